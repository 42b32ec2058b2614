#include "run/measures.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/suggestion.h"
#include "flight/flight_history.h"
#include "model/blocks/firing.h"
#include "model/parts.h"
#include "state/history.h"
#include "systems/bases/base.h"

// ---- columns

enum { TABLES = 3 };

static bool is_of_flight(const char *instant)
{
    return strcmp(instant, "t_burnout") == 0 || strcmp(instant, "t_apogee") == 0 ||
           strcmp(instant, "t_impact") == 0;
}

// Whether a measure is of a column of the flight.
static bool is_in_flight(const ld_model *model, const ld_measure *measure)
{
    return !model_has_launcher(model) || is_of_flight(measure->from) || is_of_flight(measure->to);
}

// The tables of a launch's columns, or of a flight's; NULL: no more.
static void tables_of(const ld_model *model, bool flight, const quantity_table *tables[TABLES])
{
    tables[0] = flight ? &flight_quantities : &launch_quantities;
    tables[1] = flight ? NULL : base_quantities(model_base(model)->kind);
    tables[2] = flight ? NULL : &balance_quantities;
}

const char *measure_unit(const ld_model *model, int item)
{
    const quantity_table *tables[TABLES];
    const quantity *row = NULL;
    tables_of(model, is_in_flight(model, model_measure(model, item)), tables);
    for (int i = 0; i < TABLES && !row; i++)
        row = tables[i] ? quantity_like(tables[i], model_measure(model, item)->of) : NULL;
    return row ? row->unit : "";
}

const char *quantity_unit(const quantity_walk *at)
{
    return at->row->unit ? at->row->unit : measure_unit(at->things->model, at->item);
}

// What a column is searched among.
typedef struct column_search {
    quantity_things things;
    const quantity_table *table[TABLES];
} column_search;

static column_search search_in(const ld_model *model, bool flight)
{
    const ld_modes *modes = &model_tubes(model)->modes;
    column_search search = {.things = quantity_things_of(model)};
    search.things.count[EACH_COORDINATE] = 2 * modes->bending + modes->torsion + modes->axial;
    search.things.count[EACH_EARTH] =
        flight && model_environment(model)->earth.kind != LD_EARTH_FLAT;
    tables_of(model, flight, search.table);
    return search;
}

// Row NULL: there is none.
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

static int foremost_adaptor(const ld_rocket *rocket)
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
    return rocket->adaptor_count == 3 ? 3 - foremost_adaptor(rocket) : -1;
}

typedef struct instant_row {
    const char *name;
    measure_instant instant;
} instant_row;

// The instants of a model's rockets, in their order of time but for exits of single adaptors; those
// of a flight in the order in which they most often come.
enum { MOST_INSTANTS = 10 + LD_MAX_ADAPTORS };

// Those in the tube: how many.
static int list_tube_instants(const ld_model *model, char exits[LD_MAX_ADAPTORS][LD_MAX_QUANTITY],
                              instant_row *row)
{
    const ld_rocket *rocket = model_rocket(model);
    int count = 0;
    row[count++] = (instant_row){"t_ignition", {INSTANT_IGNITION, 0}};
    if (rocket->lock.present)
        row[count++] = (instant_row){"t_release", {INSTANT_RELEASE, 0}};
    row[count++] = (instant_row){"t_front", {INSTANT_EXIT, foremost_adaptor(rocket)}};
    if (middle(rocket) > 0)
        row[count++] = (instant_row){"t_middle", {INSTANT_EXIT, middle(rocket)}};
    row[count++] = (instant_row){"t_rear", {INSTANT_EXIT, 0}};
    for (int i = 0; i < rocket->adaptor_count; i++) {
        snprintf(exits[i], sizeof exits[i], "t_exit.%s", rocket->adaptor[i].name);
        row[count++] = (instant_row){exits[i], {INSTANT_EXIT, i}};
    }
    return count;
}

