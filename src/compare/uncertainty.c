#include "compare/uncertainty.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare/evaluation.h"
#include "compare/further_runs.h"
#include "launchdyn/scenario.h"
#include "launchdyn/study_data.h"
#include "launchdyn/summary.h"
#include "model/model.h"

// ---- further runs

// What is done with the values of a run.
typedef struct run_observer {
    ld_comparison *comparison;
    run_values now;
    run_values sum; // of squares of changes; of samples their sums
    run_values mean;
    int count;
} run_observer;

static size_t numbers_of(const ld_comparison *self)
{
    return (size_t)self->log.sensors * self->log.rows;
}

// Values of which none is known.
static ld_status make_unknown(run_values *values, const measured_log *log, ld_error *error)
{
    ld_status status = run_values_make(values, log, error);
    for (size_t i = 0; !status && i < (size_t)log->sensors * log->rows; i++)
        values->reading[i] = NAN;
    for (int k = 0; !status && k < log->results; k++)
        values->result[k] = NAN;
    return status;
}

static void take_unit(void *data, const ld_quantity *quantity)
{
    ld_comparison *self = data;
    char path[LD_MAX_QUANTITY + 32];
    for (int k = 0; k < self->log.results; k++) {
        snprintf(path, sizeof path, "rocket.%d.%.95s", self->rocket, self->log.result[k].of);
        if (self->log.result[k].take == TAKE_RESULT && strcmp(path, quantity->name) == 0)
            snprintf(self->result_head[k].unit, CSV_UNIT, "%s",
                     strcmp(quantity->unit, "1") == 0 ? "" : quantity->unit);
    }
}

// The estimate that a run makes of its own integration error, of the rates at the exit; NaN: none.
static double own_error(const ld_summary *summary, int rocket, const char *result)
{
    char path[64];
    double error;
    size_t length = strlen(result);
    bool rate = length > 5 && strcmp(result + length - 5, "_rate") == 0;
    bool against =
        strncmp(result, "tip_off.", 8) == 0 || strncmp(result, "since_ignition.", 15) == 0;
    snprintf(path, sizeof path, "rocket.%d.exit_error.%s", rocket, against ? "rates" : "yaw_rate");
    if (!(rate && against) && strcmp(result, "yaw_rate") != 0)
        return NAN;
    return ld_summary_number(summary, path, &error, NULL) ? NAN : error;
}

// The numbers that the nominal run's history does not hold, with their units.
static ld_status take_nominal(void *data, const run_series *run, const ld_summary *summary,
                              ld_error *error)
{
    ld_comparison *self = ((run_observer *)data)->comparison;
    char path[LD_MAX_QUANTITY + 32];
    (void)run;
    ld_summary_each(summary, take_unit, self);
    ld_status status = make_unknown(&self->u_num, &self->log, error);
    for (int k = 0; k < self->log.results && !status; k++) {
        const log_result *result = &self->log.result[k];
        if (result->take != TAKE_RESULT || comparison_instant(result->of) >= 0)
            continue;
        snprintf(path, sizeof path, "rocket.%d.%.95s", self->rocket, result->of);
        status = ld_summary_number(summary, path, &self->nominal.result[k], error);
        self->u_num.result[k] = own_error(summary, self->rocket, result->of);
    }
    return status;
}

// Adds the squares of the changes from the nominal run.
static ld_status take_refined(void *data, const run_series *run, const ld_summary *summary,
                              ld_error *error)
{
    run_observer *self = data;
    const ld_comparison *comparison = self->comparison;
    ld_status status = comparison_evaluate(comparison, run, summary, &self->now, error);
    for (size_t i = 0; i < numbers_of(comparison) && !status; i++) {
        double change = self->now.reading[i] - comparison->nominal.reading[i];
        self->sum.reading[i] += change * change;
    }
    for (int k = 0; k < comparison->log.results && !status; k++) {
        double change = self->now.result[k] - comparison->nominal.result[k];
        self->sum.result[k] += change * change;
    }
    self->count += !status;
    return status;
}

static void add_number(double now, int count, double *mean, double *squares)
{
    double before = now - *mean;
    *mean += before / count;
    *squares += before * (now - *mean);
}

// Mean and squares of what samples give (Welford).
static ld_status take_sample(void *data, const run_series *run, const ld_summary *summary,
                             ld_error *error)
{
    run_observer *self = data;
    const ld_comparison *comparison = self->comparison;
    ld_status status = comparison_evaluate(comparison, run, summary, &self->now, error);
    if (status)
        return status;
    self->count++;
    for (size_t i = 0; i < numbers_of(comparison); i++)
        add_number(self->now.reading[i], self->count, &self->mean.reading[i],
                   &self->sum.reading[i]);
    for (int k = 0; k < comparison->log.results; k++)
        add_number(self->now.result[k], self->count, &self->mean.result[k], &self->sum.result[k]);
    return LD_OK;
}

