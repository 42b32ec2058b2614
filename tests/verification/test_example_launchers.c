// ctest: slow
// Examples of examples/multibody against equations of their own: places of point masses as
// functions of coordinates, written out here (support/point_masses.h, support/lumped_launch.h).
// Rail or tube and its supports are rigid, the rocket slides without play and friction.
#include "support/check.h"
#include "support/lumped_launch.h"

// A rocket that slides without play has two.
#define TWO_ADAPTORS "rocket.adaptors=[{name: rear, at: 0 m}, {name: front, at: 1.2 m}]"

// A base: its coordinates are angles and displacements of its joints.
typedef struct launcher {
    const ld_model *model;
    lumped_base base;
    double point[MOST_POINTS][3];
    int body[4], marker[16];       // first points of bodies; markers
    double preload[2], neutral[2]; // of locks
} launcher;

static void put_body(const launcher *self, int body, const cplx from[3], const cplx_matrix *A,
                     cplx (*r)[3])
{
    int first = self->body[body];
    for (int k = 0; k < RIGID_POINTS; k++)
        put_point(from, A, self->point[first + k], r[first + k]);
}

static void put_marker(const launcher *self, int marker, const cplx from[3], const cplx_matrix *A,
                       cplx (*r)[3])
{
    int point = self->marker[marker];
    put_point(from, A, self->point[point], r[point]);
}

static void put_tube(const launcher *self, const cplx from[3], const cplx_matrix *A,
                     lumped_frame *tube)
{
    put_point(from, A, self->model->tubes.layout.first, tube->r);
    tube->A = turns(*A, turn_z(self->model->base.elevation));
}

static void begin(launcher *self, const ld_model *model, int coordinates, int extra)
{
    memset(self, 0, sizeof *self);
    self->model = model;
    self->base = (lumped_base){.coordinates = coordinates, .extra = extra, .self = self};
}

static int add_marker(launcher *self, double x, double y, double z)
{
    return lumped_add_marker(&self->base, self->point, (double[]){x, y, z});
}

// ---- a rail that hangs on two wires: universal joints above, axes z and then x, points below

enum { LEFT_Z, LEFT_X, FRAME_YAW, FRAME_PITCH, SWING_COORDINATES };
enum { LEFT = 0, RIGHT = 1, SPREADER = 2, FRAME = 3 };

// The frame's roll, with which the right shackle is a wire's length from its hook: the smaller root
// of p sin(roll) + r cos(roll) = K by the tangent of half the roll. `e`: from the right hook to the
// left shackle, turned back by yaw and pitch.
static cplx roll_of(const cplx e[3], double apart, double length)
{
    cplx square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
    cplx K = (length * length - square - apart * apart) / (2 * apart), p = -e[1], r = e[2];
    return 2 * catan((K - r) / (p + csqrt(p * p - (K + r) * (K - r))));
}

typedef struct swing {
    cplx hook[2][3], shackle[2][3], right[2]; // [left, right]; angles of the right wire
    cplx_matrix frame;
} swing;

static void find_swing(const launcher *self, const cplx *q, swing *at)
{
    static const char *const hook[] = {"left-hook", "right-hook"};
    const double *arm = lumped_joint(self->model, "arm")->at,
                 *base = lumped_joint(self->model, "base")->at,
                 *end = lumped_joint(self->model, "left-shackle")->at,
                 *far = lumped_joint(self->model, "right-shackle")->body_at;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++)
            at->hook[k][i] = base[i] + arm[i] + lumped_joint(self->model, hook[k])->at[i];
    cplx_matrix left = turns(turn_z(q[LEFT_Z]), turn_x(q[LEFT_X]));
    put_point(at->hook[0], &left, end, at->shackle[0]);
    cplx d[3], e[3], way[3];
    double length = -end[1];
    for (int i = 0; i < 3; i++)
        d[i] = at->shackle[0][i] - at->hook[1][i];
    cplx_matrix back = turns(turn_z(-q[FRAME_PITCH]), turn_y(-q[FRAME_YAW]));
    for (int i = 0; i < 3; i++)
        e[i] = back.a[i][0] * d[0] + back.a[i][1] * d[1] + back.a[i][2] * d[2];
    at->frame = turns(turns(turn_y(q[FRAME_YAW]), turn_z(q[FRAME_PITCH])),
                      turn_x(roll_of(e, far[2], length)));
    put_point(at->shackle[0], &at->frame, far, at->shackle[1]);
    for (int i = 0; i < 3; i++)
        way[i] = (at->shackle[1][i] - at->hook[1][i]) / length;
    at->right[0] = catan(-way[0] / way[1]);
    at->right[1] = -casin(way[2]);
}

