#include "studies/run/keeper.h"

#include <stdlib.h>

#include "base/random.h"
#include "launchdyn/version.h"
#include "studies/run/part.h"
#include "studies/store/store_begin.h"

ld_status study_key(const ld_study *study, uint64_t *key, ld_error *error)
{
    char *identity = store_identity(study->nominal);
    if (!identity)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the scenario's text");
    *key = random_stream(identity) ^ random_stream(LD_VERSION);
    free(identity);
    return LD_OK;
}

// ---- what is kept

static bool is_kept(const study_keeper *self, int64_t number)
{
    return self->kept[(number - 1) / 8] >> ((number - 1) % 8) & 1;
}

// A sample beyond the study's, of a time when it had more, belongs to no range.
static void note_kept(void *argument, int64_t number)
{
    study_keeper *self = argument;
    int range = ranges_find(&self->ranges, number);
    if (range == self->ranges.count)
        return;
    self->kept[(number - 1) / 8] |= (unsigned char)(1 << (number - 1) % 8);
    self->lacks[range]--;
}

bool keeper_has(const study_keeper *self, int range)
{
    return self->lacks[range] == 0;
}

bool keeper_wants(const study_keeper *self, int range)
{
    return self->ranges.item[range].last <= self->rule.look && !keeper_has(self, range);
}

static bool has_all_wanted(const study_keeper *self)
{
    int range = 0;
    while (range < self->ranges.count && !keeper_wants(self, range))
        range++;
    return range == self->ranges.count;
}

bool keeper_is_complete(const study_keeper *self)
{
    return self->rule.decided && has_all_wanted(self);
}

ld_status keeper_check(study_keeper *self, ld_error *error)
{
    ld_status status = LD_OK;
    while (!status && !self->rule.decided && has_all_wanted(self))
        status = until_check(&self->rule, &self->store, self->folder, error);
    return status;
}

static ld_status put_record(study_keeper *self, ld_error *error)
{
    const study_record *record = self->record;
    if (record->number > self->study->samples || is_kept(self, record->number))
        return LD_OK;
    ld_status status = store_put(&self->store, record, error);
    if (status)
        return status;
    note_kept(self, record->number);
    self->done++;
    self->failed += record->outcome != LD_OK;
    return LD_OK;
}

bool keeper_knows(const study_keeper *self, const void *part, size_t size)
{
    part_reader reader = {.shape = self->study->shape, .record = self->record};
    ld_error error;
    return part_open(&reader, part, size, self->key, &error) == LD_OK;
}

ld_status keeper_put(study_keeper *self, const void *part, size_t size, ld_error *error)
{
    part_reader reader = {.shape = self->study->shape, .record = self->record};
    ld_status status = part_open(&reader, part, size, self->key, error);
    while (!status && part_next(&reader))
        status = put_record(self, error);
    return status ? status : store_settle(&self->store, false, error);
}

// ---- from begin to end

static ld_status make_lists(study_keeper *self, ld_error *error)
{
    ld_status status = ranges_create(&self->ranges, self->study, error);
    if (status)
        return status;
    self->kept = calloc((size_t)self->study->samples / 8 + 1, 1);
    self->lacks = calloc((size_t)self->ranges.count + 1, sizeof *self->lacks);
    self->record = calloc(1, record_size(&self->study->shape));
    if (!self->kept || !self->lacks || !self->record)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the numbers of the samples");
    for (int i = 0; i < self->ranges.count; i++)
        self->lacks[i] = self->ranges.item[i].last - self->ranges.item[i].first + 1;
    return LD_OK;
}

ld_status keeper_open(study_keeper *self, const ld_study *study, const store_place *place,
                      ld_error *error)
{
    ld_study_counts counts = {0};
    *self = (study_keeper){.study = study, .folder = place->folder, .rule = until_begin(study)};
    self->ruled = !self->rule.decided;
    ld_status status = store_open(&self->store, place, study, error);
    self->open = !status;
    if (!status)
        status = study_key(study, &self->key, error);
    if (!status)
        status = make_lists(self, error);
    if (!status)
        status = store_numbers(&self->store, note_kept, self, error);
    if (!status)
        status = store_count(&self->store, &counts, error);
    self->done = counts.done;
    self->failed = counts.failed;
    return status ? status : keeper_check(self, error);
}

ld_status keeper_close(study_keeper *self, ld_error *error)
{
    ld_status status = LD_OK;
    if (self->open) {
        status = store_settle(&self->store, true, error);
        if (!status)
            status = store_check_place(&self->store, error);
        store_close(&self->store);
    }
    ranges_free(&self->ranges);
    free(self->lacks);
    free(self->kept);
    free(self->record);
    *self = (study_keeper){0};
    return status;
}
