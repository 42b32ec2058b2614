#include "support/lumped_launch.h"

#include <string.h>

#include "launchdyn/scenario.h"
#include "math/matrices/dense.h"
#include "scenario/scenario.h"
#include "support/check.h"

// ---- places

static void place_all(const void *it, cplx t, const cplx *q, cplx (*r)[3])
{
    const lumped_launch *self = it;
    const cplx *x = q + self->first;
    lumped_frame tube;
    self->base->place(self->base->self, t, q, r, &tube);
    for (int k = 0; k < self->rocket - self->carried; k++)
        put_point(tube.r, &tube.A, self->tube_point[k], r[self->carried + k]);
    cplx_matrix A =
        turns(turns(turn_z(x[ROCKET_PITCH]), turn_y(x[ROCKET_YAW])), turn_x(x[ROCKET_ROLL]));
    cplx_matrix body = turns(tube.A, A);
    cplx origin[3];
    for (int i = 0; i < 3; i++)
        origin[i] = tube.r[i] + tube.A.a[i][0] * x[ROCKET_S];
    for (int k = 0; k < RIGID_POINTS + 2; k++)
        put_point(origin, &body, self->rocket_point[k], r[self->rocket + k]);
}

// Linear between the rows.
static double thrust_at(const ld_table *table, double t)
{
    for (size_t i = 0; i + 1 < table->rows; i++) {
        const double *row = table->data + 2 * i;
        if (t >= row[0] && t < row[2])
            return row[1] + (row[3] - row[1]) * (t - row[0]) / (row[2] - row[0]);
    }
    return 0;
}

// Thrust along the axis, from the rear adaptor's centre to the point before it.
static void push_all(const void *it, double t, const mass_motion *now, double (*F)[3], double *Q,
                     double *z_dot)
{
    const lumped_launch *self = it;
    int rear = self->rocket + RIGID_POINTS, ahead = rear + 1;
    double f = self->gone ? 0 : thrust_at(&self->model->rocket.motor.thrust, t);
    for (int i = 0; i < 3; i++)
        F[rear][i] += f * (now->r[ahead][i] - now->r[rear][i]);
    self->base->push(self->base->self, t, now, F, Q, z_dot);
}

// ---- begin

static void add_tube(lumped_launch *self, int *count)
{
    const ld_tubes *tubes = &self->model->tubes;
    for (int k = 0; k < tubes->section_count; k++) {
        const ld_section *section = &tubes->section[k];
        double end = k + 1 < tubes->section_count ? section[1].from : tubes->length;
        double length = end - section->from, mass = section->mass_per_length * length;
        double across = mass * length * length / 12, middle[3] = {section->from + length / 2, 0, 0};
        double J[3] = {section->polar_inertia * length, across, across};
        rigid_points(mass, middle, J, self->tube_point + *count,
                     self->system.mass + self->carried + *count);
        *count += RIGID_POINTS;
    }
    if (tubes->tail.mass > 0) {
        double c[3] = {tubes->tail.center, 0, 0};
        rigid_points(tubes->tail.mass, c, tubes->tail.inertia, self->tube_point + *count,
                     self->system.mass + self->carried + *count);
        *count += RIGID_POINTS;
    }
}

void lumped_begin(lumped_launch *self, const ld_model *model, const lumped_base *base, double t,
                  double step, const double *q, const double *u, const double *z)
{
    const ld_rocket *rocket = &model->rocket;
    int tube = 0, n = base->coordinates + ROCKET_COORDINATES;
    memset(self, 0, sizeof *self);
    self->model = model;
    self->base = base;
    self->t = t;
    self->step = step;
    self->first = base->coordinates;
    self->carried = base->points;
    self->system.coordinates = n;
    self->system.extra = base->extra;
    self->system.gravity = model->gravity;
    self->system.place = place_all;
    self->system.push = push_all;
    self->system.self = self;
    memcpy(self->system.mass, base->mass, (size_t)base->points * sizeof *base->mass);
    add_tube(self, &tube);
    self->rocket = self->carried + tube;
    rigid_points(rocket->full.mass, rocket->full.center, rocket->full.inertia, self->rocket_point,
                 self->system.mass + self->rocket);
    self->rocket_point[RIGID_POINTS + 1][0] = 1; // a point ahead, for the thrust
    self->system.points = self->rocket + RIGID_POINTS + 2;
    memcpy(self->y, q, (size_t)base->coordinates * sizeof *q);
    self->y[self->first + ROCKET_S] = rocket->start_at;
    if (u)
        memcpy(self->y + n, u, (size_t)base->coordinates * sizeof *u);
    if (z)
        memcpy(self->y + 2 * n, z, (size_t)base->extra * sizeof *z);
    self->locked = self->both = true;
    for (int i = 0; i < ROCKET_COORDINATES; i++)
        self->system.held[self->first + i] = true; // the lock holds roll where no slot does
}

