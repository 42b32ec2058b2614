#include "compare/further_runs.h"

#include <inttypes.h>

#include "launchdyn/scenario.h"
#include "launchdyn/study.h"
#include "model/blocks/study.h"
#include "model/parts.h"

// The first message, as a sentence.
static ld_status fail_by(ld_status status, ld_messages *messages, ld_error *error)
{
    if (messages->count > 0)
        ld_fail(error, status, "%.150s: %s", messages->item[0].path, messages->item[0].text);
    else
        ld_fail(error, status, "no memory for a further run");
    ld_messages_free(messages);
    return status;
}

// Reads the model; closes after a message.
static ld_status read_model(further_runs *self, const char *folder, ld_error *error)
{
    ld_messages messages;
    ld_status status = LD_OK;
    if (!self->origin.source)
        status =
            ld_fail(error, LD_ERR_INPUT,
                    "%.300s cannot be repeated: its model was not read from a scenario", folder);
    else if ((status = ld_scenario_read_source(self->origin.source, self->origin.point,
                                               &self->model, &messages)) != LD_OK)
        fail_by(status, &messages, error);
    if (status)
        further_runs_close(self);
    return status;
}

ld_status further_runs_open(further_runs *self, const char *folder, const ld_run_options *options,
                            ld_error *error)
{
    *self = (further_runs){.options = *options};
    ld_status status = ld_origin_read(folder, &self->origin, error);
    return status ? status : read_model(self, folder, error);
}

ld_status further_runs_open_study(further_runs *self, const char *folder,
                                  const ld_run_options *options, ld_error *error)
{
    *self = (further_runs){.options = *options};
    ld_status status = ld_study_read_origin(folder, &self->origin, error);
    return status ? status : read_model(self, folder, error);
}

void further_runs_close(further_runs *self)
{
    ld_model_free(self->model);
    ld_origin_free(&self->origin);
    self->model = NULL;
}

ld_status further_runs_gravity(const char *folder, double *gravity, ld_error *error)
{
    further_runs runs;
    ld_status status = further_runs_open(&runs, folder, &(ld_run_options){.self = NULL}, error);
    if (status)
        return status;
    *gravity = model_gravity(runs.model);
    further_runs_close(&runs);
    return LD_OK;
}

ld_status series_run_make(const series_run *self, ld_error *error)
{
    ld_simulation *simulation = NULL;
    ld_run_options options = self->options;
    ld_summary *summary = ld_summary_new();
    ld_history *history = ld_history_new(NULL);
    ld_status status = summary && history
                           ? ld_simulation_create(self->model, &simulation, error)
                           : ld_fail(error, LD_ERR_MEMORY, "no memory for a further run");
    if (!status) {
        options.sink = ld_history_sink(history);
        status = ld_simulation_run(simulation, &options, summary, error);
    }
    run_series series = {.launch = {0}};
    if (!status)
        status = run_series_of_run(&series, history, summary, self->rocket, error);
    series.gravity = model_gravity(self->model);
    if (!status)
        status = self->take(self->data, &series, summary, error);
    run_series_free(&series);
    ld_simulation_free(simulation);
    ld_history_free(history);
    ld_summary_free(summary);
    return status;
}

// Sample `number` of its model; 0: the model itself.
static ld_status run_sample(series_run *self, int number, ld_error *error)
{
    ld_sample *sample = NULL;
    if (number == 0)
        return series_run_make(self, error);
    ld_status status = ld_sample_create(self->model, number, &sample, error);
    if (!status) {
        self->model = ld_sample_model(sample);
        status = series_run_make(self, error);
    }
    ld_sample_free(sample);
    return status;
}

ld_status further_run(const further_runs *self, const run_overrides *overrides, int rocket,
                      run_taker *take, void *data, ld_error *error)
{
    ld_model *derived = NULL;
    ld_messages messages;
    series_run run = {self->model, self->options, rocket, take, data};
    if (!overrides)
        return run_sample(&run, self->origin.sample, error);
    ld_status status =
        ld_model_derive(self->model, overrides->set, overrides->count, &derived, &messages);
    if (status)
        return fail_by(status, &messages, error);
    run.model = derived;
    status = run_sample(&run, self->origin.sample, error);
    ld_model_free(derived);
    return status;
}

ld_status further_run_sample(const further_runs *self, int number, int rocket, run_taker *take,
                             void *data, ld_error *error)
{
    const ld_scatter *scatter = model_scatter(self->model);
    const int64_t runs = scatter->present ? plan_runs(scatter) : 0;
    if (number > runs)
        return ld_fail(error, LD_ERR_INPUT,
                       "samples: the scenario of the run has %" PRId64 " (scatter.samples)", runs);
    series_run run = {self->model, self->options, rocket, take, data};
    return run_sample(&run, number, error);
}
