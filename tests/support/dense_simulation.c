#include "support/dense_simulation.h"

#include "math/matrices/lapack.h"
#include "model/model.h"
#include "support/dense_motor.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Integrated numbers: r, A_IR as a quaternion, v, w, q, q_dot, r_O1, A_IB as a quaternion, v_O1,
// w_B; of a vehicle also its states.
enum {
    LAUNCH_MAX = 26 + 2 * DENSE_MAX_MODES,
    STATE_MAX = LAUNCH_MAX + VEHICLE_BODY_STATES + DENSE_MARCHING_STATES
};

typedef struct launch_run {
    const ld_model *model;
    dense_launch dense;
    bool on_vehicle, frictionless;
    dense_vehicle vehicle;
    hold_rest rest[HINGES];
    int size, rocket, platform, wheels; // count of numbers, where the rocket's and vehicle's begin
    double ignition;                    // [s] on the run's clock
    bool locked, passed[LD_MAX_ADAPTORS];
    bool on_breech;                      // starts there, without a lock
    bool apart[DENSE_MAX_SURFACES];      // adaptor (or surface of a shoe) was off the wall
    double touch_speed[LD_MAX_ADAPTORS]; // [m/s] when it last touched
    double surface_touch_speed[DENSE_MAX_SURFACES]; // the same of a surface
    int slot_piece;                     // stretch of the slot's table, as in dense_conditions
    int slide_stop[LD_MAX_SUPPORTS][2]; // likewise
    double s;                           // [m] where O1 was last
    double step;
    dense_summary *summary;
} launch_run;

static const double two_pi = 6.283185307179586476925;

// ---------------------------------------------------------------- given functions of time

// Adds value and rate of a sum of sines.
static void add_sines(const ld_sines *sines, double t, double *value, double *rate)
{
    for (int i = 0; i < sines->count; i++) {
        const ld_sine *sine = &sines->term[i];
        double turn = two_pi * sine->frequency;
        *value += sine->amplitude * sin(turn * t + sine->phase);
        *rate += sine->amplitude * turn * cos(turn * t + sine->phase);
    }
}

// A := A times the rotation by `angle` about axis 0, 1 or 2.
static void turn_about(double A[3][3], int axis, double angle)
{
    int j = (axis + 1) % 3, k = (axis + 2) % 3;
    double c = cos(angle), s = sin(angle);
    for (int i = 0; i < 3; i++) {
        double a = A[i][j], b = A[i][k];
        A[i][j] = a * c + b * s;
        A[i][k] = b * c - a * s;
    }
}

