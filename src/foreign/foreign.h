// FMUs of other people's for co-simulation (FMI 2.0, 3.0): a package is unpacked and described
// once; its instances run, each in a process of its own.
#ifndef LD_FOREIGN_FOREIGN_H
#define LD_FOREIGN_FOREIGN_H

#include "base/archive.h"
#include "foreign/description.h"
#include "foreign/protocol.h"

typedef struct foreign_package {
    char *path;   // as it was named, for sentences
    char *folder; // that it is unpacked in
    foreign_description description;
} foreign_package;

typedef struct foreign_instance foreign_instance;

// Unpacks and reads the FMU `path`; the folder is removed when the package is closed, or by the
// process of an instance where this one dies.
ld_status foreign_open(const char *path, foreign_package **out, ld_error *error);
void foreign_close(foreign_package *self); // may be NULL

// An instance, in a process of its own; the package must outlive it. A call of its functions may
// take `limit` [s].
ld_status foreign_begin(const foreign_package *package, double limit, foreign_instance **out,
                        ld_error *error);
void foreign_end(foreign_instance *self); // may be NULL

// Its values: before initialization parameters and start values, within it inputs; afterwards
// inputs are set with a step. `t` [s] of the caller's clock, NaN for none, is for sentences.
ld_status foreign_set(foreign_instance *self, double t, const foreign_value *values, size_t count,
                      ld_error *error);
ld_status foreign_set_text(foreign_instance *self, double t, uint32_t reference, const char *text,
                           ld_error *error);
ld_status foreign_get(foreign_instance *self, double t, const foreign_value *values, size_t count,
                      double *numbers, ld_error *error);
// Initialization mode, beginning at time `start` [s] of its own clock.
ld_status foreign_enter(foreign_instance *self, double t, double start, ld_error *error);
ld_status foreign_leave(foreign_instance *self, double t, ld_error *error);
// Sets the inputs and steps from `step->t` of its own clock by `step->size`; a step that it breaks
// off continues from there, and from its start in halves where it keeps its state. Then gets the
// outputs. `values`: inputs, then outputs. `pieces`: that it took the step in.
ld_status foreign_step(foreign_instance *self, double t, const foreign_stepping *step,
                       const foreign_value *values, double *numbers, int *pieces, ld_error *error);
// Its state, where its description says that it can be saved; saves or loads.
ld_status foreign_archive(foreign_instance *self, double t, archive *bytes, ld_error *error);

#endif
