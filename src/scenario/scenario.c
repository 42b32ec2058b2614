// Reading a scenario: files and what they include, overrides, then tree to model.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "base/text_file.h"
#include "model/fields/field.h"
#include "model/fields/source.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "scenario/scenario_reader.h"

// The files being read, outermost first.
typedef struct open_file {
    const struct open_file *outer;
    const char *real_name;
    int depth;
} open_file;

static tree_node *load(scenario_reader *reader, const text_source *source, const open_file *file);

// The file by which a text is known again where it includes itself, to be freed; NULL: its name.
static char *real_name_of(const scenario_reader *reader, const text_source *source)
{
    return reader->source->folder ? realpath(source->name, NULL) : NULL;
}

// Loads the file that `value` names, below what includes it.
static tree_node *load_included(scenario_reader *reader, const tree_node *value,
                                const open_file *file)
{
    if (value->kind != NODE_SCALAR || tree_is_empty(value)) {
        reader_refuse(reader, value->at, "include", "expected the name of a file");
        return NULL;
    }
    text_source *opened = reader_open(reader, value->at, "include", value->text);
    if (!opened)
        return NULL;
    char *real_name = real_name_of(reader, opened);
    open_file inner = {file, real_name ? real_name : opened->name, file->depth + 1};
    tree_node *root = NULL;
    bool cycle = false;
    for (const open_file *outer = file; outer; outer = outer->outer)
        cycle = cycle || strcmp(outer->real_name, inner.real_name) == 0;
    if (cycle)
        reader_refuse(reader, value->at, "include", "file \"%s\" includes itself", opened->name);
    else if (inner.depth > READER_MAX_INCLUDES)
        reader_refuse(reader, value->at, "include", "files are included more than %d deep",
                      READER_MAX_INCLUDES);
    else
        root = load(reader, opened, &inner);
    free(real_name);
    return root;
}

// Refuses a key that probably means `include`: what the file then lacks is not known.
static bool misspells_include(scenario_reader *reader, const tree_node *root)
{
    for (const tree_node *member = root->first; member; member = member->next) {
        const char *meant = field_find(&scenario_block, member->key)
                                ? NULL
                                : scenario_key_meant(&scenario_block, member->key);
        if (meant && strcmp(meant, "include") == 0) {
            reader_refuse_key(reader, member->key_at, member->key, meant, "");
            return true;
        }
    }
    return false;
}

// Parses a source and lays it over what it includes; NULL after a message.
static tree_node *load(scenario_reader *reader, const text_source *source, const open_file *file)
{
    tree_node *root = tree_parse(reader, source, source->text, source->length, 1);
    if (!root || root->kind != NODE_MAP)
        return root;
    measures_write_out(reader, root, false);
    tree_node *include = tree_member(root, "include");
    if (!include)
        return misspells_include(reader, root) ? NULL : root;
    tree_remove(root, include);
    tree_node *under = load_included(reader, include, file);
    if (!under)
        return NULL;
    if (under->kind != NODE_MAP) {
        reader_refuse(reader, under->at, "", "an included file must be a block of keys");
        return NULL;
    }
    return tree_merge(reader, under, root, "");
}

// ---- overrides

// The mapping {key: {key: ... value}} of a text "key.key...=value"; NULL after a message.
static tree_node *parse_override(scenario_reader *reader, const text_source *source)
{
    const char *text = source->text, *equals = strchr(text, '=');
    text_place begin = {source, source->first_line, 1};
    if (!equals) {
        reader_refuse(reader, begin, "", "expected path=value");
        return NULL;
    }
    const char *path = pool_text(reader, text, (size_t)(equals - text)), *value = equals + 1;
    tree_node *node;
    if (value[strspn(value, " \t")] == '\0') {
        node = tree_new(reader, NODE_SCALAR, begin);
        if (node) {
            node->plain = true;
            node->text = "";
        }
    } else {
        node = tree_parse(reader, source, value, strlen(value), (int)(value - text) + 1);
    }
    return path && node ? tree_at_path(reader, path, begin, node) : NULL;
}

