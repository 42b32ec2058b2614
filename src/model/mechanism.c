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

int mechanism_joint(const ld_mechanism *self, const char *name)
{
    for (int i = 0; i < self->joint_count; i++)
        if (strcmp(self->joint[i].name, name) == 0)
            return i;
    return -1;
}
