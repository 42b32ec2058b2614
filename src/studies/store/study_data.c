#include "studies/store/study_data.h"

#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "model/fields/factor.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "quantities/study_results.h"
#include "run/measure_names.h"
#include "scenario/scenario.h"
#include "studies/statistics/statistics.h"
#include "studies/store/store.h"
#include "studies/store/store_check.h"
#include "studies/store/store_text.h"

typedef struct study_reader {
    study_store store;
    study_column *column;
    int *number;
    const char **swept;
    study_point *point;
    const char **point_text; // [point_count][swept_count]
    char **text;             // all that is freed at the end
    int texts, text_capacity;
} study_reader;

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's tables");
}

// Keeps a text until the end, if it is one; NULL: no memory.
static const char *keep_text(study_reader *self, char *text)
{
    if (self->texts == self->text_capacity) {
        int capacity = self->text_capacity ? 2 * self->text_capacity : 64;
        char **list = realloc(self->text, (size_t)capacity * sizeof *list);
        if (!list) {
            free(text);
            return NULL;
        }
        self->text = list;
        self->text_capacity = capacity;
    }
    if (text)
        self->text[self->texts++] = text;
    return text;
}

// Of a row, "" where there is nothing; NULL: no memory.
static const char *column_text(study_reader *self, sqlite3_stmt *row, int column)
{
    const char *text = (const char *)sqlite3_column_text(row, column);
    if (!text && sqlite3_column_type(row, column) != SQLITE_NULL)
        return NULL;
    return keep_text(self, strdup(text ? text : ""));
}

// ---- columns

// Columns of bookkeeping, of the tables `sample` and `rocket`.
static bool is_key(const char *name)
{
    static const char *const keys[] = {"sample", "point", "status", "reason",
                                       "rocket", "tube",  "digest"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strcmp(name, keys[i]) == 0)
            return true;
    return false;
}

// Adds the columns of a table: first its results, then its factors, are counted.
static ld_status list_table(study_data *data, const char *table, bool factors, ld_error *error)
{
    study_reader *self = data->reader;
    char query[64];
    snprintf(query, sizeof query, "PRAGMA table_info(%s)", table);
    sqlite3_stmt *row = store_prepare(&self->store, query, error);
    if (!row)
        return store_status(&self->store);
    ld_status status = LD_OK;
    int stepped;
    while ((stepped = sqlite3_step(row)) == SQLITE_ROW && !status) {
        const char *name = (const char *)sqlite3_column_text(row, 1);
        const quantity *result = name ? study_result_like(name) : NULL;
        if (!name) {
            status = no_memory(error);
            break;
        }
        if (is_key(name) || factors != !result)
            continue;
        size_t size = ((size_t)data->column_count + 1) * sizeof *self->column;
        study_column *column = realloc(self->column, size);
        self->column = column ? column : self->column;
        const char *kept = column ? column_text(self, row, 1) : NULL;
        if (!kept)
            status = no_memory(error);
        else
            column[data->column_count++] =
                (study_column){kept, result && result->unit ? result->unit : "", !result,
                               strcmp(table, "rocket") == 0, false};
    }
    sqlite3_finalize(row);
    data->column = self->column;
    return status || stepped == SQLITE_DONE ? status : store_fail(&self->store, "read", error);
}

// The factor with the name of that column, or NULL.
static const ld_factor *factor_named(const ld_model *model, const char *name)
{
    for (int i = 0; i < model->scatter.factor_count; i++)
        if (strcmp(model->scatter.factor[i].path, name) == 0)
            return &model->scatter.factor[i];
    return NULL;
}

// Units of the results that the scenario itself asks for, which may go with the model; false: no
// memory.
static bool name_units(study_data *data, const ld_model *model)
{
    const quantity_things things = quantity_things_of(model);
    for (int i = 0; i < data->result_count; i++) {
        const quantity_walk result = study_result_find(&things, data->column[i].name);
        if (!result.row)
            continue;
        const char *unit = keep_text(data->reader, strdup(quantity_unit(&result)));
        if (!unit)
            return false;
        data->reader->column[i].unit = unit;
    }
    return true;
}

static void describe_factors(study_data *data, const ld_model *model)
{
    study_reader *self = data->reader;
    char why[384];
    data->plan = (study_plan){model->scatter.plan, model->scatter.seed, model->scatter.factor_count,
                              plan_row(&model->scatter)};
    for (int i = data->result_count; i < data->column_count; i++) {
        const ld_factor *factor = factor_named(model, data->column[i].name);
        field_place place;
        if (!factor)
            continue;
        self->number[i] = (int)(factor - model->scatter.factor);
        if (field_locate(model, factor_path(factor, 0), &place, why, sizeof why) && place.row->unit)
            self->column[i].unit = place.row->unit;
        self->column[i].seed = distribution_of(factor->distribution)->traits & LD_SEED;
    }
}

