#include "studies/store.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/random.h"
#include "io/folder.h"
#include "launchdyn/scenario.h"

#define FORMAT "1"

ld_status store_fail(const study_store *self, const char *what, ld_error *error)
{
    return ld_fail(error, LD_ERR_FILE, "cannot %s %s: %s", what, self->path,
                   self->database ? sqlite3_errmsg(self->database) : "no memory");
}

sqlite3_stmt *store_prepare(study_store *self, const char *text, ld_error *error)
{
    sqlite3_stmt *statement = NULL;
    if (sqlite3_prepare_v2(self->database, text, -1, &statement, NULL) != SQLITE_OK)
        store_fail(self, "use", error);
    return statement;
}

static ld_status execute(study_store *self, const char *text, ld_error *error)
{
    if (sqlite3_exec(self->database, text, NULL, NULL, NULL) != SQLITE_OK)
        return store_fail(self, "write", error);
    return LD_OK;
}

// ---- what is written once

// The scenario as text in which nothing is left out; without the number of samples where more may
// be added.
static char *identity_of(const ld_model *model)
{
    char *text = NULL;
    size_t length;
    ld_model same = *model;
    FILE *stream = open_memstream(&text, &length);
    if (!stream)
        return NULL;
    if (same.scatter.plan == LD_PLAN_RANDOM)
        same.scatter.samples = 1;
    ld_model_print(&same, stream);
    return fclose(stream) == 0 ? text : NULL;
}

static bool is_of_rocket(const ld_model *model, int factor)
{
    return model->scatter.factor[factor].per_rocket;
}

static ld_status make_tables(study_store *self, ld_error *error)
{
    const ld_model *model = self->model;
    char *text = NULL;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    if (!stream)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's tables");
    fputs("CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID;"
          "CREATE TABLE sample (sample INTEGER PRIMARY KEY, status TEXT NOT NULL, reason TEXT",
          stream);
    for (int i = 0; i < model->scatter.factor_count; i++)
        if (!is_of_rocket(model, i))
            fprintf(stream, ", \"%s\" REAL", model->scatter.factor[i].path);
    fputs("); CREATE TABLE rocket (sample INTEGER NOT NULL, rocket INTEGER NOT NULL, tube INTEGER",
          stream);
    for (int i = 0; i < model->scatter.factor_count; i++)
        if (is_of_rocket(model, i))
            fprintf(stream, ", \"%s\" REAL", model->scatter.factor[i].path);
    for (const study_result *r = study_results; r->name; r++)
        fprintf(stream, ", \"%s\" REAL", r->name);
    fputs(", PRIMARY KEY (sample, rocket)) WITHOUT ROWID;", stream);
    ld_status status = fclose(stream) == 0 ? execute(self, text, error) : LD_ERR_MEMORY;
    free(text);
    return status;
}

static ld_status set_text(study_store *self, const char *name, const char *value, ld_error *error)
{
    sqlite3_stmt *insert =
        store_prepare(self, "INSERT OR REPLACE INTO study (name, value) VALUES (?, ?)", error);
    if (!insert)
        return LD_ERR_FILE;
    sqlite3_bind_text(insert, 1, name, -1, SQLITE_STATIC);
    sqlite3_bind_text(insert, 2, value, -1, SQLITE_STATIC);
    int result = sqlite3_step(insert);
    sqlite3_finalize(insert);
    return result == SQLITE_DONE ? LD_OK : store_fail(self, "write", error);
}

char *store_text(study_store *self, const char *name)
{
    sqlite3_stmt *select = store_prepare(self, "SELECT value FROM study WHERE name = ?", NULL);
    char *value = NULL;
    if (!select)
        return NULL;
    sqlite3_bind_text(select, 1, name, -1, SQLITE_STATIC);
    if (sqlite3_step(select) == SQLITE_ROW && sqlite3_column_text(select, 0))
        value = strdup((const char *)sqlite3_column_text(select, 0));
    sqlite3_finalize(select);
    return value;
}

static ld_status fill_new(study_store *self, const char *identity, ld_error *error)
{
    char hash[32];
    snprintf(hash, sizeof hash, "%016" PRIx64, random_stream(identity));
    ld_status status = make_tables(self, error);
    if (!status)
        status = set_text(self, "format", FORMAT, error);
    if (!status)
        status = set_text(self, "version", LD_VERSION, error);
    if (!status)
        status = set_text(self, "hash", hash, error);
    if (!status)
        status = set_text(self, "scenario", identity, error);
    return status;
}

// The first line in which the texts differ, cut for a message.
static void first_difference(const char *before, const char *now, char line[96])
{
    size_t i = 0, start = 0;
    for (; before[i] && before[i] == now[i]; i++)
        start = now[i] == '\n' ? i + 1 : start;
    start += strspn(now + start, " ");
    size_t length = strcspn(now + start, "\n");
    snprintf(line, 96, "%.*s", (int)(length < 95 ? length : 95), now + start);
}

