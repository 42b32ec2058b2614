// Cells coloured by their values, with a colour bar, in the place of a chart's curves.
#ifndef LD_FIGURES_CHART_MAP_H
#define LD_FIGURES_CHART_MAP_H

#include <stdio.h>

#include "figures/chart.h"

// The outermost edges.
void chart_map_ranges(const chart_map *self, double x[2], double y[2]);

// Plots it on axes of these pixels.
void chart_map_write(FILE *script, const chart_map *self, size_t index, double width,
                     double height);

#endif
