// The loop of a hinge, opened. A command r acts through the controller alone, so with E the gain
// from r to the error and b that to the chassis' rate along the hinge, which a feedforward takes,
//   asked / (C r) = E - (F/C) b = 1/(1 + L),
// C and F what the controller makes of an error and of that rate: the closed loop gives the open
// one. How the chassis turns the platform is what it does where forces on it let it do nothing else
// than turn about the hinge. For a drive of a multibody base there is no such answer.
#include "launchdyn/loop.h"
#include "model/blocks/base.h"
#include "model/blocks/platform.h"
#include "model/blocks/stabiliser.h"
#include "model/parts.h"

#include <complex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "linear/response_state.h"
#include "math/functions.h"
#include "math/matrices/dense.h"
#include "math/vectors/mat3.h"

static const double TWO_PI = 6.283185307179586476925286766559;
static const double LOWEST = 0.05, HIGHEST = 500; // [Hz] of margins

enum {
    GRID = 12000, // frequencies of margins: a motion damped by 0.05 % is a step wide
    HALVINGS = 45,
    WAYS = 6,        // of the chassis to move
    SEEN = 1 + WAYS, // columns: the error, the chassis' angular velocity and its velocity
};

struct ld_loop {
    ld_response *response;
    const ld_stabiliser *stabiliser;
    char path[LD_MAX_NAME + 24];    // of its keys
    char command[LD_MAX_NAME + 16]; // the input
    int seen;                       // columns
    double speed;                   // [m/s]
    double axis[3];                 // of the hinge, in the chassis' axes
    double turn[WAYS]; // angular velocity and velocity of a chassis that turns about the hinge
    double late;       // [s]
    double lateness;   // [s] that would be too much, of the loop as if it were at once
    ld_loop_margins margins;
};

// What a loop is at a frequency.
typedef struct look {
    double frequency;           // [Hz]
    double complex open, error; // L as it is; error per command as if it were at once
    double complex delay;
} look;

static ld_phasor phasor(double complex z)
{
    return (ld_phasor){creal(z), cimag(z)};
}

static double modulus(double complex z)
{
    return hypot(creal(z), cimag(z));
}

static double argument(double complex z)
{
    return atan2(cimag(z), creal(z));
}

static double complex sensitivity(const look *at)
{
    return 1 / (1 + at->open);
}

// What is measured, per command: P D C/(1 + P D C), from P C/(1 + P C).
static double complex tracking(const look *at)
{
    return (1 - at->error) * (at->delay + at->open) / (1 + at->open);
}

// F/C at s: a share of the chassis' rate, against a rate command.
static double complex feedforward(const ld_stabiliser *given, double complex s)
{
    const ld_cascade *cascade = &given->cascade;
    if (given->feedforward == 0)
        return 0;
    if (cascade->present)
        return given->feedforward / (cascade->kp + s);
    return given->feedforward * given->kd * s / (given->ki + s * (given->kp + s * given->kd));
}

// What an input makes of the columns.
static ld_status evaluate_columns(const ld_loop *self, const char *input, double frequency,
                                  double complex seen[SEEN], ld_error *error)
{
    ld_phasor gain[SEEN];
    ld_status status =
        ld_response_gain(self->response, self->speed, input, &frequency, 1, gain, error);
    for (int i = 0; i < SEEN && !status; i++)
        seen[i] = i < self->seen ? gain[i].real + I * gain[i].imaginary : 0;
    return status;
}

// e^(-s late)
static double complex delay_of(const ld_loop *self, double frequency)
{
    double sine, cosine;
    sincos(TWO_PI * frequency * self->late, &sine, &cosine);
    return cosine - I * sine;
}

static ld_status evaluate_at(const ld_loop *self, double frequency, look *at, ld_error *error)
{
    double complex seen[SEEN], s = I * TWO_PI * frequency, rate = 0;
    ld_status status = evaluate_columns(self, self->command, frequency, seen, error);
    if (status)
        return status;
    for (int i = 0; i < 3; i++)
        rate += self->axis[i] * seen[1 + i];
    at->frequency = frequency;
    at->error = seen[0];
    double complex left = at->error - feedforward(self->stabiliser, s) * rate;
    at->delay = delay_of(self, frequency);
    at->open = at->delay * (1 - left) / left;
    return LD_OK;
}

// ---- margins ----

static double frequency_of(int k)
{
    return LOWEST * pow(HIGHEST / LOWEST, k / (GRID - 1.0));
}

static double above_one(double complex open)
{
    return modulus(open) - 1;
}

static double beside_axis(double complex open)
{
    return cimag(open);
}

static double above_tracking(const look *at)
{
    return modulus(tracking(at)) - sqrt(0.5);
}

