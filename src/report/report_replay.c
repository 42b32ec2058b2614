// What the replay of a launch requires beside what the plots show: where the tube is against its
// undeformed place, and the launcher's geometry.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/vectors/quaternion.h"
#include "math/vectors/rotation_vector.h"
#include "report/report_parts.h"
#include "results/json_text.h"

enum { DERIVED = 6 };

static const char *const derived[DERIVED] = {"replay.x",  "replay.y",  "replay.z",
                                             "replay.rx", "replay.ry", "replay.rz"};

// Columns that the place of the tube's frame is computed from.
enum { BASE = 6, TUBE = 7 };
static const char *const base_columns[BASE] = {"base.x",   "base.y",     "base.z",
                                               "base.yaw", "base.pitch", "base.roll"};
static const char *const tube_columns[TUBE] = {"tube.x",  "tube.y",  "tube.z", "tube.q0",
                                               "tube.q1", "tube.q2", "tube.q3"};

static bool has_all(const history_data *history, const char *const *names, size_t count)
{
    bool all = true;
    for (size_t i = 0; i < count; i++)
        all = all && history_column(history, names[i]);
    return all;
}

bool report_has_replay(const history_data *history)
{
    return history->rows > 0 && history_array_named(history, "tube.station") &&
           has_all(history, base_columns, BASE) && has_all(history, tube_columns, TUBE);
}

static bool is_one_of(const char *name, const char *const *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(name, list[i]) == 0)
            return true;
    return false;
}

// Columns HEAD.NAME.LAST of what a base of bodies has.
static bool is_of_mechanism(const char *name)
{
    static const char *const heads[] = {"body.", "beam.", "wheel.", "carrier."};
    static const char *const lasts[] = {"x", "y", "z", "yaw", "pitch", "roll", "travel", "road"};
    const char *last = strrchr(name, '.');
    bool head = false;
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++)
        head = head || strncmp(name, heads[i], strlen(heads[i])) == 0;
    bool coordinate = last && last[1] == 'q' && strncmp(name, "beam.", 5) == 0;
    return head && last && (coordinate || is_one_of(last + 1, lasts, sizeof lasts / sizeof *lasts));
}

bool report_replay_shows(const char *name, bool flight)
{
    static const char *const of_launcher[] = {
        "base.x",        "base.y",       "base.z",        "base.yaw",   "base.pitch",
        "base.roll",     "chassis.x",    "chassis.y",     "chassis.z",  "chassis.yaw",
        "chassis.pitch", "chassis.roll", "azimuth.angle", "thrust",     "phase",
        "rocket.s",      "rocket.y",     "rocket.z",      "rocket.psi", "rocket.theta",
        "rocket.gamma"};
    static const char *const of_flight[] = {"center.x",   "center.y",    "center.z", "rocket.pitch",
                                            "rocket.yaw", "rocket.spin", "thrust",   "canopy.x",
                                            "canopy.y",   "canopy.z",    "drag_area"};
    if (flight)
        return is_one_of(name, of_flight, sizeof of_flight / sizeof *of_flight) ||
               (strncmp(name, "line.", 5) == 0 && strspn(name + 5, "0123456789") > 0);
    return is_one_of(name, of_launcher, sizeof of_launcher / sizeof *of_launcher) ||
           is_one_of(name, derived, DERIVED) || strncmp(name, "shoe.", 5) == 0 ||
           is_of_mechanism(name) ||
           (*name == 'q' && name[1] && strspn(name + 1, "0123456789") == strlen(name + 1));
}

// ---- columns ----

// The values of these columns.
typedef struct pose_columns {
    const double *base[BASE], *tube[TUBE];
} pose_columns;

// Place of the tube's frame R and rotation vector of R, both against the undeformed tube and in its
// axes: small numbers, which single precision holds to 7 digits where the places in I would not.
static void find_pose(const pose_columns *from, const m3 *mount, size_t row, double pose[DERIVED])
{
    const double *const *base = from->base, *const *tube = from->tube;
    m3 yaw = m3_rotation_y(base[3][row]), pitch = m3_rotation_z(base[4][row]);
    m3 A = m3_mul(m3_mul(m3_mul(yaw, pitch), m3_rotation_x(base[5][row])), *mount);
    quat q = q_from((double[]){tube[3][row], tube[4][row], tube[5][row], tube[6][row]});
    v3 r = v3_make(tube[0][row] - base[0][row], tube[1][row] - base[1][row],
                   tube[2][row] - base[2][row]);
    v3_store(pose, m3_apply_transposed(A, r));
    v3_store(pose + 3, rv_log(m3_mul(m3_transpose(A), q_matrix(q))));
}

static void fill(const history_data *history, double *value)
{
    pose_columns from;
    for (int i = 0; i < BASE; i++)
        from.base[i] = history_column(history, base_columns[i]);
    for (int i = 0; i < TUBE; i++)
        from.tube[i] = history_column(history, tube_columns[i]);
    const history_array *angles = history_array_named(history, "base.mount");
    m3 mount = m3_identity();
    if (angles && angles->rows * angles->columns == 2)
        mount = m3_mul(m3_rotation_y(angles->value[0]), m3_rotation_z(angles->value[1]));
    for (size_t row = 0; row < history->rows; row++) {
        double pose[DERIVED];
        find_pose(&from, &mount, row, pose);
        for (size_t i = 0; i < DERIVED; i++)
            value[i * history->rows + row] = pose[i];
    }
}

// Room for more columns; what is there stays.
static bool grow(history_data *history, size_t columns)
{
    char **name = realloc(history->name, columns * sizeof *name);
    history->name = name ? name : history->name;
    char **unit = realloc(history->unit, columns * sizeof *unit);
    history->unit = unit ? unit : history->unit;
    double *value = realloc(history->value, columns * history->rows * sizeof *value);
    history->value = value ? value : history->value;
    return name && unit && value;
}

ld_status report_add_replay(history_data *history, ld_error *error)
{
    size_t before = history->columns;
    if (!report_has_replay(history))
        return LD_OK;
    bool fine = grow(history, before + DERIVED);
    for (size_t i = 0; fine && i < DERIVED; i++) {
        history->name[before + i] = strdup(derived[i]);
        history->unit[before + i] = strdup(i < 3 ? "m" : "rad");
        history->columns++;
        fine = history->name[before + i] && history->unit[before + i];
    }
    if (!fine)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
    fill(history, history->value + before * history->rows);
    return LD_OK;
}

// ---- geometry ----

void report_write_geometry(FILE *json, const history_data *history)
{
    fputc('{', json);
    for (size_t i = 0; i < history->arrays && report_has_replay(history); i++) {
        const history_array *array = &history->geometry[i];
        fputs(i ? ",\n" : "\n", json);
        json_write_text(json, array->name);
        fprintf(json, ":{\"columns\":%zu,\"value\":[", array->columns);
        for (size_t k = 0; k < array->rows * array->columns; k++) {
            fputs(k ? "," : "", json);
            if (isfinite(array->value[k]))
                fprintf(json, "%.9g", array->value[k]);
            else
                fputs("null", json);
        }
        fputs("]}", json);
    }
    fputc('}', json);
}
