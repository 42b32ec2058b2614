// The rocket of each firing: where the rockets of a salvo differ in numbers, each its own.
#ifndef LD_MODEL_SALVO_H
#define LD_MODEL_SALVO_H

#include "model/model.h"

// That of firing i, in the order of firing.
static inline const ld_rocket *salvo_rocket(const ld_model *model, int i)
{
    return model->salvo ? &model->salvo[i] : &model->rocket;
}

#endif
