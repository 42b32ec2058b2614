#include "support/dense_vehicle.h"

#include "math/matrices/lapack.h"
#include "model/model.h"
#include <stdlib.h>
#include <string.h>

static const double two_pi = 6.283185307179586476925;

// ---------------------------------------------------------------- masses

static void add_part(dense_vehicle *vehicle, int body, double mass, v3 center, m3 inertia)
{
    int n = vehicle->body[body].count++;
    dense_part *grown =
        realloc(vehicle->body[body].part, ((size_t)n + 1) * sizeof *vehicle->body[body].part);
    grown[n] = (dense_part){mass, center, inertia};
    vehicle->body[body].part = grown;
}

static m3 diagonal(const double J[3])
{
    return m3_diagonal(J[0], J[1], J[2]);
}

// Tube, guide rings and tail, rigid and straight, rear end at `rear` of the platform.
static void carry_tube(dense_vehicle *vehicle, v3 rear)
{
    const ld_tubes *tubes = &vehicle->model->tubes;
    for (int i = 0; i < tubes->section_count; i++) {
        const ld_section *section = &tubes->section[i];
        double end = i + 1 < tubes->section_count ? section[1].from : tubes->length;
        double length = end - section->from, mass = section->mass_per_length * length;
        double across = mass * length * length / 12;
        add_part(vehicle, DENSE_ELEVATION, mass,
                 v3_add(rear, v3_make(0.5 * (section->from + end), 0, 0)),
                 m3_diagonal(section->polar_inertia * length, across, across));
    }
    for (int i = 0; i < tubes->point_mass_count; i++)
        add_part(vehicle, DENSE_ELEVATION, tubes->point_mass[i].mass,
                 v3_add(rear, v3_make(tubes->point_mass[i].at, 0, 0)), m3_diagonal(0, 0, 0));
    add_part(vehicle, DENSE_ELEVATION, tubes->tail.mass,
             v3_add(rear, v3_make(tubes->tail.center, 0, 0)), diagonal(tubes->tail.inertia));
}

static void carry_rocket(dense_vehicle *vehicle, v3 rear)
{
    const ld_rocket *rocket = &vehicle->model->rocket;
    m3 J = diagonal(rocket->full.inertia);
    J.a[0][1] = J.a[1][0] = rocket->products[0];
    J.a[0][2] = J.a[2][0] = rocket->products[1];
    J.a[1][2] = J.a[2][1] = rocket->products[2];
    v3 center = v3_from(rocket->full.center);
    center.x += rocket->start_at;
    center.y += rocket->eccentricity[0];
    center.z += rocket->eccentricity[1];
    add_part(vehicle, DENSE_ELEVATION, rocket->full.mass + rocket->mass_error, v3_add(rear, center),
             J);
}

static bool listed(int number, const int *list, int count)
{
    for (int i = 0; i < count; i++)
        if (list[i] == number)
            return true;
    return false;
}

void dense_vehicle_create(dense_vehicle *vehicle, const ld_model *model, int launching,
                          const int *fired, int fired_count)
{
    const ld_platform *platform = &model->platform;
    const ld_turret *turret[HINGES] = {&platform->azimuth, &platform->elevation};
    const ld_layout *layout = &model->tubes.layout;
    *vehicle = (dense_vehicle){.model = model};
    add_part(vehicle, DENSE_CHASSIS, platform->chassis_mass, v3_zero(),
             diagonal(platform->chassis_inertia));
    for (int i = 0; i < HINGES; i++)
        add_part(vehicle, DENSE_AZIMUTH + i, turret[i]->mass, v3_from(turret[i]->center),
                 diagonal(turret[i]->inertia));
    // tubes in rows along y, columns along z
    for (int row = 0, number = 1; row < layout->rows; row++)
        for (int column = 0; column < layout->columns; column++, number++) {
            v3 rear = v3_add(v3_from(layout->first),
                             v3_make(0, row * layout->pitch, column * layout->pitch));
            if (number == launching) {
                vehicle->tube_at = rear;
                continue;
            }
            carry_tube(vehicle, rear);
            if (!listed(number, fired, fired_count) &&
                !listed(number, model->tubes.empty, model->tubes.empty_count))
                carry_rocket(vehicle, rear);
        }
}

void dense_vehicle_free(dense_vehicle *vehicle)
{
    for (int i = 0; i < DENSE_BODIES; i++)
        free(vehicle->body[i].part);
    *vehicle = (dense_vehicle){0};
}

// ---------------------------------------------------------------- road

