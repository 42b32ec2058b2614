// What history.h5 holds of a base of bodies is enough to draw it: boxes have their bodies' mass and
// inertia, joints and ends of struts are where the columns say, a mesh is where `looks` puts it.
#include "support/check.h"

#include <stdlib.h>

#include "math/vectors/mat3.h"
#include "support/example_run.h"
#include "support/scratch.h"

static void run_example(const char *name, const char *const *sets, size_t count, history_data *read)
{
    static ld_summary summary;
    example_run(in("."), name, sets, count, &summary, read);
}

static const history_array *array(const history_data *read, const char *name)
{
    const history_array *found = history_array_named(read, name);
    if (!found)
        fail_msg("no array %s", name);
    return found;
}

static const double *row_of(const history_data *read, const char *name, size_t row)
{
    const history_array *found = array(read, name);
    assert_true(row < found->rows);
    return found->value + row * found->columns;
}

static double at(const history_data *read, const char *head, const char *last, size_t row)
{
    char name[96];
    snprintf(name, sizeof name, "%s%s", head, last);
    const double *column = history_column(read, name);
    if (!column)
        fail_msg("no column %s", name);
    return column[row];
}

// What is no number stays.
static double larger(double a, double b)
{
    return isnan(a) || b <= a ? a : b;
}

static m3 turned(const double angles[3])
{
    return m3_mul(m3_mul(m3_rotation_y(angles[0]), m3_rotation_z(angles[1])),
                  m3_rotation_x(angles[2]));
}

typedef struct pose {
    v3 r;
    m3 A;
} pose;

// By the beginning of its columns; NULL: the ground.
static pose pose_of(const history_data *read, const char *head, size_t row)
{
    pose of = {v3_zero(), m3_identity()};
    if (!head)
        return of;
    of.r = v3_make(at(read, head, "x", row), at(read, head, "y", row), at(read, head, "z", row));
    of.A = turned((double[]){at(read, head, "yaw", row), at(read, head, "pitch", row),
                             at(read, head, "roll", row)});
    return of;
}

static v3 point_of(pose of, const double p[3])
{
    return v3_add(of.r, m3_apply(of.A, v3_from(p)));
}

// ---- boxes

// Moments of inertia of a full box, of its mass, in the axes of its body.
static m3 inertia_of_box(double mass, const double size[3], const double attitude[3])
{
    double x = size[0] * size[0], y = size[1] * size[1], z = size[2] * size[2];
    m3 A = turned(attitude), J = m3_diagonal(y + z, x + z, x + y);
    return m3_scale(mass / 12, m3_mul(m3_mul(A, J), m3_transpose(A)));
}

// A box of 3 x 0.5 x 0.8 m of 120 kg, turned, by its moments and products of inertia.
static void test_boxes(void **state)
{
    (void)state;
    const double mass = 120, size[3] = {3, 0.5, 0.8}, attitude[3] = {0.3, -0.4, 0.2};
    m3 J = inertia_of_box(mass, size, attitude);
    char inertia[200], products[200];
    const char *const sets[] = {"base.bodies.boom.mass=120 kg",
                                inertia,
                                products,
                                "base.bodies.boom.looks=",
                                "base.bodies.boom.center=2.2 0.1 -0.1 m",
                                "base.bodies.rod.looks=",
                                "base.bodies.stand.looks=",
                                "base.bodies.stand.inertia=0 0 0 kg.m2",
                                "base.bodies.stand.mass=16 kg",
                                "base.bodies.cylinder.looks=",
                                "base.bodies.cylinder.inertia=0 12 12 kg.m2"};
    snprintf(inertia, sizeof inertia, "base.bodies.boom.inertia=%.17g %.17g %.17g kg.m2", J.a[0][0],
             J.a[1][1], J.a[2][2]);
    snprintf(products, sizeof products,
             "base.bodies.boom.products_of_inertia=%.17g %.17g %.17g kg.m2", J.a[0][1], J.a[0][2],
             J.a[1][2]);
    history_data read;
    run_example("multibody/erector.yaml", sets, sizeof sets / sizeof *sets, &read);
    static const double shape[] = {1, 1, 1, 1};
    const double *center = row_of(&read, "body.at", 0), *of = row_of(&read, "body.size", 0);
    for (size_t i = 0; i < 4; i++)
        assert_true(*row_of(&read, "body.shape", i) == shape[i]);
    m3 drawn = inertia_of_box(mass, of, row_of(&read, "body.attitude", 0));
    double off = 0;
    for (int i = 0; i < 9; i++)
        off = larger(off, fabs(drawn.a[i / 3][i % 3] - J.a[i / 3][i % 3]));
    CHECK_BELOW("inertia of the box drawn [kg m2]", off, 1e-12);
    CHECK_NEAR("its volume [m3]", of[0] * of[1] * of[2], 1.2, 1e-13);
    CHECK_NEAR("its centre, x [m]", center[0], 2.2, 0);
    CHECK_NEAR("z [m]", center[2], -0.1, 0);
    const double *rod = row_of(&read, "body.size", 3);
    CHECK_NEAR("a rod's length [m]", rod[0], sqrt(6 * 17.9 / 40), 1e-14);
    CHECK_NEAR("its thickness [m]", rod[1], sqrt(6 * 0.1 / 40), 1e-14);
    const double *thin = row_of(&read, "body.size", 2); // no thickness: 3 % of its length
    CHECK_NEAR("that of a thin cylinder [m]", thin[1], 0.03 * sqrt(6 * 24 / 60.0), 1e-15);
    CHECK_NEAR("a point's cube [m]", row_of(&read, "body.size", 1)[2], 0.2, 1e-15);
    history_free(&read);
}

