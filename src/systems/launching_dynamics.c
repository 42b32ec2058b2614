// Accelerations of the launching subsystem: the reduced form in the fast layout of formulation.md,
// section 5. One pass, no memory but the stack.
#include "systems/launching_forces.h"

LD_INLINE void finish_without_rocket(const int lanes, const launching_system *self,
                                     tube_state *tube, const tube_force *h, launching_output *out)
{
    v3 f, m;
    double rigid[6];
    condense(lanes, self, tube, h, &f, &m);
    forward(tube, v3_sub(h->f, f), v3_sub(h->m, m), rigid);
    backward(tube, rigid, &out->a, &out->w_dot);
    modal_accelerations(lanes, self, tube, NULL, h, v3_zero(), v3_zero(), out->a, out->w_dot,
                        out->q_ddot);
}

LD_INLINE void load_products(const tube_state *tube, const section_shapes *shapes,
                             const constraint_forces *c, constraint_products *D)
{
    D->D00 = direction_product(tube, shapes, &c->e[0], &c->e[0]);
    D->D01 = D->D11 = D->Dt = 0;
    if (c->count == 2) {
        D->D01 = direction_product(tube, shapes, &c->e[0], &c->e[1]);
        D->D11 = direction_product(tube, shapes, &c->e[1], &c->e[1]);
    }
    if (c->sliding)
        D->Dt = direction_product(tube, shapes, &c->e[0], &c->tangent);
}

LD_INLINE launching_outcome evaluate(const int lanes, const launching_system *self,
                                     const launching_input *input, const launching_phase *phase,
                                     const double *state, launching_output *out)
{
    tube_state tube;
    tube_force h;
    load_tube(lanes, self, state, &tube);
    memset(out->power, 0, sizeof out->power);
    tube_own_forces(lanes, self, &tube, &h, out);
    support_forces(lanes, self, &input->base, &tube, &h, out);
    factor(self, &tube);
    if (!phase->rocket) {
        finish_without_rocket(lanes, self, &tube, &h, out);
        return LAUNCHING_OK;
    }

    // rocket: own forces, then contacts, which also act on the tube
    rocket_state rocket;
    rocket_inertia inertia;
    v3 f_O1, m_O1;
    load_rocket(self, state, &tube, &rocket, out);
    rocket_inertia_load(&input->mass, rocket.A_RB, &inertia);
    rocket_own_forces(self, input, &tube, &rocket, &inertia, &f_O1, &m_O1, out);
    for (int i = 0; i < self->adaptor_count; i++)
        if (!phase->passed[i])
            adaptor_contact(lanes, self, phase, &tube, &rocket, i, &h, &f_O1, &m_O1, out);
    breech_contact(lanes, self, phase, &tube, &rocket, &h, &f_O1, out);

    // accelerations without constraints: r_O and, forward-substituted, e_0
    v3 r_a, r_alpha, f, m;
    double rigid[6];
    rocket_solve(&inertia, f_O1, m_O1, &r_a, &r_alpha);
    condense(lanes, self, &tube, &h, &f, &m);
    forward(&tube, v3_sub(h.f, f), v3_sub(h.m, m), rigid);

    // constraint forces, and the accelerations with them
    constraint_forces c;
    constraint_products D;
    section_shapes shapes;
    v3 force = v3_zero(), mu = v3_zero();
    double v_tau, r[2];
    load_shapes(lanes, self, &rocket.at, &shapes);
    load_constraints(self, phase, &tube, &rocket, &inertia, &shapes, &c, &v_tau);
    if (c.count) {
        for (int i = 0; i < c.count; i++)
            r[i] =
                -(free_acceleration(lanes, self, &tube, &shapes, &c.e[i], r_a, r_alpha, rigid, &h) +
                  c.e[i].beta);
        load_products(&tube, &shapes, &c, &D);
        if (!solve_constraints(self, &D, r, v_tau, &c))
            return LAUNCHING_JAMMED;
        for (int i = 0; i < c.count; i++)
            add_constraint(&c.e[i], c.x[i], &r_a, &r_alpha, rigid, &force, &mu);
        if (c.sliding)
            add_constraint(&c.tangent, c.rub, &r_a, &r_alpha, rigid, &force, &mu);
    }
    report_constraints(&c, self->slot, v_tau, out);
    out->a_O1 = r_a;
    out->alpha_B = r_alpha;
    backward(&tube, rigid, &out->a, &out->w_dot);
    modal_accelerations(lanes, self, &tube, &shapes, &h, force, mu, out->a, out->w_dot,
                        out->q_ddot);
    return LAUNCHING_OK;
}

// One instance for the usual number of modes (up to 8 a plane), one for any.
LD_INLINE launching_outcome evaluate_any(const launching_system *self, const launching_input *input,
                                         const launching_phase *phase, const double *state,
                                         launching_output *out)
{
    if (self->tube.nbp == 8)
        return evaluate(2, self, input, phase, state, out);
    return evaluate(self->tube.nbp / 4, self, input, phase, state, out);
}

#if defined(__x86_64__)
// The same code with the processor's wider instructions: the same bits.
__attribute__((target("avx2"))) static launching_outcome
evaluate_wide(const launching_system *self, const launching_input *input,
              const launching_phase *phase, const double *state, launching_output *out)
{
    return evaluate_any(self, input, phase, state, out);
}
#endif

