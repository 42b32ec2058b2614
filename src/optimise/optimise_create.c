#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/fields/factor.h"
#include "model/model.h"
#include "optimise/optimise.h"
#include "run/aims.h"

// ---- keys

double optimise_key_value(const optimise_key *key, double x)
{
    double place = key->low + x * (key->high - key->low);
    return fmin(fmax(key->log ? exp(place) : place, key->from), key->to); // whatever was rounded
}

double optimise_key_place(const optimise_key *key, double value)
{
    return ((key->log ? log(value) : value) - key->low) / (key->high - key->low);
}

// Whether a factor replaces the key whatever its value.
static bool is_replaced(const ld_scatter *scatter, const char *path)
{
    for (int i = 0; i < scatter->factor_count; i++) {
        const ld_factor *factor = &scatter->factor[i];
        ld_given given = distribution_of(factor->distribution)->given;
        bool about = given == LD_GIVEN_DEVIATION || given == LD_GIVEN_RATIO ||
                     (given == LD_GIVEN_SPAN && isnan(factor->between[0]));
        for (int k = 0; k < factor_numbers(factor) && !about; k++)
            if (strcmp(factor_path(factor, k), path) == 0)
                return true;
    }
    return false;
}

static ld_status read_key(const ld_model *model, const ld_bounds *bounds, optimise_key *key,
                          ld_error *error)
{
    char why[384];
    if (!field_locate(model, bounds->path, &key->place, why, sizeof why))
        return ld_fail(error, LD_ERR_INPUT, "optimise.over.%s: %s", bounds->path, why);
    key->unit = key->place.row->unit ? key->place.row->unit : "";
    key->log = bounds->log;
    key->from = bounds->from;
    key->to = bounds->to;
    key->low = bounds->log ? log(bounds->from) : bounds->from;
    key->high = bounds->log ? log(bounds->to) : bounds->to;
    double now = field_get(model, &key->place);
    if (!(now >= bounds->from && now <= bounds->to))
        return ld_fail(error, LD_ERR_INPUT,
                       "optimise.over.%s: the search starts at the scenario's value, %.10g%s%s, "
                       "which is outside the bounds",
                       bounds->path, now, *key->unit ? " " : "", key->unit);
    if (is_replaced(&model->scatter, bounds->path))
        return ld_fail(error, LD_ERR_INPUT,
                       "optimise.over.%s: scatter.factors samples this key whatever its value",
                       bounds->path);
    return LD_OK;
}

// ---- aims

static int result_number(ld_optimisation *self, const char *name)
{
    int i = 0;
    while (i < self->results && strcmp(self->result[i], name) != 0)
        i++;
    if (i == self->results)
        snprintf(self->result[self->results++], QUANTITY_NAME, "%s", name);
    return i;
}

static study_unit shown_unit(const ld_aim *aim)
{
    if (aim->take == LD_AIM_PHASE_MARGIN)
        return (study_unit){"deg", 57.29577951308232};
    if (aim->take == LD_AIM_FOOTPRINT || aim->take == LD_AIM_GAIN_MARGIN)
        return (study_unit){aim->unit, 1};
    return study_result_unit(aim->of, aim->unit);
}

// Whether a statistic has values enough.
static ld_status check_values(const ld_optimisation *self, const ld_aim *aim, const char *path,
                              ld_error *error)
{
    bool spread = aim->take == LD_AIM_DEVIATION || aim->take == LD_AIM_QUANTILE ||
                  aim->take == LD_AIM_FOOTPRINT;
    if (!spread || self->samples * self->rockets > 2)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "%s: expected at least 3 launches for such a statistic, found %d; set "
                   "scatter.samples",
                   path, self->samples * self->rockets);
}

static ld_status add_aim(ld_optimisation *self, const ld_aim *as, const char *path, ld_error *error)
{
    optimise_aim *aim = &self->aim[self->aims++];
    char unit[LD_MAX_UNIT], why[384];
    *aim = (optimise_aim){.as = as,
                          .plan = {.take = as->take, .level = as->level, .first = -1, .second = -1},
                          .margin = -1,
                          .shown = shown_unit(as)};
    if (!aim_is_possible(self->model, as, unit, why, sizeof why))
        return ld_fail(error, LD_ERR_INPUT, "%s: %s", path, why);
    if (aim_is_margin(as)) {
        aim->margin = self->margins;
        self->margin[self->margins++] = as;
        return LD_OK;
    }
    if (as->take == LD_AIM_FOOTPRINT) {
        aim->plan.first = result_number(self, "downrange");
        aim->plan.second = result_number(self, "drift");
    } else {
        aim->plan.first = result_number(self, as->of);
        if (as->take == LD_AIM_DEVIATION && as->beside[0])
            aim->plan.second = result_number(self, as->beside);
    }
    aim->blocks = aim_blocks_of(&aim->plan, self->samples, self->hypercubes);
    return check_values(self, as, path, error);
}

