#include "systems/multibody/closing.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "math/vectors/rotation_vector.h"
#include "systems/multibody/loop_rows.h"
#include "systems/multibody/loop_system.h"

// Pivots below this, squared sines, count as none: where a pose is singular; the same when rows are
// orthogonalised; where rows depend on each other in every pose; where a row opens in no pose at
// all.
static const double singular_pivot = 1e-12, orthogonal_pivot = 1e-20, dependent_pivot = 1e-10,
                    dead_pivot = 1e-20;
// Below this the rows are orthogonalised.
static const double careful_pivot = 1e-5;

// ---- accelerations

ld_status loops_close(ld_mstmm *system, ld_error *error)
{
    const loop_pivots pivots = {.least = singular_pivot, .limited = true};
    if (!system->assembled)
        return ld_fail(error, LD_ERR_INPUT,
                       "the loops are not assembled: call ld_mstmm_assemble before the first "
                       "evaluation");
    loops_make_rows(system, LOOPS_ACCELERATIONS);
    system->sweep->propagate(system);
    system->singularity = loop_system_factor(system, &pivots, &system->singular_loop);
    if (!isfinite(system->singularity))
        return ld_fail(error, LD_ERR_NUMERIC, "loop '%s': its state is not finite",
                       system->loop_name[system->singular_loop]);
    double none = singular_pivot, careful = -1;
    if (system->singularity < careful_pivot)
        careful = loop_system_solve_dense(system, orthogonal_pivot, &system->singular_loop);
    if (careful >= 0) {
        system->singularity = careful;
        none = orthogonal_pivot;
    } else {
        loop_system_solve(system);
    }
    if (!(system->singularity > none))
        for (int i = 0; i < system->loop_count; i++)
            if (!(loop_system_rest(system, i) < 1e-6))
                return ld_fail(error, LD_ERR_NUMERIC,
                               "loop '%s': its pose is singular, no force keeps it closed",
                               system->loop_name[i]);
    for (int i = 0; i < system->loop_count; i++)
        loop_sum_forces(&system->loop[i], &system->loop_work[i]);
    system->sweep->apply(system);
    return LD_OK;
}

// ---- the least motion that closes gaps

// The motion at q without speeds and forces: rates and biases are zero.
static int stand(ld_mstmm *system, const double *q)
{
    const spatial base = system->base;
    multibody_move(system, q, system->zero);
    loops_place(system, system->zero);
    for (int i = 0; i < system->beam_count; i++)
        beam_still(&system->beams[i]);
    system->base = (spatial){v3_zero(), v3_zero()};
    int singular = system->sweep->inwards(system, system->zero, NULL);
    system->base = base;
    return singular;
}

// Unit wrenches, and the gaps as they are: the ground has no acceleration.
static void propagate_still(ld_mstmm *system)
{
    const spatial base = system->base;
    system->base = (spatial){v3_zero(), v3_zero()};
    system->sweep->propagate(system);
    system->base = base;
}

// The response to the loops' forces: `response` of the speeds. What else the axes' rates and the
// motion's biases hold is set aside.
static void respond(ld_mstmm *system)
{
    const spatial base = system->base;
    const v4d none = v4d_all(0);
    for (int k = 0; k < system->axis_count; k++)
        system->axis[k].rate = 0;
    for (int i = 1; i <= system->node_count; i++)
        system->motion[i].bias_a = system->motion[i].bias_alpha = none;
    for (int i = 0; i < system->beam_count; i++)
        beam_still(&system->beams[i]);
    system->base = (spatial){v3_zero(), v3_zero()};
    loop_system_solve(system);
    system->sweep->apply(system);
    system->sweep->outwards(system, system->response);
    system->base = base;
}

void multibody_displace(const ld_mstmm *system, const double *q, double size, const double *d,
                        double *out)
{
    memcpy(out, q, (size_t)system->q_count * sizeof *q);
    for (int e = 0; e < system->element_count; e++) {
        const ld_hinge hinge = system->element[e].hinge;
        const double *by = d + system->element_u[e];
        double *to = out + system->element_q[e];
        int plain = system->u_length[e];
        if (hinge == LD_HINGE_SPHERICAL || hinge == LD_HINGE_FREE) {
            plain = hinge == LD_HINGE_FREE ? 3 : 0;
            v3 turn = v3_scale(size, v3_from(by + plain));
            quat q_new = q_multiply(q_from(to + plain), rv_quaternion(turn));
            memcpy(to + plain, &q_new, sizeof q_new);
        }
        for (int k = 0; k < plain; k++)
            to[k] += size * by[k];
        to += system->q_length[e];
        by += system->u_length[e];
        for (int k = 0; system->element[e].beam && k < system->beams[system->element_beam[e]].modes;
             k++)
            to[k] += size * by[k];
    }
}

