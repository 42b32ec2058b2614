// A fast heavy top on a spherical hinge: its place and its precession, against the slow precession
// of the classical theory, m g l/(J w).
//
//   heavy_top
#include <launchdyn/mstmm.h>
#include <math.h>
#include <stdio.h>

int main(void)
{
    const double mass = 15, length = 1, spin = 150, axial = 0.46875, g = 9.81;
    const ld_mstmm_element top = {.name = "top",
                                  .hinge = LD_HINGE_SPHERICAL,
                                  .mass = mass,
                                  .center = {0, length, 0},
                                  .inertia = {0.234375, axial, 0.234375}};
    const double gravity[3] = {0, 0, -g};
    ld_mstmm *system;
    ld_error error;
    if (ld_mstmm_create(&top, 1, gravity, &system, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }

    // the axis lies along y at first; q is the quaternion, u the rate in the top's own axes
    double q[4] = {1, 0, 0, 0}, u[3] = {0, spin, mass * g * length / (axial * spin)}, t = 0,
           angle = 0;
    const double tip[3] = {0, length, 0};
    const ld_mstmm_settings settings = {.rtol = 1e-11, .atol = 1e-11};
    printf("   t [s]   x [m]     y [m]     z [m]    precession [rad/s]\n");
    for (int k = 1; k <= 10; k++) {
        ld_mstmm_statistics done;
        if (ld_mstmm_integrate(system, &settings, t, 0.1 * k, q, u, &done, &error)) {
            fprintf(stderr, "%s\n", error.text);
            break;
        }
        ld_mstmm_point p = ld_mstmm_locate(system, q, u, 0, tip);
        double now = atan2(-p.position[0], p.position[1]);
        double turned = remainder(now - angle, 2 * acos(-1));
        printf("%8.3f %9.5f %9.5f %9.5f %9.4f\n", 0.1 * k, p.position[0], p.position[1],
               p.position[2], turned / 0.1);
        angle = now;
        t = 0.1 * k;
    }
    printf("steady precession by theory: %.4f rad/s\n", mass * g * length / (axial * spin));
    ld_mstmm_free(system);
    return 0;
}
