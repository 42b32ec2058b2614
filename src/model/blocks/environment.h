/// Earth, site, air, wind, ground: the block `environment`.
#ifndef LD_MODEL_BLOCKS_ENVIRONMENT_H
#define LD_MODEL_BLOCKS_ENVIRONMENT_H

#include <stdbool.h>

#include "model/blocks/limits.h"
#include "model/blocks/table.h"

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

#endif
