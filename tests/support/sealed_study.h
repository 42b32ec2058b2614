// Databases of studies changed by hand, with the digests that then belong to them.
#ifndef LD_TESTS_SUPPORT_SEALED_STUDY_H
#define LD_TESTS_SUPPORT_SEALED_STUDY_H

#include <sqlite3.h>

#include "studies/store/row_digest.h"
#include "studies/store/store_check.h"
#include "support/check.h"

// The digest of a sample and its rockets as they stand there.
static inline uint32_t digest_in(sqlite3 *database, int64_t number)
{
    static const char *const queries[] = {"SELECT * FROM rocket WHERE sample = ? ORDER BY rocket",
                                          "SELECT * FROM sample WHERE sample = ?"};
    uint32_t digest = 0;
    for (int i = 0; i < 2; i++) {
        sqlite3_stmt *row;
        assert_int_equal(sqlite3_prepare_v2(database, queries[i], -1, &row, NULL), SQLITE_OK);
        sqlite3_bind_int64(row, 1, number);
        while (sqlite3_step(row) == SQLITE_ROW) // the last column of a sample is its digest
            digest = digest_columns(digest, row, 0, sqlite3_column_count(row) - i);
        sqlite3_finalize(row);
    }
    return digest;
}

// Writes the digests that belong to what stands there.
static inline void seal_study(const char *path)
{
    study_store store = {.lock = -1};
    sqlite3_stmt *number, *seal;
    assert_int_equal(sqlite3_open(path, &store.database), SQLITE_OK);
    sqlite3_exec(store.database, "BEGIN; ALTER TABLE sample ADD digest INTEGER", NULL, NULL, NULL);
    sqlite3_prepare_v2(store.database, "SELECT sample FROM sample", -1, &number, NULL);
    sqlite3_prepare_v2(store.database, "UPDATE sample SET digest = ? WHERE sample = ?", -1, &seal,
                       NULL);
    while (sqlite3_step(number) == SQLITE_ROW) {
        uint32_t digest = digest_in(store.database, sqlite3_column_int64(number, 0));
        store_kept_add(&store.kept, sqlite3_column_int64(number, 0), digest);
        sqlite3_bind_int64(seal, 1, (int32_t)digest);
        sqlite3_bind_int64(seal, 2, sqlite3_column_int64(number, 0));
        assert_true(store_step(seal));
    }
    sqlite3_finalize(number);
    sqlite3_finalize(seal);
    assert_int_equal(store_seal(&store, NULL), LD_OK);
    assert_int_equal(sqlite3_exec(store.database, "COMMIT", NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(store.database);
}

// Runs SQL on a database.
static inline void run_sql(const char *path, const char *text)
{
    char *problem = NULL;
    sqlite3 *database;
    assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
    sqlite3_exec(database, text, NULL, NULL, &problem);
    if (problem)
        fail_msg("%s", problem);
    sqlite3_close(database);
}

#endif