static void accelerations_of(const lumped_launch *self, const int *coordinate, int count, double *a)
{
    double y_dot[2 * MOST_COORDINATES + MOST_EXTRA];
    masses_rates(&self->system, self->t, self->y, y_dot, NULL);
    for (int i = 0; i < count; i++)
        a[i] = y_dot[self->system.coordinates + coordinate[i]];
}

void lumped_settle(lumped_launch *self, const int *coordinate, int count)
{
    const double h = 1e-6;
    double a[8], side[2][8], J[64];
    int pivot[8];
    for (int turn = 0; turn < 8; turn++) {
        accelerations_of(self, coordinate, count, a);
        for (int j = 0; j < count; j++) {
            double *q = &self->y[coordinate[j]], middle = *q;
            for (int s = 0; s < 2; s++) {
                *q = middle + (s ? h : -h);
                accelerations_of(self, coordinate, count, side[s]);
            }
            *q = middle;
            for (int i = 0; i < count; i++)
                J[i * count + j] = (side[1][i] - side[0][i]) / (2 * h);
        }
        assert_int_equal(lu_factor(count, J, pivot), 0);
        lu_solve(count, J, pivot, a);
        for (int i = 0; i < count; i++)
            self->y[coordinate[i]] -= a[i];
    }
    accelerations_of(self, coordinate, count, a);
    for (int i = 0; i < count; i++)
        CHECK_BELOW("acceleration at rest", fabs(a[i]), 1e-7);
}

// ---- on the way

// What rises through zero at the next event.
static double until_event(const lumped_launch *self, double t, const double *y)
{
    double s = y[self->first + ROCKET_S], length = self->model->tubes.length;
    if (self->locked) {
        double y_dot[2 * MOST_COORDINATES + MOST_EXTRA], holding[MOST_COORDINATES];
        masses_rates(&self->system, t, y, y_dot, holding);
        return -holding[self->first + ROCKET_S] - self->model->rocket.lock.release_force;
    }
    return s - length + (self->both ? self->model->rocket.adaptor[1].at : 0);
}

static void happen(lumped_launch *self)
{
    bool *held = self->system.held + self->first;
    if (self->locked) {
        self->locked = held[ROCKET_S] = held[ROCKET_ROLL] = false;
        self->t_release = self->t;
    } else if (self->both) {
        self->both = held[ROCKET_YAW] = held[ROCKET_PITCH] = false;
        self->t_front = self->t;
    } else {
        self->gone = true;
        self->t_rear = self->t;
    }
}

void lumped_advance(lumped_launch *self, double t)
{
    int count = 2 * self->system.coordinates + self->system.extra;
    while (self->t < t - 1e-12 && !self->gone) {
        double before[2 * MOST_COORDINATES + MOST_EXTRA], h = fmin(self->step, t - self->t);
        memcpy(before, self->y, (size_t)count * sizeof *before);
        masses_step(&self->system, self->t, h, self->y);
        bool waits = self->locked && self->t + h < 0; // nothing releases it before ignition
        if (waits || until_event(self, self->t + h, self->y) < 0) {
            self->t += h;
            continue;
        }
        double low = 0, high = h;
        for (int turn = 0; turn < 40; turn++) {
            double middle = 0.5 * (low + high);
            memcpy(self->y, before, (size_t)count * sizeof *before);
            masses_step(&self->system, self->t, middle, self->y);
            bool past = until_event(self, self->t + middle, self->y) >= 0;
            *(past ? &high : &low) = middle;
        }
        self->t += high;
        happen(self);
    }
}

// ---- compared

// Rates of pitch and yaw of the rocket's axis in the tube's axes as they are now.
static void rates_at_exit(const lumped_launch *self, double rate[2])
{
    static cplx r[MOST_POINTS][3];
    cplx q[MOST_COORDINATES];
    int n = self->system.coordinates, rear = self->rocket + RIGID_POINTS;
    double d[3] = {0}, d_dot[3] = {0};
    lumped_frame tube;
    for (int i = 0; i < n; i++)
        q[i] = self->y[i];
    self->base->place(self->base->self, self->t, q, r, &tube);
    for (int i = 0; i < n; i++)
        q[i] += I * 1e-30 * self->y[n + i];
    self->system.place(self->system.self, self->t + I * 1e-30, q, r);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            cplx along = r[rear + 1][i] - r[rear][i];
            d[k] += creal(tube.A.a[i][k]) * creal(along);
            d_dot[k] += creal(tube.A.a[i][k]) * cimag(along) / 1e-30;
        }
    double square = d[0] * d[0] + d[2] * d[2];
    rate[0] = d_dot[1] / sqrt(square);
    rate[1] = (d[2] * d_dot[0] - d[0] * d_dot[2]) / square;
}

