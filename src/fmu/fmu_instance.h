// One instance of an FMU, whatever the version of the interface around it (fmi2.c, fmi3.c): a
// scenario in its folder of resources, whose numbers are set and reported by value reference, and a
// run of it that is stepped, or whose steps the importer takes (fmu_exchange.h).
#ifndef LD_FMU_FMU_INSTANCE_H
#define LD_FMU_FMU_INSTANCE_H

#include <stdbool.h>
#include <stddef.h>

#include "fmu/fmu_variables.h"
#include "launchdyn/status.h"

typedef struct fmu_instance fmu_instance;

// Reads the scenario in the folder `resources`; `exchange`: for model exchange. NULL: why stands in
// `error`.
fmu_instance *fmu_instance_new(const char *resources, const char *token, bool exchange,
                               ld_error *error);
// May be NULL.
void fmu_instance_free(fmu_instance *self);
// As it was when it was new.
ld_status fmu_instance_reset(fmu_instance *self, ld_error *error);

// The value references of the numbers that a variable consists of: an array's elements, or it
// alone. Returns how many.
size_t fmu_elements(const fmu_instance *self, unsigned reference,
                    unsigned element[FMU_LONGEST_ARRAY]);

// A number (of what is true or false 1 or 0) of a type, or a text, by value reference. A text lasts
// until its variable is set. Returns LD_OK; LD_ERR_INPUT: no such variable, or one of another type;
// what ended the run, or why there is none.
ld_status fmu_get_number(fmu_instance *self, unsigned reference, fmu_type type, double *value,
                         ld_error *error);
ld_status fmu_get_text(fmu_instance *self, unsigned reference, const char **text, ld_error *error);

// The same, set: parameters before the run has begun, inputs at any time. Returns LD_OK;
// LD_ERR_INPUT: no such variable, or one that is not to be set now; LD_ERR_MEMORY.
ld_status fmu_set_number(fmu_instance *self, unsigned reference, fmu_type type, double value,
                         ld_error *error);
ld_status fmu_set_text(fmu_instance *self, unsigned reference, const char *text, ld_error *error);

// The importer's clock at the start, and what it wants of the tolerance (0: nothing).
ld_status fmu_set_experiment(fmu_instance *self, double start, double tolerance, ld_error *error);

// Begins the run with the parameters and inputs of now, unless it has begun with these; after
// fmu_go() parameters stand. Until then outputs are those of the start.
ld_status fmu_begin(fmu_instance *self, ld_error *error);
ld_status fmu_go(fmu_instance *self, ld_error *error);

// What came of a step.
typedef struct fmu_step {
    double t;   // [s] where it ended, on the importer's clock
    bool event; // something happened there: ignition, release, an exit, ...
    bool ended; // so has the launch
} fmu_step;

// A step from t, which must be where the last one ended, on by `size`, or where `at_events` to the
// next event on the way. Inputs that were set since the last step hold from its start on; outputs
// that are asked for before it follow them.
ld_status fmu_step_on(fmu_instance *self, double t, double size, bool at_events, fmu_step *step,
                      ld_error *error);

// All that the rest depends on, as bytes, for this instance or another one of the same FMU, to the
// bit.
typedef struct fmu_state {
    size_t size;
    unsigned char bytes[];
} fmu_state;

// To be freed.
ld_status fmu_save(fmu_instance *self, fmu_state **state, ld_error *error);
ld_status fmu_load(fmu_instance *self, const fmu_state *state, ld_error *error);
// From bytes and into them, where there is room for it.
ld_status fmu_state_read(const void *bytes, size_t size, fmu_state **state, ld_error *error);
ld_status fmu_state_write(const fmu_state *state, void *bytes, size_t size, ld_error *error);

// What a call of fmi2.c or fmi3.c needs: an instance `self`, and what it points to; most also that
// it has not been terminated. refuse_call() of that file refuses it.
#define NEEDS(pointers)                                                                            \
    do {                                                                                           \
        if (!self || !(pointers))                                                                  \
            return refuse_call(self, __func__, "a pointer is null");                               \
    } while (0)
#define NEEDS_ALIVE(pointers)                                                                      \
    do {                                                                                           \
        NEEDS(pointers);                                                                           \
        if (self->terminated)                                                                      \
            return refuse_call(self, __func__, "the instance has been terminated");                \
    } while (0)

#endif
