#include "elements/motor.h"

#include <math.h>
#include <stdlib.h>

// The shortest rotation of x onto (1, y, z): of columns in the turned axes to B.
static m3 turned(double y, double z)
{
    double cosine = 1 / sqrt(1 + y * y + z * z);
    m3 across = m3_skew((v3){0, -z * cosine, y * cosine});
    m3 square = m3_scale(1 / (1 + cosine), m3_mul(across, across));
    return m3_add(m3_identity(), m3_add(across, square));
}

static rocket_mass mass_of(const ld_rocket *rocket, const ld_mass_data *data)
{
    rocket_mass mass = {.m = data->mass + rocket->mass_error, .c = v3_from(data->center)};
    mass.c.y += rocket->eccentricity[0];
    mass.c.z += rocket->eccentricity[1];
    mass.J = m3_diagonal(data->inertia[0], data->inertia[1], data->inertia[2]);
    mass.J.a[0][1] = mass.J.a[1][0] = rocket->products[0];
    mass.J.a[0][2] = mass.J.a[2][0] = rocket->products[1];
    mass.J.a[1][2] = mass.J.a[2][1] = rocket->products[2];
    const double *delta = rocket->dynamic_imbalance;
    if (delta[0] != 0 || delta[1] != 0) {
        m3 turn = turned(delta[0], delta[1]);
        mass.J = m3_mul(m3_mul(turn, mass.J), m3_transpose(turn));
    }
    return mass;
}

ld_status motor_build(motor *self, const ld_rocket *rocket, ld_error *error)
{
    const ld_table *table = &rocket->motor.thrust;
    size_t n = table->rows;
    *self = (motor){.corner_count = n, .propellant = rocket->propellant};
    self->full = mass_of(rocket, &rocket->full);
    self->empty = mass_of(rocket, &rocket->empty);
    self->t = malloc((3 * n + 1) * sizeof(double));
    if (!self->t)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the thrust table");
    self->thrust = self->t + n;
    self->impulse = self->t + 2 * n;
    for (size_t k = 0; k < n; k++) {
        self->t[k] = rocket->motor.time_scale * table->data[k * table->columns];
        self->thrust[k] = rocket->motor.thrust_scale * table->data[k * table->columns + 1];
        self->impulse[k] =
            k == 0 ? 0
                   : self->impulse[k - 1] + 0.5 * (self->thrust[k] + self->thrust[k - 1]) *
                                                (self->t[k] - self->t[k - 1]);
    }
    return LD_OK;
}

void motor_free(motor *self)
{
    free(self->t);
    *self = (motor){0};
}

static bool burning(const motor *self, int piece)
{
    return piece >= 0 && piece + 1 < (int)self->corner_count;
}

double motor_thrust(const motor *self, int piece, double t)
{
    if (!burning(self, piece))
        return 0;
    double slope =
        (self->thrust[piece + 1] - self->thrust[piece]) / (self->t[piece + 1] - self->t[piece]);
    return self->thrust[piece] + slope * (t - self->t[piece]);
}

double motor_impulse(const motor *self, int piece, double t)
{
    if (piece < 0)
        return 0;
    double burnt = self->impulse[piece];
    if (burning(self, piece))
        burnt += 0.5 * (self->thrust[piece] + motor_thrust(self, piece, t)) * (t - self->t[piece]);
    return burnt;
}

int motor_piece(const motor *self, double t)
{
    int piece = -1;
    while (piece + 1 < (int)self->corner_count && t >= self->t[piece + 1])
        piece++;
    return piece;
}

double motor_total_impulse(const motor *self)
{
    return self->corner_count ? self->impulse[self->corner_count - 1] : 0;
}

void motor_mass(const motor *self, int piece, double t, rocket_mass *mass)
{
    double total = motor_total_impulse(self);
    double share = total > 0 ? motor_impulse(self, piece, t) / total : 0;
    double share_dot = total > 0 ? motor_thrust(self, piece, t) / total : 0;
    // the burnt mass is a scalar of its own; centre and inertia go linearly in it
    v3 c_change = v3_sub(self->empty.c, self->full.c);
    m3 J_change = m3_sub(self->empty.J, self->full.J);
    mass->m = self->full.m - share * self->propellant;
    mass->m_dot = -share_dot * self->propellant;
    mass->c = v3_axpy(self->full.c, share, c_change);
    mass->c_dot = v3_scale(share_dot, c_change);
    mass->J = m3_add(self->full.J, m3_scale(share, J_change));
    mass->J_dot = m3_scale(share_dot, J_change);
}
