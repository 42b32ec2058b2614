#include "run/aims.h"

#include <stdio.h>
#include <string.h>

#include "flight/flight_history.h"
#include "model/blocks/measure.h"
#include "model/parts.h"
#include "quantities/study_results.h"
#include "run/measure_names.h"

// ---- where rockets land

static const char no_aim[] =
    "says where the rocket flies or lands, which is no aim: expected a disturbance, a load or a "
    "time, or take: footprint, the area in which rockets land";

static bool is_place(const char *unit)
{
    return strcmp(unit, "m") == 0 || strcmp(unit, "rad") == 0;
}

// The measures that were looked at, whose expressions may name each other.
typedef struct seen_measures {
    bool at[LD_MAX_MEASURES];
} seen_measures;

static bool is_of_landing(const ld_model *model, const char *name, seen_measures *seen);

// Whether a word of an expression is such a result or, `flight`, a place or a direction in flight.
static bool is_word_of_landing(const ld_model *model, const char *word, bool flight,
                               seen_measures *seen)
{
    const quantity_things things = quantity_things_of(model);
    const quantity *column = quantity_like(&flight_quantities, word);
    if (flight && column && column->unit && is_place(column->unit))
        return true;
    return study_result_find(&things, word).row && is_of_landing(model, word, seen);
}

// Whether a word of the expression is such a one. Of a flight are expressions that name one of its
// instants.
static bool has_landing(const ld_model *model, const char *expression, seen_measures *seen)
{
    static const char letters[] = "-abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                  "0123456789_.";
    bool flight = !model_has_launcher(model) || strstr(expression, "t_burnout") ||
                  strstr(expression, "t_apogee") || strstr(expression, "t_impact");
    for (int hyphens = 0; hyphens < 2; hyphens++) // may be within a name, or a minus
        for (const char *at = expression; *at;) {
            char word[LD_MAX_QUANTITY];
            size_t length = strspn(at, letters + !hyphens);
            snprintf(word, sizeof word, "%.*s", (int)length, at);
            if (length && is_word_of_landing(model, word, flight, seen))
                return true;
            at += length + (length == 0);
        }
    return false;
}

// Whether a result says where the rocket lands, or is a measure of its places and directions in
// flight.
static bool is_of_landing(const ld_model *model, const char *name, seen_measures *seen)
{
    static const char *const landing[] = {"downrange", "drift", "range", "impact_angle"};
    const quantity_things things = quantity_things_of(model);
    const quantity_walk at = study_result_find(&things, name);
    for (size_t i = 0; i < sizeof landing / sizeof *landing; i++)
        if (strcmp(name, landing[i]) == 0)
            return true;
    if (!study_result_is_measure(name) || at.item < 0 || seen->at[at.item])
        return false;
    seen->at[at.item] = true;
    const ld_measure *measure = model_measure(model, at.item);
    if (measure->take == LD_TAKE_EXPRESSION)
        return measure->expression && has_landing(model, measure->expression, seen);
    return measure_is_in_flight(model, measure) && is_place(quantity_unit(&at));
}

// ---- an aim

// The unit of a result that may be an aim.
static bool find_result(const ld_model *model, const char *name, char unit[LD_MAX_UNIT], char *why,
                        size_t size)
{
    const quantity_things things = quantity_things_of(model);
    const quantity_walk at = study_result_find(&things, name);
    char near[QUANTITY_NAME];
    if (!at.row) {
        study_result_near(&things, name, near);
        snprintf(why, size, "\"%.90s\" is not a result%s%s%s", name,
                 *near ? ", did you mean \"" : "", near, *near ? "\"?" : "");
        return false;
    }
    seen_measures seen = {{false}};
    if (is_of_landing(model, name, &seen)) {
        snprintf(why, size, "%.90s %s", name, no_aim);
        return false;
    }
    const char *own = quantity_unit(&at);
    snprintf(unit, LD_MAX_UNIT, "%s", strcmp(own, "1") == 0 ? "" : own);
    return true;
}

bool aim_is_possible(const ld_model *model, const ld_aim *aim, char unit[LD_MAX_UNIT], char *why,
                     size_t size)
{
    char other[LD_MAX_UNIT];
    if (aim->take == LD_AIM_FOOTPRINT || aim_is_margin(aim)) {
        snprintf(unit, LD_MAX_UNIT, "%s",
                 aim->take == LD_AIM_FOOTPRINT      ? "m2"
                 : aim->take == LD_AIM_PHASE_MARGIN ? "rad"
                                                    : "");
        return true;
    }
    if (!find_result(model, aim->of, unit, why, size))
        return false;
    if (aim->take != LD_AIM_DEVIATION || !aim->beside[0])
        return true;
    if (!find_result(model, aim->beside, other, why, size))
        return false;
    if (strcmp(other, unit) != 0)
        snprintf(why, size, "%.90s and %.90s have different units", aim->of, aim->beside);
    return strcmp(other, unit) == 0;
}

void aim_text(const ld_aim *aim, char *text, size_t size)
{
    static const char *const words[] = {"mean of ", "deviation of ",   "mean of the greatest ", "",
                                        "",         "gain margin of ", "phase margin of "};
    if (aim->take == LD_AIM_QUANTILE)
        snprintf(text, size, "%.4g %% quantile of %s", 100 * aim->level, aim->of);
    else if (aim->take == LD_AIM_FOOTPRINT)
        snprintf(text, size, "area with 95 %% of the landings");
    else
        snprintf(text, size, "%s%s%s%s", words[aim->take], aim->of, aim->beside[0] ? " and " : "",
                 aim->take == LD_AIM_DEVIATION ? aim->beside : "");
}
