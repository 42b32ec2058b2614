// Random models on a fixed or prescribed base: support/random_model.h.
#include "support/random_model.h"

#include "support/check.h"

static void draw_jointed(uint64_t seed, ld_model *model)
{
    draw_random_model(seed, model);
    draw_joint(seed, model);
}

static void every_model_ends(void **state)
{
    (void)state;
    run_random_models(draw_jointed, OF_ALL(24, 8));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_model_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
