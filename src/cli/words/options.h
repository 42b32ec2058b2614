// The options of a command: a table of them, what it reads, what --help says of it.
#ifndef LD_CLI_WORDS_OPTIONS_H
#define LD_CLI_WORDS_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

#include "launchdyn/status.h"

typedef enum option_kind {
    OPTION_FLAG,    // an int, which becomes 1
    OPTION_TEXT,    // a char *
    OPTION_TEXTS,   // a char **, NULL at first: one more each time it is given, and then NULL
    OPTION_INTEGER, // an int
    OPTION_HELP,    // nothing: what is asked for is help
    // a double in this unit, given with a unit or without
    OPTION_METRES,
    OPTION_MILLIMETRES,
    OPTION_MILLISECONDS,
    OPTION_HERTZ,
    OPTION_NUMBER, // "1"
    OPTION_WORD    // one of the words of `argument`, "one|other", or without it ""
} option_kind;

// A row of the table; one without a name ends it.
typedef struct command_option {
    const char *name;
    char letter; // '\0': none
    option_kind kind;
    void *value;
    const char *help, *argument; // argument NULL: it has none
} command_option;

enum { MOST_OPTIONS = 24, MOST_TEXTS = 6 }; // of a table; of kind OPTION_TEXTS

// What stands on the command line beside the options.
typedef struct command_line {
    const char *const *word;
    size_t count;
    bool help;                // it was asked for: what stands after that was not read
    char **texts[MOST_TEXTS]; // of OPTION_TEXTS
} command_line;

// Reads the words after the first one: options into their values, the others in their order into
// `line`, which keeps them in argv. Values are parts of argv. options_end() is due in any case.
// Returns LD_OK, LD_ERR_INPUT, LD_ERR_MEMORY.
ld_status options_read(command_line *line, int argc, char **argv, const command_option *options,
                       ld_error *error);
void options_end(command_line *line);

// Whether the text is a word that an option of kind OPTION_WORD takes.
bool option_has_word(const command_option *option, const char *text);

// Prints text from a column on, broken at blanks before column 79, and ends the line.
void print_wrapped(const char *text, int column);

// Prints a line or more for each option.
void options_print(const command_option *options);

#endif
