// launchdyn modes: natural frequencies of the tube on its supports and of the whole at equilibrium.
#include <stdio.h>

#include "cli/command.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"

enum { MOST = 256 };

// As "%.4f" prints it, without the sign of what rounds to nothing.
static double to_four_decimals(double value)
{
    return value > -0.5e-4 && value < 0 ? 0 : value;
}

static void print_modes(const char *title, const ld_mode *modes, int count)
{
    printf("%s\n       frequency [Hz]  damping ratio [%%]  shape\n", title);
    for (int i = 0; i < count; i++)
        printf("%4d %16.4f %18.4f  %s\n", i + 1, modes[i].frequency,
               to_four_decimals(modes[i].damping * 100), modes[i].shape);
}

static void print_poles(const ld_pole *poles, int count)
{
    puts("Its eigenvalues with damping\n           real [1/s]  imaginary [rad/s]  shape");
    for (int i = 0; i < count; i++)
        printf("%4d %16.6g %18.6g  %s\n", i + 1, poles[i].real + 0.0, poles[i].imaginary + 0.0,
               poles[i].shape);
}

static ld_status list_modes(const ld_model *model, ld_error *error)
{
    static ld_mode modes[MOST];
    static ld_pole poles[2 * MOST];
    ld_simulation *simulation = NULL;
    if (!ld_model_has_launcher(model))
        return ld_fail(error, LD_ERR_INPUT, "a flight alone has no launcher, and no modes");
    ld_status status = ld_simulation_create(model, &simulation, error);
    if (status)
        return status;
    int count = ld_simulation_tube_modes(simulation, modes, MOST), pole_count;
    print_modes("Tube and tail on their supports, base held, undamped frequencies", modes, count);
    status = ld_simulation_system_modes(simulation, modes, MOST, &count, poles, 2 * MOST,
                                        &pole_count, error);
    if (!status) {
        putchar('\n');
        print_modes(ld_model_has_vehicle(model)
                        ? "Vehicle with platforms, tube and locked rocket about their equilibrium "
                          "on a flat road, no Coulomb friction: moduli of the damped eigenvalues"
                        : "Tube, tail and locked rocket about their equilibrium, no Coulomb "
                          "friction, undamped",
                    modes, count);
        putchar('\n');
        print_poles(poles, pole_count);
    }
    ld_simulation_free(simulation);
    return status;
}

static int print_all_modes(const ld_model *model, void *data)
{
    (void)data;
    ld_error error;
    ld_status status = list_modes(model, &error);
    return status ? command_fail_on(model, status, &error) : 0;
}

int command_modes(const command *self, int argc, char **argv)
{
    char **sets = NULL;
    const command_option options[] = {COMMAND_SETS(&sets), COMMAND_HELP, COMMAND_END};
    return command_on_model(self, argc, argv, options, &sets, print_all_modes, NULL);
}
