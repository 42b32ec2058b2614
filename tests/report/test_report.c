// The report of a run: its numbers are those of the results, its size is bounded, what it leaves
// out would not be seen, no text of a scenario becomes part of its code.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>
#include <time.h>
#include <unistd.h>
#include <zlib.h>

#include "report/report_parts.h"
#include "support/example_run.h"
#include "support/made_launch.h"
#include "support/scratch.h"

// Results of a made-up run in the folder; `name` of the third adaptor and title as they are given.
static void make_results(size_t rows, const char *title, const char *name)
{
    static ld_model model;
    static ld_summary summary;
    static char kept[128];
    ld_output *output = NULL;
    made_model(&model);
    made_summary(&summary, 1);
    snprintf(kept, sizeof kept, "%s", title);
    model.title = kept;
    snprintf(model.rocket.adaptor[2].name, LD_MAX_NAME, "%s", name);
    assert_int_equal(ld_output_open(folder, &model, false, &output, NULL), LD_OK);
    assert_int_equal(made_run(ld_output_sink(output), rows, NULL), LD_OK);
    assert_int_equal(ld_output_finish(output, &summary, NULL), LD_OK);
}

static char *read_all(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char *text = calloc(1, 4 << 20);
    assert_in_range(fread(text, 1, (4 << 20) - 1, file), 1, REPORT_BYTES);
    fclose(file);
    return text;
}

static char *write_report(ld_report *report)
{
    ld_error error = {0};
    if (ld_report_write(folder, NULL, report, &error))
        fail_msg("%s", error.text);
    return read_all(in("report.html"));
}

// ---- reading a table back ----

static size_t decode(const char *text, unsigned char *bytes)
{
    static const char letters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t count = 0;
    unsigned bits = 0, held = 0;
    for (text++; *text != '"' && *text != '='; text++) {
        bits = bits << 6 | (unsigned)(strchr(letters, *text) - letters);
        held += 6;
        if (held >= 8)
            bytes[count++] = (unsigned char)(bits >> (held -= 8));
    }
    return count;
}

// ---- bytes of a segment: counts of seven bits a byte, numbers as folded second differences ----

static size_t next_count(const unsigned char **bytes)
{
    size_t value = 0;
    for (int shift = 0;; shift += 7) {
        unsigned char byte = *(*bytes)++;
        value |= (size_t)(byte & 127) << shift;
        if (!(byte & 128))
            return value;
    }
}

static void next_sums(const unsigned char **bytes, size_t count, long long sum, long long *sums)
{
    for (size_t i = 0; i < count; i++)
        sums[i] = sum += (long long)next_count(bytes);
}

// The offset and then the numbers: double and single precision, the lowest byte first as the
// machines have it that run these tests.
static void next_floats(const unsigned char **bytes, size_t count, double *value)
{
    double offset;
    memcpy(&offset, *bytes, sizeof offset);
    *bytes += sizeof offset;
    uint32_t ordered[2] = {0, 0};
    for (size_t i = 0; i < count; i++) {
        uint32_t folded = 0;
        for (size_t k = 4; k-- > 0;)
            folded = folded << 8 | (*bytes)[k * count + i];
        uint32_t difference = folded & 1 ? ~(folded >> 1) : folded >> 1;
        uint32_t now = difference + 2 * ordered[0] - ordered[1];
        ordered[1] = ordered[0];
        ordered[0] = now;
        uint32_t bits = now >> 31 ? now & 0x7fffffff : ~now;
        float single;
        memcpy(&single, &bits, sizeof bits);
        value[i] = offset + single;
    }
    *bytes += 4 * count;
}

static int index_of_column(const char *json, const char *name)
{
    char wanted[80];
    int index = 0;
    snprintf(wanted, sizeof wanted, "[\"%s\",", name);
    const char *list = strstr(json, "\"columns\":[["), *place = strstr(list, wanted);
    assert_non_null(place);
    for (list += 11; (list = strchr(list, '[')) != NULL && list < place; list++)
        index++;
    return index;
}