static ld_status begin_observer(run_observer *self, ld_comparison *comparison, ld_error *error)
{
    *self = (run_observer){.comparison = comparison};
    ld_status status = run_values_make(&self->now, &comparison->log, error);
    if (!status)
        status = run_values_make(&self->sum, &comparison->log, error);
    return status ? status : run_values_make(&self->mean, &comparison->log, error);
}

// Roots of the sums over `count` become the uncertainties.
static void end_observer(run_observer *self, double count, run_values *uncertainty)
{
    if (count > 0) {
        for (size_t i = 0; i < numbers_of(self->comparison); i++)
            self->sum.reading[i] = sqrt(self->sum.reading[i] / count);
        for (int k = 0; k < self->comparison->log.results; k++)
            self->sum.result[k] = sqrt(self->sum.result[k] / count);
        *uncertainty = self->sum;
        self->sum = (run_values){0};
    }
    run_values_free(&self->now);
    run_values_free(&self->sum);
    run_values_free(&self->mean);
}

// Half as many more of the modes.
static int more_modes(int count, int most)
{
    int more = count + (count + 1) / 2;
    return more < most ? more : most;
}

// A run with a tenth of the tolerances, one with half as many modes more.
static ld_status refine(ld_comparison *self, const further_runs *runs, ld_error *error)
{
    char text[4][64];
    const char *const sets[] = {text[0], text[1], text[2], text[3]};
    const ld_run_settings *settings = &runs->model->run;
    const ld_modes *modes = &runs->model->tubes.modes;
    snprintf(text[0], sizeof text[0], "run.tolerance=%.3e", fmax(1e-12, 0.1 * settings->tolerance));
    snprintf(text[1], sizeof text[1], "run.flight_tolerance=%.3e",
             fmax(1e-13, 0.1 * settings->flight_tolerance));
    snprintf(text[2], sizeof text[2], "tubes.modes.bending=%d",
             more_modes(modes->bending, LD_MAX_BENDING_MODES));
    snprintf(text[3], sizeof text[3], "tubes.modes.torsion=%d",
             more_modes(modes->torsion, LD_MAX_TORSION_MODES));
    run_observer observer;
    ld_status status = begin_observer(&observer, self, error);
    if (!status)
        status = further_run(runs, &(run_overrides){sets, 2}, self->rocket, take_refined, &observer,
                             error);
    if (!status && ld_model_has_launcher(runs->model))
        status = further_run(runs, &(run_overrides){sets + 2, 2}, self->rocket, take_refined,
                             &observer, error);
    run_values_free(&self->u_num);
    end_observer(&observer, status ? 0 : 1, &self->u_num);
    return status;
}

static ld_status run_samples(ld_comparison *self, const further_runs *runs, int samples,
                             ld_error *error)
{
    run_observer observer;
    int failed = 0;
    ld_error why;
    ld_status status = begin_observer(&observer, self, error);
    for (int i = 0; i < samples && !status; i++) {
        ld_status ran = further_run_sample(runs, i + 1, self->rocket, take_sample, &observer, &why);
        failed += ran == LD_ERR_LAUNCH || ran == LD_ERR_NUMERIC;
        if (ran && ran != LD_ERR_LAUNCH && ran != LD_ERR_NUMERIC)
            status = ld_fail(error, ran, "%s", why.text);
    }
    int count = observer.count;
    if (!status && count < 2)
        status =
            ld_fail(error, LD_ERR_INPUT,
                    "u_input requires at least 2 samples that run to their end, found %d", count);
    if (!status && failed > 0)
        comparison_note(self, "%d of %d samples did not run to their end and are left out", failed,
                        samples);
    end_observer(&observer, status ? 0 : count - 1, &self->u_input);
    return status;
}

// ---- a study's deviations

static ld_status read_study(ld_comparison *self, const char *folder, ld_error *error)
{
    ld_study_data *data = NULL;
    ld_status status = ld_study_data_open(folder, &data, error);
    if (!status && !self->u_input.result)
        status = make_unknown(&self->u_input, &self->log, error);
    for (int k = 0; k < self->log.results && !status; k++) {
        const ld_study_statistics *statistics;
        const log_result *result = &self->log.result[k];
        if (result->take != TAKE_RESULT)
            continue;
        ld_status found = ld_study_data_statistics(data, 1, result->of, &statistics, error);
        if (!found)
            self->u_input.result[k] = statistics->deviation.value;
        else if (found == LD_ERR_INPUT)
            comparison_note(self, "the study keeps no %.95s: u_input is not known", result->of);
        else
            status = found;
    }
    ld_study_data_close(data);
    return status;
}

