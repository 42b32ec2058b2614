// The page that simulates as a server has it: the scripts of the page, a scenario file to begin
// with, launches one after the other.
#include "launchdyn/live.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "base/numeric_locale.h"
#include "base/text_file.h"
#include "page/page.h"
#include "report/report_html.h"
#include "report/report_parts.h"
#include "results/json_text.h"

enum { MOST_BYTES = 1 << 24 }; // of a scenario

struct ld_live {
    char *file, *folder;
    char **set; // [count]
    size_t count;
    pthread_mutex_t one; // launch at a time
    atomic_bool stop;
};

// ---- the scenario to begin with ----

static ld_status read_file(const char *file, char **text, ld_error *error)
{
    size_t length;
    ld_error why;
    ld_status status = text_file_read(file, MOST_BYTES, text, &length, &why);
    return status ? ld_fail(error, status, "file \"%s\" %s", file, why.text) : LD_OK;
}

static ld_status check_sets(const char *const *sets, size_t count, ld_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (!strchr(sets[i], '=') || strchr(sets[i], '\n'))
            return ld_fail(error, LD_ERR_INPUT,
                           "--set: expected PATH=VALUE, on a line, found \"%.80s\"", sets[i]);
    return LD_OK;
}

static ld_live *live_new(const char *file, const char *const *sets, size_t count)
{
    ld_live *self = calloc(1, sizeof *self);
    const char *slash = strrchr(file, '/');
    if (!self)
        return NULL;
    atomic_init(&self->stop, false);
    pthread_mutex_init(&self->one, NULL);
    self->file = strdup(file);
    self->folder = strndup(file, slash == file ? 1 : slash ? (size_t)(slash - file) : 0);
    self->set = calloc(count + 1, sizeof *self->set);
    bool fine = self->file && self->folder && self->set;
    for (size_t i = 0; i < count && fine; i++)
        fine = (self->set[self->count++] = strdup(sets[i])) != NULL;
    if (fine)
        return self;
    ld_live_free(self);
    return NULL;
}

ld_status ld_live_create(const char *file, const char *const *sets, size_t count, ld_live **live,
                         ld_error *error)
{
    char *text = NULL;
    *live = NULL;
    ld_status status = check_sets(sets, count, error);
    if (!status && strcmp(file, "-") == 0)
        status = ld_fail(error, LD_ERR_INPUT,
                         "the page reads its scenario whenever it is loaded; give a file, not "
                         "standard input");
    if (!status)
        status = read_file(file, &text, error);
    free(text);
    if (!status && !(*live = live_new(file, sets, count)))
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the page");
    return status;
}

void ld_live_free(ld_live *self)
{
    if (!self)
        return;
    for (size_t i = 0; i < self->count; i++)
        free(self->set[i]);
    free(self->set);
    free(self->folder);
    free(self->file);
    pthread_mutex_destroy(&self->one);
    free(self);
}

void ld_live_stop(ld_live *self)
{
    atomic_store(&self->stop, true);
}

// ---- the page ----

// {"choices": [[name, title]], "files": {name: text}, "sets": {path: value}}
static void write_scenario(FILE *json, const ld_live *self, const char *text)
{
    const char *slash = strrchr(self->file, '/'), *name = slash ? slash + 1 : self->file;
    fputs("{\"choices\":[[", json);
    json_write_text(json, name);
    fputc(',', json);
    json_write_text(json, name);
    fputs("]],\"files\":{", json);
    json_write_text(json, name);
    fputc(':', json);
    json_write_text(json, text);
    fputs("},\"sets\":{", json);
    for (size_t i = 0; i < self->count; i++) {
        char *path = strdup(self->set[i]), *value = path ? strchr(path, '=') : NULL;
        if (value) {
            *value = '\0';
            fputs(i ? "," : "", json);
            json_write_text(json, path);
            fputc(':', json);
            json_write_text(json, value + 1);
        }
        free(path);
    }
    fputs("}}", json);
}

