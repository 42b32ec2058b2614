#include "report/report_study_source.h"

#include <stdio.h>

void study_take_problem(study_source *source, const char *what, const ld_error *error)
{
    report_take_note(source->report, "%s%.230s.", what, error->text);
    if (!source->problem.status)
        source->problem = *error;
}

static void take_damage(study_source *source, study_series *series, const ld_error *error)
{
    char what[128];
    if (series->report_broken)
        return;
    series->report_broken = true;
    snprintf(what, sizeof what,
             "%.60s is damaged, the numbers are of what could be read: ", series->label);
    study_take_problem(source, what, error);
}

void study_read(study_source *source, study_series *series, const study_column *const *column,
                int columns)
{
    ld_error error;
    if (study_data_read(series->data, series->point, column, columns, &series->values, &error))
        take_damage(source, series, &error);
}

void study_read_line(study_source *source, study_series *series)
{
    ld_error error;
    if (study_data_read_line(series->data, series->point, &series->values, &error))
        take_damage(source, series, &error);
}

void study_read_values(study_source *source, study_series *series, const char *const *name,
                       int columns)
{
    const study_column *column[2];
    const char *nearest;
    series->values.count = 0;
    for (int i = 0; i < columns; i++)
        if (!(column[i] = study_data_find(series->data, name[i], &nearest)))
            return;
    study_read(source, series, column, columns);
}
