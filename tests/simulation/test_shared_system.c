// One simulation run by several threads at a time: nothing in it changes, so each gets the bits of
// a run alone. On a vehicle, whose chain of bodies has a workspace; with rockets that differ.
#include <pthread.h>

#include "model/model.h"
#include "quantities/summary.h"
#include "support/check.h"
#include "support/reference_model.h"

enum { THREADS = 3 };

typedef struct one_run {
    const ld_simulation *simulation;
    ld_summary summary;
    ld_status status;
    ld_error error;
} one_run;

static void *run(void *self)
{
    one_run *the = self;
    the->status = ld_simulation_run(the->simulation, NULL, &the->summary, &the->error);
    // what differs from run to run
    the->summary.statistics.cpu_seconds = 0;
    return NULL;
}

static void threads_get_the_bits_of_one(void **state)
{
    (void)state;
    ld_model model;
    ld_simulation *simulation;
    ld_error error;
    reference_vehicle(&model, 8);
    model.run.lead_in = 0;
    model.run.end = LD_END_TIP;
    model.firing_count = 2;
    model.firing[1] = (ld_firing){.tube = 7, .at = 0.5};
    ld_rocket rocket[2] = {model.rocket, model.rocket};
    rocket[1].full.mass += 1;
    model.salvo = rocket;
    if (ld_simulation_create(&model, &simulation, &error))
        fail_msg("%s", error.text);
    static one_run alone, beside[THREADS];
    alone.simulation = simulation;
    run(&alone);
    if (alone.status)
        fail_msg("%s", alone.error.text);
    pthread_t thread[THREADS];
    for (int i = 0; i < THREADS; i++) {
        beside[i].simulation = simulation;
        assert_int_equal(pthread_create(&thread[i], NULL, run, &beside[i]), 0);
    }
    int differ = 0;
    for (int i = 0; i < THREADS; i++) {
        pthread_join(thread[i], NULL);
        differ += memcmp((const char *)&beside[i].summary, (const char *)&alone.summary,
                         sizeof alone.summary) != 0;
    }
    CHECK_WITHIN("threads whose summary is another than that of a run alone", differ, 0, 0);
    CHECK_WITHIN("rockets that left, of the run alone", alone.summary.rocket_count, 2, 2);
    ld_simulation_free(simulation);
    model.salvo = NULL;
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_get_the_bits_of_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
