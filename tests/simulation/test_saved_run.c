// A run that is saved and loaded continues with the bits of one that was not interrupted: rows and
// summary, at 1773 instants, among them 1 ns before and after each event; in another process too.
// What is not its state is refused.
// ctest: slow
#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "launchdyn/run.h"
#include "model/model.h"
#include "quantities/summary.h"
#include "scenario/scenario.h"
#include "support/check.h"

enum { MOST_SETS = 8, MOST_BYTES = 1 << 17, SPREAD = 120, MOST_INSTANTS = 300 };

#define MEASURES                                                                                   \
    "measures=[{name: lit, of: tip.pitch, take: value, at: t_ignition}, "                          \
    "{name: in, of: contact.rear.force, take: rms, from: t_ignition, to: t_rear}, "                \
    "{name: all, of: tip.inertial_vy, take: mean, from: start, to: end}, "                         \
    "{name: most, of: tip.pitch_rate, take: peak, from: t_front, to: t_rear}, "                    \
    "{name: both, expression: \"rms(hypot(tip.y, tip.z)) + (tip.y at t_front) - least(tip.z)\"}]"

static const struct saved_case {
    const char *name, *example, *sets[MOST_SETS];
    double ignite; // [s] an input: when it is ignited in place of its firing time; 0: none
} cases[] = {
    {"fixed", "fixed.yaml", {"run.output_step.tube=0.5 ms"}, 0},
    {"ship",
     "ship.yaml",
     {"run.lead_in=50 ms", "run.output_step.tube=0.5 ms", "rocket.lock.hold_down=20 ms"},
     0},
    {"marching",
     "marching/30-kmh.yaml",
     {"run.lead_in=50 ms", "run.output_step.tube=0.5 ms",
      "platform.elevation.stabiliser={sample: 0.7 ms, delay: 0.3 ms, sensor_noise: {rate: 1 "
      "mrad/s}, "
      "bandwidth: 30 Hz}"},
     0},
    {"long steps",
     "marching/30-kmh.yaml",
     {"run={lead_in: 60 ms, lead_in_method: exponential, output_step: {lead_in: 1.7 ms, tube: 0.5 "
      "ms}}"},
     0},
    {"apart",
     "marching/15-kmh.yaml",
     {"run={lead_in: 50 ms, coupling: {step: 0.5 ms}, output_step: {tube: 0.5 ms}}",
      "run.formulation=overall",
      "platform.azimuth.stabiliser={sample: 1 ms, delay: 1 ms, gear: {stiffness: 5e7 N.m/rad, "
      "damping: 2e4 N.m.s/rad, inertia: 100 kg.m2, backlash: 0.3 mrad}}",
      "platform.elevation.lock={stiffness: 5e7 N.m/rad, damping: 1e4 N.m.s/rad}"},
     0},
    {"touching",
     "ship.yaml",
     {"rocket.contact={stiffness: 5e7 N/m, law: lankarani-nikravesh, restitution: 0.6}",
      "rocket.lock=none", "run.lead_in=50 ms", "run.output_step.tube=0.5 ms", MEASURES},
     0.01},
    {"shoes",
     "ship.yaml",
     {"tubes.slot=none",
      "tubes.guide={line: 120 0 mm, t_slot: {at: -80 0 mm, lips: 40 mm, gap: 2 mm, "
      "side_gap: 1 mm}}",
      "rocket.contact={stiffness: 2e6 N/m, law: lankarani-nikravesh, restitution: 0.1}",
      "rocket.adaptors=[{name: rear, at: 0 m}, {name: front, at: 1.9 m}]",
      "run.output_step.tube=0.5 ms"},
     0},
    {"ideal",
     "marching/15-kmh.yaml",
     {"run={lead_in: 20 ms, coupling: {step: 0.5 ms}, output_step: {tube: 0.5 ms}}",
      "rocket.contact={law: ideal, friction: 0}",
      "rocket.adaptors=[{name: rear, at: 0 m}, {name: front, at: 1.9 m}]"},
     0},
    {"clamped",
     "ship.yaml",
     {"tubes.supports=[{at: 0.4 m, clamped: all}, {at: 1.8 m, clamped: [y, z]}]",
      "rocket.contact={law: ideal, friction: 0}",
      "rocket.adaptors=[{name: rear, at: 0 m}, {name: front, at: 1.9 m}]",
      "tubes.loads=[{at: 0.2 m}, {at: 1 m}]", "tubes.modes.cut=900 Hz",
      "rocket.line={length: 90 m, mass_per_length: 30 g/m, diameter: 4 mm, stiffness: 20 kN, "
      "slack: 0.3 m, breaking_force: 250 N, container_on: launcher, container: -0.4 0 0 m}",
      "run={lead_in: 20 ms, output_step: {tube: 0.5 ms}}"},
     0},
    {"pressure",
     "spin-rig.yaml",
     {"run={end: 60 ms, lead_in: 5 ms, output_step: {tube: 0.5 ms}}", "tubes.modes.cut=3 kHz"},
     0},
    {"multibody", "../tests/data/multibody/launcher.yaml", {"run.output_step.tube=0.5 ms"}, 0},
    {"sequence",
     "marching/30-kmh.yaml",
     {"firing=[{tube: 8, at: 0 s}, {tube: 9, at: 0.45 s}]", "run.lead_in=20 ms",
      "run.output_step.tube=0.5 ms", "rocket.lock=none",
      "rocket.aerodynamics.emerged={nose: 2.4 m, drag: 1.2}",
      "platform.jet=[[0 m, 3 kN], [30 m, 0 kN]]", "tubes.jet=[[0 m, 1 kN], [20 m, 0 kN]]",
      MEASURES},
     0},
};
enum { CASES = sizeof cases / sizeof *cases };

