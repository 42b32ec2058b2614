#include "state/outside_steps.h"

#include <string.h>

void outside_steps_place(outside_steps *self, double t, const double *y)
{
    size_t size = (size_t)self->states * sizeof *y;
    if (t == self->now.t && memcmp((const char *)y, (const char *)self->now.y, size) == 0)
        return;
    self->now.t = t;
    memmove(self->now.y, y, size);
    self->accepted = false;
}

// A value that begins at zero itself goes nowhere.
static int direction_of(double before, double now)
{
    return before > 0 && now <= 0 ? -1 : before < 0 && now >= 0 ? 1 : 0;
}

bool outside_steps_accept(outside_steps *self, const double *value)
{
    bool crossed = false;
    self->accepted = true;
    self->steps++;
    for (int i = 0; i < self->events; i++) {
        self->direction[i] = direction_of(self->value[i], value[i]);
        crossed |= self->direction[i] != 0;
    }
    return crossed;
}

void outside_steps_begin(outside_steps *self, const double *value)
{
    self->last = self->now;
    self->accepted = true;
    memcpy(self->value, value, (size_t)self->events * sizeof *value);
    memset(self->direction, 0, sizeof self->direction);
}

void outside_steps_interpolate(const outside_steps *self, double t, double *y)
{
    const outside_point *from = &self->last, *to = &self->now;
    double h = to->t - from->t, x = h > 0 ? (t - from->t) / h : 1;
    double a = (1 + 2 * x) * (1 - x) * (1 - x), b = x * (1 - x) * (1 - x) * h;
    double c = x * x * (3 - 2 * x), d = -x * x * (1 - x) * h;
    for (int i = 0; i < self->states; i++)
        y[i] = t == to->t ? to->y[i]
                          : a * from->y[i] + b * from->rate[i] + c * to->y[i] + d * to->rate[i];
}

static void archive_point(outside_point *point, int states, archive *bytes)
{
    archive_double(bytes, &point->t);
    archive_doubles(bytes, point->y, (size_t)states);
    archive_doubles(bytes, point->rate, (size_t)states);
}

void outside_steps_archive(outside_steps *self, archive *bytes)
{
    archive_point(&self->last, self->states, bytes);
    archive_point(&self->now, self->states, bytes);
    archive_bool(bytes, &self->accepted);
    archive_doubles(bytes, self->value, (size_t)self->events);
    for (int i = 0; i < self->events; i++)
        archive_int(bytes, &self->direction[i], -1, 1);
    archive_count(bytes, &self->steps);
    archive_count(bytes, &self->evaluations);
}
