// The marching subsystem: energy, action and reaction on random states, then one wheel against
// closed forms.
#include <stdlib.h>

#include "model/model.h"
#include "support/check.h"
#include "support/draw.h"
#include "support/reference_model.h"
#include "systems/mechanism/marching.h"

static const double PI = 3.141592653589793238462643383280, GRAVITY = 9.80665;

enum { WHEELS = 6, STATES = WHEEL_STATES * WHEELS + 1, Z_D = STATES - 1 };

typedef struct fixture {
    ld_model model;
    ld_vehicle *vehicle;
    marching_system system;
} fixture;

// The reference vehicle on a flat road, its data still to be changed before build().
static void set_up(fixture *f, double speed)
{
    reference_vehicle(&f->model, speed);
    f->vehicle = &f->model.base.vehicle;
}

static void build(fixture *f)
{
    ld_error error;
    if (marching_build(&f->system, f->vehicle, GRAVITY, (double[]){-10, 10}, NULL, &error))
        fail_msg("%s", error.text);
}

static void tear_down(fixture *f)
{
    marching_free(&f->system);
    reference_model_free(&f->model);
}

static void make_wavy(fixture *f)
{
    ld_road *waves = &f->vehicle->road;
    waves->form = LD_ROAD_SUM;
    waves->sine_count = 2;
    waves->sine[0] = (ld_road_sine){0.02, 3.1, 0.4};
    waves->sine[1] = (ld_road_sine){0.01, 0.9, 1.4};
    waves->bump_count = 1;
    waves->bump[0] = (ld_bump){-4, 8, 0.03, LD_TRACK_RIGHT};
}

// A chassis frame that stands level at height y, or moves.
static base_frame level_frame(double y, v3 v)
{
    return (base_frame){
        .r = {0, y, 0}, .v = v, .A = m3_identity(), .q = {1, 0, 0, 0}, .w = v3_zero()};
}

// ---- balances

// The chassis in motion, as the wheels know it, and where it is a time h later.
typedef struct flight {
    base_frame frame;
    v3 a, alpha;
} flight;

static base_frame frame_after(const flight *path, double h)
{
    base_frame frame = path->frame;
    v3 turn = v3_axpy(v3_scale(h, path->frame.w), 0.5 * h * h, path->alpha);
    double angle = v3_norm(turn), s = angle > 0 ? sin(0.5 * angle) / angle : 0.5;
    quat q = {cos(0.5 * angle), s * turn.x, s * turn.y, s * turn.z};
    frame.r = v3_axpy(v3_axpy(frame.r, h, path->frame.v), 0.5 * h * h, path->a);
    frame.v = v3_axpy(frame.v, h, path->a);
    frame.w = v3_axpy(frame.w, h, path->alpha);
    frame.q = q_multiply(q, path->frame.q);
    frame.A = q_matrix(frame.q);
    return frame;
}

// Any heading, some tilt.
static flight draw_flight(uint64_t *seed)
{
    flight path;
    m3 tilt = m3_mul(m3_rotation_z(0.05 * draw(seed)), m3_rotation_x(0.05 * draw(seed)));
    path.frame.A = m3_mul(m3_rotation_y(PI * draw(seed)), tilt);
    path.frame.q = q_from_matrix(path.frame.A);
    path.frame.r = v3_add(v3_make(0, 1.2, 0), draw_v3(seed, 0.1));
    path.frame.v = draw_v3(seed, 10);
    path.frame.w = draw_v3(seed, 1);
    path.a = draw_v3(seed, 10);
    path.alpha = draw_v3(seed, 5);
    return path;
}

// Wheels near their mounts with any tyre state.
static void draw_wheels(const fixture *f, uint64_t *seed, const base_frame *chassis, double *state)
{
    marching_place(&f->system, chassis, state);
    for (int j = 0; j < WHEELS; j++) {
        double *wheel = state + WHEEL_STATES * j;
        v3_store(wheel + WHEEL_R, v3_add(v3_from(wheel + WHEEL_R), draw_v3(seed, 0.1)));
        v3_store(wheel + WHEEL_V, draw_v3(seed, 10));
        wheel[WHEEL_ETA] = 0.05 * draw(seed);
        wheel[WHEEL_XI] = 0.05 * draw(seed);
    }
    state[Z_D] = draw(seed);
}

