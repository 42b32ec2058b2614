#include "elements/motor.h"

#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/masses.h"
#include "model/motor_clock.h"

// The shortest rotation of x onto (1, y, z): of columns in the turned axes to B.
static m3 rotation_onto(double y, double z)
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
        m3 turn = rotation_onto(delta[0], delta[1]);
        mass.J = m3_mul(m3_mul(turn, mass.J), m3_transpose(turn));
    }
    return mass;
}

static rocket_mass mass_between(const rocket_mass *a, const rocket_mass *b, double share)
{
    rocket_mass out = *a;
    out.m += share * (b->m - a->m);
    out.c = v3_axpy(a->c, share, v3_sub(b->c, a->c));
    out.J = m3_add(a->J, m3_scale(share, m3_sub(b->J, a->J)));
    return out;
}

// The mass data at a time, unscaled, from ignition.
static rocket_mass masses_in_table(const ld_rocket *rocket, double t)
{
    const ld_table *table = &rocket->motor.masses;
    size_t k = 0;
    while (k < table->rows && table->data[k * table->columns] <= t)
        k++;
    ld_mass_data after = masses_at(rocket, k < table->rows ? k : table->rows - 1);
    ld_mass_data before = masses_at(rocket, k > 0 ? k - 1 : 0);
    rocket_mass first = mass_of(rocket, &before), last = mass_of(rocket, &after);
    if (k == 0 || k == table->rows)
        return last;
    double t0 = table->data[(k - 1) * table->columns], t1 = table->data[k * table->columns];
    return mass_between(&first, &last, (t - t0) / (t1 - t0));
}

// What a stand measured below 0 counts as 0.
static double pushing(double thrust)
{
    return thrust < 0 ? 0 : thrust;
}

// The tables over time besides the thrust, whose rows are corners, too.
enum { FURTHER_TABLES = 4 };
typedef struct further_rows {
    const ld_table *table[FURTHER_TABLES];
    size_t row[FURTHER_TABLES]; // the next of each
} further_rows;

static further_rows further_rows_of(const ld_motor *given)
{
    const ld_side_force *side = &given->side_force;
    return (further_rows){{&given->masses, &side->force, &side->noise.deviation, &given->nozzle},
                          {0}};
}

// The time of the next row; infinity after the last.
static double next_row(const further_rows *self)
{
    double t = INFINITY;
    for (int i = 0; i < FURTHER_TABLES; i++) {
        const ld_table *table = self->table[i];
        if (self->row[i] < table->rows)
            t = fmin(t, table->data[self->row[i] * table->columns]);
    }
    return t;
}

static void pass_row(further_rows *self, double t)
{
    for (int i = 0; i < FURTHER_TABLES; i++) {
        const ld_table *table = self->table[i];
        self->row[i] +=
            self->row[i] < table->rows && table->data[self->row[i] * table->columns] == t;
    }
}

// Corners of the thrust, and the rows of other tables that lie between them; unscaled.
static void find_corners(motor *self, const ld_motor *given)
{
    const ld_table *thrust = &given->thrust;
    further_rows others = further_rows_of(given);
    size_t n = 0;
    for (size_t i = 0; i < thrust->rows; i++) {
        const double *now = &thrust->data[i * thrust->columns];
        double force = pushing(now[1]), before = i > 0 ? pushing(now[-1]) : 0;
        for (double t = next_row(&others); t <= now[0]; t = next_row(&others)) {
            pass_row(&others, t);
            if (i == 0 || t == now[0])
                continue;
            self->t[n] = t;
            self->thrust[n++] = before + (force - before) * (t - now[-2]) / (now[0] - now[-2]);
        }
        self->t[n] = now[0];
        self->thrust[n++] = force;
    }
    self->corner_count = n;
}

// Column `column` of a table over time: linear, constant outside; 0 without rows.
static double column_at(const ld_table *table, int column, double t)
{
    size_t width = table->columns, k = 0;
    if (table->rows == 0)
        return 0;
    while (k < table->rows && table->data[k * width] <= t)
        k++;
    if (k == 0 || k == table->rows)
        return table->data[(k ? k - 1 : 0) * width + (size_t)column];
    const double *a = table->data + (k - 1) * width, *b = a + width;
    return a[column] + (b[column] - a[column]) * (t - a[0]) / (b[0] - a[0]);
}

// What is across the axis at a time, unscaled, from ignition.
static void find_across(const ld_motor *given, double t, double across[ACROSS_COUNT])
{
    const ld_side_force *side = &given->side_force;
    double y = column_at(&side->force, 1, t), z = column_at(&side->force, 2, t);
    double c = side->scale * cos(side->angle), s = side->scale * sin(side->angle);
    across[ACROSS_FORCE] = c * y - s * z;
    across[ACROSS_FORCE + 1] = s * y + c * z;
    across[ACROSS_DEVIATION] = side->scale * column_at(&side->noise.deviation, 1, t);
    for (int i = 0; i < 4; i++)
        across[ACROSS_LEAN + i] = column_at(&given->nozzle, 1 + i, t);
}

