// The vehicle by MuJoCo (examples/mujoco): alone against closed forms of a plane vehicle on two
// rows of wheels, then under our launcher, against a vehicle of our own with the same masses and
// springs.
// link: -ldl
#include <complex.h>

#include "fmu/fmi2_interface.h"
#include "launchdyn/run.h"
#include "launchdyn/scenario.h"
#include "launchdyn/summary.h"
#include "math/matrices/dense.h"
#include "math/matrices/general_eigen.h"
#include "support/fmu.h"

#define PACKED LD_BINARY_DIR "/examples/mujoco_vehicle.fmu"

// ---- the FMU

static unpacked_fmu fmu;
static char logged[1024];

static void keep_log(void *environment, const char *name, fmi2Status status, const char *category,
                     const char *message, ...)
{
    va_list arguments;
    (void)environment, (void)name, (void)category;
    assert_int_equal(status, fmi2Error);
    va_start(arguments, message);
    vsnprintf(logged, sizeof logged, message, arguments);
    va_end(arguments);
}

// False, with a line that says so: there is no MuJoCo to test.
static bool opened(void)
{
    if (access(PACKED, R_OK) != 0) {
        printf("    skipped: MuJoCo is not here, so there is no vehicle of it\n");
        return false;
    }
    fmu = fmu_unpack(PACKED, 2);
    return true;
}

static void *begin(void)
{
    const fmi2CallbackFunctions call = {.logger = keep_log};
    char uri[256];
    snprintf(uri, sizeof uri, "file://%s", fmu.resources);
    void *c = FMU_FUNCTION(&fmu, fmi2Instantiate)("vehicle", fmi2CoSimulation, fmu.token, uri,
                                                  &call, 0, 0);
    if (!c)
        fail_msg("%s", logged);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetupExperiment)(c, 0, 0, 0, 0, 0), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2EnterInitializationMode)(c), fmi2OK);
    return c;
}

static fmi2Status put(void *c, const char *name, double value)
{
    unsigned reference = reference_of(&fmu, name);
    return FMU_FUNCTION(&fmu, fmi2SetReal)(c, &reference, 1, &value);
}

static double get(void *c, const char *name)
{
    unsigned reference = reference_of(&fmu, name);
    double value;
    if (FMU_FUNCTION(&fmu, fmi2GetReal)(c, &reference, 1, &value) != fmi2OK)
        fail_msg("%s: %s", name, logged);
    return value;
}

static void start(void *c)
{
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2ExitInitializationMode)(c), fmi2OK);
}

static void step(void *c, double t, double size)
{
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2DoStep)(c, t, size, 1), fmi2OK);
}

static void end(void *c)
{
    FMU_FUNCTION(&fmu, fmi2FreeInstance)(c);
}

// ---- closed forms

// The numbers of vehicle.xml.
static const double CHASSIS = 8000, AZIMUTH = 600, ELEVATION = 900, WHEEL = 250, G = 9.80665;
static const double UP = 4e5, UP_DAMPING = 2.5e4, TYRE_UP = 1.1e6, TYRE_DAMPING = 4e3;
static const double SIDE = 2e6, SIDE_DAMPING = 2e4, RADIUS = 0.55, MOUNT = -0.7;
static const double AZIMUTH_AT = 0.9, ELEVATION_AT = 1.3; // their mass centres, above the chassis'

// A plane through the vehicle: s along x, or across, along -z. Its coordinates: s and y of the
// chassis, its turn from s to y; s and y of two rows of two wheels; last, where the plane has it,
// the angle of the elevation's hinge.
typedef struct plane {
    int count;                 // of coordinates
    double half;               // [m] from the chassis to the rows of wheels
    double inertia, platform;  // [kg m2] of what turns with the chassis; on the hinge
    double tyre;               // [N/m] along s
    double lock, lock_damping; // [N m/rad], [N m s/rad] of the hinge
} plane;

static const double PI = 3.14159265358979324;

enum { S, Y, TURN, ROW, HINGE = ROW + 4, MOST, STATES = 2 * MOST };

static const plane lengthwise = {.count = MOST,
                                 .half = 2,
                                 .inertia = 2.8e4 + 200,
                                 .platform = 400,
                                 .tyre = 4e5,
                                 .lock = 6e6,
                                 .lock_damping = 6e4};
static const plane across = {.count = MOST - 1, .half = 1, .inertia = 7e3 + 200 + 300, .tyre = 5e5};

// Deflections at rest: of tyres and of suspensions, compressed.
static double tyre_sag(void)
{
    return (CHASSIS + AZIMUTH + ELEVATION + 4 * WHEEL) * G / (4 * TYRE_UP);
}

