// The report of studies: its numbers are those that `study show` prints and those of the values
// themselves, its size is bounded, what is broken is said, no text becomes code.
// link: -lsqlite3
#include "support/study_database.h"

#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "launchdyn/report.h"
#include "launchdyn/study.h"
#include "quantities/study_results.h"
#include "report/report_html.h"
#include "report/report_study_numbers.h"
#include "studies/statistics/agreement.h"
#include "studies/statistics/density.h"
#include "studies/statistics/sensitivity.h"

// ---- studies made up

// Names of results, of a rocket with two adaptors: those that the tests ask for, each of which
// costs as much as another, or all.
static char study_name[128][QUANTITY_NAME];
static double study_factor[128]; // to the unit of study show
static int results;

static bool asked_for(const char *name)
{
    static const char *const asked[] = {"exit_speed", "pitch", "yaw", "downrange", "drift"};
    for (size_t i = 0; i < sizeof asked / sizeof *asked; i++)
        if (strcmp(name, asked[i]) == 0)
            return true;
    return false;
}

static void name_results(bool all)
{
    results = 0;
    static const char adaptors[2][8] = {"rear", "front"};
    const quantity_things things = {.count = {[EACH_RUN] = 1, [EACH_ADAPTOR] = 2},
                                    .name = {[EACH_ADAPTOR] = adaptors[0]},
                                    .stride = {[EACH_ADAPTOR] = sizeof adaptors[0]}};
    for (quantity_walk at = study_result_first(&things); at.row; study_result_next(&at)) {
        study_result_name(&at, study_name[results]);
        study_factor[results] = study_result_unit(study_name[results], at.row->unit).factor;
        results += all || asked_for(study_name[results]);
    }
}

// What result number k of rocket r of sample i is, as SQL and in C.
#define VALUE "((i * 7919 + r * 104729 + %d * 1299709) %% 10007) / 10007.0 * %d"
static double value_of(int i, int r, int k)
{
    return ((i * 7919 + r * 104729 + k * 1299709) % 10007) / 10007.0 * (k + 1);
}

// `first`: number of the first sample. All results, of two rockets a sample.
static void add_samples(FILE *sql, int first, int count)
{
    fprintf(sql,
            "WITH RECURSIVE n(i) AS (SELECT %d UNION ALL SELECT i + 1 FROM n LIMIT %d)"
            " INSERT INTO sample SELECT i, 1, 'ok', NULL FROM n;",
            first, count);
    fprintf(sql,
            "WITH RECURSIVE n(i) AS (SELECT %d UNION ALL SELECT i + 1 FROM n LIMIT %d), o(r) AS "
            "(VALUES (1), (2)) INSERT INTO rocket SELECT i, r, r",
            first, count);
    for (int k = 0; k < results; k++)
        fprintf(sql, ", " VALUE, k, k + 1);
    fputs(" FROM n, o;", sql);
}

static void make_tables(FILE *sql, const char *title, int samples)
{
    fprintf(sql,
            "CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT);"
            "CREATE TABLE origin (kind TEXT, name TEXT, text BLOB);"
            "INSERT INTO study VALUES ('format', '" STORE_FORMAT
            "'), ('version', '0.1'), ('samples', '%d'),"
            " ('strata', '1'), ('scenario', 'include: %s/examples/fixed.yaml\ntitle: ''%s''\n');"
            "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER, status TEXT, "
            "reason TEXT);" ONE_POINT
            "CREATE TABLE rocket (sample INTEGER, rocket INTEGER, tube INTEGER",
            samples, LD_SOURCE_DIR, title);
    for (int k = 0; k < results; k++)
        fprintf(sql, ", \"%s\" REAL", study_name[k]);
    fputs(", PRIMARY KEY (sample, rocket)) WITHOUT ROWID;", sql);
}

