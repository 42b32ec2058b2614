// What is shown of a study, found: for those who print it.
#ifndef LD_STUDIES_SHOWN_H
#define LD_STUDIES_SHOWN_H

#include "launchdyn/study.h"
#include "studies/points/footprint.h"
#include "studies/show/show_against.h"
#include "studies/show/show_measured.h"
#include "studies/statistics/normality.h"
#include "studies/statistics/statistics.h"
#include "studies/store/study_data.h"

typedef struct shown {
    const study_data *data;
    const ld_study_view *view;
    const char *statistic; // that is asked for; NULL: none
    FILE *stream;
    measured launches;           // beside which the study is shown, or none
    against reference;           // against which points are shown, or none
    show_against pairs;          // with those
    const study_column **column; // [count] what is shown
    int count;
    group_statistics *of; // [points][count]
    study_values values;  // read last
} shown;

// Adds results to a list with room for all, each once: those that the text names, with commas
// between; of a usual choice those that there are; the scenario's measures.
ld_status shown_add(const study_data *data, const char *names, const study_column **list,
                    int *count, ld_error *error);
ld_status shown_add_usual(const study_data *data, const char *names, const study_column **list,
                          int *count, ld_error *error);
void shown_add_measures(const study_data *data, const study_column **list, int *count);

// Chooses what the view asks for, and computes the statistics of all points.
ld_status shown_choose(shown *self, ld_error *error);
ld_status shown_compute(shown *self, ld_error *error);

// Of the point: [count].
group_statistics *shown_statistics(const shown *self, const study_point *point);

// The share of the variance of the shown result that each factor of the study explains, in the
// order of the study's columns; one result's columns are read at a time.
ld_status shown_sensitivities(shown *self, const study_point *point, int result, estimate *share,
                              ld_error *error);

// Rockets that leave with rates off by more than EXIT_ERROR_NOTED; that leave near the vertical.
typedef struct shown_share {
    const char *result;
    bool (*counts)(double value);
} shown_share;
extern const shown_share shown_uncertain, shown_vertical;

// Of how many rockets the result is known, and how many of these count.
ld_status shown_share_of(shown *self, const study_point *point, const shown_share *share,
                         size_t *known, size_t *above, ld_error *error);

// The ellipse of two results that go together, with the intervals of its semi-axes, and whether the
// cloud may be normal.
typedef struct shown_ellipse {
    const study_column *column[2];
    covariance_ellipse of;
    estimate axis[2];
    normality form;
    size_t count; // rockets with both; 0: there is no ellipse
} shown_ellipse;

// Ellipse `index` below STUDY_PAIRS, where both results are shown.
ld_status shown_ellipse_of(shown *self, const study_point *point, size_t index,
                           shown_ellipse *ellipse, ld_error *error);

// The footprints of the landing points, where both results are shown, or of the line, where its
// reach is; their count is 0 where there are none.
ld_status shown_footprint_of(shown *self, const study_point *point, footprint_kind kind,
                             footprint *of, ld_error *error);

#endif
