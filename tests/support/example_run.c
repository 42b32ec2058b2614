#include "support/example_run.h"

#include "launchdyn/output.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "support/check.h"

void example_run(const char *folder, const char *name, const char *const *sets, size_t count,
                 ld_summary *summary, history_data *read)
{
    char path[512];
    ld_error error = {0};
    ld_messages messages;
    ld_model model;
    ld_output *output = NULL;
    ld_simulation *simulation = NULL;
    snprintf(path, sizeof path, "%s/examples/%s", LD_SOURCE_DIR, name);
    if (scenario_read(path, sets, count, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        fail_msg("%s", path);
    }
    if (ld_simulation_create(&model, &simulation, &error) ||
        ld_output_open(folder, &model, false, &output, &error) ||
        ld_simulation_run(simulation, &(ld_run_options){.sink = ld_output_sink(output)}, summary,
                          &error) ||
        ld_output_finish(output, summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    model_clear(&model);
    snprintf(path, sizeof path, "%s/history.h5", folder);
    if (history_read(path, read, &error))
        fail_msg("%s", error.text);
}
