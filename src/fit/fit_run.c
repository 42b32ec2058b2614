#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "fit/fit_launches.h"
#include "math/curves/distributions.h"
#include "math/functions.h"
#include "results/folder.h"

enum { USUAL_STARTS = 4 };

// Keys of the cube, as the fit's scaled bounds have them.
typedef struct cube {
    double mean[FIT_MOST_KEYS], deviation[FIT_MOST_KEYS], first[FIT_MOST_KEYS];
    uint64_t stream[FIT_MOST_KEYS];
} cube;

static cube make_cube(const ld_fit *self)
{
    cube made;
    for (int i = 0; i < self->keys; i++) {
        const fit_key *key = &self->key[i];
        double now = (key->start - key->low) / key->width;
        made.mean[i] = (key->mean - key->low) / key->width;
        made.deviation[i] = key->deviation / key->width;
        made.first[i] = now >= 0 && now <= 1 ? now : 0.5;
        made.stream[i] = random_stream(key->name);
    }
    return made;
}

// ---- what is refused

static ld_status check_data(const ld_fit *self, ld_error *error)
{
    int without_prior = 0;
    for (int i = 0; i < self->keys; i++)
        without_prior += isinf(self->key[i].deviation);
    if (self->data.residuals == 0)
        return ld_fail(error, LD_ERR_INPUT, "expected a file of measured launches or a log");
    if (without_prior <= self->data.residuals)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "%d keys without a prior, but %d measured results: expected as many results",
                   without_prior, self->data.residuals);
}

static ld_status refuse_idle(const ld_fit *self, const fit_problem *problem, const cube *keys,
                             ld_error *error)
{
    bool idle[FIT_MOST_KEYS] = {false};
    problem->stage(problem->self, "effect of each key", NAN);
    ld_status status = fit_find_idle(problem, keys->first, idle, error);
    for (int i = 0; i < self->keys && !status; i++)
        if (idle[i] && (i < self->own_keys || isinf(self->key[i].deviation)))
            status =
                ld_fail(error, LD_ERR_INPUT,
                        "%s changes none of the measured results: leave it out", self->key[i].name);
    return status;
}

// ---- what the noise is

static int count_priors(const ld_fit *self)
{
    int count = 0;
    for (int i = 0; i < self->keys; i++)
        count += isfinite(self->key[i].deviation);
    return count;
}

// Of an estimated covariance of k results by nu launches beyond the first: Hotelling's T^2.
static double chance_of(const ld_fit *self)
{
    const fit_quality *quality = &self->quality;
    int freedom = quality->freedom, known = self->data.freedom;
    if (freedom <= 0)
        return NAN;
    if (self->data.estimated == 0 || known < freedom)
        return chi_square_beyond(quality->chi2, freedom);
    double rest = known - freedom + 1;
    return fisher_beyond(quality->chi2 * rest / (known * (double)freedom), freedom, rest);
}

// Independent residuals: of a series its samples over the sum of their correlation.
static int count_independent(const ld_fit *self)
{
    double count = 0;
    for (int i = 0; i < self->logs; i++)
        for (int k = 0; k < self->log[i].log.sensors; k++)
            count += (double)self->log[i].series[k].count / self->log[i].series[k].correlation;
    return self->data.residuals - (int)fit_log_samples(self->log, self->logs) + (int)count;
}

static void find_quality(ld_fit *self)
{
    fit_quality *quality = &self->quality;
    const fit_data *data = &self->data;
    *quality = (fit_quality){.chi2 = self->minimum.best.chi2,
                             .freedom = count_independent(self) + count_priors(self) - self->keys,
                             .misfit_chance = NAN};
    for (int i = 0; i < self->keys; i++)
        quality->freedom += self->minimum.at_bound[i];
    quality->chance = chance_of(self);
    for (int i = 0; i < data->results; i++) {
        quality->misfit += data->result[i].misfit;
        quality->misfit_freedom += data->result[i].misfit_freedom;
    }
    if (quality->misfit_freedom > 0)
        quality->misfit_chance =
            chi_square_beyond(quality->misfit, (double)quality->misfit_freedom);
}