// All at one state: energy, action and reaction, travel's rate. Largest relative errors so far.
typedef struct balance_errors {
    double energy, elastic, force, moment, travel;
} balance_errors;

static double worst(double so_far, double error)
{
    return fabs(error) <= so_far ? so_far : fabs(error); // a NaN stays
}

// Returns how many wheels touch the road.
static int check_state(const fixture *f, const flight *path, const double *state,
                       balance_errors *errors)
{
    const base_frame *chassis = &path->frame;
    double dot[STATES], near[STATES], scratch[STATES];
    marching_output out, side[2];
    marching_evaluate(&f->system, chassis, false, NULL, state, dot, &out);

    // elastic energy and travel a little before and after
    const double h = 1e-6;
    for (int k = 0; k < 2; k++) {
        double step = k ? h : -h;
        for (int i = 0; i < STATES; i++)
            near[i] = state[i] + step * dot[i];
        for (int j = 0; j < WHEELS; j++) // along the parabola, as the chassis does
            v3_store(near + WHEEL_STATES * j,
                     v3_axpy(v3_from(near + WHEEL_STATES * j), 0.5 * step * step,
                             v3_from(dot + WHEEL_STATES * j + WHEEL_V)));
        base_frame frame = frame_after(path, step);
        marching_evaluate(&f->system, &frame, false, NULL, near, scratch, &side[k]);
    }
    double change = (side[1].elastic - side[0].elastic) / (2 * h), elastic = 0;
    double size = fabs(change), power = 0;
    double rate = v3_dot(out.force, chassis->v) + v3_dot(out.moment, chassis->w);

    v3 force = out.force, moment = v3_add(v3_cross(chassis->r, out.force), out.moment);
    int touching = 0;
    double largest = v3_norm(force), largest_moment = v3_norm(moment);
    for (int j = 0; j < WHEELS; j++) {
        const wheel_report *report = &out.wheel[j];
        const double *wheel = state + WHEEL_STATES * j;
        v3 r = v3_from(wheel + WHEEL_R), a = v3_from(dot + WHEEL_STATES * j + WHEEL_V);
        double mass = f->vehicle->wheel[j].mass;
        touching += report->normal > 0;
        rate += mass * v3_dot(a, v3_from(wheel + WHEEL_V));
        // the force of spring and stop is that of the suspension less its damper's
        v3 damper = v3_mul(v3_from(f->vehicle->suspension.damping), report->travel_rate);
        elastic -= v3_dot(v3_add(report->suspension, damper), report->travel_rate);
        a.y += GRAVITY;
        // what wheel and chassis get, less what the road gives at the contact point, is nothing
        v3 ahead = m3_column(chassis->A, 0);
        double level = hypot(ahead.x, ahead.z);
        v3 e_f = {ahead.x / level, 0, ahead.z / level}, e_s = v3_cross(e_f, v3_make(0, 1, 0));
        v3 ground =
            v3_axpy(v3_axpy(v3_make(0, report->normal, 0), report->along, e_f), report->side, e_s);
        v3 c = {r.x, report->height, r.z};
        force = v3_sub(v3_axpy(force, mass, a), ground);
        moment = v3_sub(v3_axpy(moment, mass, v3_cross(r, a)), v3_cross(c, ground));
        v3 travel_rate =
            v3_scale(0.5 / h, v3_sub(side[1].wheel[j].travel, side[0].wheel[j].travel));
        errors->travel = worst(errors->travel, v3_norm(v3_sub(travel_rate, report->travel_rate)));
    }
    for (int k = 0; k < MARCHING_POWERS; k++) {
        power += out.power[k];
        size += fabs(out.power[k]);
    }
    errors->energy = worst(errors->energy, (rate + elastic - power) / size);
    errors->elastic = worst(errors->elastic, (elastic - change) / size);
    errors->force = worst(errors->force, v3_norm(force) / largest);
    errors->moment = worst(errors->moment, v3_norm(moment) / largest_moment);
    return touching;
}

