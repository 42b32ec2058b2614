// Bases of bodies, joints, loops and force elements followed in time: energy and works balance, in
// space momenta stay; both as the independent mechanism (support/dense_mechanism.h) has them.
#include "support/check.h"

#include "model/model.h"
#include "support/mechanism_case.h"
#include "support/reference_model.h"
#include "systems/bases/mechanism_base.h"

enum { STATES = BASE_MOST_STATES + 1 }; // and the work of all forces on the bodies

// A base under a wrench that stays in T.
typedef struct motion {
    const base_system *base;
    mechanism_case *c;
    double elastic; // [J] of the latest evaluation
} motion;

static void find_rates(motion *self, double t, const double *state, double *rate)
{
    static base_output out;
    const base_system *base = self->base;
    int n = base->state_count;
    base_frame tube;
    base_found found;
    base_load load = {.force = self->c->tube_force,
                      .moment = self->c->tube_moment,
                      .rest = self->c->rest,
                      .linear = self->c->linear};
    base->kind->find_frame(base, t, state, &tube, &found);
    assert_int_equal(base->kind->dynamics->evaluate(base, &found, &load, state, &out), 0);
    memcpy(rate, out.rate, (size_t)n * sizeof *rate);
    rate[n] = v3_dot(load.force, m3_apply_transposed(tube.A, tube.v)) +
              v3_dot(load.moment, m3_apply_transposed(tube.A, tube.w));
    for (int k = 0; k < base->work_count; k++)
        rate[n] += out.power[k];
    self->elastic = out.elastic;
}

// One step of Runge's and Kutta's fourth order.
static void step(motion *self, double t, double h, double *state)
{
    static const double at[] = {0, 0.5, 0.5, 1}, weight[] = {1, 2, 2, 1};
    double k[STATES] = {0}, trial[STATES], sum[STATES] = {0};
    int n = self->base->state_count + 1;
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < n; i++)
            trial[i] = state[i] + at[stage] * h * k[i];
        find_rates(self, t + at[stage] * h, trial, k);
        for (int i = 0; i < n; i++)
            sum[i] += weight[stage] * k[i];
    }
    for (int i = 0; i < n; i++)
        state[i] += h / 6 * sum[i];
    if (self->base->drifts)
        self->base->kind->dynamics->project(self->base, t + h, state);
}

// Mechanical energy less the work of all that is not elastic [J].
static double balance(motion *self, const dense_mechanism *dense, double t, const double *state)
{
    static dense_mechanism_output out;
    double rate[STATES];
    base_frame carrier = mechanism_base_carrier(self->base, t);
    dense_mechanism_input input = {.t = t,
                                   .state = state,
                                   .carrier = &carrier,
                                   .rest = self->c->rest.hold,
                                   .linear = self->c->linear};
    assert_true(dense_mechanism_evaluate(dense, &input, &out));
    find_rates(self, t, state, rate);
    return out.kinetic + self->elastic - state[self->base->state_count];
}

typedef struct momenta {
    v3 linear, angular; // about the origin of I
} momenta;

static momenta momenta_of(const dense_mechanism *dense, const double *state)
{
    static dense_mechanism_output out;
    static const base_frame still = {.A = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .q = {1, 0, 0, 0}};
    dense_mechanism_input input = {.state = state, .carrier = &still};
    momenta sum = {.linear = v3_zero(), .angular = v3_zero()};
    dense_mechanism_place(dense, &input, &out);
    for (int k = 0; k < dense->given->body_count; k++) {
        const dense_body *body = &dense->body[k];
        const dense_frame *f = &out.body[k];
        v3 moment = m3_apply(f->A, body->moment);
        v3 p = v3_axpy(v3_cross(f->w, moment), body->mass, f->v);
        v3 spin = m3_apply(f->A, m3_apply(body->inertia, m3_apply_transposed(f->A, f->w)));
        sum.linear = v3_add(sum.linear, p);
        sum.angular = v3_add(sum.angular, v3_add(v3_cross(f->r, p), spin));
        sum.angular = v3_add(sum.angular, v3_cross(moment, f->v));
    }
    return sum;
}

