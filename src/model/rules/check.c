// Checks of a model that was filled by hand: every value against its table, then the rules.
#include "model/fields/factor.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "model/parts.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef struct model_checker {
    const ld_model *model;
    bool drawn; // what the study says was checked before it drew
    ld_error *error;
    ld_status status;
} model_checker;

// Where a value stands, written out only where it is refused: many models are checked in a study.
typedef struct key_path {
    const struct key_path *above; // NULL: of the whole scenario
    const char *key;
    int entry; // of the list of that key, from 1; 0: no list
} key_path;

static void refuse_rule(void *self, const char *path, const char *text)
{
    model_checker *checker = self;
    if (checker->status == LD_OK)
        checker->status = ld_fail(checker->error, LD_ERR_INPUT, "%s: %s", path, text);
}

// The path as text; returns its length.
static size_t write_path(const key_path *path, char *text, size_t size)
{
    if (!path)
        return 0;
    size_t at = write_path(path->above, text, size);
    const char *dot = at ? "." : "";
    int more = path->entry
                   ? snprintf(text + at, size - at, "%s%.100s.%d", dot, path->key, path->entry)
                   : snprintf(text + at, size - at, "%s%.100s", dot, path->key);
    return at + (size_t)more < size ? at + (size_t)more : size - 1;
}

static void report_refused(model_checker *checker, const key_path *path, const char *text)
{
    char written[160] = "";
    write_path(path, written, sizeof written);
    refuse_rule(checker, written, text);
}

// One number of a field; `optional` allows NaN.
static void check_number(model_checker *checker, const key_path *path, const field_row *f,
                         double value)
{
    char range[96], text[192];
    bool optional = !f->required && isnan(f->initial);
    if ((optional && isnan(value)) || (isfinite(value) && field_in_range(f->range, value)))
        return;
    field_range_text(f, range, sizeof range);
    snprintf(text, sizeof text, "%g%s%s is not allowed%s%s", value, f->unit[0] ? " " : "", f->unit,
             range[0] ? "; expected " : "", range);
    report_refused(checker, path, text);
}

static void check_choice(model_checker *checker, const key_path *path, const field_row *f,
                         const void *base)
{
    int value;
    if (f->offset == FIELD_NOWHERE)
        return;
    memcpy(&value, field_at_const(base, f), sizeof value);
    const field_word *word = field_word_of(f->words, value);
    if (!word)
        report_refused(checker, path, "not a value of this choice");
    else if (!word->name[0])
        check_number(checker, path, f, *(const double *)((const char *)base + f->other));
}

static void check_integer(model_checker *checker, const key_path *path, const field_row *f,
                          const void *base)
{
    int value;
    char text[96];
    if (f->offset == FIELD_NOWHERE)
        return;
    memcpy(&value, field_at_const(base, f), sizeof value);
    if (field_in_range(f->range, value))
        return;
    snprintf(text, sizeof text, "%d is not from %g to %.9g", value, f->range.low, f->range.high);
    report_refused(checker, path, text);
}

static void check_integers(model_checker *checker, const key_path *path, const field_row *f,
                           const void *base)
{
    int count = field_switch(base, f);
    char text[96];
    if (count < f->least || count > f->count) {
        snprintf(text, sizeof text, "%d numbers, not %d to %d", count, f->least, f->count);
        report_refused(checker, path, text);
        return;
    }
    for (int i = 0; i < count; i++) {
        int value = ((const int *)field_at_const(base, f))[i];
        if (field_in_range(f->range, value))
            continue;
        snprintf(text, sizeof text, "%d is not from %g to %.9g", value, f->range.low,
                 f->range.high);
        report_refused(checker, path, text);
    }
}

static void check_table(model_checker *checker, const key_path *path, const field_row *f,
                        const ld_table *table)
{
    if (f->required && table->rows == 0)
        report_refused(checker, path, "missing");
    if (table->rows == 0)
        return;
    const table_format *format = field_table_format(f->table, table->columns);
    if (!format) {
        report_refused(checker, path, "does not have the required columns");
        return;
    }
    for (size_t i = 0; i < table->rows; i++)
        for (size_t k = 0; k < table->columns; k++)
            check_number(checker, path, &format->column[k], table->data[i * table->columns + k]);
}

static void check_block(model_checker *checker, const key_path *path, const field_block *block,
                        const void *base);

