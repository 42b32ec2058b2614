#include "fit/fit_data.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/matrices/dense.h"
#include "run/measure_names.h"

// What stands behind the name of a result whose standard uncertainty a column gives.
static const char suffix[] = "_u";

// A launch as the files have it.
typedef struct measured_row {
    const char *file;
    size_t number; // in the file, from 1
    double value[FIT_MOST_RESULTS], uncertainty[FIT_MOST_RESULTS], setting[FIT_MOST_SETTINGS];
    int launch; // of which it is one
} measured_row;

typedef struct row_reader {
    fit_data *data;
    const char *file;
    measured_row *row;                                      // [data->rows]
    double covariance[FIT_MOST_RESULTS * FIT_MOST_RESULTS]; // of those estimated, by `results`
    ld_error *error;
} row_reader;

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the measured launches");
}

// ---- columns

// The result that a column is of, by its present name: its unit, or NULL.
static const char *find_result(const quantity_things *things, const char *name,
                               char now[MEASURED_NAME])
{
    char current[QUANTITY_NAME];
    quantity_walk at = study_result_find(things, name);
    snprintf(now, MEASURED_NAME, "%s", name);
    if (!at.row && ld_current_name(name, current, sizeof current)) {
        at = study_result_find(things, current);
        snprintf(now, MEASURED_NAME, "%.*s", MEASURED_NAME - 1, current);
    }
    return at.row ? quantity_unit(&at) : NULL;
}

// Whether the name ends as that of an uncertainty; the name of the result before it.
static bool is_uncertainty(const char *name, char result[MEASURED_NAME])
{
    size_t length = strlen(name), end = strlen(suffix);
    bool is = length > end && strcmp(name + length - end, suffix) == 0;
    snprintf(result, MEASURED_NAME, "%.*s", (int)(is ? length - end : length), name);
    return is;
}

static const char *unit_of_column(const void *self, const char *name, char now[MEASURED_NAME],
                                  char near[MEASURED_NAME])
{
    const fit_data *data = self;
    char before[MEASURED_NAME], nearest[QUANTITY_NAME], why[384];
    field_place place;
    const char *unit = find_result(&data->things, name, now);
    near[0] = 0;
    if (unit)
        return strcmp(unit, "1") == 0 ? "" : unit;
    if (is_uncertainty(name, before) && (unit = find_result(&data->things, before, now))) {
        strncat(now, suffix, MEASURED_NAME - strlen(now) - 1);
        return strcmp(unit, "1") == 0 ? "" : unit;
    }
    snprintf(now, MEASURED_NAME, "%s", name);
    if (field_locate(data->model, name, &place, why, sizeof why))
        return place.row->unit ? place.row->unit : "";
    study_result_near(&data->things, name, nearest);
    snprintf(near, MEASURED_NAME, "%.*s", MEASURED_NAME - 1, nearest);
    return NULL;
}

// The number of a result, which is added where it is new; -1: too many.
static int result_number(fit_data *data, const char *name, const measured_result *column)
{
    for (int i = 0; i < data->results; i++)
        if (strcmp(data->result[i].name, name) == 0)
            return i;
    if (data->results == FIT_MOST_RESULTS)
        return -1;
    fit_result *result = &data->result[data->results];
    memset(result, 0, sizeof *result);
    snprintf(result->name, sizeof result->name, "%s", name);
    memcpy(result->unit, column->unit, sizeof result->unit);
    result->factor = column->factor;
    return data->results++;
}

static int setting_number(fit_data *data, const char *path)
{
    char why[384];
    field_place place;
    if (!field_locate(data->model, path, &place, why, sizeof why))
        return -1;
    for (int i = 0; i < data->settings; i++)
        if (strcmp(data->setting[i].path, place.path) == 0)
            return i;
    if (data->settings == FIT_MOST_SETTINGS)
        return -1;
    data->setting[data->settings] = place;
    return data->settings++;
}

static ld_status take_column(row_reader *self, const measured_result *column, size_t first)
{
    fit_data *data = self->data;
    char name[MEASURED_NAME], now[MEASURED_NAME];
    bool direct = find_result(&data->things, column->name, now) != NULL;
    bool deviation =
        !direct && is_uncertainty(column->name, name) && find_result(&data->things, name, now);
    bool setting = !direct && !deviation;
    int number = setting ? setting_number(data, column->name) : result_number(data, now, column);
    if (number < 0)
        return ld_fail(self->error, LD_ERR_INPUT, "%.300s: %s: more than %d results or %d keys",
                       self->file, column->name, FIT_MOST_RESULTS, FIT_MOST_SETTINGS);
    for (size_t i = 0; i < column->count; i++) {
        measured_row *row = &self->row[first + column->launch[i]];
        double *value = setting     ? &row->setting[number]
                        : deviation ? &row->uncertainty[number]
                                    : &row->value[number];
        *value = column->value[i];
    }
    return LD_OK;
}

