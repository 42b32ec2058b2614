#include "studies/run/sample_source.h"

bool source_continues(const source_end *self, const ld_study_options *options)
{
    return !self->stopped && (!options->go_on || options->go_on(options->self));
}

void source_end_with(source_end *self, ld_status status, const ld_error *error)
{
    if (!self->status) {
        self->status = status;
        *self->error = *error;
    }
    self->stopped = true;
}

bool source_end_by(source_end *self, const study_record *record)
{
    ld_error error;
    if (record->outcome == LD_ERR_INTERRUPTED)
        self->stopped = true;
    else if (record->outcome == LD_ERR_MEMORY)
        source_end_with(self, ld_fail(&error, LD_ERR_MEMORY, "%s", record->reason), &error);
    else
        return false;
    return true;
}
