#include "simulation/free_flight.h"

#include <math.h>
#include <string.h>

#include "simulation/simulation.h"

enum { EVENT_GROUND, EVENT_APEX, EVENTS };

// The course of the state in the last step: a cubic by values and slopes at its ends, plus
// x^2 (1 - x)^2 (A + B x), x from 0 to 1.
typedef struct step_course {
    bool open; // what follows t and y0 is there
    double t;  // [s] where the step began
    double y0[FLIGHT_STATES];
    double h, y1[FLIGHT_STATES], f0[FLIGHT_STATES], f1[FLIGHT_STATES];
    double A[FLIGHT_STATES], B[FLIGHT_STATES];
} step_course;

typedef struct flight_run {
    const free_flight *job;
    flight_phase phase;
    integrator *integrator;
    ld_flight_summary *flight;
    ld_summary *summary;
    ld_error *error;
    double next_output, last_row, output_from;
    int64_t output_index;
    double next_progress;
    double apogee;
    double fastest, tilted; // largest Mach number and angle of attack
    double t_beyond;        // when the Mach number first went past the table's last; NaN: not
    double t_tumbling;      // when the angle of attack first passed 90 degrees; NaN: not
    double last_time;       // the end of the last step
    step_course step;
    bool landed;
} flight_run;

static int rhs(double t, const double *y, double *y_dot, void *self)
{
    flight_run *run = self;
    flight_rates(run->job->system, &run->phase, t, y, y_dot);
    double sum = 0;
    for (int i = 0; i < run->job->system->states; i++)
        sum += 0 * y_dot[i];
    return sum == 0 ? 0 : -1;
}

static int events(double t, const double *y, double *g, void *self)
{
    flight_run *run = self;
    const flight_system *system = run->job->system;
    double height;
    flight_height(system, &run->phase, t, y, &height, &g[EVENT_APEX]);
    g[EVENT_GROUND] = system->has_ground ? height - system->ground : 1;
    return 0;
}

// Absolute tolerances: what an error of the relative tolerance makes of a kilometre, of ten metres
// a second, of a radian. Places have no relative one: they may be counted from the Earth's centre,
// where a double holds no more than nanometres.
static ld_status make_integrator(flight_run *run)
{
    double tolerance = run->job->model->run.flight_tolerance, atol[FLIGHT_STATES];
    bool absolute[FLIGHT_STATES] = {false};
    for (int i = 0; i < 3; i++) {
        atol[FLIGHT_R + i] = 1e3 * tolerance;
        atol[FLIGHT_V + i] = 10 * tolerance;
        atol[FLIGHT_W + i] = tolerance;
        absolute[FLIGHT_R + i] = absolute[FLIGHT_V + i] = true;
        if (!run->job->system->earth.flat) {
            atol[FLIGHT_R + i] = fmax(atol[FLIGHT_R + i], 1e-8);
            atol[FLIGHT_V + i] = fmax(atol[FLIGHT_V + i], 1e-11);
        }
    }
    for (int i = 0; i < 4; i++)
        atol[FLIGHT_Q + i] = tolerance;
    atol[FLIGHT_ROLL] = 10 * tolerance;
    for (int i = 0; i < 2; i++)
        atol[FLIGHT_XI + i] = tolerance;
    absolute[FLIGHT_ROLL] = absolute[FLIGHT_XI] = absolute[FLIGHT_XI + 1] = true;
    integrator_settings settings = {
        .n = run->job->system->states,
        .method = INTEGRATOR_CASH_KARP,
        .rtol = tolerance,
        .atol = atol,
        .absolute = absolute,
        .rhs = rhs,
        .events = events,
        .event_count = EVENTS,
        .self = run,
    };
    return integrator_create(&settings, &run->integrator, run->error);
}

flight_phase free_flight_phase(const flight_system *system, double t_ignition, double t)
{
    flight_phase phase = {.t_ignition = t_ignition};
    flight_set_piece(system, &phase, motor_piece(&system->motor, t - t_ignition));
    return phase;
}

// ---- between the steps' ends ----

static void course_at(const step_course *step, double x, double *y)
{
    double left = 1 - x, w = x * x * left * left;
    double end = x * x * (3 - 2 * x), slope0 = x * left * left, slope1 = -x * x * left;
    for (int i = 0; i < FLIGHT_STATES; i++)
        y[i] = step->y0[i] + end * (step->y1[i] - step->y0[i]) +
               step->h * (slope0 * step->f0[i] + slope1 * step->f1[i]) +
               w * (step->A[i] + step->B[i] * x);
}

