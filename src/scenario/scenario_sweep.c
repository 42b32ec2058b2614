// Sweeps: lists of values for keys of the scenario. A value is laid on the scenario as an override
// is, so that its place in the file and all messages about it are those of any other value.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "scenario/scenario_reader.h"

static bool refuse(scenario_reader *reader, text_place place, const char *key, const char *format,
                   const char *detail)
{
    char path[READER_MAX_PATH];
    snprintf(path, sizeof path, "sweep.%s", key);
    reader_refuse(reader, place, path, format, detail);
    return false;
}

// Whether one of the paths is the other, or a key below it.
static bool overlap(const char *a, const char *b)
{
    size_t length = strlen(a) < strlen(b) ? strlen(a) : strlen(b);
    return strncmp(a, b, length) == 0 && (!a[length] || a[length] == '.') &&
           (!b[length] || b[length] == '.');
}

// A sweep while it is read: its scenario, the overrides, the axes so far.
typedef struct sweep_reader {
    scenario_reader *reader;
    const tree_node *root;
    const char *const *sets;
    size_t set_count;
    scenario_sweep sweep;
} sweep_reader;

static bool is_overridden(const sweep_reader *self, const char *path)
{
    for (size_t i = 0; i < self->set_count; i++) {
        char set[READER_MAX_PATH], full_path[READER_MAX_PATH];
        snprintf(set, sizeof set, "%.*s", (int)strcspn(self->sets[i], "="), self->sets[i]);
        tree_path(self->root, set, full_path);
        if (strcmp(full_path, path) == 0)
            return true;
    }
    return false;
}

// Whether a key of the axis can be swept beside those of the axis `other`.
static bool is_compatible(scenario_reader *reader, const scenario_axis *axis,
                          const scenario_axis *other, const char *path)
{
    const tree_node *node = axis->node;
    for (int k = 0; k < other->keys.count; k++) {
        const char *above = other->keys.path[k];
        if (axis->paths && overlap(path, above))
            return refuse(reader, node->key_at, node->key,
                          "%s, or a block above or below it, is swept above already", path);
        if (strcmp(path, above) == 0)
            return refuse(reader, node->key_at, node->key, "is the same key as %s above", above);
        if (overlap(path, above))
            return refuse(reader, node->key_at, node->key, "overlaps %s above", above);
    }
    return true;
}

// Whether a key can be swept beside those before it, on its own axis too.
static bool may_be_swept(const sweep_reader *self, const scenario_axis *axis, const char *path)
{
    scenario_reader *reader = self->reader;
    static const char *const own[] = {"launchdyn", "include", "scatter", "sweep", "optimise"};
    const tree_node *node = axis->node;
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (overlap(path, own[i]))
            return refuse(reader, node->key_at, node->key,
                          "keys of the study itself cannot be swept%s", "");
    for (int i = 0; i < self->sweep.count; i++)
        if (!is_compatible(reader, axis, &self->sweep.axis[i], path))
            return false;
    if (strlen(path) >= LD_MAX_PATH)
        return refuse(reader, node->key_at, node->key, "the path is too long%s", "");
    return is_compatible(reader, axis, axis, path);
}

static bool has_values(scenario_reader *reader, const scenario_axis *axis)
{
    const tree_node *list = axis->list;
    if (list && list->kind == NODE_LIST && list->count > 0)
        return true;
    return refuse(reader, !list || tree_is_empty(list) ? axis->node->key_at : list->at,
                  axis->node->key, "expected a list of values, such as [0 km/h, 15 km/h]%s", "");
}

// Lays value `number` (from 0) of the list on the key that is written `path` at that place.
static tree_node *lay_on(scenario_reader *reader, tree_node *root, const scenario_axis *axis,
                         int number, const char *path, text_place at)
{
    const tree_node *value = axis->list->first;
    while (number-- > 0)
        value = value->next;
    tree_node *copy = tree_copy(reader, value);
    tree_node *over = copy ? tree_at_path(reader, path, at, copy) : NULL;
    return over && root ? tree_merge(reader, root, over, "") : over;
}

