/// How many of each a model holds at most.
#ifndef LD_MODEL_BLOCKS_LIMITS_H
#define LD_MODEL_BLOCKS_LIMITS_H

enum {
    LD_MAX_SECTIONS = 32,
    LD_MAX_POINT_MASSES = 16,
    LD_MAX_SUPPORTS = 8,
    LD_MAX_CLAMPED_STATIONS = 4, ///< supports with directions held rigidly
    LD_MAX_CLAMPED = 12,         ///< such directions in all
    LD_MAX_STATIONS = 16,
    LD_MAX_WIND_DRAGS = 16, ///< lengths of the guide in the wind
    LD_MAX_RAIL_JOINTS = 10,
    LD_MAX_ADAPTORS = 8,
    LD_MAX_PARACHUTES = 8,
    LD_MAX_FURTHER_MOTORS = 4,
    LD_LINE_PLACES = 12, ///< places of a line in results
    LD_MAX_SURFACES = 12,
    LD_MAX_AIR_SURFACES = 8, ///< nose, body, tail, fins
    LD_MAX_SINES = 16,
    LD_MAX_SEA_RESPONSES = 37, ///< headings at which a ship's response is given
    LD_MAX_WHEELS = 32,
    LD_MAX_BUMPS = 16,
    LD_MAX_TUBES = 512,
    LD_MAX_FIRINGS = 64,
    LD_MAX_BENDING_MODES = 24,
    LD_MAX_TORSION_MODES = 8,
    LD_MAX_AXIAL_MODES = 8,
    LD_MAX_GUSTS = 16,
    LD_MAX_NAME = 64,
    LD_MAX_PATH = 128,
    LD_MAX_TOGETHER = 8,
    LD_MAX_CHOICES = 32,
    LD_MAX_UNTIL = 16,
    LD_MAX_BOUNDS = 12,
    LD_MAX_AIMS = 6,
    LD_MAX_MEASURES = 40,
    LD_MAX_TAKEN = 80, ///< measures, and figures over time in their expressions
    LD_MAX_UNIT = 48,
    LD_MAX_QUANTITY = 96,
    LD_MAX_CORRELATED = 16,
    LD_MAX_POINTS = 10000,
};

#endif
