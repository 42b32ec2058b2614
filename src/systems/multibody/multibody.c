#include "systems/multibody/multibody.h"

#include <math.h>
#include <string.h>

// ---- hinges

uint8_t multibody_pass(const node *n, int prescribed)
{
    static const uint8_t pass[] = {[NODE_WELD] = PASS_WELD,
                                   [NODE_TURN] = PASS_TURN,
                                   [NODE_SLIDE] = PASS_SLIDE,
                                   [NODE_BALL] = PASS_SEVERAL,
                                   [NODE_FREE] = PASS_SEVERAL};
    return prescribed && n->hinge != NODE_WELD ? PASS_GIVEN : pass[n->hinge];
}

void ld_mstmm_prescribe(ld_mstmm *s, int element, int prescribed)
{
    // the nodes of its hinge end in its body's
    int i = s->element_node[element];
    s->prescribed[element] = prescribed != 0;
    do
        s->pass[i] = multibody_pass(&s->node[i], prescribed);
    while (i > 1 && s->node[i].parent == i - 1 && s->node[--i].element < 0 &&
           s->node[i].body == NODE_RIGID);
}

// ---- questions

int ld_mstmm_element_count(const ld_mstmm *s)
{
    return s->element_count;
}

int ld_mstmm_coordinate_count(const ld_mstmm *s)
{
    return s->q_count;
}

int ld_mstmm_speed_count(const ld_mstmm *s)
{
    return s->u_count;
}

int ld_mstmm_find(const ld_mstmm *s, const char *name)
{
    for (int e = 0; e < s->element_count; e++)
        if (!strcmp(s->name[e], name))
            return e;
    return -1;
}

int ld_mstmm_coordinate_offset(const ld_mstmm *s, int element)
{
    return s->element_q[element];
}

int ld_mstmm_speed_offset(const ld_mstmm *s, int element)
{
    return s->element_u[element];
}

void ld_mstmm_reference(const ld_mstmm *s, double *q)
{
    memset(q, 0, (size_t)s->q_count * sizeof *q);
    for (int e = 0; e < s->element_count; e++) {
        if (s->element[e].hinge == LD_HINGE_SPHERICAL)
            q[s->element_q[e]] = 1;
        if (s->element[e].hinge == LD_HINGE_FREE)
            q[s->element_q[e] + 3] = 1;
    }
}

ld_status multibody_singular(const ld_mstmm *s, int i, ld_error *error)
{
    int element = s->node[i].element >= 0 ? s->node[i].element : s->node[i + 1].element;
    const node_motion *m = &s->motion[i];
    bool finite_state = isfinite(m->A[0][0] + v4d_total(m->w)[0] + v4d_total(m->r)[0]);
    return ld_fail(error, LD_ERR_NUMERIC,
                   finite_state ? "element '%s': its hinge is in a singular state, nothing resists "
                                  "along one of its axes"
                                : "element '%s': its state is not finite",
                   s->name[element]);
}
