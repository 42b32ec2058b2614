// A flexible manipulator: two slender beams between revolute hinges swing a load through a large
// angle. First its natural frequencies, the shoulder free and the elbow sprung, then the motion.
//
//   beam_chain
#include <launchdyn/mstmm.h>
#include <math.h>
#include <stdio.h>

enum { SHOULDER, ELBOW, LOAD, ELEMENTS };

// A torque at the shoulder, up and down within a second.
static void drive(double t, const double *q, const double *u, double *tau, double *wrench,
                  void *context)
{
    (void)q, (void)u, (void)wrench, (void)context;
    tau[0] = t < 1 ? 150 * sin(2 * acos(-1) * t) : 0;
}

static int print_row(double t, const double *q, const double *u, void *context)
{
    ld_mstmm *system = context;
    const double origin[3] = {0, 0, 0};
    ld_mstmm_point load = ld_mstmm_locate(system, q, u, LOAD, origin);
    ld_mstmm_energies e = ld_mstmm_energy(system, q, u);
    printf("%6.2f  %8.4f  %8.4f  %8.4f  %10.3e\n", t, q[0], load.position[0], load.position[1],
           e.elastic);
    return 0;
}

int main(void)
{
    // an aluminium tube of 40 mm, 2 mm thick: 2/3 kg/m, E I = 3025 N m2
    const ld_section tube = {.mass_per_length = 0.645,
                             .axial_stiffness = 1.67e7,
                             .bending_stiffness = 3025,
                             .torsion_stiffness = 2270,
                             .polar_inertia = 2.33e-4};
    const ld_mstmm_beam beam = {.length = 2,
                                .section_count = 1,
                                .section = &tube,
                                .bending = 4,
                                .torsion = 1,
                                .damping = 0.01};
    const ld_mstmm_element arm[ELEMENTS] = {
        [SHOULDER] = {.name = "upper arm",
                      .hinge = LD_HINGE_REVOLUTE,
                      .axis = {0, 0, 1},
                      .beam = &beam},
        [ELBOW] = {.name = "fore arm",
                   .parent = "upper arm",
                   .at = {2, 0, 0},
                   .hinge = LD_HINGE_REVOLUTE,
                   .axis = {0, 0, 1},
                   .stiffness = {400},
                   .damping = {5},
                   .beam = &beam},
        [LOAD] = {.name = "load",
                  .parent = "fore arm",
                  .at = {2, 0, 0},
                  .hinge = LD_HINGE_WELD,
                  .mass = 2,
                  .inertia = {0.01, 0.01, 0.01}},
    };
    const double no_gravity[3] = {0, 0, 0};
    ld_mstmm *system;
    ld_error error;
    if (ld_mstmm_create(arm, ELEMENTS, no_gravity, &system, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }

    double q[32] = {0}, u[32] = {0};
    ld_mstmm_mode mode[32];
    int count;
    ld_status status = ld_mstmm_vibration(system, q, NULL, mode, NULL, &count, &error);
    for (int k = 0; !status && k < 6; k++)
        printf("mode %d: %8.3f Hz, damping ratio %.4f\n", k + 1, mode[k].frequency,
               mode[k].damping);

    const ld_mstmm_settings settings = {
        .output_step = 0.1, .drive = drive, .sink = print_row, .context = system};
    printf("t [s]   shoulder [rad]  load x, y [m]   elastic energy [J]\n");
    if (!status)
        status = ld_mstmm_integrate(system, &settings, 0, 2, q, u, NULL, &error);
    if (status)
        fprintf(stderr, "%s\n", error.text);
    ld_mstmm_free(system);
    return status != LD_OK;
}
