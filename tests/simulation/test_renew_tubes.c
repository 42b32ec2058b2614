// A simulation renewed after a change of any key of the tubes gives the bits of one made afresh:
// what it keeps of the tube before follows from no key that has changed.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "model/fields/field.h"
#include "run/simulation_build.h"
#include "scenario/scenario.h"
#include "state/simulation.h"

// All forms of sections, a mass at a point, modes of every kind; the first instants are enough to
// distinguishes tubes.
static const char text[] =
    "include: fixed.yaml\n"
    "tubes:\n"
    "  layout: {rows: 2, columns: 2, pitch: 0.3 m, first: 0.1 0.2 0.3 m}\n"
    "  sections:\n"
    "    - {from: 0 m, inner_radius: 82.5 mm, outer_radius: 85 mm}\n"
    "    - {from: 1 m, bore_radius: 82.5 mm, mass_per_length: 11 kg/m,\n"
    "       area: 1.3e-3 m2, second_moment: 4.6e-6 m4,\n"
    "       torsion_constant: 9.2e-6 m4, polar_inertia: 0.08 kg.m}\n"
    "    - {from: 2 m, bore_radius: 82.5 mm, mass_per_length: 11 kg/m,\n"
    "       axial_stiffness: 2.7e8 N, bending_stiffness: 9.6e5 N.m2,\n"
    "       torsion_stiffness: 7.4e5 N.m2, polar_inertia: 0.08 kg.m}\n"
    "    - {from: 2.5 m, bore_radius: 82.5 mm, mass_per_length: 11 kg/m,\n"
    "       axial_stiffness: 2.7e8 N, bending_stiffness_y: 9e5 N.m2,\n"
    "       bending_stiffness_z: 9.6e5 N.m2,\n"
    "       torsion_stiffness: 7.4e5 N.m2, polar_inertia: 0.08 kg.m}\n"
    "  point_masses: [{at: 2.5 m, mass: 2 kg}]\n"
    "  wind_drag: [{from: 0.5 m, to: 2.5 m, width: 0.2 m, coefficient: 1.2}]\n"
    "  modes: {bending: 2, torsion: 1, axial: 1, elements: 12}\n"
    "firing: [{tube: 2, at: 0 s}]\n"
    "run: {lead_in: 0 s, end: 3 ms}\n";

typedef struct changes {
    const ld_model *nominal;
    ld_simulation *renewed; // from the nominal model to a change, and back
    ld_summary unchanged;
    int count, matter; // numbers changed; of which the launch depends on
} changes;

static bool is_same(const ld_summary *a, const ld_summary *b)
{
    return memcmp(a->rocket, b->rocket, sizeof a->rocket) == 0 &&
           memcmp(&a->equilibrium, &b->equilibrium, sizeof a->equilibrium) == 0 &&
           memcmp(&a->energy, &b->energy, sizeof a->energy) == 0;
}

static void run_afresh(const ld_model *model, ld_summary *summary)
{
    ld_simulation *simulation;
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, NULL, summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
}

static void check_change(changes *self, ld_model *model, const char *what)
{
    static ld_summary own, again;
    ld_error error;
    model_complete(model);
    if (model_check(model, &error))
        fail_msg("%s: %s", what, error.text);
    run_afresh(model, &own);
    assert_int_equal(simulation_renew(&self->renewed, self->nominal, &error), LD_OK);
    assert_int_equal(simulation_renew(&self->renewed, model, &error), LD_OK);
    assert_int_equal(ld_simulation_run(self->renewed, NULL, &again, &error), LD_OK);
    if (!is_same(&own, &again))
        fail_msg("%s: renewed it is not as afresh", what);
    self->count++;
    self->matter += !is_same(&own, &self->unchanged);
}

// Changes one number by a thousandth, from 0 by a millionth, a whole one by 1.
static void change_number(changes *self, const char *path)
{
    static ld_model model;
    field_place place;
    char why[384];
    if (!field_locate(self->nominal, path, &place, why, sizeof why))
        fail_msg("%s", why);
    double value = field_get(self->nominal, &place);
    if (isnan(value) || strcmp(path, "tubes.sections.1.from") == 0)
        return; // not given, or 0 always
    model = *self->nominal;
    field_set(&model, &place, place.whole ? value + 1 : value == 0 ? 1e-6 : 1.001 * value);
    check_change(self, &model, path);
}

// Whether a block that may be a word, as `none`, is one.
static bool is_word(const field_row *f, const void *base)
{
    const field_word *word = f->words ? field_word_of(f->words, field_switch(base, f)) : NULL;
    return word && word->name[0];
}

