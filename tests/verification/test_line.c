// A line that is drawn out of a container against closed forms: tension of steady pay-out, with
// drag; momentum and energy of what is drawn out; the elastic catenary, by number of segments; a
// rocket that coasts and pulls one; ends, breaks, ground.
#include "support/check.h"

#include <stdlib.h>

#include "support/flight_text.h"
#include "support/reference_model.h"
#include "systems/flight/line.h"
#include "systems/launching/launcher.h"

static const double g = 9.80665;
static const v3 still = {0, 0, 0};

static moving_air dense(const void *self, double t, v3 r)
{
    (void)t;
    (void)r;
    return (moving_air){still, *(const double *)self, 340};
}

// ---- by a given motion of the bridle

static void follow(flight_line *line, line_bridle (*at)(double t), double until)
{
    while (line->t < until) {
        line_bridle now = at(line->t);
        line_advance(line, fmin(until, line->t + line_step(line)), &now);
    }
}

static v3 away(void)
{
    return v3_scale(1 / sqrt(14), v3_make(2, 3, -1));
}

static line_bridle steadily(double t)
{
    return (line_bridle){v3_scale(1 + 70 * t, away()), v3_scale(70, away()), still};
}

// The pull is T_c + m' v^2 (a length is stretched when it is as fast: m' v^2/(1 + T/EA)), and with
// the drag along, 1/2 rho pi d C v^2 for each metre that is out; its mean over 35 m.
static void test_steady(void **state)
{
    (void)state;
    const ld_line given = {.present = true,
                           .length = 200,
                           .mass_per_length = 0.012,
                           .diameter = 0.004,
                           .stiffness = 9e4,
                           .damping = 0.1,
                           .breaking_force = NAN,
                           .drag_across = 1.2,
                           .drag_along = 0.015,
                           .tension = 7,
                           .segments = 25};
    const double density[] = {0, 1.3}, v = 70;
    for (int i = 0; i < 2; i++) {
        const line_setting setting = {
            .given = &given, .ground = -INFINITY, .air = dense, .self = &density[i]};
        line_bridle begin = steadily(0);
        flight_line *line = line_create(&setting, 0, &begin);
        follow(line, steadily, 1.5);
        v3 impulse = still;
        for (int k = 0; k < 400; k++) {
            line_bridle now = steadily(line->t);
            line_advance(line, 1.5 + 0.5 * (k + 1) / 400, &now);
            impulse = v3_axpy(impulse, 1.0 / 400, line->mean);
        }
        double out = 1 + v * 2, mean = 1 + v * 1.75, pi = acos(-1), strain = 65 / 9e4;
        double pull =
            7 + 0.012 * v * v / (1 + strain) + 0.5 * density[i] * pi * 0.004 * 0.015 * v * v * mean;
        double found = v3_norm(impulse);
        printf("  air of %.1f kg/m3: %.4f N, closed form %.4f N, %d points\n", density[i], found,
               pull, line->count);
        CHECK_NEAR("pull, relative", found / pull, 1, i ? 4e-3 : 1e-5);
        CHECK_NEAR("length out, less the strain, relative", line->paid / out,
                   1 - (7 + 0.012 * v * v) / 9e4, i ? 1e-3 : 3e-6);
        CHECK_NEAR("along the line", v3_dot(impulse, away()) / -found, 1, 1e-9);
        line_free(line);
    }
}

// ---- momentum and energy

static line_bridle winding(double t)
{
    return (line_bridle){{2 + 60 * t, 8 * t * t, 3 * sin(3 * t)},
                         {60, 16 * t, 9 * cos(3 * t)},
                         {0, 16, -27 * sin(3 * t)}};
}

typedef struct ledger {
    v3 impulse, momentum;                // [N s] of bridle and container, [kg m/s] of the line
    double work, kinetic, elastic, lost; // [J]
} ledger;

static void weigh(const flight_line *line, const line_bridle *end, ledger *sum)
{
    const ld_line *given = line->setting.given;
    double d = given->length / given->segments, m = given->mass_per_length;
    sum->momentum = v3_scale(0.5 * m * d, end->v);
    sum->kinetic = 0.25 * m * d * v3_norm2(end->v);
    sum->elastic = 0;
    for (int i = 0; i < line->count; i++) {
        bool last = i + 1 == line->count;
        double mass = m * (last ? 0.5 * d + line->paid - line->count * d : d);
        sum->momentum = v3_axpy(sum->momentum, mass, line->point[i].v);
        sum->kinetic += 0.5 * mass * v3_norm2(line->point[i].v);
        double stretched = v3_norm(v3_sub(i ? line->point[i - 1].r : end->r, line->point[i].r));
        sum->elastic += 0.5 * given->stiffness * d * pow(fmax(0, stretched / d - 1), 2);
    }
}