static bool needs_summary(const ld_comparison *self)
{
    for (int k = 0; k < self->log.results; k++)
        if (self->log.result[k].take == TAKE_RESULT &&
            comparison_instant(self->log.result[k].of) < 0)
            return true;
    return false;
}

static void note_program(ld_comparison *self, const further_runs *runs)
{
    char differs[128];
    if (ld_origin_differs(&runs->origin, differs, sizeof differs))
        comparison_note(self, "further runs are those of another program than the results': %s",
                        differs);
}

static ld_status make_runs(ld_comparison *self, const char *folder,
                           const ld_compare_options *options, ld_error *error)
{
    further_runs runs;
    const ld_run_options each = {.self = options->self, .progress = options->progress};
    ld_status status = further_runs_open(&runs, folder, &each, error);
    if (status)
        return status;
    note_program(self, &runs);
    run_observer nominal = {.comparison = self};
    if (needs_summary(self))
        status = further_run(&runs, NULL, self->rocket, take_nominal, &nominal, error);
    if (!status && options->refine)
        status = refine(self, &runs, error);
    if (!status && options->samples > 0 && !options->study)
        status = run_samples(self, &runs, options->samples, error);
    further_runs_close(&runs);
    return status;
}

// Studies keep numbers, no series: these come from its first samples, run again.
static ld_status repeat_study(ld_comparison *self, const ld_compare_options *options,
                              ld_error *error)
{
    further_runs runs;
    const ld_run_options each = {.self = options->self, .progress = options->progress};
    ld_status status = further_runs_open_study(&runs, options->study, &each, error);
    if (status)
        return status;
    note_program(self, &runs);
    status = run_samples(self, &runs, options->samples, error);
    further_runs_close(&runs);
    return status;
}

ld_status uncertainty_find(ld_comparison *self, const char *folder,
                           const ld_compare_options *options, ld_error *error)
{
    ld_status status = LD_OK;
    if (needs_summary(self) || options->refine || options->samples > 0)
        status = make_runs(self, folder, options, error);
    if (!status && options->study && options->samples > 0)
        status = repeat_study(self, options, error);
    else if (!status && options->study && self->log.sensors > 0)
        comparison_note(
            self, "u_input of series requires --samples N: N launches of the study are run again");
    if (!status && options->study)
        status = read_study(self, options->study, error);
    return status;
}

// ---- uncertainties

// What counts of an uncertainty that may not be known.
static double square(double uncertainty)
{
    return isnan(uncertainty) ? 0 : uncertainty * uncertainty;
}

static void judge(ld_validation *of)
{
    of->u_val = sqrt(square(of->u_num) + square(of->u_input) + square(of->u_data));
    if (fabs(of->error) > 2 * of->u_val)
        of->verdict = LD_VERDICT_DISAGREE;
    else
        of->verdict = 2 * of->u_val > of->limit ? LD_VERDICT_CANNOT_TELL : LD_VERDICT_AGREE;
}

// Slope of the readings about sample i.
static double slope_at(const ld_comparison *self, const double *reading, size_t i)
{
    size_t last = self->log.rows - 1, before = i > 0 ? i - 1 : 0, after = i < last ? i + 1 : last;
    double dt = self->t[after] - self->t[before];
    return dt > 0 ? (reading[after] - reading[before]) / dt : 0;
}

// Standard uncertainty of what a sensor's samples have in common, where it reads `value` and rises
// with `slope`.
static double common_square(const ld_comparison *self, const sensor *of, double value, double slope)
{
    return square(of->bias_uncertainty) + square(of->scale_uncertainty * (value - of->bias)) +
           square(self->clock.uncertainty * slope);
}

// Of a sample alone.
static double own_square(const sensor *of)
{
    return square(of->noise) + square(of->resolution) / 12;
}

ld_validation uncertainty_of_sample(const ld_comparison *self, int k, size_t i)
{
    const sensor *of = &self->log.sensor[k];
    size_t at = (size_t)k * self->log.rows + i;
    const double *reading = self->nominal.reading + (size_t)k * self->log.rows;
    ld_validation found = {.error = reading[i] - of->value[i],
                           .u_num = self->u_num.reading ? self->u_num.reading[at] : NAN,
                           .u_input = self->u_input.reading ? self->u_input.reading[at] : NAN,
                           .u_data =
                               sqrt(own_square(of) + common_square(self, of, of->value[i],
                                                                   slope_at(self, reading, i)))};
    judge(&found);
    return found;
}

// Squares of an uncertainty's samples, of which none may be known.
typedef struct known_squares {
    double sum;
    bool known;
} known_squares;

static void add_square(known_squares *self, double uncertainty)
{
    self->sum += square(uncertainty);
    self->known = self->known || !isnan(uncertainty);
}