static void set_unit(double A[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            A[i][j] = i == j;
}

void dense_base_at(const ld_model *model, double t, dense_base *base)
{
    const ld_base *given = &model->base;
    memset(base, 0, sizeof *base);
    set_unit(base->A);
    if (given->kind == LD_BASE_PRESCRIBED) {
        const ld_sines *path[3] = {&given->surge, &given->heave, &given->sway};
        const ld_sines *turn[3] = {&given->yaw, &given->pitch, &given->roll};
        const int axis[3] = {1, 2, 0};
        for (int i = 0; i < 3; i++) {
            base->r[i] = given->velocity[i] * t;
            base->v[i] = given->velocity[i];
            add_sines(path[i], t, &base->r[i], &base->v[i]);
        }
        // each turn is about an axis of the frame so far
        for (int i = 0; i < 3; i++) {
            double angle = 0, rate = 0;
            add_sines(turn[i], t, &angle, &rate);
            for (int k = 0; k < 3; k++)
                base->w[k] += rate * base->A[k][axis[i]];
            turn_about(base->A, axis[i], angle);
        }
    }
    turn_about(base->A, 1, given->azimuth);
    turn_about(base->A, 2, given->elevation);
}

// The same of the run's base, of a vehicle at state x.
static void base_at(const launch_run *launch, double t, const double *x, dense_base *base)
{
    if (!launch->on_vehicle) {
        dense_base_at(launch->model, t, base);
        return;
    }
    base_frame tube;
    dense_vehicle_tube(&launch->vehicle, x + launch->platform, &tube);
    v3_store(base->r, tube.r);
    v3_store(base->v, tube.v);
    v3_store(base->w, tube.w);
    memcpy(base->A, tube.A.a, sizeof base->A);
}

double dense_pressure_at(const ld_pressure *given, double since, double middle)
{
    const ld_table *table = &given->over_time;
    for (size_t i = 0; i + 1 < table->rows; i++) {
        const double *a = table->data + 2 * i, *b = a + 2;
        if (middle >= a[0] && middle < b[0]) {
            double share = (since - a[0]) / (b[0] - a[0]);
            return given->scale * ((1 - share) * a[1] + share * b[1]) - given->ambient;
        }
    }
    return 0;
}

void dense_rocket_at(const ld_model *model, double since, double middle, dense_conditions *on)
{
    const ld_rocket *rocket = &model->rocket;
    const ld_motor *motor = &rocket->motor;
    const ld_mass_data *full = &rocket->full, *empty = &rocket->empty;
    double sum[2] = {0};
    for (int k = 0; k <= rocket->further_motor_count; k++) {
        dense_curve curve = dense_curve_of(rocket, k);
        double impulse[2], T = dense_curve_at(&curve, since, middle, impulse);
        sum[0] += impulse[0];
        sum[1] += impulse[1];
        if (k == 0) {
            on->thrust = T;
            continue;
        }
        const ld_further_motor *one = &rocket->further_motor[k - 1];
        double e[3] = {1, one->misalignment[0], one->misalignment[1]};
        for (int i = 0; i < 3; i++) {
            on->further[k - 1].force[i] = T * e[i] / sqrt(1 + e[1] * e[1] + e[2] * e[2]);
            on->further[k - 1].at[i] = one->at[i];
        }
    }
    double burnt = sum[1] > 0 ? sum[0] / sum[1] : 0;
    on->power = middle < dense_burn_out(rocket);
    dense_motor_across(motor, since, on->across);
    if (!dense_motor_burns(motor, middle))
        on->across[0] = on->across[1] = 0;
    on->mass = full->mass + rocket->mass_error - burnt * rocket->propellant;
    for (int i = 0; i < 3; i++) {
        on->center[i] = full->center[i] + burnt * (empty->center[i] - full->center[i]);
        on->inertia[i] = full->inertia[i] + burnt * (empty->inertia[i] - full->inertia[i]);
        on->products[i] = rocket->products[i];
    }
    on->center[1] += rocket->eccentricity[0];
    on->center[2] += rocket->eccentricity[1];
}

void dense_air_at(const ld_model *model, dense_conditions *on)
{
    const ld_wind *wind = &model->environment.wind;
    double speed = wind->present ? wind->scale * wind->speed : 0;
    on->air[0] = speed * cos(wind->heading);
    on->air[1] = 0;
    on->air[2] = speed * sin(wind->heading);
    on->density = model->environment.atmosphere.density;
    on->sound = model->environment.atmosphere.speed_of_sound;
}

// Takes what has fallen off with the adaptors passed out of the sums about O1: mass, first moment,
// products of inertia.
static void drop_fallen(const ld_rocket *rocket, dense_conditions *on)
{
    double mass = on->mass, first[3], second[3][3], r2 = 0;
    for (int i = 0; i < 3; i++) {
        first[i] = mass * on->center[i];
        r2 += on->center[i] * on->center[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            second[i][j] = (i == j ? on->inertia[i] + mass * r2 : on->products[i + j - 1]) -
                           mass * on->center[i] * on->center[j];
    for (int k = 0; k < rocket->adaptor_count; k++) {
        const ld_falling *part = &rocket->adaptor[k].falls_off;
        const double r[3] = {rocket->adaptor[k].at, part->center[0], part->center[1]};
        if (!on->passed[k] || !part->present)
            continue;
        mass -= part->mass;
        for (int i = 0; i < 3; i++) {
            first[i] -= part->mass * r[i];
            second[i][i] -= part->inertia[i];
            for (int j = 0; j < 3; j++)
                second[i][j] += part->mass * (r[i] * r[j] -
                                              (i == j) * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]));
        }
    }
    on->mass = mass;
    r2 = 0;
    for (int i = 0; i < 3; i++) {
        on->center[i] = first[i] / mass;
        r2 += on->center[i] * on->center[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            double moment = second[i][j] + mass * on->center[i] * on->center[j];
            *(i == j ? &on->inertia[i] : &on->products[i + j - 1]) = moment - (i == j) * mass * r2;
        }
}

// What acts at time t of the run and state x, on the piece of the thrust table that holds time
// `middle`.
static void conditions_at(const launch_run *launch, double t, double middle, const double *x,
                          dense_conditions *on)
{
    memset(on, 0, sizeof *on);
    base_at(launch, t, x, &on->base);
    dense_rocket_at(launch->model, t - launch->ignition, middle - launch->ignition, on);
    dense_air_at(launch->model, on);
    on->pressed = middle >= launch->ignition;
    on->pressure = dense_pressure_at(&launch->model->tubes.pressure, t - launch->ignition,
                                     middle - launch->ignition);
    on->locked = launch->locked;
    on->breech = launch->model->rocket.start_at;
    on->frictionless = launch->frictionless;
    on->slot_piece = launch->slot_piece;
    memcpy(on->slide_stop, launch->slide_stop, sizeof on->slide_stop);
    memcpy(on->passed, launch->passed, sizeof on->passed);
    drop_fallen(&launch->model->rocket, on);
    memcpy(on->touch_speed, launch->touch_speed, sizeof on->touch_speed);
    memcpy(on->surface_touch_speed, launch->surface_touch_speed, sizeof on->surface_touch_speed);
}

// ---------------------------------------------------------------- numbers to integrate

static void matrix_of(double A[3][3], const double q[4])
{
    double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        A[i][i] =
            (q[0] * q[0] + q[1 + i] * q[1 + i] - q[1 + j] * q[1 + j] - q[1 + k] * q[1 + k]) / n;
        A[j][i] = 2 * (q[1 + i] * q[1 + j] + q[0] * q[1 + k]) / n;
        A[i][j] = 2 * (q[1 + i] * q[1 + j] - q[0] * q[1 + k]) / n;
    }
}

// Quaternion of A, largest component first.
static void quaternion_of(double q[4], const double A[3][3])
{
    double square[4] = {1 + A[0][0] + A[1][1] + A[2][2], 1 + A[0][0] - A[1][1] - A[2][2],
                        1 - A[0][0] + A[1][1] - A[2][2], 1 - A[0][0] - A[1][1] + A[2][2]};
    int big = 0;
    for (int i = 1; i < 4; i++)
        if (square[i] > square[big])
            big = i;
    q[big] = 0.5 * sqrt(square[big]);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double odd = A[k][j] - A[j][k], even = A[j][i] + A[i][j];
        if (big == 0)
            q[1 + i] = odd / (4 * q[0]);
        else if (big == 1 + i)
            q[0] = odd / (4 * q[big]);
        if (big == 1 + i)
            q[1 + j] = even / (4 * q[big]);
        if (big == 1 + j)
            q[1 + i] = even / (4 * q[big]);
    }
}

static void quaternion_rate(double rate[4], const double q[4], const double w[3])
{
    rate[0] = -0.5 * (q[1] * w[0] + q[2] * w[1] + q[3] * w[2]);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        rate[1 + i] = 0.5 * (q[0] * w[i] + q[1 + j] * w[k] - q[1 + k] * w[j]);
    }
}

