// An FMU in a process of its own: what it does wrong ends that process alone, and is one sentence
// here, with the function and the time.
#ifndef LD_FOREIGN_PROCESS_H
#define LD_FOREIGN_PROCESS_H

#include "foreign/protocol.h"

typedef struct foreign_process foreign_process;

// Starts one; `name` of the FMU, in sentences, must outlive it; [s] longest that it may take to
// answer.
ld_status foreign_process_start(const char *name, double limit, foreign_process **out,
                                ld_error *error);
// Asks: body in two parts, of which the second may be NULL, and waits for the answer, which has at
// most `room` bytes; `t` [s] is for the sentence. After a failure it can only be ended.
ld_status foreign_process_ask(foreign_process *self, foreign_kind kind, double t, const void *body,
                              size_t size, const void *more, size_t more_size, void *answer,
                              size_t room, size_t *answered, ld_error *error);
// Ends it, after the FMU has been let end where it does so in good time; may be NULL.
void foreign_process_end(foreign_process *self);

#endif
