#include "base/text_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include <sys/stat.h>

ld_status text_file_status(int number)
{
    if (number == ENOENT || number == ENOTDIR || number == EISDIR || number == EACCES ||
        number == EPERM || number == ELOOP || number == ENAMETOOLONG)
        return LD_ERR_INPUT;
    return number == ENOMEM ? LD_ERR_MEMORY : LD_ERR_FILE;
}

ld_status text_file_failed(ld_error *error)
{
    return ld_fail(error, text_file_status(errno), "cannot be read: %s", strerror(errno));
}

static ld_status read_stream(FILE *stream, size_t limit, char **text, size_t *length,
                             ld_error *error)
{
    size_t capacity = 1 << 14, used = 0;
    char *buffer = NULL;
    for (;;) {
        char *larger = realloc(buffer, capacity + 1);
        if (!larger) {
            free(buffer);
            errno = ENOMEM;
            return text_file_failed(error);
        }
        buffer = larger;
        used += fread(buffer + used, 1, capacity - used, stream);
        if (used < capacity || used > limit)
            break;
        capacity *= 2;
    }
    if (used > limit) {
        free(buffer);
        return ld_fail(error, LD_ERR_INPUT, "is larger than %zu kB", limit / 1024);
    }
    if (ferror(stream)) {
        ld_status status = text_file_failed(error);
        free(buffer);
        return status;
    }
    buffer[used] = '\0';
    *text = buffer;
    *length = used;
    return LD_OK;
}

ld_status text_file_read(const char *path, size_t limit, char **text, size_t *length,
                         ld_error *error)
{
    struct stat about;
    if (strcmp(path, "-") == 0)
        return read_stream(stdin, limit, text, length, error);
    if (stat(path, &about) != 0)
        return text_file_failed(error);
    if (!S_ISREG(about.st_mode))
        return ld_fail(error, LD_ERR_INPUT, "is not a regular file");
    if (about.st_size > (off_t)limit)
        return ld_fail(error, LD_ERR_INPUT, "is larger than %zu kB", limit / 1024);
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return text_file_failed(error);
    ld_status status = read_stream(stream, limit, text, length, error);
    fclose(stream);
    return status;
}
