// What is allowed in place of the last word of a line: verbs, options, their arguments, keys of the
// scenario, results. A line each for the shell: the whole word, a tab and what it is; ":files" and
// ":folders" ask for those of the shell. A word that ends with . = or , continues.
#ifndef LD_CLI_WORDS_COMPLETE_H
#define LD_CLI_WORDS_COMPLETE_H

#include "cli/words/help.h"

// The words after the program's name, the last of which is to be completed.
void complete_begin(int count, char **words);

// Prints a candidate, if it begins as that word.
void complete_offer(const char *word, const char *about);

// Prints the candidates of a command with its options.
void complete_print(const command *self, const command_option *options);

#endif
