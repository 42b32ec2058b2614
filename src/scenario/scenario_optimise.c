// What is optimised: keys between bounds, and limits in the units of their results.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/fields/field.h"
#include "model/model.h"
#include "run/aims.h"
#include "scenario/scenario_reader.h"

// ---- keys

static bool refuse_bounds(scenario_reader *reader, const tree_node *node, const char *path)
{
    reader_refuse(reader, node->at, path,
                  "expected bounds, such as [0.5 m, 1.5 m] or [1 kN, 100 kN, log]");
    return false;
}

static bool read_bound(scenario_reader *reader, const tree_node *node, const char *path,
                       const field_row *row, double *value)
{
    if (node->kind != NODE_SCALAR || tree_is_empty(node))
        return refuse_bounds(reader, node, path);
    const written_value given = written_in(row, node, path);
    return quantity_read(reader, &given, value, 1);
}

static bool check_bounds(scenario_reader *reader, const tree_node *node, const char *path,
                         const ld_bounds *bounds)
{
    const char *wrong = NULL;
    if (!(bounds->from < bounds->to))
        wrong = "expected bounds in rising order";
    else if (bounds->log && !(bounds->from > 0))
        wrong = "expected bounds > 0 for a search by the logarithm";
    if (wrong)
        reader_refuse(reader, node->at, path, "%s", wrong);
    return !wrong;
}

static bool read_bounds(scenario_reader *reader, const tree_node *node, const char *path,
                        const field_place *place, ld_bounds *bounds)
{
    const field_row row = {.kind = FIELD_NUMBER,
                           .unit = place->row->unit ? place->row->unit : "",
                           .range = place->row->range,
                           .count = 1};
    const tree_node *first = node->first, *second = first ? first->next : NULL;
    const tree_node *third = second ? second->next : NULL;
    if (node->kind != NODE_LIST || !second || node->count > 3)
        return refuse_bounds(reader, node, path);
    if (third && (third->kind != NODE_SCALAR || strcmp(third->text, "log") != 0))
        return refuse_bounds(reader, third, path);
    bounds->log = third != NULL;
    return read_bound(reader, first, path, &row, &bounds->from) &&
           read_bound(reader, second, path, &row, &bounds->to) &&
           check_bounds(reader, node, path, bounds);
}

static bool is_given(const ld_optimise *optimise, const char *path)
{
    for (int i = 0; i < optimise->key_count; i++)
        if (strcmp(optimise->key[i].path, path) == 0)
            return true;
    return false;
}

static void read_key(scenario_reader *reader, const tree_node *node, ld_model *model)
{
    ld_optimise *optimise = &model->optimise;
    ld_bounds bounds;
    field_place place;
    char path[READER_MAX_PATH], why[384];
    memset(&bounds, 0, sizeof bounds);
    snprintf(path, sizeof path, "optimise.over.%.*s", LD_MAX_PATH, node->key);
    if (!field_locate(model, node->key, &place, why, sizeof why))
        reader_refuse(reader, node->key_at, path, "%s", why);
    else if (place.whole)
        reader_refuse(reader, node->key_at, path, "a whole number cannot be optimised");
    else if (is_given(optimise, place.path))
        reader_refuse(reader, node->key_at, path, "is given above already");
    else if (read_bounds(reader, node, path, &place, &bounds)) {
        memcpy(bounds.path, place.path, sizeof bounds.path);
        optimise->key[optimise->key_count++] = bounds;
    }
}

static void read_keys(scenario_reader *reader, const tree_node *over, ld_model *model)
{
    if (over->kind != NODE_MAP || over->count < 1 || over->count > LD_MAX_BOUNDS) {
        reader_refuse(reader, over->key_at, "optimise.over",
                      "expected 1 to %d paths with bounds, such as {rocket.mass: [60 kg, 62 kg]}",
                      LD_MAX_BOUNDS);
        return;
    }
    for (const tree_node *node = over->first; node; node = node->next)
        read_key(reader, node, model);
}

// ---- aims

static void read_limit(scenario_reader *reader, const tree_node *map, const char *path,
                       const char *key, const field_row *row, double *limit)
{
    const tree_node *node = tree_member(map, key);
    char full[READER_MAX_PATH];
    snprintf(full, sizeof full, "%.200s.%s", path, key);
    if (node && (node->kind != NODE_SCALAR || tree_is_empty(node)))
        reader_refuse(reader, node->key_at, full, "expected a number with the unit of the result");
    else if (node) {
        const written_value given = written_in(row, node, full);
        quantity_read(reader, &given, limit, 1);
    }
}

static void read_aim(scenario_reader *reader, const tree_node *map, const char *path, bool limited,
                     const ld_model *model, ld_aim *aim)
{
    char why[384];
    if (reader_has_refused(reader, reader->messages->count, path))
        return;
    if (!aim_is_possible(model, aim, aim->unit, why, sizeof why)) {
        reader_refuse(reader, map->at, path, "%s", why);
        return;
    }
    if (!limited)
        return;
    const field_row row = {
        .kind = FIELD_NUMBER, .unit = aim->unit, .range = {-INFINITY, INFINITY, 1, 1}, .count = 1};
    read_limit(reader, map, path, "at_most", &row, &aim->at_most);
    read_limit(reader, map, path, "at_least", &row, &aim->at_least);
    bool given = tree_member(map, "at_most") || tree_member(map, "at_least");
    if (!given)
        reader_refuse(reader, map->at, path, "expected at_most or at_least");
}

void scenario_fill_optimise(scenario_reader *reader, const tree_node *root, ld_model *model)
{
    const tree_node *block = tree_member(root, "optimise");
    ld_optimise *optimise = &model->optimise;
    if (!block || block->kind != NODE_MAP)
        return;
    const tree_node *over = tree_member(block, "over"), *least = tree_member(block, "least");
    const tree_node *limits = tree_member(block, "subject_to");
    char path[64];
    if (over)
        read_keys(reader, over, model);
    if (least && least->kind == NODE_MAP)
        read_aim(reader, least, "optimise.least", false, model, &optimise->least);
    const tree_node *entry = limits && limits->kind == NODE_LIST ? limits->first : NULL;
    for (int i = 0; entry && i < optimise->limit_count; i++, entry = entry->next) {
        snprintf(path, sizeof path, "optimise.subject_to.%d", i + 1);
        if (entry->kind == NODE_MAP)
            read_aim(reader, entry, path, true, model, &optimise->limit[i]);
    }
}