static double track_height(const ld_road *profile, bool left, double x, double *slope)
{
    double h = 0;
    *slope = 0;
    for (int i = 0; i < profile->sine_count; i++) {
        double k = two_pi / profile->sine[i].wavelength, angle = k * x + profile->sine[i].phase;
        h += profile->sine[i].amplitude * sin(angle);
        *slope += profile->sine[i].amplitude * k * cos(angle);
    }
    for (int i = 0; i < profile->bump_count; i++) {
        const ld_bump *bump = &profile->bump[i];
        double along = x - bump->at, k = two_pi / bump->length;
        bool under = bump->tracks == LD_TRACK_BOTH || (bump->tracks == LD_TRACK_LEFT) == left;
        if (!under || along <= 0 || along >= bump->length)
            continue;
        h += 0.5 * bump->height * (1 - cos(k * along));
        *slope += 0.5 * bump->height * k * sin(k * along);
    }
    return h;
}

double dense_road_height(const ld_road *profile, double z, double x, double *slope)
{
    double from = profile->places[0], to = profile->places[1];
    bool placed = from < to;
    if (placed ? z <= from : z < 0)
        return track_height(profile, true, x, slope);
    double h_right = track_height(profile, false, x, slope), left_slope;
    if (!placed || z >= to)
        return h_right;
    double h_left = track_height(profile, true, x, &left_slope);
    *slope = left_slope + (*slope - left_slope) / (to - from) * (z - from);
    return h_left + (h_right - h_left) / (to - from) * (z - from);
}

// ---------------------------------------------------------------- equations

enum {
    HINGE_ROWS = 5,
    ROWS = HINGES * HINGE_ROWS,
    FREEDOMS = 6 * DENSE_BODIES + 3 * LD_MAX_WHEELS,
    SIZE = FREEDOMS + ROWS
};

// One state: bodies by their origins, all in I, and the dense system M x - C^T lambda = h,
// C x = rhs; x: acceleration of the origin and angular acceleration of every body in I, then the
// wheels' accelerations.
typedef struct equations {
    const dense_vehicle *vehicle;
    const dense_vehicle_input *input;
    dense_vehicle_output *output;
    struct {
        v3 r, v, w;
        m3 A;
    } body[DENSE_BODIES];
    int n; // freedoms
    double M[FREEDOMS][FREEDOMS];
    double h[FREEDOMS];
    double C[ROWS][FREEDOMS], rhs[ROWS];
} equations;

static const ld_turret *turret_of(const dense_vehicle *vehicle, int hinge)
{
    const ld_platform *platform = &vehicle->model->platform;
    return hinge == HINGE_AZIMUTH ? &platform->azimuth : &platform->elevation;
}

// Axis of a hinge on its inboard body, in I: y of the chassis, z of the azimuth platform.
static v3 hinge_axis(const equations *eq, int hinge)
{
    return m3_column(eq->body[hinge].A, hinge == HINGE_AZIMUTH ? 1 : 2);
}

static m3 attitude(const double q[4])
{
    double s = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    m3 A;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        A.a[i][i] = 1 - s * (q[1 + j] * q[1 + j] + q[1 + k] * q[1 + k]);
        A.a[j][i] = s * (q[1 + i] * q[1 + j] + q[0] * q[1 + k]);
        A.a[k][i] = s * (q[1 + i] * q[1 + k] - q[0] * q[1 + j]);
    }
    return A;
}

// Places and speeds of the three bodies and of the tube.
static void place_bodies(equations *eq)
{
    const double *state = eq->input->orientating;
    eq->body[0].r = v3_from(state + VEHICLE_R);
    eq->body[0].v = v3_from(state + VEHICLE_V);
    eq->body[0].A = attitude(state + VEHICLE_QUATERNION);
    eq->body[0].w = m3_apply(eq->body[0].A, v3_from(state + VEHICLE_W));
    for (int i = 0; i < HINGES; i++) {
        double angle = state[VEHICLE_ANGLE + i], rate = state[VEHICLE_RATE + i];
        v3 arm = m3_apply(eq->body[i].A, v3_from(turret_of(eq->vehicle, i)->hinge_at));
        m3 turn = i == HINGE_AZIMUTH ? m3_rotation_y(angle) : m3_rotation_z(angle);
        eq->body[i + 1].r = v3_add(eq->body[i].r, arm);
        eq->body[i + 1].v = v3_add(eq->body[i].v, v3_cross(eq->body[i].w, arm));
        eq->body[i + 1].A = m3_mul(eq->body[i].A, turn);
        eq->body[i + 1].w = v3_axpy(eq->body[i].w, rate, hinge_axis(eq, i));
    }
    base_frame *tube = &eq->output->tube;
    v3 arm = m3_apply(eq->body[DENSE_ELEVATION].A, eq->vehicle->tube_at);
    tube->r = v3_add(eq->body[DENSE_ELEVATION].r, arm);
    tube->A = eq->body[DENSE_ELEVATION].A;
    tube->w = eq->body[DENSE_ELEVATION].w;
    tube->v = v3_add(eq->body[DENSE_ELEVATION].v, v3_cross(tube->w, arm));
}

