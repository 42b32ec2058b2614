// The sweep for any processor.
#define SWEEP_NAME sweep_default
#include "systems/sweep_code.h"
