/// Multibody systems by the transfer matrix method: chains, trees and closed loops of rigid bodies,
/// beams and hinges at acceleration level, order N.
///
/// A system is described by a list of elements. An element is a body (rigid, or a beam) together
/// with the hinge that carries it on its parent: another element, or the ground. The body's frame
/// sits on the outboard side of its hinge; at zero coordinates it coincides with the hinge frame,
/// which is fixed on the parent at `at`, turned by `attitude`. The ground's frame is the inertial
/// one. SI units and radians throughout.
///
/// Coordinates q and speeds u are flat arrays, element by element in the order of the description:
///   weld         -                                              -
///   revolute     angle about axis                               its rate
///   prismatic    displacement along axis                        its rate
///   cylindrical  displacement along axis, angle about it        their rates
///   universal    angle about axis, then about axis_2            their rates
///   spherical    quaternion w x y z, body to hinge frame        angular velocity relative to the
///                                                               parent, in body axes (3)
///   free         position of the body's origin in the hinge     its rate (3), angular velocity
///                frame (3), quaternion as above (4)             relative to the parent, body axes
///                (3)
///   planar       displacements along axis_2 and along axis x axis_2, angle about axis (the plane's
///                normal)                                         their rates
/// A beam's modal coordinates q_y, q_z, q_t, q_a (and their rates) follow those of its hinge.
/// Generalised forces tau belong to the speeds: their power is tau . u. They act on the body and
/// with opposite sign on its parent. Of a prescribed hinge, tau is what its speeds' rates are: the
/// motion is given (q and u by the caller), the force it needs is found (ld_mstmm_forces). A ground
/// that moves is an element without mass on a prescribed free hinge.
///
/// A system holds its workspace: use one per thread (ld_mstmm_copy). Nothing is allocated after
/// ld_mstmm_create but in ld_mstmm_copy, ld_mstmm_accelerations_overall, ld_mstmm_vibration and
/// ld_mstmm_integrate.
#ifndef LAUNCHDYN_MSTMM_H
#define LAUNCHDYN_MSTMM_H

#include <stdint.h>

#include "launchdyn/section.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct ld_mstmm ld_mstmm;

typedef enum ld_hinge {
    LD_HINGE_WELD,
    LD_HINGE_REVOLUTE,
    LD_HINGE_PRISMATIC,
    LD_HINGE_CYLINDRICAL,
    LD_HINGE_UNIVERSAL,
    LD_HINGE_SPHERICAL,
    LD_HINGE_FREE,
    LD_HINGE_PLANAR,
} ld_hinge;

/// A flexible tube or beam along its body frame's x axis (elastic axis and line of masses; of
/// sections with LD_SECTION_PLANES y and z are the principal axes): bending, torsion and stretch as
/// small vibrations in a frame that rides on its input end, by component modes.
typedef struct ld_mstmm_beam {
    double length; ///< [m]
    int section_count;
    const ld_section *section;   ///< from x = 0 on, ascending; bore radius is not used
    int bending, torsion, axial; ///< number of modes: bending per plane
    int elements;                ///< finite elements at least; 0: 40
    double damping;              ///< [-] ratio, of the modes clamped at x = 0
    ld_mode_span span;           ///< LD_SPAN_FREE_FREE, LD_SPAN_TIP_LOADED, or clamped
    int geometric_stiffness;     ///< other than 0: axial forces stiffen or soften bending
    int reserved_number;         ///< 0
    double shear_coefficient;    ///< [-] k of k G A of round sections, with rotary inertia; G A is
                                 ///< torsion stiffness times mass over polar inertia. 0: neither
    const void *reserved[2];     ///< NULL: room for what later versions may be asked
} ld_mstmm_beam;

/// One body and the hinge that carries it. All not mentioned may be zero.
typedef struct ld_mstmm_element {
    const char *name;
    const char *parent; ///< name of the element that carries it; NULL: the ground
    double at[3]; ///< [m] the hinge on the parent, parent's axes; on a beam: station along it,
                  ///< then y and z in the axes of the deformed section there
    double attitude[4]; ///< quaternion, hinge frame to parent's axes (any length); zeros: parallel
    ld_hinge hinge;
    double axis[3];      ///< in the hinge frame (any length)
    double axis_2[3];    ///< universal: second axis, turned by the first angle; planar: a direction
                         ///< in the plane (its part along axis is taken out)
    double stiffness[6]; ///< of springs in the hinge, one per speed [N m/rad] or [N/m]; spherical
                         ///< and free: against the rotation vector in body axes
    double damping[6];   ///< of dampers in the hinge, one per speed
    double rest[2];      ///< coordinates without spring force (hinges with one or two axes, planar:
                         ///< its displacements)
    double mass;         ///< [kg] 0 at an end: a frame, welded or on a prescribed hinge
    double center[3];    ///< [m] mass centre, body axes
    double inertia[6];   ///< [kg m2] matrix elements xx yy zz xy xz yz about the mass centre
    const ld_mstmm_beam *beam; ///< not NULL: the body is this beam (mass, center, inertia unused)
    int prescribed;            ///< other than 0: the hinge's motion is given, tau its accelerations
    const void *reserved[3];   ///< NULL: room for what later versions may be asked
} ld_mstmm_element;

