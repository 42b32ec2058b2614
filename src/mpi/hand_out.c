// A follower sends the record of the sample that it has run (an empty one at first) and gets the
// number of its next sample; 0: no more, it is dismissed. So each message has one answer, which
// comes before the message where the study stops while a sample runs.
#include "mpi/hand_out.h"

#include <mpi.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "cli/command.h"
#include "studies/run/ledger.h"
#include "studies/run/worker.h"

enum { TAG_RECORD = 1, TAG_NUMBER = 2, DISMISSED = 0 };

// Waiting without keeping a core busy: the longer it has lasted, the longer the next pause.
typedef struct patience {
    double since; // [s]
} patience;

static void pause_a_little(const patience *self)
{
    const double least = 20e-6, most = 1e-3; // [s]
    double pause = 0.05 * (MPI_Wtime() - self->since);
    pause = pause < least ? least : pause > most ? most : pause;
    nanosleep(&(struct timespec){.tv_nsec = (long)(pause * 1e9)}, NULL);
}

// ---- the first process

typedef enum follower_state { RUNNING, ASKING, SENT_HOME, GONE } follower_state;

typedef struct leader {
    study_ledger *ledger;
    int processes;
    follower_state *state; // [processes], of all but the first
    study_record *record;  // the message that came last
    size_t record_size;
} leader;

static void answer_follower(leader *self, int follower, int64_t number, follower_state next)
{
    MPI_Send(&number, 1, MPI_INT64_T, follower, TAG_NUMBER, MPI_COMM_WORLD);
    self->state[follower] = next;
}

// Takes in and keeps what has come; returns how many messages there were.
static int receive_records(leader *self)
{
    int received = 0;
    for (;;) {
        MPI_Status about;
        int there;
        MPI_Iprobe(MPI_ANY_SOURCE, TAG_RECORD, MPI_COMM_WORLD, &there, &about);
        if (!there)
            return received;
        int from = about.MPI_SOURCE;
        MPI_Recv(self->record, (int)self->record_size, MPI_BYTE, from, TAG_RECORD, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
        self->state[from] = self->state[from] == SENT_HOME ? GONE : ASKING;
        if (self->record->number > 0 || self->record->outcome)
            ledger_keep(self->ledger, self->record);
        received++;
    }
}

// Answers those who ask; where the study stops, everybody.
static void answer_all(leader *self)
{
    for (int i = 1; i < self->processes; i++) {
        if (self->state[i] == ASKING) {
            int64_t number = ledger_next(self->ledger);
            if (number != SAMPLE_WAIT)
                answer_follower(self, i, number, number == DISMISSED ? GONE : RUNNING);
        } else if (self->state[i] == RUNNING && !ledger_continues(self->ledger)) {
            answer_follower(self, i, DISMISSED, SENT_HOME);
        }
    }
}

static bool all_are_gone(const leader *self)
{
    for (int i = 1; i < self->processes; i++)
        if (self->state[i] != GONE)
            return false;
    return true;
}

static void serve_followers(leader *self)
{
    patience waiting = {MPI_Wtime()};
    while (!all_are_gone(self)) {
        if (receive_records(self) > 0)
            waiting.since = MPI_Wtime();
        else
            pause_a_little(&waiting);
        answer_all(self);
    }
}

ld_status mpi_study_lead(const ld_study *study, const char *folder, const ld_study_options *options,
                         ld_study_counts *counts, ld_error *error)
{
    study_ledger ledger;
    pthread_t worker;
    leader all = {.ledger = &ledger, .record_size = record_size(&study->shape)};
    MPI_Comm_size(MPI_COMM_WORLD, &all.processes);
    all.state = calloc((size_t)all.processes, sizeof *all.state);
    all.record = calloc(1, all.record_size);
    if (!all.state || !all.record) {
        fputs("launchdyn-mpi: no memory for the records of samples\n", stderr);
        MPI_Abort(MPI_COMM_WORLD, EXIT_SYSTEM);
    }
    const store_place place = {.folder = folder, .journal = STORE_ROLLBACK};
    ledger_open(&ledger, study, &place, options, counts, error);
    const sample_source source = ledger_source(&ledger);
    // MPI is this thread's; alone, or without a second one, it runs samples after it has served
    bool second = all.processes > 1 && worker_start(&worker, &source) == 0;
    serve_followers(&all);
    if (second)
        pthread_join(worker, NULL);
    worker_run_all(&source);
    free(all.state);
    free(all.record);
    return ledger_close(&ledger);
}

// ---- every other process

static bool is_answered(void)
{
    int there;
    MPI_Iprobe(0, TAG_NUMBER, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
    return there;
}

typedef struct follower {
    bool (*go_on)(void *);
    void *self;
    double looked; // [s] when for a message
    bool sent_home;
} follower;

// Whether the sample that runs is still requested.
static bool is_wanted(void *argument)
{
    const double often = 0.02; // [s]
    follower *self = argument;
    double now = MPI_Wtime();
    if (now - self->looked > often) {
        self->sent_home = is_answered();
        self->looked = now;
    }
    return !self->sent_home && self->go_on(self->self);
}

// Sends a record and waits for the number that answers it.
static int64_t send_record(const study_record *record)
{
    int64_t number;
    MPI_Send(record, (int)record_size(&record->shape), MPI_BYTE, 0, TAG_RECORD, MPI_COMM_WORLD);
    patience waiting = {MPI_Wtime()};
    while (!is_answered())
        pause_a_little(&waiting);
    MPI_Recv(&number, 1, MPI_INT64_T, 0, TAG_NUMBER, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return number;
}

void mpi_study_follow(const ld_study *study, bool (*go_on)(void *), void *self)
{
    follower of = {.go_on = go_on, .self = self};
    study_worker worker;
    ld_error error;
    ld_status status = worker_create(&worker, study, &error);
    if (status) {
        study_record failed = {.outcome = status};
        snprintf(failed.reason, sizeof failed.reason, "%s", error.text);
        while (send_record(&failed) != DISMISSED)
            ;
        return;
    }
    for (int64_t number; (number = send_record(worker.record)) != DISMISSED;)
        worker_run(&worker, number, is_wanted, &of);
    worker_free(&worker);
}
