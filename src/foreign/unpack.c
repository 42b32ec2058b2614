#include "foreign/unpack.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <minizip/unzip.h>

#include "base/text_file.h"

enum { LONGEST_PATH = 4096, BLOCK_SIZE = 1 << 15 };

typedef struct unpacking {
    const char *path, *folder;
    unzFile zip;
    uint64_t packed;   // [byte] size of the archive
    uint64_t unpacked; // of what has been met so far
    ld_error *error;
} unpacking;

// An entry of the archive.
typedef struct entry {
    char name[FOREIGN_LONGEST_NAME + 1];
    unz_file_info64 about;
} entry;

static ld_status damaged(const unpacking *self)
{
    return ld_fail(self->error, LD_ERR_INPUT, "%.300s: is not a zip archive, or is damaged",
                   self->path);
}

static ld_status refuse_entry(const unpacking *self, const char *name, const char *why)
{
    return ld_fail(self->error, LD_ERR_INPUT, "%.200s: its entry \"%.120s\" %s", self->path, name,
                   why);
}

// ---- names

// A part of a path between slashes, of `length` bytes.
static bool is_plain(const char *part, size_t length)
{
    return length > 0 && !(length == 1 && part[0] == '.') &&
           !(length == 2 && part[0] == '.' && part[1] == '.');
}

// Why a name is refused, or NULL.
static const char *wrong_name(const char *name)
{
    if (name[0] == '/')
        return "has an absolute path";
    if (strchr(name, '\\'))
        return "has a backslash in its name";
    for (const char *c = name; *c; c++)
        if ((unsigned char)*c < 0x20)
            return "has a control character in its name";
    for (const char *part = name; *part;) {
        size_t length = strcspn(part, "/");
        if (!is_plain(part, length))
            return "has a path that leaves the archive";
        part += length;
        part += *part == '/';
    }
    return *name ? NULL : "has no name";
}

static const char *wrong_entry(const entry *one)
{
    enum { MODE_BITS = 16, ENCRYPTED = 1, STORED = 0, DEFLATED = 8 };
    unsigned kind = (unsigned)(one->about.external_fa >> MODE_BITS) & S_IFMT;
    if (strlen(one->name) != one->about.size_filename)
        return "has a name that is too long or has a zero in it";
    const char *why = wrong_name(one->name);
    if (why)
        return why;
    if (S_ISLNK(kind))
        return "is a link";
    if (kind && !S_ISREG(kind) && !S_ISDIR(kind))
        return "is neither a file nor a folder";
    if (one->about.flag & ENCRYPTED)
        return "is encrypted";
    if (one->about.compression_method != STORED && one->about.compression_method != DEFLATED)
        return "uses an unknown compression";
    return NULL;
}

static bool begins(const char *name, const char *with)
{
    return strncmp(name, with, strlen(with)) == 0;
}

// Sources, documentation and other machines' binaries stay packed.
static bool is_wanted(const char *name)
{
    return strcmp(name, "modelDescription.xml") == 0 || begins(name, "resources/") ||
           begins(name, "binaries/" FOREIGN_BINARIES_2 "/") ||
           begins(name, "binaries/" FOREIGN_BINARIES_3 "/");
}

// ---- sizes

// What it says it takes counts, whether it is requested or not.
static ld_status count_size(unpacking *self, const entry *one)
{
    const uint64_t allowance = 1 << 24; // [byte] small archives may be packed as well as they like
    uint64_t size = one->about.uncompressed_size;
    if (size > FOREIGN_MOST_BYTES - self->unpacked)
        return ld_fail(self->error, LD_ERR_INPUT,
                       "%.300s: takes more than %llu MB unpacked, the largest size allowed",
                       self->path, (unsigned long long)(FOREIGN_MOST_BYTES >> 20));
    self->unpacked += size;
    if (self->unpacked > allowance + FOREIGN_MOST_RATIO * self->packed)
        return ld_fail(self->error, LD_ERR_INPUT,
                       "%.300s: grows to more than %d times its size, the largest factor allowed",
                       self->path, FOREIGN_MOST_RATIO);
    return LD_OK;
}

// ---- files

