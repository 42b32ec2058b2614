// Building a system: the description turned into nodes, parents before children.
#include "systems/multibody/multibody.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/vectors/quaternion.h"
#include "systems/multibody/description.h"
#include "systems/multibody/loop_description.h"

// ---- memory

// One array of the system; records a failure.
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

static bool allocate_constant(ld_mstmm *s)
{
    bool missing = false;
    size_t n = (size_t)s->node_count + 1;
    s->node = array(n, sizeof *s->node, &missing);
    s->inertia = array(n, sizeof *s->inertia, &missing);
    s->angle_q = array(n + 4, sizeof *s->angle_q, &missing);
    return !missing;
}

static bool allocate_workspace(ld_mstmm *s)
{
    bool missing = false;
    size_t n = (size_t)s->node_count + 1, u = (size_t)s->u_count, k = (size_t)s->branch_count;
    s->beam_of = array(n, sizeof *s->beam_of, &missing);
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
    s->pass = array(n, sizeof *s->pass, &missing);
    s->known = array((size_t)s->q_count + u, sizeof *s->known, &missing);
    s->prescribed = array((size_t)s->element_count, sizeof *s->prescribed, &missing);
    if (!missing)
        v4d_store_m3(s->motion[0].A, m3_identity());
    return !missing;
}

static void free_blocks(void *const *block, size_t count)
{
    for (size_t i = 0; i < count; i++)
        free(block[i]);
}

#define FREE_ALL(...)                                                                              \
    free_blocks((void *const[]){__VA_ARGS__}, sizeof((void *const[]){__VA_ARGS__}) / sizeof(void *))

void ld_mstmm_free(ld_mstmm *s)
{
    if (!s)
        return;
    const bool last = !s->sharing || atomic_fetch_sub(&s->sharing->systems, 1) == 1;
    for (int i = 0; s->beams && i < s->beam_count; i++)
        beam_free(&s->beams[i], last);
    FREE_ALL(s->beam_of, s->beams, s->angle, s->sine, s->cosine, s->motion, s->axis, s->branch,
             s->branch_x, s->passing, s->own, s->tau, s->wrench, s->place, s->pass, s->prescribed,
             s->known);
    loops_free_workspace(s);
    if (last)
        loops_free(s);
    if (last)
        FREE_ALL(s->name, s->element, s->element_node, s->element_q, s->element_u, s->q_length,
                 s->u_length, s->body_axes, s->node, s->inertia, s->element_beam, s->angle_q,
                 s->sharing);
    free(s);
}

// The workspace of a copy: beams with their outputs.
static bool copy_workspace(ld_mstmm *s, const ld_mstmm *from)
{
    bool missing = false;
    s->beams = array((size_t)s->beam_count, sizeof *s->beams, &missing);
    if (missing || !allocate_workspace(s) || !loops_allocate(s))
        return false;
    for (int i = 0; i < s->beam_count; i++)
        if (!beam_copy(&s->beams[i], &from->beams[i]))
            return false;
    memcpy(s->beam_of, from->beam_of, ((size_t)s->node_count + 1) * sizeof *s->beam_of);
    memcpy(s->pass, from->pass, ((size_t)s->node_count + 1) * sizeof *s->pass);
    memcpy(s->prescribed, from->prescribed, (size_t)s->element_count * sizeof *s->prescribed);
    loops_copy(s, from);
    for (int i = 0; i <= s->node_count; i++)
        if (s->beam_of[i].body)
            s->beam_of[i].body = s->beams + (s->beam_of[i].body - from->beams);
    return true;
}