// Force f at a place and moment m, both in I, on a body.
static void push(equations *eq, int body, v3 f, v3 place, v3 m)
{
    v3 moment = v3_add(m, v3_cross(v3_sub(place, eq->body[body].r), f));
    double *h = eq->h + 6 * body;
    v3_store(h, v3_add(v3_from(h), f));
    v3_store(h + 3, v3_add(v3_from(h + 3), moment));
}

static double power_of(const equations *eq, int body, v3 f, v3 place, v3 m)
{
    v3 w = eq->body[body].w;
    v3 v = v3_add(eq->body[body].v, v3_cross(w, v3_sub(place, eq->body[body].r)));
    return v3_dot(f, v) + v3_dot(m, w);
}

// M += block at (row, column)
static void add_block(equations *eq, int row, int column, m3 block)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            eq->M[row + i][column + j] += block.a[i][j];
}

// Newton's and Euler's equations of a part, acceleration a + alpha x s + w x (w x s) at its centre.
static void add_mass(equations *eq, int body, const dense_part *part)
{
    m3 A = eq->body[body].A, J = m3_mul(A, m3_mul(part->inertia, m3_transpose(A)));
    v3 w = eq->body[body].w, s = m3_apply(A, part->center), spin = m3_apply(J, w);
    v3 place = v3_add(eq->body[body].r, s), v = v3_add(eq->body[body].v, v3_cross(w, s));
    m3 skew = m3_scale(part->mass, m3_skew(s));
    int at = 6 * body;
    add_block(eq, at, at, m3_diagonal(part->mass, part->mass, part->mass));
    add_block(eq, at, at + 3, m3_scale(-1, skew));
    add_block(eq, at + 3, at, skew);
    add_block(eq, at + 3, at + 3, m3_sub(J, m3_mul(skew, m3_skew(s))));
    double weight = part->mass * eq->vehicle->model->gravity;
    v3 f = v3_scale(-part->mass, v3_cross(w, v3_cross(w, s)));
    f.y -= weight;
    push(eq, body, f, place, v3_neg(v3_cross(w, spin)));
    eq->output->kinetic += 0.5 * part->mass * v3_dot(v, v) + 0.5 * v3_dot(w, spin);
    eq->output->potential += weight * place.y;
}

// Row `row`: second time derivative of a . b = 0, a fixed on body i and b on body k.
static void keep_normal(equations *eq, int row, int i, v3 a, int k, v3 b)
{
    v3 lever = v3_cross(a, b), wi = eq->body[i].w, wk = eq->body[k].w;
    v3_store(&eq->C[row][6 * i + 3], lever);
    v3_store(&eq->C[row][6 * k + 3], v3_neg(lever));
    eq->rhs[row] = -v3_dot(v3_cross(wi, v3_cross(wi, a)), b) -
                   v3_dot(a, v3_cross(wk, v3_cross(wk, b))) -
                   2 * v3_dot(v3_cross(wi, a), v3_cross(wk, b));
}

// The outboard body's origin stays at the hinge's place on the inboard one, and two of its axes
// normal to the hinge's.
static void add_hinge(equations *eq, int hinge)
{
    int in = hinge, out = hinge + 1, row = HINGE_ROWS * hinge;
    v3 w = eq->body[in].w, arm = v3_sub(eq->body[out].r, eq->body[in].r);
    v3 inward = v3_cross(w, v3_cross(w, arm));
    m3 skew = m3_skew(arm);
    v3_store(eq->rhs + row, inward);
    for (int i = 0; i < 3; i++) {
        eq->C[row + i][6 * out + i] = 1;
        eq->C[row + i][6 * in + i] = -1;
        for (int j = 0; j < 3; j++)
            eq->C[row + i][6 * in + 3 + j] = skew.a[i][j];
    }
    v3 axis = hinge_axis(eq, hinge);
    keep_normal(eq, row + 3, in, axis, out, m3_column(eq->body[out].A, 0));
    keep_normal(eq, row + 4, in, axis, out,
                m3_column(eq->body[out].A, hinge == HINGE_AZIMUTH ? 2 : 1));
}

// ---------------------------------------------------------------- orientating forces

// Command and its rate at t, linear between the rows, on the stretch that holds `on`.
static double command_of(const ld_table *table, double t, double on, double *rate)
{
    const double *row = table->data;
    *rate = 0;
    if (on < row[0])
        return row[1];
    for (size_t i = 0; i + 1 < table->rows; i++, row += 2)
        if (on < row[2]) {
            *rate = (row[3] - row[1]) / (row[2] - row[0]);
            return row[1] + *rate * (t - row[0]);
        }
    return row[1];
}