// Whether each key is a path on which a value can be laid.
static bool can_be_laid(scenario_reader *reader, const scenario_axis *axis)
{
    if (!axis->paths)
        return lay_on(reader, NULL, axis, 0, axis->node->key, axis->node->key_at) != NULL;
    for (const tree_node *entry = axis->paths->first; entry; entry = entry->next)
        if (!lay_on(reader, NULL, axis, 0, entry->text, entry->at))
            return false;
    return true;
}

// Adds a key, written so, to the axis; false after a message, or where an override has it.
static bool add_key(const sweep_reader *self, scenario_axis *axis, const char *written)
{
    char path[READER_MAX_PATH];
    tree_path(self->root, written, path);
    if (is_overridden(self, path) || !may_be_swept(self, axis, path))
        return false;
    snprintf(axis->keys.path[axis->keys.count++], LD_MAX_PATH, "%.*s", LD_MAX_PATH - 1, path);
    return true;
}

// What the member `node` of the sweep varies; false after a message, or where an override has it.
static bool read_axis(const sweep_reader *self, const tree_node *node, scenario_axis *axis)
{
    scenario_reader *reader = self->reader;
    static const char *const keys[] = {"paths", "values"};
    bool several = node->kind == NODE_MAP && tree_member(node, "paths");
    char path[READER_MAX_PATH];
    snprintf(path, sizeof path, "sweep.%s", node->key);
    if (node->kind == NODE_MAP && !reader_check_keys(reader, node, path, keys, 2))
        return false;
    *axis = (scenario_axis){.node = node, .list = several ? tree_member(node, "values") : node};
    if (!several)
        return add_key(self, axis, node->key) && has_values(reader, axis) &&
               can_be_laid(reader, axis);
    axis->paths = together_paths(reader, node, path);
    const tree_node *entry = axis->paths ? axis->paths->first : NULL;
    for (; entry; entry = entry->next)
        if (!add_key(self, axis, entry->text))
            return false;
    return axis->paths && has_values(reader, axis) && can_be_laid(reader, axis);
}

scenario_sweep sweep_find(scenario_reader *reader, const tree_node *root, const char *const *sets,
                          size_t count)
{
    const tree_node *block = root->kind == NODE_MAP ? tree_member(root, "sweep") : NULL;
    sweep_reader self = {.reader = reader, .root = root, .sets = sets, .set_count = count};
    scenario_sweep *sweep = &self.sweep;
    long points = 1;
    if (!block)
        return *sweep;
    if (block->kind != NODE_MAP || block->count == 0) {
        reader_refuse(reader, block->key_at, "sweep",
                      "expected paths with lists of values, such as "
                      "base.speed: [0 km/h, 15 km/h]");
        return *sweep;
    }
    sweep->axis = pool_take(reader, (size_t)block->count * sizeof *sweep->axis);
    for (const tree_node *node = block->first; node && sweep->axis; node = node->next) {
        scenario_axis *axis = &sweep->axis[sweep->count];
        if (!read_axis(&self, node, axis))
            continue;
        sweep->count++;
        points = points > LD_MAX_POINTS ? points : points * axis->list->count;
    }
    if (points > LD_MAX_POINTS) {
        reader_refuse(reader, block->key_at, "sweep", "has more than %d points", LD_MAX_POINTS);
        sweep->count = 0;
    }
    return *sweep;
}

tree_node *sweep_lay(scenario_reader *reader, tree_node *root, const scenario_axis *axis,
                     int number)
{
    const tree_node *entry = axis->paths ? axis->paths->first : NULL;
    tree_node *laid =
        entry ? root : lay_on(reader, root, axis, number, axis->node->key, axis->node->key_at);
    for (; entry && laid; entry = entry->next)
        laid = lay_on(reader, laid, axis, number, entry->text, entry->at);
    return laid ? laid : root;
}