static void place_swing(const void *it, cplx t, const cplx *q, cplx (*r)[3], lumped_frame *tube)
{
    const launcher *self = it;
    const double *hanger = lumped_joint(self->model, "hanger")->at;
    swing at;
    cplx middle[3];
    (void)t;
    find_swing(self, q, &at);
    cplx_matrix left = turns(turn_z(q[LEFT_Z]), turn_x(q[LEFT_X]));
    cplx_matrix right = turns(turn_z(at.right[0]), turn_x(at.right[1]));
    put_body(self, LEFT, at.hook[0], &left, r);
    put_body(self, RIGHT, at.hook[1], &right, r);
    put_body(self, SPREADER, at.shackle[0], &at.frame, r);
    put_point(at.shackle[0], &at.frame, hanger, middle);
    put_body(self, FRAME, middle, &at.frame, r);
    put_marker(self, 0, middle, &at.frame, r);
    put_tube(self, middle, &at.frame, tube);
}

// The damper at the right hook, whose angles follow from the coordinates.
static void damp_right(const launcher *self, const mass_motion *now, double damping, double *Q)
{
    static const double tiny = 1e-30;
    double J[2][SWING_COORDINATES], rate[2] = {0};
    for (int j = 0; j < SWING_COORDINATES; j++) {
        cplx q[SWING_COORDINATES];
        swing at;
        for (int i = 0; i < SWING_COORDINATES; i++)
            q[i] = now->q[i] + (i == j ? I * tiny : 0);
        find_swing(self, q, &at);
        for (int k = 0; k < 2; k++) {
            J[k][j] = cimag(at.right[k]) / tiny;
            rate[k] += J[k][j] * now->u[j];
        }
    }
    for (int j = 0; j < SWING_COORDINATES; j++)
        Q[j] -= damping * (J[0][j] * rate[0] + J[1][j] * rate[1]);
}

// The pull ends within 10 ms; dampers.
static void push_swing(const void *it, double t, const mass_motion *now, double (*F)[3], double *Q,
                       double *z_dot)
{
    const launcher *self = it;
    const double *row = self->model->base.mechanism.load[0].force.data + 4;
    double share = fmin(1, fmax(0, 1 - (t - row[0]) / (row[4] - row[0])));
    double damping = lumped_joint(self->model, "left-hook")->rotational_damping;
    (void)z_dot;
    for (int i = 0; i < 3; i++)
        F[self->marker[0]][i] += share * row[1 + i];
    Q[LEFT_Z] -= damping * now->u[LEFT_Z];
    Q[LEFT_X] -= damping * now->u[LEFT_X];
    damp_right(self, now, damping, Q);
}

static void test_suspended(void **state)
{
    (void)state;
    static ld_model model;
    static launcher self;
    static lumped_launch launch;
    recorded_run run;
    lumped_model("suspended.yaml", NULL, 0, &model);
    begin(&self, &model, SWING_COORDINATES, 0);
    self.base.place = place_swing;
    self.base.push = push_swing;
    static const char *const bodies[] = {"left", "right", "spreader", "frame"};
    for (int i = 0; i < 4; i++)
        self.body[i] = lumped_add_body(&self.base, self.point, lumped_body(&model, bodies[i]));
    const double *at = model.base.mechanism.load[0].at;
    self.marker[0] = add_marker(&self, at[0], at[1], at[2]);
    double q[SWING_COORDINATES] = {0.05, 0, 0, 0.1};
    lumped_begin(&launch, &model, &self.base, -model.run.lead_in, 2e-3, q, NULL, NULL);
    static const int all[] = {LEFT_Z, LEFT_X, FRAME_YAW, FRAME_PITCH};
    lumped_settle(&launch, all, 4);
    recorded_run_make(&run, &model);
    static const lumped_pair pairs[] = {{"body.left.pitch", LEFT_Z, 1, 0, 2e-6},
                                        {"body.left.roll", LEFT_X, 1, 0, 3e-8},
                                        {"body.frame.yaw", FRAME_YAW, 1, 0, 1.5e-7},
                                        {"body.frame.pitch", FRAME_PITCH, 1, 0, 4e-6},
                                        {"rocket.s", -1, 1, 0, 2e-4}};
    lumped_compare(&launch, &run, pairs, 5, &(lumped_exit){1e-5, 1e-4, 2e-5});
    recorded_run_free(&run);
    model_clear(&model);
}

// ---- a sled on four springs on a track

enum { BOUNCE, PITCH, SLED_COORDINATES };
enum { RUNNER = 0, SLED = 1, STRUTS = 4 };

