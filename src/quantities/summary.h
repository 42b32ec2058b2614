// What came of a run: its rockets, its equilibrium, its energies. To users it is a handle, whose
// numbers have names (launchdyn/summary.h).
#ifndef LD_QUANTITIES_SUMMARY_H
#define LD_QUANTITIES_SUMMARY_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "launchdyn/simulation.h"
#include "model/blocks/limits.h"
#include "model/blocks/mechanism.h"

enum { LD_MAX_MODES = 2 * LD_MAX_BENDING_MODES + LD_MAX_TORSION_MODES + LD_MAX_AXIAL_MODES };

/// Free flight of one rocket, of its mass centre in I against the ground; NaN where it has not
/// landed, or has not flown. The launch point has x and z of the rear adaptor at ignition (of a
/// flight alone: at its start). The apogee is NaN where the flight ended while rising.
typedef struct ld_flight_summary {
    double stability_margin;       ///< [reference diameters] at its start
    double apogee;                 ///< [m] greatest height above environment.ground
    double apogee_altitude;        ///< [m] the same above sea level: sphere or ellipsoid
    double t_apogee;               ///< [s] from ignition
    double downrange, drift;       ///< [m] x and z of the impact from the launch point
    double range;                  ///< [m] distance of the two
    double t_impact;               ///< [s] from ignition
    double time_of_flight;         ///< [s] from t_rear, or from the start of a flight alone
    double impact_speed;           ///< [m/s]
    double impact_angle;           ///< [rad] of the velocity below the horizontal there
    double max_mach;               ///< [-]
    double max_dynamic_pressure;   ///< [Pa]
    double t_max_dynamic_pressure; ///< [s] from ignition
    double max_acceleration;       ///< [m/s2] against inertial axes, at the ends of the steps
    double t_max_acceleration;     ///< [s] from ignition
    double max_angle_of_attack;    ///< [rad] at the ends of the steps
} ld_flight_summary;

/// A parachute that has opened; NaN: it has not.
typedef struct ld_parachute_summary {
    double t_open;   ///< [s] from ignition
    double height;   ///< [m] of the mass centre above the ground (without one, its height)
    double airspeed; ///< [m/s]
    // of a canopy with a mass of its own
    double t_taut;           ///< [s] its lines are taut for the first time
    double snatch;           ///< [N] first maximum of their force
    double greatest_force;   ///< [N]
    double t_greatest_force; ///< [s]
} ld_parachute_summary;

/// What became of a line that the rocket pulled.
typedef struct ld_line_summary {
    double greatest_tension;   ///< [N] of its pull on the rocket in flight
    double t_greatest_tension; ///< [s] from ignition, as all times here
    double paid_out;           ///< [m] unstretched length that has left the container
    double remaining;          ///< [m] in the container
    double t_end;              ///< [s] all of it was out; NaN: it is not
    double t_break;            ///< [s] NaN: it has not broken
    double broken[3];          ///< [m] where it broke, in I
    double broken_at;          ///< [m] along it from the rocket
    double reach;              ///< [m] greatest horizontal distance from the container of the part
                               ///< that hangs on it, at the end
    double t_rest;             ///< [s] it rests, after the landing; NaN: it does not
    /// [m] where it is at the end, in I, at equal parts of its length, the first at the container
    struct {
        double x, y, z;
    } place[LD_LINE_PLACES];
} ld_line_summary;

/// State at the end of a free flight, of the rear adaptor's centre in I against the ground.
typedef struct ld_final_state {
    double t;                    ///< [s] on the run's clock
    double position[3];          ///< [m]
    double velocity[3];          ///< [m/s]
    double quaternion[4];        ///< of B against I, scalar part first
    double rate[3];              ///< [rad/s] of B against I, in B
    double center[3];            ///< [m] mass centre
    double center_velocity[3];   ///< [m/s]
    bool earth;                  ///< a round or WGS 84 Earth: what follows is there
    double latitude, longitude;  ///< [rad] geodetic, of the mass centre
    double altitude;             ///< [m] above the ellipsoid, of the mass centre
    double velocity_ned[3];      ///< [m/s] of the mass centre towards north, east, down there
    double heading, pitch, roll; ///< [rad] against north, up and east there
    double rate_inertial[3];     ///< [rad/s] against inertial axes, in B
} ld_final_state;

/// The rocket's x axis d and mass centre C (the point c(t) of the body, without c_dot) in the axes
/// of the undeformed tube on its base, T, as it stands and moves at that instant. Pitch and yaw as
/// in model.md section 1, of d in T: they keep their meaning however steep the launcher is.
typedef struct ld_tip_off {
    double pitch, yaw;                             ///< [rad]
    double pitch_rate, yaw_rate;                   ///< [rad/s] of d in I: T held still
    double pitch_rate_relative, yaw_rate_relative; ///< [rad/s] T moving
    double vy, vz;                                 ///< [m/s] of C in I, along T's y and z
    double vy_relative, vz_relative;               ///< [m/s] v_C - v_T - w_T x (r_C - r_T)
} ld_tip_off;