// ---- a mesh

// The mesh's box and corners, turned, moved, scaled.
static void test_mesh(void **state)
{
    (void)state;
    static const char mesh_rows[] = "base.bodies.boom.looks.mesh=[[1 m, 0 m, 0 m, 3 m, 0 m, 0 m, "
                                    "1 m, 4 m, -1 m, 0.25, 0.5, 1]]";
    static const char *const sets[] = {mesh_rows, "base.bodies.boom.looks.at=0.1 0.2 0.3 m",
                                       "base.bodies.boom.looks.attitude=90 0 0 deg",
                                       "base.bodies.boom.looks.scale=0.5"};
    static const double corner[3][3] = {{1, 0, 0}, {3, 0, 0}, {1, 4, -1}};
    history_data read;
    run_example("multibody/erector.yaml", sets, 4, &read);
    const double *mesh = row_of(&read, "body.mesh", 0), *center = row_of(&read, "body.at", 0);
    m3 A = turned(row_of(&read, "body.attitude", 0));
    double off = 0;
    assert_true(array(&read, "body.mesh")->rows == 1 && mesh[0] == 0);
    for (int k = 0; k < 3; k++) { // a yaw of 90 deg turns x to -z and z to x
        const double *p = corner[k];
        v3 expected = {0.1 + 0.5 * p[2], 0.2 + 0.5 * p[1], 0.3 - 0.5 * p[0]};
        v3 drawn = v3_add(v3_from(center), m3_apply(A, v3_from(mesh + 1 + 3 * k)));
        off = larger(off, v3_norm(v3_sub(drawn, expected)));
    }
    CHECK_BELOW("corners of a mesh, rounded to 10 um [m]", off, 1e-15);
    assert_true(mesh[10] == 0.25 && mesh[11] == 0.5 && mesh[12] == 1);
    const double *size = row_of(&read, "body.size", 0);
    double beyond = 0;
    for (int k = 0; k < 9; k++)
        beyond = larger(beyond, fabs(mesh[1 + k]) - size[k % 3] / 2);
    CHECK_BELOW("corners beyond the box about its centre [m]", beyond, 0);
    CHECK_BELOW("its size [m]",
                fabs(size[0] - 1) + fabs(size[1] - 2) + fabs(size[2] - 0.5) +
                    fabs(*row_of(&read, "body.shape", 0) - 4),
                0);
    history_free(&read);
}

// ---- joints