// Override `number`, from 0. In messages it has its place among those that came with it: who sets
// one key after the other knows no other number.
static tree_node *apply_override(scenario_reader *reader, tree_node *root, size_t number)
{
    const ld_source *from = reader->source;
    const char *text = from->set[number];
    bool before = number < from->set_before;
    text_source *source = pool_take(reader, sizeof *source);
    if (!source)
        return root;
    *source = (text_source){.name = before ? "set before" : "--set",
                            .text = pool_text(reader, text, strlen(text)),
                            .length = strlen(text),
                            .folder = from->folder,
                            .first_line = before ? 1 : (int)(number - from->set_before) + 1,
                            .within = ""};
    tree_node *over = source->text ? parse_override(reader, source) : NULL;
    root = over ? tree_merge(reader, root, over, "") : root;
    measures_write_out(reader, root, false);
    return root;
}

// ---- the whole

static tree_node *apply_overrides(scenario_reader *reader, tree_node *root)
{
    const ld_source *source = reader->source;
    for (size_t i = 0; i < source->set_count; i++)
        root = apply_override(reader, root, i);
    return root;
}

// Reads each value of each axis on its own, only for messages about its key: whether values of
// several go together is seen when their point is read.
static void check_values(scenario_reader *reader, const tree_node *file,
                         const scenario_sweep *sweep)
{
    for (int i = 0; i < sweep->count; i++)
        for (int k = 0; k < sweep->axis[i].list->count && !reader->no_memory; k++) {
            ld_model model;
            memory_pool before = pool_mark(reader);
            size_t messages = reader->messages->count;
            model_init(&model);
            tree_node *root = tree_copy(reader, file);
            root = root ? sweep_lay(reader, root, &sweep->axis[i], k) : NULL;
            if (root)
                root = apply_overrides(reader, root);
            if (root && !reader->no_memory)
                scenario_fill_values(reader, root, &model);
            model_clear(&model);
            reader_keep_messages(reader, messages, &sweep->axis[i].keys);
            pool_return(reader, before);
        }
}

// A scenario with all that it includes.
typedef struct whole_scenario {
    const text_source *source;
    tree_node *file; // without overrides
    tree_node *root; // with them
    scenario_sweep sweep;
} whole_scenario;

// Reads the texts and puts the axes of the sweep into the model; false after a message.
static bool open_whole(scenario_reader *reader, const text_source *source, whole_scenario *whole,
                       ld_model *axes)
{
    char *real_name = real_name_of(reader, source);
    open_file open = {NULL, real_name ? real_name : source->name, 0};
    const char *const *sets = (const char *const *)reader->source->set;
    *whole = (whole_scenario){.source = source, .file = load(reader, source, &open)};
    free(real_name);
    whole->root = whole->file ? tree_copy(reader, whole->file) : NULL;
    if (!whole->root)
        return false;
    whole->root = apply_overrides(reader, whole->root);
    whole->sweep = sweep_find(reader, whole->root, sets, reader->source->set_count);
    sweep_fill(reader, &whole->sweep, axes);
    return true;
}

// The tree of a point (0: with the nominal values); NULL after a message.
static tree_node *tree_of_point(scenario_reader *reader, const whole_scenario *whole,
                                const ld_model *axes, int point)
{
    if (point > ld_scenario_points(axes)) {
        reader_refuse(reader, (text_place){whole->source, 0, 0}, "sweep",
                      "found point %d, expected 1 to %d", point, ld_scenario_points(axes));
        return NULL;
    }
    if (point == 0)
        return whole->root;
    // overrides come last: they have the last word
    tree_node *root = tree_copy(reader, whole->file);
    for (int i = 0; i < whole->sweep.count && root; i++)
        root = sweep_lay(reader, root, &whole->sweep.axis[i], ld_scenario_value(axes, point, i));
    return root ? apply_overrides(reader, root) : NULL;
}