// The bytes of a segment, to be freed; `count`: how many rows it keeps.
static unsigned char *read_segment(const char *json, const char *part, size_t *count)
{
    char key[32];
    snprintf(key, sizeof key, "{\"name\":\"%s\"", part);
    const char *text = strstr(json, key);
    assert_non_null(text);
    *count = strtoull(strstr(text, "\"count\":") + 8, NULL, 10);
    uLongf length = 64 << 20;
    unsigned char *packed = malloc(4 << 20), *bytes = malloc(length);
    size_t packed_length = decode(strstr(text, "\"data\":") + 7, packed);
    assert_int_equal(uncompress(bytes, &length, packed, packed_length), Z_OK);
    free(packed);
    return bytes;
}

// A column of one segment: times from its first row and values. Returns how many rows it keeps.
static size_t read_column(const char *json, const char *part, const char *name, double *t,
                          double *value)
{
    static long long at[1 << 18], row[1 << 18];
    size_t count, kept = 0;
    unsigned char *bytes = read_segment(json, part, &count);
    const unsigned char *next = bytes;
    next_sums(&next, count, 0, at);
    for (int column = index_of_column(json, name); column >= 0; column--) {
        kept = next_count(&next);
        if (kept < count)
            next_sums(&next, kept, -1, row);
        next_floats(&next, kept, value);
    }
    for (size_t i = 0; i < kept; i++)
        t[i] = (double)at[kept < count ? (size_t)row[i] : i] * 1e-9;
    free(bytes);
    return kept;
}

static double times[1 << 18];
static double values[1 << 18];

// ---- tests ----

static void test_numbers_are_those_of_the_results(void **state)
{
    (void)state;
    ld_report report;
    make_results(1605, "Made up", "front");
    char *page = write_report(&report);
    static const struct {
        const char *name;
        int column;
    } checked[] = {{"tip.y", 33}, {"tip.yaw", 36}, {"rocket.s", 41}};
    for (int c = 0; c < 3; c++) {
        double row[MADE_COLUMNS], worst = 0, worst_t = 0;
        size_t count = read_column(page, "tube", checked[c].name, times, values);
        assert_int_equal(count, 1605);
        for (size_t i = 0; i < count; i++) {
            made_row(i, row);
            double expected = (float)row[checked[c].column];
            worst = fmax(worst, isnan(expected) ? !isnan(values[i]) : fabs(values[i] - expected));
            worst_t = fmax(worst_t, fabs(times[i] - row[0]));
        }
        printf("    %s\n", checked[c].name);
        CHECK_BELOW("value less that of the results, in single precision", worst, 0);
        CHECK_BELOW("time less that of the results [s]", worst_t, 0.51e-9);
    }
    CHECK_WITHIN("pixels that a curve may be moved by", report.pixels, 0, 0);
    CHECK_WITHIN("bytes of the page", (double)strlen(page), (double)report.bytes,
                 (double)report.bytes);
    assert_int_equal(report.note_count, 0);
    assert_non_null(strstr(page, "\"exit_speed\":37.700000000000003"));
    assert_non_null(strstr(page, "\"release\":0.0033335999999999999"));
    free(page);
}

static int count_of(const char *text, const char *part)
{
    int count = 0;
    for (; (text = strstr(text, part)) != NULL; text++)
        count++;
    return count;
}

// Neither a title nor a name ends the text that it stands in, or begins a tag.
static void test_no_text_becomes_code(void **state)
{
    (void)state;
    make_results(10,
                 "</title></script><script>alert(1)</script><!-- & \" <img src=x onerror=alert(2)>",
                 "</script><svg onload=alert(3)>");
    char *page = write_report(NULL);
    CHECK_WITHIN("script tags: summary, data, origin, code", count_of(page, "<script"), 4, 4);
    CHECK_WITHIN("ends of script tags", count_of(page, "</script"), 4, 4);
    CHECK_WITHIN("tags from the title and the name",
                 count_of(page, "<img") + count_of(page, "<svg") + count_of(page, "<!--"), 0, 0);
    assert_non_null(strstr(page, "<title>&lt;/title&gt;&lt;/script&gt;&lt;script&gt;alert(1)"));
    assert_non_null(strstr(page, "\\u003csvg onload=alert(3)>"));
    assert_non_null(strstr(page, "content=\"default-src 'none'; script-src 'sha256-"));
    assert_non_null(strstr(page, "; style-src 'sha256-"));
    assert_non_null(strstr(page, "; base-uri 'none'; form-action 'none'\">"));
    assert_null(strstr(page, "'unsafe-"));
    free(page);
}

