// The inputs of fuzz_mesh, and changes of them, as a test.
#include "fuzz/fuzz_mesh.c"

#include "fuzz/corpus.h"

static void test_corpus(void **state)
{
    (void)state;
    corpus_test("mesh", 2000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_corpus)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
