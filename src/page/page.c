// What the page that simulates asks of its core. A scenario goes in as text; the summary, what a
// report shows of the run, messages as the command prints them come out as text.
#include "page/page.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "launchdyn/output.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "launchdyn/summary.h"
#include "model/fields/source.h"
#include "report/report_parts.h"
#include "results/history.h"

struct page_core {
    ld_source *files;        // behind an empty scenario, in place of which comes the one to be read
    char *text[PAGE_TEXTS];  // what the last run left, each new from malloc or NULL
    history_data history;    // with the columns of the replay behind its own
    size_t columns;          // its own
    const atomic_bool *stop; // or NULL
};

page_core *page_new(const char *folder)
{
    page_core *self = calloc(1, sizeof *self);
    if (!self)
        return NULL;
    self->files = source_new("scenario.yaml", folder);
    if (self->files && page_add_file(self, "scenario.yaml", "", 0))
        return self;
    page_free(self);
    return NULL;
}

void page_confine(page_core *self)
{
    self->files->confined = true;
}

bool page_add_file(page_core *self, const char *name, const char *text, size_t length)
{
    char *own = malloc(length + 1);
    if (!own)
        return false;
    memcpy(own, text, length);
    own[length] = '\0';
    return source_add(self->files, name, own, length) != NULL;
}

void page_heed(page_core *self, const atomic_bool *stop)
{
    self->stop = stop;
}

// ---- texts ----

// A text on its way, in the place of the one before.
typedef struct writing {
    FILE *stream;
    size_t length;
} writing;

static bool begin_text(page_core *of, page_text_kind kind, writing *self)
{
    free(of->text[kind]);
    self->stream = memory_stream(&of->text[kind], &self->length);
    return self->stream != NULL;
}

static ld_status end_text(writing *self, ld_status status)
{
    return fclose(self->stream) != 0 && !status ? LD_ERR_MEMORY : status;
}

const char *page_text(const page_core *self, page_text_kind kind)
{
    return self->text[kind] ? self->text[kind] : "";
}

static void forget(page_core *self)
{
    for (int i = 0; i < PAGE_TEXTS; i++) {
        free(self->text[i]);
        self->text[i] = NULL;
    }
    history_free(&self->history);
}

void page_free(page_core *self)
{
    if (!self)
        return;
    forget(self);
    source_free(self->files);
    free(self);
}