static ld_status build_across(motor *self, const ld_motor *given, int place, ld_error *error)
{
    const ld_side_noise *noise = &given->side_force.noise;
    self->across = calloc((self->corner_count + 1) * ACROSS_COUNT, sizeof(double));
    if (!self->across)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the side force");
    for (size_t k = 0; k < self->corner_count; k++)
        find_across(given, self->t[k], self->across + k * ACROSS_COUNT);
    return noise->present ? side_noise_build(&self->noise, noise, place, error) : LD_OK;
}

// Room for the corners; freed by motor_free().
static ld_status make_room(motor *self, size_t most, bool by_table, ld_error *error)
{
    self->t = malloc((3 * most + 1) * sizeof(double));
    self->at = by_table ? malloc((most + 1) * sizeof *self->at) : NULL;
    if (!self->t || (by_table && !self->at)) {
        motor_free(self);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the thrust table");
    }
    self->thrust = self->t + most;
    self->impulse = self->t + 2 * most;
    return LD_OK;
}

static void sum_impulse(motor *self)
{
    for (size_t k = 0; k < self->corner_count; k++)
        self->impulse[k] =
            k == 0 ? 0
                   : self->impulse[k - 1] + 0.5 * (self->thrust[k] + self->thrust[k - 1]) *
                                                (self->t[k] - self->t[k - 1]);
}

// The motor alone.
static ld_status build_alone(motor *self, const ld_rocket *rocket, int place, ld_error *error)
{
    const ld_motor *given = &rocket->motor;
    const ld_side_force *side = &given->side_force;
    size_t most = given->thrust.rows + given->masses.rows + side->force.rows +
                  side->noise.deviation.rows + given->nozzle.rows;
    bool by_table = given->masses.rows > 0;
    *self = (motor){.propellant = rocket->propellant};
    self->full = mass_of(rocket, &rocket->full);
    self->empty = mass_of(rocket, &rocket->empty);
    if (make_room(self, most, by_table, error))
        return LD_ERR_MEMORY;
    find_corners(self, given);
    if ((side->present || given->nozzle.rows > 0) && build_across(self, given, place, error)) {
        motor_free(self);
        return LD_ERR_MEMORY;
    }
    for (size_t k = 0; k < self->corner_count; k++) {
        if (by_table)
            self->at[k] = masses_in_table(rocket, self->t[k]);
        self->t[k] = motor_clock(given, self->t[k]);
        self->thrust[k] *= given->thrust_scale;
    }
    sum_impulse(self);
    return LD_OK;
}

// ---- further motors

static bool burning(const motor *self, int piece)
{
    return piece >= 0 && piece + 1 < (int)self->corner_count;
}

// Just before a time, or just after.
typedef enum time_side { BEFORE, AFTER } time_side;

// Thrust of all and what is beside it at a corner.
typedef struct corner {
    double thrust, across[ACROSS_COUNT];
} corner;

static bool is_past(double t, double from, time_side side)
{
    return side == AFTER ? t >= from : t > from;
}

// Where t lies between two corners, from 0 to 1; 1 at the second to the bit.
static double share_of(double t, double from, double to)
{
    return t == to ? 1 : (t - from) / (to - from);
}

static double between(double a, double b, double share)
{
    return share == 1 ? b : a + share * (b - a);
}

static void add_alone(const motor *alone, double t, time_side side, corner *out)
{
    int piece = -1;
    while (piece + 1 < (int)alone->corner_count && is_past(t, alone->t[piece + 1], side))
        piece++;
    if (!burning(alone, piece))
        return;
    double share = share_of(t, alone->t[piece], alone->t[piece + 1]);
    out->thrust += between(alone->thrust[piece], alone->thrust[piece + 1], share);
    if (!alone->across)
        return;
    const double *a = alone->across + (size_t)piece * ACROSS_COUNT, *b = a + ACROSS_COUNT;
    for (int i = 0; i < ACROSS_COUNT; i++)
        out->across[i] += between(a[i], b[i], share);
}