static double suspension_sag(void)
{
    return (CHASSIS + AZIMUTH + ELEVATION) * G / (4 * UP);
}

// Energy [J] of heights and springs, exact but for the tyre along s: its contact point moves with
// the wheel and, by the wheel's height, with the turn.
static double potential(const plane *p, const double *q)
{
    double c = cos(q[TURN]), s = sin(q[TURN]);
    double sum = G * (CHASSIS * q[Y] + AZIMUTH * (q[Y] + AZIMUTH_AT * c) +
                      ELEVATION * (q[Y] + ELEVATION_AT * c));
    for (int row = 0; row < 2; row++) {
        double at = row ? p->half : -p->half, w_s = q[ROW + 2 * row], w_y = q[ROW + 2 * row + 1];
        double r_s = w_s - q[S], r_y = w_y - q[Y];
        double d_s = c * r_s + s * r_y - at, d_y = c * r_y - s * r_s - MOUNT;
        double up = RADIUS - w_y, side = w_s - at + (RADIUS - tyre_sag()) * q[TURN];
        sum += 2 * WHEEL * G * w_y + SIDE * d_s * d_s + UP * d_y * d_y + TYRE_UP * up * up +
               p->tyre * side * side;
    }
    return sum + (p->count > HINGE ? 0.5 * p->lock * q[HINGE] * q[HINGE] : 0);
}

static void rest_of(const plane *p, double *q)
{
    memset(q, 0, MOST * sizeof *q);
    for (int row = 0; row < 2; row++) {
        q[ROW + 2 * row] = row ? p->half : -p->half;
        q[ROW + 2 * row + 1] = RADIUS - tyre_sag();
    }
    q[Y] = RADIUS - tyre_sag() - MOUNT - suspension_sag();
}

// Small displacements from rest: M q'' + D q' + K q = f.
typedef struct linear_plane {
    int count;
    double M[MOST * MOST], D[MOST * MOST], K[MOST * MOST];
} linear_plane;

// Adds c b b' to D: a damper whose length changes by b . q.
static void add_damper(linear_plane *self, const double *b, double c)
{
    for (int i = 0; i < self->count; i++)
        for (int j = 0; j < self->count; j++)
            self->D[i * self->count + j] += c * b[i] * b[j];
}

static void add_mass(linear_plane *self, double m, double height)
{
    int n = self->count;
    self->M[S * n + S] += m;
    self->M[Y * n + Y] += m;
    self->M[S * n + TURN] -= m * height;
    self->M[TURN * n + S] -= m * height;
    self->M[TURN * n + TURN] += m * height * height;
}

static double curvature(const plane *p, int i, int j)
{
    static const double STEP = 1e-4;
    double q[MOST], sum = 0;
    for (int k = 0; k < 4; k++) {
        rest_of(p, q);
        q[i] += k & 1 ? STEP : -STEP;
        q[j] += k & 2 ? STEP : -STEP;
        sum += ((k == 0 || k == 3) ? 1 : -1) * potential(p, q);
    }
    return sum / (4 * STEP * STEP);
}

