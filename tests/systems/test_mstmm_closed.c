// Closed loops: redundant constraints, singular poses and what does not close are reported;
// prescribed motion, copies, vibration, beams in loops.
#include "launchdyn/mstmm.h"

#include <string.h>

#include "support/check.h"
#include "support/draw.h"

static ld_mstmm *build(const ld_mstmm_element *e, int count, const ld_mstmm_loop *l, int loops,
                       double g)
{
    const ld_mstmm_description d = {.elements = e,
                                    .element_count = count,
                                    .loops = l,
                                    .loop_count = loops,
                                    .gravity = {0, -g, 0}};
    ld_mstmm *system = NULL;
    ld_error error = {0};
    if (ld_mstmm_build(&d, &system, &error))
        fail_msg("%s", error.text);
    return system;
}

static ld_mstmm_element rod(const char *name, const char *parent, double x, double y, double length)
{
    return (ld_mstmm_element){
        .name = name,
        .parent = parent,
        .at = {x, y, 0},
        .hinge = LD_HINGE_REVOLUTE,
        .axis = {0, 0, 1},
        .mass = length,
        .center = {length / 2, 0, 0},
        .inertia = {0, length * length * length / 12, length * length * length / 12}};
}

static ld_mstmm_loop pin(const char *first, double x, const char *second, double x_2, double y_2)
{
    return (ld_mstmm_loop){.name = "pin",
                           .first = {.element = first, .at = {x, 0, 0}},
                           .second = {.element = second, .at = {x_2, y_2, 0}},
                           .joint = LD_HINGE_REVOLUTE,
                           .axis = {0, 0, 1}};
}

// Rods of 1 m: up from the ground, along, down to the ground.
static ld_mstmm *parallelogram(double g)
{
    const ld_mstmm_element e[3] = {rod("left", NULL, 0, 0, 1), rod("coupler", "left", 1, 0, 1),
                                   rod("right", NULL, 1, 0, 1)};
    const ld_mstmm_loop l = pin("coupler", 1, "right", 1, 0);
    return build(e, 3, &l, 1, g);
}

