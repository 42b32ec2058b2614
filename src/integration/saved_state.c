#include "integration/saved_state.h"

#include "model/fields/digest.h"

void saved_state_head(const saved_state *self, const ld_model *model, archive *bytes,
                      int64_t length)
{
    archive_expect(bytes, self->magic);
    archive_expect(bytes, self->form);
    archive_expect(bytes, (int64_t)model_digest(model));
    archive_expect(bytes, length);
}

void saved_state_sum(archive *bytes)
{
    uint64_t sum = bytes->failed ? 0 : digest_bytes(DIGEST_BEGIN, bytes->bytes, bytes->at);
    archive_expect(bytes, (int64_t)sum);
}

ld_status saved_state_check(const saved_state *self, const ld_model *model, const void *bytes,
                            size_t size, ld_error *error)
{
    archive loaded = archive_load(bytes, size);
    archive_expect(&loaded, self->magic);
    if (loaded.failed)
        return ld_fail(error, LD_ERR_INPUT, "this is not a saved %s", self->name);
    archive_expect(&loaded, self->form);
    if (loaded.failed)
        return ld_fail(error, LD_ERR_INPUT, "the %s was saved by another version of launchdyn",
                       self->name);
    archive_expect(&loaded, (int64_t)model_digest(model));
    if (loaded.failed)
        return ld_fail(error, LD_ERR_INPUT, "the saved %s belongs to another model", self->name);
    archive_expect(&loaded, (int64_t)size);
    if (!loaded.failed) {
        loaded.at = size - 8;
        saved_state_sum(&loaded);
    }
    return loaded.failed
               ? ld_fail(error, LD_ERR_INPUT, "the saved %s is truncated or damaged", self->name)
               : LD_OK;
}
