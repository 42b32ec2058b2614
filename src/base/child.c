#include "base/child.h"

#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/lock_file.h"

enum { LONGEST = 4096, MOST_WRITTEN = 16 };

// In memory that parent and child share.
typedef struct child_work {
    bool done; // the work has come to its end
    char read[LONGEST];
    char written[MOST_WRITTEN][LONGEST]; // "": free
    char lock[LONGEST];                  // that guards them; "": none
} child_work;

static child_work *at_work; // of the child that this process is; NULL: it is none

// ---- in the child ----

void child_reads(const char *path)
{
    if (at_work)
        snprintf(at_work->read, LONGEST, "%s", path ? path : "");
}

static void replace(const char *path, const char *by)
{
    for (int i = 0; at_work && i < MOST_WRITTEN; i++)
        if (strcmp(at_work->written[i], path) == 0) {
            snprintf(at_work->written[i], LONGEST, "%s", by);
            return;
        }
}

void child_writes(const char *path)
{
    replace("", path);
}

void child_wrote(const char *path)
{
    replace(path, "");
}

void child_locks(const char *path)
{
    if (at_work)
        snprintf(at_work->lock, LONGEST, "%s", path ? path : "");
}

// ---- in the parent ----

static bool asks_to_end(int number)
{
    return number == SIGHUP || number == SIGINT || number == SIGTERM;
}

// The signals that are waited for: the child's end, and those to be handed on, also where this
// process ignores them, for the child may not.
static void fill_waited(sigset_t *set)
{
    static const int numbers[] = {SIGCHLD, SIGHUP, SIGINT, SIGTERM};
    sigemptyset(set);
    for (int i = 0; i < 4; i++)
        sigaddset(set, numbers[i]);
}

// Returns the child's status for wait(). What a terminal sends has reached the child, too.
static int wait_for(pid_t child, const sigset_t *waited)
{
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        siginfo_t about;
        int number = sigwaitinfo(waited, &about);
        if (number > 0 && asks_to_end(number) && about.si_code <= 0)
            sigqueue(child, number, (union sigval){0});
    }
    return status;
}

static ld_status fail_by_signal(const child_work *work, int number, ld_error *error)
{
    const char *written = work->written[0];
    if (*work->read) // what it writes beside is not foreign
        return ld_fail(
            error, LD_ERR_FILE,
            "ended by signal %d (%s) while reading %.400s: the file is damaged, or memory ran out",
            number, strsignal(number), work->read);
    return ld_fail(error, LD_ERR_FILE, "ended by signal %d (%s)%s%.400s", number, strsignal(number),
                   *written ? " while writing " : "", written);
}

// Removes what the child has left, unless another process has taken its lock since: then that has
// done so, and what lies there now is its own.
static void clear_up(const child_work *work)
{
    int lock = -1;
    if (*work->lock && lock_file_try(work->lock, "", &lock, NULL) == LD_ERR_INPUT)
        return;
    for (int i = 0; i < MOST_WRITTEN; i++)
        if (*work->written[i])
            unlink(work->written[i]);
    lock_file_remove(work->lock, lock);
}

static ld_status judge_status(const child_work *work, int status, int *code, ld_error *error)
{
    *code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (WIFEXITED(status) && work->done)
        return LD_OK;
    clear_up(work);
    if (WIFEXITED(status))
        return ld_fail(error, LD_ERR_FILE,
                       "a library ended the process (code %d); memory may have run out", *code);
    return asks_to_end(WTERMSIG(status)) ? LD_OK : fail_by_signal(work, WTERMSIG(status), error);
}

// ---- both ----

// Starts the child, which does not come back from here.
static pid_t start(int (*work)(void *data), void *data, child_work *shared, const sigset_t *before)
{
    fflush(NULL);
    pid_t parent = getpid(), child = fork();
    if (child != 0)
        return child;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(0);
    at_work = shared;
    sigprocmask(SIG_SETMASK, before, NULL);
    int code = work(data);
    shared->done = true;
    exit(code);
}

ld_status ld_child_run(int (*work)(void *data), void *data, int *code, ld_error *error)
{
    sigset_t waited, before;
    struct sigaction usual = {.sa_handler = SIG_DFL}, of_children;
    child_work *shared =
        mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED)
        return ld_fail(error, LD_ERR_MEMORY, "no memory to start a process");
    fill_waited(&waited);
    sigprocmask(SIG_BLOCK, &waited, &before);
    sigaction(SIGCHLD, &usual, &of_children);
    pid_t child = start(work, data, shared, &before);
    int number = errno;
    ld_status status =
        child > 0 ? judge_status(shared, wait_for(child, &waited), code, error)
                  : ld_fail(error, LD_ERR_MISSING, "cannot start a process: %s", strerror(number));
    while (sigtimedwait(&waited, NULL, &(struct timespec){0}) > 0)
        ; // what the child has had, too
    sigaction(SIGCHLD, &of_children, NULL);
    sigprocmask(SIG_SETMASK, &before, NULL);
    munmap(shared, sizeof *shared);
    return status;
}
