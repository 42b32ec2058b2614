#include "systems/flight/line.h"

#include <stdlib.h>
#include <string.h>

#include "math/functions.h"

// Rates of change of the points and of the length, and the force on the rocket.
typedef struct line_rates {
    line_point *point;
    double paid;
    v3 force;
} line_rates;

typedef struct line_work {
    line_point *at; // the state of a stage
    line_rates rates;
    line_point *sum; // of the stages' rates, weighted
    double *mass;    // [kg]
    v3 *force;       // [N]
    moving_air *air; // of the points, then of the bridle
    double most;     // [N] the greatest tension
    int tightest;    // in that segment
    double settles;  // [1/s] how fast drag brakes the fastest point
} line_work;

// What the growing segment does.
typedef struct line_mouth {
    v3 e;           // away from the container
    double length;  // [m] unstretched
    double tension; // [N]
    double rate;    // [m/s] u
    bool drawn;     // out of the container
    bool attached;  // to it
} line_mouth;

static double segment_length(const flight_line *self)
{
    return self->setting.given->length / self->setting.given->segments;
}

// What rounding leaves of a strain.
static const double SLACK = 1e-9;

static double seconds_of_segment(const flight_line *self)
{
    const ld_line *given = self->setting.given;
    return segment_length(self) * sqrt(given->mass_per_length / given->stiffness);
}

// The highest frequency of a chain is 2 over the time that a tension takes along a segment;
// Runge-Kutta steps of order 4 are stable up to 2.8 times its inverse.
double line_step(const flight_line *self)
{
    const double most = 5e-3, least = 1e-3; // [s]
    return fmin(most, fmax(least, 0.8 * seconds_of_segment(self)));
}

// ---- forces

static double damping_of(const ld_line *given)
{
    return given->damping * sqrt(given->stiffness * given->mass_per_length);
}

static double tension_of(const ld_line *given, double ratio, double rate)
{
    if (ratio <= 1)
        return 0;
    return fmax(0, given->stiffness * (ratio - 1) + damping_of(given) * rate);
}

// Drag of a length [m] along `tangent`, which moves with v: across and along each by its own speed
// (the cross-flow principle; S. F. Hoerner, Fluid-Dynamic Drag, 1965, chapter 3).
static v3 drag_of(const ld_line *given, const moving_air *air, v3 tangent, v3 v, double length)
{
    const double pi = 3.14159265358979323846;
    double norm = v3_norm(tangent);
    if (norm == 0 || air->density == 0)
        return v3_zero();
    v3 e = v3_scale(1 / norm, tangent), slip = v3_sub(v, air->v);
    v3 along = v3_scale(v3_dot(slip, e), e), across = v3_sub(slip, along);
    double pressed = -0.5 * air->density * given->diameter * length;
    return v3_add(v3_scale(pressed * given->drag_across * v3_norm(across), across),
                  v3_scale(pressed * pi * given->drag_along * v3_norm(along), along));
}

// By the outer end of the growing segment.
static line_mouth mouth_of(const flight_line *self, const line_point *end, double paid)
{
    const ld_line *given = self->setting.given;
    line_mouth mouth = {.attached = self->cut != self->count &&
                                    !(self->ended && given->end == LD_LINE_FREE)};
    mouth.length = paid - self->count * segment_length(self);
    v3 reach = v3_sub(end->r, self->hold.r);
    double distance = v3_norm(reach);
    if (!mouth.attached || distance == 0)
        return mouth;
    mouth.e = v3_scale(1 / distance, reach);
    double speed = v3_dot(v3_sub(end->v, self->hold.v), mouth.e), ratio = distance / mouth.length;
    double elastic = given->stiffness * (ratio - 1), holds = given->tension;
    double damped = tension_of(given, ratio, speed);
    if (self->ended) {
        mouth.tension = damped;
    } else if (elastic >= holds - SLACK * given->stiffness && speed > 0) {
        double flux = given->mass_per_length * speed * speed;
        mouth.rate = speed / (1 + (holds + flux) / given->stiffness);
        mouth.tension = holds + given->mass_per_length * mouth.rate * speed;
        mouth.drawn = true;
    } else {
        mouth.tension = fmin(holds, elastic >= holds ? holds : damped);
    }
    return mouth;
}

