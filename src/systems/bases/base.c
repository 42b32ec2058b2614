// The kinds of base, and how one is built.
#include "systems/bases/base.h"

#include <math.h>

#include "model/model.h"

#define KIND(name, word, number) [name] = &base_##word,
static const base_interface *const kinds[] = {LD_BASE_KINDS(KIND)};

// NULL: there is none.
static const base_interface *base_of_kind(ld_base_kind kind)
{
    size_t number = (size_t)kind;
    return number < sizeof kinds / sizeof kinds[0] ? kinds[number] : NULL;
}

const quantity_table *base_quantities(ld_base_kind kind)
{
    const base_interface *base = base_of_kind(kind);
    return base ? base->quantities : NULL;
}

ld_status base_build(base_system *self, const ld_model *model, road **kept, ld_error *error)
{
    *self = (base_system){.model = model, .kind = base_of_kind(model->base.kind), .kept = kept};
    if (!self->kind)
        return ld_fail(error, LD_ERR_INPUT, "base.kind: %d carries no tube", (int)model->base.kind);
    ld_status status = self->kind->build(self, error);
    self->kept = NULL;
    if (status)
        base_free(self);
    return status;
}

road *base_take_road(base_system *self)
{
    return self->own && self->kind->take_road ? self->kind->take_road(self) : NULL;
}

void base_free(base_system *self)
{
    if (self->kind)
        self->kind->free(self);
    *self = (base_system){0};
}

ld_status base_share(base_system *self, const base_system *of, ld_error *error)
{
    *self = *of;
    if (!self->kind->share)
        return LD_OK;
    ld_status status = self->kind->share(self, error);
    if (status)
        base_free(self);
    return status;
}

void base_free_share(base_system *self)
{
    if (self->kind && self->kind->share)
        base_free(self);
    *self = (base_system){0};
}

void base_span(const base_system *self, double *first, double *last)
{
    *first = -INFINITY;
    *last = INFINITY;
    if (self->kind->span)
        self->kind->span(self, first, last);
}

void base_angles(const base_system *self, double t, const base_frame *tube, double angles[3])
{
    if (self->kind->angles)
        self->kind->angles(self, t, angles);
    else
        m3_yaw_pitch_roll(&tube->A, angles);
}

void base_find(const base_system *self, const base_found *found, const base_output *output,
               const double *state, base_instant *instant)
{
    if (self->kind->fill_instant)
        self->kind->fill_instant(self, found, output, state, instant);
}
