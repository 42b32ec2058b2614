/// Status codes and error messages, returned by every function that can fail.
///
/// A pointer is NULL only where the comment of a function or a member says so. Anywhere else NULL
/// is a fault of the calling program: reading, running and writing end it by an assertion that
/// names what is missing (release builds too), other functions have no defined behaviour.
#ifndef LAUNCHDYN_STATUS_H
#define LAUNCHDYN_STATUS_H

#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

#if defined(__GNUC__)
#define LD_PRINTF(format_index, first_argument)                                                    \
    __attribute__((format(printf, format_index, first_argument)))
#else
#define LD_PRINTF(format_index, first_argument)
#endif

/// What came of a call. `LD_OK` is zero, so `if (status)` means "it failed".
typedef enum ld_status {
    LD_OK = 0,
    LD_ERR_INPUT,       ///< an argument, the scenario or a file that is read is wrong or not there
    LD_ERR_FILE,        ///< a file cannot be written
    LD_ERR_MEMORY,      ///< no memory
    LD_ERR_NUMERIC,     ///< the numerics failed: NaN, singular matrix, no convergence
    LD_ERR_LAUNCH,      ///< the launch cannot continue: stuck, jammed, never released
    LD_ERR_INTERRUPTED, ///< stopped on request
    LD_ERR_MISSING,     ///< a program or a feature needed is not there
} ld_status;

enum { LD_ERROR_TEXT = 640 };

/// An error as one clear sentence. Functions take `ld_error *error`, which may be NULL.
typedef struct ld_error {
    ld_status status;
    char text[LD_ERROR_TEXT];
} ld_error;

/// Short name of a status code, e.g. "input".
const char *ld_status_name(ld_status status);

/// Writes status and formatted text into `error` (if not NULL) and returns `status`, so that a
/// failing function can end with `return ld_fail(error, LD_ERR_INPUT, "...", ...);`.
ld_status ld_fail(ld_error *error, ld_status status, const char *format, ...) LD_PRINTF(3, 4);

/// Writes `text` as a terminal may show it: control characters, those that are not seen or turn
/// others around (U+200B, U+202E), and bytes that are no UTF-8, byte by byte as `\x1b`; what
/// `size` has no room for as "...". The texts of errors are such already. Returns
/// `visible`.
char *ld_visible_text(const char *text, char *visible, size_t size);

/// A stream into memory, for what functions print: *text is what was written, with a zero after its
/// *length bytes, once the stream was closed; free it with ld_free().
/// @return NULL: no memory
FILE *ld_text_open(char **text, size_t *length);

/// Closes it.
/// @return LD_ERR_MEMORY: there was no room for all of it, and *text is NULL
ld_status ld_text_close(FILE *stream);

/// free(), for programs that have another C library than launchdyn, or none: of every array or text
/// whose comment says that it is to be freed. NULL is allowed.
void ld_free(void *memory);

/// The one of `count` names that is nearest to `word` by edit distance, for "did you mean"; NULL if
/// none is near.
const char *ld_nearest_name(const char *word, const char *const *names, size_t count);

/// What a quantity is called that had another name in earlier versions: "rocket.1.exit_speed" for
/// "rocket.1.muzzle_speed". Functions that find columns and results by name accept such names.
/// @param name of `size` bytes, always ended; what is too long is cut
/// @return `name`; NULL: not a former name
const char *ld_current_name(const char *former, char *name, size_t size);

/// The name that the text of an error or of a message suggests ("..., did you mean "mass"?"), for
/// programs that offer it on its own.
/// @param name of `size` bytes, always ended; what is too long is cut
/// @return `name`; NULL: the text suggests none
const char *ld_suggested_name(const char *text, char *name, size_t size);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