static void read_point(scenario_reader *reader, const text_source *source, int point,
                       ld_model *model)
{
    whole_scenario whole;
    if (!open_whole(reader, source, &whole, model))
        return;
    tree_node *root = tree_of_point(reader, &whole, model, point);
    if (root && !reader->no_memory)
        scenario_fill(reader, root, model);
    if (point == 0)
        check_values(reader, whole.file, &whole.sweep);
}

// Puts warnings on point `from` to `to` into `notes`, each once, and what is wrong with them into
// the messages.
static void note_points(scenario_reader *reader, const text_source *source, int from, int to,
                        ld_messages *notes)
{
    whole_scenario whole;
    ld_messages *errors = reader->messages;
    ld_model *axes = malloc(sizeof *axes);
    if (!axes) {
        reader->no_memory = true;
        return;
    }
    model_init(axes);
    bool good = open_whole(reader, source, &whole, axes);
    for (int point = from; point <= to && good && !reader->no_memory; point++) {
        memory_pool before = pool_mark(reader);
        size_t count = notes->count;
        ld_model model;
        model_init(&model);
        tree_node *root = tree_of_point(reader, &whole, axes, point);
        if (root && !reader->no_memory)
            scenario_fill(reader, root, &model);
        good = root && errors->count == 0 && !reader->no_memory;
        reader->messages = notes;
        if (good)
            scenario_take_notes(reader, root, &model);
        reader_keep_messages(reader, count, NULL);
        reader->messages = errors;
        model_clear(&model);
        pool_return(reader, before);
    }
    ld_model_free(axes);
}

// What is to be read: point `from` into the model or, without one, warnings on it up to point `to`.
typedef struct reading {
    int from, to;
    const char *complaint; // about a key of the model, for which there is a message; NULL: none
    ld_model *model;
    ld_messages *notes;
} reading;

// Reads, with points as decimal signs; `messages` is filled on failure.
static ld_status read_wanted(ld_source *source, const reading *wanted, ld_messages *messages)
{
    scenario_reader reader = {
        .messages = messages, .source = source, .complaint = wanted->complaint};
    const ld_source_file *first = source->file[0];
    text_source root = {.name = source->name,
                        .text = first->text,
                        .length = first->length,
                        .folder = source->folder,
                        .first_line = 1,
                        .within = ""};
    locale_t before = numeric_locale_enter();
    *messages = (ld_messages){0};
    if (wanted->model)
        read_point(&reader, &root, wanted->from, wanted->model);
    else
        note_points(&reader, &root, wanted->from, wanted->to, wanted->notes);
    bool good = messages->count == 0;
    reader.messages = good && wanted->notes ? wanted->notes : messages;
    reader_finish_messages(&reader);
    if (reader.no_memory) // what they say may come of that
        ld_messages_free(messages);
    pool_free(&reader);
    numeric_locale_leave(before);
    return reader.no_memory ? LD_ERR_MEMORY
           : reader.no_file ? LD_ERR_FILE
           : good           ? LD_OK
                            : LD_ERR_INPUT;
}

ld_status scenario_read_source(ld_source *source, int point, ld_model *model, ld_messages *messages)
{
    ld_model fresh;
    model_init(&fresh);
    ld_status status = read_wanted(source, &(reading){.from = point, .model = &fresh}, messages);
    if (status) {
        model_clear(&fresh);
        return status;
    }
    fresh.source = source_hold(source);
    fresh.point = point;
    *model = fresh;
    return LD_OK;
}

ld_status ld_scenario_notes(ld_source *source, int from, int to, ld_messages *notes)
{
    ld_messages found = {0};
    ld_status status =
        read_wanted(source, &(reading){.from = from, .to = to, .notes = &found}, notes);
    if (!status)
        *notes = found;
    else
        ld_messages_free(&found);
    return status;
}

bool ld_scenario_explain(const ld_model *model, const ld_error *error, ld_messages *messages)
{
    ld_model unused;
    *messages = (ld_messages){0};
    if (!model->source || !scenario_complains_of_key(error->text))
        return false;
    model_init(&unused);
    const reading wanted = {.from = model->point, .complaint = error->text, .model = &unused};
    ld_status status = read_wanted(model->source, &wanted, messages);
    model_clear(&unused);
    if (status == LD_ERR_INPUT)
        return true;
    ld_messages_free(messages);
    return false;
}

