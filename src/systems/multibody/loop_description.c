#include "systems/multibody/loop_description.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "systems/multibody/description.h"

// ---- checks

static int find_element(const ld_mstmm_description *d, const char *name)
{
    for (int e = 0; name && e < d->element_count; e++)
        if (!strcmp(d->elements[e].name, name))
            return e;
    return -1;
}

static const ld_mstmm_element *carrying_beam(const ld_mstmm_description *d, const ld_mstmm_end *end)
{
    int e = find_element(d, end->element);
    return e >= 0 && d->elements[e].beam ? &d->elements[e] : NULL;
}

static ld_status check_end(const ld_mstmm_description *d, const ld_mstmm_loop *l,
                           const ld_mstmm_end *end, ld_error *error)
{
    if (end->element && find_element(d, end->element) < 0)
        return ld_fail(error, LD_ERR_INPUT, "loop '%s': its element '%s' does not exist", l->name,
                       end->element);
    const ld_mstmm_element *on = carrying_beam(d, end);
    if (on && !(end->at[0] >= 0 && end->at[0] <= on->beam->length))
        return ld_fail(error, LD_ERR_INPUT,
                       "loop '%s': its station %g m is not on the beam '%s' (0 to %g m)", l->name,
                       end->at[0], on->name, on->beam->length);
    return LD_OK;
}

static ld_status check_loop(const ld_mstmm_description *d, int index, ld_error *error)
{
    const ld_mstmm_loop *l = &d->loops[index];
    if (!l->name || !l->name[0] || strlen(l->name) >= LD_MAX_NAME)
        return ld_fail(error, LD_ERR_INPUT, "loop number %d needs a name of 1 to %d letters",
                       index + 1, LD_MAX_NAME - 1);
    for (int k = 0; k < index; k++)
        if (!strcmp(d->loops[k].name, l->name))
            return ld_fail(error, LD_ERR_INPUT, "loop '%s' is given twice", l->name);
    const double *numbers[] = {l->first.at,        l->second.at, l->first.attitude,
                               l->second.attitude, l->axis,      l->axis_2,
                               l->stiffness,       l->damping,   l->rest};
    const int lengths[] = {3, 3, 4, 4, 3, 3, 6, 6, 2};
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++)
        if (!description_all_finite(numbers[k], lengths[k]))
            return ld_fail(error, LD_ERR_INPUT, "loop '%s': a value is not finite", l->name);
    const described_joint joint = {l->name,   true,         l->joint,  l->axis,
                                   l->axis_2, l->stiffness, l->damping};
    ld_status status = description_check_joint(&joint, error);
    if (status)
        return status;
    if (l->joint == LD_HINGE_FREE)
        return ld_fail(error, LD_ERR_INPUT, "loop '%s': a free joint constrains nothing", l->name);
    status = check_end(d, l, &l->first, error);
    if (!status)
        status = check_end(d, l, &l->second, error);
    const char *first = l->first.element, *second = l->second.element;
    bool same = first && second ? !strcmp(first, second) : first == second;
    if (!status && same && !carrying_beam(d, &l->first))
        return ld_fail(error, LD_ERR_INPUT, "loop '%s' joins %s%s%s with itself", l->name,
                       first ? "'" : "", first ? first : "the ground", first ? "'" : "");
    return status;
}

ld_status loops_check(const ld_mstmm_description *d, ld_error *error)
{
    ld_status status = LD_OK;
    for (int i = 0; !status && i < d->loop_count; i++)
        status = check_loop(d, i, error);
    return status;
}

int loops_sections(const ld_mstmm_description *d)
{
    int count = 0;
    for (int i = 0; i < d->loop_count; i++)
        count += (carrying_beam(d, &d->loops[i].first) != NULL) +
                 (carrying_beam(d, &d->loops[i].second) != NULL);
    return count;
}

// ---- rows

static void add_row(loop *l, bool turns, int first, int second, double cosine)
{
    l->row[l->row_count++] = (loop_row){turns, first, second, cosine};
}

enum { AXIS_X, AXIS_Y, AXIS_Z };

