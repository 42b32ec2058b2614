// Plausibility of the rocket, its motor and its aerodynamics.
#include "math/functions.h"
#include "model/model.h"
#include "model/parts.h"
#include "model/warnings/estimates.h"
#include "model/warnings/plausible_rule.h"

#define PI 3.14159265358979323846

static plausible_pair off_axis(const plausible_entry *at)
{
    const ld_rocket *rocket = &at->model->rocket;
    double y = rocket->full.center[1] + rocket->eccentricity[0];
    double z = rocket->full.center[2] + rocket->eccentricity[1];
    return plausible_compare(hypot(y, z), estimate_bore(at));
}

// ---- motor

// The shortest time between two corners of the thrust, and the row of the second; a jump has none.
static plausible_pair thrust_corner(const plausible_entry *at)
{
    const ld_motor *motor = &at->model->rocket.motor;
    plausible_pair pair = plausible_nothing();
    for (size_t i = 1; i < motor->thrust.rows; i++) {
        double time = motor->thrust.data[2 * i] - motor->thrust.data[2 * (i - 1)];
        if (time > 0 && !(time * motor->time_scale >= pair.value)) {
            pair = plausible_alone(time * motor->time_scale);
            pair.row = (int)i + 1;
        }
    }
    return pair;
}

static plausible_pair thrust_at_end(const plausible_entry *at)
{
    const ld_motor *motor = &at->model->rocket.motor;
    size_t rows = motor->thrust.rows;
    double last = motor->thrust.data[2 * rows - 1] * motor->thrust_scale;
    plausible_pair pair = plausible_compare(last, estimate_peak_thrust(at));
    pair.row = (int)rows;
    return pair;
}

// The first row below 0.
static plausible_pair negative_thrust(const plausible_entry *at)
{
    const ld_table *thrust = &at->model->rocket.motor.thrust;
    for (size_t k = 0; k < thrust->rows; k++)
        if (thrust->data[2 * k + 1] < 0) {
            plausible_pair pair = plausible_alone(thrust->data[2 * k + 1]);
            pair.row = (int)k + 1;
            return pair;
        }
    return plausible_nothing();
}

// Of the jet's pressures over all radii at a distance, that which differs most from the thrust.
static plausible_pair force_of_pressures(const plausible_entry *at)
{
    const ld_table *table = &at->model->rocket.motor.plume.pressure;
    double thrust = estimate_peak_thrust(at), force = 0, worst = 0;
    plausible_pair pair = plausible_nothing();
    for (size_t k = 1; k < table->rows; k++) {
        const double *a = &table->data[3 * (k - 1)], *b = a + 3;
        if (a[0] != b[0]) {
            force = 0;
            continue;
        }
        // p r over the ring, p linear
        force += PI / 3 * (b[1] - a[1]) * (a[2] * (2 * a[1] + b[1]) + b[2] * (a[1] + 2 * b[1]));
        bool last = k + 1 == table->rows || b[3] != b[0];
        if (last && !(fabs(log(force / thrust)) <= worst)) {
            worst = fabs(log(force / thrust));
            pair = plausible_compare(force, thrust);
            pair.row = (int)k + 1;
        }
    }
    return pair;
}

// At which the empty rocket falls below it near sea level.
static plausible_pair speed_of_descent(const plausible_entry *at)
{
    const ld_rocket *rocket = &at->model->rocket;
    double area = rocket->parachute[at->i].drag_area;
    return plausible_alone(sqrt(2 * rocket->empty.mass * 9.81 / (1.2 * area)));
}

// The way on which it fills over its diameter D, by a drag coefficient of 0.75: A = 0.75 pi D^2/4.
static plausible_pair diameters_of_filling(const plausible_entry *at)
{
    const ld_parachute *one = &at->model->rocket.parachute[at->i];
    return plausible_alone(one->filling_distance / sqrt(one->drag_area / (0.75 * acos(-1) / 4)));
}