// Before a step is looked into: slopes at its ends, then the two coefficients that take the cubic
// of Hermite to the polynomial of degree 5 whose slopes at 1/3 and 2/3 of the step are those of the
// equations there, twice over (the first time on the cubic).
static void look_into_step(flight_run *run, double t, const double *y)
{
    step_course *step = &run->step;
    double f[2][FLIGHT_STATES], at[FLIGHT_STATES];
    step->h = t - step->t;
    memcpy(step->y1, y, sizeof step->y1);
    memset(step->A, 0, sizeof step->A);
    memset(step->B, 0, sizeof step->B);
    flight_rates(run->job->system, &run->phase, step->t, step->y0, step->f0);
    flight_rates(run->job->system, &run->phase, t, y, step->f1);
    for (int round = 0; round < 2; round++) {
        for (int k = 0; k < 2; k++) {
            double share = (k + 1) / 3.0;
            course_at(step, share, at);
            flight_rates(run->job->system, &run->phase, step->t + share * step->h, at, f[k]);
        }
        for (int i = 0; i < FLIGHT_STATES; i++) {
            // slopes of the cubic at 1/3 and 2/3
            double rise = 4.0 / 3 * (step->y1[i] - step->y0[i]);
            double a = step->h * f[0][i] - (rise - step->h * step->f1[i] / 3);
            double b = step->h * f[1][i] - (rise - step->h * step->f0[i] / 3);
            step->A[i] = -6.75 * a - 13.5 * b;
            step->B[i] = 20.25 * (a + b);
        }
    }
    step->open = true;
}

// ---- rows ----

static ld_status write_row(flight_run *run, double t, const double *y)
{
    const free_flight *job = run->job;
    if (!job->row || t == run->last_row)
        return LD_OK;
    run->last_row = t;
    return job->row(job->self, &run->phase, t, y, run->error);
}

// Rows that fell into the last step.
static ld_status write_rows(flight_run *run, double now, const double *y)
{
    double between[FLIGHT_STATES];
    while (run->job->row && run->next_output < now) {
        double t = run->next_output;
        if (!run->step.open)
            look_into_step(run, now, y);
        course_at(&run->step, (t - run->step.t) / run->step.h, between);
        ld_status status = write_row(run, t, between);
        if (status)
            return status;
        run->next_output = run->output_from +
                           (double)++run->output_index * run->job->model->run.output_step_flight;
    }
    return LD_OK;
}

// ---- watching ----

static void watch(flight_run *run, double t, const double *y)
{
    const flight_system *system = run->job->system;
    flight_flow flow = flight_flow_at(system, t, y);
    double height = flight_center(system, t, y).r.y;
    run->apogee = fmax(run->apogee, height);
    run->fastest = fmax(run->fastest, flow.mach);
    if (flow.airspeed > 0 && flow.density > 0)
        run->tilted = fmax(run->tilted, flow.angle_of_attack);
    if (isnan(run->t_beyond) && system->aerodynamics.present &&
        flow.mach > system->aerodynamics.last_mach)
        run->t_beyond = t;
    if (isnan(run->t_tumbling) && system->aerodynamics.present && flow.density > 0 &&
        flow.airspeed > 10 && flow.angle_of_attack > acos(0))
        run->t_tumbling = t;
}

static ld_status check_table(flight_run *run, double t, const double *y)
{
    const ld_aerodynamics *model = &run->job->model->rocket.aerodynamics;
    if (isnan(run->t_beyond) || model->beyond_table == LD_BEYOND_HOLD)
        return LD_OK;
    v3 r = flight_center(run->job->system, t, y).r;
    flight_flow flow = flight_flow_at(run->job->system, t, y);
    return ld_fail(run->error, LD_ERR_LAUNCH,
                   "the Mach number %.4g is beyond the aerodynamic table, which ends at %.4g, at "
                   "t = %.4f s, x = %.1f m, y = %.1f m, z = %.1f m (beyond_table: hold keeps the "
                   "last values)",
                   flow.mach, run->job->system->aerodynamics.last_mach, t, r.x, r.y, r.z);
}

static ld_status check_limit(flight_run *run, double t)
{
    double limit = run->job->model->run.flight_limit;
    if (isfinite(run->job->t_end) || t < run->job->t_start + limit)
        return LD_OK;
    return ld_fail(run->error, LD_ERR_LAUNCH,
                   "the rocket has not landed within the flight limit of %.6g s", limit);
}

// Every 50 ms of flight; the share by the time that the rocket would need to fall without air.
static ld_status report_progress(flight_run *run, double t, const double *y)
{
    const free_flight *job = run->job;
    if (!job->options || !job->options->progress || t < run->next_progress)
        return LD_OK;
    run->next_progress = t + 0.05;
    earth_motion center = flight_center(job->system, t, y);
    double g = 9.8, left = job->t_end - t;
    if (isinf(left)) {
        double height = fmax(0, center.r.y - job->system->ground);
        left = (center.v.y + sqrt(center.v.y * center.v.y + 2 * g * height)) / g;
    }
    double gone = t - job->t_start, share = gone > 0 ? gone / (gone + left) : 0;
    if (!job->options->progress(job->options->self, share))
        return ld_fail(run->error, LD_ERR_INTERRUPTED, "interrupted at t = %.6g s", t);
    return LD_OK;
}

