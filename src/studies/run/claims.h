// The folder DIR/ranges, by which processes on any machines share a study: who runs which range,
// and the parts that are not in the database yet. Nothing depends on it but speed: a range that
// runs twice gives the same records twice.
//   worker-ME      of each process; renewed in time, its time says that it lives
//   000007.taken   range 7 is taken: a second name (link) of the file of the process that runs it
//   000007.part    records of the whole range (part.h)
//   ME-000007.part records of a process that was stopped in the midst of the range
//   state          what the keeper of the database knows (join_state.h)
// All of this works on NFS: link() and rename() are atomic there; all times are those of the file
// system, so that clocks of machines may differ.
#ifndef LD_STUDIES_CLAIMS_H
#define LD_STUDIES_CLAIMS_H

#include <dirent.h>
#include <stdbool.h>
#include <stdint.h>

#include "launchdyn/status.h"
#include "studies/run/part.h"

enum { CLAIMS_NAME = 4352 };

typedef struct study_claims {
    char folder[4096]; // DIR/ranges
    char me[160];      // name of this process's file
    double begun;      // [s] its first time
    double now;        // [s] its latest time
    double expiry;     // [s] after which others are taken for dead
} study_claims;

// Makes the folder and the file of this process.
// @return LD_OK; LD_ERR_INPUT, the name is too long; LD_ERR_FILE
ld_status claims_open(study_claims *self, const char *folder, double expiry, ld_error *error);
// Takes the file of this process away, and where `last`, all of the folder.
void claims_close(study_claims *self, bool last);

// Says that this process lives; *there: false where its file has been removed, as when the study is
// complete.
ld_status claims_renew(study_claims *self, bool *there, ld_error *error);

// What is said of a range.
typedef enum claim_kind { CLAIM_NONE, CLAIM_TAKEN, CLAIM_PART } claim_kind;

// Reads what is said of each: kind[count].
ld_status claims_list(const study_claims *self, claim_kind *kind, int count, ld_error *error);

// Takes a range, also that of a process that has given no sign of life; *taken: false where another
// has it.
ld_status claims_take(const study_claims *self, int range, bool *taken, ld_error *error);
void claims_release(const study_claims *self, int range);
// Whether the whole part of a range is there: a list is not of one instant.
bool claims_has_part(const study_claims *self, int range);

// Writes the part of a range, of which it is the whole or not.
ld_status claims_put_part(const study_claims *self, int range, bool whole, const study_part *part,
                          ld_error *error);
// Reads the parts one after the other. Those that have been kept are then removed.
typedef struct claims_parts {
    const study_claims *claims;
    DIR *folder;
    char path[CLAIMS_NAME]; // of the part read last
    unsigned char *bytes;
    size_t size;
} claims_parts;

ld_status claims_parts_begin(claims_parts *self, const study_claims *claims, ld_error *error);
bool claims_parts_next(claims_parts *self);
void claims_parts_end(claims_parts *self);

// A file of the folder: its contents, and when it was written [s].
ld_status claims_write(const study_claims *self, const char *name, const void *bytes, size_t size,
                       ld_error *error);
// @return text to be freed; NULL: it is not there
char *claims_read(const study_claims *self, const char *name, size_t *size, double *time);
void claims_remove(const study_claims *self, const char *name);

#endif
