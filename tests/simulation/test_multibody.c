// Launches from bases of kind multibody: what is one launcher in two descriptions launches alike.
// ctest: slow
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "launchdyn/response.h"
#include "math/vectors/mat3.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "support/recorded_run.h"

static ld_model read_text(const char *text, const char *const *sets, size_t count)
{
    ld_model model;
    ld_messages messages = {0};
    if (scenario_read_text(text, strlen(text), "text", LD_SOURCE_DIR "/examples", sets, count,
                           &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail_msg("the scenario cannot be read");
    }
    return model;
}

// Largest difference of a column between two runs with the same rows, over its largest value.
static double differ(const recorded_run *a, const recorded_run *b, const char *name)
{
    size_t i = recorded_column(a, name), k = recorded_column(b, name);
    double worst = 0, size = 0;
    assert_int_equal(a->rows, b->rows);
    for (size_t row = 0; row < a->rows; row++) {
        double x = recorded_value(a, row, i), y = recorded_value(b, row, k);
        if (isnan(x) && isnan(y))
            continue;
        worst = fmax(worst, isnan(x - y) ? INFINITY : fabs(x - y));
        size = fmax(size, fabs(y));
    }
    return worst > 0 ? worst / fmax(size, 1e-9) : 0;
}

// Two rockets from a cradle on a frame; joints to be added.
#define CRADLE                                                                                     \
    "include: fixed.yaml\n"                                                                        \
    "base:\n"                                                                                      \
    "  kind: multibody\n"                                                                          \
    "  elevation: 20 deg\n"                                                                        \
    "  bodies:\n"                                                                                  \
    "    - {name: frame, mass: 900 kg, center: 0.1 0.2 0 m, inertia: 300 700 600 kg.m2}\n"         \
    "    - {name: cradle, mass: 250 kg, center: 0.6 0.1 0 m, inertia: 20 90 90 kg.m2}\n"           \
    "  joints:\n"
#define REST                                                                                       \
    "tubes: {on: cradle}\n"                                                                        \
    "firing: [{tube: 8, at: 0 s}, {tube: 11, at: 0.3 s}]\n"                                        \
    "run: {tolerance: 1e-11, output_step: 1 ms}\n"
#define MOUNT(parent)                                                                              \
    "    - {name: mount, kind: spherical, parent: " parent ", body: frame, at: 0 0.3 0 m,\n"       \
    "       rotational_stiffness: 4e5 N.m/rad, rotational_damping: 4e3 N.m.s/rad}\n"
#define PIVOT(more)                                                                                \
    "    - {name: pivot, kind: revolute, parent: frame, body: cradle, at: 0.2 0.6 0 m,\n"          \
    "       axis: 0 0 1, rotational_stiffness: 3e5 N.m/rad, rotational_damping: 3e3 "              \
    "N.m.s/rad" more "}\n"
#define LOOSE_ON_CARRIER                                                                           \
    "    - {name: loose, kind: free, parent: carrier, body: cradle, at: 0.2 0.9 0 m}\n"
#define LOOSE "    - {name: loose, kind: free, parent: ground, body: cradle, at: 0.2 0.9 0 m}\n"

// Of all columns that both have.
static double differ_most(const recorded_run *a, const recorded_run *b)
{
    const ld_column *of_a, *of_b;
    size_t count_a = ld_simulation_columns(a->simulation, &of_a), compared = 0;
    size_t count_b = ld_simulation_columns(b->simulation, &of_b);
    double worst = 0;
    for (size_t i = 0; i < count_a; i++)
        for (size_t k = 0; k < count_b; k++) {
            bool balance =
                strncmp(of_a[i].name, "energy.", 7) == 0 || strncmp(of_a[i].name, "work.", 5) == 0;
            if (balance || strcmp(of_a[i].name, of_b[k].name) != 0)
                continue;
            double d = differ(a, b, of_a[i].name);
            worst = fmax(worst, d);
            compared++;
        }
    printf("    %zu columns of %zu and %zu\n", compared, count_a, count_b);
    return worst;
}

// A hinge of the tree, or one that closes a loop: the cradle then hangs on a free joint. The change
// of tubes, too.
static void a_hinge_closes_a_loop(void **state)
{
    (void)state;
    ld_model tree = read_text(CRADLE MOUNT("ground") PIVOT("") REST, NULL, 0);
    ld_model loop = read_text(CRADLE MOUNT("ground") LOOSE PIVOT("") REST, NULL, 0);
    recorded_run a, b;
    recorded_run_make(&a, &tree);
    recorded_run_make(&b, &loop);
    CHECK_BELOW("columns of both, of the largest", differ_most(&a, &b), 3e-6);
    recorded_run_free(&a);
    recorded_run_free(&b);
    model_clear(&tree);
    model_clear(&loop);
}

// Undeformed, bodies stand where the scenario puts them; in equilibrium they sag first.
static void starts_as_given(void **state)
{
    (void)state;
    static const char *const sets[] = {"run.start=undeformed"};
    double angle[2];
    for (size_t k = 0; k < 2; k++) {
        ld_model model = read_text(CRADLE MOUNT("ground") PIVOT("") REST, sets, k);
        recorded_run run;
        model.firing_count = 1;
        recorded_run_make(&run, &model);
        angle[k] = recorded_value(&run, 0, recorded_column(&run, "joint.pivot.angle"));
        CHECK_BELOW("residual of the energy balance [J]", run.summary.energy.residual, 1e-3);
        recorded_run_free(&run);
        model_clear(&model);
    }
    CHECK_WITHIN("sag in equilibrium [rad]", -angle[0], 1e-4, 1e-1);
    CHECK_BELOW("angle at an undeformed start [rad]", angle[1], 0);
}

// ---- joints of several coordinates

// A joint between ground and frame, of the tree or, where the frame hangs on a free joint, in a
// loop.
#define SEVERAL(kind, more, tree)                                                                  \
    CRADLE tree                                                                                    \
        "    - {name: several, kind: " kind ", parent: ground, body: frame, "                      \
        "at: 0 0.3 0 m" more "}\n" PIVOT(                                                          \
            "") "  bushings:\n    - {name: held, from: ground, to: frame, at: 0.3 0.3 0.2 m,\n"    \
                "       stiffness: 4e5 4e5 4e5 N/m, damping: 4e3 4e3 4e3 N.s/m,\n"                 \
                "       rotational_stiffness: 3e5 3e5 3e5 N.m/rad, rotational_damping: 3e3 3e3 "   \
                "3e3 "                                                                             \
                "N.m.s/rad}\n" REST
#define HANGING "    - {name: loose, kind: free, parent: ground, body: frame, at: 0 0.3 0 m}\n"

static double at_row(const recorded_run *run, size_t row, const char *name)
{
    return recorded_value(run, row, recorded_column(run, name));
}

// Where the frame stands, by its own columns.
static m3 frame_axes(const recorded_run *run, size_t row)
{
    return m3_mul(m3_rotation_y(at_row(run, row, "body.frame.yaw")),
                  m3_mul(m3_rotation_z(at_row(run, row, "body.frame.pitch")),
                         m3_rotation_x(at_row(run, row, "body.frame.roll"))));
}

static v3 frame_vector(const recorded_run *run, size_t row, const char *const names[3])
{
    return v3_make(at_row(run, row, names[0]), at_row(run, row, names[1]),
                   at_row(run, row, names[2]));
}

static const char *const place_of_frame[] = {"body.frame.x", "body.frame.y", "body.frame.z"};
static const char *const velocity_of_frame[] = {"body.frame.vx", "body.frame.vy", "body.frame.vz"};
static const char *const rate_of_frame[] = {"body.frame.wx", "body.frame.wy", "body.frame.wz"};

// The columns of the joint less what the frame's place, attitude and motion say.
static void about_the_axis(const recorded_run *run, size_t row, v3 axis, double *worst)
{
    m3 A = frame_axes(run, row);
    v3 w = m3_apply(A, frame_vector(run, row, rate_of_frame));
    v3 spin = v3_make(A.a[2][1] - A.a[1][2], A.a[0][2] - A.a[2][0], A.a[1][0] - A.a[0][1]);
    double trace = A.a[0][0] + A.a[1][1] + A.a[2][2];
    double angle = atan2(v3_dot(axis, spin), trace - 1);
    *worst = fmax(*worst, fabs(at_row(run, row, "joint.several.angle") - angle));
    *worst = fmax(*worst, fabs(at_row(run, row, "joint.several.rate") - v3_dot(axis, w)));
}

static void cylindrical(const recorded_run *run, size_t row, double *worst)
{
    v3 axis = v3_make(0.6, 0, 0.8), r = frame_vector(run, row, place_of_frame);
    v3 v = frame_vector(run, row, velocity_of_frame);
    about_the_axis(run, row, axis, worst);
    double along = v3_dot(axis, v3_sub(r, v3_make(0, 0.3, 0)));
    *worst = fmax(*worst, fabs(at_row(run, row, "joint.several.displacement") - along));
    *worst = fmax(*worst, fabs(at_row(run, row, "joint.several.speed") - v3_dot(axis, v)));
}

// The directions in the plane are either one's own affair: lengths are compared.
static void planar(const recorded_run *run, size_t row, double *worst)
{
    v3 r = v3_sub(frame_vector(run, row, place_of_frame), v3_make(0, 0.3, 0));
    v3 v = frame_vector(run, row, velocity_of_frame);
    about_the_axis(run, row, v3_make(0.6, 0, 0.8), worst);
    double far = hypot(at_row(run, row, "joint.several.displacement"),
                       at_row(run, row, "joint.several.displacement_2"));
    double fast =
        hypot(at_row(run, row, "joint.several.speed"), at_row(run, row, "joint.several.speed_2"));
    *worst = fmax(*worst, fmax(fabs(far - v3_norm(r)), fabs(fast - v3_norm(v))));
}

// R = R_y(first) R_z(second), w = first y + second R_y z.
static void universal(const recorded_run *run, size_t row, double *worst)
{
    m3 A = frame_axes(run, row);
    double first = at_row(run, row, "joint.several.angle");
    m3 R = m3_mul(m3_rotation_y(first), m3_rotation_z(at_row(run, row, "joint.several.angle_2")));
    v3 w = m3_apply(A, frame_vector(run, row, rate_of_frame));
    v3 z = m3_apply(m3_rotation_y(first), v3_make(0, 0, 1));
    v3 own = v3_axpy(v3_make(0, at_row(run, row, "joint.several.rate"), 0),
                     at_row(run, row, "joint.several.rate_2"), z);
    for (int i = 0; i < 9; i++)
        *worst = fmax(*worst, fabs(A.a[i / 3][i % 3] - R.a[i / 3][i % 3]));
    *worst = fmax(*worst, v3_norm(v3_sub(w, own)));
}

static void spherical(const recorded_run *run, size_t row, double *worst)
{
    static const char *const angles[] = {"joint.several.yaw", "joint.several.pitch",
                                         "joint.several.roll"};
    static const char *const of_frame[] = {"body.frame.yaw", "body.frame.pitch", "body.frame.roll"};
    static const char *const rates[] = {"joint.several.wx", "joint.several.wy", "joint.several.wz"};
    v3 turned = v3_sub(frame_vector(run, row, angles), frame_vector(run, row, of_frame));
    v3 spins = v3_sub(frame_vector(run, row, rates), frame_vector(run, row, rate_of_frame));
    *worst = fmax(*worst, fmax(v3_norm(turned), v3_norm(spins)));
}

// Against the frame's own columns, of the tree and where it closes a loop.
static void columns_of_joints(void **state)
{
    (void)state;
    static const struct {
        const char *name, *text[2];
        void (*check)(const recorded_run *run, size_t row, double *worst);
    } joint[] = {
        {"cylindrical",
         {SEVERAL("cylindrical", ", axis: 0.6 0 0.8", ""),
          SEVERAL("cylindrical", ", axis: 0.6 0 0.8", HANGING)},
         cylindrical},
        {"planar",
         {SEVERAL("planar", ", axis: 0.6 0 0.8", ""),
          SEVERAL("planar", ", axis: 0.6 0 0.8", HANGING)},
         planar},
        {"universal",
         {SEVERAL("universal", ", axis: 0 1 0, axis_2: 0 0 1", ""),
          SEVERAL("universal", ", axis: 0 1 0, axis_2: 0 0 1", HANGING)},
         universal},
        {"spherical", {SEVERAL("spherical", "", ""), SEVERAL("spherical", "", HANGING)}, spherical},
    };
    for (size_t i = 0; i < sizeof joint / sizeof *joint; i++)
        for (int k = 0; k < 2; k++) {
            ld_model model = read_text(joint[i].text[k], NULL, 0);
            recorded_run run;
            double worst = 0, moved = 0;
            model.firing_count = 1;
            recorded_run_make(&run, &model);
            for (size_t row = 0; row < run.rows; row++) {
                joint[i].check(&run, row, &worst);
                moved = fmax(moved, fabs(at_row(&run, row, "body.frame.pitch")));
            }
            printf("    %s, %s, turned by %.2g rad\n", joint[i].name, k ? "loop" : "tree", moved);
            CHECK_BELOW("its columns against the body's", worst, 1e-14);
            recorded_run_free(&run);
            model_clear(&model);
        }
}

// On a carrier of constant velocity everything goes as on one at rest.
static void on_a_moving_carrier(void **state)
{
    (void)state;
    static const char *const columns[] = {"rocket.s",
                                          "rocket.psi",
                                          "contact.rear.force",
                                          "contact.front.force",
                                          "joint.pivot.angle",
                                          "joint.pivot.fx",
                                          "joint.pivot.my",
                                          "joint.mount.fy",
                                          "joint.mount.mz",
                                          "tip.pitch",
                                          "q1_dot",
                                          "body.cradle.wx"};
    static const char *const moving[] = {"base.velocity=3 0.5 -2 m/s"};
    ld_model still = read_text(CRADLE MOUNT("carrier") LOOSE_ON_CARRIER PIVOT("") REST, NULL, 0);
    ld_model goes = read_text(CRADLE MOUNT("carrier") LOOSE_ON_CARRIER PIVOT("") REST, moving, 1);
    recorded_run a, b;
    recorded_run_make(&a, &still);
    recorded_run_make(&b, &goes);
    double worst = 0;
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++)
        worst = fmax(worst, differ(&a, &b, columns[i]));
    CHECK_BELOW("columns against the carrier, of the largest", worst, 2e-6);
    recorded_run_free(&a);
    recorded_run_free(&b);
    model_clear(&still);
    model_clear(&goes);
}

