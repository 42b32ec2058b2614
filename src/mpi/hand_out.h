// A study on the processes of MPI: the first hands out numbers of samples and keeps the records
// that come back, all run samples.
#ifndef LD_MPI_HAND_OUT_H
#define LD_MPI_HAND_OUT_H

#include "launchdyn/study.h"

// The first process, like ld_study_run(); `options` are the folder's and the user's, shards and
// threads are not checked. One thread serves the others, another runs samples.
ld_status mpi_study_lead(const ld_study *study, const char *folder, const ld_study_options *options,
                         ld_study_counts *counts, ld_error *error);

// Every other process: runs samples until the first one has no more, or go_on() says false, which
// stops the whole study.
void mpi_study_follow(const ld_study *study, bool (*go_on)(void *), void *self);

#endif
