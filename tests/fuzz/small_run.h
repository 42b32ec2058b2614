// A short launch of two rockets, one of which flies on, and what it writes.
#ifndef LD_TESTS_FUZZ_SMALL_RUN_H
#define LD_TESTS_FUZZ_SMALL_RUN_H

#include "fuzz/memory_folder.h"
#include "launchdyn/output.h"
#include "launchdyn/simulation.h"
#include "launchdyn/summary.h"
#include "model/model.h"
#include "scenario/scenario.h"

static const char small_run[] =
    "launchdyn: 1\ntitle: Small\nbase: {kind: fixed, elevation: 20 deg}\ntubes:\n  length: 1.6 m\n"
    "  layout: {rows: 1, columns: 2, pitch: 0.3 m}\n"
    "  sections: [{from: 0 m, inner_radius: 80 mm, outer_radius: 85 mm}]\n"
    "  material: {youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7850 kg/m3}\n"
    "  supports: [{at: 1 m, stiffness: 1e7 1e7 1e7 N/m,\n"
    "              rotational_stiffness: 1e6 1e6 1e6 N.m/rad}]\n"
    "  modes: {bending: 1, torsion: 0}\n  slot: none\nrocket:\n  mass: 60 kg\n  center: 1 0 0 m\n  "
    "inertia: 1 24 24 kg.m2\n"
    "  empty: {mass: 40 kg, center: 1 0 0 m, inertia: 1 18 18 kg.m2}\n"
    "  adaptors: [{name: a, at: 0 m, clearance: 1 mm}, {name: b, at: 1.5 m, clearance: 1 mm}]\n"
    "  contact: {stiffness: 5e7 N/m}\n  lock: none\n"
    "  motor: {thrust: [[0 s, 0 N], [10 ms, 80 kN], [1 s, 80 kN], [1.1 s, 0 N]]}\n"
    "  aerodynamics: {model: body, area: 0.02 m2}\n"
    "firing: [{tube: 1, at: 0 s}, {tube: 2, at: 150 ms}]\n"
    "run: {end: 0.25 s, output_step: 20 ms, start: undeformed}\n";

// Writes its results into the folder in memory.
static inline void write_small_run(void)
{
    ld_model model;
    ld_messages messages;
    ld_simulation *simulation;
    ld_output *output;
    ld_error error;
    ld_summary *summary = ld_summary_new();
    ld_status status = scenario_read_text(small_run, sizeof small_run - 1, "small", "", NULL, 0,
                                          &model, &messages);
    if (status)
        ld_messages_print(&messages, stderr);
    must(!status && summary);
    must(!ld_simulation_create(&model, &simulation, &error));
    must(!ld_output_open(in_memory("run"), &model, true, &output, &error));
    ld_run_options options = {.sink = ld_output_sink(output)};
    status = ld_simulation_run(simulation, &options, summary, &error);
    if (status)
        fprintf(stderr, "%s\n", error.text);
    must(!status);
    must(!ld_output_finish(output, summary, &error));
    ld_simulation_free(simulation);
    ld_summary_free(summary);
    model_clear(&model);
}

#endif