// A planar loop of spatial pins has three constraints too many; a ball instead of a pin one.
static void test_redundant_constraints(void **state)
{
    (void)state;
    ld_mstmm_element e[3] = {rod("left", NULL, 0, 0, 1), rod("coupler", "left", 1, 0, 1),
                             rod("right", NULL, 1, 0, 1)};
    ld_mstmm_loop l = pin("coupler", 1, "right", 1, 0);
    static const struct {
        ld_hinge joint;
        int held, redundant, freedoms;
    } cases[] = {{LD_HINGE_REVOLUTE, 2, 3, 1},    {LD_HINGE_SPHERICAL, 2, 1, 1},
                 {LD_HINGE_CYLINDRICAL, 2, 2, 1}, {LD_HINGE_UNIVERSAL, 2, 2, 1},
                 {LD_HINGE_WELD, 3, 3, 0},        {LD_HINGE_PRISMATIC, 3, 2, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double q[3] = {1.2, -1.2, 1.2};
        ld_mstmm_assembly found;
        ld_error error = {0};
        l.joint = cases[i].joint;
        l.axis_2[0] = 1;
        // what must not turn stands as the rods do
        l.second.attitude[0] = cos(0.6);
        l.second.attitude[3] = -sin(0.6);
        ld_mstmm *system = build(e, 3, &l, 1, 9.81);
        if (ld_mstmm_assemble(system, q, NULL, NULL, &found, &error))
            fail_msg("%s", error.text);
        printf("    joint %d: holds %d, redundant %d, freedoms %d\n", (int)l.joint, found.held,
               found.redundant, found.freedoms);
        assert_int_equal(found.held, cases[i].held);
        assert_int_equal(found.redundant, cases[i].redundant);
        assert_int_equal(found.freedoms, cases[i].freedoms);
        assert_int_equal(ld_mstmm_loop_redundancy(system, 0), cases[i].redundant);
        double basis[9];
        int count;
        assert_int_equal(ld_mstmm_freedoms(system, q, basis, &count, NULL), LD_OK);
        assert_int_equal(count, cases[i].freedoms);
        if (l.joint == LD_HINGE_REVOLUTE)
            CHECK_BELOW("the parallelogram's direction: 1, -1, 1",
                        fabs(basis[0] - basis[2]) + fabs(basis[0] + basis[1]), 1e-14);
        ld_mstmm_free(system);
    }
}

static void refused(ld_status status, const ld_error *error, const char *sentence)
{
    assert_int_equal(status, LD_ERR_INPUT);
    if (strcmp(error->text, sentence) != 0)
        fail_msg("got:  %s\nnot:  %s", error->text, sentence);
}

static void test_what_does_not_close(void **state)
{
    (void)state;
    ld_mstmm_element e[3] = {rod("left", NULL, 0, 0, 1), rod("coupler", "left", 1, 0, 1),
                             rod("right", NULL, 1, 0, 1)};
    ld_mstmm_loop l = pin("coupler", 1, "right", 1, 0);
    ld_error error = {0};
    double q[3] = {1.2, -1.2, 1.2}, u[3] = {0}, u_dot[3];
    ld_mstmm_assembly found;

    // evaluated before it is assembled
    ld_mstmm *system = build(e, 3, &l, 1, 9.81);
    refused(ld_mstmm_accelerations(system, q, u, NULL, NULL, u_dot, &error), &error,
            "the loops are not assembled: call ld_mstmm_assemble before the first evaluation");
    ld_mstmm_overall report;
    refused(ld_mstmm_accelerations_overall(system, LD_MSTMM_PAPER, q, u, NULL, NULL, u_dot, &report,
                                           &error),
            &error, "the overall transfer equation takes no closed loops; use the reduced sweep");
    ld_mstmm_free(system);

    // too far apart: the rods reach 3 m
    e[2].at[0] = 5;
    system = build(e, 3, &l, 1, 9.81);
    ld_status status = ld_mstmm_assemble(system, q, u, NULL, &found, &error);
    refused(status, &error,
            "loop 'pin' cannot be closed: 2 m and 0 rad are left between its sides");
    ld_mstmm_free(system);

    // beside the plane: no motion closes it
    e[2].at[0] = 1;
    e[2].at[2] = 0.1;
    system = build(e, 3, &l, 1, 9.81);
    refused(ld_mstmm_assemble(system, q, u, NULL, &found, &error), &error,
            "loop 'pin' cannot be closed: 0.1 m and 0 rad are left between its sides");
    ld_mstmm_free(system);
}

// Flat, a parallelogram has two freedoms: only speeds of one of its branches continue.
static void test_singular_pose(void **state)
{
    (void)state;
    ld_mstmm *system = parallelogram(0);
    ld_error error = {0};
    double q[3] = {0, 0, 0}, u[3] = {1, -1, 1}, u_dot[3];
    ld_mstmm_assembly found;
    int which = -1;
    if (ld_mstmm_assemble(system, q, NULL, NULL, &found, &error))
        fail_msg("%s", error.text);
    assert_int_equal(found.held, 2);
    CHECK_BELOW("flat parallelogram: its singularity", found.singularity, 1e-20);
    assert_int_equal(ld_mstmm_accelerations(system, q, u, NULL, NULL, u_dot, &error), LD_OK);
    CHECK_BELOW("flat parallelogram: singularity told", ld_mstmm_singularity(system, &which),
                1e-20);
    assert_int_equal(which, 0);
    CHECK_BELOW("its uniform motion goes on [rad/s2]",
                fabs(u_dot[0]) + fabs(u_dot[1]) + fabs(u_dot[2]), 1e-12);
    // rods at unequal rates, tips at one speed: 1 * 2 + 1 * (w_2 - 2) at x = 2 against w_3 at x = 2
    double apart[3] = {2, -3, 1};
    assert_int_equal(ld_mstmm_accelerations(system, q, apart, NULL, NULL, u_dot, &error),
                     LD_ERR_NUMERIC);
    assert_string_equal(error.text, "loop 'pin': its pose is singular, no force keeps it closed");
    ld_mstmm_free(system);
}

static void move_pivot(double t, double *q, double *u, double *u_dot, void *context)
{
    (void)context;
    q[0] = 0.3 * sin(3 * t);
    u[0] = 0.9 * cos(3 * t);
    u_dot[0] = -2.7 * sin(3 * t);
}

// th'' = -g/l sin th - a/l cos th, hanging, by small steps of order 4.
static double shaken_pendulum(double end)
{
    enum { STEPS = 20000 };
    double y[2] = {0.5, 0}, h = end / STEPS;
    for (int i = 0; i < STEPS; i++) {
        double k[4][2], t = i * h;
        static const double at[4] = {0, 0.5, 0.5, 1};
        for (int s = 0; s < 4; s++) {
            double z[2], time = t + at[s] * h;
            for (int j = 0; j < 2; j++)
                z[j] = y[j] + (s ? at[s] * h * k[s - 1][j] : 0);
            double a = -2.7 * sin(3 * time);
            k[s][0] = z[1];
            k[s][1] = -9.81 / 0.7 * sin(z[0]) - a / 0.7 * cos(z[0]);
        }
        for (int j = 0; j < 2; j++)
            y[j] += h / 6 * (k[0][j] + 2 * k[1][j] + 2 * k[2][j] + k[3][j]);
    }
    return y[0];
}

static void test_prescribed_motion(void **state)
{
    (void)state;
    const ld_mstmm_element e[2] = {
        {.name = "pivot", .hinge = LD_HINGE_PRISMATIC, .axis = {1, 0, 0}, .prescribed = 1},
        {.name = "bob",
         .parent = "pivot",
         .hinge = LD_HINGE_REVOLUTE,
         .axis = {0, 0, 1},
         .mass = 3,
         .center = {0, -0.7, 0}}};
    ld_mstmm *system = build(e, 2, NULL, 0, 9.81);
    const ld_mstmm_settings settings = {.rtol = 1e-11, .atol = 1e-11, .motion = move_pivot};
    double q[2] = {0, 0.5}, u[2] = {0, 0};
    assert_int_equal(ld_mstmm_integrate(system, &settings, 0, 4, q, u, NULL, NULL), LD_OK);
    CHECK_BELOW("pendulum on a shaken pivot, 4 s [rad]", q[1] - shaken_pendulum(4), 1e-9);
    CHECK_BELOW("its pivot [m]", q[0] - 0.3 * sin(12), 1e-15);
    ld_mstmm_free(system);
}

static void turn_crank(double t, double *q, double *u, double *u_dot, void *context)
{
    (void)context;
    q[0] = 1.2 + 2 * t;
    u[0] = 2;
    u_dot[0] = 0;
}

// A driven crank, slider on the x axis: closed form of its position, speed and the crank's torque
// by energy.
static void test_driven_crank(void **state)
{
    (void)state;
    ld_mstmm_element e[3] = {rod("crank", NULL, 0, 0, 0.3),
                             rod("rod", "crank", 0.3, 0, 1),
                             {.name = "slider",
                              .hinge = LD_HINGE_PRISMATIC,
                              .axis = {1, 0, 0},
                              .mass = 2,
                              .inertia = {1, 1, 1}}};
    e[0].prescribed = 1;
    const ld_mstmm_loop l = pin("rod", 1, "slider", 0, 0);
    ld_mstmm *system = build(e, 3, &l, 1, 0);
    double q[3] = {1.2, -1.4, 1.1}, u[3] = {2, 0, 0}, u_dot[3], tau[3] = {0};
    ld_error error = {0};
    ld_mstmm_assembly found;
    if (ld_mstmm_assemble(system, q, u, NULL, &found, &error))
        fail_msg("%s", error.text);
    assert_int_equal(found.freedoms, 0);
    CHECK_BELOW("the crank stays where it is", fabs(q[0] - 1.2) + fabs(u[0] - 2), 1e-15);
    const ld_mstmm_settings settings = {.rtol = 1e-10, .atol = 1e-10, .motion = turn_crank};
    if (ld_mstmm_integrate(system, &settings, 0, 1, q, u, NULL, &error))
        fail_msg("%s", error.text);
    double a = 3.2, s = 0.3 * sin(a), c = sqrt(1 - s * s);
    CHECK_BELOW("slider's place [m]", q[2] - (0.3 * cos(a) + c), 1e-13);
    CHECK_BELOW("slider's speed [m/s]", u[2] - 2 * (-0.3 * sin(a) - s * 0.3 * cos(a) / c), 1e-12);
    // power of the crank's torque is the kinetic energy's rate
    assert_int_equal(ld_mstmm_accelerations(system, q, u, tau, NULL, u_dot, &error), LD_OK);
    double reaction[18], h = 1e-5, T[2], q_1[3], u_1[3];
    ld_mstmm_reactions(system, q, u, u_dot, NULL, reaction);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) {
            double by = k ? h : -h;
            q_1[i] = q[i] + by * u[i] + 0.5 * by * by * u_dot[i];
            u_1[i] = u[i] + by * u_dot[i];
        }
        T[k] = ld_mstmm_energy(system, q_1, u_1).kinetic;
    }
    CHECK_BELOW("crank's power against the energy's rate [W]",
                reaction[5] * u[0] - (T[1] - T[0]) / (2 * h), 1e-7);
    // released, it is a mechanism of one freedom
    ld_mstmm_prescribe(system, 0, 0);
    if (ld_mstmm_assemble(system, q, NULL, NULL, &found, &error))
        fail_msg("%s", error.text);
    assert_int_equal(found.freedoms, 1);
    ld_mstmm_free(system);
}

