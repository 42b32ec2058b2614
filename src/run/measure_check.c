#include "run/measure_check.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/suggestion.h"
#include "model/blocks/firing.h"
#include "model/blocks/rocket.h"
#include "model/blocks/run.h"
#include "model/parts.h"

static void refuse(const measure_check *check, const char *key, const char *format, ...)
    LD_PRINTF(3, 4);
static void refuse(const measure_check *check, const char *key, const char *format, ...)
{
    char path[64], text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (check->why) {
        snprintf(check->why, EXPRESSION_WHY, "%.*s", EXPRESSION_WHY - 1, text);
        return;
    }
    snprintf(path, sizeof path, "measures.%d.%s", check->number, key);
    check->report(check->self, path, text);
}

// The column, or NULL after a message.
static const quantity_group *check_column(const measure_check *check, bool flight, const char *name)
{
    const column_search search = measure_columns(check->model, flight);
    const char *what = flight ? "the flight" : "the launch";
    const quantity_walk found = measure_column_named(&search, name);
    char near[QUANTITY_NAME];
    if (found.row)
        return found.group;
    measure_nearest_column(&search, name, near);
    if (*near)
        refuse(check, "of", "found \"%s\", which is not a column of %s; did you mean \"%s\"?", name,
               what, near);
    else
        refuse(check, "of",
               "found \"%s\", which is not a column of %s; expected one of docs/quantities.md, "
               "such as %s",
               name, what, flight ? "rocket.pitch_rate" : "tip.pitch_rate");
    return NULL;
}

static void refuse_instant(const measure_check *check, const char *key, const char *name)
{
    char exits[LD_MAX_ADAPTORS][LD_MAX_QUANTITY], known[512] = "";
    instant_row row[MEASURE_MOST_INSTANTS];
    int count = measure_list_instants(check->model, exits, row);
    name_suggestion best = suggestion_begin(name);
    for (int i = 0; i < count; i++) {
        size_t length = strlen(known);
        suggestion_offer(&best, row[i].name);
        snprintf(known + length, sizeof known - length, "%s%s", i ? ", " : "", row[i].name);
    }
    const bool launcher = model_has_launcher(check->model);
    if (launcher && strcmp(name, "t_middle") == 0)
        refuse(check, key,
               "found \"t_middle\", which requires exactly three adaptors; the rocket has %d",
               model_rocket(check->model)->adaptor_count);
    else if (launcher && strcmp(name, "t_release") == 0)
        refuse(check, key, "found \"t_release\", but the rocket has no lock");
    else if (best.name)
        refuse(check, key, "found \"%s\", which is not an instant; did you mean \"%s\"?", name,
               best.name);
    else
        refuse(check, key, "found \"%s\", which is not an instant; expected one of %s", name,
               known);
}

static bool check_instant(const measure_check *check, const char *key, const char *name,
                          measure_instant *instant)
{
    if (!name[0]) // refused already
        return false;
    bool good = measure_instant_named(check->model, name, instant);
    if (!good)
        refuse_instant(check, key, name);
    return good;
}

// Whether the run begins with the first ignition.
static bool starts_ignited(const ld_model *model)
{
    return model_firing_count(model) > 0 &&
           !(0 - model_run(model)->lead_in < model_firing(model, 0)->at);
}

// Of a flight: that rockets fly, and that the window begins when they do.
static void check_flight(const measure_check *check, const ld_measure *measure,
                         measure_instant from)
{
    const char *begins = measure->take == LD_TAKE_VALUE ? "at" : "from";
    bool tip = model_has_launcher(check->model) && model_run(check->model)->end == LD_END_TIP;
    bool early = from.kind < INSTANT_EXIT || (from.kind == INSTANT_EXIT && from.adaptor > 0);
    if (tip)
        refuse(check, measure_is_of_flight(measure->from) ? begins : "to",
               "the window never occurs: with run.end: tip no rocket flies");
    else if (model_has_launcher(check->model) && early)
        refuse(check, begins, "the flight begins at t_rear; found \"%s\"", measure->from);
}

// Of a window in the tube: that it comes, and that the column is there until its end.
static void check_launch(const measure_check *check, const ld_measure *measure,
                         const quantity_group *group, measure_instant from, measure_instant to)
{
    const char *ends = measure->take == LD_TAKE_VALUE ? "at" : "to";
    if (from.kind == INSTANT_START && to.kind == INSTANT_IGNITION && starts_ignited(check->model))
        refuse(check, ends,
               "the window never occurs: without run.lead_in the run begins with the ignition");
    else if (group && group->where.type != QUANTITY_NONE && to.kind == INSTANT_END)
        refuse(check, ends,
               "%s is a column of a rocket in its tube, which t_rear ends; found \"end\"",
               measure->of);
}

// A window's ends in their order, and the column there from one to the other.
void measure_check_window(const measure_check *check, const ld_measure *measure)
{
    const bool value = measure->take == LD_TAKE_VALUE;
    const bool flight = measure_is_in_flight(check->model, measure);
    const quantity_group *group = measure->of[0] ? check_column(check, flight, measure->of) : NULL;
    measure_instant from, to;
    bool good = check_instant(check, value ? "at" : "from", measure->from, &from);
    if (value)
        to = from;
    else
        good &= check_instant(check, "to", measure->to, &to);
    if (!good)
        return;
    if (!value && measure_compare_instants(check->model, from, to) >= 0)
        refuse(check, "to", "the window never occurs: %s is not after %s", measure->to,
               measure->from);
    else if (!value && !(measure->within[1] > measure->within[0]))
        refuse(check, "within", "the window never occurs: it ends no later than it begins");
    else if (flight)
        check_flight(check, measure, from);
    else
        check_launch(check, measure, group, from, to);
}

void measure_check_name(const measure_check *check, const ld_measure *measure)
{
    const ld_measure *all = model_measure(check->model, 0);
    for (const ld_measure *before = all; before < measure; before++)
        if (measure->name[0] && strcmp(before->name, measure->name) == 0)
            refuse(check, "name", "measure %d has the same name", (int)(before - all) + 1);
}
