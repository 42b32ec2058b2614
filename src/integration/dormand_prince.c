#include "integration/dormand_prince.h"

#include <string.h>

#include "math/functions.h"

enum { N = DORMAND_PRINCE_STATES };

static int states_of(const dormand_prince *self)
{
    return self->count > DORMAND_PRINCE_FEW ? N : DORMAND_PRINCE_FEW;
}

static void evaluate(dormand_prince *self, double t, const double *y, double *y_dot)
{
    self->f(&t, y, y_dot, self->self);
    self->step.evaluations++;
}

static double norm(const dormand_prince *self, const double *v, const double *y)
{
    double sum = 0;
    for (int i = 0, n = states_of(self); i < n; i++) {
        double share = v[i] / (self->step.absolute[i] + self->step.relative[i] * fabs(y[i]));
        sum += share * share;
    }
    return sqrt(sum / self->count);
}

// A first step size: the slopes may change the state by a hundredth, their change the error by as
// much (Hairer, Norsett and Wanner, II.4).
static double first_size(dormand_prince *self)
{
    double at[N], slope[N], change[N];
    double d0 = norm(self, self->step.y, self->step.y),
           d1 = norm(self, self->step.k[6], self->step.y);
    double h = d0 > 1e-5 && d1 > 1e-5 ? 0.01 * d0 / d1 : 1e-6;
    h = fmin(h, 0.1);
    for (int i = 0, n = states_of(self); i < n; i++)
        at[i] = self->step.y[i] + h * self->step.k[6][i];
    evaluate(self, self->step.t + h, at, slope);
    for (int i = 0, n = states_of(self); i < n; i++)
        change[i] = (slope[i] - self->step.k[6][i]) / h;
    double d2 = fmax(norm(self, change, self->step.y), d1);
    double h1 = d2 > 1e-15 ? pow(0.01 / d2, 0.2) : fmax(1e-6, 1e-3 * h);
    return fmin(100 * h, h1);
}

void dormand_prince_start(dormand_prince *self, double t, const double *y)
{
    self->step.t = self->step.t0 = t;
    memmove(self->step.y, y, sizeof self->step.y);
    memcpy(self->step.y0, self->step.y, sizeof self->step.y0);
    self->open = false;
    self->step.log_before = DORMAND_PRINCE_LOG_LEAST;
    self->step.outcome = DORMAND_PRINCE_DONE;
    evaluate(self, t, self->step.y, self->step.k[6]);
    if (self->step.h == 0)
        self->step.h = first_size(self);
}

bool dormand_prince_step(dormand_prince *self, double t_stop)
{
    self->step.t_stop = t_stop;
    self->open = false;
    do
        dormand_prince_try_default((double *)&self->step, self->count, self->f, self->self);
    while (self->step.outcome == DORMAND_PRINCE_REFUSED);
    return self->step.outcome == DORMAND_PRINCE_DONE;
}

void dormand_prince_retake(dormand_prince *self, double t)
{
    self->step.size = t - self->step.t0;
    dormand_prince_stages(&self->step, self->count, self->f, self->self);
    self->step.t = t;
    self->open = false;
}

// ---- between the ends

// The cubic by values and slopes at the ends, plus x^2 (1 - x)^2 (A + B x), x from 0 to 1.
static void course_at(const dormand_prince *self, double x, double *y)
{
    double left = 1 - x, w = x * x * left * left, h = self->step.t - self->step.t0;
    double end = x * x * (3 - 2 * x), first = h * x * left * left, last = -h * x * x * left;
    for (int i = 0, n = states_of(self); i < n; i++)
        y[i] = self->step.y0[i] + end * (self->step.y[i] - self->step.y0[i]) +
               (first * self->step.k[0][i] + last * self->step.k[6][i]) +
               w * (self->course[0][i] + self->course[1][i] * x);
}

// A and B such that the slopes at 1/3 and 2/3 of the step are those of the equations there, twice
// over: the first time on the cubic.
static void find_course(dormand_prince *self)
{
    double h = self->step.t - self->step.t0, at[N], f[2][N];
    memset(self->course, 0, sizeof self->course);
    for (int round = 0; round < 2; round++) {
        for (int k = 0; k < 2; k++) {
            course_at(self, (k + 1) / 3.0, at);
            evaluate(self, self->step.t0 + h * (k + 1) / 3.0, at, f[k]);
        }
        for (int i = 0, n = states_of(self); i < n; i++) {
            // less the cubic's slopes there
            double rise = 4.0 / 3 * (self->step.y[i] - self->step.y0[i]);
            double a = h * f[0][i] - (rise - h * self->step.k[6][i] / 3);
            double b = h * f[1][i] - (rise - h * self->step.k[0][i] / 3);
            self->course[0][i] = -6.75 * a - 13.5 * b;
            self->course[1][i] = 20.25 * (a + b);
        }
    }
    self->open = true;
}

void dormand_prince_between(dormand_prince *self, double t, double *y)
{
    double h = self->step.t - self->step.t0;
    if (!self->open)
        find_course(self);
    course_at(self, h > 0 ? (t - self->step.t0) / h : 1, y);
}
