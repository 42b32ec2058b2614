// Columns of the history against each other: the tip in inertial space from base and relative tip,
// and rates and velocities from differences.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "math/vectors/mat3.h"
#include "quantities/summary.h"
#include "scenario/scenario.h"

enum { ROWS = 10000, COLUMNS = 32 };

// The columns that are checked, in this order.
static const char *const wanted[COLUMNS] = {
    "t",
    "base.x",
    "base.y",
    "base.z",
    "base.yaw",
    "base.pitch",
    "base.roll",
    "tip.y",
    "tip.z",
    "tip.pitch",
    "tip.yaw",
    "tip.inertial_x",
    "tip.inertial_y",
    "tip.inertial_z",
    "tip.inertial_pitch",
    "tip.inertial_yaw",
    "tip.inertial_pitch_rate",
    "tip.inertial_yaw_rate",
    "tip.inertial_vx",
    "tip.inertial_vy",
    "tip.inertial_vz",
    "rocket.psi",
    "rocket.theta",
    "rocket.gamma",
    "rocket.psi_dot",
    "rocket.theta_dot",
    "rocket.gamma_dot",
    "rocket.w_x",
    "rocket.w_y",
    "rocket.w_z",
};
enum { T, BASE, YAW = 4, PITCH, ROLL, TIP_Y, TIP_Z, TIP_PITCH, TIP_YAW, AT, I_PITCH = 14, I_YAW };
enum { TIP_V = 18, PSI = 21, PSI_DOT = 24, W = 27 };

typedef struct record {
    int rows, column[COLUMNS];
    double value[ROWS][COLUMNS];
} record;

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)error;
    record *kept = self;
    for (int i = 0; i < COLUMNS && wanted[i]; i++) {
        kept->column[i] = -1;
        for (size_t j = 0; j < count; j++)
            if (strcmp(columns[j].name, wanted[i]) == 0)
                kept->column[i] = (int)j;
        assert_true(kept->column[i] >= 0);
    }
    return LD_OK;
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    (void)count;
    (void)error;
    record *kept = self;
    assert_true(kept->rows < ROWS);
    for (int i = 0; i < COLUMNS && wanted[i]; i++)
        kept->value[kept->rows][i] = values[kept->column[i]];
    kept->rows++;
    return LD_OK;
}

static record *record_launch(const char *scenario, const char *set)
{
    ld_model model;
    ld_messages messages = {0};
    ld_simulation *simulation;
    ld_summary summary;
    record *kept = calloc(1, sizeof *kept);
    // so tight that the differences between rows are the error
    const char *sets[] = {set, "run.tolerance=1e-9",
                          "run.output_step={lead_in: 1 ms, tube: 0.02 ms}"};
    if (scenario_read(scenario, sets, 3, &model, &messages))
        ld_messages_print(&messages, stderr);
    assert_int_equal(ld_simulation_create(&model, &simulation, NULL), LD_OK);
    ld_sink sink = {.self = kept, .begin = begin, .row = row};
    assert_int_equal(
        ld_simulation_run(simulation, &(ld_run_options){.sink = &sink}, &summary, NULL), LD_OK);
    ld_simulation_free(simulation);
    model_clear(&model);
    return kept;
}

static m3 turn(double yaw, double pitch, double roll)
{
    double cy = cos(yaw), sy = sin(yaw), cp = cos(pitch), sp = sin(pitch), cr = cos(roll),
           sr = sin(roll);
    m3 y = {{{cy, 0, sy}, {0, 1, 0}, {-sy, 0, cy}}}, z = {{{cp, -sp, 0}, {sp, cp, 0}, {0, 0, 1}}},
       x = {{{1, 0, 0}, {0, cr, -sr}, {0, sr, cr}}};
    return m3_mul(m3_mul(y, z), x);
}

