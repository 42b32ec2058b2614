// What a sensor would have read in a run: what is there at its place, through its low pass, at the
// instants of the log.
#ifndef LD_COMPARE_SENSOR_READING_H
#define LD_COMPARE_SENSOR_READING_H

#include "compare/sensor.h"

// What the sensor measures over the time from ignition, before low pass, scale and bias:
//   accelerometer at r in B: axis . (f + w_dot x r + w x (w x r)), f the specific force at O1
//   gyro: axis . w
//   on the launcher: launcher_reading.h
//   altimeter: height of the mass centre above where it is at the ignition
// @return LD_OK, LD_ERR_INPUT (the run has no such columns), LD_ERR_MEMORY
ld_status sensor_signal(const sensor *self, const run_series *run, run_signal *signal,
                        ld_error *error);

// Readings at n times from ignition, which rise; outside the signal its end values count.
// @return LD_OK, LD_ERR_MEMORY
ld_status sensor_read(const sensor *self, const run_signal *signal, size_t n, const double *t,
                      double *reading, ld_error *error);

#endif