static void check_balances(double speed, uint64_t seed)
{
    fixture f;
    set_up(&f, speed);
    make_wavy(&f);
    f.vehicle->suspension.bump_stop.compression = 0.04;
    f.vehicle->suspension.bump_stop.extension = 0.03;
    f.vehicle->suspension.bump_stop.stiffness = 3e6;
    for (int j = 0; j < 3; j++)
        f.vehicle->wheel[j].driven = false;
    build(&f);
    balance_errors errors = {0};
    int touching = 0;
    for (int sample = 0; sample < 300; sample++) {
        double state[STATES];
        flight path = draw_flight(&seed);
        draw_wheels(&f, &seed, &path.frame, state);
        touching += check_state(&f, &path, state, &errors);
    }
    printf("  at %g m/s, %d of %d wheels on the road\n", speed, touching, 300 * WHEELS);
    assert_in_range(touching, 600, 1500);
    CHECK_BELOW("energy rate against powers, relative", errors.energy, 2e-15);
    CHECK_BELOW("spring force against elastic energy, relative", errors.elastic, 3e-8);
    CHECK_BELOW("forces add up, relative", errors.force, 2e-15);
    CHECK_BELOW("moments add up, relative", errors.moment, 1e-14);
    CHECK_BELOW("rate of the suspension's travel [m/s]", errors.travel, 1e-8);
    tear_down(&f);
}

static void test_balances(void **context)
{
    (void)context;
    check_balances(8, 1);
    check_balances(0, 2);
}

// The tyre's deflection rate, by its damper, is that of its deflection: slope included.
static void test_tyre_on_slope(void **context)
{
    (void)context;
    fixture f;
    set_up(&f, 8);
    make_wavy(&f);
    build(&f);
    base_frame chassis = level_frame(1.2, v3_make(8, 0, 0));
    double state[STATES], dot[STATES], error = 0;
    marching_output out, near;
    uint64_t seed = 3;
    for (int sample = 0; sample < 100; sample++) {
        draw_wheels(&f, &seed, &chassis, state);
        for (int j = 0; j < WHEELS; j++)
            state[WHEEL_STATES * j + WHEEL_R + 1] = 0.4;
        marching_evaluate(&f.system, &chassis, false, NULL, state, dot, &out);
        const double h = 1e-6;
        double moved[STATES], scratch[STATES], change[WHEELS] = {0};
        for (int k = -1; k <= 1; k += 2) {
            for (int i = 0; i < STATES; i++)
                moved[i] = state[i] + k * h * dot[i];
            marching_evaluate(&f.system, &chassis, false, NULL, moved, scratch, &near);
            for (int j = 0; j < WHEELS; j++)
                change[j] += k * near.wheel[j].deflection / (2 * h);
        }
        for (int j = 0; j < WHEELS; j++) {
            double p_dot = (out.wheel[j].normal - 1.1e6 * out.wheel[j].deflection) / 4e3;
            error = worst(error, p_dot - change[j]);
        }
    }
    CHECK_BELOW("rate of the tyre's deflection [m/s]", error, 3e-9);
    tear_down(&f);
}

// Wheels with mount z < 0 run on the left track: a bump under the others lifts them alone.
static void test_tracks(void **context)
{
    (void)context;
    fixture f;
    set_up(&f, 8);
    make_wavy(&f);
    f.vehicle->road.sine_count = 0;
    build(&f);
    base_frame chassis = level_frame(1.2, v3_zero());
    double state[STATES], dot[STATES];
    marching_output out;
    marching_place(&f.system, &chassis, state);
    marching_evaluate(&f.system, &chassis, false, NULL, state, dot, &out);
    for (int j = 0; j < WHEELS; j++) {
        double x = f.vehicle->wheel[j].mount[0];
        double bump = 0.015 * (1 - cos(2 * PI * (x + 4) / 8));
        CHECK_NEAR(f.vehicle->wheel[j].name, out.wheel[j].height, j % 2 ? bump : 0, 1e-16);
    }
    tear_down(&f);
}

// ---- one wheel against closed forms

