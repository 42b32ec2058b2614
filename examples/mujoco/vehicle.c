#include "vehicle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mujoco/mujoco.h>

enum { MOST_WHEELS = 8, HINGES = 2, MOST_SPEEDS = 6 + HINGES + 3 * MOST_WHEELS };

// What MuJoCo's user data hold: the wrench, then the factor on the tyres' damping.
enum { DAMPING_SCALE = VEHICLE_INPUTS, USER_DATA };

// Numbers of the model, by name. Along, up, across.
typedef struct tyre_numbers {
    const mjtNum *radius, *stiffness, *damping, *friction;
} tyre_numbers;

struct vehicle {
    mjModel *model;
    mjData *data;
    mjtNum *damping; // [nv] of the joints, as given
    int chassis, tube, hinge[HINGES];
    bool started, stale; // stale: the equilibrium is not that of the present numbers
    double value[VEHICLE_VARIABLES];
};

// ---- tyres: called by MuJoCo, for every model of the process

static const mjtNum *number_of(const mjModel *m, const char *name)
{
    int id = mj_name2id(m, mjOBJ_NUMERIC, name);
    return id < 0 ? NULL : m->numeric_data + m->numeric_adr[id];
}

// False: not a model of ours.
static bool tyres_of(const mjModel *m, tyre_numbers *tyre)
{
    *tyre = (tyre_numbers){number_of(m, "tyre.radius"), number_of(m, "tyre.stiffness"),
                           number_of(m, "tyre.damping"), number_of(m, "tyre.friction")};
    return tyre->radius && tyre->stiffness && tyre->damping && tyre->friction;
}

// The body of the wheel that actuators 2 j and 2 j + 1 stand for.
static int wheel_body(const mjModel *m, int j)
{
    return m->jnt_bodyid[m->actuator_trnid[2 * 2 * j]];
}

// What a tyre knows: e_f = (x, 0, z) is the chassis' x axis made horizontal, e_s = (-z, 0, x);
// p the deflection, v_f and v_s the velocity along and across of the point below that turns with
// the chassis.
typedef struct contact {
    double x, z, p, p_dot, v_f, v_s;
    mjtNum place[3];
} contact;

static contact contact_of(const mjModel *m, const mjData *d, const tyre_numbers *tyre, int j)
{
    int body = wheel_body(m, j);
    const mjtNum *r = d->xpos + 3 * body, *A = d->xmat + 9 * m->body_parentid[body];
    mjtNum v[6]; // angular, linear
    mj_objectVelocity(m, d, mjOBJ_BODY, body, v, 0);
    double length = sqrt(A[0] * A[0] + A[6] * A[6]);
    contact c = {.x = A[0] / length, .z = A[6] / length, .place = {r[0], 0, r[2]}};
    c.p = *tyre->radius - r[1];
    c.p_dot = -v[4];
    // v + w x (0, -r_y, 0)
    double v_x = v[3] + r[1] * v[2], v_z = v[5] - r[1] * v[0];
    c.v_f = c.x * v_x + c.z * v_z;
    c.v_s = c.x * v_z - c.z * v_x;
    return c;
}

// Rate of a tyre's deflection, along (even) or across.
static mjtNum deflection_rate(const mjModel *m, const mjData *d, int actuator)
{
    tyre_numbers tyre;
    if (!tyres_of(m, &tyre))
        return 0;
    contact c = contact_of(m, d, &tyre, actuator / 2);
    return actuator % 2 ? c.v_s : c.v_f;
}

