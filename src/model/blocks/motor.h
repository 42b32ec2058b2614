/// Thrust and what burns: the blocks `rocket.motor` and `rocket.further_motors`.
#ifndef LD_MODEL_BLOCKS_MOTOR_H
#define LD_MODEL_BLOCKS_MOTOR_H

#include <stdbool.h>

#include "model/blocks/table.h"

/// Whether free flight counts what the gas that flows takes along and the rates of m, c and J.
typedef enum ld_jet_damping { LD_JET_DAMPING_NO, LD_JET_DAMPING_YES } ld_jet_damping;

/// The shape of the spectrum of a side force's noise.
typedef enum ld_spectrum_form { LD_SPECTRUM_CORNER, LD_SPECTRUM_TABLE } ld_spectrum_form;

/// The random part of the side force.
typedef struct ld_side_noise {
    bool present;
    ld_table deviation; ///< t [s] from ignition, [N] of each component; linear, constant outside
    ld_spectrum_form form;
    double corner;     ///< [Hz]
    ld_table spectrum; ///< [Hz], [-] density over the frequency, but for a factor; linear
    int seed;
    int harmonics; ///< cells of the spectrum
} ld_side_noise;

/// Force across the axis at the nozzle while the motor burns.
typedef struct ld_side_force {
    bool present;
    ld_table force; ///< t [s] from ignition, F_y, F_z [N] in B; linear, constant outside
    double scale;   ///< [-] of both parts
    double angle;   ///< [rad] by which `force` is turned about x of B
    ld_side_noise noise;
} ld_side_force;

/// How the jet's pressure is given.
typedef enum ld_plume_form { LD_PLUME_ROUND, LD_PLUME_TABLE } ld_plume_form;

/// The jet of all motors on rings of the guide.
typedef struct ld_plume {
    bool present;
    ld_plume_form form;
    double radius; ///< [m] of the round jet at the nozzle, where the pressure is 1/e of the axis'
    double spread; ///< [-] growth of that radius over the distance
    ld_table pressure; ///< distance, radius [m], pressure [Pa] at the greatest thrust; linear
    double reach;      ///< [m] distance at which the jet ends
} ld_plume;

typedef struct ld_motor {
    bool absent;            ///< no motor (flight alone, or a launch by pressure)
    ld_table thrust;        ///< t [s], T [N]; linear between, 0 after the last; a double time jumps
    double at[3];           ///< [m] x_T, e_y, e_z in B
    double misalignment[2]; ///< [-] eps_y, eps_z
    double thrust_scale;    ///< [-]
    double time_scale;      ///< [-]
    double rise_scale;      ///< [-] of the times up to 90 % of the greatest thrust
    double delay;           ///< [s] from ignition to the tables' beginning
    ld_jet_damping jet_damping;
    double exit_radius; ///< [m] of the nozzle, for jet damping
    ld_table masses;    ///< t [s], m [kg], x [m], J_x, J_t [kg m2] of the part of the rocket that
                        ///< loses mass; linear between, constant before and after. Empty: what
                        ///< burns goes with the impulse
    double masses_at;   ///< [m] x of B from which the table counts its centres
    ld_side_force side_force;
    ld_table nozzle; ///< t [s], eps_y, eps_z [-], y, z [m] besides `misalignment` and `at`; linear,
                     ///< constant outside
    ld_plume plume;
} ld_motor;

/// A motor besides: `rocket.further_motors`.
typedef struct ld_further_motor {
    ld_table thrust;        ///< as of ld_motor; so the rest
    double at[3];           ///< [m] in B
    double misalignment[2]; ///< [-]
    double thrust_scale;    ///< [-]
    double time_scale;      ///< [-]
    double delay;           ///< [s] from ignition
    ld_table masses;        ///< of a part on the line through `at` along x; empty: what burns goes
                            ///< with the impulse of all motors
    double masses_at;       ///< [m]
} ld_further_motor;

#endif
