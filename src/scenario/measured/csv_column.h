// Columns of a CSV file of measured values: a header of "NAME [unit]", numbers below.
#ifndef LD_SCENARIO_MEASURED_CSV_COLUMN_H
#define LD_SCENARIO_MEASURED_CSV_COLUMN_H

#include <stdbool.h>
#include <stddef.h>

enum { CSV_NAME = 96, CSV_UNIT = 32 };

typedef struct csv_column {
    char name[CSV_NAME];
    char unit[CSV_UNIT]; // as the file has it, "" without
} csv_column;

// Takes name and unit of a header's field; false: it is not of that form.
bool csv_column_read(const char *text, csv_column *column);

// Factor from the column's unit to the SI unit `target`; false: `why` is a sentence.
bool csv_column_factor(const csv_column *column, const char *target, double *factor, char *why,
                       size_t size);

// The number in a field; false: `why` is a sentence.
bool csv_number(const char *text, double *value, char *why, size_t size);

#endif
