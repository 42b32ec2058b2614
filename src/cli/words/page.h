// Manual pages, in roff for man(1), of what --help reports.
#ifndef LD_CLI_WORDS_PAGE_H
#define LD_CLI_WORDS_PAGE_H

#include "cli/words/help.h"

// Prints the page of a command.
void page_print(const command *self, const command_option *options);

// Prints launchdyn(1), of all commands up to one without a name.
void page_print_all(const command *commands);

#endif