// Adds the force of the road: springs and dampers; what lies in the plane within the friction
// limit, times 1/sqrt(1 + |f|^2/(mu F_n)^2).
static void add_tyre(const mjModel *m, mjData *d, const tyre_numbers *tyre, int j)
{
    static const mjtNum none[3];
    contact c = contact_of(m, d, tyre, j);
    const mjtNum *k = tyre->stiffness, scale = d->userdata[DAMPING_SCALE];
    const double damping[3] = {scale * tyre->damping[0], scale * tyre->damping[1],
                               scale * tyre->damping[2]};
    double normal = c.p > 0 ? fmax(0, k[1] * c.p + damping[1] * c.p_dot) : 0;
    double along = -k[0] * d->act[2 * j] - damping[0] * c.v_f;
    double side = -k[2] * d->act[2 * j + 1] - damping[2] * c.v_s;
    double limit = *tyre->friction * normal;
    double share = limit > 0 ? limit / sqrt(limit * limit + along * along + side * side) : 0;
    along *= share;
    side *= share;
    const mjtNum force[3] = {along * c.x - side * c.z, normal, along * c.z + side * c.x};
    mj_applyFT(m, d, force, none, c.place, wheel_body(m, j), d->qfrc_passive);
}

// Tyres, and the wrench that the user data hold, on what holds the tube.
static void add_forces(const mjModel *m, mjData *d)
{
    tyre_numbers tyre;
    int tube = mj_name2id(m, mjOBJ_SITE, "tube");
    if (!tyres_of(m, &tyre) || tube < 0 || m->nuserdata < USER_DATA)
        return;
    for (int j = 0; j < m->nu / 2; j++)
        add_tyre(m, d, &tyre, j);
    mj_applyFT(m, d, d->userdata + VEHICLE_FORCE, d->userdata + VEHICLE_MOMENT,
               d->site_xpos + 3 * tube, m->site_bodyid[tube], d->qfrc_passive);
}

// ---- life

static void be_quiet(const char *message)
{
    (void)message; // what it warns of is checked after each step
}

// What the code below takes for granted of the model's text.
static bool find_parts(vehicle *self)
{
    const mjModel *m = self->model;
    tyre_numbers tyre;
    self->chassis = mj_name2id(m, mjOBJ_BODY, "chassis");
    self->tube = mj_name2id(m, mjOBJ_SITE, "tube");
    self->hinge[0] = mj_name2id(m, mjOBJ_JOINT, "azimuth");
    self->hinge[1] = mj_name2id(m, mjOBJ_JOINT, "elevation");
    return self->chassis == 1 && self->tube >= 0 && self->hinge[0] > 0 && self->hinge[1] > 0 &&
           tyres_of(m, &tyre) && m->nu % 2 == 0 && m->na == m->nu && m->nv <= MOST_SPEEDS &&
           m->nv == 6 + HINGES + 3 * m->nu / 2 && m->nuserdata == USER_DATA;
}

vehicle *vehicle_create(const char *resources, char *error, size_t error_size)
{
    char path[4096];
    vehicle *self = calloc(1, sizeof *self);
    if (!self)
        return NULL;
    mju_user_warning = be_quiet;
    mjcb_passive = add_forces;
    mjcb_act_dyn = deflection_rate;
    snprintf(path, sizeof path, "%s/vehicle.xml", resources);
    self->model = mj_loadXML(path, NULL, error, (int)error_size);
    if (self->model && !find_parts(self)) {
        snprintf(error, error_size, "%s: a part of the vehicle is missing or one too many", path);
        mj_deleteModel(self->model);
        self->model = NULL;
    }
    if (!self->model) {
        free(self);
        return NULL;
    }
    size_t speeds = (size_t)self->model->nv;
    self->damping = malloc(speeds * sizeof *self->damping);
    self->data = mj_makeData(self->model);
    if (!self->damping || !self->data) {
        snprintf(error, error_size, "no memory for the vehicle");
        vehicle_free(self);
        return NULL;
    }
    memcpy(self->damping, self->model->dof_damping, speeds * sizeof *self->damping);
    vehicle_reset(self);
    return self;
}

void vehicle_free(vehicle *self)
{
    if (!self)
        return;
    if (self->data)
        mj_deleteData(self->data);
    mj_deleteModel(self->model);
    free(self->damping);
    free(self);
}