static ld_status write_page(FILE *page, const char *json, size_t length, ld_error *error)
{
    report_begin_page(page, &page_bundle, "launchdyn: simulate a launch",
                      "This page simulates with JavaScript and launchdyn.");
    fputs("<script type=\"text/plain\" id=\"replay\">", page);
    ld_status status = report_write_bytes(page, replay_script, replay_script_size, error);
    fputs("</script>\n", page);
    report_write_json(page, "examples", json, length);
    fputs("<script>", page);
    fwrite(run_bundle.script, 1, run_bundle.script_size, page);
    fputs("</script>\n", page);
    report_end_page(page, &page_bundle);
    return status;
}

ld_status ld_live_page(const ld_live *self, FILE *page, ld_error *error)
{
    char *text = NULL, *json = NULL;
    size_t length = 0;
    ld_status status = read_file(self->file, &text, error);
    if (status)
        return status;
    FILE *stream = memory_stream(&json, &length);
    if (stream)
        write_scenario(stream, self, text);
    if (!stream || fclose(stream) != 0)
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the page");
    else
        status = write_page(page, json, length, error);
    free(json);
    free(text);
    return status;
}

// ---- a launch ----

// What the page has posted; texts of the request itself.
typedef struct request {
    const char *text, *sets, *paths;
} request;

// One named text of a request; false: there is none of that name, or it was there before.
static bool take(request *self, page_core *core, const char *name, const char *text)
{
    static const char file[] = "file ";
    if (strncmp(name, file, sizeof file - 1) == 0)
        return page_add_file(core, name + sizeof file - 1, text, strlen(text));
    const char **place = strcmp(name, "text") == 0    ? &self->text
                         : strcmp(name, "sets") == 0  ? &self->sets
                         : strcmp(name, "paths") == 0 ? &self->paths
                                                      : NULL;
    if (!place || *place)
        return false;
    *place = text;
    return true;
}

static bool read_request(request *self, page_core *core, const char *bytes, size_t length)
{
    const char *end = bytes + length;
    *self = (request){0};
    if (length == 0 || end[-1] != '\0')
        return false;
    while (bytes < end) {
        const char *name = bytes, *text = name + strlen(name) + 1;
        if (text >= end || !take(self, core, name, text))
            return false;
        bytes = text + strlen(text) + 1;
    }
    return self->text && self->sets && self->paths;
}

static void write_answer(FILE *answer, const page_core *core, int status, const char *values)
{
    static const page_text_kind kind[] = {PAGE_MESSAGES, PAGE_SCENARIO, PAGE_SUMMARY, PAGE_DATA};
    fprintf(answer, "%d%c", status, '\0');
    for (int i = 0; i < 4; i++)
        fprintf(answer, "%s%c", page_text(core, kind[i]), '\0');
    fprintf(answer, "%s%c", values, '\0');
}

// The values are those without what is set over the scenario.
static ld_status launch(page_core *core, const request *wanted, FILE *answer, ld_error *error)
{
    char none[] = "", *sets = strdup(wanted->sets);
    bool readable = page_values(core, wanted->text, none, wanted->paths) == LD_OK;
    char *values = strdup(readable ? page_text(core, PAGE_VALUES) : "");
    int status = sets && values ? page_run(core, wanted->text, sets) : LD_ERR_MEMORY;
    if (status == LD_ERR_INTERRUPTED)
        ld_fail(error, LD_ERR_INTERRUPTED, "launchdyn live has ended");
    else if (status == LD_ERR_MEMORY)
        ld_fail(error, LD_ERR_MEMORY, "no memory for a launch");
    else
        write_answer(answer, core, status, values);
    free(values);
    free(sets);
    return status == LD_ERR_INTERRUPTED || status == LD_ERR_MEMORY ? (ld_status)status : LD_OK;
}

ld_status ld_live_launch(ld_live *self, const char *bytes, size_t length, FILE *answer,
                         ld_error *error)
{
    request wanted;
    page_core *core = page_new(self->folder);
    ld_status status = LD_OK;
    if (!core)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a launch");
    page_confine(core);
    page_heed(core, &self->stop);
    if (!read_request(&wanted, core, bytes, length))
        status = ld_fail(error, LD_ERR_INPUT, "this is no request of the page");
    if (!status) {
        locale_t before = numeric_locale_enter();
        pthread_mutex_lock(&self->one);
        status = launch(core, &wanted, answer, error);
        pthread_mutex_unlock(&self->one);
        numeric_locale_leave(before);
    }
    page_free(core);
    return status;
}
