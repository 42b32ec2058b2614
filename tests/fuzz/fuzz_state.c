// Any bytes, given as the state of a run, are refused or make a run that continues or ends with a
// message. The input is changes of the numbers of a true state: number (2 bytes), value (8 bytes);
// with a length that this does not divide it is taken for the state itself.
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/run.h"
#include "model/fields/digest.h"
#include "model/model.h"
#include "scenario/scenario.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char scenario[] =
    "launchdyn: 1\nbase: {kind: fixed, elevation: 20 deg}\ntubes:\n  length: 3 m\n"
    "  sections: [{from: 0 m, inner_radius: 80 mm, outer_radius: 85 mm}]\n"
    "  material: {youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7850 kg/m3}\n"
    "  supports: [{at: 1 m, stiffness: 1e7 1e7 1e7 N/m,\n"
    "              rotational_stiffness: 1e6 1e6 1e6 N.m/rad}]\n"
    "  slot: none\nrocket:\n  mass: 60 kg\n  center: 1 0 0 m\n  inertia: 1 24 24 kg.m2\n"
    "  empty: {mass: 40 kg, center: 1 0 0 m, inertia: 1 18 18 kg.m2}\n"
    "  adaptors: [{name: a, at: 0 m, clearance: 1 mm}, {name: b, at: 1.5 m, clearance: 1 mm}]\n"
    "  contact: {stiffness: 5e7 N/m, law: lankarani-nikravesh, restitution: 0.7}\n"
    "  lock: {release_force: 2000 N}\n"
    "  motor: {thrust: [[0 s, 0 N], [10 ms, 20 kN], [1 s, 20 kN]]}\n"
    "run: {lead_in: 10 ms, end: tip}\n";

static ld_model model;
static ld_simulation *simulation;
static unsigned char kept[1 << 16]; // a state amid the launch
static size_t kept_size;

static void must(int so)
{
    if (!so)
        abort();
}

static void make_once(void)
{
    ld_messages messages;
    ld_run *run;
    if (simulation)
        return;
    must(
        !scenario_read_text(scenario, sizeof scenario - 1, "fuzz", "", NULL, 0, &model, &messages));
    ld_messages_free(&messages);
    must(!ld_simulation_create(&model, &simulation, NULL));
    must(!ld_run_begin(simulation, NULL, &run, NULL));
    must(!ld_run_advance(run, 0.03, NULL));
    must(!ld_run_save(run, kept, sizeof kept, &kept_size, NULL));
    must(!ld_run_end(run, NULL, NULL));
    must(!ld_run_load(simulation, NULL, kept, kept_size, &run, NULL));
    must(!ld_run_end(run, NULL, NULL));
}

static ld_status count_row(void *self, const double *values, size_t count, ld_error *error)
{
    (void)values, (void)count;
    return ++*(int *)self < 1000 ? LD_OK : ld_fail(error, LD_ERR_FILE, "rows enough");
}

static ld_status begin_rows(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)self, (void)columns, (void)count, (void)error;
    return LD_OK;
}

// Some milliseconds of a run, if it is one.
static void go_on(const unsigned char *bytes, size_t size)
{
    int rows = 0;
    ld_sink sink = {.self = &rows, .begin = begin_rows, .row = count_row};
    ld_run_options options = {.sink = &sink};
    ld_run *run;
    ld_error error = {0};
    ld_status status = ld_run_load(simulation, &options, bytes, size, &run, &error);
    must(!status == !error.text[0] && !status == (run != NULL));
    if (status)
        return;
    double t = ld_run_time(run), value;
    unsigned char again[sizeof kept];
    must(!ld_run_save(run, again, sizeof again, &size, NULL));
    ld_run_number(run, "tip.y", &value, NULL);
    for (int k = 1; k <= 4 && !status; k++)
        status = ld_run_advance(run, t + 1e-3 * k, &error);
    if (!status)
        ld_run_ignite(run, ld_run_time(run), NULL);
    ld_run_end(run, NULL, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { WORD = 8, CHANGE = 2 + WORD };
    static unsigned char bytes[sizeof kept];
    make_once();
    if (size % CHANGE) {
        go_on(data, size);
        return 0;
    }
    memcpy(bytes, kept, kept_size);
    for (; size; size -= CHANGE, data += CHANGE) {
        size_t number = (size_t)(data[0] | data[1] << 8) % (kept_size / WORD);
        memcpy(bytes + number * WORD, data + 2, WORD);
    }
    uint64_t sum = digest_bytes(DIGEST_BEGIN, bytes, kept_size - WORD);
    for (size_t i = 0; i < WORD; i++)
        bytes[kept_size - WORD + i] = (unsigned char)(sum >> 8 * i);
    go_on(bytes, kept_size);
    return 0;
}
