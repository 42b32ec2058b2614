// A base that an FMU moves (base.kind: fmu; fmi.md): a platform on springs whose motion is known in
// closed form under the reference launcher, by FMI 2 and 3.
#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "foreign/foreign.h"
#include "launch/launch_run.h"
#include "launchdyn/run.h"
#include "math/vectors/rotation_vector.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "support/check.h"
#include "support/made_fmu.h"
#include "support/scratch.h"

// ---- scenarios

typedef struct on_platform {
    ld_model model;
    ld_simulation *simulation;
} on_platform;

// The example on a fixed base with this in the place of its base's kind. Status of the reading.
static ld_status read_with(const char *base, const char *const *sets, size_t count, ld_model *model,
                           char *message, size_t size)
{
    size_t length;
    char *text = read_whole(LD_SOURCE_DIR "/examples/fixed.yaml", &length), *whole = NULL;
    char *kind = strstr(text, "  kind: fixed\n"), *after = kind + strlen("  kind: fixed\n");
    ld_messages messages = {0};
    assert_non_null(kind);
    FILE *to = open_memstream(&whole, &length);
    if (strstr(base, "external")) // which reports the tube's own frame
        after = strchr(after, '\n') + 1;
    fprintf(to, "%.*s%s%s", (int)(kind - text), text, base, after);
    fclose(to);
    ld_status status =
        scenario_read_text(whole, length, "platform.yaml", folder, sets, count, model, &messages);
    if (status && messages.count)
        snprintf(message, size, "%s", messages.item[0].text);
    free(whole);
    free(text);
    return status;
}

#define ON_PLATFORM_2 "  kind: fmu\n  file: platform2.fmu\n  step: 1 ms\n"
#define RAMPED "  kind: fmu\n  file: ramped.fmu\n  step: 1 ms\n  inputs: ramped\n"
#define ON_PLATFORM_3 "  kind: fmu\n  file: platform3.fmu\n  step: 1 ms\n"

static on_platform begin(const char *base, double tolerance, double step)
{
    on_platform self = {.simulation = NULL};
    char message[640] = "";
    if (read_with(base, NULL, 0, &self.model, message, sizeof message))
        fail_msg("%s", message);
    self.model.run.tolerance = tolerance;
    self.model.run.lead_in = 0.02;
    self.model.base.fmu.step = step;
    return self;
}

static void simulate(on_platform *self)
{
    ld_error error;
    if (ld_simulation_create(&self->model, &self->simulation, &error))
        fail_msg("%s", error.text);
}

static void end(on_platform *self)
{
    ld_simulation_free(self->simulation);
    model_clear(&self->model);
}

static ld_run *start(on_platform *self)
{
    ld_run *run;
    ld_error error;
    simulate(self);
    if (ld_run_begin(self->simulation, NULL, &run, &error))
        fail_msg("%s", error.text);
    return run;
}

static double number(ld_run *run, const char *name)
{
    double value;
    ld_error error;
    if (ld_run_number(run, name, &value, &error))
        fail_msg("%s", error.text);
    return value;
}

static void go_to(ld_run *run, double t)
{
    ld_error error;
    if (ld_run_advance(run, t, &error))
        fail_msg("%s", error.text);
}

// ---- a launch, and how its error falls with the step

typedef struct outcome {
    double pitch_rate, yaw_rate; // [rad/s] at the exit
    double missing;              // [J] of the work that the launcher says it did on the base
    double largest;              // [J] of that work
} outcome;

static outcome shoot(const char *base, double step)
{
    on_platform self = begin(base, 1e-10, step);
    ld_run *run = start(&self);
    ld_summary summary;
    ld_error error;
    go_to(run, INFINITY);
    double work = number(run, "work.base");
    outcome out = {.missing = work + number(run, "base.fmu_work"), .largest = fabs(work)};
    assert_int_equal(ld_run_end(run, &summary, &error), LD_OK);
    out.pitch_rate = summary.rocket[0].pitch_rate;
    out.yaw_rate = summary.rocket[0].yaw_rate;
    end(&self);
    return out;
}

// The platform's steps against a fine one, with inputs that it holds.
static void the_error_falls_with_the_square_of_the_step(void **state)
{
    (void)state;
    outcome at[4];
    double exact, error[3];
    for (int i = 0; i < 4; i++)
        at[i] = shoot(ON_PLATFORM_3, 1e-3 / (1 << 2 * i));
    exact = at[3].pitch_rate + (at[3].pitch_rate - at[2].pitch_rate) / 15;
    for (int i = 0; i < 3; i++)
        error[i] = 1e3 * fabs(at[i].pitch_rate - exact);
    CHECK_WITHIN("order, 1 to 0.0625 ms", log2(error[0] / error[2]) / 4, 1.8, 2.3);
    CHECK_BELOW("pitch rate at 1 ms [mrad/s]", error[0], 0.8);
    CHECK_BELOW("at 0.25 ms", error[1], 0.05);
    CHECK_BELOW("at 0.0625 ms", error[2], 3.5e-3);
    for (int i = 0; i < 3; i++)
        error[i] = fabs(at[i].missing) / at[i].largest;
    CHECK_BELOW("work missed between the two, of its size, at 1 ms", error[0], 2e-2);
    CHECK_BELOW("at 0.25 ms", error[1], 2e-4);
    CHECK_BELOW("at 0.0625 ms", error[2], 1e-5);
}