static double clip(double value, double limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

// Pitch (yaw) of the elevation platform's x axis, and its rate.
static double measure(const equations *eq, int hinge, double *rate)
{
    v3 d = m3_column(eq->body[DENSE_ELEVATION].A, 0);
    v3 d_dot = v3_cross(eq->body[DENSE_ELEVATION].w, d);
    double level = d.x * d.x + d.z * d.z;
    if (hinge == HINGE_AZIMUTH) {
        *rate = (d.z * d_dot.x - d.x * d_dot.z) / level;
        return atan2(-d.z, d.x);
    }
    *rate = d_dot.y / sqrt(level);
    return atan2(d.y, sqrt(level));
}

// Torque that the loops ask for and rate of their integral, of a digital one between its samples. A
// cascade is a PID whose integral takes the rate's error, too.
static double ask(const equations *eq, int hinge, double e, double e_dot, double *z_dot)
{
    const ld_stabiliser *given = &turret_of(eq->vehicle, hinge)->stabiliser;
    const ld_cascade *two = &given->cascade;
    const double *state = eq->input->orientating, limit = given->torque_limit;
    double kp = two->present ? two->rate_kp * two->kp : given->kp;
    double kd = two->present ? two->rate_kp : given->kd;
    double ki = two->present ? two->rate_ki * two->kp : given->ki;
    double grows = ki * e + (two->present ? two->rate_ki * e_dot : 0);
    double z = state[VEHICLE_Z + hinge];
    *z_dot = 0;
    if (given->sample > 0 && !eq->input->frictionless)
        return state[VEHICLE_DRIVE + DRIVE_STATES * hinge + DRIVE_HELD];
    if (fabs(z) < limit || z * grows <= 0)
        *z_dot = grows;
    return clip(kp * e + kd * e_dot + z, limit);
}

// Torque of a stabiliser's actuator and gear on the hinge, of what is asked for; their rates.
static double actuate(equations *eq, int hinge, double asked, double b_dot)
{
    const ld_stabiliser *given = &turret_of(eq->vehicle, hinge)->stabiliser;
    const ld_gear *gear = &given->gear;
    int at = VEHICLE_DRIVE + DRIVE_STATES * hinge;
    const double *drive = eq->input->orientating + at;
    double *rate = eq->output->orientating + at, torque = asked;
    if (given->bandwidth > 0) {
        torque = drive[DRIVE_TORQUE];
        rate[DRIVE_TORQUE] = two_pi * given->bandwidth * (asked - torque);
        if (given->slew > 0)
            rate[DRIVE_TORQUE] = clip(rate[DRIVE_TORQUE], given->slew);
    }
    if (!gear->present)
        return torque;
    double twist = drive[DRIVE_TWIST], play = 0.5 * gear->backlash;
    double side = twist < 0 ? -1 : 1, pressed = side * twist - play;
    double push = gear->stiffness * pressed + gear->damping * side * (drive[DRIVE_RATE] - b_dot);
    if (gear->backlash > 0 && !eq->input->frictionless && (pressed <= 0 || push <= 0))
        push = 0;
    rate[DRIVE_TWIST] = drive[DRIVE_RATE] - b_dot;
    rate[DRIVE_RATE] = (torque - side * push) / gear->inertia;
    return side * push;
}

// Stabiliser or lock and friction of a hinge; rates of what it has in the state.
static void turn_hinge(equations *eq, int hinge)
{
    const ld_turret *turret = turret_of(eq->vehicle, hinge);
    const ld_stabiliser *stabiliser = &turret->stabiliser;
    const double *state = eq->input->orientating;
    double b = state[VEHICLE_ANGLE + hinge], b_dot = state[VEHICLE_RATE + hinge];
    double *z_dot = &eq->output->orientating[VEHICLE_Z + hinge], measured_rate, command_rate;
    // errors
    double measured = measure(eq, hinge, &measured_rate);
    double command =
        command_of(&stabiliser->command, eq->input->t, eq->input->command_at, &command_rate);
    double base_rate = v3_dot(eq->body[DENSE_CHASSIS].w, hinge_axis(eq, hinge));
    double e = remainder(command - measured, two_pi);
    double e_dot = command_rate - stabiliser->feedforward * base_rate - measured_rate;
    // torque
    double torque;
    if (turret->lock.present) {
        const hold_rest *rest = &eq->input->rest[hinge];
        torque = rest->torque - turret->lock.stiffness * (b - rest->angle) -
                 turret->lock.damping * b_dot;
        *z_dot = 0;
    } else {
        torque = actuate(eq, hinge, ask(eq, hinge, e, e_dot, z_dot), b_dot);
    }
    const ld_hinge_friction *friction = &turret->friction;
    double drag = -friction->viscous * b_dot;
    if (!eq->input->frictionless)
        drag -= friction->coulomb * b_dot / sqrt(b_dot * b_dot + friction->rate * friction->rate);
    // outboard about the hinge, opposite inboard
    v3 m = v3_scale(torque + drag, hinge_axis(eq, hinge));
    push(eq, hinge + 1, v3_zero(), eq->body[hinge + 1].r, m);
    push(eq, hinge, v3_zero(), eq->body[hinge].r, v3_neg(m));
    eq->output->power += (torque + drag) * b_dot;
    eq->output->hinge[hinge].measured = measured;
    eq->output->hinge[hinge].measured_rate = measured_rate;
    eq->output->hinge[hinge].error = e;
    eq->output->hinge[hinge].torque = torque;
    eq->output->hinge[hinge].friction = drag;
    eq->output->hinge[hinge].base_rate = base_rate;
}

static void load_tube(equations *eq)
{
    const base_frame *tube = &eq->output->tube;
    v3 f = m3_apply(tube->A, eq->input->tube_force), m = m3_apply(tube->A, eq->input->tube_moment);
    push(eq, DENSE_ELEVATION, f, tube->r, m);
    eq->output->power += power_of(eq, DENSE_ELEVATION, f, tube->r, m);
    v3 jet = v3_scale(-eq->input->jet, m3_column(tube->A, 0));
    v3 mouth = v3_add(tube->r, m3_apply(tube->A, eq->input->jet_at));
    push(eq, DENSE_ELEVATION, jet, mouth, v3_zero());
    eq->output->power += power_of(eq, DENSE_ELEVATION, jet, mouth, v3_zero());
}

// ---------------------------------------------------------------- marching forces

// A force on a wheel's mass, in I.
static void push_wheel(equations *eq, int wheel, v3 f)
{
    double *h = eq->h + 6 * DENSE_BODIES + 3 * wheel;
    v3_store(h, v3_add(v3_from(h), f));
}

// Spring, damper and bump stop between wheel and chassis, by components along its axes.
static void suspend(equations *eq, int wheel, v3 r, v3 v)
{
    const ld_vehicle *model = &eq->vehicle->model->base.vehicle;
    const ld_suspension *suspension = &model->suspension;
    m3 A = eq->body[DENSE_CHASSIS].A;
    v3 arm = v3_sub(r, eq->body[DENSE_CHASSIS].r);
    v3 relative =
        v3_sub(v3_sub(v, eq->body[DENSE_CHASSIS].v), v3_cross(eq->body[DENSE_CHASSIS].w, arm));
    double d[3], d_dot[3], f[3], energy = 0, damping = 0;
    v3_store(d, v3_sub(m3_apply_transposed(A, arm), v3_from(model->wheel[wheel].mount)));
    v3_store(d_dot, m3_apply_transposed(A, relative));
    for (int i = 0; i < 3; i++) {
        f[i] = -suspension->stiffness[i] * d[i] - suspension->damping[i] * d_dot[i];
        energy += 0.5 * suspension->stiffness[i] * d[i] * d[i];
        damping -= suspension->damping[i] * d_dot[i] * d_dot[i];
    }
    double up = d[1] - suspension->bump_stop.compression;
    double down = -d[1] - suspension->bump_stop.extension;
    if (up > 0) {
        f[1] -= suspension->bump_stop.stiffness * up;
        energy += 0.5 * suspension->bump_stop.stiffness * up * up;
    }
    if (down > 0) {
        f[1] += suspension->bump_stop.stiffness * down;
        energy += 0.5 * suspension->bump_stop.stiffness * down * down;
    }
    v3 force = m3_apply(A, v3_from(f));
    push_wheel(eq, wheel, force);
    push(eq, DENSE_CHASSIS, v3_neg(force), r, v3_zero());
    eq->output->potential += energy;
    eq->output->power += damping;
    eq->output->wheel[wheel].travel = v3_from(d);
}

// Tyre on the road: vertical force, drive or holding force along, lateral force across.
static void roll(equations *eq, int wheel, v3 r, v3 v, double drive)
{
    const ld_vehicle *model = &eq->vehicle->model->base.vehicle;
    const ld_tyre *tyre = &model->tyre;
    const double *state = eq->input->marching + WHEEL_STATES * wheel;
    double *rate = eq->output->marching + WHEEL_STATES * wheel;
    double eta = state[WHEEL_ETA], xi = state[WHEEL_XI], slope;
    double height = dense_road_height(&model->road, model->wheel[wheel].mount[2], r.x, &slope);
    // normal force
    double p = height + tyre->radius - r.y, p_dot = slope * v.x - v.y;
    double normal = p > 0 ? fmax(0, tyre->stiffness[1] * p + tyre->damping[1] * p_dot) : 0;
    // speed of the carrier's material at the contact point, along and across the heading
    v3 ahead = m3_column(eq->body[DENSE_CHASSIS].A, 0), up = v3_make(0, 1, 0);
    v3 e_f = v3_scale(1 / hypot(ahead.x, ahead.z), v3_make(ahead.x, 0, ahead.z));
    v3 e_s = v3_cross(e_f, up), arm = v3_sub(v3_make(r.x, height, r.z), r);
    v3 v_c = v3_add(v, v3_cross(eq->body[DENSE_CHASSIS].w, arm));
    double v_f = v3_dot(v_c, e_f), v_s = v3_dot(v_c, e_s);
    // deflections and forces
    bool parked = model->speed == 0;
    rate[WHEEL_XI] = parked ? v_f : 0;
    rate[WHEEL_ETA] = parked ? v_s : v_s - fabs(v_f) * eta / tyre->relaxation_length;
    double f_f = parked ? -tyre->stiffness[0] * xi - tyre->damping[0] * v_f : drive;
    double f_s = -tyre->stiffness[2] * eta - tyre->damping[2] * rate[WHEEL_ETA];
    double most = tyre->friction * normal;
    double share = normal > 0 ? 1 / sqrt(1 + (f_f * f_f + f_s * f_s) / (most * most)) : 0;
    v3 f = v3_add(v3_scale(share * f_f, e_f), v3_scale(share * f_s, e_s));
    v3 moment = v3_cross(arm, f), force = v3_axpy(f, normal, up);
    push_wheel(eq, wheel, force);
    push(eq, DENSE_CHASSIS, v3_zero(), eq->body[DENSE_CHASSIS].r, moment);
    eq->output->power += v3_dot(force, v) + v3_dot(moment, eq->body[DENSE_CHASSIS].w);
    eq->output->wheel[wheel].deflection = p;
    eq->output->wheel[wheel].normal = normal;
    eq->output->wheel[wheel].along = share * f_f;
    eq->output->wheel[wheel].side = share * f_s;
}

static void add_wheels(equations *eq)
{
    const ld_model *model = eq->vehicle->model;
    const ld_vehicle *vehicle = &model->base.vehicle;
    int count = vehicle->wheel_count, driven = 0;
    for (int i = 0; i < count; i++)
        driven += vehicle->wheel[i].driven;
    // drive along the heading
    v3 ahead = m3_column(eq->body[DENSE_CHASSIS].A, 0), v_C = eq->body[DENSE_CHASSIS].v;
    double v = (ahead.x * v_C.x + ahead.z * v_C.z) / hypot(ahead.x, ahead.z);
    double z_d = eq->input->marching[WHEEL_STATES * count];
    double drive = vehicle->drive.kp * (vehicle->speed - v) + vehicle->drive.ki * z_d;
    if (eq->input->still)
        drive = 0;
    eq->output->marching[WHEEL_STATES * count] = vehicle->speed - v; // parked as well
    for (int i = 0; i < count; i++) {
        const double *state = eq->input->marching + WHEEL_STATES * i;
        v3 r_j = v3_from(state + WHEEL_R), v_j = v3_from(state + WHEEL_V);
        double mass = vehicle->wheel[i].mass;
        int at = 6 * DENSE_BODIES + 3 * i;
        add_block(eq, at, at, m3_diagonal(mass, mass, mass));
        push_wheel(eq, i, v3_make(0, -mass * model->gravity, 0));
        suspend(eq, i, r_j, v_j);
        roll(eq, i, r_j, v_j, vehicle->wheel[i].driven ? drive / driven : 0);
        eq->output->kinetic += 0.5 * mass * v3_dot(v_j, v_j);
        eq->output->potential += mass * model->gravity * r_j.y;
    }
}

// ---------------------------------------------------------------- solution

static bool solve(const equations *eq, double x[])
{
    static _Thread_local double matrix[SIZE * SIZE], right[SIZE];
    lapack_int pivot[SIZE];
    int n = eq->n, size = n + ROWS;
    memset(matrix, 0, sizeof matrix);
    for (int i = 0; i < n; i++)
        memcpy(matrix + i * size, eq->M[i], (size_t)n * sizeof(double));
    memcpy(right, eq->h, (size_t)n * sizeof(double));
    memcpy(right + n, eq->rhs, sizeof eq->rhs);
    for (int row = 0; row < ROWS; row++)
        for (int i = 0; i < n; i++) {
            matrix[(n + row) * size + i] = eq->C[row][i];
            matrix[i * size + n + row] = -eq->C[row][i];
        }
    if (LAPACKE_dgesv(LAPACK_ROW_MAJOR, size, 1, matrix, size, pivot, right, 1) != 0)
        return false;
    memcpy(x, right, (size_t)n * sizeof(double));
    return true;
}

static void write_rates(const equations *eq, const double x[])
{
    dense_vehicle_output *output = eq->output;
    const double *state = eq->input->orientating, *q = state + VEHICLE_QUATERNION;
    for (int i = 0; i < DENSE_BODIES; i++) {
        output->acceleration[i] = v3_from(x + 6 * i);
        output->alpha[i] = v3_from(x + 6 * i + 3);
    }
    // chassis; A^T w_dot in I is the derivative of w in body axes too
    double *rate = output->orientating, w[3];
    memcpy(w, state + VEHICLE_W, sizeof w);
    memcpy(rate + VEHICLE_R, state + VEHICLE_V, sizeof w);
    rate[VEHICLE_QUATERNION] = -0.5 * (q[1] * w[0] + q[2] * w[1] + q[3] * w[2]);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        rate[VEHICLE_QUATERNION + 1 + i] = 0.5 * (q[0] * w[i] + q[1 + j] * w[k] - q[1 + k] * w[j]);
    }
    v3_store(rate + VEHICLE_V, output->acceleration[DENSE_CHASSIS]);
    v3_store(rate + VEHICLE_W,
             m3_apply_transposed(eq->body[DENSE_CHASSIS].A, output->alpha[DENSE_CHASSIS]));
    for (int i = 0; i < HINGES; i++) {
        rate[VEHICLE_ANGLE + i] = state[VEHICLE_RATE + i];
        rate[VEHICLE_RATE + i] =
            v3_dot(hinge_axis(eq, i), v3_sub(output->alpha[i + 1], output->alpha[i]));
    }
    for (int i = 0; i < eq->vehicle->model->base.vehicle.wheel_count; i++) {
        double *wheel = output->marching + WHEEL_STATES * i;
        memcpy(wheel + WHEEL_R, eq->input->marching + WHEEL_STATES * i + WHEEL_V, sizeof w);
        memcpy(wheel + WHEEL_V, x + 6 * DENSE_BODIES + 3 * i, sizeof w);
    }
}