static void make_rows(loop *l)
{
    static const bool held[][6] = {
        // distances along x, y, z; products x z, y z of the frames; all three turns
        [LD_HINGE_WELD] = {1, 1, 1, 0, 0, 1},
        [LD_HINGE_REVOLUTE] = {1, 1, 1, 1, 1, 0},
        [LD_HINGE_PRISMATIC] = {1, 1, 0, 0, 0, 1},
        [LD_HINGE_CYLINDRICAL] = {1, 1, 0, 1, 1, 0},
        [LD_HINGE_UNIVERSAL] = {1, 1, 1, 0, 0, 0},
        [LD_HINGE_SPHERICAL] = {1, 1, 1, 0, 0, 0},
        [LD_HINGE_FREE] = {0},
        [LD_HINGE_PLANAR] = {0, 0, 1, 1, 1, 0},
    };
    const bool *holds = held[l->given.joint];
    for (int k = 0; k < 3; k++)
        if (holds[k])
            add_row(l, false, k, 0, 0);
    if (holds[3])
        add_row(l, true, AXIS_X, AXIS_Z, 0);
    if (holds[4])
        add_row(l, true, AXIS_Y, AXIS_Z, 0);
    if (holds[5]) {
        add_row(l, true, AXIS_X, AXIS_Y, 0);
        add_row(l, true, AXIS_Y, AXIS_Z, 0);
        add_row(l, true, AXIS_Z, AXIS_X, 0);
    }
    if (l->given.joint == LD_HINGE_UNIVERSAL) {
        v3 a = m3_column(l->axes[0], AXIS_Z), b = m3_column(l->axes[1], AXIS_Z);
        l->psi = atan2(v3_norm(v3_cross(a, b)), v3_dot(a, b));
        add_row(l, true, AXIS_Z, AXIS_Z, v3_dot(a, b));
    }
}

// ---- ends

static void make_end(ld_mstmm *s, const ld_mstmm_description *d, loop *l, int side, int *section)
{
    const ld_mstmm_end *given = side ? &d->loops[l - s->loop].second : &d->loops[l - s->loop].first;
    loop_end *end = &l->end[side];
    const int e = find_element(d, given->element);
    const quat attitude = q_from(given->attitude);
    m3 back = m3_identity(), turned = m3_identity();
    v3 at = v3_from(given->at);
    end->element = e;
    if (e >= 0 && s->element[e].beam) {
        end->node = (*section)++;
        at.x = 0;
    } else if (e >= 0) {
        end->node = s->element_node[e];
        back = m3_transpose(s->body_axes[e]);
    }
    if (attitude.w != 0 || attitude.x != 0 || attitude.y != 0 || attitude.z != 0)
        turned = q_matrix(attitude);
    end->at = m3_apply(back, at);
    end->frame = m3_mul(back, m3_mul(turned, l->axes[side]));
}

// ---- paths

// From both nodes towards the ground: the nodes of each side alone, then those of both.
static bool make_path(const ld_mstmm *s, loop *l)
{
    int here[2] = {l->end[0].node, l->end[1].node}, *path[2];
    path[0] = malloc(((size_t)s->node_count + 1) * sizeof *path[0]);
    path[1] = malloc(((size_t)s->node_count + 1) * sizeof *path[1]);
    bool whole = path[0] && path[1];
    while (whole && here[0] != here[1]) {
        int side = here[0] > here[1] ? 0 : 1;
        path[side][l->part[side]++] = here[side];
        here[side] = s->node[here[side]].parent;
    }
    for (int i = here[0]; i > 0; i = s->node[i].parent)
        l->part[2]++;
    const size_t count = (size_t)(l->part[0] + l->part[1] + l->part[2]) + 1;
    l->path = calloc(count, sizeof *l->path);
    l->path_slot = calloc(count, sizeof *l->path_slot);
    whole &= l->path && l->path_slot;
    if (whole) {
        int at = 0;
        for (int side = 0; side < 2; side++)
            for (int k = 0; k < l->part[side]; k++)
                l->path[at++] = path[side][k];
        for (int i = here[0]; i > 0; i = s->node[i].parent)
            l->path[at++] = i;
        l->meets_in_beam = here[0] > 0 && s->node[here[0]].body == NODE_BEAM;
    }
    free(path[0]);
    free(path[1]);
    return whole;
}

