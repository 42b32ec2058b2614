// Samples side by side on the threads of one process.
#include "model/blocks/study.h"
#include "model/parts.h"
#include "studies/run/ledger.h"

#include "studies/run/worker.h"
#include <assert.h>

static ld_status check_shard(const ld_study *study, const ld_study_options *options,
                             ld_error *error)
{
    if (options->shards > 0 && model_scatter(study->nominal)->until_count > 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "scatter.until requires all samples, and a shard has its own only: run the "
                       "shards with --set scatter.until=, or run the study without shards");
    if (options->shards == 0 || (options->shard >= 1 && options->shard <= options->shards))
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT, "there is no shard %d of %d: they go from 1/%d to %d/%d",
                   options->shard, options->shards, options->shards, options->shards,
                   options->shards);
}

ld_status ld_study_run(const ld_study *study, const char *folder, const ld_study_options *options,
                       ld_study_counts *counts, ld_error *error)
{
    assert(study && folder && counts);
    static const ld_study_options none = {0};
    ld_error own;
    study_ledger ledger;
    error = error ? error : &own;
    options = options ? options : &none;
    *counts = (ld_study_counts){0};
    ld_status status = study_check(study, error);
    if (!status)
        status = check_shard(study, options, error);
    if (status)
        return status;
    const store_place place = {.folder = folder,
                               .shard = options->shard,
                               .shards = options->shards,
                               .journal = options->shards > 0 ? STORE_ROLLBACK : STORE_AHEAD};
    ledger_open(&ledger, study, &place, options, counts, error);
    const sample_source source = ledger_source(&ledger);
    worker_run_side_by_side(&source, options->threads);
    return ledger_close(&ledger);
}
