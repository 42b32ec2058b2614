// Plausibility of a base whose motion is given: sines, measured rows, a sea.
#include <stdlib.h>

#include "math/curves/spline.h"
#include "math/functions.h"
#include "model/model.h"
#include "model/motion_rows.h"
#include "model/warnings/plausible_rule.h"

#define PI 3.14159265358979323846

// Largest change of phase from row to row of the motion in columns j and j + 1, where in both rows
// it is more than a twentieth of its largest.
static double phase_step(const ld_table *table, size_t j)
{
    double largest = 0, most = 0;
    for (size_t i = 0; i < table->rows; i++)
        largest = fmax(largest, table->data[i * table->columns + j]);
    for (size_t i = 1; i < table->rows; i++) {
        const double *row = table->data + i * table->columns + j, *before = row - table->columns;
        if (fmin(row[0], before[0]) > 0.05 * largest)
            most = fmax(most, fabs(remainder(row[1] - before[1], 2 * PI)));
    }
    return most;
}

// Sum of amplitude (2 pi f)^power.
static double greatest_rate(const ld_sines *sines, int power)
{
    double sum = 0;
    for (int i = 0; i < sines->count; i++)
        sum += fabs(sines->term[i].amplitude) * pow(2 * PI * sines->term[i].frequency, power);
    return sum;
}

static plausible_pair base_acceleration(const plausible_entry *at)
{
    const ld_base *base = &at->model->base;
    const double a[3] = {greatest_rate(&base->surge, 2), greatest_rate(&base->heave, 2),
                         greatest_rate(&base->sway, 2)};
    return plausible_alone(plausible_norm(a));
}

static plausible_pair base_rate(const plausible_entry *at)
{
    const ld_base *base = &at->model->base;
    const double w[3] = {greatest_rate(&base->yaw, 1), greatest_rate(&base->pitch, 1),
                         greatest_rate(&base->roll, 1)};
    return plausible_alone(plausible_norm(w));
}

