// A rocket that draws a line out of its container, in flight, against a program of its own: the
// line as a continuum r(S, t) over the unstretched length S from the rocket, on a grid that grows
// with what is out, rocket and line in one system of equations.
//
// Points at S_i = i L/N with the velocity v of the material there, L the length out:
//   r_i' = v_i + S_i' r_S,   m' v_i' = (T r_S/|r_S|)_S + m' S_i' v_S + m' g + drag,   S_i' = i L'/N
// with central differences. At the container r is fixed, v = -L' r_S, and what is drawn out was at
// rest:  T = T_c + m' L'^2 |r_S|  gives L'. The rocket is a point of mass at the other end.
// ctest: slow
#include "support/check.h"

#include "support/flight_text.h"

enum { MOST = 96 };

typedef struct point {
    double x, y, z;
} point;

static point add(point a, double s, point b)
{
    return (point){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static double dot(point a, point b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double norm(point a)
{
    return sqrt(dot(a, a));
}

// The case: invented numbers, those of `text` below.
static const double M = 3, area = 0.004, drag = 0.45, density = 1.2, g = 9.80665;
static const double m = 0.012, D = 0.005, across = 1.2, friction = 0.012, EA = 3000, hold = 4;
static const point wind = {0, 0, 7}, container = {-9, -5, 3}, velocity = {52, 38, -6};

static const char *const text =
    "launchdyn: 1\n"
    "environment: {ground: none, atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}, wind: "
    "{speed: 7 m/s, heading: 90 deg}}\n"
    "rocket:\n  mass: 3 kg\n  center: 0.3 0 0 m\n  inertia: 0.1 1 1 kg.m2\n"
    "  aerodynamics: {model: body, area: 0.004 m2, drag: 0.45}\n"
    "  line: {length: 400 m, mass_per_length: 12 g/m, diameter: 5 mm, stiffness: 3 kN, damping: "
    "0.3, "
    "drag_along: 0.012, tension: 4 N, bridle: 0.3 0 0 m, container: -9 -5 3 m, segments: %d}\n"
    "flight: {point: center, position: 0 0 0 m, velocity: 52 38 -6 m/s}\n"
    "run: {end: 3 s, output_step: {flight: 5 ms}}\n";

// Points 0 (the rocket) to N (the container, which no equation moves), and L.
typedef struct line {
    point r[MOST + 1], v[MOST + 1];
    double L;
} line;

static point air_drag(point tangent, point v, double diameter)
{
    point slip = add(v, -1, wind), e = add((point){0}, 1 / norm(tangent), tangent);
    point along = add((point){0}, dot(slip, e), e), beside = add(slip, -1, along);
    double half = 0.5 * density * diameter;
    return add(add((point){0}, -half * across * norm(beside), beside),
               -half * acos(-1) * friction * norm(along), along);
}

static void rates(int N, const line *now, line *dot_of)
{
    double h = now->L / N, T[MOST];
    point e[MOST];
    for (int i = 0; i < N; i++) {
        point step = add(now->r[i + 1], -1, now->r[i]);
        double length = norm(step);
        e[i] = add((point){0}, 1 / length, step);
        // a little viscosity, that vanishes with h
        double rate = i + 1 < N ? dot(e[i], add(now->v[i + 1], -1, now->v[i])) : 0;
        T[i] = fmax(0, EA * (length / h - 1) + 0.3 * sqrt(EA * m) * rate);
    }
    double last = 1.5 * T[N - 1] - 0.5 * T[N - 2];
    double stretched = norm(add(now->r[N], -1, now->r[N - 1])) / h;
    double out = last > hold ? sqrt((last - hold) / (m * stretched)) : 0;
    point end = add((point){0}, -out * stretched, e[N - 1]);
    dot_of->L = out;
    for (int i = 1; i < N; i++) {
        point v_after = i + 1 < N ? now->v[i + 1] : end;
        point r_S = add((point){0}, 0.5 / h, add(now->r[i + 1], -1, now->r[i - 1]));
        point v_S = add((point){0}, 0.5 / h, add(v_after, -1, now->v[i - 1]));
        double goes = out * i / N;
        point pull = add(add((point){0}, T[i] / h, e[i]), -T[i - 1] / h, e[i - 1]);
        point force = add(pull, 1, air_drag(r_S, now->v[i], D));
        dot_of->r[i] = add(now->v[i], goes, r_S);
        dot_of->v[i] = add(add((point){0, -g, 0}, 1 / m, force), goes, v_S);
    }
    // the rocket with half an interval of line
    point slip = add(now->v[0], -1, wind), force = add((point){0}, T[0], e[0]);
    force = add(force, -0.5 * density * area * drag * norm(slip), slip);
    force = add(force, 0.5 * h, air_drag(e[0], now->v[0], D));
    double mass = M + 0.5 * m * h;
    dot_of->r[0] = now->v[0];
    dot_of->v[0] = add((point){0, -g, 0}, 1 / mass, force);
    dot_of->r[N] = dot_of->v[N] = (point){0};
}

static void go(int N, const line *from, double dt, const line *by, line *to)
{
    for (int i = 0; i <= N; i++) {
        to->r[i] = add(from->r[i], dt, by->r[i]);
        to->v[i] = add(from->v[i], dt, by->v[i]);
    }
    to->L = from->L + dt * by->L;
}

// Steps of order 3 (Shu and Osher, 1988), as long as waves and mouth allow.
static void step(int N, line *now, double dt)
{
    line by, one, two;
    rates(N, now, &by);
    go(N, now, dt, &by, &one);
    rates(N, &one, &by);
    go(N, &one, dt, &by, &two);
    line mean = *now;
    for (int i = 0; i <= N; i++) {
        mean.r[i] = add(add((point){0}, 0.75, now->r[i]), 0.25, two.r[i]);
        mean.v[i] = add(add((point){0}, 0.75, now->v[i]), 0.25, two.v[i]);
    }
    mean.L = 0.75 * now->L + 0.25 * two.L;
    rates(N, &mean, &by);
    go(N, &mean, dt, &by, &two);
    for (int i = 0; i <= N; i++) {
        now->r[i] = add(add((point){0}, 1.0 / 3, now->r[i]), 2.0 / 3, two.r[i]);
        now->v[i] = add(add((point){0}, 1.0 / 3, now->v[i]), 2.0 / 3, two.v[i]);
    }
    now->L = now->L / 3 + 2 * two.L / 3;
}

enum { INSTANTS = 12 };
static const double spacing = 0.25; // [s]

// At the instants; the pull is the mean over the time since the one before.
typedef struct course {
    point r[INSTANTS + 1], v[INSTANTS + 1];
    double L[INSTANTS + 1], pull[INSTANTS + 1];
} course;

// What the rocket feels besides its own weight and drag.
static double pull_of(int N, const line *now)
{
    line by;
    rates(N, now, &by);
    point slip = add(now->v[0], -1, wind), own = {0, -M * g, 0};
    own = add(own, -0.5 * density * area * drag * norm(slip), slip);
    return norm(add(own, -M, by.v[0]));
}

// Steps over the time of a wave along an interval: what leaves the container, u, follows T with the
// rate c^2/(2 u h).
static double longest(point v, double c)
{
    return fmin(0.25, 1.2 * norm(v) / c);
}

static void solve(int N, course *out)
{
    line now = {0};
    point way = add((point){0}, -1, container);
    double distance = norm(way), along = dot(way, velocity) / distance;
    now.L = distance / (1 + hold / EA);
    for (int i = 0; i <= N; i++) {
        now.r[i] = add((point){0}, (double)i / N, container);
        // all that is out goes along as fast as the rocket
        now.v[i] = i ? add((point){0}, along / distance, way) : velocity;
    }
    for (int k = 0; k <= INSTANTS; k++) {
        double t = 0, impulse = 0;
        while (k && t < spacing) {
            double c = sqrt(EA / m), wave = longest(now.v[N - 1], c) * now.L / N / c;
            double left = spacing - t;
            double dt = wave < left ? wave : left;
            impulse += dt * pull_of(N, &now);
            step(N, &now, dt);
            t = wave < left ? t + dt : spacing;
        }
        out->r[k] = now.r[0];
        out->v[k] = now.v[0];
        out->L[k] = now.L;
        out->pull[k] = impulse / spacing;
    }
}

static void fly(int segments, course *out)
{
    char made[2048];
    snprintf(made, sizeof made, text, segments);
    ld_model model = read_text(made);
    recorded_run run;
    recorded_run_make(&run, &model);
    double before = 0, since = 0, impulse = 0;
    int k = 0;
    for (size_t i = 0; i < run.rows && k <= INSTANTS; i++) {
#define VALUE(name) recorded_value(&run, i, recorded_column(&run, name))
        double t = VALUE("t"), pull = VALUE("line.tension");
        impulse += 0.5 * (t - since) * (before + pull);
        before = pull;
        since = t;
        if (fabs(t - k * spacing) > 1e-9)
            continue;
        out->r[k] = (point){VALUE("center.x"), VALUE("center.y"), VALUE("center.z")};
        out->v[k] = (point){VALUE("center.vx"), VALUE("center.vy"), VALUE("center.vz")};
        out->L[k] = VALUE("line.paid_out");
        out->pull[k] = impulse / spacing;
        impulse = 0;
        k++;
#undef VALUE
    }
    assert_int_equal(k, INSTANTS + 1);
    recorded_run_free(&run);
    model_clear(&model);
}

// How far two courses are apart at most: place, velocity, length, mean pull of its greatest.
typedef struct apart {
    double place, velocity, length, pull;
} apart;

static apart compare(const course *one, const course *other)
{
    apart off = {0};
    for (int k = 1; k <= INSTANTS; k++) {
        off.place = fmax(off.place, norm(add(one->r[k], -1, other->r[k])));
        off.velocity = fmax(off.velocity, norm(add(one->v[k], -1, other->v[k])));
        off.length = fmax(off.length, fabs(one->L[k] - other->L[k]));
        off.pull = fmax(off.pull, fabs(one->pull[k] - other->pull[k]) / other->pull[1]);
    }
    return off;
}

// To segments of no length, from two lengths of which the first is twice the second.
static course without_length(const course *one, const course *half)
{
    course to = *half;
    for (int k = 0; k <= INSTANTS; k++) {
        to.r[k] = add(half->r[k], 1, add(half->r[k], -1, one->r[k]));
        to.v[k] = add(half->v[k], 1, add(half->v[k], -1, one->v[k]));
        to.L[k] += half->L[k] - one->L[k];
        to.pull[k] += half->pull[k] - one->pull[k];
    }
    return to;
}

static void test_flight(void **state)
{
    (void)state;
    static course coarse, fine, ours[3];
    solve(MOST / 2, &coarse);
    solve(MOST, &fine);
    apart own = compare(&coarse, &fine);
    printf("  of its own, %d and %d intervals: %.4f m, %.4f m/s, length %.4f m, pull %.4f\n",
           MOST / 2, MOST, own.place, own.velocity, own.length, own.pull);
    for (int i = 0; i < 3; i++)
        fly(80 << i, &ours[i]);
    apart off[3];
    for (int i = 0; i < 3; i++) {
        off[i] = compare(&ours[i], &fine);
        printf("  %d segments: %.4f m, %.4f m/s, length %.4f m, pull %.4f\n", 80 << i, off[i].place,
               off[i].velocity, off[i].length, off[i].pull);
    }
    course limit = without_length(&ours[1], &ours[2]);
    apart last = compare(&limit, &fine);
    point end = fine.r[INSTANTS];
    printf("  after 3 s at %.3f, %.3f, %.3f m, %.3f m out\n", end.x, end.y, end.z,
           fine.L[INSTANTS]);
    CHECK_BELOW("place, 320 segments [m]", off[2].place, 0.15);
    CHECK_WITHIN("that beside half as many segments", off[2].place / off[1].place, 0.4, 0.6);
    CHECK_BELOW("place, to segments of no length [m]", last.place, 0.03);
    CHECK_BELOW("velocity [m/s]", last.velocity, 0.04);
    CHECK_BELOW("length out [m]", last.length, 0.06);
    CHECK_BELOW("mean pull, of the greatest", last.pull, 0.012);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_flight)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
