#include "studies/store/store_check.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/version.h"
#include "studies/store/row_digest.h"
#include "studies/store/store_tables.h"
#include "studies/store/store_text.h"

static bool is_damage(int result)
{
    return result == SQLITE_CORRUPT || result == SQLITE_NOTADB || result == SQLITE_TOOBIG;
}

// ---- what is said once

// Continues with the rows of a query.
static ld_status digest_rows(const store_view *self, const char *format, uint32_t *digest,
                             ld_error *error)
{
    sqlite3_stmt *row = store_view_prepare(self, format, error);
    int result;
    if (!row)
        return store_status(self->store);
    while ((result = sqlite3_step(row)) == SQLITE_ROW)
        *digest = digest_columns(*digest, row, 0, sqlite3_column_count(row));
    sqlite3_finalize(row);
    return result == SQLITE_DONE ? LD_OK : store_view_fail(self, error);
}

static ld_status find_facts(const store_view *self, uint32_t *digest, ld_error *error)
{
    static const char *const queries[] = {
        "SELECT type, name, tbl_name, sql FROM %s.sqlite_master ORDER BY name",
        "SELECT name, value FROM %s.study WHERE name != 'kept' ORDER BY name",
        "SELECT * FROM %s.point ORDER BY point",
        "SELECT kind, name, text FROM %s.origin ORDER BY rowid",
    };
    ld_status status = LD_OK;
    *digest = 0;
    for (size_t i = 0; i < sizeof queries / sizeof *queries && !status; i++)
        status = digest_rows(self, queries[i], digest, error);
    return status;
}

// The row `kept`: count, greatest number and sum of digests, then the digest of all that.
static void kept_text(const store_kept *kept, char text[128])
{
    int length = snprintf(text, 96, "%" PRId64 " %" PRId64 " %016" PRIx64, kept->samples,
                          kept->greatest, kept->sum);
    snprintf(text + length, 16, " %08" PRIx32, digest_text(kept->facts, text, (size_t)length));
}

// A database of this format, which says so in one word.
static ld_status check_format(const store_view *self, ld_error *error)
{
    char *format = NULL, *version = NULL;
    ld_status status = store_view_text(self, "format", &format, error);
    if (!status)
        status = store_view_text(self, "version", &version, error);
    if (!status && (!format || !version))
        status = ld_fail(error, LD_ERR_INPUT, "%s contains no study", self->path);
    else if (!status && strcmp(format, STORE_FORMAT) != 0)
        status = ld_fail(error, LD_ERR_INPUT,
                         "%s is of format %.20s, begun by launchdyn %.40s: this is launchdyn "
                         "%s, which knows format " STORE_FORMAT " only",
                         self->path, format, version, LD_VERSION);
    free(format);
    free(version);
    return status;
}

ld_status store_read_kept(const store_view *self, store_kept *kept, ld_error *error)
{
    char again[128], *text;
    *kept = (store_kept){0};
    ld_status status = check_format(self, error);
    if (!status)
        status = store_check_tables(self, error);
    if (!status)
        status = find_facts(self, &kept->facts, error);
    if (status)
        return status;
    status = store_view_text(self, "kept", &text, error);
    if (status)
        return status;
    if (text)
        sscanf(text, "%" SCNd64 " %" SCNd64 " %" SCNx64, &kept->samples, &kept->greatest,
               &kept->sum);
    kept_text(kept, again);
    if (!text || strcmp(text, again) != 0)
        status = ld_fail(error, LD_ERR_INPUT,
                         "%s is damaged: its tables study, point, origin were changed", self->path);
    free(text);
    return status;
}

ld_status store_write_kept(study_store *self, ld_error *error)
{
    char text[128];
    kept_text(&self->kept, text);
    return store_set_text(self, "kept", text, error);
}

ld_status store_seal(study_store *self, ld_error *error)
{
    const store_view view = store_main(self);
    ld_status status = find_facts(&view, &self->kept.facts, error);
    return status ? status : store_write_kept(self, error);
}

// ---- samples

enum { SAMPLE, POINT, STATUS, DIGEST, COLUMNS }; // asked for by name, then all; the last: digest

ld_status store_walk_begin(store_walk *self, const store_view *view, const store_kept *kept,
                           ld_error *error)
{
    *self = (store_walk){.view = *view, .kept = *kept};
    self->sample = store_view_prepare(view,
                                      "SELECT sample, point, status, digest, * FROM %s.sample "
                                      "WHERE sample >= ? ORDER BY sample LIMIT 1",
                                      error);
    self->rocket =
        self->sample ? store_view_prepare(
                           view, "SELECT * FROM %s.rocket WHERE sample = ? ORDER BY rocket", error)
                     : NULL;
    return self->rocket ? LD_OK : store_status(view->store);
}

void store_walk_again(store_walk *self)
{
    self->number = 0;
    self->intact = self->damaged = self->first_damaged = self->all_rockets = 0;
    self->sum = 0;
}

// Reads the sample's rockets.
static int read_rockets(store_walk *self)
{
    int result;
    self->rockets = 0;
    self->digest = 0;
    sqlite3_bind_int64(self->rocket, 1, self->number);
    while ((result = sqlite3_step(self->rocket)) == SQLITE_ROW) {
        self->digest =
            digest_columns(self->digest, self->rocket, 0, sqlite3_column_count(self->rocket));
        self->rockets++;
    }
    sqlite3_reset(self->rocket);
    return result;
}