ld_status ld_mstmm_copy(const ld_mstmm *system, ld_mstmm **out, ld_error *error)
{
    ld_mstmm *s = malloc(sizeof *s);
    if (!s)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    *s = *system;
    atomic_fetch_add(&s->sharing->systems, 1);
    s->beam_of = NULL;
    s->beams = NULL;
    s->angle = s->sine = s->cosine = s->tau = NULL;
    s->motion = NULL;
    s->axis = NULL;
    s->own = s->passing = s->branch = NULL;
    s->branch_x = NULL;
    s->wrench = s->place = NULL;
    s->pass = NULL;
    s->prescribed = NULL;
    s->known = NULL;
    s->known_at = 0;
    s->loop_work = NULL;
    s->dense = (dense_rows){0};
    s->loop_numbers = s->applied = s->zero = s->response = s->trial = NULL;
    if (!copy_workspace(s, system)) {
        ld_mstmm_free(s);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    }
    *out = s;
    return LD_OK;
}

// ---- nodes

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
                                .load = -1,
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

// A section node at a station of the beam that is element e.
static int add_section(builder *b, int e, double station, bool *missing)
{
    ld_mstmm *s = b->system;
    int carrier = s->element_node[e];
    int i = add_node(b, carrier, NODE_WELD, 0);
    s->node[i].body = NODE_SECTION;
    s->node[i].G = m3_transpose(s->body_axes[e]);
    s->beam_of[i].body = s->beam_of[carrier].body;
    s->beam_of[i].output = beam_add_output(s->beam_of[carrier].body, station);
    *missing |= s->beam_of[i].output < 0;
    return i;
}

// Sections for the loops' ends on beams, in their order; each may be loaded.
static ld_status add_loop_sections(builder *b, const ld_mstmm_description *d, ld_error *error)
{
    bool missing = false;
    for (int i = 0; i < 2 * d->loop_count; i++) {
        const ld_mstmm_end *end = i % 2 ? &d->loops[i / 2].second : &d->loops[i / 2].first;
        int e = end->element ? ld_mstmm_find(b->system, end->element) : -1;
        if (e < 0 || !b->system->element[e].beam)
            continue;
        int section = add_section(b, e, end->at[0], &missing);
        b->system->node[section].load = b->system->load_count++;
    }
    return missing ? ld_fail(error, LD_ERR_MEMORY, "no memory for a beam") : LD_OK;
}

// Axes of a hinge that consists of single ones, in their order.
static int single_axes(const ld_mstmm_element *given, node_hinge kind[3], v3 along[3])
{
    static const node_hinge planar[3] = {NODE_SLIDE, NODE_SLIDE, NODE_TURN};
    along[0] = along[1] = v3_from(given->axis);
    kind[0] = kind[1] = NODE_TURN;
    switch (given->hinge) {
    case LD_HINGE_REVOLUTE:
        return 1;
    case LD_HINGE_PRISMATIC:
        kind[0] = NODE_SLIDE;
        return 1;
    case LD_HINGE_CYLINDRICAL:
        kind[0] = NODE_SLIDE;
        return 2;
    case LD_HINGE_UNIVERSAL:
        along[1] = v3_from(given->axis_2);
        return 2;
    case LD_HINGE_PLANAR:
        memcpy(kind, planar, sizeof planar);
        for (int k = 0; k < 3; k++)
            along[k] = m3_column(description_plane_axes(given->axis, given->axis_2), k);
        return 3;
    default:
        return 0;
    }
}