static void unpack(const launch_run *launch, const double *x, dense_state *state)
{
    int nq = launch->dense.mode_count;
    const double *rocket = x + launch->rocket;
    memset(state, 0, sizeof *state);
    memcpy(state->r, x, sizeof state->r);
    matrix_of(state->A_R, x + 3);
    memcpy(state->v, x + 7, sizeof state->v);
    memcpy(state->w, x + 10, sizeof state->w);
    memcpy(state->q, x + 13, (size_t)nq * sizeof *x);
    memcpy(state->q_dot, x + 13 + nq, (size_t)nq * sizeof *x);
    memcpy(state->r_O1, rocket, sizeof state->r_O1);
    matrix_of(state->A_B, rocket + 3);
    memcpy(state->v_O1, rocket + 7, sizeof state->v_O1);
    memcpy(state->w_B, rocket + 10, sizeof state->w_B);
    state->s = launch->s;
}

static void pack(const launch_run *launch, const dense_state *state, double *x)
{
    int nq = launch->dense.mode_count;
    double *rocket = x + launch->rocket;
    memcpy(x, state->r, sizeof state->r);
    quaternion_of(x + 3, (const double(*)[3])state->A_R);
    memcpy(x + 7, state->v, sizeof state->v);
    memcpy(x + 10, state->w, sizeof state->w);
    memcpy(x + 13, state->q, (size_t)nq * sizeof *x);
    memcpy(x + 13 + nq, state->q_dot, (size_t)nq * sizeof *x);
    memcpy(rocket, state->r_O1, sizeof state->r_O1);
    quaternion_of(rocket + 3, (const double(*)[3])state->A_B);
    memcpy(rocket + 7, state->v_O1, sizeof state->v_O1);
    memcpy(rocket + 10, state->w_B, sizeof state->w_B);
}

// Rates and forces of the vehicle under the tube's supports.
static bool vehicle_at(const launch_run *launch, double t, double middle, const double *x,
                       const dense_launch_output *tube, dense_vehicle_output *output)
{
    dense_vehicle_input input = {.t = t,
                                 .command_at = middle,
                                 .orientating = x + launch->platform,
                                 .marching = x + launch->wheels,
                                 .tube_force = v3_from(tube->base_force),
                                 .tube_moment = v3_from(tube->base_moment),
                                 .frictionless = launch->frictionless};
    memcpy(input.rest, launch->rest, sizeof input.rest);
    return dense_vehicle_evaluate(&launch->vehicle, &input, output);
}

static bool derivative(launch_run *launch, double t, double middle, const double *x, double *x_dot,
                       dense_launch_output *output)
{
    dense_state state;
    dense_conditions on;
    dense_rates rates;
    dense_launch_output own;
    output = output ? output : &own;
    int nq = launch->dense.mode_count;
    unpack(launch, x, &state);
    conditions_at(launch, t, middle, x, &on);
    launch->summary->evaluations++;
    if (!dense_launch_rates(&launch->dense, &state, &on, &rates, output))
        return false;
    double *rocket = x_dot + launch->rocket;
    memcpy(x_dot, state.v, sizeof state.v);
    quaternion_rate(x_dot + 3, x + 3, state.w);
    memcpy(x_dot + 7, rates.x_ddot, 6 * sizeof *x_dot);
    memcpy(x_dot + 13, state.q_dot, (size_t)nq * sizeof *x_dot);
    memcpy(x_dot + 13 + nq, rates.x_ddot + 6, (size_t)nq * sizeof *x_dot);
    memcpy(rocket, state.v_O1, sizeof state.v_O1);
    quaternion_rate(rocket + 3, x + launch->rocket + 3, state.w_B);
    memcpy(rocket + 7, rates.x_ddot + 6 + nq, 6 * sizeof *x_dot);
    if (!launch->on_vehicle)
        return true;
    dense_vehicle_output vehicle;
    if (!vehicle_at(launch, t, middle, x, output, &vehicle))
        return false;
    memcpy(x_dot + launch->platform, vehicle.orientating, sizeof vehicle.orientating);
    memcpy(x_dot + launch->wheels, vehicle.marching,
           (size_t)(launch->size - launch->wheels) * sizeof *x_dot);
    return true;
}

// The vehicle as it is at time t.
static void note_instant(const launch_run *launch, double t, const double *x,
                         const dense_launch_output *tube, dense_instant *instant)
{
    if (!launch->on_vehicle)
        return;
    memcpy(instant->orientating, x + launch->platform, sizeof instant->orientating);
    memcpy(instant->marching, x + launch->wheels,
           (size_t)(launch->size - launch->wheels) * sizeof *x);
    vehicle_at(launch, t, t, x, tube, &instant->output);
}

// One classical Runge-Kutta step from x with the rate k1 that holds there; output at its end.
static bool take_step(launch_run *launch, double t, double h, const double *x, const double *k1,
                      double *after, double *rate_after, dense_launch_output *output)
{
    double k[4][STATE_MAX], middle = t + 0.5 * h;
    memcpy(k[0], k1, sizeof k[0]);
    for (int i = 1; i < 4; i++) {
        double part = i < 3 ? 0.5 * h : h;
        for (int j = 0; j < launch->size; j++)
            after[j] = x[j] + part * k[i - 1][j];
        if (!derivative(launch, t + part, middle, after, k[i], NULL))
            return false;
    }
    for (int j = 0; j < launch->size; j++)
        after[j] = x[j] + h / 6 * (k[0][j] + 2 * k[1][j] + 2 * k[2][j] + k[3][j]);
    return derivative(launch, t + h, middle, after, rate_after, output);
}