bool dense_vehicle_evaluate(const dense_vehicle *vehicle, const dense_vehicle_input *input,
                            dense_vehicle_output *output)
{
    static _Thread_local equations eq;
    double x[FREEDOMS];
    memset(&eq, 0, sizeof eq);
    memset(output, 0, sizeof *output);
    eq.vehicle = vehicle;
    eq.input = input;
    eq.output = output;
    eq.n = 6 * DENSE_BODIES + 3 * vehicle->model->base.vehicle.wheel_count;
    place_bodies(&eq);
    for (int i = 0; i < DENSE_BODIES; i++)
        for (int k = 0; k < vehicle->body[i].count; k++)
            add_mass(&eq, i, &vehicle->body[i].part[k]);
    for (int i = 0; i < HINGES; i++) {
        add_hinge(&eq, i);
        turn_hinge(&eq, i);
    }
    load_tube(&eq);
    add_wheels(&eq);
    if (!solve(&eq, x))
        return false;
    write_rates(&eq, x);
    return true;
}

void dense_vehicle_tube(const dense_vehicle *vehicle, const double *orientating, base_frame *tube)
{
    equations eq;
    dense_vehicle_input input = {.orientating = orientating};
    dense_vehicle_output output;
    eq.vehicle = vehicle;
    eq.input = &input;
    eq.output = &output;
    place_bodies(&eq);
    *tube = output.tube;
}

