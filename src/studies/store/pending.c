#include "studies/store/pending.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

// A slot is the digest of a record, then the record.
static study_record *record_in(const study_pending *self, int index)
{
    return (study_record *)(void *)(self->slot + (size_t)index * self->slot_size +
                                    sizeof(uint64_t));
}

static uint64_t *digest_in(const study_pending *self, int index)
{
    return (uint64_t *)(void *)(self->slot + (size_t)index * self->slot_size);
}

// FNV-1a by words: says what was not written whole, or for another study.
static uint64_t digest(const study_pending *self, const study_record *record)
{
    const unsigned char *bytes = (const unsigned char *)record;
    uint64_t hash = 0xcbf29ce484222325u ^ self->key;
    for (size_t i = 0; i < record_size(&record->shape); i += sizeof hash) {
        uint64_t word;
        memcpy(&word, bytes + i, sizeof word);
        hash = (hash ^ word) * 0x100000001b3u;
    }
    return hash;
}

static bool is_whole(const study_pending *self, int index)
{
    const study_record *record = record_in(self, index);
    study_shape shape = record->shape;
    return record->number > 0 && shape.rockets >= 0 && shape.rockets <= self->shape.rockets &&
           shape.of_sample == self->shape.of_sample && shape.of_rocket == self->shape.of_rocket &&
           shape.results == self->shape.results &&
           memchr(record->reason, '\0', sizeof record->reason) &&
           *digest_in(self, index) == digest(self, record);
}

// Puts a whole record behind those before it, where one between them is damaged.
static void move_up(study_pending *self, int index)
{
    if (index > self->count) {
        memcpy(record_in(self, self->count), record_in(self, index), record_size(&self->shape));
        *digest_in(self, self->count) = *digest_in(self, index);
        *digest_in(self, index) = 0;
    }
    self->count++;
}

ld_status pending_open(study_pending *self, const char *path, uint64_t key,
                       const study_shape *shape, ld_error *error)
{
    *self = (study_pending){
        .slot_size = sizeof(uint64_t) + record_size(shape), .shape = *shape, .key = key};
    snprintf(self->path, sizeof self->path, "%s", path);
    size_t size = PENDING_MOST * self->slot_size;
    int file = open(path, O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (file < 0)
        return ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", path, strerror(errno));
    // room on the disk first: none is missing later
    int problem = posix_fallocate(file, 0, (off_t)size);
    void *map =
        problem ? MAP_FAILED : mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    problem = !problem && map == MAP_FAILED ? errno : problem;
    close(file);
    if (problem)
        return ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", path, strerror(problem));
    self->slot = map;
    for (int i = 0; i < PENDING_MOST; i++)
        if (is_whole(self, i))
            move_up(self, i);
    return LD_OK;
}

void pending_close(study_pending *self)
{
    if (!self->slot)
        return;
    if (self->count == 0)
        unlink(self->path);
    munmap(self->slot, PENDING_MOST * self->slot_size);
    self->slot = NULL;
}

void pending_add(study_pending *self, const study_record *record)
{
    memcpy(record_in(self, self->count), record, record_size(&record->shape));
    *digest_in(self, self->count) = digest(self, record);
    self->count++;
}

void pending_clear(study_pending *self)
{
    for (int i = 0; i < PENDING_MOST; i++)
        *digest_in(self, i) = 0;
    self->count = 0;
}

const study_record *pending_read(const study_pending *self, int index)
{
    return record_in(self, index);
}
