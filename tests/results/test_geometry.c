// What history.h5 holds of a launcher's geometry is enough to draw it: with the rows of the history
// it gives the tip and the adaptors' places in the tube, which the history has too.
#include "support/check.h"

#include <stdlib.h>

#include "math/vectors/quaternion.h"
#include "math/vectors/rotation_vector.h"
#include "support/example_run.h"
#include "support/scratch.h"

static bool bent; // the guide counts with its initial shape
static const double PI = 3.14159265358979323846;

static void run_example(const char *name, const char *const *sets, size_t count, history_data *read)
{
    static ld_summary summary;
    example_run(folder, name, sets, count, &summary, read);
}

static double at(const history_data *read, const char *name, size_t row)
{
    const double *column = history_column(read, name);
    assert_non_null(column);
    return column[row];
}

static const history_array *array(const history_data *read, const char *name)
{
    const history_array *found = history_array_named(read, name);
    if (!found)
        fail_msg("no array %s", name);
    return found;
}

// Point and section frame of the tube's axis at station x, in R, from shapes by cubics between the
// stations (beyond the ends straight on).
typedef struct section {
    v3 P;
    m3 A;
} section;

static void add_initial(const history_data *read, double x, double u[2], double slope[2],
                        double *twist)
{
    const history_array *all = bent ? array(read, "tube.initial_shape") : NULL;
    size_t k = 0;
    if (!bent)
        return;
    while (k + 2 < all->rows && x > all->value[7 * k + 7])
        k++;
    const double *a = all->value + 7 * k, *b = a + 7;
    double h = b[0] - a[0], t = (x - a[0]) / h, t2 = t * t, t3 = t2 * t;
    for (int i = 0; i < 3; i++) {
        double value = (1 - 3 * t2 + 2 * t3) * a[1 + i] + h * (t - 2 * t2 + t3) * a[4 + i] +
                       (3 * t2 - 2 * t3) * b[1 + i] + h * (t3 - t2) * b[4 + i];
        double rate = 6 * (t2 - t) / h * (a[1 + i] - b[1 + i]) + (1 - 4 * t + 3 * t2) * a[4 + i] +
                      (3 * t2 - 2 * t) * b[4 + i];
        if (i == 2)
            *twist += value;
        else
            u[i] += value, slope[i] += rate;
    }
}

static section section_at(const history_data *read, size_t row, double x)
{
    const history_array *station = array(read, "tube.station"), *t = array(read, "tube.torsion");
    const history_array *of_y = array(read, "tube.bending");
    const double *s = station->value;
    const double *bending[] = {of_y->value, array(read, "tube.bending_z")->value};
    const double *slopes[] = {array(read, "tube.bending_slope")->value,
                              array(read, "tube.bending_z_slope")->value};
    size_t k = 0, nb = of_y->columns;
    while (k + 2 < station->rows && x > s[k + 1])
        k++;
    double h = s[k + 1] - s[k], xi = fmin(1, fmax(0, (x - s[k]) / h)), beyond = x - s[k] - xi * h;
    double H[4] = {1 + xi * xi * (2 * xi - 3), h * xi * (1 + xi * (xi - 2)), xi * xi * (3 - 2 * xi),
                   h * xi * xi * (xi - 1)};
    double dH[4] = {6 * xi * (xi - 1) / h, 1 + xi * (3 * xi - 4), 6 * xi * (1 - xi) / h,
                    xi * (3 * xi - 2)};
    double u[2] = {0, 0}, slope[2] = {0, 0}, twist = 0;
    for (size_t i = 0; i < 2 * nb; i++) {
        char name[32];
        snprintf(name, sizeof name, "q%zu", i + 1);
        double q = at(read, name, row);
        size_t at0 = k * nb + i % nb, at1 = at0 + nb;
        const double *b = bending[i / nb], *d = slopes[i / nb];
        u[i / nb] += q * (H[0] * b[at0] + H[1] * d[at0] + H[2] * b[at1] + H[3] * d[at1]);
        slope[i / nb] += q * (dH[0] * b[at0] + dH[1] * d[at0] + dH[2] * b[at1] + dH[3] * d[at1]);
    }
    for (size_t i = 0; i < t->columns; i++) {
        char name[32];
        snprintf(name, sizeof name, "q%zu", 2 * nb + i + 1);
        twist += at(read, name, row) * ((1 - xi) * t->value[k * t->columns + i] +
                                        xi * t->value[(k + 1) * t->columns + i]);
    }
    add_initial(read, x - beyond, u, slope, &twist);
    section found = {.A = rv_exp(v3_make(twist, -slope[1], slope[0]))};
    found.P = v3_add(v3_make(x - beyond, u[0], u[1]), v3_scale(beyond, m3_column(found.A, 0)));
    return found;
}