// ---- rows

static ld_status add_rows(row_reader *self, size_t count)
{
    fit_data *data = self->data;
    size_t rows = data->rows + count;
    measured_row *larger = realloc(self->row, rows * sizeof *larger);
    if (!larger)
        return no_memory(self->error);
    self->row = larger;
    for (size_t i = data->rows; i < rows; i++) {
        measured_row *row = &larger[i];
        *row = (measured_row){.file = self->file, .number = i - data->rows + 1, .launch = -1};
        for (int k = 0; k < FIT_MOST_RESULTS; k++)
            row->value[k] = row->uncertainty[k] = NAN;
        for (int k = 0; k < FIT_MOST_SETTINGS; k++)
            row->setting[k] = NAN;
    }
    return LD_OK;
}

static ld_status read_file(row_reader *self, const char *file)
{
    fit_data *data = self->data;
    const measured_names names = {"neither a result nor a key of the scenario is called",
                                  unit_of_column, data};
    measured launches;
    size_t first = data->rows;
    self->file = file;
    ld_status status = measured_read_named(file, &names, &launches, self->error);
    if (status)
        return status;
    if (launches.count > FIT_MOST_LAUNCHES)
        status = ld_fail(self->error, LD_ERR_INPUT, "%.300s: more than %d launches", file,
                         FIT_MOST_LAUNCHES);
    if (!status)
        status = add_rows(self, launches.count);
    for (int i = 0; i < launches.results && !status; i++)
        status = take_column(self, &launches.result[i], first);
    data->rows += status ? 0 : launches.count;
    measured_free(&launches);
    return status;
}

// ---- launches alike

static bool is_alike(const fit_data *data, const fit_launch *launch, const measured_row *row)
{
    for (int i = 0; i < data->settings; i++)
        if (launch->setting[i] != row->setting[i])
            return false;
    return true;
}

static ld_status check_settings(const row_reader *self, const measured_row *row)
{
    for (int i = 0; i < self->data->settings; i++)
        if (isnan(row->setting[i]))
            return ld_fail(self->error, LD_ERR_INPUT, "%.300s: launch %zu has no value of %s",
                           row->file, row->number, self->data->setting[i].path);
    return LD_OK;
}

// Sorts the rows to launches.
static ld_status group_rows(row_reader *self)
{
    fit_data *data = self->data;
    ld_status status = LD_OK;
    data->launch = calloc(data->rows, sizeof *data->launch);
    if (!data->launch)
        return no_memory(self->error);
    for (size_t i = 0; i < data->rows && !status; i++) {
        measured_row *row = &self->row[i];
        size_t k = 0;
        status = check_settings(self, row);
        while (k < data->launches && !is_alike(data, &data->launch[k], row))
            k++;
        if (k == data->launches)
            memcpy(data->launch[data->launches++].setting, row->setting, sizeof row->setting);
        data->launch[k].rows++;
        row->launch = (int)k;
    }
    return status;
}

// ---- uncertainties

// Which results have their uncertainty from columns: then all their values have one.
static ld_status check_uncertainties(row_reader *self)
{
    fit_data *data = self->data;
    for (int k = 0; k < data->results; k++) {
        fit_result *result = &data->result[k];
        size_t given = 0;
        for (size_t i = 0; i < data->rows; i++) {
            result->values += !isnan(self->row[i].value[k]);
            given += !isnan(self->row[i].uncertainty[k]);
        }
        result->estimated = given == 0;
        data->estimated += result->estimated;
        for (size_t i = 0; i < data->rows && given > 0; i++) {
            const measured_row *row = &self->row[i];
            if (!isnan(row->value[k]) && !(row->uncertainty[k] > 0))
                return ld_fail(self->error, LD_ERR_INPUT,
                               "%.300s: launch %zu: %s%s: found %s, expected a number > 0",
                               row->file, row->number, result->name, suffix,
                               isnan(row->uncertainty[k]) ? "nothing" : "0 or less");
        }
    }
    return LD_OK;
}

// Whether the row has all results whose uncertainty is estimated.
static bool is_whole(const fit_data *data, const measured_row *row)
{
    for (int k = 0; k < data->results; k++)
        if (data->result[k].estimated && isnan(row->value[k]))
            return false;
    return true;
}

