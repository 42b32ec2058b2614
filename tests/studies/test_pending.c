// Records that wait for the database: what a file of them gives back to the same study, and that
// another one takes none of it.
#include "support/check.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "studies/store/pending.h"

static const study_shape asked = {.rockets = 2, .of_sample = 3, .of_rocket = 1, .results = 4};
static char path[64];

static void write_record(void)
{
    study_record *record = calloc(1, record_size(&asked));
    study_pending pending;
    assert_non_null(record);
    record->number = 7;
    record->shape = asked;
    for (int64_t i = 0; i < record_rocket(&asked, asked.rockets); i++)
        record->value[i] = 0.5 + (double)i;
    snprintf(path, sizeof path, "/tmp/launchdyn-pending-%ld", (long)getpid());
    unlink(path);
    assert_int_equal(pending_open(&pending, path, 1, &asked, NULL), LD_OK);
    pending_add(&pending, record);
    pending_close(&pending);
    free(record);
}

// How many records of a file with one are taken for a study of that key and shape.
static int taken(uint64_t key, study_shape shape)
{
    study_pending pending;
    write_record();
    assert_int_equal(pending_open(&pending, path, key, &shape, NULL), LD_OK);
    int count = pending.count;
    pending_close(&pending);
    return count;
}

static void test_same_study(void **state)
{
    (void)state;
    study_pending pending;
    write_record();
    assert_int_equal(pending_open(&pending, path, 1, &asked, NULL), LD_OK);
    assert_int_equal(pending.count, 1);
    const study_record *record = pending_read(&pending, 0);
    assert_int_equal(record->number, 7);
    for (int64_t i = 0; i < record_rocket(&asked, asked.rockets); i++)
        assert_true(record->value[i] == 0.5 + (double)i);
    pending_close(&pending);
    unlink(path);
}

static void test_other_studies(void **state)
{
    (void)state;
    study_shape other[] = {asked, asked, asked, asked};
    other[0].rockets--;
    other[1].of_sample++;
    other[2].of_rocket++;
    other[3].results++;
    for (int i = 0; i < 4; i++)
        assert_int_equal(taken(1, other[i]), 0);
    assert_int_equal(taken(2, asked), 0);
}

// Behind a record that is damaged the others are there.
static void test_damaged(void **state)
{
    (void)state;
    enum { RECORDS = 5 };
    study_record *record = calloc(1, record_size(&asked));
    study_pending pending;
    assert_non_null(record);
    write_record();
    assert_int_equal(pending_open(&pending, path, 1, &asked, NULL), LD_OK);
    record->shape = asked;
    for (record->number = 8; record->number < 7 + RECORDS; record->number++)
        pending_add(&pending, record);
    size_t slot = pending.slot_size;
    pending_close(&pending);
    free(record);
    FILE *file = fopen(path, "r+");
    assert_non_null(file);
    for (int i = 0; i < RECORDS; i += 2) { // the first, the third and the last
        assert_int_equal(fseek(file, (long)((size_t)i * slot + slot / 2), SEEK_SET), 0);
        fputc('x', file);
    }
    fclose(file);
    assert_int_equal(pending_open(&pending, path, 1, &asked, NULL), LD_OK);
    assert_int_equal(pending.count, 2);
    assert_int_equal(pending_read(&pending, 0)->number, 8);
    assert_int_equal(pending_read(&pending, 1)->number, 10);
    pending_clear(&pending);
    pending_close(&pending);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_study),
        cmocka_unit_test(test_other_studies),
        cmocka_unit_test(test_damaged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