/// Builds a system in a uniform gravity field [m/s2]. Fails with a sentence that names the element:
/// a parent that does not exist, elements in a circle, a name given twice, a massless end body, a
/// mass or an inertia that no body can have, a missing axis.
ld_status ld_mstmm_create(const ld_mstmm_element *elements, int count, const double gravity[3],
                          ld_mstmm **out, ld_error *error);
void ld_mstmm_free(ld_mstmm *system);

/// One side of a joint that closes a loop.
typedef struct ld_mstmm_end {
    const char *element; ///< NULL: the ground
    double at[3]; ///< [m] the joint's point on it, its axes; on a beam: station, then y and z in
                  ///< the axes of the deformed section there
    double attitude[4]; ///< quaternion, joint frame to these axes (any length); zeros: parallel
} ld_mstmm_end;

/// A joint that closes a loop: two elements, or an element and the ground, that the tree of hinges
/// already connects. It is of the kinds that hinges have (but for free), `first` as the parent and
/// `second` as the body; both joint frames coincide at zero coordinates. Its coordinates and speeds
/// follow from those of the hinges (ld_mstmm_loop_state).
typedef struct ld_mstmm_loop {
    const char *name;
    ld_mstmm_end first, second;
    ld_hinge joint;
    double axis[3], axis_2[3]; ///< in the joint frames, as of a hinge
    double stiffness[6];       ///< of springs in the joint, as of a hinge
    double damping[6];
    double rest[2];
    const void *reserved[4]; ///< NULL: room for what later versions may be asked
} ld_mstmm_loop;

/// What a system consists of.
typedef struct ld_mstmm_description {
    const ld_mstmm_element *elements;
    int element_count;
    int loop_count;
    const ld_mstmm_loop *loops;
    double gravity[3];       ///< [m/s2]
    const void *reserved[4]; ///< NULL: room for what later versions may be asked
} ld_mstmm_description;

/// Builds a system with closed loops: fails as ld_mstmm_create does, and with a sentence that names
/// the joint: a name given twice, an element that does not exist, a free joint, a body joined with
/// itself. Before its first evaluation it has to be assembled.
ld_status ld_mstmm_build(const ld_mstmm_description *description, ld_mstmm **out, ld_error *error);

/// What ld_mstmm_assemble has found.
typedef struct ld_mstmm_assembly {
    int iterations;
    int freedoms;       ///< degrees of freedom of the closed system
    int held;           ///< constraints of the loops that are independent of each other
    int redundant;      ///< constraints that the others imply: the motion is unique, forces are not
    double gap;         ///< [m] largest distance left in a joint
    double turn;        ///< [rad] largest angle left
    double singularity; ///< of the pose: 1 far from a singular one, 0 in one (ld_mstmm_singularity)
} ld_mstmm_assembly;

/// Closes the loops: moves q (a guess) to where all joints fit, by the least motion weighted with
/// the masses; and u (NULL: none), whose part that opens the loops goes likewise. Hinges of
/// elements with kept[element] other than 0 (NULL: none) and prescribed ones keep their coordinates
/// and speeds; beams flex only where hinges alone do not close. Finds out which constraints are
/// redundant in general poses near q; later evaluations go by that. LD_ERR_INPUT with the joint's
/// name and what is left where the loops cannot be closed. `report` may be NULL.
ld_status ld_mstmm_assemble(ld_mstmm *system, double *q, double *u, const int *kept,
                            ld_mstmm_assembly *report, ld_error *error);

/// Takes the drift of a step out of q and then out of u, to rounding, by the least changes weighted
/// with the masses: momenta stay. LD_ERR_NUMERIC with the joint's name where it does not close.
/// ld_mstmm_integrate does it after every step.
ld_status ld_mstmm_project(ld_mstmm *system, double *q, double *u, ld_error *error);

