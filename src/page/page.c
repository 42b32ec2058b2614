// The page that simulates: the functions that its worker calls. A scenario goes in as text; the
// summary, what a report shows of the run, messages as the command prints them come out as text.
#include "page/page.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "launchdyn/output.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "launchdyn/summary.h"
#include "report/report_parts.h"
#include "results/history.h"

enum { MOST_SETS = 256 };

// What the last run left, each new from malloc or NULL.
static struct {
    char *text[PAGE_TEXTS];
    history_data history; // with the columns of the replay behind its own
    size_t columns;       // its own
} last;

// ---- texts ----

// A text on its way, in the place of the one before.
typedef struct writing {
    FILE *stream;
    size_t length;
} writing;

static bool begin_text(writing *self, page_text_kind kind)
{
    free(last.text[kind]);
    self->stream = memory_stream(&last.text[kind], &self->length);
    return self->stream != NULL;
}

static ld_status end_text(writing *self, ld_status status)
{
    return fclose(self->stream) != 0 && !status ? LD_ERR_MEMORY : status;
}

const char *page_text(page_text_kind kind)
{
    return last.text[kind] ? last.text[kind] : "";
}

static void forget(void)
{
    for (int i = 0; i < PAGE_TEXTS; i++) {
        free(last.text[i]);
        last.text[i] = NULL;
    }
    history_free(&last.history);
}

// What the command would print: errors of a scenario, or of a run where they have a place in it.
static ld_status complain(const ld_model *model, ld_status status, const ld_error *error,
                          ld_messages *messages)
{
    writing text;
    bool placed = !model || ld_scenario_explain(model, error, messages);
    if (!begin_text(&text, PAGE_MESSAGES))
        return LD_ERR_MEMORY;
    if (placed && messages->count > 0)
        ld_messages_print(messages, text.stream);
    else
        fprintf(text.stream, "launchdyn: %s\n", model ? error->text : "no memory");
    ld_messages_free(messages);
    return end_text(&text, status);
}

// ---- a run ----

// What the report shows of it, but for its scripts.
static ld_status write_data(const report_source *source, ld_error *error)
{
    const report_detail detail = {.whole_tube = true, .pixel = 1.0 / 4000};
    writing text;
    if (!begin_text(&text, PAGE_DATA))
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the page");
    ld_status status = report_write_data(text.stream, source, &detail, error);
    return end_text(&text, status);
}

static ld_status write_summary(const ld_model *model, const ld_summary *summary, ld_error *error)
{
    writing text;
    if (!begin_text(&text, PAGE_SUMMARY))
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the page");
    ld_status status = ld_summary_print_json(model, summary, text.stream, error);
    return end_text(&text, status);
}

static ld_status write_results(const ld_model *model, const history_memory *memory,
                               const ld_summary *summary, ld_error *error)
{
    ld_report report = {0};
    report_source source = {.report = &report, .has_history = true, .has_origin = true};
    ld_status status = history_memory_take(memory, summary, &last.history, error);
    if (!status)
        status = ld_origin_of(model, &source.origin, error);
    if (status)
        return status;
    last.columns = last.history.columns;
    status = report_add_replay(&last.history, error);
    source.history = last.history;
    if (!status)
        status = write_data(&source, error);
    if (!status)
        status = write_summary(model, summary, error);
    ld_origin_free(&source.origin);
    return status;
}

// Runs; what ends a run early leaves results up to there, as the command does.
static ld_status simulate(const ld_model *model, ld_error *error)
{
    ld_simulation *simulation = NULL;
    history_memory *memory = history_memory_new();
    ld_summary *summary = ld_summary_new();
    ld_status status = memory && summary ? ld_simulation_create(model, &simulation, error)
                                         : ld_fail(error, LD_ERR_MEMORY, "no memory for a run");
    if (!status) {
        const ld_run_options options = {.sink = history_memory_sink(memory)};
        ld_error other;
        status = ld_simulation_run(simulation, &options, summary, error);
        if (status == LD_OK || status == LD_ERR_LAUNCH || status == LD_ERR_NUMERIC) {
            ld_status written = write_results(model, memory, summary, status ? &other : error);
            status = status ? status : written;
        }
    }
    ld_simulation_free(simulation);
    ld_summary_free(summary);
    history_memory_free(memory);
    return status;
}