// Units and kinds of the factors and the title, from the scenario itself; without them where it
// cannot be read.
static ld_status read_scenario(study_data *data, ld_error *error)
{
    ld_model *model = malloc(sizeof *model);
    ld_messages messages;
    if (!model)
        return no_memory(error);
    ld_status status = scenario_read_text(data->scenario, strlen(data->scenario), "study", ".",
                                          NULL, 0, model, &messages);
    bool whole = status != LD_ERR_MEMORY;
    if (status) {
        ld_messages_free(&messages);
    } else {
        whole = name_units(data, model);
        describe_factors(data, model);
        data->title = keep_text(data->reader, strdup(model->title ? model->title : ""));
        whole &= data->title != NULL;
        model_clear(model);
    }
    free(model);
    return whole ? LD_OK : no_memory(error);
}

static ld_status list_columns(study_data *data, ld_error *error)
{
    ld_status status = list_table(data, "rocket", false, error);
    data->result_count = data->column_count;
    if (!status)
        status = list_table(data, "sample", true, error);
    if (!status)
        status = list_table(data, "rocket", true, error);
    if (status)
        return status;
    data->plan.row = 1;
    data->reader->number = malloc(((size_t)data->column_count + 1) * sizeof(int));
    if (!data->reader->number)
        return no_memory(error);
    for (int i = 0; i < data->column_count; i++)
        data->reader->number[i] = -1;
    data->number = data->reader->number;
    return read_scenario(data, error);
}

// ---- points

static ld_status make_points(study_data *data, int points, ld_error *error)
{
    study_reader *self = data->reader;
    size_t swept = (size_t)data->swept_count, count = (size_t)points;
    self->point = calloc(count + 1, sizeof *self->point);
    self->point_text = calloc(count * swept + 1, sizeof *self->point_text);
    self->swept = calloc(swept + 1, sizeof *self->swept);
    if (!self->point || !self->point_text || !self->swept)
        return no_memory(error);
    for (int i = 0; i < points; i++)
        self->point[i] = (study_point){.number = i + 1, .text = self->point_text + i * swept};
    data->point = self->point;
    data->swept = self->swept;
    data->point_count = points;
    return LD_OK;
}

static ld_status count_points(study_store *store, int *points, ld_error *error)
{
    sqlite3_stmt *row = store_prepare(store, "SELECT count(*) FROM point", error);
    if (!row)
        return store_status(store);
    bool read = sqlite3_step(row) == SQLITE_ROW;
    *points = read ? sqlite3_column_int(row, 0) : 0;
    sqlite3_finalize(row);
    if (!read)
        return store_fail(store, "read", error);
    return *points > 0 ? LD_OK
                       : ld_fail(error, LD_ERR_INPUT, "%s contains no study: it has no points",
                                 store->path);
}

// The points as the table `point` has them: a number and a text for each swept key.
static ld_status list_points(study_data *data, ld_error *error)
{
    study_reader *self = data->reader;
    int points = 0;
    ld_status status = count_points(&self->store, &points, error);
    if (status)
        return status;
    sqlite3_stmt *row = store_prepare(&self->store, "SELECT * FROM point ORDER BY point", error);
    if (!row)
        return store_status(&self->store);
    data->swept_count = sqlite3_column_count(row) - 1;
    status = make_points(data, points, error);
    for (int k = 0; k < data->swept_count && !status; k++) {
        const char *name = sqlite3_column_name(row, k + 1);
        if (!(self->swept[k] = keep_text(self, name ? strdup(name) : NULL)))
            status = no_memory(error);
    }
    for (int i = 0; i < data->point_count && !status; i++) {
        if (sqlite3_step(row) != SQLITE_ROW)
            status = store_fail(&self->store, "read", error);
        self->point[i].number = sqlite3_column_int64(row, 0);
        for (int k = 0; k < data->swept_count && !status; k++)
            if (!(self->point_text[i * data->swept_count + k] = column_text(self, row, k + 1)))
                status = no_memory(error);
    }
    sqlite3_finalize(row);
    return status;
}

