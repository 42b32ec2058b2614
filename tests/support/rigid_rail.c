#include "support/rigid_rail.h"

#include "math/matrices/lapack.h"
#include "model/model.h"
#include <math.h>

#include "math/vectors/quaternion.h"
#include "support/dense_flight.h"
#include "support/dense_simulation.h"

// Body: O1 and attitude in I, speeds of O1 in I and of turning in B.
typedef struct body_state {
    v3 r, v, w;
    quat q;
} body_state;

// The base's frame with rates and accelerations, in I.
typedef struct moving_frame {
    v3 r, v, a, w, alpha;
    m3 A;
} moving_frame;

// A point of the rocket that keeps its coordinate along an axis of the base.
typedef struct row {
    v3 point; // [m] in B
    int axis;
} row;

enum { LOCK, REAR_Y, REAR_Z, ROLL, FRONT_Y, FRONT_Z, ROWS };

typedef struct rail_run {
    const ld_model *model;
    row row[ROWS];
    bool held[ROWS];
} rail_run;

static void frame_values(const ld_model *model, double t, moving_frame *frame)
{
    dense_base base;
    dense_base_at(model, t, &base);
    frame->r = v3_from(base.r);
    frame->v = v3_from(base.v);
    frame->w = v3_from(base.w);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            frame->A.a[i][j] = base.A[i][j];
}

// Accelerations by five-point differences of the rates.
static moving_frame frame_at(const ld_model *model, double t)
{
    const double h = 2e-3, weight[4] = {1, -8, 8, -1}, at[4] = {-2, -1, 1, 2};
    moving_frame frame, beside;
    frame_values(model, t, &frame);
    frame.a = frame.alpha = v3_zero();
    for (int i = 0; i < 4; i++) {
        frame_values(model, t + at[i] * h, &beside);
        frame.a = v3_axpy(frame.a, weight[i] / (12 * h), beside.v);
        frame.alpha = v3_axpy(frame.alpha, weight[i] / (12 * h), beside.w);
    }
    return frame;
}

