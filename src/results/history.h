// The history of a run in files, HDF5 and CSV, row by row; read back, or kept, in memory.
#ifndef LD_RESULTS_HISTORY_H
#define LD_RESULTS_HISTORY_H

#include <stddef.h>

#include "launchdyn/origin.h"
#include "launchdyn/results.h"
#include "launchdyn/status.h"
#include "quantities/summary.h"

// Of history.h5: 1 had texts of variable length and no checksums.
enum { HISTORY_FORMAT = 3 };

// history.h5, laid out as docs/results.md says. Rows are gathered in blocks; after each block the
// file on disk is complete up to there.
typedef struct history_hdf5 history_hdf5;

// Creates the file at `path`; `title` becomes an attribute.
ld_status history_hdf5_create(const char *path, const char *title, history_hdf5 **history,
                              ld_error *error);
// Where the run comes from, right after the creation.
ld_status history_hdf5_origin(history_hdf5 *history, const ld_origin *origin, ld_error *error);
// What does not change in the run: group geometry, one array each. Before the columns.
ld_status history_hdf5_geometry(history_hdf5 *history, const ld_array *arrays, size_t count,
                                ld_error *error);
ld_status history_hdf5_begin(history_hdf5 *history, const ld_column *columns, size_t count,
                             ld_error *error);
// The rows that follow are of the flight of rocket number `rocket`: group rockets/N/flight.
ld_status history_hdf5_flight(history_hdf5 *history, int rocket, const ld_column *columns,
                              size_t count, ld_error *error);
ld_status history_hdf5_row(history_hdf5 *history, const double *values, ld_error *error);
// Writes what is left and, if `summary` is not NULL, the key instants; closes the file and frees.
ld_status history_hdf5_close(history_hdf5 *history, const ld_summary *summary, ld_error *error);

// history.csv: a line of "name [unit]", then a line of %.17g each row.
typedef struct history_csv history_csv;

ld_status history_csv_create(const char *path, history_csv **history, ld_error *error);
ld_status history_csv_begin(history_csv *history, const ld_column *columns, size_t count,
                            ld_error *error);
ld_status history_csv_row(history_csv *history, const double *values, size_t count,
                          ld_error *error);
ld_status history_csv_close(history_csv *history, ld_error *error);

// One array of the geometry, read back.
typedef struct history_array {
    char *name;
    size_t rows, columns;
    double *value; // [rows][columns]
} history_array;

// A parachute that has opened.
typedef struct history_opening {
    char name[LD_MAX_NAME];
    double t; // [s] from ignition
} history_opening;

// A history read back from history.h5, whole. Of the flight of a rocket: its rows and its instants.
typedef struct history_data {
    char *title;
    size_t rows, columns; // 0 where a flight began without a launcher
    char **name;          // [columns]
    char **unit;          // [columns]
    double *value;        // [columns][rows]
    // key instants of a rocket [s], the first in the launcher's history: ignition on the run's
    // clock, the others from ignition; NaN where there is none
    double t_ignition, t_release, t_front, t_middle, t_rear;
    double t_apogee, t_impact; // of its flight, from ignition; NaN in files of before
    history_opening opening[LD_MAX_PARACHUTES]; // [openings] of its parachutes, by their names
    int openings;
    int tube, number; // of a rocket: its tube (0: none) and its place in the firing order
    struct history_data *flight; // [flights] in the order of firing
    size_t flights;
    struct history_data *rocket; // [rockets] tube and instants of each, flown or not; no columns
    int rockets;
    history_array *geometry; // [arrays]; none where the file holds none
    size_t arrays;
    int complete;  // 0: the run ended early, or was killed
    char *stopped; // why it ended early, "" or NULL where nothing is known
} history_data;

ld_status history_read(const char *path, history_data *history, ld_error *error);

void history_free(history_data *history);

// The array of the geometry with this name, or NULL.
const history_array *history_array_named(const history_data *history, const char *name);

// The values of column `name`, or NULL.
const double *history_column(const history_data *history, const char *name);

// A flight without its rows, added to room for it: instants, tube and number of a rocket.
history_data *history_begin_flight(history_data *history, const history_data *rocket);

// A history in memory, without a file: what history_read() would read of the file of the same run.
typedef struct history_memory history_memory;
history_memory *history_memory_new(void); // NULL: no memory
void history_memory_free(history_memory *memory);
const ld_sink *history_memory_sink(history_memory *memory);
// `history` becomes what the run came to; to be freed where it is LD_OK. LD_ERR_INPUT: no rows.
ld_status history_memory_take(const history_memory *memory, const ld_summary *summary,
                              history_data *history, ld_error *error);

#endif