// By how much an estimated covariance makes the intervals wider. Exact for launches alike and a
// linear model (C. R. Rao, Biometrika 46, 1959): with q results beyond the keys the weights use up
// q of the nu degrees of freedom, and the key's covariance grows by 1 + T^2/nu. Launches under
// several settings share one covariance of k results: there q is at most k - 1, and T^2 its mean q.
static void find_inflation(ld_fit *self)
{
    const fit_data *data = &self->data;
    self->inflation = 1;
    self->inflated_freedom = INFINITY;
    if (data->estimated == 0)
        return;
    bool alike = data->launches == 1 && data->estimated == data->results && self->logs == 0;
    int beyond = self->quality.freedom > 0 ? self->quality.freedom : 0;
    int most = data->estimated - 1, used = beyond < most ? beyond : most;
    double known = data->freedom, square = alike ? self->quality.chi2 : used;
    self->inflated_freedom = known - used;
    self->inflation = known / (known - used) * (1 + square / known);
}

// ---- keys

static double interval_factor(const ld_fit *self)
{
    const double upper = 0.975;
    double normal = normal_quantile(upper);
    double student =
        isinf(self->inflated_freedom) ? normal : student_quantile(upper, self->inflated_freedom);
    return student * sqrt(self->inflation);
}

// The interval of a key by its deviation; at its bound there is none.
static void fill_interval(ld_fit *self, int i, double deviation)
{
    const fit_key *key = &self->key[i];
    fit_estimate *found = &self->estimate[i];
    double half = interval_factor(self) * deviation, high = key->low + key->width;
    found->open[0] = !(found->value - half > key->low);
    found->open[1] = !(found->value + half < high);
    found->low = found->open[0] ? key->low : found->value - half;
    found->high = found->open[1] ? high : found->value + half;
}

static void fill_estimates(ld_fit *self)
{
    for (int i = 0; i < self->keys; i++) {
        const fit_key *key = &self->key[i];
        double variance = self->minimum.covariance[i * FIT_MOST_KEYS + i];
        fit_estimate *found = &self->estimate[i];
        found->value = fit_key_value(key, self->minimum.best.p[i]);
        found->at_bound = self->minimum.at_bound[i];
        found->deviation = key->width * sqrt(variance * self->inflation);
        if (i >= self->own_keys || found->by_deviation)
            fill_interval(self, i, key->width * sqrt(variance));
    }
}

// The profile of a key; its interval, unless a lower minimum was found.
static ld_status find_interval(ld_fit *self, const fit_problem *problem, int i, bool *lower,
                               ld_error *error)
{
    fit_end end[2];
    fit_estimate *found = &self->estimate[i];
    char text[LD_MAX_PATH + 16];
    snprintf(text, sizeof text, "interval of %s", self->key[i].name);
    problem->stage(problem->self, text, self->minimum.best.chi2);
    ld_status status =
        fit_profile(problem, &self->minimum, i, interval_factor(self), end, lower, error);
    for (int side = 0; side < 2 && !status && !*lower; side++) {
        *(side ? &found->high : &found->low) = fit_key_value(&self->key[i], end[side].p);
        found->open[side] = end[side].open;
    }
    return status;
}

// Where profiles find lower minima again and again, the intervals of their keys follow from the
// deviations.
static ld_status find_intervals(ld_fit *self, const fit_problem *problem, ld_error *error)
{
    enum { TIMES = 5 };
    ld_status status = LD_OK;
    bool lower = true;
    self->rough = 0;
    for (int time = 1; time <= TIMES && lower && !status; time++) {
        find_quality(self);
        find_inflation(self);
        lower = false;
        for (int i = 0; i < self->own_keys && !status && !lower; i++) {
            status = find_interval(self, problem, i, &lower, error);
            self->estimate[i].by_deviation = lower;
            self->rough += lower && time == TIMES;
            lower = lower && time < TIMES;
        }
    }
    find_quality(self);
    self->level = interval_factor(self) * interval_factor(self);
    fill_estimates(self);
    return status;
}

// Simulated readings and results of a log.
static void fill_fitted_log(ld_fit *self, const fit_log *log)
{
    const double *residual = self->minimum.best.residual;
    for (int k = 0; k < log->log.sensors; k++) {
        const fit_series *series = &log->series[k];
        double unit = series->noise * sqrt(series->correlation);
        for (size_t i = 0; i < series->count; i++) {
            size_t at = (size_t)series->first + i;
            self->fitted[at] = series->value[i] + residual[at] * unit;
        }
    }
    for (int i = 0; i < log->scalars; i++) {
        const fit_scalar *scalar = &log->scalar[i];
        self->fitted[scalar->residual] =
            scalar->measured + residual[scalar->residual] * scalar->uncertainty;
    }
}

