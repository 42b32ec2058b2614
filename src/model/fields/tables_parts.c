// Tables of parts that several blocks have: sections and their material, stabilisers of angles and
// of lengths.
#include "model/fields/tables_parts.h"

#include "model/fields/field_rows.h"

#define PI 3.14159265358979323846

// ---- sections of a tube or beam

static const field_row material_fields[] = {
    {"youngs_modulus", NUMBER(ld_material, youngs_modulus, "Pa"), FROM_TO(1e3, 1e15),
     NO_DEFAULT("required without section stiffnesses"), .doc = "E"},
    {"poisson_ratio", NUMBER(ld_material, poisson_ratio, ""), INSIDE(-1, 0.5),
     NO_DEFAULT("this or shear_modulus"), .doc = "nu, for G = E/(2 (1 + nu))"},
    {"shear_modulus", NUMBER(ld_material, shear_modulus, "Pa"), FROM_TO(1e3, 1e15),
     NO_DEFAULT("this or poisson_ratio"), .doc = "G"},
    {"density", NUMBER(ld_material, density, "kg/m3"), FROM_TO(1e-3, 1e6),
     NO_DEFAULT("required by sections given by radii"), .doc = "density"},
    {0}};
const field_block material_block = {.fields = material_fields};

static const field_word section_forms[] = {
    {"a section given by radii", LD_SECTION_ANNULUS},
    {"a section given by its area", LD_SECTION_AREA},
    {"a section given by stiffnesses", LD_SECTION_STIFFNESS},
    {"a section given by stiffnesses of each plane", LD_SECTION_PLANES},
    {NULL, 0}};
#define STIFFNESS FORM(LD_SECTION_STIFFNESS)
#define PLANES FORM(LD_SECTION_PLANES)
#define ANNULUS FORM(LD_SECTION_ANNULUS)
#define AREA FORM(LD_SECTION_AREA)
static const field_row section_fields[] = {
    {"from", NUMBER(ld_section, from, "m"), FROM_TO(0, 100), REQUIRED,
     .doc = "station at which it begins; up to the next section or the end"},
    {"inner_radius", NUMBER(ld_section, bore_radius, "m"), ABOVE_TO(0, 10), REQUIRED,
     .forms = ANNULUS, .doc = "radius of the bore"},
    {"outer_radius", NUMBER(ld_section, outer_radius, "m"), ABOVE_TO(0, 10), REQUIRED,
     .forms = ANNULUS, .doc = "outer radius"},
    {"bore_radius", NUMBER(ld_section, bore_radius, "m"), ABOVE_TO(0, 10),
     NO_DEFAULT("required by a bore"), .forms = AREA | STIFFNESS | PLANES,
     .doc = "radius of the bore"},
    {"mass_per_length", NUMBER(ld_section, mass_per_length, "kg/m"), POSITIVE, REQUIRED,
     .forms = AREA | STIFFNESS | PLANES, .doc = "mass per length"},
    {"area", NUMBER(ld_section, area, "m2"), POSITIVE, REQUIRED, .forms = AREA,
     .doc = "area A of the wall"},
    {"second_moment", NUMBER(ld_section, second_moment, "m4"), POSITIVE, REQUIRED, .forms = AREA,
     .doc = "second moment of area I, the same in both planes"},
    {"torsion_constant", NUMBER(ld_section, torsion_constant, "m4"), POSITIVE, REQUIRED,
     .forms = AREA, .doc = "Saint-Venant torsion constant"},
    {"axial_stiffness", NUMBER(ld_section, axial_stiffness, "N"), POSITIVE, REQUIRED,
     .forms = STIFFNESS | PLANES, .doc = "E A"},
    {"bending_stiffness", NUMBER(ld_section, bending_stiffness, "N.m2"), POSITIVE, REQUIRED,
     .forms = STIFFNESS, .doc = "E I, the same in both planes"},
    {"bending_stiffness_y", NUMBER(ld_section, bending_stiffness_y, "N.m2"), POSITIVE, REQUIRED,
     .forms = PLANES, .doc = "E I about y, against deflection along z"},
    {"bending_stiffness_z", NUMBER(ld_section, bending_stiffness_z, "N.m2"), POSITIVE, REQUIRED,
     .forms = PLANES, .doc = "E I about z, against deflection along y"},
    {"torsion_stiffness", NUMBER(ld_section, torsion_stiffness, "N.m2"), POSITIVE, REQUIRED,
     .forms = STIFFNESS | PLANES, .doc = "G times the torsion constant"},
    {"polar_inertia", NUMBER(ld_section, polar_inertia, "kg.m"), POSITIVE, REQUIRED,
     .forms = AREA | STIFFNESS | PLANES, .doc = "polar moment of inertia per length"},
    {0}};
