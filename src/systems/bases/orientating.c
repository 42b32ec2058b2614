#include "systems/bases/orientating.h"

#include <stdlib.h>

#include "base/random.h"
#include "elements/motor.h"
#include "math/functions.h"
#include "math/sine_cosine.h"
#include "model/model.h"

static const double PI = 3.141592653589793238462643383280;

enum { CHASSIS, AZIMUTH, ELEVATION, BODIES, SPEEDS = 8 };

// Mass, its moment and its inertia about a body's origin, gathered from parts.
typedef struct gathered_mass {
    double mass;
    v3 moment;  // [kg m]
    m3 inertia; // [kg m2]
} gathered_mass;

// m (|c|^2 E - c c^T): what a point mass adds to the inertia about the origin.
static m3 point_inertia(double mass, v3 c)
{
    double square = v3_norm2(c);
    return m3_scale(mass, m3_sub(m3_diagonal(square, square, square), m3_outer(c, c)));
}

// A part with its mass centre c from the body's origin and its inertia J about c.
static void add_mass(gathered_mass *all, double mass, v3 c, m3 J)
{
    all->mass += mass;
    all->moment = v3_axpy(all->moment, mass, c);
    all->inertia = m3_add(all->inertia, m3_add(J, point_inertia(mass, c)));
}

// A rigid tube in its place, rear end at `at`: a line mass with polar inertia, point masses, tail.
static void gather_tube(gathered_mass *all, const ld_tubes *tubes, v3 at)
{
    for (int k = 0; k < tubes->section_count; k++) {
        const ld_section *section = &tubes->section[k];
        double end = k + 1 < tubes->section_count ? section[1].from : tubes->length;
        double length = end - section->from, mass = section->mass_per_length * length;
        double across = mass * length * length / 12;
        v3 center = v3_add(at, v3_make(section->from + 0.5 * length, 0, 0));
        add_mass(all, mass, center, m3_diagonal(section->polar_inertia * length, across, across));
    }
    for (int k = 0; k < tubes->point_mass_count; k++)
        add_mass(all, tubes->point_mass[k].mass, v3_add(at, v3_make(tubes->point_mass[k].at, 0, 0)),
                 m3_diagonal(0, 0, 0));
    const double *J = tubes->tail.inertia;
    add_mass(all, tubes->tail.mass, v3_add(at, v3_make(tubes->tail.center, 0, 0)),
             m3_diagonal(J[0], J[1], J[2]));
}

v3 orientating_tube_place(const ld_layout *layout, int number)
{
    int row = (number - 1) / layout->columns, column = (number - 1) % layout->columns;
    return v3_add(v3_from(layout->first), v3_make(0, row * layout->pitch, column * layout->pitch));
}

static bool listed(const int *list, int count, int number)
{
    for (int k = 0; k < count; k++)
        if (list[k] == number)
            return true;
    return false;
}

// The rocket in tube `number`.
static const ld_rocket *rocket_in(const ld_model *model, int number)
{
    for (int i = 0; model->salvo && i < model->firing_count; i++)
        if (model->firing[i].tube == number)
            return &model->salvo[i];
    return &model->rocket;
}

// The elevation platform's frame and every tube but the launching one, full rockets in those that
// are neither empty nor fired.
static ld_status gather_elevation(gathered_mass *all, const ld_model *model, int launching,
                                  const int *fired, int fired_count, ld_error *error)
{
    const ld_turret *frame = &model->platform.elevation;
    const ld_tubes *tubes = &model->tubes;
    *all = (gathered_mass){0};
    add_mass(all, frame->mass, v3_from(frame->center),
             m3_diagonal(frame->inertia[0], frame->inertia[1], frame->inertia[2]));
    for (int number = 1; number <= tubes->layout.rows * tubes->layout.columns; number++) {
        v3 at = orientating_tube_place(&tubes->layout, number);
        if (number == launching)
            continue;
        gather_tube(all, tubes, at);
        if (listed(fired, fired_count, number) || listed(tubes->empty, tubes->empty_count, number))
            continue;
        const ld_rocket *rocket = rocket_in(model, number);
        motor thruster;
        ld_status status = motor_build(&thruster, rocket, error);
        if (status)
            return status;
        v3 c = v3_add(at, thruster.full.c);
        c.x += rocket->start_at;
        add_mass(all, thruster.full.m, c, thruster.full.J);
        motor_free(&thruster);
    }
    return LD_OK;
}

