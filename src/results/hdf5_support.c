#include "results/hdf5_support.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text_file.h"

// Why calls have failed since hdf5_quiet_begin().
static struct {
    bool memory;    // for want of it
    int number;     // the system's error number, where one is named; the first
    char text[128]; // of the latest: the innermost entry of the error stack
} why;

static herr_t see_entry(unsigned depth, const H5E_error2_t *entry, void *unused)
{
    (void)unused;
    const char *number = entry->desc ? strstr(entry->desc, "errno = ") : NULL;
    why.memory |= entry->maj_num == H5E_RESOURCE || entry->min_num == H5E_CANTALLOC;
    if (number && !why.number)
        sscanf(number, "errno = %d", &why.number); // NOLINT(cert-err34-c): written by HDF5
    if (depth == 0 && entry->desc)
        snprintf(why.text, sizeof why.text, "%s", entry->desc);
    return 0;
}

// Called by HDF5 where a call fails. Without memory it may have none for the entries either.
static herr_t see_failure(hid_t stack, void *unused)
{
    why.memory |= errno == ENOMEM;
    return H5Ewalk2(stack, H5E_WALK_UPWARD, see_entry, unused);
}

// Whether what has failed since hdf5_quiet_begin() did so for want of memory. Where nothing has
// failed the error number says nothing: memory may have been refused in one place and found in
// another.
static bool lacks_memory(void)
{
    return why.memory || errno == ENOMEM;
}

hdf5_quiet hdf5_quiet_begin(void)
{
    hdf5_quiet quiet = {0};
    // before its first work: what a full disk leaves open is not closed again at the program's end,
    // where the library crashes on it; what is to be kept has been closed by hand
    H5dont_atexit();
    memset(&why, 0, sizeof why);
    errno = 0;
    why.memory = H5Eget_auto2(H5E_DEFAULT, &quiet.function, &quiet.data) < 0; // it cannot begin
    H5Eset_auto2(H5E_DEFAULT, see_failure, NULL);
    return quiet;
}

ld_status hdf5_quiet_end(const hdf5_quiet *quiet, ld_status status, ld_error *error)
{
    const bool memory = why.memory || (status && lacks_memory());
    H5Eset_auto2(H5E_DEFAULT, quiet->function, quiet->data);
    if (memory && status != LD_ERR_MEMORY)
        return ld_fail(error, LD_ERR_MEMORY, "HDF5 has no memory");
    return status;
}

// Files that lead to others are none of ours, and what those hold is not of this run.
static hid_t leads_away(void)
{
    snprintf(why.text, sizeof why.text, "it links to other files");
    return -1;
}

static herr_t see_link(hid_t group, const char *name, const H5L_info_t *info, void *unused)
{
    (void)group, (void)name, (void)unused;
    return info->type != H5L_TYPE_HARD;
}

hid_t hdf5_open(const char *path)
{
    enum { STEP = 1 << 20 };
    // HDF5 does not say why a file cannot be opened in this way
    int there = open(path, O_RDONLY | O_CLOEXEC);
    if (there < 0) {
        why.number = errno;
        return -1;
    }
    close(there);
    hid_t properties = H5Pcreate(H5P_FILE_ACCESS);
    bool fine = H5Pset_fapl_core(properties, STEP, false) >= 0;
    hid_t file = fine ? H5Fopen(path, H5F_ACC_RDONLY, properties) : -1;
    H5Pclose(properties);
    if (file >= 0 && H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, see_link, NULL) > 0) {
        H5Fclose(file);
        return leads_away();
    }
    return file;
}

hid_t hdf5_open_dataset(hid_t group, const char *name)
{
    hid_t dataset = H5Dopen2(group, name, H5P_DEFAULT);
    if (dataset < 0)
        return -1;
    hid_t properties = H5Dget_create_plist(dataset);
    bool elsewhere =
        H5Pget_external_count(properties) > 0 || H5Pget_layout(properties) == H5D_VIRTUAL;
    H5Pclose(properties);
    if (!elsewhere)
        return dataset;
    H5Dclose(dataset);
    return leads_away();
}

