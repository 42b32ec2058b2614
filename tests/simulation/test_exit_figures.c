// The rocket against the launcher, over time and at the exit: each column and each figure of the
// summary, by its name, against places and directions that are rebuilt from other columns and
// differentiated from row to row; launchers that differ in their place in I alone; steep ones.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "math/vectors/mat3.h"
#include "quantities/study_results.h"
#include "scenario/scenario.h"
#include "state/exit_figures.h"
#include "state/launch_state.h"
#include "support/draw.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

enum { OFF = 10, ROLL = OFF + 6, FIGURES = ROLL + 2 };

static const char *const name[FIGURES] = {
    "tip_off.pitch",
    "tip_off.yaw",
    "tip_off.pitch_rate",
    "tip_off.yaw_rate",
    "tip_off.pitch_rate_relative",
    "tip_off.yaw_rate_relative",
    "tip_off.vy",
    "tip_off.vz",
    "tip_off.vy_relative",
    "tip_off.vz_relative",
    "since_ignition.pitch",
    "since_ignition.yaw",
    "since_ignition.pitch_rate",
    "since_ignition.yaw_rate",
    "since_ignition.vy",
    "since_ignition.vz",
    "since_ignition.roll",
    "since_ignition.roll_rate",
};

static double result_named(const ld_rocket_summary *rocket, const char *result)
{
    const quantity_things things = {.count = {[EACH_RUN] = 1}};
    quantity_walk found = quantity_find(&rocket_quantities, &things, result);
    return quantity_value(&found, rocket);
}

static void read_example(const char *file, const char *const *sets, size_t count, ld_model *model)
{
    char path[256];
    ld_messages messages = {0};
    snprintf(path, sizeof path, "%s/examples/%s", LD_SOURCE_DIR, file);
    if (scenario_read(path, sets, count, model, &messages))
        ld_messages_print(&messages, stderr);
}

// ---- by differences ----

static double at(const recorded_run *run, size_t row, const char *column)
{
    return recorded_value(run, row, recorded_column(run, column));
}

// Undeformed tube and rocket at one row, from other columns than those that are tested.
typedef struct place {
    double t, mass;
    m3 T, B;
    v3 r_T, r_O1, v_O1;
    double pitch, yaw, yaw_rate, spin;
} place;

static void read_place(const recorded_run *run, const ld_base *base, size_t row, place *out)
{
    m3 yaw = m3_rotation_y(at(run, row, "base.yaw")),
       pitch = m3_rotation_z(at(run, row, "base.pitch"));
    m3 A = m3_mul(m3_mul(yaw, pitch), m3_rotation_x(at(run, row, "base.roll")));
    if (base->kind != LD_BASE_VEHICLE)
        A = m3_mul(A, m3_mul(m3_rotation_y(base->azimuth), m3_rotation_z(base->elevation)));
    *out = (place){
        .t = at(run, row, "t"),
        .mass = at(run, row, "rocket.mass"),
        .T = A,
        .r_T = v3_make(at(run, row, "base.x"), at(run, row, "base.y"), at(run, row, "base.z")),
        .v_O1 = v3_make(at(run, row, "rocket.vx"), at(run, row, "rocket.vy"),
                        at(run, row, "rocket.vz")),
        .pitch = at(run, row, "rocket.pitch"),
        .yaw = at(run, row, "rocket.yaw"),
        .yaw_rate = at(run, row, "rocket.yaw_rate"),
        .spin = at(run, row, "rocket.spin"),
    };
}

