// The columns of a run for one rocket, in the launch and in its flight, over the time from its
// ignition: from a history in a file or in memory.
#ifndef LD_COMPARE_RUN_SERIES_H
#define LD_COMPARE_RUN_SERIES_H

#include "launchdyn/history.h"
#include "launchdyn/simulation.h"
#include "results/history.h"

// Columns of the launch, or of the flight; texts and values belong to the history.
typedef struct series_part {
    size_t columns, rows;
    const char **name, **unit; // [columns] owned
    const double **value;      // [columns][rows] owned
} series_part;

typedef enum series_instant {
    SERIES_IGNITION,
    SERIES_RELEASE,
    SERIES_FRONT,
    SERIES_MIDDLE,
    SERIES_REAR,
    SERIES_APOGEE,
    SERIES_IMPACT,
    SERIES_INSTANTS
} series_instant;

typedef struct run_series {
    series_part launch, flight; // without rows where there is none
    double t_ignition;          // [s] on the run's clock
    double t_first, t_last;     // [s] likewise: rows of the launch outside are not this rocket's
    double instant[SERIES_INSTANTS]; // [s] from ignition; NaN: none
    double gravity;                  // [m/s2] along -y of I; NaN: not known
} run_series;

// Of the rocket with this place in the firing order, from 1. The history must outlive it.
// @return LD_OK, LD_ERR_INPUT (no such rocket), LD_ERR_MEMORY
ld_status run_series_of_file(run_series *self, const history_data *history, int rocket,
                             ld_error *error);
ld_status run_series_of_run(run_series *self, const ld_history *history, const ld_summary *summary,
                            int rocket, ld_error *error);
void run_series_free(run_series *self);

// The unit of a column of launch or flight; NULL: there is none, and *nearest is the name that is
// probably meant, or NULL.
const char *run_series_unit(const run_series *self, const char *name, const char **nearest);

// An end of a window: a time from ignition, an instant of the rocket, or none.
enum { WINDOW_TIME = SERIES_INSTANTS, WINDOW_OPEN };
typedef struct window_end {
    int kind; // series_instant or one of these
    double t; // [s]
} window_end;

// An end of a window [s] from ignition; `open` where it is none, or an instant that there is not.
double window_time(const run_series *run, window_end end, double open);

// A column over the time from ignition, launch and flight joined; of the launch the rows in which
// it is a number.
typedef struct run_signal {
    size_t count;
    double *t, *value; // [count] t rises; two rows at one time: a jump. Owned
} run_signal;

// `names`: so many columns side by side, value[i * width + k]; rows where one is no number are left
// out.
// @return LD_OK, LD_ERR_INPUT (no such column in the run), LD_ERR_MEMORY
ld_status run_series_take(const run_series *self, const char *const *names, size_t width,
                          run_signal *signal, ld_error *error);
void run_signal_free(run_signal *self);

#endif
