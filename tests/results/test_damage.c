// A folder of results that is not as it was written: files that were flipped, cut, lengthened,
// taken away, exchanged. None of it is taken for whole, and nothing crashes. LD_DAMAGES cases (of
// scripts/prove) in place of a sample.
// link: -lsqlite3
#include "support/check.h"
#include "support/draw.h"
#include "support/scratch.h"

#include <sqlite3.h>
#include <stdbool.h>
#include <unistd.h>

#include "base/text_file.h"
#include "launchdyn/child.h"
#include "launchdyn/origin.h"
#include "launchdyn/output.h"
#include "launchdyn/report.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "launchdyn/summary.h"
#include "results/history.h"
#include "results/manifest.h"

// HDF5 itself loses memory on some damage.
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libhdf5\nleak:H5\n";
}

enum { FILES = 5, MOST = 1 << 24 };
static const char *const names[FILES] = {"history.h5", "summary.json", "history.csv", "flights.csv",
                                         "trajectories.kml"};

static int shell(const char *line)
{
    char command[1024];
    snprintf(command, sizeof command, "cd %s && { %s; }", folder, line);
    return system(command);
}

// Runs a small launch with a flight into a folder that has all five files.
static void make_run(const char *where, const char *mass)
{
    char key[64];
    snprintf(key, sizeof key, "rocket.mass=%s", mass);
    const char *const sets[] = {"run.end=landing", "environment.site.latitude=40 deg",
                                "run.output_step={tube: 2 ms, lead_in: 2 ms, flight: 1 s}", key};
    ld_model *model;
    ld_messages messages;
    ld_output *output;
    ld_simulation *simulation;
    ld_summary *summary = ld_summary_new();
    ld_error error = {.text = ""};
    if (ld_scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", sets, 4, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        fail();
    }
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_output_open(where, model, true, &output, &error) ||
        ld_simulation_run(simulation, &(ld_run_options){.sink = ld_output_sink(output)}, summary,
                          &error) ||
        ld_output_finish(output, summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    ld_summary_free(summary);
    ld_model_free(model);
}

static int make_runs(void **state)
{
    if (scratch_make(state))
        return -1;
    make_run(in("run"), "60 kg");
    make_run(in("other"), "61 kg");
    return 0;
}

// ---- readers of a folder, each in a process of its own

static int report(void *data)
{
    ld_error error;
    return (int)ld_report_write(data, in("report.html"), NULL, &error);
}

static int plot(void *data)
{
    const char *const from[] = {data};
    ld_picture picture = {.folder = from, .folder_count = 1, .from = NAN, .to = NAN};
    return (int)ld_plot(&picture, in("x.svg"), NULL);
}

static int read_origin(void *data)
{
    ld_origin origin;
    ld_status status = ld_origin_read(data, &origin, NULL);
    if (!status)
        ld_origin_free(&origin);
    return (int)status;
}

// The status that a reader of the folder "run" ends with.
static int look(int (*reader)(void *data))
{
    char where[128];
    ld_error error = {.text = ""};
    int code = -1;
    snprintf(where, sizeof where, "%s", in("run"));
    if (ld_child_run(reader, where, &code, &error))
        fail_msg("%s", error.text);
    return code;
}

// ---- files

typedef struct bytes {
    unsigned char *at;
    size_t count;
} bytes;

static bytes read_bytes(const char *path)
{
    char *text;
    bytes found;
    assert_int_equal(text_file_read(path, MOST, &text, &found.count, NULL), LD_OK);
    found.at = (unsigned char *)text;
    return found;
}

static void write_bytes(const char *path, const unsigned char *at, size_t count)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(at, 1, count, file), count);
    assert_int_equal(fclose(file), 0);
}

// A number from 0 to below `most`.
static size_t draw_below(uint64_t *random, size_t most)
{
    return (size_t)((draw(random) + 1) / 2 * (double)most) % most;
}

// Writes the file with one of its bits turned, cut, or with a byte more. Half of the turned bits
// are in the first 8 kB, where HDF5 keeps most of what it could stumble over.
static void damage(const char *path, bytes whole, uint64_t *random, char *what, size_t size)
{
    size_t kind = draw_below(random, 8), at = draw_below(random, whole.count);
    if (kind < 3 && whole.count > 8192)
        at %= 8192;
    if (kind == 7) {
        snprintf(what, size, "cut to %zu bytes", at);
        write_bytes(path, whole.at, at);
    } else if (kind == 6 && at % 8 == 0) {
        snprintf(what, size, "a byte more");
        write_bytes(path, whole.at, whole.count + 1); // the zero after its end
    } else {
        unsigned char flip = (unsigned char)(1u << draw_below(random, 8));
        snprintf(what, size, "byte %zu xor 0x%02x", at, flip);
        whole.at[at] ^= flip;
        write_bytes(path, whole.at, whole.count);
        whole.at[at] ^= flip;
    }
}

