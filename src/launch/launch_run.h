// One run of a launch: its state, who listens, and what its loop, rows, events, limits, summary and
// flights keep.
#ifndef LD_SIMULATION_LAUNCH_RUN_H
#define LD_SIMULATION_LAUNCH_RUN_H

#include "launchdyn/run.h"
#include "quantities/measuring.h"
#include "state/stepping/propagator.h"
#include "systems/flight/flight.h"

// At one instant.
enum {
    MOST_EVENTS = LD_MAX_ADAPTORS * (1 + LD_MAX_SURFACES) + LD_MAX_WHEELS +
                  LD_SLIDE_STOPS * LD_MAX_SUPPORTS + 8
};

// Of a hinge's error, torque and power since the ignition, for its means.
typedef struct hinge_watch {
    double since; // [s] until when; NaN: not yet begun
    double latest[4], sum[4];
} hinge_watch;

// A start that is given in place of the scenario's: the state at the run's first instant, what its
// base keeps of the equilibrium, the road of a vehicle.
typedef struct launch_start {
    double y[LD_MAX_STATES];
    base_rest rest;
    bool on_breech;
    road *road;
} launch_start;

// What a run keeps of how far the errors of its steps have come.
typedef struct exit_error exit_error;

struct ld_run {
    launch_state launch;
    const launch_start *start; // NULL: the scenario's
    ld_run_options options;    // who listens
    ld_summary summary;        // so far
    ld_status status;          // what ended the run early, with its sentence
    ld_error error;
    ld_error archived; // why what the base has besides its state could not be saved or loaded
    propagator *propagator;
    exit_error *exit_error; // NULL: not estimated
    base_frame told;        // frame T at the start, of a base that is told
    // where it was told last [s], and its state before that: told again there it was not told
    // before
    double told_at, before_told[BASE_MOST_STATES];

    bool outside; // whoever asks takes the steps (launch_outside.h)
    double t;     // [s] the present
    bool ahead;   // a step ends later than the present: what happens at its end has not
    integrator_outcome outcome;  // of that step
    double t_input;              // [s] a step ends there, for an input; infinity: none comes
    int event_count, event_told; // at the present
    ld_event event[MOST_EVENTS];

    double row[LD_MAX_COLUMNS];    // one row of the history
    double between[LD_MAX_STATES]; // state between steps
    double energy_start;           // [J]
    double t_start, t_end;
    double next_output; // time of the next row
    double output_step;
    int64_t output_index; // rows since the last change of the output step
    double output_from;   // where that was
    double last_row;      // time of the last row written
    double next_progress;
    int64_t steps_since_progress;
    bool sink_failed;
    double greatest_lock_force;
    hinge_watch watch[HINGES];
    double t_rocket;                         // [s] start of the current rocket's instants
    double t_measured;                       // [s] where the last step ended
    measure_window measure[LD_MAX_MEASURES]; // of the rocket that is in its tube
    double point[LD_MAX_FIRINGS][2];         // [m] x and z of the rear adaptors at their ignition
    flight_system flight;                    // of the rocket that flies now
    quantity_columns flight_columns;         // its, where rows are wanted
    double cpu, cpu_output;                  // [s] spent in all; of it on rows and their sink
};

// The state at the present, in which no step need end.
const double *run_present_state(ld_run *run);
bool launch_is_finished(const ld_run *run);
// Keeps what happens at t for whoever asks; `part`: adaptor or wheel, -1: of none.
void launch_tell(ld_run *run, ld_event_kind kind, double t, int part);

// Runs from a given start to the end; one that ends early says why.
ld_status run_from(const ld_simulation *simulation, const launch_start *start, ld_summary *summary,
                   ld_error *error);

// ---- the launch, step by step (launch.c)

// Finds the start; the run's state has begun.
ld_status launch_begin(ld_run *run);
// Goes on until the integrator's time has reached t, or the launch is finished, or (`to_event`)
// something happens. The present is then t, or where that was.
ld_status launch_advance(ld_run *run, double t, bool to_event);
// What happens at the end of the step; what to say of one that failed.
ld_status launch_arrive(ld_run *run);
ld_status launch_step_failed(ld_run *run);
// Takes the step under way anew so that it ends at the present.
ld_status launch_stand(ld_run *run);

// ---- a base that is told where it is (launch_base.c)

// Takes what the options say of it at the start.
ld_status launch_begin_base(ld_run *run);
// Refuses a base that goes where its kind says.
ld_status launch_base_listens(const base_system *base, ld_error *error);
// The frame as it is told.
ld_status launch_read_frame(const ld_base_frame *given, base_frame *frame, ld_error *error);
// The first instant after t at which the base changes its state by itself [s]; it does so where the
// present is one.
double launch_next_sample(const ld_run *run, double t);
ld_status launch_sample_base(ld_run *run);
// Takes a base that is stepped from the instant t, where all is in the state y, to its next; others
// nowhere.
ld_status launch_step_base(ld_run *run, double t, double *y);
// On any base, in the state y of the present.
ld_status launch_wrench(ld_run *run, const double *y, ld_base_wrench *wrench, ld_error *error);