// ---------------------------------------------------------------- start

// Unknowns: base-relative place and turning of R (6), q, y_S, z_S, psi, theta, lock force on the
// rocket (on the breech: s less the start), slot force or roll moment, on surfaces that the lock
// does not keep from rolling gamma. Residuals: all generalised forces. On surfaces soft springs
// [N/m, and N m/rad] hold the rocket in its centred place; they are released in steps, the last
// hold what no surface does.
typedef struct balance_problem {
    const launch_run *launch;
    dense_conditions on;
    int n;
    bool rolls; // gamma is unknown
    double soft;
} balance_problem;

static void start_input(const balance_problem *balance, const double *u, dense_launch_input *input)
{
    const dense_base *base = &balance->on.base;
    int nq = balance->launch->dense.mode_count;
    double A[3][3];
    memset(input, 0, sizeof *input);
    memcpy(A, base->A, sizeof A);
    memcpy(input->r, base->r, sizeof input->r);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            input->r[i] += base->A[i][j] * u[j];
    for (int i = 0; i < 3; i++)
        turn_about(A, i, u[3 + i]);
    quaternion_of(input->quaternion, (const double(*)[3])A);
    memcpy(input->q, u + 6, (size_t)nq * sizeof *u);
    input->s = balance->launch->model->rocket.start_at;
    if (balance->launch->on_breech)
        input->s += u[balance->n - 2];
    input->y = u[6 + nq];
    input->z = u[7 + nq];
    input->psi = u[8 + nq];
    input->theta = u[9 + nq];
    input->gamma = balance->rolls ? u[balance->n - 1] : 0;
    input->conditions = balance->on;
}

// The soft springs' generalised forces, on the rocket alone.
static void add_soft(const balance_problem *balance, const dense_launch_input *input,
                     double *residual)
{
    const double *line = balance->launch->dense.line;
    double offset[2] = {input->y - line[0], input->z - line[1]};
    double turn[3] = {input->gamma, input->theta, input->psi};
    double *rocket = residual + balance->n - 6;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 2; j++)
            rocket[i] -= balance->soft * balance->on.base.A[i][1 + j] * offset[j];
        rocket[3 + i] -= balance->soft * turn[i];
    }
}

static bool residual_of(const balance_problem *balance, const double *u, double *residual,
                        dense_launch_output *output)
{
    const dense_launch *dense = &balance->launch->dense;
    bool slotted = balance->launch->model->tubes.slot.kind == LD_SLOT_HELIX;
    dense_launch_input input;
    dense_state state;
    dense_rates rates;
    start_input(balance, u, &input);
    dense_launch_place(dense, &input, &state);
    if (!dense_launch_rates(dense, &state, &balance->on, &rates, output))
        return false;
    double lock = balance->launch->on_breech ? 0 : u[balance->n - 2];
    double across = balance->rolls ? 0 : u[balance->n - 1];
    for (int i = 0; i < balance->n; i++)
        residual[i] = rates.h[i] + lock * rates.G[0][i] + across * rates.G[slotted ? 1 : 2][i];
    add_soft(balance, &input, residual);
    return true;
}

static double norm_of(const double *a, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * a[i];
    return sqrt(sum);
}

// Newton's method with differences for the Jacobian and halved steps.
static bool find_balance(const balance_problem *balance, double *u)
{
    enum { SIZE = DENSE_MAX_COORDINATES };
    static _Thread_local double jacobian[SIZE * SIZE];
    double residual[SIZE], side[2][SIZE], step[SIZE], trial[SIZE], there[SIZE];
    lapack_int pivot[SIZE];
    int n = balance->n;
    if (!residual_of(balance, u, residual, NULL))
        return false;
    for (int iteration = 0; iteration < 60; iteration++) {
        for (int j = 0; j < n; j++) {
            bool length = j < n - 2 || (j == n - 2 && balance->launch->on_breech) ||
                          (j == n - 1 && balance->rolls);
            double h = length ? 1e-7 : 1;
            for (int i = 0; i < 2; i++) {
                memcpy(trial, u, sizeof trial);
                trial[j] += i == 0 ? -h : h;
                if (!residual_of(balance, trial, side[i], NULL))
                    return false;
            }
            for (int i = 0; i < n; i++)
                jacobian[j * n + i] = (side[1][i] - side[0][i]) / (2 * h);
        }
        for (int i = 0; i < n; i++)
            step[i] = -residual[i];
        if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, jacobian, n, pivot, step, n) != 0)
            return false;
        double before = norm_of(residual, n), part = 1;
        for (; part > 1e-3; part /= 2) {
            for (int i = 0; i < n; i++)
                trial[i] = u[i] + part * step[i];
            if (residual_of(balance, trial, there, NULL) && norm_of(there, n) < before)
                break;
        }
        if (part <= 1e-3) { // no better: converged to rounding, or stuck
            if (before < 1e-5 || balance->soft == 0)
                return before < 1e-5;
            for (int i = 0; i < n; i++) // at a surface's kink: across it
                trial[i] = u[i] + step[i];
            if (!residual_of(balance, trial, there, NULL))
                return false;
        }
        memcpy(u, trial, sizeof trial);
        memcpy(residual, there, sizeof residual);
    }
    return norm_of(residual, n) < 1e-5;
}

