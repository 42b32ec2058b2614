#include "figures/chart.h"

#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "figures/chart_map.h"
#include "figures/labels.h"
#include "figures/plot.h"
#include "math/functions.h"

// Pixels of the svg: of the heading, a chart, and from its edges to the axes.
enum { HEADING = 40, HEIGHT = 330, LEFT = 78, RIGHT = 25, TOP = 58, BOTTOM = 52, COLOURS = 115 };

typedef struct chart_page {
    const char *heading;
    const chart *charts;
    size_t count;
} chart_page;

// The values of one curve as they are drawn, and which of them are needed.
typedef struct drawn_curve {
    size_t count;
    plot_line line;
} drawn_curve;

static ld_status allocate(drawn_curve *drawn, const chart_page *page, ld_error *error)
{
    size_t most = 0;
    for (size_t i = 0; i < page->count; i++)
        for (int j = 0; j < page->charts[i].count; j++)
            if (page->charts[i].curve[j].count > most)
                most = page->charts[i].curve[j].count;
    drawn->line.x = malloc((2 * most + 1) * sizeof(double));
    drawn->line.y = drawn->line.x + most;
    drawn->line.keep = malloc(most + 1);
    drawn->line.stack = malloc((2 * most + 8) * sizeof(size_t));
    if (!drawn->line.x || !drawn->line.keep || !drawn->line.stack)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the charts");
    return LD_OK;
}

static void set_values(drawn_curve *drawn, const chart *self, const chart_curve *curve)
{
    drawn->count = curve->count;
    for (size_t i = 0; i < curve->count; i++) {
        double x = curve->x[i] * self->x_factor, y = curve->y[i] * self->y_factor;
        drawn->line.x[i] = self->log_x ? log10(x) : x;
        drawn->line.y[i] = self->log_y ? log10(y) : y;
    }
}

static bool drawable(const drawn_curve *drawn, size_t i)
{
    return isfinite(drawn->line.x[i]) && isfinite(drawn->line.y[i]);
}

// By the interval of a dot or a bar, which begins at 0.
static void widen(const chart_curve *curve, size_t i, double factor, double range[2])
{
    if (curve->bar > 0)
        range[0] = fmin(range[0], 0), range[1] = fmax(range[1], 0);
    if (!curve->low || !isfinite(curve->low[i]) || !isfinite(curve->high[i]))
        return;
    range[0] = fmin(range[0], curve->low[i] * factor);
    range[1] = fmax(range[1], curve->high[i] * factor);
}

static bool has_bars(const chart *self)
{
    return self->count > 0 && self->curve[0].bar > 0;
}

// Words have half a place each to both sides; dots stand clear of the axes.
static void room_beside(const chart *self, double x[2])
{
    bool apart = self->count > 0 && (self->curve[0].dots || has_bars(self));
    double room = x[1] > x[0] && apart ? 0.03 * (x[1] - x[0]) : 0;
    x[0] -= room, x[1] += room;
    if (self->x_words.count > 0)
        x[0] = -0.5, x[1] = self->x_words.count - 0.5;
}

// Ranges of the curves that are not faint, with some room above and below.
static void set_ranges(drawn_curve *drawn, const chart *self, double x[2], double y[2])
{
    x[0] = y[0] = INFINITY;
    x[1] = y[1] = -INFINITY;
    for (int j = 0; j < self->count; j++) {
        set_values(drawn, self, &self->curve[j]);
        for (size_t i = 0; i < drawn->count; i++)
            if (!self->curve[j].faint && drawable(drawn, i)) {
                x[0] = fmin(x[0], drawn->line.x[i]), x[1] = fmax(x[1], drawn->line.x[i]);
                y[0] = fmin(y[0], drawn->line.y[i]), y[1] = fmax(y[1], drawn->line.y[i]);
                if (self->curve[j].bar > 0)
                    widen(&self->curve[j], i, self->x_factor, x);
                else
                    widen(&self->curve[j], i, self->y_factor, y);
            }
    }
    if (self->levelled)
        y[0] = fmin(y[0], self->level), y[1] = fmax(y[1], self->level);
    room_beside(self, x);
    double room = fmax(0.06 * (y[1] - y[0]), 1e-6 * fmax(fabs(y[0]), fabs(y[1])));
    if (!(x[1] > x[0]))
        x[0] = 0, x[1] = 1;
    if (!(room > 0))
        room = 1;
    if (!(y[1] >= y[0]))
        y[0] = y[1] = 0;
    if (self->log_y && self->decades > 0)
        y[0] = fmax(y[0], y[1] - self->decades);
    y[0] -= room, y[1] += room;
    if (has_bars(self)) // the first on top
        y[0] = self->y_words.count - 0.5, y[1] = -0.5;
}

