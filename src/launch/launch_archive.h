// A launch saved and loaded.
#ifndef LD_LAUNCH_LAUNCH_ARCHIVE_H
#define LD_LAUNCH_LAUNCH_ARCHIVE_H

#include "launch/launch_run.h"

// All that the run's steps, rows and summary to come depend on, or that the summary holds by now;
// loads into a run of the same model, whose propagator is there. One walk, as in archive.h. After a
// failed load the run can only be ended.
void launch_archive(ld_run *run, archive *bytes);

#endif