// With the rates of the wrench: against the same with a wrench that is held (FMI 2 tells the same).
static void with_rates_of_inputs_the_order_is_three(void **state)
{
    (void)state;
    outcome held[2], at[3];
    double exact, error[3];
    for (int i = 0; i < 2; i++)
        held[i] = shoot(ON_PLATFORM_3, 1e-3 / (16 << 2 * i));
    exact = held[1].pitch_rate + (held[1].pitch_rate - held[0].pitch_rate) / 15;
    for (int i = 0; i < 3; i++) {
        at[i] = shoot(RAMPED, 1e-3 / (i == 2 ? 8 : 1 << 2 * i));
        error[i] = 1e3 * fabs(at[i].pitch_rate - exact);
    }
    CHECK_WITHIN("order of ramped inputs, 1 to 0.125 ms", log2(error[0] / error[2]) / 3, 2.8, 3.5);
    CHECK_BELOW("pitch rate, ramped, at 1 ms [mrad/s]", error[0], 0.3);
    CHECK_BELOW("ramped, at 0.25 ms", error[1], 4e-3);
    CHECK_BELOW("ramped, at 0.125 ms", error[2], 5e-4);
    for (int i = 0; i < 3; i++)
        error[i] = fabs(at[i].missing) / at[i].largest;
    CHECK_BELOW("work missed by the ramp, of its size, at 1 ms", error[0], 4e-3);
    CHECK_BELOW("work missed by it at 0.25 ms", error[1], 1e-3);
    CHECK_BELOW("work missed by it at 0.125 ms", error[2], 2e-4);
}

static void both_versions_of_FMI_tell_the_same(void **state)
{
    (void)state;
    outcome two = shoot(ON_PLATFORM_2, 1e-3), three = shoot(ON_PLATFORM_3, 1e-3);
    assert_memory_equal(&two, &three, sizeof two);
}

// ---- against a program that moves an external base by the same springs

// The platform of tests/fmu/platform_fmu.c: mass, stiffness, damping; it has as much of each about
// its axes.
static const double M = 1000, K = 1e6, C = 2e3, G = 9.81;

// x'' = (F - K x - C x')/M over h, F held: trapezoidal rule in many parts.
static void swing(double F, double h, double *x, double *u)
{
    enum { PARTS = 50 };
    double d = h / PARTS;
    for (int i = 0; i < PARTS; i++) {
        double a = (F - K * *x - C * *u) / M;
        double next = (*u + 0.5 * d * (a + (F - K * (*x + 0.5 * d * *u)) / M)) /
                      (1 + 0.5 * d * C / M + 0.25 * d * d * K / M);
        *x += 0.5 * d * (*u + next);
        *u = next;
    }
}

// With the tube on it.
static ld_base_frame frame_of(const double x[6], const double u[6])
{
    const double elevation = 19.8 * 3.14159265358979323846 / 180;
    ld_base_frame frame;
    v3 turn = v3_from(x + 3);
    quat q = q_from_matrix(m3_mul(rv_exp(turn), m3_rotation_z(elevation)));
    memcpy(frame.position, x, sizeof frame.position);
    memcpy(frame.quaternion, &q, sizeof q);
    memcpy(frame.velocity, u, sizeof frame.velocity);
    v3_store(frame.rate, m3_apply(rv_left_jacobian(turn), v3_from(u + 3)));
    return frame;
}

// Pitch rate at the exit [rad/s] of a launcher that is reported at every step.
static double shoot_told(double step)
{
    on_platform self = begin("  kind: external\n", 1e-9, 0);
    on_platform by_fmu = begin(ON_PLATFORM_3, 1e-9, step);
    double x[6] = {0}, u[6] = {0};
    ld_base_wrench wrench, last;
    ld_summary summary;
    ld_error error;
    ld_run *first = start(&by_fmu), *run;
    assert_int_equal(ld_run_base_wrench(first, &wrench, &error), LD_OK);
    ld_run_end(first, NULL, NULL);
    double *load[] = {wrench.force, wrench.moment}, *before[] = {last.force, last.moment};
    for (int i = 0; i < 6; i++)
        x[i] = (load[i / 3][i % 3] - (i == 1 ? M * G : 0)) / K;
    simulate(&self);
    ld_base_frame frame = frame_of(x, u);
    assert_int_equal(ld_run_begin(self.simulation, &(ld_run_options){.base = &frame}, &run, &error),
                     LD_OK);
    last = wrench;
    for (int k = 1; !ld_run_is_finished(run); k++) {
        assert_int_equal(ld_run_base_wrench(run, &wrench, &error), LD_OK);
        for (int i = 0; i < 6; i++) {
            double now = load[i / 3][i % 3], mean = now + 0.5 * (now - before[i / 3][i % 3]);
            swing(mean - (i == 1 ? M * G : 0), step, &x[i], &u[i]);
        }
        last = wrench;
        go_to(run, -self.model.run.lead_in + k * step);
        frame = frame_of(x, u);
        if (!ld_run_is_finished(run))
            assert_int_equal(ld_run_set_base(run, &frame, &error), LD_OK);
    }
    assert_int_equal(ld_run_end(run, &summary, &error), LD_OK);
    end(&self);
    end(&by_fmu);
    return summary.rocket[0].pitch_rate;
}

