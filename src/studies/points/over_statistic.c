#include "studies/points/over_statistic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/scenario.h"
#include "studies/points/footprint.h"

static const estimate none = {NAN, NAN, NAN};

// ---- words

static ld_status refuse(const char *text, ld_error *error)
{
    return ld_fail(
        error, LD_ERR_INPUT,
        "--statistic: found \"%.60s\"; expected mean, deviation, quantile:P with P from 0 "
        "to 1, share:>LIMIT, share:<LIMIT or footprint[:0.95|:0.99|:0.999]",
        text);
}

// What follows "NAME:"; NULL where the text is not of that kind, `otherwise` where nothing follows.
static const char *after(const char *text, const char *name, const char *otherwise)
{
    size_t length = strlen(name);
    if (strncmp(text, name, length) != 0)
        return NULL;
    return text[length] == ':' ? text + length + 1 : text[length] ? NULL : otherwise;
}

static bool read_level(const char *text, double *level)
{
    ld_error error;
    return !ld_read_quantity(text, "", level, &error) && *level > 0 && *level < 1;
}

static bool read_share(const char *text, over_statistic *self)
{
    self->above = *text == '>';
    if (*text != '>' && *text != '<')
        return false;
    text += 1 + strspn(text + 1, " ");
    snprintf(self->limit, sizeof self->limit, "%s", text);
    return *text && strlen(text) < sizeof self->limit;
}

static bool is_footprint(double level)
{
    return level == 0.95 || level == 0.99 || level == 0.999;
}

ld_status over_statistic_read(const char *text, over_statistic *self, ld_error *error)
{
    const char *rest;
    *self = (over_statistic){.kind = OVER_MEAN};
    if (!text || strcmp(text, "mean") == 0)
        return LD_OK;
    if (strcmp(text, "deviation") == 0) {
        self->kind = OVER_DEVIATION;
        return LD_OK;
    }
    if ((rest = after(text, "quantile", NULL)) != NULL) {
        self->kind = OVER_QUANTILE;
        return read_level(rest, &self->level) ? LD_OK : refuse(text, error);
    }
    if ((rest = after(text, "share", NULL)) != NULL) {
        self->kind = OVER_SHARE;
        return read_share(rest, self) ? LD_OK : refuse(text, error);
    }
    if ((rest = after(text, "footprint", "0.95")) != NULL) {
        self->kind = OVER_FOOTPRINT;
        return read_level(rest, &self->level) && is_footprint(self->level) ? LD_OK
                                                                           : refuse(text, error);
    }
    return refuse(text, error);
}

static study_unit unit_of(const over_statistic *self, bool paired, const study_column *result)
{
    switch (self->kind) {
    case OVER_SHARE:
        return (study_unit){"%", 100};
    case OVER_FOOTPRINT:
        return (study_unit){"m2", 1};
    case OVER_DEVIATION:
        if (paired)
            return (study_unit){"", 1};
        break;
    default:
        break;
    }
    return study_result_unit(result->name, result->unit);
}

const char *over_statistic_word(const over *self, const over_statistic *statistic)
{
    static const char *const word[][2] = {[OVER_MEAN] = {"mean", "difference"},
                                          [OVER_DEVIATION] = {"standard deviation", "ratio"},
                                          [OVER_QUANTILE] = {"quantile", "difference"},
                                          [OVER_SHARE] = {"share", "difference"},
                                          [OVER_FOOTPRINT] = {"area", ""}};
    return word[statistic->kind][self->reference.data != NULL];
}

double over_statistic_same(const over_statistic *statistic)
{
    return statistic->kind == OVER_DEVIATION ? 1 : 0;
}

study_unit over_statistic_text(const over *self, const over_statistic *statistic,
                               const study_column *result, char *text, size_t size)
{
    const bool paired = self->reference.data;
    const char *name = result ? result->name : "";
    if (statistic->kind == OVER_SHARE)
        snprintf(text, size, "%sshare of %s %s %s", paired ? "difference of the " : "", name,
                 statistic->above ? "above" : "below", statistic->limit);
    else if (statistic->kind == OVER_FOOTPRINT)
        snprintf(text, size, "area with %.4g %% of the landings", 100 * statistic->level);
    else if (statistic->kind == OVER_QUANTILE)
        snprintf(text, size,
                 paired ? "difference of the %.4g %% quantiles of %s" : "%.4g %% quantile of %s",
                 100 * statistic->level, name);
    else if (statistic->kind == OVER_DEVIATION)
        snprintf(text, size, "%s of %s", paired ? "ratio of the deviations" : "standard deviation",
                 name);
    else
        snprintf(text, size, "%s of %s", paired ? "difference of the means" : "mean", name);
    return unit_of(statistic, paired, result);
}

