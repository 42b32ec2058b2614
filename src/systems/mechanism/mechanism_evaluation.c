#include "systems/mechanism/mechanism_evaluation.h"

#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "systems/mechanism/mechanism_forces.h"
#include "systems/multibody/loop_rows.h"
#include "systems/multibody/multibody.h"

// Torque or force of a hold into its report; rates of what it has in the state.
static void drive_hold(const mechanism_system *self, int index, const mechanism_input *input,
                       const double *state, hinge_report *report, double *state_dot)
{
    const mechanism_hold *hold = &self->hold[index];
    const hold_rest *rest = &input->rest[index];
    int z = self->z_at + index;
    report->limited = false;
    report->friction = 0;
    state_dot[z] = 0;
    for (int k = 0; k < DRIVE_STATES && hold->drive >= 0; k++)
        state_dot[hold->drive + k] = 0;
    if (input->held)
        report->torque = rest->torque;
    else if (hold->lock)
        report->torque = rest->torque - hold->lock->stiffness * (report->angle - rest->angle) -
                         hold->lock->damping * report->rate;
    else
        stabiliser_evaluate(hold->control, input->linear, state[z], state + hold->drive, report,
                            state_dot + z, state_dot + hold->drive);
}

// ---- joints

// Friction of joint i's axis, its rate being b_dot.
static double friction_of(const ld_joint *joint, bool linear, double b_dot)
{
    const ld_hinge_friction *friction = &joint->friction;
    double force = -friction->viscous * b_dot;
    if (!linear && friction->coulomb > 0)
        force -= friction->coulomb * b_dot / sqrt(b_dot * b_dot + friction->rate * friction->rate);
    return force;
}

// Force of a stop at coordinate b; what it stores and what its damper takes are added.
static double stop_force(const ld_joint_stops *stops, double b, double b_dot,
                         mechanism_output *output)
{
    double beyond = b > stops->high ? b - stops->high : b < stops->low ? b - stops->low : 0;
    if (!stops->present || beyond == 0)
        return 0;
    double spring = -stops->stiffness * beyond, all = spring - stops->damping * b_dot;
    if (all * beyond > 0)
        all = 0; // it does not pull
    output->elastic += -0.5 * spring * beyond;
    output->power[MECHANISM_FRICTION] += (all - spring) * b_dot;
    return all;
}

static bool has_one_axis(ld_joint_kind kind)
{
    return kind == LD_JOINT_REVOLUTE || kind == LD_JOINT_PRISMATIC;
}

// Friction and stops of the joints with one axis.
static void load_joints(const mechanism_system *self, const mechanism_input *input,
                        const mechanism_motion *motion, double *tau, mechanism_output *output)
{
    for (int i = 0; i < self->given->joint_count; i++) {
        const ld_joint *joint = &self->given->joint[i];
        int element = self->joint_element[i];
        output->report.friction[i] = 0;
        if (element < 0 || !has_one_axis(joint->kind))
            continue;
        int q = ld_mstmm_coordinate_offset(self->chain, element);
        int u = ld_mstmm_speed_offset(self->chain, element);
        double rate = motion->u[u];
        double friction = input->held ? 0 : friction_of(joint, input->linear, rate);
        tau[u] += friction + stop_force(&joint->stops, motion->q[q], rate, output);
        output->power[MECHANISM_FRICTION] += friction * rate;
        output->report.friction[i] = friction;
    }
}

// Locks that close later, once they have.
static void load_locks(const mechanism_system *self, const mechanism_motion *motion,
                       const double *state, double *tau, mechanism_output *output)
{
    for (int k = 0; k < self->later_count; k++) {
        const mechanism_later_lock *later = &self->later[k];
        const ld_joint_lock *lock = &self->given->joint[later->joint].lock;
        if (motion->t < lock->from)
            continue;
        double bent = motion->q[later->q] - state[later->state], rate = motion->u[later->u];
        tau[later->u] -= lock->spring.stiffness * bent + lock->spring.damping * rate;
        output->elastic += 0.5 * lock->spring.stiffness * bent * bent;
        output->power[MECHANISM_HOLDS] -= lock->spring.damping * rate * rate;
    }
}

