#include "cli/help.h"

#include <stdio.h>
#include <string.h>

static help_printer *chosen;

void help_choose(help_printer *print)
{
    chosen = print;
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
    printf("%s\n\nUsage: launchdyn %s %s\n", self->summary, self->name, self->arguments);
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
