// Calls of the system that fail: of each kind, over the commands, one call or all from one on. What
// must hold: a code that is not 0 after one sentence that names the cause, or no consequence; no
// signal; no file half-written under its own name; the same command then continues to the same
// files.
//
// Of all calls that come from the same stack the first one fails. LD_FAILING_CALLS: how many, of
// all there are, in a command (default 2), drawn by chance; 0: all of them. LD_FAILING_COMMAND:
// only in this one; LD_FAILING_KIND: only of this kind, or, behind a "-", of all but this one;
// LD_FAILING_EXAMPLE: of which example the scenario is made (fixed), LD_FAILING_STEP: with rows how
// far apart (10 ms). Not with sanitizers, which bring an allocator of their own.
// ctest: slow
#define _GNU_SOURCE
#include "support/shell.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdbool.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "base/random.h"

enum {
    INPUT = 2,
    SYSTEM = 3,
    MOST_FILES = 32,
    MOST_CALLS = 1 << 14,
    MOST_WORDS = 24,
    MOST_PATH = 160
};

// ---- the commands, each in a folder of its own

#define SCENARIO                                                                                   \
    "ln -s ../examples .; printf 'include: examples/%s.yaml\nrun: {end: tip, output_step: %s}\n"   \
    "scatter: {samples: 2, factors: {rocket.mass_error: {normal: 0.2 kg}}}\n' "                    \
    "${LD_FAILING_EXAMPLE:-fixed} \"${LD_FAILING_STEP:-10 ms}\" >s.yaml; "
#define RUN SCENARIO "../launchdyn run s.yaml --out o --quiet; "
#define STUDY SCENARIO "../launchdyn study s.yaml --out o --quiet; "

typedef struct verb {
    const char *name, *prepare, *line;
    const char *shown; // a command that prints what a folder holds whose files may be in the making
    const char *only;  // the one kind that is tried; NULL: all
} verb;

static const verb verbs[] = {
    {"check", SCENARIO, "check s.yaml", NULL, NULL},
    {"modes", SCENARIO, "modes s.yaml", NULL, NULL},
    {"response", SCENARIO, "response s.yaml --input base.y -w tip.y --out o", NULL, NULL},
    {"run", SCENARIO, "run s.yaml --out o --csv", NULL, NULL},
    {"run again", RUN, "run --again o --out p", NULL, NULL},
    {"plot", RUN, "plot o -o x.svg", NULL, NULL},
    {"report", RUN, "report o -o x.html", NULL, NULL},
    {"report of a study", STUDY, "report o -o x.html", NULL, NULL},
    {"study", SCENARIO, "study s.yaml --out o", "study show o --what all", NULL},
    {"study on threads", SCENARIO, "study s.yaml --out o --jobs 2", "study show o --what all",
     "thread"},
    {"study joined", SCENARIO, "study s.yaml --out o --join", "study show o --what all", "thread"},
    {"study show", STUDY, "study show o", NULL, NULL},
    {"study export", STUDY, "study export o --csv x.csv --hdf5 x.h5", NULL, NULL},
    {"study merge",
     SCENARIO "../launchdyn study s.yaml --out o --quiet --shard 1/2; "
              "../launchdyn study s.yaml --out o --quiet --shard 2/2; ",
     "study merge o", "study show o --what all", NULL},
};

enum { VERBS = sizeof verbs / sizeof *verbs };

// ---- the kinds of failures

typedef struct fault {
    const char *kind;
    int error;
    const char *told[4]; // beside the error's own text: what libraries make of it
} fault;

