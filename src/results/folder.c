#include "results/folder.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

ld_status folder_make(char *path, size_t *there, ld_error *error)
{
    bool made = false;
    *there = 0;
    for (size_t end = 1;; end++) {
        char letter = path[end];
        if (letter && letter != '/')
            continue;
        path[end] = '\0';
        if (mkdir(path, 0777) == 0) {
            made = true;
        } else if (errno != EEXIST) {
            return ld_fail(error, LD_ERR_FILE, "cannot make the folder %s: %s", path,
                           strerror(errno));
        }
        path[end] = letter;
        if (!made)
            *there = end;
        if (!letter)
            return LD_OK;
    }
}

ld_status folder_ensure(const char *path, ld_error *error)
{
    char made[4096];
    size_t there;
    if (!*path || strlen(path) >= sizeof made)
        return ld_fail(error, LD_ERR_INPUT, "the folder has no name, or one that is too long");
    strcpy(made, path);
    return folder_make(made, &there, error);
}

void folder_remove(char *path, size_t there)
{
    for (size_t end = strlen(path); end > there; end--)
        if (!path[end] || path[end] == '/') {
            path[end] = '\0';
            rmdir(path); // not where others have put something there
        }
}