static void it_moves_as_a_base_that_a_program_moves(void **state)
{
    (void)state;
    double step = 0.0625e-3, told = shoot_told(step),
           by_fmu = shoot(ON_PLATFORM_3, step).pitch_rate;
    CHECK_BELOW("pitch rate, against a base told by a program [mrad/s]", 1e3 * (told - by_fmu),
                3e-4);
}

// ---- at rest

static void it_rests_where_its_springs_carry_all(void **state)
{
    (void)state;
    on_platform self =
        begin(ON_PLATFORM_2 "  at: 0.5 0.25 -0.125 m\n  azimuth: 30 deg\n", 1e-8, 1e-3);
    self.model.run.lead_in = 1;
    ld_run *run = start(&self);
    ld_base_wrench on;
    ld_error error;
    assert_int_equal(ld_run_base_wrench(run, &on, &error), LD_OK);
    double y = number(run, "base.y"), z = number(run, "base.z"), tip = number(run, "tip.y");
    // the platform's place and rotation vector from the wrench about its own point
    v3 F = v3_from(on.force), arm = v3_make(0.5, 0.25, -0.125), turn = v3_zero(), r = arm;
    for (int i = 0; i < 20; i++) {
        v3 moment = v3_add(v3_from(on.moment), v3_cross(m3_apply(rv_exp(turn), arm), F));
        turn = v3_scale(1 / K, moment);
        r = v3_add(m3_apply(rv_exp(turn), arm), v3_scale(1 / K, v3_sub(F, v3_make(0, M * G, 0))));
    }
    CHECK_WITHIN("sag [mm]", 1e3 * (0.25 - y), 5, 20);
    CHECK_BELOW("height, against the springs [m]", y - r.y, 1e-11);
    CHECK_BELOW("place across, against them [m]", z - r.z, 1e-11);
    go_to(run, -1e-3);
    CHECK_BELOW("height a second later [m]", number(run, "base.y") - y, 5e-10);
    CHECK_BELOW("place across [m]", number(run, "base.z") - z, 5e-10);
    CHECK_BELOW("the tube's tip [m]", number(run, "tip.y") - tip, 1e-9);
    ld_run_end(run, NULL, NULL);
    end(&self);
}

static void angles_and_body_rates_tell_the_same(void **state)
{
    (void)state;
    outcome one = shoot(ON_PLATFORM_3, 1e-3);
    outcome other =
        shoot(ON_PLATFORM_3 "  rate_axes: body\n"
                            "  connect: {angles: yaw pitch roll, angular_rate: body_rate.x "
                            "body_rate.y body_rate.z}\n",
              1e-3);
    CHECK_BELOW("pitch rate [mrad/s]", 1e3 * (one.pitch_rate - other.pitch_rate), 1e-6);
    CHECK_BELOW("yaw rate [mrad/s]", 1e3 * (one.yaw_rate - other.yaw_rate), 1e-6);
}

static double sag(const char *base)
{
    on_platform self = begin(base, 1e-7, 1e-3);
    ld_run *run = start(&self);
    double y = number(run, "base.y");
    ld_run_end(run, NULL, NULL);
    end(&self);
    return y;
}

static void parameters_reach_it(void **state)
{
    (void)state;
    double soft = sag(ON_PLATFORM_2 "  parameters: [{name: stiffness, value: 5e5}]\n");
    CHECK_NEAR("sag on springs half as stiff", soft / sag(ON_PLATFORM_2), 2, 1e-9);
}

static void texts_reach_it(void **state)
{
    (void)state;
    double two = sag(ON_PLATFORM_2), three = sag(ON_PLATFORM_3);
    double soft_2 = sag(ON_PLATFORM_2 "  parameters: [{name: tuning, text: half as stiff}]\n"),
           soft_3 = sag(ON_PLATFORM_3 "  parameters: [{name: tuning, text: half as stiff}]\n");
    CHECK_NEAR("sag on springs half as stiff, FMI 2", soft_2 / two, 2, 1e-9);
    CHECK_NEAR("FMI 3", soft_3 / three, 2, 1e-9);
}

