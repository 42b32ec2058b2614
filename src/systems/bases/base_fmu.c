// A base that an FMU of other people's moves, under the wrench of the tube (foreign/foreign.h).
//
// The FMU reports a frame F, in which the tube is mounted, at instants t_k = t_0 + k step. At t_k
// it is given the wrench on F's origin and continues to t_k+1 before the launch does, so that the
// launch knows F at both ends of the step: between them F's place goes by the cubic that has both
// positions and velocities, its attitude by that of the rotation vector against the first end
// (Hermite). So the wrench alone is extrapolated: an FMU that holds its inputs is given the mean
// over the step that the last two wrenches report, W_k + (W_k - W_k-1)/2, whose error is of second
// order. One that takes rates of its inputs is given a ramp that has the mean, over the step, of
// the parabola through the last three, and the rate of the last two: with the first and the second
// difference D, E at t_k the mean W_k + D/2 + 5 E/12 and the rate D/step. Both the velocity and the
// place that follow are then of third order.
//
// State, constant between the instants: F at both ends with their times, the last wrenches, works.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "foreign/foreign.h"
#include "math/vectors/rotation_vector.h"
#include "model/model.h"
#include "systems/bases/base.h"

enum { FRAME_R = 0, FRAME_QUATERNION = 3, FRAME_V = 7, FRAME_W = 10, FRAME_SIZE = 13 };
enum { WRENCH_SIZE = 6 };
enum {
    FMU_T_FROM = 0,
    FMU_T_TO = 1,
    FMU_FROM = 2,
    FMU_TO = FMU_FROM + FRAME_SIZE,
    FMU_WRENCH = FMU_TO + FRAME_SIZE,     // the last, about F's origin, in I
    FMU_MEAN = FMU_WRENCH + WRENCH_SIZE,  // over the step that is known
    FMU_STEPS = FMU_MEAN + WRENCH_SIZE,   // taken so far
    FMU_WORK,                             // [J] done on the FMU up to its first end
    FMU_HELD_STATES,                      // of an FMU that is given no rates
    FMU_SLOPE = FMU_HELD_STATES,          // [1/s] of the wrench over the step that is known
    FMU_BEFORE = FMU_SLOPE + WRENCH_SIZE, // the wrench before the last
    FMU_STATES = FMU_BEFORE + WRENCH_SIZE
};
_Static_assert((int)FMU_STATES <= (int)BASE_MOST_STATES, "more states than a base is allowed");

// The names that our own vehicle as an FMU has.
static const char *const default_names[LD_FMU_QUANTITIES] = {
    "base.position.x",
    "base.position.y",
    "base.position.z",
    "base.quaternion.0",
    "base.quaternion.1",
    "base.quaternion.2",
    "base.quaternion.3",
    "base.yaw",
    "base.pitch",
    "base.roll",
    "base.velocity.x",
    "base.velocity.y",
    "base.velocity.z",
    "base.rate.x",
    "base.rate.y",
    "base.rate.z",
    "input.wrench.force.x",
    "input.wrench.force.y",
    "input.wrench.force.z",
    "input.wrench.moment.x",
    "input.wrench.moment.y",
    "input.wrench.moment.z",
};

// A variable of the FMU for a quantity; value in SI = factor value + offset.
typedef struct fmu_variable {
    bool there;
    foreign_value of;
    double factor, offset;
} fmu_variable;

typedef struct fmu_base {
    const ld_fmu_base *given;
    foreign_package *package;
    bool owns_package;
    m3 mount; // A_FT
    v3 at;    // [m] T's origin in F
    fmu_variable variable[LD_FMU_QUANTITIES];

    // of a run
    foreign_instance *instance; // NULL: not begun
    bool going;                 // it has left its initialization
    double t_first;             // [s] where it stood first
} fmu_base;

// ---- frames

// F without accelerations, which its state does not have.
static base_frame frame_in(const double *state)
{
    quat q = q_from(state + FRAME_QUATERNION);
    return (base_frame){.r = v3_from(state + FRAME_R),
                        .v = v3_from(state + FRAME_V),
                        .A = q_matrix(q),
                        .q = q,
                        .w = v3_from(state + FRAME_W)};
}

