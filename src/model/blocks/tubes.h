/// The tube, its modes, its place among others: the block `tubes`.
#ifndef LD_MODEL_BLOCKS_TUBES_H
#define LD_MODEL_BLOCKS_TUBES_H

#include "model/blocks/guide.h"
#include "model/blocks/limits.h"
#include "model/blocks/pressure.h"
#include "model/blocks/section.h"
#include "model/blocks/slot.h"
#include "model/blocks/support.h"

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

/// Whether axial forces stiffen or soften bending.
typedef enum ld_geometric { LD_GEOMETRIC_NO, LD_GEOMETRIC_YES } ld_geometric;

typedef struct ld_modes {
    int bending; ///< modes per plane
    int torsion;
    int axial;
    int elements; ///< finite elements along the tube (at least; section steps add nodes)
    ld_mode_span span;
    double damping; ///< [-] ratio, of the clamped modes of the bare tube
    double cut;     ///< [Hz] faster modes are slowed to it, their compliance kept; 0: none
    ld_geometric geometric_stiffness;
    double shear_coefficient; ///< [-] k of k G A; 0: rigid in shear, without rotary inertia
} ld_modes;

typedef struct ld_tail {
    double mass;       ///< [kg], may be 0
    double center;     ///< [m] x of the mass centre in the rear section's frame (negative: behind)
    double inertia[3]; ///< [kg m2] about its own mass centre, tube axes
} ld_tail;

/// A length of the guide in the wind; overlapping ones add up.
typedef struct ld_wind_drag {
    double from, to;    ///< [m] stations
    double width;       ///< [m] across the wind
    double coefficient; ///< [-] of its drag across the axis
} ld_wind_drag;

/// Where it is asked for what the tube carries.
typedef struct ld_station {
    double at;             ///< [m] station
    double outer_fibre[2]; ///< [m] along y, z from the elastic axis; NaN: that of a ring, or none
} ld_station;

typedef struct ld_layout {
    int rows, columns;
    double pitch;    ///< [m]
    double first[3]; ///< [m] rear end of tube 1, platform axes
} ld_layout;

/// A place where two lengths of the guide meet.
typedef struct ld_rail_joint {
    double at;      ///< [m] station
    double step[2]; ///< [m] y, z: by how much the guide beyond it is off
    double kink[2]; ///< [rad] in y, z: by how much the guide beyond it is turned
    double length;  ///< [m] over which step and kink are rounded, around `at`
} ld_rail_joint;

/// Sine half waves between the ends, whose amplitudes a seed decides.
typedef struct ld_random_bends {
    bool present;
    double deviation; ///< [m] largest distance from the line between the ends
    int terms;        ///< half waves, 1 to this many
    double decay;     ///< [-] standard deviations fall as the number of half waves to this power
} ld_random_bends;

/// How the unloaded guide departs from a straight line.
typedef struct ld_initial_shape {
    bool present;
    ld_table offsets;   ///< x [m], y_0, z_0 [m], perhaps twist [rad]; cubic spline; empty: none
    double scale[2];    ///< [-] factors on y_0, z_0
    double twist_scale; ///< [-] factor on the twist
    double accuracy[2]; ///< [m] standard deviations of each row's y_0, z_0
    ld_random_bends random;
    int seed; ///< of random bends and of the rows' errors
    int joint_count;
    ld_rail_joint joint[LD_MAX_RAIL_JOINTS];
} ld_initial_shape;

/// Ring of a guide's front end in the jet of `rocket.motor.plume`.
typedef struct ld_jet_face {
    bool present;
    double inner, outer; ///< [m] radii of the ring
} ld_jet_face;

/// Ring on the guide behind the rocket that turns the jet aside.
typedef struct ld_deflector {
    bool present;
    double at;           ///< [m] x of its centre from the guide's rear end
    double inner, outer; ///< [m] radii, across the axis
    double push[3];      ///< [-] force over that of the jet that hits, in axes of the guide there
} ld_deflector;

typedef struct ld_tubes {
    ld_layout layout;
    char on[LD_MAX_NAME]; ///< body that carries them (multibody)
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
    ld_initial_shape initial_shape;
    int wind_drag_count;
    ld_wind_drag wind_drag[LD_MAX_WIND_DRAGS];
    ld_table jet; ///< distance from the tip [m], force of a jet on the front end [N]; empty: none
    double jet_scale;     ///< [-] factor on the force, and on the others' of jets
    ld_jet_face jet_face; ///< instead of `jet`
    ld_deflector deflector;
} ld_tubes;

#endif
