// What factors do to results as a picture: bars with intervals.
#ifndef LD_STUDIES_PLOT_INFLUENCE_H
#define LD_STUDIES_PLOT_INFLUENCE_H

#include "launchdyn/study.h"
#include "studies/store/study_data.h"

// A chart for each result at each point, as far as there is room on a page.
// @return as ld_study_plot()
ld_status plot_influences(const study_data *data, const ld_study_question *question,
                          const char *file, ld_error *error);

#endif
