// Scenarios: values, units, includes, overrides, files of tables, printing and reading again.
#include "support/check.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <unistd.h>

#include "model/fields/digest.h"
#include "model/fields/field.h"
#include "scenario/scenario.h"
#include "support/comma_locale.h"
#include "support/model_compare.h"
#include "support/reference_model.h"

static const double pi = 3.14159265358979323846;
static const char *const examples[] = {
    "fixed.yaml",      "prescribed.yaml",     "smooth.yaml",       "straight.yaml",
    "unbalanced.yaml", "engine.yaml",         "reference.yaml",    "ship.yaml",
    "aircraft.yaml",   "flight.yaml",         "salvo.yaml",        "marching/stationary.yaml",
    "interval.yaml",   "salvo-marching.yaml", "line-thrower.yaml", "spin-rig.yaml",
    "rail/truck.yaml", "rail/deck.yaml",      "rail/tower.yaml",   "ship-sea.yaml"};
enum { EXAMPLES = sizeof examples / sizeof examples[0] };

// Reads a file below the source folder; messages fail the test.
static ld_model read_model(const char *name, const char *const *sets, size_t count)
{
    char path[512];
    ld_model model;
    ld_messages messages;
    snprintf(path, sizeof path, "%s/%s", LD_SOURCE_DIR, name);
    ld_status status = scenario_read(path, sets, count, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    assert_int_equal(messages.count, 0);
    return model;
}

static char *print_model(const ld_model *model)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    ld_model_print(model, stream);
    fclose(stream);
    return text;
}

