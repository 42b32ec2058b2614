// What glibc 2.28 calls otherwise than the one in whose headers this was compiled; linked into what is to load there.
#define _GNU_SOURCE
#include <errno.h>
#include <sys/random.h>
#include <sys/stat.h>

enum { STAT_VERSION = 1 }; // of struct stat on x86-64, where struct stat64 is the same

int __xstat(int version, const char *path, void *to);
int __lxstat(int version, const char *path, void *to);
int __fxstat(int version, int file, void *to);

int stat(const char *path, struct stat *to)
{
    return __xstat(STAT_VERSION, path, to);
}

int stat64(const char *path, struct stat64 *to)
{
    return __xstat(STAT_VERSION, path, to);
}

int lstat(const char *path, struct stat *to)
{
    return __lxstat(STAT_VERSION, path, to);
}

int lstat64(const char *path, struct stat64 *to)
{
    return __lxstat(STAT_VERSION, path, to);
}

int fstat(int file, struct stat *to)
{
    return __fxstat(STAT_VERSION, file, to);
}

int fstat64(int file, struct stat64 *to)
{
    return __fxstat(STAT_VERSION, file, to);
}

// Expat takes the seed of its tables from it; without random bytes they stay as they are.
void arc4random_buf(void *to, size_t size);
void arc4random_buf(void *to, size_t size)
{
    unsigned char *at = to;
    while (size > 0) {
        ssize_t got = getrandom(at, size, 0);
        if (got < 0 && errno != EINTR)
            return;
        at += got > 0 ? got : 0;
        size -= got > 0 ? (size_t)got : 0;
    }
}