// What the command would print: errors of a scenario, or of a run where they have a place in it.
static ld_status complain(page_core *self, const ld_model *model, ld_status status,
                          const ld_error *error, ld_messages *messages)
{
    writing text;
    bool placed = !model || ld_scenario_explain(model, error, messages);
    if (!begin_text(self, PAGE_MESSAGES, &text))
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
static ld_status write_data(page_core *self, const report_source *source, ld_error *error)
{
    const report_detail detail = {.whole_tube = true, .pixel = 1.0 / 4000};
    writing text;
    if (!begin_text(self, PAGE_DATA, &text))
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the page");
    ld_status status = report_write_data(text.stream, source, &detail, error);
    return end_text(&text, status);
}

static ld_status write_summary(page_core *self, const ld_model *model, const ld_summary *summary,
                               ld_error *error)
{
    writing text;
    if (!begin_text(self, PAGE_SUMMARY, &text))
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the page");
    ld_status status = ld_summary_print_json(model, summary, text.stream, error);
    return end_text(&text, status);
}

static ld_status write_results(page_core *self, const ld_model *model, const history_memory *memory,
                               const ld_summary *summary, ld_error *error)
{
    ld_report report = {0};
    report_source source = {.report = &report, .has_history = true, .has_origin = true};
    ld_status status = history_memory_take(memory, summary, &self->history, error);
    if (!status)
        status = ld_origin_of(model, &source.origin, error);
    if (status)
        return status;
    self->columns = self->history.columns;
    status = report_add_replay(&self->history, error);
    source.history = self->history;
    if (!status)
        status = write_data(self, &source, error);
    if (!status)
        status = write_summary(self, model, summary, error);
    ld_origin_free(&source.origin);
    return status;
}

// For ld_run_options.progress.
static bool goes_on(void *data, double share)
{
    const page_core *self = data;
    (void)share;
    return !self->stop || !atomic_load(self->stop);
}

// Runs; what ends a run early leaves results up to there, as the command does.
static ld_status simulate(page_core *self, const ld_model *model, ld_error *error)
{
    ld_simulation *simulation = NULL;
    history_memory *memory = history_memory_new();
    ld_summary *summary = ld_summary_new();
    ld_status status = memory && summary ? ld_simulation_create(model, &simulation, error)
                                         : ld_fail(error, LD_ERR_MEMORY, "no memory for a run");
    if (!status) {
        const ld_run_options options = {
            .sink = history_memory_sink(memory), .self = self, .progress = goes_on};
        ld_error other;
        status = ld_simulation_run(simulation, &options, summary, error);
        if (status == LD_OK || status == LD_ERR_LAUNCH || status == LD_ERR_NUMERIC) {
            ld_status written =
                write_results(self, model, memory, summary, status ? &other : error);
            status = status ? status : written;
        }
    }
    ld_simulation_free(simulation);
    ld_summary_free(summary);
    history_memory_free(memory);
    return status;
}

static ld_status print_model(page_core *self, const ld_model *model)
{
    writing text;
    if (!begin_text(self, PAGE_SCENARIO, &text))
        return LD_ERR_MEMORY;
    ld_model_print(model, text.stream);
    return end_text(&text, LD_OK);
}

// What is to be read: the scenario with overrides, one a line, which are ended in place.
static ld_source *source_of(const page_core *self, const char *scenario, char *sets)
{
    ld_source *source = source_copy(self->files);
    char *text = source ? strdup(scenario) : NULL, *rest = NULL;
    bool fine = text != NULL;
    if (fine) {
        free(source->file[0]->text);
        source->file[0]->text = text;
        source->file[0]->length = strlen(text);
    }
    for (char *line = strtok_r(sets, "\n", &rest); line && fine; line = strtok_r(NULL, "\n", &rest))
        fine = source_add_set(source, line);
    if (fine)
        return source;
    source_free(source);
    return NULL;
}

static ld_status read_model(page_core *self, const char *scenario, char *sets, ld_model **model)
{
    ld_messages messages = {0};
    ld_source *source = source_of(self, scenario, sets);
    ld_status status =
        source ? ld_scenario_read_source(source, 0, model, &messages) : LD_ERR_MEMORY;
    source_free(source);
    return status ? complain(self, NULL, status, NULL, &messages) : LD_OK;
}

int page_run(page_core *self, const char *scenario, char *sets)
{
    ld_model *model = NULL;
    ld_messages messages = {0};
    ld_error error;
    forget(self);
    ld_status status = read_model(self, scenario, sets, &model);
    if (status)
        return status;
    status = print_model(self, model);
    ld_status run =
        status ? ld_fail(&error, status, "no memory for the page") : simulate(self, model, &error);
    if (run)
        run = complain(self, model, run, &error, &messages);
    ld_model_free(model);
    return run;
}

// ---- values and columns ----

int page_values(page_core *self, const char *scenario, char *sets, const char *paths)
{
    ld_model *model = NULL;
    writing text;
    free(self->text[PAGE_MESSAGES]);
    self->text[PAGE_MESSAGES] = NULL;
    ld_status status = read_model(self, scenario, sets, &model);
    if (status)
        return status;
    bool begun = begin_text(self, PAGE_VALUES, &text);
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
static const history_data *table_of(const page_core *self, int rocket)
{
    for (size_t i = 0; rocket > 0 && i < self->history.flights; i++)
        if (self->history.flight[i].number == rocket)
            return &self->history.flight[i];
    return rocket == 0 && self->history.rows > 0 ? &self->history : NULL;
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

int page_write_csv(const page_core *self, int rocket, const char *path)
{
    ld_error error;
    const history_data *table = table_of(self, rocket);
    if (!table)
        return LD_ERR_INPUT;
    return write_csv(table, rocket == 0 ? self->columns : table->columns, path, &error);
}
