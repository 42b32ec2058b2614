// link: -Wl,--wrap=realloc
// A stream and a writer into memory: what was written, or that there was no room for it.
#include "support/check.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

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
    FILE *stream = ld_text_open(&text, &length);
    for (int i = 0; i < 100000; i++) {
        none = i >= 50000 && i < 99000;
        fprintf(stream, "%d,", i);
    }
    assert_int_equal(ld_text_close(stream), LD_ERR_MEMORY);
    assert_null(text);
    assert_int_equal(length, 0);
}

// Of all lengths about that which is printed at once, and of a text that is not ended.
static void test_writer(void **state)
{
    (void)state;
    char expected[20000] = "", *text;
    size_t length, printed = 0;
    text_writer to = {0};
    for (int i = 250; i < 262; i++) {
        text_print(&to, "%0*d", i, i);
        printed += (size_t)sprintf(expected + printed, "%0*d", i, i);
    }
    text_add(&to, "ab", 1);
    text_put(&to, "cd");
    strcat(expected, "acd");
    text = text_take(&to, &length);
    assert_string_equal(text, expected);
    assert_int_equal(length, printed + 3);
    free(text);
    text = text_take(&to, &length); // nothing was written
    assert_string_equal(text, "");
    assert_int_equal(length, 0);
    free(text);
}

static void test_writer_without_memory(void **state)
{
    (void)state;
    size_t length = 1;
    text_writer to = {0};
    for (int i = 0; i < 100000; i++) {
        none = i >= 50000 && i < 99000;
        text_print(&to, "%d,", i);
    }
    assert_true(to.full);
    assert_null(text_take(&to, &length));
    assert_int_equal(length, 0);
}

// What has no room is cut; the byte behind is left alone.
static void test_fixed_room(void **state)
{
    (void)state;
    for (size_t size = 1; size < 12; size++) {
        char text[12], expected[12];
        memset(text, '#', sizeof text);
        text_writer to = {.text = text, .capacity = size, .fixed = true};
        text_put(&to, "abcd");
        text_print(&to, "%d", 12345);
        snprintf(expected, size, "abcd12345");
        assert_string_equal(text, expected);
        assert_int_equal(to.full, size < 10);
        assert_int_equal(text[size], '#');
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_was_written), cmocka_unit_test(test_no_memory),
        cmocka_unit_test(test_writer),           cmocka_unit_test(test_writer_without_memory),
        cmocka_unit_test(test_fixed_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