// Where a rigid rocket lies on a straight lower wall: the two adaptors on either side of its mass
// centre whose line no other one crosses, pressed in a little. Height of O1 and slope.
static void lay_down(const ld_rocket *rocket, double center, double *height, double *slope)
{
    const ld_adaptor *adaptor = rocket->adaptor;
    for (int i = 0; i < rocket->adaptor_count; i++)
        for (int j = 0; j < rocket->adaptor_count; j++) {
            if (!(adaptor[i].at <= center && center < adaptor[j].at))
                continue;
            double rise =
                (adaptor[i].clearance - adaptor[j].clearance) / (adaptor[j].at - adaptor[i].at);
            double start = -adaptor[i].clearance - rise * adaptor[i].at;
            bool free = true;
            for (int k = 0; k < rocket->adaptor_count; k++)
                free = free && start + rise * adaptor[k].at >= -adaptor[k].clearance - 1e-9;
            if (free) {
                *height = start - 5e-6;
                *slope = rise;
                return;
            }
        }
}

// Balance on a base that is at rest, in a bore from where the rocket lies, on surfaces from its
// centred place, held ever more softly.
static bool find_balance_held(balance_problem *balance, double *u)
{
    bool found = true;
    balance->soft = balance->launch->dense.surface_count ? 1e7 : 0;
    for (; found && balance->soft > 1e-3; balance->soft /= 10)
        found = find_balance(balance, u);
    return found && find_balance(balance, u);
}

static void co_move(dense_state *state, const dense_base *base)
{
    double *place[2] = {state->r, state->r_O1}, *speed[2] = {state->v, state->v_O1};
    for (int b = 0; b < 2; b++)
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3, k = (i + 2) % 3;
            speed[b][i] = base->v[i] + base->w[j] * (place[b][k] - base->r[k]) -
                          base->w[k] * (place[b][j] - base->r[j]);
        }
    for (int i = 0; i < 3; i++) {
        state->w[i] = state->w_B[i] = 0;
        for (int k = 0; k < 3; k++) {
            state->w[i] += state->A_R[k][i] * base->w[k];
            state->w_B[i] += state->A_B[k][i] * base->w[k];
        }
    }
}

// The base at rest as it is at state x.
static void hold_base(const launch_run *launch, double t, const double *x, dense_conditions *on)
{
    conditions_at(launch, t, t, x, on);
    on->thrust = on->across[0] = on->across[1] = 0;
    on->pressed = false;
    on->frictionless = true;
    memset(on->base.v, 0, sizeof on->base.v);
    memset(on->base.w, 0, sizeof on->base.w);
}

// Vehicle and launching subsystem in equilibrium with one another, each in turn under what the
// other gave; the vehicle's states go into x, the launching subsystem's unknowns into u.
static bool find_balance_on_vehicle(balance_problem *balance, launch_run *launch, double t,
                                    double *x, double *u)
{
    const ld_model *model = launch->model;
    double place = -model->base.vehicle.speed * model->run.lead_in, residual;
    double wrench[6] = {0}, change = INFINITY;
    for (int i = 0; i < 12 && change > 1e-7; i++) {
        dense_launch_output output;
        double left[DENSE_MAX_COORDINATES];
        if (!dense_vehicle_equilibrium(&launch->vehicle, t, place, v3_from(wrench),
                                       v3_from(wrench + 3), x + launch->platform,
                                       x + launch->wheels, launch->rest, &residual))
            return false;
        hold_base(launch, t, x, &balance->on);
        if (!find_balance_held(balance, u) || !residual_of(balance, u, left, &output))
            return false;
        change = 0;
        for (int k = 0; k < 3; k++) {
            change = fmax(change, fabs(output.base_force[k] - wrench[k]));
            change = fmax(change, fabs(output.base_moment[k] - wrench[3 + k]));
            wrench[k] = output.base_force[k];
            wrench[3 + k] = output.base_moment[k];
        }
    }
    return change <= 1e-7;
}

static bool settle(launch_run *launch, double t, balance_problem *balance, double *x, double *u)
{
    const ld_rocket *rocket = &launch->model->rocket;
    int nq = launch->dense.mode_count;
    dense_launch_output output;
    double residual[DENSE_MAX_COORDINATES];
    if (launch->dense.surface_count == 0)
        lay_down(rocket, balance->on.center[0], &u[6 + nq], &u[8 + nq]);
    if (launch->on_breech)
        u[balance->n - 2] = -5e-6;
    bool found = launch->on_vehicle ? find_balance_on_vehicle(balance, launch, t, x, u)
                                    : find_balance_held(balance, u);
    if (!found || !residual_of(balance, u, residual, &output))
        return false;
    dense_summary *summary = launch->summary;
    summary->equilibrium.lock_force = launch->on_breech ? 0 : -u[balance->n - 2];
    summary->equilibrium.breech_force = output.breech_force;
    summary->equilibrium.slot_force =
        launch->model->tubes.slot.kind == LD_SLOT_HELIX ? u[balance->n - 1] : 0;
    for (int i = 0; i < rocket->adaptor_count; i++)
        summary->equilibrium.contact_force[i] = output.contact[i].normal;
    double worst = 0;
    for (int i = 0; i < 3; i++)
        worst = fmax(worst, fmax(fmax(fabs(output.a[i]), fabs(output.w_dot[i])),
                                 fmax(fabs(output.a_O1[i]), fabs(output.alpha_B[i]))));
    for (int i = 0; i < nq; i++)
        worst = fmax(worst, fabs(output.q_ddot[i]));
    summary->equilibrium.residual = worst;
    note_instant(launch, t, x, &output, &summary->start);
    return true;
}