// Where a ramp leads it within a step, from rest without damping and gravity; `mishap`: how the
// platform breaks the step off (platform_fmu.c).
static void check_ramp(int mishap, const char *name)
{
    enum { FORCE_Y = 1, POSITION_Y = 11, DAMPING = 32, GRAVITY = 36, MISHAP = 40 };
    const double force = 1500, rate = -4e5, h = 2e-3, omega = sqrt(K / M), phase = omega * h;
    const foreign_value before[] = {{.reference = DAMPING},
                                    {.reference = GRAVITY},
                                    {.reference = MISHAP, .type = FOREIGN_INT32, .value = mishap}};
    const foreign_value value[] = {{.reference = FORCE_Y, .value = force, .rate = rate},
                                   {.reference = POSITION_Y}};
    const foreign_stepping step = {
        .t = 0.5, .size = h, .inputs = 1, .outputs = 1, .with_rates = true};
    foreign_package *package;
    foreign_instance *fmu;
    ld_error error;
    double y;
    int pieces;
    assert_int_equal(foreign_open(in("ramped.fmu"), &package, &error), LD_OK);
    assert_int_equal(foreign_begin(package, 10, &fmu, &error), LD_OK);
    assert_int_equal(foreign_set(fmu, 0, before, 3, &error), LD_OK);
    assert_int_equal(foreign_enter(fmu, 0, step.t, &error), LD_OK);
    assert_int_equal(foreign_leave(fmu, 0, &error), LD_OK);
    if (foreign_step(fmu, 0, &step, value, &y, &pieces, &error))
        fail_msg("%s", error.text);
    // m y'' + k y = F + s t
    double exact = force / K * (1 - cos(phase)) + rate / K * (h - sin(phase) / omega);
    assert_true(mishap ? pieces > 4 : pieces == 1);
    CHECK_BELOW(name, y / exact - 1, 1.5e-13);
    foreign_end(fmu);
    foreign_close(package);
}

static void a_ramp_moves_it_as_in_closed_form(void **state)
{
    (void)state;
    check_ramp(0, "place at the end of a ramp, of its own size");
    check_ramp(4, "a ramp in quarters of a millisecond");
    check_ramp(5, "in halves of halves, from the start of each");
}

// Half of the platform under half of the wrench.
static void rates_are_in_the_units_of_the_FMU(void **state)
{
    (void)state;
    outcome one = shoot(RAMPED, 1e-3);
    outcome half = shoot("  kind: fmu\n  file: two_newtons.fmu\n  step: 1 ms\n  inputs: ramped\n"
                         "  parameters: [{name: mass, value: 500}, {name: stiffness, value: 5e5},"
                         "{name: damping, value: 1e3}, {name: inertia, value: 500}, "
                         "{name: turning.stiffness, value: 5e5}, "
                         "{name: turning.damping, value: 1e3}]\n",
                         1e-3);
    CHECK_BELOW("pitch rate, by a unit of two newtons [mrad/s]",
                1e3 * (one.pitch_rate - half.pitch_rate), 1e-10);
}

// An array is set and got as a whole.
static void arrays_reach_it(void **state)
{
    (void)state;
    foreign_package *package;
    foreign_instance *fmu;
    ld_error error;
    const double springs[3] = {1, 2, 4};
    double got[5];
    foreign_value value[5] = {{0}};
    assert_int_equal(foreign_open(in("platform3.fmu"), &package, &error), LD_OK);
    assert_int_equal(foreign_begin(package, 10, &fmu, &error), LD_OK);
    const foreign_variable *array = foreign_variable_find(&package->description, "springs");
    assert_int_equal(array->elements, 3);
    for (int i = 0; i < 3; i++)
        value[i + 1] = (foreign_value){.reference = array->reference,
                                       .type = (int32_t)array->type,
                                       .value = springs[i],
                                       .elements = array->elements};
    value[0] = value[4] = (foreign_value){.reference = 36, .value = 9}; // gravity
    assert_int_equal(foreign_set(fmu, 0, value, 5, &error), LD_OK);
    assert_int_equal(foreign_get(fmu, 0, value, 5, got, &error), LD_OK);
    for (int i = 0; i < 5; i++)
        assert_true(got[i] == value[i].value);
    // a part of it
    assert_int_not_equal(foreign_set(fmu, 0, value, 3, &error), LD_OK);
    foreign_end(fmu);
    foreign_close(package);
}