// Simulated results, from the residuals: f = mean + root^-T residual.
static ld_status fill_fitted(ld_fit *self, ld_error *error)
{
    free(self->fitted);
    self->fitted = calloc((size_t)self->data.residuals + 1, sizeof *self->fitted);
    if (!self->fitted)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the fitted results");
    for (size_t c = 0; c < self->data.launches; c++) {
        const fit_launch *launch = &self->data.launch[c];
        double apart[FIT_MOST_RESULTS];
        int n = launch->cells;
        for (int i = n - 1; i >= 0; i--) {
            apart[i] = self->minimum.best.residual[launch->first + i];
            for (int j = i + 1; j < n; j++)
                apart[i] -= launch->root[j * n + i] * apart[j];
            apart[i] /= launch->root[i * n + i];
            self->fitted[launch->first + i] = launch->mean[i] + apart[i];
        }
    }
    for (int i = 0; i < self->logs; i++)
        fill_fitted_log(self, &self->log[i]);
    return LD_OK;
}

// ---- correlated residuals

// Weighs series whose residuals are correlated by their independent samples. *changed: there are.
static void weigh_correlated(ld_fit *self, bool *changed)
{
    *changed = false;
    for (int i = 0; i < self->logs; i++)
        for (int k = 0; k < self->log[i].log.sensors; k++) {
            fit_series *series = &self->log[i].series[k];
            series->correlation =
                fit_correlation_sum(&self->minimum.best.residual[series->first], series->count);
            *changed = *changed || series->correlation > 1;
        }
}

// ---- from begin to end

static ld_status fit_keys(ld_fit *self, fit_launches *launches, ld_error *error)
{
    const cube keys = make_cube(self);
    const fit_problem problem = {.keys = self->keys,
                                 .residuals = self->data.residuals,
                                 .steady = self->keys - self->own_keys,
                                 .prior_mean = keys.mean,
                                 .prior_deviation = keys.deviation,
                                 .evaluate = fit_launches_evaluate,
                                 .stage = fit_launches_stage,
                                 .self = launches};
    const ld_fit_options *options = launches->options;
    fit_minimum_free(&self->minimum);
    self->weighed_again = false;
    for (int i = 0; i < self->logs; i++)
        for (int k = 0; k < self->log[i].log.sensors; k++)
            self->log[i].series[k].correlation = 1;
    ld_status status = refuse_idle(self, &problem, &keys, error);
    if (!status)
        status = fit_minimise(&problem, options->starts, keys.first, (uint64_t)options->seed,
                              keys.stream, &self->minimum, error);
    if (status == LD_ERR_LAUNCH && launches->reason[0]) {
        const ld_error why = *error;
        return ld_fail(error, status, "%.300s; first: %.600s", why.text, launches->reason);
    }
    if (!status)
        weigh_correlated(self, &self->weighed_again);
    if (!status && self->weighed_again)
        status = fit_minimise_again(&problem, &self->minimum, error);
    if (!status)
        status = find_intervals(self, &problem, error);
    return status ? status : fill_fitted(self, error);
}

static ld_status tell_interrupted(const fit_launches *launches, ld_error *error)
{
    return ld_fail(error, LD_ERR_INTERRUPTED, "interrupted after %lld launches%s",
                   (long long)launches->counts.launches,
                   launches->options->folder ? "; the same command continues" : "");
}

ld_status ld_fit_run(ld_fit *self, const ld_fit_options *given, ld_error *error)
{
    assert(self);
    ld_error own;
    fit_launches launches;
    ld_fit_options options = given ? *given : (ld_fit_options){0};
    error = error ? error : &own;
    options.starts = options.starts ? options.starts : USUAL_STARTS;
    if (options.starts < 1 || options.starts > FIT_MOST_STARTS)
        return ld_fail(error, LD_ERR_INPUT, "expected 1 to %d starts", FIT_MOST_STARTS);
    ld_status status = check_data(self, error);
    if (!status && options.folder)
        status = folder_ensure(options.folder, error);
    if (status)
        return status;
    self->done = false;
    status = fit_launches_open(&launches, self, &options, error);
    if (!status)
        status = fit_keys(self, &launches, error);
    if (status == LD_ERR_INTERRUPTED)
        status = tell_interrupted(&launches, error);
    self->simulated = launches.counts.launches;
    self->done = !status;
    if (!status && options.folder)
        status = fit_write(self, options.folder, error);
    fit_launches_close(&launches);
    return status;
}
