/// Air forces on the rocket: the block `rocket.aerodynamics`.
#ifndef LD_MODEL_BLOCKS_AERODYNAMICS_H
#define LD_MODEL_BLOCKS_AERODYNAMICS_H

#include <stdbool.h>

#include "model/blocks/limits.h"
#include "model/blocks/table.h"

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

#endif
