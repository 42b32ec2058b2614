#include "support/fine_tube.h"

#include "model/model.h"
#include "support/check.h"

// Node at station x, which must be one.
static int node_at(double x, double h)
{
    int node = (int)lround(x / h);
    assert_true(fabs(node * h - x) < 1e-9);
    return node;
}

// ---- bending ----

// Adds to the freedoms i and j, i >= j.
static void add(fine_matrix to, int i, int j, double value)
{
    to[i][i - j] += value;
}

static void add_element(fine_bending *self, int plane, int node, const ld_section *section)
{
    const double h = self->h, m = section->mass_per_length * h;
    const double EI = section->form != LD_SECTION_PLANES ? section->bending_stiffness
                      : plane                            ? section->bending_stiffness_y
                                                         : section->bending_stiffness_z;
    const double K[4][4] = {
        {12}, {6 * h, 4 * h * h}, {-12, -6 * h, 12}, {6 * h, 2 * h * h, -6 * h, 4 * h * h}};
    const double M[4][4] = {
        {156}, {22 * h, 4 * h * h}, {54, 13 * h, 156}, {-13 * h, -3 * h * h, -22 * h, 4 * h * h}};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j <= i; j++) {
            add(self->K[plane], 2 * node + i, 2 * node + j, EI / (h * h * h) * K[i][j]);
            add(self->M[plane], 2 * node + i, 2 * node + j, m / 420 * M[i][j]);
        }
}

// A force and a moment at station x, on the nodes of its element.
static void add_load(const fine_bending *self, double x, double force, double moment,
                     fine_vector to)
{
    int node = (int)fmin(x / self->h, self->nodes - 2);
    double h = self->h, s = x / h - node, r = 1 - s;
    const double N[4] = {r * r * (1 + 2 * s), h * s * r * r, s * s * (3 - 2 * s), -h * s * s * r};
    const double N1[4] = {-6 * s * r / h, r * (1 - 3 * s), 6 * s * r / h, s * (3 * s - 2)};
    for (int i = 0; i < 4; i++)
        to[2 * node + i] += N[i] * force + N1[i] * moment;
}

// M times the acceleration of gravity, by plane.
static void weigh(fine_bending *self, const ld_model *model)
{
    const double g = -model->gravity * cos(model->base.elevation);
    const ld_section *section = &model->tubes.section[0];
    const ld_tail *tail = &model->tubes.tail;
    for (int i = 0; i + 1 < self->nodes; i++)
        for (int k = 0; k < 2; k++) {
            self->weight[0][2 * (i + k)] += g * section->mass_per_length * self->h / 2;
            self->weight[0][2 * (i + k) + 1] +=
                (k ? -1 : 1) * g * section->mass_per_length * self->h * self->h / 12;
        }
    self->weight[0][0] += g * tail->mass;
    self->weight[0][1] += g * tail->mass * tail->center;
}

// L D L^T in place.
static void decompose(fine_matrix A, int n)
{
    for (int i = 0; i < n; i++)
        for (int j = i < FINE_BAND ? 0 : i - FINE_BAND + 1; j <= i; j++) {
            double sum = A[i][i - j];
            for (int k = i < FINE_BAND ? 0 : i - FINE_BAND + 1; k < j; k++)
                sum -= A[i][i - k] * A[j][j - k] * A[k][0];
            A[i][i - j] = i == j ? sum : sum / A[j][0];
        }
}

static void solve(fine_matrix A, int n, double *x)
{
    for (int i = 0; i < n; i++)
        for (int k = 1; k < FINE_BAND && k <= i; k++)
            x[i] -= A[i][k] * x[i - k];
    for (int i = 0; i < n; i++)
        x[i] /= A[i][0];
    for (int i = n - 1; i >= 0; i--)
        for (int k = 1; k < FINE_BAND && k <= i; k++)
            x[i - k] -= A[i][k] * x[i];
}

