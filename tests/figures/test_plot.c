// Figures: what the script says against the history, what gnuplot makes of it, what can go wrong.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "figures/labels.h"
#include "figures/plot.h"
#include "quantities/summary.h"
#include "scenario/scenario.h"
#include "support/made_launch.h"
#include "support/scratch.h"

// A made-up run of 160 ms in `folder`/run.
static int set_up(void **state)
{
    static ld_model model;
    static ld_summary summary;
    ld_output *output = NULL;
    if (scratch_make(state))
        return -1;
    made_model(&model);
    made_summary(&summary, 1);
    return ld_output_open(in("run"), &model, false, &output, NULL) ||
           made_run(ld_output_sink(output), 1605, NULL) || ld_output_finish(output, &summary, NULL);
}

static int run(const char *format, const char *path)
{
    char command[256];
    snprintf(command, sizeof command, format, path);
    return system(command);
}

// The script of one figure of the made-up run, `runs` times over, from `from` [s] on, with a column
// of a shoe or without, to be freed.
// Of the scripts made next; the width [m] as the style has it: 0.
static const char *style;
static double width;

static char *script_with(const char *name, size_t runs, double from, bool shoes)
{
    history_data history[2];
    for (size_t i = 0; i < runs; i++)
        assert_int_equal(history_read(in("run/history.h5"), &history[i], NULL), LD_OK);
    for (size_t i = 0; i < history[0].columns && shoes; i++)
        if (strcmp(history[0].name[i], "slot.friction") == 0)
            memcpy(history[0].name[i], "shoe.rear.mm", sizeof "shoe.rear.mm");
    const plot_figure *figure = plot_figure_find(name);
    assert_non_null(figure);
    const char *names[] = {"the one", "the other's"};
    plot_page page = {.run = history,
                      .style = plot_style_find(style, NULL),
                      .width = plot_width(plot_style_find(style, NULL), width),
                      .name = names,
                      .runs = runs,
                      .figure = &figure,
                      .figures = 1,
                      .from = from,
                      .to = NAN};
    char *text = NULL;
    size_t length = 0;
    FILE *script = open_memstream(&text, &length);
    assert_int_equal(plot_write_script(script, &page, PLOT_SVG, NULL), LD_OK);
    fclose(script);
    for (size_t i = 0; i < runs; i++)
        history_free(&history[i]);
    return text;
}

static char *script_of_runs(const char *name, size_t runs, double from)
{
    return script_with(name, runs, from, false);
}

static char *script_of(const char *name)
{
    return script_of_runs(name, 1, NAN);
}

// Draws one figure of a run.
static ld_status plot(const char *run_folder, const char *figure, const char *file, ld_error *error)
{
    return ld_plot(&(ld_picture){.folder = &run_folder,
                                 .folder_count = 1,
                                 .figure = &figure,
                                 .figure_count = 1,
                                 .from = NAN,
                                 .to = NAN},
                   file, error);
}

// Largest distance, over the rows of a made column, of the thinned curve from the full one, as a
// share of the panel's size. Fails if the data block is not there.
static double farthest(const char *script, const char *block, int column, double factor,
                       size_t rows, size_t *points)
{
    const char *place = strstr(script, block);
    assert_non_null(place);
    double x[2], y[2], values[MADE_COLUMNS], a[2], b[2], worst2 = 0;
    int read = 0;
    size_t row = 0;
    assert_int_equal(sscanf(strstr(place, "set xrange"),
                            "set xrange [%lf:%lf]\nset yrange [%lf:%lf]", &x[0], &x[1], &y[0],
                            &y[1]),
                     4);
    place += strlen(block);
    assert_int_equal(sscanf(place, "%lf %lf\n%n", &a[0], &a[1], &read), 2);
    for (*points = 1; row < rows; *points += 1) {
        place += read;
        assert_int_equal(sscanf(place, "%lf %lf\n%n", &b[0], &b[1], &read), 2);
        double across = (b[0] - a[0]) / (x[1] - x[0]), up = (b[1] - a[1]) / (y[1] - y[0]);
        for (; row < rows; row++) {
            made_row(row, values);
            if (values[0] * 1e3 > b[0] + 1e-9)
                break;
            double px = (values[0] * 1e3 - a[0]) / (x[1] - x[0]),
                   py = (values[column] * factor - a[1]) / (y[1] - y[0]),
                   cross = px * up - py * across;
            worst2 = fmax(worst2, cross * cross / (across * across + up * up));
        }
        a[0] = b[0];
        a[1] = b[1];
    }
    return sqrt(worst2);
}