static ld_status print_model(const ld_model *model)
{
    writing text;
    if (!begin_text(&text, PAGE_SCENARIO))
        return LD_ERR_MEMORY;
    ld_model_print(model, text.stream);
    return end_text(&text, LD_OK);
}

// Overrides, one a line, which are ended in place.
static size_t split(char *sets, const char *set[MOST_SETS])
{
    size_t count = 0;
    for (char *line = strtok(sets, "\n"); line && count < MOST_SETS; line = strtok(NULL, "\n"))
        set[count++] = line;
    return count;
}

static ld_status read_model(const char *scenario, char *sets, ld_model **model)
{
    const char *set[MOST_SETS];
    ld_messages messages = {0};
    size_t count = split(sets, set);
    ld_status status = ld_scenario_read_text(scenario, strlen(scenario), "scenario.yaml", "/", set,
                                             count, model, &messages);
    return status ? complain(NULL, status, NULL, &messages) : LD_OK;
}

int page_run(const char *scenario, char *sets)
{
    ld_model *model = NULL;
    ld_messages messages = {0};
    ld_error error;
    forget();
    ld_status status = read_model(scenario, sets, &model);
    if (status)
        return status;
    status = print_model(model);
    ld_status run =
        status ? ld_fail(&error, status, "no memory for the page") : simulate(model, &error);
    if (run)
        run = complain(model, run, &error, &messages);
    ld_model_free(model);
    return run;
}

// ---- values and columns ----

int page_values(const char *scenario, char *sets, const char *paths)
{
    ld_model *model = NULL;
    writing text;
    free(last.text[PAGE_MESSAGES]);
    last.text[PAGE_MESSAGES] = NULL;
    ld_status status = read_model(scenario, sets, &model);
    if (status)
        return status;
    bool begun = begin_text(&text, PAGE_VALUES);
    for (const char *path = paths; begun && *path;) {
        char one[LD_MAX_PATH], value[256];
        size_t length = strcspn(path, "\n");
        snprintf(one, sizeof one, "%.*s", (int)length, path);
        if (ld_model_text(model, one, value, sizeof value, NULL))
            *value = '\0';
        fprintf(text.stream, "%s\n", value);
        path += length + (path[length] == '\n');
    }
    ld_model_free(model);
    return begun ? end_text(&text, LD_OK) : LD_ERR_MEMORY;
}

// The launcher's table, or that of a rocket's flight; NULL: there is none.
static const history_data *table_of(int rocket)
{
    for (size_t i = 0; rocket > 0 && i < last.history.flights; i++)
        if (last.history.flight[i].number == rocket)
            return &last.history.flight[i];
    return rocket == 0 && last.history.rows > 0 ? &last.history : NULL;
}

static ld_status write_csv(const history_data *table, size_t columns, const char *path,
                           ld_error *error)
{
    history_csv *csv = NULL;
    ld_column *column = calloc(columns, sizeof *column);
    double *row = calloc(columns, sizeof *row);
    ld_status status = column && row ? history_csv_create(path, &csv, error)
                                     : ld_fail(error, LD_ERR_MEMORY, "no memory for the page");
    for (size_t i = 0; i < columns && !status; i++)
        column[i] = (ld_column){.name = table->name[i], .unit = table->unit[i]};
    if (!status)
        status = history_csv_begin(csv, column, columns, error);
    for (size_t k = 0; k < table->rows && !status; k++) {
        for (size_t i = 0; i < columns; i++)
            row[i] = table->value[i * table->rows + k];
        status = history_csv_row(csv, row, columns, error);
    }
    if (csv) {
        ld_status closed = history_csv_close(csv, status ? NULL : error);
        status = status ? status : closed;
    }
    free(column);
    free(row);
    return status;
}

int page_write_csv(int rocket, const char *path)
{
    ld_error error;
    const history_data *table = table_of(rocket);
    if (!table)
        return LD_ERR_INPUT;
    return write_csv(table, rocket == 0 ? last.columns : table->columns, path, &error);
}
