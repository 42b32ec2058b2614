// The variables of an FMU: what its description lists, and what its instances find by the same
// value references.
#ifndef LD_FMU_FMU_VARIABLES_H
#define LD_FMU_FMU_VARIABLES_H

#include <stdbool.h>
#include <stddef.h>

#include "fmu/fmu_part.h"

// In the order in which they are counted.
typedef enum fmu_group {
    FMU_TIME,       // independent
    FMU_PART_INPUT, // inputs: what it receives from another FMU (fmu_runner.h)
    FMU_IGNITE,     // input: becomes true, and the waiting rocket is ignited
    FMU_WAIT,       // parameter: no rocket is ignited but by the input
    FMU_NUMBER,     // parameters: keys of the scenario
    FMU_TEXT,
    FMU_PART_OUTPUT, // outputs: what it sends to another FMU
    FMU_COLUMN,      // columns of the history
    FMU_RESULT,      // numbers of the rockets' summary, NaN until they are known
    FMU_STATE,       // of model exchange: the continuous states, their rates in the same order
    FMU_RATE,
    FMU_INDICATOR, // what goes through zero at events
} fmu_group;

typedef enum fmu_type { FMU_REAL, FMU_BOOLEAN, FMU_INTEGER, FMU_STRING } fmu_type;

typedef struct fmu_variable {
    fmu_group group;
    bool whole;         // a number that counts
    unsigned reference; // value reference: follows from the name alone, below 2^31
    unsigned array;     // that of the array which begins with it, likewise
    int index;          // in its group, from 0
    char *name;         // "input.base.position.x", "scenario.rocket.mass", "tip.y"
    char *unit;         // SI; "" without
    char *description;  // one line
    double nominal;     // of states
    double start;       // of numbers and of what is true (1) or false (0); NaN: calculated
    char *text;         // start of texts; NULL
} fmu_variable;

typedef struct fmu_variables {
    size_t count, capacity;
    fmu_variable *item;
    size_t *order; // places in `item`, by value references that rise
    size_t array_count;
    size_t *array_order; // likewise of those with which arrays begin
    double start;        // [s] of the run's clock
    double stop;         // when the launch is over, rounded up; NaN: not known, as inside of an FMU
    const fmu_runner *runner;
    bool exchange; // it is one for model exchange, too
} fmu_variables;

// Those of a part, and of a simulation of the model that is its. fmu_variables_free() is due in any
// case. Returns LD_OK, LD_ERR_MEMORY, LD_ERR_INPUT (a flight alone), or why no run of it begins.
ld_status fmu_variables_make(const fmu_part *part, const ld_model *model,
                             const ld_simulation *simulation, fmu_variables *self, ld_error *error);
void fmu_variables_free(fmu_variables *self);

void fmu_variable_free(fmu_variable *self);

// Gives them their value references: the same name has the same one in every FMU. Where two names
// of one FMU have the same, the latter takes the next that is free. False: no memory.
bool fmu_variables_refer(fmu_variables *self);
// The place of that value reference; `count`: there is none.
size_t fmu_variables_find(const fmu_variables *self, unsigned reference);

// Numbers that stand behind each other and whose names end in x, y, z or in 0 to 3 are an array,
// too, in FMI 3.0: its name is what is before the end, its value reference that of the name.
enum { FMU_LONGEST_ARRAY = 4, FMU_ARRAY_NAME = 256 };
// How many elements the array has that begins at that place; 1: none does.
size_t fmu_array_length(const fmu_variables *self, size_t place);
void fmu_array_name(const fmu_variable *first, char name[FMU_ARRAY_NAME]);
// The place of its first element; `count`: there is no such array.
size_t fmu_variables_find_array(const fmu_variables *self, unsigned reference);

fmu_type fmu_type_of(const fmu_variable *variable);
bool fmu_is_input(const fmu_variable *variable);
bool fmu_is_parameter(const fmu_variable *variable);
bool fmu_is_output(const fmu_variable *variable);
// Seen from outside alone, of model exchange.
bool fmu_is_local(const fmu_variable *variable);
// The place of a group's first variable; how many it has.
size_t fmu_group_begin(const fmu_variables *self, fmu_group group);
size_t fmu_group_count(const fmu_variables *self, fmu_group group);

// The key's path of a parameter that is one.
const char *fmu_key_of(const fmu_variable *variable);

// What an FMU's resources hold: the scenario that was understood, all in SI.
#define FMU_SCENARIO_FILE "scenario.yaml"

enum { FMU_TOKEN_SIZE = 48 };

// The token of the FMU of a part of a scenario: that of this version of the program, of the
// scenario's text and of the part.
void fmu_token(const char *scenario, size_t length, ld_fmu_part part, char token[FMU_TOKEN_SIZE]);

#endif
