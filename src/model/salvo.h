// The rocket of each firing: where the rockets of a salvo differ in numbers, each its own.
#ifndef LD_MODEL_SALVO_H
#define LD_MODEL_SALVO_H

#include <stdbool.h>

#include "launchdyn/model.h"

// Whether they differ.
bool salvo_is_given(const ld_model *model);
// That of firing i, in the order of firing.
const struct ld_rocket *salvo_rocket(const ld_model *model, int i);

#endif