// Halves the step between two frequencies on both sides of a zero of L's function; what is there.
static ld_status close_in(const ld_loop *self, double (*side)(double complex), double low,
                          double high, look *at, ld_error *error)
{
    look first;
    ld_status status = evaluate_at(self, low, &first, error);
    for (int i = 0; i < HALVINGS && !status; i++) {
        double middle = 0.5 * (low + high);
        status = evaluate_at(self, middle, at, error);
        bool below = !status && side(at->open) * side(first.open) > 0;
        low = below ? middle : low;
        high = below ? high : middle;
    }
    return status;
}

// L on the negative real axis: gains times -1/L are at the limit.
static void note_axis(ld_loop_margins *to, const look *at)
{
    double factor = -1 / creal(at->open);
    if (factor > 1 && factor < to->raise) {
        to->raise = factor;
        to->raise_at = at->frequency;
    } else if (factor > 0 && factor < 1 && factor > to->lower) {
        to->lower = factor;
        to->lower_at = at->frequency;
    }
}

// |L| = 1: how far it may turn back, as it does the more the later the loop is, until it is -1.
static void note_unity(ld_loop *self, const look *at)
{
    ld_loop_margins *to = &self->margins;
    double omega = TWO_PI * at->frequency, lag = argument(-at->open / at->delay);
    to->phase = fmin(to->phase, fabs(argument(-at->open)));
    to->crossover = at->frequency;
    self->lateness = fmin(self->lateness, (lag < 0 ? lag + TWO_PI : lag) / omega);
}

static ld_status note_step(ld_loop *self, int k, const look *from, const look *to, ld_error *error)
{
    look at;
    double low = frequency_of(k - 1), high = frequency_of(k);
    ld_status status = LD_OK;
    if (above_one(from->open) * above_one(to->open) <= 0) {
        status = close_in(self, above_one, low, high, &at, error);
        if (!status)
            note_unity(self, &at);
    }
    if (!status && beside_axis(from->open) * beside_axis(to->open) <= 0) {
        status = close_in(self, beside_axis, low, high, &at, error);
        if (!status)
            note_axis(&self->margins, &at);
    }
    // little depends on it: within the step by a straight line
    double before = above_tracking(from), after = above_tracking(to);
    if (isnan(self->margins.bandwidth) && before >= 0 && after < 0)
        self->margins.bandwidth = low + (high - low) * before / (before - after);
    if (modulus(sensitivity(to)) > self->margins.peak) {
        self->margins.peak = modulus(sensitivity(to));
        self->margins.peak_at = high;
    }
    return status;
}

static ld_status find_margins(ld_loop *self, ld_error *error)
{
    look step[2];
    self->lateness = INFINITY;
    self->margins = (ld_loop_margins){.raise = INFINITY,
                                      .raise_at = NAN,
                                      .lower_at = NAN,
                                      .phase = INFINITY,
                                      .crossover = NAN,
                                      .bandwidth = NAN,
                                      .peak = 1,
                                      .peak_at = NAN};
    ld_status status = evaluate_at(self, frequency_of(0), &step[0], error);
    for (int k = 1; k < GRID && !status; k++) {
        status = evaluate_at(self, frequency_of(k), &step[k % 2], error);
        if (!status)
            status = note_step(self, k, &step[(k - 1) % 2], &step[k % 2], error);
    }
    self->margins.delay = self->lateness - self->late;
    return status;
}

// ---- life ----

static ld_status find_hinge(ld_loop *self, const ld_model *model, const char *name, int *hinge,
                            ld_error *error)
{
    int count = model_hinge_count(model);
    name_suggestion best = suggestion_begin(name);
    for (int i = 0; i < count; i++)
        suggestion_offer(&best, model_hinge_name(model, i));
    for (*hinge = 0; *hinge < count && strcmp(model_hinge_name(model, *hinge), name) != 0;)
        ++*hinge;
    if (*hinge == count)
        return ld_fail(error, LD_ERR_INPUT, "unknown hinge \"%s\"%s%s%s", name,
                       best.name    ? ", did you mean \""
                       : count == 2 ? "; expected azimuth or elevation"
                                    : "; expected elevation",
                       best.name ? best.name : "", best.name ? "\"?" : "");
    const ld_turret *turret = model_hinge(model, *hinge);
    if (turret->lock.present)
        return ld_fail(error, LD_ERR_INPUT,
                       "platform.%s.lock: there is no loop: the hinge is locked", name);
    self->stabiliser = &turret->stabiliser;
    snprintf(self->path, sizeof self->path, "platform.%.60s.stabiliser", name);
    return LD_OK;
}