static void add_further(const ld_further_motor *one, double t, time_side side, corner *out)
{
    const ld_table *table = &one->thrust;
    size_t k = 0; // the row after
    while (k < table->rows && is_past(t, further_motor_clock(one, table->data[2 * k]), side))
        k++;
    if (k == 0 || k == table->rows)
        return;
    const double *a = table->data + 2 * (k - 1), *b = a + 2;
    double share = share_of(t, further_motor_clock(one, a[0]), further_motor_clock(one, b[0]));
    double thrust = one->thrust_scale * between(pushing(a[1]), pushing(b[1]), share);
    v3 direction = {1, one->misalignment[0], one->misalignment[1]};
    v3 force = v3_scale(thrust / v3_norm(direction), direction);
    v3 moment = v3_cross(v3_from(one->at), force);
    out->thrust += thrust;
    out->across[ACROSS_OTHERS] += thrust;
    v3_store(out->across + ACROSS_OTHERS_FORCE,
             v3_add(v3_from(out->across + ACROSS_OTHERS_FORCE), force));
    v3_store(out->across + ACROSS_OTHERS_MOMENT,
             v3_add(v3_from(out->across + ACROSS_OTHERS_MOMENT), moment));
}

static corner corner_at(const motor *alone, const ld_rocket *rocket, double t, time_side side)
{
    corner out = {0};
    add_alone(alone, t, side, &out);
    for (int i = 0; i < rocket->further_motor_count; i++)
        add_further(&rocket->further_motor[i], t, side, &out);
    return out;
}

static bool is_same(const corner *a, const corner *b)
{
    bool same = a->thrust == b->thrust;
    for (int i = 0; i < ACROSS_COUNT; i++)
        same = same && a->across[i] == b->across[i];
    return same;
}

// Mass data of all at t; the axes of the inertia are turned as those at ignition.
static rocket_mass masses_of_all(const ld_rocket *rocket, double t)
{
    const double *delta = rocket->dynamic_imbalance;
    rocket_mass out = mass_of(rocket, &rocket->full);
    m3 turn = rotation_onto(delta[0], delta[1]);
    m3 grown = masses_of_parts(rocket, t, &out.m, &out.c);
    out.m += rocket->mass_error;
    out.c.y += rocket->eccentricity[0];
    out.c.z += rocket->eccentricity[1];
    out.J = m3_add(out.J, m3_mul(m3_mul(turn, grown), m3_transpose(turn)));
    return out;
}

