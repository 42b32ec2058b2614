#include "base/cpu_time.h"

#include <time.h>

double cpu_time_now(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}
