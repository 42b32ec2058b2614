// The factor of every axis of every figure, in plots and reports, is that from its columns' unit to
// the unit written at it.
#include "report/report_parts.h"
#include "simulation/free_flight.h"
#include "simulation/simulation.h"
#include "support/check.h"
#include "support/reference_model.h"

#include "scenario/units.h"

// The unit of a label: in its brackets, or the whole of it; "" of plain numbers.
static void unit_of(const char *label, char unit[32])
{
    const char *from = strchr(label, '[');
    snprintf(unit, 32, "%s", from ? from + 1 : label);
    unit[strcspn(unit, "]")] = '\0';
    if (strcmp(unit, "1") == 0)
        unit[0] = '\0';
    char *cube = strstr(unit, "³");
    if (cube)
        memcpy(cube, "3", 2);
}

// The columns that a figure may show: of a launch, then of a flight.
static size_t all_columns(const ld_simulation *simulation, const flight_system *flight,
                          const ld_column **launch, ld_column in_flight[FLIGHT_MAX_COLUMNS],
                          size_t *count)
{
    *count = (size_t)flight_columns(flight, in_flight);
    return ld_history_columns(simulation, launch);
}

// Axes of the columns that the name or pattern fits; returns how many.
static int check_axis(const ld_column *columns, size_t count, const char *pattern,
                      const char *label, double factor)
{
    int axes = 0;
    char text[64], unit[32], own[32], unknown[32];
    unit_of(label, unit);
    for (size_t i = 0; i < count; i++) {
        double into = 1;
        if (!plot_column_matches(columns[i].name, pattern, text, sizeof text))
            continue;
        unit_of(columns[i].unit, own);
        if (strcmp(own, unit) != 0 &&
            units_factor(units_open(), own, unit, &into, unknown) != UNITS_OK)
            fail_msg("%s [%s] at an axis in %s", columns[i].name, own, label);
        if (!(fabs(factor / into - 1) < 1e-13))
            fail_msg("%s: factor %g to %s, not %g", columns[i].name, factor, label, into);
        axes++;
    }
    return axes;
}

static int check_figure(const plot_figure *figure, const ld_column *columns, size_t count)
{
    int axes = 0;
    for (const plot_panel *panel = figure->panel;
         panel < figure->panel + PLOT_PANELS && panel->title; panel++) {
        for (const plot_curve *curve = panel->curve; curve->column; curve++)
            axes += check_axis(columns, count, curve->column, panel->y_label, panel->y_factor);
        if (panel->x_column)
            axes += check_axis(columns, count, panel->x_column, panel->x_label, panel->x_factor);
    }
    return axes;
}

static void test_factors(void **state)
{
    (void)state;
    ld_model model;
    ld_simulation *simulation;
    const ld_column *launch;
    ld_column in_flight[FLIGHT_MAX_COLUMNS];
    size_t flight_count;
    reference_vehicle(&model, 5);
    assert_int_equal(ld_simulation_create(&model, &simulation, NULL), LD_OK);
    flight_system flight = {.earth = {.flat = true}};
    size_t count = all_columns(simulation, &flight, &launch, in_flight, &flight_count);
    int axes = 0;
    const ld_figure *about;
    const plot_figure *figure;
    for (size_t i = 0; (about = ld_figure_at(i)) != NULL; i++) {
        figure = plot_figure_find(about->name);
        bool flies = figure->time == PLOT_FLIGHT;
        axes += check_figure(figure, flies ? in_flight : launch, flies ? flight_count : count);
    }
    for (size_t i = 0; (figure = report_figure_at(true, i)) != NULL; i++)
        axes += check_figure(figure, in_flight, flight_count);
    printf("    %d curves and axes\n", axes);
    assert_true(axes > 100);
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_factors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
