#include "support/rigid_rest.h"

#include "math/matrices/lapack.h"
#include "model/model.h"
#include <math.h>
#include <string.h>

#include "math/vectors/rotation_vector.h"
#include "model/guide.h"
#include "support/check.h"

// Freedoms: O1 along y and z, turns about x, y and z of the guide.
enum { FREEDOMS = 5 };

typedef struct rest_problem {
    const ld_model *model;
    v3 gravity, c;
    double mass;
    bool rolls;
    int surfaces;
    ld_surface surface[LD_MAX_SURFACES];
} rest_problem;

static rigid_pose moved(const rigid_pose *pose, const double u[FREEDOMS])
{
    m3 turn = rv_exp(v3_make(u[2], u[3], u[4]));
    return (rigid_pose){v3_add(pose->r, v3_make(0, u[0], u[1])), m3_mul(turn, pose->A)};
}

rigid_pose rigid_centre(const ld_model *model)
{
    const double *line = model->tubes.guide.line;
    return (rigid_pose){v3_make(0, line[0], line[1]), m3_identity()};
}

// Energy of a force field of potential -f . x at point X of the rocket (from O1), and what it does
// to the freedoms.
static void add_force(v3 arm, v3 f, double gradient[FREEDOMS])
{
    v3 m = v3_cross(arm, f);
    const double on[FREEDOMS] = {f.y, f.z, m.x, m.y, m.z};
    for (int i = 0; i < FREEDOMS; i++)
        gradient[i] -= on[i];
}

// Energy, and its gradient; a spring of the contact's law stands at each shoe on each surface.
static double energy_of(const rest_problem *the, const rigid_pose *pose, double gradient[FREEDOMS])
{
    const ld_rocket *rocket = &the->model->rocket;
    const ld_contact *law = &rocket->contact;
    const double *line = the->model->tubes.guide.line;
    v3 weight = v3_scale(the->mass, the->gravity), centre = m3_apply(pose->A, the->c);
    v3 from_line = v3_sub(pose->r, v3_make(0, line[0], line[1]));
    double energy = -v3_dot(weight, v3_add(from_line, v3_sub(centre, the->c)));
    memset(gradient, 0, FREEDOMS * sizeof *gradient);
    add_force(centre, weight, gradient);
    for (int i = 0; i < rocket->adaptor_count; i++)
        for (int k = 0; k < the->surfaces; k++) {
            const ld_surface *s = &the->surface[k];
            bool flat = s->shape == LD_SURFACE_FLAT;
            v3 n = v3_make(0, cos(s->normal), sin(s->normal));
            v3 own = v3_make(0, flat ? s->at[0] : 0, flat ? s->at[1] : 0);
            v3 arm = m3_apply(pose->A, v3_add(v3_make(rocket->adaptor[i].at, 0, 0), own));
            double p = v3_dot(n, v3_sub(v3_add(from_line, arm), own)) - s->gap;
            p -= isnan(rocket->adaptor[i].clearance) ? 0 : rocket->adaptor[i].clearance;
            if (p <= 0)
                continue;
            double ratio = p / law->reference_penetration;
            double f = law->stiffness * law->reference_penetration * pow(ratio, law->exponent);
            energy += f * p / (law->exponent + 1);
            add_force(arm, v3_scale(-f, n), gradient);
        }
    if (!the->rolls)
        gradient[2] = 0;
    return energy;
}

// Second derivatives, by differences.
static void curvature_of(const rest_problem *the, const rigid_pose *pose,
                         double H[FREEDOMS][FREEDOMS])
{
    const double h = 1e-8;
    for (int j = 0; j < FREEDOMS; j++) {
        double u[FREEDOMS] = {0}, side[2][FREEDOMS];
        for (int i = 0; i < 2; i++) {
            u[j] = i ? h : -h;
            rigid_pose trial = moved(pose, u);
            energy_of(the, &trial, side[i]);
        }
        for (int i = 0; i < FREEDOMS; i++)
            H[i][j] = (side[1][i] - side[0][i]) / (2 * h);
    }
    for (int i = 0; i < FREEDOMS && !the->rolls; i++)
        H[i][2] = H[2][i] = 0;
}

// A step down a hill that is round enough with `damping`; false where it is not.
static bool step_down(double H[FREEDOMS][FREEDOMS], const double gradient[FREEDOMS], double damping,
                      double step[FREEDOMS])
{
    double damped[FREEDOMS * FREEDOMS];
    for (int i = 0; i < FREEDOMS; i++) {
        for (int j = 0; j < FREEDOMS; j++)
            damped[FREEDOMS * i + j] = 0.5 * (H[i][j] + H[j][i]) + (i == j ? damping : 0);
        step[i] = -gradient[i];
    }
    return LAPACKE_dposv(LAPACK_ROW_MAJOR, 'U', FREEDOMS, 1, damped, FREEDOMS, step, 1) == 0;
}

// Between round surfaces alone roll does not count.
static double off_centre(const rest_problem *the, const rigid_pose *pose)
{
    double way = v3_norm(v3_sub(pose->r, rigid_centre(the->model).r));
    double tilt = atan2(hypot(pose->A.a[1][0], pose->A.a[2][0]), pose->A.a[0][0]);
    return fmax(way, guide_is_flat(&the->model->tubes.guide) ? v3_norm(rv_log(pose->A)) : tilt);
}

rigid_rest rigid_rest_from(const ld_model *model, v3 gravity, bool rolls, const rigid_pose *pose)
{
    const ld_rocket *rocket = &model->rocket;
    rest_problem the = {.model = model, .gravity = gravity, .rolls = rolls};
    the.surfaces = guide_surfaces(&model->tubes.guide, the.surface);
    the.mass = rocket->full.mass + rocket->mass_error;
    the.c = v3_add(v3_from(rocket->full.center),
                   v3_make(0, rocket->eccentricity[0], rocket->eccentricity[1]));
    rigid_rest at = {.pose = *pose};
    double gradient[FREEDOMS], H[FREEDOMS][FREEDOMS], damping = 1e6;
    at.energy = energy_of(&the, &at.pose, gradient);
    // along the kink of a wall it creeps: of 200 random channels three need more than 10000 steps,
    // one of them 50000
    for (int k = 0; k < 200000; k++) {
        double size = 0, step[FREEDOMS], next_gradient[FREEDOMS];
        for (int i = 0; i < FREEDOMS; i++)
            size = fmax(size, fabs(gradient[i]));
        at.off = off_centre(&the, &at.pose);
        at.found = at.off <= 0.6;
        if (!at.found || size < 1e-6 * the.mass * v3_norm(gravity))
            return at;
        if (damping > 1e14) { // nowhere lower, to rounding
            at.found = size < 1e-3 * the.mass * v3_norm(gravity);
            return at;
        }
        curvature_of(&the, &at.pose, H);
        while (!step_down(H, gradient, damping, step))
            damping *= 3;
        rigid_pose next = moved(&at.pose, step);
        double energy = energy_of(&the, &next, next_gradient);
        if (energy >= at.energy) {
            damping *= 3;
            continue;
        }
        at.pose = next;
        at.energy = energy;
        memcpy(gradient, next_gradient, sizeof gradient);
        damping = fmax(1e-3, damping / 3);
    }
    fail_msg("a rigid rocket still sinks after 200000 steps");
    return at;
}
