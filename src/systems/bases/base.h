// What carries the tube: where the frame T of the undeformed tube is, how it moves, and what the
// tube's wrench does to it (model.md, section 2). Each kind is a file base_*.c with a table of
// functions, listed in LD_BASE_KINDS. The equations do not ask which kind it is; base_is_vehicle is
// there for what a vehicle alone has: subsystems integrated apart, geometry, figures at rest.
//
// Some kinds go where time or a caller says. Others have a motion of their own, with rates, works,
// equilibrium and natural frequencies: they fill in `dynamics`.
#ifndef LD_SYSTEMS_BASE_H
#define LD_SYSTEMS_BASE_H

#include <stdio.h>

#include "base/archive.h"
#include "elements/exchange.h"
#include "model/blocks/base.h"
#include "model/quantity.h"
#include "systems/bases/vehicle.h"
#include "systems/mechanism/mechanism.h"
#include "systems/mechanism/mechanism_joints.h"

// The works of a base of kind multibody: those of its mechanism, then those of its wheels.
enum { MULTIBODY_POWERS = MECHANISM_POWERS + MARCHING_POWERS };

enum {
    BASE_MOST_STATES = MECHANISM_MOST_STATES,
    BASE_MOST_WORKS = MULTIBODY_POWERS,
    BASE_MOST_EVENTS = LD_MAX_WHEELS + LD_MAX_FEET,
    BASE_MOST_SPEEDS = MECHANISM_MOST_SPEEDS,
    BASE_MOST_FREEDOMS = MECHANISM_MOST_SPEEDS + MECHANISM_MOST_HOLDS + 3 * LD_MAX_WHEELS,
    BASE_GROUPS = LD_MAX_BODIES + LD_MAX_BEAMS + 3, // of what moves in a natural mode
};
_Static_assert((int)VEHICLE_POWERS <= (int)MULTIBODY_POWERS, "works of a vehicle");

typedef struct base_interface base_interface;

// What may act on a launcher from outside, by name.
typedef struct base_inputs {
    double motion[6]; // [m], [rad] x, y, z, yaw, pitch, roll of a base with a given motion
    double road[LD_MAX_WHEELS];           // [m] height under each wheel
    double command[MECHANISM_MOST_HOLDS]; // [rad] of hinges
    v3 force, moment;           // [N], [N m] on the body on the wheels, in I, about its origin
    v3 tube_force, tube_moment; // [N], [N m] on what holds the tube, in T, about its origin
    launching_load launching;   // on tube and rocket
} base_inputs;

// A base that is linearised is at rest on flat ground, whatever the scenario moves it by; what is
// added to that, its rate and, of its motion, its acceleration.
typedef struct base_disturbance {
    base_inputs input, rate, acceleration;
} base_disturbance;

// A base as it was built; a run has a copy (base_share) with `tube` and `disturbed` of its own.
typedef struct base_system {
    const base_interface *kind;
    const ld_model *model;
    void *own;   // what the kind made of the model; constant but for its workspace
    int tube;    // that launches now, in the order of firing
    road **kept; // while it is built: a road that it may take over; NULL: none
    const base_disturbance *disturbed; // linearised; NULL: it goes as the scenario says
    int state_count, work_count, event_count;
    int speed_at, speed_count; // in the state: generalised speeds of what carries the tube
    int freedom_count;         // unknowns of its equilibrium
    bool drifts;               // errors of the steps open its loops: dynamics->project
    int displacement_count, extra_count; // unknowns of its linearised equations
} base_system;

// The frame that an FMU reports, at time t [s].
typedef struct fmu_found {
    base_frame frame;
    double t;
} fmu_found;

// What a kind finds when it places the tube, and requires again in the same evaluation.
typedef union base_found {
    mechanism_motion mechanism;
    fmu_found fmu;
} base_found;

// What a mechanism and its wheels report besides rates and works.
typedef struct base_report {
    mechanism_output mechanism;
    marching_output marching;
    double jet; // [N] of all jets, along -x of T
} base_report;

// Of a base that an FMU moves.
typedef struct fmu_instant {
    double work; // [J] that the wrench did on it
} fmu_instant;

// A joint that turns about one axis or slides along one.
typedef struct axis_instant {
    double state[2]; // coordinate and its rate
    double friction; // [N m], [N]
} axis_instant;

// A joint of several coordinates, in the order of the multibody system (launchdyn/mstmm.h).
typedef struct joint_instant {
    double q[JOINT_MOST_COORDINATES], u[JOINT_MOST_SPEEDS];
    double angles[3]; // [rad] yaw, pitch, roll of a spherical one
} joint_instant;