static double stored_in_last(const flight_line *line)
{
    const ld_line *given = line->setting.given;
    double d = given->length / given->segments;
    const line_point *last = &line->point[line->count - 1];
    return 0.5 * given->stiffness * d *
           pow(fmax(0, v3_norm(v3_sub(last[-1].r, last->r)) / d - 1), 2);
}

// Without weight and air: the impulses of bridle and container become momentum of the line, their
// work its energy and what is lost as it is drawn out, m' u v^2/2 in a second.
static void test_momentum_and_energy(void **state)
{
    (void)state;
    double residual[2];
    for (int i = 0; i < 2; i++) {
        const ld_line given = {.present = true,
                               .length = 130,
                               .mass_per_length = 0.05,
                               .diameter = 0.01,
                               .stiffness = 2e4,
                               .breaking_force = NAN,
                               .tension = 5,
                               .segments = i ? 80 : 40};
        const line_setting setting = {.given = &given, .ground = -INFINITY};
        line_bridle end = winding(0);
        flight_line *line = line_create(&setting, 0, &end);
        follow(line, winding, 0.2);
        end = winding(line->t);
        ledger begun, now, sum = {0};
        weigh(line, &end, &begun);
        while (line->t < 1.5) {
            line_bridle from = winding(line->t);
            double t = line->t, h = line_step(line) / 4;
            v3 out = line->point[line->count - 1].r, v = line->point[line->count - 1].v;
            double u = v3_dot(v, out) / v3_norm(out);
            double loss = 0.5 * 0.05 * line->rate * v3_norm2(v) + 5 * u;
            v3 held = v3_scale(-5 / v3_norm(out), out);
            int before = line->count;
            line_advance(line, t + h, &from);
            // what a segment stores when it is complete comes out of what is lost
            double stored = line->count > before ? stored_in_last(line) : 0;
            out = line->point[line->count - 1].r;
            v = line->point[line->count - 1].v;
            u = v3_dot(v, out) / v3_norm(out);
            loss += 0.5 * 0.05 * line->rate * v3_norm2(v) + 5 * u;
            held = v3_axpy(held, -5 / v3_norm(out), out);
            sum.lost += 0.5 * h * loss - stored;
            // of the mean force, and of its slope against the bridle's acceleration
            sum.impulse = v3_axpy(sum.impulse, -h, line->mean);
            sum.impulse = v3_axpy(sum.impulse, 0.5 * h, held);
            v3 middle = v3_axpy(from.v, 0.5 * h, from.a);
            sum.work -=
                h * v3_dot(line->mean, middle) + h * h * h / 12 * v3_dot(line->slope, from.a);
        }
        end = winding(line->t);
        weigh(line, &end, &now);
        v3 missing = v3_sub(v3_sub(now.momentum, begun.momentum), sum.impulse);
        residual[i] = fabs(sum.work - sum.lost - (now.kinetic - begun.kinetic) -
                           (now.elastic - begun.elastic)) /
                      sum.work;
        printf("  %d segments: momentum %.3f kg m/s, missing %.2e; work %.2f J, lost %.2f J, "
               "missing %.2e of it\n",
               given.segments, v3_norm(now.momentum), v3_norm(missing), sum.work, sum.lost,
               residual[i]);
        CHECK_BELOW("momentum that is missing, relative", v3_norm(missing) / v3_norm(now.momentum),
                    1.5e-5);
        line_free(line);
    }
    CHECK_BELOW("energy that is missing, of the work", residual[1], 3e-5);
}

// ---- catenary

static line_bridle out_and_back(double t)
{
    double x = t < 3 ? 1 + 11 * t : t < 6 ? 34 - 5 * (t - 3) : 19;
    double y = t < 6 ? 0.2 + t : 6.2, vx = t < 3 ? 11 : t < 6 ? -5 : 0, vy = t < 6 ? 1 : 0;
    return (line_bridle){{x, y, -0.4 * x}, {vx, vy, -0.4 * vx}, still};
}