// Of a load along the growing segment what its outer end carries: half, and along the line all
// that the container, which holds with a given tension, does not.
static v3 outer_part(const line_mouth *mouth, v3 load)
{
    if (!mouth->attached)
        return load;
    v3 half = v3_scale(0.5, load);
    return mouth->drawn ? v3_axpy(half, v3_dot(half, mouth->e), mouth->e) : half;
}

static v3 mouth_load(const flight_line *self, const line_mouth *mouth, const moving_air *air,
                     const line_point *end)
{
    const ld_line *given = self->setting.given;
    v3 weight = v3_scale(given->mass_per_length * mouth->length, self->setting.gravity);
    v3 drag = drag_of(given, air, v3_sub(end->r, self->hold.r), end->v, mouth->length);
    return outer_part(mouth, v3_add(weight, drag));
}

static void note_tension(line_work *work, double tension, int segment)
{
    if (tension <= work->most)
        return;
    work->most = tension;
    work->tightest = segment;
}

// Weights, drag, tensions of the points into force and mass; the bridle at `end`. The pull of
// segment 0 on the bridle is returned.
static v3 load_points(flight_line *self, const line_point *p, const line_bridle *end,
                      const line_mouth *mouth)
{
    const ld_line *given = self->setting.given;
    line_work *work = self->work;
    double d = segment_length(self), mass = given->mass_per_length * d;
    v3 pull = v3_zero();
    int n = self->count;
    for (int i = 0; i < n; i++) {
        v3 before = i ? p[i - 1].r : end->r, v_before = i ? p[i - 1].v : end->v;
        v3 after = i + 1 < n ? p[i + 1].r : self->hold.r;
        bool last = i + 1 == n;
        double length = last ? 0.5 * d : d;
        work->mass[i] = last ? 0.5 * mass + given->mass_per_length * mouth->length : mass;
        v3 load = v3_scale(given->mass_per_length * length, self->setting.gravity);
        v3 tangent = v3_sub(before, last && !mouth->attached ? p[i].r : after);
        v3 drag = drag_of(given, &work->air[i], tangent, p[i].v, length);
        work->force[i] = v3_add(work->force[i], v3_add(load, drag));
        v3 reach = v3_sub(before, p[i].r);
        double stretched = v3_norm(reach);
        if (i == self->cut || stretched == 0)
            continue;
        v3 e = v3_scale(1 / stretched, reach);
        double tension = tension_of(given, stretched / d, v3_dot(e, v3_sub(v_before, p[i].v)));
        note_tension(work, tension, i);
        work->force[i] = v3_axpy(work->force[i], tension, e);
        if (i)
            work->force[i - 1] = v3_axpy(work->force[i - 1], -tension, e);
        else
            pull = v3_scale(-tension, e);
    }
    return pull;
}

// What a point does under its force; on the ground it stays until it is lifted.
static line_point rates_of_point(const flight_line *self, const line_point *p, v3 force,
                                 double mass)
{
    if (p->r.y <= self->setting.ground && force.y <= 0 && p->v.y <= 0)
        return (line_point){v3_zero(), v3_zero()};
    return (line_point){p->v, v3_scale(1 / mass, force)};
}

// The force on the rocket while the line has no points: all that is out goes as fast as the bridle.
static v3 short_pull(const flight_line *self, const line_bridle *end, const line_mouth *mouth)
{
    const ld_line *given = self->setting.given;
    const line_point outer = {end->r, end->v};
    if (self->cut == 0)
        return v3_zero();
    v3 force = mouth_load(self, mouth, &self->work->air[0], &outer);
    double lag = given->mass_per_length * mouth->length * v3_dot(end->a, mouth->e);
    return v3_axpy(force, -(mouth->tension + fmax(lag, -mouth->tension)), mouth->e);
}

