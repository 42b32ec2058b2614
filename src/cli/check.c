// launchdyn check: what is wrong with a scenario, or what was understood.
#include <stdio.h>

#include "cli/command.h"
#include "launchdyn/scenario.h"

static int print_model(const ld_model *model, void *data)
{
    (void)data;
    ld_model_print(model, stdout);
    return 0;
}

int command_check(const command *self, int argc, const char **argv)
{
    char **sets = NULL;
    const struct poptOption options[] = {COMMAND_SETS(&sets), COMMAND_HELP, COMMAND_END};
    return command_on_model(self, argc, argv, options, &sets, print_model, NULL);
}
