#include "support/mechanism_case.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "support/dense_vehicle.h"
#include "support/draw.h"
#include "support/reference_model.h"
#include "support/stabiliser_options.h"
#include "systems/bases/mechanism_base.h"
#include "systems/mechanism/mechanism_loops.h"

static bool heads(uint64_t *seed)
{
    return draw(seed) > 0;
}

static void fill3(uint64_t *seed, double x[3], double size)
{
    for (int i = 0; i < 3; i++)
        x[i] = size * draw(seed);
}

static void sizes3(uint64_t *seed, double x[3], double low, double high)
{
    for (int i = 0; i < 3; i++)
        x[i] = draw_size(seed, low, high);
}

static void nan3(double x[3])
{
    x[0] = x[1] = x[2] = NAN;
}

// ---------------------------------------------------------------- bodies and joints

static void draw_body(uint64_t *seed, int number, ld_body *body)
{
    snprintf(body->name, sizeof body->name, "b%d", number);
    body->mass = draw_size(seed, 20, 500);
    fill3(seed, body->center, 0.4);
    m3 J = draw_inertia(seed, body->mass);
    for (int i = 0; i < 3; i++)
        body->inertia[i] = J.a[i][i];
    body->products[0] = J.a[0][1];
    body->products[1] = J.a[0][2];
    body->products[2] = J.a[1][2];
}

static int freedoms_of(ld_joint_kind kind)
{
    static const int count[] = {
        [LD_JOINT_FIXED] = 0,       [LD_JOINT_REVOLUTE] = 1,  [LD_JOINT_PRISMATIC] = 1,
        [LD_JOINT_CYLINDRICAL] = 2, [LD_JOINT_UNIVERSAL] = 2, [LD_JOINT_SPHERICAL] = 3,
        [LD_JOINT_PLANAR] = 3,      [LD_JOINT_FREE] = 6};
    return count[kind];
}

static void draw_springs(uint64_t *seed, ld_joint *joint)
{
    bool slides = joint->kind == LD_JOINT_PRISMATIC || joint->kind == LD_JOINT_CYLINDRICAL ||
                  joint->kind == LD_JOINT_PLANAR || joint->kind == LD_JOINT_FREE;
    bool turns = joint->kind != LD_JOINT_FIXED && joint->kind != LD_JOINT_PRISMATIC;
    if (slides) {
        joint->stiffness = draw_size(seed, 1e3, 1e5);
        joint->damping = draw_size(seed, 10, 1e3);
    }
    if (turns) {
        joint->rotational_stiffness = draw_size(seed, 1e2, 1e4);
        joint->rotational_damping = draw_size(seed, 10, 1e3);
    }
    if (joint->kind == LD_JOINT_PRISMATIC || joint->kind == LD_JOINT_CYLINDRICAL)
        joint->rest_length = 0.3 * draw(seed);
    if (joint->kind == LD_JOINT_REVOLUTE || joint->kind == LD_JOINT_CYLINDRICAL)
        joint->rest_angle = draw(seed);
}

static void draw_frame(uint64_t *seed, ld_joint *joint)
{
    fill3(seed, joint->at, 0.7);
    fill3(seed, joint->attitude, 3);
    fill3(seed, joint->axis, 2);
    fill3(seed, joint->axis_2, 2);
    if (heads(seed)) {
        // axes as scenarios have them
        int k = (int)(1.5 + 1.5 * draw(seed)) % 3;
        for (int i = 0; i < 3; i++) {
            joint->axis[i] = i == k;
            joint->axis_2[i] = i == (k + 1) % 3;
        }
    }
}

// In the plane of x and y: turns about z, slides in the plane.
static void flatten(ld_joint *joint)
{
    bool slides = joint->kind == LD_JOINT_PRISMATIC;
    joint->at[2] = joint->attitude[0] = joint->attitude[2] = 0;
    for (int i = 0; i < 3; i++) {
        joint->axis[i] = slides ? (i < 2 ? joint->axis[i] + 0.1 : 0) : i == 2;
        joint->axis_2[i] = i == 0;
    }
}

