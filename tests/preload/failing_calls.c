// Preloaded into a program, lets calls of one kind fail, the n-th since its main began, or all from
// that one on; its children by fork count with it, programs that it starts are left alone.
//
// By the environment: FAIL_KIND, one of the names below (none: nothing fails); FAIL_AT, the first
// call that fails; FAIL_ON, if set: all after it, too; FAIL_ERROR, the error number, or "wait": the
// call does not come back; FAIL_LOG, a
// file: of the call that fails, its stack, and, behind a line "crash", that of a signal which ends
// the program; where nothing fails, a line "KIND N" for the first call of each kind from each
// stack.
//
// The processor time is always 0, so that results can be compared by their bytes.
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

typedef enum kind {
    MEMORY,  // malloc, calloc, realloc and their kin; also those of the C library for itself
    OPENING, // open, and a stream's: fopen, tmpfile
    READ,    // read, pread, and what a stream reads
    WRITE,   // write, pwrite, writev, and what a stream writes
    SYNC,    // fsync, fdatasync
    RENAME,  // rename, link
    REMOVE,  // unlink, rmdir
    MAP,     // mmap
    THREAD,  // pthread_create
    PROCESS, // fork, posix_spawn
    FOLDER,  // mkdir
    LENGTH,  // ftruncate
    CLOSE,   // close, and a stream's
    LOCK,    // flock
    KINDS
} kind;

static const char *const kind_names[KINDS] = {"memory", "open",   "read",  "write",  "sync",
                                              "rename", "remove", "map",   "thread", "process",
                                              "folder", "length", "close", "lock"};

enum { MOST_WAYS = 1 << 15 };

static struct {
    kind kind;
    bool on, waits;
    int error;
    long at;
    int log;
    // shared with children by fork
    struct shared {
        atomic_long calls[KINDS];
        atomic_bool told;
        uint64_t way[MOST_WAYS]; // hashes of stacks
    } * shared;
    atomic_bool counts; // since main began
} self = {.kind = KINDS, .log = -1};

static _Thread_local bool busy __attribute__((tls_model("initial-exec")));

#define NEXT(name) (__extension__(__typeof__(&name)) next(#name))

static void *next(const char *name)
{
    bool before = busy;
    busy = true; // it may ask for memory
    void *found = dlsym(RTLD_NEXT, name);
    busy = before;
    return found;
}

enum { DEEPEST = 64 };

static void log_stack(void)
{
    void *frame[DEEPEST];
    if (!atomic_exchange(&self.shared->told, true))
        backtrace_symbols_fd(frame, backtrace(frame, DEEPEST), self.log);
}

// Where the program is ended by a fault of its own.
static void log_crash(int number)
{
    void *frame[DEEPEST];
    dprintf(self.log, "crash\n");
    backtrace_symbols_fd(frame, backtrace(frame, DEEPEST), self.log);
    signal(number, SIG_DFL);
    raise(number);
}

