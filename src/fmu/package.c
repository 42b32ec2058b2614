#include "fmu/package.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <minizip/zip.h>

#include "base/child.h"

enum { PATH_SIZE = 4096 };

struct package {
    zipFile zip;
    bool failed; // what has gone wrong stays
    int number;  // why, of errno
};

// Keeps the first failure.
static void note(package *self, bool fine)
{
    if (fine || self->failed)
        return;
    self->failed = true;
    self->number = errno;
}

// Every entry is of the same day, so that equal contents make equal packages.
void package_put(package *self, const char *name, const void *bytes, size_t size)
{
    const zip_fileinfo info = {.tmz_date = {.tm_mday = 1, .tm_year = 1980}};
    if (self->failed)
        return;
    errno = 0;
    int result = zipOpenNewFileInZip(self->zip, name, &info, NULL, 0, NULL, 0, NULL, Z_DEFLATED,
                                     Z_DEFAULT_COMPRESSION);
    if (result == ZIP_OK)
        result = zipWriteInFileInZip(self->zip, bytes, (unsigned)size);
    if (result == ZIP_OK)
        result = zipCloseFileInZip(self->zip);
    note(self, result == ZIP_OK);
}

ld_status package_write(const char *file, void put_all(package *self, const void *data),
                        const void *data, ld_error *error)
{
    char part[PATH_SIZE + 8];
    package self = {0};
    snprintf(part, sizeof part, "%.4000s.part", file);
    child_writes(part);
    self.zip = zipOpen64(part, APPEND_STATUS_CREATE);
    note(&self, self.zip != NULL);
    if (self.zip) {
        put_all(&self, data);
        errno = 0;
        note(&self, zipClose(self.zip, NULL) == ZIP_OK);
        note(&self, self.failed || rename(part, file) == 0);
        if (self.failed)
            unlink(part);
    }
    child_wrote(part);
    if (self.failed)
        return ld_fail(error, LD_ERR_FILE, "cannot write %.400s: %s", file,
                       self.number ? strerror(self.number) : "the package cannot be closed");
    return LD_OK;
}