static bool single(const ld_joint *joint)
{
    return joint->kind == LD_JOINT_REVOLUTE || joint->kind == LD_JOINT_PRISMATIC;
}

// Friction, stops and locks of a joint with one axis.
static void draw_holders(uint64_t *seed, ld_joint *joint)
{
    if (!single(joint))
        return;
    if (heads(seed))
        joint->friction = (ld_hinge_friction){draw_size(seed, 10, 1e3), draw_size(seed, 1, 1e3),
                                              draw_size(seed, 1e-3, 1)};
    if (heads(seed))
        joint->stops = (ld_joint_stops){true, NAN, NAN, draw_size(seed, 1e4, 1e6),
                                        heads(seed) ? draw_size(seed, 10, 1e4) : 0};
    if (heads(seed))
        joint->lock = (ld_joint_lock){{true, draw_size(seed, 1e4, 1e6), draw_size(seed, 1e2, 1e4)},
                                      heads(seed) ? NAN : draw(seed)};
}

static void draw_tree_joint(uint64_t *seed, ld_joint_kind kind, bool elements, ld_joint *joint)
{
    joint->kind = kind;
    draw_frame(seed, joint);
    nan3(joint->body_at);
    joint->lock.from = NAN;
    joint->stops.low = joint->stops.high = NAN;
    joint->angle = 2 * draw(seed);
    joint->angle_2 = draw(seed);
    joint->displacement = 0.4 * draw(seed);
    if (elements && heads(seed))
        draw_springs(seed, joint);
    if (elements)
        draw_holders(seed, joint);
}

// Bodies in the tree's order: the place of each in the list.
typedef struct drawing {
    int order[LD_MAX_BODIES];
    int parent[LD_MAX_BODIES], kind[LD_MAX_BODIES]; // by place in the tree
    int freedoms, constraints;
} drawing;

static void shuffle(uint64_t *seed, int n, int *order)
{
    for (int i = 0; i < n; i++)
        order[i] = i;
    for (int i = n - 1; i > 0; i--) {
        int k = tree_pick(i + 1, seed), swap = order[i];
        order[i] = order[k];
        order[k] = swap;
    }
}

static void name_body(int body, bool carrier, char name[LD_MAX_NAME])
{
    if (body >= 0)
        snprintf(name, LD_MAX_NAME, "b%d", body);
    else
        snprintf(name, LD_MAX_NAME, "%s", carrier ? "carrier" : "ground");
}

static void draw_tree(uint64_t *seed, int kind, const mechanism_options *options, drawing *d,
                      ld_mechanism *given)
{
    int n = given->body_count = given->joint_count = options->bodies;
    shuffle(seed, n, d->order);
    for (int i = 0; i < n; i++)
        draw_body(seed, i, &given->body[i]);
    for (int i = 0; i < n; i++) {
        ld_joint *joint = &given->joint[i];
        bool root = i == 0 || (!options->isolated && tree_pick(6, seed) == 0);
        int to = root ? -1 : d->order[tree_pick(i, seed)];
        bool rolls = (options->wheels || options->isolated) && i == 0;
        ld_joint_kind of = rolls ? LD_JOINT_FREE : (ld_joint_kind)((kind + 3 * i) % 8);
        // a body that is welded to the ground gives nothing to compare
        if (to < 0 && of == LD_JOINT_FIXED && i == 0)
            of = LD_JOINT_REVOLUTE;
        if (options->flat)
            of = i % 3 == 2 ? LD_JOINT_PRISMATIC : i == 4 ? LD_JOINT_PLANAR : LD_JOINT_REVOLUTE;
        draw_tree_joint(seed, of, options->elements && !(options->isolated && i == 0), joint);
        if (options->flat)
            flatten(joint);
        snprintf(joint->name, sizeof joint->name, "j%d", i);
        snprintf(joint->body, sizeof joint->body, "b%d", d->order[i]);
        bool carried = options->carrier && !rolls && tree_pick(3, seed) > 0;
        name_body(to, carried, joint->parent);
        d->freedoms += freedoms_of(of);
    }
    if (options->wheels)
        snprintf(given->wheels_on, sizeof given->wheels_on, "b%d", d->order[0]);
}

// ---------------------------------------------------------------- loops