// Rows from first to last, backwards from the state at the exit: the position of O1 from its
// velocity, the roll from the spin.
static void rebuild(const recorded_run *run, const ld_base *base, const ld_rocket_summary *rocket,
                    size_t first, size_t last, place *path)
{
    quat q = {rocket->exit.quaternion[0], rocket->exit.quaternion[1], rocket->exit.quaternion[2],
              rocket->exit.quaternion[3]};
    for (size_t row = first; row <= last; row++)
        read_place(run, base, row, &path[row - first]);
    place *end = &path[last - first];
    m3 level = m3_mul(m3_rotation_y(end->yaw), m3_rotation_z(end->pitch));
    m3 turn = m3_mul(m3_transpose(level), q_matrix(q));
    double roll = atan2(turn.a[2][1], turn.a[1][1]);
    end->r_O1 = v3_from(rocket->exit.position);
    for (place *p = end;; p--) {
        level = m3_mul(m3_rotation_y(p->yaw), m3_rotation_z(p->pitch));
        p->B = m3_mul(level, m3_rotation_x(roll));
        if (p == path)
            return;
        double dt = p[0].t - p[-1].t;
        double now = p[0].spin - p[0].yaw_rate * sin(p[0].pitch);
        double before = p[-1].spin - p[-1].yaw_rate * sin(p[-1].pitch);
        roll -= dt * (now + before) / 2;
        p[-1].r_O1 = v3_axpy(p[0].r_O1, -dt / 2, v3_add(p[0].v_O1, p[-1].v_O1));
    }
}

static v3 center_of(const ld_rocket *rocket, double mass)
{
    double burnt = (rocket->full.mass - mass) / rocket->propellant;
    v3 full = v3_from(rocket->full.center), empty = v3_from(rocket->empty.center);
    v3 aside = v3_make(0, rocket->eccentricity[0], rocket->eccentricity[1]);
    return v3_add(aside, v3_axpy(full, burnt, v3_sub(empty, full)));
}

// Pitch (0) or yaw (1) of the rocket's axis, or its roll (2), at b in the tube's axes of a.
static double angle_in(const m3 *T, const place *b, int which)
{
    m3 A = m3_mul(m3_transpose(*T), b->B);
    v3 d = m3_column(A, 0);
    if (which == 2)
        return atan2(-A.a[1][2], A.a[1][1]);
    return which ? atan2(-d.z, d.x) : atan2(d.y, hypot(d.x, d.z));
}

static double component(v3 a, int which)
{
    return which ? a.z : a.y;
}

// Mean rates between two rows; the body's point c held in the body.
static void differences(const place *a, const place *b, const m3 *ignition, v3 c,
                        double mean[FIGURES])
{
    double dt = b->t - a->t;
    v3 r_a = v3_add(a->r_O1, m3_apply(a->B, c)), r_b = v3_add(b->r_O1, m3_apply(b->B, c));
    v3 way = v3_sub(r_b, r_a), in_a = m3_apply_transposed(a->T, v3_sub(r_a, a->r_T)),
       in_b = m3_apply_transposed(b->T, v3_sub(r_b, b->r_T));
    for (int k = 0; k < 2; k++) {
        mean[k] = mean[OFF + k] = NAN;
        mean[2 + k] = (angle_in(&a->T, b, k) - angle_in(&a->T, a, k) + angle_in(&b->T, b, k) -
                       angle_in(&b->T, a, k)) /
                      (2 * dt);
        mean[4 + k] = (angle_in(&b->T, b, k) - angle_in(&a->T, a, k)) / dt;
        mean[6 + k] = (component(m3_apply_transposed(a->T, way), k) +
                       component(m3_apply_transposed(b->T, way), k)) /
                      (2 * dt);
        mean[8 + k] = component(v3_sub(in_b, in_a), k) / dt;
        mean[OFF + 2 + k] = (angle_in(ignition, b, k) - angle_in(ignition, a, k)) / dt;
        mean[OFF + 4 + k] = component(m3_apply_transposed(*ignition, way), k) / dt;
    }
    double turned = angle_in(ignition, b, 2) - angle_in(ignition, a, 2);
    mean[ROLL] = NAN;
    mean[ROLL + 1] = remainder(turned, 2 * acos(-1)) / dt;
}

