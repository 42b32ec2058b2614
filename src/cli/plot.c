// launchdyn plot: figures of one run, or of several laid one over the other.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "launchdyn/output.h"

enum { MOST = 32 };

void command_plot_figures(void)
{
    puts("Figures for --what, drawn one below the other on one page:");
    const ld_figure *figure;
    for (size_t i = 0; (figure = ld_figure_at(i)) != NULL; i++)
        printf("  %-13s %s\n", figure->name, figure->description);
    puts("  all           all whose columns the results have");
}

// Parts the list at its commas, in place.
static size_t split(char *list, const char *names[MOST])
{
    size_t count = 0;
    for (char *name = list ? strtok(list, ",") : NULL; name && count < MOST;
         name = strtok(NULL, ","))
        names[count++] = name;
    return count;
}

// What the options ask for; lengths in mm, times in ms.
typedef struct wishes {
    char *what, *file, *style;
    double from, to, width;
    ld_scene scene; // 0: not given
} wishes;

static int draw(const command_line *line, const wishes *asked)
{
    const char *names[MOST];
    char note[LD_ERROR_TEXT];
    ld_scene scene = {asked->scene.magnify != 0 ? asked->scene.magnify : 1,
                      asked->scene.slower != 0 ? asked->scene.slower : 1};
    ld_picture picture = {.folder = line->word,
                          .folder_count = line->count,
                          .figure = names,
                          .figure_count = split(asked->what, names),
                          .from = asked->from * 1e-3,
                          .to = asked->to * 1e-3,
                          .style = asked->style,
                          .width = asked->width * 1e-3,
                          .note = note,
                          .scene = asked->scene.magnify != 0 || asked->scene.slower != 0 ? &scene
                                                                                         : NULL};
    ld_error error;
    ld_status status = ld_plot(&picture, asked->file, &error);
    if (!status)
        command_step("drew %s", asked->file);
    if (!status && *note && !command_is_quiet())
        command_complain("note: %s", note);
    return status ? command_fail(status, &error) : 0;
}

int command_plot(const command *self, int argc, char **argv)
{
    wishes asked = {.from = NAN, .to = NAN};
    const command_option options[] = {
        {"what", 'w', OPTION_TEXT, &asked.what,
         "Figures to draw (tip,contact,relative; for a flight without launcher trajectory,flight)",
         "NAME,..."},
        {"output", 'o', OPTION_TEXT, &asked.file,
         "Picture: FILE.svg, FILE.pdf or FILE.png; FILE.glb: the moving launcher in three "
         "dimensions",
         "FILE"},
        {"from", '\0', OPTION_MILLISECONDS, &asked.from, "First time to draw, after ignition [ms]",
         "MS"},
        {"to", '\0', OPTION_MILLISECONDS, &asked.to, "Last time to draw, after ignition [ms]",
         "MS"},
        {"style", '\0', OPTION_TEXT, &asked.style,
         "Style: screen (default), dark, or paper (84 mm wide)", "NAME"},
        {"width", '\0', OPTION_MILLIMETRES, &asked.width,
         "Width of the picture [mm]; the font size stays", "MM"},
        {"magnify", '\0', OPTION_NUMBER, &asked.scene.magnify,
         "Of a .glb: deflections of tubes and beams so many times (1)", "N"},
        {"slower", '\0', OPTION_NUMBER, &asked.scene.slower,
         "Of a .glb: played so many times slower than the launch (1)", "N"},
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, &code)) {
        if (!asked.file) {
            command_complain("plot requires -o FILE.svg, FILE.pdf, FILE.png or FILE.glb");
            code = EXIT_INPUT;
        } else {
            code = draw(&line, &asked);
        }
        options_end(&line);
    }
    return code;
}