// ---- rows (launch_rows.c)

// Hands geometry and columns to the sink.
ld_status launch_open_output(ld_run *run);
// A row at t and state y; one instant gives one row.
ld_status launch_write_row(ld_run *run, double t, const double *y);
// Rows that fell into the last step.
ld_status launch_write_rows(ld_run *run);
// Output instants count from t on, at the step that holds there.
void launch_restart_output(ld_run *run, double t);
// A run that ends early has its last state as its last row.
void launch_write_last_row(ld_run *run);

// ---- events and stops (launch_events.c)

// Switches what the events just located say; true where the equations changed.
bool launch_switch_phase(ld_run *run, double t, const double *y);
// The same of the stops of recoil slides, after each step; `at_event`: which ended at one.
bool launch_hold_stops(ld_run *run, double t, const double *y, bool at_event);
// Opens a lock that carries more than its release force without a crossing to be located.
void launch_let_go_at_once(ld_run *run, double t, const double *y);
// When the next tube takes the place of the one that is empty now [s].
double launch_change_instant(const launch_state *self);
// The next instant at which a step must end [s]; at one: what begins there, true where the
// equations change. The first one is finite where nothing is to come, the other one not.
double launch_next_stop(const ld_run *run, double t);
double launch_next_instant(const ld_run *run, double t);
bool launch_pass_stop(ld_run *run, double t);

// ---- what ends a run early (launch_limits.c)

ld_status launch_check_tube(ld_run *run, double t, const double *y);
ld_status launch_check_base(ld_run *run, double t);
// After each step; each millisecond the caller hears of it.
ld_status launch_check_step(ld_run *run, double t, const double *y);

// ---- summary (launch_summary.c)

void launch_record_ignition(ld_run *run, double t, const double *y);
void launch_record_exit(ld_run *run, double t, const double *landed);
// Largest contact and slot forces so far.
void launch_watch_forces(ld_run *run, double t, const double *y);
// Largest recoil of the tube so far, also after the rocket has left it.
void launch_watch_recoil(ld_run *run, double t, const double *y);
// Largest of what the tube has carried and its supports have borne, where that is asked for.
void launch_watch_loads(ld_run *run, double t, const double *y);
// How the hinges of a vehicle have been held since the ignition.
void launch_watch_hinges(ld_run *run, double t, const double *y);
void launch_energy_at(const launch_state *self, double t, const double *y, double energy_start,
                      ld_energy *energy);
void launch_summarise(ld_run *run);

// ---- how far the errors of the steps leave the rates of a rocket at its exit off, found beside
// the run, whose bits stay as they are (launch_exit_error.c; formulation.md, section 6)

// Nothing is made (NULL) where the tube cannot be linearised. LD_ERR_MEMORY.
ld_status exit_error_create(const ld_simulation *simulation, exit_error **out, ld_error *error);
void exit_error_free(exit_error *self);
// Around each step of the run: where it begins, and where it ends before anything has happened.
void exit_error_begin_step(exit_error *self, ld_run *run);
void exit_error_end_step(exit_error *self, ld_run *run);
// At the exit, in the state y: fills the rocket's exit_error.
void exit_error_record(const exit_error *self, ld_run *run, double t, const double *y);
// Says which rates at an exit may be off by more than EXIT_ERROR_NOTED.
void exit_error_note(ld_run *run);

// ---- measures (launch_measures.c)

// At t a rocket's instants begin; those of the one before have ended.
void launch_begin_measures(ld_run *run, double t);
// Takes the step that has just ended, before anything that happens at its end has; only there, at
// an event or a stop (`lands`), are instants looked for.
void launch_measure_step(ld_run *run, bool lands);
// What has happened at t, in the state y: windows begin and end.
void launch_measure_instant(ld_run *run, double t, const double *y);
// The rocket's last instant, at the end of the last step.
void launch_end_measures(ld_run *run);

// ---- saving and loading (launch_archive.c)

// All that the run's steps, rows and summary to come depend on, or that the summary holds by now;
// loads into a run of the same model, whose propagator is there. One walk, as in archive.h. After a
// failed load the run can only be ended.
void launch_archive(ld_run *run, archive *bytes);

// ---- flights (launch_flights.c)

// Every rocket that has left its tube flies to the ground, or until the run's end.
ld_status launch_fly_all(ld_run *run);
// The rocket that left its tube at t, the state of the launcher there being y, has a jet; the next
// one, whose tube's mouth was there.
ld_status launch_begin_jet(ld_run *run, double t, const double *y);
ld_status launch_add_jet(ld_run *run, const jet_place *mouth, ld_error *error);

#endif