// Counts the samples of each point, all of which are checked; what is damaged stands in
// data->damage.
static ld_status count_samples(study_data *data, ld_error *error)
{
    study_reader *self = data->reader;
    const store_view view = store_main(&self->store);
    store_walk walk;
    ld_status status = store_walk_begin(&walk, &view, &self->store.kept, &data->damage);
    while (!status && store_walk_next(&walk, error))
        if (walk.point >= 1 && walk.point <= data->point_count) {
            self->point[walk.point - 1].done++;
            self->point[walk.point - 1].failed += walk.failed;
        }
    if (!status)
        status = store_walk_verdict(&walk, &data->damage);
    data->rockets = walk.all_rockets;
    store_walk_end(&walk);
    if (status == LD_ERR_INPUT)
        return LD_OK;
    if (status && !walk.status)
        *error = data->damage;
    return status;
}

// ---- opening

// A whole number, at least `least`.
static ld_status read_number(const store_view *view, const char *name, int64_t least,
                             int64_t *number, ld_error *error)
{
    char *text;
    ld_status status = store_view_text(view, name, &text, error);
    *number = text ? atoll(text) : least;
    *number = *number > least ? *number : least;
    free(text);
    return status;
}

static ld_status read_text(study_reader *self, const char *name, const char **text, ld_error *error)
{
    char *found;
    const store_view view = store_main(&self->store);
    ld_status status = store_view_text(&view, name, &found, error);
    if (status)
        return status;
    if (!found)
        return ld_fail(error, LD_ERR_INPUT, "%s contains no study", self->store.path);
    *text = keep_text(self, found);
    return *text ? LD_OK : no_memory(error);
}

static ld_status read_texts(study_data *data, ld_error *error)
{
    study_reader *self = data->reader;
    const store_view view = store_main(&self->store);
    data->title = "";
    ld_status status = read_number(&view, "strata", 1, &data->strata, error);
    if (!status)
        status = read_number(&view, "samples", 0, &data->asked, error);
    if (!status)
        status = read_text(self, "scenario", &data->scenario, error);
    return status ? status : read_text(self, "version", &data->version, error);
}

ld_status study_data_open_damaged(const char *folder, study_data *data, ld_error *error)
{
    *data = (study_data){.reader = calloc(1, sizeof(study_reader))};
    if (!data->reader)
        return no_memory(error);
    ld_status status = store_open_to_read(&data->reader->store, folder, error);
    if (status) {
        free(data->reader);
        data->reader = NULL;
        return status;
    }
    status = read_texts(data, error);
    if (!status)
        status = list_columns(data, error);
    if (!status)
        status = list_points(data, error);
    for (int i = 0; i < data->point_count; i++)
        data->reader->point[i].asked = data->asked / data->point_count;
    if (!status)
        status = count_samples(data, error);
    if (status)
        study_data_close(data);
    return status;
}

ld_status study_data_open(const char *folder, study_data *data, ld_error *error)
{
    ld_status status = study_data_open_damaged(folder, data, error);
    if (status || !data->damage.status)
        return status;
    ld_fail(error, LD_ERR_INPUT, "%s; launchdyn study export writes what is intact",
            data->damage.text);
    study_data_close(data);
    return LD_ERR_INPUT;
}

study_store *study_data_store(const study_data *data)
{
    return &data->reader->store;
}

void study_data_close(study_data *data)
{
    study_reader *self = data->reader;
    if (!self)
        return;
    for (int i = 0; i < self->texts; i++)
        free(self->text[i]);
    free(self->text);
    free(self->column);
    free(self->number);
    free(self->swept);
    free(self->point);
    free(self->point_text);
    store_close(&self->store);
    free(self);
    *data = (study_data){0};
}

static const study_column *column_named(const study_data *data, const char *name)
{
    for (int i = 0; i < data->column_count; i++)
        if (strcmp(data->column[i].name, name) == 0)
            return &data->column[i];
    return NULL;
}

const study_column *study_data_find(const study_data *data, const char *name, const char **nearest)
{
    char now[QUANTITY_NAME];
    name_suggestion suggestion = suggestion_begin(name);
    const study_column *column = column_named(data, name);
    if (!column && ld_current_name(name, now, sizeof now))
        column = column_named(data, now);
    for (int i = 0; i < data->column_count && !column; i++)
        suggestion_offer(&suggestion, data->column[i].name);
    *nearest = suggestion.name;
    return column;
}

// ---- failures

// What the column holds as a text, "" where it is NULL, cut to its room.
static void copy_text(sqlite3_stmt *row, int column, char *text, size_t size)
{
    const char *found = (const char *)sqlite3_column_text(row, column);
    snprintf(text, size, "%s", found ? found : "");
}

