// Random vehicles and random states of them: rolling or parked, wheels on the road or in the air,
// beyond and below the friction limit, stabilisers at their limits and with their options, locked
// hinges, every kind of deterministic road.
#ifndef LD_TESTS_SUPPORT_VEHICLE_CASE_H
#define LD_TESTS_SUPPORT_VEHICLE_CASE_H

#include <stdlib.h>

#include "model/model.h"
#include "support/dense_vehicle.h"
#include "support/draw.h"
#include "support/reference_model.h"
#include "support/stabiliser_options.h"

typedef struct vehicle_case {
    double t;
    double orientating[VEHICLE_MOST_BODY_STATES], marching[DENSE_MARCHING_STATES];
    v3 tube_force, tube_moment;
    hold_rest rest[HINGES];
    bool frictionless;
} vehicle_case;

static inline void shift3(uint64_t *seed, double x[3], double size)
{
    for (int i = 0; i < 3; i++)
        x[i] += size * draw(seed);
}

static inline void draw_road(uint64_t *seed, int kind, ld_road *given)
{
    given->form = kind & 3 ? LD_ROAD_SUM : LD_ROAD_FLAT;
    given->sine_count = kind & 1 ? 2 : 0;
    given->bump_count = kind & 2 ? 3 : 0;
    for (int i = 0; i < given->sine_count; i++) {
        double wavelength = 1.5 + draw(seed), phase = 3 * draw(seed);
        given->sine[i] = (ld_road_sine){0.01 + 0.01 * i, wavelength, phase};
    }
    for (int i = 0; i < given->bump_count; i++) {
        double at = 4 * draw(seed), length = 2 + draw(seed), height = 0.05 * draw(seed);
        given->bump[i] = (ld_bump){at, length, height, (ld_track)i};
    }
}

// Vehicle number `kind`, from 0, of which every eighth is much like the one eight before.
static inline void draw_vehicle(uint64_t *seed, int kind, ld_model *model)
{
    reference_vehicle(model, kind % 3 == 0 ? 0 : 8 + 5 * draw(seed));
    ld_vehicle *vehicle = &model->base.vehicle;
    ld_platform *platform = &model->platform;
    draw_road(seed, kind % 4, &vehicle->road);
    // wheels
    vehicle->wheel_count = 3 + kind % 6;
    for (int i = 0; i < vehicle->wheel_count; i++) {
        ld_wheel *wheel = &vehicle->wheel[i];
        *wheel = vehicle->wheel[i % 6];
        shift3(seed, wheel->mount, 0.3);
        wheel->mass += 50 * draw(seed);
        wheel->driven = i != kind % 8;
    }
    shift3(seed, vehicle->suspension.stiffness, 3e5);
    shift3(seed, vehicle->suspension.damping, 1e4);
    if (kind & 4) {
        vehicle->suspension.bump_stop.compression = 0.05;
        vehicle->suspension.bump_stop.extension = 0.1;
        vehicle->suspension.bump_stop.stiffness = 5e6;
    }
    // platforms
    shift3(seed, platform->chassis_inertia, 1e3);
    ld_turret *turret[HINGES] = {&platform->azimuth, &platform->elevation};
    for (int i = 0; i < HINGES; i++) {
        shift3(seed, turret[i]->hinge_at, 0.5);
        shift3(seed, turret[i]->center, 0.4);
        shift3(seed, turret[i]->inertia, 30);
        turret[i]->lock = (ld_hinge_lock){(kind / 2 + i) % 4 == 0, 1e7, 1e5};
        if (kind % 8 > 1)
            draw_stabiliser_options(seed, &turret[i]->stabiliser);
        if (kind % 2) {
            free(turret[i]->stabiliser.command.data);
            turret[i]->stabiliser.command =
                reference_table(3, 2, (double[]){-0.5, 0, 0.5, 0.1, 1.5, 0});
        }
    }
    // carried tubes
    ld_tubes *tubes = &model->tubes;
    shift3(seed, tubes->layout.first, 0.2);
    if (kind & 2) {
        tubes->section_count = 2;
        tubes->section[1] = tubes->section[0];
        tubes->section[1].from = 1.3;
        tubes->section[1].mass_per_length *= 0.8;
        tubes->section[1].polar_inertia *= 0.7;
        tubes->point_mass_count = 1;
        tubes->point_mass[0] = (ld_point_mass){.at = 2.8, .mass = 0.6};
        tubes->empty_count = 2;
        tubes->empty[0] = 3;
        tubes->empty[1] = 11;
        shift3(seed, model->rocket.products, 0.05);
        model->rocket.eccentricity[0] = 3e-3;
        model->rocket.eccentricity[1] = -2e-3;
        model->rocket.mass_error = 0.4;
    }
}

