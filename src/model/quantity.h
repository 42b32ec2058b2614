// A quantity is written once, as a row of a table: how it is called, what it is, where its number
// stands. From the rows follow columns, the numbers of summary.json, the table after a run, what a
// study keeps of a rocket (`studied`), docs/quantities.md, and what a program finds by name
// (quantities/quantity_table.h).
#ifndef LD_MODEL_QUANTITY_H
#define LD_MODEL_QUANTITY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// What there is one of each: a run; a vehicle, where the base is one; a slot; air on the emerged
// part of the rocket or on all of it in an open guide, jets on the platform, a pressure behind the
// rocket, what all recoil slides do, where they are asked for; a round or WGS 84 Earth; a line
// that the rocket pulls; wind, a jet on the guide; a canopy below which it flies; then several.
typedef enum quantity_each {
    EACH_RUN,
    EACH_VEHICLE,
    EACH_SLOT,
    EACH_CROSSFLOW,
    EACH_OPEN_AIR,
    EACH_JET,
    EACH_PRESSURE,
    EACH_SLIDE_WORK,
    EACH_EARTH,
    EACH_LINE,
    EACH_GUIDE_WIND,
    EACH_GUIDE_JET,
    EACH_DEFLECTOR,
    EACH_DESCENT,
    EACH_COORDINATE, // modal, of the tube
    EACH_ADAPTOR,
    EACH_SHOE,  // an adaptor on a guide's surfaces
    EACH_HINGE, // azimuth, elevation
    EACH_WHEEL,
    EACH_MEASURE,    // that the scenario asks for
    EACH_SLIDE,      // support on which the tube recoils, by its number among them
    EACH_PARACHUTE,  // of a rocket whose canopies have no mass
    EACH_CANOPY,     // parachute with a mass of its own
    EACH_LINE_PLACE, // at equal parts of the length that is out, the first at the container
    EACH_STATION,    // of the tube, at which loads are asked for
    EACH_SUPPORT,    // of the tube, where loads are asked for
    // of a base of kind multibody: there is one, it has wheels; its parts
    EACH_MULTIBODY,
    EACH_ROLLING,
    EACH_BODY,
    EACH_BEAM,
    EACH_BEAM_COORDINATE, // modal
    EACH_CARRIER,         // where something stands on it
    EACH_JOINT,
    EACH_TURN,     // joint that turns about one axis
    EACH_SLIDER,   // joint that slides along one
    EACH_CYLINDER, // joint by kind: cylindrical, universal, planar, spherical
    EACH_UNIVERSAL,
    EACH_PLANE,
    EACH_BALL,
    EACH_DRIVE,
    EACH_STRUT,
    EACH_FOOT,
    EACH_BUSHING,
    EACH_ROLLER, // its wheels
    EACH_COUNT
} quantity_each;

// A number in the struct that a table is about.
typedef struct quantity_place {
    enum { QUANTITY_NONE, QUANTITY_NUMBER, QUANTITY_INT, QUANTITY_INT64, QUANTITY_BOOL } type;
    size_t offset, stride; // [bytes] stride: from one of several to the next
} quantity_place;

#define QUANTITY_TYPE(of)                                                                          \
    _Generic((of), double                                                                          \
             : QUANTITY_NUMBER, int                                                                \
             : QUANTITY_INT, int64_t                                                               \
             : QUANTITY_INT64, bool                                                                \
             : QUANTITY_BOOL)
// The member of a struct; a member of each item of an array in it, or the item itself.
#define QUANTITY_AT(type, member)                                                                  \
    {                                                                                              \
        QUANTITY_TYPE(((type *)0)->member), offsetof(type, member), 0                              \
    }
#define QUANTITY_OF_EACH(type, array, member)                                                      \
    {                                                                                              \
        QUANTITY_TYPE(((type *)0)->array[0].member), offsetof(type, array[0].member),              \
            sizeof(((type *)0)->array[0])                                                          \
    }
#define QUANTITY_EACH_OF(type, array)                                                              \
    {                                                                                              \
        QUANTITY_TYPE(((type *)0)->array[0]), offsetof(type, array), sizeof(((type *)0)->array[0]) \
    }

// How the table after a run shows it.
typedef struct quantity_line {
    const char *label; // NULL: not shown, or as the second number of the line before it
    const char *unit;
    double factor;        // from SI
    int digits;           // after the point
    bool beside;          // the second number of the line before it
    bool nonzero;         // shown only where it is not 0
    quantity_place error; // how far off both numbers may be, where that is known
} quantity_line;

typedef struct quantity {
    const char *name; // %s: of which
    const char *unit; // SI; "" or "1": none; NULL: each has one of its own (quantity_unit)
    const char *description;
    quantity_place at;
    const char *json; // path in summary.json, where that is not the name; [] at its end: in a list
    bool studied;     // kept by a study
    bool from_zero;   // a greatest value or a sum, 0 at first; others are NaN until they are known
    quantity_line line; // label with %s: of which
} quantity;

// Rows that are there together, of one or, item by item, of several.
typedef struct quantity_group {
    quantity_each each;
    const char *title; // in docs/quantities.md
    const quantity *row;
    int rows;
    quantity_place where; // there only where this is not 0
    bool launch;          // not of a flight alone
    int block;            // of lines in the table after a run
    bool backwards;       // there the last item comes first
} quantity_group;

#define QUANTITY_ROWS(list) .row = list, .rows = sizeof(list) / sizeof *(list)

typedef struct quantity_table {
    const quantity_group *group;
    int groups;
} quantity_table;

#endif
