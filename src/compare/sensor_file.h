// The description of a log's sensors: a file of keys.
#ifndef LD_COMPARE_SENSOR_FILE_H
#define LD_COMPARE_SENSOR_FILE_H

#include "compare/sensor.h"

// Clock without keys; a sensor of the kind `column` without more.
void sensor_file_defaults(measured_log *log);
ld_status sensor_file_add_column(measured_log *log, const char *name, const char *unit,
                                 ld_error *error);

// Reads clock, sensors and results; units of what sensors measure are the run's.
ld_status sensor_file_read(measured_log *log, const char *path, const run_series *run,
                           ld_error *error);
void sensor_file_free(measured_log *log);

#endif
