#include "systems/mechanism/mechanism_build.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "systems/mechanism/carried_tubes.h"
#include "systems/mechanism/mechanism_seen.h"

// The elements of the tree as they are listed: bodies, beams, points of beams.
typedef struct element_list {
    int count;
    ld_mstmm_element element[MECHANISM_MOST_ELEMENTS];
    char name[MECHANISM_MOST_ELEMENTS][LD_MAX_NAME];
    ld_mstmm_beam beam[LD_MAX_BEAMS];
    int loop_count;
    ld_mstmm_loop loop[LD_MAX_JOINTS];
} element_list;

// A_XY of yaw, pitch, roll.
static m3 turned(const double angles[3])
{
    return m3_mul(m3_rotation_y(angles[0]),
                  m3_mul(m3_rotation_z(angles[1]), m3_rotation_x(angles[2])));
}

static void store_attitude(double to[4], m3 A)
{
    quat q = q_from_matrix(A);
    memcpy(to, (double[]){q.w, q.x, q.y, q.z}, 4 * sizeof *to);
}

static bool is_beam(const ld_mechanism *given, int body)
{
    return body >= given->body_count;
}

// ---- bodies

static void add_body(element_list *list, const ld_body *body)
{
    ld_mstmm_element *e = &list->element[list->count++];
    *e = (ld_mstmm_element){.name = body->name, .mass = body->mass};
    memcpy(e->center, body->center, sizeof e->center);
    memcpy(e->inertia, body->inertia, 3 * sizeof *e->inertia);
    memcpy(e->inertia + 3, body->products, 3 * sizeof *e->inertia);
}

static void add_beam(element_list *list, const ld_beam *given, ld_mstmm_beam *beam)
{
    *beam =
        (ld_mstmm_beam){.length = given->length,
                        .section_count = given->section_count,
                        .section = given->section,
                        .bending = given->modes.bending,
                        .torsion = given->modes.torsion,
                        .axial = given->modes.axial,
                        .elements = given->modes.elements,
                        .damping = given->modes.damping,
                        .geometric_stiffness = given->modes.geometric_stiffness == LD_GEOMETRIC_YES,
                        .shear_coefficient = given->modes.shear_coefficient,
                        .span = given->modes.span};
    list->element[list->count++] = (ld_mstmm_element){.name = given->name, .beam = beam};
}

// The frame of the body that carries the tubes with those that do not launch.
static ld_status add_tubes(mechanism_system *self, element_list *list, const mechanism_tubes *tubes,
                           ld_error *error)
{
    ld_mstmm_element *e = &list->element[self->tube.element];
    carried_mass all = carried_body(e->mass, v3_from(e->center), e->inertia);
    ld_status status = carried_tubes(&all, self->model, tubes, &self->tube.axes, error);
    if (status || all.mass == e->mass)
        return status;
    carried_store(&all, e);
    return LD_OK;
}

// ---- joints

static const ld_hinge hinges[] = {
    [LD_JOINT_FIXED] = LD_HINGE_WELD,          [LD_JOINT_REVOLUTE] = LD_HINGE_REVOLUTE,
    [LD_JOINT_PRISMATIC] = LD_HINGE_PRISMATIC, [LD_JOINT_CYLINDRICAL] = LD_HINGE_CYLINDRICAL,
    [LD_JOINT_UNIVERSAL] = LD_HINGE_UNIVERSAL, [LD_JOINT_SPHERICAL] = LD_HINGE_SPHERICAL,
    [LD_JOINT_PLANAR] = LD_HINGE_PLANAR,       [LD_JOINT_FREE] = LD_HINGE_FREE,
};

// How many speeds of a joint slide and turn, in their order.
static void freedoms(ld_joint_kind kind, int *slides, int *turns)
{
    static const int table[][2] = {
        [LD_JOINT_FIXED] = {0, 0},     [LD_JOINT_REVOLUTE] = {0, 1},
        [LD_JOINT_PRISMATIC] = {1, 0}, [LD_JOINT_CYLINDRICAL] = {1, 1},
        [LD_JOINT_UNIVERSAL] = {0, 2}, [LD_JOINT_SPHERICAL] = {0, 3},
        [LD_JOINT_PLANAR] = {2, 1},    [LD_JOINT_FREE] = {3, 3},
    };
    *slides = table[kind][0];
    *turns = table[kind][1];
}

