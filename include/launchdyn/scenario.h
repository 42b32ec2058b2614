/// Scenario files: reading, checking, printing. The language is in docs/scenario.md.
#ifndef LAUNCHDYN_SCENARIO_H
#define LAUNCHDYN_SCENARIO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// One thing wrong with a scenario: where, which key, what was found and what is allowed.
typedef struct ld_message {
    char *file;   ///< name of the file that holds the key; "--set" for an override
    int line;     ///< from 1; 0 where there is none; of an override, its number from 1
    int column;   ///< from 1, in characters
    char *path;   ///< the key's full path, as in --set, e.g. "rocket.adaptors.rear.clearance"
    char *text;   ///< what was found, what is allowed, a suggestion
    char *source; ///< the line of text that it is about; "" where there is none
} ld_message;

typedef struct ld_messages {
    size_t count;
    ld_message *item;
} ld_messages;

void ld_messages_free(ld_messages *messages);

/// Prints `file:line:column: error: path: text`, a line each (with the source line and a caret), as
/// a terminal may show it (ld_visible_text).
void ld_messages_print(const ld_messages *messages, FILE *stream);

/// Prints warnings as ld_messages_print() prints errors, with `warning` in place of `error`.
void ld_notes_print(const ld_messages *notes, FILE *stream);

/// What a simulation or a run of a model said, as a message at its place: an error that is about a
/// key begins with the key's path ("base.wheels.3: ...").
/// @param messages one message, to be freed (ld_messages_free()); none where it returns false
/// @return whether the error is about a key, and the model was read from texts
bool ld_scenario_explain(const ld_model *model, const ld_error *error, ld_messages *messages);

/// Reads and checks a scenario file: of one with a sweep the values that it gives besides, the
/// nominal ones, and each swept value on its own. All errors of the file come in one pass.
/// @param path     file name; "-" is standard input
/// @param sets     `count` texts "path=value" that override the file (as of --set)
/// @param model    filled on success (free with ld_model_free()); NULL on failure
/// @param messages filled on failure (free with ld_messages_free())
/// @return LD_OK, LD_ERR_INPUT, LD_ERR_FILE (the system refused to read a file), LD_ERR_MEMORY
///         (without messages)
ld_status ld_scenario_read(const char *path, const char *const *sets, size_t count,
                           ld_model **model, ld_messages *messages);

/// The same from text in memory; `name` stands for the file in messages, `folder` is where files
/// that it names are searched.
ld_status ld_scenario_read_text(const char *text, size_t length, const char *name,
                                const char *folder, const char *const *sets, size_t count,
                                ld_model **model, ld_messages *messages);

/// A model of overrides alone, "path=value" as of --set; all else has the language's defaults.
ld_status ld_model_new(const char *const *sets, size_t count, ld_model **model,
                       ld_messages *messages);

/// Reads a number in a unit: "0.1 km" in "m" is 100. A number without a unit is in it already.
/// @param unit  in any form of the scenario language ("m", "Hz", "ms"); "" for a plain number
/// @param value stays as it is after an error
/// @return LD_OK; LD_ERR_INPUT, with what was found and what is expected
ld_status ld_read_quantity(const char *text, const char *unit, double *value, ld_error *error);

/// Sets a key by its path to a value with its unit, as --set does: ("rocket.mass", "61 kg"),
/// ("rocket.motor.thrust", "{file: other.eng}"). The whole scenario is read again with it, so that
/// what follows from the key follows. Not while anything made of the model is there.
/// @param messages filled on failure (free with ld_messages_free())
/// @return LD_OK; LD_ERR_INPUT (no such key, no such value, or one that does not fit the others),
///         LD_ERR_MEMORY: then the model is as before
ld_status ld_model_set(ld_model *model, const char *path, const char *value, ld_messages *messages);

/// Sets several keys at once, `count` texts "path=value": for those that fit only together.
ld_status ld_model_set_all(ld_model *model, const char *const *sets, size_t count,
                           ld_messages *messages);

/// A model of its own with several keys set, as ld_model_set_all() would; `model` and what is made
/// of it stay as they are.
/// @param sets    `count` texts "path=value"; without any the new model is equal
/// @param derived filled on success (free with ld_model_free()); NULL on failure
/// @return as ld_model_set()
ld_status ld_model_derive(const ld_model *model, const char *const *sets, size_t count,
                          ld_model **derived, ld_messages *messages);