const field_block section_block = {.fields = section_fields,
                                   .form = section_forms,
                                   .form_offset = offsetof(ld_section, form),
                                   .form_from_keys = true};

// ---- stabilisers

static const field_row command_columns[] = {
    {"t", .unit = "s", ANY},
    {"angle", .unit = "rad", FROM_TO(-200 * PI, 200 * PI)},
};
static const table_format command_table = {TABLE_CONSTANT | TABLE_CSV, 2, command_columns, NULL};
#define UNLESS_LOCKED NO_DEFAULT("required without lock")
static const field_row cascade_fields[] = {
    {"kp", NUMBER(ld_cascade, kp, "1/s"), POSITIVE, REQUIRED,
     .doc = "gain of the angle loop: commanded rate over error"},
    {"rate_kp", NUMBER(ld_cascade, rate_kp, "N.m.s/rad"), POSITIVE, REQUIRED,
     .doc = "gain of the rate loop"},
    {"rate_ki", NUMBER(ld_cascade, rate_ki, "N.m/rad"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "gain on the integral of the rate error, limited to the torque limit"},
    {0}};
static const field_block cascade_block = {.fields = cascade_fields};
static const field_word cascade_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};

static const field_row noise_fields[] = {
    {"angle", NUMBER(ld_sensor_noise, angle, "rad"), FROM_TO(0, 1), DEFAULT(0),
     .doc = "rms of the measured angle"},
    {"rate", NUMBER(ld_sensor_noise, rate, "rad/s"), FROM_TO(0, 100), DEFAULT(0),
     .doc = "rms of the measured rate"},
    {"seed", INTEGER(ld_sensor_noise, seed, 0, 999999999), DEFAULT(1), .doc = "of the noise"},
    {0}};
static const field_block noise_block = {.fields = noise_fields};
static const field_row resolution_fields[] = {
    {"angle", NUMBER(ld_resolution, angle, "rad"), FROM_TO(0, 1), DEFAULT(0),
     .doc = "step of the measured angle; 0: none"},
    {"rate", NUMBER(ld_resolution, rate, "rad/s"), FROM_TO(0, 100), DEFAULT(0),
     .doc = "step of the measured rate; 0: none"},
    {0}};
static const field_block resolution_block = {.fields = resolution_fields};

static const field_row gear_fields[] = {
    {"stiffness", NUMBER(ld_gear, stiffness, "N.m/rad"), POSITIVE, REQUIRED,
     .doc = "of the drive, seen from the hinge"},
    {"damping", NUMBER(ld_gear, damping, "N.m.s/rad"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "parallel to that stiffness"},
    {"inertia", NUMBER(ld_gear, inertia, "kg.m2"), POSITIVE, REQUIRED,
     .doc = "of the motor, times the square of the gear ratio"},
    {"backlash", NUMBER(ld_gear, backlash, "rad"), FROM_TO(0, 1), DEFAULT(0),
     .doc = "free travel between the flanks"},
    {0}};
static const field_block gear_block = {.fields = gear_fields};
static const field_word gear_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};

