// Lateral force of slender bodies and fins, and roll of fins, by Barrowman's formulas (model.md,
// section 8).
//
// J. S. Barrowman and J. A. Barrowman, The theoretical prediction of the center of pressure,
// NARAM-8, 1966; J. S. Barrowman, The practical calculation of the aerodynamic characteristics of
// slender finned vehicles, thesis, Catholic University of America, 1967. Lengths in m; slopes per
// radian on the area S.
#ifndef LD_ELEMENTS_BARROWMAN_H
#define LD_ELEMENTS_BARROWMAN_H

#include "model/blocks/aerodynamics.h"

// A body of revolution: its force's slope and place behind its front end, and its area seen from
// the side with that area's centre.
typedef struct barrowman_body {
    double slope, center; // of slope 0 the middle of the area
    double side, side_center;
} barrowman_body;

// Radius of a nose over that of its base at the share x of its length from the tip; slenderness:
// length over radius.
double barrowman_nose_radius(ld_nose_shape shape, double slenderness, double x);

barrowman_body barrowman_nose(ld_nose_shape shape, double length, double radius, double area);
barrowman_body barrowman_tail(double front_radius, double rear_radius, double length, double area);

// A set of fins: factors on barrowman_fin at `aspect`, and the force's place behind the leading
// edge of the root chord.
typedef struct barrowman_fins {
    double slope;   // of the lateral force
    double forcing; // roll moment per radian of cant, with the length d
    double damping; // roll moment for rates times d/(2 V), < 0, with the length d
    double aspect;
    double center;
} barrowman_fins;

barrowman_fins barrowman_fins_of(const ld_air_surface *fins, double area, double d);

// What the slope of a fin is over the Mach number: 1/(2 + sqrt(4 + (beta aspect)^2)) with
// aspect = AR/cos(Gamma) of the middle chord's sweep Gamma, after Diederich (NACA TN 2335, 1951),
// beta = sqrt(1 - M^2) up to Mach 0.8 after Prandtl and Glauert, the same until that of Ackeret,
// sqrt(M^2 - 1), comes to it at Mach 1.166, and that from there on. `derivative`: by the Mach
// number, on the side of `towards`.
double barrowman_fin(double aspect, double mach, double towards, double *derivative);

#define BARROWMAN_SUBSONIC 0.8                 // [Mach] Prandtl and Glauert up to here
#define BARROWMAN_SUPERSONIC 1.166190378969060 // sqrt(1.36), where Ackeret's factor is the same

#endif
