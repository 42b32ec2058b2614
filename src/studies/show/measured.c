#include "studies/show/measured.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "base/text_file.h"
#include "base/text_lines.h"
#include "scenario/measured/csv_column.h"
#include "scenario/scenario_reader.h"

enum { MOST_BYTES = 64 << 20, NO_RESULT = -1 };

// A line of the file.
typedef struct launch_row {
    int64_t salvo; // without such a column its number
    size_t number;
    double value[]; // [results] SI; NaN: not measured
} launch_row;

typedef struct launch_reader {
    const char *file;
    const measured_names *names;
    measured *launches;
    text_lines at;
    int columns, salvo;            // columns of the header, and the one of salvos, or NO_RESULT
    int result[TEXT_LINES_FIELDS]; // of each column, or NO_RESULT
    launch_row **row;              // [launches->count]
    ld_error *error;
} launch_reader;

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the measured launches");
}

// "FILE:LINE:COLUMN: NAME: ..."
static ld_status refuse(const launch_reader *self, int field, const char *name, const char *text)
{
    return ld_fail(self->error, LD_ERR_INPUT, "%.300s:%d:%d: %.*s%s%s", self->file, self->at.number,
                   text_lines_column(&self->at, field), MEASURED_NAME, name, name[0] ? ": " : "",
                   text);
}

static bool next_line(launch_reader *self)
{
    return text_lines_next(&self->at, '#', true);
}

// ---- the header

// Takes the unit, what stands behind the name in brackets, of a result in SI unit `target`.
static ld_status read_unit(const launch_reader *self, int field, const csv_column *head,
                           measured_result *result, const char *target)
{
    char text[256];
    snprintf(result->unit, sizeof result->unit, "%s", head->unit);
    return csv_column_factor(head, target, &result->factor, text, sizeof text)
               ? LD_OK
               : refuse(self, field, result->name, text);
}

static const char *unit_of_result(const void *data, const char *name, char now[MEASURED_NAME],
                                  char near[MEASURED_NAME])
{
    const char *nearest = NULL;
    const study_column *column = study_data_find(data, name, &nearest);
    snprintf(now, MEASURED_NAME, "%s", column ? column->name : "");
    snprintf(near, MEASURED_NAME, "%s", nearest ? nearest : "");
    return column && !column->factor ? column->unit : NULL;
}

// A column of the header: "name [unit]" or "salvo".
static ld_status read_head(launch_reader *self, int field)
{
    measured *launches = self->launches;
    measured_result *result = &launches->result[launches->results];
    const char *text = self->at.field[field];
    char message[256], quoted[64], now[MEASURED_NAME], near[MEASURED_NAME];
    csv_column head;
    self->result[field] = NO_RESULT;
    if (strcmp(text, "salvo") == 0 && self->salvo == NO_RESULT) {
        self->salvo = field;
        return LD_OK;
    }
    if (!csv_column_read(text, &head))
        return refuse(self, field, "",
                      "expected a result with its unit, such as \"t_front [ms]\", or \"salvo\"");
    snprintf(result->name, sizeof result->name, "%s", head.name);
    const char *unit = self->names->unit_of(self->names->self, result->name, now, near);
    if (!unit) {
        snprintf(message, sizeof message, "%s %s%s%s%s", self->names->none,
                 reader_quote(result->name, quoted), near[0] ? ", did you mean \"" : "", near,
                 near[0] ? "\"?" : "");
        return refuse(self, field, "", message);
    }
    if (strcmp(now, result->name) != 0) {
        memcpy(result->former, result->name, sizeof result->former);
        memcpy(result->name, now, sizeof result->name);
    }
    for (int i = 0; i < launches->results; i++)
        if (strcmp(launches->result[i].name, result->name) == 0)
            return refuse(self, field, result->name, "is given in an earlier column, too");
    self->result[field] = launches->results++;
    return read_unit(self, field, &head, result, unit);
}

