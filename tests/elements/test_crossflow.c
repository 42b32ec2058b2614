// The air on the emerged part of the rocket against integrals by hand.
#include "elements/guide/crossflow.h"
#include "support/check.h"
#include "support/draw.h"

static const double length = 3, nose = 2.4, drag = 1.1, diameter = 0.122, density = 1.2;

typedef struct bench {
    tube_system guide;
    crossflow_body body;
    launching_input input;
    launching_output out;
    launching_instant now;
} bench;

// The rocket at travel s, somehow turned against R and R against I, at rest in still air.
static void set_up(bench *self, double s)
{
    uint64_t seed = 5;
    const ld_aerodynamics given = {
        .present = true,
        .reference_diameter = diameter,
        .emerged = {.present = true, .nose = nose, .drag = drag, .diameter = NAN},
    };
    memset(self, 0, sizeof *self);
    crossflow_build(&given, &self->body);
    self->guide.flexible.length = length;
    self->input.air.density = density;
    self->now.input = &self->input;
    self->now.out = &self->out;
    self->now.tube.A_IR = draw_rotation(&seed);
    self->now.rocket.A_RB = draw_rotation(&seed);
    self->now.rocket.s = s;
}

// A vector of B in R.
static v3 in_R(const bench *self, double x, double y, double z)
{
    return m3_apply(self->now.rocket.A_RB, v3_make(x, y, z));
}

// Force and moment about O1, given in B, and the power.
static void check(bench *self, v3 force, v3 moment, double power)
{
    crossflow_add(&self->body, &self->guide, &self->now);
    double f = v3_norm(force), m = v3_norm(moment);
    v3 found = m3_apply_transposed(self->now.rocket.A_RB, self->now.f);
    CHECK_BELOW("force", v3_norm(v3_sub(found, force)) / f, 1e-13);
    found = m3_apply_transposed(self->now.rocket.A_RB, self->out.crossflow);
    CHECK_BELOW("force told", v3_norm(v3_sub(found, force)) / f, 1e-13);
    found = m3_apply_transposed(self->now.rocket.A_RB, self->now.m);
    CHECK_BELOW("moment about O1", v3_norm(v3_sub(found, moment)) / m, 1e-13);
    CHECK_BELOW("power", (self->out.power[POWER_AIR] - power) / (f + fabs(power)), 1e-13);
    CHECK_BELOW("length [m]", self->out.emerged - (nose - length + self->now.rocket.s), 1e-15);
}

// 1/2 rho C_c D l |v_t| v_t in the middle of what is out: the wind's part along the axis does
// nothing.
static void steady_wind_on_a_rocket_at_rest(void **state)
{
    (void)state;
    bench self;
    set_up(&self, 1.5);
    self.input.air.v = m3_apply(self.now.tube.A_IR, in_R(&self, 30, 4, -7));
    double l = 0.9, middle = 1.95, factor = 0.5 * density * drag * diameter * l * hypot(4, 7);
    v3 force = v3_make(0, 4 * factor, -7 * factor);
    check(&self, force, v3_cross(v3_make(middle, 0, 0), force), 0);
}

// Moved sideways through still air.
static void drag_takes_power_from_a_rocket_that_moves(void **state)
{
    (void)state;
    bench self;
    set_up(&self, 2.3);
    self.now.rocket.v_O1 = in_R(&self, 40, 3, 0);
    double l = 1.7, middle = 1.55, f = 0.5 * density * drag * diameter * l * 9;
    check(&self, v3_make(0, -f, 0), v3_make(0, 0, -f * middle), -3 * f);
}

// Pitching at w about O1, which rises at v: u = v + w x changes its sign at x = 1.5.
//   int |u| u dx = [|u|^3]/(3 w),   int x |u| u dx = [u^3 |u|/4 - v |u|^3/3]/w^2
//   int |u|^3 dx = [u^3 |u|/4]/w
static void lateral_speed_that_changes_its_sign(void **state)
{
    (void)state;
    bench self;
    const double v = -3, w = 2, s = 2.1, from = length - s;
    set_up(&self, s);
    self.now.rocket.v_O1 = in_R(&self, 20, v, 0);
    self.now.rocket.w_B = in_R(&self, 50, 0, w);
    double a = v + w * from, b = v + w * nose, factor = -0.5 * density * drag * diameter;
    double third = (pow(fabs(b), 3) - pow(fabs(a), 3)) / 3;
    double fourth = (b * b * b * fabs(b) - a * a * a * fabs(a)) / 4;
    v3 force = v3_make(0, factor * third / w, 0);
    check(&self, force, v3_make(0, 0, factor * (fourth - v * third) / (w * w)),
          factor * fourth / w);
}

// It begins with the nose at the tip, from nothing.
static void grows_from_nothing(void **state)
{
    (void)state;
    bench self;
    const double still[] = {-0.1, 0}, out[] = {1e-9, 1e-6, 1e-3};
    double across = 0.5 * density * drag * diameter * 100;
    for (int i = 0; i < 2; i++) {
        set_up(&self, length - nose + still[i]);
        self.input.air.v = m3_apply(self.now.tube.A_IR, in_R(&self, 0, 10, 0));
        crossflow_add(&self.body, &self.guide, &self.now);
        CHECK_BELOW("force before [N]", v3_norm(self.now.f), 0);
        CHECK_BELOW("length before [m]", self.out.emerged, 0);
    }
    for (int i = 0; i < 3; i++) {
        set_up(&self, length - nose + out[i]);
        self.input.air.v = m3_apply(self.now.tube.A_IR, in_R(&self, 0, 10, 0));
        crossflow_add(&self.body, &self.guide, &self.now);
        CHECK_BELOW("force [N]", v3_norm(self.now.f) - across * out[i], 1e-14);
    }
}

// Neither in one plane nor ever without speed: against Simpson's rule.
static void motion_in_space(void **state)
{
    (void)state;
    enum { STRETCHES = 20000 };
    uint64_t seed = 11;
    double worst = 0;
    for (int k = 0; k < 20; k++) {
        bench self;
        set_up(&self, 2.5);
        self.now.rocket.v_O1 = draw_v3(&seed, 8);
        self.now.rocket.w_B = draw_v3(&seed, 5);
        crossflow_add(&self.body, &self.guide, &self.now);
        v3 d = m3_column(self.now.rocket.A_RB, 0), sum = v3_zero();
        double from = length - 2.5, factor = -0.5 * density * drag * diameter, largest = 0;
        for (int i = 0; i <= STRETCHES; i++) {
            double x = from + (nose - from) * i / STRETCHES;
            v3 v = v3_add(self.now.rocket.v_O1, v3_cross(self.now.rocket.w_B, v3_scale(x, d)));
            v = v3_axpy(v, -v3_dot(v, d), d);
            double weight = (i == 0 || i == STRETCHES ? 1 : i % 2 ? 4 : 2) / (3.0 * STRETCHES);
            sum = v3_axpy(sum, factor * weight * (nose - from) * v3_norm(v), v);
            largest = fmax(largest, v3_norm2(v));
        }
        double scale = -factor * (nose - from) * largest;
        worst = fmax(worst, v3_norm(v3_sub(sum, self.now.f)) / scale);
    }
    CHECK_BELOW("force, of that at the greatest speed", worst, 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steady_wind_on_a_rocket_at_rest),
        cmocka_unit_test(drag_takes_power_from_a_rocket_that_moves),
        cmocka_unit_test(lateral_speed_that_changes_its_sign),
        cmocka_unit_test(grows_from_nothing),
        cmocka_unit_test(motion_in_space),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
