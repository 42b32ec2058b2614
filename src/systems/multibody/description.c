// The description checked, and its tree.
#include "systems/multibody/description.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/vectors/mat3.h"
#include "model/blocks/limits.h"

// ---- hinges

const hinge_kind hinge_table[] = {
    [LD_HINGE_WELD] = {"weld", 0, 0, 0},
    [LD_HINGE_REVOLUTE] = {"revolute", 1, 1, 1},
    [LD_HINGE_PRISMATIC] = {"prismatic", 1, 1, 1},
    [LD_HINGE_CYLINDRICAL] = {"cylindrical", 2, 2, 1},
    [LD_HINGE_UNIVERSAL] = {"universal", 2, 2, 2},
    [LD_HINGE_SPHERICAL] = {"spherical", 4, 3, 0},
    [LD_HINGE_FREE] = {"free", 7, 6, 0},
    [LD_HINGE_PLANAR] = {"planar", 3, 3, 2},
};

// ---- axes

m3 description_axes_along(v3 axis)
{
    v3 z = v3_scale(1 / v3_norm(axis), axis);
    v3 other = fabs(z.x) < 0.6 ? v3_make(1, 0, 0) : v3_make(0, 1, 0);
    if (z.z == 1)
        return m3_identity();
    v3 x = v3_cross(other, z);
    x = v3_scale(1 / v3_norm(x), x);
    return m3_columns(x, v3_cross(z, x), z);
}

m3 description_plane_axes(const double axis[3], const double axis_2[3])
{
    v3 normal = v3_from(axis), first = v3_from(axis_2);
    normal = v3_scale(1 / v3_norm(normal), normal);
    first = v3_axpy(first, -v3_dot(first, normal), normal);
    first = v3_scale(1 / v3_norm(first), first);
    return m3_columns(first, v3_cross(normal, first), normal);
}

void description_joint_axes(ld_hinge joint, const double axis[3], const double axis_2[3],
                            m3 axes[2])
{
    axes[0] = m3_identity();
    if (joint == LD_HINGE_PLANAR)
        axes[0] = description_plane_axes(axis, axis_2);
    else if (hinge_table[joint].axes > 0)
        axes[0] = description_axes_along(v3_from(axis));
    axes[1] = joint == LD_HINGE_UNIVERSAL ? description_axes_along(v3_from(axis_2)) : axes[0];
}

// ---- checks of one element

bool description_all_finite(const double *x, int n)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return false;
    return true;
}

// A body's second moments of mass, tr(J)/2 E - J, are never negative; then J is that of a body.
static bool is_inertia(const double J[6])
{
    double half = 0.5 * (J[0] + J[1] + J[2]), tiny = 1e-9 * fabs(half);
    double xx = half - J[0], yy = half - J[1], zz = half - J[2], xy = -J[3], xz = -J[4], yz = -J[5];
    double determinant =
        xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    return half >= 0 && xx >= -tiny && yy >= -tiny && zz >= -tiny &&
           xx * yy - xy * xy >= -tiny * half && xx * zz - xz * xz >= -tiny * half &&
           yy * zz - yz * yz >= -tiny * half && determinant >= -tiny * half * half;
}

ld_status description_check_joint(const described_joint *j, ld_error *error)
{
    const char *sort = j->closes ? "loop" : "element", *hinge = j->closes ? "joint" : "hinge";
    if ((unsigned)j->kind > LD_HINGE_PLANAR)
        return ld_fail(error, LD_ERR_INPUT, "%s '%s': no such %s", sort, j->name, hinge);
    const hinge_kind *kind = &hinge_table[j->kind];
    v3 first = v3_from(j->axis), second = v3_from(j->axis_2);
    if ((kind->axes > 0 && !(v3_norm(first) > 0)) || (kind->axes > 1 && !(v3_norm(second) > 0)))
        return ld_fail(error, LD_ERR_INPUT, "%s '%s': its %s %s needs %s", sort, j->name,
                       kind->name, hinge, kind->axes > 1 ? "two axes" : "an axis");
    if (kind->axes > 1 &&
        !(v3_norm(v3_cross(first, second)) > 1e-6 * v3_norm(first) * v3_norm(second)))
        return ld_fail(error, LD_ERR_INPUT, "%s '%s': the two axes of its %s %s are parallel", sort,
                       j->name, kind->name, hinge);
    for (int k = 0; k < kind->speeds; k++)
        if (!(j->stiffness[k] >= 0) || !(j->damping[k] >= 0))
            return ld_fail(error, LD_ERR_INPUT,
                           "%s '%s': stiffness and damping of its %s must not be negative", sort,
                           j->name, hinge);
    return LD_OK;
}

static ld_status check_element(const ld_mstmm_element *e, int index, ld_error *error)
{
    if (!e->name || !e->name[0] || strlen(e->name) >= LD_MAX_NAME)
        return ld_fail(error, LD_ERR_INPUT, "element number %d needs a name of 1 to %d letters",
                       index + 1, LD_MAX_NAME - 1);
    bool known = description_all_finite(e->at, 3) && description_all_finite(e->attitude, 4) &&
                 description_all_finite(e->axis, 3) && description_all_finite(e->axis_2, 3) &&
                 description_all_finite(e->stiffness, 6) && description_all_finite(e->damping, 6) &&
                 description_all_finite(e->rest, 2) && description_all_finite(&e->mass, 1) &&
                 description_all_finite(e->center, 3) && description_all_finite(e->inertia, 6);
    if (!known)
        return ld_fail(error, LD_ERR_INPUT, "element '%s': a value is not finite", e->name);
    const described_joint hinge = {e->name,   false,        e->hinge,  e->axis,
                                   e->axis_2, e->stiffness, e->damping};
    ld_status status = description_check_joint(&hinge, error);
    if (status || e->beam)
        return status;
    if (e->mass < 0)
        return ld_fail(error, LD_ERR_INPUT, "element '%s': its mass is negative (%g kg)", e->name,
                       e->mass);
    if (!is_inertia(e->inertia))
        return ld_fail(error, LD_ERR_INPUT,
                       "element '%s': its inertia is impossible (each principal moment must be "
                       "positive or 0 and none above the sum of the other two)",
                       e->name);
    return LD_OK;
}

