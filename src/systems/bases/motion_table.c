#include "systems/bases/motion_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/curves/spline.h"

static const double TURN = 6.283185307179586476925286766559;

// The rows' angles.
static bool find_angles(motion_table *self)
{
    size_t n = self->rows.coordinates;
    self->angles = malloc(3 * self->rows.count * sizeof *self->angles);
    for (size_t i = 0; i < self->rows.count && self->angles; i++) {
        m3 A = q_matrix(q_from(self->rows.at + i * n + 3));
        m3_yaw_pitch_roll(&A, self->angles + 3 * i);
    }
    for (size_t k = 0; k < 3 && self->angles; k++)
        motion_unwrap(self->rows.count, 3, self->angles + k);
    return self->angles;
}

// Coordinate k of all rows, one after the other.
static void take_column(const motion_rows *rows, size_t k, double *column)
{
    for (size_t i = 0; i < rows->count; i++)
        column[i] = rows->at[i * rows->coordinates + k];
}

static ld_status build_pieces(motion_table *self, double *column, ld_error *error)
{
    size_t n = self->rows.coordinates;
    ld_status status = LD_OK;
    for (size_t k = 0; k < n && !status; k++) {
        spline path;
        take_column(&self->rows, k, column);
        status = spline_build(&path, self->rows.count, self->rows.t, column, error);
        for (size_t i = 0; i + 1 < self->rows.count && !status; i++)
            memcpy(self->piece + 4 * (i * n + k), path.coefficient + 4 * i, 4 * sizeof(double));
        if (!status)
            spline_free(&path);
    }
    return status;
}

ld_status motion_table_build(motion_table *self, const ld_base *model, ld_error *error)
{
    size_t count = model->motion.rows;
    *self = (motion_table){0};
    if (count == 0)
        return LD_OK;
    bool taken = motion_rows_take(&self->rows, model, 0, count);
    self->turned = self->rows.coordinates == MOTION_QUATERNION;
    self->piece = malloc(4 * self->rows.coordinates * count * sizeof *self->piece);
    double *column = malloc(count * sizeof *column);
    ld_status status = LD_OK;
    if (!taken || !self->piece || !column || (self->turned && !find_angles(self)))
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for a motion of %zu rows", count);
    else
        status = build_pieces(self, column, error);
    free(column);
    if (status)
        motion_table_free(self);
    return status;
}

void motion_table_free(motion_table *self)
{
    motion_rows_free(&self->rows);
    free(self->piece);
    free(self->angles);
    *self = (motion_table){0};
}

// The row before t, of those that begin a piece.
static size_t row_before(const motion_table *self, double t)
{
    size_t low = 0, high = self->rows.count - 1;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (t >= self->rows.t[middle])
            low = middle;
        else
            high = middle;
    }
    return low;
}

// Adds value, rate and acceleration of all coordinates.
static void add_pieces(const motion_table *self, double t, double *x, double *u, double *a)
{
    size_t n = self->rows.coordinates, i = row_before(self, t);
    const double *c = self->piece + 4 * i * n;
    double s = t - self->rows.t[i];
    for (size_t k = 0; k < n; k++, c += 4) {
        x[k] += c[0] + s * (c[1] + s * (c[2] + s * c[3]));
        u[k] += c[1] + s * (2 * c[2] + s * 3 * c[3]);
        a[k] += 2 * c[2] + s * 6 * c[3];
    }
}

void motion_table_add(const motion_table *self, double t, double x[6], double u[6], double a[6])
{
    if (!self->turned) {
        if (self->rows.count)
            add_pieces(self, t, x, u, a);
        return;
    }
    double p[MOTION_QUATERNION] = {0}, v[MOTION_QUATERNION] = {0}, b[MOTION_QUATERNION] = {0};
    add_pieces(self, t, p, v, b);
    m3 A = q_matrix(q_from(p + 3));
    double angles[3];
    m3_yaw_pitch_roll(&A, angles);
    const double *near = self->angles + 3 * row_before(self, t);
    for (int k = 0; k < 3; k++) {
        x[k] += p[k];
        u[k] += v[k];
        a[k] += b[k];
        // of all turns that of the row before
        x[3 + k] += angles[k] + TURN * round((near[k] - angles[k]) / TURN);
    }
}

// Of a quaternion Q of any length, which the spline's is not between its rows: w = 2 vec(Q' Q^-1),
// w' = 2 vec(Q'' Q^-1) - 2 (Q . Q')/|Q|^2 w, since vec of a square is 2 scalar times vec.
void motion_table_place(const motion_table *self, double t, const m3 *mount, base_frame *tube)
{
    double x[MOTION_QUATERNION] = {0}, u[MOTION_QUATERNION] = {0}, a[MOTION_QUATERNION] = {0};
    add_pieces(self, t, x, u, a);
    quat Q = q_from(x + 3), rate = q_from(u + 3), second = q_from(a + 3);
    double square = Q.w * Q.w + Q.x * Q.x + Q.y * Q.y + Q.z * Q.z;
    quat inverse = {Q.w / square, -Q.x / square, -Q.y / square, -Q.z / square};
    quat first = q_multiply(rate, inverse), next = q_multiply(second, inverse);
    tube->r = v3_from(x);
    tube->v = v3_from(u);
    tube->a = v3_from(a);
    tube->A = m3_mul(q_matrix(Q), *mount);
    tube->q = q_from_matrix(tube->A);
    tube->w = v3_make(2 * first.x, 2 * first.y, 2 * first.z);
    tube->alpha = v3_axpy(v3_make(2 * next.x, 2 * next.y, 2 * next.z), -2 * first.w, tube->w);
}