void vehicle_reset(vehicle *self)
{
    memset(self->value, 0, sizeof self->value);
    self->value[VEHICLE_DAMPING_SCALE] = 1;
    self->value[VEHICLE_STEP] = 5e-4;
    self->started = false;
    self->stale = true;
}

// ---- equilibrium

static void take_values(vehicle *self)
{
    mjModel *m = self->model;
    double scale = self->value[VEHICLE_DAMPING_SCALE];
    memcpy(self->data->userdata, self->value, VEHICLE_INPUTS * sizeof *self->value);
    self->data->userdata[DAMPING_SCALE] = scale;
    for (int i = 0; i < m->nv; i++)
        m->dof_damping[i] = scale * self->damping[i];
}

// Generalised forces [nv] at rest.
static void forces_at_rest(vehicle *self, double *force)
{
    mj_forward(self->model, self->data);
    memcpy(force, self->data->qfrc_smooth, (size_t)self->model->nv * sizeof *force);
}

// Displaces unknown i: generalised coordinate i, but that place x, z and heading of the chassis are
// given: in their stead go the tyres' deflections that such a displacement would make.
static void displace(vehicle *self, int i, double amount)
{
    const mjModel *m = self->model;
    mjData *d = self->data;
    double change[MOST_SPEEDS] = {0};
    change[i] = amount;
    if (i != 0 && i != 2 && i != 4) {
        mj_integratePos(m, d->qpos, change, 1);
        return;
    }
    for (int j = 0; j < m->nu / 2; j++) {
        const mjtNum *r = d->xpos + 3 * wheel_body(m, j), *r_C = d->xpos + 3 * self->chassis;
        const mjtNum *A = d->xmat + 9 * self->chassis;
        double length = sqrt(A[0] * A[0] + A[6] * A[6]), x = A[0] / length, z = A[6] / length;
        double along_x = change[0] + change[4] * (r[2] - r_C[2]);
        double along_z = change[2] - change[4] * (r[0] - r_C[0]);
        d->act[2 * j] += x * along_x + z * along_z;
        d->act[2 * j + 1] += x * along_z - z * along_x;
    }
}

// Solves A x = b, n by n in rows of MOST_SPEEDS, in place; x in b.
static bool solve(int n, double A[][MOST_SPEEDS], double *b)
{
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(A[i][k]) > fabs(A[pivot][k]))
                pivot = i;
        if (!(fabs(A[pivot][k]) > 0))
            return false;
        for (int j = 0; j < n; j++) {
            double kept = A[k][j];
            A[k][j] = A[pivot][j];
            A[pivot][j] = kept;
        }
        double kept = b[k];
        b[k] = b[pivot];
        b[pivot] = kept;
        for (int i = k + 1; i < n; i++) {
            double factor = A[i][k] / A[k][k];
            for (int j = k; j < n; j++)
                A[i][j] -= factor * A[k][j];
            b[i] -= factor * b[k];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++)
            b[k] -= A[k][j] * b[j];
        b[k] /= A[k][k];
    }
    return true;
}

// One step of Newton's method for all but the hinges.
static bool balance(vehicle *self, const double *force)
{
    static const double CHANGE = 1e-6;
    const mjModel *m = self->model;
    double A[MOST_SPEEDS][MOST_SPEEDS], b[MOST_SPEEDS], changed[MOST_SPEEDS];
    double place[MOST_SPEEDS + 1], act[2 * MOST_WHEELS];
    int unknown[MOST_SPEEDS], n = 0;
    for (int i = 0; i < m->nv; i++)
        if (i != m->jnt_dofadr[self->hinge[0]] && i != m->jnt_dofadr[self->hinge[1]])
            unknown[n++] = i;
    memcpy(place, self->data->qpos, (size_t)m->nq * sizeof *place);
    memcpy(act, self->data->act, (size_t)m->na * sizeof *act);
    for (int j = 0; j < n; j++) {
        displace(self, unknown[j], CHANGE);
        forces_at_rest(self, changed);
        for (int i = 0; i < n; i++)
            A[i][j] = (changed[unknown[i]] - force[unknown[i]]) / CHANGE;
        b[j] = -force[unknown[j]];
        memcpy(self->data->qpos, place, (size_t)m->nq * sizeof *place);
        memcpy(self->data->act, act, (size_t)m->na * sizeof *act);
        mj_forward(m, self->data);
    }
    if (!solve(n, A, b))
        return false;
    for (int j = 0; j < n; j++)
        displace(self, unknown[j], b[j]);
    return true;
}