static int compare_times(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// All corners' times, in order; returns how many. `t` NULL: counts alone.
static size_t gather_times(const motor *alone, const ld_rocket *rocket, double *t)
{
    size_t n = 0;
    for (size_t k = 0; k < alone->corner_count; k++, n++)
        if (t)
            t[n] = alone->t[k];
    for (int i = 0; i < rocket->further_motor_count; i++) {
        const ld_further_motor *one = &rocket->further_motor[i];
        const ld_table *const table[] = {&one->thrust, &one->masses};
        for (int j = 0; j < 2; j++)
            for (size_t k = 0; k < table[j]->rows; k++, n++)
                if (t)
                    t[n] = further_motor_clock(one, table[j]->data[k * table[j]->columns]);
    }
    if (t)
        qsort(t, n, sizeof *t, compare_times);
    return n;
}

static void put_corner(motor *self, double t, const corner *now)
{
    self->t[self->corner_count] = t;
    self->thrust[self->corner_count] = now->thrust;
    memcpy(self->across + self->corner_count * ACROSS_COUNT, now->across, sizeof now->across);
    self->corner_count++;
}

// Puts the further motors to what the first is alone. A time at which something jumps has two
// corners; what begins and what ends all has one.
static ld_status join_further(motor *self, const ld_rocket *rocket, ld_error *error)
{
    motor alone = *self;
    size_t count = gather_times(&alone, rocket, NULL);
    double *t = malloc(count * sizeof *t);
    self->t = NULL;
    self->at = NULL;
    self->corner_count = 0;
    self->across = calloc(2 * count * ACROSS_COUNT, sizeof(double));
    ld_status status = t && self->across ? make_room(self, 2 * count, alone.at != NULL, error)
                                         : ld_fail(error, LD_ERR_MEMORY, "no memory for motors");
    if (!status)
        gather_times(&alone, rocket, t);
    for (size_t k = 0; k < count && !status; k++) {
        if (k > 0 && t[k] == t[k - 1])
            continue;
        corner before = corner_at(&alone, rocket, t[k], BEFORE),
               after = corner_at(&alone, rocket, t[k], AFTER);
        if (t[k] > t[0] && (t[k] == t[count - 1] || !is_same(&before, &after)))
            put_corner(self, t[k], &before);
        if (t[k] < t[count - 1])
            put_corner(self, t[k], &after);
    }
    for (size_t k = 0; alone.at && k < self->corner_count; k++)
        self->at[k] = masses_of_all(rocket, self->t[k]);
    sum_impulse(self);
    free(t);
    free(alone.t);
    free(alone.at);
    free(alone.across);
    return status;
}

ld_status motor_build(motor *self, const ld_rocket *rocket, int place, ld_error *error)
{
    ld_status status = build_alone(self, rocket, place, error);
    if (!status && rocket->further_motor_count > 0 && !rocket->motor.absent)
        status = join_further(self, rocket, error);
    if (status)
        motor_free(self);
    for (size_t k = 0; k < self->corner_count; k++)
        self->greatest = fmax(self->greatest, self->thrust[k]);
    return status;
}

void motor_free(motor *self)
{
    free(self->t);
    free(self->at);
    free(self->across);
    side_noise_free(&self->noise);
    *self = (motor){0};
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

motor_across motor_across_at(const motor *self, int piece, double t)
{
    motor_across out = {0};
    if (!burning(self, piece))
        return out;
    const double *a = self->across + (size_t)piece * ACROSS_COUNT, *b = a + ACROSS_COUNT;
    double share = (t - self->t[piece]) / (self->t[piece + 1] - self->t[piece]), now[ACROSS_COUNT];
    for (int i = 0; i < ACROSS_COUNT; i++)
        now[i] = a[i] + share * (b[i] - a[i]);
    if (a[ACROSS_DEVIATION] != 0 || b[ACROSS_DEVIATION] != 0)
        side_noise_at(&self->noise, t, out.force);
    out.others = now[ACROSS_OTHERS];
    out.others_force = v3_from(now + ACROSS_OTHERS_FORCE);
    out.others_moment = v3_from(now + ACROSS_OTHERS_MOMENT);
    for (int i = 0; i < 2; i++) {
        out.force[i] = now[ACROSS_FORCE + i] + now[ACROSS_DEVIATION] * out.force[i];
        out.lean[i] = now[ACROSS_LEAN + i];
        out.shift[i] = now[ACROSS_SHIFT + i];
    }
    return out;
}

// Between two corners of which the masses are known they go evenly in time.
static void mass_by_table(const motor *self, int piece, double t, rocket_mass *mass)
{
    *mass = self->at[piece < 0 ? 0 : piece];
    if (!burning(self, piece))
        return;
    const rocket_mass *next = &self->at[piece + 1];
    double rate = 1 / (self->t[piece + 1] - self->t[piece]);
    mass->m_dot = rate * (next->m - mass->m);
    mass->c_dot = v3_scale(rate, v3_sub(next->c, mass->c));
    mass->J_dot = m3_scale(rate, m3_sub(next->J, mass->J));
    *mass = mass_between(mass, next, rate * (t - self->t[piece]));
}

void motor_mass(const motor *self, int piece, double t, rocket_mass *mass)
{
    if (self->at) {
        mass_by_table(self, piece, t, mass);
        return;
    }
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

// With r from the mass centre c to the part's (mass p, inertia I), m' = m - p and f = m p/m':
//   c' = c - p/m' r,   J' = J - I - f (r^2 E - r r^T);   rates with r' = -c', p, I constant.
void rocket_mass_without(const ld_rocket *rocket, int i, rocket_mass *mass)
{
    const ld_falling *part = &rocket->adaptor[i].falls_off;
    if (!part->present)
        return;
    v3 at = {rocket->adaptor[i].at, part->center[0], part->center[1]};
    double m = mass->m, p = part->mass, rest = m - p;
    v3 r = v3_sub(at, mass->c), r_dot = v3_neg(mass->c_dot);
    double f = m * p / rest, f_dot = -p * p * mass->m_dot / (rest * rest);
    m3 across = m3_skew(r), turning = m3_skew(r_dot); // r^2 E - r r^T = -~r ~r
    m3 square = m3_scale(-1, m3_mul(across, across));
    m3 square_dot = m3_scale(-1, m3_add(m3_mul(turning, across), m3_mul(across, turning)));
    m3 own = m3_diagonal(part->inertia[0], part->inertia[1], part->inertia[2]);
    mass->J = m3_sub(m3_sub(mass->J, own), m3_scale(f, square));
    mass->J_dot = m3_sub(mass->J_dot, m3_add(m3_scale(f_dot, square), m3_scale(f, square_dot)));
    mass->c = v3_axpy(mass->c, -p / rest, r);
    // c' = c - p/m' r
    mass->c_dot =
        v3_axpy(v3_axpy(mass->c_dot, -p / rest, r_dot), p * mass->m_dot / (rest * rest), r);
    mass->m = rest;
}

static void drop_all(const ld_rocket *rocket, rocket_mass *mass)
{
    for (int i = 0; i < rocket->adaptor_count; i++)
        rocket_mass_without(rocket, i, mass);
}

void motor_without_falling(motor *self, const ld_rocket *rocket)
{
    drop_all(rocket, &self->full);
    drop_all(rocket, &self->empty);
    for (size_t k = 0; self->at && k < self->corner_count; k++)
        drop_all(rocket, &self->at[k]);
}