// An element of the chain with its mass centre c and the inertia J about it.
static ld_mstmm_element chain_element(const char *name, const char *parent, double mass, v3 c, m3 J)
{
    ld_mstmm_element element = {.name = name, .parent = parent, .mass = mass};
    v3_store(element.center, c);
    for (int i = 0; i < 3; i++)
        element.inertia[i] = J.a[i][i];
    element.inertia[3] = J.a[0][1];
    element.inertia[4] = J.a[0][2];
    element.inertia[5] = J.a[1][2];
    return element;
}

// Makes an element turn about an axis of the body that carries it.
static void attach_hinge(ld_mstmm_element *element, const double at[3], v3 axis)
{
    element->hinge = LD_HINGE_REVOLUTE;
    v3_store(element->at, v3_from(at));
    v3_store(element->axis, axis);
}

static bool has_drive(const ld_turret *turret)
{
    return !turret->lock.present && stabiliser_has_drive(&turret->stabiliser);
}

ld_status orientating_build(orientating_system *self, const ld_model *model, int launching,
                            const int *fired, int fired_count, ld_error *error)
{
    const ld_platform *given = &model->platform;
    const ld_turret *azimuth = &given->azimuth;
    *self = (orientating_system){.model = model,
                                 .formulation = model->run.formulation,
                                 .state_count = has_drive(azimuth) || has_drive(&given->elevation)
                                                    ? ORIENTATING_MOST_STATES
                                                    : ORIENTATING_STATES};
    gathered_mass elevation;
    ld_status status = gather_elevation(&elevation, model, launching, fired, fired_count, error);
    if (status)
        return status;

    // mass centre and inertia about it
    v3 center = v3_scale(1 / elevation.mass, elevation.moment);
    m3 inertia = m3_sub(elevation.inertia, point_inertia(elevation.mass, center));
    const double *J = given->chassis_inertia, *Ja = azimuth->inertia;
    ld_mstmm_element chain[BODIES] = {
        chain_element("chassis", NULL, given->chassis_mass, v3_zero(),
                      m3_diagonal(J[0], J[1], J[2])),
        chain_element("azimuth platform", "chassis", azimuth->mass, v3_from(azimuth->center),
                      m3_diagonal(Ja[0], Ja[1], Ja[2])),
        chain_element("elevation platform", "azimuth platform", elevation.mass, center, inertia),
    };
    chain[CHASSIS].hinge = LD_HINGE_FREE;
    attach_hinge(&chain[AZIMUTH], azimuth->hinge_at, v3_make(0, 1, 0));
    attach_hinge(&chain[ELEVATION], given->elevation.hinge_at, v3_make(0, 0, 1));
    self->tube_at = orientating_tube_place(&model->tubes.layout, launching);
    self->elevation_mass = elevation.mass;
    self->elevation_center = center;
    self->mass = given->chassis_mass + azimuth->mass + elevation.mass;
    return ld_mstmm_create(chain, BODIES, (double[]){0, -model->gravity, 0}, &self->chain, error);
}

void orientating_free(orientating_system *self)
{
    ld_mstmm_free(self->chain);
    *self = (orientating_system){0};
}

// Half the angle's sine and cosine make quaternion and matrix.
typedef struct half_turn {
    double s, c;
} half_turn;

static void half_turns(const double angle[HINGES], half_turn turn[HINGES])
{
    double half[HINGES] = {0.5 * angle[0], 0.5 * angle[1]}, sine[HINGES], cosine[HINGES];
    sine_cosine(HINGES, half, sine, cosine);
    for (int i = 0; i < HINGES; i++)
        turn[i] = (half_turn){sine[i], cosine[i]};
}

