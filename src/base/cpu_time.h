// CPU time.
#ifndef LD_BASE_CPU_TIME_H
#define LD_BASE_CPU_TIME_H

// That of the process so far [s].
double cpu_time_now(void);

#endif
