#include "environment/road.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "math/curves/spline.h"
#include "math/functions.h"
#include "math/lanes.h"
#include "math/sine_cosine.h"

static const double TWO_PI = 6.283185307179586476925286766559;

enum { BLOCK = 64, ORDERS = 4, COEFFICIENTS = 8, MOST_CELLS = 1 << 18 };

struct road {
    const ld_road *model;
    int harmonics;   // of the random part, a zero added to an odd number
    double *k;       // [harmonics] 2 pi n_i, rad/m
    double *c[2][2]; // [harmonics] real and imaginary part of the amplitude c_i of each track:
                     // h = Re sum c_i e^(i k_i x)
    double from, spacing, rate; // rate: 1/spacing
    size_t cells;
    double *cell[2];        // [cells][COEFFICIENTS] of each track over (x - from)/spacing - index
    double *memory;         // of k and c
    bool wide_instructions; // AVX2 is there
    spline profile[2];
};

// Of k and c.
static size_t numbers_of(int harmonics)
{
    return 5 * (size_t)harmonics;
}

double road_class_density(int iso_class, double n)
{
    return 16e-6 * pow(4, iso_class) * (0.1 / n) * (0.1 / n);
}

// ---- the random part: harmonics ----

// Linear between the points of n, g, constant outside.
static double coherent_share(const ld_table *table, double n)
{
    const double *row = table->data;
    size_t last = table->rows - 1, i = 0;
    if (n <= row[0])
        return row[1];
    if (n >= row[2 * last])
        return row[2 * last + 1];
    while (n > row[2 * i + 2])
        i++;
    row += 2 * i;
    return row[1] + (row[3] - row[1]) * (n - row[0]) / (row[2] - row[0]);
}

static double share_at(const ld_road *model, double n)
{
    switch (model->tracks) {
    case LD_TRACKS_INDEPENDENT:
        return 0;
    case LD_TRACKS_COHERENT:
        return coherent_share(&model->coherence, n);
    case LD_TRACKS_SAME:
        break;
    }
    return 1;
}

// A sine of the random part: n [1/m], its amplitude [m], and how much of the right track's is the
// left one's.
typedef struct harmonic {
    double n, a, share;
} harmonic;

// Bands between the inverse wavelengths, equal in log n; a_i^2/2 is the integral of G_d over its
// band, G_d(0.1/m) 0.1^2 (1/n_lo - 1/n_hi).
static harmonic harmonic_of(const ld_road *model, int i)
{
    double longest = model->wavelengths[1];
    double band = log(longest / model->wavelengths[0]) / model->harmonics;
    double density = road_class_density(model->iso_class, 1);
    double n = exp((i + 0.5) * band) / longest;
    return (harmonic){.n = n,
                      .a = sqrt(2 * density * -expm1(-band) * longest * exp(-i * band)),
                      .share = share_at(model, n)};
}

static void set_harmonics(road *self)
{
    const ld_road *model = self->model;
    uint64_t seed = (uint64_t)model->seed, stream = random_stream("road");
    for (int i = 0; i < model->harmonics; i++) {
        harmonic it = harmonic_of(model, i);
        double a = it.a, share = it.share;
        double phase = TWO_PI * random_uniform(seed, stream, 0, (uint64_t)i, 0);
        double other = TWO_PI * random_uniform(seed, stream, 1, (uint64_t)i, 0);
        double rest = sqrt(1 - share * share);
        self->k[i] = TWO_PI * it.n;
        self->c[ROAD_LEFT][0][i] = a * cos(phase);
        self->c[ROAD_LEFT][1][i] = a * sin(phase);
        self->c[ROAD_RIGHT][0][i] = a * (share * cos(phase) + rest * cos(other));
        self->c[ROAD_RIGHT][1][i] = a * (share * sin(phase) + rest * sin(other));
    }
}

static double sum_harmonics(const road *self, road_track track, double x, double *slope)
{
    double height = 0, sum = 0;
    for (int first = 0; first < self->harmonics; first += BLOCK) {
        double angle[BLOCK], sine[BLOCK], cosine[BLOCK];
        const double *k = self->k + first;
        const double *re = self->c[track][0] + first, *im = self->c[track][1] + first;
        int n = self->harmonics - first < BLOCK ? self->harmonics - first : BLOCK;
        for (int i = 0; i < n; i++)
            angle[i] = k[i] * x;
        sine_cosine(n, angle, sine, cosine);
        for (int i = 0; i < n; i++) {
            height += re[i] * cosine[i] - im[i] * sine[i];
            sum -= k[i] * (re[i] * sine[i] + im[i] * cosine[i]);
        }
    }
    *slope = sum;
    return height;
}

