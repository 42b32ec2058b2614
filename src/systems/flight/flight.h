// Free flight: the rocket as one rigid body in the air (model.md, section 8).
//
// State (flat array of FLIGHT_STATES), in the axes C of environment/earth.h:
//   r [3] mass centre [m], v [3] its velocity v_O1 + w x c [m/s], q [4] quaternion of N against C,
//   roll [1] angle phi [rad] from N to B, w [3] angular velocity of B against C, in N.
// N has the rocket's x axis but does not turn about it, so A_CB = A_CN Rx(phi): of a rocket that is
// the same all around nothing in the state turns as fast as it spins. With c_dot the rate at which
// the mass centre moves in B as propellant burns, f the force without gravity, g gravity, and m, c,
// J taken as constants at each instant (a_O1 as in model.md, differentiated):
//   r_dot = v + A c_dot,   v_dot = A f/m + g + A (w x c_dot),   J alpha = M_C - w x J w (in B),
//   q_dot = 1/2 q (0, 0, w_y, w_z),   phi_dot = w_x,   w_dot = alpha + w_x e_x x w (in N)
// With jet damping (docs/flight.md) besides, in B, mu = -m_dot what leaves at r_e = r_T, R the
// radius there, and e = r_e - c:
//   f -= 2 w x (m c_dot + mu e),   M_C -= J_dot w + mu (e x (w x e) + R^2/4 (2 w_x, w_y, w_z))
// Air brakes of drag area A add -1/2 rho A |v_a| v_a.x along x of B, v_a the velocity through the
// air. Below a parachute the rocket is a point of its mass: with v_a its velocity through the air
// and A the drag area, v_dot = g - rho A |v_a| v_a/(2 m), r_dot = v; the attitude stays as it was.
// Below a canopy with a mass of its own it stays a rigid body (canopy.h).
// In turbulence two more states: xi_dot = V_m/L_u and V_m/L_w, V_m the speed through the air
// without it.
#ifndef LD_SYSTEMS_FLIGHT_H
#define LD_SYSTEMS_FLIGHT_H

#include <stdbool.h>

#include "elements/air/aerodynamics.h"
#include "elements/motor.h"
#include "environment/atmosphere.h"
#include "environment/earth.h"
#include "environment/turbulence.h"
#include "environment/wind.h"
#include "math/vectors/quaternion.h"

struct flight_line;
struct ld_canopy;
struct ld_flight;
struct ld_rocket;
struct line_bridle;

enum {
    FLIGHT_R = 0,
    FLIGHT_V = 3,
    FLIGHT_Q = 6,
    FLIGHT_ROLL = 10,
    FLIGHT_W = 11,
    FLIGHT_XI = 14,
    FLIGHT_STATES = 16,
    // below a parachute that has them, canopy.h
    FLIGHT_CANOPY_S = FLIGHT_STATES,
    FLIGHT_CANOPY_U = FLIGHT_CANOPY_S + 3,
    FLIGHT_WAY = FLIGHT_CANOPY_U + 3,
    FLIGHT_ALL_STATES,
};

// The numbers that the equations of motion read, all doubles: lanes keep them side by side
// (math/real.h). What does not burn has a thrust of 0.
typedef struct flight_numbers {
    struct {
        double t0;            // [s] where the piece of the thrust curve begins
        double thrust, slope; // [N] there, [N/s]
        double share, rate;   // burnt share of the propellant there; 1 over the total impulse, or
                              // of the piece's own where a table says the masses: 1 over its time
        double power;         // 1: the thrust table has not ended
    } burn;
    double thrust_point[3], thrust_direction[3];
    double exit_square;      // [m2] R^2/4 of the nozzle's exit
    double mass, propellant; // [kg] full; what burns: in all, or in the piece
    double c[3], c_change[3];
    double J[9], J_change[9];
    struct {
        double density, speed_of_sound; // where these do not change with height
        double density_scale, temperature_offset;
        double drag, damping[3]; // as in elements/air/aerodynamics.h
        double half_area, diameter, cant, crossflow_drag, crossflow_at, last_mach;
        double slope_at[LD_MAX_AIR_SURFACES]; // by surface
        double across_at[SURFACES_ACROSS], across[SURFACES_ACROSS];
    } air;
    struct {
        double altitude, gravity, gm, j2, rotation, a, b, e2; // as in environment/earth.h
        double ground;                                        // [m]
        double watched; // [m] steps that end so low are checked; -infinity: none is
    } earth;
    struct {
        double steady[3], scale; // as in environment/wind.h
        double first, last;      // [m] between which the profile has rows
        double axes[9];          // from its axes to those of I on a flat Earth, else from I to E
    } wind;
    struct {
        double open, t0, area, slope; // 1: the rocket hangs below one; [m2] at t0 [s], [m2/s]
    } parachute;
} flight_numbers;