static linear_plane linear_of(const plane *p)
{
    linear_plane self = {.count = p->count};
    int n = p->count;
    add_mass(&self, CHASSIS, 0);
    add_mass(&self, AZIMUTH, AZIMUTH_AT);
    add_mass(&self, ELEVATION, ELEVATION_AT);
    self.M[TURN * n + TURN] += p->inertia + p->platform;
    if (n > HINGE) {
        self.M[TURN * n + HINGE] = self.M[HINGE * n + TURN] = self.M[HINGE * n + HINGE] =
            p->platform;
        add_damper(&self, (double[MOST]){[HINGE] = 1}, p->lock_damping);
    }
    double height = RADIUS - tyre_sag(), drop = -MOUNT - suspension_sag();
    for (int row = 0; row < 2; row++) {
        double at = row ? p->half : -p->half;
        int s = ROW + 2 * row, y = s + 1;
        self.M[s * n + s] = self.M[y * n + y] = 2 * WHEEL;
        double d_s[MOST] = {[S] = -1, [TURN] = -drop}, d_y[MOST] = {[Y] = -1, [TURN] = -at};
        double c_s[MOST] = {[TURN] = height}, c_y[MOST] = {0};
        d_s[s] = d_y[y] = c_s[s] = c_y[y] = 1;
        add_damper(&self, d_s, 2 * SIDE_DAMPING);
        add_damper(&self, d_y, 2 * UP_DAMPING);
        add_damper(&self, c_s, 2 * TYRE_DAMPING);
        add_damper(&self, c_y, 2 * TYRE_DAMPING);
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            self.K[i * n + j] = curvature(p, i, j);
    return self;
}

// b := A^-1 b.
static void solve(int n, const double *A, double *b)
{
    double LU[STATES * STATES];
    int pivot[STATES];
    memcpy(LU, A, (size_t)(n * n) * sizeof *LU);
    assert_int_equal(lu_factor(n, LU, pivot), 0);
    lu_solve(n, LU, pivot, b);
}

// Rates of (q, q').
static void linear_rates(const linear_plane *self, const double *load, const double *x,
                         double *rate)
{
    int n = self->count;
    for (int i = 0; i < n; i++) {
        rate[i] = x[n + i];
        rate[n + i] = load[i];
        for (int j = 0; j < n; j++)
            rate[n + i] -= self->K[i * n + j] * x[j] + self->D[i * n + j] * x[n + j];
    }
    solve(n, self->M, rate + n);
}

// By the classical method of order 4.
static void linear_step(const linear_plane *self, const double *load, double h, double *x)
{
    double k[4][STATES], at[STATES];
    static const double share[4] = {0, 0.5, 0.5, 1};
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < 2 * self->count; i++)
            at[i] = x[i] + (stage ? h * share[stage] * k[stage - 1][i] : 0);
        linear_rates(self, load, at, k[stage]);
    }
    for (int i = 0; i < 2 * self->count; i++)
        x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
}

static int compare_decay(const void *a, const void *b)
{
    double left = -creal(*(const double complex *)a), right = -creal(*(const double complex *)b);
    return (left > right) - (left < right);
}

// Eigenvalues with positive imaginary part.
static int upper_eigenvalues(int n, double *A, double complex *exponent)
{
    double re[STATES], im[STATES];
    int count = 0;
    assert_int_equal(general_eigen(n, A, re, im, NULL, NULL), 0);
    for (int i = 0; i < n; i++)
        if (im[i] > 0)
            exponent[count++] = re[i] + I * im[i];
    return count;
}

// Exponents [1/s] of its natural motions, the slowest to decay first.
static void linear_exponents(const linear_plane *self, double complex exponent[STATES])
{
    int n = self->count;
    double A[STATES * STATES], x[STATES], rate[STATES];
    for (int j = 0; j < 2 * n; j++) {
        memset(x, 0, sizeof x);
        x[j] = 1;
        linear_rates(self, (double[MOST]){0}, x, rate);
        memcpy(A + j * 2 * n, rate, (size_t)(2 * n) * sizeof *rate);
    }
    int count = upper_eigenvalues(2 * n, A, exponent);
    qsort(exponent, (size_t)count, sizeof *exponent, compare_decay);
}

// Those of a signal of `modes` decaying waves, from y_k = sum of a_i y_(k-i).
enum { SAMPLES = 40 };
static void signal_exponents(const double *y, double dt, int modes, double complex *exponent)
{
    int n = 2 * modes;
    double A[16] = {0}, a[4] = {0}, companion[16] = {0};
    for (int k = n; k < SAMPLES; k++)
        for (int i = 0; i < n; i++) {
            a[i] += y[k] * y[k - 1 - i];
            for (int j = 0; j < n; j++)
                A[i * n + j] += y[k - 1 - i] * y[k - 1 - j];
        }
    solve(n, A, a);
    for (int i = 0; i < n; i++) {
        companion[i * n] = a[i]; // by columns: row 0
        if (i + 1 < n)
            companion[i * n + i + 1] = 1;
    }
    assert_int_equal(upper_eigenvalues(n, companion, exponent), modes);
    for (int i = 0; i < modes; i++)
        exponent[i] = clog(exponent[i]) / dt;
    qsort(exponent, (size_t)modes, sizeof *exponent, compare_decay);
}

// ---- alone

// A wrench [N], [N m] at the tube's rear end.
typedef struct wrench {
    double force[3], moment[3];
} wrench;

static void load(void *c, const wrench *by)
{
    static const char *const axis[] = {"x", "y", "z"};
    char name[64];
    for (int i = 0; i < 3; i++) {
        snprintf(name, sizeof name, "input.wrench.force.%s", axis[i]);
        assert_int_equal(put(c, name, by->force[i]), fmi2OK);
        snprintf(name, sizeof name, "input.wrench.moment.%s", axis[i]);
        assert_int_equal(put(c, name, by->moment[i]), fmi2OK);
    }
}

