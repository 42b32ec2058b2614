#include "support/dense_flight.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "math/vectors/mat3.h"
#include "model/model.h"
#include "support/dense_motor.h"

// Numbers of the state: O1 and its velocity in inertial axes, quaternion of B, rate in B.
enum { R = 0, V = 3, Q = 6, W = 10, STATES = 13, POINTS = 64 };

typedef struct matrix {
    double a[3][3];
} matrix;

typedef struct dense {
    const ld_model *model;
    bool round;
    double GM, J2, spin, a, f; // of the Earth
    matrix A_EI;
    double site[3];               // axes of I and its origin in Earth axes
    double slope[7][POINTS];      // of the aerodynamic table
    double wind_slope[2][POINTS]; // of the wind profile
} dense;

// ---- tables

// Slopes of a monotone cubic: three-point weighted harmonic means.
static void monotone_slopes(int n, int stride, const double *table, int column, double *slope)
{
    double h[POINTS] = {0}, d[POINTS] = {0};
    for (int i = 0; i + 1 < n; i++) {
        h[i] = table[(i + 1) * stride] - table[i * stride];
        d[i] = (table[(i + 1) * stride + column] - table[i * stride + column]) / h[i];
    }
    for (int i = 1; i + 1 < n; i++) {
        double w1 = 2 * h[i] + h[i - 1], w2 = h[i] + 2 * h[i - 1];
        slope[i] = d[i - 1] * d[i] <= 0 ? 0 : (w1 + w2) / (w1 / d[i - 1] + w2 / d[i]);
    }
    for (int end = 0; end < 2; end++) {
        int i = end ? n - 2 : 0, j = end ? n - 3 : 1;
        double s = n == 2 ? d[0] : ((2 * h[i] + h[j]) * d[i] - h[i] * d[j]) / (h[i] + h[j]);
        if (n > 2 && s * d[i] <= 0)
            s = 0;
        else if (n > 2 && d[i] * d[j] <= 0 && fabs(s) > 3 * fabs(d[i]))
            s = 3 * d[i];
        slope[end ? n - 1 : 0] = s;
    }
}

static double monotone_value(int n, int stride, const double *table, int column,
                             const double *slope, double x)
{
    x = fmax(table[0], fmin(x, table[(n - 1) * stride]));
    int i = 0;
    while (i + 2 < n && x > table[(i + 1) * stride])
        i++;
    double h = table[(i + 1) * stride] - table[i * stride], t = (x - table[i * stride]) / h;
    double y0 = table[i * stride + column], y1 = table[(i + 1) * stride + column];
    return (1 + 2 * t) * (1 - t) * (1 - t) * y0 + t * t * (3 - 2 * t) * y1 +
           h * t * (1 - t) * (1 - t) * slope[i] - h * t * t * (1 - t) * slope[i + 1];
}

// ---- surroundings

static void standard_air(const ld_atmosphere *air, double z, double *rho, double *sound)
{
    static const double base[] = {0, 11e3, 20e3, 32e3, 47e3, 51e3, 71e3, 1e9};
    static const double lapse[] = {-0.0065, 0, 0.001, 0.0028, 0, -0.0028, -0.002};
    const double gas = 8314.32 / 28.9644, g = 9.80665, r0 = 6356766;
    double H = r0 * z / (r0 + z), T = 288.15, p = 101325;
    for (int k = 0; k < 7; k++) {
        double to = k == 0 || H > base[k] ? fmin(H, base[k + 1]) : base[k];
        if (k > 0 && H <= base[k])
            break;
        double hotter = T + lapse[k] * (to - base[k]);
        p *= lapse[k] == 0 ? exp(-g * (to - base[k]) / (gas * T))
                           : exp(-g / (gas * lapse[k]) * log(hotter / T));
        T = hotter;
    }
    double warm = T + air->temperature_offset;
    *rho = air->density_scale * p / (gas * warm);
    *sound = sqrt(1.4 * gas * warm);
}

