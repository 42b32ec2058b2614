#include "simulation/dormand_prince.h"

#include <math.h>
#include <string.h>

enum { N = DORMAND_PRINCE_STATES };

static void evaluate(dormand_prince *self, double t, const double *y, double *y_dot)
{
    self->f(&t, y, y_dot, self->self);
    self->evaluations++;
}

static void take_step(dormand_prince *self)
{
    dormand_prince_try_default((double *)&self->step, self->count, self->f, self->self);
    self->evaluations += DORMAND_PRINCE_STAGES - 1;
}

static double norm(const dormand_prince *self, const double *v, const double *y)
{
    double sum = 0;
    for (int i = 0; i < N; i++) {
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
    for (int i = 0; i < N; i++)
        at[i] = self->step.y[i] + h * self->step.k[6][i];
    evaluate(self, self->t + h, at, slope);
    for (int i = 0; i < N; i++)
        change[i] = (slope[i] - self->step.k[6][i]) / h;
    double d2 = fmax(norm(self, change, self->step.y), d1);
    double h1 = d2 > 1e-15 ? pow(0.01 / d2, 0.2) : fmax(1e-6, 1e-3 * h);
    return fmin(100 * h, h1);
}

void dormand_prince_start(dormand_prince *self, double t, const double *y)
{
    self->t = self->step.t0 = t;
    memmove(self->step.y, y, sizeof self->step.y);
    memcpy(self->step.y0, self->step.y, sizeof self->step.y0);
    self->open = false;
    self->error = 1e-4;
    evaluate(self, t, self->step.y, self->step.k[6]);
    if (self->h == 0)
        self->h = first_size(self);
}

void dormand_prince_begin(dormand_prince *self, double t_stop)
{
    dormand_prince_numbers *step = &self->step;
    step->t0 = self->t;
    memcpy(step->y0, step->y, sizeof step->y0);
    memcpy(step->k[0], step->k[6], sizeof step->k[0]);
    self->open = false;
    self->t_stop = t_stop;
    self->most = 10;
}

bool dormand_prince_choose(dormand_prince *self)
{
    dormand_prince_numbers *step = &self->step;
    // what is left before a stop is taken in one step or in two
    double left = self->t_stop - step->t0;
    self->last = self->h >= left * (1 - 1e-12);
    step->size = self->last ? left : 2 * self->h > left ? 0.5 * left : self->h;
    if (step->size > 4e-16 * fabs(step->t0) && step->size > 0)
        return true;
    memcpy(step->y, step->y0, sizeof step->y);
    return false;
}

bool dormand_prince_judge(dormand_prince *self)
{
    double h = self->step.size, error = self->step.error;
    double grow = isfinite(error) ? 0.9 * pow(error, -0.17) : 0.3;
    if (!(error <= 1)) {
        self->h = h * fmax(0.2, fmin(1, grow));
        self->most = 1;
        return false;
    }
    double next = h * fmin(self->most, fmax(0.2, grow * pow(self->error, 0.04)));
    // a step cut short by a stop tells nothing against the size before it
    self->h = h < self->h ? fmax(next, self->h) : next;
    self->error = fmax(error, 1e-4);
    self->t = self->last ? self->t_stop : self->step.t0 + h;
    self->steps++;
    return true;
}

bool dormand_prince_step(dormand_prince *self, double t_stop)
{
    dormand_prince_begin(self, t_stop);
    while (dormand_prince_choose(self)) {
        take_step(self);
        if (dormand_prince_judge(self))
            return true;
    }
    return false;
}

void dormand_prince_retake(dormand_prince *self, double t)
{
    self->step.size = t - self->step.t0;
    take_step(self);
    self->t = t;
    self->open = false;
}

// ---- between the ends

// The cubic by values and slopes at the ends, plus x^2 (1 - x)^2 (A + B x), x from 0 to 1.
static void course_at(const dormand_prince *self, double x, double *y)
{
    double left = 1 - x, w = x * x * left * left, h = self->t - self->step.t0;
    double end = x * x * (3 - 2 * x), first = h * x * left * left, last = -h * x * x * left;
    for (int i = 0; i < N; i++)
        y[i] = self->step.y0[i] + end * (self->step.y[i] - self->step.y0[i]) +
               (first * self->step.k[0][i] + last * self->step.k[6][i]) +
               w * (self->course[0][i] + self->course[1][i] * x);
}

// A and B such that the slopes at 1/3 and 2/3 of the step are those of the equations there, twice
// over: the first time on the cubic.
static void find_course(dormand_prince *self)
{
    double h = self->t - self->step.t0, at[N], f[2][N];
    memset(self->course, 0, sizeof self->course);
    for (int round = 0; round < 2; round++) {
        for (int k = 0; k < 2; k++) {
            course_at(self, (k + 1) / 3.0, at);
            evaluate(self, self->step.t0 + h * (k + 1) / 3.0, at, f[k]);
        }
        for (int i = 0; i < N; i++) {
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
    double h = self->t - self->step.t0;
    if (!self->open)
        find_course(self);
    course_at(self, h > 0 ? (t - self->step.t0) / h : 1, y);
}
