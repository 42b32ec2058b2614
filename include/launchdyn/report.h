/// A run, runs laid over each other, or studies, to look at: one HTML file that opens offline in
/// any browser (docs/report.md).
#ifndef LAUNCHDYN_REPORT_H
#define LAUNCHDYN_REPORT_H

#include <stddef.h>

#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

enum { LD_REPORT_NOTES = 8 };

/// What became of a report.
typedef struct ld_report {
    size_t bytes;  ///< size of the file, at most 2 000 000
    double pixels; ///< of 4000 in height: what thinning may move a curve by; 0: all rows are there,
                   ///< and of studies
    int note_count;                  ///< what is missing or broken in the results,
    char note[LD_REPORT_NOTES][256]; ///< each in a sentence; the report shows them too
} ld_report;

/// Writes the report of the run in `folder`, from history.h5 (or the history.h5.part of a run that
/// was killed) and summary.json; of one of the two, if the other is missing or broken.
/// @param file   NULL: report.html in the folder
/// @param report filled; may be NULL
/// @return LD_OK; LD_ERR_INPUT: neither can be read, or a file in the folder may not be read or is
///         not as it was written: then report->bytes is not 0, and the report shows the rest;
///         LD_ERR_FILE (the report cannot be written; an earlier one stands) or LD_ERR_MEMORY
ld_status ld_report_write(const char *folder, const char *file, ld_report *report, ld_error *error);

/// The same with a log beside the run (launchdyn/compare.h): its series over the simulated ones,
/// their differences and verdicts.
/// @param log     a CSV file
/// @param sensors what its sensors are; NULL: the file beside it
/// @return as ld_report_write() and ld_compare()
ld_status ld_report_write_log(const char *folder, const char *log, const char *sensors,
                              const char *file, ld_report *report, ld_error *error);

/// Writes the report of up to 8 runs laid over each other: the figures of all in one, their
/// summaries side by side. What is broken or not there is left out with a warning.
/// @param folder [count] of the runs
/// @param report filled; may be NULL
/// @return LD_OK; LD_ERR_INPUT: one of the folders holds no run, or a damaged one; where
///         report->bytes is not 0, the report shows the others; LD_ERR_FILE (the report cannot be
///         written; an earlier one stands) or LD_ERR_MEMORY
ld_status ld_report_write_runs(const char *const *folder, size_t count, const char *file,
                               ld_report *report, ld_error *error);

/// Writes the report of studies (launchdyn/study.h) side by side: of each folder its study, or each
/// point of its sweep. What is broken or not there is left out with a warning.
/// @param report filled; may be NULL
/// @return LD_OK; LD_ERR_INPUT: one of the folders holds no study, or a damaged one; where
///         report->bytes is not 0, the report shows the others; LD_ERR_FILE (a study cannot be read
///         or the report written; an earlier one stands) or LD_ERR_MEMORY
ld_status ld_report_write_studies(const char *const *folder, size_t count, const char *file,
                                  ld_report *report, ld_error *error);

/// The same with measured launches beside the studies: differences with intervals and p
/// (docs/study.md).
/// @param launches a CSV file of results of the first study, with their units; NULL: none
/// @return as ld_report_write_studies(); LD_ERR_INPUT: the file is wrong, with line and column
ld_status ld_report_write_measured(const char *const *folder, size_t count, const char *launches,
                                   const char *file, ld_report *report, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
