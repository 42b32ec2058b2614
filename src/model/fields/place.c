// Numbers of a model by the path of their keys.
#include <stdarg.h>
#include <string.h>

#include "base/suggestion.h"
#include "launchdyn/status.h"
#include "math/curves/distributions.h"
#include "model/fields/field.h"

// Where a walk along the keys of a path has come to.
typedef struct walk {
    const char *rest; // of the path
    char key[LD_MAX_NAME];
    const field_block *block;
    const void *base;   // the block's struct
    field_place *place; // its path: what has been walked
    char *why;
    size_t size;
} walk;

static bool refuse(const walk *w, const char *format, ...) LD_PRINTF(2, 3);
static bool refuse(const walk *w, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(w->why, w->size, format, arguments);
    va_end(arguments);
    return false;
}

// Takes the next key of the path; false at its end. A dot after the last key stays, as no key.
static bool next_key(walk *w)
{
    size_t length = strcspn(w->rest, ".");
    if (length == 0 || length >= sizeof w->key)
        return false;
    memcpy(w->key, w->rest, length);
    w->key[length] = '\0';
    w->rest += length;
    w->rest += w->rest[0] == '.' && w->rest[1];
    return true;
}

// Adds a key to the path that has been walked.
static bool extend(walk *w, const char *key)
{
    char *path = w->place->path;
    size_t length = strlen(path);
    if (length + strlen(key) + 2 > LD_MAX_PATH)
        return refuse(w, "the path is too long");
    snprintf(path + length, LD_MAX_PATH - length, "%s%s", length ? "." : "", key);
    return true;
}

// "no such key; did you mean ...?"
static bool refuse_key(const walk *w, const char *what, const char *nearest)
{
    const char *path = w->place->path;
    if (nearest)
        return refuse(w, "no %s \"%s\"%s%s, did you mean \"%s\"?", what, w->key,
                      path[0] ? " in " : "", path, nearest);
    return refuse(w, "no %s \"%s\"%s%s", what, w->key, path[0] ? " in " : "", path);
}

// The word that stands in place of a number or a block, or NULL.
static const char *word_in_place(const field_row *f, int value)
{
    const field_word *word = field_word_of(f->words, value);
    return word && !word->name[0] ? NULL : word ? word->name : "wrong";
}

static bool is_scalar(const field_row *f)
{
    if (f->kind == FIELD_CHOICE)
        return f->unit != NULL;
    return (f->kind == FIELD_NUMBER || f->kind == FIELD_INTEGER) && f->offset != FIELD_NOWHERE;
}

// The number that `f` stands for, or its component.
static bool take_number(walk *w, const field_row *f)
{
    static const char names[] = "wxyz";
    const char *base = w->base;
    int index = 0;
    w->place->row = f;
    w->place->whole = f->kind == FIELD_INTEGER;
    if (f->kind == FIELD_CHOICE && word_in_place(f, *(const int *)(base + f->offset)))
        return refuse(w, "%s is not a number in this scenario", w->place->path);
    if (f->kind == FIELD_NUMBER && f->count > 1) {
        const char *first = names + 4 - f->count;
        if (!next_key(w))
            return refuse(w, "%s is a vector: name a component, .%c to .z", w->place->path, *first);
        const char *name = w->key[1] ? NULL : strchr(first, w->key[0]);
        if (!name)
            return refuse_key(w, "component", NULL);
        index = (int)(name - first);
        if (!extend(w, w->key))
            return false;
    }
    if (w->rest[0])
        return refuse(w, "%s is a number and has no keys", w->place->path);
    size_t within = f->kind == FIELD_CHOICE ? f->other : f->offset;
    w->place->offset += within + (size_t)index * sizeof(double);
    return true;
}

// The name of a list's entry, or NULL.
static const char *entry_name(const field_row *f, const void *entry)
{
    const field_row *name = field_find(f->block, "name");
    return name && name->kind == FIELD_WORD ? field_at_const(entry, name) : NULL;
}

static bool enter_block(walk *w, const field_row *f)
{
    const char *word = f->words ? word_in_place(f, field_switch(w->base, f)) : NULL;
    if (word)
        return refuse(w, "%s is %s in this scenario", w->place->path, word);
    w->place->offset += f->offset;
    w->block = f->block;
    w->base = field_at_const(w->base, f);
    return true;
}

static bool enter_list(walk *w, const field_row *f)
{
    if (f->alternative && field_switch(w->base, f->alternative))
        return enter_block(w, f->alternative);
    int count = field_switch(w->base, f), chosen = -1;
    if (!next_key(w))
        return refuse(w, "%s is a list: name one of its members%s", w->place->path,
                      count ? ", or give its number from 1" : "; it has none");
    name_suggestion best = suggestion_begin(w->key);
    for (int i = 0; i < count && chosen < 0; i++) {
        const char *name = entry_name(f, field_entry_const(w->base, f, i));
        char number[16];
        snprintf(number, sizeof number, "%d", i + 1);
        if (strcmp(w->key, number) == 0 || (name && strcmp(w->key, name) == 0))
            chosen = i;
        if (name)
            suggestion_offer(&best, name);
    }
    if (chosen < 0)
        return refuse_key(w, "member", best.name);
    const void *entry = field_entry_const(w->base, f, chosen);
    const char *name = entry_name(f, entry);
    char number[16];
    snprintf(number, sizeof number, "%d", chosen + 1);
    w->place->offset += f->offset + (size_t)chosen * f->stride;
    w->block = f->block;
    w->base = entry;
    return extend(w, name ? name : number);
}

