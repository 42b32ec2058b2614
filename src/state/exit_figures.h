// How the rocket and the tip move, as summary and history have it.
#ifndef LD_STATE_EXIT_FIGURES_H
#define LD_STATE_EXIT_FIGURES_H

#include "state/launch_state.h"

// Direction angles: pitch and yaw of d (any length) and their rates under d_dot (model.md, section
// 1).
typedef struct direction_angles {
    double pitch, yaw, pitch_rate, yaw_rate;
} direction_angles;
direction_angles direction_angles_of(v3 d, v3 d_dot);

// The rocket's axes x and y, its rate, position and velocity of its mass centre, all in I; its
// relative roll, which counts whole turns.
typedef struct rocket_motion {
    v3 axis, side, w, r_C, v_C;
    double gamma;
} rocket_motion;
// Of the rocket with this pose in state y, its mass centre at c in B.
rocket_motion rocket_motion_of(const launching_pose *pose, v3 c, const double *y,
                               const launching_layout *at);

// The rocket against the launcher, as it stands and moves; at time t in the launcher's axes at the
// ignition, before which there are none. Those of no rocket: not a number.
ld_tip_off tip_off_of(const base_frame *base, const rocket_motion *rocket);
ld_since_ignition since_ignition_of(const launch_state *self, double t,
                                    const rocket_motion *rocket);
extern const ld_tip_off no_tip_off;
extern const ld_since_ignition before_ignition;

// The tip's section against the undeformed tube, in the base's tube axes.
typedef struct tip_state {
    v3 offset, offset_dot;
    direction_angles angles;
} tip_state;
tip_state tip_state_of(const launch_state *self, const base_frame *base, const double *y);

#endif
