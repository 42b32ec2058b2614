// From the tree to the model: every value against its table, then the rules between values.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "run/measures.h"
#include "scenario/clock_text.h"
#include "scenario/scenario_reader.h"

enum { PATH = READER_MAX_PATH };

// Appends to a path; what is too long is cut.
static void extend(char path[PATH], const char *more)
{
    size_t used = strlen(path), room = PATH - 1 - used, length = strlen(more);
    length = length < room ? length : room;
    memcpy(path + used, more, length);
    path[used + length] = '\0';
}

static void join(char path[PATH], const char *parent, const char *key)
{
    path[0] = '\0';
    extend(path, parent);
    extend(path, parent[0] ? "." : "");
    extend(path, key);
}

// Refuses a value that is not a scalar, list or mapping as it should be.
static void refuse_value(scenario_reader *reader, const field_row *f, const tree_node *value,
                         const char *path)
{
    static const char *const kinds[] = {NULL, "a list", "a block"};
    char expected[FIELD_EXPECTATION], quoted[64];
    field_expectation(f, expected, sizeof expected);
    if (tree_is_empty(value))
        reader_refuse(reader, value->key_at, path, "found no value; expected %s", expected);
    else
        reader_refuse(reader, value->at, path, "found %s; expected %s",
                      value->kind == NODE_SCALAR ? reader_quote(value->text, quoted)
                                                 : kinds[value->kind],
                      expected);
}

static bool is_scalar(scenario_reader *reader, const field_row *f, const tree_node *value,
                      const char *path)
{
    bool good = value->kind == NODE_SCALAR && !tree_is_empty(value);
    if (!good)
        refuse_value(reader, f, value, path);
    return good;
}

// ---- values

// A vector given by its components, over what it was before or its default.
static bool read_components(scenario_reader *reader, const field_row *f, const tree_node *map,
                            const char *path, double *values)
{
    static const char *const names[] = {"w", "x", "y", "z"};
    const char *const *name = names + 4 - f->count;
    bool good = true, given[4] = {false};
    if (map->beneath && map->beneath->kind == NODE_SCALAR) {
        const written_value before = written_in(f, map->beneath, path);
        good = quantity_read(reader, &before, values, f->count);
        given[0] = given[1] = given[2] = given[3] = true;
    }
    for (const tree_node *member = map->first; member; member = member->next) {
        char key_path[PATH];
        int i = 0;
        join(key_path, path, member->key);
        while (i < f->count && strcmp(name[i], member->key) != 0)
            i++;
        if (i == f->count) {
            reader_refuse(reader, member->key_at, key_path,
                          "is not a component; this vector has %s%sy, z",
                          f->count == 4 ? "w, " : "", f->count >= 3 ? "x, " : "");
            good = false;
        } else if (is_scalar(reader, f, member, key_path)) {
            const written_value component = written_in(f, member, key_path);
            good &= quantity_read(reader, &component, &values[i], 1);
            given[i] = true;
        } else {
            good = false;
        }
    }
    for (int i = 0; i < f->count && good; i++)
        if (!given[i] && isnan(values[i])) {
            reader_refuse(reader, map->key_at, path, "component %s is missing", name[i]);
            good = false;
        }
    return good;
}

static void read_number(scenario_reader *reader, const field_row *f, const tree_node *value,
                        void *base, const char *path)
{
    double *values = field_at(base, f);
    const written_value given = written_in(f, value, path);
    bool good;
    if (value->kind == NODE_MAP && f->count > 1)
        good = read_components(reader, f, value, path, values);
    else
        good = is_scalar(reader, f, value, path) && quantity_read(reader, &given, values, f->count);
    for (int i = 0; i < f->count && !good; i++)
        values[i] = NAN;
}

