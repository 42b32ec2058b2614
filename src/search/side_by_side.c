#include "search/side_by_side.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "studies/run/worker.h"

typedef struct progress {
    const side_by_side *work;
    atomic_int next, worker;
    atomic_bool stopped;
} progress;

static void *do_tasks(void *user)
{
    progress *self = user;
    const side_by_side *work = self->work;
    int worker = self->worker++, task;
    while (!self->stopped && (task = self->next++) < work->tasks)
        if (!work->run(work->self, worker, task))
            self->stopped = true;
    return NULL;
}

ld_status side_by_side_run(const side_by_side *work, ld_error *error)
{
    progress self = {.work = work};
    int most = work->threads < work->tasks ? work->threads : work->tasks;
    int others = most > 1 ? most - 1 : 0, started = 0, problem = 0;
    pthread_t *thread = calloc((size_t)others + 1, sizeof *thread);
    if (!thread)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for threads");
    while (!problem && started < others) {
        problem = worker_start_thread(&thread[started], do_tasks, &self);
        started += !problem;
    }
    ld_status status = LD_OK;
    if (problem) {
        status = ld_fail(error, LD_ERR_MISSING, "cannot start thread %d of %d: %s", started + 2,
                         work->threads, strerror(problem));
        self.stopped = true;
    }
    do_tasks(&self);
    while (started > 0)
        pthread_join(thread[--started], NULL);
    free(thread);
    return status;
}
