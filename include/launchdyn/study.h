/// Studies: many samples of a scenario whose numbers are scattered, kept in a folder.
#ifndef LAUNCHDYN_STUDY_H
#define LAUNCHDYN_STUDY_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/origin.h"
#include "launchdyn/scenario.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// A scenario with all points of its sweep. The samples are numbered from 1 round the points:
/// sample s is the sample (s - 1) / points + 1 of point (s - 1) % points + 1.
typedef struct ld_study ld_study;

/// Reads a study, all points of its sweep, as ld_scenario_read() does; messages about a point name
/// it.
/// @param study filled on success (free with ld_study_free())
ld_status ld_study_read(const char *path, const char *const *sets, size_t count, ld_study **study,
                        ld_messages *messages);
ld_status ld_study_read_text(const char *text, size_t length, const char *name, const char *folder,
                             const char *const *sets, size_t count, ld_study **study,
                             ld_messages *messages);
/// From texts that have been read before, as ld_scenario_read_source().
ld_status ld_study_read_source(ld_source *source, ld_study **study, ld_messages *messages);
void ld_study_free(ld_study *study);

/// The scenario's model, of a sweep the nominal one.
const ld_model *ld_study_model(const ld_study *study);

/// How far a study is.
typedef struct ld_study_counts {
    int64_t samples; ///< that the scenario asks for; as soon as its stopping rule holds, those
                     ///< that were enough
    int64_t look;    ///< of a stopping rule: samples after which it is checked; without one 0
    bool enough;     ///< the stopping rule holds
    int64_t done;    ///< that are kept, failed ones included
    int64_t failed;
    int64_t now; ///< of `done`, those of this run
} ld_study_counts;

/// What the caller requires; every member may be NULL or 0.
typedef struct ld_study_options {
    int threads; ///< samples that run side by side; 0: one
    /// Runs only the samples shard, shard + shards, shard + 2 shards, ... into a database of its
    /// own in the folder, for ld_study_merge(); 1 to shards, 0 of 0: all samples.
    int shard, shards;
    void *self;
    /// Called after each sample, never twice at once.
    void (*progress)(void *self, const ld_study_counts *counts);
    /// Called often, from all threads at once; false stops the study, which keeps what it has.
    bool (*go_on)(void *self);
    double expiry; ///< [s] of ld_study_join(): without a sign of life for so long, a process has
                   ///< lost the ranges that it has taken; 0: 60
    const void *reserved[3]; ///< NULL: room for what later versions may be asked
} ld_study_options;

/// Runs the samples of `study` that the folder does not hold yet and keeps each as soon as it is
/// done, in DIR/study.db. A sample that cannot run is kept with its reason. Results are the same to
/// the bit for any number of threads and any interruption.
/// @param counts filled in any case
/// @return LD_OK; LD_ERR_INPUT (nothing varies; the folder holds another scenario's study, or
///         another program works on it), LD_ERR_FILE, LD_ERR_MEMORY, LD_ERR_INTERRUPTED
ld_status ld_study_run(const ld_study *study, const char *folder, const ld_study_options *options,
                       ld_study_counts *counts, ld_error *error);

/// Shares the study with all processes that do the same, on any machines that have the folder,
/// which need nothing else: each takes ranges of samples (at most 4000) and may come, go or be
/// killed at any time. Returns when all samples are kept, whoever ran them: the folder is then that
/// of ld_study_run(), to the bit, also with a stopping rule. Not for shards.
/// @param counts of the whole study; `now`: of this process
/// @return as ld_study_run(); LD_ERR_MISSING, the file system has no hard links
ld_status ld_study_join(const ld_study *study, const char *folder, const ld_study_options *options,
                        ld_study_counts *counts, ld_error *error);

