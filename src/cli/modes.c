// launchdyn modes: natural frequencies of the tube on its supports and of the whole at equilibrium.
#include <stdio.h>

#include "cli/command.h"
#include "launchdyn/output.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"

enum { MOST = 256 };

// As "%.4f" prints it, without the sign of what rounds to nothing.
static double to_four_decimals(double value)
{
    return value > -0.5e-4 && value < 0 ? 0 : value;
}

static void print_modes(const ld_mode *modes, int count)
{
    puts("       frequency [Hz]  damping ratio [%]  shape");
    for (int i = 0; i < count; i++)
        printf("%4d %16.4f %18.4f  %s\n", i + 1, modes[i].frequency,
               to_four_decimals(modes[i].damping * 100), modes[i].shape);
}

static void print_poles(const ld_pole *poles, int count)
{
    puts("Eigenvalues of the damped system\n           real [1/s]  imaginary [rad/s]  shape");
    for (int i = 0; i < count; i++)
        printf("%4d %16.6g %18.6g  %s\n", i + 1, poles[i].real + 0.0, poles[i].imaginary + 0.0,
               poles[i].shape);
}

static void print_system(const ld_model *model, const ld_found_modes *modes)
{
    const char *guide = ld_model_guide(model);
    if (ld_model_has_vehicle(model))
        printf("\nVehicle, platforms, %s and locked rocket about their equilibrium on a flat road, "
               "without Coulomb friction: moduli of the damped eigenvalues\n",
               guide);
    else
        printf("\nUndamped frequencies of %s, tail and locked rocket about their equilibrium, "
               "without Coulomb friction\n",
               guide);
    print_modes(modes->system, modes->system_count);
    putchar('\n');
    print_poles(modes->pole, modes->pole_count);
}

static ld_status list_modes(const ld_model *model, bool json, ld_error *error)
{
    static ld_mode tube[MOST], whole[MOST];
    static ld_pole poles[2 * MOST];
    ld_found_modes found = {.tube = tube, .system = whole, .pole = poles};
    ld_simulation *simulation = NULL;
    if (!ld_model_has_launcher(model))
        return ld_fail(error, LD_ERR_INPUT,
                       "a scenario of flight only has no launcher and no modes");
    ld_status status = ld_simulation_create(model, &simulation, error);
    if (status)
        return status;
    bool text = !json && !command_is_quiet();
    found.tube_count = ld_simulation_tube_modes(simulation, tube, MOST);
    if (text) {
        printf("Undamped frequencies of %s and tail on their supports, base fixed\n",
               ld_model_guide(model));
        print_modes(tube, found.tube_count);
    }
    command_step("found the modes of the tube");
    status = ld_simulation_system_modes(simulation, whole, MOST, &found.system_count, poles,
                                        2 * MOST, &found.pole_count, error);
    ld_simulation_free(simulation);
    if (status)
        return status;
    command_step("found the modes of the whole system about its equilibrium");
    if (json)
        ld_modes_print_json(&found, stdout);
    if (text)
        print_system(model, &found);
    return LD_OK;
}

static int print_all_modes(const ld_model *model, void *data)
{
    const int *json = data;
    ld_error error;
    ld_status status = list_modes(model, *json != 0, &error);
    return status ? command_fail_on(model, status, &error) : 0;
}

int command_modes(const command *self, int argc, char **argv)
{
    char **sets = NULL;
    int json = 0;
    const command_option options[] = {COMMAND_SETS(&sets), COMMAND_JSON(&json), COMMAND_USUAL};
    return command_on_model(self, argc, argv, options, &sets, print_all_modes, &json);
}