// The unilateral vertical force: none in the air, none where damping would pull.
static void test_unilateral(void **context)
{
    (void)context;
    fixture f;
    set_up(&f, 8);
    build(&f);
    base_frame chassis = level_frame(1.25, v3_zero());
    const struct {
        double y, v, normal; // centre's height, its speed
    } row[] = {
        {0.55, -1, 0},                         // p = 0
        {0.5501, -1, 0},                       // in the air, falling
        {0.54, 0, 1.1e4},                      // p = 10 mm
        {0.54, -1, 1.1e4 + 4e3},               //
        {0.54, 2, 1.1e4 - 8e3},                //
        {0.54, 3, 0},                          // damping would pull
        {0.54, 1.1e4 / 4e3 - 1e-9, 4e3 * 1e-9} // just before
    };
    double state[STATES], dot[STATES];
    marching_output out;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        marching_place(&f.system, &chassis, state);
        state[WHEEL_R + 1] = row[k].y;
        state[WHEEL_V + 1] = row[k].v;
        state[WHEEL_ETA] = 0.01;
        marching_evaluate(&f.system, &chassis, false, NULL, state, dot, &out);
        CHECK_NEAR("normal force [N]", out.wheel[0].normal, row[k].normal, 2e-10);
        if (row[k].normal == 0)
            CHECK_BELOW("no side force either", fabs(out.wheel[0].side), 0);
    }
    tear_down(&f);
}

// Static loads: suspension and tyre deflect by load over stiffness, and then nothing moves.
static void test_static_deflection(void **context)
{
    (void)context;
    fixture f;
    set_up(&f, 0);
    build(&f);
    const double load = 25000, weight = 220 * GRAVITY;
    double tyre = (load + weight) / 1.1e6, spring = load / 4e5;
    base_frame chassis = level_frame(0.55 - tyre - spring + 0.7, v3_zero());
    double state[STATES], dot[STATES], fastest = 0;
    marching_output out;
    marching_place(&f.system, &chassis, state);
    for (int j = 0; j < WHEELS; j++)
        state[WHEEL_STATES * j + WHEEL_R + 1] += spring;
    marching_evaluate(&f.system, &chassis, false, NULL, state, dot, &out);
    for (int k = 0; k < STATES; k++)
        fastest = worst(fastest, dot[k]);
    CHECK_BELOW("acceleration of wheels [m/s2]", fastest, 1e-11);
    CHECK_NEAR("force on the chassis [N]", out.force.y, WHEELS * load, 1e-8);
    CHECK_NEAR("tyre force [N]", out.wheel[0].normal, load + weight, 1e-9);
    // front wheels at 2.7, the others at -1.1 and -2.5 m
    CHECK_NEAR("pitching moment [N m]", out.moment.z, 2 * load * (2.7 - 1.1 - 2.5), 1e-8);
    CHECK_NEAR("elastic energy [J]", out.elastic, WHEELS * 0.5 * 4e5 * spring * spring, 1e-9);
    tear_down(&f);
}

// A quarter car: chassis of mass M upon all six wheels, heaving. Frequencies by the stiffness
// matrix of differences against the closed form.
static void test_quarter_car(void **context)
{
    (void)context;
    fixture f;
    set_up(&f, 0);
    build(&f);
    const double M = 11000, m = 6 * 220.0, k_s = 6 * 4e5, k_t = 6 * 1.1e6, h = 1e-4;
    double matrix[2][2];
    for (int column = 0; column < 2; column++) {
        double acceleration[2][2];
        for (int k = 0; k < 2; k++) {
            double change = k ? h : -h, state[STATES], dot[STATES];
            marching_output out;
            base_frame chassis = level_frame(1.2, v3_zero());
            marching_place(&f.system, &chassis, state);
            if (column == 0)
                chassis.r.y += change;
            for (int j = 0; j < WHEELS && column == 1; j++)
                state[WHEEL_STATES * j + WHEEL_R + 1] += change;
            marching_evaluate(&f.system, &chassis, false, NULL, state, dot, &out);
            acceleration[k][0] = out.force.y / M;
            acceleration[k][1] = dot[WHEEL_V + 1];
        }
        for (int row = 0; row < 2; row++)
            matrix[row][column] = (acceleration[0][row] - acceleration[1][row]) / (2 * h);
    }
    double trace = matrix[0][0] + matrix[1][1];
    double determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
    double root = sqrt(0.25 * trace * trace - determinant);
    // M m w^4 - (M (k_s + k_t) + m k_s) w^2 + k_s k_t = 0
    double b = (M * (k_s + k_t) + m * k_s) / (2 * M * m), c = k_s * k_t / (M * m);
    double slow = c / (b + sqrt(b * b - c)), fast = b + sqrt(b * b - c);
    CHECK_NEAR("heave [Hz]", sqrt(0.5 * trace - root) / (2 * PI), sqrt(slow) / (2 * PI), 1e-10);
    CHECK_NEAR("wheel hop [Hz]", sqrt(0.5 * trace + root) / (2 * PI), sqrt(fast) / (2 * PI), 1e-10);
    tear_down(&f);
}

