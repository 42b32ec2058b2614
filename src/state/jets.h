// The jets of rockets that have left, on the platform that carries their tubes (model.md, section
// 6). The platform does nothing to a rocket in flight, so that one's course is found first, when it
// leaves, and then only looked up.
#ifndef LD_STATE_JETS_H
#define LD_STATE_JETS_H

#include "systems/bases/vehicle.h"
#include "systems/flight/flight.h"

// A point and its velocity, in I, at one instant.
typedef struct jet_place {
    double t;
    v3 r, v;
} jet_place;

// Of a rocket: O1, and its axis.
typedef struct jet_pose {
    double t;
    v3 r, v, axis;
} jet_pose;

// On the front end of a guide: a force along its axis backwards, at y and z from that.
typedef struct jet_load {
    double force; // [N]
    double at[2]; // [m]
} jet_load;

// One rocket that has left.
typedef struct jet {
    const flight_system *flight;
    double t_ignition;
    double greatest; // [N] of its thrust
    int piece;       // of its thrust curve
    int tube;        // that it left, number from 1
    jet_place mouth; // of that tube as the rocket left
    int count;
    jet_pose *place; // [count] from there on, owned
} jet;

typedef struct jets {
    const ld_model *model;
    int count; // of the first firings
    jet of[LD_MAX_FIRINGS];
} jets;

void jets_free(jets *self);

// The mouth's centre of a tube [m] in T, the axes of the undeformed tube that launches.
v3 jets_mouth(const ld_model *model, int tube, int launching);

// Adds the rocket that leaves next, its tube's mouth there, in the flight's state: finds its course
// until its motor is burnt out or it is out of reach.
// @return LD_OK, LD_ERR_NUMERIC, LD_ERR_MEMORY
ld_status jets_add(jets *self, const flight_system *flight, const flight_phase *phase,
                   const jet_place *mouth, const double *state, ld_error *error);

// Their wrench at t, T being `tube` and that of the tube `launching`.
jet_wrench jets_at(const jets *self, double t, const base_frame *tube, int launching);

// The load of a round jet on a ring, in axes of the ring from its centre, x normal to it: `thrust`
// [N], `r` [m] where the nozzle is, `axis` that of the rocket, of length 1 (model.md, section 5).
jet_load jet_on_face(const ld_jet_face *face, double thrust, v3 r, v3 axis);

// The load on the front end of the tube `launching`, at `tip` of I, with axes A there: that of the
// rocket that has left it.
jet_load jets_on_guide(const jets *self, double t, v3 tip, m3 A, int launching);

// The first corner of a thrust curve that lies ahead.
double jets_next_corner(const jets *self);
// Begins the pieces of thrust curves that t has reached; true where there was one.
bool jets_pass_corners(jets *self, double t);
// How many pieces have begun in all.
int jets_pieces(const jets *self);

#endif
