/// Linear responses to look at: as tables, files and pictures.
#ifndef LAUNCHDYN_RESPONSE_VIEW_H
#define LAUNCHDYN_RESPONSE_VIEW_H

#include <stdbool.h>
#include <stdio.h>

#include "launchdyn/loop.h"
#include "launchdyn/response.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// What is shown. Without an input: the columns, or the exit, on the model's road, at its speed
/// or over speeds.
typedef struct ld_response_wish {
    const char *const *what; ///< columns; NULL: a choice of them, and "all" alone: all
    size_t what_count;
    const char *input;             ///< NULL: the road; else the frequency response from it
    double from, to;               ///< [Hz] of spectrum or frequency response; NaN: 0.2, 50
    double slowest, fastest, step; ///< [m/s] speeds; NaN: the model's alone
    const char *loop;              ///< a hinge, of whose loop it is; NULL: none
    const char *density; ///< of an input that is random: a CSV file of frequencies [Hz] and its
                         ///< one-sided power spectral density there; NULL: it is a sine
    bool exit;           ///< by what the road scatters the exit: `what` are numbers of a launch
    bool friction; ///< the hinges rub, as the road moves them (ld_response_friction()); of the
                   ///< exit always
    int draws;     ///< of the exit; 0: to the first order
    const ld_watch *watch; ///< of the exit, while the view is made; NULL: no one
} ld_response_wish;

/// A frequency response, or root mean squares with a spectrum, or root mean squares over the speed,
/// or the loop of a hinge, or the scatter of the exit.
typedef struct ld_response_view ld_response_view;

/// @param model kept by reference
/// @return as ld_response_create(), ld_response_choose(), ld_response_gain(), ld_response_exit()
/// and ld_loop_create(), and LD_ERR_INPUT (frequencies or speeds that are not a range, a loop with
/// other wishes)
ld_status ld_response_view_create(const ld_model *model, const ld_response_wish *wish,
                                  ld_response_view **view, ld_error *error);
void ld_response_view_free(ld_response_view *view);

/// Prints it as a table for a terminal.
void ld_response_view_print(const ld_response_view *view, FILE *stream);

/// Writes response-frequency.csv, or response-loop.csv, or response-rms.csv and
/// response-spectrum.csv, or response-rms.csv, or response-exit.csv into the folder, which is made
/// where it is not there.
/// @return LD_OK, LD_ERR_INPUT, LD_ERR_FILE or LD_ERR_MEMORY
ld_status ld_response_view_write(const ld_response_view *view, const char *folder, ld_error *error);

/// Draws it with gnuplot, a chart for each unit; the ending of the file says what it becomes: .svg,
/// .pdf or .png.
/// @return LD_OK, LD_ERR_INPUT (ending, more than a page has room for), LD_ERR_FILE, LD_ERR_MEMORY,
///         LD_ERR_MISSING (no gnuplot)
ld_status ld_response_view_draw(const ld_response_view *view, const char *file, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
