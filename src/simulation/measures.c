#include "simulation/measures.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/suggestion.h"
#include "simulation/launch_quantities.h"
#include "systems/base.h"

// ---- columns

enum { TABLES = 3 };

// The tables of a launch's columns; one is NULL where the base has none of its own.
static void tables_of(const ld_model *model, const quantity_table *tables[TABLES])
{
    tables[0] = &launch_quantities;
    tables[1] = base_quantities(model->base.kind);
    tables[2] = &balance_quantities;
}

const char *measure_unit(const ld_model *model, int item)
{
    const quantity_table *tables[TABLES];
    const quantity *row = NULL;
    tables_of(model, tables);
    for (int i = 0; i < TABLES && !row; i++)
        row = tables[i] ? quantity_like(tables[i], model->measure[item].of) : NULL;
    return row ? row->unit : "";
}

const char *quantity_unit(const quantity_walk *at)
{
    return at->row->unit ? at->row->unit : measure_unit(at->things->model, at->item);
}

// What a column is looked for among.
typedef struct column_search {
    quantity_things things;
    const quantity_table *table[TABLES];
} column_search;

static column_search search_in(const ld_model *model)
{
    const ld_modes *modes = &model->tubes.modes;
    column_search search = {.things = quantity_things_of(model)};
    search.things.count[EACH_COORDINATE] = 2 * modes->bending + modes->torsion + modes->axial;
    tables_of(model, search.table);
    return search;
}

// Group NULL: there is none.
static quantity_walk column_named(const column_search *search, const char *name)
{
    quantity_walk found = {0};
    for (int i = 0; i < TABLES && !found.row; i++)
        if (search->table[i])
            found = quantity_find(search->table[i], &search->things, name);
    return found;
}

// The name that may be meant, or "".
static void nearest_column(const column_search *search, const char *name, char near[QUANTITY_NAME])
{
    name_suggestion best = suggestion_begin(name);
    near[0] = 0;
    for (int i = 0; i < TABLES; i++) {
        if (!search->table[i])
            continue;
        quantity_walk at = quantity_first(search->table[i], &search->things);
        for (; at.row; quantity_next(&at)) {
            char offered[QUANTITY_NAME];
            quantity_text(at.row->name, at.group->each, at.item, &search->things, offered,
                          sizeof offered);
            suggestion_offer(&best, offered);
            if (best.name == offered) {
                memcpy(near, offered, sizeof offered);
                best.name = near;
            }
        }
    }
}

// ---- instants

static int foremost(const ld_rocket *rocket)
{
    int front = 0;
    for (int i = 1; i < rocket->adaptor_count; i++)
        if (rocket->adaptor[i].at > rocket->adaptor[front].at)
            front = i;
    return front;
}

// Of exactly three adaptors the one that is neither the front nor the rear one.
static int middle(const ld_rocket *rocket)
{
    return rocket->adaptor_count == 3 ? 3 - foremost(rocket) : -1;
}

typedef struct instant_row {
    const char *name;
    measure_instant instant;
} instant_row;

// The instants of a model's rockets, in their order of time but for exits of single adaptors.
enum { MOST_INSTANTS = 7 + LD_MAX_ADAPTORS };

static int list_instants(const ld_model *model, char exits[LD_MAX_ADAPTORS][LD_MAX_QUANTITY],
                         instant_row row[MOST_INSTANTS])
{
    const ld_rocket *rocket = &model->rocket;
    int count = 0;
    row[count++] = (instant_row){"start", {INSTANT_START, 0}};
    row[count++] = (instant_row){"t_ignition", {INSTANT_IGNITION, 0}};
    if (rocket->lock.present)
        row[count++] = (instant_row){"t_release", {INSTANT_RELEASE, 0}};
    row[count++] = (instant_row){"t_front", {INSTANT_EXIT, foremost(rocket)}};
    if (middle(rocket) > 0)
        row[count++] = (instant_row){"t_middle", {INSTANT_EXIT, middle(rocket)}};
    row[count++] = (instant_row){"t_rear", {INSTANT_EXIT, 0}};
    row[count++] = (instant_row){"end", {INSTANT_END, 0}};
    for (int i = 0; i < rocket->adaptor_count; i++) {
        snprintf(exits[i], sizeof exits[i], "t_exit.%s", rocket->adaptor[i].name);
        row[count++] = (instant_row){exits[i], {INSTANT_EXIT, i}};
    }
    return count;
}

static bool instant_named(const ld_model *model, const char *name, measure_instant *instant)
{
    char exits[LD_MAX_ADAPTORS][LD_MAX_QUANTITY];
    instant_row row[MOST_INSTANTS];
    int count = list_instants(model, exits, row);
    for (int i = 0; i < count; i++)
        if (strcmp(row[i].name, name) == 0) {
            *instant = row[i].instant;
            return true;
        }
    return false;
}

// Which comes first: of exits that of the adaptor farther forward.
static int compare(const ld_model *model, measure_instant a, measure_instant b)
{
    const ld_adaptor *adaptor = model->rocket.adaptor;
    if (a.kind != b.kind || a.kind != INSTANT_EXIT)
        return (a.kind > b.kind) - (a.kind < b.kind);
    return (adaptor[a.adaptor].at < adaptor[b.adaptor].at) -
           (adaptor[a.adaptor].at > adaptor[b.adaptor].at);
}

// ---- what is wrong with a measure

typedef struct measure_check {
    const ld_model *model;
    rule_report *report;
    void *self;
    int number; // of the measure, from 1
} measure_check;

