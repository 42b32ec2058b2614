// The sweep for processors with four lanes to a register.
#define SWEEP_NAME sweep_avx
#include "systems/multibody/sweep_code.h"