// What the quantities of a mechanism are about.
typedef struct multibody_instant {
    rolling_instant rolling; // first, as of a vehicle
    body_instant body[LD_MAX_BODIES], beam[LD_MAX_BEAMS], carrier;
    double coordinate[LD_MAX_BEAMS * LD_MAX_BEAM_COORDINATES]; // [kg0.5 m]
    axis_instant turn[LD_MAX_JOINTS], slide[LD_MAX_JOINTS];
    joint_instant cylinder[LD_MAX_JOINTS], universal[LD_MAX_JOINTS], plane[LD_MAX_JOINTS],
        ball[LD_MAX_JOINTS];
    joint_load joint[LD_MAX_JOINTS];
    hinge_report drive[LD_MAX_DRIVES];
    struct {
        strut_report spring;
        double push; // [N] of its actuator
    } strut[LD_MAX_STRUTS];
    foot_report foot[LD_MAX_FEET];
    v3 bushing[LD_MAX_BUSHINGS];
} multibody_instant;

// What its quantities stand in.
typedef union base_instant {
    vehicle_instant vehicle;
    multibody_instant multibody;
    fmu_instant fmu;
} base_instant;

// What the tube does to its base, in I, the moment about T's origin.
typedef struct base_wrench {
    v3 force, moment; // [N], [N m]
} base_wrench;

// What keeps what it was in the equilibrium.
typedef union base_rest {
    double number[2 * MECHANISM_MOST_HOLDS]; // all of them
    hold_rest hold[MECHANISM_MOST_HOLDS];
} base_rest;

// What acts on a base.
typedef struct base_load {
    v3 force, moment;            // [N], [N m] of the tube, about T's origin, in T
    const guide_wrench *station; // and on each station, in its axes; NULL: it has none
    jet_wrench jet;              // of a vehicle, on its platform
    base_rest rest;
    bool held;   // it carries what `rest` says, whatever drives it (equilibrium)
    bool linear; // no Coulomb friction, its drives linear (equilibrium, linearisation)
} base_load;

typedef struct base_output {
    double rate[BASE_MOST_STATES];
    double power[BASE_MOST_WORKS];
    double event[BASE_MOST_EVENTS]; // [m] a step ends where one of them rises through zero
    double elastic;                 // [J]
    base_report report;
} base_output;

// Bases with a motion of their own.
typedef struct base_dynamics {
    // Rates and what else is reported. Other than 0: singular or not finite.
    int (*evaluate)(const base_system *self, const base_found *found, const base_load *load,
                    const double *state, base_output *output);
    // [J], as found at that state
    double (*kinetic_energy)(const base_system *self, const base_found *found, const double *state);
    // Absolute tolerances of the states under the run's; where there is no relative one.
    void (*tolerances)(const base_system *self, double tolerance, double *atol, bool *absolute);
    // Gives it the velocity with which it starts.
    void (*set_start_velocity)(const base_system *self, double *state);

    // Puts a state that drifts back to where its loops close.
    void (*project)(const base_system *self, double t, double *state);

    // Its part that a state belongs to: 0 is what carries the tube, others touch only that.
    int (*part_of)(const base_system *self, int state);

    // Equilibrium: a guess under a tube and a rocket of these masses [kg]; its unknowns; what must
    // vanish; what an equilibrium must fulfil for a run to begin in it; what is kept of it.
    void (*guess)(const base_system *self, double tube, double rocket, double *state);
    // Where the scenario puts it, at rest, whatever pulls at it (run.start: undeformed). NULL: it
    // stands in equilibrium then, too.
    void (*place_as_given)(const base_system *self, double *state);
    void (*displace)(const base_system *self, int freedom, double change, double *state);
    void (*rest_of)(const base_system *self, const double *state, base_rest *rest);
    void (*residual)(const base_system *self, const base_output *output, double *r);
    ld_status (*check_rest)(const base_system *self, const base_found *found, const double *state,
                            ld_error *error);
    // Says that there is none, with the smallest residual found [m/s2].
    ld_status (*report_no_rest)(const base_system *self, double smallest, ld_error *error);
    // Fails where a motion that grows from it by `rate` [1/s] is one that nothing holds. NULL: all
    // are held.
    ld_status (*check_growing)(const base_system *self, double rate, ld_error *error);
    // Fails where nothing holds a part of it; what is to be said of the equilibrium, empty:
    // nothing. NULL: nothing is.
    ld_status (*check_held)(const base_system *self, ld_error *error);
    void (*note_rest)(const base_system *self, char *text, size_t size);

    // Linearised: small displacements; where in the state their speeds are, and what has a rate
    // alone. What moves: a group's number and the inertia [kg, kg m2] of a displacement.
    void (*displace_slightly)(const base_system *self, int displacement, double change,
                              double *state);
    int (*speed_of)(const base_system *self, int displacement);
    // Adds to the speed of a displacement, where others follow it; NULL: none does.
    void (*quicken)(const base_system *self, int displacement, double change, double *state);
    int (*extra_of)(const base_system *self, int extra);
    double (*inertia_of)(const base_system *self, int displacement, int *group);
    const char *(*group_name)(const base_system *self, int group);
    // What holds a displacement still: its key (NULL: nothing does) and what it does, [N], [N m].
    const char *(*holder_of)(const base_system *self, int displacement);
    double (*held_by)(const base_system *self, const base_output *output, int displacement);
} base_dynamics;

