#include "support/made_launch.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/model.h"

// name, unit, size of the numbers, frequency [Hz], 1: of the rocket (NaN after it has left)
typedef struct made {
    const char *name, *unit;
    double size, frequency;
    int rocket;
} made;

static const made columns[] = {
    {"t", "s", 1, 0, 0},
    {"phase", "1", 2, 0, 0},
    {"base.x", "m", 1, 1, 0},
    {"base.y", "m", 0.02, 2, 0},
    {"base.z", "m", 0.01, 1, 0},
    {"base.yaw", "rad", 0.01, 1, 0},
    {"base.pitch", "rad", 0.03, 1, 0},
    {"base.roll", "rad", 0.02, 1, 0},
    {"tube.x", "m", 1, 1, 0},
    {"tube.y", "m", 1e-3, 20, 0},
    {"tube.z", "m", 1e-3, 24, 0},
    {"tube.q0", "1", 1, 0, 0},
    {"tube.q1", "1", 1e-3, 20, 0},
    {"tube.q2", "1", 1e-3, 20, 0},
    {"tube.q3", "1", 0.2, 2, 0},
    {"tube.vx", "m/s", 0.2, 30, 0},
    {"tube.vy", "m/s", 0.2, 30, 0},
    {"tube.vz", "m/s", 0.2, 30, 0},
    {"tube.wx", "rad/s", 0.2, 30, 0},
    {"tube.wy", "rad/s", 0.2, 30, 0},
    {"tube.wz", "rad/s", 0.2, 30, 0},
    {"q1", "kg^0.5 m", 1e-3, 28, 0},
    {"q2", "kg^0.5 m", 1e-4, 130, 0},
    {"q3", "kg^0.5 m", 1e-5, 320, 0},
    {"q4", "kg^0.5 m", 1e-3, 28, 0},
    {"q5", "kg^0.5 m", 1e-4, 130, 0},
    {"q6", "kg^0.5 m", 1e-5, 320, 0},
    {"q1_dot", "kg^0.5 m/s", 0.2, 28, 0},
    {"q2_dot", "kg^0.5 m/s", 0.1, 130, 0},
    {"q3_dot", "kg^0.5 m/s", 0.05, 320, 0},
    {"q4_dot", "kg^0.5 m/s", 0.2, 28, 0},
    {"q5_dot", "kg^0.5 m/s", 0.1, 130, 0},
    {"q6_dot", "kg^0.5 m/s", 0.05, 320, 0},
    {"tip.y", "m", 2e-3, 28, 0},
    {"tip.z", "m", 6e-4, 31, 0},
    {"tip.pitch", "rad", 1.1e-3, 29, 0},
    {"tip.yaw", "rad", 5e-4, 33, 0},
    {"tip.vy", "m/s", 0.35, 28, 0},
    {"tip.vz", "m/s", 0.12, 31, 0},
    {"tip.pitch_rate", "rad/s", 0.25, 29, 0},
    {"tip.yaw_rate", "rad/s", 0.1, 33, 0},
    {"rocket.s", "m", 3, 0.5, 1},
    {"rocket.y", "m", 3e-4, 25, 1},
    {"rocket.z", "m", 2e-4, 40, 1},
    {"rocket.psi", "rad", 4e-4, 22, 1},
    {"rocket.theta", "rad", 3e-4, 35, 1},
    {"rocket.gamma", "rad", 2.5, 0.5, 1},
    {"rocket.s_dot", "m/s", 38, 1, 1},
    {"rocket.y_dot", "m/s", 0.05, 25, 1},
    {"rocket.z_dot", "m/s", 0.05, 40, 1},
    {"rocket.psi_dot", "rad/s", 0.1, 22, 1},
    {"rocket.theta_dot", "rad/s", 0.1, 35, 1},
    {"rocket.gamma_dot", "rad/s", 32, 1, 1},
    {"rocket.w_x", "rad/s", 32, 1, 1},
    {"rocket.w_y", "rad/s", 0.1, 35, 1},
    {"rocket.w_z", "rad/s", 0.1, 22, 1},
    {"rocket.vx", "m/s", 36, 1, 1},
    {"rocket.vy", "m/s", 12, 1, 1},
    {"rocket.vz", "m/s", 0.2, 20, 1},
    {"rocket.pitch", "rad", 0.35, 1, 1},
    {"rocket.yaw", "rad", 1e-3, 20, 1},
    {"rocket.pitch_rate", "rad/s", 0.26, 12, 1},
    {"rocket.yaw_rate", "rad/s", 0.1, 15, 1},
    {"rocket.spin", "rad/s", 32, 1, 1},
    {"rocket.mass", "kg", 60, 0, 1},
    {"rocket.thrust", "N", 15000, 1, 1},
    {"contact.rear.force", "N", 1500, 60, 1},
    {"contact.rear.normal", "N", 1490, 60, 1},
    {"contact.rear.penetration", "m", 3e-5, 60, 1},
    {"contact.rear.y", "m", 3e-4, 60, 1},
    {"contact.rear.z", "m", 3e-4, 60, 1},
    {"contact.middle.force", "N", 500, 80, 1},
    {"contact.middle.normal", "N", 490, 80, 1},
    {"contact.middle.penetration", "m", 1e-5, 80, 1},
    {"contact.middle.y", "m", 3e-4, 60, 1},
    {"contact.middle.z", "m", 3e-4, 60, 1},
    {"contact.front.force", "N", 900, 45, 1},
    {"contact.front.normal", "N", 890, 45, 1},
    {"contact.front.penetration", "m", 2e-5, 45, 1},
    {"contact.front.y", "m", 3e-4, 60, 1},
    {"contact.front.z", "m", 3e-4, 60, 1},
    {"slot.force", "N", 700, 50, 1},
    {"slot.friction", "N", 70, 50, 1},
    {"lock.force", "N", 5000, 20, 1},
    {"energy.kinetic", "J", 43000, 1, 0},
    {"energy.potential", "J", 300, 2, 0},
    {"energy.elastic", "J", 12, 30, 0},
    {"work.thrust", "J", 44000, 1, 0},
    {"work.gravity_rocket", "J", -600, 1, 0},
    {"work.contact_normal", "J", -9, 2, 0},
    {"work.contact_friction", "J", -150, 1, 0},
    {"work.slot", "J", 1e-9, 3, 0},
    {"work.slot_friction", "J", -120, 1, 0},
    {"work.lock", "J", 1e-9, 2, 0},
    {"work.support_damping", "J", -4, 2, 0},
    {"work.modal_damping", "J", -2, 2, 0},
    {"work.base", "J", 3, 4, 0},
    {"work.mass_change", "J", -70, 1, 0},
    {"energy.residual", "J", 1e-4, 10, 0},
    {"spare.1", "1", 1, 1, 0},
    {"spare.2", "1", 1, 2, 0},
    {"spare.3", "1", 1, 3, 0},
    {"spare.4", "1", 1, 4, 0},
    {"spare.5", "1", 1, 5, 0},
    {"spare.6", "1", 1, 6, 0},
    {"spare.7", "1", 1, 7, 0},
    {"spare.8", "1", 1, 8, 0},
    {"spare.9", "1", 1, 9, 0},
    {"spare.10", "1", 1, 10, 0},
    {"spare.11", "1", 1, 11, 0},
    {"spare.12", "1", 1, 12, 0},
    {"spare.13", "1", 1, 13, 0},
    {"spare.14", "1", 1, 14, 0},
    {"spare.15", "1", 1, 15, 0},
    {"spare.16", "1", 1, 16, 0},
};

