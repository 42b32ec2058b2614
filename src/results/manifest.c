#include "results/manifest.h"

#include <errno.h>
#include <inttypes.h>
#include <sqlite3.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text_file.h"
#include "model/fields/digest.h"

enum { LONGEST_PATH = 4096, MOST_TEXT = 1 << 28 };

// ---- files

static ld_status measure_stream(FILE *stream, manifest_file *file, ld_error *error)
{
    unsigned char bytes[1 << 14];
    size_t count;
    *file = (manifest_file){.there = true, .digest = DIGEST_BEGIN};
    while ((count = fread(bytes, 1, sizeof bytes, stream)) > 0) {
        file->digest = digest_bytes(file->digest, bytes, count);
        file->size += (int64_t)count;
    }
    return ferror(stream) ? text_file_failed(error) : LD_OK;
}

ld_status manifest_measure(const char *path, manifest_file *file, ld_error *error)
{
    *file = (manifest_file){0};
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return errno == ENOENT ? LD_OK : text_file_failed(error);
    ld_status status = measure_stream(stream, file, error);
    fclose(stream);
    return status;
}

// ---- the seal

#define HEAD "{\n  \"format\": "

// A seal was there, and its beginning or its end still is.
static bool had_seal(const manifest *self)
{
    return strncmp(self->text, HEAD, strlen(HEAD)) == 0 ||
           (self->length >= MANIFEST_SEAL_LENGTH &&
            strncmp(self->text + self->length - MANIFEST_SEAL_LENGTH, MANIFEST_SEAL,
                    strlen(MANIFEST_SEAL)) == 0);
}

static bool is_sealed(const manifest *self)
{
    char seal[MANIFEST_SEAL_LENGTH + 1];
    if (self->length < MANIFEST_SEAL_LENGTH)
        return false;
    size_t before = self->length - MANIFEST_SEAL_LENGTH;
    manifest_make_seal(seal, self->text, before);
    return memcmp(self->text + before, seal, MANIFEST_SEAL_LENGTH) == 0;
}

// ---- what it says, by SQLite's reader of JSON

// What is wrong with the text ?1, in a row; none: nothing is. Of what is not JSON the first one
// makes an error (json_valid() says so of anything where there is no memory).
static const char *const wrongs[] = {
    "SELECT '\"' || key || '\" is missing, or something else' FROM json_each("
    "'{\"title\": \"text\", \"version\": \"text\", \"complete\": \"true false\","
    " \"t_end\": \"integer real null\", \"rockets\": \"array\"}')"
    " WHERE instr(value, coalesce(json_type(?1, '$.' || key), '-')) = 0",
    "SELECT '\"files\" is not a list of files with name, size and digest' FROM json_each(?1, "
    "'$.files') WHERE type <> 'object' OR json_type(?1, fullkey || '.name') IS NOT 'text' OR "
    "json_type(?1, fullkey || '.size') IS NOT 'integer' OR json_type(?1, fullkey || '.digest') IS "
    "NOT 'text'",
    "SELECT '\"' || replace(substr(fullkey, 3), '\"', '') || '\" is not a number' FROM "
    "json_tree(?1) WHERE type = 'text' AND key NOT IN ('name', 'shape') AND path NOT IN ('$', "
    "'$.program', '$.notes') AND path NOT GLOB '$.source*' AND path NOT GLOB '$.files*' AND path "
    "NOT GLOB '$.measures*'",
    "SELECT '\"format\" is not a whole number' WHERE json_type(?1, '$.format') <> 'integer'",
    "SELECT 'it is of format ' || json_extract(?1, '$.format') ||"
    " ', and this program reads " MANIFEST_FORMAT "'"
    " WHERE json_extract(?1, '$.format') <> " MANIFEST_FORMAT,
};

