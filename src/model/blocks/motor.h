/// Thrust and what burns: the block `rocket.motor`.
#ifndef LD_MODEL_BLOCKS_MOTOR_H
#define LD_MODEL_BLOCKS_MOTOR_H

#include <stdbool.h>

#include "model/blocks/table.h"

/// Whether free flight counts what the gas that flows takes along and the rates of m, c and J.
typedef enum ld_jet_damping { LD_JET_DAMPING_NO, LD_JET_DAMPING_YES } ld_jet_damping;

typedef struct ld_motor {
    bool absent;            ///< no motor (flight alone, or a launch by pressure)
    ld_table thrust;        ///< t [s], T [N]; linear between, 0 after the last; a double time jumps
    double at[3];           ///< [m] x_T, e_y, e_z in B
    double misalignment[2]; ///< [-] eps_y, eps_z
    double thrust_scale;    ///< [-]
    double time_scale;      ///< [-]
    ld_jet_damping jet_damping;
    double exit_radius; ///< [m] of the nozzle, for jet damping
    ld_table masses;    ///< t [s], m [kg], x [m], J_x, J_t [kg m2] of the part of the rocket that
                        ///< loses mass; linear between, constant before and after. Empty: what
                        ///< burns goes with the impulse
    double masses_at;   ///< [m] x of B from which the table counts its centres
} ld_motor;

#endif
