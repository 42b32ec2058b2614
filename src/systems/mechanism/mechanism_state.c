#include "systems/mechanism/mechanism_state.h"

#include <stdio.h>
#include <string.h>

#include "base/random.h"
#include "math/functions.h"
#include "model/model.h"
#include "systems/mechanism/mechanism_motion.h"
#include "systems/multibody/multibody.h"

// How the coordinates of an element are counted: slides, then a quaternion or single turns.
typedef struct hinge_parts {
    int slides;
    bool quaternion;
} hinge_parts;

static hinge_parts parts_of(ld_hinge hinge)
{
    return (hinge_parts){hinge == LD_HINGE_FREE ? 3 : 0,
                         hinge == LD_HINGE_FREE || hinge == LD_HINGE_SPHERICAL};
}

const flexible_tube *mechanism_beam(const mechanism_system *self, int number)
{
    int element = self->given->body_count + number;
    return &self->chain->beams[self->chain->element_beam[element]].tube;
}

int mechanism_beam_at(const mechanism_system *self, int number)
{
    int element = self->given->body_count + number;
    return self->chain->element_q[element] + self->chain->q_length[element];
}

void mechanism_start(const mechanism_system *self, double *state)
{
    const ld_mstmm *chain = self->chain;
    double q[MECHANISM_MOST_COORDINATES];
    memset(state, 0, (size_t)self->state_count * sizeof *state);
    ld_mstmm_reference(chain, q);
    for (int i = 0; i < self->given->joint_count; i++) {
        const ld_joint *joint = &self->given->joint[i];
        if (self->joint_element[i] < 0)
            continue;
        double *at = q + ld_mstmm_coordinate_offset(chain, self->joint_element[i]);
        if (joint->kind == LD_JOINT_PRISMATIC || joint->kind == LD_JOINT_CYLINDRICAL)
            *at++ = joint->displacement;
        if (joint->kind == LD_JOINT_REVOLUTE || joint->kind == LD_JOINT_CYLINDRICAL ||
            joint->kind == LD_JOINT_UNIVERSAL)
            *at++ = joint->angle;
        if (joint->kind == LD_JOINT_UNIVERSAL)
            *at = joint->angle_2;
    }
    memcpy(state, q, (size_t)self->q_count * sizeof *state);
}

void mechanism_complete(mechanism_system *self, const base_frame *carrier, const double *state)
{
    mechanism_motion motion;
    mechanism_move(self, 0, carrier, state, &motion);
    for (int i = 0; i < self->given->strut_count; i++) {
        strut_line line;
        mechanism_strut_line(&motion, &self->strut[i], &line);
        double length = self->given->strut[i].length;
        self->strut[i].length = isnan(length) ? line.length : length;
    }
    for (int i = 0; i < self->given->bushing_count; i++) {
        mechanism_bushing *bushing = &self->bushing[i];
        body_motion from = mechanism_point_motion(&motion, &bushing->from);
        body_motion to = mechanism_point_motion(&motion, &bushing->to);
        if (isnan(self->given->bushing[i].to_at[0]))
            bushing->to.at = m3_apply_transposed(to.A, v3_sub(from.r, to.r));
        bushing->turned = m3_mul(m3_transpose(to.A), from.A);
    }
    for (int i = 0; i < self->given->foot_count; i++)
        self->anchor[i] = mechanism_point_motion(&motion, &self->foot[i]).r;
}

ld_status mechanism_check_struts(const mechanism_system *self, const base_frame *carrier,
                                 const double *state, ld_error *error)
{
    mechanism_motion motion;
    mechanism_move(self, 0, carrier, state, &motion);
    for (int i = 0; i < self->given->strut_count; i++) {
        const ld_strut *strut = &self->given->strut[i];
        strut_line line;
        mechanism_strut_line(&motion, &self->strut[i], &line);
        if (!(line.length > 1e-6))
            return ld_fail(error, LD_ERR_INPUT,
                           "base.struts.%s: its ends on \"%s\" and \"%s\" coincide at the start; "
                           "expected a distance along which it acts",
                           strut->name, strut->from, strut->to);
    }
    return LD_OK;
}

mechanism_axis mechanism_axis_of(const mechanism_system *self, int speed)
{
    int i = 0, element = 0;
    while (element + 1 < self->element_count && self->chain->element_u[element + 1] <= speed)
        element++;
    while (i + 1 < self->given->joint_count && self->joint_element[i] != element)
        i++;
    static const int slides[] = {[LD_JOINT_PRISMATIC] = 1,
                                 [LD_JOINT_CYLINDRICAL] = 1,
                                 [LD_JOINT_PLANAR] = 2,
                                 [LD_JOINT_FREE] = 3};
    const ld_joint *joint = &self->given->joint[i];
    return (mechanism_axis){joint, speed - self->chain->element_u[element] >= slides[joint->kind]};
}

void mechanism_plant(const mechanism_system *self, const base_frame *carrier, double *state)
{
    mechanism_motion motion;
    if (self->given->foot_count == 0)
        return;
    mechanism_move(self, 0, carrier, state, &motion);
    for (int i = 0; i < self->given->foot_count; i++) {
        v3 moved = v3_sub(mechanism_point_motion(&motion, &self->foot[i]).r, self->anchor[i]);
        state[self->feet_at + 2 * i] = moved.x;
        state[self->feet_at + 2 * i + 1] = moved.z;
    }
}

