#include "figures/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "figures/scene_parts.h"
#include "math/vectors/rotation_vector.h"

enum { MOST_KEYS = 4000, OTHER = 0x7f8fa0, ROCKET = 0xe8602c };

static const double EARLIER = 5e-3; // [s] of a scene's start before the ignition, as of figures

// ---- the clock ----

// Rows between two times of the run's clock; of very many every second, third ..., and the last.
static bool choose_rows(scene *self, const history_data *history, double from, double to,
                        scene_rows *rows)
{
    const double *t = history_column(history, "t");
    size_t first = 0, end = t ? history->rows : 0;
    while (first < end && t[first] < from)
        first++;
    while (end > first && t[end - 1] > to)
        end--;
    size_t step = (end - first) / MOST_KEYS + 1;
    *rows = (scene_rows){.history = history,
                         .row = malloc(((end - first) / step + 2) * sizeof *rows->row)};
    self->failed = self->failed || !rows->row;
    if (!rows->row)
        return false;
    double before = -INFINITY;
    for (size_t i = first; i < end; i++) // two rows of one time: the earlier one
        if (((i - first) % step == 0 || i + 1 == end) && t[i] > before) {
            rows->row[rows->count++] = i;
            before = t[i];
        }
    return rows->count > 0;
}

// Which rocket's turn it is at a row, from 0: the last ignited or, before, the one that waits.
static int turn_at(const history_data *history, size_t row)
{
    const double *t = history_column(history, "t");
    int turn = 0;
    while (turn + 1 < history->rockets) {
        const history_data *now = &history->rocket[turn];
        double left = now->t_ignition + now->t_rear;
        if (!isfinite(left) || t[row] <= left)
            break;
        turn++;
    }
    return turn;
}

// Hides a node but from key to key of a clock, -INFINITY and INFINITY for its ends.
static void show_between(scene *self, int node, double from, double to)
{
    double end = scene_value(self->history, "t", self->launch.row[self->launch.count - 1]);
    const double at[3] = {self->first, from, to};
    float time[3], size[9];
    size_t count = 0;
    for (int i = 0; i < 3; i++) {
        if (i > 0 && !(at[i] > self->first && at[i] < fmax(end, self->after)))
            continue;
        bool shown = i == 1 || (i == 0 && !(from > self->first));
        time[count] = (float)((at[i] - self->first) * self->slower);
        for (size_t k = 0; k < 3; k++)
            size[3 * count + k] = shown ? 1 : 0;
        count++;
    }
    if (count > 1)
        glb_step(&self->glb, node, "scale", glb_keys(&self->glb, time, count, 1),
                 glb_keys(&self->glb, size, count, 3));
}

// ---- the tubes ----

// The undeformed tube's frame T in I; against a base that is no vehicle it is mounted.
static scene_pose launcher_at(const scene *self, size_t row)
{
    const history_array *mount = history_array_named(self->history, "base.mount");
    scene_pose pose = scene_pose_of(self->history, "base", row);
    if (mount && mount->rows * mount->columns == 2)
        pose.A =
            m3_mul(pose.A, m3_mul(m3_rotation_y(mount->value[0]), m3_rotation_z(mount->value[1])));
    return pose;
}

// The tube's frame R in T, its offsets across and its turn so many times.
static scene_pose tube_at(const scene *self, size_t row, double magnify)
{
    static const char *const columns[] = {"tube.x",  "tube.y",  "tube.z", "tube.q0",
                                          "tube.q1", "tube.q2", "tube.q3"};
    double v[7];
    for (int i = 0; i < 7; i++)
        v[i] = scene_value(self->history, columns[i], row);
    scene_pose R =
        scene_against(launcher_at(self, row), (scene_pose){v3_from(v), q_matrix(q_from(v + 3))});
    if (magnify == 1)
        return R;
    return (scene_pose){v3_make(R.r.x, magnify * R.r.y, magnify * R.r.z),
                        rv_exp(v3_scale(magnify, rv_log(R.A)))};
}

static bool is_bore(const history_data *history)
{
    return !history_array_named(history, "guide.form");
}

