#include "studies/run/part.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

// Written as it lies in memory: bits are those of one kind of processor.
typedef struct part_head {
    char kind[8];
    uint64_t key;
    uint64_t size;   // of what follows
    uint64_t digest; // of what follows
} part_head;

static const char kind[8] = "ldpart1";

// Before the reason, filled up to words, and the numbers.
typedef struct packed_record {
    int64_t number, outcome, rockets, reason; // bytes of the reason
} packed_record;

static size_t padded(int64_t bytes)
{
    return ((size_t)bytes + 7) / 8 * 8;
}

static bool make_room(study_part *self, size_t more)
{
    size_t room = self->room ? self->room : 4096;
    while (room < self->size + more)
        room *= 2;
    if (room == self->room)
        return true;
    unsigned char *bytes = realloc(self->bytes, room);
    if (!bytes)
        return false;
    self->bytes = bytes;
    self->room = room;
    return true;
}

static void append(study_part *self, const void *bytes, size_t size)
{
    memcpy(self->bytes + self->size, bytes, size);
    self->size += size;
}

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the records of samples");
}

ld_status part_add(study_part *self, const study_record *record, ld_error *error)
{
    const packed_record head = {record->number, record->outcome, record->shape.rockets,
                                (int64_t)strlen(record->reason)};
    const uint64_t zero = 0;
    size_t values = (size_t)record_rocket(&record->shape, record->shape.rockets) * sizeof(double);
    size_t filling = padded(head.reason) - (size_t)head.reason;
    size_t first = self->size ? 0 : sizeof(part_head);
    if (!make_room(self, first + sizeof head + padded(head.reason) + values))
        return no_memory(error);
    self->size += first;
    append(self, &head, sizeof head);
    append(self, record->reason, (size_t)head.reason);
    append(self, &zero, filling);
    append(self, record->value, values);
    self->count++;
    return LD_OK;
}

ld_status part_seal(study_part *self, uint64_t key, ld_error *error)
{
    if (!self->size && !make_room(self, sizeof(part_head)))
        return no_memory(error);
    self->size = self->size ? self->size : sizeof(part_head);
    part_head head = {.key = key, .size = self->size - sizeof head};
    memcpy(head.kind, kind, sizeof kind);
    head.digest = crc32_z(0, self->bytes + sizeof head, head.size);
    memcpy(self->bytes, &head, sizeof head);
    return LD_OK;
}

void part_free(study_part *self)
{
    free(self->bytes);
    *self = (study_part){0};
}

// ---- reading

ld_status part_open(part_reader *self, const void *bytes, size_t size, uint64_t key,
                    ld_error *error)
{
    part_head head = {0};
    const unsigned char *from = bytes;
    if (size >= sizeof head)
        memcpy(&head, bytes, sizeof head);
    if (memcmp(head.kind, kind, sizeof kind) != 0 || head.size != size - sizeof head ||
        head.digest != crc32_z(0, from + sizeof head, head.size))
        return ld_fail(error, LD_ERR_INPUT, "records of samples are damaged: they run again");
    if (head.key != key)
        return ld_fail(error, LD_ERR_INPUT,
                       "records of samples are of another scenario, or another version of "
                       "launchdyn ran them");
    self->next = from + sizeof head;
    self->end = from + size;
    return LD_OK;
}

// Whether what is packed at `next` is a record of the study, all of which is there.
static bool is_possible(const part_reader *self, const packed_record *head, size_t there)
{
    study_shape shape = self->shape;
    if (head->number < 1 || head->outcome < 0 || head->rockets < 0 ||
        head->rockets > shape.rockets || head->reason < 0 || head->reason >= LD_ERROR_TEXT)
        return false;
    return there >=
           padded(head->reason) + (size_t)record_rocket(&shape, head->rockets) * sizeof(double);
}

bool part_next(part_reader *self)
{
    packed_record head;
    size_t there = (size_t)(self->end - self->next);
    if (there < sizeof head)
        return false;
    memcpy(&head, self->next, sizeof head);
    if (!is_possible(self, &head, there - sizeof head))
        return false;
    study_record *record = self->record;
    record->number = head.number;
    record->outcome = head.outcome;
    record->shape = self->shape;
    record->shape.rockets = head.rockets;
    const unsigned char *reason = self->next + sizeof head;
    memcpy(record->reason, reason, (size_t)head.reason);
    record->reason[head.reason] = '\0';
    size_t values = (size_t)record_rocket(&record->shape, head.rockets) * sizeof(double);
    memcpy(record->value, reason + padded(head.reason), values);
    self->next = reason + padded(head.reason) + values;
    return true;
}