// Largest distance of a function from the kept rows of a segment, as a share of its span 2.
static double farthest(size_t count, double (*function)(double t), double from, double step,
                       size_t rows)
{
    double worst = 0;
    for (size_t i = 0, k = 0; i < rows; i++) {
        double t = (double)i * step, y = function(from + t);
        while (k + 2 < count && t > times[k + 1] + 1e-9)
            k++;
        double share = (t - times[k]) / (times[k + 1] - times[k]);
        worst = fmax(worst, fabs(values[k] + share * (values[k + 1] - values[k]) - y));
    }
    return worst / 2;
}

static double wave(double t)
{
    return sin(10 * t);
}

// A peak one row wide in the lead-in, on a wave.
static double with_peak(double t)
{
    return fabs(t - 1.234) < 1e-6 ? 1 : 0.25 * sin(3 * t) - 0.75;
}

// 5 s of lead-in and 60 s after the tube at 1 ms, 0.2 s in the tube at 0.1 ms.
static void test_thinning(void **state)
{
    (void)state;
    enum { BEFORE = 5000, TUBE = 2000, AFTER = 60000, ROWS = BEFORE + TUBE + AFTER };
    char *name[] = {"t", "phase", "tip.y", "tip.z"}, *unit[] = {"s", "1", "m", "m"};
    double *value = malloc(sizeof *value * 4 * ROWS);
    for (int i = 0; i < ROWS; i++) {
        int part = i < BEFORE ? 0 : i < BEFORE + TUBE ? 2 : 3;
        double t = part == 0   ? 1e-3 * i
                   : part == 2 ? 5 + 1e-4 * (i - BEFORE)
                               : 5.2 + 1e-3 * (i - BEFORE - TUBE);
        value[i] = t;
        value[ROWS + i] = part;
        value[2 * ROWS + i] = wave(t);
        value[3 * ROWS + i] = with_peak(t);
    }
    history_data history = {.rows = ROWS, .columns = 4, .name = name, .unit = unit, .value = value};
    char *json = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&json, &length);
    report_detail detail = {.whole_tube = true, .pixel = 1.0 / 4000};
    assert_int_equal(report_write_table(stream, &history, 0, &detail, NULL), LD_OK);
    fclose(stream);

    const double pixel = 1.0 / 4000 + 1e-7; // single precision beside it
    size_t count = read_column(json, "before", "tip.y", times, values);
    CHECK_BELOW("lead-in: wave off by, share of its span", farthest(count, wave, 0, 1e-3, BEFORE),
                pixel);
    CHECK_WITHIN("lead-in: rows kept of 5000", (double)count, 550, 750);
    count = read_column(json, "before", "tip.z", times, values);
    CHECK_BELOW("lead-in: peak off by, share of the span",
                farthest(count, with_peak, 0, 1e-3, BEFORE), pixel);
    CHECK_WITHIN("lead-in: rows kept of 5000", (double)count, 50, 200);
    CHECK_WITHIN("tube: rows kept of 2000",
                 (double)read_column(json, "tube", "tip.y", times, values), TUBE, TUBE);
    count = read_column(json, "after", "tip.y", times, values);
    CHECK_BELOW("after: wave off by, share of its span", farthest(count, wave, 5.2, 1e-3, AFTER),
                pixel);
    free(json);
    free(value);
}

// Numbers without pattern between -1 and 1.
static double noise(void)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005 + 1442695040888963407;
    return (double)(state >> 40) / (1 << 23) - 1;
}

