#include "studies/run/ranges.h"

#include <stdlib.h>

#include "studies/run/until.h"

// The most ranges of all samples; of the samples between two checks of a stopping rule.
enum { MOST = 4000, MOST_BETWEEN = 400 };

static ld_status add_ranges(study_ranges *self, int64_t first, int64_t last, int64_t size,
                            ld_error *error)
{
    int64_t more = (last - first) / size + 1;
    sample_range *item = realloc(self->item, (size_t)(self->count + more) * sizeof *item);
    if (!item)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the ranges of samples");
    self->item = item;
    for (; first <= last; first += size)
        item[self->count++] = (sample_range){first, last - first < size ? last : first + size - 1};
    return LD_OK;
}

ld_status ranges_create(study_ranges *self, const ld_study *study, ld_error *error)
{
    until_rule rule = until_begin(study);
    int64_t most = rule.decided ? MOST : MOST_BETWEEN, before = 0;
    ld_status status = LD_OK;
    *self = (study_ranges){0};
    while (!status && before < rule.last) {
        int64_t size = (rule.look - before + most - 1) / most;
        status = add_ranges(self, before + 1, rule.look, size, error);
        before = rule.look;
        if (before < rule.last)
            until_look_further(&rule);
    }
    if (status)
        ranges_free(self);
    return status;
}

void ranges_free(study_ranges *self)
{
    free(self->item);
    *self = (study_ranges){0};
}

int ranges_find(const study_ranges *self, int64_t number)
{
    int low = 0, high = self->count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (self->item[middle].last < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low < self->count && self->item[low].first <= number ? low : self->count;
}