// The cubic over 0 <= x <= 1, of length h [s], with these ends and rates; its rate and second.
static v3 cubic(double x, double h, const v3 end[2], const v3 rate[2], v3 *first, v3 *second)
{
    v3 chord = v3_sub(end[1], end[0]);
    v3 c2 = v3_sub(v3_scale(3, chord), v3_scale(h, v3_add(v3_scale(2, rate[0]), rate[1])));
    v3 c3 = v3_sub(v3_scale(h, v3_add(rate[0], rate[1])), v3_scale(2, chord));
    *first = v3_add(rate[0], v3_scale(x / h, v3_add(v3_scale(2, c2), v3_scale(3 * x, c3))));
    *second = v3_scale(1 / (h * h), v3_add(v3_scale(2, c2), v3_scale(6 * x, c3)));
    return v3_add(end[0],
                  v3_add(v3_scale(x * h, rate[0]), v3_scale(x * x, v3_add(c2, v3_scale(x, c3)))));
}

// F at time t; outside of the step that is known as at its nearer end.
static void frame_at(const double *state, double t, base_frame *frame)
{
    double h = state[FMU_T_TO] - state[FMU_T_FROM], x = h > 0 ? (t - state[FMU_T_FROM]) / h : 1;
    *frame = frame_in(state + (x > 0 ? FMU_TO : FMU_FROM));
    if (!(h > 0) || x < 0 || x > 1)
        return;
    base_frame from = frame_in(state + FMU_FROM), to = *frame;
    v3 turn = rv_log(m3_mul(to.A, m3_transpose(from.A)));
    v3 turn_rate = rv_left_jacobian_inverse_transposed(v3_neg(turn), to.w);
    v3 theta_dot, theta_ddot;
    v3 theta = cubic(x, h, (const v3[]){v3_zero(), turn}, (const v3[]){from.w, turn_rate},
                     &theta_dot, &theta_ddot);
    frame->r =
        cubic(x, h, (const v3[]){from.r, to.r}, (const v3[]){from.v, to.v}, &frame->v, &frame->a);
    m3 J = rv_left_jacobian(theta);
    frame->A = m3_mul(rv_exp(theta), from.A);
    frame->q = q_from_matrix(frame->A);
    frame->w = m3_apply(J, theta_dot);
    frame->alpha =
        v3_add(m3_apply(J, theta_ddot), rv_left_jacobian_derivative(theta, theta_dot, theta_dot));
}

static bool is_ramped(const fmu_base *self)
{
    return self->given->inputs == LD_FMU_RAMPED;
}

// [J] that what a ramp adds to its mean has done until t, on the way to F: with
// the motion a cubic, the integral of slope (time - h/2) velocity.
static double ramp_work_until(const double *state, double t, const base_frame *F)
{
    base_frame from = frame_in(state + FMU_FROM);
    double T = t - state[FMU_T_FROM], h = state[FMU_T_TO] - state[FMU_T_FROM];
    v3 turn = rv_log(m3_mul(F->A, m3_transpose(from.A)));
    v3 way = v3_add(v3_scale(0.5 * (T - h), v3_sub(F->r, from.r)),
                    v3_scale(T * T / 12, v3_sub(F->v, from.v)));
    v3 turning = v3_add(v3_scale(0.5 * (T - h), turn), v3_scale(T * T / 12, v3_sub(F->w, from.w)));
    const double *slope = state + FMU_SLOPE;
    return v3_dot(v3_from(slope), way) + v3_dot(v3_from(slope + 3), turning);
}

// [J] that the wrench, as the FMU was given it, has done until t, on the way to F.
static double work_until(const fmu_base *self, const double *state, double t, const base_frame *F)
{
    base_frame from = frame_in(state + FMU_FROM);
    const double *mean = state + FMU_MEAN;
    double work = v3_dot(v3_from(mean), v3_sub(F->r, from.r)) +
                  v3_dot(v3_from(mean + 3), rv_log(m3_mul(F->A, m3_transpose(from.A))));
    return is_ramped(self) ? work + ramp_work_until(state, t, F) : work;
}