void mechanism_displace(const mechanism_system *self, int k, double change, double *state)
{
    const ld_mstmm *chain = self->chain;
    int e = 0;
    while (e + 1 < chain->element_count && chain->element_u[e + 1] <= k)
        e++;
    // elements without speeds share the offset of the next one
    hinge_parts parts = parts_of(chain->element[e].hinge);
    double *q = state + chain->element_q[e];
    int own = k - chain->element_u[e], hinge = chain->u_length[e];
    if (own >= hinge) {
        q[chain->q_length[e] + own - hinge] += change;
    } else if (!parts.quaternion || own < parts.slides) {
        q[own] += change;
    } else {
        double axis[3] = {0};
        axis[own - parts.slides] = sin(0.5 * change);
        quat turn = {cos(0.5 * change), axis[0], axis[1], axis[2]};
        quat now = q_multiply(q_from(q + parts.slides), turn);
        memcpy(q + parts.slides, &now, sizeof now);
    }
}

void mechanism_tolerances(const mechanism_system *self, double tolerance, double *atol,
                          bool *absolute)
{
    const ld_mstmm *chain = self->chain;
    for (int i = 0; i < self->z_at; i++)
        atol[i] = i < self->q_count ? 1e-2 * tolerance : tolerance;
    for (int i = self->z_at; i < self->z_at + self->hold_count; i++)
        atol[i] = 1e2 * tolerance; // torques
    for (int i = 0; i < self->hold_count && self->hold[i].drive >= 0; i++) {
        double *drive = atol + self->hold[i].drive;
        for (int k = 0; k < DRIVE_STATES; k++)
            drive[k] = 1e2 * tolerance;
        drive[DRIVE_TWIST] = 1e-2 * tolerance;
        drive[DRIVE_RATE] = tolerance;
    }
    for (int i = self->feet_at; i < self->state_count; i++)
        atol[i] = 1e-2 * tolerance;
    // places of free bodies: they may be far from the origin
    for (int e = 0; e < self->element_count; e++)
        for (int k = 0; k < 3 && e != self->carrier && chain->element[e].hinge == LD_HINGE_FREE;
             k++)
            absolute[chain->element_q[e] + k] = true;
}

void mechanism_start_speeds(const mechanism_system *self, double *state)
{
    double *u = state + self->q_count;
    for (int i = 0; i < self->given->joint_count; i++) {
        const ld_joint *joint = &self->given->joint[i];
        if (self->joint_element[i] < 0)
            continue;
        double *at = u + ld_mstmm_speed_offset(self->chain, self->joint_element[i]);
        if (joint->kind == LD_JOINT_PRISMATIC || joint->kind == LD_JOINT_CYLINDRICAL)
            *at++ = joint->speed;
        if (joint->kind == LD_JOINT_REVOLUTE || joint->kind == LD_JOINT_CYLINDRICAL)
            *at = joint->rate;
    }
}

void mechanism_set_off(const mechanism_system *self, double *state)
{
    for (int i = 0; i < self->hold_count && self->hold[i].drive >= 0; i++)
        if (self->hold[i].control)
            stabiliser_rest(self->hold[i].control, state[self->z_at + i],
                            state + self->hold[i].drive);
}

// The first row of a table over time after t.
static double corner_after(const ld_table *table, double t)
{
    for (size_t i = 0; i < table->rows && table->rows > 1; i++)
        if (table->data[i * table->columns] > t)
            return table->data[i * table->columns];
    return INFINITY;
}

double mechanism_next_corner(const mechanism_system *self, double t)
{
    double next = INFINITY;
    for (int i = 0; i < self->hold_count; i++)
        if (self->hold[i].control)
            next = fmin(next, corner_after(&self->hold[i].control->command, t));
    for (int i = 0; i < self->given->load_count; i++) {
        next = fmin(next, corner_after(&self->given->load[i].force, t));
        next = fmin(next, corner_after(&self->given->load[i].moment, t));
    }
    return next;
}

static double next_of_hold(const mechanism_hold *hold, double t)
{
    return hold->lock || !hold->control ? INFINITY : stabiliser_next_sample(hold->control, t);
}

double mechanism_next_sample(const mechanism_system *self, double t)
{
    double next = INFINITY;
    for (int i = 0; i < self->hold_count; i++)
        next = fmin(next, next_of_hold(&self->hold[i], t));
    for (int k = 0; k < self->later_count; k++) {
        double from = self->given->joint[self->later[k].joint].lock.from;
        if (from > t)
            next = fmin(next, from);
    }
    return next;
}

void mechanism_sample(const mechanism_system *self, const mechanism_motion *motion, double *state)
{
    double t = motion->t, before = nextafter(t, -INFINITY);
    for (int i = 0; i < self->hold_count; i++) {
        const mechanism_hold *hold = &self->hold[i];
        if (next_of_hold(hold, before) != t)
            continue;
        hinge_report report;
        mechanism_watch(self, i, motion, &report);
        stabiliser_sample(hold->control, t, random_stream(hold->stream), &report,
                          state + self->z_at + i, state + hold->drive);
    }
    for (int k = 0; k < self->later_count; k++)
        if (self->given->joint[self->later[k].joint].lock.from == t)
            state[self->later[k].state] = state[self->later[k].q];
}

int mechanism_rolling(const mechanism_system *self)
{
    const ld_mstmm *chain = self->chain;
    bool rolls = self->wheels >= 0 && chain->element[self->wheels].hinge == LD_HINGE_FREE;
    return rolls ? chain->element_u[self->wheels] : -1;
}

double mechanism_inertia(const mechanism_system *self, const double *state, int k, int *body)
{
    ld_mstmm *chain = self->chain;
    double u[MECHANISM_MOST_SPEEDS] = {0}, q[MECHANISM_MOST_COORDINATES];
    int e = 0;
    while (e + 1 < chain->element_count && chain->element_u[e + 1] <= k)
        e++;
    *body = e;
    ld_mstmm_reference(chain, q);
    memcpy(q, state, (size_t)self->q_count * sizeof *q);
    u[k] = 1;
    return 2 * ld_mstmm_energy(chain, q, u).kinetic;
}
