// What a report of studies lays side by side, and how it is read.
#ifndef LD_REPORT_REPORT_STUDY_SOURCE_H
#define LD_REPORT_REPORT_STUDY_SOURCE_H

#include "launchdyn/study.h"
#include "report/report_html.h"
#include "studies/show/measured.h"
#include "studies/store/study_data.h"

// More series than REPORT_OVERLAID are drawn as columns: their histograms are left out.
enum { REPORT_SERIES = 40, REPORT_OVERLAID = 4 };

// A study, or one point of its sweep.
typedef struct study_series {
    const study_data *data;
    const study_point *point;
    char label[256];
    study_values values; // of the results at hand
    bool report_broken;  // said already
} study_series;

typedef struct study_source {
    bool several; // folders were named
    int study_count, series_count;
    double share; // of what grows with the number of series, as much as fits
    study_data study[REPORT_SERIES];
    ld_origin origin[REPORT_SERIES]; // of each study; empty where it is not known
    const char *folder[REPORT_SERIES];
    study_series series[REPORT_SERIES];
    const char *measured; // file with launches to lay beside, or NULL
    measured launches;    // what it holds
    ld_report *report;    // takes warnings
    ld_error problem;     // what could not be read, the first; status 0: all could
} study_source;

// Records what could not be read: `what` it is about, and why.
void study_take_problem(study_source *source, const char *what, const ld_error *error);

// Reads columns of a series; of a broken one what can be read, which is said once.
void study_read(study_source *source, study_series *series, const study_column *const *column,
                int columns);

// Reads one or two results of a series into its values; none where it lacks one.
void study_read_values(study_source *source, study_series *series, const char *const *name,
                       int columns);

// Reads where a series' lines lie (study_data_read_line()); none where it has none.
void study_read_line(study_source *source, study_series *series);

#endif
