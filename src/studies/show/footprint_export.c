// Footprints as a file: CSV in metres, KML (OGC 2.2) and GeoJSON (RFC 7946) on the Earth.
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "launchdyn/study.h"
#include "model/model.h"
#include "quantities/study_results.h"
#include "results/json_text.h"
#include "results/kml.h"
#include "scenario/scenario.h"
#include "studies/show/footprint_shape.h"
#include "studies/store/table_file.h"

typedef struct footprint_writer {
    const struct footprint_format *format;
    FILE *stream;
    const study_data *data;
    const study_point *point;
    footprint_site site;
    footprint_kind kind;
    footprint of;
    study_values values;
    const char *moving;    // key of the site that is swept or drawn; NULL: none
    bool placed;           // the site says where on the Earth it is
    int stated;            // regions of all points
    footprint_region best; // of 95 %, of the point with the most landings or places
    footprint_kind best_kind;
} footprint_writer;

// A region that is written: its numbers, its shape in metres and, where it is placed, on the Earth.
typedef struct footprint_item {
    const footprint_region *region;
    const footprint_shape *flat, *placed;
} footprint_item;

typedef struct footprint_format {
    const char *ending;
    bool on_earth; // requires a place
    void (*begin)(footprint_writer *self);
    void (*region)(footprint_writer *self, const footprint_item *item);
    void (*end)(footprint_writer *self);
} footprint_format;

// What the regions are of, in a file's words.
static const char *const kind_word[FOOTPRINT_KINDS] = {
    [FOOTPRINT_LANDINGS] = "landings", [FOOTPRINT_LINE] = "line"};
static const char *const kind_told[FOOTPRINT_KINDS] = {
    [FOOTPRINT_LANDINGS] = "landings", [FOOTPRINT_LINE] = "places of a line"};

// ---- CSV: a line for each corner

static void begin_csv(footprint_writer *self)
{
    fputs("point,of,share,content_low,content_high,needed,independent,polygon,line,hole,downrange "
          "[m],drift [m]\n",
          self->stream);
}

static void csv_number(FILE *stream, double value, const char *after)
{
    if (!isnan(value))
        fprintf(stream, "%.17g", value);
    fputs(after, stream);
}

// A region that is not stated has one line without a corner.
static void region_csv(footprint_writer *self, const footprint_item *item)
{
    const footprint_region *region = item->region;
    int polygon = 0;
    FILE *stream = self->stream;
    for (size_t i = 0; i < item->flat->count || i == 0; i++) {
        const footprint_line *line = region->stated ? &item->flat->line[i] : NULL;
        polygon += line && !line->hole;
        for (size_t k = 0; k < (line ? line->count : 1); k++) {
            fprintf(stream, "%" PRId64 ",%s,%g,", self->point->number, kind_word[self->kind],
                    region->share);
            csv_number(stream, region->content.low, ",");
            csv_number(stream, region->content.high, ",");
            fprintf(stream, "%.17g,%.17g,", region->needed, region->independent);
            if (line)
                fprintf(stream, "%d,%zu,%d,%.17g,%.17g\n", polygon, i + 1, line->hole,
                        line->at[k][0], line->at[k][1]);
            else
                fputs(",,,,\n", stream);
        }
    }
}

static void end_csv(footprint_writer *self)
{
    (void)self;
}

// ---- KML

// "99 % of landings, base.speed: 15 km/h"
static void write_name(footprint_writer *self, const footprint_region *region,
                       void (*write)(FILE *stream, const char *text))
{
    char text[64];
    snprintf(text, sizeof text, "%.3g %% of %s", 100 * region->share, kind_told[self->kind]);
    write(self->stream, text);
    for (int k = 0; k < self->data->swept_count; k++) {
        write(self->stream, ", ");
        write(self->stream, self->data->swept[k]);
        write(self->stream, ": ");
        write(self->stream, self->point->text[k]);
    }
}