static const fault failures[] = {
    {"memory", ENOMEM, {"memory"}},
    {"open", EMFILE, {"unable to open", "disk I/O error"}},
    {"open", EACCES, {"unable to open", "readonly database", "disk I/O error"}},
    {"read", EIO, {"disk I/O error", "malformed", "damaged"}}, // SQLite takes it for that
    {"write", ENOSPC, {"disk is full"}},
    {"write", EIO, {"disk I/O error"}},
    {"sync", EIO, {"disk I/O error"}},
    {"rename", EIO, {NULL}},
    {"remove", EACCES, {"disk I/O error"}},
    {"map", ENOMEM, {"memory", "disk I/O error"}},
    {"thread", EAGAIN, {NULL}},
    {"process", EAGAIN, {NULL}},
    {"folder", ENOSPC, {NULL}},
    {"length", ENOSPC, {"disk is full", "disk I/O error"}},
    {"close", EIO, {"disk I/O error"}},
    {"lock", ENOLCK, {NULL}},
};

enum { FAILURES = sizeof failures / sizeof *failures };

// ---- what is in a folder

typedef struct file_mark {
    char path[MOST_PATH];
    uint64_t hash; // of what it holds
} file_mark;

typedef struct folder_mark {
    file_mark file[MOST_FILES];
    int count;
} folder_mark;

static uint64_t hash_file(const char *path)
{
    static char bytes[1 << 16];
    uint64_t hash = 14695981039346656037u;
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    for (size_t count; (count = fread(bytes, 1, sizeof bytes, file)) > 0;)
        for (size_t i = 0; i < count; i++)
            hash = (hash ^ (unsigned char)bytes[i]) * 1099511628211u;
    fclose(file);
    return hash;
}

static void mark_folder(const char *path, folder_mark *mark)
{
    DIR *folder = opendir(path);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        char inner[MOST_PATH];
        size_t length = strlen(entry->d_name);
        bool of_database = length > 4 && (strcmp(entry->d_name + length - 4, "-wal") == 0 ||
                                          strcmp(entry->d_name + length - 4, "-shm") == 0);
        bool lock = length > 5 && strcmp(entry->d_name + length - 5, ".lock") == 0; // may stay
        if (entry->d_name[0] == '.' || entry->d_type == DT_LNK || of_database || lock)
            continue;
        snprintf(inner, sizeof inner, "%.60s/%.90s", path, entry->d_name);
        if (entry->d_type == DT_DIR) {
            mark_folder(inner, mark);
            continue;
        }
        assert_true(mark->count < MOST_FILES);
        file_mark *file = &mark->file[mark->count++];
        strcpy(file->path, inner);
        file->hash = hash_file(inner);
    }
    closedir(folder);
}

static folder_mark mark_files(void)
{
    folder_mark mark = {.count = 0};
    mark_folder(".", &mark);
    return mark;
}

static bool holds(const folder_mark *mark, const file_mark *file)
{
    for (int i = 0; i < mark->count; i++)
        if (strcmp(mark->file[i].path, file->path) == 0)
            return mark->file[i].hash == file->hash;
    return false;
}

static bool all_in(const folder_mark *mark, const folder_mark *other)
{
    for (int i = 0; i < mark->count; i++)
        if (!holds(other, &mark->file[i]))
            return false;
    return true;
}

// Whether each file is one of `before` or `after`, or, if such may be left, has a name for a while.
static bool none_half_written(const folder_mark *now, const folder_mark *before,
                              const folder_mark *after, bool parts)
{
    for (int i = 0; i < now->count; i++) {
        const file_mark *file = &now->file[i];
        size_t length = strlen(file->path);
        bool part = length > 5 && strcmp(file->path + length - 5, ".part") == 0;
        if (!(part && parts) && !holds(before, file) && !holds(after, file))
            return false;
    }
    return true;
}

// ---- one run of a command

typedef struct outcome {
    int code; // minus the signal
    char out[1 << 14], err[1 << 12];
    folder_mark files;
} outcome;

static void read_text(const char *name, char *text, size_t size)
{
    FILE *file = fopen(name, "r");
    assert_non_null(file);
    text[fread(text, 1, size - 1, file)] = '\0';
    fclose(file);
}