// Largest differences over the rows of one rocket, from its ignition to its exit.
static void compare(const recorded_run *run, const ld_model *model, int rocket,
                    double worst[FIGURES])
{
    const ld_rocket_summary *summary = &run->summary.rocket[rocket];
    size_t first = 0, last;
    while (at(run, first, "t") < summary->t_ignition)
        first++;
    for (last = first; last + 1 < run->rows && !isnan(at(run, last + 1, "rocket.s")); last++)
        ;
    assert_true(last > first + 1000);
    for (int k = OFF; k < FIGURES && first > 0; k++)
        assert_true(isnan(at(run, first - 1, name[k])));
    place *path = calloc(last - first + 1, sizeof *path);
    rebuild(run, &model->base, summary, first, last, path);
    memset(worst, 0, FIGURES * sizeof *worst);
    size_t column[FIGURES];
    int turns = 0;
    for (int k = 0; k < FIGURES; k++)
        column[k] = recorded_column(run, name[k]);
    for (size_t i = 1; i <= last - first; i++) {
        const place *a = &path[i - 1], *b = &path[i];
        double mean[FIGURES];
        if (b->t - a->t < 1e-5) // a key instant just after a row
            continue;
        differences(a, b, &path->T, center_of(&model->rocket, (a->mass + b->mass) / 2), mean);
        for (int k = 0; k < 2; k++) {
            mean[k] = (angle_in(&a->T, a, k) + angle_in(&b->T, b, k)) / 2;
            mean[OFF + k] = (angle_in(&path->T, a, k) + angle_in(&path->T, b, k)) / 2;
        }
        double from = angle_in(&path->T, a, 2), turned = angle_in(&path->T, b, 2) - from;
        from += 2 * acos(-1) * turns; // of the whole path, from row to row
        mean[ROLL] = from + remainder(turned, 2 * acos(-1)) / 2;
        turns += remainder(turned, 2 * acos(-1)) - turned > 3 ? 1 : 0;
        turns -= remainder(turned, 2 * acos(-1)) - turned < -3 ? 1 : 0;
        for (int k = 0; k < FIGURES; k++) {
            double shown = (recorded_value(run, first + i - 1, column[k]) +
                            recorded_value(run, first + i, column[k])) /
                           2;
            double error = fabs(shown - mean[k]);
            worst[k] = error <= worst[k] ? worst[k] : error; // not a number stays
        }
    }
    // the summary has the values of the row of the exit
    for (int k = 0; k < FIGURES; k++) {
        double there = recorded_value(run, last, column[k]);
        double figure = result_named(summary, name[k]);
        if (!(fabs(figure - there) <= 1e-7 + 1e-7 * fabs(there)))
            fail_msg("%s: %.17g in the summary, %.17g in the history", name[k], figure, there);
    }
    free(path);
}

static void check_run(const char *file, const char *const *sets, size_t count, int rocket,
                      const double bound[FIGURES])
{
    ld_model model;
    recorded_run run;
    double worst[FIGURES];
    read_example(file, sets, count, &model);
    recorded_run_make(&run, &model);
    compare(&run, &model, rocket, worst);
    for (int k = 0; k < FIGURES; k++)
        CHECK_BELOW(name[k], worst[k], bound[k]);
    recorded_run_free(&run);
    model_clear(&model);
}

// A deck that turns by 40 mrad/s; a mass centre off the axis that moves forward or back.
static void test_columns_on_a_ship(void **state)
{
    (void)state;
    static const char *const sets[] = {
        "run={lead_in: 0.02 s, tolerance: 1e-11, output_step: {lead_in: 5 ms, tube: 0.02 ms}}",
        "rocket.eccentricity=3 -2 mm", "rocket.empty.center=0.4 0 0 m"};
    const double a = 3e-16, y = 3e-6, z = 1.5e-6, roll = 1.5e-8; // from the spin, by quadrature
    const double bound[FIGURES] = {a, a, y, z, y, z, y, z, y, z, a, a, y, z, y, z, roll, y};
    check_run("ship.yaml", sets, 3, 0, bound);
}