static void find_rates(flight_line *self, const line_point *p, double paid, const line_bridle *end)
{
    const ld_line *given = self->setting.given;
    line_work *work = self->work;
    int n = self->count;
    line_point outer = n ? p[n - 1] : (line_point){end->r, end->v};
    line_mouth mouth = mouth_of(self, &outer, paid);
    work->most = 0;
    memset(work->force, 0, (size_t)n * sizeof *work->force);
    work->rates.paid = mouth.rate;
    if (n == 0) {
        work->rates.force = short_pull(self, end, &mouth);
        note_tension(work, v3_norm(work->rates.force), 0);
        return;
    }
    v3 pull = load_points(self, p, end, &mouth);
    v3 *last = &work->force[n - 1];
    *last = v3_add(*last, mouth_load(self, &mouth, &work->air[n - 1], &outer));
    double drawn = given->mass_per_length * mouth.rate;
    *last = v3_axpy(*last, mouth.drawn ? -given->tension : -mouth.tension, mouth.e);
    *last = v3_axpy(*last, -drawn, v3_sub(outer.v, self->hold.v));
    note_tension(work, mouth.tension, n);
    for (int i = 0; i < n; i++)
        work->rates.point[i] = rates_of_point(self, &p[i], work->force[i], work->mass[i]);
    work->rates.force = pull;
    if (self->cut == 0)
        return;
    // half of segment 0 goes with the bridle
    double half = 0.5 * segment_length(self);
    v3 felt = v3_sub(self->setting.gravity, end->a);
    v3 load = v3_scale(given->mass_per_length * half, felt);
    v3 drag = drag_of(given, &work->air[n], v3_sub(end->r, p[0].r), end->v, half);
    work->rates.force = v3_add(work->rates.force, v3_add(load, drag));
}

// ---- steps

static line_bridle bridle_after(const line_bridle *bridle, double t)
{
    return (line_bridle){v3_axpy(v3_axpy(bridle->r, t, bridle->v), 0.5 * t * t, bridle->a),
                         v3_axpy(bridle->v, t, bridle->a), bridle->a};
}

// Puts the container where it is predicted to be, t after the beginning of a step.
static void hold_after(flight_line *self, double t)
{
    if (!self->setting.carried)
        return;
    line_bridle now = bridle_after(&self->carried, t);
    self->hold = (line_point){now.r, now.v};
}

static void carry(flight_line *self)
{
    if (self->setting.carried)
        self->carried = self->setting.carried(self->setting.carrier, self->t);
    hold_after(self, 0);
}

static void find_air(flight_line *self, const line_bridle *bridle)
{
    const line_setting *setting = &self->setting;
    const ld_line *given = setting->given;
    double most = 0;
    for (int i = 0; i <= self->count; i++) {
        const line_point point =
            i < self->count ? self->point[i] : (line_point){bridle->r, bridle->v};
        moving_air *air = &self->work->air[i];
        *air = setting->air ? setting->air(setting->self, self->t, point.r)
                            : (moving_air){v3_zero(), 0, 1};
        most = fmax(most, air->density * v3_norm(v3_sub(point.v, air->v)));
    }
    self->work->settles = most * given->diameter * (given->drag_across + 4 * given->drag_along) /
                          given->mass_per_length;
}