// ---- the random part on a grid: e^(i k (x + j step)) = e^(i k x) e^(i k j step) ----

// [harmonics][2][BLOCK] cosine and sine of k j step; NULL without memory.
static double *turns_of(const road *self, double step)
{
    double *turns = malloc(((size_t)self->harmonics * 2 * BLOCK + 1) * sizeof *turns);
    for (int i = 0; turns && i < self->harmonics; i++) {
        double angle[BLOCK], *cosine = turns + (size_t)i * 2 * BLOCK;
        for (int j = 0; j < BLOCK; j++)
            angle[j] = self->k[i] * (j * step);
        sine_cosine(BLOCK, angle, cosine + BLOCK, cosine);
    }
    return turns;
}

// Sines and cosines of k x, of as many harmonics from `first` on as are reported: all of a block,
// which costs a tenth each, but far away, where the lanes give up, each on its own.
static int turns_at(const road *self, double x, int first, double *sine, double *cosine)
{
    static const double NEAR = 5e5 / 4;
    const double *k = self->k + first;
    int left = self->harmonics - first, n = left < BLOCK ? left : BLOCK;
    double angle[BLOCK];
    bool far = false;
    for (int i = 0; i < n; i++) {
        angle[i] = k[i] * x;
        far |= !(fabs(angle[i]) < NEAR);
    }
    if (far) {
        n = 1;
        angle[1] = 0;
    }
    sine_cosine(n, angle, sine, cosine);
    return n;
}

// Adds height and its first three derivatives (orders = 4), or height alone (1), of a harmonic
// whose amplitude at x is re + i im, with the cosines and sines of its turns [2][BLOCK].
LD_ALWAYS_INLINE void add_harmonic(double k, double re, double im, const double *turns, int orders,
                                   double sum[ORDERS][BLOCK])
{
    const double *cosine = turns, *sine = turns + BLOCK;
    if (orders == 1) {
        for (int j = 0; j < BLOCK; j++)
            sum[0][j] += re * cosine[j] - im * sine[j];
        return;
    }
    for (int j = 0; j < BLOCK; j++) {
        double height = re * cosine[j] - im * sine[j];
        double slope = -k * (re * sine[j] + im * cosine[j]);
        sum[0][j] += height;
        sum[1][j] += slope;
        sum[2][j] -= k * k * height;
        sum[3][j] -= k * k * slope;
    }
}

LD_ALWAYS_INLINE void add_harmonics(const road *self, road_track track, const double *turns,
                                    double x, int orders, double sum[ORDERS][BLOCK])
{
    const double *a = self->c[track][0], *b = self->c[track][1];
    double s[BLOCK], c[BLOCK];
    for (int first = 0, n; first < self->harmonics; first += n) {
        n = turns_at(self, x, first, s, c);
        for (int i = 0; i < n; i++) {
            int at = first + i;
            add_harmonic(self->k[at], a[at] * c[i] - b[at] * s[i], a[at] * s[i] + b[at] * c[i],
                         turns + (size_t)at * 2 * BLOCK, orders, sum);
        }
    }
}

// The same code with the processor's wider instructions: the same bits.
LANES_AVX2 static void add_harmonics_wide(const road *self, road_track track, const double *turns,
                                          double x, int orders, double sum[ORDERS][BLOCK])
{
    add_harmonics(self, track, turns, x, orders, sum);
}

// Height and its first three derivatives (orders = 4), or height alone (1), at x + j step.
static void sum_block(const road *self, road_track track, const double *turns, double x, int orders,
                      double sum[ORDERS][BLOCK])
{
    memset(sum, 0, (size_t)orders * sizeof *sum);
    if (self->wide_instructions) {
        add_harmonics_wide(self, track, turns, x, orders, sum);
        return;
    }
    add_harmonics(self, track, turns, x, orders, sum);
}

// ---- the random part tabulated ----

