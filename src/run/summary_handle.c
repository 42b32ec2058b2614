// Summaries as handles: numbers by their names.
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "launchdyn/summary.h"
#include "quantities/summary_quantities.h"
#include "run/measure_names.h"

ld_summary *ld_summary_new(void)
{
    return calloc(1, sizeof(ld_summary));
}

void ld_summary_free(ld_summary *self)
{
    free(self);
}

int ld_summary_rockets(const ld_summary *self)
{
    return self->rocket_count;
}

const char *ld_summary_stopped(const ld_summary *self)
{
    return self->complete ? NULL : self->stopped;
}

const char *ld_summary_note(const ld_summary *self, int index)
{
    return index >= 0 && index < self->note_count ? self->note[index] : NULL;
}

enum { PREFIX = 24, SUMMARY_NAME = PREFIX + QUANTITY_NAME };

// Numbers of one kind: a rocket's, the run's, its cost, a mode's; their names begin with a prefix.
typedef struct section {
    char prefix[PREFIX];
    const quantity_table *table; // NULL: there is no such section
    const void *from;
} section;

static section section_at(const ld_summary *self, int index)
{
    section s = {.prefix = ""};
    int rockets = self->rocket_count, modes = index - rockets - 2;
    if (!self->model || modes >= self->mode_count)
        return s;
    if (index < rockets) {
        snprintf(s.prefix, sizeof s.prefix, "rocket.%d.", index + 1);
        s.table = &rocket_quantities;
        s.from = &self->rocket[index];
    } else if (modes < 0) {
        s.table = index == rockets ? &run_quantities : &cost_quantities;
        s.from = self;
    } else {
        snprintf(s.prefix, sizeof s.prefix, "mode.%d.", modes + 1);
        s.table = &mode_quantities;
        s.from = &self->mode[modes];
    }
    return s;
}

static void take_section(const section *s, const quantity_things *things,
                         void (*take)(void *self, const ld_quantity *quantity), void *to)
{
    for (quantity_walk at = quantity_first(s->table, things); at.row; quantity_next(&at)) {
        char name[SUMMARY_NAME], text[QUANTITY_NAME], description[512];
        if ((at.group->launch && !things->launcher) || !quantity_is_there(at.group, s->from))
            continue;
        quantity_text(at.row->name, at.group->each, at.item, things, text, sizeof text);
        snprintf(name, sizeof name, "%s%s", s->prefix, text);
        quantity_text(at.row->description, at.group->each, at.item, things, description,
                      sizeof description);
        take(to,
             &(ld_quantity){name, quantity_unit(&at), description, quantity_value(&at, s->from)});
    }
}

void ld_summary_each(const ld_summary *self, void (*take)(void *self, const ld_quantity *quantity),
                     void *to)
{
    const quantity_things things = quantity_things_of(self->model);
    section s;
    for (int i = 0; (s = section_at(self, i)).table; i++)
        take_section(&s, &things, take, to);
}

// The nearest name so far, as a copy.
typedef struct likely {
    name_suggestion best;
    char name[SUMMARY_NAME];
} likely_name;

static void offer_quantity(void *self, const ld_quantity *offered)
{
    likely_name *likely = self;
    suggestion_offer(&likely->best, offered->name);
    if (likely->best.name == offered->name) {
        snprintf(likely->name, sizeof likely->name, "%s", offered->name);
        likely->best.name = likely->name;
    }
}

static ld_status refuse(const ld_summary *self, const char *name, ld_error *error)
{
    likely_name likely = {.best = suggestion_begin(name)};
    if (!self->model)
        return ld_fail(error, LD_ERR_INPUT, "the summary is empty: nothing has run");
    ld_summary_each(self, offer_quantity, &likely);
    if (likely.best.name)
        return ld_fail(error, LD_ERR_INPUT, "there is no result \"%s\", did you mean \"%s\"?", name,
                       likely.name);
    return ld_fail(error, LD_ERR_INPUT, "there is no result \"%s\"", name);
}

// The number of that very name; false: there is none.
static bool find_number(const ld_summary *self, const char *name, double *value)
{
    const quantity_things things = quantity_things_of(self->model);
    section s;
    for (int i = 0; (s = section_at(self, i)).table; i++) {
        size_t length = strlen(s.prefix);
        if (strncmp(name, s.prefix, length) != 0)
            continue;
        quantity_walk at = quantity_find(s.table, &things, name + length);
        if (!at.row)
            continue;
        *value = quantity_value(&at, s.from);
        return true;
    }
    return false;
}

ld_status ld_summary_number(const ld_summary *self, const char *name, double *value,
                            ld_error *error)
{
    assert(self && name && value);
    char now[SUMMARY_NAME];
    *value = NAN;
    if (find_number(self, name, value) ||
        (ld_current_name(name, now, sizeof now) && find_number(self, now, value)))
        return LD_OK;
    return refuse(self, name, error);
}