static m3 about(const double axis[3], double angle)
{
    v3 e = v3_from(axis), n = v3_scale(1 / v3_norm(e), e);
    m3 S = m3_skew(n);
    return m3_add(m3_identity(),
                  m3_add(m3_scale(sin(angle), S), m3_scale(1 - cos(angle), m3_mul(S, S))));
}

// Displacement and turn of a joint somewhere in its range, in its own axes.
static void draw_pose(uint64_t *seed, const ld_joint *joint, v3 *slide, m3 *turn)
{
    v3 e = v3_from(joint->axis);
    e = v3_scale(1 / v3_norm(e), e);
    *slide = v3_zero();
    *turn = m3_identity();
    if (joint->kind == LD_JOINT_PRISMATIC || joint->kind == LD_JOINT_CYLINDRICAL)
        *slide = v3_scale(0.5 * draw(seed), e);
    if (joint->kind == LD_JOINT_PLANAR)
        *slide = v3_cross(e, draw_v3(seed, 0.5));
    if (joint->kind == LD_JOINT_REVOLUTE || joint->kind == LD_JOINT_CYLINDRICAL ||
        joint->kind == LD_JOINT_PLANAR)
        *turn = about(joint->axis, 1.5 * draw(seed));
    if (joint->kind == LD_JOINT_UNIVERSAL)
        *turn = m3_mul(about(joint->axis, draw(seed)), about(joint->axis_2, draw(seed)));
    if (joint->kind == LD_JOINT_SPHERICAL)
        *turn = draw_rotation(seed);
}

// The frame on the body where a joint closes as bodies are now.
static void fit(uint64_t *seed, const dense_frame *p, const dense_frame *b, ld_joint *joint)
{
    m3 axes = m3_mul(m3_rotation_y(joint->attitude[0]),
                     m3_mul(m3_rotation_z(joint->attitude[1]), m3_rotation_x(joint->attitude[2])));
    v3 slide;
    m3 turn, A = m3_mul(p->A, axes);
    draw_pose(seed, joint, &slide, &turn);
    v3 r = v3_add(p->r, m3_apply(p->A, v3_from(joint->at)));
    r = v3_add(r, m3_apply(A, slide));
    A = m3_mul(A, turn);
    v3_store(joint->body_at, m3_apply_transposed(b->A, v3_sub(r, b->r)));
    m3 own = m3_mul(m3_transpose(b->A), A);
    m3_yaw_pitch_roll(&own, joint->body_attitude);
}

static const base_frame STILL = {.A = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .q = {1, 0, 0, 0}};

static void place_start(const ld_model *model, const base_frame *carrier,
                        dense_mechanism_output *out)
{
    static const hold_rest rest[MECHANISM_MOST_HOLDS];
    dense_mechanism dense;
    double state[BASE_MOST_STATES];
    dense_mechanism_create(&dense, model, model->firing[0].tube, NULL, 0);
    dense_mechanism_start(&dense, state);
    dense_mechanism_input input = {
        .t = -2, .state = state, .carrier = carrier, .rest = rest, .held = true};
    if (!dense_mechanism_evaluate(&dense, &input, out))
        out->redundant = -1;
}

// How many of a flat joint's constraints flat motions imply already.
static int implied(ld_joint_kind kind)
{
    static const int count[] = {
        [LD_JOINT_FIXED] = 3,       [LD_JOINT_REVOLUTE] = 3,  [LD_JOINT_PRISMATIC] = 3,
        [LD_JOINT_CYLINDRICAL] = 2, [LD_JOINT_UNIVERSAL] = 2, [LD_JOINT_SPHERICAL] = 1,
        [LD_JOINT_PLANAR] = 3};
    return count[kind];
}