typedef struct flight_system {
    const struct ld_rocket *rocket;
    earth earth;
    atmosphere atmosphere;
    wind wind;
    turbulence turbulence; // none without aerodynamics
    int states;            // 14, or FLIGHT_STATES in turbulence
    aerodynamics aerodynamics;
    motor motor;
    v3 thrust_point;     // [m] in B
    v3 thrust_direction; // unit vector, in B
    bool jet_damping;
    bool parachutes;  // there are some
    bool canopies;    // with a mass of their own
    bool own_filling; // one of them does not fill linearly in time
    bool feels_air;   // of aerodynamics, brakes or parachutes, or its guide does
    bool symmetric;   // the same all around its x axis: nothing depends on the roll angle
    bool feels_shear; // surfaces in a wind that changes with height
    double ground;    // [m] its height: of the plane y, else above sphere or ellipsoid
    bool has_ground;
    flight_numbers number; // before anything burns
} flight_system;

// Of the rocket with this place in the firing sequence, from 0, which decides its turbulence.
ld_status flight_build(flight_system *self, const ld_model *model, int rocket, ld_error *error);
// The same of one that was built, or is all 0: an equal profile of the air is kept.
ld_status flight_renew(flight_system *self, const ld_model *model, int rocket, ld_error *error);
void flight_free(flight_system *self);

// The intervals of the tables that a flight was in last.
typedef struct flight_tables {
    CURVES_KEPT(SURFACES_COLUMNS) aerodynamics;
    CURVES_KEPT(ATMOSPHERE_FUNCTIONS) air;
    CURVES_KEPT(WIND_FUNCTIONS) wind;
} flight_tables;
enum { FLIGHT_TABLES = sizeof(flight_tables) / sizeof(double) };

// The canopy with a mass of its own below which the rocket flies (canopy.h).
typedef struct flight_canopy {
    const struct ld_canopy *given; // NULL: none
    double full;                   // [m2] its drag area then
    double stiffness, damping;     // [N/m], [N.s/m]
    bool taut;                     // its lines
    rocket_mass rocket;            // without it
} flight_canopy;

// How a drag area grows that does not linearly in time: A = A_0 + more x^power, x = per way, the
// way through the air since then (FLIGHT_WAY [m]), or per time.
typedef struct flight_filling {
    double more, per, power; // [m2], [1/m] or [1/s], 0: it does not
    bool by_way;
} flight_filling;

// What is switched between steps.
typedef struct flight_phase {
    double t_ignition; // [s]
    int piece;         // of the thrust curve
    bool burning;
    bool hangs;                      // below a parachute, as a point
    double hangs_since, area, slope; // its drag area [m2] then [s], [m2/s] while it fills
    flight_filling filling;
    flight_canopy canopy;
    double lowest_trigger; // [m] height at or below which a parachute's trigger waits; else -inf
    int changes;           // of the numbers, so far
    const struct flight_line *line; // that the rocket pulls (line.h); NULL: none
    flight_numbers number;
    flight_tables tables;
} flight_phase;

// Begins a piece of the thrust curve (elements/motor.h).
void flight_set_piece(const flight_system *self, flight_phase *phase, int piece);