// Velocities and accelerations of the tube off the FMU's frame between two instants, against
// differences of places and velocities: a frame that turns by 0.4 rad about no axis of its own.
static void the_tube_moves_as_its_rates_say(void **state)
{
    (void)state;
    on_platform self = begin(ON_PLATFORM_2 "  at: 0.5 0.25 -0.125 m\n", 1e-7, 0.1);
    base_system base;
    ld_error error;
    base_frame at[3];
    base_found found;
    double y[BASE_MOST_STATES] = {0, 0.1}, worst[4] = {0};
    const v3 turn = v3_make(0.2, -0.3, 0.17), rate = v3_make(3, -2, 1);
    quat q = q_from_matrix(rv_exp(turn));
    const double h = 1e-5, frames[26] = {0,   0,   0,  1, 0,   0,      0,      1,     2,
                                         -1,  1,   -4, 2, 0.1, 0.25,   -0.1,   q.w,   q.x,
                                         q.y, q.z, 2,  1, 0,   rate.x, rate.y, rate.z};
    memcpy(y + 2, frames, sizeof frames);
    assert_int_equal(base_build(&base, &self.model, NULL, &error), LD_OK);
    for (double t = 0.01; t < 0.095; t += 0.02) {
        for (int i = 0; i < 3; i++)
            base.kind->find_frame(&base, t + (i - 1) * h, y, &at[i], &found);
        m3 turned = m3_mul(at[2].A, m3_transpose(at[0].A));
        const v3 of[4][2] = {{v3_sub(at[2].r, at[0].r), at[1].v},
                             {v3_sub(at[2].v, at[0].v), at[1].a},
                             {rv_log(turned), at[1].w},
                             {v3_sub(at[2].w, at[0].w), at[1].alpha}};
        for (int i = 0; i < 4; i++)
            worst[i] = fmax(worst[i], v3_norm(v3_sub(v3_scale(0.5 / h, of[i][0]), of[i][1])));
    }
    CHECK_BELOW("velocity [m/s]", worst[0], 1e-7);
    CHECK_BELOW("acceleration [m/s2]", worst[1], 1e-7);
    CHECK_BELOW("angular velocity [rad/s]", worst[2], 3e-8);
    CHECK_BELOW("angular acceleration [rad/s2]", worst[3], 1e-7);
    base_free(&base);
    end(&self);
}

// ---- steps that it does not take whole

static void a_step_broken_off_goes_on(void **state)
{
    (void)state;
    outcome whole = shoot(ON_PLATFORM_2, 1e-3), two, three, stuck;
    two = shoot(ON_PLATFORM_2 "  parameters: [{name: mishap, value: 4}]\n", 1e-3);
    three = shoot(ON_PLATFORM_3 "  parameters: [{name: mishap, value: 4}]\n", 1e-3);
    stuck = shoot(ON_PLATFORM_2 "  parameters: [{name: mishap, value: 5}]\n", 1e-3);
    CHECK_BELOW("pitch rate, in quarters [mrad/s]", 1e3 * (two.pitch_rate - whole.pitch_rate),
                1e-5);
    CHECK_BELOW("by FMI 3", 1e3 * (three.pitch_rate - whole.pitch_rate), 1e-5);
    CHECK_BELOW("in halves of halves, from the start of each",
                1e3 * (stuck.pitch_rate - whole.pitch_rate), 1e-5);
}

// A unit that steps by 0.1 ms, or by 10 s, of its own says that it has come to the last of these.
// At these steps t + h, minus t, is not always h.
static void a_unit_of_fixed_steps_is_where_it_was_sent(void **state)
{
    (void)state;
    static const double steps[] = {0.4e-3, 0.7e-3, 1.5e-3, 4e-3};
    double worst = 0;
    for (int i = 0; i < 4; i++) {
        double whole = shoot(ON_PLATFORM_3, steps[i]).pitch_rate;
        double fixed = shoot(ON_PLATFORM_3 "  parameters: [{name: mishap, value: 12}, "
                                           "{name: mishap_at, value: 1e-4}]\n",
                             steps[i])
                           .pitch_rate;
        worst = fmax(worst, 1e3 * fabs(fixed - whole));
    }
    CHECK_BELOW("pitch rate, in steps of its own [mrad/s]", worst, 1e-4);

    on_platform self = begin(ON_PLATFORM_3 "  parameters: [{name: mishap, value: 12}, {name: "
                                           "mishap_at, value: 10}]\n",
                             1e-7, 1.5e-3);
    ld_run *run = start(&self);
    double at_start = number(run, "base.y");
    go_to(run, 0.05);
    CHECK_BELOW("one that has not stepped yet has not moved [m]", number(run, "base.y") - at_start,
                0);
    ld_run_end(run, NULL, NULL);
    end(&self);
}

// ---- what goes wrong in it