// Angular frequency of the canopy on its lines, the rocket held.
static plausible_pair swiftness_of_lines(const plausible_entry *at)
{
    const ld_canopy *one = &at->model->rocket.parachute[at->i].canopy;
    if (!one->present)
        return plausible_nothing();
    return plausible_alone(sqrt(one->line_stiffness / one->line_length / one->mass));
}

// ---- aerodynamics

enum { CA_POWER_OFF = 1, CN_ALPHA = 3, X_CP = 4 }; // columns

// Static margin in calibres: the mass centre before the centre of pressure at Mach 0.
static plausible_pair static_margin(const plausible_entry *at)
{
    const ld_rocket *rocket = &at->model->rocket;
    const ld_aerodynamics *air = &rocket->aerodynamics;
    double x_cp = air->table.data[X_CP] + air->x_cp_shift;
    return plausible_alone((rocket->full.center[0] - x_cp) / air->reference_diameter);
}

// Last Mach number of the table beside the one that the rocket would reach in vacuum.
static plausible_pair last_mach(const plausible_entry *at)
{
    const ld_rocket *rocket = &at->model->rocket;
    const ld_aerodynamics *air = &rocket->aerodynamics;
    const double sound = 340;
    double mean = rocket->full.mass - rocket->propellant / 2;
    double gain = rocket->motor.absent ? 0 : estimate_impulse(at) / mean;
    bool ends = air->beyond_table == LD_BEYOND_ERROR && model_has_launcher(at->model);
    const ld_table *table = &air->table;
    double last = table->data[(table->rows - 1) * table->columns];
    return plausible_compare(last, ends ? gain / sound : NAN);
}

static plausible_pair leaving(const plausible_entry *at)
{
    const ld_rocket *rocket = &at->model->rocket;
    return plausible_compare(at->own, rocket->start_at + rocket->adaptor[at->i].at);
}

#define BORE .other = "the bore's radius"
#define FRONT .other = "the position of the foremost adaptor"

