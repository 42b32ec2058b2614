/// The model: what a scenario says, validated, as plain data in SI units and radians.
///
/// A model is constant while it runs. It is read from a scenario, or filled by hand in tests,
/// starting from model_init(). To users it is a handle (launchdyn/model.h). Counts say how many
/// entries of a fixed array are used; tables are pointers to memory that the model owns (see
/// model_clear()). Frames: `I` inertial (x forward, y up, z right), `B` rocket (origin at the rear
/// adaptor's centre, x along the axis, forward), tube axes (origin at the undeformed tube's rear
/// end, x along it).
#ifndef LD_MODEL_MODEL_H
#define LD_MODEL_MODEL_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "launchdyn/model.h"
#include "launchdyn/section.h"
#include "launchdyn/status.h"

enum {
    LD_MAX_SECTIONS = 32,
    LD_MAX_POINT_MASSES = 16,
    LD_MAX_SUPPORTS = 8,
    LD_MAX_CLAMPED_STATIONS = 4, ///< supports with directions held rigidly
    LD_MAX_CLAMPED = 12,         ///< such directions in all
    LD_MAX_STATIONS = 16,
    LD_MAX_ADAPTORS = 8,
    LD_MAX_PARACHUTES = 8,
    LD_MAX_SURFACES = 12,
    LD_MAX_AIR_SURFACES = 8, ///< nose, body, tail, fins
    LD_MAX_SINES = 16,
    LD_MAX_SEA_RESPONSES = 37, ///< headings at which a ship's response is given
    LD_MAX_WHEELS = 32,
    LD_MAX_BUMPS = 16,
    LD_MAX_TUBES = 512,
    LD_MAX_FIRINGS = 64,
    LD_MAX_BENDING_MODES = 24,
    LD_MAX_TORSION_MODES = 8,
    LD_MAX_AXIAL_MODES = 8,
    LD_MAX_GUSTS = 16,
    LD_MAX_NAME = 64,
    LD_MAX_PATH = 128,
    LD_MAX_TOGETHER = 8,
    LD_MAX_CHOICES = 32,
    LD_MAX_UNTIL = 16,
    LD_MAX_MEASURES = 40,
    LD_MAX_QUANTITY = 96,
    LD_MAX_CORRELATED = 16,
    LD_MAX_POINTS = 10000,
};

/// A numeric table, row by row, `rows` x `columns`, owned by its model. Empty: rows = 0.
typedef struct ld_table {
    size_t rows;
    size_t columns;
    double *data;
} ld_table;

/// One sinusoid `amplitude sin(2 pi frequency t + phase)`.
typedef struct ld_sine {
    double amplitude; ///< [m] or [rad]
    double frequency; ///< [Hz], cycles per second
    double phase;     ///< [rad]
} ld_sine;

typedef struct ld_sines {
    int count;
    ld_sine term[LD_MAX_SINES];
} ld_sines;

typedef enum ld_earth_model {
    LD_EARTH_FLAT,  ///< I is inertial, gravity is constant
    LD_EARTH_ROUND, ///< sphere, central gravitation, rotating
    LD_EARTH_WGS84, ///< ellipsoid, gravitation with J2, rotating
    LD_EARTH_GIVEN, ///< `model` with the numbers of ld_earth
} ld_earth_model;

/// Figure and gravitation of the Earth: model.md, section 8. NaN: the value of the model.
typedef struct ld_earth {
    ld_earth_model kind;
    ld_earth_model model; ///< of LD_EARTH_GIVEN: LD_EARTH_ROUND or LD_EARTH_WGS84
    double gm;            ///< [m3/s2]
    double j2;            ///< [-]
    double rotation;      ///< [rad/s]
    double radius;        ///< [m] of the sphere, or of the equator
} ld_earth;

/// Where the origin of I is on the Earth, and where its x axis points.
typedef struct ld_site {
    bool present;               ///< false: the numbers below are 0, the azimuth a quarter turn
    double latitude, longitude; ///< [rad] geodetic
    double altitude;            ///< [m] above the ellipsoid
    double azimuth;             ///< [rad] of x, clockwise from north
} ld_site;

typedef enum ld_atmosphere_kind {
    LD_ATMOSPHERE_US1976,
    LD_ATMOSPHERE_NONE,
    LD_ATMOSPHERE_UNIFORM,
    LD_ATMOSPHERE_PROFILE,
} ld_atmosphere_kind;

typedef struct ld_atmosphere {
    ld_atmosphere_kind kind;
    double density;            ///< [kg/m3] (uniform)
    double speed_of_sound;     ///< [m/s] (uniform)
    double density_scale;      ///< [-] factor on the density
    double temperature_offset; ///< [K] added at unchanged pressure (us1976, profile)
    ld_table profile; ///< measured: altitude [m], pressure [Pa], temperature [K] and, where
                      ///< it has a fourth column, relative humidity over water [-]
} ld_atmosphere;

/// Half-cosine up, constant, half-cosine down, uniform in space.
typedef struct ld_gust {
    double start;   ///< [s] on the run's clock
    double rise;    ///< [s]
    double hold;    ///< [s]
    double fall;    ///< [s], NaN: as rise
    double speed;   ///< [m/s]
    double heading; ///< [rad] where it goes to
} ld_gust;

typedef enum ld_turbulence_model { LD_TURBULENCE_DRYDEN } ld_turbulence_model;

typedef struct ld_turbulence {
    bool present;
    ld_turbulence_model model;
    double wind_at_6m; ///< [m/s] scales it, adds no wind
    int seed;
    int harmonics; ///< cells of the spectrum
} ld_turbulence;

typedef enum ld_wind_axes { LD_WIND_LAUNCHER, LD_WIND_GEOGRAPHIC } ld_wind_axes;

/// Velocity of the air, where it goes to: model.md, section 8. Headings from I's x axis, positive
/// to the right; geographic: from north, positive to the east.
typedef struct ld_wind {
    bool present;
    ld_wind_axes axes;
    double speed;     ///< [m/s] without profile: the same at every height
    double heading;   ///< [rad]
    ld_table profile; ///< height above ground [m], along x, along z [m/s]; geographic: altitude
                      ///< [m], north, east; pchip, constant outside
    double scale;     ///< [-] factor on speed or profile
    double add[3];    ///< [m/s] added then, along x, y, z; geographic: north, up, east
    int gust_count;
    ld_gust gust[LD_MAX_GUSTS];
    ld_turbulence turbulence;
} ld_wind;

typedef enum ld_ground_kind { LD_GROUND_PLANE, LD_GROUND_NONE } ld_ground_kind;

