// A table as a file, which gets its name when it is whole; lines of CSV.
#ifndef LD_STUDIES_TABLE_FILE_H
#define LD_STUDIES_TABLE_FILE_H

#include <stdio.h>

#include "launchdyn/status.h"

// Writes what `self` is into a file; messages call it by its name.
typedef ld_status table_writer(void *self, const char *file, const char *name, ld_error *error);

// Under a temporary name beside the file, which then gets its own, where it is a file.
// @return LD_OK, LD_ERR_INPUT (too long a name), what the writer returns
ld_status table_file_write(table_writer *write, void *self, const char *name, ld_error *error);

// Prints what `self` is.
typedef ld_status csv_writer(void *self, FILE *stream, ld_error *error);

// The same of a file of text.
// @return besides, LD_ERR_FILE
ld_status table_file_print(csv_writer *write, void *self, const char *name, ld_error *error);

// A field of CSV: texts with a comma, a quote or a line's end stand in quotes (RFC 4180).
void csv_text(FILE *stream, const char *text);

#endif