// Elastic catenary of length L between supports at a distance (l, h), w weight per length, V and H
// the tension's parts at the upper end (H. M. Irvine, Cable Structures, 1981, chapter 1).
static void catenary(double l, double h, double L, double w, double EA, double *H, double *V)
{
    *H = w * l;
    *V = w * L;
    for (int i = 0; i < 200; i++) {
        double f[3][2], d = 1e-6 * *H;
        for (int k = 0; k < 3; k++) {
            double a = *H + (k == 1) * d, b = *V + (k == 2) * d, c = b - w * L;
            f[k][0] = a * L / EA + a / w * (asinh(b / a) - asinh(c / a)) - l;
            f[k][1] =
                L / EA * (b - 0.5 * w * L) + (sqrt(a * a + b * b) - sqrt(a * a + c * c)) / w - h;
        }
        double J[2][2] = {{(f[1][0] - f[0][0]) / d, (f[2][0] - f[0][0]) / d},
                          {(f[1][1] - f[0][1]) / d, (f[2][1] - f[0][1]) / d}};
        double det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
        double dH = -(J[1][1] * f[0][0] - J[0][1] * f[0][1]) / det;
        double dV = -(J[0][0] * f[0][1] - J[1][0] * f[0][0]) / det;
        double share = fmin(1, 0.3 * *H / (fabs(dH) + fabs(dV) + 1e-300));
        *H += share * dH;
        *V += share * dV;
    }
}

// A line that is all out and held comes to rest in heavy air.
static void test_catenary(void **state)
{
    (void)state;
    const double density = 800, L = 30, w = 0.5 * g, EA = 8e3;
    double H, V, error[3];
    catenary(19 * sqrt(1.16), 6.2, L, w, EA, &H, &V);
    for (int i = 0; i < 3; i++) {
        const ld_line given = {.present = true,
                               .length = L,
                               .mass_per_length = 0.5,
                               .diameter = 0.05,
                               .stiffness = EA,
                               .damping = 0.3,
                               .breaking_force = NAN,
                               .drag_across = 1.2,
                               .drag_along = 0.5,
                               .segments = 6 << i};
        const line_setting setting = {.given = &given,
                                      .gravity = {0, -g, 0},
                                      .ground = -INFINITY,
                                      .air = dense,
                                      .self = &density};
        line_bridle begin = out_and_back(0);
        flight_line *line = line_create(&setting, 0, &begin);
        follow(line, out_and_back, 80);
        v3 force = line_force(line, line->t);
        double pull[2] = {hypot(force.x, force.z), -force.y};
        error[i] = hypot(pull[0] - H, pull[1] - V) / hypot(H, V);
        printf("  %2d segments: H %.4f N, V %.4f N; catenary %.4f N, %.4f N\n", given.segments,
               pull[0], pull[1], H, V);
        assert_true(line->ended);
        line_free(line);
    }
    CHECK_BELOW("pull against the catenary, relative, 24 segments", error[2], 2e-4);
    CHECK_WITHIN("order in the number of segments", log2(error[0] / error[1]), 1.8, 2.2);
}

// ---- ends and breaks

static void test_ends(void **state)
{
    (void)state;
    for (int end = LD_LINE_HELD; end <= LD_LINE_FREE; end++) {
        const ld_line given = {.present = true,
                               .length = 50,
                               .mass_per_length = 0.012,
                               .diameter = 0.004,
                               .stiffness = 9e3,
                               .damping = 0.2,
                               .breaking_force = end == LD_LINE_HELD ? 900 : NAN,
                               .end = (ld_line_end)end,
                               .segments = 20};
        const line_setting setting = {.given = &given, .ground = -INFINITY};
        line_bridle begin = steadily(0);
        flight_line *line = line_create(&setting, 0, &begin);
        follow(line, steadily, 1.2);
        // strained by m' v^2/EA as it is drawn out
        double strain = 0.012 * 70 * 70 / 9e3;
        CHECK_NEAR("all is out [s]", line->t_ended, (50 * (1 + strain) - 1) / 70, 1e-4);
        CHECK_NEAR("length out [m]", line->paid, 50, 1e-7);
        if (end == LD_LINE_HELD) {
            // its end stops: the tension rises by sqrt(EA m') v, a wave goes to the bridle
            double rise = sqrt(9e3 * 0.012) * 70 + 0.012 * 70 * 70;
            printf("  rise of the tension by the first wave: %.1f N\n", rise);
            assert_true(line->cut >= 0);
            CHECK_WITHIN("breaks after the end [s]", line->t_broke - line->t_ended, 0, 0.15);
        } else {
            assert_true(line->cut < 0);
            CHECK_BELOW("pull of a free line [N]", v3_norm(line_force(line, line->t)), 20);
        }
        line_free(line);
    }
}