static void test_curves_are_the_history(void **state)
{
    (void)state;
    char *script = script_of("tip");
    size_t points = 0;
    CHECK_BELOW("thinned tip.y from the history, share of the panel",
                farthest(script, "$p0c0 << EOD\n", 33, 1e3, 1605, &points), 1.0 / 3000);
    CHECK_WITHIN("points left of 1605", (double)points, 80, 200);
    CHECK_BELOW("thinned tip.yaw from the history, share of the panel",
                farthest(script, "$p1c1 << EOD\n", 36, 1e3, 1605, &points), 1.0 / 3000);
    free(script);
    script = script_of("travel");
    CHECK_BELOW("thinned rocket.s until it leaves, share of the panel",
                farthest(script, "$p0c0 << EOD\n", 41, 1, 1601, &points), 1.0 / 3000);
    free(script);
}

static void expect_in(const char *script, const char *const *expected, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!strstr(script, expected[i]))
            fail_msg("not in the script: %s", expected[i]);
}

static void test_instants_titles_and_names(void **state)
{
    (void)state;
    char *script = script_of("contact");
    static const char *const expected[] = {
        "set label \"Made-up launch, \\042in quotes\\042 and in \\047quotes\\047, ±1 %\" at screen",
        "set arrow from 3.3336, graph 0 to 3.3336, graph 1 ",
        "set arrow from 95.2, graph 0 to 95.2, graph 1 ",
        "set arrow from 127.3, graph 0 to 127.3, graph 1 ",
        "set label 'ignition' at graph ",
        "set label 'release' at graph ",
        "to 3.3336, graph 1 nohead lw 1 lc",
        "set label 'middle' at graph ",
        "$p0c0 using 1:2 with lines ls 1 title 'rear'",
        "$p0c1 using 1:2 with lines ls 2 title 'middle'",
        "$p0c2 using 1:2 with lines ls 3 title 'front'",
        "set label 'force [kN]' at screen",
        "set label 'time from ignition [ms]' at screen",
    };
    expect_in(script, expected, sizeof expected / sizeof *expected);
    free(script);
}

// Colours distinguish the runs, dashes the columns; the legend names both.
static void test_several_runs(void **state)
{
    (void)state;
    char *script = script_of_runs("tip", 2, NAN);
    static const char *const expected[] = {
        "set label 'the one' at screen",
        "set label \"the other\\047s\" at screen",
        "$p0c0 using 1:2 with lines ls 1 dt solid notitle",
        "$p0c1 using 1:2 with lines ls 2 dt solid notitle",
        "$p0c2 using 1:2 with lines ls 1 dt (8,4) notitle",
        "$p0c3 using 1:2 with lines ls 2 dt (8,4) notitle",
        "keyentry with lines lw 1.5 lc rgb '#303030' dt solid title 'y'",
        "keyentry with lines lw 1.5 lc rgb '#303030' dt (8,4) title 'z'",
    };
    expect_in(script, expected, sizeof expected / sizeof *expected);
    assert_null(strstr(script, "Made-up launch"));
    free(script);
}

// The terminal of a style, its colours, one panel or two in a row, dashes; a paper's page has no
// title.
static void check_style(const char *name, double metres, bool title, bool two,
                        const char *const *expected, size_t count)
{
    style = name;
    width = metres;
    char *script = script_of("tip");
    style = NULL;
    width = 0;
    expect_in(script, expected, count);
    assert_int_equal(strstr(script, "Made-up launch") != NULL, title);
    double first = 0, second = 0;
    const char *margin = strstr(script, "set lmargin at screen ");
    assert_int_equal(sscanf(margin, "set lmargin at screen %lf", &first), 1);
    margin = strstr(margin + 1, "set lmargin at screen ");
    assert_int_equal(sscanf(margin, "set lmargin at screen %lf", &second), 1);
    CHECK_NEAR("left ends of two panels apart, of the page", second - first, two ? 0.5 : 0, 1e-5);
    free(script);
}

