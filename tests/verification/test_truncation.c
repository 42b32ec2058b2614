// What a launch's modes leave out, against a tube without modes (tests/support/fine_tube.h) under
// the loads of the launch itself: motion of the tip, and the rate of twist that the knob meets,
// which enters the spin. Prints the numbers of docs/convergence.md.
// ctest: slow
#include <stdlib.h>

#include "model/model.h"
#include "support/check.h"
#include "support/fine_tube.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

// The columns of a row that the loads follow from.
typedef struct row_columns {
    size_t t, s, s_dot, y, z, gamma, w_x, slot, rub, lock;
    size_t normal[3], force[3], cy[3], cz[3];
} row_columns;

// A launch and the loads that its rows have put on the tube.
typedef struct launch {
    ld_model model;
    recorded_run run;
    row_columns column;
    fine_loads *loads; // [rows]
} launch;

static row_columns find_columns(const recorded_run *run)
{
    static const char *const adaptor[] = {"rear", "middle", "front"};
    row_columns c = {.t = recorded_column(run, "t"),
                     .s = recorded_column(run, "rocket.s"),
                     .s_dot = recorded_column(run, "rocket.s_dot"),
                     .y = recorded_column(run, "rocket.y"),
                     .z = recorded_column(run, "rocket.z"),
                     .gamma = recorded_column(run, "rocket.gamma"),
                     .w_x = recorded_column(run, "rocket.w_x"),
                     .slot = recorded_column(run, "slot.force"),
                     .rub = recorded_column(run, "slot.friction"),
                     .lock = recorded_column(run, "lock.force")};
    for (int i = 0; i < 3; i++) {
        char name[48];
        snprintf(name, sizeof name, "contact.%s.normal", adaptor[i]);
        c.normal[i] = recorded_column(run, name);
        snprintf(name, sizeof name, "contact.%s.force", adaptor[i]);
        c.force[i] = recorded_column(run, name);
        snprintf(name, sizeof name, "contact.%s.y", adaptor[i]);
        c.cy[i] = recorded_column(run, name);
        snprintf(name, sizeof name, "contact.%s.z", adaptor[i]);
        c.cz[i] = recorded_column(run, name);
    }
    return c;
}

// A force (along x, outwards, round about x) at distance r from the axis, in the direction (y, z).
static void add_force(fine_load *load, double r, double y, double z, double along, double outwards,
                      double round)
{
    double e = hypot(y, z);
    load->force[0] += (outwards * y - round * z) / e;
    load->force[1] += (outwards * z + round * y) / e;
    load->moment[0] -= r * along * y / e;
    load->moment[1] -= r * along * z / e;
    load->torque += r * round;
}

// Normal force and friction of an adaptor on the wall (model.md, section 5).
static fine_load contact_load(const launch *self, const double *row, int i)
{
    const row_columns *c = &self->column;
    const double R = self->model.tubes.section[0].bore_radius;
    fine_load load = {.x = row[c->s] + self->model.rocket.adaptor[i].at, .x_dot = row[c->s_dot]};
    double N = row[c->normal[i]], y = row[c->cy[i]], z = row[c->cz[i]];
    if (N > 0) {
        double F = row[c->force[i]], friction = sqrt(fmax(0, F * F - N * N));
        double along = row[c->s_dot], round = row[c->w_x] * (R - hypot(y, z));
        double v = fmax(1e-9, hypot(along, round));
        add_force(&load, R, y, z, friction * along / v, N, friction * round / v);
    }
    return load;
}

// The knob and the lock.
static void add_slot_load(const launch *self, const double *row, fine_load *load)
{
    const row_columns *c = &self->column;
    const ld_slot *slot = &self->model.tubes.slot;
    double alpha = slot->angle.data[1], N = row[c->slot], rub = row[c->rub];
    double y = row[c->y] + slot->radius * cos(row[c->gamma]);
    double z = row[c->z] + slot->radius * sin(row[c->gamma]);
    add_force(load, hypot(y, z), y, z, N * sin(alpha) - rub * cos(alpha), 0,
              -N * cos(alpha) - rub * sin(alpha));
    load->moment[0] -= row[c->lock] * row[c->y];
    load->moment[1] -= row[c->lock] * row[c->z];
}

