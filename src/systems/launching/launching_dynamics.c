#include "systems/launching/launching_dynamics.h"

#include "systems/launching/launching_constraints.h"
#include "systems/launching/launching_general.h"

// Accelerations without constraint forces: r_O and, forward-substituted, e_0.
LD_INLINE void accelerate_freely(const int lanes, const bool rocket, const launching_system *self,
                                 const launching_instant *now, constrained *to)
{
    v3 f, m;
    const tube_force *h = &now->on_tube;
    to->a = to->alpha = v3_zero();
    if (rocket)
        rocket_solve(&now->inertia, now->f, now->m, &to->a, &to->alpha);
    tube_condense(lanes, &self->tube, &now->tube, h, &f, &m);
    tube_forward(&now->tube, v3_sub(h->f, f), v3_sub(h->m, m), to->rigid);
    constrained_begin(to);
}

// Finds the forces of the constraints and adds what they do. False where the knob jams.
LD_INLINE bool constrain(const int lanes, const launching_system *self,
                         const launching_instant *now, constraint_set *set, constrained *to)
{
    double r[LD_MAX_CONSTRAINTS];
    constraint_products D;
    if (!set->count)
        return true;
    for (int i = 0; i < set->count; i++)
        r[i] = -(free_acceleration(lanes, &self->tube, now, set, &set->e[i], to) + set->e[i].beta);
    constraint_products_load(lanes, &self->tube, &now->tube, set, &D);
    if (!constraints_solve(&D, r, set))
        return false;
    for (int i = 0; i < set->count; i++)
        constraint_apply(&set->e[i], set->x[i], to);
    if (set->sliding)
        constraint_apply(&set->tangent, set->friction, to);
    return true;
}

LD_INLINE section_reaction reaction_at(const constraint_set *set, const constrained *all, int i)
{
    return (section_reaction){&set->section[i].shapes, all->force[i], all->mu[i]};
}

// Accelerations of the tube's frame and of its modes with the constraint forces.
LD_INLINE frame_acceleration accelerate_tube(const int lanes, const launching_system *self,
                                             const launching_instant *now,
                                             const constraint_set *set, const constrained *all,
                                             double *q_ddot)
{
    frame_acceleration frame = tube_backward(&now->tube, all->rigid);
    section_reaction first = reaction_at(set, all, 0);
    tube_modal_accelerations(lanes, &self->tube, now, set->section_count ? &first : NULL, frame,
                             q_ddot);
    for (int i = 1; i < set->section_count; i++) {
        section_reaction other = reaction_at(set, all, i);
        react_on_modes(&self->tube, &other, q_ddot);
    }
    return frame;
}

// What an instance of the code knows when it is compiled: lanes of modes, whether the rocket is in
// the tube, whether something is held in its place.
typedef struct evaluation_kind {
    int lanes;
    bool rocket, holds;
} evaluation_kind;

LD_INLINE launching_outcome evaluate(const evaluation_kind kind, const launching_system *self,
                                     const launching_input *input, const launching_phase *phase,
                                     const double *state, launching_output *out)
{
    const int lanes = kind.lanes;
    const bool rocket = kind.rocket, holds = kind.holds;
    launching_instant now;
    now.input = input;
    now.phase = phase;
    now.out = out;
    memset(out->power, 0, sizeof out->power);
    now.on_tube.record = input->record;
    now.on_tube.bent = NULL;
    tube_load(lanes, &self->tube, &self->layout, state, &now.tube);
    tube_forces(lanes, &self->tube, &now.tube, &now.on_tube, out);
    supports_add(lanes, &self->supports, &self->tube, &now);
    tube_factor(lanes, &self->tube, &now.tube);
    if (input->load)
        load_tip(lanes, input->load, &self->tube, &now);
    if (__builtin_expect(self->wind.count, 0))
        guide_wind_add(&self->wind, &self->tube, &now);
    out->guide_jet = input->jet_face.hit;
    out->deflector = input->deflector.hit;
    if (__builtin_expect(out->guide_jet != 0 || out->deflector != 0, 0))
        guide_jet_add(&self->tube, &now);
    if (rocket)
        launching_load_rocket(lanes, self, state, &now);

    launching_constraints constraints;
    constrained all;
    accelerate_freely(lanes, rocket, self, &now, &all);
    launching_constrain(lanes, rocket, holds, self, &now, &constraints);
    if (!constrain(lanes, self, &now, &constraints.set, &all))
        return LAUNCHING_JAMMED;
    launching_report(rocket, holds, self, &now, &constraints.set, out);
    constraints_record(&now, &constraints.set);
    out->a_O1 = all.a;
    out->alpha_B = all.alpha;
    frame_acceleration frame =
        accelerate_tube(lanes, self, &now, &constraints.set, &all, out->q_ddot);
    out->a = frame.a;
    out->w_dot = frame.w_dot;
    return LAUNCHING_OK;
}