void lumped_compare(lumped_launch *self, const recorded_run *run, const lumped_pair *pair,
                    int count, const lumped_exit *bound)
{
    size_t t = recorded_column(run, "t"), column[16];
    double worst[16] = {0}, span[16][2] = {{0}};
    for (int i = 0; i < count; i++)
        column[i] = recorded_column(run, pair[i].column);
    double end = run->summary.rocket[0].t_rear;
    for (size_t row = 0; row < run->rows && recorded_value(run, row, t) < end - 1e-9; row++) {
        lumped_advance(self, recorded_value(run, row, t));
        for (int i = 0; i < count && !self->gone; i++) {
            double now = recorded_value(run, row, column[i]);
            int at = pair[i].coordinate < 0 ? self->first + ROCKET_S : pair[i].coordinate;
            double other = pair[i].factor * self->y[at] + pair[i].offset;
            worst[i] = fmax(worst[i], fabs(now - other));
            span[i][0] = row ? fmin(span[i][0], now) : now;
            span[i][1] = row ? fmax(span[i][1], now) : now;
        }
    }
    lumped_advance(self, end + 1);
    for (int i = 0; i < count; i++) {
        char what[96];
        snprintf(what, sizeof what, "%s, which changes by %.3g", pair[i].column,
                 span[i][1] - span[i][0]);
        CHECK_BELOW(what, worst[i], pair[i].bound);
    }
    double speed = self->y[self->system.coordinates + self->first + ROCKET_S], rate[2];
    const ld_tip_off *off = &run->summary.rocket[0].tip_off;
    rates_at_exit(self, rate);
    CHECK_NEAR("exit [s]", end, self->t_rear, bound->time);
    CHECK_NEAR("exit speed [m/s]", run->summary.rocket[0].exit_speed, speed, bound->speed);
    CHECK_NEAR("pitch rate at the exit [rad/s]", off->pitch_rate, rate[0], bound->rates);
    CHECK_NEAR("yaw rate at the exit [rad/s]", off->yaw_rate, rate[1], bound->rates);
}

// ---- bases

const ld_body *lumped_body(const ld_model *model, const char *name)
{
    int i = mechanism_body(&model->base.mechanism, name);
    if (i < 0 || i >= model->base.mechanism.body_count)
        fail_msg("no body %s", name);
    return &model->base.mechanism.body[i];
}

const ld_joint *lumped_joint(const ld_model *model, const char *name)
{
    int i = mechanism_joint(&model->base.mechanism, name);
    if (i < 0)
        fail_msg("no joint %s", name);
    return &model->base.mechanism.joint[i];
}

int lumped_add_body(lumped_base *base, double (*point)[3], const ld_body *body)
{
    int first = base->points;
    rigid_points(body->mass, body->center, body->inertia, point + first, base->mass + first);
    base->points += RIGID_POINTS;
    return first;
}

int lumped_add_marker(lumped_base *base, double (*point)[3], const double at[3])
{
    memcpy(point[base->points], at, sizeof point[0]);
    base->mass[base->points] = 0;
    return base->points++;
}

void lumped_model(const char *name, const char *const *sets, size_t count, ld_model *model)
{
    static const char *const rigid[] = {
        "environment.wind=none",
        "environment.atmosphere=none",
        "rocket.aerodynamics=none",
        "rocket.empty=",
        "rocket.eccentricity=0 0 m",
        "rocket.motor.misalignment=0 0 deg",
        "rocket.contact.law=ideal",
        "rocket.contact.restitution=",
        "rocket.contact.friction=",
        "tubes.guide=bore",
        "tubes.slot=none",
        "tubes.modes.bending=1",
        "tubes.modes.torsion=0",
        "tubes.sections=[{from: 0 m, bore_radius: 80 mm, mass_per_length: 10 kg/m, "
        "axial_stiffness: "
        "1e11 N, bending_stiffness: 1e9 N.m2, torsion_stiffness: 1e9 N.m2, polar_inertia: 0.1 "
        "kg.m}]",
        "tubes.supports=[{at: 0.2 m, stiffness: 1e9 1e9 1e9 N/m, damping: 1e5 1e5 1e5 N.s/m, "
        "rotational_stiffness: 1e7 1e7 1e7 N.m/rad, rotational_damping: 1e3 1e3 1e3 N.m.s/rad}, "
        "{at: 2.6 m, stiffness: 1e9 1e9 1e9 N/m, damping: 1e5 1e5 1e5 N.s/m}]",
        "run.tolerance=1e-8",
    };
    enum { RIGID = sizeof rigid / sizeof *rigid };
    const char *all[RIGID + 16];
    char path[512];
    ld_messages messages;
    memcpy(all, rigid, sizeof rigid);
    memcpy(all + RIGID, sets, count * sizeof *sets);
    snprintf(path, sizeof path, "%s/examples/multibody/%s", LD_SOURCE_DIR, name);
    if (scenario_read(path, all, RIGID + count, model, &messages)) {
        ld_messages_print(&messages, stderr);
        fail_msg("%s", path);
    }
}