// Geodetic latitude and height by the plain iteration on the latitude.
static double geodetic_height(const dense *d, v3 r, double *latitude)
{
    double p = hypot(r.x, r.y), e2 = d->f * (2 - d->f), phi = atan2(r.z, p), N = d->a;
    for (int i = 0; i < 30; i++) {
        N = d->a / sqrt(1 - e2 * sin(phi) * sin(phi));
        phi = atan2(r.z + e2 * N * sin(phi), p);
    }
    *latitude = phi;
    return p * cos(phi) + (r.z + e2 * N * sin(phi)) * sin(phi) - N;
}

static v3 through(const matrix *A, v3 x)
{
    return v3_make(A->a[0][0] * x.x + A->a[0][1] * x.y + A->a[0][2] * x.z,
                   A->a[1][0] * x.x + A->a[1][1] * x.y + A->a[1][2] * x.z,
                   A->a[2][0] * x.x + A->a[2][1] * x.y + A->a[2][2] * x.z);
}

static v3 back_through(const matrix *A, v3 x)
{
    return v3_make(A->a[0][0] * x.x + A->a[1][0] * x.y + A->a[2][0] * x.z,
                   A->a[0][1] * x.x + A->a[1][1] * x.y + A->a[2][1] * x.z,
                   A->a[0][2] * x.x + A->a[1][2] * x.y + A->a[2][2] * x.z);
}

// Turn about the Earth's axis by the angle it has gone at time t, or back.
static v3 turned(const dense *d, double t, v3 x, int sign)
{
    double angle = sign * d->spin * t, c = cos(angle), s = sin(angle);
    return v3_make(c * x.x - s * x.y, s * x.x + c * x.y, x.z);
}

// A point and its velocity from inertial axes into I, against the ground.
static void to_ground(const dense *d, double t, v3 r, v3 v, v3 *ground_r, v3 *ground_v)
{
    *ground_r = r;
    *ground_v = v;
    if (!d->round)
        return;
    v3 v_rel = v3_make(v.x + d->spin * r.y, v.y - d->spin * r.x, v.z);
    *ground_r = back_through(&d->A_EI, v3_sub(turned(d, t, r, -1), v3_from(d->site)));
    *ground_v = back_through(&d->A_EI, turned(d, t, v_rel, -1));
}

static v3 gravity(const dense *d, v3 r)
{
    if (!d->round)
        return v3_make(0, -d->model->gravity, 0);
    double n = v3_norm(r), k = 1.5 * d->J2 * pow(d->a / n, 2), s = r.z * r.z / (n * n);
    return v3_scale(-d->GM / pow(n, 3),
                    v3_make(r.x * (1 + k * (1 - 5 * s)), r.y * (1 + k * (1 - 5 * s)),
                            r.z * (1 + k * (3 - 5 * s))));
}

static double gust_share(const ld_gust *g, double t)
{
    double fall = isnan(g->fall) ? g->rise : g->fall, x = t - g->start;
    if (x < 0 || x > g->rise + g->hold + fall)
        return 0;
    if (x < g->rise)
        return pow(sin(acos(-1) * x / (2 * g->rise)), 2);
    x -= g->rise + g->hold;
    return x < 0 ? 1 : pow(cos(acos(-1) * x / (2 * fall)), 2);
}

