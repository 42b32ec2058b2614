#include "systems/mechanism/mechanism_motion.h"

#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "systems/multibody/loop_rows.h"
#include "systems/multibody/multibody.h"

static const double PI = 3.141592653589793238462643383280;

// ---- motion

body_motion mechanism_point_motion(const mechanism_motion *motion, const mechanism_point *point)
{
    if (point->element == MECHANISM_GROUND)
        return (body_motion){.r = point->at, .A = point->axes};
    body_motion of;
    if (point->element == MECHANISM_CARRIER) {
        const base_frame *carrier = &motion->carrier;
        of = (body_motion){carrier->r, carrier->v, carrier->A, carrier->w};
    } else {
        of = motion->body[point->element];
    }
    v3 arm = m3_apply(of.A, point->at);
    return (body_motion){v3_add(of.r, arm), v3_add(of.v, v3_cross(of.w, arm)),
                         m3_mul(of.A, point->axes), of.w};
}

void mechanism_gather(const mechanism_system *self, const base_frame *carrier, const double *state,
                      double *q, double *u)
{
    memcpy(q, state, (size_t)self->q_count * sizeof *state);
    memcpy(u, state + self->q_count, (size_t)self->u_count * sizeof *state);
    if (self->carrier < 0)
        return;
    v3_store(q + self->q_count, carrier->r);
    memcpy(q + self->q_count + 3, &carrier->q, 4 * sizeof *q);
    v3_store(u + self->u_count, carrier->v);
    v3_store(u + self->u_count + 3, m3_apply_transposed(carrier->A, carrier->w));
}

body_motion mechanism_body_motion(const mechanism_system *self, int element)
{
    const ld_mstmm *chain = self->chain;
    int i = chain->element_node[element];
    return (body_motion){chain->place[i].linear, chain->place[i].angular,
                         self->straight[element] ? node_axes(chain, i) : node_body_axes(chain, i),
                         v4d_v3(chain->motion[i].w)};
}

static void move_chain(ld_mstmm *chain, const mechanism_motion *motion)
{
    multibody_move(chain, motion->q, motion->u);
    multibody_place(chain, motion->u);
}

void mechanism_stand(const mechanism_system *self, const mechanism_motion *motion)
{
    if (motion->chain != self->chain || motion->move != self->chain->moves)
        move_chain(self->chain, motion);
}

static base_frame frame_of(const mechanism_system *self, const mechanism_motion *motion)
{
    const body_motion *body = &motion->body[self->tube.element];
    v3 arm = m3_apply(body->A, self->tube.at);
    m3 A = self->tube_turned ? m3_mul(body->A, self->tube.axes) : body->A;
    return (base_frame){.r = v3_add(body->r, arm),
                        .v = v3_add(body->v, v3_cross(body->w, arm)),
                        .A = A,
                        .q = q_from_matrix(A),
                        .w = body->w};
}

static base_frame station_frame(const mechanism_motion *motion, const mechanism_point *point)
{
    body_motion of = mechanism_point_motion(motion, point);
    return (base_frame){.r = of.r, .v = of.v, .A = of.A, .q = q_from_matrix(of.A), .w = of.w};
}

void mechanism_move(const mechanism_system *self, double t, const base_frame *carrier,
                    const double *state, mechanism_motion *motion)
{
    motion->t = t;
    motion->carrier = *carrier;
    mechanism_gather(self, carrier, state, motion->q, motion->u);
    move_chain(self->chain, motion);
    motion->chain = self->chain;
    motion->move = self->chain->moves;
    for (int k = 0; k < self->seen_count; k++)
        motion->body[self->seen[k]] = mechanism_body_motion(self, self->seen[k]);
    motion->tube = frame_of(self, motion);
    for (int k = 0; k < self->station_count; k++)
        motion->station[k] = station_frame(motion, &self->station[k]);
}

// ---- struts

