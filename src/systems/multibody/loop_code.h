// The loops' part of the sweep (mstmm.md, closed loops), text of the sources that sweep_code.h is
// the text of. A unit wrench g of a row goes from the sides of its joint towards the ground as
// wrenches do: at every axis it has the share y = e . F, and F - V y continues. With all y of two
// rows r and s the response is S_rs = sum y_r y_s/D; without forces the row has the acceleration
// sum y rate + sum F . bias + F_ground . base.

// A beam's speeds under the unit wrenches that its sections carry.
typedef struct unit_loads {
    double Q[6][6 + LD_TUBE_MODES];
} unit_loads;

// What is being walked with: one wrench a row.
typedef struct walker {
    ld_mstmm *system;
    const loop *l;
    loop_work *w;
    spatial_lanes F[6];
    double gap[6];
} walker;

static void walk_axis(walker *k, int i, int slot, bool turns)
{
    const node_motion *m = &k->system->motion[i];
    const axis_record *record = &k->system->axis[k->system->node[i].axis];
    const int stride = k->l->slot_count;
    const lanes_cycle r = lanes_cycle_of(m->r);
    const v4d e = m->A[2];
    for (int a = 0; a < k->w->active; a++) {
        spatial_lanes F = k->F[a];
        v4d y = v4d_total(e * (turns ? F.alpha : F.a)), along = F.a * m->bias_a;
        if (turns)
            along += F.alpha * m->bias_alpha;
        k->gap[a] += y[0] * record->rate + v4d_total(along)[0];
        k->w->Y[a * stride + slot] = y[0];
        k->w->Z[a * stride + slot] = y[0] * record->inverse;
        F.alpha += lanes_cross(&r, F.a) - record->V_alpha * y;
        F.a -= record->V_a * y;
        k->F[a] = F;
    }
}

// No axis gives way: all passes.
static void walk_rigidly(walker *k, int i)
{
    const node_motion *m = &k->system->motion[i];
    const lanes_cycle r = lanes_cycle_of(m->r);
    for (int a = 0; a < k->w->active; a++) {
        spatial_lanes *F = &k->F[a];
        k->gap[a] += v4d_total(F->a * m->bias_a + F->alpha * m->bias_alpha)[0];
        F->alpha += lanes_cross(&r, F->a);
    }
}

// A ball passes the force at its point, a free hinge nothing.
static void walk_several(walker *k, int i, int slot)
{
    const node *n = &k->system->node[i];
    const node_motion *m = &k->system->motion[i];
    const axis_record *record = &k->system->axis[n->axis];
    const bool is_free = n->hinge == NODE_FREE;
    const lanes_cycle r = lanes_cycle_of(m->r);
    for (int a = 0; a < k->w->active; a++) {
        spatial_lanes F = k->F[a];
        double *Y = k->w->Y + a * k->l->slot_count + slot;
        double *Z = k->w->Z + a * k->l->slot_count + slot;
        for (int c = 0; c < (is_free ? 6 : 3); c++) {
            double y = c < 3 ? F.alpha[c] : F.a[c - 3];
            k->gap[a] += y * record[c].rate;
            Y[c] = y;
            Z[c] = y * record[c].inverse;
            F.alpha -= record[c].V_alpha * v4d_all(y);
            F.a -= record[c].V_a * v4d_all(y);
        }
        if (is_free)
            F.a = v4d_all(0);
        k->gap[a] += v4d_total(F.a * m->bias_a)[0];
        k->F[a] = (spatial_lanes){F.a, lanes_cross(&r, F.a)};
    }
}

// A section hands its wrench to the beam's speeds.
static void walk_section(walker *k, int i, unit_loads *loads)
{
    const node_beam *b = &k->system->beam_of[i];
    const m3 A_R = node_body_axes(k->system, k->system->node[i].parent);
    const double *gamma = b->body->output[b->output].section.gamma;
    for (int a = 0; a < k->w->active; a++) {
        spatial F = spatial_turn_back(A_R, (spatial){v4d_v3(k->F[a].a), v4d_v3(k->F[a].alpha)});
        k->gap[a] += spatial_dot(F, (spatial){v3_from(gamma), v3_from(gamma + 3)});
        beam_carry_unit(b->body, b->output, F, loads->Q[a]);
        k->F[a] = (spatial_lanes){v4d_all(0), v4d_all(0)};
    }
}

// A beam's modes take their share of what its sections have handed over; the rest is a wrench at
// its input end.
static void walk_beam(walker *k, int i, int slot, unit_loads *loads)
{
    const node_beam *b = &k->system->beam_of[i];
    const m3 A_R = node_body_axes(k->system, i);
    for (int a = 0; a < k->w->active; a++) {
        double *Q = loads->Q[a];
        if (k->system->beams_rigid)
            memset(Q + 6, 0, (size_t)b->body->modes * sizeof *Q);
        beam_reduce_unit(b->body, Q);
        for (int c = 0; c < b->body->modes; c++) {
            k->gap[a] += Q[6 + c] * b->body->h[6 + c];
            k->w->Y[a * k->l->slot_count + slot + c] = Q[6 + c];
            k->w->Z[a * k->l->slot_count + slot + c] = Q[6 + c];
        }
        spatial F = spatial_turn(A_R, (spatial){v3_from(Q), v3_from(Q + 3)});
        k->F[a].a += v4d_from_v3(F.linear);
        k->F[a].alpha += v4d_from_v3(F.angular);
        memset(Q, 0, (size_t)(6 + b->body->modes) * sizeof *Q);
    }
}

