#include "studies/show/footprint_shape.h"

#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"

#define DEGREES 57.29577951308232

void footprint_shape_free(footprint_shape *shape)
{
    for (size_t i = 0; i < shape->count; i++)
        free(shape->line[i].at);
    free(shape->line);
    *shape = (footprint_shape){0};
}

// A new line with room for so many corners; NULL: no memory.
static footprint_line *add_line(footprint_shape *shape, size_t room, bool hole)
{
    footprint_line *line = realloc(shape->line, (shape->count + 1) * sizeof *line);
    if (!line)
        return NULL;
    shape->line = line;
    line += shape->count;
    *line = (footprint_line){.at = malloc(room * sizeof *line->at), .hole = hole};
    if (!line->at)
        return NULL;
    shape->count++;
    return line;
}

static void turn_round(footprint_line *line)
{
    for (size_t i = 0, k = line->count; i + 1 < k--; i++)
        for (int c = 0; c < 2; c++) {
            double at = line->at[i][c];
            line->at[i][c] = line->at[k][c];
            line->at[k][c] = at;
        }
}

static double area_of(const footprint_line *line)
{
    double sum = 0, *origin = line->at[0];
    for (size_t i = 1; i + 1 < line->count; i++) {
        double *a = line->at[i], *b = line->at[i + 1];
        sum += 0.5 *
               ((a[0] - origin[0]) * (b[1] - origin[1]) - (b[0] - origin[0]) * (a[1] - origin[1]));
    }
    return sum;
}

// ---- in metres

typedef struct line_taker {
    const footprint *of;
    footprint_shape all;
    bool full; // no memory
} line_taker;

static void take_line(void *self, double (*corner)[2], size_t count)
{
    line_taker *taker = self;
    footprint_line *line = taker->full ? NULL : add_line(&taker->all, count, false);
    taker->full = !line;
    for (size_t i = 0; i < count && line; i++)
        footprint_place(taker->of, corner[i], line->at[line->count++]);
    if (line)
        line->hole = area_of(line) < 0;
}

