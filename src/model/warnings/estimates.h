// Estimates from a model's keys that several rules of plausibility share.
#ifndef LD_MODEL_ESTIMATES_H
#define LD_MODEL_ESTIMATES_H

#include "launchdyn/model.h"
#include "model/blocks/motor.h"
#include "model/blocks/tubes.h"

// Radius of the bore at the rear end [m]; NaN on surfaces and in a flight alone.
double estimate_bore(const ld_model *model);
// Mass of a tube with its point masses and tail [kg].
double estimate_tube_mass(const ld_tubes *tubes);
// Greatest thrust [N], integral of the thrust [N s] and its end [s], with their scales; 0 without.
double estimate_peak_thrust(const ld_motor *motor);
double estimate_impulse(const ld_motor *motor);
double estimate_burn_time(const ld_motor *motor);
// Greatest force of the pressure behind the rocket, and with the greatest thrust [N]; 0 without.
double estimate_peak_pressure(const ld_model *model);
double estimate_peak_drive(const ld_model *model);
// Weight of the full rocket along the tube, backwards [N], where the tube is lowest; NaN where its
// elevation is not known.
double estimate_weight_along(const ld_model *model);
// Time [s] that the rocket at least needs to leave the tube by its greatest drive; NaN: it cannot.
double estimate_time_in_tube(const ld_model *model);
// x of the foremost adaptor [m]; NaN in a flight alone.
double estimate_front(const ld_model *model);
// Moment of inertia [kg m2] of tubes and rockets about the elevation hinge, of rods of the tubes'
// length about their middles.
double estimate_tubes_inertia(const ld_model *model);
// Mass of platforms, tubes and rockets [kg]; with the chassis, what the suspensions carry.
double estimate_carried_mass(const ld_model *model);
double estimate_sprung_mass(const ld_model *model);
// Heave frequency [Hz] of a vehicle on its suspensions.
double estimate_heave_frequency(const ld_model *model);

#endif
