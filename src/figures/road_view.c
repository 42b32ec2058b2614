// Roads to look at: profile and spectrum as tables, files and charts.
#include <stdlib.h>
#include <string.h>

#include "base/printed.h"
#include "environment/road.h"
#include "environment/road_class.h"
#include "figures/chart.h"
#include "launchdyn/environment.h"
#include "math/curves/spectrum.h"
#include "math/functions.h"
#include "model/blocks/base.h"
#include "model/parts.h"
#include "results/columns.h"

enum { MOST_PLACES = 10000000, MOST_BANDS = 200, CLASSES = 8 };

struct ld_road_view {
    const ld_road *model;
    ld_stretch stretch;
    size_t count;
    double *x, *height[ROAD_TRACKS]; // [count]
    size_t bands;
    double edge[MOST_BANDS + 1]; // [1/m]
    double density[ROAD_TRACKS][MOST_BANDS], line[MOST_BANDS];
    bool classified; // there is a random part or a table
    road_estimate estimate[ROAD_TRACKS];
};

static bool is_random(const ld_road *model)
{
    return model->iso_class != LD_ROAD_SMOOTH;
}

static char class_letter(int iso_class)
{
    return (char)('A' + iso_class);
}

// ---- the view ----

static ld_status set_stretch(ld_road_view *view, ld_stretch stretch, ld_error *error)
{
    double usual = is_random(view->model) ? fmin(0.02, view->model->wavelengths[0] / 10) : 0.02;
    ld_stretch *s = &view->stretch;
    s->from = isnan(stretch.from) ? -100 : stretch.from;
    s->to = isnan(stretch.to) ? 100 : stretch.to;
    s->step = isnan(stretch.step) ? usual : stretch.step;
    double places = floor((s->to - s->from) / s->step * (1 + 1e-12)) + 1;
    if (!(s->step > 0 && places >= 2 && places <= MOST_PLACES))
        return ld_fail(error, LD_ERR_INPUT,
                       "a section of road requires 2 to %d points; from %g m to %g m by %g m has "
                       "another number",
                       MOST_PLACES, s->from, s->to, s->step);
    view->count = (size_t)places;
    return LD_OK;
}

// Mean over a band of what the class says.
static double class_mean(const ld_road *model, double from, double to)
{
    return road_class_density(model->iso_class, sqrt(from * to));
}

// Thirds of octaves (base 10), from two periods in the stretch to half the sampling rate; of a
// random road, from end to end of its harmonics.
static void set_bands(ld_road_view *view)
{
    const ld_road *model = view->model;
    double low = 2 / ((double)view->count * view->stretch.step), high = 0.5 / view->stretch.step;
    if (is_random(model)) {
        low = fmax(low, 1 / model->wavelengths[1]);
        high = fmin(high, 1 / model->wavelengths[0]);
    }
    view->bands = 0;
    view->edge[0] = low;
    int third = (int)floor(10 * log10(low) + 1); // a first band at least half as wide
    for (; view->bands < MOST_BANDS && view->edge[view->bands] < high; third++)
        view->edge[++view->bands] = fmin(pow(10, (third + 0.5) / 10), high);
    for (size_t i = 0; i < view->bands; i++)
        view->line[i] =
            is_random(model) ? class_mean(model, view->edge[i], view->edge[i + 1]) : NAN;
}

// By the places on the table and the waves that it and the random part have.
static ld_status classify(ld_road_view *view, ld_error *error)
{
    const ld_road *model = view->model;
    const ld_table *table = &model->profile;
    size_t first = 0, end = view->count;
    double from = 0, to = INFINITY, widest = 0;
    if (is_random(model)) {
        from = 1 / model->wavelengths[1];
        to = 1 / model->wavelengths[0];
    }
    if (table->rows > 0) {
        const double *row = table->data;
        for (size_t i = 1; i < table->rows; i++, row += table->columns)
            widest = fmax(widest, row[table->columns] - row[0]);
        while (first < end && view->x[first] < table->data[0])
            first++;
        while (end > first && view->x[end - 1] > row[0])
            end--;
        to = fmin(to, 0.25 / widest);
    }
    view->classified = is_random(model) || table->rows > 0;
    ld_status status = LD_OK;
    for (int track = 0; track < ROAD_TRACKS && view->classified && !status; track++) {
        const road_record record = {.count = end - first,
                                    .step = view->stretch.step,
                                    .height = view->height[track] + first,
                                    .from = from,
                                    .to = to};
        status = road_classify(&record, &view->estimate[track], error);
    }
    return status;
}