static ld_model read_text(const char *text, const char *const *sets, size_t count)
{
    ld_model model;
    ld_messages messages;
    ld_status status = scenario_read_text(text, strlen(text), "text", LD_SOURCE_DIR "/examples",
                                          sets, count, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    return model;
}

// The example's values, as written in it.
static void test_values(void **state)
{
    (void)state;
    ld_model m = read_model("examples/fixed.yaml", NULL, 0);
    assert_string_equal(m.title, "Reference launcher on a fixed base");
    assert_true(m.gravity == 9.80665);
    assert_int_equal(m.base.kind, LD_BASE_FIXED);
    CHECK_BELOW("elevation, 19.8 deg", m.base.elevation - 19.8 * pi / 180, 1e-16);
    assert_int_equal(m.tubes.layout.rows * m.tubes.layout.columns, 18);
    assert_true(m.tubes.length == 3 && m.tubes.section_count == 1);
    assert_true(m.tubes.section[0].bore_radius == 0.0825);
    assert_true(m.tubes.section[0].outer_radius == 0.085);
    assert_true(m.tubes.material.youngs_modulus == 210e9);
    assert_true(m.tubes.modes.bending == 6 && m.tubes.modes.damping == 0.01);
    assert_true(m.tubes.support_count == 2 && m.tubes.support[1].at == 1.8);
    assert_true(m.tubes.support[1].stiffness[2] == 2e7);
    assert_true(m.tubes.support[0].rotational_damping[0] == 200);
    assert_true(m.tubes.slot.kind == LD_SLOT_HELIX && m.tubes.slot.angle.rows == 1);
    CHECK_BELOW("slot angle, 4 deg", m.tubes.slot.angle.data[1] - 4 * pi / 180, 1e-17);
    assert_true(m.rocket.full.mass == 60 && m.rocket.empty.mass == 40);
    assert_true(m.rocket.propellant == 20);
    assert_true(m.rocket.full.center[0] == 1.1 && m.rocket.full.inertia[2] == 24);
    assert_int_equal(m.rocket.adaptor_count, 3);
    assert_string_equal(m.rocket.adaptor[1].name, "middle");
    assert_true(m.rocket.adaptor[1].clearance == 0.0005);
    assert_true(m.rocket.contact.reference_penetration == 1e-3);
    assert_true(m.rocket.lock.present && m.rocket.lock.release_force == 5000);
    assert_true(m.rocket.motor.thrust.rows == 4 && m.rocket.motor.thrust.data[2] == 0.01);
    assert_true(m.rocket.motor.thrust.data[3] == 15000);
    assert_true(m.firing_count == 1 && m.firing[0].tube == 8);
    assert_true(m.run.end == LD_END_TIP && m.run.lead_in == 0);
    assert_true(m.run.output_step_lead_in == 1e-4 && m.run.output_step_tube == 1e-4);
    CHECK_BELOW("stuck time, end of thrust + 1 s", m.run.stuck_time - 3.55, 1e-15);
    model_clear(&m);
}

// Stiffnesses of a ring by numerical integration over its wall.
static void test_ring(void **state)
{
    (void)state;
    ld_model m = read_model("examples/fixed.yaml", NULL, 0);
    const ld_section *s = &m.tubes.section[0];
    double area = 0, second = 0, r0 = 0.0825, r1 = 0.085;
    enum { RINGS = 2000 };
    for (int i = 0; i < RINGS; i++) {
        double h = (r1 - r0) / RINGS, r = r0 + (i + 0.5) * h;
        area += 2 * pi * r * h;
        second += pi * r * r * r * h;
    }
    CHECK_BELOW("mass per length", s->mass_per_length / (7850 * area) - 1, 1e-12);
    CHECK_BELOW("axial stiffness", s->axial_stiffness / (210e9 * area) - 1, 1e-12);
    CHECK_BELOW("bending stiffness", s->bending_stiffness / (210e9 * second) - 1, 1e-9);
    CHECK_BELOW("torsion stiffness", s->torsion_stiffness / (210e9 / 2.6 * 2 * second) - 1, 1e-9);
    CHECK_BELOW("polar inertia", s->polar_inertia / (7850 * 2 * second) - 1, 1e-9);
    model_clear(&m);
}

// Largest relative difference of the numbers that both models have; choices and counts are equal.
static double difference(const field_block *block, const void *a, const void *b)
{
    double most = 0;
    for (const field_row *f = block->fields; f->name; f++) {
        if (f->offset == FIELD_NOWHERE || f->kind == FIELD_TEXT || f->kind == FIELD_FILE ||
            f->kind == FIELD_WORD)
            continue;
        const void *x = field_at_const(a, f), *y = field_at_const(b, f);
        if (f->kind == FIELD_NUMBER)
            for (int i = 0; i < f->count; i++) {
                double u = ((const double *)x)[i], v = ((const double *)y)[i];
                most = u == v || isnan(u) ? most : fmax(most, fabs(u - v) / fmax(fabs(u), fabs(v)));
            }
        else if (f->kind == FIELD_INTEGER || f->kind == FIELD_CHOICE)
            assert_int_equal(*(const int *)x, *(const int *)y);
        else if (f->kind == FIELD_BLOCK)
            most = fmax(most, difference(f->block, x, y));
        else if (f->kind == FIELD_LIST) {
            assert_int_equal(field_switch(a, f), field_switch(b, f));
            for (int i = 0; i < field_switch(a, f); i++)
                most = fmax(most, difference(f->block, (const char *)x + (size_t)i * f->stride,
                                             (const char *)y + (size_t)i * f->stride));
        } else if (f->kind == FIELD_TABLE) {
            const ld_table *t = x, *u = y;
            assert_int_equal(t->rows, u->rows);
            for (size_t i = 0; i < t->rows * t->columns; i++)
                most =
                    t->data[i] == u->data[i] ? most : fmax(most, fabs(t->data[i] / u->data[i] - 1));
        }
    }
    return most;
}

// The example is the model that others filled by hand from the same data.
static void test_reference_model(void **state)
{
    (void)state;
    const char *const sets[] = {"run.output_step.lead_in=5 ms", "run.output_step.tube=0.1 ms",
                                "run.stuck_time=2 s"};
    ld_model read = read_model("examples/fixed.yaml", sets, 3), filled;
    reference_model(&filled);
    filled.tubes.modes.elements = read.tubes.modes.elements;
    filled.rocket.contact.damping = 0;
    filled.run.lead_in_method = read.run.lead_in_method;
    filled.run.exit_error = read.run.exit_error;
    filled.tubes.material = read.tubes.material;
    filled.tubes.section[0].outer_radius = read.tubes.section[0].outer_radius;
    filled.tubes.section[0].area = read.tubes.section[0].area;
    filled.tubes.section[0].second_moment = read.tubes.section[0].second_moment;
    filled.tubes.section[0].torsion_constant = read.tubes.section[0].torsion_constant;
    CHECK_BELOW("largest relative difference", difference(&scenario_block, &read, &filled), 1e-14);
    reference_model_free(&filled);
    model_clear(&read);
}

// The three ways to give a section are one.
static void test_section_forms(void **state)
{
    (void)state;
    ld_model ring = read_model("examples/fixed.yaml", NULL, 0);
    const ld_section *r = &ring.tubes.section[0];
    char by_area[512], by_stiffness[512];
    snprintf(by_area, sizeof by_area,
             "tubes.sections=[{from: 0 m, bore_radius: 82.5 mm, mass_per_length: %.17g kg/m, area: "
             "%.17g m2, second_moment: %.17g m4, torsion_constant: %.17g m4, polar_inertia: %.17g "
             "kg.m}]",
             r->mass_per_length, r->area, r->second_moment, r->torsion_constant, r->polar_inertia);
    snprintf(by_stiffness, sizeof by_stiffness,
             "tubes.sections=[{from: 0 m, bore_radius: 82.5 mm, mass_per_length: %.17g kg/m, "
             "axial_stiffness: %.17g N, bending_stiffness: %.17g N.m2, torsion_stiffness: %.17g "
             "N.m2, polar_inertia: %.17g kg.m}]",
             r->mass_per_length, r->axial_stiffness, r->bending_stiffness, r->torsion_stiffness,
             r->polar_inertia);
    const char *const sets[2][2] = {{by_area, "tubes.material.density="},
                                    {by_stiffness, "tubes.material="}};
    for (int i = 0; i < 2; i++) {
        ld_model m = read_model("examples/fixed.yaml", sets[i], 2);
        const ld_section *s = &m.tubes.section[0];
        assert_int_equal(s->form, i == 0 ? LD_SECTION_AREA : LD_SECTION_STIFFNESS);
        assert_true(s->mass_per_length == r->mass_per_length);
        assert_true(s->axial_stiffness == r->axial_stiffness);
        assert_true(s->bending_stiffness == r->bending_stiffness);
        assert_true(s->torsion_stiffness == r->torsion_stiffness);
        assert_true(s->polar_inertia == r->polar_inertia);
        model_clear(&m);
    }
    model_clear(&ring);
}

// An included file lies below; mappings merge, list members by name, everything else is replaced.
static void test_include(void **state)
{
    (void)state;
    ld_model fixed = read_model("examples/fixed.yaml", NULL, 0);
    ld_model other = read_model("examples/unbalanced.yaml", NULL, 0);
    assert_string_equal(other.title, "Reference launcher with an unbalanced rocket");
    assert_true(other.rocket.adaptor[1].clearance == 0.0004);
    assert_true(other.rocket.adaptor[1].at == 1.2);
    assert_true(other.rocket.eccentricity[0] == 0.0005 && other.rocket.eccentricity[1] == -0.0003);
    assert_true(other.rocket.motor.misalignment[1] == -0.0005);
    assert_true(other.rocket.motor.thrust.rows == 4 && other.rocket.full.mass == 60);
    model_clear(&other);
    other = read_model("examples/smooth.yaml", NULL, 0);
    assert_int_equal(other.tubes.slot.kind, LD_SLOT_NONE);
    model_clear(&other);
    // with the overrides taken back, an including file is the included one
    const char *const back[] = {"title=Reference launcher on a fixed base",
                                "tubes.slot.angle=4 deg"};
    other = read_model("examples/straight.yaml", back, 2);
    assert_true(same_model(&fixed, &other));
    model_clear(&other);
    model_clear(&fixed);
}

static void test_point_of_the_lock(void **state)
{
    (void)state;
    const char *const set = "rocket.lock.at={x: 30 cm, radius: 80 mm, angle: 0.5 rad}";
    ld_model m = read_model("examples/fixed.yaml", &set, 1);
    assert_true(m.rocket.lock.x == 0.3 && m.rocket.lock.radius == 0.08);
    assert_true(m.rocket.lock.angle == 0.5 && m.rocket.lock.release_force == 5000);
    model_clear(&m);
}

static void test_overrides(void **state)
{
    (void)state;
    const char *const sets[] = {
        "rocket.mass=61 kg",
        "rocket.eccentricity.z=0.2 mm",
        "rocket.center.x=1.15 m",
        "rocket.adaptors.rear.clearance=0.35 mm",
        "tubes.supports.2.at=1.9 m",
        "tubes.supports.1.stiffness.y=3e7 N/m",
        "tubes.slot.angle=[[0 m, 0 deg], [3 m, 6 deg]]",
        "rocket.lock=none",
        "run.end=0.2 s",
        "run.output_step={lead_in: 1 ms}",
        "tubes.material.poisson_ratio=",
        "tubes.material.shear_modulus=80 GPa",
    };
    ld_model m = read_model("examples/fixed.yaml", sets, sizeof sets / sizeof sets[0]);
    assert_true(m.rocket.full.mass == 61 && m.rocket.propellant == 21);
    assert_true(m.rocket.eccentricity[0] == 0 && m.rocket.eccentricity[1] == 0.0002);
    assert_true(m.rocket.full.center[0] == 1.15 && m.rocket.full.center[1] == 0);
    assert_true(m.rocket.adaptor[0].clearance == 0.00035);
    assert_true(m.tubes.support[1].at == 1.9);
    assert_true(m.tubes.support[0].stiffness[0] == 2e7 && m.tubes.support[0].stiffness[1] == 3e7);
    assert_true(m.tubes.slot.angle.rows == 2 && m.tubes.slot.angle.data[2] == 3);
    assert_false(m.rocket.lock.present);
    assert_true(m.run.end == LD_END_TIME && m.run.end_time == 0.2);
    assert_true(m.run.output_step_lead_in == 1e-3 && m.run.output_step_tube == 1e-4);
    assert_true(isnan(m.tubes.material.poisson_ratio));
    CHECK_BELOW(
        "torsion stiffness by G",
        m.tubes.section[0].torsion_stiffness / (80e9 * m.tubes.section[0].torsion_constant) - 1,
        1e-15);
    model_clear(&m);
}

// Later overrides win, and one may open a block that another fills.
static void test_override_order(void **state)
{
    (void)state;
    const char *const sets[] = {"tubes.slot=none", "tubes.slot.angle=2 deg",
                                "tubes.slot.radius=80 mm", "rocket.mass=61 kg",
                                "rocket.mass=62 kg"};
    ld_model m = read_model("examples/fixed.yaml", sets, 5);
    assert_true(m.tubes.slot.kind == LD_SLOT_HELIX && m.tubes.slot.radius == 0.08);
    assert_true(m.tubes.slot.friction == 0 && m.rocket.full.mass == 62);
    model_clear(&m);
}

static void test_parachutes(void **state)
{
    (void)state;
    const char *const sets[] = {"run.end=apogee", "rocket.parachutes.main.lag=200 ms",
                                "rocket.parachutes.1={trigger: time, time: 40 s}"};
    ld_model m = read_model("examples/parachutes.yaml", sets, 3);
    const ld_parachute *drogue = &m.rocket.parachute[0], *chief = &m.rocket.parachute[1];
    assert_true(m.rocket.parachute_count == 2 && m.run.end == LD_END_APOGEE);
    assert_true(strcmp(drogue->name, "drogue") == 0 && strcmp(chief->name, "main") == 0);
    assert_true(drogue->trigger == LD_TRIGGER_TIME && chief->trigger == LD_TRIGGER_HEIGHT);
    assert_true(drogue->time == 40 && chief->height == 300);
    assert_true(drogue->drag_area == 0.6 && chief->drag_area == 7);
    assert_true(drogue->lag == 1 && chief->lag == 0.2);
    assert_true(drogue->filling == 0.3 && chief->filling == 1.2);
    assert_false(drogue->canopy.present || chief->canopy.present);
    model_clear(&m);
}

static void test_canopy(void **state)
{
    (void)state;
    const char *const sets[] = {
        "rocket.parachutes={main: {canopy: {mass: 600 g, line_length: 7 m, line_stiffness: 20 kN, "
        "at: 1 0 0.1 m, ejection: 8 0 0 m/s, packed_area: 300 cm2}}, drogue: {canopy: {mass: 100 "
        "g, line_length: 3 m, line_stiffness: 9 kN, damping: 0.2, ejection: 8 0 0 m/s, "
        "air_volume: 0.5 m3, strength: 2 kN}, filling: , filling_distance: 12 ft, filling_power: "
        "2}}"};
    ld_model m = read_model("examples/parachutes.yaml", sets, 1);
    const ld_canopy *drogue = &m.rocket.parachute[0].canopy, *chief = &m.rocket.parachute[1].canopy;
    assert_true(drogue->present && chief->present);
    assert_true(drogue->mass == 0.1 && chief->mass == 0.6 && drogue->strength == 2000);
    assert_true(drogue->line_length == 3 && chief->line_stiffness == 2e4);
    assert_true(drogue->damping == 0.2 && chief->damping == 0.1 && isnan(chief->strength));
    assert_true(chief->at[0] == 1 && chief->at[2] == 0.1 && drogue->ejection[0] == 8);
    assert_true(fabs(chief->packed_area - 0.03) < 1e-17 && drogue->air_volume == 0.5);
    const ld_parachute *first = &m.rocket.parachute[0], *second = &m.rocket.parachute[1];
    assert_true(first->filling == 0 && fabs(first->filling_distance - 3.6576) < 1e-15);
    assert_true(first->filling_power == 2 && second->filling_power == 1);
    assert_true(second->filling == 1.2 && isnan(second->filling_distance));
    model_clear(&m);
}

static void test_engine_file(void **state)
{
    (void)state;
    ld_model m = read_model("examples/engine.yaml", NULL, 0);
    const ld_table *thrust = &m.rocket.motor.thrust;
    assert_true(thrust->rows == 9 && thrust->columns == 2);
    assert_true(thrust->data[0] == 0 && thrust->data[1] == 0); // implied by the format
    assert_true(thrust->data[2] == 0.004 && thrust->data[3] == 4200);
    assert_true(thrust->data[16] == 2.55 && thrust->data[17] == 0);
    model_clear(&m);
}

// Writes a file into the build folder and reads the example with `set` pointing at it.
static ld_model read_with_file(const char *name, const char *content, const char *const *sets,
                               size_t count)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", LD_BINARY_DIR, name);
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fputs(content, stream);
    fclose(stream);
    return read_model("examples/fixed.yaml", sets, count);
}

