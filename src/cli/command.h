// The parts that the commands of launchdyn share.
#ifndef LD_CLI_COMMAND_H
#define LD_CLI_COMMAND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "cli/words/help.h"
#include "cli/words/options.h"
#include "launchdyn/model.h"
#include "launchdyn/origin.h"
#include "launchdyn/scenario.h"
#include "launchdyn/status.h"
#include "launchdyn/study.h"

// What the command ends with, beside 0 and 128 + the number of the signal that stopped it.
enum {
    EXIT_LAUNCH = 1, // launch or flight cannot be computed to its end: what there is was written
    EXIT_INPUT = 2,  // what was given is wrong: words, scenario, tables, folders of results
    EXIT_SYSTEM = 3, // what is needed is not available: room on a disk, memory, threads, gnuplot
};

// Complains of an error of a simulation or a run of the model, at its place in the scenario where
// it is about a key; its exit code.
int command_fail_on(const ld_model *model, ld_status status, const ld_error *error);

// Before all else, in every program: a pipe that was cut and a file that grows beyond its limit
// become errors of the write and do not end the program. Returns 0, or EXIT_SYSTEM after a message
// where the stack is limited to less than is needed.
int command_begin(void);

// The end of a command: what it printed is out, or the code says so.
int command_end(int code);

// Does `work` in a process of its own (launchdyn/child.h). Returns the exit code.
int command_in_child(int (*work)(void *data), void *data);

// The exit code that belongs to a status.
int command_code(ld_status status);

// The commands, rows of the table in main.c.
int command_run(const command *self, int argc, char **argv);
int command_study(const command *self, int argc, char **argv);
int command_new(const command *self, int argc, char **argv);
int command_check(const command *self, int argc, char **argv);
int command_live(const command *self, int argc, char **argv);
int command_modes(const command *self, int argc, char **argv);
int command_fit(const command *self, int argc, char **argv);
int command_optimise(const command *self, int argc, char **argv);
int command_fmu(const command *self, int argc, char **argv);
int command_plot(const command *self, int argc, char **argv);
void command_plot_figures(void);
int command_compare(const command *self, int argc, char **argv);
int command_report(const command *self, int argc, char **argv);
int command_response(const command *self, int argc, char **argv);
int command_sensitivity(const command *self, int argc, char **argv);
int command_road(const command *self, int argc, char **argv);
int command_wind(const command *self, int argc, char **argv);

#define COMMAND_SETS(sets)                                                                         \
    {                                                                                              \
        "set", '\0', OPTION_TEXTS, sets, "Set a key of the scenario (can be repeated)",            \
            "PATH=VALUE"                                                                           \
    }

#define COMMAND_STRICT(strict)                                                                     \
    {                                                                                              \
        "strict", '\0', OPTION_FLAG, strict, "Treat warnings about implausible values as errors",  \
            NULL                                                                                   \
    }

#define COMMAND_JOBS(threads, what)                                                                \
    {                                                                                              \
        "jobs", 'j', OPTION_INTEGER, threads, "Number of " what " computed in parallel (1)", "N"   \
    }

#define COMMAND_JSON(json)                                                                         \
    {                                                                                              \
        "json", '\0', OPTION_FLAG, json, "Print as JSON, in full precision", NULL                  \
    }

// What is wrong with a number of jobs; NULL: nothing.
const char *command_wrong_jobs(int threads);

// The options of every command, with which its list ends: what is said beside the result, less than
// usual or more, and its help.
#define COMMAND_USUAL                                                                              \
    {"quiet", 'q', OPTION_FLAG, command_quiet_flag(), "Print errors only", NULL},                  \
        {"verbose",                                                                                \
         'v',                                                                                      \
         OPTION_FLAG,                                                                              \
         command_verbose_flag(),                                                                   \
         "Print each step and its duration on standard error",                                     \
         NULL},                                                                                    \
        {"help", 'h', OPTION_HELP, NULL, "Show this help and stop", NULL},                         \
    {                                                                                              \
        NULL, '\0', OPTION_FLAG, NULL, NULL, NULL                                                  \
    }
int *command_quiet_flag(void);
int *command_verbose_flag(void);
bool command_is_quiet(void);
FILE *command_text(void); // stdout; with --quiet one that no one reads

// With --verbose prints "launchdyn: text: 3.1 ms" on stderr, the time since the last such line or
// the start.
void command_step(const char *format, ...) LD_PRINTF(1, 2);

// Reads the options and the command's words. Returns true to go on, then options_end() is due;
// false to end with *code.
bool command_line_read(command_line *line, const command *self, int argc, char **argv,
                       const command_option *options, int *code);

// Prints "launchdyn: text" on stderr.
void command_complain(const char *format, ...) LD_PRINTF(1, 2);

// Says on stderr which names of a list, "NAME,...", are former ones, and what they are called now;
// the library accepts both. NULL: no list.
void command_tell_renamed(const char *list);

// Prints the error and returns the exit code that belongs to its status.
int command_fail(ld_status status, const ld_error *error);

// Says on stderr what is another program than the one that made the results in a folder.
void command_warn_difference(const char *folder, const ld_origin *origin);

// Writes the report of the results in `folder` (file NULL: into it), says what is missing in them
// and, unless `silent`, prints what was written. Returns the exit code.
int command_write_report(const char *folder, const char *file, bool silent);

// A command on one scenario: reads the options and the file with its overrides, which `options` put
// into *sets, and does `work` on the model. Returns the exit code.
int command_on_model(const command *self, int argc, char **argv, const command_option *options,
                     char ***sets, int (*work)(const ld_model *model, void *data), void *data);

// Reads a scenario with its overrides; `messages` as of ld_scenario_read().
ld_status command_read_file(const char *file, char **sets, ld_model **model, ld_messages *messages);

// The parts of it: `work` on the nominal model of the file with its overrides; the model of texts
// at a point of its sweep (0: the nominal one), or a study, after messages LD_ERR_INPUT or another.
int command_on_file(const char *file, char **sets, int (*work)(const ld_model *model, void *data),
                    void *data);
ld_status command_read_source(ld_source *source, int point, ld_model **model);
ld_status command_read_study(const char *file, char **sets, ld_study **study);
ld_status command_read_study_source(ld_source *source, ld_study **study);

// Prints warnings on points `from` to `to` of the sweep of texts: as warnings, which --quiet leaves
// out, or where `strict` as errors; where one of the points is wrong, none. Returns 0, or the exit
// code to end with.
int command_take_notes(ld_source *source, int from, int to, bool strict);

#endif