static const struct {
    int mishap;
    const char *in[2]; // by FMI 2 and 3
} mishaps[] = {
    {1,
     {"the FMU ended with signal 11 (Segmentation fault) in fmi2DoStep at t = ",
      "the FMU ended with signal 11 (Segmentation fault) in fmi3DoStep at t = "}},
    {2,
     {"the FMU did not return within 0.2 s in fmi2DoStep at t = ",
      "the FMU did not return within 0.2 s in fmi3DoStep at t = "}},
    {3,
     {"the FMU ended itself (exit code 3) in fmi2DoStep at t = ",
      "the FMU ended itself (exit code 3) in fmi3DoStep at t = "}},
    {6,
     {"the FMU reports that base.position.y is nan at t = ",
      "the FMU reports that base.position.y is nan at t = "}},
    {7,
     {"the FMU reports an error in fmi2DoStep at t = -0.005 s: the platform has had enough",
      "the FMU reports an error in fmi3DoStep at t = -0.005 s: the platform has had enough"}},
    {9,
     {"the FMU requests the end of the simulation in fmi2DoStep at t = ",
      "the FMU requests the end of the simulation in fmi3DoStep at t = "}},
    {11,
     {"the FMU has moved by 0.001 (m, or of its quaternion) when its initialization ends",
      "the FMU has moved by 0.001 (m, or of its quaternion) when its initialization ends"}},
    {8, {NULL, NULL}}, // noise
    {13,
     {"the FMU closed the connection to its process in fmi2DoStep at t = ",
      "the FMU closed the connection to its process in fmi3DoStep at t = "}},
};

static void expect_end(int version, int i)
{
    char base[512];
    ld_summary summary;
    ld_error error = {0};
    const char *expected = mishaps[i].in[version - 2];
    snprintf(base, sizeof base,
             "%s  time_limit: %s\n  parameters: [{name: mishap, value: %d}, {name: mishap_at, "
             "value: 0.0155}]\n",
             version == 2 ? ON_PLATFORM_2 : ON_PLATFORM_3,
             mishaps[i].mishap == 2 ? "0.2 s" : "60 s", mishaps[i].mishap);
    on_platform self = begin(base, 1e-7, 1e-3);
    simulate(&self);
    ld_status status = ld_simulation_run(self.simulation, NULL, &summary, &error);
    if (expected) {
        assert_int_equal(status, LD_ERR_NUMERIC);
        if (!strstr(error.text, expected) || !strstr(error.text, ".fmu: "))
            fail_msg("\"%s\" is not in: %s", expected, error.text);
    } else {
        assert_int_equal(status, LD_OK);
    }
    end(&self);
}

static void what_goes_wrong_is_one_sentence(void **state)
{
    (void)state;
    for (int version = 2; version <= 3; version++)
        for (size_t i = 0; i < sizeof mishaps / sizeof *mishaps; i++)
            expect_end(version, (int)i);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); // no process is left
}

// One that closes its connection takes nothing from others of its package.
static void the_package_stays_for_others(void **state)
{
    (void)state;
    enum { MISHAP = 40, DEAF = 13, TIMES = 3 };
    foreign_package *package;
    foreign_instance *fmu;
    ld_error error;
    int pieces;
    const foreign_value mishap = {.reference = MISHAP, .type = FOREIGN_INT32, .value = DEAF};
    assert_int_equal(foreign_open(in("platform3.fmu"), &package, &error), LD_OK);
    for (int i = 0; i < TIMES; i++) {
        if (foreign_begin(package, 60, &fmu, &error))
            fail_msg("%s", error.text);
        assert_int_equal(foreign_set(fmu, 0, &mishap, 1, &error), LD_OK);
        assert_int_equal(foreign_enter(fmu, 0, 0, &error), LD_OK);
        assert_int_equal(foreign_leave(fmu, 0, &error), LD_OK);
        const foreign_stepping step = {.size = 1e-3};
        assert_int_equal(foreign_step(fmu, 0, &step, NULL, NULL, &pieces, &error), LD_ERR_NUMERIC);
        assert_non_null(strstr(error.text, "closed the connection"));
        foreign_end(fmu);
    }
    foreign_close(package);
}

// An FMU that ends the process which runs it leaves neither a process nor a folder.
static void nothing_is_left_when_it_ends_who_asks(void **state)
{
    (void)state;
    for (int mishap = 14; mishap <= 15; mishap++) {
        int end_of[2], how;
        char byte, base[256];
        snprintf(base, sizeof base,
                 ON_PLATFORM_2 "  parameters: [{name: mishap, value: %d}, {name: mishap_at, "
                               "value: 0.0155}]\n",
                 mishap);
        assert_int_equal(pipe(end_of), 0);
        int open_as_long = fcntl(end_of[1], F_DUPFD, 20); // beyond those that its process is given
        close(end_of[1]);
        pid_t asking = fork();
        if (asking == 0) {
            on_platform self = begin(base, 1e-7, 1e-3);
            ld_run *run = start(&self);
            ld_run_advance(run, 0.01, NULL);
            ld_run_end(run, NULL, NULL);
            _exit(1);
        }
        assert_int_equal(waitpid(asking, &how, 0), asking);
        assert_true(WIFSIGNALED(how) && WTERMSIG(how) == SIGKILL);
        close(open_as_long); // here; its process has it as long as it lives
        assert_int_equal(read(end_of[0], &byte, 1), 0);
        close(end_of[0]);
        assert_int_equal(rmdir(in("unpacked")), 0);
        assert_int_equal(mkdir(in("unpacked"), 0700), 0);
    }
}

