#include "compare/sensor_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/fields/field_rows.h"
#include "scenario/measured/block_file.h"

// ---- what stands in the file

// The unit of what the sensor measures, put in its place when its kind is known.
#define MEASURED "*"
#define TEXT(type, member) .kind = FIELD_TEXT, .offset = offsetof(type, member)
#define WINDOW(type, member)                                                                       \
    CHOICE(type, member.kind, window_words), .other = offsetof(type, member.t), .unit = "s",       \
                                             DEFAULT(WINDOW_OPEN), ANY
#define ACCELEROMETER FORM(SENSOR_ACCELEROMETER)
#define INERTIAL (ACCELEROMETER | FORM(SENSOR_GYRO))
#define STRAIN FORM(SENSOR_STRAIN)
#define SERIES (~FORM(TAKE_RESULT) & 0xffu)

static const field_word window_words[] = {
    {"", WINDOW_TIME},           {"t_ignition", SERIES_IGNITION}, {"t_release", SERIES_RELEASE},
    {"t_front", SERIES_FRONT},   {"t_middle", SERIES_MIDDLE},     {"t_rear", SERIES_REAR},
    {"t_apogee", SERIES_APOGEE}, {"t_impact", SERIES_IMPACT},     {NULL, 0}};

static const field_row clock_fields[] = {
    {"column", TEXT(log_clock, column)},
    {"offset", NUMBER(log_clock, offset, "s"), ANY, DEFAULT(0)},
    {"uncertainty", NUMBER(log_clock, uncertainty, "s"), NOT_NEGATIVE, DEFAULT(0)},
    {"find", TEXT(log_clock, find)},
    {"within", NUMBER(log_clock, within, "s"), POSITIVE, DEFAULT(1)},
    {"from", WINDOW(log_clock, from)},
    {"to", WINDOW(log_clock, to)},
    {0}};
static const field_block clock_block = {.fields = clock_fields};

static const field_word kind_words[] = {{"accelerometer", SENSOR_ACCELEROMETER},
                                        {"gyro", SENSOR_GYRO},
                                        {"altimeter", SENSOR_ALTIMETER},
                                        {"strain", SENSOR_STRAIN},
                                        {"column", SENSOR_COLUMN},
                                        {NULL, 0}};

static const field_row sensor_fields[] = {
    {"column", TEXT(sensor, column), .required = true},
    {"kind", CHOICE(sensor, kind, kind_words), REQUIRED},
    {"of", QUANTITY(sensor, of), .required = true, .forms = FORM(SENSOR_COLUMN)},
    {"on", TEXT(sensor, on), .forms = INERTIAL | STRAIN},
    {"at", VECTOR(sensor, at, "m", 3), ANY, DEFAULT(0), .forms = ACCELEROMETER | STRAIN},
    {"axis", VECTOR(sensor, axis, "", 3), ANY, REQUIRED, .forms = INERTIAL},
    {"low_pass", NUMBER(sensor, cutoff, "Hz"), POSITIVE, NO_DEFAULT("none")},
    {"order", INTEGER(sensor, order, 1, 8), DEFAULT(2)},
    {"delay", NUMBER(sensor, delay, "s"), ANY, DEFAULT(0)},
    {"scale", NUMBER(sensor, scale, ""), ANY, DEFAULT(1)},
    {"bias", NUMBER(sensor, bias, MEASURED), ANY, DEFAULT(0)},
    {"noise", NUMBER(sensor, noise, MEASURED), NOT_NEGATIVE, DEFAULT(0)},
    {"bias_uncertainty", NUMBER(sensor, bias_uncertainty, MEASURED), NOT_NEGATIVE, DEFAULT(0)},
    {"scale_uncertainty", NUMBER(sensor, scale_uncertainty, ""), NOT_NEGATIVE, DEFAULT(0)},
    {"range", VECTOR(sensor, range, MEASURED, 2), ANY, NO_DEFAULT("none")},
    {"resolution", NUMBER(sensor, resolution, MEASURED), NOT_NEGATIVE, DEFAULT(0)},
    {"rest", VECTOR(sensor, rest, "s", 2), ANY, NO_DEFAULT("none")},
    {"from", WINDOW(sensor, from)},
    {"to", WINDOW(sensor, to)},
    {"limit", NUMBER(sensor, limit, MEASURED), POSITIVE, NO_DEFAULT("none")},
    {0}};
static const field_block sensor_block = {.fields = sensor_fields,
                                         .form = kind_words,
                                         .form_offset = offsetof(sensor, kind),
                                         .form_key = "kind"};

static const field_word take_words[] = {
    {"result", TAKE_RESULT}, {"max", TAKE_MAX},     {"min", TAKE_MIN},
    {"mean", TAKE_MEAN},     {"rms", TAKE_RMS},     {"value", TAKE_VALUE},
    {"t_max", TAKE_T_MAX},   {"t_min", TAKE_T_MIN}, {NULL, 0}};