static void sags_by_its_weight(void **state)
{
    (void)state;
    if (!opened())
        return;
    void *c = begin();
    assert_int_equal(put(c, "pitch", 0.3), fmi2OK);
    CHECK_NEAR("height of the chassis [m]", get(c, "chassis.position.y"),
               RADIUS - tyre_sag() - MOUNT - suspension_sag(), 1e-12);
    CHECK_NEAR("tube, 1 m behind the hinge and 0.2 m above [m]", get(c, "base.position.x"),
               -cos(0.3) - 0.2 * sin(0.3), 1e-12);
    CHECK_NEAR("pitch of the tube [rad]", 2 * asin(get(c, "base.quaternion.3")), 0.3, 1e-12);
    start(c);
    double before = get(c, "base.position.y");
    step(c, 0, 1);
    CHECK_BELOW("stays where it rests [m]", get(c, "base.position.y") - before, 1e-12);
    CHECK_BELOW("and does not move [m/s]", get(c, "base.velocity.y"), 1e-11);
    end(c);

    // more weight: by the same springs
    c = begin();
    load(c, &(wrench){.force = {0, -2000, 0}, .moment = {-200, 0, -2000}});
    double sag = RADIUS - tyre_sag() - MOUNT - suspension_sag() - get(c, "chassis.position.y");
    CHECK_BELOW("sag under 2 kN, of itself", sag / (2000 / (4 * TYRE_UP) + 2000 / (4 * UP)) - 1,
                1e-9);
    end(c);
    fmu_close(&fmu);
}

// What pushes along the ground, its moment about the wheels' contacts cancelled.
static wrench push_along_ground(void *c, double force)
{
    return (wrench){.force = {force, 0, 0}, .moment = {0, 0, force * get(c, "base.position.y")}};
}

static void stands_as_far_as_tyres_hold(void **state)
{
    (void)state;
    if (!opened())
        return;
    void *c = begin();
    load(c, &(wrench){.force = {9e3, -2e3, -5e3}, .moment = {500, 6e3, 3e3}});
    start(c);
    double z = get(c, "base.position.z");
    step(c, 0, 1);
    CHECK_BELOW("stays at rest under a wrench [m]", get(c, "base.position.z") - z, 1e-11);
    end(c);

    // friction 0.8
    double held, limit = 0.8 * 4 * TYRE_UP * tyre_sag();
    unsigned reference = reference_of(&fmu, "base.position.x");
    for (int beyond = 0; beyond < 2; beyond++) {
        c = begin();
        wrench push = push_along_ground(c, limit * (beyond ? 1.01 : 0.99));
        load(c, &push);
        fmi2Status status = FMU_FUNCTION(&fmu, fmi2GetReal)(c, &reference, 1, &held);
        assert_int_equal(status, beyond ? fmi2Error : fmi2OK);
        end(c);
    }
    assert_non_null(strstr(logged, "finds no equilibrium"));
    fmu_close(&fmu);
}

// What is watched of a plane's coordinate: its place and its speed.
typedef struct watched {
    int coordinate;
    const char *place, *speed;
    double place_of, speed_of; // place and speed of a coordinate, a rate of 1
} watched;

// At rest a load comes; the motion is that of the linear plane, what decays of it has its
// exponents, what is left its sag.
static void follows(const plane *p, const watched *at, const wrench *by, const double push[MOST],
                    int modes)
{
    enum { SKIPPED = 12 };
    const double dt = 0.05;
    linear_plane linear = linear_of(p);
    double x[STATES] = {0}, sag[MOST], signal[SKIPPED + SAMPLES], worst = 0, largest = 0;
    double complex found[STATES], expected[STATES];
    void *c = begin();
    assert_int_equal(put(c, "step", 1e-3), fmi2OK);
    start(c);
    double before = get(c, at->place);
    load(c, by);
    for (int i = 0; i < SKIPPED + SAMPLES; i++) {
        step(c, i * dt, dt);
        for (int k = 0; k < 100; k++)
            linear_step(&linear, push, dt / 100, x);
        signal[i] = get(c, at->speed);
        double told = at->speed_of * x[p->count + at->coordinate];
        worst = fmax(worst, fabs(signal[i] - told));
        largest = fmax(largest, fabs(told));
    }
    CHECK_BELOW("motion, of the largest", worst / largest, 1e-6);
    signal_exponents(signal + SKIPPED, dt, modes, found);
    linear_exponents(&linear, expected);
    for (int i = 0; i < modes; i++) {
        // the slowest of the plane that are in the signal: heave is not among what turns
        int best = 0;
        for (int k = 1; k < p->count; k++)
            if (cabs(found[i] - expected[k]) < cabs(found[i] - expected[best]))
                best = k;
        printf("    %.5f Hz, damping %.5f\n", cabs(expected[best]) / (2 * PI),
               -creal(expected[best]) / cabs(expected[best]));
        CHECK_BELOW("natural frequency, of itself", cabs(found[i]) / cabs(expected[best]) - 1,
                    1e-7);
        CHECK_BELOW(
            "its damping ratio, of itself",
            creal(found[i]) / creal(expected[best]) * cabs(expected[best]) / cabs(found[i]) - 1,
            1e-3);
    }
    memcpy(sag, push, sizeof sag);
    solve(p->count, linear.K, sag);
    step(c, (SKIPPED + SAMPLES) * dt, 20);
    CHECK_BELOW("sag in the end, of itself",
                (get(c, at->place) - before) / (at->place_of * sag[at->coordinate]) - 1, 1e-7);
    end(c);
}

