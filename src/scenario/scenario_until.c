// The stopping rule of a study: statistics of results, and how well each must be known.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/suggestion.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "quantities/study_results.h"
#include "run/measure_names.h"
#include "scenario/scenario_reader.h"

static const char *const statistic_names[] = {"mean", "deviation"};
enum { STATISTICS = sizeof statistic_names / sizeof *statistic_names };

// Refuses a key that names no statistic of a result.
static void refuse_name(scenario_reader *reader, const tree_node *node, const char *path,
                        const char *result, const quantity_things *things)
{
    const char *point = strrchr(node->key, '.');
    const char *statistic = point ? ld_nearest_name(point + 1, statistic_names, STATISTICS) : NULL;
    char best[QUANTITY_NAME], whole[QUANTITY_NAME];
    study_result_near(things, result, best);
    study_result_near(things, node->key, whole);
    // without a statistic, what stands before the last point is not a result's name
    const char *near = study_result_find(things, result).row ? result : *whole ? whole : best;
    if (*near && near != whole && statistic)
        reader_refuse(reader, node->key_at, path,
                      "is not a statistic of a result, did you mean \"%s.%s\"?", near, statistic);
    else if (*near)
        reader_refuse(
            reader, node->key_at, path,
            "is not a statistic of a result, did you mean \"%s.mean\" or \"%s.deviation\"?", near,
            near);
    else
        reader_refuse(
            reader, node->key_at, path,
            "is not a statistic of a result; expected, for example, t_rear.mean or yaw.deviation");
}

static void read_half_width(scenario_reader *reader, const tree_node *node, const char *path,
                            const char *unit, ld_until *until)
{
    field_row row = {.kind = FIELD_NUMBER, .unit = unit, .range = {0, INFINITY, 1, 1}, .count = 1};
    char expected[192];
    if (node->kind != NODE_SCALAR || tree_is_empty(node)) {
        field_expectation(&row, expected, sizeof expected);
        reader_refuse(reader, node->at, path, "expected a half width in %%, or %s", expected);
        return;
    }
    size_t length = strlen(node->text);
    until->relative = node->text[length - 1] == '%';
    row.unit = until->relative ? "" : unit;
    const written_value given = written_in(&row, node, path);
    quantity_read(reader, &given, &until->half_width, 1);
}

static void read_until(scenario_reader *reader, const tree_node *node,
                       const quantity_things *things, ld_until *until)
{
    char path[READER_MAX_PATH], name[sizeof until->result] = "";
    const char *point = strrchr(node->key, '.');
    size_t length = point ? (size_t)(point - node->key) : strlen(node->key);
    int statistic = 0;
    snprintf(path, sizeof path, "scatter.until.%s", node->key);
    snprintf(name, sizeof name, "%.*s", (int)length, node->key);
    while (point && statistic < STATISTICS && strcmp(point + 1, statistic_names[statistic]) != 0)
        statistic++;
    const quantity_walk result = study_result_find(things, name);
    if (!point || statistic == STATISTICS || !result.row) {
        refuse_name(reader, node, path, name, things);
        return;
    }
    memcpy(until->result, name, sizeof name);
    until->statistic = (ld_statistic)statistic;
    read_half_width(reader, node, path, quantity_unit(&result), until);
}

void fill_until(scenario_reader *reader, const tree_node *map, ld_model *model)
{
    ld_scatter *scatter = &model->scatter;
    const quantity_things things = quantity_things_of(model);
    if (map->kind != NODE_MAP || map->count < 1 || map->count > LD_MAX_UNTIL) {
        reader_refuse(reader, map->key_at, "scatter.until",
                      "expected 1 to %d statistics, such as {t_rear.mean: 0.1 %%}", LD_MAX_UNTIL);
        return;
    }
    for (const tree_node *node = map->first; node; node = node->next)
        read_until(reader, node, &things, &scatter->until[scatter->until_count++]);
}