// The nodes of element e's hinge; the last one carries its body. Returns that one.
static int add_hinge(builder *b, int e, int parent, v3 at, m3 G)
{
    ld_mstmm *s = b->system;
    const ld_mstmm_element *given = &s->element[e];
    node_hinge kind[3];
    v3 along[3];
    m3 Q = m3_identity();
    int i = 0, axes = single_axes(given, kind, along);
    for (int k = 0; k < axes; k++) {
        // the node before has its axis along its z axis; a second axis may be the same one
        m3 before = Q;
        bool same = k > 0 && v3_norm(v3_cross(along[k - 1], along[k])) == 0;
        Q = description_axes_along(along[k]);
        i = add_node(b, k == 0 ? parent : i, kind[k], 1);
        s->node[i].G = k == 0 ? m3_mul(G, Q)
                       : same ? m3_identity()
                              : m3_mul(m3_transpose(before), Q);
        s->node[i].at = k == 0 ? at : v3_zero();
        s->node[i].q = s->element_q[e] + k;
        s->node[i].u = s->element_u[e] + k;
        s->pass[i] = multibody_pass(&s->node[i], given->prescribed);
        if (kind[k] == NODE_TURN)
            add_turn(b, &s->node[i]);
    }
    s->body_axes[e] = Q;
    if (axes > 0)
        return i;
    node_hinge hinge = given->hinge == LD_HINGE_WELD        ? NODE_WELD
                       : given->hinge == LD_HINGE_SPHERICAL ? NODE_BALL
                                                            : NODE_FREE;
    i = add_node(b, parent, hinge, hinge_table[given->hinge].speeds);
    s->node[i].G = G;
    s->node[i].at = at;
    s->node[i].q = s->element_q[e];
    s->node[i].u = s->element_u[e];
    s->pass[i] = multibody_pass(&s->node[i], given->prescribed);
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
        parent = add_section(b, carrier, given->at[0], &missing);
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
    s->node[i].element = s->node[i].load = e;
    s->prescribed[e] = given->prescribed != 0;
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
    s->node[0].load = -1;
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
    s->sharing = array(0, sizeof *s->sharing, &missing);
    if (s->sharing)
        atomic_init(&s->sharing->systems, 1);
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
        node_hinge kind[3];
        v3 along[3];
        int axes = single_axes(given, kind, along);
        bool on_beam = t->parent[e] >= 0 && elements[t->parent[e]].beam;
        s->node_count += (axes > 0 ? axes : 1) + on_beam;
    }
    return LD_OK;
}

static ld_status build_nodes(ld_mstmm *s, const tree *t, const ld_mstmm_description *d,
                             ld_error *error)
{
    builder b = {.system = s, .tree = t};
    ld_status status = LD_OK;
    for (int k = 0; !status && k < d->element_count; k++)
        status = add_element(&b, t->order[k], error);
    s->axis_count = b.axis;
    s->angle_count = b.angle;
    s->load_count = s->element_count;
    const int first_section = b.node + 1;
    if (!status)
        status = add_loop_sections(&b, d, error);
    link_shares(s);
    return status ? status : loops_build(s, d, first_section, error);
}

ld_status ld_mstmm_build(const ld_mstmm_description *d, ld_mstmm **out, ld_error *error)
{
    tree t;
    if (d->element_count < 1 || !description_all_finite(d->gravity, 3))
        return ld_fail(error, LD_ERR_INPUT, "a system needs at least one element and gravity");
    ld_status status = tree_make(&t, d->elements, d->element_count, error);
    if (status)
        return status;
    ld_mstmm *s = NULL;
    status = loops_check(d, error);
    if (!status)
        s = calloc(1, sizeof *s);
    if (!status && !s)
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    if (!status) {
        s->element_count = d->element_count;
        s->gravity = v3_from(d->gravity);
        s->base = (spatial){v3_neg(s->gravity), v3_zero()};
        s->branch_count = d->element_count;
        s->moves = 1;
        s->singularity = 1;
        s->singular_loop = -1;
        choose_sweep(s);
        status = copy_elements(s, &t, d->elements, error);
    }
    if (!status) {
        s->node_count += loops_sections(d);
        if (!allocate_constant(s) || !allocate_workspace(s))
            status = ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    }
    if (!status)
        status = build_nodes(s, &t, d, error);
    if (!status && !loops_allocate(s))
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    tree_free(&t);
    if (status)
        ld_mstmm_free(s);
    else
        *out = s;
    return status;
}

ld_status ld_mstmm_create(const ld_mstmm_element *elements, int count, const double gravity[3],
                          ld_mstmm **out, ld_error *error)
{
    ld_mstmm_description d = {.elements = elements, .element_count = count};
    memcpy(d.gravity, gravity, sizeof d.gravity);
    return ld_mstmm_build(&d, out, error);
}