// Letters and lines of a pdf in pixels of 1/96 inch, which are 3/4 of a point, or of one point.
static void test_pdf_is_to_scale(void **state)
{
    (void)state;
    for (int measured = 0; measured < 2; measured++) {
        char text[1024] = "";
        const plot_style *look = plot_style_find(measured ? "paper" : NULL, NULL);
        FILE *script = fmemopen(text, sizeof text, "w");
        plot_begin(script, PLOT_PDF, look, plot_width(look, 0), 480);
        fclose(script);
        assert_non_null(
            strstr(text, measured ? " size 3.3071in,5.0000in " : " size 13.8889in,6.6667in "));
        assert_non_null(strstr(text, measured ? " fontscale 0.5625 linewidth 1.5 "
                                              : " fontscale 0.75 linewidth 1 "));
    }
}

static void test_styles(void **state)
{
    (void)state;
    static const char *const screen[] = {"svg size 1000,308 ", "background '#ffffff'",
                                         "lc rgb '#0072B2'",
                                         "$p0c1 using 1:2 with lines ls 2 title 'z'"};
    static const char *const dark[] = {"svg size 1000,308 ", "background '#1b2025'",
                                       "lc rgb '#56B4E9'", "textcolor rgb '#e6eaee'",
                                       "tc rgb '#e6eaee' center rotate by 90"};
    static const char *const paper[] = {"svg size 317,480 ", "background '#ffffff'",
                                        "$p0c0 using 1:2 with lines ls 1 dt solid title 'y'",
                                        "$p0c1 using 1:2 with lines ls 2 dt (8,4) title 'z'"};
    static const char *const wide[] = {"svg size 680,240 "};
    check_style(NULL, 0, true, true, screen, sizeof screen / sizeof *screen);
    check_style("dark", 0, true, true, dark, sizeof dark / sizeof *dark);
    check_style("paper", 0, false, false, paper, sizeof paper / sizeof *paper);
    check_style("paper", 0.18, false, true, wide, 1);
    CHECK_NEAR("84 mm in pixels of 1/96 inch", plot_width(plot_style_find("paper", NULL), 0),
               84 / 25.4 * 96, 1e-9);
}

// A diagram for each adaptor, and no more.
static void test_each_of_a_kind(void **state)
{
    (void)state;
    char *script = script_of("contact-force");
    static const char *const expected[] = {"set label 'Adaptor rear' at",
                                           "set label 'Adaptor middle' at",
                                           "set label 'Adaptor front' at", "$p2c0 << EOD\n"};
    expect_in(script, expected, sizeof expected / sizeof *expected);
    assert_null(strstr(script, "$p3c0"));
    free(script);
}

// On surfaces the words are guide and shoe; names that users gave stay.
static void test_words_on_surfaces(void **state)
{
    (void)state;
    char *script = script_with("contact-force", 1, NAN, true);
    assert_non_null(strstr(script, "set label 'Shoe rear' at"));
    free(script);
    script = script_with("travel", 1, NAN, true);
    assert_non_null(strstr(script, "set label 'Travel of the rocket along the guide' at"));
    assert_non_null(strstr(script, "title 'relative to the guide'"));
    free(script);
}

// The first time [ms] of a curve that is drawn.
// ---- names of instants ----

// A case of labels.txt: what was said of it, its names with what they ought to become.
typedef struct label_case {
    bool on_line;
    double given[5], others[8][2], wanted[8][5];
    size_t names, other_count;
} label_case;

