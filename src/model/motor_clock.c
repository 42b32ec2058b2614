#include "model/motor_clock.h"

#include <math.h>

double motor_rise_time(const ld_motor *motor)
{
    const ld_table *thrust = &motor->thrust;
    double greatest = 0;
    size_t k = 0;
    for (size_t i = 0; i < thrust->rows; i++)
        greatest = fmax(greatest, thrust->data[i * thrust->columns + 1]);
    while (k < thrust->rows && thrust->data[k * thrust->columns + 1] < MOTOR_RISE * greatest)
        k++;
    return k < thrust->rows ? thrust->data[k * thrust->columns] : 0;
}

double motor_clock(const ld_motor *motor, double t)
{
    double rise = motor->rise_scale == 1 ? t : fmin(t, motor_rise_time(motor));
    return (t + (motor->rise_scale - 1) * rise) * motor->time_scale + motor->delay;
}

double further_motor_clock(const ld_further_motor *motor, double t)
{
    return t * motor->time_scale + motor->delay;
}
