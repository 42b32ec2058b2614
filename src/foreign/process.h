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
// What it is asked for: a body in up to two parts; `t` [s] is for the sentence of a failure.
typedef struct foreign_question {
    foreign_kind kind;
    double t;
    const void *body[2];
    size_t size[2];
} foreign_question;

// Room for what it answers, and how much that is.
typedef struct foreign_reply {
    void *bytes;
    size_t room, size;
} foreign_reply;

// Asks and waits for the answer. After a failure it can only be ended.
ld_status foreign_process_ask(foreign_process *self, const foreign_question *question,
                              foreign_reply *reply, ld_error *error);
// Ends it, after the FMU has been let end where it does so in good time; may be NULL.
void foreign_process_end(foreign_process *self);

#endif