// Reads the first sample from this number on: SQLITE_ROW, SQLITE_DONE (there is none), or what was
// wrong; *intact: it is as it was kept.
static int read_sample(store_walk *self, int64_t from, bool *intact)
{
    sqlite3_bind_int64(self->sample, 1, from);
    int result = sqlite3_step(self->sample);
    *intact = false;
    self->number = from;
    if (result == SQLITE_ROW && sqlite3_column_int64(self->sample, SAMPLE) >= from) {
        const char *status = (const char *)sqlite3_column_text(self->sample, STATUS);
        self->number = sqlite3_column_int64(self->sample, SAMPLE);
        self->point = sqlite3_column_int64(self->sample, POINT);
        self->failed = !status || strcmp(status, ld_status_name(LD_OK)) != 0;
        int rockets = read_rockets(self);
        self->digest = digest_columns(self->digest, self->sample, COLUMNS,
                                      sqlite3_column_count(self->sample) - 1);
        *intact = rockets == SQLITE_DONE &&
                  (int32_t)self->digest == sqlite3_column_int64(self->sample, DIGEST);
        result = rockets == SQLITE_DONE ? SQLITE_ROW : rockets;
    }
    // what of a row could not be made, without memory, is reported here
    const int after = sqlite3_reset(self->sample);
    return result == SQLITE_ROW && after != SQLITE_OK ? after : result;
}

bool store_walk_next(store_walk *self, ld_error *error)
{
    bool intact = false;
    for (int result; !intact && !self->status && self->number < INT64_MAX;) {
        result = read_sample(self, self->number + 1, &intact);
        if (result == SQLITE_DONE || (is_damage(result) && self->number > self->kept.greatest))
            return false;
        if (result != SQLITE_ROW && !is_damage(result)) {
            self->status = store_fail_by(self->view.store, result, self->view.path, "read", error);
        } else if (intact) {
            self->intact++;
            self->sum += self->digest;
            self->all_rockets += self->rockets;
        } else {
            self->damaged++;
            if (result == SQLITE_ROW && !self->first_damaged)
                self->first_damaged = self->number;
        }
    }
    return intact;
}

void store_walk_end(store_walk *self)
{
    sqlite3_finalize(self->sample);
    sqlite3_finalize(self->rocket);
}

// ---- the verdict

// The number, or the last line of the text, that a query gives first.
static ld_status first_value(const store_view *self, const char *format, int64_t *number,
                             char text[160], ld_error *error)
{
    sqlite3_stmt *row = store_view_prepare(self, format, error);
    if (!row)
        return store_status(self->store);
    int result = sqlite3_step(row);
    char *told = NULL;
    ld_status status = result == SQLITE_ROW ? store_column_text(self, row, 0, &told, error)
                                            : store_view_fail(self, error);
    const char *line = told ? strrchr(told, '\n') : NULL;
    *number = result == SQLITE_ROW ? sqlite3_column_int64(row, 0) : 0;
    snprintf(text, 160, "%s", line ? line + 1 : told ? told : "");
    free(told);
    sqlite3_finalize(row);
    return status;
}

static ld_status damaged_samples(const store_walk *self, ld_error *error)
{
    const int64_t gone = self->kept.samples - self->intact;
    char first[48] = "";
    if (self->first_damaged)
        snprintf(first, sizeof first, " (the first: %" PRId64 ")", self->first_damaged);
    return ld_fail(error, LD_ERR_INPUT,
                   "%s is damaged: changed samples: %" PRId64 " of %" PRId64 "%s", self->view.path,
                   gone > self->damaged ? gone : self->damaged, self->kept.samples, first);
}

ld_status store_walk_verdict(const store_walk *self, ld_error *error)
{
    const store_view *view = &self->view;
    int64_t rockets, none;
    char text[160];
    if (self->status)
        return self->status;
    if (self->damaged > 0 || self->intact < self->kept.samples)
        return damaged_samples(self, error);
    if (self->intact > self->kept.samples || self->sum != self->kept.sum)
        return ld_fail(error, LD_ERR_INPUT, "%s is damaged: it has samples that were not stored",
                       view->path);
    ld_status status = first_value(view, "SELECT count(*) FROM %s.rocket", &rockets, text, error);
    if (!status && rockets != self->all_rockets)
        status = ld_fail(error, LD_ERR_INPUT, "%s is damaged: it has rockets without a sample",
                         view->path);
    if (!status)
        status = first_value(view, "PRAGMA %s.integrity_check(1)", &none, text, error);
    if (!status && strcmp(text, "ok") != 0)
        status = ld_fail(error, LD_ERR_INPUT, "%s is damaged: %s", view->path, text);
    return status;
}

ld_status store_check(const store_view *self, store_kept *kept, ld_error *error)
{
    store_walk walk = {0};
    ld_status status = store_read_kept(self, kept, error);
    if (!status)
        status = store_walk_begin(&walk, self, kept, error);
    while (!status && store_walk_next(&walk, error))
        ;
    if (!status)
        status = store_walk_verdict(&walk, error);
    store_walk_end(&walk);
    return status;
}
