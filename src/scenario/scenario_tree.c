// YAML text to a tree of nodes, by libyaml's events; the tree holds the place of every key and
// value.
#include "scenario/scenario_reader.h"

#include "base/suggestion.h"
#include "model/fields/field.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <yaml.h>

// ---- memory

struct pool_chunk {
    struct pool_chunk *next;
    size_t used, size;
    _Alignas(16) char bytes[];
};

void *pool_take(scenario_reader *reader, size_t size)
{
    struct pool_chunk *chunk = reader->pool.chunk;
    size = (size + 15) & ~(size_t)15;
    if (!chunk || chunk->size - chunk->used < size) {
        size_t capacity = size > 1 << 16 ? size : 1 << 16;
        chunk = malloc(sizeof *chunk + capacity);
        if (!chunk) {
            reader->no_memory = true;
            return NULL;
        }
        *chunk = (struct pool_chunk){reader->pool.chunk, 0, capacity};
        reader->pool.chunk = chunk;
    }
    void *taken = chunk->bytes + chunk->used;
    chunk->used += size;
    return taken;
}

char *pool_text(scenario_reader *reader, const char *text, size_t length)
{
    char *copy = pool_take(reader, length + 1);
    if (copy) {
        memcpy(copy, text, length);
        copy[length] = '\0';
    }
    return copy;
}

memory_pool pool_mark(const scenario_reader *reader)
{
    struct pool_chunk *chunk = reader->pool.chunk;
    return (memory_pool){chunk, chunk ? chunk->used : 0};
}

void pool_return(scenario_reader *reader, memory_pool mark)
{
    while (reader->pool.chunk != mark.chunk) {
        struct pool_chunk *next = reader->pool.chunk->next;
        free(reader->pool.chunk);
        reader->pool.chunk = next;
    }
    if (mark.chunk)
        mark.chunk->used = mark.used;
}

void pool_free(scenario_reader *reader)
{
    pool_return(reader, (memory_pool){0});
}

// ---- nodes

tree_node *tree_new(scenario_reader *reader, node_kind kind, text_place at)
{
    tree_node *fresh = pool_take(reader, sizeof *fresh);
    if (fresh)
        *fresh = (tree_node){.kind = kind, .at = at, .key_at = at};
    return fresh;
}

void tree_append(tree_node *parent, tree_node *member)
{
    member->next = NULL;
    if (parent->last)
        parent->last->next = member;
    else
        parent->first = member;
    parent->last = member;
    parent->count++;
}

tree_node *tree_member(const tree_node *map, const char *key)
{
    for (tree_node *member = map->first; member; member = member->next)
        if (member->key && strcmp(member->key, key) == 0)
            return member;
    return NULL;
}

const tree_node *tree_taken(const tree_node *map, const char *key)
{
    const tree_node *taken = map->taken;
    while (taken && strcmp(taken->key, key) != 0)
        taken = taken->next;
    return taken;
}

tree_node *tree_entry(const tree_node *list, const char *name)
{
    int number = 0;
    for (tree_node *entry = list->first; entry; entry = entry->next) {
        char text[16];
        const tree_node *own = entry->kind == NODE_MAP ? tree_member(entry, "name") : NULL;
        snprintf(text, sizeof text, "%d", ++number);
        if (strcmp(text, name) == 0 ||
            (own && own->kind == NODE_SCALAR && strcmp(own->text, name) == 0))
            return entry;
    }
    return NULL;
}

tree_node *tree_copy(scenario_reader *reader, const tree_node *node)
{
    tree_node *copy = pool_take(reader, sizeof *copy);
    if (!copy)
        return NULL;
    *copy = *node;
    copy->first = copy->last = NULL;
    copy->count = 0;
    for (const tree_node *member = node->first; member; member = member->next) {
        tree_node *inner = tree_copy(reader, member);
        if (!inner)
            return NULL;
        tree_append(copy, inner);
    }
    return copy;
}

bool tree_is_empty(const tree_node *node)
{
    return node->kind == NODE_SCALAR && node->plain &&
           (node->text[0] == '\0' || strcmp(node->text, "~") == 0 ||
            strcmp(node->text, "null") == 0);
}

// ---- parsing

typedef struct builder {
    scenario_reader *reader;
    const text_source *source;
    const char *text; // the part of the source that is parsed
    size_t length;
    int column;     // of the first character
    char path[512]; // of the value being built
    yaml_parser_t parser;
    yaml_event_t event;
    bool failed;
} builder;

static text_place place_of(const builder *b, yaml_mark_t mark)
{
    const text_source *source = b->source;
    int line = (int)mark.line + source->first_line, column = (int)mark.column + 1;
    return (text_place){source, line, mark.line == 0 ? column + b->column - 1 : column};
}