/// The same in the launcher's axes at ignition: T as it stood at this rocket's ignition, held still
/// since then. Yaw, pitch, roll: A_TB = Ry(yaw) Rz(pitch) Rx(roll).
typedef struct ld_since_ignition {
    double pitch, yaw, roll;                ///< [rad] roll counts whole turns
    double pitch_rate, yaw_rate, roll_rate; ///< [rad/s]
    double vy, vz;                          ///< [m/s] of C in I, along that T's y and z
} ld_since_ignition;

/// How a hinge of a vehicle was held from a rocket's ignition to its exit.
typedef struct ld_hinge_summary {
    double error_rms;               ///< [rad] command minus measured
    double torque_rms, torque_peak; ///< [N m] on the outboard body
    double saturated;               ///< [s] the torque asked for at its limit
    double power_mean, power_peak;  ///< [W] magnitude of torque times rate of the hinge
} ld_hinge_summary;

/// How a foot of a multibody base stood from a rocket's ignition to its exit.
typedef struct ld_foot_summary {
    double force_peak, force_least; ///< [N] vertical, of the ground on it
} ld_foot_summary;

/// Largest of what the tube carried at a station; NaN where that was not asked for.
typedef struct ld_station_summary {
    double bending;   ///< [N m] magnitude of the bending moment
    double t_bending; ///< [s] when, from ignition
    double shear;     ///< [N] magnitude of the shear force
    double torque;    ///< [N m] magnitude
    double stress;    ///< [Pa] largest bending stress; NaN: the outer fibre is not known
} ld_station_summary;

/// Largest magnitudes of what a support put on the tube; NaN where loads were not asked for.
typedef struct ld_support_summary {
    double force;  ///< [N]
    double moment; ///< [N m] at its station
} ld_support_summary;

/// Attitude, rates and forces of one rocket at its key instants. Instants in [s] from its ignition,
/// NaN where the instant was not reached or does not exist.
typedef struct ld_rocket_summary {
    int tube;                       ///< number of the tube
    double t_ignition;              ///< [s] on the run's clock
    double t_release;               ///< lock release
    double t_front;                 ///< front adaptor (the one farthest forward) leaves the guide
    double t_middle;                ///< middle adaptor (of exactly three) leaves the guide
    double t_rear;                  ///< rear adaptor leaves the guide: the rocket has left
    double t_exit[LD_MAX_ADAPTORS]; ///< the same for every adaptor, in the model's order
    double exit_speed;              ///< [m/s] s_dot at t_rear, relative to the tube
    double inertial_speed;          ///< [m/s] of O1 in I at t_rear
    double spin_rate;               ///< [rad/s] x component of the rate of B against I, in B
    double pitch, yaw;              ///< [rad] of B's x axis in I: model.md section 1
    double pitch_rate, yaw_rate;    ///< [rad/s] their time derivatives
    struct {
        double position[3];   ///< [m] of O1 in I
        double velocity[3];   ///< [m/s] of O1 in I
        double quaternion[4]; ///< B against I
        double rate[3];       ///< [rad/s] of B against I, in B
    } exit;                   ///< the rocket at t_rear, where its flight begins
    struct {
        double y, z;              ///< [m] y_S, z_S
        double psi, theta, gamma; ///< [rad] A_SB = Rz(psi) Ry(theta) Rx(gamma)
        double w_x, w_y, w_z;     ///< [rad/s] rate of B against S, in S
    } relative;                   ///< rocket against the tube's section at t_rear
    struct {
        double y, z;                 ///< [m]
        double pitch, yaw;           ///< [rad]
        double vy, vz;               ///< [m/s]
        double pitch_rate, yaw_rate; ///< [rad/s]
    } tip; ///< tube's tip at t_rear against the undeformed tube on the base, in its axes
    ld_tip_off tip_off;               ///< rocket at t_rear against the undeformed tube on the base
    ld_since_ignition since_ignition; ///< rocket at t_rear in the launcher's axes at ignition
    struct {
        double rates;    ///< [rad/s] of each of tip_off's and since_ignition's
        double yaw_rate; ///< [rad/s] of the rate of yaw in I, which grows towards the vertical
        double relative; ///< [-] of the rates of tip_off together, or of 1 mrad/s
    } exit_error;        ///< what the steps' errors may make of rates at t_rear; NaN: not estimated
    double max_contact_force[LD_MAX_ADAPTORS];   ///< [N] norm of normal force and friction
    double max_slot_force;                       ///< [N] |N|
    double max_pressure;                         ///< [Pa] net
    double max_recoil[LD_MAX_SUPPORTS];          ///< [m] of the slides, in their order
    ld_station_summary station[LD_MAX_STATIONS]; ///< in the model's order
    ld_support_summary support[LD_MAX_SUPPORTS]; ///< in the model's order
    ld_hinge_summary hinge[2];                   ///< azimuth, elevation
    ld_hinge_summary drive[LD_MAX_DRIVES];       ///< of a multibody base, [rad], [N m] or [m], [N]
    ld_foot_summary foot[LD_MAX_FEET];
    double energy_dropped; ///< [J] kinetic, when its tube took the place of the one before: of what
                           ///< moved against the platform
    double measure[LD_MAX_TAKEN]; ///< in the model's order, then figures over time of
                                  ///< expressions; NaN: its instants did not all come
    bool flown;                   ///< it has left the tube and flown: what follows is there
    ld_flight_summary flight;
    ld_parachute_summary parachute[LD_MAX_PARACHUTES]; ///< in the model's order
    ld_line_summary line;                              ///< where the rocket pulls one
    ld_final_state final;
} ld_rocket_summary;