// Of a dot or bar the ends of its interval, too; without one those are the dot.
static void write_point(FILE *script, const chart *self, const chart_curve *curve, size_t i)
{
    double x = curve->x[i] * self->x_factor, y = curve->y[i] * self->y_factor;
    fprintf(script, curve->low ? "%.9g %.9g" : "%.6g %.6g", x, y);
    if (curve->low) {
        bool known = isfinite(curve->low[i]) && isfinite(curve->high[i]);
        double factor = curve->bar > 0 ? self->x_factor : self->y_factor;
        double middle = curve->bar > 0 ? x : y;
        fprintf(script, " %.9g %.9g", known ? curve->low[i] * factor : middle,
                known ? curve->high[i] * factor : middle);
    }
    fputc('\n', script);
}

// Each run of drawable points becomes a line; an empty line of data parts them.
static void write_data(FILE *script, size_t index, int j, const drawn_curve *drawn,
                       const chart *self)
{
    memset(drawn->line.keep, 0, drawn->count);
    char block[48];
    int lines = 0;
    snprintf(block, sizeof block, "$c%zud%d", index, j);
    fprintf(script, "%s << EOD\n", block);
    for (size_t first = 0; first < drawn->count; first++) {
        if (!drawable(drawn, first))
            continue;
        size_t last = first;
        while (last + 1 < drawn->count && drawable(drawn, last + 1))
            last++;
        plot_thin(&drawn->line, first, last);
        for (size_t i = first; i <= last; i++)
            if (drawn->line.keep[i] || self->curve[j].low) {
                write_point(script, self, &self->curve[j], i);
                lines++;
            }
        fputc('\n', script);
        lines++;
        first = last;
    }
    plot_end_data(script, block, lines);
}

// The name of a faint curve where it leaves the chart on the right or below.
static void write_faint_label(FILE *script, const drawn_curve *drawn, const chart *self, int j,
                              const double x[2], const double y[2])
{
    const char *label = self->curve[j].label;
    for (size_t i = *label ? drawn->count : 0; i-- > 0;)
        if (drawable(drawn, i) && drawn->line.x[i] >= x[0] && drawn->line.x[i] <= x[1] &&
            drawn->line.y[i] >= y[0] && drawn->line.y[i] <= y[1]) {
            fputs("set label ", script);
            plot_write_quoted(script, label);
            fprintf(script, " at %.6g,%.6g right offset 0,0.9 font ',9' tc rgb '#909090'\n",
                    self->log_x ? pow(10, drawn->line.x[i]) : drawn->line.x[i],
                    self->log_y ? pow(10, drawn->line.y[i]) : drawn->line.y[i]);
            return;
        }
}

enum { LETTERS = 10 }; // size of those at ticks

static double widest(const chart_words *words)
{
    double width = 0;
    for (int i = 0; i < words->count; i++)
        width = fmax(width, label_width(words->text[i], LETTERS));
    return width;
}

// Words that do not stand beside each other go down.
static bool are_turned(const chart_words *words)
{
    return words->count * widest(words) > 850;
}

