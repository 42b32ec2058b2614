#include "studies/show/show_against.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "quantities/study_results.h"
#include "studies/store/table_file.h"

// ---- what is compared

static const study_column *shown_column(const show_against *self, const char *name)
{
    for (int i = 0; i < self->count; i++)
        if (strcmp(self->column[i]->name, name) == 0)
            return self->column[i];
    return NULL;
}

// Item `i` of those compared, first the results, then the pairs of two of them: how many columns,
// 0 where a pair is not shown.
static int item_columns(const show_against *self, int i, const study_column *column[2])
{
    if (i < self->count) {
        column[0] = self->column[i];
        return 1;
    }
    for (int k = 0; k < 2; k++)
        if (!(column[k] = shown_column(self, study_pairs[i - self->count].name[k])))
            return 0;
    return 2;
}

static int item_count(const show_against *self)
{
    return self->count + STUDY_PAIRS;
}

// Compares item `i` at a point; no groups where there are less than two pairs.
static ld_status compare_item(show_against *self, const study_point *point,
                              const study_column *const *column, int columns, paired_statistics *of,
                              ld_error *error)
{
    paired_values pairs;
    const paired_points points = {self->of->data, point, against_reference(self->of, point)};
    ld_status status = against_read_pairs(&points, column, columns, self->values, &pairs, error);
    if (!status && paired_statistics_of(&pairs, of))
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the study's statistics");
    if (!status && of->groups > 0)
        self->compared++;
    return status;
}

ld_status show_against_each(show_against *self, const study_point *point, show_against_sink *take,
                            void *sink, ld_error *error)
{
    ld_status status = LD_OK;
    if (against_reference(self->of, point) == point)
        return LD_OK;
    for (int i = 0; i < item_count(self) && !status; i++) {
        const study_column *column[2];
        paired_statistics of;
        int columns = item_columns(self, i, column);
        if (columns == 0)
            continue;
        status = compare_item(self, point, column, columns, &of, error);
        if (!status && of.groups > 0)
            take(sink, column, columns, &of);
    }
    return status;
}

// ---- as CSV

static void csv_number(FILE *stream, double value)
{
    if (isnan(value))
        fputc(',', stream);
    else
        fprintf(stream, ",%.17g", value);
}

static void csv_estimate(FILE *stream, estimate e)
{
    csv_number(stream, e.value);
    csv_number(stream, e.low);
    csv_number(stream, e.high);
}

static void csv_header(FILE *stream, const study_data *data)
{
    fputs("point", stream);
    for (int k = 0; k < data->swept_count; k++) {
        fputc(',', stream);
        csv_text(stream, data->swept[k]);
    }
    fputs(",reference,result,unit,pairs,groups", stream);
    static const char *const number[] = {"difference", "ratio", "ratio_within"};
    for (int i = 0; i < 3; i++)
        fprintf(stream, ",%s,%s_low,%s_high", number[i], number[i], number[i]);
    fputc('\n', stream);
}

typedef struct csv {
    FILE *stream;
    const study_data *data;
    const study_point *point, *reference;
} csv;

static void csv_line(void *self, const study_column *const *column, int columns,
                     const paired_statistics *of)
{
    static const estimate none = {NAN, NAN, NAN};
    const csv *into = self;
    FILE *stream = into->stream;
    fprintf(stream, "%" PRId64, into->point->number);
    for (int k = 0; k < into->data->swept_count; k++) {
        fputc(',', stream);
        csv_text(stream, into->point->text[k]);
    }
    fprintf(stream, ",%" PRId64 ",", into->reference->number);
    csv_text(stream, column[0]->name);
    if (columns == 2) {
        fputs(" and ", stream);
        csv_text(stream, column[1]->name);
    }
    fprintf(stream, ",%s,%zu,%zu", column[0]->unit, of->count, of->groups);
    csv_estimate(stream, columns == 1 ? of->difference : none);
    csv_estimate(stream, of->spread);
    csv_estimate(stream, of->within);
    fputc('\n', stream);
}

ld_status show_against_csv(show_against *self, FILE *stream, ld_error *error)
{
    const study_data *data = self->of->data;
    ld_status status = LD_OK;
    csv_header(stream, data);
    for (int p = 0; p < data->point_count && !status; p++) {
        const study_point *point = &data->point[p];
        csv into = {stream, data, point, against_reference(self->of, point)};
        status = show_against_each(self, point, csv_line, &into, error);
    }
    return status;
}