static void set_number(const char *name, long value)
{
    char text[32];
    snprintf(text, sizeof text, "%ld", value);
    setenv(name, text, 1);
}

static void become(const char *line, const fault *failure, long at, bool on)
{
    char words[256], *word[MOST_WORDS + 1];
    const struct rlimit seconds = {20, 20}, no_core = {0, 0}; // of one that never ends
    int count = 0;
    snprintf(words, sizeof words, "launchdyn %s", line);
    for (char *next = strtok(words, " "); next && count < MOST_WORDS; next = strtok(NULL, " "))
        word[count++] = next;
    word[count] = NULL;
    setrlimit(RLIMIT_CPU, &seconds);
    setrlimit(RLIMIT_CORE, &no_core);
    alarm(300);
    setenv("LD_PRELOAD", LD_BINARY_DIR "/tests/libfailing_calls.so", 1);
    setenv("FAIL_LOG", "../.log", 1);
    if (failure) {
        setenv("FAIL_KIND", failure->kind, 1);
        set_number("FAIL_AT", at);
        set_number("FAIL_ERROR", failure->error);
    }
    if (on)
        setenv("FAIL_ON", "", 1);
    if (!freopen("/dev/null", "r", stdin) || !freopen("../.out", "w", stdout) ||
        !freopen("../.err", "w", stderr))
        _exit(126);
    execv(LD_BINARY_DIR "/launchdyn", word);
    _exit(127);
}

// Runs the line in the folder "work", where the call fails that is the one `at`.
static void run_line(const char *line, const fault *failure, long at, bool on, outcome *result)
{
    int status = 0;
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        become(line, failure, at, on);
    assert_int_equal(waitpid(child, &status, 0), child);
    result->code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    read_text("../.out", result->out, sizeof result->out);
    read_text("../.err", result->err, sizeof result->err);
    result->files = mark_files();
}

static void in_shell(const char *line)
{
    assert_int_equal(chdir(shell.folder), 0);
    if (system(line) != 0)
        fail_msg("%s failed", line);
}

static void work_anew(void)
{
    in_shell("rm -rf work && cp -a base work");
    assert_int_equal(chdir("work"), 0);
}

// ---- what is held against it

// A call that may fail: the first of its kind from a stack, and how.
typedef struct failing_call {
    const fault *failure;
    long at;
} failing_call;

typedef struct tried {
    const verb *command;
    folder_mark before, after;
    outcome expected, shown;
    failing_call call[MOST_CALLS];
    int count;
} tried;

typedef enum verdict {
    TOLD,
    HARMLESS,
    ENDED,
    SILENT,
    UNTRUE,
    CRASHED,
    HALF,
    STUCK,
    VERDICTS
} verdict;

static const char *const verdicts[VERDICTS] = {
    "told",           "harmless", "ended in a library", "silent",
    "not told truly", "crashed",  "half a file stays",  "does not go on"};

// Whether a report or a table was written all the same, of what could be read.
static bool shows_the_rest(const char *text)
{
    return strstr(text, "; the report shows the rest\n") ||
           strstr(text, "; the table has what is intact");
}

// Whether the text is one message, of a scenario's text with the line that it is about, and names
// the failure; of a report that shows the rest what is missing stands before it.
static bool one_true_message(const char *text, const fault *failure)
{
    bool names = strstr(text, strerror(failure->error)) != NULL;
    for (int i = 0; failure->told[i]; i++)
        names |= strstr(text, failure->told[i]) != NULL;
    const char *end = strchr(text, '\n');
    while (end && end[1] == ' ')
        end = strchr(end + 1, '\n');
    return end && (!end[1] || shows_the_rest(text)) && names;
}

// 3, as a rule; a file that may not be read, and a disk that cannot be, are of what was given.
static bool right_code(int code, const fault *failure)
{
    bool given = failure->error == EACCES || strcmp(failure->kind, "read") == 0;
    return code == SYSTEM || (code == INPUT && given);
}