// ---- where the texts come from

static bool is_stdin(const char *path)
{
    return strcmp(path, "-") == 0;
}

// A source of the scenario's text, which becomes its own in any case; NULL: no memory.
static ld_source *source_of(char *text, size_t length, const char *name, const char *folder,
                            const char *const *sets, size_t count)
{
    const char *slash = strrchr(name, '/');
    ld_source *source = source_new(name, folder ? folder : "");
    if (!source) {
        free(text);
        return NULL;
    }
    bool fine = source_add(source, slash ? slash + 1 : name, text, length);
    for (size_t i = 0; i < count && fine; i++)
        fine = source_add_set(source, sets[i]);
    if (fine)
        return source;
    source_free(source);
    return NULL;
}

// What is wrong with a file as a whole; returns `status`.
static ld_status refuse_file(ld_messages *messages, const char *name, const char *path,
                             ld_status status, const char *text)
{
    scenario_reader reader = {.messages = messages};
    text_source file = {.name = name};
    *messages = (ld_messages){0};
    if (status != LD_ERR_MEMORY)
        reader_refuse(&reader, (text_place){&file, 0, 0}, path, "%s", text);
    if (reader.no_memory)
        ld_messages_free(messages);
    return reader.no_memory ? LD_ERR_MEMORY : status;
}

// Reads a point of the source, which is given up.
static ld_status read_and_release(ld_source *source, int point, ld_model *model,
                                  ld_messages *messages)
{
    *messages = (ld_messages){0};
    ld_status status =
        source ? scenario_read_source(source, point, model, messages) : LD_ERR_MEMORY;
    source_free(source);
    return status;
}

ld_status scenario_read_point(const char *path, const char *const *sets, size_t count, int point,
                              ld_model *model, ld_messages *messages)
{
    const char *name = is_stdin(path) ? "<stdin>" : path, *slash = strrchr(name, '/');
    char *text, why[2 * LD_ERROR_TEXT];
    size_t length;
    ld_error error;
    if (is_stdin(path) && point > 0)
        return refuse_file(
            messages, name, "sweep", LD_ERR_INPUT,
            "a sweep reads its file more than once; give a file, not standard input");
    ld_status status = text_file_read(path, READER_MAX_BYTES, &text, &length, &error);
    if (status) {
        snprintf(why, sizeof why, "file \"%s\" %s", path, error.text);
        return refuse_file(messages, name, "", status, why);
    }
    char *folder = strndup(name, slash == name ? 1 : slash ? (size_t)(slash - name) : 0);
    ld_source *source = folder ? source_of(text, length, name, folder, sets, count) : NULL;
    if (!folder)
        free(text);
    free(folder);
    return read_and_release(source, point, model, messages);
}

// NOLINTNEXTLINE(readability-function-size)
ld_status scenario_read_text_point(const char *text, size_t length, const char *name,
                                   const char *folder, const char *const *sets, size_t count,
                                   int point, ld_model *model, ld_messages *messages)
{
    char *own = malloc(length + 1);
    if (own) {
        memcpy(own, text, length);
        own[length] = '\0';
    }
    ld_source *source = own ? source_of(own, length, name, folder, sets, count) : NULL;
    return read_and_release(source, point, model, messages);
}

ld_status scenario_read(const char *path, const char *const *sets, size_t count, ld_model *model,
                        ld_messages *messages)
{
    return scenario_read_point(path, sets, count, 0, model, messages);
}

// NOLINTNEXTLINE(readability-function-size)
ld_status scenario_read_text(const char *text, size_t length, const char *name, const char *folder,
                             const char *const *sets, size_t count, ld_model *model,
                             ld_messages *messages)
{
    return scenario_read_text_point(text, length, name, folder, sets, count, 0, model, messages);
}