ld_status study_data_failures(const study_data *data, const study_point *point,
                              study_failure *failure, int capacity, int *count, ld_error *error)
{
    study_reader *self = data->reader;
    static const char query[] =
        "SELECT count(*), min(sample), status, reason FROM sample WHERE status != 'ok' AND point "
        "= ? GROUP BY status, substr(reason, 1, 40) ORDER BY count(*) DESC, min(sample)";
    int result = SQLITE_DONE;
    *count = 0;
    sqlite3_stmt *row = store_prepare(&self->store, query, error);
    if (!row)
        return store_status(&self->store);
    sqlite3_bind_int64(row, 1, point->number);
    while (*count < capacity && (result = sqlite3_step(row)) == SQLITE_ROW) {
        study_failure *f = &failure[(*count)++];
        f->count = sqlite3_column_int64(row, 0);
        f->first = sqlite3_column_int64(row, 1);
        copy_text(row, 2, f->status, sizeof f->status);
        copy_text(row, 3, f->reason, sizeof f->reason);
    }
    sqlite3_finalize(row);
    return *count < capacity && result != SQLITE_DONE ? store_fail(&self->store, "read", error)
                                                      : LD_OK;
}

ld_status study_data_failed(const study_data *data, const study_point *point, study_failed *failed,
                            int capacity, int *count, ld_error *error)
{
    study_reader *self = data->reader;
    static const char query[] =
        "SELECT sample, status, reason FROM sample WHERE status != 'ok' AND "
        "point = ? ORDER BY sample";
    int result = SQLITE_DONE;
    *count = 0;
    sqlite3_stmt *row = store_prepare(&self->store, query, error);
    if (!row)
        return store_status(&self->store);
    sqlite3_bind_int64(row, 1, point->number);
    while (*count < capacity && (result = sqlite3_step(row)) == SQLITE_ROW) {
        study_failed *f = &failed[(*count)++];
        f->sample = sqlite3_column_int64(row, 0);
        copy_text(row, 1, f->status, sizeof f->status);
        copy_text(row, 2, f->reason, sizeof f->reason);
    }
    sqlite3_finalize(row);
    return *count < capacity && result != SQLITE_DONE ? store_fail(&self->store, "read", error)
                                                      : LD_OK;
}

// ---- values

void study_values_free(study_values *values)
{
    free(values->sample);
    free(values->group);
    free(values->rocket);
    for (int i = 0; i < values->columns; i++)
        free(values->value[i]);
    free(values->value);
    *values = (study_values){0};
}

static bool resize(void **array, size_t count, size_t size)
{
    void *larger = realloc(*array, count * size);
    if (larger)
        *array = larger;
    return larger;
}

// Makes room for so many rows of so many columns.
static bool reserve(study_values *self, int columns, size_t capacity)
{
    if (columns > self->columns) {
        if (!resize((void **)&self->value, (size_t)columns, sizeof *self->value))
            return false;
        while (self->columns < columns)
            self->value[self->columns++] = NULL;
    }
    bool good = resize((void **)&self->sample, capacity, sizeof *self->sample) &&
                resize((void **)&self->group, capacity, sizeof *self->group) &&
                resize((void **)&self->rocket, capacity, sizeof *self->rocket);
    for (int i = 0; i < self->columns && good; i++)
        good = resize((void **)&self->value[i], capacity, sizeof(double));
    self->capacity = good ? capacity : self->capacity;
    return good;
}

static void append(const study_data *data, sqlite3_stmt *row, int columns, study_values *values)
{
    size_t at = values->count;
    for (int i = 0; i < columns; i++) {
        if (sqlite3_column_type(row, 2 + i) == SQLITE_NULL)
            return;
        values->value[i][at] = sqlite3_column_double(row, 2 + i);
    }
    values->sample[at] = sqlite3_column_int64(row, 0);
    // the numbers of samples go round the points; those of one hypercube follow each other
    values->group[at] = (values->sample[at] - 1) / data->point_count / data->strata;
    values->rocket[at] = sqlite3_column_int(row, 1);
    values->count++;
}

static sqlite3_stmt *select_values(study_reader *self, const study_column *const *column,
                                   int columns, ld_error *error)
{
    sqlite3_str *text = sqlite3_str_new(self->store.database);
    sqlite3_str_appendall(text, "SELECT rocket.sample, rocket.rocket");
    for (int i = 0; i < columns; i++)
        sqlite3_str_appendf(text, ", %s.\"%w\"", column[i]->per_rocket ? "rocket" : "sample",
                            column[i]->name);
    sqlite3_str_appendall(
        text,
        " FROM sample JOIN rocket USING (sample) WHERE sample.status = 'ok' AND sample.point = "
        "? AND sample.sample <= ? ORDER BY sample.sample, rocket.rocket");
    return store_prepare_built(&self->store, text, error);
}

