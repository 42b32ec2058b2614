#include "model/model.h"

#include <string.h>

int mechanism_body(const ld_mechanism *self, const char *name)
{
    if (strcmp(name, "ground") == 0)
        return LD_ON_GROUND;
    if (strcmp(name, "carrier") == 0)
        return LD_ON_CARRIER;
    for (int i = 0; i < self->body_count; i++)
        if (strcmp(self->body[i].name, name) == 0)
            return i;
    for (int i = 0; i < self->beam_count; i++)
        if (strcmp(self->beam[i].name, name) == 0)
            return self->body_count + i;
    return LD_ON_NOTHING;
}

int beam_coordinates(const ld_beam *beam)
{
    return 2 * beam->modes.bending + beam->modes.torsion + beam->modes.axial;
}

int mechanism_beam_coordinates(const ld_mechanism *self)
{
    int count = 0;
    for (int i = 0; i < self->beam_count; i++)
        count += beam_coordinates(&self->beam[i]);
    return count;
}

static bool is_carrier(const char *name)
{
    return strcmp(name, "carrier") == 0;
}

bool mechanism_has_carrier(const ld_mechanism *self)
{
    bool has = false;
    for (int i = 0; i < self->joint_count; i++)
        has = has || is_carrier(self->joint[i].parent);
    for (int i = 0; i < self->bushing_count; i++)
        has = has || is_carrier(self->bushing[i].from) || is_carrier(self->bushing[i].to);
    for (int i = 0; i < self->strut_count; i++)
        has = has || is_carrier(self->strut[i].from) || is_carrier(self->strut[i].to);
    return has;
}

size_t mechanism_triangles(const ld_mechanism *self)
{
    size_t count = 0;
    for (int i = 0; i < self->body_count; i++)
        if (self->body[i].appearance.shape == LD_SHAPE_MESH)
            count += self->body[i].appearance.mesh.rows;
    return count;
}

int mechanism_joint(const ld_mechanism *self, const char *name)
{
    for (int i = 0; i < self->joint_count; i++)
        if (strcmp(self->joint[i].name, name) == 0)
            return i;
    return -1;
}