launching_outcome launching_evaluate(const launching_system *self, const launching_input *input,
                                     const launching_phase *phase, const double *state,
                                     launching_output *out)
{
    if (self->tube.na > 0) // axial modes: the fast layout has none
        return launching_evaluate_general(self, LD_FORMULATION_REDUCED, input, phase, state, out);
#if defined(__x86_64__)
    if (self->wide_instructions)
        return evaluate_wide(self, input, phase, state, out);
#endif
    return evaluate_any(self, input, phase, state, out);
}

void launching_feet(const launching_system *self, const launching_phase *phase, const double *state,
                    double *feet)
{
    tube_state tube;
    int lanes = self->tube.nbp / 4;
    load_tube(lanes, self, state, &tube);
    rocket_state rocket;
    launching_output unused;
    load_rocket(self, state, &tube, &rocket, &unused);
    for (int i = 0; i < self->adaptor_count; i++) {
        double guess = rocket.s + self->adaptor_at[i];
        feet[i] = guess;
        // far from the tip the sign is all that is asked for
        if (i == 0 || phase->passed[i] || fabs(guess - self->tube.length) > 0.02)
            continue;
        adaptor_state adaptor;
        adaptor_load(self, &tube, &rocket, i, &adaptor);
        feet[i] = adaptor.foot->x;
    }
}

void launching_project(const launching_system *self, const launching_input *input,
                       const launching_phase *phase, double *state)
{
    if (!self->slot || !phase->rocket)
        return;
    int lanes = self->tube.nbp / 4, nq = self->layout.nq;
    tube_state tube;
    tube_force none;
    launching_output unused;
    rocket_state rocket;
    rocket_inertia inertia;
    section_shapes shapes;
    direction e;
    memset(&none, 0, sizeof none);
    load_tube(lanes, self, state, &tube);
    factor(self, &tube);
    load_rocket(self, state, &tube, &rocket, &unused);
    rocket_inertia_load(&input->mass, rocket.A_RB, &inertia);
    load_shapes(lanes, self, &rocket.at, &shapes);
    section_bias bias = bias_of(&tube, &rocket);
    slot_directions(self, &tube, &rocket, &inertia, &shapes, &bias, &e, NULL, NULL);
    // V -= r_n eps/Dn, eta += e_n eps/Dn: an impulse along the constraint
    double x = e.drift / direction_product(&tube, &shapes, &e, &e);
    v3 a, w_dot;
    double q_dot[LD_MAX_MODAL];
    backward(&tube, e.rigid, &a, &w_dot);
    modal_accelerations(lanes, self, &tube, &shapes, &none, v3_neg(e.force), v3_neg(e.mu), a, w_dot,
                        q_dot);
    const launching_layout *at = &self->layout;
    v3_store(state + at->V, v3_axpy(rocket.v_O1, -x, e.r_a));
    v3_store(state + at->V + 3, v3_axpy(rocket.w_B, -x, e.r_alpha));
    v3_store(state + at->v, v3_axpy(tube.v, x, a));
    v3_store(state + at->w, v3_axpy(tube.w, x, w_dot));
    for (int i = 0; i < nq; i++)
        state[at->q_dot + i] += x * q_dot[i];
}

void launching_rocket_pose(const launching_system *self, const double *state, launching_pose *pose,
                           launching_output *output)
{
    tube_state tube;
    rocket_state rocket;
    load_tube(self->tube.nbp / 4, self, state, &tube);
    load_rocket(self, state, &tube, &rocket, output);
    *pose = (launching_pose){rocket.p1, rocket.at.A, rocket.A_RB, rocket.v_O1, rocket.w_B};
}

void launching_section_at(const launching_system *self, const double *state, double x,
                          launching_section *out)
{
    tube_state tube;
    element_motion motion;
    section s;
    section_rates rates;
    load_tube(self->tube.nbp / 4, self, state, &tube);
    s.index = flexible_tube_find(&self->tube, x);
    element_load(self, &tube.modal, s.index, &motion);
    section_load(self, &motion, x, &s);
    section_rates_load(&motion, &s, &rates);
    out->P = s.P;
    out->A = s.A;
    out->v = v3_add(v3_add(tube.v, v3_cross(tube.w, s.P)), rates.u_dot);
    out->w = v3_add(tube.w, rates.w);
}

double launching_offset_rate(const launching_system *self, const double *state, int i)
{
    tube_state tube;
    rocket_state rocket;
    launching_output unused;
    adaptor_state adaptor;
    load_tube(self->tube.nbp / 4, self, state, &tube);
    load_rocket(self, state, &tube, &rocket, &unused);
    adaptor_load(self, &tube, &rocket, i, &adaptor);
    v3 v_C = v3_add(rocket.v_O1, v3_cross(rocket.w_B, adaptor.arm));
    adaptor_rates(&tube, &rocket, i, v_C, &adaptor);
    double e = sqrt(adaptor.y * adaptor.y + adaptor.z * adaptor.z);
    return (adaptor.y * adaptor.y_dot + adaptor.z * adaptor.z_dot) / e;
}