// Ten seconds at 0.1 ms of 112 columns, with noise that does not pack: too many rows, so curves
// keep those that are seen.
static void test_size_is_bounded(void **state)
{
    (void)state;
    history_hdf5 *history;
    ld_report report;
    double row[MADE_COLUMNS];
    assert_int_equal(history_hdf5_create(in("history.h5"), "Long", &history, NULL), LD_OK);
    assert_int_equal(history_hdf5_begin(history, made_columns(), MADE_COLUMNS, NULL), LD_OK);
    for (size_t i = 0; i < 100000; i++) {
        made_row(i, row);
        for (int c = 2; c < MADE_COLUMNS; c++)
            row[c] *= 1 + 1e-4 * noise();
        assert_int_equal(history_hdf5_row(history, row, NULL), LD_OK);
    }
    assert_int_equal(history_hdf5_close(history, NULL, NULL), LD_OK);
    clock_t before = clock();
    free(write_report(&report));
    printf("    CPU time of a report of 100 000 rows: %.2f s\n",
           (double)(clock() - before) / CLOCKS_PER_SEC);
    CHECK_WITHIN("bytes", (double)report.bytes, 500e3, 2e6);
    CHECK_WITHIN("pixels of 4000", report.pixels, 1, 4);
}

// ---- the reference launcher: 5 s on the road, then a flight of more than 60 s ----

// Largest distance of a column of the results from what the report keeps of it in one phase, in
// pixels of 4000 over the column's span there.
static double pixels_off(const history_data *history, const char *json, const char *part,
                         const char *name, size_t first, size_t rows)
{
    const double *t = history_column(history, "t") + first;
    const double *y = history_column(history, name) + first;
    double low = INFINITY, high = -INFINITY, worst = 0;
    for (size_t i = 0; i < rows; i++) {
        low = fmin(low, y[i]);
        high = fmax(high, y[i]);
    }
    size_t count = read_column(json, part, name, times, values);
    for (size_t i = 0, k = 0; i < rows && high > low; i++) {
        while (k + 2 < count && t[i] - t[0] > times[k + 1] + 1e-9)
            k++;
        double share = fmin(1, (t[i] - t[0] - times[k]) / (times[k + 1] - times[k]));
        if (isfinite(y[i]))
            worst = fmax(worst, fabs(values[k] + share * (values[k + 1] - values[k]) - y[i]));
    }
    return high > low ? worst / (high - low) * 4000 : 0;
}

static void check_part(const history_data *history, const char *json, const char *part,
                       size_t first, size_t rows)
{
    char what[64];
    double worst = 0;
    int shown = 0;
    for (size_t c = 0; c < history->columns; c++) {
        char key[80];
        snprintf(key, sizeof key, "[\"%s\",", history->name[c]);
        if (!strstr(json, key) || strcmp(history->name[c], "t") == 0)
            continue;
        shown++;
        double off = pixels_off(history, json, part, history->name[c], first, rows);
        worst = fmax(worst, off);
    }
    snprintf(what, sizeof what, "%s: largest of %d curves, pixels of 4000", part, shown);
    CHECK_BELOW(what, worst, 1.01); // a hundredth for single precision
}

static char *table_of(const history_data *history, int rocket)
{
    char *json = NULL;
    size_t length = 0;
    report_detail detail = {.whole_tube = true, .pixel = 1.0 / 4000};
    FILE *stream = open_memstream(&json, &length);
    assert_int_equal(report_write_table(stream, history, rocket, &detail, NULL), LD_OK);
    fclose(stream);
    printf("    rocket %d: %zu rows in %zu bytes\n", rocket, history->rows, length);
    return json;
}

// All rows of it fit beside the replay; were they too many, no curve would be seen to move.
static void test_long_lead_in_and_flight(void **state)
{
    (void)state;
    history_data read;
    ld_report report;
    static ld_summary summary;
    const char *sets[] = {
        "run.lead_in=5 s", "platform.elevation.stabiliser.command=55 deg",
        "measures=[{name: bound, of: tip.pitch_rate, take: rms, from: t_middle, to: t_rear}]"};
    example_run(folder, "reference.yaml", sets, 3, &summary, &read);
    CHECK_WITHIN("time of flight [s]", summary.rocket[0].flight.time_of_flight, 60, 200);
    clock_t before = clock();
    char *page = write_report(&report);
    printf("    CPU time of the report: %.2f s\n", (double)(clock() - before) / CLOCKS_PER_SEC);
    CHECK_WITHIN("bytes", (double)report.bytes, 0.9e6, 2e6);
    CHECK_WITHIN("pixels that a curve may be moved by", report.pixels, 0, 1);
    assert_non_null(strstr(page, "id=\"replay\""));
    assert_int_equal(report.note_count, 0);
    assert_non_null(strstr(page, "\"of\":\"tip.pitch_rate\""));
    free(page);

    const double *phase = history_column(&read, "phase");
    size_t before_tube = 0, in_tube = 0;
    while (phase[before_tube] < 1)
        before_tube++;
    while (before_tube + in_tube < read.rows && phase[before_tube + in_tube] < 3)
        in_tube++;
    char *json = table_of(&read, 0);
    check_part(&read, json, "before", 0, before_tube);
    check_part(&read, json, "tube", before_tube, in_tube);
    CHECK_WITHIN("rows kept in the tube", (double)read_column(json, "tube", "tip.y", times, values),
                 (double)in_tube, (double)in_tube);
    free(json);
    json = table_of(&read.flight[0], 1);
    check_part(&read.flight[0], json, "flight", 0, read.flight[0].rows);
    free(json);
    history_free(&read);
}

