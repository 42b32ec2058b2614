#include "flight/descent.h"

#include "math/functions.h"
#include "model/blocks/drag_devices.h"
#include "systems/flight/canopy.h"

void descent_set_tolerances(const flight_system *system, dormand_prince *steps, double tolerance)
{
    for (int i = FLIGHT_CANOPY_S; i < FLIGHT_ALL_STATES; i++) {
        steps->step.absolute[i] = 10 * tolerance;
        steps->step.relative[i] = 0;
    }
    steps->count = system->states + FLIGHT_WAY - FLIGHT_CANOPY_S + system->own_filling;
}

// Slack lines pull at nothing, so steps would be long: a tenth of their length at most.
double descent_stop(const flight_phase *phase, const dormand_prince *steps)
{
    const double *y = steps->step.y;
    if (phase->canopy.taut)
        return INFINITY;
    double speed = v3_norm(v3_from(y + FLIGHT_CANOPY_U));
    return steps->step.t + 0.1 * fmax(1, phase->canopy.given->line_length) / fmax(1, speed);
}

// Positive: the lines are as the phase has them.
static double holds(const flight_phase *phase, const double *y)
{
    canopy_lines lines = canopy_lines_at(phase, y);
    if (phase->canopy.taut)
        return lines.tension;
    return -fmin(phase->canopy.stiffness * lines.stretch, lines.tension);
}

static double not_full(const flight_phase *phase, const double *y)
{
    return 1 - flight_filled_by_way(phase, y);
}

// Where something that is below 0 at the step's end comes to be so.
static double find_end(double (*value)(const flight_phase *phase, const double *y),
                       const flight_phase *phase, dormand_prince *steps)
{
    double a = steps->step.t0, b = steps->step.t, y[DORMAND_PRINCE_STATES];
    for (int i = 0; i < 60 && b - a > 1e-15 * (1 + fabs(b)); i++) {
        double middle = 0.5 * (a + b);
        dormand_prince_between(steps, middle, y);
        *(value(phase, y) < 0 ? &b : &a) = middle;
    }
    return b;
}

static void end_step(dormand_prince *steps, double t)
{
    if (t < steps->step.t)
        dormand_prince_retake(steps, t);
}

descent descent_none(void)
{
    return (descent){.t_switch = NAN, .t_full = NAN};
}

void descent_locate(descent *self, const flight_phase *phase, dormand_prince *steps)
{
    self->t_switch = self->t_full = NAN;
    if (steps->step.outcome != DORMAND_PRINCE_DONE)
        return;
    if (phase->filling.by_way && not_full(phase, steps->step.y) <= 0) {
        end_step(steps, find_end(not_full, phase, steps));
        self->t_full = steps->step.t;
    }
    // a step may end just there
    if (!phase->canopy.given || !(holds(phase, steps->step.y) <= 0))
        return;
    if (holds(phase, steps->step.y0) > 0)
        end_step(steps, find_end(holds, phase, steps));
    self->t_switch = steps->step.t;
    if (self->t_full > steps->step.t)
        self->t_full = NAN;
}

static double force_at(const flight_phase *phase, dormand_prince *steps, double t)
{
    double y[DORMAND_PRINCE_STATES];
    dormand_prince_between(steps, t, y);
    return canopy_force(phase, y);
}

// Where the force is greatest between a and b, by golden sections.
static double greatest_between(const flight_phase *phase, dormand_prince *steps, double a, double b)
{
    double share = (sqrt(5) - 1) / 2;
    for (int i = 0; i < 40; i++) {
        double c = b - share * (b - a), d = a + share * (b - a);
        if (force_at(phase, steps, c) > force_at(phase, steps, d))
            b = d;
        else
            a = c;
    }
    return 0.5 * (a + b);
}

void descent_watch(descent *self, const flight_phase *phase, dormand_prince *steps,
                   double t_ignition, ld_parachute_summary *out)
{
    enum { PARTS = 4 };
    if (!phase->canopy.given || !phase->canopy.taut)
        return;
    double t0 = steps->step.t0, end = steps->step.t, h = (end - t0) / PARTS, most = -INFINITY;
    double t = t0;
    for (int i = 0; i <= PARTS; i++) {
        double at = i < PARTS ? t0 + i * h : end, force = force_at(phase, steps, at);
        t = force > most ? at : t;
        most = fmax(most, force);
    }
    if (self->taken && most < 0.9 * out->greatest_force)
        return;
    t = greatest_between(phase, steps, fmax(t0, t - h), fmin(end, t + h));
    most = fmax(most, force_at(phase, steps, t));
    if (!self->taken) {
        self->taken = t < end - 1e-6 * h;
        out->snatch = most;
    }
    if (!(most <= out->greatest_force)) {
        out->greatest_force = most;
        out->t_greatest_force = t - t_ignition;
    }
}