// A whole number in the range of `f`, into `result` (unless NULL).
static void read_whole(scenario_reader *reader, const field_row *f, const tree_node *value,
                       const char *path, int *result)
{
    char quoted[64], expected[128];
    if (!is_scalar(reader, f, value, path))
        return;
    const char *digits = value->text + (value->text[0] == '+' || value->text[0] == '-');
    size_t count = strspn(digits, "0123456789");
    long number = strtol(value->text, NULL, 10);
    if (count == 0 || count > 9 || digits[count] || !field_in_range(f->range, (double)number)) {
        field_expectation(f, expected, sizeof expected);
        reader_refuse(reader, value->at, path, "found %s; %s %s", reader_quote(value->text, quoted),
                      f->range.low < f->range.high ? "expected" : "must be", expected);
    } else if (result) {
        *result = (int)number;
    }
}

// Refuses a value that is none of the words that is allowed there, with the one meant.
static void refuse_word(scenario_reader *reader, const field_row *f, const field_word *words,
                        const tree_node *value, const char *path)
{
    char expected[FIELD_EXPECTATION];
    const char *meant = NULL;
    if (words && value->kind == NODE_SCALAR && !tree_is_empty(value))
        meant = field_nearest_word(words, value->text);
    field_expectation(f, expected, sizeof expected);
    if (meant)
        reader_refuse_word(reader, value->at, path, value->text, meant, expected);
    else
        refuse_value(reader, f, value, path);
}

// The word that stands for a number, where the choice has one and the text looks like a number, not
// like another of its words.
static const field_word *word_for_number(const field_row *f, const char *text)
{
    for (const field_word *w = f->words; w->name; w++)
        if (!w->name[0] && strchr("0123456789+-.", text[0]) && !field_nearest_word(f->words, text))
            return w;
    return NULL;
}

// The value chosen by a word or a number; FIELD_WORD_REFUSED after a message.
static int choose(scenario_reader *reader, const field_row *f, const tree_node *value, void *base,
                  const char *path)
{
    const field_word *word = field_word_find(f->words, value->text);
    const written_value given = written_in(f, value, path);
    if (word)
        return word->value;
    word = word_for_number(f, value->text);
    if (!word)
        refuse_word(reader, f, f->words, value, path);
    else if (quantity_read(reader, &given, (double *)((char *)base + f->other), 1))
        return word->value;
    return FIELD_WORD_REFUSED;
}

static void read_choice(scenario_reader *reader, const field_row *f, const tree_node *value,
                        void *base, const char *path)
{
    int chosen = FIELD_WORD_REFUSED;
    if (is_scalar(reader, f, value, path))
        chosen = choose(reader, f, value, base, path);
    if (f->offset != FIELD_NOWHERE)
        memcpy(field_at(base, f), &chosen, sizeof chosen);
}

static void read_word(scenario_reader *reader, const field_row *f, const tree_node *value,
                      void *base, const char *path)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    static const char others[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
    bool joined = f->kind == FIELD_QUANTITY;
    if (!is_scalar(reader, f, value, path))
        return;
    size_t length = strlen(value->text), most = joined ? LD_MAX_QUANTITY : LD_MAX_NAME;
    if (length >= most || strspn(value->text, letters) == 0 ||
        strspn(value->text, others) != length || (!joined && strchr(value->text, '.')))
        refuse_value(reader, f, value, path);
    else
        memcpy(field_at(base, f), value->text, length + 1);
}

static char *own_text(scenario_reader *reader, const char *text)
{
    char *own = strdup(text);
    reader->no_memory = reader->no_memory || !own;
    return own;
}

// A file that is not text, with its digest, which may have been given.
static void read_file_name(scenario_reader *reader, const field_row *f, const tree_node *value,
                           void *base, const char *path)
{
    char **digest = (char **)((char *)base + f->other);
    const char *given = *digest, *now = given;
    if (!is_scalar(reader, f, value, path))
        return;
    const char *whole = reader_keep(reader, value->at, path, value->text, &now);
    if (!whole)
        return;
    *(char **)field_at(base, f) = own_text(reader, whole);
    if (!given)
        *digest = own_text(reader, now);
}