// Inner and outer half sizes at a station: of a bore its radii, of a rail a thin frame like it.
static void size_at(const history_data *history, double x, double length, double size[4])
{
    const history_array *section = history_array_named(history, "tube.section"),
                        *outline = history_array_named(history, "guide.outline");
    size_t k = 0;
    while (section && k + 1 < section->rows && section->value[3 * (k + 1)] <= x)
        k++;
    for (size_t i = 0; i < 2; i++) {
        double inner = section ? section->value[3 * k + 1] : NAN,
               outer = section ? section->value[3 * k + 2] : NAN;
        if (!is_bore(history)) {
            outer = outline ? outline->value[2 * k + i] : NAN;
            outer = isfinite(outer) ? outer : 0.015 * length;
            inner = 0.9 * outer;
        }
        size[2 + i] = isfinite(outer) ? outer : 1.03 * inner;
        size[i] = inner;
    }
}

// Of the tube that launches at a row: its number; 0: not known.
static int tube_of(const history_data *history, size_t row)
{
    return history->rockets > 0 ? history->rocket[turn_at(history, row)].tube : 0;
}

// A tube in its place, at those rows at which it is not the one that launches; none of one that
// always does.
static void add_other(scene *self, int number, const v3 *place, int launcher, int mesh)
{
    const scene_rows *rows = &self->launch;
    float *time = malloc((rows->count + 1) * sizeof *time),
          *size = malloc((3 * rows->count + 1) * sizeof *size);
    size_t count = 0;
    char name[GLB_NAME];
    self->failed = self->failed || !time || !size;
    for (size_t k = 0; k < rows->count && time && size; k++) {
        float shown = tube_of(self->history, rows->row[k]) == number ? 0 : 1;
        if (count > 0 && shown == size[3 * count - 1])
            continue;
        double t = scene_value(self->history, "t", rows->row[k]);
        time[count] = (float)((t - self->first) * self->slower);
        for (size_t i = 0; i < 3; i++)
            size[3 * count + i] = shown;
        count++;
    }
    if (count > 1 || (count == 1 && size[0] > 0)) {
        snprintf(name, sizeof name, "tube %d", number);
        int node = glb_add_node(&self->glb, name, launcher, mesh);
        if (!self->glb.failed) {
            float *at = self->glb.node[node].at;
            at[0] = (float)place->x;
            at[1] = (float)place->y;
            at[2] = (float)place->z;
        }
        if (count > 1)
            glb_step(&self->glb, node, "scale", glb_keys(&self->glb, time, count, 1),
                     glb_keys(&self->glb, size, count, 3));
    }
    free(time);
    free(size);
}

static void add_others(scene *self, int launcher, const double size[4], double length)
{
    const history_array *place = history_array_named(self->history, "tubes.rear_end");
    int tube = self->history->rockets > 0 ? self->history->rocket[0].tube : 1;
    if (!place || place->rows < 2 || tube < 1 || (size_t)tube > place->rows)
        return;
    glb_shape shape = {0};
    int sides = is_bore(self->history) ? SCENE_SIDES : 4;
    glb_between(&shape, glb_ring(&shape, 0, size + 2, sides),
                glb_ring(&shape, length, size + 2, sides), sides);
    int mesh = glb_mesh(&self->glb, &shape, OTHER, NULL, 0);
    glb_shape_free(&shape);
    for (size_t i = 0; i < place->rows; i++) {
        v3 at = v3_sub(v3_from(place->value + 3 * i), v3_from(place->value + 3 * (tube - 1)));
        add_other(self, (int)i + 1, &at, launcher, mesh);
    }
}

// The frame of the first launching tube, from which the others are where they are.
static scene_pose pack_at(const scene *self, size_t row)
{
    const history_array *place = history_array_named(self->history, "tubes.rear_end");
    scene_pose T = launcher_at(self, row);
    if (!place || self->history->rockets == 0)
        return T;
    int first = self->history->rocket[0].tube, now = tube_of(self->history, row);
    if (first < 1 || now < 1 || (size_t)first > place->rows || (size_t)now > place->rows)
        return T;
    v3 d = v3_sub(v3_from(place->value + 3 * (first - 1)), v3_from(place->value + 3 * (now - 1)));
    return scene_in(T, (scene_pose){d, m3_identity()});
}

