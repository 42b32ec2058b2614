#include "systems/mechanism/mechanism_loops.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "systems/mechanism/mechanism_motion.h"
#include "systems/mechanism/mechanism_state.h"

// The chain's coordinates and speeds: those of the state, and the carrier's where it has one.
typedef struct chain_state {
    double q[MECHANISM_MOST_COORDINATES], u[MECHANISM_MOST_SPEEDS];
} chain_state;

static void gather(const mechanism_system *self, const base_frame *carrier, const double *state,
                   chain_state *chain)
{
    mechanism_gather(self, carrier, state, chain->q, chain->u);
}

static void scatter(const mechanism_system *self, const chain_state *chain, double *state)
{
    memcpy(state, chain->q, (size_t)self->q_count * sizeof *state);
    memcpy(state + self->q_count, chain->u, (size_t)self->u_count * sizeof *state);
}

// Says it of the scenario's joint.
static ld_status report_open(const mechanism_system *self, const ld_error *found, ld_error *error)
{
    char name[LD_MAX_NAME];
    double gap, turn;
    int joint = -1;
    if (sscanf(found->text, "loop '%63[^']' cannot be closed: %lg m and %lg rad", name, &gap,
               &turn) == 3)
        joint = mechanism_joint(self->given, name);
    if (joint < 0)
        return ld_fail(error, found->status, "base.joints: the loops cannot be closed: %s",
                       found->text);
    return ld_fail(error, LD_ERR_INPUT,
                   "base.joints.%s: the loop of \"%s\" and \"%s\" cannot be closed: %.3g m and "
                   "%.3g rad are left; check positions and where joints start",
                   name, self->given->joint[joint].parent, self->given->joint[joint].body, gap,
                   turn);
}

ld_status mechanism_assemble(const mechanism_system *self, const base_frame *carrier, double *state,
                             ld_error *error)
{
    int kept[MECHANISM_MOST_ELEMENTS] = {0};
    chain_state chain;
    ld_error found;
    if (ld_mstmm_loop_count(self->chain) == 0)
        return LD_OK;
    for (int i = 0; i < self->hold_count; i++)
        if (self->hold[i].joint >= 0)
            kept[self->joint_element[self->hold[i].joint]] = 1;
    gather(self, carrier, state, &chain);
    ld_status status = ld_mstmm_assemble(self->chain, chain.q, chain.u, kept, NULL, &found);
    scatter(self, &chain, state);
    return status ? report_open(self, &found, error) : LD_OK;
}

void mechanism_project(const mechanism_system *self, const base_frame *carrier, double *state)
{
    chain_state chain;
    if (ld_mstmm_loop_count(self->chain) == 0)
        return;
    gather(self, carrier, state, &chain);
    if (!ld_mstmm_project(self->chain, chain.q, chain.u, NULL))
        scatter(self, &chain, state);
}

// ---- independent speeds

// Rows of `basis` made such that row i has a 1 at column[i] and 0 at the other rows' columns.
static bool solve_for(int rows, int n, const int *column, double *basis)
{
    for (int i = 0; i < rows; i++) {
        int best = i;
        for (int k = i + 1; k < rows; k++)
            if (fabs(basis[k * n + column[i]]) > fabs(basis[best * n + column[i]]))
                best = k;
        double pivot = basis[best * n + column[i]];
        if (!(fabs(pivot) > 1e-9))
            return false;
        for (int j = 0; j < n; j++) {
            double swap = basis[best * n + j];
            basis[best * n + j] = basis[i * n + j];
            basis[i * n + j] = swap / pivot;
        }
        for (int k = 0; k < rows; k++) {
            double share = basis[k * n + column[i]];
            for (int j = 0; j < n && k != i; j++)
                basis[k * n + j] -= share * basis[i * n + j];
        }
    }
    return true;
}

static bool is_held(const mechanism_system *self, int u)
{
    for (int i = 0; i < self->hold_count; i++)
        if (self->hold[i].joint >= 0 && self->hold[i].u == u)
            return true;
    return false;
}

// The column of the largest element in rows from `row` on, among speeds of holds or others; -1.
// NOLINTNEXTLINE(readability-function-size)
static int largest(const mechanism_system *self, int rows, int n, int row, bool held,
                   const double *basis, const bool *taken, int *at)
{
    int best = -1;
    double most = held ? 1e-3 : 1e-9;
    for (int k = 0; k < self->u_count; k++)
        for (int i = row; i < rows && !taken[k] && is_held(self, k) == held; i++)
            if (fabs(basis[i * n + k]) > most) {
                most = fabs(basis[i * n + k]);
                best = k;
                *at = i;
            }
    return best;
}

