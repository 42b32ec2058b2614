#define _GNU_SOURCE // memfd_create; NOLINT(bugprone-reserved-identifier)
#include "foreign/process.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "foreign/host_inside.h"

struct foreign_process {
    const char *name;
    double limit; // [s]
    pid_t pid;
    int socket;
    bool lost; // it has failed, or ended
    foreign_shared *shared;
};

// ---- start

// The host program as a file that has no name. -1: it cannot be.
static int host_file(void)
{
    int file = memfd_create("launchdyn-fmu-host", MFD_CLOEXEC);
    size_t size = (size_t)(host_binary_end - host_binary);
    if (file >= 0 && write(file, host_binary, size) == (ssize_t)size)
        return file;
    if (file >= 0)
        close(file);
    return -1;
}

// In the child: nothing to read, nowhere to print, the socket and the shared memory in their
// places, other files not there.
static int set_files(posix_spawn_file_actions_t *actions, int socket, int shared)
{
    int wrong = posix_spawn_file_actions_addopen(actions, 0, "/dev/null", O_RDONLY, 0);
    wrong |= posix_spawn_file_actions_addopen(actions, 1, "/dev/null", O_WRONLY, 0);
    wrong |= posix_spawn_file_actions_addopen(actions, 2, "/dev/null", O_WRONLY, 0);
    wrong |= posix_spawn_file_actions_adddup2(actions, socket, FOREIGN_SOCKET);
    wrong |= posix_spawn_file_actions_adddup2(actions, shared, FOREIGN_SHARED);
    return wrong;
}

// A group of its own: what a terminal sends does not reach it; it ends with this process.
static int set_signals(posix_spawnattr_t *attributes)
{
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    int wrong = posix_spawnattr_setflags(
        attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    wrong |= posix_spawnattr_setpgroup(attributes, 0);
    wrong |= posix_spawnattr_setsigmask(attributes, &none);
    wrong |= posix_spawnattr_setsigdefault(attributes, &all);
    return wrong;
}

static int spawn(foreign_process *self, int host, int socket, int shared)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    char path[64], *const arguments[] = {"launchdyn-fmu-host", NULL};
    snprintf(path, sizeof path, "/proc/self/fd/%d", host);
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    int wrong = set_files(&actions, socket, shared);
    wrong = wrong ? wrong : set_signals(&attributes);
    wrong =
        wrong ? wrong : posix_spawn(&self->pid, path, &actions, &attributes, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    return wrong;
}

// A descriptor beyond those that the child requires in their places.
static int descriptor_beyond(int file)
{
    int moved = file >= 0 ? fcntl(file, F_DUPFD_CLOEXEC, 10) : -1;
    if (file >= 0)
        close(file);
    return moved;
}

static bool start(foreign_process *self)
{
    int pair[2] = {-1, -1};
    int host = descriptor_beyond(host_file()),
        shared = descriptor_beyond(memfd_create("launchdyn-fmu", MFD_CLOEXEC));
    bool good = host >= 0 && shared >= 0 && ftruncate(shared, sizeof *self->shared) == 0 &&
                socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) == 0;
    pair[1] = descriptor_beyond(pair[1]);
    self->socket = pair[0];
    void *memory = MAP_FAILED;
    if (good)
        memory = mmap(NULL, sizeof *self->shared, PROT_READ | PROT_WRITE, MAP_SHARED, shared, 0);
    self->shared = memory == MAP_FAILED ? NULL : memory;
    if (good && self->shared) {
        int wrong = spawn(self, host, pair[1], shared);
        good = wrong == 0;
        errno = wrong;
    }
    int number = errno, open[] = {host, shared, pair[1]};
    for (int i = 0; i < 3; i++)
        if (open[i] >= 0)
            close(open[i]);
    errno = number;
    return good && self->shared;
}

ld_status foreign_process_start(const char *name, double limit, foreign_process **out,
                                ld_error *error)
{
    foreign_process *self = calloc(1, sizeof *self);
    *out = NULL;
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for an FMU");
    *self = (foreign_process){.name = name, .limit = limit, .socket = -1};
    if (start(self)) {
        *out = self;
        return LD_OK;
    }
    ld_status status =
        ld_fail(error, LD_ERR_MISSING, "%.300s: cannot start a process for the FMU: %s", name,
                strerror(errno));
    self->pid = 0;
    foreign_process_end(self);
    return status;
}