/// The study as bytes, from which a process anywhere reads it without files: the texts that it was
/// read from.
/// @param packed to be freed (ld_free()); NULL on failure
/// @return LD_OK; LD_ERR_INPUT, its model was not read from a scenario; LD_ERR_MEMORY
ld_status ld_study_pack(const ld_study *study, void **packed, size_t *size, ld_error *error);
/// @return as ld_study_read_source(); LD_ERR_INPUT without messages: damaged bytes
ld_status ld_study_unpack(const void *packed, size_t size, ld_study **study, ld_messages *messages);

/// Samples `first` to `last`.
typedef struct ld_study_range {
    int64_t first, last;
} ld_study_range;

/// Runs a range of samples for a study that another process keeps, whatever carries the part there.
/// @param options threads, go_on
/// @param part to be freed (ld_free()); NULL on failure
/// @return LD_OK; LD_ERR_INPUT (nothing varies, no such samples), LD_ERR_MEMORY, LD_ERR_INTERRUPTED
ld_status ld_study_run_range(const ld_study *study, const ld_study_range *range,
                             const ld_study_options *options, void **part, size_t *size,
                             ld_error *error);

/// A study whose ranges run elsewhere: hands them out, and keeps the parts that come back, in any
/// order and also twice. On one thread at a time.
typedef struct ld_study_keeper ld_study_keeper;

/// Opens the folder as ld_study_run(). The study must outlive it.
/// @param keeper to be closed; NULL on failure
ld_status ld_study_keeper_open(const ld_study *study, const char *folder, ld_study_keeper **keeper,
                               ld_error *error);
/// The next of at most 4000 ranges that are not kept; each is handed out once: run again what is
/// lost. false: there is none now; with a stopping rule there may be after the next part.
bool ld_study_keeper_next(ld_study_keeper *keeper, ld_study_range *range);
/// Keeps a part.
/// @return LD_OK; LD_ERR_INPUT (damaged, or of another scenario or version), LD_ERR_FILE,
///         LD_ERR_MEMORY
ld_status ld_study_keeper_put(ld_study_keeper *keeper, const void *part, size_t size,
                              ld_error *error);
void ld_study_keeper_counts(const ld_study_keeper *keeper, ld_study_counts *counts);
/// May be NULL.
/// @return LD_OK, LD_ERR_FILE, LD_ERR_MEMORY
ld_status ld_study_keeper_close(ld_study_keeper *keeper, ld_error *error);

/// Joins what shards have kept in the folder into its study.db and prints what is still missing.
/// Harmless however often, and while shards run; ld_study_run() without a shard then runs the rest.
/// @return LD_OK; LD_ERR_INPUT (no shards, or of different studies, or another program works on
///         study.db), LD_ERR_FILE, LD_ERR_MEMORY
ld_status ld_study_merge(const char *folder, FILE *stream, ld_error *error);

/// Reads where the study in `folder` comes from, as ld_origin_read() of a run. Where several
/// programs have worked on it, what differs between them is there several times.
ld_status ld_study_read_origin(const char *folder, ld_origin *origin, ld_error *error);

/// Sensitivities (docs/study.md), which require samples of a plan.
typedef enum ld_index {
    LD_INDEX_USUAL,  ///< what the plan of the samples gives
    LD_INDEX_TOTAL,  ///< total indices, with first-order ones: plan saltelli
    LD_INDEX_FIRST,  ///< first-order indices: plan saltelli, else shares of a regression
    LD_INDEX_MORRIS, ///< elementary effects: plan morris
} ld_index;

/// What is shown of a study; NULL or zeros: the usual.
typedef struct ld_study_view {
    const char *what;     ///< names of results, with commas between; "all"; NULL: a choice
    bool sensitivity;     ///< how much of the variance each factor explains, instead of statistics
    bool json;            ///< as JSON (docs/command.md), in full precision
    unsigned char index;  ///< an ld_index: the sensitivities shown, and by which they are sorted
    const char *measured; ///< a CSV file of measured launches, beside which its results are shown
                          ///< instead (docs/study.md): differences with intervals and p; NULL: none
    const char *against;  ///< a point of the sweep, by its number or as KEY=VALUE,...: how far the
                          ///< others are from it is shown instead (docs/study.md); NULL: none
    const char *csv;      ///< of `against` and `over`: besides, a CSV file with the same, of
                          ///< `against` alone of every point; NULL: not requested
    const char *over;     ///< one or two swept keys, "base.speed,firing.interval": a row for each
                          ///< of their values is shown instead, pooled over the other keys; NULL:
                          ///< of `against` the keys that it names, else every point
} ld_study_view;

