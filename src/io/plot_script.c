// The gnuplot script of a page of figures, with its data in it.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/numeric_locale.h"
#include "io/plot.h"

// Lengths of the page in pixels of the svg; pdf takes one for a point, png makes two of it.
enum {
    WIDTH = 1000,
    TITLE = 34,
    HEADING = 34,
    PANEL = 240,
    LEFT = 75,
    RIGHT = 25,
    TOP = 44,
    BOTTOM = 50
};
enum { MOST_CURVES = 16 };

typedef struct instant {
    const char *name;
    double t;           // [s] from ignition
    const char *offset; // of the name from a point of a curve, in letters
} instant;

enum { INSTANTS = 4 };

// A curve of a panel, found in the history.
typedef struct found_curve {
    const double *y;
    char label[LD_MAX_NAME + 8];
} found_curve;

// A panel in the making: its curves in the units shown, its place and its axes.
typedef struct plot_drawing {
    FILE *script;
    const history_data *history;
    const plot_panel *panel;
    const char *heading;     // of the figure, to be written with its first panel, or NULL
    int index;               // of the panel on the page
    double height;           // of the page
    double left, top, width; // of the panel on the page, from above
    double *x, *y;           // [rows] scaled values of one curve; x is kept
    char *keep;              // [rows] points that are drawn
    size_t *stack;           // [2 rows] of the thinning
    int count;               // curves
    found_curve curve[MOST_CURVES];
    double x_range[2], y_range[2];
    const double *t; // [s] on the run's clock
    double t_ignition;
    instant instant[INSTANTS];
} plot_drawing;

// ---- curves ----

// Whether `name` is the pattern, whose one '*' stands for any text; that text becomes the label.
static bool matches(const char *name, const char *pattern, char *label, size_t size)
{
    const char *star = strchr(pattern, '*');
    if (!star)
        return strcmp(name, pattern) == 0;
    size_t before = (size_t)(star - pattern), after = strlen(star + 1), length = strlen(name);
    if (length <= before + after || strncmp(name, pattern, before) != 0 ||
        strcmp(name + length - after, star + 1) != 0)
        return false;
    snprintf(label, size, "%.*s", (int)(length - before - after), name + before);
    return true;
}

static bool any_finite(const double *values, size_t rows)
{
    for (size_t i = 0; i < rows; i++)
        if (isfinite(values[i]))
            return true;
    return false;
}

static void find_curves(plot_drawing *drawing)
{
    const history_data *history = drawing->history;
    drawing->count = 0;
    for (const plot_curve *wanted = drawing->panel->curve; wanted->column; wanted++)
        for (size_t i = 0; i < history->columns && drawing->count < MOST_CURVES; i++) {
            found_curve *curve = &drawing->curve[drawing->count];
            snprintf(curve->label, sizeof curve->label, "%s", wanted->label);
            if (!matches(history->name[i], wanted->column, curve->label, sizeof curve->label))
                continue;
            curve->y = history->value + i * history->rows;
            drawing->count += any_finite(curve->y, history->rows);
        }
}

// The values of the x axis, in the units shown; false where there is no such column.
static bool set_x(plot_drawing *drawing)
{
    const plot_panel *panel = drawing->panel;
    const double *column = drawing->t;
    double shift = drawing->t_ignition, factor = 1e3;
    if (panel->x_column) {
        column = history_column(drawing->history, panel->x_column);
        shift = 0;
        factor = panel->x_factor;
    }
    for (size_t i = 0; column && i < drawing->history->rows; i++)
        drawing->x[i] = (column[i] - shift) * factor;
    return column != NULL;
}

static void set_y(plot_drawing *drawing, int curve)
{
    for (size_t i = 0; i < drawing->history->rows; i++)
        drawing->y[i] = drawing->curve[curve].y[i] * drawing->panel->y_factor;
}

static bool drawable(const plot_drawing *drawing, size_t i)
{
    return isfinite(drawing->x[i]) && isfinite(drawing->y[i]);
}

static void include(double range[2], double value)
{
    range[0] = fmin(range[0], value);
    range[1] = fmax(range[1], value);
}

// Room around the values; something to draw even where they are all the same.
static void widen(double range[2], double share)
{
    double room = (range[1] - range[0]) * share, largest = fmax(fabs(range[0]), fabs(range[1]));
    if (!(room > largest * 1e-12))
        room = largest > 0 ? largest * 0.1 : 1;
    range[0] -= room;
    range[1] += room;
}