// A study in folder `name`: so many good samples, then what `more` does.
static void make_study(const char *name, const char *title, int samples, const char *more)
{
    char *text = NULL;
    size_t length;
    FILE *sql = open_memstream(&text, &length);
    fputs("BEGIN;", sql);
    make_tables(sql, title, samples);
    if (samples > 0)
        add_samples(sql, 1, samples);
    fprintf(sql, "%s; COMMIT", more);
    fclose(sql);
    write_database(name, text);
    free(text);
}

// ---- reports of them

static char *read_page(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char *text = calloc(1, 4 << 20);
    assert_in_range(fread(text, 1, (4 << 20) - 1, file), 1, REPORT_BYTES);
    fclose(file);
    return text;
}

static char *report_of(const char *const *folders, size_t count, ld_report *report)
{
    ld_error error = {0};
    if (ld_report_write_studies(folders, count, in("report.html"), report, &error))
        fail_msg("%s", error.text);
    return read_page(in("report.html"));
}

static char *report_one(const char *name, ld_report *report)
{
    const char *path = in(name);
    return report_of(&path, 1, report);
}

// What follows `key` after `place`.
static const char *after(const char *place, const char *key)
{
    const char *found = strstr(place, key);
    if (!found)
        fail_msg("the page has no %s", key);
    return found + strlen(key);
}

static const char *result_named(const char *page, const char *name)
{
    char key[QUANTITY_NAME + 32];
    snprintf(key, sizeof key, "{\"name\":\"%s\",\"unit\":", name);
    return after(page, key);
}

// Numbers between brackets and commas; null is NaN.
static void read_numbers(const char *text, double *number, int count)
{
    for (int i = 0; i < count; i++) {
        text += strspn(text, "[],");
        char *end;
        number[i] = *text == 'n' ? NAN : strtod(text, &end);
        text = *text == 'n' ? text + 4 : end;
    }
}

// ---- numbers

enum { SAMPLES = 500, VALUES = 2 * SAMPLES };
static const int pitch = 1; // its place among the results

// Mean and deviation of the values of the first samples.
static void directly(int samples, double *mean, double *deviation)
{
    double sum = 0, squares = 0;
    for (int i = 1; i <= samples; i++)
        sum += value_of(i, 1, pitch) + value_of(i, 2, pitch);
    *mean = sum / (2 * samples);
    for (int i = 1; i <= samples; i++)
        for (int r = 1; r <= 2; r++)
            squares += pow(value_of(i, r, pitch) - *mean, 2);
    *deviation = sqrt(squares / (2 * samples - 1));
}

static void test_numbers_are_those_of_the_values(void **state)
{
    (void)state;
    make_study("study", "Made up", SAMPLES, "");
    char *page = report_one("study", NULL);
    const char *result = result_named(page, "pitch"), *series = after(result, "\"series\":[");
    double mean, deviation, read[3];
    directly(SAMPLES, &mean, &deviation);
    read_numbers(after(series, "\"mean\":"), read, 3);
    CHECK_NEAR("mean", read[0], mean, 1e-14);
    read_numbers(after(series, "\"deviation\":"), read, 3);
    CHECK_NEAR("deviation", read[0], deviation, 1e-14);

    // the histogram holds every value, in the bin where it belongs
    double bins[2], value[VALUES], count[REPORT_BINS];
    bins[0] = strtod(after(result, "\"bins\":{\"from\":"), NULL);
    bins[1] = strtod(after(result, "\"width\":"), NULL);
    int bin_count = atoi(after(after(result, "\"width\":"), "\"count\":"));
    read_numbers(after(series, "\"bins\":["), count, bin_count);
    for (int i = 0; i < VALUES; i++)
        value[i] = value_of(1 + i / 2, 1 + i % 2, pitch);
    sort_values(value, VALUES);
    double total = 0, wrong = 0;
    for (int b = 0, i = 0; b < bin_count; b++) {
        int here = 0;
        for (; i < VALUES && (value[i] < bins[0] + (b + 1) * bins[1] - 1e-12 || b == bin_count - 1);
             i++)
            here++;
        wrong += fabs(here - count[b]);
        total += count[b];
    }
    CHECK_WITHIN("values in the histogram", total, VALUES, VALUES);
    CHECK_WITHIN("of them in the wrong bin", wrong, 0, 0);
    // Freedman and Diaconis: a quarter of the way between two neighbours from each end
    double low = 0.25 * value[249] + 0.75 * value[250],
           high = 0.75 * value[749] + 0.25 * value[750];
    double span = value[VALUES - 1] - value[0], rule = 2 * (high - low) / cbrt(VALUES);
    CHECK_NEAR("width of a bin", bins[1], span / ceil(span / rule), 1e-15);
    free(page);
}

