// Reading a scenario: files and what they include, overrides, then tree to model.
#include <locale.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/scenario_reader.h"
#include "io/text_file.h"

// The files being read, outermost first.
typedef struct open_file {
    const struct open_file *outer;
    const char *real_name;
    int depth;
} open_file;

char *reader_beside(scenario_reader *reader, const char *folder, const char *name)
{
    bool alone = name[0] == '/' || !folder || !folder[0];
    size_t length = strlen(name) + (alone ? 0 : strlen(folder)) + 2;
    char *joined = pool_take(reader, length);
    if (joined)
        snprintf(joined, length, "%s%s%s", alone ? "" : folder, alone ? "" : "/", name);
    return joined;
}

// The folder part of a file's name: "" without.
static char *folder_of(scenario_reader *reader, const char *name)
{
    const char *slash = strrchr(name, '/');
    return pool_text(reader, name, slash == name ? 1 : slash ? (size_t)(slash - name) : 0);
}

text_source *reader_open(scenario_reader *reader, text_place place, const char *path,
                         const char *file_name)
{
    char *text;
    size_t length;
    ld_error error;
    ld_status status = text_file_read(file_name, READER_MAX_BYTES, &text, &length, &error);
    if (status == LD_ERR_MEMORY)
        reader->no_memory = true;
    if (status != LD_OK) {
        reader_refuse(reader, place, path, "file \"%s\" %s", file_name, error.text);
        return NULL;
    }
    text_source *opened = pool_take(reader, sizeof *opened);
    if (opened)
        *opened =
            (text_source){pool_text(reader, file_name, strlen(file_name)),
                          pool_text(reader, text, length), length, folder_of(reader, file_name), 1};
    free(text);
    return reader->no_memory ? NULL : opened;
}

static tree_node *load(scenario_reader *reader, const text_source *source, const open_file *file);

// Loads the file that `value` names, below what includes it.
static tree_node *load_included(scenario_reader *reader, const tree_node *value,
                                const open_file *file)
{
    if (value->kind != NODE_SCALAR || tree_is_empty(value)) {
        reader_refuse(reader, value->at, "include", "expected the name of a file");
        return NULL;
    }
    char *name = reader_beside(reader, value->at.source->folder, value->text);
    if (!name)
        return NULL;
    text_source *opened = reader_open(reader, value->at, "include", name);
    char *real_name = opened ? realpath(name, NULL) : NULL;
    open_file inner = {file, real_name ? real_name : name, file->depth + 1};
    tree_node *root = NULL;
    bool cycle = false;
    for (const open_file *outer = file; outer; outer = outer->outer)
        cycle = cycle || strcmp(outer->real_name, inner.real_name) == 0;
    if (opened && cycle)
        reader_refuse(reader, value->at, "include", "file \"%s\" includes itself", name);
    else if (opened && inner.depth > READER_MAX_INCLUDES)
        reader_refuse(reader, value->at, "include", "more than %d files one inside the other",
                      READER_MAX_INCLUDES);
    else if (opened)
        root = load(reader, opened, &inner);
    free(real_name);
    return root;
}

