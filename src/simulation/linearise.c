#include "simulation/simulation.h"

int ld_simulation_tube_modes(const ld_simulation *simulation, ld_mode *modes, int capacity)
{
    (void)simulation, (void)modes, (void)capacity;
    return 0;
}