// Bodies that come to rest far from where the scenario places them are named after the run.
static void far_from_its_start(void **state)
{
    (void)state;
    static const struct {
        const char *joints, *note;
    } cases[] = {
        {MOUNT("ground") PIVOT(""), ""},
        {"    - {name: mount, kind: revolute, parent: ground, body: frame, axis: 0 0 1}\n" PIVOT(
             ""),
         "joint mount: its equilibrium, in which the run starts, is 94.8 deg from where the "
         "scenario places \"frame\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[4096];
        snprintf(text, sizeof text, "%s%s%s", CRADLE, cases[i].joints, REST);
        ld_model model = read_text(text, NULL, 0);
        ld_summary summary = summary_of_run(&model);
        const char *note = summary.note_count ? summary.note[0] : "";
        printf("    %s\n", note);
        assert_string_equal(note, cases[i].note);
        model_clear(&model);
    }
}

// The bodies in words, as `launchdyn check` prints them. The ball is on the axis of pivot: mount
// fixes its distance already.
static void in_words(void **state)
{
    (void)state;
    static const char expected[] =
        "# bodies and the joints that carry them:\n"
        "#   ground\n"
        "#     frame: turns about a point in joint mount\n"
        "#       cradle: turns about an axis in joint pivot, driven by lift, locked from 0.1 s; "
        "carries "
        "the "
        "tube\n"
        "#   carrier\n"
        "#     beam mast: slides along an axis in joint lift\n"
        "#   loop: cradle turns about an axis on frame in joint again, 5 constraints, 5 redundant\n"
        "#   loop: cradle turns about a point on ground in joint ball, 3 constraints, 1 redundant\n"
        "# degrees of freedom: 3 (5 of the tree less 2 that loops take), and 5 modes of beams\n";
    ld_model model = read_text(CRADLE MOUNT("ground") PIVOT(
                                   ", lock: {from: 0.1 s, stiffness: 1e6 N.m/rad, damping: 1e4 "
                                   "N.m.s/rad}") "    - {name: lift, kind: prismatic, parent: "
                                                 "carrier, body: mast, at: 0 0 9 m,\n"
                                                 "       slide_lock: none, stiffness: 1e6 N/m, "
                                                 "damping: 1e4 N.s/m}\n"
                                                 "    - {name: again, kind: revolute, parent: "
                                                 "frame, body: cradle, at: 0.2 0.6 0 m,\n"
                                                 "       axis: 0 0 1}\n"
                                                 "    - {name: ball, kind: spherical, parent: "
                                                 "ground, body: cradle, at: 0.2 0.9 0.5 m,\n"
                                                 "       body_at: 0 0 0.5 m}\n"
                                                 "  beams:\n"
                                                 "    - {name: mast, length: 1 m, sections: "
                                                 "[{from: 0 m, inner_radius: 70 mm, outer_radius: "
                                                 "76 mm}],\n"
                                                 "       material: {youngs_modulus: 210 GPa, "
                                                 "poisson_ratio: 0.3, density: 7850 kg/m3},\n"
                                                 "       modes: {bending: 2}}\n"
                                                 "  drives:\n"
                                                 "    - {name: lift, joint: pivot, angle: "
                                                 "{command: 0 deg, kp: 1e6 N.m/rad, kd: 1e4 "
                                                 "N.m.s/rad, torque_limit: 1e6 N.m}}\n" REST,
                               NULL, 0);
    ld_simulation *simulation;
    ld_error error;
    if (ld_simulation_create(&model, &simulation, &error))
        fail_msg("%s", error.text);
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    ld_simulation_describe(simulation, stream);
    fclose(stream);
    fputs(text, stdout);
    assert_string_equal(text, expected);
    free(text);
    ld_simulation_free(simulation);
    model_clear(&model);
}

// ---- summary

static double line_mass(const ld_section *section, int count, double length)
{
    double mass = 0;
    for (int i = 0; i < count; i++) {
        double end = i + 1 < count ? section[i + 1].from : length;
        mass += section[i].mass_per_length * (end - section[i].from);
    }
    return mass;
}

// In still air the feet carry all but the gauge beside; how drives and feet did from ignition to
// exit is what the rows say.
static void feet_and_drives_in_the_summary(void **state)
{
    (void)state;
    static const char *const still[] = {"environment.wind=none", "run.output_step.tube=0.1 ms",
                                        "run.max_step=0.05 ms"};
    ld_model model = read_text("include: ../tests/data/multibody/launcher.yaml\n", still, 3);
    const ld_mechanism *given = &model.base.mechanism;
    const ld_tubes *tubes = &model.tubes;
    recorded_run run;
    recorded_run_make(&run, &model);
    double mass = line_mass(given->beam[0].section, given->beam[0].section_count, 0.8), force = 0;
    for (int i = 0; i < given->body_count - 1; i++)
        mass += given->body[i].mass;
    mass += 2 * (line_mass(tubes->section, tubes->section_count, tubes->length) + tubes->tail.mass +
                 model.rocket.full.mass);
    for (int i = 0; i < given->foot_count; i++)
        force += run.summary.equilibrium.foot_force[i];
    CHECK_BELOW("feet and weight at rest (relative)", force / (mass * model.gravity) - 1, 1e-12);

    const ld_rocket_summary *rocket = &run.summary.rocket[0];
    size_t t = recorded_column(&run, "t"), foot = recorded_column(&run, "foot.rl.fy");
    size_t error = recorded_column(&run, "drive.lift.error");
    double peak = 0, least = INFINITY, sum = 0;
    for (size_t i = 1; i < run.rows; i++) {
        double now = recorded_value(&run, i, t), before = recorded_value(&run, i - 1, t);
        if (before < 0 || now > rocket->t_rear)
            continue;
        double e = recorded_value(&run, i, error), e_0 = recorded_value(&run, i - 1, error);
        peak = fmax(peak, recorded_value(&run, i, foot));
        least = fmin(least, recorded_value(&run, i, foot));
        sum += 0.5 * (now - before) * (e * e + e_0 * e_0);
    }
    CHECK_BELOW("largest force of a foot (relative)", rocket->foot[2].force_peak / peak - 1, 1e-6);
    CHECK_BELOW("least one (relative)", rocket->foot[2].force_least / least - 1, 1e-6);
    CHECK_BELOW("error of a drive (relative)",
                rocket->drive[0].error_rms / sqrt(sum / rocket->t_rear) - 1, 2e-6);
    recorded_run_free(&run);
    model_clear(&model);
}

// ---- linearised

static ld_simulation *simulation_of(const ld_model *model)
{
    ld_simulation *simulation;
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error))
        fail_msg("%s", error.text);
    return simulation;
}

