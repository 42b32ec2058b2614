// Text files as they are read: whole or not at all, with what keeps them from it.
#include "support/check.h"
#include "support/scratch.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/text_file.h"

enum { LIMIT = 1 << 15 };

static void write_bytes(const char *name, size_t count)
{
    FILE *file = fopen(in(name), "w");
    assert_non_null(file);
    for (size_t i = 0; i < count; i++)
        fputc('a', file);
    assert_int_equal(fclose(file), 0);
}

static void expect_whole(const char *path, size_t count)
{
    char *text;
    size_t length;
    ld_error error;
    assert_int_equal(text_file_read(path, LIMIT, &text, &length, &error), LD_OK);
    assert_true(length == count && strlen(text) == count);
    free(text);
}

static void expect_failure(const char *path, ld_status status, const char *sentence)
{
    char *text;
    size_t length;
    ld_error error;
    assert_int_equal(text_file_read(path, LIMIT, &text, &length, &error), status);
    assert_string_equal(error.text, sentence);
}

static void test_files(void **state)
{
    (void)state;
    write_bytes("none", 0);
    write_bytes("most", LIMIT);
    write_bytes("more", LIMIT + 1);
    expect_whole(in("none"), 0);
    expect_whole(in("most"), LIMIT);
    expect_failure(in("more"), LD_ERR_INPUT, "is larger than 32 kB");
    expect_failure(in("nothing"), LD_ERR_INPUT, "cannot be read: No such file or directory");
    expect_failure("/dev/zero", LD_ERR_INPUT, "is not a regular file");
    mkdir(in("folder"), 0777);
    expect_failure(in("folder"), LD_ERR_INPUT, "is not a regular file");
}

// Standard input has no size to look at first: what has no end is refused where the limit is.
static void test_standard_input(void **state)
{
    (void)state;
    assert_non_null(freopen(in("most"), "r", stdin));
    expect_whole("-", LIMIT);
    assert_non_null(freopen("/dev/zero", "r", stdin));
    expect_failure("-", LD_ERR_INPUT, "is larger than 32 kB");
    assert_non_null(freopen(in("folder"), "r", stdin));
    expect_failure("-", LD_ERR_INPUT, "cannot be read: Is a directory");
}

static void test_status(void **state)
{
    (void)state;
    static const int given[] = {ENOENT, ENOTDIR, EISDIR, EACCES, EPERM, ELOOP, ENAMETOOLONG};
    for (size_t i = 0; i < sizeof given / sizeof *given; i++)
        assert_int_equal(text_file_status(given[i]), LD_ERR_INPUT);
    assert_int_equal(text_file_status(ENOMEM), LD_ERR_MEMORY);
    assert_int_equal(text_file_status(EIO), LD_ERR_FILE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_files),
        cmocka_unit_test(test_standard_input),
        cmocka_unit_test(test_status),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