static void test_flips_and_cuts(void **state)
{
    (void)state;
    const char *wanted = getenv("LD_DAMAGES");
    int cases = wanted ? atoi(wanted) : 25;
    uint64_t random = 14;
    for (int file = 0; file < FILES; file++) {
        char path[128], name[32], what[64];
        snprintf(name, sizeof name, "run/%s", names[file]);
        snprintf(path, sizeof path, "%s", in(name));
        bytes whole = read_bytes(path);
        for (int i = 0; i < (cases + FILES - 1) / FILES; i++) {
            damage(path, whole, &random, what, sizeof what);
            if (look(report) != LD_ERR_INPUT)
                fail_msg("report: %s, %s", names[file], what);
            if (file < 2 && (look(plot) != LD_ERR_INPUT || look(read_origin) != LD_ERR_INPUT))
                fail_msg("plot or origin: %s, %s", names[file], what);
        }
        write_bytes(path, whole.at, whole.count);
        free(whole.at);
    }
    assert_int_equal(look(report), LD_OK);
    assert_int_equal(look(read_origin), LD_OK);
}

// ---- a history alone, without digests: its own checksums

static history_data intact;

static bool same_table(const history_data *one, const history_data *other)
{
    bool same = one->rows == other->rows && one->columns == other->columns;
    for (size_t i = 0; same && i < one->columns; i++)
        same = one->unit[i] && strcmp(one->name[i], other->name[i]) == 0 &&
               strcmp(one->unit[i], other->unit[i]) == 0;
    return same && (one->columns == 0 || memcmp(one->value, other->value,
                                                one->rows * one->columns * sizeof(double)) == 0);
}

// Exit codes that no sanitizer has.
enum { SAME = 10, REFUSED, DIFFERENT, CRASHED, ENDS };

static int read_alone(void *data)
{
    history_data found;
    if (history_read(data, &found, NULL))
        return REFUSED;
    bool same = same_table(&found, &intact) && found.flights == intact.flights &&
                found.arrays == intact.arrays && found.title &&
                strcmp(found.title, intact.title) == 0;
    for (size_t i = 0; same && i < found.flights; i++)
        same = same_table(&found.flight[i], &intact.flight[i]);
    for (size_t i = 0; same && i < found.arrays; i++)
        same = found.geometry[i].rows == intact.geometry[i].rows &&
               memcmp(found.geometry[i].value, intact.geometry[i].value,
                      found.geometry[i].rows * found.geometry[i].columns * sizeof(double)) == 0;
    history_free(&found);
    return same ? SAME : DIFFERENT;
}

static void test_a_history_alone(void **state)
{
    (void)state;
    const char *wanted = getenv("LD_DAMAGES");
    int cases = wanted ? atoi(wanted) / 5 : 40, count[ENDS] = {0};
    uint64_t random = 41;
    char path[128], what[64];
    snprintf(path, sizeof path, "%s", in("alone.h5"));
    bytes whole = read_bytes(in("run/history.h5"));
    write_bytes(path, whole.at, whole.count);
    assert_int_equal(history_read(path, &intact, NULL), LD_OK);
    // a bit of a value
    const double *value = history_column(&intact, "rocket.s") + 20;
    unsigned char *at = whole.at;
    while (memcmp(at, value, sizeof *value) != 0)
        assert_true(++at < whole.at + whole.count - sizeof *value);
    at[2] ^= 1;
    write_bytes(path, whole.at, whole.count);
    at[2] ^= 1;
    ld_error error;
    int code = CRASHED;
    assert_int_equal(ld_child_run(read_alone, path, &code, &error), LD_OK);
    assert_int_equal(code, REFUSED);
    for (int i = 0; i < cases; i++) {
        damage(path, whole, &random, what, sizeof what);
        if (ld_child_run(read_alone, path, &code, &error)) {
            assert_int_equal(error.status, LD_ERR_INPUT);
            code = CRASHED;
        }
        assert_in_range(code, SAME, CRASHED);
        count[code]++;
        if (code >= DIFFERENT)
            printf("    %s: %s\n", what, code == CRASHED ? "crashed" : "read with other values");
    }
    printf("    of %d: %d refused, %d read with the same values, %d with others, %d crashed\n",
           cases, count[REFUSED], count[SAME], count[DIFFERENT], count[CRASHED]);
    if (!wanted)
        assert_int_equal(count[DIFFERENT], 0);
    history_free(&intact);
    free(whole.at);
}

