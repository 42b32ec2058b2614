// A measured motion: splines against the motion that was sampled and their order of convergence,
// quaternions against angles, wrapped angles, signs, and clocks that count from long ago.
#include "systems/bases/motion_table.h"

#include <stdlib.h>

#include "scenario/clock_text.h"
#include "support/check.h"
#include "systems/bases/base_coordinates.h"

static const double PI = 3.14159265358979323846;

enum { MOST = 700 };
static double rows[MOST * 8];
static double middle_pitch = 0.1;

// A base that yaws through the end of a turn while it pitches and rolls; its derivatives.
static void motion_at(double t, double x[6], double u[6], double a[6])
{
    static const double start[6] = {1, 5, -2, 3.0, 0, -3.1}, rate[6] = {5, 0, 1, 0.6, 0, -0.4},
                        amplitude[6] = {0.3, 0.8, 0.2, 0.4, 0.5, 0.3},
                        omega[6] = {1.3, 1.9, 0.7, 2.3, 1.7, 2.9};
    for (int i = 0; i < 6; i++) {
        double s = sin(omega[i] * t + i), c = cos(omega[i] * t + i);
        x[i] = start[i] + rate[i] * t + amplitude[i] * s;
        u[i] = rate[i] + amplitude[i] * omega[i] * c;
        a[i] = -amplitude[i] * omega[i] * omega[i] * s;
    }
    x[4] += middle_pitch;
}

typedef enum rows_form { ANGLES, WRAPPED, QUATERNIONS } rows_form;

// Rows from -2 s to 3 s, not evenly spaced; of quaternions every third has the other sign and they
// are 0.5 % too long.
static ld_base sampled(rows_form form, size_t count)
{
    ld_base base = {.kind = LD_BASE_PRESCRIBED};
    size_t columns = form == QUATERNIONS ? 8 : 7;
    m3 none = m3_identity();
    for (size_t i = 0; i < count; i++) {
        double *row = rows + i * columns, u[6], a[6], part = (double)i / (double)(count - 1);
        base_frame frame;
        double x[6];
        row[0] = -2 + 5 * part + 0.2 * sin(2 * PI * part);
        motion_at(row[0], x, u, a);
        base_frame_at(x, u, a, &none, &frame);
        memcpy(row + 1, x, sizeof x);
        for (int k = 4; k < 7 && form == WRAPPED; k++)
            row[k] = remainder(row[k], 2 * PI);
        const double q[4] = {frame.q.w, frame.q.x, frame.q.y, frame.q.z};
        for (int k = 0; k < 4 && form == QUATERNIONS; k++)
            row[4 + k] = (i % 3 ? 1.005 : -1.005) * q[k];
    }
    base.motion = (ld_table){count, columns, rows};
    return base;
}

// Largest errors of position and attitude, of velocities and of accelerations, at places all over.
static void errors_of(rows_form form, size_t count, double worst[3])
{
    ld_base model = sampled(form, count);
    motion_table table;
    m3 none = m3_identity();
    assert_int_equal(motion_table_build(&table, &model, NULL), LD_OK);
    double turns[3] = {NAN, NAN, NAN}; // between both angles, the same all the time
    memset(worst, 0, 3 * sizeof *worst);
    for (double t = -1.9; t < 2.9; t += 0.0037) {
        double x[6], u[6], a[6], p[6] = {0}, v[6] = {0}, b[6] = {0};
        base_frame found, due;
        motion_at(t, x, u, a);
        base_frame_at(x, u, a, &none, &due);
        motion_table_add(&table, t, p, v, b);
        base_frame_at(p, v, b, &none, &found);
        if (form == QUATERNIONS)
            motion_table_place(&table, t, &none, &found);
        for (int k = 0; k < 3 && middle_pitch < 1; k++) {
            double off = p[3 + k] - x[3 + k];
            turns[k] = isnan(turns[k]) ? 2 * PI * round(off / (2 * PI)) : turns[k];
            worst[0] = fmax(worst[0], fabs(off - turns[k]));
        }
        for (int k = 0; k < 9; k++)
            worst[0] = fmax(worst[0], fabs(found.A.a[k / 3][k % 3] - due.A.a[k / 3][k % 3]));
        worst[0] = fmax(worst[0], v3_norm(v3_sub(found.r, due.r)));
        worst[1] = fmax(worst[1], v3_norm(v3_sub(found.v, due.v)));
        worst[1] = fmax(worst[1], v3_norm(v3_sub(found.w, due.w)));
        worst[2] = fmax(worst[2], v3_norm(v3_sub(found.a, due.a)));
        worst[2] = fmax(worst[2], v3_norm(v3_sub(found.alpha, due.alpha)));
    }
    motion_table_free(&table);
}

// Half the step: 2^4 in place, 2^3 in velocity, 2^2 in acceleration.
static void check_order(rows_form form, const char *what, const double bound[3])
{
    static const char *const of[3] = {"place", "velocity", "acceleration"};
    double coarse[3], fine[3];
    char text[80];
    errors_of(form, 160, coarse);
    errors_of(form, 640, fine);
    for (int i = 0; i < 3; i++) {
        snprintf(text, sizeof text, "%s, 640 rows: %s", what, of[i]);
        CHECK_BELOW(text, fine[i], bound[i]);
        snprintf(text, sizeof text, "%s: order of the error in %s", what, of[i]);
        CHECK_WITHIN(text, log2(coarse[i] / fine[i]) / 2, 3.8 - i, 4.2 - i);
    }
}

