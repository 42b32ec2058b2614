// The inputs of fuzz_summary, and changes of them, as a test.
#include "fuzz/fuzz_summary.c"

#include "fuzz/corpus.h"

static void test_corpus(void **state)
{
    (void)state;
    corpus_test("summary", 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_corpus)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
