// Where a run comes from, in its history.h5 and read back from it.
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/child.h"
#include "model/fields/source.h"
#include "results/hdf5_support.h"
#include "results/manifest.h"
#include "results/origin.h"

// ---- writing

// A group whose attributes keep the order in which they were made.
static hid_t create_program(hid_t file)
{
    hid_t properties = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_attr_creation_order(properties, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    H5Pset_obj_track_times(properties, false);
    hid_t group = H5Gcreate2(file, "program", H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    return group;
}

static bool write_program(hid_t file, const ld_origin *origin)
{
    hid_t group = create_program(file);
    bool fine = group >= 0;
    for (size_t i = 0; fine && i < origin->fact_count; i++)
        fine = hdf5_write_string(group, origin->fact[i].name, origin->fact[i].text);
    return group >= 0 && H5Gclose(group) >= 0 && fine;
}

// Texts by their numbers from 1.
static const char *number_text(size_t number, char text[24])
{
    snprintf(text, 24, "%zu", number);
    return text;
}

static bool write_files(hid_t group, const ld_source *source)
{
    char number[24];
    bool fine = group >= 0;
    for (size_t i = 0; fine && i < source->file_count; i++)
        fine = hdf5_write_document(group, number_text(i + 1, number), source->file[i]->name,
                                   source->file[i]->text, source->file[i]->length);
    return group >= 0 && H5Gclose(group) >= 0 && fine;
}

static bool write_sets(hid_t group, const ld_source *source)
{
    char number[24];
    bool fine = group >= 0;
    for (size_t i = 0; fine && i < source->set_count; i++)
        fine = hdf5_write_document(group, number_text(i + 1, number), NULL, source->set[i],
                                   strlen(source->set[i]));
    return group >= 0 && H5Gclose(group) >= 0 && fine;
}

static bool write_source(hid_t file, const ld_origin *origin)
{
    hid_t group = hdf5_create_group(file, "source");
    bool fine = group >= 0 && hdf5_write_integer(group, "point", origin->point) &&
                hdf5_write_integer(group, "sample", origin->sample) &&
                write_files(hdf5_create_group(group, "files"), origin->source) &&
                write_sets(hdf5_create_group(group, "set"), origin->source);
    return group >= 0 && H5Gclose(group) >= 0 && fine;
}

bool origin_write_hdf5(hid_t file, const ld_origin *origin)
{
    return write_program(file, origin) &&
           hdf5_write_document(file, "scenario", NULL, origin->scenario,
                               strlen(origin->scenario)) &&
           (!origin->source || write_source(file, origin));
}

// ---- reading

static herr_t read_fact(hid_t group, const char *name, const H5A_info_t *info, void *self)
{
    (void)info;
    char *text = hdf5_read_string(group, name);
    bool fine = text && origin_add_fact(self, name, text);
    free(text);
    return fine ? 0 : -1;
}

static hid_t open_group(hid_t parent, const char *name)
{
    return H5Lexists(parent, name, H5P_DEFAULT) > 0 ? H5Gopen2(parent, name, H5P_DEFAULT) : -1;
}

static bool read_program(hid_t file, ld_origin *origin)
{
    hid_t group = open_group(file, "program");
    bool fine = group >= 0 &&
                H5Aiterate2(group, H5_INDEX_CRT_ORDER, H5_ITER_INC, NULL, read_fact, origin) >= 0;
    if (group >= 0)
        H5Gclose(group);
    return fine;
}

// Hands the texts of a group to the source; there are at least `least`.
static bool read_texts(hid_t group, size_t least, ld_source *source, bool files)
{
    char number[24], *text;
    size_t length, count = 0;
    bool fine = group >= 0;
    for (;; count++) {
        char *name = NULL;
        text = fine ? hdf5_read_document(group, number_text(count + 1, number),
                                         files ? &name : NULL, &length)
                    : NULL;
        if (!text)
            break;
        if (files) {
            fine = source_add(source, name ? name : "", text, length) && name;
        } else {
            fine = source_add_set(source, text);
            free(text);
        }
        free(name);
    }
    H5G_info_t info = {0};
    fine = fine && H5Gget_info(group, &info) >= 0 && info.nlinks == count && count >= least;
    if (group >= 0)
        H5Gclose(group);
    return fine;
}

static bool read_source(hid_t file, ld_origin *origin)
{
    hid_t group = open_group(file, "source");
    if (group < 0)
        return false;
    double point = hdf5_read_number(group, "point"), sample = hdf5_read_number(group, "sample");
    bool fine = point >= 0 && point < 1e9 && sample >= 0 && sample < 1e9 &&
                (origin->source = source_new("", NULL)) != NULL &&
                read_texts(open_group(group, "files"), 1, origin->source, true) &&
                read_texts(open_group(group, "set"), 0, origin->source, false);
    H5Gclose(group);
    if (!fine)
        return false;
    origin->point = (int)point;
    origin->sample = (int)sample;
    free(origin->source->name);
    return (origin->source->name = strdup(origin->source->file[0]->name)) != NULL;
}

// Reads the file at `path`; nothing where it is of an earlier version.
static ld_status read_history(const char *path, ld_origin *origin, ld_error *error)
{
    size_t length;
    hid_t file = hdf5_open(path);
    if (file < 0)
        return hdf5_failed(error, LD_ERR_INPUT, "read", path);
    bool old = H5Lexists(file, "program", H5P_DEFAULT) == 0;
    bool fine = !old && read_program(file, origin) &&
                (origin->scenario = hdf5_read_document(file, "scenario", NULL, &length)) != NULL;
    bool by_hand = fine && H5Lexists(file, "source", H5P_DEFAULT) <= 0;
    fine = fine && (by_hand || read_source(file, origin));
    H5Fclose(file);
    return fine || old
               ? LD_OK
               : ld_fail(error, LD_ERR_INPUT,
                         "%.300s is damaged: the record of its scenario cannot be read", path);
}

ld_status origin_read_history(const char *path, ld_origin *origin, ld_error *error)
{
    *origin = (ld_origin){0};
    hdf5_quiet quiet = hdf5_quiet_begin();
    child_reads(path);
    ld_status status = read_history(path, origin, error);
    child_reads(NULL);
    status = hdf5_quiet_end(&quiet, status, error);
    if (status)
        ld_origin_free(origin);
    return status;
}

ld_status ld_origin_read(const char *folder, ld_origin *origin, ld_error *error)
{
    char path[4096];
    *origin = (ld_origin){0};
    ld_status status = manifest_check_history(folder, NULL, 0, error);
    if (status)
        return status;
    snprintf(path, sizeof path, "%.4000s/history.h5", folder);
    if (access(path, F_OK) != 0)
        snprintf(path, sizeof path, "%.4000s/history.h5.part", folder);
    if (access(path, F_OK) != 0)
        return ld_fail(error, LD_ERR_INPUT, "no results in %.300s: there is no history.h5", folder);
    status = origin_read_history(path, origin, error);
    if (!status && !origin->scenario)
        return ld_fail(error, LD_ERR_INPUT,
                       "%.300s has no record of its scenario: it is of an earlier version", path);
    return status;
}
