// What a search keeps: found again to the bit; what is damaged is cut off, and said where it cannot
// be.
#include "support/check.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "search/search_state.h"
#include "support/scratch.h"

enum { KEYS = 2, NUMBERS = 3, POINTS = 4, HEAD = 96 };

static const search_kind kind = {"fit", KEYS, NUMBERS};

// The library's files are cut by this one, which may refuse.
static bool refuse;

int ftruncate(int file, off_t length) // NOLINT(readability-inconsistent-declaration-parameter-name)
{
    if (refuse) {
        errno = EPERM;
        return -1;
    }
    return (int)syscall(SYS_ftruncate, file, length);
}

static const double point[POINTS][KEYS] = {{0.1, 0.2}, {0.3, 0.4}, {0.5, 0.6}, {0.7, 0.8}};

static void open_state(search_state *state)
{
    ld_error error;
    if (search_state_open(state, &kind, folder, "identity", &error))
        fail_msg("%s", error.text);
}

static void put_all(search_state *state, int from)
{
    ld_error error;
    for (int i = from; i < POINTS; i++) {
        const double number[NUMBERS] = {i, -i, 1. / (i + 3)};
        assert_int_equal(search_state_put(state, point[i], number, i != 2, &error), LD_OK);
    }
    assert_int_equal(search_state_flush(state, &error), LD_OK);
}

// How many of the points are found.
static int find_all(search_state *state)
{
    int found = 0;
    bool there;
    double number[NUMBERS];
    while (found < POINTS && search_state_next(state, point[found], number, &there)) {
        assert_int_equal(there, found != 2);
        assert_true(!there || number[2] == 1. / (found + 3));
        found++;
    }
    return found;
}

static long size_of_file(void)
{
    FILE *file = fopen(in("fit.state"), "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    fclose(file);
    return size;
}

static long record_size(void)
{
    return (size_of_file() - HEAD) / POINTS;
}

// Changes a byte in the record of a point.
static void damage(int number)
{
    long at = HEAD + number * record_size() + 20;
    FILE *file = fopen(in("fit.state"), "r+b");
    assert_non_null(file);
    fseek(file, at, SEEK_SET);
    int byte = fgetc(file);
    fseek(file, at, SEEK_SET);
    fputc(byte ^ 1, file);
    fclose(file);
}

static void write_state(void)
{
    search_state state;
    remove(in("fit.state"));
    open_state(&state);
    put_all(&state, 0);
    search_state_close(&state);
}

static void test_kept(void **unused)
{
    (void)unused;
    search_state state;
    write_state();
    open_state(&state);
    assert_int_equal(find_all(&state), POINTS);
    search_state_close(&state);
}

static void test_damaged(void **unused)
{
    (void)unused;
    search_state state;
    write_state();
    long whole = size_of_file();
    damage(1);
    open_state(&state);
    assert_int_equal(find_all(&state), 1);
    assert_int_equal(size_of_file(), HEAD + (whole - HEAD) / POINTS);
    put_all(&state, 1);
    search_state_close(&state);
    open_state(&state);
    assert_int_equal(find_all(&state), POINTS);
    search_state_close(&state);
    assert_int_equal(size_of_file(), whole);
}

// The points that are computed again do not go behind what is damaged: the search ends.
static void test_uncut(void **unused)
{
    (void)unused;
    search_state state;
    ld_error error;
    const double number[NUMBERS] = {0};
    char expected[256];
    write_state();
    long whole = size_of_file();
    damage(2);
    open_state(&state);
    refuse = true;
    assert_int_equal(find_all(&state), 2);
    assert_int_equal(search_state_put(&state, point[2], number, true, &error), LD_ERR_FILE);
    refuse = false;
    snprintf(expected, sizeof expected, "cannot cut what is damaged off %s: %s", in("fit.state"),
             strerror(EPERM));
    assert_string_equal(error.text, expected);
    search_state_close(&state);
    assert_int_equal(size_of_file(), whole);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_kept), cmocka_unit_test(test_damaged),
                                       cmocka_unit_test(test_uncut)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
