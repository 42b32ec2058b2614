#include "state/jets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "integration/dormand_prince.h"
#include "model/blocks/firing.h"
#include "model/blocks/platform.h"
#include "model/parts.h"
#include "systems/mechanism/carried_tubes.h"

// How far apart the places of a course are [s]; between them it is a cubic. How far beyond the
// table's end it continues [m]: so much may a mouth leave the way that it had when its rocket left.
static const double spacing = 1e-3, margin = 100;
enum { MOST_PLACES = 20000 };
static const double pi = 3.14159265358979323846;

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
    for (size_t k = 0; k < flight->motor.corner_count; k++)
        one->greatest = fmax(one->greatest, flight->motor.thrust[k]);
    course flown = {flight, *phase};
    const ld_tubes *tubes = model_tubes(self->model);
    double reach = fmax(reach_of(&model_platform(self->model)->jet), reach_of(&tubes->jet));
    if (tubes->jet_face.present)
        reach = fmax(reach, tubes->jet_face.reach);
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
    return full * thrust_at(self, t) / self->greatest;
}

// What a circle bears of a jet: its share, and the moment of that about the circle's centre [m],
// towards the jet's axis.
typedef struct borne {
    double share, moment;
} borne;

// Of radius a, the jet's axis `off` its centre, the jet's radius b. Gauss's theorem makes both
// integrals over the rim (model.md, section 5); the trapezoidal rule is exact there to rounding for
// a up to 8 b.
static borne borne_by_circle(double a, double off, double b)
{
    enum { STEPS = 48 }; // of half the rim
    borne sum = {0};
    for (int k = 0; k <= STEPS; k++) {
        double c = cos(pi * k / STEPS), weight = (k % STEPS ? 1.0 : 0.5) / STEPS;
        double x = (a * a + off * off - 2 * a * off * c) / (b * b);
        double mean = x > 0 ? -expm1(-x) / x : 1;
        sum.share += weight * mean * a * (a - off * c) / (b * b);
        sum.moment -= weight * exp(-x) * a * c;
    }
    sum.moment += off * sum.share;
    return sum;
}

jet_load jet_on_face(const ld_jet_face *face, double thrust, v3 r, v3 axis)
{
    if (axis.x < 0.1) // the jet blows past
        return (jet_load){0};
    double distance = r.x / axis.x;
    v3 hit = v3_axpy(r, -distance, axis);
    distance = fmax(distance, 0);
    double off = hypot(hit.y, hit.z), b = face->radius + face->spread * distance;
    borne outer = borne_by_circle(face->outer, off, b);
    borne inner = borne_by_circle(face->inner, off, b);
    double share = outer.share - inner.share, moment = outer.moment - inner.moment;
    if (share < 1e-12 || distance >= face->reach)
        return (jet_load){0};
    double fades = fmin(10 * (1 - distance / face->reach), 1);
    double arm = off > 0 ? moment / (share * off) : 0;
    return (jet_load){fades * share * thrust, {arm * hit.y, arm * hit.z}};
}

static jet_load on_guide(const jet *self, double t, const ld_tubes *tubes, v3 tip, m3 A)
{
    const double scale = tubes->jet_scale;
    if (!tubes->jet_face.present)
        return (jet_load){.force = force_at(self, t, &tubes->jet, scale, tip)};
    if (is_gone(self, t))
        return (jet_load){0};
    v3 r = m3_apply_transposed(A, v3_sub(place_at(self, t), tip));
    v3 axis = m3_apply_transposed(A, axis_at(self, t));
    return jet_on_face(&tubes->jet_face, scale * thrust_at(self, t), r, axis);
}

jet_load jets_on_guide(const jets *self, double t, v3 tip, m3 A, int launching)
{
    const ld_tubes *tubes = model_tubes(self->model);
    for (int i = 0; i < self->count; i++)
        if (self->of[i].tube == launching)
            return on_guide(&self->of[i], t, tubes, tip, A);
    return (jet_load){0};
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
