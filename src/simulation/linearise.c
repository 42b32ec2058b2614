// Natural frequencies and damping: eigenvalues of the equations linearised at rest.
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simulation/simulation.h"

static const double TWO_PI = 6.283185307179586476925286766559;

// Unknowns: place and attitude of R (6), q, then of the rocket s, y_S, z_S, psi, theta, gamma;
// their speeds v, w, q_dot, V. At rest x_dot = T v, v_dot = -K x - C v. Without the rocket its six
// are left out.
typedef struct linear_system {
    int half;          // displacements, and speeds
    double *T, *K, *C; // half x half, by columns
} linear_system;

static void displace(const ld_simulation *self, int half, int unknown, double change, double *y)
{
    const launching_layout *at = &self->launching.layout;
    int tube = 6 + at->nq;
    if (unknown < tube)
        simulation_displace(self, unknown, change, y);
    else if (unknown < half)
        y[at->x + unknown - tube] += change;
    else if (unknown < half + 6)
        y[at->v + unknown - half] += change; // v, then w
    else if (unknown < half + tube)
        y[at->q_dot + unknown - half - 6] += change;
    else
        y[at->V + unknown - half - tube] += change;
}

// Rates of the unknowns at state y, in the same order.
static int rates(const ld_simulation *self, const launching_input *input,
                 const launching_phase *phase, const double *y, int half, double *r)
{
    const launching_layout *at = &self->launching.layout;
    launching_output out;
    double y_dot[LD_MAX_STATES];
    if (launching_evaluate(&self->launching, input, phase, y, &out))
        return -1;
    launching_rates(&self->launching, y, &out, phase->rocket, y_dot);
    int tube = 6 + at->nq;
    memcpy(r, y_dot + at->r, 3 * sizeof(double));
    memcpy(r + 3, y + at->w, 3 * sizeof(double)); // small rotations in R
    memcpy(r + 6, y_dot + at->q, (size_t)at->nq * sizeof(double));
    memcpy(r + half, y_dot + at->v, 6 * sizeof(double));
    memcpy(r + half + 6, y_dot + at->q_dot, (size_t)at->nq * sizeof(double));
    if (phase->rocket) {
        memcpy(r + tube, y_dot + at->x, 6 * sizeof(double));
        memcpy(r + half + tube, y_dot + at->V, 6 * sizeof(double));
    }
    return 0;
}

static ld_status linearise(const ld_simulation *self, const launching_input *input,
                           const launching_phase *phase, const double *y, linear_system *system,
                           ld_error *error)
{
    int half = 6 + self->launching.layout.nq + (phase->rocket ? 6 : 0);
    double plus[2 * LD_MAX_STATES], minus[2 * LD_MAX_STATES], trial[LD_MAX_STATES];
    size_t size = (size_t)self->state_count * sizeof(double), square = (size_t)half * (size_t)half;
    system->half = half;
    system->T = calloc(3 * square, sizeof(double));
    if (!system->T)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the linearised equations");
    system->K = system->T + square;
    system->C = system->T + 2 * square;
    for (int j = 0; j < 2 * half; j++) {
        double h = j < half ? 1e-7 : 1e-5;
        memcpy(trial, y, size);
        displace(self, half, j, h, trial);
        int bad = rates(self, input, phase, trial, half, plus);
        memcpy(trial, y, size);
        displace(self, half, j, -h, trial);
        if (bad || rates(self, input, phase, trial, half, minus))
            return ld_fail(error, LD_ERR_NUMERIC, "the equations cannot be linearised");
        for (int i = 0; i < half; i++) {
            double of_speed = (plus[half + i] - minus[half + i]) / (2 * h);
            if (j < half) {
                system->K[i + half * j] = -of_speed;
            } else {
                system->C[i + half * (j - half)] = -of_speed;
                system->T[i + half * (j - half)] = (plus[i] - minus[i]) / (2 * h);
            }
        }
    }
    return LD_OK;
}