// Sum of the squares of all gaps.
static double open_gaps(const ld_mstmm *system)
{
    double sum = 0;
    for (int i = 0; i < system->loop_count; i++)
        for (int a = 0; a < system->loop_work[i].active; a++)
            sum += system->loop_work[i].gap[a] * system->loop_work[i].gap[a];
    return sum;
}

// The joint that is widest open, in lengths and angles; what is left there.
static int widest(ld_mstmm *system, double *gap, double *turn)
{
    int worst = 0;
    double most = -1;
    *gap = *turn = 0;
    for (int i = 0; i < system->loop_count; i++) {
        double distance, angle;
        loop_opening(system, &system->loop[i], &distance, &angle);
        // NaN counts
        if (!(distance + angle <= most)) {
            most = distance + angle;
            worst = i;
        }
        *gap = fmax(*gap, distance);
        *turn = fmax(*turn, angle);
    }
    return worst;
}

// ---- guesses

// A row's scale is the largest response to its own force that has been met.
static void scale_rows(ld_mstmm *system)
{
    for (int i = 0; i < system->loop_count; i++) {
        loop_work *w = &system->loop_work[i];
        const double *S = w->S + (size_t)(i - system->loop[i].first) * 36;
        for (int a = 0; a < w->active; a++)
            w->scale[a] = fmax(w->scale[a], S[7 * a]);
    }
}

// Largest turn or displacement of a response.
static double size_of(const ld_mstmm *system, const double *response)
{
    double most = 0;
    for (int k = 0; k < system->u_count; k++)
        most = fmax(most, fabs(response[k]));
    return most;
}

// Gaps at q; after it only they and the places are what they were made for.
static double gaps_at(ld_mstmm *system, const double *q, loop_purpose purpose)
{
    multibody_move(system, q, system->zero);
    loops_place(system, system->zero);
    loops_make_rows(system, purpose);
    return open_gaps(system);
}

// The equations of the loops at q, factored.
static ld_status prepare(ld_mstmm *system, const double *q, loop_purpose purpose,
                         const loop_pivots *pivots, ld_error *error)
{
    int singular = stand(system, q);
    if (singular)
        return multibody_singular(system, singular, error);
    loops_make_rows(system, purpose);
    propagate_still(system);
    scale_rows(system);
    system->singularity = loop_system_factor(system, pivots, &system->singular_loop);
    return LD_OK;
}

// Levenberg and Marquardt's steps from any guess to where the loops are all but closed: a row that
// depends on others is no harm. Leaves q where it cannot come closer.
static ld_status approach(ld_mstmm *system, double *q, int *iterations, ld_error *error)
{
    const double least_shift = 1e-10, most_shift = 1e4, longest = 0.7;
    loop_pivots pivots = {.shift = 1e-8};
    for (int k = 0; k < 200; k++, ++*iterations) {
        ld_status status = prepare(system, q, LOOPS_FAR, &pivots, error);
        const double open = open_gaps(system);
        if (status || open < 1e-22 || pivots.shift > most_shift)
            return status;
        respond(system);
        double step = fmin(1, longest / fmax(longest, size_of(system, system->response)));
        bool closer = false;
        for (int half = 0; half < 8 && !closer; half++, step *= 0.5) {
            multibody_displace(system, q, step, system->response, system->trial);
            closer = gaps_at(system, system->trial, LOOPS_FAR) < open;
        }
        if (closer)
            memcpy(q, system->trial, (size_t)system->q_count * sizeof *q);
        pivots.shift = closer ? fmax(0.1 * pivots.shift, least_shift) : 100 * pivots.shift;
    }
    return LD_OK;
}

