// What a process that runs an FMU and the one that asks it say to each other, over a socket: a
// request, then its answer. Both are of one build on one machine: structs go as they are. Memory
// that both share reports, whatever has become of the FMU, which of its functions was called last
// and what it said last.
#ifndef LD_FOREIGN_PROTOCOL_H
#define LD_FOREIGN_PROTOCOL_H

#include <stdbool.h>
#include <stdint.h>

#include "foreign/description.h"

// The descriptors that the FMU's process finds open.
enum { FOREIGN_SOCKET = 3, FOREIGN_SHARED = 4 };

enum { FOREIGN_MOST_VALUES = 4096, FOREIGN_LONGEST_SAID = 400, FOREIGN_LONGEST_PATH = 4096 };

typedef struct foreign_shared {
    char function[64];               // of the FMU, called last
    char said[FOREIGN_LONGEST_SAID]; // its logger's last message
    _Atomic bool deaf;               // the socket is closed on its side
} foreign_shared;

typedef enum foreign_kind {
    FOREIGN_OPEN,     // foreign_opening; loads and instantiates
    FOREIGN_ENTER,    // double start; initialization mode
    FOREIGN_SET,      // foreign_value[]
    FOREIGN_SET_TEXT, // uint32_t reference, the text with its zero
    FOREIGN_GET,      // foreign_value[]; answers double[]
    FOREIGN_LEAVE,    // initialization mode
    FOREIGN_STEP, // foreign_stepping, foreign_value[] set before, then got; answers as much of a
                  // foreign_step_answer as there are outputs
    FOREIGN_SAVE, // answers bytes
    FOREIGN_LOAD, // bytes
    FOREIGN_END,  // terminates and frees
} foreign_kind;

typedef struct foreign_request {
    uint64_t size; // of what follows
    int32_t kind;
} foreign_request;

typedef enum foreign_result {
    FOREIGN_DONE,
    FOREIGN_REFUSED, // a function answered with an error
    FOREIGN_ENDS,    // the FMU asks for the simulation's end
    FOREIGN_NO_STEP, // it takes no step, however short
    FOREIGN_MISSING, // `said` says what cannot be loaded
    FOREIGN_BAD,     // no such request
} foreign_result;

typedef struct foreign_answer {
    uint64_t size;
    int32_t result;
} foreign_answer;

typedef struct foreign_opening {
    int32_t version;
    bool keeps_state;
    char library[FOREIGN_LONGEST_PATH], resources[FOREIGN_LONGEST_PATH];
    char folder[FOREIGN_LONGEST_PATH]; // to be removed when the asking process has died
    char token[1024], identifier[256];
} foreign_opening;

// A variable, and its value where it is set. Of an array all elements follow each other.
typedef struct foreign_value {
    uint32_t reference;
    int32_t type;       // foreign_type
    double value, rate; // `rate`: [1/s] of an input, from where a step begins
    uint64_t elements;  // of an array, how many; 0: it is none
} foreign_value;

typedef struct foreign_stepping {
    double t, size;           // [s]
    uint32_t inputs, outputs; // how many values follow
    bool with_rates;          // of the inputs (FMI 2)
} foreign_stepping;

typedef struct foreign_step_answer {
    int64_t pieces; // that it took the step in
    double number[FOREIGN_MOST_VALUES];
} foreign_step_answer;

#endif
