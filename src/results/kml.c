#include "results/kml.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "base/printed.h"
#include "environment/earth.h"
#include "model/model.h"

#define DEGREES 57.29577951308232

enum { LATITUDE, LONGITUDE, ALTITUDE, X, Z, TIME, COLUMNS };

static const char *const column_name[COLUMNS] = {"latitude", "longitude", "altitude",
                                                 "center.x", "center.z",  "t"};

struct kml_file {
    FILE *stream;
    char *path;
    const ld_model *model;
    earth ellipsoid;        // on which a flat Earth is laid
    size_t column[COLUMNS]; // where they stand in a row
    bool geodetic;          // rows have latitude and longitude
    bool in_line;           // a flight's line is open
    int rocket;             // whose it is
    // its latest and its highest longitude, latitude [deg], altitude [m], time [s]
    double last[4], highest[4];
};

bool kml_has_place(const ld_model *model)
{
    return model->environment.site.present || model->environment.earth.kind != LD_EARTH_FLAT;
}

static ld_status state_of(const kml_file *file, ld_error *error)
{
    if (!ferror(file->stream))
        return LD_OK;
    return ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", file->path, strerror(errno));
}

// Whether a text of XML 1.0 may hold a character.
static bool is_in_xml(int32_t code)
{
    return code == '\t' || code == '\n' || (code >= 0x20 && (code < 0xfffe || code > 0xffff));
}

void kml_write_text(FILE *stream, const char *text)
{
    while (*text) {
        size_t length;
        int32_t code = printed_code(text, &length);
        if (code == '&')
            fputs("&amp;", stream);
        else if (code == '<')
            fputs("&lt;", stream);
        else if (code == '>')
            fputs("&gt;", stream);
        else if (is_in_xml(code))
            fwrite(text, 1, length, stream);
        else
            fputs("\xef\xbf\xbd", stream);
        text += length;
    }
}

static bool build_ellipsoid(kml_file *file)
{
    ld_model *laid = calloc(1, sizeof *laid);
    if (laid) {
        laid->environment.earth.kind = LD_EARTH_WGS84;
        laid->environment.site = file->model->environment.site;
        earth_build(&file->ellipsoid, laid);
    }
    free(laid);
    return laid != NULL;
}

static void free_file(kml_file *file)
{
    free(file->path);
    free(file);
}

ld_status kml_create(const char *path, const ld_model *model, kml_file **file, ld_error *error)
{
    kml_file *created = calloc(1, sizeof *created);
    if (!created)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the trajectories");
    created->model = model;
    created->path = strdup(path);
    if (!created->path || !build_ellipsoid(created)) {
        free_file(created);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the trajectories");
    }
    created->stream = fopen(path, "w");
    if (!created->stream) {
        free_file(created);
        return ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", path, strerror(errno));
    }
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
          "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n<name>",
          created->stream);
    kml_write_text(created->stream, model->title ? model->title : "");
    fputs("</name>\n", created->stream);
    *file = created;
    return state_of(created, error);
}

static void write_point(const kml_file *file, const double place[3], const char *name)
{
    fprintf(file->stream,
            "<Placemark>\n<name>Rocket %d, %s</name>\n<Point>\n"
            "<altitudeMode>absolute</altitudeMode>\n<coordinates>%.9f,%.9f,%.3f"
            "</coordinates>\n</Point>\n</Placemark>\n",
            file->rocket, name, place[0], place[1], place[2]);
}

// Points: where a flight ends, and its highest one unless it ends while it rises.
static void write_points(const kml_file *file)
{
    const ld_environment *environment = &file->model->environment;
    const double *last = file->last, *highest = file->highest;
    bool flat = environment->earth.kind == LD_EARTH_FLAT;
    double ground = environment->ground_height + (flat ? environment->site.altitude : 0);
    char name[128];
    if (highest[2] > last[2] || file->model->run.end == LD_END_APOGEE) {
        snprintf(name, sizeof name, "apogee %.1f m above ground, %.1f m above sea level",
                 printed_fixed(highest[2] - ground, 1), printed_fixed(highest[2], 1));
        write_point(file, highest, name);
    }
    snprintf(name, sizeof name, "t = %.3f s", last[3]);
    write_point(file, last, name);
}

