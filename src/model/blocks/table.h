/// A numeric table.
#ifndef LD_MODEL_BLOCKS_TABLE_H
#define LD_MODEL_BLOCKS_TABLE_H

#include <stddef.h>

/// A numeric table, row by row, `rows` x `columns`, owned by its model. Empty: rows = 0.
typedef struct ld_table {
    size_t rows;
    size_t columns;
    double *data;
} ld_table;

#endif
