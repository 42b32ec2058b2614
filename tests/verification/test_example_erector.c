// ctest: slow
// examples/multibody/erector.yaml against equations of its own: the loop of boom, cylinder and rod
// has one degree of freedom, the boom's angle, from which the places of all follow in closed form.
#include "support/check.h"
#include "support/lumped_launch.h"

// What the cylinder and its controller, the lock and the geometry are.
typedef struct erector {
    const ld_model *model;
    lumped_base base;
    double point[MOST_POINTS][3];
    int boom, cylinder, rod; // first points
    int foot, eye;           // markers
} erector;

enum { ANGLE };

static void place(const void *it, cplx t, const cplx *q, cplx (*r)[3], lumped_frame *tube)
{
    const erector *self = it;
    const ld_joint *eye = lumped_joint(self->model, "eye");
    const double *pivot = lumped_joint(self->model, "anchors")->at,
                 *foot = lumped_joint(self->model, "foot")->at;
    cplx at[3] = {pivot[0], pivot[1], pivot[2]}, from[3] = {foot[0], foot[1], foot[2]}, end[3];
    cplx_matrix boom = turn_z(q[ANGLE]);
    (void)t;
    for (int k = 0; k < RIGID_POINTS; k++)
        put_point(at, &boom, self->point[self->boom + k], r[self->boom + k]);
    put_point(at, &boom, eye->at, end);
    cplx x = end[0] - from[0], y = end[1] - from[1], length = csqrt(x * x + y * y);
    cplx_matrix along = {{{x / length, -y / length, 0}, {y / length, x / length, 0}, {0, 0, 1}}};
    cplx piston[3];
    for (int i = 0; i < 3; i++)
        piston[i] = from[i] + (1 - eye->body_at[0] / length) * (end[i] - from[i]);
    for (int k = 0; k < RIGID_POINTS; k++) {
        put_point(from, &along, self->point[self->cylinder + k], r[self->cylinder + k]);
        put_point(piston, &along, self->point[self->rod + k], r[self->rod + k]);
    }
    memcpy(r[self->foot], from, sizeof from);
    memcpy(r[self->eye], end, sizeof end);
    put_point(at, &boom, self->model->tubes.layout.first, tube->r);
    tube->A = boom;
}

static double command_at(const ld_table *table, double t, double *rate)
{
    const double *row = table->data;
    size_t i = 0;
    *rate = 0;
    while (i + 1 < table->rows && row[2 * (i + 1)] <= t)
        i++;
    if (t < row[0] || i + 1 == table->rows)
        return row[2 * i + 1];
    *rate = (row[2 * i + 3] - row[2 * i + 1]) / (row[2 * i + 2] - row[2 * i]);
    return row[2 * i + 1] + *rate * (t - row[2 * i]);
}

// The controller holds the piston's displacement, the length less the rod's; friction; the lock.
static void push(const void *it, double t, const mass_motion *now, double (*F)[3], double *Q,
                 double *z_dot)
{
    const erector *self = it;
    const ld_joint *pivot = lumped_joint(self->model, "pivot"),
                   *piston = lumped_joint(self->model, "piston"),
                   *eye = lumped_joint(self->model, "eye");
    const ld_stabiliser *control = &self->model->base.mechanism.drive[0].length;
    double rate, command_rate, command = command_at(&control->command, t, &command_rate);
    double displacement = distance_of(now, self->foot, self->eye, &rate) - eye->body_at[0];
    double error = command - displacement;
    double force = control->kp * error + control->kd * (command_rate - rate) + now->z[0];
    z_dot[0] = control->ki * error;
    push_apart(now, self->foot, self->eye, force - piston->friction.viscous * rate, F);
    // it closes where the boom has come to rest, as is checked
    if (t >= pivot->lock.from)
        Q[ANGLE] -= pivot->lock.spring.stiffness * (now->q[ANGLE] - now->z[1]) +
                    pivot->lock.spring.damping * now->u[ANGLE];
    else
        z_dot[1] = now->u[ANGLE]; // z[1] follows the angle until then
}

// The angle at which the piston is where it is commanded to be, by bisection; the force that holds.
static void start_of(erector *self, double *angle, double z[2])
{
    double low = 0, high = 1.5;
    const ld_stabiliser *control = &self->model->base.mechanism.drive[0].length;
    double wanted = control->command.data[1] + lumped_joint(self->model, "eye")->body_at[0];
    static cplx r[MOST_POINTS][3];
    lumped_frame tube;
    for (int turn = 0; turn < 60; turn++) {
        *angle = 0.5 * (low + high);
        place(self, 0, (cplx[]){*angle}, r, &tube);
        double length = hypot(creal(r[self->eye][0] - r[self->foot][0]),
                              creal(r[self->eye][1] - r[self->foot][1]));
        *(length < wanted ? &low : &high) = *angle;
    }
    z[0] = 0;
    z[1] = *angle;
}

// Sets the integral so that the boom rests before the command begins: the force is linear in it.
static void balance(lumped_launch *launch)
{
    int n = launch->system.coordinates;
    double rate[2], y_dot[2 * MOST_COORDINATES + MOST_EXTRA];
    for (int i = 0; i < 2; i++) {
        launch->y[2 * n] = 1e4 * i;
        masses_rates(&launch->system, launch->t - 1, launch->y, y_dot, NULL);
        rate[i] = y_dot[n];
    }
    launch->y[2 * n] = 1e4 * rate[0] / (rate[0] - rate[1]);
}

static void test_erector(void **state)
{
    (void)state;
    static ld_model model;
    static erector self;
    static lumped_launch launch;
    recorded_run run;
    lumped_model("erector.yaml", NULL, 0, &model);
    self.model = &model;
    self.base = (lumped_base){.coordinates = 1, .extra = 2, .place = place, .push = push};
    self.base.self = &self;
    self.boom = lumped_add_body(&self.base, self.point, lumped_body(&model, "boom"));
    self.cylinder = lumped_add_body(&self.base, self.point, lumped_body(&model, "cylinder"));
    self.rod = lumped_add_body(&self.base, self.point, lumped_body(&model, "rod"));
    self.foot = lumped_add_marker(&self.base, self.point, (double[]){0, 0, 0});
    self.eye = lumped_add_marker(&self.base, self.point, (double[]){0, 0, 0});
    double angle, z[2];
    start_of(&self, &angle, z);
    lumped_begin(&launch, &model, &self.base, -model.run.lead_in, 2e-3, &angle, NULL, z);
    balance(&launch);
    recorded_run_make(&run, &model);
    static const lumped_pair pairs[] = {
        {"joint.pivot.angle", ANGLE, 1, 0, 1e-7},
        {"rocket.s", -1, 1, 0, 2e-4},
    };
    lumped_compare(&launch, &run, pairs, 2, &(lumped_exit){1e-5, 1e-4, 2e-5});
    recorded_run_free(&run);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_erector)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