// Turns the hinges until the tube points where it should, and puts their springs so that they hold
// it there; gives the largest of the errors [rad].
static double point(vehicle *self)
{
    mjModel *m = self->model;
    double force[MOST_SPEEDS];
    forces_at_rest(self, force);
    const mjtNum *A = self->data->site_xmat + 9 * self->tube;
    const double error[HINGES] = {atan2(A[6], A[0]),
                                  self->value[VEHICLE_PITCH] - asin(fmin(1, fmax(-1, A[3])))};
    for (int i = 0; i < HINGES; i++) {
        int id = self->hinge[i], at = m->jnt_qposadr[id];
        self->data->qpos[at] += error[i];
        m->qpos_spring[at] += error[i] - force[m->jnt_dofadr[id]] / m->jnt_stiffness[id];
    }
    return fmax(fabs(error[0]), fabs(error[1]));
}

// Equilibrium under the present wrench: place x, z and heading of the chassis and the tube's
// direction are given, tyres stand unloaded but for what holds that wrench.
static bool find_equilibrium(vehicle *self, char *error, size_t error_size)
{
    mjModel *m = self->model;
    double force[MOST_SPEEDS], largest = INFINITY;
    mj_resetData(m, self->data);
    for (int i = 0; i < HINGES; i++)
        m->qpos_spring[m->jnt_qposadr[self->hinge[i]]] = 0;
    take_values(self);
    for (int turn = 0; turn < 30; turn++) {
        largest = 1e6 * point(self);
        forces_at_rest(self, force);
        for (int i = 0; i < m->nv; i++)
            largest = fmax(largest, fabs(force[i]));
        if (largest < 1e-6) {
            self->stale = false;
            return true;
        }
        if (!(largest < 1e12) || !balance(self, force))
            break;
    }
    snprintf(error, error_size, "the vehicle finds no equilibrium (%.3g N or N m are left)",
             largest);
    return false;
}

// ---- variables

// Position, quaternion, velocity and rate of a body or site.
static void tell_motion(const vehicle *self, mjtObj kind, int id, double *value)
{
    const mjData *d = self->data;
    const bool site = kind == mjOBJ_SITE;
    mjtNum v[6];
    memcpy(value, (site ? d->site_xpos : d->xpos) + 3 * id, 3 * sizeof *value);
    if (site)
        mju_mat2Quat(value + 3, d->site_xmat + 9 * id);
    else
        memcpy(value + 3, d->xquat + 4 * id, 4 * sizeof *value);
    mj_objectVelocity(self->model, d, kind, id, v, 0);
    memcpy(value + 7, v + 3, 3 * sizeof *value);
    memcpy(value + 10, v, 3 * sizeof *value);
}

static double energy_of(vehicle *self)
{
    tyre_numbers tyre;
    const mjModel *m = self->model;
    mjData *d = self->data;
    mj_energyPos(m, d);
    mj_energyVel(m, d);
    double sum = d->energy[0] + d->energy[1];
    tyres_of(m, &tyre);
    for (int j = 0; j < m->nu / 2; j++) {
        double up = fmax(0, contact_of(m, d, &tyre, j).p), xi = d->act[2 * j],
               eta = d->act[2 * j + 1];
        sum += 0.5 * (tyre.stiffness[0] * xi * xi + tyre.stiffness[1] * up * up +
                      tyre.stiffness[2] * eta * eta);
    }
    return sum;
}

