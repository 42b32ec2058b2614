// What the parts of the scenario reader share: sources of text, the tree of nodes that they are
// parsed into, and the messages.
#ifndef LD_SCENARIO_SCENARIO_READER_H
#define LD_SCENARIO_SCENARIO_READER_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/memory_stream.h"
#include "launchdyn/scenario.h"
#include "model/blocks/study.h"
#include "model/units.h"

enum {
    READER_MAX_DEPTH = 32,             // of nested lists and mappings
    READER_MAX_KEYS = 256,             // of one mapping
    READER_MAX_PATH = 512,             //
    READER_MAX_NODES = 200000,         // of one scenario
    READER_MAX_MESSAGES = 100,         //
    READER_MAX_INCLUDES = 8,           // one inside the other
    READER_MAX_BYTES = 4 * 1024 * 1024 // of one file
};

struct field_row;
struct field_block;

// A piece of text that keys or numbers come from.
typedef struct text_source {
    const char *name; // of the file; "--set"
    const char *text;
    size_t length;
    const char *folder; // where files that it names are searched
    int first_line;     // number of its first line: 1, of an override its own number
    const char *within; // folder as seen from the scenario's
    bool json;          // its notation; else YAML
} text_source;

typedef struct text_place {
    const text_source *source;
    int line, column; // from 1; 0: the source as a whole
} text_place;

typedef enum node_kind { NODE_SCALAR, NODE_LIST, NODE_MAP } node_kind;

// A node of a parsed scenario; all live in the reader's pool.
typedef struct tree_node {
    node_kind kind;
    text_place at;           // where the value begins
    text_place key_at;       // where its key stands (members of mappings; else as `at`)
    const char *key;         // of a member of a mapping, else NULL
    const char *text;        // of a scalar
    bool plain;              // the scalar is not in quotes
    int count;               // members
    struct tree_node *first; // member
    struct tree_node *last;  // member
    struct tree_node *next;  // sibling
    struct tree_node
        *beneath;            // the scalar that this mapping was laid over, for x, y, z of a vector
    struct tree_node *taken; // members taken away by the empty values listed here
} tree_node;

typedef struct memory_pool {
    struct pool_chunk *chunk; // the newest
    size_t used;              // of it, where this is a mark
} memory_pool;

typedef struct scenario_reader {
    ld_messages *messages;
    bool no_memory;
    bool no_file; // one could not be read, for no fault of the scenario's
    bool cut;     // more messages than are kept
    memory_pool pool;
    int nodes;
    ld_source *source;     // what has been read so far
    const char *complaint; // "path.of.a.key: ...", what a simulation of it said; NULL
} scenario_reader;

// Memory that lives as long as the reader; NULL (and no_memory) without.
void *pool_take(scenario_reader *reader, size_t size);
char *pool_text(scenario_reader *reader, const char *text, size_t length);
// What has been taken so far, and the return of all that was taken since.
memory_pool pool_mark(const scenario_reader *reader);
void pool_return(scenario_reader *reader, memory_pool mark);
void pool_free(scenario_reader *reader);

// Adds a message about the key `path` at `place`.
void reader_refuse(scenario_reader *reader, text_place place, const char *path, const char *format,
                   ...) LD_PRINTF(4, 5);
// Refuses an unknown key, with the one meant or, where that is not known (NULL), those allowed.
void reader_refuse_key(scenario_reader *reader, text_place place, const char *path,
                       const char *meant, const char *allowed);
// Refuses the keys of a block, whose path is given, that are none of `count` names; whether there
// are none.
bool reader_check_keys(scenario_reader *reader, const tree_node *map, const char *path,
                       const char *const *names, size_t count);
// Refuses a word, with the one meant (NULL: not known) and what is expected.
void reader_refuse_word(scenario_reader *reader, text_place place, const char *path,
                        const char *word, const char *meant, const char *expected);
// Whether one of the first `count` messages is about `path`, a key below it or a
// block around it.
bool reader_has_refused(const scenario_reader *reader, size_t count, const char *path);

// Of the messages after the first `count`, keeps those about one of the keys (NULL: any), a key
// below it or a block around it that do not stand there already.
void reader_keep_messages(scenario_reader *reader, size_t count, const ld_together *keys);

// Puts the messages into the order of the text.
void reader_finish_messages(scenario_reader *reader);

// `text` in double quotes, cut and cleaned for a message.
const char *reader_quote(const char *text, char buffer[64]);

// Parses one YAML document; `column` is where its first character stands in line 1 of the source.
// NULL after a message (or without memory).
tree_node *tree_parse(scenario_reader *reader, const text_source *source, const char *text,
                      size_t length, int column);
