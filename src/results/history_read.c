#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/child.h"
#include "results/hdf5_support.h"
#include "results/history.h"

// Number of rows of a column, 0 if it is not a one-dimensional array.
static hsize_t count_rows(hid_t dataset)
{
    hid_t space = H5Dget_space(dataset);
    hsize_t rows = 0;
    if (space >= 0 && H5Sget_simple_extent_ndims(space) == 1)
        H5Sget_simple_extent_dims(space, &rows, NULL);
    H5Sclose(space);
    return rows;
}

static char *read_name(hid_t group, hsize_t index)
{
    ssize_t length = H5Lget_name_by_idx(group, ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, index, NULL, 0,
                                        H5P_DEFAULT);
    char *name = length > 0 ? malloc((size_t)length + 1) : NULL;
    if (name)
        H5Lget_name_by_idx(group, ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, index, name,
                           (size_t)length + 1, H5P_DEFAULT);
    return name;
}

// The first `rows` values of a column.
static bool read_values(hid_t dataset, hsize_t rows, double *values)
{
    hsize_t start = 0;
    hid_t memory = H5Screate_simple(1, &rows, NULL), space = H5Dget_space(dataset);
    bool fine = H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, NULL, &rows, NULL) >= 0 &&
                H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values) >= 0;
    H5Sclose(space);
    H5Sclose(memory);
    return fine;
}

// Rows that all columns have: a killed run may have written more of some of them.
static bool read_names(hid_t group, history_data *history)
{
    history->name = calloc(history->columns + 1, sizeof *history->name);
    history->unit = calloc(history->columns + 1, sizeof *history->unit);
    if (!history->name || !history->unit)
        return false;
    history->rows = SIZE_MAX;
    for (size_t i = 0; i < history->columns; i++) {
        history->name[i] = read_name(group, i);
        hid_t dataset = history->name[i] ? hdf5_open_dataset(group, history->name[i]) : -1;
        if (dataset < 0)
            return false;
        history->unit[i] = hdf5_read_string(dataset, "unit");
        if (!history->unit[i]) {
            H5Dclose(dataset);
            return false;
        }
        hsize_t rows = count_rows(dataset);
        history->rows = rows < history->rows ? (size_t)rows : history->rows;
        H5Dclose(dataset);
    }
    return true;
}

static bool read_columns(hid_t group, history_data *history)
{
    if (!read_names(group, history) || history->rows > SIZE_MAX / 16 / history->columns)
        return false;
    history->value = malloc((history->columns * history->rows + 1) * sizeof *history->value);
    bool fine = history->value != NULL;
    for (size_t i = 0; fine && i < history->columns; i++) {
        hid_t dataset = hdf5_open_dataset(group, history->name[i]);
        fine = read_values(dataset, history->rows, history->value + i * history->rows);
        H5Dclose(dataset);
    }
    return fine;
}

static void read_instants(hid_t rocket, history_data *history)
{
    history->t_ignition = hdf5_read_number(rocket, "t_ignition");
    history->t_release = hdf5_read_number(rocket, "t_release");
    history->t_front = hdf5_read_number(rocket, "t_front");
    history->t_middle = hdf5_read_number(rocket, "t_middle");
    history->t_rear = hdf5_read_number(rocket, "t_rear");
    history->t_apogee = hdf5_read_number(rocket, "t_apogee");
    history->t_impact = hdf5_read_number(rocket, "t_impact");
}

// Its tube and its place in the firing order.
static void read_place(hid_t rocket, int number, history_data *history)
{
    double tube = hdf5_read_number(rocket, "tube");
    history->tube = isfinite(tube) ? (int)tube : 0;
    history->number = number;
}

// The table in a group; none where the group is missing or empty.
static bool read_table(hid_t file, const char *name, history_data *history)
{
    H5G_info_t info = {0};
    htri_t there = H5Lexists(file, name, H5P_DEFAULT);
    if (there == 0)
        return true;
    hid_t group = there > 0 ? H5Gopen2(file, name, H5P_DEFAULT) : -1;
    if (group < 0)
        return false;
    bool fine = H5Gget_info(group, &info) >= 0;
    history->columns = (size_t)info.nlinks;
    if (fine && info.nlinks > 0)
        fine = read_columns(group, history);
    H5Gclose(group);
    return fine;
}

