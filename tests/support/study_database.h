// A study's database, written by hand in a folder of the scratch folder.
#ifndef LD_TESTS_SUPPORT_STUDY_DATABASE_H
#define LD_TESTS_SUPPORT_STUDY_DATABASE_H

#include <sqlite3.h>
#include <sys/stat.h>

#include "support/check.h"
#include "support/scratch.h"

// The table `study`, of hypercubes of so many samples ("1": random).
#define STUDY(strata)                                                                              \
    "CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT);"                                      \
    "INSERT INTO study VALUES ('format', '2'), ('version', '0.1'), ('samples', '6'),"              \
    "  ('strata', '" strata "'), ('scenario', 'include: fixed.yaml');"

// Runs SQL on the study in folder `name`, which is made where it is not there.
static void write_database(const char *name, const char *text)
{
    char path[256];
    char *problem = NULL;
    sqlite3 *database;
    mkdir(in(name), 0777);
    snprintf(path, sizeof path, "%s/study.db", in(name));
    assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
    sqlite3_exec(database, text, NULL, NULL, &problem);
    if (problem)
        fail_msg("%s", problem);
    sqlite3_close(database);
}

#endif