// The polynomial of degree 7 in t = 0 .. 1 with height and three derivatives f at t = 0, g at 1.
static void set_cell(double spacing, const double f[ORDERS], const double g[ORDERS],
                     double p[COEFFICIENTS])
{
    double h1 = spacing, h2 = h1 * h1, h3 = h2 * h1;
    p[0] = f[0];
    p[1] = f[1] * h1;
    p[2] = f[2] * h2 / 2;
    p[3] = f[3] * h3 / 6;
    double d0 = g[0] - (p[0] + p[1] + p[2] + p[3]);
    double d1 = g[1] * h1 - (p[1] + 2 * p[2] + 3 * p[3]);
    double d2 = g[2] * h2 - (2 * p[2] + 6 * p[3]);
    double d3 = g[3] * h3 - 6 * p[3];
    p[4] = 35 * d0 - 15 * d1 + 2.5 * d2 - d3 / 6;
    p[5] = -84 * d0 + 39 * d1 - 7 * d2 + d3 / 2;
    p[6] = 70 * d0 - 34 * d1 + 6.5 * d2 - d3 / 2;
    p[7] = -20 * d0 + 10 * d1 - 2 * d2 + d3 / 6;
}

// The spacing at which the error h^8 f^(8)/(8! 2^8) of these polynomials, root mean square, is the
// rounding of the road's own.
static double table_spacing(const road *self)
{
    double height = 0, derivative = 0;
    for (int i = 0; i < self->harmonics; i++) {
        double a = hypot(self->c[0][0][i], self->c[0][1][i]);
        height = hypot(height, a);
        derivative = hypot(derivative, a * pow(self->k[i], 8));
    }
    return pow(0x1p-52 * 40320 * 256 * height / derivative, 0.125);
}

static bool tabulate(road *self, road_track track)
{
    double *turns = turns_of(self, self->spacing);
    if (!turns)
        return false;
    for (size_t first = 0; first < self->cells; first += BLOCK - 1) {
        double sum[ORDERS][BLOCK], node[BLOCK][ORDERS];
        sum_block(self, track, turns, self->from + (double)first * self->spacing, ORDERS, sum);
        for (int j = 0; j < BLOCK; j++)
            for (int order = 0; order < ORDERS; order++)
                node[j][order] = sum[order][j];
        for (size_t j = 0; j < BLOCK - 1 && first + j < self->cells; j++)
            set_cell(self->spacing, node[j], node[j + 1],
                     self->cell[track] + COEFFICIENTS * (first + j));
    }
    free(turns);
    return true;
}

static inline double table_value(const double *p, double t, double *slope)
{
    double t2 = t * t, t4 = t2 * t2;
    *slope = ((p[1] + 2 * p[2] * t) + (3 * p[3] + 4 * p[4] * t) * t2) +
             ((5 * p[5] + 6 * p[6] * t) + 7 * p[7] * t2) * t4;
    return ((p[0] + p[1] * t) + (p[2] + p[3] * t) * t2) +
           ((p[4] + p[5] * t) + (p[6] + p[7] * t) * t2) * t4;
}

static inline double random_height(const road *self, road_track track, double x, double *slope)
{
    double place = (x - self->from) * self->rate;
    if (!(place >= 0 && place < (double)self->cells))
        return sum_harmonics(self, track, x, slope);
    size_t index = (size_t)place;
    double height =
        table_value(self->cell[track] + COEFFICIENTS * index, place - (double)index, slope);
    *slope *= self->rate;
    return height;
}

// ---- sines, bumps and the table from a file ----

static double sines_height(const ld_road *model, double x, double *slope)
{
    double height = 0;
    for (int i = 0; i < model->sine_count; i++) {
        const ld_road_sine *sine = &model->sine[i];
        double k = TWO_PI / sine->wavelength, s, c;
        sincos(k * x + sine->phase, &s, &c);
        height += sine->amplitude * s;
        *slope += sine->amplitude * k * c;
    }
    return height;
}

