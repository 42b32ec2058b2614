// A state as bytes: their order, what comes back, what is refused.
#include "base/archive.h"

#include "support/check.h"

typedef struct members {
    double x, y[3];
    int64_t wide, counted;
    int narrow;
    bool yes, no;
    char text[16];
} members;

static void walk(members *self, archive *bytes)
{
    archive_expect(bytes, 20);
    archive_double(bytes, &self->x);
    archive_doubles(bytes, self->y, 3);
    archive_int64(bytes, &self->wide);
    archive_count(bytes, &self->counted);
    archive_int(bytes, &self->narrow, -7, 12);
    archive_bool(bytes, &self->yes);
    archive_bool(bytes, &self->no);
    archive_text(bytes, self->text, sizeof self->text);
}

enum { SIZE = 12 * 8 };

static const members some = {-1.5,  {NAN, -0.0, 1e-310}, INT64_MIN, INT64_C(1) << 53, -7, true,
                             false, "fifteen letters"};

static void what_was_saved_comes_back(void **state)
{
    (void)state;
    unsigned char bytes[SIZE];
    members out = some, in;
    memset(&in, 0, sizeof in);
    archive counted = archive_save(NULL, 0), saved = archive_save(bytes, SIZE);
    walk(&out, &counted);
    assert_int_equal(counted.at, SIZE);
    walk(&out, &saved);
    assert_false(saved.failed);
    assert_int_equal(saved.at, SIZE);
    archive loaded = archive_load(bytes, SIZE);
    walk(&in, &loaded);
    assert_false(loaded.failed);
    assert_memory_equal(&in.x, &some.x, sizeof some.x);
    assert_memory_equal(in.y, some.y, sizeof some.y);
    assert_true(in.wide == some.wide && in.counted == some.counted && in.narrow == some.narrow);
    assert_true(in.yes && !in.no);
    assert_string_equal(in.text, some.text);
}

static void the_lowest_byte_is_the_first(void **state)
{
    (void)state;
    unsigned char bytes[16];
    archive saved = archive_save(bytes, sizeof bytes);
    int64_t whole = 0x0102030405060708;
    double one = 1;
    archive_int64(&saved, &whole);
    archive_double(&saved, &one);
    const unsigned char expected[16] = {8, 7, 6, 5, 4, 3, 2, 1, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f};
    assert_memory_equal(bytes, expected, sizeof expected);
}

static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    unsigned char bytes[SIZE];
    members all = some;
    archive saved = archive_save(bytes, SIZE);
    walk(&all, &saved);
    for (size_t size = 0; size < SIZE; size++) { // neither room nor bytes enough
        archive small = archive_save(bytes, size), cut = archive_load(bytes, size);
        walk(&all, &small);
        assert_true(small.failed && small.at == SIZE);
        members in = some;
        walk(&in, &cut);
        assert_true(cut.failed && !in.no);
    }
    const struct {
        int word, byte, value;
    } wrong[] = {
        {0, 0, 21},              // not what is expected
        {6, 0, 1},               // a count above 2^53
        {6, 7, 0x80},            // or below 0
        {7, 0, 0xf8},            // -8: below the least
        {7, 7, 0x7f},            // above the most
        {8, 0, 2},    {9, 7, 1}, // neither true nor false
        {11, 7, 'x'},            // a text without an end
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        unsigned char other[SIZE];
        memcpy(other, bytes, SIZE);
        archive again = archive_save(other, SIZE);
        members in = some;
        walk(&in, &again);
        other[8 * wrong[i].word + wrong[i].byte] = (unsigned char)wrong[i].value;
        archive loaded = archive_load(other, SIZE);
        walk(&in, &loaded);
        assert_true(loaded.failed);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_saved_comes_back),
        cmocka_unit_test(the_lowest_byte_is_the_first),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