// Newton's steps to rounding. The equations are those at q, or a rounding beside it.
static ld_status finish(ld_mstmm *system, double *q, const loop_pivots *pivots, ld_error *error)
{
    double before = INFINITY;
    for (int k = 0; k < 12; k++) {
        ld_status status = prepare(system, q, LOOPS_PLACES, pivots, error);
        const double open = open_gaps(system);
        if (status || !(open < 0.25 * before))
            return status;
        before = open;
        respond(system);
        multibody_displace(system, q, 1, system->response, system->trial);
        memcpy(q, system->trial, (size_t)system->q_count * sizeof *q);
    }
    return LD_OK;
}

// Takes out of u what opens the loops, by the equations of the latest prepare() at q.
static double straighten(ld_mstmm *system, const double *q, double *u)
{
    multibody_move(system, q, u);
    loops_place(system, u);
    loops_make_rows(system, LOOPS_SPEEDS);
    const double open = open_gaps(system);
    // the beams' factors are gone with their new motion
    if (system->beam_count > 0)
        stand(system, q);
    respond(system);
    for (int k = 0; k < system->u_count; k++)
        u[k] += system->response[k];
    return open;
}

// Whether all joints fit but for rounding, against how far they are from the origin.
static bool is_closed(const ld_mstmm *system, double gap, double turn)
{
    double reach = 1;
    for (int i = 0; i < system->loop_count; i++) {
        loop_side side[2];
        loop_sides(system, &system->loop[i], side);
        reach = fmax(reach, v3_norm(side[0].position));
    }
    return gap <= 1e-9 * reach && turn <= 1e-9;
}

static ld_status check_closed(ld_mstmm *system, const double *q, double *gap, double *turn,
                              ld_error *error)
{
    gaps_at(system, q, LOOPS_PLACES);
    int worst = widest(system, gap, turn);
    if (is_closed(system, *gap, *turn))
        return LD_OK;
    loop_opening(system, &system->loop[worst], gap, turn);
    return ld_fail(error, LD_ERR_INPUT,
                   "loop '%s' cannot be closed: %.3g m and %.3g rad are left between its sides",
                   system->loop_name[worst], *gap, *turn);
}

// ---- what depends on what

// What a row's response is measured by: that of its unit wrench if nothing were in the way of its
// turning each axis.
static double reach_of(const ld_mstmm *system, const loop *l, const loop_row *row)
{
    loop_side side[2];
    double sum = 0;
    loop_sides(system, l, side);
    for (int p = 0; p < l->part[0] + l->part[1] + l->part[2]; p++) {
        const int i = l->path[p];
        const node *n = &system->node[i];
        double arm = v3_norm(v3_sub(side[1].position, system->place[i].linear));
        double moment = row->turns ? 1 : arm, force = row->turns ? 0 : 1;
        const axis_record *axis = &system->axis[n->axis];
        for (int k = 0; n->body != NODE_SECTION && k < node_speeds(n); k++) {
            bool slides = n->hinge == NODE_SLIDE || (n->hinge == NODE_FREE && k >= 3);
            double along = slides ? force : moment + force;
            sum += along * along * axis[k].inverse;
        }
        if (n->body == NODE_BEAM)
            sum += 1;
    }
    return sum;
}

// A number between -1 and 1.
static double draw(uint64_t pose, int k)
{
    return 2 * random_uniform(0, random_stream("poses of loops"), pose, (uint64_t)k, 0) - 1;
}

double multibody_turn(const ld_mstmm *system, const double *d)
{
    double most = 0;
    for (int e = 0; e < system->element_count; e++)
        if (system->element[e].beam)
            most = fmax(most, beam_turn(&system->beams[system->element_beam[e]],
                                        d + system->element_u[e] + system->u_length[e]));
    return most;
}

// A random displacement of all speeds, beams with geometric stiffness nearly straight.
static void draw_displacement(ld_mstmm *system, uint64_t pose, double *d)
{
    for (int k = 0; k < system->u_count; k++)
        d[k] = draw(pose, k);
    double small = 0.03 / fmax(0.03, multibody_turn(system, d));
    for (int e = 0; e < system->element_count; e++) {
        if (!system->element[e].beam)
            continue;
        double *modal = d + system->element_u[e] + system->u_length[e];
        for (int k = 0; k < system->beams[system->element_beam[e]].modes; k++)
            modal[k] *= small;
    }
}

