#include "systems/mechanism/mechanism_description.h"

#include <string.h>

#include "base/printed.h"
#include "model/model.h"
#include "model/parts.h"
#include "systems/multibody/multibody.h"

static const char *motion_of(ld_joint_kind kind)
{
    switch (kind) {
    case LD_JOINT_FIXED:
        break;
    case LD_JOINT_REVOLUTE:
        return "turns about an axis";
    case LD_JOINT_PRISMATIC:
        return "slides along an axis";
    case LD_JOINT_CYLINDRICAL:
        return "turns about an axis and slides along it";
    case LD_JOINT_UNIVERSAL:
        return "turns about two axes";
    case LD_JOINT_SPHERICAL:
        return "turns about a point";
    case LD_JOINT_PLANAR:
        return "slides in a plane and turns in it";
    case LD_JOINT_FREE:
        return "moves freely";
    }
    return "is fixed";
}

static void describe_holders(const ld_mechanism *given, const ld_joint *joint, FILE *stream)
{
    for (int i = 0; i < given->drive_count; i++)
        if (strcmp(given->drive[i].joint, joint->name) == 0)
            fprintf(stream, ", driven by %s", VISIBLE(given->drive[i].name));
    if (!joint->lock.spring.present)
        return;
    if (isnan(joint->lock.from))
        fprintf(stream, ", locked");
    else
        fprintf(stream, ", locked from %.4g s", joint->lock.from);
}

// The bodies that the joints of the tree carry on `parent`, and on those.
static void describe_carried(const mechanism_system *self, const char *parent, int depth,
                             FILE *stream)
{
    const ld_mechanism *given = self->given;
    for (int i = 0; i < given->joint_count; i++) {
        const ld_joint *joint = &given->joint[i];
        if (self->joint_element[i] < 0 || strcmp(joint->parent, parent) != 0)
            continue;
        bool bends = self->joint_element[i] >= given->body_count;
        fprintf(stream, "#   %*s%s%s: %s in joint %s", 2 * depth, "", bends ? "beam " : "",
                VISIBLE(joint->body), motion_of(joint->kind), VISIBLE(joint->name));
        describe_holders(given, joint, stream);
        if (strcmp(self->model->tubes.on, joint->body) == 0)
            fprintf(stream, "; carries the %s", model_guide_word(self->model));
        if (strcmp(given->wheels_on, joint->body) == 0)
            fprintf(stream, "; stands on wheels");
        fputc('\n', stream);
        describe_carried(self, joint->body, depth + 1, stream);
    }
}

static void describe_root(const mechanism_system *self, const char *root, FILE *stream)
{
    for (int i = 0; i < self->given->joint_count; i++)
        if (self->joint_element[i] >= 0 && strcmp(self->given->joint[i].parent, root) == 0) {
            fprintf(stream, "#   %s\n", root);
            describe_carried(self, root, 1, stream);
            return;
        }
}

static int constraints_of(ld_joint_kind kind)
{
    static const int count[] = {
        [LD_JOINT_FIXED] = 6,       [LD_JOINT_REVOLUTE] = 5,  [LD_JOINT_PRISMATIC] = 5,
        [LD_JOINT_CYLINDRICAL] = 4, [LD_JOINT_UNIVERSAL] = 4, [LD_JOINT_SPHERICAL] = 3,
        [LD_JOINT_PLANAR] = 3};
    return count[kind];
}

static const char *plural(int count)
{
    return count == 1 ? "" : "s";
}

// How many constraints of a joint others imply.
static int implied_of(const mechanism_system *self, int joint)
{
    return ld_mstmm_loop_redundancy(self->chain, self->joint_loop[joint]);
}

static void describe_loop(const mechanism_system *self, int i, FILE *stream)
{
    const ld_joint *joint = &self->given->joint[i];
    int constraints = constraints_of(joint->kind), implied = implied_of(self, i);
    fprintf(stream, "#   loop: %s %s on %s in joint %s, %d constraint%s", VISIBLE(joint->body),
            motion_of(joint->kind), VISIBLE(joint->parent), VISIBLE(joint->name), constraints,
            plural(constraints));
    if (implied > 0)
        fprintf(stream, ", %d redundant", implied);
    fputc('\n', stream);
}

static int modes_of(const mechanism_system *self)
{
    int modes = self->u_count;
    for (int e = 0; e < self->element_count; e++)
        modes -= e == self->carrier ? 0 : self->chain->u_length[e];
    return modes;
}

static void describe_freedoms(const mechanism_system *self, FILE *stream)
{
    int modes = modes_of(self), tree = self->u_count - modes, implied = 0;
    int held = self->u_count - self->freedom_count;
    for (int i = 0; i < self->given->joint_count; i++)
        implied += self->joint_element[i] < 0 ? implied_of(self, i) : 0;
    fprintf(stream, "# degrees of freedom: %d", tree - held);
    if (held + implied > 0)
        fprintf(stream, " (%d of the tree less %d that loops take)", tree, held);
    if (modes > 0)
        fprintf(stream, ", and %d mode%s of beams", modes, plural(modes));
    fputc('\n', stream);
}

void mechanism_describe(const mechanism_system *self, FILE *stream)
{
    const ld_mechanism *given = self->given;
    fprintf(stream, "# bodies and the joints that carry them:\n");
    describe_root(self, "ground", stream);
    describe_root(self, "carrier", stream);
    for (int i = 0; i < given->joint_count; i++)
        if (self->joint_element[i] < 0)
            describe_loop(self, i, stream);
    describe_freedoms(self, stream);
}
