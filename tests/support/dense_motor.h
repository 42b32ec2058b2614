// What a motor does across its axis and when, for the independent programs: from the model's tables
// alone.
#ifndef LD_TESTS_SUPPORT_DENSE_MOTOR_H
#define LD_TESTS_SUPPORT_DENSE_MOTOR_H

#include <math.h>

#include "model/blocks/rocket.h"

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

// Whether it burns `since` ignition.
static inline bool dense_motor_burns(const ld_motor *motor, double since)
{
    size_t rows = motor->thrust.rows;
    return rows > 0 && since >= motor->delay &&
           since < dense_motor_clock(motor, motor->thrust.data[2 * (rows - 1)]);
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

// A curve of thrust in seconds after ignition.
typedef struct dense_curve {
    const ld_table *table;
    const ld_motor *motor; // whose clock the table has; NULL: scaled and delayed alone
    double scale, delay, factor;
} dense_curve;

// Motor k of a rocket: 0 the first, then the further ones.
static inline dense_curve dense_curve_of(const ld_rocket *rocket, int k)
{
    if (k == 0)
        return (dense_curve){&rocket->motor.thrust, &rocket->motor, 0, 0,
                             rocket->motor.thrust_scale};
    const ld_further_motor *further = &rocket->further_motor[k - 1];
    return (dense_curve){&further->thrust, NULL, further->time_scale, further->delay,
                         further->thrust_scale};
}

static inline double dense_curve_time(const dense_curve *curve, size_t row)
{
    double t = curve->table->data[2 * row];
    return curve->motor ? dense_motor_clock(curve->motor, t) : curve->delay + curve->scale * t;
}

// Thrust [N] `since` ignition, on the line that holds `middle`; the impulse so far and in all.
static inline double dense_curve_at(const dense_curve *curve, double since, double middle,
                                    double impulse[2])
{
    double thrust = 0;
    impulse[0] = impulse[1] = 0;
    for (size_t i = 0; i + 1 < curve->table->rows; i++) {
        double t0 = dense_curve_time(curve, i), t1 = dense_curve_time(curve, i + 1);
        double T0 = curve->factor * curve->table->data[2 * i + 1],
               T1 = curve->factor * curve->table->data[2 * i + 3];
        if (t1 == t0)
            continue;
        double now = T0 + (T1 - T0) * (since - t0) / (t1 - t0);
        double in = fmin(fmax((since - t0) / (t1 - t0), 0), 1);
        if (middle >= t0 && middle < t1)
            thrust = now;
        impulse[0] += (t1 - t0) * in * (T0 + (T1 - T0) * in / 2);
        impulse[1] += (t1 - t0) * (T0 + T1) / 2;
    }
    return thrust;
}

// When the last motor is out.
static inline double dense_burn_out(const ld_rocket *rocket)
{
    double end = -INFINITY;
    for (int k = 0; k <= rocket->further_motor_count; k++) {
        dense_curve curve = dense_curve_of(rocket, k);
        if (curve.table->rows > 0)
            end = fmax(end, dense_curve_time(&curve, curve.table->rows - 1));
    }
    return end;
}

// The first corner of a further motor after `since`; infinity.
static inline double dense_further_corner(const ld_rocket *rocket, double since)
{
    double next = INFINITY;
    for (int k = 1; k <= rocket->further_motor_count; k++) {
        dense_curve curve = dense_curve_of(rocket, k);
        for (size_t i = 0; i < curve.table->rows; i++) {
            double t = dense_curve_time(&curve, i);
            next = t > since ? fmin(next, t) : next;
        }
    }
    return next;
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
