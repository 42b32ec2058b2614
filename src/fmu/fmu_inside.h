// What every FMU holds, built into programs and library: the binary, the notices of what is in it;
// the binary for Windows, empty where it was not built (LD_WIN64 of CMakeLists.txt).
#ifndef LD_FMU_FMU_INSIDE_H
#define LD_FMU_FMU_INSIDE_H

extern const unsigned char fmu_binary[], fmu_binary_end[];
extern const unsigned char fmu_windows[], fmu_windows_end[];
extern const unsigned char fmu_notices[], fmu_notices_end[];

#endif