// ---- the tree of the description

typedef struct named {
    const char *name;
    int index;
} named;

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const named *)a)->name, ((const named *)b)->name);
}

static ld_status link_parents(tree *t, const ld_mstmm_element *elements, named *names,
                              ld_error *error)
{
    for (int i = 0; i < t->count; i++)
        names[i] = (named){elements[i].name, i};
    qsort(names, (size_t)t->count, sizeof *names, compare_names);
    for (int i = 1; i < t->count; i++)
        if (!compare_names(&names[i - 1], &names[i]))
            return ld_fail(
                error, LD_ERR_INPUT,
                "element '%s' is given twice: a body has one hinge that carries it, its other "
                "joints close loops",
                names[i].name);
    for (int i = 0; i <= t->count; i++)
        t->first[i] = -1;
    for (int i = t->count - 1; i >= 0; i--) {
        const named wanted = {elements[i].parent, 0};
        const named *found = NULL;
        if (elements[i].parent) {
            found = bsearch(&wanted, names, (size_t)t->count, sizeof *names, compare_names);
            if (!found)
                return ld_fail(error, LD_ERR_INPUT, "element '%s': its parent '%s' does not exist",
                               elements[i].name, elements[i].parent);
        }
        t->parent[i] = found ? found->index : -1;
        int at = found ? found->index : t->count;
        t->next[i] = t->first[at];
        t->first[at] = i;
    }
    return LD_OK;
}

// Depth-first order; elements that the ground does not reach stand in a circle.
static ld_status order_elements(tree *t, const ld_mstmm_element *elements, ld_error *error)
{
    int done = 0, at = t->first[t->count];
    while (at >= 0) {
        t->order[done++] = at;
        if (t->first[at] >= 0) {
            at = t->first[at];
        } else {
            while (at >= 0 && t->next[at] < 0)
                at = t->parent[at];
            if (at >= 0)
                at = t->next[at];
        }
    }
    if (done == t->count)
        return LD_OK;
    bool *seen = calloc((size_t)t->count, sizeof *seen);
    if (!seen)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    for (int i = 0; i < done; i++)
        seen[t->order[i]] = true;
    int lost = 0;
    while (seen[lost])
        lost++;
    for (; !seen[lost]; lost = t->parent[lost])
        seen[lost] = true;
    free(seen);
    return ld_fail(error, LD_ERR_INPUT,
                   "element '%s' is its own ancestor: a circle never reaches the ground; joints "
                   "that close loops are described separately",
                   elements[lost].name);
}

// Its motion is its parent's, or given.
static bool is_held(const ld_mstmm_element *e)
{
    return e->hinge == LD_HINGE_WELD || e->prescribed;
}

// A hinge that moves freely has to carry mass: its own body's, or what is fixed to that.
static bool carries_mass(const tree *t, const ld_mstmm_element *elements, int i)
{
    if (elements[i].beam || elements[i].mass > 0)
        return true;
    for (int k = t->first[i]; k >= 0; k = t->next[k])
        if (!is_held(&elements[k]) || carries_mass(t, elements, k))
            return true;
    return false;
}

static ld_status check_ends(const tree *t, const ld_mstmm_element *elements, ld_error *error)
{
    for (int i = 0; i < t->count; i++) {
        const ld_mstmm_element *e = &elements[i];
        if (!is_held(e) && !carries_mass(t, elements, i))
            return ld_fail(error, LD_ERR_INPUT, "element '%s': an end body without mass", e->name);
        if (t->parent[i] >= 0 && elements[t->parent[i]].beam &&
            !(e->at[0] >= 0 && e->at[0] <= elements[t->parent[i]].beam->length))
            return ld_fail(error, LD_ERR_INPUT,
                           "element '%s': its station %g m is not on the beam '%s' (0 to %g m)",
                           e->name, e->at[0], elements[t->parent[i]].name,
                           elements[t->parent[i]].beam->length);
    }
    return LD_OK;
}

void tree_free(tree *t)
{
    free(t->parent);
    free(t->first);
    free(t->next);
    free(t->order);
}

ld_status tree_make(tree *t, const ld_mstmm_element *elements, int count, ld_error *error)
{
    size_t n = (size_t)count;
    *t = (tree){count, calloc(n, sizeof(int)), calloc(n + 1, sizeof(int)), calloc(n, sizeof(int)),
                calloc(n, sizeof(int))};
    named *names = calloc(n, sizeof *names);
    ld_status status = LD_OK;
    if (!t->parent || !t->first || !t->next || !t->order || !names)
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    for (int i = 0; !status && i < count; i++)
        status = check_element(&elements[i], i, error);
    if (!status)
        status = link_parents(t, elements, names, error);
    if (!status)
        status = order_elements(t, elements, error);
    if (!status)
        status = check_ends(t, elements, error);
    free(names);
    if (status)
        tree_free(t);
    return status;
}