static void write_ticks(FILE *script, char axis, const chart_words *words, bool turned)
{
    if (words->count == 0) {
        fprintf(script, "set %ctics norotate autofreq\n", axis);
        return;
    }
    fprintf(script, "set %ctics %s (", axis, turned ? "rotate by -20" : "norotate");
    for (int i = 0; i < words->count; i++) {
        fputs(i ? ", " : "", script);
        plot_write_quoted(script, words->text[i]);
        fprintf(script, " %d", i);
    }
    fputs(")\n", script);
}

// Many bars require more.
static double axes_height(const chart *self)
{
    const double bars = has_bars(self) ? 21. * self->y_words.count : 0;
    return fmax(HEIGHT - TOP - BOTTOM, bars);
}

static void write_axes(FILE *script, const chart *self, const double x[2], const double y[2])
{
    fprintf(script, "set xrange [%.8g:%.8g]\nset yrange [%.8g:%.8g]\nunset logscale\n",
            self->log_x ? pow(10, x[0]) : x[0], self->log_x ? pow(10, x[1]) : x[1],
            self->log_y ? pow(10, y[0]) : y[0], self->log_y ? pow(10, y[1]) : y[1]);
    fputs(self->log_x ? "set logscale x\n" : "", script);
    fputs(self->log_y ? "set logscale y\n" : "", script);
    if (self->y_step > 0)
        fprintf(script, "set ytics %g\n", self->y_step);
    else
        write_ticks(script, 'y', &self->y_words, false);
    write_ticks(script, 'x', &self->x_words, are_turned(&self->x_words));
    fputs("unset arrow\n", script);
    if (self->levelled)
        fprintf(script,
                "set arrow from graph 0, first %.9g to graph 1, first %.9g nohead lw 1 lc rgb "
                "'#909090'\n",
                self->level, self->level);
    fputs("set label ", script);
    plot_write_quoted(script, self->title);
    const double taller = axes_height(self) / (HEIGHT - TOP - BOTTOM); // distances stay
    fprintf(script, " at graph 0,%.6g left font ',12'\n", 1 + 0.17 / taller);
    if (has_bars(self))
        fprintf(script, "set key at graph 1,%.6g\n", 1 + 0.08 / taller);
    fputs("set xlabel ", script);
    plot_write_quoted(script, self->x_label);
    fputs(" font ',10'\nset ylabel ", script);
    plot_write_quoted(script, self->y_label);
    fputs(" font ',10'\n", script);
}

static void write_title(FILE *script, const chart_curve *curve)
{
    if (*curve->label) {
        fputs("title ", script);
        plot_write_quoted(script, curve->label);
    } else {
        fputs("notitle", script);
    }
}

// Bars with a whisker each.
static void write_bars(FILE *script, const chart_curve *curve, size_t index, int j, int style,
                       const char *before)
{
    fprintf(
        script,
        "%s $c%zud%d using 1:2:(0):1:($2-%g):($2+%g) with boxxyerror ls %d fs solid 1 noborder ",
        before, index, j, 0.5 * curve->bar, 0.5 * curve->bar, style);
    write_title(script, curve);
    fprintf(script,
            ", \\\n    $c%zud%d using 1:2:3:4 with xerrorbars pt 7 ps 0.1 lw 1 lc rgb '#404040' "
            "notitle",
            index, j);
}

// A line; of dots with their intervals one below them, where the axis has numbers.
static void write_plot(FILE *script, const chart *self, size_t index)
{
    int style = 1;
    const char *before = "plot";
    for (int j = 0; j < self->count; j++) {
        const chart_curve *curve = &self->curve[j];
        style -= curve->again;
        if (curve->bar > 0) {
            write_bars(script, curve, index, j, style, before);
            before = ", \\\n    ";
            style++;
            continue;
        }
        if (!curve->dots || self->x_words.count == 0) {
            fprintf(script, "%s $c%zud%d using 1:2 with lines ", before, index, j);
            before = ", \\\n    ";
            if (curve->faint)
                fputs("lw 0.8 lc rgb '#b0b0b0' notitle", script);
            else
                fprintf(script, "ls %d %s", style, curve->dots ? "notitle" : "");
        }
        if (curve->dots)
            fprintf(script, "%s $c%zud%d using 1:2:3:4 with yerrorbars ls %d pt 7 ps 0.7 ", before,
                    index, j, style);
        before = ", \\\n    ";
        if (!curve->faint)
            write_title(script, curve);
        style += !curve->faint;
    }
    fputc('\n', script);
}