// The crest by its formula, not by the table; pitch that of the slope.
static cplx_matrix track_at(cplx t, double speed, cplx r[3])
{
    static const double BEGINS = -0.25, LASTS = 0.6, HIGH = 0.06, LEVEL = 0.6;
    double turn = 2 * acos(-1);
    bool on = creal(t) > BEGINS && creal(t) < BEGINS + LASTS;
    cplx phase = on ? turn * (t - BEGINS) / LASTS : 0, share = (1 - ccos(phase)) / 2;
    r[0] = speed * t;
    r[1] = LEVEL + HIGH * share * share;
    r[2] = 0;
    return turn_z(catan(HIGH * share * csin(phase) * turn / LASTS / speed));
}

static void place_sled(const void *it, cplx t, const cplx *q, cplx (*r)[3], lumped_frame *tube)
{
    const launcher *self = it;
    const double *at = lumped_joint(self->model, "bounce")->at;
    cplx track[3], runner[3];
    cplx_matrix A = track_at(t, self->model->base.velocity[0], track);
    for (int i = 0; i < STRUTS; i++)
        put_marker(self, i, track, &A, r);
    put_point(track, &A, at, runner);
    for (int i = 0; i < 3; i++)
        runner[i] += A.a[i][1] * q[BOUNCE];
    put_body(self, RUNNER, runner, &A, r);
    cplx_matrix sled = turns(A, turn_z(q[PITCH]));
    put_body(self, SLED, runner, &sled, r);
    for (int i = 0; i < STRUTS; i++)
        put_marker(self, STRUTS + i, runner, &sled, r);
    put_tube(self, runner, &sled, tube);
}

static void push_sled(const void *it, double t, const mass_motion *now, double (*F)[3], double *Q,
                      double *z_dot)
{
    const launcher *self = it;
    (void)t, (void)Q, (void)z_dot;
    for (int i = 0; i < STRUTS; i++) {
        const ld_strut *strut = &self->model->base.mechanism.strut[i];
        mass_spring spring = {strut->stiffness, strut->damping, strut->length};
        add_spring(now, self->marker[i], self->marker[STRUTS + i], &spring, F);
    }
}

static void test_sled(void **state)
{
    (void)state;
    static ld_model model;
    static launcher self;
    static lumped_launch launch;
    recorded_run run;
    lumped_model("sled.yaml", (const char *[]){TWO_ADAPTORS}, 1, &model);
    begin(&self, &model, SLED_COORDINATES, 0);
    self.base.place = place_sled;
    self.base.push = push_sled;
    self.body[RUNNER] = lumped_add_body(&self.base, self.point, lumped_body(&model, "runner"));
    self.body[SLED] = lumped_add_body(&self.base, self.point, lumped_body(&model, "frame"));
    for (int end = 0; end < 2; end++)
        for (int i = 0; i < STRUTS; i++) {
            const ld_strut *strut = &model.base.mechanism.strut[i];
            const double *at = end ? strut->to_at : strut->at;
            self.marker[STRUTS * end + i] = add_marker(&self, at[0], at[1], at[2]);
        }
    double q[SLED_COORDINATES] = {0};
    lumped_begin(&launch, &model, &self.base, -model.run.lead_in, 1e-3, q, NULL, NULL);
    static const int all[] = {BOUNCE, PITCH};
    lumped_settle(&launch, all, 2);
    recorded_run_make(&run, &model);
    static const lumped_pair pairs[] = {{"joint.bounce.displacement", BOUNCE, 1, 0, 1e-5},
                                        {"joint.pitch.angle", PITCH, 1, 0, 1e-5},
                                        {"rocket.s", -1, 1, 0, 2e-4}};
    lumped_compare(&launch, &run, pairs, 3, &(lumped_exit){1e-5, 1e-4, 2e-5});
    recorded_run_free(&run);
    model_clear(&model);
}

// ---- a turntable on a ship: drives about two axes, of the cradle against the horizon

enum { AZIMUTH, ELEVATION, TURNTABLE_COORDINATES };
enum { TURNTABLE = 0, FORK = 1, CRADLE = 2 };

static cplx sine_sum(const ld_sines *sines, cplx t)
{
    cplx sum = 0;
    for (int i = 0; i < sines->count; i++) {
        const ld_sine *sine = &sines->term[i];
        sum += sine->amplitude * csin(2 * acos(-1) * sine->frequency * t + sine->phase);
    }
    return sum;
}

static cplx_matrix ship_at(const ld_base *base, cplx t, cplx r[3])
{
    const ld_sines *along[3] = {&base->surge, &base->heave, &base->sway};
    for (int i = 0; i < 3; i++)
        r[i] = base->velocity[i] * t + sine_sum(along[i], t);
    return turns(turns(turn_y(sine_sum(&base->yaw, t)), turn_z(sine_sum(&base->pitch, t))),
                 turn_x(sine_sum(&base->roll, t)));
}