static sqlite3_stmt *prepare_query(sqlite3 *reader, const char *query, const manifest *self)
{
    sqlite3_stmt *answer = NULL;
    if (sqlite3_prepare_v2(reader, query, -1, &answer, NULL) == SQLITE_OK)
        sqlite3_bind_text(answer, 1, self->text, (int)self->length, SQLITE_STATIC);
    return answer;
}

// SQLITE_DONE: nothing is; SQLITE_ROW: what self->problem says.
static int find_wrong(sqlite3 *reader, manifest *self)
{
    for (size_t i = 0; i < sizeof wrongs / sizeof *wrongs; i++) {
        sqlite3_stmt *answer = prepare_query(reader, wrongs[i], self);
        int result = answer ? sqlite3_step(answer) : sqlite3_errcode(reader);
        if (result == SQLITE_ROW)
            snprintf(self->problem, sizeof self->problem, "summary.json is damaged: %.200s",
                     (const char *)sqlite3_column_text(answer, 0));
        sqlite3_finalize(answer);
        if (result != SQLITE_DONE)
            return result;
    }
    return SQLITE_DONE;
}

static void take_file(sqlite3_stmt *row, manifest *self)
{
    const char *name = (const char *)sqlite3_column_text(row, 0);
    const char *digest = (const char *)sqlite3_column_text(row, 2);
    for (int i = 0; name && digest && i < MANIFEST_FILES; i++)
        if (strcmp(name, manifest_name[i]) == 0)
            self->file[i] = (manifest_file){.there = true,
                                            .size = sqlite3_column_int64(row, 1),
                                            .digest = strtoull(digest, NULL, 16)};
}

static int read_files(sqlite3 *reader, manifest *self)
{
    sqlite3_stmt *row =
        prepare_query(reader,
                      "SELECT json_extract(value, '$.name'), json_extract(value, '$.size'),"
                      " json_extract(value, '$.digest') FROM json_each(?1, '$.files')",
                      self);
    int result = row ? SQLITE_ROW : sqlite3_errcode(reader);
    while (result == SQLITE_ROW && (result = sqlite3_step(row)) == SQLITE_ROW)
        take_file(row, self);
    sqlite3_finalize(row);
    return result;
}

// Leaves of the text what is to be shown.
static int cut_text(sqlite3 *reader, manifest *self)
{
    sqlite3_stmt *row = prepare_query(
        reader, "SELECT json_remove(?1, '$.scenario', '$.source', '$.files', '$.digest')", self);
    int result = row ? sqlite3_step(row) : sqlite3_errcode(reader);
    const char *shown = result == SQLITE_ROW ? (const char *)sqlite3_column_text(row, 0) : NULL;
    char *copy = shown ? strdup(shown) : NULL;
    sqlite3_finalize(row);
    if (result != SQLITE_ROW)
        return result;
    if (!copy)
        return SQLITE_NOMEM;
    free(self->text);
    self->text = copy;
    self->length = strlen(copy);
    return SQLITE_DONE;
}

// LD_OK too where self->problem says what is wrong; LD_ERR_MEMORY.
static ld_status read_json(manifest *self, ld_error *error)
{
    sqlite3 *reader = NULL;
    int result = sqlite3_open_v2(":memory:", &reader, SQLITE_OPEN_READWRITE, NULL);
    if (result == SQLITE_OK)
        result = find_wrong(reader, self);
    if (result == SQLITE_DONE)
        result = read_files(reader, self);
    if (result == SQLITE_DONE)
        result = cut_text(reader, self);
    if (result != SQLITE_DONE && result != SQLITE_ROW && result != SQLITE_NOMEM)
        snprintf(self->problem, sizeof self->problem, "summary.json is damaged: %.200s",
                 sqlite3_errmsg(reader));
    sqlite3_close(reader);
    return result == SQLITE_NOMEM ? ld_fail(error, LD_ERR_MEMORY, "cannot be read: no memory")
                                  : LD_OK;
}

// ---- reading

