#include "systems/bases/sea_motion.h"

#include <stdlib.h>
#include <string.h>

#include "environment/sea.h"
#include "math/functions.h"
#include "math/lanes.h"
#include "model/model.h"

enum { SURGE, SWAY, HEAVE, ROLL, PITCH, YAW, MOTIONS, MOST_CELLS = 1 << 14 };

// Where the coordinates of a table stand among x, y, z, yaw, pitch, roll, and which of them change
// sides where the waves come from the other side.
static const int lane_of[MOTIONS] = {0, 2, 1, 5, 4, 3};
static const bool mirrored[MOTIONS] = {[SWAY] = true, [ROLL] = true, [YAW] = true};

static const double PI = 3.14159265358979323846;

// ---- what a table says ----

// The response of each coordinate to a wave of unit amplitude, times the factor, added: linear
// between rows as a complex number, as in the first row below it, nothing above the last.
static void add_response(const ld_table *table, double omega, double factor, double re[MOTIONS],
                         double im[MOTIONS])
{
    size_t last = table->rows - 1, i = 0, columns = table->columns;
    if (omega > table->data[last * columns])
        return;
    while (i + 1 < last && omega >= table->data[(i + 1) * columns])
        i++;
    const double *row = table->data + i * columns, *next = i < last ? row + columns : row;
    double t = i < last ? fmax(0, (omega - row[0]) / (next[0] - row[0])) : 0;
    for (int j = 0; j < MOTIONS; j++) {
        const double *a = row + 1 + 2 * j, *b = next + 1 + 2 * j;
        re[j] += factor * ((1 - t) * a[0] * cos(a[1]) + t * b[0] * cos(b[1]));
        im[j] += factor * ((1 - t) * a[0] * sin(a[1]) + t * b[0] * sin(b[1]));
    }
}

// To a wave that goes to `heading`, by the responses to both sides of it, by the nearest beyond the
// outermost ones.
static void response_to(const ld_sea *sea, const sea_wave *wave, double re[MOTIONS],
                        double im[MOTIONS])
{
    double heading = remainder(wave->heading, 2 * PI), side = fabs(heading);
    const ld_sea_response *response = sea->response;
    int i = 0, last = sea->response_count - 1;
    while (i < last - 1 && side >= response[i + 1].heading)
        i++;
    double t = last > 0
                   ? (side - response[i].heading) / (response[i + 1].heading - response[i].heading)
                   : 0;
    t = fmin(fmax(t, 0), 1);
    memset(re, 0, MOTIONS * sizeof *re);
    memset(im, 0, MOTIONS * sizeof *im);
    add_response(&response[i].table, wave->omega, 1 - t, re, im);
    if (t > 0)
        add_response(&response[i + 1].table, wave->omega, t, re, im);
    for (int j = 0; j < MOTIONS && heading < 0; j++)
        if (mirrored[j])
            re[j] = -re[j], im[j] = -im[j];
}

// Phases lead in time, also where the ship overtakes the wave and meets its crests backwards.
// False: it does not move in this wave.
static bool line_of(const ld_model *model, const sea_wave *wave, sea_line *line)
{
    double re[MOTIONS], im[MOTIONS], largest = 0;
    response_to(&model->base.sea, wave, re, im);
    *line = (sea_line){.omega = sea_encounter(wave, model->base.velocity, model->gravity)};
    double c = wave->amplitude * cos(wave->phase), s = wave->amplitude * sin(wave->phase);
    for (int j = 0; j < MOTIONS; j++) {
        double lead = line->omega < 0 ? -im[j] : im[j];
        line->re[lane_of[j]] = re[j] * c - lead * s;
        line->im[lane_of[j]] = re[j] * s + lead * c;
        largest = fmax(largest, fabs(re[j]) + fabs(im[j]));
    }
    return largest > 0;
}

// ---- the course ----

