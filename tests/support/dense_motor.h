// What a motor does across its axis and when, for the independent programs: from the model's tables
// alone.
#ifndef LD_TESTS_SUPPORT_DENSE_MOTOR_H
#define LD_TESTS_SUPPORT_DENSE_MOTOR_H

#include <math.h>

#include "model/blocks/motor.h"

// The table's time at which the rise ends.
static inline double dense_motor_rise(const ld_motor *motor)
{
    const double *row = motor->thrust.data;
    double most = 0, rise = 0;
    for (size_t i = 0; i < motor->thrust.rows; i++)
        most = row[2 * i + 1] > most ? row[2 * i + 1] : most;
    for (size_t i = motor->thrust.rows; i-- > 0;)
        rise = row[2 * i + 1] >= 0.9 * most ? row[2 * i] : rise;
    return rise;
}

// Seconds after ignition of the table's time tau: rise stretched, then all stretched and delayed.
static inline double dense_motor_clock(const ld_motor *motor, double tau)
{
    double rise = dense_motor_rise(motor), k = motor->rise_scale;
    return motor->delay + motor->time_scale * (tau < rise ? k * tau : k * rise + tau - rise);
}

// The table's time `since` ignition.
static inline double dense_motor_time(const ld_motor *motor, double since)
{
    double rise = dense_motor_rise(motor), k = motor->rise_scale;
    double s = (since - motor->delay) / motor->time_scale;
    return s < k * rise ? s / k : s - (k - 1) * rise;
}

// Column of a table over the motor's time, `since` ignition.
static inline double dense_motor_column(const ld_motor *motor, const ld_table *table, size_t column,
                                        double since)
{
    size_t n = table->rows, m = table->columns;
    double tau = dense_motor_time(motor, since);
    if (n == 0)
        return 0;
    double value = table->data[column];
    for (size_t i = 0; i + 1 < n; i++) {
        const double *a = table->data + i * m, *b = a + m;
        value += (b[column] - a[column]) * fmin(1, fmax(0, (tau - a[0]) / (b[0] - a[0])));
    }
    return value;
}

// F_y, F_z [N] of the side force without noise, eps_y, eps_z [-] and y, z [m] in all.
static inline void dense_motor_across(const ld_motor *motor, double since, double across[6])
{
    const ld_side_force *side = &motor->side_force;
    double y = dense_motor_column(motor, &side->force, 1, since),
           z = dense_motor_column(motor, &side->force, 2, since);
    double size = side->scale * hypot(y, z), direction = atan2(z, y) + side->angle;
    across[0] = size * cos(direction);
    across[1] = size * sin(direction);
    for (size_t i = 0; i < 4; i++)
        across[2 + i] = dense_motor_column(motor, &motor->nozzle, 1 + i, since) +
                        (i < 2 ? motor->misalignment[i] : motor->at[i - 1]);
}

// The first corner of a table after `since`; infinity.
static inline double dense_motor_corner(const ld_motor *motor, double since)
{
    const ld_side_force *side = &motor->side_force;
    const ld_table *const table[] = {&motor->thrust, &side->force, &motor->nozzle};
    double next = INFINITY;
    for (int k = 0; k < 3; k++)
        for (size_t i = 0; i < table[k]->rows; i++) {
            double t = dense_motor_clock(motor, table[k]->data[i * table[k]->columns]);
            next = t > since ? fmin(next, t) : next;
        }
    return next;
}

#endif
