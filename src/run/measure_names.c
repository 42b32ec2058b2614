#include "run/measure_names.h"

#include <stdio.h>
#include <string.h>

#include "base/suggestion.h"
#include "flight/flight_history.h"
#include "model/guide.h"
#include "model/parts.h"
#include "state/history.h"
#include "systems/bases/base.h"

// ---- columns

bool measure_is_of_flight(const char *instant)
{
    return strcmp(instant, "t_burnout") == 0 || strcmp(instant, "t_apogee") == 0 ||
           strcmp(instant, "t_impact") == 0;
}

// Whether a measure is of a column of the flight.
bool measure_is_in_flight(const ld_model *model, const ld_measure *measure)
{
    return !model_has_launcher(model) || measure_is_of_flight(measure->from) ||
           measure_is_of_flight(measure->to);
}

// The tables of a launch's columns, or of a flight's; NULL: no more.
void measure_tables_of(const ld_model *model, bool flight,
                       const quantity_table *tables[MEASURE_TABLES])
{
    tables[0] = flight ? &flight_quantities : &launch_quantities;
    tables[1] = flight ? NULL : base_quantities(model_base(model)->kind);
    tables[2] = flight ? NULL : &balance_quantities;
}

column_search measure_columns(const ld_model *model, bool flight)
{
    const ld_modes *modes = &model_tubes(model)->modes;
    column_search search = {.things = quantity_things_of(model)};
    search.things.count[EACH_COORDINATE] = 2 * modes->bending + modes->torsion + modes->axial;
    search.things.count[EACH_EARTH] =
        flight && model_environment(model)->earth.kind != LD_EARTH_FLAT;
    measure_tables_of(model, flight, search.table);
    return search;
}

// Row NULL: there is none.
quantity_walk measure_column_named(const column_search *search, const char *name)
{
    quantity_walk found = {0};
    for (int i = 0; i < MEASURE_TABLES && !found.row; i++)
        if (search->table[i])
            found = quantity_find(search->table[i], &search->things, name);
    return found;
}

int measure_column_number(const column_search *search, const char *name)
{
    int number = 0;
    for (int i = 0; i < MEASURE_TABLES; i++) {
        if (!search->table[i])
            continue;
        quantity_walk at = quantity_first(search->table[i], &search->things);
        for (; at.row; quantity_next(&at), number++) {
            char offered[QUANTITY_NAME];
            quantity_text(at.row->name, at.group->each, at.item, &search->things, offered,
                          sizeof offered);
            if (strcmp(offered, name) == 0)
                return number;
        }
    }
    return -1;
}

// The name that may be meant, or "".
void measure_nearest_column(const column_search *search, const char *name, char near[QUANTITY_NAME])
{
    name_suggestion best = suggestion_begin(name);
    near[0] = 0;
    for (int i = 0; i < MEASURE_TABLES; i++) {
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

const char *measure_unit(const ld_model *model, int item)
{
    const ld_measure *measure = model_measure(model, item);
    const quantity_table *tables[MEASURE_TABLES];
    const quantity *row = NULL;
    if (measure->take == LD_TAKE_EXPRESSION)
        return measure->unit;
    measure_tables_of(model, measure_is_in_flight(model, measure), tables);
    for (int i = 0; i < MEASURE_TABLES && !row; i++)
        row = tables[i] ? quantity_like(tables[i], measure->of) : NULL;
    return row ? row->unit : "";
}

const char *quantity_unit(const quantity_walk *at)
{
    return at->row->unit ? at->row->unit : measure_unit(at->things->model, at->item);
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

int measure_list_instants(const ld_model *model, char exits[LD_MAX_ADAPTORS][LD_MAX_QUANTITY],
                          instant_row row[MEASURE_MOST_INSTANTS])
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

bool measure_instant_named(const ld_model *model, const char *name, measure_instant *instant)
{
    char exits[LD_MAX_ADAPTORS][LD_MAX_QUANTITY];
    instant_row row[MEASURE_MOST_INSTANTS];
    int count = measure_list_instants(model, exits, row);
    for (int i = 0; i < count; i++)
        if (strcmp(row[i].name, name) == 0) {
            *instant = row[i].instant;
            return true;
        }
    return false;
}

// Which comes first: of exits that at the lesser travel; the motor may burn beyond the apogee.
int measure_compare_instants(const ld_model *model, measure_instant a, measure_instant b)
{
    const ld_adaptor *adaptor = model_rocket(model)->adaptor;
    const ld_tubes *tubes = model_tubes(model);
    if (a.kind == INSTANT_APOGEE && b.kind == INSTANT_BURNOUT)
        return -1;
    if (a.kind != b.kind || a.kind != INSTANT_EXIT)
        return (a.kind > b.kind) - (a.kind < b.kind);
    double later = guide_exit_station(tubes, &adaptor[a.adaptor]) -
                   guide_exit_station(tubes, &adaptor[b.adaptor]);
    return (later > GUIDE_TOGETHER) - (later < -GUIDE_TOGETHER);
}