// Refuses a folder that holds something else.
static ld_status compare(study_store *self, const char *identity, ld_error *error)
{
    char *before = store_text(self, "scenario"), *version = store_text(self, "version"), line[96];
    ld_status status = LD_OK;
    if (!before || !version) {
        status = ld_fail(error, LD_ERR_FILE, "%s holds no study", self->path);
    } else if (strcmp(before, identity) != 0) {
        first_difference(before, identity, line);
        status = ld_fail(error, LD_ERR_INPUT,
                         "%s holds the study of another scenario, which differs first in \"%s\"; "
                         "use another folder",
                         self->path, line);
    } else if (strcmp(version, LD_VERSION) != 0) {
        status = ld_fail(error, LD_ERR_INPUT,
                         "%s was begun by launchdyn %s, this is %s; use another folder", self->path,
                         version, LD_VERSION);
    }
    free(before);
    free(version);
    return status;
}

static ld_status begin_or_compare(study_store *self, ld_error *error)
{
    char *identity = identity_of(self->model), *format, samples[32];
    if (!identity)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the scenario's text");
    ld_status status = execute(self, "BEGIN IMMEDIATE", error);
    sqlite3_stmt *tables =
        status ? NULL
               : store_prepare(self, "SELECT 1 FROM sqlite_master WHERE name = 'study'", error);
    if (!status && !tables)
        status = LD_ERR_FILE;
    bool there = tables && sqlite3_step(tables) == SQLITE_ROW;
    sqlite3_finalize(tables);
    format = there ? store_text(self, "format") : NULL;
    if (!status && there && (!format || strcmp(format, FORMAT) != 0))
        status =
            ld_fail(error, LD_ERR_INPUT, "%s is of another format; use another folder", self->path);
    if (!status)
        status = there ? compare(self, identity, error) : fill_new(self, identity, error);
    snprintf(samples, sizeof samples, "%d", self->model->scatter.samples);
    if (!status)
        status = set_text(self, "samples", samples, error);
    const ld_scatter *scatter = &self->model->scatter;
    bool lhs = scatter->plan == LD_PLAN_LHS;
    snprintf(samples, sizeof samples, "%d", lhs ? scatter->samples / scatter->replicates : 1);
    if (!status)
        status = set_text(self, "strata", samples, error);
    if (!status)
        status = execute(self, "COMMIT", error);
    free(format);
    free(identity);
    return status;
}

// ---- opening

static ld_status take_lock(study_store *self, const char *folder, ld_error *error)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/study.lock", folder);
    self->lock = open(path, O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (self->lock < 0)
        return ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", path, strerror(errno));
    if (flock(self->lock, LOCK_EX | LOCK_NB) != 0)
        return ld_fail(error, LD_ERR_INPUT, "another launchdyn works on the study in %s", folder);
    return LD_OK;
}

// "INSERT INTO table VALUES (?, ?, ...)"
static sqlite3_stmt *prepare_insert(study_store *self, const char *table, int columns,
                                    ld_error *error)
{
    char *text = NULL;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    if (!stream)
        return NULL;
    fprintf(stream, "INSERT INTO %s VALUES (", table);
    for (int i = 0; i < columns; i++)
        fputs(i ? ", ?" : "?", stream);
    fputs(")", stream);
    fclose(stream);
    sqlite3_stmt *statement = store_prepare(self, text, error);
    free(text);
    return statement;
}

static ld_status prepare_all(study_store *self, ld_error *error)
{
    int of_rocket = 0, factors = self->model->scatter.factor_count;
    for (int i = 0; i < factors; i++)
        of_rocket += is_of_rocket(self->model, i);
    self->insert_sample = prepare_insert(self, "sample", 3 + factors - of_rocket, error);
    self->insert_rocket = prepare_insert(self, "rocket", 3 + of_rocket + STUDY_RESULTS, error);
    self->find = store_prepare(self, "SELECT 1 FROM sample WHERE sample = ?", error);
    return self->insert_sample && self->insert_rocket && self->find ? LD_OK : LD_ERR_FILE;
}

ld_status store_open(study_store *self, const char *folder, const ld_model *model, ld_error *error)
{
    char made[4096];
    size_t there = 0;
    *self = (study_store){.model = model, .lock = -1};
    snprintf(made, sizeof made, "%s", folder);
    snprintf(self->path, sizeof self->path, "%s/study.db", folder);
    if (strlen(folder) + 16 > sizeof made)
        return ld_fail(error, LD_ERR_FILE, "the name of the folder is too long");
    ld_status status = folder_make(made, &there, error);
    if (!status)
        status = take_lock(self, folder, error);
    if (!status && sqlite3_open(self->path, &self->database) != SQLITE_OK)
        status = store_fail(self, "open", error);
    if (!status)
        status = execute(self, "PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL", error);
    if (!status)
        status = begin_or_compare(self, error);
    if (!status)
        status = prepare_all(self, error);
    if (status)
        store_close(self);
    return status;
}