static void place_turntable(const void *it, cplx t, const cplx *q, cplx (*r)[3], lumped_frame *tube)
{
    const launcher *self = it;
    cplx ship[3], ring[3], pivot[3];
    cplx_matrix A = ship_at(&self->model->base, t, ship);
    put_point(ship, &A, lumped_joint(self->model, "azimuth")->at, ring);
    cplx_matrix table = turns(A, turn_y(q[AZIMUTH]));
    put_body(self, TURNTABLE, ring, &table, r);
    put_point(ring, &table, lumped_joint(self->model, "stand")->at, pivot);
    put_body(self, FORK, pivot, &table, r);
    cplx_matrix cradle = turns(table, turn_z(q[ELEVATION]));
    put_body(self, CRADLE, pivot, &cradle, r);
    for (int i = 0; i < 2; i++)
        put_marker(self, i, pivot, &cradle, r);
    put_tube(self, pivot, &cradle, tube);
}

// Yaw and pitch of the line from marker 0 to marker 1, one metre long, and their rates.
static void line_angles(const launcher *self, const mass_motion *now, double angle[2],
                        double rate[2])
{
    double d[3], v[3];
    for (int i = 0; i < 3; i++) {
        d[i] = now->r[self->marker[1]][i] - now->r[self->marker[0]][i];
        v[i] = now->v[self->marker[1]][i] - now->v[self->marker[0]][i];
    }
    double flat = hypot(d[0], d[2]);
    angle[0] = atan2(-d[2], d[0]);
    angle[1] = atan2(d[1], flat);
    rate[0] = (d[2] * v[0] - d[0] * v[2]) / (flat * flat);
    rate[1] = v[1] / flat;
}

static void push_turntable(const void *it, double t, const mass_motion *now, double (*F)[3],
                           double *Q, double *z_dot)
{
    const launcher *self = it;
    static const char *const joints[] = {"azimuth", "elevation"};
    double angle[2], rate[2];
    (void)t, (void)F;
    line_angles(self, now, angle, rate);
    for (int i = 0; i < 2; i++) {
        const ld_stabiliser *drive = &self->model->base.mechanism.drive[i].angle;
        double error = drive->command.data[1] - angle[i];
        Q[i] += drive->kp * error - drive->kd * rate[i] + now->z[i] -
                lumped_joint(self->model, joints[i])->friction.viscous * now->u[i];
        z_dot[i] = drive->ki * error;
    }
}

static void test_turntable(void **state)
{
    (void)state;
    static const char *const sets[] = {
        "base.joints.azimuth.friction.coulomb=0 N.m",
        "base.joints.elevation.friction.coulomb=0 N.m",
        "tubes.layout={rows: 1, columns: 1, first: -1 0.2 -0.12 m}",
        TWO_ADAPTORS,
    };
    static const char *const names[] = {"turntable", "fork", "cradle"};
    static ld_model model;
    static launcher self;
    static lumped_launch launch;
    recorded_run run;
    lumped_model("ship-turntable.yaml", sets, 4, &model);
    begin(&self, &model, TURNTABLE_COORDINATES, 2);
    self.base.place = place_turntable;
    self.base.push = push_turntable;
    for (int i = 0; i < 3; i++)
        self.body[i] = lumped_add_body(&self.base, self.point, lumped_body(&model, names[i]));
    for (int i = 0; i < 2; i++)
        self.marker[i] = add_marker(&self, i, 0, 0);
    recorded_run_make(&run, &model);
    double q[2] = {recorded_value(&run, 0, recorded_column(&run, "joint.azimuth.angle")),
                   recorded_value(&run, 0, recorded_column(&run, "joint.elevation.angle"))};
    double u[2] = {recorded_value(&run, 0, recorded_column(&run, "joint.azimuth.rate")),
                   recorded_value(&run, 0, recorded_column(&run, "joint.elevation.rate"))};
    lumped_begin(&launch, &model, &self.base, -model.run.lead_in, 2e-3, q, u, NULL);
    // at first the drives find their torques
    static const lumped_pair pairs[] = {{"joint.azimuth.angle", AZIMUTH, 1, 0, 1e-3},
                                        {"joint.elevation.angle", ELEVATION, 1, 0, 1e-3},
                                        {"rocket.s", -1, 1, 0, 2e-4}};
    lumped_compare(&launch, &run, pairs, 3, &(lumped_exit){1e-5, 1e-4, 2e-5});
    recorded_run_free(&run);
    model_clear(&model);
}

// ---- a trailer on four jacks, without its tyres; locks about two axes

enum { X, Y, Z, YAW, TILT, ROLL, TURN, RAISE, TRAILER_COORDINATES };
enum { FRAME_BODY = 0, DRAWBAR = 1, RING = 2, CRADLE_BODY = 3, JACKS = 4 };

static cplx_matrix attitude_of(const cplx angle[3])
{
    return turns(turns(turn_y(angle[0]), turn_z(angle[1])), turn_x(angle[2]));
}