// The second rocket of two, of a vehicle that slews its platforms.
static void test_columns_of_the_second_rocket(void **state)
{
    (void)state;
    static const char *const sets[] = {"run={lead_in: 0.1 s, end: tip, tolerance: 1e-10, "
                                       "output_step: {lead_in: 5 ms, tube: 0.02 ms}}",
                                       "firing=[{tube: 8, at: 0 s}, {tube: 9, at: 0.6 s}]"};
    const double a = 3e-16, y = 4e-6, z = 1.5e-6, roll = 1.5e-8;
    const double bound[FIGURES] = {a, a, y, z, y, z, y, z, y, z, a, a, y, z, y, z, roll, y};
    check_run("sequence.yaml", sets, 2, 1, bound);
}

// A slot of twice the angle turns the rocket by more than half a turn: its roll continues counting.
static void test_columns_beyond_half_a_turn(void **state)
{
    (void)state;
    static const char *const sets[] = {
        "run={lead_in: 0.02 s, tolerance: 1e-11, output_step: {lead_in: 5 ms, tube: 0.02 ms}}",
        "tubes.slot.angle=8 deg"};
    const double a = 3e-16, y = 1.5e-6, z = 1.2e-6, roll = 2.5e-8;
    const double bound[FIGURES] = {a, a, y, z, y, z, y, z, y, z, a, a, y, z, y, z, roll, y};
    check_run("fixed.yaml", sets, 2, 0, bound);
}

// ---- in closed form ----

// A rocket that turns with the base as one rigid body has the base's own rates, and none against
// it.
static void test_rocket_rigid_with_the_base(void **state)
{
    (void)state;
    uint64_t seed = 1;
    double still = 0, carried = 0;
    for (int i = 0; i < 100; i++) {
        base_frame base = {.r = draw_v3(&seed, 5),
                           .v = draw_v3(&seed, 3),
                           .A = draw_rotation(&seed),
                           .w = draw_v3(&seed, 2)};
        v3 c = v3_make(2 + draw(&seed), 0.1 * draw(&seed), 0.1 * draw(&seed));
        v3 w = m3_apply_transposed(base.A, base.w), v = m3_apply_transposed(base.A, base.v);
        v3 arm = m3_apply(base.A, c);
        rocket_motion rocket = {.axis = m3_column(base.A, 0),
                                .w = base.w,
                                .r_C = v3_add(base.r, arm),
                                .v_C = v3_add(base.v, v3_cross(base.w, arm))};
        ld_tip_off off = tip_off_of(&base, &rocket);
        still = fmax(still, fmax(hypot(off.pitch, off.yaw),
                                 hypot(off.pitch_rate_relative, off.yaw_rate_relative)));
        still = fmax(still, hypot(off.vy_relative, off.vz_relative));
        carried = fmax(carried, hypot(off.pitch_rate - w.z, off.yaw_rate - w.y));
        carried = fmax(carried, fabs(off.vy - (v.y + w.z * c.x - w.x * c.z)));
        carried = fmax(carried, fabs(off.vz - (v.z + w.x * c.y - w.y * c.x)));
    }
    CHECK_BELOW("angles, rates and velocities against the base", still, 3e-15);
    CHECK_BELOW("rates and velocities in I against the base's own", carried, 5e-15);
}

// On a base that stands still the tube's axes are those of the ignition, and do not turn.
static void test_fixed_base(void **state)
{
    (void)state;
    ld_model model;
    recorded_run run;
    reference_model(&model);
    recorded_run_make(&run, &model);
    double angle = 0;
    for (size_t row = 0; row < run.rows; row++) {
        assert_true(at(&run, row, name[2]) == at(&run, row, name[4]));
        assert_true(at(&run, row, name[3]) == at(&run, row, name[5]));
        assert_true(at(&run, row, name[6]) == at(&run, row, name[8]));
        assert_true(at(&run, row, name[7]) == at(&run, row, name[9]));
        for (int k = 0; k < 2; k++) {
            assert_true(at(&run, row, name[k]) == at(&run, row, name[OFF + k]));
            assert_true(at(&run, row, name[2 + k]) == at(&run, row, name[OFF + 2 + k]));
            assert_true(at(&run, row, name[6 + k]) == at(&run, row, name[OFF + 4 + k]));
        }
        double pitch = at(&run, row, name[0]), yaw = at(&run, row, name[1]),
               up = sin(model.base.elevation) * cos(pitch) * cos(yaw) +
                    cos(model.base.elevation) * sin(pitch);
        angle = fmax(angle, fabs(asin(up) - at(&run, row, "rocket.pitch")));
    }
    CHECK_BELOW("pitch in I from both angles and the elevation [rad]", angle, 3e-16);
    recorded_run_free(&run);
    model_clear(&model);
}