// ---------------------------------------------------------------- equilibrium

// Unknowns: chassis' height, pitch, roll; hinge angles; torques; wheels' places.
enum { Y, PITCH, ROLL, ANGLE, TORQUE = ANGLE + HINGES, PLACE = TORQUE + HINGES };

typedef struct balance {
    const dense_vehicle *vehicle;
    dense_vehicle_input input;
    double x;
    int n;
    double orientating[VEHICLE_BODY_STATES], marching[DENSE_MARCHING_STATES];
    dense_vehicle_output output;
} balance;

static void quaternion_about(double q[4], int axis, double angle)
{
    double c = cos(0.5 * angle), s = sin(0.5 * angle);
    int j = (axis + 1) % 3, k = (axis + 2) % 3;
    double w = q[0], a = q[1 + axis], b = q[1 + j], d = q[1 + k];
    q[0] = w * c - a * s;
    q[1 + axis] = a * c + w * s;
    q[1 + j] = b * c + d * s;
    q[1 + k] = d * c - b * s;
}

// Residuals: chassis' vertical, rolling and pitching acceleration, those of hinges and wheels, and
// the angle errors of the platform. (Nothing acts along, across or about the vertical.)
static bool residual_of(balance *at, const double *u, double *residual)
{
    double *q = at->orientating + VEHICLE_QUATERNION;
    memset(at->orientating, 0, sizeof at->orientating);
    memset(at->marching, 0, sizeof at->marching);
    at->orientating[0] = at->x;
    at->orientating[1] = u[Y];
    q[0] = 1;
    quaternion_about(q, 2, u[PITCH]);
    quaternion_about(q, 0, u[ROLL]);
    for (int i = 0; i < HINGES; i++) {
        at->orientating[VEHICLE_ANGLE + i] = u[ANGLE + i];
        at->orientating[VEHICLE_Z + i] = u[TORQUE + i];
        at->input.rest[i] = (hold_rest){u[ANGLE + i], u[TORQUE + i]};
    }
    int wheels = (at->n - PLACE) / 3;
    for (int i = 0; i < wheels; i++)
        memcpy(at->marching + WHEEL_STATES * i, u + PLACE + 3 * i, 3 * sizeof *u);
    at->input.orientating = at->orientating;
    at->input.marching = at->marching;
    if (!dense_vehicle_evaluate(at->vehicle, &at->input, &at->output))
        return false;
    const double *rate = at->output.orientating;
    residual[Y] = rate[VEHICLE_V + 1];
    residual[PITCH] = rate[VEHICLE_W + 2];
    residual[ROLL] = rate[VEHICLE_W];
    for (int i = 0; i < HINGES; i++) {
        residual[ANGLE + i] = at->output.hinge[i].error;
        residual[TORQUE + i] = rate[VEHICLE_RATE + i];
    }
    for (int i = 0; i < wheels; i++)
        memcpy(residual + PLACE + 3 * i, at->output.marching + WHEEL_STATES * i + WHEEL_V,
               3 * sizeof *residual);
    return true;
}