static const field_row result_fields[] = {
    {"of", TEXT(log_result, of), .required = true},
    {"name", TEXT(log_result, name)},
    {"take", CHOICE(log_result, take, take_words), DEFAULT(TAKE_RESULT)},
    {"measured", TEXT(log_result, measured), .required = true, .forms = FORM(TAKE_RESULT)},
    {"uncertainty", TEXT(log_result, uncertainty), .required = true, .forms = FORM(TAKE_RESULT)},
    {"limit", TEXT(log_result, limit)},
    {"at", WINDOW(log_result, at), .required = true, .forms = FORM(TAKE_VALUE)},
    {"from", WINDOW(log_result, from), .forms = SERIES & ~FORM(TAKE_VALUE)},
    {"to", WINDOW(log_result, to), .forms = SERIES & ~FORM(TAKE_VALUE)},
    {0}};
static const field_block result_block = {.fields = result_fields,
                                         .form = take_words,
                                         .form_offset = offsetof(log_result, take),
                                         .form_key = "take"};

// ---- reading it

typedef struct sensor_reader {
    measured_log *log;
    const run_series *run;
} sensor_reader;

void sensor_file_defaults(measured_log *log)
{
    field_initialise(&clock_block, &log->clock);
}

static void fill_clock(scenario_reader *reader, const tree_node *root, sensor_reader *self)
{
    const tree_node *map = tree_member(root, "clock");
    if (map && map->kind == NODE_MAP)
        scenario_fill_block(reader, &clock_block, map, &self->log->clock, "clock");
    else if (map)
        reader_refuse(reader, map->at, "clock", "expected a block of keys");
}

// The unit of what a sensor measures; NULL after a message.
static const char *unit_of(scenario_reader *reader, const sensor_reader *self, const tree_node *map,
                           const char *path)
{
    static const char *const units[] = {"m/s2", "rad/s", "m", ""};
    const tree_node *kind = tree_member(map, "kind"), *of = tree_member(map, "of");
    const field_word *word =
        kind && kind->kind == NODE_SCALAR ? field_word_find(kind_words, kind->text) : NULL;
    if (!word)
        return ""; // the table says what is wrong
    if (word->value != SENSOR_COLUMN)
        return units[word->value];
    if (!of || of->kind != NODE_SCALAR)
        return "";
    const char *nearest, *unit = run_series_unit(self->run, of->text, &nearest);
    char of_path[READER_MAX_PATH], quoted[64];
    snprintf(of_path, sizeof of_path, "%s.of", path);
    if (!unit)
        reader_refuse(reader, of->at, of_path, "the run has no column %s%s%s%s",
                      reader_quote(of->text, quoted), nearest ? ", did you mean \"" : "",
                      nearest ? nearest : "", nearest ? "\"?" : "");
    return unit;
}

// The part of the launcher must have the columns that the sensor measures.
static void check_part(scenario_reader *reader, const sensor_reader *self, const tree_node *map,
                       const char *path, sensor *of)
{
    const tree_node *on = tree_member(map, "on");
    char name[LD_MAX_QUANTITY], nearest_part[LD_MAX_QUANTITY], on_path[READER_MAX_PATH], quoted[64];
    const char *nearest, *last = of->kind == SENSOR_STRAIN ? "curvature_y" : "wx";
    snprintf(on_path, sizeof on_path, "%s.on", path);
    if (!of->on && of->kind == SENSOR_STRAIN)
        reader_refuse(reader, map->at, on_path, "required, a station of the tube: station.1");
    if (!of->on)
        return;
    snprintf(name, sizeof name, "%.60s.%s", of->on, last);
    if (run_series_unit(self->run, name, &nearest))
        return;
    const char *end = nearest ? strrchr(nearest, '.') : NULL;
    snprintf(nearest_part, sizeof nearest_part, "%.*s", end ? (int)(end - nearest) : 0,
             end ? nearest : "");
    reader_refuse(reader, on->at, on_path, "the run has no column %s%s%s%s",
                  reader_quote(name, quoted), end ? ", did you mean \"" : "", nearest_part,
                  end ? "\"?" : "");
}

static void fill_sensor(scenario_reader *reader, const sensor_reader *self, const tree_node *map,
                        const char *path, sensor *into)
{
    enum { MOST_FIELDS = sizeof sensor_fields / sizeof *sensor_fields };
    field_row fields[MOST_FIELDS];
    field_block block = sensor_block;
    const char *unit = unit_of(reader, self, map, path);
    if (!unit)
        return;
    memcpy(fields, sensor_fields, sizeof fields);
    for (int i = 0; i < MOST_FIELDS; i++)
        if (fields[i].unit && strcmp(fields[i].unit, MEASURED) == 0)
            fields[i].unit = unit;
    block.fields = fields;
    scenario_fill_block(reader, &block, map, into, path);
    snprintf(into->si, sizeof into->si, "%s", unit);
    if (into->on && strcmp(into->on, "rocket") == 0) {
        free(into->on);
        into->on = NULL;
    }
    check_part(reader, self, map, path, into);
    double norm = sqrt(into->axis[0] * into->axis[0] + into->axis[1] * into->axis[1] +
                       into->axis[2] * into->axis[2]);
    if (norm == 0 && into->kind <= SENSOR_GYRO)
        reader_refuse(reader, map->at, path, "axis: expected a direction, found zero");
    for (int i = 0; i < 3 && norm > 0; i++)
        into->axis[i] /= norm;
    if (into->range[0] >= into->range[1])
        reader_refuse(reader, map->at, path, "range: expected a lower end and a higher one");
    if (into->rest[0] >= into->rest[1])
        reader_refuse(reader, map->at, path, "rest: expected a beginning and a later end");
}

