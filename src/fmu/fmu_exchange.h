// An instance for model exchange: the importer's integrator takes the steps, by states, their rates
// and what goes through zero at events.
#ifndef LD_FMU_FMU_EXCHANGE_H
#define LD_FMU_FMU_EXCHANGE_H

#include "fmu/fmu_instance.h"

// Other than LD_OK, of all: LD_ERR_INPUT, what is called at the wrong time, or one for
// co-simulation; what ended the run. After fmu_go() it is in event mode.

// In continuous-time mode: where the importer is.
ld_status fmu_set_time(fmu_instance *self, double t, ld_error *error);
ld_status fmu_set_states(fmu_instance *self, const double *x, size_t count, ld_error *error);

typedef enum fmu_vector { FMU_STATES, FMU_RATES, FMU_INDICATORS, FMU_NOMINALS } fmu_vector;

// There. LD_ERR_NUMERIC: the equations have no solution, a shorter step may find one.
ld_status fmu_get_vector(fmu_instance *self, fmu_vector which, double *value, size_t count,
                         ld_error *error);
ld_status fmu_count_vector(fmu_instance *self, fmu_vector which, size_t *count, ld_error *error);

// A step has ended; `at_event`: the importer shall enter event mode here.
ld_status fmu_complete_step(fmu_instance *self, bool *at_event, bool *ended, ld_error *error);
ld_status fmu_enter_event_mode(fmu_instance *self, ld_error *error);

// What came of an event.
typedef struct fmu_update {
    bool ended;   // the launch is over
    bool changed; // states or equations may be others: an integrator begins again
    double next;  // [s] on the importer's clock, when a step must end; infinity: not known
} fmu_update;

// In event mode: what happens here happens, by the inputs of now, too.
ld_status fmu_update_states(fmu_instance *self, fmu_update *update, ld_error *error);
ld_status fmu_enter_continuous_time(fmu_instance *self, ld_error *error);

#endif