// Accelerations of O1 (I) and of turning (B), and the multipliers.
static void accelerate(const rail_run *run, double t, double middle, const body_state *x, v3 *a,
                       v3 *w_dot, double multiplier[ROWS])
{
    const ld_motor *motor = &run->model->rocket.motor;
    dense_conditions on;
    dense_rocket_at(run->model, t, middle, &on);
    dense_air_at(run->model, &on);
    moving_frame base = frame_at(run->model, t);
    m3 A = q_matrix(x->q);
    double matrix[(6 + ROWS) * (6 + ROWS)] = {0}, right[6 + ROWS] = {0};
    int size = 6, place[ROWS];
    for (int k = 0; k < ROWS; k++)
        place[k] = run->held[k] ? size++ : -1;
    // momentum, and angular momentum about O1 in B: forces F at O1, moments M about it
    v3 c = v3_from(on.center), w = x->w, g = v3_make(0, -run->model->gravity, 0);
    v3 thrust = v3_make(1, motor->misalignment[0], motor->misalignment[1]);
    thrust = v3_scale(on.thrust / v3_norm(thrust), thrust);
    v3 weight = v3_scale(on.mass, m3_apply_transposed(A, g));
    v3 swing = v3_scale(on.mass, v3_cross(w, v3_cross(w, c))), L = {0, 0, 0};
    double J[3][3], C[3] = {c.x, c.y, c.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double product = i == j ? on.inertia[i] : on.products[i + j - 1];
            J[i][j] = product + on.mass * ((i == j) * v3_dot(c, c) - C[i] * C[j]);
        }
    L = v3_make(J[0][0] * w.x + J[0][1] * w.y + J[0][2] * w.z,
                J[1][0] * w.x + J[1][1] * w.y + J[1][2] * w.z,
                J[2][0] * w.x + J[2][1] * w.y + J[2][2] * w.z);
    v3 force = v3_sub(v3_add(thrust, weight), swing);
    v3 moment = v3_add(v3_cross(v3_from(motor->at), thrust), v3_cross(c, weight));
    moment = v3_sub(moment, v3_cross(w, L));
    if (run->model->rocket.aerodynamics.present) {
        v3 slip = v3_sub(v3_add(x->v, m3_apply(A, v3_cross(w, c))), v3_from(on.air));
        dense_wrench air = dense_air(run->model, on.power, c, m3_apply_transposed(A, slip), w,
                                     on.density, on.sound);
        force = v3_add(force, air.f);
        moment = v3_add(moment, v3_add(air.m, v3_cross(c, air.f)));
    }
    v3_store(right, force);
    v3_store(right + 3, moment);
    for (int i = 0; i < 3; i++) { // unknowns: a in B, w_dot in B
        v3 unit = v3_make(i == 0, i == 1, i == 2);
        v3 by_a = v3_scale(on.mass, v3_cross(c, unit)), by_w = v3_neg(by_a);
        double column[3];
        matrix[i * size + i] = on.mass;
        v3_store(column, by_a);
        for (int j = 0; j < 3; j++)
            matrix[i * size + 3 + j] = column[j];
        v3_store(column, by_w);
        for (int j = 0; j < 3; j++) {
            matrix[(3 + i) * size + j] = column[j];
            matrix[(3 + i) * size + 3 + j] = J[j][i];
        }
    }
    // rows: second derivative of e . d, d from the base's origin to the point
    for (int k = 0; k < ROWS; k++) {
        if (!run->held[k])
            continue;
        v3 p = run->row[k].point, e = m3_column(base.A, run->row[k].axis);
        v3 d = v3_sub(v3_add(x->r, m3_apply(A, p)), base.r);
        v3 d_dot = v3_sub(v3_add(x->v, m3_apply(A, v3_cross(w, p))), base.v);
        v3 e_dot = v3_cross(base.w, e);
        v3 e_ddot = v3_add(v3_cross(base.alpha, e), v3_cross(base.w, e_dot));
        v3 known = v3_sub(m3_apply(A, v3_cross(w, v3_cross(w, p))), base.a), e_B;
        e_B = m3_apply_transposed(A, e);
        double by[6];
        v3_store(by, e_B);
        v3_store(by + 3, v3_cross(p, e_B));
        for (int i = 0; i < 6; i++) {
            matrix[i * size + place[k]] = by[i];
            matrix[place[k] * size + i] = -by[i];
        }
        right[place[k]] = -v3_dot(e_ddot, d) - 2 * v3_dot(e_dot, d_dot) - v3_dot(e, known);
    }
    lapack_int pivot[6 + ROWS];
    LAPACKE_dgesv(LAPACK_COL_MAJOR, size, 1, matrix, size, pivot, right, size);
    *a = m3_apply(A, v3_from(right));
    *w_dot = v3_from(right + 3);
    for (int k = 0; k < ROWS; k++)
        multiplier[k] = run->held[k] ? right[place[k]] : 0;
}

static body_state moved(const body_state *x, double h, const body_state *rate)
{
    body_state y = {v3_axpy(x->r, h, rate->r),
                    v3_axpy(x->v, h, rate->v),
                    v3_axpy(x->w, h, rate->w),
                    {x->q.w + h * rate->q.w, x->q.x + h * rate->q.x, x->q.y + h * rate->q.y,
                     x->q.z + h * rate->q.z}};
    return y;
}

