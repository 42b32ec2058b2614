#include "model/warnings/estimates.h"

#include <string.h>

#include "math/functions.h"
#include "model/fields/field.h"
#include "model/guide.h"
#include "model/model.h"
#include "model/motor_clock.h"
#include "model/parts.h"

static const double PI = 3.14159265358979323846;

static double if_positive(double value)
{
    return value > 0 ? value : NAN;
}

// ---- tube and bore

double estimate_bore(const plausible_entry *at)
{
    const ld_model *model = at->model;
    bool guides = model_has_launcher(model) && !model_has_surfaces(model);
    return guides ? model->tubes.section[0].bore_radius : NAN;
}

static double bore_diameter(const plausible_entry *at)
{
    return 2 * estimate_bore(at);
}

static double bore_area(const plausible_entry *at)
{
    double bore = estimate_bore(at);
    return PI * bore * bore;
}

// What the rocket leaves behind it [m3].
static double bore_volume(const plausible_entry *at)
{
    return bore_area(at) * (at->model->tubes.length - at->model->rocket.start_at);
}

// NaN of a beam that carries surfaces.
static double section_bore(const plausible_entry *at)
{
    const ld_model *model = at->model;
    return model_has_surfaces(model) ? NAN : model->tubes.section[at->i].bore_radius;
}

static double section_bore_area(const plausible_entry *at)
{
    double bore = section_bore(at);
    return PI * bore * bore;
}

double estimate_tube_mass(const plausible_entry *at)
{
    const ld_tubes *tubes = &at->model->tubes;
    double mass = tubes->tail.mass;
    for (int i = 0; i < tubes->section_count; i++) {
        const ld_section *s = &tubes->section[i];
        double end = i + 1 < tubes->section_count ? s[1].from : tubes->length;
        mass += s->mass_per_length * (end - s->from);
    }
    for (int i = 0; i < tubes->point_mass_count; i++)
        mass += tubes->point_mass[i].mass;
    return mass;
}

// Without the mass that the rule is about.
static double rest_of_tube(const plausible_entry *at)
{
    return estimate_tube_mass(at) - at->own;
}

static double tubes_of_layout(const plausible_entry *at)
{
    const ld_layout *layout = &at->model->tubes.layout;
    return layout->rows * layout->columns;
}

static double several_tubes(const plausible_entry *at)
{
    return tubes_of_layout(at) > 1;
}

static double surfaces(const plausible_entry *at)
{
    return model_has_surfaces(at->model);
}

// ---- what drives the rocket

static double peak_of(const ld_table *thrust)
{
    double peak = 0;
    for (size_t i = 0; i < thrust->rows; i++)
        peak = fmax(peak, thrust->data[2 * i + 1]);
    return peak;
}

// Of several motors the sum of what each has.
double estimate_peak_thrust(const plausible_entry *at)
{
    const ld_rocket *rocket = &at->model->rocket;
    double peak = peak_of(&rocket->motor.thrust) * rocket->motor.thrust_scale;
    for (int i = 0; i < rocket->further_motor_count; i++)
        peak += peak_of(&rocket->further_motor[i].thrust) * rocket->further_motor[i].thrust_scale;
    return peak;
}

double estimate_impulse(const plausible_entry *at)
{
    const ld_rocket *rocket = &at->model->rocket;
    const ld_motor *motor = &rocket->motor;
    double impulse = 0, others = 0;
    for (size_t i = 1; i < motor->thrust.rows; i++) {
        const double *a = &motor->thrust.data[2 * (i - 1)], *b = &motor->thrust.data[2 * i];
        double time = motor_clock(motor, b[0]) - motor_clock(motor, a[0]);
        impulse += time * (fmax(a[1], 0) + fmax(b[1], 0)) / 2;
    }
    for (int k = 0; k < rocket->further_motor_count; k++) {
        const ld_further_motor *one = &rocket->further_motor[k];
        for (size_t i = 1; i < one->thrust.rows; i++) {
            const double *a = &one->thrust.data[2 * (i - 1)], *b = &one->thrust.data[2 * i];
            others += one->thrust_scale * one->time_scale * (b[0] - a[0]) *
                      (fmax(a[1], 0) + fmax(b[1], 0)) / 2;
        }
    }
    return impulse * motor->thrust_scale + others;
}

static double last_time(const ld_table *thrust)
{
    return thrust->rows > 0 ? thrust->data[2 * (thrust->rows - 1)] : 0;
}

