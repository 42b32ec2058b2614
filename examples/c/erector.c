// An erector: a cylinder between frame and boom raises a load. Cylinder and boom make a closed
// loop, described as a tree (boom, cylinder's barrel and rod) and the pin that closes it. The loop
// is closed from a guess, then the cylinder's force follows a ramp of its length, then it is
// locked.
//
//   erector
#include <launchdyn/mstmm.h>
#include <math.h>
#include <stdio.h>

enum { BOOM, BARREL, ROD, LOAD, ELEMENTS };

static const double shortest = 1.65, longest = 2.55, extended_at = 8; // [m], [s]

// The cylinder's force: the load's share and a spring towards the ramp's length.
static void drive(double t, const double *q, const double *u, double *tau, double *wrench,
                  void *context)
{
    (void)wrench, (void)context;
    double part = fmin(t / extended_at, 1), smooth = part * part * (3 - 2 * part);
    double length = shortest + (longest - shortest) * smooth;
    tau[ROD] = 3e6 * (length - q[ROD]) - 2e5 * u[ROD];
}

static int print_row(double t, const double *q, const double *u, void *context)
{
    ld_mstmm *system = context;
    double tau[ELEMENTS] = {0}, wrench[6 * ELEMENTS] = {0}, u_dot[ELEMENTS], pin[6];
    ld_error error;
    drive(t, q, u, tau, wrench, context);
    if (ld_mstmm_accelerations(system, q, u, tau, wrench, u_dot, &error))
        return 1;
    ld_mstmm_loop_force(system, 0, pin);
    printf("%5.1f  %10.3f  %10.4f  %12.2f  %12.2f  %10.1e\n", t, q[BOOM] * 180 / acos(-1), q[ROD],
           1e-3 * tau[ROD], 1e-3 * hypot(pin[0], pin[1]), ld_mstmm_singularity(system, NULL));
    return 0;
}

int main(void)
{
    const double turn[3] = {0, 0, 1};
    ld_mstmm_element erector[ELEMENTS] = {
        [BOOM] = {.name = "boom",
                  .hinge = LD_HINGE_REVOLUTE,
                  .mass = 900,
                  .center = {2.5, 0, 0},
                  .inertia = {20, 1900, 1900}},
        [BARREL] = {.name = "barrel",
                    .at = {1.2, -0.9, 0},
                    .hinge = LD_HINGE_REVOLUTE,
                    .mass = 80,
                    .center = {0.6, 0, 0},
                    .inertia = {1, 10, 10}},
        [ROD] = {.name = "rod",
                 .parent = "barrel",
                 .hinge = LD_HINGE_PRISMATIC,
                 .axis = {1, 0, 0},
                 .mass = 40,
                 .center = {-0.6, 0, 0},
                 .inertia = {0.5, 5, 5}},
        [LOAD] = {.name = "load",
                  .parent = "boom",
                  .at = {3, 0.4, 0},
                  .mass = 2500,
                  .inertia = {300, 5000, 5000}},
    };
    for (int k = 0; k < 3; k++)
        erector[BOOM].axis[k] = erector[BARREL].axis[k] = turn[k];
    const ld_mstmm_loop pin = {.name = "rod's pin",
                               .first = {.element = "boom", .at = {2.4, -0.1, 0}},
                               .second = {.element = "rod"},
                               .joint = LD_HINGE_REVOLUTE,
                               .axis = {0, 0, 1}};
    const ld_mstmm_description description = {.elements = erector,
                                              .element_count = ELEMENTS,
                                              .loops = &pin,
                                              .loop_count = 1,
                                              .gravity = {0, -9.81, 0}};
    ld_mstmm *system;
    ld_error error;
    if (ld_mstmm_build(&description, &system, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }

    // the cylinder at its shortest; boom and barrel from a guess
    double q[ELEMENTS] = {[BOOM] = 0.2, [BARREL] = 0.8, [ROD] = shortest}, u[ELEMENTS] = {0};
    const int kept[ELEMENTS] = {[ROD] = 1};
    ld_mstmm_assembly found;
    ld_status status = ld_mstmm_assemble(system, q, u, kept, &found, &error);
    if (!status) {
        printf("%d freedom, %d constraints held, %d redundant\n", found.freedoms, found.held,
               found.redundant);
        printf("t [s]  boom [deg]  length [m]  force [kN]    pin [kN]      singularity\n");
        const ld_mstmm_settings settings = {
            .output_step = 1, .drive = drive, .sink = print_row, .context = system};
        status = ld_mstmm_integrate(system, &settings, 0, 10, q, u, NULL, &error);
    }

    // locked: what does the cylinder carry?
    if (!status) {
        double none[ELEMENTS] = {0}, reaction[6 * ELEMENTS], u_dot[ELEMENTS];
        for (int k = 0; k < ELEMENTS; k++)
            u[k] = 0;
        ld_mstmm_prescribe(system, ROD, 1);
        status = ld_mstmm_accelerations(system, q, u, none, NULL, u_dot, &error);
        ld_mstmm_reactions(system, q, u, u_dot, NULL, reaction);
        const double *f = reaction + 6 * ROD, angle = q[BARREL];
        if (!status)
            printf("locked, the cylinder carries %.2f kN\n",
                   1e-3 * (f[0] * cos(angle) + f[1] * sin(angle)));
    }
    if (status)
        fprintf(stderr, "%s\n", error.text);
    ld_mstmm_free(system);
    return status != LD_OK;
}