static void test_angles(void **state)
{
    (void)state;
    check_order(ANGLES, "angles", (double[]){8e-10, 3e-7, 3e-4});
    check_order(WRAPPED, "wrapped angles", (double[]){8e-10, 3e-7, 3e-4});
}

static void test_quaternions(void **state)
{
    (void)state;
    check_order(QUATERNIONS, "quaternions", (double[]){8e-10, 3e-7, 3e-4});
    middle_pitch = 1.5; // upright, where yaw and roll are one
    check_order(QUATERNIONS, "quaternions, upright", (double[]){8e-10, 3e-7, 3e-4});
    middle_pitch = 0.1;
}

// What goes through several turns in rows far apart is meant so.
static void test_unwrapping(void **state)
{
    (void)state;
    double turns[] = {0, 2.5 * PI, 4.9 * PI}, wrapped[] = {3, -3, 3.1, -2.9, -2}, meant[5];
    memcpy(meant, (double[]){3, 2 * PI - 3, 3.1, 2 * PI - 2.9, 2 * PI - 2}, sizeof meant);
    motion_unwrap(3, 1, turns);
    motion_unwrap(5, 1, wrapped);
    CHECK_BELOW("several turns stay", turns[1] - 2.5 * PI + turns[2] - 4.9 * PI, 0);
    for (int i = 0; i < 5; i++)
        CHECK_BELOW("a jump by a turn goes", wrapped[i] - meant[i], 1e-15);
    double half[] = {0, 1.4 * PI, 0};
    motion_unwrap(3, 1, half);
    CHECK_BELOW("a step of 252 deg stays", half[1] - 1.4 * PI, 0);
}

// ---- clocks

static void read_clock(const char *text, double factor, bool first, double origin, double time)
{
    double found_origin = origin, value = strtod(text, NULL);
    double found = clock_read(text, value, factor, first, &found_origin);
    if (found != time || found_origin != origin)
        fail_msg("%s: %.17g after %.17g, not %.17g after %.17g", text, found, found_origin, time,
                 origin);
}

// The same rows on a clock of 1.7e9 s; and if its times were plain numbers.
static void test_late_rows(void **state)
{
    (void)state;
    ld_base base = sampled(ANGLES, 640);
    motion_table early, late;
    motion_table plain;
    double worst = 0, rounded = 0;
    assert_int_equal(motion_table_build(&early, &base, NULL), LD_OK);
    for (size_t i = 0; i < 640; i++)
        rows[7 * i] += 2.5;
    base.motion_origin = 1700000000;
    base.motion_start = 1700000002.5;
    assert_int_equal(motion_table_build(&late, &base, NULL), LD_OK);
    for (size_t i = 0; i < 640; i++)
        rows[7 * i] += 1700000000;
    base.motion_origin = 0;
    assert_int_equal(motion_table_build(&plain, &base, NULL), LD_OK);
    for (double t = -1.9; t < 2.9; t += 0.0037) {
        double x[6] = {0}, u[6] = {0}, a[6] = {0}, p[6] = {0}, v[6] = {0}, b[6] = {0};
        motion_table_add(&early, t, x, u, a);
        motion_table_add(&late, t, p, v, b);
        for (int k = 0; k < 6; k++)
            worst = fmax(worst, fabs(p[k] - x[k]) + fabs(v[k] - u[k]) + fabs(b[k] - a[k]));
        memset(b, 0, sizeof b);
        motion_table_add(&plain, t, p, v, b);
        for (int k = 0; k < 6; k++)
            rounded = fmax(rounded, fabs(b[k] - a[k]));
    }
    CHECK_BELOW("1.7e9 s later: place, velocity and acceleration", worst, 1e-9);
    CHECK_WITHIN("with plain times: acceleration", rounded, 0.03, 0.3);
    motion_table_free(&plain);
    motion_table_free(&early);
    motion_table_free(&late);
}

static void test_clock(void **state)
{
    (void)state;
    read_clock("1700000000.0123456789", 1, false, 1700000000, 0.0123456789);
    read_clock("1.7000000000123456789e+09 s", 1, true, 1700000000, 0.0123456789);
    read_clock("1700000000012345678", 1e-9, true, 1700000000, 0.012345678);
    read_clock("1700000003012.5", 1e-3, false, 1700000000, 3.0125);
    read_clock("+17000000000000e-4", 1, true, 1700000000, 0);
    read_clock("28333333.5", 60, true, 1700000010, 0);
    read_clock("28333334.25", 60, false, 1700000010, 45);
    read_clock("-1700000000.5", 1, true, 0, -1700000000.5);
    read_clock("99999.25", 1, true, 0, 99999.25);
    read_clock("1e300", 1, true, 0, 1e300);
    read_clock("1e300", 1, false, 1700000000, 1e300);
    read_clock("1699999999.99999999999999999999", 1, true, 1700000000, 0);
    read_clock("5", 1e-9, false, 1e14, 5e-9 - 1e14);

    // what is printed is read back
    static const double times[] = {0, 0.1, 1 / 3.0, 1e-17, 2.5e5, 12345.678901234567};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        char text[CLOCK_TEXT];
        clock_print(times[i], 1700000000, text);
        read_clock(text, 1, false, 1700000000, times[i]);
    }
    char text[CLOCK_TEXT];
    clock_print(0.05, 1700000000, text);
    assert_string_equal(text, "1700000000.05");
    clock_print(-0.5, 0, text);
    assert_string_equal(text, "-0.5");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_angles),     cmocka_unit_test(test_quaternions),
        cmocka_unit_test(test_unwrapping), cmocka_unit_test(test_late_rows),
        cmocka_unit_test(test_clock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
