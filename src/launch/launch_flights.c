// The flights of the rockets that have left their tubes.
#include "launch/launch_flights.h"

#include <math.h>

#include "base/cpu_time.h"
#include "flight/flight_history.h"
#include "flight/free_flight.h"
#include "model/parts.h"

static ld_status write_flight_row(void *user, const flight_phase *phase, double t,
                                  const double *state, ld_error *error)
{
    ld_run *run = user;
    const ld_sink *sink = run->options.sink;
    double row[FLIGHT_MAX_COLUMNS], start = cpu_time_now();
    flight_row(&run->flight, &run->flight_columns, phase, t, state, row);
    ld_status status = sink->row(sink->self, row, (size_t)run->flight_columns.count, error);
    run->cpu_output += cpu_time_now() - start;
    return status;
}

static ld_status begin_flight_rows(ld_run *run, int i)
{
    const ld_sink *sink = run->options.sink;
    double start = cpu_time_now();
    quantity_columns *columns = &run->flight_columns;
    ld_status status = flight_columns(&run->flight, columns, &run->error);
    if (!status)
        status =
            sink->flight(sink->self, i + 1, columns->column, (size_t)columns->count, &run->error);
    run->cpu_output += cpu_time_now() - start;
    return status;
}

// The phase and the state in which rocket i, which has left its tube, begins its flight; nothing
// jumps.
static flight_phase enter_flight(const ld_run *run, const flight_system *flight, int i,
                                 double state[FLIGHT_STATES])
{
    const ld_rocket_summary *rocket = &run->summary.rocket[i];
    double t = rocket->t_ignition + rocket->t_rear;
    quat q = q_from(rocket->exit.quaternion);
    const earth *globe = &flight->earth;
    m3 A_EB = m3_mul(globe->A_EI, q_matrix(q));
    flight_pose pose = {
        .r_O1 = v3_from(rocket->exit.position),
        .v_O1 = v3_from(rocket->exit.velocity),
        .q_IB = q,
        .w = v3_add(v3_from(rocket->exit.rate), m3_apply_transposed(A_EB, earth_rate(globe))),
    };
    flight_phase phase = free_flight_phase(flight, rocket->t_ignition, t);
    flight_enter(flight, &phase, t, &pose, state);
    return phase;
}

ld_status launch_add_jet(ld_run *run, const jet_place *mouth, ld_error *error)
{
    launch_state *self = &run->launch;
    double state[FLIGHT_STATES];
    int i = self->jets.count;
    const flight_system *flight = simulation_flight(self->system, i);
    flight_phase phase = enter_flight(run, flight, i, state);
    return jets_add(&self->jets, flight, &phase, mouth, state, error);
}

ld_status launch_begin_jet(ld_run *run, double t, const double *y)
{
    const launch_state *self = &run->launch;
    launcher_input input;
    launcher_place(&self->launcher, t, y, &input);
    const base_frame *tube = &input.launching.base;
    v3 arm = m3_apply(tube->A, v3_make(model_tubes(self->model)->length, 0, 0));
    jet_place mouth = {t, v3_add(tube->r, arm), v3_add(tube->v, v3_cross(tube->w, arm))};
    return launch_add_jet(run, &mouth, &run->error);
}

// The container on a base that goes by time; beyond what its table covers it goes on as there.
static line_bridle carried_by_time(const void *carrier, double t)
{
    const ld_run *run = carrier;
    const base_system *base = &run->launch.launcher.base;
    double first, last;
    base_frame frame;
    base_found found;
    base_span(base, &first, &last);
    double known = fmin(t, last);
    base->kind->find_frame(base, known, NULL, &frame, &found);
    v3 arm = m3_apply(frame.A, v3_from(run->launch.rocket->line.container));
    v3 turns = v3_cross(frame.w, arm), v = v3_add(frame.v, turns);
    v3 a = v3_add(frame.a, v3_add(v3_cross(frame.alpha, arm), v3_cross(frame.w, turns)));
    return (line_bridle){v3_axpy(v3_add(frame.r, arm), t - known, v), v, t < last ? a : v3_zero()};
}

// On any other, which is not known after the exit: with the velocity that it had there.
static line_bridle carried_steadily(const void *carrier, double t)
{
    const ld_run *run = carrier;
    const ld_rocket_summary *rocket = &run->summary.rocket[0];
    double since = t - (rocket->t_ignition + rocket->t_rear);
    v3 v = v3_from(run->container + 3);
    return (line_bridle){v3_axpy(v3_from(run->container), since, v), v, v3_zero()};
}

// How the line begins that the rocket, the only one, pulls.
static ld_status begin_line(ld_run *run, free_flight *job)
{
    const ld_line *given = &run->launch.rocket->line;
    const ld_rocket_summary *rocket = &run->summary.rocket[0];
    const launching_phase *phase = &run->launch.phase;
    if (!given->present)
        return LD_OK;
    job->container = v3_from(run->container);
    if (given->container_on == LD_LINE_ON_LAUNCHER) {
        bool by_time = model_base_goes_by_time(run->launch.model);
        job->carried = by_time ? carried_by_time : carried_steadily;
        job->carrier = run;
    }
    if (phase->line == LINE_SLACK)
        return ld_fail(
            &run->error, LD_ERR_LAUNCH,
            "rocket.line.slack: the rocket leaves its guide before it has drawn the line "
            "taut");
    if (phase->line == LINE_BROKEN)
        job->broken = (line_break){phase->line_out, rocket->t_ignition + rocket->line.t_break,
                                   v3_from(rocket->line.broken)};
    return LD_OK;
}

// Flies rocket i from the state in which it left its tube.
static ld_status fly(ld_run *run, int i)
{
    const ld_model *model = run->launch.model;
    ld_rocket_summary *rocket = &run->summary.rocket[i];
    double t = rocket->t_ignition + rocket->t_rear, state[FLIGHT_STATES];
    bool rows = run->options.sink && run->options.sink->flight;
    enter_flight(run, &run->flight, i, state);
    double height = flight_center(&run->flight, t, state).r.y;
    if (model_run(model)->end == LD_END_TIME && run->flight.has_ground &&
        height < run->flight.ground) {
        summary_note(&run->summary,
                     "the rocket of %s %d does not fly: it leaves below the ground, its "
                     "mass centre at y = %.4g m",
                     model_guide_word(model), rocket->tube, height);
        return LD_OK;
    }
    free_flight job = {
        .system = &run->flight,
        .model = model,
        .measure = &run->launch.system->measure,
        .t_ignition = rocket->t_ignition,
        .t_start = t,
        .t_end = run->t_end,
        .launch_x = run->point[i][0],
        .launch_z = run->point[i][1],
        .options = &run->options,
        .row = rows ? write_flight_row : NULL,
        .self = run,
    };
    ld_status status = begin_line(run, &job);
    if (!status && rows)
        status = begin_flight_rows(run, i);
    if (!status)
        status = free_flight_run(&job, state, rocket, &run->summary, &run->error);
    return status;
}

// Every rocket that has left its tube flies to the ground, or until the run's end.
ld_status launch_fly_all(ld_run *run)
{
    ld_status status = LD_OK;
    if (model_run(run->launch.model)->end == LD_END_TIP)
        return LD_OK;
    for (int i = 0; i < run->summary.rocket_count && !status; i++) {
        if (isnan(run->summary.rocket[i].t_rear))
            continue;
        status = flight_build(&run->flight, run->launch.model, i, &run->error);
        if (!status)
            status = fly(run, i);
        flight_free(&run->flight);
        quantity_columns_free(&run->flight_columns);
    }
    return status;
}
