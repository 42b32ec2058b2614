// A line that a rocket pulls out of a container: points of mass joined by segments that are elastic
// in tension and slack otherwise, whose number grows (model.md, section 8). On a flat Earth, in I.
//
// Points count from the rocket: segment 0 lies between bridle and point 0, segment i between points
// i - 1 and i, the last between the last point (the bridle where there is none) and the container.
// It grows: with u the unstretched length that leaves the container in a second,
//   paid' = u = v.e/(1 + T/EA) while the line is taut and drawn out,   T = T_c + m' u v.e,
// m' the mass per length, v the velocity of the segment's outer end, e its direction away from the
// container: what is drawn out was at rest, so its momentum takes m' u v (theorem of momentum for a
// volume that mass enters; Meriam and Kraige, Engineering Mechanics: Dynamics, on variable mass).
// The growing segment's mass goes with its outer end, so
//   (m' (d/2 + L)) v' = F - T_c e - m' u v.
// When it is 1.5 d long, d the length of a segment, a point is left 1 d behind the outer end, on
// the line and as fast: mass, momentum and kinetic energy stay. The bridle moves as it is predicted
// over a step: r + v t + a t^2/2. So does a container that is carried: v is then that of the outer
// end against it, the momentum m' u v what is added to the container's.
#ifndef LD_SYSTEMS_FLIGHT_LINE_H
#define LD_SYSTEMS_FLIGHT_LINE_H

#include "elements/air/aerodynamics.h"
#include "math/vec3.h"
#include "model/blocks/line.h"

// A point that moves: of the line, or its bridle or container with the acceleration of its
// prediction.
typedef struct line_point {
    v3 r, v;
} line_point;
typedef struct line_bridle {
    v3 r, v, a;
} line_bridle;

typedef struct line_setting {
    const ld_line *given;
    v3 container;  // [m] where it stands, unless it is carried
    v3 gravity;    // [m/s2]
    double ground; // [m] its height y; -infinity: none
    // The air at a point; NULL: none.
    moving_air (*air)(const void *self, double t, v3 r);
    const void *self;
    // Where what carries the container has it at t; NULL: it stands.
    line_bridle (*carried)(const void *carrier, double t);
    const void *carrier;
} line_setting;

// One that has broken at the bridle.
typedef struct line_break {
    double paid; // [m] of it was out; 0: it has not
    double t;    // [s]
    v3 r;        // [m] where that was
} line_break;

typedef struct flight_line {
    line_setting setting;
    line_bridle carried; // the container at the beginning of a step
    line_point hold;     // it now
    double t;            // [s] how far it has been computed
    double paid;         // [m] unstretched length that has left the container
    double rate;         // [m/s] at which it does
    bool ended;          // all of it has
    int cut;             // the segment that has broken, -1: none
    int count;           // of points
    line_point *point;
    struct line_work *work;
    // the force on the rocket over the last step: mean + slope (t - middle)
    double middle;               // [s]
    v3 mean, slope;              // [N], [N/s]
    double greatest, t_greatest; // [N] of its magnitude, [s]
    double t_ended, t_broke;     // [s] NaN: not
    double broke_at;             // [m] from the bridle, along the line
    v3 broke;                    // [m] where that was
} flight_line;

// A straight line between container and bridle at t, drawn out as fast as the bridle moves.
// @return NULL: no memory
flight_line *line_create(const line_setting *setting, double t, const line_bridle *bridle);
// What is left of a line that has broken before: it lies between the container, as that is now, and
// where it broke.
flight_line *line_create_broken(const line_setting *setting, double t, const line_break *broken);
void line_free(flight_line *self);

// The longest step that is allowed [s].
double line_step(const flight_line *self);

// The container stays where it is from now on.
void line_hold_still(flight_line *self);

// Continues to `to`, at most line_step later.
void line_advance(flight_line *self, double to, const line_bridle *bridle);

// The force on the rocket at its bridle, as the last step found it.
v3 line_force(const flight_line *self, double t);

// Where the line is, at a share of the length that has left the container (0) up to the bridle
// (1), which is at `bridle`, or up to where it has broken; t: at most a step before now.
v3 line_place(const flight_line *self, double t, v3 bridle, double share);

// Greatest horizontal distance [m] from the container of the part of the line that hangs on it.
double line_reach(const flight_line *self, v3 bridle);

// Length [m] that has left the container at t.
double line_paid(const flight_line *self, double t);

// Whether no point moves faster than 0.1 m/s.
bool line_rests(const flight_line *self);

#endif