/// What free flight goes through.
typedef struct ld_environment {
    ld_earth earth;
    ld_site site;
    ld_atmosphere atmosphere;
    ld_ground_kind ground;
    double ground_height; ///< [m] y of the ground's plane, on a round Earth its height above sphere
                          ///< or ellipsoid; NaN: see model_complete()
    ld_wind wind;
} ld_environment;

/// What carries the tube: a kind, its word, its number in digests. External: told where it is by
/// whoever runs the launch, step by step. FMU: one of other people's, stepped beside the launch.
#define LD_BASE_KINDS(KIND)                                                                        \
    KIND(LD_BASE_FIXED, fixed, 0)                                                                  \
    KIND(LD_BASE_PRESCRIBED, prescribed, 1)                                                        \
    KIND(LD_BASE_VEHICLE, vehicle, 2)                                                              \
    KIND(LD_BASE_EXTERNAL, external, 4)                                                            \
    KIND(LD_BASE_FMU, fmu, 5)

#define LD_BASE_KIND_NUMBER(name, word, number) name = (number),
typedef enum ld_base_kind {
    LD_BASE_KINDS(LD_BASE_KIND_NUMBER) LD_BASE_NONE = 3, ///< no launcher: a flight alone
} ld_base_kind;

/// What a base without wheels is drawn as; nothing of its mechanics.
typedef enum ld_looks { LD_LOOKS_PLAIN, LD_LOOKS_SHIP, LD_LOOKS_AIRCRAFT } ld_looks;

/// How an external base goes on between the instants at which it is told.
typedef enum ld_extrapolation {
    LD_EXTRAPOLATION_ACCELERATION, ///< with the acceleration that its last two velocities tell
    LD_EXTRAPOLATION_VELOCITY,     ///< with its last velocity
} ld_extrapolation;

/// One sinusoid of a road, `amplitude sin(2 pi x/wavelength + phase)`, on both tracks.
typedef struct ld_road_sine {
    double amplitude;  ///< [m]
    double wavelength; ///< [m]
    double phase;      ///< [rad]
} ld_road_sine;

typedef enum ld_track { LD_TRACK_BOTH, LD_TRACK_LEFT, LD_TRACK_RIGHT } ld_track;

/// `height/2 (1 - cos(2 pi (x - at)/length))` for at < x < at + length.
typedef struct ld_bump {
    double at;     ///< [m] x of I
    double length; ///< [m]
    double height; ///< [m], negative: a hole
    ld_track tracks;
} ld_bump;

typedef enum ld_tracks { LD_TRACKS_SAME, LD_TRACKS_INDEPENDENT, LD_TRACKS_COHERENT } ld_tracks;

enum { LD_ROAD_SMOOTH = -1 };

typedef enum ld_road_form { LD_ROAD_SUM, LD_ROAD_FLAT } ld_road_form;

/// Height of the road over x of I, of the left track and the right one: the sum of what is given
/// (model.md, section 7); a flat road has nothing of it.
typedef struct ld_road {
    ld_road_form form;
    int iso_class; ///< ISO 8608: 0 (A) to 7 (H); LD_ROAD_SMOOTH: no random part
    ld_tracks tracks;
    ld_table coherence; ///< n [1/m], g [-] with coherence g^2 (coherent); linear, constant outside
    int seed;
    int harmonics;         ///< N
    double wavelengths[2]; ///< [m] shortest, longest
    int sine_count;
    ld_road_sine sine[LD_MAX_SINES];
    int bump_count;
    ld_bump bump[LD_MAX_BUMPS];
    ld_table profile; ///< x [m], h [m] of both tracks, or x, left, right; cubic spline (not a
                      ///< knot), constant outside
    double places[2]; ///< [m] z of the tracks, left, right, chassis axes: between them the height
                      ///< is linear; NaN: wheels with mount z < 0 are on the left one
} ld_road;

typedef struct ld_wheel {
    char name[LD_MAX_NAME];
    double mount[3]; ///< [m] wheel centre with unloaded suspension, chassis axes from its mass
                     ///< centre
    double mass;     ///< [kg]
    bool driven;
} ld_wheel;

/// Spring-damper between chassis and wheel, chassis axes; bump stops add `stiffness` times what
/// the travel along y exceeds `compression` (wheel up) or `extension` (wheel down).
typedef struct ld_suspension {
    double stiffness[3]; ///< [N/m]
    double damping[3];   ///< [N s/m]
    struct {
        double compression, extension; ///< [m] from the unloaded position, > 0; NaN: no stop
        double stiffness;              ///< [N/m]
    } bump_stop;
} ld_suspension;

typedef struct ld_tyre {
    double radius;            ///< [m] R
    double stiffness[3];      ///< [N/m] along, vertical, across
    double damping[3];        ///< [N s/m]
    double relaxation_length; ///< [m] sigma
    double friction;          ///< [-] mu
} ld_tyre;

/// Holds the marching speed: F = kp (speed - v) + ki z_d, shared among the driven wheels.
typedef struct ld_drive {
    double kp; ///< [N s/m]
    double ki; ///< [N/m]
} ld_drive;

/// Wheels, suspension, tyres and road of a vehicle: model.md, section 7.
typedef struct ld_vehicle {
    double speed; ///< [m/s] marching speed, >= 0; 0: parked
    ld_road road;
    ld_drive drive;
    int wheel_count;
    ld_wheel wheel[LD_MAX_WHEELS];
    ld_suspension suspension;
    ld_tyre tyre;
} ld_vehicle;

/// Two loops in place of a stabiliser's kp, ki, kd: the angle's gives the rate's command.
typedef struct ld_cascade {
    bool present;
    double kp;      ///< [1/s]
    double rate_kp; ///< [N m s/rad]
    double rate_ki; ///< [N m/rad]
} ld_cascade;

/// What a sensor of angle and rate does to each of its samples.
typedef struct ld_sensor_noise {
    double angle; ///< [rad] rms
    double rate;  ///< [rad/s] rms
    int seed;
} ld_sensor_noise;
typedef struct ld_resolution {
    double angle; ///< [rad] 0: none
    double rate;  ///< [rad/s] 0: none
} ld_resolution;

/// Between a drive's motor and its hinge, all as seen from the hinge.
typedef struct ld_gear {
    bool present;
    double stiffness; ///< [N m/rad]
    double damping;   ///< [N m s/rad]
    double inertia;   ///< [kg m2] of the motor
    double backlash;  ///< [rad] free travel between both sides of the teeth
} ld_gear;

