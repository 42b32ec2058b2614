// What is known of this program.
#ifndef LD_RESULTS_PROGRAM_H
#define LD_RESULTS_PROGRAM_H

// The state of the sources as git describes it, of the file that a build makes; "unknown" where
// they are not a checkout.
extern const char program_commit[];

// Hands out names and texts, version first, libraries last; they are to be copied.
typedef void program_fact(void *self, const char *name, const char *text);
void program_describe(program_fact *take, void *self);

#endif
