// summary.json with what it says of the files beside it.
#ifndef LD_RESULTS_SUMMARY_JSON_H
#define LD_RESULTS_SUMMARY_JSON_H

#include "launchdyn/model.h"
#include "launchdyn/status.h"
#include "launchdyn/summary.h"
#include "results/manifest.h"

// ld_summary_write() in a folder with these files.
ld_status summary_write(const char *path, const ld_model *model, const ld_summary *summary,
                        const manifest_file file[MANIFEST_FILES], ld_error *error);

#endif
