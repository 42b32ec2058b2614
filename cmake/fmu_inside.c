// What every FMU holds, as bytes: its binary and the notices of what is in it.
#include "fmu/fmu_inside.h"

#define INSIDE(name, file)                                                                         \
    __asm__(".section .rodata\n.balign 16\n.globl " #name "\n" #name ":\n.incbin \"" file          \
            "\"\n.globl " #name "_end\n" #name "_end:\n.byte 0\n.previous\n")

INSIDE(fmu_binary, LD_FMU_BINARY);
INSIDE(fmu_notices, LD_FMU_LICENSE "\"\n.incbin \"" LD_FMU_NOTICES);
