// The sweep for any processor.
#define SWEEP_NAME sweep_default
#include "systems/multibody/sweep_code.h"
