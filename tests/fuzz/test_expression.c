// The inputs of fuzz_expression, and changes of them, as a test.
#include "fuzz/fuzz_expression.c"

#include "fuzz/corpus.h"

static void test_corpus(void **state)
{
    (void)state;
    corpus_test("expression", 100000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_corpus)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