// End of the thrust [s], with its scale; 0 without.
static double burn_time(const plausible_entry *at)
{
    const ld_rocket *rocket = &at->model->rocket;
    const ld_table *thrust = &rocket->motor.thrust;
    double end = thrust->rows > 0 ? motor_clock(&rocket->motor, last_time(thrust)) : 0;
    for (int i = 0; i < rocket->further_motor_count; i++) {
        const ld_further_motor *one = &rocket->further_motor[i];
        end = fmax(end, further_motor_clock(one, last_time(&one->thrust)));
    }
    return end;
}

static double no_motor(const plausible_entry *at)
{
    return at->model->rocket.motor.absent;
}

static double a_motor(const plausible_entry *at)
{
    return !at->model->rocket.motor.absent;
}

// Greatest force of the pressure behind the rocket [N]; 0 without.
static double peak_pressure(const plausible_entry *at)
{
    const ld_pressure *given = &at->model->tubes.pressure;
    const ld_table *table =
        given->form == LD_PRESSURE_OVER_TIME ? &given->over_time : &given->over_travel;
    double bore = estimate_bore(at), peak = 0;
    if (!model_has_pressure(at->model))
        return 0;
    for (size_t i = 0; i < table->rows; i++)
        peak = fmax(peak, table->data[2 * i + 1]);
    if (given->form == LD_PRESSURE_OF_GAS)
        peak = given->pressure;
    return fmax(0, given->scale * peak - given->ambient) * PI * bore * bore;
}

// Of cold gas when the rocket leaves [Pa].
static double exit_pressure(const plausible_entry *at)
{
    const ld_pressure *gas = &at->model->tubes.pressure;
    double volume = gas->volume + bore_volume(at);
    return gas->scale * gas->pressure * pow(gas->volume / volume, gas->exponent);
}

static double a_pressure(const plausible_entry *at)
{
    return model_has_pressure(at->model);
}

static double no_pressure(const plausible_entry *at)
{
    return !model_has_pressure(at->model);
}

static double peak_drive(const plausible_entry *at)
{
    return estimate_peak_thrust(at) + peak_pressure(at);
}

double estimate_weight_along(const plausible_entry *at)
{
    const ld_model *model = at->model;
    const ld_table *command = &model->platform.elevation.stabiliser.command;
    double lowest = field_number(model, "base.elevation");
    for (size_t i = 0; i < command->rows && model_has_vehicle(model); i++)
        lowest = fmin(lowest, command->data[2 * i + 1]);
    return model->rocket.full.mass * model->gravity * sin(lowest);
}

static double weight_backwards(const plausible_entry *at)
{
    return if_positive(estimate_weight_along(at));
}

static double weight_forwards(const plausible_entry *at)
{
    return if_positive(-estimate_weight_along(at));
}

double estimate_time_in_tube(const plausible_entry *at)
{
    const ld_model *model = at->model;
    double weight = estimate_weight_along(at);
    double force = peak_drive(at) - (isnan(weight) ? 0 : weight);
    double way = guide_end(&model->tubes, model->rocket.adaptor) - model->rocket.start_at;
    return force > 0 && model_has_launcher(model) ? sqrt(2 * way * model->rocket.full.mass / force)
                                                  : NAN;
}

// ---- the rocket

double estimate_front(const plausible_entry *at)
{
    const ld_model *model = at->model;
    double front = NAN;
    for (int i = 0; i < model->rocket.adaptor_count && model_has_launcher(model); i++)
        front = fmax(front, model->rocket.adaptor[i].at);
    return front;
}

// Where it says how long the rocket is: in a bore. Buttons on a rail may be close together.
static double front_in_bore(const plausible_entry *at)
{
    return model_has_surfaces(at->model) ? NAN : estimate_front(at);
}

static double mass_lost(const plausible_entry *at)
{
    return if_positive(at->model->rocket.full.mass - at->model->rocket.empty.mass);
}

static double opening_time(const plausible_entry *at)
{
    const ld_parachute *one = &at->model->rocket.parachute[at->i];
    return one->time + one->lag;
}

// ---- the vehicle

// Least coordinate of the wheels along an axis, and from it to the greatest one [m].
static double wheels_begin(const plausible_entry *at, int axis)
{
    const ld_vehicle *vehicle = &at->model->base.vehicle;
    double least = INFINITY;
    for (int i = 0; i < vehicle->wheel_count; i++)
        least = fmin(least, vehicle->wheel[i].mount[axis]);
    return least;
}

static double wheels_span(const plausible_entry *at, int axis)
{
    const ld_vehicle *vehicle = &at->model->base.vehicle;
    double most = -INFINITY;
    for (int i = 0; i < vehicle->wheel_count; i++)
        most = fmax(most, vehicle->wheel[i].mount[axis]);
    return most - wheels_begin(at, axis);
}

// NaN where all wheels are on one axle.
static double wheelbase(const plausible_entry *at)
{
    return if_positive(wheels_span(at, 0));
}

