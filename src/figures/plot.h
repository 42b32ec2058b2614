// Figures of a launch: what they show, as data, and the drawing of them.
#ifndef LD_FIGURES_PLOT_H
#define LD_FIGURES_PLOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "launchdyn/output.h"
#include "launchdyn/status.h"
#include "results/history.h"

enum { PLOT_PANELS = 8, PLOT_CURVES = 8, PLOT_RUNS = 8 };

// A column of the history and its name in the legend. A '*' in the column stands for any text: a
// curve for each that matches, named by that text.
typedef struct plot_curve {
    const char *column, *label;
} plot_curve;

// A unit as it is written; values times the factor have it.
typedef struct plot_unit {
    const char *name; // "": plain numbers
    double factor;    // from SI
} plot_unit;

// What stands at an axis: what is shown there and its unit.
typedef struct plot_axis {
    const char *name;
    plot_unit unit;
} plot_axis;

// One diagram.
typedef struct plot_panel {
    const char *title;
    plot_axis y;
    plot_curve curve[PLOT_CURVES]; // up to the first without a column
    const char *x_column;          // NULL: time from ignition, without an axis of its own
    plot_axis x;
    bool wide;  // takes a row of its own
    bool since; // values less those at ignition
    bool each;  // a diagram for each text that the '*' stands for, which takes the title's %s
} plot_panel;

// What time a figure shows: the launch, in milliseconds from shortly before ignition; all of the
// launcher's motion, in seconds; the flight of each rocket, in seconds from its ignition.
typedef enum plot_time { PLOT_LAUNCH, PLOT_VEHICLE, PLOT_FLIGHT } plot_time;

// A standard figure: panels in rows of two under a heading.
typedef struct plot_figure {
    ld_figure about;
    plot_panel panel[PLOT_PANELS]; // up to the first without a title
    plot_time time;
    bool open; // the report shows it at once, the others folded
} plot_figure;

// The figures in their order, NULL after the last; that with a name, or NULL.
const plot_figure *plot_figure_at(size_t index);
const plot_figure *plot_figure_find(const char *name);

// An instant that figures mark, and whose name gives way first where there is no room for all: that
// of the greatest rank.
typedef struct plot_mark {
    char name[LD_MAX_NAME];
    double t; // [s] from ignition, of several rockets from that of the first
    int rank;
    int rocket;       // in the firing order, from 0; of a flight 0
    unsigned figures; // bits 1 << plot_time of the figures that mark it
} plot_mark;

enum { PLOT_MARKS = 5 * LD_MAX_FIRINGS };

typedef struct plot_marks {
    plot_mark mark[PLOT_MARKS];
    size_t count;
} plot_marks;

// The instants of a launcher and all its rockets, or of a flight, as they stand in its history and
// come out of its columns; only those that there are, in the order in which they come.
void plot_find_marks(const history_data *history, bool flight, plot_marks *marks);

// The text of an axis, "height [m]"; what is too long is cut.
void plot_axis_text(const plot_axis *axis, char *text, size_t size);

// Writes all figures, and the marks of a history, as lists of JSON, for those who draw them
// elsewhere.
void plot_write_json(FILE *json);
void plot_write_marks(FILE *json, const plot_marks *marks);

typedef enum plot_format { PLOT_SVG, PLOT_PDF, PLOT_PNG } plot_format;

// How a picture looks: colours as rrggbb.
typedef struct plot_style {
    const char *name;
    const char *paper, *ink, *soft, *grid; // background; text and axes; instants; lines behind
    const char *colour[PLOT_RUNS];         // of curves, to be distinguished by the colour-blind
    double millimetres;                    // width where none is asked for; 0: that of a screen
    bool caption;                          // stands above a caption: has no title
    bool dashed;                           // curves are distinguished without colours, too
} plot_style;

// The style of a name, the first for NULL; NULL, with the error, where there is none.
const plot_style *plot_style_find(const char *name, ld_error *error);

// Width of a page in pixels of 1/96 inch for a picture so wide [m], 0: as the style has it.
double plot_width(const plot_style *style, double metres);

// What stands on a page.
typedef struct plot_page {
    const history_data *run; // [runs], laid one over the other
    const char *const *name; // [runs], in the legend of several
    size_t runs;
    const plot_figure *const *figure; // [figures]
    size_t figures;
    double from, to; // [s] from ignition, NaN: what the figure shows on its own
    const plot_style *style;
    double width; // [pixels]
} plot_page;

// Whether `name` is the pattern, whose one '*' stands for any text; that text becomes the label.
bool plot_column_matches(const char *name, const char *pattern, char *label, size_t size);

// Whether a figure shows a column.
bool plot_figure_shows(const plot_figure *figure, const char *column);

// Whether a run has a column that the figure shows.
bool plot_figure_has_columns(const plot_figure *figure, const history_data *run);

// Writes the commands with which gnuplot draws `page` to its standard output.
typedef ld_status plot_writer(FILE *script, const void *page, plot_format format, ld_error *error);

// The writer of a plot_page.
plot_writer plot_write_script;

// The format that the ending of a picture's name says.
ld_status plot_format_of(const char *file, plot_format *format, ld_error *error);

// Draws a page with gnuplot.
ld_status plot_draw(plot_writer *write, const void *page, plot_format format, const char *file,
                    ld_error *error);

// Sets terminal and styles of lines, and begins a page of these pixels: of an svg. A pdf takes one
// for a point, a png makes two of it; of a page with a width of its own they are 1/96 inch, and a
// png has 300 dots an inch.
void plot_begin(FILE *script, plot_format format, const plot_style *style, double width,
                double height);

// Whether a page of these pixels can be a picture of that format: a png has a greatest height.
ld_status plot_fits(plot_format format, const plot_style *style, double width, double height,
                    ld_error *error);

// Ends the data of a block, "$name", and the script where gnuplot has kept another number of lines:
// short of memory it drops some and draws the rest.
void plot_end_data(FILE *script, const char *block, int lines);

// Text between quotes of gnuplot, as a terminal may show it.
void plot_write_quoted(FILE *script, const char *text);

// A curve on a panel of these spans.
typedef struct plot_line {
    double *x, *y; // [count]
    double x_span, y_span;
    char *keep;    // [count] which points are needed
    size_t *stack; // [2 count + 8]
} plot_line;

// Marks in `keep` the points from first to last that the curve needs to be within 1/3000 of the
// panel.
void plot_thin(const plot_line *line, size_t first, size_t last);

#endif
