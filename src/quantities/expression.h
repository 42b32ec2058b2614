// Expressions of named numbers: read once, with their units checked, into a row of operations that
// is computed as often as it is asked for. Nothing is allocated; length and depth are limited.
// expression_read.c reads, expression.c computes.
#ifndef LD_QUANTITIES_EXPRESSION_H
#define LD_QUANTITIES_EXPRESSION_H

#include <stdbool.h>

#include "model/blocks/limits.h"
#include "model/blocks/measure.h"
#include "model/units.h"

enum {
    EXPRESSION_MOST_TEXT = 400, // characters
    EXPRESSION_MOST_DEPTH = 16, // of parentheses
    EXPRESSION_STACK = 64,
    EXPRESSION_MOST_OPERATIONS = 600, // of all expressions of a model
    EXPRESSION_WHY = 320
};

typedef enum operation_kind {
    DO_NUMBER,
    DO_OPERAND,
    DO_PASS, // operations of a window: they are computed step by step
    DO_ADD,
    DO_SUBTRACT,
    DO_MULTIPLY,
    DO_DIVIDE,
    DO_POWER,
    DO_LESS,
    DO_LESS_EQUAL,
    DO_GREATER,
    DO_GREATER_EQUAL,
    DO_NEGATE,
    DO_ABS,
    DO_SQRT,
    DO_SIN,
    DO_COS,
    DO_TAN,
    DO_ASIN,
    DO_ACOS,
    DO_ATAN,
    DO_ATAN2,
    DO_HYPOT,
    DO_MIN,
    DO_MAX
} operation_kind;

typedef struct expression_operation {
    operation_kind kind;
    int operand;   // its number; operations to pass over
    double number; // a constant, an exponent
} expression_operation;

typedef struct expression_code {
    int count;
    expression_operation operation[EXPRESSION_MOST_OPERATIONS];
} expression_code;

// Some operations that belong together.
typedef struct expression_part {
    int first, count;
} expression_part;

// A figure of a course in time: `take` of the expression `of` from one instant to another; "" where
// they were not given. Of a value both are the same.
typedef struct expression_window {
    ld_take take;
    expression_part of;
    int at; // where it begins in the text
    char from[LD_MAX_QUANTITY], to[LD_MAX_QUANTITY];
} expression_window;

// Whom the names belong to.
typedef struct expression_names {
    // The number of an operand and its unit; -1: there is none. `over_time`: a column, in the
    // window opened last.
    int (*find)(void *self, bool over_time, const char *name, const char **unit);
    // Says why there is none.
    void (*explain)(void *self, bool over_time, const char *name, char why[EXPRESSION_WHY]);
    // A window begins, of which all but `of` is known, and ends: the number of its figure; -1: it
    // is refused, and `why` says why.
    bool (*open)(void *self, const expression_window *window, char why[EXPRESSION_WHY]);
    int (*close)(void *self, const expression_window *window, char why[EXPRESSION_WHY]);
    void *self;
} expression_names;

typedef struct expression_refusal {
    int at; // where in the text, from 0
    char why[EXPRESSION_WHY];
} expression_refusal;

// Reads `text` into the code behind what is there; false: it is refused.
bool expression_read(const char *text, const expression_names *names, expression_code *code,
                     expression_part *part, units_dimension *unit, expression_refusal *refusal);

// Its value, where operands have those of `operand`; NaN where one is missing.
double expression_value(const expression_code *code, expression_part part,
                        double (*operand)(const void *self, int number), const void *self);

#endif
