#include "model/fields/factor.h"

#include <string.h>

#include "math/curves/distributions.h"
#include "model/fields/field.h"

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