// Leaves out rows that no motion of the tree opens, closed or not: those without response in random
// states. Planar loops of spatial joints have three of them each.
static ld_status leave_out_dead_rows(ld_mstmm *system, const double *q, ld_error *error)
{
    double(*response)[6] = calloc((size_t)system->loop_count + 1, sizeof *response);
    if (!response)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    for (int i = 0; i < system->loop_count; i++) {
        loop_work *w = &system->loop_work[i];
        w->active = w->limit = system->loop[i].row_count;
        for (int r = 0; r < w->active; r++)
            w->active_row[r] = r;
    }
    for (int pose = 0; pose < 3; pose++) {
        draw_displacement(system, (uint64_t)pose, system->response);
        multibody_displace(system, q, 1, system->response, system->trial);
        if (stand(system, system->trial))
            continue;
        loops_make_rows(system, LOOPS_PLACES);
        propagate_still(system);
        for (int i = 0; i < system->loop_count; i++) {
            const loop *l = &system->loop[i];
            const double *S = system->loop_work[i].S + (size_t)(i - l->first) * 36;
            for (int r = 0; r < l->row_count; r++)
                if (S[7 * r] > dead_pivot * reach_of(system, l, &l->row[r]))
                    response[i][r] = fmax(response[i][r], S[7 * r]);
        }
    }
    for (int i = 0; i < system->loop_count; i++) {
        loop_work *w = &system->loop_work[i];
        w->active = 0;
        for (int r = 0; r < system->loop[i].row_count; r++)
            if (response[i][r] > 0) {
                w->scale[w->active] = response[i][r];
                w->active_row[w->active++] = r;
            }
    }
    free(response);
    return LD_OK;
}

// Moves q from a closed pose along a random direction in which the closed system can move, and
// closes it again. u: room for speeds.
static bool wander(ld_mstmm *system, uint64_t pose, const double *from, double size, double *q,
                   double *u)
{
    const loop_pivots pivots = {.least = dependent_pivot};
    double gap, turn;
    int steps = 0;
    if (prepare(system, from, LOOPS_PLACES, &pivots, NULL))
        return false;
    for (int e = 0, k = 0; e < system->element_count; e++) {
        const int end = e + 1 < system->element_count ? system->element_u[e + 1] : system->u_count;
        for (; k < end; k++)
            u[k] = system->prescribed[e] ? 0 : draw(pose, k);
    }
    straighten(system, from, u);
    multibody_displace(system, from, size / fmax(size_of(system, u), DBL_MIN), u, q);
    return !approach(system, q, &steps, NULL) && !finish(system, q, &pivots, NULL) &&
           !check_closed(system, q, &gap, &turn, NULL) &&
           !prepare(system, q, LOOPS_PLACES, &pivots, NULL);
}

// Independent rows of loops 0 to i in the pose of the latest prepare(), where more than before.
static void count_rows(const ld_mstmm *system, int *most)
{
    int sum = 0;
    for (int i = 0; i < system->loop_count; i++) {
        sum += system->loop_work[i].rank;
        most[i] = sum > most[i] ? sum : most[i];
    }
}

// Each loop's independent rows, those before counted first, in general poses near q: the largest
// count over q and some poses beside it.
static ld_status find_limits(ld_mstmm *system, const double *q, ld_error *error)
{
    const loop_pivots pivots = {.least = dependent_pivot};
    double *pose = malloc(((size_t)system->q_count + (size_t)system->u_count + 1) * sizeof *pose);
    int *most = calloc((size_t)system->loop_count + 1, sizeof *most);
    ld_status status = LD_OK;
    if (!pose || !most)
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    if (!status)
        status = prepare(system, q, LOOPS_PLACES, &pivots, error);
    if (!status)
        count_rows(system, most);
    for (uint64_t k = 0; !status && k < 3; k++) {
        double size = 0.2;
        for (int i = 0; i < 3; i++, size *= 0.3)
            if (wander(system, k, q, size, pose, pose + system->q_count)) {
                count_rows(system, most);
                break;
            }
    }
    for (int i = 0; !status && i < system->loop_count; i++)
        system->loop_work[i].limit = most[i] - (i > 0 ? most[i - 1] : 0);
    free(pose);
    free(most);
    return status;
}

// ---- assembly and projection

static ld_status close_guess(ld_mstmm *system, double *q, ld_mstmm_assembly *found, ld_error *error)
{
    const loop_pivots pivots = {.least = dependent_pivot};
    ld_status status = approach(system, q, &found->iterations, error);
    if (!status)
        status = finish(system, q, &pivots, error);
    return status ? status : check_closed(system, q, &found->gap, &found->turn, error);
}

