// The linear response of a vehicle, whose wheels stand unequally to its left and right, and of the
// same as bodies, joints and drives: two descriptions, two expansions, the same transfer functions.
#include <complex.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/response.h"
#include "launchdyn/scenario.h"
#include "support/check.h"

enum { FREQUENCIES = 5 };
static const double frequency[FREQUENCIES] = {0.4, 1.6, 3.27, 9, 31}; // [Hz]

// Columns of both, by the names that each has for them.
static const struct {
    const char *of_vehicle, *of_bodies;
} column[] = {
    {"base.yaw", "base.yaw"},
    {"base.pitch", "base.pitch"},
    {"base.roll", "base.roll"},
    {"chassis.y", "body.chassis.y"},
    {"chassis.vz", "body.chassis.vz"},
    {"chassis.roll", "body.chassis.roll"},
    {"chassis.wy", "body.chassis.wy"},
    {"azimuth.torque", "drive.yaw.torque"},
    {"elevation.torque", "drive.pitch.torque"},
    {"elevation.error", "drive.pitch.error"},
    {"wheel.front-left.tyre_force", "wheel.front-left.tyre_force"},
    {"wheel.rear-right.tyre_force", "wheel.rear-right.tyre_force"},
    {"wheel.rear-left.side", "wheel.rear-left.side"},
    {"wheel.middle-right.along", "wheel.middle-right.along"},
    {"tip.inertial_vy", "tip.inertial_vy"},
    {"tip.inertial_yaw", "tip.inertial_yaw"},
    {"tip_off.yaw_rate", "tip_off.yaw_rate"},
    {"rocket.pitch_rate", "rocket.pitch_rate"},
    {"lock.force", "lock.force"},
};
enum { COLUMNS = sizeof column / sizeof *column };

static const char *const input[] = {
    "wheel.front-left.road", "wheel.front-right.road", "wheel.middle-left.road",
    "wheel.rear-right.road", "platform.force_z",       "platform.moment_z",
    "tip.force_y",           "tip.moment_y",           "rocket.force_z",
};
enum { INPUTS = sizeof input / sizeof *input, ROADS = 4 };

typedef struct launcher {
    ld_model *model;
    ld_response *response;
} launcher;

static launcher read_launcher(const char *path, const char *speed)
{
    launcher self;
    ld_error error;
    ld_messages messages;
    char set[64];
    const char *const sets[] = {set};
    snprintf(set, sizeof set, "base.speed=%s", speed);
    if (ld_scenario_read(path, sets, 1, &self.model, &messages)) {
        ld_messages_print(&messages, stderr);
        fail_msg("%s", path);
    }
    if (ld_response_create(self.model, NAN, NAN, &self.response, &error))
        fail_msg("%s", error.text);
    return self;
}

static void free_launcher(launcher *self)
{
    ld_response_free(self->response);
    ld_model_free(self->model);
}

// Of all columns, [column][frequency].
static void gains(launcher *self, double speed, const char *by, bool bodies, ld_phasor *gain)
{
    const char *names[COLUMNS];
    ld_error error;
    for (int i = 0; i < COLUMNS; i++)
        names[i] = bodies ? column[i].of_bodies : column[i].of_vehicle;
    if (ld_response_choose(self->response, names, COLUMNS, &error) ||
        ld_response_gain(self->response, speed, by, frequency, FREQUENCIES, gain, &error))
        fail_msg("%s", error.text);
}

static double complex number(ld_phasor gain)
{
    return gain.real + I * gain.imaginary;
}

// The largest difference of column `i` over the largest that the input does to it.
static double compare(ld_phasor (*a)[COLUMNS], ld_phasor (*b)[COLUMNS], int i)
{
    double most = 0, off = 0;
    for (int k = 0; k < FREQUENCIES; k++) {
        most = fmax(most, cabs(number(a[k][i])));
        off = fmax(off, cabs(number(a[k][i]) - number(b[k][i])));
    }
    return most > 0 ? off / most : off;
}

// Loads do next to nothing to some columns, which differences then leave uncertain.
static void same_at(const char *speed_text, double speed)
{
    ld_phasor one[FREQUENCIES][COLUMNS], other[FREQUENCIES][COLUMNS];
    launcher vehicle = read_launcher(LD_SOURCE_DIR "/examples/firm.yaml", speed_text);
    launcher bodies = read_launcher(LD_SOURCE_DIR "/tests/data/multibody/firm.yaml", speed_text);
    double worst[2] = {0};
    for (int j = 0; j < INPUTS; j++) {
        gains(&vehicle, speed, input[j], false, one[0]);
        gains(&bodies, speed, input[j], true, other[0]);
        for (int i = 0; i < COLUMNS; i++)
            worst[j < ROADS] = fmax(worst[j < ROADS], compare(one, other, i));
    }
    printf("    at %s:\n", speed_text);
    CHECK_BELOW("to the road under each of four wheels, relative", worst[1], 1e-7);
    CHECK_BELOW("to loads on platform, tube, rocket, relative", worst[0], 3e-5);
    free_launcher(&vehicle);
    free_launcher(&bodies);
}

static void unequal_sides(void **state)
{
    (void)state;
    same_at("30 km/h", 30 / 3.6);
    same_at("5 km/h", 5 / 3.6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(unequal_sides)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
