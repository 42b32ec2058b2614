#include "cli/command.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "cli/progress.h"
#include "launchdyn/scenario.h"

void command_complain(const char *format, ...)
{
    char text[2 * LD_ERROR_TEXT], visible[4 * sizeof text];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fprintf(stderr, "launchdyn: %s\n", ld_visible_text(text, visible, sizeof visible));
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

int command_begin(void)
{
    enum { LEAST_STACK = 512 }; // [kB]
    struct rlimit stack;
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    if (getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= LEAST_STACK * 1024)
        return 0;
    command_complain("the stack is limited to %llu kB, and %d kB are needed (ulimit -s %d)",
                     (unsigned long long)stack.rlim_cur / 1024, LEAST_STACK, LEAST_STACK);
    return EXIT_SYSTEM;
}

// "unknown option --cvs (did you mean --csv?)"
static void complain_option(poptContext context, const struct poptOption *options, int problem)
{
    enum { MOST = 16 };
    const char *names[MOST];
    size_t count = 0;
    for (; count < MOST && options[count].longName; count++)
        names[count] = options[count].longName;
    const char *option = poptBadOption(context, POPT_BADOPTION_NOALIAS);
    const char *name = option + strspn(option, "-");
    const char *nearest = problem == POPT_ERROR_BADOPT ? ld_nearest_name(name, names, count) : NULL;
    if (nearest)
        command_complain("unknown option %s (did you mean --%s?)", option, nearest);
    else
        command_complain("%s: %s", option, poptStrerror(problem));
}

static void print_help(const command *self, poptContext context)
{
    printf("%s\n\n", self->summary);
    fflush(stdout);
    poptPrintHelp(context, stdout, 0);
    if (self->help)
        self->help();
}

bool command_line_read(command_line *line, const command *self, int argc, const char **argv,
                       const struct poptOption *options, int count, int *code)
{
    line->context = poptGetContext("launchdyn", argc, argv, options, POPT_CONTEXT_NO_EXEC);
    poptSetOtherOptionHelp(line->context, self->arguments);
    int found = poptGetNextOpt(line->context);
    line->word = poptGetArgs(line->context);
    for (line->count = 0; line->word && line->word[line->count];)
        line->count++;
    *code = EXIT_INPUT;
    if (found == 'h') {
        print_help(self, line->context);
        *code = 0;
    } else if (found < -1) {
        complain_option(line->context, options, found);
    } else if (count == COMMAND_WORDS ? line->count == 0
                                      : count >= 0 && line->count != (size_t)count) {
        command_complain("%s wants %s; see launchdyn %s --help", self->name, self->arguments,
                         self->name);
    } else {
        return true;
    }
    command_line_end(line);
    return false;
}

void command_line_end(command_line *line)
{
    poptFreeContext(line->context);
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
    if (status) {
        ld_messages_print(messages, stderr);
        ld_messages_free(messages);
    }
    return status;
}

static ld_status read_file(const char *file, char **sets, ld_model **model)
{
    ld_messages messages = {0};
    ld_status status =
        ld_scenario_read(file, (const char *const *)sets, count_sets(sets), model, &messages);
    return print_messages(status, &messages);
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

void command_tell_difference(const char *folder, const ld_origin *origin)
{
    char text[1024];
    if (ld_origin_differs(origin, text, sizeof text))
        command_complain("note: %s was computed otherwise, which may change the last digits: %s",
                         folder, text);
}

int command_take_notes(ld_source *source, int from, int to, bool quiet, bool strict)
{
    ld_messages notes;
    ld_status status = print_messages(ld_scenario_notes(source, from, to, &notes), &notes);
    if (status)
        return command_code(status);
    int code = strict && notes.count > 0 ? EXIT_INPUT : 0;
    if (strict)
        ld_messages_print(&notes, stderr);
    else if (!quiet)
        ld_notes_print(&notes, stderr);
    ld_messages_free(&notes);
    return code;
}

int command_on_file(const char *file, char **sets, int (*work)(const ld_model *model, void *data),
                    void *data)
{
    ld_model *model;
    ld_status status = read_file(file, sets, &model);
    if (status)
        return command_code(status);
    int code = work(model, data);
    ld_model_free(model);
    return code;
}

void command_free_sets(char **sets)
{
    for (char **set = sets; set && *set; set++)
        free(*set);
    free(sets);
}

int command_on_model(const command *self, int argc, const char **argv,
                     const struct poptOption *options, char ***sets,
                     int (*work)(const ld_model *model, void *data), void *data)
{
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, 1, &code)) {
        code = command_on_file(line.word[0], *sets, work, data);
        command_line_end(&line);
    }
    command_free_sets(*sets);
    return code;
}
