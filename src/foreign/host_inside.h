// The program that runs FMUs of other people's, built into programs and library.
#ifndef LD_FOREIGN_HOST_INSIDE_H
#define LD_FOREIGN_HOST_INSIDE_H

extern const unsigned char host_binary[], host_binary_end[];

#endif