ld_status hdf5_failed(ld_error *error, ld_status status, const char *what, const char *path)
{
    if (lacks_memory())
        return ld_fail(error, LD_ERR_MEMORY, "cannot %s %s: HDF5 has no memory", what, path);
    if (why.number && status == LD_ERR_INPUT)
        status = text_file_status(why.number);
    if (why.number)
        return ld_fail(error, status, "cannot %s %s: %s", what, path, strerror(why.number));
    if (strcmp(why.text, "unable to open file") == 0)
        status = LD_ERR_FILE;
    return ld_fail(error, status, "cannot %s %s: %s", what, path,
                   why.text[0] ? why.text : "HDF5 gives no reason");
}

hid_t hdf5_create_file(const char *path)
{
    // this form of the file has checksums on its own structures, too; a later one cannot be read
    // where the program was killed
    hid_t properties = H5Pcreate(H5P_FILE_ACCESS), root = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_libver_bounds(properties, H5F_LIBVER_V18, H5F_LIBVER_V18);
    H5Pset_attr_phase_change(root, 0, 0); // a title may be longer than 64 kB
    H5Pset_obj_track_times(root, false);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, root, properties);
    H5Pclose(root);
    H5Pclose(properties);
    return file;
}

hid_t hdf5_create_group(hid_t parent, const char *name)
{
    hid_t properties = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_link_creation_order(properties, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    H5Pset_obj_track_times(properties, false);
    hid_t group = H5Gcreate2(parent, name, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    return group;
}

static hid_t create_dataset(hid_t group, const char *name, hid_t type, int rank,
                            const hsize_t *size, bool checked)
{
    hid_t space = H5Screate_simple(rank, size, NULL);
    hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(properties, false);
    if (checked && H5Sget_simple_extent_npoints(space) > 0) {
        H5Pset_chunk(properties, rank, size);
        H5Pset_fletcher32(properties);
    }
    hid_t dataset = H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    H5Sclose(space);
    return dataset;
}

hid_t hdf5_create_dataset(hid_t group, const char *name, hid_t type, int rank, const hsize_t *size)
{
    return create_dataset(group, name, type, rank, size, false);
}

hid_t hdf5_create_piece(hid_t group, const char *name, hid_t type, int rank, const hsize_t *size)
{
    return create_dataset(group, name, type, rank, size, true);
}

static bool write_attribute(hid_t object, const char *name, hid_t type, const void *value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool fine = attribute >= 0 && H5Awrite(attribute, type, value) >= 0;
    fine = attribute >= 0 && H5Aclose(attribute) >= 0 && fine;
    H5Sclose(space);
    return fine;
}

bool hdf5_write_integer(hid_t object, const char *name, int value)
{
    return write_attribute(object, name, H5T_NATIVE_INT, &value);
}

bool hdf5_write_number(hid_t object, const char *name, double value)
{
    return write_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}

// One value: there is room for no more.
static bool read_attribute(hid_t object, const char *name, hid_t type, void *value)
{
    hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0)
        return false;
    hid_t space = H5Aget_space(attribute);
    bool fine = H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, type, value) >= 0;
    H5Sclose(space);
    H5Aclose(attribute);
    return fine;
}

double hdf5_read_number(hid_t object, const char *name)
{
    double value = NAN;
    return read_attribute(object, name, H5T_NATIVE_DOUBLE, &value) ? value : NAN;
}

hid_t hdf5_string_type(size_t length)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, length > 0 ? length : 1);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

// Both attributes are ASCII with a zero at the end, or they are none of a scale.
static bool write_ascii(hid_t object, const char *name, const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    bool fine =
        H5Tset_size(type, strlen(text) + 1) >= 0 && write_attribute(object, name, type, text);
    H5Tclose(type);
    return fine;
}

