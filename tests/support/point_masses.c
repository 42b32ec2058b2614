#include "support/point_masses.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/check.h"

void rigid_points(double mass, const double c[3], const double J[3], double point[][3],
                  double *point_mass)
{
    double sum = J[0] + J[1] + J[2];
    for (int i = 0; i < RIGID_POINTS; i++) {
        memcpy(point[i], c, sizeof point[i]);
        // two on each axis, mass/6 each: the sum of squares of two axes is 3 J/mass
        point[i][i / 2] += (i % 2 ? 1 : -1) * sqrt(1.5 * (sum - 2 * J[i / 2]) / mass);
        point_mass[i] = mass / RIGID_POINTS;
    }
}

// Velocities of all points along (1, u), by a complex step.
static void velocities(const mass_system *system, double t, const double *q, const double *u,
                       double (*r)[3], double (*v)[3])
{
    static const double tiny = 1e-30;
    cplx at[MOST_COORDINATES], place[MOST_POINTS][3];
    for (int i = 0; i < system->coordinates; i++)
        at[i] = q[i] + I * tiny * u[i];
    system->place(system->self, t + I * tiny, at, place);
    for (int k = 0; k < system->points; k++)
        for (int i = 0; i < 3; i++) {
            if (r)
                r[k][i] = creal(place[k][i]);
            v[k][i] = cimag(place[k][i]) / tiny;
        }
}

// Accelerations of the points while the coordinates' own are zero.
static void carried_accelerations(const mass_system *system, double t, const double *y,
                                  double (*a)[3])
{
    const double h = 1e-5;
    const double *q = y, *u = y + system->coordinates;
    double side[2][MOST_COORDINATES];
    static double v[2][MOST_POINTS][3];
    for (int s = 0; s < 2; s++) {
        double step = s ? h : -h;
        for (int i = 0; i < system->coordinates; i++)
            side[s][i] = q[i] + step * u[i];
        velocities(system, t + step, side[s], u, NULL, v[s]);
    }
    for (int k = 0; k < system->points; k++)
        for (int i = 0; i < 3; i++)
            a[k][i] = (v[1][k][i] - v[0][k][i]) / (2 * h);
}

static void jacobian(const mass_system *system, double t, const double *q,
                     double (*J)[MOST_POINTS][3])
{
    static const double tiny = 1e-30;
    cplx at[MOST_COORDINATES];
    static cplx place[MOST_POINTS][3];
    for (int i = 0; i < system->coordinates; i++)
        at[i] = q[i];
    for (int j = 0; j < system->coordinates; j++) {
        at[j] = q[j] + I * tiny;
        system->place(system->self, t, at, place);
        at[j] = q[j];
        for (int k = 0; k < system->points; k++)
            for (int i = 0; i < 3; i++)
                J[j][k][i] = cimag(place[k][i]) / tiny;
    }
}

// Solves the symmetric system of those that are not held, by Gauss; others have no acceleration.
static void solve(const mass_system *system, double M[][MOST_COORDINATES], const double *force,
                  double *a)
{
    static double work[MOST_COORDINATES][MOST_COORDINATES + 1];
    int free[MOST_COORDINATES], n = 0;
    for (int i = 0; i < system->coordinates; i++) {
        a[i] = 0;
        if (!system->held[i])
            free[n++] = i;
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            work[i][j] = M[free[i]][free[j]];
        work[i][n] = force[free[i]];
    }
    for (int k = 0; k < n; k++)
        for (int i = k + 1; i < n; i++) {
            double share = work[i][k] / work[k][k];
            for (int j = k; j <= n; j++)
                work[i][j] -= share * work[k][j];
        }
    for (int k = n - 1; k >= 0; k--) {
        double sum = work[k][n];
        for (int j = k + 1; j < n; j++)
            sum -= work[k][j] * a[free[j]];
        a[free[k]] = sum / work[k][k];
    }
}

