// The table of a study's rockets as HDF5: group `rockets` with a dataset for each column, of a
// sweep group `points` too.
#ifndef LD_STUDIES_EXPORT_HDF5_H
#define LD_STUDIES_EXPORT_HDF5_H

#include "launchdyn/status.h"

// Writes an export_table, from its first row, as an HDF5 file: a table_writer.
ld_status export_hdf5(void *exported, const char *file, const char *name, ld_error *error);

#endif