// exit_error.relative above which the rates at an exit are worth a warning.
static const double EXIT_ERROR_NOTED = 0.01;

// Whether a direction of that pitch [rad] in the ground frame lies within 10 deg of the vertical.
// Yaw and roll of the ground frame are singular there, and small turns make large yaw rates.
static inline bool near_vertical(double pitch)
{
    return fabs(pitch) > 80 * 3.14159265358979323846 / 180;
}

enum { LD_MAX_WORKS = 32 };

/// Energy of tube, tail, supports and rocket at the end [J]; `residual` is what the balance misses.
typedef struct ld_energy {
    double kinetic;
    double potential; ///< of tube and tail in gravity, from the origin of I (of the rocket: its
                      ///< work)
    double elastic;   ///< of the tube's modes and the support springs
    /// Work by kind of force since the start, in the state's order; positive: into tube and rocket.
    /// Of a vehicle POWER_BASE is the share of the platform, which the sum leaves out.
    double work[LD_MAX_WORKS];
    double residual;          ///< change of the three above less the sum of the works
    double residual_relative; ///< the same over the largest single work
} ld_energy;

typedef struct ld_statistics {
    int64_t steps;
    int64_t rhs_evaluations;
    double cpu_seconds;       ///< of the run, without set-up and without the history's rows
    double cpu_seconds_setup; ///< modes, coefficients, tables
} ld_statistics;

/// Static equilibrium at the start.
typedef struct ld_equilibrium_summary {
    double lock_force;                     ///< [N] carried by the lock, along +x
    double breech_force;                   ///< [N] of the breech on the rocket, along +x
    double slot_force;                     ///< [N] N
    double contact_force[LD_MAX_ADAPTORS]; ///< [N] normal
    double tip_sag[2];                     ///< [m] y, z of the tip, undeformed tube axes
    double residual;                       ///< [m/s2, rad/s2] largest acceleration at rest
    bool rests_elsewhere;                  ///< the rocket has another rest in its guide
    double taken[4], other[4];             ///< [m, rad] y_S, z_S, psi, theta of both
    int wheel_count;                       ///< 0: the base is not a vehicle
    struct {
        double tyre_force;      ///< [N] vertical
        double tyre_deflection; ///< [m]
        double suspension[3];   ///< [m] travel from the unloaded position, chassis axes
    } wheel[LD_MAX_WHEELS];     ///< in the model's order
    struct {
        double y;           ///< [m] mass centre in I
        double pitch, roll; ///< [rad] of Rz(pitch) Rx(roll)
    } chassis;
    struct {
        double angle;  ///< [rad]
        double torque; ///< [N m] on the outboard body
    } hinge[2];        ///< azimuth, elevation
    struct {
        double measured; ///< [rad], [m]
        double torque;   ///< [N m], [N]
    } drive[LD_MAX_DRIVES];
    double foot_force[LD_MAX_FEET];    ///< [N] vertical
    double strut_force[LD_MAX_STRUTS]; ///< [N] pushing, with that of its actuator
} ld_equilibrium_summary;

struct ld_summary {
    const ld_model *model; ///< of the run: names of its parts; NULL: nothing has run
    int rocket_count;
    ld_rocket_summary rocket[LD_MAX_FIRINGS];
    ld_equilibrium_summary equilibrium;
    ld_energy energy;
    int mode_count;
    ld_mode mode[LD_MAX_MODES]; ///< tube and tail on their supports
    ld_statistics statistics;
    double t_end;  ///< [s] where the run ended, on the run's clock
    bool complete; ///< false: ended early, `stopped` says why
    char stopped[LD_ERROR_TEXT];
    int note_count; ///< remarks the user should see
    char note[8][256];
};

// Adds a remark that the user should see.
void summary_note(ld_summary *summary, const char *format, ...) LD_PRINTF(2, 3);

#endif