// Runs the model, which gets so many modes, without damping of their own: the fine tube has none.
static void launch_make(launch *self, int bending, int torsion)
{
    self->model.tubes.modes.elements = 60;
    self->model.tubes.modes.damping = 0;
    self->model.tubes.modes.bending = bending;
    self->model.tubes.modes.torsion = torsion;
    self->model.run.output_step_tube = 1e-5;
    self->model.run.tolerance = 1e-7;
    recorded_run_make(&self->run, &self->model);
    self->column = find_columns(&self->run);
    self->loads = calloc(self->run.rows, sizeof *self->loads);
    for (size_t i = 0; i < self->run.rows; i++) {
        const double *row = self->run.values + i * self->run.columns;
        fine_loads *loads = &self->loads[i];
        loads->count = 3;
        for (int k = 0; k < 3; k++)
            loads->load[k] = contact_load(self, row, k);
        add_slot_load(self, row, &loads->load[0]);
    }
}

static void launch_free(launch *self)
{
    free(self->loads);
    recorded_run_free(&self->run);
}

// A place in the history: between row and row + 1.
typedef struct place {
    size_t row;
    double share;
} place;

// That of time t, looked for from another one on.
static place place_at(const launch *self, double t, place from)
{
    const recorded_run *run = &self->run;
    size_t i = from.row;
    while (i + 2 < run->rows && recorded_value(run, i + 1, self->column.t) <= t)
        i++;
    double t0 = recorded_value(run, i, self->column.t);
    double t1 = recorded_value(run, i + 1, self->column.t);
    return (place){i, t1 > t0 ? fmin(1, fmax(0, (t - t0) / (t1 - t0))) : 0};
}

static double mix(double a, double b, double share)
{
    return a + share * (b - a);
}

static double value_at(const launch *self, place at, size_t column)
{
    return mix(recorded_value(&self->run, at.row, column),
               recorded_value(&self->run, at.row + 1, column), at.share);
}

static fine_loads loads_at(const launch *self, place at)
{
    fine_loads loads = self->loads[at.row];
    for (int i = 0; i < loads.count; i++) {
        fine_load *a = &loads.load[i];
        const fine_load *b = &self->loads[at.row + 1].load[i];
        a->x = mix(a->x, b->x, at.share);
        a->x_dot = mix(a->x_dot, b->x_dot, at.share);
        a->torque = mix(a->torque, b->torque, at.share);
        for (int k = 0; k < 2; k++) {
            a->force[k] = mix(a->force[k], b->force[k], at.share);
            a->moment[k] = mix(a->moment[k], b->moment[k], at.share);
        }
    }
    return loads;
}

// ---- the tip ----

// Of the tip: its position, its slope, their rates, each in both planes.
enum { PLACE, SLOPE, PLACE_RATE, SLOPE_RATE, OF_TIP };

// Between program and fine tube over the launch, against the motion's departure from the start [%]:
// the largest of both, and their root mean squares.
typedef struct tip_errors {
    double largest[OF_TIP], rms[OF_TIP];
} tip_errors;

static void fine_values(const fine_bending *tube, double value[OF_TIP][2])
{
    for (int plane = 0; plane < 2; plane++) {
        fine_tip tip = fine_bending_tip(tube, plane);
        double sign = plane ? -1 : 1; // yaw is -w_z'
        value[PLACE][plane] = tip.w;
        value[SLOPE][plane] = sign * tip.slope;
        value[PLACE_RATE][plane] = tip.w_dot;
        value[SLOPE_RATE][plane] = sign * tip.slope_dot;
    }
}

