// Files of keys that are no scenarios, read with the scenario's tables, units and messages.
#ifndef LD_SCENARIO_MEASURED_BLOCK_FILE_H
#define LD_SCENARIO_MEASURED_BLOCK_FILE_H

#include "scenario/scenario_reader.h"

// Takes what stands in the file, a block of keys, into `self`; what is wrong it tells the reader.
typedef void block_taker(scenario_reader *reader, const tree_node *root, void *self);

// Reads the file at `path`.
// @return LD_OK, LD_ERR_INPUT (the first message, with its place), LD_ERR_FILE, LD_ERR_MEMORY
ld_status block_file_read(const char *path, block_taker *take, void *self, ld_error *error);

#endif