// What ended in libraries, or what they printed for themselves, by their names.
typedef struct library_count {
    char name[32];
    int count;
} library_count;

static struct {
    library_count of[8];
    int count;
} libraries;

static void count_library(const char *name)
{
    int i = 0;
    while (i < libraries.count && strcmp(libraries.of[i].name, name) != 0)
        i++;
    assert_true(i < (int)(sizeof libraries.of / sizeof *libraries.of));
    if (i == libraries.count) {
        libraries.of[i].count = 0;
        snprintf(libraries.of[i].name, sizeof libraries.of[i].name, "%s", name);
        libraries.count++;
    }
    libraries.of[i].count++;
}

// The library inside the program to which the function at this place of it belongs, by how its name
// begins; NULL: none.
static const char *library_inside(const char *place)
{
    static const char *const begins[][2] = {{"ERK", "SUNDIALS"}, {"ark", "SUNDIALS"},
                                            {"ARK", "SUNDIALS"}, {"N_V", "SUNDIALS"},
                                            {"SUN", "SUNDIALS"}, {"H5", "HDF5"}};
    char line[128], name[128] = "";
    snprintf(line, sizeof line, "addr2line -f -e " LD_BINARY_DIR "/launchdyn %.20s", place);
    FILE *names = popen(line, "r"); // NOLINT(cert-env33-c)
    assert_non_null(names);
    bool of = fgets(name, sizeof name, names) != NULL;
    pclose(names);
    for (size_t i = 0; of && i < sizeof begins / sizeof *begins; i++)
        if (strncmp(name, begins[i][0], strlen(begins[i][0])) == 0)
            return begins[i][1];
    return NULL;
}

// The library in which the program has crashed by the innermost call that is not the C library's;
// false: it was none, or none is known.
static bool read_crash(char name[32])
{
    static char log[1 << 15];
    read_text("../.log", log, sizeof log);
    char *line = strstr(log, "crash\n");
    for (line = line ? strtok(line, "\n") : NULL; line; line = strtok(NULL, "\n")) {
        char file[128] = "", place[24] = "";
        if (sscanf(line, "%127[^(](+%23[^)]", file, place) < 1 || !strchr(line, '('))
            continue;
        const char *base = strrchr(file, '/') ? strrchr(file, '/') + 1 : file;
        if (strncmp(base, "libc.", 5) == 0 || strncmp(base, "libfailing_calls.", 17) == 0)
            continue;
        const char *library = strcmp(base, "launchdyn") == 0 ? library_inside(place) : base;
        snprintf(name, 32, "%.31s", library ? library : "");
        return library != NULL;
    }
    return false;
}

// Whether a library has ended its process, or complains for itself, without memory:
// docs/reliability.md names which.
static bool ended_in_library(const char *text, const fault *failure, char name[32])
{
    if (failure->error != ENOMEM)
        return false;
    if (strstr(text, "launchdyn: ended by signal"))
        return read_crash(name);
    snprintf(name, 32, "%s", strstr(text, "ARKODE") ? "a line of ARKODE" : "a line of HDF5");
    return strstr(text, "ARKODE") || strstr(text, "HDF5-DIAG");
}

static bool same(const outcome *a, const outcome *b)
{
    return strcmp(a->out, b->out) == 0 && strcmp(a->err, b->err) == 0;
}

// That the command, run again where a failure left it, comes to what it would have come to.
static bool goes_on(const tried *self)
{
    static outcome again, shown;
    run_line(self->command->line, NULL, 0, false, &again);
    if (!self->command->shown)
        return again.code == 0 && all_in(&self->expected.files, &again.files) &&
               all_in(&again.files, &self->expected.files);
    run_line(self->command->shown, NULL, 0, false, &shown);
    return again.code == 0 && same(&shown, &self->shown);
}

