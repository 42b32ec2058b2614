// In place of base_fmu.c where FMUs are not run: in the binary of an FMU, and in the page that
// simulates.
#include "systems/bases/base.h"

static ld_status build(base_system *self, ld_error *error)
{
    (void)self;
    return ld_fail(error, LD_ERR_INPUT,
                   "base.kind: fmu: only the command and the library run an FMU");
}

static void release(base_system *self)
{
    (void)self;
}

const base_interface base_fmu = {.build = build, .free = release};
