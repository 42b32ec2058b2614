#include "cli/command.h"

#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "cli/progress.h"
#include "cli/words/help.h"
#include "launchdyn/child.h"

void command_complain(const char *format, ...)
{
    char text[2 * LD_ERROR_TEXT], visible[4 * sizeof text];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fprintf(stderr, "launchdyn: %s\n", ld_visible_text(text, visible, sizeof visible));
}

// Of the one command that a process does.
static struct {
    int quiet, verbose;
    double since; // [s] the latest step
} voice;

int *command_quiet_flag(void)
{
    return &voice.quiet;
}

int *command_verbose_flag(void)
{
    return &voice.verbose;
}

bool command_is_quiet(void)
{
    return voice.quiet != 0;
}

FILE *command_text(void)
{
    static FILE *nowhere;
    if (voice.quiet && !nowhere)
        nowhere = fopen("/dev/null", "w");
    return voice.quiet && nowhere ? nowhere : stdout;
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

void command_tell_renamed(const char *list)
{
    char name[128], now[160];
    size_t length;
    for (const char *at = list; at && *at; at += length + (at[length] == ',')) {
        length = strcspn(at, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (length < sizeof name && ld_current_name(name, now, sizeof now))
            command_complain("%s is called %s now", name, now);
    }
}

void command_step(const char *format, ...)
{
    char text[LD_ERROR_TEXT];
    if (!voice.verbose)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    command_complain("%s: %.1f ms", text, (now() - voice.since) * 1e3);
    voice.since = now();
}

int command_code(ld_status status)
{
    switch (status) {
    case LD_OK:
        return 0;
    case LD_ERR_LAUNCH:
    case LD_ERR_NUMERIC:
        return EXIT_LAUNCH;
    case LD_ERR_INPUT:
        return EXIT_INPUT;
    case LD_ERR_INTERRUPTED:
        return 128 + progress_signal();
    case LD_ERR_FILE:
    case LD_ERR_MEMORY:
    case LD_ERR_MISSING:
        break;
    }
    return EXIT_SYSTEM;
}

int command_fail(ld_status status, const ld_error *error)
{
    command_complain("%s", error->text);
    return command_code(status);
}

int command_fail_on(const ld_model *model, ld_status status, const ld_error *error)
{
    ld_messages messages;
    if (!ld_scenario_explain(model, error, &messages))
        return command_fail(status, error);
    ld_messages_print(&messages, stderr);
    ld_messages_free(&messages);
    return command_code(status);
}

int command_begin(void)
{
    enum { LEAST_STACK = 512 }; // [kB]
    struct rlimit stack;
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    if (getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= LEAST_STACK * 1024)
        return 0;
    command_complain("the stack is limited to %llu kB, expected at least %d kB (ulimit -s %d)",
                     (unsigned long long)stack.rlim_cur / 1024, LEAST_STACK, LEAST_STACK);
    return EXIT_SYSTEM;
}

int command_end(int code)
{
    if ((fflush(stdout) == 0 && !ferror(stdout)) || code == EXIT_SYSTEM)
        return code;
    command_complain("cannot print: %s", strerror(errno));
    return code ? code : EXIT_SYSTEM;
}

int command_in_child(int (*work)(void *data), void *data)
{
    int code = 0;
    ld_error error;
    ld_status status = ld_child_run(work, data, &code, &error);
    return status ? command_fail(status, &error) : code;
}

// What is wrong with the number of words.
static bool has_words(const command *self, const command_line *line)
{
    int count = self->words;
    if (count == COMMAND_WORDS ? line->count > 0 : count < 0 || line->count == (size_t)count)
        return true;
    char call[HELP_CALL];
    help_call(self, call);
    if (self->arguments[0])
        command_complain("%s requires %s; see %s --help", self->name, self->arguments, call);
    else
        command_complain("%s takes options only, found \"%.80s\"; see %s --help", self->name,
                         line->word[0], call);
    return false;
}

bool command_line_read(command_line *line, const command *self, int argc, char **argv,
                       const command_option *options, int *code)
{
    ld_error error;
    ld_status status = options_read(line, argc, argv, options, &error);
    voice.since = now();
    if (!status && !line->help && voice.quiet && voice.verbose)
        status = ld_fail(&error, LD_ERR_INPUT, "--quiet and --verbose exclude each other");
    if (!status && !line->help && has_words(self, line))
        return true;
    if (!status && line->help)
        help_print(self, options);
    *code = status ? command_fail(status, &error) : line->help ? 0 : EXIT_INPUT;
    options_end(line);
    return false;
}

static size_t count_sets(char **sets)
{
    size_t count = 0;
    while (sets && sets[count])
        count++;
    return count;
}

static ld_status print_messages(ld_status status, ld_messages *messages)
{
    if (status == LD_ERR_MEMORY)
        command_complain("no memory");
    if (status) {
        ld_messages_print(messages, stderr);
        ld_messages_free(messages);
    }
    return status;
}

ld_status command_read_file(const char *file, char **sets, ld_model **model, ld_messages *messages)
{
    size_t count = count_sets(sets);
    ld_status status = ld_scenario_read(file, (const char *const *)sets, count, model, messages);
    if (!status)
        command_step("read %s with %zu overrides", file, count);
    return status;
}

ld_status command_read_source(ld_source *source, int point, ld_model **model)
{
    ld_messages messages = {0};
    return print_messages(ld_scenario_read_source(source, point, model, &messages), &messages);
}

ld_status command_read_study(const char *file, char **sets, ld_study **study)
{
    ld_messages messages = {0};
    ld_status status =
        ld_study_read(file, (const char *const *)sets, count_sets(sets), study, &messages);
    return print_messages(status, &messages);
}

ld_status command_read_study_source(ld_source *source, ld_study **study)
{
    ld_messages messages = {0};
    return print_messages(ld_study_read_source(source, study, &messages), &messages);
}

void command_warn_difference(const char *folder, const ld_origin *origin)
{
    char text[1024];
    if (ld_origin_differs(origin, text, sizeof text))
        command_complain("warning: %s was computed by another program or machine; the last digits "
                         "may differ: %s",
                         folder, text);
}

const char *command_wrong_jobs(int threads)
{
    enum { MOST_THREADS = 1024 };
    return threads < 1 || threads > MOST_THREADS ? "--jobs: expected a number from 1 to 1024"
                                                 : NULL;
}

int command_take_notes(ld_source *source, int from, int to, bool strict)
{
    ld_messages notes;
    ld_status status = ld_scenario_notes(source, from, to, &notes);
    if (status == LD_ERR_INPUT)
        ld_messages_free(&notes);
    if (status)
        return status == LD_ERR_INPUT ? 0 : command_code(print_messages(status, &notes));
    int code = strict && notes.count > 0 ? EXIT_INPUT : 0;
    if (strict)
        ld_messages_print(&notes, stderr);
    else if (!command_is_quiet())
        ld_notes_print(&notes, stderr);
    ld_messages_free(&notes);
    return code;
}

int command_on_file(const char *file, char **sets, int (*work)(const ld_model *model, void *data),
                    void *data)
{
    ld_model *model;
    ld_messages messages = {0};
    ld_status status = print_messages(command_read_file(file, sets, &model, &messages), &messages);
    if (status)
        return command_code(status);
    int code = work(model, data);
    ld_model_free(model);
    return code;
}

// NOLINTNEXTLINE(readability-function-size)
int command_on_model(const command *self, int argc, char **argv, const command_option *options,
                     char ***sets, int (*work)(const ld_model *model, void *data), void *data)
{
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, &code)) {
        code = command_on_file(line.word[0], *sets, work, data);
        options_end(&line);
    }
    return code;
}
