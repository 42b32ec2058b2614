/// A base of bodies, joints and force elements (base.kind: multibody): docs/multibody.md.
///
/// Bodies are named; "ground" is I, "carrier" the frame that base.velocity, base.motion and
/// base.sea move. A point of a body is in its axes, from its origin; of a beam it is a station
/// along it, then y and z in the axes of the deformed section there.
#ifndef LD_MODEL_BLOCKS_MECHANISM_H
#define LD_MODEL_BLOCKS_MECHANISM_H

#include "model/blocks/platform.h"
#include "model/blocks/section.h"
#include "model/blocks/stabiliser.h"
#include "model/blocks/tubes.h"

enum {
    LD_MAX_BODIES = 20,
    LD_MAX_BEAMS = 4,
    LD_MAX_JOINTS = 28,
    LD_MAX_BUSHINGS = 16,
    LD_MAX_STRUTS = 12,
    LD_MAX_DRIVES = 8, ///< on joints
    LD_MAX_FEET = 8,
    LD_MAX_LOADS = 8,
    LD_MAX_DRAGS = 8,
    LD_MAX_BEAM_SECTIONS = 8,
    LD_MAX_TRIANGLES = 5000, ///< of all meshes
    LD_MESH_COLUMNS = 12,    ///< three corners of a triangle, its colour
    LD_MAX_BEAM_COORDINATES = 2 * LD_MAX_BENDING_MODES + LD_MAX_TORSION_MODES + LD_MAX_AXIAL_MODES,
};

/// What a body is drawn as; nothing of its mechanics.
typedef enum ld_body_shape {
    LD_SHAPE_INERTIA, ///< the box of its mass and inertia; a beam by its sections
    LD_SHAPE_BOX,
    LD_SHAPE_CYLINDER,
    LD_SHAPE_ELLIPSOID,
    LD_SHAPE_NONE,
    LD_SHAPE_MESH,
} ld_body_shape;

typedef struct ld_appearance {
    ld_body_shape shape;
    double at[3];       ///< [m] centre, of a mesh its origin, body axes
    double attitude[3]; ///< [rad] yaw, pitch, roll of its axes against the body's
    double size[3];     ///< [m] along x, y, z; a cylinder's axis is x
    /// [m] triangles in axes of the shape, before `scale`: x, y, z of three corners; then red,
    /// green, blue from 0 to 1, linear
    ld_table mesh;
    double scale;
} ld_appearance;

/// A rigid body.
typedef struct ld_body {
    char name[LD_MAX_NAME];
    double mass;        ///< [kg]
    double center[3];   ///< [m] mass centre, body axes
    double inertia[3];  ///< [kg m2] about the mass centre, body axes
    double products[3]; ///< [kg m2] J_xy, J_xz, J_yz, elements of the matrix
    ld_appearance appearance;
} ld_body;

/// A flexible beam along its own x axis, carried at its rear end: sections as the tube's.
typedef struct ld_beam {
    char name[LD_MAX_NAME];
    double length; ///< [m]
    ld_material material;
    int section_count;
    ld_section section[LD_MAX_BEAM_SECTIONS];
    ld_modes modes;
} ld_beam;

typedef enum ld_joint_kind {
    LD_JOINT_FIXED,
    LD_JOINT_REVOLUTE,
    LD_JOINT_PRISMATIC,
    LD_JOINT_CYLINDRICAL,
    LD_JOINT_UNIVERSAL,
    LD_JOINT_SPHERICAL,
    LD_JOINT_PLANAR,
    LD_JOINT_FREE,
} ld_joint_kind;
enum { LD_JOINT_KINDS = LD_JOINT_FREE + 1 };

/// One-sided springs where a joint's coordinate leaves a range; NaN: no stop there.
typedef struct ld_joint_stops {
    bool present;
    double low, high; ///< [rad] or [m]
    double stiffness; ///< [N m/rad] or [N/m]
    double damping;   ///< while it presses
} ld_joint_stops;

/// A spring-damper that holds a joint where it stands when it closes.
typedef struct ld_joint_lock {
    ld_hinge_lock spring;
    double from; ///< [s] on the run's clock; NaN: from the start
} ld_joint_lock;

/// A joint carries `body` on `parent`. Where another joint, given before, carries it, this one
/// closes a loop.
typedef struct ld_joint {
    char name[LD_MAX_NAME];
    ld_joint_kind kind;
    char parent[LD_MAX_NAME];
    char body[LD_MAX_NAME];
    double at[3];              ///< [m] on the parent
    double attitude[3];        ///< [rad] yaw, pitch, roll of the joint's axes against the parent's
    double body_at[3];         ///< [m] on the body (loops); NaN: its origin
    double body_attitude[3];   ///< [rad] joint's axes against the body's (loops)
    double axis[3];            ///< of the joint, in its axes
    double axis_2[3];          ///< universal: turned by the first angle
    double stiffness, damping; ///< [N/m], [N s/m] along what it lets slide
    double rotational_stiffness, rotational_damping; ///< [N m/rad], [N m s/rad] about what turns
    double rest_angle, rest_length;                  ///< [rad], [m] of springs about one axis
    double angle, angle_2, displacement;             ///< [rad], [rad], [m] at the start
    double rate, speed;                              ///< [rad/s], [m/s] at the start, along axis
    /// of one axis; where it slides in N s/m, N, m/s and N/m, N s/m
    ld_hinge_friction friction;
    ld_joint_stops stops;
    ld_joint_lock lock;
} ld_joint;

