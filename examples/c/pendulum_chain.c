// A spatial pendulum chain: five links on universal hinges, released from the horizontal.
//
//   pendulum_chain > chain.txt        t, place of the end, energy's change
#include <launchdyn/mstmm.h>
#include <stdio.h>

enum { LINKS = 5 };

typedef struct watch {
    ld_mstmm *system;
    double energy; // [J] at the start
} watch;

static int print_row(double t, const double *q, const double *u, void *context)
{
    watch *w = context;
    const double end[3] = {0.4, 0, 0};
    ld_mstmm_point p = ld_mstmm_locate(w->system, q, u, LINKS - 1, end);
    ld_mstmm_energies e = ld_mstmm_energy(w->system, q, u);
    if (t == 0)
        w->energy = e.kinetic + e.potential;
    printf("%6.3f  %9.6f %9.6f %9.6f  %10.2e\n", t, p.position[0], p.position[1], p.position[2],
           e.kinetic + e.potential - w->energy);
    return 0;
}

int main(void)
{
    // each link hangs on the end of the one before
    static const char *const name[LINKS] = {"link 1", "link 2", "link 3", "link 4", "link 5"};
    ld_mstmm_element link[LINKS] = {{0}};
    for (int i = 0; i < LINKS; i++) {
        link[i] = (ld_mstmm_element){.name = name[i],
                                     .parent = i ? name[i - 1] : NULL,
                                     .at = {i ? 0.4 : 0, 0, 0},
                                     .hinge = LD_HINGE_UNIVERSAL,
                                     .axis = {0, 0, 1},
                                     .axis_2 = {0, 1, 0},
                                     .mass = 1,
                                     .center = {0.2, 0, 0},
                                     .inertia = {0.001, 0.0134, 0.0134}};
    }
    const double gravity[3] = {0, -9.80665, 0};
    watch w = {0};
    ld_error error;
    if (ld_mstmm_create(link, LINKS, gravity, &w.system, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }

    // two angles a link; a push sideways makes the motion spatial
    double q[2 * LINKS] = {0}, u[2 * LINKS] = {[1] = 0.5};
    const ld_mstmm_settings settings = {
        .rtol = 1e-10, .atol = 1e-10, .output_step = 0.1, .sink = print_row, .context = &w};
    ld_status status = ld_mstmm_integrate(w.system, &settings, 0, 3, q, u, NULL, &error);
    if (status)
        fprintf(stderr, "%s\n", error.text);
    ld_mstmm_free(w.system);
    return status != LD_OK;
}