static ld_status fill(ld_road_view *view, ld_error *error)
{
    road *self = NULL;
    const ld_stretch *s = &view->stretch;
    view->x = malloc(3 * view->count * sizeof(double));
    if (!view->x)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %zu points", view->count);
    for (size_t i = 0; i < view->count; i++)
        view->x[i] = s->from + (double)i * s->step;
    const road_places places = {s->from, s->step, view->count};
    ld_status status = road_build(view->model, s->from, s->from, &self, error);
    for (int track = 0; track < ROAD_TRACKS && !status; track++) {
        view->height[track] = view->x + (size_t)(track + 1) * view->count;
        status = road_profile(self, (road_track)track, &places, view->height[track], error);
    }
    road_free(self);
    set_bands(view);
    const spectrum_series tracks = {view->count, s->step, view->height[ROAD_LEFT],
                                    view->height[ROAD_RIGHT]};
    const spectrum_bands bands = {.count = view->bands,
                                  .edge = view->edge,
                                  .aa = view->density[ROAD_LEFT],
                                  .bb = view->density[ROAD_RIGHT]};
    if (!status)
        status = spectrum_in_bands(&tracks, &bands, error);
    if (!status)
        status = classify(view, error);
    return status;
}

ld_status ld_road_view_create(const ld_model *model, ld_stretch stretch, ld_road_view **view,
                              ld_error *error)
{
    if (!model_has_vehicle(model))
        return ld_fail(error, LD_ERR_INPUT, "there is no road: the base is not a vehicle");
    ld_road_view *created = calloc(1, sizeof *created);
    if (!created)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a road");
    created->model = &model_base(model)->vehicle.road;
    ld_status status = set_stretch(created, stretch, error);
    if (!status)
        status = fill(created, error);
    if (status)
        ld_road_view_free(created);
    else
        *view = created;
    return status;
}

void ld_road_view_free(ld_road_view *view)
{
    if (view)
        free(view->x);
    free(view);
}

// ---- as a table ----

static void describe(const ld_road_view *view, char *text, size_t size)
{
    static const char *const tracks[] = {"same", "independent", "coherent"};
    const ld_road *model = view->model;
    if (is_random(model))
        snprintf(text, size, "Road: class %c, seed %d, tracks %s", class_letter(model->iso_class),
                 model->seed, tracks[model->tracks]);
    else
        snprintf(text, size, "Road without a random part");
}

static void print_heights(const ld_road_view *view, FILE *stream)
{
    double rms[2], low[2], high[2];
    for (int track = 0; track < ROAD_TRACKS; track++) {
        const double *h = view->height[track];
        double mean = 0, square = 0;
        low[track] = high[track] = h[0];
        for (size_t i = 0; i < view->count; i++) {
            mean += h[i] / (double)view->count;
            low[track] = fmin(low[track], h[i]);
            high[track] = fmax(high[track], h[i]);
        }
        for (size_t i = 0; i < view->count; i++)
            square += (h[i] - mean) * (h[i] - mean) / (double)view->count;
        rms[track] = sqrt(square);
    }
    fprintf(stream, "\nHeight [mm]%18s%12s\n", "left", "right");
    fprintf(stream, "  rms about the mean%9.3f%12.3f\n", 1e3 * rms[0], 1e3 * rms[1]);
    fprintf(stream, "  lowest%21.3f%12.3f\n", printed_fixed(1e3 * low[0], 3),
            printed_fixed(1e3 * low[1], 3));
    fprintf(stream, "  highest%20.3f%12.3f\n", printed_fixed(1e3 * high[0], 3),
            printed_fixed(1e3 * high[1], 3));
}

static void print_class(const ld_road_view *view, FILE *stream)
{
    static const char *const names[] = {"left", "right"};
    const road_estimate *estimate = view->estimate;
    if (!view->classified)
        return;
    if (isnan(estimate->density)) {
        fprintf(stream,
                "\nClass of ISO 8608: not determined; it requires waves of 5 m to 10 m, the "
                "section has those of %.2g m to %.2g m\n",
                1 / estimate->to, 1 / estimate->from);
        return;
    }
    fprintf(stream, "\nClass of ISO 8608 by waves of %.2g m to %.2g m, G_d(0.1/m) [1e-6 m3]\n",
            1 / estimate->to, 1 / estimate->from);
    for (int track = 0; track < ROAD_TRACKS; track++, estimate++) {
        double density = 1e6 * estimate->density, factor = estimate->factor;
        fprintf(stream, "  %-7s%c%12.4g, 95 %% from %.4g to %.4g", names[track],
                class_letter(estimate->nearest), density, density / factor, density * factor);
        if (estimate->lowest != estimate->highest)
            fprintf(stream, ", class %c to %c", class_letter(estimate->lowest),
                    class_letter(estimate->highest));
        fputc('\n', stream);
    }
}

