#include "simulation/dormand_prince.h"

#include <math.h>
#include <string.h>

enum { N = DORMAND_PRINCE_STATES, STAGES = DORMAND_PRINCE_STAGES };

static const double node[STAGES] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
static const double weight[STAGES][STAGES - 1] = {
    {0},
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
};
// weights of the fifth order less those of the fourth
static const double difference[STAGES] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                          -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

static void evaluate(dormand_prince *self, double t, const double *y, double *y_dot)
{
    self->f(t, y, y_dot, self->self);
    self->evaluations++;
}

// out = y + h sum of a_j k_j, j < count; unrolled for each count.
static inline __attribute__((always_inline)) void
combine(const double *y, double h, const double *a, int count, const double k[][N], double *out)
{
    double b[STAGES];
    for (int j = 0; j < count; j++)
        b[j] = h * a[j];
    for (int i = 0; i < N; i++) {
        double sum = b[0] * k[0][i];
        for (int j = 1; j < count; j++)
            sum += b[j] * k[j][i];
        out[i] = y[i] + sum;
    }
}

// The stages of a step of size h from (t0, y0), where k[0] is known; y: its end.
static void take_stages(dormand_prince *self, double h)
{
    const double(*k)[N] = (const double(*)[N])self->k;
    double at[N];
#define STAGE(s, to)                                                                               \
    combine(self->y0, h, weight[s], s, k, to);                                                     \
    evaluate(self, self->t0 + node[s] * h, to, self->k[s])
    STAGE(1, at);
    STAGE(2, at);
    STAGE(3, at);
    STAGE(4, at);
    STAGE(5, at);
    STAGE(6, self->y);
}

// Error of the step against what is allowed: 1 is just allowed. Not finite where the slopes are
// not.
static double step_error(const dormand_prince *self, double h)
{
    const double zero[N] = {0};
    double e[N], sum = 0;
    combine(zero, h, difference, STAGES, (const double(*)[N])self->k, e);
    for (int i = 0; i < N; i++) {
        double size = fmax(fabs(self->y0[i]), fabs(self->y[i]));
        double share = e[i] / (self->absolute[i] + self->relative[i] * size);
        sum += share * share;
    }
    return sqrt(sum / self->count);
}

static double norm(const dormand_prince *self, const double *v, const double *y)
{
    double sum = 0;
    for (int i = 0; i < N; i++) {
        double share = v[i] / (self->absolute[i] + self->relative[i] * fabs(y[i]));
        sum += share * share;
    }
    return sqrt(sum / self->count);
}

// A first step size: the slopes may change the state by a hundredth, their change the error by as
// much (Hairer, Norsett and Wanner, II.4).
static double first_size(dormand_prince *self)
{
    double at[N], slope[N], change[N];
    double d0 = norm(self, self->y, self->y), d1 = norm(self, self->k[6], self->y);
    double h = d0 > 1e-5 && d1 > 1e-5 ? 0.01 * d0 / d1 : 1e-6;
    h = fmin(h, 0.1);
    for (int i = 0; i < N; i++)
        at[i] = self->y[i] + h * self->k[6][i];
    evaluate(self, self->t + h, at, slope);
    for (int i = 0; i < N; i++)
        change[i] = (slope[i] - self->k[6][i]) / h;
    double d2 = fmax(norm(self, change, self->y), d1);
    double h1 = d2 > 1e-15 ? pow(0.01 / d2, 0.2) : fmax(1e-6, 1e-3 * h);
    return fmin(100 * h, h1);
}

void dormand_prince_start(dormand_prince *self, double t, const double *y)
{
    self->t = self->t0 = t;
    memmove(self->y, y, sizeof self->y);
    memcpy(self->y0, self->y, sizeof self->y0);
    self->open = false;
    self->error = 1e-4;
    evaluate(self, t, self->y, self->k[6]);
    if (self->h == 0)
        self->h = first_size(self);
}

bool dormand_prince_step(dormand_prince *self, double t_stop)
{
    self->t0 = self->t;
    memcpy(self->y0, self->y, sizeof self->y0);
    memcpy(self->k[0], self->k[6], sizeof self->k[0]);
    self->open = false;
    double left = t_stop - self->t0, most = 10;
    for (;;) {
        // what is left before a stop is taken in one step or in two
        bool last = self->h >= left * (1 - 1e-12);
        double h = last ? left : 2 * self->h > left ? 0.5 * left : self->h;
        if (!(h > 4e-16 * fabs(self->t0)) || !(h > 0)) {
            memcpy(self->y, self->y0, sizeof self->y);
            return false;
        }
        take_stages(self, h);
        double error = step_error(self, h);
        double grow = isfinite(error) ? 0.9 * pow(error, -0.17) : 0.3;
        if (error <= 1) {
            double next = h * fmin(most, fmax(0.2, grow * pow(self->error, 0.04)));
            // a step cut short by a stop tells nothing against the size before it
            self->h = h < self->h ? fmax(next, self->h) : next;
            self->error = fmax(error, 1e-4);
            self->t = last ? t_stop : self->t0 + h;
            self->steps++;
            return true;
        }
        self->h = h * fmax(0.2, fmin(1, grow));
        most = 1;
    }
}

void dormand_prince_retake(dormand_prince *self, double t)
{
    take_stages(self, t - self->t0);
    self->t = t;
    self->open = false;
}

// ---- between the ends

// The cubic by values and slopes at the ends, plus x^2 (1 - x)^2 (A + B x), x from 0 to 1.
static void course_at(const dormand_prince *self, double x, double *y)
{
    double left = 1 - x, w = x * x * left * left, h = self->t - self->t0;
    double end = x * x * (3 - 2 * x), first = h * x * left * left, last = -h * x * x * left;
    for (int i = 0; i < N; i++)
        y[i] = self->y0[i] + end * (self->y[i] - self->y0[i]) +
               (first * self->k[0][i] + last * self->k[6][i]) +
               w * (self->course[0][i] + self->course[1][i] * x);
}

// A and B such that the slopes at 1/3 and 2/3 of the step are those of the equations there, twice
// over: the first time on the cubic.
static void find_course(dormand_prince *self)
{
    double h = self->t - self->t0, at[N], f[2][N];
    memset(self->course, 0, sizeof self->course);
    for (int round = 0; round < 2; round++) {
        for (int k = 0; k < 2; k++) {
            course_at(self, (k + 1) / 3.0, at);
            evaluate(self, self->t0 + h * (k + 1) / 3.0, at, f[k]);
        }
        for (int i = 0; i < N; i++) {
            // less the cubic's slopes there
            double rise = 4.0 / 3 * (self->y[i] - self->y0[i]);
            double a = h * f[0][i] - (rise - h * self->k[6][i] / 3);
            double b = h * f[1][i] - (rise - h * self->k[0][i] / 3);
            self->course[0][i] = -6.75 * a - 13.5 * b;
            self->course[1][i] = 20.25 * (a + b);
        }
    }
    self->open = true;
}

void dormand_prince_between(dormand_prince *self, double t, double *y)
{
    double h = self->t - self->t0;
    if (!self->open)
        find_course(self);
    course_at(self, h > 0 ? (t - self->t0) / h : 1, y);
}
