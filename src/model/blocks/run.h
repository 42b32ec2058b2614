/// How a run is computed: the block `run`.
#ifndef LD_MODEL_BLOCKS_RUN_H
#define LD_MODEL_BLOCKS_RUN_H

typedef enum ld_start { LD_START_EQUILIBRIUM, LD_START_UNDEFORMED } ld_start;
typedef enum ld_formulation { LD_FORMULATION_REDUCED, LD_FORMULATION_OVERALL } ld_formulation;
typedef enum ld_lead_in_method { LD_LEAD_IN_EXPLICIT, LD_LEAD_IN_EXPONENTIAL } ld_lead_in_method;
typedef enum ld_exit_error { LD_EXIT_ERROR_NO, LD_EXIT_ERROR_YES } ld_exit_error;
typedef enum ld_end { LD_END_TIP, LD_END_TIME, LD_END_LANDING, LD_END_APOGEE } ld_end;

typedef struct ld_run_settings {
    ld_start start;
    ld_formulation formulation;
    double lead_in;                   ///< [s]
    ld_lead_in_method lead_in_method; ///< while no rocket is driven through its tube
    ld_end end;
    double end_time;            ///< [s] after the last ignition (LD_END_TIME)
    double tolerance;           ///< [-] relative tolerance of the integrator
    ld_exit_error exit_error;   ///< whether the steps' error in the rates at the exit is estimated
    double max_step;            ///< [s] longest step until the last rocket has left its tube; NaN:
                                ///< see model_complete()
    double output_step_lead_in; ///< [s]
    double output_step_tube;    ///< [s]
    double output_step_flight;  ///< [s]
    double stuck_time;   ///< [s] after ignition at which a rocket still in the tube is given up;
                         ///< NaN: see model_complete()
    double flight_limit; ///< [s] longest free flight
    double flight_tolerance; ///< [-] relative tolerance in free flight
    double coupling_step; ///< [s] at which the subsystems, integrated apart, exchange; 0: together
} ld_run_settings;

#endif
