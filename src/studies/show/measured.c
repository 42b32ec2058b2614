#include "studies/show/measured.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text_file.h"
#include "base/text_lines.h"
#include "scenario/scenario_reader.h"

enum { MOST_BYTES = 64 << 20, NO_RESULT = -1 };

// A line of the file.
typedef struct shot {
    int64_t salvo; // without such a column its number
    size_t number;
    double value[]; // [results] SI; NaN: not measured
} shot;

typedef struct shot_reader {
    const char *file;
    const study_data *data;
    measured *shots;
    text_lines at;
    int columns, salvo;            // columns of the header, and the one of salvos, or NO_RESULT
    int result[TEXT_LINES_FIELDS]; // of each column, or NO_RESULT
    shot **row;                    // [shots->shots]
    ld_error *error;
} shot_reader;

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the measured launches");
}

// "FILE:LINE:COLUMN: NAME: ..."
static ld_status refuse(const shot_reader *self, int field, const char *name, const char *text)
{
    return ld_fail(self->error, LD_ERR_INPUT, "%.300s:%d:%d: %.*s%s%s", self->file, self->at.number,
                   text_lines_column(&self->at, field), MEASURED_NAME, name, name[0] ? ": " : "",
                   text);
}

static bool next_line(shot_reader *self)
{
    return text_lines_next(&self->at, '#', true);
}

// ---- the header

// Takes the unit, what stands behind the name in brackets, of a result in SI unit `target`.
static ld_status read_unit(const shot_reader *self, int field, measured_result *result,
                           const char *target)
{
    char text[256], unknown[32], quoted[64];
    const char *meant = NULL;
    units_result read = units_factor(result->unit, target, &result->factor, unknown);
    if (read == UNITS_OK)
        return LD_OK;
    if (read == UNITS_UNKNOWN)
        meant = units_suggestion(unknown);
    if (!result->unit[0])
        snprintf(text, sizeof text, "no unit; expected one of %s in brackets, such as \"%s [%s]\"",
                 target, result->name, target);
    else if (target[0])
        snprintf(text, sizeof text, "found the unit %s; expected one of %s%s%s%s",
                 reader_quote(result->unit, quoted), target, meant ? ", did you mean \"" : "",
                 meant ? meant : "", meant ? "\"?" : "");
    else
        snprintf(text, sizeof text, "found the unit %s; expected none, or %%",
                 reader_quote(result->unit, quoted));
    return refuse(self, field, result->name, text);
}

static const study_column *find_result(const study_data *data, const char *name,
                                       const char **nearest)
{
    const study_column *column = study_data_find(data, name, nearest);
    return column && !column->factor ? column : NULL;
}

// A column of the header: "name [unit]" or "salvo".
static ld_status read_head(shot_reader *self, int field)
{
    measured *shots = self->shots;
    measured_result *result = &shots->result[shots->results];
    const char *text = self->at.field[field], *nearest = NULL;
    char message[256], quoted[64];
    int end = 0;
    self->result[field] = NO_RESULT;
    if (strcmp(text, "salvo") == 0 && self->salvo == NO_RESULT) {
        self->salvo = field;
        return LD_OK;
    }
    sscanf(text, "%95[^][ \t]%n [%31[^]]]%n", result->name, &end, result->unit, &end);
    if (!result->name[0] || text[end])
        return refuse(self, field, "",
                      "expected a result with its unit, such as \"t_front [ms]\", or \"salvo\"");
    const study_column *column = find_result(self->data, result->name, &nearest);
    if (!column) {
        snprintf(message, sizeof message, "the study has no result %s%s%s%s",
                 reader_quote(result->name, quoted), nearest ? ", did you mean \"" : "",
                 nearest ? nearest : "", nearest ? "\"?" : "");
        return refuse(self, field, "", message);
    }
    for (int i = 0; i < shots->results; i++)
        if (strcmp(shots->result[i].name, result->name) == 0)
            return refuse(self, field, result->name, "is given in an earlier column, too");
    self->result[field] = shots->results++;
    return read_unit(self, field, result, column->unit);
}

static ld_status read_header(shot_reader *self)
{
    ld_status status = LD_OK;
    if (!next_line(self))
        return refuse(self, 0, "", self->at.wrong ? self->at.wrong : "the file is empty");
    self->columns = self->at.count;
    self->shots->result = calloc((size_t)self->columns, sizeof *self->shots->result);
    if (!self->shots->result)
        return no_memory(self->error);
    for (int i = 0; i < self->columns && !status; i++)
        status = read_head(self, i);
    if (!status && self->shots->results == 0)
        status = refuse(self, 0, "", "names no result, such as \"t_front [ms]\"");
    return status;
}

// ---- the shots

