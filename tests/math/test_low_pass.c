// The Butterworth low pass against closed forms: step responses, gain and phase of sines, ramps.
#include "support/check.h"

#include "math/curves/low_pass.h"

static const double pi = 3.141592653589793;

// Response to a unit step, by steps of uneven length.
static void test_steps(void **state)
{
    (void)state;
    const double cutoff = 25, w = 2 * pi * cutoff;
    double worst[2] = {0, 0};
    for (int order = 1; order <= 2; order++) {
        low_pass filter;
        low_pass_begin(&filter, cutoff, order, 0);
        low_pass_step(&filter, 0, 1);
        double t = 0;
        for (int i = 0; i < 200; i++) {
            double dt = i % 3 == 0 ? 1e-7 : i % 3 == 1 ? 3.7e-4 : 2.1e-3;
            t += dt;
            low_pass_step(&filter, dt, 1);
            double expected =
                order == 1 ? 1 - exp(-w * t)
                           : 1 - sqrt(2) * exp(-w * t / sqrt(2)) * sin(w * t / sqrt(2) + pi / 4);
            worst[order - 1] = fmax(worst[order - 1], fabs(low_pass_output(&filter) - expected));
        }
    }
    CHECK_BELOW("step response, order 1", worst[0], 1e-14);
    CHECK_BELOW("step response, order 2", worst[1], 2e-14);
}

// |H|^2 = 1/(1 + (f/fc)^(2 n)), by the settled response to a sine.
static void test_gain(void **state)
{
    (void)state;
    double worst = 0;
    for (int order = 1; order <= LOW_PASS_MOST; order++)
        for (int k = 0; k < 3; k++) {
            double cutoff = 40, f = cutoff * (k == 0 ? 0.3 : k == 1 ? 1 : 1.7), w = 2 * pi * f;
            double dt = 1 / (4000 * f), c = 0, s = 0;
            low_pass filter;
            low_pass_begin(&filter, cutoff, order, 0);
            for (int i = 1; i <= 4000 * 64; i++) {
                double t = i * dt;
                low_pass_step(&filter, dt, sin(w * t));
                if (i > 4000 * 56) {
                    c += low_pass_output(&filter) * cos(w * t) / (4000 * 4);
                    s += low_pass_output(&filter) * sin(w * t) / (4000 * 4);
                }
            }
            double gain = hypot(c, s), expected = 1 / sqrt(1 + pow(f / cutoff, 2 * order));
            worst = fmax(worst, fabs(gain - expected));
        }
    CHECK_BELOW("gain, orders 1 to 8, at 0.3, 1 and 1.7 of the cut-off", worst, 1e-6);
}

// A settled ramp lags by the delay at low frequency, sum of 1/p_k: sqrt(2)/w for order 2, 2/w for
// order 3; and steps cut in two change nothing.
static void test_ramp(void **state)
{
    (void)state;
    const double cutoff = 10, w = 2 * pi * cutoff, lag[] = {sqrt(2) / w, 2 / w};
    for (int order = 2; order <= 3; order++) {
        low_pass whole, halves;
        low_pass_begin(&whole, cutoff, order, 5);
        low_pass_begin(&halves, cutoff, order, 5);
        CHECK_NEAR("settled at the start", low_pass_output(&whole), 5, 1e-14);
        double t = 0, worst = 0;
        for (int i = 0; i < 300; i++) {
            double dt = 0.01;
            low_pass_step(&whole, dt, 5 + 3 * (t + dt));
            low_pass_step(&halves, 0.3 * dt, 5 + 3 * (t + 0.3 * dt));
            low_pass_step(&halves, 0.7 * dt, 5 + 3 * (t + dt));
            t += dt;
            worst = fmax(worst, fabs(low_pass_output(&whole) - low_pass_output(&halves)));
        }
        CHECK_BELOW("steps cut in two", worst, 1e-13);
        CHECK_NEAR("lag of a ramp [s]", t - (low_pass_output(&whole) - 5) / 3, lag[order - 2],
                   1e-13);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_steps),
        cmocka_unit_test(test_gain),
        cmocka_unit_test(test_ramp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
