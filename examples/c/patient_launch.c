// A run in steps: a launch that waits. Once the time of firing has come the rocket is ignited where
// the tube's tip, moved by the road, next stops pitching; beside it the launch at the time of
// firing.
//
//     patient_launch SCENARIO.yaml
#include <launchdyn/run.h>
#include <launchdyn/scenario.h>
#include <launchdyn/summary.h>

#include <math.h>
#include <stdio.h>

// Continues in steps of 1 ms from `from` until the pitch rate of the tip in inertial space changes
// sign, and ignites the rocket there.
static ld_status ignite_at_rest(ld_run *run, double from, ld_error *error)
{
    const double step = 1e-3;
    double before, now = 0, t = from;
    ld_status status = ld_run_ignite(run, INFINITY, error);
    if (!status)
        status = ld_run_advance(run, t, error);
    if (!status)
        status = ld_run_number(run, "tip.inertial_pitch_rate", &now, error);
    for (before = now; !status && before * now > 0; t += step) {
        before = now;
        status = ld_run_advance(run, t + step, error);
        if (!status)
            status = ld_run_number(run, "tip.inertial_pitch_rate", &now, error);
    }
    if (!status)
        printf("waited %.0f ms: the tip pitches at %.3f mrad/s\n", 1e3 * (t - from), 1e3 * now);
    return status ? status : ld_run_ignite(run, t, error);
}

// Runs to the end of the launch, waiting first or not, and says how the rocket left.
static ld_status launch(const ld_simulation *simulation, bool waits, ld_error *error)
{
    ld_run *run;
    double rate = NAN, mach = NAN;
    ld_summary *summary = ld_summary_new();
    ld_status status = ld_run_begin(simulation, NULL, &run, error);
    if (!status && waits)
        status = ignite_at_rest(run, 0, error);
    if (!status)
        status = ld_run_advance(run, INFINITY, error);
    if (!status)
        status = ld_summary_number(ld_run_summary(run), "rocket.1.pitch_rate", &rate, error);
    if (!status)
        printf("%-16s leaves its tube with a pitch rate of %.3f mrad/s\n",
               waits ? "ignited with the tip at rest" : "ignited at its time", 1e3 * rate);
    ld_error unused;
    if (ld_run_end(run, status ? NULL : summary, status ? &unused : error) && !status)
        status = error->status;
    if (!status && !ld_summary_number(summary, "rocket.1.max_mach", &mach, NULL) && !isnan(mach))
        printf("%-16s flies at up to Mach %.3f\n", "", mach);
    ld_summary_free(summary);
    return status;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: patient_launch SCENARIO.yaml\n");
        return 2;
    }
    ld_model *model = NULL;
    ld_messages messages;
    ld_simulation *simulation = NULL;
    ld_error error = {0};
    if (ld_scenario_read(argv[1], NULL, 0, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        return 2;
    }
    ld_messages_free(&messages);
    ld_status status = ld_simulation_create(model, &simulation, &error);
    if (!status)
        status = launch(simulation, false, &error);
    if (!status)
        status = launch(simulation, true, &error);
    if (status)
        fprintf(stderr, "patient_launch: %s\n", error.text);
    ld_simulation_free(simulation);
    ld_model_free(model);
    return status ? 1 : 0;
}