static ld_status read_header(launch_reader *self)
{
    ld_status status = LD_OK;
    if (!next_line(self))
        return refuse(self, 0, "", self->at.wrong ? self->at.wrong : "the file is empty");
    self->columns = self->at.count;
    self->launches->result = calloc((size_t)self->columns, sizeof *self->launches->result);
    if (!self->launches->result)
        return no_memory(self->error);
    for (int i = 0; i < self->columns && !status; i++)
        status = read_head(self, i);
    if (!status && self->launches->results == 0)
        status = refuse(self, 0, "", "names no result, such as \"t_front [ms]\"");
    return status;
}

// ---- the launches

static ld_status read_number(const launch_reader *self, int field, const char *name, double *value)
{
    char message[256];
    return csv_number(self->at.field[field], value, message, sizeof message)
               ? LD_OK
               : refuse(self, field, name, message);
}

static ld_status read_field(const launch_reader *self, int field, launch_row *row)
{
    int index = self->result[field];
    const char *text = self->at.field[field];
    double value = NAN;
    if (field == self->salvo) {
        ld_status status = read_number(self, field, "salvo", &value);
        row->salvo = isfinite(value) && fabs(value) < 1e9 ? (int64_t)value : 0;
        if (!status && (double)row->salvo != value)
            return refuse(self, field, "salvo", "expected a whole number, below 1e9");
        return status;
    }
    const measured_result *result = &self->launches->result[index];
    ld_status status = text[0] ? read_number(self, field, result->name, &value) : LD_OK;
    row->value[index] = units_scale(value, result->factor);
    if (!status && isinf(row->value[index]))
        return refuse(self, field, result->name, "too large a number");
    return status;
}

static ld_status read_launch(launch_reader *self)
{
    measured *launches = self->launches;
    char message[96];
    if (self->at.count != self->columns) {
        snprintf(message, sizeof message, "found %d fields; expected %d, as in the header",
                 self->at.count, self->columns);
        return refuse(self, 0, "", message);
    }
    // room is doubled at each power of two
    if ((launches->count & (launches->count - 1)) == 0) {
        size_t room = launches->count ? 2 * launches->count : 1;
        launch_row **larger = realloc(self->row, room * sizeof(launch_row *));
        if (!larger)
            return no_memory(self->error);
        self->row = larger;
    }
    launch_row *row = calloc(1, sizeof *row + (size_t)launches->results * sizeof(double));
    if (!row)
        return no_memory(self->error);
    self->row[launches->count] = row;
    row->salvo = (int64_t)launches->count;
    row->number = launches->count++;
    ld_status status = LD_OK;
    for (int i = 0; i < self->columns && !status; i++)
        status = read_field(self, i, row);
    return status;
}

static int by_salvo(const void *left, const void *right)
{
    const launch_row *a = *(launch_row *const *)left, *b = *(launch_row *const *)right;
    int salvo = (a->salvo > b->salvo) - (a->salvo < b->salvo);
    return salvo ? salvo : (a->number > b->number) - (a->number < b->number);
}

// The values that there are of result `index`, salvo by salvo.
static ld_status take_result(launch_reader *self, int index)
{
    measured *launches = self->launches;
    measured_result *result = &launches->result[index];
    result->value = calloc(launches->count, sizeof *result->value);
    result->group = calloc(launches->count, sizeof *result->group);
    result->launch = calloc(launches->count, sizeof *result->launch);
    if (!result->value || !result->group || !result->launch)
        return no_memory(self->error);
    for (size_t i = 0; i < launches->count; i++) {
        const launch_row *row = self->row[i];
        if (isnan(row->value[index]))
            continue;
        result->group[result->count] = row->salvo;
        result->launch[result->count] = row->number;
        result->value[result->count++] = row->value[index];
    }
    if (result->count > 0)
        return LD_OK;
    return ld_fail(self->error, LD_ERR_INPUT, "%.300s: %s: no launch has a value", self->file,
                   result->name);
}

static ld_status read_launches(launch_reader *self)
{
    measured *launches = self->launches;
    ld_status status = read_header(self);
    while (!status && next_line(self))
        status = read_launch(self);
    if (!status && self->at.wrong)
        status = refuse(self, 0, "", self->at.wrong);
    if (!status && launches->count == 0)
        status = refuse(self, 0, "", "no launch follows the header");
    if (status)
        return status;
    qsort(self->row, launches->count, sizeof(launch_row *), by_salvo);
    for (size_t i = 0; self->salvo != NO_RESULT && i < launches->count; i++)
        launches->salvos += i == 0 || self->row[i]->salvo != self->row[i - 1]->salvo;
    for (int i = 0; i < launches->results && !status; i++)
        status = take_result(self, i);
    return status;
}