// The drag area of the parachute that the rocket hangs below, or of its canopy, is `area` [m2] from
// t on.
void flight_hang(const flight_system *self, flight_phase *phase, double t, double area);
// It grows from what it is at t to that of parachute i; when it is full [s], infinity: at once, or
// where it has come so far through the air.
double flight_fill(const flight_system *self, flight_phase *phase, double t, double *state, int i);
// Its value; 0 where the rocket flies on its own. Its rate [m2/s] at a speed through the air [m/s].
double flight_drag_area(const flight_phase *phase, double t, const double *state);
double flight_drag_area_rate(const flight_phase *phase, double t, const double *state,
                             double airspeed);
// What grows with its way is full at 1.
double flight_filled_by_way(const flight_phase *phase, const double *state);

// Drag area of the air brakes [m2], `since` [s] the ignition, at the height [m] above the ground.
double flight_brake_area(const flight_system *self, double since, double height);
// The next time [s] from ignition after `since` at which a schedule over time has a row; infinity.
double flight_next_brake_row(const flight_system *self, double since);

// Derivative of the state.
void flight_rates(const flight_system *self, flight_phase *phase, double t, const double *state,
                  double *state_dot);

// Flights side by side, which flight_is_like allows.
enum { FLIGHT_MOST_LANES = 8, FLIGHT_NUMBERS = sizeof(flight_numbers) / sizeof(double) };
typedef struct flight_lanes {
    const flight_system *system[FLIGHT_MOST_LANES];
    const flight_phase *phase[FLIGHT_MOST_LANES];
    const double *number; // [FLIGHT_NUMBERS][lanes] of the phases
    double *tables;       // [FLIGHT_TABLES][lanes], kept up by all who look them up
} flight_lanes;

// Whether the equations of the two ask for the same functions.
bool flight_is_like(const flight_system *self, const flight_system *other);

// Derivatives of the states [FLIGHT_STATES][lanes] at the times t [lanes], of 4 and 8 lanes; the
// arrays are aligned for these. Each lane has the bits of flight_rates.
void flight_rates_avx2(const flight_lanes *lanes, const double *t, const double *state,
                       double *state_dot);
void flight_rates_avx512(const flight_lanes *lanes, const double *t, const double *state,
                         double *state_dot);

// What has been greatest at the ends of a flight's steps, and when [s], all doubles; the angle of
// attack by the velocity through the air across the rocket's axis and along it.
typedef struct flight_extremes {
    double mach, across, along;
    double pressure, t_pressure;         // [Pa] dynamic
    double acceleration, t_acceleration; // [m2/s4] v_dot . v_dot
    double density;                      // [kg/m3] at the last end
} flight_extremes;

// Steps side by side: arrays of numbers [lanes] and states [FLIGHT_STATES][lanes].
typedef struct flight_step {
    const double *done;        // 1; else there is no step
    const double *t0, *t;      // their beginnings and ends
    const double *y0, *y0_dot; // at their beginnings
    const double *y, *y_dot;   // at their ends
    double *extremes;          // [FLIGHT_EXTREMES][lanes]
} flight_step;
enum { FLIGHT_EXTREMES = sizeof(flight_extremes) / sizeof(double) };

// Takes the ends of steps into the extremes, but for those of which more must be known: those that
// may hold the highest point, the largest Mach number or dynamic pressure, or end on the ground,
// beyond the aerodynamic table or tail first. These are said: bit i for lane i.
unsigned flight_watch(const flight_system *self, flight_phase *phase, const flight_step *step);
unsigned flight_watch_avx2(const flight_lanes *lanes, const flight_step *step);
unsigned flight_watch_avx512(const flight_lanes *lanes, const flight_step *step);

// Whether a flight is getting faster, in a wind that does not change.
bool flight_speeds_up(const flight_system *self, const double *state, const double *state_dot);