static void place_trailer(const void *it, cplx t, const cplx *q, cplx (*r)[3], lumped_frame *tube)
{
    const launcher *self = it;
    cplx at[3];
    cplx_matrix A = attitude_of(q + YAW);
    (void)t;
    put_body(self, FRAME_BODY, q + X, &A, r);
    for (int i = 0; i < JACKS; i++)
        put_marker(self, i, q + X, &A, r);
    put_point(q + X, &A, lumped_joint(self->model, "coupling")->at, at);
    put_body(self, DRAWBAR, at, &A, r);
    put_point(q + X, &A, lumped_joint(self->model, "azimuth")->at, at);
    A = turns(A, turn_y(q[TURN]));
    put_body(self, RING, at, &A, r);
    put_point(at, &A, lumped_joint(self->model, "elevation")->at, at);
    A = turns(A, turn_z(q[RAISE]));
    put_body(self, CRADLE_BODY, at, &A, r);
    put_tube(self, at, &A, tube);
}

// A jack's friction bounds the force along the ground, z what it has slid.
static void push_jack(const ld_foot *foot, const double r[3], const double v[3], const double z[2],
                      double F[3])
{
    double pressed = foot->stiffness[1] * (foot->height - r[1]) - foot->damping[1] * v[1];
    double normal = r[1] < foot->height ? fmax(0, pressed) : 0;
    double x = foot->stiffness[0] * z[0] + foot->damping[0] * v[0];
    double across = foot->stiffness[2] * z[1] + foot->damping[2] * v[2];
    double scale = hypot(1, hypot(x, across) / (foot->friction * normal));
    F[0] -= x / scale;
    F[1] += normal;
    F[2] -= across / scale;
}

static void push_trailer(const void *it, double t, const mass_motion *now, double (*F)[3],
                         double *Q, double *z_dot)
{
    const launcher *self = it;
    static const char *const locks[] = {"azimuth", "elevation"};
    (void)t;
    for (int i = 0; i < JACKS; i++) {
        int k = self->marker[i];
        push_jack(&self->model->base.mechanism.foot[i], now->r[k], now->v[k], now->z + 2 * i, F[k]);
        z_dot[2 * i] = now->v[k][0];
        z_dot[2 * i + 1] = now->v[k][2];
    }
    for (int i = 0; i < 2; i++) {
        const ld_hinge_lock *lock = &lumped_joint(self->model, locks[i])->lock.spring;
        Q[TURN + i] += self->preload[i] - lock->stiffness * (now->q[TURN + i] - self->neutral[i]) -
                       lock->damping * now->u[TURN + i];
    }
}

// At rest the locks carry what holds their joints.
static void preload_locks(launcher *self, lumped_launch *launch)
{
    static const int on_jacks[] = {Y, TILT, ROLL};
    double y_dot[2 * MOST_COORDINATES + MOST_EXTRA], holding[MOST_COORDINATES];
    bool *held = launch->system.held;
    held[TURN] = held[RAISE] = true;
    lumped_settle(launch, on_jacks, 3);
    masses_rates(&launch->system, launch->t, launch->y, y_dot, holding);
    held[TURN] = held[RAISE] = false;
    for (int i = 0; i < 2; i++)
        self->preload[i] = holding[TURN + i];
}

static void test_trailer(void **state)
{
    (void)state;
    static const char *const sets[] = {
        "base.wheels=", "base.wheels_on=",
        "base.road=",   "base.speed=",
        "base.drive=",  "base.suspension=",
        "base.tyre=",   "tubes.layout={rows: 1, columns: 1, first: -0.3 0.2 -0.12 m}",
        TWO_ADAPTORS,
    };
    static const char *const names[] = {"frame", "drawbar", "turntable", "cradle"};
    static ld_model model;
    static launcher self;
    static lumped_launch launch;
    recorded_run run;
    lumped_model("trailer.yaml", sets, sizeof sets / sizeof *sets, &model);
    begin(&self, &model, TRAILER_COORDINATES, 2 * JACKS);
    self.base.place = place_trailer;
    self.base.push = push_trailer;
    for (int i = 0; i < 4; i++)
        self.body[i] = lumped_add_body(&self.base, self.point, lumped_body(&model, names[i]));
    for (int i = 0; i < JACKS; i++) {
        const double *at = model.base.mechanism.foot[i].at;
        self.marker[i] = add_marker(&self, at[0], at[1], at[2]);
    }
    double q[TRAILER_COORDINATES] = {0};
    q[Y] = 0.7485;
    q[TURN] = self.neutral[0] = lumped_joint(&model, "azimuth")->angle;
    q[RAISE] = self.neutral[1] = lumped_joint(&model, "elevation")->angle;
    lumped_begin(&launch, &model, &self.base, -model.run.lead_in, 5e-4, q, NULL, NULL);
    preload_locks(&self, &launch);
    recorded_run_make(&run, &model);
    static const lumped_pair pairs[] = {{"body.frame.y", Y, 1, 0, 3e-7},
                                        {"body.frame.pitch", TILT, 1, 0, 3e-7},
                                        {"body.frame.roll", ROLL, 1, 0, 3e-7},
                                        {"joint.azimuth.angle", TURN, 1, 0, 3e-7},
                                        {"joint.elevation.angle", RAISE, 1, 0, 3e-7},
                                        {"rocket.s", -1, 1, 0, 2e-4}};
    lumped_compare(&launch, &run, pairs, 6, &(lumped_exit){1e-5, 1e-4, 2e-5});
    recorded_run_free(&run);
    model_clear(&model);
}