ld_status measured_read(const char *file, const study_data *data, measured *launches,
                        ld_error *error)
{
    const measured_names names = {"the study has no result", unit_of_result, data};
    return measured_read_named(file, &names, launches, error);
}

ld_status measured_read_named(const char *file, const measured_names *names, measured *launches,
                              ld_error *error)
{
    static const char mark[] = "\xef\xbb\xbf"; // of UTF-8, as spreadsheets write it
    char *text;
    size_t length;
    ld_error why;
    *launches = (measured){0};
    ld_status status = text_file_read(file, MOST_BYTES, &text, &length, &why);
    if (status)
        return ld_fail(error, status, "%.300s %s", file, why.text);
    size_t from = strncmp(text, mark, strlen(mark)) == 0 ? strlen(mark) : 0;
    launch_reader reader = {.file = file,
                            .names = names,
                            .launches = launches,
                            .at = text_lines_begin(text + from, length - from),
                            .salvo = NO_RESULT,
                            .error = error};
    status = read_launches(&reader);
    for (size_t i = 0; i < launches->count; i++)
        free(reader.row[i]);
    free(reader.row);
    free(text);
    if (status)
        measured_free(launches);
    return status;
}

// Moves the result of that name to place `*kept`.
static ld_status keep_result(measured *launches, const char *name, const study_data *data,
                             int *kept, ld_error *error)
{
    const char *nearest;
    const study_column *column = study_data_find(data, name, &nearest);
    name_suggestion suggestion = suggestion_begin(name);
    for (int i = 0; i < launches->results; i++) {
        const measured_result found = launches->result[i];
        suggestion_offer(&suggestion, launches->result[i].name);
        if (strcmp(found.name, column ? column->name : name) != 0)
            continue;
        if (i >= *kept) {
            launches->result[i] = launches->result[*kept];
            launches->result[(*kept)++] = found;
        }
        return LD_OK;
    }
    return ld_fail(error, LD_ERR_INPUT, "--what: no launch was measured for \"%.100s\"%s%s%s", name,
                   suggestion.name ? "; did you mean \"" : "",
                   suggestion.name ? suggestion.name : "", suggestion.name ? "\"?" : "");
}

static void free_result(measured_result *result)
{
    free(result->value);
    free(result->group);
    free(result->launch);
}

ld_status measured_choose(measured *launches, const char *names, const study_data *data,
                          ld_error *error)
{
    int kept = 0;
    char *copy = strdup(names), *rest = NULL;
    ld_status status = copy ? LD_OK : no_memory(error);
    for (char *name = copy ? strtok_r(copy, ", ", &rest) : NULL; name && !status;
         name = strtok_r(NULL, ", ", &rest))
        status = keep_result(launches, name, data, &kept, error);
    free(copy);
    if (!status && kept == 0)
        status = ld_fail(error, LD_ERR_INPUT, "--what: \"%.100s\" names no result", names);
    for (int i = kept; i < launches->results && !status; i++)
        free_result(&launches->result[i]);
    launches->results = status ? launches->results : kept;
    return status;
}

void measured_free(measured *launches)
{
    for (int i = 0; i < launches->results; i++)
        free_result(&launches->result[i]);
    free(launches->result);
    *launches = (measured){0};
}

ld_status measured_compare(const measured_result *result, const study_values *values,
                           measured_comparison *found)
{
    const grouped_values own = {result->value, result->group, result->count};
    const grouped_values simulated = {values->count ? values->value[0] : NULL, values->group,
                                      values->count};
    ld_status status = moments_of(own.value, own.group, own.count, &found->measured);
    if (!status)
        status = moments_of(simulated.value, simulated.group, simulated.count, &found->simulated);
    return status ? status : agreement_of(own, simulated, &found->by);
}
