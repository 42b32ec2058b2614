#include "quantities/quantity_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/blocks/base.h"
#include "model/blocks/measure.h"
#include "model/blocks/rocket.h"
#include "model/blocks/tubes.h"
#include "model/blocks/vehicle.h"
#include "model/parts.h"

// The first name of the joints of a kind.
static const char *joints_of(const ld_mechanism *parts, ld_joint_kind kind)
{
    return (const char *)(parts->joint_name + parts->named[kind].first);
}

quantity_things quantity_things_of(const ld_model *model)
{
    static const char hinges[2][16] = {"azimuth", "elevation"};
    int hinge_count = model ? model_hinge_count(model) : 0;
    if (!model)
        return (quantity_things){0};
    bool on_vehicle = model_has_vehicle(model);
    const ld_rocket *rocket = model_rocket(model);
    const ld_tubes *tubes = model_tubes(model);
    const ld_vehicle *vehicle = &model_base(model)->vehicle;
    const ld_measure *measure = model_measure(model, 0);
    const ld_mechanism *parts = &model_base(model)->mechanism;
    bool multibody = model_has_multibody(model);
    bool canopies = rocket->parachute[0].canopy.present; // all of them or none
    return (quantity_things){
        .count = {[EACH_RUN] = 1,
                  [EACH_VEHICLE] = on_vehicle,
                  [EACH_SLOT] = model_has_slot(model),
                  [EACH_CROSSFLOW] = model_has_crossflow(model),
                  [EACH_OPEN_AIR] = model_has_open_air(model),
                  [EACH_JET] = model_has_jet(model),
                  [EACH_PRESSURE] = model_has_pressure(model),
                  [EACH_SLIDE_WORK] = model_slide_count(model) > 0,
                  [EACH_SLIDE] = model_slide_count(model),
                  [EACH_ADAPTOR] = rocket->adaptor_count,
                  [EACH_SHOE] = model_has_surfaces(model) ? rocket->adaptor_count : 0,
                  [EACH_HINGE] = hinge_count,
                  [EACH_WHEEL] = on_vehicle ? vehicle->wheel_count : 0,
                  [EACH_MULTIBODY] = multibody,
                  [EACH_ROLLING] = multibody && vehicle->wheel_count > 0,
                  [EACH_BODY] = multibody ? parts->body_count : 0,
                  [EACH_BEAM] = multibody ? parts->beam_count : 0,
                  [EACH_BEAM_COORDINATE] = multibody ? mechanism_beam_coordinates(parts) : 0,
                  [EACH_CARRIER] = multibody && mechanism_has_carrier(parts),
                  [EACH_JOINT] = multibody ? parts->joint_count : 0,
                  [EACH_TURN] = multibody ? parts->named[LD_JOINT_REVOLUTE].count : 0,
                  [EACH_SLIDER] = multibody ? parts->named[LD_JOINT_PRISMATIC].count : 0,
                  [EACH_CYLINDER] = multibody ? parts->named[LD_JOINT_CYLINDRICAL].count : 0,
                  [EACH_UNIVERSAL] = multibody ? parts->named[LD_JOINT_UNIVERSAL].count : 0,
                  [EACH_PLANE] = multibody ? parts->named[LD_JOINT_PLANAR].count : 0,
                  [EACH_BALL] = multibody ? parts->named[LD_JOINT_SPHERICAL].count : 0,
                  [EACH_DRIVE] = multibody ? parts->drive_count : 0,
                  [EACH_STRUT] = multibody ? parts->strut_count : 0,
                  [EACH_FOOT] = multibody ? parts->foot_count : 0,
                  [EACH_BUSHING] = multibody ? parts->bushing_count : 0,
                  [EACH_ROLLER] = multibody ? vehicle->wheel_count : 0,
                  [EACH_MEASURE] = model_measure_count(model),
                  [EACH_LINE] = rocket->line.present,
                  [EACH_GUIDE_WIND] = model_has_guide_wind(model),
                  [EACH_GUIDE_JET] = model_has_guide_jet(model),
                  [EACH_DEFLECTOR] = model_has_launcher(model) && tubes->deflector.present,
                  [EACH_PARACHUTE] = canopies ? 0 : rocket->parachute_count,
                  [EACH_CANOPY] = canopies ? rocket->parachute_count : 0,
                  [EACH_LINE_PLACE] = rocket->line.present ? LD_LINE_PLACES : 0,
                  [EACH_STATION] = tubes->station_count,
                  [EACH_SUPPORT] = tubes->station_count ? tubes->support_count : 0},
        .name = {[EACH_ADAPTOR] = rocket->adaptor[0].name,
                 [EACH_SHOE] = rocket->adaptor[0].name,
                 [EACH_HINGE] = hinges[hinge_count == 1],
                 [EACH_WHEEL] = vehicle->wheel[0].name,
                 [EACH_BODY] = parts->body[0].name,
                 [EACH_BEAM] = parts->beam[0].name,
                 [EACH_JOINT] = parts->joint[0].name,
                 [EACH_TURN] = joints_of(parts, LD_JOINT_REVOLUTE),
                 [EACH_SLIDER] = joints_of(parts, LD_JOINT_PRISMATIC),
                 [EACH_CYLINDER] = joints_of(parts, LD_JOINT_CYLINDRICAL),
                 [EACH_UNIVERSAL] = joints_of(parts, LD_JOINT_UNIVERSAL),
                 [EACH_PLANE] = joints_of(parts, LD_JOINT_PLANAR),
                 [EACH_BALL] = joints_of(parts, LD_JOINT_SPHERICAL),
                 [EACH_DRIVE] = parts->drive[0].name,
                 [EACH_STRUT] = parts->strut[0].name,
                 [EACH_FOOT] = parts->foot[0].name,
                 [EACH_BUSHING] = parts->bushing[0].name,
                 [EACH_ROLLER] = vehicle->wheel[0].name,
                 [EACH_MEASURE] = measure->name,
                 [EACH_PARACHUTE] = rocket->parachute[0].name,
                 [EACH_CANOPY] = rocket->parachute[0].name},
        .stride = {[EACH_ADAPTOR] = sizeof rocket->adaptor[0],
                   [EACH_SHOE] = sizeof rocket->adaptor[0],
                   [EACH_HINGE] = sizeof hinges[0],
                   [EACH_WHEEL] = sizeof vehicle->wheel[0],
                   [EACH_BODY] = sizeof parts->body[0],
                   [EACH_BEAM] = sizeof parts->beam[0],
                   [EACH_JOINT] = sizeof parts->joint[0],
                   [EACH_TURN] = sizeof parts->joint_name[0],
                   [EACH_SLIDER] = sizeof parts->joint_name[0],
                   [EACH_CYLINDER] = sizeof parts->joint_name[0],
                   [EACH_UNIVERSAL] = sizeof parts->joint_name[0],
                   [EACH_PLANE] = sizeof parts->joint_name[0],
                   [EACH_BALL] = sizeof parts->joint_name[0],
                   [EACH_DRIVE] = sizeof parts->drive[0],
                   [EACH_STRUT] = sizeof parts->strut[0],
                   [EACH_FOOT] = sizeof parts->foot[0],
                   [EACH_BUSHING] = sizeof parts->bushing[0],
                   [EACH_ROLLER] = sizeof vehicle->wheel[0],
                   [EACH_MEASURE] = sizeof *measure,
                   [EACH_PARACHUTE] = sizeof rocket->parachute[0],
                   [EACH_CANOPY] = sizeof rocket->parachute[0]},
        .launcher = model_has_launcher(model),
        .model = model,
    };
}