static void read_text(scenario_reader *reader, const field_row *f, const tree_node *value,
                      void *base, const char *path)
{
    if (!is_scalar(reader, f, value, path))
        return;
    *(char **)field_at(base, f) = own_text(reader, value->text);
}

// ---- tables

// The time that was read from a cell of the first column less the clock's origin.
static double clock_of_cell(const char *text, double time, bool first, double *clock)
{
    double value, factor;
    const char *reason, *end = number_parse(text, &value, &reason);
    char unknown[32];
    if (!end || units_factor(end + strspn(end, " \t"), "s", &factor, unknown) != UNITS_OK)
        return clock_read("", time, 1, first, clock);
    return clock_read(text, value, factor, first, clock);
}

static bool read_row(scenario_reader *reader, const field_row *f, const table_format *format,
                     const tree_node *row, const char *path, double *values)
{
    char expected[FIELD_EXPECTATION], cell_path[PATH];
    field_expectation(f, expected, sizeof expected);
    if (row->kind != NODE_LIST || row->count != format->columns) {
        reader_refuse(reader, row->at, path, "found %s%d values; expected %d: %s",
                      row->kind == NODE_LIST ? "a row of " : "no row of ",
                      row->kind == NODE_LIST ? row->count : format->columns, format->columns,
                      expected);
        return false;
    }
    bool good = true;
    int k = 0;
    for (const tree_node *cell = row->first; cell; cell = cell->next, k++) {
        const field_row *column = &format->column[k];
        join(cell_path, path, column->name);
        const written_value given = written_in(column, cell, cell_path);
        good &= is_scalar(reader, column, cell, cell_path) &&
                quantity_read(reader, &given, &values[k], 1);
    }
    return good;
}

static bool read_rows(scenario_reader *reader, const field_row *f, const tree_node *rows,
                      const char *path, ld_table *table, double *clock)
{
    bool good = true;
    if (rows->count == 0) {
        reader_refuse(reader, rows->at, path, "the table is empty");
        return false;
    }
    // the first row says which form of the table it is
    const table_format *format = field_table_format(f->table, (size_t)rows->first->count);
    if (!format && f->table->other) {
        char expected[FIELD_EXPECTATION];
        field_expectation(f, expected, sizeof expected);
        reader_refuse(reader, rows->first->at, path, "found a first row of %d values; expected %s",
                      rows->first->count, expected);
        return false;
    }
    format = format ? format : f->table;
    size_t i = 0, columns = (size_t)format->columns;
    *table = (ld_table){(size_t)rows->count, columns,
                        calloc((size_t)rows->count * columns, sizeof(double))};
    if (!table->data) {
        reader->no_memory = true;
        return false;
    }
    for (const tree_node *row = rows->first; row; row = row->next, i++) {
        char number[16], row_path[PATH];
        snprintf(number, sizeof number, "%zu", i + 1);
        join(row_path, path, number);
        double *values = &table->data[i * columns];
        good &= read_row(reader, f, format, row, row_path, values);
        if (good && clock)
            values[0] = clock_of_cell(row->first->text, values[0], i == 0, clock);
    }
    return good;
}

// One value of the last column, as a table of one row.
static bool read_constant(scenario_reader *reader, const field_row *f, const tree_node *value,
                          const char *path, ld_table *table)
{
    int columns = f->table->columns;
    *table = (ld_table){1, (size_t)columns, calloc((size_t)columns, sizeof(double))};
    if (!table->data) {
        reader->no_memory = true;
        return false;
    }
    const written_value given = written_in(&f->table->column[columns - 1], value, path);
    return quantity_read(reader, &given, &table->data[columns - 1], 1);
}

static bool ends_with(const char *text, const char *ending)
{
    size_t length = strlen(text), tail = strlen(ending);
    return length > tail && strcmp(text + length - tail, ending) == 0;
}

