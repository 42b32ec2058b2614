#include <hdf5.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/version.h"
#include "model/blocks/rocket.h"
#include "model/parts.h"
#include "results/hdf5_support.h"
#include "results/history.h"
#include "results/origin.h"

// Rows in a block and in a chunk of the file. A column of the block is a little longer than that,
// so that the columns do not fall on the same lines of the processor's cache.
enum { BLOCK = 1024, COLUMN = BLOCK + 8 };

struct history_hdf5 {
    char *path;
    hid_t file, group;
    size_t count;    // columns
    hid_t *dataset;  // [count]
    double *block;   // [count][COLUMN] rows not yet written
    size_t used;     // rows in the block
    hsize_t written; // rows in the file
};

static ld_status failed(const history_hdf5 *history, ld_error *error)
{
    return hdf5_failed(error, LD_ERR_FILE, "write", history->path);
}

static bool create_file(history_hdf5 *history, const char *title)
{
    history->file = hdf5_create_file(history->path);
    if (history->file < 0)
        return false;
    history->group = hdf5_create_group(history->file, "history");
    return history->group >= 0 && hdf5_write_integer(history->file, "format", HISTORY_FORMAT) &&
           hdf5_write_string(history->file, "title", title) &&
           hdf5_write_string(history->file, "version", LD_VERSION) &&
           hdf5_write_integer(history->file, "complete", 0);
}

// Ends the table whose rows were written; false where the last of it could not be.
static bool close_table(history_hdf5 *history)
{
    bool fine = true;
    for (size_t i = 0; i < history->count; i++)
        if (history->dataset[i] > 0)
            fine = H5Dclose(history->dataset[i]) >= 0 && fine;
    if (history->group > 0)
        fine = H5Gclose(history->group) >= 0 && fine;
    free(history->dataset);
    free(history->block);
    history->dataset = NULL;
    history->block = NULL;
    history->group = 0;
    history->count = history->used = 0;
    history->written = 0;
    return fine;
}

static bool close_file(history_hdf5 *history)
{
    bool fine = close_table(history);
    if (history->file > 0)
        fine = H5Fclose(history->file) >= 0 && fine;
    history->file = 0;
    return fine;
}

static void free_history(history_hdf5 *history)
{
    close_file(history);
    free(history->path);
    free(history);
}

ld_status history_hdf5_create(const char *path, const char *title, history_hdf5 **history,
                              ld_error *error)
{
    history_hdf5 *created = calloc(1, sizeof *created);
    if (!created || !(created->path = strdup(path))) {
        free(created);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the history");
    }
    hdf5_quiet quiet = hdf5_quiet_begin();
    ld_status status = create_file(created, title) ? LD_OK : failed(created, error);
    status = hdf5_quiet_end(&quiet, status, error);
    if (status)
        free_history(created);
    else
        *history = created;
    return status;
}

ld_status history_hdf5_origin(history_hdf5 *history, const ld_origin *origin, ld_error *error)
{
    hdf5_quiet quiet = hdf5_quiet_begin();
    ld_status status = origin_write_hdf5(history->file, origin) ? LD_OK : failed(history, error);
    return hdf5_quiet_end(&quiet, status, error);
}

// One array of doubles of fixed size with its unit and description.
static bool write_array(hid_t group, const ld_array *array)
{
    hsize_t size[2] = {array->rows, array->columns};
    hid_t dataset = hdf5_create_piece(group, array->name, H5T_NATIVE_DOUBLE, 2, size);
    bool fine =
        dataset >= 0 &&
        H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array->value) >= 0 &&
        hdf5_write_string(dataset, "units", array->unit) &&
        hdf5_write_string(dataset, "long_name", array->description);
    return dataset >= 0 && H5Dclose(dataset) >= 0 && fine;
}

static bool write_geometry(hid_t file, const ld_array *arrays, size_t count)
{
    hid_t group = hdf5_create_group(file, "geometry");
    bool fine = group >= 0;
    for (size_t i = 0; fine && i < count; i++)
        fine = write_array(group, &arrays[i]);
    return group >= 0 && H5Gclose(group) >= 0 && fine;
}

ld_status history_hdf5_geometry(history_hdf5 *history, const ld_array *arrays, size_t count,
                                ld_error *error)
{
    hdf5_quiet quiet = hdf5_quiet_begin();
    ld_status status =
        write_geometry(history->file, arrays, count) ? LD_OK : failed(history, error);
    return hdf5_quiet_end(&quiet, status, error);
}

