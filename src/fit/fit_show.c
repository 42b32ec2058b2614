#include "fit/fit_show.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "math/matrices/dense.h"
#include "studies/show/show_numbers.h"

// p below which residuals are said not to be noise.
static const double level = 0.05;

double fit_cell_deviation(const fit_launch *launch, int cell)
{
    double column[FIT_MOST_RESULTS] = {0};
    column[cell] = 1;
    cholesky_solve(launch->cells, launch->root, column);
    return sqrt(column[cell]);
}

bool fit_is_untold(const ld_fit *fit, int direction)
{
    const double normal = 1.96, half = 0.5;
    return !(fit->minimum.singular_value[direction] * half > normal);
}

double fit_correlation(const ld_fit *fit, int i, int j)
{
    const double *covariance = fit->minimum.covariance;
    return covariance[i * FIT_MOST_KEYS + j] /
           sqrt(covariance[i * FIT_MOST_KEYS + i] * covariance[j * FIT_MOST_KEYS + j]);
}

double fit_log_offset(const ld_fit *fit, const fit_log *log)
{
    return log->clock_key < 0 ? log->log.clock.offset : fit->estimate[log->clock_key].value;
}

int fit_starts_at_best(const ld_fit *fit)
{
    const double apart = 1;
    const fit_minimum *minimum = &fit->minimum;
    double best = fit->weighed_again ? INFINITY : minimum->best.chi2;
    int count = 0;
    for (int i = 0; i < minimum->starts && fit->weighed_again; i++)
        best = fmin(best, minimum->start[i].chi2);
    for (int i = 0; i < minimum->starts; i++)
        count += minimum->start[i].chi2 - best < apart;
    return count;
}

static void print_chance(FILE *stream, double chance)
{
    if (chance < 5e-4)
        fputs("p < 0.001", stream);
    else
        fprintf(stream, "p %.3f", chance);
}

static const char *plural(long long count)
{
    return count == 1 ? "" : "s";
}

// Whether the residuals are noise, in a sentence or two.
static void print_verdict(const ld_fit *fit, FILE *stream)
{
    const fit_quality *quality = &fit->quality;
    fprintf(stream, "chi2 %.4g, %d degree%s of freedom", quality->chi2,
            quality->freedom > 0 ? quality->freedom : 0, plural(quality->freedom));
    if (!isnan(quality->chance)) {
        fputs(", ", stream);
        print_chance(stream, quality->chance);
    }
    if (isnan(quality->chance))
        fputs(": as many keys as results, no test\n", stream);
    else if (quality->chance < level)
        fputs(": the residuals are not noise. The model or the uncertainties are wrong, and the "
              "intervals with them\n",
              stream);
    else
        fputs(": the residuals may be noise\n", stream);
    if (quality->misfit_chance < level) {
        fprintf(stream,
                "launches alike differ by more than their uncertainties: chi2 %.4g, %zu "
                "degree%s of freedom, ",
                quality->misfit, quality->misfit_freedom,
                plural((long long)quality->misfit_freedom));
        print_chance(stream, quality->misfit_chance);
        fputs("\n", stream);
    }
}

static void print_head(const ld_fit *fit, FILE *stream)
{
    const fit_data *data = &fit->data;
    size_t samples = fit_log_samples(fit->log, fit->logs);
    fprintf(stream, "%d key%s fitted to ", fit->keys, plural(fit->keys));
    if (data->rows > 0)
        fprintf(stream, "%d result%s of %zu launch%s", data->results, plural(data->results),
                data->rows, data->rows == 1 ? "" : "es");
    if (data->rows > 0 && data->launches > 1)
        fprintf(stream, " under %zu settings", data->launches);
    if (fit->logs > 0)
        fprintf(stream, "%s%zu sample%s of %d log%s", data->rows > 0 ? ", " : "", samples,
                plural((long long)samples), fit->logs, plural(fit->logs));
    fprintf(stream, "; %lld launches simulated\n", (long long)fit->simulated);
    print_verdict(fit, stream);
    if (data->estimated > 0)
        fprintf(stream,
                "uncertainties of %d result%s: from the scatter of launches alike, %d degree%s of "
                "freedom\n",
                data->estimated, plural(data->estimated), data->freedom, plural(data->freedom));
    fprintf(stream, "%d of %d start%s end here\n\n", fit_starts_at_best(fit), fit->minimum.starts,
            plural(fit->minimum.starts));
}

