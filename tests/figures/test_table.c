// The table of figures: each column that it names is there, each axis has the factor from its
// columns' unit to the unit written at it, and gnuplot and the report get the same figures.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "base/text_file.h"
#include "figures/plot.h"
#include "flight/flight_history.h"
#include "flight/free_flight.h"
#include "model/units.h"
#include "scenario/scenario.h"
#include "state/simulation.h"
#include "support/reference_model.h"

// What a figure may show: the columns of launches from a vehicle and from a base of bodies, or of a
// flight.
typedef struct shown_columns {
    const ld_column *column;
    size_t count;
} shown_columns;

static ld_model model;
static ld_simulation *simulation, *of_bodies;
static ld_model bodies;
static quantity_columns of_flight;
static shown_columns launch, in_flight;

// The columns of both launches.
static int add_bodies(void)
{
    ld_messages messages;
    const ld_column *part[2];
    size_t count[2];
    if (scenario_read(LD_SOURCE_DIR "/tests/data/multibody/launcher.yaml", NULL, 0, &bodies,
                      &messages) ||
        ld_simulation_create(&bodies, &of_bodies, NULL))
        return -1;
    count[0] = ld_simulation_columns(simulation, &part[0]);
    count[1] = ld_simulation_columns(of_bodies, &part[1]);
    ld_column *all = calloc(count[0] + count[1], sizeof *all);
    if (!all)
        return -1;
    for (int i = 0; i < 2; i++)
        memcpy(all + i * count[0], part[i], count[i] * sizeof *all);
    launch = (shown_columns){all, count[0] + count[1]};
    return 0;
}

static int set_up(void **state)
{
    (void)state;
    flight_system flight = {.earth = {.flat = true}, .canopies = true};
    reference_vehicle(&model, 5);
    model.tubes.station_count = 1;
    model.tubes.station[0].at = 1;
    model.tubes.pressure = (ld_pressure){.present = true,
                                         .form = LD_PRESSURE_OF_GAS,
                                         .pressure = 2e5,
                                         .volume = 1,
                                         .exponent = 1.4,
                                         .scale = 1};
    reference_recoil(&model);
    if (ld_simulation_create(&model, &simulation, NULL) ||
        flight_columns(&flight, &of_flight, NULL))
        return -1;
    if (add_bodies())
        return -1;
    in_flight = (shown_columns){of_flight.column, (size_t)of_flight.count};
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    ld_simulation_free(simulation);
    ld_simulation_free(of_bodies);
    free((ld_column *)launch.column);
    model_clear(&bodies);
    quantity_columns_free(&of_flight);
    reference_model_free(&model);
    return 0;
}

static const shown_columns *columns_of(const plot_figure *figure)
{
    return figure->time == PLOT_FLIGHT ? &in_flight : &launch;
}

// ---- columns and units ----

// The unit as scenarios have it; "" of plain numbers.
static void unit_of(const char *written, char unit[32])
{
    snprintf(unit, 32, "%s", strcmp(written, "1") == 0 ? "" : written);
    char *cube = strstr(unit, "³");
    if (cube)
        memcpy(cube, "3", 2);
    for (char *blank = unit; (blank = strchr(blank, ' '));)
        *blank = '.';
}

// The columns that the name or pattern fits; returns how many.
static int check_axis(const shown_columns *columns, const char *figure, const char *pattern,
                      const plot_axis *axis)
{
    int axes = 0;
    char text[64], unit[32], own[32], unknown[32];
    for (size_t i = 0; i < columns->count; i++) {
        double into = 1;
        const char *name = columns->column[i].name;
        if (!plot_column_matches(name, pattern, text, sizeof text))
            continue;
        unit_of(columns->column[i].unit, own);
        unit_of(axis->unit.name, unit);
        bool either = strstr(unit, ".or.") && strcmp(own, "") == 0; // of a drive, by its joint
        if (either)
            into = axis->unit.factor;
        else if (strcmp(own, unit) != 0 && units_factor(own, unit, &into, unknown) != UNITS_OK)
            fail_msg("%s: %s [%s] at an axis in %s", figure, name, own, axis->unit.name);
        if (!(fabs(axis->unit.factor / into - 1) < 1e-13))
            fail_msg("%s: factor %g of %s, not %g", figure, axis->unit.factor, name, into);
        axes++;
    }
    if (axes == 0)
        fail_msg("%s: there is no column %s", figure, pattern);
    return axes;
}

static void test_columns_and_factors(void **state)
{
    (void)state;
    int axes = 0;
    const plot_figure *figure;
    for (size_t f = 0; (figure = plot_figure_at(f)) != NULL; f++)
        for (int i = 0; i < PLOT_PANELS && figure->panel[i].title; i++) {
            const plot_panel *panel = &figure->panel[i];
            for (const plot_curve *curve = panel->curve; curve->column; curve++)
                axes +=
                    check_axis(columns_of(figure), figure->about.name, curve->column, &panel->y);
            if (panel->x_column)
                axes +=
                    check_axis(columns_of(figure), figure->about.name, panel->x_column, &panel->x);
        }
    printf("    %d curves and axes\n", axes);
    assert_true(axes > 150);
}

// ---- gnuplot and the report ----