// Place and direction of the tip through the base, which carries the tube at an elevation, against
// the columns in I. Along the tube, where it gives way in its supports, the history has no column.
static void check_place(const record *kept, double elevation, double *distance, double *along,
                        double *angle)
{
    const double length = 3;
    for (int i = 0; i < kept->rows; i++) {
        const double *v = kept->value[i];
        m3 A = m3_mul(turn(v[YAW], v[PITCH], v[ROLL]), turn(0, elevation, 0));
        v3 tip = m3_apply_transposed(A, v3_sub(v3_from(v + AT), v3_from(v + BASE)));
        v3 axis = m3_apply(A, m3_column(turn(v[TIP_YAW], v[TIP_PITCH], 0), 0));
        v3 shown = m3_column(turn(v[I_YAW], v[I_PITCH], 0), 0);
        *distance = fmax(*distance, hypot(tip.y - v[TIP_Y], tip.z - v[TIP_Z]));
        *along = fmax(*along, fabs(tip.x - length));
        *angle = fmax(*angle, v3_norm(v3_sub(axis, shown)));
    }
}

// Between two rows an angle changes by the mean of its rates (trapezoidal rule).
static double worst_rate(const record *kept, int angle, int rate)
{
    double worst = 0;
    for (int i = 1; i < kept->rows; i++) {
        const double *a = kept->value[i - 1], *b = kept->value[i];
        double change = (a[rate] + b[rate]) / 2 * (b[T] - a[T]);
        double error = fabs(b[angle] - a[angle] - change);
        worst = error <= worst ? worst : error; // not a number stays
    }
    return worst;
}

static void check_tip(const char *scenario, const char *set, double elevation)
{
    record *kept = record_launch(scenario, set);
    double distance = 0, along = 0, angle = 0;
    check_place(kept, elevation, &distance, &along, &angle);
    CHECK_BELOW("tip in I against base and relative tip, across [m]", distance, 1e-14);
    CHECK_BELOW("along the tube [m]", along, 1e-4);
    CHECK_BELOW("its direction [rad]", angle, 1e-14);
    CHECK_BELOW("pitch between rows from its rates [rad]", worst_rate(kept, I_PITCH, I_PITCH + 2),
                3e-9);
    CHECK_BELOW("yaw between rows from its rates [rad]", worst_rate(kept, I_YAW, I_YAW + 2), 5e-10);
    CHECK_BELOW("x between rows from velocities in I [m]", worst_rate(kept, AT, TIP_V), 2.5e-9);
    CHECK_BELOW("y between rows from velocities in I [m]", worst_rate(kept, AT + 1, TIP_V + 1),
                4e-9);
    CHECK_BELOW("z between rows from velocities in I [m]", worst_rate(kept, AT + 2, TIP_V + 2),
                1e-10);
    free(kept);
}

static void test_tip_on_moving_base(void **state)
{
    (void)state;
    check_tip(LD_SOURCE_DIR "/examples/prescribed.yaml", "run.end=tip", 19.8 * acos(-1) / 180);
}

static void test_tip_on_vehicle(void **state)
{
    (void)state;
    check_tip(LD_SOURCE_DIR "/examples/reference.yaml", "run.lead_in=0.2 s", 0);
}

// The rates of psi, theta and gamma are not the components of the angular velocity: a rocket that
// spins and points off the tube's axis has one across it.
static void test_rates_of_the_relative_angles(void **state)
{
    (void)state;
    record *kept = record_launch(LD_SOURCE_DIR "/examples/marching/stationary.yaml",
                                 "run={lead_in: 0 s, end: tip}");
    static const char *const what[] = {"psi between rows from its rates [rad]",
                                       "theta between rows from its rates [rad]",
                                       "gamma between rows from its rates [rad]"};
    static const int component[] = {W + 2, W + 1, W};
    static const double bound[] = {1.5e-8, 1.5e-9, 2e-9};
    double apart = 0;
    for (int i = 0; i < 3; i++)
        CHECK_BELOW(what[i], worst_rate(kept, PSI + i, PSI_DOT + i), bound[i]);
    for (int i = 0; i < kept->rows; i++)
        for (int k = 0; k < 3; k++)
            apart = fmax(apart, fabs(kept->value[i][PSI_DOT + k] - kept->value[i][component[k]]));
    CHECK_WITHIN("farthest from the angular velocity's component [rad/s]", apart, 0.1, 0.3);
    free(kept);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rates_of_the_relative_angles),
        cmocka_unit_test(test_tip_on_moving_base),
        cmocka_unit_test(test_tip_on_vehicle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
