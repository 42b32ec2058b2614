/// The model as a whole, for those who make, fill, copy or check one: what a scenario says,
/// validated, as plain data in SI units and radians. Who reads a part of it includes model/parts.h
/// and the header of that block in model/blocks/: a key of another block does not recompile it.
///
/// A model is constant while it runs. It is read from a scenario, or filled by hand in tests,
/// starting from model_init(). To users it is a handle (launchdyn/model.h). Counts say how many
/// entries of a fixed array are used; tables are pointers to memory that the model owns (see
/// model_clear()). Frames: `I` inertial (x forward, y up, z right), `B` rocket (origin at the rear
/// adaptor's centre, x along the axis, forward), tube axes (origin at the undeformed tube's rear
/// end, x along it).
#ifndef LD_MODEL_MODEL_H
#define LD_MODEL_MODEL_H

#include <stdbool.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"
#include "model/blocks/base.h"
#include "model/blocks/environment.h"
#include "model/blocks/firing.h"
#include "model/blocks/flight.h"
#include "model/blocks/measure.h"
#include "model/blocks/optimise.h"
#include "model/blocks/platform.h"
#include "model/blocks/rocket.h"
#include "model/blocks/run.h"
#include "model/blocks/study.h"
#include "model/blocks/tubes.h"

struct ld_model {
    char *title;
    double gravity; ///< [m/s2]
    ld_environment environment;
    ld_base base;
    ld_platform platform; ///< of a vehicle
    ld_tubes tubes;
    ld_rocket rocket;
    ld_flight flight; ///< of a flight alone
    int firing_count;
    ld_firing firing[LD_MAX_FIRINGS];
    ld_firing_order firing_order;
    const ld_rocket *salvo; ///< [firing_count] rocket of each firing where they differ in numbers,
                            ///< not owned; NULL: each is `rocket`
    ld_run_settings run;
    int measure_count;
    ld_measure measure[LD_MAX_MEASURES];
    ld_scatter scatter; ///< for studies
    int sweep_count;
    ld_sweep_axis *sweep; ///< for studies, owned by the model; its points are read by
                          ///< scenario_read_point()
    ld_optimise optimise;
    ld_source *source; ///< what it was read from, shared; NULL: filled by hand
    struct {
        bool ground_height, empty_mass, empty_center[3], empty_inertia[3], propellant, stuck_time,
            max_step;
    } completed; ///< what model_complete() has filled in: model_forget()
    int point;   ///< of the sweep that its values are those of; 0: nominal
    int sample;  ///< whose drawn numbers it has, of its point; 0: nominal
};

/// Fills `model` with the defaults of the scenario language (no tables, no title); numbers without
/// a default become NaN.
void model_init(ld_model *model);

/// Computes what follows from the rest: the stiffnesses and masses of sections that are given by
/// radii or areas; the firings of an order of tubes; where they are NaN, the values of the empty
/// rocket (as the full ones), rocket.propellant = full.mass - empty.mass, run.stuck_time = end of
/// the tables of thrust and pressure + 1 s, without any 10 s, and run.max_step = 0.2 ms
/// (tolerance/1e-5)^(1/5), at least 0.2 ms; of a flight alone, what its rocket lacks: a motor
/// (absent), the mass centre (0), and the end at the tip (landing); the ground's height where it is
/// NaN (0, on a round Earth the site's altitude). The scenario reader has done it already.
void model_complete(ld_model *model);

/// Makes NaN again what model_complete() has filled in, so that it follows from other numbers when
/// that is called again.
void model_forget(ld_model *model);

/// Frees the title, the tables, what `model` owns for studies and its share of `source`, and resets
/// it to the defaults.
void model_clear(ld_model *model);

/// Checks that the values of `model` fit together and are finite and in range; for models filled by
/// hand (the scenario reader has its own messages with line and column).
ld_status model_check(const ld_model *model, ld_error *error);

/// The same of a model that a study has drawn from one that was checked, but for the keys of the
/// study itself.
ld_status model_check_drawn(const ld_model *model, ld_error *error);

#endif