/// Moves a platform to its commanded angle: model.md, section 6.
typedef struct ld_stabiliser {
    ld_table command;    ///< t [s], pitch or yaw [rad]; one row: constant; linear between rows,
                         ///< constant outside
    double kp;           ///< [N m/rad]
    double ki;           ///< [N m/(rad s)]
    double kd;           ///< [N m s/rad]
    double torque_limit; ///< [N m]; a locked hinge needs none of these four
    double feedforward;  ///< [-] of the chassis' rate along the hinge, against it a rate command
    ld_cascade cascade;
    double bandwidth; ///< [Hz] of the actuator's lag; 0: none
    double slew;      ///< [N m/s] greatest rate of the lagging torque; 0: any
    double sample;    ///< [s] period of a digital loop; 0: continuous
    double delay;     ///< [s] from a sample until its torque is given out, <= sample
    ld_sensor_noise noise;
    ld_resolution resolution;
    ld_gear gear;
} ld_stabiliser;

typedef struct ld_hinge_friction {
    double viscous; ///< [N m s/rad]
    double coulomb; ///< [N m]
    double rate;    ///< [rad/s] w_eps, at which Coulomb friction is at 71 %
} ld_hinge_friction;

/// Spring-damper in place of a stabiliser, at rest in the equilibrium.
typedef struct ld_hinge_lock {
    bool present;
    double stiffness; ///< [N m/rad]
    double damping;   ///< [N m s/rad]
} ld_hinge_lock;

/// A platform and the hinge that carries it: azimuth about y, elevation about z.
typedef struct ld_turret {
    double hinge_at[3]; ///< [m] in the axes of the body that carries it, from that one's origin
                        ///< (the chassis' is its mass centre)
    double mass;        ///< [kg] of the frame, without any tube
    double center[3];   ///< [m] mass centre from its hinge, own axes
    double inertia[3];  ///< [kg m2] about its own mass centre
    ld_stabiliser stabiliser;
    ld_hinge_friction friction;
    ld_hinge_lock lock;
} ld_turret;

/// Chassis, azimuth and elevation platform: model.md, section 6.
typedef struct ld_platform {
    double chassis_mass;       ///< [kg]
    double chassis_inertia[3]; ///< [kg m2]
    ld_table jet;     ///< distance from a tube's mouth [m], force of a jet [N]; empty: none
    double jet_scale; ///< [-] factor on the force
    ld_turret azimuth;
    ld_turret elevation;
} ld_platform;

/// What of its motion and of the wrench on it a base says and hears by variables of an FMU.
typedef enum ld_fmu_quantity {
    LD_FMU_POSITION,                         ///< [m] x, y, z
    LD_FMU_QUATERNION = LD_FMU_POSITION + 3, ///< scalar first
    LD_FMU_ANGLES = LD_FMU_QUATERNION + 4,   ///< [rad] yaw, pitch, roll, in place of it
    LD_FMU_VELOCITY = LD_FMU_ANGLES + 3,     ///< [m/s]
    LD_FMU_RATE = LD_FMU_VELOCITY + 3,       ///< [rad/s]
    LD_FMU_FORCE = LD_FMU_RATE + 3,          ///< [N]
    LD_FMU_MOMENT = LD_FMU_FORCE + 3,        ///< [N m]
    LD_FMU_QUANTITIES = LD_FMU_MOMENT + 3
} ld_fmu_quantity;

typedef struct ld_fmu_parameter {
    char *name;   ///< of the FMU's variable, owned by the model
    double value; ///< in the FMU's unit; NaN: a text is given
    char *text;   ///< owned by the model; NULL: a number is given
} ld_fmu_parameter;

/// How an FMU takes inputs between the instants at which they are set.
typedef enum ld_fmu_inputs {
    LD_FMU_HELD,         ///< it holds them
    LD_FMU_EXTRAPOLATED, ///< it goes on with them as the last ones tell
} ld_fmu_inputs;

/// In which axes an FMU tells its angular velocity.
typedef enum ld_fmu_axes { LD_FMU_AXES_OF_I, LD_FMU_AXES_OF_BODY } ld_fmu_axes;

enum { LD_MAX_FMU_PARAMETERS = 64 };

/// An FMU that carries the tube: fmi.md.
typedef struct ld_fmu_base {
    char *file;        ///< full path, owned by the model
    char *digest;      ///< of the file, "FNV-1a DIGEST of SIZE bytes", owned by the model
    double step;       ///< [s] between two instants at which pose and wrench are exchanged
    double start_time; ///< [s] of its own clock when the run begins
    double time_limit; ///< [s] longest that a call of one of its functions may take
    ld_fmu_inputs inputs;
    ld_fmu_axes rate_axes;
    struct { ///< names of variables with blanks between, owned by the model; NULL: as our vehicle's
        char *position, *quaternion, *angles, *velocity, *angular_rate, *force, *moment;
    } connect;
    int parameter_count;
    ld_fmu_parameter parameter[LD_MAX_FMU_PARAMETERS];
} ld_fmu_base;

typedef enum ld_sea_spectrum {
    LD_SEA_JONSWAP,
    LD_SEA_PIERSON_MOSKOWITZ,
    LD_SEA_REGULAR, ///< one wave
} ld_sea_spectrum;

/// How a ship moves in a wave of unit amplitude that goes to `heading`: its place and attitude are
/// those amplitudes, and lead the crest at its reference point by those phases.
typedef struct ld_sea_response {
    double heading; ///< [rad] from x, 0 to pi; NaN: the sea's
    ld_table table; ///< omega [rad/s] of the wave; amplitude [-], phase [rad] of surge, sway,
                    ///< heave, amplitude [rad/m], phase [rad] of roll, pitch, yaw
} ld_sea_response;

/// Sea on deep water and the ship's response to it: sea.md.
typedef struct ld_sea {
    bool present;
    ld_sea_spectrum spectrum;
    double height;     ///< [m] significant, from trough to crest; of one wave its own
    double period;     ///< [s] of the spectrum's peak, of one wave its own
    double peakedness; ///< [-] JONSWAP's gamma
    double heading;    ///< [rad] where it goes to, from x, positive to the right
    double spreading;  ///< [-] s of cos^2s(angle/2) about the heading; NaN: all go there
    int waves;
    int seed;
    int response_count;
    ld_sea_response response[LD_MAX_SEA_RESPONSES];
} ld_sea;

/// The base that carries the tube: model.md, section 2.
typedef struct ld_base {
    ld_base_kind kind;
    double azimuth;              ///< [rad] of the tube against the base, about +y
    double elevation;            ///< [rad] of the tube against the base, about +z
    double velocity[3];          ///< [m/s] constant velocity along I (prescribed)
    ld_sines surge, heave, sway; ///< [m] along I's x, y, z (prescribed)
    ld_sines yaw, pitch, roll;   ///< [rad] base pose Ry(yaw) Rz(pitch) Rx(roll) (prescribed)
    ld_table motion;      ///< t [s], x, y, z [m], yaw, pitch, roll [rad] or q0, q1, q2, q3; cubic
                          ///< spline; empty: none
    double motion_origin; ///< [s] whole seconds that are left out of its times; 0 but of late ones
    double motion_start;  ///< [s] of the table's clock: 0 of the run's
    ld_sea sea;           ///< added to sines and velocity (prescribed)
    double at[3]; ///< [m] T's origin in the frame that moves so, or that an FMU tells (prescribed,
                  ///< fmu)
    ld_vehicle vehicle;
    ld_extrapolation extrapolation; ///< (external)
    ld_fmu_base fmu;
    ld_looks looks; ///< (not of a vehicle)
} ld_base;