// Commands that miss the platform's yaw and pitch by up to 0.03 rad (locks: rest angles alike).
static inline void orient(uint64_t *seed, ld_model *model, m3 A, vehicle_case *c)
{
    ld_turret *turret[HINGES] = {&model->platform.azimuth, &model->platform.elevation};
    v3 d = m3_column(A, 0);
    double angle[HINGES] = {atan2(-d.z, d.x), asin(d.y)};
    for (int i = 0; i < HINGES; i++) {
        ld_table *command = &turret[i]->stabiliser.command;
        double shift = angle[i] + 0.03 * draw(seed) - command->data[1];
        for (size_t row = 0; row < command->rows; row++)
            command->data[2 * row + 1] += shift;
        c->rest[i].angle = c->orientating[VEHICLE_ANGLE + i] + 0.03 * draw(seed);
        c->rest[i].torque = 3e4 * draw(seed);
        c->orientating[VEHICLE_Z + i] = 1.3 * turret[i]->stabiliser.torque_limit * draw(seed);
    }
}

// Drives anywhere: torques within the limits, teeth that press on either side or are free, a motor
// about as fast as its hinge.
static inline void drive(uint64_t *seed, const ld_platform *platform, double *o)
{
    const ld_turret *turret[HINGES] = {&platform->azimuth, &platform->elevation};
    for (int i = 0; i < HINGES; i++) {
        const ld_stabiliser *given = &turret[i]->stabiliser;
        double *own = o + VEHICLE_DRIVE + DRIVE_STATES * i;
        for (int k = DRIVE_TORQUE; k <= DRIVE_COMPUTED; k++)
            own[k] = given->torque_limit * draw(seed);
        own[DRIVE_TWIST] = given->gear.backlash * draw(seed) + 1e-4 * draw(seed);
        own[DRIVE_RATE] = o[VEHICLE_RATE + i] + 1e-2 * draw(seed);
    }
}

// Draws a state, moving the model's commands near to where the platform points.
static inline void draw_vehicle_state(uint64_t *seed, ld_model *model, vehicle_case *c)
{
    const ld_vehicle *vehicle = &model->base.vehicle;
    memset(c, 0, sizeof *c);
    c->t = 2 * draw(seed);
    c->frictionless = draw(seed) > 0.5;
    // chassis and hinges
    double *o = c->orientating;
    double heading = 3 * draw(seed), pitch = 0.4 * draw(seed), roll = 0.4 * draw(seed);
    m3 A = m3_mul(m3_rotation_y(heading), m3_mul(m3_rotation_z(pitch), m3_rotation_x(roll)));
    quat q = q_from_matrix(A);
    v3 r = draw_v3(seed, 3), v = draw_v3(seed, 10), w = draw_v3(seed, 2);
    v3_store(o + VEHICLE_R, r);
    memcpy(o + VEHICLE_QUATERNION, &q, sizeof q);
    v3_store(o + VEHICLE_V, v);
    v3_store(o + VEHICLE_W, w);
    for (int i = 0; i < HINGES; i++) {
        o[VEHICLE_ANGLE + i] = (i == 0 ? 3 : 0.7) * draw(seed);
        double rate = draw(seed); // slow ones for the friction
        o[VEHICLE_RATE + i] = rate * (draw(seed) > 0 ? 1 : 2e-3);
    }
    m3 turn = m3_mul(m3_rotation_y(o[VEHICLE_ANGLE]), m3_rotation_z(o[VEHICLE_ANGLE + 1]));
    orient(seed, model, m3_mul(A, turn), c);
    drive(seed, &model->platform, o);
    // wheels about their mounts and about touching the road
    for (int i = 0; i < vehicle->wheel_count; i++) {
        double *wheel = c->marching + WHEEL_STATES * i, slope;
        v3 mount = v3_from(vehicle->wheel[i].mount);
        v3 at = v3_add(r, m3_apply(A, v3_add(mount, draw_v3(seed, 0.05))));
        at.y = dense_road_height(&vehicle->road, mount.z, at.x, &slope) + vehicle->tyre.radius -
               0.02 + 0.03 * draw(seed);
        v3_store(wheel + WHEEL_R, at);
        v3_store(wheel + WHEEL_V, v3_add(v, draw_v3(seed, 2)));
        wheel[WHEEL_ETA] = 0.08 * draw(seed);
        wheel[WHEEL_XI] = vehicle->speed == 0 ? 0.08 * draw(seed) : 0;
    }
    c->marching[WHEEL_STATES * vehicle->wheel_count] = draw(seed);
    c->tube_force = draw_v3(seed, 2e4);
    c->tube_moment = draw_v3(seed, 1e4);
}

static inline dense_vehicle_input dense_input_of(const vehicle_case *c)
{
    dense_vehicle_input input = {.t = c->t,
                                 .command_at = c->t,
                                 .orientating = c->orientating,
                                 .marching = c->marching,
                                 .tube_force = c->tube_force,
                                 .tube_moment = c->tube_moment,
                                 .frictionless = c->frictionless};
    memcpy(input.rest, c->rest, sizeof input.rest);
    return input;
}

#endif