// Undeformed tube's frame against I: the base's pose, then where the tube is mounted on it.
static m3 tube_axes(const history_data *read, size_t row)
{
    m3 A = m3_mul(m3_mul(m3_rotation_y(at(read, "base.yaw", row)),
                         m3_rotation_z(at(read, "base.pitch", row))),
                  m3_rotation_x(at(read, "base.roll", row)));
    const history_array *mount = history_array_named(read, "base.mount");
    return mount ? m3_mul(A, m3_mul(m3_rotation_y(mount->value[0]), m3_rotation_z(mount->value[1])))
                 : A;
}

static v3 vector(const history_data *read, const char *x, const char *y, const char *z, size_t row)
{
    return v3_make(at(read, x, row), at(read, y, row), at(read, z, row));
}

// How far the tip of the history is from the tip of the shapes [m].
static double tip_error(const history_data *read, size_t row)
{
    const history_array *station = array(read, "tube.station");
    double length = station->value[station->rows - 1];
    quat q = {at(read, "tube.q0", row), at(read, "tube.q1", row), at(read, "tube.q2", row),
              at(read, "tube.q3", row)};
    v3 tip = v3_add(vector(read, "tube.x", "tube.y", "tube.z", row),
                    m3_apply(q_matrix(q), section_at(read, row, length).P));
    v3 offset = m3_apply_transposed(tube_axes(read, row),
                                    v3_sub(tip, vector(read, "base.x", "base.y", "base.z", row)));
    return hypot(offset.y - at(read, "tip.y", row), offset.z - at(read, "tip.z", row));
}

// How far adaptor i's offset in the history is from that of rocket and shapes [m]; 0 where it has
// left.
static double adaptor_error(const history_data *read, size_t row, size_t i, const char *name)
{
    char y_name[64], z_name[64];
    snprintf(y_name, sizeof y_name, "contact.%s.y", name);
    snprintf(z_name, sizeof z_name, "contact.%s.z", name);
    if (isnan(at(read, y_name, row)))
        return 0;
    double s = at(read, "rocket.s", row), l = array(read, "rocket.adaptor")->value[i];
    section S = section_at(read, row, s);
    m3 A_SB = m3_mul(m3_mul(m3_rotation_z(at(read, "rocket.psi", row)),
                            m3_rotation_y(at(read, "rocket.theta", row))),
                     m3_rotation_x(at(read, "rocket.gamma", row)));
    v3 in_S = v3_add(v3_make(0, at(read, "rocket.y", row), at(read, "rocket.z", row)),
                     m3_apply(A_SB, v3_make(l, 0, 0)));
    v3 C = v3_add(S.P, m3_apply(S.A, in_S));
    double foot = s + l;
    v3 offset = {0, 0, 0};
    for (int step = 0; step < 20; step++, foot += offset.x) {
        section at_foot = section_at(read, row, foot);
        offset = m3_apply_transposed(at_foot.A, v3_sub(C, at_foot.P));
    }
    return hypot(offset.y - at(read, y_name, row), offset.z - at(read, z_name, row));
}