// Loops take no frequency away and add none.
static void modes_of_a_loop(void **state)
{
    (void)state;
    enum { MOST = 200 };
    static ld_mode modes[2][MOST];
    static ld_pole poles[2][MOST];
    int count[2], pole_count[2];
    double worst = 0, worst_pole = 0;
    for (int i = 0; i < 2; i++) {
        ld_model model = i ? read_text(CRADLE MOUNT("ground") LOOSE PIVOT("") REST, NULL, 0)
                           : read_text(CRADLE MOUNT("ground") PIVOT("") REST, NULL, 0);
        ld_simulation *simulation = simulation_of(&model);
        ld_error error;
        if (ld_simulation_system_modes(simulation, modes[i], MOST, &count[i], poles[i], MOST,
                                       &pole_count[i], &error))
            fail_msg("%s", error.text);
        ld_simulation_free(simulation);
        model_clear(&model);
    }
    assert_int_equal(count[0], count[1]);
    assert_int_equal(pole_count[0], pole_count[1]);
    for (int k = 0; k < count[0]; k++)
        worst = fmax(worst, fabs(modes[1][k].frequency / modes[0][k].frequency - 1));
    for (int k = 0; k < pole_count[0]; k++)
        worst_pole =
            fmax(worst_pole, hypot(poles[1][k].real - poles[0][k].real,
                                   fabs(poles[1][k].imaginary) - fabs(poles[0][k].imaginary)) /
                                 hypot(poles[0][k].real, poles[0][k].imaginary));
    printf("    %d modes, %d eigenvalues\n", count[0], pole_count[0]);
    CHECK_BELOW("natural frequencies (relative)", worst, 2e-9);
    CHECK_BELOW("eigenvalues (relative)", worst_pole, 2e-9);
}