static double bumps_height(const ld_road *model, road_track track, double x, double *slope)
{
    double height = 0;
    for (int i = 0; i < model->bump_count; i++) {
        const ld_bump *bump = &model->bump[i];
        double along = x - bump->at, k = TWO_PI / bump->length;
        if (bump->tracks == (track == ROAD_LEFT ? LD_TRACK_RIGHT : LD_TRACK_LEFT) ||
            !(along > 0 && along < bump->length))
            continue;
        double s, c;
        sincos(k * along, &s, &c);
        height += bump->height / 2 * (1 - c);
        *slope += bump->height / 2 * k * s;
    }
    return height;
}

static double profile_height(const spline *profile, double x, double *slope)
{
    size_t last = profile->count - 1;
    double inside = fmin(fmax(x, profile->x[0]), profile->x[last]), steepness;
    double height = spline_value(profile, inside, &steepness);
    if (x == inside)
        *slope += steepness;
    return height;
}

static double fixed_height(const road *self, road_track track, double x, double *slope)
{
    double height = sines_height(self->model, x, slope);
    height += bumps_height(self->model, track, x, slope);
    if (self->profile[track].count)
        height += profile_height(&self->profile[track], x, slope);
    return height;
}

// ---- the whole ----

double road_height(const road *self, road_track track, double x, double *slope)
{
    double steepness = 0, height = 0;
    if (self->harmonics)
        height = random_height(self, track, x, &steepness);
    height += fixed_height(self, track, x, &steepness);
    if (slope)
        *slope = steepness;
    return height;
}

double road_right_share(const ld_road *model, double z)
{
    const double *at = model->places;
    if (!(at[0] < at[1]))
        return z < 0 ? 0 : 1;
    return fmin(fmax((z - at[0]) / (at[1] - at[0]), 0), 1);
}

ld_status road_profile(const road *self, road_track track, const road_places *places,
                       double *height, ld_error *error)
{
    size_t count = places->count;
    double step = places->step, *turns = turns_of(self, step);
    if (!turns)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a profile of the road");
    for (size_t first = 0; first < count; first += BLOCK) {
        double sum[ORDERS][BLOCK], slope = 0, start = places->from + (double)first * step;
        sum_block(self, track, turns, start, 1, sum);
        for (size_t j = 0; j < BLOCK && first + j < count; j++)
            height[first + j] =
                sum[0][j] + fixed_height(self, track, start + (double)j * step, &slope);
    }
    free(turns);
    return LD_OK;
}

// ---- as a spectrum ----

// Mean square of the given sines of one wavelength together, which are the same on both tracks.
static double square_of_sines(const ld_road *model, double wavelength)
{
    double re = 0, im = 0;
    for (int i = 0; i < model->sine_count; i++) {
        const ld_road_sine *sine = &model->sine[i];
        if (sine->wavelength == wavelength) {
            re += sine->amplitude * cos(sine->phase);
            im += sine->amplitude * sin(sine->phase);
        }
    }
    return (re * re + im * im) / 2;
}

static bool is_first_of_its_wavelength(const ld_road *model, int i)
{
    for (int k = 0; k < i; k++)
        if (model->sine[k].wavelength == model->sine[i].wavelength)
            return false;
    return true;
}

ld_status road_lines(const ld_road *model, road_line **lines, size_t *count, ld_error *error)
{
    bool flat = model->form == LD_ROAD_FLAT;
    int harmonics = flat || model->iso_class == LD_ROAD_SMOOTH ? 0 : model->harmonics;
    int sines = flat ? 0 : model->sine_count;
    *count = 0;
    *lines = malloc(((size_t)harmonics + (size_t)sines + 1) * sizeof **lines);
    if (!*lines)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the spectrum of a road");
    for (int i = 0; i < harmonics; i++) {
        harmonic it = harmonic_of(model, i);
        (*lines)[(*count)++] = (road_line){it.n, it.a * it.a / 2, it.share};
    }
    for (int i = 0; i < sines; i++)
        if (is_first_of_its_wavelength(model, i)) {
            double wavelength = model->sine[i].wavelength;
            (*lines)[(*count)++] =
                (road_line){1 / wavelength, square_of_sines(model, wavelength), 1};
        }
    return LD_OK;
}

double road_density(const ld_road *model, double n, double *shared)
{
    *shared = share_at(model, n);
    bool random = model->form != LD_ROAD_FLAT && model->iso_class != LD_ROAD_SMOOTH;
    bool within = n * model->wavelengths[1] >= 1 && n * model->wavelengths[0] <= 1;
    return random && within ? road_class_density(model->iso_class, n) : 0;
}