static void log_crashes(void)
{
    static const int numbers[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    static char own[1 << 16]; // the program's stack may be full
    const struct sigaction act = {.sa_handler = log_crash, .sa_flags = SA_NODEFER | SA_ONSTACK};
    sigaltstack(&(stack_t){.ss_sp = own, .ss_size = sizeof own}, NULL);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        sigaction(numbers[i], &act, NULL);
}

// Logs the call if none of its kind came from this stack before.
static void log_way(kind of, long call)
{
    void *frame[DEEPEST];
    uint64_t hash = 14695981039346656037u ^ of;
    for (int i = 0, depth = backtrace(frame, DEEPEST); i < depth; i++)
        hash = (hash ^ (uintptr_t)frame[i]) * 1099511628211u;
    uint64_t *way = self.shared->way, place = hash % MOST_WAYS;
    while (way[place] != 0 && way[place] != hash)
        place = (place + 1) % MOST_WAYS;
    if (way[place] != hash)
        dprintf(self.log, "%s %ld\n", kind_names[of], call);
    way[place] = hash;
}

// Whether this call is one that fails; then errno is set.
static bool fails(kind of)
{
    if (busy || !self.counts)
        return false;
    long call = ++self.shared->calls[of];
    bool bad = of == self.kind && (self.on ? call >= self.at : call == self.at);
    busy = true;
    if (self.log >= 0 && bad)
        log_stack();
    else if (self.log >= 0 && self.kind == KINDS)
        log_way(of, call);
    busy = false;
    while (bad && self.waits)
        pause();
    if (bad)
        errno = self.error;
    return bad;
}

#define PASS(of, type, failed, name, parameters, arguments)                                        \
    type name parameters;                                                                          \
    type name parameters                                                                           \
    {                                                                                              \
        return fails(of) ? failed : NEXT(name) arguments;                                          \
    }

// ---- memory: by the C library's inner names, for a look-up asks for memory itself

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

void *malloc(size_t size)
{
    return fails(MEMORY) ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails(MEMORY) ? NULL : __libc_calloc(count, size);
}

void *realloc(void *old, size_t size)
{
    return fails(MEMORY) ? NULL : __libc_realloc(old, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return fails(MEMORY) ? NULL : __libc_memalign(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size)
{
    void *found = aligned_alloc(alignment, size);
    if (!found)
        return ENOMEM;
    *block = found;
    return 0;
}

// ---- files

static int open_at(int folder, const char *path, int flags, va_list more)
{
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    return fails(OPENING) ? -1 : NEXT(openat)(folder, path, flags, mode);
}

#define OPEN(name)                                                                                 \
    int name(const char *path, int flags, ...);                                                    \
    int name(const char *path, int flags, ...)                                                     \
    {                                                                                              \
        va_list more;                                                                              \
        va_start(more, flags);                                                                     \
        return open_at(AT_FDCWD, path, flags, more);                                               \
    }
OPEN(open)
OPEN(open64)

PASS(READ, ssize_t, -1, read, (int file, void *bytes, size_t size), (file, bytes, size))
PASS(READ, ssize_t, -1, pread, (int file, void *bytes, size_t size, off_t at),
     (file, bytes, size, at))
PASS(READ, ssize_t, -1, pread64, (int file, void *bytes, size_t size, off64_t at),
     (file, bytes, size, at))
PASS(WRITE, ssize_t, -1, write, (int file, const void *bytes, size_t size), (file, bytes, size))
PASS(WRITE, ssize_t, -1, pwrite, (int file, const void *bytes, size_t size, off_t at),
     (file, bytes, size, at))
PASS(WRITE, ssize_t, -1, pwrite64, (int file, const void *bytes, size_t size, off64_t at),
     (file, bytes, size, at))
PASS(SYNC, int, -1, fsync, (int file), (file))
PASS(SYNC, int, -1, fdatasync, (int file), (file))
PASS(RENAME, int, -1, rename, (const char *from, const char *to), (from, to))
PASS(REMOVE, int, -1, unlink, (const char *path), (path))
PASS(REMOVE, int, -1, rmdir, (const char *path), (path))
PASS(LOCK, int, -1, flock, (int file, int operation), (file, operation))
PASS(FOLDER, int, -1, mkdir, (const char *path, mode_t mode), (path, mode))
PASS(LENGTH, int, -1, ftruncate, (int file, off_t length), (file, length))
PASS(LENGTH, int, -1, ftruncate64, (int file, off64_t length), (file, length))
PASS(MAP, void *, MAP_FAILED, mmap,
     (void *where, size_t size, int protection, int flags, int file, off_t at),
     (where, size, protection, flags, file, at))
PASS(MAP, void *, MAP_FAILED, mmap64,
     (void *where, size_t size, int protection, int flags, int file, off64_t at),
     (where, size, protection, flags, file, at))
PASS(LENGTH, int, -1, fallocate, (int file, int mode, off_t at, off_t size), (file, mode, at, size))

void *mremap(void *old, size_t size, size_t larger, int flags, ...)
{
    return fails(MAP) ? MAP_FAILED : NEXT(mremap)(old, size, larger, flags);
}

int posix_fallocate(int file, off_t at, off_t size)
{
    return fails(LENGTH) ? errno : NEXT(posix_fallocate)(file, at, size);
}

// A file is closed and says that what was written has not come through.
int close(int file)
{
    bool bad = fails(CLOSE);
    int problem = errno, result = NEXT(close)(file);
    errno = bad ? problem : errno;
    return bad ? -1 : result;
}

// ---- streams: over the calls above, since the C library's own do not go by them

static ssize_t stream_read(void *file, char *bytes, size_t size)
{
    return read((int)(intptr_t)file, bytes, size);
}

static ssize_t stream_write(void *file, const char *bytes, size_t size)
{
    ssize_t written = write((int)(intptr_t)file, bytes, size);
    return written < 0 ? 0 : written;
}

static int stream_seek(void *file, off64_t *offset, int whence)
{
    *offset = lseek64((int)(intptr_t)file, *offset, whence);
    return *offset < 0 ? -1 : 0;
}

enum { MOST_STREAMS = 32 };
static FILE *streams[MOST_STREAMS]; // by descriptor

static int stream_close(void *file)
{
    streams[(intptr_t)file % MOST_STREAMS] = NULL;
    return close((int)(intptr_t)file);
}

FILE *fdopen(int file, const char *mode)
{
    static const cookie_io_functions_t calls = {stream_read, stream_write, stream_seek,
                                                stream_close};
    FILE *stream = file < MOST_STREAMS ? fopencookie((void *)(intptr_t)file, mode, calls) : NULL;
    if (stream)
        streams[file] = stream;
    return stream;
}

int fileno(FILE *stream)
{
    for (int i = 0; i < MOST_STREAMS; i++)
        if (streams[i] == stream)
            return i;
    return NEXT(fileno)(stream);
}

FILE *fopen(const char *path, const char *mode)
{
    int way = strchr(mode, '+') ? O_RDWR : mode[0] == 'r' ? O_RDONLY : O_WRONLY;
    int make = mode[0] == 'w' ? O_CREAT | O_TRUNC : mode[0] == 'a' ? O_CREAT | O_APPEND : 0;
    void *volatile room =
        malloc(sizeof(FILE)); // first, as the C library does: no file is made without
    free(room);
    int file = room ? open(path, way | make | (strchr(mode, 'e') ? O_CLOEXEC : 0), 0666) : -1;
    busy = true;
    FILE *stream = file < 0 ? NULL : fdopen(file, mode);
    busy = false;
    return stream;
}

FILE *fopen64(const char *path, const char *mode);
FILE *fopen64(const char *path, const char *mode)
{
    return fopen(path, mode);
}

FILE *tmpfile(void)
{
    int file = open("/tmp", O_TMPFILE | O_RDWR | O_EXCL, 0600);
    return file < 0 ? NULL : fdopen(file, "w+");
}

FILE *tmpfile64(void);
FILE *tmpfile64(void)
{
    return tmpfile();
}

// ---- threads and processes

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                   void *data)
{
    return fails(THREAD) ? errno : NEXT(pthread_create)(thread, attributes, run, data);
}

PASS(PROCESS, pid_t, -1, fork, (void), ())

int posix_spawnp(pid_t *child, const char *file, const posix_spawn_file_actions_t *actions,
                 const posix_spawnattr_t *attributes, char *const words[], char *const variables[])
{
    if (fails(PROCESS))
        return errno;
    return NEXT(posix_spawnp)(child, file, actions, attributes, words, variables);
}

clock_t clock(void)
{
    return 0;
}

// ---- beginning

static long number_from(const char *name, long otherwise)
{
    const char *text = getenv(name);
    return text ? strtol(text, NULL, 10) : otherwise;
}

__attribute__((constructor)) static void begin(void)
{
    void *frame[1];
    const char *wanted = getenv("FAIL_KIND"), *log = getenv("FAIL_LOG"),
               *how = getenv("FAIL_ERROR");
    for (int i = 0; wanted && i < KINDS; i++)
        if (strcmp(wanted, kind_names[i]) == 0)
            self.kind = i;
    self.at = number_from("FAIL_AT", 0);
    self.error = (int)number_from("FAIL_ERROR", ENOMEM);
    self.waits = how && strcmp(how, "wait") == 0;
    self.on = getenv("FAIL_ON");
    self.log = log ? open(log, O_CREAT | O_WRONLY | O_TRUNC | O_APPEND | O_CLOEXEC, 0666) : -1;
    if (self.log >= 0) // out of the way of the program's own
        self.log = fcntl(self.log, F_DUPFD_CLOEXEC, 100);
    self.shared =
        mmap(NULL, sizeof *self.shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    backtrace(frame, 1); // loads what it needs
    if (self.log >= 0)
        log_crashes();
    unsetenv("LD_PRELOAD");
}

static int (*real_main)(int, char **, char **);

static int counted_main(int count, char **words, char **variables)
{
    stdout = fdopen(STDOUT_FILENO, "w");
    self.counts = true;
    return real_main(count, words, variables);
}

int __libc_start_main(int (*main)(int, char **, char **), int count, char **words,
                      void (*init)(void), void (*fini)(void), void (*rtld_fini)(void), void *stack);
int __libc_start_main(int (*main)(int, char **, char **), int count, char **words,
                      void (*init)(void), void (*fini)(void), void (*rtld_fini)(void), void *stack)
{
    real_main = main;
    return NEXT(__libc_start_main)(counted_main, count, words, init, fini, rtld_fini, stack);
}