// Means of the whole rows of a launch, and how many there are.
static size_t mean_of_whole(const row_reader *self, size_t launch, double mean[FIT_MOST_RESULTS])
{
    const fit_data *data = self->data;
    size_t count = 0;
    memset(mean, 0, FIT_MOST_RESULTS * sizeof *mean);
    for (size_t i = 0; i < data->rows; i++) {
        const measured_row *row = &self->row[i];
        if ((size_t)row->launch != launch || !is_whole(data, row))
            continue;
        count++;
        for (int k = 0; k < data->results; k++)
            mean[k] += data->result[k].estimated ? row->value[k] : 0;
    }
    for (int k = 0; k < data->results; k++)
        mean[k] /= (double)count;
    return count;
}

static void add_products(row_reader *self, size_t launch, const double *mean)
{
    const fit_data *data = self->data;
    int n = data->results;
    for (size_t i = 0; i < data->rows; i++) {
        const measured_row *row = &self->row[i];
        if ((size_t)row->launch != launch || !is_whole(data, row))
            continue;
        for (int k = 0; k < n; k++)
            for (int j = 0; j < n; j++)
                if (data->result[k].estimated && data->result[j].estimated)
                    self->covariance[k * n + j] +=
                        (row->value[k] - mean[k]) * (row->value[j] - mean[j]);
    }
}

// The covariance of the results without a given uncertainty, pooled over launches alike.
static ld_status estimate_covariance(row_reader *self)
{
    fit_data *data = self->data;
    int n = data->results;
    if (data->estimated == 0)
        return LD_OK;
    for (size_t c = 0; c < data->launches; c++) {
        double mean[FIT_MOST_RESULTS];
        size_t count = mean_of_whole(self, c, mean);
        if (count > 1) {
            add_products(self, c, mean);
            data->freedom += (int)count - 1;
        }
    }
    int k = 0;
    while (!data->result[k].estimated)
        k++;
    if (data->freedom < data->estimated + 1)
        return ld_fail(self->error, LD_ERR_INPUT,
                       "%s: its uncertainty is neither given, in a column %s%s, nor known from "
                       "launches alike: found %d beyond the first, expected %d for %d results",
                       data->result[k].name, data->result[k].name, suffix, data->freedom,
                       data->estimated + 1, data->estimated);
    for (int i = 0; i < n * n; i++)
        self->covariance[i] /= data->freedom;
    return LD_OK;
}

// The weights of one row: the inverse of the covariance of what it has. False: there is none.
static bool weigh_row(const row_reader *self, const measured_row *row, double *weight)
{
    const fit_data *data = self->data;
    int n = data->results, count = 0, result[FIT_MOST_RESULTS];
    double factor[FIT_MOST_RESULTS * FIT_MOST_RESULTS], column[FIT_MOST_RESULTS];
    memset(weight, 0, (size_t)(n * n) * sizeof *weight);
    for (int k = 0; k < n; k++) {
        if (!isnan(row->value[k]) && data->result[k].estimated)
            result[count++] = k;
        else if (!isnan(row->value[k]))
            weight[k * n + k] = 1 / (row->uncertainty[k] * row->uncertainty[k]);
    }
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++)
            factor[i * count + j] = self->covariance[result[i] * n + result[j]];
    if (cholesky_factor(count, factor) != 0)
        return false;
    for (int j = 0; j < count; j++) {
        memset(column, 0, sizeof column);
        column[j] = 1;
        cholesky_solve(count, factor, column);
        for (int i = 0; i < count; i++)
            weight[result[i] * n + result[j]] = column[i];
    }
    return true;
}

// ---- means

// Means and weights of what there is, from the sums over the rows.
static ld_status finish_launch(row_reader *self, fit_launch *launch, const double *sum,
                               const double *moment)
{
    int n = self->data->results, count = 0;
    for (int k = 0; k < n; k++)
        if (sum[k * n + k] > 0)
            launch->result[count++] = k;
    launch->cells = count;
    launch->first = self->data->residuals;
    self->data->residuals += count;
    launch->root = calloc((size_t)(count * count) + 1, sizeof *launch->root);
    if (!launch->root)
        return no_memory(self->error);
    for (int i = 0; i < count; i++) {
        launch->mean[i] = moment[launch->result[i]];
        for (int j = 0; j < count; j++)
            launch->root[i * count + j] = sum[launch->result[i] * n + launch->result[j]];
    }
    if (cholesky_factor(count, launch->root) != 0)
        return ld_fail(self->error, LD_ERR_INPUT,
                       "the uncertainties of the launches have no finite weights");
    cholesky_solve(count, launch->root, launch->mean);
    return LD_OK;
}