static void test_bump_stops(void **context)
{
    (void)context;
    fixture f;
    set_up(&f, 0);
    f.vehicle->suspension.bump_stop.compression = 0.1;
    f.vehicle->suspension.bump_stop.extension = 0.08;
    f.vehicle->suspension.bump_stop.stiffness = 3e6;
    build(&f);
    // the chassis lies on its side, so that its y axis points along -z of I
    base_frame chassis = {.r = {1, 5, 2}, .A = m3_rotation_x(-PI / 2)};
    const double travel[] = {0.1, 0.11, -0.08, -0.1, 0.05};
    const double stop[] = {0, -3e6 * 0.01, 0, 3e6 * 0.02, 0};
    double state[STATES], dot[STATES];
    marching_output out;
    for (int k = 0; k < 5; k++) {
        marching_place(&f.system, &chassis, state);
        state[WHEEL_R + 2] -= travel[k];
        marching_evaluate(&f.system, &chassis, false, NULL, state, dot, &out);
        double force = -4e5 * travel[k] + stop[k];
        CHECK_NEAR("travel [m]", out.wheel[0].travel.y, travel[k], 1e-15);
        CHECK_NEAR("force along the chassis' y axis [N]", out.wheel[0].suspension.y, force, 1e-8);
        CHECK_NEAR("on the wheel along z [N]", 220 * dot[WHEEL_V + 2], -force, 1e-8);
        double energy = 0.5 * 4e5 * travel[k] * travel[k] + 0.5 * stop[k] * stop[k] / 3e6;
        CHECK_NEAR("elastic energy [J]", out.elastic, energy, 1e-9);
    }
    tear_down(&f);
}

// ---- tyre sideways and along

// A wheel held at 10 mm of tyre deflection under a level chassis that moves with it at v.
static double side_by_side(const fixture *f, v3 v, double eta, double xi, double *eta_dot,
                           marching_output *out)
{
    base_frame chassis = level_frame(1.24, v);
    double state[STATES], dot[STATES];
    marching_place(&f->system, &chassis, state);
    for (int j = 0; j < WHEELS; j++) {
        v3_store(state + WHEEL_STATES * j + WHEEL_V, v);
        state[WHEEL_STATES * j + WHEEL_ETA] = eta;
        state[WHEEL_STATES * j + WHEEL_XI] = xi;
    }
    marching_evaluate(&f->system, &chassis, false, NULL, state, dot, out);
    *eta_dot = dot[WHEEL_ETA];
    assert_true(f->system.parked || dot[WHEEL_XI] == 0);
    return out->wheel[0].side;
}