static void find_frame(const base_system *base, double t, const double *state, base_frame *tube,
                       base_found *found)
{
    const fmu_base *self = base->own;
    base_frame F;
    frame_at(state, t, &F);
    v3 arm = m3_apply(F.A, self->at), turning = v3_cross(F.w, arm);
    tube->r = v3_add(F.r, arm);
    tube->v = v3_add(F.v, turning);
    tube->A = m3_mul(F.A, self->mount);
    tube->q = q_from_matrix(tube->A);
    tube->w = F.w;
    tube->a = v3_add(F.a, v3_add(v3_cross(F.alpha, arm), v3_cross(F.w, turning)));
    tube->alpha = F.alpha;
    found->fmu = (fmu_found){F, t};
}

// ---- what the FMU is reported and reports

static ld_status not_finite(const fmu_base *self, double t, int i, double value, ld_error *error)
{
    return ld_fail(error, LD_ERR_NUMERIC, "%.300s: the FMU reports that %s is %g at t = %.9g s",
                   self->package->path, default_names[i], value, t);
}

// The frame that its numbers report, [LD_FMU_FORCE] by quantity, in SI.
static ld_status take_frame(const fmu_base *self, double t, const double *number, double *frame,
                            ld_error *error)
{
    bool by_angles = self->variable[LD_FMU_ANGLES].there;
    for (int i = 0; i < LD_FMU_FORCE; i++)
        if (self->variable[i].there && !isfinite(number[i]))
            return not_finite(self, t, i, number[i], error);
    quat q = q_from(number + LD_FMU_QUATERNION);
    if (by_angles) {
        const double *angle = number + LD_FMU_ANGLES;
        q = q_from_matrix(m3_mul(m3_rotation_y(angle[0]),
                                 m3_mul(m3_rotation_z(angle[1]), m3_rotation_x(angle[2]))));
    }
    double length = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(fabs(length - 1) <= 1e-3))
        return ld_fail(
            error, LD_ERR_NUMERIC,
            "%.300s: the FMU reports a quaternion of length %.6g, expected 1, at t = %.9g s",
            self->package->path, length, t);
    double unit[4] = {q.w / length, q.x / length, q.y / length, q.z / length};
    v3 w = v3_from(number + LD_FMU_RATE);
    if (self->given->rate_axes == LD_FMU_AXES_OF_BODY)
        w = m3_apply(q_matrix(q_from(unit)), w);
    memcpy(frame + FRAME_R, number + LD_FMU_POSITION, 3 * sizeof *frame);
    memcpy(frame + FRAME_QUATERNION, unit, sizeof unit);
    memcpy(frame + FRAME_V, number + LD_FMU_VELOCITY, 3 * sizeof *frame);
    v3_store(frame + FRAME_W, w);
    return LD_OK;
}

// Its inputs with this wrench about F's origin, and its rate (NULL: none is given), then its
// outputs; how many of each.
static foreign_stepping values_of(const fmu_base *self, const double wrench[WRENCH_SIZE],
                                  const double *rate, foreign_value value[LD_FMU_QUANTITIES])
{
    foreign_stepping step = {.with_rates = rate != NULL};
    int count = 0;
    for (int i = LD_FMU_FORCE; i < LD_FMU_QUANTITIES; i++) {
        const fmu_variable *one = &self->variable[i];
        if (!one->there)
            continue;
        value[count] = one->of;
        value[count].rate = rate ? rate[i - LD_FMU_FORCE] / one->factor : 0;
        value[count++].value = (wrench[i - LD_FMU_FORCE] - one->offset) / one->factor;
    }
    step.inputs = (uint32_t)count;
    for (int i = 0; i < LD_FMU_FORCE; i++)
        if (self->variable[i].there)
            value[count++] = self->variable[i].of;
    step.outputs = (uint32_t)count - step.inputs;
    return step;
}

