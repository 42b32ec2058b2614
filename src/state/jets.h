// The jets of rockets that have left, on the platform that carries their tubes (model.md, section
// 6). The platform does nothing to a rocket in flight, so that one's course is found first, when it
// leaves, and then only looked up.
#ifndef LD_STATE_JETS_H
#define LD_STATE_JETS_H

#include "elements/exchange.h"
#include "elements/plume.h"
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

// Where a rocket's jet comes from: O1, and its axis, in I. No thrust: there is none.
typedef struct jet_source {
    v3 r, axis;
    plume_thrust thrust;
} jet_source;

// One rocket that has left.
typedef struct jet {
    const flight_system *flight;
    double t_ignition;
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

// The jet of the rocket that has left the tube `launching`.
jet_source jets_source(const jets *self, double t, int launching);

// On a guide without deflection, A its axes (model.md, section 5): on its front end about `tip`, of
// a rocket that has left; on its deflector, its rear end at `rear`.
guide_push jet_on_face(const ld_tubes *tubes, const ld_plume *plume, const jet_source *from, v3 tip,
                       m3 A);
guide_push jet_on_deflector(const ld_tubes *tubes, const ld_plume *plume, const jet_source *from,
                            v3 rear, m3 A);

// The first corner of a thrust curve that lies ahead.
double jets_next_corner(const jets *self);
// Begins the pieces of thrust curves that t has reached; true where there was one.
bool jets_pass_corners(jets *self, double t);
// How many pieces have begun in all.
int jets_pieces(const jets *self);

#endif