// ---- a case

typedef struct setting {
    ld_model model;
    ld_simulation *simulation;
} setting;

static void set_up(const struct saved_case *of, setting *out)
{
    char path[512];
    ld_error error;
    ld_messages messages;
    size_t count = 0;
    while (count < MOST_SETS && of->sets[count])
        count++;
    snprintf(path, sizeof path, "%s/examples/%s", LD_SOURCE_DIR, of->example);
    if (scenario_read(path, of->sets, count, &out->model, &messages)) {
        ld_messages_print(&messages, stderr);
        fail_msg("%s", path);
    }
    if (ld_simulation_create(&out->model, &out->simulation, &error))
        fail_msg("%s", error.text);
}

static void tear_down(setting *of)
{
    ld_simulation_free(of->simulation);
    model_clear(&of->model);
}

// ---- rows: kept, or held against those that were kept

typedef struct kept_rows {
    double *values;
    size_t columns, count, capacity;
} kept_rows;

static ld_status begin_rows(void *user, const ld_column *columns, size_t count, ld_error *error)
{
    (void)columns, (void)error;
    ((kept_rows *)user)->columns = count;
    return LD_OK;
}

static ld_status keep_row(void *user, const double *values, size_t count, ld_error *error)
{
    (void)error;
    kept_rows *self = user;
    if (self->count == self->capacity) {
        self->capacity = 2 * self->capacity + 256;
        self->values = realloc(self->values, self->capacity * count * sizeof(double));
        assert_non_null(self->values);
    }
    memcpy(self->values + self->count++ * count, values, count * sizeof(double));
    return LD_OK;
}

typedef struct comparison {
    const kept_rows *expected;
    size_t next, wrong;
} comparison;

static ld_status begin_comparison(void *user, const ld_column *columns, size_t count,
                                  ld_error *error)
{
    (void)columns, (void)error;
    assert_int_equal(count, ((comparison *)user)->expected->columns);
    return LD_OK;
}

static ld_status compare_row(void *user, const double *values, size_t count, ld_error *error)
{
    (void)error;
    comparison *self = user;
    const kept_rows *expected = self->expected;
    size_t size = count * sizeof(double);
    self->wrong += self->next >= expected->count ||
                   memcmp(values, expected->values + self->next * count, size) != 0;
    self->next++;
    return LD_OK;
}

// ---- the run that is not interrupted

typedef struct instant {
    double t;
    unsigned char bytes[MOST_BYTES];
    size_t size, rows; // rows until then
    double row[1024];  // there
} instant;

typedef struct course {
    const struct saved_case *of;
    setting setting;
    kept_rows rows;
    ld_summary summary;
    int events, instants;
    instant *at;
} course;

// What two processes, or two runs, need not agree on.
static void leave_out(ld_summary *summary)
{
    summary->model = NULL;
    summary->statistics.cpu_seconds = summary->statistics.cpu_seconds_setup = 0;
}

static ld_run *begin(const course *self, const ld_run_options *options)
{
    ld_run *run;
    ld_error error;
    if (ld_run_begin(self->setting.simulation, options, &run, &error) ||
        (self->of->ignite > 0 && ld_run_ignite(run, self->of->ignite, &error)))
        fail_msg("%s", error.text);
    return run;
}

// To its end, event by event: their instants, and 1 ns before and after each.
static void run_through(course *self)
{
    ld_sink sink = {.self = &self->rows, .begin = begin_rows, .row = keep_row};
    ld_run_options options = {.sink = &sink};
    ld_run *run = begin(self, &options);
    ld_error error;
    ld_event event;
    double start = ld_run_time(run);
    do {
        if (ld_run_advance_to_event(run, INFINITY, &event, &error))
            fail_msg("%s", error.text);
        self->events++;
        for (int k = -1; k <= 1; k++)
            if (event.kind != LD_EVENT_END || k < 0)
                self->at[self->instants++].t = fmax(start, event.t + 1e-9 * k);
        assert_true(self->instants < MOST_INSTANTS - SPREAD);
    } while (event.kind != LD_EVENT_END);
    for (int k = 0; k < SPREAD; k++) {
        double share = fmod((k + 0.5) * 0.6180339887498949, 1);
        self->at[self->instants++].t = start + share * (event.t - start);
    }
    ld_run_end(run, &self->summary, &error);
    leave_out(&self->summary);
}

