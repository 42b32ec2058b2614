#include "support/reference_model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/model.h"

static const double degree = 3.14159265358979323846 / 180;

ld_table reference_table(size_t rows, size_t columns, const double *data)
{
    ld_table table = {rows, columns, malloc(rows * columns * sizeof *data)};
    memcpy(table.data, data, rows * columns * sizeof *data);
    return table;
}

static void set3(double out[3], double x, double y, double z)
{
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

static void fill_tubes(ld_tubes *tubes)
{
    // layout and steel tube
    tubes->layout = (ld_layout){.rows = 3, .columns = 6, .pitch = 0.24, .first = {-0.4, 0.1, -0.6}};
    tubes->length = 3.0;
    const double pi = 180 * degree, inner = 0.0825, outer = 0.085, E = 210e9, nu = 0.3, rho = 7850;
    double area = pi * (outer * outer - inner * inner);
    double second_moment = pi / 4 * (pow(outer, 4) - pow(inner, 4));
    tubes->section_count = 1;
    tubes->section[0] = (ld_section){.from = 0,
                                     .bore_radius = inner,
                                     .mass_per_length = rho * area,
                                     .axial_stiffness = E * area,
                                     .bending_stiffness = E * second_moment,
                                     .torsion_stiffness = E / (2 * (1 + nu)) * 2 * second_moment,
                                     .polar_inertia = rho * 2 * second_moment};
    tubes->modes = (ld_modes){.bending = 6,
                              .torsion = 2,
                              .axial = 0,
                              .elements = 40,
                              .span = LD_SPAN_SUPPORTED,
                              .damping = 0.01};
    tubes->tail = (ld_tail){.mass = 8, .center = -0.1, .inertia = {0.05, 0.06, 0.06}};
    // two supports
    tubes->support_count = 2;
    for (int k = 0; k < 2; k++) {
        ld_support *support = &tubes->support[k];
        support->at = k == 0 ? 0.4 : 1.8;
        set3(support->stiffness, 2e7, 2e7, 2e7);
        set3(support->damping, 2e4, 2e4, 2e4);
        set3(support->rotational_stiffness, 2e5, 2e5, 2e5);
        set3(support->rotational_damping, 2e2, 2e2, 2e2);
        support->recoil = (ld_recoil){.friction_speed = 0.01, .stroke = NAN};
    }
    tubes->pressure.scale = 1;
    tubes->slot.kind = LD_SLOT_HELIX;
    tubes->slot.angle = reference_table(1, 2, (double[]){0, 4 * degree});
    tubes->slot.radius = 0.0825;
    tubes->slot.friction = 0.1;
}

static void fill_rocket(ld_rocket *rocket)
{
    rocket->start_at = 0.1;
    rocket->full = (ld_mass_data){60, {1.1, 0, 0}, {0.22, 24, 24}};
    rocket->empty = (ld_mass_data){40, {1.2, 0, 0}, {0.16, 18, 18}};
    rocket->propellant = 20;
    // adaptors and contact
    static const double at[] = {0, 1.2, 1.9}, clearance[] = {0.3e-3, 0.5e-3, 0.4e-3};
    static const char *const name[] = {"rear", "middle", "front"};
    rocket->adaptor_count = 3;
    for (int i = 0; i < 3; i++) {
        snprintf(rocket->adaptor[i].name, LD_MAX_NAME, "%s", name[i]);
        rocket->adaptor[i].at = at[i];
        rocket->adaptor[i].clearance = clearance[i];
    }
    for (int i = 0; i < LD_MAX_ADAPTORS; i++)
        rocket->adaptor[i].leaves_at = NAN;
    rocket->contact = (ld_contact){.law = LD_CONTACT_HUNT_CROSSLEY,
                                   .stiffness = 5e7,
                                   .exponent = 1,
                                   .reference_penetration = 1e-3,
                                   .restitution = 0.5,
                                   .reference_speed = 0.5,
                                   .friction = 0.12,
                                   .friction_speed = 0.01,
                                   .drag_scale = 1};
    // lock and motor
    rocket->lock = (ld_lock){.present = true, .release_force = 5e3};
    rocket->motor.thrust = reference_table(4, 2, (double[]){0, 0, 0.01, 15e3, 2.5, 15e3, 2.55, 0});
    rocket->motor.thrust_scale = 1;
    rocket->motor.rise_scale = 1;
    rocket->motor.time_scale = 1;
}

void reference_model(ld_model *model)
{
    model_init(model);
    static const char title[] = "Reference launcher, fixed base";
    model->title = malloc(sizeof title);
    memcpy(model->title, title, sizeof title);
    model->gravity = 9.80665;
    model->environment.ground_height = 0;
    model->base.kind = LD_BASE_FIXED;
    model->base.elevation = 19.8 * degree;
    fill_tubes(&model->tubes);
    fill_rocket(&model->rocket);
    model->firing_count = 1;
    model->firing[0] = (ld_firing){.tube = 8, .at = 0};
    model->run = (ld_run_settings){.start = LD_START_EQUILIBRIUM,
                                   .formulation = LD_FORMULATION_REDUCED,
                                   .lead_in = 0,
                                   .end = LD_END_TIP,
                                   .tolerance = 1e-5,
                                   .max_step = 2e-4,
                                   .output_step_lead_in = 5e-3,
                                   .output_step_tube = 1e-4,
                                   .output_step_flight = 2e-2,
                                   .flight_limit = 600,
                                   .flight_tolerance = 1e-7,
                                   .stuck_time = 2};
}

static void fill_wheels(ld_vehicle *vehicle)
{
    static const char *const name[] = {"front-left",   "front-right", "middle-left",
                                       "middle-right", "rear-left",   "rear-right"};
    static const double x[] = {2.7, -1.1, -2.5};
    vehicle->wheel_count = 6;
    for (int i = 0; i < 6; i++) {
        ld_wheel *wheel = &vehicle->wheel[i];
        snprintf(wheel->name, LD_MAX_NAME, "%s", name[i]);
        set3(wheel->mount, x[i / 2], -0.7, i % 2 ? 1.05 : -1.05);
        wheel->mass = 220;
        wheel->driven = true;
    }
    vehicle->drive = (ld_drive){.kp = 4e4, .ki = 1e4};
    set3(vehicle->suspension.stiffness, 2e6, 4e5, 2e6);
    set3(vehicle->suspension.damping, 2e4, 2.5e4, 2e4);
    vehicle->tyre = (ld_tyre){.radius = 0.55,
                              .stiffness = {4e5, 1.1e6, 5e5},
                              .damping = {4e3, 4e3, 4e3},
                              .relaxation_length = 0.3,
                              .friction = 0.8};
}

static void fill_platform(ld_platform *platform)
{
    platform->chassis_mass = 11000;
    set3(platform->chassis_inertia, 9e3, 4.5e4, 4.2e4);
    platform->has_azimuth = true;
    platform->azimuth = (ld_turret){
        .hinge_at = {-1.2, 0.6, 0},
        .mass = 700,
        .center = {0, 0.3, 0},
        .inertia = {250, 400, 250},
        .stabiliser = {.command = reference_table(1, 2, (double[]){0, 0}),
                       .kp = 4e6,
                       .ki = 4e6,
                       .kd = 3e5,
                       .torque_limit = 5e4},
        .friction = {.viscous = 500, .coulomb = 200, .rate = 1e-3},
    };
    platform->elevation = (ld_turret){
        .hinge_at = {-0.6, 0.7, 0},
        .mass = 900,
        .center = {0.7, 0.3, 0},
        .inertia = {230, 470, 360},
        .stabiliser = {.command = reference_table(1, 2, (double[]){0, 19.8 * degree}),
                       .kp = 6e6,
                       .ki = 6e6,
                       .kd = 4e5,
                       .torque_limit = 8e4},
        .friction = {.viscous = 800, .coulomb = 300, .rate = 1e-3},
    };
}

void reference_vehicle(ld_model *model, double speed)
{
    reference_model(model);
    model->base.kind = LD_BASE_VEHICLE;
    model->base.vehicle.speed = speed;
    model->base.vehicle.road.form = LD_ROAD_FLAT;
    model->base.vehicle.road.iso_class = LD_ROAD_SMOOTH;
    model->base.vehicle.road.places[0] = model->base.vehicle.road.places[1] = NAN;
    fill_wheels(&model->base.vehicle);
    fill_platform(&model->platform);
}

void reference_by_pressure(ld_model *model)
{
    free(model->rocket.motor.thrust.data);
    model->rocket.motor.thrust = (ld_table){0};
    model->rocket.motor.absent = true;
    model->rocket.empty = model->rocket.full;
    model->rocket.propellant = 0;
    model->tubes.pressure = (ld_pressure){.present = true,
                                          .form = LD_PRESSURE_OF_GAS,
                                          .pressure = 2e6,
                                          .volume = 0.03,
                                          .exponent = 1.4,
                                          .ambient = 1e5,
                                          .scale = 1};
}

void reference_recoil(ld_model *model)
{
    model->tubes.support[0].recoil = (ld_recoil){.present = true,
                                                 .preload = 2e3,
                                                 .stiffness = 2e4,
                                                 .damping = 500,
                                                 .quadratic_damping = 100,
                                                 .friction = 100,
                                                 .friction_speed = 0.01,
                                                 .stroke = 0.3};
    model->tubes.support[1].stiffness[0] = model->tubes.support[1].damping[0] = 0;
}

void reference_model_free(ld_model *model)
{
    model_clear(model);
    memset(model, 0, sizeof *model);
}
