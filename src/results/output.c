#include "launchdyn/output.h"
#include "model/parts.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/child.h"
#include "base/lock_file.h"
#include "results/folder.h"
#include "results/history.h"
#include "results/kml.h"
#include "results/manifest.h"
#include "results/summary_json.h"

// Files of a results folder, in the order in which they get their names: summary.json comes last,
// so that where it stands the others belong to it.
enum { MOST_FLIGHT_COLUMNS = 256 };
enum { SUMMARY = MANIFEST_FILES, FILES };

// Which file of the file system a temporary name stands for.
typedef struct file_identity {
    bool made;
    dev_t device;
    ino_t number;
} file_identity;

struct ld_output {
    const ld_model *model;
    char *folder;
    size_t made_from; // length of the folder's part that was there before
    char *lock_path;  // history.lock, there while the folder is written
    int lock;         // its descriptor; -1: not locked
    bool begun;       // what lies there under temporary names is of this run
    char *path[FILES], *part[FILES];
    file_identity made[FILES]; // under part[]
    char *report;              // what launchdyn report made of an earlier run
    history_hdf5 *hdf5;
    history_csv *csv;     // NULL: not requested
    history_csv *flights; // NULL: not requested, or none has flown on
    kml_file *map;        // NULL: no place on the Earth is given, or none has flown on
    double flying;        // number of the rocket whose flight's rows come; 0: the launcher's
    ld_sink sink;
};

static bool identify(const char *path, file_identity *found)
{
    struct stat about;
    *found = (file_identity){0};
    if (stat(path, &about) != 0)
        return false;
    *found = (file_identity){true, about.st_dev, about.st_ino};
    return true;
}

// Marks a file that this run has just made, where `status` is LD_OK.
static ld_status mark_made(ld_output *output, int file, ld_status status, ld_error *error)
{
    if (!status && !identify(output->part[file], &output->made[file]))
        return ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", output->part[file],
                       strerror(errno));
    return status;
}

// The rows that follow are of the flight of this rocket: a line of the map, where there is one.
static ld_status begin_line(ld_output *output, int rocket, const ld_column *columns, size_t count,
                            ld_error *error)
{
    if (!kml_has_place(output->model))
        return LD_OK;
    ld_status status = LD_OK;
    if (!output->map) {
        status = kml_create(output->part[MANIFEST_MAP], output->model, &output->map, error);
        status = mark_made(output, MANIFEST_MAP, status, error);
    }
    return status ? status : kml_flight(output->map, rocket, columns, count, error);
}

static ld_status geometry(void *self, const ld_array *arrays, size_t count, ld_error *error)
{
    ld_output *output = self;
    return history_hdf5_geometry(output->hdf5, arrays, count, error);
}

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    ld_output *output = self;
    ld_status status = history_hdf5_begin(output->hdf5, columns, count, error);
    if (!status && output->csv)
        status = history_csv_begin(output->csv, columns, count, error);
    if (!status && !model_has_launcher(output->model))
        status = begin_line(output, 1, columns, count, error);
    return status;
}

// Rows of all flights go into one file, with the rocket's number before them.
static ld_status begin_flights(ld_output *output, const ld_column *columns, size_t count,
                               ld_error *error)
{
    ld_column *with_number = malloc((count + 1) * sizeof *with_number);
    if (!with_number)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the results");
    with_number[0] = (ld_column){"rocket", "1", "number in the order of firing"};
    memcpy(with_number + 1, columns, count * sizeof *columns);
    ld_status status = history_csv_create(output->part[MANIFEST_FLIGHTS], &output->flights, error);
    status = mark_made(output, MANIFEST_FLIGHTS, status, error);
    if (!status)
        status = history_csv_begin(output->flights, with_number, count + 1, error);
    free(with_number);
    return status;
}

static ld_status flight(void *self, int rocket, const ld_column *columns, size_t count,
                        ld_error *error)
{
    ld_output *output = self;
    output->flying = rocket;
    ld_status status = history_hdf5_flight(output->hdf5, rocket, columns, count, error);
    if (!status && output->csv && !output->flights)
        status = begin_flights(output, columns, count, error);
    return status ? status : begin_line(output, rocket, columns, count, error);
}

