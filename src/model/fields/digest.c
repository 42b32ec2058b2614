#include "model/fields/digest.h"

#include <string.h>

#include "model/fields/field.h"
#include "model/model.h"

uint64_t digest_bytes(uint64_t digest, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    for (size_t i = 0; i < size; i++)
        digest = (digest ^ at[i]) * UINT64_C(1099511628211);
    return digest;
}

static uint64_t of_int(uint64_t digest, int value)
{
    return digest_bytes(digest, &value, sizeof value);
}

static uint64_t of_text(uint64_t digest, const char *text)
{
    return text ? digest_bytes(digest, text, strlen(text) + 1) : of_int(digest, 0);
}

static uint64_t of_table(uint64_t digest, const ld_table *table)
{
    digest = digest_bytes(digest, &table->rows, sizeof table->rows);
    digest = digest_bytes(digest, &table->columns, sizeof table->columns);
    return digest_bytes(digest, table->data, table->rows * table->columns * sizeof(double));
}

static uint64_t of_block(uint64_t digest, const field_block *block, const void *base);

static uint64_t of_list(uint64_t digest, const field_row *f, const void *base)
{
    const field_row *other = f->alternative;
    if (other && field_switch(base, other))
        return of_block(digest, other->block, field_at_const(base, other));
    int count = field_switch(base, f);
    digest = of_int(digest, count);
    for (int i = 0; i < count; i++)
        digest = of_block(digest, f->block, field_entry_const(base, f, i));
    return digest;
}

static uint64_t of_field(uint64_t digest, const field_row *f, const void *base)
{
    const void *at = field_at_const(base, f);
    switch (f->kind) {
    case FIELD_NUMBER:
        return digest_bytes(digest, at, (size_t)f->count * sizeof(double));
    case FIELD_INTEGER:
    case FIELD_WORDS:
        return digest_bytes(digest, at, sizeof(int));
    case FIELD_INTEGERS:
        digest = of_int(digest, field_switch(base, f));
        return digest_bytes(digest, at, (size_t)field_switch(base, f) * sizeof(int));
    case FIELD_WORD:
    case FIELD_QUANTITY:
        return of_text(digest, at);
    case FIELD_TEXT:
    case FIELD_FILE:
        return of_text(digest, *(char *const *)at);
    case FIELD_CHOICE:
        digest = digest_bytes(digest, at, sizeof(int));
        return f->other ? digest_bytes(digest, (const char *)base + f->other, sizeof(double))
                        : digest;
    case FIELD_BLOCK:
        if (f->words)
            digest = of_int(digest, field_switch(base, f));
        return of_block(digest, f->block, at);
    case FIELD_LIST:
        return of_list(digest, f, base);
    case FIELD_SELECTION:
        for (int i = 0; i < field_switch(base, f); i++)
            digest = of_int(digest, field_marked(base, f, i));
        return digest;
    case FIELD_TABLE:
        if (f->table->sources & TABLE_CLOCK)
            digest = digest_bytes(digest, (const char *)base + f->other, sizeof(double));
        return of_table(digest, at);
    default:
        return digest;
    }
}

static uint64_t of_block(uint64_t digest, const field_block *block, const void *base)
{
    int form = field_form(block, base);
    digest = of_int(digest, form);
    for (const field_row *f = block->fields; f->name; f++)
        if (f->offset != FIELD_NOWHERE && field_has_form(f, form))
            digest = of_field(digest, f, base);
    return digest;
}

uint64_t model_digest(const ld_model *model)
{
    uint64_t digest = of_block(DIGEST_BEGIN, &scenario_block, model);
    const field_block *rocket = field_find(&scenario_block, "rocket")->block;
    for (int i = 0; model->salvo && i < model->firing_count; i++) {
        ld_model with = *model; // its tables know a rocket by its place in a model
        with.rocket = model->salvo[i];
        digest = of_block(digest, rocket, &with);
    }
    return digest;
}