static void test_running_estimates(void **state)
{
    (void)state;
    make_study("study", "Made up", SAMPLES, "");
    char *page = report_one("study", NULL);
    const char *running = after(result_named(page, "pitch"), "\"running\":[");
    double samples[REPORT_PLACES] = {0}, read[3 * REPORT_PLACES], worst = 0;
    int count = 0;
    read_numbers(after(running, "\"samples\":"), samples, REPORT_PLACES);
    while (count < REPORT_PLACES && samples[count] < SAMPLES)
        count++;
    count++;
    CHECK_WITHIN("places", count, 50, REPORT_PLACES);
    CHECK_WITHIN("samples at the first", samples[0], 2, 2);
    CHECK_WITHIN("samples at the last", samples[count - 1], SAMPLES, SAMPLES);
    for (int which = 0; which < 2; which++) {
        worst = 0;
        read_numbers(after(running, which ? "\"deviation\":" : "\"mean\":"), read, 3 * count);
        for (int i = 0; i < count; i++) {
            double expected[2];
            directly((int)samples[i], &expected[0], &expected[1]);
            worst = fmax(worst, fabs(read[3 * i] / expected[which] - 1));
        }
        CHECK_BELOW(which ? "deviation: worst relative error" : "mean: worst relative error", worst,
                    1e-7);
    }
    free(page);
}

static void expect_line(const char *shown, const char *format, const double *number)
{
    char line[256];
    snprintf(line, sizeof line, format, number[0], number[1], number[2]);
    if (!strstr(shown, line))
        fail_msg("show does not say \"%s\"", line);
    printf("    show says %s\n", line);
}

static void test_numbers_are_those_of_show(void **state)
{
    (void)state;
    name_results(true);
    make_study("study", "Made up", 60, "UPDATE sample SET status = 'launch' WHERE sample > 50");
    char *shown = NULL, *page = report_one("study", NULL);
    size_t length;
    FILE *stream = open_memstream(&shown, &length);
    ld_study_view all = {.what = "all"};
    assert_int_equal(ld_study_show(in("study"), &all, stream, NULL), LD_OK);
    fclose(stream);
    for (int k = 0; k < results; k++) {
        double e[3] = {0};
        const char *series = after(result_named(page, study_name[k]), "\"series\":[");
        read_numbers(after(series, "\"mean\":"), e, 3);
        e[0] *= study_factor[k];
        e[1] = 0.5 * (e[2] - e[1]) * study_factor[k];
        expect_line(shown, "%.6g +- %.2g", e);
        read_numbers(after(series, "\"deviation\":"), e, 3);
        for (int i = 0; i < 3; i++)
            e[i] *= study_factor[k];
        expect_line(shown, "%.4g [%.4g, %.4g]", e);
    }
    const char *ellipse = after(after(page, "\"x\":\"downrange\""), "\"ellipse\":");
    double e[6] = {0};
    read_numbers(after(ellipse, "\"mean\":"), e, 2);
    expect_line(shown, "downrange and drift [m]: centre %.6g, %.6g", e);
    read_numbers(after(ellipse, "\"semi_axis\":"), e, 6);
    expect_line(shown, "    semi-axes of one standard deviation %.4g [%.4g, %.4g]", e);
    expect_line(shown, "] and %.4g [%.4g, %.4g]", e + 3);
    name_results(false);
    free(page);
    free(shown);
}

static int result_number(const char *name)
{
    for (int k = 0; k < results; k++)
        if (strcmp(study_name[k], name) == 0)
            return k;
    fail_msg("there is no result %s", name);
    return 0;
}