static void check_case(const label_case *one)
{
    label_on_line line[8] = {0};
    label_beside beside[8] = {0};
    const double *given = one->given;
    for (size_t i = 0; i < one->names; i++) {
        const double *name = one->wanted[i];
        line[i] = (label_on_line){.at = name[0], .width = name[1], .rank = (int)name[2]};
        beside[i] = (label_beside){.x = name[0], .y = name[1], .width = name[2]};
    }
    if (one->on_line)
        labels_place_on_line(line, one->names, given[0], given[1], given[2]);
    else
        labels_place_beside(beside, one->names, given[0],
                            &(label_box){given[1], given[2], given[3], given[4]}, one->others,
                            one->other_count);
    for (size_t i = 0; i < one->names; i++) {
        const double *wanted = one->wanted[i] + 3;
        double left = one->on_line ? line[i].left : beside[i].placed ? beside[i].box.left : NAN;
        double top = beside[i].placed ? beside[i].box.top : 0;
        bool fine = left == wanted[0] && (one->on_line || top == wanted[1]);
        if (isnan(wanted[0]) ? !isnan(left) : !fine)
            fail_msg("name %zu of %s %g: left %g, top %g instead of %g, %g", i + 1,
                     one->on_line ? "line" : "beside", given[0], left, top, wanted[0], wanted[1]);
    }
}

// The rule of the reports in the browser, in the cases that tests/report/labels.mjs has, too.
static void test_names_stand_as_in_the_browser(void **state)
{
    (void)state;
    FILE *file = fopen(LD_SOURCE_DIR "/tests/figures/labels.txt", "r");
    assert_non_null(file);
    char text[256];
    label_case one = {0};
    int cases = 0;
    while (fgets(text, sizeof text, file)) {
        double at[5] = {NAN, NAN, NAN, NAN, NAN}; // 'none' leaves what follows
        char word[8] = "";
        int found =
            sscanf(text, "%7s %lf %lf %lf %lf %lf", word, &at[0], &at[1], &at[2], &at[3], &at[4]);
        if (strcmp(word, "name") == 0) {
            assert_true(found >= 4 && one.names < 8);
            memcpy(one.wanted[one.names++], at, sizeof at);
        } else if (strcmp(word, "other") == 0) {
            memcpy(one.others[one.other_count++], at, sizeof *one.others);
        } else if (strcmp(word, "line") == 0 || strcmp(word, "beside") == 0) {
            check_case(&one);
            one = (label_case){.on_line = *word == 'l'};
            memcpy(one.given, at, sizeof at);
            cases++;
        }
    }
    check_case(&one);
    fclose(file);
    CHECK_WITHIN("cases of names", cases, 20, 40);
}

static void expect_marks(const plot_marks *marks, const plot_mark *expected, size_t count)
{
    assert_int_equal(marks->count, count);
    for (size_t i = 0; i < count; i++) {
        const plot_mark *mark = &marks->mark[i];
        assert_string_equal(mark->name, expected[i].name);
        assert_true(fabs(mark->t - expected[i].t) < 1e-12);
        assert_int_equal(mark->rank, expected[i].rank);
        assert_int_equal(mark->rocket, expected[i].rocket);
        assert_int_equal(mark->figures, expected[i].figures);
    }
}

// A flight of 11 rows a second apart, of rows as they stand; its parachutes by their names.
static void test_marks_of_a_flight(void **state)
{
    (void)state;
    enum { ROWS = 11, IN = 1 << PLOT_FLIGHT };
    char t[] = "t", thrust[] = "thrust";
    char *names[] = {t, thrust};
    double value[2][ROWS] = {{0}, {0, 9, 9, 0, 9, 0, 0, 0, 0, 0, 0}};
    for (int i = 0; i < ROWS; i++)
        value[0][i] = 2 + i;
    history_data flight = {.rows = ROWS,
                           .columns = 2,
                           .name = names,
                           .value = &value[0][0],
                           .t_ignition = 1,
                           .t_rear = 1.25,
                           .t_apogee = 6.5,
                           .t_impact = 11,
                           .opening = {{"main", 9}, {"drogue", 6.25}},
                           .openings = 2};
    static const plot_mark expected[] = {{"exit", 1.25, 0, 0, IN},   {"burnout", 6, 2, 0, IN},
                                         {"drogue", 6.25, 2, 0, IN}, {"apogee", 6.5, 1, 0, IN},
                                         {"main", 9, 2, 0, IN},      {"landing", 11, 0, 0, IN}};
    static plot_marks marks;
    plot_find_marks(&flight, true, &marks);
    expect_marks(&marks, expected, 6);
    value[1][ROWS - 1] = 9;
    plot_find_marks(&flight, true, &marks);
    assert_int_equal(marks.count, 5);
    assert_string_equal(marks.mark[1].name, "drogue");
}

