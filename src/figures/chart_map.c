#include "figures/chart_map.h"

#include <math.h>

#include "figures/labels.h"
#include "figures/plot.h"

// Dark to light, readable in grey: viridis (S. van der Walt, N. Smith, CC0). Apart: blue to red.
static const char rising[] = "0 '#440154', 1 '#46327e', 2 '#365c8d', 3 '#277f8e', 4 '#1fa187', "
                             "5 '#4ac16d', 6 '#a0da39', 7 '#fde725'";
static const char apart[] = "0 '#2166ac', 1 '#67a9cf', 2 '#f7f7f7', 3 '#ef8a62', 4 '#b2182b'";
enum { LETTERS = 10, LINE = 14, BAR = 107 }; // BAR: from the axes to the name of the bar

void chart_map_ranges(const chart_map *self, double x[2], double y[2])
{
    x[0] = self->x_edge[0], x[1] = self->x_edge[self->columns];
    y[0] = self->y_edge[0], y[1] = self->y_edge[self->rows];
}

// Of the colours; never of no width.
static void find_range(const chart_map *self, double range[2])
{
    range[0] = INFINITY, range[1] = -INFINITY;
    for (int i = 0; i < self->columns * self->rows; i++)
        if (isfinite(self->value[i])) {
            range[0] = fmin(range[0], self->value[i]);
            range[1] = fmax(range[1], self->value[i]);
        }
    if (self->centred) {
        double most = fmax(fabs(range[0] - self->middle), fabs(range[1] - self->middle));
        range[0] = self->middle - most, range[1] = self->middle + most;
    }
    if (!(range[1] > range[0]) || !isfinite(range[1] - range[0])) {
        double middle = isfinite(range[0]) ? range[0] : 0, room = fmax(1e-3 * fabs(middle), 1e-9);
        range[0] = middle - room, range[1] = middle + room;
    }
}

// Where white letters are read on the cell.
static bool is_dark(const chart_map *self, double value, const double range[2])
{
    double at = (value - range[0]) / (range[1] - range[0]);
    return self->centred ? at < 0.15 || at > 0.85 : at < 0.55;
}

typedef struct map_room {
    double x, y; // [pixels] of a unit of the axes
} map_room;

static void write_text(FILE *script, const char *text, double x, double y, double down, bool dark)
{
    fputs("set label ", script);
    plot_write_quoted(script, text);
    fprintf(script, " at first %.9g, first %.9g center offset 0,%g front font ',%d' tc rgb '%s'\n",
            x, y, -down, LETTERS, dark ? "#ffffff" : "#202020");
}

// Value and interval of a cell, as far as there is room.
static void write_texts(FILE *script, const chart_map *self, int cell, const map_room *pixels,
                        bool dark)
{
    int i = cell / self->rows, j = cell % self->rows;
    const double *x = &self->x_edge[i], *y = &self->y_edge[j];
    double width = pixels->x * (x[1] - x[0]) - 4, height = pixels->y * (y[1] - y[0]);
    const char *const *text = self->text[cell];
    bool one = height > LINE && label_width(text[0], LETTERS) < 1.15 * width;
    bool two =
        one && *text[1] && height > 2.2 * LINE && label_width(text[1], LETTERS) < 1.15 * width;
    if (one)
        write_text(script, text[0], 0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), two ? -0.4 : 0, dark);
    if (two)
        write_text(script, text[1], 0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 0.5, dark);
}

static void write_cells(FILE *script, const chart_map *self, size_t index)
{
    char block[32];
    int lines = 0;
    snprintf(block, sizeof block, "$m%zu", index);
    fprintf(script, "%s << EOD\n", block);
    for (int cell = 0; cell < self->columns * self->rows; cell++) {
        const double *x = &self->x_edge[cell / self->rows], *y = &self->y_edge[cell % self->rows];
        if (!isfinite(self->value[cell]))
            continue;
        fprintf(script, "%.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", 0.5 * (x[0] + x[1]),
                0.5 * (y[0] + y[1]), x[0], x[1], y[0], y[1], self->value[cell]);
        lines++;
    }
    plot_end_data(script, block, lines);
}

static void write_ticks(FILE *script, char axis, const double *tick, int count)
{
    if (!tick)
        return;
    fprintf(script, "set %ctics (", axis);
    for (int i = 0; i < count; i++)
        fprintf(script, "%s%.9g", i ? ", " : "", tick[i]);
    fputs(")\n", script);
}

void chart_map_write(FILE *script, const chart_map *self, size_t index, double width, double height)
{
    double range[2], x[2], y[2];
    find_range(self, range);
    chart_map_ranges(self, x, y);
    const map_room pixels = {width / (x[1] - x[0]), height / (y[1] - y[0])};
    write_cells(script, self, index);
    fprintf(script,
            "set palette defined (%s)\nset cbrange [%.9g:%.9g]\nunset cblabel\nset colorbox\nset "
            "label ",
            self->centred ? apart : rising, range[0], range[1]);
    plot_write_quoted(script, self->label);
    fprintf(script, " at graph %.6f, graph 0.5 center rotate font ',10'\n", 1 + BAR / width);
    write_ticks(script, 'x', self->x_tick, self->columns);
    write_ticks(script, 'y', self->y_tick, self->rows);
    for (int cell = 0; cell < self->columns * self->rows; cell++)
        if (isfinite(self->value[cell]))
            write_texts(script, self, cell, &pixels, is_dark(self, self->value[cell], range));
    fprintf(script,
            "plot $m%zu using 1:2:3:4:5:6:7 with boxxyerror fs solid noborder lc palette "
            "notitle\n",
            index);
}
