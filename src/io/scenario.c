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

static bool is_path_character(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
}

// The mapping {key: {key: ... value}} of a text "key.key...=value"; NULL after a message.
static tree_node *parse_override(scenario_reader *reader, const text_source *source)
{
    const char *text = source->text, *equals = strchr(text, '=');
    int line = source->first_line;
    tree_node *root = tree_new(reader, NODE_MAP, (text_place){source, line, 1}), *map = root;
    int depth = 0;
    for (const char *begin = text; map && equals; depth++) {
        const char *end = begin;
        while (is_path_character(*end))
            end++;
        text_place at = {source, line, (int)(begin - text) + 1};
        if (end == begin || (*end != '.' && *end != '=') || depth >= READER_MAX_DEPTH) {
            reader_refuse(reader, (text_place){source, line, (int)(end - text) + 1}, "",
                          "not a path of keys joined by dots, such as rocket.mass");
            return NULL;
        }
        bool last = end == equals;
        const char *value = equals + 1;
        tree_node *inner;
        if (!last) {
            inner = tree_new(reader, NODE_MAP, at);
        } else if (value[strspn(value, " \t")] == '\0') {
            inner = tree_new(reader, NODE_SCALAR, at);
            if (inner) {
                inner->plain = true;
                inner->text = "";
            }
        } else {
            inner = tree_parse(reader, source, value, strlen(value), (int)(value - text) + 1);
        }
        if (!inner)
            return NULL;
        inner->key = pool_text(reader, begin, (size_t)(end - begin));
        inner->key_at = at;
        if (!inner->key)
            return NULL;
        tree_append(map, inner);
        if (last)
            return root;
        map = inner;
        begin = end + 1;
    }
    if (root && !equals)
        reader_refuse(reader, (text_place){source, line, 1}, "", "expected path=value");
    return NULL;
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

static void read_source(scenario_reader *reader, const text_source *source, const char *const *sets,
                        size_t count, ld_model *model)
{
    char *real_name = realpath(source->name, NULL);
    open_file file = {NULL, real_name ? real_name : source->name, 0};
    tree_node *root = load(reader, source, &file);
    free(real_name);
    if (!root)
        return;
    for (size_t i = 0; i < count; i++)
        root = apply_override(reader, root, sets[i], source->folder, (int)i + 1);
    if (reader->no_memory)
        return;
    scenario_fill(reader, root, model);
}

// udunits keeps the state of its parser in global variables.
static pthread_mutex_t one_reader = PTHREAD_MUTEX_INITIALIZER;

static ld_status read_scenario(const char *file, text_source *source, const char *const *sets,
                               size_t count, ld_model *model, ld_messages *messages)
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
    } else if (file) {
        struct text_source unread = {.name = strcmp(file, "-") == 0 ? "<stdin>" : file};
        source = reader_open(&reader, (text_place){&unread, 0, 0}, "", file);
        status = source ? LD_OK : LD_ERR_FILE;
        if (source && strcmp(file, "-") == 0)
            source->name = unread.name;
    }
    if (source && !reader.no_memory)
        read_source(&reader, source, sets, count, &fresh);
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
    return read_scenario(path, NULL, sets, count, model, messages);
}

ld_status ld_scenario_read_text(const char *text, size_t length, const char *name,
                                const char *folder, const char *const *sets, size_t count,
                                ld_model *model, ld_messages *messages)
{
    text_source source = {name, text, length, folder, 1};
    return read_scenario(NULL, &source, sets, count, model, messages);
}