// ---- a gondola under a balloon: attitudes of balloon, line and swivel

enum { BALLOON_AT = 0, BALLOON_TURN = 3, LINE_TURN = 6, SWIVEL_TURN = 9, SPIN = 12 };
enum { GONDOLA_COORDINATES = 13, BALLOON = 0, LINE = 1, SWIVEL = 2, GONDOLA = 3, LIFT = 12 };

static void place_gondola(const void *it, cplx t, const cplx *q, cplx (*r)[3], lumped_frame *tube)
{
    const launcher *self = it;
    cplx at[3] = {q[0], q[1], q[2]};
    cplx_matrix A = attitude_of(q + BALLOON_TURN);
    (void)t;
    put_marker(self, LIFT, at, &A, r);
    for (int body = BALLOON; body <= SWIVEL; body++) {
        if (body == SWIVEL)
            put_point(at, &A, lumped_joint(self->model, "shackle")->at, at);
        A = attitude_of(q + BALLOON_TURN + 3 * body);
        put_body(self, body, at, &A, r);
        for (int i = 0; i < 4; i++)
            put_marker(self, 4 * body + i, at, &A, r);
    }
    A = turns(A, turn_y(q[SPIN]));
    put_body(self, GONDOLA, at, &A, r);
    put_tube(self, at, &A, tube);
}

static void add_cross(const double a[3], const double b[3], double factor, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] += factor * (a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
}

// Adds a body's angular velocity, from its origin's marker and those a metre ahead on its axes.
static void add_turning(const mass_motion *now, int marker, double factor, double w[3])
{
    for (int i = 1; i < 4; i++) {
        double e[3], v[3];
        for (int k = 0; k < 3; k++) {
            e[k] = now->r[marker + i][k] - now->r[marker][k];
            v[k] = now->v[marker + i][k] - now->v[marker][k];
        }
        add_cross(e, v, factor / 2, w);
    }
}

// A moment as pairs of forces there.
static void add_moment(const mass_motion *now, int marker, const double m[3], double (*F)[3])
{
    for (int i = 1; i < 4; i++) {
        double e[3], f[3] = {0};
        for (int k = 0; k < 3; k++)
            e[k] = now->r[marker + i][k] - now->r[marker][k];
        add_cross(m, e, 0.5, f);
        for (int k = 0; k < 3; k++) {
            F[marker + i][k] += f[k];
            F[marker][k] -= f[k];
        }
    }
}

static void push_gondola(const void *it, double t, const mass_motion *now, double (*F)[3],
                         double *Q, double *z_dot)
{
    const launcher *self = it;
    (void)t, (void)Q, (void)z_dot;
    for (int i = 0; i < 3; i++)
        F[self->marker[LIFT]][i] += self->model->base.mechanism.load[0].force.data[1 + i];
    for (int body = LINE; body <= SWIVEL; body++) {
        double damping =
            lumped_joint(self->model, body == LINE ? "crown" : "shackle")->rotational_damping;
        int here = self->marker[4 * body], before = self->marker[4 * (body - 1)];
        double m[3] = {0}, back[3];
        add_turning(now, here, -damping, m);
        add_turning(now, before, damping, m);
        for (int i = 0; i < 3; i++)
            back[i] = -m[i];
        add_moment(now, here, m, F);
        add_moment(now, before, back, F);
    }
}

// The launch's first row: at rest, but for the spin.
static void start_of(const recorded_run *run, double *q)
{
    static const char *const columns[] = {
        "body.balloon.x",     "body.balloon.y",    "body.balloon.z",    "body.balloon.yaw",
        "body.balloon.pitch", "body.balloon.roll", "body.line.yaw",     "body.line.pitch",
        "body.line.roll",     "body.swivel.yaw",   "body.swivel.pitch", "body.swivel.roll",
        "joint.bearing.angle"};
    for (int i = 0; i < GONDOLA_COORDINATES; i++)
        q[i] = recorded_value(run, 0, recorded_column(run, columns[i]));
}

