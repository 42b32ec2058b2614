// launchdyn sensitivity: derivatives of a launch's results by keys of its scenario.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "launchdyn/derivatives.h"

enum { MOST_KEYS = 64 };

typedef struct wishes {
    char **sets, *what;
    int threads, json, strict;
    size_t count;
    ld_derivative_key key[MOST_KEYS];
    char text[MOST_KEYS][256]; // that they point into
} wishes;

// "KEY" or "KEY=STEP"; false after a message.
static bool read_keys(wishes *self, const char *const *words, size_t count)
{
    if (count < 1 || count > MOST_KEYS) {
        command_complain("sensitivity requires a file and 1 to %d keys; see launchdyn sensitivity "
                         "--help",
                         MOST_KEYS);
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        char *text = self->text[i];
        snprintf(text, sizeof self->text[i], "%s", words[i]);
        char *step = strchr(text, '=');
        if (step)
            *step++ = '\0';
        self->key[i] = (ld_derivative_key){text, step};
    }
    self->count = count;
    return true;
}

static int print(const ld_derivatives *found, const wishes *self)
{
    ld_error error;
    command_tell_renamed(self->what);
    ld_status status = self->json ? ld_derivatives_print_json(found, self->what, stdout, &error)
                                  : ld_derivatives_print(found, self->what, command_text(), &error);
    return status ? command_fail(status, &error) : 0;
}

static int differentiate(const ld_model *model, void *data)
{
    const wishes *self = data;
    ld_derivatives *found = NULL;
    run_progress progress;
    ld_error error;
    int code = command_take_notes(ld_model_source(model), 0, 0, self->strict != 0);
    if (code)
        return code;
    progress_start(&progress, command_is_quiet());
    const ld_derivative_options options = {.threads = self->threads,
                                           .self = &progress,
                                           .progress = progress_derivatives,
                                           .go_on = progress_resume};
    ld_status status = ld_derivatives_find(model, self->key, self->count, &options, &found, &error);
    progress_end(&progress);
    command_step("launches run");
    code = status ? command_fail_on(model, status, &error) : print(found, self);
    ld_derivatives_free(found);
    return code;
}

int command_sensitivity(const command *self, int argc, char **argv)
{
    wishes asked = {.threads = 1};
    const command_option options[] = {
        COMMAND_SETS(&asked.sets),
        COMMAND_STRICT(&asked.strict),
        {"what", 'w', OPTION_TEXT, &asked.what, "Results in place of the usual ones", "NAME,..."},
        COMMAND_JOBS(&asked.threads, "launches"),
        COMMAND_JSON(&asked.json),
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (!command_line_read(&line, self, argc, argv, options, &code))
        return code;
    code = EXIT_INPUT;
    if (command_wrong_jobs(asked.threads))
        command_complain("%s", command_wrong_jobs(asked.threads));
    else if (read_keys(&asked, line.word + 1, line.count - (line.count > 0)))
        code = command_on_file(line.word[0], asked.sets, differentiate, &asked);
    options_end(&line);
    return code;
}