// Speeds along the path, a beam's modes before those of its hinge.
static bool make_slots(const ld_mstmm *s, loop *l)
{
    const int nodes = l->part[0] + l->part[1] + l->part[2];
    l->slot = calloc((size_t)s->u_count + 1, sizeof *l->slot);
    if (!l->slot)
        return false;
    for (int p = 0; p < nodes; p++) {
        const int i = l->path[p];
        const node *n = &s->node[i];
        l->path_slot[p] = l->slot_count;
        if (n->body == NODE_SECTION)
            continue;
        for (int k = 0; n->body == NODE_BEAM && k < s->beam_of[i].body->modes; k++)
            l->slot[l->slot_count++] = s->beam_of[i].modes_u + k;
        for (int k = 0; k < node_speeds(n); k++)
            l->slot[l->slot_count++] = n->u + k;
    }
    return true;
}

// The runs of slots that l and another loop share; returns their number. `at`: -1 for each speed.
static int find_runs(const loop *l, const loop *other, int *at, loop_run *run)
{
    int count = 0;
    for (int k = 0; k < other->slot_count; k++)
        at[other->slot[k]] = k;
    for (int k = 0; k < l->slot_count; k++) {
        int there = at[l->slot[k]];
        if (there < 0)
            continue;
        loop_run *last = count > 0 ? &run[count - 1] : NULL;
        if (last && last->here + last->length == k && last->there + last->length == there)
            last->length++;
        else
            run[count++] = (loop_run){k, there, 1};
    }
    for (int k = 0; k < other->slot_count; k++)
        at[other->slot[k]] = -1;
    return count;
}

static bool make_pairs(ld_mstmm *s, int i, int *at)
{
    loop *l = &s->loop[i];
    loop_run *run = calloc((size_t)l->slot_count + 1, sizeof *run);
    l->pair = calloc((size_t)i + 1, sizeof *l->pair);
    bool whole = run && l->pair;
    l->first = i;
    for (int j = 0; whole && j <= i; j++) {
        int count = find_runs(l, &s->loop[j], at, run);
        if (count == 0 && j < i)
            continue;
        loop_run *own = malloc(((size_t)count + 1) * sizeof *own);
        if (own)
            memcpy(own, run, (size_t)count * sizeof *own);
        l->pair[l->pair_count++] = (loop_pair){j, count, own};
        l->first = j < l->first ? j : l->first;
        whole = own != NULL;
    }
    free(run);
    return whole;
}

// The nodes whose places the loops' sides follow from.
static bool list_nodes(ld_mstmm *s)
{
    bool *seen = calloc((size_t)s->node_count + 1, sizeof *seen);
    s->loop_node = calloc((size_t)s->node_count + 1, sizeof *s->loop_node);
    bool whole = seen && s->loop_node;
    for (int i = 0; whole && i < s->loop_count; i++) {
        const loop *l = &s->loop[i];
        for (int p = 0; p < l->part[0] + l->part[1] + l->part[2]; p++)
            seen[l->path[p]] = true;
    }
    for (int i = 1; whole && i <= s->node_count; i++)
        if (seen[i])
            s->loop_node[s->loop_node_count++] = i;
    free(seen);
    return whole;
}

// ---- build

ld_status loops_build(ld_mstmm *s, const ld_mstmm_description *d, int first_section,
                      ld_error *error)
{
    const size_t count = (size_t)d->loop_count;
    s->loop = calloc(count + 1, sizeof *s->loop);
    s->loop_name = calloc(count + 1, sizeof *s->loop_name);
    int *at = malloc(((size_t)s->u_count + 1) * sizeof *at);
    bool whole = s->loop && s->loop_name && at;
    for (int k = 0; whole && k < s->u_count; k++)
        at[k] = -1;
    s->loop_count = whole ? d->loop_count : 0;
    for (int i = 0; whole && i < s->loop_count; i++) {
        loop *l = &s->loop[i];
        const ld_mstmm_loop *given = &d->loops[i];
        memcpy(s->loop_name[i], given->name, strlen(given->name) + 1);
        l->given = *given;
        l->given.name = l->given.first.element = l->given.second.element = NULL;
        description_joint_axes(given->joint, given->axis, given->axis_2, l->axes);
        for (int k = 0; k < hinge_table[given->joint].speeds; k++)
            l->has_springs |= given->stiffness[k] > 0 || given->damping[k] > 0;
        s->loop_loads |= l->has_springs;
        make_end(s, d, l, 0, &first_section);
        make_end(s, d, l, 1, &first_section);
        make_rows(l);
        whole = make_path(s, l) && make_slots(s, l) && make_pairs(s, i, at);
    }
    free(at);
    whole = whole && list_nodes(s);
    return whole ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
}

