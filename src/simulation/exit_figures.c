// The rocket against the launcher: figures of its exit that keep their meaning however steep the
// launcher stands and however it moves.
#include <math.h>

#include "simulation/launch_state.h"

rocket_motion rocket_motion_of(const launching_pose *pose, v3 c, const double *y,
                               const launching_layout *at)
{
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 to_C = m3_apply(pose->A_RB, c);
    return (rocket_motion){
        .axis = m3_apply(A_IR, m3_column(pose->A_RB, 0)),
        .w = m3_apply(A_IR, pose->w_B),
        .r_C = v3_add(v3_from(y + at->r), m3_apply(A_IR, v3_add(pose->p1, to_C))),
        .v_C = m3_apply(A_IR, v3_add(pose->v_O1, v3_cross(pose->w_B, to_C))),
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

ld_aim aim_of(const launch_state *self, double t, const rocket_motion *rocket)
{
    if (t < self->t_ignition)
        return no_aim;
    v3 v = m3_apply_transposed(self->aim, rocket->v_C);
    direction_angles angles = angles_in(&self->aim, rocket->axis, rocket->w);
    return (ld_aim){
        .pitch = angles.pitch,
        .yaw = angles.yaw,
        .pitch_rate = angles.pitch_rate,
        .yaw_rate = angles.yaw_rate,
        .vy = v.y,
        .vz = v.z,
    };
}

const ld_tip_off no_tip_off = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
const ld_aim no_aim = {NAN, NAN, NAN, NAN, NAN, NAN};