// Each rocket's from the first one's ignition, with its number where there are several.
static void test_marks_of_a_sequence(void **state)
{
    (void)state;
    enum { IN = 1 << PLOT_LAUNCH, BOTH = IN | 1 << PLOT_VEHICLE };
    history_data rocket[] = {
        {.t_ignition = 0.5, .t_release = 0.01, .t_front = 0.03, .t_middle = 0.04, .t_rear = 0.05},
        {.t_ignition = 1.5, .t_release = 0.02, .t_front = 0.06, .t_middle = NAN, .t_rear = 0.08}};
    history_data launch = {.t_ignition = 0.5, .rocket = rocket, .rockets = 2};
    static const plot_mark two[] = {
        {"ignition 1", 0, 0, 0, BOTH}, {"release 1", 0.01, 2, 0, IN}, {"front 1", 0.03, 3, 0, IN},
        {"middle 1", 0.04, 4, 0, IN},  {"rear 1", 0.05, 1, 0, BOTH},  {"ignition 2", 1, 0, 1, BOTH},
        {"release 2", 1.02, 2, 1, IN}, {"front 2", 1.06, 3, 1, IN},   {"rear 2", 1.08, 1, 1, BOTH}};
    static const plot_mark one[] = {{"ignition", 0, 0, 0, BOTH},
                                    {"release", 0.01, 2, 0, IN},
                                    {"front", 0.03, 3, 0, IN},
                                    {"middle", 0.04, 4, 0, IN},
                                    {"rear", 0.05, 1, 0, BOTH}};
    static plot_marks marks;
    plot_find_marks(&launch, false, &marks);
    expect_marks(&marks, two, 9);
    launch.rockets = 1;
    plot_find_marks(&launch, false, &marks);
    expect_marks(&marks, one, 5);
    marks.count = 2;
    char text[256] = "";
    FILE *json = fmemopen(text, sizeof text, "w");
    plot_write_marks(json, &marks);
    fclose(json);
    assert_string_equal(
        text, "[{\"name\":\"ignition\",\"t\":0,\"rank\":0,\"rocket\":0,\"figures\":[\"launch\","
              "\"vehicle\"]},{\"name\":\"release\",\"t\":0.01,\"rank\":2,\"rocket\":0,"
              "\"figures\":[\"launch\"]}]");
    launch.rockets = 0;
    plot_find_marks(&launch, false, &marks);
    assert_int_equal(marks.count, 0);
}

static double first_time(const char *script)
{
    double x = NAN;
    const char *block = "$p0c0 << EOD\n";
    assert_int_equal(sscanf(strstr(script, block) + strlen(block), "%lf", &x), 1);
    return x;
}

static void test_window_of_time(void **state)
{
    (void)state;
    char *whole = script_of("tip"), *part = script_of_runs("tip", 1, 0.08);
    CHECK_WITHIN("first time drawn of all [ms]", first_time(whole), 0, 0);
    CHECK_WITHIN("first time drawn from 80 ms on [ms]", first_time(part), 80, 80.1);
    free(whole);
    free(part);
}

static void test_every_figure_in_every_format(void **state)
{
    (void)state;
    ld_error error = {0};
    static const struct {
        const char *file, *magic;
    } formats[] = {{"all.svg", "<?xml"}, {"all.pdf", "%PDF-"}, {"all.PNG", "\x89PNG\r"}};
    for (size_t i = 0; i < 3; i++) {
        char start[6] = "";
        if (plot(in("run"), "all", in(formats[i].file), &error))
            fail_msg("%s", error.text);
        FILE *file = fopen(in(formats[i].file), "r");
        assert_non_null(fgets(start, sizeof start, file));
        fclose(file);
        assert_memory_equal(start, formats[i].magic, 5);
    }
    assert_int_equal(run("rsvg-convert %s >/dev/null", in("all.svg")), 0);
    assert_int_equal(run("test \"$(ls %s)\" = 'all.PNG\nall.pdf\nall.svg\nrun'", folder), 0);
}

