// link: -Wl,--wrap=realloc
// A stream into memory: what was written, or that there was no room for it.
#include "support/check.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/memory_stream.h"

void *__real_realloc(void *old, size_t size);
void *__wrap_realloc(void *old, size_t size);

static bool none; // there is no memory

void *__wrap_realloc(void *old, size_t size)
{
    return none ? NULL : __real_realloc(old, size);
}

static void test_what_was_written(void **state)
{
    (void)state;
    char *text;
    size_t length;
    FILE *stream = memory_stream(&text, &length);
    assert_int_equal(fclose(stream), 0);
    assert_string_equal(text, "");
    assert_int_equal(length, 0);
    free(text);
    stream = memory_stream(&text, &length);
    for (int i = 0; i < 100000; i++)
        fprintf(stream, "%d,", i);
    fputc('\0', stream);
    assert_int_equal(fclose(stream), 0);
    assert_int_equal(length, 588891);
    assert_memory_equal(text + length - 13, "99998,99999,\0", 13);
    free(text);
}

// For a while, in the middle of it: nothing is left out without a word.
static void test_no_memory(void **state)
{
    (void)state;
    char *text;
    size_t length;
    FILE *stream = memory_stream(&text, &length);
    for (int i = 0; i < 100000; i++) {
        none = i >= 50000 && i < 99000;
        fprintf(stream, "%d,", i);
    }
    assert_int_equal(fclose(stream), EOF);
    assert_null(text);
    assert_int_equal(length, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_was_written),
        cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
