// Building a system: the description checked and turned into nodes, parents before children.
#include "systems/multibody/multibody.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/vectors/quaternion.h"

// ---- hinges

static const struct {
    const char *name;
    int coordinates, speeds, axes; // axes that the description must give
} hinge_table[] = {
    [LD_HINGE_WELD] = {"weld", 0, 0, 0},
    [LD_HINGE_REVOLUTE] = {"revolute", 1, 1, 1},
    [LD_HINGE_PRISMATIC] = {"prismatic", 1, 1, 1},
    [LD_HINGE_CYLINDRICAL] = {"cylindrical", 2, 2, 1},
    [LD_HINGE_UNIVERSAL] = {"universal", 2, 2, 2},
    [LD_HINGE_SPHERICAL] = {"spherical", 4, 3, 0},
    [LD_HINGE_FREE] = {"free", 7, 6, 0},
};

// ---- checks of one element

static bool all_finite(const double *x, int n)
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

static ld_status check_hinge(const ld_mstmm_element *e, ld_error *error)
{
    if ((unsigned)e->hinge > LD_HINGE_FREE)
        return ld_fail(error, LD_ERR_INPUT, "element '%s': no such hinge", e->name);
    int axes = hinge_table[e->hinge].axes, speeds = hinge_table[e->hinge].speeds;
    v3 first = v3_from(e->axis), second = v3_from(e->axis_2);
    if ((axes > 0 && !(v3_norm(first) > 0)) || (axes > 1 && !(v3_norm(second) > 0)))
        return ld_fail(error, LD_ERR_INPUT, "element '%s': its %s hinge needs %s", e->name,
                       hinge_table[e->hinge].name, axes > 1 ? "two axes" : "an axis");
    if (axes > 1 && !(v3_norm(v3_cross(first, second)) > 1e-6 * v3_norm(first) * v3_norm(second)))
        return ld_fail(error, LD_ERR_INPUT,
                       "element '%s': the two axes of its universal hinge are parallel", e->name);
    for (int k = 0; k < speeds; k++)
        if (!(e->stiffness[k] >= 0) || !(e->damping[k] >= 0))
            return ld_fail(error, LD_ERR_INPUT,
                           "element '%s': stiffness and damping of its hinge must not be negative",
                           e->name);
    return LD_OK;
}

static ld_status check_element(const ld_mstmm_element *e, int index, ld_error *error)
{
    if (!e->name || !e->name[0] || strlen(e->name) >= LD_MAX_NAME)
        return ld_fail(error, LD_ERR_INPUT, "element number %d needs a name of 1 to %d letters",
                       index + 1, LD_MAX_NAME - 1);
    bool known = all_finite(e->at, 3) && all_finite(e->attitude, 4) && all_finite(e->axis, 3) &&
                 all_finite(e->axis_2, 3) && all_finite(e->stiffness, 6) &&
                 all_finite(e->damping, 6) && all_finite(e->rest, 2) && all_finite(&e->mass, 1) &&
                 all_finite(e->center, 3) && all_finite(e->inertia, 6);
    if (!known)
        return ld_fail(error, LD_ERR_INPUT, "element '%s': a value is not finite", e->name);
    ld_status status = check_hinge(e, error);
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

typedef struct tree {
    int count;
    int *parent;       // element index, -1: the ground
    int *first, *next; // children in the order given; first[count]: of the ground
    int *order;        // parents before children, depth first
} tree;

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
                "element '%s' is given twice: a body has one inboard hinge, closed loops "
                "are not supported",
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
                   "element '%s' is its own ancestor: a circle never reaches the ground (closed "
                   "loops are not supported)",
                   elements[lost].name);
}

