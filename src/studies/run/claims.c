#include "studies/run/claims.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static ld_status cannot(const char *what, const char *path, int number, ld_error *error)
{
    return ld_fail(error, LD_ERR_FILE, "cannot %s %s: %s", what, path, strerror(number));
}

static void path_of(const study_claims *self, const char *name, char path[CLAIMS_NAME])
{
    snprintf(path, CLAIMS_NAME, "%s/%s", self->folder, name);
}

static double seconds(const struct timespec *time)
{
    return (double)time->tv_sec + 1e-9 * (double)time->tv_nsec;
}

// What is known of a file. It is opened: on NFS that asks the server, where stat() may say what was
// a minute ago.
static bool look_at(const char *path, struct stat *about)
{
    int file = open(path, O_RDONLY | O_CLOEXEC);
    bool good = file >= 0 && fstat(file, about) == 0;
    if (file >= 0)
        close(file);
    return good;
}

// ---- the file of this process

static ld_status make_folder(const study_claims *self, ld_error *error)
{
    if (mkdir(self->folder, 0777) == 0 || errno == EEXIST)
        return LD_OK;
    return cannot("make", self->folder, errno, error);
}

// The folder may go away just now: the study of others is complete.
static ld_status make_mine(study_claims *self, ld_error *error)
{
    char path[CLAIMS_NAME];
    int file = -1, problem = 0;
    path_of(self, self->me, path);
    for (int tries = 0; tries < 10 && file < 0; tries++) {
        ld_status status = make_folder(self, error);
        if (status)
            return status;
        file = open(path, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
        problem = file < 0 ? errno : 0;
        if (problem && problem != ENOENT)
            break;
    }
    if (file < 0 || close(file) != 0)
        return cannot("write", path, problem ? problem : errno, error);
    return LD_OK;
}

ld_status claims_open(study_claims *self, const char *folder, double expiry, ld_error *error)
{
    char host[64] = "";
    bool there;
    struct timespec time;
    *self = (study_claims){.expiry = expiry};
    if (strlen(folder) + 64 > sizeof self->folder)
        return ld_fail(error, LD_ERR_INPUT, "the name of the folder is too long");
    snprintf(self->folder, sizeof self->folder, "%s/ranges", folder);
    gethostname(host, sizeof host - 1);
    clock_gettime(CLOCK_REALTIME, &time); // tells apart those whose numbers are the same
    snprintf(self->me, sizeof self->me, "worker-%s-%d-%" PRIx64, host, (int)getpid(),
             (uint64_t)time.tv_sec << 30 ^ (uint64_t)time.tv_nsec);
    ld_status status = make_mine(self, error);
    if (!status)
        status = claims_renew(self, &there, error);
    self->begun = self->now;
    return status;
}

ld_status claims_renew(study_claims *self, bool *there, ld_error *error)
{
    char path[CLAIMS_NAME];
    struct stat about;
    path_of(self, self->me, path);
    *there = utimensat(AT_FDCWD, path, NULL, 0) == 0 && look_at(path, &about);
    if (*there)
        self->now = seconds(&about.st_mtim);
    else if (errno != ENOENT && errno != ESTALE)
        return cannot("write", path, errno, error);
    return LD_OK;
}

// Names that are listed, apart from the folder's own.
static const char *next_name(DIR *list)
{
    const struct dirent *entry;
    while ((entry = readdir(list)) && entry->d_name[0] == '.')
        ;
    return entry ? entry->d_name : NULL;
}

static void remove_all(const study_claims *self)
{
    char path[CLAIMS_NAME];
    const char *name;
    DIR *list = opendir(self->folder);
    while (list && (name = next_name(list))) {
        path_of(self, name, path);
        unlink(path);
    }
    if (list)
        closedir(list);
}

void claims_close(study_claims *self, bool last)
{
    char path[CLAIMS_NAME];
    if (!self->me[0])
        return;
    path_of(self, self->me, path);
    unlink(path);
    if (last)
        remove_all(self);
    rmdir(self->folder); // where it is empty
    self->me[0] = '\0';
}

// ---- ranges

static bool ends_in(const char *name, const char *ending)
{
    size_t length = strlen(name), end = strlen(ending);
    return length >= end && strcmp(name + length - end, ending) == 0;
}

ld_status claims_list(const study_claims *self, claim_kind *kind, int count, ld_error *error)
{
    DIR *list = opendir(self->folder);
    if (!list && errno == ENOENT)
        return LD_OK;
    if (!list)
        return cannot("read", self->folder, errno, error);
    const char *name;
    while ((name = next_name(list))) {
        int range = -1, length = 0;
        if (sscanf(name, "%d%n", &range, &length) != 1 || range < 0 || range >= count)
            continue;
        if (strcmp(name + length, ".part") == 0)
            kind[range] = CLAIM_PART;
        else if (strcmp(name + length, ".taken") == 0 && kind[range] == CLAIM_NONE)
            kind[range] = CLAIM_TAKEN;
    }
    closedir(list);
    return LD_OK;
}

static void path_of_range(const study_claims *self, int range, const char *ending,
                          char path[CLAIMS_NAME])
{
    snprintf(path, CLAIMS_NAME, "%s/%06d.%s", self->folder, range, ending);
}

// Whether the claim is that of this process, whatever link() has said: the answer may be lost and
// the request repeated.
static bool is_mine(const char *claim, const char *mine)
{
    struct stat one, other;
    return look_at(claim, &one) && look_at(mine, &other) && one.st_ino == other.st_ino &&
           one.st_dev == other.st_dev;
}

// Takes a claim away whose process has given no sign of life. Two that do so at once may both run
// the range.
static bool remove_dead(const study_claims *self, const char *claim)
{
    struct stat about;
    char away[CLAIMS_NAME + 8];
    if (!look_at(claim, &about) || self->now - seconds(&about.st_mtim) < self->expiry)
        return false;
    snprintf(away, sizeof away, "%s/%s.dead", self->folder, self->me);
    bool removed = rename(claim, away) == 0;
    unlink(away);
    return removed;
}

ld_status claims_take(const study_claims *self, int range, bool *taken, ld_error *error)
{
    char claim[CLAIMS_NAME], mine[CLAIMS_NAME];
    path_of_range(self, range, "taken", claim);
    path_of(self, self->me, mine);
    *taken = link(mine, claim) == 0;
    int problem = *taken ? 0 : errno;
    if (problem == EEXIST) {
        *taken = is_mine(claim, mine) || (remove_dead(self, claim) && link(mine, claim) == 0);
        return LD_OK;
    }
    if (problem == EPERM || problem == EOPNOTSUPP || problem == ENOSYS)
        return ld_fail(error, LD_ERR_MISSING,
                       "the file system of %s has no hard links, by which processes share a "
                       "study: run shards, or launchdyn-mpi",
                       self->folder);
    return problem && problem != ENOENT && problem != ESTALE
               ? cannot("write", claim, problem, error)
               : LD_OK;
}

bool claims_has_part(const study_claims *self, int range)
{
    char part[CLAIMS_NAME];
    struct stat about;
    path_of_range(self, range, "part", part);
    return look_at(part, &about);
}

void claims_release(const study_claims *self, int range)
{
    char claim[CLAIMS_NAME], mine[CLAIMS_NAME];
    path_of_range(self, range, "taken", claim);
    path_of(self, self->me, mine);
    if (is_mine(claim, mine))
        unlink(claim);
}

// ---- files

static int write_file(const char *path, const void *bytes, size_t size)
{
    int file = open(path, O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666), problem = 0;
    if (file < 0)
        return errno;
    const char *next = bytes;
    while (size > 0 && !problem) {
        ssize_t written = write(file, next, size);
        if (written < 0 && errno != EINTR)
            problem = errno;
        else if (written > 0) {
            next += written;
            size -= (size_t)written;
        }
    }
    if (close(file) != 0 && !problem)
        problem = errno;
    return problem;
}

ld_status claims_write(const study_claims *self, const char *name, const void *bytes, size_t size,
                       ld_error *error)
{
    char path[CLAIMS_NAME], made[2 * CLAIMS_NAME];
    path_of(self, name, path);
    // threads write different files at once
    snprintf(made, sizeof made, "%s/%s.%s.new", self->folder, self->me, name);
    int problem = write_file(made, bytes, size);
    if (!problem && rename(made, path) != 0)
        problem = errno;
    if (!problem)
        return LD_OK;
    unlink(made);
    // the folder goes with the study that others have completed
    return problem == ENOENT || problem == ESTALE ? LD_OK : cannot("write", path, problem, error);
}

ld_status claims_put_part(const study_claims *self, int range, bool whole, const study_part *part,
                          ld_error *error)
{
    char name[CLAIMS_NAME];
    snprintf(name, sizeof name, "%s%s%06d.part", whole ? "" : self->me, whole ? "" : "-", range);
    return claims_write(self, name, part->bytes, part->size, error);
}

static char *read_file(const char *path, size_t *size, double *time)
{
    struct stat about;
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return NULL;
    char *bytes = fstat(file, &about) == 0 ? malloc((size_t)about.st_size + 1) : NULL;
    *size = 0;
    while (bytes && *size < (size_t)about.st_size) {
        ssize_t got = read(file, bytes + *size, (size_t)about.st_size - *size);
        if (got <= 0)
            break;
        *size += (size_t)got;
    }
    close(file);
    if (bytes)
        bytes[*size] = '\0';
    *time = bytes ? seconds(&about.st_mtim) : 0;
    return bytes;
}

void claims_remove(const study_claims *self, const char *name)
{
    char path[CLAIMS_NAME];
    path_of(self, name, path);
    if (self->me[0])
        unlink(path);
}

char *claims_read(const study_claims *self, const char *name, size_t *size, double *time)
{
    char path[CLAIMS_NAME];
    DIR *list = opendir(self->folder); // NFS then asks the server whether the name is there
    if (list)
        closedir(list);
    path_of(self, name, path);
    return read_file(path, size, time);
}

ld_status claims_parts_begin(claims_parts *self, const study_claims *claims, ld_error *error)
{
    *self = (claims_parts){.claims = claims, .folder = opendir(claims->folder)};
    return self->folder || errno == ENOENT ? LD_OK : cannot("read", claims->folder, errno, error);
}

bool claims_parts_next(claims_parts *self)
{
    const char *name;
    double time;
    free(self->bytes);
    self->bytes = NULL;
    while (self->folder && !self->bytes && (name = next_name(self->folder))) {
        if (!ends_in(name, ".part"))
            continue;
        path_of(self->claims, name, self->path);
        self->bytes = (unsigned char *)read_file(self->path, &self->size, &time);
    }
    return self->bytes != NULL;
}

void claims_parts_end(claims_parts *self)
{
    free(self->bytes);
    if (self->folder)
        closedir(self->folder);
    *self = (claims_parts){0};
}