// The bit that led HDF5 into a heap of texts that was none: byte 4125 of a run's history.
static void test_byte_4125(void **state)
{
    (void)state;
    char path[128];
    ld_error error;
    int code = CRASHED;
    snprintf(path, sizeof path, "%s", in("run/history.h5"));
    bytes whole = read_bytes(path);
    assert_int_equal(history_read(path, &intact, NULL), LD_OK);
    whole.at[4125] ^= 0x40;
    write_bytes(path, whole.at, whole.count);
    assert_int_equal(look(report), LD_ERR_INPUT);
    assert_int_equal(look(plot), LD_ERR_INPUT);
    assert_int_equal(look(read_origin), LD_ERR_INPUT);
    if (ld_child_run(read_alone, path, &code, &error))
        fail_msg("%s", error.text);
    assert_in_range(code, SAME, REFUSED);
    whole.at[4125] ^= 0x40;
    write_bytes(path, whole.at, whole.count);
    history_free(&intact);
    free(whole.at);
}

// ---- what is said

static void expect_report(const char *line, ld_status status, const char *text, const char *note)
{
    ld_report made;
    ld_error error = {.text = ""};
    assert_int_equal(shell("rm -rf kept && cp -r run kept"), 0);
    assert_int_equal(shell(line), 0);
    ld_status found = ld_report_write(in("run"), in("report.html"), &made, &error);
    if (found != status || !strstr(error.text, text))
        fail_msg("%s: %d, %s", line, found, error.text);
    bool noted = false;
    for (int i = 0; i < made.note_count; i++)
        noted |= strstr(made.note[i], note) != NULL;
    if (!noted)
        fail_msg("%s: %d notes, \"%s\"", line, made.note_count, made.note[0]);
    // the page says so, too, and shows the rest
    char command[256];
    snprintf(command, sizeof command, "grep -qF '%s' report.html", note);
    if (made.bytes > 0)
        assert_int_equal(shell(command), 0);
    assert_int_equal(shell("rm -rf run && mv kept run"), 0);
}

static void test_what_is_said(void **state)
{
    (void)state;
    static const char *const report_broken[] = {"{", "", "[]", "null", "{}"};
    for (int i = 0; i < 5; i++) {
        char line[64];
        snprintf(line, sizeof line, "printf '%s' >run/summary.json", report_broken[i]);
        expect_report(line, LD_ERR_INPUT, "run is damaged: summary.json is damaged: ",
                      "No summary: summary.json is damaged: ");
    }
    expect_report("rm run/history.csv", LD_ERR_INPUT, "history.csv is missing; the report shows",
                  "history.csv is missing.");
    expect_report("rm run/history.h5", LD_ERR_INPUT, "history.h5 is missing; the report shows",
                  "No plots: history.h5 is missing.");
    expect_report("truncate -s 70000 run/history.h5", LD_ERR_INPUT,
                  "history.h5 is damaged: it has 70000 bytes, and had ",
                  "No plots: history.h5 is damaged: it has 70000 bytes");
    expect_report("cp other/history.h5 run", LD_ERR_INPUT, "history.h5 is damaged, or of another",
                  "history.h5 is damaged, or of another run: its digest is not that in summary");
    expect_report("cp other/summary.json run", LD_ERR_INPUT, "history.h5 is damaged",
                  "trajectories.kml is damaged");
    expect_report("sed -i 's/\"tube\": 8/\"tube\": 7/' run/summary.json", LD_ERR_INPUT,
                  "summary.json is damaged: its text does not match the digest in its last line",
                  "No summary");
    expect_report("rm run/*", LD_ERR_INPUT, "no results in ", "There is no history.h5");
    // what is beside it is not checked
    expect_report("rm run/summary.json; touch run/my.txt", LD_OK, "",
                  "No summary: summary.json is missing");
}

// A summary of a version without digests: its members are checked, no more.
#define EARLIER                                                                                    \
    "jq 'del(.format, .files, .digest)' run/summary.json >earlier && mv earlier run/summary.json"