static void kml_place(FILE *stream, const double place[2])
{
    fprintf(stream, "%.9f,%.9f,0 ", place[0] + 0.0, place[1] + 0.0);
}

static void begin_kml(footprint_writer *self)
{
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
          "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n<name>Footprints: ",
          self->stream);
    kml_write_text(self->stream, self->data->title ? self->data->title : "");
    fputs("</name>\n<Placemark>\n<name>launch point</name>\n<Point>\n<coordinates>", self->stream);
    kml_place(self->stream, self->site.place);
    fputs("</coordinates>\n</Point>\n</Placemark>\n", self->stream);
}

static void kml_ring(FILE *stream, const footprint_line *line)
{
    const char *kind = line->hole ? "inner" : "outer";
    fprintf(stream, "<%sBoundaryIs><LinearRing><coordinates>\n", kind);
    for (size_t i = 0; i <= line->count; i++)
        kml_place(stream, line->at[i % line->count]);
    fprintf(stream, "\n</coordinates></LinearRing></%sBoundaryIs>\n", kind);
}

static void kml_polygons(FILE *stream, const footprint_shape *shape)
{
    fputs("<MultiGeometry>\n", stream);
    for (size_t i = 0; i < shape->count; i++) {
        bool last = i + 1 == shape->count || !shape->line[i + 1].hole;
        fputs(shape->line[i].hole ? "" : "<Polygon>\n<tessellate>1</tessellate>\n", stream);
        kml_ring(stream, &shape->line[i]);
        fputs(last ? "</Polygon>\n" : "", stream);
    }
    fputs("</MultiGeometry>\n", stream);
}

static void region_kml(footprint_writer *self, const footprint_item *item)
{
    static const char *const colour[FOOTPRINT_SHARES] = {"0000d7", "0080ff", "00d7ff"}; // bbggrr
    const footprint_region *region = item->region;
    FILE *stream = self->stream;
    char why[128];
    footprint_why_not(self->kind, region, why);
    const char *of = colour[(region - self->of.region) % FOOTPRINT_SHARES];
    fputs("<Placemark>\n<name>", stream);
    write_name(self, region, kml_write_text);
    if (region->stated)
        fprintf(stream,
                "</name>\n<description>%.4g to %.4g %% of further %s lie within (95 %% "
                "interval); from %zu, worth %.6g independent ones; %.6g m2, at most %.6g "
                "m from the launch point</description>\n",
                100 * region->content.low, 100 * region->content.high, kind_told[self->kind],
                self->of.count, region->independent, region->area.value, region->distance.value);
    else
        fprintf(stream, "</name>\n<description>%s</description>\n", why);
    fprintf(stream,
            "<Style><LineStyle><color>ff%s</color><width>2</width></LineStyle><PolyStyle>"
            "<color>40%s</color></PolyStyle></Style>\n",
            of, of);
    if (region->stated)
        kml_polygons(stream, item->placed);
    fputs("</Placemark>\n", stream);
}

static void end_kml(footprint_writer *self)
{
    fputs("</Document>\n</kml>\n", self->stream);
}

// ---- GeoJSON

static void begin_geojson(footprint_writer *self)
{
    fprintf(self->stream,
            "{\"type\":\"FeatureCollection\",\"features\":[\n{\"type\":\"Feature\",\"geometry\":{"
            "\"type\":\"Point\",\"coordinates\":[%.9f,%.9f]},\"properties\":{\"name\":\"launch "
            "point\"}}",
            self->site.place[0] + 0.0, self->site.place[1] + 0.0);
}

static void geojson_ring(FILE *stream, const footprint_line *line)
{
    for (size_t i = 0; i <= line->count; i++) {
        const double *place = line->at[i % line->count];
        fprintf(stream, "%s[%.9f,%.9f]", i ? "," : "[", place[0] + 0.0, place[1] + 0.0);
    }
    fputc(']', stream);
}