// What is read of a point: columns, of the samples numbered up to `last`.
typedef struct study_query {
    const study_point *point;
    int64_t last;
    const study_column *const *column;
    int columns;
} study_query;

static ld_status read_up_to(const study_data *data, const study_query *query, study_values *values,
                            ld_error *error)
{
    const int columns = query->columns;
    study_reader *self = data->reader;
    int result = SQLITE_DONE;
    sqlite3_stmt *row = select_values(self, query->column, columns, error);
    if (!row)
        return error->status;
    sqlite3_bind_int64(row, 1, query->point->number);
    sqlite3_bind_int64(row, 2, query->last);
    values->count = 0;
    bool room = reserve(values, columns, values->capacity ? values->capacity : 1024);
    while (room && (result = sqlite3_step(row)) == SQLITE_ROW) {
        if (values->count == values->capacity)
            room = reserve(values, columns, 2 * values->capacity);
        if (room)
            append(data, row, columns, values);
    }
    sqlite3_finalize(row);
    if (!room)
        return no_memory(error);
    return result == SQLITE_DONE ? LD_OK : store_fail(&self->store, "read", error);
}

ld_status study_data_read(const study_data *data, const study_point *point,
                          const study_column *const *column, int columns, study_values *values,
                          ld_error *error)
{
    const study_query query = {point, INT64_MAX, column, columns};
    return read_up_to(data, &query, values, error);
}

// ---- lines

enum { MOST_PLACES = 32 };

// The columns with x and z of each place; how many places there are.
static int find_places(const study_data *data, const study_column *column[2 * MOST_PLACES])
{
    for (int i = 0; i < 2 * MOST_PLACES; i++) {
        char name[32];
        const char *nearest;
        snprintf(name, sizeof name, "line.%d.%c", i / 2 + 1, i % 2 ? 'z' : 'x');
        if (!(column[i] = study_data_find(data, name, &nearest)))
            return i / 2;
    }
    return MOST_PLACES;
}

// Of pairs of columns the first pair, for all places; from the end, so that none is lost.
static bool pool_places(study_values *self, size_t places)
{
    if (!reserve(self, self->columns, (self->count + 1) * places))
        return false;
    for (size_t i = self->count * places; i-- > 0;) {
        const size_t rocket = i / places, pair = i % places;
        self->sample[i] = self->sample[rocket];
        self->group[i] = self->group[rocket];
        self->rocket[i] = self->rocket[rocket];
        for (size_t k = 0; k < 2; k++)
            self->value[k][i] = self->value[2 * pair + k][rocket];
    }
    self->count *= places;
    return true;
}

ld_status study_data_read_line(const study_data *data, const study_point *point,
                               study_values *values, ld_error *error)
{
    const study_column *column[2 * MOST_PLACES];
    const int places = find_places(data, column);
    values->count = 0;
    if (places == 0)
        return LD_OK;
    ld_status status = study_data_read(data, point, column, 2 * places, values, error);
    if (!status && !pool_places(values, (size_t)places))
        status = no_memory(error);
    return status;
}

// ---- stopping rules

static double half_width(const group_statistics *of, ld_statistic statistic, bool relative)
{
    const estimate *e = statistic == LD_STATISTIC_MEAN ? &of->mean : &of->deviation;
    double half = 0.5 * (e->high - e->low);
    if (of->groups > 2 && of->deviation.value == 0)
        return 0;
    return isnan(half) ? INFINITY : relative ? half / fabs(e->value) : half;
}

ld_status study_data_half_width(const study_data *data, const study_column *result,
                                const ld_until *rule, int64_t last, double *half, ld_error *error)
{
    study_values values = {0};
    ld_status status = LD_OK;
    *half = 0;
    for (int i = 0; i < data->point_count && !status; i++) {
        group_statistics of;
        const study_query query = {&data->point[i], last > 0 ? last : INT64_MAX, &result, 1};
        status = read_up_to(data, &query, &values, error);
        if (!status && moments_of(values.value[0], values.group, values.count, &of))
            status = no_memory(error);
        if (!status)
            *half = fmax(*half, half_width(&of, rule->statistic, rule->relative));
    }
    study_values_free(&values);
    return status;
}
