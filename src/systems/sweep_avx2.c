// The sweep once more, compiled with four v4d to a register; chosen where the processor has them.
#define SWEEP_NAME sweep_avx2
#include "systems/sweep.c"
