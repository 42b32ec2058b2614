#include "cli/words/help.h"

#include <stdio.h>
#include <string.h>

static help_printer *chosen;

void help_choose(help_printer *print)
{
    chosen = print;
}

const char *help_call(const command *self, char text[HELP_CALL])
{
    snprintf(text, HELP_CALL, "%s %s", self->program ? self->program : "launchdyn", self->name);
    return text;
}

// Each line of an example is a command, a bar and what it does.
static void print_examples(const command *self)
{
    for (const char *line = self->examples; line && *line; line += strcspn(line, "\n") + 1) {
        size_t bar = strcspn(line, "|"), end = strcspn(line, "\n");
        printf("%s  %.*s\n      %.*s\n", line == self->examples ? "\nExamples:\n" : "", (int)bar,
               line, (int)(end - bar - 1), line + bar + 1);
        if (!line[end])
            return;
    }
}

static void print_text(const command *self, const command_option *options)
{
    char call[HELP_CALL];
    printf("%s\n\nUsage: %s%s%s\n", self->summary, help_call(self, call),
           self->arguments[0] ? " " : "", self->arguments);
    options_print(options);
    if (self->about) {
        putchar('\n');
        print_wrapped(self->about, 0);
    }
    if (self->more) {
        putchar('\n');
        self->more();
    }
    print_examples(self);
}

void help_print(const command *self, const command_option *options)
{
    if (chosen)
        chosen(self, options);
    else
        print_text(self, options);
}