// LD_OK too where self->problem says what is wrong; LD_ERR_MEMORY.
static ld_status judge_manifest(manifest *self, ld_error *error)
{
    bool sealed = had_seal(self);
    if (sealed && !is_sealed(self)) {
        snprintf(self->problem, sizeof self->problem,
                 "summary.json is damaged: its text does not match the digest in its last line");
        return LD_OK;
    }
    if (memchr(self->text, '\0', self->length)) { // where a reader of JSON may end
        snprintf(self->problem, sizeof self->problem, "summary.json is damaged: it is not text");
        return LD_OK;
    }
    ld_status status = read_json(self, error);
    if (!status && !*self->problem)
        self->state = sealed ? MANIFEST_WHOLE : MANIFEST_EARLIER;
    return status;
}

ld_status manifest_read(const char *folder, manifest *self, ld_error *error)
{
    char path[LONGEST_PATH];
    ld_error problem;
    *self = (manifest){.state = MANIFEST_NONE};
    snprintf(path, sizeof path, "%.4000s/summary.json", folder);
    if (access(path, F_OK) != 0)
        return LD_OK;
    self->state = MANIFEST_DAMAGED;
    ld_status status = text_file_read(path, MOST_TEXT, &self->text, &self->length, &problem);
    if (status == LD_ERR_INPUT)
        snprintf(self->problem, sizeof self->problem, "summary.json %.200s", problem.text);
    else if (!status)
        status = judge_manifest(self, &problem);
    if (self->state != MANIFEST_DAMAGED)
        return LD_OK;
    manifest_free(self);
    return *self->problem ? LD_OK : ld_fail(error, status, "summary.json %.200s", problem.text);
}

void manifest_free(manifest *self)
{
    free(self->text);
    self->text = NULL;
}

const char *manifest_doubt(const manifest *self)
{
    switch (self->state) {
    case MANIFEST_NONE:
        return "summary.json is missing: the files cannot be verified";
    case MANIFEST_EARLIER:
        return "summary.json is of an earlier version: the files cannot be verified";
    case MANIFEST_DAMAGED:
        return self->problem;
    default:
        return NULL;
    }
}

ld_status manifest_check(const manifest *self, const char *folder, int file, ld_error *error)
{
    char path[LONGEST_PATH];
    manifest_file found;
    ld_error problem;
    const manifest_file *known = &self->file[file];
    if (self->state != MANIFEST_WHOLE)
        return LD_OK;
    const char *name = manifest_name[file];
    snprintf(path, sizeof path, "%.4000s/%s", folder, name);
    ld_status status = manifest_measure(path, &found, &problem);
    if (status)
        return ld_fail(error, status, "%s %s", name, problem.text);
    if (found.there && !known->there)
        return ld_fail(error, LD_ERR_INPUT, "%s is not of this run: summary.json does not name it",
                       name);
    if (!found.there && known->there)
        return ld_fail(error, LD_ERR_INPUT, "%s is missing", name);
    if (found.size != known->size)
        return ld_fail(error, LD_ERR_INPUT,
                       "%s is damaged: it has %" PRId64 " bytes, and had %" PRId64
                       " when it was written",
                       name, found.size, known->size);
    if (found.digest != known->digest)
        return ld_fail(error, LD_ERR_INPUT,
                       "%s is damaged, or of another run: its digest is not that in summary.json",
                       name);
    return LD_OK;
}

ld_status manifest_check_history(const char *folder, char *doubt, size_t size, ld_error *error)
{
    manifest self;
    ld_error problem;
    ld_status status = manifest_read(folder, &self, error);
    if (status)
        return status;
    if (doubt)
        snprintf(doubt, size, "%s", manifest_doubt(&self) ? manifest_doubt(&self) : "");
    if (self.state == MANIFEST_DAMAGED)
        status = ld_fail(&problem, LD_ERR_INPUT, "%s", self.problem);
    else
        status = manifest_check(&self, folder, MANIFEST_HDF5, &problem);
    if (status)
        ld_fail(error, status, "%.300s/%.300s", folder, problem.text);
    manifest_free(&self);
    return status;
}