static void check_run(const history_data *read)
{
    static const char *const adaptor[] = {"rear", "middle", "front"};
    double tip = 0, contact = 0, span = 0;
    for (size_t row = 0; row < read->rows; row += 7) {
        tip = fmax(tip, tip_error(read, row));
        span = fmax(span, hypot(at(read, "tip.y", row), at(read, "tip.z", row)));
        bent = history_array_named(read, "tube.initial_shape");
        for (size_t i = 0; i < 3; i++)
            contact = fmax(contact, adaptor_error(read, row, i, adaptor[i]));
        bent = false;
    }
    CHECK_WITHIN("largest offset of the tip [m]", span, 1e-4, 0.1);
    CHECK_BELOW("tip from the shapes less tip of the history [m]", tip, 1e-14);
    CHECK_BELOW("adaptors from the shapes less those of the history [m]", contact, 1e-14);
}

static void test_fixed(void **state)
{
    (void)state;
    history_data read;
    run_example("fixed.yaml", NULL, 0, &read);
    check_run(&read);
    assert_null(history_array_named(&read, "wheel.mount"));
    assert_null(history_array_named(&read, "base.looks"));
    history_free(&read);
}

// Planes with shapes of their own.
static void test_planes(void **state)
{
    (void)state;
    const char *sets[] = {"tubes.tail.inertia=0.05 0.06 0.1 kg.m2"};
    history_data read;
    run_example("fixed.yaml", sets, 1, &read);
    check_run(&read);
    history_free(&read);
}

static void test_bent_guide(void **state)
{
    (void)state;
    const char *sets[] = {
        "tubes.initial_shape={offsets: [[0 m, 0 mm, 1 mm, 0 deg], [1.3 m, 1 mm, 0 mm, 0.2 deg], [3 "
        "m, 0 mm, 0.5 mm, -0.1 deg]], random: {deviation: 1 mm}, joints: [{at: 1.5 m, step: 0.2 "
        "-0.1 mm, kink: 0.02 0 deg, length: 40 mm}]}"};
    history_data read;
    run_example("fixed.yaml", sets, 1, &read);
    CHECK_WITHIN("rows of the initial shape", (double)array(&read, "tube.initial_shape")->rows, 256,
                 270);
    check_run(&read);
    history_free(&read);
}

static void test_ship(void **state)
{
    (void)state;
    const char *sets[] = {"run.lead_in=0.1 s"};
    history_data read;
    run_example("ship.yaml", sets, 1, &read);
    check_run(&read);
    CHECK_WITHIN("looks of a ship", array(&read, "base.looks")->value[0], 1, 1);
    history_free(&read);
}

static const char guide[] = "tubes.guide={line: 160 0 mm, t_slot: {at: -90 0 mm, lips: 60 mm, "
                            "gap: 0.5 mm, side_gap: 0.3 mm}}";

// Of a guide of surfaces: what its T-slot stands for, and the rectangle like its section.
static void test_guide(void **state)
{
    (void)state;
    const char *sets[] = {"tubes.slot=none", "run.end=tip", guide};
    static const double surface[6][2] = {{-0.09, 0.03},  {-0.09, 0.03}, {-0.09, -0.03},
                                         {-0.09, -0.03}, {-0.09, 0},    {-0.09, 0}};
    static const double normal[6] = {0, PI, 0, PI, PI / 2, -PI / 2};
    history_data read;
    run_example("fixed.yaml", sets, 3, &read);
    const history_array *at = array(&read, "guide.surface");
    double most = 0;
    assert_int_equal(at->rows, 6);
    for (size_t k = 0; k < 6; k++) {
        most = fmax(most, fabs(at->value[2 * k] - surface[k][0]));
        most = fmax(most, fabs(at->value[2 * k + 1] - surface[k][1]));
        most = fmax(most, fabs(array(&read, "guide.normal")->value[k] - normal[k]));
        most = fmax(most, fabs(array(&read, "guide.gap")->value[k] - (k < 4 ? 5e-4 : 3e-4)));
        most = fmax(most, array(&read, "guide.round")->value[k]);
    }
    CHECK_BELOW("surfaces of a T-slot", most, 1e-15);
    CHECK_WITHIN("guide's form", array(&read, "guide.form")->value[0], 2, 2);
    CHECK_WITHIN("guide line [m]", array(&read, "guide.line")->value[0], 0.16, 0.16);
    // of a ring I/A = (r^2 + R^2)/4, of a rectangle h^2/3
    const double *outline = array(&read, "guide.outline")->value, size = hypot(0.0825, 0.085);
    CHECK_BELOW("outline [m]", fabs(outline[0] - size * sqrt(0.75)), 1e-12);
    CHECK_BELOW("outline [m]", fabs(outline[1] - outline[0]), 1e-12);
    history_free(&read);
}

