// Accelerations of the launching subsystem from the tube's general mass matrix, in the reduced form
// (formulation.md, sections 3 to 5). Clear rather than fast; forces and constraints are those of
// the fast layout.
#ifndef LD_SYSTEMS_LAUNCHING_GENERAL_H
#define LD_SYSTEMS_LAUNCHING_GENERAL_H

#include "elements/tube/tube_dynamics.h"
#include "systems/launching/launching_constraints.h"

// As launching_evaluate; with axial modes, too.
launching_outcome launching_evaluate_general(const launching_system *self,
                                             const launching_input *input,
                                             const launching_phase *phase, const double *state,
                                             launching_output *output);

// What an impulse changes speeds by (or, along the same directions, places): as accelerations of
// the tube and of the rocket.
typedef struct launching_change {
    v3 a, w_dot, a_O1, alpha_B;
    double q_ddot[LD_MAX_MODAL];
} launching_change;

// The impulse of the set's constraints that takes `wrong` [set->count] out of their rates, from the
// general mass matrix; none where that is not positive definite.
void launching_impulse_general(const launching_system *self, const launching_instant *now,
                               const constraint_set *set, const double *state, const double *wrong,
                               launching_change *change);

// Tube and rocket before they are coupled.
typedef struct launching_uncoupled {
    int n;                                     // speeds of the tube
    double M[LD_TUBE_SPEEDS * LD_TUBE_SPEEDS]; // tube alone
    double h[LD_TUBE_SPEEDS];                  // tube alone, with supports and contacts
    launching_instant now;
    launching_constraints c;
    double B[LD_MAX_CONSTRAINTS + 1]
            [LD_TUBE_SPEEDS];             // generalised forces of the directions; last: tangent
    const tube_section_state *rear, *tip; // of the tube, for the overall form
} launching_uncoupled;

// Fills *u and, of `output`, powers and elastic energy.
void launching_uncouple(const launching_system *self, const launching_input *input,
                        const launching_phase *phase, const double *state, launching_uncoupled *u,
                        launching_output *output);
// Couples them: the accelerations, the constraints' forces.
launching_outcome launching_solve_reduced(const launching_system *self,
                                          const launching_phase *phase, launching_uncoupled *u,
                                          launching_output *output);
// The tube's accelerations from its n generalised ones.
void launching_store_tube(int n, const double *eta_dot, launching_output *output);

// Of two vectors with n numbers.
LD_INLINE double launching_dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

#endif
