// Where names stand so that none goes through another: the rule of assets/report/labels.js, which
// the reports follow in the browser. Lengths in pixels, y downwards; at most LABELS_MOST names.
#ifndef LD_FIGURES_LABELS_H
#define LD_FIGURES_LABELS_H

#include <stdbool.h>
#include <stddef.h>

enum { LABELS_MOST = 320 };

// A name above a line. The lower its rank, the sooner it has room.
typedef struct label_on_line {
    double at, width; // its middle, where the others let it
    int rank;
    double left; // found: its left end, NaN where there is no room
} label_on_line;

typedef struct label_box {
    double left, right, top, bottom;
} label_box;

// A name beside a point.
typedef struct label_beside {
    double x, y, width;
    bool placed;   // found: there is room
    label_box box; // found
} label_beside;

// Each name as near to its middle as the others let it, between `low` and `high`.
void labels_place_on_line(label_on_line *name, size_t count, double low, double high, double gap);

// Names `height` high within `bounds`, clear of each other and of all points, and of as many of
// the places `others` [count][2] as can be; those first in the list choose first.
void labels_place_beside(label_beside *name, size_t count, double height, const label_box *bounds,
                         const double (*others)[2], size_t other_count);

// Width of a text of letters of `size`, rather more than less than what a font makes of it.
double label_width(const char *text, double size);

#endif