// ---- steep launchers ----

static double figure_of(const ld_summary *summary, int k)
{
    return result_named(&summary->rocket[0], name[k]);
}

// Without gravity it is one launch, wherever it points.
static void test_same_launch_wherever_it_points(void **state)
{
    (void)state;
    static const double pose[][2] = {{0, 0},      {0, 75},      {-60, 20},
                                     {130, 89.9}, {-20, 89.99}, {30, 90}};
    const double degree = acos(-1) / 180;
    ld_model model;
    double worst[FIGURES] = {0};
    reference_model(&model);
    model.gravity = 0;
    model.run.start = LD_START_UNDEFORMED;
    model.run.tolerance = 2e-9;
    model.rocket.eccentricity[0] = 1e-3;
    ld_summary first = summary_of_run(&model);
    for (size_t i = 0; i < sizeof pose / sizeof *pose; i++) {
        model.base.azimuth = pose[i][0] * degree;
        model.base.elevation = pose[i][1] * degree;
        ld_summary other = summary_of_run(&model);
        for (int k = 0; k < FIGURES; k++) {
            double error = fabs(figure_of(&other, k) - figure_of(&first, k));
            worst[k] = error <= worst[k] ? worst[k] : error;
        }
    }
    for (int k = 0; k < FIGURES; k++)
        CHECK_BELOW(name[k], worst[k],
                    k == ROLL                                          ? 4e-8
                    : k == ROLL + 1                                    ? 6e-7
                    : strstr(name[k], "rate") || strstr(name[k], ".v") ? 3e-8
                                                                       : 1.5e-9);
    model_clear(&model);
}

// On a ship, from 20 over 75 to 89 degrees of elevation, angles and rates go with the share of
// gravity across the tube, while yaw and its rate in I lose their meaning.
static void test_steep_on_a_ship(void **state)
{
    (void)state;
    static const double elevation[] = {20, 75, 89};
    // share of its range from 20 to 89 degrees by which the figure at 75 misses a + b
    // cos(elevation)
    static const double bound[OFF] = {0.01, 0.15, 0.06, 0.01, 0.06, 0.15, 1, 1, 0.03, 0.15};
    const double degree = acos(-1) / 180;
    ld_model model;
    ld_summary is[3];
    read_example("ship.yaml", (const char *[]){"run.lead_in=0.02 s"}, 1, &model);
    for (int i = 0; i < 3; i++) {
        model.base.elevation = elevation[i] * degree;
        is[i] = summary_of_run(&model);
    }
    double low = cos(elevation[2] * degree), high = cos(elevation[0] * degree),
           share = (cos(elevation[1] * degree) - low) / (high - low);
    for (int k = 0; k < OFF; k++) {
        double from = figure_of(&is[2], k), range = figure_of(&is[0], k) - from;
        if (k == 6 || k == 7) // with the ship's own velocity, which the elevation turns
            continue;
        printf("    %-30s %9.3f %9.3f %9.3f at 20, 75, 89 deg\n", name[k],
               1e3 * figure_of(&is[0], k), 1e3 * figure_of(&is[1], k), 1e3 * from);
        CHECK_BELOW(name[k], (figure_of(&is[1], k) - from) / range - share, bound[k]);
    }
    CHECK_WITHIN("yaw in I moves from 75 to 89 deg [rad]",
                 is[2].rocket[0].yaw - is[1].rocket[0].yaw, 0.7, 0.9);
    CHECK_WITHIN("yaw rate in I [rad/s]", is[2].rocket[0].yaw_rate - is[1].rocket[0].yaw_rate, -0.8,
                 -0.6);
    model_clear(&model);
}

