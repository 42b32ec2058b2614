#include "quantities/study_results.h"

#include <math.h>
#include <string.h>

#include "base/suggestion.h"

static void skip_unstudied(quantity_walk *walk)
{
    while (walk->row && !walk->row->studied)
        quantity_next(walk);
}

quantity_walk study_result_first(const quantity_things *things)
{
    quantity_walk walk = quantity_first(&rocket_quantities, things);
    skip_unstudied(&walk);
    return walk;
}

void study_result_next(quantity_walk *walk)
{
    quantity_next(walk);
    skip_unstudied(walk);
}

int study_result_count(const quantity_things *things)
{
    int count = 0;
    for (quantity_walk at = study_result_first(things); at.row; study_result_next(&at))
        count++;
    return count;
}

void study_result_name(const quantity_walk *at, char name[QUANTITY_NAME])
{
    quantity_text(at->row->name, at->group->each, at->item, at->things, name, QUANTITY_NAME);
}

quantity_walk study_result_find(const quantity_things *things, const char *name)
{
    quantity_walk at = quantity_find(&rocket_quantities, things, name);
    if (at.row && !at.row->studied)
        at.row = NULL;
    return at;
}

void study_result_near(const quantity_things *things, const char *name, char near[QUANTITY_NAME])
{
    name_suggestion best = suggestion_begin(name);
    near[0] = 0;
    for (quantity_walk at = study_result_first(things); at.row; study_result_next(&at)) {
        char offered[QUANTITY_NAME];
        const char *before = best.name;
        study_result_name(&at, offered);
        suggestion_offer(&best, offered);
        if (best.name != before) {
            strcpy(near, offered);
            best.name = near;
        }
    }
}

const quantity *study_result_like(const char *name)
{
    const quantity *row = quantity_like(&rocket_quantities, name);
    return row && row->studied ? row : NULL;
}

bool study_result_is_measure(const char *name)
{
    const quantity *row = study_result_like(name);
    return row && !row->unit;
}

// As the table after a run has it; small angles and rates in milliradians.
study_unit study_result_unit(const char *name, const char *si)
{
    static const struct {
        const char *si;
        study_unit shown;
    } units[] = {{"rad", {"mrad", 1e3}}, {"rad/s", {"mrad/s", 1e3}},
                 {"s", {"ms", 1e3}},     {"rad", {"deg", 57.29577951308232}},
                 {"m", {"mm", 1e3}},     {"N", {"kN", 1e-3}}};
    const quantity *row = study_result_like(name);
    double factor = row && row->line.factor > 0 ? row->line.factor : si[0] == 'r' ? 1e3 : 1;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(units[i].si, si) == 0 && fabs(units[i].shown.factor / factor - 1) < 1e-9)
            return units[i].shown;
    return (study_unit){strcmp(si, "1") == 0 ? "" : si, 1};
}

const study_pair study_pairs[STUDY_PAIRS] = {
    {"Landing points", {"downrange", "drift"}, "m"},
    {"Attitude at the exit, launcher's axes at ignition",
     {"since_ignition.pitch", "since_ignition.yaw"},
     "rad"},
    {"Rates at the exit, launcher's axes at ignition",
     {"since_ignition.pitch_rate", "since_ignition.yaw_rate"},
     "rad/s"},
    {"Attitude at the exit, ground frame", {"pitch", "yaw"}, "rad"},
    {"Rates at the exit, ground frame", {"pitch_rate", "yaw_rate"}, "rad/s"},
};
