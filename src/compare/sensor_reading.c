#include "compare/sensor_reading.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "compare/launcher_reading.h"
#include "math/curves/low_pass.h"
#include "math/curves/pchip.h"
#include "math/vectors/mat3.h"

// ---- what is there

// Each row of columns becomes one number, the first of `width`.
static ld_status accelerate(const sensor *self, const run_series *run, run_signal *signal,
                            ld_error *error)
{
    static const char *const names[] = {"rocket.fx",     "rocket.fy",     "rocket.fz",
                                        "rocket.wx",     "rocket.wy",     "rocket.wz",
                                        "rocket.wx_dot", "rocket.wy_dot", "rocket.wz_dot"};
    ld_status status = run_series_take(run, names, 9, signal, error);
    v3 at = v3_from(self->at), axis = v3_from(self->axis);
    for (size_t i = 0; i < signal->count; i++) {
        const double *row = signal->value + 9 * i;
        v3 f = v3_from(row), w = v3_from(row + 3), w_dot = v3_from(row + 6);
        f = v3_add(f, v3_add(v3_cross(w_dot, at), v3_cross(w, v3_cross(w, at))));
        signal->value[i] = v3_dot(axis, f);
    }
    return status;
}

static ld_status turn(const sensor *self, const run_series *run, run_signal *signal,
                      ld_error *error)
{
    static const char *const rates[] = {"wx", "wy", "wz"};
    ld_status status = launcher_take(self->on ? self->on : "rocket", run, rates, 3, signal, error);
    for (size_t i = 0; i < signal->count; i++)
        signal->value[i] = v3_dot(v3_from(self->axis), v3_from(signal->value + 3 * i));
    return status;
}

// Of the rows of the flight, on a round Earth, the altitude's changes count.
static void take_altitude(const run_series *run, run_signal *signal)
{
    const series_part *flight = &run->flight;
    size_t first = signal->count - flight->rows;
    for (size_t k = 0; k < flight->columns; k++)
        if (flight->rows > 0 && strcmp(flight->name[k], "altitude") == 0) {
            double start = signal->value[first] - flight->value[k][0];
            for (size_t i = 0; i < flight->rows; i++)
                signal->value[first + i] = start + flight->value[k][i];
        }
}

static ld_status climb(const run_series *run, run_signal *signal, ld_error *error)
{
    static const char *const names[] = {"center.y"};
    ld_status status = run_series_take(run, names, 1, signal, error);
    if (status || signal->count == 0)
        return status;
    take_altitude(run, signal);
    size_t at = 0;
    while (at + 1 < signal->count && signal->t[at + 1] <= 0)
        at++;
    double start = signal->value[at];
    for (size_t i = 0; i < signal->count; i++)
        signal->value[i] -= start;
    return LD_OK;
}

ld_status sensor_signal(const sensor *self, const run_series *run, run_signal *signal,
                        ld_error *error)
{
    const char *of = self->of;
    ld_status status = LD_OK;
    switch (self->kind) {
    case SENSOR_ACCELEROMETER:
        status = self->on ? launcher_accelerate(self, run, signal, error)
                          : accelerate(self, run, signal, error);
        break;
    case SENSOR_GYRO:
        status = turn(self, run, signal, error);
        break;
    case SENSOR_STRAIN:
        status = launcher_strain(self, run, signal, error);
        break;
    case SENSOR_ALTIMETER:
        status = climb(run, signal, error);
        break;
    case SENSOR_COLUMN:
        status = run_series_take(run, &of, 1, signal, error);
        break;
    }
    if (!status && signal->count == 0) {
        run_signal_free(signal);
        status = ld_fail(error, LD_ERR_INPUT, "%.95s: the run has no value of it", self->column);
    }
    return status;
}

// ---- what it reads

// Values between rows by a cubic between jumps.
static ld_status read_smooth(const run_signal *signal, size_t n, const double *t, double *reading,
                             ld_error *error)
{
    size_t count = signal->count, row = 0;
    double *slope = calloc(count, sizeof *slope);
    if (!slope)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a sensor's readings");
    for (size_t first = 0, end; first < count; first = end) {
        end = first + 1;
        while (end < count && signal->t[end] > signal->t[end - 1])
            end++;
        if (end - first > 1)
            pchip_slopes(end - first, signal->t + first, signal->value + first, slope + first);
    }
    for (size_t i = 0; i < n; i++) {
        while (row + 1 < count && signal->t[row + 1] <= t[i])
            row++;
        const double *x = signal->t + row, *y = signal->value + row, *d = slope + row;
        reading[i] = y[0];
        if (row + 1 == count || t[i] <= x[0])
            continue;
        double h = x[1] - x[0], s = (t[i] - x[0]) / h, u = 1 - s;
        reading[i] = u * u * (1 + 2 * s) * y[0] + s * s * (1 + 2 * u) * y[1] +
                     h * s * u * (u * d[0] - s * d[1]);
    }
    free(slope);
    return LD_OK;
}

// Through the low pass, the signal linear between its rows.
static void read_filtered(const sensor *self, const run_signal *signal, size_t n, const double *t,
                          double *reading)
{
    low_pass filter;
    low_pass_begin(&filter, self->cutoff, self->order, signal->value[0]);
    size_t row = 0;
    for (size_t i = 0; i < n; i++) {
        while (row + 1 < signal->count && signal->t[row + 1] <= t[i]) {
            low_pass_step(&filter, signal->t[row + 1] - signal->t[row], signal->value[row + 1]);
            row++;
        }
        low_pass now = filter;
        double since = t[i] - signal->t[row], value = signal->value[row];
        if (row + 1 < signal->count)
            value +=
                (signal->value[row + 1] - value) * since / (signal->t[row + 1] - signal->t[row]);
        if (since > 0)
            low_pass_step(&now, since, value);
        reading[i] = low_pass_output(&now);
    }
}

ld_status sensor_read(const sensor *self, const run_signal *signal, size_t n, const double *t,
                      double *reading, ld_error *error)
{
    double *ago = calloc(n + 1, sizeof *ago);
    if (!ago)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a sensor's readings");
    for (size_t i = 0; i < n; i++)
        ago[i] = t[i] - self->delay;
    ld_status status = LD_OK;
    if (isnan(self->cutoff))
        status = read_smooth(signal, n, ago, reading, error);
    else
        read_filtered(self, signal, n, ago, reading);
    free(ago);
    for (size_t i = 0; i < n && !status; i++) {
        double value = self->scale * reading[i] + self->bias;
        if (!isnan(self->range[0]))
            value = fmin(fmax(value, self->range[0]), self->range[1]);
        reading[i] = value;
    }
    return status;
}