static void print_key(const fit_key *key, const fit_estimate *found, int width, FILE *stream)
{
    double to = 1 / key->shown_factor;
    double spread = found->deviation > 0 ? found->deviation : found->high - found->low;
    int digits = show_digits(found->value, spread, 3);
    show_name(stream, width, key->name, key->shown_unit);
    show_number(stream, 12, found->value * to, digits);
    show_number(stream, 12, found->deviation * to, 2);
    const double end[2] = {found->low, found->high};
    for (int side = 0; side < 2; side++) {
        show_number(stream, 14, end[side] * to, digits);
        fputs(found->open[side] ? "*" : " ", stream);
    }
    fprintf(stream, "  %.6g to %.6g%s\n", key->low * to, (key->low + key->width) * to,
            found->at_bound ? ", at its bound" : "");
}

static int name_width(const ld_fit *fit)
{
    int width = SHOW_NAME;
    for (int i = 0; i < fit->keys; i++) {
        int length = (int)(strlen(fit->key[i].name) + strlen(fit->key[i].shown_unit) + 3);
        width = length > width ? length : width;
    }
    return width;
}

static void print_keys(const ld_fit *fit, FILE *stream)
{
    int width = name_width(fit), open = 0;
    fprintf(stream, "%-*s%12s%12s%14s%15s   bounds\n", width, "key", "value", "deviation",
            "95 % from", "to");
    for (int i = 0; i < fit->keys; i++) {
        print_key(&fit->key[i], &fit->estimate[i], width, stream);
        open += fit->estimate[i].open[0] || fit->estimate[i].open[1];
    }
    if (open > 0)
        fputs("* the interval reaches the bound\n", stream);
    if (fit->rough > 0)
        fprintf(
            stream,
            "interval%s of %d key%s by the deviation%s: chi2 is too rough for a profile; reduce "
            "run.tolerance\n",
            plural(fit->rough), fit->rough, plural(fit->rough), plural(fit->rough));
}

static void print_correlations(const ld_fit *fit, FILE *stream)
{
    const double strong = 0.9;
    for (int i = 0; i < fit->keys; i++)
        for (int j = 0; j < i; j++)
            if (fabs(fit_correlation(fit, i, j)) >= strong)
                fprintf(stream, "correlation %+.3f of %s and %s\n", fit_correlation(fit, i, j),
                        fit->key[j].name, fit->key[i].name);
}

// Combinations of keys in the order in which the data tell them.
static void print_directions(const ld_fit *fit, FILE *stream)
{
    const double small = 0.1;
    fputs("\nwhat the data tell: combinations of the keys, each in widths of its bounds, with the "
          "combination's deviation\n",
          stream);
    for (int k = 0; k < fit->keys; k++) {
        double value = fit->minimum.singular_value[k];
        if (value > 1e-6)
            show_number(stream, 10, 1 / value, 2);
        else
            fprintf(stream, "%10s", "-");
        fprintf(stream, " %-8s", fit_is_untold(fit, k) ? "not told" : "");
        for (int i = 0; i < fit->keys; i++)
            if (fabs(fit->minimum.direction[k][i]) >= small)
                fprintf(stream, " %+.2f %s", fit->minimum.direction[k][i], fit->key[i].name);
        fputs("\n", stream);
    }
}

static void print_head_of_results(FILE *stream)
{
    fprintf(stream, "\n%-*s%14s%14s%14s\n", SHOW_NAME, "result", "measured", "fitted",
            "difference/u");
}

// Of launches alike: measured, fitted, their difference.
static void print_only_launch(const ld_fit *fit, FILE *stream)
{
    const fit_launch *launch = &fit->data.launch[0];
    print_head_of_results(stream);
    for (int i = 0; i < launch->cells; i++) {
        const fit_result *result = &fit->data.result[launch->result[i]];
        double u = fit_cell_deviation(launch, i), fitted = fit->fitted[launch->first + i];
        int digits = show_digits(launch->mean[i], u, 4);
        show_name(stream, SHOW_NAME, result->name, result->unit);
        show_number(stream, 14, launch->mean[i] / result->factor, digits);
        show_number(stream, 14, fitted / result->factor, digits);
        show_number(stream, 14, (launch->mean[i] - fitted) / u, 3);
        fputs("\n", stream);
    }
}