static bool start(launch_run *launch, double t, double *x)
{
    const ld_model *model = launch->model;
    balance_problem balance = {.launch = launch, .n = launch->dense.mode_count + 12};
    double u[DENSE_MAX_COORDINATES] = {0};
    launch->on_breech = model->run.start == LD_START_EQUILIBRIUM && !model->rocket.lock.present;
    launch->locked = !launch->on_breech;
    balance.rolls =
        launch->dense.surface_count && !(launch->locked && dense_launch_holds_roll(&launch->dense));
    u[6 + launch->dense.mode_count] = launch->dense.line[0];
    u[7 + launch->dense.mode_count] = launch->dense.line[1];
    if (launch->on_vehicle)
        x[launch->platform + VEHICLE_QUATERNION] = 1;
    hold_base(launch, t, x, &balance.on);
    if (model->run.start == LD_START_EQUILIBRIUM && !settle(launch, t, &balance, x, u))
        return false;
    dense_launch_input input;
    dense_state state;
    double tip[8];
    start_input(&balance, u, &input);
    dense_launch_place(&launch->dense, &input, &state);
    dense_launch_tip(&launch->dense, &state, &balance.on.base, tip);
    memcpy(launch->summary->equilibrium.tip_sag, tip, sizeof launch->summary->equilibrium.tip_sag);
    if (launch->on_vehicle) {
        x[launch->platform + VEHICLE_V] = model->base.vehicle.speed;
        for (int i = 0; i < model->base.vehicle.wheel_count; i++)
            x[launch->wheels + WHEEL_STATES * i + WHEEL_V] = model->base.vehicle.speed;
    }
    dense_base base;
    base_at(launch, t, x, &base);
    co_move(&state, &base);
    launch->s = input.s;
    const ld_table *angle = &model->tubes.slot.angle;
    if (model->tubes.slot.kind == LD_SLOT_HELIX && angle->rows > 1)
        for (launch->slot_piece = 1; launch->slot_piece <= (int)angle->rows &&
                                     angle->data[2 * (launch->slot_piece - 1)] <= input.s;)
            launch->slot_piece++;
    launch->locked = model->rocket.lock.present;
    pack(launch, &state, x);
    return true;
}

// ---------------------------------------------------------------- events and summary

// Exit of adaptor i is event i, its touch TOUCH + i; stop k of support i's slide is STOP + 2 i + k.
enum { RELEASE = LD_MAX_ADAPTORS, SLOT_POINT, STOP, TOUCH = STOP + 2 * LD_MAX_SUPPORTS };

// What touch `number` is of: an adaptor, or a surface of a shoe.
static int shoe_of(const launch_run *launch, int number)
{
    return launch->dense.surface_count ? launch->dense.surface[number].shoe : number;
}

static int touch_count(const launch_run *launch)
{
    int surfaces = launch->dense.surface_count;
    return surfaces ? surfaces : launch->model->rocket.adaptor_count;
}

static double penetration_of(const launch_run *launch, const dense_launch_output *output,
                             int number)
{
    return launch->dense.surface_count ? output->surface[number].penetration
                                       : output->contact[number].penetration;
}

static double exit_station(const ld_model *model, int i)
{
    double given = model->rocket.adaptor[i].leaves_at;
    return given > 0 ? given : model->tubes.length;
}

// The first of those that a straight guide lets go with adaptor i.
static int exit_leader(const ld_model *model, int i)
{
    const ld_adaptor *adaptor = model->rocket.adaptor;
    for (int j = 0; j < i; j++) {
        double apart =
            exit_station(model, j) - adaptor[j].at - (exit_station(model, i) - adaptor[i].at);
        if (fabs(apart) < 1e-6)
            return exit_leader(model, j);
    }
    return i;
}

// Positive once the event has happened; negative where it cannot (any more).
static double event(const launch_run *launch, int which, const dense_launch_output *output)
{
    const ld_model *model = launch->model;
    const ld_table *angle = &model->tubes.slot.angle;
    if (which == RELEASE)
        return launch->locked ? output->lock_force - model->rocket.lock.release_force : -1;
    if (which == SLOT_POINT)
        return launch->slot_piece && launch->slot_piece <= (int)angle->rows
                   ? output->s - angle->data[2 * (launch->slot_piece - 1)]
                   : -1;
    if (which >= STOP && which < TOUCH) {
        int support = (which - STOP) / 2, k = (which - STOP) % 2;
        int held = launch->slide_stop[support][k];
        return held ? -held * output->slide_press[support][k] : -1;
    }
    if (which < TOUCH)
        return which < model->rocket.adaptor_count && !launch->passed[which] &&
                       exit_leader(model, which) == which
                   ? output->contact[which].s - exit_station(model, which)
                   : -1;
    int number = which - TOUCH;
    bool latches = model->rocket.contact.law == LD_CONTACT_LANKARANI_NIKRAVESH;
    if (!latches || launch->passed[shoe_of(launch, number)] || !launch->apart[number])
        return -1;
    return penetration_of(launch, output, number);
}

// A step that ends at the first event within it, if there is one (*which; else -1).
static bool step_to_event(launch_run *launch, double t, double *h, const double *x,
                          const double *k1, double *after, double *rate,
                          dense_launch_output *output, int *which,
                          const dense_launch_output *before)
{
    *which = -1;
    if (!take_step(launch, t, *h, x, k1, after, rate, output))
        return false;
    for (int i = 0; i < TOUCH + touch_count(launch); i++) {
        double low = 0, high = *h, f_low = event(launch, i, before),
               f_high = event(launch, i, output);
        if (f_high <= 0)
            continue;
        // false position (Illinois), ending on the side where it has happened
        *which = i;
        for (int k = 0, kept = 0; k < 60 && high - low > 1e-13; k++) {
            double trial = (low * f_high - high * f_low) / (f_high - f_low);
            if (!take_step(launch, t, trial, x, k1, after, rate, output))
                return false;
            double f = event(launch, i, output);
            if (f > 0 || fabs(f) < 1e-12) {
                high = trial;
                f_high = f;
                f_low *= kept == 1 ? 0.5 : 1;
                kept = 1;
            } else {
                low = trial;
                f_low = f;
                f_high *= kept == -1 ? 0.5 : 1;
                kept = -1;
            }
            if (fabs(f) < 1e-12)
                break;
        }
        *h = high;
        if (!take_step(launch, t, high, x, k1, after, rate, output))
            return false;
    }
    return true;
}