int ld_mstmm_loop_count(const ld_mstmm *system);
/// Index of a loop by its joint's name, -1 where there is none.
int ld_mstmm_find_loop(const ld_mstmm *system, const char *name);
/// How many constraints of a joint are implied by the others', those of joints given before it
/// counted first.
int ld_mstmm_loop_redundancy(const ld_mstmm *system, int loop);
/// How far the pose of the last evaluation is from a singular one: the least independent
/// constraint's part that no other one covers, squared sine, against general poses; and its joint
/// (NULL: not asked for). 1 without loops. Below 1e-20 that constraint has no force.
double ld_mstmm_singularity(const ld_mstmm *system, int *loop);
/// Force, then moment about the joint's point, of a joint on its second side in the last evaluation
/// of accelerations, springs included, inertial axes. Redundant constraints carry nothing.
void ld_mstmm_loop_force(const ld_mstmm *system, int loop, double force[6]);
/// Coordinates (angles within pi) and speeds of a joint that closes a loop, in the order of a
/// hinge's.
void ld_mstmm_loop_state(ld_mstmm *system, const double *q, const double *u, int loop,
                         double *coordinates, double *speeds);
/// Adds what forces `tau` along a joint's speeds do, on its second side and opposite on the first,
/// to `wrench` (6 for each element). LD_ERR_INPUT for an end on a beam: weld a frame there.
ld_status ld_mstmm_loop_wrench(ld_mstmm *system, const double *q, int loop, const double *tau,
                               double *wrench, ld_error *error);
/// Directions in which the closed system can move at q: `count` rows of speed_count speeds, each
/// with a 1 at one independent speed and 0 at the others of these. basis has room for speed_count
/// rows.
ld_status ld_mstmm_freedoms(ld_mstmm *system, const double *q, double *basis, int *count,
                            ld_error *error);

/// Makes an element's hinge prescribed, or free again, from now on (a lock: u and tau zero). Copies
/// made before are not concerned.
void ld_mstmm_prescribe(ld_mstmm *system, int element, int prescribed);

/// The same system with a workspace of its own, for another thread; it shares what is constant.
/// Either may be freed first.
ld_status ld_mstmm_copy(const ld_mstmm *system, ld_mstmm **out, ld_error *error);

/// Number of elements; length of q and of u.
int ld_mstmm_element_count(const ld_mstmm *system);
int ld_mstmm_coordinate_count(const ld_mstmm *system);
int ld_mstmm_speed_count(const ld_mstmm *system);
/// Index of an element by name, -1 where there is none.
int ld_mstmm_find(const ld_mstmm *system, const char *name);
/// Where an element's coordinates begin in q, and its speeds in u.
int ld_mstmm_coordinate_offset(const ld_mstmm *system, int element);
int ld_mstmm_speed_offset(const ld_mstmm *system, int element);
/// The reference state: zeros and unit quaternions.
void ld_mstmm_reference(const ld_mstmm *system, double *q);

/// Forward dynamics by the reduced sweep (Riccati form of the transfer equations, formulation.md
/// section 2): u_dot from q, u, hinge forces `tau` (NULL: none) and applied wrenches (NULL: none;
/// else 6 for each element: force, then moment about the body's origin, inertial axes). Springs and
/// dampers of the hinges are added. q and u NULL: those of the latest ld_mstmm_places. Loops are
/// closed by forces at acceleration level; q and u are to close them already. Fails where a hinge's
/// state is singular, with its name, or where a singular pose of a loop demands what no force
/// gives.
ld_status ld_mstmm_accelerations(ld_mstmm *system, const double *q, const double *u,
                                 const double *tau, const double *wrench, double *u_dot,
                                 ld_error *error);

/// Inverse dynamics: the hinge forces `tau` that make `u_dot` (on top of springs and dampers),
/// joints of loops carrying nothing but their springs.
void ld_mstmm_forces(ld_mstmm *system, const double *q, const double *u, const double *u_dot,
                     const double *wrench, double *tau);

/// What every hinge transmits to its body (with loops: of the joints' forces of the last evaluation
/// of accelerations) while `u_dot` holds: force, then moment about the hinge's point on the body
/// (its frame's origin), inertial axes; 6 for each element.
void ld_mstmm_reactions(ld_mstmm *system, const double *q, const double *u, const double *u_dot,
                        const double *wrench, double *reaction);

typedef enum ld_mstmm_form {
    LD_MSTMM_PAPER,  ///< each hinge acceleration eliminated by the next hinge's equation
    LD_MSTMM_HINGES, ///< all hinge accelerations kept as unknowns
} ld_mstmm_form;

/// How far an overall transfer equation may be trusted.
typedef struct ld_mstmm_overall {
    int order;         ///< of the equations solved
    double loss;       ///< largest difference from the reduced sweep over the largest acceleration
    char warning[256]; ///< empty, or a sentence: the form cannot hold here
} ld_mstmm_overall;

/// Forward dynamics by the overall transfer equation: the product of the elements' 13 x 13 matrices
/// closed by the conditions at both ends; arguments as of ld_mstmm_accelerations. For comparison
/// and study: it loses digits with the length of the chain (`report`, may be NULL). Fails with
/// LD_ERR_NUMERIC where it has none left.
ld_status ld_mstmm_accelerations_overall(ld_mstmm *system, ld_mstmm_form form, const double *q,
                                         const double *u, const double *tau, const double *wrench,
                                         double *u_dot, ld_mstmm_overall *report, ld_error *error);