// Command and its rate at time t: linear between the table's rows, from a row's time on the slope
// behind it; constant outside.
static double command_at(const ld_table *table, double t, double *rate)
{
    const double *row = table->data;
    size_t n = table->columns, first = 0, end = table->rows;
    *rate = 0;
    if (t < row[0])
        return row[1];
    // the last row at or before t
    while (end - first > 1) {
        size_t middle = (first + end) / 2;
        if (t >= row[middle * n])
            first = middle;
        else
            end = middle;
    }
    row += first * n;
    if (end == table->rows)
        return row[1];
    *rate = (row[n + 1] - row[1]) / (row[n] - row[0]);
    return row[1] + *rate * (t - row[0]);
}

// Into [-pi, pi].
static double wrapped(double angle)
{
    return fabs(angle) > PI ? remainder(angle, 2 * PI) : angle;
}

// Pitch and yaw of the elevation platform's x axis d, of unit length, and their rates under d_dot =
// w x d (model.md, section 1).
static void measure(const base_frame *platform, hinge_report hinge[HINGES])
{
    v3 d = m3_column(platform->A, 0), d_dot = v3_cross(platform->w, d);
    double square = d.x * d.x + d.z * d.z, level = sqrt(square);
    hinge[HINGE_AZIMUTH].measured = atan2(-d.z, d.x);
    hinge[HINGE_AZIMUTH].measured_rate = (d.z * d_dot.x - d.x * d_dot.z) / square;
    hinge[HINGE_ELEVATION].measured = atan2(d.y, level);
    hinge[HINGE_ELEVATION].measured_rate = d_dot.y / level;
}

void orientating_motion_at(const orientating_system *self, double t, const double *state,
                           orientating_motion *motion)
{
    const ld_platform *given = &self->model->platform;
    const ld_turret *turret[HINGES] = {&given->azimuth, &given->elevation};
    base_frame *chassis = &motion->chassis, *tube = &motion->tube;
    quat q = q_from(state + ORIENTATING_QUATERNION);
    double norm = 1 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    q = (quat){norm * q.w, norm * q.x, norm * q.y, norm * q.z};
    chassis->r = v3_from(state + ORIENTATING_R);
    chassis->v = v3_from(state + ORIENTATING_V);
    chassis->q = q;
    chassis->A = q_matrix(q);
    chassis->w = m3_apply(chassis->A, v3_from(state + ORIENTATING_W));

    // azimuth platform: about the chassis' y axis
    half_turn turn[HINGES];
    half_turns(state + ORIENTATING_ANGLE, turn);
    half_turn a = turn[HINGE_AZIMUTH], e = turn[HINGE_ELEVATION];
    double s = 2 * a.s * a.c, c = 1 - 2 * a.s * a.s;
    v3 X = m3_column(chassis->A, 0), Y = m3_column(chassis->A, 1), Z = m3_column(chassis->A, 2);
    v3 arm = m3_apply(chassis->A, v3_from(turret[HINGE_AZIMUTH]->hinge_at));
    v3 r = v3_add(chassis->r, arm), v = v3_add(chassis->v, v3_cross(chassis->w, arm));
    motion->hinge[HINGE_AZIMUTH].base_rate = v3_dot(chassis->w, Y);
    v3 w = v3_axpy(chassis->w, state[ORIENTATING_RATE + HINGE_AZIMUTH], Y);
    m3 A = m3_columns(v3_axpy(v3_scale(c, X), -s, Z), Y, v3_axpy(v3_scale(c, Z), s, X));
    v3 center = m3_apply(A, v3_from(turret[HINGE_AZIMUTH]->center));
    v3 momentum = v3_scale(given->chassis_mass, chassis->v);
    momentum = v3_axpy(momentum, given->azimuth.mass, v3_add(v, v3_cross(w, center)));

    // elevation platform: about the azimuth platform's z axis
    s = 2 * e.s * e.c;
    c = 1 - 2 * e.s * e.s;
    arm = m3_apply(A, v3_from(turret[HINGE_ELEVATION]->hinge_at));
    r = v3_add(r, arm);
    v = v3_add(v, v3_cross(w, arm));
    X = m3_column(A, 0), Z = m3_column(A, 2);
    motion->hinge[HINGE_ELEVATION].base_rate = v3_dot(chassis->w, Z);
    w = v3_axpy(w, state[ORIENTATING_RATE + HINGE_ELEVATION], Z);
    A = m3_columns(v3_axpy(v3_scale(c, X), s, Y), v3_axpy(v3_scale(c, Y), -s, X), Z);
    center = m3_apply(A, self->elevation_center);
    momentum = v3_axpy(momentum, self->elevation_mass, v3_add(v, v3_cross(w, center)));
    motion->momentum = momentum;

    // tube
    arm = m3_apply(A, self->tube_at);
    tube->r = v3_add(r, arm);
    tube->v = v3_add(v, v3_cross(w, arm));
    tube->A = A;
    tube->q = q_multiply(q, (quat){a.c * e.c, a.s * e.s, a.s * e.c, a.c * e.s});
    tube->w = w;

    measure(tube, motion->hinge);
    for (int i = 0; i < HINGES; i++) {
        hinge_report *hinge = &motion->hinge[i];
        hinge->angle = state[ORIENTATING_ANGLE + i];
        hinge->rate = state[ORIENTATING_RATE + i];
        hinge->command = command_at(&turret[i]->stabiliser.command, t, &hinge->command_rate);
        hinge->error = wrapped(hinge->command - hinge->measured);
    }
}

