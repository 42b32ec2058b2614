#include "systems/bases/mechanism_base.h"

#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "systems/bases/base_coordinates.h"
#include "systems/mechanism/mechanism_evaluation.h"
#include "systems/mechanism/mechanism_loops.h"
#include "systems/mechanism/mechanism_motion.h"
#include "systems/mechanism/mechanism_state.h"

const mechanism_system *mechanism_of(const base_system *self)
{
    const mechanism_base *own = self->own;
    return &own->of_tube[self->tube];
}

static const marching_system *marching_of(const base_system *self)
{
    const mechanism_base *own = self->own;
    return self->disturbed ? &own->level : &own->marching;
}

int mechanism_base_marching_at(const base_system *self)
{
    return mechanism_of(self)->state_count;
}

base_frame mechanism_base_carrier(const base_system *base, double t)
{
    static const m3 E = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const mechanism_base *self = base->own;
    const base_disturbance *disturbed = base->disturbed;
    base_frame frame = {.A = E, .q = {1, 0, 0, 0}};
    double x[6], u[6], a[6];
    if (self->still)
        return frame;
    if (self->carrier.table.turned && !disturbed) {
        motion_table_place(&self->carrier.table, t, &E, &frame);
        return frame;
    }
    prescribed_motion_at(&self->carrier, t, x, u, a);
    for (int i = 0; i < 6 && disturbed; i++) {
        x[i] = (i < 3 ? 0 : x[i]) + disturbed->input.motion[i];
        u[i] = disturbed->rate.motion[i];
        a[i] = disturbed->acceleration.motion[i];
    }
    base_frame_at(x, u, a, &E, &frame);
    return frame;
}

// ---- life

// The stretch of road [m] that the wheels will see in a launch.
static void road_under(const ld_model *model, double x[2])
{
    const ld_vehicle *vehicle = &model->base.vehicle;
    double speed = vehicle->speed, rear = 0, front = 0;
    for (int j = 0; j < vehicle->wheel_count; j++) {
        rear = fmin(rear, vehicle->wheel[j].mount[0]);
        front = fmax(front, vehicle->wheel[j].mount[0]);
    }
    double end = model->run.end == LD_END_TIME ? model->run.end_time : 1;
    x[0] = rear - speed * model->run.lead_in - 1;
    x[1] = front + speed * (model->firing[model->firing_count - 1].at + end) + 1;
}

static ld_status build_mechanisms(mechanism_base *self, const mechanism_plan *plan, ld_error *error)
{
    const ld_model *model = self->model;
    int fired[LD_MAX_FIRINGS];
    self->of_tube = calloc((size_t)model->firing_count, sizeof *self->of_tube);
    if (!self->of_tube)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's bodies");
    for (int i = 0; i < model->firing_count; i++) {
        fired[i] = model->firing[i].tube;
        mechanism_tubes tubes = {fired[i], i, fired};
        ld_status status = mechanism_build(&self->of_tube[i], plan, &tubes, error);
        if (status)
            return status;
        self->tube_count++;
    }
    return LD_OK;
}

static ld_status build_wheels(mechanism_base *self, road **kept, ld_error *error)
{
    static const ld_road flat = {.iso_class = LD_ROAD_SMOOTH};
    const ld_model *model = self->model;
    double stretch[2];
    self->has_wheels = model->base.vehicle.wheel_count > 0;
    if (!self->has_wheels)
        return LD_OK;
    road_under(model, stretch);
    ld_status status =
        marching_build(&self->marching, &model->base.vehicle, model->gravity, stretch, kept, error);
    if (status)
        return status;
    self->level = self->marching;
    self->level.road = NULL;
    return road_build(&flat, 0, 0, &self->level.road, error);
}

static ld_status build_air(mechanism_base *self, ld_error *error)
{
    const ld_environment *environment = &self->model->environment;
    self->has_drag = self->of_tube[0].given->drag_count > 0;
    if (!self->has_drag)
        return LD_OK;
    ld_status status = atmosphere_build(&self->air, &environment->atmosphere, error);
    return status ? status : wind_build(&self->wind, &environment->wind, error);
}