static void refuse(builder *b, yaml_mark_t mark, const char *text)
{
    if (!b->failed)
        reader_refuse(b->reader, place_of(b, mark), b->path, "%s", text);
    b->failed = true;
}

// Place of a byte, for errors below the level of characters.
static text_place place_of_byte(const builder *b, size_t offset)
{
    int line = b->source->first_line, column = b->column;
    for (size_t i = 0; i < offset && i < b->length; i++) {
        unsigned char c = (unsigned char)b->text[i];
        line += c == '\n';
        column = c == '\n' ? 1 : column + ((c & 0xc0) != 0x80);
    }
    return (text_place){b->source, line, column};
}

// Where the parser stopped; at the end of the text, behind its last word.
static text_place place_of_problem(const builder *b)
{
    size_t length = b->length;
    while (length > 0 && strchr(" \t\r\n", b->text[length - 1]))
        length--;
    text_place stop = place_of(b, b->parser.problem_mark), end = place_of_byte(b, length);
    return stop.line > end.line ? end : stop;
}

static void refuse_yaml(builder *b)
{
    const yaml_parser_t *p = &b->parser;
    const char *notation = b->source->json ? "JSON" : "YAML";
    if (b->failed)
        return;
    b->failed = true;
    if (p->error == YAML_MEMORY_ERROR)
        b->reader->no_memory = true;
    else if (p->error == YAML_READER_ERROR)
        reader_refuse(b->reader, place_of_byte(b, p->problem_offset), "", "not valid text: %s",
                      p->problem);
    else if (p->context && p->context_mark.line != p->problem_mark.line)
        reader_refuse(b->reader, place_of_problem(b), "",
                      "not valid %s: %s, %s that begins in line %d", notation, p->problem,
                      p->context, place_of(b, p->context_mark).line);
    else
        reader_refuse(b->reader, place_of_problem(b), "", "not valid %s: %s%s%s", notation,
                      p->problem, p->context ? ", " : "", p->context ? p->context : "");
}

// The next event into b->event (to be deleted); false after a failure.
static bool next_event(builder *b)
{
    if (b->failed)
        return false;
    if (!yaml_parser_parse(&b->parser, &b->event)) {
        refuse_yaml(b);
        return false;
    }
    return true;
}

static bool is_properly_plain(builder *b, const yaml_char_t *anchor, const yaml_char_t *tag)
{
    if (anchor)
        refuse(b, b->event.start_mark, "anchors (&) are not allowed in a scenario");
    else if (tag)
        refuse(b, b->event.start_mark, "tags (!) are not allowed in a scenario");
    return !b->failed;
}

static tree_node *build_value(builder *b, int depth);

// Appends a key or a number to the path; returns the length it had.
static size_t enter_path(builder *b, const char *key, int number)
{
    size_t length = strlen(b->path), room = sizeof b->path - length;
    const char *point = length ? "." : "";
    if (key)
        snprintf(b->path + length, room, "%s%s", point, key);
    else
        snprintf(b->path + length, room, "%s%d", point, number);
    return length;
}

static void add_key(builder *b, tree_node *map, tree_node *key, tree_node *value)
{
    const tree_node *twin = tree_member(map, key->text);
    if (twin) {
        reader_refuse(b->reader, key->at, b->path, "is given twice, first in line %d",
                      twin->key_at.line);
        return;
    }
    if (map->count >= READER_MAX_KEYS) {
        reader_refuse(b->reader, key->at, b->path, "more than %d keys in one block",
                      READER_MAX_KEYS);
        b->failed = true;
        return;
    }
    value->key = key->text;
    value->key_at = key->at;
    tree_append(map, value);
}

static void build_map(builder *b, tree_node *map, int depth)
{
    while (next_event(b)) {
        if (b->event.type == YAML_MAPPING_END_EVENT) {
            yaml_event_delete(&b->event);
            return;
        }
        if (b->event.type != YAML_SCALAR_EVENT && b->event.type != YAML_ALIAS_EVENT)
            refuse(b, b->event.start_mark, "a key must be a word, not a list or a block");
        tree_node *key = build_value(b, depth);
        if (!key || !next_event(b))
            return;
        size_t length = enter_path(b, key->text, 0);
        tree_node *value = build_value(b, depth);
        if (value)
            add_key(b, map, key, value);
        b->path[length] = '\0';
    }
}

static void build_list(builder *b, tree_node *list, int depth)
{
    while (next_event(b)) {
        if (b->event.type == YAML_SEQUENCE_END_EVENT) {
            yaml_event_delete(&b->event);
            return;
        }
        size_t length = enter_path(b, NULL, list->count + 1);
        tree_node *member = build_value(b, depth);
        if (member)
            tree_append(list, member);
        b->path[length] = '\0';
    }
}