// ---- scenarios that do not fit the FMU

static const struct {
    const char *base, *in;
} unfit[] = {
    {"  file: platform2.fmu\n  step: 1 ms\n  connect: {force: input.wrench.force.x "
     "input.wrench.force.z}\n",
     "base.connect.force: \"input.wrench.force.x input.wrench.force.z\" has 2 names; expected 3"},
    {"  file: platform2.fmu\n  step: 1 ms\n  connect: {angles: yaw pitch roll pitch}\n",
     "base.connect.angles: \"yaw pitch roll pitch\" has more than 3 names"},
    {"  file: platform2.fmu\n  step: 1 ms\n  connect: {angles: yaw pitsch roll}\n",
     "platform2.fmu has no variable \"pitsch\"; did you mean \"pitch\"?"},
    {"  file: platform2.fmu\n  step: 1 ms\n  connect: {angles: yaw pitch roll, quaternion: a b c "
     "d}\n",
     "base.connect.angles: given together with quaternion; give one of them"},
    {"  file: platform3.fmu\n  step: 1 ms\n  connect: {angles: yaw pitch mishap}\n",
     "variable mishap is of type Int32; expected a Float64"},
    {"  file: platform3.fmu\n  step: 1 ms\n  connect: {angles: yaw pitch base.position.x}\n",
     "variable base.position.x has the unit m; expected one of rad"},
    {"  file: platform3.fmu\n  step: 1 ms\n  connect: {moment: yaw pitch roll}\n",
     "variable yaw has the causality output; expected input"},
    {"  file: platform3.fmu\n  step: 1 ms\n  connect: {angles: input.wrench.force.x pitch roll}\n",
     "variable input.wrench.force.x has the causality input; expected one to be read"},
    {"  file: platform3.fmu\n  step: 1 ms\n  parameters: [{name: stifness, value: 1}]\n",
     "platform3.fmu has no variable \"stifness\"; did you mean \"stiffness\"?"},
    {"  file: platform3.fmu\n  step: 1 ms\n  parameters: [{name: yaw, value: 1}]\n",
     "platform3.fmu: variable yaw (output, Float64) cannot be set to a number"},
    {"  file: platform3.fmu\n  step: 1 ms\n  parameters: [{name: mass, value: 1}, {name: springs, "
     "value: 1}]\n",
     "base.parameters.2: "},
    {"  file: platform3.fmu\n  step: 1 ms\n  parameters: [{name: springs, value: 1}]\n",
     "variable springs (parameter, array of Float64) cannot be set to a number"},
    {"  file: platform3.fmu\n  step: 1 ms\n  parameters: [{name: three, value: 1}]\n",
     "variable three (structuralParameter, UInt64) cannot be set to a number"},
    {"  file: platform3.fmu\n  step: 1 ms\n  parameters: [{name: mass, text: big}]\n",
     "variable mass (parameter, Float64) cannot be set to a text"},
    {"  file: platform3.fmu\n  step: 1 ms\n  parameters: [{name: mass, text: big, value: 1}]\n",
     "base.parameters.1: mass: expected one of value and text"},
    {"  file: platform3.fmu\n  step: 1 ms\n  parameters: [{name: mass}]\n",
     "base.parameters.1: mass: expected one of value and text"},
    {"  file: nameless.fmu\n  step: 1 ms\n",
     "nameless.fmu has no variable \"base.position.x\", the default of "
     "base.connect.position; did you mean \"bass.position.x\"?"},
    {"  file: platform3.fmu\n  step: 1 ms\n  inputs: ramped\n",
     "platform3.fmu: found ramped, but the FMU takes no rates of its inputs (FMI 2.0, "
     "canInterpolateInputs); expected held or extrapolated"},
    {"  file: platform3.fmu\n  step: 1 ms\n  connect: {angles: springs pitch roll}\n",
     "variable springs is an array of Float64; expected a Float64"},
};

static void what_does_not_fit_is_one_sentence(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof unfit / sizeof *unfit; i++) {
        char base[512];
        ld_error error = {0};
        snprintf(base, sizeof base, "  kind: fmu\n%s", unfit[i].base);
        on_platform self = begin(base, 1e-7, 1e-3);
        assert_int_equal(ld_simulation_create(&self.model, &self.simulation, &error), LD_ERR_INPUT);
        if (!strstr(error.text, unfit[i].in))
            fail_msg("\"%s\" is not in: %s", unfit[i].in, error.text);
        model_clear(&self.model);
    }
}

// ---- saved and loaded

