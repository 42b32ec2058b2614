// Two results of a study against each other: points, the ellipse, and of a cloud that is not normal
// the contours of its density.
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "report/report_study.h"
#include "results/json_text.h"
#include "studies/density.h"
#include "studies/normality.h"

// Bytes for what grows with the number of series; the rest of a report fits beside them.
enum { BYTES_OF_POINTS = 400000, BYTES_OF_A_POINT = 40, MOST_POINTS = 2000 };

typedef struct contour_writer {
    FILE *json;
    bool any;
} contour_writer;

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

// One piece of a contour in hundredths of a cell.
static void write_piece(void *self, const double from[2], const double to[2])
{
    contour_writer *writer = self;
    fprintf(writer->json, "%s%.0f,%.0f,%.0f,%.0f", writer->any ? "," : "", 100 * from[0],
            100 * from[1], 100 * to[0], 100 * to[1]);
    writer->any = true;
}

// The grid's origin and steps, and a list of pieces for each level.
static ld_status write_contours(FILE *json, const study_values *values, double effective)
{
    density_map *map = malloc(sizeof *map);
    ld_status status =
        map ? density_of(values->value[0], values->value[1], values->count, effective, map)
            : LD_ERR_MEMORY;
    if (status) {
        free(map);
        return status;
    }
    fprintf(
        json,
        ",\"contours\":{\"origin\":[%.17g,%.17g],\"step\":[%.17g,%.17g,%.17g,%.17g],\"levels\":[",
        map->origin[0], map->origin[1], map->step[0][0], map->step[0][1], map->step[1][0],
        map->step[1][1]);
    for (int k = 0; k < DENSITY_LEVELS; k++) {
        contour_writer writer = {.json = json};
        fprintf(json, "%s[%g,[", k ? "," : "", density_share[k]);
        density_contour(map, map->level[k], write_piece, &writer);
        fputs("]]", json);
    }
    fputs("]}", json);
    free(map);
    return LD_OK;
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

static ld_status write_scatter(FILE *json, const study_values *values, size_t most, bool contours)
{
    fprintf(json, "{\"count\":%zu", values->count);
    bool cloud = values->count >= 3 && all_finite(values);
    ld_status status = cloud ? write_ellipse(json, values) : LD_OK;
    if (cloud && !status)
        status = write_form(json, values, contours);
    write_points(json, values, most);
    fputc('}', json);
    return status;
}

ld_status study_write_pairs(FILE *json, study_source *source)
{
    ld_status status = LD_OK;
    double bytes = source->share * BYTES_OF_POINTS;
    size_t fit = (size_t)(bytes / (STUDY_PAIRS * BYTES_OF_A_POINT * source->series_count));
    size_t most = fit < MOST_POINTS ? fit : MOST_POINTS;
    for (size_t p = 0; p < STUDY_PAIRS && !status; p++) {
        const study_pair *pair = &study_pairs[p];
        fprintf(json, "%s\n{\"title\":\"%s\",\"x\":\"%s\",\"y\":\"%s\",\"unit\":\"%s\"",
                p ? "," : "", pair->title, pair->name[0], pair->name[1], pair->unit);
        fprintf(json, ",\"radius\":%.17g,\"series\":[", ellipse_radius);
        for (int i = 0; i < source->series_count && !status; i++) {
            study_series *series = &source->series[i];
            study_read_values(source, series, pair->name, 2);
            fputs(i ? ",\n" : "\n", json);
            if (series->values.count)
                status = write_scatter(json, &series->values, most,
                                       source->series_count <= REPORT_OVERLAID);
            else
                fputs("null", json);
        }
        fputs("]}", json);
    }
    return status;
}