static ld_status csv_flight_row(ld_output *output, const double *values, size_t count,
                                ld_error *error)
{
    double with_number[MOST_FLIGHT_COLUMNS] = {output->flying};
    if (count + 1 > MOST_FLIGHT_COLUMNS)
        return ld_fail(error, LD_ERR_INPUT, "a flight has at most %d columns",
                       MOST_FLIGHT_COLUMNS - 1);
    memcpy(with_number + 1, values, count * sizeof *values);
    return history_csv_row(output->flights, with_number, count + 1, error);
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    ld_output *output = self;
    ld_status status = history_hdf5_row(output->hdf5, values, error);
    if (!status && output->csv && output->flying > 0)
        status = csv_flight_row(output, values, count, error);
    else if (!status && output->csv)
        status = history_csv_row(output->csv, values, count, error);
    if (!status && output->map)
        status = kml_row(output->map, values, error);
    return status;
}

static char *join(const char *folder, const char *name, const char *ending)
{
    size_t size = strlen(folder) + strlen(name) + strlen(ending) + 2;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s/%s%s", folder, name, ending);
    return path;
}

static ld_status set_paths(ld_output *output, const char *folder, ld_error *error)
{
    bool fine = (output->folder = strdup(folder)) != NULL;
    for (int i = 0; fine && i < FILES; i++) {
        const char *name = i == SUMMARY ? "summary.json" : manifest_name[i];
        output->path[i] = join(folder, name, "");
        output->part[i] = join(folder, name, ".part");
        fine = output->path[i] && output->part[i];
    }
    fine = fine && (output->report = join(folder, "report.html", "")) != NULL;
    fine = fine && (output->lock_path = join(folder, "history.lock", "")) != NULL;
    if (!fine)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the results");
    return LD_OK;
}

static ld_status take_away(const char *path, ld_error *error)
{
    if (unlink(path) != 0 && errno != ENOENT)
        return ld_fail(error, LD_ERR_FILE, "cannot replace %s: %s", path, strerror(errno));
    return LD_OK;
}

// Of an earlier run that was killed: they are not this one's.
static ld_status take_parts_away(ld_output *output, ld_error *error)
{
    ld_status status = LD_OK;
    for (int i = 0; i < FILES && !status; i++)
        status = take_away(output->part[i], error);
    return status;
}

static void free_output(ld_output *output)
{
    for (int i = 0; i < FILES; i++) {
        if (output->part[i])
            child_wrote(output->part[i]);
        free(output->path[i]);
        free(output->part[i]);
    }
    lock_file_remove(output->lock_path, output->lock);
    child_locks(NULL);
    free(output->report);
    free(output->lock_path);
    free(output->folder);
    free(output);
}

// Makes the folder, and locks it where its file system has locks.
static ld_status make_and_lock(ld_output *output, ld_error *error)
{
    ld_status status = folder_make(output->folder, &output->made_from, error);
    if (!status)
        status = lock_file_take(output->lock_path, output->folder, &output->lock, error);
    return status == LD_ERR_MISSING ? LD_OK : status;
}

// The run before may have removed the folder that it had made, as it failed.
static ld_status begin_folder(ld_output *output, ld_error *error)
{
    ld_status status = make_and_lock(output, error);
    if (status == LD_ERR_FILE && access(output->folder, F_OK) != 0 && errno == ENOENT)
        status = make_and_lock(output, error);
    if (status)
        return status;
    output->begun = true;
    child_locks(output->lock < 0 ? NULL : output->lock_path);
    for (int i = 0; i < FILES; i++)
        child_writes(output->part[i]);
    return take_parts_away(output, error);
}

static ld_status create_hdf5(ld_output *output, ld_error *error)
{
    const char *title = model_title(output->model);
    ld_origin origin;
    ld_status status =
        history_hdf5_create(output->part[MANIFEST_HDF5], title ? title : "", &output->hdf5, error);
    status = mark_made(output, MANIFEST_HDF5, status, error);
    if (!status)
        status = ld_origin_of(output->model, &origin, error);
    if (status)
        return status;
    status = history_hdf5_origin(output->hdf5, &origin, error);
    ld_origin_free(&origin);
    return status;
}