/// Isotropic material of the tube; NaN: not given.
typedef struct ld_material {
    double youngs_modulus; ///< [Pa] E
    double poisson_ratio;  ///< [-] nu; G = E/(2 (1 + nu))
    double shear_modulus;  ///< [Pa] G, in place of nu
    double density;        ///< [kg/m3]
} ld_material;

typedef struct ld_point_mass {
    double at;   ///< [m] station
    double mass; ///< [kg]
} ld_point_mass;

typedef struct ld_modes {
    int bending; ///< modes per plane
    int torsion;
    int axial;
    int elements; ///< finite elements along the tube (at least; section steps add nodes)
    ld_mode_span span;
    double damping; ///< [-] ratio, of the clamped modes of the bare tube
} ld_modes;

typedef struct ld_tail {
    double mass;       ///< [kg], may be 0
    double center;     ///< [m] x of the mass centre in the rear section's frame (negative: behind)
    double inertia[3]; ///< [kg m2] about its own mass centre, tube axes
} ld_tail;

/// A slide on which the tube recoils along its x against a support: model.md, section 4.
typedef struct ld_recoil {
    bool present;
    double preload;           ///< [N] towards battery
    double stiffness;         ///< [N/m] of the recuperator
    double damping;           ///< [N s/m]
    double quadratic_damping; ///< [N s2/m2]
    double friction;          ///< [N]
    double friction_speed;    ///< [m/s] at which the friction is at 71 %
    double stroke;            ///< [m] from one stop to the other; NaN: no stop behind
} ld_recoil;

/// Spring-damper between the tube's section at `at` and the base: model.md, section 4.
typedef struct ld_support {
    double at;                      ///< [m] station
    double stiffness[3];            ///< [N/m]
    double damping[3];              ///< [N s/m]
    double rotational_stiffness[3]; ///< [N m/rad]
    double rotational_damping[3];   ///< [N m s/rad]
    ld_recoil recoil;               ///< along x, between stops of that stiffness and damping
    unsigned clamped; ///< directions that are held rigidly: bits of ld_clamp; of these no spring
} ld_support;

/// Directions of a support, along and about the tube's axes.
typedef enum ld_clamp {
    LD_CLAMP_X,
    LD_CLAMP_Y,
    LD_CLAMP_Z,
    LD_CLAMP_ROLL,
    LD_CLAMP_YAW,   ///< about y
    LD_CLAMP_PITCH, ///< about z
    LD_CLAMPS
} ld_clamp;

/// Whether a support holds a direction rigidly.
static inline bool support_clamps(const ld_support *support, ld_clamp direction)
{
    return support->clamped >> direction & 1u;
}

/// Spring along or about an axis: 0 in directions held rigidly and where none is given.
static inline double support_spring(const ld_support *support, ld_clamp direction)
{
    if (support_clamps(support, direction))
        return 0;
    if (direction >= LD_CLAMP_ROLL)
        return support->rotational_stiffness[direction - LD_CLAMP_ROLL];
    double along = support->stiffness[direction];
    return along >= 0 ? along : 0;
}

/// Where it is asked for what the tube carries.
typedef struct ld_station {
    double at;             ///< [m] station
    double outer_fibre[2]; ///< [m] along y, z from the elastic axis; NaN: that of a ring, or none
} ld_station;

typedef enum ld_slot_kind { LD_SLOT_NONE, LD_SLOT_HELIX } ld_slot_kind;

typedef struct ld_slot {
    ld_slot_kind kind;
    ld_table angle;  ///< s [m], alpha [rad]; one row: constant; linear between, constant outside
    double radius;   ///< [m] R_k, of the knob's circle
    double friction; ///< [-] mu_s
} ld_slot;

typedef enum ld_pressure_form {
    LD_PRESSURE_OVER_TIME,
    LD_PRESSURE_OVER_TRAVEL,
    LD_PRESSURE_OF_GAS,
} ld_pressure_form;

/// Pressure on the rocket's rear while it is in its tube: model.md, section 5.
typedef struct ld_pressure {
    bool present;
    ld_pressure_form form;
    ld_table over_time;   ///< t [s] since the ignition, p [Pa]; linear between, 0 after the last; a
                          ///< time given twice is a jump
    ld_table over_travel; ///< s - start_at [m], p [Pa]; pchip, up to the tip
    double scale;         ///< [-] factor on the pressure
    double pressure;      ///< [Pa] p_0 of cold gas, absolute
    double volume;        ///< [m3] V_0 at the start
    double exponent;      ///< [-] kappa
    double ambient;       ///< [Pa] p_a, before the rocket
} ld_pressure;

typedef enum ld_surface_shape {
    LD_SURFACE_FLAT,  ///< the shoe's point beside the surface's counts: roll opens and closes gaps
    LD_SURFACE_ROUND, ///< the shoe's centre counts: roll changes nothing
} ld_surface_shape;

/// A surface on which every shoe slides: model.md, section 5.
typedef struct ld_surface {
    char name[LD_MAX_NAME];
    double at[2];  ///< [m] y, z of a point of it, from the guide line
    double normal; ///< [rad] of the normal from shoe to surface, from y towards z
    double gap;    ///< [m] between a shoe in its centred place and the surface
    ld_surface_shape shape;
} ld_surface;

/// Six flat surfaces: over, under and beside both lips of a slot.
typedef struct ld_t_slot {
    double at[2];    ///< [m] y, z of its middle, from the guide line
    double lips;     ///< [m] from one lip's middle to the other's, along z
    double gap;      ///< [m] over and under the lips
    double side_gap; ///< [m] on either side
} ld_t_slot;

/// Round surfaces around the guide line, evenly spaced.
typedef struct ld_tower {
    int rails;
    double first;  ///< [rad] of the first rail, from y towards z
    double gap;    ///< [m] radial
    double radius; ///< [m] from the guide line to the rails' surfaces, where friction acts
} ld_tower;

typedef enum ld_guide_form {
    LD_GUIDE_SURFACES,
    LD_GUIDE_T_SLOT,
    LD_GUIDE_TOWER,
} ld_guide_form;

/// What guides the rocket. Of surfaces: guide_surfaces() in model/guide.h makes one list of each
/// form.
typedef struct ld_guide {
    bool present; ///< false: a bore, with a radial clearance for each adaptor
    ld_guide_form form;
    double line[2]; ///< [m] y, z of the guide line, from the elastic axis
    int surface_count;
    ld_surface surface[LD_MAX_SURFACES];
    ld_t_slot t_slot;
    ld_tower tower;
} ld_guide;