// Of a solid bar 40 mm high and 20 mm wide: its own half height and half width.
static void test_outline(void **state)
{
    (void)state;
    const char *sets[] = {
        "tubes.guide={tower: {rails: 4, gap: 0.3 mm}}", "tubes.slot=none", "run.end=tip",
        "tubes.sections=[{from: 0 m, mass_per_length: 6.28 kg/m, axial_stiffness: 1.68e8 N, "
        "bending_stiffness_y: 5.6 kN.m2, bending_stiffness_z: 22.4 kN.m2, "
        "torsion_stiffness: 5.6 kN.m2, polar_inertia: 1.046666666666667e-3 kg.m}]"};
    history_data read;
    run_example("fixed.yaml", sets, 4, &read);
    const double *outline = array(&read, "guide.outline")->value;
    CHECK_BELOW("half height of a bar [m]", fabs(outline[0] - 0.02), 1e-12);
    CHECK_BELOW("half width of a bar [m]", fabs(outline[1] - 0.01), 1e-12);
    history_free(&read);
}

// Of a rocket whose air is given by surface: its curve from tip to tail and its fins, as the
// scenario says; a cone's radius grows along its length, an ellipse's curve ends level.
static void test_rocket_outline(void **state)
{
    (void)state;
    const char *sets[] = {
        "run.end=tip",
        "rocket.aerodynamics={model: surfaces, reference_diameter: 160 mm, axial: [[0, 0.4], [3, "
        "0.4]], surfaces: ["
        "{name: fins, kind: fins, at: 0.3 m, fin_count: 3, root_chord: 0.2 m, tip_chord: 0.1 m, "
        "span: 60 mm, "
        "sweep_length: 50 mm, radius: 70 mm}, "
        "{name: tail, kind: tail, at: 0.4 m, length: 0.3 m, front_radius: 80 mm, rear_radius: 70 "
        "mm}, "
        "{name: nose, kind: nose, shape: cone, at: 2.6 m, length: 0.5 m, radius: 80 mm}]}"};
    static const double fin[7] = {0.3, 0.2, 0.1, 0.06, 0.05, 0.07, 3};
    history_data read;
    run_example("fixed.yaml", sets, 2, &read);
    const history_array *outline = array(&read, "rocket.outline");
    assert_int_equal(outline->rows, 17 + 2);
    double cone = 0, order = 0, fins = 0;
    for (size_t i = 0; i < 17; i++)
        cone = fmax(cone, fabs(outline->value[2 * i + 1] - 0.16 * (2.6 - outline->value[2 * i])));
    for (size_t i = 1; i < outline->rows; i++)
        order = fmax(order, outline->value[2 * i] - outline->value[2 * i - 2]);
    CHECK_BELOW("a cone's radius less its slope times the way from the tip [m]", cone, 1e-15);
    CHECK_BELOW("from the tip backwards [m]", order, 0);
    CHECK_BELOW("shoulder [m]", fabs(outline->value[32] - 2.1) + fabs(outline->value[33] - 0.08),
                1e-15);
    CHECK_BELOW("tail [m]", fabs(outline->value[36] - 0.1) + fabs(outline->value[37] - 0.07),
                1e-15);
    const history_array *row = array(&read, "rocket.fins");
    assert_int_equal(row->rows * row->columns, 7);
    for (int k = 0; k < 7; k++)
        fins = fmax(fins, fabs(row->value[k] - fin[k]));
    CHECK_BELOW("fins [m]", fins, 0);
    history_free(&read);
    run_example("fixed.yaml", NULL, 0, &read);
    assert_null(history_array_named(&read, "rocket.outline"));
    history_free(&read);
}

