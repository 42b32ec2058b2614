// The state of a launch as bytes.
#include "launch/launch_archive.h"

#include <limits.h>

#include "launch/launch_flights.h"
#include "model/blocks/firing.h"
#include "model/parts.h"
#include "quantities/summary_quantities.h"

static void archive_phase(archive *bytes, launching_phase *phase)
{
    archive_bool(bytes, &phase->rocket);
    archive_bool(bytes, &phase->locked);
    int line = (int)phase->line;
    archive_int(bytes, &line, LINE_TAUT, LINE_BROKEN);
    phase->line = (line_state)line;
    archive_double(bytes, &phase->line_out);
    archive_bool(bytes, &phase->frictionless);
    for (int i = 0; i < LD_MAX_ADAPTORS; i++)
        archive_bool(bytes, &phase->passed[i]);
    archive_doubles(bytes, phase->touch_speed, LD_MAX_ADAPTORS);
    for (int i = 0; i < LD_MAX_ADAPTORS; i++)
        archive_doubles(bytes, phase->surface_speed[i], LD_MAX_SURFACES);
    archive_double(bytes, &phase->breech);
    archive_double(bytes, &phase->breech_speed);
    for (int i = 0; i < LD_MAX_SUPPORTS; i++)
        for (int k = 0; k < LD_SLIDE_STOPS; k++)
            archive_int(bytes, &phase->pushing[i][k], -1, 1);
}

static void archive_launch(archive *bytes, launch_state *self)
{
    int current = self->current;
    archive_int(bytes, &current, 0, model_firing_count(self->model) - 1);
    if (bytes->loading) {
        launcher_select(&self->launcher, current);
        launch_state_select(self, current);
        self->latest.known = false;
    }
    archive_double(bytes, &self->t_ignition);
    archive_int(bytes, &self->piece, -1, (int)self->motor->corner_count - 1);
    if (model_has_pressure(self->model)) {
        const ld_pressure *pressure = &model_tubes(self->model)->pressure;
        int most = pressure->form == LD_PRESSURE_OVER_TIME ? (int)pressure->over_time.rows : 1;
        archive_int(bytes, &self->pressure_piece, 0, most);
    }
    archive_bool(bytes, &self->held_down);
    archive_phase(bytes, &self->phase);
    archive_doubles(bytes, self->rest.number, sizeof self->rest.number / sizeof(double));
    archive_bool(bytes, &self->on_breech);
    for (int i = 0; i < 3; i++)
        archive_doubles(bytes, self->A_ignition.a[i], 3);
    archive_bool(bytes, &self->jammed);
    archive_count(bytes, &self->fallbacks);
    archive_double(bytes, &self->worst_condition);
}

static void archive_watch(archive *bytes, hinge_watch *watch)
{
    archive_double(bytes, &watch->since);
    archive_doubles(bytes, watch->latest, sizeof watch->latest / sizeof *watch->latest);
    archive_doubles(bytes, watch->sum, sizeof watch->sum / sizeof *watch->sum);
}

static void archive_output(archive *bytes, ld_run *run)
{
    double *numbers[] = {&run->energy_start, &run->t_start,       &run->t_end,
                         &run->next_output,  &run->output_step,   &run->output_from,
                         &run->last_row,     &run->next_progress, &run->greatest_lock_force};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        archive_double(bytes, numbers[i]);
    const ld_run_settings *steps = model_run(run->launch.model);
    for (int i = 0; i < HINGES; i++)
        archive_watch(bytes, &run->watch[i]);
    int drives = model_has_multibody(run->launch.model)
                     ? model_base(run->launch.model)->mechanism.drive_count
                     : 0;
    for (int i = 0; i < drives; i++)
        archive_watch(bytes, &run->drive_watch[i]);
    bytes->failed |= run->output_step != steps->output_step_lead_in &&
                     run->output_step != steps->output_step_tube;
    archive_count(bytes, &run->output_index);
    archive_count(bytes, &run->steps_since_progress);
}

// Of what is known before the run's end.
static void archive_summary(archive *bytes, ld_run *run)
{
    ld_summary *summary = &run->summary;
    const quantity_things things = quantity_things_of(run->launch.model);
    archive_int(bytes, &summary->rocket_count, 0, model_firing_count(run->launch.model));
    for (int i = 0; i < summary->rocket_count; i++) {
        ld_rocket_summary *rocket = &summary->rocket[i];
        if (bytes->loading)
            rocket_clear(rocket, true);
        rocket->tube = model_firing(run->launch.model, i)->tube;
        archive_bool(bytes, &rocket->flown);
        archive_bool(bytes, &rocket->final.earth);
        quantity_archive(&rocket_quantities, &things, rocket, bytes);
        archive_doubles(bytes, run->point[i], 2);
    }
    if (run->launch.rocket->line.present)
        archive_doubles(bytes, run->container, sizeof run->container / sizeof(double));
    archive_int(bytes, &summary->equilibrium.wheel_count, 0, LD_MAX_WHEELS);
    quantity_archive(&run_quantities, &things, summary, bytes);
    const int most_notes = sizeof summary->note / sizeof *summary->note;
    archive_int(bytes, &summary->note_count, 0, most_notes);
    for (int i = 0; i < summary->note_count; i++)
        archive_text(bytes, summary->note[i], sizeof summary->note[i]);
}