// Outputs as they came, by quantity and in SI.
static void sort_outputs(const fmu_base *self, const double *told, double number[LD_FMU_FORCE])
{
    for (int i = 0, k = 0; i < LD_FMU_FORCE; i++) {
        const fmu_variable *one = &self->variable[i];
        number[i] = one->there ? one->factor * told[k++] + one->offset : 0;
    }
}

// The tube's wrench about F's origin.
static void carry(const fmu_base *self, const base_wrench *on, const double *frame,
                  double wrench[WRENCH_SIZE])
{
    v3 arm = m3_apply(q_matrix(q_from(frame + FRAME_QUATERNION)), self->at);
    v3_store(wrench, on->force);
    v3_store(wrench + 3, v3_add(on->moment, v3_cross(arm, on->force)));
}

// ---- a run

static ld_status set_parameters(fmu_base *self, double t, ld_error *error)
{
    ld_status status = LD_OK;
    for (int i = 0; i < self->given->parameter_count && !status; i++) {
        const ld_fmu_parameter *one = &self->given->parameter[i];
        const foreign_variable *variable =
            foreign_variable_find(&self->package->description, one->name);
        const foreign_value value = {
            .reference = variable->reference, .type = (int32_t)variable->type, .value = one->value};
        status = one->text ? foreign_set_text(self->instance, t, value.reference, one->text, error)
                           : foreign_set(self->instance, t, &value, 1, error);
    }
    return status;
}

// In its initialization mode.
static ld_status begin(fmu_base *self, double t, ld_error *error)
{
    if (self->instance)
        return LD_OK;
    self->going = false;
    self->t_first = t;
    ld_status status =
        foreign_begin(self->package, self->given->time_limit, &self->instance, error);
    if (!status)
        status = set_parameters(self, t, error);
    return status ? status : foreign_enter(self->instance, t, self->given->start_time, error);
}

static ld_status find_rest(const base_system *base, double t, const base_wrench *on, double *state,
                           double *moved, ld_error *error)
{
    fmu_base *self = base->own;
    bool first = !self->instance;
    double told[LD_FMU_QUANTITIES], number[LD_FMU_FORCE], wrench[WRENCH_SIZE], frame[FRAME_SIZE];
    foreign_value value[LD_FMU_QUANTITIES];
    ld_status status = begin(self, t, error);
    if (status)
        return status;
    if (first)
        memset(wrench, 0, sizeof wrench);
    else
        carry(self, on, state + FMU_TO, wrench);
    foreign_stepping step = values_of(self, wrench, NULL, value);
    status = foreign_set(self->instance, t, value, step.inputs, error);
    if (!status)
        status = foreign_get(self->instance, t, value + step.inputs, step.outputs, told, error);
    if (status)
        return status;
    sort_outputs(self, told, number);
    status = take_frame(self, t, number, frame, error);
    *moved = first ? INFINITY : 0;
    for (int i = FRAME_R; i < FRAME_V && !first; i++)
        *moved = fmax(*moved, fabs(frame[i] - state[FMU_TO + i]));
    memset(state, 0, (size_t)base->state_count * sizeof *state);
    state[FMU_T_FROM] = state[FMU_T_TO] = t;
    memcpy(state + FMU_FROM, frame, sizeof frame);
    memcpy(state + FMU_TO, frame, sizeof frame);
    return status;
}

static double next_instant(const base_system *base, double t)
{
    const fmu_base *self = base->own;
    double k = fmax(0, floor((t - self->t_first) / self->given->step) - 1), next;
    do
        next = self->t_first + k++ * self->given->step;
    while (next <= t);
    return next;
}

// What it is given for the coming step: the mean over it, or what it continues from on its own.
// Keeps both.
static void choose_inputs(const fmu_base *self, const double wrench[WRENCH_SIZE], double *state,
                          double inputs[WRENCH_SIZE])
{
    double *last = state + FMU_WRENCH, *mean = state + FMU_MEAN;
    for (int i = 0; i < WRENCH_SIZE; i++) {
        double change = state[FMU_STEPS] > 0 ? wrench[i] - last[i] : 0;
        mean[i] = wrench[i] + 0.5 * change;
        inputs[i] = self->given->inputs == LD_FMU_HELD ? mean[i] : wrench[i];
    }
    memcpy(last, wrench, WRENCH_SIZE * sizeof *last);
}

