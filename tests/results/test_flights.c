// Flights of made-up rockets in the results: history.h5, flights.csv, trajectories.kml, figures.
#include "model/model.h"
#include "support/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "figures/plot.h"
#include "scenario/scenario.h"
#include "support/made_launch.h"
#include "support/scratch.h"

enum { FLIGHTS = 2, ROWS = 1500, COLUMNS = 6 };

static const double degree = 0.017453292519943295;
static const ld_column columns[] = {
    {"t", "s", ""},        {"center.x", "m", ""},          {"center.z", "m", ""},
    {"altitude", "m", ""}, {"angle_of_attack", "rad", ""}, {"rocket.pitch", "rad", ""}};

static void made_flight_row(int rocket, int i, double row[COLUMNS])
{
    double t = 0.02 * i;
    row[0] = 10 * rocket + t;
    row[1] = 100 * t * rocket;
    row[2] = -30 * t;
    row[3] = 100 + t * (150 - 5 * t);
    row[4] = exp(-t);
    row[5] = 0.3 - 0.02 * t;
}

static void made_flying_model(ld_model *model)
{
    made_model(model);
    model->firing_count = FLIGHTS;
    model->firing[0].tube = 8;
    model->firing[1].tube = 9;
    model->environment.site =
        (ld_site){.latitude = 45 * degree, .longitude = 10 * degree, .altitude = 100};
}

static void write_rows(const ld_sink *sink, int rocket)
{
    for (int i = 0; i < ROWS; i++) {
        double row[COLUMNS];
        made_flight_row(rocket, i, row);
        assert_int_equal(sink->row(sink->self, row, COLUMNS, NULL), LD_OK);
    }
}

// A launch of two rockets whose flights are rows of this kind.
static void write_flights(const ld_model *model, const char *name)
{
    ld_summary summary;
    ld_output *output;
    made_summary(&summary, 1);
    summary.rocket_count = FLIGHTS;
    summary.rocket[1] = summary.rocket[0];
    summary.rocket[1].tube = 9;
    summary.rocket[1].t_ignition = 10;
    assert_int_equal(ld_output_open(in(name), model, true, &output, NULL), LD_OK);
    const ld_sink *sink = ld_output_sink(output);
    assert_int_equal(made_run(sink, 3, NULL), LD_OK);
    for (int rocket = 1; rocket <= FLIGHTS; rocket++) {
        assert_int_equal(sink->flight(sink->self, rocket, columns, COLUMNS, NULL), LD_OK);
        write_rows(sink, rocket);
    }
    assert_int_equal(ld_output_finish(output, &summary, NULL), LD_OK);
}

static void test_hdf5_has_a_table_for_each(void **state)
{
    (void)state;
    ld_model model;
    history_data read;
    int wrong = 0;
    made_flying_model(&model);
    write_flights(&model, "run");
    assert_int_equal(history_read(in("run/history.h5"), &read, NULL), LD_OK);
    assert_int_equal(read.rows, 3);
    assert_int_equal(read.flights, FLIGHTS);
    for (int rocket = 1; rocket <= FLIGHTS; rocket++) {
        const history_data *flight = &read.flight[rocket - 1];
        assert_int_equal(flight->rows, ROWS);
        assert_int_equal(flight->columns, COLUMNS);
        assert_int_equal(flight->tube, 7 + rocket);
        assert_true(flight->t_ignition == 10 * (rocket - 1));
        for (int i = 0; i < ROWS; i++) {
            double row[COLUMNS];
            made_flight_row(rocket, i, row);
            for (int j = 0; j < COLUMNS; j++)
                wrong += flight->value[j * ROWS + i] != row[j];
        }
    }
    CHECK_BELOW("values of the flights that differ", (double)wrong, 0.0);
    history_free(&read);
}

