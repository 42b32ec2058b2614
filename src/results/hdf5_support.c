#include "results/hdf5_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

hdf5_quiet hdf5_quiet_begin(void)
{
    hdf5_quiet quiet;
    // before its first work: what a full disk leaves open is not closed again at the program's end,
    // where the library crashes on it; what is to be kept has been closed by hand
    H5dont_atexit();
    H5Eget_auto2(H5E_DEFAULT, &quiet.function, &quiet.data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return quiet;
}

void hdf5_quiet_end(const hdf5_quiet *quiet)
{
    H5Eset_auto2(H5E_DEFAULT, quiet->function, quiet->data);
}

// The innermost entry of the error stack, and the system's error number if one is named.
typedef struct reason {
    int number;
    char text[128];
} reason;

static herr_t find_reason(unsigned depth, const H5E_error2_t *entry, void *data)
{
    reason *found = data;
    const char *number = entry->desc ? strstr(entry->desc, "errno = ") : NULL;
    if (number && !found->number)
        sscanf(number, "errno = %d", &found->number); // NOLINT(cert-err34-c): written by HDF5
    if (depth == 0 && entry->desc)
        snprintf(found->text, sizeof found->text, "%s", entry->desc);
    return 0;
}

ld_status hdf5_failed(ld_error *error, ld_status status, const char *what, const char *path)
{
    reason found = {0, "HDF5 failed"};
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find_reason, &found);
    return ld_fail(error, status, "cannot %s %s: %s", what, path,
                   found.number ? strerror(found.number) : found.text);
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

hid_t hdf5_create_dataset(hid_t group, const char *name, hid_t type, int rank, const hsize_t *size)
{
    hid_t space = rank > 0 ? H5Screate_simple(rank, size, NULL) : H5Screate(H5S_SCALAR);
    hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(properties, false);
    hid_t dataset = H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    H5Sclose(space);
    return dataset;
}

hid_t hdf5_text_type(void)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

static bool write_attribute(hid_t object, const char *name, hid_t type, const void *value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool fine = attribute >= 0 && H5Awrite(attribute, type, value) >= 0;
    if (attribute >= 0)
        H5Aclose(attribute);
    H5Sclose(space);
    return fine;
}

bool hdf5_write_text(hid_t object, const char *name, const char *text)
{
    hid_t type = hdf5_text_type();
    bool fine = write_attribute(object, name, type, &text);
    H5Tclose(type);
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

char *hdf5_read_text(hid_t object, const char *name)
{
    char *text = NULL;
    hid_t type = hdf5_text_type();
    bool fine = read_attribute(object, name, type, &text);
    H5Tclose(type);
    char *copy = fine && text ? strdup(text) : NULL;
    if (fine && text)
        H5free_memory(text);
    return copy;
}

double hdf5_read_number(hid_t object, const char *name)
{
    double value = NAN;
    return read_attribute(object, name, H5T_NATIVE_DOUBLE, &value) ? value : NAN;
}

// Padded by zeros, which no text ends with; an empty one is a single zero.
static hid_t string_type(size_t length)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, length > 0 ? length : 1);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

bool hdf5_write_string(hid_t object, const char *name, const char *text)
{
    hid_t type = string_type(strlen(text));
    bool fine = write_attribute(object, name, type, text);
    H5Tclose(type);
    return fine;
}

bool hdf5_write_document(hid_t group, const char *key, const char *name, const char *text,
                         size_t length)
{
    hid_t type = string_type(length);
    hid_t dataset = hdf5_create_dataset(group, key, type, 0, NULL);
    bool fine = dataset >= 0 && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0 &&
                (!name || hdf5_write_string(dataset, "name", name));
    if (dataset >= 0)
        H5Dclose(dataset);
    H5Tclose(type);
    return fine;
}

enum { LONGEST_STRING = 1 << 28 };

// Room for a scalar of this type and a zero after it; NULL: it is no text of fixed length.
static char *room_for(hid_t type, hid_t space)
{
    bool fine = type >= 0 && space >= 0 && H5Tget_class(type) == H5T_STRING &&
                H5Tis_variable_str(type) == 0 && H5Tget_size(type) <= LONGEST_STRING &&
                H5Sget_simple_extent_npoints(space) == 1;
    return fine ? calloc(H5Tget_size(type) + 1, 1) : NULL;
}

char *hdf5_read_string(hid_t object, const char *name)
{
    hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0)
        return NULL;
    hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
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
    hid_t dataset = H5Lexists(group, key, H5P_DEFAULT) > 0 ? H5Dopen2(group, key, H5P_DEFAULT) : -1;
    if (dataset < 0)
        return NULL;
    char *text = read_dataset(dataset, length);
    if (name)
        *name = hdf5_read_string(dataset, "name");
    H5Dclose(dataset);
    return text;
}
