#include "simulation/quantity.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

int quantity_count(quantity_each each, const quantity_things *things)
{
    const ld_model *model = things->model;
    bool vehicle = model_has_vehicle(model);
    switch (each) {
    case EACH_VEHICLE:
        return vehicle;
    case EACH_EARTH:
        return model->environment.earth.kind != LD_EARTH_FLAT;
    case EACH_COORDINATE:
        return things->coordinates;
    case EACH_ADAPTOR:
        return model->rocket.adaptor_count;
    case EACH_HINGE:
        return vehicle ? 2 : 0;
    case EACH_WHEEL:
        return vehicle ? model->base.vehicle.wheel_count : 0;
    default:
        return 1;
    }
}

void quantity_text(const char *text, quantity_each each, int item, const quantity_things *things,
                   char *to, size_t size)
{
    static const char *const hinges[] = {"azimuth", "elevation"};
    const ld_model *model = things->model;
    const char *mark = strstr(text, "%s"), *name = "";
    char number[16];
    snprintf(number, sizeof number, "%d", item + 1);
    if (each == EACH_ADAPTOR)
        name = model->rocket.adaptor[item].name;
    else if (each == EACH_WHEEL)
        name = model->base.vehicle.wheel[item].name;
    else if (each == EACH_HINGE)
        name = hinges[item];
    else if (each == EACH_COORDINATE)
        name = number;
    if (mark)
        snprintf(to, size, "%.*s%s%s", (int)(mark - text), text, name, mark + 2);
    else
        snprintf(to, size, "%s", text);
}

// Leaves groups of which there is nothing.
static void settle(quantity_walk *walk)
{
    const quantity_table *table = walk->table;
    while (walk->at_group < table->groups &&
           walk->item >= quantity_count(table->group[walk->at_group].each, walk->things)) {
        walk->at_group++;
        walk->item = walk->at_row = 0;
    }
    bool there = walk->at_group < table->groups;
    walk->group = there ? &table->group[walk->at_group] : NULL;
    walk->row = there ? &walk->group->row[walk->at_row] : NULL;
}

quantity_walk quantity_first(const quantity_table *table, const quantity_things *things)
{
    quantity_walk walk = {.table = table, .things = things};
    settle(&walk);
    return walk;
}

void quantity_next(quantity_walk *walk)
{
    if (++walk->at_row == walk->group->rows) {
        walk->at_row = 0;
        walk->item++;
    }
    settle(walk);
}

quantity_walk quantity_find(const quantity_table *table, const quantity_things *things,
                            const char *name)
{
    quantity_walk walk = quantity_first(table, things);
    for (; walk.row; quantity_next(&walk)) {
        char text[QUANTITY_NAME];
        quantity_text(walk.row->name, walk.group->each, walk.item, things, text, sizeof text);
        if (strcmp(text, name) == 0)
            break;
    }
    return walk;
}

static bool is_like(const char *pattern, const char *name)
{
    const char *mark = strstr(pattern, "%s");
    if (!mark)
        return strcmp(pattern, name) == 0;
    size_t before = (size_t)(mark - pattern), after = strlen(mark + 2), length = strlen(name);
    return length > before + after && strncmp(pattern, name, before) == 0 &&
           strcmp(name + length - after, mark + 2) == 0;
}

const quantity *quantity_like(const quantity_table *table, const char *name)
{
    for (int i = 0; i < table->groups; i++)
        for (int k = 0; k < table->group[i].rows; k++)
            if (is_like(table->group[i].row[k].name, name))
                return &table->group[i].row[k];
    return NULL;
}

double quantity_number(const quantity_place *place, int item, const void *from)
{
    const char *at = (const char *)from + place->offset + (size_t)item * place->stride;
    switch (place->type) {
    case QUANTITY_NUMBER:
        return *(const double *)(const void *)at;
    case QUANTITY_INT:
        return *(const int *)(const void *)at;
    case QUANTITY_INT64:
        return (double)*(const int64_t *)(const void *)at;
    case QUANTITY_BOOL:
        return *(const bool *)at;
    default:
        return NAN;
    }
}

void quantity_put(const quantity_place *place, int item, double value, void *in)
{
    char *at = (char *)in + place->offset + (size_t)item * place->stride;
    memcpy(at, &value, sizeof value);
}

bool quantity_is_there(const quantity_group *group, const void *from)
{
    return group->where.type == QUANTITY_NONE || quantity_number(&group->where, 0, from) != 0;
}

double quantity_value(const quantity_walk *at, const void *from)
{
    return quantity_is_there(at->group, from) ? quantity_number(&at->row->at, at->item, from) : NAN;
}

void quantity_archive(const quantity_table *table, const quantity_things *things, void *in,
                      archive *bytes)
{
    for (quantity_walk at = quantity_first(table, things); at.row; quantity_next(&at)) {
        if (at.row->at.type != QUANTITY_NUMBER || !quantity_is_there(at.group, in))
            continue;
        double value = quantity_number(&at.row->at, at.item, in);
        archive_double(bytes, &value);
        if (bytes->loading)
            quantity_put(&at.row->at, at.item, value, in);
    }
}