static void test_gondola(void **state)
{
    (void)state;
    static const char *const names[] = {"balloon", "line", "swivel", "gondola"};
    static ld_model model;
    static launcher self;
    static lumped_launch launch;
    recorded_run run;
    lumped_model("gondola.yaml", NULL, 0, &model);
    begin(&self, &model, GONDOLA_COORDINATES, 0);
    self.base.place = place_gondola;
    self.base.push = push_gondola;
    for (int i = 0; i < 4; i++)
        self.body[i] = lumped_add_body(&self.base, self.point, lumped_body(&model, names[i]));
    for (int i = 0; i < 12; i++)
        self.marker[i] = add_marker(&self, i % 4 == 1, i % 4 == 2, i % 4 == 3);
    const double *lift = model.base.mechanism.load[0].at;
    self.marker[LIFT] = add_marker(&self, lift[0], lift[1], lift[2]);
    double q[GONDOLA_COORDINATES] = {0}, u[GONDOLA_COORDINATES] = {0}, mass = 0;
    lumped_begin(&launch, &model, &self.base, 0, 2e-3, q, u, NULL);
    for (int k = 0; k < launch.system.points; k++)
        mass += launch.system.mass[k];
    model.base.mechanism.load[0].force.data[2] = mass * model.gravity; // of this rail's weight
    recorded_run_make(&run, &model);
    start_of(&run, q);
    u[SPIN] = lumped_joint(&model, "bearing")->rate;
    lumped_begin(&launch, &model, &self.base, -model.run.lead_in, 2e-3, q, u, NULL);
    static const lumped_pair pairs[] = {{"body.balloon.y", 1, 1, 0, 2e-6},
                                        {"body.line.pitch", LINE_TURN + 1, 1, 0, 1e-6},
                                        {"body.swivel.pitch", SWIVEL_TURN + 1, 1, 0, 6e-6},
                                        {"body.swivel.roll", SWIVEL_TURN + 2, 1, 0, 1e-6},
                                        {"joint.bearing.angle", SPIN, 1, 0, 6e-6},
                                        {"rocket.s", -1, 1, 0, 2e-4}};
    lumped_compare(&launch, &run, pairs, 6, &(lumped_exit){1e-5, 1e-4, 2e-5});
    recorded_run_free(&run);
    model_clear(&model);
}

// ---- a mast that bends in the vertical plane: cubic finite elements, a node at the step

enum { ELEMENTS = 4, MAST_HEAD = 2 * ELEMENTS, MAST_COORDINATES, PIECES = 4 * ELEMENTS };

typedef struct mast {
    launcher common;
    double length, bend[ELEMENTS]; // [m], [N m2]
    double station[PIECES];        // [m] of the mass points
    double preload, neutral;
} mast;

// Deflection and slope at x of an element, from those of its ends.
static cplx deflected(const mast *self, const cplx *q, int element, double x, cplx *slope)
{
    double h = self->length / ELEMENTS, s = x / h - element;
    const cplx *end = q + 2 * element, *start = end - 2;
    cplx u_0 = element ? start[0] : 0, turn_0 = element ? start[1] : 0;
    *slope = 6 * s * (1 - s) / h * (end[0] - u_0) + (1 - s) * (1 - 3 * s) * turn_0 +
             s * (3 * s - 2) * end[1];
    return u_0 + s * s * (3 - 2 * s) * (end[0] - u_0) +
           h * s * (1 - s) * ((1 - s) * turn_0 - s * end[1]);
}

// How far bending draws the axis down between two places of an element, by Boole's rule,
// exact for the slope's square.
static cplx drawn_down(const mast *self, const cplx *q, int element, double from, double to)
{
    static const double weight[5] = {7, 32, 12, 32, 7};
    cplx sum = 0, slope;
    for (int i = 0; i < 5; i++) {
        deflected(self, q, element, from + 0.25 * i * (to - from), &slope);
        sum += weight[i] / 90 * (to - from) * slope * slope;
    }
    return 0.5 * sum;
}

// Deflections go backwards.
static void place_mast(const void *it, cplx t, const cplx *q, cplx (*r)[3], lumped_frame *tube)
{
    const mast *self = it;
    cplx down = 0, slope, head[3] = {0};
    double h = self->length / ELEMENTS;
    (void)t;
    for (int e = 0; e < ELEMENTS; e++) {
        double before = e * h;
        for (int i = 4 * e; i < 4 * e + 4; i++) {
            double x = self->station[i];
            down += drawn_down(self, q, e, before, x);
            r[i][0] = -deflected(self, q, e, x, &slope);
            r[i][1] = x - down;
            r[i][2] = 0;
            before = x;
        }
        down += drawn_down(self, q, e, before, (e + 1) * h);
    }
    head[0] = -deflected(self, q, ELEMENTS - 1, self->length, &slope);
    head[1] = self->length - down;
    cplx_matrix A = turn_z(slope + q[MAST_HEAD]);
    put_body(&self->common, 0, head, &A, r);
    put_tube(&self->common, head, &A, tube);
}