// Two rockets of a sample that come down at one place count as one: the contours' grid begins where
// that of the first ones alone does, three widths of the kernel beside them.
static void test_contours_count_independent_rockets(void **state)
{
    (void)state;
    enum { COUNT = 200 };
    static density_map alone;
    double x[COUNT], y[COUNT], origin[2];
    make_study("study", "Twins", COUNT,
               "UPDATE rocket SET downrange = o.downrange, drift = o.drift FROM rocket AS o "
               "WHERE o.sample = rocket.sample AND o.rocket = 1");
    for (int i = 0; i < COUNT; i++) {
        x[i] = value_of(1 + i, 1, result_number("downrange"));
        y[i] = value_of(1 + i, 1, result_number("drift"));
    }
    char *page = report_one("study", NULL);
    const char *pair = after(page, "\"x\":\"downrange\"");
    read_numbers(after(after(pair, "\"contours\":"), "\"origin\":"), origin, 2);
    assert_int_equal(density_of(x, y, COUNT, COUNT, &alone), LD_OK);
    for (int k = 0; k < 2; k++)
        CHECK_NEAR("origin of the grid", origin[k] / alone.origin[k], 1, 1.5e-3);
    free(page);
}

// Area of closed lines "[[i,j,i,j,...],[...]]".
static double enclosed(const char *text)
{
    double sum = 0, last[2] = {0}, corner[2], first[2] = {0};
    bool begins = true;
    for (const char *at = text + 1; *at != ']' || at[1] != ']';) {
        char *after_number;
        begins |= *at == '[';
        at += strspn(at, "[],");
        corner[0] = strtod(at, &after_number);
        corner[1] = strtod(after_number + 1, &after_number);
        at = after_number;
        memcpy(begins ? first : last, begins ? corner : last, sizeof last);
        if (!begins)
            sum += 0.5 * ((last[0] - first[0]) * (corner[1] - first[1]) -
                          (corner[0] - first[0]) * (last[1] - first[1]));
        memcpy(last, corner, sizeof last);
        begins = strncmp(at, "],[", 3) == 0;
    }
    return sum;
}

// The lines of a footprint enclose the area that stands beside them.
static void test_footprint(void **state)
{
    (void)state;
    double step[4], estimates[4];
    make_study("study", "Safe", 200, "");
    char *page = report_one("study", NULL);
    const char *of = after(after(page, "\"x\":\"downrange\""), "\"footprint\":{");
    read_numbers(after(of, "\"step\":"), step, 4);
    of = after(of, "{\"share\":0.95,\"needed\":180,\"independent\":");
    read_numbers(after(of, "\"estimates\":"), estimates, 4);
    CHECK_NEAR("share", estimates[0], 0.95, 1e-12);
    CHECK_NEAR("area of the footprint that is drawn",
               enclosed(after(of, "\"lines\":")) * 1e-4 * (step[0] * step[3] - step[1] * step[2]) /
                   estimates[3],
               1, 1e-3);
    free(page);
}

static double first_number(const char *place, const char *key)
{
    double number;
    read_numbers(after(place, key), &number, 1);
    return number;
}

