// The limit of a rail, supports and contacts that do not give: a rigid rocket on two shoes without
// gaps and friction, then on its rear one, about which it pivots (support/rigid_rail.h). Everything
// is made stiff, and twice as stiff: what the finite stiffness does goes with its inverse, and the
// two launches give the limit.
// ctest: slow
#include <stdlib.h>

#include "model/model.h"
#include "quantities/summary.h"
#include "support/check.h"
#include "support/reference_model.h"
#include "support/rigid_rail.h"

static const double degree = 3.14159265358979323846 / 180;

// ---- stiff rails ----

// Rail, supports and contacts of one stiffness [N/m, N m2, N m/rad], damped as much as quickly
// dies.
static void stiffen(ld_model *model, double stiffness)
{
    ld_tubes *tubes = &model->tubes;
    tubes->section[0].bending_stiffness = stiffness;
    tubes->section[0].torsion_stiffness = stiffness;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++) {
            tubes->support[k].stiffness[i] = stiffness;
            tubes->support[k].rotational_stiffness[i] = stiffness;
            tubes->support[k].damping[i] = 2 * sqrt(stiffness * 10);
            tubes->support[k].rotational_damping[i] = sqrt(stiffness * 3);
        }
    model->rocket.contact.stiffness = stiffness;
    model->rocket.contact.damping = 2 * sqrt(stiffness * 10);
}

static void rail(ld_model *model)
{
    reference_model(model);
    ld_tubes *tubes = &model->tubes;
    tubes->modes = (ld_modes){
        .bending = 2, .torsion = 1, .elements = 8, .span = LD_SPAN_SUPPORTED, .damping = 0.01};
    tubes->section[0].polar_inertia = 1;
    tubes->tail = (ld_tail){.mass = 30, .center = -0.1, .inertia = {3, 3, 3}};
    tubes->slot.kind = LD_SLOT_NONE;
    tubes->guide.present = true;
    tubes->guide.line[0] = 0.12;
    tubes->guide.line[1] = -0.03;
    ld_rocket *rocket = &model->rocket;
    rocket->adaptor_count = 2;
    rocket->adaptor[1] = rocket->adaptor[2];
    rocket->adaptor[0].clearance = rocket->adaptor[1].clearance = NAN;
    rocket->contact.law = LD_CONTACT_KELVIN_VOIGT;
    rocket->contact.friction = 0;
    rocket->eccentricity[0] = 4e-3;
    rocket->eccentricity[1] = -2e-3;
    model->run.start = LD_START_UNDEFORMED;
    model->run.tolerance = 1e-7;
    model->base.kind = LD_BASE_PRESCRIBED;
}

static void tower(ld_model *model)
{
    model->tubes.guide.form = LD_GUIDE_TOWER;
    model->tubes.guide.tower = (ld_tower){.rails = 4, .first = 45 * degree, .radius = 0.1};
}

static void t_slot(ld_model *model)
{
    model->tubes.guide.form = LD_GUIDE_T_SLOT;
    model->tubes.guide.t_slot = (ld_t_slot){.lips = 0.06};
}

static void resting(ld_model *model)
{
    (void)model;
}

static void surging(ld_model *model)
{
    model->base.surge = (ld_sines){1, {{0.2, 1.5, 0}}};
    model->base.heave = (ld_sines){1, {{0.1, 2, 0}}};
    model->base.sway = (ld_sines){1, {{0.1, 1.6, 0}}};
}

static void pitching(ld_model *model)
{
    model->base.azimuth = 30 * degree;
    model->base.velocity[0] = 8;
    model->base.yaw = (ld_sines){1, {{1 * degree, 1.1, 0.4}}};
    model->base.pitch = (ld_sines){1, {{3 * degree, 1, 0}}};
    model->base.roll = (ld_sines){1, {{3 * degree, 0.8, 1}}};
}

// A wind from the side of 20 m/s on a body that hardly moves the less by it.
static void pitching_in_wind(ld_model *model)
{
    static double table[] = {0, 0.4, 0.3, 9, 0.9, 5, -8, -300, 1, 0.6, 0.5, 11, 0.8, 6, -9, -400};
    pitching(model);
    model->environment.atmosphere = (ld_atmosphere){
        .kind = LD_ATMOSPHERE_UNIFORM, .density = 1.2, .density_scale = 1, .speed_of_sound = 340};
    model->environment.wind = (ld_wind){.present = true, .speed = 20, .scale = 1, .heading = 1.4};
    model->rocket.aerodynamics =
        (ld_aerodynamics){.present = true,
                          .reference_diameter = 0.16,
                          .ca_scale = 1,
                          .cn_scale = 1,
                          .fin_cant = 0.02,
                          .table = {.rows = 2, .columns = 8, .data = table}};
    model->rocket.aerodynamics.crossflow.present = true;
    model->rocket.aerodynamics.crossflow.drag = 20;
    model->rocket.aerodynamics.crossflow.at = 1.3;
}

