// Whether two models are the same to the bit, whatever they were read from.
#ifndef LD_TESTS_SUPPORT_MODEL_COMPARE_H
#define LD_TESTS_SUPPORT_MODEL_COMPARE_H

#include <string.h>

#include "model/fields/field.h"
#include "model/model.h"

static inline bool same_table(const ld_table *a, const ld_table *b)
{
    return a->rows == b->rows && a->columns == b->columns &&
           (a->rows == 0 || memcmp(a->data, b->data, a->rows * a->columns * sizeof(double)) == 0);
}

static inline bool same_axes(const ld_sweep_axis *a, const ld_sweep_axis *b, int count)
{
    bool same = true;
    for (int i = 0; i < count; i++) {
        same &= strcmp(a[i].path, b[i].path) == 0 && a[i].count == b[i].count &&
                memcmp(&a[i].together, &b[i].together, sizeof a[i].together) == 0;
        for (int k = 0; k < a[i].count && same; k++)
            same &= strcmp(a[i].value[k], b[i].value[k]) == 0;
    }
    return same;
}

// Whether the tables of the block are the same; forgets them.
static inline bool same_tables(const field_block *block, void *a, void *b)
{
    bool same = true;
    for (const field_row *f = block->fields; f->name; f++) {
        if (f->kind == FIELD_BLOCK) {
            same &= same_tables(f->block, field_at(a, f), field_at(b, f));
        } else if (f->kind == FIELD_LIST) {
            int count = field_switch(a, f);
            same &= count == field_switch(b, f);
            for (int i = 0; i < count && same; i++)
                same &= same_tables(f->block, field_entry(a, f, i), field_entry(b, f, i));
        } else if (f->kind == FIELD_TABLE) {
            ld_table *x = field_at(a, f), *y = field_at(b, f);
            same &= same_table(x, y);
            x->data = y->data = NULL;
        } else if (f->kind == FIELD_FACTORS) {
            ld_factor **x = field_at(a, f), **y = field_at(b, f);
            int count = field_switch(a, f);
            same &= count == field_switch(b, f) &&
                    (count == 0 || memcmp(*x, *y, (size_t)count * sizeof **x) == 0);
            *x = *y = NULL;
        } else if (f->kind == FIELD_CORRELATED) {
            ld_correlated **x = field_at(a, f), **y = field_at(b, f);
            int count = field_switch(a, f);
            same &= count == field_switch(b, f) &&
                    (count == 0 || memcmp(*x, *y, (size_t)count * sizeof **x) == 0);
            *x = *y = NULL;
        } else if (f->kind == FIELD_SWEEP) {
            ld_sweep_axis **x = field_at(a, f), **y = field_at(b, f);
            int count = field_switch(a, f);
            same &= count == field_switch(b, f) && same_axes(*x, *y, count);
            *x = *y = NULL;
        }
    }
    return same;
}

static inline bool same_model(const ld_model *left, const ld_model *right)
{
    ld_model a, b;
    memcpy(&a, left, sizeof a);
    memcpy(&b, right, sizeof b);
    bool titles = (!a.title && !b.title) || (a.title && b.title && strcmp(a.title, b.title) == 0);
    a.title = b.title = NULL;
    a.source = b.source = NULL;
    a.point = b.point = 0;
    memset(&a.completed, 0, sizeof a.completed); // where values are from, no value
    memset(&b.completed, 0, sizeof b.completed);
    bool tables = same_tables(&scenario_block, &a, &b);
    return titles && tables && memcmp(&a, &b, sizeof a) == 0;
}

#endif
