// The linear response by what must hold between its parts; tests/verification compares it with
// runs.
#include <complex.h>
#include <stdlib.h>

#include "environment/road.h"
#include "launchdyn/response.h"
#include "model/model.h"
#include "support/check.h"
#include "support/reference_model.h"

static const double two_pi = 6.283185307179586476925, speed = 8;

static void random_road(ld_model *model, ld_tracks tracks)
{
    reference_vehicle(model, speed);
    ld_road *rough = &model->base.vehicle.road;
    rough->form = LD_ROAD_SUM;
    rough->iso_class = 1;
    rough->tracks = tracks;
    rough->harmonics = 60;
    rough->wavelengths[0] = 0.3;
    rough->wavelengths[1] = 100;
}

static ld_response *respond(const ld_model *model, double slowest, double fastest)
{
    ld_response *response;
    ld_error error;
    if (ld_response_create(model, slowest, fastest, &response, &error))
        fail_msg("%s", error.text);
    return response;
}

static void choose(ld_response *response, const char *const *names, size_t count)
{
    ld_error error;
    if (ld_response_choose(response, names, count, &error))
        fail_msg("%s", error.text);
}

static double complex gain_of(ld_response *response, double at_speed, const char *input,
                              const char *name, double frequency)
{
    ld_phasor gain;
    ld_error error;
    choose(response, &name, 1);
    if (ld_response_gain(response, at_speed, input, &frequency, 1, &gain, &error))
        fail_msg("%s", error.text);
    return gain.real + I * gain.imaginary;
}

// ---- speeds ----

static const char *const some[] = {"chassis.vy",      "chassis.roll",    "chassis.z",
                                   "azimuth.torque",  "tip.inertial_vz", "tip_off.vy",
                                   "rocket.yaw_rate", "lock.force",      "wheel.rear-left.side"};
enum { SOME = sizeof some / sizeof *some };

// The matrices depend on the speed as on a straight line: those of any speed follow from two.
static void between_two_speeds_all_is_known(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    double one[SOME], many[SOME], worst = 0;
    random_road(&model, LD_TRACKS_INDEPENDENT);
    ld_response *at = respond(&model, NAN, NAN), *over = respond(&model, 3, 20);
    ld_response *from_rest = respond(&model, 0, 9);
    choose(at, some, SOME);
    choose(over, some, SOME);
    choose(from_rest, some, SOME);
    assert_int_equal(ld_response_on_road(at, speed, one, NULL, &error), LD_OK);
    assert_int_equal(ld_response_on_road(over, 5, many, NULL, &error), LD_OK);
    assert_int_equal(ld_response_on_road(over, speed, many, NULL, &error), LD_OK);
    for (int i = 0; i < SOME; i++)
        worst = fmax(worst, fabs(many[i] / one[i] - 1));
    assert_int_equal(ld_response_on_road(from_rest, speed, many, NULL, &error), LD_OK);
    for (int i = 0; i < SOME; i++)
        worst = fmax(worst, fabs(many[i] / one[i] - 1));
    CHECK_BELOW("rms from matrices of other speeds, relative", worst, 1e-6);
    ld_response_free(at);
    ld_response_free(over);
    ld_response_free(from_rest);
    reference_model_free(&model);
}

// ---- road ----

// Two wheels between the tracks, which lie beside the others.
static void spread_tracks(ld_model *model)
{
    ld_vehicle *vehicle = &model->base.vehicle;
    vehicle->road.places[0] = -1.4;
    vehicle->road.places[1] = 1.05;
    vehicle->wheel[2].mount[2] = -0.3;
    vehicle->wheel[3].mount[2] = 0.5;
}

