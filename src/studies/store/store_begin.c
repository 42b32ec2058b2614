#include "studies/store/store_begin.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "base/random.h"
#include "launchdyn/origin.h"
#include "launchdyn/version.h"
#include "model/fields/source.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "studies/store/store_check.h"
#include "studies/store/store_tables.h"
#include "studies/store/store_text.h"

char *store_identity(const ld_model *model)
{
    char *text = NULL;
    size_t length;
    ld_model same = *model;
    FILE *stream = memory_stream(&text, &length);
    if (!stream)
        return NULL;
    if (!plan_is_replicated(&same.scatter))
        same.scatter.samples = 1;
    same.scatter.until_count = 0;
    ld_model_print(&same, stream);
    return fclose(stream) == 0 ? text : NULL;
}

static ld_status make_tables(study_store *self, ld_error *error)
{
    char *text;
    ld_status status = store_tables_of_study(self, &text, error);
    if (!status)
        status = store_execute(self, text, error);
    sqlite3_free(text);
    return status;
}

static ld_status put_points(study_store *self, ld_error *error)
{
    const ld_model *model = self->study->nominal;
    sqlite3_stmt *insert = store_prepare_insert(self, "point", 1 + model->sweep_count, error);
    bool good = insert != NULL;
    for (int point = 1; point <= self->study->points && good; point++) {
        sqlite3_bind_int(insert, 1, point);
        for (int i = 0; i < model->sweep_count; i++)
            sqlite3_bind_text(insert, 2 + i,
                              model->sweep[i].value[ld_scenario_value(model, point, i)], -1,
                              SQLITE_STATIC);
        good = store_step(insert);
    }
    sqlite3_finalize(insert);
    return good ? LD_OK : insert ? store_fail(self, "write", error) : error->status;
}

static ld_status fill_new(study_store *self, const char *identity, ld_error *error)
{
    char hash[32];
    snprintf(hash, sizeof hash, "%016" PRIx64, random_stream(identity));
    ld_status status = make_tables(self, error);
    if (!status)
        status = put_points(self, error);
    if (!status)
        status = store_set_text(self, "format", STORE_FORMAT, error);
    if (!status)
        status = store_set_text(self, "version", LD_VERSION, error);
    if (!status)
        status = store_set_text(self, "hash", hash, error);
    if (!status)
        status = store_set_text(self, "scenario", identity, error);
    return status;
}

// The first line in which the texts differ, as it is now or, where there is none, was; cut for a
// message.
static void first_difference(const char *before, const char *now, char line[96])
{
    size_t i = 0, start = 0;
    for (; before[i] && before[i] == now[i]; i++)
        start = now[i] == '\n' ? i + 1 : start;
    const char *text = now[start] && now[start] != '\n' ? now + start : before + start;
    text += strspn(text, " ");
    size_t length = strcspn(text, "\n");
    snprintf(line, 96, "%.*s", (int)(length < 95 ? length : 95), text);
}

static ld_status compare_tables(const study_store *self, const store_view *view, ld_error *error)
{
    char *own, *there = NULL;
    ld_status status = store_tables_of_study(self, &own, error);
    if (!status)
        status = store_tables_of(view, &there, error);
    if (!status && strcmp(own, there) != 0)
        status =
            ld_fail(error, LD_ERR_INPUT,
                    "%s is damaged or changed: its tables are not those of this study", self->path);
    sqlite3_free(own);
    sqlite3_free(there);
    return status;
}