ld_status ld_output_open(const char *folder, const ld_model *model, bool csv, ld_output **output,
                         ld_error *error)
{
    assert(folder && model && output);
    if (!*folder)
        return ld_fail(error, LD_ERR_INPUT, "the results need the name of a folder");
    ld_output *opened = calloc(1, sizeof *opened);
    if (!opened)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the results");
    opened->model = model;
    opened->lock = -1;
    opened->sink = (ld_sink){
        .self = opened, .begin = begin, .row = row, .flight = flight, .geometry = geometry};
    ld_status status = set_paths(opened, folder, error);
    if (!status)
        status = begin_folder(opened, error);
    if (!status)
        status = create_hdf5(opened, error);
    if (!status && csv) {
        status = history_csv_create(opened->part[MANIFEST_CSV], &opened->csv, error);
        status = mark_made(opened, MANIFEST_CSV, status, error);
    }
    if (status)
        ld_output_discard(opened);
    else
        *output = opened;
    return status;
}

const ld_sink *ld_output_sink(ld_output *output)
{
    return &output->sink;
}

static ld_status first_failure(ld_status before, ld_status after)
{
    return before ? before : after;
}

// Closes the histories; `summary` NULL: they are not requested any more.
static ld_status close_histories(ld_output *output, const ld_summary *summary, ld_error *error)
{
    ld_status status = LD_OK;
    if (output->csv)
        status = first_failure(status, history_csv_close(output->csv, status ? NULL : error));
    if (output->flights)
        status = first_failure(status, history_csv_close(output->flights, status ? NULL : error));
    if (output->map)
        status = first_failure(status, kml_close(output->map, status ? NULL : error));
    if (output->hdf5)
        status =
            first_failure(status, history_hdf5_close(output->hdf5, summary, status ? NULL : error));
    output->csv = output->flights = NULL;
    output->map = NULL;
    output->hdf5 = NULL;
    return status;
}

// Takes an earlier run's summary and report away, and the files that this run does not have, then
// gives every file its name.
static ld_status put_in_place(ld_output *output, ld_error *error)
{
    ld_status status = take_away(output->path[SUMMARY], error);
    if (!status)
        status = take_away(output->report, error);
    for (int i = 0; i < FILES && !status; i++)
        if (!output->made[i].made)
            status = take_away(output->path[i], error);
    for (int i = 0; i < FILES && !status; i++)
        if (output->made[i].made && rename(output->part[i], output->path[i]) != 0)
            status = ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", output->path[i],
                             strerror(errno));
    return status;
}

// Size and digest of a file of this run, which no one has removed or replaced meanwhile.
static ld_status measure_made(const ld_output *output, int file, manifest_file *found,
                              ld_error *error)
{
    file_identity now;
    ld_error problem;
    const char *part = output->part[file];
    *found = (manifest_file){0};
    if (!output->made[file].made)
        return LD_OK;
    if (!identify(part, &now) || now.device != output->made[file].device ||
        now.number != output->made[file].number)
        return ld_fail(error, LD_ERR_FILE,
                       "cannot write %s: another program has removed %s while the run wrote it",
                       output->path[file], part);
    if (manifest_measure(part, found, &problem))
        return ld_fail(error, LD_ERR_FILE, "%s %s", part, problem.text);
    return LD_OK;
}

// The summary, with sizes and digests of the others, which are whole.
static ld_status write_summary(ld_output *output, const ld_summary *summary, ld_error *error)
{
    manifest_file file[MANIFEST_FILES];
    ld_status status = LD_OK;
    for (int i = 0; i < MANIFEST_FILES && !status; i++)
        status = measure_made(output, i, &file[i], error);
    if (!status)
        status = summary_write(output->part[SUMMARY], output->model, summary, file, error);
    return mark_made(output, SUMMARY, status, error);
}

ld_status ld_output_finish(ld_output *output, const ld_summary *summary, ld_error *error)
{
    assert(output && summary);
    ld_status status = close_histories(output, summary, error);
    if (!status)
        status = write_summary(output, summary, error);
    if (!status)
        status = put_in_place(output, error);
    if (status)
        ld_output_discard(output);
    else
        free_output(output);
    return status;
}

void ld_output_discard(ld_output *output)
{
    if (!output)
        return;
    close_histories(output, NULL, NULL);
    for (int i = 0; i < FILES && output->begun; i++)
        unlink(output->part[i]);
    lock_file_remove(output->lock_path, output->lock);
    output->lock = -1;
    if (output->folder)
        folder_remove(output->folder, output->made_from);
    free_output(output);
}
