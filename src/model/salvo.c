#include "model/salvo.h"

#include "model/model.h"

bool salvo_is_given(const ld_model *model)
{
    return model->salvo;
}

const ld_rocket *salvo_rocket(const ld_model *model, int i)
{
    return model->salvo ? &model->salvo[i] : &model->rocket;
}