// Derivatives of order 0 .. count - 1 over t [s] times width^order/order!, summed wave by wave.
static void sum_lines(const sea_motion *self, double t, double width, int count,
                      double sum[][SEA_LANES])
{
    memset(sum, 0, (size_t)count * sizeof *sum);
    for (size_t i = 0; i < self->count; i++) {
        const sea_line *line = &self->line[i];
        double c, s, step = line->omega * width;
        sincos(line->omega * t, &s, &c);
        for (int order = 0; order < count; order++) {
            for (int j = 0; j < SEA_LANES; j++)
                sum[order][j] += line->re[j] * c - line->im[j] * s;
            // times i omega width/(order + 1)
            double turned = -s * step / (order + 1);
            s = c * step / (order + 1);
            c = turned;
        }
    }
}

// A cell is so wide that the series' next term is below rounding at its ends, where the fastest
// wave has turned by half a radian.
static ld_status tabulate(sea_motion *self, double first, double last, ld_error *error)
{
    double fastest = 0;
    for (size_t i = 0; i < self->count; i++)
        fastest = fmax(fastest, fabs(self->line[i].omega));
    self->from = first;
    self->width = 1 / fmax(fastest, 1e-3);
    self->cells = (size_t)fmin(fmax((last - first) / self->width, 0) + 1, MOST_CELLS);
    self->cell = aligned_alloc(64, self->cells * sizeof *self->cell);
    if (!self->cell)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the motion in the sea");
    for (size_t i = 0; i < self->cells; i++)
        sum_lines(self, first + ((double)i + 0.5) * self->width, self->width, SEA_COEFFICIENTS,
                  self->cell[i]);
    return LD_OK;
}

ld_status sea_motion_build(sea_motion *self, const ld_model *model, double first, double last,
                           ld_error *error)
{
    sea_wave *waves;
    size_t count;
    *self = (sea_motion){0};
    if (!model->base.sea.present)
        return LD_OK;
    ld_status status = sea_build(&model->base.sea, &waves, &count, error);
    if (status)
        return status;
    self->line = malloc(count * sizeof *self->line);
    for (size_t i = 0; i < count && self->line; i++)
        self->count += line_of(model, &waves[i], &self->line[self->count]);
    free(waves);
    if (!self->line)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the motion in the sea");
    return tabulate(self, first, last, error);
}

void sea_motion_free(sea_motion *self)
{
    free(self->line);
    free(self->cell);
    *self = (sea_motion){0};
}

// Value, first and second derivative of the series by Horner's scheme.
static void evaluate(double cell[SEA_COEFFICIENTS][SEA_LANES], double tau, double sum[3][SEA_LANES])
{
    for (int part = 0; part < SEA_LANES / 4; part++) {
        v4d value = v4d_all(0), rate = value, half = value;
        for (int i = SEA_COEFFICIENTS - 1; i >= 0; i--) {
            half = half * tau + rate;
            rate = rate * tau + value;
            value = value * tau + *v4d_lanes_of(&cell[i][4 * part]);
        }
        *v4d_lanes(&sum[0][4 * part]) = value;
        *v4d_lanes(&sum[1][4 * part]) = rate;
        *v4d_lanes(&sum[2][4 * part]) = half;
    }
}

void sea_motion_add(const sea_motion *self, double t, double x[6], double u[6], double a[6])
{
    _Alignas(32) double sum[3][SEA_LANES];
    if (!self->count)
        return;
    double width = self->width, place = (t - self->from) / width;
    if (place >= 0 && place < (double)self->cells) {
        size_t i = (size_t)place;
        evaluate(self->cell[i], place - (double)i - 0.5, sum);
    } else {
        sum_lines(self, t, width, 3, sum);
    }
    for (int j = 0; j < 6; j++) {
        x[j] += sum[0][j];
        u[j] += sum[1][j] / width;
        a[j] += sum[2][j] * 2 / (width * width);
    }
}