static bool read_table_file(scenario_reader *reader, const field_row *f, const tree_node *value,
                            void *base, const char *path)
{
    ld_table *table = field_at(base, f);
    const written_value given = written_in(f, value, path);
    bool sounding = false;
    bool known = (f->table->sources & TABLE_CSV && ends_with(value->text, ".csv")) ||
                 (f->table->sources & TABLE_ENGINE && ends_with(value->text, ".eng")) ||
                 (f->table->sources & TABLE_MESH && ends_with(value->text, ".glb")) ||
                 (f->table->sources & TABLE_ROCKSIM && ends_with(value->text, ".rse")) ||
                 (f->table->sources & TABLE_SOUNDING && ends_with(value->text, ".txt"));
    if (!known)
        refuse_value(reader, f, value, path);
    if (!known || !table_file_read(reader, &given, table, field_clock(base, f), &sounding))
        return false;
    if (sounding && f->other && field_switch(base, f) == LD_WIND_LAUNCHER) {
        reader_refuse(reader, value->at, path,
                      "a sounding gives the wind to north and east; it requires axes: geographic");
        return false;
    }
    return true;
}

// Whether a text in place of a table is its one value; else it is the name of a file.
static bool is_constant(const table_format *format, const char *text)
{
    bool has_files = format->sources & (TABLE_CSV | TABLE_ENGINE);
    return format->sources & TABLE_CONSTANT &&
           (!has_files || (strchr("0123456789+-.", text[0]) && !ends_with(text, ".csv")));
}

static void read_table(scenario_reader *reader, const field_row *f, const tree_node *value,
                       void *base, const char *path)
{
    ld_table *table = field_at(base, f);
    bool good = false;
    if (value->kind == NODE_LIST)
        good = read_rows(reader, f, value, path, table, field_clock(base, f));
    else if (!is_scalar(reader, f, value, path))
        good = false;
    else if (is_constant(f->table, value->text))
        good = read_constant(reader, f, value, path, table);
    else
        good = read_table_file(reader, f, value, base, path);
    if (!good) {
        free(table->data);
        *table = (ld_table){0};
    }
}

// ---- blocks and lists

static void read_block(scenario_reader *reader, const field_block *block, const tree_node *map,
                       void *base, const char *path);

static void read_shared_value(scenario_reader *reader, const field_row *f, const tree_node *value,
                              void *base, const char *path)
{
    for (const field_row *part = f->block->fields; part->name; part++)
        if (part->kind == FIELD_NUMBER) {
            size_t count = reader->messages->count;
            read_number(reader, part, value, base, path);
            if (reader->messages->count > count)
                return;
        }
}

static void read_block_field(scenario_reader *reader, const field_row *f, const tree_node *value,
                             void *base, const char *path)
{
    void *inner = field_at(base, f);
    const field_word *word = NULL;
    if (f->words && value->kind == NODE_SCALAR)
        word = field_word_find(f->words, value->text);
    if (word) {
        field_set_switch(base, f, word->value);
    } else if (f->block->shared_value && value->kind == NODE_SCALAR && !tree_is_empty(value)) {
        read_shared_value(reader, f, value, inner, path);
    } else if (value->kind == NODE_MAP) {
        for (const field_word *w = f->words; w && w->name; w++)
            if (!w->name[0])
                field_set_switch(base, f, w->value);
        read_block(reader, f->block, value, inner, path);
    } else {
        refuse_word(reader, f, f->words, value, path);
    }
}

// Path of a list's entry: by its name if it has one, else by its number.
static void entry_path(char path[PATH], const char *parent, const tree_node *entry, int number)
{
    char text[16];
    const tree_node *name = entry->kind == NODE_MAP ? tree_member(entry, "name") : NULL;
    snprintf(text, sizeof text, "%d", number);
    join(path, parent, name && name->kind == NODE_SCALAR && name->text[0] ? name->text : text);
}