// Rows of the measured motion that the run sees as far as is known before it, and some more before
// and behind; false: there are none.
static bool rows_of_run(const ld_model *model, size_t *first, size_t *count)
{
    enum { MORE = 10 };
    const ld_table *table = &model->base.motion;
    double since = model->base.motion_start - model->base.motion_origin;
    double begin = fmin(model->firing[0].at, -model->run.lead_in) + since;
    double end = model->firing[model->firing_count - 1].at + since +
                 (model->run.end == LD_END_TIME ? model->run.end_time : model->run.stuck_time);
    size_t last = table->rows;
    *first = 0;
    while (*first + MORE < last && table->data[(*first + MORE) * table->columns] < begin)
        ++*first;
    while (last > *first + MORE && table->data[(last - MORE) * table->columns] > end)
        last--;
    *count = last - *first;
    return table->rows > 0;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// The longest time from row to row of the run beside the median of them.
static plausible_pair motion_gap(const plausible_entry *at)
{
    const ld_table *table = &at->model->base.motion;
    size_t first, count;
    plausible_pair pair = plausible_nothing();
    if (!rows_of_run(at->model, &first, &count) || count < 3)
        return pair;
    double *step = malloc(count * sizeof *step);
    for (size_t i = 1; i < count && step; i++) {
        const double *row = table->data + (first + i) * table->columns;
        step[i - 1] = row[0] - row[-(ptrdiff_t)table->columns];
        if (!(step[i - 1] <= pair.value)) {
            pair.value = step[i - 1];
            pair.row = (int)(first + i) + 1;
        }
    }
    if (step) {
        qsort(step, count - 1, sizeof *step, by_size);
        pair.other = step[(count - 1) / 2];
    }
    free(step);
    return pair;
}

// How far a coordinate's skipped rows are from the spline through every second one, beside its
// range without its mean rate; `row`: the farthest, from 0.
static plausible_pair coarseness(const motion_rows *rows, size_t k, double *t, double *at)
{
    size_t n = rows->coordinates, half = (rows->count + 1) / 2;
    const double *x = rows->at + k;
    double low = 0, high = 0,
           rate = (x[(rows->count - 1) * n] - x[0]) / (rows->t[rows->count - 1] - rows->t[0]);
    plausible_pair pair = plausible_compare(0, NAN);
    spline every_second;
    for (size_t i = 0; i < rows->count; i++) {
        double off = x[i * n] - x[0] - rate * (rows->t[i] - rows->t[0]);
        low = fmin(low, off);
        high = fmax(high, off);
        t[i / 2] = rows->t[i / 2 * 2];
        at[i / 2] = x[i / 2 * 2 * n];
    }
    if (spline_build(&every_second, half, t, at, NULL))
        return plausible_nothing();
    pair.other = high - low;
    // but for the ends, where a spline knows less
    for (size_t i = 3; i + 3 < rows->count; i += 2) {
        double off = fabs(x[i * n] - spline_value(&every_second, rows->t[i], NULL));
        if (off > pair.value) {
            pair.value = off;
            pair.row = (int)i;
        }
    }
    spline_free(&every_second);
    return pair;
}

// The coordinate for which that is worst, of those that move.
static plausible_pair motion_coarse(const plausible_entry *at)
{
    static const double AT_REST = 1e-4; // [m], [rad]
    motion_rows rows;
    size_t first, count;
    plausible_pair worst = plausible_compare(0, 1);
    if (!rows_of_run(at->model, &first, &count) || count < 12 ||
        !motion_rows_take(&rows, &at->model->base, first, count))
        return plausible_nothing();
    double *column = malloc(2 * count * sizeof *column);
    for (size_t k = 0; k < rows.coordinates && column; k++) {
        plausible_pair pair = coarseness(&rows, k, column, column + count);
        if (!(pair.other > AT_REST && pair.value * worst.other > worst.value * pair.other))
            continue;
        worst = pair;
        worst.row += (int)first + 1;
        worst.unit = k < 3 ? "m" : rows.coordinates == MOTION_ANGLES ? "rad" : "";
    }
    free(column);
    motion_rows_free(&rows);
    return worst;
}

// Largest change of a motion's phase from row to row where it is more than a twentieth of its
// largest, in all responses.
static plausible_pair sea_phase_step(const plausible_entry *at)
{
    const ld_sea *sea = &at->model->base.sea;
    double most = 0;
    for (int i = 0; i < sea->response_count; i++) {
        const ld_table *table = &sea->response[i].table;
        for (size_t j = 1; j < table->columns; j += 2)
            most = fmax(most, phase_step(table, j));
    }
    return plausible_alone(sea->present ? most : NAN);
}

const plausible_rule plausible_of_base[] = {
    {"base.velocity", "the speed", .unit = "m/s", NO_LOW, .high = 1000, .form = PLAUSIBLE_NORM,
     .why = "it is steady while the launch lasts"},
    {"base.motion", "the acceleration by its sines", .unit = "m/s2", NO_LOW, .high = 100,
     .find = base_acceleration, .why = "gravity is 9.8 m/s2"},
    {"base.motion", "the angular rate by its sines", .unit = "rad/s", NO_LOW, .high = 10,
     .find = base_rate, .why = "that is more than a turn in a second"},
    {"base.motion.table.#", "the time since the row before", .unit = "s",
     .other = "the median of these times", NO_LOW, .high = 10, .find = motion_gap,
     .why = "in a gap the motion is only that of a spline"},
    {"base.motion.table.#", "the distance from a spline through every second row", .unit = "m",
     .other = "the range of that coordinate without its mean rate", NO_LOW, .high = 0.01,
     .find = motion_coarse, .why = "rows so coarse or noisy give no acceleration"},
    {"base.sea.height", "the steepness of the waves", .unit = "", NO_LOW, .high = 0.07,
     .form = PLAUSIBLE_RATIO, .b = "the wavelength", .of = "base.sea.period",
     .why = "steeper waves break"},
    {"base.sea.responses", "the phase from row to row", .unit = "rad", NO_LOW,
     .high = 100 * PI / 180, .find = sea_phase_step,
     .why = "a line between rows so far apart goes past the response"},
    {0}};