void ld_road_view_print(const ld_road_view *view, FILE *stream)
{
    char title[128];
    describe(view, title, sizeof title);
    fprintf(stream, "%s, x = %g m to %g m every %g m\n", title, view->stretch.from,
            view->stretch.to, view->stretch.step);
    print_heights(view, stream);
    print_class(view, stream);
    fprintf(stream, "\nPower spectral density [1e-6 m3]\n  n [1/m]%28s%12s", "left", "right");
    if (is_random(view->model))
        fprintf(stream, "%11s%c", "class ", class_letter(view->model->iso_class));
    for (size_t i = 0; i < view->bands; i++) {
        fprintf(stream, "\n  %8.4f to %8.4f%13.4g%12.4g", view->edge[i], view->edge[i + 1],
                1e6 * view->density[ROAD_LEFT][i], 1e6 * view->density[ROAD_RIGHT][i]);
        if (is_random(view->model))
            fprintf(stream, "%12.4g", 1e6 * view->line[i]);
    }
    fputc('\n', stream);
}

// ---- as files ----

ld_status ld_road_view_write(const ld_road_view *view, const char *folder, ld_error *error)
{
    static const ld_column places[] = {
        {.name = "x", .unit = "m"}, {.name = "left", .unit = "m"}, {.name = "right", .unit = "m"}};
    static const ld_column bands[] = {{.name = "from", .unit = "1/m"},
                                      {.name = "to", .unit = "1/m"},
                                      {.name = "left", .unit = "m3"},
                                      {.name = "right", .unit = "m3"},
                                      {.name = "class", .unit = "m3"}};
    const double *const profile[] = {view->x, view->height[0], view->height[1]};
    const double *const spectrum[] = {view->edge, view->edge + 1, view->density[0],
                                      view->density[1], view->line};
    const number_columns of_places = {3, view->count, places, profile};
    const number_columns of_bands = {is_random(view->model) ? 5 : 4, view->bands, bands, spectrum};
    ld_status status = columns_write(folder, "road.csv", &of_places, error);
    return status ? status : columns_write(folder, "road-spectrum.csv", &of_bands, error);
}

// ---- as charts ----

ld_status ld_road_view_draw(const ld_road_view *view, const char *file, ld_error *error)
{
    char title[128], names[CLASSES][16];
    double middle[MOST_BANDS], lines[CLASSES][MOST_BANDS + 1];
    chart charts[2] = {{.title = "Height",
                        .x_label = "x [m]",
                        .y_label = "height [mm]",
                        .x_factor = 1,
                        .y_factor = 1e3},
                       {.title = "Power spectral density",
                        .x_label = "spatial frequency n [1/m]",
                        .y_label = "density [10⁻⁶ m³]",
                        .x_factor = 1,
                        .y_factor = 1e6,
                        .log_x = true,
                        .log_y = true}};
    bool same = memcmp(view->height[0], view->height[1], view->count * sizeof(double)) == 0;
    for (size_t i = 0; i < view->bands; i++)
        middle[i] = sqrt(view->edge[i] * view->edge[i + 1]);
    for (int i = 0; i < CLASSES; i++) {
        snprintf(names[i], sizeof names[i], "class %c", class_letter(i));
        for (size_t j = 0; j <= view->bands; j++)
            lines[i][j] = road_class_density(i, view->edge[j]);
        charts[1].curve[charts[1].count++] = (chart_curve){.label = names[i],
                                                           .count = view->bands + 1,
                                                           .x = view->edge,
                                                           .y = lines[i],
                                                           .faint = true};
    }
    for (int track = 0; track < (same ? 1 : 2); track++) {
        const char *label = same ? "both tracks" : track == ROAD_LEFT ? "left" : "right";
        charts[0].curve[charts[0].count++] = (chart_curve){
            .label = label, .count = view->count, .x = view->x, .y = view->height[track]};
        charts[1].curve[charts[1].count++] = (chart_curve){
            .label = label, .count = view->bands, .x = middle, .y = view->density[track]};
    }
    describe(view, title, sizeof title);
    return charts_draw(file, title, charts, 2, error);
}
