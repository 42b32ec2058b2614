// A model's parts and what it has, for sources that read some of it: they include the headers of
// the blocks that they read, not model.h. That one is for those who make, fill or check a model.
#ifndef LD_MODEL_PARTS_H
#define LD_MODEL_PARTS_H

#include <stdbool.h>

#include "launchdyn/model.h"

const char *model_title(const ld_model *model); // NULL: none
double model_gravity(const ld_model *model);    // [m/s2]
int model_firing_count(const ld_model *model);  // 0: a flight alone
int model_measure_count(const ld_model *model); // user-defined results
int model_sweep_count(const ld_model *model);   // axes

const struct ld_base *model_base(const ld_model *model);
const struct ld_environment *model_environment(const ld_model *model);
const struct ld_flight *model_flight(const ld_model *model);
const struct ld_optimise *model_optimise(const ld_model *model);
const struct ld_platform *model_platform(const ld_model *model);
const struct ld_rocket *model_rocket(const ld_model *model);
const struct ld_run_settings *model_run(const ld_model *model);
const struct ld_scatter *model_scatter(const ld_model *model);
const struct ld_tubes *model_tubes(const ld_model *model);
// The list that begins with entry `i`, from 0.
const struct ld_firing *model_firing(const ld_model *model, int i);
const struct ld_measure *model_measure(const ld_model *model, int i);
const struct ld_sweep_axis *model_sweep(const ld_model *model, int i);

// False: a flight alone.
bool model_has_launcher(const ld_model *model);
// Whether the base is externally driven; makes it one that is.
bool model_base_is_external(const ld_model *model);
void model_make_base_external(ld_model *model);
// Whether the motion of the base is a function of time alone.
bool model_base_goes_by_time(const ld_model *model);
// Whether the base is a vehicle, which has wheels, hinges and tubes beside the one that launches.
bool model_has_vehicle(const ld_model *model);
// The vehicle's hinges from the chassis on: azimuth, where it has one, and elevation.
int model_hinge_count(const ld_model *model);
const struct ld_turret *model_hinge(const ld_model *model, int i);
const char *model_hinge_name(const ld_model *model, int i);
// Whether the base is one of bodies, joints and force elements.
bool model_has_multibody(const ld_model *model);
// Whether the rocket's shoes slide on surfaces, not in a bore.
bool model_has_surfaces(const ld_model *model);
// What guides the rocket, in a word.
const char *model_guide_word(const ld_model *model);
// Whether the rocket's knob follows a slot.
bool model_has_slot(const ld_model *model);
// Whether the air acts on what has come out of the tube.
bool model_has_crossflow(const ld_model *model);
// Whether the air acts on the whole rocket on its guide: that is open, not a bore.
bool model_has_open_air(const ld_model *model);
// Whether the guide itself feels the air.
bool model_has_guide_wind(const ld_model *model);
// Whether the rocket feels the air before its release.
bool model_feels_air(const ld_model *model);
// Whether the jet of the rocket that has left acts on its guide.
bool model_has_guide_jet(const ld_model *model);
// Whether jets act on anything.
bool model_has_jets(const ld_model *model);
// Whether the jets of rockets that have left act on the platform.
bool model_has_jet(const ld_model *model);
// Whether a pressure drives the rocket out of its tube.
bool model_has_pressure(const ld_model *model);
// How many supports are slides on which the tube recoils.
int model_slide_count(const ld_model *model);

#endif