// The rockets that have left are known from the summary, and so are their courses but for where the
// mouth was, and how it moved.
static void archive_jets(archive *bytes, ld_run *run)
{
    jets *left = &run->launch.jets;
    int count = run->launch.current + !run->launch.phase.rocket;
    if (!model_has_jets(run->launch.model))
        return;
    if (bytes->loading)
        jets_free(left);
    for (int i = 0; i < count && !(bytes->loading && bytes->failed); i++) {
        jet *one = &left->of[i];
        double mouth[7] = {one->mouth.t};
        v3_store(mouth + 1, one->mouth.r);
        v3_store(mouth + 4, one->mouth.v);
        archive_doubles(bytes, mouth, 7);
        const jet_place place = {mouth[0], v3_from(mouth + 1), v3_from(mouth + 4)};
        bytes->failed |= bytes->loading && launch_add_jet(run, &place, NULL);
        archive_int(bytes, &one->piece, -1, (int)one->flight->motor.corner_count - 1);
    }
}

// Measures as far as they have been taken; nothing where there are none.
static void archive_measures(archive *bytes, ld_run *run)
{
    const measure_plans *plans = &run->launch.system->measure;
    const int own = model_measure_count(run->launch.model); // those of the summary are in it
    if (plans->count == 0)
        return;
    archive_double(bytes, &run->t_rocket);
    archive_double(bytes, &run->t_measured);
    for (int i = 0; i < run->summary.rocket_count; i++)
        archive_doubles(bytes, run->summary.rocket[i].measure + own, (size_t)(plans->count - own));
    for (int i = 0; i < plans->count; i++) {
        measure_window *measure = &run->measure[i];
        archive_bool(bytes, &measure->open);
        archive_bool(bytes, &measure->done);
        archive_double(bytes, &measure->t_from);
        archive_double(bytes, &measure->value);
        archive_double(bytes, &measure->reference);
        archive_double(bytes, &measure->sum);
        archive_double(bytes, &measure->peak);
    }
}

// Where the run stands, and what its events are that have not been reported.
static void archive_present(archive *bytes, ld_run *run)
{
    int outcome = (int)run->outcome;
    archive_double(bytes, &run->t);
    archive_bool(bytes, &run->ahead);
    archive_int(bytes, &outcome, INTEGRATOR_STEPPED, INTEGRATOR_EVENT);
    run->outcome = (integrator_outcome)outcome;
    archive_int(bytes, &run->event_count, 0, MOST_EVENTS);
    archive_int(bytes, &run->event_reported, 0, run->event_count);
    for (int i = 0; i < run->event_count; i++) {
        ld_event *one = &run->event[i];
        int kind = (int)one->kind;
        archive_int(bytes, &kind, LD_EVENT_NONE, LD_EVENT_END);
        one->kind = (ld_event_kind)kind;
        archive_double(bytes, &one->t);
        archive_int(bytes, &one->rocket, 0, LD_MAX_FIRINGS);
        archive_int(bytes, &one->part, 0, INT_MAX);
    }
}

// What an externally driven base would go back to where it is set again.
static void archive_driven(archive *bytes, ld_run *run)
{
    const base_system *base = &run->launch.launcher.base;
    if (!base->kind->receive_frame)
        return;
    archive_double(bytes, &run->reported_at);
    archive_doubles(bytes, run->before_driven, (size_t)base->state_count);
}

// The present lies in the last step, or at its end; rows come after what has been gone through.
static void check_instants(const ld_run *run, archive *bytes)
{
    double begins = propagator_previous_time(run->propagator);
    double ends = propagator_time(run->propagator);
    bool present = run->ahead ? begins <= run->t && run->t <= ends : run->t == ends;
    double next_row = run->output_from + (double)run->output_index * run->output_step;
    bool under_way = run->ahead || run->outside;
    bool rows = run->next_output == next_row && next_row > (under_way ? begins : ends);
    bytes->failed |= !present || !rows;
}

// What a base that is stepped has besides its state.
static void archive_base(archive *bytes, ld_run *run)
{
    const base_system *base = &run->launch.launcher.base;
    const base_stepping *stepping = base->kind->stepping;
    run->archived = (ld_error){0};
    if (!stepping || (bytes->loading && bytes->failed))
        return;
    double t = propagator_time(run->propagator);
    bytes->failed |= stepping->archive(base, t, bytes, &run->archived) != LD_OK;
}

void launch_archive(ld_run *run, archive *bytes)
{
    archive_launch(bytes, &run->launch);
    archive_present(bytes, run);
    archive_output(bytes, run);
    archive_summary(bytes, run);
    archive_jets(bytes, run);
    archive_measures(bytes, run);
    archive_driven(bytes, run);
    propagator_archive(run->propagator, bytes);
    archive_base(bytes, run);
    check_instants(run, bytes);
}