// Rows and columns of an array and its numbers.
static bool read_array(hid_t dataset, history_array *array)
{
    hsize_t size[2] = {0, 0};
    hid_t space = H5Dget_space(dataset);
    bool fine = space >= 0 && H5Sget_simple_extent_ndims(space) == 2;
    if (fine)
        H5Sget_simple_extent_dims(space, size, NULL);
    H5Sclose(space);
    fine = fine && size[0] < 1 << 20 && size[1] < 1 << 10;
    array->rows = (size_t)size[0];
    array->columns = (size_t)size[1];
    array->value = fine ? malloc((array->rows * array->columns + 1) * sizeof *array->value) : NULL;
    return array->value &&
           H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array->value) >= 0;
}

static bool read_arrays(hid_t group, history_data *history)
{
    H5G_info_t info = {0};
    bool fine = H5Gget_info(group, &info) >= 0;
    history->geometry = calloc((size_t)info.nlinks + 1, sizeof *history->geometry);
    fine = fine && history->geometry;
    for (hsize_t i = 0; fine && i < info.nlinks; i++) {
        history_array *array = &history->geometry[history->arrays++];
        array->name = read_name(group, i);
        hid_t dataset = array->name ? hdf5_open_dataset(group, array->name) : -1;
        fine = dataset >= 0 && read_array(dataset, array);
        if (dataset >= 0)
            H5Dclose(dataset);
    }
    return fine;
}

// None where the file is of a flight alone, or of a version that wrote none.
static bool read_geometry(hid_t file, history_data *history)
{
    htri_t there = H5Lexists(file, "geometry", H5P_DEFAULT);
    if (there == 0)
        return true;
    hid_t group = there > 0 ? H5Gopen2(file, "geometry", H5P_DEFAULT) : -1;
    bool fine = group >= 0 && read_arrays(group, history);
    if (group >= 0)
        H5Gclose(group);
    return fine;
}

// Whether there is a group rockets/N, which becomes *rocket; -1: it cannot be read.
static htri_t open_rocket(hid_t file, int number, hid_t *rocket)
{
    char name[32];
    snprintf(name, sizeof name, "rockets/%d", number);
    htri_t there = H5Lexists(file, "rockets", H5P_DEFAULT);
    if (there > 0)
        there = H5Lexists(file, name, H5P_DEFAULT);
    if (there <= 0)
        return there;
    *rocket = H5Gopen2(file, name, H5P_DEFAULT);
    return *rocket >= 0 ? 1 : -1;
}

// A flight alone: its rows are all the history there is.
static bool read_flight_alone(hid_t file, history_data *history)
{
    history_data *flight = &history->flight[0];
    flight->t_ignition = history->t_ignition;
    flight->t_release = history->t_release;
    flight->t_front = history->t_front;
    flight->t_middle = history->t_middle;
    flight->t_rear = history->t_rear;
    flight->t_apogee = history->t_apogee;
    flight->t_impact = history->t_impact;
    flight->number = 1;
    history->flights = 1;
    return read_table(file, "history", flight);
}

// The flights of the rockets, as far as they have rows.
static bool read_flights(hid_t file, history_data *history)
{
    bool fine = (history->flight = calloc(LD_MAX_FIRINGS, sizeof *history->flight)) != NULL;
    for (int number = 1; fine && number <= LD_MAX_FIRINGS; number++) {
        hid_t rocket;
        htri_t there = open_rocket(file, number, &rocket);
        if (there < 0)
            return false;
        if (there == 0)
            break;
        history_data *flight = &history->flight[history->flights++];
        read_instants(rocket, flight);
        fine = read_table(rocket, "flight", flight);
        read_place(rocket, number, flight);
        H5Gclose(rocket);
        if (fine && flight->rows == 0) {
            history_free(flight);
            history->flights--;
        }
    }
    if (fine && history->flights == 0 && history_column(history, "angle_of_attack"))
        fine = read_flight_alone(file, history);
    return fine;
}