// Which part moves most in an eigenvector: the group with the largest kinetic energy.
static const char *shape_of(const ld_simulation *self, bool rocket, const double *speeds)
{
    enum { VERTICAL, LATERAL, ALONG, TWIST, ROCKET_Y, ROCKET_Z, ROCKET_ROLL, GROUPS };
    static const char *const names[GROUPS] = {
        [VERTICAL] = "tube, vertical plane",    [LATERAL] = "tube, lateral plane",
        [ALONG] = "tube, along its axis",       [TWIST] = "tube, twist",
        [ROCKET_Y] = "rocket, pitch and heave", [ROCKET_Z] = "rocket, yaw and sway",
        [ROCKET_ROLL] = "rocket, roll",
    };
    const launching_system *launching = &self->launching;
    int nb = launching->tube.nb, nt = launching->tube.nt, nq = launching->layout.nq;
    double energy[GROUPS] = {0};
    double m = launching->m, j = launching->tube.j0;
    const double mass[6] = {m, m, m, launching->jx, j, j};
    const int group[6] = {ALONG, VERTICAL, LATERAL, TWIST, LATERAL, VERTICAL};
    for (int i = 0; i < 6 + nq + (rocket ? 6 : 0); i++) {
        double amount = speeds[i] * speeds[i];
        int k = i - 6;
        if (i < 6)
            energy[group[i]] += mass[i] * amount;
        else if (k < nq)
            energy[k < nb            ? VERTICAL
                   : k < 2 * nb      ? LATERAL
                   : k < 2 * nb + nt ? TWIST
                                     : ALONG] += amount;
        else {
            const rocket_mass *full = &self->motor.full;
            k -= nq;
            double inertia[6] = {full->m,         full->m,         full->m,
                                 full->J.a[0][0], full->J.a[1][1], full->J.a[2][2]};
            const int rocket_group[6] = {ALONG,       ROCKET_Y, ROCKET_Z,
                                         ROCKET_ROLL, ROCKET_Z, ROCKET_Y};
            energy[rocket_group[k]] += inertia[k] * amount;
        }
    }
    int best = 0;
    for (int g = 1; g < GROUPS; g++)
        if (energy[g] > energy[best])
            best = g;
    return names[best];
}

static int by_frequency(const void *a, const void *b)
{
    const ld_mode *p = a, *q = b;
    return (p->frequency > q->frequency) - (p->frequency < q->frequency);
}

// left^T C right/(left^T right): what the dampers do to a mode, 2 zeta omega.
static double modal_damping(int n, const double *C, const double *left, const double *right)
{
    double damped = 0, norm = 0;
    for (int j = 0; j < n; j++) {
        norm += left[j] * right[j];
        for (int i = 0; i < n; i++)
            damped += left[i] * C[i + n * j] * right[j];
    }
    return damped / norm;
}

// Undamped modes K T v = omega^2 v with the damping of each shape; those that the constraints leave
// at zero are dropped.
static ld_status eigenmodes(const ld_simulation *self, const linear_system *system, bool rocket,
                            ld_mode *modes, int capacity, int *count, ld_error *error)
{
    int n = system->half;
    size_t square = (size_t)n * (size_t)n;
    double *memory = calloc(3 * square + 2 * (size_t)n, sizeof *memory);
    if (!memory)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the modes");
    double *KT = memory, *left = memory + square, *right = left + square, *wr = right + square,
           *wi = wr + n;
    for (int j = 0; j < n; j++)
        for (int k = 0; k < n; k++)
            for (int i = 0; i < n; i++)
                KT[i + n * j] += system->K[i + n * k] * system->T[k + n * j];
    int bad = LAPACKE_dgeev(LAPACK_COL_MAJOR, 'V', 'V', n, KT, n, wr, wi, left, n, right, n);
    *count = 0;
    for (int i = 0; i < n && !bad && *count < capacity; i++) {
        if (wr[i] < 1)
            continue;
        double omega = sqrt(wr[i]);
        double rate = 0.5 * modal_damping(n, system->C, left + n * i, right + n * i);
        modes[(*count)++] = (ld_mode){.frequency = omega / TWO_PI,
                                      .damping = rate / omega,
                                      .real = -rate,
                                      .shape = shape_of(self, rocket, right + n * i)};
    }
    free(memory);
    qsort(modes, (size_t)*count, sizeof *modes, by_frequency);
    return bad ? ld_fail(error, LD_ERR_NUMERIC,
                         "the eigenvalues of the linearised equations failed")
               : LD_OK;
}