// The boom turns about its joint's axis, its origin is there; so is the rod on its piston.
static void test_joints(void **state)
{
    (void)state;
    static const char *const head[] = {"body.boom.", "body.stand.", "body.cylinder.", "body.rod."};
    static const double kind[] = {0, 1, 5, 2, 4};
    static const double link[5][2] = {{-1, 1}, {1, 0}, {-1, 2}, {2, 3}, {0, 3}};
    const char *const sets[] = {"base.joints.pivot.attitude=0 0 10 deg"};
    history_data read;
    run_example("multibody/erector.yaml", sets, 1, &read);
    double place = 0, angle = 0, slide = 0;
    for (size_t i = 0; i < 5; i++) {
        assert_true(*row_of(&read, "joint.kind", i) == kind[i]);
        assert_true(row_of(&read, "joint.link", i)[0] == link[i][0]);
        assert_true(row_of(&read, "joint.link", i)[1] == link[i][1]);
    }
    for (size_t row = 0; row < read.rows; row += 50) {
        pose stand = pose_of(&read, head[1], row), boom = pose_of(&read, head[0], row);
        pose cylinder = pose_of(&read, head[2], row), rod = pose_of(&read, head[3], row);
        place =
            larger(place, v3_norm(v3_sub(boom.r, point_of(stand, row_of(&read, "joint.at", 1)))));
        place = larger(place, v3_norm(v3_sub(cylinder.r, v3_from(row_of(&read, "joint.at", 2)))));
        m3 axes = m3_mul(stand.A, turned(row_of(&read, "joint.attitude", 1)));
        v3 x = m3_column(m3_mul(m3_transpose(axes), boom.A), 0);
        assert_true(row_of(&read, "joint.axis", 1)[2] == 1);
        angle = larger(angle, fabs(atan2(x.y, x.x) - at(&read, "joint.pivot.", "angle", row)));
        v3 way = m3_apply(cylinder.A, v3_from(row_of(&read, "joint.axis", 3)));
        double s = at(&read, "joint.piston.", "displacement", row);
        slide = larger(slide, v3_norm(v3_sub(rod.r, v3_axpy(cylinder.r, s, way))));
    }
    CHECK_BELOW("joints from the geometry less bodies' origins [m]", place, 1e-14);
    CHECK_BELOW("angle about the joint's axis [rad]", angle, 1e-14);
    CHECK_BELOW("along the piston's axis [m]", slide, 1e-14);
    history_free(&read);
}

// ---- force elements

// Ends of struts are as far apart as their columns say; the first stands on the carrier.
static void test_struts(void **state)
{
    (void)state;
    static const char *const name[] = {"strut.front-left.", "strut.front-right.",
                                       "strut.rear-left.", "strut.rear-right."};
    history_data read;
    run_example("multibody/sled.yaml", NULL, 0, &read);
    double off = 0;
    for (size_t i = 0; i < 4; i++)
        for (size_t row = 0; row < read.rows; row += 50) {
            const double *ends = row_of(&read, "strut.at", i);
            assert_true(row_of(&read, "strut.link", i)[0] == -2);
            v3 from = point_of(pose_of(&read, "carrier.", row), ends);
            size_t body = (size_t)row_of(&read, "strut.link", i)[1];
            static const char *const bodies[] = {"body.runner.", "body.frame."};
            v3 to = point_of(pose_of(&read, bodies[body], row), ends + 3);
            off = larger(off, fabs(v3_norm(v3_sub(to, from)) - at(&read, name[i], "length", row)));
        }
    CHECK_BELOW("distance of struts' ends less their length [m]", off, 1e-14);
    history_free(&read);
}

// Feet are as deep in the ground as their columns say; wheels are on the frame.
static void test_feet(void **state)
{
    (void)state;
    static const char *const name[] = {"foot.front-left.", "foot.front-right.", "foot.rear-left.",
                                       "foot.rear-right."};
    const char *const sets[] = {"base.feet.front-left.height=2 mm"};
    history_data read;
    run_example("multibody/trailer.yaml", sets, 1, &read);
    double off = 0;
    for (size_t i = 0; i < 4; i++)
        for (size_t row = 0; row < read.rows; row += 50) {
            assert_true(*row_of(&read, "foot.on", i) == 0);
            v3 foot = point_of(pose_of(&read, "body.frame.", row), row_of(&read, "foot.at", i));
            double deep = *row_of(&read, "foot.height", i) - foot.y;
            off = larger(off, fabs(deep - at(&read, name[i], "deflection", row)));
        }
    CHECK_BELOW("depth of feet less that of the history [m]", off, 1e-14);
    assert_true(*row_of(&read, "wheel.on", 0) == 0 && *row_of(&read, "tubes.on", 0) == 3);
    CHECK_NEAR("radius of the wheels [m]", *row_of(&read, "wheel.radius", 0), 0.35, 0);
    history_free(&read);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_boxes), cmocka_unit_test(test_mesh),
                                       cmocka_unit_test(test_joints), cmocka_unit_test(test_struts),
                                       cmocka_unit_test(test_feet)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
