// The moving scene of a launch, for programs that draw in three dimensions: what its parts share.
#ifndef LD_FIGURES_SCENE_PARTS_H
#define LD_FIGURES_SCENE_PARTS_H

#include "figures/glb.h"
#include "math/vectors/mat3.h"
#include "model/blocks/mechanism.h"
#include "results/history.h"

enum {
    SCENE_SIDES = 24, // of what is round
    SCENE_MODES = LD_MAX_BEAM_COORDINATES
};

// Columns and rows of a history that keys are taken from.
typedef struct scene_rows {
    const history_data *history;
    size_t *row, count;
    int times; // accessor
} scene_rows;

typedef struct scene {
    glb glb;
    const history_data *history;
    scene_rows launch;
    double first, slower; // [s] the run's clock at the scene's start; played so many times slower
    double magnify;       // of deflections
    double after;         // [s] the run's clock where the flights end
    bool failed;          // without memory
} scene;

// Where a frame is.
typedef struct scene_pose {
    v3 r;
    m3 A;
} scene_pose;

// Of a node under way: its keys.
typedef struct scene_track {
    float *at, *turn; // [3 count], [4 count] quaternions x, y, z, w
    size_t count;
} scene_track;

// Value of a column at a row, NaN without the column.
double scene_value(const history_data *history, const char *column, size_t row);
// Of columns HEAD.x, .y, .z, .yaw, .pitch, .roll.
scene_pose scene_pose_of(const history_data *history, const char *head, size_t row);
// `local`, which is given in the axes of `frame`, in those that `frame` is given in.
scene_pose scene_in(scene_pose frame, scene_pose local);
// `pose` in the axes of `frame`.
scene_pose scene_against(scene_pose frame, scene_pose pose);

bool scene_begin_track(scene *self, scene_track *track, size_t room);
void scene_add_key(scene_track *track, scene_pose pose);
// Gives the keys to a node and frees them.
void scene_end_track(scene *self, scene_track *track, int node, int times);
// Accessor of the clock at the rows.
int scene_times(scene *self, const history_data *history, const size_t *row, size_t count);
// A node with a body and the keys of HEAD.x to .roll at every row of the launch.
int scene_add_body(scene *self, const char *head, int mesh);

// The axis of a tube or beam at a station: offsets u and slopes along y and z, twist, stretch.
typedef struct scene_section {
    double x, u[2], slope[2], twist, stretch;
} scene_section;

// A tube or beam that bends: its shapes OF.station and so on and its coordinates HEADq1 and so on.
typedef struct scene_shapes {
    const char *head;
    const double *station, *bending[2], *slope[2], *torsion, *axial;
    const double *q[SCENE_MODES]; // columns
    size_t stations, modes, nb, nt, na;
    const double *initial; // [bends][7] OF.initial_shape, of a guide that is not straight
    size_t bends;
} scene_shapes;

bool scene_find_shapes(const history_data *history, const char *of, const char *head,
                       scene_shapes *shapes);
// The section at x, deflections `magnify` times: cubic in bending, linear in torsion and stretch.
scene_section scene_section_at(const scene *self, const scene_shapes *shapes, size_t row, double x);
// Its frame in that of the tube: the cross section stands on the axis.
scene_pose scene_section_pose(const scene_section *at);
// A node below `parent` that bends: a hollow body, its inner and outer half sizes [stations][4].
int scene_add_bending(scene *self, const scene_shapes *shapes, const double (*size)[4], int sides,
                      int parent);

// The vehicle, the bodies and beams of a mechanism, or the plain frame of another base.
void scene_add_base(scene *self);

#endif