static int by_size(const void *a, const void *b)
{
    const ld_pole *p = a, *q = b;
    double x = hypot(p->real, p->imaginary), y = hypot(q->real, q->imaginary);
    return (x > y) - (x < y);
}

// Eigenvalues of [0 T; -K -C] with imaginary part >= 0, but for those that the constraints leave at
// zero.
static ld_status eigenvalues(const linear_system *system, ld_pole *poles, int capacity, int *count,
                             ld_error *error)
{
    int half = system->half, n = 2 * half;
    double *A = calloc(((size_t)n + 2) * (size_t)n, sizeof *A), *wr = A + n * n, *wi = wr + n;
    if (!A)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the eigenvalues");
    for (int j = 0; j < half; j++)
        for (int i = 0; i < half; i++) {
            A[i + n * (half + j)] = system->T[i + half * j];
            A[half + i + n * j] = -system->K[i + half * j];
            A[half + i + n * (half + j)] = -system->C[i + half * j];
        }
    int bad = LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, A, n, wr, wi, NULL, 1, NULL, 1);
    *count = 0;
    for (int i = 0; i < n && !bad && *count < capacity; i++)
        if (wi[i] >= 0 && hypot(wr[i], wi[i]) >= 1)
            poles[(*count)++] = (ld_pole){wr[i], wi[i]};
    free(A);
    qsort(poles, (size_t)*count, sizeof *poles, by_size);
    return bad ? ld_fail(error, LD_ERR_NUMERIC,
                         "the eigenvalues of the linearised equations failed")
               : LD_OK;
}

int ld_simulation_tube_modes(const ld_simulation *self, ld_mode *modes, int capacity)
{
    double y[LD_MAX_STATES];
    int count = 0;
    launching_input input;
    linear_system system = {0};
    launching_phase phase = {.rocket = false};
    simulation_input(self, self->t_ignition, &input);
    input.base.v = input.base.w = v3_zero();
    simulation_undeformed(self, self->t_ignition, y);
    if (!linearise(self, &input, &phase, y, &system, NULL))
        eigenmodes(self, &system, false, modes, capacity, &count, NULL);
    free(system.T);
    return count;
}

ld_status ld_simulation_system_modes(ld_simulation *self, ld_mode *modes, int capacity, int *count,
                                     ld_pole *poles, int pole_capacity, int *pole_count,
                                     ld_error *error)
{
    double y[LD_MAX_STATES];
    launching_input input;
    ld_equilibrium_summary unused;
    linear_system system = {0};
    launching_phase phase = simulation_start_phase(self);
    double t = -self->model->run.lead_in;
    phase.frictionless = true;
    self->piece = -1;
    *count = *pole_count = 0;
    ld_status status = simulation_equilibrium(self, t, y, &unused, error);
    if (status)
        return status;
    simulation_input(self, t, &input);
    input.base.v = input.base.w = v3_zero();
    status = linearise(self, &input, &phase, y, &system, error);
    if (!status)
        status = eigenmodes(self, &system, true, modes, capacity, count, error);
    if (!status)
        status = eigenvalues(&system, poles, pole_capacity, pole_count, error);
    free(system.T);
    return status;
}