static void add_tubes(scene *self, const scene_shapes *shapes)
{
    double length = shapes->station[shapes->stations - 1], (*size)[4];
    size = calloc(shapes->stations, sizeof *size);
    int launcher = glb_add_node(&self->glb, "launcher", -1, -1);
    scene_track track, tube;
    if (!size || !scene_begin_track(self, &track, self->launch.count)) {
        self->failed = true;
        free(size);
        return;
    }
    for (size_t k = 0; k < shapes->stations; k++)
        size_at(self->history, shapes->station[k], length, size[k]);
    int bending = scene_add_bending(self, shapes, (const double(*)[4])size,
                                    is_bore(self->history) ? SCENE_SIDES : 4, launcher);
    add_others(self, launcher, size[0], length);
    free(size);
    for (size_t k = 0; k < self->launch.count; k++)
        scene_add_key(&track, pack_at(self, self->launch.row[k]));
    scene_end_track(self, &track, launcher, self->launch.times);
    if (!scene_begin_track(self, &tube, self->launch.count))
        return;
    for (size_t k = 0; k < self->launch.count; k++) {
        size_t row = self->launch.row[k];
        scene_pose T = scene_against(pack_at(self, row), launcher_at(self, row));
        scene_add_key(&tube, scene_in(T, tube_at(self, row, self->magnify)));
    }
    scene_end_track(self, &tube, bending, self->launch.times);
}

// ---- the rockets ----

// Its outline where the scenario has one; else a body in the tube's bore, from the rear adaptor on.
static int rocket_mesh(scene *self)
{
    const history_data *history = self->history;
    const history_array *outline = history_array_named(history, "rocket.outline"),
                        *adaptor = history_array_named(history, "rocket.adaptor"),
                        *diameter = history_array_named(history, "rocket.diameter"),
                        *section = history_array_named(history, "tube.section");
    glb_shape shape = {0};
    if (outline && outline->columns == 2) {
        glb_lathe(&shape, (const double(*)[2])outline->value, outline->rows, SCENE_SIDES);
    } else {
        double front = adaptor ? adaptor->value[adaptor->rows - 1] : 1,
               bore = section ? section->value[1] : 0.05 * front,
               radius = diameter ? 0.5 * diameter->value[0] : 0.8 * bore;
        const double point[][2] = {{0, radius},
                                   {front, radius},
                                   {front + 4 * radius, 0.6 * radius},
                                   {front + 6 * radius, 0}};
        glb_lathe(&shape, point, 4, SCENE_SIDES);
    }
    int mesh = glb_mesh(&self->glb, &shape, ROCKET, NULL, 0);
    glb_shape_free(&shape);
    return mesh;
}

// B in I in the tube, at its true place against the tube as it is drawn.
static scene_pose rocket_in_tube(const scene *self, const scene_shapes *shapes, size_t row)
{
    static const char *const columns[] = {"rocket.s",   "rocket.y",     "rocket.z",
                                          "rocket.psi", "rocket.theta", "rocket.gamma"};
    double v[6];
    for (int i = 0; i < 6; i++)
        v[i] = scene_value(self->history, columns[i], row);
    scene_section at = scene_section_at(self, shapes, row, v[0]);
    scene_pose section = scene_section_pose(&at),
               body = {
                   v3_make(0, v[1], v[2]),
                   m3_mul(m3_rotation_z(v[3]), m3_mul(m3_rotation_y(v[4]), m3_rotation_x(v[5])))};
    scene_pose R = scene_in(launcher_at(self, row), tube_at(self, row, self->magnify));
    return scene_in(R, scene_in(section, body));
}

// B in I in flight, its roll from the spin, its mass centre that of the full rocket.
static void add_flight(const scene *self, const scene_rows *rows, scene_track *track)
{
    const history_array *center = history_array_named(self->history, "rocket.center");
    const history_data *flight = rows->history;
    const double *t = history_column(flight, "t"), *spin = history_column(flight, "rocket.spin");
    double roll = 0;
    for (size_t k = 0, row = 0; k < rows->count; k++) {
        for (; spin && row < rows->row[k]; row++)
            roll += 0.5 * (spin[row] + spin[row + 1]) * (t[row + 1] - t[row]);
        scene_pose pose = {v3_make(scene_value(flight, "center.x", row),
                                   scene_value(flight, "center.y", row),
                                   scene_value(flight, "center.z", row)),
                           m3_mul(m3_mul(m3_rotation_y(scene_value(flight, "rocket.yaw", row)),
                                         m3_rotation_z(scene_value(flight, "rocket.pitch", row))),
                                  m3_rotation_x(roll))};
        v3 behind = v3_make(center ? -center->value[0] : 0, 0, 0);
        scene_add_key(track, scene_in(pose, (scene_pose){behind, m3_identity()}));
    }
}

// Rows of the launch at which a rocket is in the tube.
static size_t rows_in_tube(const scene *self, int rocket, size_t *row)
{
    size_t count = 0;
    for (size_t k = 0; k < self->launch.count; k++)
        if (turn_at(self->history, self->launch.row[k]) == rocket &&
            isfinite(scene_value(self->history, "rocket.s", self->launch.row[k])))
            row[count++] = self->launch.row[k];
    return count;
}