// The rates that belong to the angles of the figure before, not components of the angular velocity.
static void test_relative_rates_are_of_the_angles(void **state)
{
    (void)state;
    static const char *const rate[] = {"rocket.psi_dot", "rocket.theta_dot", "rocket.gamma_dot"};
    const plot_figure *figure = plot_figure_find("relative-rate");
    for (int i = 0; i < 3; i++) {
        assert_string_equal(figure->panel[i].curve[0].column, rate[i]);
        assert_null(figure->panel[i].curve[1].column);
    }
    assert_null(figure->panel[3].title);
}

// A run that ended before its first row, or has none of the columns, draws empty panels.
static void test_nothing_to_show(void **state)
{
    (void)state;
    const char *figures[] = {"contact", "phase", "chassis"};
    const ld_column t = {"t", "s", "time"};
    ld_error error = {0};
    for (int rows = 0; rows < 2; rows++) {
        history_hdf5 *history;
        mkdir(in("few"), 0777);
        assert_int_equal(history_hdf5_create(in("few/history.h5"), "few", &history, NULL), LD_OK);
        assert_int_equal(history_hdf5_begin(history, &t, 1, NULL), LD_OK);
        for (int i = 0; i < rows; i++)
            assert_int_equal(history_hdf5_row(history, &(double){0}, NULL), LD_OK);
        assert_int_equal(history_hdf5_close(history, NULL, NULL), LD_OK);
        for (int i = 0; i < 3; i++)
            if (plot(in("few"), figures[i], in("few.svg"), &error))
                fail_msg("%s", error.text);
    }
    assert_int_equal(plot(in("few"), "all", in("few.svg"), &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "no figure shows a column of these results");
}

static void expect(const char *where, const char *figure, const char *file, ld_status status,
                   const char *text)
{
    ld_error error = {0};
    assert_int_equal(plot(where, figure, file, &error), status);
    if (!strstr(error.text, text))
        fail_msg("\"%s\" does not say \"%s\"", error.text, text);
    printf("    %s\n", error.text);
}

static void test_what_can_be_wrong(void **state)
{
    (void)state;
    expect(
        in("run"), "tipp", in("x.svg"), LD_ERR_INPUT,
        "unknown figure \"tipp\" (did you mean tip?); expected one of travel, contact, relative, ");
    expect(in("run"), "spaghetti", in("x.svg"), LD_ERR_INPUT,
           "unknown figure \"spaghetti\"; expected one of");
    expect(in("run"), "tip", in("x.jpg"), LD_ERR_INPUT, "ends in .svg, .pdf or .png");
    expect(in("run"), "tip", in("none/x.svg"), LD_ERR_FILE, "No such file or directory");
    expect(in("none"), "tip", in("x.svg"), LD_ERR_INPUT, "there is no history.h5");
    const char *figure = "tip", *run_folder = in("run");
    ld_picture picture = {&run_folder, 1, &figure, 1, .from = 0.1, .to = 0.05};
    ld_error error = {0};
    assert_int_equal(ld_plot(&picture, in("x.svg"), &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "there is nothing to draw from 100 ms to 50 ms");
    picture.folder_count = 9;
    assert_int_equal(ld_plot(&picture, in("x.svg"), &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "expected 1 to 8 folders with results");
    picture = (ld_picture){&run_folder, 1, &figure, 1, .from = NAN, .to = NAN, .style = "papr"};
    assert_int_equal(ld_plot(&picture, in("x.svg"), &error), LD_ERR_INPUT);
    assert_string_equal(
        error.text, "unknown style \"papr\" (did you mean paper?); expected screen, dark or paper");
    picture.style = "paper";
    picture.width = 0.01;
    assert_int_equal(ld_plot(&picture, in("x.svg"), &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "found a width of 10 mm, expected 50 mm to 500 mm");
    assert_int_not_equal(access(in("x.svg"), F_OK), 0);
    const char *many[32];
    for (size_t i = 0; i < 32; i++)
        many[i] = "tip";
    run_folder = in("run");
    picture = (ld_picture){&run_folder, 1, many, 32, .from = NAN, .to = NAN, .style = "paper"};
    assert_int_equal(ld_plot(&picture, in("x.png"), &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "dots high, more than 32767: name fewer with --what, or"));
    assert_int_not_equal(access(in("x.png"), F_OK), 0);
}

// Another gnuplot, or none, in PATH; an earlier picture stays.
static void test_without_gnuplot(void **state)
{
    (void)state;
    char *path = strdup(getenv("PATH"));
    assert_int_equal(plot(in("run"), "tip", in("x.svg"), NULL), LD_OK);
    assert_int_equal(run("cd %s && cp x.svg before", folder), 0);
    setenv("PATH", folder, 1);
    expect(in("run"), "tip", in("x.svg"), LD_ERR_MISSING,
           "gnuplot not found: install it (Debian: apt install gnuplot-nox)");
    FILE *script = fopen(in("gnuplot"), "w");
    fputs("#!/bin/sh\necho 'line 7: it cannot' >&2\necho >&2\nexit 1\n", script);
    fclose(script);
    chmod(in("gnuplot"), 0755);
    expect(in("run"), "tip", in("x.svg"), LD_ERR_FILE, "gnuplot failed: line 7: it cannot");
    setenv("PATH", path, 1);
    free(path);
    assert_int_equal(run("cd %s && cmp x.svg before", folder), 0);
    assert_int_not_equal(access(in("x.svg.part"), F_OK), 0);
}

// A gnuplot that has no memory for one of the lines of data, which it then leaves out.
static void test_short_of_memory(void **state)
{
    (void)state;
    char *path = strdup(getenv("PATH")), *first = malloc(strlen(path) + sizeof folder + 8);
    FILE *script = fopen(in("gnuplot"), "w");
    fprintf(script, "#!/bin/sh\nPATH='%s'\nsed '0,/^[-0-9.]* [-0-9.]*$/{//d}' | gnuplot \"$@\"\n",
            path);
    fclose(script);
    chmod(in("gnuplot"), 0755);
    sprintf(first, "%s:%s", folder, path);
    setenv("PATH", first, 1);
    expect(in("run"), "tip", in("x.svg"), LD_ERR_FILE, "no memory for a curve");
    setenv("PATH", path, 1);
    free(path);
    free(first);
    assert_int_not_equal(access(in("x.svg"), F_OK), 0);
}

// What gnuplot takes a quoted text for is the text.
static void test_quoted_texts(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "plain",  "'begins",  "it''s",         "it's",    "ends'",
        "'",      "''''",     "'`echo x` $x",  "`date`",  "'@x \\n ",
        "\\n 'a", "{a_b^c}'", "\"both\" '±µ'", "a \"b\"",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char line[160];
        FILE *script = fopen(in("quoted"), "w");
        fputs("x = 'expanded'\nset print '-'\nprint ", script);
        plot_write_quoted(script, texts[i]);
        fputs("\n", script);
        fclose(script);
        snprintf(line, sizeof line, "gnuplot --default-settings %s", in("quoted"));
        FILE *printed = popen(line, "r"); // NOLINT(cert-env33-c)
        assert_non_null(printed);
        line[fread(line, 1, sizeof line - 1, printed)] = '\0';
        assert_int_equal(pclose(printed), 0);
        line[strcspn(line, "\n")] = '\0';
        assert_string_equal(line, texts[i]);
    }
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, set_up, scratch_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_curves_are_the_history),
        TEST(test_instants_titles_and_names),
        TEST(test_several_runs),
        TEST(test_each_of_a_kind),
        TEST(test_styles),
        TEST(test_pdf_is_to_scale),
        TEST(test_words_on_surfaces),
        TEST(test_names_stand_as_in_the_browser),
        TEST(test_marks_of_a_flight),
        TEST(test_marks_of_a_sequence),
        TEST(test_window_of_time),
        TEST(test_every_figure_in_every_format),
        TEST(test_nothing_to_show),
        TEST(test_what_can_be_wrong),
        TEST(test_without_gnuplot),
        TEST(test_short_of_memory),
        TEST(test_quoted_texts),
        cmocka_unit_test(test_relative_rates_are_of_the_angles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