static void read_list(scenario_reader *reader, const field_row *f, const tree_node *list,
                      void *base, const char *path)
{
    char expected[FIELD_EXPECTATION], inner_path[PATH];
    int number = 0;
    if (list->kind != NODE_LIST) {
        refuse_value(reader, f, list, path);
        return;
    }
    field_expectation(f, expected, sizeof expected);
    if (list->count < f->least || list->count > f->count)
        reader_refuse(reader, list->at, path, "found a list of %d; expected %s", list->count,
                      expected);
    for (const tree_node *entry = list->first; entry && number < f->count; entry = entry->next) {
        void *inner = field_entry(base, f, number);
        entry_path(inner_path, path, entry, ++number);
        memset(inner, 0, f->stride);
        field_initialise(f->block, inner);
        if (entry->kind == NODE_MAP)
            read_block(reader, f->block, entry, inner, inner_path);
        else
            reader_refuse(reader, entry->at, inner_path, "expected a block of keys");
    }
    field_set_switch(base, f, number);
}

// ---- lists of plain values

static void read_integers(scenario_reader *reader, const field_row *f, const tree_node *list,
                          void *base, const char *path)
{
    int *values = field_at(base, f), number = 0;
    field_row one = *f;
    one.kind = FIELD_INTEGER;
    if (list->kind != NODE_LIST || list->count < f->least || list->count > f->count) {
        refuse_value(reader, f, list, path);
        return;
    }
    for (const tree_node *entry = list->first; entry; entry = entry->next, number++) {
        char inner_path[PATH];
        entry_path(inner_path, path, entry, number + 1);
        read_whole(reader, &one, entry, inner_path, &values[number]);
    }
    field_set_switch(base, f, number);
}

// The number of the entry of that name, or -1.
static int entry_named(const field_row *f, const void *base, const char *name)
{
    for (int i = 0; i < field_switch(base, f); i++)
        if (strcmp(field_entry_const(base, f, i), name) == 0)
            return i;
    return -1;
}

static void select_entry(scenario_reader *reader, const field_row *f, const tree_node *name,
                         void *base, const char *path)
{
    char quoted[64];
    if (!is_scalar(reader, f, name, path))
        return;
    int i = entry_named(f, base, name->text);
    if (i >= 0) {
        field_set_mark(base, f, i, true);
        return;
    }
    name_suggestion best = suggestion_begin(name->text);
    for (int k = 0; k < field_switch(base, f); k++)
        suggestion_offer(&best, field_entry_const(base, f, k));
    reader_refuse(reader, name->at, path, "found %s, an unknown name%s%s%s",
                  reader_quote(name->text, quoted), best.name ? "; did you mean \"" : "",
                  best.name ? best.name : "", best.name ? "\"?" : "");
}

// Marks the entries named; without a value, or for `all`, every one.
static void read_selection(scenario_reader *reader, const field_row *f, const tree_node *value,
                           void *base, const char *path)
{
    static const field_word words[] = {{"all", 1}, {NULL, 0}};
    bool all = !value || (value->kind == NODE_SCALAR && strcmp(value->text, words->name) == 0);
    int number = 0;
    for (int i = 0; i < field_switch(base, f); i++)
        field_set_mark(base, f, i, all);
    if (all)
        return;
    if (value->kind != NODE_LIST) {
        refuse_word(reader, f, words, value, path);
        return;
    }
    for (const tree_node *entry = value->first; entry; entry = entry->next) {
        char inner_path[PATH];
        entry_path(inner_path, path, entry, ++number);
        select_entry(reader, f, entry, base, inner_path);
    }
}

// Some of a row's words, or `all`, as bits.
static void read_words(scenario_reader *reader, const field_row *f, const tree_node *value,
                       void *base, const char *path)
{
    unsigned bits = 0;
    int number = 0;
    bool all = value->kind == NODE_SCALAR && strcmp(value->text, "all") == 0;
    if (!all && value->kind != NODE_LIST) {
        static const field_word words[] = {{"all", 1}, {NULL, 0}};
        refuse_word(reader, f, words, value, path);
        return;
    }
    for (const field_word *w = f->words; all && w->name; w++)
        bits |= 1u << w->value;
    for (const tree_node *entry = all ? NULL : value->first; entry; entry = entry->next) {
        char inner_path[PATH];
        entry_path(inner_path, path, entry, ++number);
        const field_word *word =
            entry->kind == NODE_SCALAR ? field_word_find(f->words, entry->text) : NULL;
        if (word)
            bits |= 1u << word->value;
        else
            refuse_word(reader, f, f->words, entry, inner_path);
    }
    memcpy(field_at(base, f), &bits, sizeof bits);
}

