// What launchdyn calls that the C library of Windows (msvcrt) has not, or has for files by names in UTF-8 not; included
// before every source of an FMU's binary for Windows.
#ifndef LD_WIN64_H
#define LD_WIN64_H

#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// At a multiple of 16 bytes, as malloc() gives memory: nothing wider is loaded at once without AVX. Freed by free().
void *aligned_alloc(size_t alignment, size_t size);
char *strndup(const char *text, size_t size);
char *realpath(const char *path, char *resolved); // of what is there; no link is followed

// The locale of this thread, as far as launchdyn uses it: to C and back, in pairs.
typedef struct win64_locale *locale_t;
#define LC_ALL_MASK 0
locale_t newlocale(int mask, const char *name, locale_t base);
locale_t uselocale(locale_t to);

// Files by names in UTF-8; "/C:/folder", as the location of an FMU's resources has it, is "C:/folder".
FILE *win64_fopen(const char *path, const char *mode);
int win64_stat(const char *path, struct stat *to);
#define fopen win64_fopen
#define stat(path, to) win64_stat(path, to)

// Code for AVX2 is left out: gcc for Windows keeps vectors of 32 bytes on stacks that are aligned to 16.
#ifdef WIN64_PLAIN
#undef __x86_64__
#endif

#endif
