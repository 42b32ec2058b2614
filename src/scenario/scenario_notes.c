// Warnings on values that are allowed but implausible: the rules of plausibility with their places
// in the text.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/warnings/plausible.h"
#include "scenario/scenario_reader.h"

// What a key is called with another prefix, a thousandfold from one to the next.
static const char *const ladders[][6] = {
    {"nm", "um", "mm", "m", "km"},
    {"mg", "g", "kg", "t"},
    {"us", "ms", "s"},
    {"mN", "N", "kN", "MN", "GN"},
    {"Pa", "kPa", "MPa", "GPa"},
    {"N/m", "kN/m", "MN/m", "GN/m"},
    {"N.m", "kN.m", "MN.m"},
    {"mrad", "rad"},
    {"mm/s", "m/s", "km/s"},
};
enum { LADDERS = sizeof ladders / sizeof *ladders };

// The unit a thousand times as large (step 1) or a thousandth (step -1), or NULL.
static const char *unit_beside(const char *unit, int step)
{
    for (int i = 0; i < LADDERS; i++)
        for (int k = 0; ladders[i][k]; k++)
            if (strcmp(ladders[i][k], unit) == 0)
                return step > 0 ? ladders[i][k + 1] : k > 0 ? ladders[i][k - 1] : NULL;
    return NULL;
}

// "; did you mean "82 um"?" where another prefix of the unit makes a value plausible.
static void suggest(const plausible_note *note, const char *written, char text[96])
{
    const plausible_rule *rule = note->rule;
    double least = rule->low * note->other, most = rule->high * note->other;
    bool far = note->value < (least > 0 ? least / 5 : 5 * least) || note->value > 5 * most;
    size_t digits = strspn(written, "0123456789+-.eE");
    const char *unit = written + digits + strspn(written + digits, " ");
    for (int step = -1; step <= 1 && far; step += 2) {
        double value = note->value * pow(1000, step);
        const char *other = unit_beside(unit, step);
        if (other && !(value < least) && !(value > most))
            snprintf(text, 96, "; did you mean \"%.*s %s\"?", (int)(digits < 40 ? digits : 40),
                     written, other);
    }
}

// A number with its unit as it is printed.
static void quantity_text(double value, const char *unit, char text[64])
{
    bool angle = strcmp(unit, "rad") == 0;
    snprintf(text, 64, "%.5g%s%s", angle ? value * 180 / 3.14159265358979323846 : value,
             unit[0] ? " " : "", angle ? "deg" : unit);
}

// What the rule compares with: a key's path, # being the entry of the warning, or words.
static void other_name(const plausible_note *note, char name[LD_MAX_PATH])
{
    const plausible_rule *rule = note->rule;
    const char *mark = strchr(rule->other, '#'), *entry = note->path + strcspn(rule->path, "#");
    if (mark)
        snprintf(name, LD_MAX_PATH, "%.*s%.*s%s", (int)(mark - rule->other), rule->other,
                 (int)strcspn(entry, "."), entry, mark + 1);
    else
        snprintf(name, LD_MAX_PATH, "%s", rule->other);
}

// ", but tubes.length is 3 m" or ", where 500 kg/m3 or more is usual".
static void comparison(const plausible_note *note, char text[256])
{
    const plausible_rule *rule = note->rule;
    bool below = note->value < rule->low * note->other;
    char number[64], name[LD_MAX_PATH];
    if (rule->other) {
        quantity_text(note->other, note->unit, number);
        other_name(note, name);
        snprintf(text, 256, ", but %s is %s", name, number);
    } else {
        quantity_text(below ? rule->low : rule->high, note->unit, number);
        snprintf(text, 256, ", where %s%s%s is usual", below ? "" : "up to ", number,
                 below ? " or more" : "");
    }
}

typedef struct note_context {
    scenario_reader *reader;
    const tree_node *root;
} note_context;

// The innermost node on the way to the path; `exact` whether that is what it leads to. The key of
// a factor has dots of its own.
static const tree_node *node_towards(const tree_node *root, const char *path, bool *exact)
{
    const tree_node *node = root;
    *exact = true;
    while (*path) {
        char key[LD_MAX_PATH];
        const tree_node *inner = node->kind == NODE_MAP ? tree_member(node, path) : NULL;
        size_t length = inner ? strlen(path) : strcspn(path, ".");
        snprintf(key, sizeof key, "%.*s", (int)length, path);
        if (!inner && node->kind != NODE_SCALAR)
            inner = node->kind == NODE_MAP ? tree_member(node, key) : tree_entry(node, key);
        if (!inner) {
            *exact = false;
            return node;
        }
        node = inner;
        path += length + (path[length] == '.');
    }
    return node;
}

static void take_note(void *self, const plausible_note *note)
{
    const note_context *context = self;
    const plausible_rule *rule = note->rule;
    bool exact;
    char full_path[READER_MAX_PATH], found[96], value[64], other[256], meant[96] = "", quoted[64];
    const tree_node *node = node_towards(context->root, note->path, &exact);
    bool written = exact && node->kind == NODE_SCALAR && !tree_is_empty(node) && !rule->what;
    text_place place = node->kind == NODE_SCALAR ? node->at : node->key_at;
    tree_path(context->root, note->path, full_path);
    snprintf(found, sizeof found, "%s%s", rule->what ? rule->what : "found",
             rule->what ? " is" : "");
    quantity_text(note->value, note->unit, value);
    comparison(note, other);
    if (written)
        suggest(note, node->text, meant);
    reader_refuse(context->reader, place, full_path, "%s %s%s: %s%s", found,
                  written ? reader_quote(node->text, quoted) : value, other, rule->why, meant);
}

void scenario_take_notes(scenario_reader *reader, const tree_node *root, const ld_model *model)
{
    plausible_check(model, take_note, &(note_context){reader, root});
}
