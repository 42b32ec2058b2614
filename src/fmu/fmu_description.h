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
} fmu_description;

// Writes it; what fails shows in the stream's error.
void fmu_description_write(const fmu_description *self, FILE *stream);

// A text as it stands in XML.
void fmu_write_text(FILE *stream, const char *text);
// Start, stop and tolerance as attributes; NaN is left out.
void fmu_write_experiment(FILE *stream, double start, double stop, double tolerance);

#endif