// All wheels, each at its time, are the road; the two tracks are, too, each by its shares.
static void wheels_make_the_road(void **state)
{
    (void)state;
    ld_model model;
    double worst = 0;
    random_road(&model, LD_TRACKS_SAME);
    spread_tracks(&model);
    ld_response *response = respond(&model, NAN, NAN);
    for (double f = 0.3; f < 40; f *= 3.1)
        for (int i = 0; i < SOME; i++) {
            double complex all = gain_of(response, speed, "road", some[i], f), wheels = 0,
                           on_right = 0;
            double complex left = gain_of(response, speed, "road.left", some[i], f);
            double complex right = gain_of(response, speed, "road.right", some[i], f);
            double size = cabs(left) + cabs(right);
            for (int j = 0; j < model.base.vehicle.wheel_count; j++) {
                const ld_wheel *wheel = &model.base.vehicle.wheel[j];
                char input[LD_MAX_NAME + 16];
                snprintf(input, sizeof input, "wheel.%s.road", wheel->name);
                double complex one = cexp(I * two_pi * f * wheel->mount[0] / speed) *
                                     gain_of(response, speed, input, some[i], f);
                wheels += one;
                on_right += fmin((wheel->mount[2] + 1.4) / 2.45, 1) * one;
            }
            worst = fmax(worst, cabs(left + right - all) / size);
            worst = fmax(worst, cabs(on_right - right) / size);
            worst = fmax(worst, cabs(wheels - all) / size);
        }
    // the wheels rest some tenths of a millimetre beside their mounts
    CHECK_BELOW("sum over wheels and over tracks, relative", worst, 1e-2);
    ld_response_free(response);
    reference_model_free(&model);
}

static void rms_with(ld_tracks tracks, const double *share, double rms[SOME])
{
    ld_model model;
    ld_error error;
    random_road(&model, tracks);
    if (share)
        model.base.vehicle.road.coherence = reference_table(1, 2, share);
    ld_response *response = respond(&model, NAN, NAN);
    choose(response, some, SOME);
    assert_int_equal(ld_response_on_road(response, speed, rms, NULL, &error), LD_OK);
    ld_response_free(response);
    free(model.base.vehicle.road.coherence.data);
    model.base.vehicle.road.coherence = (ld_table){0};
    reference_model_free(&model);
}

// Tracks that share all are the same, those that share nothing are independent; mean squares of
// tracks in between lie where their share says.
static void coherence_goes_from_independent_to_same(void **state)
{
    (void)state;
    double same[SOME], independent[SOME], all[SOME], nothing[SOME], some_of_it[SOME], worst = 0;
    rms_with(LD_TRACKS_SAME, NULL, same);
    rms_with(LD_TRACKS_INDEPENDENT, NULL, independent);
    rms_with(LD_TRACKS_COHERENT, (double[]){1, 1}, all);
    rms_with(LD_TRACKS_COHERENT, (double[]){1, 0}, nothing);
    rms_with(LD_TRACKS_COHERENT, (double[]){1, 0.6}, some_of_it);
    for (int i = 0; i < SOME; i++) {
        double one = same[i] * same[i], other = independent[i] * independent[i];
        double between = other + 0.6 * (one - other);
        worst = fmax(worst, fabs(all[i] - same[i]) / independent[i]);
        worst = fmax(worst, fabs(nothing[i] / independent[i] - 1));
        worst = fmax(worst, fabs(some_of_it[i] * some_of_it[i] / between - 1));
    }
    CHECK_BELOW("rms of tracks that share all, nothing, 0.6", worst, 1e-9);
}

