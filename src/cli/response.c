// launchdyn response: what a scenario's launcher answers to small motions of its road, its base,
// its commands and to forces.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "launchdyn/response_view.h"

enum { MOST = 1024 };

typedef struct response_wishes {
    char **sets;
    char *what, *speeds, *loop;
    char *folder, *picture; // NULL: not requested
    int list;
    ld_response_wish wish;
} response_wishes;

static void print_names(const char *title, const ld_column *columns, size_t count)
{
    puts(title);
    for (size_t i = 0; i < count; i++)
        printf("  %-32s %-10s %s\n", columns[i].name, columns[i].unit, columns[i].description);
}

static int list_names(const ld_model *model)
{
    ld_response *response;
    ld_error error;
    const ld_column *columns;
    ld_status status = ld_response_create(model, NAN, NAN, &response, &error);
    if (status)
        return command_fail_on(model, status, &error);
    size_t count = ld_response_inputs(response, &columns);
    print_names("Inputs", columns, count);
    count = ld_response_columns(response, &columns);
    print_names("\nQuantities", columns, count);
    ld_response_free(response);
    return 0;
}

static int show_response(const ld_model *model, void *data)
{
    const response_wishes *wishes = data;
    ld_response_view *view = NULL;
    ld_error error;
    if (wishes->list)
        return list_names(model);
    ld_status status = ld_response_view_create(model, &wishes->wish, &view, &error);
    if (!status && wishes->folder)
        status = ld_response_view_write(view, wishes->folder, &error);
    if (!status && wishes->picture)
        status = ld_response_view_draw(view, wishes->picture, &error);
    if (!status)
        command_step("computed and wrote the results");
    if (!status && !command_is_quiet())
        ld_response_view_print(view, stdout);
    ld_response_view_free(view);
    return status ? command_fail_on(model, status, &error) : 0;
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

// FROM:TO:STEP in km/h.
static bool read_speeds(const char *text, ld_response_wish *wish)
{
    double number[3];
    char *end;
    for (int i = 0; i < 3; i++) {
        number[i] = strtod(text, &end) / 3.6;
        if (end == text || !isfinite(number[i]) || (i < 2 && *end != ':'))
            return false;
        text = end + 1;
    }
    wish->slowest = number[0];
    wish->fastest = number[1];
    wish->step = number[2];
    return *end == '\0' || strcmp(end, " km/h") == 0 || strcmp(end, "km/h") == 0;
}

int command_response(const command *self, int argc, char **argv)
{
    response_wishes wishes = {.wish = {.from = NAN, .to = NAN, .step = NAN}};
    char *input = NULL, *density = NULL;
    int of_exit = 0, friction = 0;
    int draws = 0;
    const command_option options[] = {
        COMMAND_SETS(&wishes.sets),
        {"what", 'w', OPTION_TEXT, &wishes.what,
         "Quantities: columns of the history, or all (a selection)", "NAME,..."},
        {"input", 'i', OPTION_TEXT, &input,
         "Frequency response to this input in place of the response to the road", "NAME"},
        {"density", '\0', OPTION_TEXT, &density,
         "Root mean squares and spectra for a random input; the CSV file has its one-sided power "
         "spectral density over the frequency in Hz",
         "FILE"},
        {"exit", 'x', OPTION_FLAG, &of_exit,
         "Scatter of the exit that the road causes, at the scenario's speed or over --speeds; "
         "--what names results of a launch",
         NULL},
        {"draws", '\0', OPTION_INTEGER, &draws,
         "For --exit: compute N launches (2 or more) with sampled phases of the road in place of "
         "the first order",
         "N"},
        {"friction", '\0', OPTION_FLAG, &friction,
         "Linearise the friction of the hinges for the motion on the road; --exit always does",
         NULL},
        {"loop", '\0', OPTION_TEXT, &wishes.loop,
         "Open loop of this hinge's stabiliser or of this drive: margins, bandwidth, sensitivity",
         "azimuth|elevation|DRIVE"},
        {"speeds", '\0', OPTION_TEXT, &wishes.speeds,
         "Root mean squares at these speeds in km/h, such as 0:60:1", "FROM:TO:STEP"},
        {"from", '\0', OPTION_HERTZ, &wishes.wish.from, "Lowest frequency in Hz (0.2)", "HZ"},
        {"to", '\0', OPTION_HERTZ, &wishes.wish.to, "Highest frequency in Hz (50)", "HZ"},
        {"list", 'l', OPTION_FLAG, &wishes.list, "List the names of inputs and quantities and stop",
         NULL},
        {"out", 'o', OPTION_TEXT, &wishes.folder,
         "Write response-rms.csv and response-spectrum.csv, response-frequency.csv, "
         "response-loop.csv or response-exit.csv into this folder",
         "DIR"},
        {"plot", 'p', OPTION_TEXT, &wishes.picture,
         "Draw it with gnuplot: FILE.svg, FILE.pdf or FILE.png", "FILE"},
        COMMAND_USUAL};
    static const char *names[MOST];
    command_line line;
    int code = 0;
    if (!command_line_read(&line, self, argc, argv, options, &code))
        return code;
    wishes.wish.input = input;
    wishes.wish.density = density;
    wishes.wish.exit = of_exit;
    wishes.wish.friction = friction;
    wishes.wish.draws = draws;
    wishes.wish.loop = wishes.loop;
    wishes.wish.what = names;
    command_tell_renamed(wishes.what);
    wishes.wish.what_count = split(wishes.what, names);
    if (wishes.speeds && !read_speeds(wishes.speeds, &wishes.wish)) {
        command_complain("--speeds: found \"%s\", expected FROM:TO:STEP in km/h, such as 0:60:1",
                         wishes.speeds);
        code = EXIT_INPUT;
    } else {
        code = command_on_file(line.word[0], wishes.sets, show_response, &wishes);
    }
    options_end(&line);
    return code;
}
