// A vehicle's chassis, platforms and stabilisers as a mechanism (model.md, section 6): the chassis
// free on the ground, the azimuth platform on it, where there is one, the elevation platform, which
// carries the tubes, on that.
#ifndef LD_SYSTEMS_VEHICLE_MECHANISM_H
#define LD_SYSTEMS_VEHICLE_MECHANISM_H

#include "systems/mechanism/mechanism_build.h"

// Fills the description, from zeros.
void vehicle_describe(const ld_model *model, ld_mechanism *self);
// What its mechanisms are built from.
mechanism_plan vehicle_plan(const ld_model *model, const ld_mechanism *described);
// Gives a mechanism that was built from it the streams of noise of a vehicle's sensors.
void vehicle_name_streams(mechanism_system *self);

#endif