static void refuse(const measure_check *check, const char *key, const char *format, ...)
    LD_PRINTF(3, 4);
static void refuse(const measure_check *check, const char *key, const char *format, ...)
{
    char path[64], text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    snprintf(path, sizeof path, "measures.%d.%s", check->number, key);
    check->report(check->self, path, text);
}

// The column, or a group NULL after a message.
static const quantity_group *check_column(const measure_check *check, const char *name)
{
    const column_search search = search_in(check->model);
    const quantity_walk found = column_named(&search, name);
    char near[QUANTITY_NAME];
    if (found.row)
        return found.group;
    nearest_column(&search, name, near);
    if (*near)
        refuse(check, "of", "found \"%s\", no column of the launch; did you mean \"%s\"?", name,
               near);
    else
        refuse(check, "of",
               "found \"%s\", no column of the launch; expected one of docs/quantities.md, such as "
               "tip.pitch_rate",
               name);
    return NULL;
}

static void refuse_instant(const measure_check *check, const char *key, const char *name)
{
    char exits[LD_MAX_ADAPTORS][LD_MAX_QUANTITY], known[512] = "";
    instant_row row[MOST_INSTANTS];
    int count = list_instants(check->model, exits, row);
    name_suggestion best = suggestion_begin(name);
    for (int i = 0; i < count; i++) {
        size_t length = strlen(known);
        suggestion_offer(&best, row[i].name);
        snprintf(known + length, sizeof known - length, "%s%s", i ? ", " : "", row[i].name);
    }
    if (strcmp(name, "t_middle") == 0)
        refuse(check, key,
               "found \"t_middle\", which is of exactly three adaptors; the rocket has %d",
               check->model->rocket.adaptor_count);
    else if (strcmp(name, "t_release") == 0)
        refuse(check, key, "found \"t_release\", but the rocket has no lock");
    else if (best.name)
        refuse(check, key, "found \"%s\", no instant; did you mean \"%s\"?", name, best.name);
    else
        refuse(check, key, "found \"%s\", no instant; expected one of %s", name, known);
}

static bool check_instant(const measure_check *check, const char *key, const char *name,
                          measure_instant *instant)
{
    if (!name[0]) // refused already
        return false;
    bool good = instant_named(check->model, name, instant);
    if (!good)
        refuse_instant(check, key, name);
    return good;
}

// Whether the run begins with the first ignition.
static bool starts_lit(const ld_model *model)
{
    return model->firing_count > 0 && !(0 - model->run.lead_in < model->firing[0].at);
}

// A window's ends in their order, and the column there from one to the other.
static void check_window(const measure_check *check, const ld_measure *measure,
                         const quantity_group *group)
{
    const bool value = measure->take == LD_TAKE_VALUE;
    const char *begins = value ? "at" : "from", *ends = value ? "at" : "to";
    measure_instant from, to;
    bool good = check_instant(check, begins, measure->from, &from);
    if (!value)
        good &= check_instant(check, ends, measure->to, &to);
    else
        to = from;
    if (!good)
        return;
    if (!value && compare(check->model, from, to) >= 0)
        refuse(check, ends, "the window never comes: %s is not after %s", measure->to,
               measure->from);
    else if (!value && from.kind == INSTANT_START && to.kind == INSTANT_IGNITION &&
             starts_lit(check->model))
        refuse(check, ends,
               "the window never comes: without run.lead_in the run begins with the "
               "ignition");
    else if (group && group->where.type != QUANTITY_NONE && to.kind == INSTANT_END)
        refuse(check, ends, "%s is of a rocket in its tube, which t_rear ends; found \"end\"",
               measure->of);
}

static void check_name(const measure_check *check, const ld_measure *measure)
{
    const ld_measure *all = check->model->measure;
    for (const ld_measure *before = all; before < measure; before++)
        if (measure->name[0] && strcmp(before->name, measure->name) == 0)
            refuse(check, "name", "measure %d has this name, too", (int)(before - all) + 1);
}

void measures_check(const ld_model *model, rule_report *report, void *self)
{
    for (int i = 0; i < model->measure_count && model_has_launcher(model); i++) {
        const ld_measure *measure = &model->measure[i];
        const measure_check check = {model, report, self, i + 1};
        check_name(&check, measure);
        check_window(&check, measure, measure->of[0] ? check_column(&check, measure->of) : NULL);
    }
}

// ---- how it is taken

typedef struct first_refusal {
    ld_error *error;
    ld_status status;
} first_refusal;

static void keep_first(void *self, const char *path, const char *text)
{
    first_refusal *first = self;
    if (!first->status)
        first->status = ld_fail(first->error, LD_ERR_INPUT, "%s: %s", path, text);
}

static int number_of(const quantity_columns *columns, const char *name)
{
    int i = 0;
    while (i < columns->count && strcmp(columns->column[i].name, name) != 0)
        i++;
    return i;
}

ld_status measures_build(const ld_model *model, const quantity_columns *columns,
                         measure_plan plan[LD_MAX_MEASURES], ld_error *error)
{
    first_refusal first = {error, LD_OK};
    measures_check(model, keep_first, &first);
    for (int i = 0; i < model->measure_count && !first.status; i++) {
        const ld_measure *measure = &model->measure[i];
        const char *to = measure->take == LD_TAKE_VALUE ? measure->from : measure->to;
        plan[i] = (measure_plan){.column = number_of(columns, measure->of), .take = measure->take};
        bool known = plan[i].column < columns->count &&
                     instant_named(model, measure->from, &plan[i].from) &&
                     instant_named(model, to, &plan[i].to);
        assert(known);
    }
    return first.status;
}
