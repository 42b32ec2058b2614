#include "systems/bases/vehicle_mechanism.h"

#include <stdio.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"

static const char chassis[] = "chassis", azimuth_platform[] = "azimuth platform",
                  elevation_platform[] = "elevation platform";

static void set_name(char to[LD_MAX_NAME], const char *from)
{
    snprintf(to, LD_MAX_NAME, "%s", from);
}

static ld_body *add_body(ld_mechanism *self, const char *name, double mass, const double inertia[3])
{
    ld_body *body = &self->body[self->body_count++];
    set_name(body->name, name);
    body->mass = mass;
    memcpy(body->inertia, inertia, sizeof body->inertia);
    return body;
}

static ld_joint *add_joint(ld_mechanism *self, const char *name, const char *parent,
                           const char *body)
{
    ld_joint *joint = &self->joint[self->joint_count++];
    set_name(joint->name, name);
    set_name(joint->parent, parent);
    set_name(joint->body, body);
    joint->lock.from = NAN;
    for (int k = 0; k < 3; k++)
        joint->body_at[k] = NAN;
    joint->stops.low = joint->stops.high = NAN;
    return joint;
}

static void add_drive(ld_mechanism *self, const char *hinge, const ld_stabiliser *stabiliser,
                      ld_follows follows)
{
    ld_joint_drive *drive = &self->drive[self->drive_count++];
    set_name(drive->name, hinge);
    set_name(drive->joint, hinge);
    drive->follows = follows;
    drive->form = LD_DRIVE_ANGLE;
    drive->angle = *stabiliser;
}

// A platform on its hinge, about an axis of the body that carries it.
static void add_platform(ld_mechanism *self, const ld_turret *turret, const char *hinge,
                         const char *parent, const char *name, const double axis[3])
{
    ld_body *body = add_body(self, name, turret->mass, turret->inertia);
    memcpy(body->center, turret->center, sizeof body->center);
    ld_joint *joint = add_joint(self, hinge, parent, name);
    joint->kind = LD_JOINT_REVOLUTE;
    memcpy(joint->at, turret->hinge_at, sizeof joint->at);
    memcpy(joint->axis, axis, sizeof joint->axis);
    joint->friction = turret->friction;
    joint->lock.spring = turret->lock;
}

void vehicle_describe(const ld_model *model, ld_mechanism *self)
{
    static const double y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    const ld_platform *given = &model->platform;
    add_body(self, chassis, given->chassis_mass, given->chassis_inertia);
    add_joint(self, chassis, "ground", chassis)->kind = LD_JOINT_FREE;
    if (given->has_azimuth) {
        add_platform(self, &given->azimuth, "azimuth", chassis, azimuth_platform, y);
        add_drive(self, "azimuth", &given->azimuth.stabiliser, LD_FOLLOWS_YAW);
    }
    add_platform(self, &given->elevation, "elevation",
                 given->has_azimuth ? azimuth_platform : chassis, elevation_platform, z);
    add_drive(self, "elevation", &given->elevation.stabiliser, LD_FOLLOWS_PITCH);
    set_name(self->wheels_on, chassis);
}

mechanism_plan vehicle_plan(const ld_model *model, const ld_mechanism *described)
{
    return (mechanism_plan){.model = model,
                            .given = described,
                            .carries = elevation_platform,
                            .mount = m3_identity(),
                            .overall = model->run.formulation == LD_FORMULATION_OVERALL};
}

void vehicle_name_streams(mechanism_system *self)
{
    for (int i = 0; i < self->hold_count; i++) {
        mechanism_hold *hold = &self->hold[i];
        char name[LD_MAX_NAME];
        set_name(name, hold->name);
        snprintf(hold->stream, sizeof hold->stream, "platform.%.60s.stabiliser.sensor_noise", name);
    }
}
