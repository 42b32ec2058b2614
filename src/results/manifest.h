// What a folder of results holds, by its summary.json: size and digest of each other file, and in
// its last line a digest of its own text.
#ifndef LD_RESULTS_MANIFEST_H
#define LD_RESULTS_MANIFEST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "launchdyn/status.h"

// The files beside summary.json, in the order in which they get their names.
enum { MANIFEST_HDF5, MANIFEST_CSV, MANIFEST_FLIGHTS, MANIFEST_MAP, MANIFEST_FILES };
extern const char *const manifest_name[MANIFEST_FILES];

typedef struct manifest_file {
    bool there;
    int64_t size;    // [bytes]
    uint64_t digest; // FNV-1a
} manifest_file;

typedef enum manifest_state {
    MANIFEST_NONE,    // there is no summary.json
    MANIFEST_EARLIER, // it is of a version that kept no digests
    MANIFEST_DAMAGED,
    MANIFEST_WHOLE,
} manifest_state;

typedef struct manifest {
    manifest_state state;
    char problem[256];                  // why it is damaged: "summary.json ..."
    char *text;                         // what it says but for files and the scenario's texts;
                                        // NULL: it is damaged, or not there
    size_t length;                      // of the text
    manifest_file file[MANIFEST_FILES]; // of a whole one
} manifest;

// The first member of summary.json, "format", since it keeps digests.
#define MANIFEST_FORMAT "2"

// The last member: the digest of all before it.
#define MANIFEST_SEAL "  \"digest\": \""
enum { MANIFEST_SEAL_LENGTH = sizeof MANIFEST_SEAL - 1 + 16 + sizeof "\"\n}\n" - 1 };

// Size and digest of the file at `path`; not `there` where it is not. Where it cannot be read the
// status and sentence of text_file_failed().
ld_status manifest_measure(const char *path, manifest_file *file, ld_error *error);

// manifest_seal.c: the last member of the JSON object whose text up to there this is; the text and
// that member.
void manifest_make_seal(char seal[MANIFEST_SEAL_LENGTH + 1], const char *text, size_t length);
void manifest_seal(FILE *file, const char *text, size_t length);

// Reads summary.json of a folder. LD_OK whatever it finds; LD_ERR_FILE or LD_ERR_MEMORY where the
// system refuses.
ld_status manifest_read(const char *folder, manifest *self, ld_error *error);
void manifest_free(manifest *self);

// Why it is not known whether the files are whole, in a sentence; NULL: it is.
const char *manifest_doubt(const manifest *self);

// Whether a file is the one that the manifest names, or is rightly not there; LD_OK too where there
// are no digests. LD_ERR_INPUT, or what manifest_measure() returns, with a sentence that begins
// with its name.
ld_status manifest_check(const manifest *self, const char *folder, int file, ld_error *error);

// The same of history.h5, before it is opened, of a folder whose summary.json is not damaged; the
// sentence begins with the folder. `doubt` (NULL: not requested) becomes why it is not known, or
// "".
ld_status manifest_check_history(const char *folder, char *doubt, size_t size, ld_error *error);

#endif