// ---- memory

// Room for all rows at a time, if they are not too many.
static bool allocate_dense(ld_mstmm *s)
{
    const size_t most = 1000000;
    size_t rows = 0, n = (size_t)s->u_count;
    for (int i = 0; i < s->loop_count; i++)
        rows += (size_t)s->loop[i].row_count;
    dense_rows *d = &s->dense;
    *d = (dense_rows){0};
    if (rows == 0 || rows * (n + rows) > most)
        return true;
    d->V = malloc(rows * n * sizeof *d->V + sizeof *d->V);
    d->R = malloc(rows * rows * sizeof *d->R);
    d->scale = malloc(rows * sizeof *d->scale);
    d->gap = malloc(rows * sizeof *d->gap);
    d->found = malloc(rows * sizeof *d->found);
    d->order = malloc(rows * sizeof *d->order);
    return d->V && d->R && d->scale && d->gap && d->found && d->order;
}

bool loops_allocate(ld_mstmm *s)
{
    const size_t u = (size_t)s->u_count + 1;
    size_t numbers = 1;
    for (int i = 0; i < s->loop_count; i++)
        numbers += 12 * (size_t)s->loop[i].slot_count + 72 * (size_t)(i - s->loop[i].first + 1);
    const size_t work = ((size_t)s->loop_count + 1) * sizeof *s->loop_work;
    s->loop_work = aligned_alloc(64, (work + 63) / 64 * 64);
    s->loop_numbers = calloc(numbers, sizeof *s->loop_numbers);
    s->applied = calloc(6 * (size_t)s->load_count + 6, sizeof *s->applied);
    s->zero = calloc(u, sizeof *s->zero);
    s->response = calloc(u, sizeof *s->response);
    s->trial = calloc((size_t)s->q_count + 1, sizeof *s->trial);
    if (!s->loop_work || !s->loop_numbers || !s->applied || !s->zero || !s->response || !s->trial ||
        !allocate_dense(s))
        return false;
    memset(s->loop_work, 0, work);
    double *next = s->loop_numbers;
    for (int i = 0; i < s->loop_count; i++) {
        loop_work *w = &s->loop_work[i];
        const size_t slots = 6 * (size_t)s->loop[i].slot_count;
        const size_t blocks = 36 * (size_t)(i - s->loop[i].first + 1);
        w->Y = next;
        w->Z = w->Y + slots;
        w->S = w->Z + slots;
        w->X = w->S + blocks;
        next = w->X + blocks;
    }
    return true;
}

void loops_copy(ld_mstmm *s, const ld_mstmm *from)
{
    for (int i = 0; i < s->loop_count; i++) {
        loop_work *w = &s->loop_work[i];
        const loop_work *known = &from->loop_work[i];
        w->active = known->active;
        w->limit = known->limit;
        memcpy(w->active_row, known->active_row, sizeof w->active_row);
        memcpy(w->scale, known->scale, sizeof w->scale);
    }
}

void loops_free_workspace(ld_mstmm *s)
{
    free(s->loop_work);
    free(s->loop_numbers);
    free(s->applied);
    free(s->zero);
    free(s->response);
    free(s->trial);
    free(s->dense.V);
    free(s->dense.R);
    free(s->dense.scale);
    free(s->dense.gap);
    free(s->dense.found);
    free(s->dense.order);
}

void loops_free(ld_mstmm *s)
{
    for (int i = 0; s->loop && i < s->loop_count; i++) {
        loop *l = &s->loop[i];
        for (int p = 0; l->pair && p < l->pair_count; p++)
            free(l->pair[p].run);
        free(l->pair);
        free(l->path);
        free(l->path_slot);
        free(l->slot);
    }
    free(s->loop);
    free(s->loop_name);
    free(s->loop_node);
}