static int by_time(const void *a, const void *b)
{
    double x = ((const instant *)a)->t, y = ((const instant *)b)->t;
    return (x > y) - (x < y);
}

static size_t save(ld_run *run, unsigned char *bytes)
{
    size_t size = 0;
    ld_error error = {0};
    if (ld_run_save(run, bytes, MOST_BYTES, &size, &error))
        fail_msg("%s", error.text);
    return size;
}

static void end_like(const course *self, ld_run *run, const comparison *rows)
{
    static ld_summary summary;
    ld_error error;
    assert_int_equal(ld_run_advance(run, INFINITY, &error), LD_OK);
    assert_int_equal(ld_run_end(run, &summary, &error), LD_OK);
    leave_out(&summary);
    assert_memory_equal(&summary, &self->summary, sizeof summary);
    assert_int_equal(rows->next, self->rows.count);
    assert_int_equal(rows->wrong, 0);
}

// The same run once more, checked and saved at all the instants, which does not change it.
static void save_at_instants(course *self)
{
    comparison rows = {.expected = &self->rows};
    ld_sink sink = {.self = &rows, .begin = begin_comparison, .row = compare_row};
    ld_run_options options = {.sink = &sink};
    ld_run *run = begin(self, &options);
    ld_error error;
    qsort(self->at, (size_t)self->instants, sizeof *self->at, by_time);
    for (int i = 0; i < self->instants; i++) {
        instant *at = &self->at[i];
        if (ld_run_advance(run, at->t, &error) || ld_run_row(run, at->row, &error))
            fail_msg("%s", error.text);
        at->t = ld_run_time(run); // the end, where that comes before
        at->size = save(run, at->bytes);
        at->rows = rows.next;
    }
    end_like(self, run, &rows);
}

static void course_make(course *self, int number)
{
    memset(self, 0, sizeof *self);
    self->at = calloc(MOST_INSTANTS, sizeof *self->at);
    assert_non_null(self->at);
    self->of = &cases[number];
    set_up(self->of, &self->setting);
    run_through(self);
    save_at_instants(self);
}

static void course_free(course *self)
{
    tear_down(&self->setting);
    free(self->rows.values);
    free(self->at);
}

// ---- saved, loaded, continued with

static ld_run *load(const course *self, const instant *at, const ld_run_options *options)
{
    ld_run *run;
    ld_error error;
    if (ld_run_load(self->setting.simulation, options, at->bytes, at->size, &run, &error))
        fail_msg("%s", error.text);
    return run;
}

// From instant i to the next one, where it must look and be saved as the one that was not
// interrupted; or from there on to the end.
static void go_on(const course *self, int i, bool to_end)
{
    const instant *from = &self->at[i], *to = from + 1;
    static double row[1024];
    static unsigned char bytes[MOST_BYTES];
    size_t size = self->rows.columns * sizeof(double);
    comparison rows = {.expected = &self->rows, .next = from->rows};
    ld_sink sink = {.self = &rows, .begin = begin_comparison, .row = compare_row};
    ld_error error;
    ld_run *run = load(self, from, &(ld_run_options){.sink = &sink});
    assert_true(ld_run_time(run) == from->t);
    assert_int_equal(ld_run_row(run, row, &error), LD_OK);
    assert_memory_equal(row, from->row, size);
    assert_int_equal(save(run, bytes), from->size);
    assert_memory_equal(bytes, from->bytes, from->size);
    if (i + 1 < self->instants) {
        assert_int_equal(ld_run_advance(run, to->t, &error), LD_OK);
        assert_int_equal(ld_run_row(run, row, &error), LD_OK);
        assert_memory_equal(row, to->row, size);
        assert_int_equal(rows.next, to->rows);
        assert_int_equal(rows.wrong, 0);
        assert_int_equal(save(run, bytes), to->size);
        assert_memory_equal(bytes, to->bytes, to->size);
    }
    if (to_end)
        end_like(self, run, &rows);
    else
        ld_run_end(run, NULL, NULL);
}

// ---- in another process

static uint64_t hash(uint64_t so_far, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        so_far = (so_far ^ ((const unsigned char *)bytes)[i]) * UINT64_C(0x100000001b3);
    return so_far;
}