// Whether the dynamic pressure may be greatest within a step, one lane: `pressure` at its end,
// density at its beginning and its end.
bool flight_pressure_turns(const flight_system *self, const flight_step *step,
                           const double density[2], double pressure);

// Height of the point r of C over the ground, by which turbulence goes.
double flight_height_over_ground(const flight_system *self, v3 r, double altitude);

// Velocity of turbulence against the ground, in C, at the point r of C, with its scales, where the
// distances flown through the air have come to xi.
v3 flight_turbulence(const flight_system *self, double t, v3 r, double altitude, const double xi[2],
                     turbulence_scales *scales);

// The rocket as the rest of the program knows it: rear adaptor O1 and attitude against the ground.
typedef struct flight_pose {
    v3 r_O1, v_O1; // [m], [m/s] against the ground, in I
    quat q_IB;
    v3 w; // [rad/s] against the inertial axes C, in B
} flight_pose;

void flight_enter(const flight_system *self, const flight_phase *phase, double t,
                  const flight_pose *pose, double *state);
void flight_leave(const flight_system *self, const flight_phase *phase, double t,
                  const double *state, flight_pose *pose);

// The state that a flight alone begins with, at t = 0.
void flight_start(const flight_system *self, const flight_phase *phase,
                  const struct ld_flight *start, double *state);

// Mass centre against the ground, in I.
earth_motion flight_center(const flight_system *self, double t, const double *state);

// Where the mass centre is on a round Earth, and how it and the rocket (A_IB: its attitude) go
// against north, east and down there.
typedef struct flight_place {
    geodetic geodetic;
    v3 velocity_ned;             // [m/s]
    double heading, pitch, roll; // [rad] Ry(-heading) Rz(pitch) Rx(roll) against north, up, east
} flight_place;

flight_place flight_place_at(const flight_system *self, double t, const double *state, m3 A_IB);

// Height of the mass centre, which counts against that of the ground, and its rate: y of I on a
// flat Earth, else the altitude above sphere or ellipsoid.
double flight_height(const flight_system *self, const double *state);
double flight_height_rate(const flight_system *self, const flight_phase *phase, double t,
                          const double *state);

// The point of the rocket at r of B, with its acceleration by the rates of the state; on a flat
// Earth.
struct line_bridle flight_point(const flight_system *self, const flight_phase *phase, double t,
                                const double *state, const double *state_dot, v3 r);

// Flow about the rocket.
typedef struct flight_flow {
    double altitude;        // [m] of the mass centre
    double density;         // [kg/m3]
    double airspeed;        // [m/s]
    double pressure;        // [Pa] dynamic, half the density times the square of that
    double mach;            // 0 without air
    double across, along;   // [m/s] velocity through the air across x of B and along it
    double angle_of_attack; // [rad] between x of B and that velocity, 0 to pi
    v3 wind;                // [m/s] velocity of the air against the ground, in I
} flight_flow;

flight_flow flight_flow_at(const flight_system *self, double t, const double *state);

// The air where a rocket in its tube has its mass centre r [m] of I: as it will be when the flight
// begins, its turbulence that of `left` [m] before the mouth, the way that the rocket has to go.
moving_air flight_air_at(const flight_system *self, double t, v3 r, double left);

// The same without turbulence at a point r of the guide.
moving_air flight_air_about(const flight_system *self, double t, v3 r);

// The turbulence that passes a fixed point r of I with the mean wind there: xi = V_m t/L, [m/s] in
// I.
v3 flight_turbulence_past(const flight_system *self, double t, v3 r);

// The same without turbulence, on a flat Earth.
moving_air flight_steady_air_at(const flight_system *self, double t, v3 r);

// By how many reference diameters the mass centre lies ahead of the centre of pressure at a Mach
// number; NaN where the air's forces have none.
double flight_stability_margin(const flight_system *self, const flight_phase *phase, double t,
                               double mach);

// Mass data and thrust now.
rocket_mass flight_mass(const flight_system *self, const flight_phase *phase, double t);
double flight_thrust(const flight_system *self, const flight_phase *phase, double t);

#endif
