// What a core gives at best: additions and multiplications, divisions and square roots by the width
// of the registers, the wait for one after the other, reading from caches and memory. Process CPU
// time. Nothing is fused, as everywhere in launchdyn.
#include <string.h>

#include "bench_sample.h"

enum { REPEATS = 21, CHAINS = 12, ROUNDS = 20000, READERS = 8 };

// What is done in registers of LANES numbers; each returns a number, which keeps the work alive.
#define DEFINE_WIDTH(LANES, TARGET)                                                                \
    typedef double lanes_##LANES __attribute__((vector_size(8 * (LANES))));                        \
    TARGET static double multiply_add_##LANES(const double *x, size_t rounds)                      \
    {                                                                                              \
        lanes_##LANES chain[CHAINS] = {{0}}, factor = chain[0] + x[0], term = chain[0] + x[1];     \
        for (size_t i = 0; i < rounds; i++)                                                        \
            for (int k = 0; k < CHAINS; k++) {                                                     \
                chain[k] = chain[k] * factor + term;                                               \
                __asm__("" : "+x"(chain[k])); /* kept apart from its neighbours */                 \
            }                                                                                      \
        for (int k = 1; k < CHAINS; k++)                                                           \
            chain[0] += chain[k];                                                                  \
        return chain[0][0];                                                                        \
    }                                                                                              \
    TARGET static double divide_##LANES(const double *x, size_t rounds)                            \
    {                                                                                              \
        lanes_##LANES chain[CHAINS] = {{0}}, one = chain[0] + x[2];                                \
        for (int k = 0; k < CHAINS; k++)                                                           \
            chain[k] += x[1];                                                                      \
        for (size_t i = 0; i < rounds; i++)                                                        \
            for (int k = 0; k < CHAINS; k++) {                                                     \
                chain[k] = one / chain[k];                                                         \
                __asm__("" : "+x"(chain[k]));                                                      \
            }                                                                                      \
        for (int k = 1; k < CHAINS; k++)                                                           \
            chain[0] += chain[k];                                                                  \
        return chain[0][0];                                                                        \
    }                                                                                              \
    TARGET static double read_##LANES(const double *x, size_t count)                               \
    {                                                                                              \
        lanes_##LANES sum[READERS] = {{0}}, piece;                                                 \
        for (size_t i = 0; i + READERS * (LANES) <= count; i += READERS * (LANES))                 \
            for (int k = 0; k < READERS; k++) {                                                    \
                memcpy(&piece, x + i + k * (LANES), sizeof piece);                                 \
                sum[k] += piece;                                                                   \
            }                                                                                      \
        for (int k = 1; k < READERS; k++)                                                          \
            sum[0] += sum[k];                                                                      \
        return sum[0][0];                                                                          \
    }

DEFINE_WIDTH(2, )
DEFINE_WIDTH(4, __attribute__((target("avx2"))))
DEFINE_WIDTH(8, __attribute__((target("avx512f"))))

static double multiply_add_1(const double *x, size_t rounds)
{
    const double factor = x[0], term = x[1];
    double a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0;
    for (size_t i = 0; i < rounds; i++) {
        a = a * factor + term, b = b * factor + term, c = c * factor + term, d = d * factor + term;
        e = e * factor + term, f = f * factor + term, g = g * factor + term, h = h * factor + term;
        __asm__("" : "+x"(a), "+x"(b), "+x"(c), "+x"(d), "+x"(e), "+x"(f), "+x"(g), "+x"(h));
    }
    return a + b + c + d + e + f + g + h;
}

// One after the other: a product and a sum, a quotient, a root.
static double wait_multiply_add(const double *x, size_t rounds)
{
    double y = x[1];
    for (size_t i = 0; i < rounds; i++)
        y = y * x[0] + x[1];
    return y;
}

static double wait_divide(const double *x, size_t rounds)
{
    double y = x[1];
    for (size_t i = 0; i < rounds; i++)
        y = x[2] / y;
    return y;
}

static double wait_root(const double *x, size_t rounds)
{
    double y = x[1];
    for (size_t i = 0; i < rounds; i++) {
        __asm__("sqrtsd %0, %0" : "+x"(y));
        y += x[1];
    }
    return y;
}

static double kept; // so that no work is left out

static void bench(const char *what, double (*work)(const double *, size_t), const double *x,
                  size_t count, int passes, double operations)
{
    double sample[REPEATS];
    for (int r = -REPEATS / 10; r < REPEATS; r++) {
        double start = now();
        for (int pass = 0; pass < passes; pass++)
            kept += work(x, count);
        sample[r < 0 ? 0 : r] = (now() - start) / (passes * operations);
    }
    print(what, sample, REPEATS, 1e-9, "ns");
}

static void bench_reading(const char *what, double (*work)(const double *, size_t), size_t bytes)
{
    size_t count = bytes / sizeof(double);
    double *x = calloc(count, sizeof *x);
    if (!x)
        exit(1);
    for (size_t i = 0; i < count; i++)
        x[i] = 1;
    bench(what, work, x, count, (int)(((size_t)1 << 28) / bytes), (double)bytes);
    free(x);
}

int main(void)
{
    static const double numbers[3] = {0.5, 1.5, 1.7};
    const double all = 1.0 * CHAINS * ROUNDS;
    double (*reader)(const double *, size_t) = read_2;
    bench("an addition or multiplication, 1 lane", multiply_add_1, numbers, ROUNDS, 1,
          16.0 * ROUNDS);
    bench("an addition or multiplication, 2 lanes", multiply_add_2, numbers, ROUNDS, 1, 4 * all);
    bench("a division, 2 lanes", divide_2, numbers, ROUNDS, 1, 2 * all);
    if (__builtin_cpu_supports("avx2")) {
        reader = read_4;
        bench("an addition or multiplication, 4 lanes", multiply_add_4, numbers, ROUNDS, 1,
              8 * all);
        bench("a division, 4 lanes", divide_4, numbers, ROUNDS, 1, 4 * all);
    }
    if (__builtin_cpu_supports("avx512f")) {
        reader = read_8;
        bench("an addition or multiplication, 8 lanes", multiply_add_8, numbers, ROUNDS, 1,
              16 * all);
        bench("a division, 8 lanes", divide_8, numbers, ROUNDS, 1, 8 * all);
    }
    bench("wait for a product and a sum", wait_multiply_add, numbers, ROUNDS, 1, ROUNDS);
    bench("wait for a quotient", wait_divide, numbers, ROUNDS, 1, ROUNDS);
    bench("wait for a square root and a sum", wait_root, numbers, ROUNDS, 1, ROUNDS);
    bench_reading("a byte of 16 KiB", reader, (size_t)1 << 14);
    bench_reading("a byte of 512 KiB", reader, (size_t)1 << 19);
    bench_reading("a byte of 16 MiB", reader, (size_t)1 << 24);
    bench_reading("a byte of 256 MiB", reader, (size_t)1 << 28);
    return kept != kept;
}
