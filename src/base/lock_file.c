#include "base/lock_file.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

// Locks of this process, each a descriptor + 1; 0: a free place. A process that is forked would
// hold them too, beyond the end of this one: it closes them. Those beyond the places are not
// closed.
enum { PLACES = 64 };
static atomic_int held[PLACES];

static void close_in_child(void)
{
    for (int i = 0; i < PLACES; i++)
        if (held[i] > 0) {
            close(held[i] - 1);
            held[i] = 0;
        }
}

static void watch_forks(void)
{
    pthread_atfork(NULL, NULL, close_in_child);
}

// Puts `now` in the place of `before`.
static void note(int before, int now)
{
    int expected = before;
    for (int i = 0; i < PLACES; i++, expected = before)
        if (atomic_compare_exchange_strong(&held[i], &expected, now))
            return;
}

// Whether the locked file still has this name: its last holder may have removed it.
static bool is_in_place(int lock, const char *name)
{
    struct stat locked, there;
    return fstat(lock, &locked) == 0 && stat(name, &there) == 0 && locked.st_dev == there.st_dev &&
           locked.st_ino == there.st_ino;
}

static ld_status cannot_lock(const char *name, const char *guarded, int number, ld_error *error)
{
    if (number == EWOULDBLOCK)
        return ld_fail(
            error, LD_ERR_INPUT,
            "another launchdyn process uses %s: wait until it ends, or use another folder",
            guarded);
    bool none = number == ENOSYS || number == ENOLCK || number == EOPNOTSUPP;
    if (none)
        unlink(name);
    return ld_fail(error, none ? LD_ERR_MISSING : LD_ERR_FILE, "cannot lock %s: %s", name,
                   strerror(number));
}

ld_status lock_file_try(const char *name, const char *guarded, int *lock, ld_error *error)
{
    *lock = open(name, O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (*lock < 0)
        return ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", name, strerror(errno));
    int number = flock(*lock, LOCK_EX | LOCK_NB) != 0 ? errno : 0;
    if (!number && !is_in_place(*lock, name))
        number = EWOULDBLOCK; // it is another's now
    if (!number) {
        static pthread_once_t once = PTHREAD_ONCE_INIT;
        pthread_once(&once, watch_forks);
        note(0, *lock + 1);
        return LD_OK;
    }
    close(*lock);
    *lock = -1;
    return cannot_lock(name, guarded, number, error);
}

// Counts tries, not seconds: a slow machine has no fewer of them.
ld_status lock_file_take(const char *name, const char *guarded, int *lock, ld_error *error)
{
    enum { TRIES = 100 };
    const struct timespec pause = {.tv_nsec = 20000000};
    ld_status status = lock_file_try(name, guarded, lock, error);
    for (int i = 0; i < TRIES && status == LD_ERR_INPUT; i++) {
        nanosleep(&pause, NULL);
        status = lock_file_try(name, guarded, lock, error);
    }
    return status;
}

void lock_file_release(int lock)
{
    if (lock < 0)
        return;
    note(lock + 1, 0);
    flock(lock, LOCK_UN); // where a descriptor of another process is the same lock
    close(lock);
}

void lock_file_remove(const char *name, int lock)
{
    if (lock < 0)
        return;
    unlink(name);
    lock_file_release(lock);
}