static void choose(ld_response *response, const char *const *names, size_t count)
{
    ld_error error;
    if (ld_response_choose(response, names, count, &error))
        fail_msg("%s", error.text);
}

static ld_response *respond(const ld_model *model)
{
    ld_response *response;
    ld_error error;
    if (ld_response_create(model, NAN, NAN, &response, &error))
        fail_msg("%s", error.text);
    return response;
}

// Its answers to a force are those of the tree.
static void response_of_a_loop(void **state)
{
    (void)state;
    static const char *const names[] = {"tip.inertial_vy", "joint.pivot.angle",
                                        "joint.pivot.fx",  "joint.mount.mz",
                                        "body.frame.wx",   "rocket.pitch_rate"};
    static const double frequency[] = {0.3, 4, 25};
    enum { NAMES = sizeof names / sizeof *names, POINTS = 3 };
    ld_phasor gain[2][POINTS][NAMES];
    double worst = 0;
    for (int i = 0; i < 2; i++) {
        ld_model model = i ? read_text(CRADLE MOUNT("ground") LOOSE PIVOT("") REST, NULL, 0)
                           : read_text(CRADLE MOUNT("ground") PIVOT("") REST, NULL, 0);
        ld_response *response = respond(&model);
        ld_error error;
        choose(response, names, NAMES);
        if (ld_response_gain(response, 0, "platform.force_y", frequency, POINTS, gain[i][0],
                             &error))
            fail_msg("%s", error.text);
        ld_response_free(response);
        model_clear(&model);
    }
    for (int k = 0; k < NAMES; k++) {
        double size = 0;
        for (int f = 0; f < POINTS; f++)
            size = fmax(size, hypot(gain[0][f][k].real, gain[0][f][k].imaginary));
        for (int f = 0; f < POINTS; f++)
            worst = fmax(worst, hypot(gain[1][f][k].real - gain[0][f][k].real,
                                      gain[1][f][k].imaginary - gain[0][f][k].imaginary) /
                                    size);
    }
    CHECK_BELOW("gains of columns, of the largest", worst, 1e-8);
}