static void read_field(scenario_reader *reader, const field_row *f, const tree_node *value,
                       void *base, const char *path)
{
    switch (f->kind) {
    case FIELD_NUMBER:
        read_number(reader, f, value, base, path);
        break;
    case FIELD_INTEGER:
        read_whole(reader, f, value, path, f->offset == FIELD_NOWHERE ? NULL : field_at(base, f));
        break;
    case FIELD_INTEGERS:
        read_integers(reader, f, value, base, path);
        break;
    case FIELD_SELECTION:
        read_selection(reader, f, value, base, path);
        break;
    case FIELD_WORDS:
        read_words(reader, f, value, base, path);
        break;
    case FIELD_CHOICE:
        read_choice(reader, f, value, base, path);
        break;
    case FIELD_WORD:
    case FIELD_QUANTITY:
        read_word(reader, f, value, base, path);
        break;
    case FIELD_TEXT:
        read_text(reader, f, value, base, path);
        break;
    case FIELD_FILE:
        read_file_name(reader, f, value, base, path);
        break;
    case FIELD_BLOCK:
        read_block_field(reader, f, value, base, path);
        break;
    case FIELD_LIST:
        if (tree_is_alternative(f, value))
            read_block_field(reader, f->alternative, value, base, path);
        else
            read_list(reader, f, value, base, path);
        break;
    case FIELD_TABLE:
        read_table(reader, f, value, base, path);
        break;
    case FIELD_FACTORS:
    case FIELD_CORRELATED:
    case FIELD_UNTIL: // about all the rest: scenario_fill_scatter()
    case FIELD_BOUNDS:
    case FIELD_LIMIT: // scenario_fill_optimise()
    case FIELD_SWEEP: // see sweep_find()
        break;
    }
}

const char *scenario_key_meant(const field_block *block, const char *key)
{
    const char *meant = field_nearest_key(block, key);
    const char *names[] = {"include", meant};
    return block == &scenario_block ? ld_nearest_name(key, names, meant ? 2 : 1) : meant;
}

// Refuses what is not a key of the block, and continues with the key meant, lest it be missed as
// well. A block is laid over the one meant (of a file included), lest its own errors be missed.
static void refuse_unknown_keys(scenario_reader *reader, const field_block *block,
                                const tree_node *map, const char *path)
{
    for (tree_node *member = map->first; member; member = member->next) {
        char key_path[PATH], allowed[PATH] = "";
        if (field_find(block, member->key))
            continue;
        const char *meant = scenario_key_meant(block, member->key);
        for (const field_row *f = block->fields; f->name; f++) {
            extend(allowed, allowed[0] ? ", " : "");
            extend(allowed, f->name);
        }
        join(key_path, path, member->key);
        reader_refuse_key(reader, member->key_at, key_path, meant, allowed);
        tree_node *own = meant ? tree_member(map, meant) : NULL;
        if (meant && !own)
            member->key = meant;
        else if (own && own->kind == NODE_MAP && member->kind == NODE_MAP) {
            join(key_path, path, meant);
            tree_merge(reader, own, member, key_path);
        }
    }
}

// The form with most of the keys given, the first of those alike; -1 where there is none.
static int form_of_keys(const field_block *block, const tree_node *map)
{
    int best = -1, most = 0;
    for (const field_word *w = block->form; w->name; w++) {
        int count = 0;
        for (const field_row *f = block->fields; f->name; f++)
            count += f->forms && field_has_form(f, w->value) && tree_member(map, f->name);
        if (count > most) {
            most = count;
            best = w->value;
        }
    }
    return best;
}