// y -= A x.
static void subtract_product(fine_matrix A, int n, const double *x, double *y)
{
    for (int i = 0; i < n; i++) {
        y[i] -= A[i][0] * x[i];
        for (int k = 1; k < FINE_BAND && k <= i; k++) {
            y[i] -= A[i][k] * x[i - k];
            y[i - k] -= A[i][k] * x[i];
        }
    }
}

// A plane with tail and supports: of y their springs along y and about z.
static void create_plane(fine_bending *self, int plane, const ld_tubes *tubes)
{
    for (int i = 0; i + 1 < self->nodes; i++)
        add_element(self, plane, i, &tubes->section[0]);
    fine_matrix *K = &self->K[plane], *C = &self->C[plane], *M = &self->M[plane];
    const ld_tail *tail = &tubes->tail;
    double m = tail->mass, c = tail->center;
    add(*M, 0, 0, m);
    add(*M, 1, 0, m * c);
    add(*M, 1, 1, tail->inertia[2 - plane] + m * c * c);
    for (int i = 0; i < tubes->support_count; i++) {
        const ld_support *support = &tubes->support[i];
        int w = 2 * node_at(support->at, self->h);
        add(*K, w, w, support->stiffness[1 + plane]);
        add(*C, w, w, support->damping[1 + plane]);
        add(*K, w + 1, w + 1, support->rotational_stiffness[2 - plane]);
        add(*C, w + 1, w + 1, support->rotational_damping[2 - plane]);
    }
    for (int i = 0; i < 2 * self->nodes; i++)
        for (int k = 0; k < FINE_BAND; k++)
            self->factor[plane][i][k] =
                (*M)[i][k] + self->step / 2 * (*C)[i][k] + self->step * self->step / 4 * (*K)[i][k];
    decompose(self->factor[plane], 2 * self->nodes);
}

void fine_bending_create(fine_bending *self, const ld_model *model, double h, double step)
{
    const ld_tubes *tubes = &model->tubes;
    memset(self, 0, sizeof *self);
    self->h = h;
    self->step = step;
    self->nodes = node_at(tubes->length, h) + 1;
    assert_true(self->nodes <= FINE_MOST_NODES && tubes->section_count == 1);
    weigh(self, model);
    create_plane(self, 0, tubes);
    create_plane(self, 1, tubes);
}

static void gather(fine_bending *self, const fine_loads *loads, int plane, fine_vector f)
{
    memcpy(f, self->weight[plane], sizeof(fine_vector));
    for (int i = 0; i < loads->count; i++) {
        const fine_load *load = &loads->load[i];
        if (load->x < self->h * (self->nodes - 1))
            add_load(self, load->x, load->force[plane], load->moment[plane], f);
    }
}

void fine_bending_rest(fine_bending *self, const fine_loads *loads)
{
    static fine_matrix K;
    for (int plane = 0; plane < 2; plane++) {
        memcpy(K, self->K[plane], sizeof K);
        decompose(K, 2 * self->nodes);
        gather(self, loads, plane, self->u[plane]);
        solve(K, 2 * self->nodes, self->u[plane]);
        memset(self->u_dot[plane], 0, sizeof self->u_dot[plane]);
        memset(self->a[plane], 0, sizeof self->a[plane]);
    }
}

void fine_bending_step(fine_bending *self, const fine_loads *loads)
{
    const int n = 2 * self->nodes;
    const double h = self->step;
    static fine_vector f;
    for (int plane = 0; plane < 2; plane++) {
        double *u = self->u[plane], *v = self->u_dot[plane], *a = self->a[plane];
        for (int i = 0; i < n; i++) { // where it comes without the new acceleration
            u[i] += h * v[i] + h * h / 4 * a[i];
            v[i] += h / 2 * a[i];
        }
        gather(self, loads, plane, f);
        subtract_product(self->C[plane], n, v, f);
        subtract_product(self->K[plane], n, u, f);
        solve(self->factor[plane], n, f);
        for (int i = 0; i < n; i++) {
            a[i] = f[i];
            u[i] += h * h / 4 * a[i];
            v[i] += h / 2 * a[i];
        }
    }
}