// A step of slip v_s/v: eta = sigma v_s/v (1 - exp(-x/sigma)) over the distance x, whatever the
// speed, either way.
static void test_relaxation_length(void **context)
{
    (void)context;
    fixture f;
    set_up(&f, 8);
    build(&f);
    double error = 0;
    for (double speed = -5; speed < 10; speed += 5) {
        if (speed == 0)
            continue;
        const double slip = 0.02, sigma = 0.3, step = 0.01; // [m] of distance
        double v_s = slip * fabs(speed), eta = 0, h = step / fabs(speed), k[4];
        marching_output out;
        v3 v = {speed, 0, v_s};
        for (int i = 1; i <= 100; i++) {
            // classical Runge-Kutta: error of a step (step/sigma)^5/120
            side_by_side(&f, v, eta, 0, &k[0], &out);
            side_by_side(&f, v, eta + 0.5 * h * k[0], 0, &k[1], &out);
            side_by_side(&f, v, eta + 0.5 * h * k[1], 0, &k[2], &out);
            side_by_side(&f, v, eta + h * k[2], 0, &k[3], &out);
            eta += h / 6 * (k[0] + 2 * k[1] + 2 * k[2] + k[3]);
            error = worst(error, eta / (sigma * slip) - (1 - exp(-i * step / sigma)));
        }
    }
    CHECK_BELOW("step response over distance, relative", error, 1e-8);
    tear_down(&f);
}

// Rolling: the damper works on the deflection's rate, not on the slip alone.
static void test_rolling_side_force(void **context)
{
    (void)context;
    fixture f;
    set_up(&f, 8);
    f.vehicle->tyre.friction = 1e9;
    build(&f);
    const double eta = 1e-3, eta_dot = 0.05 - 8 * eta / 0.3;
    double rate;
    marching_output out;
    double side = side_by_side(&f, v3_make(-8, 0, 0.05), eta, 0, &rate, &out);
    CHECK_NEAR("rate of the deflection [m/s]", rate, eta_dot, 1e-15);
    CHECK_NEAR("side force [N]", side, -5e5 * eta - 4e3 * eta_dot, 1e-10);
    tear_down(&f);
}

// |f| = |f_0|/sqrt(1 + |f_0|^2/(mu F_n)^2): its direction stays, mu F_n is reached from below.
static void test_friction_limit(void **context)
{
    (void)context;
    fixture f;
    set_up(&f, 0);
    build(&f);
    const double limit = 0.8 * 1.1e4;
    double eta_dot, along_0, side_0;
    marching_output out;
    for (double size = 1e-4; size < 1e9; size *= 1e3) {
        side_by_side(&f, v3_zero(), 0.6 * size, -size, &eta_dot, &out);
        along_0 = 4e5 * size;
        side_0 = -5e5 * 0.6 * size;
        double wanted = hypot(along_0, side_0);
        double share = 1 / sqrt(1 + wanted * wanted / (limit * limit));
        CHECK_NEAR("along [N]", out.wheel[0].along, along_0 * share, 1e-11);
        CHECK_NEAR("side [N]", out.wheel[0].side, side_0 * share, 1e-11);
    }
    CHECK_NEAR("at the limit [N]", hypot(out.wheel[0].along, out.wheel[0].side), limit, 1e-11);
    // dampers count as well: creep forward and to the right with deflected tyre
    side_by_side(&f, v3_make(0.01, 0, 0.02), 1e-3, 2e-3, &eta_dot, &out);
    along_0 = -4e5 * 2e-3 - 4e3 * 0.01;
    side_0 = -5e5 * 1e-3 - 4e3 * 0.02;
    double share = limit / sqrt(limit * limit + along_0 * along_0 + side_0 * side_0);
    CHECK_NEAR("creeping: along [N]", out.wheel[0].along, along_0 * share, 1e-12);
    CHECK_NEAR("creeping: side [N]", out.wheel[0].side, side_0 * share, 1e-12);
    tear_down(&f);
}

// A heavy mass on parked tyres under a side load, damped: it comes to rest where the friction
// circle's force balances the load, eta = (F/k)/sqrt(1 - (F/mu F_n)^2), and creeps no further.
static void test_parked_hold(void **context)
{
    (void)context;
    fixture f;
    set_up(&f, 0);
    build(&f);
    const double load = 5000, limit = 0.8 * 1.1e4, mass = 2000, h = 2e-3; // of one wheel
    double eta = 0, v = 0, eta_dot;
    marching_output out;
    for (int i = 0; i < 30000; i++) {
        // semi-implicit Euler: its position of rest is exact
        double side = side_by_side(&f, v3_make(0, 0, v), eta, 0, &eta_dot, &out);
        v += h * (load + side) / mass;
        eta += h * v;
    }
    double ratio = load / limit;
    CHECK_NEAR("deflection [m]", eta, load / 5e5 / sqrt(1 - ratio * ratio), 1e-12);
    CHECK_BELOW("creep [m/s]", v, 1e-12);
    tear_down(&f);
}

