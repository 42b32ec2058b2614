/// A run beside what was measured: simulated sensors against the columns of a log, with E, u_val
/// and a verdict after ASME V&V 20 (docs/compare.md).
#ifndef LAUNCHDYN_COMPARE_H
#define LAUNCHDYN_COMPARE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// What a comparison is made of.
typedef struct ld_compare_options {
    const char *sensors; ///< file that says what the log's sensors are; NULL: beside the log, .yaml
    const char *study;   ///< folder of a study, whose deviations are u_input of results; NULL: none
    int samples; ///< so many samples of the scenario's scatter, with `study` of the study's, are
                 ///< run for u_input, of series too; 0: none
    bool refine; ///< two more runs, of a tighter tolerance and of more modes, give u_num
    int rocket;  ///< from 1, in the order of firing; 0: the first
    /// Called within each further run with the share of it that is done; return false to stop,
    /// which ends with LD_ERR_INTERRUPTED; NULL: not called.
    bool (*progress)(void *self, double share);
    void *self;
    const void *reserved[4]; ///< NULL: room for what later versions may be asked
} ld_compare_options;

typedef enum ld_verdict {
    LD_VERDICT_AGREE,       ///< |E| <= 2 u_val
    LD_VERDICT_DISAGREE,    ///< |E| > 2 u_val
    LD_VERDICT_CANNOT_TELL, ///< |E| <= 2 u_val, but 2 u_val is larger than what is to be told
} ld_verdict;

/// An error and its standard uncertainties, in SI; NaN: not found, then it does not count.
typedef struct ld_validation {
    double error;   ///< E, simulated less measured; of a series its rms
    double u_num;   ///< of the integration and of the modes
    double u_input; ///< of the scenario's uncertain inputs
    double u_data;  ///< of the log
    double u_val;   ///< root of the sum of their squares
    double limit;   ///< what 2 u_val must not exceed to tell anything
    ld_verdict verdict;
} ld_validation;

/// A sensor's series, without gaps, saturated samples and what lies outside the run.
typedef struct ld_compared_series {
    const char *name;     ///< of its column in the log
    const char *unit;     ///< SI, "" without
    const char *log_unit; ///< as the log has it, `factor` times larger than SI's
    double factor;
    size_t count;
    const double *t;                 ///< [count] s from ignition
    const double *measured;          ///< [count]
    const double *simulated;         ///< [count]
    const double *u_val;             ///< [count]
    ld_validation of;                ///< of rms values
    double mean;                     ///< of E
    double largest, t_largest;       ///< |E| and when that is
    size_t saturated, gaps, outside; ///< samples left out
    double bias, bias_uncertainty;   ///< of the sensor, as given or as found at rest
    const char *column; ///< of the run that it measures, of an altimeter center.y; "": of several
} ld_compared_series;

/// A number, in SI.
typedef struct ld_compared_result {
    const char *name;
    const char *unit;     ///< SI, "" without
    const char *log_unit; ///< as the log has it, `factor` times larger than SI's
    double factor;
    double measured, simulated;
    ld_validation of;
} ld_compared_result;

/// Time from ignition = time of the log + offset.
typedef struct ld_compared_clock {
    double offset, uncertainty; ///< [s]
    const char *found_by;       ///< column by which it was found; NULL: it was given
} ld_compared_clock;

typedef struct ld_comparison ld_comparison;

/// Compares the run in `folder` with the log.
/// @param log        a CSV file
/// @param options    may be NULL
/// @param comparison to be freed; NULL on failure
/// @return LD_OK; LD_ERR_INPUT (no results, a log or a description that is wrong, nothing to be
///         compared), LD_ERR_FILE, LD_ERR_MEMORY, LD_ERR_INTERRUPTED, what a further run returns
ld_status ld_compare(const char *folder, const char *log, const ld_compare_options *options,
                     ld_comparison **comparison, ld_error *error);
/// May be NULL.
void ld_comparison_free(ld_comparison *comparison);

/// Series and results by index from 0, in the order of the description; NULL after the last.
const ld_compared_series *ld_comparison_series(const ld_comparison *comparison, int index);
const ld_compared_result *ld_comparison_result(const ld_comparison *comparison, int index);
const ld_compared_clock *ld_comparison_clock(const ld_comparison *comparison);
/// Remark `index` (from 0) that the user should see; NULL after the last.
const char *ld_comparison_note(const ld_comparison *comparison, int index);

/// Prints it as tables, in the log's units.
void ld_comparison_print(const ld_comparison *comparison, FILE *stream);
/// Draws each series as measured and as simulated, and below that E between -2 u_val and 2 u_val,
/// with gnuplot, which must be in PATH.
/// @param file the picture; its ending says what it becomes: .svg, .pdf or .png
/// @return LD_OK, LD_ERR_INPUT (another ending, no series), LD_ERR_FILE, LD_ERR_MEMORY,
///         LD_ERR_MISSING (no gnuplot)
ld_status ld_comparison_draw(const ld_comparison *comparison, const char *file, ld_error *error);
/// Prints it as one JSON object, in SI, with the series' rows.
void ld_comparison_print_json(const ld_comparison *comparison, FILE *stream);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
