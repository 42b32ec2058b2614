// link: -Wl,--wrap=malloc -Wl,--wrap=calloc -Wl,--wrap=realloc -Wl,--wrap=aligned_alloc
// Nothing is allocated between the first and the last step of a run: the linker leads each call of
// the allocator, from our code and from the integrator's library, through a counter. Nor does a
// number fall below the smallest normal one, which would cost a processor a hundred times an
// operation.
#include "model/model.h"
#include "support/check.h"

#include <fenv.h>
#include <stdlib.h>

#include "quantities/summary.h"
#include "support/multibody_case.h"
#include "support/reference_model.h"

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

static long allocations;

void *__wrap_malloc(size_t size)
{
    allocations++;
    return __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    allocations++;
    return __real_calloc(count, size);
}

void *__wrap_realloc(void *old, size_t size)
{
    allocations++;
    return __real_realloc(old, size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    allocations++;
    return __real_aligned_alloc(alignment, size);
}

// Allocations seen at rows of the history: the first after a step was made, and the latest.
typedef struct counter {
    long rows, at_first_step, at_last_step;
} counter;

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)self, (void)columns, (void)count, (void)error;
    return LD_OK;
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    (void)values, (void)count, (void)error;
    counter *seen = self;
    if (++seen->rows == 2)
        seen->at_first_step = allocations;
    seen->at_last_step = allocations;
    return LD_OK;
}

static void check_model(const char *name, const ld_model *model)
{
    ld_error error;
    ld_simulation *simulation;
    ld_summary summary;
    counter seen = {0};
    ld_sink sink = {.self = &seen, .begin = begin, .row = row};
    long before = allocations;
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, &(ld_run_options){.sink = &sink}, &summary, &error))
        fail_msg("%s", error.text);
    printf("  %s: %lld steps, %ld rows, %ld allocations in all\n", name,
           (long long)summary.statistics.steps, seen.rows, allocations - before);
    assert_true(seen.rows > 1000);
    assert_true(allocations > before); // the counter is at work
    CHECK_BELOW("allocations between first and last step",
                (double)(seen.at_last_step - seen.at_first_step), 0);
    ld_simulation_free(simulation);
}

static void a_run_allocates_nothing(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    check_model("reduced form, fixed base", &model);
    model.run.formulation = LD_FORMULATION_OVERALL;
    check_model("overall form, fixed base", &model);
    model.base.kind = LD_BASE_PRESCRIBED;
    model.base.pitch = (ld_sines){1, {{0.03, 1, 0}}};
    model.run.lead_in = 0.01;
    check_model("overall form, moving base", &model);
    model.run.formulation = LD_FORMULATION_REDUCED;
    model.rocket.contact.law = LD_CONTACT_LANKARANI_NIKRAVESH;
    check_model("reduced form, moving base, lankarani-nikravesh", &model);
    model.base.motion = reference_table(
        3, 7, (double[]){-1, 0, 0, 0, 0, 0, 0, 0.1, 1, 0, 0, 0, 0, 0, 1, 3, 0.1, 0, 0, 0, 0});
    check_model("reduced form, base by a table", &model);
    reference_model_free(&model);
    reference_vehicle(&model, 8);
    model.base.vehicle.road.form = LD_ROAD_SUM;
    model.base.vehicle.road.iso_class = 2;
    model.run.lead_in = 0.1;
    check_model("reduced form, vehicle on a road of class C", &model);
    model.platform.elevation.lock = (ld_hinge_lock){true, 1e8, 1e5};
    check_model("reduced form, vehicle with a locked hinge", &model);
    reference_model_free(&model);
}

// Works, which steer no step, least of all.
static void a_run_does_not_underflow(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    ld_simulation *simulation;
    ld_summary summary;
    reference_model(&model);
    assert_int_equal(ld_simulation_create(&model, &simulation, &error), LD_OK);
    feclearexcept(FE_UNDERFLOW);
    assert_int_equal(ld_simulation_run(simulation, NULL, &summary, &error), LD_OK);
    assert_false(fetestexcept(FE_UNDERFLOW));
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

// The sweep of a multibody system allocates nothing either.
static void accelerations_of_a_chain_allocate_nothing(void **state)
{
    (void)state;
    static multibody_case c;
    double u_dot[CASE_VALUES], tau[CASE_VALUES];
    ld_mstmm *system;
    ld_error error;
    assert_int_equal(read_multibody_case("chain100", &c), 0);
    if (ld_mstmm_create(c.element, c.count, c.gravity, &system, &error))
        fail_msg("%s", error.text);
    long before = allocations;
    for (int k = 0; k < 100; k++) {
        ld_mstmm_accelerations(system, c.q, c.u, c.tau, NULL, u_dot, &error);
        ld_mstmm_forces(system, c.q, c.u, u_dot, NULL, tau);
    }
    CHECK_BELOW("100 times forward and inverse dynamics: allocations",
                (double)(allocations - before), 0);
    ld_mstmm_free(system);
    assert_true(allocations > 0); // the counter counts
}

// Nor do evaluations and projections of closed loops, near a singular pose (flat) and apart.
static void closed_loops_allocate_nothing(void **state)
{
    (void)state;
    ld_mstmm_element e[3] = {{.name = "left"},
                             {.name = "coupler", .parent = "left", .at = {1}},
                             {.name = "right", .at = {1}}};
    for (int i = 0; i < 3; i++) {
        e[i].hinge = LD_HINGE_REVOLUTE;
        e[i].axis[2] = e[i].mass = e[i].inertia[1] = e[i].inertia[2] = 1;
    }
    const ld_mstmm_loop l = {.name = "pin",
                             .first = {.element = "coupler", .at = {1}},
                             .second = {.element = "right", .at = {1}},
                             .joint = LD_HINGE_REVOLUTE,
                             .axis = {0, 0, 1}};
    const ld_mstmm_description d = {
        .elements = e, .element_count = 3, .loops = &l, .loop_count = 1, .gravity = {0, -9.81, 0}};
    double q[3] = {1, -1, 1}, u[3] = {1, -1, 1}, u_dot[3];
    ld_mstmm *system;
    ld_error error;
    if (ld_mstmm_build(&d, &system, &error) || ld_mstmm_assemble(system, q, u, NULL, NULL, &error))
        fail_msg("%s", error.text);
    long before = allocations;
    for (int k = 0; k < 100; k++) {
        q[0] = q[2] = 0.01 * k + 1e-5;
        q[1] = -q[0];
        assert_int_equal(ld_mstmm_accelerations(system, q, u, NULL, NULL, u_dot, &error), LD_OK);
        assert_int_equal(ld_mstmm_project(system, q, u, &error), LD_OK);
    }
    CHECK_BELOW("100 evaluations and projections of a loop: allocations",
                (double)(allocations - before), 0);
    ld_mstmm_free(system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_run_allocates_nothing),
        cmocka_unit_test(a_run_does_not_underflow),
        cmocka_unit_test(accelerations_of_a_chain_allocate_nothing),
        cmocka_unit_test(closed_loops_allocate_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
