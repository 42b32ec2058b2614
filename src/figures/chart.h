// Charts of plain series, one below the other on one page.
#ifndef LD_FIGURES_CHART_H
#define LD_FIGURES_CHART_H

#include <stdbool.h>
#include <stddef.h>

#include "figures/chart_map.h"
#include "launchdyn/status.h"

enum { CHART_CURVES = 16 };

typedef struct chart_curve {
    const char *label; // "" : not in the key
    size_t count;
    const double *x, *y;      // [count]; a gap where one is not finite
    bool faint;               // grey and thin, its label beside its end
    bool dots;                // a dot at each point, with its interval where that is finite
    const double *low, *high; // [count] of dots; of bars along x
    double bar;               // height of bars from 0 to x, of the place that a word has; 0: none
    bool again;               // looks as the one before it, and is not in the key
} chart_curve;

// Words along an axis at 0, 1, 2, ...; or numbers.
typedef struct chart_words {
    int count;
    const char *const *text; // [count]
} chart_words;

typedef struct chart {
    const char *title, *x_label, *y_label;
    double x_factor, y_factor;    // to the units that the labels name
    bool log_x, log_y;            // values > 0 only
    double decades;               // a logarithmic y axis shows of those below its top; 0: all
    double y_step;                // between ticks of a linear y axis, in the unit; 0: as it comes
    chart_words x_words, y_words; // count 0: the axis has numbers
    bool levelled;                // a thin line at this value of y, which the axis shows
    double level;
    const chart_map *map; // NULL: curves
    int count;
    chart_curve curve[CHART_CURVES];
} chart;

// Draws the charts under a heading; the ending of the file says the format (as ld_plot()).
ld_status charts_draw(const char *file, const char *heading, const chart *charts, size_t count,
                      ld_error *error);

#endif
