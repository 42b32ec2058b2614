// Any bytes as an FMU's archive are refused with one sentence that names it, or unpacked: never is
// a link made, or anything beside the folder.
#define _XOPEN_SOURCE 700 // nftw; NOLINT(bugprone-reserved-identifier)
#include <ftw.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "foreign/folder.h"
#include "foreign/unpack.h"
#include "fuzz/must_say.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int look_at(const char *path, const struct stat *about, int kind, struct FTW *at)
{
    (void)path, (void)kind, (void)at;
    must(S_ISREG(about->st_mode) || S_ISDIR(about->st_mode));
    return 0;
}

// What stands in a folder.
static int count(const char *path)
{
    struct stat about;
    must(stat(path, &about) == 0);
    return (int)about.st_nlink;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char around[] = "/tmp/launchdyn-fuzz-XXXXXX", into[64], file[64];
    ld_error error = {0};
    must(mkdtemp(around) != NULL);
    snprintf(into, sizeof into, "%s/into", around);
    snprintf(file, sizeof file, "%s/x.fmu", around);
    FILE *to = fopen(file, "wb");
    must(to && fwrite(data, 1, size, to) == size && fclose(to) == 0 && mkdir(into, 0700) == 0);
    ld_status status = foreign_unpack(file, into, &error);
    must(!status || strstr(error.text, "/x.fmu: "));
    nftw(into, look_at, 16, FTW_PHYS);
    must(count(around) == 3); // itself, its parent, one folder
    foreign_folder_remove(around);
    return 0;
}
