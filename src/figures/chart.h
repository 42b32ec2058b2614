// Charts of plain series, one below the other on one page.
#ifndef LD_FIGURES_CHART_H
#define LD_FIGURES_CHART_H

#include <stdbool.h>
#include <stddef.h>

#include "launchdyn/status.h"

enum { CHART_CURVES = 16 };

typedef struct chart_curve {
    const char *label; // "" : not in the key
    size_t count;
    const double *x, *y; // [count]; a gap where one is not finite
    bool faint;          // grey and thin, its label beside its end
} chart_curve;

typedef struct chart {
    const char *title, *x_label, *y_label;
    double x_factor, y_factor; // to the units that the labels name
    bool log_x, log_y;         // values > 0 only
    double decades;            // a logarithmic y axis shows of those below its top; 0: all
    double y_step;             // between ticks of a linear y axis, in the unit; 0: as it comes
    int count;
    chart_curve curve[CHART_CURVES];
} chart;

// Draws the charts under a heading; the ending of the file says the format (as ld_plot()).
ld_status charts_draw(const char *file, const char *heading, const chart *charts, size_t count,
                      ld_error *error);

#endif