ld_status mechanism_base_build(base_system *base, const mechanism_plan *plan, ld_error *error)
{
    mechanism_base *self = base->own;
    self->model = plan->model;
    ld_status status = prescribed_motion_build(&self->carrier, plan->model, error);
    if (!status)
        status = build_mechanisms(self, plan, error);
    self->still = !status && !self->of_tube[0].carried;
    if (!status)
        status = build_wheels(self, base->kept, error);
    return status ? status : build_air(self, error);
}

void mechanism_base_count(base_system *base)
{
    const mechanism_base *self = base->own;
    const mechanism_system *mechanism = &self->of_tube[0];
    int wheels = self->marching.wheel_count, feet = mechanism->given->foot_count;
    bool drives = mechanism->hold_count && mechanism->hold[0].drive >= 0;
    base->state_count = mechanism->state_count + self->marching.state_count;
    base->work_count =
        self->mechanism_works + (self->has_wheels ? MARCHING_POWERS : 0) + self->has_jet;
    base->event_count = wheels + feet;
    base->speed_at = mechanism->q_count;
    base->speed_count = mechanism->u_count;
    base->freedom_count = self->freedom_count + mechanism->hold_count + 3 * wheels;
    base->displacement_count = mechanism->freedom_count + 3 * wheels;
    base->drifts = ld_mstmm_loop_count(mechanism->chain) > 0;
    base->extra_count = mechanism->hold_count * (1 + (drives ? DRIVE_STATES : 0)) + 2 * feet +
                        (self->has_wheels ? 2 * wheels + 1 : 0);
}

void mechanism_base_mount_wheels(const base_system *base, double *state)
{
    const mechanism_base *self = base->own;
    const mechanism_system *mechanism = &self->of_tube[0];
    base_frame tube;
    base_found found;
    if (!self->has_wheels)
        return;
    base->kind->find_frame(base, -self->model->run.lead_in, state, &tube, &found);
    base_frame chassis = mechanism_base_chassis(base, &found.mechanism);
    marching_place(&self->marching, &chassis, state + mechanism->state_count);
}

void mechanism_base_free(base_system *base)
{
    mechanism_base *self = base->own;
    if (!self)
        return;
    for (int i = 0; i < self->tube_count; i++)
        mechanism_free(&self->of_tube[i]);
    if (!self->shared) {
        road_free(self->marching.road);
        road_free(self->level.road);
        prescribed_motion_free(&self->carrier);
        if (self->has_drag) {
            atmosphere_free(&self->air);
            wind_free(&self->wind);
        }
        free(self->rest);
        free(self->given);
        free(self->made);
    }
    free(self->of_tube);
    free(self);
}