// The ramp in its place: where it begins. Keeps the last two wrenches, its mean and its rate.
static void choose_ramp(const fmu_base *self, const double wrench[WRENCH_SIZE], double *state,
                        double inputs[WRENCH_SIZE])
{
    const double h = self->given->step;
    double *last = state + FMU_WRENCH, *before = state + FMU_BEFORE;
    for (int i = 0; i < WRENCH_SIZE; i++) {
        double first = state[FMU_STEPS] > 0 ? wrench[i] - last[i] : 0;
        double second = state[FMU_STEPS] > 1 ? first - (last[i] - before[i]) : 0;
        double mean = wrench[i] + first / 2 + second * 5 / 12, slope = first / h;
        state[FMU_MEAN + i] = mean;
        state[FMU_SLOPE + i] = slope;
        inputs[i] = mean - slope * h / 2;
        before[i] = last[i];
        last[i] = wrench[i];
    }
}

static ld_status leave_initialization(fmu_base *self, double t, ld_error *error)
{
    ld_status status = self->going ? LD_OK : foreign_leave(self->instance, t, error);
    self->going = true;
    return status;
}

// The launcher rests on the place that the initialization mode reported.
static ld_status check_place(fmu_base *self, double t, const double *state, ld_error *error)
{
    const double most = 1e-6; // [m], [rad]
    double told[LD_FMU_QUANTITIES], number[LD_FMU_FORCE], frame[FRAME_SIZE];
    double unused[WRENCH_SIZE] = {0}, moved = 0;
    foreign_value value[LD_FMU_QUANTITIES];
    foreign_stepping step = values_of(self, unused, NULL, value);
    ld_status status =
        foreign_get(self->instance, t, value + step.inputs, step.outputs, told, error);
    if (status)
        return status;
    sort_outputs(self, told, number);
    status = take_frame(self, t, number, frame, error);
    for (int i = FRAME_R; i < FRAME_V && !status; i++)
        moved = fmax(moved, fabs(frame[i] - state[FMU_TO + i]));
    if (status || moved <= most)
        return status;
    return ld_fail(error, LD_ERR_NUMERIC,
                   "%s: the FMU has moved by %.3g (m, or of its quaternion) when its "
                   "initialization ends; its outputs must follow its inputs during initialization",
                   self->package->path, moved);
}

static ld_status step_on(const base_system *base, double t, const base_wrench *on, double *state,
                         ld_error *error)
{
    fmu_base *self = base->own;
    double told[LD_FMU_QUANTITIES], number[LD_FMU_FORCE], frame[FRAME_SIZE];
    double wrench[WRENCH_SIZE], inputs[WRENCH_SIZE];
    foreign_value value[LD_FMU_QUANTITIES];
    int pieces;
    base_frame to = frame_in(state + FMU_TO);
    carry(self, on, state + FMU_TO, wrench);
    state[FMU_WORK] += work_until(self, state, t, &to);
    (is_ramped(self) ? choose_ramp : choose_inputs)(self, wrench, state, inputs);
    foreign_stepping step =
        values_of(self, inputs, is_ramped(self) ? state + FMU_SLOPE : NULL, value);
    double next = next_instant(base, t);
    step.t = self->given->start_time + (t - self->t_first);
    step.size = self->given->start_time + (next - self->t_first) - step.t;
    bool first = !self->going;
    ld_status status = leave_initialization(self, t, error);
    if (!status && first)
        status = check_place(self, t, state, error);
    if (!status)
        status = foreign_step(self->instance, t, &step, value, told, &pieces, error);
    if (status)
        return status;
    sort_outputs(self, told, number);
    status = take_frame(self, next, number, frame, error);
    if (status)
        return status;
    memcpy(state + FMU_FROM, state + FMU_TO, sizeof frame);
    memcpy(state + FMU_TO, frame, sizeof frame);
    state[FMU_T_FROM] = t;
    state[FMU_T_TO] = next;
    state[FMU_STEPS]++;
    return LD_OK;
}

