#include "compare/log_clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "compare/sensor_reading.h"

enum { FEWEST = 8 };
static const double most_tried = 2000; // on each side

// The samples that are compared, and where.
typedef struct search {
    const measured_log *log;
    const sensor *by;
    run_signal signal;
    double from, to;                // [s] from ignition
    double *t, *reading, *measured; // [rows] room
    size_t count;                   // samples of the latest trial
    ld_error *error;
} search;

// Mean square of the residuals with this offset; infinity with too few samples.
static double miss(search *self, double offset)
{
    self->count = 0;
    for (size_t i = 0; i < self->log->rows; i++) {
        double t = self->log->t[i] + offset, value = self->by->value[i];
        if (isnan(value) || t < self->from || t > self->to)
            continue;
        self->t[self->count] = t;
        self->measured[self->count++] = value;
    }
    if (self->count < FEWEST ||
        sensor_read(self->by, &self->signal, self->count, self->t, self->reading, self->error))
        return INFINITY;
    double sum = 0;
    for (size_t i = 0; i < self->count; i++)
        sum += (self->reading[i] - self->measured[i]) * (self->reading[i] - self->measured[i]);
    return sum / (double)self->count;
}

// The least of the misses between two offsets, to 1e-7 s or 1e-6 of their distance.
static double golden(search *self, double low, double high)
{
    const double part = 0.5 * (sqrt(5) - 1), least = fmax(1e-7, 1e-6 * (high - low));
    double a = high - part * (high - low), b = low + part * (high - low);
    double at_a = miss(self, a), at_b = miss(self, b);
    while (high - low > least) {
        if (at_a <= at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - part * (high - low);
            at_a = miss(self, a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + part * (high - low);
            at_b = miss(self, b);
        }
    }
    return 0.5 * (low + high);
}

// What is read at the latest trial's times, so much later, into `reading`.
static bool read_later(search *self, double later, double *reading)
{
    for (size_t i = 0; i < self->count; i++)
        self->t[i] += later;
    return !sensor_read(self->by, &self->signal, self->count, self->t, reading, self->error);
}

// Standard uncertainty of the offset, at which miss() was called last.
static double uncertainty_of(search *self, double mean_square, double h)
{
    double lagged = 0, square = 0, slopes = 0, before = 0;
    for (size_t i = 0; i < self->count; i++) {
        double residual = self->measured[i] - self->reading[i];
        square += residual * residual;
        lagged += residual * before;
        before = residual;
    }
    double *late = self->reading, *early = self->measured;
    if (!read_later(self, h, late) || !read_later(self, -2 * h, early))
        return NAN;
    for (size_t i = 0; i < self->count; i++) {
        double slope = 0.5 * (late[i] - early[i]) / h;
        slopes += slope * slope;
    }
    double rho = square > 0 ? fmin(fmax(lagged / square, 0), 0.99) : 0;
    double n = (double)self->count;
    return sqrt(mean_square * n / (n - 1) * (1 + rho) / (1 - rho) / slopes);
}

static ld_status seek(search *self, log_clock *clock)
{
    double spacing = (self->log->t[self->log->rows - 1] - self->log->t[0]) /
                     (double)(self->log->rows > 1 ? self->log->rows - 1 : 1);
    double step = fmin(clock->within / 100, fmax(spacing, clock->within / most_tried));
    int half = (int)ceil(clock->within / step), best = 0;
    double least = INFINITY;
    for (int k = -half; k <= half; k++) {
        double now = miss(self, clock->offset + k * step);
        if (now < least) {
            least = now;
            best = k;
        }
    }
    if (isinf(least))
        return ld_fail(self->error, LD_ERR_INPUT,
                       "clock.find: fewer than %d samples of %.95s lie between %g s and %g s",
                       FEWEST, self->by->column, self->from, self->to);
    if (best == -half || best == half)
        return ld_fail(self->error, LD_ERR_INPUT,
                       "clock.find: no offset within %g s of %g s is best; expected another "
                       "clock.offset, or a larger clock.within",
                       clock->within, clock->offset);
    double center = clock->offset + best * step;
    clock->offset = golden(self, center - step, center + step);
    double mean_square = miss(self, clock->offset);
    clock->uncertainty = uncertainty_of(self, mean_square, 0.1 * step);
    return LD_OK;
}

ld_status log_clock_find(measured_log *log, const sensor *by, const run_series *run,
                         ld_error *error)
{
    search self = {.log = log, .by = by, .error = error};
    ld_status status = sensor_signal(by, run, &self.signal, error);
    if (status)
        return status;
    self.from = window_time(run, log->clock.from, self.signal.t[0]);
    self.to = window_time(run, log->clock.to, self.signal.t[self.signal.count - 1]);
    self.t = calloc(log->rows, sizeof *self.t);
    self.reading = calloc(log->rows, sizeof *self.reading);
    self.measured = calloc(log->rows, sizeof *self.measured);
    if (self.t && self.reading && self.measured)
        status = seek(&self, &log->clock);
    else
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the clock of the log");
    free(self.t);
    free(self.reading);
    free(self.measured);
    run_signal_free(&self.signal);
    return status;
}
