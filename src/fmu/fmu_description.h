// modelDescription.xml of an FMU, for FMI 2.0 and 3.0.
#ifndef LD_FMU_FMU_DESCRIPTION_H
#define LD_FMU_FMU_DESCRIPTION_H

#include <stdio.h>

#include "fmu/fmu_variables.h"

typedef struct fmu_description {
    int version; // of FMI: 2 or 3
    const char *title, *token;
    const char *identifier;        // the name of the binary in the FMU
    double start, stop, tolerance; // [s], when the launch is over, NaN: not known; of the run
    const fmu_variables *variables;
    bool arrays; // vectors are one variable each, in FMI 3
} fmu_description;

// Writes it; what fails shows in the stream's error.
void fmu_description_write(const fmu_description *self, FILE *stream);

// How many of the variables at that place and behind it are listed as one.
size_t fmu_listed_length(const fmu_description *self, size_t place);
// What they are listed by, where they are several: name, meaning.
void fmu_write_array_name(FILE *stream, const fmu_variable *first);
void fmu_write_array_meaning(FILE *stream, const fmu_variable *first, size_t length);

// A text as it stands in XML.
void fmu_write_text(FILE *stream, const char *text);
// Start, stop and tolerance as attributes; NaN is left out.
void fmu_write_experiment(FILE *stream, double start, double stop, double tolerance);

#endif