// Of several: how far they are apart.
static void print_result(const ld_fit *fit, int number, FILE *stream)
{
    const fit_result *result = &fit->data.result[number];
    double square = 0, sum = 0, most = 0;
    int count = 0;
    for (size_t c = 0; c < fit->data.launches; c++) {
        const fit_launch *launch = &fit->data.launch[c];
        for (int i = 0; i < launch->cells; i++) {
            if (launch->result[i] != number)
                continue;
            double apart =
                (launch->mean[i] - fit->fitted[launch->first + i]) / fit_cell_deviation(launch, i);
            count++;
            sum += apart;
            square += apart * apart;
            most = fabs(apart) > fabs(most) ? apart : most;
        }
    }
    show_name(stream, SHOW_NAME, result->name, "");
    fprintf(stream, "%14d", count);
    show_number(stream, 14, sum / count, 3);
    show_number(stream, 14, sqrt(square / count), 3);
    show_number(stream, 14, most, 3);
    fputs("\n", stream);
}

static void print_results(const ld_fit *fit, FILE *stream)
{
    fprintf(stream, "\n%-*s%14s%14s%14s%14s\n", SHOW_NAME, "(measured - fitted)/u", "settings",
            "mean", "rms", "largest");
    for (int i = 0; i < fit->data.results; i++)
        print_result(fit, i, stream);
}

// Series of logs: how far readings are apart, in units of the noise of a sample.
static void print_series(const ld_fit *fit, FILE *stream)
{
    fprintf(stream, "\n%-*s%14s%14s%14s%14s\n", SHOW_NAME, "(measured - fitted)/noise", "samples",
            "independent", "mean", "rms");
    for (int i = 0; i < fit->logs; i++)
        for (int k = 0; k < fit->log[i].log.sensors; k++) {
            const fit_series *series = &fit->log[i].series[k];
            const double *fitted = &fit->fitted[series->first];
            double sum = 0, square = 0, n = (double)series->count;
            for (size_t j = 0; j < series->count; j++) {
                double apart = (series->value[j] - fitted[j]) / series->noise;
                sum += apart;
                square += apart * apart;
            }
            show_name(stream, SHOW_NAME, fit->log[i].log.sensor[k].column, "");
            fprintf(stream, "%14zu%14.0f", series->count, n / series->correlation);
            show_number(stream, 14, sum / n, 3);
            show_number(stream, 14, sqrt(square / n), 3);
            fputs("\n", stream);
        }
}

static void print_scalars(const ld_fit *fit, FILE *stream)
{
    int count = 0;
    for (int i = 0; i < fit->logs; i++)
        for (int k = 0; k < fit->log[i].scalars; k++) {
            const fit_scalar *scalar = &fit->log[i].scalar[k];
            double fitted = fit->fitted[scalar->residual];
            int digits = show_digits(scalar->measured, scalar->uncertainty, 4);
            if (count++ == 0)
                print_head_of_results(stream);
            show_name(stream, SHOW_NAME, scalar->name, scalar->unit);
            show_number(stream, 14, scalar->measured, digits);
            show_number(stream, 14, fitted, digits);
            show_number(stream, 14, (scalar->measured - fitted) / scalar->uncertainty, 3);
            fputs("\n", stream);
        }
}

void ld_fit_print(const ld_fit *fit, FILE *stream)
{
    if (!fit->done)
        return;
    print_head(fit, stream);
    print_keys(fit, stream);
    print_correlations(fit, stream);
    print_directions(fit, stream);
    if (fit->data.results > 0 && fit->data.launches == 1)
        print_only_launch(fit, stream);
    else if (fit->data.results > 0)
        print_results(fit, stream);
    print_scalars(fit, stream);
    if (fit->logs > 0)
        print_series(fit, stream);
}