static ld_status archive_run(const base_system *base, double t, archive *bytes, ld_error *error)
{
    fmu_base *self = base->own;
    double t_first = self->t_first;
    archive_double(bytes, &t_first);
    if (bytes->loading && !bytes->failed) {
        ld_status status = begin(self, t_first, error);
        if (!status)
            status = leave_initialization(self, t_first, error);
        if (status)
            return status;
    }
    return foreign_archive(self->instance, t, bytes, error);
}

static const base_stepping stepping = {
    .find_rest = find_rest, .step_on = step_on, .archive = archive_run};

// ---- columns

// clang-format off
static const quantity of_fmu[] = {
    {"base.fmu_work", "J", "work of the wrench on the FMU, as sent to it", .at = QUANTITY_AT(fmu_instant, work)},
};
// clang-format on
static const quantity_group quantity_groups[] = {
    {.title = "base moved by an FMU", QUANTITY_ROWS(of_fmu)},
};
static const quantity_table quantities = {quantity_groups, 1};

static void fill_instant(const base_system *base, const base_found *found,
                         const base_output *output, const double *state, base_instant *instant)
{
    const fmu_found *now = &found->fmu;
    (void)output;
    instant->fmu.work = state[FMU_WORK] + work_until(base->own, state, now->t, &now->frame);
}

// ---- set-up

// `by`: the key that names it; where it is not given, by default, it is the file that does not fit.
static ld_status fail_unknown(const fmu_base *self, const char *by, bool given, const char *name,
                              foreign_causality causality, ld_error *error)
{
    const char *near = foreign_variable_near(&self->package->description, name, causality);
    return ld_fail(error, LD_ERR_INPUT, "%s: %.200s has no variable \"%.100s\"%s%s%s%.100s%s",
                   given ? by : "base.file", self->package->path, name,
                   given ? "" : ", the default of ", given ? "" : by,
                   near ? "; did you mean \"" : "", near ? near : "", near ? "\"?" : "");
}

// Powers of kg, m, s, rad of a quantity's unit, and the unit in words.
typedef struct fmu_dimension {
    int kg, m, s, rad;
    const char *unit;
} fmu_dimension;

static fmu_dimension dimension_of(int i)
{
    return i >= LD_FMU_MOMENT       ? (fmu_dimension){1, 2, -2, 0, "N.m"}
           : i >= LD_FMU_FORCE      ? (fmu_dimension){1, 1, -2, 0, "N"}
           : i >= LD_FMU_RATE       ? (fmu_dimension){0, 0, -1, 1, "rad/s"}
           : i >= LD_FMU_VELOCITY   ? (fmu_dimension){0, 1, -1, 0, "m/s"}
           : i >= LD_FMU_ANGLES     ? (fmu_dimension){0, 0, 0, 1, "rad"}
           : i >= LD_FMU_QUATERNION ? (fmu_dimension){0, 0, 0, 0, "1"}
                                    : (fmu_dimension){0, 1, 0, 0, "m"};
}

// The radian is none of the base units to everybody.
static bool has_dimension(const foreign_unit *unit, fmu_dimension wanted)
{
    const int power[FOREIGN_BASE_UNITS] = {wanted.kg, wanted.m, wanted.s, 0, 0, 0, 0, 0};
    for (int i = 0; i < FOREIGN_BASE_UNITS - 1; i++)
        if (unit->power[i] != power[i])
            return false;
    int rad = unit->power[FOREIGN_BASE_UNITS - 1];
    return (rad == wanted.rad || rad == 0) && unit->factor != 0 && isfinite(unit->factor);
}