// Of a drive on a joint.
static ld_status find_drive(ld_loop *self, const ld_mechanism *given, const char *name,
                            ld_error *error)
{
    name_suggestion best = suggestion_begin(name);
    const ld_joint_drive *drive = NULL;
    for (int i = 0; i < given->drive_count; i++) {
        suggestion_offer(&best, given->drive[i].name);
        if (strcmp(given->drive[i].name, name) == 0)
            drive = &given->drive[i];
    }
    if (given->drive_count == 0)
        return ld_fail(error, LD_ERR_INPUT, "there is no loop: the base has no drives");
    if (!drive)
        return ld_fail(error, LD_ERR_INPUT, "unknown drive \"%s\"%s%s%s", name,
                       best.name ? ", did you mean \"" : "; expected a name of base.drives",
                       best.name ? best.name : "", best.name ? "\"?" : "");
    self->stabiliser = drive->form == LD_DRIVE_ANGLE ? &drive->angle : &drive->length;
    snprintf(self->path, sizeof self->path, "base.drives.%.60s", name);
    return LD_OK;
}

// Its axis, and what turns about it.
static void place_hinge(ld_loop *self, const ld_platform *platform, bool azimuth)
{
    const ld_response *at = self->response;
    m3 A_IC = m3_mul(m3_rotation_y(response_rest(at, "chassis.yaw")),
                     m3_mul(m3_rotation_z(response_rest(at, "chassis.pitch")),
                            m3_rotation_x(response_rest(at, "chassis.roll"))));
    m3 A_CA = m3_identity();
    v3 place = v3_zero();
    if (platform->has_azimuth) {
        A_CA = m3_rotation_y(response_rest(at, "azimuth.angle"));
        place = v3_from(platform->azimuth.hinge_at);
    }
    v3 axis = azimuth ? v3_make(0, 1, 0) : m3_column(A_CA, 2);
    if (!azimuth)
        place = v3_add(place, m3_apply(A_CA, v3_from(platform->elevation.hinge_at)));
    v3_store(self->axis, axis);
    v3_store(self->turn, axis);
    v3_store(self->turn + 3, m3_apply(A_IC, v3_cross(place, axis)));
}

static ld_status choose_columns(ld_loop *self, const ld_model *model, int hinge, ld_error *error)
{
    const ld_platform *platform = model_platform(model);
    char column[sizeof self->command];
    const char *const names[SEEN] = {column,       "chassis.wx", "chassis.wy", "chassis.wz",
                                     "chassis.vx", "chassis.vy", "chassis.vz"};
    snprintf(column, sizeof column, "%s.error", model_hinge_name(model, hinge));
    snprintf(self->command, sizeof self->command, "%s.command", model_hinge_name(model, hinge));
    place_hinge(self, platform, model_hinge(model, hinge) == &platform->azimuth);
    self->seen = SEEN;
    return ld_response_choose(self->response, names, SEEN, error);
}

// The rate about the joint stands where that of the chassis along the hinge does.
static ld_status choose_of_drive(ld_loop *self, const char *name, ld_error *error)
{
    enum { OF_DRIVE = 2 };
    char column[OF_DRIVE][sizeof self->command];
    const char *const names[OF_DRIVE] = {column[0], column[1]};
    snprintf(column[0], sizeof column[0], "drive.%.60s.error", name);
    snprintf(column[1], sizeof column[1], "drive.%.60s.base_rate", name);
    snprintf(self->command, sizeof self->command, "drive.%.60s.command", name);
    self->axis[0] = 1;
    self->seen = OF_DRIVE;
    return ld_response_choose(self->response, names, OF_DRIVE, error);
}

static ld_status check_lateness(const ld_loop *self, ld_error *error)
{
    if (self->margins.delay > 0)
        return LD_OK;
    return ld_fail(
        error, LD_ERR_INPUT,
        "%s: unstable: delay and half the period are %.3g ms, the loop's delay margin is "
        "%.3g ms",
        self->path, 1e3 * self->late, 1e3 * self->lateness);
}

static ld_status build(ld_loop *self, const ld_model *model, const char *name, ld_error *error)
{
    int hinge = 0;
    bool vehicle = model_has_vehicle(model);
    if (!vehicle && !model_has_multibody(model))
        return ld_fail(error, LD_ERR_INPUT,
                       "there is no loop: the base is neither a vehicle nor multibody");
    ld_status status = vehicle ? find_hinge(self, model, name, &hinge, error)
                               : find_drive(self, &model_base(model)->mechanism, name, error);
    if (status)
        return status;
    self->speed = vehicle ? model_base(model)->vehicle.speed : 0;
    const ld_stabiliser *given = self->stabiliser;
    self->late = given->sample > 0 ? given->delay + 0.5 * given->sample : 0;
    status = response_create(model, NAN, NAN, false, &self->response, error);
    if (!status)
        status = vehicle ? choose_columns(self, model, hinge, error)
                         : choose_of_drive(self, name, error);
    if (!status)
        status = find_margins(self, error);
    return status ? status : check_lateness(self, error);
}

