// What every FMU holds, built into programs and library: the binary, the notices of what is in it.
#ifndef LD_FMU_FMU_INSIDE_H
#define LD_FMU_FMU_INSIDE_H

extern const unsigned char fmu_binary[], fmu_binary_end[];
extern const unsigned char fmu_notices[], fmu_notices_end[];

#endif