// Parses a source and lays it over what it includes; NULL after a message.
static tree_node *load(scenario_reader *reader, const text_source *source, const open_file *file)
{
    tree_node *root = tree_parse(reader, source, source->text, source->length, 1);
    tree_node *include = root && root->kind == NODE_MAP ? tree_member(root, "include") : NULL;
    if (!include)
        return root;
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

static tree_node *apply_override(scenario_reader *reader, tree_node *root, const char *text,
                                 const char *folder, int number)
{
    text_source *source = pool_take(reader, sizeof *source);
    if (!source)
        return root;
    *source =
        (text_source){"--set", pool_text(reader, text, strlen(text)), strlen(text), folder, number};
    tree_node *over = source->text ? parse_override(reader, source) : NULL;
    return over ? tree_merge(reader, root, over, "") : root;
}

// ---- the whole

// What stands on the command line, and which point of the sweep is wanted (from 1; 0: none).
typedef struct scenario_request {
    const char *const *set;
    size_t count;
    int point;
} scenario_request;

static tree_node *apply_overrides(scenario_reader *reader, tree_node *root, const char *folder,
                                  const scenario_request *request)
{
    for (size_t i = 0; i < request->count; i++)
        root = apply_override(reader, root, request->set[i], folder, (int)i + 1);
    return root;
}

// Reads each value of each axis by itself, only for messages about its key: whether values of
// several go together is seen when their point is read.
static void check_values(scenario_reader *reader, const tree_node *file,
                         const scenario_sweep *sweep, const char *folder,
                         const scenario_request *request)
{
    for (int i = 0; i < sweep->count; i++)
        for (int k = 0; k < sweep->axis[i].list->count && !reader->no_memory; k++) {
            ld_model model;
            memory_pool before = pool_mark(reader);
            size_t messages = reader->messages->count;
            ld_model_init(&model);
            tree_node *root = tree_copy(reader, file);
            root = root ? sweep_lay(reader, root, &sweep->axis[i], k) : NULL;
            if (root)
                root = apply_overrides(reader, root, folder, request);
            if (root && !reader->no_memory)
                scenario_fill_values(reader, root, &model);
            ld_model_free(&model);
            reader_keep_messages(reader, messages, &sweep->axis[i].keys);
            pool_return(reader, before);
        }
}

static void read_source(scenario_reader *reader, const text_source *source,
                        const scenario_request *request, ld_model *model)
{
    char *real_name = realpath(source->name, NULL);
    open_file open = {NULL, real_name ? real_name : source->name, 0};
    tree_node *file = load(reader, source, &open);
    free(real_name);
    tree_node *root = file ? tree_copy(reader, file) : NULL;
    if (!root)
        return;
    root = apply_overrides(reader, root, source->folder, request);
    scenario_sweep sweep = sweep_find(reader, root, request->set, request->count);
    sweep_fill(reader, &sweep, model);
    if (request->point > ld_scenario_points(model)) {
        reader_refuse(reader, (text_place){source, 0, 0}, "sweep",
                      "there is no point %d: they go from 1 to %d", request->point,
                      ld_scenario_points(model));
        return;
    }
    if (request->point > 0) {
        // overrides come last: they have the last word
        root = tree_copy(reader, file);
        for (int i = 0; i < sweep.count && root; i++)
            root = sweep_lay(reader, root, &sweep.axis[i],
                             ld_scenario_value(model, request->point, i));
        root = root ? apply_overrides(reader, root, source->folder, request) : NULL;
    }
    if (root && !reader->no_memory)
        scenario_fill(reader, root, model);
    if (request->point == 0)
        check_values(reader, file, &sweep, source->folder, request);
}

// udunits keeps the state of its parser in global variables.
static pthread_mutex_t one_reader = PTHREAD_MUTEX_INITIALIZER;

static ld_status read_scenario(const char *file, text_source *source,
                               const scenario_request *request, ld_model *model,
                               ld_messages *messages)
{
    scenario_reader reader = {.messages = messages};
    ld_model fresh;
    ld_status status = LD_OK;
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0), before = uselocale(plain);
    *messages = (ld_messages){0};
    ld_model_init(&fresh);
    pthread_mutex_lock(&one_reader);
    reader.units = units_open();
    if (!plain || !reader.units) {
        reader.no_memory = true;
    } else if (file && strcmp(file, "-") == 0 && request->point > 0) {
        reader_refuse(&reader, (text_place){&(text_source){.name = "<stdin>"}, 0, 0}, "sweep",
                      "its points are read one by one: give a file, not standard input");
    } else if (file) {
        struct text_source unread = {.name = strcmp(file, "-") == 0 ? "<stdin>" : file};
        source = reader_open(&reader, (text_place){&unread, 0, 0}, "", file);
        status = source ? LD_OK : LD_ERR_FILE;
        if (source && strcmp(file, "-") == 0)
            source->name = unread.name;
    }
    if (source && !reader.no_memory)
        read_source(&reader, source, request, &fresh);
    pthread_mutex_unlock(&one_reader);
    reader_finish_messages(&reader);
    if (reader.no_memory)
        status = LD_ERR_MEMORY;
    else if (status == LD_OK && messages->count > 0)
        status = LD_ERR_INPUT;
    if (status == LD_OK)
        *model = fresh;
    else
        ld_model_free(&fresh);
    pool_free(&reader);
    uselocale(before);
    if (plain)
        freelocale(plain);
    return status;
}

ld_status ld_scenario_read(const char *path, const char *const *sets, size_t count, ld_model *model,
                           ld_messages *messages)
{
    return read_scenario(path, NULL, &(scenario_request){sets, count, 0}, model, messages);
}

ld_status ld_scenario_read_text(const char *text, size_t length, const char *name,
                                const char *folder, const char *const *sets, size_t count,
                                ld_model *model, ld_messages *messages)
{
    text_source source = {name, text, length, folder, 1};
    return read_scenario(NULL, &source, &(scenario_request){sets, count, 0}, model, messages);
}

ld_status ld_scenario_read_point(const char *path, const char *const *sets, size_t count, int point,
                                 ld_model *model, ld_messages *messages)
{
    return read_scenario(path, NULL, &(scenario_request){sets, count, point}, model, messages);
}

ld_status ld_scenario_read_text_point(const char *text, size_t length, const char *name,
                                      const char *folder, const char *const *sets, size_t count,
                                      int point, ld_model *model, ld_messages *messages)
{
    text_source source = {name, text, length, folder, 1};
    return read_scenario(NULL, &source, &(scenario_request){sets, count, point}, model, messages);
}
