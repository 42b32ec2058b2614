// Quantities estimated from a model's keys, which rules of plausibility compare.
#ifndef LD_MODEL_ESTIMATES_H
#define LD_MODEL_ESTIMATES_H

#include "model/warnings/plausible_rule.h"

// The estimate with that name; NaN: there is none here.
double estimate_named(const char *name, const plausible_entry *at);

// Radius of the bore at the rear end [m]; NaN on surfaces and in a flight alone.
double estimate_bore(const plausible_entry *at);
// Mass of a tube with its point masses and tail [kg].
double estimate_tube_mass(const plausible_entry *at);
// Greatest thrust [N] and integral of the thrust [N s], with their scales; 0 without.
double estimate_peak_thrust(const plausible_entry *at);
double estimate_impulse(const plausible_entry *at);
// Weight of the full rocket along the tube, backwards [N], where the tube is lowest; NaN where its
// elevation is not known.
double estimate_weight_along(const plausible_entry *at);
// Shortest time [s] in which the rocket can leave the tube; NaN: it cannot, or there is none.
double estimate_time_in_tube(const plausible_entry *at);
// x of the foremost adaptor [m]; NaN in a flight alone.
double estimate_front(const plausible_entry *at);

#endif