/// Prints counts, failures and statistics of what the folder holds, also while a study runs: point
/// by point of a sweep, and side by side.
/// @return LD_OK; LD_ERR_INPUT (no study there, no such result, wrong measured launches, no such
/// point,
///         nowhere two pairs), LD_ERR_FILE, LD_ERR_MEMORY
ld_status ld_study_show(const char *folder, const ld_study_view *view, FILE *stream,
                        ld_error *error);

/// The same of one statistic, as in ld_study_question, in rows as those of `over`; without `over` a
/// row for each point. NULL: as ld_study_show().
ld_status ld_study_show_statistic(const char *folder, const char *statistic,
                                  const ld_study_view *view, FILE *stream, ld_error *error);

/// What is drawn of a sweep; NULL or zeros: the usual.
typedef struct ld_study_question {
    const char *what;      ///< names of results, with commas between; NULL: a choice
    const char *over;      ///< one or two swept keys, "base.speed,firing.interval"; NULL: the first
    const char *against;   ///< a point, as in ld_study_view: differences from it; NULL: none
    const char *statistic; ///< "mean" (NULL), "deviation", "quantile:P", "share:>LIMIT",
                           ///< "share:<LIMIT", "footprint[:SHARE]" (docs/study.md)
    bool map;              ///< two keys as a map, however few values the second one has
    bool sensitivity;      ///< bars of the factors instead, of each point
    unsigned char index;   ///< an ld_index: by which they are sorted
    const void *reserved[3]; ///< NULL: room for what later versions may be asked
} ld_study_question;

/// Draws results over the values of one swept key, or of two, pooled over the others, with 95 %
/// intervals, by gnuplot.
/// @param file ends in .svg, .pdf or .png
/// @return LD_OK; LD_ERR_INPUT (no study there, no sweep, no such key, result or point, no value to
///         draw), LD_ERR_FILE, LD_ERR_MISSING (no gnuplot), LD_ERR_MEMORY
ld_status ld_study_plot(const char *folder, const ld_study_question *question, const char *file,
                        ld_error *error);

/// Writes all rockets with their factors and results, in full precision: a line for each into the
/// CSV file, a dataset for each column into the HDF5 file; NULL: not requested.
ld_status ld_study_export(const char *folder, const char *csv, const char *hdf5, ld_error *error);

/// Writes the footprints of all points of the sweep, for range safety: the regions in which 95, 99
/// and 99.9 % of landings lie (docs/study.md), into a file whose ending says what it becomes: .csv
/// (corners in metres from the launch point), .kml or .geojson (on the Earth).
/// @return LD_OK; LD_ERR_INPUT (no study there, another ending, too few landings for any, no place
///         on the Earth for .kml and .geojson), LD_ERR_FILE, LD_ERR_MEMORY
ld_status ld_study_export_footprint(const char *folder, const char *file, ld_error *error);

/// One sample on its own.
typedef struct ld_sample ld_sample;

/// Sample `number` (from 1) of a study, which must outlive it.
/// @return LD_OK, LD_ERR_INPUT (nothing varies, no such sample, or its values make no possible
///         model), LD_ERR_MEMORY
ld_status ld_study_sample(const ld_study *study, int64_t number, ld_sample **sample,
                          ld_error *error);
/// Sample `number` (from 1) of a model on its own, which must outlive it.
ld_status ld_sample_create(const ld_model *model, int64_t number, ld_sample **sample,
                           ld_error *error);
const ld_model *ld_sample_model(const ld_sample *sample);
void ld_sample_free(ld_sample *sample);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
