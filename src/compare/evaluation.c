#include "compare/evaluation.h"

#include <math.h>
#include <string.h>

#include "compare/sensor_reading.h"
#include "launchdyn/summary.h"

static const char *const instant_names[SERIES_INSTANTS] = {
    "t_ignition", "t_release", "t_front", "t_middle", "t_rear", "t_apogee", "t_impact"};

int comparison_instant(const char *name)
{
    for (int i = 1; i < SERIES_INSTANTS; i++)
        if (strcmp(instant_names[i], name) == 0)
            return i;
    return -1;
}

// ---- numbers of a series

// At time t, linear between the samples around it that count.
static double value_at(const ld_comparison *self, const char *counts, const double *value, double t)
{
    size_t before = SIZE_MAX;
    for (size_t i = 0; i < self->log.rows; i++) {
        if (!counts[i])
            continue;
        if (self->t[i] >= t && before == SIZE_MAX)
            return self->t[i] == t ? value[i] : NAN;
        if (self->t[i] >= t) {
            double share = (t - self->t[before]) / (self->t[i] - self->t[before]);
            return value[before] + share * (value[i] - value[before]);
        }
        before = i;
    }
    return NAN;
}

typedef struct series_numbers {
    size_t count;
    double sum, squares, least, greatest, t_least, t_greatest;
} series_numbers;

static series_numbers numbers_of(const ld_comparison *self, const log_result *result,
                                 const double *value)
{
    const char *counts = self->compared + (size_t)result->sensor * self->log.rows;
    double from = window_time(&self->run, result->from, -INFINITY),
           to = window_time(&self->run, result->to, INFINITY);
    series_numbers all = {.least = INFINITY, .greatest = -INFINITY};
    for (size_t i = 0; i < self->log.rows; i++) {
        double t = self->t[i], now = value[i];
        if (!counts[i] || t < from || t > to)
            continue;
        all.count++;
        all.sum += now;
        all.squares += now * now;
        if (now < all.least)
            all.t_least = t;
        if (now > all.greatest)
            all.t_greatest = t;
        all.least = fmin(all.least, now);
        all.greatest = fmax(all.greatest, now);
    }
    return all;
}

double comparison_take(const ld_comparison *self, const log_result *result, const double *value)
{
    const char *counts = self->compared + (size_t)result->sensor * self->log.rows;
    if (result->take == TAKE_VALUE)
        return value_at(self, counts, value, window_time(&self->run, result->at, NAN));
    series_numbers all = numbers_of(self, result, value);
    if (all.count == 0)
        return NAN;
    const double number[] = {[TAKE_MAX] = all.greatest,
                             [TAKE_MIN] = all.least,
                             [TAKE_MEAN] = all.sum / (double)all.count,
                             [TAKE_RMS] = sqrt(all.squares / (double)all.count),
                             [TAKE_T_MAX] = all.t_greatest,
                             [TAKE_T_MIN] = all.t_least};
    return number[result->take];
}

size_t comparison_count(const ld_comparison *self, const log_result *result)
{
    return numbers_of(self, result, self->log.sensor[result->sensor].value).count;
}

// ---- a run

static double result_by_name(const ld_comparison *self, const char *name, const run_series *run,
                             const ld_summary *summary)
{
    char path[LD_MAX_QUANTITY + 32];
    double value;
    int instant = comparison_instant(name);
    if (instant >= 0)
        return run->instant[instant];
    snprintf(path, sizeof path, "rocket.%d.%.95s", self->rocket, name);
    return !summary || ld_summary_number(summary, path, &value, NULL) ? NAN : value;
}

static ld_status read_sensor(const ld_comparison *self, const sensor *of, const run_series *run,
                             double *reading, ld_error *error)
{
    run_signal signal;
    ld_status status = sensor_signal(of, run, &signal, error);
    if (status)
        return status;
    status = sensor_read(of, &signal, self->log.rows, self->t, reading, error);
    run_signal_free(&signal);
    return status;
}

ld_status comparison_evaluate(const ld_comparison *self, const run_series *run,
                              const ld_summary *summary, run_values *values, ld_error *error)
{
    const measured_log *log = &self->log;
    ld_status status = LD_OK;
    for (int i = 0; i < log->sensors && !status; i++)
        status =
            read_sensor(self, &log->sensor[i], run, values->reading + (size_t)i * log->rows, error);
    for (int i = 0; i < log->results && !status; i++) {
        const log_result *result = &log->result[i];
        if (result->take == TAKE_RESULT)
            values->result[i] = result_by_name(self, result->of, run, summary);
        else
            values->result[i] =
                comparison_take(self, result, values->reading + (size_t)result->sensor * log->rows);
    }
    return status;
}