// An engine that gives its first point at t = 0, and a jump, as many files do.
static void test_engine_from_zero(void **state)
{
    (void)state;
    const char *const sets[] = {"rocket.motor.thrust=" LD_BINARY_DIR "/zero.eng"};
    ld_model m = read_with_file("zero.eng",
                                "; comment\r\n\r\nA8 18 70 3-5-P 0.003 0.016 X\r\n0 5\r\n"
                                "0.5 10\r\n0.5 4\r\n0.7 0\r\n; end\r\n",
                                sets, 1);
    const ld_table *thrust = &m.rocket.motor.thrust;
    assert_true(thrust->rows == 4 && thrust->data[0] == 0 && thrust->data[1] == 5);
    assert_true(thrust->data[2] == 0.5 && thrust->data[4] == 0.5 && thrust->data[5] == 4);
    model_clear(&m);
}

static void test_motion_file(void **state)
{
    (void)state;
    const char *const sets[] = {"base={kind: prescribed, motion: {table: " LD_BINARY_DIR
                                "/deck.csv}}"};
    ld_model m = read_with_file("deck.csv",
                                "# a deck\nt [ms], x [m], y [mm], z [m], yaw [deg], pitch [mrad], "
                                "roll [rad]\n-500, 1, 20, 0, 90, 5, 0.1\n250, 2,-3,4,5,6,7\n",
                                sets, 1);
    const ld_table *motion = &m.base.motion;
    assert_true(motion->rows == 2 && motion->columns == 7);
    assert_true(motion->data[0] == -0.5 && motion->data[2] == 0.02 && motion->data[5] == 0.005);
    CHECK_BELOW("yaw, 90 deg", motion->data[4] - pi / 2, 1e-16);
    assert_true(motion->data[7] == 0.25 && motion->data[13] == 7);
    assert_true(m.base.motion_origin == 0 && m.base.motion_start == 0);
    model_clear(&m);
}

