// The parts of a run's report: figures, tables of numbers, the page around them.
#ifndef LD_REPORT_REPORT_PARTS_H
#define LD_REPORT_REPORT_PARTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "figures/plot.h"
#include "launchdyn/compare.h"
#include "launchdyn/origin.h"
#include "launchdyn/report.h"
#include "launchdyn/status.h"
#include "report/report_html.h"
#include "results/history.h"

// What was found in a folder of results.
typedef struct report_source {
    bool has_history;
    history_data history; // the launcher's with those of the flights, or of a flight alone
    char *summary;        // text of summary.json, NULL: there is none
    size_t summary_length;
    bool has_origin;
    ld_origin origin;
    ld_report *report; // takes warnings
    const char *log;   // the run is compared with, or NULL
    ld_comparison *comparison;
} report_source;

// How finely curves are kept.
typedef struct report_detail {
    bool whole, whole_tube; // every row; every row while a rocket is in the tube
    double pixel;           // elsewhere a curve is moved by this share of its span, at most,
    bool over_all;          // of that over all rows, not in the phase of the run at hand
    bool figures_alone;     // without what the replay requires besides
} report_detail;

// A page of runs, and the JSON that it holds, at some detail.
typedef struct report_page {
    const void *self;
    ld_status (*write_data)(FILE *json, const void *self, const report_detail *detail,
                            ld_error *error);
    ld_status (*write_page)(FILE *page, const void *self, const char *data, size_t length,
                            ld_error *error);
    bool figures_alone; // see report_detail
    size_t title;       // bytes of its titles, which no detail makes shorter
} report_page;

// Writes the page into `file` as fine as it fits, and what it took into `report`.
ld_status report_write_as_fits(const report_page *page, const char *file, ld_report *report,
                               ld_error *error);

// Reads what is whole in a folder of results. LD_ERR_INPUT, with what is damaged, where something
// is; LD_ERR_FILE, LD_ERR_MEMORY. `source` is zero but for who takes warnings; to be freed either
// way.
ld_status report_read_folder(report_source *source, const char *folder, ld_error *error);
void report_free_source(report_source *source);

// Bytes of the run's title.
size_t report_title_length(const report_source *source);

// Whether a history is that of a flight.
bool report_is_flight(const history_data *history);

// Writes one table of numbers as JSON: the columns that figures show, in segments, each column by
// the rows that it needs. `rocket`: whose flight it is, 0: the launcher.
ld_status report_write_table(FILE *json, const history_data *history, int rocket,
                             const report_detail *detail, ld_error *error);

// Whether a history has what the replay requires.
bool report_has_replay(const history_data *history);

// Adds the columns that the replay requires and the history lacks, where there is a replay:
// "replay.x", ".y", ".z" [m], ".rx", ".ry", ".rz" [rad], place and rotation vector of the tube's
// frame R against the undeformed tube, in its axes.
ld_status report_add_replay(history_data *history, ld_error *error);

// Whether the replay shows a column of a launcher, or of a flight.
bool report_replay_shows(const char *name, bool flight);

// Writes the launcher's geometry as JSON: an object of arrays, empty where there is no replay.
void report_write_geometry(FILE *json, const history_data *history);

// Writes bytes as text: deflated (zlib), in base64.
ld_status report_write_bytes(FILE *text, const void *bytes, size_t count, ld_error *error);

// Writes what the page shows of a run beside its summary and the figures' table: members of an
// object of JSON.
ld_status report_write_run(FILE *json, const report_source *source, const report_detail *detail,
                           ld_error *error);

// Writes what a run was compared with, an object of JSON in the log's units; null where it was not.
void report_write_compared(FILE *json, const report_source *source);

// Writes where a run comes from under this name, where that is known; `room`: for texts [bytes].
ld_status report_write_run_origin(FILE *page, const char *name, const report_source *source,
                                  size_t room, ld_error *error);

// Writes all that the page shows beside the summary as JSON.
ld_status report_write_data(FILE *json, const report_source *source, const report_detail *detail,
                            ld_error *error);

// Writes the page: `data` is the JSON of report_write_data().
ld_status report_write_page(FILE *page, const report_source *source, const char *data,
                            size_t length, ld_error *error);

#endif