static void test_earlier_version(void **state)
{
    (void)state;
    expect_report(EARLIER, LD_OK, "",
                  "The files cannot be verified: summary.json is of an earlier");
    expect_report(EARLIER " && sed -i 's/\"exit_speed\": [0-9]/\"exit_speed\": \"/; "
                          "s/\\(\"exit_speed\": \"[^,]*\\),/\\1\",/' run/summary.json",
                  LD_ERR_INPUT, "\"rockets[0].exit_speed\" is not a number", "No summary");
    expect_report(EARLIER " && jq 'del(.rockets)' run/summary.json >x && mv x run/summary.json",
                  LD_ERR_INPUT, "\"rockets\" is missing, or something else", "No summary");
    expect_report(EARLIER " && printf 'x' >>run/summary.json", LD_ERR_INPUT, "malformed JSON",
                  "No summary");
    expect_report(EARLIER " && printf '\\0' >>run/summary.json", LD_ERR_INPUT, "it is not text",
                  "No summary");
    // no digest is kept of the history, which HDF5 then refuses
    expect_report(EARLIER " && truncate -s 70000 run/history.h5", LD_ERR_INPUT,
                  "/run/history.h5: truncated file", "No plots: cannot read ");
}

// A summary under a digest that holds, written by hand.
static void seal_summary(const char *text)
{
    FILE *file = fopen(in("sealed.json"), "w");
    assert_non_null(file);
    manifest_seal(file, text, strlen(text));
    assert_int_equal(fclose(file), 0);
}

static void test_other_formats(void **state)
{
    (void)state;
    static const struct {
        const char *format, *text;
    } formats[] = {{"\"2\"", "summary.json is damaged: \"format\" is not a whole number"},
                   {"2.5", "summary.json is damaged: \"format\" is not a whole number"},
                   {"99", "summary.json is damaged: it is of format 99, and this program reads 2"}};
    for (int i = 0; i < 3; i++) {
        char text[256];
        snprintf(text, sizeof text,
                 "{\n  \"format\": %s,\n  \"title\": \"x\", \"version\": \"0.1\", "
                 "\"complete\": true, \"t_end\": 1, \"rockets\": [],\n",
                 formats[i].format);
        seal_summary(text);
        expect_report("cp sealed.json run/summary.json", LD_ERR_INPUT, formats[i].text,
                      "No summary");
    }
}

// What a killed run left goes to no other one.
static void test_parts_of_a_killed_run(void **state)
{
    (void)state;
    assert_int_equal(shell("mkdir again && echo old | tee again/history.csv.part "
                           "again/flights.csv.part again/trajectories.kml.part >/dev/null"),
                     0);
    ld_model *model;
    ld_output *output;
    ld_summary *summary = ld_summary_new();
    ld_messages messages;
    ld_error error;
    assert_int_equal(
        ld_scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", NULL, 0, &model, &messages), LD_OK);
    assert_int_equal(ld_output_open(in("again"), model, false, &output, &error), LD_OK);
    assert_int_equal(ld_output_finish(output, summary, &error), LD_OK);
    ld_summary_free(summary);
    ld_model_free(model);
    assert_int_equal(shell("[ \"$(echo $(ls again))\" = 'history.h5 summary.json' ]"), 0);
}

// Where its reader of JSON gets no memory, a whole summary is not said to be damaged.
static void test_little_memory(void **state)
{
    (void)state;
    enum { STEP = 500, MOST_STEPS = 4000 };
    int want = 0, read = 0;
    manifest found;
    ld_error error;
    for (int i = 1; i < MOST_STEPS && !read; i++) {
        sqlite3_hard_heap_limit64(sqlite3_memory_used() + (sqlite3_int64)STEP * i);
        ld_status status = manifest_read(in("run"), &found, &error);
        if (status != LD_ERR_MEMORY && (status || found.state != MANIFEST_WHOLE))
            fail_msg("%d bytes: %d, \"%s\"", STEP * i, status, found.problem);
        want += status == LD_ERR_MEMORY;
        read += status == LD_OK;
        manifest_free(&found);
    }
    sqlite3_hard_heap_limit64(0);
    printf("    %d bytes are enough\n", STEP * (want + 1));
    assert_true(want > 50 && read == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flips_and_cuts),        cmocka_unit_test(test_a_history_alone),
        cmocka_unit_test(test_what_is_said),          cmocka_unit_test(test_earlier_version),
        cmocka_unit_test(test_other_formats),         cmocka_unit_test(test_byte_4125),
        cmocka_unit_test(test_parts_of_a_killed_run), cmocka_unit_test(test_little_memory),
    };
    return cmocka_run_group_tests(tests, make_runs, scratch_remove);
}