// A jet's pressures, whose distance stays over a group of rows.
static void test_plume_file(void **state)
{
    (void)state;
    const char *const sets[] = {"rocket.motor.plume={ends_at: 2 m, pressure: " LD_BINARY_DIR
                                "/plume.csv}"};
    ld_model m = read_with_file("plume.csv",
                                "distance [m],radius [cm],pressure [kPa]\n0,0,900\n0,6,0\n"
                                "2,0,200\n2,10,90\n2,30,0\n",
                                sets, 1);
    const ld_plume *plume = &m.rocket.motor.plume;
    assert_true(plume->form == LD_PLUME_TABLE && plume->reach == 2);
    assert_true(plume->pressure.rows == 5 && plume->pressure.data[2] == 900e3);
    assert_true(plume->pressure.data[10] == 0.1 && plume->pressure.data[11] == 90e3);
    model_clear(&m);
}

// A record of quaternions on a clock in nanoseconds, from a file and as it is printed.
static void test_record_of_quaternions(void **state)
{
    (void)state;
    const char *const sets[] = {
        "base={kind: prescribed, motion: {start: 1700000002500 ms, table: " LD_BINARY_DIR
        "/record.csv}}"};
    ld_model m = read_with_file("record.csv",
                                "t [ns], x [m], y [m], z [m], q0, q1, q2, q3\n"
                                "1700000000012345678, 1, 2, 3, 1, 0, 0, 0\n"
                                "1700000009100000000, 1, 2, 3, -0.6, 0, 0.8, 0\n",
                                sets, 1);
    const ld_table *motion = &m.base.motion;
    assert_true(motion->rows == 2 && motion->columns == 8);
    assert_true(m.base.motion_origin == 1700000000 && m.base.motion_start == 1700000002.5);
    assert_true(motion->data[0] == 0.012345678 && motion->data[8] == 9.1);
    assert_true(motion->data[12] == -0.6 && motion->data[14] == 0.8);

    ld_model again;
    ld_messages messages;
    char *text = NULL;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    ld_model_print(&m, stream);
    fclose(stream);
    assert_non_null(strstr(text, "[1700000000.012345678 s, "));
    assert_int_equal(scenario_read_text(text, length, "printed", ".", NULL, 0, &again, &messages),
                     LD_OK);
    assert_true(again.base.motion_origin == 1700000000);
    assert_memory_equal(again.base.motion.data, motion->data, 16 * sizeof(double));
    assert_true(model_digest(&again) == model_digest(&m));
    again.base.motion_origin += 1;
    assert_true(model_digest(&again) != model_digest(&m));
    free(text);
    model_clear(&again);
    model_clear(&m);
}