static void expect_note(const ld_report *report, const char *text)
{
    for (int i = 0; i < report->note_count; i++) {
        printf("    %s\n", report->note[i]);
        if (strstr(report->note[i], text))
            return;
    }
    fail_msg("no note says \"%s\"", text);
}

static int run(const char *format)
{
    char command[256];
    snprintf(command, sizeof command, format, folder);
    return system(command);
}

static void test_what_is_missing_is_said(void **state)
{
    (void)state;
    ld_report report;
    ld_error error = {0};
    assert_int_equal(ld_report_write(in("none"), NULL, &report, &error), LD_ERR_INPUT);
    printf("    %s\n", error.text);
    assert_non_null(strstr(error.text, "no results in "));
    assert_non_null(strstr(error.text, "There is no history.h5"));

    make_results(1605, "Whole", "front");
    assert_int_equal(run("cd %s && mv summary.json away"), 0);
    char *page = write_report(&report);
    expect_note(&report, "No summary: summary.json is missing");
    assert_non_null(strstr(page, "No summary: summary.json is missing"));
    assert_non_null(strstr(page, "\"tip.y\""));
    free(page);

    assert_int_equal(run("cd %s && mv away summary.json && truncate -s 100000 history.h5"), 0);
    assert_int_equal(ld_report_write(folder, NULL, &report, &error), LD_ERR_INPUT);
    page = read_all(in("report.html"));
    expect_note(&report, "No plots: history.h5 is damaged: it has 100000 bytes");
    assert_non_null(strstr(page, "\"tables\":[]"));
    assert_non_null(strstr(page, "\"exit_speed\""));
    free(page);

    assert_int_equal(run("cd %s && rm history.h5"), 0);
    assert_int_equal(ld_report_write(folder, NULL, &report, &error), LD_ERR_INPUT);
    expect_note(&report, "No plots: history.h5 is missing");
    assert_int_equal(ld_report_write(folder, in("none/x.html"), &report, &error), LD_ERR_FILE);
    assert_non_null(strstr(error.text, "No such file or directory"));
    assert_int_equal(ld_report_write(folder, "/dev/full", &report, &error), LD_ERR_FILE);
    assert_string_equal(error.text, "cannot write /dev/full: No space left on device");
    assert_int_equal(ld_report_write(in("summary.json"), NULL, &report, &error), LD_ERR_INPUT);
    printf("    %s\n", error.text);
    assert_non_null(strstr(error.text, "summary.json is not a folder"));
}

// What a killed run leaves.
static void test_part_of_a_run(void **state)
{
    (void)state;
    history_hdf5 *history;
    double row[MADE_COLUMNS];
    assert_int_equal(history_hdf5_create(in("history.h5.part"), "Killed", &history, NULL), LD_OK);
    assert_int_equal(history_hdf5_begin(history, made_columns(), MADE_COLUMNS, NULL), LD_OK);
    for (size_t i = 0; i < 1500; i++) {
        made_row(i, row);
        assert_int_equal(history_hdf5_row(history, row, NULL), LD_OK);
    }
    assert_int_equal(run("cp %1$s/history.h5.part %1$s/kept"), 0);
    assert_int_equal(history_hdf5_close(history, NULL, NULL), LD_OK);
    assert_int_equal(run("mv %1$s/kept %1$s/history.h5.part"), 0);
    ld_report report;
    char *page = write_report(&report);
    expect_note(&report, "The run did not reach its end");
    CHECK_WITHIN("rows of the whole blocks",
                 (double)read_column(page, "tube", "tip.y", times, values), 1024, 1024);
    free(page);
}