typedef struct ld_layout {
    int rows, columns;
    double pitch;    ///< [m]
    double first[3]; ///< [m] rear end of tube 1, platform axes
} ld_layout;

typedef struct ld_tubes {
    ld_layout layout;
    int empty_count;
    int empty[LD_MAX_TUBES]; ///< numbers of the tubes without a rocket from the start
    double length;           ///< [m]
    ld_material material;
    int section_count;
    ld_section section[LD_MAX_SECTIONS];
    int point_mass_count;
    ld_point_mass point_mass[LD_MAX_POINT_MASSES];
    ld_modes modes;
    ld_tail tail;
    int support_count;
    ld_support support[LD_MAX_SUPPORTS];
    int station_count;
    ld_station station[LD_MAX_STATIONS];
    ld_slot slot;
    ld_pressure pressure;
    ld_guide guide;
} ld_tubes;

/// Mass data of the rocket at one instant.
typedef struct ld_mass_data {
    double mass;       ///< [kg]
    double center[3];  ///< [m] in B
    double inertia[3]; ///< [kg m2] about the mass centre, in B
} ld_mass_data;

typedef struct ld_adaptor {
    char name[LD_MAX_NAME];
    double at;        ///< [m] l_i, from the rear adaptor
    double clearance; ///< [m] radial; not used by laws that hold on both sides, NaN there if not
                      ///< given. On surfaces: added to their gaps at this shoe, NaN: nothing
} ld_adaptor;

/// The contact laws, the first by default: each with its word and its traits. Their forces stand in
/// elements/guide/contact.h; of one that holds on both sides that of an adaptor in
/// elements/guide/adaptor.h (bilateral) and elements/guide/ideal.h.
#define LD_CONTACT_LAWS(LAW)                                                                       \
    LAW(LD_CONTACT_HUNT_CROSSLEY, "hunt-crossley", 0)                                              \
    LAW(LD_CONTACT_LANKARANI_NIKRAVESH, "lankarani-nikravesh", LD_CONTACT_BY_TOUCH)                \
    LAW(LD_CONTACT_KELVIN_VOIGT, "kelvin-voigt", LD_CONTACT_LINEAR)                                \
    LAW(LD_CONTACT_BILATERAL, "bilateral", LD_CONTACT_LINEAR | LD_CONTACT_TWO_SIDED)               \
    LAW(LD_CONTACT_IDEAL, "ideal", LD_CONTACT_TWO_SIDED | LD_CONTACT_HELD)

#define LD_CONTACT_LAW_NAME(name, word, traits) name,
typedef enum ld_contact_law { LD_CONTACT_LAWS(LD_CONTACT_LAW_NAME) } ld_contact_law;

enum {
    LD_CONTACT_LINEAR = 1,    ///< its exponent is 1, it damps by its own coefficient
    LD_CONTACT_TWO_SIDED = 2, ///< holds the adaptor on the axis, without clearance
    LD_CONTACT_BY_TOUCH = 4,  ///< depends on the speed at first touch
    LD_CONTACT_HELD = 8,      ///< holds it there exactly, by constraints: no stiffness
};

/// Whether a law has a trait.
static inline bool contact_has(ld_contact_law law, unsigned trait)
{
#define LD_CONTACT_LAW_TRAITS(name, word, traits) traits,
    static const unsigned of[] = {LD_CONTACT_LAWS(LD_CONTACT_LAW_TRAITS)};
    return of[law] & trait;
}

/// Contact between adaptors and tube: model.md, section 5.
typedef struct ld_contact {
    ld_contact_law law;
    double stiffness;             ///< [N/m] k; NaN if not given (ideal: of the breech alone)
    double exponent;              ///< [-] n
    double reference_penetration; ///< [m] d_0
    double restitution;           ///< [-] e
    double reference_speed;       ///< [m/s] v_0
    double damping;               ///< [N s/m] c, of the laws kelvin-voigt and bilateral
    double friction;              ///< [-] mu
    double friction_speed;        ///< [m/s] v_eps, of tube contact and slot
} ld_contact;

typedef enum ld_hold { LD_HOLD_BY_GUIDE, LD_HOLD_YES, LD_HOLD_NO } ld_hold;

typedef struct ld_lock {
    bool present;         ///< false: the rocket is free from the start
    double release_force; ///< [N]
    double hold_down;     ///< [s] from ignition, before which it lets go under no force; 0: never
    double x, radius,
        angle;          ///< [m], [m], [rad] of the point held, in B: (x, radius cos, radius sin)
    ld_hold holds_roll; ///< by the guide: yes without slot and flat surfaces
} ld_lock;

/// Whether free flight counts what the gas that flows takes along and the rates of m, c and J.
typedef enum ld_jet_damping { LD_JET_DAMPING_NO, LD_JET_DAMPING_YES } ld_jet_damping;

typedef struct ld_motor {
    bool absent;            ///< no motor (flight alone, or a launch by pressure)
    ld_table thrust;        ///< t [s], T [N]; linear between, 0 after the last; a double time jumps
    double at[3];           ///< [m] x_T, e_y, e_z in B
    double misalignment[2]; ///< [-] eps_y, eps_z
    double thrust_scale;    ///< [-]
    double time_scale;      ///< [-]
    ld_jet_damping jet_damping;
    double exit_radius; ///< [m] of the nozzle, for jet damping
    ld_table masses;    ///< t [s], m [kg], x [m], J_x, J_t [kg m2] of the part of the rocket that
                        ///< loses mass; linear between, constant before and after. Empty: what
                        ///< burns goes with the impulse
    double masses_at;   ///< [m] x of B from which the table counts its centres
} ld_motor;

typedef enum ld_aerodynamic_model {
    LD_AERODYNAMICS_TABLE,
    LD_AERODYNAMICS_BODY,
    LD_AERODYNAMICS_SURFACES
} ld_aerodynamic_model;

typedef enum ld_air_surface_kind {
    LD_AIR_COEFFICIENTS, ///< slope and roll given
    LD_AIR_NOSE,         ///< the others by their shape
    LD_AIR_BODY,
    LD_AIR_TAIL,
    LD_AIR_FINS
} ld_air_surface_kind;

typedef enum ld_nose_shape {
    LD_NOSE_CONE,
    LD_NOSE_OGIVE, ///< tangent
    LD_NOSE_VON_KARMAN,
    LD_NOSE_HAACK, ///< of least drag for length and volume
    LD_NOSE_ELLIPSOID,
    LD_NOSE_PARABOLOID
} ld_nose_shape;