// What a wheel meets is the road itself: its mean square, its density, its lines.
static void the_road_is_among_the_columns(void **state)
{
    (void)state;
    static const char *const under[] = {"wheel.front-left.road", "wheel.rear-right.road"};
    ld_model model;
    ld_error error;
    double rms[2], strongest[2], density[2], n[2] = {1 / 100.0, 1 / 0.3}, square = 0, f = 2;
    random_road(&model, LD_TRACKS_INDEPENDENT);
    model.base.vehicle.road.sine_count = 3;
    model.base.vehicle.road.sine[0] = (ld_road_sine){0.05, 4, 0.2};
    model.base.vehicle.road.sine[1] = (ld_road_sine){0.04, 4, 0.2};
    model.base.vehicle.road.sine[2] = (ld_road_sine){0.01, 5, 0};
    ld_response *response = respond(&model, NAN, NAN);
    choose(response, under, 2);
    // class B: 64e-6 m3 at 0.1/m
    square = 64e-6 * 0.01 * (1 / n[0] - 1 / n[1]) + (0.09 * 0.09 + 0.01 * 0.01) / 2;
    assert_int_equal(ld_response_on_road(response, speed, rms, strongest, &error), LD_OK);
    CHECK_BELOW("rms of the road, left", rms[0] / sqrt(square) - 1, 1e-9);
    CHECK_BELOW("right", rms[1] / sqrt(square) - 1, 1e-9);
    CHECK_BELOW("its strongest line [Hz]", strongest[0] - speed / 4, 1e-12);
    assert_int_equal(ld_response_density(response, speed, &f, 1, density, &error), LD_OK);
    CHECK_BELOW("its density", density[1] * speed / (64e-6 * pow(0.1 * speed / f, 2)) - 1, 1e-9);
    f = 1.01 * speed / 0.3;
    assert_int_equal(ld_response_density(response, speed, &f, 1, density, &error), LD_OK);
    assert_true(density[0] == 0 && density[1] == 0);
    ld_response_free(response);
    reference_model_free(&model);
}

// Between independent tracks a wheel meets (1 - w)^2 + w^2 of their mean square, w the right one's
// share, and all of the sines, which are on both.
static void between_the_tracks_the_road_is_smoother(void **state)
{
    (void)state;
    static const char *const under[] = {"wheel.middle-left.road", "wheel.rear-right.road"};
    ld_model model;
    ld_error error;
    double rms[2], random = 64e-6 * 0.01 * (100 - 0.3), sine = 0.02 * 0.02 / 2, w = 1.1 / 2.45;
    random_road(&model, LD_TRACKS_INDEPENDENT);
    spread_tracks(&model);
    model.base.vehicle.road.sine_count = 1;
    model.base.vehicle.road.sine[0] = (ld_road_sine){0.02, 5, 0};
    ld_response *response = respond(&model, NAN, NAN);
    choose(response, under, 2);
    assert_int_equal(ld_response_on_road(response, speed, rms, NULL, &error), LD_OK);
    double between = ((1 - w) * (1 - w) + w * w) * random + sine;
    CHECK_BELOW("rms between the tracks", rms[0] / sqrt(between) - 1, 1e-9);
    CHECK_BELOW("on the right one", rms[1] / sqrt(random + sine) - 1, 1e-9);
    ld_response_free(response);
    reference_model_free(&model);
}

// ---- forces, slowly ----

static double carried(ld_response *response, const ld_vehicle *vehicle, const char *input,
                      bool lever)
{
    double sum = 0;
    for (int j = 0; j < vehicle->wheel_count; j++) {
        char name[LD_MAX_NAME + 32];
        snprintf(name, sizeof name, "wheel.%s.tyre_force", vehicle->wheel[j].name);
        sum += creal(gain_of(response, speed, input, name, 1e-3)) *
               (lever ? vehicle->wheel[j].mount[0] : 1);
    }
    return sum;
}

static void wheels_carry_what_is_put_on(void **state)
{
    (void)state;
    ld_model model;
    random_road(&model, LD_TRACKS_SAME);
    const ld_vehicle *vehicle = &model.base.vehicle;
    ld_response *response = respond(&model, NAN, NAN);
    double elevation = model.platform.elevation.stabiliser.command.data[1];
    CHECK_BELOW("a force upwards on the chassis [N per N]",
                carried(response, vehicle, "chassis.force_y", false) + 1, 1e-4);
    CHECK_BELOW("across the tube on the platform",
                carried(response, vehicle, "platform.force_y", false) + cos(elevation), 1e-4);
    CHECK_BELOW("along the tube",
                carried(response, vehicle, "platform.force_x", false) + sin(elevation), 1e-4);
    // as it pitches, the weights move over the wheels
    CHECK_BELOW("a moment on the chassis [N m per N m]",
                carried(response, vehicle, "chassis.moment_z", true) + 1, 3e-2);
    CHECK_BELOW("on the platform", carried(response, vehicle, "platform.moment_z", true) + 1, 3e-2);
    ld_response_free(response);
    reference_model_free(&model);
}

