// A follower asks for so many samples as it may have at once and, where those are short, for as
// many ahead; the record of each that it has run asks for another one. So each message has one
// answer, a number; 0: no more. One message more comes to each follower: that it may go, or, before
// its answers, that the study stops.
#include "mpi/hand_out.h"

#include <mpi.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cli/command.h"
#include "flight/flight_lanes.h"
#include "studies/run/ledger.h"
#include "studies/run/worker.h"

enum { TAG_RECORD = 1, TAG_NUMBER = 2, TAG_GO = 3, NO_MORE = 0 };

// Messages with which a follower begins.
static int first_messages(const ld_study *study)
{
    int at_once = worker_samples_at_once(study);
    return at_once > 1 ? 2 * at_once : 1;
}

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

// What the first process knows of another one.
typedef struct follower_state {
    int coming;  // messages with which it begins
    int asks;    // messages without an answer
    int running; // samples whose records have not come
    bool told, gone;
} follower_state;

typedef struct leader {
    study_ledger *ledger;
    int processes;
    follower_state *state; // [processes], of all but the first
    study_record *record;  // the message that came last
    size_t record_size;
} leader;

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
        follower_state *from = &self->state[about.MPI_SOURCE];
        MPI_Recv(self->record, (int)self->record_size, MPI_BYTE, about.MPI_SOURCE, TAG_RECORD,
                 MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        bool ran = self->record->number > 0;
        from->asks++;
        from->running -= ran;
        from->coming -= !ran;
        if (ran)
            ledger_keep(self->ledger, self->record);
        received++;
    }
}

static void answer_follower(leader *self, int follower)
{
    follower_state *one = &self->state[follower];
    int64_t number;
    while (one->asks > 0 && (number = ledger_next(self->ledger)) != SAMPLE_WAIT) {
        MPI_Send(&number, 1, MPI_INT64_T, follower, TAG_NUMBER, MPI_COMM_WORLD);
        one->asks--;
        one->running += number != NO_MORE;
    }
    one->gone = one->coming + one->asks + one->running == 0;
    if (!one->told && (one->gone || !ledger_continues(self->ledger))) {
        MPI_Send(NULL, 0, MPI_BYTE, follower, TAG_GO, MPI_COMM_WORLD);
        one->told = true;
    }
}

static bool all_are_gone(const leader *self)
{
    for (int i = 1; i < self->processes; i++)
        if (!self->state[i].gone)
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
        for (int i = 1; i < self->processes; i++)
            if (!self->state[i].gone)
                answer_follower(self, i);
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
    for (int i = 1; i < all.processes; i++)
        all.state[i].coming = first_messages(study);
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

typedef struct follower {
    bool (*go_on)(void *);
    void *self;
    double looked, asked; // [s] when for a message, for numbers: each look may yield the processor
    bool goes;            // was told that it may
    int unanswered, running;
    int64_t number[2 * FLIGHT_MOST_LANES]; // of samples to be run
    int numbers;
    study_record *handed_back; // what is said of a sample that it does not run
} follower;

static bool is_there(int tag)
{
    int there;
    MPI_Iprobe(0, tag, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
    return there;
}

static void send_record(follower *self, const study_record *record)
{
    MPI_Send(record, (int)record_size(&record->shape), MPI_BYTE, 0, TAG_RECORD, MPI_COMM_WORLD);
    self->unanswered++;
}

static void take_answers(follower *self)
{
    while (is_there(TAG_NUMBER)) {
        int64_t number;
        MPI_Recv(&number, 1, MPI_INT64_T, 0, TAG_NUMBER, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        self->unanswered--;
        if (number != NO_MORE)
            self->number[self->numbers++] = number;
    }
}

static void leave(follower *self)
{
    MPI_Recv(NULL, 0, MPI_BYTE, 0, TAG_GO, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    self->goes = true;
}

// Whether the samples that run are still requested.
static bool is_wanted(void *argument)
{
    const double often = 0.02; // [s]
    follower *self = argument;
    double now = MPI_Wtime();
    if (now - self->looked > often) {
        if (!self->goes && is_there(TAG_GO))
            leave(self);
        self->looked = now;
    }
    return !self->goes && self->go_on(self->self);
}

// The oldest number that has come. Waits for one only where no sample runs, on whose record the
// first process may wait.
static int64_t next_number(void *argument)
{
    const double often = 0.2e-3; // [s]
    follower *self = argument;
    patience waiting = {MPI_Wtime()};
    if (self->numbers == 0 && waiting.since - self->asked > often) {
        take_answers(self);
        self->asked = waiting.since;
    }
    while (self->numbers == 0 && self->running == 0 && self->unanswered > 0 && is_wanted(self)) {
        pause_a_little(&waiting);
        take_answers(self);
    }
    if (!is_wanted(self))
        return NO_MORE;
    if (self->numbers == 0)
        return self->unanswered > 0 ? SAMPLE_WAIT : NO_MORE;
    int64_t number = self->number[0];
    self->numbers--;
    memmove(self->number, self->number + 1, (size_t)self->numbers * sizeof number);
    self->running++;
    return number;
}

static void keep_record(void *argument, const study_record *record)
{
    follower *self = argument;
    self->running--;
    send_record(self, record);
}

static void stop(void *argument, ld_status status, const ld_error *error)
{
    study_record *record = ((follower *)argument)->handed_back;
    record->outcome = status;
    snprintf(record->reason, sizeof record->reason, "%s", error->text);
}

// What it was given and does not run goes back.
static void hand_back(follower *self)
{
    patience waiting = {MPI_Wtime()};
    for (;;) {
        take_answers(self);
        if (self->numbers > 0) {
            self->handed_back->number = self->number[--self->numbers];
            send_record(self, self->handed_back);
        } else if (self->unanswered > 0) {
            pause_a_little(&waiting);
        } else {
            return;
        }
    }
}

void mpi_study_follow(const ld_study *study, bool (*go_on)(void *), void *self)
{
    static const study_record none;
    study_record back = {.outcome = LD_ERR_INTERRUPTED};
    follower of = {.go_on = go_on, .self = self, .handed_back = &back};
    const sample_source source = {&of, study, next_number, keep_record, is_wanted, stop};
    for (int i = first_messages(study); i > 0; i--)
        send_record(&of, &none);
    worker_run_all(&source);
    hand_back(&of);
    if (!of.goes)
        leave(&of);
}
