// Groups of correlated factors.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "model/fields/factor.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "scenario/scenario_reader.h"

// One group while it is read.
typedef struct group_reader {
    scenario_reader *reader;
    const ld_model *model;
    const tree_node *map; // its block
    char path[64];
    ld_correlated *group;
} group_reader;

static bool refuse(const group_reader *self, const tree_node *node, const char *key,
                   const char *format, const char *detail)
{
    char path[96];
    snprintf(path, sizeof path, "%s%s%s", self->path, key[0] ? "." : "", key);
    reader_refuse(self->reader, node->kind == NODE_SCALAR ? node->at : node->key_at, path, format,
                  detail);
    return false;
}

// Number of the factor with that path, or name of several; -1: there is none.
static int find_factor(const ld_scatter *scatter, const char *path)
{
    for (int i = 0; i < scatter->factor_count; i++)
        if (strcmp(scatter->factor[i].path, path) == 0)
            return i;
    return -1;
}

static bool read_factor(const group_reader *self, const tree_node *name)
{
    const ld_scatter *scatter = &self->model->scatter;
    char why[384], key[24];
    field_place place;
    snprintf(key, sizeof key, "factors.%d", self->group->count + 1);
    if (name->kind != NODE_SCALAR)
        return refuse(self, name, key, "expected the path of a factor%s", "");
    int factor = find_factor(scatter, name->text);
    bool number = factor < 0 && field_locate(self->model, name->text, &place, why, sizeof why);
    if (number)
        factor = find_factor(scatter, place.path);
    if (factor >= 0) {
        self->group->factor[self->group->count++] = factor;
        return true;
    }
    name_suggestion best = suggestion_begin(name->text);
    for (int i = 0; i < scatter->factor_count; i++)
        suggestion_offer(&best, scatter->factor[i].path);
    if (best.name)
        return refuse(self, name, key, "is not an uncertain input, did you mean \"%s\"?",
                      best.name);
    if (!number)
        return refuse(self, name, key, "%s", why);
    return refuse(self, name, key, "is not one of scatter.factors%s", "");
}

static bool read_factors(const group_reader *self)
{
    const tree_node *list = tree_member(self->map, "factors");
    char most[16];
    snprintf(most, sizeof most, "%d", LD_MAX_CORRELATED);
    if (!list || list->kind != NODE_LIST || list->count < 2 || list->count > LD_MAX_CORRELATED)
        return refuse(self, list ? list : self->map, "factors",
                      "expected a list of 2 to %s paths of factors", most);
    for (const tree_node *name = list->first; name; name = name->next)
        if (!read_factor(self, name))
            return false;
    return true;
}

static bool read_matrix(const group_reader *self)
{
    static const field_row number = {
        .kind = FIELD_NUMBER, .unit = "", .range = {-1, 1, 0, 0}, .count = 1};
    const tree_node *rows = tree_member(self->map, "matrix");
    int count = self->group->count, i = 0;
    char wanted[64];
    snprintf(wanted, sizeof wanted, "%d rows of %d numbers", count, count);
    if (!rows || rows->kind != NODE_LIST || rows->count != count)
        return refuse(self, rows ? rows : self->map, "matrix", "expected %s", wanted);
    for (const tree_node *row = rows->first; row; row = row->next, i++) {
        char path[128];
        int k = 0;
        if (row->kind != NODE_LIST || row->count != count)
            return refuse(self, rows, "matrix", "expected %s", wanted);
        for (const tree_node *cell = row->first; cell; cell = cell->next, k++) {
            snprintf(path, sizeof path, "%s.matrix.%d.%d", self->path, i + 1, k + 1);
            if (cell->kind != NODE_SCALAR)
                return refuse(self, rows, "matrix", "expected %s", wanted);
            const written_value given = written_in(&number, cell, path);
            if (!quantity_read(self->reader, &given, &self->group->matrix[i][k], 1))
                return false;
        }
    }
    return true;
}

static bool read_group(const group_reader *self)
{
    static const char *const keys[] = {"factors", "matrix"};
    char why[384];
    if (self->map->kind != NODE_MAP)
        return refuse(self, self->map, "", "expected {factors: [...], matrix: [[...], ...]}%s", "");
    if (!reader_check_keys(self->reader, self->map, self->path, keys, 2) || !read_factors(self) ||
        !read_matrix(self))
        return false;
    if (!correlated_is_possible(&self->model->scatter, self->group, why, sizeof why))
        return refuse(self, tree_member(self->map, "matrix"), "", "%s", why);
    return true;
}

void fill_correlated(scenario_reader *reader, const tree_node *list, ld_model *model)
{
    ld_scatter *scatter = &model->scatter;
    size_t messages = reader->messages->count;
    if (list->kind != NODE_LIST || list->count == 0) {
        reader_refuse(reader, list->key_at, "scatter.correlated",
                      "expected a list of groups, such as "
                      "[{factors: [...], matrix: [[1, 0.5], [0.5, 1]]}]");
        return;
    }
    if (reader_has_refused(reader, messages, "scatter.factors"))
        return;
    scatter->correlated = calloc((size_t)list->count, sizeof *scatter->correlated);
    if (!scatter->correlated) {
        reader->no_memory = true;
        return;
    }
    for (const tree_node *map = list->first; map; map = map->next) {
        group_reader self = {.reader = reader,
                             .model = model,
                             .map = map,
                             .group = &scatter->correlated[scatter->correlated_count]};
        snprintf(self.path, sizeof self.path, "scatter.correlated.%d",
                 scatter->correlated_count + 1);
        if (!read_group(&self))
            return;
        scatter->correlated_count++;
    }
}