// Torques on the outboard body of hinge i; rates of what its stabiliser has in the state.
static void drive_hinge(const ld_turret *turret, const orientating_input *input, int i,
                        const double *state, hinge_report *hinge, double *state_dot)
{
    const hinge_rest *rest = &input->rest[i];
    double b_dot = hinge->rate;
    hinge->limited = false;
    hinge->friction = 0;
    state_dot[ORIENTATING_Z + i] = 0;
    if (input->held) {
        hinge->torque = rest->torque;
        return;
    }
    const ld_hinge_friction *friction = &turret->friction;
    hinge->friction = -friction->viscous * b_dot;
    if (!input->linear)
        hinge->friction -=
            friction->coulomb * b_dot / sqrt(b_dot * b_dot + friction->rate * friction->rate);
    int drive = ORIENTATING_DRIVE + DRIVE_STATES * i;
    if (turret->lock.present)
        hinge->torque = rest->torque - turret->lock.stiffness * (hinge->angle - rest->angle) -
                        turret->lock.damping * b_dot;
    else
        stabiliser_evaluate(&turret->stabiliser, input->linear, state[ORIENTATING_Z + i],
                            state + drive, hinge, state_dot + ORIENTATING_Z + i, state_dot + drive);
}

// Accelerations of the chain by the form that the model asks for.
static ld_status accelerate(const orientating_system *self, const double *state, const double *tau,
                            const double *wrench, double *u_dot, double *loss)
{
    const double *u = state + ORIENTATING_V;
    ld_mstmm_overall report = {0};
    *loss = 0;
    if (self->formulation == LD_FORMULATION_REDUCED)
        return ld_mstmm_accelerations(self->chain, state, u, tau, wrench, u_dot, NULL);
    ld_status status = ld_mstmm_accelerations_overall(self->chain, LD_MSTMM_PAPER, state, u, tau,
                                                      wrench, u_dot, &report, NULL);
    *loss = report.loss;
    return status;
}

