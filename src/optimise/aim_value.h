// Numbers of a study that an optimisation makes least or limits, with intervals.
#ifndef LD_OPTIMISE_AIM_VALUE_H
#define LD_OPTIMISE_AIM_VALUE_H

#include <stdbool.h>

#include "launchdyn/study_data.h"
#include "model/blocks/optimise.h"

// What the samples of a candidate gave: results of each rocket of each sample.
typedef struct aim_samples {
    int samples, rockets, results;
    const double *value; // [samples][rockets][results]
} aim_samples;

// An aim with the places of its results: the first, and the second of a deviation or of the landing
// points (-1: none).
typedef struct aim_plan {
    ld_aim_take take;
    double level;
    int first, second;
} aim_plan;

// The parts of the samples of which intervals are made: all but one independent block (jackknife),
// or halves, one sample of each pair (P. J. McCarthy, Rev. Int. Stat. Inst. 37, 1969).
typedef struct aim_blocks {
    int count; // of parts; fewer than 2: no intervals
    bool halves;
} aim_blocks;

// Blocks for the aim: single samples of means and deviations; of Latin hypercubes whole ones;
// halves of quantiles, whose jackknife fails.
aim_blocks aim_blocks_of(const aim_plan *aim, int samples, int hypercubes);

// The value over part `part` of the samples (-1: over all).
// @param work [samples * rockets]
double aim_value(const aim_plan *aim, const aim_samples *of, aim_blocks blocks, int part,
                 double *work);

// The value, or its difference from that of the same samples at another candidate (`from` not
// NULL), with its 95 % interval by Student's t.
// @param work [samples * rockets]
ld_estimate aim_estimate(const aim_plan *aim, const aim_samples *of, const aim_samples *from,
                         aim_blocks blocks, double *work);

#endif