// Beams flex only where hinges alone do not close the loops.
static ld_status close_from(ld_mstmm *system, double *q, ld_mstmm_assembly *found, ld_error *error)
{
    if (system->beam_count == 0)
        return close_guess(system, q, found, error);
    double *start = malloc(((size_t)system->q_count + 1) * sizeof *start);
    if (!start)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a multibody system");
    memcpy(start, q, (size_t)system->q_count * sizeof *q);
    system->beams_rigid = true;
    ld_status status = close_guess(system, q, found, NULL);
    system->beams_rigid = false;
    if (status) {
        memcpy(q, start, (size_t)system->q_count * sizeof *q);
        status = close_guess(system, q, found, error);
    }
    free(start);
    return status;
}

static void count_freedoms(const ld_mstmm *system, ld_mstmm_assembly *found)
{
    found->held = found->redundant = 0;
    for (int i = 0; i < system->loop_count; i++) {
        found->held += system->loop_work[i].limit;
        found->redundant += ld_mstmm_loop_redundancy(system, i);
    }
    found->freedoms = system->u_count - found->held;
    for (int e = 0; e < system->element_count; e++)
        found->freedoms -= system->prescribed[e] ? system->u_length[e] : 0;
    found->singularity = system->singularity;
}

// Makes the hinges that are to be kept prescribed, or those that were not free again.
static void keep_hinges(ld_mstmm *system, const int *kept, bool on)
{
    for (int e = 0; kept && e < system->element_count; e++)
        if (kept[e] && !system->element[e].prescribed)
            ld_mstmm_prescribe(system, e, on);
}

ld_status ld_mstmm_assemble(ld_mstmm *system, double *q, double *u, const int *kept,
                            ld_mstmm_assembly *report, ld_error *error)
{
    const loop_pivots limited = {.least = singular_pivot, .limited = true};
    ld_mstmm_assembly found = {0};
    keep_hinges(system, kept, true);
    ld_status status = leave_out_dead_rows(system, q, error);
    if (!status)
        status = close_from(system, q, &found, error);
    keep_hinges(system, kept, false);
    if (!status)
        status = find_limits(system, q, error);
    // the speeds, by the rows that are to be held
    if (!status && u) {
        keep_hinges(system, kept, true);
        for (int k = 0; !status && k < 2; k++) {
            status = prepare(system, q, LOOPS_PLACES, &limited, error);
            if (!status)
                straighten(system, q, u);
        }
        keep_hinges(system, kept, false);
    }
    if (!status)
        status = prepare(system, q, LOOPS_PLACES, &limited, error);
    system->assembled = !status;
    count_freedoms(system, &found);
    if (report)
        *report = found;
    return status;
}

ld_status ld_mstmm_project(ld_mstmm *system, double *q, double *u, ld_error *error)
{
    const loop_pivots pivots = {.least = singular_pivot, .limited = true};
    if (system->loop_count == 0)
        return LD_OK;
    int unused, singular = stand(system, q);
    if (singular)
        return multibody_singular(system, singular, error);
    loops_make_rows(system, LOOPS_PLACES);
    double open = open_gaps(system);
    const bool far = open > 1e-14;
    propagate_still(system);
    loop_system_factor(system, &pivots, &unused);
    // the factors serve all steps: they are off by as little as q is
    for (int k = 0; k < 6 && open > 0; k++) {
        if (system->beam_count > 0 && k > 0)
            stand(system, q);
        respond(system);
        multibody_displace(system, q, 1, system->response, system->trial);
        double now = gaps_at(system, system->trial, LOOPS_PLACES);
        if (!(now < open))
            break;
        memcpy(q, system->trial, (size_t)system->q_count * sizeof *q);
        const bool slow = now > 1e-6 * open;
        open = now;
        if (slow && k > 0)
            break;
    }
    double gap, turn;
    int worst = widest(system, &gap, &turn);
    if (!is_closed(system, gap, turn))
        return ld_fail(error, LD_ERR_NUMERIC,
                       "loop '%s' does not close again: %.3g m and %.3g rad are left",
                       system->loop_name[worst], gap, turn);
    for (int k = 0; k < (far ? 3 : 1); k++)
        straighten(system, q, u);
    return LD_OK;
}

