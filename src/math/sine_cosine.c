#include "math/sine_cosine.h"

#include <string.h>

void sine_cosine(int n, const double *angle, double *sine, double *cosine)
{
    for (int i = 0; i < n; i += 4) {
        LANE_ARRAY(given, 4) = {0};
        LANE_ARRAY(s, 4);
        LANE_ARRAY(c, 4);
        size_t size = (i + 2 < n ? 4 : 2) * sizeof *given;
        memcpy(given, angle + i, size);
        sine_cosine_four(given, s, c);
        memcpy(sine + i, s, size);
        memcpy(cosine + i, c, size);
    }
}