int orientating_evaluate(const orientating_system *self, const orientating_input *input,
                         const double *state, orientating_motion *motion, double *state_dot,
                         orientating_output *output)
{
    const ld_platform *given = &self->model->platform;
    const ld_turret *turret[HINGES] = {&given->azimuth, &given->elevation};
    double tau[SPEEDS] = {0}, wrench[6 * BODIES] = {0};
    output->power[ORIENTATING_STABILISER] = output->power[ORIENTATING_FRICTION] = 0;
    output->power[ORIENTATING_GRAVITY] = -self->model->gravity * motion->momentum.y;
    for (int k = ORIENTATING_DRIVE; k < self->state_count; k++)
        state_dot[k] = 0;
    for (int i = 0; i < HINGES; i++) {
        hinge_report *hinge = &motion->hinge[i];
        drive_hinge(turret[i], input, i, state, hinge, state_dot);
        tau[6 + i] = hinge->torque + hinge->friction;
        output->power[ORIENTATING_STABILISER] += hinge->torque * hinge->rate;
        output->power[ORIENTATING_FRICTION] += hinge->friction * hinge->rate;
    }

    // wrenches about the bodies' origins: the tube's from T's origin to the elevation hinge
    const m3 *A = &motion->tube.A;
    v3 moment = v3_add(input->tube_moment, v3_cross(self->tube_at, input->tube_force));
    v3_store(wrench + 6 * CHASSIS, input->chassis_force);
    v3_store(wrench + 6 * CHASSIS + 3, input->chassis_moment);
    v3_store(wrench + 6 * ELEVATION, m3_apply(*A, input->tube_force));
    v3_store(wrench + 6 * ELEVATION + 3, m3_apply(*A, moment));
    double *u_dot = state_dot + ORIENTATING_V;
    if (accelerate(self, state, tau, wrench, u_dot, &output->loss))
        return 1;
    for (int k = 0; k < SPEEDS; k++)
        if (!isfinite(u_dot[k]))
            return 1;

    // rates of the coordinates
    quat q_dot = q_rate(q_from(state + ORIENTATING_QUATERNION), v3_from(state + ORIENTATING_W));
    v3_store(state_dot + ORIENTATING_R, v3_from(state + ORIENTATING_V));
    state_dot[ORIENTATING_QUATERNION] = q_dot.w;
    state_dot[ORIENTATING_QUATERNION + 1] = q_dot.x;
    state_dot[ORIENTATING_QUATERNION + 2] = q_dot.y;
    state_dot[ORIENTATING_QUATERNION + 3] = q_dot.z;
    for (int i = 0; i < HINGES; i++)
        state_dot[ORIENTATING_ANGLE + i] = state[ORIENTATING_RATE + i];
    return 0;
}

void orientating_rest(const orientating_system *self, double *state)
{
    const ld_platform *given = &self->model->platform;
    const ld_turret *turret[HINGES] = {&given->azimuth, &given->elevation};
    for (int i = 0; i < HINGES && self->state_count > ORIENTATING_DRIVE; i++)
        stabiliser_rest(&turret[i]->stabiliser, state[ORIENTATING_Z + i],
                        state + ORIENTATING_DRIVE + DRIVE_STATES * i);
}

// The next instant of hinge i.
static double next_sample(const ld_turret *turret, double t)
{
    return turret->lock.present ? INFINITY : stabiliser_next_sample(&turret->stabiliser, t);
}

double orientating_next_sample(const orientating_system *self, double t)
{
    const ld_platform *given = &self->model->platform;
    return fmin(next_sample(&given->azimuth, t), next_sample(&given->elevation, t));
}

void orientating_sample(const orientating_system *self, double t, double *state)
{
    const ld_platform *given = &self->model->platform;
    const ld_turret *turret[HINGES] = {&given->azimuth, &given->elevation};
    static const char *const stream[HINGES] = {"platform.azimuth.stabiliser.sensor_noise",
                                               "platform.elevation.stabiliser.sensor_noise"};
    double before = nextafter(t, -INFINITY);
    orientating_motion motion;
    orientating_motion_at(self, t, state, &motion);
    for (int i = 0; i < HINGES; i++)
        if (next_sample(turret[i], before) == t)
            stabiliser_sample(&turret[i]->stabiliser, t, random_stream(stream[i]), &motion.hinge[i],
                              state + ORIENTATING_Z + i,
                              state + ORIENTATING_DRIVE + DRIVE_STATES * i);
}

double orientating_kinetic_energy(const orientating_system *self, const double *state)
{
    return ld_mstmm_energy(self->chain, state, state + ORIENTATING_V).kinetic;
}