// Level, platforms turned, tyres and suspensions pressed in by centimetres.
static void guess_of(const balance *at, double *u)
{
    const ld_model *model = at->vehicle->model;
    const ld_vehicle *vehicle = &model->base.vehicle;
    memset(u, 0, (size_t)at->n * sizeof *u);
    double highest = -INFINITY, slope, rate;
    for (int i = 0; i < vehicle->wheel_count; i++) {
        const double *mount = vehicle->wheel[i].mount;
        double h = dense_road_height(&vehicle->road, mount[2], at->x + mount[0], &slope);
        highest = fmax(highest, h + vehicle->tyre.radius - mount[1]);
        u[PLACE + 3 * i] = at->x + mount[0];
        u[PLACE + 3 * i + 1] = h + vehicle->tyre.radius - 0.02;
        u[PLACE + 3 * i + 2] = mount[2];
    }
    u[Y] = highest - 0.07;
    for (int i = 0; i < HINGES; i++)
        u[ANGLE + i] = command_of(&turret_of(at->vehicle, i)->stabiliser.command, at->input.t,
                                  at->input.t, &rate);
}

static double largest(const double *a, int n)
{
    double most = 0;
    for (int i = 0; i < n; i++)
        most = fmax(most, fabs(a[i]));
    return most;
}