// Joints that leave the tree at least two freedoms and hold what is not held yet.
static void draw_loops(uint64_t *seed, int kind, const mechanism_options *options, drawing *d,
                       const base_frame *carrier, ld_model *model)
{
    ld_mechanism *given = &model->base.mechanism;
    static const dense_frame still = {.A = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    static dense_mechanism_output out;
    int redundant = 0;
    for (int i = 0, tries = 0; i < options->loops && tries < 60; tries++) {
        ld_joint *joint = &given->joint[given->joint_count];
        ld_joint_kind of = (ld_joint_kind)((kind + i + tries / 4) % 7);
        int a = tree_pick(given->body_count + 1, seed) - 1, b = tree_pick(given->body_count, seed);
        int extra = options->flat ? implied(of) : 0, held = 6 - freedoms_of(of) - extra;
        if (a == b || (options->isolated && a < 0) || d->freedoms - d->constraints - held < 2 ||
            held == 0)
            continue;
        memset(joint, 0, sizeof *joint);
        draw_tree_joint(seed, of, false, joint);
        if (options->flat)
            flatten(joint);
        if (options->elements && heads(seed))
            draw_springs(seed, joint);
        snprintf(joint->name, sizeof joint->name, "loop%d", i);
        snprintf(joint->body, sizeof joint->body, "b%d", b);
        name_body(a, false, joint->parent);
        place_start(model, carrier, &out);
        fit(seed, a >= 0 ? &out.body[a] : &still, &out.body[b], joint);
        given->joint_count++;
        place_start(model, carrier, &out);
        if (out.redundant != redundant + extra) {
            given->joint_count--;
            continue;
        }
        redundant += extra;
        d->constraints += held;
        i++;
    }
}

// ---------------------------------------------------------------- force elements

static void draw_end(uint64_t *seed, const ld_mechanism *given, const mechanism_options *options,
                     char *name)
{
    int body = options->isolated ? tree_pick(given->body_count, seed)
                                 : tree_pick(given->body_count + 1, seed) - 1;
    name_body(body, options->carrier && heads(seed), name);
}

static void draw_bushings(uint64_t *seed, const mechanism_options *options, ld_mechanism *given)
{
    given->bushing_count = tree_pick(4, seed);
    for (int i = 0; i < given->bushing_count; i++) {
        ld_bushing *b = &given->bushing[i];
        snprintf(b->name, sizeof b->name, "bushing%d", i);
        do {
            draw_end(seed, given, options, b->from);
            draw_end(seed, given, options, b->to);
        } while (strcmp(b->from, b->to) == 0);
        fill3(seed, b->at, 0.5);
        fill3(seed, b->attitude, 3);
        nan3(b->to_at);
        nan3(b->stop);
        if (heads(seed))
            fill3(seed, b->to_at, 0.5);
        sizes3(seed, b->stiffness, 1e3, 1e5);
        sizes3(seed, b->damping, 10, 1e3);
        sizes3(seed, b->rotational_stiffness, 1e2, 1e4);
        sizes3(seed, b->rotational_damping, 10, 1e3);
        for (int k = 0; k < 3; k++) {
            b->clearance[k] = heads(seed) ? 0.1 * (1 + draw(seed)) : 0;
            b->stop[k] = heads(seed) ? 0.1 + 0.1 * draw(seed) : NAN;
            b->stop_stiffness[k] = draw_size(seed, 1e4, 1e6);
        }
    }
}

static ld_table draw_command(uint64_t *seed)
{
    double row[] = {-0.5, draw(seed), 0.5, draw(seed), 1.5, draw(seed)};
    return reference_table(heads(seed) ? 1 : 3, 2, row);
}

static void draw_stabiliser(uint64_t *seed, ld_stabiliser *s)
{
    *s = (ld_stabiliser){.command = draw_command(seed),
                         .kp = draw_size(seed, 1e3, 1e5),
                         .ki = draw_size(seed, 1e3, 1e5),
                         .kd = draw_size(seed, 1e2, 1e4),
                         .torque_limit = draw_size(seed, 1e2, 1e4)};
    if (heads(seed))
        draw_stabiliser_options(seed, s);
    s->cascade.rate_kp *= 1e-2;
    s->cascade.rate_ki *= 1e-2;
    s->gear.stiffness *= 1e-2;
    s->gear.damping *= 1e-2;
    s->slew *= 1e-2;
}

// Of a length: what its table of fields has no key for is not there.
static void draw_positioner(uint64_t *seed, ld_stabiliser *s)
{
    draw_stabiliser(seed, s);
    s->feedforward = 0;
    s->cascade = (ld_cascade){0};
    s->gear = (ld_gear){0};
    s->noise = (ld_sensor_noise){0};
    s->resolution = (ld_resolution){0};
}

static void draw_struts(uint64_t *seed, const mechanism_options *options, ld_mechanism *given)
{
    given->strut_count = tree_pick(4, seed);
    for (int i = 0; i < given->strut_count; i++) {
        ld_strut *s = &given->strut[i];
        snprintf(s->name, sizeof s->name, "strut%d", i);
        do {
            draw_end(seed, given, options, s->from);
            draw_end(seed, given, options, s->to);
        } while (strcmp(s->from, s->to) == 0);
        fill3(seed, s->at, 0.5);
        fill3(seed, s->to_at, 0.5);
        s->stiffness = draw_size(seed, 1e3, 1e5);
        s->damping = draw_size(seed, 10, 1e3);
        s->length = heads(seed) ? NAN : 1 + 0.5 * draw(seed);
        s->preload = heads(seed) ? 0 : 1e3 * draw(seed);
        s->driven = heads(seed);
        if (s->driven)
            draw_positioner(seed, &s->actuator);
    }
}

// Drives on joints of the tree with one axis.
static void draw_drives(uint64_t *seed, ld_mechanism *given)
{
    for (int i = 0; i < given->body_count; i++) {
        const ld_joint *joint = &given->joint[i];
        ld_joint_drive *d = &given->drive[given->drive_count];
        if (!single(joint) || tree_pick(3, seed) == 0 || given->drive_count == LD_MAX_DRIVES)
            continue;
        snprintf(d->name, sizeof d->name, "drive%d", given->drive_count++);
        snprintf(d->joint, sizeof d->joint, "%s", joint->name);
        d->form = joint->kind == LD_JOINT_REVOLUTE ? LD_DRIVE_ANGLE : LD_DRIVE_LENGTH;
        if (d->form == LD_DRIVE_LENGTH) {
            draw_positioner(seed, &d->length);
            continue;
        }
        draw_stabiliser(seed, &d->angle);
        d->follows = (ld_follows)tree_pick(3, seed);
        if (heads(seed))
            snprintf(d->of, sizeof d->of, "b%d", tree_pick(given->body_count, seed));
    }
}

static void draw_feet(uint64_t *seed, ld_mechanism *given)
{
    given->foot_count = tree_pick(5, seed);
    for (int i = 0; i < given->foot_count; i++) {
        ld_foot *foot = &given->foot[i];
        snprintf(foot->name, sizeof foot->name, "foot%d", i);
        snprintf(foot->body, sizeof foot->body, "b%d", tree_pick(given->body_count, seed));
        fill3(seed, foot->at, 0.7);
        sizes3(seed, foot->stiffness, 1e4, 1e6);
        sizes3(seed, foot->damping, 1e2, 1e4);
        foot->friction = draw_size(seed, 0.1, 1);
    }
}

static ld_table draw_load(uint64_t *seed, double size)
{
    double row[12];
    for (int i = 0; i < 3; i++) {
        row[4 * i] = -0.5 + 0.6 * i;
        fill3(seed, row + 4 * i + 1, size);
    }
    return reference_table((size_t)(1 + tree_pick(3, seed)), 4, row);
}

static void draw_loads(uint64_t *seed, ld_mechanism *given)
{
    given->load_count = tree_pick(4, seed);
    for (int i = 0; i < given->load_count; i++) {
        ld_point_load *load = &given->load[i];
        snprintf(load->name, sizeof load->name, "load%d", i);
        snprintf(load->body, sizeof load->body, "b%d", tree_pick(given->body_count, seed));
        fill3(seed, load->at, 0.7);
        load->axes = heads(seed) ? LD_LOAD_IN_BODY : LD_LOAD_IN_GROUND;
        if (heads(seed))
            load->force = draw_load(seed, 1e4);
        if (load->force.rows == 0 || heads(seed))
            load->moment = draw_load(seed, 1e3);
    }
    given->drag_count = tree_pick(4, seed);
    for (int i = 0; i < given->drag_count; i++) {
        ld_body_drag *drag = &given->drag[i];
        snprintf(drag->name, sizeof drag->name, "drag%d", i);
        snprintf(drag->body, sizeof drag->body, "b%d", tree_pick(given->body_count, seed));
        fill3(seed, drag->at, 0.7);
        sizes3(seed, drag->area, 0.01, 3);
    }
}

// Uniform air, the same wind at every height.
static void draw_air(uint64_t *seed, ld_environment *environment)
{
    environment->atmosphere.kind = LD_ATMOSPHERE_UNIFORM;
    environment->atmosphere.density = 1.2 + 0.2 * draw(seed);
    environment->atmosphere.speed_of_sound = 340;
    environment->atmosphere.density_scale = 1;
    ld_wind *flow = &environment->wind;
    flow->present = tree_pick(4, seed) > 0;
    flow->axes = heads(seed) ? LD_WIND_GEOGRAPHIC : LD_WIND_LAUNCHER;
    flow->speed = 20 * draw_size(seed, 0.1, 1);
    flow->heading = 3 * draw(seed);
    flow->scale = 1 + 0.5 * draw(seed);
    fill3(seed, flow->add, 3);
    environment->site.present = true;
    environment->site.azimuth = 3 * draw(seed);
}

// A table of turns and paths, or sines.
static void draw_carrier(uint64_t *seed, ld_base *base)
{
    fill3(seed, base->velocity, 3);
    ld_sines *sines[] = {&base->surge, &base->heave, &base->sway,
                         &base->yaw,   &base->pitch, &base->roll};
    for (int i = 0; i < 6; i++) {
        sines[i]->count = 1;
        sines[i]->term[0] = (ld_sine){0.3 * draw(seed), draw_size(seed, 0.1, 1), 3 * draw(seed)};
    }
}

static void draw_road(uint64_t *seed, ld_road *given)
{
    given->form = LD_ROAD_SUM;
    given->sine_count = 1;
    given->sine[0] = (ld_road_sine){0.01, 1.5 + draw(seed), 3 * draw(seed)};
}

static void draw_elements(uint64_t *seed, const mechanism_options *options, ld_model *model)
{
    ld_mechanism *given = &model->base.mechanism;
    draw_bushings(seed, options, given);
    draw_struts(seed, options, given);
    draw_drives(seed, given);
    draw_feet(seed, given);
    draw_loads(seed, given);
    draw_air(seed, &model->environment);
}

static void smoothen_control(ld_stabiliser *s)
{
    s->slew = s->sample = s->delay = s->gear.backlash = 0;
}

// Takes out what has corners.
static void smoothen(ld_mechanism *given)
{
    for (int i = 0; i < given->joint_count; i++) {
        given->joint[i].stops.present = false;
        given->joint[i].friction.coulomb = 0;
    }
    for (int i = 0; i < given->bushing_count; i++) {
        memset(given->bushing[i].clearance, 0, sizeof given->bushing[i].clearance);
        nan3(given->bushing[i].stop);
    }
    for (int i = 0; i < given->strut_count; i++)
        smoothen_control(&given->strut[i].actuator);
    for (int i = 0; i < given->drive_count; i++) {
        smoothen_control(&given->drive[i].angle);
        smoothen_control(&given->drive[i].length);
    }
    given->foot_count = 0;
}

static void isolate(ld_model *model)
{
    ld_mechanism *given = &model->base.mechanism;
    model->gravity = 0;
    for (int i = 0; i < given->load_count; i++) {
        free(given->load[i].force.data);
        free(given->load[i].moment.data);
        given->load[i].force = given->load[i].moment = (ld_table){0};
    }
    given->foot_count = given->load_count = given->drag_count = 0;
}

void draw_mechanism(uint64_t *seed, int kind, const mechanism_options *options, ld_model *model)
{
    drawing d = {.freedoms = 0};
    reference_vehicle(model, options->wheels && kind % 2 ? 8 : 0);
    ld_mechanism *given = &model->base.mechanism;
    model->base.kind = LD_BASE_MULTIBODY;
    model->base.azimuth = 2 * draw(seed);
    model->base.elevation = draw(seed);
    if (!options->wheels)
        model->base.vehicle.wheel_count = 0;
    if (!options->whole)
        model->tubes.layout.rows = model->tubes.layout.columns = model->firing[0].tube = 1;
    draw_tree(seed, kind, options, &d, given);
    snprintf(model->tubes.on, sizeof model->tubes.on, "b%d", tree_pick(options->bodies, seed));
    if (options->carrier)
        draw_carrier(seed, &model->base);
    if (options->wheels)
        draw_road(seed, &model->base.vehicle.road);
    base_frame carrier = STILL;
    if (options->carrier) {
        mechanism_base own = {.model = model};
        base_system base = {.model = model, .own = &own};
        own.carrier.model = &model->base;
        carrier = mechanism_base_carrier(&base, 0);
    }
    draw_loops(seed, kind, options, &d, &carrier, model);
    if (options->elements)
        draw_elements(seed, options, model);
    if (options->smooth)
        smoothen(given);
    if (options->isolated)
        isolate(model);
}

// ---------------------------------------------------------------- states

static void turn_quaternion(uint64_t *seed, double size, double *q)
{
    v3 th = draw_v3(seed, 0.5 * size);
    double n = v3_norm(th), s = n > 0 ? sin(n) / n : 1;
    quat turn = {cos(n), s * th.x, s * th.y, s * th.z}, now = q_multiply(q_from(q), turn);
    memcpy(q, &now, sizeof now);
}

static void draw_bodies(uint64_t *seed, const dense_mechanism *dense, double far, double *state)
{
    const ld_mechanism *given = dense->given;
    dense_mechanism_start(dense, state);
    for (int k = 0; k < given->body_count; k++) {
        ld_joint_kind kind = given->joint[dense->joint_of[k]].kind;
        double *q = state + dense->q_at[k];
        int plain = freedoms_of(kind);
        if (kind == LD_JOINT_SPHERICAL || kind == LD_JOINT_FREE) {
            plain -= 3;
            turn_quaternion(seed, 3 * far, q + plain);
        }
        for (int i = 0; i < plain; i++)
            q[i] += far * draw(seed);
    }
    for (int i = 0; i < dense->u_count; i++) // slow ones for the friction
        state[dense->q_count + i] = (tree_pick(4, seed) ? 2 : 0.01) * draw(seed);
}

static ld_stabiliser *control_of(ld_mechanism *given, const dense_hold *hold)
{
    if (hold->strut >= 0)
        return &given->strut[hold->strut].actuator;
    if (hold->drive < 0)
        return NULL;
    ld_joint_drive *drive = &given->drive[hold->drive];
    return drive->form == LD_DRIVE_ANGLE ? &drive->angle : &drive->length;
}

// Commands that miss what is measured by a little; integrals beyond their limits, too; drives
// anywhere, a motor about as fast as its joint.
static void draw_holds(uint64_t *seed, const dense_mechanism *dense, ld_mechanism *given,
                       const dense_mechanism_output *now, mechanism_case *c)
{
    for (int i = 0; i < dense->hold_count; i++) {
        const hinge_report *report = &now->hold[i];
        ld_stabiliser *s = control_of(given, &dense->hold[i]);
        c->rest.hold[i] = (hold_rest){report->angle + 0.03 * draw(seed), 3e3 * draw(seed)};
        if (!s)
            continue;
        c->state[dense->z_at + i] = 1.3 * s->torque_limit * draw(seed);
        double shift = report->error + 0.03 * draw(seed);
        for (size_t row = 0; row < s->command.rows; row++)
            s->command.data[2 * row + 1] -= shift;
        if (dense->drive_at < 0)
            continue;
        double *own = c->state + dense->drive_at + DRIVE_STATES * i;
        for (int k = DRIVE_TORQUE; k <= DRIVE_COMPUTED; k++)
            own[k] = s->torque_limit * draw(seed);
        own[DRIVE_TWIST] = s->gear.backlash * draw(seed) + 1e-4 * draw(seed);
        own[DRIVE_RATE] = report->rate + 1e-2 * draw(seed);
    }
}

static void draw_limits(uint64_t *seed, const dense_mechanism *dense, ld_mechanism *given,
                        mechanism_case *c)
{
    for (int k = 0; k < given->body_count; k++) {
        int i = dense->joint_of[k];
        ld_joint *joint = &given->joint[i];
        double q = c->state[dense->q_at[k]];
        double low = q + 0.1 * draw(seed), width = 0.1 + 0.05 * draw(seed);
        if (joint->stops.present) {
            joint->stops.low = tree_pick(4, seed) ? low : NAN;
            joint->stops.high = tree_pick(4, seed) || isnan(joint->stops.low) ? low + width : NAN;
        }
        if (dense->later_at[i] >= 0)
            c->state[dense->later_at[i]] = q + 0.02 * draw(seed);
    }
}

// Ground below, at and above the feet; sliding and sticking ones.
static void draw_ground(uint64_t *seed, const dense_mechanism *dense, ld_mechanism *given,
                        const dense_mechanism_output *now, mechanism_case *c)
{
    for (int i = 0; i < given->foot_count; i++) {
        ld_foot *foot = &given->foot[i];
        const dense_frame *body = &now->body[mechanism_body(given, foot->body)];
        v3 r = v3_add(body->r, m3_apply(body->A, v3_from(foot->at)));
        foot->height = r.y + 0.02 * draw(seed) + 0.01;
        c->state[dense->feet_at + 2 * i] = 0.02 * draw(seed);
        c->state[dense->feet_at + 2 * i + 1] = 0.02 * draw(seed);
    }
}

static void draw_wheels(uint64_t *seed, const dense_mechanism *dense, const ld_model *model,
                        const dense_mechanism_output *now, mechanism_case *c)
{
    const ld_vehicle *vehicle = &model->base.vehicle;
    if (!vehicle->wheel_count)
        return;
    const dense_frame *body =
        &now->body[mechanism_body(&model->base.mechanism, model->base.mechanism.wheels_on)];
    for (int i = 0; i < vehicle->wheel_count; i++) {
        double *wheel = c->state + dense->wheels_at + WHEEL_STATES * i, slope;
        v3 mount = v3_from(vehicle->wheel[i].mount);
        v3 at = v3_add(body->r, m3_apply(body->A, v3_add(mount, draw_v3(seed, 0.05))));
        at.y = dense_road_height(&vehicle->road, mount.z, at.x, &slope) + vehicle->tyre.radius -
               0.02 + 0.03 * draw(seed);
        v3_store(wheel + WHEEL_R, at);
        v3_store(wheel + WHEEL_V, v3_add(body->v, draw_v3(seed, 2)));
        wheel[WHEEL_ETA] = 0.08 * draw(seed);
        wheel[WHEEL_XI] = vehicle->speed == 0 ? 0.08 * draw(seed) : 0;
    }
    c->state[dense->wheels_at + WHEEL_STATES * vehicle->wheel_count] = draw(seed);
}

bool draw_mechanism_state(uint64_t *seed, const dense_mechanism *dense, ld_model *model,
                          const base_system *base, mechanism_case *c)
{
    static dense_mechanism_output now;
    memset(c, 0, sizeof *c);
    c->t = base->drifts ? 0.05 * draw(seed) : draw(seed);
    c->linear = heads(seed);
    base_frame carrier = mechanism_base_carrier(base, c->t);
    dense_mechanism_input input = {
        .t = c->t, .state = c->state, .carrier = &carrier, .rest = c->rest.hold, .linear = true};
    draw_bodies(seed, dense, base->drifts ? 0.15 : 1.5, c->state);
    const mechanism_base *own = base->own;
    if (mechanism_assemble(&own->of_tube[0], &carrier, c->state, NULL))
        return false;
    if (!dense_mechanism_evaluate(dense, &input, &now) || now.open > 1e-9)
        return false;
    draw_holds(seed, dense, &model->base.mechanism, &now, c);
    draw_limits(seed, dense, &model->base.mechanism, c);
    draw_ground(seed, dense, &model->base.mechanism, &now, c);
    draw_wheels(seed, dense, model, &now, c);
    c->tube_force = draw_v3(seed, 2e4);
    c->tube_moment = draw_v3(seed, 1e4);
    return true;
}