static void compare_tip(const launch *self, tip_errors *out)
{
    static const char *const name[OF_TIP][2] = {{"tip.y", "tip.z"},
                                                {"tip.pitch", "tip.yaw"},
                                                {"tip.vy", "tip.vz"},
                                                {"tip.pitch_rate", "tip.yaw_rate"}};
    const double element = 0.05, step = 5e-6; // [m], [s]
    const double end = self->run.summary.rocket[0].t_rear;
    double start[OF_TIP][2], now[OF_TIP][2];
    double error[OF_TIP] = {0}, size[OF_TIP] = {0}, errors[OF_TIP] = {0}, sizes[OF_TIP] = {0};
    fine_bending *tube = malloc(sizeof *tube);
    place at = {0, 0};
    fine_bending_create(tube, &self->model, element, step);
    fine_bending_rest(tube, &self->loads[0]);
    fine_values(tube, start);
    for (int i = 1; i * step < end; i++) {
        at = place_at(self, i * step, at);
        fine_loads loads = loads_at(self, at);
        fine_bending_step(tube, &loads);
        fine_values(tube, now);
        for (int k = 0; k < OF_TIP; k++) {
            double off[2], away[2];
            for (int plane = 0; plane < 2; plane++) {
                size_t column = recorded_column(&self->run, name[k][plane]);
                off[plane] = value_at(self, at, column) - now[k][plane];
                away[plane] = now[k][plane] - start[k][plane];
            }
            double e = hypot(off[0], off[1]), a = hypot(away[0], away[1]);
            error[k] = fmax(error[k], e);
            size[k] = fmax(size[k], a);
            errors[k] += e * e;
            sizes[k] += a * a;
        }
    }
    for (int k = 0; k < OF_TIP; k++) {
        out->largest[k] = 100 * error[k] / size[k];
        out->rms[k] = 100 * sqrt(errors[k] / sizes[k]);
    }
    free(tube);
}

// Upper bounds of tip_errors.
typedef struct tip_bounds {
    int modes;
    double largest[3], rms[OF_TIP];
} tip_bounds;

static void tip_converges_in_bending(void **state)
{
    (void)state;
    static const tip_bounds bounds[] = {
        {4, {1.1, 4.5, 7}, {0.5, 2.2, 4, 18}},        {6, {0.6, 3.4, 6.2}, {0.24, 1.5, 2, 14}},
        {7, {0.24, 1.6, 4.4}, {0.14, 0.8, 1.2, 11}},  {8, {0.17, 1.3, 4.3}, {0.12, 0.66, 0.7, 10}},
        {12, {0.11, 0.4, 2.8}, {0.1, 0.24, 0.33, 9}}, {24, {0.1, 0.17, 1.4}, {0.09, 0.11, 0.17, 8}},
    };
    static const char *const what[OF_TIP] = {"place", "slope", "rate of place", "rate of slope"};
    for (size_t i = 0; i < sizeof bounds / sizeof bounds[0]; i++) {
        launch self;
        tip_errors e;
        reference_model(&self.model);
        launch_make(&self, bounds[i].modes, 2);
        compare_tip(&self, &e);
        for (int k = 0; k < OF_TIP; k++) {
            char text[64];
            double low = bounds[i].modes <= 7 ? 0.75 : 0; // what the document says is really missed
            snprintf(text, sizeof text, "%d modes, tip's %s, rms [%%]", bounds[i].modes, what[k]);
            CHECK_WITHIN(text, e.rms[k], low * bounds[i].rms[k], bounds[i].rms[k]);
            snprintf(text, sizeof text, "%d modes, tip's %s, largest [%%]", bounds[i].modes,
                     what[k]);
            if (k == SLOPE_RATE) // unbounded in theory
                printf("    %-58s %10.3g\n", text, e.largest[k]);
            else
                CHECK_WITHIN(text, e.largest[k], low * bounds[i].largest[k], bounds[i].largest[k]);
        }
        launch_free(&self);
        reference_model_free(&self.model);
    }
}

// A tube whose planes differ: `stiffness`, `along` and `about` are what plane y has over plane z.
typedef struct unlike_planes {
    const char *name;
    double stiffness, along, about;
    double bound[2][3]; // rms of place, slope and rate of place [%], with 7 and 12 modes
} unlike_planes;

static void split_planes(const unlike_planes *of, ld_tubes *tubes)
{
    ld_section *section = &tubes->section[0];
    section->form = LD_SECTION_PLANES;
    section->bending_stiffness_z = sqrt(of->stiffness) * section->bending_stiffness;
    section->bending_stiffness_y = section->bending_stiffness / sqrt(of->stiffness);
    section->bending_stiffness = NAN;
    for (int k = 0; k < tubes->support_count; k++) {
        ld_support *support = &tubes->support[k];
        support->stiffness[1] *= sqrt(of->along);
        support->stiffness[2] /= sqrt(of->along);
        support->rotational_stiffness[2] *= sqrt(of->about);
        support->rotational_stiffness[1] /= sqrt(of->about);
    }
}

