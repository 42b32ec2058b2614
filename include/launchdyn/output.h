/// Results on disk and on paper: history.h5, history.csv, flights.csv, trajectories.kml,
/// summary.json, the table of a run, figures. What the files hold is described in docs/results.md.
#ifndef LAUNCHDYN_OUTPUT_H
#define LAUNCHDYN_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/results.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// The results of one run on their way to a folder. Files are written under temporary names
/// ("history.h5.part") and get their own ones at the end.
typedef struct ld_output ld_output;

/// Opens the results of a run in `folder`, which is made, with its parents, where it is not there.
/// @param model  kept by reference: title and names of the adaptors
/// @param csv    also write history.csv and, where rockets fly on, flights.csv
/// @param output opened: end it with ld_output_finish() or ld_output_discard()
/// @return LD_OK, LD_ERR_FILE (with the reason, nothing left behind), LD_ERR_MEMORY, or
///         LD_ERR_INPUT: another run writes there, as it has for 2 s
ld_status ld_output_open(const char *folder, const ld_model *model, bool csv, ld_output **output,
                         ld_error *error);

/// Where the rows of the run go: for ld_run_options.sink. Valid as long as `output`.
const ld_sink *ld_output_sink(ld_output *output);

/// Writes what is left and summary.json, puts all files in place of those of an earlier run, whose
/// report.html goes, and frees `output`. Also for runs that ended early: summary->complete says.
/// @return LD_OK, or LD_ERR_FILE: then the earlier files stand as they were. So it is where another
///         program has removed or replaced a file of this run
ld_status ld_output_finish(ld_output *output, const ld_summary *summary, ld_error *error);

/// Removes what has been written, and the folders made for it, and frees `output` (may be NULL).
void ld_output_discard(ld_output *output);

/// Writes a summary as JSON: SI units, radians, 17 digits, null where there is no value.
/// @return LD_OK or LD_ERR_FILE (then there is no file)
ld_status ld_summary_write(const char *path, const ld_model *model, const ld_summary *summary,
                           ld_error *error);

/// Prints a summary as a short table for a terminal.
void ld_summary_print(const ld_model *model, const ld_summary *summary, FILE *stream);

/// Prints what ld_summary_write() writes, one JSON object.
/// @return LD_OK, LD_ERR_MEMORY (then nothing is printed)
ld_status ld_summary_print_json(const ld_model *model, const ld_summary *summary, FILE *stream,
                                ld_error *error);

/// Prints as JSON (docs/command.md) what was found in a scenario: its errors and warnings and,
/// where there is a model, what was understood, in SI.
/// @param model  NULL: the scenario has errors
/// @param errors, warnings  may be NULL: none
/// @return LD_OK, LD_ERR_MEMORY
ld_status ld_check_print_json(const ld_model *model, const ld_messages *errors,
                              const ld_messages *notes, FILE *stream, ld_error *error);

/// Natural frequencies, as ld_simulation_tube_modes() and ld_simulation_system_modes() find them.
typedef struct ld_found_modes {
    const ld_mode *tube; ///< [tube_count] tube and tail on their supports
    int tube_count;
    const ld_mode *system; ///< [system_count] the whole about its equilibrium
    int system_count;
    const ld_pole *pole; ///< [pole_count] its eigenvalues with damping
    int pole_count;
} ld_found_modes;

/// Prints them as JSON (docs/command.md), in full precision.
void ld_modes_print_json(const ld_found_modes *modes, FILE *stream);

/// A standard figure of a launch.
typedef struct ld_figure {
    const char *name;        ///< e.g. "tip"
    const char *description; ///< one line
} ld_figure;

/// The standard figures, by index from 0; NULL after the last.
const ld_figure *ld_figure_at(size_t index);

/// How a scene in three dimensions is written.
typedef struct ld_scene {
    double magnify; ///< deflections of tubes and beams so many times, up to 100000
    double slower;  ///< played so many times slower than the launch, up to 100000
} ld_scene;

/// A page of figures, one below the other.
typedef struct ld_picture {
    const char *const *folder; ///< results of `folder_count` runs, at most 8; several are laid one
                               ///< over the other, named by their titles or else their folders
    size_t folder_count;
    const char *const *figure; ///< `figure_count` names of figures; "all": all that there are
                               ///< columns for; none: tip, contact and relative, or of a flight
                               ///< alone trajectory and flight
    size_t figure_count;
    double from, to;       ///< [s] from ignition; NaN: what the figure shows on its own
    char *note;            ///< NULL, or [LD_ERROR_TEXT]: becomes "", or why it is not known
                           ///< whether a history that was drawn is whole
    const char *style;     ///< "screen" (NULL), "dark", or "paper": 84 mm wide, without a title
    double width;          ///< [m] 0: as the style has it; else 0.05 to 0.5, letters stay as large
    const ld_scene *scene; ///< of a .glb; NULL: true deflections, true time
} ld_picture;

/// Draws a page with gnuplot, which must be in PATH; or writes the moving launcher of one run as a
/// scene in three dimensions.
/// @param file the picture; its ending says what it becomes: .svg, .pdf or .png, or .glb (binary
///             glTF 2.0: `figure`, `style` and `width` are not given; `to` NaN: up to the last row
///             of the launch)
/// @return LD_OK, LD_ERR_INPUT (unknown figure or ending, no history in a folder, or one that is
/// not
///         as it was written), LD_ERR_FILE, LD_ERR_MEMORY, LD_ERR_MISSING (no gnuplot)
ld_status ld_plot(const ld_picture *picture, const char *file, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