// Launches that are every tenth value, 0.3 mrad higher: differences, ratios and p are those of
// agreement_of(), and of what is not a study's nothing is written.
static void test_measured(void **state)
{
    (void)state;
    enum { LAUNCHES = VALUES / 10 };
    double launch[LAUNCHES], value[VALUES], read[3];
    int64_t launch_group[LAUNCHES], group[VALUES];
    make_study("study", "Made up", SAMPLES, "");
    FILE *file = fopen(in("<svg onload=alert(1)>.csv"), "w");
    fputs("pitch [mrad]\n", file);
    for (int i = 0; i < VALUES; i++) {
        value[i] = value_of(1 + i / 2, 1 + i % 2, pitch);
        group[i] = i / 2;
        if (i % 10 == 0) {
            fprintf(file, "%.17g\n", 1e3 * value[i] + 0.3);
            launch[i / 10] = value[i] + 3e-4;
            launch_group[i / 10] = i;
        }
    }
    fclose(file);
    ld_error error;
    const char *study = in("study");
    char launches[128];
    snprintf(launches, sizeof launches, "%s", in("<svg onload=alert(1)>.csv"));
    assert_int_equal(ld_report_write_measured(&study, 1, launches, in("report.html"), NULL, &error),
                     LD_OK);
    char *page = read_page(in("report.html"));
    const char *series =
        after(after(after(page, "\"measured\":{\"file\":"), "\"own\":"), "\"series\":[");
    agreement by;
    assert_int_equal(agreement_of((grouped_values){launch, launch_group, LAUNCHES},
                                  (grouped_values){value, group, VALUES}, &by),
                     LD_OK);
    read_numbers(after(series, "\"difference\":"), read, 3);
    CHECK_NEAR("difference", read[0], by.mean.value, 1e-14);
    CHECK_NEAR("its upper end", read[2], by.mean.high, 1e-14);
    CHECK_NEAR("p", first_number(series, "\"difference_chance\":"), by.mean_chance, 1e-10);
    read_numbers(after(series, "\"ratio\":"), read, 3);
    CHECK_NEAR("ratio", read[0], by.deviation.value, 1e-12);
    CHECK_NEAR("p", first_number(series, "\"ratio_chance\":"), by.deviation_chance, 1e-10);
    assert_null(strstr(page, "<svg"));
    free(page);
    page = report_one("study", NULL);
    assert_non_null(strstr(page, "\"measured\":null"));
    free(page);
    file = fopen(launches, "w");
    fputs("pitch [mrad]\n1\nx\n", file);
    fclose(file);
    assert_int_equal(ld_report_write_measured(&study, 1, launches, in("report.html"), NULL, &error),
                     LD_ERR_INPUT);
    assert_non_null(strstr(error.text, ".csv:3:1: pitch: found \"x\"; expected a number"));
}

// A factor that is pitch and something else.
static void test_sensitivities(void **state)
{
    (void)state;
    make_study("study", "Made up", SAMPLES,
               "ALTER TABLE rocket ADD \"rocket.mass_error\" REAL;"
               "UPDATE rocket SET \"rocket.mass_error\" = pitch + 0.2 * (sample % 10)");
    char *page = report_one("study", NULL);
    const char *own = after(after(page, "\"sensitivities\":["), "{\"name\":\"pitch\",\"series\":[");
    double read[3], x[VALUES], y[VALUES];
    int64_t sample[VALUES], group[VALUES];
    read_numbers(after(own, "[[\"rocket.mass_error\","), read, 3);
    for (int i = 0; i < VALUES; i++) {
        sample[i] = 1 + i / 2;
        group[i] = i / 2;
        y[i] = value_of((int)sample[i], 1 + i % 2, pitch);
        x[i] = y[i] + 0.2 * (double)(sample[i] % 10);
    }
    estimate expected = sensitivity_of(x, y, sample, group, VALUES, true);
    CHECK_NEAR("sensitivity", read[0], expected.value, 1e-8);
    CHECK_NEAR("its interval, low", read[1], expected.low, 1e-8);
    CHECK_NEAR("its interval, high", read[2], expected.high, 1e-8);
    // variances: 2^2/12 of pitch, 0.2^2 (10^2 - 1)/12 of the rest
    CHECK_NEAR("share that is pitch", read[0], 4 / (4 + 3.96), 0.02);
    free(page);
}

// ---- what is drawn