// Takes over the table of a road that has the same harmonics, of which spacing and equal tracks
// follow, and as many places: to the bit its own.
static bool take_table(road *self, road *former)
{
    if (!former || former->harmonics != self->harmonics || former->cells != self->cells ||
        former->from != self->from ||
        memcmp(former->memory, self->memory, numbers_of(self->harmonics) * sizeof(double)) != 0)
        return false;
    memcpy(self->cell, former->cell, sizeof self->cell);
    memset(former->cell, 0, sizeof former->cell);
    return true;
}

static ld_status build_random(road *self, double x0, double x1, road *former, ld_error *error)
{
    size_t n = (size_t)self->model->harmonics, room = n + (n & 1);
    self->memory = calloc(numbers_of((int)room), sizeof(double));
    if (!self->memory)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a road of %zu harmonics", n);
    self->harmonics = (int)room;
    self->k = self->memory;
    for (int i = 0; i < 4; i++)
        self->c[i / 2][i % 2] = self->memory + (size_t)(i + 1) * room;
    set_harmonics(self);

    // the table, as far as it may go; equal tracks share it
    self->from = x0;
    self->spacing = table_spacing(self);
    self->rate = 1 / self->spacing;
    double cells = fmax(ceil((x1 - x0) / self->spacing), 0) + 1;
    self->cells = (size_t)fmin(cells, MOST_CELLS);
    if (take_table(self, former))
        return LD_OK;
    int tables = self->model->tracks == LD_TRACKS_SAME ? 1 : 2;
    for (int track = 0; track < tables; track++) {
        self->cell[track] = malloc(self->cells * COEFFICIENTS * sizeof(double));
        if (!self->cell[track] || !tabulate(self, (road_track)track))
            return ld_fail(error, LD_ERR_MEMORY, "no memory for a table of the road");
    }
    if (tables == 1)
        self->cell[ROAD_RIGHT] = self->cell[ROAD_LEFT];
    return LD_OK;
}

static ld_status build_profile(road *self, ld_error *error)
{
    const ld_table *table = &self->model->profile;
    size_t rows = table->rows, columns = table->columns;
    double *x = malloc(2 * rows * sizeof *x), *h = x + rows;
    if (!x)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a road of %zu points", rows);
    ld_status status = LD_OK;
    for (int track = 0; track < ROAD_TRACKS && !status; track++) {
        size_t column = track == ROAD_RIGHT ? columns - 1 : 1;
        for (size_t i = 0; i < rows; i++) {
            x[i] = table->data[i * columns];
            h[i] = table->data[i * columns + column];
        }
        status = spline_build(&self->profile[track], rows, x, h, error);
    }
    free(x);
    return status;
}

ld_status road_build(const ld_road *model, double x0, double x1, road **out, ld_error *error)
{
    *out = NULL;
    return road_renew(out, model, x0, x1, error);
}

static ld_status build(road *self, double x0, double x1, road *former, ld_error *error)
{
    ld_status status = LD_OK;
    if (self->model->iso_class != LD_ROAD_SMOOTH)
        status = build_random(self, x0, x1, former, error);
    if (!status && self->model->profile.rows)
        status = build_profile(self, error);
    return status;
}

ld_status road_renew(road **renewed, const ld_road *model, double x0, double x1, ld_error *error)
{
    road *former = *renewed, *self = calloc(1, sizeof *self);
    *renewed = self;
    if (!self) {
        road_free(former);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a road");
    }
    static const ld_road flat = {.iso_class = LD_ROAD_SMOOTH};
    self->model = model->form == LD_ROAD_FLAT ? &flat : model;
    self->wide_instructions = lanes_have_avx2();
    ld_status status = build(self, x0, x1, former, error);
    road_free(former);
    if (status) {
        road_free(self);
        *renewed = NULL;
    }
    return status;
}

void road_free(road *self)
{
    if (!self)
        return;
    if (self->cell[ROAD_RIGHT] != self->cell[ROAD_LEFT])
        free(self->cell[ROAD_RIGHT]);
    free(self->cell[ROAD_LEFT]);
    free(self->memory);
    spline_free(&self->profile[ROAD_LEFT]);
    spline_free(&self->profile[ROAD_RIGHT]);
    free(self);
}