// ---- a rocket that coasts and pulls a line

// (M + m' x) v = M v_0 without T_c; with it p^2 = p_0^2 - 2 T_c (M x + m' x^2/2), x what is out
// more than at the start.
static void test_coasting(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        char text[1024];
        double hold = i ? 15 : 0, m = 0.02, v_0 = 60 * sqrt(1.3125), M = 3 + m * 2;
        snprintf(text, sizeof text,
                 "launchdyn: 1\nenvironment: {gravity: 0 m/s2, atmosphere: none, ground: none}\n"
                 "rocket:\n  mass: 3 kg\n  center: 0.3 0 0 m\n  inertia: 0.1 1 1 kg.m2\n"
                 "  line: {length: 300 m, mass_per_length: 20 g/m, diameter: 5 mm, stiffness: 30 "
                 "kN, tension: %g N, bridle: 0.3 0 0 m, segments: 60}\n"
                 "flight: {point: center, position: %.17g %.17g %.17g m, velocity: 60 30 -15 m/s}\n"
                 "run: {end: 3 s}\n",
                 hold, 2 / sqrt(1.3125), 1 / sqrt(1.3125), -0.5 / sqrt(1.3125));
        ld_model model = read_text(text);
        ld_rocket_summary rocket = fly_model(&model);
        model_clear(&model);
        double v = v3_norm(v3_from(rocket.final.center_velocity));
        double x = v3_norm(v3_from(rocket.final.center)) - 2, p = M * v_0;
        double due = sqrt(p * p - 2 * hold * (M * x + 0.5 * m * x * x)) / (M + m * x);
        printf("  held by %.0f N: %.3f m out, %.5f m/s, closed form %.5f m/s\n", hold, x, v, due);
        CHECK_NEAR("speed, relative", v / due, 1, 5e-4);
        // sum of x' = v by Simpson over x
        double t = 0;
        for (int k = 0; k <= 2000; k++) {
            double y = x * k / 2000;
            double speed = sqrt(p * p - 2 * hold * (M * y + 0.5 * m * y * y)) / (M + m * y);
            t += (k == 0 || k == 2000 ? 1 : k % 2 ? 4 : 2) / speed * x / 6000;
        }
        CHECK_NEAR("time to come there [s]", t, 3, 1.5e-3);
        CHECK_NEAR("paid out [m]", rocket.line.paid_out, x + 2, 0.2);
        CHECK_NEAR("remaining and paid out [m]", rocket.line.remaining + rocket.line.paid_out, 300,
                   1e-9);
    }
}

static ld_rocket_summary thrown(double length, const char *line)
{
    char text[1024];
    snprintf(text, sizeof text,
             "launchdyn: 1\nenvironment: {ground: -4 m, wind: {speed: 8 m/s, heading: 90 deg}}\n"
             "rocket:\n  mass: 3 kg\n  center: 0.3 0 0 m\n  inertia: 0.1 1 1 kg.m2\n"
             "  aerodynamics: {model: body, area: 0.005 m2, drag: 0.4}\n"
             "  line: {length: %g m, mass_per_length: 9 g/m, diameter: 4 mm, stiffness: 12 kN, "
             "container: -1 -1 0 m%s}\n"
             "flight: {point: center, position: 0 0 0 m, velocity: 60 50 3 m/s}\n",
             length, line);
    ld_model model = read_text(text);
    ld_rocket_summary rocket = fly_model(&model);
    model_clear(&model);
    return rocket;
}

