#include "systems/mechanism/marching.h"

// What all wheels share at one instant. e_f = (x, 0, z) is the chassis' x axis made horizontal,
// e_s = (-z, 0, x).
typedef struct carrier {
    const base_frame *frame;
    double x, z;
    double drive; // [N] on each driven wheel
    const road_disturbance *disturbed;
} carrier;

ld_status marching_build(marching_system *self, const ld_vehicle *model, double gravity,
                         const double stretch[2], road **kept, ld_error *error)
{
    *self = (marching_system){
        .model = model,
        .gravity = gravity,
        .wheel_count = model->wheel_count,
        .parked = model->speed == 0,
        .state_count = WHEEL_STATES * model->wheel_count + 1,
    };
    for (int j = 0; j < self->wheel_count; j++) {
        self->right[j] = road_right_share(&model->road, model->wheel[j].mount[2]);
        self->driven_count += model->wheel[j].driven;
    }
    if (kept) {
        self->road = *kept;
        *kept = NULL;
    }
    return road_renew(&self->road, &model->road, stretch[0], stretch[1], error);
}

void marching_free(marching_system *self)
{
    road_free(self->road);
    *self = (marching_system){0};
}

// Force of a bump stop on the wheel along the chassis' y axis at travel y; its energy is added.
static double bump_stop_force(const ld_suspension *suspension, double y, double *energy)
{
    // not given (NaN): never beyond it
    double k = suspension->bump_stop.stiffness, beyond = 0;
    if (y > suspension->bump_stop.compression)
        beyond = y - suspension->bump_stop.compression;
    else if (y < -suspension->bump_stop.extension)
        beyond = y + suspension->bump_stop.extension;
    else
        return 0;
    *energy += 0.5 * k * beyond * beyond;
    return -k * beyond;
}

// Force of the suspension on wheel j in I; opposite on the chassis at the wheel's centre.
static v3 suspension_force(const marching_system *self, const base_frame *chassis, int j, v3 r,
                           v3 v, marching_output *output)
{
    const ld_suspension *suspension = &self->model->suspension;
    wheel_report *report = &output->wheel[j];
    // d and the derivative of these coordinates, the chassis' rotation included
    v3 arm = v3_sub(r, chassis->r);
    v3 drift = v3_sub(v3_sub(v, chassis->v), v3_cross(chassis->w, arm));
    v3 d = v3_sub(m3_apply_transposed(chassis->A, arm), v3_from(self->model->wheel[j].mount));
    v3 d_dot = m3_apply_transposed(chassis->A, drift);

    v3 spring = v3_mul(v3_from(suspension->stiffness), d);
    v3 damper = v3_mul(v3_from(suspension->damping), d_dot);
    output->elastic += 0.5 * v3_dot(spring, d);
    output->power[MARCHING_SUSPENSION] -= v3_dot(damper, d_dot);
    report->travel = d;
    report->travel_rate = d_dot;
    report->suspension = v3_neg(v3_add(spring, damper));
    report->suspension.y += bump_stop_force(suspension, d.y, &output->elastic);

    v3 force = m3_apply(chassis->A, report->suspension);
    output->force = v3_sub(output->force, force);
    output->moment = v3_sub(output->moment, v3_cross(arm, force));
    return force;
}

