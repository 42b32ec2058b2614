#include <string.h>

#include "elements/tube/shortening.h"
#include "elements/tube/tube_dynamics.h"
#include "math/vectors/rotation_vector.h"

// Value and slope of bending shape i of a plane.
static double bending_at(const tube_element *e, int plane, int i, double xi)
{
    const double(*b)[LD_NB] = e->b[plane];
    return b[0][i] + xi * (b[1][i] + xi * (b[2][i] + xi * b[3][i]));
}

static double slope_at(const tube_element *e, int plane, int i, double xi)
{
    const double(*b)[LD_NB] = e->b[plane];
    return b[1][i] + xi * (2 * b[2][i] + xi * 3 * b[3][i]);
}

// Columns of Phi (displacement) and Psi (rotation vector) of every mode at station x.
static void shapes_at(const flexible_tube *tube, double x, v3 *Phi, v3 *Psi)
{
    int nb = tube->nb, z = nb, t = 2 * nb, a = t + tube->nt;
    const tube_element *e = &tube->element[flexible_tube_find(tube, x)];
    double xi = x - e->x0;
    for (int i = 0; i < nb; i++) {
        Phi[i] = v3_make(0, bending_at(e, PLANE_Y, i, xi), 0);
        Psi[i] = v3_make(0, 0, slope_at(e, PLANE_Y, i, xi));
        Phi[z + i] = v3_make(0, 0, bending_at(e, PLANE_Z, i, xi));
        Psi[z + i] = v3_make(0, -slope_at(e, PLANE_Z, i, xi), 0);
    }
    for (int i = 0; i < nb && tube->shear; i++) {
        double(*strain)[LD_NB] = tube->shear->strain[e - tube->element];
        Psi[i].z -= strain[PLANE_Y][i];
        Psi[z + i].y += strain[PLANE_Z][i];
    }
    for (int i = 0; i < tube->nt; i++) {
        Phi[t + i] = v3_zero();
        Psi[t + i] = v3_make(e->tau[0][i] + xi * e->tau[1][i], 0, 0);
    }
    for (int i = 0; i < tube->na; i++) {
        Phi[a + i] = v3_make(e->a[0][i] + xi * e->a[1][i], 0, 0);
        Psi[a + i] = v3_zero();
    }
}

// Foreshortening: part x of Phi, what the combination with q has twice of the displacement; returns
// part x of the acceleration without accelerations of q.
static double shorten(const flexible_tube *tube, double x, const double *q, const double *q_dot,
                      v3 *Phi, double *twice)
{
    double Hq[LD_NB], of_rate[LD_NB], bending_on = 0;
    *twice = 0;
    for (int plane = PLANE_Y; plane <= PLANE_Z && tube->shortening; plane++) {
        const double *bent = q + plane * tube->nb, *rate = q_dot + plane * tube->nb;
        shortening_at(tube, plane, x, bent, Hq);
        shortening_at(tube, plane, x, rate, of_rate);
        for (int i = 0; i < tube->nb; i++) {
            Phi[plane * tube->nb + i].x = -Hq[i];
            *twice -= 0.5 * bent[i] * Hq[i];
            bending_on -= rate[i] * of_rate[i];
        }
    }
    return bending_on;
}

static v3 combine(int n, const v3 *column, const double *factor)
{
    v3 sum = v3_zero();
    for (int i = 0; i < n; i++)
        sum = v3_axpy(sum, factor[i], column[i]);
    return sum;
}

// Moves the section's point by `arm`, which turns with it.
static void move_point(int n, v3 w, v3 arm, tube_section_state *section)
{
    v3 u = v3_cross(section->spin, arm), bend = v3_from(section->gamma + 3);
    v3 gamma = v3_cross(w, v3_axpy(v3_cross(w, arm), 2, u));
    bend = v3_sub(bend, v3_cross(w, section->spin)); // relative to R
    gamma = v3_add(gamma, v3_add(v3_cross(bend, arm), v3_cross(section->spin, u)));
    section->position = v3_add(section->position, arm);
    section->velocity = v3_add(section->velocity, u);
    v3_store(section->gamma, v3_add(v3_from(section->gamma), gamma));
    double *L = section->L;
    for (int k = 0; k < n; k++) {
        v3 turn = v3_make(L[3 * n + k], L[4 * n + k], L[5 * n + k]), shift = v3_cross(turn, arm);
        L[k] += shift.x;
        L[n + k] += shift.y;
        L[2 * n + k] += shift.z;
    }
}

void guide_section(const guide_station *at, v3 w, const double *q, const double *q_dot,
                   tube_section_state *section)
{
    const flexible_tube *tube = at->tube;
    double x = at->x;
    v3 Phi[LD_TUBE_MODES], Psi[LD_TUBE_MODES];
    int modes = tube_mode_count(tube), n = 6 + modes;
    double inside = x < 0 ? 0 : x > tube->length ? tube->length : x;
    double twice, pulled;
    shapes_at(tube, inside, Phi, Psi);
    pulled = shorten(tube, inside, q, q_dot, Phi, &twice);

    // position, rotation and their rates against R
    v3 p = combine(modes, Phi, q), u = combine(modes, Phi, q_dot);
    v3 th = combine(modes, Psi, q), th_dot = combine(modes, Psi, q_dot);
    p.x += inside - twice;
    if (at->initial) {
        initial_section initial;
        initial_shape_at(at->initial, inside, &initial);
        p = v3_add(p, initial.P);
        th = v3_add(th, initial.th);
    }
    m3 Jl = rv_left_jacobian(th);
    v3 spin = m3_apply(Jl, th_dot);
    section->position = p;
    section->velocity = u;
    section->rotation = rv_exp(th);
    section->rotation_vector = th;
    section->spin = spin;

    // gamma = (w x (w x p) + 2 w x Phi q_dot, Jl_dot Psi q_dot + w x Jl Psi q_dot)
    v3 moved = v3_cross(w, v3_axpy(v3_cross(w, p), 2, u));
    v3_store(section->gamma, v3_make(moved.x + pulled, moved.y, moved.z));
    v3_store(section->gamma + 3,
             v3_add(rv_left_jacobian_derivative(th, th_dot, th_dot), v3_cross(w, spin)));

    // L = [E, -~p, Phi; 0, E, Jl Psi]
    double *L = section->L;
    m3 p_skew = m3_skew(p);
    memset(L, 0, (size_t)(6 * n) * sizeof *L);
    for (int i = 0; i < 3; i++) {
        L[i * n + i] = L[(3 + i) * n + 3 + i] = 1;
        for (int j = 0; j < 3; j++)
            L[i * n + 3 + j] = -p_skew.a[i][j];
    }
    for (int k = 0; k < modes; k++) {
        double shift[3], turn[3];
        v3_store(shift, Phi[k]);
        v3_store(turn, m3_apply(Jl, Psi[k]));
        for (int i = 0; i < 3; i++) {
            L[i * n + 6 + k] = shift[i];
            L[(3 + i) * n + 6 + k] = turn[i];
        }
    }
    if (x != inside)
        move_point(n, w, v3_scale(x - inside, m3_column(section->rotation, 0)), section);
}

void tube_section(const flexible_tube *tube, double x, v3 w, const double *q, const double *q_dot,
                  tube_section_state *section)
{
    guide_section(&(guide_station){tube, NULL, x}, w, q, q_dot, section);
}