// What is put on tube or rocket comes to the wheels through lock, adaptors and supports.
static void wheels_carry_what_is_put_on_the_tube(void **state)
{
    (void)state;
    static const char *const parts[] = {"tip", "rocket"};
    ld_model model;
    random_road(&model, LD_TRACKS_SAME);
    const ld_vehicle *vehicle = &model.base.vehicle;
    ld_response *response = respond(&model, NAN, NAN);
    double elevation = model.platform.elevation.stabiliser.command.data[1];
    for (int i = 0; i < 2; i++) {
        char input[32];
        snprintf(input, sizeof input, "%s.force_y", parts[i]);
        CHECK_BELOW("a force across the tube [N per N]",
                    carried(response, vehicle, input, false) + cos(elevation), 3e-4);
        snprintf(input, sizeof input, "%s.force_x", parts[i]);
        CHECK_BELOW("along it", carried(response, vehicle, input, false) + sin(elevation), 3e-4);
        snprintf(input, sizeof input, "%s.moment_z", parts[i]);
        CHECK_BELOW("a moment [N m per N m]", carried(response, vehicle, input, true) + 1, 3e-2);
    }
    ld_response_free(response);
    reference_model_free(&model);
}

// What a force does to the position of another one, that one does to the position of the first
// (Maxwell, Rayleigh), at any frequency.
static void loads_and_places_change_sides(void **state)
{
    (void)state;
    static const struct {
        const char *load, *at; // its position's speed
    } of[] = {
        {"tip.force_y", "tip.vy"},
        {"tip.force_z", "tip.vz"},
        {"rocket.force_y", "tip_off.vy"},
        {"rocket.force_z", "tip_off.vz"},
        {"rocket.moment_z", "rocket.pitch_rate"},
        {"tip.moment_z", "tip.pitch_rate"},
        {"tip.moment_y", "tip.yaw_rate"},
    };
    enum { OF = sizeof of / sizeof *of };
    ld_model model;
    double worst = 0;
    reference_model(&model);
    model.gravity = 0;
    model.rocket.contact.law = LD_CONTACT_BILATERAL;
    model.rocket.contact.friction = 0;
    ld_response *response = respond(&model, NAN, NAN);
    for (double f = 0.5; f < 100; f *= 4)
        for (int i = 0; i < OF; i++)
            for (int j = 0; j < i; j++) {
                double complex a = gain_of(response, 0, of[i].load, of[j].at, f);
                double complex b = gain_of(response, 0, of[j].load, of[i].at, f);
                double complex p = gain_of(response, 0, of[i].load, of[i].at, f);
                double complex q = gain_of(response, 0, of[j].load, of[j].at, f);
                worst = fmax(worst, cabs(a - b) / sqrt(cabs(p * q)));
            }
    CHECK_BELOW("what one does to the other, of what each does to itself", worst, 1e-7);
    ld_response_free(response);
    reference_model_free(&model);
}

// ---- an input that is random ----

static void a_density_becomes_a_root_mean_square(void **state)
{
    (void)state;
    static const char *const column[] = {"base.y"};
    static const double f[] = {2, 5, 8}, density[] = {0, 4e-6, 0};
    ld_model model;
    ld_error error;
    double rms, strongest;
    reference_model(&model);
    ld_response *response = respond(&model, NAN, NAN);
    choose(response, column, 1);
    assert_int_equal(
        ld_response_random(response, 0, "base.y", f, density, 3, &rms, &strongest, &error), LD_OK);
    CHECK_BELOW("rms of the input itself", rms / sqrt(12e-6) - 1, 1e-9);
    CHECK_BELOW("strongest at [Hz]", strongest - 5, 1e-2);
    assert_int_equal(ld_response_random(response, 0, "base.y", (double[]){5, 5}, density, 2, &rms,
                                        &strongest, &error),
                     LD_ERR_INPUT);
    assert_string_equal(error.text, "a spectral density requires at least two points, with rising "
                                    "frequencies and no value below 0");
    ld_response_free(response);
    reference_model_free(&model);
}

