// A study's database, written by hand in a folder of the scratch folder.
#ifndef LD_TESTS_SUPPORT_STUDY_DATABASE_H
#define LD_TESTS_SUPPORT_STUDY_DATABASE_H

#include <sys/stat.h>

#include "studies/store/store_tables.h"
#include "support/scratch.h"
#include "support/sealed_study.h"

// The tables `study` and `origin`, of hypercubes of so many samples ("1": random).
#define STUDY(strata)                                                                              \
    "CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT);"                                      \
    "CREATE TABLE origin (kind TEXT, name TEXT, text BLOB);"                                       \
    "INSERT INTO study VALUES ('format', '" STORE_FORMAT                                           \
    "'), ('version', '0.1'), ('samples', '6'),"                                                    \
    "  ('strata', '" strata "'), ('scenario', 'include: fixed.yaml');"

// The table `point` of a study without a sweep.
#define ONE_POINT "CREATE TABLE point (point INTEGER PRIMARY KEY); INSERT INTO point VALUES (1);"

// Runs SQL on the study in folder `name`, which is made where it is not there, and seals it.
static inline void write_database(const char *name, const char *text)
{
    char path[256];
    mkdir(in(name), 0777);
    snprintf(path, sizeof path, "%s/study.db", in(name));
    run_sql(path, text);
    seal_study(path);
}

#endif
