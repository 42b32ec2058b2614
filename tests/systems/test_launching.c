// The launching subsystem against dense multipliers from positions alone, on random states.
#include <stdlib.h>

#include "support/check.h"
#include "support/launching_state.h"
#include "support/reference_model.h"

typedef struct agreement {
    double eta, V, slot, lock, contact, elastic;
} agreement;

static double relative3(const double *a, v3 b, double scale)
{
    double d[3];
    v3_store(d, b);
    return sqrt((a[0] - d[0]) * (a[0] - d[0]) + (a[1] - d[1]) * (a[1] - d[1]) +
                (a[2] - d[2]) * (a[2] - d[2])) /
           scale;
}

static double norm3(const double *a)
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

// Largest differences, relative to the largest acceleration of the kind and to the largest force.
static void compare(const launching_system *system, const launching_case *c,
                    const launching_output *out, const dense_launch_output *dense, agreement *worst)
{
    double modal = 0, modal_error = 0, force = fabs(dense->slot_force) + fabs(dense->lock_force);
    for (int i = 0; i < system->layout.nq; i++) {
        modal = fmax(modal, fabs(dense->q_ddot[i]));
        modal_error = fmax(modal_error, fabs(dense->q_ddot[i] - out->q_ddot[i]));
    }
    for (int i = 0; i < system->adaptor_count; i++)
        force += c->phase.passed[i] ? 0 : fabs(dense->contact[i].normal);
    worst->eta = fmax(worst->eta, relative3(dense->a, out->a, norm3(dense->a)));
    worst->eta = fmax(worst->eta, relative3(dense->w_dot, out->w_dot, norm3(dense->w_dot)));
    worst->eta = fmax(worst->eta, modal_error / modal);
    worst->V = fmax(worst->V, relative3(dense->a_O1, out->a_O1, norm3(dense->a_O1)));
    worst->V = fmax(worst->V, relative3(dense->alpha_B, out->alpha_B, norm3(dense->alpha_B)));
    worst->slot = fmax(worst->slot, fabs(dense->slot_force - out->N) / force);
    worst->lock = fmax(worst->lock, fabs(dense->lock_force - out->lock_force) / force);
    for (int i = 0; i < system->adaptor_count; i++)
        if (!c->phase.passed[i])
            worst->contact = fmax(worst->contact,
                                  fabs(dense->contact[i].normal - out->adaptor[i].normal) / force);
}

typedef launching_outcome (*evaluator)(const launching_system *, const launching_input *,
                                       const launching_phase *, const double *,
                                       launching_output *);

static void check_agreement(const ld_model *model, evaluator evaluate, int count, const char *name,
                            double bound)
{
    launching_system *system = aligned_alloc(64, (sizeof *system + 63) / 64 * 64);
    dense_launch dense;
    ld_error error;
    assert_int_equal(launching_build(system, model, &error), LD_OK);
    dense_launch_create(&dense, model, &system->tube);
    uint64_t seed = 20261121;
    agreement worst = {0};
    for (int k = 0; k < count; k++) {
        launching_case c;
        launching_output out;
        dense_launch_output reference;
        draw_state(system, &seed, k % 4 == 0, &c);
        for (int i = system->adaptor_count - 1; i > 0 && draw(&seed) > 0.5; i--)
            c.phase.passed[i] = true;
        copy_to_dense(system, &c);
        assert_int_equal(evaluate(system, &c.input, &c.phase, c.state, &out), LAUNCHING_OK);
        assert_true(dense_launch_evaluate(&dense, &c.dense, &reference));
        compare(system, &c, &out, &reference, &worst);
    }
    printf("  %s, %d states:\n", name, count);
    CHECK_BELOW("tube accelerations", worst.eta, bound);
    CHECK_BELOW("rocket accelerations", worst.V, bound);
    CHECK_BELOW("slot force", worst.slot, bound);
    CHECK_BELOW("lock force", worst.lock, bound);
    CHECK_BELOW("contact forces", worst.contact, bound);
    dense_launch_free(&dense);
    launching_free(system);
    free(system);
}

static void reduced_equals_dense(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.rocket.motor.misalignment[0] = 1e-3;
    model.rocket.motor.misalignment[1] = -2e-3;
    model.rocket.motor.at[1] = 1e-3;
    model.rocket.knob_angle = 0.4;
    int modes[2] = {3, 5};
    for (int i = 0; i < 2; i++) {
        char name[64];
        model.tubes.modes.bending = modes[i];
        snprintf(name, sizeof name, "reduced, %d bending modes a plane", modes[i]);
        check_agreement(&model, launching_evaluate, 500, name, 1e-10);
    }
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reduced_equals_dense),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
