// Footprints as files: corners against the landings themselves, the three formats against each
// other, places on the Earth against radii of curvature and against points of the ellipsoid; what
// crosses the antimeridian, has a hole, or cannot be written.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/random.h"
#include "launchdyn/study_data.h"
#include "math/curves/distributions.h"
#include "studies/show/footprint_shape.h"
#include "support/study_run.h"

enum { SAMPLES = 300, MOST = 4000 };

static const double pi = 3.141592653589793;

static const char flight[] = "include: range-safety.yaml\nscatter: {samples: 300}\n";

static int make_study(void **state)
{
    if (scratch_make(state))
        return -1;
    ld_study *study = study_of(flight);
    study_run(study, "out", 2);
    ld_study_free(study);
    return 0;
}

static char *export(const char *study, const char *file)
{
    ld_error error = {0};
    char *text = calloc(1, 1 << 20);
    if (ld_study_export_footprint(in(study), in(file), &error))
        fail_msg("%s", error.text);
    FILE *stream = fopen(in(file), "r");
    assert_true(stream && text);
    assert_true(fread(text, 1, (1 << 20) - 1, stream) > 0);
    fclose(stream);
    return text;
}

static void expect_refused(const char *study, const char *file, const char *why)
{
    ld_error error = {0};
    assert_int_equal(ld_study_export_footprint(in(study), in(file), &error), LD_ERR_INPUT);
    if (!strstr(error.text, why))
        fail_msg("\"%s\" does not say \"%s\"", error.text, why);
    assert_int_equal(access(in(file), F_OK), -1);
}

// ---- CSV

typedef struct corner {
    int line, hole;
    double x, z;
} corner;