void uncertainty_of_series(const ld_comparison *self, int k, ld_compared_series *series)
{
    const sensor *of = &self->log.sensor[k];
    const char *compared = self->compared + (size_t)k * self->log.rows;
    double error = 0, mean = 0, u_data = 0, size = 0;
    known_squares u_num = {.sum = 0}, u_input = {.sum = 0};
    for (size_t i = 0; i < self->log.rows; i++) {
        if (!compared[i])
            continue;
        ld_validation sample = uncertainty_of_sample(self, k, i);
        mean += sample.error;
        error += sample.error * sample.error;
        add_square(&u_num, sample.u_num);
        add_square(&u_input, sample.u_input);
        u_data += square(sample.u_data);
        size += square(of->value[i]);
        if (!(fabs(sample.error) <= series->largest)) {
            series->largest = fabs(sample.error);
            series->t_largest = self->t[i];
        }
    }
    double n = (double)series->count;
    series->mean = mean / n;
    series->of = (ld_validation){
        .error = sqrt(error / n),
        .u_num = u_num.known ? sqrt(u_num.sum / n) : NAN,
        .u_input = u_input.known ? sqrt(u_input.sum / n) : NAN,
        .u_data = sqrt(u_data / n),
        .limit = isnan(of->limit) ? sqrt(size / n) : of->limit,
    };
    judge(&series->of);
}

// ---- results

static ld_status read_text(const ld_comparison *self, int k, const char *text, double *value,
                           ld_error *error)
{
    ld_error why;
    const ld_compared_result *result = &self->result[k];
    if (!text || !ld_read_quantity(text, result->unit, value, &why))
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT, "results.%d, %.95s: %s", k + 1, result->name, why.text);
}

// u_D of a number taken from a sensor's series: of a mean by what its samples have in common, of a
// value or an extreme besides by one sample's own.
static double data_uncertainty(const ld_comparison *self, const log_result *of, double measured)
{
    const sensor *by = &self->log.sensor[of->sensor];
    double spacing = (self->t[self->log.rows - 1] - self->t[0]) / (double)self->log.rows;
    if (of->take == TAKE_T_MAX || of->take == TAKE_T_MIN)
        return sqrt(square(self->clock.uncertainty) + spacing * spacing / 12);
    double own = own_square(by), common = common_square(self, by, measured, 0);
    if (of->take == TAKE_MEAN || of->take == TAKE_RMS)
        own /= (double)comparison_count(self, of);
    return sqrt(own + common);
}

static ld_status fill_of_series(const ld_comparison *self, int k, ld_compared_result *result,
                                ld_error *error)
{
    const log_result *of = &self->log.result[k];
    const sensor *by = &self->log.sensor[of->sensor];
    bool time = of->take == TAKE_T_MAX || of->take == TAKE_T_MIN;
    result->unit = time ? "s" : by->si;
    result->log_unit = time ? "s" : by->head.unit;
    result->factor = time ? 1 : by->factor;
    result->measured = comparison_take(self, of, by->value);
    if (isnan(result->measured))
        return ld_fail(error, LD_ERR_INPUT, "results.%d, %.95s: no sample lies in its window",
                       k + 1, result->name);
    result->of.u_data = data_uncertainty(self, of, result->measured);
    return LD_OK;
}

static ld_status fill_of_run(ld_comparison *self, int k, ld_compared_result *result,
                             ld_error *error)
{
    const log_result *of = &self->log.result[k];
    csv_column *head = &self->result_head[k];
    if (comparison_instant(of->of) >= 0)
        snprintf(head->unit, sizeof head->unit, "s");
    result->unit = result->log_unit = head->unit;
    result->factor = 1;
    if (isnan(result->simulated))
        return ld_fail(error, LD_ERR_INPUT, "results.%d: the run has no %.95s", k + 1, of->of);
    ld_status status = read_text(self, k, of->measured, &result->measured, error);
    return status ? status : read_text(self, k, of->uncertainty, &result->of.u_data, error);
}

ld_status uncertainty_of_result(ld_comparison *self, int k, ld_compared_result *result,
                                ld_error *error)
{
    const log_result *of = &self->log.result[k];
    result->name = of->name ? of->name : of->of;
    result->simulated = self->nominal.result[k];
    ld_status status = of->take == TAKE_RESULT ? fill_of_run(self, k, result, error)
                                               : fill_of_series(self, k, result, error);
    if (status)
        return status;
    result->of.error = result->simulated - result->measured;
    result->of.u_num = self->u_num.result ? self->u_num.result[k] : NAN;
    result->of.u_input = self->u_input.result ? self->u_input.result[k] : NAN;
    result->of.limit = fabs(result->measured);
    status = read_text(self, k, of->limit, &result->of.limit, error);
    judge(&result->of);
    return status;
}
