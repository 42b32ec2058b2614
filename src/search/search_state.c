#include "search/search_state.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/lock_file.h"
#include "base/random.h"
#include "base/text_file.h"
#include "launchdyn/version.h"

enum { HEAD = 96, MOST_BYTES = 1 << 30 };

// A record: point, whether there is a launch, numbers; then a digest of these bytes.
static size_t record_size(const search_state *self)
{
    return (size_t)(self->keys + 1 + self->numbers) * sizeof(double);
}

// FNV-1a.
static uint64_t digest_of(const void *bytes, size_t size)
{
    const unsigned char *byte = bytes;
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ byte[i]) * 0x100000001b3u;
    return hash;
}

static ld_status cannot(const search_state *self, const char *what, ld_error *error)
{
    return ld_fail(error, LD_ERR_FILE, "cannot %s %.300s: %s", what, self->path, strerror(errno));
}

// Reads what is there; nothing where there is no file.
static ld_status read_file(search_state *self, const char *head, ld_error *error)
{
    ld_error why;
    struct stat there;
    if (stat(self->path, &there) != 0 || there.st_size == 0)
        return LD_OK;
    ld_status status = text_file_read(self->path, MOST_BYTES, &self->text, &self->length, &why);
    if (status)
        return ld_fail(error, status, "%.300s %s", self->path, why.text);
    if (self->length < HEAD || memcmp(self->text, head, HEAD) != 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "%.300s is of another scenario, other keys or other data, or of another "
                       "version; use another folder",
                       self->path);
    self->at = HEAD;
    return LD_OK;
}

static ld_status open_file(search_state *self, const char *head, ld_error *error)
{
    ld_status status = read_file(self, head, error);
    if (status)
        return status;
    self->file = fopen(self->path, self->text ? "r+b" : "wb");
    if (!self->file)
        return cannot(self, "write", error);
    if (!self->text && fwrite(head, 1, HEAD, self->file) != HEAD)
        return cannot(self, "write", error);
    return LD_OK;
}

ld_status search_state_open(search_state *self, const search_kind *kind, const char *folder,
                            const char *identity, ld_error *error)
{
    char head[HEAD + 1] = "";
    *self = (search_state){.lock = -1, .keys = kind->keys, .numbers = kind->numbers};
    if (!folder)
        return LD_OK;
    int length = snprintf(self->path, sizeof self->path, "%s/%s.state", folder, kind->what);
    snprintf(self->lock_path, sizeof self->lock_path, "%s/%s.lock", folder, kind->what);
    if (length < 0 || (size_t)length >= sizeof self->path)
        return ld_fail(error, LD_ERR_INPUT, "the folder's name is too long");
    int written = snprintf(head, sizeof head, "launchdyn %s 1, version %.20s, %016" PRIx64,
                           kind->what, LD_VERSION, digest_of(identity, strlen(identity)));
    memset(head + written, ' ', (size_t)(HEAD - written));
    head[HEAD - 1] = '\n';
    ld_status status = lock_file_take(self->lock_path, folder, &self->lock, error);
    return status ? status : open_file(self, head, error);
}

bool search_state_next(search_state *self, const double *point, double *number, bool *there)
{
    size_t size = record_size(self), keys = (size_t)self->keys * sizeof(double);
    uint64_t digest;
    double flag;
    if (!self->text)
        return false;
    const char *record = self->text + self->at;
    bool whole = self->at + size + sizeof digest <= self->length;
    if (whole)
        memcpy(&digest, record + size, sizeof digest);
    if (!whole || digest != digest_of(record, size) || memcmp(record, point, keys) != 0) {
        // damaged, or of another machine: what follows is computed again
        free(self->text);
        self->text = NULL;
        if (fseeko(self->file, (off_t)self->at, SEEK_SET) != 0 ||
            ftruncate(fileno(self->file), (off_t)self->at) != 0)
            self->uncut = errno;
        return false;
    }
    memcpy(&flag, record + keys, sizeof flag);
    memcpy(number, record + keys + sizeof flag, (size_t)self->numbers * sizeof *number);
    *there = flag != 0;
    self->at += size + sizeof digest;
    return true;
}

ld_status search_state_put(search_state *self, const double *point, const double *number,
                           bool there, ld_error *error)
{
    size_t size = record_size(self), keys = (size_t)self->keys * sizeof(double);
    double flag = there;
    if (!self->file)
        return LD_OK;
    if (self->uncut) {
        errno = self->uncut;
        return cannot(self, "cut what is damaged off", error);
    }
    char *record = calloc(1, size);
    if (!record)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for what was computed");
    memcpy(record, point, keys);
    memcpy(record + keys, &flag, sizeof flag);
    if (there)
        memcpy(record + keys + sizeof flag, number, (size_t)self->numbers * sizeof *number);
    uint64_t digest = digest_of(record, size);
    bool good = fwrite(record, 1, size, self->file) == size &&
                fwrite(&digest, 1, sizeof digest, self->file) == sizeof digest;
    free(record);
    return good ? LD_OK : cannot(self, "write", error);
}

ld_status search_state_flush(search_state *self, ld_error *error)
{
    return !self->file || fflush(self->file) == 0 ? LD_OK : cannot(self, "write", error);
}

void search_state_close(search_state *self)
{
    if (self->file)
        fclose(self->file);
    if (self->lock >= 0)
        lock_file_remove(self->lock_path, self->lock);
    free(self->text);
    *self = (search_state){.lock = -1};
}
