// launchdyn road: the road of a scenario, to look at.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "launchdyn/environment.h"

typedef struct road_wishes {
    char **sets;
    char *folder, *picture; // NULL: not requested
    ld_stretch stretch;
} road_wishes;

static int show_road(const ld_model *model, void *data)
{
    const road_wishes *wishes = data;
    ld_road_view *view = NULL;
    ld_error error;
    ld_status status = ld_road_view_create(model, wishes->stretch, &view, &error);
    if (!status && wishes->folder)
        status = ld_road_view_write(view, wishes->folder, &error);
    if (!status && wishes->picture)
        status = ld_road_view_draw(view, wishes->picture, &error);
    if (!status)
        command_step("computed and wrote the results");
    if (!status && !command_is_quiet())
        ld_road_view_print(view, stdout);
    ld_road_view_free(view);
    return status ? command_fail(status, &error) : 0;
}

int command_road(const command *self, int argc, char **argv)
{
    road_wishes wishes = {.stretch = {NAN, NAN, NAN}};
    const command_option options[] = {
        COMMAND_SETS(&wishes.sets),
        {"out", 'o', OPTION_TEXT, &wishes.folder,
         "Write road.csv and road-spectrum.csv into this folder", "DIR"},
        {"plot", 'p', OPTION_TEXT, &wishes.picture,
         "Draw both with gnuplot: FILE.svg, FILE.pdf or FILE.png", "FILE"},
        {"from", '\0', OPTION_METRES, &wishes.stretch.from,
         "First x of the section, in metres (-100)", "X"},
        {"to", '\0', OPTION_METRES, &wishes.stretch.to, "Last x of the section, in metres (100)",
         "X"},
        {"step", '\0', OPTION_METRES, &wishes.stretch.step,
         "Spacing of the points, in metres (0.02)", "DX"},
        COMMAND_USUAL};
    int code = command_on_model(self, argc, argv, options, &wishes.sets, show_road, &wishes);
    return code;
}
