#include "systems/mechanism/mechanism_forces.h"

#include "math/functions.h"
#include "math/vectors/rotation_vector.h"
#include "model/model.h"

void force_add(const force_sum *sum, const mechanism_point *point, v3 r, v3 force, v3 moment)
{
    if (point->element == MECHANISM_GROUND)
        return;
    if (point->element == MECHANISM_CARRIER) {
        const base_frame *carrier = &sum->motion->carrier;
        v3 v = v3_add(carrier->v, v3_cross(carrier->w, v3_sub(r, carrier->r)));
        sum->output->power[MECHANISM_CARRYING] -= v3_dot(force, v) + v3_dot(moment, carrier->w);
        return;
    }
    double *to = sum->wrench + 6 * point->element;
    v3 arm = v3_sub(r, sum->motion->body[point->element].r);
    v3_store(to, v3_add(v3_from(to), force));
    v3_store(to + 3, v3_add(v3_from(to + 3), v3_add(moment, v3_cross(arm, force))));
}

// ---- bushings

// Of one axis: force, what it stores, what its damper takes.
typedef struct axis_force {
    double force;  // [N]
    double stored; // [J]
    double power;  // [W]
} axis_force;

// At displacement d and rate v.
static axis_force bushing_axis(const ld_bushing *given, int i, double d, double v)
{
    double over = fabs(d) - given->clearance[i];
    axis_force sum = {0};
    if (over > 0 || given->clearance[i] == 0) {
        double bent = copysign(over, d), damper = given->damping[i] * v;
        sum.force = -given->stiffness[i] * bent - damper;
        sum.stored = 0.5 * given->stiffness[i] * bent * bent;
        sum.power = -damper * v;
    }
    double beyond = fabs(d) - given->stop[i]; // NaN: there is none
    if (beyond > 0) {
        sum.force -= copysign(given->stop_stiffness[i] * beyond, d);
        sum.stored += 0.5 * given->stop_stiffness[i] * beyond * beyond;
    }
    return sum;
}

// Force in the bushing's axes on `to`; stores and powers are added.
static v3 bushing_force(const force_sum *sum, const ld_bushing *given, v3 d, v3 d_dot)
{
    axis_force x = bushing_axis(given, 0, d.x, d_dot.x), y = bushing_axis(given, 1, d.y, d_dot.y),
               z = bushing_axis(given, 2, d.z, d_dot.z);
    sum->output->elastic += x.stored + y.stored + z.stored;
    sum->output->power[MECHANISM_BUSHINGS] += x.power + y.power + z.power;
    return v3_make(x.force, y.force, z.force);
}

static v3 bushing_moment(const force_sum *sum, const ld_bushing *given, v3 phi, v3 w)
{
    v3 spring = v3_mul(v3_from(given->rotational_stiffness), phi);
    v3 damper = v3_mul(v3_from(given->rotational_damping), w);
    sum->output->elastic += 0.5 * v3_dot(phi, spring);
    sum->output->power[MECHANISM_BUSHINGS] -= v3_dot(damper, w);
    return v3_neg(v3_add(rv_left_jacobian_inverse_transposed(phi, spring), damper));
}

static void add_bushing(const force_sum *sum, int index)
{
    const ld_bushing *given = &sum->self->given->bushing[index];
    const mechanism_bushing *bushing = &sum->self->bushing[index];
    body_motion from = mechanism_point_motion(sum->motion, &bushing->from);
    body_motion to = mechanism_point_motion(sum->motion, &bushing->to);
    v3 arm = v3_sub(to.r, from.r);
    v3 drift = v3_sub(v3_sub(to.v, from.v), v3_cross(from.w, arm));
    v3 f = bushing_force(sum, given, m3_apply_transposed(from.A, arm),
                         m3_apply_transposed(from.A, drift));
    v3 phi = rv_log(m3_mul(m3_transpose(from.A), m3_mul(to.A, bushing->turned)));
    v3 m = bushing_moment(sum, given, phi, m3_apply_transposed(from.A, v3_sub(to.w, from.w)));
    sum->output->report.bushing[index] = f;
    v3 force = m3_apply(from.A, f), moment = m3_apply(from.A, m);
    force_add(sum, &bushing->to, to.r, force, moment);
    force_add(sum, &bushing->from, to.r, v3_neg(force), v3_neg(moment));
}

void mechanism_add_bushings(const force_sum *sum)
{
    for (int i = 0; i < sum->self->given->bushing_count; i++)
        add_bushing(sum, i);
}

// ---- struts