static void set_springs(const ld_joint *joint, double *stiffness, double *damping, double *rest)
{
    int slides, turns;
    freedoms(joint->kind, &slides, &turns);
    for (int k = 0; k < slides + turns; k++) {
        stiffness[k] = k < slides ? joint->stiffness : joint->rotational_stiffness;
        damping[k] = k < slides ? joint->damping : joint->rotational_damping;
    }
    bool single = joint->kind == LD_JOINT_REVOLUTE || joint->kind == LD_JOINT_PRISMATIC ||
                  joint->kind == LD_JOINT_CYLINDRICAL;
    if (single && slides)
        rest[0] = joint->rest_length;
    if (single && turns)
        rest[slides] = joint->rest_angle;
}

// A direction across the axis of a planar joint, along which its first coordinate counts.
static void in_plane(const ld_joint *joint, double axis_2[3])
{
    v3 axis = v3_from(joint->axis);
    bool along_x = fabs(axis.x) > 0.9 * v3_norm(axis);
    if (joint->kind == LD_JOINT_PLANAR)
        memcpy(axis_2, along_x ? (double[]){0, 1, 0} : (double[]){1, 0, 0}, 3 * sizeof *axis_2);
}

static const char *element_name(const element_list *list, int body)
{
    return body >= 0 ? list->element[body].name : body == LD_ON_CARRIER ? "carrier" : NULL;
}

static void carry(const ld_joint *joint, const char *parent, ld_mstmm_element *e)
{
    e->parent = parent;
    e->hinge = hinges[joint->kind];
    memcpy(e->at, joint->at, sizeof e->at);
    memcpy(e->axis, joint->axis, sizeof e->axis);
    memcpy(e->axis_2, joint->axis_2, sizeof e->axis_2);
    in_plane(joint, e->axis_2);
    store_attitude(e->attitude, turned(joint->attitude));
    set_springs(joint, e->stiffness, e->damping, e->rest);
}

static void close_loop(const ld_joint *joint, const char *parent, const char *body,
                       ld_mstmm_loop *loop)
{
    *loop = (ld_mstmm_loop){.name = joint->name, .joint = hinges[joint->kind]};
    loop->first.element = parent;
    loop->second.element = body;
    memcpy(loop->first.at, joint->at, sizeof joint->at);
    for (int k = 0; k < 3; k++)
        loop->second.at[k] = isnan(joint->body_at[k]) ? 0 : joint->body_at[k];
    store_attitude(loop->first.attitude, turned(joint->attitude));
    store_attitude(loop->second.attitude, turned(joint->body_attitude));
    memcpy(loop->axis, joint->axis, sizeof loop->axis);
    memcpy(loop->axis_2, joint->axis_2, sizeof loop->axis_2);
    in_plane(joint, loop->axis_2);
    set_springs(joint, loop->stiffness, loop->damping, loop->rest);
}

// The first joint that names a body carries it, others close loops.
static void join(mechanism_system *self, element_list *list)
{
    const ld_mechanism *given = self->given;
    bool carried[LD_MAX_BODIES + LD_MAX_BEAMS] = {0};
    for (int i = 0; i < given->joint_count; i++) {
        const ld_joint *joint = &given->joint[i];
        int body = mechanism_body(given, joint->body);
        const char *parent = element_name(list, mechanism_body(given, joint->parent));
        self->joint_element[i] = carried[body] ? -1 : body;
        self->joint_loop[i] = carried[body] ? list->loop_count : -1;
        if (carried[body])
            close_loop(joint, parent, list->element[body].name, &list->loop[list->loop_count++]);
        else
            carry(joint, parent, &list->element[body]);
        carried[body] = true;
    }
}

// ---- points

// A point of a body by its name; of a beam a massless element that its section carries.
static mechanism_point point_of(mechanism_system *self, element_list *list, const char *name,
                                const double at[3], m3 axes)
{
    int body = mechanism_body(self->given, name);
    mechanism_point point = {.element = body, .at = v3_from(at), .axes = axes};
    self->carried |= body == LD_ON_CARRIER;
    if (body < 0) {
        point.element = body == LD_ON_CARRIER ? MECHANISM_CARRIER : MECHANISM_GROUND;
        return point;
    }
    if (!is_beam(self->given, body))
        return point;
    int i = list->count++;
    snprintf(list->name[i], sizeof *list->name, "point %d of %.40s", i, name);
    list->element[i] = (ld_mstmm_element){.name = list->name[i],
                                          .parent = list->element[body].name,
                                          .hinge = LD_HINGE_WELD,
                                          .at = {at[0], at[1], at[2]}};
    point.element = i;
    point.at = v3_zero();
    return point;
}