static void a_run_is_saved_where_the_FMU_gives_its_state(void **state)
{
    (void)state;
    on_platform self = begin(ON_PLATFORM_3, 1e-7, 1e-3);
    ld_run *run = start(&self), *other;
    ld_summary whole, rest;
    ld_error error;
    size_t size;
    static char bytes[1 << 17];
    go_to(run, 0.0123);
    if (ld_run_save(run, bytes, sizeof bytes, &size, &error))
        fail_msg("%s", error.text);
    if (ld_run_load(self.simulation, NULL, bytes, size, &other, &error))
        fail_msg("%s", error.text);
    go_to(run, INFINITY);
    go_to(other, INFINITY);
    assert_true(number(run, "base.fmu_work") == number(other, "base.fmu_work"));
    assert_int_equal(ld_run_end(run, &whole, &error), LD_OK);
    assert_int_equal(ld_run_end(other, &rest, &error), LD_OK);
    assert_memory_equal(&whole.rocket[0].exit, &rest.rocket[0].exit, sizeof whole.rocket[0].exit);
    end(&self);
}

static void a_run_is_not_saved_where_it_does_not(void **state)
{
    (void)state;
    on_platform self = begin(ON_PLATFORM_2, 1e-7, 1e-3);
    ld_run *run = start(&self);
    ld_error error;
    size_t size;
    assert_int_equal(ld_run_save(run, NULL, 0, &size, &error), LD_ERR_INPUT);
    if (!strstr(error.text, "the FMU cannot serialise its own"))
        fail_msg("%s", error.text);
    ld_run_end(run, NULL, NULL);
    end(&self);
}

// ---- several runs side by side, each with an instance of its own

static void *run_one(void *simulation)
{
    static ld_summary summary[4];
    static atomic_int next;
    ld_summary *own = &summary[atomic_fetch_add(&next, 1)];
    ld_error error;
    return ld_simulation_run(simulation, NULL, own, &error) ? NULL : own;
}

static void threads_have_an_instance_each(void **state)
{
    (void)state;
    on_platform self = begin(ON_PLATFORM_2, 1e-7, 1e-3);
    pthread_t thread[4];
    void *out[4];
    simulate(&self);
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, run_one, self.simulation), 0);
    for (int i = 0; i < 4; i++) {
        pthread_join(thread[i], &out[i]);
        assert_non_null(out[i]);
        const ld_summary *first = out[0], *this = out[i];
        assert_memory_equal(&first->rocket[0].exit, &this->rocket[0].exit,
                            sizeof first->rocket[0].exit);
    }
    end(&self);
}

static int make_all(void **state)
{
    if (scratch_make(state))
        return -1;
    make_platform(in("platform2.fmu"), 2, PLATFORM_KEEPS_2);
    make_platform(in("platform3.fmu"), 3, PLATFORM_SAVES_3);
    make_nameless_platform(in("nameless.fmu"));
    make_platform(in("ramped.fmu"), 2, PLATFORM_RAMPED_2);
    make_platform_of_two_newtons(in("two_newtons.fmu"));
    // where packages are unpacked
    return mkdir(in("unpacked"), 0700) || setenv("TMPDIR", in("unpacked"), 1);
}

// Nothing is left of any package.
static int remove_all(void **state)
{
    if (rmdir(in("unpacked")))
        return -1;
    return scratch_remove(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_error_falls_with_the_square_of_the_step),
        cmocka_unit_test(with_rates_of_inputs_the_order_is_three),
        cmocka_unit_test(a_ramp_moves_it_as_in_closed_form),
        cmocka_unit_test(rates_are_in_the_units_of_the_FMU),
        cmocka_unit_test(both_versions_of_FMI_tell_the_same),
        cmocka_unit_test(it_moves_as_a_base_that_a_program_moves),
        cmocka_unit_test(it_rests_where_its_springs_carry_all),
        cmocka_unit_test(angles_and_body_rates_tell_the_same),
        cmocka_unit_test(parameters_reach_it),
        cmocka_unit_test(texts_reach_it),
        cmocka_unit_test(arrays_reach_it),
        cmocka_unit_test(the_tube_moves_as_its_rates_say),
        cmocka_unit_test(a_step_broken_off_goes_on),
        cmocka_unit_test(a_unit_of_fixed_steps_is_where_it_was_sent),
        cmocka_unit_test(what_goes_wrong_is_one_sentence),
        cmocka_unit_test(the_package_stays_for_others),
        cmocka_unit_test(nothing_is_left_when_it_ends_who_asks),
        cmocka_unit_test(what_does_not_fit_is_one_sentence),
        cmocka_unit_test(a_run_is_saved_where_the_FMU_gives_its_state),
        cmocka_unit_test(a_run_is_not_saved_where_it_does_not),
        cmocka_unit_test(threads_have_an_instance_each),
    };
    return cmocka_run_group_tests(tests, make_all, remove_all);
}