// ---- the ground ----

// One Runge-Kutta step of the classical kind.
static void small_step(flight_run *run, double t, double h, double *y)
{
    double k[4][FLIGHT_STATES], at[FLIGHT_STATES];
    const double part[4] = {0, 0.5, 0.5, 1};
    int states = run->job->system->states;
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < states; i++)
            at[i] = y[i] + (stage ? part[stage] * h * k[stage - 1][i] : 0);
        flight_rates(run->job->system, &run->phase, t + part[stage] * h, at, k[stage]);
    }
    for (int i = 0; i < states; i++)
        y[i] += h / 6 * (k[0][i] + 2 * (k[1][i] + k[2][i]) + k[3][i]);
}

// The event is found on an interpolated course: from there Newton's method to the ground itself.
static double touch_ground(flight_run *run, double t, double *y)
{
    const flight_system *system = run->job->system;
    for (int i = 0; i < 4; i++) {
        double height, rate;
        flight_height(system, &run->phase, t, y, &height, &rate);
        double h = (system->ground - height) / rate;
        if (!(fabs(h) < 1) || fabs(h) < 1e-14)
            break;
        small_step(run, t, h, y);
        t += h;
    }
    return t;
}

static void record_impact(flight_run *run, double t, const double *y)
{
    const free_flight *job = run->job;
    earth_motion center = flight_center(job->system, t, y);
    ld_flight_summary *flight = run->flight;
    flight->downrange = center.r.x - job->launch_x;
    flight->drift = center.r.z - job->launch_z;
    flight->range = hypot(flight->downrange, flight->drift);
    flight->t_impact = t - job->t_ignition;
    flight->time_of_flight = t - job->t_start;
    flight->impact_speed = v3_norm(center.v);
    flight->impact_angle = atan2(-center.v.y, hypot(center.v.x, center.v.z));
}

static void record_final(const flight_run *run, double t, const double *y, ld_final_state *final)
{
    const flight_system *system = run->job->system;
    const earth *globe = &system->earth;
    flight_pose pose;
    flight_leave(system, &run->phase, t, y, &pose);
    earth_motion center = flight_center(system, t, y);
    m3 A_EI = globe->A_EI, A_IB = q_matrix(pose.q_IB);
    v3 turn = m3_apply_transposed(A_EI, earth_rate(globe)); // of the Earth, in I
    *final = (ld_final_state){.t = t, .earth = !globe->flat};
    v3_store(final->position, pose.r_O1);
    v3_store(final->velocity, pose.v_O1);
    memcpy(final->quaternion, &pose.q_IB, sizeof final->quaternion);
    v3_store(final->rate, v3_sub(pose.w, m3_apply_transposed(A_IB, turn)));
    v3_store(final->center, center.r);
    v3_store(final->center_velocity, center.v);
    v3_store(final->rate_inertial, pose.w);
    if (globe->flat)
        return;
    flight_place place = flight_place_at(system, t, y, A_IB);
    final->latitude = place.geodetic.latitude;
    final->longitude = place.geodetic.longitude;
    final->altitude = place.geodetic.altitude;
    v3_store(final->velocity_ned, place.velocity_ned);
    final->heading = place.heading;
    final->pitch = place.pitch;
    final->roll = place.roll;
}

// ---- the loop ----

// The next instant at which a step must end: a corner of the thrust or of a gust, the end.
static double next_stop(const flight_run *run, double t)
{
    const free_flight *job = run->job;
    const motor *thrust = &job->system->motor;
    double stop = fmin(job->t_end, wind_next_corner(&job->system->wind, t));
    int next = run->phase.piece + 1;
    if (next < (int)thrust->corner_count)
        stop = fmin(stop, job->t_ignition + thrust->t[next]);
    if (isinf(job->t_end))
        stop = fmin(stop, job->t_start + job->model->run.flight_limit);
    return stop;
}

// Corners of the thrust curve at or before t.
static void pass_corners(flight_run *run, double t)
{
    const free_flight *job = run->job;
    const motor *thrust = &job->system->motor;
    int piece = run->phase.piece;
    while (piece + 1 < (int)thrust->corner_count && t >= job->t_ignition + thrust->t[piece + 1])
        piece++;
    if (piece != run->phase.piece)
        flight_set_piece(job->system, &run->phase, piece);
}

static bool is_down(flight_run *run, integrator_outcome outcome, double t, const double *y)
{
    double height, rate;
    if (!run->job->system->has_ground)
        return false;
    flight_height(run->job->system, &run->phase, t, y, &height, &rate);
    if (outcome == INTEGRATOR_EVENT && integrator_event(run->integrator, EVENT_GROUND) < 0)
        return true;
    return height < run->job->system->ground && rate < 0; // began on the ground and fell
}