static ld_status add_limits(ld_optimisation *self, ld_error *error)
{
    char path[64];
    ld_status status = LD_OK;
    for (int i = 0; i < self->as->limit_count && !status; i++) {
        const ld_aim *limit = &self->as->limit[i];
        double least = fabs(limit->at_least), most = fabs(limit->at_most);
        snprintf(path, sizeof path, "optimise.subject_to.%d", i + 1);
        status = add_aim(self, limit, path, error);
        double scale = isnan(most) ? least : isnan(least) ? most : fmax(least, most);
        self->aim[self->aims - 1].scale = scale > 0 ? scale : 1;
    }
    const optimum_method *method = optimum_method_of(self->as->method);
    if (!status && self->aims > 1 && !method->limited)
        status = ld_fail(error, LD_ERR_INPUT,
                         "optimise.method: %s takes no constraints (subject_to); expected cobyla, "
                         "slsqp, ccsa or isres",
                         method->name);
    return status;
}

// ---- values

double optimise_aim_of(const ld_optimisation *self, int i, const double *number, double *work)
{
    const optimise_aim *aim = &self->aim[i];
    if (aim->margin >= 0)
        return number[optimise_numbers(self) - (size_t)self->margins + (size_t)aim->margin];
    const aim_samples samples = {self->samples, self->rockets, self->results, number};
    return aim_value(&aim->plan, &samples, aim->blocks, -1, work);
}

double optimise_excess(const optimise_aim *aim, double value, bool lower)
{
    double excess = lower ? aim->as->at_least - value : value - aim->as->at_most;
    return fmax(excess / aim->scale, -1); // far from its limit a constraint is flat
}

ld_estimate optimise_estimate(const ld_optimisation *self, int i, const optimise_pair *of)
{
    const optimise_aim *aim = &self->aim[i];
    int count = of->others ? self->others_count : self->samples;
    double *work = calloc((size_t)count * (size_t)self->rockets + 1, sizeof *work);
    if (!work)
        return (ld_estimate){NAN, NAN, NAN};
    ld_estimate found = {NAN, NAN, NAN};
    if (aim->margin >= 0) {
        found.value = optimise_aim_of(self, i, of->number, work) -
                      (of->from ? optimise_aim_of(self, i, of->from, work) : 0);
    } else {
        int cubes = self->hypercubes * count / self->samples;
        const aim_samples samples = {count, self->rockets, self->results, of->number};
        const aim_samples from = {count, self->rockets, self->results, of->from};
        const aim_blocks blocks =
            self->hypercubes ? (aim_blocks){cubes, false} : aim_blocks_of(&aim->plan, count, 0);
        found = aim_estimate(&aim->plan, &samples, of->from ? &from : NULL, blocks, work);
    }
    free(work);
    return found;
}

// ---- from begin to end

static ld_status read_block(ld_optimisation *self, ld_error *error)
{
    const ld_model *model = self->model;
    const ld_scatter *scatter = &model->scatter;
    ld_status status = LD_OK;
    self->samples = scatter->present ? scatter->samples : 1;
    self->rockets = model->firing_count;
    self->others_count = self->as->others > 0 ? self->as->others : self->samples;
    self->hypercubes = scatter->present && plan_is_replicated(scatter) ? scatter->replicates : 0;
    if (scatter->present && plan_has_rows(scatter))
        status = ld_fail(error, LD_ERR_INPUT,
                         "scatter.plan: expected random, lhs or sobol to optimise over; the others "
                         "are for sensitivities");
    for (int i = 0; i < self->as->key_count && !status; i++)
        status = read_key(model, &self->as->key[i], &self->key[self->keys++], error);
    if (!status)
        status = add_aim(self, &self->as->least, "optimise.least", error);
    if (!status && aim_is_margin(&self->as->least))
        status = ld_fail(
            error, LD_ERR_INPUT, "optimise.least: a margin is a constraint (subject_to), found %s",
            self->as->least.take == LD_AIM_GAIN_MARGIN ? "gain_margin" : "phase_margin");
    return status ? status : add_limits(self, error);
}

ld_status ld_optimise_create(const ld_model *model, ld_optimisation **out, ld_error *error)
{
    assert(model && out);
    ld_error own;
    error = error ? error : &own;
    *out = NULL;
    if (!model->optimise.present)
        return ld_fail(error, LD_ERR_INPUT,
                       "nothing to optimise: the scenario has no block optimise");
    if (model->sweep_count > 0 && model->point == 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "an optimisation has one point: leave out the sweep (--set sweep=)");
    ld_optimisation *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the optimisation");
    self->model = model;
    self->as = &model->optimise;
    ld_status status = read_block(self, error);
    if (status) {
        ld_optimise_free(self);
        return status;
    }
    *out = self;
    return LD_OK;
}

void ld_optimise_free(ld_optimisation *self)
{
    if (!self)
        return;
    for (int i = 0; i < self->candidates; i++)
        free(self->candidate[i].number);
    free(self->candidate);
    free(self->others[0]);
    free(self->others[1]);
    free(self);
}