static void test_bins(void **state)
{
    (void)state;
    // 0 ... 999: IQR 499.5, width 99.9, ten bins of 99.9
    double even[1000], same[] = {3, 3, 3}, far[1000];
    for (int i = 0; i < 1000; i++)
        even[i] = far[i] = i;
    far[999] = 1e9;
    const double *list[] = {even, same, far};
    study_bins bins = study_choose_bins(list, (size_t[]){1000}, 1);
    CHECK_WITHIN("bins of even values", bins.count, 10, 10);
    CHECK_NEAR("their width", bins.width, 99.9, 1e-12);
    long in_bin[REPORT_BINS];
    study_fill_bins(&bins, even, 1000, in_bin);
    assert_true(in_bin[0] == 100 && in_bin[4] == 100 && in_bin[9] == 100);
    bins = study_choose_bins(list + 1, (size_t[]){3}, 1);
    study_fill_bins(&bins, same, 3, in_bin);
    assert_true(bins.count == 1 && in_bin[0] == 3);
    bins = study_choose_bins(list + 2, (size_t[]){1000}, 1);
    CHECK_WITHIN("bins with a value far off", bins.count, REPORT_BINS, REPORT_BINS);
    bins = study_choose_bins(list, (size_t[]){1000, 3, 0}, 3);
    CHECK_WITHIN("bins that two share", bins.count, 10, 10);
    bins = study_choose_bins(list, (size_t[]){0}, 1);
    CHECK_WITHIN("bins of nothing", bins.count, 0, 0);
}

static void test_places(void **state)
{
    (void)state;
    size_t place[REPORT_PLACES];
    assert_int_equal(study_choose_places(0, REPORT_PLACES, place), 0);
    assert_int_equal(study_choose_places(1, REPORT_PLACES, place), 0);
    assert_int_equal(study_choose_places(2, REPORT_PLACES, place), 1);
    assert_int_equal(study_choose_places(20, REPORT_PLACES, place), 19);
    int count = study_choose_places(100000, REPORT_PLACES, place);
    assert_true(place[0] == 2 && place[count - 1] == 100000);
    for (int i = 1; i < count; i++)
        assert_true(place[i] > place[i - 1]);
    CHECK_WITHIN("places of 100 000 groups", count, 50, REPORT_PLACES);
}

// Which points are shown has nothing to do with where they stand or with what they hold.
static void test_points_shown(void **state)
{
    (void)state;
    enum { COUNT = 100000, MOST = 2000 };
    double shown = 0, sum = 0;
    for (int i = 1; i <= COUNT; i++)
        if (study_shows_point(i, 1, COUNT, MOST)) {
            shown++;
            sum += i;
        }
    CHECK_WITHIN("points shown, 2000 +- 4 deviations", shown, 2000 - 180, 2000 + 180);
    CHECK_WITHIN("their mean place, +- 4 deviations", sum / shown / COUNT, 0.5 - 0.026,
                 0.5 + 0.026);
    assert_true(study_shows_point(7, 1, 10, MOST));
}

// ---- several

static void test_side_by_side(void **state)
{
    (void)state;
    make_study("slow", "At 15 km/h", 100, "");
    make_study("fast", "At 30 km/h", 300, "");
    const char *folders[] = {in("slow"), in("fast")};
    ld_report report;
    char *page = report_of(folders, 2, &report);
    assert_int_equal(report.note_count, 0);
    assert_non_null(strstr(page, "{\"label\":\"slow\",\"title\":\"At 15 km/h\""));
    assert_non_null(strstr(page, "{\"label\":\"fast\",\"title\":\"At 30 km/h\""));
    const char *series = after(result_named(page, "pitch"), "\"series\":[");
    CHECK_WITHIN("values of the first", atof(after(series, "\"count\":")), 200, 200);
    series = after(series, "\"bins\":[");
    CHECK_WITHIN("values of the second", atof(after(series, "\"count\":")), 600, 600);
    free(page);
}