static void refuse_without_form(scenario_reader *reader, const field_block *block,
                                const tree_node *map, const char *path)
{
    char keys[384] = "";
    for (const field_word *w = block->form; w->name; w++) {
        const char *between = w == block->form ? "" : "; or ";
        for (const field_row *f = block->fields; f->name; f++) {
            size_t length = strlen(keys);
            if (f->forms && field_has_form(f, w->value)) {
                snprintf(keys + length, sizeof keys - length, "%s%s", between, f->name);
                between = ", ";
            }
        }
    }
    reader_refuse(reader, map->key_at, path, "missing keys: %s", keys);
}

static void read_key(scenario_reader *reader, const field_block *block, const field_row *f,
                     const tree_node *map, void *base, const char *path)
{
    const tree_node *value = tree_member(map, f->name);
    int form = field_form(block, base);
    bool fits = form < 0 || field_has_form(f, form);
    char key_path[PATH], expected[FIELD_EXPECTATION];
    join(key_path, path, f->name);
    if (value && fits) {
        read_field(reader, f, value, base, key_path);
    } else if (value) {
        reader_refuse(reader, value->key_at, key_path, "is not allowed with %s%s%s",
                      block->form_key ? block->form_key : "", block->form_key ? ": " : "",
                      field_word_of(block->form, form)->name);
    } else if (f->kind == FIELD_SELECTION && fits) {
        read_selection(reader, f, NULL, base, key_path);
    } else if (field_is_required(f, form) && fits && (form >= 0 || !f->forms)) {
        const tree_node *taken = tree_taken(map, f->name);
        field_expectation(f, expected, sizeof expected);
        reader_refuse(reader, taken ? taken->key_at : map->key_at, key_path, "%s; expected %s",
                      taken ? "removed here, but required" : "missing", expected);
    }
}

static void read_block(scenario_reader *reader, const field_block *block, const tree_node *map,
                       void *base, const char *path)
{
    refuse_unknown_keys(reader, block, map, path);
    if (block->last_form && tree_member(map, block->last_form)) {
        const field_word *last = block->form;
        while (last[1].name)
            last++;
        memcpy((char *)base + block->form_offset, &last->value, sizeof last->value);
    }
    if (block->form_from_keys) {
        int form = form_of_keys(block, map);
        if (form < 0)
            refuse_without_form(reader, block, map, path);
        memcpy((char *)base + block->form_offset, &form, sizeof form);
    }
    for (const field_row *f = block->fields; f->name; f++)
        read_key(reader, block, f, map, base, path);
}

void scenario_fill_block(scenario_reader *reader, const field_block *block, const tree_node *map,
                         void *base, const char *path)
{
    read_block(reader, block, map, base, path);
}

// ---- rules

typedef struct rule_context {
    scenario_reader *reader;
    const tree_node *root;
    size_t messages; // about single values, which came before the rules
} rule_context;

// Whether the key stands in the text as a word.
static bool has_word(const char *text, const char *key)
{
    static const char inside[] = "abcdefghijklmnopqrstuvwxyz0123456789_";
    size_t length = strlen(key);
    for (const char *c = text; (c = strstr(c, key)); c++) {
        bool begins = c == text || !strchr(inside, c[-1]);
        if (begins && (!c[length] || !strchr(inside, c[length])))
            return true;
    }
    return false;
}

// The place of a broken rule about the node: a key that it names and that was taken away, else the
// value, or the key of a block.
static text_place place_of_rule(const tree_node *node, const char *text)
{
    for (const tree_node *taken = node->taken; taken; taken = taken->next)
        if (has_word(text, taken->key))
            return taken->key_at;
    return node->kind == NODE_SCALAR && !tree_is_empty(node) ? node->at : node->key_at;
}

