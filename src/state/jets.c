#include "state/jets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "integration/dormand_prince.h"
#include "model/blocks/firing.h"
#include "model/blocks/platform.h"
#include "model/blocks/rocket.h"
#include "model/parts.h"
#include "systems/mechanism/carried_tubes.h"

// How far apart the places of a course are [s]; between them it is a cubic. How far beyond the
// table's end it continues [m]: so much may a mouth leave the way that it had when its rocket left.
static const double spacing = 1e-3, margin = 100;
enum { MOST_PLACES = 20000 };

void jets_free(jets *self)
{
    for (int i = 0; i < self->count; i++)
        free(self->of[i].place);
    self->count = 0;
}

v3 jets_mouth(const ld_model *model, int tube, int launching)
{
    const ld_layout *layout = &model_tubes(model)->layout;
    v3 between = v3_sub(carried_tube_row(layout, tube), carried_tube_row(layout, launching));
    return v3_add(between, v3_make(model_tubes(model)->length, 0, 0));
}

// ---- a course

typedef struct course {
    const flight_system *flight;
    flight_phase phase;
} course;

static void slopes(const double *t, const double *y, double *y_dot, void *self)
{
    course *flown = self;
    flight_rates(flown->flight, &flown->phase, *t, y, y_dot);
}

static bool is_ignited(const jet *self)
{
    return self->piece + 1 < (int)self->flight->motor.corner_count;
}

static double corner_of(const jet *self)
{
    return is_ignited(self) ? self->t_ignition + self->flight->motor.t[self->piece + 1] : INFINITY;
}

// Begins the pieces that t has reached.
static bool pass_corners(jet *self, double t)
{
    int before = self->piece;
    while (is_ignited(self) && t >= corner_of(self))
        self->piece++;
    return self->piece != before;
}

static bool keep_place(jet *self, const course *flown, double t, const double *y)
{
    if ((self->count & (self->count - 1)) == 0) { // full at each power of two
        size_t room = self->count ? 2 * (size_t)self->count : 1;
        jet_pose *place = realloc(self->place, room * sizeof *place);
        if (!place)
            return false;
        self->place = place;
    }
    flight_pose pose;
    flight_leave(flown->flight, &flown->phase, t, y, &pose);
    self->place[self->count++] =
        (jet_pose){t, pose.r_O1, pose.v_O1, m3_column(q_matrix(pose.q_IB), 0)};
    return true;
}

// The last place is out of reach of the mouth, had that continued as it did.
static bool is_away(const jet *self, double reach)
{
    const jet_pose *last = &self->place[self->count - 1];
    v3 mouth = v3_axpy(self->mouth.r, last->t - self->mouth.t, self->mouth.v);
    return !(v3_norm(v3_sub(last->r, mouth)) < reach + margin);
}

// Flies from place to place; `self` has the pieces that hold.
static ld_status find_course(jet *self, course *flown, double reach, const double *state,
                             ld_error *error)
{
    jet now = *self; // its pieces as it flies
    double t = self->mouth.t;
    dormand_prince steps = {.f = slopes, .self = flown, .count = flown->flight->states};
    double y[DORMAND_PRINCE_STATES] = {0};
    for (int i = 0; i < DORMAND_PRINCE_STATES; i++)
        steps.step.absolute[i] = 1e-8;
    memcpy(y, state, FLIGHT_STATES * sizeof *y);
    dormand_prince_start(&steps, t, y);
    bool kept = keep_place(self, flown, t, y);
    while (kept && is_ignited(&now) && !is_away(self, reach) && self->count < MOST_PLACES) {
        double next = t + self->count * spacing;
        while (steps.step.t < next) {
            double stop =
                fmin(corner_of(&now), wind_next_corner(&flown->flight->wind, steps.step.t));
            if (!dormand_prince_step(&steps, fmin(next, stop)))
                return ld_fail(error, LD_ERR_NUMERIC,
                               "the equations of flight gave no finite result after the exit, at "
                               "t = %.9g s",
                               steps.step.t);
            if (pass_corners(&now, steps.step.t))
                flight_set_piece(flown->flight, &flown->phase, now.piece);
            if (steps.step.t == stop)
                dormand_prince_start(&steps, steps.step.t, steps.step.y);
        }
        kept = keep_place(self, flown, steps.step.t, steps.step.y);
    }
    return kept ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for a rocket's jet");
}

static double reach_of(const ld_table *table)
{
    return table->rows > 0 ? table->data[(table->rows - 1) * table->columns] : 0;
}

ld_status jets_add(jets *self, const flight_system *flight, const flight_phase *phase,
                   const jet_place *mouth, const double *state, ld_error *error)
{
    int tube = model_firing(self->model, self->count)->tube;
    jet *one = &self->of[self->count++];
    *one = (jet){.flight = flight,
                 .t_ignition = phase->t_ignition,
                 .piece = phase->piece,
                 .tube = tube,
                 .mouth = *mouth};
    course flown = {flight, *phase};
    const ld_tubes *tubes = model_tubes(self->model);
    double reach = fmax(reach_of(&model_platform(self->model)->jet), reach_of(&tubes->jet));
    const ld_plume *plume = &model_rocket(self->model)->motor.plume;
    if (plume->present)
        reach = fmax(reach, plume->reach);
    return find_course(one, &flown, reach, state, error);
}

// ---- what they do