const char *quantity_name_of(const quantity_things *things, quantity_each each, int item)
{
    return things->name[each] + (size_t)item * things->stride[each];
}

int quantity_item_named(const quantity_things *things, quantity_each each, const char *name)
{
    for (int i = 0; i < things->count[each]; i++)
        if (strcmp(quantity_name_of(things, each, i), name) == 0)
            return i;
    return -1;
}

// Modal coordinates count through all beams and are named after them: BEAM.q1.
static void name_coordinate(const ld_mechanism *parts, int item, char *to, size_t size)
{
    int i = 0;
    for (; item >= beam_coordinates(&parts->beam[i]); i++)
        item -= beam_coordinates(&parts->beam[i]);
    snprintf(to, size, "%s.q%d", parts->beam[i].name, item + 1);
}

static void name_thing(quantity_each each, int item, const quantity_things *things, char *to,
                       size_t size)
{
    if (each == EACH_BEAM_COORDINATE)
        name_coordinate(&model_base(things->model)->mechanism, item, to, size);
    else if (!things->name[each])
        snprintf(to, size, "%d", item + 1);
    else
        snprintf(to, size, "%s", quantity_name_of(things, each, item));
}

void quantity_text(const char *text, quantity_each each, int item, const quantity_things *things,
                   char *to, size_t size)
{
    const char *mark = strstr(text, "%s");
    char of[QUANTITY_NAME];
    if (!mark) {
        snprintf(to, size, "%s", text);
        return;
    }
    name_thing(each, item, things, of, sizeof of);
    snprintf(to, size, "%.*s%s%s", (int)(mark - text), text, of, mark + 2);
}

