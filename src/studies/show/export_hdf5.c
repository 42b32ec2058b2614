#include "studies/show/export_hdf5.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "results/hdf5_support.h"
#include "studies/show/export_table.h"

enum { BLOCK = 1024, STATUS = 16 };

typedef struct hdf5_column {
    hid_t dataset, type; // type: one of the library's own, or `status`
    size_t size;         // of one cell
    char *block;         // [BLOCK] cells
} hdf5_column;

typedef struct hdf5_writer {
    export_table *table;
    hid_t file, group, status; // status: text of fixed size
    hdf5_column *column;       // [columns]; swept keys have none: see the group `points`
    ld_status read;            // what came of reading the rows
    ld_error *error;           // of that
} hdf5_writer;

static bool is_text_of_point(const export_table *table, int column)
{
    return column > EXPORT_KEYS && column < table->keys;
}

static bool create_file(hdf5_writer *self, const char *file)
{
    const study_data *data = self->table->data;
    self->file = hdf5_create_file(file);
    if (self->file < 0)
        return false;
    self->group = hdf5_create_group(self->file, "rockets");
    return self->group >= 0 && hdf5_write_integer(self->file, "format", 2) &&
           hdf5_write_string(self->file, "title", data->title) &&
           hdf5_write_string(self->file, "version", data->version) &&
           hdf5_write_string(self->file, "scenario", data->scenario) &&
           hdf5_write_integer(self->file, "strata", (int)data->strata);
}

static bool create_columns(hdf5_writer *self)
{
    const export_table *table = self->table;
    hsize_t rows = (hsize_t)table->data->rockets;
    for (int i = 0; i < table->columns; i++) {
        hdf5_column *column = &self->column[i];
        if (is_text_of_point(table, i))
            continue;
        bool text = i == EXPORT_KEYS - 1;
        column->type = text ? self->status : i < table->keys ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
        column->size = text ? STATUS : 8;
        column->block = calloc(BLOCK, column->size);
        const char *name = sqlite3_column_name(table->row, i);
        if (!column->block || !name) {
            self->read = ld_fail(self->error, LD_ERR_MEMORY, "no memory for the table");
            return false;
        }
        column->dataset = hdf5_create_dataset(self->group, name, column->type, 1, &rows);
        if (column->dataset < 0 ||
            !hdf5_write_string(column->dataset, "unit", export_unit(table, i)))
            return false;
    }
    return true;
}

static void fill_cell(const hdf5_writer *self, int i, size_t at)
{
    hdf5_column *column = &self->column[i];
    sqlite3_stmt *row = self->table->row;
    char *cell = column->block + at * column->size;
    if (column->type == H5T_NATIVE_INT64) {
        int64_t value = sqlite3_column_int64(row, i);
        memcpy(cell, &value, sizeof value);
    } else if (column->type == H5T_NATIVE_DOUBLE) {
        double value =
            sqlite3_column_type(row, i) == SQLITE_NULL ? NAN : sqlite3_column_double(row, i);
        memcpy(cell, &value, sizeof value);
    } else {
        const char *text = (const char *)sqlite3_column_text(row, i);
        memset(cell, 0, STATUS);
        if (text) // else no memory, which the next step reports
            memcpy(cell, text, strnlen(text, STATUS - 1));
    }
}

static bool write_block(const hdf5_writer *self, hsize_t start, hsize_t rows)
{
    bool fine = true;
    hid_t memory = H5Screate_simple(1, &rows, NULL);
    for (int i = 0; i < self->table->columns && fine; i++) {
        const hdf5_column *column = &self->column[i];
        if (!column->block)
            continue;
        hid_t space = H5Dget_space(column->dataset);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, NULL, &rows, NULL);
        fine =
            H5Dwrite(column->dataset, column->type, memory, space, H5P_DEFAULT, column->block) >= 0;
        H5Sclose(space);
    }
    H5Sclose(memory);
    return fine;
}

static bool write_rows(hdf5_writer *self)
{
    hsize_t written = 0, used = 0;
    bool fine = true, there = true;
    export_begin(self->table);
    while (fine && !(self->read = export_next(self->table, &there, self->error)) && there) {
        for (int i = 0; i < self->table->columns; i++)
            if (self->column[i].block)
                fill_cell(self, i, used);
        if (++used == BLOCK) {
            fine = write_block(self, written, used);
            written += used;
            used = 0;
        }
    }
    return fine && !self->read && (used == 0 || write_block(self, written, used));
}

// The texts of a swept key, as long as the longest.
static bool write_swept(hid_t group, const study_data *data, int key)
{
    size_t longest = 1;
    hsize_t points = (hsize_t)data->point_count;
    for (hsize_t i = 0; i < points; i++)
        if (strlen(data->point[i].text[key]) > longest)
            longest = strlen(data->point[i].text[key]);
    char *cells = calloc(points, longest);
    for (hsize_t i = 0; cells && i < points; i++)
        memcpy(cells + i * longest, data->point[i].text[key], strlen(data->point[i].text[key]));
    hid_t type = hdf5_string_type(longest);
    hid_t dataset =
        cells ? hdf5_create_piece(group, data->swept[key], type, 1, &points) : H5I_INVALID_HID;
    bool fine = dataset >= 0 && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, cells) >= 0;
    fine = dataset >= 0 && H5Dclose(dataset) >= 0 && fine;
    H5Tclose(type);
    free(cells);
    return fine;
}

// A dataset of texts for each swept key.
static bool write_points(const hdf5_writer *self)
{
    const study_data *data = self->table->data;
    hid_t group = hdf5_create_group(self->file, "points");
    bool fine = group >= 0;
    for (int k = 0; k < data->swept_count && fine; k++)
        fine = write_swept(group, data, k);
    if (group >= 0)
        H5Gclose(group);
    return fine;
}

// Closes what is open; false where the last of it cannot be written.
static bool close_all(hdf5_writer *self)
{
    bool fine = true;
    for (int i = 0; i < self->table->columns; i++) {
        if (self->column[i].dataset > 0)
            fine = H5Dclose(self->column[i].dataset) >= 0 && fine;
        free(self->column[i].block);
    }
    if (self->group > 0)
        fine = H5Gclose(self->group) >= 0 && fine;
    if (self->file > 0)
        fine = H5Fclose(self->file) >= 0 && fine;
    H5Tclose(self->status);
    free(self->column);
    return fine;
}

ld_status export_hdf5(void *exported, const char *file, const char *name, ld_error *error)
{
    export_table *table = exported;
    hdf5_quiet quiet = hdf5_quiet_begin();
    hdf5_writer self = {.table = table, .status = H5Tcopy(H5T_C_S1), .error = error};
    H5Tset_size(self.status, STATUS);
    self.column = calloc((size_t)table->columns, sizeof *self.column);
    ld_status status = LD_OK;
    if (!self.column) {
        H5Tclose(self.status);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the table");
    }
    if (!create_file(&self, file) || !create_columns(&self) || !write_rows(&self) ||
        (table->data->swept_count > 0 && !write_points(&self)))
        status = self.read ? self.read : hdf5_failed(error, LD_ERR_FILE, "write", name);
    if (!close_all(&self) && !status)
        status = hdf5_failed(error, LD_ERR_FILE, "write", name);
    return hdf5_quiet_end(&quiet, status, error);
}
