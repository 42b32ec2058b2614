// What a launch leaves besides its rows.
#ifndef LD_LAUNCH_LAUNCH_SUMMARY_H
#define LD_LAUNCH_LAUNCH_SUMMARY_H

#include "launch/launch_run.h"

void launch_record_ignition(ld_run *run, double t, const double *y);
void launch_record_exit(ld_run *run, double t, const double *landed);
// Largest contact and slot forces so far.
void launch_watch_forces(ld_run *run, double t, const double *y);
// Largest recoil of the tube so far, also after the rocket has left it.
void launch_watch_recoil(ld_run *run, double t, const double *y);
// Largest of what the tube has carried and its supports have borne, where that is asked for.
void launch_watch_loads(ld_run *run, double t, const double *y);
// How the hinges of a vehicle have been held since the ignition.
// Of one hinge or drive since the ignition; the integrals continue by the trapezoidal rule, one
// that begins after the ignition as if it had been so since then.
void launch_watch_hinge(hinge_watch *watch, double since, const hinge_report *hinge,
                        ld_hinge_summary *held);
void launch_watch_hinges(ld_run *run, double t, const double *y);
void launch_energy_at(const launch_state *self, double t, const double *y, double energy_start,
                      ld_energy *energy);
void launch_summarise(ld_run *run);

#endif
