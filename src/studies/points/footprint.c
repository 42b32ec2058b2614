#include "studies/points/footprint.h"

#include <stdio.h>
#include <stdlib.h>

#include "math/functions.h"
#include "quantities/study_results.h"
#include "studies/statistics/normality.h"

// Of the landings that rank, so many lie outside of an edge that is stated; one of PARTS draws.
enum { OUTSIDE = 6, PARTS = 3 };

static const double share_of[FOOTPRINT_SHARES] = {0.95, 0.99, 0.999};

void footprint_place(const footprint *of, const double node[2], double place[2])
{
    const density_map *map = &of->map;
    for (int k = 0; k < 2; k++)
        place[k] = map->origin[k] + node[0] * map->step[0][k] + node[1] * map->step[1][k];
}

// ---- what a contour encloses

typedef struct extent {
    const footprint *of;
    double area, distance;
} extent;

static void measure_line(void *self, double (*corner)[2], size_t count)
{
    extent *sum = self;
    double last[2], next[2], origin[2];
    footprint_place(sum->of, corner[0], origin);
    footprint_place(sum->of, corner[count - 1], last);
    for (size_t i = 0; i < count; i++) {
        footprint_place(sum->of, corner[i], next);
        sum->distance = fmax(sum->distance, hypot(next[0], next[1]));
        sum->area += 0.5 * ((last[0] - origin[0]) * (next[1] - origin[1]) -
                            (next[0] - origin[0]) * (last[1] - origin[1]));
        last[0] = next[0];
        last[1] = next[1];
    }
}

// NaN where the level is that of no contour.
static ld_status measure(const footprint *of, double level, double *area, double *distance)
{
    extent sum = {.of = of};
    ld_status status = level > 0 ? density_contour(&of->map, level, measure_line, &sum) : LD_OK;
    *area = level > 0 ? sum.area : NAN;
    *distance = level > 0 ? sum.distance : NAN;
    return status;
}

// ---- regions

// Landings in the order of their groups, which rise.
typedef struct landings {
    double *x, *y;
    int64_t *group;
    size_t count;
} landings;

static ld_status state_region(footprint *of, const landings *ranking, int index)
{
    const double whole = (double)of->count / (double)ranking->count;
    footprint_region *region = &of->region[index];
    double outside = 1 - region->share;
    estimate *level = &of->level[index], *area = &region->area, *distance = &region->distance;
    ld_status status = tail_quantile_of(ranking->x, ranking->group, ranking->count, outside, level,
                                        &region->independent);
    if (status)
        return status;
    estimate share = share_below_quantile(region->independent, outside);
    region->independent *= whole;
    region->stated = region->independent > region->needed - 0.5 && level->value > 0;
    if (!region->stated)
        return LD_OK;
    region->content = (estimate){region->share, 1 - share.high, 1 - share.low};
    status = measure(of, level->value, &area->value, &distance->value);
    if (!status)
        status = measure(of, level->high, &area->low, &distance->low);
    return status ? status : measure(of, level->low, &area->high, &distance->high);
}

// Whole groups: one of PARTS draws the contours, the others rank.
static void part_landings(const double *x, const double *y, const int64_t *group, size_t count,
                          landings *drawing, landings *ranking)
{
    for (size_t i = 0, g = 0; i < count; i++) {
        g += i > 0 && group[i] != group[i - 1];
        landings *to = g % PARTS == 0 ? drawing : ranking;
        to->x[to->count] = x[i];
        to->y[to->count] = y[i];
        to->group[to->count++] = group[i];
    }
}

// Levels from those that rank, on the map of those that draw.
static ld_status state_regions(footprint *result, const landings *drawing, const landings *ranking,
                               double effective)
{
    double part = effective / (double)result->count;
    ld_status status = density_of(drawing->x, drawing->y, drawing->count,
                                  part * (double)drawing->count, &result->map);
    for (size_t i = 0; i < ranking->count; i++)
        ranking->x[i] = density_at(&result->map, ranking->x[i], ranking->y[i]);
    for (int k = 0; k < FOOTPRINT_SHARES && !status; k++) {
        result->region[k].independent = part * (double)ranking->count;
        status = state_region(result, ranking, k);
    }
    return status;
}

ld_status footprint_of(const double *x, const double *y, const int64_t *group, size_t count,
                       footprint *result)
{
    static const estimate none = {NAN, NAN, NAN};
    normality cloud = normality_of(x, y, group, count);
    *result = (footprint){.count = count, .on_line = !(cloud.effective > 0)};
    for (int k = 0; k < FOOTPRINT_SHARES; k++)
        result->region[k] =
            (footprint_region){.share = share_of[k],
                               .needed = round(OUTSIDE / (1 - share_of[k])) * PARTS / (PARTS - 1),
                               .independent = cloud.effective,
                               .content = none,
                               .area = none,
                               .distance = none};
    if (result->on_line || cloud.effective <= result->region[0].needed - 0.5)
        return LD_OK;
    double *room = malloc(4 * count * sizeof *room);
    int64_t *groups = malloc(2 * count * sizeof *groups);
    landings drawing = {room, room + count, groups, 0};
    landings ranking = {room + 2 * count, room + 3 * count, groups + count, 0};
    ld_status status = LD_ERR_MEMORY;
    if (room && groups) {
        part_landings(x, y, group, count, &drawing, &ranking);
        status = state_regions(result, &drawing, &ranking, cloud.effective);
    }
    free(room);
    free(groups);
    return status;
}

ld_status footprint_of_values(const study_values *values, footprint *result)
{
    if (values->count > 0)
        return footprint_of(values->value[0], values->value[1], values->group, values->count,
                            result);
    *result = (footprint){.on_line = true};
    return LD_OK;
}

ld_status footprint_read(const study_data *data, const study_point *point, footprint_kind kind,
                         study_values *values, footprint *result, ld_error *error)
{
    const study_column *column[2];
    const char *nearest;
    *result = (footprint){.on_line = true};
    if (kind == FOOTPRINT_LANDINGS)
        for (int k = 0; k < 2; k++)
            if (!(column[k] = study_data_find(data, study_pairs[STUDY_LANDING].name[k], &nearest)))
                return LD_OK;
    ld_status status = kind == FOOTPRINT_LINE
                           ? study_data_read_line(data, point, values, error)
                           : study_data_read(data, point, column, 2, values, error);
    if (!status && footprint_of_values(values, result))
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the footprints");
    return status;
}

void footprint_why_not(footprint_kind kind, const footprint_region *region, char text[128])
{
    bool enough = region->independent > region->needed - 0.5;
    const char *of = kind == FOOTPRINT_LINE ? "places of lines" : "landings";
    snprintf(text, 128,
             enough ? "%s too far apart: more than %.6g independent ones are needed"
                    : "too few %s: %.6g independent ones are needed, found %.6g",
             of, enough ? region->independent : region->needed, region->independent);
}
