// The walk over the rules of plausibility.
#include "model/warnings/plausible.h"

#include <string.h>

#include "model/blocks/platform.h"
#include "model/fields/field.h"
#include "model/parts.h"
#include "model/warnings/plausible_find.h"

enum { TABLES = 7, MOST_RULES = 256, HINGES = 2 };
static const plausible_rule *const tables[TABLES] = {
    plausible_of_tube,       plausible_of_base,      plausible_of_rocket, plausible_of_vehicle,
    plausible_of_stabiliser, plausible_of_mechanism, plausible_of_run};

// ---- the walk

// How many entries there are for the # of a path: of the list before it, or both hinges of the
// platform; 1 where there is none.
static int entries(const ld_model *model, const char *path)
{
    char list[LD_MAX_PATH], why[384];
    field_value value;
    const char *mark = strstr(path, ".#");
    snprintf(list, sizeof list, "%.*s", mark ? (int)(mark - path) : 0, path);
    if (!mark || !field_reach(model, list, &value, why, sizeof why))
        return 1;
    if (value.row->kind == FIELD_BLOCK)
        return HINGES;
    bool many = value.row->kind == FIELD_LIST || value.row->kind == FIELD_FACTORS;
    return many ? field_switch(value.base, value.row) : 1;
}

static bool is_of_hinge(const plausible_rule *rule)
{
    return strncmp(rule->path, "platform.#", strlen("platform.#")) == 0;
}

// Whether the rule says something about entry `i`; then the warning, whose path it fills. There may
// be no azimuth hinge.
static bool is_implausible(const plausible_rule *rule, const ld_model *model, int i,
                           char path[LD_MAX_PATH], plausible_note *note)
{
    static const char *const hinges[HINGES] = {"azimuth", "elevation"};
    char number[16];
    if (is_of_hinge(rule) && i == 0 && !model_platform(model)->has_azimuth)
        return false;
    snprintf(number, sizeof number, "%d", i + 1);
    plausible_pair pair = plausible_find(rule, model, i, is_of_hinge(rule) ? hinges[i] : number);
    if (pair.row)
        snprintf(number, sizeof number, "%d", pair.row);
    const char *entry = is_of_hinge(rule) ? hinges[i] : pair.entry ? pair.entry : number;
    plausible_put_entry(path, rule->path, entry);
    *note =
        (plausible_note){rule, path, pair.unit ? pair.unit : rule->unit, pair.value, pair.other, i};
    return pair.value < rule->low * pair.other || pair.value > rule->high * pair.other;
}

// Calls `report` for each note, whatever it rests on.
static void check_all_rules(const ld_model *model, plausible_report *report, void *self)
{
    char path[LD_MAX_PATH];
    plausible_note note;
    for (int i = 0; i < TABLES; i++)
        for (const plausible_rule *rule = tables[i]; rule->path; rule++)
            for (int k = 0, count = entries(model, rule->path); k < count; k++)
                if (is_implausible(rule, model, k, path, &note))
                    report(self, &note);
}

// Rules that have a warning; of a hinge's each with its hinge.
typedef struct reported_rules {
    const plausible_rule *rule[MOST_RULES];
    int hinge[MOST_RULES];
    int count;
    plausible_report *report;
    void *self;
} reported_rules;

static void note_rule(void *self, const plausible_note *note)
{
    reported_rules *noted = self;
    int hinge = is_of_hinge(note->rule) ? note->entry : -1, last = noted->count - 1;
    bool known = last >= 0 && noted->rule[last] == note->rule && noted->hinge[last] == hinge;
    if (known || noted->count == MOST_RULES)
        return;
    noted->rule[noted->count] = note->rule;
    noted->hinge[noted->count++] = hinge;
}

// Whether the key of a rule is `key` or lies below it; NULL is not a key.
static bool is_below(const plausible_rule *rule, const char *key)
{
    size_t length = key ? strlen(key) : 0;
    return length > 0 && strncmp(rule->path, key, length) == 0 &&
           (rule->path[length] == '.' || rule->path[length] == '\0');
}

// Reports a warning unless what it rests on gives a warning.
static void report_first(void *self, const plausible_note *note)
{
    const reported_rules *noted = self;
    for (int i = 0; i < noted->count; i++) {
        bool here = noted->hinge[i] < 0 || noted->hinge[i] == note->entry;
        if (noted->rule[i] != note->rule && here &&
            (is_below(noted->rule[i], note->rule->of) ||
             is_below(noted->rule[i], note->rule->other)))
            return;
    }
    noted->report(noted->self, note);
}

void plausible_check(const ld_model *model, plausible_report *report, void *self)
{
    reported_rules noted = {.report = report, .self = self};
    check_all_rules(model, note_rule, &noted);
    if (noted.count > 0)
        check_all_rules(model, report_first, &noted);
}

// ---- the document

// A key's path with N for the entries of lists, both hinges of the platform as one; or words.
static void write_path(FILE *stream, const plausible_rule *rule, const char *path)
{
    char text[LD_MAX_PATH];
    plausible_put_entry(text, path, is_of_hinge(rule) ? "azimuth, elevation" : "N");
    fprintf(stream, strchr(path, ' ') ? "%s" : "`%s`", text);
}

static void write_bounds(FILE *stream, const plausible_rule *rule)
{
    bool angle = strcmp(rule->unit, "rad") == 0 && !rule->other;
    double scale = angle ? 180 / 3.14159265358979323846 : 1;
    bool low = isfinite(rule->low), high = isfinite(rule->high);
    if (low && high)
        fprintf(stream, "%.5g to ", rule->low * scale);
    else
        fprintf(stream, low ? "at least " : "at most ");
    double last = high ? rule->high : rule->low;
    bool once = rule->other && last == 1 && !(low && high);
    if (!once)
        fprintf(stream, "%.5g", last * scale);
    if (rule->other) {
        fprintf(stream, once ? "" : " times ");
        write_path(stream, rule, rule->other);
    } else {
        fprintf(stream, "%s%s", rule->unit[0] ? " " : "", angle ? "deg" : rule->unit);
    }
}

static bool are_equal(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

// Whether two rules differ by their paths alone.
static bool are_alike(const plausible_rule *a, const plausible_rule *b)
{
    return are_equal(a->what, b->what) && are_equal(a->other, b->other) &&
           strcmp(a->unit, b->unit) == 0 && a->low == b->low && a->high == b->high;
}

// A line with the paths of all rules like this one, unless a rule before it has it.
static void write_rule(FILE *stream, const plausible_rule *table, const plausible_rule *rule)
{
    for (const plausible_rule *before = table; before < rule; before++)
        if (are_alike(before, rule))
            return;
    fprintf(stream, "- ");
    write_path(stream, rule, rule->path);
    for (const plausible_rule *next = rule + 1; next->path; next++)
        if (are_alike(rule, next)) {
            fprintf(stream, ", ");
            write_path(stream, next, next->path);
        }
    bool article = rule->what && strncmp(rule->what, "the ", 4) == 0;
    fprintf(stream, "%s%s: ", rule->what ? ", " : "", rule->what ? rule->what + 4 * article : "");
    write_bounds(stream, rule);
    fprintf(stream, "\n");
}

void plausible_write_markdown(FILE *stream)
{
    fprintf(stream, "\n");
    for (int i = 0; i < TABLES; i++)
        for (const plausible_rule *rule = tables[i]; rule->path; rule++)
            write_rule(stream, tables[i], rule);
    fprintf(stream, "\n");
}