_Static_assert(sizeof columns / sizeof *columns == MADE_COLUMNS, "count the columns");

const ld_column *made_columns(void)
{
    static ld_column list[MADE_COLUMNS];
    static char description[MADE_COLUMNS][80];
    for (int i = 0; i < MADE_COLUMNS; i++) {
        snprintf(description[i], sizeof description[i], "made up, ±%g", columns[i].size);
        list[i] = (ld_column){columns[i].name, columns[i].unit, description[i]};
    }
    return list;
}

void made_row(size_t index, double *values)
{
    const double tau = 6.283185307179586;
    double t = 1e-4 * (double)index;
    for (int i = 0; i < MADE_COLUMNS; i++) {
        const made *column = &columns[i];
        double phase = tau * column->frequency * t;
        values[i] = column->frequency > 0 ? column->size * sin(phase) : column->size;
        if (strncmp(column->name, "contact.", 8) == 0 && strstr(column->name, "force"))
            values[i] = fmax(values[i], 0);
        if (column->rocket && t > 0.16)
            values[i] = NAN;
    }
    values[0] = t;
}

ld_status made_run(const ld_sink *sink, size_t rows, ld_error *error)
{
    ld_status status = sink->begin(sink->self, made_columns(), MADE_COLUMNS, error);
    for (size_t i = 0; !status && i < rows; i++) {
        double values[MADE_COLUMNS];
        made_row(i, values);
        status = sink->row(sink->self, values, MADE_COLUMNS, error);
    }
    return status;
}