static void watch(launch_run *launch, const dense_launch_output *output)
{
    dense_summary *summary = launch->summary;
    for (int i = 0; i < launch->model->rocket.adaptor_count; i++)
        summary->max_contact_force[i] =
            fmax(summary->max_contact_force[i], norm_of(output->contact[i].force, 3));
    for (int i = 0; i < touch_count(launch); i++)
        if (penetration_of(launch, output, i) < -1e-11)
            launch->apart[i] = true;
    summary->max_slot_force = fmax(summary->max_slot_force, fabs(output->slot_force));
    summary->slot_drift = fmax(summary->slot_drift, fabs(output->slot_drift));
    launch->s = output->s;
}

static void note_exit(launch_run *launch, int which, double since)
{
    dense_summary *summary = launch->summary;
    const ld_rocket *rocket = &launch->model->rocket;
    launch->passed[which] = true;
    summary->t_exit[which] = since;
    int ahead = 0;
    for (int i = 0; i < rocket->adaptor_count; i++)
        ahead += rocket->adaptor[i].at > rocket->adaptor[which].at;
    if (ahead == 0)
        summary->t_front = since;
    if (ahead == 1 && rocket->adaptor_count == 3)
        summary->t_middle = since;
    if (which == 0)
        summary->t_rear = since;
}

static void note_event(launch_run *launch, int which, double t, const dense_launch_output *output)
{
    dense_summary *summary = launch->summary;
    const ld_rocket *rocket = &launch->model->rocket;
    double since = t - launch->ignition;
    if (which == RELEASE) {
        launch->locked = false;
        summary->t_release = since;
        return;
    }
    if (which == SLOT_POINT) {
        launch->slot_piece++;
        return;
    }
    if (which >= STOP && which < TOUCH) {
        launch->slide_stop[(which - STOP) / 2][(which - STOP) % 2] *= -1;
        return;
    }
    if (which >= TOUCH) {
        int number = which - TOUCH;
        launch->apart[number] = false;
        if (launch->dense.surface_count)
            launch->surface_touch_speed[number] = output->surface[number].penetration_rate;
        else
            launch->touch_speed[number] = output->contact[number].penetration_rate;
        return;
    }
    // with those that leave with it; all with the rear one
    for (int i = rocket->adaptor_count - 1; i > which; i--)
        if (!launch->passed[i] && (which == 0 || exit_leader(launch->model, i) == which))
            note_exit(launch, i, since);
    note_exit(launch, which, since);
}

static void summarise(launch_run *launch, double t, const double *x,
                      const dense_launch_output *output)
{
    dense_summary *summary = launch->summary;
    dense_state state;
    dense_base base;
    double tip[8], d[3], d_dot[3];
    unpack(launch, x, &state);
    base_at(launch, t, x, &base);
    note_instant(launch, t, x, output, &summary->exit);
    summary->exit_speed = output->s_dot;
    summary->inertial_speed = norm_of(state.v_O1, 3);
    summary->spin_rate = state.w_B[0];
    // axis d = A e_x, d_dot = A (w x e_x)
    for (int i = 0; i < 3; i++) {
        d[i] = state.A_B[i][0];
        d_dot[i] = state.A_B[i][1] * state.w_B[2] - state.A_B[i][2] * state.w_B[1];
    }
    double level = hypot(d[0], d[2]);
    summary->pitch = atan2(d[1], level);
    summary->yaw = atan2(-d[2], d[0]);
    summary->pitch_rate = d_dot[1] / level;
    summary->yaw_rate = (d[2] * d_dot[0] - d[0] * d_dot[2]) / (level * level);
    summary->relative.y = output->y;
    summary->relative.z = output->z;
    summary->relative.psi = output->psi;
    summary->relative.theta = output->theta;
    summary->relative.gamma = output->gamma;
    summary->relative.w_x = output->w_SB[0];
    summary->relative.w_y = output->w_SB[1];
    summary->relative.w_z = output->w_SB[2];
    dense_launch_tip(&launch->dense, &state, &base, tip);
    memcpy(&summary->tip, tip, sizeof tip);
    summary->complete = true;
}

// The next instant at which the equations change by the clock.
static double next_corner(const launch_run *launch, double t)
{
    const ld_motor *motor = &launch->model->rocket.motor;
    double since = t + 1e-12 - launch->ignition;
    double next = launch->ignition + fmin(dense_motor_corner(motor, since),
                                          dense_further_corner(&launch->model->rocket, since));
    const ld_table *pressure = &launch->model->tubes.pressure.over_time;
    for (size_t i = 0; i < pressure->rows; i++)
        if (launch->ignition + pressure->data[2 * i] > t + 1e-12)
            next = fmin(next, launch->ignition + pressure->data[2 * i]);
    if (launch->ignition > t + 1e-12)
        next = fmin(next, launch->ignition);
    const ld_stabiliser *stabiliser[HINGES] = {&launch->model->platform.azimuth.stabiliser,
                                               &launch->model->platform.elevation.stabiliser};
    for (int i = 0; i < HINGES && launch->on_vehicle; i++)
        for (size_t k = 0; k < stabiliser[i]->command.rows; k++) {
            double corner = stabiliser[i]->command.data[2 * k];
            if (corner > t + 1e-12)
                next = fmin(next, corner);
        }
    return next;
}