ld_status ld_loop_create(const ld_model *model, const char *hinge, ld_loop **loop, ld_error *error)
{
    *loop = NULL;
    ld_loop *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the loop");
    ld_status status = build(self, model, hinge, error);
    if (status)
        ld_loop_free(self);
    else
        *loop = self;
    return status;
}

void ld_loop_free(ld_loop *loop)
{
    if (!loop)
        return;
    ld_response_free(loop->response);
    free(loop);
}

// ---- what is asked ----

ld_status ld_loop_points(ld_loop *self, const double *frequency, size_t count, ld_loop_point *point,
                         ld_error *error)
{
    look at;
    ld_status status = LD_OK;
    for (size_t i = 0; i < count && !status; i++) {
        status = evaluate_at(self, frequency[i], &at, error);
        if (!status)
            point[i] =
                (ld_loop_point){phasor(at.open), phasor(tracking(&at)), phasor(sensitivity(&at))};
    }
    return status;
}

// Rates of the chassis per force and moment, complex numbers as real ones; factored.
typedef struct held_chassis {
    double matrix[4 * WAYS * WAYS];
    int pivot[2 * WAYS];
    double complex error[WAYS]; // per force or moment
} held_chassis;

// What forces and moments on the chassis do, one by one.
static ld_status evaluate_held_chassis(const ld_loop *self, double frequency, held_chassis *by,
                                       ld_error *error)
{
    static const char *const push[WAYS] = {"chassis.force_x",  "chassis.force_y",
                                           "chassis.force_z",  "chassis.moment_x",
                                           "chassis.moment_y", "chassis.moment_z"};
    double complex seen[SEEN];
    for (int j = 0; j < WAYS; j++) {
        ld_status status = evaluate_columns(self, push[j], frequency, seen, error);
        if (status)
            return status;
        by->error[j] = seen[0];
        for (int i = 0; i < WAYS; i++) {
            double *row = by->matrix + 2 * WAYS * i + j, *below = row + 2 * WAYS * WAYS;
            row[0] = below[WAYS] = creal(seen[1 + i]);
            below[0] = cimag(seen[1 + i]);
            row[WAYS] = -below[0];
        }
    }
    if (lu_factor(2 * WAYS, by->matrix, by->pivot))
        return ld_fail(error, LD_ERR_NUMERIC, "at %g Hz no forces hold the chassis", frequency);
    return LD_OK;
}

// The error where forces give the chassis these rates.
static double complex error_at(const held_chassis *by, const double complex rate[WAYS])
{
    double push[2 * WAYS];
    double complex sum = 0;
    for (int i = 0; i < WAYS; i++) {
        push[i] = creal(rate[i]);
        push[WAYS + i] = cimag(rate[i]);
    }
    lu_solve(2 * WAYS, by->matrix, by->pivot, push);
    for (int i = 0; i < WAYS; i++)
        sum += by->error[i] * (push[i] + I * push[WAYS + i]);
    return sum;
}

// With the chassis held the loop as it is at once gives L and what comes through without it; late,
// both the loop and its feedforward are.
static ld_status evaluate_rejection(const ld_loop *self, double frequency,
                                    double complex *rejection, ld_error *error)
{
    held_chassis by;
    double complex seen[SEEN], turn[WAYS], s = I * TWO_PI * frequency;
    ld_status status = evaluate_held_chassis(self, frequency, &by, error);
    if (!status)
        status = evaluate_columns(self, self->command, frequency, seen, error);
    if (status)
        return status;
    for (int i = 0; i < WAYS; i++) {
        turn[i] = s * self->turn[i];
        seen[1 + i] = -seen[1 + i];
    }
    double complex left = seen[0] + error_at(&by, seen + 1), open = (1 - left) / left;
    double complex fed = open * s * feedforward(self->stabiliser, s),
                   delay = delay_of(self, frequency);
    double complex through = -error_at(&by, turn) * (1 + open) + fed;
    *rejection = (through - delay * fed) / (1 + delay * open);
    return LD_OK;
}

ld_status ld_loop_rejection(ld_loop *self, const double *frequency, size_t count,
                            ld_phasor *rejection, ld_error *error)
{
    double complex at;
    ld_status status = LD_OK;
    if (!ld_loop_has_rejection(self))
        return ld_fail(error, LD_ERR_INPUT,
                       "%s: the rejection is that of a vehicle's chassis, the base is multibody",
                       self->path);
    for (size_t i = 0; i < count && !status; i++) {
        status = evaluate_rejection(self, frequency[i], &at, error);
        if (!status)
            rejection[i] = phasor(at);
    }
    return status;
}

bool ld_loop_has_rejection(const ld_loop *loop)
{
    return loop->seen == SEEN;
}

void ld_loop_margins_of(const ld_loop *loop, ld_loop_margins *margins)
{
    *margins = loop->margins;
}
