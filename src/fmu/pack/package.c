#include "fmu/pack/package.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>

#include <minizip/zip.h>

#include "base/part_file.h"

struct package {
    zipFile zip;
    bool failed; // what has gone wrong stays
    int number;  // why, of errno
};

// Keeps the first failure.
static void keep_failure(package *self, bool fine)
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
    keep_failure(self, result == ZIP_OK);
}

static ld_status write_zip(const part_file *part, void put_all(package *self, const void *data),
                           const void *data, ld_error *error)
{
    package self = {0};
    self.zip = zipOpen64(part->path, APPEND_STATUS_CREATE);
    keep_failure(&self, self.zip != NULL);
    if (self.zip) {
        put_all(&self, data);
        errno = 0;
        keep_failure(&self, zipClose(self.zip, NULL) == ZIP_OK);
    }
    if (self.failed && self.number == 0)
        return ld_fail(error, LD_ERR_FILE, "cannot write %.400s: the package cannot be closed",
                       part->name);
    return self.failed ? part_file_failed(part, self.number, error) : LD_OK;
}

ld_status package_write(const char *file, void put_all(package *self, const void *data),
                        const void *data, ld_error *error)
{
    part_file part;
    ld_status status = part_file_begin(&part, file, error);
    if (status)
        return status;
    status = write_zip(&part, put_all, data, error);
    return part_file_end(&part, status, error);
}