// Newton's method with differences for the Jacobian.
static bool find_balance(balance *at, double *u)
{
    enum { MOST = PLACE + 3 * LD_MAX_WHEELS };
    static _Thread_local double jacobian[MOST * MOST];
    double residual[MOST], side[2][MOST];
    lapack_int pivot[MOST];
    int n = at->n;
    for (int iteration = 0; iteration < 30; iteration++) {
        for (int j = 0; j < n; j++) {
            double h = j == TORQUE || j == TORQUE + 1 ? 1 : 1e-7, kept = u[j];
            for (int i = 0; i < 2; i++) {
                u[j] = kept + (i == 0 ? -h : h);
                if (!residual_of(at, u, side[i]))
                    return false;
            }
            u[j] = kept;
            for (int i = 0; i < n; i++)
                jacobian[j * n + i] = (side[1][i] - side[0][i]) / (2 * h);
        }
        if (!residual_of(at, u, residual) ||
            LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, jacobian, n, pivot, residual, n) != 0)
            return false;
        // torques in units of 1e5 N m; at most two centimetres (or hundredths of a radian) a step
        double most = 0;
        for (int j = 0; j < n; j++)
            most = fmax(most, fabs(residual[j]) / (j == TORQUE || j == TORQUE + 1 ? 1e7 : 1));
        double part = fmin(1, 0.02 / most);
        for (int j = 0; j < n; j++)
            u[j] -= part * residual[j];
        if (most < 1e-14)
            break;
    }
    return residual_of(at, u, residual) && largest(residual, n) < 1e-7;
}

bool dense_vehicle_equilibrium(const dense_vehicle *vehicle, double t, double x, v3 tube_force,
                               v3 tube_moment, double *orientating, double *marching,
                               hold_rest rest[HINGES], double *residual)
{
    balance at = {.vehicle = vehicle,
                  .input = {.t = t,
                            .command_at = t,
                            .tube_force = tube_force,
                            .tube_moment = tube_moment,
                            .frictionless = true,
                            .still = true},
                  .x = x,
                  .n = PLACE + 3 * vehicle->model->base.vehicle.wheel_count};
    double u[PLACE + 3 * LD_MAX_WHEELS];
    guess_of(&at, u);
    if (!find_balance(&at, u))
        return false;
    int states = WHEEL_STATES * vehicle->model->base.vehicle.wheel_count + 1;
    memcpy(orientating, at.orientating, sizeof at.orientating);
    memcpy(marching, at.marching, (size_t)states * sizeof *marching);
    memcpy(rest, at.input.rest, sizeof at.input.rest);
    *residual = largest(at.output.orientating, VEHICLE_BODY_STATES);
    *residual = fmax(*residual, largest(at.output.marching, states));
    return true;
}