// The chains are workspaces, too.
ld_status mechanism_base_share(base_system *base, ld_error *error)
{
    const mechanism_base *of = base->own;
    mechanism_base *self = base->own = malloc(sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's bodies");
    *self = *of;
    self->shared = true;
    self->tube_count = 0;
    self->of_tube = malloc((size_t)of->tube_count * sizeof *self->of_tube);
    if (!self->of_tube)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's bodies");
    memcpy(self->of_tube, of->of_tube, (size_t)of->tube_count * sizeof *self->of_tube);
    for (int i = 0; i < of->tube_count; i++) {
        ld_status status = ld_mstmm_copy(of->of_tube[i].chain, &self->of_tube[i].chain, error);
        if (status)
            return status;
        self->tube_count++;
    }
    return LD_OK;
}

road *mechanism_base_take_road(base_system *self)
{
    mechanism_base *own = self->own;
    road *taken = own->marching.road;
    own->marching.road = NULL;
    return taken;
}

void base_set_road(base_system *self, road *under)
{
    mechanism_base *own = self->own;
    own->marching.road = under;
}

// ---- motion

void mechanism_base_find_frame(const base_system *self, double t, const double *state,
                               base_frame *tube, base_found *found)
{
    base_frame carrier = mechanism_base_carrier(self, t);
    mechanism_move(mechanism_of(self), t, &carrier, state, &found->mechanism);
    *tube = found->mechanism.tube;
}

base_frame mechanism_base_chassis(const base_system *self, const mechanism_motion *motion)
{
    const body_motion *body = &motion->body[mechanism_of(self)->wheels];
    return (base_frame){.r = body->r, .v = body->v, .A = body->A, .w = body->w};
}

void mechanism_base_span(const base_system *base, double *first, double *last)
{
    const mechanism_base *self = base->own;
    prescribed_motion_span(&self->carrier, first, last);
}

double mechanism_base_next_corner(const base_system *base, double t)
{
    const mechanism_base *self = base->own;
    double next = mechanism_next_corner(mechanism_of(base), t);
    return self->has_drag ? fmin(next, wind_next_corner(&self->wind, t)) : next;
}

double mechanism_base_next_sample(const base_system *self, double t)
{
    return mechanism_next_sample(mechanism_of(self), t);
}

void mechanism_base_sample(const base_system *self, double t, double *state)
{
    base_frame carrier = mechanism_base_carrier(self, t);
    mechanism_motion motion;
    mechanism_move(mechanism_of(self), t, &carrier, state, &motion);
    mechanism_sample(mechanism_of(self), &motion, state);
}

void mechanism_base_find_air(const mechanism_base *self, const mechanism_motion *motion,
                             mechanism_input *input)
{
    const ld_site *site = &self->model->environment.site;
    double height = motion->tube.r.y, altitude = height + (site->present ? site->altitude : 0);
    if (!self->has_drag)
        return;
    input->density = atmosphere_at(&self->air, altitude).density;
    if (!self->wind.present)
        return;
    v3 flow = wind_at(&self->wind, motion->t, self->wind.geographic ? altitude : height);
    double s, c;
    sincos(site->azimuth, &s, &c);
    // north, up, east; x of I goes along the azimuth
    input->wind = self->wind.geographic
                      ? v3_make(c * flow.x + s * flow.z, flow.y, c * flow.z - s * flow.x)
                      : flow;
}

// The wheels under their body; its wrench on it.
static void roll(const base_system *self, const base_load *load, const mechanism_motion *motion,
                 const double *state, base_output *output, mechanism_input *input)
{
    const mechanism_base *own = self->own;
    const base_disturbance *disturbed = self->disturbed;
    road_disturbance ground = {disturbed ? disturbed->input.road : NULL,
                               disturbed ? disturbed->rate.road : NULL};
    marching_output *marching = &output->report.marching;
    if (!own->has_wheels)
        return;
    base_frame chassis = mechanism_base_chassis(self, motion);
    int at = mechanism_base_marching_at(self);
    marching_evaluate(marching_of(self), &chassis, load->held, disturbed ? &ground : NULL,
                      state + at, output->rate + at, marching);
    input->wheel_force = marching->force;
    input->wheel_moment = marching->moment;
    memcpy(output->power + own->mechanism_works, marching->power, sizeof marching->power);
    output->elastic += marching->elastic;
    for (int j = 0; j < own->marching.wheel_count; j++)
        output->event[j] = marching->wheel[j].deflection;
}

// Adds what disturbs bodies and holds.
static void disturb(const base_disturbance *by, mechanism_input *input)
{
    input->command = by->input.command;
    input->rate = by->rate.command;
    input->wheel_force = v3_add(input->wheel_force, by->input.force);
    input->wheel_moment = v3_add(input->wheel_moment, by->input.moment);
    input->tube_force = v3_add(input->tube_force, by->input.tube_force);
    input->tube_moment = v3_add(input->tube_moment, by->input.tube_moment);
}

double jet_power(const jet_wrench *jet, const base_frame *tube)
{
    return v3_dot(m3_apply(tube->A, jet->force), tube->v) +
           v3_dot(m3_apply(tube->A, jet->moment), tube->w);
}

int mechanism_base_evaluate(const base_system *self, const base_found *found, const base_load *load,
                            const double *state, base_output *output)
{
    const mechanism_base *own = self->own;
    const mechanism_motion *motion = &found->mechanism;
    mechanism_input input = {
        .tube_force = v3_add(load->force, load->jet.force),
        .tube_moment = v3_add(load->moment, load->jet.moment),
        .station = load->station,
        .rest = load->rest.hold,
        .held = load->held,
        .linear = load->linear || self->disturbed,
    };
    mechanism_output *of = &output->report.mechanism;
    output->elastic = 0;
    roll(self, load, motion, state, output, &input);
    mechanism_base_find_air(own, motion, &input);
    if (self->disturbed)
        disturb(self->disturbed, &input);
    int outcome = mechanism_evaluate(mechanism_of(self), &input, state, motion, output->rate, of);
    memcpy(output->power, of->power, (size_t)own->mechanism_works * sizeof *of->power);
    output->elastic += of->elastic;
    output->report.jet = -load->jet.force.x;
    if (own->has_jet)
        output->power[self->work_count - 1] = jet_power(&load->jet, &motion->tube);
    for (int i = 0; i < mechanism_of(self)->given->foot_count; i++)
        output->event[own->marching.wheel_count + i] = of->report.foot[i].deflection;
    return outcome;
}

double mechanism_base_kinetic_energy(const base_system *self, const base_found *found,
                                     const double *state)
{
    const mechanism_base *own = self->own;
    const mechanism_motion *motion = &found->mechanism;
    double sum = ld_mstmm_energy(mechanism_of(self)->chain, motion->q, motion->u).kinetic;
    if (own->has_wheels)
        sum += marching_kinetic_energy(marching_of(self), state + mechanism_base_marching_at(self));
    return sum;
}

void mechanism_base_tolerances(const base_system *self, double tolerance, double *atol,
                               bool *absolute)
{
    const mechanism_base *own = self->own;
    int at = mechanism_base_marching_at(self);
    double *wheel = atol + at;
    mechanism_tolerances(mechanism_of(self), tolerance, atol, absolute);
    if (!own->has_wheels)
        return;
    for (int j = 0; j < own->marching.wheel_count; j++, wheel += WHEEL_STATES)
        for (int i = 0; i < WHEEL_STATES; i++) {
            bool speed = i >= WHEEL_V && i < WHEEL_V + 3;
            wheel[i] = speed ? tolerance : 1e-2 * tolerance;
            absolute[wheel + i - atol] = i < WHEEL_V;
        }
    *wheel = tolerance;
}

// Each wheel is one; the drive is with the bodies.
int mechanism_base_part_of(const base_system *self, int state)
{
    const mechanism_base *own = self->own;
    int wheel = (state - mechanism_base_marching_at(self)) / WHEEL_STATES;
    bool of_wheel = state >= mechanism_base_marching_at(self) && wheel < own->marching.wheel_count;
    return of_wheel ? wheel + 1 : 0;
}

void mechanism_base_project(const base_system *self, double t, double *state)
{
    base_frame carrier = mechanism_base_carrier(self, t);
    mechanism_project(mechanism_of(self), &carrier, state);
}

void mechanism_base_set_start_velocity(const base_system *self, double *state)
{
    const mechanism_base *own = self->own;
    const mechanism_system *mechanism = mechanism_of(self);
    double speed = own->model->base.vehicle.speed;
    mechanism_set_off(mechanism, state);
    if (!self->disturbed) // linearised, it is at rest
        mechanism_start_speeds(mechanism, state);
    mechanism_base_project(self, -own->model->run.lead_in, state);
    if (!own->has_wheels || !(speed > 0))
        return;
    // the body on the wheels hangs on the ground by a free joint, whose first speed is along x
    state[mechanism->q_count + ld_mstmm_speed_offset(mechanism->chain, mechanism->wheels)] = speed;
    for (int j = 0; j < own->marching.wheel_count; j++)
        state[mechanism_base_marching_at(self) + WHEEL_STATES * j + WHEEL_V] = speed;
}

// Unknowns: displacements that something holds, torques of holds, wheel positions.
void mechanism_base_displace(const base_system *self, int freedom, double change, double *state)
{
    const mechanism_base *own = self->own;
    const mechanism_system *mechanism = mechanism_of(self);
    int hold = freedom - own->freedom_count, k = hold - mechanism->hold_count;
    if (hold < 0)
        mechanism_settle(mechanism, own->freedom[freedom], change, state);
    else if (k < 0)
        state[mechanism->z_at + hold] += 1e6 * change; // held torque
    else
        state[mechanism_base_marching_at(self) + WHEEL_STATES * (k / 3) + WHEEL_R + k % 3] +=
            change;
    base_frame carrier = mechanism_base_carrier(self, -own->model->run.lead_in);
    mechanism_plant(mechanism, &carrier, state);
}

// Locked joints keep their equilibrium; the others begin with the integral that holds it.
void mechanism_base_rest_of(const base_system *self, const double *state, base_rest *rest)
{
    const mechanism_system *mechanism = mechanism_of(self);
    for (int i = 0; i < mechanism->hold_count; i++) {
        const mechanism_hold *hold = &mechanism->hold[i];
        rest->hold[i] = (hold_rest){.angle = hold->strut < 0 ? state[hold->q] : 0,
                                    .torque = state[mechanism->z_at + i]};
    }
}

// Accelerations but those that are neutral, and the errors of holds.
void mechanism_base_residual(const base_system *self, const base_output *output, double *r)
{
    const mechanism_base *own = self->own;
    const mechanism_system *mechanism = mechanism_of(self);
    const double *rate = output->rate, *wheel = rate + mechanism_base_marching_at(self);
    for (int i = 0; i < own->freedom_count; i++)
        *r++ = rate[mechanism->q_count + mechanism->freedom[own->freedom[i]]];
    for (int i = 0; i < mechanism->hold_count; i++)
        *r++ = output->report.mechanism.report.hold[i].error;
    for (int j = 0; j < own->marching.wheel_count; j++, wheel += WHEEL_STATES)
        for (int i = 0; i < 3; i++)
            *r++ = wheel[WHEEL_V + i];
}

// Whether everything that must stand on the ground does.
ld_status mechanism_base_check_wheels(const base_system *self, const base_found *found,
                                      const double *state, ld_error *error)
{
    const mechanism_base *own = self->own;
    base_frame chassis = mechanism_base_chassis(self, &found->mechanism);
    marching_output marching;
    double unused[WHEEL_STATES * LD_MAX_WHEELS + 1];
    marching_evaluate(marching_of(self), &chassis, true, NULL,
                      state + mechanism_base_marching_at(self), unused, &marching);
    for (int j = 0; j < own->marching.wheel_count; j++)
        if (!(marching.wheel[j].normal > 0))
            return ld_fail(
                error, LD_ERR_INPUT,
                "base.wheels.%d: wheel \"%s\" does not reach the ground at the start: in "
                "equilibrium it hangs %.3g m above the road",
                j + 1, own->model->base.vehicle.wheel[j].name,
                fmax(0, -marching.wheel[j].deflection));
    return LD_OK;
}

// ---- linearised

// Displacements: those in the sense of the independent speeds, then wheel positions.
void mechanism_base_displace_slightly(const base_system *self, int displacement, double change,
                                      double *state)
{
    const mechanism_system *mechanism = mechanism_of(self);
    int k = displacement - mechanism->freedom_count;
    if (k < 0)
        mechanism_displace_freedom(mechanism, displacement, change, state);
    else
        state[mechanism_base_marching_at(self) + WHEEL_STATES * (k / 3) + WHEEL_R + k % 3] +=
            change;
}

int mechanism_base_speed_of(const base_system *self, int displacement)
{
    const mechanism_system *mechanism = mechanism_of(self);
    int k = displacement - mechanism->freedom_count;
    return k < 0 ? mechanism->q_count + mechanism->freedom[displacement]
                 : mechanism_base_marching_at(self) + WHEEL_STATES * (k / 3) + WHEEL_V + k % 3;
}

void mechanism_base_quicken(const base_system *self, int displacement, double change, double *state)
{
    const mechanism_system *mechanism = mechanism_of(self);
    if (displacement < mechanism->freedom_count)
        mechanism_quicken_freedom(mechanism, displacement, change, state);
    else
        state[mechanism_base_speed_of(self, displacement)] += change;
}

// The holds' integrals, then what their drives have; the feet; eta and xi of each wheel, the
// drive's integral.
int mechanism_base_extra_of(const base_system *self, int extra)
{
    const mechanism_system *mechanism = mechanism_of(self);
    bool drives = mechanism->hold_count && mechanism->hold[0].drive >= 0;
    int own = mechanism->hold_count * (1 + (drives ? DRIVE_STATES : 0));
    int feet = 2 * mechanism->given->foot_count;
    if (extra < own)
        return mechanism->z_at + extra;
    if (extra < own + feet)
        return mechanism->feet_at + extra - own;
    int k = extra - own - feet, wheels = marching_of(self)->wheel_count;
    if (k < 2 * wheels)
        return mechanism_base_marching_at(self) + WHEEL_STATES * (k / 2) + WHEEL_ETA + k % 2;
    return mechanism_base_marching_at(self) + WHEEL_STATES * wheels;
}

static int hold_of(const mechanism_system *mechanism, int displacement)
{
    for (int i = 0; i < mechanism->hold_count; i++)
        if (mechanism->hold[i].strut < 0 && displacement < mechanism->freedom_count &&
            mechanism->hold[i].u == mechanism->freedom[displacement])
            return i;
    return -1;
}

const char *mechanism_base_holder_of(const base_system *self, int displacement)
{
    const mechanism_base *own = self->own;
    int hold = hold_of(mechanism_of(self), displacement);
    return hold < 0 ? NULL : own->holder[hold];
}

double mechanism_base_held_by(const base_system *self, const base_output *output, int displacement)
{
    int hold = hold_of(mechanism_of(self), displacement);
    return hold < 0 ? 0 : output->report.mechanism.report.hold[hold].torque;
}

// ---- columns

#define AT(member) .at = QUANTITY_AT(rolling_instant, member)
#define EACH(array, member) .at = QUANTITY_OF_EACH(rolling_instant, array, member)

// clang-format off
const quantity rolling_drive_columns[] = {
    {"drive.speed", "m/s", "speed of the chassis along its heading", AT(marching.speed)},
    {"drive.force", "N", "drive force of all driven wheels", AT(marching.drive_force)},
};
const quantity rolling_wheel_columns[] = {
    {"wheel.%s.x", "m", "wheel %s: centre in I", EACH(wheel, r[0])},
    {"wheel.%s.y", "m", "wheel %s: centre in I", EACH(wheel, r[1])},
    {"wheel.%s.z", "m", "wheel %s: centre in I", EACH(wheel, r[2])},
    {"wheel.%s.road", "m", "wheel %s: height of the road under it", EACH(marching.wheel, height)},
    {"wheel.%s.travel", "m", "wheel %s: suspension travel along the chassis' y, from unloaded", EACH(marching.wheel, travel.y)},
    {"wheel.%s.deflection", "m", "wheel %s: tyre deflection", EACH(marching.wheel, deflection)},
    {"wheel.%s.tyre_force", "N", "wheel %s: vertical tyre force", EACH(marching.wheel, normal)},
    {"wheel.%s.along", "N", "wheel %s: longitudinal tyre force", EACH(marching.wheel, along)},
    {"wheel.%s.side", "N", "wheel %s: lateral tyre force", EACH(marching.wheel, side)},
};
// clang-format on

void mechanism_base_fill_rolling(const base_system *base, const base_output *output,
                                 const double *state, rolling_instant *now)
{
    const double *wheel = state + mechanism_base_marching_at(base);
    for (int j = 0; j < base->model->base.vehicle.wheel_count; j++)
        memcpy(now->wheel[j].r, wheel + j * WHEEL_STATES + WHEEL_R, sizeof now->wheel[j].r);
    now->marching = output->report.marching;
}