// ---- everything

// NOLINTNEXTLINE(readability-function-size)
static void load_holds(const mechanism_system *self, const mechanism_input *input,
                       const mechanism_motion *motion, const double *state, double *state_dot,
                       force_sum *sum, double *tau)
{
    double push[LD_MAX_STRUTS] = {0};
    for (int i = 0; i < self->hold_count; i++) {
        const mechanism_hold *hold = &self->hold[i];
        hinge_report *report = &sum->output->report.hold[i];
        mechanism_watch(self, i, motion, report);
        drive_hold(self, i, input, state, report, state_dot);
        if (hold->strut >= 0)
            push[hold->strut] += report->torque;
        else
            tau[hold->u] += report->torque;
        sum->output->power[MECHANISM_HOLDS] += report->torque * report->rate;
    }
    mechanism_add_struts(sum, push);
}

// Momentum [kg m/s] in I of all bodies, and what beams store and their damping takes; from the
// motion in the workspace.
static v3 momentum_of(const mechanism_system *self, const mechanism_motion *motion,
                      mechanism_output *output)
{
    const ld_mstmm *chain = self->chain;
    v3 sum = v3_zero();
    for (int e = 0; e < self->element_count; e++) {
        const body_motion *body = &motion->body[e];
        int i = chain->element_node[e];
        if (chain->node[i].body == NODE_BEAM) {
            const node_beam *b = &chain->beam_of[i];
            const double *q = motion->q + b->modes_q, *q_dot = motion->u + b->modes_u;
            spatial p = beam_momentum(b->body, m3_apply_transposed(body->A, body->v), q_dot);
            sum = v3_add(sum, m3_apply(body->A, p.linear));
            output->power[MECHANISM_BEAMS] += tube_damping_power(&b->body->tube, q_dot);
            output->elastic += tube_elastic_energy(&b->body->tube, q);
        } else if (chain->inertia[i].mass > 0) {
            v3 center = m3_apply(node_axes(chain, i), chain->inertia[i].moment);
            sum = v3_axpy(sum, chain->inertia[i].mass, body->v);
            sum = v3_add(sum, v3_cross(body->w, center));
        }
    }
    return sum;
}

// Springs and dampers of joints that close loops.
static void note_loops(const mechanism_system *self, const mechanism_motion *motion,
                       mechanism_output *output)
{
    ld_mstmm *chain = self->chain;
    for (int i = 0; i < self->given->joint_count; i++) {
        int number = self->joint_loop[i];
        double x[7], v[6];
        if (number < 0 || !chain->loop[number].has_springs)
            continue;
        ld_mstmm_loop_state(chain, motion->q, motion->u, number, x, v);
        for (int k = 0; k < 6; k++)
            if (chain->loop[number].given.damping[k] > 0)
                output->power[MECHANISM_FRICTION] -=
                    chain->loop[number].given.damping[k] * v[k] * v[k];
    }
    loops_place(chain, motion->u);
    output->elastic += loops_energy(chain);
}

// Springs and dampers that the tree's hinges have on their own.
static void note_springs(const mechanism_system *self, const mechanism_motion *motion,
                         mechanism_output *output)
{
    const ld_mstmm *chain = self->chain;
    if (chain->loop_count > 0)
        note_loops(self, motion, output);
    if (!chain->has_springs)
        return;
    output->elastic += multibody_spring_energy(chain, motion->q);
    for (int e = 0; e < chain->element_count; e++)
        for (int k = 0; k < chain->u_length[e]; k++) {
            double rate = motion->u[chain->element_u[e] + k];
            output->power[MECHANISM_FRICTION] -= chain->element[e].damping[k] * rate * rate;
        }
}