// A ship in its sea, with a response as rows and one from a file.
static void test_sea(void **state)
{
    (void)state;
    const char *const sets[] = {
        "base={kind: prescribed, at: 1 2 3 m, sea: {spectrum: pierson_moskowitz, height: 2 m, "
        "period: 8 s, peakedness: 2, heading: -90 deg, spreading: 4, waves: 50, seed: 9, "
        "responses: [{heading: 0 deg, table: [[0.5 rad/s, 1, 2 rad, 3, 4 rad, 5, 6 rad, 7 rad/m, "
        "8 rad, 9 rad/m, 10 rad, 11 rad/m, 12 rad]]}, {heading: 90 deg, table: " LD_BINARY_DIR
        "/raos.csv}]}}"};
    ld_model m = read_with_file(
        "raos.csv",
        "omega [rad/s], surge [%], surge_phase [deg], sway, sway_phase [deg], heave [m/m], "
        "heave_phase [deg], roll [deg/m], roll_phase [deg], pitch [mrad/m], pitch_phase [deg], "
        "yaw [deg/m], yaw_phase [rad]\n0.4, 50, 90, 3, 4, 5, 6, 90, 8, 9, 10, 11, 12\n"
        "0.8, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12\n",
        sets, 1);
    const ld_sea *sea = &m.base.sea;
    assert_true(sea->present && sea->spectrum == LD_SEA_PIERSON_MOSKOWITZ && sea->height == 2);
    assert_true(sea->period == 8 && sea->peakedness == 2 && sea->spreading == 4);
    assert_true(sea->waves == 50 && sea->seed == 9 && m.base.at[2] == 3);
    CHECK_BELOW("heading, -90 deg", sea->heading + pi / 2, 1e-16);
    assert_int_equal(sea->response_count, 2);
    const ld_table *rows = &sea->response[0].table, *file = &sea->response[1].table;
    assert_true(rows->rows == 1 && file->rows == 2 && file->columns == 13);
    for (int i = 1; i < 13; i++)
        assert_true(rows->data[i] == i);
    assert_true(file->data[1] == 0.5 && file->data[5] == 5 && file->data[9] == 0.009);
    assert_true(file->data[12] == 12);
    CHECK_BELOW("roll, 90 deg/m", file->data[7] - pi / 2, 1e-16);
    model_clear(&m);
}

