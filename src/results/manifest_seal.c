// What a summary says of the files beside it, as it is written.
#include <inttypes.h>

#include "model/fields/digest.h"
#include "results/manifest.h"

const char *const manifest_name[MANIFEST_FILES] = {
    [MANIFEST_HDF5] = "history.h5",
    [MANIFEST_CSV] = "history.csv",
    [MANIFEST_FLIGHTS] = "flights.csv",
    [MANIFEST_MAP] = "trajectories.kml",
};

void manifest_make_seal(char seal[MANIFEST_SEAL_LENGTH + 1], const char *text, size_t length)
{
    snprintf(seal, MANIFEST_SEAL_LENGTH + 1, MANIFEST_SEAL "%016" PRIx64 "\"\n}\n",
             digest_bytes(DIGEST_BEGIN, text, length));
}

void manifest_seal(FILE *file, const char *text, size_t length)
{
    char seal[MANIFEST_SEAL_LENGTH + 1];
    manifest_make_seal(seal, text, length);
    fwrite(text, 1, length, file);
    fputs(seal, file);
}