// A line lies on the ground in the end; the wind, across, has carried it further than the rocket.
static void test_lies(void **state)
{
    (void)state;
    double range[3];
    for (int i = 0; i < 3; i++) {
        char line[64];
        snprintf(line, sizeof line, ", segments: %d", 20 << i);
        ld_rocket_summary rocket = thrown(500, line);
        range[i] = rocket.flight.range;
        double lowest = 0, highest = -100, aside = 0;
        for (int k = 0; k < LD_LINE_PLACES; k++) {
            lowest = fmin(lowest, rocket.line.place[k].y);
            highest = fmax(highest, rocket.line.place[k].y);
            aside = fmax(aside, rocket.line.place[k].z);
        }
        printf("  %d segments: range %.3f m, line %.3f m out, reach %.3f m, at rest %.2f s, aside "
               "%.1f m, the rocket %.1f m\n",
               20 << i, range[i], rocket.line.paid_out, rocket.line.reach, rocket.line.t_rest,
               aside, rocket.flight.drift);
        assert_true(rocket.line.t_rest > rocket.flight.t_impact);
        CHECK_NEAR("lowest place [m]", lowest, -4, 1e-6);
        assert_true(aside > rocket.flight.drift);
        CHECK_NEAR("reach beside the range [m]", rocket.line.reach,
                   hypot(rocket.flight.downrange + 1, rocket.flight.drift), 0.6);
    }
    CHECK_BELOW("range of 80 segments beside 40 [m]", fabs(range[2] - range[1]), 1.5);
    CHECK_BELOW("that beside 40 and 20", fabs(range[2] - range[1]) / fabs(range[1] - range[0]),
                0.4);
}

static v3 place_of(const ld_rocket_summary *rocket, int i)
{
    return v3_make(rocket->line.place[i].x, rocket->line.place[i].y, rocket->line.place[i].z);
}

// All of a short line is out before the landing: held, its end pulls back until it breaks there.
static void test_breaks(void **state)
{
    (void)state;
    ld_rocket_summary held = thrown(150, ""), broken = thrown(150, ", breaking_force: 200 N"),
                      loose = thrown(150, ", end: free");
    printf(
        "  range %.1f m held, %.1f m broken %.4f s after the end, %.1f m from the rocket, %.1f m "
        "loose\n",
        held.flight.range, broken.flight.range, broken.line.t_break - broken.line.t_end,
        broken.line.broken_at, loose.flight.range);
    CHECK_BELOW("held, beyond the line [m]", fmax(0, held.flight.range - 151), 0.5);
    CHECK_WITHIN("greatest pull held [N]", held.line.greatest_tension, 200, 2000);
    assert_true(isnan(held.line.t_break) && isnan(loose.line.t_break));
    CHECK_WITHIN("breaks after the end [s]", broken.line.t_break - broken.line.t_end, 0, 0.15);
    CHECK_WITHIN("from the rocket [m]", broken.line.broken_at, 100, 150);
    assert_true(broken.line.reach < 50);
    assert_true(broken.flight.range > held.flight.range + 20);
    CHECK_NEAR("range beside that of a free end [m]", broken.flight.range, loose.flight.range, 15);
    CHECK_NEAR("all is out: as early [s]", loose.line.t_end, held.line.t_end, 1e-12);
    // a stronger one breaks later, elsewhere: its places are those of what hangs on the container
    ld_rocket_summary later = thrown(150, ", breaking_force: 600 N");
    double farthest = 0, between = 0;
    for (int k = 0; k < LD_LINE_PLACES; k++) {
        farthest = fmax(farthest, hypot(later.line.place[k].x + 1, later.line.place[k].z));
        v3 step = k ? v3_sub(place_of(&later, k), place_of(&later, k - 1)) : v3_zero();
        between += v3_norm(step);
    }
    printf("  breaks %.1f m from the rocket\n", later.line.broken_at);
    CHECK_BELOW("reach beyond the farthest place [m]", later.line.reach - farthest, 1);
    CHECK_BELOW("what is left, along its places [m]", between, 150 - later.line.broken_at);
}

