#include "integration/step_course.h"

#include <stdlib.h>

void step_course_add(step_course *self, const course_step *step)
{
    if (self->count == self->room) {
        int room = 2 * self->room + 256;
        course_step *grown = realloc(self->step, (size_t)room * sizeof *grown);
        self->failed |= !grown;
        if (!grown)
            return;
        self->step = grown;
        self->room = room;
    }
    self->step[self->count++] = *step;
}

void step_course_follow(step_course *self)
{
    self->follows = true;
    self->lost = false;
    self->at = -1;
}

step_course step_course_of(const step_course *other)
{
    step_course self = *other;
    step_course_follow(&self);
    return self;
}

bool step_course_differs(const step_course *self)
{
    int next = self->at + 1;
    while (next < self->count && !self->step[next].begins)
        next++;
    return self->follows && (self->lost || next < self->count);
}

const course_step *step_course_next(step_course *self, bool begins, bool is_long)
{
    int next = self->at + 1;
    while (begins && next < self->count && !self->step[next].begins)
        next++;
    bool repeats = !begins && (next >= self->count || self->step[next].begins);
    if (repeats)
        next = self->at;
    self->lost |= next < 0 || next >= self->count || self->step[next].is_long != is_long;
    if (self->lost)
        return NULL;
    self->at = next;
    return &self->step[next];
}

void step_course_free(step_course *self)
{
    free(self->step);
    *self = (step_course){0};
}
