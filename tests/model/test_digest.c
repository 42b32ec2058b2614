// The digest of a model: the same for a model read again, another one whatever key is changed.
#include <stdlib.h>

#include "model/fields/digest.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "support/check.h"

static ld_model read(const char *file, const char *set)
{
    ld_model model;
    ld_messages messages = {0};
    char path[512];
    snprintf(path, sizeof path, "%s/examples/%s", LD_SOURCE_DIR, file);
    if (scenario_read(path, &set, set != NULL, &model, &messages))
        fail_msg("%s with %s cannot be read", file, set ? set : "nothing");
    return model;
}

static uint64_t digest_of(const char *file, const char *set)
{
    ld_model model = read(file, set);
    uint64_t digest = model_digest(&model);
    model_clear(&model);
    return digest;
}

// Numbers, integers, choices, tables, lists, lists of integers, blocks with a switch.
static void every_kind_of_key_counts(void **state)
{
    (void)state;
    static const char *const sets[] = {
        "rocket.mass=60.00000000000001 kg",
        "rocket.lock.release_force=5.1 kN",
        "rocket.contact.law=kelvin-voigt",
        "rocket.motor.thrust=[[0 s, 25 kN], [0.3 s, 25 kN]]",
        "tubes.modes.bending=8",
        "tubes.slot.angle=4.1 deg",
        "base.road.seed=2",
        "base.speed=31 km/h",
        "run.tolerance=1e-7",
        "run.end=tip",
        "firing=[{tube: 9, at: 0 s}]",
    };
    enum { SETS = sizeof sets / sizeof *sets };
    uint64_t digest[SETS + 1] = {digest_of("reference.yaml", NULL)};
    int same = 0;
    for (int i = 1; i <= SETS; i++) {
        digest[i] = digest_of("reference.yaml", sets[i - 1]);
        for (int k = 0; k < i; k++)
            if (digest[i] == digest[k]) {
                printf("    %s\n", sets[i - 1]);
                same++;
            }
    }
    CHECK_WITHIN("changes that are not seen", same, 0, 0);
    assert_true(digest[0] == digest_of("reference.yaml", NULL));
}

static void rockets_of_a_salvo_count(void **state)
{
    (void)state;
    ld_model model = read("sequence.yaml", NULL);
    ld_rocket rocket[LD_MAX_FIRINGS];
    for (int i = 0; i < model.firing_count; i++)
        rocket[i] = model.rocket;
    model.salvo = rocket;
    uint64_t before = model_digest(&model);
    rocket[model.firing_count - 1].adaptor[0].clearance *= 1 + 1e-15;
    assert_true(model_digest(&model) != before);
    model.salvo = NULL;
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_key_counts),
        cmocka_unit_test(rockets_of_a_salvo_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
