#include "studies/run/join_state.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "base/random.h"
#include "launchdyn/scenario.h"
#include "launchdyn/version.h"

static const char name[] = "state";

ld_status join_key(const ld_study *study, uint64_t *key, ld_error *error)
{
    char *text = NULL;
    size_t length;
    FILE *stream = memory_stream(&text, &length);
    if (stream)
        ld_model_print(ld_study_model(study), stream);
    bool good = stream && fclose(stream) == 0;
    if (good)
        *key = random_stream(text) ^ random_stream(LD_VERSION);
    free(text);
    return good ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the scenario's text");
}

ld_status join_state_take(join_state *self, const study_keeper *keeper, ld_error *error)
{
    int count = keeper->ranges.count;
    char *kept = realloc(self->kept, (size_t)count + 1);
    if (!kept)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the ranges of samples");
    for (int i = 0; i < count; i++)
        kept[i] = keeper_has(keeper, i) ? '1' : '0';
    kept[count] = '\0';
    *self = (join_state){.key = self->key,
                         .samples = keeper->rule.last,
                         .look = keeper->rule.look,
                         .done = keeper->done,
                         .failed = keeper->failed,
                         .ruled = keeper->ruled,
                         .enough = keeper->rule.enough,
                         .complete = keeper_is_complete(keeper),
                         .count = count,
                         .kept = kept,
                         .time = self->time};
    return LD_OK;
}

#define FORM                                                                                       \
    "launchdyn ranges 1\nkey %" PRIx64 "\nsamples %" PRId64 "\nlook %" PRId64 "\ndone %" PRId64    \
    "\nfailed %" PRId64 "\nruled %d\nenough %d\ncomplete %d\nranges %d\n"
#define FORM_READ                                                                                  \
    "launchdyn ranges 1 key %" SCNx64 " samples %" SCNd64 " look %" SCNd64 " done %" SCNd64        \
    " failed %" SCNd64 " ruled %d enough %d complete %d ranges %d %n"

ld_status join_state_write(const join_state *self, const study_claims *claims, ld_error *error)
{
    size_t room = (size_t)self->count + 512;
    char *text = malloc(room);
    if (!text)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the ranges of samples");
    int length =
        snprintf(text, room, FORM "%s\n", self->key, self->samples, self->look, self->done,
                 self->failed, self->ruled, self->enough, self->complete, self->count, self->kept);
    ld_status status = claims_write(claims, name, text, (size_t)length, error);
    free(text);
    return status;
}

bool join_state_read(join_state *self, const study_claims *claims)
{
    join_state read = {0};
    size_t size;
    int at = 0;
    char *text = claims_read(claims, name, &size, &read.time);
    bool good =
        text && read.time >= claims->begun &&
        sscanf(text, FORM_READ, &read.key, &read.samples, &read.look, &read.done, &read.failed,
               &read.ruled, &read.enough, &read.complete, &read.count, &at) == 9 &&
        at > 0 && read.count >= 0 && strspn(text + at, "01") == (size_t)read.count;
    if (good) {
        memmove(text, text + at, (size_t)read.count);
        text[read.count] = '\0';
        read.kept = text;
        free(self->kept);
        *self = read;
    } else {
        free(text);
    }
    return good;
}

void join_state_free(join_state *self)
{
    free(self->kept);
    *self = (join_state){0};
}
