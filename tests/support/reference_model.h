// The reference launcher of docs (invented round numbers), filled by hand: fixed base, elevation
// 19.8 deg, tube 8, no lead-in.
#ifndef LD_TESTS_SUPPORT_REFERENCE_MODEL_H
#define LD_TESTS_SUPPORT_REFERENCE_MODEL_H

#include <stddef.h>

#include "launchdyn/model.h"
#include "model/blocks/table.h"

// Fills `model` on a fixed base; free with reference_model_free() or model_clear().
void reference_model(ld_model *model);

// The same on its vehicle at `speed` [m/s], on a flat road.
void reference_vehicle(ld_model *model, double speed);

// Frees what reference_model() and reference_table() allocated in `model`.
void reference_model_free(ld_model *model);

// A table of its own copy of `data`, rows x columns.
ld_table reference_table(size_t rows, size_t columns, const double *data);

// Puts 2 MPa of air at the start, before air of 0.1 MPa, in place of its motor.
void reference_by_pressure(ld_model *model);
// Lets the tube recoil at its first support, the second of which then holds it no more along x.
void reference_recoil(ld_model *model);

#endif