// ---- what went wrong

// " in FUNCTION at t = T s"
static const char *place_text(const foreign_process *self, double t, char text[128])
{
    char function[sizeof self->shared->function];
    memcpy(function, self->shared->function, sizeof function);
    function[sizeof function - 1] = '\0';
    int length = snprintf(text, 128, " in %s", function);
    if (!isnan(t))
        snprintf(text + length, 128 - (size_t)length, " at t = %.9g s", t);
    return text;
}

// ": what it said last", or nothing.
static const char *last_words(const foreign_process *self, char text[FOREIGN_LONGEST_SAID + 4])
{
    char message[FOREIGN_LONGEST_SAID];
    memcpy(message, self->shared->said, sizeof message);
    message[sizeof message - 1] = '\0';
    size_t length = strlen(message);
    while (length && strchr(" \n\r\t.", message[length - 1]))
        message[--length] = '\0';
    snprintf(text, FOREIGN_LONGEST_SAID + 4, "%s%s", length ? ": " : "", message);
    return text;
}

static double now(void)
{
    struct timespec at;
    clock_gettime(CLOCK_MONOTONIC, &at);
    return (double)at.tv_sec + 1e-9 * (double)at.tv_nsec;
}

// With whatever it has started: they are a group.
static void end_now(foreign_process *self)
{
    kill(-self->pid, SIGKILL);
    waitpid(self->pid, NULL, 0);
    self->pid = 0;
}

// Waits for its end, which is near where the socket closed with it. False: it lives on without the
// socket, and has been ended.
static bool wait_for_end(foreign_process *self, int *status)
{
    const struct timespec pause = {.tv_nsec = 1000000};
    double until = now() + self->limit;
    pid_t ended;
    while ((ended = waitpid(self->pid, status, WNOHANG)) != self->pid) {
        if (self->shared->deaf || ended < 0 || now() > until) {
            end_now(self);
            return false;
        }
        nanosleep(&pause, NULL);
    }
    self->pid = 0;
    return true;
}

static ld_status fail_ended(foreign_process *self, double t, ld_error *error)
{
    char at[128], last[FOREIGN_LONGEST_SAID + 4];
    int status = 0;
    bool known = wait_for_end(self, &status);
    place_text(self, t, at);
    last_words(self, last);
    if (known && WIFSIGNALED(status))
        return ld_fail(error, LD_ERR_NUMERIC, "%.200s: the FMU ended with signal %d (%s)%s%s",
                       self->name, WTERMSIG(status), strsignal(WTERMSIG(status)), at, last);
    if (known && WIFEXITED(status))
        return ld_fail(error, LD_ERR_NUMERIC, "%.200s: the FMU ended itself (exit code %d)%s%s",
                       self->name, WEXITSTATUS(status), at, last);
    return ld_fail(error, LD_ERR_NUMERIC,
                   "%.200s: the FMU closed the connection to its process%s%s", self->name, at,
                   last);
}

static ld_status fail_timed_out(foreign_process *self, double t, ld_error *error)
{
    char at[128];
    return ld_fail(error, LD_ERR_NUMERIC,
                   "%.300s: the FMU did not return within %g s%s (base.time_limit)", self->name,
                   self->limit, place_text(self, t, at));
}

static ld_status fail_refused(foreign_process *self, foreign_result result, double t,
                              ld_error *error)
{
    char at[128], last[FOREIGN_LONGEST_SAID + 4];
    place_text(self, t, at);
    last_words(self, last);
    if (result == FOREIGN_MISSING)
        return ld_fail(error, LD_ERR_INPUT, "%.200s: its binary cannot be loaded%s", self->name,
                       last);
    const char *what = result == FOREIGN_ENDS      ? "the FMU requests the end of the simulation"
                       : result == FOREIGN_NO_STEP ? "the FMU refuses every step, however short,"
                                                   : "the FMU reports an error";
    return ld_fail(error, LD_ERR_NUMERIC, "%.200s: %s%s%s", self->name, what, at, last);
}