static void test_points_of_a_sweep(void **state)
{
    (void)state;
    make_study("sweep", "Swept", 40,
               "ALTER TABLE point ADD \"base.speed\" TEXT; UPDATE point SET \"base.speed\" = '0 "
               "km/h'; INSERT INTO point VALUES (2, '15 km/h');"
               "UPDATE sample SET point = 2 WHERE sample > 30");
    ld_report report;
    char *page = report_one("sweep", &report);
    assert_non_null(strstr(page, "{\"label\":\"speed = 0 km/h\",\"title\":\"Swept\""));
    const char *series = after(result_named(page, "pitch"), "\"series\":[");
    CHECK_WITHIN("values of the first point", atof(after(series, "\"count\":")), 60, 60);
    series = after(series, "\"bins\":[");
    CHECK_WITHIN("values of the second", atof(after(series, "\"count\":")), 20, 20);
    const char *key = after(page, "\"over\":{\"keys\":[");
    assert_non_null(strstr(key,
                           "{\"name\":\"base.speed\",\"unit\":\"km/h\",\"texts\":[\"0 km/h\",\"15 "
                           "km/h\"],\"numbers\":[0,15],\"reference\":\"0 km/h\"}"));
    // of what differences are from there are none
    assert_non_null(strstr(key, "\"difference\":[null,null,null],\"ratio\":[null,null,null]"));
    free(page);
}

// As many series as there may be, all results, in long numbers, factors, many failures with long
// reasons: the first try is too large.
static void test_size_is_bounded(void **state)
{
    (void)state;
    name_results(true);
    char more[16384] = "INSERT INTO sample SELECT sample + 10000, 1, 'launch', printf('%.300c', "
                       "'x') FROM sample; ALTER TABLE point ADD key TEXT;",
         *end = more + strlen(more);
    for (int i = 2; i <= 41; i++)
        end += sprintf(end, "INSERT INTO point VALUES (%d, '%d');", i, i);
    end += sprintf(end, "UPDATE sample SET point = 1 + sample %% 41;");
    for (int i = 0; i < 16; i++)
        end += sprintf(end,
                       "ALTER TABLE sample ADD \"rocket.motor.misalignment.%d\" REAL;"
                       "UPDATE sample SET \"rocket.motor.misalignment.%d\" = sample * %d %% 1009;",
                       i, i, 101 + i);
    for (int k = 0; k < results; k++)
        end +=
            sprintf(end, "UPDATE rocket SET \"%s\" = -\"%s\" / 3e9;", study_name[k], study_name[k]);
    make_study("sweep", "Swept", 7 * 41, more);
    name_results(false);
    ld_report report;
    clock_t before = clock();
    free(report_one("sweep", &report));
    printf("    CPU time of 40 series: %.2f s\n", (double)(clock() - before) / CLOCKS_PER_SEC);
    CHECK_WITHIN("bytes", (double)report.bytes, 1e6, REPORT_BYTES);
    assert_int_equal(report.note_count, 2);
    printf("    %s\n    %s\n", report.note[0], report.note[1]);
    assert_non_null(strstr(report.note[0], "More than 40 series"));
    assert_non_null(strstr(report.note[1], "first 3 of 16 results"));
}

// ---- what is broken

static void test_no_text_becomes_code(void **state)
{
    (void)state;
    make_study("<svg onload=alert(1)>",
               "</title></script><script>alert(2)</script><img src=x onerror=alert(3)>", 20,
               "UPDATE sample SET status = 'input', reason = '</script><b onclick=alert(4)><!--' "
               "WHERE sample > 15");
    const char *path = in("<svg onload=alert(1)>");
    char *page = report_of(&path, 1, NULL);
    int tags = 0, comments = 0;
    for (const char *place = page; (place = strstr(place, "<script")) != NULL; place++)
        tags++;
    CHECK_WITHIN("script tags: data, code", tags, 2, 2);
    for (const char *place = page; (place = strstr(place, "<!--")) != NULL; place++)
        comments++;
    CHECK_WITHIN("comments", comments, 0, 0);
    assert_null(strstr(page, "<img"));
    assert_null(strstr(page, "<svg"));
    assert_null(strstr(page, "<b "));
    assert_non_null(strstr(page, "<title>&lt;/title&gt;&lt;/script&gt;&lt;script&gt;alert(2)"));
    assert_non_null(strstr(page, "[16,\"input\",\"\\u003c/script>\\u003cb onclick=alert(4)>"));
    assert_non_null(strstr(page, "content=\"default-src 'none'; script-src 'sha256-"));
    free(page);
}

