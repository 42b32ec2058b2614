// Directions and their rates; the tube's tip against the undeformed tube; the rocket against the
// launcher: figures of its exit that keep their meaning however steep the launcher stands and
// however it moves.
#include "state/exit_figures.h"

#include "math/functions.h"
#include "state/launch_state.h"
#include "systems/launching/launching_kinematics.h"

direction_angles direction_angles_of(v3 d, v3 d_dot)
{
    double level2 = d.x * d.x + d.z * d.z, level = sqrt(level2);
    double level_dot = level > 0 ? (d.x * d_dot.x + d.z * d_dot.z) / level : 0;
    return (direction_angles){
        .pitch = atan2(d.y, level),
        .yaw = atan2(-d.z, d.x),
        .pitch_rate = (d_dot.y * level - d.y * level_dot) / (level2 + d.y * d.y),
        .yaw_rate = (d.z * d_dot.x - d.x * d_dot.z) / level2,
    };
}

tip_state tip_state_of(const launch_state *self, const base_frame *base, const double *y)
{
    const launching_system *launching = &self->launcher.launching;
    const launching_layout *at = &launching->layout;
    launching_section tip;
    double length = launching->tube.flexible.length;
    launching_section_at(launching, y, length, &tip);
    m3 A_TR = m3_mul(m3_transpose(base->A), q_matrix(q_from(y + at->quaternion)));
    v3 r = m3_apply_transposed(base->A, v3_sub(v3_from(y + at->r), base->r));
    v3 base_v = m3_apply_transposed(base->A, base->v),
       base_w = m3_apply_transposed(base->A, base->w);
    v3 place = v3_add(r, m3_apply(A_TR, tip.P));
    v3 v = v3_sub(m3_apply(A_TR, tip.v), v3_add(base_v, v3_cross(base_w, place)));
    v3 w = v3_sub(m3_apply(A_TR, tip.w), base_w);
    v3 axis = m3_apply(A_TR, m3_column(tip.A, 0));
    return (tip_state){
        .offset = v3_sub(place, v3_make(length, 0, 0)),
        .offset_dot = v, // base_w x place is taken off: the derivative of base coordinates
        .angles = direction_angles_of(axis, v3_cross(w, axis)),
    };
}

rocket_motion rocket_motion_of(const launching_pose *pose, v3 c, const double *y,
                               const launching_layout *at)
{
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 to_C = m3_apply(pose->A_RB, c);
    return (rocket_motion){
        .axis = m3_apply(A_IR, m3_column(pose->A_RB, 0)),
        .side = m3_apply(A_IR, m3_column(pose->A_RB, 1)),
        .w = m3_apply(A_IR, pose->w_B),
        .r_C = v3_add(v3_from(y + at->r), m3_apply(A_IR, v3_add(pose->p1, to_C))),
        .v_C = m3_apply(A_IR, v3_add(pose->v_O1, v3_cross(pose->w_B, to_C))),
        .gamma = y[at->x + X_GAMMA],
    };
}

// Direction and rates of an axis that turns at w, both in I, seen in axes A_IT held still.
static direction_angles angles_in(const m3 *A_IT, v3 axis, v3 w)
{
    return direction_angles_of(m3_apply_transposed(*A_IT, axis),
                               m3_apply_transposed(*A_IT, v3_cross(w, axis)));
}

ld_tip_off tip_off_of(const base_frame *base, const rocket_motion *rocket)
{
    v3 carried = v3_add(base->v, v3_cross(base->w, v3_sub(rocket->r_C, base->r)));
    v3 v = m3_apply_transposed(base->A, rocket->v_C);
    v3 v_relative = m3_apply_transposed(base->A, v3_sub(rocket->v_C, carried));
    direction_angles angles = angles_in(&base->A, rocket->axis, rocket->w);
    direction_angles relative = angles_in(&base->A, rocket->axis, v3_sub(rocket->w, base->w));
    return (ld_tip_off){
        .pitch = angles.pitch,
        .yaw = angles.yaw,
        .pitch_rate = angles.pitch_rate,
        .yaw_rate = angles.yaw_rate,
        .pitch_rate_relative = relative.pitch_rate,
        .yaw_rate_relative = relative.yaw_rate,
        .vy = v.y,
        .vz = v.z,
        .vy_relative = v_relative.y,
        .vz_relative = v_relative.z,
    };
}

// Roll of Ry(yaw) Rz(pitch) Rx(roll) in axes A_IT, of whose turns the relative roll reports the
// number.
static double roll_in(const m3 *A_IT, direction_angles angles, const rocket_motion *rocket)
{
    double sy = sin(angles.yaw), cy = cos(angles.yaw), sp = sin(angles.pitch),
           cp = cos(angles.pitch);
    v3 side = m3_apply_transposed(*A_IT, rocket->side);
    double roll =
        atan2(v3_dot(side, v3_make(sy, 0, cy)), v3_dot(side, v3_make(-sp * cy, cp, sp * sy)));
    return rocket->gamma + remainder(roll - rocket->gamma, 2 * acos(-1));
}

ld_since_ignition since_ignition_of(const launch_state *self, double t, const rocket_motion *rocket)
{
    if (t < self->t_ignition)
        return before_ignition;
    v3 v = m3_apply_transposed(self->A_ignition, rocket->v_C);
    direction_angles angles = angles_in(&self->A_ignition, rocket->axis, rocket->w);
    return (ld_since_ignition){
        .pitch = angles.pitch,
        .yaw = angles.yaw,
        .roll = roll_in(&self->A_ignition, angles, rocket),
        .pitch_rate = angles.pitch_rate,
        .yaw_rate = angles.yaw_rate,
        .roll_rate = v3_dot(rocket->axis, rocket->w) - angles.yaw_rate * sin(angles.pitch),
        .vy = v.y,
        .vz = v.z,
    };
}

const ld_tip_off no_tip_off = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
const ld_since_ignition before_ignition = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