// How many rockets the file tells of; -1: it cannot be read.
static int count_rockets(hid_t file)
{
    hid_t rocket;
    for (int number = 1; number <= LD_MAX_FIRINGS; number++) {
        htri_t there = open_rocket(file, number, &rocket);
        if (there <= 0)
            return there < 0 ? -1 : number - 1;
        H5Gclose(rocket);
    }
    return LD_MAX_FIRINGS;
}

// What to read from an open file.
typedef ld_status file_reader(hid_t file, const char *path, int number, history_data *history,
                              ld_error *error);

static ld_status read_launcher(hid_t file, const char *path, int number, history_data *history,
                               ld_error *error)
{
    double format = hdf5_read_number(file, "format");
    if (!(format >= 1 && format <= HISTORY_FORMAT))
        return ld_fail(error, LD_ERR_INPUT,
                       isnan(format) ? "%s is no history of a run, or is damaged"
                                     : "%s is of a later version of launchdyn",
                       path);
    history->title = hdf5_read_string(file, "title");
    history->stopped = hdf5_read_string(file, "stopped");
    if (!history->title)
        return hdf5_failed(error, LD_ERR_INPUT, "read", path);
    history->complete = hdf5_read_number(file, "complete") > 0;
    hid_t rocket = -1;
    htri_t there = open_rocket(file, number, &rocket);
    read_instants(rocket, history);
    if (there > 0)
        H5Gclose(rocket);
    history->rockets = count_rockets(file);
    if (there < 0 || history->rockets < 0 || !read_table(file, "history", history) ||
        !read_flights(file, history) || !read_geometry(file, history))
        return hdf5_failed(error, LD_ERR_INPUT, "read", path);
    if (history->columns == 0 && history->flights == 0)
        return ld_fail(error, LD_ERR_INPUT, "%s holds no history", path);
    return LD_OK;
}

static ld_status read_rocket(hid_t file, const char *path, int number, history_data *history,
                             ld_error *error)
{
    hid_t rocket;
    if (open_rocket(file, number, &rocket) <= 0)
        return ld_fail(error, LD_ERR_INPUT, "%s holds no rocket %d", path, number);
    read_instants(rocket, history);
    read_place(rocket, number, history);
    H5Gclose(rocket);
    return LD_OK;
}

static ld_status read_file(const char *path, file_reader *read, int rocket, history_data *history,
                           ld_error *error)
{
    memset(history, 0, sizeof *history);
    hdf5_quiet quiet = hdf5_quiet_begin();
    child_reads(path);
    hid_t file = hdf5_open(path);
    ld_status status = LD_OK;
    if (file < 0) {
        status = hdf5_failed(error, LD_ERR_INPUT, "read", path);
    } else {
        status = read(file, path, rocket, history, error);
        H5Fclose(file);
    }
    child_reads(NULL);
    status = hdf5_quiet_end(&quiet, status, error);
    if (status)
        history_free(history);
    return status;
}

ld_status history_read(const char *path, history_data *history, ld_error *error)
{
    return read_file(path, read_launcher, 1, history, error);
}

ld_status history_read_rocket(const char *path, int rocket, history_data *history, ld_error *error)
{
    return read_file(path, read_rocket, rocket, history, error);
}

void history_free(history_data *history)
{
    for (size_t i = 0; history->name && i < history->columns; i++)
        free(history->name[i]);
    for (size_t i = 0; i < history->flights; i++)
        history_free(&history->flight[i]);
    free(history->flight);
    for (size_t i = 0; i < history->arrays; i++) {
        free(history->geometry[i].name);
        free(history->geometry[i].value);
    }
    free(history->geometry);
    for (size_t i = 0; history->unit && i < history->columns; i++)
        free(history->unit[i]);
    free(history->name);
    free(history->unit);
    free(history->value);
    free(history->title);
    free(history->stopped);
    memset(history, 0, sizeof *history);
}

const history_array *history_array_named(const history_data *history, const char *name)
{
    for (size_t i = 0; i < history->arrays; i++)
        if (strcmp(history->geometry[i].name, name) == 0)
            return &history->geometry[i];
    return NULL;
}

const double *history_column(const history_data *history, const char *name)
{
    for (size_t i = 0; i < history->columns; i++)
        if (strcmp(history->name[i], name) == 0)
            return history->value + i * history->rows;
    return NULL;
}