// A title that no report has room for is reported as what it is, of one run and of several.
static void test_title_without_room(void **state)
{
    (void)state;
    enum { BYTES = 1000000 };
    history_hdf5 *history;
    ld_error error = {.text = ""};
    char *title = malloc(BYTES + 1);
    memset(title, 'x', BYTES);
    title[BYTES] = '\0';
    assert_int_equal(run("mkdir -p %1$s/titled"), 0);
    assert_int_equal(history_hdf5_create(in("titled/history.h5"), title, &history, NULL), LD_OK);
    assert_int_equal(history_hdf5_begin(history, made_columns(), MADE_COLUMNS, NULL), LD_OK);
    assert_int_equal(history_hdf5_close(history, NULL, NULL), LD_OK);
    free(title);
    assert_int_equal(ld_report_write(in("titled"), NULL, NULL, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "the title has 1000000 bytes, too many for a report of 2000000 "
                                    "bytes");
    const char *const both[] = {in("titled"), in("titled")};
    assert_int_equal(ld_report_write_runs(both, 2, in("both.html"), NULL, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "the title has 2000000 bytes"));
}

// Runs laid over each other: what is not there is left out with a warning, titles stay texts.
static void test_runs_over_each_other(void **state)
{
    (void)state;
    static char one[512], other[512], none[512];
    ld_report report;
    ld_error error = {0};
    make_results(1605, "One</script><b>bold", "front");
    assert_int_equal(run("cd %s && mkdir one && mv summary.json history.h5 one"), 0);
    make_results(400, "Other", "front");
    assert_int_equal(run("cd %s && mkdir other && mv summary.json history.h5 other"), 0);
    snprintf(one, sizeof one, "%s/one/", folder);
    snprintf(other, sizeof other, "%s/other", folder);
    snprintf(none, sizeof none, "%s/none", folder);
    const char *const folders[] = {one, none, other};
    assert_int_equal(ld_report_write_runs(folders, 3, in("over.html"), &report, &error),
                     LD_ERR_INPUT);
    expect_note(&report, "no results in ");
    assert_non_null(strstr(error.text, "none; the report shows the rest"));
    char *page = read_all(in("over.html"));
    assert_true(strlen(page) == report.bytes);
    assert_non_null(strstr(page, "{\"folder\":\"one\",\"title\":\"One"));
    assert_non_null(strstr(page, "{\"folder\":\"other\",\"title\":\"Other\""));
    assert_non_null(strstr(page, "id=\"summary-1\""));
    assert_null(strstr(page, "id=\"summary-2\""));
    assert_null(strstr(page, "</script><b>"));
    assert_null(strstr(page, "id=\"replay\""));
    CHECK_WITHIN("rows of the first run", (double)read_column(page, "tube", "tip.y", times, values),
                 1, 1605);
    free(page);

    assert_int_equal(run("cd %s && truncate -s 9000 other/history.h5"), 0);
    assert_int_equal(ld_report_write_runs(folders, 3, in("over.html"), &report, &error),
                     LD_ERR_INPUT);
    expect_note(&report, "other is damaged: history.h5 is damaged");
    assert_int_equal(ld_report_write_runs(folders + 1, 1, in("over.html"), &report, &error),
                     LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "no run to report: no results in "));
    assert_int_equal(ld_report_write_runs(folders, 1, in("over.html"), &report, &error), LD_OK);
    assert_int_equal(ld_report_write_runs(folders, 1, "/dev/full", &report, &error), LD_ERR_FILE);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, scratch_make, scratch_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_numbers_are_those_of_the_results),
        TEST(test_no_text_becomes_code),
        TEST(test_thinning),
        TEST(test_size_is_bounded),
        TEST(test_long_lead_in_and_flight),
        TEST(test_what_is_missing_is_said),
        TEST(test_part_of_a_run),
        TEST(test_title_without_room),
        TEST(test_runs_over_each_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