// NaN where all wheels are in one track.
static double track(const plausible_entry *at)
{
    return if_positive(wheels_span(at, 2));
}

// From the chassis' mass centre.
static double rear_wheels(const plausible_entry *at)
{
    return -wheels_begin(at, 0);
}

static double left_wheels(const plausible_entry *at)
{
    return -wheels_begin(at, 2);
}

// Mass of tubes and rockets [kg].
static double tubes_mass(const plausible_entry *at)
{
    double count = tubes_of_layout(at), rockets = count - at->model->tubes.empty_count;
    return count * estimate_tube_mass(at) + rockets * at->model->rocket.full.mass;
}

static double carried_mass(const plausible_entry *at)
{
    const ld_platform *platform = &at->model->platform;
    const ld_tubes *tubes = &at->model->tubes;
    double count = tubes_of_layout(at);
    double platforms =
        platform->elevation.mass + (platform->has_azimuth ? platform->azimuth.mass : 0);
    return platforms + count * estimate_tube_mass(at) +
           (count - tubes->empty_count) * at->model->rocket.full.mass;
}

// What the suspensions carry [kg].
static double sprung_mass(const plausible_entry *at)
{
    return at->model->platform.chassis_mass + carried_mass(at);
}

static double heave_frequency(const plausible_entry *at)
{
    const ld_vehicle *vehicle = &at->model->base.vehicle;
    double stiffness = vehicle->wheel_count * vehicle->suspension.stiffness[1];
    return sqrt(stiffness / sprung_mass(at)) / (2 * PI);
}

static double heave_period(const plausible_entry *at)
{
    return 1 / heave_frequency(at);
}

// Of one suspension [N s/m].
static double critical_damping(const plausible_entry *at)
{
    const ld_vehicle *vehicle = &at->model->base.vehicle;
    double mass = sprung_mass(at) / vehicle->wheel_count;
    return 2 * sqrt(vehicle->suspension.stiffness[1] * mass);
}

static double static_travel(const plausible_entry *at)
{
    const ld_vehicle *vehicle = &at->model->base.vehicle;
    double load = sprung_mass(at) / vehicle->wheel_count * at->model->gravity;
    return load / vehicle->suspension.stiffness[1];
}

static double tyre_load(const plausible_entry *at)
{
    const ld_vehicle *vehicle = &at->model->base.vehicle;
    return (sprung_mass(at) / vehicle->wheel_count + vehicle->wheel[0].mass) * at->model->gravity;
}

static double wheel_stiffness(const plausible_entry *at)
{
    const ld_vehicle *vehicle = &at->model->base.vehicle;
    return vehicle->tyre.stiffness[1] + vehicle->suspension.stiffness[1];
}

static double shaking_road(const plausible_entry *at)
{
    const ld_vehicle *vehicle = &at->model->base.vehicle;
    return model_has_vehicle(at->model) && vehicle->speed > 0 && vehicle->road.form == LD_ROAD_SUM;
}

// 0 without jets.
static double scale_of_jets(const plausible_entry *at)
{
    return model_has_jet(at->model) ? at->model->platform.jet_scale : 0;
}

// ---- a hinge and its loop, be it a PID or a cascade, as the PID that it is the same as

static const ld_turret *turret_of(const plausible_entry *at)
{
    const ld_platform *platform = &at->model->platform;
    return at->i == 0 ? &platform->azimuth : &platform->elevation;
}

// With tubes and rockets, of rods of the tubes' length about their middles [kg m2].
static double hinge_inertia(const plausible_entry *at)
{
    const ld_tubes *tubes = &at->model->tubes;
    double arm = tubes->layout.first[0] + tubes->length / 2;
    double of_tubes = tubes_mass(at) * (tubes->length * tubes->length / 12 + arm * arm);
    return turret_of(at)->inertia[at->i == 0 ? 1 : 2] + of_tubes;
}

// 1; NaN where a lock holds the hinge.
static double free_hinge(const plausible_entry *at)
{
    return turret_of(at)->lock.present ? NAN : 1;
}

static double angle_gain(const plausible_entry *at)
{
    const ld_stabiliser *given = &turret_of(at)->stabiliser;
    const ld_cascade *two = &given->cascade;
    return free_hinge(at) * (two->present ? two->rate_kp * two->kp + two->rate_ki : given->kp);
}

static double rate_gain(const plausible_entry *at)
{
    const ld_stabiliser *given = &turret_of(at)->stabiliser;
    const ld_cascade *two = &given->cascade;
    return free_hinge(at) * (two->present ? two->rate_kp : given->kd);
}

// Time in which the rate gain takes the hinge's motion [s].
static double decay_time(const plausible_entry *at)
{
    return hinge_inertia(at) / if_positive(rate_gain(at));
}