// ---- printing and reading again

static void check_round_trip(const ld_model *model)
{
    char *text = print_model(model);
    ld_model again = read_text(text, NULL, 0);
    assert_true(same_model(model, &again));
    model_clear(&again);
    free(text);
}

static void test_round_trip(void **state)
{
    (void)state;
    for (int i = 0; i < EXAMPLES; i++) {
        char name[64];
        snprintf(name, sizeof name, "examples/%s", examples[i]);
        ld_model m = read_model(name, NULL, 0);
        check_round_trip(&m);
        model_clear(&m);
    }
}

// A number between -1 and 1 with random bits to the last.
static double random_number(unsigned long long *seed)
{
    *seed = *seed * 6364136223846793005ull + 1442695040888963407ull;
    return (double)(*seed >> 11) / 4503599627370496.0 - 1;
}

// Changes every number of the block that goes with its form by up to a thousandth of itself.
static void shake(const field_block *block, void *base, unsigned long long *seed)
{
    for (const field_row *f = block->fields; f->name; f++) {
        if (!field_has_form(f, field_form(block, base)) ||
            (f->kind == FIELD_BLOCK && f->words &&
             field_word_of(f->words, field_switch(base, f))->name[0]))
            continue; // what is not there is not printed
        if (f->kind == FIELD_BLOCK)
            shake(f->block, field_at(base, f), seed);
        else if (f->kind == FIELD_LIST)
            for (int i = 0; i < field_switch(base, f); i++)
                shake(f->block, (char *)field_at(base, f) + (size_t)i * f->stride, seed);
        else if (f->kind == FIELD_NUMBER)
            for (int i = 0; i < f->count; i++) {
                double *value = &((double *)field_at(base, f))[i];
                double shaken = *value * (1 + 1e-3 * random_number(seed));
                *value = field_in_range(f->range, shaken) ? shaken : *value;
            }
    }
}