static bool contains(const footprint_line *line, const double at[2])
{
    bool inside = false;
    for (size_t i = 0, k = line->count - 1; i < line->count; k = i++) {
        const double *a = line->at[k], *b = line->at[i];
        if ((a[1] > at[1]) != (b[1] > at[1]) &&
            a[0] + (at[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > at[0])
            inside = !inside;
    }
    return inside;
}

// The least outline about a hole.
static const footprint_line *outline_of(const footprint_shape *all, const footprint_line *hole)
{
    const footprint_line *least = NULL;
    for (size_t i = 0; i < all->count; i++) {
        const footprint_line *line = &all->line[i];
        if (!line->hole && contains(line, hole->at[0]) &&
            (!least || area_of(line) < area_of(least)))
            least = line;
    }
    return least;
}

// Outlines in their order, each with its holes; the corners change hands.
static ld_status sort_lines(footprint_shape *all, footprint_shape *shape)
{
    size_t count = all->count;
    *shape = (footprint_shape){.line = malloc((count + 1) * sizeof *shape->line)};
    const footprint_line **about = calloc(count + 1, sizeof(void *));
    if (!shape->line || !about) {
        free(about);
        footprint_shape_free(shape);
        return LD_ERR_MEMORY;
    }
    for (size_t i = 0; i < count; i++)
        about[i] = all->line[i].hole ? outline_of(all, &all->line[i]) : &all->line[i];
    for (size_t i = 0; i < count; i++)
        for (size_t k = i; k < count + i && !all->line[i].hole; k++)
            if (about[k % count] == &all->line[i])
                shape->line[shape->count++] = all->line[k % count];
    free(about);
    free(all->line);
    *all = (footprint_shape){0};
    return LD_OK;
}

ld_status footprint_shape_of(const footprint *of, int index, footprint_shape *shape)
{
    line_taker taker = {.of = of};
    *shape = (footprint_shape){0};
    ld_status status = density_contour(&of->map, of->level[index].value, take_line, &taker);
    if (taker.full)
        status = LD_ERR_MEMORY;
    if (!status)
        status = sort_lines(&taker.all, shape);
    footprint_shape_free(&taker.all);
    return status;
}

// ---- on the Earth

ld_status footprint_site_of(const ld_model *model, footprint_site *site, bool *there)
{
    const ld_environment *environment = &model->environment;
    bool flat = environment->earth.kind == LD_EARTH_FLAT;
    *there = environment->site.present || !flat;
    ld_model *laid = calloc(1, sizeof *laid);
    if (!laid)
        return LD_ERR_MEMORY;
    laid->environment.earth = environment->earth;
    if (flat)
        laid->environment.earth.kind = LD_EARTH_WGS84;
    laid->environment.site = environment->site;
    *site = (footprint_site){.tangent = flat, .ground = environment->ground_height};
    earth_build(&site->globe, laid);
    site->place[0] = DEGREES * environment->site.longitude;
    site->place[1] = DEGREES * environment->site.latitude;
    free(laid);
    return LD_OK;
}

// Longitude, from that of the site less 180 to that plus 180, and latitude [deg] of the ground
// below or above a point of I's horizontal plane. false: there is none.
static bool place_of(const footprint_site *site, const double flat[2], double place[2])
{
    const earth *globe = &site->globe;
    double y = 0, off = site->tangent ? 0 : INFINITY;
    v3 r = v3_add(globe->r_site, m3_apply(globe->A_EI, v3_make(flat[0], 0, flat[1])));
    for (int i = 0; i < 50 && fabs(off) > 1e-4; i++) {
        v3 up, along = m3_column(globe->A_EI, 1);
        off = earth_height(globe, r, &up) - site->ground;
        double rise = v3_dot(up, along);
        if (!(rise > 0.05) || !(fabs(y) < 2 * globe->a))
            return false;
        y -= off / rise;
        r = v3_add(globe->r_site, m3_apply(globe->A_EI, v3_make(flat[0], y, flat[1])));
    }
    geodetic found = earth_geodetic(globe, r);
    place[0] = site->place[0] + remainder(DEGREES * found.longitude - site->place[0], 360);
    place[1] = DEGREES * found.latitude;
    return !(fabs(off) > 1e-4);
}

// Keeps what lies on one side of a meridian, and shifts its longitudes (I. E. Sutherland and G. W.
// Hodgman, Comm. ACM 17, 1974). Lines of which nothing lies there are left out.
static ld_status cut_line(const footprint_line *line, double meridian, int side, double shift,
                          footprint_shape *shape)
{
    footprint_line *kept = add_line(shape, 2 * line->count + 1, line->hole);
    if (!kept)
        return LD_ERR_MEMORY;
    for (size_t i = 0, k = line->count - 1; i < line->count; k = i++) {
        const double *a = line->at[k], *b = line->at[i];
        double from = side * (a[0] - meridian), to = side * (b[0] - meridian);
        if ((from > 0 && to < 0) || (from < 0 && to > 0)) {
            kept->at[kept->count][0] = meridian + shift;
            kept->at[kept->count++][1] = a[1] + from / (from - to) * (b[1] - a[1]);
        }
        if (to >= 0) {
            kept->at[kept->count][0] = b[0] + shift;
            kept->at[kept->count++][1] = b[1];
        }
    }
    if (kept->count < 3 || area_of(kept) == 0) {
        free(kept->at);
        shape->count--;
    }
    return LD_OK;
}

// Cuts where longitudes leave -180 to 180, at 180 (outer 1) or at -180 (outer -1): a polygon's part
// before, then that beyond.
static ld_status cut_all(const footprint_shape *whole, int outer, footprint_shape *shape)
{
    ld_status status = LD_OK;
    for (size_t i = 0, end = 0; i < whole->count && !status; i = end) {
        for (end = i + 1; end < whole->count && whole->line[end].hole;)
            end++;
        for (int side = -1; side <= 1; side += 2)
            for (size_t k = i; k < end && !status; k++)
                status = cut_line(&whole->line[k], 180 * outer, side * outer,
                                  side > 0 ? -360.0 * outer : 0, shape);
    }
    return status;
}

static ld_status place_line(const footprint_site *site, const footprint_line *flat,
                            footprint_shape *shape, ld_error *error)
{
    footprint_line *line = add_line(shape, flat->count, flat->hole);
    if (!line)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the footprints");
    for (; line->count < flat->count; line->count++)
        if (!place_of(site, flat->at[line->count], line->at[line->count]))
            return ld_fail(error, LD_ERR_INPUT,
                           "a footprint reaches beyond the horizon of the launch point, where x "
                           "and z of I have no position on the Earth");
    for (size_t i = 0; i < line->count; i++)
        if (fabs(line->at[i][0] - line->at[(i + 1) % line->count][0]) > 180)
            return ld_fail(
                error, LD_ERR_INPUT,
                "a footprint encloses a pole: it is not a polygon of longitudes and latitudes");
    if ((area_of(line) < 0) != line->hole)
        turn_round(line);
    return LD_OK;
}

ld_status footprint_shape_on_earth(const footprint_site *site, const footprint_shape *flat,
                                   footprint_shape *shape, ld_error *error)
{
    footprint_shape whole = {0};
    double least = INFINITY, most = -INFINITY;
    ld_status status = LD_OK;
    *shape = (footprint_shape){0};
    for (size_t i = 0; i < flat->count && !status; i++) {
        status = place_line(site, &flat->line[i], &whole, error);
        for (size_t k = 0; k < flat->line[i].count && !status; k++) {
            least = fmin(least, whole.line[i].at[k][0]);
            most = fmax(most, whole.line[i].at[k][0]);
        }
    }
    if (!status && (most > 180 || least < -180)) {
        status = cut_all(&whole, most > 180 ? 1 : -1, shape);
        if (status)
            status = ld_fail(error, status, "no memory for the footprints");
    } else if (!status) {
        *shape = whole;
        whole = (footprint_shape){0};
    }
    footprint_shape_free(&whole);
    if (status)
        footprint_shape_free(shape);
    return status;
}