// ---- values as text

// Whether a scalar can stand in a list without quotes, and means the same there.
static bool is_bare(const tree_node *scalar)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    static const char others[] = "0123456789+-._ /%*^()";
    const char *text = scalar->text;
    size_t length = strlen(text), good = 0;
    while (text[good] && (strchr(letters, text[good]) || strchr(others, text[good])))
        good++;
    tree_node plain = *scalar;
    plain.plain = true;
    return length > 0 && good == length && !strchr("._ /%*^()", text[0]) &&
           (text[0] != '-' || (length > 1 && text[1] != ' ')) && text[length - 1] != ' ' &&
           (scalar->plain || !tree_is_empty(&plain));
}

static void write_scalar(text_writer *to, const tree_node *scalar)
{
    if (tree_is_empty(scalar))
        text_put(to, "~");
    else if (is_bare(scalar))
        text_put(to, scalar->text);
    else
        scenario_print_text(to, scalar->text);
}

static void write_value(text_writer *to, const tree_node *node)
{
    if (node->kind == NODE_SCALAR) {
        write_scalar(to, node);
        return;
    }
    bool map = node->kind == NODE_MAP;
    text_put(to, map ? "{" : "[");
    for (const tree_node *member = node->first; member; member = member->next) {
        if (map) {
            const tree_node key = {.kind = NODE_SCALAR, .text = member->key};
            write_scalar(to, &key);
            text_put(to, ": ");
        }
        write_value(to, member);
        text_put(to, member->next ? ", " : "");
    }
    text_put(to, map ? "}" : "]");
}

static char *value_text(const tree_node *value)
{
    text_writer to = {0};
    size_t length;
    write_value(&to, value);
    return text_take(&to, &length);
}

void sweep_fill(scenario_reader *reader, const scenario_sweep *sweep, ld_model *model)
{
    if (sweep->count == 0)
        return;
    model->sweep = calloc((size_t)sweep->count, sizeof *model->sweep);
    reader->no_memory = reader->no_memory || !model->sweep;
    for (int i = 0; i < sweep->count && !reader->no_memory; i++) {
        const scenario_axis *from = &sweep->axis[i];
        const tree_node *list = from->list;
        ld_sweep_axis *axis = &model->sweep[model->sweep_count++];
        snprintf(axis->path, sizeof axis->path, "%s",
                 from->paths ? from->node->key : from->keys.path[0]);
        if (from->paths)
            axis->together = from->keys;
        axis->value = calloc((size_t)list->count, sizeof *axis->value);
        reader->no_memory = !axis->value;
        for (const tree_node *value = list->first; value && !reader->no_memory;
             value = value->next) {
            axis->value[axis->count] = value_text(value);
            reader->no_memory = !axis->value[axis->count];
            axis->count += !reader->no_memory;
        }
    }
}

int ld_scenario_axes(const ld_model *model)
{
    return model->sweep_count;
}

int ld_scenario_points(const ld_model *model)
{
    int points = 1;
    for (int i = 0; i < model->sweep_count; i++)
        points *= model->sweep[i].count;
    return points;
}

int ld_scenario_value(const ld_model *model, int point, int axis)
{
    int rest = point - 1;
    for (int i = model->sweep_count - 1; i > axis; i--)
        rest /= model->sweep[i].count;
    return rest % model->sweep[axis].count;
}

void ld_scenario_point_name(const ld_model *model, int point, char *text, size_t size)
{
    size_t length = 0;
    text[0] = '\0';
    for (int i = 0; i < model->sweep_count && length < size - 1; i++) {
        const ld_sweep_axis *axis = &model->sweep[i];
        snprintf(text + length, size - length, "%s%s %s", i ? ", " : "", axis->path,
                 axis->value[ld_scenario_value(model, point, i)]);
        length += strlen(text + length);
    }
}