// ---- figures ----

enum { RELEASE, FRONT, REAR, SPEED, PITCH, YAW, PITCH_RATE, YAW_RATE, SPIN, FIGURES };

static const char *const figure_name[FIGURES] = {
    "t_release [s]", "t_front [s]",        "t_rear [s]",       "exit speed [m/s]", "pitch [rad]",
    "yaw [rad]",     "pitch rate [rad/s]", "yaw rate [rad/s]", "spin [rad/s]"};

static void launch(const ld_model *model, double figure[FIGURES])
{
    ld_simulation *simulation = NULL;
    static ld_summary summary;
    ld_error error;
    if (model_check(model, &error) || ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    const ld_rocket_summary *r = &summary.rocket[0];
    printf("    %d steps, %.2f s\n", (int)summary.statistics.steps, summary.statistics.cpu_seconds);
    memcpy(figure,
           (double[]){r->t_release, r->t_front, r->t_rear, r->exit_speed, r->pitch, r->yaw,
                      r->pitch_rate, r->yaw_rate, r->spin_rate},
           FIGURES * sizeof *figure);
}

typedef struct scenario {
    const char *name;
    void (*guide)(ld_model *);
    void (*base)(ld_model *);
    bool holds_roll;
    double ends[2]; // [m] of the rear shoe and the front one; 0: the tip
} scenario;

static void pivots_about_its_rear_shoe(void **state)
{
    const scenario *s = *state;
    ld_model model;
    rigid_exit exit;
    double stiff[FIGURES], stiffer[FIGURES];
    rail(&model);
    s->guide(&model);
    s->base(&model);
    for (int i = 0; i < 2; i++)
        model.rocket.adaptor[i].leaves_at = s->ends[i] > 0 ? s->ends[i] : NAN;
    assert_true(rigid_rail_launch(&model, model.tubes.guide.line, s->holds_roll, 2e-4, &exit));
    const double limit[FIGURES] = {exit.t_release,  exit.t_front,  exit.t_rear,
                                   exit.exit_speed, exit.pitch,    exit.yaw,
                                   exit.pitch_rate, exit.yaw_rate, exit.spin_rate};
    stiffen(&model, 4e9);
    launch(&model, stiff);
    stiffen(&model, 8e9);
    launch(&model, stiffer);
    printf("  %s\n", s->name);
    double rate = fmax(0.1, hypot(exit.pitch_rate, exit.yaw_rate)); // 0: both shoes at once
    const double scale[FIGURES] = {exit.t_rear, exit.t_rear, exit.t_rear, exit.exit_speed, 1, 1,
                                   rate,        rate,        rate};
    for (int i = 0; i < FIGURES; i++) {
        double off = (stiffer[i] - limit[i]) / scale[i], half = (stiff[i] - limit[i]) / scale[i];
        printf("    %-18s %12.9f, off by %9.2e, twice as stiff %9.2e\n", figure_name[i], limit[i],
               half, off);
        CHECK_BELOW("  extrapolated, relative", 2 * off - half, 1e-6);
    }
    if (rate == 0.1)
        return;
    // to first order in the flexibility
    double order =
        (stiff[PITCH_RATE] - limit[PITCH_RATE]) / (stiffer[PITCH_RATE] - limit[PITCH_RATE]);
    CHECK_WITHIN("pitch rate: stiff over twice as stiff", order, 1.6, 2.4);
    model.rocket.aerodynamics.table.data = NULL; // not the model's own
    reference_model_free(&model);
}

int main(void)
{
    static scenario scenarios[] = {
        {"tower, pitching base", tower, pitching, false, {2.9, 2.7}},
        {"T-slot, fixed base", t_slot, resting, true, {0}},
        {"T-slot, accelerating base, both shoes at once", t_slot, surging, true, {1, 2.9}},
        {"T-slot, pitching base, in the wind", t_slot, pitching_in_wind, true, {0}},
    };
    enum { COUNT = sizeof scenarios / sizeof *scenarios };
    struct CMUnitTest tests[COUNT];
    for (int i = 0; i < COUNT; i++)
        tests[i] = (struct CMUnitTest){scenarios[i].name, pivots_about_its_rear_shoe, NULL, NULL,
                                       &scenarios[i]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