static void moves_as_a_plane_vehicle(void **state)
{
    (void)state;
    if (!opened())
        return;
    // half the turn's sine stands in the quaternion
    printf("    heave\n");
    follows(&lengthwise, &(watched){Y, "chassis.position.y", "chassis.velocity.y", 1, 1},
            &(wrench){.force = {0, -1000, 0}, .moment = {-100, 0, -1000}},
            (double[MOST]){[Y] = -1000}, 1);
    printf("    pitch and surge: turn\n");
    follows(&lengthwise, &(watched){TURN, "chassis.quaternion.3", "chassis.rate.z", 0.5, 1},
            &(wrench){.moment = {0, 0, 300}}, (double[MOST]){[TURN] = 300, [HINGE] = 300}, 2);
    printf("    pitch and surge: along\n");
    follows(&lengthwise, &(watched){S, "chassis.position.x", "chassis.velocity.x", 1, 1},
            &(wrench){.moment = {0, 0, 300}}, (double[MOST]){[TURN] = 300, [HINGE] = 300}, 2);
    printf("    roll and sway: turn\n");
    follows(&across, &(watched){TURN, "chassis.quaternion.1", "chassis.rate.x", 0.5, 1},
            &(wrench){.moment = {200, 0, 0}}, (double[MOST]){[TURN] = 200}, 2);
    printf("    roll and sway: across\n");
    follows(&across, &(watched){S, "chassis.position.z", "chassis.velocity.z", -1, -1},
            &(wrench){.moment = {200, 0, 0}}, (double[MOST]){[TURN] = 200}, 2);
    fmu_close(&fmu);
}

// Without damping the load's work is what the energy gains.
static void keeps_its_energy(void **state)
{
    (void)state;
    if (!opened())
        return;
    void *c = begin();
    double worst = 0, largest = 0;
    const double force[3] = {300, -800, 200};
    assert_int_equal(put(c, "damping_scale", 0), fmi2OK);
    start(c);
    double r[3] = {get(c, "base.position.x"), get(c, "base.position.y"), get(c, "base.position.z")};
    double energy = get(c, "energy");
    load(c, &(wrench){.force = {force[0], force[1], force[2]}});
    for (int i = 0; i < 200; i++) {
        step(c, i * 0.01, 0.01);
        double work = force[0] * (get(c, "base.position.x") - r[0]) +
                      force[1] * (get(c, "base.position.y") - r[1]) +
                      force[2] * (get(c, "base.position.z") - r[2]);
        worst = fmax(worst, fabs(get(c, "energy") - energy - work));
        largest = fmax(largest, fabs(work));
    }
    CHECK_BELOW("energy gained less work, of the largest work", worst / largest, 5e-6);
    end(c);
    fmu_close(&fmu);
}

static const char *const watched_outputs[] = {
    "base.position.x",    "base.position.y", "base.quaternion.2", "base.velocity.y", "base.rate.z",
    "chassis.position.z", "energy"};
enum { TOLD = sizeof watched_outputs / sizeof *watched_outputs };