void mechanism_strut_line(const mechanism_motion *motion, const mechanism_strut *strut,
                          strut_line *line)
{
    line->from = mechanism_point_motion(motion, &strut->from);
    line->to = mechanism_point_motion(motion, &strut->to);
    v3 arm = v3_sub(line->to.r, line->from.r);
    line->length = v3_norm(arm);
    line->e = v3_scale(1 / line->length, arm);
    line->rate = v3_dot(line->e, v3_sub(line->to.v, line->from.v));
}

// ---- holds

// Value and its rate at time t: linear between the table's rows, from a row's time on the slope
// behind it; constant outside.
static double command_at(const ld_table *table, double t, double *rate)
{
    const double *row = table->data;
    size_t n = table->columns, first = 0, end = table->rows;
    *rate = 0;
    if (t < row[0])
        return row[1];
    // the last row at or before t
    while (end - first > 1) {
        size_t middle = (first + end) / 2;
        if (t >= row[middle * n])
            first = middle;
        else
            end = middle;
    }
    row += first * n;
    if (end == table->rows)
        return row[1];
    *rate = (row[n + 1] - row[1]) / (row[n] - row[0]);
    return row[1] + *rate * (t - row[0]);
}

double mechanism_command(const mechanism_hold *hold, double t, double *rate)
{
    *rate = 0;
    return hold->control ? command_at(&hold->control->command, t, rate) : hold->command;
}

// Into [-pi, pi].
static double wrapped(double angle)
{
    return fabs(angle) > PI ? remainder(angle, 2 * PI) : angle;
}

// Yaw or pitch of an x axis d, of unit length, and their rates under d_dot = w x d (model.md,
// section 1).
static void measure(v3 d, v3 w, bool pitch, hinge_report *report)
{
    v3 d_dot = v3_cross(w, d);
    double square = d.x * d.x + d.z * d.z, level = sqrt(square);
    report->measured = pitch ? atan2(d.y, level) : atan2(-d.z, d.x);
    report->measured_rate = pitch ? d_dot.y / level : (d.z * d_dot.x - d.x * d_dot.z) / square;
}

// Rate about its axis of what carries a joint: of its body, less its own.
static double rate_of_carrier(const mechanism_system *self, const mechanism_hold *hold,
                              const mechanism_motion *motion)
{
    if (hold->strut >= 0)
        return 0;
    const ld_mstmm *chain = self->chain;
    int element = self->joint_element[hold->joint];
    v3 axis = v4d_v3(chain->motion[chain->element_node[element]].A[2]);
    bool turns = self->given->joint[hold->joint].kind == LD_JOINT_REVOLUTE;
    return v3_dot(motion->body[element].w, axis) - (turns ? motion->u[hold->u] : 0);
}

void mechanism_watch(const mechanism_system *self, int index, const mechanism_motion *motion,
                     hinge_report *report)
{
    const mechanism_hold *hold = &self->hold[index];
    if (hold->strut >= 0) {
        strut_line line;
        mechanism_strut_line(motion, &self->strut[hold->strut], &line);
        report->angle = line.length;
        report->rate = line.rate;
    } else {
        report->angle = motion->q[hold->q];
        report->rate = motion->u[hold->u];
    }
    report->base_rate = rate_of_carrier(self, hold, motion);
    report->measured = report->angle;
    report->measured_rate = report->rate;
    if (hold->follows != LD_FOLLOWS_JOINT) {
        bool pitch = hold->follows == LD_FOLLOWS_PITCH;
        if (hold->of < 0)
            measure(m3_column(motion->tube.A, 0), motion->tube.w, pitch, report);
        else
            measure(m3_column(motion->body[hold->of].A, 0), motion->body[hold->of].w, pitch,
                    report);
    }
    report->command = mechanism_command(hold, motion->t, &report->command_rate);
    report->error = report->command - report->measured;
    if (hold->follows != LD_FOLLOWS_JOINT)
        report->error = wrapped(report->error);
}
