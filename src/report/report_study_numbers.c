#include "report/report_study_numbers.h"

#include "base/random.h"
#include "math/functions.h"

// 0: the rule gives none.
static double bin_width(const double *sorted, size_t count)
{
    double middle_half =
        sorted_quantile(sorted, count, 0.75) - sorted_quantile(sorted, count, 0.25);
    return 2 * middle_half * pow((double)count, -1.0 / 3);
}

study_bins study_choose_bins(const double *const *sorted, const size_t *count, int series)
{
    double low = INFINITY, high = -INFINITY, width = INFINITY;
    for (int i = 0; i < series; i++) {
        if (count[i] == 0)
            continue;
        double own = bin_width(sorted[i], count[i]);
        low = fmin(low, sorted[i][0]);
        high = fmax(high, sorted[i][count[i] - 1]);
        width = own > 0 ? fmin(width, own) : width;
    }
    if (!isfinite(high - low)) // there are no values, or infinite ones
        return (study_bins){0};
    if (high == low)
        return (study_bins){.from = low, .width = 0, .count = 1};
    double bins = ceil(fmin((high - low) / width, REPORT_BINS));
    int wanted = isinf(width) ? REPORT_BINS : bins < 1 ? 1 : (int)bins;
    return (study_bins){.from = low, .width = (high - low) / wanted, .count = wanted};
}

void study_fill_bins(const study_bins *bins, const double *sorted, size_t count, long *in_bin)
{
    for (int i = 0; i < bins->count; i++)
        in_bin[i] = 0;
    for (size_t i = 0; i < count && bins->count > 0; i++) {
        double bin = bins->width > 0 ? floor((sorted[i] - bins->from) / bins->width) : 0;
        in_bin[(int)fmin(fmax(bin, 0), bins->count - 1)]++;
    }
}

int study_choose_places(size_t groups, int most, size_t *place)
{
    int count = 0;
    double last = log((double)groups), first = log(2);
    for (int i = 0; i < most && groups >= 2; i++) {
        size_t next = (size_t)lround(exp(first + (last - first) * i / (most - 1)));
        if (count == 0 || next > place[count - 1])
            place[count++] = next;
    }
    return count;
}

bool study_shows_point(int64_t sample, int rocket, size_t count, size_t most)
{
    double u = random_uniform(0, random_stream("report"), (uint64_t)sample, (uint64_t)rocket, 0);
    return u * (double)count < (double)most;
}

// ---- as JSON

void study_write_short(FILE *json, double value)
{
    if (isfinite(value))
        fprintf(json, "%.8g", value);
    else
        fputs("null", json);
}

void study_write_estimate(FILE *json, int index, estimate e, study_write_number *write)
{
    fputs(index ? ",[" : "[", json);
    write(json, e.value);
    fputc(',', json);
    write(json, e.low);
    fputc(',', json);
    write(json, e.high);
    fputc(']', json);
}