// Instances of the code, each a function of its own: together in one they are 12 % slower. For the
// usual launch (up to 8 modes a plane, the rocket in the tube, nothing held in its place), for any
// with as many modes, and for any.
typedef launching_outcome evaluation(const launching_system *self, const launching_input *input,
                                     const launching_phase *phase, const double *state,
                                     launching_output *out);

#define INSTANCE(TARGET, NAME, LANES, ROCKET, HOLDS)                                               \
    TARGET static __attribute__((noinline)) launching_outcome NAME(                                \
        const launching_system *self, const launching_input *input, const launching_phase *phase,  \
        const double *state, launching_output *out)                                                \
    {                                                                                              \
        return evaluate((evaluation_kind){LANES, ROCKET, HOLDS}, self, input, phase, state, out);  \
    }
#define INSTANCES(TARGET, USUAL, FEW_MODES, ANY)                                                   \
    INSTANCE(TARGET, USUAL, 2, true, false)                                                        \
    INSTANCE(TARGET, FEW_MODES, 2, phase->rocket, launching_holds_places(self))                    \
    INSTANCE(TARGET, ANY, self->tube.flexible.nbp / 4, phase->rocket, launching_holds_places(self))

INSTANCES(, usual, few_modes, any)
#if defined(__x86_64__)
// The same code with the processor's wider instructions: the same bits.
INSTANCES(__attribute__((target("avx2"))), usual_wide, few_modes_wide, any_wide)
#endif

launching_outcome launching_evaluate(const launching_system *self, const launching_input *input,
                                     const launching_phase *phase, const double *state,
                                     launching_output *out)
{
    if (launching_is_general(self))
        return launching_evaluate_general(self, input, phase, state, out);
    bool few = self->tube.flexible.nbp == 8;
    bool is_usual = few && phase->rocket && !launching_holds_places(self);
    evaluation *chosen = is_usual ? usual : few ? few_modes : any;
#if defined(__x86_64__)
    if (self->wide_instructions)
        chosen = is_usual ? usual_wide : few ? few_modes_wide : any_wide;
#endif
    return chosen(self, input, phase, state, out);
}

// An impulse along the constraints that takes what is wrong, e.g. their drift, out of the speeds:
// D x = -wrong, V += r x, eta -= e x.
static void find_impulse(int lanes, const launching_system *self, const launching_instant *now,
                         const constraint_set *set, const double *wrong, constrained *impulse)
{
    constraint_products D;
    double x[LD_MAX_CONSTRAINTS];
    *impulse = (constrained){.a = v3_zero()};
    constraint_products_load(lanes, &self->tube, &now->tube, set, &D);
    ldl_factor(set->count, LD_MAX_CONSTRAINTS, D.D[0]);
    for (int i = 0; i < set->count; i++)
        x[i] = -wrong[i];
    ldl_solve(set->count, LD_MAX_CONSTRAINTS, D.D[0], x);
    for (int i = 0; i < set->count; i++)
        constraint_apply(&set->e[i], x[i], impulse);
}

static void load_to_project(int lanes, const launching_system *self, const double *state,
                            launching_instant *now)
{
    memset(&now->on_tube, 0, sizeof now->on_tube);
    tube_load(lanes, &self->tube, &self->layout, state, &now->tube);
    tube_factor(lanes, &self->tube, &now->tube);
}