static void test_round_trip_of_random_bits(void **state)
{
    (void)state;
    unsigned long long seed = 2026;
    for (int i = 0; i < 200; i++) {
        char name[64];
        snprintf(name, sizeof name, "examples/%s", examples[i % EXAMPLES]);
        ld_model m = read_model(name, NULL, 0);
        shake(&scenario_block, &m, &seed);
        memset(&m.completed, 0, sizeof m.completed); // shaken, they follow from nothing
        model_complete(&m);
        check_round_trip(&m);
        model_clear(&m);
    }
}

static void test_awkward_title(void **state)
{
    (void)state;
    ld_model m = read_model("examples/fixed.yaml", NULL, 0);
    free(m.title);
    m.title = strdup("\"quoted\", \\back: #slash\ttab\nline \xc3\xa9\xe2\x82\xac \x01");
    check_round_trip(&m);
    model_clear(&m);
}

// ---- the program's surroundings

static void test_locale(void **state)
{
    (void)state;
    ld_model before = read_model("examples/unbalanced.yaml", NULL, 0);
    char *text = print_model(&before);
    set_comma_locale(LD_BINARY_DIR);
    char comma[16];
    snprintf(comma, sizeof comma, "%.1f", 1.5);
    ld_model after = read_model("examples/unbalanced.yaml", NULL, 0);
    char *text_after = print_model(&after);
    leave_comma_locale();
    assert_string_equal(comma, "1,5");
    assert_true(same_model(&before, &after));
    assert_string_equal(text, text_after);
    model_clear(&before);
    model_clear(&after);
    free(text);
    free(text_after);
}

