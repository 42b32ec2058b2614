// link: -Wl,--wrap=malloc -Wl,--wrap=calloc -Wl,--wrap=realloc -Wl,--wrap=aligned_alloc
// link: -Wl,--wrap=free
// Too little memory, however much of it, ends a simulation or its run with one sentence: the linker
// leads each call of the allocator, from our code and from the integrator's library, here.
#include "model/model.h"
#include "support/check.h"

#include <malloc.h>
#include <stdlib.h>

#include "launchdyn/run.h"
#include "quantities/summary.h"
#include "support/reference_model.h"

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *block);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __wrap_free(void *block);

static size_t used, most = SIZE_MAX; // [bytes]
static int arrays, refused;          // of arrays of 8-byte entries that of this number fails

static bool has_room(size_t size)
{
    return most == SIZE_MAX || (used < most && size <= most - used);
}

// What others have allocated is given back here too: not below zero.
static void forget(void *block)
{
    size_t size = malloc_usable_size(block);
    used -= size < used ? size : used;
}

static void *count(void *block)
{
    used += malloc_usable_size(block);
    return block;
}

void *__wrap_malloc(size_t size)
{
    return has_room(size) ? count(__real_malloc(size)) : NULL;
}

void *__wrap_calloc(size_t number, size_t size)
{
    bool fails = size == 8 && ++arrays == refused;
    return has_room(number * size) && !fails ? count(__real_calloc(number, size)) : NULL;
}

void *__wrap_realloc(void *old, size_t size)
{
    if (!has_room(size))
        return NULL;
    forget(old);
    return count(__real_realloc(old, size));
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    return has_room(size) ? count(__real_aligned_alloc(alignment, size)) : NULL;
}

void __wrap_free(void *block)
{
    forget(block);
    __real_free(block);
}

static ld_status try_run(const ld_model *model, size_t room, ld_error *error)
{
    static ld_summary summary;
    ld_simulation *simulation;
    used = 0;
    most = room;
    ld_status status = ld_simulation_create(model, &simulation, error);
    if (!status) {
        status = ld_simulation_run(simulation, NULL, &summary, error);
        ld_simulation_free(simulation);
    }
    most = SIZE_MAX;
    return status;
}

static void check_model(const char *name, const ld_model *model)
{
    enum { STEP = 1 << 12 };
    ld_error error;
    size_t room = 0;
    for (ld_status status; (status = try_run(model, room, &error)) != LD_OK; room += STEP)
        if (status != LD_ERR_MEMORY || !strstr(error.text, "memory"))
            fail_msg("%s, room for %zu bytes: %s", name, room, error.text);
    printf("  %s: wants %zu kB\n", name, room / 1024);
    assert_true(room > STEP);
}

// The integrator's library takes the rest of what it needs in its first step; where it gets none
// for a vector, or for the first array, it crashes: the other arrays alone fail here.
static ld_status try_first_step(const ld_simulation *simulation, int array, ld_error *error)
{
    ld_run *run;
    assert_int_equal(ld_run_begin(simulation, NULL, &run, error), LD_OK);
    arrays = 0;
    refused = array;
    ld_status status = ld_run_advance(run, 1e-6, error);
    refused = 0;
    ld_run_end(run, NULL, NULL);
    return status;
}

static void check_first_step(const char *name, const ld_model *model)
{
    ld_simulation *simulation;
    ld_error error;
    int array = 1;
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    for (ld_status status; (status = try_first_step(simulation, ++array, &error)) != LD_OK;)
        if (status != LD_ERR_MEMORY || !strstr(error.text, "memory"))
            fail_msg("%s, array %d of the first step: %s", name, array, error.text);
    printf("  %s: %d arrays in the first step\n", name, array - 1);
    assert_true(array > 2);
    ld_simulation_free(simulation);
}

static void a_run_without_memory_says_so(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    check_model("fixed base", &model);
    check_first_step("fixed base", &model);
    reference_model_free(&model);
    reference_vehicle(&model, 8);
    model.run.lead_in = 0;
    model.run.coupling_step = 1e-3;
    check_model("vehicle, subsystems apart", &model);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_run_without_memory_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
