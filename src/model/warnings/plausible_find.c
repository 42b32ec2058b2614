#include "model/warnings/plausible_find.h"

#include <stdio.h>
#include <string.h>

#include "math/functions.h"
#include "model/blocks/table.h"
#include "model/fields/field.h"
#include "model/warnings/estimates.h"

static const double PI = 3.14159265358979323846;

void plausible_put_entry(char path[LD_MAX_PATH], const char *pattern, const char *entry)
{
    const char *mark = strchr(pattern, '#');
    if (mark)
        snprintf(path, LD_MAX_PATH, "%.*s%s%s", (int)(mark - pattern), pattern, entry, mark + 1);
    else
        snprintf(path, LD_MAX_PATH, "%s", pattern);
}

// A rule that is checked.
typedef struct look {
    const plausible_rule *rule;
    plausible_entry at;
    const char *entry; // what stands for #
} look;

// An estimate's name has blanks, a path has none.
static double term(const look *self, const char *text)
{
    char path[LD_MAX_PATH];
    if (strchr(text, ' '))
        return estimate_named(text, &self->at);
    plausible_put_entry(path, text, self->entry);
    return field_number(self->at.model, path);
}

// The vector or table that is the rule's own key; NULL: there is none.
static const void *own_key(const look *self, field_value *value)
{
    char path[LD_MAX_PATH], why[384];
    plausible_put_entry(path, self->rule->path, self->entry);
    bool reached = field_reach(self->at.model, path, value, why, sizeof why);
    return reached ? field_at_const(value->base, value->row) : NULL;
}

static double norm(const look *self)
{
    field_value value;
    const double *v = own_key(self, &value);
    return !v ? NAN : value.row->count == 2 ? hypot(v[0], v[1]) : plausible_norm(v);
}

// NaN where all are 0.
static double greatest(const look *self)
{
    field_value value;
    const ld_table *table = own_key(self, &value);
    double most = 0;
    for (size_t i = 0; table && i < table->rows; i++)
        most = fmax(most, fabs(table->data[i * table->columns + (size_t)self->rule->column]));
    return most > 0 ? most : NAN;
}

static double value_of(const look *self)
{
    const plausible_rule *rule = self->rule;
    double a = rule->a ? term(self, rule->a) : self->at.own;
    double b = rule->b ? term(self, rule->b) : 1;
    switch (rule->form) {
    case PLAUSIBLE_TERM:
        return a;
    case PLAUSIBLE_DIFFERENCE:
        return a - b;
    case PLAUSIBLE_PRODUCT:
        return a * b;
    case PLAUSIBLE_RATIO:
        return a / b;
    case PLAUSIBLE_GYRATION:
        return sqrt(a / b);
    case PLAUSIBLE_RING:
        return sqrt(2 * a / b);
    case PLAUSIBLE_FREQUENCY:
        return sqrt(a / b) / (2 * PI);
    case PLAUSIBLE_DECAY:
        return a > 0 ? b / a : NAN;
    case PLAUSIBLE_DISTANCE:
        return hypot(a, b);
    case PLAUSIBLE_NORM:
        return norm(self);
    case PLAUSIBLE_GREATEST:
        return greatest(self) * b;
    }
    return NAN;
}

// Whether the scenario has the rule's key, and its value where it is a number; of a path that ends
// with #, the list or table.
static bool find_own(look *self)
{
    char path[LD_MAX_PATH], why[384];
    field_place place;
    field_value value;
    const plausible_rule *rule = self->rule;
    const char *mark = strstr(rule->path, ".#");
    bool whole = mark && !mark[2];
    if (whole)
        snprintf(path, sizeof path, "%.*s", (int)(mark - rule->path), rule->path);
    else
        plausible_put_entry(path, rule->path, self->entry);
    bool number = !whole && field_locate(self->at.model, path, &place, why, sizeof why);
    if (number)
        self->at.own = field_get(self->at.model, &place);
    return number || field_reach(self->at.model, path, &value, why, sizeof why);
}

plausible_pair plausible_find(const plausible_rule *rule, const ld_model *model, int i,
                              const char *entry)
{
    look self = {rule, {model, i, NAN}, entry};
    if (!find_own(&self) || (rule->when && !(term(&self, rule->when) > 0)))
        return plausible_nothing();
    if (rule->find)
        return rule->find(&self.at);
    const char *other = rule->with ? rule->with : rule->other;
    return plausible_compare(value_of(&self), other ? term(&self, other) : 1);
}