void made_model(ld_model *model)
{
    static char title[] = "Made-up launch, \"in quotes\" and in 'quotes', ±1 %";
    memset(model, 0, sizeof *model);
    model->title = title;
    model->tubes.slot.kind = LD_SLOT_HELIX;
    model->rocket.adaptor_count = 3;
    strcpy(model->rocket.adaptor[0].name, "rear");
    strcpy(model->rocket.adaptor[1].name, "middle");
    strcpy(model->rocket.adaptor[2].name, "front");
}

void made_summary(ld_summary *summary, int middle)
{
    static const ld_mode modes[] = {{31.25, 0.012, -2.356, "bending y"},
                                    {31.25, 0.012, -2.356, "bending z"},
                                    {128.5, 0.02, -16.1, "bending y"},
                                    {128.5, 0.02, -16.1, "bending z"},
                                    {310.125, 0.01, -19.5, "torsion"}};
    memset(summary, 0, sizeof *summary);
    summary->rocket_count = 1;
    summary->rocket[0] = (ld_rocket_summary){
        .tube = 8,
        .t_ignition = 0,
        .t_release = 3.3336e-3,
        .t_front = 0.0952,
        .t_middle = middle ? 0.1273 : NAN,
        .t_rear = 0.1604,
        .t_exit = {0.1604, middle ? 0.1273 : NAN, 0.0952},
        .exit_speed = 37.7,
        .inertial_speed = 37.75,
        .spin_rate = 31.9,
        .pitch = 0.3455,
        .yaw = -1e-4,
        .pitch_rate = 0.254,
        .yaw_rate = 0.012,
        .exit = {{1.5, 2.25, -0.5}, {35.5, 12.75, 0.125}, {0.5, -0.5, 0.5, 0.5}, {32, 0.25, -0.75}},
        .relative = {1e-4, -2e-4, 3e-4, -4e-4, 2.5, 31.9, 0.05, -0.25},
        .tip = {-1.1e-3, 2e-4, -5e-4, 1e-4, 0.3, -0.02, 0.2, 0.01},
        .tip_off = {-7e-3, 2e-4, -0.26, 0.007, -0.3, 0.015, -1.5, 5.125, -0.375, -0.02},
        .since_ignition = {-8e-4, -1e-3, 2.25, -0.27, 0.008, 31.5, -1.25, 5.25},
        .exit_error = {2e-5, 1.2e-3, 2e-3},
        .max_contact_force = {1500, 500, 900},
        .max_slot_force = 700,
        .energy_dropped = 0.0625};
    summary->equilibrium = (ld_equilibrium_summary){.lock_force = -199.25,
                                                    .slot_force = 0.125,
                                                    .contact_force = {250, 0, 303.5},
                                                    .tip_sag = {-1.25e-3, 0},
                                                    .residual = 1e-10};
    summary->energy = (ld_energy){
        43000,  300,
        12,     {44000, -600, -9, -150, 1e-9, -120, 1e-9, -4, -2, 3, -70, 0, 0, 0, 0, 0, 0, 0, 0},
        1.5e-4, 3.4e-9};
    summary->mode_count = 5;
    memcpy(summary->mode, modes, sizeof modes);
    summary->statistics = (ld_statistics){1234, 9876, 0.0105, 0.0125};
    summary->t_end = 0.1604;
    summary->complete = true;
}
