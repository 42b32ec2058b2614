// Air forces on a rocket in free flight, about its x axis (model.md, section 8):
// aerodynamics_real.h has them. They hold from rest and at any angle: nothing is divided by a speed
// or an angle.
#ifndef LD_ELEMENTS_AERODYNAMICS_H
#define LD_ELEMENTS_AERODYNAMICS_H

#include <stdbool.h>
#include <stddef.h>

#include "elements/air/aerodynamics_surfaces.h"
#include "math/curves/curves.h"
#include "math/vec3.h"

enum { AERODYNAMICS_COLUMNS = 7 };

typedef struct aerodynamics {
    bool present;
    ld_aerodynamic_model model;
    // coefficients over the Mach number: pi d^2/8, d/2, scaled as the model says
    double half_area; // [m2] S/2
    double diameter;  // [m] d
    double cant;      // [rad] delta
    curves table;     // ca_power_off, ca_power_on, cn_alpha, x_cp, cl_delta, cl_p, cm_q
    double last_mach;
    char last_of[LD_MAX_PATH]; // key of the table that ends there
    double crossflow_drag, crossflow_at;
    air_surfaces surfaces; // by surface, with the table of its columns
    // plain body
    double drag;       // C_D S/2 [m2]
    v3 damping;        // 1/4 S l_i^2 C_i [m4]
    bool axisymmetric; // damping about y and z the same
} aerodynamics;

ld_status aerodynamics_build(aerodynamics *self, const ld_aerodynamics *model, ld_error *error);
void aerodynamics_free(aerodynamics *self);

// The air about a rocket, taken as one over its length.
typedef struct moving_air {
    v3 v;                  // [m/s] its velocity against the ground, in I
    double density;        // [kg/m3]
    double speed_of_sound; // [m/s], > 0
} moving_air;

// Force f and moment m about the mass centre, in axes whose x is the rocket's.
typedef struct air_wrench {
    v3 f, m;
} air_wrench;

// Of the lateral force at small angles: slope on pi d^2/4 [1/rad], of a plain body 0, and where it
// acts [m, x of B]; NaN where the slope is 0.
typedef struct air_center {
    double slope, at;
} air_center;

// At the Mach number, held at the table's last.
air_center aerodynamics_center(const aerodynamics *self, double mach);

// How the rocket moves through the air; all in the same axes, of B or of a frame that differs from
// B by a roll.
typedef struct airflow {
    v3 v;           // [m/s] velocity through the air of the mass centre
    double speed;   // |v|
    v3 w;           // [rad/s] angular velocity
    v3 c;           // [m] the mass centre, from O1
    double density; // [kg/m3]
    double mach;    // held at the table's last
} airflow;

// power: the thrust table has not ended; interval: of the table, kept between calls.
air_wrench aerodynamics_wrench(const aerodynamics *self, const airflow *flow, bool power,
                               size_t *interval);

#endif
