// usage: foreign_step_fmu FILE STOP STEP [NAME=VALUE...]
// Steps an FMU of other people's by our importer, from 0 s to STOP [s] by STEP [s], and prints its
// outputs that are numbers as CSV, of an array all elements. Parameters and inputs keep the values
// given, VALUE,VALUE,... of an array. For comparing by hand (docs/fmi.md).
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "foreign/foreign.h"

typedef struct choice {
    size_t count;
    foreign_value value[FOREIGN_MOST_VALUES];
} choice;

static size_t length_of(const foreign_variable *variable)
{
    return variable->elements ? variable->elements : 1;
}

static bool is_number(const foreign_variable *variable)
{
    return variable->type < FOREIGN_STRING && length_of(variable) <= FOREIGN_MOST_VALUES;
}

// One value more of this variable; false: there is no room.
static bool add(choice *to, const foreign_variable *variable, double value)
{
    if (to->count == FOREIGN_MOST_VALUES)
        return false;
    to->value[to->count++] = (foreign_value){.reference = variable->reference,
                                             .type = (int32_t)variable->type,
                                             .value = value,
                                             .elements = variable->elements};
    return true;
}

static bool find_outputs(const foreign_description *all, choice *outputs)
{
    bool fine = true;
    printf("time");
    for (size_t i = 0; i < all->count; i++) {
        const foreign_variable *variable = &all->variable[i];
        if (variable->causality != FOREIGN_OUTPUT || !is_number(variable))
            continue;
        for (size_t k = 0; k < length_of(variable) && fine; k++) {
            printf(variable->elements ? ",%s[%zu]" : ",%s", variable->name, k + 1);
            fine = add(outputs, variable, 0);
        }
    }
    printf("\n");
    return fine;
}

// Those given as NAME=VALUE, inputs and others apart. False: there is no such variable.
static bool find_given(const foreign_description *all, char *const *given, choice *inputs,
                       choice *others)
{
    for (; *given; given++) {
        char *at = strchr(*given, '=');
        if (!at)
            return false;
        *at = '\0';
        const foreign_variable *variable = foreign_variable_find(all, *given);
        if (!variable || !is_number(variable))
            return false;
        choice *to = variable->causality == FOREIGN_INPUT ? inputs : others;
        for (size_t k = 0; k < length_of(variable); k++)
            if (!at || !add(to, variable, strtod(at + 1, &at)))
                return false;
        if (*at)
            return false;
    }
    return true;
}

static void print_row(double t, const double *number, size_t count)
{
    printf("%.16g", t);
    for (size_t i = 0; i < count; i++)
        printf(",%.17g", number[i]);
    printf("\n");
}

static ld_status walk(foreign_instance *fmu, double stop, double step, const choice *inputs,
                      const choice *outputs, ld_error *error)
{
    static foreign_value values[2 * FOREIGN_MOST_VALUES];
    static double number[FOREIGN_MOST_VALUES];
    ld_status status = foreign_get(fmu, 0, outputs->value, outputs->count, number, error);
    memcpy(values, inputs->value, inputs->count * sizeof *values);
    memcpy(values + inputs->count, outputs->value, outputs->count * sizeof *values);
    for (long k = 0; !status && (double)k * step < stop * (1 - 1e-12); k++) {
        print_row((double)k * step, number, outputs->count);
        foreign_stepping stepping = {(double)k * step, step, (uint32_t)inputs->count,
                                     (uint32_t)outputs->count, false};
        int pieces;
        status = foreign_step(fmu, stepping.t, &stepping, values, number, &pieces, error);
    }
    if (!status)
        print_row(stop, number, outputs->count);
    return status;
}

static ld_status simulate(const foreign_package *package, char **argv, ld_error *error)
{
    static choice inputs, outputs, others;
    foreign_instance *fmu = NULL;
    if (!find_given(&package->description, argv + 4, &inputs, &others))
        return ld_fail(error, LD_ERR_INPUT, "NAME=VALUE wants a variable that is a number");
    ld_status status = foreign_begin(package, 10, &fmu, error);
    if (!status)
        status = foreign_set(fmu, NAN, others.value, others.count, error);
    if (!status)
        status = foreign_enter(fmu, 0, 0, error);
    if (!status)
        status = foreign_set(fmu, 0, inputs.value, inputs.count, error);
    if (!status)
        status = foreign_leave(fmu, 0, error);
    if (!status && !find_outputs(&package->description, &outputs))
        status = ld_fail(error, LD_ERR_INPUT, "it has too many outputs");
    if (!status)
        status = walk(fmu, strtod(argv[2], NULL), strtod(argv[3], NULL), &inputs, &outputs, error);
    foreign_end(fmu);
    return status;
}

int main(int argc, char **argv)
{
    foreign_package *package = NULL;
    ld_error error = {0};
    if (argc < 4) {
        fprintf(stderr, "usage: foreign_step_fmu FILE STOP STEP [NAME=VALUE...]\n");
        return 2;
    }
    ld_status status = foreign_open(argv[1], &package, &error);
    if (!status)
        status = simulate(package, argv, &error);
    foreign_close(package);
    if (status)
        fprintf(stderr, "%s\n", error.text);
    return status ? 1 : 0;
}