static void geojson_estimate(FILE *stream, const char *name, const estimate *e)
{
    fprintf(stream, ",\"%s\":", name);
    json_write_number(stream, e->value);
    fprintf(stream, ",\"%s_low\":", name);
    json_write_number(stream, e->low);
    fprintf(stream, ",\"%s_high\":", name);
    json_write_number(stream, e->high);
}

static void geojson_properties(footprint_writer *self, const footprint_region *region)
{
    FILE *stream = self->stream;
    fprintf(stream, "\"properties\":{\"of\":\"%s\",\"share\":%g,\"point\":%" PRId64,
            kind_word[self->kind], region->share, self->point->number);
    for (int k = 0; k < self->data->swept_count; k++) {
        fputc(',', stream);
        json_write_text(stream, self->data->swept[k]);
        fputc(':', stream);
        json_write_text(stream, self->point->text[k]);
    }
    fprintf(stream, ",\"stated\":%s,\"count\":%zu,\"independent\":%.17g,\"needed\":%.17g",
            region->stated ? "true" : "false", self->of.count, region->independent, region->needed);
    geojson_estimate(stream, "content", &region->content);
    geojson_estimate(stream, "area_m2", &region->area);
    geojson_estimate(stream, "distance_m", &region->distance);
    fputc('}', stream);
}

static void region_geojson(footprint_writer *self, const footprint_item *item)
{
    FILE *stream = self->stream;
    fputs(",\n{\"type\":\"Feature\",\"geometry\":", stream);
    if (item->region->stated) {
        fputs("{\"type\":\"MultiPolygon\",\"coordinates\":[", stream);
        for (size_t i = 0; i < item->placed->count; i++) {
            const footprint_line *line = &item->placed->line[i];
            fputs(i == 0 ? "[" : line->hole ? "," : "],[", stream);
            geojson_ring(stream, line);
        }
        fputs("]]},", stream);
    } else {
        fputs("null,", stream);
    }
    geojson_properties(self, item->region);
    fputc('}', stream);
}

static void end_geojson(footprint_writer *self)
{
    fputs("\n]}\n", self->stream);
}

// ---- all of them

static const footprint_format formats[] = {
    {".csv", false, begin_csv, region_csv, end_csv},
    {".kml", true, begin_kml, region_kml, end_kml},
    {".geojson", true, begin_geojson, region_geojson, end_geojson},
};

static const footprint_format *format_of(const char *file)
{
    size_t length = strlen(file);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        size_t ending = strlen(formats[i].ending);
        if (length > ending && strcmp(file + length - ending, formats[i].ending) == 0)
            return &formats[i];
    }
    return NULL;
}

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the footprints");
}

static ld_status write_region(footprint_writer *self, int index, ld_error *error)
{
    footprint_shape flat = {0}, placed = {0};
    const footprint_item item = {&self->of.region[index], &flat, &placed};
    ld_status status = LD_OK;
    if (item.region->stated) {
        self->stated++;
        status = footprint_shape_of(&self->of, index, &flat) ? no_memory(error) : LD_OK;
    }
    if (!status && item.region->stated && self->format->on_earth)
        status = footprint_shape_on_earth(&self->site, &flat, &placed, error);
    if (!status)
        self->format->region(self, &item);
    footprint_shape_free(&flat);
    footprint_shape_free(&placed);
    return status;
}

static ld_status write_point(footprint_writer *self, const study_point *point, ld_error *error)
{
    self->point = point;
    ld_status status =
        footprint_read(self->data, point, self->kind, &self->values, &self->of, error);
    for (int k = 0; k < FOOTPRINT_SHARES && !status && !self->of.on_line; k++)
        status = write_region(self, k, error);
    if (!status && self->of.region[0].independent > self->best.independent) {
        self->best = self->of.region[0];
        self->best_kind = self->kind;
    }
    return status;
}

