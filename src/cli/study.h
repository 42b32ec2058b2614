// What the commands share that run a study.
#ifndef LD_CLI_STUDY_H
#define LD_CLI_STUDY_H

#include <limits.h>

#include "cli/run.h"
#include "launchdyn/study.h"

enum { ALL_SAMPLES = INT_MIN };

typedef struct study_wishes {
    run_wishes run; // overrides, folder
    int threads;
    int only; // sample, or ALL_SAMPLES
    int shard, shards;
    int join, expiry; // shared with other processes; [s] after which one has lost its ranges
    ld_study_view view;
    char *over, *and_over, *statistic; // keys of the sweep, of a picture its statistic
    int map;
    char keys[1024];              // both keys, with a comma between
    char *csv, *hdf5, *footprint; // files to be written
} study_wishes;

// The options that they share; overrides and folder are those of `wishes`.
#define STUDY_OPTIONS(wishes)                                                                      \
    COMMAND_SETS(&(wishes)->run.sets),                                                             \
        {"out",                                                                                    \
         'o',                                                                                      \
         OPTION_TEXT,                                                                              \
         &(wishes)->run.folder,                                                                    \
         "Folder of the study; for plot: picture FILE.svg, .pdf or .png",                          \
         "DIR"},                                                                                   \
        COMMAND_STRICT(&(wishes)->run.strict)

// The index that a word of --sensitivity names: total, first, morris; NULL and others: the usual.
ld_index study_index_of(const char *word);
// Reads a file by `sets`, with the plan for an index but the usual, and frees what it makes for it.
ld_status study_read_planned(const char *file, char **sets, ld_index index, ld_study **study);

// Prints warnings on all points of the study (command_take_notes()).
int study_take_notes(const ld_study *study, const study_wishes *wishes);

// ld_study_run(), or another that does the same.
typedef ld_status study_runner(const ld_study *study, const char *folder,
                               const ld_study_options *options, ld_study_counts *counts,
                               ld_error *error);

// Runs the study by `run` with a progress line, and prints what the folder then holds. Returns the
// exit code.
int study_run_all(const ld_study *study, const study_wishes *wishes, study_runner *run);

#endif
