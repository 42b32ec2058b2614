// Forward dynamics.
#include "systems/multibody/multibody.h"

ld_status ld_mstmm_accelerations(ld_mstmm *system, const double *q, const double *u,
                                 const double *tau, const double *wrench, double *u_dot,
                                 ld_error *error)
{
    tau = multibody_hinge_forces(system, q, u, tau);
    multibody_move(system, q, u);
    int singular = system->sweep->inwards(system, tau, wrench);
    if (singular)
        return multibody_singular(system, singular, error);
    system->sweep->outwards(system, u_dot);
    return LD_OK;
}
