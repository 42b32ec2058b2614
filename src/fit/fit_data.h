// Measured launches as a fit compares them: those alike in one, by the means of their results with
// the matrix of weights that the launches give these.
#ifndef LD_FIT_DATA_H
#define LD_FIT_DATA_H

#include "model/fields/field.h"
#include "quantities/study_results.h"
#include "studies/show/measured.h"

enum { FIT_MOST_RESULTS = 64, FIT_MOST_SETTINGS = 32, FIT_MOST_LAUNCHES = 100000 };

// A result that was measured.
typedef struct fit_result {
    char name[MEASURED_NAME];
    char unit[MEASURED_UNIT]; // as the first file has it
    double factor;            // from that to SI
    bool estimated;           // its uncertainty is that of launches alike, not a column
    size_t values;            // that were measured
    double misfit;            // sum of ((value - mean of launches alike)/uncertainty)^2, and how
    size_t misfit_freedom;    // many values that is of beyond the means; of an estimated one 0
} fit_result;

// Launches under the same settings: one is simulated.
typedef struct fit_launch {
    size_t rows;                       // how many
    double setting[FIT_MOST_SETTINGS]; // SI
    int cells;                         // results that were measured
    int first;                         // number of their first residual
    int result[FIT_MOST_RESULTS];      // [cells]
    double mean[FIT_MOST_RESULTS];     // [cells] SI, weighted
    double *root; // [cells][cells], lower: weights root root^T; residuals are root^T (f - mean)
} fit_launch;

typedef struct fit_data {
    quantity_things things; // of the model
    const ld_model *model;
    int results, settings;
    fit_result result[FIT_MOST_RESULTS];
    field_place setting[FIT_MOST_SETTINGS]; // keys of the scenario that columns set
    size_t rows, launches;
    fit_launch *launch; // [launches] in the order of the first of each
    int residuals;      // cells of all, and samples and results of logs
    int estimated;      // results whose uncertainty is estimated, together with its correlations
    int freedom;        // of the estimate: launches beyond one of each setting
} fit_data;

// Reads files of launches: results, their uncertainties NAME_u, keys of the scenario, with units
// (docs/fit.md).
// @param data to be freed in any case
// @return LD_OK, LD_ERR_INPUT, LD_ERR_FILE, LD_ERR_MEMORY
ld_status fit_data_read(const ld_model *model, const char *const *files, size_t count,
                        fit_data *data, ld_error *error);
void fit_data_free(fit_data *data);

// The number of the launch under the scenario's own values, which is added where there is none.
// @return LD_OK, LD_ERR_MEMORY
ld_status fit_data_own_launch(fit_data *data, int *number, ld_error *error);

#endif