static void expect_failure(const char *name, const char *reason)
{
    ld_error error = {0};
    const char *path = in(name);
    assert_int_equal(ld_report_write_studies(&path, 1, in("report.html"), NULL, &error),
                     LD_ERR_INPUT);
    printf("    %s\n", error.text);
    assert_non_null(strstr(error.text, reason));
}

static int run(const char *command)
{
    char whole[256];
    snprintf(whole, sizeof whole, "cd %s && %s", folder, command);
    return system(whole);
}

static void test_what_is_missing_is_said(void **state)
{
    (void)state;
    expect_failure("none", "contains no study");
    make_study("empty", "Empty", 0, "");
    char *page = report_one("empty", NULL);
    assert_non_null(strstr(page, "\"samples\":0,\"done\":0,\"failed\":0"));
    assert_non_null(strstr(page, "\"results\":[]"));
    free(page);
    make_study("failed", "All failed", 20, "UPDATE sample SET status = 'launch', reason = 'stuck'");
    page = report_one("failed", NULL);
    assert_non_null(strstr(page, "\"done\":20,\"failed\":20"));
    assert_non_null(strstr(page, "[20,\"launch\",\"stuck\"]"));
    assert_non_null(strstr(page, "\"results\":[]"));
    free(page);
    make_study("running", "Running", 20, "UPDATE study SET value = '50' WHERE name = 'samples'");
    page = report_one("running", NULL);
    assert_non_null(strstr(page, "\"samples\":50,\"done\":20"));
    free(page);
    make_study("text", "Not a database", 1, "");
    assert_int_equal(run("echo 'this is no database at all, only a line of text' > text/study.db"),
                     0);
    expect_failure("text", "not a database");
}

// Cut off in the middle: what can be read is shown beside a whole study.
static void test_truncated(void **state)
{
    (void)state;
    make_study("whole", "Whole", 500, "");
    make_study("cut", "Cut", 500, "");
    assert_int_equal(run("truncate -s 60000 cut/study.db"), 0);
    const char *folders[] = {in("cut"), in("whole")};
    ld_report report;
    ld_error error = {.text = ""};
    assert_int_equal(ld_report_write_studies(folders, 2, in("report.html"), &report, &error),
                     LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "cut/study.db is damaged: "));
    assert_non_null(strstr(error.text, "; the report shows the rest"));
    char *page = read_page(in("report.html"));
    assert_true(report.bytes > 0 && report.note_count > 0);
    for (int i = 0; i < report.note_count; i++)
        printf("    %s\n", report.note[i]);
    assert_non_null(strstr(report.note[0], "cut"));
    assert_non_null(strstr(report.note[0], "malformed"));
    assert_non_null(strstr(page, "\"label\":\"whole\""));
    assert_non_null(strstr(page, "malformed"));
    free(page);
}

// Damaged in the middle: no page of what may be wrong.
static void test_damaged(void **state)
{
    (void)state;
    make_study("damaged", "Damaged", 500, "");
    assert_int_equal(run("dd if=/dev/zero of=damaged/study.db bs=4096 seek=17 count=1 conv=notrunc "
                         "status=none"),
                     0);
    expect_failure("damaged", "damaged/study.db is damaged: ");
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, scratch_make, scratch_remove)

int main(void)
{
    name_results(false);
    const struct CMUnitTest tests[] = {
        TEST(test_numbers_are_those_of_the_values),
        TEST(test_running_estimates),
        TEST(test_numbers_are_those_of_show),
        TEST(test_contours_count_independent_rockets),
        TEST(test_footprint),
        TEST(test_measured),
        TEST(test_sensitivities),
        TEST(test_bins),
        TEST(test_places),
        TEST(test_points_shown),
        TEST(test_side_by_side),
        TEST(test_points_of_a_sweep),
        TEST(test_size_is_bounded),
        TEST(test_no_text_becomes_code),
        TEST(test_what_is_missing_is_said),
        TEST(test_truncated),
        TEST(test_damaged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