// ---- drive

// v' = F/M with F = kp (V - v) + ki z_d: the lag V - v obeys M e'' + kp e' + ki e = 0; from e = e_0
// and z_d = 0 it is e_0 (cos w t - d/w sin w t) exp(-d t), d = kp/2M, w^2 = ki/M - d^2.
static void test_drive_step(void **context)
{
    (void)context;
    fixture f;
    const double M = 16000, step = 2, V = 8;
    set_up(&f, V);
    f.vehicle->drive.ki = 1e5;
    for (int j = 0; j < 4; j++)
        f.vehicle->wheel[j].driven = false;
    f.vehicle->tyre.friction = 1e9;
    build(&f);
    const double h = 0.01, d = 4e4 / (2 * M), w = sqrt(1e5 / M - d * d);
    double y[2] = {V - step, 0}, k[4][2], error = 0, share_error = 0;
    const double at[4] = {0, 0.5, 0.5, 1};
    for (int i = 1; i <= 500; i++) {
        for (int stage = 0; stage < 4; stage++) {
            double state[STATES], dot[STATES], v = y[0], z = y[1];
            if (stage) {
                v += at[stage] * h * k[stage - 1][0];
                z += at[stage] * h * k[stage - 1][1];
            }
            // heading 0.5 rad to the left: v counts along it, sideways motion does not
            base_frame chassis = level_frame(1.24, v3_zero());
            chassis.A = m3_mul(m3_rotation_y(0.5), m3_rotation_z(0.1));
            chassis.v = v3_make(v * cos(0.5) - 3 * sin(0.5), 1, -v * sin(0.5) - 3 * cos(0.5));
            marching_output out;
            marching_place(&f.system, &chassis, state);
            for (int j = 0; j < WHEELS; j++)
                state[WHEEL_STATES * j + WHEEL_R + 1] = 0.54;
            state[Z_D] = z;
            marching_evaluate(&f.system, &chassis, false, NULL, state, dot, &out);
            k[stage][0] = out.drive_force / M;
            k[stage][1] = dot[Z_D];
            for (int j = 0; j < WHEELS; j++) {
                double part = j < 4 ? 0 : out.drive_force / 2;
                share_error = worst(share_error, out.wheel[j].along - part);
            }
        }
        for (int c = 0; c < 2; c++)
            y[c] += h / 6 * (k[0][c] + 2 * k[1][c] + 2 * k[2][c] + k[3][c]);
        double t = i * h, e = step * (cos(w * t) - d / w * sin(w * t)) * exp(-d * t);
        error = worst(error, V - y[0] - e);
    }
    // held in the equilibrium it gives nothing
    base_frame chassis = level_frame(1.24, v3_zero());
    double state[STATES], dot[STATES];
    marching_output out;
    marching_place(&f.system, &chassis, state);
    marching_evaluate(&f.system, &chassis, true, NULL, state, dot, &out);
    CHECK_BELOW("force of a held drive [N]", out.drive_force + out.wheel[5].along, 0);
    CHECK_BELOW("speed's lag against the closed form [m/s]", error, 1e-8);
    CHECK_BELOW("half the force on each of two driven wheels [N]", share_error, 1e-8);
    tear_down(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_balances),
        cmocka_unit_test(test_tyre_on_slope),
        cmocka_unit_test(test_tracks),
        cmocka_unit_test(test_rolling_side_force),
        cmocka_unit_test(test_unilateral),
        cmocka_unit_test(test_static_deflection),
        cmocka_unit_test(test_quarter_car),
        cmocka_unit_test(test_bump_stops),
        cmocka_unit_test(test_relaxation_length),
        cmocka_unit_test(test_friction_limit),
        cmocka_unit_test(test_parked_hold),
        cmocka_unit_test(test_drive_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