// A section of the beam for each support where that stands unbent, T fixed to it.
static void find_stations(mechanism_system *self, element_list *list, const mechanism_plan *plan,
                          v3 rear)
{
    const ld_tubes *tubes = &self->model->tubes;
    self->station_count = tubes->support_count;
    for (int k = 0; k < tubes->support_count; k++) {
        v3 arm = m3_apply(plan->mount, v3_make(tubes->support[k].at, 0, 0));
        double at[3];
        v3_store(at, v3_add(rear, arm));
        self->station[k] = point_of(self, list, plan->carries, at, plan->mount);
        self->station[k].at = v3_neg(arm);
    }
}

static void find_points(mechanism_system *self, element_list *list)
{
    const ld_mechanism *given = self->given;
    const m3 E = m3_identity();
    for (int i = 0; i < given->strut_count; i++) {
        const ld_strut *strut = &given->strut[i];
        self->strut[i].from = point_of(self, list, strut->from, strut->at, E);
        self->strut[i].to = point_of(self, list, strut->to, strut->to_at, E);
    }
    for (int i = 0; i < given->bushing_count; i++) {
        const ld_bushing *bushing = &given->bushing[i];
        self->bushing[i].from =
            point_of(self, list, bushing->from, bushing->at, turned(bushing->attitude));
        double at[3];
        for (int k = 0; k < 3; k++)
            at[k] = isnan(bushing->to_at[k]) ? 0 : bushing->to_at[k];
        self->bushing[i].to = point_of(self, list, bushing->to, at, E);
    }
    for (int i = 0; i < given->foot_count; i++)
        self->foot[i] = point_of(self, list, given->foot[i].body, given->foot[i].at, E);
    for (int i = 0; i < given->load_count; i++)
        self->load[i] = point_of(self, list, given->load[i].body, given->load[i].at, E);
    for (int i = 0; i < given->drag_count; i++)
        self->drag[i] = point_of(self, list, given->drag[i].body, given->drag[i].at, E);
}

// A frame that moves as is said, the last element.
static void add_carrier(mechanism_system *self, element_list *list)
{
    self->carrier = MECHANISM_GROUND;
    for (int i = 0; i < self->given->joint_count; i++)
        if (mechanism_body(self->given, self->given->joint[i].parent) == LD_ON_CARRIER)
            self->carrier = list->count;
    self->carried |= self->carrier >= 0;
    if (self->carrier >= 0)
        list->element[list->count++] =
            (ld_mstmm_element){.name = "carrier", .hinge = LD_HINGE_FREE, .prescribed = 1};
}

// ---- holds

static mechanism_hold *add_hold(mechanism_system *self, const char *name)
{
    mechanism_hold *hold = &self->hold[self->hold_count++];
    *hold = (mechanism_hold){.joint = -1, .strut = -1, .drive = -1, .of = -1};
    snprintf(hold->name, sizeof hold->name, "%s", name);
    return hold;
}

static void hold_joint(const mechanism_system *self, mechanism_hold *hold, int joint)
{
    const ld_joint *given = &self->given->joint[joint];
    int element = self->joint_element[joint];
    hold->joint = joint;
    hold->q = ld_mstmm_coordinate_offset(self->chain, element);
    hold->u = ld_mstmm_speed_offset(self->chain, element);
    hold->command = given->kind == LD_JOINT_PRISMATIC ? given->displacement : given->angle;
}

// That of a joint which closes at the start; NULL: none.
static const ld_hinge_lock *lock_at_once(const ld_joint *joint)
{
    const ld_joint_lock *lock = &joint->lock;
    return lock->spring.present && isnan(lock->from) ? &lock->spring : NULL;
}

static void find_holds(mechanism_system *self)
{
    const ld_mechanism *given = self->given;
    bool driven[LD_MAX_JOINTS] = {0};
    for (int i = 0; i < given->drive_count; i++) {
        const ld_joint_drive *drive = &given->drive[i];
        mechanism_hold *hold = add_hold(self, drive->name);
        int joint = mechanism_joint(given, drive->joint);
        hold_joint(self, hold, joint);
        driven[joint] = true;
        snprintf(hold->stream, sizeof hold->stream, "base.drives.%s", drive->name);
        hold->control = drive->form == LD_DRIVE_ANGLE ? &drive->angle : &drive->length;
        hold->follows = drive->follows;
        hold->of = drive->of[0] ? mechanism_body(given, drive->of) : -1;
        hold->lock = lock_at_once(&given->joint[joint]);
    }
    for (int i = 0; i < given->joint_count; i++) {
        const ld_joint *joint = &given->joint[i];
        if (driven[i] || !lock_at_once(joint))
            continue;
        mechanism_hold *hold = add_hold(self, joint->name);
        hold_joint(self, hold, i);
        hold->lock = lock_at_once(joint);
    }
    for (int i = 0; i < given->strut_count; i++) {
        if (!given->strut[i].driven)
            continue;
        mechanism_hold *hold = add_hold(self, given->strut[i].name);
        hold->strut = i;
        hold->control = &given->strut[i].actuator;
        snprintf(hold->stream, sizeof hold->stream, "base.struts.%s", given->strut[i].name);
    }
}