// Velocity of the air against the ground at a point of I and its altitude, in I; geographic axes on
// a flat Earth only.
static v3 wind(const dense *d, double t, v3 r, double altitude)
{
    const ld_environment *e = &d->model->environment;
    const ld_wind *w = &e->wind;
    if (!w->present)
        return v3_zero();
    bool north = w->axes == LD_WIND_GEOGRAPHIC;
    double level[2] = {w->speed * cos(w->heading), w->speed * sin(w->heading)};
    double h = d->round || north ? altitude : r.y;
    h -= north ? 0 : e->ground_height;
    for (int k = 0; k < 2 && w->profile.rows > 0; k++)
        level[k] =
            monotone_value((int)w->profile.rows, 3, w->profile.data, k + 1, d->wind_slope[k], h);
    v3 out = v3_make(w->scale * level[0] + w->add[0], w->add[1], w->scale * level[1] + w->add[2]);
    for (int i = 0; i < w->gust_count; i++) {
        double v = w->gust[i].speed * gust_share(&w->gust[i], t);
        out.x += v * cos(w->gust[i].heading);
        out.z += v * sin(w->gust[i].heading);
    }
    double s = sin(e->site.azimuth), c = cos(e->site.azimuth);
    return north ? v3_make(c * out.x + s * out.z, out.y, -s * out.x + c * out.z) : out;
}

// ---- the rocket

typedef struct body {
    double m, T;
    v3 c, further, turning; // of further motors the force, and the moment about O1
    matrix J;
    bool power;
} body;

static body body_at(const dense *d, double t)
{
    const ld_rocket *rocket = &d->model->rocket;
    double since = t - d->model->flight.ignition, total = 0, burnt = 0;
    body b = {.power = since < dense_burn_out(rocket)};
    for (int k = 0; k <= rocket->further_motor_count; k++) {
        dense_curve curve = dense_curve_of(rocket, k);
        double impulse[2], T = dense_curve_at(&curve, since, since, impulse);
        burnt += impulse[0];
        total += impulse[1];
        if (k == 0) {
            b.T = T;
            continue;
        }
        const ld_further_motor *one = &rocket->further_motor[k - 1];
        v3 e = v3_make(1, one->misalignment[0], one->misalignment[1]);
        v3 f = v3_scale(T / v3_norm(e), e);
        b.further = v3_add(b.further, f);
        b.turning = v3_add(b.turning, v3_cross(v3_from(one->at), f));
    }
    double x = total > 0 ? burnt / total : 0;
    b.m = rocket->full.mass + rocket->mass_error - x * rocket->propellant;
    double c[3];
    for (int i = 0; i < 3; i++) {
        c[i] = (1 - x) * rocket->full.center[i] + x * rocket->empty.center[i];
        b.J.a[i][i] = (1 - x) * rocket->full.inertia[i] + x * rocket->empty.inertia[i];
    }
    b.c = v3_make(c[0], c[1] + rocket->eccentricity[0], c[2] + rocket->eccentricity[1]);
    b.J.a[0][1] = b.J.a[1][0] = rocket->products[0];
    b.J.a[0][2] = b.J.a[2][0] = rocket->products[1];
    b.J.a[1][2] = b.J.a[2][1] = rocket->products[2];
    return b;
}

// Force of the air and its moment about the mass centre; v: velocity through the air, all in B.
static void air_forces(const dense *d, const body *b, v3 v, v3 w, double rho, double sound, v3 *f,
                       v3 *m)
{
    const ld_aerodynamics *air = &d->model->rocket.aerodynamics;
    const double pi = acos(-1);
    double speed = v3_norm(v);
    *f = *m = v3_zero();
    if (!air->present)
        return;
    if (air->model == LD_AERODYNAMICS_BODY) {
        double q = 0.25 * rho * speed * air->area;
        const double *l = air->lengths, *C = air->damping;
        *f = v3_scale(-0.5 * rho * air->area * air->drag * speed, v);
        *m = v3_make(q * l[0] * l[0] * C[0] * w.x, q * l[1] * l[1] * C[1] * w.y,
                     q * l[2] * l[2] * C[2] * w.z);
        return;
    }
    double k[8], d_ref = air->reference_diameter, S = pi * d_ref * d_ref / 4;
    for (int i = 1; i < 8; i++)
        k[i] = monotone_value((int)air->table.rows, 8, air->table.data, i, d->slope[i - 1],
                              speed / sound);
    double CA = air->ca_scale * (b->power ? k[2] : k[1]), CN = air->cn_scale * k[3];
    v3 f_a = v3_scale(-0.5 * rho * S * speed, v3_make(CA * v.x, CN * v.y, CN * v.z));
    v3 r_a = v3_make(k[4] + air->x_cp_shift, 0, 0);
    double n = 0.5 * rho * S * d_ref * speed;
    v3 m_a = v3_make(n * (k[5] * air->fin_cant * v.x + k[6] * w.x * d_ref / 2),
                     n * k[7] * w.y * d_ref / 2, n * k[7] * w.z * d_ref / 2);
    v3 f_x = v3_zero(), r_x = v3_make(air->crossflow.present ? air->crossflow.at : 0, 0, 0);
    if (air->crossflow.present)
        f_x =
            v3_scale(-0.5 * rho * S * air->crossflow.drag * hypot(v.y, v.z), v3_make(0, v.y, v.z));
    *f = v3_add(f_a, f_x);
    *m = v3_add(m_a, v3_add(v3_cross(v3_sub(r_a, b->c), f_a), v3_cross(v3_sub(r_x, b->c), f_x)));
}