static void write_chart(FILE *script, const chart *self, size_t index, drawn_curve *drawn)
{
    double x[2], y[2];
    set_ranges(drawn, self, x, y);
    if (self->map)
        chart_map_ranges(self->map, x, y);
    fputs("unset label\n", script);
    drawn->line.x_span = x[1] - x[0];
    drawn->line.y_span = y[1] - y[0];
    for (int j = 0; j < self->count; j++) {
        set_values(drawn, self, &self->curve[j]);
        write_data(script, index, j, drawn, self);
        if (self->curve[j].faint)
            write_faint_label(script, drawn, self, j, x, y);
    }
    write_axes(script, self, x, y);
}

// ---- the page

static double bottom_of(const chart *self)
{
    double down = 0.34 * widest(&self->x_words); // sine of 20 degrees
    return BOTTOM + (are_turned(&self->x_words) ? fmin(down, 150) : 0);
}

static double left_of(const chart *self)
{
    return fmax(LEFT, fmin(widest(&self->y_words), has_bars(self) ? 300 : 200) + 34);
}

static double height_of(const chart *self)
{
    return TOP + axes_height(self) + bottom_of(self);
}

// The axes' place: of the chart whose upper edge is `above` pixels down.
static void write_place(FILE *script, const chart *self, double above, double width, double height)
{
    fprintf(script, "set lmargin at screen %.6f\nset rmargin at screen %.6f\n",
            left_of(self) / width, 1 - (self->map ? COLOURS : RIGHT) / width);
    fprintf(script, "set tmargin at screen %.6f\nset bmargin at screen %.6f\n",
            1 - (above + TOP) / height, 1 - (above + height_of(self) - bottom_of(self)) / height);
}

static void write_heading(FILE *script, const char *heading, double height)
{
    fputs("set label ", script);
    plot_write_quoted(script, heading);
    fprintf(script, " at screen 0.016, screen %.6f left font ',17'\n", 1 - 0.5 * HEADING / height);
}

static void write_page(FILE *script, const chart_page *page, drawn_curve *drawn, double width,
                       double height)
{
    double above = HEADING;
    fputs("set clip two\nset key at graph 1,1.08\n", script); // below the title
    for (size_t i = 0; i < page->count; i++) {
        const chart *self = &page->charts[i];
        write_chart(script, self, i, drawn);
        write_place(script, self, above, width, height);
        if (i == 0)
            write_heading(script, page->heading, height);
        if (self->map)
            chart_map_write(script, self->map, i, width - left_of(self) - COLOURS,
                            HEIGHT - TOP - BOTTOM);
        else
            write_plot(script, self, i);
        above += height_of(self);
    }
    fputs("unset multiplot\nunset output\n", script);
}

static ld_status write_charts(FILE *script, const void *what, plot_format format, ld_error *error)
{
    const chart_page *page = what;
    drawn_curve drawn = {0};
    ld_status status = allocate(&drawn, page, error);
    if (!status) {
        const plot_style *style = plot_style_find(NULL, error);
        double width = plot_width(style, 0), height = HEADING;
        for (size_t i = 0; i < page->count; i++)
            height += height_of(&page->charts[i]);
        locale_t before = numeric_locale_enter();
        plot_begin(script, format, style, width, height);
        write_page(script, page, &drawn, width, height);
        numeric_locale_leave(before);
    }
    free(drawn.line.x);
    free(drawn.line.keep);
    free(drawn.line.stack);
    return status;
}

ld_status charts_draw(const char *file, const char *heading, const chart *charts, size_t count,
                      ld_error *error)
{
    chart_page page = {heading, charts, count};
    plot_format format = PLOT_SVG;
    ld_status status = plot_format_of(file, &format, error);
    return status ? status : plot_draw(write_charts, &page, format, file, error);
}