// The ranges of what is drawn; 0 to 1 where that is nothing.
static void set_ranges(plot_drawing *drawing)
{
    double x[2] = {INFINITY, -INFINITY}, y[2] = {INFINITY, -INFINITY};
    for (int i = 0; i < drawing->count; i++) {
        set_y(drawing, i);
        for (size_t row = 0; row < drawing->history->rows; row++)
            if (drawable(drawing, row)) {
                include(x, drawing->x[row]);
                include(y, drawing->y[row]);
            }
    }
    if (x[0] > x[1]) {
        drawing->count = 0;
        x[0] = y[0] = 0;
        x[1] = y[1] = 1;
    }
    widen(x, drawing->panel->x_column ? 0.05 : 0.01);
    widen(y, 0.06);
    memcpy(drawing->x_range, x, sizeof x);
    memcpy(drawing->y_range, y, sizeof y);
}

// ---- thinning: points that would not be seen are left out (Douglas and Peucker) ----

// Square of the distance of point i from the straight line a to b, in shares of the panel.
static double distance2(const plot_drawing *drawing, size_t i, size_t a, size_t b)
{
    double across = drawing->x_range[1] - drawing->x_range[0],
           up = drawing->y_range[1] - drawing->y_range[0];
    double bx = (drawing->x[b] - drawing->x[a]) / across, by = (drawing->y[b] - drawing->y[a]) / up;
    double ix = (drawing->x[i] - drawing->x[a]) / across, iy = (drawing->y[i] - drawing->y[a]) / up;
    double length2 = bx * bx + by * by;
    double along = length2 > 0 ? fmin(fmax((ix * bx + iy * by) / length2, 0), 1) : 0;
    double dx = ix - along * bx, dy = iy - along * by;
    return dx * dx + dy * dy;
}

// Marks the points between a and b that the curve needs.
static void thin(plot_drawing *drawing, size_t first, size_t last)
{
    const double seen = 1.0 / 3000;
    size_t depth = 0, *stack = drawing->stack;
    drawing->keep[first] = drawing->keep[last] = 1;
    stack[depth++] = first;
    stack[depth++] = last;
    while (depth > 0) {
        size_t b = stack[--depth], a = stack[--depth], far = a;
        double farthest = seen * seen;
        for (size_t i = a + 1; i < b; i++) {
            double d2 = distance2(drawing, i, a, b);
            if (d2 > farthest) {
                farthest = d2;
                far = i;
            }
        }
        if (far == a)
            continue;
        drawing->keep[far] = 1;
        size_t parts[] = {a, far, far, b};
        memcpy(stack + depth, parts, sizeof parts);
        depth += 4;
    }
}

// Each run of drawable points becomes a line; an empty line of data parts them.
static void write_curve(plot_drawing *drawing, int curve)
{
    size_t rows = drawing->history->rows;
    set_y(drawing, curve);
    memset(drawing->keep, 0, rows);
    fprintf(drawing->script, "$p%dc%d << EOD\n", drawing->index, curve);
    for (size_t first = 0; first < rows; first++) {
        if (!drawable(drawing, first))
            continue;
        size_t last = first;
        while (last + 1 < rows && drawable(drawing, last + 1))
            last++;
        thin(drawing, first, last);
        for (size_t i = first; i <= last; i++)
            if (drawing->keep[i])
                fprintf(drawing->script, "%.8g %.8g\n", drawing->x[i], drawing->y[i]);
        fputc('\n', drawing->script);
        first = last;
    }
    fputs("EOD\n", drawing->script);
}

// ---- the panel ----

// Text between the single quotes of gnuplot.
static void write_quoted(FILE *script, const char *text)
{
    fputc('\'', script);
    for (; *text; text++) {
        if (*text == '\'')
            fputc('\'', script);
        fputc((unsigned char)*text < 0x20 ? ' ' : *text, script);
    }
    fputc('\'', script);
}

// A vertical line at each key instant, its name above; where names would meet, one step higher.
static void write_instants_in_time(const plot_drawing *drawing)
{
    double pixels = drawing->width - LEFT - RIGHT,
           across = drawing->x_range[1] - drawing->x_range[0], before = -INFINITY;
    bool raised = false;
    for (int i = 0; i < INSTANTS; i++) {
        double x = drawing->instant[i].t * 1e3;
        if (!(x >= drawing->x_range[0] && x <= drawing->x_range[1]))
            continue;
        fprintf(drawing->script,
                "set arrow from %.8g, graph 0 to %.8g, graph 1 nohead lw 1 dt (4,3) lc rgb "
                "'#808080' back\n",
                x, x);
        double place = (x - drawing->x_range[0]) / across * pixels;
        raised = !raised && place - before < 45;
        before = place;
        fprintf(drawing->script, "set label '%s' at %.8g, graph %g %s font ',9' tc rgb '#606060'\n",
                drawing->instant[i].name, x, raised ? 1.10 : 1.03, place < 20 ? "left" : "center");
    }
}