fine_tip fine_bending_tip(const fine_bending *self, int plane)
{
    int w = 2 * (self->nodes - 1);
    return (fine_tip){self->u[plane][w], self->u[plane][w + 1], self->u_dot[plane][w],
                      self->u_dot[plane][w + 1]};
}

// ---- twist ----

void fine_twist_create(fine_twist *self, const ld_model *model, double h)
{
    const ld_tubes *tubes = &model->tubes;
    const ld_section *section = &tubes->section[0];
    memset(self, 0, sizeof *self);
    self->h = h;
    self->stiffness = section->torsion_stiffness;
    self->c = sqrt(section->torsion_stiffness / section->polar_inertia);
    self->step = h / self->c;
    self->nodes = node_at(tubes->length, h) + 1;
    assert_true(self->nodes <= FINE_MOST_NODES && tubes->section_count == 1);
    self->tail = tubes->tail.inertia[0];
    self->support_count = tubes->support_count;
    for (int i = 0; i < tubes->support_count; i++) {
        self->support[i] = node_at(tubes->support[i].at, h);
        self->spring[i] = tubes->support[i].rotational_stiffness[0];
        self->damper[i] = tubes->support[i].rotational_damping[0];
    }
}

// A load between node and node + 1 throughout, or that passes one of them, meets one wave each way:
// the jump of rate -+ c twist' across it, [twist'] = -torque/(GJ (1 - v^2/c^2)), [rate] = -v
// [twist'].
static void add_waves(fine_twist *self, const fine_load *load)
{
    const double v = load->x_dot, travel = v * self->step / 2;
    const double unit = load->torque * self->c / self->stiffness;
    int near = (int)(load->x / self->h);
    for (int i = near > 0 ? near - 1 : 0; i <= near + 1 && i + 1 < self->nodes; i++) {
        double x0 = i * self->h, x1 = x0 + self->h;
        if (load->x - travel >= x0 && load->x + travel < x1)
            self->right[i + 1] += unit / (1 - v / self->c);
        if (load->x - travel < x1 && load->x + travel >= x0)
            self->left[i] += unit / (1 + v / self->c);
    }
}

// A spring and damper turn the waves that arrive from both sides into those that leave.
static void meet_support(fine_twist *self, int i)
{
    int node = self->support[i];
    double wave = self->stiffness / self->c, h = self->step;
    double right = self->right[node], left = self->left[node];
    double angle = self->angle[i] + h / 2 * self->speed[i];
    double rate = (wave * (right + left) - self->spring[i] * angle) /
                  (2 * wave + self->damper[i] + self->spring[i] * h / 2);
    self->angle[i] = angle + h / 2 * rate;
    self->speed[i] = self->rate[node] = rate;
    self->right[node] = 2 * rate - left;
    self->left[node] = 2 * rate - right;
}

// So does the tail's inertia the wave that arrives, `before` at the step's begin.
static void meet_tail(fine_twist *self, double before, double rate_before)
{
    double share = self->stiffness * self->step / (2 * self->c * self->tail), after = self->left[0];
    self->rate[0] = (rate_before * (1 - share) + share * (before + after)) / (1 + share);
    self->right[0] = 2 * self->rate[0] - after;
}

void fine_twist_step(fine_twist *self, const fine_loads *loads)
{
    const int last = self->nodes - 1;
    double before = self->left[0], rate_before = self->rate[0];
    // what left a node arrives at the next
    memmove(self->right + 1, self->right, (size_t)last * sizeof *self->right);
    memmove(self->left, self->left + 1, (size_t)last * sizeof *self->left);
    for (int i = 0; i < loads->count; i++)
        add_waves(self, &loads->load[i]);
    self->left[last] = self->right[last]; // free end
    for (int i = 1; i <= last; i++)
        self->rate[i] = (self->right[i] + self->left[i]) / 2;
    meet_tail(self, before, rate_before);
    for (int i = 0; i < self->support_count; i++)
        meet_support(self, i);
}

double fine_twist_rate(const fine_twist *self, double x)
{
    int i = (int)fmin(x / self->h, self->nodes - 2);
    return (self->rate[i] + self->rate[i + 1]) / 2;
}
