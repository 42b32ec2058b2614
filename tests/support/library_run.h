// A launch that the library steps itself, beside one that an FMU does.
#ifndef LD_TESTS_SUPPORT_LIBRARY_RUN_H
#define LD_TESTS_SUPPORT_LIBRARY_RUN_H

#include "launchdyn/run.h"
#include "launchdyn/scenario.h"
#include "support/check.h"

typedef struct library {
    ld_model *model;
    ld_simulation *simulation;
    ld_run *run;
} library;

// Of the scenario file with what is set over it; base: as ld_run_options has it.
static inline library library_begin(const char *path, const char *const *set, size_t sets,
                                    const ld_base_frame *base)
{
    library self;
    ld_messages messages;
    ld_error error;
    assert_int_equal(ld_scenario_read(path, set, sets, &self.model, &messages), LD_OK);
    assert_int_equal(ld_simulation_create(self.model, &self.simulation, &error), LD_OK);
    assert_int_equal(
        ld_run_begin(self.simulation, &(ld_run_options){.base = base}, &self.run, &error), LD_OK);
    return self;
}

static inline void library_end(library *self)
{
    ld_run_end(self->run, NULL, NULL);
    ld_simulation_free(self->simulation);
    ld_model_free(self->model);
}

#endif