// The pull acts at the bridle: accelerations of a rocket that is free but for it.
static void test_bridle(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\nenvironment: {gravity: 0 m/s2, atmosphere: none, ground: none}\n"
        "rocket:\n  mass: 3 kg\n  center: 0.3 0 0 m\n  inertia: 0.5 0.8 1.1 kg.m2\n"
        "  line: {length: 300 m, mass_per_length: 20 g/m, diameter: 5 mm, stiffness: 30 kN,"
        " tension: 9 N, bridle: 0.05 0.04 -0.02 m, container: 0 -1 2 m}\n"
        "flight: {point: center, position: 2 1 0.5 m, velocity: 60 30 -15 m/s, attitude: {pitch: "
        "20 deg}}\nrun: {end: 0.03 s, output_step: 0.01 s}\n");
    recorded_run run;
    recorded_run_make(&run, &model);
    double worst = 0, greatest = 0;
    for (size_t i = 1; i < run.rows; i++) {
#define VALUE(name) recorded_value(&run, i, recorded_column(&run, name))
        quat q = {VALUE("rocket.q0"), VALUE("rocket.q1"), VALUE("rocket.q2"), VALUE("rocket.q3")};
        m3 A = q_matrix(q);
        v3 O1 = {VALUE("rocket.x"), VALUE("rocket.y"), VALUE("rocket.z")};
        v3 way = v3_sub(v3_add(O1, m3_apply(A, v3_make(0.05, 0.04, -0.02))), v3_make(0, -1, 2));
        v3 pull = v3_scale(-VALUE("line.tension") / v3_norm(way), way);
        v3 M = v3_cross(v3_make(-0.25, 0.04, -0.02), m3_apply_transposed(A, pull));
        v3 w = {VALUE("rocket.wx"), VALUE("rocket.wy"), VALUE("rocket.wz")};
        v3 w_dot = {VALUE("rocket.wx_dot"), VALUE("rocket.wy_dot"), VALUE("rocket.wz_dot")};
        v3 Jw = {0.5 * w.x, 0.8 * w.y, 1.1 * w.z};
        v3 due = v3_add(v3_make(0.5 * w_dot.x, 0.8 * w_dot.y, 1.1 * w_dot.z), v3_cross(w, Jw));
        worst = fmax(worst, v3_norm(v3_sub(due, M)));
        worst = fmax(worst, fabs(VALUE("acceleration") * 3 - v3_norm(pull)));
        greatest = fmax(greatest, v3_norm(M));
#undef VALUE
    }
    CHECK_WITHIN("moment of the pull [N m]", greatest, 5, 100);
    CHECK_BELOW("moment and force against accelerations, of it", worst / greatest, 1e-3);
    recorded_run_free(&run);
    model_clear(&model);
}

// ---- in the tube

// A slug that gas drives out of a tube that nothing holds along x, in a straight line: what slug,
// line and tube have of momentum is what the container took.
static void test_in_tube(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        ld_model model;
        recorded_run run;
        reference_model(&model);
        reference_by_pressure(&model);
        model.gravity = 0;
        model.base.elevation = 0;
        model.tubes.slot.kind = LD_SLOT_NONE;
        model.rocket.lock.present = false;
        model.rocket.contact.friction = 0;
        model.run.start = LD_START_UNDEFORMED;
        model.run.tolerance = 1e-11;
        reference_recoil(&model);
        model.tubes.support[0].recoil =
            (ld_recoil){.present = true, .friction_speed = 1, .stroke = 9};
        model.rocket.start_at = 0.1;
        double m = 1.5, hold = i ? 400 : 0;
        model.rocket.line = (ld_line){.present = true,
                                      .length = 300,
                                      .mass_per_length = m,
                                      .diameter = 0.01,
                                      .stiffness = 1e6,
                                      .tension = hold,
                                      .breaking_force = NAN,
                                      .container_on = LD_LINE_ON_LAUNCHER,
                                      .container = {-0.4, 0, 0},
                                      .segments = 40};
        recorded_run_make(&run, &model);
        const ld_rocket_summary *rocket = &run.summary.rocket[0];
        double last = (double)(run.rows - 1);
        double out = recorded_value(&run, (size_t)last, recorded_column(&run, "line.paid_out"));
        double back = recorded_value(&run, (size_t)last, recorded_column(&run, "tube.vx"));
        const ld_tubes *tubes = &model.tubes;
        double tube = tubes->section[0].mass_per_length * tubes->length + tubes->tail.mass;
        double slug = (model.rocket.full.mass + m * out) * rocket->inertial_speed;
        double sum = slug + tube * back + hold * rocket->t_rear;
        printf("  %.4f m out at %.4f m/s, momentum %.3f kg m/s, missing %.2e\n", out,
               rocket->inertial_speed, slug, sum);
        CHECK_BELOW("momentum that is missing, relative", sum / slug, i ? 5e-5 : 2e-15);
        CHECK_BELOW("energy balance, relative", run.summary.energy.residual_relative, 2e-14);
        recorded_run_free(&run);
        reference_model_free(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_steady),   cmocka_unit_test(test_momentum_and_energy),
        cmocka_unit_test(test_catenary), cmocka_unit_test(test_ends),
        cmocka_unit_test(test_coasting), cmocka_unit_test(test_lies),
        cmocka_unit_test(test_breaks),   cmocka_unit_test(test_bridle),
        cmocka_unit_test(test_in_tube),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
