// Files under temporary names: each writer has its own, and the last to end gives the file.
#include "support/check.h"
#include "support/scratch.h"

#include <stdbool.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/part_file.h"

static void fill(const part_file *part, const char *text)
{
    FILE *file = fopen(part->path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static void expect_text(const char *name, const char *text)
{
    char found[64] = "";
    FILE *file = fopen(in(name), "r");
    assert_non_null(file);
    assert_true(fgets(found, sizeof found, file) != NULL);
    fclose(file);
    assert_string_equal(found, text);
}

static bool is_there(const char *name)
{
    return access(in(name), F_OK) == 0;
}

static void test_two_writers(void **state)
{
    (void)state;
    part_file first, second;
    const char *name = in("x.csv");
    char path[128];
    strcpy(path, name);
    assert_int_equal(part_file_begin(&first, path, NULL), LD_OK);
    assert_int_equal(part_file_begin(&second, path, NULL), LD_OK);
    assert_string_equal(first.path, in("x.csv.part"));
    assert_string_equal(second.path, in("x.csv.2.part"));
    fill(&first, "first");
    fill(&second, "second");
    assert_int_equal(part_file_end(&first, LD_OK, NULL), LD_OK);
    expect_text("x.csv", "first");
    assert_int_equal(part_file_end(&second, LD_OK, NULL), LD_OK);
    expect_text("x.csv", "second");
    // one that fails changes nothing
    assert_int_equal(part_file_begin(&first, path, NULL), LD_OK);
    fill(&first, "half");
    assert_int_equal(part_file_end(&first, LD_ERR_MEMORY, NULL), LD_ERR_MEMORY);
    expect_text("x.csv", "second");
    assert_false(is_there("x.csv.part") || is_there("x.csv.2.part"));
}

static void test_rights(void **state)
{
    (void)state;
    part_file part;
    struct stat about;
    char path[128];
    strcpy(path, in("rights"));
    mode_t before = umask(027);
    assert_int_equal(part_file_begin(&part, path, NULL), LD_OK);
    assert_int_equal(part_file_end(&part, LD_OK, NULL), LD_OK);
    umask(before);
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0640);
}

// Its own part is gone: another program has removed it.
static void test_removed_meanwhile(void **state)
{
    (void)state;
    part_file part;
    ld_error error;
    char path[128];
    strcpy(path, in("gone"));
    assert_int_equal(part_file_begin(&part, path, NULL), LD_OK);
    unlink(part.path);
    assert_int_equal(part_file_end(&part, LD_OK, &error), LD_ERR_FILE);
    assert_non_null(strstr(error.text, "/gone: No such file or directory"));
}

static void expect_failure(const char *name, ld_status status, const char *text)
{
    part_file part;
    ld_error error = {.text = ""};
    assert_int_equal(part_file_begin(&part, name, &error), status);
    if (!strstr(error.text, text))
        fail_msg("\"%s\" does not say \"%s\"", error.text, text);
}

static void test_no_name_to_be_had(void **state)
{
    (void)state;
    char path[128], taken[160], lengthy[4097];
    strcpy(path, in("stale"));
    for (int i = 1; i <= 99; i++) {
        snprintf(taken, sizeof taken, i == 1 ? "%s.part" : "%s.%d.part", path, i);
        fclose(fopen(taken, "w"));
    }
    expect_failure(path, LD_ERR_FILE, "stale.part to .99.part; remove those");
    expect_failure(in("none/x"), LD_ERR_FILE, "none/x: No such file or directory");
    memset(lengthy, 'x', sizeof lengthy);
    lengthy[4096] = '\0';
    expect_failure(lengthy, LD_ERR_INPUT, "name is too long: xxx");
    // what is not a regular file is written itself
    part_file part;
    assert_int_equal(part_file_begin(&part, "/dev/null", NULL), LD_OK);
    assert_string_equal(part.path, "/dev/null");
    assert_int_equal(part_file_end(&part, LD_ERR_FILE, NULL), LD_ERR_FILE);
    assert_int_equal(access("/dev/null", F_OK), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_writers),
        cmocka_unit_test(test_rights),
        cmocka_unit_test(test_removed_meanwhile),
        cmocka_unit_test(test_no_name_to_be_had),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