// The place of a character of a scalar, where it stands in one line as it is read.
static text_place place_inside(const tree_node *node, text_place at, size_t character)
{
    const text_source *source = at.source;
    if (node->kind != NODE_SCALAR || !source || !source->text || at.line != node->at.line)
        return at;
    const char *line = source->text, *end = source->text + source->length;
    for (int i = source->first_line; i < at.line && line; i++) {
        line = memchr(line, '\n', (size_t)(end - line));
        line += line ? 1 : 0;
    }
    size_t before = (size_t)at.column - 1 + !node->plain;
    bool whole = line && (size_t)(end - line) >= before + character &&
                 memcmp(line + before, node->text, character) == 0;
    at.column += whole ? (int)character + !node->plain : 0;
    return at;
}

// Reports a broken rule at the key that it is about, or at the nearest block around it.
static void refuse_rule(void *self, const char *path, const char *text)
{
    rule_context *context = self;
    const tree_node *node = context->root; // the innermost found
    bool lost = false;
    char full_path[PATH] = "", rest[PATH];
    snprintf(rest, sizeof rest, "%.*s", (int)strcspn(path, "@"), path);
    for (char *save = NULL, *key = strtok_r(rest, ".", &save); key;
         key = strtok_r(NULL, ".", &save)) {
        char longer[PATH];
        const tree_node *inner = NULL, *taken = NULL;
        if (!lost && node->kind == NODE_MAP)
            inner = tree_member(node, key);
        else if (!lost && node->kind == NODE_LIST)
            inner = tree_entry(node, key);
        if (!lost && !inner)
            taken = tree_taken(node, key);
        if (inner && node->kind == NODE_LIST)
            entry_path(longer, full_path, inner, atoi(key));
        else
            join(longer, full_path, key);
        memcpy(full_path, longer, sizeof full_path);
        // a key that is missing is reported where it was taken away, or at the block that lacks it
        lost = lost || !inner;
        node = inner ? inner : taken ? taken : node;
    }
    text_place at = place_of_rule(node, text);
    if (strchr(path, '@'))
        at = place_inside(node, at, (size_t)atoi(strchr(path, '@') + 1));
    if (!reader_has_refused(context->reader, context->messages, full_path))
        reader_refuse(context->reader, at, full_path, "%s", text);
}

void scenario_fill_values(scenario_reader *reader, tree_node *root, ld_model *model)
{
    if (root->kind != NODE_MAP) {
        reader_refuse(reader, root->at, "",
                      "expected a scenario: a block of keys that begins with \"launchdyn: 1\"");
        return;
    }
    measures_write_out(reader, root, true);
    read_block(reader, &scenario_block, root, model, "");
    model_complete(model);
    measures_complete(model);
    scenario_fill_scatter(reader, root, model);
    scenario_fill_optimise(reader, root, model);
}

// Of the path of a key: what it is written with.
#define PATH_CHARACTERS "abcdefghijklmnopqrstuvwxyz0123456789_-."

bool scenario_complains_of_key(const char *complaint)
{
    char first[LD_MAX_NAME];
    size_t length = strcspn(complaint, ".: "), path = strspn(complaint, PATH_CHARACTERS);
    snprintf(first, sizeof first, "%.*s", (int)(length < LD_MAX_NAME ? length : 0), complaint);
    return field_find(&scenario_block, first) && strncmp(complaint + path, ": ", 2) == 0;
}

// Reports what a simulation said of a key.
static void refuse_complaint(rule_context *context, const char *complaint)
{
    char path[PATH];
    size_t length = strspn(complaint, PATH_CHARACTERS);
    snprintf(path, sizeof path, "%.*s", (int)length, complaint);
    refuse_rule(context, path, complaint + length + strlen(": "));
}

void scenario_fill(scenario_reader *reader, tree_node *root, ld_model *model)
{
    rule_context context = {.reader = reader, .root = root};
    scenario_fill_values(reader, root, model);
    if (root->kind != NODE_MAP)
        return;
    context.messages = reader->messages->count;
    model_check_rules(model, refuse_rule, &context);
    measures_check(model, refuse_rule, &context);
    if (reader->complaint)
        refuse_complaint(&context, reader->complaint);
}