static void comes_back_to_the_bit(void **state)
{
    (void)state;
    if (!opened())
        return;
    void *c = begin(), *other = begin(), *saved = NULL, *back = NULL;
    size_t size;
    double first[TOLD];
    int unequal = 0;
    assert_int_equal(put(c, "pitch", 0.35), fmi2OK);
    start(c);
    load(c, &(wrench){.force = {5000, -900, 300}, .moment = {100, -200, 4000}});
    step(c, 0, 0.0173);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2GetFMUstate)(c, &saved), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SerializedFMUstateSize)(c, saved, &size), fmi2OK);
    char *bytes = malloc(size);
    assert_non_null(bytes);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SerializeFMUstate)(c, saved, bytes, size - 1),
                     fmi2Error);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SerializeFMUstate)(c, saved, bytes, size), fmi2OK);
    step(c, 0.0173, 0.1);
    for (int i = 0; i < TOLD; i++)
        first[i] = get(c, watched_outputs[i]);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetFMUstate)(c, saved), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2DeSerializeFMUstate)(other, bytes, size, &back),
                     fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetFMUstate)(other, back), fmi2OK);
    void *const again[] = {c, other};
    for (int k = 0; k < 2; k++) {
        step(again[k], 0.0173, 0.1);
        for (int i = 0; i < TOLD; i++) {
            double value = get(again[k], watched_outputs[i]);
            unequal += memcmp(&first[i], &value, sizeof value) != 0;
        }
    }
    CHECK_BELOW("outputs that differ after a state came back", unequal, 0);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2FreeFMUstate)(c, &saved), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2FreeFMUstate)(other, &back), fmi2OK);
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2DeSerializeFMUstate)(other, bytes, size - 8, &back),
                     fmi2Error);
    assert_non_null(strstr(logged, "are no state of this vehicle"));
    free(bytes);
    end(c);
    end(other);
    fmu_close(&fmu);
}

static void refuses_what_is_wrong(void **state)
{
    (void)state;
    if (!opened())
        return;
    void *c = begin();
    assert_int_equal(put(c, "base.position.x", 1), fmi2Error);
    assert_string_equal(logged, "variable 6 is neither an input nor a parameter");
    assert_int_equal(put(c, "pitch", NAN), fmi2Error);
    assert_string_equal(logged, "variable 33 cannot be nan");
    assert_int_equal(put(c, "step", 0), fmi2Error);
    start(c);
    assert_int_equal(put(c, "pitch", 0), fmi2Error);
    assert_string_equal(logged, "variable 33 is fixed once the vehicle has started");
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2DoStep)(c, 1, 0.1, 1), fmi2Error);
    assert_string_equal(logged, "a step from 1 s, the vehicle is at 0 s");
    assert_int_equal(FMU_FUNCTION(&fmu, fmi2SetRealInputDerivatives)(c, NULL, 0, NULL, NULL),
                     fmi2Error);
    end(c);
    const fmi2CallbackFunctions call = {.logger = keep_log};
    assert_null(FMU_FUNCTION(&fmu, fmi2Instantiate)("x", fmi2CoSimulation, fmu.token, "/nowhere",
                                                    &call, 0, 0));
    assert_non_null(strstr(logged, "/nowhere/vehicle.xml"));
    fmu_close(&fmu);
}

// ---- under the launcher

typedef struct launch {
    ld_model *model;
    ld_simulation *simulation;
    ld_run *run;
} launch;

static launch launch_of(const char *scenario, const char *another)
{
    const char *const set[] = {"run.tolerance=1e-8", another};
    launch self = {0};
    char path[128];
    ld_messages messages;
    ld_error error;
    snprintf(path, sizeof path, "%s/%s", shell.folder, scenario);
    if (ld_scenario_read(path, set, 1 + (another != NULL), &self.model, &messages) != LD_OK) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    assert_int_equal(ld_simulation_create(self.model, &self.simulation, &error), LD_OK);
    return self;
}

static void launch_begin(launch *self, const ld_base_frame *base)
{
    ld_error error;
    if (self->run)
        ld_run_end(self->run, NULL, NULL);
    if (ld_run_begin(self->simulation, &(ld_run_options){.base = base}, &self->run, &error))
        fail_msg("%s", error.text);
}

static void launch_end(launch *self)
{
    ld_run_end(self->run, NULL, NULL);
    ld_simulation_free(self->simulation);
    ld_model_free(self->model);
}

static ld_base_frame frame_of(void *c)
{
    ld_base_frame base;
    for (int i = 0; i < 3; i++) {
        char name[64], axis = "xyz"[i];
        snprintf(name, sizeof name, "base.position.%c", axis);
        base.position[i] = get(c, name);
        snprintf(name, sizeof name, "base.velocity.%c", axis);
        base.velocity[i] = get(c, name);
        snprintf(name, sizeof name, "base.rate.%c", axis);
        base.rate[i] = get(c, name);
    }
    for (int i = 0; i < 4; i++) {
        char name[64];
        snprintf(name, sizeof name, "base.quaternion.%d", i);
        base.quaternion[i] = get(c, name);
    }
    return base;
}

static wrench wrench_of(const launch *self)
{
    ld_base_wrench w;
    wrench of;
    assert_int_equal(ld_run_base_wrench(self->run, &w, NULL), LD_OK);
    memcpy(of.force, w.force, sizeof of.force);
    memcpy(of.moment, w.moment, sizeof of.moment);
    return of;
}

