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

// Friction and stops of the joints with one axis.
static void load_joints(const mechanism_system *self, const mechanism_input *input,
                        const mechanism_motion *motion, double *tau, mechanism_output *output)
{
    memset(output->report.friction, 0,
           (size_t)self->given->joint_count * sizeof *output->report.friction);
    for (int k = 0; k < self->axis_count; k++) {
        const single_axis *axis = &self->axis[k];
        const ld_joint *joint = &self->given->joint[axis->joint];
        if (!axis->resists)
            continue;
        double rate = motion->u[axis->u];
        double friction = input->held ? 0 : friction_of(joint, input->linear, rate);
        tau[axis->u] += friction + stop_force(&joint->stops, motion->q[axis->q], rate, output);
        output->power[MECHANISM_FRICTION] += friction * rate;
        output->report.friction[axis->joint] = friction;
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

static void load_holds(const mechanism_input *input, const double *state, double *state_dot,
                       force_sum *sum, double *tau)
{
    const mechanism_system *self = sum->self;
    double push[LD_MAX_STRUTS] = {0};
    for (int i = 0; i < self->hold_count; i++) {
        const mechanism_hold *hold = &self->hold[i];
        hinge_report *report = &sum->output->report.hold[i];
        mechanism_watch(self, i, sum->motion, report);
        if (input->command) {
            report->command += input->command[i];
            report->command_rate += input->rate[i];
            report->error += input->command[i];
        }
        drive_hold(self, i, input, state, report, state_dot);
        if (hold->strut >= 0)
            push[hold->strut] += report->torque;
        else
            tau[hold->u] += report->torque;
        sum->output->power[MECHANISM_HOLDS] += report->torque * report->rate;
    }
    mechanism_add_struts(sum, push);
}

// What a beam stores and its damping takes; its momentum [kg m/s] in I.
static v4d note_beam(const ld_mstmm *chain, int i, const mechanism_motion *motion,
                     mechanism_output *output)
{
    const node_beam *b = &chain->beam_of[i];
    const double *q = motion->q + b->modes_q, *q_dot = motion->u + b->modes_u;
    m3 A = node_body_axes(chain, i);
    spatial p = beam_momentum(b->body, m3_apply_transposed(A, chain->place[i].angular), q_dot);
    output->power[MECHANISM_BEAMS] += tube_damping_power(&b->body->tube, q_dot);
    output->elastic += tube_elastic_energy(&b->body->tube, q);
    return v4d_from_v3(m3_apply(A, p.linear));
}

// Momentum [kg m/s] in I of all bodies, from the motion in the workspace.
static v3 momentum_of(const mechanism_system *self, const mechanism_motion *motion,
                      mechanism_output *output)
{
    const ld_mstmm *chain = self->chain;
    v4d sum = v4d_all(0);
    for (int e = 0; e < self->element_count; e++) {
        int i = chain->element_node[e];
        const node_inertia *body = &chain->inertia[i];
        const node_motion *move = &chain->motion[i];
        if (chain->node[i].body == NODE_BEAM) {
            sum += note_beam(chain, i, motion, output);
        } else if (body->mass > 0) {
            v4d center = v4d_combine(move->A, body->moment.x, body->moment.y, body->moment.z);
            sum += v4d_all(body->mass) * v4d_from_v3(chain->place[i].angular) +
                   v4d_cross(move->w, center);
        }
    }
    return v4d_v3(sum);
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
    for (int k = 0; k < self->station_count && input->station; k++) {
        const base_frame *station = &sum->motion->station[k];
        force_add(sum, &self->station[k], station->r, m3_apply(station->A, input->station[k].f),
                  m3_apply(station->A, input->station[k].m));
    }
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

// Accelerations of the chain, by the form that is asked for.
static ld_status accelerate(const mechanism_system *self, const mechanism_motion *motion,
                            const double *tau, double *u_dot, mechanism_output *output)
{
    const double *q = motion->q, *u = motion->u, *wrench = output->wrench;
    if (!self->overall)
        return multibody_accelerate(self->chain, q, u, &(multibody_load){tau, wrench}, u_dot, NULL);
    ld_mstmm_overall report = {0};
    ld_status status = ld_mstmm_accelerations_overall(self->chain, LD_MSTMM_PAPER, q, u, tau,
                                                      wrench, u_dot, &report, NULL);
    output->loss = report.loss;
    return status;
}

// Rates of coordinates and speeds.
static int find_rates(const mechanism_system *self, const mechanism_motion *motion,
                      const double *tau, double *state_dot, mechanism_output *output)
{
    double q_dot[MECHANISM_MOST_COORDINATES], u_dot[MECHANISM_MOST_SPEEDS];
    if (accelerate(self, motion, tau, u_dot, output))
        return 1;
    note_carrier(self, motion, u_dot, output);
    ld_mstmm_rates(self->chain, motion->q, motion->u, q_dot);
    memcpy(state_dot, q_dot, (size_t)self->q_count * sizeof *q_dot);
    memcpy(state_dot + self->q_count, u_dot, (size_t)self->u_count * sizeof *u_dot);
    for (int k = 0; k < self->u_count; k++)
        if (!isfinite(u_dot[k]))
            return 1;
    return 0;
}

int mechanism_evaluate(const mechanism_system *self, const mechanism_input *input,
                       const double *state, const mechanism_motion *motion, double *state_dot,
                       mechanism_output *output)
{
    double tau[MECHANISM_MOST_SPEEDS], *wrench = output->wrench;
    const ld_mstmm *chain = self->chain;
    memset(tau, 0, (size_t)chain->u_count * sizeof *tau);
    memset(wrench, 0, 6 * (size_t)chain->element_count * sizeof *wrench);
    memset(output->power, 0, sizeof output->power);
    output->elastic = output->loss = 0;
    mechanism_stand(self, motion);
    force_sum sum = {self, motion, wrench, output};
    v3 momentum = momentum_of(self, motion, output);
    output->power[MECHANISM_GRAVITY] = -self->model->gravity * momentum.y;
    note_springs(self, motion, output);
    load_holds(input, state, state_dot, &sum, tau);
    load_joints(self, input, motion, tau, output);
    load_locks(self, motion, state, tau, output);
    load_tube(self, input, &sum);
    mechanism_add_bushings(&sum);
    mechanism_add_feet(&sum, state + self->feet_at, state_dot + self->feet_at);
    mechanism_add_loads(&sum, motion->t, input->density, input->wind);
    prescribe(self, &motion->carrier, tau);
    for (int k = 0; k < self->later_count; k++)
        state_dot[self->later[k].state] = 0;
    return find_rates(self, motion, tau, state_dot, output);
}