static ld_status check_variable(const fmu_base *self, int i, const char *key,
                                const foreign_variable *variable, ld_error *error)
{
    bool input = i >= LD_FMU_FORCE;
    const char *path = self->package->path;
    if (variable->type > FOREIGN_FLOAT32 || variable->elements)
        return ld_fail(error, LD_ERR_INPUT,
                       "%s: %.200s: variable %.100s is %s %s; expected a Float64", key, path,
                       variable->name, variable->elements ? "an array of" : "of type",
                       foreign_type_name(variable->type));
    if (input != (variable->causality == FOREIGN_INPUT))
        return ld_fail(error, LD_ERR_INPUT,
                       "%s: %.200s: variable %.100s has the causality %s; expected %s", key, path,
                       variable->name, foreign_causality_name(variable->causality),
                       input ? "input" : "one to be read, as output");
    if (variable->unit && !has_dimension(variable->unit, dimension_of(i)))
        return ld_fail(error, LD_ERR_INPUT,
                       "%s: %.200s: variable %.100s has the unit %.40s; expected one of "
                       "%s",
                       key, path, variable->name, variable->unit->name, dimension_of(i).unit);
    return LD_OK;
}

// Quantity i, by a name of the scenario's, or by default (NULL).
static ld_status connect(fmu_base *self, int i, const char *key, const char *name, ld_error *error)
{
    const char *wanted = name ? name : default_names[i];
    const foreign_variable *variable = foreign_variable_find(&self->package->description, wanted);
    if (!variable)
        return fail_unknown(self, key, name != NULL, wanted,
                            i >= LD_FMU_FORCE ? FOREIGN_INPUT : FOREIGN_OUTPUT, error);
    ld_status status = check_variable(self, i, key, variable, error);
    self->variable[i] = (fmu_variable){
        .there = true,
        .of = {.reference = variable->reference, .type = (int32_t)variable->type},
        .factor = variable->unit ? variable->unit->factor : 1,
        .offset = variable->unit ? variable->unit->offset : 0,
    };
    return status;
}

// What stands together in the scenario: names with blanks between.
typedef struct fmu_names {
    const char *key, *names;
    int first, count;
} fmu_names;

static ld_status connect_group(fmu_base *self, const fmu_names *group, ld_error *error)
{
    char name[256];
    const char *at = group->names ? group->names : "";
    ld_status status = LD_OK;
    for (int i = 0; i < group->count && !status; i++) {
        at += strspn(at, " ");
        int length = (int)strcspn(at, " ");
        snprintf(name, sizeof name, "%.*s", length, at);
        at += length;
        if (group->names && !length)
            return ld_fail(error, LD_ERR_INPUT, "%s: \"%.200s\" has %d names; expected %d",
                           group->key, group->names, i, group->count);
        status = connect(self, group->first + i, group->key, group->names ? name : NULL, error);
    }
    if (!status && at[strspn(at, " ")])
        status = ld_fail(error, LD_ERR_INPUT, "%s: \"%.200s\" has more than %d names", group->key,
                         group->names, group->count);
    return status;
}

static ld_status connect_all(fmu_base *self, ld_error *error)
{
    const ld_fmu_base *given = self->given;
    const fmu_names groups[] = {
        {"base.connect.position", given->connect.position, LD_FMU_POSITION, 3},
        {"base.connect.quaternion", given->connect.quaternion, LD_FMU_QUATERNION, 4},
        {"base.connect.angles", given->connect.angles, LD_FMU_ANGLES, 3},
        {"base.connect.velocity", given->connect.velocity, LD_FMU_VELOCITY, 3},
        {"base.connect.angular_rate", given->connect.angular_rate, LD_FMU_RATE, 3},
        {"base.connect.force", given->connect.force, LD_FMU_FORCE, 3},
        {"base.connect.moment", given->connect.moment, LD_FMU_MOMENT, 3},
    };
    bool by_angles = given->connect.angles != NULL;
    if (by_angles && given->connect.quaternion)
        return ld_fail(error, LD_ERR_INPUT,
                       "base.connect.angles: given together with quaternion; give one of them");
    ld_status status = LD_OK;
    for (size_t i = 0; i < sizeof groups / sizeof *groups && !status; i++)
        if (groups[i].first != (by_angles ? LD_FMU_QUATERNION : LD_FMU_ANGLES))
            status = connect_group(self, &groups[i], error);
    return status;
}