// Failures leave the caller's model alone and say what kind they are.
static void test_failures(void **state)
{
    (void)state;
    ld_model model, untouched;
    ld_messages messages;
    memset(&model, 0x5a, sizeof model);
    memcpy(&untouched, &model, sizeof model);
    assert_int_equal(scenario_read("/nowhere/at/all.yaml", NULL, 0, &model, &messages),
                     LD_ERR_INPUT);
    assert_int_equal(messages.count, 1);
    assert_int_equal(messages.item[0].line, 0);
    assert_string_equal(messages.item[0].text,
                        "file \"/nowhere/at/all.yaml\" cannot be read: No such file or directory");
    ld_messages_free(&messages);
    assert_int_equal(scenario_read("/dev/zero", NULL, 0, &model, &messages), LD_ERR_INPUT);
    ld_messages_free(&messages);
    const char bad[] = "launchdyn: 1\ntitle: \xff\xfe\n";
    assert_int_equal(
        scenario_read_text(bad, sizeof bad - 1, "bad", NULL, NULL, 0, &model, &messages),
        LD_ERR_INPUT);
    assert_string_equal(messages.item[0].text, "not valid text: invalid leading UTF-8 octet");
    assert_int_equal(messages.item[0].line, 2);
    assert_int_equal(messages.item[0].column, 8);
    ld_messages_free(&messages);
    assert_memory_equal(&model, &untouched, sizeof model);
}

// Hostile sizes end, with a message and no more than a hundred of them. (Were the time to grow with
// the square of the size, the test would not end within hours.)
static void test_sizes(void **state)
{
    (void)state;
    ld_model model;
    ld_messages messages;
    size_t length = 3000000;
    char *text = malloc(length + 1);
    assert_non_null(text);
    const char *const patterns[] = {"[", "{a: ", "- ", "a: 1\n", "[1, 2],\n", "x", "? "};
    for (size_t i = 0; i < sizeof patterns / sizeof patterns[0]; i++) {
        size_t step = strlen(patterns[i]);
        for (size_t k = 0; k < length; k++)
            text[k] = patterns[i][k % step];
        clock_t begin = clock();
        assert_int_equal(scenario_read_text(text, length, "big", NULL, NULL, 0, &model, &messages),
                         LD_ERR_INPUT);
        printf("    CPU time for 3 MB of pattern %zu: %.2f s\n", i,
               (double)(clock() - begin) / CLOCKS_PER_SEC);
        CHECK_WITHIN("messages", (double)messages.count, 1, 100);
        ld_messages_free(&messages);
    }
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_ring),
        cmocka_unit_test(test_reference_model),
        cmocka_unit_test(test_section_forms),
        cmocka_unit_test(test_include),
        cmocka_unit_test(test_point_of_the_lock),
        cmocka_unit_test(test_overrides),
        cmocka_unit_test(test_override_order),
        cmocka_unit_test(test_parachutes),
        cmocka_unit_test(test_canopy),
        cmocka_unit_test(test_engine_file),
        cmocka_unit_test(test_engine_from_zero),
        cmocka_unit_test(test_motion_file),
        cmocka_unit_test(test_plume_file),
        cmocka_unit_test(test_record_of_quaternions),
        cmocka_unit_test(test_sea),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_round_trip_of_random_bits),
        cmocka_unit_test(test_awkward_title),
        cmocka_unit_test(test_locale),
        cmocka_unit_test(test_failures),
        cmocka_unit_test(test_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