// Elements resist the curvature that their ends impose: E I/h^3 K, by forces and moments.
static void push_mast(const void *it, double t, const mass_motion *now, double (*F)[3], double *Q,
                      double *z_dot)
{
    const mast *self = it;
    const ld_hinge_lock *lock = &lumped_joint(self->common.model, "head")->lock.spring;
    double h = self->length / ELEMENTS;
    (void)t, (void)F, (void)z_dot;
    for (int e = 0; e < ELEMENTS; e++) {
        const double *end = now->q + 2 * e, *start = end - 2;
        double chord = (end[0] - (e ? start[0] : 0)) / h;
        double left = (e ? start[1] : 0) - chord, right = end[1] - chord;
        double m_left = self->bend[e] / h * (4 * left + 2 * right);
        double m_right = self->bend[e] / h * (2 * left + 4 * right);
        Q[2 * e] += (m_left + m_right) / h;
        Q[2 * e + 1] -= m_right;
        if (e) {
            Q[2 * e - 2] -= (m_left + m_right) / h;
            Q[2 * e - 1] -= m_left;
        }
    }
    Q[MAST_HEAD] += self->preload - lock->stiffness * (now->q[MAST_HEAD] - self->neutral) -
                    lock->damping * now->u[MAST_HEAD];
}

static void build_mast(mast *self, const ld_model *model)
{
    // Gauss's rule with four points, exact for the square of a deflection
    static const double at[4] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                 0.8611363115940526};
    static const double weight[4] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                     0.3478548451374538};
    const ld_beam *beam = &model->base.mechanism.beam[0];
    begin(&self->common, model, MAST_COORDINATES, 0);
    self->common.base.place = place_mast;
    self->common.base.push = push_mast;
    self->common.base.self = self;
    self->length = beam->length;
    for (int k = 0; k < PIECES; k++) {
        double h = beam->length / ELEMENTS, x = (k / 4 + 0.5 + 0.5 * at[k % 4]) * h;
        const ld_section *section = &beam->section[x > beam->section[1].from];
        double in = section->bore_radius, out = section->outer_radius, pi = acos(-1);
        self->station[k] = x;
        self->bend[k / 4] = beam->material.youngs_modulus * pi / 4 * (pow(out, 4) - pow(in, 4));
        self->common.base.mass[k] =
            beam->material.density * pi * (out * out - in * in) * 0.5 * h * weight[k % 4];
    }
    self->common.base.points = PIECES;
}

static void test_mast(void **state)
{
    (void)state;
    static const char *const sets[] = {"base.beams.mast.modes.damping=0 %",
                                       "base.beams.mast.modes.bending=8", TWO_ADAPTORS};
    static const int bent[MAST_HEAD] = {0, 1, 2, 3, 4, 5, 6, 7};
    static ld_model model;
    static mast self;
    static lumped_launch launch;
    recorded_run run;
    lumped_model("mast.yaml", sets, 3, &model);
    build_mast(&self, &model);
    self.common.body[0] =
        lumped_add_body(&self.common.base, self.common.point, lumped_body(&model, "cradle"));
    double q[MAST_COORDINATES] = {0}, y_dot[2 * MOST_COORDINATES], holding[MOST_COORDINATES];
    q[MAST_HEAD] = self.neutral = lumped_joint(&model, "head")->angle;
    lumped_begin(&launch, &model, &self.common.base, -model.run.lead_in, 5e-5, q, NULL, NULL);
    launch.system.held[MAST_HEAD] = true;
    lumped_settle(&launch, bent, MAST_HEAD);
    masses_rates(&launch.system, launch.t, launch.y, y_dot, holding);
    launch.system.held[MAST_HEAD] = false;
    self.preload = holding[MAST_HEAD];
    recorded_run_make(&run, &model);
    static const lumped_pair pairs[] = {{"body.cradle.x", MAST_HEAD - 2, -1, 0, 1e-6},
                                        {"joint.head.angle", MAST_HEAD, 1, 0, 5e-7},
                                        {"rocket.s", -1, 1, 0, 1e-4}};
    lumped_compare(&launch, &run, pairs, 3, &(lumped_exit){5e-6, 2e-5, 3e-6});
    recorded_run_free(&run);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_suspended), cmocka_unit_test(test_sled),
        cmocka_unit_test(test_turntable), cmocka_unit_test(test_trailer),
        cmocka_unit_test(test_gondola),   cmocka_unit_test(test_mast),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
