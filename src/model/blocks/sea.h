/// Sea and a ship's response to it: the block `base.sea`.
#ifndef LD_MODEL_BLOCKS_SEA_H
#define LD_MODEL_BLOCKS_SEA_H

#include <stdbool.h>

#include "model/blocks/limits.h"
#include "model/blocks/table.h"

typedef enum ld_sea_spectrum {
    LD_SEA_JONSWAP,
    LD_SEA_PIERSON_MOSKOWITZ,
    LD_SEA_REGULAR, ///< one wave
} ld_sea_spectrum;

/// How a ship moves in a wave of unit amplitude that goes to `heading`: its place and attitude are
/// those amplitudes, and lead the crest at its reference point by those phases.
typedef struct ld_sea_response {
    double heading; ///< [rad] from x, 0 to pi; NaN: the sea's
    ld_table table; ///< omega [rad/s] of the wave; amplitude [-], phase [rad] of surge, sway,
                    ///< heave, amplitude [rad/m], phase [rad] of roll, pitch, yaw
} ld_sea_response;

/// Sea on deep water and the ship's response to it: sea.md.
typedef struct ld_sea {
    bool present;
    ld_sea_spectrum spectrum;
    double height;     ///< [m] significant, from trough to crest; of one wave its own
    double period;     ///< [s] of the spectrum's peak, of one wave its own
    double peakedness; ///< [-] JONSWAP's gamma
    double heading;    ///< [rad] where it goes to, from x, positive to the right
    double spreading;  ///< [-] s of cos^2s(angle/2) about the heading; NaN: all go there
    int waves;
    int seed;
    int response_count;
    ld_sea_response response[LD_MAX_SEA_RESPONSES];
} ld_sea;

#endif
