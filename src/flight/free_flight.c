#include "flight/free_flight.h"

#include <string.h>

#include "flight/flight_history.h"
#include "integration/step_limit.h"
#include "math/functions.h"
#include "model/parts.h"
#include "state/simulation.h"
#include "systems/flight/canopy.h"

static void slopes(const double *t, const double *y, double *y_dot, void *self)
{
    flight_run *run = self;
    flight_rates(run->job->system, &run->phase, *t, y, y_dot);
}

// Absolute tolerances: what an error of the relative tolerance makes of a kilometre, of ten metres
// a second, of a radian. Places have no relative one: they may be counted from the Earth's centre,
// where a double holds no more than nanometres.
static void set_tolerances(flight_run *run)
{
    double tolerance = model_run(run->job->model)->flight_tolerance;
    bool flat = run->job->system->earth.flat;
    dormand_prince *steps = &run->steps;
    *steps = (dormand_prince){.f = slopes, .self = run, .count = run->job->system->states};
    for (int i = 0; i < DORMAND_PRINCE_STATES; i++)
        steps->step.absolute[i] = 1;
    for (int i = 0; i < 3; i++) {
        steps->step.absolute[FLIGHT_R + i] = fmax(1e3 * tolerance, flat ? 0 : 1e-8);
        steps->step.absolute[FLIGHT_V + i] = fmax(10 * tolerance, flat ? 0 : 1e-11);
        steps->step.absolute[FLIGHT_W + i] = steps->step.relative[FLIGHT_W + i] = tolerance;
    }
    for (int i = 0; i < 4; i++)
        steps->step.absolute[FLIGHT_Q + i] = steps->step.relative[FLIGHT_Q + i] = tolerance;
    steps->step.absolute[FLIGHT_ROLL] = 10 * tolerance;
    if (run->job->system->turbulence.present)
        steps->step.absolute[FLIGHT_XI] = steps->step.absolute[FLIGHT_XI + 1] = tolerance;
}

