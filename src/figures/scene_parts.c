#include "figures/scene_parts.h"

#include <math.h>
#include <stdlib.h>

#include "math/vectors/quaternion.h"

double scene_value(const history_data *history, const char *column, size_t row)
{
    const double *value = history_column(history, column);
    return value ? value[row] : NAN;
}

static double of_head(const history_data *history, const char *head, const char *last, size_t row)
{
    char column[2 * GLB_NAME];
    snprintf(column, sizeof column, "%s.%s", head, last);
    return scene_value(history, column, row);
}

scene_pose scene_pose_of(const history_data *history, const char *head, size_t row)
{
    m3 yaw = m3_rotation_y(of_head(history, head, "yaw", row)),
       pitch = m3_rotation_z(of_head(history, head, "pitch", row)),
       roll = m3_rotation_x(of_head(history, head, "roll", row));
    return (scene_pose){v3_make(of_head(history, head, "x", row), of_head(history, head, "y", row),
                                of_head(history, head, "z", row)),
                        m3_mul(m3_mul(yaw, pitch), roll)};
}

scene_pose scene_in(scene_pose frame, scene_pose local)
{
    return (scene_pose){v3_add(frame.r, m3_apply(frame.A, local.r)), m3_mul(frame.A, local.A)};
}

scene_pose scene_against(scene_pose frame, scene_pose pose)
{
    return (scene_pose){m3_apply_transposed(frame.A, v3_sub(pose.r, frame.r)),
                        m3_mul(m3_transpose(frame.A), pose.A)};
}

bool scene_begin_track(scene *self, scene_track *track, size_t room)
{
    *track = (scene_track){malloc((3 * room + 1) * sizeof(float)),
                           malloc((4 * room + 1) * sizeof(float)), 0};
    if (track->at && track->turn)
        return true;
    self->failed = true;
    free(track->at);
    free(track->turn);
    return false;
}

// Of the two quaternions of an attitude the one nearer to that before.
void scene_add_key(scene_track *track, scene_pose pose)
{
    float *at = track->at + 3 * track->count, *turn = track->turn + 4 * track->count;
    quat q = q_from_matrix(pose.A);
    at[0] = (float)pose.r.x;
    at[1] = (float)pose.r.y;
    at[2] = (float)pose.r.z;
    turn[0] = (float)q.x;
    turn[1] = (float)q.y;
    turn[2] = (float)q.z;
    turn[3] = (float)q.w;
    float along = 0;
    for (int i = 0; i < 4 && track->count > 0; i++)
        along += turn[i] * turn[i - 4];
    for (int i = 0; i < 4 && along < 0; i++)
        turn[i] = -turn[i];
    track->count++;
}

void scene_end_track(scene *self, scene_track *track, int node, int times)
{
    if (track->count > 0) {
        glb_move(&self->glb, node, "translation", times,
                 glb_keys(&self->glb, track->at, track->count, 3));
        glb_move(&self->glb, node, "rotation", times,
                 glb_keys(&self->glb, track->turn, track->count, 4));
    }
    free(track->at);
    free(track->turn);
}

int scene_add_body(scene *self, const char *head, int mesh)
{
    int node = glb_add_node(&self->glb, head, -1, mesh);
    scene_track track;
    if (!scene_begin_track(self, &track, self->launch.count))
        return node;
    for (size_t k = 0; k < self->launch.count; k++)
        scene_add_key(&track, scene_pose_of(self->history, head, self->launch.row[k]));
    scene_end_track(self, &track, node, self->launch.times);
    return node;
}

int scene_times(scene *self, const history_data *history, const size_t *row, size_t count)
{
    const double *t = history_column(history, "t");
    float *time = malloc((count + 1) * sizeof *time);
    self->failed = self->failed || !time;
    if (!time)
        return 0;
    for (size_t i = 0; i < count; i++)
        time[i] = (float)((t[row[i]] - self->first) * self->slower);
    int accessor = glb_keys(&self->glb, time, count, 1);
    free(time);
    return accessor;
}