// Bases whose motion is found outside of the equations, from one instant to the next and no
// further; between two it is known from its state.
typedef struct base_stepping {
    // Where it stands at the run's start t [s] under this wrench, of a tube at rest on it, into the
    // state. It may be asked again with another wrench, before it goes; `moved`: by how much it
    // then stands elsewhere than before [m], [rad], infinity at first.
    ld_status (*find_rest)(const base_system *self, double t, const base_wrench *on, double *state,
                           double *moved, ld_error *error);
    // Goes from the instant t on to the next one, the wrench at t being this.
    ld_status (*step_on)(const base_system *self, double t, const base_wrench *on, double *state,
                         ld_error *error);
    // What it has besides its state, at t, as bytes, or from them into one that has not begun.
    ld_status (*archive)(const base_system *self, double t, archive *bytes, ld_error *error);
} base_stepping;

struct base_interface {
    // Fills self->own and the counts.
    ld_status (*build)(base_system *self, ld_error *error);
    void (*free)(base_system *self);
    // Takes the road out of a base that is used no more, to be freed or kept; NULL: there is none.
    road *(*take_road)(base_system *self);
    // Puts a workspace of its own in the place of self->own, shares the rest, which outlives it;
    // NULL: there is none, all is shared.
    ld_status (*share)(base_system *self, ld_error *error);
    // Frame T at time t [s] and the base's state.
    void (*find_frame)(const base_system *self, double t, const double *state, base_frame *tube,
                       base_found *found);
    // T as the sections go that carry the supports, by support; returns or is NULL: the base
    // carries them as one body.
    const base_frame *(*stations)(const base_system *self, const base_found *found);
    // Yaw, pitch, roll [rad] for output; NULL: those of T.
    void (*angles)(const base_system *self, double t, double angles[3]);
    // First and last time [s] that its table covers; NULL: all.
    void (*span)(const base_system *self, double *first, double *last);
    // The first instant [s] after t at which a step must end, and the equations change; NULL: none.
    double (*next_corner)(const base_system *self, double t);
    // The first instant [s] after t at which it changes its state on its own, as a digital loop
    // does, infinity: none; what it makes of the state at such an instant. NULL: there are none. A
    // base that is stepped continues at them instead.
    double (*next_sample)(const base_system *self, double t);
    void (*sample)(const base_system *self, double t, double *state);
    const base_stepping *stepping; // NULL: its motion is part of the equations, or reported
    // Takes frame T of the instant t [s], the present one, into the state; `first`: nothing of
    // before continues. NULL: no one reports it.
    void (*receive_frame)(const base_system *self, double t, bool first, const base_frame *now,
                          double *state);
    // Columns of its own, which stand in the base_instant that `find` fills; NULL: none.
    const quantity_table *quantities;
    void (*fill_instant)(const base_system *self, const base_found *found,
                         const base_output *output, const double *state, base_instant *instant);
    // Describes in words what it is made of, in lines that begin with "# "; NULL: nothing is said.
    void (*describe)(const base_system *self, FILE *stream);
    const base_dynamics *dynamics; // NULL: it has no motion of its own
    const quantity_table *inputs;  // which of the base_inputs it has; NULL: none
};

#define BASE_INTERFACE(name, word, number) extern const base_interface base_##word;
LD_BASE_KINDS(BASE_INTERFACE)
#undef BASE_INTERFACE

// Columns of the bases of that kind; NULL: they have none of their own.
const quantity_table *base_quantities(ld_base_kind kind);

// `kept`: a road that it may take over, which is NULL then; NULL: none.
ld_status base_build(base_system *self, const ld_model *model, road **kept, ld_error *error);
// The road under a base that is used no more, to be freed or kept; NULL: there is none.
road *base_take_road(base_system *self);
void base_free(base_system *self);

// Makes *self the base of one run; `of` must outlive it.
ld_status base_share(base_system *self, const base_system *of, ld_error *error);
void base_free_share(base_system *self);

// First and last time [s] at which the base knows where it is.
void base_span(const base_system *self, double *first, double *last);

// Yaw, pitch, roll [rad] for output: of the base itself where it reports them, else of frame T.
void base_angles(const base_system *self, double t, const base_frame *tube, double angles[3]);

// What its quantities are at an instant, where it has any of its own.
void base_find(const base_system *self, const base_found *found, const base_output *output,
               const double *state, base_instant *instant);

// The road under a vehicle of a run of its own (base_share) is this one, which outlives it.
void base_set_road(base_system *self, road *under);

// A base of kind multibody; NULL: it is none.
const mechanism_system *base_as_multibody(const base_system *self);
// Whether it is of kind vehicle.
bool base_is_vehicle(const base_system *self);

#endif
