// Cells coloured by their values, with a colour bar, in the place of a chart's curves.
#ifndef LD_FIGURES_CHART_MAP_H
#define LD_FIGURES_CHART_MAP_H

#include <stdbool.h>
#include <stdio.h>

// Cells on a grid in place of curves: coloured by their values, which stand in them.
typedef struct chart_map {
    int columns, rows;
    const double *x_edge, *y_edge; // [columns + 1], [rows + 1] in the units that the labels name
    const double *x_tick, *y_tick; // [columns], [rows]; NULL: words
    const double *value;           // [columns][rows] in the unit of the label; NaN: nothing
    const char *(*text)[2];        // [columns][rows] value and interval, "" without
    const char *label;             // of the colour bar
    bool centred;                  // colours part at `middle`
    double middle;
} chart_map;

// The outermost edges.
void chart_map_ranges(const chart_map *self, double x[2], double y[2]);

// Plots it on axes of these pixels.
void chart_map_write(FILE *script, const chart_map *self, size_t index, double width,
                     double height);

#endif
