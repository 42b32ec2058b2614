#include "run/measure_expressions.h"

#include <stdio.h>
#include <string.h>

#include "base/suggestion.h"
#include "model/parts.h"
#include "quantities/summary_quantities.h"
#include "run/measure_check.h"

// The model, the measure and the window that is open.
typedef struct expressing {
    const ld_model *model;
    int item;
    measure_plans *plans;
    quantity_things things;
    ld_measure window; // its take and instants
    bool flight;
    column_search columns;
    const quantity_group *short_lived; // of a column asked for, which ends before the window does
} expressing;

// ---- results

// That of the name, as far as this measure knows; row NULL: none.
static quantity_walk result_named(const expressing *self, const char *name)
{
    quantity_walk found = quantity_find(&rocket_quantities, &self->things, name);
    bool later = found.row && found.group->each == EACH_MEASURE && found.item >= self->item;
    if (later || (found.row && found.group->launch && !self->things.launcher))
        found.row = NULL;
    return found;
}

// The number of a result among those that expressions name; -1: there are too many.
static int add_result(measure_plans *plans, const measure_result *result)
{
    int i = 0;
    while (i < plans->results && (plans->result[i].at.offset != result->at.offset ||
                                  plans->result[i].item != result->item))
        i++;
    if (i == MEASURE_MOST_RESULTS)
        return -1;
    plans->result[i] = *result;
    plans->results += i == plans->results;
    return i;
}

static int find_result(expressing *self, const char *name, const char **unit)
{
    const quantity_walk found = result_named(self, name);
    if (!found.row)
        return -1;
    *unit = quantity_unit(&found);
    return add_result(self->plans,
                      &(measure_result){found.group->where, found.row->at, found.item});
}

// ---- columns

static int find_column(expressing *self, const char *name, const char **unit)
{
    const quantity_walk found = measure_column_named(&self->columns, name);
    if (!found.row)
        return -1;
    bool ends = found.group->where.type != QUANTITY_NONE && !self->flight;
    self->short_lived = ends && strcmp(self->window.to, "end") == 0 ? found.group : NULL;
    *unit = found.row->unit;
    return self->short_lived ? -1 : measure_column_number(&self->columns, name);
}

static int find(void *context, bool over_time, const char *name, const char **unit)
{
    expressing *self = context;
    return over_time ? find_column(self, name, unit) : find_result(self, name, unit);
}

// ---- what is wrong with a name

static void explain_column(const expressing *self, const char *name, char why[EXPRESSION_WHY])
{
    const char *what = self->flight ? "the flight" : "the launch";
    char near[QUANTITY_NAME];
    measure_nearest_column(&self->columns, name, near);
    if (self->short_lived)
        snprintf(why, EXPRESSION_WHY,
                 "%s is a column of a rocket in its tube, which t_rear ends; found \"end\"", name);
    else if (*near)
        snprintf(why, EXPRESSION_WHY,
                 "found \"%s\", which is not a column of %s; did you mean \"%s\"?", name, what,
                 near);
    else
        snprintf(why, EXPRESSION_WHY,
                 "found \"%s\", which is not a column of %s; expected one of docs/quantities.md",
                 name, what);
}

// The result whose name is nearest, or "".
static void nearest_result(const expressing *self, const char *name, char near[QUANTITY_NAME])
{
    name_suggestion best = suggestion_begin(name);
    near[0] = 0;
    for (quantity_walk at = quantity_first(&rocket_quantities, &self->things); at.row;
         quantity_next(&at)) {
        char offered[QUANTITY_NAME];
        quantity_text(at.row->name, at.group->each, at.item, &self->things, offered,
                      sizeof offered);
        if (!result_named(self, offered).row)
            continue;
        suggestion_offer(&best, offered);
        if (best.name == offered) {
            memcpy(near, offered, sizeof offered);
            best.name = near;
        }
    }
}

