// Descriptions that make no system are refused with a sentence that names the element, and states
// in which a hinge is singular likewise.
#include "launchdyn/mstmm.h"

#include <string.h>

#include "support/check.h"

static const double gravity[3] = {0, -9.81, 0};

static ld_mstmm_element body(const char *name, const char *parent)
{
    return (ld_mstmm_element){.name = name,
                              .parent = parent,
                              .at = {1, 0, 0},
                              .hinge = LD_HINGE_REVOLUTE,
                              .axis = {0, 0, 1},
                              .mass = 2,
                              .center = {0.5, 0, 0},
                              .inertia = {0.1, 0.2, 0.2}};
}

static void refused(const ld_mstmm_element *elements, int count, const char *sentence)
{
    ld_mstmm *system = NULL;
    ld_error error = {0};
    assert_int_equal(ld_mstmm_create(elements, count, gravity, &system, &error), LD_ERR_INPUT);
    if (strcmp(error.text, sentence))
        fail_msg("got:  %s\nnot:  %s", error.text, sentence);
    assert_null(system);
}

static void test_bad_descriptions(void **state)
{
    (void)state;
    ld_mstmm_element e[3] = {body("a", NULL), body("b", "a"), body("c", "b")};
    refused(e, 0, "a system needs at least one element and gravity");

    e[1].parent = "x";
    refused(e, 3, "element 'b': its parent 'x' does not exist");
    e[1].parent = "c";
    refused(e, 3,
            "element 'b' is its own ancestor: a circle never reaches the ground; joints that close "
            "loops are described separately");
    e[1].parent = "b";
    refused(e, 3,
            "element 'b' is its own ancestor: a circle never reaches the ground; joints that close "
            "loops are described separately");
    e[1] = body("a", NULL);
    refused(e, 3,
            "element 'a' is given twice: a body has one hinge that carries it, its other joints "
            "close loops");
    e[1] = body("", "a");
    refused(e, 3, "element number 2 needs a name of 1 to 63 letters");

    e[1] = body("b", "a");
    e[2].mass = 0;
    refused(e, 3, "element 'c': an end body without mass");
    // a frame may hang on a body, but what turns needs mass
    e[2].hinge = LD_HINGE_WELD;
    e[1].mass = 0;
    refused(e, 3, "element 'b': an end body without mass");
    e[1].mass = 2;
    e[2].hinge = LD_HINGE_REVOLUTE;
    e[2].mass = -1;
    refused(e, 3, "element 'c': its mass is negative (-1 kg)");
    e[2].mass = NAN;
    refused(e, 3, "element 'c': a value is not finite");
    e[2] = body("c", "b");
    const char *const no_body = "element 'c': its inertia is impossible (each principal moment "
                                "must be positive or 0 and none above the sum of the other two)";
    e[2].inertia[1] = -0.2;
    refused(e, 3, no_body);
    e[2].inertia[1] = 0.5;
    refused(e, 3, no_body);
    e[2].inertia[1] = 0.2;
    e[2].inertia[3] = 0.3;
    refused(e, 3, no_body);

    e[2] = body("c", "b");
    e[2].axis[2] = 0;
    refused(e, 3, "element 'c': its revolute hinge needs an axis");
    e[2] = body("c", "b");
    e[2].hinge = LD_HINGE_UNIVERSAL;
    refused(e, 3, "element 'c': its universal hinge needs two axes");
    e[2].axis_2[2] = 2;
    refused(e, 3, "element 'c': the two axes of its universal hinge are parallel");
    e[2].hinge = LD_HINGE_PLANAR;
    refused(e, 3, "element 'c': the two axes of its planar hinge are parallel");
    e[2] = body("c", "b");
    e[2].hinge = (ld_hinge)77;
    refused(e, 3, "element 'c': no such hinge");
    e[2] = body("c", "b");
    e[2].stiffness[0] = -1;
    refused(e, 3, "element 'c': stiffness and damping of its hinge must not be negative");

    const ld_section section = {.mass_per_length = 2,
                                .axial_stiffness = 1e6,
                                .bending_stiffness = 50,
                                .torsion_stiffness = 40,
                                .polar_inertia = 1e-3};
    ld_mstmm_beam beam = {.length = 0.8, .section_count = 1, .section = &section, .bending = 2};
    e[1].beam = &beam;
    e[2] = body("c", "b");
    refused(e, 3, "element 'c': its station 1 m is not on the beam 'b' (0 to 0.8 m)");
    beam.length = 0;
    refused(e, 2, "element 'b': a beam needs a length above 0 and at least one section");
    beam.length = 0.8;
    beam.bending = 1000;
    refused(
        e, 2,
        "element 'b': a beam has at most 24 bending modes a plane, 8 torsional and 8 axial ones");
    beam.bending = 2;
    beam.damping = -0.5;
    refused(e, 2, "element 'b': damping ratio -0.5, expected 0 to 1");
    beam.damping = 0;
    ld_section sections[2] = {section, section};
    beam.section = sections;
    beam.section_count = 2;
    refused(e, 2, "element 'b': section 2 of the beam begins at 0 m, expected it beyond 0 m");
    sections[0].from = 0.1;
    refused(e, 2, "element 'b': section 1 of the beam begins at 0.1 m, expected it at 0 m");
}

