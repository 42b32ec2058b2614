#include "compare/comparison.h"

#include <stdarg.h>
#include <stdlib.h>

#include "compare/measured_log.h"

void comparison_note(ld_comparison *self, const char *format, ...)
{
    if (self->notes == COMPARISON_NOTES)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(self->note[self->notes++], COMPARISON_NOTE, format, arguments);
    va_end(arguments);
}

ld_status run_values_make(run_values *values, const measured_log *log, ld_error *error)
{
    *values = (run_values){
        .reading = calloc((size_t)log->sensors * log->rows + 1, sizeof *values->reading),
        .result = calloc((size_t)log->results + 1, sizeof *values->result)};
    if (values->reading && values->result)
        return LD_OK;
    run_values_free(values);
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the values of a run");
}

void run_values_free(run_values *values)
{
    free(values->reading);
    free(values->result);
    *values = (run_values){0};
}

void ld_comparison_free(ld_comparison *self)
{
    if (!self)
        return;
    for (int k = 0; self->series && k < self->log.sensors; k++)
        free((double *)self->series[k].t);
    free(self->series);
    free(self->result);
    free(self->result_head);
    free(self->t);
    free(self->compared);
    run_values_free(&self->nominal);
    run_values_free(&self->u_num);
    run_values_free(&self->u_input);
    run_series_free(&self->run);
    measured_log_free(&self->log);
    history_free(&self->history);
    free(self);
}

const ld_compared_series *ld_comparison_series(const ld_comparison *self, int index)
{
    return index >= 0 && index < self->log.sensors ? &self->series[index] : NULL;
}

const ld_compared_result *ld_comparison_result(const ld_comparison *self, int index)
{
    return index >= 0 && index < self->log.results ? &self->result[index] : NULL;
}

const ld_compared_clock *ld_comparison_clock(const ld_comparison *self)
{
    return &self->clock;
}

const char *ld_comparison_note(const ld_comparison *self, int index)
{
    return index >= 0 && index < self->notes ? self->note[index] : NULL;
}