tree_node *tree_member(const tree_node *map, const char *key);
// The empty value that took this member away, or NULL.
const tree_node *tree_taken(const tree_node *map, const char *key);
// The member of a list by name (its `name`) or by number from 1, or NULL.
tree_node *tree_entry(const tree_node *list, const char *name);
// Lays `over` on `under` and returns the result: mappings member by member (an empty value takes
// the key away), a mapping over a list on the members it names, all else in place of what was
// there.
tree_node *tree_merge(scenario_reader *reader, tree_node *under, tree_node *over, const char *path);
tree_node *tree_new(scenario_reader *reader, node_kind kind, text_place at);
void tree_append(tree_node *parent, tree_node *member);
// A copy with all that is below.
tree_node *tree_copy(scenario_reader *reader, const tree_node *node);
// The path of the node that `path` leads to from `root`, list members by name where they have one;
// what is not there stays as it stands.
void tree_path(const tree_node *root, const char *path, char full_path[READER_MAX_PATH]);
// {key: {key: ... value}} of the path "key.key" whose first character is at `at`; NULL after a
// message.
tree_node *tree_at_path(scenario_reader *reader, const char *path, text_place at, tree_node *value);
void tree_remove(tree_node *parent, tree_node *member);
// Whether the node is the block that is allowed in place of the list `f` (NULL: no key).
bool tree_is_alternative(const struct field_row *f, const tree_node *node);
// Whether there is no value: nothing, ~ or null.
bool tree_is_empty(const tree_node *node);

// The key that an unknown one of a block probably means, or NULL; of the root also `include`.
const char *scenario_key_meant(const struct field_block *block, const char *key);

// Reads the tree into `model` (initialised), each value against its table; then checks the rules.
void scenario_fill_values(scenario_reader *reader, tree_node *root, ld_model *model);
void scenario_fill(scenario_reader *reader, tree_node *root, ld_model *model);
// Writes root's measures in short, NAME: EXPRESSION, out as blocks of a list; of one file, which
// may be laid over another, only those of a list.
void measures_write_out(scenario_reader *reader, tree_node *root, bool whole);
// Reads a block's keys from `map`, whose path is given, into its struct, which was initialised.
void scenario_fill_block(scenario_reader *reader, const struct field_block *block,
                         const tree_node *map, void *base, const char *path);

// Adds a message about each value of a good scenario that is allowed but implausible.
void scenario_take_notes(scenario_reader *reader, const tree_node *root, const ld_model *model);

// Whether a sentence begins with the path of a key and a colon.
bool scenario_complains_of_key(const char *complaint);

// Reads what scatter says about other keys, once the rest of the model is known.
void scenario_fill_scatter(scenario_reader *reader, const tree_node *root, ld_model *model);
// Its groups of correlated factors, and the statistics of its stopping rule.
void fill_correlated(scenario_reader *reader, const tree_node *list, ld_model *model);
void fill_until(scenario_reader *reader, const tree_node *map, ld_model *model);

// The same of what is optimised.
void scenario_fill_optimise(scenario_reader *reader, const tree_node *root, ld_model *model);

// A text in double quotes.
void scenario_print_text(text_writer *to, const char *text);

// The list `paths` of a block that sets several keys under one name, its key; NULL after a message
// about the block, whose own path is given.
const tree_node *together_paths(scenario_reader *reader, const tree_node *block, const char *path);

// What is swept: one key, or several together, and its values.
typedef struct scenario_axis {
    const tree_node *node;  // its key is the path as written, or the name of several
    const tree_node *paths; // of several as written, or NULL
    const tree_node *list;  // of values
    ld_together keys;       // the path in full, or those of several
} scenario_axis;

typedef struct scenario_sweep {
    int count;
    scenario_axis *axis;
} scenario_sweep;

// Finds the axes of root's `sweep`, less those with the path of one of the overrides.
scenario_sweep sweep_find(scenario_reader *reader, const tree_node *root, const char *const *sets,
                          size_t count);
// Lays the value with that number (from 0) of an axis on `root`, which it returns.
tree_node *sweep_lay(scenario_reader *reader, tree_node *root, const scenario_axis *axis,
                     int number);
// Puts the axes into the model, with their values as text.
void sweep_fill(scenario_reader *reader, const scenario_sweep *sweep, ld_model *model);

// A value as it is written, where, and the field that it is one of.
typedef struct written_value {
    const struct field_row *field;
    text_place at;
    const char *path; // of its key
    const char *text;
} written_value;

// The text of a scalar.
static inline written_value written_in(const struct field_row *field, const tree_node *scalar,
                                       const char *path)
{
    return (written_value){field, scalar->at, path, scalar->text};
}

// Reads `count` numbers, "15 km/h" or "0 0 1 m", in SI into `values`; false after a message.
bool quantity_read(scenario_reader *reader, const written_value *given, double *values, int count);

// Reads a table from the file that the text names (beside the file that names it), a RASP .eng
// file, a RockSim .rse file, a CSV file, a mesh or a sounding's text by the ending of its name;
// `sounding`: whether it was one. Messages about what it holds point into it. False after a
// message.
bool table_file_read(scenario_reader *reader, const written_value *given, ld_table *table,
                     double *clock, bool *sounding);
// The file that the text at `place` names, read once in a run and kept in reader->source; NULL
// after a message at `place`.
text_source *reader_open(scenario_reader *reader, text_place place, const char *path,
                         const char *name);

// The same of a file that is not text: its full path; in reader->source are that path and a digest.
// A file that has changed since, or is not of `digest` (NULL: any), is refused; then `digest` is
// its own.
const char *reader_keep(scenario_reader *reader, text_place place, const char *path,
                        const char *name, const char **digest);

// Reads a number in plain decimal notation at the start of `text` and returns its end; NULL if
// there is none, or none that is finite and normal: then `reason` says why, or is NULL.
const char *number_parse(const char *text, double *value, const char **reason);

#endif
