/// How a flight alone begins: the block `flight`.
#ifndef LD_MODEL_BLOCKS_FLIGHT_H
#define LD_MODEL_BLOCKS_FLIGHT_H

#include <stdbool.h>

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

#endif