static wrench between(const wrench *a, const wrench *b)
{
    wrench mean;
    for (int i = 0; i < 3; i++) {
        mean.force[i] = 0.5 * (a->force[i] + b->force[i]);
        mean.moment[i] = 0.5 * (a->moment[i] + b->moment[i]);
    }
    return mean;
}

static double number(const launch *self, const char *name)
{
    double value;
    assert_int_equal(ld_run_number(self->run, name, &value, NULL), LD_OK);
    return value;
}

static double exit_number(const launch *self, const char *name)
{
    double value;
    assert_int_equal(ld_summary_number(ld_run_summary(self->run), name, &value, NULL), LD_OK);
    return value;
}

// The launcher and the vehicle in the equilibrium of both.
static wrench begin_together(launch *launcher, void *c, double pitch)
{
    wrench w;
    assert_int_equal(put(c, "pitch", pitch), fmi2OK);
    int turn = 0;
    do {
        ld_base_frame base = frame_of(c);
        launch_begin(launcher, &base);
        w = wrench_of(launcher);
        load(c, &w);
    } while (++turn < 4);
    start(c);
    return w;
}

// What both report of the vehicle's motion, and its largest difference as a share of the largest
// motion.
typedef struct motion {
    const char *ours, *its;
    double bound, rest[2], worst, largest;
} motion;

typedef struct exit_figure {
    const char *name;
    double bound, difference; // of itself
} exit_figure;

static void note_rest(motion *self, const launch *own, void *c)
{
    self->rest[0] = number(own, self->ours);
    self->rest[1] = get(c, self->its);
    self->worst = self->largest = 0;
    CHECK_BELOW("difference at rest", self->rest[1] - self->rest[0], 1e-12);
}

static void note_motion(motion *self, const launch *own, void *c)
{
    double ours = number(own, self->ours) - self->rest[0];
    self->worst = fmax(self->worst, fabs(get(c, self->its) - self->rest[1] - ours));
    self->largest = fmax(self->largest, fabs(ours));
}

// One exchange: the launcher first, reported where its base is, then the vehicle under the mean of
// the wrenches at both ends.
static wrench exchange(const launch *told, void *c, const wrench *before, int k, double h,
                       double end_of_step)
{
    ld_base_frame base = frame_of(c);
    if (k > 0)
        assert_int_equal(ld_run_set_base(told->run, &base, NULL), LD_OK);
    assert_int_equal(ld_run_advance(told->run, end_of_step, NULL), LD_OK);
    wrench after = wrench_of(told), mean = between(before, &after);
    load(c, &mean);
    step(c, k * h, h);
    return after;
}

// A launch from both vehicles, exchanges each h [s].
static void launch_both(double h, motion *of, int motions, exit_figure *figure, int figures)
{
    launch told = launch_of("external.yaml", NULL),
           own = launch_of("examples/mujoco/own-vehicle.yaml", NULL);
    void *c = begin();
    launch_begin(&own, NULL);
    wrench w = begin_together(&told, c, 19.8 * PI / 180);
    double t0 = ld_run_time(told.run);
    for (int i = 0; i < motions; i++)
        note_rest(of + i, &own, c);
    for (int k = 0; !ld_run_is_finished(told.run) || !ld_run_is_finished(own.run); k++) {
        double t = t0 + (k + 1) * h;
        if (!ld_run_is_finished(told.run))
            w = exchange(&told, c, &w, k, h, t);
        assert_int_equal(ld_run_advance(own.run, t, NULL), LD_OK);
        for (int i = 0; i < motions && ld_run_time(own.run) == t && ld_run_time(told.run) == t; i++)
            note_motion(of + i, &own, c);
    }
    for (int i = 0; i < figures; i++)
        figure[i].difference =
            exit_number(&told, figure[i].name) / exit_number(&own, figure[i].name) - 1;
    end(c);
    launch_end(&told);
    launch_end(&own);
}

