// Kinds of work, each written once where the subsystem that does it is: X(place of its power, name,
// what it is). From such a list come the places, the columns and the numbers of the summary.
#ifndef LD_ELEMENTS_WORK_H
#define LD_ELEMENTS_WORK_H

#define WORK_PLACE(place, name, is) place,

#endif