// The list of blocks of that name, or NULL; *count entries.
static const tree_node *list_of(scenario_reader *reader, const tree_node *root, const char *name,
                                int *count)
{
    const tree_node *list = tree_member(root, name);
    *count = 0;
    if (!list)
        return NULL;
    bool good = list->kind == NODE_LIST;
    for (const tree_node *entry = good ? list->first : NULL; entry; entry = entry->next)
        good = good && entry->kind == NODE_MAP;
    if (good)
        *count = list->count;
    else
        reader_refuse(reader, list->at, name, "expected a list of blocks of keys");
    return good ? list->first : NULL;
}

static void fill_sensors(scenario_reader *reader, const tree_node *root, sensor_reader *self)
{
    measured_log *log = self->log;
    int count;
    char path[32];
    const tree_node *entry = list_of(reader, root, "sensors", &count);
    log->sensor = calloc((size_t)count + 1, sizeof *log->sensor);
    if (!log->sensor)
        reader->no_memory = true;
    for (; entry && !reader->no_memory; entry = entry->next) {
        sensor *into = &log->sensor[log->sensors++];
        field_initialise(&sensor_block, into);
        snprintf(path, sizeof path, "sensors.%d", log->sensors);
        fill_sensor(reader, self, entry, path, into);
    }
}

static int sensor_named(const measured_log *log, const char *name)
{
    int i = 0;
    while (i < log->sensors && (!log->sensor[i].column || strcmp(log->sensor[i].column, name) != 0))
        i++;
    return i < log->sensors ? i : -1;
}

static void fill_results(scenario_reader *reader, const tree_node *root, sensor_reader *self)
{
    measured_log *log = self->log;
    int count;
    char path[32], quoted[64];
    const tree_node *entry = list_of(reader, root, "results", &count);
    log->result = calloc((size_t)count + 1, sizeof *log->result);
    if (!log->result)
        reader->no_memory = true;
    for (; entry && !reader->no_memory; entry = entry->next) {
        log_result *into = &log->result[log->results++];
        field_initialise(&result_block, into);
        snprintf(path, sizeof path, "results.%d", log->results);
        scenario_fill_block(reader, &result_block, entry, into, path);
        into->sensor = into->take == TAKE_RESULT || !into->of ? -1 : sensor_named(log, into->of);
        if (into->take != TAKE_RESULT && into->of && into->sensor < 0)
            reader_refuse(reader, entry->at, path, "of: %s is the column of no sensor here",
                          reader_quote(into->of, quoted));
    }
}

static void take_file(scenario_reader *reader, const tree_node *root, void *data)
{
    static const char *const keys[] = {"clock", "sensors", "results"};
    sensor_reader *self = data;
    reader_check_keys(reader, root, "", keys, sizeof keys / sizeof *keys);
    fill_clock(reader, root, self);
    fill_sensors(reader, root, self);
    fill_results(reader, root, self);
    if (self->log->clock.find && sensor_named(self->log, self->log->clock.find) < 0)
        reader_refuse(reader, root->at, "clock.find", "expected the column of a sensor");
}

ld_status sensor_file_read(measured_log *log, const char *path, const run_series *run,
                           ld_error *error)
{
    sensor_reader self = {log, run};
    return block_file_read(path, take_file, &self, error);
}

ld_status sensor_file_add_column(measured_log *log, const char *name, const char *unit,
                                 ld_error *error)
{
    sensor *larger = realloc(log->sensor, ((size_t)log->sensors + 1) * sizeof *larger);
    if (!larger)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the sensors");
    log->sensor = larger;
    sensor *added = &larger[log->sensors++];
    *added = (sensor){0};
    field_initialise(&sensor_block, added);
    added->kind = SENSOR_COLUMN;
    snprintf(added->si, sizeof added->si, "%s", unit);
    added->column = strdup(name);
    snprintf(added->of, sizeof added->of, "%s", name);
    return added->column ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the sensors");
}

void sensor_file_free(measured_log *log)
{
    field_release(&clock_block, &log->clock);
    for (int i = 0; i < log->sensors; i++) {
        field_release(&sensor_block, &log->sensor[i]);
        free(log->sensor[i].value);
    }
    for (int i = 0; i < log->results; i++)
        field_release(&result_block, &log->result[i]);
    free(log->sensor);
    free(log->result);
}
