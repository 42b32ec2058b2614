#include "report/report_study_scatter.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "quantities/study_results.h"
#include "report/report_study_numbers.h"
#include "results/json_text.h"
#include "studies/points/footprint.h"
#include "studies/statistics/normality.h"

// Bytes for what grows with the number of series; the rest of a report fits beside them.
enum { BYTES_OF_POINTS = 400000, BYTES_OF_A_POINT = 40, MOST_POINTS = 2000 };

typedef struct contour_writer {
    FILE *json;
    bool any;
} contour_writer;

// What is drawn of a series.
typedef struct scatter_choice {
    size_t most;    // points, about
    bool contours;  // of density, too
    bool footprint; // these are landing points, or places of lines
} scatter_choice;

static void write_points(FILE *json, const study_values *values, size_t most)
{
    bool first = true;
    fputs(",\"points\":[", json);
    for (size_t i = 0; i < values->count; i++) {
        if (!study_shows_point(values->sample[i], values->rocket[i], values->count, most))
            continue;
        fprintf(json, "%s[%" PRId64 ",%d,", first ? "" : ",", values->sample[i], values->rocket[i]);
        first = false;
        study_write_short(json, values->value[0][i]);
        fputc(',', json);
        study_write_short(json, values->value[1][i]);
        fputc(']', json);
    }
    fputc(']', json);
}

static ld_status write_ellipse(FILE *json, const study_values *values)
{
    covariance_ellipse e;
    estimate axis[2];
    double *const *value = values->value;
    covariance_ellipse_of(value[0], value[1], values->count, &e);
    ld_status status =
        covariance_ellipse_intervals(value[0], value[1], values->group, values->count, &e, axis);
    if (status)
        return status;
    fprintf(json, ",\"ellipse\":{\"mean\":[%.17g,%.17g],\"angle\":%.17g,\"semi_axis\":[", e.mean[0],
            e.mean[1], e.angle);
    for (int k = 0; k < 2; k++)
        study_write_estimate(json, k, axis[k], json_write_number);
    fputs("]}", json);
    return LD_OK;
}

// A closed line in hundredths of a cell.
static void write_line(void *self, double (*corner)[2], size_t count)
{
    contour_writer *writer = self;
    fputs(writer->any ? ",[" : "[", writer->json);
    for (size_t i = 0; i < count; i++)
        fprintf(writer->json, "%s%.0f,%.0f", i ? "," : "", 100 * corner[i][0], 100 * corner[i][1]);
    fputc(']', writer->json);
    writer->any = true;
}

static ld_status write_lines(FILE *json, const density_map *map, double level)
{
    contour_writer writer = {.json = json};
    fputc('[', json);
    ld_status status = density_contour(map, level, write_line, &writer);
    fputc(']', json);
    return status;
}

// The grid's origin and steps.
static void write_grid(FILE *json, const density_map *map)
{
    fprintf(json, "\"origin\":[%.17g,%.17g],\"step\":[%.17g,%.17g,%.17g,%.17g]", map->origin[0],
            map->origin[1], map->step[0][0], map->step[0][1], map->step[1][0], map->step[1][1]);
}

// The grid, and the closed lines of each level.
static ld_status write_contours(FILE *json, const study_values *values, double effective)
{
    density_map *map = malloc(sizeof *map);
    ld_status status =
        map ? density_of(values->value[0], values->value[1], values->count, effective, map)
            : LD_ERR_MEMORY;
    if (!status) {
        fputs(",\"contours\":{", json);
        write_grid(json, map);
        fputs(",\"levels\":[", json);
    }
    for (int k = 0; k < DENSITY_LEVELS && !status; k++) {
        fprintf(json, "%s[%g,", k ? "," : "", density_share[k]);
        status = write_lines(json, map, map->level[k]);
        fputc(']', json);
    }
    fputs(status ? "" : "]}", json);
    free(map);
    return status;
}

// A region's numbers; its lines where it is drawn.
static ld_status write_region(FILE *json, const footprint *of, int index, bool drawn)
{
    const footprint_region *region = &of->region[index];
    fprintf(json, "{\"share\":%g,\"needed\":%.17g,\"independent\":", region->share, region->needed);
    json_write_number(json, region->independent);
    fprintf(json, ",\"stated\":%d,\"estimates\":[", region->stated);
    study_write_estimate(json, 0, region->content, json_write_number);
    study_write_estimate(json, 1, region->area, json_write_number);
    study_write_estimate(json, 2, region->distance, json_write_number);
    fputs("],\"lines\":", json);
    ld_status status = LD_OK;
    if (region->stated && drawn)
        status = write_lines(json, &of->map, of->level[index].value);
    else
        fputs("[]", json);
    fputc('}', json);
    return status;
}