static double rate_bandwidth(const plausible_entry *at)
{
    return 1 / decay_time(at);
}

static double loop_frequency(const plausible_entry *at)
{
    return angle_gain(at) / rate_gain(at) / (2 * PI);
}

static double error_at_limit(const plausible_entry *at)
{
    return turret_of(at)->stabiliser.torque_limit / angle_gain(at);
}

static double sampling_period(const plausible_entry *at)
{
    return free_hinge(at) * turret_of(at)->stabiliser.sample;
}

// With half a sampling period [s].
static double torque_delay(const plausible_entry *at)
{
    const ld_stabiliser *given = &turret_of(at)->stabiliser;
    return given->delay + given->sample / 2;
}

// ---- waves, air, flight

// Of the peak's period, on deep water [m].
static double wave_length(const plausible_entry *at)
{
    double period = at->model->base.sea.period;
    return at->model->gravity * period * period / (2 * PI);
}

// Whether air forces end where a table of the air ends.
static double air_of_table(const plausible_entry *at)
{
    ld_atmosphere_kind kind = at->model->environment.atmosphere.kind;
    return at->model->rocket.aerodynamics.present &&
           (kind == LD_ATMOSPHERE_US1976 || kind == LD_ATMOSPHERE_PROFILE);
}

static double free_flight(const plausible_entry *at)
{
    return at->model->run.end != LD_END_TIP;
}

static double powered_flight(const plausible_entry *at)
{
    return at->model->run.end != LD_END_TIP && !at->model->rocket.motor.absent;
}

// ---- by name

static const struct {
    const char *name;
    double (*of)(const plausible_entry *at);
} estimates[] = {
    {"the bore's radius", estimate_bore},
    {"the bore's diameter", bore_diameter},
    {"the area of the bore", bore_area},
    {"the volume of the bore before the rocket", bore_volume},
    {"the section's bore", section_bore},
    {"the area of the section's bore", section_bore_area},
    {"the whole mass of the tube", estimate_tube_mass},
    {"the mass of the rest of the tube", rest_of_tube},
    {"several tubes", several_tubes},
    {"surfaces to slide on", surfaces},
    {"the greatest thrust", estimate_peak_thrust},
    {"the impulse of the motor", estimate_impulse},
    {"the burn time of the motor", burn_time},
    {"no motor", no_motor},
    {"a motor", a_motor},
    {"the greatest force of the pressure", peak_pressure},
    {"the pressure of the gas at the exit", exit_pressure},
    {"a pressure", a_pressure},
    {"no pressure", no_pressure},
    {"the greatest force of pressure and thrust", peak_drive},
    {"the weight towards the rear", weight_backwards},
    {"the weight towards the tip", weight_forwards},
    {"the shortest time in the tube", estimate_time_in_tube},
    {"the position of the foremost adaptor", estimate_front},
    {"the position of the foremost adaptor in a bore", front_in_bore},
    {"the full mass minus the empty one", mass_lost},
    {"the time at which the parachute opens", opening_time},
    {"the wheelbase", wheelbase},
    {"the track width", track},
    {"the distance of the rear wheels", rear_wheels},
    {"the distance of the left wheels", left_wheels},
    {"the mass of platforms, tubes and rockets on it", carried_mass},
    {"the mass on the suspensions", sprung_mass},
    {"the heave frequency of the vehicle", heave_frequency},
    {"the period of the vehicle's heave", heave_period},
    {"the critical damping of the heave", critical_damping},
    {"the static travel", static_travel},
    {"the load of a tyre", tyre_load},
    {"the stiffness of suspension and tyre at a wheel", wheel_stiffness},
    {"a road that shakes", shaking_road},
    {"the scale of jets", scale_of_jets},
    {"the inertia that the hinge turns", hinge_inertia},
    {"a free hinge", free_hinge},
    {"the loop's angle gain", angle_gain},
    {"the loop's rate gain", rate_gain},
    {"the decay time by the rate gain", decay_time},
    {"rate_kp over the inertia that the hinge turns", rate_bandwidth},
    {"the loop's kp over kd", loop_frequency},
    {"the error at which the torque reaches its limit", error_at_limit},
    {"the sampling period of the loop", sampling_period},
    {"the delay of a torque", torque_delay},
    {"the wavelength", wave_length},
    {"air of a table", air_of_table},
    {"a free flight", free_flight},
    {"a powered flight", powered_flight},
};

double estimate_named(const char *name, const plausible_entry *at)
{
    for (size_t i = 0; i < sizeof estimates / sizeof *estimates; i++)
        if (strcmp(estimates[i].name, name) == 0)
            return estimates[i].of(at);
    return NAN;
}