// Refuses a folder that holds something else, or is damaged.
static ld_status compare(study_store *self, const char *identity, ld_error *error)
{
    const store_view view = store_main(self);
    ld_status status = store_check(&view, &self->kept, error);
    if (status)
        return status;
    char *before = NULL, *version = NULL, line[96];
    status = store_view_text(&view, "scenario", &before, error);
    if (!status)
        status = store_view_text(&view, "version", &version, error);
    if (status) {
        free(before);
        return status;
    }
    if (!before || !version) {
        status = ld_fail(error, LD_ERR_INPUT, "%s contains no study", self->path);
    } else if (strcmp(before, identity) != 0) {
        first_difference(before, identity, line);
        status = ld_fail(error, LD_ERR_INPUT,
                         "%s contains the study of another scenario, whose first difference is in "
                         "\"%s\"; use another folder",
                         self->path, line);
    } else if (strcmp(version, LD_VERSION) != 0) {
        status = ld_fail(error, LD_ERR_INPUT,
                         "%s was begun by launchdyn %s, this is %s; use another folder", self->path,
                         version, LD_VERSION);
    } else {
        status = compare_tables(self, &view, error);
    }
    free(before);
    free(version);
    return status;
}

// ---- where the study comes from

static ld_status insert_origin(study_store *self, const char *kind, const char *name,
                               const char *text, size_t length, ld_error *error)
{
    sqlite3_stmt *insert = store_prepare(
        self,
        "INSERT INTO origin SELECT ?1, ?2, ?3 WHERE (?1, ?2, ?3) NOT IN (SELECT kind, "
        "name, text FROM origin)",
        error);
    if (!insert)
        return store_status(self);
    sqlite3_bind_text(insert, 1, kind, -1, SQLITE_STATIC);
    sqlite3_bind_text(insert, 2, name, -1, SQLITE_STATIC);
    sqlite3_bind_blob(insert, 3, text, (int)length, SQLITE_STATIC);
    int result = sqlite3_step(insert);
    sqlite3_finalize(insert);
    return result == SQLITE_DONE ? LD_OK : store_fail(self, "write", error);
}

static ld_status put_source(study_store *self, const ld_source *source, ld_error *error)
{
    ld_status status =
        store_execute(self, "DELETE FROM origin WHERE kind IN ('file', 'set')", error);
    for (size_t i = 0; source && i < source->file_count && !status; i++) {
        const ld_source_file *file = source->file[i];
        status = insert_origin(self, "file", file->name, file->text, file->length, error);
    }
    for (size_t i = 0; source && i < source->set_count && !status; i++) {
        char number[24];
        snprintf(number, sizeof number, "%zu", i + 1);
        status = insert_origin(self, "set", number, source->set[i], strlen(source->set[i]), error);
    }
    return status;
}

// The texts are those of the last time; of programs that have worked on it all are kept.
static ld_status put_origin(study_store *self, ld_error *error)
{
    ld_origin origin;
    ld_status status = ld_origin_of(self->study->nominal, &origin, error);
    if (status)
        return status;
    for (size_t i = 0; i < origin.fact_count && !status; i++)
        status = insert_origin(self, "program", origin.fact[i].name, origin.fact[i].text,
                               strlen(origin.fact[i].text), error);
    if (!status)
        status = put_source(self, origin.source, error);
    if (!status)
        status = store_set_text(self, "resolved", origin.scenario, error);
    ld_origin_free(&origin);
    return status;
}

static ld_status begin_or_compare(study_store *self, const char *identity, ld_error *error)
{
    const ld_scatter *scatter = &self->study->nominal->scatter;
    sqlite3_stmt *tables = store_prepare(self, "SELECT 1 FROM sqlite_master", error);
    if (!tables)
        return store_status(self);
    int there = sqlite3_step(tables);
    sqlite3_finalize(tables);
    ld_status status = there == SQLITE_ROW    ? compare(self, identity, error)
                       : there == SQLITE_DONE ? fill_new(self, identity, error)
                                              : store_fail(self, "read", error);
    if (!status)
        status = store_set_number(self, "samples", self->study->samples, error);
    if (!status)
        status = store_set_number(self, "strata", plan_strata(scatter), error);
    if (!status)
        status = put_origin(self, error);
    return status ? status : store_seal(self, error);
}

ld_status store_begin(study_store *self, ld_error *error)
{
    char *identity = store_identity(self->study->nominal);
    if (!identity)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the scenario's text");
    ld_status status = store_execute(self, "BEGIN IMMEDIATE", error);
    if (!status)
        status = begin_or_compare(self, identity, error);
    status = store_commit(self, status, error);
    free(identity);
    return status;
}