// Whether it may be set before its initialization, and to what is given.
static ld_status check_parameter(const fmu_base *self, int i, ld_error *error)
{
    const ld_fmu_parameter *given = &self->given->parameter[i];
    bool text = given->text != NULL;
    const foreign_variable *variable =
        foreign_variable_find(&self->package->description, given->name);
    if (!variable)
        return fail_unknown(self, "base.parameters", true, given->name, FOREIGN_PARAMETER, error);
    if (text != isnan(given->value))
        return ld_fail(error, LD_ERR_INPUT,
                       "base.parameters.%d: %.200s: expected one of value and text", i + 1,
                       given->name);
    bool starts = variable->causality == FOREIGN_PARAMETER ||
                  variable->causality == FOREIGN_INPUT || variable->has_start;
    bool fits = text ? variable->type == FOREIGN_STRING : variable->type <= FOREIGN_ENUMERATION;
    if (fits && !variable->elements && starts && variable->variability != FOREIGN_CONSTANT &&
        variable->causality != FOREIGN_STRUCTURAL_PARAMETER)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "base.parameters.%d: %.200s: variable %.100s (%s, %s%s) cannot be set to a %s",
                   i + 1, self->package->path, given->name,
                   foreign_causality_name(variable->causality),
                   variable->elements ? "array of " : "", foreign_type_name(variable->type),
                   text ? "text" : "number");
}

static ld_status check_parameters(const fmu_base *self, ld_error *error)
{
    ld_status status = LD_OK;
    for (int i = 0; i < self->given->parameter_count && !status; i++)
        status = check_parameter(self, i, error);
    return status;
}

static ld_status check_inputs(const fmu_base *self, ld_error *error)
{
    if (is_ramped(self) && !self->package->description.takes_rates)
        return ld_fail(
            error, LD_ERR_INPUT,
            "base.inputs: %.300s: found ramped, but the FMU takes no rates of its inputs "
            "(FMI 2.0, canInterpolateInputs); expected held or extrapolated",
            self->package->path);
    return LD_OK;
}

static ld_status check_step(const fmu_base *self, ld_error *error)
{
    double own = self->package->description.step, ratio = self->given->step / own;
    if (own > 0 && !(fabs(ratio - round(ratio)) <= 1e-9 * ratio && ratio >= 0.5))
        return ld_fail(
            error, LD_ERR_INPUT,
            "base.step: %.300s: the FMU steps by %g s; found %g s, which is not a multiple",
            self->package->path, own, self->given->step);
    return LD_OK;
}

static ld_status build(base_system *base, ld_error *error)
{
    const ld_base *given = &base->model->base;
    if (!given->fmu.file)
        return ld_fail(error, LD_ERR_INPUT, "base.file: missing");
    fmu_base *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base");
    base->own = self;
    base->state_count = given->fmu.inputs == LD_FMU_RAMPED ? FMU_STATES : FMU_HELD_STATES;
    self->given = &given->fmu;
    self->mount = m3_mul(m3_rotation_y(given->azimuth), m3_rotation_z(given->elevation));
    self->at = v3_from(given->at);
    self->owns_package = true;
    ld_status status = foreign_open(given->fmu.file, &self->package, error);
    if (!status)
        status = connect_all(self, error);
    if (!status)
        status = check_parameters(self, error);
    if (!status)
        status = check_inputs(self, error);
    return status ? status : check_step(self, error);
}

static void release(base_system *base)
{
    fmu_base *self = base->own;
    if (!self)
        return;
    foreign_end(self->instance);
    if (self->owns_package)
        foreign_close(self->package);
    free(self);
}

// Each run has an instance of its own.
static ld_status share(base_system *base, ld_error *error)
{
    const fmu_base *of = base->own;
    fmu_base *self = base->own = malloc(sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base");
    *self = *of;
    self->owns_package = false;
    self->instance = NULL;
    return LD_OK;
}

const base_interface base_fmu = {.build = build,
                                 .free = release,
                                 .share = share,
                                 .find_frame = find_frame,
                                 .next_sample = next_instant,
                                 .stepping = &stepping,
                                 .quantities = &quantities,
                                 .fill_instant = fill_instant};