// A mechanism that was drawn, in a random state.
typedef struct drawn {
    ld_model model;
    base_system base;
    dense_mechanism dense;
    mechanism_case c;
} drawn;

static bool begin(uint64_t *seed, int kind, const mechanism_options *options, drawn *d)
{
    ld_error error;
    double start[BASE_MOST_STATES];
    draw_mechanism(seed, kind, options, &d->model);
    if (base_build(&d->base, &d->model, NULL, &error))
        fail_msg("mechanism %d: %s", kind, error.text);
    dense_mechanism_create(&d->dense, &d->model, d->model.firing[0].tube, NULL, 0);
    dense_mechanism_start(&d->dense, start);
    base_frame carrier = mechanism_base_carrier(&d->base, 0);
    dense_mechanism_begin(&d->dense, &carrier, start);
    return draw_mechanism_state(seed, &d->dense, &d->model, &d->base, &d->c);
}

static void end(drawn *d)
{
    base_free(&d->base);
    reference_model_free(&d->model);
}

enum { STEPS = 1500 };
static const double H = 4e-6;

static void energy_and_works_balance(void **state)
{
    (void)state;
    uint64_t seed = 4711;
    double worst = 0;
    int followed = 0;
    for (int kind = 0; kind < OF_ALL(40, 3); kind++) {
        mechanism_options options = {.bodies = 2 + kind % 5,
                                     .loops = kind % 4,
                                     .carrier = kind % 5 == 1,
                                     .wheels = kind % 8 == 3,
                                     .elements = kind % 6 != 5,
                                     .flat = kind % 6 == 4,
                                     .smooth = true};
        drawn d;
        if (begin(&seed, kind, &options, &d)) {
            motion m = {&d.base, &d.c, 0};
            double y[STATES] = {0}, most = 1, t = d.c.t;
            memcpy(y, d.c.state, (size_t)d.base.state_count * sizeof *y);
            double before = balance(&m, &d.dense, t, y);
            for (int i = 0; i < STEPS; i++) {
                step(&m, t + i * H, H, y);
                most = fmax(most, fabs(y[d.base.state_count]));
            }
            double after = balance(&m, &d.dense, t + STEPS * H, y);
            worst = fmax(worst, fabs(after - before) / fmax(most, before));
            followed++;
        }
        end(&d);
    }
    printf("    %d mechanisms over %g s\n", followed, STEPS * H);
    CHECK_BELOW("energy less works, of the largest", worst, 5e-10);
}

static void momenta_stay_in_space(void **state)
{
    (void)state;
    uint64_t seed = 815;
    double linear = 0, angular = 0;
    int followed = 0;
    for (int kind = 0; kind < OF_ALL(40, 3); kind++) {
        mechanism_options options = {
            .bodies = 2 + kind % 5, .loops = kind % 4, .elements = kind % 6 != 5, .isolated = true};
        drawn d;
        if (begin(&seed, kind, &options, &d)) {
            d.c.tube_force = d.c.tube_moment = v3_zero();
            motion m = {&d.base, &d.c, 0};
            double y[STATES] = {0};
            memcpy(y, d.c.state, (size_t)d.base.state_count * sizeof *y);
            momenta before = momenta_of(&d.dense, y);
            for (int i = 0; i < STEPS; i++)
                step(&m, d.c.t + i * H, H, y);
            momenta after = momenta_of(&d.dense, y);
            linear =
                fmax(linear, v3_norm(v3_sub(after.linear, before.linear)) / v3_norm(before.linear));
            angular = fmax(angular, v3_norm(v3_sub(after.angular, before.angular)) /
                                        v3_norm(before.angular));
            followed++;
        }
        end(&d);
    }
    printf("    %d mechanisms over %g s\n", followed, STEPS * H);
    CHECK_BELOW("momentum (relative)", linear, 1e-10);
    CHECK_BELOW("angular momentum (relative)", angular, 5e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(energy_and_works_balance),
                                       cmocka_unit_test(momenta_stay_in_space)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