static int list_instants(const ld_model *model, char exits[LD_MAX_ADAPTORS][LD_MAX_QUANTITY],
                         instant_row row[MOST_INSTANTS])
{
    int count = 0;
    row[count++] = (instant_row){"start", {INSTANT_START, 0}};
    if (model_has_launcher(model))
        count += list_tube_instants(model, exits, row + count);
    row[count++] = (instant_row){"t_burnout", {INSTANT_BURNOUT, 0}};
    row[count++] = (instant_row){"t_apogee", {INSTANT_APOGEE, 0}};
    row[count++] = (instant_row){"t_impact", {INSTANT_IMPACT, 0}};
    row[count++] = (instant_row){"end", {INSTANT_END, 0}};
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

// Which comes first: of exits that of the adaptor farther forward; the motor may burn beyond the
// apogee.
static int compare(const ld_model *model, measure_instant a, measure_instant b)
{
    const ld_adaptor *adaptor = model_rocket(model)->adaptor;
    if (a.kind == INSTANT_APOGEE && b.kind == INSTANT_BURNOUT)
        return -1;
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

// The column, or NULL after a message.
static const quantity_group *check_column(const measure_check *check, bool flight, const char *name)
{
    const column_search search = search_in(check->model, flight);
    const char *what = flight ? "the flight" : "the launch";
    const quantity_walk found = column_named(&search, name);
    char near[QUANTITY_NAME];
    if (found.row)
        return found.group;
    nearest_column(&search, name, near);
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
    instant_row row[MOST_INSTANTS];
    int count = list_instants(check->model, exits, row);
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
    bool good = instant_named(check->model, name, instant);
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
        refuse(check, is_of_flight(measure->from) ? begins : "to",
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
static void check_window(const measure_check *check, const ld_measure *measure)
{
    const bool value = measure->take == LD_TAKE_VALUE, flight = is_in_flight(check->model, measure);
    const quantity_group *group = measure->of[0] ? check_column(check, flight, measure->of) : NULL;
    measure_instant from, to;
    bool good = check_instant(check, value ? "at" : "from", measure->from, &from);
    if (value)
        to = from;
    else
        good &= check_instant(check, "to", measure->to, &to);
    if (!good)
        return;
    if (!value && compare(check->model, from, to) >= 0)
        refuse(check, "to", "the window never occurs: %s is not after %s", measure->to,
               measure->from);
    else if (!value && !(measure->within[1] > measure->within[0]))
        refuse(check, "within", "the window never occurs: it ends no later than it begins");
    else if (flight)
        check_flight(check, measure, from);
    else
        check_launch(check, measure, group, from, to);
}

static void check_name(const measure_check *check, const ld_measure *measure)
{
    const ld_measure *all = model_measure(check->model, 0);
    for (const ld_measure *before = all; before < measure; before++)
        if (measure->name[0] && strcmp(before->name, measure->name) == 0)
            refuse(check, "name", "measure %d has the same name", (int)(before - all) + 1);
}

void measures_check(const ld_model *model, rule_report *report, void *self)
{
    for (int i = 0; i < model_measure_count(model); i++) {
        const ld_measure *measure = model_measure(model, i);
        const measure_check check = {model, report, self, i + 1};
        check_name(&check, measure);
        check_window(&check, measure);
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

// The place of a column in a row, columns standing in the order of the tables.
static int column_number(const ld_model *model, const ld_measure *measure)
{
    const column_search search = search_in(model, is_in_flight(model, measure));
    int number = 0;
    for (int i = 0; i < TABLES; i++) {
        if (!search.table[i])
            continue;
        quantity_walk at = quantity_first(search.table[i], &search.things);
        for (; at.row; quantity_next(&at), number++) {
            char name[QUANTITY_NAME];
            quantity_text(at.row->name, at.group->each, at.item, &search.things, name, sizeof name);
            if (strcmp(name, measure->of) == 0)
                return number;
        }
    }
    return -1;
}

ld_status measures_build(const ld_model *model, measure_plan plan[LD_MAX_MEASURES], ld_error *error)
{
    first_refusal first = {error, LD_OK};
    measures_check(model, keep_first, &first);
    for (int i = 0; i < model_measure_count(model) && !first.status; i++) {
        const ld_measure *measure = model_measure(model, i);
        const char *to = measure->take == LD_TAKE_VALUE ? measure->from : measure->to;
        plan[i] = (measure_plan){.flight = is_in_flight(model, measure),
                                 .column = column_number(model, measure),
                                 .take = measure->take,
                                 .within = {measure->within[0], measure->within[1]}};
        bool known = plan[i].column >= 0 && instant_named(model, measure->from, &plan[i].from) &&
                     instant_named(model, to, &plan[i].to);
        assert(known);
    }
    return first.status;
}
