// The description of an FMU, modelDescription.xml (FMI 2.0.4 sections 2.2 and 4.3, FMI 3.0.2
// sections 2.4 and 4.4), as far as whoever steps it for co-simulation needs it. Read by expat from
// a text that is not trusted.
#ifndef LD_FOREIGN_DESCRIPTION_H
#define LD_FOREIGN_DESCRIPTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "launchdyn/status.h"

// In the order of FMI 3; FMI 2 has Real (FLOAT64), Integer (INT32), Boolean, String, Enumeration.
typedef enum foreign_type {
    FOREIGN_FLOAT64,
    FOREIGN_FLOAT32,
    FOREIGN_INT8,
    FOREIGN_UINT8,
    FOREIGN_INT16,
    FOREIGN_UINT16,
    FOREIGN_INT32,
    FOREIGN_UINT32,
    FOREIGN_INT64,
    FOREIGN_UINT64,
    FOREIGN_BOOLEAN,
    FOREIGN_ENUMERATION,
    FOREIGN_STRING,
    FOREIGN_BINARY,
    FOREIGN_CLOCK,
    FOREIGN_TYPES
} foreign_type;

typedef enum foreign_causality {
    FOREIGN_LOCAL, // the default
    FOREIGN_PARAMETER,
    FOREIGN_CALCULATED_PARAMETER,
    FOREIGN_STRUCTURAL_PARAMETER,
    FOREIGN_INPUT,
    FOREIGN_OUTPUT,
    FOREIGN_INDEPENDENT,
    FOREIGN_DEPENDENT,
    FOREIGN_CAUSALITIES
} foreign_causality;

typedef enum foreign_variability {
    FOREIGN_CONSTANT,
    FOREIGN_FIXED,
    FOREIGN_TUNABLE,
    FOREIGN_DISCRETE,
    FOREIGN_CONTINUOUS, // the default of floats
    FOREIGN_VARIABILITIES
} foreign_variability;

// A unit by its powers of the base units: value in them = factor value + offset.
enum { FOREIGN_BASE_UNITS = 8 }; // kg, m, s, A, K, mol, cd, rad
typedef struct foreign_unit {
    char *name;
    bool described; // by base units
    int power[FOREIGN_BASE_UNITS];
    double factor, offset;
} foreign_unit;

typedef struct foreign_variable {
    char *name;
    uint32_t reference;
    foreign_type type;
    foreign_causality causality;
    foreign_variability variability;
    uint32_t elements; // of an array, as its dimensions' start values say; 0: it is none
    bool has_start;
    double start;             // of a number, where it is there
    char *declared;           // name of its type, or NULL
    char *unit_name;          // its own, or NULL
    const foreign_unit *unit; // described, or NULL
} foreign_variable;

typedef struct foreign_description {
    int version; // of FMI: 2, 3
    char *token; // guid, instantiationToken
    char *model; // its name
    char *identifier;
    bool keeps_state; // can get and set its state
    bool saves_state; // and as bytes
    bool needs_tool;
    bool takes_rates; // of its inputs (FMI 2)
    double step;      // [s] that it steps by alone; 0: by any
    size_t count, unit_count;
    foreign_variable *variable;
    foreign_unit *unit;
} foreign_description;

// Reads the file `path`; `name` stands for it in sentences. Refuses what is no FMU of version 2 or
// 3 for co-simulation, one with clocks, and one whose variables name what is not there.
ld_status foreign_describe(const char *path, const char *name, foreign_description *out,
                           ld_error *error);
// The same of a text.
ld_status foreign_describe_text(const char *text, size_t length, const char *name,
                                foreign_description *out, ld_error *error);
void foreign_description_free(foreign_description *self);

// NULL: there is none.
const foreign_variable *foreign_variable_find(const foreign_description *self, const char *name);
// Of all that have this causality the one whose name is nearest, for "did you mean"; or NULL.
const char *foreign_variable_near(const foreign_description *self, const char *name,
                                  foreign_causality causality);
const char *foreign_causality_name(foreign_causality causality);
const char *foreign_type_name(foreign_type type);

#endif
