// Random mechanisms with one to four closed loops of all kinds of joints, against a dense program
// with Lagrange's multipliers: mass matrix and forces of support/dense_tree.h, constraints written
// as functions of the relative pose in Taylor series. No kinematics of the library enters.
#include "launchdyn/mstmm.h"

#include <stdlib.h>
#include <string.h>

#include "support/check.h"
#include "support/dense_tree.h"
#include "support/draw.h"

enum { MECHANISMS = OF_ALL(600, 60), LOOPS = 4, ROWS = 24 };

static const int held_by[KINDS] = {6, 5, 5, 4, 4, 3, 0, 3};

typedef struct mechanism {
    specimen tree;
    int count, rows;
    char name[LOOPS][8];
    ld_mstmm_loop loop[LOOPS];
    double x[LOOPS][7]; // coordinates of the joints
} mechanism;

static moving unit[SPEEDS][BODIES], now[BODIES];
static real M[SPEEDS][SPEEDS], G[ROWS][SPEEDS], A[EQUATIONS][EQUATIONS];

// ---- poses

typedef struct pose {
    jet3 origin;
    jet33 R;
} pose;

static int find(const specimen *s, const char *name)
{
    for (int i = 0; name && i < s->count; i++)
        if (!strcmp(s->name[i], name))
            return i;
    return -1;
}

// A joint's frame on an element along a path.
static pose frame_on(const specimen *s, const moving *body, const ld_mstmm_end *end)
{
    int i = find(s, end->element);
    pose p = {.R = jet33_identity()};
    memset(&p.origin, 0, sizeof p.origin);
    if (i >= 0)
        p = (pose){body[i].origin, body[i].R};
    p.origin = jet3_add(p.origin, jet33_apply(p.R, jet3_constant(end->at)));
    p.R = jet33_multiply(p.R, jet33_quaternion(end->attitude));
    return p;
}

// Place and turn of frame b in frame a.
static pose relative(pose a, pose b)
{
    jet33 back = jet33_transpose(a.R);
    jet3 d;
    for (int k = 0; k < 3; k++)
        d.a[k] = jet_add(b.origin.a[k], jet_scale(-1, a.origin.a[k]));
    return (pose){jet33_apply(back, d), jet33_multiply(back, b.R)};
}

static void store_quaternion(const jet33 *R, double q[4])
{
    m3 plain;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            plain.a[i][j] = (double)R->a[i][j].c[0];
    quat p = q_from_matrix(plain);
    memcpy(q, &p, sizeof p);
}

// ---- constraints

static jet dot(const real v[3], jet3 d)
{
    jet sum = {{0}};
    for (int k = 0; k < 3; k++)
        sum = jet_add(sum, jet_scale(v[k], d.a[k]));
    return sum;
}