static ld_status check_ends(const tree *t, const ld_mstmm_element *elements, ld_error *error)
{
    for (int i = 0; i < t->count; i++) {
        const ld_mstmm_element *e = &elements[i];
        if (t->first[i] < 0 && !e->beam && !(e->mass > 0))
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

static void free_tree(tree *t)
{
    free(t->parent);
    free(t->first);
    free(t->next);
    free(t->order);
}

static ld_status make_tree(tree *t, const ld_mstmm_element *elements, int count, ld_error *error)
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
        free_tree(t);
    return status;
}

// ---- memory

// One array of the system; notes a failure.
static void *array(size_t count, size_t size, bool *missing)
{
    size_t bytes = (count + 1) * size;
    void *block = aligned_alloc(64, (bytes + 63) / 64 * 64);
    if (block)
        memset(block, 0, (bytes + 63) / 64 * 64);
    else
        *missing = true;
    return block;
}

static bool allocate(ld_mstmm *s)
{
    bool missing = false;
    size_t n = (size_t)s->node_count + 1, u = (size_t)s->u_count, k = (size_t)s->branch_count;
    s->node = array(n, sizeof *s->node, &missing);
    s->inertia = array(n, sizeof *s->inertia, &missing);
    s->beam_of = array(n, sizeof *s->beam_of, &missing);
    s->angle_q = array(n + 4, sizeof *s->angle_q, &missing);
    s->angle = array(n + 4, sizeof *s->angle, &missing);
    s->sine = array(n + 4, sizeof *s->sine, &missing);
    s->cosine = array(n + 4, sizeof *s->cosine, &missing);
    s->motion = array(n, sizeof *s->motion, &missing);
    s->axis = array(u, sizeof *s->axis, &missing);
    s->passing = array(0, sizeof *s->passing, &missing);
    s->own = array(MULTIBODY_BLOCK, sizeof *s->own, &missing);
    s->branch = array(k, sizeof *s->branch, &missing);
    s->branch_x = array(k, sizeof *s->branch_x, &missing);
    s->tau = array(u, sizeof *s->tau, &missing);
    s->wrench = array(n, sizeof *s->wrench, &missing);
    s->place = array(n, sizeof *s->place, &missing);
    return !missing;
}

void ld_mstmm_free(ld_mstmm *s)
{
    if (!s)
        return;
    for (int i = 0; i < s->beam_count; i++)
        beam_free(&s->beams[i]);
    void *blocks[] = {s->name,     s->element,  s->element_node, s->element_q, s->element_u,
                      s->q_length, s->u_length, s->body_axes,    s->node,      s->inertia,
                      s->beam_of,  s->beams,    s->element_beam, s->angle_q,   s->angle,
                      s->sine,     s->cosine,   s->motion,       s->axis,      s->branch,
                      s->branch_x, s->passing,  s->own,          s->tau,       s->wrench,
                      s->place};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        free(blocks[i]);
    free(s);
}

// ---- nodes

// A rotation that takes e_z to the direction `axis`; its columns are the internal axes.
static m3 axes_along(v3 axis)
{
    v3 z = v3_scale(1 / v3_norm(axis), axis);
    v3 other = fabs(z.x) < 0.6 ? v3_make(1, 0, 0) : v3_make(0, 1, 0);
    if (z.z == 1)
        return m3_identity();
    v3 x = v3_cross(other, z);
    x = v3_scale(1 / v3_norm(x), x);
    return m3_columns(x, v3_cross(z, x), z);
}

// State of the builder: the next node and the offsets given out so far.
typedef struct builder {
    ld_mstmm *system;
    const tree *tree;
    int node, axis, angle;
} builder;

static int add_node(builder *b, int parent, node_hinge hinge, int speeds)
{
    int i = ++b->node;
    b->system->node[i] = (node){.parent = parent,
                                .hinge = hinge,
                                .body = NODE_RIGID,
                                .axis = b->axis,
                                .element = -1,
                                .branch = -1,
                                .G = m3_identity()};
    b->axis += speeds;
    return i;
}

static void add_turn(builder *b, node *n)
{
    n->angle = b->angle;
    b->system->angle_q[b->angle++] = n->q;
}

// A section node at element e's station of its parent beam.
static int add_section(builder *b, int e, bool *missing)
{
    ld_mstmm *s = b->system;
    int carrier = s->element_node[b->tree->parent[e]];
    int i = add_node(b, carrier, NODE_WELD, 0);
    s->node[i].body = NODE_SECTION;
    s->node[i].G = m3_transpose(s->body_axes[b->tree->parent[e]]);
    s->beam_of[i].body = s->beam_of[carrier].body;
    s->beam_of[i].output = beam_add_output(s->beam_of[carrier].body, s->element[e].at[0]);
    *missing |= s->beam_of[i].output < 0;
    return i;
}

// The nodes of element e's hinge; the last one carries its body. Returns that one.
static int add_hinge(builder *b, int e, int parent, v3 at, m3 G)
{
    ld_mstmm *s = b->system;
    const ld_mstmm_element *given = &s->element[e];
    int q = s->element_q[e], u = s->element_u[e], i = 0;
    m3 Q = m3_identity(), first = m3_identity();
    switch (given->hinge) {
    case LD_HINGE_REVOLUTE:
    case LD_HINGE_PRISMATIC:
        Q = axes_along(v3_from(given->axis));
        i = add_node(b, parent, given->hinge == LD_HINGE_REVOLUTE ? NODE_TURN : NODE_SLIDE, 1);
        s->node[i].G = m3_mul(G, Q);
        break;
    case LD_HINGE_CYLINDRICAL:
        Q = axes_along(v3_from(given->axis));
        i = add_node(b, parent, NODE_SLIDE, 1);
        s->node[i].G = m3_mul(G, Q);
        break;
    case LD_HINGE_UNIVERSAL:
        first = axes_along(v3_from(given->axis));
        Q = axes_along(v3_from(given->axis_2));
        i = add_node(b, parent, NODE_TURN, 1);
        s->node[i].G = m3_mul(G, first);
        break;
    case LD_HINGE_WELD:
    case LD_HINGE_SPHERICAL:
    case LD_HINGE_FREE:
        i = add_node(b, parent,
                     given->hinge == LD_HINGE_WELD        ? NODE_WELD
                     : given->hinge == LD_HINGE_SPHERICAL ? NODE_BALL
                                                          : NODE_FREE,
                     hinge_table[given->hinge].speeds);
        s->node[i].G = G;
        break;
    }
    s->node[i].at = at;
    s->node[i].q = q;
    s->node[i].u = u;
    if (s->node[i].hinge == NODE_TURN)
        add_turn(b, &s->node[i]);
    // the second axis of a hinge with two
    if (given->hinge == LD_HINGE_CYLINDRICAL || given->hinge == LD_HINGE_UNIVERSAL) {
        i = add_node(b, i, NODE_TURN, 1);
        s->node[i].G =
            given->hinge == LD_HINGE_UNIVERSAL ? m3_mul(m3_transpose(first), Q) : m3_identity();
        s->node[i].q = q + 1;
        s->node[i].u = u + 1;
        add_turn(b, &s->node[i]);
    }
    s->body_axes[e] = Q;
    return i;
}

static void set_inertia(ld_mstmm *s, int i, int e)
{
    const ld_mstmm_element *given = &s->element[e];
    m3 back = m3_transpose(s->body_axes[e]);
    v3 c = v3_from(given->center), mc = v3_scale(given->mass, c);
    const double *J = given->inertia;
    sym3 about_origin = {
        J[0] + c.y * mc.y + c.z * mc.z, J[3] - c.x * mc.y, J[4] - c.x * mc.z,
        J[1] + c.x * mc.x + c.z * mc.z, J[5] - c.y * mc.z, J[2] + c.x * mc.x + c.y * mc.y};
    s->inertia[i] = (node_inertia){given->mass, m3_apply(back, mc), sym3_turn(back, about_origin)};
}

static ld_status add_element(builder *b, int e, ld_error *error)
{
    ld_mstmm *s = b->system;
    const ld_mstmm_element *given = &s->element[e];
    int carrier = b->tree->parent[e], parent = 0;
    bool missing = false;

    // where the hinge sits on the parent, in the parent's internal axes
    v3 at = v3_from(given->at);
    m3 G = m3_identity();
    if (carrier >= 0 && s->element[carrier].beam) {
        parent = add_section(b, e, &missing);
        at.x = 0;
    } else if (carrier >= 0) {
        parent = s->element_node[carrier];
        G = m3_transpose(s->body_axes[carrier]);
        at = m3_apply(G, at);
    }
    quat attitude = q_from(given->attitude);
    if (attitude.w != 0 || attitude.x != 0 || attitude.y != 0 || attitude.z != 0)
        G = m3_mul(G, q_matrix(attitude));

    int i = add_hinge(b, e, parent, at, G);
    s->node[i].element = e;
    s->element_node[e] = i;
    if (given->beam) {
        beam *body = &s->beams[s->element_beam[e]];
        int behind = hinge_table[given->hinge].coordinates;
        s->node[i].body = NODE_BEAM;
        s->beam_of[i] = (node_beam){body, -1, s->element_q[e] + behind,
                                    s->element_u[e] + hinge_table[given->hinge].speeds};
    } else {
        set_inertia(s, i, e);
    }
    return missing ? ld_fail(error, LD_ERR_MEMORY, "no memory for a beam") : LD_OK;
}

// Which nodes hand their share to the node before, and where others are summed.
static void link_shares(ld_mstmm *s)
{
    s->branch_count = 0;
    s->node[0].branch = -1;
    for (int i = 1; i <= s->node_count; i++) {
        node *n = &s->node[i], *parent = &s->node[n->parent];
        bool section = n->body == NODE_SECTION;
        n->leads = n->parent == i - 1 && i > 1 && !section;
        if (!n->leads && !section && n->parent > 0 && parent->branch < 0)
            parent->branch = s->branch_count++;
    }
}

// ---- create

static void choose_sweep(ld_mstmm *s)
{
    s->sweep = &sweep_default;
#ifdef LD_HAVE_AVX
    // valgrind does not know all of AVX: LAUNCHDYN_PLAIN=1 does without
    if (__builtin_cpu_supports("avx") && !getenv("LAUNCHDYN_PLAIN"))
        s->sweep = &sweep_avx;
#endif
}

static ld_status copy_elements(ld_mstmm *s, const tree *t, const ld_mstmm_element *elements,
                               ld_error *error)
{
    bool missing = false;
    size_t n = (size_t)s->element_count;
    s->name = array(n, sizeof *s->name, &missing);
    s->element = array(n, sizeof *s->element, &missing);
    s->element_node = array(n, sizeof *s->element_node, &missing);
    s->element_q = array(n, sizeof *s->element_q, &missing);
    s->element_u = array(n, sizeof *s->element_u, &missing);
    s->q_length = array(n, sizeof *s->q_length, &missing);
    s->u_length = array(n, sizeof *s->u_length, &missing);
    s->body_axes = array(n, sizeof *s->body_axes, &missing);
    s->element_beam = array(n, sizeof *s->element_beam, &missing);
    s->beams = array(n, sizeof *s->beams, &missing);
    if (missing)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");

    for (int e = 0; e < s->element_count; e++) {
        const ld_mstmm_element *given = &elements[e];
        s->element[e] = *given;
        s->element[e].name = s->element[e].parent = NULL;
        memcpy(s->name[e], given->name, strlen(given->name) + 1);
        s->element_q[e] = s->q_count;
        s->element_u[e] = s->u_count;
        s->q_length[e] = hinge_table[given->hinge].coordinates;
        s->u_length[e] = hinge_table[given->hinge].speeds;
        s->q_count += s->q_length[e];
        s->u_count += s->u_length[e];
        if (given->beam) {
            s->element_beam[e] = s->beam_count;
            beam *body = &s->beams[s->beam_count++];
            ld_status status = beam_create(body, given->beam, given->name, error);
            if (status)
                return status;
            s->q_count += body->modes;
            s->u_count += body->modes;
        }
        for (int k = 0; k < s->u_length[e]; k++)
            s->has_springs |= given->stiffness[k] > 0 || given->damping[k] > 0;
        bool two_nodes = given->hinge == LD_HINGE_CYLINDRICAL || given->hinge == LD_HINGE_UNIVERSAL;
        bool on_beam = t->parent[e] >= 0 && elements[t->parent[e]].beam;
        s->node_count += 1 + two_nodes + on_beam;
    }
    return LD_OK;
}

ld_status ld_mstmm_create(const ld_mstmm_element *elements, int count, const double gravity[3],
                          ld_mstmm **out, ld_error *error)
{
    tree t;
    if (count < 1 || !all_finite(gravity, 3))
        return ld_fail(error, LD_ERR_INPUT, "a system needs at least one element and gravity");
    ld_status status = make_tree(&t, elements, count, error);
    if (status)
        return status;
    ld_mstmm *s = calloc(1, sizeof *s);
    if (!s) {
        free_tree(&t);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    }
    s->element_count = count;
    s->gravity = v3_from(gravity);
    s->base = (spatial){v3_neg(s->gravity), v3_zero()};
    s->branch_count = count;
    status = copy_elements(s, &t, elements, error);
    if (!status && !allocate(s))
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    if (!status) {
        v4d_store_m3(s->motion[0].A, m3_identity());
        choose_sweep(s);
        builder b = {.system = s, .tree = &t};
        for (int k = 0; !status && k < count; k++)
            status = add_element(&b, t.order[k], error);
        s->axis_count = b.axis;
        s->angle_count = b.angle;
        link_shares(s);
    }
    free_tree(&t);
    if (status)
        ld_mstmm_free(s);
    else
        *out = s;
    return status;
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