static void test_csv_names_the_rocket(void **state)
{
    (void)state;
    ld_model model;
    char line[512];
    int rows[FLIGHTS + 1] = {0};
    made_flying_model(&model);
    write_flights(&model, "run");
    FILE *file = fopen(in("run/flights.csv"), "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    assert_memory_equal(line, "rocket [1],t [s],center.x [m],", 30);
    while (fgets(line, sizeof line, file)) {
        double row[COLUMNS];
        int rocket = (int)strtol(line, NULL, 10);
        assert_in_range(rocket, 1, FLIGHTS);
        made_flight_row(rocket, rows[rocket]++, row);
        assert_true(strtod(strchr(line, ',') + 1, NULL) == row[0]);
    }
    fclose(file);
    assert_true(rows[1] == ROWS && rows[2] == ROWS);
}

// Longitude, latitude [deg] and altitude of row `i` of a line of the map.
static void place_on_map(const char *name, int rocket, int i, double place[3])
{
    char line[256], heading[64];
    snprintf(heading, sizeof heading, "<name>Rocket %d, tube %d</name>\n", rocket, 7 + rocket);
    FILE *file = fopen(in(name), "r");
    assert_non_null(file);
    do
        assert_non_null(fgets(line, sizeof line, file));
    while (strcmp(line, heading) != 0);
    do
        assert_non_null(fgets(line, sizeof line, file));
    while (strcmp(line, "<coordinates>\n") != 0);
    for (int row = 0; row <= i; row++)
        assert_non_null(fgets(line, sizeof line, file));
    assert_int_equal(sscanf(line, "%lf,%lf,%lf", &place[0], &place[1], &place[2]), 3);
    fclose(file);
}

static bool has_line(const char *name, const char *expected)
{
    char line[256];
    bool found = false;
    FILE *file = fopen(in(name), "r");
    assert_non_null(file);
    while (!found && fgets(line, sizeof line, file))
        found = strcmp(line, expected) == 0;
    fclose(file);
    return found;
}

// x to the north, z to the east: the arcs are those of the ellipsoid's radii of curvature, to the
// second order in the distance over the radius.
static void test_map_of_a_flat_earth(void **state)
{
    (void)state;
    ld_model model;
    double row[COLUMNS], place[3];
    made_flying_model(&model);
    model.environment.site.present = true;
    write_flights(&model, "run");
    double a = 6378137, e2 = 6.69437999014e-3, w = sqrt(1 - e2 / 2), M = a * (1 - e2) / (w * w * w),
           N = a / w;
    made_flight_row(2, 250, row);
    place_on_map("run/trajectories.kml", 2, 250, place);
    CHECK_BELOW("north of the site, from its arc [m]",
                fabs((place[1] - 45) * degree * (M + 100) - row[1]), 3e-3);
    CHECK_BELOW("east of the site, from its arc [m]",
                fabs((place[0] - 10) * degree * (N + 100) * sqrt(0.5) - row[2]), 3e-2);
    CHECK_BELOW("height [m]", fabs(place[2] - row[3]), 5.1e-4);
    assert_true(has_line(
        "run/trajectories.kml",
        "<name>Rocket 2, apogee 1125.0 m above ground, 1225.0 m above sea level</name>\n"));
    assert_int_equal(access(in("run/trajectories.kml.part"), F_OK), -1);
}

static void test_no_place_no_map(void **state)
{
    (void)state;
    ld_model model;
    made_flying_model(&model);
    model.environment.site.present = true;
    write_flights(&model, "run");
    assert_int_equal(access(in("run/trajectories.kml"), F_OK), 0);
    model.environment.site.present = false;
    write_flights(&model, "run"); // the earlier run's map goes
    assert_int_equal(access(in("run/trajectories.kml"), F_OK), -1);
}

// A flight alone, whose rows are the history, on an Earth that says itself where it is.
static void write_flight_alone(const char *name)
{
    static const ld_column on_earth[] = {
        {"t", "s", ""},        {"latitude", "rad", ""},        {"longitude", "rad", ""},
        {"altitude", "m", ""}, {"angle_of_attack", "rad", ""}, {"center.x", "m", ""}};
    ld_model model;
    ld_summary summary;
    ld_output *output;
    made_model(&model);
    made_summary(&summary, 1);
    model.base.kind = LD_BASE_NONE;
    model.environment.earth.kind = LD_EARTH_WGS84;
    assert_int_equal(ld_output_open(in(name), &model, false, &output, NULL), LD_OK);
    const ld_sink *sink = ld_output_sink(output);
    assert_int_equal(sink->begin(sink->self, on_earth, 6, NULL), LD_OK);
    const double row[] = {0, 0.5, -1.25, 9144, 0.1, 0}, later[] = {1, 0.5, -1.25, 9140, 0.1, 1};
    assert_int_equal(sink->row(sink->self, row, 6, NULL), LD_OK);
    assert_int_equal(sink->row(sink->self, later, 6, NULL), LD_OK);
    assert_int_equal(ld_output_finish(output, &summary, NULL), LD_OK);
}

static void test_flight_alone(void **state)
{
    (void)state;
    char expected[64];
    history_data read;
    write_flight_alone("alone");
    snprintf(expected, sizeof expected, "%.9f,%.9f,9144.000\n", -1.25 / degree, 0.5 / degree);
    assert_true(has_line("alone/trajectories.kml", expected));
    assert_int_equal(history_read(in("alone/history.h5"), &read, NULL), LD_OK);
    assert_int_equal(read.flights, 1);
    assert_int_equal(read.flight[0].rows, 2);
    history_free(&read);
    // the figures that are usual for it
    const char *run = in("alone");
    ld_picture picture = {.folder = &run, .folder_count = 1, .from = NAN, .to = NAN};
    assert_int_equal(ld_plot(&picture, in("alone.svg"), NULL), LD_OK);
}

static void assert_line(FILE *file, const char *expected)
{
    char line[256];
    assert_non_null(fgets(line, sizeof line, file));
    line[strcspn(line, "\n")] = '\0';
    assert_string_equal(line, expected);
}

// A real flight on the ellipsoid: the map line by line, its places those of the history's rows, the
// last that of the impact, heights above the ellipsoid and never a negative zero.
static void test_map_of_an_ellipsoid(void **state)
{
    (void)state;
    const char *const sets[] = {"environment.earth=wgs84", "title=A <small> & \"round\" one",
                                "environment.site={latitude: -35 deg, longitude: 150 deg}"};
    static ld_summary summary;
    ld_model model;
    ld_messages messages;
    ld_simulation *simulation;
    ld_output *output;
    history_data read;
    assert_int_equal(
        scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", sets, 3, &model, &messages), LD_OK);
    assert_int_equal(ld_simulation_create(&model, &simulation, NULL), LD_OK);
    assert_int_equal(ld_output_open(in("round"), &model, false, &output, NULL), LD_OK);
    const ld_run_options options = {.sink = ld_output_sink(output)};
    assert_int_equal(ld_simulation_run(simulation, &options, &summary, NULL), LD_OK);
    assert_int_equal(ld_output_finish(output, &summary, NULL), LD_OK);
    assert_int_equal(history_read(in("round/history.h5"), &read, NULL), LD_OK);
    FILE *file = fopen(in("round/trajectories.kml"), "r");
    assert_non_null(file);
    const char *const head[] = {
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>",
        "<kml xmlns=\"http://www.opengis.net/kml/2.2\">",
        "<Document>",
        "<name>A &lt;small&gt; &amp; \"round\" one</name>",
        "<Placemark>",
        "<name>Rocket 1, tube 1</name>",
        "<Style><LineStyle><color>ffb27200</color><width>2</width></LineStyle></Style>",
        "<LineString>",
        "<altitudeMode>absolute</altitudeMode>",
        "<coordinates>"};
    for (size_t i = 0; i < sizeof head / sizeof head[0]; i++)
        assert_line(file, head[i]);
    const double *latitude = history_column(&read, "latitude"),
                 *longitude = history_column(&read, "longitude"),
                 *altitude = history_column(&read, "altitude");
    char line[256], digits[64] = "";
    double worst = 0, place[3] = {0};
    for (size_t i = 0; i < read.rows; i++) {
        assert_non_null(fgets(line, sizeof line, file));
        assert_int_equal(sscanf(line, "%lf,%lf,%lf%63s", &place[0], &place[1], &place[2], digits),
                         3);
        worst = fmax(worst, 2e9 * fabs(place[0] - longitude[i] / degree));
        worst = fmax(worst, 2e9 * fabs(place[1] - latitude[i] / degree));
        worst = fmax(worst, 2e3 * fabs(place[2] - altitude[i]));
        assert_null(strstr(line, ",-0.000\n"));
    }
    CHECK_BELOW("places of rows, in halves of the last digit", worst, 1.01);
    const ld_final_state *final = &summary.rocket[0].final;
    CHECK_BELOW("impact [deg]",
                hypot(place[0] - final->longitude / degree, place[1] - final->latitude / degree),
                1e-9);
    CHECK_NEAR("altitude of the impact [m]", place[2], 0, 0);
    assert_line(file, "</coordinates>");
    assert_line(file, "</LineString>");
    assert_line(file, "</Placemark>");
    const ld_flight_summary *flight = &summary.rocket[0].flight;
    snprintf(line, sizeof line,
             "<name>Rocket 1, apogee %.1f m above ground, %.1f m above sea level</name>",
             flight->apogee, flight->apogee_altitude);
    assert_line(file, "<Placemark>");
    assert_line(file, line);
    assert_line(file, "<Point>");
    assert_line(file, "<altitudeMode>absolute</altitudeMode>");
    double highest[3];
    assert_non_null(fgets(line, sizeof line, file));
    assert_int_equal(sscanf(line, "<coordinates>%lf,%lf,%lf</coordinates>", &highest[0],
                            &highest[1], &highest[2]),
                     3);
    CHECK_NEAR("altitude of the apogee [m]", highest[2], flight->apogee_altitude, 5.1e-4);
    assert_line(file, "</Point>");
    assert_line(file, "</Placemark>");
    // where it ended, and when
    snprintf(digits, sizeof digits, "<name>Rocket 1, t = %.3f s</name>", final->t);
    assert_line(file, "<Placemark>");
    assert_line(file, digits);
    assert_line(file, "<Point>");
    assert_line(file, "<altitudeMode>absolute</altitudeMode>");
    snprintf(line, sizeof line, "<coordinates>%.9f,%.9f,%.3f</coordinates>", place[0], place[1],
             place[2]);
    assert_line(file, line);
    assert_line(file, "</Point>");
    assert_line(file, "</Placemark>");
    assert_line(file, "</Document>");
    assert_line(file, "</kml>");
    assert_null(fgets(line, sizeof line, file));
    fclose(file);
    history_free(&read);
    ld_simulation_free(simulation);
    model_clear(&model);
}

static const char *script_of(const history_data *history, size_t runs, const char *name)
{
    static const char *const names[] = {"the one", "the other"};
    const plot_figure *figure = plot_figure_find(name);
    plot_page page = {.run = history,
                      .style = plot_style_find(NULL, NULL),
                      .width = 1000,
                      .name = names,
                      .runs = runs,
                      .figure = &figure,
                      .figures = 1,
                      .from = NAN,
                      .to = NAN};
    static char text[1 << 18];
    memset(text, 0, sizeof text);
    FILE *script = fmemopen(text, sizeof text - 1, "w");
    assert_int_equal(plot_write_script(script, &page, PLOT_SVG, NULL), LD_OK);
    fclose(script);
    return text;
}

// A curve for each rocket, in its time from its own ignition.
static void test_figures_of_flights(void **state)
{
    (void)state;
    ld_model model;
    history_data read[2];
    double x[3], y[3], row[COLUMNS];
    made_flying_model(&model);
    write_flights(&model, "run");
    assert_int_equal(history_read(in("run/history.h5"), &read[0], NULL), LD_OK);
    assert_int_equal(history_read(in("run/history.h5"), &read[1], NULL), LD_OK);
    const char *script = script_of(read, 1, "flight");
    assert_non_null(strstr(script, "title 'rocket 1, tube 8'"));
    assert_non_null(strstr(script, "title 'rocket 2, tube 9'"));
    const char *block = strstr(script, "$p0c1 << EOD\n");
    assert_non_null(block);
    assert_int_equal(sscanf(block + 13, "%lf %lf", &x[0], &y[0]), 2);
    made_flight_row(2, 0, row);
    CHECK_BELOW("start of the second flight's altitude [s, m]",
                fabs(x[0] - (row[0] - 10)) + fabs(y[0] - row[3]), 0.0);
    script = script_of(read, 1, "trajectory");
    assert_non_null(block = strstr(script, "$p1c1 << EOD\n"));
    const char *end = strstr(block, "\n\nEOD\n");
    while (*--end != '\n')
        ;
    assert_int_equal(sscanf(end, "%lf %lf", &x[0], &y[0]), 2);
    made_flight_row(2, ROWS - 1, row);
    CHECK_BELOW("end of the second ground track [m]", hypot(x[0] - row[1], y[0] - row[2]), 0.0);
    // of several runs a colour each, and a dash for each rocket
    script = script_of(read, 2, "trajectory");
    assert_non_null(strstr(script, "$p0c3 << EOD\n"));
    assert_non_null(strstr(script, "'#303030' dt (8,4) title 'rocket 2, tube 9'"));
    history_free(&read[0]);
    history_free(&read[1]);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, scratch_make, scratch_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_hdf5_has_a_table_for_each),
        TEST(test_csv_names_the_rocket),
        TEST(test_map_of_a_flat_earth),
        TEST(test_no_place_no_map),
        TEST(test_flight_alone),
        TEST(test_map_of_an_ellipsoid),
        TEST(test_figures_of_flights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