void mechanism_add_struts(const force_sum *sum, const double *push)
{
    for (int i = 0; i < sum->self->given->strut_count; i++) {
        const ld_strut *given = &sum->self->given->strut[i];
        const mechanism_strut *strut = &sum->self->strut[i];
        strut_line line;
        mechanism_strut_line(sum->motion, strut, &line);
        double bent = line.length - strut->length;
        double force = given->preload - given->stiffness * bent - given->damping * line.rate;
        sum->output->elastic += bent * (0.5 * given->stiffness * bent - given->preload);
        sum->output->power[MECHANISM_BUSHINGS] -= given->damping * line.rate * line.rate;
        sum->output->report.strut[i] = (strut_report){line.length, line.rate, force};
        v3 on_to = v3_scale(force + push[i], line.e);
        force_add(sum, &strut->to, line.to.r, on_to, v3_zero());
        force_add(sum, &strut->from, line.from.r, v3_neg(on_to), v3_zero());
    }
}

// ---- feet

// What the ground remembers of a foot in the air fades so fast [1/s].
static const double LIFTED = 50;

static v3 foot_force(const ld_foot *given, const body_motion *foot, const double *deflected,
                     foot_report *report)
{
    double p = given->height - foot->r.y, p_dot = -foot->v.y;
    double normal = given->stiffness[1] * p + given->damping[1] * p_dot;
    normal = p > 0 && normal > 0 ? normal : 0;
    double x = -given->stiffness[0] * deflected[0] - given->damping[0] * foot->v.x;
    double z = -given->stiffness[2] * deflected[1] - given->damping[2] * foot->v.z;
    double limit = given->friction * normal;
    double share = limit > 0 ? 1 / sqrt(1 + (x * x + z * z) / (limit * limit)) : 0;
    report->deflection = p;
    report->normal = normal;
    report->force = v3_make(share * x, normal, share * z);
    return report->force;
}

void mechanism_add_feet(const force_sum *sum, const double *state, double *state_dot)
{
    for (int i = 0; i < sum->self->given->foot_count; i++) {
        const mechanism_point *point = &sum->self->foot[i];
        body_motion foot = mechanism_point_motion(sum->motion, point);
        foot_report *report = &sum->output->report.foot[i];
        v3 force = foot_force(&sum->self->given->foot[i], &foot, state + 2 * i, report);
        // in the air the ground has nothing to remember
        bool down = report->deflection > 0;
        state_dot[2 * i] = down ? foot.v.x : -LIFTED * state[2 * i];
        state_dot[2 * i + 1] = down ? foot.v.z : -LIFTED * state[2 * i + 1];
        sum->output->power[MECHANISM_FEET] += v3_dot(force, foot.v);
        force_add(sum, point, foot.r, force, v3_zero());
    }
}

// ---- loads

// Linear between the rows of a table over time, constant outside.
static v3 load_at(const ld_table *table, double t)
{
    if (table->rows == 0)
        return v3_zero();
    size_t i = 0;
    while (i + 1 < table->rows && table->data[4 * (i + 1)] <= t)
        i++;
    const double *row = table->data + 4 * i;
    v3 value = v3_from(row + 1);
    if (i + 1 == table->rows || t <= row[0])
        return value;
    double share = (t - row[0]) / (row[4] - row[0]);
    return v3_axpy(value, share, v3_sub(v3_from(row + 5), value));
}

static void add_load(const force_sum *sum, int index, double t)
{
    const ld_point_load *given = &sum->self->given->load[index];
    const mechanism_point *point = &sum->self->load[index];
    body_motion at = mechanism_point_motion(sum->motion, point);
    v3 force = load_at(&given->force, t), moment = load_at(&given->moment, t);
    if (given->axes == LD_LOAD_IN_BODY) {
        force = m3_apply(at.A, force);
        moment = m3_apply(at.A, moment);
    }
    sum->output->power[MECHANISM_LOADS] += v3_dot(force, at.v) + v3_dot(moment, at.w);
    force_add(sum, point, at.r, force, moment);
}

static void add_drag(const force_sum *sum, int index, double density, v3 wind)
{
    const mechanism_point *point = &sum->self->drag[index];
    body_motion at = mechanism_point_motion(sum->motion, point);
    v3 v = m3_apply_transposed(at.A, v3_sub(wind, at.v));
    double q = 0.5 * density * v3_norm(v);
    v3 area = v3_from(sum->self->given->drag[index].area);
    v3 force = m3_apply(at.A, v3_scale(q, v3_mul(area, v)));
    sum->output->power[MECHANISM_LOADS] += v3_dot(force, at.v);
    force_add(sum, point, at.r, force, v3_zero());
}

void mechanism_add_loads(const force_sum *sum, double t, double density, v3 wind)
{
    for (int i = 0; i < sum->self->given->load_count; i++)
        add_load(sum, i, t);
    for (int i = 0; i < sum->self->given->drag_count; i++)
        add_drag(sum, i, density, wind);
}