void masses_rates(const mass_system *system, double t, const double *y, double *y_dot,
                  double *holding)
{
    static double J[MOST_COORDINATES][MOST_POINTS][3], F[MOST_POINTS][3], a0[MOST_POINTS][3];
    static double M[MOST_COORDINATES][MOST_COORDINATES];
    static mass_motion now;
    int n = system->coordinates;
    double Q[MOST_COORDINATES] = {0}, force[MOST_COORDINATES], z_dot[MOST_EXTRA] = {0};
    now.q = y;
    now.u = y + n;
    now.z = y + 2 * n;
    velocities(system, t, now.q, now.u, now.r, now.v);
    carried_accelerations(system, t, y, a0);
    jacobian(system, t, now.q, J);
    memset(F, 0, sizeof F);
    system->push(system->self, t, &now, F, Q, z_dot);
    for (int k = 0; k < system->points; k++) {
        F[k][1] -= system->mass[k] * system->gravity;
        for (int i = 0; i < 3; i++)
            F[k][i] -= system->mass[k] * a0[k][i];
    }
    for (int j = 0; j < n; j++) {
        force[j] = Q[j];
        for (int k = 0; k < system->points; k++)
            force[j] += J[j][k][0] * F[k][0] + J[j][k][1] * F[k][1] + J[j][k][2] * F[k][2];
        for (int l = 0; l <= j; l++) {
            double sum = 0;
            for (int k = 0; k < system->points; k++)
                sum += system->mass[k] * (J[j][k][0] * J[l][k][0] + J[j][k][1] * J[l][k][1] +
                                          J[j][k][2] * J[l][k][2]);
            M[j][l] = M[l][j] = sum;
        }
    }
    solve(system, M, force, y_dot + n);
    memcpy(y_dot, now.u, (size_t)n * sizeof *y_dot);
    memcpy(y_dot + 2 * n, z_dot, (size_t)system->extra * sizeof *z_dot);
    for (int j = 0; holding && j < n; j++) {
        holding[j] = -force[j];
        for (int l = 0; l < n; l++)
            holding[j] += M[j][l] * y_dot[n + l];
    }
}

void masses_step(const mass_system *system, double t, double h, double *y)
{
    enum { MOST = 2 * MOST_COORDINATES + MOST_EXTRA };
    double k[4][MOST], at[MOST];
    int count = 2 * system->coordinates + system->extra;
    for (int stage = 0; stage < 4; stage++) {
        double step = stage == 0 ? 0 : stage == 3 ? h : h / 2;
        for (int i = 0; i < count; i++)
            at[i] = stage ? y[i] + step * k[stage - 1][i] : y[i];
        // what changes at the ends of a step does so before its beginning and after its end
        double inside = stage == 0 ? 1e-9 : stage == 3 ? 1 - 1e-9 : 0.5;
        masses_rates(system, t + inside * h, at, k[stage], NULL);
    }
    for (int i = 0; i < count; i++)
        y[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
}

// ---- places

cplx_matrix turn_x(cplx angle)
{
    cplx c = ccos(angle), s = csin(angle);
    return (cplx_matrix){{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
}

cplx_matrix turn_y(cplx angle)
{
    cplx c = ccos(angle), s = csin(angle);
    return (cplx_matrix){{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
}

cplx_matrix turn_z(cplx angle)
{
    cplx c = ccos(angle), s = csin(angle);
    return (cplx_matrix){{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

cplx_matrix turns(cplx_matrix first, cplx_matrix second)
{
    cplx_matrix result;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            result.a[i][j] = 0;
            for (int k = 0; k < 3; k++)
                result.a[i][j] += first.a[i][k] * second.a[k][j];
        }
    return result;
}

void put_point(const cplx from[3], const cplx_matrix *A, const double p[3], cplx to[3])
{
    cplx at[3];
    for (int i = 0; i < 3; i++)
        at[i] = from[i] + A->a[i][0] * p[0] + A->a[i][1] * p[1] + A->a[i][2] * p[2];
    memcpy(to, at, sizeof at);
}

// ---- forces

double distance_of(const mass_motion *now, int a, int b, double *rate)
{
    double square = 0, product = 0;
    for (int i = 0; i < 3; i++) {
        double d = now->r[b][i] - now->r[a][i];
        square += d * d;
        product += d * (now->v[b][i] - now->v[a][i]);
    }
    *rate = product / sqrt(square);
    return sqrt(square);
}

void push_apart(const mass_motion *now, int a, int b, double f, double (*F)[3])
{
    double unused, length = distance_of(now, a, b, &unused);
    for (int i = 0; i < 3; i++) {
        double along = f * (now->r[b][i] - now->r[a][i]) / length;
        F[b][i] += along;
        F[a][i] -= along;
    }
}

void add_spring(const mass_motion *now, int a, int b, const mass_spring *spring, double (*F)[3])
{
    double rate, length = distance_of(now, a, b, &rate);
    double force = -spring->stiffness * (length - spring->length) - spring->damping * rate;
    push_apart(now, a, b, force, F);
}