// A hanging parallelogram swings with omega^2 = 2 g/(5/3); its pin's force is in the stiffness.
static void test_vibration(void **state)
{
    (void)state;
    ld_mstmm *system = parallelogram(9.81);
    double q[3] = {-M_PI / 2, M_PI / 2, -M_PI / 2}, shapes[6];
    ld_mstmm_mode modes[3];
    int count = 0;
    ld_error error = {0};
    if (ld_mstmm_assemble(system, q, NULL, NULL, NULL, &error) ||
        ld_mstmm_vibration(system, q, NULL, modes, shapes, &count, &error))
        fail_msg("%s", error.text);
    assert_int_equal(count, 1);
    CHECK_BELOW("hanging parallelogram: frequency, relative",
                modes[0].frequency * 2 * M_PI / sqrt(2 * 9.81 / (5.0 / 3)) - 1, 1e-10);
    CHECK_BELOW("its shape: all rods turn alike",
                fabs(fabs(shapes[2]) - 1) + fabs(shapes[4] - shapes[0]), 1e-12);
    ld_mstmm_free(system);
}

// A spring and a damper in the pin that closes the loop: stiffness and damping of one pendulum.
static void test_damped_vibration(void **state)
{
    (void)state;
    const ld_mstmm_element e[3] = {rod("left", NULL, 0, 0, 1), rod("coupler", "left", 1, 0, 1),
                                   rod("right", NULL, 1, 0, 1)};
    ld_mstmm_loop l = pin("coupler", 1, "right", 1, 0);
    const double k = 7, d = 0.8, inertia = 5.0 / 3;
    double q[3] = {-M_PI / 2, M_PI / 2, -M_PI / 2};
    l.stiffness[0] = k;
    l.damping[0] = d;
    l.rest[0] = -M_PI / 2;
    ld_mstmm *system = build(e, 3, &l, 1, 9.81);
    ld_mstmm_mode mode[3];
    int count = 0;
    ld_error error = {0};
    if (ld_mstmm_assemble(system, q, NULL, NULL, NULL, &error) ||
        ld_mstmm_vibration(system, q, NULL, mode, NULL, &count, &error))
        fail_msg("%s", error.text);
    double omega = sqrt((k + 2 * 9.81) / inertia);
    CHECK_BELOW("spring in the loop's pin: frequency, relative",
                mode[0].frequency * 2 * M_PI / omega - 1, 1e-10);
    CHECK_BELOW("damper in the loop's pin: damping ratio",
                mode[0].damping - d / (2 * inertia * omega), 1e-12);
    ld_mstmm_free(system);
}