static void eliminate(int rows, int n, int row, int at, int column, double *basis)
{
    for (int j = 0; j < n; j++) {
        double swap = basis[at * n + j];
        basis[at * n + j] = basis[row * n + j];
        basis[row * n + j] = swap;
    }
    for (int i = row + 1; i < rows; i++) {
        double share = basis[i * n + column] / basis[row * n + column];
        for (int j = 0; j < n; j++)
            basis[i * n + j] -= share * basis[row * n + j];
    }
}

static int ascending(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

// Loops that leave no freedom are refused where they hold more than there is.
static ld_status check_rigid(const mechanism_system *self, ld_error *error)
{
    for (int i = self->given->joint_count - 1; i >= 0; i--) {
        const ld_joint *joint = &self->given->joint[i];
        int implied = self->joint_loop[i] < 0
                          ? 0
                          : ld_mstmm_loop_redundancy(self->chain, self->joint_loop[i]);
        if (implied > 0)
            return ld_fail(error, LD_ERR_INPUT,
                           "base.joints.%s: more constraints than degrees of freedom: nothing can "
                           "move, and others imply %d constraints of this joint; remove it, or use "
                           "a kind that holds less",
                           joint->name, implied);
    }
    return LD_OK;
}

ld_status mechanism_find_freedoms(mechanism_system *self, const base_frame *carrier,
                                  const double *state, ld_error *error)
{
    int n = ld_mstmm_speed_count(self->chain), rows = 0;
    bool taken[MECHANISM_MOST_SPEEDS] = {0};
    chain_state chain;
    if (ld_mstmm_loop_count(self->chain) == 0)
        return LD_OK;
    gather(self, carrier, state, &chain);
    double *basis = malloc((size_t)(n * n) * sizeof *basis);
    if (!basis)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's loops");
    ld_status status = ld_mstmm_freedoms(self->chain, chain.q, basis, &rows, error);
    self->freedom_count = 0;
    for (int i = 0, at = 0; i < rows && !status; i++) {
        int column = largest(self, rows, n, i, true, basis, taken, &at);
        if (column < 0)
            column = largest(self, rows, n, i, false, basis, taken, &at);
        if (column < 0)
            break;
        taken[column] = true;
        self->freedom[self->freedom_count++] = column;
        eliminate(rows, n, i, at, column, basis);
    }
    if (!status && self->freedom_count == 0)
        status = check_rigid(self, error);
    qsort(self->freedom, (size_t)self->freedom_count, sizeof *self->freedom, ascending);
    free(basis);
    return status;
}

// The speeds of all joints while freedom i goes at 1 and the other freedoms stand.
static bool find_row(const mechanism_system *self, const chain_state *chain, int i, double *row)
{
    int n = ld_mstmm_speed_count(self->chain), rows = 0;
    double *basis = malloc((size_t)(n * n) * sizeof *basis);
    bool good = basis && !ld_mstmm_freedoms(self->chain, chain->q, basis, &rows, NULL) &&
                rows == self->freedom_count && solve_for(rows, n, self->freedom, basis);
    if (good)
        memcpy(row, basis + i * n, (size_t)n * sizeof *row);
    free(basis);
    return good;
}

// A frame that stands in the origin: loops close wherever the carrier is.
static const base_frame ORIGIN = {.A = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .q = {1, 0, 0, 0}};

void mechanism_displace_freedom(const mechanism_system *self, int i, double change, double *state)
{
    double row[MECHANISM_MOST_SPEEDS];
    chain_state chain;
    if (ld_mstmm_loop_count(self->chain) == 0) {
        mechanism_displace(self, self->freedom[i], change, state);
        return;
    }
    gather(self, &ORIGIN, state, &chain);
    if (!find_row(self, &chain, i, row))
        return;
    for (int k = 0; k < self->u_count; k++)
        if (row[k] != 0)
            mechanism_displace(self, k, change * row[k], state);
    mechanism_project(self, &ORIGIN, state);
}

void mechanism_quicken_freedom(const mechanism_system *self, int i, double change, double *state)
{
    double row[MECHANISM_MOST_SPEEDS], *u = state + self->q_count;
    chain_state chain;
    if (ld_mstmm_loop_count(self->chain) == 0) {
        u[self->freedom[i]] += change;
        return;
    }
    gather(self, &ORIGIN, state, &chain);
    if (!find_row(self, &chain, i, row))
        return;
    for (int k = 0; k < self->u_count; k++)
        u[k] += change * row[k];
}

void mechanism_settle(const mechanism_system *self, int i, double change, double *state)
{
    int rolling = mechanism_rolling(self);
    if (rolling < 0 || self->freedom[i] != rolling + 5) {
        mechanism_displace_freedom(self, i, change, state);
        return;
    }
    double *q = state + ld_mstmm_coordinate_offset(self->chain, self->wheels) + 3;
    quat turn = {cos(0.5 * change), 0, 0, sin(0.5 * change)}, now = q_multiply(turn, q_from(q));
    memcpy(q, &now, sizeof now);
    mechanism_project(self, &ORIGIN, state);
}
