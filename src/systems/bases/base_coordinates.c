#include "systems/bases/base_coordinates.h"

// clang-format off
static const quantity motions[] = {
    {"base.x", "m", "position of the base in I", .at = QUANTITY_AT(base_inputs, motion[0])},
    {"base.y", "m", "position of the base in I", .at = QUANTITY_AT(base_inputs, motion[1])},
    {"base.z", "m", "position of the base in I", .at = QUANTITY_AT(base_inputs, motion[2])},
    {"base.yaw", "rad", "yaw of the base", .at = QUANTITY_AT(base_inputs, motion[3])},
    {"base.pitch", "rad", "pitch of the base", .at = QUANTITY_AT(base_inputs, motion[4])},
    {"base.roll", "rad", "roll of the base", .at = QUANTITY_AT(base_inputs, motion[5])},
};
// clang-format on
static const quantity_group motion_groups[] = {
    {.title = "motion of the base", QUANTITY_ROWS(motions)},
};
const quantity_table base_motion_inputs = {motion_groups, 1};

// Derivative of w = yaw' e_y + Ry w_1, w_1 = pitch' e_z + Rz roll' e_x.
static v3 angular_acceleration(const double u[6], const double a[6], const m3 *Ry, const m3 *Rz)
{
    v3 rolling = m3_apply(*Rz, v3_make(u[5], 0, 0)), pitching = v3_make(0, 0, u[4]);
    v3 w_1 = v3_add(pitching, rolling);
    v3 rate = v3_add(m3_apply(*Rz, v3_make(a[5], 0, 0)), v3_cross(pitching, rolling));
    rate.z += a[4];
    v3 alpha = v3_add(m3_apply(*Ry, rate), v3_cross(v3_make(0, u[3], 0), m3_apply(*Ry, w_1)));
    alpha.y += a[3];
    return alpha;
}

void base_frame_at(const double x[6], const double u[6], const double a[6], const m3 *mount,
                   base_frame *tube)
{
    // A_base = Ry(yaw) Rz(pitch) Rx(roll); w = yaw' e_y + Ry (pitch' e_z + Rz roll' e_x)
    m3 Ry = m3_rotation_y(x[3]), Rz = m3_rotation_z(x[4]), Rx = m3_rotation_x(x[5]);
    m3 A = m3_mul(Ry, m3_mul(Rz, Rx));
    v3 w = m3_apply(Rz, v3_make(u[5], 0, 0));
    w.z += u[4];
    w = m3_apply(Ry, w);
    w.y += u[3];
    tube->r = v3_make(x[0], x[1], x[2]);
    tube->v = v3_make(u[0], u[1], u[2]);
    tube->A = m3_mul(A, *mount);
    tube->q = q_from_matrix(tube->A);
    tube->w = w;
    tube->a = v3_make(a[0], a[1], a[2]);
    tube->alpha = angular_acceleration(u, a, &Ry, &Rz);
}

void base_frame_go(base_frame *tube, v3 arm)
{
    v3 along = m3_apply(tube->A, arm), turning = v3_cross(tube->w, along);
    tube->r = v3_add(tube->r, along);
    tube->v = v3_add(tube->v, turning);
    tube->a = v3_add(tube->a, v3_add(v3_cross(tube->alpha, along), v3_cross(tube->w, turning)));
}
