// Measures in short, NAME: EXPRESSION, written out as blocks of a list.
#include <string.h>

#include "scenario/scenario_reader.h"

static bool is_expression(const tree_node *node)
{
    return node->kind == NODE_SCALAR && node->key && !tree_is_empty(node);
}

static void add_text(scenario_reader *reader, tree_node *block, const char *key,
                     const tree_node *from)
{
    tree_node *member = tree_new(reader, NODE_SCALAR, from->at);
    if (!member)
        return;
    member->key = key;
    member->key_at = from->key_at;
    member->text = from->text;
    member->plain = from->plain;
    tree_append(block, member);
}

// The block {name: KEY, expression: TEXT}, or the block of KEY with its name; NULL without memory.
static tree_node *written_out(scenario_reader *reader, const tree_node *member)
{
    tree_node *block = tree_new(reader, NODE_MAP, member->at);
    if (!block)
        return NULL;
    block->key_at = member->key_at;
    tree_node name = {.at = member->key_at, .key_at = member->key_at, .text = member->key};
    name.plain = true;
    add_text(reader, block, "name", &name);
    if (member->kind == NODE_SCALAR)
        add_text(reader, block, "expression", member);
    for (tree_node *inner = member->first, *next; inner; inner = next) {
        next = inner->next;
        tree_append(block, inner);
    }
    return block;
}

// The entry of a list in full: {KEY: TEXT} and, laid over another, a text with a key.
static tree_node *entry_in_full(scenario_reader *reader, tree_node *entry)
{
    const tree_node *only = entry->kind == NODE_MAP && entry->count == 1 ? entry->first : NULL;
    if (is_expression(entry))
        return written_out(reader, entry);
    if (only && is_expression(only) && strcmp(only->key, "name") != 0)
        return written_out(reader, only);
    return entry;
}

// Says of a block with an expression that it is one.
static void say_take(scenario_reader *reader, tree_node *block)
{
    static const char word[] = "expression";
    const tree_node *given = block->kind == NODE_MAP ? tree_member(block, word) : NULL;
    if (!given || tree_member(block, "take"))
        return;
    tree_node said = {.at = given->key_at, .key_at = given->key_at, .text = word};
    said.plain = true;
    add_text(reader, block, "take", &said);
}

static tree_node *member_in_full(scenario_reader *reader, tree_node *member)
{
    bool named = member->kind == NODE_MAP && tree_member(member, "name");
    return is_expression(member) || (member->kind == NODE_MAP && !named)
               ? written_out(reader, member)
               : member;
}

void measures_write_out(scenario_reader *reader, tree_node *root, bool whole)
{
    tree_node *measures = root->kind == NODE_MAP ? tree_member(root, "measures") : NULL;
    bool list = measures && measures->kind == NODE_LIST;
    bool map = measures && measures->kind == NODE_MAP && whole && !tree_member(measures, "of") &&
               !tree_member(measures, "take");
    tree_node *next = list || map ? measures->first : NULL;
    if (!next)
        return;
    measures->kind = NODE_LIST;
    measures->first = measures->last = NULL;
    measures->count = 0;
    while (next) {
        tree_node *member = next;
        next = member->next;
        member = map ? member_in_full(reader, member) : entry_in_full(reader, member);
        if (member && whole)
            say_take(reader, member);
        if (member)
            tree_append(measures, member);
    }
}