static bool same_files(const folder_mark *a, const folder_mark *b)
{
    return all_in(a, b) && all_in(b, a);
}

static verdict judge(const tried *self, const fault *failure, long at, bool on, outcome *now)
{
    run_line(self->command->line, failure, at, on, now);
    bool in_the_making = self->command->shown, finished = same_files(&now->files, &self->after);
    bool parts = on || strcmp(failure->kind, "remove") == 0;
    char library[32];
    if (now->code == 0 && (!same(now, &self->expected) || (!finished && !in_the_making)))
        return SILENT;
    if (now->code == SYSTEM && ended_in_library(now->err, failure, library)) {
        count_library(library);
        return ENDED;
    }
    if (now->code < 0 || strstr(now->err, "launchdyn: ended by signal"))
        return CRASHED;
    if (now->code != 0 && !(right_code(now->code, failure) && one_true_message(now->err, failure)))
        return UNTRUE;
    bool rest = shows_the_rest(now->err);
    if (!in_the_making && !rest &&
        !none_half_written(&now->files, &self->before, &self->after, parts))
        return HALF;
    bool as_ever = same_files(&now->files, &self->before) || (finished && now->code == 0);
    if (!as_ever && !goes_on(self))
        return STUCK;
    return now->code == 0 ? HARMLESS : TOLD;
}

static void tell(const tried *self, const fault *failure, long at, bool on, verdict found,
                 const outcome *now)
{
    char stack[1 << 15] = "";
    read_text("../.log", stack, sizeof stack);
    printf("%s, %s %d at %ld%s: %s, code %d, \"%s\"\n%s\n", self->command->name, failure->kind,
           failure->error, at, on ? " on" : "", verdicts[found], now->code, now->err, stack);
}

// Whether this kind is tried with the command.
static bool is_wanted(const verb *command, const char *kind)
{
    const char *only = getenv("LD_FAILING_KIND");
    if (command->only && strcmp(kind, command->only) != 0)
        return false;
    return !only || (*only == '-' ? strcmp(kind, only + 1) != 0 : strcmp(kind, only) == 0);
}

static void read_calls(tried *self)
{
    char kind[16];
    long at;
    FILE *log = fopen("../.log", "r");
    assert_non_null(log);
    self->count = 0;
    while (fscanf(log, "%15s %ld", kind, &at) == 2)
        for (int i = 0; i < FAILURES; i++) {
            if (strcmp(kind, failures[i].kind) != 0 || !is_wanted(self->command, kind))
                continue;
            assert_true(self->count < MOST_CALLS);
            self->call[self->count++] = (failing_call){&failures[i], at};
        }
    fclose(log);
}

// Runs the command as it is, for what it prints and writes and which calls it makes.
static void begin_command(tried *self, const verb *command)
{
    char line[1024];
    self->command = command;
    snprintf(line, sizeof line, "rm -rf base && mkdir base && cd base && { %s:; } >.prepared 2>&1",
             command->prepare);
    in_shell(line);
    work_anew();
    self->before = mark_files();
    run_line(command->line, NULL, 0, false, &self->expected);
    if (self->expected.code != 0)
        fail_msg("%s: code %d, \"%s\"", command->line, self->expected.code, self->expected.err);
    self->after = self->expected.files;
    read_calls(self);
    if (command->shown)
        run_line(command->shown, NULL, 0, false, &self->shown);
    work_anew();
}

// What came of the calls of each kind.
typedef int kind_counts[FAILURES][VERDICTS];

// Of a call's kind, which may fail in more than one way, the first of them.
static int kind_of(const fault *failure)
{
    int i = 0;
    while (strcmp(failures[i].kind, failure->kind) != 0)
        i++;
    return i;
}

// Lets one call fail; adds to the counts of what came of it.
static void try_call(tried *self, failing_call call, bool on, kind_counts counts)
{
    static outcome now;
    verdict found = judge(self, call.failure, call.at, on, &now);
    counts[kind_of(call.failure)][found]++;
    if (found > ENDED)
        tell(self, call.failure, call.at, on, found, &now);
    folder_mark files = mark_files();
    if (!same_files(&files, &self->before))
        work_anew();
}