static body_state advance(const rail_run *run, double t, double h, double middle,
                          const body_state *x)
{
    static const double part[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
    body_state rate = {0}, y = *x;
    double multiplier[ROWS];
    for (int i = 0; i < 4; i++) {
        body_state there = moved(x, part[i] * h, &rate);
        rate.r = there.v;
        rate.q = q_rate(there.q, there.w);
        accelerate(run, t + part[i] * h, middle, &there, &rate.v, &rate.w, multiplier);
        y = moved(&y, weight[i] * h / 6, &rate);
    }
    return y;
}

// Station of a point of the rocket's axis on the rail.
static double station(const rail_run *run, double t, const body_state *x, double along)
{
    moving_frame base;
    frame_values(run->model, t, &base);
    v3 place = v3_add(x->r, m3_apply(q_matrix(x->q), v3_make(along, 0, 0)));
    return v3_dot(m3_column(base.A, 0), v3_sub(place, base.r));
}

// Positive once the next thing has happened: the lock releases, the front shoe leaves, the rear
// one.
static double happened(const rail_run *run, int phase, double t, double middle, const body_state *x)
{
    const ld_rocket *rocket = &run->model->rocket;
    if (phase > 0) {
        const ld_adaptor *next = &rocket->adaptor[2 - phase];
        double end = next->leaves_at > 0 ? next->leaves_at : run->model->tubes.length;
        return station(run, t, x, next->at) - end;
    }
    v3 a, w_dot;
    double multiplier[ROWS];
    accelerate(run, t, middle, x, &a, &w_dot, multiplier);
    return -multiplier[LOCK] - rocket->lock.release_force;
}

static void set_rows(rail_run *run)
{
    double front = run->model->rocket.adaptor[1].at;
    for (int k = 0; k < ROWS; k++) {
        bool ahead = k == FRONT_Y || k == FRONT_Z;
        run->row[k].point = v3_make(ahead ? front : 0, 0, k == ROLL ? 1 : 0);
        run->row[k].axis = k == LOCK ? 0 : k == REAR_Z || k == FRONT_Z ? 2 : 1;
        run->held[k] = true; // the lock holds roll
    }
}

static void place_on_rail(const rail_run *run, const double line[2], body_state *x)
{
    moving_frame base;
    frame_values(run->model, 0, &base);
    v3 d = m3_apply(base.A, v3_make(run->model->rocket.start_at, line[0], line[1]));
    x->r = v3_add(base.r, d);
    x->v = v3_add(base.v, v3_cross(base.w, d));
    x->w = m3_apply_transposed(base.A, base.w);
    x->q = q_from_matrix(base.A);
}

static void note_front(rail_run *run, double t, double middle, const body_state *x,
                       rigid_exit *exit)
{
    v3 a, w_dot;
    double multiplier[ROWS];
    accelerate(run, t, middle, x, &a, &w_dot, multiplier);
    for (int i = 0; i < 2; i++) {
        exit->front_force[i] = multiplier[FRONT_Y + i];
        exit->rear_force[i] = multiplier[REAR_Y + i] + (i == 0 ? multiplier[ROLL] : 0);
    }
    run->held[FRONT_Y] = run->held[FRONT_Z] = false;
    accelerate(run, t, middle, x, &a, &w_dot, multiplier);
    for (int i = 0; i < 2; i++)
        exit->pivot_force[i] = multiplier[REAR_Y + i] + (i == 0 ? multiplier[ROLL] : 0);
    exit->roll_moment = -multiplier[ROLL];
}

static void note_exit(const rail_run *run, double t, const body_state *x, rigid_exit *exit)
{
    moving_frame base;
    frame_values(run->model, t, &base);
    v3 arm = v3_sub(x->r, base.r), e = m3_column(base.A, 0);
    v3 slip = v3_sub(v3_sub(x->v, base.v), v3_cross(base.w, arm));
    m3 A = q_matrix(x->q);
    v3 d = m3_column(A, 0), d_dot = m3_apply(A, v3_cross(x->w, v3_make(1, 0, 0)));
    double level = hypot(d.x, d.z);
    exit->t_rear = t;
    exit->exit_speed = v3_dot(e, slip);
    exit->pitch = atan2(d.y, level);
    exit->yaw = atan2(-d.z, d.x);
    exit->pitch_rate = d_dot.y / level;
    exit->yaw_rate = (d.z * d_dot.x - d.x * d_dot.z) / (level * level);
    exit->spin_rate = x->w.x;
}

bool rigid_rail_launch(const ld_model *model, const double line[2], bool holds_roll, double step,
                       rigid_exit *exit)
{
    rail_run run = {.model = model};
    const ld_table *thrust = &model->rocket.motor.thrust;
    body_state x;
    int phase = 0;
    double t = 0;
    set_rows(&run);
    place_on_rail(&run, line, &x);
    while (t < model->run.stuck_time) {
        double h = step;
        for (size_t i = 0; i < thrust->rows; i++)
            if (thrust->data[2 * i] > t + 1e-12)
                h = fmin(h, thrust->data[2 * i] - t);
        double middle = t + 0.5 * h, low = 0, high = h;
        body_state next = advance(&run, t, h, middle, &x);
        bool event = happened(&run, phase, t + h, middle, &next) > 0;
        for (int i = 0; event && i < 60; i++) { // by halves
            double trial = 0.5 * (low + high);
            next = advance(&run, t, trial, middle, &x);
            *(happened(&run, phase, t + trial, middle, &next) > 0 ? &high : &low) = trial;
        }
        x = next;
        t += event ? high : h;
        if (!event)
            continue;
        if (phase == 0) {
            exit->t_release = t;
            run.held[LOCK] = false;
            run.held[ROLL] = holds_roll;
        } else if (phase == 1) {
            exit->t_front = t;
            note_front(&run, t, middle, &x, exit);
        } else {
            note_exit(&run, t, &x, exit);
            return true;
        }
        phase++;
    }
    return false;
}
