#include "io/hdf5_support.h"

#include <math.h>
#include <stdio.h>
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

ld_status hdf5_failed(ld_error *error, const char *what, const char *path)
{
    reason found = {0, "HDF5 failed"};
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find_reason, &found);
    return ld_fail(error, LD_ERR_FILE, "cannot %s %s: %s", what, path,
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
    hid_t space = H5Screate_simple(rank, size, NULL), properties = H5Pcreate(H5P_DATASET_CREATE);
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

static bool read_attribute(hid_t object, const char *name, hid_t type, void *value)
{
    hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    if (attribute < 0)
        return false;
    bool fine = H5Aread(attribute, type, value) >= 0;
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