// The row of the next key of the path; NULL after a refusal, or at the path's end.
static const field_row *next_row(walk *w)
{
    if (!next_key(w))
        return NULL;
    const field_row *f = field_find(w->block, w->key);
    if (!f) {
        refuse_key(w, "key", field_nearest_key(w->block, w->key));
        return NULL;
    }
    if (!extend(w, w->key))
        return NULL;
    if (!field_has_form(f, field_form(w->block, w->base))) {
        refuse(w, "%s does not belong to this scenario", w->place->path);
        return NULL;
    }
    return f;
}

static walk begin_walk(const ld_model *model, const char *path, field_place *place, char *why,
                       size_t size)
{
    *place = (field_place){0};
    why[0] = '\0';
    return (walk){.rest = path,
                  .block = &scenario_block,
                  .base = model,
                  .place = place,
                  .why = why,
                  .size = size};
}

// Why a path that has come to its end is not what was looked for; false.
static bool refuse_end(const walk *w, const char *path)
{
    if (w->why[0])
        return false;
    if (w->rest[0] || !path[0])
        return refuse(w, "expected a path of keys joined by dots, such as rocket.mass");
    return refuse(w, "%s is a block: name one of its keys", w->place->path);
}

bool field_locate(const ld_model *model, const char *path, field_place *place, char *why,
                  size_t size)
{
    walk w = begin_walk(model, path, place, why, size);
    const field_row *f;
    while ((f = next_row(&w))) {
        if (is_scalar(f))
            return take_number(&w, f);
        bool study = w.block == &scenario_block &&
                     (strcmp(f->name, "scatter") == 0 || strcmp(f->name, "sweep") == 0);
        bool inside = study ? refuse(&w, "keys of the study itself cannot be uncertain")
                      : f->kind == FIELD_BLOCK ? enter_block(&w, f)
                      : f->kind == FIELD_LIST  ? enter_list(&w, f)
                                               : refuse(&w, "%s is not a number", place->path);
        if (!inside)
            return false;
    }
    return refuse_end(&w, path);
}

bool field_reach(const ld_model *model, const char *path, field_value *value, char *why,
                 size_t size)
{
    field_place place;
    walk w = begin_walk(model, path, &place, why, size);
    const field_row *f;
    while ((f = next_row(&w))) {
        *value = (field_value){f, w.base};
        if (!w.rest[0])
            return true;
        bool inside = f->kind == FIELD_BLOCK  ? enter_block(&w, f)
                      : f->kind == FIELD_LIST ? enter_list(&w, f)
                                              : refuse(&w, "%s has no keys", place.path);
        if (!inside)
            return false;
    }
    return refuse_end(&w, path);
}

double field_get(const ld_model *model, const field_place *place)
{
    const char *at = (const char *)model + place->offset;
    return place->whole ? *(const int *)at : *(const double *)at;
}

double field_number(const ld_model *model, const char *path)
{
    char why[384];
    field_place place;
    return field_locate(model, path, &place, why, sizeof why) ? field_get(model, &place) : NAN;
}

void field_set(ld_model *model, const field_place *place, double value)
{
    char *at = (char *)model + place->offset;
    if (place->whole)
        *(int *)at = (int)value;
    else
        *(double *)at = value;
}

// ---- factors

int factor_numbers(const ld_factor *factor)
{
    return factor->together.count ? factor->together.count : 1;
}

const char *factor_path(const ld_factor *factor, int number)
{
    return factor->together.count ? factor->together.path[number] : factor->path;
}

bool factor_may_be_per_rocket(const ld_factor *factor)
{
    bool below = true;
    for (int i = 0; i < factor_numbers(factor); i++)
        below &= strncmp(factor_path(factor, i), "rocket.", 7) == 0;
    return below;
}

// Whether a normal distribution about the nominal value has something between its bounds.
static bool has_values_between(const ld_factor *factor, double nominal)
{
    double low = (factor->between[0] - nominal) / factor->deviation;
    double high = (factor->between[1] - nominal) / factor->deviation;
    // on the side where the distribution function is accurate
    return low > 0 ? normal_cumulative(-low) > normal_cumulative(-high)
                   : normal_cumulative(high) > normal_cumulative(low);
}