// A beam between pins, the far one on a light slider: its first frequency, and a copy's bits.
static void test_beam_in_a_loop(void **state)
{
    (void)state;
    const ld_section section = {.mass_per_length = 2,
                                .axial_stiffness = 1e6,
                                .bending_stiffness = 50,
                                .torsion_stiffness = 40,
                                .polar_inertia = 1e-3};
    const ld_mstmm_beam beam = {
        .length = 2, .section_count = 1, .section = &section, .bending = 20};
    ld_mstmm_element e[2] = {
        {.name = "beam", .hinge = LD_HINGE_REVOLUTE, .axis = {0, 0, 1}, .beam = &beam},
        {.name = "slider", .hinge = LD_HINGE_PRISMATIC, .axis = {1, 0, 0}, .mass = 1e-6}};
    const ld_mstmm_loop l = pin("beam", 2, "slider", 0, 0);
    ld_mstmm *system = build(e, 2, &l, 1, 0), *copy = NULL;
    double q[48] = {0.02, 0}, u[48] = {0}, u_dot[48], again[48];
    q[41] = 1.9;
    ld_error error = {0};
    ld_mstmm_assembly found;
    if (ld_mstmm_assemble(system, q, NULL, NULL, &found, &error))
        fail_msg("%s", error.text);
    int n = ld_mstmm_speed_count(system), count, slider = ld_mstmm_coordinate_offset(system, 1);
    printf("    %d speeds, %d held, %d redundant\n", n, found.held, found.redundant);
    CHECK_BELOW("beam straight between its pins: slider [m]", q[slider] - 2, 1e-12);
    ld_mstmm_mode modes[48];
    if (ld_mstmm_vibration(system, q, NULL, modes, NULL, &count, &error))
        fail_msg("%s", error.text);
    assert_int_equal(count, found.freedoms);
    double first = M_PI * M_PI / 4 * sqrt(50 / 2.0) / (2 * M_PI), off = 1;
    for (int k = 0; k < count; k++)
        off = fmin(off, fabs(modes[k].frequency / first - 1));
    // clamped shapes know no force at their end: the error falls with the cube of their number
    CHECK_BELOW("beam between pins: first frequency, relative", off, 2.5e-5);

    // bent and moving
    uint64_t seed = 4;
    for (int k = 0; k < n; k++)
        u[k] = 0.1 * draw(&seed);
    for (int k = 1; k < 5; k++)
        q[k] = 0.02 * draw(&seed);
    if (ld_mstmm_assemble(system, q, u, NULL, NULL, &error) ||
        ld_mstmm_copy(system, &copy, &error) ||
        ld_mstmm_accelerations(system, q, u, NULL, NULL, u_dot, &error) ||
        ld_mstmm_accelerations(copy, q, u, NULL, NULL, again, &error))
        fail_msg("%s", error.text);
    assert_memory_equal(u_dot, again, (size_t)n * sizeof *u_dot);
    // the closed system's own equations: what its accelerations open
    double point[2][3], turn[2][3], tip[3] = {2, 0, 0}, origin[3] = {0, 0, 0};
    ld_mstmm_point_acceleration(copy, q, u, u_dot, 0, tip, point[0], turn[0]);
    ld_mstmm_free(system);
    ld_mstmm_point_acceleration(copy, q, u, u_dot, 1, origin, point[1], turn[1]);
    double size = fabs(point[1][0]) + fabs(point[1][1]);
    CHECK_BELOW("tip and slider: difference of accelerations, relative",
                (fabs(point[0][0] - point[1][0]) + fabs(point[0][1] - point[1][1])) / (1 + size),
                1e-9);
    ld_mstmm_free(copy);
}