/// A number of the model by the path of its key ("rocket.mass"; of a vector a component:
/// "rocket.center.x"; of a list a member by its name or number: "rocket.adaptors.rear.at"), in SI.
/// @param value NaN on failure, and where it is not given
/// @return LD_OK, LD_ERR_INPUT (no such number: why)
ld_status ld_model_number(const ld_model *model, const char *path, double *value, ld_error *error);

/// A value as text that can be set again: "61 kg", "1 0 0 m", "fixed"; empty where it is not given.
/// @param text of `size` bytes, always ended; what is too long is cut
/// @return LD_OK, LD_ERR_INPUT (no such key; a block, a list or a table: more than a line),
///         LD_ERR_MEMORY
ld_status ld_model_text(const ld_model *model, const char *path, char *text, size_t size,
                        ld_error *error);

/// A table ("rocket.motor.thrust"), in SI. Times of "base.motion.table" on a clock that counts from
/// long ago (1e5 s or more at the first row) are less the whole seconds of the first row.
/// @param table [rows][columns], the model's own; NULL without rows
/// @return LD_OK, LD_ERR_INPUT (no such table)
ld_status ld_model_table(const ld_model *model, const char *path, const double **table,
                         size_t *rows, size_t *columns, ld_error *error);

/// A key of the scenario language that has a value.
typedef struct ld_key {
    const char *path;        ///< "rocket.mass"; N stands for the name or number of a list's member
    const char *unit;        ///< SI, "" without
    const char *description; ///< one line
    const char *expected;    ///< what its value looks like: "a number with a unit of kg, > 0 kg"
    double low, high;        ///< what a number may be, in SI; infinite without bound
    int required;            ///< has no default
} ld_key;

/// Hands out every key of the language, valid during the call.
void ld_scenario_keys(void (*take)(void *self, const ld_key *key), void *self);

/// Number of axes of the model's sweep: 0 without.
int ld_scenario_axes(const ld_model *model);

/// Number of points of the model's sweep: the product of its axes' counts, 1 without.
int ld_scenario_points(const ld_model *model);

/// The number (from 0) of the value that axis `axis` (from 0) has at point `point` (from 1): the
/// first axis varies most slowly.
int ld_scenario_value(const ld_model *model, int point, int axis);

/// Writes the keys and values of a point, "base.speed 15 km/h, firing.interval 0.4 s"; what is too
/// long is cut.
void ld_scenario_point_name(const ld_model *model, int point, char *text, size_t size);

/// Reads a point of its sweep (from 1 to ld_scenario_points(); 0: the nominal values) from texts
/// that have been read before, those of another model or of results (ld_origin_read()). A value's
/// place in messages is that in the sweep. An override of a swept key takes its axis away; other
/// overrides are laid over the point. The model keeps the axes, and everything else may differ
/// between points. Files that are not among them are read, and added, where the source has a
/// folder.
/// @param source the model gets a share of it
ld_status ld_scenario_read_source(ld_source *source, int point, ld_model **model,
                                  ld_messages *messages);

/// Warnings on values that are allowed but implausible, each beside what makes it so: rules over
/// several keys, docs/scenario.md. They change nothing.
/// @param source of a scenario that has been read (ld_model_source())
/// @param from   first point of its sweep that is examined, from 0 (the nominal values)
/// @param to     last one; what is the same at several points gives a warning once
/// @param warnings  in any case to be freed with ld_messages_free(); of a failure what is wrong
/// @return LD_OK, LD_ERR_INPUT (the scenario has errors, or no such point), LD_ERR_MEMORY
ld_status ld_scenario_notes(ld_source *source, int from, int to, ld_messages *notes);

/// The texts that a model was read from, as long as the model is there.
ld_source *ld_model_source(const ld_model *model);

/// Whether a scenario has a launcher, and whether that is a vehicle; a flight alone has none.
bool ld_model_has_launcher(const ld_model *model);
bool ld_model_has_vehicle(const ld_model *model);

/// What guides the rocket: "tube", "rail" or "tower".
const char *ld_model_guide(const ld_model *model);

/// Prints what was understood, every key with its value in SI, as YAML that can be read again. With
/// `scatter` or `sweep` numbers that follow from others by default are left out, so that samples of
/// the text are those of the model.
void ld_model_print(const ld_model *model, FILE *stream);

/// Describes in words what carries, guides, holds and drives the rocket: some lines that begin with
/// "# ", comments of the scenario language. Nothing of a flight alone.
void ld_model_describe(const ld_model *model, FILE *stream);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