static void explain_result(const expressing *self, const char *name, char why[EXPRESSION_WHY])
{
    const column_search columns = measure_columns(self->model, !self->things.launcher);
    char measure[QUANTITY_NAME], near[QUANTITY_NAME];
    snprintf(measure, sizeof measure, "measure.%s", name);
    nearest_result(self, name, near);
    if (result_named(self, measure).row)
        snprintf(near, sizeof near, "%s", measure);
    const quantity_walk any = quantity_find(&rocket_quantities, &self->things, name);
    if (any.row && any.group->each == EACH_MEASURE)
        snprintf(why, EXPRESSION_WHY, "found \"%s\"; expected a result or a measure listed before",
                 name);
    else if (!*near && measure_column_named(&columns, name).row)
        snprintf(why, EXPRESSION_WHY,
                 "found \"%s\", a column; expected a result, or the column over time, such as "
                 "largest(%s), or \"%s at t_rear\"",
                 name, name, name);
    else if (*near)
        snprintf(why, EXPRESSION_WHY, "found \"%s\", which is not a result; did you mean \"%s\"?",
                 name, near);
    else
        snprintf(why, EXPRESSION_WHY,
                 "found \"%s\", which is not a result; expected one of docs/quantities.md, such as "
                 "%s",
                 name, self->things.launcher ? "yaw_rate" : "apogee");
}

static void explain(void *context, bool over_time, const char *name, char why[EXPRESSION_WHY])
{
    if (over_time)
        explain_column(context, name, why);
    else
        explain_result(context, name, why);
}

// ---- windows

static void set_instant(char to[LD_MAX_QUANTITY], const char *given, const char *otherwise)
{
    snprintf(to, LD_MAX_QUANTITY, "%s", given[0] ? given : otherwise);
}

static bool open_window(void *context, const expression_window *window, char why[EXPRESSION_WHY])
{
    expressing *self = context;
    const bool launcher = self->things.launcher;
    const measure_check check = {.model = self->model, .number = self->item + 1, .why = why};
    self->window = (ld_measure){.take = window->take, .within = {0, 1e5}};
    set_instant(self->window.from, window->from, launcher ? "t_ignition" : "start");
    set_instant(self->window.to, window->to, launcher ? "t_rear" : "end");
    self->flight = measure_is_in_flight(self->model, &self->window);
    self->columns = measure_columns(self->model, self->flight);
    measure_check_window(&check, &self->window);
    return !why[0];
}

// Between the instants of a measure that is known to be good.
static bool plan_instants(const ld_model *model, const ld_measure *measure, measure_plan *plan)
{
    const char *to = measure->take == LD_TAKE_VALUE ? measure->from : measure->to;
    plan->flight = measure_is_in_flight(model, measure);
    plan->take = measure->take;
    plan->within[0] = measure->within[0];
    plan->within[1] = measure->within[1];
    return measure_instant_named(model, measure->from, &plan->from) &&
           measure_instant_named(model, to, &plan->to);
}

static int close_window(void *context, const expression_window *window, char why[EXPRESSION_WHY])
{
    expressing *self = context;
    measure_plans *plans = self->plans;
    const measure_result result = {.at = QUANTITY_EACH_OF(ld_rocket_summary, measure),
                                   .item = plans->count};
    if (plans->count == LD_MAX_TAKEN) {
        snprintf(why, EXPRESSION_WHY, "measures and figures over time are more than %d",
                 LD_MAX_TAKEN);
        return -1;
    }
    measure_plan *plan = &plans->plan[plans->count++];
    *plan = (measure_plan){.column = -1, .part = window->of};
    plan_instants(self->model, &self->window, plan);
    return add_result(plans, &result);
}

// ---- measures

bool measure_plan_window(const ld_model *model, const ld_measure *measure, measure_plan *plan)
{
    const column_search columns = measure_columns(model, measure_is_in_flight(model, measure));
    *plan = (measure_plan){.column = measure_column_number(&columns, measure->of)};
    return plan->column >= 0 && plan_instants(model, measure, plan);
}

bool measure_express(const ld_model *model, int i, measure_plans *plans, units_dimension *unit,
                     expression_refusal *refusal)
{
    expressing self = {
        .model = model, .item = i, .plans = plans, .things = quantity_things_of(model)};
    const expression_names names = {find, explain, open_window, close_window, &self};
    measure_plan *plan = &plans->plan[i];
    *plan = (measure_plan){.take = LD_TAKE_EXPRESSION, .column = -1};
    return expression_read(model_measure(model, i)->expression, &names, &plans->code, &plan->part,
                           unit, refusal);
}
