// launchdyn plot: figures of a run.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "launchdyn/output.h"

enum { MOST = 32 };

void command_plot_help(void)
{
    puts("\nFigures for --what, one below the other on one page:");
    const ld_figure *figure;
    for (size_t i = 0; (figure = ld_figure_at(i)) != NULL; i++)
        printf("  %-10s %s\n", figure->name, figure->description);
    puts("  all        every one of them");
}

// Parts the list at its commas, in place.
static size_t split(char *list, const char *names[MOST])
{
    size_t count = 0;
    for (char *name = strtok(list, ","); name && count < MOST; name = strtok(NULL, ","))
        names[count++] = name;
    return count;
}

static size_t all_figures(const char *names[MOST])
{
    size_t count = 0;
    for (const ld_figure *figure; (figure = ld_figure_at(count)) != NULL; count++)
        names[count] = figure->name;
    return count;
}

static int draw(const char *folder, char *what, const char *file)
{
    const char *names[MOST];
    size_t count = strcmp(what, "all") == 0 ? all_figures(names) : split(what, names);
    ld_error error;
    ld_status status = ld_plot(folder, names, count, file, &error);
    return status ? command_fail(status, &error) : 0;
}

int command_plot(const command *self, int argc, const char **argv)
{
    char *what = NULL, *file = NULL, usual[] = "tip,contact,relative";
    const struct poptOption options[] = {{"what", 'w', POPT_ARG_STRING, &what, 0,
                                          "Figures to draw (tip,contact,relative)", "NAME,..."},
                                         {"output", 'o', POPT_ARG_STRING, &file, 0,
                                          "The picture: FILE.svg, FILE.pdf or FILE.png", "FILE"},
                                         COMMAND_HELP,
                                         COMMAND_END};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, 1, &code)) {
        if (!file) {
            command_complain("plot wants -o FILE.svg, FILE.pdf or FILE.png");
            code = EXIT_INPUT;
        } else {
            code = draw(line.word[0], what ? what : usual, file);
        }
        command_line_end(&line);
    }
    free(what);
    free(file);
    return code;
}
