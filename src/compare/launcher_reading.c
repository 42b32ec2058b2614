#include "compare/launcher_reading.h"

#include "math/vectors/mat3.h"

enum { MOST_NAMES = 9 };

ld_status launcher_take(const char *part, const run_series *run, const char *const *names,
                        size_t width, run_signal *signal, ld_error *error)
{
    char text[MOST_NAMES][LD_MAX_QUANTITY];
    const char *name[MOST_NAMES];
    for (size_t k = 0; k < width; k++) {
        snprintf(text[k], sizeof text[k], "%.64s.%.24s", part, names[k]);
        name[k] = text[k];
    }
    return run_series_take(run, name, width, signal, error);
}

// ---- accelerations

// The sensor at a row: velocity of its place and its axis, in I.
typedef struct sensor_motion {
    double t;
    v3 v, e;
} sensor_motion;

static sensor_motion motion_at(const sensor *self, const run_signal *of, size_t row)
{
    const double *angles = of->value + MOST_NAMES * row, *v = angles + 3, *w = angles + 6;
    m3 A = m3_mul(m3_rotation_y(angles[0]),
                  m3_mul(m3_rotation_z(angles[1]), m3_rotation_x(angles[2])));
    v3 lever = v3_cross(v3_from(w), v3_from(self->at));
    return (sensor_motion){of->t[row], v3_add(v3_from(v), m3_apply(A, lever)),
                           m3_apply(A, v3_from(self->axis))};
}

// Rows at one instant (a jump), or so near that their difference is rounding, have no mean between
// them.
static bool are_apart(const run_signal *of, size_t row, double usual)
{
    return of->t[row + 1] - of->t[row] > 1e-3 * usual;
}

// From the motion at rows to the specific force between them.
static void differentiate(const sensor *self, const run_series *run, run_signal *signal)
{
    size_t rows = signal->count;
    double usual = rows > 1 ? (signal->t[rows - 1] - signal->t[0]) / (double)(rows - 1) : 0;
    signal->count = 0;
    sensor_motion before = rows ? motion_at(self, signal, 0) : (sensor_motion){0};
    for (size_t i = 0; i + 1 < rows; i++) {
        sensor_motion after = motion_at(self, signal, i + 1);
        if (are_apart(signal, i, usual)) {
            double dt = after.t - before.t;
            v3 a = v3_scale(1 / dt, v3_sub(after.v, before.v));
            a.y += run->gravity;
            signal->t[signal->count] = 0.5 * (before.t + after.t);
            signal->value[signal->count++] = 0.5 * (v3_dot(before.e, a) + v3_dot(after.e, a));
        }
        before = after;
    }
}

ld_status launcher_accelerate(const sensor *self, const run_series *run, run_signal *signal,
                              ld_error *error)
{
    static const char *const names[MOST_NAMES] = {"yaw", "pitch", "roll", "vx", "vy",
                                                  "vz",  "wx",    "wy",   "wz"};
    ld_status status = launcher_take(self->on, run, names, MOST_NAMES, signal, error);
    if (!status)
        differentiate(self, run, signal);
    return status;
}

// ---- strains

ld_status launcher_strain(const sensor *self, const run_series *run, run_signal *signal,
                          ld_error *error)
{
    static const char *const names[] = {"strain", "curvature_y", "curvature_z"};
    ld_status status = launcher_take(self->on, run, names, 3, signal, error);
    for (size_t i = 0; !status && i < signal->count; i++) {
        const double *row = signal->value + 3 * i;
        signal->value[i] = row[0] - self->at[1] * row[1] - self->at[2] * row[2];
    }
    return status;
}