// Which stops of the slides push at the start.
static bool set_stops(launch_run *launch, double t, const double *x)
{
    double rate[STATE_MAX];
    dense_launch_output output;
    if (!derivative(launch, t, t, x, rate, &output))
        return false;
    for (int i = 0; i < launch->model->tubes.support_count; i++)
        for (int k = 0; k < 2 && launch->model->tubes.support[i].recoil.present; k++)
            launch->slide_stop[i][k] = output.slide_press[i][k] > 0 ? 1 : -1;
    return true;
}

// Runs from t, start state x.
static bool run(launch_run *launch, double t, double *x)
{
    double k1[STATE_MAX] = {0}, after[STATE_MAX] = {0}, rate[STATE_MAX] = {0};
    dense_launch_output before, output;
    double end = launch->ignition + launch->model->run.stuck_time;
    if (!set_stops(launch, t, x))
        return false;
    while (t < end) {
        // pieces between corners, in equal steps; a step that an event cuts starts a new piece
        double corner = fmin(next_corner(launch, t), end);
        int steps = (int)ceil((corner - t) / launch->step - 1e-9), which = -1;
        double from = t, h0 = (corner - t) / steps;
        for (int i = 0; i < steps && which < 0; i++) {
            double h = h0;
            t = from + i * h0;
            if (i == 0 && !derivative(launch, t, t + 0.5 * h, x, k1, &before))
                return false;
            if (event(launch, RELEASE, &before) > 0) {
                note_event(launch, RELEASE, t, &before);
                which = RELEASE;
                break;
            }
            watch(launch, &before);
            if (i == 0 && fabs(t - launch->ignition) < 1e-12)
                note_instant(launch, t, x, &before, &launch->summary->ignition);
            if (!step_to_event(launch, t, &h, x, k1, after, rate, &output, &which, &before))
                return false;
            memcpy(x, after, sizeof after);
            memcpy(k1, rate, sizeof rate);
            before = output;
            t = which < 0 ? from + (i + 1) * h0 : t + h;
            if (which >= 0) {
                watch(launch, &output);
                note_event(launch, which, t, &output);
            }
            if (which == 0) {
                summarise(launch, t, x, &output);
                return true;
            }
        }
    }
    return false;
}

static void prepare(launch_run *launch, const ld_model *model, const flexible_tube *tube,
                    dense_summary *summary)
{
    memset(summary, 0, sizeof *summary);
    launch->model = model;
    launch->summary = summary;
    dense_launch_create(&launch->dense, model, tube);
    launch->rocket = 13 + 2 * launch->dense.mode_count;
    launch->size = launch->rocket + 13;
    launch->ignition = model->firing[0].at;
    launch->on_vehicle = model->base.kind == LD_BASE_VEHICLE;
    if (launch->on_vehicle) {
        dense_vehicle_create(&launch->vehicle, model, model->firing[0].tube, NULL, 0);
        launch->platform = launch->size;
        launch->wheels = launch->platform + VEHICLE_BODY_STATES;
        launch->size = launch->wheels + WHEEL_STATES * model->base.vehicle.wheel_count + 1;
    }
}

static void release(launch_run *launch)
{
    dense_launch_free(&launch->dense);
    if (launch->on_vehicle)
        dense_vehicle_free(&launch->vehicle);
}

bool dense_simulate(const ld_model *model, const flexible_tube *tube, double step,
                    dense_summary *summary)
{
    launch_run launch = {.step = step};
    double x[STATE_MAX] = {0};
    prepare(&launch, model, tube, summary);
    summary->t_release = summary->t_front = summary->t_middle = summary->t_rear = NAN;
    for (int i = 0; i < LD_MAX_ADAPTORS; i++)
        summary->t_exit[i] = NAN;
    double t = -model->run.lead_in;
    bool done = start(&launch, t, x) && run(&launch, t, x);
    release(&launch);
    return done;
}

// ---------------------------------------------------------------- poles

static int by_modulus(const void *a, const void *b)
{
    const dense_pole *p = a, *q = b;
    double d = hypot(p->real, p->imaginary) - hypot(q->real, q->imaginary);
    return (d > 0) - (d < 0);
}

static bool jacobian_of(launch_run *launch, double t, double *x, double *jacobian)
{
    double side[2][STATE_MAX];
    int torque = launch->platform + VEHICLE_Z;
    for (int k = 0; k < launch->size; k++) {
        // contacts are pressed in by micrometres, torques go to 1e4 N m
        double kept = x[k], h = k == torque || k == torque + 1 ? 1 : 1e-7;
        for (int i = 0; i < 2; i++) {
            x[k] = kept + (i == 0 ? -h : h);
            if (!derivative(launch, t, t, x, side[i], NULL))
                return false;
        }
        x[k] = kept;
        for (int i = 0; i < launch->size; i++)
            jacobian[k * launch->size + i] = (side[1][i] - side[0][i]) / (2 * h);
    }
    return true;
}

int dense_poles(const ld_model *model, const flexible_tube *tube, dense_pole *pole, int capacity)
{
    static _Thread_local double jacobian[STATE_MAX * STATE_MAX];
    static _Thread_local dense_summary unused;
    launch_run launch = {0};
    double x[STATE_MAX] = {0}, real[STATE_MAX], imaginary[STATE_MAX], t = -model->run.lead_in;
    int count = 0;
    prepare(&launch, model, tube, &unused);
    bool found = start(&launch, t, x);
    int n = launch.size;
    launch.frictionless = true;
    if (found && jacobian_of(&launch, t, x, jacobian) &&
        LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, jacobian, n, real, imaginary, NULL, 1, NULL,
                      1) == 0)
        for (; count < n && count < capacity; count++)
            pole[count] = (dense_pole){real[count], imaginary[count]};
    release(&launch);
    qsort(pole, (size_t)count, sizeof *pole, by_modulus);
    return count;
}