static ld_status write_all(void *writer, FILE *stream, ld_error *error)
{
    footprint_writer *self = writer;
    const study_data *data = self->data;
    ld_status status = LD_OK;
    char why[128];
    self->stream = stream;
    self->format->begin(self);
    for (int i = 0; i < data->point_count && !status; i++)
        for (int kind = 0; kind < FOOTPRINT_KINDS && !status; kind++) {
            self->kind = (footprint_kind)kind;
            status = write_point(self, &data->point[i], error);
        }
    self->format->end(self);
    if (status || self->stated > 0)
        return status;
    footprint_why_not(self->best_kind, &self->best, why);
    if (self->best.needed > 0)
        return ld_fail(error, LD_ERR_INPUT, "no footprint, not even of 95 %%: %s", why);
    return ld_fail(error, LD_ERR_INPUT,
                   "the study has no footprints: fewer than three rockets have landed, or all on "
                   "one line");
}

// ---- where it is

static bool is_of_place(const char *path)
{
    static const char *const below[] = {"environment.site", "environment.earth",
                                        "environment.ground_height"};
    for (size_t i = 0; i < sizeof below / sizeof *below; i++)
        if (strncmp(path, below[i], strlen(below[i])) == 0)
            return true;
    return false;
}

static void find_moving(footprint_writer *self)
{
    const study_data *data = self->data;
    for (int i = 0; i < data->swept_count; i++)
        if (is_of_place(data->swept[i]))
            self->moving = data->swept[i];
    for (int i = data->result_count; i < data->column_count; i++)
        if (is_of_place(data->column[i].name))
            self->moving = data->column[i].name;
}

static ld_status find_place(footprint_writer *self, const char *file, ld_error *error)
{
    const char *text = self->data->scenario;
    ld_model model;
    ld_messages messages;
    ld_status status =
        scenario_read_text(text, strlen(text), "study", ".", NULL, 0, &model, &messages);
    if (status) {
        ld_messages_free(&messages);
        return status == LD_ERR_MEMORY
                   ? no_memory(error)
                   : ld_fail(error, LD_ERR_INPUT, "the study's scenario cannot be read");
    }
    status = footprint_site_of(&model, &self->site, &self->placed) ? no_memory(error) : LD_OK;
    model_clear(&model);
    find_moving(self);
    if (!status && !self->placed)
        return ld_fail(error, LD_ERR_INPUT,
                       "%s requires a position on the Earth: the scenario has no environment.site; "
                       "a .csv file has metres from the launch point",
                       file);
    if (!status && self->moving)
        return ld_fail(error, LD_ERR_INPUT,
                       "%s requires one launch point on the Earth, and %s differs from launch to "
                       "launch; a .csv file has metres from the launch point",
                       file, self->moving);
    return status;
}

static ld_status export_footprints(footprint_writer *self, const char *file, ld_error *error)
{
    const char *nearest, *const *name = study_pairs[STUDY_LANDING].name;
    if (!study_data_find(self->data, name[0], &nearest))
        return ld_fail(error, LD_ERR_INPUT, "the study has no landings: its rockets do not fly");
    ld_status status = self->format->on_earth ? find_place(self, file, error) : LD_OK;
    return status ? status : table_file_print(write_all, self, file, error);
}

ld_status ld_study_export_footprint(const char *folder, const char *file, ld_error *error)
{
    const footprint_format *format = format_of(file);
    if (!format)
        return ld_fail(error, LD_ERR_INPUT,
                       "%s: a file of footprints ends in .csv, .kml or .geojson", file);
    study_data data;
    ld_status status = study_data_open(folder, &data, error);
    if (status)
        return status;
    locale_t before = numeric_locale_enter();
    footprint_writer *self = calloc(1, sizeof *self);
    if (self) {
        self->format = format;
        self->data = &data;
        status = export_footprints(self, file, error);
        study_values_free(&self->values);
        free(self);
    } else {
        status = no_memory(error);
    }
    numeric_locale_leave(before);
    study_data_close(&data);
    return status;
}
