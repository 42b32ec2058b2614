// The course of a run's steps: their sizes as one run chose them, which runs that differ little
// take again, so that results depend on what they differ by as smoothly as the equations do
// (internal differentiation: Bock, Numerical treatment of inverse problems in chemical reaction
// kinetics, 1981).
#ifndef LD_INTEGRATION_STEP_COURSE_H
#define LD_INTEGRATION_STEP_COURSE_H

#include <stdbool.h>

// Of one step. Steps that begin anew, after an event, a stop or another kind of step, begin a
// stretch.
typedef struct course_step {
    bool begins;
    bool is_long;         // exponential, of `rung` (its count: refused)
    double size;          // [s] of others; infinity: to the stop
    int rung, control[4]; // of long ones, and what steered them before
} course_step;

typedef struct step_course {
    bool follows; // else it records
    bool lost;    // while following: its run had other events
    bool failed;  // no memory
    int count, room, at;
    course_step *step;
} step_course;

void step_course_add(step_course *self, const course_step *step);
// Goes back to the start, from where it is followed.
void step_course_follow(step_course *self);
// One that follows the same steps, which remain the other's.
step_course step_course_of(const step_course *other);
// Whether a run that has followed it had other stretches.
bool step_course_differs(const step_course *self);
// The step to take next: the first of the next stretch, or the next of the present one, whose last
// one is repeated. NULL: there is none of this kind, the course is lost.
const course_step *step_course_next(step_course *self, bool begins, bool is_long);
void step_course_free(step_course *self);

#endif