// A history of two rows with all these columns.
static history_data history_of(const shown_columns *columns)
{
    history_data history = {.rows = 2, .columns = columns->count};
    history.name = calloc(columns->count, sizeof *history.name);
    history.value = calloc(2 * columns->count, sizeof *history.value);
    for (size_t i = 0; i < columns->count; i++) {
        history.name[i] = strdup(columns->column[i].name);
        history.value[2 * i + 1] = 0.1;
    }
    return history;
}

static char *script_of(const plot_figure *figure, const history_data *history)
{
    char *text = NULL;
    size_t length = 0;
    FILE *script = open_memstream(&text, &length);
    const char *name = "run";
    plot_page page = {history, &name, 1, &figure, 1, NAN, NAN, plot_style_find(NULL, NULL), 1000};
    assert_int_equal(plot_write_script(script, &page, PLOT_SVG, NULL), LD_OK);
    fclose(script);
    return text;
}

// What stands between gnuplot's quotes, with them, up to the name of one of a kind.
static const char *quoted(const char *text)
{
    static char all[160];
    bool twice = strchr(text, '\'') != NULL; // then in double ones
    size_t length = 0;
    all[length++] = twice ? '"' : '\'';
    for (; *text && *text != '%'; text++)
        length +=
            (size_t)snprintf(all + length, 5, *text == '\'' ? "\\%03o" : "%c", (unsigned)*text);
    if (!*text)
        all[length++] = twice ? '"' : '\'';
    all[length] = '\0';
    return all;
}

// Continues in the text behind what is requested, which must be there.
static void find_next(const char **text, const char *figure, const char *format, const char *wanted)
{
    char all[256];
    snprintf(all, sizeof all, format, wanted);
    const char *found = strstr(*text, all);
    if (!found)
        fail_msg("%s: there is no %s after the parts before it", figure, all);
    *text = found + strlen(all);
}

// Title and axes of each panel, in their order; a panel for each of a kind has its own titles.
static void check_script(const plot_figure *figure, const char *script)
{
    const char *name = figure->about.name;
    char axis[64];
    for (int i = 0; i < PLOT_PANELS && figure->panel[i].title; i++) {
        const plot_panel *panel = &figure->panel[i];
        if (i == 0)
            find_next(&script, name, "set label %s", quoted(figure->about.description));
        find_next(&script, name, "set label %s", quoted(panel->title));
        plot_axis_text(&panel->y, axis, sizeof axis);
        find_next(&script, name, "set label '%s' at", axis);
        if (panel->x_column)
            plot_axis_text(&panel->x, axis, sizeof axis);
        find_next(&script, name, "set label '%s", panel->x_column ? axis : "time from ignition");
        for (const plot_curve *curve = panel->curve; curve->column && *curve->label; curve++)
            find_next(&script, name, " title '%s'", curve->label);
    }
    if (strstr(script, "nothing to show"))
        fail_msg("%s: a panel is empty", name);
}

static void check_json(const plot_figure *figure, const char **json)
{
    const char *name = figure->about.name;
    char axis[64];
    find_next(json, name, "{\"name\":\"%s\"", name);
    find_next(json, name, "\"title\":\"%s\"", figure->about.description);
    for (int i = 0; i < PLOT_PANELS && figure->panel[i].title; i++) {
        const plot_panel *panel = &figure->panel[i];
        find_next(json, name, "{\"title\":\"%s\"", panel->title);
        plot_axis_text(&panel->y, axis, sizeof axis);
        find_next(json, name, "\"y\":{\"text\":\"%s\"", axis);
        if (panel->x_column) {
            find_next(json, name, "\"x\":{\"column\":\"%s\"", panel->x_column);
            plot_axis_text(&panel->x, axis, sizeof axis);
            find_next(json, name, "\"text\":\"%s\"", axis);
        }
        for (const plot_curve *curve = panel->curve; curve->column; curve++) {
            find_next(json, name, "[\"%s\"", curve->column);
            find_next(json, name, ",\"%s\"]", curve->label);
        }
    }
}

static void test_both_get_all_figures(void **state)
{
    (void)state;
    char *json = NULL;
    size_t length = 0, figures = 0;
    FILE *stream = open_memstream(&json, &length);
    plot_write_json(stream);
    fclose(stream);
    const char *rest = json;
    history_data history = history_of(&launch), flight = history_of(&in_flight);
    history.flight = calloc(1, sizeof *history.flight);
    *history.flight = flight;
    history.flights = 1;
    const plot_figure *figure;
    for (; (figure = plot_figure_at(figures)) != NULL; figures++) {
        assert_ptr_equal(plot_figure_find(figure->about.name), figure);
        char *script = script_of(figure, &history);
        check_script(figure, script);
        check_json(figure, &rest);
        free(script);
    }
    printf("    %zu figures\n", figures);
    assert_true(figures >= 24);
    history_free(&history);
    free(json);
}

// Each has its line in the list of docs/command.md.
static void test_all_are_described(void **state)
{
    (void)state;
    char *text = NULL, line[64];
    size_t length = 0;
    const plot_figure *figure;
    assert_int_equal(
        text_file_read(LD_SOURCE_DIR "/docs/command.md", 1 << 20, &text, &length, NULL), LD_OK);
    for (size_t f = 0; (figure = plot_figure_at(f)) != NULL; f++) {
        snprintf(line, sizeof line, "\n- `%s`: ", figure->about.name);
        if (!strstr(text, line))
            fail_msg("docs/command.md does not describe %s", figure->about.name);
    }
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_columns_and_factors),
        cmocka_unit_test(test_both_get_all_figures),
        cmocka_unit_test(test_all_are_described),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