/// One of the surfaces that carry the lateral force of the air.
typedef struct ld_air_surface {
    char name[LD_MAX_NAME];
    ld_air_surface_kind kind;
    double at;          ///< [m] x of B of the force, or of the front end of nose, body, tail, fins
    double slope_scale; ///< [-] factor on the slope
    // coefficients
    ld_table slope;        ///< mach, cn_alpha [1/rad]
    double area;           ///< [m2] of the coefficients; NaN: that of reference_diameter
    ld_table roll_forcing; ///< mach, cl_delta [1/rad]; no rows: 0
    ld_table roll_damping; ///< mach, cl_p [-]; no rows: 0
    // nose, body, tail
    ld_nose_shape shape;
    double length, radius;            ///< [m]; of fins the radius of the body that they stand on
    double front_radius, rear_radius; ///< [m] of a tail
    double body_lift;                 ///< [-] K of K A_plan/S sin^2
    // fins
    int count;
    double root_chord, tip_chord, span, sweep_length; ///< [m]
    double cant; ///< [rad] positive: spins about +x; of coefficients, too
} ld_air_surface;

typedef enum ld_interpolation { LD_PCHIP, LD_SPLINE, LD_LINEAR } ld_interpolation;

typedef enum ld_beyond_table { LD_BEYOND_ERROR, LD_BEYOND_HOLD } ld_beyond_table;

/// Air forces in free flight: model.md, section 8.
typedef struct ld_aerodynamics {
    bool present;
    ld_aerodynamic_model model;
    // coefficients over the Mach number
    double reference_diameter; ///< [m]
    double fin_cant;           ///< [rad] positive: spins about +x
    ld_interpolation interpolation;
    ld_beyond_table beyond_table; ///< past the last Mach number
    ld_table table;  ///< mach, ca_power_off, ca_power_on, cn_alpha [1/rad], x_cp [m forward of the
                     ///< rear adaptor], cl_delta [1/rad], cl_p, cm_q
    double ca_scale; ///< [-] factor on both ca
    double cn_scale; ///< [-] factor on cn_alpha
    double x_cp_shift; ///< [m] added to x_cp
    struct {
        bool present;
        double drag; ///< [-] C_c
        double at;   ///< [m] x of B
    } crossflow;
    struct {
        bool present;
        double nose;     ///< [m] x of B
        double drag;     ///< [-] C_c
        double diameter; ///< [m] D; NaN: reference_diameter
    } emerged;           ///< the air on what has come out of the tube, while the rocket is in it
    // plain body: drag and damping at the mass centre
    double area;       ///< [m2]
    double drag;       ///< [-] C_D
    double damping[3]; ///< [-] C_i, about x, y, z of B
    double lengths[3]; ///< [m] l_i
    // by surface
    ld_table axial; ///< mach, ca; or mach, ca_power_off, ca_power_on
    int surface_count;
    ld_air_surface surface[LD_MAX_AIR_SURFACES];
} ld_aerodynamics;

typedef enum ld_trigger { LD_TRIGGER_APOGEE, LD_TRIGGER_TIME, LD_TRIGGER_HEIGHT } ld_trigger;

/// A parachute, which takes the place of the one before it: model.md, section 8.
typedef struct ld_parachute {
    char name[LD_MAX_NAME];
    double drag_area; ///< [m2] C_D S when full, with all that hangs below it
    ld_trigger trigger;
    double time;    ///< [s] from ignition
    double height;  ///< [m] above the ground, falling
    double lag;     ///< [s] from the trigger until it opens
    double filling; ///< [s] in which the drag area grows, linearly
} ld_parachute;

typedef enum ld_brakes_form { LD_BRAKES_OVER_TIME, LD_BRAKES_OVER_HEIGHT } ld_brakes_form;

/// Drag of surfaces that are put out by a schedule, in free flight: model.md, section 8.
typedef struct ld_air_brakes {
    bool present;
    ld_brakes_form form;
    ld_table over_time;   ///< t [s] from ignition, A [m2]; linear between, constant outside
    ld_table over_height; ///< h [m] of the mass centre above the ground, A [m2]; likewise
    double scale;         ///< [-] on the area
} ld_air_brakes;

typedef struct ld_rocket {
    double start_at; ///< [m] s of the rear adaptor at the start
    ld_mass_data full;
    ld_mass_data empty;
    double propellant;           ///< [kg] burnt mass; NaN: see model_complete()
    double products[3];          ///< [kg m2] J_xy, J_xz, J_yz of the matrix, full and empty
    double dynamic_imbalance[2]; ///< [-] delta_y, delta_z: the inertia's x axis points along
                                 ///< (1, delta_y, delta_z) of B, turned the shortest way
    double mass_error;           ///< [kg] at the mass centre, added to full and empty
    double eccentricity[2];      ///< [m] y, z, added to full and empty
    int adaptor_count;
    ld_adaptor adaptor[LD_MAX_ADAPTORS]; ///< the first is the rear one
    ld_contact contact;
    double knob_angle; ///< [rad] gamma_b
    ld_lock lock;
    ld_motor motor;
    ld_aerodynamics aerodynamics;
    ld_air_brakes air_brakes;
    int parachute_count;
    ld_parachute parachute[LD_MAX_PARACHUTES];
} ld_rocket;

typedef enum ld_flight_point { LD_POINT_REAR, LD_POINT_CENTER } ld_flight_point;
typedef enum ld_rate_against { LD_AGAINST_INERTIAL, LD_AGAINST_EARTH } ld_rate_against;
typedef enum ld_attitude_form {
    LD_ATTITUDE_YAW,        ///< against I: Ry(yaw) Rz(pitch) Rx(roll)
    LD_ATTITUDE_HEADING,    ///< against north, up, east there: Ry(-heading) Rz(pitch) Rx(roll)
    LD_ATTITUDE_QUATERNION, ///< of B against I
} ld_attitude_form;

/// State at t = 0 of a flight alone (base.kind = LD_BASE_NONE). Velocities are relative
/// to the Earth; what is NaN is not given.
typedef struct ld_flight {
    double ignition;       ///< [s] on the run's clock
    ld_flight_point point; ///< which position and velocity belong to: O1 or the mass centre
    double position[3];    ///< [m] in I
    struct {
        bool present;               ///< in place of position
        double latitude, longitude; ///< [rad]
        double altitude;            ///< [m] above the ellipsoid
    } geodetic;
    double velocity[3];     ///< [m/s] in I
    double speed;           ///< [m/s] along x of B, in place of velocity
    double velocity_ned[3]; ///< [m/s] north, east, down, in place of velocity
    ld_attitude_form attitude;
    double yaw, heading, pitch, roll; ///< [rad]
    double quaternion[4];             ///< scalar part first; not NaN: in place of the angles
    double rate[3];                   ///< [rad/s] of B, in B
    ld_rate_against rate_against;
} ld_flight;

