// The canopy of a parachute as a point of mass on lines (model.md, section 8). With m, c, J the
// rocket's mass data at its opening, a the lines' point of it, d = a - c, and m_c the canopy's
// mass:
//   m' = m - m_c,   c' = c - m_c d/m',   J' = J - (m_c m/m') (d^2 E - d d^T)
// is the rocket without it. State, after that of flight.h, in the axes C: canopy against the mass
// centre, s [3] [m], and their velocity u [3] [m/s]. With p = A_CB (a - c'), l = |s - p|, e from
// the rocket to the canopy, L the lines' length, k = EA/L and damping c_d, lines that are taut pull
//   T = k (l - L) + c_d l',   l' = e.(u - w x p),
// until T falls below 0; slack ones are taut again where l > L and T > 0. In air of density rho
// that moves with v_air, A(t) the drag area, V = V_p (A/A_p)^1.5 the volume of air in the canopy:
//   (m_c + rho V) v_c' = m_c g - T e - rho (|v_a| A/2 + V') v_a,   v_a = v_c - v_air
// (the momentum of what is in it; weight and buoyancy of that air cancel). Where it fills over a
// distance, the last state is the way through the air since then [m], of the canopy, or of the
// rocket below a parachute without a mass.
#ifndef LD_SYSTEMS_FLIGHT_CANOPY_H
#define LD_SYSTEMS_FLIGHT_CANOPY_H

#include "systems/flight/flight.h"

// Puts parachute i of the rocket out at t: the rocket's mass data lose it, the state gets its
// places; momentum, and moment of momentum, of the two are those of the rocket before.
void canopy_open(const flight_system *self, flight_phase *phase, int i, double t, double *state);

// The lines become taut, or slack.
void canopy_switch(flight_phase *phase, bool taut);

// Of the lines, as long as they are now.
typedef struct canopy_lines {
    v3 p;           // [m] where they are attached, from the mass centre, in C
    v3 e;           // from there to the canopy
    double stretch; // [m] beyond their length, negative: they are slack
    double tension; // [N] if they were taut; negative: they would push
} canopy_lines;

canopy_lines canopy_lines_at(const flight_phase *phase, const double *state);

// Force of the lines [N].
double canopy_force(const flight_phase *phase, const double *state);

// Volume of the air in it [m3] and its rate at a speed through the air [m/s].
void canopy_volume(const flight_phase *phase, double t, const double *state, double airspeed,
                   double *volume, double *rate);

// Adds the lines' force to the rates of the rocket, and those of the canopy.
void canopy_rates(const flight_system *self, flight_phase *phase, double t, const double *state,
                  double *state_dot);

// Mass centre of the rocket's canopy in C [m].
v3 canopy_place(const double *state);

#endif