static void walk_given(walker *k, int i, int slot)
{
    for (int a = 0; a < k->w->active; a++)
        for (int c = 0; c < node_speeds(&k->system->node[i]); c++) {
            k->w->Y[a * k->l->slot_count + slot + c] = 0;
            k->w->Z[a * k->l->slot_count + slot + c] = 0;
        }
    walk_rigidly(k, i);
}

// Along the nodes path[from] to path[to - 1].
static void walk(walker *k, int from, int to, unit_loads *loads)
{
    for (int p = from; p < to; p++) {
        const int i = k->l->path[p];
        const node *n = &k->system->node[i];
        int slot = k->l->path_slot[p];
        if (n->body == NODE_SECTION) {
            walk_section(k, i, loads);
            continue;
        }
        if (n->body == NODE_BEAM) {
            walk_beam(k, i, slot, loads);
            slot += k->system->beam_of[i].body->modes;
        }
        switch ((node_pass)k->system->pass[i]) {
        case PASS_TURN:
            walk_axis(k, i, slot, true);
            break;
        case PASS_SLIDE:
            walk_axis(k, i, slot, false);
            break;
        case PASS_SEVERAL:
            walk_several(k, i, slot);
            break;
        case PASS_GIVEN:
            walk_given(k, i, slot);
            break;
        case PASS_WELD:
            walk_rigidly(k, i);
        }
    }
}

// Both sides to where they meet, and on together.
static void walk_loop(ld_mstmm *system, int index, unit_loads loads[2])
{
    const loop *l = &system->loop[index];
    loop_work *w = &system->loop_work[index];
    const size_t size = (size_t)w->active * sizeof *w->unit[0];
    walker k = {.system = system, .l = l, .w = w};
    spatial_lanes first[6];
    memcpy(k.gap, w->gap, sizeof k.gap);
    memcpy(k.F, w->unit[0], size);
    walk(&k, 0, l->part[0], &loads[0]);
    memcpy(first, k.F, size);
    memcpy(k.F, w->unit[1], size);
    walk(&k, l->part[0], l->part[0] + l->part[1], &loads[1]);
    for (int a = 0; a < w->active; a++) {
        k.F[a].a += first[a].a;
        k.F[a].alpha += first[a].alpha;
        for (int c = 0; l->meets_in_beam && c < 6 + LD_TUBE_MODES; c++) {
            loads[0].Q[a][c] += loads[1].Q[a][c];
            loads[1].Q[a][c] = 0;
        }
    }
    walk(&k, l->part[0] + l->part[1], l->part[0] + l->part[1] + l->part[2], &loads[0]);
    v4d base = v4d_from_v3(system->base.linear);
    for (int a = 0; a < w->active; a++)
        w->gap[a] = k.gap[a] + v4d_total(k.F[a].a * base)[0];
}

// How the rows of loop i answer to unit forces of loop j.
static void couple(const ld_mstmm *system, int i, const loop_pair *pair)
{
    const int j = pair->other, here = system->loop[i].slot_count;
    const int there = system->loop[j].slot_count;
    const loop_work *w = &system->loop_work[i], *other = &system->loop_work[j];
    double *S = w->S + (size_t)(j - system->loop[i].first) * 36;
    for (int a = 0; a < w->active; a++)
        for (int b = 0; b < (i == j ? a + 1 : other->active); b++) {
            double sum = 0;
            for (int r = 0; r < pair->run_count; r++) {
                const double *Z = w->Z + a * here + pair->run[r].here;
                const double *Y = other->Y + b * there + pair->run[r].there;
                for (int k = 0; k < pair->run[r].length; k++)
                    sum += Z[k] * Y[k];
            }
            S[6 * a + b] = sum;
            if (i == j)
                S[6 * b + a] = sum;
        }
}

static void propagate(ld_mstmm *system)
{
    unit_loads loads[2];
    if (system->beam_count > 0)
        memset(loads, 0, sizeof loads);
    for (int i = 0; i < system->loop_count; i++) {
        walk_loop(system, i, loads);
        for (int p = 0; p < system->loop[i].pair_count; p++)
            couple(system, i, &system->loop[i].pair[p]);
    }
}

static void apply(ld_mstmm *system)
{
    for (int index = 0; index < system->loop_count; index++) {
        const loop *l = &system->loop[index];
        const loop_work *w = &system->loop_work[index];
        int slot = 0;
        for (int p = 0; p < l->part[0] + l->part[1] + l->part[2]; p++) {
            const int i = l->path[p];
            const node *n = &system->node[i];
            const beam *body = n->body == NODE_BEAM ? system->beam_of[i].body : NULL;
            const int modes = body ? body->modes : 0;
            const int last = modes + (n->body == NODE_SECTION ? 0 : node_speeds(n));
            for (int c = 0; c < last; c++, slot++) {
                double *to = c < modes ? &body->h[6 + c] : &system->axis[n->axis + c - modes].rate;
                for (int a = 0; a < w->active; a++)
                    *to += w->Z[a * l->slot_count + slot] * w->force[w->active_row[a]];
            }
        }
    }
}