// Corners of a share of the kind in the table; how many.
static int read_corners(const char *csv, const char *kind, double share, corner *to)
{
    int count = 0;
    for (const char *line = strchr(csv, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
        char word[16];
        double of;
        corner c;
        if (sscanf(line, "1,%15[a-z],%lf,%*f,%*f,%*f,%*f,%*d,%d,%d,%lf,%lf", word, &of, &c.line,
                   &c.hole, &c.x, &c.z) == 6 &&
            strcmp(word, kind) == 0 && of == share && count < MOST)
            to[count++] = c;
    }
    return count;
}

// The corner after c of the same line.
static const corner *next_of(const corner *all, int count, int c)
{
    int first = c;
    while (first > 0 && all[first - 1].line == all[c].line)
        first--;
    return c + 1 < count && all[c + 1].line == all[c].line ? &all[c + 1] : &all[first];
}

static bool is_within(const corner *all, int count, double x, double z)
{
    bool inside = false;
    for (int i = 0; i < count; i++) {
        const corner *a = &all[i], *b = next_of(all, count, i);
        if ((a->z > z) != (b->z > z) && a->x + (z - a->z) / (b->z - a->z) * (b->x - a->x) > x)
            inside = !inside;
    }
    return inside;
}

static corner corners[MOST];

static double corners_area(int count)
{
    double area = 0;
    for (int i = 0; i < count; i++) {
        const corner *a = &corners[i], *b = next_of(corners, count, i);
        area += 0.5 * (a->x * b->z - b->x * a->z);
    }
    return area;
}

// The landings lie within as often as is said; area and farthest point are those of the table.
static void test_csv(void **state)
{
    (void)state;
    static const char *const names[] = {"downrange", "drift"};
    ld_error error;
    ld_study_data *data;
    const ld_study_values *values;
    const ld_study_footprint *region;
    char *text = export("out", "a.csv");
    int count = read_corners(text, "landings", 0.95, corners), within = 0;
    double area = corners_area(count), farthest = 0;
    for (int i = 0; i < count; i++)
        farthest = fmax(farthest, hypot(corners[i].x, corners[i].z));
    assert_int_equal(ld_study_data_open(in("out"), &data, &error), LD_OK);
    assert_int_equal(ld_study_data_values(data, 1, names, 2, &values, &error), LD_OK);
    assert_int_equal(values->count, SAMPLES);
    for (size_t i = 0; i < SAMPLES; i++)
        within += is_within(corners, count, values->value[0][i], values->value[1][i]);
    CHECK_WITHIN("landings within that of 95 % [%]", 100.0 * within / SAMPLES, 94, 98);
    assert_int_equal(ld_study_data_footprint(data, 1, 0.95, &region, &error), LD_OK);
    CHECK_NEAR("area", area / region->area.value, 1, 1e-12);
    CHECK_NEAR("farthest point", farthest / region->distance.value, 1, 1e-12);
    CHECK_WITHIN("area over that of a normal cloud's ellipse",
                 region->area.value / (pi * 5.9915 * 197 * 179), 0.85, 1.3);
    CHECK_NEAR("content, low, by its beta distribution",
               beta_cumulative(0.95 * 201, 0.05 * 201, region->content.low), 0.025, 1e-9);
    CHECK_NEAR("content, high", beta_cumulative(0.95 * 201, 0.05 * 201, region->content.high),
               0.975, 1e-9);
    assert_true(region->stated && region->independent == 300 && region->needed == 180);
    assert_int_equal(ld_study_data_footprint(data, 1, 0.999, &region, &error), LD_OK);
    assert_true(!region->stated && isnan(region->area.value) && isnan(region->content.low));
    assert_true(region->independent == 300 && region->needed == 9000);
    assert_non_null(strstr(text, "\n1,landings,0.99,,,900,300,,,,,\n"
                                 "1,landings,0.999,,,9000,300,,,,,\n"));
    assert_int_equal(ld_study_data_footprint(data, 1, 0.5, &region, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "they are of 0.95, 0.99 and 0.999"));
    assert_int_equal(ld_study_data_footprint(data, 2, 0.95, &region, &error), LD_ERR_INPUT);
    assert_null(region);
    ld_study_data_close(data);
    free(text);
}

// ---- of the line

static const char thrower[] =
    "include: flight.yaml\n"
    "environment: {wind: {speed: 3 m/s, heading: 90 deg}}\n"
    "rocket:\n"
    "  motor: {thrust: [[0 s, 0 N], [0.1 s, 1 N], [0.2 s, 0 N]]}\n"
    "  empty: {mass: 59.9 kg, center: 1.1 0 0 m, inertia: 0.22 24 24 kg.m2}\n"
    "  line: {length: 60 m, mass_per_length: 20 g/m, diameter: 4 mm, stiffness: 2 kN,\n"
    "         breaking_force: 1.5 kN, tension: 3 N, segments: 6, container: 1 0 2 m}\n"
    "flight: {ignition: 0 s, velocity: 25 15 0 m/s, attitude: {pitch: 30 deg}, rate: 0 0 0 rad/s}\n"
    "scatter:\n"
    "  samples: 120\n"
    "  factors:\n"
    "    flight.velocity.x: {normal: 4 m/s}\n"
    "    environment.wind.heading: {normal: 40 deg}\n"
    "    environment.wind.speed: {normal: 1 m/s}\n";

// That of all 12 places of each line, read one by one, a line a group.
static void test_line(void **state)
{
    (void)state;
    enum { LINES = 120, PLACES = 12 };
    static double x[LINES * PLACES], z[LINES * PLACES];
    static int64_t group[LINES * PLACES];
    static footprint of;
    ld_error error;
    ld_study_data *data;
    ld_study *study = study_of(thrower);
    study_run(study, "thrown", 2);
    char *text = export("thrown", "t.csv");
    assert_int_equal(ld_study_data_open(in("thrown"), &data, &error), LD_OK);
    for (int place = 0; place < PLACES; place++) {
        char name[2][16];
        const char *const names[] = {name[0], name[1]};
        const ld_study_values *values;
        snprintf(name[0], sizeof name[0], "line.%d.x", place + 1);
        snprintf(name[1], sizeof name[1], "line.%d.z", place + 1);
        assert_int_equal(ld_study_data_values(data, 1, names, 2, &values, &error), LD_OK);
        assert_int_equal(values->count, LINES);
        for (int i = 0; i < LINES; i++) {
            x[i * PLACES + place] = values->value[0][i];
            z[i * PLACES + place] = values->value[1][i];
            group[i * PLACES + place] = i;
        }
    }
    assert_int_equal(footprint_of(x, z, group, (size_t)(LINES * PLACES), &of), LD_OK);
    int count = read_corners(text, "line", 0.95, corners), within = 0;
    for (int i = 0; i < LINES * PLACES; i++)
        within += is_within(corners, count, x[i], z[i]);
    CHECK_WITHIN("places of lines within 95 % [%]", 100.0 * within / (LINES * PLACES), 93, 97);
    CHECK_NEAR("area of the line's footprint", corners_area(count) / of.region[0].area.value, 1,
               1e-12);
    CHECK_WITHIN("places of a line, worth independent ones", of.region[0].independent / LINES, 2,
                 3.5);
    char row[96];
    snprintf(row, sizeof row, "\n1,line,0.999,,,9000,%.17g,", of.region[2].independent);
    assert_non_null(strstr(text, row));
    assert_non_null(strstr(text, "\n1,landings,0.95,,,180,120,"));
    ld_study_data_close(data);
    ld_study_free(study);
    free(text);
}

// ---- on the Earth

// Numbers after a place in the text, in pairs, until `end`.
static int read_places(const char *from, const char *end, double (*to)[2])
{
    int count = 0;
    while (from < end && count < MOST) {
        char *after;
        double longitude = strtod(from, &after);
        if (after == from) {
            from++;
            continue;
        }
        to[count][0] = longitude;
        to[count++][1] = strtod(after + 1, &after);
        from = after + (strncmp(after, ",0 ", 3) == 0 ? 3 : 0);
    }
    return count;
}

// GeoJSON: closed rings against the clock's way, their corners where radii of curvature put those
// of the CSV file, in any order; KML has the same ones.
static void test_places(void **state)
{
    (void)state;
    static double json[MOST][2], kml[MOST][2];
    char *csv = export("out", "b.csv"), *geojson = export("out", "b.geojson");
    char *map = export("out", "b.kml");
    int count = read_corners(csv, "landings", 0.95, corners);
    const char *from = strstr(geojson, "[[[["), *to = strstr(from, "]]]]");
    int places = read_places(from, to, json);
    double s = sin(pi / 4), e2 = 6.69437999014e-3, w = 1 - e2 * s * s, off = 0, area = 0;
    double across = 6378137 / sqrt(w) * s, along = 6378137 * (1 - e2) / (w * sqrt(w));
    for (int i = 0; i < places; i++) {
        double e = (json[i][0] - 7) * pi / 180 * across, n = (json[i][1] - 45) * pi / 180 * along;
        double x = e * 0.5 + n * sqrt(0.75), z = e * sqrt(0.75) - n * 0.5, least = INFINITY;
        for (int k = 0; k < count; k++)
            least = fmin(least, hypot(corners[k].x - x, corners[k].z - z));
        off = fmax(off, least);
    }
    CHECK_NEAR("places on the Earth against radii of curvature [m]", off, 0, 1);
    const char *ring = strstr(from, "]]"); // of the first ring
    int first = read_places(from, ring + 1, json);
    for (int i = 0; i + 1 < first; i++)
        area += 0.5 * (json[i][0] * json[i + 1][1] - json[i + 1][0] * json[i][1]);
    assert_true(area > 0);
    assert_memory_equal(json[0], json[first - 1], sizeof json[0]);
    assert_non_null(strstr(geojson, "\"geometry\":null,\"properties\":{"
                                    "\"of\":\"landings\",\"share\":0.99,"));
    assert_non_null(strstr(geojson, "\"stated\":false,\"count\":300,\"independent\":300,"));
    const char *outline = strstr(map, "<outerBoundaryIs>");
    assert_int_equal(read_places(outline, strstr(outline, "</outer"), kml), first);
    assert_memory_equal(kml, json, (size_t)first * sizeof *kml);
    assert_non_null(strstr(map, "<name>99 % of landings</name>\n<description>too few landings: 900 "
                                "independent ones are needed, found 300"));
    free(csv);
    free(geojson);
    free(map);
}

// A ring of landings, some 3 km about a place 4 km east of the launch point; its middle is empty.
static footprint *ring_footprint(void)
{
    enum { COUNT = 9000 };
    static double x[COUNT], y[COUNT];
    static int64_t group[COUNT];
    static footprint of;
    for (int i = 0; i < COUNT; i++) {
        double angle = 2 * pi * random_uniform(41, 1, (uint64_t)i, 0, 0);
        double radius = 3000 + 400 * normal_quantile(random_uniform(41, 2, (uint64_t)i, 0, 0));
        x[i] = 4000 + radius * cos(angle);
        y[i] = radius * sin(angle);
        group[i] = i;
    }
    assert_int_equal(footprint_of(x, y, group, COUNT, &of), LD_OK);
    return &of;
}

static double area_of(const footprint_shape *shape)
{
    double sum = 0;
    for (size_t i = 0; i < shape->count; i++) {
        const footprint_line *line = &shape->line[i];
        for (size_t k = 0; k < line->count; k++) {
            const double *a = line->at[k], *b = line->at[(k + 1) % line->count];
            sum += 0.5 * ((a[0] - line->at[0][0]) * (b[1] - line->at[0][1]) -
                          (b[0] - line->at[0][0]) * (a[1] - line->at[0][1]));
        }
    }
    return sum;
}

static footprint_site site_at(double latitude, double longitude, int kind)
{
    static ld_model model;
    footprint_site site;
    bool there;
    memset(&model, 0, sizeof model);
    model.environment.earth.kind = (ld_earth_model)kind;
    model.environment.site = (ld_site){.present = true,
                                       .latitude = latitude * pi / 180,
                                       .longitude = longitude * pi / 180,
                                       .altitude = 200,
                                       .azimuth = pi / 2};
    model.environment.ground_height = kind == LD_EARTH_FLAT ? 0 : 200;
    assert_int_equal(footprint_site_of(&model, &site, &there), LD_OK);
    assert_true(there);
    return site;
}

static void test_hole(void **state)
{
    (void)state;
    footprint *of = ring_footprint();
    footprint_shape flat;
    assert_int_equal(footprint_shape_of(of, 0, &flat), LD_OK);
    assert_true(flat.count >= 2 && !flat.line[0].hole && flat.line[1].hole);
    CHECK_NEAR("area of a ring", area_of(&flat) / of->region[0].area.value, 1, 1e-12);
    CHECK_WITHIN("over that of 1.96 deviations to both sides",
                 area_of(&flat) / (4 * pi * 3000 * 1.96 * 400), 0.95, 1.1);
    footprint_shape_free(&flat);
}

// The same at the antimeridian: the parts have the area of the whole, and all longitudes are those
// of the globe; launches from either side.
static void test_antimeridian(void **state)
{
    (void)state;
    ld_error error;
    footprint *of = ring_footprint();
    footprint_shape flat, whole, parts;
    assert_int_equal(footprint_shape_of(of, 0, &flat), LD_OK);
    footprint_site site = site_at(20, 0, LD_EARTH_FLAT);
    assert_int_equal(footprint_shape_on_earth(&site, &flat, &whole, &error), LD_OK);
    assert_int_equal(whole.count, flat.count);
    for (int k = 0; k < 2; k++) {
        site = site_at(20, k ? -179.97 : 179.97, LD_EARTH_FLAT);
        if (k)
            for (size_t i = 0; i < flat.count; i++) // to the west
                for (size_t n = 0; n < flat.line[i].count; n++)
                    flat.line[i].at[n][0] *= -1;
        assert_int_equal(footprint_shape_on_earth(&site, &flat, &parts, &error), LD_OK);
        CHECK_NEAR("area of the parts over that of the whole", area_of(&parts) / area_of(&whole), 1,
                   1e-6);
        int east = 0, west = 0;
        for (size_t i = 0; i < parts.count; i++)
            for (size_t n = 0; n < parts.line[i].count; n++) {
                double longitude = parts.line[i].at[n][0];
                assert_true(fabs(longitude) <= 180 && fabs(longitude) > 179.8);
                east += longitude > 0;
                west += longitude < 0;
            }
        assert_true(east > 20 && west > 20 && !parts.line[0].hole);
        footprint_shape_free(&parts);
    }
    footprint_shape_free(&whole);
    footprint_shape_free(&flat);
}

// On a round Earth a corner is the point of the ground with its x and z of I.
static void test_round_earth(void **state)
{
    (void)state;
    ld_error error;
    footprint_shape flat, placed;
    double off = 0;
    assert_int_equal(footprint_shape_of(ring_footprint(), 0, &flat), LD_OK);
    for (size_t n = 0; n < flat.line[0].count; n++) // some 300 km away
        flat.line[0].at[n][0] *= 60;
    flat.line[0].at[0][1] += 1;
    footprint_site site = site_at(-35, 140, LD_EARTH_WGS84);
    footprint_shape one = {flat.line, 1};
    assert_int_equal(footprint_shape_on_earth(&site, &one, &placed, &error), LD_OK);
    for (size_t n = 0; n < placed.line[0].count; n++) {
        const double *at = placed.line[0].at[n];
        geodetic place = {at[1] * pi / 180, at[0] * pi / 180, 200};
        v3 r = v3_sub(earth_place(&site.globe, place), site.globe.r_site);
        v3 in_i = m3_apply_transposed(site.globe.A_EI, r);
        double least = INFINITY;
        for (size_t k = 0; k < flat.line[0].count; k++)
            least =
                fmin(least, hypot(flat.line[0].at[k][0] - in_i.x, flat.line[0].at[k][1] - in_i.z));
        off = fmax(off, least);
    }
    CHECK_NEAR("corner less the ground's x and z there [m]", off, 0, 1e-3);
    CHECK_WITHIN("area in degrees, against the clock", area_of(&placed), 0.1, 1);
    footprint_shape_free(&placed);
    // round a pole, beyond the horizon
    site = site_at(89.97, 0, LD_EARTH_WGS84);
    for (size_t n = 0; n < flat.line[0].count; n++) {
        flat.line[0].at[n][0] = flat.line[0].at[n][0] / 60 - 4000;
        flat.line[0].at[n][1] -= 3340;
    }
    assert_int_equal(footprint_shape_on_earth(&site, &one, &placed, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "encloses a pole"));
    flat.line[0].at[0][0] = 7e6;
    assert_int_equal(footprint_shape_on_earth(&site, &one, &placed, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "beyond the horizon"));
    footprint_shape_free(&flat);
}

// ---- what cannot be written

static void test_refused(void **state)
{
    (void)state;
    expect_refused("out", "a.txt", "a file of footprints ends in .csv, .kml or .geojson");
    expect_refused("out", ".kml/x", "ends in");
    expect_refused("nowhere", "c.csv", "nowhere");
    static const struct {
        const char *text, *file, *why;
    } cases[] = {
        {"include: range-safety.yaml\nscatter: {samples: 20}\n", "few.kml",
         "no footprint, not even of 95 %: too few landings: 180 independent ones are needed, found "
         "20"},
        {"include: range-safety.yaml\nscatter: {samples: 4}\nenvironment:\n  site:\n", "flat.kml",
         "requires a position on the Earth: the scenario has no environment.site; a .csv file"},
        {"include: range-safety.yaml\nscatter: {samples: 2}\nsweep: {environment.site.azimuth: [0 "
         "deg, 9 deg]}\n",
         "swept.geojson", "environment.site.azimuth differs from launch to launch"},
        {"include: range-safety.yaml\nscatter: {samples: 2}\n", "two.csv",
         "fewer than three rockets have landed"},
        {"include: fixed.yaml\nrun: {end: tip}\nscatter: {samples: 2, factors: {rocket.mass_error: "
         "{normal: 0.1 kg}}}\n",
         "tip.csv", "landed"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char name[16];
        snprintf(name, sizeof name, "c%zu", i);
        ld_study *study = study_of(cases[i].text);
        study_run(study, name, 2);
        expect_refused(name, cases[i].file, cases[i].why);
        ld_study_free(study);
    }
    ld_error error = {0};
    assert_int_equal(ld_study_export_footprint(in("out"), in("no/where.csv"), &error), LD_ERR_FILE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_csv),          cmocka_unit_test(test_line),
        cmocka_unit_test(test_places),       cmocka_unit_test(test_hole),
        cmocka_unit_test(test_antimeridian), cmocka_unit_test(test_round_earth),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, make_study, scratch_remove);
}
