// A vehicle by MuJoCo (vehicle.xml), as an FMU requires it: numbered variables, steps, a state as
// numbers. It begins at rest in equilibrium under the wrench that it was given.
#ifndef LD_EXAMPLES_MUJOCO_VEHICLE_H
#define LD_EXAMPLES_MUJOCO_VEHICLE_H

#include <stdbool.h>
#include <stddef.h>

// Numbers of the variables, as in the descriptions. All in I (x forward, y up), SI.
enum {
    VEHICLE_FORCE = 0,        // [3] in: wrench on what holds the tube
    VEHICLE_MOMENT = 3,       // [3] about the place of frame T
    VEHICLE_INPUTS = 6,       //
    VEHICLE_BASE = 6,         // [13] position, quaternion (scalar first), velocity and rate of the
    VEHICLE_CHASSIS = 19,     // [13] undeformed tube's rear end, frame T, and of the chassis
    VEHICLE_ENERGY = 32,      // kinetic and of springs and height
    VEHICLE_OUTPUTS_END = 33, //
    VEHICLE_PITCH = 33,       // parameters: of the tube at the start
    VEHICLE_DAMPING_SCALE = 34, // factor on all damping
    VEHICLE_STEP = 35,          // largest of the integration
    VEHICLE_VARIABLES = 36
};

typedef struct vehicle vehicle;

// NULL: `error` [error_size] says why. resources: the folder with vehicle.xml.
vehicle *vehicle_create(const char *resources, char *error, size_t error_size);
void vehicle_free(vehicle *self);

// Back to what it was when created.
void vehicle_reset(vehicle *self);

// What these refuse, `error` says; nothing is changed then.
bool vehicle_set(vehicle *self, unsigned variable, double value, char *error, size_t error_size);
// Before the start the outputs are those of the equilibrium under the present inputs.
bool vehicle_get(vehicle *self, unsigned variable, double *value, char *error, size_t error_size);
// Ends the setting of parameters.
bool vehicle_start(vehicle *self, char *error, size_t error_size);
// Continues by `size` [s], inputs held.
bool vehicle_step(vehicle *self, double size, char *error, size_t error_size);

// The state, in which all that follows has the same bits.
size_t vehicle_state_count(const vehicle *self);
void vehicle_save(const vehicle *self, double *state);
void vehicle_load(vehicle *self, const double *state);

#endif