static void loop_refused(const ld_mstmm_loop *loops, int count, const char *sentence)
{
    const ld_mstmm_element e[2] = {body("a", NULL), body("b", "a")};
    const ld_mstmm_description d = {
        .elements = e, .element_count = 2, .loops = loops, .loop_count = count};
    ld_mstmm *system = NULL;
    ld_error error = {0};
    assert_int_equal(ld_mstmm_build(&d, &system, &error), LD_ERR_INPUT);
    if (strcmp(error.text, sentence) != 0)
        fail_msg("got:  %s\nnot:  %s", error.text, sentence);
    assert_null(system);
}

static void test_bad_loops(void **state)
{
    (void)state;
    const ld_mstmm_loop good = {
        .name = "pin", .second = {.element = "b"}, .joint = LD_HINGE_REVOLUTE, .axis = {0, 0, 1}};
    ld_mstmm_loop l[2] = {good, good};
    loop_refused(l, 2, "loop 'pin' is given twice");
    l[1].name = "";
    loop_refused(l, 2, "loop number 2 needs a name of 1 to 63 letters");
    l[0].second.element = "c";
    loop_refused(l, 1, "loop 'pin': its element 'c' does not exist");
    l[0] = good;
    l[0].second.element = NULL;
    loop_refused(l, 1, "loop 'pin' joins the ground with itself");
    l[0].first.element = l[0].second.element = "b";
    loop_refused(l, 1, "loop 'pin' joins 'b' with itself");
    l[0] = good;
    l[0].joint = LD_HINGE_FREE;
    loop_refused(l, 1, "loop 'pin': a free joint constrains nothing");
    l[0].joint = (ld_hinge)77;
    loop_refused(l, 1, "loop 'pin': no such joint");
    l[0] = good;
    l[0].axis[2] = 0;
    loop_refused(l, 1, "loop 'pin': its revolute joint needs an axis");
    l[0].axis[2] = NAN;
    loop_refused(l, 1, "loop 'pin': a value is not finite");
    l[0] = good;
    l[0].damping[0] = -1;
    loop_refused(l, 1, "loop 'pin': stiffness and damping of its joint must not be negative");
}

// A point mass on its own axis: nothing resists the turn.
static void test_singular_hinges(void **state)
{
    (void)state;
    ld_mstmm_element e[2] = {body("arm", NULL), body("bob", "arm")};
    memset(e[1].inertia, 0, sizeof e[1].inertia);
    memset(e[1].center, 0, sizeof e[1].center);
    ld_mstmm *system;
    ld_error error = {0};
    double q[2] = {0.3, 0.4}, u[2] = {1, 2}, u_dot[2];
    assert_int_equal(ld_mstmm_create(e, 2, gravity, &system, &error), LD_OK);
    assert_int_equal(ld_mstmm_accelerations(system, q, u, NULL, NULL, u_dot, &error),
                     LD_ERR_NUMERIC);
    assert_string_equal(error.text, "element 'bob': its hinge is in a singular state, nothing "
                                    "resists along one of its axes");
    ld_mstmm_free(system);

    // a point mass off a ball: no resistance about the line through it, whatever the rounding
    e[1].hinge = LD_HINGE_SPHERICAL;
    e[1].center[0] = 0.3;
    e[1].center[1] = 0.2;
    e[1].center[2] = 0.1;
    double q_ball[5] = {0.3, 0.1, 0.2, 0.3, 0.4}, u_ball[4] = {1, 2, 3, 4}, u_dot_ball[4];
    assert_int_equal(ld_mstmm_create(e, 2, gravity, &system, &error), LD_OK);
    assert_int_equal(ld_mstmm_accelerations(system, q_ball, u_ball, NULL, NULL, u_dot_ball, &error),
                     LD_ERR_NUMERIC);
    assert_string_equal(error.text, "element 'bob': its hinge is in a singular state, nothing "
                                    "resists along one of its axes");
    q_ball[0] = NAN;
    assert_int_equal(ld_mstmm_accelerations(system, q_ball, u_ball, NULL, NULL, u_dot_ball, &error),
                     LD_ERR_NUMERIC);
    assert_string_equal(error.text, "element 'bob': its state is not finite");
    ld_mstmm_free(system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bad_descriptions),
        cmocka_unit_test(test_bad_loops),
        cmocka_unit_test(test_singular_hinges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