static void carries_our_launcher(void **state)
{
    (void)state;
    if (!opened())
        return;
    static motion of[] = {{.ours = "chassis.vx", .its = "chassis.velocity.x", .bound = 2e-4},
                          {.ours = "chassis.vy", .its = "chassis.velocity.y", .bound = 1e-4},
                          {.ours = "chassis.vz", .its = "chassis.velocity.z", .bound = 1e-4},
                          {.ours = "base.x", .its = "base.position.x", .bound = 5e-5},
                          {.ours = "base.y", .its = "base.position.y", .bound = 5e-5},
                          {.ours = "base.z", .its = "base.position.z", .bound = 1e-4}};
    static exit_figure figure[] = {{.name = "rocket.1.yaw_rate", .bound = 1e-3},
                                   {.name = "rocket.1.pitch_rate", .bound = 1e-6},
                                   {.name = "rocket.1.tip_off.pitch", .bound = 5e-6},
                                   {.name = "rocket.1.tip_off.yaw", .bound = 1e-4},
                                   {.name = "rocket.1.exit_speed", .bound = 2e-9}};
    enum { MOTIONS = sizeof of / sizeof *of, FIGURES = sizeof figure / sizeof *figure };
    assert_int_equal(run("printf '%s\\n' 'include: examples/mujoco/launcher.yaml' "
                         "'base: {kind: external}' >external.yaml"),
                     0);
    launch_both(1e-4, of, MOTIONS, figure, FIGURES);
    for (int i = 0; i < MOTIONS; i++) {
        printf("    %s, up to %g:\n", of[i].ours, of[i].largest);
        CHECK_BELOW("  difference, of that", of[i].worst / of[i].largest, of[i].bound);
    }
    for (int i = 0; i < FIGURES; i++)
        CHECK_BELOW(figure[i].name, figure[i].difference, figure[i].bound);
    double difference = figure[0].difference;
    launch_both(2e-4, of, 0, figure, 1);
    CHECK_WITHIN("order of the exchange", log2(figure[0].difference / difference), 1.8, 2.2);
    fmu_close(&fmu);
}

// Takes both on each millisecond; the largest difference of a column, of its largest motion.
static void advance_both(const launch *own, const launch *foreign, int columns,
                         const char *const *column)
{
    double rest[8], worst[8] = {0}, largest[8] = {0};
    for (int i = 0; i < columns; i++)
        rest[i] = number(own, column[i]);
    for (int k = -20; k < 159; k++) {
        assert_int_equal(ld_run_advance(own->run, 1e-3 * k, NULL), LD_OK);
        assert_int_equal(ld_run_advance(foreign->run, 1e-3 * k, NULL), LD_OK);
        for (int i = 0; i < columns; i++) {
            double ours = number(own, column[i]);
            worst[i] = fmax(worst[i], fabs(number(foreign, column[i]) - ours));
            largest[i] = fmax(largest[i], fabs(ours - rest[i]));
        }
    }
    for (int i = 0; i < columns; i++)
        CHECK_BELOW(column[i], worst[i] / largest[i], 1e-4);
}

// The same as a scenario: the base is the FMU.
static void carries_it_as_a_base(void **state)
{
    (void)state;
    if (!opened())
        return;
    static const exit_figure figure[] = {{.name = "rocket.1.yaw_rate", .bound = 1e-3},
                                         {.name = "rocket.1.pitch_rate", .bound = 2e-5},
                                         {.name = "rocket.1.tip_off.pitch", .bound = 1e-7},
                                         {.name = "rocket.1.tip_off.yaw", .bound = 2e-4},
                                         {.name = "rocket.1.exit_speed", .bound = 2e-8}};
    static const char *const column[] = {"base.x", "base.y", "base.z", "base.pitch"};
    launch foreign = launch_of("examples/mujoco/launch.yaml", "base.file=" PACKED),
           own = launch_of("examples/mujoco/own-vehicle.yaml", NULL);
    launch_begin(&own, NULL);
    launch_begin(&foreign, NULL);
    advance_both(&own, &foreign, 4, column);
    assert_int_equal(ld_run_advance(own.run, INFINITY, NULL), LD_OK);
    assert_int_equal(ld_run_advance(foreign.run, INFINITY, NULL), LD_OK);
    for (size_t i = 0; i < sizeof figure / sizeof *figure; i++)
        CHECK_BELOW(figure[i].name,
                    exit_number(&foreign, figure[i].name) / exit_number(&own, figure[i].name) - 1,
                    figure[i].bound);
    launch_end(&foreign);
    launch_end(&own);
    fmu_close(&fmu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sags_by_its_weight),       cmocka_unit_test(stands_as_far_as_tyres_hold),
        cmocka_unit_test(moves_as_a_plane_vehicle), cmocka_unit_test(keeps_its_energy),
        cmocka_unit_test(comes_back_to_the_bit),    cmocka_unit_test(refuses_what_is_wrong),
        cmocka_unit_test(carries_our_launcher),     cmocka_unit_test(carries_it_as_a_base),
    };
    return cmocka_run_group_tests(tests, shell_make, shell_remove);
}