// The wrench of the tube, and that of the wheels.
static void load_tube(const mechanism_system *self, const mechanism_input *input,
                      const force_sum *sum)
{
    const base_frame *tube = &sum->motion->tube;
    force_add(sum, &self->tube, tube->r, m3_apply(tube->A, input->tube_force),
              m3_apply(tube->A, input->tube_moment));
    if (self->wheels < 0)
        return;
    double *on = sum->wrench + 6 * self->wheels;
    v3_store(on, v3_add(v3_from(on), input->wheel_force));
    v3_store(on + 3, v3_add(v3_from(on + 3), input->wheel_moment));
}

// The carrier's acceleration in the place of its forces.
static void prescribe(const mechanism_system *self, const base_frame *carrier, double *tau)
{
    if (self->carrier < 0)
        return;
    double *to = tau + self->u_count;
    v3_store(to, carrier->a);
    v3_store(to + 3, m3_apply_transposed(carrier->A, carrier->alpha));
}

// Power of the carrier's joints: what its hinge transmits is what its bodies need.
static void note_carrier(const mechanism_system *self, const mechanism_motion *motion,
                         const double *u_dot, mechanism_output *output)
{
    double reaction[6 * MECHANISM_MOST_ELEMENTS];
    const base_frame *carrier = &motion->carrier;
    if (self->carrier < 0)
        return;
    ld_mstmm_reactions(self->chain, motion->q, motion->u, u_dot, output->wrench, reaction);
    const double *on = reaction + 6 * self->carrier;
    output->power[MECHANISM_CARRYING] +=
        v3_dot(v3_from(on), carrier->v) + v3_dot(v3_from(on + 3), carrier->w);
}

int mechanism_evaluate(const mechanism_system *self, const mechanism_input *input,
                       const double *state, const mechanism_motion *motion, double *state_dot,
                       mechanism_output *output)
{
    double tau[MECHANISM_MOST_SPEEDS], *wrench = output->wrench;
    double q_dot[MECHANISM_MOST_COORDINATES], u_dot[MECHANISM_MOST_SPEEDS];
    ld_mstmm *chain = self->chain;
    memset(tau, 0, (size_t)chain->u_count * sizeof *tau);
    memset(wrench, 0, 6 * (size_t)chain->element_count * sizeof *wrench);
    memset(output->power, 0, sizeof output->power);
    output->elastic = 0;
    multibody_move(chain, motion->q, motion->u);
    force_sum sum = {self, motion, wrench, output};
    v3 momentum = momentum_of(self, motion, output);
    output->power[MECHANISM_GRAVITY] = -self->model->gravity * momentum.y;
    note_springs(self, motion, output);
    load_holds(self, input, motion, state, state_dot, &sum, tau);
    load_joints(self, input, motion, tau, output);
    load_locks(self, motion, state, tau, output);
    load_tube(self, input, &sum);
    mechanism_add_bushings(&sum);
    mechanism_add_feet(&sum, state + self->feet_at, state_dot + self->feet_at);
    mechanism_add_loads(&sum, motion->t, input->density, input->wind);
    prescribe(self, &motion->carrier, tau);
    for (int k = 0; k < self->later_count; k++)
        state_dot[self->later[k].state] = 0;
    if (ld_mstmm_accelerations(chain, motion->q, motion->u, tau, wrench, u_dot, NULL))
        return 1;
    note_carrier(self, motion, u_dot, output);
    ld_mstmm_rates(chain, motion->q, motion->u, q_dot);
    memcpy(state_dot, q_dot, (size_t)self->q_count * sizeof *q_dot);
    memcpy(state_dot + self->q_count, u_dot, (size_t)self->u_count * sizeof *u_dot);
    for (int k = 0; k < self->u_count; k++)
        if (!isfinite(u_dot[k]))
            return 1;
    return 0;
}