// Solves J x = b by Cramer's rule.
static v3 solve(const matrix *J, v3 b)
{
    v3 x = v3_make(J->a[0][0], J->a[1][0], J->a[2][0]),
       y = v3_make(J->a[0][1], J->a[1][1], J->a[2][1]),
       z = v3_make(J->a[0][2], J->a[1][2], J->a[2][2]);
    double det = v3_dot(x, v3_cross(y, z));
    return v3_make(v3_dot(b, v3_cross(y, z)) / det, v3_dot(x, v3_cross(b, z)) / det,
                   v3_dot(x, v3_cross(y, b)) / det);
}

// Vector of B in inertial axes, and back: q (0, a) q*.
static v3 rotate(const double *q, v3 a, int sign)
{
    v3 u = v3_scale(sign, v3_make(q[1], q[2], q[3])), t = v3_scale(2, v3_cross(u, a));
    return v3_add(a, v3_add(v3_scale(q[0], t), v3_cross(u, t)));
}

static void derivative(const dense *d, double t, const double *y, double *y_dot)
{
    body b = body_at(d, t);
    const double *q = y + Q;
    double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double unit[4] = {q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
    v3 r = v3_from(y + R), v = v3_from(y + V), w = v3_from(y + W);
    // mass centre, air there
    v3 r_C = v3_add(r, rotate(unit, b.c, 1)), v_C = v3_add(v, rotate(unit, v3_cross(w, b.c), 1));
    v3 ground_r, ground_v;
    to_ground(d, t, r_C, v_C, &ground_r, &ground_v);
    double latitude, altitude = d->model->environment.site.altitude + r_C.y;
    if (d->round)
        altitude = geodetic_height(d, r_C, &latitude);
    v3 v_air = v3_sub(ground_v, wind(d, t, ground_r, altitude)); // in I
    if (d->round)
        v_air = turned(d, t, through(&d->A_EI, v_air), 1);
    const ld_atmosphere *air = &d->model->environment.atmosphere;
    double rho = 0, sound = 1;
    if (air->kind == LD_ATMOSPHERE_US1976) {
        standard_air(air, altitude, &rho, &sound);
    } else if (air->kind == LD_ATMOSPHERE_UNIFORM) {
        rho = air->density_scale * air->density;
        sound = air->speed_of_sound;
    }
    v3 f_a, m_a;
    air_forces(d, &b, rotate(unit, v_air, -1), w, rho, sound, &f_a, &m_a);
    // thrust
    const ld_motor *motor = &d->model->rocket.motor;
    double across[6], since = t - d->model->flight.ignition;
    dense_motor_across(motor, since, across);
    v3 e_T = v3_make(1, across[2], across[3]);
    e_T = v3_scale(1 / v3_norm(e_T), e_T);
    v3 f_T = v3_scale(b.T, e_T), point = v3_make(motor->at[0], across[4], across[5]);
    if (dense_motor_burns(motor, since))
        f_T = v3_add(f_T, v3_make(0, across[0], across[1]));
    v3 M = v3_add(v3_cross(v3_sub(point, b.c), f_T), m_a);
    M = v3_add(M, v3_sub(b.turning, v3_cross(b.c, b.further)));
    f_T = v3_add(f_T, b.further);
    // Euler, then the acceleration of O1
    v3 w_dot = solve(&b.J, v3_sub(M, v3_cross(w, through(&b.J, w))));
    v3 F = v3_add(v3_scale(b.m, rotate(unit, gravity(d, r_C), -1)), v3_add(f_T, f_a));
    v3 a =
        v3_sub(v3_scale(1 / b.m, F), v3_add(v3_cross(w_dot, b.c), v3_cross(w, v3_cross(w, b.c))));
    v3_store(y_dot + R, v);
    v3_store(y_dot + V, rotate(unit, a, 1));
    y_dot[Q] = -0.5 * (q[1] * w.x + q[2] * w.y + q[3] * w.z);
    y_dot[Q + 1] = 0.5 * (q[0] * w.x + q[2] * w.z - q[3] * w.y);
    y_dot[Q + 2] = 0.5 * (q[0] * w.y + q[3] * w.x - q[1] * w.z);
    y_dot[Q + 3] = 0.5 * (q[0] * w.z + q[1] * w.y - q[2] * w.x);
    v3_store(y_dot + W, w_dot);
}

// ---- steps

// Midpoint rule in n substeps, n even (without smoothing: the expansion is even in the step).
static void midpoints(const dense *d, double t, double H, int n, const double *y, double *out)
{
    double z[3][STATES], f[STATES], h = H / n;
    memcpy(z[0], y, sizeof z[0]);
    derivative(d, t, y, f);
    for (int i = 0; i < STATES; i++)
        z[1][i] = y[i] + h * f[i];
    for (int k = 1; k < n; k++) {
        derivative(d, t + k * h, z[1], f);
        for (int i = 0; i < STATES; i++) {
            z[2][i] = z[0][i] + 2 * h * f[i];
            z[0][i] = z[1][i];
            z[1][i] = z[2][i];
        }
    }
    memcpy(out, z[1], sizeof z[1]);
}

static void step(const dense *d, double t, double H, double *y)
{
    enum { ROUNDS = 3 };
    double table[ROUNDS][STATES];
    for (int k = 0; k < ROUNDS; k++) {
        midpoints(d, t, H, 2 * (k + 1), y, table[k]);
        for (int j = k - 1; j >= 0; j--)
            for (int i = 0; i < STATES; i++) {
                double ratio = (double)((k + 1) * (k + 1)) / ((j + 1) * (j + 1));
                table[j][i] = table[j + 1][i] + (table[j + 1][i] - table[j][i]) / (ratio - 1);
            }
    }
    memcpy(y, table[0], sizeof table[0]);
}

// The next corner of thrust or gust after t.
static double next_corner(const ld_model *model, double t)
{
    const ld_wind *w = &model->environment.wind;
    double since = t + 1e-12 - model->flight.ignition;
    double next = model->flight.ignition + fmin(dense_motor_corner(&model->rocket.motor, since),
                                                dense_further_corner(&model->rocket, since));
    for (int i = 0; w->present && i < w->gust_count; i++) {
        const ld_gust *g = &w->gust[i];
        double fall = isnan(g->fall) ? g->rise : g->fall, at = g->start;
        const double part[] = {0, g->rise, g->hold, fall};
        for (int k = 0; k < 4; k++) {
            at += part[k];
            next = at > t + 1e-12 ? fmin(next, at) : next;
        }
    }
    return next;
}

// ---- the flight

static void set_up_air(dense *d)
{
    const ld_table *air = &d->model->rocket.aerodynamics.table;
    for (int k = 0; k < 7 && air->rows > 0; k++)
        monotone_slopes((int)air->rows, 8, air->data, k + 1, d->slope[k]);
}

dense_wrench dense_air(const ld_model *model, bool power, v3 c, v3 v, v3 w, double density,
                       double sound)
{
    const body b = {.c = c, .power = power};
    dense d = {.model = model};
    dense_wrench out;
    set_up_air(&d);
    air_forces(&d, &b, v, w, density, sound, &out.f, &out.m);
    return out;
}

static void set_up(dense *d, const ld_model *model)
{
    const ld_environment *e = &model->environment;
    const ld_table *wind_table = &e->wind.profile;
    *d = (dense){.model = model, .round = e->earth.kind != LD_EARTH_FLAT};
    set_up_air(d);
    for (int k = 0; k < 2 && wind_table->rows > 1; k++)
        monotone_slopes((int)wind_table->rows, 3, wind_table->data, k + 1, d->wind_slope[k]);
    if (!d->round)
        return;
    bool ellipsoid = e->earth.kind == LD_EARTH_WGS84;
    d->GM = 3.986004418e14;
    d->spin = 7.292115e-5;
    d->J2 = ellipsoid ? 1.08262982e-3 : 0;
    d->a = ellipsoid ? 6378137 : 6371007.1809;
    d->f = ellipsoid ? 1 / 298.257223563 : 0;
    double sp = sin(e->site.latitude), cp = cos(e->site.latitude);
    double sl = sin(e->site.longitude), cl = cos(e->site.longitude);
    double sa = sin(e->site.azimuth), ca = cos(e->site.azimuth);
    const double north[] = {-sp * cl, -sp * sl, cp}, east[] = {-sl, cl, 0};
    const double up[] = {cp * cl, cp * sl, sp};
    double e2 = d->f * (2 - d->f), N = d->a / sqrt(1 - e2 * sp * sp), h = e->site.altitude;
    d->site[0] = (N + h) * cp * cl;
    d->site[1] = (N + h) * cp * sl;
    d->site[2] = (N * (1 - e2) + h) * sp;
    for (int i = 0; i < 3; i++) {
        d->A_EI.a[i][0] = ca * north[i] + sa * east[i];
        d->A_EI.a[i][1] = up[i];
        d->A_EI.a[i][2] = -sa * north[i] + ca * east[i];
    }
}

// p q of quaternions.
static void multiply(const double *p, const double *q, double *out)
{
    const double r[4] = {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
                         p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
                         p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
                         p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
    memcpy(out, r, sizeof r);
}

// Quaternion of axes of which x and y are given.
static void quaternion_of_axes(v3 x, v3 y, double *q)
{
    v3 z = v3_cross(x, y);
    double trace = x.x + y.y + z.z;
    if (trace > 0) {
        double s = 2 * sqrt(trace + 1);
        q[0] = s / 4;
        q[1] = (y.z - z.y) / s;
        q[2] = (z.x - x.z) / s;
        q[3] = (x.y - y.x) / s;
    } else {
        // by the axis of the turn: turn about it by half a turn more is regular
        const double half[4] = {0, 1, 0, 0};
        double other[4];
        v3 my = v3_scale(-1, y);
        double t2 = x.x + my.y - z.z;
        if (t2 > -0.9) {
            quaternion_of_axes(x, my, other); // A Rx(pi) has the columns x, -y, -z
            multiply(other, (const double[]){half[0], -half[1], 0, 0}, q);
        } else {
            quaternion_of_axes(v3_scale(-1, x), y, other); // A Ry(pi): -x, y, -z
            multiply(other, (const double[]){0, 0, -1, 0}, q);
        }
    }
}

static void start(const dense *d, double *y)
{
    const ld_flight *flight = &d->model->flight;
    double q[4], a = flight->yaw / 2, b = flight->pitch / 2, c = flight->roll / 2;
    if (isnan(flight->quaternion[0])) {
        const double yaw[] = {cos(a), 0, sin(a), 0}, pitch[] = {cos(b), 0, 0, sin(b)};
        const double roll[] = {cos(c), sin(c), 0, 0};
        multiply(yaw, pitch, q);
        multiply(q, roll, q);
    } else {
        memcpy(q, flight->quaternion, sizeof q);
    }
    v3 r = v3_from(flight->position), v = v3_from(flight->velocity);
    if (d->round) {
        double A[4];
        v3 x = through(&d->A_EI, v3_make(1, 0, 0)), up = through(&d->A_EI, v3_make(0, 1, 0));
        quaternion_of_axes(x, up, A);
        multiply(A, q, q);
        r = v3_add(v3_from(d->site), through(&d->A_EI, r));
        v = through(&d->A_EI, v);
        v = v3_make(v.x - d->spin * r.y, v.y + d->spin * r.x, v.z);
    }
    v3_store(y + R, r);
    v3_store(y + V, v);
    memcpy(y + Q, q, sizeof q);
    memcpy(y + W, flight->rate, sizeof flight->rate);
}

static void center_of(const dense *d, double t, const double *y, v3 *r, v3 *v)
{
    body b = body_at(d, t);
    v3 w = v3_from(y + W), r_C = v3_add(v3_from(y + R), rotate(y + Q, b.c, 1));
    v3 v_C = v3_add(v3_from(y + V), rotate(y + Q, v3_cross(w, b.c), 1));
    to_ground(d, t, r_C, v_C, r, v);
}

// Height of the mass centre, which counts against the ground, and its rate: y of I, or the geodetic
// height and the velocity along the ellipsoid's normal.
static void height_of(const dense *d, double t, const double *y, double *height, double *rate)
{
    body b = body_at(d, t);
    v3 r = v3_add(v3_from(y + R), rotate(y + Q, b.c, 1));
    v3 v = v3_add(v3_from(y + V), rotate(y + Q, v3_cross(v3_from(y + W), b.c), 1));
    *height = r.y;
    *rate = v.y;
    if (!d->round)
        return;
    double latitude, longitude = atan2(r.y, r.x);
    *height = geodetic_height(d, r, &latitude);
    *rate = cos(latitude) * (v.x * cos(longitude) + v.y * sin(longitude)) + v.z * sin(latitude);
}

static void normalise(double *q)
{
    double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        q[i] /= n;
}

void dense_flight(const ld_model *model, double size, dense_flight_end *end)
{
    dense d;
    double y[STATES], before[STATES], t = 0, ground = model->environment.ground_height;
    double height, rate;
    v3 r, v;
    set_up(&d, model);
    start(&d, y);
    end->apogee = -INFINITY;
    while (t < 1000) {
        double corner = next_corner(model, t), h = size;
        if (corner - t < 1.5 * h)
            h = corner - t;
        memcpy(before, y, sizeof y);
        step(&d, t, h, y);
        normalise(y + Q);
        height_of(&d, t + h, y, &height, &rate);
        end->apogee = fmax(end->apogee, height);
        if (height <= ground && rate < 0) {
            // the last step again, until it ends on the ground
            for (int i = 0; i < 6; i++) {
                h += (ground - height) / rate;
                memcpy(y, before, sizeof y);
                step(&d, t, h, y);
                normalise(y + Q);
                height_of(&d, t + h, y, &height, &rate);
            }
            t += h;
            break;
        }
        t = corner - t < 1.5 * size ? corner : t + h;
    }
    center_of(&d, t, y, &r, &v);
    v3 r_O1, v_O1, axis = rotate(y + Q, v3_make(1, 0, 0), 1);
    to_ground(&d, t, v3_from(y + R), v3_from(y + V), &r_O1, &v_O1);
    if (d.round)
        axis = back_through(&d.A_EI, turned(&d, t, axis, -1));
    end->t = t;
    end->angle = asin(-rate / v3_norm(v));
    v3_store(end->center, r);
    v3_store(end->velocity, v);
    v3_store(end->position, r_O1);
    v3_store(end->axis, axis);
    memcpy(end->rate, y + W, sizeof end->rate);
}