static void tip_converges_in_planes_that_differ(void **state)
{
    (void)state;
    static const unlike_planes of[] = {
        {"stiffness 3:1", 3, 1, 1, {{0.12, 0.7, 1}, {0.085, 0.22, 0.29}}},
        {"stiffness 25:1", 25, 1, 1, {{0.31, 0.97, 1.1}, {0.22, 0.37, 0.39}}},
        {"springs 3:1", 1, 3, 3, {{0.15, 0.73, 0.96}, {0.11, 0.23, 0.3}}},
        {"springs along 25:1, about 1:25", 1, 25, 0.04, {{0.22, 0.7, 0.9}, {0.19, 0.25, 0.36}}},
        {"stiffness 3:1, springs 1:25, 25:1",
         3,
         0.04,
         25,
         {{0.18, 0.74, 1.14}, {0.146, 0.25, 0.37}}},
    };
    static const int modes[] = {7, 12};
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++)
        for (int m = 0; m < 2; m++) {
            launch self;
            tip_errors e;
            reference_model(&self.model);
            split_planes(&of[i], &self.model.tubes);
            launch_make(&self, modes[m], 2);
            compare_tip(&self, &e);
            printf("  %s, %d modes\n", of[i].name, modes[m]);
            CHECK_BELOW("tip's place, rms [%]", e.rms[PLACE], of[i].bound[m][PLACE]);
            CHECK_BELOW("tip's slope, rms [%]", e.rms[SLOPE], of[i].bound[m][SLOPE]);
            CHECK_BELOW("rate of tip's place, rms [%]", e.rms[PLACE_RATE],
                        of[i].bound[m][PLACE_RATE]);
            launch_free(&self);
            reference_model_free(&self.model);
        }
}

// ---- the knob ----

// The reference launch without what shakes the tube: adaptors on the axis, no friction, no weight,
// a gentle thrust, no lock worth speaking of.
static void quiet_model(ld_model *model)
{
    reference_model(model);
    ld_rocket *rocket = &model->rocket;
    model->gravity = 0;
    model->tubes.slot.friction = 0;
    rocket->contact.law = LD_CONTACT_BILATERAL;
    rocket->contact.stiffness = 1e9;
    rocket->contact.damping = 1e5;
    rocket->contact.friction = 0;
    rocket->lock.release_force = 1;
    free(rocket->motor.thrust.data);
    rocket->motor.thrust = reference_table(4, 2, (double[]){0, 0, 0.06, 15e3, 2.5, 15e3, 2.55, 0});
}

// Spin less tan(alpha)/R s_dot, which is the rate of twist at the knob [rad/s]: mean between two
// stations well inside, and at the exit.
typedef struct knob_rates {
    double modes_inside, fine_inside, modes_at_exit, fine_at_exit, jump;
} knob_rates;

static void compare_knob(const launch *self, knob_rates *out)
{
    const double element = 0.01, from = 2.0, to = 2.5; // [m]
    const ld_rocket_summary *rocket = &self->run.summary.rocket[0];
    const ld_slot *slot = &self->model.tubes.slot;
    const double roll = tan(slot->angle.data[1]) / slot->radius;
    const size_t spin = recorded_column(&self->run, "rocket.spin");
    fine_twist *tube = malloc(sizeof *tube);
    fine_loads loads = {0};
    place at = {0, 0};
    int inside = 0;
    memset(out, 0, sizeof *out);
    fine_twist_create(tube, &self->model, element);
    for (int i = 1; i * tube->step < rocket->t_rear; i++) {
        loads = loads_at(self, place_at(self, (i - 0.5) * tube->step, at));
        fine_twist_step(tube, &loads);
        at = place_at(self, i * tube->step, at);
        double s = value_at(self, at, self->column.s);
        out->fine_at_exit = fine_twist_rate(tube, s);
        if (s > from && s < to) {
            out->fine_inside += out->fine_at_exit;
            out->modes_inside +=
                value_at(self, at, spin) - roll * value_at(self, at, self->column.s_dot);
            inside++;
        }
    }
    out->fine_inside /= inside;
    out->modes_inside /= inside;
    out->modes_at_exit = rocket->spin_rate - roll * rocket->exit_speed;
    out->jump = loads.load[0].torque * rocket->exit_speed / tube->stiffness;
    free(tube);
}