// The place of a course before t, within it.
static const jet_pose *place_before(const jet *self, double t)
{
    double share = (t - self->place[0].t) / spacing;
    return &self->place[(int)fmin(fmax(share, 0), self->count - 2)];
}

// O1 at t, within the course; cubic Hermite between two places.
static v3 place_at(const jet *self, double t)
{
    const jet_pose *a = place_before(self, t), *b = a + 1;
    double h = b->t - a->t, x = (t - a->t) / h;
    v3 r = v3_scale((1 + 2 * x) * (1 - x) * (1 - x), a->r);
    r = v3_axpy(r, x * (1 - x) * (1 - x) * h, a->v);
    r = v3_axpy(r, x * x * (3 - 2 * x), b->r);
    return v3_axpy(r, -x * x * (1 - x) * h, b->v);
}

// The rocket's axis then, turned evenly between two places.
static v3 axis_at(const jet *self, double t)
{
    const jet_pose *a = place_before(self, t), *b = a + 1;
    v3 axis = v3_axpy(a->axis, (t - a->t) / (b->t - a->t), v3_sub(b->axis, a->axis));
    return v3_scale(1 / v3_norm(axis), axis);
}

// Linear between the rows, 0 beyond the last.
static double table_at(const ld_table *table, double distance)
{
    const double *row = table->data;
    for (size_t k = 1; k < table->rows; k++, row += 2)
        if (distance < row[2])
            return row[1] + (row[3] - row[1]) * (distance - row[0]) / (row[2] - row[0]);
    return 0;
}

static bool is_gone(const jet *self, double t)
{
    return self->count < 2 || t > self->place[self->count - 1].t;
}

static double thrust_at(const jet *self, double t)
{
    return motor_thrust(&self->flight->motor, self->piece, t - self->t_ignition);
}

// The force on something at a place [N]; 0 after the course.
static double force_at(const jet *self, double t, const ld_table *table, double scale, v3 place)
{
    if (is_gone(self, t))
        return 0;
    double full = scale * table_at(table, v3_norm(v3_sub(place_at(self, t), place)));
    return full * thrust_at(self, t) / self->flight->motor.greatest;
}

jet_source jets_source(const jets *self, double t, int launching)
{
    for (int i = 0; i < self->count; i++) {
        const jet *one = &self->of[i];
        if (one->tube == launching && !is_gone(one, t))
            return (jet_source){place_at(one, t),
                                axis_at(one, t),
                                {thrust_at(one, t), one->flight->motor.greatest}};
    }
    return (jet_source){0};
}

static guide_push push_on_ring(const ld_plume *plume, const jet_source *from, plume_ring ring,
                               v3 center, m3 A)
{
    v3 r = m3_apply_transposed(A, v3_sub(from->r, center));
    v3 axis = m3_apply_transposed(A, from->axis);
    plume_load load = plume_on_ring(plume, ring, from->thrust, r, axis);
    return (guide_push){.hit = load.force, .at = {0, load.at[0], load.at[1]}};
}

guide_push jet_on_face(const ld_tubes *tubes, const ld_plume *plume, const jet_source *from, v3 tip,
                       m3 A)
{
    const ld_jet_face *face = &tubes->jet_face;
    guide_push push = {0};
    if (face->present)
        push = push_on_ring(plume, from, (plume_ring){face->inner, face->outer}, tip, A);
    else if (from->thrust.now > 0)
        push.hit = table_at(&tubes->jet, v3_norm(v3_sub(from->r, tip))) * from->thrust.now /
                   from->thrust.greatest;
    push.hit *= tubes->jet_scale;
    push.force = v3_make(-push.hit, 0, 0);
    return push;
}

guide_push jet_on_deflector(const ld_tubes *tubes, const ld_plume *plume, const jet_source *from,
                            v3 rear, m3 A)
{
    const ld_deflector *self = &tubes->deflector;
    v3 center = v3_axpy(rear, self->at, m3_column(A, 0));
    guide_push push = push_on_ring(plume, from, (plume_ring){self->inner, self->outer}, center, A);
    push.hit *= tubes->jet_scale;
    push.force = v3_scale(push.hit, v3_from(self->push));
    push.at.x = self->at;
    return push;
}

jet_wrench jets_at(const jets *self, double t, const base_frame *tube, int launching)
{
    const ld_platform *platform = model_platform(self->model);
    jet_wrench sum = {0};
    for (int i = 0; i < self->count; i++) {
        const jet *one = &self->of[i];
        v3 mouth = jets_mouth(self->model, one->tube, launching);
        v3 place = v3_add(tube->r, m3_apply(tube->A, mouth));
        double force = force_at(one, t, &platform->jet, platform->jet_scale, place);
        v3 back = v3_make(-force, 0, 0);
        sum.force = v3_add(sum.force, back);
        sum.moment = v3_add(sum.moment, v3_cross(mouth, back));
    }
    return sum;
}

double jets_next_corner(const jets *self)
{
    double next = INFINITY;
    for (int i = 0; i < self->count; i++)
        next = fmin(next, corner_of(&self->of[i]));
    return next;
}

bool jets_pass_corners(jets *self, double t)
{
    bool passed = false;
    for (int i = 0; i < self->count; i++)
        passed |= pass_corners(&self->of[i], t);
    return passed;
}

int jets_pieces(const jets *self)
{
    int sum = 0;
    for (int i = 0; i < self->count; i++)
        sum += self->of[i].piece + 1;
    return sum;
}
