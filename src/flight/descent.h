// What happens to a parachute within the steps of a flight (systems/flight/canopy.h): when the
// lines of a canopy become taut or slack, their greatest forces, when it is full by its way.
#ifndef LD_FLIGHT_DESCENT_H
#define LD_FLIGHT_DESCENT_H

#include "integration/dormand_prince.h"
#include "quantities/summary.h"
#include "systems/flight/flight.h"

typedef struct descent {
    double t_switch;     // [s] at the end of the last step the lines become taut or slack; NaN: not
    double t_full;       // [s] at its end what fills over a distance is full; NaN: not
    bool filling, taken; // since the lines were first taut; their first maximum is known
} descent;

// Of a parachute that has just come out.
descent descent_none(void);

// Absolute tolerances of the states below a parachute by the relative one.
void descent_set_tolerances(const flight_system *system, dormand_prince *steps, double tolerance);

// The latest end of the next step.
double descent_stop(const flight_phase *phase, const dormand_prince *steps);

// After a step: it ends where the lines become taut or slack in it, or what fills is full.
void descent_locate(descent *self, const flight_phase *phase, dormand_prince *steps);

// The forces in it, the flight's clock from `t_ignition`.
void descent_watch(descent *self, const flight_phase *phase, dormand_prince *steps,
                   double t_ignition, ld_parachute_summary *out);

#endif
