// Joins the databases of shards into the study's own.
#include <glob.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/printed.h"
#include "studies/store.h"

// The databases that a folder holds of a study run in parts.
typedef struct shard_list {
    glob_t found;
    int shards;  // into how many the study was cut; 0: the files differ in it
    bool *there; // [shards + 1]
} shard_list;

static bool read_name(const char *path, int *shard, int *shards)
{
    const char *name = strrchr(path, '/');
    int length = 0;
    return name && sscanf(name, "/shard-%d-of-%d.db%n", shard, shards, &length) == 2 &&
           length > 0 && name[length] == '\0' && *shard >= 1 && *shard <= *shards;
}

// The pattern of the shards' names, in which what the folder's name has of wildcards is none.
static void shard_pattern(const char *folder, char pattern[4096])
{
    size_t length = 0;
    for (const char *c = folder; *c && length < 4000; c++) {
        if (strchr("*?[\\", *c))
            pattern[length++] = '\\';
        pattern[length++] = *c;
    }
    strcpy(pattern + length, "/shard-*-of-*.db");
}

static ld_status list_shards(shard_list *self, const char *folder, ld_error *error)
{
    char pattern[4096];
    int shard, shards;
    *self = (shard_list){0};
    shard_pattern(folder, pattern);
    if (glob(pattern, 0, NULL, &self->found) != 0)
        return ld_fail(error, LD_ERR_INPUT, "%s holds no shards of a study", folder);
    bool first = true;
    for (size_t i = 0; i < self->found.gl_pathc; i++) {
        if (!read_name(self->found.gl_pathv[i], &shard, &shards))
            continue;
        self->shards = first || shards == self->shards ? shards : 0;
        first = false;
    }
    self->there = calloc((size_t)self->shards + 1, sizeof *self->there);
    if (!self->there)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the list of shards");
    for (size_t i = 0; i < self->found.gl_pathc; i++)
        if (self->shards && read_name(self->found.gl_pathv[i], &shard, &shards))
            self->there[shard] = true;
    return LD_OK;
}

// The first cell that a query gives, to be freed; NULL: it gives none.
static ld_status ask(study_store *self, const char *query, char **answer, ld_error *error)
{
    sqlite3_stmt *select = store_prepare(self, query, error);
    *answer = NULL;
    if (!select)
        return store_status(self);
    int result = sqlite3_step(select);
    const char *text = result == SQLITE_ROW ? (const char *)sqlite3_column_text(select, 0) : NULL;
    if (text)
        *answer = strdup(text);
    sqlite3_finalize(select);
    return result == SQLITE_ROW || result == SQLITE_DONE ? LD_OK : store_fail(self, "read", error);
}

// Makes the tables that the attached database has, and copies what it says of the study.
static ld_status begin_as(study_store *self, ld_error *error)
{
    char *tables;
    ld_status status =
        ask(self, "SELECT group_concat(sql, ';') FROM part.sqlite_master WHERE sql NOT NULL",
            &tables, error);
    if (!status && tables)
        status = store_execute(self, tables, error);
    free(tables);
    if (!status)
        status = store_execute(self,
                               "INSERT INTO main.study SELECT * FROM part.study;"
                               "INSERT INTO main.point SELECT * FROM part.point",
                               error);
    return status;
}

// Adds the programs that have worked on the attached database; one of an earlier version names
// none.
static ld_status add_programs(study_store *self, ld_error *error)
{
    char *named;
    ld_status status =
        ask(self, "SELECT 1 FROM part.sqlite_master WHERE name = 'origin'", &named, error);
    if (!status && named)
        status = store_execute(self, "INSERT OR IGNORE INTO main.origin SELECT * FROM part.origin",
                               error);
    free(named);
    return status;
}

static ld_status add_part(study_store *self, const char *path, ld_error *error)
{
    char *begun = NULL, *here = NULL, *differs = NULL;
    ld_status status =
        ask(self, "SELECT 1 FROM part.sqlite_master WHERE name = 'study'", &begun, error);
    if (!status)
        status = ask(self, "SELECT 1 FROM main.sqlite_master WHERE name = 'study'", &here, error);
    if (!status && begun && !here)
        status = begin_as(self, error);
    if (!status && begun)
        status = ask(self,
                     "SELECT name FROM part.study AS p JOIN main.study AS m USING (name) WHERE "
                     "p.value != m.value AND name IN ('format', 'version', 'scenario')",
                     &differs, error);
    if (differs)
        status = ld_fail(error, LD_ERR_INPUT, "%s and %s are of different studies: in their %s",
                         path, self->path, differs);
    if (!status && begun)
        status = store_execute(
            self,
            "INSERT OR IGNORE INTO main.sample SELECT * FROM part.sample ORDER BY sample;"
            "INSERT OR IGNORE INTO main.rocket SELECT * FROM part.rocket ORDER BY sample, rocket;"
            "UPDATE main.study SET value = (SELECT max(CAST(value AS INTEGER)) FROM (SELECT value "
            "FROM main.study WHERE name = 'samples' UNION SELECT value FROM part.study WHERE name "
            "= 'samples')) WHERE name = 'samples'",
            error);
    if (!status && begun)
        status = add_programs(self, error);
    free(begun);
    free(here);
    free(differs);
    return status;
}