// A ring on the curve at each key instant, its name beside it.
static void write_instants_on_curve(plot_drawing *drawing)
{
    set_y(drawing, 0);
    for (int i = 0; i < INSTANTS; i++) {
        double t = drawing->instant[i].t + drawing->t_ignition;
        size_t nearest = drawing->history->rows;
        for (size_t row = 0; row < drawing->history->rows; row++)
            if (drawable(drawing, row) &&
                (nearest == drawing->history->rows ||
                 fabs(drawing->t[row] - t) < fabs(drawing->t[nearest] - t)))
                nearest = row;
        if (isfinite(t) && nearest < drawing->history->rows)
            fprintf(drawing->script,
                    "set label '%s' at %.8g, %.8g point pt 7 ps 0.6 lc rgb '#404040' offset %s "
                    "font ',9' tc rgb '#606060' front\n",
                    drawing->instant[i].name, drawing->x[nearest], drawing->y[nearest],
                    drawing->instant[i].offset);
    }
}

// A text at a place of the page, `top` pixels below its upper edge.
static void write_text(const plot_drawing *drawing, const char *text, double left, double top,
                       const char *style)
{
    fputs("set label ", drawing->script);
    write_quoted(drawing->script, text);
    fprintf(drawing->script, " at screen %.6f, screen %.6f %s\n", left / WIDTH,
            1 - top / drawing->height, style);
}

static void write_headings(plot_drawing *drawing)
{
    const char *title = drawing->history->title;
    if (drawing->index == 0 && title)
        write_text(drawing, title, 16, TITLE * 0.55, "left font ',17'");
    if (drawing->heading) {
        double above = 1 - (drawing->top - HEADING) / drawing->height;
        fprintf(drawing->script,
                "set arrow from screen 0.016, screen %.6f to screen 0.984, screen %.6f nohead lw 1 "
                "lc rgb '#c0c0c0'\n",
                above, above);
        write_text(drawing, drawing->heading, 16, drawing->top - HEADING * 0.35, "left font ',14'");
    }
    drawing->heading = NULL;
}

static void write_axes(plot_drawing *drawing)
{
    const plot_panel *panel = drawing->panel;
    FILE *script = drawing->script;
    double top = drawing->top + TOP, bottom = drawing->top + PANEL - BOTTOM;
    char unit[64];
    fprintf(script, "set lmargin at screen %.6f\nset rmargin at screen %.6f\n",
            (drawing->left + LEFT) / WIDTH, (drawing->left + drawing->width - RIGHT) / WIDTH);
    fprintf(script, "set tmargin at screen %.6f\nset bmargin at screen %.6f\n",
            1 - top / drawing->height, 1 - bottom / drawing->height);
    fprintf(script, "set xrange [%.8g:%.8g]\nset yrange [%.8g:%.8g]\n", drawing->x_range[0],
            drawing->x_range[1], drawing->y_range[0], drawing->y_range[1]);
    snprintf(unit, sizeof unit, panel->x_column ? "%s" : "[%s]", panel->y_label);
    write_text(drawing, panel->title, drawing->left + LEFT, top - 26, "left font ',11'");
    write_text(drawing, unit, drawing->left + 18, (top + bottom) / 2,
               "center rotate by 90 font ',10'");
    write_text(drawing, panel->x_column ? panel->x_label : "time from ignition [ms]",
               drawing->left + (LEFT + drawing->width - RIGHT) / 2, bottom + 34,
               "center font ',10'");
}

static void write_plot(const plot_drawing *drawing)
{
    FILE *script = drawing->script;
    for (int i = 0; i < drawing->count; i++) {
        fprintf(script, "%s $p%dc%d using 1:2 with lines ls %d ", i ? ", \\\n    " : "plot",
                drawing->index, i, i % 6 + 1);
        if (*drawing->curve[i].label) {
            fputs("title ", script);
            write_quoted(script, drawing->curve[i].label);
        } else {
            fputs("notitle", script);
        }
    }
    if (drawing->count == 0)
        fputs("set label 'nothing to show' at graph 0.5, 0.5 center\nplot NaN notitle", script);
    fputc('\n', script);
}