// ---- questions

typedef enum moved { MOVED, MOVED_LATE, MOVED_NOT } moved;

// Waits until the socket is ready. MOVED: it is.
static moved wait_for(const foreign_process *self, short events, double until)
{
    for (;;) {
        struct pollfd wait = {.fd = self->socket, .events = events};
        double left = fmin(until - now(), 1e6);
        int ready = left > 0 ? poll(&wait, 1, (int)ceil(1e3 * left)) : 0;
        if (ready == 0)
            return MOVED_LATE;
        if (ready > 0)
            return MOVED;
        if (errno != EINTR)
            return MOVED_NOT;
    }
}

// Whether it is to be tried again; else `count` of bytes have gone, or none ever will.
static bool is_retried(ssize_t count)
{
    return count < 0 && (errno == EAGAIN || errno == EINTR);
}

static moved send_all(const foreign_process *self, const char *bytes, size_t size, double until)
{
    for (size_t at = 0; at < size;) {
        moved ready = wait_for(self, POLLOUT, until);
        if (ready != MOVED)
            return ready;
        ssize_t count = send(self->socket, bytes + at, size - at, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count <= 0 && !is_retried(count))
            return MOVED_NOT;
        at += count > 0 ? (size_t)count : 0;
    }
    return MOVED;
}

static moved receive_all(const foreign_process *self, char *bytes, size_t size, double until)
{
    for (size_t at = 0; at < size;) {
        moved ready = wait_for(self, POLLIN, until);
        if (ready != MOVED)
            return ready;
        ssize_t count = recv(self->socket, bytes + at, size - at, MSG_DONTWAIT);
        if (count <= 0 && !is_retried(count))
            return MOVED_NOT;
        at += count > 0 ? (size_t)count : 0;
    }
    return MOVED;
}

static moved ask(const foreign_process *self, const foreign_question *question,
                 foreign_answer *head)
{
    const size_t *size = question->size;
    foreign_request request = {.kind = question->kind, .size = size[0] + size[1]};
    double until = now() + self->limit;
    moved result = send_all(self, (const char *)&request, sizeof request, until);
    for (int i = 0; i < 2 && result == MOVED; i++)
        result = send_all(self, question->body[i], size[i], until);
    return result == MOVED ? receive_all(self, (char *)head, sizeof *head, until) : result;
}

ld_status foreign_process_ask(foreign_process *self, const foreign_question *question,
                              foreign_reply *reply, ld_error *error)
{
    foreign_answer head = {0};
    double t = question->t;
    size_t room = reply->room;
    if (self->lost)
        return ld_fail(error, LD_ERR_NUMERIC, "%.300s: the FMU has ended", self->name);
    moved result = ask(self, question, &head);
    if (result == MOVED && head.result == FOREIGN_DONE && head.size <= room)
        result = receive_all(self, reply->bytes, head.size, now() + self->limit);
    self->lost = result != MOVED || head.result != FOREIGN_DONE || head.size > room;
    reply->size = head.size;
    if (result == MOVED_NOT)
        return fail_ended(self, t, error);
    if (result == MOVED_LATE)
        return fail_timed_out(self, t, error);
    if (head.result != FOREIGN_DONE)
        return fail_refused(self, (foreign_result)head.result, t, error);
    return self->lost ? ld_fail(error, LD_ERR_NUMERIC, "%.300s: the FMU's state requires %zu bytes",
                                self->name, head.size)
                      : LD_OK;
}

// ---- end

// The FMU may end on its own, in good time.
static void say_goodbye(foreign_process *self)
{
    foreign_answer head;
    const double limit = self->limit;
    self->limit = fmin(limit, 2);
    ask(self, &(foreign_question){.kind = FOREIGN_END}, &head);
    self->limit = limit;
}

void foreign_process_end(foreign_process *self)
{
    if (!self)
        return;
    if (self->pid > 0 && !self->lost)
        say_goodbye(self);
    if (self->pid > 0)
        end_now(self);
    if (self->socket >= 0)
        close(self->socket);
    if (self->shared)
        munmap(self->shared, sizeof *self->shared);
    free(self);
}
