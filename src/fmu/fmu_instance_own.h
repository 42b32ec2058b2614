// What an instance holds: for fmu_instance.c and fmu_exchange.c alone.
#ifndef LD_FMU_FMU_INSTANCE_OWN_H
#define LD_FMU_FMU_INSTANCE_OWN_H

#include "fmu/fmu_variables.h"
#include "launch/launch_exchange.h"
#include "model/fields/source.h"

// Where an importer that takes the steps is.
typedef struct fmu_exchange {
    bool is;         // the instance is one for model exchange
    bool continuous; // it is in continuous-time mode, not in event mode
    bool moved;      // the run has not received what follows, or the base
    double t;        // [s] on the importer's clock
    double x[LD_MAX_STATES];
} fmu_exchange;

struct fmu_instance {
    ld_source *source; // the scenario's texts
    uint64_t scenario; // digest of what was understood
    fmu_part part;
    fmu_variables variables;

    // what was set: [variables.count], by value reference
    double *number; // NaN of what is calculated
    char **text;    // NULL: as at the start
    bool *changed;
    double tolerance; // that the importer requires; 0: the scenario's
    double start;     // [s] on the importer's clock; NaN: that of the run

    ld_model *model;
    ld_simulation *simulation;
    uint64_t built_with; // digest of the parameters that these have
    void *run;           // of variables.runner; NULL: not begun with what was set
    bool going;
    double ahead;                    // [s] of the importer's clock against the run's
    bool inputs_set;                 // since the last step
    double inputs[FMU_MOST_NUMBERS]; // what the run received last, and when
    double inputs_at;                // [s] on the run's clock
    bool lit;                        // the input of the last step
    // outputs at the present, by index, where they have been asked for (`known`)
    double *row, *result, outputs[FMU_MOST_NUMBERS];
    struct {
        bool row, result, outputs;
    } known;

    fmu_exchange exchange; // of an instance for model exchange
};

typedef struct fmu_instance fmu_instance;

// The present is another one: no output is known.
void fmu_forget_outputs(fmu_instance *self);

// The run is that of other inputs or parameters: fmu_begin() begins another one.
void fmu_end_run(fmu_instance *self);

// Ignites the rocket where the input has become true since the last step; then `*lit` becomes true.
ld_status fmu_ignite(fmu_instance *self, bool *lit, ld_error *error);

// The run is where an importer is that takes the steps: time, states and inputs.
ld_status fmu_place(fmu_instance *self, ld_error *error);

// Rates and event indicators there; after the launch an importer's states stand still.
ld_status fmu_rates(fmu_instance *self, double *rates, ld_error *error);
ld_status fmu_indicators(fmu_instance *self, double *values, ld_error *error);

#endif