// Inside the tube the knob turns with the mean of both sides of the jump that its torque makes in
// the rate of twist. The slope of all modes vanishes at the tip, so that there they know no jump.
static void spin_at_exit_does_not_converge(void **state)
{
    (void)state;
    static const int modes[] = {1, 2, 4, 8};
    for (int i = 0; i < 4; i++) {
        launch self;
        knob_rates rates;
        quiet_model(&self.model);
        launch_make(&self, 6, modes[i]);
        compare_knob(&self, &rates);
        printf("  %d torsion modes [mrad/s]\n", modes[i]);
        CHECK_WITHIN("jump of the rate of twist", 1e3 * rates.jump, -2.41, -2.35);
        CHECK_WITHIN("inside, without modes", 1e3 * rates.fine_inside, -1.1, -1.0);
        CHECK_WITHIN("inside, modes", 1e3 * rates.modes_inside, -1.2,
                     modes[i] == 1 ? -0.65 : -0.95);
        CHECK_WITHIN("at the exit, without modes", 1e3 * rates.fine_at_exit, -1.19, -1.05);
        CHECK_WITHIN("at the exit, modes", 1e3 * rates.modes_at_exit, -0.18, -0.05);
        CHECK_WITHIN("modes less without", 1e3 * (rates.modes_at_exit - rates.fine_at_exit), 0.85,
                     1.15);
        launch_free(&self);
        reference_model_free(&self.model);
    }
}

// ---- the fine tube itself ----

// Bare and level it sags by 75.598752 um at the tip (exact curve, docs/theory-tube.md).
static void fine_tube_sags(void **state)
{
    (void)state;
    ld_model model;
    fine_bending *tube = malloc(sizeof *tube);
    reference_model(&model);
    model.base.elevation = 0;
    fine_bending_create(tube, &model, 0.05, 1e-5);
    fine_bending_rest(tube, &(fine_loads){0});
    CHECK_NEAR("sag of the tip [um]", -1e6 * fine_bending_tip(tube, 0).w, 75.598752, 1e-6);
    for (int i = 0; i < 1000; i++)
        fine_bending_step(tube, &(fine_loads){0});
    CHECK_BELOW("its rate after 10 ms at rest [um/s]", 1e6 * fine_bending_tip(tube, 0).w_dot, 1e-4);
    free(tube);
    reference_model_free(&model);
}

// A torque that stays: the supports' springs bear it when all has come to rest.
static void fine_tube_twists(void **state)
{
    (void)state;
    ld_model model;
    fine_twist *tube = malloc(sizeof *tube);
    fine_loads loads = {1, {{.x = 2.925, .torque = 100}}};
    reference_model(&model);
    fine_twist_create(tube, &model, 0.05);
    for (int i = 0; i * tube->step < 1; i++)
        fine_twist_step(tube, &loads);
    double borne = tube->spring[0] * tube->angle[0] + tube->spring[1] * tube->angle[1];
    CHECK_NEAR("torque on the supports after 1 s [N m]", borne, 100, 1e-6);
    CHECK_BELOW("rate of twist [rad/s]", fine_twist_rate(tube, 2.5), 1e-9);
    // sent off at half the waves' speed it meets, until they come back from the ends, T/(2 GJ/c)
    // over 1 - v^2/c^2
    fine_twist_create(tube, &model, 0.05);
    double v = tube->c / 2;
    for (int i = 0; i < 10; i++) {
        loads.load[0] =
            (fine_load){.x = 2.02 + v * (i + 0.5) * tube->step, .x_dot = v, .torque = 100};
        fine_twist_step(tube, &loads);
    }
    CHECK_NEAR("rate of twist at a fast torque [mrad/s]", 1e3 * fine_twist_rate(tube, 2.27),
               1e3 * 100 * tube->c / (2 * tube->stiffness) / 0.75, 1e-9);
    free(tube);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fine_tube_sags),
        cmocka_unit_test(fine_tube_twists),
        cmocka_unit_test(tip_converges_in_bending),
        cmocka_unit_test(tip_converges_in_planes_that_differ),
        cmocka_unit_test(spin_at_exit_does_not_converge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
