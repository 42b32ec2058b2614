// The table of a study's rockets, to be written: columns with their units, rows from the database.
#ifndef LD_STUDIES_EXPORT_TABLE_H
#define LD_STUDIES_EXPORT_TABLE_H

#include <sqlite3.h>

#include "studies/store/store_check.h"
#include "studies/store/study_data.h"

enum { EXPORT_KEYS = 4 }; // sample, rocket, tube, status: the first columns

typedef struct export_table {
    const study_data *data;
    int keys; // columns before the factors: EXPORT_KEYS, of a sweep its points too
    int columns;
    sqlite3_stmt *row; // of the sample at which the walk stands
    store_walk walk;
    int64_t rockets; // given so far
} export_table;

// To be closed in any case.
ld_status export_open(export_table *table, const study_data *data, ld_error *error);
void export_close(export_table *table);

// Before the first row.
void export_begin(export_table *table);
// The next row of a sample that is as it was kept, in table->row; *there: there is one. Refuses
// others than were found when the study was opened.
ld_status export_next(export_table *table, bool *there, ld_error *error);

// The unit of a column, "" without.
const char *export_unit(const export_table *table, int column);

#endif
