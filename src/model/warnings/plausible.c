// The walk over the rules of plausibility.
#include "model/warnings/plausible.h"

#include <string.h>

#include "math/functions.h"

enum { TABLES = 6, MOST_RULES = 256 };
static const plausible_rule *const tables[TABLES] = {plausible_of_tube,       plausible_of_base,
                                                     plausible_of_rocket,     plausible_of_vehicle,
                                                     plausible_of_stabiliser, plausible_of_run};

// ---- the walk

// How many entries the list has in which # stands; 1 where there is none.
static int entries(const ld_model *model, const char *path)
{
    char list[LD_MAX_PATH], why[384];
    field_value value;
    const char *mark = strstr(path, ".#");
    snprintf(list, sizeof list, "%.*s", mark ? (int)(mark - path) : 0, path);
    if (!mark || !field_reach(model, list, &value, why, sizeof why))
        return 1;
    bool many = value.row->kind == FIELD_LIST || value.row->kind == FIELD_FACTORS;
    return many ? field_switch(value.base, value.row) : 1;
}

static void put_entry(char path[LD_MAX_PATH], const char *pattern, const char *entry)
{
    const char *mark = strchr(pattern, '#');
    if (mark)
        snprintf(path, LD_MAX_PATH, "%.*s%s%s", (int)(mark - pattern), pattern, entry, mark + 1);
    else
        snprintf(path, LD_MAX_PATH, "%s", pattern);
}

// Whether the scenario has the key; of one that ends with #, the list or table.
static bool is_there(const ld_model *model, const char *path)
{
    char list[LD_MAX_PATH], why[384];
    field_place place;
    field_value value;
    const char *mark = strstr(path, ".#");
    snprintf(list, sizeof list, "%.*s", mark ? (int)(mark - path) : LD_MAX_PATH - 1, path);
    return field_locate(model, list, &place, why, sizeof why) ||
           field_reach(model, list, &value, why, sizeof why);
}

static plausible_pair find_pair(const plausible_rule *rule, const plausible_entry *at,
                                const char *entry)
{
    char path[LD_MAX_PATH];
    bool whole = strchr(rule->path, '#') && !strstr(rule->path, "#.");
    put_entry(path, rule->path, whole ? "#" : entry);
    if (rule->find)
        return is_there(at->model, path) ? rule->find(at) : plausible_nothing();
    plausible_pair pair = plausible_alone(field_number(at->model, path));
    if (rule->other) {
        put_entry(path, rule->other, entry);
        pair.other = field_number(at->model, path);
    }
    return pair;
}

// Whether the rule says something about the entry; then the note, whose path it fills.
static bool is_noted(const plausible_rule *rule, const plausible_entry *at, char path[LD_MAX_PATH],
                     plausible_note *note)
{
    char number[16];
    snprintf(number, sizeof number, "%d", at->i + 1);
    plausible_pair pair = find_pair(rule, at, number);
    if (pair.row)
        snprintf(number, sizeof number, "%d", pair.row);
    put_entry(path, rule->path, pair.entry ? pair.entry : number);
    *note =
        (plausible_note){rule, path, pair.unit ? pair.unit : rule->unit, pair.value, pair.other};
    return pair.value < rule->low * pair.other || pair.value > rule->high * pair.other;
}

// Calls `report` for each note, whatever it rests on.
static void look_at_all(const ld_model *model, plausible_report *report, void *self)
{
    char path[LD_MAX_PATH];
    plausible_note note;
    for (int i = 0; i < TABLES; i++)
        for (const plausible_rule *rule = tables[i]; rule->path; rule++)
            for (int k = 0, count = entries(model, rule->path); k < count; k++)
                if (is_noted(rule, &(plausible_entry){model, k}, path, &note))
                    report(self, &note);
}

// Rules that have a note.
typedef struct noted_rules {
    const plausible_rule *rule[MOST_RULES];
    int count;
    plausible_report *report;
    void *self;
} noted_rules;

static void note_rule(void *self, const plausible_note *note)
{
    noted_rules *noted = self;
    bool known = noted->count > 0 && noted->rule[noted->count - 1] == note->rule;
    if (!known && noted->count < MOST_RULES)
        noted->rule[noted->count++] = note->rule;
}

// Whether the key of a rule is `key` or lies below it; NULL is no key.
static bool is_below(const plausible_rule *rule, const char *key)
{
    size_t length = key ? strlen(key) : 0;
    return length > 0 && strncmp(rule->path, key, length) == 0 &&
           (rule->path[length] == '.' || rule->path[length] == '\0');
}

// Reports a note unless what it rests on is noted.
static void report_first(void *self, const plausible_note *note)
{
    const noted_rules *noted = self;
    for (int i = 0; i < noted->count; i++)
        if (noted->rule[i] != note->rule && (is_below(noted->rule[i], note->rule->of) ||
                                             is_below(noted->rule[i], note->rule->other)))
            return;
    noted->report(noted->self, note);
}

void plausible_look(const ld_model *model, plausible_report *report, void *self)
{
    noted_rules noted = {.report = report, .self = self};
    look_at_all(model, note_rule, &noted);
    if (noted.count > 0)
        look_at_all(model, report_first, &noted);
}

// ---- the document

static const char azimuth[] = "platform.azimuth", elevation[] = "platform.elevation";

static bool is_of_elevation(const plausible_rule *rule)
{
    return strncmp(rule->path, elevation, strlen(elevation)) == 0;
}

// Whether it is a rule of the azimuth's hinge that the elevation's has, too.
static bool is_of_both(const plausible_rule *rule)
{
    if (strncmp(rule->path, azimuth, strlen(azimuth)) != 0)
        return false;
    for (int i = 0; i < TABLES; i++)
        for (const plausible_rule *r = tables[i]; r->path; r++)
            if (is_of_elevation(r) &&
                strcmp(r->path + strlen(elevation), rule->path + strlen(azimuth)) == 0 &&
                strcmp(r->what ? r->what : "", rule->what ? rule->what : "") == 0)
                return true;
    return false;
}

// A key's path with N for the entries of lists, both hinges of the platform as one; or words.
static void write_path(FILE *stream, const plausible_rule *rule, const char *path)
{
    char text[LD_MAX_PATH];
    put_entry(text, path, "N");
    if (strchr(text, ' '))
        fprintf(stream, "%s", text);
    else if (is_of_both(rule) && strncmp(text, azimuth, strlen(azimuth)) == 0)
        fprintf(stream, "`%s, elevation%s`", azimuth, text + strlen(azimuth));
    else
        fprintf(stream, "`%s`", text);
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
        if (are_alike(before, rule) && !is_of_elevation(before))
            return;
    fprintf(stream, "- ");
    write_path(stream, rule, rule->path);
    for (const plausible_rule *next = rule + 1; next->path; next++)
        if (are_alike(rule, next) && !is_of_elevation(next)) {
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
            if (!is_of_elevation(rule))
                write_rule(stream, tables[i], rule);
    fprintf(stream, "\n");
}
