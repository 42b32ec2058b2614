// Joins the databases of shards into the study's own.
#include <errno.h>
#include <glob.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/lock_file.h"
#include "base/printed.h"
#include "base/text_file.h"
#include "studies/store/store.h"
#include "studies/store/store_check.h"
#include "studies/store/store_tables.h"

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
    const int problem = glob(pattern, GLOB_ERR, NULL, &self->found);
    if (problem == GLOB_NOSPACE)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the list of shards");
    if (problem == GLOB_ABORTED && errno != ENOENT)
        return ld_fail(error, text_file_status(errno), "cannot read the folder %s: %s", folder,
                       strerror(errno));
    if (problem)
        return ld_fail(error, LD_ERR_INPUT, "%s contains no shards of a study", folder);
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
static ld_status first_cell(study_store *self, const char *query, char **answer, ld_error *error)
{
    const store_view view = store_main(self);
    return store_first_text(&view, store_prepare(self, query, error), answer, error);
}

// Makes the tables that the attached database has, and copies what it says of the study.
static ld_status begin_as(study_store *self, const char *tables, ld_error *error)
{
    ld_status status = store_execute(self, tables, error);
    return status ? status
                  : store_execute(self,
                                  "INSERT INTO main.study SELECT * FROM part.study;"
                                  "INSERT INTO main.point SELECT * FROM part.point",
                                  error);
}

// Adds the samples of the attached database that are as they were kept; *damage: what of the
// others.
static ld_status add_samples(const store_view *part, const store_kept *kept, ld_error *damage,
                             ld_error *error)
{
    study_store *self = part->store;
    store_walk walk = {0};
    sqlite3_stmt *sample = store_prepare(
        self, "INSERT OR IGNORE INTO main.sample SELECT * FROM part.sample WHERE sample = ?",
        error);
    sqlite3_stmt *rockets =
        sample ? store_prepare(self,
                               "INSERT INTO main.rocket SELECT * FROM part.rocket WHERE sample = ?",
                               error)
               : NULL;
    ld_status status = rockets ? store_walk_begin(&walk, part, kept, error) : store_status(self);
    while (!status && store_walk_next(&walk, error)) {
        sqlite3_bind_int64(sample, 1, walk.number);
        sqlite3_bind_int64(rockets, 1, walk.number);
        if (!store_step(sample))
            status = store_fail(self, "write", error);
        if (status || sqlite3_changes(self->database) == 0)
            continue;
        store_kept_add(&self->kept, walk.number, walk.digest);
        if (!store_step(rockets))
            status = store_fail(self, "write", error);
    }
    if (!status && walk.status)
        status = walk.status;
    else if (!status && store_walk_verdict(&walk, damage) != LD_ERR_INPUT)
        status = ld_fail(error, damage->status, "%s", damage->text);
    store_walk_end(&walk);
    sqlite3_finalize(sample);
    sqlite3_finalize(rockets);
    return status;
}

// Refuses what is of another study than the attached database.
static ld_status expect_same(const store_view *part, ld_error *error)
{
    study_store *self = part->store;
    char *differs = NULL;
    ld_status status =
        first_cell(self,
                   "SELECT name FROM part.study AS p JOIN main.study AS m USING (name) WHERE "
                   "p.value != m.value AND name IN ('version', 'scenario') UNION ALL "
                   "SELECT 'table ' || name FROM part.sqlite_master WHERE sql NOT IN "
                   "(SELECT sql FROM main.sqlite_master WHERE sql NOT NULL)",
                   &differs, error);
    if (differs)
        status = ld_fail(error, LD_ERR_INPUT, "%s and %s are of different studies: in their %s",
                         part->path, self->path, differs);
    free(differs);
    return status;
}