static ld_status after_step(flight_run *run, integrator_outcome outcome, double *end)
{
    double t = integrator_time(run->integrator);
    memcpy(end, integrator_state(run->integrator),
           (size_t)run->job->system->states * sizeof(double));
    run->landed = is_down(run, outcome, t, end);
    ld_status status = write_rows(run, t, end);
    if (run->landed)
        t = touch_ground(run, t, end);
    watch(run, t, end);
    if (!status)
        status = check_table(run, t, end);
    if (!status && (run->landed || outcome != INTEGRATOR_STEPPED))
        status = write_row(run, t, end);
    if (run->landed)
        record_impact(run, t, end);
    if (!status && !run->landed)
        status = check_limit(run, t);
    if (!status)
        status = report_progress(run, t, end);
    if (!status && outcome != INTEGRATOR_STEPPED && !run->landed) {
        pass_corners(run, t);
        status = integrator_start(run->integrator, t, end, run->error);
    }
    run->last_time = run->step.t = t;
    run->step.open = false;
    memcpy(run->step.y0, end, sizeof run->step.y0);
    return status;
}

static ld_status loop(flight_run *run, double *y)
{
    double t = run->job->t_start;
    while (!run->landed && t < run->job->t_end) {
        integrator_outcome outcome =
            integrator_step(run->integrator, next_stop(run, t), run->error);
        if (outcome == INTEGRATOR_FAILED)
            return LD_ERR_NUMERIC;
        ld_status status = after_step(run, outcome, y);
        t = run->last_time;
        if (status)
            return status;
    }
    return LD_OK;
}

static ld_status begin(flight_run *run, const double *y)
{
    const free_flight *job = run->job;
    double height = flight_center(job->system, job->t_start, y).r.y;
    run->apogee = height;
    run->step.t = job->t_start;
    memcpy(run->step.y0, y, sizeof run->step.y0);
    watch(run, job->t_start, y);
    if (job->system->has_ground && height < job->system->ground)
        return ld_fail(run->error, LD_ERR_LAUNCH,
                       "the flight begins below the ground: the mass centre is at y = %.6g m, the "
                       "ground at %.6g m",
                       height, job->system->ground);
    ld_status status = check_table(run, job->t_start, y);
    if (!status)
        status = make_integrator(run);
    if (!status)
        status = integrator_start(run->integrator, job->t_start, y, run->error);
    return status ? status : write_row(run, job->t_start, y);
}

static void note(flight_run *run)
{
    const double degree = acos(0) / 90;
    if (!isnan(run->t_beyond) &&
        run->job->model->rocket.aerodynamics.beyond_table == LD_BEYOND_HOLD)
        simulation_note(run->summary,
                        "beyond the aerodynamic table (Mach %.4g) from t = %.4f s on, up to Mach "
                        "%.4g: its last values were held",
                        run->job->system->aerodynamics.last_mach, run->t_beyond, run->fastest);
    if (!isnan(run->t_tumbling))
        simulation_note(run->summary,
                        "the rocket flies backwards or tumbles: its angle of attack passed 90 deg "
                        "at t = %.4f s and reached %.1f deg",
                        run->t_tumbling, run->tilted / degree);
}

ld_status free_flight_run(const free_flight *self, double state[FLIGHT_STATES],
                          ld_rocket_summary *rocket, ld_summary *summary, ld_error *error)
{
    flight_run run = {.job = self,
                      .phase = free_flight_phase(self->system, self->t_ignition, self->t_start),
                      .flight = &rocket->flight,
                      .summary = summary,
                      .error = error,
                      .output_from = self->t_start,
                      .output_index = 1,
                      .next_output = self->t_start + self->model->run.output_step_flight,
                      .next_progress = self->t_start,
                      .last_row = NAN,
                      .last_time = self->t_start,
                      .t_beyond = NAN,
                      .t_tumbling = NAN};
    rocket->flown = true;
    double *flight = &rocket->flight.apogee;
    for (size_t i = 0; i < sizeof rocket->flight / sizeof(double); i++)
        flight[i] = NAN;
    ld_status status = begin(&run, state);
    if (!status)
        status = loop(&run, state);
    rocket->flight.apogee = run.apogee;
    rocket->flight.max_mach = run.fastest;
    rocket->flight.max_angle_of_attack = run.tilted;
    record_final(&run, run.last_time, state, &rocket->final);
    note(&run);
    summary->t_end = run.last_time;
    if (run.integrator) {
        summary->statistics.steps += integrator_steps(run.integrator);
        summary->statistics.rhs_evaluations += integrator_evaluations(run.integrator);
        integrator_free(run.integrator);
    }
    return status;
}