typedef struct ld_mstmm_energies {
    double kinetic;   ///< [J]
    double potential; ///< in gravity, zero at the inertial origin
    double elastic;   ///< of beams and hinge springs
} ld_mstmm_energies;

ld_mstmm_energies ld_mstmm_energy(ld_mstmm *system, const double *q, const double *u);
/// Linear momentum [kg m/s] and angular momentum about the inertial origin [kg m2/s].
void ld_mstmm_momentum(ld_mstmm *system, const double *q, const double *u, double linear[3],
                       double angular[3]);

/// Place and motion of a point of an element in inertial axes.
typedef struct ld_mstmm_point {
    double position[3];
    double velocity[3];
    double attitude[4]; ///< quaternion, body (or beam section) axes to inertial axes
    double rate[3];     ///< angular velocity of the body (or section), inertial axes
} ld_mstmm_point;

/// The point `at` of an element: body axes, or station, y, z on a beam.
ld_mstmm_point ld_mstmm_locate(ld_mstmm *system, const double *q, const double *u, int element,
                               const double at[3]);

/// The same of the frames' origins of all elements, in their order (a beam's input end). An
/// evaluation of ld_mstmm_accelerations that follows may have NULL for q and u and then saves their
/// motion.
void ld_mstmm_places(ld_mstmm *system, const double *q, const double *u, ld_mstmm_point *places);

/// Acceleration [m/s2] of the point `at` of an element and angular acceleration [rad/s2] of the
/// body (or section) while `u_dot` holds, inertial axes.
void ld_mstmm_point_acceleration(ld_mstmm *system, const double *q, const double *u,
                                 const double *u_dot, int element, const double at[3],
                                 double linear[3], double angular[3]);

/// Rates of the coordinates q from the speeds u.
void ld_mstmm_rates(const ld_mstmm *system, const double *q, const double *u, double *q_dot);

/// One mode of the system linearised at an equilibrium.
typedef struct ld_mstmm_mode {
    double frequency; ///< [Hz] |eigenvalue|/(2 pi); real eigenvalues (overdamped, unstable): 0
    double damping;   ///< [-] ratio -Re/|eigenvalue|; negative: it grows
    double rate;      ///< [1/s] real part of the eigenvalue
} ld_mstmm_mode;

/// Natural frequencies, damping ratios and mode shapes at the equilibrium q held by constant `tau`
/// (NULL: none), ascending; prescribed hinges hold, loops stay closed. modes: at most speed_count
/// are written, `count` says how many; shapes (NULL: none): count rows of speed_count displacements
/// (in the sense of the speeds), real and imaginary part in turn, the largest one 1. Fails where q
/// is not an equilibrium.
ld_status ld_mstmm_vibration(ld_mstmm *system, const double *q, const double *tau,
                             ld_mstmm_mode *modes, double *shapes, int *count, ld_error *error);

/// Drive forces at an instant: fills tau [speed_count] and wrench [6 per element], zero on entry
/// but for what `motion` has given. It may ask the system for places and motions.
typedef void (*ld_mstmm_drive)(double t, const double *q, const double *u, double *tau,
                               double *wrench, void *context);
/// Motion of the prescribed hinges at an instant: writes their coordinates into q, their speeds
/// into u and the speeds' rates into u_dot; the other entries are to be left alone.
typedef void (*ld_mstmm_motion)(double t, double *q, double *u, double *u_dot, void *context);
/// Receives the state at every output instant; other than 0 stops the integration.
typedef int (*ld_mstmm_sink)(double t, const double *q, const double *u, void *context);

typedef struct ld_mstmm_settings {
    double rtol, atol;    ///< tolerances; 0: 1e-8 each
    double output_step;   ///< [s] between calls of the sink
    ld_mstmm_drive drive; ///< NULL: no drive forces
    ld_mstmm_sink sink;   ///< NULL: none
    void *context;
    ld_mstmm_motion motion;  ///< NULL: prescribed hinges move as they start
    const void *reserved[3]; ///< NULL: room for what later versions may be asked
} ld_mstmm_settings;

typedef struct ld_mstmm_statistics {
    int64_t steps, evaluations;
} ld_mstmm_statistics;

/// Integrates from t_0 to t_1 by error-controlled Dormand-Prince steps; q and u hold the start and
/// get the end. statistics may be NULL.
ld_status ld_mstmm_integrate(ld_mstmm *system, const ld_mstmm_settings *settings, double t_0,
                             double t_1, double *q, double *u, ld_mstmm_statistics *statistics,
                             ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