// Leaves groups of which there is nothing.
static void skip_absent(quantity_walk *walk)
{
    const quantity_table *table = walk->table;
    while (walk->at_group < table->groups &&
           walk->item >= walk->things->count[table->group[walk->at_group].each]) {
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
    skip_absent(&walk);
    return walk;
}

void quantity_next(quantity_walk *walk)
{
    if (++walk->at_row == walk->group->rows) {
        walk->at_row = 0;
        walk->item++;
    }
    skip_absent(walk);
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

// ---- columns ----

// The text as it stands, or with the name of which, written at *room, which is moved on.
static const char *text_of(const char *text, const quantity_walk *at, char **room)
{
    if (!strstr(text, "%s"))
        return text;
    const char *written = *room;
    quantity_text(text, at->group->each, at->item, at->things, *room, QUANTITY_TEXT);
    *room += strlen(*room) + 1;
    return written;
}

// How many columns a table has; *several: of them, those that say of which.
static size_t count_columns(const quantity_table *table, const quantity_things *things,
                            size_t *several)
{
    size_t count = 0;
    for (int i = 0; i < table->groups; i++) {
        const quantity_group *group = &table->group[i];
        size_t columns = (size_t)(things->count[group->each] * group->rows);
        count += columns;
        *several += group->each > EACH_LINE ? columns : 0;
    }
    return count;
}

static void add_columns(quantity_columns *self, const quantity_part *part,
                        const quantity_things *things, char **room)
{
    for (quantity_walk at = quantity_first(part->table, things); at.row; quantity_next(&at)) {
        size_t where = at.group->where.offset;
        size_t offset = at.row->at.offset + (size_t)at.item * at.row->at.stride;
        self->cell[self->count] =
            (quantity_cell){part->offset + offset, where ? part->offset + where : 0};
        self->column[self->count++] =
            (ld_column){.name = text_of(at.row->name, &at, room),
                        .unit = at.row->unit,
                        .description = text_of(at.row->description, &at, room)};
    }
}

ld_status quantity_columns_make(quantity_columns *self, const quantity_part *parts, int part_count,
                                const quantity_things *things, ld_error *error)
{
    size_t count = 0, several = 0;
    for (int i = 0; i < part_count; i++)
        count += parts[i].table ? count_columns(parts[i].table, things, &several) : 0;
    self->count = 0;
    self->column = calloc(count, sizeof *self->column);
    self->cell = calloc(count, sizeof *self->cell);
    self->text = malloc(several * 2 * QUANTITY_TEXT + 1);
    if (!self->column || !self->cell || !self->text) {
        quantity_columns_free(self);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the columns' names");
    }
    char *room = self->text;
    for (int i = 0; i < part_count; i++)
        if (parts[i].table)
            add_columns(self, &parts[i], things, &room);
    return LD_OK;
}

void quantity_columns_free(quantity_columns *self)
{
    free(self->column);
    free(self->cell);
    free(self->text);
    *self = (quantity_columns){0};
}

void quantity_row(const quantity_columns *self, const void *from, double *row)
{
    const char *start = from;
    for (int i = 0; i < self->count; i++) {
        const quantity_cell *cell = &self->cell[i];
        bool there = cell->where == 0 || *(const bool *)(start + cell->where);
        row[i] = there ? *(const double *)(const void *)(start + cell->offset) : NAN;
    }
}