// Adds the attached database, which may have nothing yet.
static ld_status add_part(const store_view *part, ld_error *damage, ld_error *error)
{
    study_store *self = part->store;
    store_kept kept;
    char *begun = NULL, *here = NULL, *tables = NULL;
    ld_status status = first_cell(self, "SELECT 1 FROM part.sqlite_master", &begun, error);
    if (!status && begun)
        status = first_cell(self, "SELECT 1 FROM main.sqlite_master", &here, error);
    bool there = begun, first = !here;
    free(begun);
    free(here);
    if (status || !there)
        return status;
    status = store_read_kept(part, &kept, error);
    if (!status)
        status = store_tables_of(part, &tables, error);
    if (!status)
        status = first ? begin_as(self, tables, error) : expect_same(part, error);
    sqlite3_free(tables);
    if (!status)
        status = add_samples(part, &kept, damage, error);
    if (!status)
        status = store_execute(
            self,
            "UPDATE main.study SET value = (SELECT max(CAST(value AS INTEGER)) FROM (SELECT value "
            "FROM main.study WHERE name = 'samples' UNION SELECT value FROM part.study WHERE name "
            "= 'samples')) WHERE name = 'samples';"
            "INSERT INTO main.origin SELECT * FROM part.origin WHERE (kind, name, text) NOT IN "
            "(SELECT kind, name, text FROM main.origin) ORDER BY rowid",
            error);
    return status ? status : store_seal(self, error);
}

// *damage: of a shard that is damaged, whose intact samples are added all the same.
static ld_status merge_file(study_store *self, const char *path, ld_error *damage, ld_error *error)
{
    const store_view part = {self, "part", path};
    const store_kept before = self->kept;
    sqlite3_stmt *attach = store_prepare(self, "ATTACH DATABASE ? AS part", error);
    if (!attach)
        return store_status(self);
    sqlite3_bind_text(attach, 1, path, -1, SQLITE_STATIC);
    bool attached = sqlite3_step(attach) == SQLITE_DONE;
    sqlite3_finalize(attach);
    if (!attached)
        return store_fail_at(self, path, "read", error);
    ld_status status = store_execute(self, "BEGIN IMMEDIATE", error);
    if (!status)
        status = add_part(&part, damage, error);
    status = store_commit(self, status, error);
    if (status)
        self->kept = before;
    else
        status = store_execute(self, "DETACH part", error);
    return status;
}

// ---- what is said of it

static bool is_at_work(const char *path)
{
    char name[4096];
    int lock;
    store_lock_name(path, name);
    bool taken = lock_file_try(name, path, &lock, NULL) == LD_ERR_INPUT;
    lock_file_release(lock);
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
    ld_status status = first_cell(self, query, &text, error);
    if (status)
        return status;
    int64_t kept = text ? atoll(text) : 0,
            all = samples < shard ? 0 : (samples - shard) / shards + 1;
    free(text);
    if (kept < all)
        fprintf(stream, "  shard %d of %d lacks %" PRId64 " of its %" PRId64 " samples%s\n", shard,
                shards, all - kept, all, is_at_work(path) ? ", and is still running" : "");
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
        fprintf(stream, said ? ", %d" : "  missing: shard %d", i);
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
    ld_status status = first_cell(self, "SELECT 1 FROM main.sqlite_master", &begun, error);
    if (!status && !begun)
        status = ld_fail(error, LD_ERR_INPUT, "no shard of %s has begun", self->path);
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

// Adds all of them; *damage: of the first that is damaged.
static ld_status merge_all(study_store *self, const shard_list *list, ld_error *damage,
                           ld_error *error)
{
    ld_status status = LD_OK;
    for (size_t i = 0; i < list->found.gl_pathc && !status; i++) {
        int shard, shards;
        ld_error this = {0};
        if (!read_name(list->found.gl_pathv[i], &shard, &shards))
            continue;
        status = merge_file(self, list->found.gl_pathv[i], &this, error);
        if (this.status && !damage->status)
            *damage = this;
    }
    return status;
}

ld_status ld_study_merge(const char *folder, FILE *stream, ld_error *error)
{
    study_store store;
    shard_list list;
    ld_error damage = {0};
    ld_status status = list_shards(&list, folder, error);
    if (!status)
        status = store_open_to_merge(&store, folder, error);
    if (!status) {
        status = merge_all(&store, &list, &damage, error);
        if (!status)
            status = print_state(&store, &list, stream, error);
        store_close(&store);
    }
    if (!status && damage.status)
        status = ld_fail(error, LD_ERR_INPUT, "%s; its intact part was merged", damage.text);
    globfree(&list.found);
    free(list.there);
    return status;
}