// The stages of Runge and Kutta; the force's integral and its first moment about the whole step's
// middle, by the same weights, are added: momentum that leaves the rocket enters the line.
static void runge_kutta(flight_line *self, double begun, double h, const line_bridle *bridle)
{
    static const double part[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
    line_work *work = self->work;
    int n = self->count;
    double paid = self->paid, paid_sum = 0;
    for (int stage = 0; stage < 4; stage++) {
        double ahead = part[stage] * h, share = weight[stage] * h / 6;
        for (int i = 0; i < n; i++) {
            const line_point *p = &self->point[i], *dot = &work->rates.point[i];
            work->at[i] =
                stage ? (line_point){v3_axpy(p->r, ahead, dot->r), v3_axpy(p->v, ahead, dot->v)}
                      : *p;
        }
        double at = stage ? paid + ahead * work->rates.paid : paid;
        line_bridle end = bridle_after(bridle, self->t - begun + ahead);
        hold_after(self, self->t - begun + ahead);
        find_rates(self, work->at, at, &end);
        for (int i = 0; i < n; i++) {
            line_point *sum = &work->sum[i], *dot = &work->rates.point[i];
            *sum = (line_point){v3_axpy(stage ? sum->r : v3_zero(), share, dot->r),
                                v3_axpy(stage ? sum->v : v3_zero(), share, dot->v)};
        }
        paid_sum += share * work->rates.paid;
        self->mean = v3_axpy(self->mean, share, work->rates.force);
        self->slope =
            v3_axpy(self->slope, share * (self->t + ahead - self->middle), work->rates.force);
    }
    for (int i = 0; i < n; i++) {
        self->point[i].r = v3_add(self->point[i].r, work->sum[i].r);
        self->point[i].v = v3_add(self->point[i].v, work->sum[i].v);
    }
    self->paid += paid_sum;
    self->t += h;
}

// A point on the growing segment, one segment behind its outer end, which is at `end`.
static void add_point(flight_line *self, const line_point *end)
{
    double d = segment_length(self), length = self->paid - self->count * d;
    v3 back = v3_sub(self->hold.r, end->r);
    line_point *added = &self->point[self->count++];
    added->r = v3_axpy(end->r, d / length, back);
    added->v = end->v;
}

static void add_points(flight_line *self, const line_bridle *bridle)
{
    double d = segment_length(self);
    while (self->cut < 0 && !self->ended && self->paid - self->count * d > 1.5 * d) {
        line_point end =
            self->count ? self->point[self->count - 1] : (line_point){bridle->r, bridle->v};
        v3 reach = v3_sub(end.r, self->hold.r), v = v3_sub(end.v, self->hold.v);
        if (!self->count) // only along the line: across, the container holds it
            end.v = v3_axpy(self->hold.v, v3_dot(v, reach) / v3_norm2(reach), reach);
        add_point(self, &end);
    }
}

static void lay_down(flight_line *self)
{
    for (int i = 0; i < self->count; i++) {
        line_point *p = &self->point[i];
        if (p->r.y > self->setting.ground || p->v.y > 0)
            continue;
        p->r.y = self->setting.ground;
        p->v = v3_zero();
    }
}

// A line without points breaks at the bridle, and lies between there and the container.
static bool broke_short(const flight_line *self)
{
    return self->cut == 0 && self->count == 0;
}

// Length [m] along the line from the bridle to the middle of a segment.
static double length_to(const flight_line *self, int segment)
{
    double d = segment_length(self);
    return segment < self->count ? (segment + 0.5) * d : 0.5 * (segment * d + self->paid);
}

// By the tensions at the beginning of a step.
static void watch_tensions(flight_line *self, const line_bridle *bridle)
{
    const ld_line *given = self->setting.given;
    find_rates(self, self->point, self->paid, bridle);
    self->rate = self->work->rates.paid;
    double pull = v3_norm(self->work->rates.force);
    if (pull > self->greatest) {
        self->greatest = pull;
        self->t_greatest = self->t;
    }
    if (self->cut >= 0 || !(self->work->most > given->breaking_force))
        return;
    self->t_broke = self->t;
    self->broke_at = self->count ? length_to(self, self->work->tightest) : 0;
    self->broke = line_place(self, self->t, bridle->r, 1 - self->broke_at / self->paid);
    self->cut = self->work->tightest;
    find_rates(self, self->point, self->paid, bridle);
    self->rate = self->work->rates.paid;
}

// The step goes at most to where all of the line is out, by the present rate.
static double to_the_end(flight_line *self, double h)
{
    double left = self->setting.given->length - self->paid;
    if (self->ended || self->rate * h < left)
        return h;
    if (left > 1e-7)
        return fmin(h, left / self->rate);
    self->ended = true;
    self->t_ended = self->t;
    return h;
}

// [s] in which the direction of a line without points hardly turns.
static double turning(const flight_line *self, const line_bridle *bridle)
{
    double distance = v3_norm(v3_sub(bridle->r, self->hold.r));
    if (self->count || self->cut == 0)
        return INFINITY;
    return fmax(1e-5, 0.2 * distance / fmax(v3_norm(v3_sub(bridle->v, self->hold.v)), 1e-3));
}

void line_advance(flight_line *self, double to, const line_bridle *bridle)
{
    double begun = self->t, most = 0.8 * seconds_of_segment(self), spent = 0;
    self->middle = 0.5 * (begun + to);
    self->mean = self->slope = v3_zero();
    carry(self);
    while (self->t < to) {
        line_bridle now = bridle_after(bridle, self->t - begun);
        hold_after(self, self->t - begun);
        add_points(self, &now);
        find_air(self, &now);
        watch_tensions(self, &now);
        double longest = fmin(fmin(most, 1 / fmax(self->work->settles, 1e-3)), turning(self, &now));
        double h = to_the_end(self, fmin(to - self->t, longest));
        bool last = self->t + h >= to || to - self->t - h < 1e-12;
        runge_kutta(self, begun, h, bridle);
        spent += h;
        lay_down(self);
        if (last)
            self->t = to;
    }
    // rounding leaves no slope in the shortest
    hold_after(self, to - begun);
    double cube = spent > 1e-6 ? spent * spent * spent : INFINITY;
    self->mean = v3_scale(1 / spent, self->mean);
    self->slope = v3_scale(12 / cube, self->slope);
}

// ---- begin, end, answers

// At t, without anything out.
static flight_line *create(const line_setting *setting, double t)
{
    size_t most = (size_t)setting->given->segments + 1;
    flight_line *self = calloc(1, sizeof *self);
    line_work *work = calloc(1, sizeof *work);
    line_point *points = calloc(4 * most, sizeof *points);
    double *mass = calloc(most, sizeof *mass);
    v3 *force = calloc(most, sizeof *force);
    moving_air *air = calloc(most + 1, sizeof *air);
    if (!self || !work || !points || !mass || !force || !air) {
        free(self);
        free(work);
        free(points);
        free(mass);
        free(force);
        free(air);
        return NULL;
    }
    *work = (line_work){.at = points + most,
                        .rates.point = points + 2 * most,
                        .sum = points + 3 * most,
                        .mass = mass,
                        .force = force,
                        .air = air};
    *self = (flight_line){.setting = *setting,
                          .hold.r = setting->container,
                          .t = t,
                          .cut = -1,
                          .point = points,
                          .work = work,
                          .middle = t,
                          .t_ended = NAN,
                          .t_broke = NAN,
                          .broke_at = NAN,
                          .broke = {NAN, NAN, NAN}};
    carry(self);
    return self;
}

flight_line *line_create(const line_setting *setting, double t, const line_bridle *bridle)
{
    const ld_line *given = setting->given;
    flight_line *self = create(setting, t);
    if (!self)
        return NULL;
    double distance = v3_norm(v3_sub(bridle->r, self->hold.r));
    self->paid = fmin(given->length, distance / (1 + given->tension / given->stiffness));
    add_points(self, bridle);
    return self;
}

flight_line *line_create_broken(const line_setting *setting, double t, const line_break *broken)
{
    flight_line *self = create(setting, t);
    if (!self)
        return NULL;
    self->paid = broken->paid;
    self->cut = 0;
    self->t_broke = broken->t;
    self->broke_at = 0;
    self->broke = broken->r;
    self->t_greatest = NAN;
    return self;
}

void line_hold_still(flight_line *self)
{
    self->setting.carried = NULL;
    self->hold.v = v3_zero();
}

void line_free(flight_line *self)
{
    if (!self)
        return;
    free(self->work->mass);
    free(self->work->force);
    free(self->work->air);
    free(self->work);
    free(self->point);
    free(self);
}

v3 line_force(const flight_line *self, double t)
{
    return v3_axpy(self->mean, t - self->middle, self->slope);
}

double line_paid(const flight_line *self, double t)
{
    return self->paid - (self->t - t) * self->rate;
}

v3 line_place(const flight_line *self, double t, v3 bridle, double share)
{
    if (broke_short(self))
        return v3_axpy(self->hold.r, share, v3_sub(self->broke, self->hold.r));
    bool parted = self->cut >= 0 && self->cut < self->count;
    double d = segment_length(self), gone = parted ? (self->cut + 1) * d : 0;
    double at = gone + (1 - share) * (self->paid - gone);
    int i = (int)fmin(at / d, self->count);
    double length = i < self->count ? d : self->paid - self->count * d;
    bool held =
        self->cut != self->count && !(self->ended && self->setting.given->end == LD_LINE_FREE);
    v3 ends[2];
    for (int k = 0; k < 2; k++) {
        int point = i - 1 + k;
        if (point < 0)
            ends[k] = bridle;
        else if (point < self->count)
            ends[k] = v3_axpy(self->point[point].r, t - self->t, self->point[point].v);
        else
            ends[k] = held ? self->hold.r : ends[0];
    }
    double part = length > 0 ? fmin(1, (at - i * d) / length) : 0;
    return v3_axpy(ends[0], part, v3_sub(ends[1], ends[0]));
}

double line_reach(const flight_line *self, v3 bridle)
{
    v3 left = broke_short(self) ? v3_sub(self->broke, self->hold.r) : v3_zero();
    double reach = hypot(left.x, left.z);
    for (int i = self->cut < 0 ? -1 : self->cut; i < self->count; i++) {
        v3 away = v3_sub(i < 0 ? bridle : self->point[i].r, self->hold.r);
        reach = fmax(reach, hypot(away.x, away.z));
    }
    return reach;
}

bool line_rests(const flight_line *self)
{
    const double slow = 0.1; // [m/s]
    for (int i = 0; i < self->count; i++)
        if (v3_norm(self->point[i].v) > slow)
            return false;
    return true;
}