// The road's own density, given as that of the input "road", and the sum of its sines.
static void the_road_as_a_density(void **state)
{
    (void)state;
    static const char *const seen[] = {"chassis.vy", "lock.force", "elevation.error"};
    enum { POINTS = 400, SEEN = 3 };
    ld_model model;
    ld_error error;
    double lines[SEEN], rms[SEEN], strongest[SEEN], f[POINTS], density[POINTS], worst = 0;
    random_road(&model, LD_TRACKS_SAME);
    model.base.vehicle.road.harmonics = 2000;
    ld_response *response = respond(&model, NAN, NAN);
    choose(response, seen, SEEN);
    for (int i = 0; i < POINTS; i++) {
        f[i] = speed / 100 * pow(100 / 0.3, i / (POINTS - 1.0));
        density[i] = road_class_density(1, f[i] / speed) / speed;
    }
    assert_int_equal(ld_response_on_road(response, speed, lines, NULL, &error), LD_OK);
    assert_int_equal(
        ld_response_random(response, speed, "road", f, density, POINTS, rms, strongest, &error),
        LD_OK);
    for (int i = 0; i < SEEN; i++)
        worst = fmax(worst, fabs(rms[i] / lines[i] - 1));
    CHECK_BELOW("rms from the density against that from 2000 sines", worst, 1e-3);
    ld_response_free(response);
    reference_model_free(&model);
}

// ---- hinges that rub ----

// Mean over a normal rate of deviation s of the slope of b/sqrt(b^2 + r^2).
static double slope_at(double s, double r)
{
    double sum = 0, step = 1e-3;
    for (double z = -8; z < 8; z += step)
        sum += step * exp(-z * z / 2) / sqrt(two_pi) * r * r / pow(s * s * z * z + r * r, 1.5);
    return sum;
}

// Their friction is the viscous one that the rates found with it call for.
static void friction_of_hinges_is_a_viscous_one(void **state)
{
    (void)state;
    static const char *const rates[] = {"azimuth.rate", "elevation.rate", "elevation.error"};
    ld_model model;
    ld_error error;
    double rub[3], viscous[3], plain[3], worst = 0;
    random_road(&model, LD_TRACKS_INDEPENDENT);
    ld_response *response = respond(&model, NAN, NAN);
    choose(response, rates, 3);
    assert_int_equal(ld_response_on_road(response, speed, plain, NULL, &error), LD_OK);
    assert_int_equal(ld_response_friction(response, true, &error), LD_OK);
    assert_int_equal(ld_response_on_road(response, speed, rub, NULL, &error), LD_OK);
    ld_response_free(response);
    ld_turret *turret[2] = {&model.platform.azimuth, &model.platform.elevation};
    // without it they have none
    ld_model smooth = model;
    smooth.platform.azimuth.friction.coulomb = smooth.platform.elevation.friction.coulomb = 0;
    response = respond(&smooth, NAN, NAN);
    choose(response, rates, 3);
    assert_int_equal(ld_response_on_road(response, speed, viscous, NULL, &error), LD_OK);
    ld_response_free(response);
    for (int i = 0; i < 3; i++)
        worst = fmax(worst, fabs(viscous[i] / plain[i] - 1));
    CHECK_BELOW("hinges that do not rub, or that cannot", worst, 1e-9);
    for (int i = 0; i < 2; i++) {
        ld_hinge_friction *friction = &turret[i]->friction;
        assert_true(friction->coulomb > 0 && rub[i] < 0.99 * plain[i]);
        friction->viscous += friction->coulomb * slope_at(rub[i], friction->rate);
    }
    response = respond(&model, NAN, NAN);
    choose(response, rates, 3);
    assert_int_equal(ld_response_on_road(response, speed, viscous, NULL, &error), LD_OK);
    for (int i = 0; i < 3; i++)
        worst = fmax(worst, fabs(viscous[i] / rub[i] - 1));
    CHECK_BELOW("rms with friction, with a viscous one like it", worst, 1e-3);
    ld_response_free(response);
    reference_model_free(&model);
}