// ---- the state

static void lay_out(mechanism_system *self)
{
    bool drives = false;
    bool carried = self->carrier >= 0;
    self->q_count = ld_mstmm_coordinate_count(self->chain) - 7 * carried;
    self->u_count = ld_mstmm_speed_count(self->chain) - 6 * carried;
    self->z_at = self->q_count + self->u_count;
    self->freedom_count = self->u_count;
    for (int k = 0; k < self->u_count; k++)
        self->freedom[k] = k;
    int at = self->z_at + self->hold_count;
    for (int i = 0; i < self->hold_count; i++) {
        const mechanism_hold *hold = &self->hold[i];
        drives |= hold->control && !hold->lock && stabiliser_has_drive(hold->control);
    }
    for (int i = 0; drives && i < self->hold_count; i++, at += DRIVE_STATES)
        self->hold[i].drive = at;
    for (int i = 0; i < self->given->joint_count; i++) {
        const ld_joint_lock *lock = &self->given->joint[i].lock;
        if (!lock->spring.present || isnan(lock->from))
            continue;
        int element = self->joint_element[i];
        self->later[self->later_count++] =
            (mechanism_later_lock){i, ld_mstmm_coordinate_offset(self->chain, element),
                                   ld_mstmm_speed_offset(self->chain, element), at++};
    }
    self->feet_at = at;
    self->state_count = at + 2 * self->given->foot_count;
}

static ld_status build_chain(mechanism_system *self, element_list *list, const mechanism_plan *plan,
                             const mechanism_tubes *tubes, ld_error *error)
{
    const ld_mechanism *given = self->given;
    for (int i = 0; i < given->body_count; i++)
        add_body(list, &given->body[i]);
    for (int i = 0; i < given->beam_count; i++)
        add_beam(list, &given->beam[i], &list->beam[i]);
    join(self, list);
    v3 first = v3_from(self->model->tubes.layout.first);
    v3 row = m3_apply(plan->mount, carried_tube_row(&self->model->tubes.layout, tubes->launching));
    double at[3];
    v3_store(at, v3_add(first, row));
    self->tube = point_of(self, list, plan->carries, at, plan->mount);
    self->tube_turned = !m3_is_identity(&plan->mount);
    if (is_beam(given, mechanism_body(given, plan->carries))) {
        find_stations(self, list, plan, v3_from(at));
    } else {
        ld_status status = add_tubes(self, list, tubes, error);
        if (status)
            return status;
    }
    find_points(self, list);
    add_carrier(self, list);
    self->element_count = list->count;
    for (int i = 0; i < list->count; i++)
        self->mass += list->element[i].mass;
    ld_mstmm_description all = {.elements = list->element,
                                .element_count = list->count,
                                .loops = list->loop,
                                .loop_count = list->loop_count,
                                .gravity = {0, -self->model->gravity, 0}};
    return ld_mstmm_build(&all, &self->chain, error);
}

static bool has_room(const mechanism_system *self, ld_error *error)
{
    bool fits = ld_mstmm_coordinate_count(self->chain) <= MECHANISM_MOST_COORDINATES &&
                ld_mstmm_speed_count(self->chain) <= MECHANISM_MOST_SPEEDS;
    if (!fits)
        ld_fail(
            error, LD_ERR_INPUT,
            "base.joints: bodies and beams have %d degrees of freedom without loops; at most %d "
            "are allowed",
            ld_mstmm_speed_count(self->chain), (int)MECHANISM_MOST_SPEEDS);
    return fits;
}

ld_status mechanism_build(mechanism_system *self, const mechanism_plan *plan,
                          const mechanism_tubes *tubes, ld_error *error)
{
    element_list *list = calloc(1, sizeof *list);
    *self =
        (mechanism_system){.model = plan->model, .given = plan->given, .overall = plan->overall};
    if (!list)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's bodies");
    ld_status status = build_chain(self, list, plan, tubes, error);
    free(list);
    if (!status && !has_room(self, error))
        status = LD_ERR_INPUT;
    if (status)
        return status;
    int wheels = self->given->wheels_on[0] ? mechanism_body(self->given, self->given->wheels_on)
                                           : MECHANISM_GROUND;
    self->wheels = wheels;
    find_holds(self);
    lay_out(self);
    mechanism_find_seen(self);
    return LD_OK;
}

void mechanism_free(mechanism_system *self)
{
    ld_mstmm_free(self->chain);
    self->chain = NULL;
}
