// Forward dynamics against published-quality reference accelerations (113-bit arithmetic, agreed by
// four other libraries).
#include "launchdyn/mstmm.h"

#include "support/check.h"
#include "support/multibody_case.h"
#include "systems/multibody/multibody.h"

// Largest error of the accelerations over the largest acceleration; the forces that
// the rounded reference accelerations need (the mass matrix's condition times their rounding).
static void check_case(const char *name, double bound, double force_bound)
{
    static multibody_case c;
    ld_mstmm *system;
    ld_error error = {0};
    double u_dot[CASE_VALUES], tau[CASE_VALUES], size = 0, off = 0, force = 0, force_off = 0;
    assert_int_equal(read_multibody_case(name, &c), 0);
    if (ld_mstmm_create(c.element, c.count, c.gravity, &system, &error))
        fail_msg("%s", error.text);
    assert_int_equal(ld_mstmm_accelerations(system, c.q, c.u, c.tau, NULL, u_dot, &error), LD_OK);
    ld_mstmm_forces(system, c.q, c.u, c.u_dot, NULL, tau);
    for (int i = 0; i < ld_mstmm_speed_count(system); i++) {
        size = fmax(size, fabs(c.u_dot[i]));
        off = fmax(off, fabs(u_dot[i] - c.u_dot[i]));
        force = fmax(force, fabs(c.tau[i]));
        force_off = fmax(force_off, fabs(tau[i] - c.tau[i]));
    }
    char what[64];
    snprintf(what, sizeof what, "%s: accelerations", name);
    CHECK_BELOW(what, off / size, bound);
    snprintf(what, sizeof what, "%s: forces back from the accelerations", name);
    CHECK_BELOW(what, force_off / force, force_bound);
    ld_mstmm_free(system);
}

#ifdef LD_HAVE_AVX
// The sweep for wider registers gives the same bits.
static void test_same_bits_with_wider_registers(void **state)
{
    (void)state;
    static multibody_case c;
    static const char *const names[] = {"chain3", "chain10", "chain100", "vehicle"};
    for (int k = 0; k < 4; k++) {
        ld_mstmm *system;
        double plain[CASE_VALUES] = {0}, wide[CASE_VALUES] = {0};
        ld_error error;
        assert_int_equal(read_multibody_case(names[k], &c), 0);
        if (ld_mstmm_create(c.element, c.count, c.gravity, &system, &error))
            fail_msg("%s", error.text);
        ld_mstmm_accelerations(system, c.q, c.u, c.tau, NULL, wide, &error);
        system->sweep = &sweep_default;
        ld_mstmm_accelerations(system, c.q, c.u, c.tau, NULL, plain, &error);
        assert_memory_equal(plain, wide, sizeof plain);
        ld_mstmm_free(system);
    }
}
#endif

static void test_reference_cases(void **state)
{
    (void)state;
    check_case("chain3", 1e-15, 2e-15);
    check_case("chain10", 2e-15, 5e-14);
    check_case("chain100", 5e-15, 5e-11);
    check_case("vehicle", 2e-15, 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference_cases),
#ifdef LD_HAVE_AVX
        cmocka_unit_test(test_same_bits_with_wider_registers),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
