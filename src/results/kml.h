// trajectories.kml: the flights of a run as lines over the Earth (OGC KML 2.2).
#ifndef LD_RESULTS_KML_H
#define LD_RESULTS_KML_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/results.h"
#include "launchdyn/status.h"

typedef struct kml_file kml_file;

// Whether the model says where on the Earth its flights are.
bool kml_has_place(const ld_model *model);

// Writes a text as XML has it; what XML cannot hold becomes U+FFFD.
void kml_write_text(FILE *stream, const char *text);

// Creates the file at `path` with the model's title; the model is kept by reference. A flat Earth
// is laid as a tangent plane on the WGS 84 ellipsoid at its site, heights upright on it.
ld_status kml_create(const char *path, const ld_model *model, kml_file **file, ld_error *error);
// The rows that follow are of the flight of rocket number `rocket`.
ld_status kml_flight(kml_file *file, int rocket, const ld_column *columns, size_t count,
                     ld_error *error);
ld_status kml_row(kml_file *file, const double *values, ld_error *error);
// Ends the last line, closes the file and frees.
ld_status kml_close(kml_file *file, ld_error *error);

#endif