// ---- questions

int ld_mstmm_loop_count(const ld_mstmm *system)
{
    return system->loop_count;
}

int ld_mstmm_find_loop(const ld_mstmm *system, const char *name)
{
    for (int i = 0; i < system->loop_count; i++)
        if (!strcmp(system->loop_name[i], name))
            return i;
    return -1;
}

int ld_mstmm_loop_redundancy(const ld_mstmm *system, int index)
{
    return system->loop[index].row_count - system->loop_work[index].limit;
}

double ld_mstmm_singularity(const ld_mstmm *system, int *index)
{
    if (index)
        *index = system->singular_loop;
    return system->singularity;
}

// ---- directions of motion

// Relative speeds of the active rows under unit speeds: G [rows][u_count].
static void make_jacobian(ld_mstmm *system, const double *q, double *unit, double *G)
{
    const int n = system->u_count;
    for (int k = 0; k < n; k++) {
        unit[k] = 1;
        multibody_move(system, q, unit);
        loops_place(system, unit);
        loops_make_rows(system, LOOPS_SPEEDS);
        unit[k] = 0;
        for (int i = 0, row = 0; i < system->loop_count; i++)
            for (int a = 0; a < system->loop_work[i].active; a++, row++)
                G[row * n + k] = system->loop_work[i].gap[a];
    }
}

// Gauss and Jordan's elimination with full pivoting of at most `most` rows: column pivot[i] becomes
// the i-th unit vector. Returns how many.
static int eliminate_dependent(int rows, int n, int most, const bool *given, double *G, int *pivot)
{
    double largest = 0;
    for (int count = 0; count < most; count++) {
        int row = count, column = -1;
        double best = 0;
        for (int i = count; i < rows; i++)
            for (int k = 0; k < n; k++)
                if (!given[k] && fabs(G[i * n + k]) > best) {
                    best = fabs(G[i * n + k]);
                    row = i;
                    column = k;
                }
        largest = fmax(largest, best);
        if (column < 0 || best < 1e-9 * largest)
            return count;
        pivot[count] = column;
        for (int k = 0; k < n; k++) {
            double held = G[row * n + k];
            G[row * n + k] = G[count * n + k];
            G[count * n + k] = held;
        }
        double scale = 1 / G[count * n + column];
        for (int k = 0; k < n; k++)
            G[count * n + k] *= scale;
        for (int i = 0; i < rows; i++) {
            double factor = G[i * n + column];
            for (int k = 0; i != count && factor != 0 && k < n; k++)
                G[i * n + k] -= factor * G[count * n + k];
        }
    }
    return most;
}

static void mark_given(const ld_mstmm *system, bool *given)
{
    for (int e = 0; e < system->element_count; e++)
        for (int k = 0; k < system->u_length[e]; k++)
            given[system->element_u[e] + k] = system->prescribed[e];
}

ld_status ld_mstmm_freedoms(ld_mstmm *system, const double *q, double *basis, int *count,
                            ld_error *error)
{
    const int n = system->u_count;
    int rows = 0, most = 0;
    for (int i = 0; i < system->loop_count; i++) {
        rows += system->loop_work[i].active;
        most += system->loop_work[i].limit;
    }
    double *G = calloc(((size_t)rows + 1) * ((size_t)n + 1), sizeof *G);
    int *pivot = calloc((size_t)rows + 1, sizeof *pivot);
    bool *given = calloc((size_t)n + 1, sizeof *given);
    ld_status status = LD_OK;
    *count = 0;
    if (!G || !pivot || !given)
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for directions of motion");
    if (!status) {
        mark_given(system, given);
        memset(system->response, 0, (size_t)n * sizeof *system->response);
        make_jacobian(system, q, system->response, G);
        int held = eliminate_dependent(rows, n, most, given, G, pivot);
        for (int i = 0; i < held; i++)
            given[pivot[i]] = true;
        for (int k = 0; k < n; k++) {
            if (given[k])
                continue;
            double *row = basis + (size_t)(*count)++ * (size_t)n;
            memset(row, 0, (size_t)n * sizeof *row);
            row[k] = 1;
            for (int i = 0; i < held; i++)
                row[pivot[i]] = -G[i * n + k];
        }
    }
    free(G);
    free(pivot);
    free(given);
    return status;
}