static ld_status merge_file(study_store *self, const char *path, ld_error *error)
{
    sqlite3_stmt *attach = store_prepare(self, "ATTACH DATABASE ? AS part", error);
    if (!attach)
        return store_status(self);
    sqlite3_bind_text(attach, 1, path, -1, SQLITE_STATIC);
    bool attached = sqlite3_step(attach) == SQLITE_DONE;
    sqlite3_finalize(attach);
    if (!attached)
        return ld_fail(error, store_status(self), "cannot read %s: %s", path,
                       sqlite3_errmsg(self->database));
    ld_status status = store_execute(self, "BEGIN IMMEDIATE", error);
    if (!status)
        status = add_part(self, path, error);
    if (!status)
        status = store_execute(self, "COMMIT", error);
    else if (!sqlite3_get_autocommit(self->database))
        sqlite3_exec(self->database, "ROLLBACK", NULL, NULL, NULL);
    if (!status)
        status = store_execute(self, "DETACH part", error);
    return status;
}

// ---- what is said of it

static bool is_at_work(const char *path)
{
    int lock;
    bool taken = store_lock(path, &lock, NULL) == LD_ERR_INPUT;
    if (lock >= 0)
        close(lock);
    return taken;
}

static ld_status print_unfinished(study_store *self, const char *path, int64_t samples,
                                  FILE *stream, ld_error *error)
{
    int shard, shards;
    char query[128], *text;
    if (!read_name(path, &shard, &shards))
        return LD_OK;
    snprintf(query, sizeof query, "SELECT count(*) FROM sample WHERE (sample - %d) %% %d = 0",
             shard, shards);
    ld_status status = ask(self, query, &text, error);
    if (status)
        return status;
    int64_t kept = text ? atoll(text) : 0,
            all = samples < shard ? 0 : (samples - shard) / shards + 1;
    free(text);
    if (kept < all)
        fprintf(stream, "  shard %d of %d lacks %" PRId64 " of its %" PRId64 " samples%s\n", shard,
                shards, all - kept, all, is_at_work(path) ? ", and is still at work" : "");
    return LD_OK;
}

// "  not there: shards 2, 5 to 7 of 64"
static void print_absent(const shard_list *list, FILE *stream)
{
    bool said = false;
    for (int i = 1, end; i <= list->shards; i = end + 1) {
        for (end = i; end <= list->shards && !list->there[end]; end++)
            ;
        if (end == i)
            continue;
        fprintf(stream, said ? ", %d" : "  not there: shard %d", i);
        if (end - 1 > i)
            fprintf(stream, " to %d", end - 1);
        said = true;
    }
    if (said)
        fprintf(stream, " of %d\n", list->shards);
}

static ld_status print_state(study_store *self, const shard_list *list, FILE *stream,
                             ld_error *error)
{
    ld_study_counts counts;
    char *begun;
    ld_status status = ask(self, "SELECT 1 FROM sqlite_master WHERE name = 'study'", &begun, error);
    if (!status && !begun)
        status = ld_fail(error, LD_ERR_INPUT, "no shard beside %s has begun", self->path);
    free(begun);
    if (!status)
        status = store_count(self, &counts, error);
    if (status)
        return status;
    fprintf(stream,
            counts.done > counts.samples
                ? "%s: %" PRId64 " samples kept, %" PRId64 " asked for, %" PRId64 " failed\n"
                : "%s: %" PRId64 " of %" PRId64 " samples, %" PRId64 " failed\n",
            VISIBLE(self->path), counts.done, counts.samples, counts.failed);
    for (size_t i = 0; i < list->found.gl_pathc && !status; i++)
        status = print_unfinished(self, list->found.gl_pathv[i], counts.samples, stream, error);
    if (!status && counts.done < counts.samples)
        print_absent(list, stream);
    if (!status && counts.done < counts.samples)
        fputs("  launchdyn study FILE --out DIR runs what is missing\n", stream);
    return status;
}

ld_status ld_study_merge(const char *folder, FILE *stream, ld_error *error)
{
    study_store store;
    shard_list list;
    int shard, shards;
    ld_status status = list_shards(&list, folder, error);
    if (!status)
        status = store_open_to_merge(&store, folder, error);
    if (!status) {
        for (size_t i = 0; i < list.found.gl_pathc && !status; i++)
            if (read_name(list.found.gl_pathv[i], &shard, &shards))
                status = merge_file(&store, list.found.gl_pathv[i], error);
        if (!status)
            status = print_state(&store, &list, stream, error);
        store_close(&store);
    }
    globfree(&list.found);
    free(list.there);
    return status;
}