static void check_list(model_checker *checker, const key_path *path, const field_row *f,
                       const void *base)
{
    int count = field_switch(base, f);
    char text[96];
    if (count < f->least || count > f->count) {
        snprintf(text, sizeof text, "%d entries, not %d to %d", count, f->least, f->count);
        report_refused(checker, path, text);
        return;
    }
    for (int i = 0; i < count; i++) {
        const key_path entry = {path->above, path->key, i + 1};
        check_block(checker, &entry, f->block, field_entry_const(base, f, i));
    }
}

static void check_factors(model_checker *checker, const ld_scatter *scatter)
{
    char path[LD_MAX_PATH + 24], why[384];
    for (int i = 0; i < scatter->factor_count; i++) {
        const ld_factor *factor = &scatter->factor[i];
        if (factor_is_possible(checker->model, factor, why, sizeof why))
            continue;
        snprintf(path, sizeof path, "scatter.factors.%.*s", LD_MAX_PATH - 1, factor->path);
        refuse_rule(checker, path, why);
    }
}

static void check_correlated(model_checker *checker, const ld_scatter *scatter)
{
    char path[48], why[384];
    for (int i = 0; i < scatter->correlated_count; i++) {
        const ld_correlated *group = &scatter->correlated[i];
        bool known = group->count >= 2 && group->count <= LD_MAX_CORRELATED;
        for (int k = 0; known && k < group->count; k++)
            known = group->factor[k] >= 0 && group->factor[k] < scatter->factor_count;
        snprintf(path, sizeof path, "scatter.correlated.%d", i + 1);
        if (!known)
            refuse_rule(checker, path,
                        "is not a group of two or more of the scatter's factors, or has too many");
        else if (!correlated_is_possible(scatter, group, why, sizeof why))
            refuse_rule(checker, path, why);
    }
}

static void check_until(model_checker *checker, const ld_scatter *scatter)
{
    char path[48];
    if (scatter->until_count < 0 || scatter->until_count > LD_MAX_UNTIL) {
        refuse_rule(checker, "scatter.until", "more statistics than fit");
        return;
    }
    for (int i = 0; i < scatter->until_count; i++) {
        const ld_until *until = &scatter->until[i];
        bool good =
            until->half_width > 0 && isfinite(until->half_width) &&
            memchr(until->result, '\0', LD_MAX_NAME) &&
            (until->statistic == LD_STATISTIC_MEAN || until->statistic == LD_STATISTIC_DEVIATION);
        snprintf(path, sizeof path, "scatter.until.%d", i + 1);
        if (!good)
            refuse_rule(checker, path, "no statistic with a half width > 0");
    }
}

static void check_bounds(model_checker *checker, const ld_optimise *optimise)
{
    char path[LD_MAX_PATH + 24], why[384];
    if (optimise->key_count < 0 || optimise->key_count > LD_MAX_BOUNDS)
        refuse_rule(checker, "optimise.over", "more keys than fit");
    for (int i = 0; i < optimise->key_count && i < LD_MAX_BOUNDS; i++) {
        const ld_bounds *bounds = &optimise->key[i];
        field_place place;
        bool good = memchr(bounds->path, '\0', sizeof bounds->path) &&
                    field_locate(checker->model, bounds->path, &place, why, sizeof why) &&
                    bounds->from < bounds->to && (!bounds->log || bounds->from > 0);
        snprintf(path, sizeof path, "optimise.over.%d", i + 1);
        if (!good)
            refuse_rule(checker, path, "no number of the model with bounds in rising order");
    }
}

static void check_sweep(model_checker *checker, const ld_model *model)
{
    int64_t points = 1;
    for (int i = 0; i < model->sweep_count && points <= LD_MAX_POINTS; i++) {
        int count = model->sweep[i].count;
        points *= count > LD_MAX_POINTS ? LD_MAX_POINTS + 1 : count;
    }
    if (points < 1 || points > LD_MAX_POINTS)
        refuse_rule(checker, "sweep", "has no points, or more than are allowed");
}

// What a study says.
static void check_study(model_checker *checker, field_kind kind, const void *base)
{
    if (kind == FIELD_FACTORS)
        check_factors(checker, base);
    else if (kind == FIELD_CORRELATED)
        check_correlated(checker, base);
    else if (kind == FIELD_UNTIL)
        check_until(checker, base);
    else if (kind == FIELD_BOUNDS)
        check_bounds(checker, base);
    else
        check_sweep(checker, base);
}

