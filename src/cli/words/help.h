// What is reported of a command: as --help prints it, or in another form made of the same.
#ifndef LD_CLI_WORDS_HELP_H
#define LD_CLI_WORDS_HELP_H

#include <stdbool.h>

#include "cli/words/options.h"

enum { COMMAND_WORDS = -1, COMMAND_ANY = -2 }; // one word or more; any number of them

// One command: a row of the table in main.c.
typedef struct command command;
struct command {
    const char *name;
    const char *program;   // whose command it is; NULL: launchdyn
    const char *arguments; // e.g. "FILE"; forms with " | " between
    int words;             // that it takes besides options
    const char *summary;   // one line
    const char *about;     // what --help and the page say besides; NULL: nothing
    const char *examples;  // lines "command|what it does"; NULL: none
    void (*more)(void);    // prints what follows `about`, as it is; NULL: nothing
    int (*run)(const command *self, int argc, char **argv);
    bool in_child; // it reads or writes files by libraries that may crash on it; it has a page
};

// "launchdyn run", "launchdyn-mpi study": how it is called.
enum { HELP_CALL = 64 };
const char *help_call(const command *self, char text[HELP_CALL]);

// Prints the help of a command with its options.
typedef void help_printer(const command *self, const command_option *options);
help_printer help_print;

// From now on help_print() does what this one does: page_print(), complete_print().
void help_choose(help_printer *print);

#endif