#define UNLESS_CASCADE NO_DEFAULT("required without lock and cascade")
static const field_row stabiliser_fields[] = {
    {"command", TABLE(ld_stabiliser, command, command_table), .required = true,
     .doc = "yaw (azimuth) or pitch (elevation) of the elevation platform's x axis in I, constant "
            "or over time (linear, constant outside)"},
    {"kp", NUMBER(ld_stabiliser, kp, "N.m/rad"), NOT_NEGATIVE, UNLESS_CASCADE,
     .doc = "gain on the error"},
    {"ki", NUMBER(ld_stabiliser, ki, "N.m/rad/s"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "gain on its integral, limited to the torque limit"},
    {"kd", NUMBER(ld_stabiliser, kd, "N.m.s/rad"), NOT_NEGATIVE, UNLESS_CASCADE,
     .doc = "gain on its rate"},
    {"torque_limit", NUMBER(ld_stabiliser, torque_limit, "N.m"), POSITIVE, UNLESS_LOCKED,
     .doc = "greatest torque"},
    {"feedforward", NUMBER(ld_stabiliser, feedforward, ""), FROM_TO(0, 1), DEFAULT(0),
     .doc = "share of the chassis' rate about the hinge that the command compensates"},
    {"cascade", BLOCK(ld_stabiliser, cascade, cascade_block), .initial_doc = "none",
     SWITCH(ld_stabiliser, cascade.present, cascade_words), .other_is_bool = true,
     .doc = "two loops in place of kp, ki, kd: the angle loop commands a rate to the rate loop"},
    {"bandwidth", NUMBER(ld_stabiliser, bandwidth, "Hz"), FROM_TO(0, 10000), DEFAULT(0),
     .doc = "of the actuator, a first-order lag of the torque; 0: no lag"},
    {"slew", NUMBER(ld_stabiliser, slew, "N.m/s"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "greatest rate of the torque, requires bandwidth; 0: no limit"},
    {"sample", NUMBER(ld_stabiliser, sample, "s"), FROM_TO(0, 10), DEFAULT(0),
     .doc = "period of a digital loop that holds its torque; 0: continuous"},
    {"delay", NUMBER(ld_stabiliser, delay, "s"), FROM_TO(0, 10), DEFAULT(0),
     .doc = "from a sample to its torque, at most the period"},
    {"sensor_noise", BLOCK(ld_stabiliser, noise, noise_block), .initial_doc = "none",
     .doc = "white noise of the sensors, one value a sample"},
    {"sensor_resolution", BLOCK(ld_stabiliser, resolution, resolution_block), .initial_doc = "none",
     .doc = "rounding of the sensors"},
    {"gear", BLOCK(ld_stabiliser, gear, gear_block), .initial_doc = "none",
     SWITCH(ld_stabiliser, gear.present, gear_words), .other_is_bool = true,
     .doc = "between actuator and hinge"},
    {0}};
const field_block stabiliser_block = {.fields = stabiliser_fields};

// The same for a length.
static const field_row length_command_columns[] = {
    {"t", .unit = "s", ANY},
    {"length", .unit = "m", FROM_TO(-1000, 1000)},
};
static const table_format length_command_table = {TABLE_CONSTANT | TABLE_CSV, 2,
                                                  length_command_columns, NULL};
static const field_row positioner_fields[] = {
    {"command", TABLE(ld_stabiliser, command, length_command_table), .required = true,
     .doc = "length or displacement, constant or over time (linear between rows, constant "
            "outside)"},
    {"kp", NUMBER(ld_stabiliser, kp, "N/m"), NOT_NEGATIVE, REQUIRED, .doc = "gain on the error"},
    {"ki", NUMBER(ld_stabiliser, ki, "N/m/s"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "gain on its integral, which stays within the force limit"},
    {"kd", NUMBER(ld_stabiliser, kd, "N.s/m"), NOT_NEGATIVE, DEFAULT(0), .doc = "gain on its rate"},
    {"force_limit", NUMBER(ld_stabiliser, torque_limit, "N"), POSITIVE, REQUIRED,
     .doc = "greatest force"},
    {"bandwidth", NUMBER(ld_stabiliser, bandwidth, "Hz"), FROM_TO(0, 10000), DEFAULT(0),
     .doc = "of the actuator, whose force follows as a first-order lag; 0: at once"},
    {"slew", NUMBER(ld_stabiliser, slew, "N/s"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "greatest rate of the actuator's force, which needs its bandwidth; 0: any"},
    {"sample", NUMBER(ld_stabiliser, sample, "s"), FROM_TO(0, 10), DEFAULT(0),
     .doc = "period of a digital loop, whose force is held in between; 0: continuous"},
    {"delay", NUMBER(ld_stabiliser, delay, "s"), FROM_TO(0, 10), DEFAULT(0),
     .doc = "from a sample until its force is given out, at most the period"},
    {0}};
const field_block positioner_block = {.fields = positioner_fields};