static void unit_vector(const double v[3], real out[3])
{
    real n = sqrtl((real)v[0] * v[0] + (real)v[1] * v[1] + (real)v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        out[k] = v[k] / n;
}

// Two directions across a unit vector.
static void across(const real z[3], real x[3], real y[3])
{
    double any[3] = {fabsl(z[0]) < 0.6L ? 1 : 0, fabsl(z[0]) < 0.6L ? 0 : 1, 0}, c[3];
    for (int k = 0; k < 3; k++)
        c[k] = (double)(any[(k + 1) % 3] * z[(k + 2) % 3] - any[(k + 2) % 3] * z[(k + 1) % 3]);
    unit_vector(c, x);
    for (int k = 0; k < 3; k++)
        y[k] = z[(k + 1) % 3] * x[(k + 2) % 3] - z[(k + 2) % 3] * x[(k + 1) % 3];
}

// What the joint keeps at zero, as functions of the relative pose; returns their number.
static int constraints_of(const ld_mstmm_loop *l, pose p, jet *row)
{
    static const real e[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    real z[3], x[3], y[3], b[3];
    int n = 0;
    unit_vector(l->axis, z);
    unit_vector(l->axis_2, b);
    across(z, x, y);
    switch (l->joint) {
    case LD_HINGE_WELD:
    case LD_HINGE_REVOLUTE:
    case LD_HINGE_UNIVERSAL:
    case LD_HINGE_SPHERICAL:
        for (int k = 0; k < 3; k++)
            row[n++] = dot(e[k], p.origin);
        break;
    case LD_HINGE_PRISMATIC:
    case LD_HINGE_CYLINDRICAL:
        row[n++] = dot(x, p.origin);
        row[n++] = dot(y, p.origin);
        break;
    default:
        row[n++] = dot(z, p.origin);
    }
    jet3 z_now, b_now;
    for (int i = 0; i < 3; i++) {
        z_now.a[i] = dot(z, (jet3){{p.R.a[i][0], p.R.a[i][1], p.R.a[i][2]}});
        b_now.a[i] = dot(b, (jet3){{p.R.a[i][0], p.R.a[i][1], p.R.a[i][2]}});
    }
    switch (l->joint) {
    case LD_HINGE_WELD:
    case LD_HINGE_PRISMATIC:
        // the skew part
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3;
            row[n++] = jet_add(p.R.a[i][j], jet_scale(-1, p.R.a[j][i]));
        }
        break;
    case LD_HINGE_UNIVERSAL: {
        real cosine = 0;
        for (int k = 0; k < 3; k++)
            cosine += z[k] * b[k];
        row[n] = dot(z, b_now);
        row[n++].c[0] -= cosine;
        break;
    }
    case LD_HINGE_SPHERICAL:
        break;
    default:
        row[n++] = dot(x, z_now);
        row[n++] = dot(y, z_now);
    }
    return n;
}

// All constraints along a path.
static int evaluate(const mechanism *m, const moving *body, jet row[ROWS])
{
    int n = 0;
    for (int i = 0; i < m->count; i++) {
        const ld_mstmm_loop *l = &m->loop[i];
        pose p =
            relative(frame_on(&m->tree, body, &l->first), frame_on(&m->tree, body, &l->second));
        n += constraints_of(l, p, row + n);
    }
    return n;
}

// ---- random mechanisms

// A joint between two elements that stand as they do, at random coordinates of its own.
static void draw_loop(mechanism *m, uint64_t *seed)
{
    specimen *s = &m->tree;
    ld_mstmm_loop *l = &m->loop[m->count];
    const double none[SPEEDS] = {0};
    memset(l, 0, sizeof *l);
    snprintf(m->name[m->count], sizeof m->name[0], "l%d", m->count);
    l->name = m->name[m->count];
    do
        l->joint = (ld_hinge)tree_pick(KINDS, seed);
    while (l->joint == LD_HINGE_FREE);
    int i = tree_pick(s->count + 1, seed) - 1, j;
    do
        j = tree_pick(s->count, seed);
    while (i == j);
    l->first.element = i >= 0 ? s->name[i] : NULL;
    l->second.element = s->name[j];
    tree_fill(l->first.at, 3, 0.5, seed);
    tree_fill(l->first.attitude, 4, 1, seed);
    tree_fill(l->axis, 3, 1, seed);
    tree_fill(l->axis_2, 3, 1, seed);
    tree_fill(m->x[m->count], 7, 1, seed);

    // the second side where the joint is then
    tree_trace(s, none, now);
    pose first = frame_on(s, now, &l->first), body = {now[j].origin, now[j].R}, p;
    tree_joint(l->joint, l->axis, l->axis_2, m->x[m->count], none, &p.origin, &p.R);
    p.origin = jet3_add(first.origin, jet33_apply(first.R, p.origin));
    p.R = jet33_multiply(first.R, p.R);
    p = relative(body, p);
    for (int k = 0; k < 3; k++)
        l->second.at[k] = (double)p.origin.a[k].c[0];
    store_quaternion(&p.R, l->second.attitude);
    m->rows += held_by[l->joint];
    m->count++;
}

// G from unit speeds; returns the rows.
static int make_jacobian(const mechanism *m)
{
    jet row[ROWS];
    int n = 0;
    for (int k = 0; k < m->tree.u_count; k++) {
        double e[SPEEDS] = {0};
        e[k] = 1;
        tree_trace(&m->tree, e, now);
        n = evaluate(m, now, row);
        for (int r = 0; r < n; r++)
            G[r][k] = row[r].c[1];
    }
    return n;
}

// Takes the part that opens the loops out of u: u -= G^T (G G^T)^-1 G u. Returns the condition, 0
// where a constraint is none.
static real close_speeds(mechanism *m)
{
    static real GG[ROWS][ROWS];
    real b[ROWS], x[ROWS];
    int n = make_jacobian(m);
    for (int r = 0; r < n; r++) {
        b[r] = 0;
        for (int k = 0; k < m->tree.u_count; k++)
            b[r] += G[r][k] * m->tree.u[k];
        for (int c = 0; c < n; c++) {
            GG[r][c] = 0;
            for (int k = 0; k < m->tree.u_count; k++)
                GG[r][c] += G[r][k] * G[c][k];
        }
    }
    real condition = tree_solve(n, ROWS, &GG[0][0], b, x);
    for (int r = 0; r < n; r++)
        condition = GG[r][r] > 1e-6L ? condition : 0;
    for (int r = 0; r < n; r++)
        for (int k = 0; k < m->tree.u_count; k++)
            m->tree.u[k] -= (double)(G[r][k] * x[r]);
    return condition;
}

// A mechanism of so many loops, of independent constraints.
static void draw_mechanism(mechanism *m, int wanted, uint64_t *seed)
{
    real condition = 0;
    do {
        memset(m, 0, sizeof *m);
        tree_draw(&m->tree, KINDS, seed);
        for (int k = 0; k < wanted && m->rows + 6 < m->tree.u_count; k++)
            draw_loop(m, seed);
        if (m->count == wanted)
            condition = close_speeds(m);
        // without a solution the condition is not a number, or 0
    } while (m->count < wanted || !(condition >= 1 && condition < 1e6L && isfinite(m->tree.u[0])));
}

static ld_mstmm *build(const mechanism *m)
{
    ld_mstmm_description d = {.elements = m->tree.element,
                              .element_count = m->tree.count,
                              .loops = m->loop,
                              .loop_count = m->count};
    memcpy(d.gravity, m->tree.gravity, sizeof d.gravity);
    ld_mstmm *system;
    ld_error error;
    if (ld_mstmm_build(&d, &system, &error))
        fail_msg("%s", error.text);
    return system;
}

// ---- the dense program: M u_dot - G^T force = h, G u_dot = -(second derivative without u_dot)

static real solve_dense(const mechanism *m, real *u_dot)
{
    const specimen *s = &m->tree;
    const int n = s->u_count, rows = make_jacobian(m);
    real b[EQUATIONS], x[EQUATIONS];
    jet row[ROWS];
    tree_assemble(s, unit, M, b);
    tree_trace(s, s->u, now);
    evaluate(m, now, row);
    memset(A, 0, sizeof A);
    for (int k = 0; k < n; k++) {
        for (int l = 0; l < n; l++)
            A[k][l] = M[k][l];
        for (int r = 0; r < rows; r++) {
            A[k][n + r] = -G[r][k];
            A[n + r][k] = G[r][k];
        }
    }
    for (int r = 0; r < rows; r++)
        b[n + r] = -2 * row[r].c[2];
    real condition = tree_solve(n + rows, EQUATIONS, &A[0][0], b, x);
    memcpy(u_dot, x, (size_t)n * sizeof *x);
    return condition;
}

// Part of M u_dot - h that the joints' forces, as reported, do not give: their virtual work on both
// sides at the second point.
static double forces_missing(const mechanism *m, ld_mstmm *system, const real *u_dot)
{
    const specimen *s = &m->tree;
    real need[SPEEDS], size = 0, worst = 0;
    tree_assemble(s, unit, M, need);
    for (int k = 0; k < s->u_count; k++) {
        need[k] = -need[k];
        for (int l = 0; l < s->u_count; l++)
            need[k] += M[k][l] * u_dot[l];
        size = fmaxl(size, fabsl(need[k]));
    }
    const double none[SPEEDS] = {0};
    tree_trace(s, none, now);
    for (int i = 0; i < m->count; i++) {
        double force[6];
        ld_mstmm_loop_force(system, i, force);
        pose at = frame_on(s, now, &m->loop[i].second);
        int body[2] = {find(s, m->loop[i].first.element), find(s, m->loop[i].second.element)};
        for (int k = 0; k < s->u_count; k++)
            for (int side = 0; side < 2; side++) {
                if (body[side] < 0)
                    continue;
                const moving *b = &unit[k][body[side]];
                real w[3], unused[3], power = 0, r[3];
                tree_rates(&b->R, w, unused);
                for (int a = 0; a < 3; a++)
                    r[a] = at.origin.a[a].c[0] - b->origin.a[a].c[0];
                for (int a = 0; a < 3; a++) {
                    int c = (a + 1) % 3, d = (a + 2) % 3;
                    power += force[a] * (b->origin.a[a].c[1] + w[c] * r[d] - w[d] * r[c]) +
                             force[3 + a] * w[a];
                }
                need[k] -= side ? power : -power;
            }
    }
    for (int k = 0; k < s->u_count; k++)
        worst = fmaxl(worst, fabsl(need[k]));
    return (double)(worst / size);
}

static void test_accelerations_are_those_of_multipliers(void **state)
{
    (void)state;
    static mechanism m;
    uint64_t seed = 31;
    int kinds[KINDS] = {0}, loops[LOOPS + 1] = {0};
    double worst = 0, worst_force = 0, least = 1;
    for (int i = 0; i < MECHANISMS; i++) {
        real expected[SPEEDS];
        double u_dot[SPEEDS], off = 0, size = 0;
        ld_error error = {0};
        ld_mstmm_assembly found;
        draw_mechanism(&m, 1 + i % LOOPS, &seed);
        loops[m.count]++;
        for (int k = 0; k < m.count; k++)
            kinds[m.loop[k].joint]++;
        ld_mstmm *system = build(&m);
        if (ld_mstmm_assemble(system, m.tree.q, NULL, NULL, &found, &error))
            fail_msg("%s", error.text);
        assert_int_equal(found.held, m.rows);
        assert_int_equal(found.redundant, 0);
        assert_int_equal(found.freedoms, m.tree.u_count - m.rows);
        if (ld_mstmm_accelerations(system, m.tree.q, m.tree.u, m.tree.tau, m.tree.wrench, u_dot,
                                   &error))
            fail_msg("%s", error.text);
        solve_dense(&m, expected);
        for (int k = 0; k < m.tree.u_count; k++) {
            size = fmax(size, fabs((double)expected[k]));
            off = fmax(off, fabs((double)(u_dot[k] - expected[k])));
        }
        worst = fmax(worst, off / size);
        worst_force = fmax(worst_force, forces_missing(&m, system, expected));
        least = fmin(least, ld_mstmm_singularity(system, NULL));
        ld_mstmm_free(system);
    }
    for (int k = 0; k < KINDS; k++)
        assert_true(k == LD_HINGE_FREE || kinds[k] > OF_ALL(30, 2));
    printf("    %d mechanisms: %d, %d, %d, %d of 1 to 4 loops, least pivot %.1e\n", MECHANISMS,
           loops[1], loops[2], loops[3], loops[4], least);
    CHECK_BELOW("accelerations against multipliers, relative", worst, 1e-9);
    CHECK_BELOW("forces in the joints, relative", worst_force, 1e-9);
}

// Guesses off by much are closed; drift of a step goes; speeds close; u_dot does what they say.
static void test_closing(void **state)
{
    (void)state;
    static mechanism m;
    uint64_t seed = 9;
    double gap = 0, drift = 0, speed = 0;
    int closed = 0;
    for (int i = 0; i < MECHANISMS / 4; i++) {
        jet row[ROWS];
        ld_error error = {0};
        draw_mechanism(&m, 1 + i % LOOPS, &seed);
        ld_mstmm *system = build(&m);
        for (int k = 0; k < m.tree.q_count; k++)
            m.tree.q[k] += 0.2 * draw(&seed);
        ld_status status = ld_mstmm_assemble(system, m.tree.q, m.tree.u, NULL, NULL, &error);
        if (!status) {
            closed++;
            for (int pass = 0; pass < 2; pass++) {
                tree_trace(&m.tree, m.tree.u, now);
                int n = evaluate(&m, now, row);
                for (int r = 0; r < n; r++) {
                    double *most = pass ? &drift : &gap;
                    *most = fmax(*most, fabs((double)row[r].c[0]));
                    speed = fmax(speed, fabs((double)row[r].c[1]));
                }
                for (int k = 0; k < m.tree.q_count && !pass; k++)
                    m.tree.q[k] += 1e-5 * draw(&seed);
                if (!pass && ld_mstmm_project(system, m.tree.q, m.tree.u, &error))
                    fail_msg("%s", error.text);
            }
        }
        ld_mstmm_free(system);
    }
    printf("    %d of %d guesses closed\n", closed, MECHANISMS / 4);
    assert_true(closed > MECHANISMS / 5);
    CHECK_BELOW("gaps after assembly [m, rad]", gap, 1e-10);
    CHECK_BELOW("gaps after a step's projection [m, rad]", drift, 1e-12);
    CHECK_BELOW("speeds along the constraints after either [m/s, rad/s]", speed, 1e-9);
}

// Which body hangs on which does not matter to a joint that is described as a hinge or as a loop:
// the same accelerations of a chain, springs and dampers in the joint included.
static void test_a_loop_is_a_hinge(void **state)
{
    (void)state;
    uint64_t seed = 3;
    double worst = 0, worst_energy = 0, worst_state = 0;
    for (int kind = 0; kind < KINDS; kind++) {
        if (kind == LD_HINGE_FREE)
            continue;
        for (int trial = 0; trial < 20; trial++) {
            const double gravity[3] = {1, -9, 3};
            ld_mstmm_element e[2];
            memset(e, 0, sizeof e);
            for (int i = 0; i < 2; i++) {
                e[i].name = i ? "second" : "first";
                e[i].hinge = LD_HINGE_FREE;
                e[i].mass = 2 + draw(&seed);
                tree_fill(e[i].center, 3, 0.3, &seed);
                m3 J = draw_inertia(&seed, e[i].mass);
                double six[6] = {J.a[0][0], J.a[1][1], J.a[2][2], J.a[0][1], J.a[0][2], J.a[1][2]};
                memcpy(e[i].inertia, six, sizeof six);
            }
            // as a hinge
            ld_mstmm_element hinged[2] = {e[0], e[1]};
            hinged[1].parent = "first";
            hinged[1].hinge = (ld_hinge)kind;
            tree_fill(hinged[1].at, 3, 1, &seed);
            tree_fill(hinged[1].attitude, 4, 1, &seed);
            tree_fill(hinged[1].axis, 3, 1, &seed);
            tree_fill(hinged[1].axis_2, 3, 1, &seed);
            for (int k = 0; k < tree_speeds[kind]; k++) {
                hinged[1].stiffness[k] = 40 + 30 * draw(&seed);
                hinged[1].damping[k] = 4 + 3 * draw(&seed);
            }
            tree_fill(hinged[1].rest, 2, 0.3, &seed);
            if (kind == LD_HINGE_SPHERICAL)
                hinged[1].rest[0] = hinged[1].rest[1] = 0;
            ld_mstmm *tree, *closed;
            assert_int_equal(ld_mstmm_create(hinged, 2, gravity, &tree, NULL), LD_OK);
            double q[14], u[12], u_dot[12], x[14] = {0}, v[12] = {0}, v_dot[12];
            tree_fill(q, 7 + tree_coordinates[kind], 1, &seed);
            tree_fill(u, 6 + tree_speeds[kind], 1, &seed);
            // driven along the joint's speeds
            double tau[12] = {0}, wrench[12] = {0};
            tree_fill(tau + 6, tree_speeds[kind], 5, &seed);
            assert_int_equal(ld_mstmm_accelerations(tree, q, u, tau, NULL, u_dot, NULL), LD_OK);

            // as a loop: both bodies free, in the same places
            ld_mstmm_loop l = {.name = "joint", .joint = (ld_hinge)kind};
            l.first.element = "first";
            l.second.element = "second";
            memcpy(l.first.at, hinged[1].at, sizeof l.first.at);
            memcpy(l.first.attitude, hinged[1].attitude, sizeof l.first.attitude);
            memcpy(l.axis, hinged[1].axis, sizeof l.axis);
            memcpy(l.axis_2, hinged[1].axis_2, sizeof l.axis_2);
            memcpy(l.stiffness, hinged[1].stiffness, sizeof l.stiffness);
            memcpy(l.damping, hinged[1].damping, sizeof l.damping);
            memcpy(l.rest, hinged[1].rest, sizeof l.rest);
            const ld_mstmm_description d = {.elements = e,
                                            .element_count = 2,
                                            .loops = &l,
                                            .loop_count = 1,
                                            .gravity = {1, -9, 3}};
            assert_int_equal(ld_mstmm_build(&d, &closed, NULL), LD_OK);
            for (int i = 0; i < 2; i++) {
                const double origin[3] = {0};
                ld_mstmm_point p = ld_mstmm_locate(tree, q, u, i, origin);
                memcpy(x + 7 * i, p.position, sizeof p.position);
                memcpy(x + 7 * i + 3, p.attitude, sizeof p.attitude);
                memcpy(v + 6 * i, p.velocity, sizeof p.velocity);
                v3 w = m3_apply_transposed(q_matrix(q_from(p.attitude)), v3_from(p.rate));
                v3_store(v + 6 * i + 3, w);
            }
            ld_error error = {0};
            if (ld_mstmm_assemble(closed, x, NULL, NULL, NULL, &error))
                fail_msg("%s", error.text);
            assert_int_equal(ld_mstmm_loop_wrench(closed, x, 0, tau + 6, wrench, NULL), LD_OK);
            assert_int_equal(ld_mstmm_accelerations(closed, x, v, NULL, wrench, v_dot, NULL),
                             LD_OK);
            double size = 0, off = 0;
            for (int i = 0; i < 2; i++) {
                double at[3], a[2][3], alpha[2][3];
                tree_fill(at, 3, 1, &seed);
                ld_mstmm_point_acceleration(tree, q, u, u_dot, i, at, a[0], alpha[0]);
                ld_mstmm_point_acceleration(closed, x, v, v_dot, i, at, a[1], alpha[1]);
                for (int k = 0; k < 3; k++) {
                    size = fmax(size, fmax(fabs(a[0][k]), fabs(alpha[0][k])));
                    off = fmax(off, fmax(fabs(a[0][k] - a[1][k]), fabs(alpha[0][k] - alpha[1][k])));
                }
            }
            worst = fmax(worst, off / size);
            ld_mstmm_energies first = ld_mstmm_energy(tree, q, u);
            ld_mstmm_energies second = ld_mstmm_energy(closed, x, v);
            worst_energy = fmax(worst_energy, fabs(first.elastic - second.elastic));
            // the joint's own state is the hinge's
            double c[7] = {0}, c_dot[6] = {0}, sign = 1;
            ld_mstmm_loop_state(closed, x, v, 0, c, c_dot);
            if (kind == LD_HINGE_SPHERICAL) {
                double n = sqrt(q[7] * q[7] + q[8] * q[8] + q[9] * q[9] + q[10] * q[10]);
                for (int k = 7; k < 11; k++)
                    q[k] /= n;
                sign = c[0] * q[7] < 0 ? -1 : 1;
            }
            for (int k = 0; k < tree_coordinates[kind]; k++)
                worst_state = fmax(worst_state, fabs(sign * c[k] - q[7 + k]));
            for (int k = 0; k < tree_speeds[kind]; k++)
                worst_state = fmax(worst_state, fabs(c_dot[k] - u[6 + k]));
            ld_mstmm_free(tree);
            ld_mstmm_free(closed);
        }
    }
    CHECK_BELOW("a joint as a loop and as a hinge: accelerations, relative", worst, 1e-11);
    CHECK_BELOW("its springs' energy [J]", worst_energy, 1e-11);
    CHECK_BELOW("its coordinates and speeds", worst_state, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_accelerations_are_those_of_multipliers),
        cmocka_unit_test(test_closing),
        cmocka_unit_test(test_a_loop_is_a_hinge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