static void end_line(kml_file *file)
{
    if (file->in_line) {
        locale_t before = numeric_locale_enter();
        fputs("</coordinates>\n</LineString>\n</Placemark>\n", file->stream);
        if (!isnan(file->last[0]))
            write_points(file);
        numeric_locale_leave(before);
    }
    file->in_line = false;
}

// Index of a column, `count` if it is not there.
static size_t find_column(const ld_column *columns, size_t count, const char *name)
{
    size_t i = 0;
    while (i < count && strcmp(columns[i].name, name) != 0)
        i++;
    return i;
}

ld_status kml_flight(kml_file *file, int rocket, const ld_column *columns, size_t count,
                     ld_error *error)
{
    // colours of the lines as aabbggrr
    static const char *const colour[] = {"ffb27200", "ff005ed5", "ff739e00", "ffa779cc",
                                         "ff009fe6", "ffe9b456", "ff000000", "ff999999"};
    for (int i = 0; i < COLUMNS; i++)
        file->column[i] = find_column(columns, count, column_name[i]);
    file->geodetic = file->column[LATITUDE] < count && file->column[LONGITUDE] < count;
    bool plane = file->column[X] < count && file->column[Z] < count;
    if (file->column[ALTITUDE] == count || file->column[TIME] == count ||
        !(file->geodetic || plane))
        return ld_fail(error, LD_ERR_INPUT, "the rows of a flight have no column for %s",
                       file->path);
    end_line(file);
    file->rocket = rocket;
    file->last[0] = NAN;
    file->highest[2] = -INFINITY;
    fprintf(file->stream, "<Placemark>\n<name>Rocket %d", rocket);
    if (rocket <= file->model->firing_count)
        fprintf(file->stream, ", tube %d", file->model->firing[rocket - 1].tube);
    fprintf(file->stream,
            "</name>\n<Style><LineStyle><color>%s</color><width>2</width></LineStyle></Style>\n"
            "<LineString>\n<altitudeMode>absolute</altitudeMode>\n<coordinates>\n",
            colour[(size_t)(rocket - 1) % (sizeof colour / sizeof *colour)]);
    file->in_line = true;
    return state_of(file, error);
}

// Latitude and longitude of a row, in I's horizontal plane where the Earth is flat.
static geodetic place_of(const kml_file *file, const double *values)
{
    if (file->geodetic)
        return (geodetic){values[file->column[LATITUDE]], values[file->column[LONGITUDE]], 0};
    const earth *globe = &file->ellipsoid;
    v3 in_plane = v3_make(values[file->column[X]], 0, values[file->column[Z]]);
    return earth_geodetic(globe, v3_add(globe->r_site, m3_apply(globe->A_EI, in_plane)));
}

ld_status kml_row(kml_file *file, const double *values, ld_error *error)
{
    geodetic place = place_of(file, values);
    file->last[0] = printed_fixed(place.longitude * DEGREES, 9);
    file->last[1] = printed_fixed(place.latitude * DEGREES, 9);
    file->last[2] = printed_fixed(values[file->column[ALTITUDE]], 3);
    file->last[3] = values[file->column[TIME]];
    if (file->last[2] > file->highest[2])
        memcpy(file->highest, file->last, sizeof file->highest);
    locale_t before = numeric_locale_enter();
    fprintf(file->stream, "%.9f,%.9f,%.3f\n", file->last[0], file->last[1], file->last[2]);
    numeric_locale_leave(before);
    return state_of(file, error);
}

ld_status kml_close(kml_file *file, ld_error *error)
{
    end_line(file);
    fputs("</Document>\n</kml>\n", file->stream);
    bool wrong = ferror(file->stream) != 0;
    wrong |= fclose(file->stream) != 0;
    ld_status status = LD_OK;
    if (wrong)
        status = ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", file->path, strerror(errno));
    free_file(file);
    return status;
}