// Whether values lie about that of the scenario.
static bool is_about_nominal(const ld_factor *factor)
{
    const distribution_row *row = distribution_of(factor->distribution);
    return (row->traits & LD_ABOUT_NOMINAL) ||
           (row->given == LD_GIVEN_SPAN && isnan(factor->between[0]));
}

// Whether the numbers of the factor after the first are alike and have its value in the scenario,
// where that counts.
static bool go_together(const ld_model *model, const ld_factor *factor, const field_place *first,
                        char *why, size_t size)
{
    for (int i = 1; i < factor_numbers(factor); i++) {
        field_place place;
        if (!field_locate(model, factor_path(factor, i), &place, why, size))
            return false;
        const char *unit = first->row->unit ? first->row->unit : "";
        const char *own = place.row->unit ? place.row->unit : "", *text = NULL;
        if (strcmp(unit, own) != 0 || place.whole != first->whole)
            text = "are not of one kind";
        else if (is_about_nominal(factor) && field_get(model, &place) != field_get(model, first))
            text = "do not have the same nominal value in the scenario";
        if (text) {
            snprintf(why, size, "%s and %s %s", first->path, place.path, text);
            return false;
        }
    }
    return true;
}

// Whether the distribution goes with one of the factor's numbers.
static bool goes_with(const ld_model *model, const ld_factor *factor, const field_place *place,
                      char *why, size_t size)
{
    double nominal = field_get(model, place);
    bool about = is_about_nominal(factor);
    const distribution_row *row = distribution_of(factor->distribution);
    const char *text = NULL;
    if (place->whole && !(row->traits & LD_FOR_WHOLE))
        text = "a whole number can only be discrete, or {each: sample}";
    else if (!place->whole && (row->traits & LD_SEED))
        text = "{each: sample} is for whole numbers, such as seeds";
    else if (factor->per_rocket && !factor_may_be_per_rocket(factor))
        text = "only keys below rocket can be sampled per rocket";
    else if (about && !isfinite(nominal))
        text = "has no nominal value in this scenario";
    else if ((row->traits & LD_ABOVE_ZERO) && nominal <= 0)
        text = "a %s distribution requires a nominal value > 0";
    else if ((row->traits & LD_BOUNDED) && !isnan(factor->between[0]) &&
             !has_values_between(factor, nominal))
        text = "a %s distribution has no values so far from the nominal value";
    if (text)
        snprintf(why, size, text, row->word);
    return !text;
}

bool factor_is_possible(const ld_model *model, const ld_factor *factor, char *why, size_t size)
{
    field_place first;
    return field_locate(model, factor_path(factor, 0), &first, why, size) &&
           goes_with(model, factor, &first, why, size) &&
           go_together(model, factor, &first, why, size);
}

bool correlated_factorise(const ld_correlated *group,
                          double lower[LD_MAX_CORRELATED][LD_MAX_CORRELATED])
{
    for (int i = 0; i < group->count; i++)
        for (int k = 0; k <= i; k++) {
            double rest = group->matrix[i][k];
            for (int j = 0; j < k; j++)
                rest -= lower[i][j] * lower[k][j];
            // the least pivot is far above rounding errors
            if (i == k && rest < 1e-10)
                return false;
            lower[i][k] = i == k ? sqrt(rest) : rest / lower[k][k];
        }
    return true;
}

// Whether the matrix has 1 on its diagonal, is symmetric and between -1 and 1.
static const char *wrong_with_matrix(const ld_correlated *group)
{
    for (int i = 0; i < group->count; i++)
        for (int k = 0; k <= i; k++) {
            double c = group->matrix[i][k];
            if (i == k && c != 1)
                return "its diagonal must be 1";
            if (c != group->matrix[k][i])
                return "must be symmetric";
            if (!(fabs(c) <= 1))
                return "has an entry that is not a number from -1 to 1";
        }
    double lower[LD_MAX_CORRELATED][LD_MAX_CORRELATED];
    return correlated_factorise(group, lower) ? NULL : "is not positive definite";
}

bool correlated_is_possible(const ld_scatter *scatter, const ld_correlated *group, char *why,
                            size_t size)
{
    const ld_factor *factor = scatter->factor, *first = &factor[group->factor[0]];
    for (int i = 0; i < group->count; i++) {
        const ld_factor *own = &factor[group->factor[i]];
        bool again = false;
        for (const ld_correlated *g = scatter->correlated; g <= group; g++)
            for (int k = 0; k < (g == group ? i : g->count); k++)
                again = again || g->factor[k] == group->factor[i];
        const char *text =
            again ? "is in a group already"
            : distribution_of(own->distribution)->traits & LD_SEED
                ? "is a seed, which cannot be correlated"
            : own->per_rocket != first->per_rocket
                ? "is not sampled as the first of its group, per rocket or per sample"
                : NULL;
        if (text) {
            snprintf(why, size, "%s %s", own->path, text);
            return false;
        }
    }
    const char *text = wrong_with_matrix(group);
    if (text)
        snprintf(why, size, "the matrix %s", text);
    return !text;
}
