/// The road under a vehicle: the block `base.road`.
#ifndef LD_MODEL_BLOCKS_ROAD_H
#define LD_MODEL_BLOCKS_ROAD_H

#include "model/blocks/limits.h"
#include "model/blocks/table.h"

/// One sinusoid of a road, `amplitude sin(2 pi x/wavelength + phase)`, on both tracks.
typedef struct ld_road_sine {
    double amplitude;  ///< [m]
    double wavelength; ///< [m]
    double phase;      ///< [rad]
} ld_road_sine;

typedef enum ld_track { LD_TRACK_BOTH, LD_TRACK_LEFT, LD_TRACK_RIGHT } ld_track;

/// `height/2 (1 - cos(2 pi (x - at)/length))` for at < x < at + length.
typedef struct ld_bump {
    double at;     ///< [m] x of I
    double length; ///< [m]
    double height; ///< [m], negative: a hole
    ld_track tracks;
} ld_bump;

typedef enum ld_tracks { LD_TRACKS_SAME, LD_TRACKS_INDEPENDENT, LD_TRACKS_COHERENT } ld_tracks;

enum { LD_ROAD_SMOOTH = -1 };

typedef enum ld_road_form { LD_ROAD_SUM, LD_ROAD_FLAT } ld_road_form;

/// Height of the road over x of I, of the left track and the right one: the sum of what is given
/// (model.md, section 7); a flat road has nothing of it.
typedef struct ld_road {
    ld_road_form form;
    int iso_class; ///< ISO 8608: 0 (A) to 7 (H); LD_ROAD_SMOOTH: no random part
    ld_tracks tracks;
    ld_table coherence; ///< n [1/m], g [-] with coherence g^2 (coherent); linear, constant outside
    int seed;
    int harmonics;         ///< N
    double wavelengths[2]; ///< [m] shortest, longest
    int sine_count;
    ld_road_sine sine[LD_MAX_SINES];
    int bump_count;
    ld_bump bump[LD_MAX_BUMPS];
    ld_table profile; ///< x [m], h [m] of both tracks, or x, left, right; cubic spline (not a
                      ///< knot), constant outside
    double places[2]; ///< [m] z of the tracks, left, right, chassis axes: between them the height
                      ///< is linear; NaN: wheels with mount z < 0 are on the left one
} ld_road;

#endif