/// Six springs and dampers between an axis frame on `from` and one on `to`.
typedef struct ld_bushing {
    char name[LD_MAX_NAME];
    char from[LD_MAX_NAME], to[LD_MAX_NAME];
    double at[3];       ///< [m] on `from`
    double attitude[3]; ///< [rad] of the springs' axes against those of `from`
    double to_at[3];    ///< [m] on `to`; NaN: where it meets `at` at the start, unloaded
    double stiffness[3], damping[3];
    double rotational_stiffness[3], rotational_damping[3];
    double clearance[3];      ///< [m] free on each side
    double stop[3];           ///< [m] displacement at which a stop begins; NaN: none
    double stop_stiffness[3]; ///< [N/m] added beyond
} ld_bushing;

/// A spring, a damper and an actuator between two points.
typedef struct ld_strut {
    char name[LD_MAX_NAME];
    char from[LD_MAX_NAME], to[LD_MAX_NAME];
    double at[3], to_at[3]; ///< [m] on each
    double stiffness;       ///< [N/m]
    double damping;         ///< [N s/m]
    double length;          ///< [m] without force; NaN: that of the start
    double preload;         ///< [N] pushing, at that length
    bool driven;
    ld_stabiliser actuator; ///< of its length: commands [m], gains [N/m], forces [N]
} ld_strut;

/// What a drive on a joint follows.
typedef enum ld_follows {
    LD_FOLLOWS_JOINT, ///< its coordinate
    LD_FOLLOWS_YAW,   ///< yaw of a body's x axis against I
    LD_FOLLOWS_PITCH, ///< its pitch
} ld_follows;

typedef enum ld_drive_form { LD_DRIVE_ANGLE, LD_DRIVE_LENGTH } ld_drive_form;

/// A stabiliser on a joint with one axis.
typedef struct ld_joint_drive {
    char name[LD_MAX_NAME];
    char joint[LD_MAX_NAME];
    ld_follows follows;
    char of[LD_MAX_NAME]; ///< body of yaw and pitch; empty: the one that carries the tube
    ld_drive_form form;
    ld_stabiliser angle;
    ld_stabiliser length; ///< commands [m], gains [N/m], forces [N]
} ld_joint_drive;

/// A jack: a point of a body on the ground y = height of I.
typedef struct ld_foot {
    char name[LD_MAX_NAME];
    char body[LD_MAX_NAME];
    double at[3];
    double height;       ///< [m] of the ground under it
    double stiffness[3]; ///< [N/m] along x, vertical, along z of I
    double damping[3];   ///< [N s/m]
    double friction;     ///< [-]
} ld_foot;

typedef enum ld_load_axes { LD_LOAD_IN_GROUND, LD_LOAD_IN_BODY } ld_load_axes;

/// A force and a moment at a point over time.
typedef struct ld_point_load {
    char name[LD_MAX_NAME];
    char body[LD_MAX_NAME];
    double at[3];
    ld_load_axes axes;
    ld_table force, moment; ///< t [s], x, y, z [N] or [N m]; linear, constant outside
} ld_point_load;

/// Drag of the wind: 1/2 rho |v| (A_x v_x, A_y v_y, A_z v_z), v of the air against the point.
typedef struct ld_body_drag {
    char name[LD_MAX_NAME];
    char body[LD_MAX_NAME];
    double at[3];
    double area[3]; ///< [m2] drag coefficient times area along x, y, z of the body
} ld_body_drag;

/// Where the names of the joints of a kind stand among `joint_name`.
typedef struct ld_joint_names {
    int first, count;
} ld_joint_names;

typedef struct ld_mechanism {
    int body_count;
    ld_body body[LD_MAX_BODIES];
    int beam_count;
    ld_beam beam[LD_MAX_BEAMS];
    int joint_count;
    ld_joint joint[LD_MAX_JOINTS];
    int bushing_count;
    ld_bushing bushing[LD_MAX_BUSHINGS];
    int strut_count;
    ld_strut strut[LD_MAX_STRUTS];
    int drive_count;
    ld_joint_drive drive[LD_MAX_DRIVES];
    int foot_count;
    ld_foot foot[LD_MAX_FEET];
    int load_count;
    ld_point_load load[LD_MAX_LOADS];
    int drag_count;
    ld_body_drag drag[LD_MAX_DRAGS];
    char wheels_on[LD_MAX_NAME];                 ///< body whose axes the wheels' mounts are in
    ld_joint_names named[LD_JOINT_KINDS];        ///< by kind; model_complete() lists them
    char joint_name[LD_MAX_JOINTS][LD_MAX_NAME]; ///< kind by kind, each in its order
} ld_mechanism;

/// Whom a point belongs to, where it is not a body.
enum { LD_ON_GROUND = -1, LD_ON_CARRIER = -2, LD_ON_NOTHING = -3 };

/// Number of a beam's modal coordinates (bending along y, along z, torsion, stretch), and of all
/// beams' together.
int beam_coordinates(const ld_beam *beam);
int mechanism_beam_coordinates(const ld_mechanism *self);

/// Whether anything stands on the frame that moves as is said.
bool mechanism_has_carrier(const ld_mechanism *self);

/// Number of the body of that name, rigid ones first, then beams, or one of the above.
int mechanism_body(const ld_mechanism *self, const char *name);
int mechanism_joint(const ld_mechanism *self, const char *name);
/// Triangles of all its meshes.
size_t mechanism_triangles(const ld_mechanism *self);

#endif