// ---- a base with a given motion ----

static void a_slow_base_takes_all_along(void **state)
{
    (void)state;
    static const char *const inputs[] = {"base.x", "base.y", "base.z", "base.yaw", "base.pitch"};
    static const char *const tips[] = {"tip.inertial_x", "tip.inertial_y", "tip.inertial_z",
                                       "rocket.yaw", "rocket.pitch"};
    ld_model model;
    double worst = 0;
    reference_model(&model);
    ld_response *response = respond(&model, NAN, NAN);
    for (int i = 0; i < 5; i++) {
        worst = fmax(worst, cabs(gain_of(response, 0, inputs[i], tips[i], 0.05) - 1));
        worst = fmax(worst, cabs(gain_of(response, 0, inputs[i], inputs[i], 20) - 1));
    }
    CHECK_BELOW("tip, rocket and the base itself", worst, 1e-4);
    ld_response_free(response);
    reference_model_free(&model);
}

// The reference tube on a wall and a pin, k: springs [N/m] in their place, 0: rigid.
static void hold_rigidly(ld_model *model, double k)
{
    static const unsigned held[] = {0x3f, 1u << LD_CLAMP_Y | 1u << LD_CLAMP_Z};
    reference_model(model);
    model->gravity = 0;
    model->rocket.contact.law = LD_CONTACT_BILATERAL;
    model->rocket.contact.friction = 0;
    model->tubes.station_count = 1;
    model->tubes.station[0] = (ld_station){.at = 1, .outer_fibre = {NAN, NAN}};
    for (int i = 0; i < 2; i++) {
        ld_support support = {.at = model->tubes.support[i].at, .clamped = k > 0 ? 0 : held[i]};
        for (int a = 0; a < 3; a++) {
            support.stiffness[a] = held[i] >> a & 1u ? k : 0;
            support.rotational_stiffness[a] = held[i] >> (3 + a) & 1u ? k : 0;
        }
        model->tubes.support[i] = support;
    }
}

// The tip against I across the undeformed tube, per unit of an input.
static double complex across(ld_response *response, const ld_model *model, const char *input,
                             double f)
{
    double elevation = model->base.elevation;
    return cos(elevation) * gain_of(response, 0, input, "tip.inertial_y", f) -
           sin(elevation) * gain_of(response, 0, input, "tip.inertial_x", f);
}

// What a base that clamps hold the tube on does to the tip, the tip's force does to the base
// (Maxwell), at any frequency; slowly it takes the tip along.
static void clamps_carry_the_base_to_the_tip(void **state)
{
    (void)state;
    ld_model model;
    double aside = 0, turning = 0, slow = 0;
    hold_rigidly(&model, 0);
    ld_response *response = respond(&model, NAN, NAN);
    for (double f = 0.5; f < 100; f *= 6) {
        double complex z = gain_of(response, 0, "base.z", "tip.inertial_z", f);
        double complex y = across(response, &model, "base.pitch", f), force = 0, moment = 0;
        for (int k = 0; k < 2; k++) {
            char name[2][32];
            snprintf(name[0], sizeof name[0], "support.%d.force_z", k + 1);
            force += gain_of(response, 0, "tip.force_z", name[0], f);
            snprintf(name[0], sizeof name[0], "support.%d.force_y", k + 1);
            snprintf(name[1], sizeof name[1], "support.%d.moment_z", k + 1);
            moment += gain_of(response, 0, "tip.force_y", name[1], f) +
                      model.tubes.support[k].at * gain_of(response, 0, "tip.force_y", name[0], f);
        }
        aside = fmax(aside, cabs(z + force) / cabs(z));
        turning = fmax(turning, cabs(y + moment) / cabs(y));
        slow = f == 0.5 ? cabs(z - 1) : slow;
    }
    CHECK_BELOW("tip aside per base, and force on the base per tip's", aside, 1e-8);
    CHECK_BELOW("tip across per turn of the base, and moment per tip's force", turning, 1e-8);
    CHECK_BELOW("tip less base at 0.5 Hz", slow, 1e-3);
    ld_response_free(response);
    reference_model_free(&model);
}

