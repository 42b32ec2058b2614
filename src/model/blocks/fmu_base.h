/// An imported FMU that carries the tube: what the block `base` holds of it.
#ifndef LD_MODEL_BLOCKS_FMU_BASE_H
#define LD_MODEL_BLOCKS_FMU_BASE_H

/// What of its motion and of the wrench on it a base says and hears by variables of an FMU.
typedef enum ld_fmu_quantity {
    LD_FMU_POSITION,                         ///< [m] x, y, z
    LD_FMU_QUATERNION = LD_FMU_POSITION + 3, ///< scalar first
    LD_FMU_ANGLES = LD_FMU_QUATERNION + 4,   ///< [rad] yaw, pitch, roll, in place of it
    LD_FMU_VELOCITY = LD_FMU_ANGLES + 3,     ///< [m/s]
    LD_FMU_RATE = LD_FMU_VELOCITY + 3,       ///< [rad/s]
    LD_FMU_FORCE = LD_FMU_RATE + 3,          ///< [N]
    LD_FMU_MOMENT = LD_FMU_FORCE + 3,        ///< [N m]
    LD_FMU_QUANTITIES = LD_FMU_MOMENT + 3
} ld_fmu_quantity;

typedef struct ld_fmu_parameter {
    char *name;   ///< of the FMU's variable, owned by the model
    double value; ///< in the FMU's unit; NaN: a text is given
    char *text;   ///< owned by the model; NULL: a number is given
} ld_fmu_parameter;

/// How an FMU takes inputs between the instants at which they are set.
typedef enum ld_fmu_inputs {
    LD_FMU_HELD,         ///< it holds them
    LD_FMU_EXTRAPOLATED, ///< it continues with them as the last ones report
    LD_FMU_RAMPED,       ///< it continues with them at the rates that it is given (FMI 2.0)
} ld_fmu_inputs;

/// In which axes an FMU reports its angular velocity.
typedef enum ld_fmu_axes { LD_FMU_AXES_OF_I, LD_FMU_AXES_OF_BODY } ld_fmu_axes;

enum { LD_MAX_FMU_PARAMETERS = 64 };

/// An FMU that carries the tube: fmi.md.
typedef struct ld_fmu_base {
    char *file;        ///< full path, owned by the model
    char *digest;      ///< of the file, "FNV-1a DIGEST of SIZE bytes", owned by the model
    double step;       ///< [s] between two instants at which pose and wrench are exchanged
    double start_time; ///< [s] of its own clock when the run begins
    double time_limit; ///< [s] longest that a call of one of its functions may take
    ld_fmu_inputs inputs;
    ld_fmu_axes rate_axes;
    struct { ///< names of variables with blanks between, owned by the model; NULL: as our vehicle's
        char *position, *quaternion, *angles, *velocity, *angular_rate, *force, *moment;
    } connect;
    int parameter_count;
    ld_fmu_parameter parameter[LD_MAX_FMU_PARAMETERS];
} ld_fmu_base;

#endif