// Force of the road on wheel j in I, all at the contact point c = (x, h, z): on the wheel's mass,
// its moment (c - r) x f on the chassis. Rates of eta and xi.
static v3 tyre_force(const marching_system *self, const carrier *on, int j, const double *wheel,
                     double *wheel_dot, marching_output *output)
{
    const ld_tyre *tyre = &self->model->tyre;
    wheel_report *report = &output->wheel[j];
    v3 r = v3_from(wheel + WHEEL_R), v = v3_from(wheel + WHEEL_V), w = on->frame->w;

    // vertical, also on a slope
    double h = road_height_between(self->road, self->right[j], r.x, &report->slope);
    double h_dot = report->slope * v.x;
    if (on->disturbed) {
        h += on->disturbed->height[j];
        h_dot += on->disturbed->rate[j];
    }
    double p = h + tyre->radius - r.y, p_dot = h_dot - v.y;
    double normal = tyre->stiffness[1] * p + tyre->damping[1] * p_dot;
    normal = p > 0 && normal > 0 ? normal : 0;
    report->height = h;
    report->deflection = p;
    report->normal = normal;

    // velocity of the carrier's material at c, along and across
    double lever = h - r.y, vx = v.x - lever * w.z, vz = v.z + lever * w.x;
    double v_f = on->x * vx + on->z * vz, v_s = on->x * vz - on->z * vx;
    double eta = wheel[WHEEL_ETA], xi = wheel[WHEEL_XI], eta_dot = v_s, xi_dot = 0, along;
    if (self->parked) {
        xi_dot = v_f;
        along = -tyre->stiffness[0] * xi - tyre->damping[0] * v_f;
    } else {
        eta_dot -= fabs(v_f) * eta / tyre->relaxation_length;
        along = self->model->wheel[j].driven ? on->drive : 0;
    }
    wheel_dot[WHEEL_ETA] = eta_dot;
    wheel_dot[WHEEL_XI] = xi_dot;

    // both within the friction limit: times 1/sqrt(1 + |f|^2/(mu F_n)^2)
    double side = -tyre->stiffness[2] * eta - tyre->damping[2] * eta_dot;
    double limit = tyre->friction * normal;
    double share = limit > 0 ? limit / sqrt(limit * limit + along * along + side * side) : 0;
    report->along = along *= share;
    report->side = side *= share;

    v3 force = {along * on->x - side * on->z, normal, along * on->z + side * on->x};
    output->moment.x += lever * force.z;
    output->moment.z -= lever * force.x;
    output->power[MARCHING_TYRE] += normal * v.y;
    output->power[MARCHING_SIDE] += side * v_s;
    output->power[self->parked ? MARCHING_SIDE : MARCHING_DRIVE] += along * v_f;
    return force;
}

// NOLINTNEXTLINE(readability-function-size)
void marching_evaluate(const marching_system *self, const base_frame *chassis, bool held,
                       const road_disturbance *disturbed, const double *state, double *state_dot,
                       marching_output *output)
{
    int drive_at = WHEEL_STATES * self->wheel_count;
    output->force = output->moment = v3_zero();
    output->elastic = 0;
    for (int k = 0; k < MARCHING_POWERS; k++)
        output->power[k] = 0;

    // heading; drive F = kp (speed - v) + ki z_d, no force while parked
    carrier on = {.frame = chassis, .disturbed = disturbed};
    double x = chassis->A.a[0][0], z = chassis->A.a[2][0], length = sqrt(x * x + z * z);
    on.x = x / length;
    on.z = z / length;
    output->speed = on.x * chassis->v.x + on.z * chassis->v.z;
    double lag = self->model->speed - output->speed;
    bool drives = !self->parked && !held && self->driven_count > 0;
    output->drive_force =
        drives ? self->model->drive.kp * lag + self->model->drive.ki * state[drive_at] : 0;
    on.drive = drives ? output->drive_force / self->driven_count : 0;
    state_dot[drive_at] = lag;

    for (int j = 0; j < self->wheel_count; j++) {
        const double *wheel = state + WHEEL_STATES * j;
        double *wheel_dot = state_dot + WHEEL_STATES * j, mass = self->model->wheel[j].mass;
        v3 v = v3_from(wheel + WHEEL_V);
        v3 force = suspension_force(self, chassis, j, v3_from(wheel + WHEEL_R), v, output);
        force = v3_add(force, tyre_force(self, &on, j, wheel, wheel_dot, output));
        v3 a = v3_scale(1 / mass, force);
        a.y -= self->gravity;
        v3_store(wheel_dot + WHEEL_R, v);
        v3_store(wheel_dot + WHEEL_V, a);
        output->power[MARCHING_GRAVITY] -= mass * self->gravity * v.y;
    }
}

double marching_kinetic_energy(const marching_system *self, const double *state)
{
    double sum = 0;
    for (int j = 0; j < self->wheel_count; j++)
        sum += self->model->wheel[j].mass * v3_norm2(v3_from(state + WHEEL_STATES * j + WHEEL_V));
    return 0.5 * sum;
}

void marching_place(const marching_system *self, const base_frame *chassis, double *state)
{
    for (int k = 0; k < self->state_count; k++)
        state[k] = 0;
    for (int j = 0; j < self->wheel_count; j++) {
        v3 mount = v3_from(self->model->wheel[j].mount);
        v3_store(state + WHEEL_STATES * j + WHEEL_R,
                 v3_add(chassis->r, m3_apply(chassis->A, mount)));
    }
}
