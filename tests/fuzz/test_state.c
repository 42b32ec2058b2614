// The seeds of fuzz_state, and inputs that once failed, run as a test.
#include "fuzz/fuzz_state.c"

#include "fuzz/corpus.h"

static void test_corpus(void **state)
{
    (void)state;
    int count = run_folder(LD_SOURCE_DIR "/tests/fuzz/state", LLVMFuzzerTestOneInput);
    CHECK_WITHIN("inputs run", count, 20, 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_corpus)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