// Three bodies on balls in a ring, floating: energy and both momenta stay.
static void test_floating_ring_conserves(void **state)
{
    (void)state;
    uint64_t seed = 12;
    ld_mstmm_element e[4];
    static const char *const name[] = {"a", "b", "c", "d"};
    memset(e, 0, sizeof e);
    for (int i = 0; i < 4; i++) {
        e[i].name = name[i];
        e[i].parent = i ? name[i - 1] : NULL;
        e[i].hinge = i == 0 ? LD_HINGE_FREE : i == 2 ? LD_HINGE_UNIVERSAL : LD_HINGE_SPHERICAL;
        e[i].at[i % 3] = i ? 1 : 0;
        e[i].axis[0] = e[i].axis_2[1] = 1;
        e[i].mass = 2 + draw(&seed);
        v3_store(e[i].center, draw_v3(&seed, 0.3));
        m3 J = draw_inertia(&seed, e[i].mass);
        double six[6] = {J.a[0][0], J.a[1][1], J.a[2][2], J.a[0][1], J.a[0][2], J.a[1][2]};
        memcpy(e[i].inertia, six, sizeof six);
    }
    const ld_mstmm_loop l = {.name = "ring",
                             .first = {.element = "d", .at = {0.3, 0.8, 0}},
                             .second = {.element = "a", .at = {0.2, -0.4, 0.5}},
                             .joint = LD_HINGE_CYLINDRICAL,
                             .axis = {1, 0, 0}};
    ld_mstmm *system = build(e, 4, &l, 1, 0);
    double q[32], u[32], p_0[3], l_0[3], p_1[3], l_1[3], p_off = 0, l_off = 0;
    ld_error error = {0};
    ld_mstmm_reference(system, q);
    for (int i = 0; i < ld_mstmm_speed_count(system); i++)
        u[i] = 0.5 * draw(&seed);
    if (ld_mstmm_assemble(system, q, u, NULL, NULL, &error))
        fail_msg("%s", error.text);
    ld_mstmm_energies before = ld_mstmm_energy(system, q, u);
    ld_mstmm_momentum(system, q, u, p_0, l_0);
    const ld_mstmm_settings settings = {.rtol = 1e-11, .atol = 1e-11};
    if (ld_mstmm_integrate(system, &settings, 0, 20, q, u, NULL, &error))
        fail_msg("%s", error.text);
    ld_mstmm_energies after = ld_mstmm_energy(system, q, u);
    ld_mstmm_momentum(system, q, u, p_1, l_1);
    for (int i = 0; i < 3; i++) {
        p_off = fmax(p_off, fabs(p_1[i] - p_0[i]));
        l_off = fmax(l_off, fabs(l_1[i] - l_0[i]));
    }
    CHECK_BELOW("floating ring, 20 s: energy, relative", after.kinetic / before.kinetic - 1, 1e-8);
    CHECK_BELOW("floating ring: linear momentum [kg m/s]", p_off, 1e-8);
    CHECK_BELOW("floating ring: angular momentum [kg m2/s]", l_off, 1e-8);
    ld_mstmm_free(system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_redundant_constraints),
        cmocka_unit_test(test_what_does_not_close),
        cmocka_unit_test(test_singular_pose),
        cmocka_unit_test(test_prescribed_motion),
        cmocka_unit_test(test_driven_crank),
        cmocka_unit_test(test_vibration),
        cmocka_unit_test(test_damped_vibration),
        cmocka_unit_test(test_beam_in_a_loop),
        cmocka_unit_test(test_floating_ring_conserves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
