// Random numbers: the published vectors of the generator, uniformity, independence, the key alone.
#include "base/random.h"

#include "support/check.h"

// Random123's kat_vectors, philox4x64 10.
static void test_published_vectors(void **state)
{
    (void)state;
    static const struct {
        uint64_t counter[4], key[2], words[4];
    } known[] = {
        {{0, 0, 0, 0},
         {0, 0},
         {0x16554d9eca36314c, 0xdb20fe9d672d0fdc, 0xd7e772cee186176b, 0x7e68b68aec7ba23b}},
        {{UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX},
         {UINT64_MAX, UINT64_MAX},
         {0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6, 0xa09caebf594f0ba0}},
        {{0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0, 0x082efa98ec4e6c89},
         {0x452821e638d01377, 0xbe5466cf34e90c6c},
         {0xa528f45403e61d95, 0x38c72dbd566e9788, 0xa5a1610e72fd18b5, 0x57bd43b5e52b7fe6}},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        uint64_t words[4];
        random_block(known[i].key, known[i].counter, words);
        assert_memory_equal(words, known[i].words, sizeof words);
    }
}

// FNV's own test vectors.
static void test_streams(void **state)
{
    (void)state;
    assert_true(random_stream("") == 0xcbf29ce484222325u);
    assert_true(random_stream("a") == 0xaf63dc4c8601ec8cu);
    assert_true(random_stream("foobar") == 0x85944171f73967e8u);
}

// The layout of key and counter: seeds keep their meaning from version to version.
static void test_key(void **state)
{
    (void)state;
    uint64_t words[4], stream = random_stream("road");
    random_block((uint64_t[]){7, stream}, (uint64_t[]){1, 2, 3, 0}, words);
    double expected = ldexp((double)(2 * (words[0] >> 12) + 1), -53);
    assert_true(random_uniform(7, stream, 1, 2, 3) == expected);
    assert_true(expected > 0 && expected < 1);
}

// Counts in 1000 cells of (0, 1): chi-square has mean 999 and standard deviation 45.
static double chi_square(uint64_t seed, int step_i, int step_j)
{
    enum { CELLS = 1000, DRAWS = 1000000 };
    static int count[CELLS];
    memset(count, 0, sizeof count);
    for (uint64_t n = 0; n < DRAWS; n++)
        count[(int)(CELLS *
                    random_uniform(seed, 5, n * (uint64_t)step_i, n * (uint64_t)step_j, 0))]++;
    double sum = 0, mean = (double)DRAWS / CELLS;
    for (int i = 0; i < CELLS; i++)
        sum += (count[i] - mean) * (count[i] - mean) / mean;
    return sum;
}

static void test_uniformity(void **state)
{
    (void)state;
    CHECK_WITHIN("chi-square over i, 999 +- 3 sigma", chi_square(1, 1, 0), 865, 1133);
    CHECK_WITHIN("chi-square over j", chi_square(1, 0, 1), 865, 1133);
    CHECK_WITHIN("chi-square over both, another seed", chi_square(2, 3, 1), 865, 1133);
}

// Correlation of u - 1/2 with its neighbour in each index, in the seed and in the stream: standard
// deviation 1/sqrt(n).
static void test_independence(void **state)
{
    (void)state;
    enum { DRAWS = 100000 };
    static const char *const names[] = {"seed", "stream", "i", "j", "k"};
    for (int which = 0; which < 5; which++) {
        double sum = 0;
        for (uint64_t n = 0; n < DRAWS; n++) {
            uint64_t a[5] = {n % 7, n % 11, n, n % 13, n / 3}, b[5];
            memcpy(b, a, sizeof b);
            b[which]++;
            sum += (random_uniform(a[0], a[1], a[2], a[3], a[4]) - 0.5) *
                   (random_uniform(b[0], b[1], b[2], b[3], b[4]) - 0.5) * 12;
        }
        char what[64];
        snprintf(what, sizeof what, "correlation with the next %s, in sigmas", names[which]);
        CHECK_BELOW(what, sum / sqrt(DRAWS), 3);
    }
}

static void test_order_of_calls(void **state)
{
    (void)state;
    enum { DRAWS = 1000 };
    double forward[DRAWS];
    for (uint64_t i = 0; i < DRAWS; i++)
        forward[i] = random_uniform(3, 4, i, 1, 2);
    for (uint64_t i = DRAWS; i-- > 0;)
        assert_true(forward[i] == random_uniform(3, 4, i, 1, 2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_published_vectors),
        cmocka_unit_test(test_streams),
        cmocka_unit_test(test_key),
        cmocka_unit_test(test_uniformity),
        cmocka_unit_test(test_independence),
        cmocka_unit_test(test_order_of_calls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