bool vehicle_set(vehicle *self, unsigned variable, double value, char *error, size_t error_size)
{
    if (variable >= VEHICLE_VARIABLES ||
        (variable >= VEHICLE_INPUTS && variable < VEHICLE_OUTPUTS_END))
        snprintf(error, error_size, "variable %u is neither an input nor a parameter", variable);
    else if (variable >= VEHICLE_OUTPUTS_END && self->started)
        snprintf(error, error_size, "variable %u is fixed once the vehicle has started", variable);
    else if (!isfinite(value) || (variable == VEHICLE_STEP && !(value > 0)) ||
             (variable == VEHICLE_DAMPING_SCALE && value < 0) ||
             (variable == VEHICLE_PITCH && fabs(value) > 1.4))
        snprintf(error, error_size, "variable %u cannot be %g", variable, value);
    else {
        self->value[variable] = value;
        self->stale = self->stale || !self->started;
        return true;
    }
    return false;
}

bool vehicle_get(vehicle *self, unsigned variable, double *value, char *error, size_t error_size)
{
    if (variable >= VEHICLE_VARIABLES) {
        snprintf(error, error_size, "variable %u does not exist", variable);
        return false;
    }
    if (self->stale && !find_equilibrium(self, error, error_size))
        return false;
    tell_motion(self, mjOBJ_SITE, self->tube, self->value + VEHICLE_BASE);
    tell_motion(self, mjOBJ_BODY, self->chassis, self->value + VEHICLE_CHASSIS);
    self->value[VEHICLE_ENERGY] = energy_of(self);
    *value = self->value[variable];
    return true;
}

// ---- steps

bool vehicle_start(vehicle *self, char *error, size_t error_size)
{
    if (self->stale && !find_equilibrium(self, error, error_size))
        return false;
    self->started = true;
    return true;
}

bool vehicle_step(vehicle *self, double size, char *error, size_t error_size)
{
    if (!(size >= 0) || !(size < 1e6)) {
        snprintf(error, error_size, "a step cannot be %g s", size);
        return false;
    }
    int count = (int)ceil(size / self->value[VEHICLE_STEP] - 1e-9);
    take_values(self);
    self->model->opt.timestep = size / count;
    for (int i = 0; i < count; i++)
        mj_step(self->model, self->data);
    mj_forward(self->model, self->data);
    if (self->data->warning[mjWARN_BADQPOS].number || self->data->warning[mjWARN_BADQVEL].number ||
        self->data->warning[mjWARN_BADQACC].number) {
        snprintf(error, error_size, "the motion grows beyond all bounds");
        return false;
    }
    return true;
}

// ---- state

// Calls `part` with each array of the state and its length.
static size_t walk(const vehicle *self, void (*part)(double *mine, double *bytes, size_t count),
                   double *state)
{
    const mjModel *m = self->model;
    const mjData *d = self->data;
    struct {
        double *at;
        int count;
    } const parts[] = {{d->qpos, m->nq},
                       {d->qvel, m->nv},
                       {d->act, m->na},
                       {m->qpos_spring, m->nq},
                       {(double *)self->value, VEHICLE_VARIABLES}};
    size_t total = 0;
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        if (part)
            part(parts[k].at, state + total, (size_t)parts[k].count);
        total += (size_t)parts[k].count;
    }
    return total;
}

static void save_part(double *mine, double *state, size_t count)
{
    memcpy(state, mine, count * sizeof *state);
}

static void load_part(double *mine, double *state, size_t count)
{
    memcpy(mine, state, count * sizeof *state);
}

size_t vehicle_state_count(const vehicle *self)
{
    return walk(self, NULL, NULL) + 2;
}

void vehicle_save(const vehicle *self, double *state)
{
    state[0] = self->started;
    state[1] = self->stale;
    walk(self, save_part, state + 2);
}

void vehicle_load(vehicle *self, const double *state)
{
    self->started = state[0] != 0;
    self->stale = state[1] != 0;
    walk(self, load_part, (double *)state + 2);
    mj_forward(self->model, self->data);
}
