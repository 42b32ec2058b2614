// Natural frequencies and damping: eigenvalues of the equations linearised at rest.
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simulation/simulation.h"

// First-order unknowns: place and attitude of R (6), q, then of the rocket s, y_S, z_S, psi, theta,
// gamma; and their speeds: v, w, q_dot, V. Without the rocket its twelve are left out.
typedef struct linear_system {
    int n;     // unknowns
    int half;  // displacements
    double *A; // n x n, by columns
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

static int linearise(const ld_simulation *self, const launching_input *input,
                     const launching_phase *phase, const double *y, linear_system *system)
{
    int n = system->n, half = system->half;
    double plus[2 * LD_MAX_STATES], minus[2 * LD_MAX_STATES], trial[LD_MAX_STATES];
    size_t size = (size_t)self->state_count * sizeof(double);
    for (int j = 0; j < n; j++) {
        double h = j < half ? 1e-7 : 1e-5;
        memcpy(trial, y, size);
        displace(self, half, j, h, trial);
        int bad = rates(self, input, phase, trial, half, plus);
        memcpy(trial, y, size);
        displace(self, half, j, -h, trial);
        if (bad || rates(self, input, phase, trial, half, minus))
            return -1;
        for (int i = 0; i < n; i++)
            system->A[i + n * j] = (plus[i] - minus[i]) / (2 * h);
    }
    return 0;
}

// Which part moves most in an eigenvector: the group with the largest kinetic energy.
static const char *shape_of(const ld_simulation *self, int half, bool rocket, const double *real,
                            const double *imaginary)
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
        double amount = real[half + i] * real[half + i] + imaginary[half + i] * imaginary[half + i];
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
    if (p->frequency != q->frequency)
        return p->frequency < q->frequency ? -1 : 1;
    return p->real < q->real ? -1 : p->real > q->real;
}

// Eigenvalues with positive imaginary part, and real ones; those that the constraints leave at zero
// are dropped.
static int collect(const ld_simulation *self, const linear_system *system, bool rocket,
                   const double *wr, const double *wi, const double *vectors, ld_mode *modes,
                   int capacity)
{
    int count = 0, n = system->n;
    const double zeros[2 * LD_MAX_STATES] = {0};
    for (int i = 0; i < n && count < capacity; i++) {
        double size = hypot(wr[i], wi[i]);
        if (wi[i] < 0 || size < 1)
            continue;
        const double *v = vectors + (size_t)(n * i);
        modes[count++] = (ld_mode){
            .frequency = wi[i] / 6.283185307179586,
            .damping = -wr[i] / size,
            .real = wr[i],
            .shape = shape_of(self, system->half, rocket, v, wi[i] > 0 ? v + n : zeros),
        };
    }
    qsort(modes, (size_t)count, sizeof *modes, by_frequency);
    return count;
}

static int eigenmodes(const ld_simulation *self, const launching_input *input,
                      const launching_phase *phase, const double *y, ld_mode *modes, int capacity)
{
    linear_system system = {.half = 6 + self->launching.layout.nq + (phase->rocket ? 6 : 0)};
    system.n = 2 * system.half;
    size_t n = (size_t)system.n;
    double *memory = malloc((2 * n * n + 2 * n) * sizeof *memory);
    if (!memory)
        return -1;
    system.A = memory;
    double *vectors = memory + n * n, *wr = memory + 2 * n * n, *wi = wr + n;
    int count = -1;
    if (!linearise(self, input, phase, y, &system) &&
        !LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'V', system.n, system.A, system.n, wr, wi, NULL, 1,
                       vectors, system.n))
        count = collect(self, &system, phase->rocket, wr, wi, vectors, modes, capacity);
    free(memory);
    return count;
}

int ld_simulation_tube_modes(const ld_simulation *self, ld_mode *modes, int capacity)
{
    double y[LD_MAX_STATES];
    launching_input input;
    launching_phase phase = {.rocket = false};
    simulation_input(self, self->t_ignition, &input);
    input.base.v = input.base.w = v3_zero();
    simulation_undeformed(self, self->t_ignition, y);
    int count = eigenmodes(self, &input, &phase, y, modes, capacity);
    return count > 0 ? count : 0;
}

ld_status ld_simulation_system_modes(ld_simulation *self, ld_mode *modes, int capacity, int *count,
                                     ld_error *error)
{
    double y[LD_MAX_STATES];
    launching_input input;
    ld_equilibrium_summary unused;
    launching_phase phase = simulation_start_phase(self);
    double t = -self->model->run.lead_in;
    phase.frictionless = true;
    self->piece = -1;
    *count = 0;
    ld_status status = simulation_equilibrium(self, t, y, &unused, error);
    if (status)
        return status;
    simulation_input(self, t, &input);
    input.base.v = input.base.w = v3_zero();
    *count = eigenmodes(self, &input, &phase, y, modes, capacity);
    if (*count < 0) {
        *count = 0;
        return ld_fail(error, LD_ERR_NUMERIC, "the eigenvalues of the linearised system failed");
    }
    return LD_OK;
}