// The other process: loads what lies in the file, continues to the end, prints a hash of all that
// came.
static int other_process(int number, const char *path)
{
    static instant at;
    static ld_summary summary;
    kept_rows rows = {0};
    setting here;
    ld_run *run;
    ld_error error;
    FILE *file = fopen(path, "rb");
    at.size = file ? fread(at.bytes, 1, sizeof at.bytes, file) : 0;
    set_up(&cases[number], &here);
    ld_sink sink = {.self = &rows, .begin = begin_rows, .row = keep_row};
    ld_run_options options = {.sink = &sink};
    if (ld_run_load(here.simulation, &options, at.bytes, at.size, &run, &error) ||
        ld_run_advance(run, INFINITY, &error) || ld_run_end(run, &summary, &error))
        return 1;
    leave_out(&summary);
    uint64_t all = hash(0, rows.values, rows.count * rows.columns * sizeof(double));
    printf("%016llx\n", (unsigned long long)hash(all, &summary, sizeof summary));
    free(rows.values);
    tear_down(&here);
    return file ? fclose(file) : 1;
}

static uint64_t hash_of_other(int number, const instant *at)
{
    char path[] = "/tmp/launchdyn-state-XXXXXX", command[320], self[256] = "";
    int file = mkstemp(path);
    assert_true(file >= 0 && write(file, at->bytes, at->size) == (ssize_t)at->size);
    close(file);
    assert_true(readlink("/proc/self/exe", self, sizeof self - 1) > 0);
    snprintf(command, sizeof command, "'%s' %d %s", self, number, path);
    FILE *other = popen(command, "r");
    assert_non_null(other);
    unsigned long long found = 0;
    assert_int_equal(fscanf(other, "%llx", &found), 1);
    assert_int_equal(pclose(other), 0);
    unlink(path);
    return found;
}

static uint64_t hash_of_rest(const course *self, const instant *from)
{
    size_t row = self->rows.columns * sizeof(double);
    const char *rest = (const char *)self->rows.values + from->rows * row;
    uint64_t all = hash(0, rest, (self->rows.count - from->rows) * row);
    return hash(all, &self->summary, sizeof self->summary);
}

// LD_SAVED_RUNS=1: from all instants to the end, else from each to the next and from some to the
// end.
static void loaded_runs_go_on_to_the_bit(void **state)
{
    (void)state;
    int all = 0, every = getenv("LD_SAVED_RUNS") ? 1 : 40;
    size_t most = 0;
    for (int number = 0; number < CASES; number++) {
        course self;
        course_make(&self, number);
        for (int i = 0; i < self.instants; i++) {
            go_on(&self, i, i % every == number % every);
            most = self.at[i].size > most ? self.at[i].size : most;
        }
        const instant *away = &self.at[(number + 1) * self.instants / (CASES + 1)];
        assert_true(hash_of_other(number, away) == hash_of_rest(&self, away));
        printf("    %-10s %d events, %d instants, %zu rows\n", cases[number].name, self.events,
               self.instants, self.rows.count);
        all += self.instants;
        course_free(&self);
    }
    CHECK_WITHIN("instants at which runs were saved, loaded, gone on with", all, 1550, 1850);
    CHECK_WITHIN("bytes of a state", (double)most, 4000, 131072);
}

// ---- what is refused

static void refused(const course *self, const unsigned char *bytes, size_t size)
{
    ld_run *run;
    ld_error error = {0};
    assert_int_equal(ld_run_load(self->setting.simulation, NULL, bytes, size, &run, &error),
                     LD_ERR_INPUT);
    assert_null(run);
    assert_true(strlen(error.text) >= 20);
}

// Cut off anywhere, a bit turned anywhere, bytes taken out or added, another model's state.
static void what_is_no_state_is_refused(void **state)
{
    (void)state;
    static unsigned char bytes[MOST_BYTES + 8];
    course self, other;
    course_make(&self, 0);
    course_make(&other, 4);
    const instant *at = &self.at[self.instants / 2];
    memcpy(bytes, at->bytes, at->size);
    for (size_t size = 0; size < at->size; size++)
        refused(&self, bytes, size);
    for (size_t size = 1; size <= 8; size++)
        refused(&self, bytes, at->size + size);
    for (size_t i = 0; i < 8 * at->size; i += 13) {
        bytes[i / 8] ^= (unsigned char)(1 << i % 8);
        refused(&self, bytes, at->size);
        bytes[i / 8] ^= (unsigned char)(1 << i % 8);
    }
    refused(&self, other.at[3].bytes, other.at[3].size);
    memset(bytes, 0, sizeof bytes);
    refused(&self, bytes, at->size);
    course_free(&self);
    course_free(&other);
}

int main(int count, char **arguments)
{
    if (count == 3)
        return other_process(atoi(arguments[1]), arguments[2]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loaded_runs_go_on_to_the_bit),
        cmocka_unit_test(what_is_no_state_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