// One extendible array of doubles with its unit and description.
static hid_t create_column(hid_t group, const ld_column *column, hid_t space, hid_t properties,
                           hid_t access)
{
    hid_t dataset =
        H5Dcreate2(group, column->name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, properties, access);
    if (dataset >= 0 && hdf5_write_string(dataset, "units", column->unit) &&
        hdf5_write_string(dataset, "long_name", column->description))
        return dataset;
    if (dataset >= 0)
        H5Dclose(dataset);
    return -1;
}

// The first column of a table over t is the scale of all.
static bool give_scale(const hid_t *dataset, const ld_column *columns, size_t i)
{
    if (strcmp(columns[0].name, "t") != 0)
        return true;
    return i == 0 ? hdf5_make_scale(dataset[0], "t") : hdf5_set_scale(dataset[i], dataset[0]);
}

static bool create_columns(history_hdf5 *history, const ld_column *columns, size_t count)
{
    hsize_t none = 0, unlimited = H5S_UNLIMITED, chunk = BLOCK;
    hid_t space = H5Screate_simple(1, &none, &unlimited);
    hid_t properties = H5Pcreate(H5P_DATASET_CREATE), access = H5Pcreate(H5P_DATASET_ACCESS);
    H5Pset_chunk(properties, 1, &chunk);
    H5Pset_fletcher32(properties);
    H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER);
    H5Pset_obj_track_times(properties, false);
    H5Pset_chunk_cache(access, 1, 0, 1); // a chunk is written once, and whole: none is kept
    bool fine = true;
    for (size_t i = 0; fine && i < count; i++) {
        history->dataset[i] = create_column(history->group, &columns[i], space, properties, access);
        fine = history->dataset[i] >= 0 && give_scale(history->dataset, columns, i);
    }
    H5Pclose(access);
    H5Pclose(properties);
    H5Sclose(space);
    return fine && H5Fflush(history->file, H5F_SCOPE_LOCAL) >= 0;
}

ld_status history_hdf5_begin(history_hdf5 *history, const ld_column *columns, size_t count,
                             ld_error *error)
{
    if (count == 0)
        return ld_fail(error, LD_ERR_INPUT, "a history needs columns");
    for (size_t i = 0; i < count; i++)
        if (!*columns[i].name || strchr(columns[i].name, '/'))
            return ld_fail(error, LD_ERR_INPUT, "\"%s\" cannot be the name of a column",
                           columns[i].name);
    history->count = count;
    history->dataset = calloc(count, sizeof *history->dataset);
    history->block = malloc(count * COLUMN * sizeof *history->block);
    if (!history->dataset || !history->block) {
        history->count = 0;
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the history");
    }
    hdf5_quiet quiet = hdf5_quiet_begin();
    ld_status status = create_columns(history, columns, count) ? LD_OK : failed(history, error);
    return hdf5_quiet_end(&quiet, status, error);
}

// Appends the block to every column and flushes, so that the file can be read if we are killed.
static bool write_block(history_hdf5 *history)
{
    hsize_t start = history->written, rows = history->used, size = start + rows;
    hid_t memory = H5Screate_simple(1, &rows, NULL);
    hid_t space = H5Screate_simple(1, &size, NULL);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, NULL, &rows, NULL);
    bool fine = memory >= 0 && space >= 0;
    for (size_t i = 0; fine && i < history->count; i++)
        fine = H5Dset_extent(history->dataset[i], &size) >= 0 &&
               H5Dwrite(history->dataset[i], H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT,
                        history->block + i * COLUMN) >= 0;
    H5Sclose(space);
    H5Sclose(memory);
    if (!fine || H5Fflush(history->file, H5F_SCOPE_LOCAL) < 0)
        return false;
    history->written = size;
    history->used = 0;
    return true;
}

static ld_status flush(history_hdf5 *history, ld_error *error)
{
    hdf5_quiet quiet = hdf5_quiet_begin();
    ld_status status = write_block(history) ? LD_OK : failed(history, error);
    return hdf5_quiet_end(&quiet, status, error);
}

ld_status history_hdf5_row(history_hdf5 *history, const double *values, ld_error *error)
{
    double *cell = history->block + history->used;
    for (size_t i = 0; i < history->count; i++)
        cell[i * COLUMN] = values[i];
    return ++history->used == BLOCK ? flush(history, error) : LD_OK;
}

