// A model's values by the paths of their keys.
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "model/fields/field.h"
#include "model/fields/source.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "scenario/scenario_text.h"

// ---- set

// Whether an override's value is a list or a mapping, which others may be laid over.
static bool has_members(const char *value)
{
    return strchr("[{", value[strspn(value, " \t\r\n")]) != NULL;
}

// Adds an override; where it is plain, the earlier ones of the same key that are plain, too, go, so
// that a key may be set over and over.
static bool lay_over(ld_source *source, const char *set)
{
    size_t path = strcspn(set, "=") + 1, kept = 0, before = source->set_before;
    bool plain = set[path - 1] == '=' && !has_members(set + path);
    for (size_t i = 0; i < source->set_count; i++) {
        char *other = source->set[i];
        if (i < before && plain && strncmp(other, set, path) == 0 && !has_members(other + path)) {
            free(other);
            source->set_before--;
        } else {
            source->set[kept++] = other;
        }
    }
    source->set_count = kept;
    return source_add_set(source, set);
}

// Reads a model's texts again with overrides laid over them; `model` stays as it is.
static ld_status read_again(const ld_model *model, const char *const *sets, size_t count,
                            ld_model *fresh, ld_messages *messages)
{
    ld_source *source = source_copy(model->source);
    bool fine = source != NULL;
    *messages = (ld_messages){0};
    if (fine)
        source->set_before = source->set_count;
    for (size_t i = 0; i < count && fine; i++)
        fine = lay_over(source, sets[i]);
    ld_status status =
        fine ? scenario_read_source(source, model->point, fresh, messages) : LD_ERR_MEMORY;
    source_free(source);
    return status;
}

ld_status ld_model_set_all(ld_model *model, const char *const *sets, size_t count,
                           ld_messages *messages)
{
    ld_model fresh;
    ld_status status = read_again(model, sets, count, &fresh, messages);
    if (status)
        return status;
    model_clear(model);
    *model = fresh;
    return LD_OK;
}

ld_status ld_model_derive(const ld_model *model, const char *const *sets, size_t count,
                          ld_model **derived, ld_messages *messages)
{
    ld_model *fresh = malloc(sizeof *fresh);
    *messages = (ld_messages){0};
    ld_status status = fresh ? read_again(model, sets, count, fresh, messages) : LD_ERR_MEMORY;
    if (status)
        free(fresh);
    *derived = status ? NULL : fresh;
    return status;
}

ld_status ld_model_set(ld_model *model, const char *path, const char *value, ld_messages *messages)
{
    size_t size = strlen(path) + strlen(value) + 2;
    char *set = malloc(size);
    *messages = (ld_messages){0};
    if (!set)
        return LD_ERR_MEMORY;
    snprintf(set, size, "%s=%s", path, value);
    ld_status status = ld_model_set_all(model, (const char *const *)&set, 1, messages);
    free(set);
    return status;
}

// ---- get

ld_status ld_model_number(const ld_model *model, const char *path, double *value, ld_error *error)
{
    assert(model && path && value);
    field_place place;
    char why[LD_ERROR_TEXT];
    *value = NAN;
    if (!field_locate(model, path, &place, why, sizeof why))
        return ld_fail(error, LD_ERR_INPUT, "%s", why);
    *value = field_get(model, &place);
    return LD_OK;
}

// A number with its unit.
static void number_text(const ld_model *model, const field_place *place, char *text, size_t size)
{
    char number[32];
    const char *unit = place->row->unit ? place->row->unit : "";
    field_number_text(field_get(model, place), number);
    snprintf(text, size, "%s%s%s", number, unit[0] ? " " : "", unit);
}

static ld_status value_text(const ld_model *model, const char *path, char *text, size_t size,
                            ld_error *error)
{
    field_place place;
    field_value value;
    char why[LD_ERROR_TEXT];
    text[0] = '\0';
    if (field_reach(model, path, &value, why, sizeof why)) {
        ld_status status = scenario_value_text(&value, text, size);
        if (status == LD_ERR_INPUT)
            return ld_fail(error, status, "%s does not fit on one line", path);
        if (status)
            return ld_fail(error, status, "no memory");
    } else if (field_locate(model, path, &place, why, sizeof why)) {
        number_text(model, &place, text, size); // a component of a vector
    } else {
        return ld_fail(error, LD_ERR_INPUT, "%s", why);
    }
    return LD_OK;
}

ld_status ld_model_text(const ld_model *model, const char *path, char *text, size_t size,
                        ld_error *error)
{
    locale_t before = numeric_locale_enter();
    ld_status status = value_text(model, path, text, size, error);
    numeric_locale_leave(before);
    return status;
}

ld_status ld_model_table(const ld_model *model, const char *path, const double **table,
                         size_t *rows, size_t *columns, ld_error *error)
{
    field_value value;
    char why[LD_ERROR_TEXT];
    *table = NULL;
    *rows = *columns = 0;
    if (!field_reach(model, path, &value, why, sizeof why))
        return ld_fail(error, LD_ERR_INPUT, "%s", why);
    if (value.row->kind != FIELD_TABLE)
        return ld_fail(error, LD_ERR_INPUT, "%s is not a table", path);
    const ld_table *found = field_at_const(value.base, value.row);
    *table = found->data;
    *rows = found->rows;
    *columns = found->columns;
    return LD_OK;
}

// ---- the keys that there are

typedef struct key_taker {
    void (*take)(void *self, const ld_key *key);
    void *self;
} key_taker;

static void take_block(const key_taker *taker, const field_block *block, const char *above);

static void take_key(const key_taker *taker, const field_row *f, const char *above)
{
    char path[LD_MAX_PATH], expected[FIELD_EXPECTATION] = "";
    snprintf(path, sizeof path, "%s%s%s%s", above, above[0] ? "." : "", f->name,
             f->kind == FIELD_LIST ? ".N" : "");
    if (f->block)
        take_block(taker, f->block, path);
    if (f->alternative)
        take_key(taker, f->alternative, above);
    if (f->kind == FIELD_BLOCK || f->kind == FIELD_LIST)
        return;
    field_expectation(f, expected, sizeof expected);
    taker->take(taker->self, &(ld_key){.path = path,
                                       .unit = f->unit ? f->unit : "",
                                       .description = f->doc,
                                       .expected = expected,
                                       .low = f->range.low,
                                       .high = f->range.high,
                                       .required = f->required});
}

static void take_block(const key_taker *taker, const field_block *block, const char *above)
{
    for (const field_row *f = block->fields; f->name; f++)
        take_key(taker, f, above);
}

void ld_scenario_keys(void (*take)(void *self, const ld_key *key), void *self)
{
    take_block(&(key_taker){take, self}, &scenario_block, "");
}