static ld_status read_number(const shot_reader *self, int field, const char *name, double *value)
{
    char message[256], quoted[64];
    const char *text = self->at.field[field], *reason, *end = number_parse(text, value, &reason);
    if (end && *end == '\0')
        return LD_OK;
    snprintf(message, sizeof message,
             "found %s%s%s; expected a number, or nothing where there is none",
             reader_quote(text, quoted), reason ? ", " : "", reason ? reason : "");
    return refuse(self, field, name, message);
}

static ld_status read_field(const shot_reader *self, int field, shot *row)
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
    const measured_result *result = &self->shots->result[index];
    ld_status status = text[0] ? read_number(self, field, result->name, &value) : LD_OK;
    row->value[index] = units_scale(value, result->factor);
    if (!status && isinf(row->value[index]))
        return refuse(self, field, result->name, "too large a number");
    return status;
}

static ld_status read_shot(shot_reader *self)
{
    measured *shots = self->shots;
    char message[96];
    if (self->at.count != self->columns) {
        snprintf(message, sizeof message, "found %d fields; expected %d, as in the header",
                 self->at.count, self->columns);
        return refuse(self, 0, "", message);
    }
    // room is doubled at each power of two
    if ((shots->shots & (shots->shots - 1)) == 0) {
        size_t room = shots->shots ? 2 * shots->shots : 1;
        shot **larger = realloc(self->row, room * sizeof(shot *));
        if (!larger)
            return no_memory(self->error);
        self->row = larger;
    }
    shot *row = calloc(1, sizeof *row + (size_t)shots->results * sizeof(double));
    if (!row)
        return no_memory(self->error);
    self->row[shots->shots] = row;
    row->salvo = (int64_t)shots->shots;
    row->number = shots->shots++;
    ld_status status = LD_OK;
    for (int i = 0; i < self->columns && !status; i++)
        status = read_field(self, i, row);
    return status;
}

static int by_salvo(const void *left, const void *right)
{
    const shot *a = *(shot *const *)left, *b = *(shot *const *)right;
    int salvo = (a->salvo > b->salvo) - (a->salvo < b->salvo);
    return salvo ? salvo : (a->number > b->number) - (a->number < b->number);
}

// The values that there are of result `index`, salvo by salvo.
static ld_status take_result(shot_reader *self, int index)
{
    measured *shots = self->shots;
    measured_result *result = &shots->result[index];
    result->value = calloc(shots->shots, sizeof *result->value);
    result->group = calloc(shots->shots, sizeof *result->group);
    if (!result->value || !result->group)
        return no_memory(self->error);
    for (size_t i = 0; i < shots->shots; i++) {
        const shot *row = self->row[i];
        if (isnan(row->value[index]))
            continue;
        result->group[result->count] = row->salvo;
        result->value[result->count++] = row->value[index];
    }
    if (result->count > 0)
        return LD_OK;
    return ld_fail(self->error, LD_ERR_INPUT, "%.300s: %s: no launch has a value", self->file,
                   result->name);
}

static ld_status read_shots(shot_reader *self)
{
    measured *shots = self->shots;
    ld_status status = read_header(self);
    while (!status && next_line(self))
        status = read_shot(self);
    if (!status && self->at.wrong)
        status = refuse(self, 0, "", self->at.wrong);
    if (!status && shots->shots == 0)
        status = refuse(self, 0, "", "no launch follows the header");
    if (status)
        return status;
    qsort(self->row, shots->shots, sizeof(shot *), by_salvo);
    for (size_t i = 0; self->salvo != NO_RESULT && i < shots->shots; i++)
        shots->salvos += i == 0 || self->row[i]->salvo != self->row[i - 1]->salvo;
    for (int i = 0; i < shots->results && !status; i++)
        status = take_result(self, i);
    return status;
}

ld_status measured_read(const char *file, const study_data *data, measured *shots, ld_error *error)
{
    static const char mark[] = "\xef\xbb\xbf"; // of UTF-8, as spreadsheets write it
    char *text;
    size_t length;
    ld_error why;
    *shots = (measured){0};
    ld_status status = text_file_read(file, MOST_BYTES, &text, &length, &why);
    if (status)
        return ld_fail(error, status, "%.300s %s", file, why.text);
    size_t from = strncmp(text, mark, strlen(mark)) == 0 ? strlen(mark) : 0;
    shot_reader reader = {.file = file,
                          .data = data,
                          .shots = shots,
                          .at = text_lines_begin(text + from, length - from),
                          .salvo = NO_RESULT,
                          .error = error};
    status = read_shots(&reader);
    for (size_t i = 0; i < shots->shots; i++)
        free(reader.row[i]);
    free(reader.row);
    free(text);
    if (status)
        measured_free(shots);
    return status;
}

void measured_free(measured *shots)
{
    for (int i = 0; i < shots->results; i++) {
        free(shots->result[i].value);
        free(shots->result[i].group);
    }
    free(shots->result);
    *shots = (measured){0};
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