bool hdf5_make_scale(hid_t dataset, const char *name)
{
    return write_ascii(dataset, "CLASS", "DIMENSION_SCALE") && write_ascii(dataset, "NAME", name);
}

bool hdf5_set_scale(hid_t dataset, hid_t scale)
{
    hsize_t one = 1;
    hobj_ref_t reference;
    hvl_t list = {.len = 1, .p = &reference};
    if (H5Rcreate(&reference, scale, ".", H5R_OBJECT, -1) < 0)
        return false;
    hid_t type = H5Tvlen_create(H5T_STD_REF_OBJ), space = H5Screate_simple(1, &one, NULL);
    hid_t attribute = H5Acreate2(dataset, "DIMENSION_LIST", type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool fine = attribute >= 0 && H5Awrite(attribute, type, &list) >= 0;
    fine = attribute >= 0 && H5Aclose(attribute) >= 0 && fine;
    H5Sclose(space);
    H5Tclose(type);
    return fine;
}

bool hdf5_write_string(hid_t object, const char *name, const char *text)
{
    hid_t type = hdf5_string_type(strlen(text));
    bool fine = write_attribute(object, name, type, text);
    H5Tclose(type);
    return fine;
}

bool hdf5_write_document(hid_t group, const char *key, const char *name, const char *text,
                         size_t length)
{
    hsize_t one = 1;
    hid_t type = hdf5_string_type(length);
    hid_t dataset = hdf5_create_piece(group, key, type, 1, &one);
    bool fine = dataset >= 0 && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0 &&
                hdf5_make_scale(dataset, key) &&
                (!name || hdf5_write_string(dataset, "name", name));
    fine = dataset >= 0 && H5Dclose(dataset) >= 0 && fine;
    H5Tclose(type);
    return fine;
}

enum { LONGEST_STRING = 1 << 28 };

// Room for one of this type and a zero after it; NULL: it is not text of fixed length.
static char *room_for(hid_t type, hid_t space)
{
    bool fine = type >= 0 && space >= 0 && H5Tget_class(type) == H5T_STRING &&
                H5Tis_variable_str(type) == 0 && H5Tget_size(type) <= LONGEST_STRING &&
                H5Sget_simple_extent_npoints(space) == 1;
    return fine ? calloc(H5Tget_size(type) + 1, 1) : NULL;
}

// A text of variable length, as earlier versions wrote attributes.
static char *read_variable(hid_t attribute)
{
    char *text = NULL;
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    bool fine = H5Aread(attribute, type, &text) >= 0 && text;
    H5Tclose(type);
    char *copy = fine ? strdup(text) : NULL;
    if (fine)
        H5free_memory(text);
    return copy;
}

char *hdf5_read_string(hid_t object, const char *name)
{
    hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0)
        return NULL;
    hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
    if (type >= 0 && H5Tis_variable_str(type) > 0) {
        char *variable = read_variable(attribute);
        H5Sclose(space);
        H5Tclose(type);
        H5Aclose(attribute);
        return variable;
    }
    char *text = room_for(type, space);
    if (text && H5Aread(attribute, type, text) < 0) {
        free(text);
        text = NULL;
    }
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(attribute);
    return text;
}

// The text of an open dataset.
static char *read_dataset(hid_t dataset, size_t *length)
{
    hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
    char *text = room_for(type, space);
    if (text && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) < 0) {
        free(text);
        text = NULL;
    }
    *length = text ? H5Tget_size(type) : 0;
    while (*length > 0 && text[*length - 1] == '\0')
        --*length;
    H5Sclose(space);
    H5Tclose(type);
    return text;
}

char *hdf5_read_document(hid_t group, const char *key, char **name, size_t *length)
{
    hid_t dataset = H5Lexists(group, key, H5P_DEFAULT) > 0 ? hdf5_open_dataset(group, key) : -1;
    if (dataset < 0)
        return NULL;
    char *text = read_dataset(dataset, length);
    if (name)
        *name = hdf5_read_string(dataset, "name");
    H5Dclose(dataset);
    return text;
}
