// Numbers of a model by the path of their keys.
#include <stdarg.h>
#include <string.h>

#include "base/suggestion.h"
#include "launchdyn/status.h"
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
                     (strcmp(f->name, "scatter") == 0 || strcmp(f->name, "sweep") == 0 ||
                      strcmp(f->name, "optimise") == 0);
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
