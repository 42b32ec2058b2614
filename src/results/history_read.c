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
        history->unit[i] = hdf5_read_string(dataset, "units");
        if (!history->unit[i]) // before format 3
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

// An attribute of a rocket that says when a parachute has opened.
static herr_t read_opening(hid_t rocket, const char *attribute, const H5A_info_t *unused,
                           void *into)
{
    static const char head[] = "parachute.", tail[] = ".t_open";
    history_data *history = into;
    size_t length = strlen(attribute), around = strlen(head) + strlen(tail);
    (void)unused;
    if (history->openings == LD_MAX_PARACHUTES || length <= around ||
        length - around >= LD_MAX_NAME || strncmp(attribute, head, strlen(head)) != 0 ||
        strcmp(attribute + length - strlen(tail), tail) != 0)
        return 0;
    history_opening *opening = &history->opening[history->openings++];
    snprintf(opening->name, sizeof opening->name, "%.*s", (int)(length - around),
             attribute + strlen(head));
    opening->t = hdf5_read_number(rocket, attribute);
    return 0;
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
    H5Aiterate2(rocket, H5_INDEX_NAME, H5_ITER_INC, NULL, read_opening, history);
}

// Instants, tube and place in the firing order.
static void read_rocket(hid_t rocket, int number, history_data *history)
{
    read_instants(rocket, history);
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

// What the file reports of each rocket, flown or not.
static bool read_rockets(hid_t file, history_data *history)
{
    hid_t rocket;
    htri_t there = 1;
    history->rocket = calloc(LD_MAX_FIRINGS, sizeof *history->rocket);
    if (!history->rocket)
        return false;
    while (there > 0 && history->rockets < LD_MAX_FIRINGS) {
        there = open_rocket(file, history->rockets + 1, &rocket);
        if (there <= 0)
            break;
        read_rocket(rocket, history->rockets + 1, &history->rocket[history->rockets]);
        history->rockets++;
        H5Gclose(rocket);
    }
    return there >= 0;
}

// The flights of the rockets, as far as they have rows; of a flight alone its rows are all the
// history there is.
static bool read_flights(hid_t file, history_data *history)
{
    bool fine = (history->flight = calloc(LD_MAX_FIRINGS, sizeof *history->flight)) != NULL;
    for (int i = 0; fine && i < history->rockets; i++) {
        char name[40];
        snprintf(name, sizeof name, "rockets/%d/flight", i + 1);
        history_data *flight = history_begin_flight(history, &history->rocket[i]);
        fine = read_table(file, name, flight);
        if (fine && flight->rows == 0) {
            history_free(flight);
            history->flights--;
        }
    }
    if (fine && history->flights == 0 && history_column(history, "angle_of_attack")) {
        history->number = 1;
        fine = read_table(file, "history", history_begin_flight(history, history));
    }
    return fine;
}

static ld_status read_launcher(hid_t file, const char *path, history_data *history, ld_error *error)
{
    double format = hdf5_read_number(file, "format");
    if (!(format >= 1 && format <= HISTORY_FORMAT))
        return ld_fail(error, LD_ERR_INPUT,
                       isnan(format) ? "%s is not a history of a run, or is damaged"
                                     : "%s is of a later version of launchdyn",
                       path);
    history->title = hdf5_read_string(file, "title");
    history->stopped = hdf5_read_string(file, "stopped");
    if (!history->title)
        return hdf5_failed(error, LD_ERR_INPUT, "read", path);
    history->complete = hdf5_read_number(file, "complete") > 0;
    hid_t rocket = -1;
    htri_t there = open_rocket(file, 1, &rocket);
    read_instants(rocket, history);
    if (there > 0)
        H5Gclose(rocket);
    if (there < 0 || !read_rockets(file, history) || !read_table(file, "history", history) ||
        !read_flights(file, history) || !read_geometry(file, history))
        return hdf5_failed(error, LD_ERR_INPUT, "read", path);
    if (history->columns == 0 && history->flights == 0)
        return ld_fail(error, LD_ERR_INPUT, "%s has no history", path);
    return LD_OK;
}

ld_status history_read(const char *path, history_data *history, ld_error *error)
{
    memset(history, 0, sizeof *history);
    hdf5_quiet quiet = hdf5_quiet_begin();
    child_reads(path);
    hid_t file = hdf5_open(path);
    ld_status status = LD_OK;
    if (file < 0) {
        status = hdf5_failed(error, LD_ERR_INPUT, "read", path);
    } else {
        status = read_launcher(file, path, history, error);
        H5Fclose(file);
    }
    child_reads(NULL);
    status = hdf5_quiet_end(&quiet, status, error);
    if (status)
        history_free(history);
    return status;
}
