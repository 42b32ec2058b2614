// The program that runs FMUs of other people's, as bytes.
#include "foreign/host_inside.h"

__asm__(".section .rodata\n.balign 16\n.globl host_binary\nhost_binary:\n.incbin \"" LD_HOST_BINARY
        "\"\n.globl host_binary_end\nhost_binary_end:\n.byte 0\n.previous\n");