flight_phase free_flight_phase(const flight_system *system, double t_ignition, double t)
{
    flight_phase phase = {.t_ignition = t_ignition, .lowest_trigger = -INFINITY};
    flight_set_piece(system, &phase, motor_piece(&system->motor, t - t_ignition));
    return phase;
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

// Rows within the last step, before t.
static ld_status write_rows(flight_run *run, double t)
{
    double between[DORMAND_PRINCE_STATES];
    while (run->job->row && run->next_output < t) {
        dormand_prince_between(&run->steps, run->next_output, between);
        ld_status status = write_row(run, run->next_output, between);
        if (status)
            return status;
        run->next_output = run->output_from + (double)++run->output_index *
                                                  model_run(run->job->model)->output_step_flight;
    }
    return LD_OK;
}

// ---- watching ----

// The last step as its watch sees it.
static flight_step ends_of(flight_run *run)
{
    dormand_prince_numbers *step = &run->steps.step;
    return (flight_step){.done = &step->outcome,
                         .t0 = &step->t0,
                         .t = &step->t,
                         .y0 = step->y0,
                         .y0_dot = step->k[0],
                         .y = step->y,
                         .y_dot = step->k[DORMAND_PRINCE_STAGES - 1],
                         .extremes = (double *)&run->extremes};
}

static flight_flow flow_at(flight_run *run, double t)
{
    double y[DORMAND_PRINCE_STATES];
    dormand_prince_between(&run->steps, t, y);
    return flight_flow_at(run->job->system, t, y);
}

// At t within the last step.
static double mach_at(flight_run *run, double t)
{
    return flow_at(run, t).mach;
}

static double dynamic_pressure_at(flight_run *run, double t)
{
    return flow_at(run, t).pressure;
}

// When something is greatest within the last step, by golden sections.
static double greatest_instant(flight_run *run, double (*value_at)(flight_run *run, double t))
{
    double a = run->steps.step.t0, b = run->steps.step.t, share = (sqrt(5) - 1) / 2;
    double c = b - share * (b - a), d = a + share * (b - a);
    double at_c = value_at(run, c), at_d = value_at(run, d);
    for (int i = 0; i < 25; i++) {
        bool left = at_c > at_d;
        *(left ? &b : &a) = left ? d : c;
        *(left ? &d : &c) = left ? c : d;
        *(left ? &at_d : &at_c) = left ? at_c : at_d;
        *(left ? &c : &d) = left ? b - share * (b - a) : a + share * (b - a);
        *(left ? &at_c : &at_d) = value_at(run, left ? c : d);
    }
    return c;
}

// When the Mach number is greatest within the last step; NaN: it has been greater.
static double fastest_instant(flight_run *run, double mach)
{
    const dormand_prince_numbers *step = &run->steps.step;
    const flight_system *system = run->job->system;
    if (flight_speeds_up(system, step->y0, step->k[0]) &&
        !flight_speeds_up(system, step->y, step->k[6]))
        return greatest_instant(run, mach_at);
    return mach >= run->extremes.mach ? step->t : NAN;
}

static void watch_pressure(flight_run *run, const flight_flow *flow)
{
    flight_extremes *most = &run->extremes;
    const dormand_prince_numbers *step = &run->steps.step;
    const flight_step ends = ends_of(run);
    double pressure = flow->pressure, t = step->t;
    // again: what the extremes have of it may be of the end already
    const double density[] = {flight_flow_at(run->job->system, step->t0, step->y0).density,
                              flow->density};
    if (flight_pressure_turns(run->job->system, &ends, density, pressure)) {
        t = greatest_instant(run, dynamic_pressure_at);
        pressure = dynamic_pressure_at(run, t);
    }
    if (pressure > most->pressure) {
        most->pressure = pressure;
        most->t_pressure = t;
    }
    most->density = flow->density;
}

static void watch_acceleration(flight_run *run)
{
    const dormand_prince_numbers *step = &run->steps.step;
    flight_extremes *most = &run->extremes;
    v3 a = v3_from(step->k[DORMAND_PRINCE_STAGES - 1] + FLIGHT_V);
    if (v3_dot(a, a) > most->acceleration) {
        most->acceleration = v3_dot(a, a);
        most->t_acceleration = step->t;
    }
}

// When the Mach number went past the table's last, between the step's begin and t.
static double beyond_instant(flight_run *run, double t)
{
    double a = run->steps.step.t0, b = t, last = run->job->system->aerodynamics.last_mach;
    for (int i = 0; i < 50 && b > a; i++) {
        double middle = 0.5 * (a + b);
        *(mach_at(run, middle) > last ? &b : &a) = middle;
    }
    return b;
}

static void take_height(flight_run *run, double t, const double *y)
{
    double height = flight_height(run->job->system, y);
    if (height > run->apogee) {
        run->apogee = height;
        run->t_apogee = t;
    }
}

static void watch_extremes(flight_run *run, double t, const double *y)
{
    const flight_system *system = run->job->system;
    flight_extremes *most = &run->extremes;
    flight_flow flow = flight_flow_at(system, t, y);
    take_height(run, t, y);
    watch_pressure(run, &flow);
    watch_acceleration(run);
    bool in_air = flow.density > 0 && !run->phase.hangs && !run->phase.canopy.given;
    if (flow.airspeed > 0 && in_air && flow.across * most->along > flow.along * most->across) {
        most->across = flow.across;
        most->along = flow.along;
    }
    if (isnan(run->t_tumbling) && system->aerodynamics.present && in_air && flow.airspeed > 10 &&
        flow.along < 0)
        run->t_tumbling = t;
    double t_fastest = fastest_instant(run, flow.mach);
    if (isnan(t_fastest))
        return;
    most->mach = fmax(most->mach, t_fastest == t ? flow.mach : mach_at(run, t_fastest));
    if (isnan(run->t_beyond) && system->aerodynamics.present &&
        most->mach > system->aerodynamics.last_mach)
        run->t_beyond = beyond_instant(run, t_fastest);
}

static ld_status check_table(flight_run *run)
{
    const ld_aerodynamics *model = &run->job->system->rocket->aerodynamics;
    double t = run->t_beyond, y[DORMAND_PRINCE_STATES];
    if (isnan(t) || model->beyond_table == LD_BEYOND_HOLD)
        return LD_OK;
    dormand_prince_between(&run->steps, t, y);
    v3 r = flight_center(run->job->system, t, y).r;
    return ld_fail(run->error, LD_ERR_LAUNCH,
                   "%s: ends at Mach %.4g; the rocket exceeds it at t = %.4f s, x = %.1f m, y = "
                   "%.1f m, z = %.1f m (`beyond_table: hold` keeps the last values)",
                   run->job->system->aerodynamics.last_of, run->job->system->aerodynamics.last_mach,
                   t, r.x, r.y, r.z);
}

static ld_status check_limit(flight_run *run, double t)
{
    double limit = model_run(run->job->model)->flight_limit;
    if (isfinite(run->job->t_end) || t < run->t_limit)
        return LD_OK;
    return ld_fail(run->error, LD_ERR_LAUNCH,
                   model_run(run->job->model)->end == LD_END_APOGEE
                       ? "the rocket has not reached its apogee within the flight limit of %.6g s"
                       : "the rocket has not landed within the flight limit of %.6g s",
                   limit);
}

// Every 50 ms of flight; the share by the time that the rocket would need to fall without air.
static ld_status report_progress(flight_run *run, double t, const double *y)
{
    const free_flight *job = run->job;
    if (!job->options || !job->options->progress || t < run->next_progress)
        return LD_OK;
    run->next_progress = t + 0.05;
    double g = 9.8, left = job->t_end - t;
    if (isinf(left)) {
        double height = fmax(0, flight_height(job->system, y) - job->system->ground);
        double rate = flight_height_rate(job->system, &run->phase, t, y);
        left = (rate + sqrt(rate * rate + 2 * g * height)) / g;
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
    double k[4][FLIGHT_ALL_STATES] = {0}, at[FLIGHT_ALL_STATES];
    const double part[4] = {0, 0.5, 0.5, 1};
    const flight_system *system = run->job->system;
    int states = system->canopies || system->own_filling ? FLIGHT_ALL_STATES : system->states;
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < states; i++)
            at[i] = y[i] + (stage ? part[stage] * h * k[stage - 1][i] : 0);
        flight_rates(system, &run->phase, t + part[stage] * h, at, k[stage]);
    }
    for (int i = 0; i < states; i++)
        y[i] += h / 6 * (k[0][i] + 2 * (k[1][i] + k[2][i]) + k[3][i]);
}

