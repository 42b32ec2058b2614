/// The model: what a scenario says, checked and whole, in SI units and radians.
///
/// A model is made by reading a scenario (launchdyn/scenario.h). It is constant while it runs: what
/// is made of it keeps it by reference.
#ifndef LAUNCHDYN_MODEL_H
#define LAUNCHDYN_MODEL_H

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct ld_model ld_model;

/// All that a scenario was read from, so that it can be read again without its files.
typedef struct ld_source ld_source;

/// May be NULL.
void ld_model_free(ld_model *model);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
