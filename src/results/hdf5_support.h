// What HDF5 needs around it: silence, errors as one sentence, attributes.
#ifndef LD_RESULTS_HDF5_SUPPORT_H
#define LD_RESULTS_HDF5_SUPPORT_H

#include <hdf5.h>
#include <stdbool.h>

#include "launchdyn/origin.h"
#include "launchdyn/status.h"

// HDF5 prints its error stack unless asked not to; the setting before is put back at the end. What
// has no memory meanwhile is seen in that stack wherever it was, for HDF5 takes what cannot be
// looked up for what is not there, and where `status` is a failure in errno too: then the end
// returns LD_ERR_MEMORY in place of `status`.
typedef struct hdf5_quiet {
    H5E_auto2_t function;
    void *data;
} hdf5_quiet;

hdf5_quiet hdf5_quiet_begin(void);
ld_status hdf5_quiet_end(const hdf5_quiet *quiet, ld_status status, ld_error *error);

// Opens a file to be read: its bytes are read at once, so that what the system refuses is known
// here. -1 also where it links to other files.
hid_t hdf5_open(const char *path);
// A dataset to be read; -1 also where its numbers lie in other files.
hid_t hdf5_open_dataset(hid_t group, const char *name);

// `status` with "cannot `what` `path`: reason", the reason from HDF5's error stack.
ld_status hdf5_failed(ld_error *error, ld_status status, const char *what, const char *path);

// A new file, in place of one that is there.
hid_t hdf5_create_file(const char *path);
// A group whose members keep the order in which they were made.
hid_t hdf5_create_group(hid_t parent, const char *name);
// An array of fixed size; one that is written in one piece and has a checksum.
hid_t hdf5_create_dataset(hid_t group, const char *name, hid_t type, int rank, const hsize_t *size);
hid_t hdf5_create_piece(hid_t group, const char *name, hid_t type, int rank, const hsize_t *size);
// UTF-8 text of so many bytes, to be closed: padded by zeros, which no text ends with; an empty one
// is a single zero.
hid_t hdf5_string_type(size_t length);

// Attributes of an open object: integer, double.
bool hdf5_write_integer(hid_t object, const char *name, int value);
bool hdf5_write_number(hid_t object, const char *name, double value);

// Dimension scales (HDF5's high-level specification; netCDF-4's coordinate variables, by which
// xarray opens a file): the dataset becomes the scale of that name; the one dimension of the
// dataset has this scale. The scale has no REFERENCE_LIST: netCDF-4 requires none.
bool hdf5_make_scale(hid_t dataset, const char *name);
bool hdf5_set_scale(hid_t dataset, hid_t scale);

// UTF-8 text of fixed length, since HDF5 crashes on damage to those of variable length: an
// attribute, or a dataset of one with an attribute `name` (NULL: without), its own scale.
bool hdf5_write_string(hid_t object, const char *name, const char *text);
bool hdf5_write_document(hid_t group, const char *key, const char *name, const char *text,
                         size_t length);
// Read back, new; NULL: there is none. Attributes may be of variable length, too.
char *hdf5_read_string(hid_t object, const char *name);
char *hdf5_read_document(hid_t group, const char *key, char **name, size_t *length);

// A number read back, NaN where there is none.
double hdf5_read_number(hid_t object, const char *name);

// origin_hdf5.c: the groups program and source and the text scenario of an open file.
bool origin_write_hdf5(hid_t file, const ld_origin *origin);

#endif