// Makes the folders that lead to a path.
static bool make_way(char *path, size_t from)
{
    for (char *slash = strchr(path + from, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        bool there = mkdir(path, 0700) == 0 || errno == EEXIST;
        *slash = '/';
        if (!there)
            return false;
    }
    return true;
}

static ld_status cannot_write(const unpacking *self, const char *name)
{
    return ld_fail(self->error, LD_ERR_FILE, "%.200s: its entry \"%.120s\" cannot be unpacked: %s",
                   self->path, name, strerror(errno));
}

static ld_status copy_bytes(const unpacking *self, const entry *one, int file)
{
    char block[BLOCK_SIZE];
    uint64_t left = one->about.uncompressed_size;
    if (unzOpenCurrentFile(self->zip) != UNZ_OK)
        return damaged(self);
    ld_status status = LD_OK;
    int length;
    while (!status && (length = unzReadCurrentFile(self->zip, block, sizeof block)) != 0) {
        if (length < 0 || (uint64_t)length > left)
            status = damaged(self);
        else if (write(file, block, (size_t)length) != length)
            status = cannot_write(self, one->name);
        left -= status ? 0 : (uint64_t)length;
    }
    // its checksum is checked here
    bool whole = unzCloseCurrentFile(self->zip) == UNZ_OK && left == 0;
    return status || whole ? status : damaged(self);
}

static ld_status unpack_file(const unpacking *self, const entry *one)
{
    char path[LONGEST_PATH];
    int length = snprintf(path, sizeof path, "%s/%s", self->folder, one->name);
    if (length < 0 || length >= LONGEST_PATH)
        return refuse_entry(self, one->name, "has a name that is too long");
    if (!make_way(path, strlen(self->folder) + 1))
        return errno == ENOTDIR ? refuse_entry(self, one->name, "has a path through a file")
                                : cannot_write(self, one->name);
    if (path[length - 1] == '/')
        return LD_OK;
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0700);
    if (file < 0)
        return errno == EEXIST    ? refuse_entry(self, one->name, "occurs twice")
               : errno == ENOTDIR ? refuse_entry(self, one->name, "has a path through a file")
                                  : cannot_write(self, one->name);
    ld_status status = copy_bytes(self, one, file);
    if (close(file) && !status)
        status = cannot_write(self, one->name);
    return status;
}

static ld_status unpack_entry(unpacking *self)
{
    entry one = {.name = ""};
    if (unzGetCurrentFileInfo64(self->zip, &one.about, one.name, FOREIGN_LONGEST_NAME, NULL, 0,
                                NULL, 0) != UNZ_OK)
        return damaged(self);
    const char *why = wrong_entry(&one);
    if (why)
        return refuse_entry(self, one.name, why);
    ld_status status = count_size(self, &one);
    return status || !is_wanted(one.name) ? status : unpack_file(self, &one);
}

static ld_status unpack_all(unpacking *self)
{
    int next = unzGoToFirstFile(self->zip);
    ld_status status = LD_OK;
    for (int i = 0; next == UNZ_OK && !status; i++) {
        status = i < FOREIGN_MOST_ENTRIES
                     ? unpack_entry(self)
                     : ld_fail(self->error, LD_ERR_INPUT, "%.300s: has more than %d entries",
                               self->path, FOREIGN_MOST_ENTRIES);
        next = unzGoToNextFile(self->zip);
    }
    return status || next == UNZ_END_OF_LIST_OF_FILE ? status : damaged(self);
}

ld_status foreign_unpack(const char *path, const char *folder, ld_error *error)
{
    struct stat about;
    if (stat(path, &about))
        return ld_fail(error, text_file_status(errno), "%.300s: cannot be read: %s", path,
                       strerror(errno));
    if (!S_ISREG(about.st_mode))
        return ld_fail(error, LD_ERR_INPUT, "%.300s: is not a file", path);
    unpacking self = {.path = path,
                      .folder = folder,
                      .packed = (uint64_t)about.st_size,
                      .zip = unzOpen64(path),
                      .error = error};
    if (!self.zip)
        return damaged(&self);
    ld_status status = unpack_all(&self);
    unzClose(self.zip);
    return status;
}
