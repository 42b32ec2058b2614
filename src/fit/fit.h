// A fit: keys, data, and what was found.
#ifndef LD_FIT_H
#define LD_FIT_H

#include "fit/fit_data.h"
#include "fit/fit_log.h"
#include "fit/minimum.h"
#include "launchdyn/fit.h"

enum { FIT_KEY_NAME = LD_MAX_PATH };

// A key of the scenario, or after those what is not known of a log's clock or sensor.
typedef struct fit_key {
    char name[FIT_KEY_NAME];
    field_place place;   // of a key of the scenario
    const char *unit;    // SI
    char shown_unit[32]; // as its bounds were given, and the factor from that to SI
    double shown_factor;
    double low, width;      // SI
    double mean, deviation; // SI; deviation infinite: no prior
    double start;           // SI; of a key of the scenario its value there
} fit_key;

// What a fit says of a key, in SI.
typedef struct fit_estimate {
    double value, deviation; // NaN: at its bound, or untold
    double low, high;        // of the 95 % interval
    bool open[2];            // that end is the bound
    bool at_bound;
    bool by_deviation; // the interval, for the profile found lower minima to the end
} fit_estimate;

// How far simulated means are from measured ones, and whether noise alone would be as far.
typedef struct fit_quality {
    double chi2;   // of data and priors
    int freedom;   // results and priors beyond the keys
    double chance; // of a chi2 this large, of noise alone; NaN without freedom
    double misfit; // of launches alike whose uncertainties are given
    size_t misfit_freedom;
    double misfit_chance;
} fit_quality;

struct ld_fit {
    const ld_model *model;
    int keys, own_keys; // own: of the scenario, which come first
    fit_key key[FIT_MOST_KEYS];
    fit_data data;
    int logs, log_launch; // launch of the data that the logs are of
    fit_log log[FIT_MOST_LOGS];
    fit_minimum minimum;
    bool weighed_again; // for correlated residuals of series: chi2 of starts is of before
    int rough;          // keys whose profile found lower minima to the end
    int64_t simulated;  // launches
    double inflation, inflated_freedom; // of the covariance, of Student's t; infinite: normal
    double level;                       // rise of chi2 at the ends of intervals
    fit_estimate estimate[FIT_MOST_KEYS];
    fit_quality quality;
    double *fitted; // [residuals] simulated results at the best fit, SI
    bool done;
};

static inline double fit_key_value(const fit_key *key, double p)
{
    return key->low + p * key->width;
}

// Writes fit.json and fitted.yaml into a folder that is there.
ld_status fit_write(const ld_fit *fit, const char *folder, ld_error *error);

#endif