// The figures at the exit from its quaternion and the rates about the rocket's own axes, by the
// kinematic equations of Ry(yaw) Rz(pitch) Rx(roll): of a launcher at 45 degrees whose planes
// differ, and of one near the vertical, where the ground frame's yaw rate is of another size.
static void test_exit_by_body_rates(void **state)
{
    (void)state;
    static const char *const sets[][2] = {
        {"base.elevation=45 deg", "tubes.supports.1.stiffness=2e7 2e7 2e6 N/m"},
        {"base.elevation=89.99 deg", "base.azimuth=25 deg"}};
    for (size_t i = 0; i < 2; i++) {
        ld_model model;
        read_example("fixed.yaml", sets[i], 2, &model);
        ld_summary summary = summary_of_run(&model);
        const ld_rocket_summary *rocket = &summary.rocket[0];
        m3 T = m3_mul(m3_rotation_y(model.base.azimuth), m3_rotation_z(model.base.elevation));
        const double *q = rocket->exit.quaternion, *w = rocket->exit.rate;
        m3 A = m3_mul(m3_transpose(T), q_matrix((quat){q[0], q[1], q[2], q[3]}));
        double pitch = asin(A.a[1][0]), roll = atan2(-A.a[1][2], A.a[1][1]), c = cos(roll),
               s = sin(roll), yaw_rate = (w[1] * c - w[2] * s) / cos(pitch);
        const double expected[FIGURES - OFF] = {[0] = pitch,
                                                [1] = atan2(-A.a[2][0], A.a[0][0]),
                                                [2] = w[1] * s + w[2] * c,
                                                [3] = yaw_rate,
                                                [6] = roll,
                                                [7] = w[0] - yaw_rate * sin(pitch)};
        printf("    %s: rates since ignition %.3f, %.3f mrad/s, ground %.3f, %.3f mrad/s\n",
               sets[i][0], 1e3 * rocket->since_ignition.pitch_rate,
               1e3 * rocket->since_ignition.yaw_rate, 1e3 * rocket->pitch_rate,
               1e3 * rocket->yaw_rate);
        for (int k = 0; k < FIGURES - OFF; k++)
            if (k != 4 && k != 5)
                CHECK_BELOW(name[OFF + k],
                            remainder(result_named(rocket, name[OFF + k]) - expected[k],
                                      k == 6 ? 2 * acos(-1) : 1e9),
                            2e-14);
        model_clear(&model);
    }
}

// A launch near the vertical says so once; one at 45 degrees does not.
static void test_note_near_the_vertical(void **state)
{
    (void)state;
    static const char *const elevation[] = {"base.elevation=45 deg", "base.elevation=89.99 deg"};
    for (int i = 0; i < 2; i++) {
        ld_model model;
        int notes = 0;
        read_example("fixed.yaml", &elevation[i], 1, &model);
        ld_summary summary = summary_of_run(&model);
        for (int k = 0; k < summary.note_count; k++)
            notes += strstr(summary.note[k], "near the vertical") != NULL;
        assert_int_equal(notes, i);
        model_clear(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_columns_on_a_ship),
        cmocka_unit_test(test_columns_of_the_second_rocket),
        cmocka_unit_test(test_columns_beyond_half_a_turn),
        cmocka_unit_test(test_rocket_rigid_with_the_base),
        cmocka_unit_test(test_fixed_base),
        cmocka_unit_test(test_same_launch_wherever_it_points),
        cmocka_unit_test(test_steep_on_a_ship),
        cmocka_unit_test(test_exit_by_body_rates),
        cmocka_unit_test(test_note_near_the_vertical),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