static void check_field(model_checker *checker, const key_path *path, const field_row *f,
                        const void *base)
{
    switch (f->kind) {
    case FIELD_NUMBER:
        for (int i = 0; i < f->count; i++)
            check_number(checker, path, f, ((const double *)field_at_const(base, f))[i]);
        break;
    case FIELD_INTEGER:
        check_integer(checker, path, f, base);
        break;
    case FIELD_INTEGERS:
        check_integers(checker, path, f, base);
        break;
    case FIELD_WORDS:
        for (unsigned left = *(const unsigned *)field_at_const(base, f), bit = 0; left;
             left >>= 1, bit++)
            if (left & 1u && !field_word_of(f->words, (int)bit)) {
                report_refused(checker, path, "not a value of this choice");
                break;
            }
        break;
    case FIELD_CHOICE:
        check_choice(checker, path, f, base);
        break;
    case FIELD_BLOCK:
        if (f->words && !field_word_of(f->words, field_switch(base, f)))
            report_refused(checker, path, "not a value of this choice");
        else if (!f->words || !field_word_of(f->words, field_switch(base, f))->name[0])
            check_block(checker, path, f->block, field_at_const(base, f));
        break;
    case FIELD_LIST:
        if (f->alternative && field_switch(base, f->alternative))
            check_block(checker, path, f->alternative->block, field_at_const(base, f->alternative));
        else
            check_list(checker, path, f, base);
        break;
    case FIELD_TABLE:
        check_table(checker, path, f, field_at_const(base, f));
        break;
    case FIELD_WORD:
        if (!memchr(field_at_const(base, f), '\0', LD_MAX_NAME))
            report_refused(checker, path, "not terminated by a zero");
        break;
    case FIELD_QUANTITY:
        if (!memchr(field_at_const(base, f), '\0', LD_MAX_QUANTITY))
            report_refused(checker, path, "not terminated by a zero");
        break;
    case FIELD_FACTORS:
    case FIELD_CORRELATED:
    case FIELD_UNTIL:
    case FIELD_SWEEP:
    case FIELD_BOUNDS:
        if (!checker->drawn)
            check_study(checker, f->kind, base);
        break;
    case FIELD_LIMIT: // any
    case FIELD_TEXT:
    case FIELD_FILE:
    case FIELD_SELECTION:
        break;
    }
}

static void check_block(model_checker *checker, const key_path *path, const field_block *block,
                        const void *base)
{
    int form = field_form(block, base);
    if (block->form && (form < 0 || !field_word_of(block->form, form))) {
        report_refused(checker, path, "not a value of this choice");
        return;
    }
    for (const field_row *f = block->fields; f->name; f++)
        if (field_has_form(f, form) && !field_is_absent(f, base, form))
            check_field(checker, &(key_path){path, f->name, 0}, f, base);
}

// What model_complete() computes must be there.
static void check_complete(model_checker *checker, const ld_model *model)
{
    char path[32];
    bool launch = model_has_launcher(model);
    for (int i = 0; launch && i < model->tubes.section_count; i++) {
        const ld_section *s = &model->tubes.section[i];
        double sum = s->mass_per_length + s->axial_stiffness + section_stiffness_y(s) +
                     section_stiffness_z(s) + s->torsion_stiffness + s->polar_inertia;
        snprintf(path, sizeof path, "tubes.sections.%d", i + 1);
        if (isnan(sum))
            refuse_rule(checker, path,
                        "its stiffnesses and masses are not computed; call model_complete()");
    }
    if (isnan(model->rocket.propellant))
        refuse_rule(checker, "rocket.propellant", "not computed; call model_complete()");
    if (launch && isnan(model->run.stuck_time))
        refuse_rule(checker, "run.stuck_time", "not computed; call model_complete()");
    if (launch && isnan(model->run.max_step))
        refuse_rule(checker, "run.max_step", "not computed; call model_complete()");
}

static ld_status check(const ld_model *model, bool drawn, ld_error *error)
{
    model_checker checker = {model, drawn, error, LD_OK};
    if (isnan(model->environment.ground_height))
        refuse_rule(&checker, "environment.ground", "not computed; call model_complete()");
    check_block(&checker, NULL, &scenario_block, model);
    if (checker.status == LD_OK)
        model_check_rules(model, refuse_rule, &checker);
    if (checker.status == LD_OK)
        check_complete(&checker, model);
    return checker.status;
}

ld_status model_check(const ld_model *model, ld_error *error)
{
    return check(model, false, error);
}

ld_status model_check_drawn(const ld_model *model, ld_error *error)
{
    return check(model, true, error);
}