// Every number that a block has in its form, and those of the blocks in it.
static void change_all(changes *self, const field_block *block, const void *base, const char *above)
{
    static const char *const component[] = {".x", ".y", ".z"};
    for (const field_row *f = block->fields; f->name; f++) {
        char path[LD_MAX_PATH];
        int length = snprintf(path, sizeof path, "%s.%s", above, f->name);
        if (!field_has_form(f, field_form(block, base)))
            continue;
        if (f->kind == FIELD_BLOCK && !is_word(f, base))
            change_all(self, f->block, field_at_const(base, f), path);
        for (int i = 0; f->kind == FIELD_LIST && i < field_switch(base, f); i++) {
            snprintf(path + length, sizeof path - (size_t)length, ".%d", i + 1);
            change_all(self, f->block, field_entry_const(base, f, i), path);
        }
        if (f->kind != FIELD_NUMBER && f->kind != FIELD_INTEGER)
            continue;
        for (int i = 0; i < f->count || i < 1; i++) {
            const char *axis = f->count < 2 ? "" : component[f->count == 2 ? i + 1 : i];
            snprintf(path + length, sizeof path - (size_t)length, "%s", axis);
            change_number(self, path);
        }
    }
}

// What is not a number: choices, how many entries a list has.
static void change_the_rest(changes *self)
{
    ld_model model = *self->nominal;
    model.tubes.modes.span = LD_SPAN_CLAMPED;
    check_change(self, &model, "tubes.modes.span");
    model = *self->nominal;
    model.tubes.point_mass_count = 0;
    check_change(self, &model, "tubes.point_masses");
    model = *self->nominal;
    model.tubes.section_count--;
    check_change(self, &model, "tubes.sections");
    model = *self->nominal;
    model.tubes.section[1].form = LD_SECTION_STIFFNESS;
    check_change(self, &model, "tubes.sections.2");
    model = *self->nominal;
    model.tubes.slot.kind = LD_SLOT_NONE;
    check_change(self, &model, "tubes.slot");
}

static void read_tubes(const char *const *sets, size_t count, ld_model *model)
{
    ld_messages messages = {0};
    if (scenario_read_text(text, strlen(text), "tubes.yaml", LD_SOURCE_DIR "/examples", sets, count,
                           model, &messages)) {
        ld_messages_print(&messages, stderr);
        fail_msg("the tubes cannot be read");
    }
}

static void test_every_key_of_the_tubes(void **state)
{
    (void)state;
    ld_model nominal;
    read_tubes(NULL, 0, &nominal);
    static changes all;
    all.nominal = &nominal;
    run_afresh(&nominal, &all.unchanged);
    change_all(&all, &tubes_block, &nominal.tubes, "tubes");
    change_the_rest(&all);
    // not seen: where the tubes are, a bore without contact, friction before the rocket moves, a
    // jet before the exit
    printf("    %d changes of the tubes\n", all.count);
    CHECK_WITHIN("of which the launch shows", all.matter, all.count - 12, all.count);
    ld_simulation_free(all.renewed);
    model_clear(&nominal);
}

// What holds, drives and guides in other ways: clamps, on which the modes rest, a gas, surfaces.
static void test_clamps_gas_and_rails(void **state)
{
    (void)state;
    const char *const sets[] = {
        "tubes.supports=[{at: 0.4 m, clamped: all}, {at: 1.8 m, clamped: [y, z]}]",
        "tubes.loads=[{at: 0.2 m}, {at: 1 m, outer_fibre: 90 90 mm}]",
        "tubes.pressure={pressure: 2 MPa, volume: 0.03 m3, exponent: 1.4, ambient: 0.1 MPa}"};
    const char *const rail[] = {
        sets[0], sets[1], "run.start=undeformed",
        "rocket.adaptors=[{name: rear, at: 0 m}, {name: front, at: 1.9 m}]",
        "tubes={slot: none, guide: {line: 150 10 mm, t_slot: {at: -80 0 mm, lips: 40 mm, gap: 0 "
        "mm, side_gap: 0 mm}}}"};
    static changes gas, shoes;
    ld_model nominal, changed;
    read_tubes(sets, 3, &nominal);
    gas.nominal = &nominal;
    run_afresh(&nominal, &gas.unchanged);
    change_all(&gas, field_find(&tubes_block, "pressure")->block, &nominal.tubes.pressure,
               "tubes.pressure");
    for (int k = 0; k < 2; k++) {
        char path[] = "tubes.supports.#.at";
        path[15] = (char)('1' + k);
        change_number(&gas, path);
        changed = nominal;
        changed.tubes.support[k].clamped ^= 1u << LD_CLAMP_Y;
        check_change(&gas, &changed, "tubes.supports.N.clamped");
    }
    CHECK_WITHIN("changes of clamps and gas that the launch shows", gas.matter, gas.count,
                 gas.count);
    ld_simulation_free(gas.renewed);
    model_clear(&nominal);
    read_tubes(rail, 5, &nominal);
    shoes.nominal = &nominal;
    run_afresh(&nominal, &shoes.unchanged);
    change_all(&shoes, field_find(&tubes_block, "guide")->block, &nominal.tubes.guide,
               "tubes.guide");
    CHECK_WITHIN("changes of a rail that it shows", shoes.matter, shoes.count, shoes.count);
    ld_simulation_free(shoes.renewed);
    model_clear(&nominal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_key_of_the_tubes),
        cmocka_unit_test(test_clamps_gas_and_rails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