typedef struct ld_firing {
    int tube;  ///< number from 1
    double at; ///< [s] on the run's clock
} ld_firing;

/// The firings as an order of tubes at one interval; where it is present, model_complete() makes
/// the list of firings from it.
typedef struct ld_firing_order {
    bool present;
    int tube_count;
    int tube[LD_MAX_FIRINGS]; ///< numbers from 1
    double start;             ///< [s] first ignition, on the run's clock
    double interval;          ///< [s] from one ignition to the next
} ld_firing_order;

typedef enum ld_start { LD_START_EQUILIBRIUM, LD_START_UNDEFORMED } ld_start;
typedef enum ld_formulation { LD_FORMULATION_REDUCED, LD_FORMULATION_OVERALL } ld_formulation;
typedef enum ld_lead_in_method { LD_LEAD_IN_EXPLICIT, LD_LEAD_IN_EXPONENTIAL } ld_lead_in_method;
typedef enum ld_exit_error { LD_EXIT_ERROR_NO, LD_EXIT_ERROR_YES } ld_exit_error;
typedef enum ld_end { LD_END_TIP, LD_END_TIME, LD_END_LANDING, LD_END_APOGEE } ld_end;

typedef struct ld_run_settings {
    ld_start start;
    ld_formulation formulation;
    double lead_in;                   ///< [s]
    ld_lead_in_method lead_in_method; ///< while no rocket is driven through its tube
    ld_end end;
    double end_time;            ///< [s] after the last ignition (LD_END_TIME)
    double tolerance;           ///< [-] relative tolerance of the integrator
    ld_exit_error exit_error;   ///< whether the steps' error in the rates at the exit is estimated
    double max_step;            ///< [s] longest step until the last rocket has left its tube; NaN:
                                ///< see model_complete()
    double output_step_lead_in; ///< [s]
    double output_step_tube;    ///< [s]
    double output_step_flight;  ///< [s]
    double stuck_time;   ///< [s] after ignition at which a rocket still in the tube is given up;
                         ///< NaN: see model_complete()
    double flight_limit; ///< [s] longest free flight
    double flight_tolerance; ///< [-] relative tolerance in free flight
    double coupling_step; ///< [s] at which the subsystems, integrated apart, exchange; 0: together
} ld_run_settings;

/// Distributions of a factor: each with its word, what a scenario says of it, and its traits. What
/// they make of a uniform number stands in studies/plan/draw.c (model.md, section 10).
#define LD_DISTRIBUTIONS(ROW)                                                                      \
    ROW(LD_NORMAL, "normal", LD_GIVEN_DEVIATION, LD_ABOUT_NOMINAL | LD_BOUNDED)                    \
    ROW(LD_UNIFORM, "uniform", LD_GIVEN_SPAN, 0)                                                   \
    ROW(LD_LOGNORMAL, "lognormal", LD_GIVEN_RATIO, LD_ABOUT_NOMINAL | LD_ABOVE_ZERO)               \
    ROW(LD_DISCRETE, "discrete", LD_GIVEN_VALUES, LD_FOR_WHOLE)                                    \
    ROW(LD_EACH_SAMPLE, "each", LD_GIVEN_SAMPLE, LD_FOR_WHOLE | LD_SEED)

#define LD_DISTRIBUTION_NAME(name, word, given, traits) name,
typedef enum ld_distribution { LD_DISTRIBUTIONS(LD_DISTRIBUTION_NAME) } ld_distribution;

#define LD_DISTRIBUTION_ONE(name, word, given, traits) +1
enum { LD_DISTRIBUTION_COUNT = LD_DISTRIBUTIONS(LD_DISTRIBUTION_ONE) };

/// What a scenario says of a distribution.
typedef enum ld_given {
    LD_GIVEN_DEVIATION, ///< `deviation` in the key's unit
    LD_GIVEN_RATIO,     ///< `deviation`, a plain number
    LD_GIVEN_SPAN,      ///< `between`, or `spread`
    LD_GIVEN_VALUES,    ///< `value` with `weight`
    LD_GIVEN_SAMPLE,    ///< the word `sample`
} ld_given;

/// Traits of a distribution.
enum {
    LD_ABOUT_NOMINAL = 1, ///< always about the scenario's value
    LD_BOUNDED = 2,       ///< may be kept `within` or `between`
    LD_ABOVE_ZERO = 4,    ///< of values > 0, whose median is the nominal one
    LD_FOR_WHOLE = 8,     ///< for whole numbers too
    LD_SEED = 16, ///< for whole numbers alone, another one of the key's range in each sample
};

typedef struct distribution_row {
    const char *word;
    ld_given given;
    unsigned traits;
} distribution_row;

static inline const distribution_row *distribution_of(ld_distribution distribution)
{
#define LD_DISTRIBUTION_ROW(name, word, given, traits) {word, given, traits},
    static const distribution_row row[] = {LD_DISTRIBUTIONS(LD_DISTRIBUTION_ROW)};
    return &row[distribution];
}

/// Several keys under one name, which always have the same value.
typedef struct ld_together {
    int count; ///< 0: not several
    char path[LD_MAX_TOGETHER][LD_MAX_PATH];
} ld_together;

typedef enum ld_take {
    LD_TAKE_VALUE,
    LD_TAKE_PEAK,
    LD_TAKE_CHANGE,
    LD_TAKE_RMS,
    LD_TAKE_MEAN
} ld_take;

/// A result that the scenario asks for: what a column of the launch is at an instant of a rocket,
/// or in a window between two. Instants: start, t_ignition, t_release, t_front, t_middle, t_rear,
/// t_exit.NAME, end. With one of t_burnout, t_apogee, t_impact it is a column of the rocket's
/// flight.
typedef struct ld_measure {
    char name[LD_MAX_NAME];   ///< the result is called measure.NAME
    char of[LD_MAX_QUANTITY]; ///< column
    ld_take take; ///< its value, largest magnitude, change since `from`, root mean square, mean
    char from[LD_MAX_QUANTITY]; ///< instant of a value, or at which the window begins
    char to[LD_MAX_QUANTITY];   ///< instant at which it ends; of a value ""
    double within[2];           ///< [s] since `from`: of the window only what lies between these
} ld_measure;

/// One scattered number of the scenario. Units are those of the key, in SI.
typedef struct ld_factor {
    char path[LD_MAX_PATH]; ///< keys joined by dots; list members by name, else by number from 1;
                            ///< components of vectors by .w, .x, .y, .z; of several: their name
    ld_together together;
    ld_distribution distribution;
    double deviation;  ///< standard deviation, or that of the logarithm [-]
    double within;     ///< [-] kept within so many standard deviations; NaN: not
    double between[2]; ///< kept between these; of a span its ends; NaN: not given
    double spread;     ///< of a span: nominal +- this, where `between` is NaN
    int value_count;
    double value[LD_MAX_CHOICES];
    double weight[LD_MAX_CHOICES];
    bool per_rocket; ///< drawn for every rocket (keys of the rocket only)
} ld_factor;

