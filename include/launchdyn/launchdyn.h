/// @file
/// All of launchdyn: every other header of this folder.
#ifndef LAUNCHDYN_LAUNCHDYN_H
#define LAUNCHDYN_LAUNCHDYN_H

#include "launchdyn/child.h"
#include "launchdyn/compare.h"
#include "launchdyn/derivatives.h"
#include "launchdyn/environment.h"
#include "launchdyn/fit.h"
#include "launchdyn/fmu.h"
#include "launchdyn/history.h"
#include "launchdyn/live.h"
#include "launchdyn/loop.h"
#include "launchdyn/model.h"
#include "launchdyn/mstmm.h"
#include "launchdyn/optimise.h"
#include "launchdyn/origin.h"
#include "launchdyn/output.h"
#include "launchdyn/report.h"
#include "launchdyn/response.h"
#include "launchdyn/response_view.h"
#include "launchdyn/results.h"
#include "launchdyn/run.h"
#include "launchdyn/scenario.h"
#include "launchdyn/section.h"
#include "launchdyn/simulation.h"
#include "launchdyn/status.h"
#include "launchdyn/study.h"
#include "launchdyn/study_data.h"
#include "launchdyn/summary.h"
#include "launchdyn/vehicle_run.h"
#include "launchdyn/version.h"

#endif