// The launching tube's rear end is where chassis, hinges and layout put it; wheels hang where their
// travel says.
static void test_vehicle(void **state)
{
    (void)state;
    const char *sets[] = {"run.lead_in=0.2 s", "run.end=tip"};
    history_data read;
    run_example("reference.yaml", sets, 2, &read);
    check_run(&read);
    const history_array *places = array(&read, "tubes.rear_end");
    assert_int_equal(places->rows, 18);
    double place = 0, wheel = 0;
    for (size_t row = 0; row < read.rows; row += 7) {
        m3 A_C = m3_mul(m3_mul(m3_rotation_y(at(&read, "chassis.yaw", row)),
                               m3_rotation_z(at(&read, "chassis.pitch", row))),
                        m3_rotation_x(at(&read, "chassis.roll", row)));
        v3 r_C = vector(&read, "chassis.x", "chassis.y", "chassis.z", row);
        m3 A_A = m3_mul(A_C, m3_rotation_y(at(&read, "azimuth.angle", row)));
        m3 A_E = m3_mul(A_A, m3_rotation_z(at(&read, "elevation.angle", row)));
        v3 azimuth = v3_add(r_C, m3_apply(A_C, v3_from(array(&read, "azimuth.hinge")->value)));
        v3 elevation =
            v3_add(azimuth, m3_apply(A_A, v3_from(array(&read, "elevation.hinge")->value)));
        v3 rear = v3_add(elevation, m3_apply(A_E, v3_from(places->value + 3 * 7)));
        place =
            fmax(place, v3_norm(v3_sub(rear, vector(&read, "base.x", "base.y", "base.z", row))));
        v3 mount = v3_from(array(&read, "wheel.mount")->value);
        v3 hanging =
            m3_apply_transposed(A_C, v3_sub(vector(&read, "wheel.front-left.x",
                                                   "wheel.front-left.y", "wheel.front-left.z", row),
                                            r_C));
        wheel = fmax(wheel, fabs(hanging.y - mount.y - at(&read, "wheel.front-left.travel", row)));
    }
    CHECK_BELOW("tube 8 from hinges and layout less that of the history [m]", place, 1e-14);
    CHECK_BELOW("wheel from mount and travel less that of the history [m]", wheel, 1e-14);
    history_free(&read);
}

// A history without geometry, as earlier versions wrote it, is read too.
static void test_without(void **state)
{
    (void)state;
    history_hdf5 *history;
    history_data read;
    const ld_column t = {"t", "s", "time"};
    assert_int_equal(history_hdf5_create(in("old.h5"), "Old", &history, NULL), LD_OK);
    assert_int_equal(history_hdf5_begin(history, &t, 1, NULL), LD_OK);
    assert_int_equal(history_hdf5_close(history, NULL, NULL), LD_OK);
    assert_int_equal(history_read(in("old.h5"), &read, NULL), LD_OK);
    CHECK_WITHIN("arrays of a history without geometry", (double)read.arrays, 0, 0);
    assert_null(history_array_named(&read, "tube.station"));
    history_free(&read);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, scratch_make, scratch_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_fixed),          TEST(test_planes),  TEST(test_bent_guide),
        TEST(test_ship),           TEST(test_guide),   TEST(test_outline),
        TEST(test_rocket_outline), TEST(test_vehicle), TEST(test_without)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
