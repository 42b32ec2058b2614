#include "run/measures.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "model/model.h"
#include "model/parts.h"
#include "run/measure_check.h"
#include "run/measure_expressions.h"

void measures_complete(ld_model *model)
{
    measure_plans plans = {.count = model->measure_count};
    expression_refusal refusal;
    for (int i = 0; i < model->measure_count; i++) {
        ld_measure *measure = &model->measure[i];
        units_dimension unit;
        if (measure->take == LD_TAKE_EXPRESSION && measure->expression &&
            measure_express(model, i, &plans, &unit, &refusal))
            units_write(&unit, measure->unit);
    }
}

// ---- what is wrong

// Plans the expression of measure i, or says at which character it is wrong.
static void plan_expression(const measure_check *check, int i, measure_plans *plans)
{
    char path[64];
    expression_refusal refusal;
    units_dimension unit;
    if (!model_measure(check->model, i)->expression) // refused already
        return;
    if (measure_express(check->model, i, plans, &unit, &refusal))
        return;
    snprintf(path, sizeof path, "measures.%d.expression@%d", i + 1, refusal.at);
    check->report(check->self, path, refusal.why);
}

// Plans what can be, and reports what cannot.
static void plan_all(const ld_model *model, measure_plans *plans, rule_report *report, void *self)
{
    *plans = (measure_plans){.count = model_measure_count(model)};
    for (int i = 0; i < model_measure_count(model); i++) {
        const ld_measure *measure = model_measure(model, i);
        const measure_check check = {model, report, self, i + 1, NULL};
        measure_check_name(&check, measure);
        if (measure->take == LD_TAKE_EXPRESSION)
            plan_expression(&check, i, plans);
        else
            measure_check_window(&check, measure);
    }
}

void measures_check(const ld_model *model, rule_report *report, void *self)
{
    measure_plans plans;
    plan_all(model, &plans, report, self);
}

// ---- how they are taken

typedef struct first_refusal {
    ld_error *error;
    ld_status status;
} first_refusal;

static void keep_first(void *self, const char *path, const char *text)
{
    first_refusal *first = self;
    if (!first->status)
        first->status =
            ld_fail(first->error, LD_ERR_INPUT, "%.*s: %s", (int)strcspn(path, "@"), path, text);
}

ld_status measures_build(const ld_model *model, measure_plans *plans, ld_error *error)
{
    first_refusal first = {error, LD_OK};
    plan_all(model, plans, keep_first, &first);
    for (int i = 0; i < model_measure_count(model) && !first.status; i++) {
        const ld_measure *measure = model_measure(model, i);
        if (measure->take == LD_TAKE_EXPRESSION)
            continue;
        bool known = measure_plan_window(model, measure, &plans->plan[i]);
        assert(known);
    }
    return first.status;
}
