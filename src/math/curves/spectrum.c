#include "math/curves/spectrum.h"

#include <stdlib.h>

#include "math/functions.h"

static const double TWO_PI = 6.283185307179586476925286766559;

// In place, re + i im, size a power of 2: sum over n of z_n e^(-2 pi i m n/size) (Cooley and
// Tukey).
static void transform(size_t size, double *re, double *im, const double *cosine, const double *sine)
{
    // bit-reversed order
    for (size_t i = 1, j = 0; i < size; i++) {
        size_t bit = size >> 1;
        for (; j & bit; bit >>= 1)
            j ^= bit;
        j |= bit;
        if (i < j) {
            double r = re[i], s = im[i];
            re[i] = re[j], im[i] = im[j];
            re[j] = r, im[j] = s;
        }
    }
    // butterflies
    for (size_t half = 1; half < size; half *= 2)
        for (size_t first = 0; first < size; first += 2 * half)
            for (size_t k = 0; k < half; k++) {
                size_t i = first + k, j = i + half, turn = k * (size / (2 * half));
                double c = cosine[turn], s = -sine[turn];
                double r = re[j] * c - im[j] * s, q = re[j] * s + im[j] * c;
                re[j] = re[i] - r, im[j] = im[i] - q;
                re[i] += r, im[i] += q;
            }
}

static double mean_of(size_t count, const double *values)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += values[i];
    return sum / (double)count;
}

// The tapered series as real and imaginary part; returns the sum of the squared taper.
static double taper(size_t count, const double *a, const double *b, double *re, double *im)
{
    double mean_a = mean_of(count, a), mean_b = mean_of(count, b), power = 0;
    for (size_t i = 0; i < count; i++) {
        double s = sin(TWO_PI / 2 * ((double)i + 0.5) / (double)count), window = s * s;
        re[i] = window * (a[i] - mean_a);
        im[i] = window * (b[i] - mean_b);
        power += window * window;
    }
    return power;
}

// Means of the products of the two series' transforms in one band, from Z = A + i B.
static void band_means(size_t size, double resolution, const double *re, const double *im,
                       const double *edge, double mean[3])
{
    size_t from = (size_t)fmax(ceil(edge[0] / resolution), 1), m = from;
    mean[0] = mean[1] = mean[2] = 0;
    for (; m < size / 2 && (double)m * resolution < edge[1]; m++) {
        double a_re = (re[m] + re[size - m]) / 2, a_im = (im[m] - im[size - m]) / 2;
        double b_re = (im[m] + im[size - m]) / 2, b_im = (re[size - m] - re[m]) / 2;
        mean[0] += a_re * a_re + a_im * a_im;
        mean[1] += b_re * b_re + b_im * b_im;
        mean[2] += a_re * b_re + a_im * b_im;
    }
    for (int i = 0; i < 3; i++)
        mean[i] = m > from ? mean[i] / (double)(m - from) : NAN;
}

ld_status spectrum_in_bands(const spectrum_series *series, const spectrum_bands *bands,
                            ld_error *error)
{
    size_t size = 2, count = series->count;
    double step = series->step;
    while (size < count)
        size *= 2;
    double *re = calloc(3 * size, sizeof *re), *im = re + size, *cosine = re + 2 * size;
    if (!re)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a spectrum of %zu samples", count);
    double *sine = cosine + size / 2;
    for (size_t i = 0; i < size / 2; i++)
        sincos(TWO_PI * (double)i / (double)size, sine + i, cosine + i);
    double scale = 2 * step / taper(count, series->a, series->b, re, im);
    transform(size, re, im, cosine, sine);
    double *out[3] = {bands->aa, bands->bb, bands->ab};
    for (size_t band = 0; band < bands->count; band++) {
        double mean[3];
        band_means(size, 1 / ((double)size * step), re, im, bands->edge + band, mean);
        for (int i = 0; i < 3; i++)
            if (out[i])
                out[i][band] = scale * mean[i];
    }
    free(re);
    return LD_OK;
}

// Less the straight line of least squares.
static void take_line_off(size_t count, const double *a, double *out)
{
    double mean = mean_of(count, a), middle = 0.5 * (double)(count - 1), slope = 0, square = 0;
    for (size_t i = 0; i < count; i++) {
        double along = (double)i - middle;
        slope += along * (a[i] - mean);
        square += along * along;
    }
    slope /= square;
    for (size_t i = 0; i < count; i++)
        out[i] = a[i] - mean - slope * ((double)i - middle);
}

ld_status spectrum_of_segments(size_t count, double step, const double *a, size_t size,
                               double *density, ld_error *error)
{
    size_t half = size / 2, segments = (count - half) / half;
    double *segment = malloc((size + 2 * half) * sizeof *segment);
    if (!segment)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a spectrum of %zu samples", size);
    double *edge = segment + size, *own = edge + half;
    for (size_t m = 0; m < half; m++) {
        edge[m] = ((double)m + 0.5) / ((double)size * step);
        density[m] = m ? 0 : NAN;
    }
    const spectrum_series series = {size, step, segment, segment};
    const spectrum_bands bins = {.count = half - 1, .edge = edge, .aa = own};
    ld_status status = LD_OK;
    for (size_t i = 0; i < segments && !status; i++) {
        take_line_off(size, a + i * half, segment);
        status = spectrum_in_bands(&series, &bins, error);
        for (size_t m = 1; m < half && !status; m++)
            density[m] += own[m - 1] / (double)segments;
    }
    free(segment);
    return status;
}