// What that impulse makes of tube and rocket, with all modes that the tube has.
static void change_by_impulse(const launching_system *self, const launching_instant *now,
                              const constraint_set *set, const double *state, const double *wrong,
                              launching_change *change)
{
    int lanes = self->tube.flexible.nbp / 4;
    constrained impulse;
    if (launching_is_general(self)) {
        launching_impulse_general(self, now, set, state, wrong, change);
        return;
    }
    find_impulse(lanes, self, now, set, wrong, &impulse);
    frame_acceleration frame = accelerate_tube(lanes, self, now, set, &impulse, change->q_ddot);
    change->a = frame.a;
    change->w_dot = frame.w_dot;
    change->a_O1 = impulse.a;
    change->alpha_B = impulse.alpha;
}

// Puts the tube where its clamps hold it, by displacements along their forces.
static void place_on_clamps(int lanes, const launching_system *self, const launching_instant *given,
                            double *state)
{
    const launching_layout *at = &self->layout;
    const launching_phase tube_alone = {.rocket = false};
    launching_instant now = *given;
    now.phase = &tube_alone;
    for (int pass = 0; pass < 3; pass++) {
        launching_constraints clamps;
        launching_change shift;
        double wrong[LD_MAX_CONSTRAINTS], most = 0;
        load_to_project(lanes, self, state, &now);
        launching_constrain(lanes, false, true, self, &now, &clamps);
        for (int i = 0; i < clamps.set.count; i++) {
            wrong[i] = clamps.set.e[i].error;
            most = fmax(most, fabs(wrong[i]));
        }
        if (most < 1e-15)
            return;
        change_by_impulse(self, &now, &clamps.set, state, wrong, &shift);
        quat turned = q_multiply(now.tube.q_IR, rv_quaternion(shift.w_dot));
        v3_store(state + at->r, v3_add(now.tube.r, m3_apply(now.tube.A_IR, shift.a)));
        memcpy(state + at->quaternion, &turned, sizeof turned);
        for (int i = 0; i < at->nq; i++)
            state[at->q + i] += shift.q_ddot[i];
    }
}

// Takes the drift of all constraints out of the speeds.
static void remove_drift(const launching_system *self, const launching_instant *now,
                         const constraint_set *set, double *state)
{
    const launching_layout *at = &self->layout;
    launching_change change;
    double drift[LD_MAX_CONSTRAINTS];
    for (int i = 0; i < set->count; i++)
        drift[i] = set->e[i].drift;
    change_by_impulse(self, now, set, state, drift, &change);
    if (now->phase->rocket) {
        v3_store(state + at->V, v3_add(now->rocket.v_O1, change.a_O1));
        v3_store(state + at->V + 3, v3_add(now->rocket.w_B, change.alpha_B));
    }
    v3_store(state + at->v, v3_add(now->tube.v, change.a));
    v3_store(state + at->w, v3_add(now->tube.w, change.w_dot));
    for (int i = 0; i < at->nq; i++)
        state[at->q_dot + i] += change.q_ddot[i];
}

void launching_project(const launching_system *self, const launching_input *input,
                       const launching_phase *phase, double *state)
{
    const launching_layout *at = &self->layout;
    int lanes = self->tube.flexible.nbp / 4;
    launching_output unused;
    launching_constraints constraints;
    launching_instant now = {.input = input, .phase = phase, .out = &unused};
    if (self->supports.clamps)
        place_on_clamps(lanes, self, &now, state);
    load_to_project(lanes, self, state, &now);
    if (phase->rocket) {
        if (self->adaptors.law.held)
            ideal_place(&self->adaptors, &self->tube, at, phase, &now.tube, state);
        rocket_load(&self->tube, at, state, &now.tube, &now.rocket, &unused);
        rocket_inertia_load(&input->mass, now.rocket.A_RB, &now.inertia);
    }
    launching_constrain(lanes, phase->rocket, true, self, &now, &constraints);
    if (constraints.set.count)
        remove_drift(self, &now, &constraints.set, state);
}