ld_status store_open_to_read(study_store *self, const char *folder, ld_error *error)
{
    *self = (study_store){.lock = -1};
    snprintf(self->path, sizeof self->path, "%.4000s/study.db", folder);
    if (access(self->path, R_OK) != 0)
        return ld_fail(error, LD_ERR_INPUT, "%s holds no study: cannot read %s: %s", folder,
                       self->path, strerror(errno));
    // a database in WAL mode wants its side files, which a reader may have to make
    ld_status status = LD_OK;
    if (sqlite3_open_v2(self->path, &self->database, SQLITE_OPEN_READWRITE, NULL) != SQLITE_OK ||
        sqlite3_exec(self->database, "PRAGMA query_only = 1; BEGIN; SELECT 1 FROM study", NULL,
                     NULL, NULL) != SQLITE_OK)
        status = store_fail(self, "read", error);
    if (status)
        store_close(self);
    return status;
}

void store_close(study_store *self)
{
    sqlite3_finalize(self->insert_sample);
    sqlite3_finalize(self->insert_rocket);
    sqlite3_finalize(self->find);
    sqlite3_close(self->database);
    if (self->lock >= 0)
        close(self->lock);
    *self = (study_store){.lock = -1};
}

// ---- samples

ld_status store_count(study_store *self, ld_study_counts *counts, ld_error *error)
{
    char *samples = store_text(self, "samples");
    sqlite3_stmt *count = store_prepare(
        self, "SELECT count(*), count(*) FILTER (WHERE status != 'ok') FROM sample", error);
    *counts = (ld_study_counts){.samples = samples ? atoll(samples) : 0};
    free(samples);
    if (!count)
        return LD_ERR_FILE;
    bool read = sqlite3_step(count) == SQLITE_ROW;
    if (read) {
        counts->done = sqlite3_column_int64(count, 0);
        counts->failed = sqlite3_column_int64(count, 1);
    }
    sqlite3_finalize(count);
    return read ? LD_OK : store_fail(self, "read", error);
}

ld_status store_has(study_store *self, int64_t number, bool *there, ld_error *error)
{
    sqlite3_bind_int64(self->find, 1, number);
    int result = sqlite3_step(self->find);
    sqlite3_reset(self->find);
    *there = result == SQLITE_ROW;
    return result == SQLITE_ROW || result == SQLITE_DONE ? LD_OK : store_fail(self, "read", error);
}

static void bind_number(sqlite3_stmt *statement, int column, double value)
{
    if (isnan(value))
        sqlite3_bind_null(statement, column);
    else
        sqlite3_bind_double(statement, column, value);
}

static bool step(sqlite3_stmt *statement)
{
    int result = sqlite3_step(statement);
    sqlite3_reset(statement);
    return result == SQLITE_DONE;
}

// Binds the factors of the sample (rocket 0) or of a rocket; returns the next free column.
static int bind_factors(const study_store *self, sqlite3_stmt *statement, int column,
                        const study_sample *sample, int rocket)
{
    const ld_scatter *scatter = &self->model->scatter;
    const double *row = sample->value + (size_t)rocket * (size_t)scatter->factor_count;
    for (int i = 0; i < scatter->factor_count; i++)
        if (scatter->factor[i].per_rocket == (rocket > 0))
            bind_number(statement, column++, row[i]);
    return column;
}

static bool put_rocket(study_store *self, int64_t number, const study_sample *sample, int rocket,
                       const ld_rocket_summary *summary)
{
    sqlite3_stmt *insert = self->insert_rocket;
    sqlite3_bind_int64(insert, 1, number);
    sqlite3_bind_int(insert, 2, rocket);
    sqlite3_bind_int(insert, 3, sample->model.firing[rocket - 1].tube);
    int column = bind_factors(self, insert, 4, sample, rocket);
    for (const study_result *r = study_results; r->name; r++)
        bind_number(insert, column++, summary ? study_result_of(summary, r) : NAN);
    return step(insert);
}

ld_status store_put(study_store *self, int64_t number, const study_sample *sample,
                    ld_status outcome, const char *reason, const ld_summary *summary,
                    ld_error *error)
{
    sqlite3_stmt *insert = self->insert_sample;
    ld_status status = execute(self, "BEGIN", error);
    if (status)
        return status;
    sqlite3_bind_int64(insert, 1, number);
    sqlite3_bind_text(insert, 2, ld_status_name(outcome), -1, SQLITE_STATIC);
    if (outcome)
        sqlite3_bind_text(insert, 3, reason, -1, SQLITE_TRANSIENT);
    else
        sqlite3_bind_null(insert, 3);
    bind_factors(self, insert, 4, sample, 0);
    bool good = step(insert);
    for (int i = 1; i <= self->model->firing_count && good; i++)
        good = put_rocket(self, number, sample, i,
                          summary && i <= summary->rocket_count ? &summary->rocket[i - 1] : NULL);
    if (good)
        status = execute(self, "COMMIT", error);
    else
        status = store_fail(self, "write", error);
    if (status)
        sqlite3_exec(self->database, "ROLLBACK", NULL, NULL, NULL);
    return status;
}
