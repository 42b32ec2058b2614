// Figures of a launch: what they show, as data, and the drawing of them.
#ifndef LD_IO_PLOT_H
#define LD_IO_PLOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "io/history.h"
#include "launchdyn/output.h"
#include "launchdyn/status.h"

enum { PLOT_PANELS = 4, PLOT_CURVES = 8 };

// A column of the history and its name in the legend. A '*' in the column stands for any text: a
// curve for each that matches, named by that text.
typedef struct plot_curve {
    const char *column, *label;
} plot_curve;

// One diagram. Values times the factor have the unit that the label names.
typedef struct plot_panel {
    const char *title;
    const char *y_label;
    double y_factor;
    plot_curve curve[PLOT_CURVES]; // up to the first without a column
    const char *x_column;          // NULL: time from ignition
    const char *x_label;
    double x_factor;
    bool wide; // takes a row of its own
} plot_panel;

// A standard figure: panels in rows of two under a heading.
typedef struct plot_figure {
    ld_figure about;
    plot_panel panel[PLOT_PANELS]; // up to the first without a title
} plot_figure;

// The figure with this name, or NULL.
const plot_figure *plot_figure_find(const char *name);

typedef enum plot_format { PLOT_SVG, PLOT_PDF, PLOT_PNG } plot_format;

// Writes the commands with which gnuplot draws the figures into `output`.
ld_status plot_write_script(FILE *script, const history_data *history,
                            const plot_figure *const *figures, size_t count, plot_format format,
                            const char *output, ld_error *error);

#endif