// ---- numbers

ld_status over_statistic_columns(const over_statistic *self, const study_data *data,
                                 const study_column *result, const study_column *column[2],
                                 int *columns, ld_error *error)
{
    const char *nearest;
    *columns = self->kind == OVER_FOOTPRINT ? 2 : 1;
    column[0] = result;
    for (int k = 0; k < 2 && self->kind == OVER_FOOTPRINT; k++)
        if (!(column[k] = study_data_find(data, study_pairs[STUDY_LANDING].name[k], &nearest)))
            return ld_fail(error, LD_ERR_INPUT,
                           "--statistic footprint: the study has no landing points");
    return LD_OK;
}

// Puts 1 in the place of numbers that count, 0 in that of the others.
static ld_status count_share(pooled *of, const over_statistic *self, const study_column *result,
                             ld_error *error)
{
    double limit;
    ld_error why;
    if (ld_read_quantity(self->limit, result->unit, &limit, &why))
        return ld_fail(error, LD_ERR_INPUT, "--statistic share of %.100s: %.300s", result->name,
                       why.text);
    for (size_t i = 0; i < of->count; i++)
        for (int k = 0; k < POOLED_NUMBERS; k += POOLED_COLUMNS) {
            double *value = &of->row[i].value[k];
            *value = self->above ? *value > limit : *value < limit;
        }
    return LD_OK;
}

static ld_status find_footprint(const pooled *of, const over_statistic *self, estimate *area)
{
    footprint *found = malloc(sizeof *found);
    *area = none;
    if (!found)
        return LD_ERR_MEMORY;
    for (size_t i = 0; i < of->count; i++)
        for (int k = 0; k < 2; k++)
            of->value[k][i] = of->row[i].value[k];
    ld_status status = LD_OK;
    if (of->count > 0)
        status = footprint_of(of->value[0], of->value[1], of->group, of->count, found);
    for (int k = 0; k < FOOTPRINT_SHARES && of->count > 0 && !status; k++)
        if (found->region[k].share == self->level && !found->on_line)
            *area = found->region[k].area;
    free(found);
    return status;
}

static ld_status find_pairs(const pooled *of, const over_statistic *self, estimate *found)
{
    paired_statistics pairs;
    if (self->kind == OVER_QUANTILE)
        return pooled_quantile_difference(of, self->level, found);
    ld_status status = pooled_pairs(of, &pairs);
    *found = self->kind == OVER_DEVIATION ? pairs.spread : pairs.difference;
    return status;
}

static ld_status find_own(const pooled *of, const over_statistic *self, estimate *found)
{
    uncertain mean;
    if (self->kind == OVER_DEVIATION)
        return pooled_deviation(of, found);
    if (self->kind == OVER_QUANTILE)
        return pooled_quantile(of, self->level, found);
    if (self->kind == OVER_FOOTPRINT)
        return find_footprint(of, self, found);
    ld_status status = pooled_mean(of, &mean);
    *found = self->kind == OVER_SHARE ? share_interval(&mean, of->count) : interval_of(&mean);
    return status;
}

static ld_status refuse_differences(ld_error *error)
{
    return ld_fail(
        error, LD_ERR_INPUT,
        "--against compares means, deviations, shares and quantiles; leave out --against, "
        "or take another --statistic");
}

ld_status over_find(over *self, int cell, const over_statistic *statistic,
                    const study_column *result, over_found *found, ld_error *error)
{
    const study_column *column[2];
    int columns;
    pooled *of = &self->pool;
    const bool paired = self->reference.data;
    *found = (over_found){.of = none, .reference = paired && over_is_reference(self, cell)};
    if (paired && statistic->kind == OVER_FOOTPRINT)
        return refuse_differences(error);
    ld_status status =
        over_statistic_columns(statistic, self->data, result, column, &columns, error);
    if (!status)
        status = over_pool(self, cell, column, columns, error);
    if (!status && statistic->kind == OVER_SHARE)
        status = count_share(of, statistic, result, error);
    if (status)
        return status;
    found->count = of->count;
    found->groups = pooled_groups(of);
    found->points = of->points;
    if (of->count > 0 &&
        (paired ? find_pairs(of, statistic, &found->of) : find_own(of, statistic, &found->of)))
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's statistics");
    return LD_OK;
}
