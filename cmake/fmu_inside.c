// What every FMU holds, as bytes: its binary and the notices of what is in it.
#include "fmu/fmu_inside.h"

#define INSIDE(name, file)                                                                         \
    __asm__(".section .rodata\n.balign 16\n.globl " #name "\n" #name ":\n.incbin \"" file          \
            "\"\n.globl " #name "_end\n" #name "_end:\n.byte 0\n.previous\n")

INSIDE(fmu_binary, LD_FMU_BINARY);
#ifdef LD_FMU_WINDOWS
INSIDE(fmu_windows, LD_FMU_WINDOWS);
INSIDE(fmu_notices, LD_FMU_LICENSE "\"\n.incbin \"" LD_FMU_NOTICES "\"\n.incbin \"" LD_FMU_WINDOWS_NOTICES);
#else
__asm__(".section .rodata\n.globl fmu_windows\nfmu_windows:\n.globl fmu_windows_end\nfmu_windows_end:\n.byte 0\n.previous\n");
INSIDE(fmu_notices, LD_FMU_LICENSE "\"\n.incbin \"" LD_FMU_NOTICES);
#endif
