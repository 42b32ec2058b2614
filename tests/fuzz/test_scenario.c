// The inputs of fuzz_scenario, and changes of them, as a test.
#include "fuzz/fuzz_scenario.c"

#include "fuzz/corpus.h"

static void test_corpus(void **state)
{
    (void)state;
    corpus_test("scenario", 4000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_corpus)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