// A slow moment about a vertical axis turns what a spring holds about it by M / k.
static void a_slow_moment_bends_a_spring(void **state)
{
    (void)state;
    static const char *const name = "joint.azimuth.angle";
    static const char *const level[] = {"base.elevation=0 deg"};
    const double k = 6e5, slow = 1e-3;
    ld_model model = read_text(
        CRADLE
        "    - {name: azimuth, kind: revolute, parent: ground, body: frame, axis: 0 1 0,\n"
        "       rotational_stiffness: 6e5 N.m/rad, rotational_damping: 1e3 N.m.s/rad}\n"
        "    - {name: weld, kind: fixed, parent: frame, body: cradle, at: 0.2 0.6 0 m}\n" REST,
        level, 1);
    ld_response *response = respond(&model);
    ld_phasor gain;
    ld_error error;
    choose(response, &name, 1);
    if (ld_response_gain(response, 0, "platform.moment_y", &slow, 1, &gain, &error))
        fail_msg("%s", error.text);
    CHECK_BELOW("angle for a moment (relative)", gain.real * k - 1, 1e-6);
    ld_response_free(response);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hinge_closes_a_loop),
        cmocka_unit_test(starts_as_given),
        cmocka_unit_test(columns_of_joints),
        cmocka_unit_test(on_a_moving_carrier),
        cmocka_unit_test(far_from_its_start),
        cmocka_unit_test(in_words),
        cmocka_unit_test(feet_and_drives_in_the_summary),
        cmocka_unit_test(modes_of_a_loop),
        cmocka_unit_test(response_of_a_loop),
        cmocka_unit_test(a_slow_moment_bends_a_spring),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