// Clamps are the limit of springs for a base that moves.
static void clamps_are_stiff_springs(void **state)
{
    (void)state;
    static const char *const inputs[] = {"base.x", "base.y", "base.yaw", "base.roll"};
    static const char *const tips[] = {"tip.inertial_vx", "tip.inertial_vy", "tip.inertial_vz",
                                       "tip.inertial_vz"};
    ld_model rigid, stiff;
    double off[4];
    hold_rigidly(&rigid, 0);
    hold_rigidly(&stiff, 1e9);
    ld_response *response[] = {respond(&rigid, NAN, NAN), respond(&stiff, NAN, NAN)};
    for (int i = 0; i < 4; i++) {
        double complex a = gain_of(response[0], 0, inputs[i], tips[i], 40);
        double complex b = gain_of(response[1], 0, inputs[i], tips[i], 40);
        off[i] = cabs(a - b) / cabs(b);
        printf("  %s: %.6g, on springs %.6g\n", inputs[i], cabs(a), cabs(b));
        CHECK_BELOW("springs of 1e9 N/m off clamps, relative", off[i], 2e-2);
    }
    for (int i = 0; i < 2; i++)
        ld_response_free(response[i]);
    reference_model_free(&rigid);
    reference_model_free(&stiff);
}

// ---- what is wrong ----

static void wrong_names_and_ranges_are_told(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    ld_response *response, *none;
    double f = -1, rms[1];
    ld_phasor gain[1];
    random_road(&model, LD_TRACKS_SAME);
    response = respond(&model, 2, 4);
    const char *name = "chassis.vz_";
    assert_int_equal(ld_response_choose(response, &name, 1, &error), LD_ERR_INPUT);
    assert_string_equal(error.text,
                        "unknown quantity \"chassis.vz_\", did you mean \"chassis.vz\"?");
    name = "chassis.vz";
    choose(response, &name, 1);
    assert_int_equal(ld_response_gain(response, 3, "raod", &f, 1, gain, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "unknown input \"raod\", did you mean \"road\"?");
    assert_int_equal(ld_response_gain(response, 3, "road", &f, 1, gain, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "found -1 Hz, expected a frequency above 0");
    assert_int_equal(ld_response_on_road(response, 5, rms, NULL, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "a speed of 5 m/s is not within the range that was linearised");
    assert_int_equal(ld_response_on_road(response, 0, rms, NULL, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "the response to the road requires a speed above 0");
    assert_int_equal(ld_response_create(&model, 5, 4, &none, &error), LD_ERR_INPUT);
    assert_string_equal(
        error.text, "found speeds from 5 m/s to 4 m/s, expected a rising range from 0 to 1000 m/s");
    assert_null(none);
    ld_response_free(response);
    // a stabiliser that feeds what it ought to hold
    model.platform.elevation.stabiliser.kd = -1e5;
    assert_int_equal(ld_response_create(&model, NAN, NAN, &none, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "platform.elevation.stabiliser: unstable"));
    ld_response_free(NULL);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(between_two_speeds_all_is_known),
        cmocka_unit_test(wheels_make_the_road),
        cmocka_unit_test(coherence_goes_from_independent_to_same),
        cmocka_unit_test(the_road_is_among_the_columns),
        cmocka_unit_test(between_the_tracks_the_road_is_smoother),
        cmocka_unit_test(wheels_carry_what_is_put_on),
        cmocka_unit_test(wheels_carry_what_is_put_on_the_tube),
        cmocka_unit_test(loads_and_places_change_sides),
        cmocka_unit_test(a_density_becomes_a_root_mean_square),
        cmocka_unit_test(the_road_as_a_density),
        cmocka_unit_test(friction_of_hinges_is_a_viscous_one),
        cmocka_unit_test(a_slow_base_takes_all_along),
        cmocka_unit_test(clamps_carry_the_base_to_the_tip),
        cmocka_unit_test(clamps_are_stiff_springs),
        cmocka_unit_test(wrong_names_and_ranges_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