// The group of that name, made where it is not there.
static hid_t open_group(hid_t parent, const char *name)
{
    return H5Lexists(parent, name, H5P_DEFAULT) > 0 ? H5Gopen2(parent, name, H5P_DEFAULT)
                                                    : hdf5_create_group(parent, name);
}

// The group of rocket number `rocket`, by its number in the order of firing.
static hid_t open_rocket(hid_t file, int rocket)
{
    char name[16];
    snprintf(name, sizeof name, "%d", rocket);
    hid_t rockets = open_group(file, "rockets");
    hid_t group = rockets >= 0 ? open_group(rockets, name) : -1;
    if (rockets >= 0)
        H5Gclose(rockets);
    return group;
}

static bool begin_flight(history_hdf5 *history, int rocket)
{
    if ((history->used > 0 && !write_block(history)) || !close_table(history))
        return false;
    hid_t group = open_rocket(history->file, rocket);
    if (group >= 0) {
        history->group = hdf5_create_group(group, "flight");
        H5Gclose(group);
    }
    return group >= 0 && history->group >= 0;
}

ld_status history_hdf5_flight(history_hdf5 *history, int rocket, const ld_column *columns,
                              size_t count, ld_error *error)
{
    hdf5_quiet quiet = hdf5_quiet_begin();
    ld_status status = begin_flight(history, rocket) ? LD_OK : failed(history, error);
    status = hdf5_quiet_end(&quiet, status, error);
    return status ? status : history_hdf5_begin(history, columns, count, error);
}

// When the parachutes of a rocket have opened, each under the name of that number of the summary.
static bool write_openings(hid_t group, const ld_model *model, const ld_rocket_summary *rocket)
{
    bool fine = true;
    int count = model && rocket->flown ? model_rocket(model)->parachute_count : 0;
    for (int i = 0; i < count && fine; i++) {
        char name[LD_MAX_NAME + 24];
        snprintf(name, sizeof name, "parachute.%s.t_open", model_rocket(model)->parachute[i].name);
        if (isfinite(rocket->parachute[i].t_open))
            fine = hdf5_write_number(group, name, rocket->parachute[i].t_open);
    }
    return fine;
}

// A group "rockets" with one group each.
static bool write_rockets(hid_t file, const ld_summary *summary)
{
    hid_t rockets = open_group(file, "rockets");
    bool fine = rockets >= 0;
    for (int i = 0; fine && i < summary->rocket_count; i++) {
        const ld_rocket_summary *rocket = &summary->rocket[i];
        hid_t group = open_rocket(file, i + 1);
        fine =
            group >= 0 && hdf5_write_integer(group, "tube", rocket->tube) &&
            hdf5_write_number(group, "t_ignition", rocket->t_ignition) &&
            hdf5_write_number(group, "t_release", rocket->t_release) &&
            hdf5_write_number(group, "t_front", rocket->t_front) &&
            hdf5_write_number(group, "t_middle", rocket->t_middle) &&
            hdf5_write_number(group, "t_rear", rocket->t_rear) &&
            hdf5_write_number(group, "t_apogee", rocket->flown ? rocket->flight.t_apogee : NAN) &&
            hdf5_write_number(group, "t_impact", rocket->flown ? rocket->flight.t_impact : NAN) &&
            write_openings(group, summary->model, rocket);
        H5Gclose(group);
    }
    if (rockets >= 0)
        H5Gclose(rockets);
    return fine;
}

static bool write_end(history_hdf5 *history, const ld_summary *summary)
{
    return (history->used == 0 || write_block(history)) &&
           (!summary ||
            (write_rockets(history->file, summary) && H5Adelete(history->file, "complete") >= 0 &&
             hdf5_write_integer(history->file, "complete", summary->complete) &&
             hdf5_write_string(history->file, "stopped", summary->stopped))) &&
           H5Fflush(history->file, H5F_SCOPE_LOCAL) >= 0;
}

ld_status history_hdf5_close(history_hdf5 *history, const ld_summary *summary, ld_error *error)
{
    hdf5_quiet quiet = hdf5_quiet_begin();
    bool fine = write_end(history, summary);
    ld_status status = fine && close_file(history) ? LD_OK : failed(history, error);
    free_history(history);
    return hdf5_quiet_end(&quiet, status, error);
}