// The event is found on an interpolated course: from there Newton's method to the ground itself.
static double touch_ground(flight_run *run, double t, double *y)
{
    const flight_system *system = run->job->system;
    for (int i = 0; i < 4; i++) {
        double rate = flight_height_rate(system, &run->phase, t, y);
        double h = (system->ground - flight_height(system, y)) / rate;
        if (!(fabs(h) < 0.01) || fabs(h) < 1e-14)
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
    ld_flight_summary *flight = &run->rocket->flight;
    flight->downrange = center.r.x - job->launch_x;
    flight->drift = center.r.z - job->launch_z;
    flight->range = hypot(flight->downrange, flight->drift);
    flight->t_impact = t - job->t_ignition;
    flight->time_of_flight = t - job->t_start;
    flight->impact_speed = v3_norm(center.v);
    v3 v = center.v; // ahead, up, to the side
    if (!job->system->earth.flat) {
        v3 ned = flight_place_at(job->system, t, y, m3_identity()).velocity_ned;
        v = v3_make(ned.x, -ned.z, ned.y);
    }
    flight->impact_angle = atan2(-v.y, hypot(v.x, v.z));
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

// ---- measures ----

static void find_row(void *self, double t, double *row)
{
    flight_run *run = self;
    double y[DORMAND_PRINCE_STATES];
    dormand_prince_between(&run->steps, t, y);
    flight_row(run->job->system, &run->columns, &run->phase, t, y, row);
}

static bool has_come(void *self, measure_instant instant)
{
    const flight_run *run = self;
    switch (instant.kind) {
    case INSTANT_BURNOUT:
        return run->burnt_out;
    case INSTANT_APOGEE:
        return run->past_apex;
    case INSTANT_IMPACT:
        return run->landed;
    default: // it flies; its end: measuring_end
        return instant.kind != INSTANT_END;
    }
}

static measuring measuring_of(flight_run *run)
{
    return (measuring){
        .plans = run->job->measure,
        .flight = true,
        .window = run->window,
        .result = run->rocket->measure,
        .row = find_row,
        .has_come = has_come,
        .self = run,
    };
}

static void measure_now(flight_run *run, double t, const double *y)
{
    const measuring self = measuring_of(run);
    double now[FLIGHT_MAX_COLUMNS];
    if (!measuring_is_there(&self))
        return;
    flight_row(run->job->system, &run->columns, &run->phase, t, y, now);
    measuring_instant(&self, t, now);
}

// The last step, the apex in it (NaN: none), before what happens at its end.
static void measure_step(flight_run *run, double apex)
{
    const measuring self = measuring_of(run);
    double from = run->steps.step.t0, y[DORMAND_PRINCE_STATES], end[FLIGHT_MAX_COLUMNS];
    if (!measuring_is_there(&self))
        return;
    if (!isnan(apex) && !run->past_apex) {
        dormand_prince_between(&run->steps, apex, y);
        find_row(run, apex, end);
        measuring_step(&self, from, apex, end);
        run->past_apex = true;
        measure_now(run, apex, y);
        from = apex;
    }
    flight_row(run->job->system, &run->columns, &run->phase, run->steps.step.t, run->steps.step.y,
               end);
    measuring_step(&self, from, run->steps.step.t, end);
}

// ---- events within a step ----

// Where the height goes through `level` between a and b, or its rate through zero where that is
// NaN: the method of false position as Illinois has it.
static double crossing(flight_run *run, double level, double a, double b)
{
    double f[3], t[3] = {a, b, b};
    for (int i = 0; i < 60; i++) {
        // of the first two the ends, then a new point between them
        for (int k = i ? 2 : 0; k < (i ? 3 : 2); k++) {
            const flight_system *system = run->job->system;
            double y[DORMAND_PRINCE_STATES];
            dormand_prince_between(&run->steps, t[k], y);
            f[k] = isnan(level) ? flight_height_rate(system, &run->phase, t[k], y)
                                : flight_height(system, y) - level;
        }
        if (i) {
            bool other = f[2] * f[1] < 0;
            t[0] = other ? t[1] : t[0];
            f[0] = other ? f[1] : 0.5 * f[0];
            t[1] = t[2];
            f[1] = f[2];
        }
        if (f[1] == 0 || f[0] == f[1] || fabs(t[1] - t[0]) < 1e-13 * (1 + fabs(t[1])))
            break;
        t[2] = t[1] - f[1] * (t[1] - t[0]) / (f[1] - f[0]);
    }
    return t[1];
}

// The highest point within the last step, NaN without.
static double find_apex(flight_run *run)
{
    const flight_system *system = run->job->system;
    const dormand_prince *steps = &run->steps;
    double before = flight_height_rate(system, &run->phase, steps->step.t0, steps->step.y0);
    double after = flight_height_rate(system, &run->phase, steps->step.t, steps->step.y);
    // a step that ended there is not to be found again
    bool passed = steps->step.t0 == run->t_topped;
    return before > 0 && after < 0 && !passed ? crossing(run, NAN, steps->step.t0, steps->step.t)
                                              : NAN;
}

// Ends the last step on the ground if it went through; apex: of the same step.
static bool end_on_ground(flight_run *run, double apex)
{
    const flight_system *system = run->job->system;
    dormand_prince *steps = &run->steps;
    double y[DORMAND_PRINCE_STATES];
    if (!system->has_ground || flight_height(system, steps->step.y) > system->ground ||
        flight_height_rate(system, &run->phase, steps->step.t, steps->step.y) > 0)
        return false;
    double t = crossing(run, system->ground, isnan(apex) ? steps->step.t0 : apex, steps->step.t);
    dormand_prince_retake(steps, t);
    memcpy(y, steps->step.y, sizeof y);
    t = touch_ground(run, t, y);
    memcpy(steps->step.y, y, sizeof y);
    steps->step.t = t;
    return true;
}

// ---- parachutes ----

static int parachutes_of(const flight_run *run)
{
    return run->job->system->rocket->parachute_count;
}

static double height_of_trigger(const flight_run *run, int i)
{
    return run->job->system->ground + run->job->system->rocket->parachute[i].height;
}

// The highest of the heights on which a trigger waits is checked.
static void watch_triggers(flight_run *run)
{
    flight_phase *phase = &run->phase;
    double level = -INFINITY;
    for (int i = 0; i < parachutes_of(run); i++)
        if (isnan(run->t_open[i]) &&
            run->job->system->rocket->parachute[i].trigger == LD_TRIGGER_HEIGHT)
            level = fmax(level, height_of_trigger(run, i));
    if (level == phase->lowest_trigger)
        return;
    phase->lowest_trigger = level;
    flight_set_piece(run->job->system, phase, phase->piece);
}

// When parachute i is triggered in the last step, with the apex in it (NaN: none); NaN: not.
static double trigger_in_step(flight_run *run, int i, double apex)
{
    const flight_system *system = run->job->system;
    const dormand_prince_numbers *step = &run->steps.step;
    const ld_parachute *one = &system->rocket->parachute[i];
    if (!isnan(run->t_open[i]) || one->trigger == LD_TRIGGER_TIME)
        return NAN;
    if (one->trigger == LD_TRIGGER_APOGEE)
        return apex;
    double from = step->t0, level = height_of_trigger(run, i);
    double between[DORMAND_PRINCE_STATES];
    const double *y = step->y0;
    if (!isnan(apex)) {
        from = apex;
        y = between;
        dormand_prince_between(&run->steps, apex, between);
    }
    // what is so little below it may be an end that was cut short
    if (flight_height(system, y) < level - 1e-6)
        return apex;
    bool falls_through = flight_height(system, step->y) <= level;
    return falls_through ? fmax(from, crossing(run, level, from, step->t)) : NAN;
}

// The next instant at which one opens or is full.
static double next_opening(const flight_run *run)
{
    double t = run->t_full;
    for (int i = 0; i < parachutes_of(run); i++)
        if (!run->opened[i])
            t = fmin(t, run->t_open[i]); // which leaves NaN out
    return t;
}

// Triggers in the last step; where one of the parachutes opens within it, or the flight ends at its
// highest point, the step ends there.
static bool cut_step(flight_run *run, double *apex)
{
    const ld_parachute *parachute = run->job->system->rocket->parachute;
    double t[LD_MAX_PARACHUTES], end = run->steps.step.t;
    bool to_apex = model_run(run->job->model)->end == LD_END_APOGEE && !isnan(*apex);
    double cut = to_apex ? *apex : end;
    for (int i = 0; i < parachutes_of(run); i++) {
        t[i] = trigger_in_step(run, i, *apex);
        if (t[i] + parachute[i].lag < cut)
            cut = t[i] + parachute[i].lag;
    }
    for (int i = 0; i < parachutes_of(run); i++)
        if (t[i] <= cut)
            run->t_open[i] = t[i] + parachute[i].lag;
    if (*apex > cut)
        *apex = NAN;
    run->topped = to_apex && *apex == cut;
    run->t_topped = *apex == cut ? cut : run->t_topped;
    watch_triggers(run);
    if (cut < end)
        dormand_prince_retake(&run->steps, cut);
    return run->topped || next_opening(run) <= cut;
}

// It begins to fill where its lines are taut.
static void put_canopy_out(flight_run *run, int i, double t, double *y)
{
    const flight_system *system = run->job->system;
    const ld_parachute *one = &system->rocket->parachute[i];
    canopy_open(system, &run->phase, i, t, y);
    flight_hang(system, &run->phase, t, one->canopy.packed_area);
    run->canopy = i;
    run->descent = descent_none();
    run->t_full = INFINITY;
    run->area = one->drag_area;
    run->opened[i] = true;
}

// The rocket, which hangs below parachute i from now on, does not turn.
static void hang_below(flight_run *run, int i, double t, double *y)
{
    const ld_parachute *one = &run->job->system->rocket->parachute[i];
    run->t_full = flight_fill(run->job->system, &run->phase, t, y, i);
    run->area = one->drag_area;
    run->opened[i] = true;
    for (int k = 0; k < 3; k++)
        y[FLIGHT_W + k] = 0;
}

static void open_parachute(flight_run *run, int i, double t, double *y)
{
    const flight_system *system = run->job->system;
    const ld_parachute *one = &system->rocket->parachute[i];
    ld_parachute_summary *opened = &run->rocket->parachute[i];
    *opened = (ld_parachute_summary){t - run->job->t_ignition,
                                     flight_height(system, y),
                                     flight_flow_at(system, t, y).airspeed,
                                     NAN,
                                     NAN,
                                     NAN,
                                     NAN};
    if (system->has_ground)
        opened->height -= system->ground;
    bool opens_first = !run->phase.hangs && !run->phase.canopy.given;
    if (run->phase.burning && opens_first)
        summary_note(
            run->summary,
            "parachute %s opened at t = %.4f s while the motor was burning: the thrust ends there",
            one->name, t);
    if (!opens_first && one->drag_area < run->area)
        summary_note(run->summary,
                     "parachute %s of %.4g m2, opened at t = %.4f s, replaced one of %.4g m2: the "
                     "drag falls",
                     one->name, one->drag_area, t, run->area);
    if (system->canopies || system->own_filling)
        descent_set_tolerances(system, &run->steps, model_run(run->job->model)->flight_tolerance);
    if (one->canopy.present)
        put_canopy_out(run, i, t, y);
    else
        hang_below(run, i, t, y);
}

// The lines become taut or slack; the first time the canopy begins to fill.
static void switch_lines(flight_run *run)
{
    dormand_prince_numbers *step = &run->steps.step;
    flight_phase *phase = &run->phase;
    canopy_switch(phase, !phase->canopy.taut);
    if (phase->canopy.taut && !run->descent.filling) {
        run->descent.filling = true;
        run->rocket->parachute[run->canopy].t_taut = step->t - run->job->t_ignition;
        run->t_full = flight_fill(run->job->system, phase, step->t, step->y, run->canopy);
    }
    run->descent.t_switch = NAN;
    dormand_prince_start(&run->steps, step->t, step->y);
    watch_acceleration(run);
}

static void note_loads(flight_run *run)
{
    for (int i = 0; i < parachutes_of(run); i++) {
        const ld_parachute *one = &run->job->system->rocket->parachute[i];
        const ld_parachute_summary *of = &run->rocket->parachute[i];
        if (one->canopy.present && of->greatest_force > one->canopy.strength)
            summary_note(run->summary,
                         "parachute %s: its lines carry %.4g N at t = %.4f s, more than their "
                         "strength of %.4g N",
                         one->name, of->greatest_force, of->t_greatest_force + run->job->t_ignition,
                         one->canopy.strength);
    }
}

// Parachutes that open at or before t, and one that is full; true where there was one.
static bool pass_parachutes(flight_run *run, double t, double *y)
{
    bool passed = t >= run->t_full;
    if (passed) {
        flight_hang(run->job->system, &run->phase, t, run->area);
        run->t_full = INFINITY;
    }
    for (int i = 0; i < parachutes_of(run); i++)
        if (!run->opened[i] && t >= run->t_open[i]) {
            open_parachute(run, i, t, y);
            passed = true;
        }
    return passed;
}

// Those of a time are known, that of a rocket still in its tube comes at its exit.
static void set_triggers(flight_run *run)
{
    const free_flight *job = run->job;
    for (int i = 0; i < parachutes_of(run); i++) {
        const ld_parachute *one = &job->system->rocket->parachute[i];
        run->t_open[i] = one->trigger == LD_TRIGGER_TIME
                             ? fmax(job->t_start, job->t_ignition + one->time + one->lag)
                             : NAN;
    }
    watch_triggers(run);
}

static void note_closed(flight_run *run)
{
    for (int i = 0; i < parachutes_of(run); i++)
        if (!run->opened[i])
            summary_note(run->summary, "parachute %s did not open before the rocket landed",
                         run->job->system->rocket->parachute[i].name);
}

// ---- the line ----

static moving_air air_of_line(const void *self, double t, v3 r)
{
    return flight_steady_air_at(self, t, r);
}

// Its bridle now, as the rates of the last step's end have it.
static line_bridle bridle_now(const flight_run *run)
{
    const dormand_prince_numbers *step = &run->steps.step;
    return flight_point(run->job->system, &run->phase, step->t, step->y,
                        step->k[DORMAND_PRINCE_STAGES - 1],
                        v3_from(run->job->system->rocket->line.bridle));
}

static ld_status begin_line(flight_run *run)
{
    const free_flight *job = run->job;
    const ld_line *given = &job->system->rocket->line;
    const line_setting setting = {
        .given = given,
        .container = job->container,
        .gravity = earth_gravity(&job->system->earth, v3_zero()),
        .ground = job->system->has_ground ? job->system->ground : -INFINITY,
        .air = job->system->atmosphere.kind == LD_ATMOSPHERE_NONE ? NULL : air_of_line,
        .self = job->system,
        .carried = job->carried,
        .carrier = job->carrier};
    line_bridle bridle = bridle_now(run);
    double distance = v3_norm(v3_sub(bridle.r, setting.container));
    bool broken = job->broken.paid > 0;
    if (distance > given->length && !broken)
        return ld_fail(run->error, LD_ERR_LAUNCH,
                       "rocket.line.container: the flight begins %.6g m away from it, the line is "
                       "%.6g m long",
                       distance, given->length);
    run->line = broken ? line_create_broken(&setting, job->t_start, &job->broken)
                       : line_create(&setting, job->t_start, &bridle);
    if (!run->line)
        return ld_fail(run->error, LD_ERR_MEMORY, "no memory for a line");
    run->phase.line = run->line;
    return LD_OK;
}

// The line goes ahead of the rocket by up to a step, with the bridle as it is predicted; its force
// then acts on the rocket over that time.
static void step_line(flight_run *run)
{
    dormand_prince *steps = &run->steps;
    if (steps->step.t < run->line->t)
        return;
    line_bridle bridle = bridle_now(run);
    double to = fmin(steps->step.t_stop, steps->step.t + line_step(run->line));
    line_advance(run->line, to, &bridle);
    dormand_prince_start(steps, steps->step.t, steps->step.y);
}

// After a landing the line falls until it lies, or hangs from its container, which stays there.
static void lay_line(flight_run *run)
{
    const double longest = 120; // [s]
    line_bridle bridle = bridle_now(run);
    bridle.v = bridle.a = v3_zero();
    double until = run->line->t + longest;
    line_hold_still(run->line);
    while (!line_rests(run->line) && run->line->t < until)
        line_advance(run->line, run->line->t + line_step(run->line), &bridle);
}

static void record_line(flight_run *run)
{
    const flight_line *line = run->line;
    const ld_line *given = line->setting.given;
    double ignition = run->job->t_ignition;
    v3 bridle = bridle_now(run).r;
    ld_line_summary *out = &run->rocket->line;
    *out = (ld_line_summary){.greatest_tension = line->greatest,
                             .t_greatest_tension = line->t_greatest - ignition,
                             .paid_out = line->paid,
                             .remaining = fmax(0, given->length - line->paid),
                             .t_end = line->t_ended - ignition,
                             .t_break = line->t_broke - ignition,
                             .broken_at = line->broke_at,
                             .reach = line_reach(line, bridle),
                             .t_rest = run->landed && line_rests(line) ? line->t - ignition : NAN};
    v3_store(out->broken, line->broke);
    for (int i = 0; i < LD_LINE_PLACES; i++) {
        v3 r = line_place(line, line->t, bridle, (double)i / (LD_LINE_PLACES - 1));
        out->place[i].x = r.x;
        out->place[i].y = r.y;
        out->place[i].z = r.z;
    }
    if (line->cut >= 0 && !(run->job->broken.paid > 0))
        summary_note(run->summary,
                     "the line broke at t = %.4f s, %.4g m from the rocket, at x = %.1f m, y = "
                     "%.1f m, z = %.1f m",
                     line->t_broke, line->broke_at, line->broke.x, line->broke.y, line->broke.z);
}

static void end_line(flight_run *run, ld_status status)
{
    if (!run->line)
        return;
    if (!status && run->landed)
        lay_line(run);
    record_line(run);
    line_free(run->line);
    run->line = NULL;
    run->phase.line = NULL;
}

// ---- the loop ----

// The next row of the brakes' schedule, from ignition, that lies after t by the run's clock.
static double next_brake_row(const flight_run *run, double t)
{
    const free_flight *job = run->job;
    double row = flight_next_brake_row(job->system, t - job->t_ignition);
    while (job->t_ignition + row <= t)
        row = flight_next_brake_row(job->system, row);
    return row;
}

// The next instant at which a step must end: a corner of the thrust or of a gust, the end.
static double next_stop(const flight_run *run)
{
    double t = run->steps.step.t;
    const free_flight *job = run->job;
    const motor *thrust = &job->system->motor;
    double stop = fmin(job->t_end, wind_next_corner(&job->system->wind, t));
    int next = run->phase.piece + 1;
    if (next < (int)thrust->corner_count)
        stop = fmin(stop, job->t_ignition + thrust->t[next]);
    stop = fmin(stop, job->t_ignition + next_brake_row(run, t));
    stop = fmin(stop, next_opening(run));
    return fmin(stop, isinf(job->t_end) ? run->t_limit : INFINITY);
}

// Corners of the thrust curve at or before t; true where there was one.
static bool pass_corners(flight_run *run, double t)
{
    const free_flight *job = run->job;
    const motor *thrust = &job->system->motor;
    int piece = run->phase.piece;
    while (piece + 1 < (int)thrust->corner_count && t >= job->t_ignition + thrust->t[piece + 1])
        piece++;
    if (piece == run->phase.piece)
        return false;
    bool burning = run->phase.burning;
    flight_set_piece(job->system, &run->phase, piece);
    run->burnt_out |= burning && !run->phase.burning;
    return true;
}

// What changes the equations at or before t; true where there was something.
static bool pass_events(flight_run *run, double t, double *y)
{
    bool corner = pass_corners(run, t);
    return pass_parachutes(run, t, y) || corner;
}

static ld_status after_step(flight_run *run, double apex, bool stopped)
{
    const dormand_prince *steps = &run->steps;
    ld_status status = LD_OK;
    // the step as it was, until the ground ends it
    if (!isnan(apex)) {
        double y[DORMAND_PRINCE_STATES];
        dormand_prince_between(&run->steps, apex, y);
        take_height(run, apex, y);
        status = write_rows(run, apex);
        if (!status)
            status = write_row(run, apex, y);
    }
    run->landed = end_on_ground(run, apex);
    if (run->phase.canopy.given)
        descent_watch(&run->descent, &run->phase, &run->steps, run->job->t_ignition,
                      &run->rocket->parachute[run->canopy]);
    measure_step(run, apex);
    if (!status)
        status = write_rows(run, steps->step.t);
    watch_extremes(run, steps->step.t, steps->step.y);
    if (!status)
        status = check_table(run);
    if (!status && (run->landed || stopped))
        status = write_row(run, steps->step.t, steps->step.y);
    if (run->landed)
        record_impact(run, steps->step.t, steps->step.y);
    else if (!status)
        status = check_limit(run, steps->step.t);
    return status ? status : report_progress(run, steps->step.t, steps->step.y);
}

// A flight whose steps are so short hardly continues.
static ld_status check_steps(const flight_run *run)
{
    const dormand_prince *steps = &run->steps;
    double spent = steps->step.t - run->job->t_start;
    double least =
        least_step(model_run(run->job->model)->flight_tolerance, 1e-7, 5e-5, steps->step.steps);
    if (steps->step.steps < 1000 || spent >= least * steps->step.steps)
        return LD_OK;
    return ld_fail(run->error, LD_ERR_NUMERIC,
                   "the flight's steps are too short to continue: %lld steps for %.6g s, up to t = "
                   "%.9g s; check aerodynamics and inertia",
                   (long long)steps->step.steps, spent, steps->step.t);
}

bool flight_run_continues(const flight_run *run)
{
    return !run->landed && !run->topped && run->steps.step.t < run->job->t_end;
}

// Where every row is asked for, or something is measured, all steps are checked.
static void set_next(flight_run *run)
{
    enum { UNSEEN = 64 }; // steps between looks without a reason
    const measuring measured = measuring_of(run);
    bool all = run->job->row || measuring_is_there(&measured);
    run->next_check = run->steps.step.steps + (all ? 1 : UNSEEN);
    run->steps.step.t_stop = next_stop(run);
}

// Begins the next step where the last one has stopped, past what changes the equations there.
static void pass_stop(flight_run *run)
{
    dormand_prince *steps = &run->steps;
    if (!pass_events(run, steps->step.t, steps->step.y))
        return;
    dormand_prince_start(steps, steps->step.t, steps->step.y);
    watch_acceleration(run); // beyond the corner, too
}

// Whether the last step, of which flight_watch has said nothing, ended at its stop within the
// flight, and nothing else is asked of it.
static bool is_plain_stop(const flight_run *run)
{
    const dormand_prince_numbers *step = &run->steps.step;
    double t = step->t;
    return step->outcome == DORMAND_PRINCE_DONE && t == step->t_stop && !run->job->row &&
           run->job->measure->count == 0 && t < run->t_limit && t < run->job->t_end;
}

ld_status flight_run_examine(flight_run *run, bool seen)
{
    dormand_prince *steps = &run->steps;
    if (!seen && is_plain_stop(run)) {
        take_height(run, steps->step.t, steps->step.y);
        ld_status status = report_progress(run, steps->step.t, steps->step.y);
        if (!status)
            status = check_steps(run);
        if (status)
            return status;
        pass_stop(run);
        set_next(run);
        return LD_OK;
    }
    if (steps->step.outcome == DORMAND_PRINCE_LOST)
        return ld_fail(run->error, LD_ERR_NUMERIC,
                       "the equations of flight gave no finite result, or the step size fell to 0, "
                       "at t = %.9g s",
                       steps->step.t);
    double apex = find_apex(run);
    bool cut = cut_step(run, &apex), stopped = cut || steps->step.t == steps->step.t_stop;
    ld_status status = after_step(run, apex, stopped);
    if (!status)
        status = check_steps(run);
    if (status)
        return status;
    if (stopped && !run->landed)
        pass_stop(run);
    if (stopped || run->landed)
        measure_now(run, steps->step.t, steps->step.y);
    set_next(run);
    return LD_OK;
}

// After a step below a canopy, or what fills by its way, which may end where its lines become taut
// or slack, or it is full; it may end even earlier.
static ld_status end_step_below(flight_run *run)
{
    int canopy = run->canopy;
    descent_locate(&run->descent, &run->phase, &run->steps);
    if (run->phase.filling.by_way)
        run->t_full = fmin(INFINITY, run->descent.t_full); // which leaves NaN out
    ld_status status = flight_run_examine(run, true);
    if (!status && run->canopy == canopy && run->steps.step.t == run->descent.t_switch &&
        flight_run_continues(run)) {
        switch_lines(run);
        set_next(run);
    }
    return status;
}

ld_status flight_run_step(flight_run *run)
{
    dormand_prince_numbers *step = &run->steps.step;
    double stop = step->t_stop, most = stop;
    if (run->line) {
        step_line(run);
        most = fmin(stop, run->line->t);
    }
    if (run->phase.canopy.given)
        most = fmin(most, descent_stop(&run->phase, &run->steps));
    dormand_prince_step(&run->steps, most);
    step->t_stop = stop;
    if (run->phase.canopy.given || run->phase.filling.by_way)
        return end_step_below(run);
    const flight_step ends = ends_of(run);
    bool seen = flight_watch(run->job->system, &run->phase, &ends);
    bool due = step->steps >= run->next_check || step->t == step->t_stop ||
               step->outcome == DORMAND_PRINCE_LOST;
    return seen || due ? flight_run_examine(run, seen) : LD_OK;
}

static ld_status begin(flight_run *run, const double *y)
{
    const free_flight *job = run->job;
    double start[DORMAND_PRINCE_STATES] = {0};
    memcpy(start, y, FLIGHT_STATES * sizeof(double));
    bool wide = run->job->system->canopies || run->job->system->own_filling;
    const double *first = wide ? start : y; // of all states
    set_tolerances(run);
    pass_parachutes(run, job->t_start, start);
    dormand_prince_start(&run->steps, job->t_start, start);
    if (job->system->rocket->line.present) {
        ld_status made = begin_line(run);
        if (made)
            return made;
    }
    double height = flight_height(job->system, first);
    run->t_limit = job->t_start + model_run(job->model)->flight_limit;
    watch_extremes(run, job->t_start, first);
    if (job->system->has_ground && height < job->system->ground)
        return ld_fail(
            run->error, LD_ERR_LAUNCH,
            "environment.ground: the flight begins below the ground: the mass centre is at "
            "%s %.6g m, the ground at %.6g m",
            job->system->earth.flat ? "y =" : "an altitude of", height, job->system->ground);
    measuring_begin(run->window, job->measure->count);
    measure_now(run, job->t_start, first);
    set_next(run);
    ld_status status = check_table(run);
    return status ? status : write_row(run, job->t_start, first);
}

static void note_warnings(flight_run *run)
{
    const double degree = acos(0) / 90;
    if (!isnan(run->t_beyond) &&
        run->job->system->rocket->aerodynamics.beyond_table == LD_BEYOND_HOLD)
        summary_note(run->summary,
                     "beyond the aerodynamic table (Mach %.4g) from t = %.4f s on, up to Mach "
                     "%.4g: its last values were used",
                     run->job->system->aerodynamics.last_mach, run->t_beyond, run->extremes.mach);
    if (!isnan(run->t_tumbling))
        summary_note(run->summary,
                     "the rocket flies backwards or tumbles: its angle of attack passed 90 deg "
                     "at t = %.4f s and reached %.1f deg",
                     run->t_tumbling, run->rocket->flight.max_angle_of_attack / degree);
    if (run->landed && run->phase.burning)
        summary_note(run->summary,
                     "the rocket hit the ground at t = %.4f s while its motor was burning",
                     run->steps.step.t);
    if (run->landed)
        note_closed(run);
    note_loads(run);
}

// Neither fins nor spin keep the rocket straight: the centre of pressure lies before the mass
// centre, and (J_x w_x)^2/(4 J_t M'), M' the slope of the air's moment over the angle of attack, is
// below 1 (R. L. McCoy, Modern Exterior Ballistics, 1999, chapter 10).
static void note_unstable(flight_run *run, const double *state, const flight_flow *flow)
{
    const flight_system *system = run->job->system;
    const aerodynamics *body = &system->aerodynamics;
    double margin = run->rocket->flight.stability_margin, t = run->job->t_start;
    if (!(margin < 0) || run->phase.hangs)
        return;
    rocket_mass mass = flight_mass(system, &run->phase, t);
    double area = acos(-1) * body->diameter * body->diameter / 4;
    double slope = aerodynamics_center(body, flow->mach).slope * flow->pressure * area * -margin *
                   body->diameter;
    double across = sqrt(mass.J.a[1][1] * mass.J.a[2][2]);
    double factor = pow(mass.J.a[0][0] * state[FLIGHT_W], 2) / (4 * across * slope);
    if (factor < 1)
        summary_note(
            run->summary,
            "the rocket is unstable at t = %.4f s: its stability margin is %.2f calibres, and its "
            "spin does not stabilise it (gyroscopic factor %.3g, expected more than 1)",
            t, margin, factor);
}

ld_status flight_run_begin(flight_run *run, const free_flight *job, const double *state,
                           ld_rocket_summary *rocket, ld_summary *summary, ld_error *error)
{
    *run = (flight_run){.job = job,
                        .phase = free_flight_phase(job->system, job->t_ignition, job->t_start),
                        .rocket = rocket,
                        .summary = summary,
                        .error = error,
                        .output_from = job->t_start,
                        .output_index = 1,
                        .next_output = job->t_start + model_run(job->model)->output_step_flight,
                        .next_progress = job->t_start,
                        .apogee = -INFINITY,
                        .extremes = {.along = 1},
                        .last_row = NAN,
                        .t_beyond = NAN,
                        .t_tumbling = NAN,
                        .t_topped = NAN,
                        .t_full = INFINITY,
                        .canopy = -1,
                        .descent = descent_none()};
    rocket->flown = true;
    set_triggers(run);
    flight_flow about = flight_flow_at(job->system, job->t_start, state);
    rocket->flight.stability_margin =
        flight_stability_margin(job->system, &run->phase, job->t_start, about.mach);
    note_unstable(run, state, &about);
    const measuring measured = measuring_of(run);
    ld_status status = LD_OK;
    if (measuring_is_there(&measured))
        status = flight_columns(job->system, &run->columns, error);
    return status ? status : begin(run, state);
}

// A flight that ends while it rises has its highest point still ahead.
static void forget_apogee_ahead(flight_run *run)
{
    double t = run->steps.step.t;
    if (t == run->t_apogee && !run->topped &&
        flight_height_rate(run->job->system, &run->phase, t, run->steps.step.y) > 0)
        run->apogee = run->t_apogee = NAN;
}

void flight_run_end(flight_run *run, ld_status status, double *state)
{
    const measuring measured = measuring_of(run);
    if (!status)
        measuring_end(&measured, run->steps.step.t);
    quantity_columns_free(&run->columns);
    memcpy(state, run->steps.step.y, FLIGHT_STATES * sizeof(double));
    ld_flight_summary *flight = &run->rocket->flight;
    take_height(run, run->steps.step.t, state);
    forget_apogee_ahead(run);
    double t_ignition = run->job->t_ignition;
    const flight_system *system = run->job->system;
    flight->apogee = run->apogee - system->ground;
    flight->apogee_altitude = run->apogee + (system->earth.flat ? system->earth.altitude : 0);
    flight->t_apogee = run->t_apogee - t_ignition;
    flight->max_mach = run->extremes.mach;
    flight->max_dynamic_pressure = run->extremes.pressure;
    flight->t_max_dynamic_pressure = run->extremes.t_pressure - t_ignition;
    flight->max_acceleration = sqrt(run->extremes.acceleration);
    flight->t_max_acceleration = run->extremes.t_acceleration - t_ignition;
    flight->max_angle_of_attack = atan2(run->extremes.across, run->extremes.along);
    record_final(run, run->steps.step.t, state, &run->rocket->final);
    measuring_express(run->job->measure, run->rocket);
    note_warnings(run);
    end_line(run, status);
    run->summary->t_end = run->steps.step.t;
    run->summary->statistics.steps += (int64_t)run->steps.step.steps;
    run->summary->statistics.rhs_evaluations += (int64_t)run->steps.step.evaluations;
}

ld_status free_flight_run(const free_flight *self, double state[FLIGHT_STATES],
                          ld_rocket_summary *rocket, ld_summary *summary, ld_error *error)
{
    flight_run run;
    ld_status status = flight_run_begin(&run, self, state, rocket, summary, error);
    while (!status && flight_run_continues(&run))
        status = flight_run_step(&run);
    flight_run_end(&run, status, state);
    return status;
}