// Whether all was well.
static bool print_kind(const tried *self, int kind, const int counts[VERDICTS])
{
    int stacks = 0, tries = 0;
    for (int i = 0; i < self->count; i++)
        stacks += kind_of(self->call[i].failure) == kind;
    for (int i = 0; i < VERDICTS; i++)
        tries += counts[i];
    if (tries > 0)
        printf("    %-17s %-7s %5d stacks, %5d tried:", self->command->name, failures[kind].kind,
               stacks, tries);
    for (int i = 0; i < VERDICTS; i++)
        if (counts[i] > 0)
            printf(" %d %s", counts[i], verdicts[i]);
    if (tries > 0)
        printf("\n");
    return counts[TOLD] + counts[HARMLESS] + counts[ENDED] == tries;
}

static bool print_command(const tried *self, kind_counts counts)
{
    bool fine = true;
    for (int i = 0; i < FAILURES; i++)
        fine &= print_kind(self, i, counts[i]);
    for (int i = 0; i < libraries.count; i++)
        printf("        %s: %d\n", libraries.of[i].name, libraries.of[i].count);
    libraries.count = 0;
    fflush(stdout);
    return fine;
}

static bool try_command(const verb *command, int wanted)
{
    static tried self;
    kind_counts counts = {{0}};
    int tries = 0;
    uint64_t stream = random_stream(command->name);
    begin_command(&self, command);
    if (wanted == 0)
        for (; tries < 2 * self.count; tries++)
            try_call(&self, self.call[tries / 2], tries % 2, counts);
    for (; tries < wanted && self.count > 0; tries++) {
        int drawn = (int)(random_uniform(1, stream, (uint64_t)tries, 0, 0) * self.count);
        try_call(&self, self.call[drawn], tries % 2, counts);
    }
    return print_command(&self, counts);
}

// Memory that is gone for good, from each eighth of a study's calls for it on.
static void test_no_more_memory(void **state)
{
    (void)state;
    enum { PARTS = 8 };
    static tried self;
    static const char *const studies[] = {"study", "study show"};
    kind_counts counts = {{0}};
    int tries = 0;
    setenv("LD_FAILING_KIND", "memory", 1);
    for (int i = 0; i < VERBS; i++) {
        if (strcmp(verbs[i].name, studies[0]) != 0 && strcmp(verbs[i].name, studies[1]) != 0)
            continue;
        begin_command(&self, &verbs[i]);
        for (int part = 0; part < PARTS; part++, tries++)
            try_call(&self, self.call[part * self.count / PARTS], true, counts);
    }
    unsetenv("LD_FAILING_KIND");
    assert_int_equal(counts[0][TOLD], tries); // memory, the first kind
}

// A disk that cannot be read where a study's table is written, which goes through the samples
// twice: what it gives the second time is what it gave the first.
static void test_reads_of_a_table(void **state)
{
    (void)state;
    const verb *export = verbs;
    while (strcmp(export->name, "study export") != 0)
        export ++;
    setenv("LD_FAILING_KIND", "read", 1);
    bool fine = try_command(export, 0);
    unsetenv("LD_FAILING_KIND");
    assert_true(fine);
}

static void test_commands(void **state)
{
    (void)state;
    const char *wanted = getenv("LD_FAILING_CALLS"), *only = getenv("LD_FAILING_COMMAND");
    bool fine = true;
    for (int i = 0; i < VERBS; i++)
        if (!only || strcmp(only, verbs[i].name) == 0)
            fine &= try_command(&verbs[i], wanted ? atoi(wanted) : 2);
    assert_true(fine);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_commands, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(test_no_more_memory, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(test_reads_of_a_table, shell_make, shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
