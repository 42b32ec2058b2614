// The parts of the report of studies: what is laid side by side, its numbers, the page.
#ifndef LD_REPORT_REPORT_STUDY_H
#define LD_REPORT_REPORT_STUDY_H

#include "launchdyn/study.h"
#include "quantities/study_results.h"
#include "report/report_html.h"
#include "studies/show/measured.h"
#include "studies/statistics/statistics.h"
#include "studies/store/study_data.h"

// More series than REPORT_OVERLAID are drawn as columns: their histograms are left out.
enum { REPORT_SERIES = 40, REPORT_OVERLAID = 4, REPORT_BINS = 80, REPORT_PLACES = 60 };

// A study, or one point of its sweep.
typedef struct study_series {
    const study_data *data;
    const study_point *point;
    char label[256];
    study_values values; // of the results at hand
    bool broken;         // said already
} study_series;

typedef struct study_source {
    bool several; // folders were named
    int study_count, series_count;
    double share; // of what grows with the number of series, as much as fits
    study_data study[REPORT_SERIES];
    ld_origin origin[REPORT_SERIES]; // of each study; empty where it is not known
    const char *folder[REPORT_SERIES];
    study_series series[REPORT_SERIES];
    const char *measured; // file with shots to lay beside, or NULL
    measured shots;       // what it holds
    ld_report *report;    // takes notes
    ld_error problem;     // what could not be read, the first; status 0: all could
} study_source;

// Notes what could not be read: `what` it is about, and why.
void study_take_problem(study_source *source, const char *what, const ld_error *error);

// Bins of the same width for all series.
typedef struct study_bins {
    double from, width;
    int count;
} study_bins;

// Bins for values, each series' sorted: the width of Freedman and Diaconis (2 IQR n^(-1/3)) for the
// series that wants the finest, at most REPORT_BINS. count 0: there are no values.
study_bins study_choose_bins(const double *const *sorted, const size_t *count, int series);
// How many of the values lie in each bin; the last one has its upper end too.
void study_fill_bins(const study_bins *bins, const double *sorted, size_t count, long *in_bin);

// Numbers of independent groups at which estimates are shown as the study grows, from 2 to all of
// them, evenly spaced in their logarithm; at most `most`. Returns how many.
int study_choose_places(size_t groups, int most, size_t *place);

// Whether a plot that holds about `most` of `count` points shows this one; depends on its number
// only.
bool study_shows_point(int64_t sample, int rocket, size_t count, size_t most);

// Writes a number with eight digits, enough to draw; null where there is none.
void study_write_short(FILE *json, double value);
// One of a list of estimates, each as [value, low, high].
typedef void study_write_number(FILE *json, double value);
void study_write_estimate(FILE *json, int index, estimate e, study_write_number *write);

// Reads columns of a series; of a broken one what can be read, which is said once.
void study_read(study_source *source, study_series *series, const study_column *const *column,
                int columns);

// Reads one or two results of a series into its values; none where it lacks one.
void study_read_values(study_source *source, study_series *series, const char *const *name,
                       int columns);

// Writes the pairs of results that are shown against each other, as items of a list.
// @return LD_OK, LD_ERR_MEMORY
ld_status study_write_pairs(FILE *json, study_source *source);

// Writes what study number `index` was asked to do and where it comes from, an item of a list.
// @return LD_OK, LD_ERR_MEMORY
ld_status study_write_plan(FILE *json, const study_source *source, int index);

// Writes the sensitivities of chosen results to all factors, as items of a list.
// @return LD_OK, LD_ERR_MEMORY
ld_status study_write_sensitivities(FILE *json, study_source *source);

// Writes the measured shots and, of each result, how far each series is from them: an object, or
// null where there are none.
// @return LD_OK, LD_ERR_MEMORY
ld_status study_write_measured(FILE *json, study_source *source);

// Writes all that the page shows as JSON; notes what cannot be read.
// @return LD_OK, LD_ERR_MEMORY
ld_status study_write_data(FILE *json, study_source *source);

#endif