static ld_status write_footprint(FILE *json, const study_values *values, bool drawn)
{
    footprint *of = malloc(sizeof *of);
    ld_status status = of ? footprint_of_values(values, of) : LD_ERR_MEMORY;
    if (!status && !of->on_line) {
        fputs(",\"footprint\":{", json);
        write_grid(json, &of->map);
        fputs(",\"regions\":[", json);
        for (int k = 0; k < FOOTPRINT_SHARES && !status; k++) {
            fputs(k ? "," : "", json);
            status = write_region(json, of, k, drawn);
        }
        fputs("]}", json);
    }
    free(of);
    return status;
}

// Whether the cloud is normal; where it is not, the contours of its density.
static ld_status write_form(FILE *json, const study_values *values, bool contours)
{
    normality of = normality_of(values->value[0], values->value[1], values->group, values->count);
    fprintf(json, ",\"normality\":{\"tested\":%d,\"normal\":%d,\"level\":%g,\"chance\":[",
            of.tested, of.normal, normality_level);
    json_write_number(json, of.chance[0]);
    fputc(',', json);
    json_write_number(json, of.chance[1]);
    fputs("]}", json);
    return of.tested && !of.normal && contours ? write_contours(json, values, of.effective) : LD_OK;
}

static bool all_finite(const study_values *values)
{
    for (size_t i = 0; i < values->count; i++)
        if (!isfinite(values->value[0][i]) || !isfinite(values->value[1][i]))
            return false;
    return true;
}

static ld_status write_cloud(FILE *json, const study_values *values, const scatter_choice *choice)
{
    ld_status status = write_ellipse(json, values);
    if (!status)
        status = write_form(json, values, choice->contours);
    return status || !choice->footprint ? status : write_footprint(json, values, choice->contours);
}

static ld_status write_scatter(FILE *json, const study_values *values, const scatter_choice *choice)
{
    fprintf(json, "{\"count\":%zu", values->count);
    ld_status status =
        values->count >= 3 && all_finite(values) ? write_cloud(json, values, choice) : LD_OK;
    write_points(json, values, choice->most);
    fputc('}', json);
    return status;
}

// Two results of all series; `pair` NULL: where their lines lie.
static ld_status write_pair(FILE *json, study_source *source, const study_pair *pair,
                            const scatter_choice *choice)
{
    static const study_pair line = {"Where the line lies", {"line x", "line z"}, "m"};
    const study_pair *of = pair ? pair : &line;
    ld_status status = LD_OK;
    fprintf(json, "\n{\"title\":\"%s\",\"x\":\"%s\",\"y\":\"%s\",\"unit\":\"%s\"", of->title,
            of->name[0], of->name[1], of->unit);
    fprintf(json, ",\"radius\":%.17g,\"series\":[", ellipse_radius);
    for (int i = 0; i < source->series_count && !status; i++) {
        study_series *series = &source->series[i];
        if (pair)
            study_read_values(source, series, pair->name, 2);
        else
            study_read_line(source, series);
        fputs(i ? ",\n" : "\n", json);
        if (series->values.count)
            status = write_scatter(json, &series->values, choice);
        else
            fputs("null", json);
    }
    fputs("]}", json);
    return status;
}

static bool any_lines(const study_source *source)
{
    const char *nearest;
    for (int i = 0; i < source->series_count; i++)
        if (study_data_find(source->series[i].data, "line.1.x", &nearest))
            return true;
    return false;
}

ld_status study_write_pairs(FILE *json, study_source *source)
{
    ld_status status = LD_OK;
    double bytes = source->share * BYTES_OF_POINTS;
    size_t fit = (size_t)(bytes / (STUDY_PAIRS * BYTES_OF_A_POINT * source->series_count));
    scatter_choice choice = {.most = fit < MOST_POINTS ? fit : MOST_POINTS,
                             .contours = source->series_count <= REPORT_OVERLAID};
    for (size_t p = 0; p < STUDY_PAIRS && !status; p++) {
        choice.footprint = p == STUDY_LANDING;
        fputs(p ? "," : "", json);
        status = write_pair(json, source, &study_pairs[p], &choice);
        if (status || p != STUDY_LANDING || !any_lines(source))
            continue;
        fputc(',', json);
        status = write_pair(json, source, NULL, &choice);
    }
    return status;
}