static void write_panel(plot_drawing *drawing)
{
    find_curves(drawing);
    if (!set_x(drawing))
        drawing->count = 0;
    set_ranges(drawing);
    for (int i = 0; i < drawing->count; i++)
        write_curve(drawing, i);
    fputs("unset label\nunset arrow\n", drawing->script);
    write_headings(drawing);
    write_axes(drawing);
    if (drawing->count > 0 && drawing->panel->x_column)
        write_instants_on_curve(drawing);
    else if (drawing->count > 0)
        write_instants_in_time(drawing);
    write_plot(drawing);
    drawing->index++;
}

// ---- the page ----

// Places of the panels of a figure from `top` on; returns where the next figure begins. Draws them
// if `drawing` is not NULL.
static double place_panels(const plot_figure *figure, double top, plot_drawing *drawing)
{
    bool right = false;
    top += HEADING;
    if (drawing)
        drawing->heading = figure->about.description;
    for (int i = 0; i < PLOT_PANELS && figure->panel[i].title; i++) {
        const plot_panel *panel = &figure->panel[i];
        if (drawing) {
            drawing->panel = panel;
            drawing->left = right ? WIDTH / 2.0 : 0;
            drawing->width = panel->wide ? WIDTH : WIDTH / 2.0;
            drawing->top = top;
            write_panel(drawing);
        }
        right = !right && !panel->wide;
        if (!right)
            top += PANEL;
    }
    return right ? top + PANEL : top;
}

static double page_height(const plot_figure *const *figures, size_t count)
{
    double height = TITLE;
    for (size_t i = 0; i < count; i++)
        height = place_panels(figures[i], height, NULL);
    return height;
}

static void write_terminal(FILE *script, plot_format format, double height, const char *output)
{
    if (format == PLOT_SVG)
        fprintf(script, "set terminal svg size %d,%.0f font 'sans-serif,12' background 'white'",
                WIDTH, height);
    else if (format == PLOT_PDF)
        fprintf(script,
                "set terminal pdfcairo size %.4fin,%.4fin font 'sans-serif,12' fontscale 0.75",
                WIDTH / 72.0, height / 72);
    else
        fprintf(script,
                "set terminal pngcairo size %d,%.0f font 'sans-serif,12' fontscale 1.5 linewidth "
                "2 pointscale 2 background 'white'",
                2 * WIDTH, 2 * height);
    fputs(" noenhanced\nset encoding utf8\nset output ", script);
    write_quoted(script, output);
    fputs("\nset multiplot\n"
          "set key at graph 1, 1.15 right center horizontal Left reverse samplen 2 font ',10'\n"
          "set grid lc rgb '#e0e0e0' lw 0.8\nset border 3 lc rgb '#404040'\n"
          "set tics nomirror font ',10'\nset format '%g'\n",
          script);
    static const char *const colour[] = {"0072B2", "D55E00", "009E73",
                                         "CC79A7", "E69F00", "56B4E9"};
    for (int i = 0; i < 6; i++)
        fprintf(script, "set style line %d lw 1.5 lc rgb '#%s'\n", i + 1, colour[i]);
}

ld_status plot_write_script(FILE *script, const history_data *history,
                            const plot_figure *const *figures, size_t count, plot_format format,
                            const char *output, ld_error *error)
{
    size_t rows = history->rows;
    plot_drawing drawing = {
        .script = script,
        .history = history,
        .height = page_height(figures, count),
        .x = malloc(rows * sizeof(double)),
        .y = malloc(rows * sizeof(double)),
        .keep = malloc(rows),
        .stack = malloc((2 * rows + 8) * sizeof(size_t)),
        .t = history_column(history, "t"),
        .t_ignition = isfinite(history->t_ignition) ? history->t_ignition : 0,
        .instant = {{"release", history->t_release, "-3.2, -0.8"},
                    {"front", history->t_front, "0.8, 0.6"},
                    {"middle", history->t_middle, "0.8, -0.8"},
                    {"rear", history->t_rear, "0.8, 0.6"}},
    };
    ld_status status = LD_OK;
    if (!drawing.x || !drawing.y || !drawing.keep || !drawing.stack) {
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the figures");
    } else if (!drawing.t) {
        status = ld_fail(error, LD_ERR_INPUT, "the history has no column t");
    } else {
        locale_t before = numeric_locale_enter();
        write_terminal(script, format, drawing.height, output);
        double top = TITLE;
        for (size_t i = 0; i < count; i++)
            top = place_panels(figures[i], top, &drawing);
        fputs("unset multiplot\nunset output\n", script);
        numeric_locale_leave(before);
    }
    free(drawing.x);
    free(drawing.y);
    free(drawing.keep);
    free(drawing.stack);
    return status;
}
