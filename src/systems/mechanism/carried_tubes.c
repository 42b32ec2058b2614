#include "systems/mechanism/carried_tubes.h"

#include "elements/motor.h"
#include "model/model.h"

// m (|c|^2 E - c c^T): what a point mass adds to the inertia about the origin.
static m3 point_inertia(double mass, v3 c)
{
    double square = v3_norm2(c);
    return m3_scale(mass, m3_sub(m3_diagonal(square, square, square), m3_outer(c, c)));
}

// A part with its mass centre c from the body's origin and its inertia J about c.
static void gather(carried_mass *all, double mass, v3 c, m3 J)
{
    all->mass += mass;
    all->moment = v3_axpy(all->moment, mass, c);
    all->inertia = m3_add(all->inertia, m3_add(J, point_inertia(mass, c)));
}

carried_mass carried_body(double mass, v3 c, const double J[6])
{
    carried_mass all = {0};
    gather(&all, mass, c, (m3){{{J[0], J[3], J[4]}, {J[3], J[1], J[5]}, {J[4], J[5], J[2]}}});
    return all;
}

// A rigid tube in its place: its rear end, and its axes, against the body.
typedef struct tube_pose {
    v3 at; // [m]
    const m3 *mount;
} tube_pose;

static v3 on_tube(const tube_pose *pose, v3 point)
{
    return v3_add(pose->at, m3_apply(*pose->mount, point));
}

static m3 in_body(const tube_pose *pose, m3 J)
{
    return m3_mul(*pose->mount, m3_mul(J, m3_transpose(*pose->mount)));
}

// A line mass with polar inertia, point masses, tail.
static void gather_tube(carried_mass *all, const ld_tubes *tubes, const tube_pose *pose)
{
    for (int k = 0; k < tubes->section_count; k++) {
        const ld_section *section = &tubes->section[k];
        double end = k + 1 < tubes->section_count ? section[1].from : tubes->length;
        double length = end - section->from, mass = section->mass_per_length * length;
        double across = mass * length * length / 12;
        m3 J = m3_diagonal(section->polar_inertia * length, across, across);
        gather(all, mass, on_tube(pose, v3_make(section->from + 0.5 * length, 0, 0)),
               in_body(pose, J));
    }
    for (int k = 0; k < tubes->point_mass_count; k++)
        gather(all, tubes->point_mass[k].mass,
               on_tube(pose, v3_make(tubes->point_mass[k].at, 0, 0)), m3_diagonal(0, 0, 0));
    const double *J = tubes->tail.inertia;
    gather(all, tubes->tail.mass, on_tube(pose, v3_make(tubes->tail.center, 0, 0)),
           in_body(pose, m3_diagonal(J[0], J[1], J[2])));
}

v3 carried_tube_row(const ld_layout *layout, int number)
{
    int row = (number - 1) / layout->columns, column = (number - 1) % layout->columns;
    return v3_make(0, row * layout->pitch, column * layout->pitch);
}

static bool listed(const int *list, int count, int number)
{
    for (int k = 0; k < count; k++)
        if (list[k] == number)
            return true;
    return false;
}

// The rocket in tube `number`.
static const ld_rocket *rocket_in(const ld_model *model, int number)
{
    for (int i = 0; model->salvo && i < model->firing_count; i++)
        if (model->firing[i].tube == number)
            return &model->salvo[i];
    return &model->rocket;
}

ld_status carried_tubes(carried_mass *all, const ld_model *model, const mechanism_tubes *which,
                        const m3 *mount, ld_error *error)
{
    const ld_tubes *tubes = &model->tubes;
    for (int number = 1; number <= tubes->layout.rows * tubes->layout.columns; number++) {
        v3 row = m3_apply(*mount, carried_tube_row(&tubes->layout, number));
        tube_pose pose = {v3_add(v3_from(tubes->layout.first), row), mount};
        if (number == which->launching)
            continue;
        gather_tube(all, tubes, &pose);
        if (listed(which->fired, which->fired_count, number) ||
            listed(tubes->empty, tubes->empty_count, number))
            continue;
        const ld_rocket *rocket = rocket_in(model, number);
        motor thruster;
        ld_status status = motor_build(&thruster, rocket, 0, error);
        if (status)
            return status;
        v3 c = v3_add(v3_make(rocket->start_at, 0, 0), thruster.full.c);
        gather(all, thruster.full.m, on_tube(&pose, c), in_body(&pose, thruster.full.J));
        motor_free(&thruster);
    }
    return LD_OK;
}

void carried_store(const carried_mass *all, ld_mstmm_element *e)
{
    v3 c = v3_scale(1 / all->mass, all->moment);
    m3 J = m3_sub(all->inertia, point_inertia(all->mass, c));
    e->mass = all->mass;
    v3_store(e->center, c);
    for (int i = 0; i < 3; i++)
        e->inertia[i] = J.a[i][i];
    e->inertia[3] = J.a[0][1];
    e->inertia[4] = J.a[0][2];
    e->inertia[5] = J.a[1][2];
}