// Builds the value that begins with the event at hand, and deletes that event.
static tree_node *build_value(builder *b, int depth)
{
    yaml_event_t event = b->event;
    tree_node *value = NULL;
    if (depth > READER_MAX_DEPTH)
        refuse(b, event.start_mark, "nested too deeply");
    else if (++b->reader->nodes > READER_MAX_NODES)
        refuse(b, event.start_mark, "too many values");
    else if (event.type == YAML_ALIAS_EVENT)
        refuse(b, event.start_mark, "aliases (*) are not allowed in a scenario");
    else if (event.type == YAML_SCALAR_EVENT &&
             is_properly_plain(b, event.data.scalar.anchor, event.data.scalar.tag)) {
        value = tree_new(b->reader, NODE_SCALAR, place_of(b, event.start_mark));
        if (value) {
            value->plain = event.data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
            value->text = pool_text(b->reader, (const char *)event.data.scalar.value,
                                    event.data.scalar.length);
            if (value->text && strlen(value->text) != event.data.scalar.length)
                refuse(b, event.start_mark, "found a zero byte in a value");
        }
    } else if (event.type == YAML_MAPPING_START_EVENT &&
               is_properly_plain(b, event.data.mapping_start.anchor,
                                 event.data.mapping_start.tag)) {
        value = tree_new(b->reader, NODE_MAP, place_of(b, event.start_mark));
        if (value)
            build_map(b, value, depth + 1);
    } else if (event.type == YAML_SEQUENCE_START_EVENT &&
               is_properly_plain(b, event.data.sequence_start.anchor,
                                 event.data.sequence_start.tag)) {
        value = tree_new(b->reader, NODE_LIST, place_of(b, event.start_mark));
        if (value)
            build_list(b, value, depth + 1);
    }
    yaml_event_delete(&event);
    if (b->reader->no_memory)
        b->failed = true;
    return b->failed ? NULL : value;
}

// Skips events up to the start of the first document's content; false if there is none.
static bool find_content(builder *b)
{
    while (next_event(b)) {
        yaml_event_type_t type = b->event.type;
        if (type == YAML_STREAM_END_EVENT)
            refuse(b, b->event.start_mark, "the file is empty");
        if (b->failed || (type != YAML_STREAM_START_EVENT && type != YAML_DOCUMENT_START_EVENT)) {
            if (b->failed)
                yaml_event_delete(&b->event);
            return !b->failed;
        }
        yaml_event_delete(&b->event);
    }
    return false;
}

static void expect_end(builder *b)
{
    bool end = false;
    while (!end && next_event(b)) {
        if (b->event.type == YAML_DOCUMENT_START_EVENT)
            refuse(b, b->event.start_mark, "found a second document (---); expected one per file");
        end = b->event.type == YAML_STREAM_END_EVENT;
        yaml_event_delete(&b->event);
    }
}

tree_node *tree_parse(scenario_reader *reader, const text_source *source, const char *text,
                      size_t length, int column)
{
    builder b = {
        .reader = reader, .source = source, .text = text, .length = length, .column = column};
    tree_node *root = NULL;
    if (!yaml_parser_initialize(&b.parser)) {
        reader->no_memory = true;
        return NULL;
    }
    yaml_parser_set_encoding(&b.parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&b.parser, (const unsigned char *)text, length);
    if (find_content(&b))
        root = build_value(&b, 1);
    if (root)
        expect_end(&b);
    yaml_parser_delete(&b.parser);
    return b.failed ? NULL : root;
}

// ---- paths

static bool is_path_character(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
}

tree_node *tree_at_path(scenario_reader *reader, const char *path, text_place at, tree_node *value)
{
    tree_node *root = tree_new(reader, NODE_MAP, at), *map = root;
    const char *begin = path;
    for (int depth = 0; map; depth++) {
        const char *end = begin;
        while (is_path_character(*end))
            end++;
        text_place here = {at.source, at.line, at.column + (int)(begin - path)};
        if (end == begin || (*end && *end != '.') || depth >= READER_MAX_DEPTH) {
            here.column += (int)(end - begin);
            reader_refuse(reader, here, "",
                          "expected a path of keys joined by dots, such as rocket.mass");
            return NULL;
        }
        tree_node *inner = *end ? tree_new(reader, NODE_MAP, here) : value;
        if (!inner)
            return NULL;
        inner->key = pool_text(reader, begin, (size_t)(end - begin));
        inner->key_at = here;
        if (!inner->key)
            return NULL;
        tree_append(map, inner);
        if (!*end)
            return root;
        map = inner;
        begin = end + 1;
    }
    return NULL;
}