const plausible_rule plausible_of_rocket[] = {
    {"rocket.start_at", .unit = "m", .other = "tubes.length", NO_LOW, .high = 0.9,
     .why = "the rocket starts at the rear of its tube"},
    {"rocket.mass_error", .unit = "kg", .other = "rocket.mass", .low = -0.2, .high = 0.2,
     .why = "an error of the mass is a small part of it"},
    {"rocket.propellant", .unit = "kg", .other = "rocket.mass", NO_LOW, .high = 0.95,
     .why = "little is left of the rocket"},
    {"rocket.propellant", .unit = "kg", .other = "the full mass minus the empty one", .low = 0.5,
     .high = 2, .why = "both are what is burnt"},
    {"rocket.center.x", .unit = "m", FRONT, .low = -0.5, .high = 1.5, .of = "rocket.adaptors",
     .why = "the mass centre lies between the adaptors, or near them"},
    {"rocket.empty.center.x", .unit = "m", FRONT, .low = -0.5, .high = 1.5, .of = "rocket.adaptors",
     .why = "the mass centre lies between the adaptors, or near them"},
    {"rocket.eccentricity", "the mass centre's distance from the axis", .unit = "m", BORE, NO_LOW,
     .high = 0.1, .find = off_axis, .why = "rockets are balanced to about a millimetre"},
    {"rocket.dynamic_imbalance", "the angle of the inertia's axis", .unit = "rad", NO_LOW,
     .high = PI / 180, .form = PLAUSIBLE_NORM, .why = "rockets are balanced to a few mrad"},
    {"rocket.inertia.x", "the radius of gyration about x", .unit = "m", BORE, .low = 0.1, .high = 1,
     .form = PLAUSIBLE_GYRATION, .b = "rocket.mass", .why = "the rocket passes through the bore"},
    {"rocket.empty.inertia.x", "the radius of gyration about x", .unit = "m", BORE, .low = 0.1,
     .high = 1, .form = PLAUSIBLE_GYRATION, .b = "rocket.empty.mass",
     .why = "the rocket passes through the bore"},
    {"rocket.inertia.z", "the radius of gyration about z", .unit = "m", FRONT, .low = 0.05,
     .high = 2, .form = PLAUSIBLE_GYRATION, .b = "rocket.mass",
     .with = "the position of the foremost adaptor in a bore", .of = "rocket.adaptors",
     .why = "the rocket is about as long as the distance of its adaptors"},
    {"rocket.empty.inertia.z", "the radius of gyration about z", .unit = "m", FRONT, .low = 0.05,
     .high = 2, .form = PLAUSIBLE_GYRATION, .b = "rocket.empty.mass",
     .with = "the position of the foremost adaptor in a bore", .of = "rocket.adaptors",
     .why = "the rocket is about as long as the distance of its adaptors"},
    {"rocket.adaptors", "the position of the foremost adaptor", .unit = "m", BORE, .low = 1,
     NO_HIGH, .a = "the position of the foremost adaptor",
     .why = "adaptors so close give little guidance"},
    {"rocket.adaptors.#.at", .unit = "m", .other = "tubes.length", NO_LOW, .high = 1,
     .why = "this adaptor is never in the tube"},
    {"rocket.adaptors.#.clearance", .unit = "m", BORE, NO_LOW, .high = 0.1,
     .why = "a clearance is a small part of the bore"},
    {"rocket.adaptors.#.leaves_at", .unit = "m", .other = "its station at the start", .low = 1,
     NO_HIGH, .find = leaving, .of = "rocket.start_at",
     .why = "this adaptor is never in the guide"},
    {"rocket.adaptors.#.leaves_at", .unit = "m", .other = "tubes.length", .low = 0.3, NO_HIGH,
     .why = "most of the guide is beyond its end"},
    {"rocket.adaptors.#.falls_off.mass", .unit = "kg", .other = "rocket.mass", NO_LOW, .high = 0.1,
     .why = "an adaptor is a small part of the rocket"},
    {"rocket.contact.stiffness", "the frequency of the rocket on it", .unit = "Hz", .low = 2,
     .high = 5000, .form = PLAUSIBLE_FREQUENCY, .b = "rocket.mass",
     .why = "metal on metal is stiff, but a touch lasts longer than 0.1 ms"},
    {"rocket.contact.damping", "the decay time of the rocket's motion", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .form = PLAUSIBLE_DECAY, .b = "rocket.mass",
     .of = "rocket.mass", .why = "the integrator needs many short steps to follow it"},
    {"rocket.contact.reference_penetration", .unit = "m", .low = 1e-6, .high = 0.02,
     .why = "penetrations are fractions of a millimetre"},
    {"rocket.contact.reference_speed", .unit = "m/s", .low = 1e-3, .high = 50,
     .why = "adaptors touch the tube at some 0.1 m/s"},
    {"rocket.contact.friction", .unit = "", NO_LOW, .high = 1.5,
     .why = "dry metal on metal has below 1"},
    {"rocket.contact.friction_speed", .unit = "m/s", .low = 1e-6, .high = 1,
     .why = "it only smooths friction near zero speed"},
    {"rocket.contact.drag", "its greatest force", .unit = "N", .other = "the greatest thrust",
     NO_LOW, .high = 1, .form = PLAUSIBLE_GREATEST, .column = 1, .b = "rocket.contact.drag_scale",
     .when = "no pressure", .why = "the rocket never leaves"},
    {"rocket.contact.drag_scale", .unit = "", .low = 0.1, .high = 10,
     .why = "it is a correction of the drag"},
    {"rocket.lock.release_force", .unit = "N", .other = "the greatest thrust", NO_LOW, .high = 1,
     .when = "no pressure", .why = "the lock never releases"},
    {"rocket.lock.release_force", .unit = "N", .other = "the greatest force of pressure and thrust",
     NO_LOW, .high = 1, .when = "a pressure", .why = "the lock never releases"},
    {"rocket.lock.release_force", .unit = "N", .other = "the weight towards the tip", .low = 1,
     NO_HIGH, .why = "the lock releases before the ignition"},
    {"rocket.lock.hold_down", .unit = "s", .other = "the burn time of the motor", NO_LOW,
     .high = 0.5, .when = "no pressure",
     .why = "propellant burnt before the release drives nothing"},
    {"rocket.lock.at.x", .unit = "m", FRONT, .low = -1, .high = 1.5, .of = "rocket.adaptors",
     .why = "the lock holds the rocket's body"},
    {"rocket.lock.at.radius", .unit = "m", BORE, NO_LOW, .high = 1.1,
     .why = "the lock holds the rocket's body"},
    {"rocket.motor.thrust.#", "the thrust", .unit = "N", .low = 0, NO_HIGH, .find = negative_thrust,
     .why = "a motor does not pull; thrust below 0 counts as 0 N"},
    {"rocket.motor.thrust.#", "the thrust at its end", .unit = "N", .other = "the greatest thrust",
     NO_LOW, .high = 0.1, .find = thrust_at_end,
     .why = "a motor burns out, and the curve ends near 0 N"},
    {"rocket.motor.thrust.#", "the time since the row before", .unit = "s", .low = 1e-6, NO_HIGH,
     .find = thrust_corner, .why = "for a jump give the same time twice"},
    {"rocket.motor.thrust", "the greatest thrust", .unit = "N",
     .other = "the weight towards the rear", .low = 1, NO_HIGH,
     .a = "the greatest force of pressure and thrust", .why = "the rocket never leaves"},
    {"rocket.motor.thrust", "the greatest thrust over the mass", .unit = "m/s2", NO_LOW,
     .high = 5e4, .form = PLAUSIBLE_RATIO, .a = "the greatest thrust", .b = "rocket.mass",
     .why = "that is 5000 times gravity"},
    {"rocket.motor.thrust", "impulse over propellant (the exhaust speed)", .unit = "m/s",
     .low = 500, .high = 6000, .form = PLAUSIBLE_RATIO, .a = "the impulse of the motor",
     .b = "rocket.propellant", .when = "rocket.propellant", .of = "rocket.propellant",
     .why = "solid propellants have 1800 m/s to 2800 m/s"},
    {"rocket.motor.at.x", .unit = "m", FRONT, .low = -1, .high = 1,
     .with = "the position of the foremost adaptor in a bore", .of = "rocket.adaptors",
     .why = "thrust acts at the nozzle"},
    {"rocket.motor.at", "the distance from the axis", .unit = "m", BORE, NO_LOW, .high = 0.5,
     .form = PLAUSIBLE_DISTANCE, .a = "rocket.motor.at.y", .b = "rocket.motor.at.z",
     .why = "thrust acts at the nozzle"},
    {"rocket.motor.misalignment.y", .unit = "rad", .low = -0.05, .high = 0.05,
     .why = "motors are aligned to a few mrad"},
    {"rocket.motor.misalignment.z", .unit = "rad", .low = -0.05, .high = 0.05,
     .why = "motors are aligned to a few mrad"},
    {"rocket.motor.thrust_scale", .unit = "", .low = 0.1, .high = 10,
     .why = "it is a correction of the curve"},
    {"rocket.motor.time_scale", .unit = "", .low = 0.1, .high = 10,
     .why = "it is a correction of the curve"},
    {"rocket.motor.rise_scale", .unit = "", .low = 0.1, .high = 10,
     .why = "it is a correction of the curve"},
    {"rocket.motor.delay", .unit = "s", NO_LOW, .high = 5,
     .why = "igniters take milliseconds to a second"},
    {"rocket.motor.plume.pressure.#", "the force of this distance's pressures", .unit = "N",
     .other = "the greatest thrust", .low = 0.5, .high = 1.5, .find = force_of_pressures,
     .why = "a jet keeps the momentum of the thrust"},
    {"rocket.motor.side_force.fluctuation.deviation", "its greatest force", .unit = "N",
     .other = "the greatest thrust", NO_LOW, .high = 0.2, .form = PLAUSIBLE_GREATEST, .column = 1,
     .b = "rocket.motor.side_force.scale", .why = "side forces are a few percent of the thrust"},
    {"rocket.parachutes.#.drag_area", "the descent speed under it", .unit = "m/s", .low = 0.5,
     .high = 100, .find = speed_of_descent,
     .why = "rockets come down at 15 to 40 m/s under a drogue, at 4 to 10 m/s under a main"},
    {"rocket.parachutes.#.time", "the time of its opening", .unit = "s",
     .other = "the burn time of the motor", .low = 1, NO_HIGH,
     .a = "the time at which the parachute opens", .when = "a motor",
     .why = "under a parachute the thrust is ignored"},
    {"rocket.parachutes.#.filling", .unit = "s", NO_LOW, .high = 20,
     .why = "parachutes fill in some tenths of a second to a few seconds"},
    {"rocket.parachutes.#.filling_distance", "the number of the canopy's diameters", .unit = "",
     .low = 1, .high = 40, .find = diameters_of_filling,
     .why = "parachutes fill on 4 to 14 of their diameters"},
    {"rocket.parachutes.#.canopy.mass", .unit = "kg", .other = "rocket.mass", NO_LOW, .high = 0.3,
     .why = "canopies have some hundredths of the rocket's mass"},
    {"rocket.parachutes.#.canopy.line_stiffness", "the frequency of the canopy on its lines",
     .unit = "rad/s", .low = 3, .high = 2000, .find = swiftness_of_lines,
     .why = "lines of textile stretch by some percent; stiffer ones take short steps"},
    {"rocket.line.mass_per_length", "the mass of the whole line", .unit = "kg",
     .other = "rocket.mass", NO_LOW, .high = 2, .form = PLAUSIBLE_PRODUCT,
     .a = "rocket.line.mass_per_length", .b = "rocket.line.length",
     .why = "a rocket carries a line lighter than itself"},
    {"rocket.line.stiffness", "the speed of waves along it", .unit = "m/s", .low = 100,
     .high = 12000, .form = PLAUSIBLE_GYRATION, .a = "rocket.line.stiffness",
     .b = "rocket.line.mass_per_length", .why = "that of textile lines is 500 to 4000 m/s"},
    {"rocket.aerodynamics.reference_diameter", .unit = "m", .other = "the bore's diameter",
     .low = 0.2, .high = 1.05, .why = "the rocket passes through the bore"},
    {"rocket.aerodynamics.area", .unit = "m2", .other = "the area of the bore", .low = 0.04,
     .high = 2, .when = "rocket.aerodynamics.area", .why = "the rocket passes through the bore"},
    {"rocket.aerodynamics.emerged.nose", .unit = "m", FRONT, NO_LOW, .high = 3,
     .of = "rocket.adaptors", .why = "the nose is not far before the foremost adaptor"},
    {"rocket.aerodynamics.emerged.drag", .unit = "", .low = 0.1, .high = 3,
     .why = "that of a cylinder across the wind is 1.2"},
    {"rocket.aerodynamics.emerged.diameter", .unit = "m", .other = "the bore's diameter",
     .low = 0.2, .high = 1.05, .why = "the rocket passes through the bore"},
    {"rocket.aerodynamics.fin_cant", .unit = "rad", .low = -20 * PI / 180, .high = 20 * PI / 180,
     .why = "fins are canted by a degree or so"},
    {"rocket.aerodynamics.table", "the greatest ca_power_off", .unit = "", NO_LOW, .high = 5,
     .form = PLAUSIBLE_GREATEST, .column = CA_POWER_OFF, .b = "rocket.aerodynamics.ca_scale",
     .why = "that of rockets is 0.2 to 1"},
    {"rocket.aerodynamics.table", "the greatest cn_alpha", .unit = "", .low = 0.5, .high = 100,
     .form = PLAUSIBLE_GREATEST, .column = CN_ALPHA,
     .why = "that of rockets is 2 to 20 per radian; per degree it would be 57 times less"},
    {"rocket.aerodynamics.table", "the static margin in calibres", .unit = "", .low = -20,
     .high = 20, .find = static_margin, .why = "x_cp counts forward from the rear adaptor"},
    {"rocket.aerodynamics.table", "the last Mach number", .unit = "",
     .other = "the Mach number that the motor gives without drag", .low = 0.5, NO_HIGH,
     .find = last_mach, .why = "the flight ends with an error where the table ends"},
    {0}};
