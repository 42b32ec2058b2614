/// A run that is stepped: begun, taken forward to a time or to the next event, read, given its
/// ignition or its base, saved and loaded, ended.
///
/// The steps are those of ld_simulation_run(), however often and wherever the run is stopped to be
/// read: between their ends values are interpolated. So rows and summary have the same bits,
/// unless an input comes, at whose instant a step then ends.
#ifndef LAUNCHDYN_RUN_H
#define LAUNCHDYN_RUN_H

#include <stddef.h>

#include "launchdyn/simulation.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct ld_run ld_run;

/// What happens in a run, in the order in which it can come.
typedef enum ld_event_kind {
    LD_EVENT_NONE,     ///< nothing up to the time asked for
    LD_EVENT_IGNITION, ///< of the rocket
    LD_EVENT_RELEASE,  ///< the lock lets the rocket go
    LD_EVENT_CORNER,   ///< of the thrust curve, or of a commanded angle
    LD_EVENT_TOUCH,  ///< adaptor `part` comes to the tube's wall (contact law lankarani-nikravesh)
    LD_EVENT_BREECH, ///< the rocket comes to the breech (that law alone)
    LD_EVENT_LINE,   ///< the line that the rocket pulls becomes taut, or breaks
    LD_EVENT_LIFT,   ///< wheel `part` leaves the road (integrated together alone, as the next)
    LD_EVENT_LAND,   ///< wheel `part` comes back to it
    LD_EVENT_LEAVE,  ///< the tube leaves stop `part` of its recoil slides
    LD_EVENT_STOP,   ///< the tube comes to it
    LD_EVENT_EXIT,   ///< adaptor `part` leaves the guide
    LD_EVENT_TUBE,   ///< the rocket's tube takes the place of the one before
    LD_EVENT_END,    ///< of the launch; the flights are flown by ld_run_end()
} ld_event_kind;

typedef struct ld_event {
    ld_event_kind kind;
    double t;   ///< [s] on the run's clock
    int rocket; ///< from 1, in the order of firing: the one whose turn it is
    int part;   ///< adaptor or wheel, from 1, in the model's order; of each slide first the front
                ///< stop, then the one behind; 0: of none
} ld_event;

/// Begins a run: finds its start, gives the sink geometry, columns and the first row. What
/// `options` point to, and the simulation, must outlive it; other runs may continue over the same
/// simulation, each on one thread at a time. A flight alone has no launch: it is finished at once,
/// and flown by ld_run_end().
/// @param options may be NULL
/// @param run NULL after LD_ERR_MEMORY; after other failures a run that failed, to be ended
/// @return as ld_simulation_run()
ld_status ld_run_begin(const ld_simulation *simulation, const ld_run_options *options, ld_run **run,
                       ld_error *error);

/// Continues to time t [s], or to the end of the launch where that comes before; infinity: to the
/// end. Events on the way, that at t too, have then happened.
/// @return LD_OK; LD_ERR_INPUT (t lies behind, or is not a number); what ended the run, as
///         ld_simulation_run(), now and whenever it is asked again
ld_status ld_run_advance(ld_run *run, double t, ld_error *error);

/// Continues to the next event, but not beyond time t [s]. Several at one instant come one by one;
/// those that ld_run_advance() has passed are reported no more.
/// @return as ld_run_advance()
ld_status ld_run_advance_to_event(ld_run *run, double t, ld_event *next, ld_error *error);

/// Present time [s] on the run's clock.
double ld_run_time(const ld_run *run);
/// Whether the launch is over: what is left are the flights, by ld_run_end().
bool ld_run_is_finished(const ld_run *run);

/// A column of the history, by name, at the present time.
/// @return LD_OK, LD_ERR_INPUT (no such column, a flight alone), or what ended the run
ld_status ld_run_number(ld_run *run, const char *name, double *value, ld_error *error);
/// All of them, in the order of ld_simulation_columns(). @return as ld_run_number()
ld_status ld_run_row(ld_run *run, double *values, ld_error *error);

/// What came of it so far, for ld_summary_number(); energies, warnings, flights are there at the
/// end alone. Owned by the run.
const ld_summary *ld_run_summary(const ld_run *run);

/// An input: the rocket that stands in the tube is ignited at time t [s] in place of its firing
/// time; infinity: not until it is set again. What the scenario counts from its ignition moves
/// along; the firing times of the others stay.
/// @return LD_OK; LD_ERR_INPUT (it burns already, t lies behind or after the next firing)
ld_status ld_run_ignite(ld_run *run, double t, ld_error *error);

/// An input: where the base is at the present time and how it moves (base.kind: external). Until it
/// is set again it continues with its velocity, and with the acceleration that its last two
/// velocities report unless base.extrapolation says without. A step ends at every time to which
/// such a run is taken: set the base there, then continue. Set again at the same time, what it
/// was given before at that time counts no more.
/// @return LD_OK; LD_ERR_INPUT (another kind of base, a number that is not finite, a quaternion
///         whose length is not 1; the launch is over); what ended the run
ld_status ld_run_set_base(ld_run *run, const ld_base_frame *base, ld_error *error);

/// What the launching tube does to its base, all in I.
typedef struct ld_base_wrench {
    double force[3];  ///< [N]
    double moment[3]; ///< [N m] about the undeformed tube's rear end
} ld_base_wrench;

/// That of the present time, on a base of any kind. @return as ld_run_number()
ld_status ld_run_base_wrench(ld_run *run, ld_base_wrench *wrench, ld_error *error);

/// Writes the state as bytes, with the version of their form, a digest of the model and a checksum.
/// Loaded, in this process or another one of the same program, it continues with the same bits.
/// @param bytes [capacity] may be NULL where capacity is 0
/// @param size bytes it takes, less than 64 KiB for a usual model
/// @return LD_OK; LD_ERR_INPUT (more than `capacity`; a run that failed, a flight alone)
ld_status ld_run_save(ld_run *run, void *bytes, size_t capacity, size_t *size, ld_error *error);

/// Continues where the run that was saved stood. The sink gets geometry, columns, and the rows that
/// come after; CPU times count from here on.
/// @param simulation of an equal model
/// @param run NULL after a failure
/// @return LD_OK; LD_ERR_INPUT (no state of a run, cut off, damaged, of another model or another
///         version); LD_ERR_MEMORY; what the sink returned
ld_status ld_run_load(const ld_simulation *simulation, const ld_run_options *options,
                      const void *bytes, size_t size, ld_run **run, ld_error *error);

/// Ends it: flies the rockets that left their tubes where the scenario requires it, writes the
/// summary and frees the run (NULL: nothing happens). A launch that is not over ends where it is,
/// its rockets stay unflown, the summary says so. To give it up, leave the summary out.
/// @param summary filled; may be NULL
/// @return as ld_simulation_run(); LD_ERR_INTERRUPTED where the launch was not over
ld_status ld_run_end(ld_run *run, ld_summary *summary, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