/// Factors whose normal scores are correlated (Gaussian copula): of normal factors the matrix is
/// that of their own correlations.
typedef struct ld_correlated {
    int count;
    int factor[LD_MAX_CORRELATED];                       ///< numbers from 0 in ld_scatter.factor
    double matrix[LD_MAX_CORRELATED][LD_MAX_CORRELATED]; ///< symmetric, 1 on the diagonal
} ld_correlated;

typedef enum ld_statistic { LD_STATISTIC_MEAN, LD_STATISTIC_DEVIATION } ld_statistic;

/// How well a statistic of a result must be known for a study to stop before its last sample.
typedef struct ld_until {
    char result[2 * LD_MAX_NAME]; ///< name of the result's column, e.g. "t_rear"
    ld_statistic statistic;
    double half_width; ///< of the 95 % interval, in SI or, where relative, as a share of the
                       ///< statistic's magnitude
    bool relative;
} ld_until;

typedef enum ld_plan { LD_PLAN_RANDOM, LD_PLAN_LHS } ld_plan;

/// What a study scatters, and how often it runs.
typedef struct ld_scatter {
    bool present;
    int seed;
    int samples; ///< runs, each of all rockets of the firing; with `until`, at most
    ld_plan plan;
    int replicates; ///< independent Latin hypercubes, of samples/replicates each
    int factor_count;
    ld_factor *factor; ///< owned by the model
    int correlated_count;
    ld_correlated *correlated;    ///< groups of factors, owned by the model
    int until_count;              ///< 0: all samples are run
    ld_until until[LD_MAX_UNTIL]; ///< all of which must hold
} ld_scatter;

/// One key of the scenario that a study varies: a sweep is the product of its axes, the first
/// varying most slowly.
typedef struct ld_sweep_axis {
    char path[LD_MAX_PATH]; ///< list members by name, else by number from 1; of several: their name
    ld_together together;
    int count;
    char **value; ///< [count] as written, in one line of YAML
} ld_sweep_axis;

/// A file that a scenario was read from: the scenario itself, one that it includes, a table.
typedef struct ld_source_file {
    char *name;    ///< as seen from the scenario's folder; of the scenario without its folder
    char *text;    ///< with a zero after its end
    size_t length; ///< of the text
} ld_source_file;

/// All that a scenario was read from, so that it can be read again without its files.
struct ld_source {
    char *name;   ///< of the scenario, in messages
    char *folder; ///< where files that it names are looked for; NULL: `file` has all there are
    size_t file_count;
    ld_source_file **file; ///< [file_count] the scenario first
    size_t set_count;
    char **set;        ///< [set_count] overrides (as of --set)
    size_t set_before; ///< so many of them were there when the others were laid over them
    atomic_int users;  ///< models that share it, on any threads
};

// Gives one share of it up; the last one frees it. May be NULL.
void source_free(ld_source *source);

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
    ld_source *source;    ///< what it was read from, shared; NULL: filled by hand
    struct {
        bool ground_height, empty_mass, empty_center[3], empty_inertia[3], propellant, stuck_time,
            max_step;
    } completed; ///< what model_complete() has filled in: model_forget()
    int point;   ///< of the sweep that its values are those of; 0: nominal
    int sample;  ///< whose drawn numbers it has, of its point; 0: nominal
};

/// False: a flight alone.
static inline bool model_has_launcher(const ld_model *model)
{
    return model->base.kind != LD_BASE_NONE;
}
/// Whether the base is told where it is; makes it one that is.
static inline bool model_base_is_told(const ld_model *model)
{
    return model->base.kind == LD_BASE_EXTERNAL;
}
static inline void model_tell_base(ld_model *model)
{
    model->base.kind = LD_BASE_EXTERNAL;
}
/// Whether the base is a vehicle, which has wheels, hinges and tubes beside the one that launches.
static inline bool model_has_vehicle(const ld_model *model)
{
    return model->base.kind == LD_BASE_VEHICLE;
}
/// Bending stiffness of a section about y, which deflections along z meet.
static inline double section_stiffness_y(const ld_section *section)
{
    return section->form == LD_SECTION_PLANES ? section->bending_stiffness_y
                                              : section->bending_stiffness;
}

/// Bending stiffness of a section about z, which deflections along y meet.
static inline double section_stiffness_z(const ld_section *section)
{
    return section->form == LD_SECTION_PLANES ? section->bending_stiffness_z
                                              : section->bending_stiffness;
}

/// Whether the rocket's shoes slide on surfaces, not in a bore.
static inline bool model_has_surfaces(const ld_model *model)
{
    return model_has_launcher(model) && model->tubes.guide.present;
}

/// What guides the rocket, in a word.
static inline const char *model_guide_word(const ld_model *model)
{
    const ld_guide *guide = &model->tubes.guide;
    bool tower = guide->form == LD_GUIDE_TOWER;
    return !model_has_surfaces(model) ? "tube" : tower ? "tower" : "rail";
}

/// Whether the rocket's knob follows a slot.
static inline bool model_has_slot(const ld_model *model)
{
    return model_has_launcher(model) && model->tubes.slot.kind == LD_SLOT_HELIX;
}

/// Whether the air acts on what has come out of the tube.
static inline bool model_has_crossflow(const ld_model *model)
{
    const ld_aerodynamics *air = &model->rocket.aerodynamics;
    return model_has_launcher(model) && air->present && air->emerged.present;
}

/// Whether the air acts on the whole rocket on its guide: that is open, not a bore.
static inline bool model_has_open_air(const ld_model *model)
{
    return model_has_surfaces(model) && model->rocket.aerodynamics.present;
}

/// Whether the rocket feels the air before its release.
static inline bool model_feels_air(const ld_model *model)
{
    return model_has_crossflow(model) || model_has_open_air(model);
}

/// Whether the jets of rockets that have left act on the platform.
static inline bool model_has_jet(const ld_model *model)
{
    return model_has_vehicle(model) && model->platform.jet.rows > 0;
}

/// Whether a pressure drives the rocket out of its tube.
static inline bool model_has_pressure(const ld_model *model)
{
    return model_has_launcher(model) && model->tubes.pressure.present;
}

/// How many supports are slides on which the tube recoils.
static inline int model_slide_count(const ld_model *model)
{
    int count = 0;
    for (int i = 0; i < model->tubes.support_count; i++)
        count += model->tubes.support[i].recoil.present;
    return model_has_launcher(model) ? count : 0;
}

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
