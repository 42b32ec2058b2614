// Forward dynamics.
#include "systems/multibody/closing.h"
#include "systems/multibody/loop_rows.h"

ld_status multibody_accelerate(ld_mstmm *system, const double *q, const double *u,
                               const multibody_load *load, double *u_dot, ld_error *error)
{
    const double *tau = multibody_hinge_forces(system, q, u, load->tau), *wrench = load->wrench;
    system->moves++; // the sweep uses it up
    if (system->loop_count > 0) {
        loops_place(system, u);
        wrench = loops_load(system, wrench);
    }
    int singular = system->sweep->inwards(system, tau, wrench);
    if (singular)
        return multibody_singular(system, singular, error);
    if (system->loop_count > 0) {
        ld_status status = loops_close(system, error);
        if (status)
            return status;
    }
    system->sweep->outwards(system, u_dot);
    return LD_OK;
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_mstmm_accelerations(ld_mstmm *system, const double *q, const double *u,
                                 const double *tau, const double *wrench, double *u_dot,
                                 ld_error *error)
{
    if (!q) {
        q = system->known;
        u = q + system->q_count;
    }
    if (q != system->known || system->known_at != system->moves)
        multibody_move(system, q, u);
    return multibody_accelerate(system, q, u, &(multibody_load){tau, wrench}, u_dot, error);
}
