// Reading a log: a CSV file with a column of times, and beside it a file of keys that says what its
// sensors are (docs/compare.md).
#ifndef LD_COMPARE_MEASURED_LOG_H
#define LD_COMPARE_MEASURED_LOG_H

#include "compare/sensor.h"

// Reads log and description; `sensors` NULL: the file beside the log whose ending is .yaml, and
// without one each column of the log that has a name of the run's.
// @return LD_OK, LD_ERR_INPUT, LD_ERR_FILE, LD_ERR_MEMORY
ld_status measured_log_read(measured_log *self, const char *log, const char *sensors,
                            const run_series *run, ld_error *error);
void measured_log_free(measured_log *self);

#endif
