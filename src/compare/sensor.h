// A log of measured series, with its sensors, its clock and the numbers to compare
// (docs/compare.md).
#ifndef LD_COMPARE_SENSOR_H
#define LD_COMPARE_SENSOR_H

#include "compare/run_series.h"
#include "scenario/measured/csv_column.h"

typedef enum sensor_kind {
    SENSOR_ACCELEROMETER,
    SENSOR_GYRO,
    SENSOR_ALTIMETER,
    SENSOR_STRAIN,
    SENSOR_COLUMN,
} sensor_kind;

// A sensor, and the column of the log that it wrote. Its reading is
//   scale * low pass(what is there, delay ago) + bias, within its range.
// Numbers in SI units of what it measures.
typedef struct sensor {
    char *column; // its name in the log
    sensor_kind kind;
    char of[LD_MAX_QUANTITY]; // column of the run, where that is what it measures
    char *on; // part of the launcher that carries it, as its columns begin; NULL: the rocket
    double at[3], axis[3]; // [m] place, and direction in which it measures, in that part's axes
    double cutoff;         // [Hz] NaN: no low pass
    int order;
    double delay; // [s]
    double scale, bias;
    double noise;                               // rms of a sample
    double bias_uncertainty, scale_uncertainty; // standard
    double range[2];                            // NaN: none
    double resolution;
    double rest[2];      // [s] window in which the bias is found; NaN: it is not
    window_end from, to; // what is compared
    double limit;        // what the comparison is to tell; NaN: the size of the measured
    // from the log
    char si[CSV_UNIT]; // unit, "" without
    csv_column head;
    double factor; // from the log's unit
    int field;     // in the file
    double *value; // [rows] SI; NaN: a gap
} sensor;

typedef enum result_take {
    TAKE_RESULT, // a result of the run by name
    TAKE_MAX,
    TAKE_MIN,
    TAKE_MEAN,
    TAKE_RMS,
    TAKE_VALUE,
    TAKE_T_MAX,
    TAKE_T_MIN,
} result_take;

// A number to compare: a result of the run, or one of a sensor's series.
typedef struct log_result {
    char *of, *name; // name NULL: that of `of`
    result_take take;
    char *measured, *uncertainty, *limit; // numbers with units; NULL: none
    window_end from, to, at;
    int sensor; // -1: a result of the run
} log_result;

// Time from ignition = time of the log + offset.
typedef struct log_clock {
    char *column, *find;        // NULL: t or time; NULL: the offset is given
    double offset, uncertainty; // [s]
    double within;              // [s] searched on both sides of the offset
    window_end from, to;        // of the run, where the search compares
} log_clock;

typedef struct measured_log {
    log_clock clock;
    size_t rows;
    double *t; // [rows] s, of the log
    int sensors, results;
    sensor *sensor;     // [sensors]
    log_result *result; // [results]
} measured_log;

#endif
