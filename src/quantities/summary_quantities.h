// The quantities of a summary: of each rocket, of the run, of each natural mode. Order and paths
// are those of summary.json.
#ifndef LD_QUANTITIES_SUMMARY_QUANTITIES_H
#define LD_QUANTITIES_SUMMARY_QUANTITIES_H

#include "quantities/quantity_table.h"
#include "quantities/summary.h"

extern const quantity_table rocket_quantities; // of ld_rocket_summary; paths below rockets.N
extern const quantity_table run_quantities;    // of ld_summary
extern const quantity_table mode_quantities;   // of ld_mode; paths below modes.N
extern const quantity_table cost_quantities;   // of ld_summary

// Of a rocket nothing has happened yet: its numbers are NaN, greatest forces and sums of one in a
// tube (`launched`) zero.
void rocket_clear(ld_rocket_summary *rocket, bool launched);

// Blocks of the table after a run.
enum {
    SHOWN_EQUILIBRIUM = 1,
    SHOWN_CHANGE,
    SHOWN_LAUNCH,
    SHOWN_GROUND,
    SHOWN_TIP,
    SHOWN_PEAKS,
    SHOWN_HINGES,
    SHOWN_MEASURES,
    SHOWN_FLIGHT
};

#endif