static ld_status average_rows(row_reader *self, size_t c, double *sum, double *weight)
{
    fit_data *data = self->data;
    int n = data->results;
    double moment[FIT_MOST_RESULTS] = {0};
    memset(sum, 0, (size_t)(n * n) * sizeof *sum);
    for (size_t i = 0; i < data->rows; i++) {
        const measured_row *row = &self->row[i];
        if ((size_t)row->launch != c)
            continue;
        if (!weigh_row(self, row, weight))
            return ld_fail(self->error, LD_ERR_INPUT,
                           "launches alike do not scatter, or only together: give the "
                           "uncertainties of the results in columns NAME%s",
                           suffix);
        for (int k = 0; k < n * n; k++)
            sum[k] += weight[k];
        for (int k = 0; k < n; k++)
            for (int j = 0; j < n; j++)
                if (weight[k * n + j] != 0)
                    moment[k] += weight[k * n + j] * row->value[j];
    }
    return finish_launch(self, &data->launch[c], sum, moment);
}

// How far values with a given uncertainty are from the mean of launches alike.
static void find_misfit(row_reader *self)
{
    fit_data *data = self->data;
    for (size_t c = 0; c < data->launches; c++) {
        const fit_launch *launch = &data->launch[c];
        for (int cell = 0; cell < launch->cells; cell++) {
            int k = launch->result[cell];
            fit_result *result = &data->result[k];
            size_t count = 0;
            for (size_t i = 0; i < data->rows && !result->estimated; i++) {
                const measured_row *row = &self->row[i];
                if ((size_t)row->launch != c || isnan(row->value[k]))
                    continue;
                double apart = (row->value[k] - launch->mean[cell]) / row->uncertainty[k];
                result->misfit += apart * apart;
                count++;
            }
            result->misfit_freedom += count > 0 ? count - 1 : 0;
        }
    }
}

static ld_status average(row_reader *self)
{
    size_t n = (size_t)self->data->results;
    double *sum = calloc(n * n, sizeof *sum), *weight = calloc(n * n, sizeof *weight);
    ld_status status = LD_OK;
    if (!sum || !weight)
        status = no_memory(self->error);
    else
        for (size_t c = 0; c < self->data->launches && !status; c++)
            status = average_rows(self, c, sum, weight);
    free(sum);
    free(weight);
    if (!status)
        find_misfit(self);
    return status;
}

static ld_status read_files(row_reader *self, const char *const *files, size_t count)
{
    ld_status status = LD_OK;
    for (size_t i = 0; i < count && !status; i++)
        status = read_file(self, files[i]);
    if (!status)
        status = check_uncertainties(self);
    for (int k = 0; k < self->data->results && !status; k++)
        if (self->data->result[k].values == 0)
            status = ld_fail(self->error, LD_ERR_INPUT, "%s: no launch has a value",
                             self->data->result[k].name);
    if (!status && self->data->results == 0)
        status = ld_fail(self->error, LD_ERR_INPUT, "%.300s names no result", self->file);
    if (!status)
        status = group_rows(self);
    if (!status)
        status = estimate_covariance(self);
    return status ? status : average(self);
}

ld_status fit_data_read(const ld_model *model, const char *const *files, size_t count,
                        fit_data *data, ld_error *error)
{
    *data = (fit_data){.model = model, .things = quantity_things_of(model)};
    if (count == 0)
        return LD_OK;
    row_reader *self = calloc(1, sizeof *self);
    if (!self)
        return no_memory(error);
    self->data = data;
    self->error = error;
    ld_status status = read_files(self, files, count);
    free(self->row);
    free(self);
    return status;
}

void fit_data_free(fit_data *data)
{
    for (size_t i = 0; i < data->launches; i++)
        free(data->launch[i].root);
    free(data->launch);
    *data = (fit_data){0};
}

ld_status fit_data_own_launch(fit_data *data, int *number, ld_error *error)
{
    fit_launch own = {.first = data->residuals};
    size_t k = 0;
    for (int i = 0; i < data->settings; i++)
        own.setting[i] = field_get(data->model, &data->setting[i]);
    while (k < data->launches && memcmp(data->launch[k].setting, own.setting,
                                        (size_t)data->settings * sizeof *own.setting) != 0)
        k++;
    *number = (int)k;
    if (k < data->launches)
        return LD_OK;
    fit_launch *larger = realloc(data->launch, (k + 1) * sizeof *larger);
    own.root = calloc(1, sizeof *own.root);
    if (larger)
        data->launch = larger;
    if (!larger || !own.root) {
        free(own.root);
        return no_memory(error);
    }
    data->launch[data->launches++] = own;
    return LD_OK;
}