void tree_path(const tree_node *root, const char *path, char full_path[READER_MAX_PATH])
{
    const tree_node *node = root;
    size_t length = 0;
    while (*path && length < READER_MAX_PATH - 1) {
        char key[256];
        snprintf(key, sizeof key, "%.*s", (int)strcspn(path, "."), path);
        path += strcspn(path, ".");
        path += *path == '.';
        bool list = node && node->kind == NODE_LIST;
        node = !node                    ? NULL
               : node->kind == NODE_MAP ? tree_member(node, key)
               : list                   ? tree_entry(node, key)
                                        : NULL;
        const tree_node *name =
            list && node && node->kind == NODE_MAP ? tree_member(node, "name") : NULL;
        bool named = name && name->kind == NODE_SCALAR && name->text[0];
        snprintf(full_path + length, READER_MAX_PATH - length, "%s%s", length ? "." : "",
                 named ? name->text : key);
        length = strlen(full_path);
    }
    full_path[length] = '\0';
}

// ---- merging

static void replace_member(tree_node *parent, tree_node *old, tree_node *fresh)
{
    tree_node **link = &parent->first;
    while (*link != old)
        link = &(*link)->next;
    fresh->next = old->next;
    *link = fresh;
    if (parent->last == old)
        parent->last = fresh;
}

void tree_remove(tree_node *parent, tree_node *old)
{
    tree_node *before = NULL;
    for (tree_node *member = parent->first; member != old; member = member->next)
        before = member;
    if (before)
        before->next = old->next;
    else
        parent->first = old->next;
    if (parent->last == old)
        parent->last = before;
    parent->count--;
}

static void merge_maps(scenario_reader *reader, tree_node *under, tree_node *over, const char *path)
{
    tree_node *next = NULL;
    for (tree_node *member = over->first; member; member = next) {
        next = member->next;
        tree_node *old = tree_member(under, member->key);
        char key_path[512];
        snprintf(key_path, sizeof key_path, "%s%s%s", path, path[0] ? "." : "", member->key);
        if (old && tree_is_empty(member)) {
            tree_remove(under, old);
            member->next = under->taken;
            under->taken = member;
        } else if (old) {
            tree_node *merged = tree_merge(reader, old, member, key_path);
            if (merged != old)
                replace_member(under, old, merged);
        } else {
            tree_append(under, member);
        }
    }
}

// The name of the list's entry that an unknown one probably means, or NULL.
static const char *entry_meant(const tree_node *list, const char *name)
{
    name_suggestion best = suggestion_begin(name);
    for (const tree_node *entry = list->first; entry; entry = entry->next) {
        const tree_node *own = entry->kind == NODE_MAP ? tree_member(entry, "name") : NULL;
        if (own && own->kind == NODE_SCALAR)
            suggestion_offer(&best, own->text);
    }
    return best.name;
}

static void refuse_entry(scenario_reader *reader, const tree_node *list, const tree_node *member,
                         const char *path)
{
    char quoted[64], likely[64];
    const char *meant = entry_meant(list, member->key);
    reader_quote(member->key, quoted);
    if (meant)
        reader_refuse(reader, member->key_at, path,
                      "no entry %s in the list of %d, did you mean %s?", quoted, list->count,
                      reader_quote(meant, likely));
    else
        reader_refuse(reader, member->key_at, path,
                      "no entry %s in the list of %d; give its name or a number from 1", quoted,
                      list->count);
}

// Lays the members of a mapping on the entries of a list that they name.
static void merge_entries(scenario_reader *reader, tree_node *list, tree_node *over,
                          const char *path)
{
    tree_node *next = NULL;
    for (tree_node *member = over->first; member; member = next) {
        next = member->next;
        tree_node *old = tree_entry(list, member->key);
        char entry_path[512];
        snprintf(entry_path, sizeof entry_path, "%s.%s", path, member->key);
        if (!old) {
            refuse_entry(reader, list, member, entry_path);
            continue;
        }
        tree_node *merged = tree_merge(reader, old, member, entry_path);
        if (merged != old)
            replace_member(list, old, merged);
    }
}

bool tree_is_alternative(const struct field_row *f, const tree_node *map)
{
    if (!f || !f->alternative || map->kind != NODE_MAP)
        return false;
    for (const tree_node *member = map->first; member; member = member->next)
        if (field_find(f->alternative->block, member->key))
            return true;
    return false;
}

tree_node *tree_merge(scenario_reader *reader, tree_node *under, tree_node *over, const char *path)
{
    if (under->kind == NODE_MAP && over->kind == NODE_MAP) {
        merge_maps(reader, under, over, path);
        return under;
    }
    if (under->kind == NODE_LIST && over->kind == NODE_MAP &&
        !tree_is_alternative(field_find(&scenario_block, path), over)) {
        merge_entries(reader, under, over, path);
        return under;
    }
    if (over->kind == NODE_MAP)
        over->beneath = under;
    return over;
}
