#include "base/part_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/child.h"

enum { MOST_NAMES = 99 };

static bool is_replaced(const char *path)
{
    struct stat there;
    return stat(path, &there) != 0 || S_ISREG(there.st_mode) || S_ISDIR(there.st_mode);
}

ld_status part_file_failed(const part_file *self, int number, ld_error *error)
{
    return ld_fail(error, LD_ERR_FILE, "cannot write %.400s: %s", self->name, strerror(number));
}

// Makes the file under the temporary name of this number; errno says why not.
static bool make(part_file *self, int number)
{
    char ending[24] = ".part";
    if (number > 1)
        snprintf(ending, sizeof ending, ".%d.part", number);
    snprintf(self->path, sizeof self->path, "%s%s", self->name, ending);
    child_writes(self->path);
    int file = open(self->path, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file >= 0 && close(file) == 0)
        return true;
    int problem = errno;
    if (file >= 0)
        unlink(self->path);
    child_wrote(self->path);
    errno = problem;
    return false;
}

ld_status part_file_begin(part_file *self, const char *name, ld_error *error)
{
    self->name = name;
    self->replaces = is_replaced(name);
    if (strlen(name) + 16 > sizeof self->path)
        return ld_fail(error, LD_ERR_INPUT, "the file's name is too long: %.200s...", name);
    strcpy(self->path, name);
    bool made = !self->replaces;
    for (int i = 1; !made && i <= MOST_NAMES; i++) {
        made = make(self, i);
        if (!made && errno != EEXIST)
            return part_file_failed(self, errno, error);
    }
    return made ? LD_OK
                : ld_fail(error, LD_ERR_FILE,
                          "cannot write %.400s: all temporary names are taken, from %.400s.part "
                          "to .%d.part; remove those of programs that were killed",
                          name, name, MOST_NAMES);
}

ld_status part_file_end(part_file *self, ld_status status, ld_error *error)
{
    if (!self->replaces)
        return status;
    if (!status && rename(self->path, self->name) != 0)
        status = part_file_failed(self, errno, error);
    if (status)
        unlink(self->path);
    child_wrote(self->path);
    return status;
}
