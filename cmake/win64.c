#include "win64.h"

#include <errno.h>
#include <stdbool.h>
#include <wchar.h>

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

enum { NAME_SIZE = 64 };

void *aligned_alloc(size_t alignment, size_t size)
{
    (void)alignment;
    return malloc(size);
}

char *strndup(const char *text, size_t size)
{
    size_t length = strnlen(text, size);
    char *copy = malloc(length + 1);
    if (copy) {
        memcpy(copy, text, length);
        copy[length] = '\0';
    }
    return copy;
}

// ---- the locale

struct win64_locale {
    int before; // whether this thread had a locale of its own
    char name[NAME_SIZE];
};

locale_t newlocale(int mask, const char *name, locale_t base)
{
    (void)mask, (void)name, (void)base;
    return NULL;
}

// To C with NULL: what was before is remembered. Back with that, which is freed. Without memory the locale stays.
locale_t uselocale(locale_t to)
{
    if (to) {
        setlocale(LC_ALL, to->name);
        _configthreadlocale(to->before);
        free(to);
        return NULL;
    }
    locale_t now = malloc(sizeof *now);
    const char *name = setlocale(LC_ALL, NULL);
    if (!now || !name || strlen(name) >= NAME_SIZE) {
        free(now);
        return NULL;
    }
    strcpy(now->name, name);
    now->before = _configthreadlocale(_ENABLE_PER_THREAD_LOCALE);
    setlocale(LC_ALL, "C");
    return now;
}

// ---- files

// In UTF-16, to be freed; NULL: no memory, or no UTF-8.
static wchar_t *wide_path(const char *path)
{
    bool drive = path[0] == '/' && path[1] && path[2] == ':';
    path += drive;
    int count = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, NULL, 0);
    wchar_t *wide = count > 0 ? malloc((size_t)count * sizeof *wide) : NULL;
    if (wide)
        MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, count);
    else
        errno = count > 0 ? ENOMEM : ENOENT;
    return wide;
}

FILE *win64_fopen(const char *path, const char *mode)
{
    wchar_t *wide = wide_path(path), wide_mode[8];
    mbstowcs(wide_mode, mode, 8);
    FILE *file = wide ? _wfopen(wide, wide_mode) : NULL;
    free(wide);
    return file;
}

int win64_stat(const char *path, struct stat *to)
{
    struct _stat64 found;
    wchar_t *wide = wide_path(path);
    int result = wide ? _wstat64(wide, &found) : -1;
    free(wide);
    if (!result)
        *to = (struct stat){.st_mode = found.st_mode, .st_size = found.st_size};
    return result;
}

char *realpath(const char *path, char *resolved)
{
    struct stat about;
    return win64_stat(path, &about) ? NULL : _fullpath(resolved, path, 0);
}