// A node for the keys in the tube and one for those in flight: each has its own clock.
static void add_rocket(scene *self, const scene_shapes *shapes, int rocket, int mesh)
{
    size_t *row = malloc((self->launch.count + 1) * sizeof *row);
    char name[GLB_NAME];
    scene_track track;
    if (!row || !scene_begin_track(self, &track, self->launch.count)) {
        self->failed = true;
        free(row);
        return;
    }
    size_t count = rows_in_tube(self, rocket, row);
    for (size_t k = 0; k < count; k++)
        scene_add_key(&track, rocket_in_tube(self, shapes, row[k]));
    snprintf(name, sizeof name, "rocket %d", rocket + 1);
    int node = count > 0 ? glb_add_node(&self->glb, name, -1, mesh) : -1;
    scene_end_track(self, &track, node,
                    count > 0 ? scene_times(self, self->history, row, count) : 0);
    if (count > 0)
        show_between(self, node, scene_value(self->history, "t", row[0]),
                     scene_value(self->history, "t", row[count - 1]));
    free(row);
}

static void add_flown(scene *self, const history_data *flight, int mesh)
{
    scene_rows rows;
    scene_track track;
    char name[GLB_NAME];
    if (choose_rows(self, flight, self->first, self->after, &rows) &&
        scene_begin_track(self, &track, rows.count)) {
        add_flight(self, &rows, &track);
        snprintf(name, sizeof name, "rocket %d in flight", flight->number);
        int node = glb_add_node(&self->glb, name, -1, mesh);
        scene_end_track(self, &track, node, scene_times(self, flight, rows.row, rows.count));
        show_between(self, node, scene_value(flight, "t", rows.row[0]), INFINITY);
    }
    free(rows.row);
}

static void add_rockets(scene *self, const scene_shapes *shapes)
{
    int mesh = rocket_mesh(self), rockets = self->history->rockets;
    for (int i = 0; i < (rockets > 0 ? rockets : 1); i++)
        add_rocket(self, shapes, i, mesh);
    for (size_t i = 0; i < self->history->flights; i++)
        add_flown(self, &self->history->flight[i], mesh);
}

// ---- the whole ----

static ld_status write_scene(scene *self, const scene_shapes *shapes, FILE *file, ld_error *error)
{
    char extras[160];
    double ignition = isfinite(self->history->t_ignition) ? self->history->t_ignition : 0;
    glb_begin(&self->glb);
    self->launch.times = scene_times(self, self->history, self->launch.row, self->launch.count);
    add_tubes(self, shapes);
    add_rockets(self, shapes);
    scene_add_base(self);
    self->glb.failed = self->glb.failed || self->failed;
    snprintf(extras, sizeof extras, "{\"from\":%.9g,\"slower\":%.9g,\"magnified\":%.9g}",
             self->first - ignition, self->slower, self->magnify);
    return glb_write(&self->glb, extras, file, error);
}

ld_status scene_write(const history_data *history, const ld_picture *picture, FILE *file,
                      ld_error *error)
{
    scene_shapes shapes;
    if (history->rows == 0 || !history_column(history, "tube.q0") ||
        !scene_find_shapes(history, "tube", "", &shapes))
        return ld_fail(error, LD_ERR_INPUT, "a scene requires a launcher; these results have none");
    double zero = isfinite(history->t_ignition) ? history->t_ignition : 0,
           from = zero + (isnan(picture->from) ? -EARLIER : picture->from),
           to = isnan(picture->to) ? INFINITY : zero + picture->to;
    scene self = {.history = history,
                  .slower = picture->scene ? picture->scene->slower : 1,
                  .magnify = picture->scene ? picture->scene->magnify : 1};
    ld_status status = LD_OK;
    if (choose_rows(&self, history, from, to, &self.launch)) {
        const size_t *row = self.launch.row;
        self.first = scene_value(history, "t", row[0]);
        self.after = isfinite(to) ? to : scene_value(history, "t", row[self.launch.count - 1]);
        status = write_scene(&self, &shapes, file, error);
    } else {
        status = self.failed ? ld_fail(error, LD_ERR_MEMORY, "no memory for the scene")
                             : ld_fail(error, LD_ERR_INPUT,
                                       "the launch has no row between from "
                                       "and to");
    }
    free(self.launch.row);
    return status;
}
