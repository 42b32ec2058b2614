// A platform on a spring under a launcher: moves up and down only.
//     platform SCENARIO   a scenario with `base.kind: external`
#include <launchdyn/run.h>
#include <launchdyn/scenario.h>
#include <launchdyn/summary.h>

#include <math.h>
#include <stdio.h>

static const double mass = 500, stiffness = 5e5, damping = 4e3; // [kg], [N/m], [N.s/m]
static const double step = 1e-4;                                //  [s] between two exchanges

int main(int argc, char **argv)
{
    ld_model *model;
    ld_messages messages;
    ld_simulation *simulation;
    ld_run *run;
    ld_error error;
    ld_base_wrench wrench;
    // The tube's frame: its rear end at the origin, 19.8 degrees up, which is a turn about z.
    const double half = 9.9 * acos(-1) / 180;
    ld_base_frame frame = {.quaternion = {cos(half), 0, 0, sin(half)}};

    if (argc != 2) {
        fprintf(stderr, "usage: platform SCENARIO\n");
        return 2;
    }
    if (ld_scenario_read(argv[1], NULL, 0, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        return 2;
    }
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_run_begin(simulation, &(ld_run_options){.base = &frame}, &run, &error) ||
        ld_run_base_wrench(run, &wrench, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    const double carried = -wrench.force[1]; // [N] what the spring carries at rest
    double highest = 0, y = 0, v = 0;
    while (!ld_run_is_finished(run)) {
        // Over one step: the platform under the force of the tube, then the launcher on the
        // platform.
        double a = (wrench.force[1] + carried - stiffness * y - damping * v) / mass;
        v += step * a;
        y += step * v;
        highest = fmax(highest, y);
        if (ld_run_advance(run, ld_run_time(run) + step, &error))
            break;
        frame.position[1] = y;
        frame.velocity[1] = v;
        if (!ld_run_is_finished(run) &&
            (ld_run_set_base(run, &frame, &error) || ld_run_base_wrench(run, &wrench, &error)))
            break;
    }
    ld_summary *summary = ld_summary_new();
    double rate;
    if (ld_run_end(run, summary, &error) ||
        ld_summary_number(summary, "rocket.1.pitch_rate", &rate, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    printf("the platform rises by %.2f mm, pitch rate %.1f mrad/s\n", 1e3 * highest, 1e3 * rate);
    ld_summary_free(summary);
    ld_simulation_free(simulation);
    ld_model_free(model);
    return 0;
}
