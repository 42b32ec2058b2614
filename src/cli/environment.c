// launchdyn road, launchdyn wind: the road and the wind of a scenario, to look at.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "launchdyn/environment.h"

// ---- road

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

// ---- wind

typedef struct wind_wishes {
    char **sets;
    char *folder, *picture; // NULL: not requested
    ld_wind_section section;
} wind_wishes;

static int show_wind(const ld_model *model, void *data)
{
    const wind_wishes *wishes = data;
    ld_wind_view *view = NULL;
    ld_error error;
    ld_status status = ld_wind_view_create(model, wishes->section, &view, &error);
    if (!status && wishes->folder)
        status = ld_wind_view_write(view, wishes->folder, &error);
    if (!status && wishes->picture)
        status = ld_wind_view_draw(view, wishes->picture, &error);
    if (!status)
        command_step("computed and wrote the results");
    if (!status && !command_is_quiet())
        ld_wind_view_print(view, stdout);
    ld_wind_view_free(view);
    return status ? command_fail(status, &error) : 0;
}

int command_wind(const command *self, int argc, char **argv)
{
    wind_wishes wishes = {.section = {100, 2000, NAN, NAN, 1}};
    const command_option options[] = {
        COMMAND_SETS(&wishes.sets),
        {"out", 'o', OPTION_TEXT, &wishes.folder,
         "Write wind-profile.csv and, if the wind has gusts or turbulence, wind-gusts.csv, "
         "wind-turbulence.csv and wind-spectrum.csv into this folder",
         "DIR"},
        {"plot", 'p', OPTION_TEXT, &wishes.picture,
         "Draw them with gnuplot: FILE.svg, FILE.pdf or FILE.png", "FILE"},
        {"height", '\0', OPTION_METRES, &wishes.section.height,
         "Height of gusts and turbulence above ground, in metres (100)", "H"},
        {"top", '\0', OPTION_METRES, &wishes.section.top,
         "Largest height of the profile, in metres (2000)", "H"},
        {"length", '\0', OPTION_METRES, &wishes.section.length,
         "Length of the line through the turbulence, in metres (100 L_u)", "S"},
        {"step", '\0', OPTION_METRES, &wishes.section.step,
         "Spacing of the points on that line, in metres (0.03 of the smaller length scale)", "DS"},
        {"rocket", '\0', OPTION_INTEGER, &wishes.section.rocket,
         "Number of the rocket in the launch sequence whose turbulence is shown (1)", "N"},
        COMMAND_USUAL};
    int code = command_on_model(self, argc, argv, options, &wishes.sets, show_wind, &wishes);
    return code;
}
