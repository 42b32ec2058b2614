#include "math/matrices/exponential.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "math/lanes.h"

// Matrices lie in panels of 16 rows, each column by column; those of n rows are filled up to whole
// panels by zeros. Vectors hold the blocks one after the other, each filled up likewise, then the
// states that are in none.
enum { PANEL = 16 };

// Functions of a rung, phi_3 within what multiplies the last stage's slope: 4 phi_3 - phi_2.
typedef struct rung_functions {
    double *phi_1, *phi_2, *last;
} rung_functions;

typedef struct block {
    int n, rows, at; // states; filled up; where it begins in vectors
    double *L;       // [n][n] by columns
    double *panels;  // the same in panels
    double *scale;   // [n] powers of two that balance it
    rung_functions of_rung[EXPONENTIAL_MOST_RUNGS + 1];
} block;

enum { VECTORS = 10, MOST_PIECES = 1 << (EXPONENTIAL_MOST_RUNGS - 1) };

// Matrices in which the functions are found: of z, exp(z), phi_1, phi_2, phi_3, z^2, z^3, and one
// more.
enum { Z, E, PHI_1, PHI_2, PHI_3, SQUARE, CUBE, NEXT, MATRICES };

struct exponential {
    exponential_settings settings;
    bool wide_instructions; // AVX2 is there
    int block_count, size;  // blocks; length of a vector
    block *blocks;
    int quadratures; // where states begin in vectors that are in no block
    int *place;      // [n] of a state in a vector
    double *memory;
    double *vector[VECTORS];
    double *matrix[MATRICES]; // for the largest block
    double *y, *f;            // [n] of a stage
    double *middle;           // [n] slopes in the middle of the step
    exponential_course course;
    bool found; // its way in steps of the finest rung, each a vector, with the slopes
    double *way[MOST_PIECES + 1], *way_slope[MOST_PIECES + 1];
};

// ---- products

// y = A x; both filled up.
LD_ALWAYS_INLINE void multiply_any(int n, int rows, const double *A, const double *x, double *y)
{
    for (int at = 0; at < rows; at += PANEL, A += PANEL * n, y += PANEL) {
        v4d sum[4] = {v4d_all(0), v4d_all(0), v4d_all(0), v4d_all(0)};
        const v4d *a = v4d_lanes_of(A);
        for (int j = 0; j < n; j++, a += 4) {
            v4d factor = v4d_all(x[j]);
            for (int k = 0; k < 4; k++)
                sum[k] += a[k] * factor;
        }
        for (int k = 0; k < 4; k++)
            v4d_lanes(y)[k] = sum[k];
    }
}

// The same code with the processor's wider instructions: the same bits.
LANES_AVX2 static void multiply_wide(int n, int rows, const double *A, const double *x, double *y)
{
    multiply_any(n, rows, A, x, y);
}

static void multiply(const exponential *self, const block *of, const double *A, const double *x,
                     double *y)
{
    if (self->wide_instructions) {
        multiply_wide(of->n, of->rows, A, x, y);
        return;
    }
    multiply_any(of->n, of->rows, A, x, y);
}

static size_t place_in(const block *of, int i, int j)
{
    return (size_t)(i / PANEL) * PANEL * (size_t)of->n + (size_t)(j * PANEL + i % PANEL);
}

// C = A B, `column` two vectors.
static void multiply_matrices(const exponential *self, const block *of, const double *A,
                              const double *B, double *C)
{
    double *column = self->vector[0], *product = self->vector[1];
    for (int j = 0; j < of->n; j++) {
        for (int i = 0; i < of->n; i++)
            column[i] = B[place_in(of, i, j)];
        multiply(self, of, A, column, product);
        for (int i = 0; i < of->rows; i += PANEL)
            memcpy(C + place_in(of, i, j), product + i, PANEL * sizeof *C);
    }
}

// ---- life

static size_t matrix_size(const block *of)
{
    return (size_t)of->rows * (size_t)of->n;
}

static int filled_up(int n)
{
    return (n + PANEL - 1) / PANEL * PANEL;
}

// Where the states are, and how large all is.
static void lay_out(exponential *self)
{
    int at = 0;
    for (int b = 0; b < self->block_count; b++) {
        block *of = &self->blocks[b];
        of->at = at;
        for (int i = 0; i < self->settings.n; i++)
            if (self->settings.block[i] == b)
                self->place[i] = at + of->n++;
        of->rows = filled_up(of->n);
        at += of->rows;
    }
    self->quadratures = at;
    for (int i = 0; i < self->settings.n; i++)
        if (self->settings.block[i] == EXPONENTIAL_NO_BLOCK)
            self->place[i] = at++;
    self->size = filled_up(at);
}

// The next `count` of the memory, where there is any yet.
static double *take(double *memory, size_t *used, size_t count)
{
    size_t at = *used;
    *used += (count + 7) / 8 * 8;
    return memory ? memory + at : NULL;
}

// Gives every array its place in the memory; returns how much they want.
static size_t divide(exponential *self, double *memory)
{
    size_t n = (size_t)self->settings.n, used = 0;
    exponential_course *course = &self->course;
    double **own[] = {&self->y,       &self->f,       &self->middle,   &course->y,
                      &course->y_dot, &course->drift, &course->linear, &course->quadratic};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        *own[i] = take(memory, &used, n);
    for (int i = 0; i < VECTORS; i++)
        self->vector[i] = take(memory, &used, (size_t)self->size);
    for (int k = 0; k <= 1 << (self->settings.rungs - 1); k++) {
        self->way[k] = take(memory, &used, (size_t)self->size);
        self->way_slope[k] = take(memory, &used, (size_t)self->size);
    }
    size_t largest = 0;
    for (int b = 0; b < self->block_count; b++) {
        block *of = &self->blocks[b];
        size_t square = matrix_size(of);
        largest = square > largest ? square : largest;
        of->L = take(memory, &used, (size_t)of->n * (size_t)of->n);
        of->panels = take(memory, &used, square);
        of->scale = take(memory, &used, (size_t)of->n);
        for (int r = 0; r <= self->settings.rungs; r++) {
            rung_functions *functions = &of->of_rung[r];
            functions->phi_1 = take(memory, &used, square);
            functions->phi_2 = take(memory, &used, square);
            functions->last = take(memory, &used, square);
        }
    }
    for (int i = 0; i < MATRICES; i++)
        self->matrix[i] = take(memory, &used, largest);
    return used;
}

exponential *exponential_new(const exponential_settings *settings)
{
    exponential *self = calloc(1, sizeof *self);
    if (!self)
        return NULL;
    self->settings = *settings;
    self->block_count = settings->block_count;
    self->wide_instructions = lanes_have_avx2();
    self->blocks = calloc((size_t)self->block_count + 1, sizeof *self->blocks);
    self->place = calloc((size_t)settings->n + 1, sizeof *self->place);
    if (self->blocks && self->place) {
        lay_out(self);
        size_t count = divide(self, NULL);
        self->memory = aligned_alloc(64, count * sizeof(double));
        if (self->memory) {
            memset(self->memory, 0, count * sizeof(double));
            divide(self, self->memory);
        }
    }
    self->settings.block = NULL;
    if (self->memory)
        return self;
    exponential_free(self);
    return NULL;
}

void exponential_free(exponential *self)
{
    if (!self)
        return;
    free(self->memory);
    free(self->place);
    free(self->blocks);
    free(self);
}

double *exponential_block(exponential *self, int which, int *count)
{
    *count = self->blocks[which].n;
    return self->blocks[which].L;
}

double exponential_size(const exponential *self, int rung)
{
    return ldexp(self->settings.longest, -rung);
}

// ---- the functions phi

// Powers of two that make rows and columns alike large (Parlett and Reinsch, Numer. Math. 13,
// 1969).
static void balance(block *of)
{
    int n = of->n, sweeps = 0;
    bool changed = true;
    for (int i = 0; i < n; i++)
        of->scale[i] = 1;
    while (changed && sweeps++ < 100) {
        changed = false;
        for (int i = 0; i < n; i++) {
            double row = 0, column = 0, factor = 1;
            for (int j = 0; j < n; j++)
                if (j != i) {
                    row += fabs(of->L[i + n * j]) * of->scale[j] / of->scale[i];
                    column += fabs(of->L[j + n * i]) * of->scale[i] / of->scale[j];
                }
            if (!(row > 0) || !(column > 0) || !isfinite(row) || !isfinite(column))
                continue;
            double sum = row + column;
            for (; column * factor * factor < row / 2; factor *= 2)
                ;
            for (; column * factor * factor > row * 2; factor /= 2)
                ;
            if (column * factor + row / factor < 0.95 * sum) {
                of->scale[i] *= factor;
                changed = true;
            }
        }
    }
}

static double norm_of(const block *of)
{
    double most = 0;
    for (int j = 0; j < of->n; j++) {
        double sum = 0;
        for (int i = 0; i < of->n; i++)
            sum += fabs(of->L[i + of->n * j]) * of->scale[j] / of->scale[i];
        if (!isfinite(sum))
            return INFINITY;
        most = fmax(most, sum);
    }
    return most;
}

// Adds a times the unit matrix.
static void add_unit(const block *of, double a, double *A)
{
    for (int i = 0; i < of->n; i++)
        A[place_in(of, i, i)] += a;
}

static double one_over_factorial(int n)
{
    double product = 1;
    for (int i = 2; i <= n; i++)
        product *= i;
    return 1 / product;
}

// phi_3 = sum over k of z^k/(k + 3)!, twelve terms by threes; phi_(k - 1) = 1/(k - 1)! + z phi_k.
static void begin_functions(const exponential *self, const block *of, double *m[MATRICES])
{
    size_t size = matrix_size(of);
    multiply_matrices(self, of, m[Z], m[Z], m[SQUARE]);
    multiply_matrices(self, of, m[SQUARE], m[Z], m[CUBE]);
    memset(m[PHI_3], 0, size * sizeof(double));
    for (int k = 9; k >= 0; k -= 3) {
        if (k < 9)
            multiply_matrices(self, of, m[CUBE], m[PHI_3], m[NEXT]);
        else
            memset(m[NEXT], 0, size * sizeof(double));
        double a = one_over_factorial(k + 4), b = one_over_factorial(k + 5);
        for (size_t i = 0; i < size; i++)
            m[PHI_3][i] = m[NEXT][i] + a * m[Z][i] + b * m[SQUARE][i];
        add_unit(of, one_over_factorial(k + 3), m[PHI_3]);
    }
    multiply_matrices(self, of, m[Z], m[PHI_3], m[PHI_2]);
    add_unit(of, 0.5, m[PHI_2]);
    multiply_matrices(self, of, m[Z], m[PHI_2], m[PHI_1]);
    add_unit(of, 1, m[PHI_1]);
    multiply_matrices(self, of, m[Z], m[PHI_1], m[E]);
    add_unit(of, 1, m[E]);
}

// From z to 2 z: 2^k phi_k(2 z) = exp(z) phi_k(z) + sum over j to k of phi_j(z)/(k - j)!.
static void double_functions(const exponential *self, const block *of, double *m[MATRICES])
{
    size_t size = matrix_size(of);
    multiply_matrices(self, of, m[E], m[PHI_3], m[NEXT]);
    for (size_t i = 0; i < size; i++)
        m[PHI_3][i] = (m[NEXT][i] + 0.5 * m[PHI_1][i] + m[PHI_2][i] + m[PHI_3][i]) / 8;
    multiply_matrices(self, of, m[E], m[PHI_2], m[NEXT]);
    for (size_t i = 0; i < size; i++)
        m[PHI_2][i] = (m[NEXT][i] + m[PHI_1][i] + m[PHI_2][i]) / 4;
    multiply_matrices(self, of, m[E], m[PHI_1], m[NEXT]);
    for (size_t i = 0; i < size; i++)
        m[PHI_1][i] = (m[NEXT][i] + m[PHI_1][i]) / 2;
    multiply_matrices(self, of, m[E], m[E], m[NEXT]);
    memcpy(m[E], m[NEXT], size * sizeof(double));
}

// Keeps those of a rung, no longer balanced.
static void keep_functions(block *of, double *const m[MATRICES], int rung)
{
    rung_functions *to = &of->of_rung[rung];
    for (int j = 0; j < of->n; j++)
        for (int i = 0; i < of->n; i++) {
            size_t at = place_in(of, i, j);
            double back = of->scale[i] / of->scale[j];
            to->phi_1[at] = m[PHI_1][at] * back;
            to->phi_2[at] = m[PHI_2][at] * back;
            to->last[at] = (4 * m[PHI_3][at] - m[PHI_2][at]) * back;
        }
}

// Other than 0: L is not finite, or too large.
static int prepare_block(exponential *self, block *of)
{
    int rungs = self->settings.rungs, doublings = 0;
    double h = exponential_size(self, rungs), **m = self->matrix;
    balance(of);
    double norm = norm_of(of) * h;
    while (doublings < 60 && !(ldexp(norm, -doublings) <= 0.5))
        doublings++;
    if (doublings == 60)
        return -1;
    for (int i = 0; i < MATRICES; i++)
        memset(m[i], 0, matrix_size(of) * sizeof(double));
    for (int j = 0; j < of->n; j++)
        for (int i = 0; i < of->n; i++) {
            double L = of->L[i + of->n * j];
            of->panels[place_in(of, i, j)] = L;
            m[Z][place_in(of, i, j)] = ldexp(L * h, -doublings) * of->scale[j] / of->scale[i];
        }
    begin_functions(self, of, m);
    for (int k = 0; k < doublings; k++)
        double_functions(self, of, m);
    for (int rung = rungs; rung >= 0; rung--) {
        keep_functions(of, m, rung);
        if (rung > 0)
            double_functions(self, of, m);
    }
    return 0;
}

int exponential_prepare(exponential *self)
{
    for (int b = 0; b < self->block_count; b++)
        if (prepare_block(self, &self->blocks[b]))
            return -1;
    return 0;
}

// ---- steps

typedef enum function { PHI_ONE, PHI_TWO, LAST } function;
static const double without_block[] = {1, 0.5, 1.0 / 6}; // 4/6 - 1/2

// y = phi x at a rung.
static void apply(const exponential *self, int rung, function which, const double *x, double *y)
{
    int at = 0;
    for (int b = 0; b < self->block_count; b++) {
        const block *of = &self->blocks[b];
        const rung_functions *f = &of->of_rung[rung];
        const double *A = which == PHI_ONE ? f->phi_1 : which == PHI_TWO ? f->phi_2 : f->last;
        multiply(self, of, A, x + of->at, y + of->at);
        at = of->at + of->rows;
    }
    for (; at < self->size; at++)
        y[at] = without_block[which] * x[at];
}

// y = L x
static void apply_matrix(const exponential *self, const double *x, double *y)
{
    int at = 0;
    for (int b = 0; b < self->block_count; b++) {
        const block *of = &self->blocks[b];
        multiply(self, of, of->panels, x + of->at, y + of->at);
        at = of->at + of->rows;
    }
    for (; at < self->size; at++)
        y[at] = 0;
}

// Where the step has begun, and what its stages have in common.
typedef struct begin {
    exponential_start at;
    double h;
    double *g; // y_dot - drift, as a vector
} begin;

// What they yield: the sum of the remainders in the middle, and that of the last stage less that
// sum; phi_1 g over half the step and over all of it.
typedef struct stages {
    double *sum, *last, *half, *whole;
} stages;

// The state that is `w` away from y and the drift since t, and its slope.
static int evaluate(exponential *self, const begin *from, double since, const double *w, double *y,
                    double *y_dot)
{
    for (int i = 0; i < self->settings.n; i++)
        y[i] = from->at.y[i] + (since * from->at.drift[i] + w[self->place[i]]);
    return self->settings.f(from->at.t + since, y, y_dot, self->settings.self);
}

// The remainder f(y + drift + w) - f(y) - L w from the slope found there.
static void find_remainder(const exponential *self, const begin *from, const double *w,
                           const double *slope, double *remainder)
{
    apply_matrix(self, w, remainder);
    for (int i = 0; i < self->settings.n; i++) {
        int at = self->place[i];
        remainder[at] = (slope[i] - from->at.y_dot[i]) - remainder[at];
    }
}

static int find_stage(exponential *self, const begin *from, double since, const double *w,
                      double *remainder)
{
    if (evaluate(self, from, since, w, self->y, self->f))
        return -1;
    find_remainder(self, from, w, self->f, remainder);
    return 0;
}

static int find_stages(exponential *self, int rung, const begin *from, const stages *to)
{
    double *sum = to->sum, *last = to->last, *half = to->half, *whole = to->whole;
    double *w = self->vector[0], *a = self->vector[1], h = from->h;
    apply(self, rung + 1, PHI_ONE, from->g, half);
    for (int i = 0; i < self->size; i++)
        w[i] = h / 2 * half[i];
    if (find_stage(self, from, h / 2, w, sum))
        return -1;
    apply(self, rung + 1, PHI_TWO, sum, a);
    for (int i = 0; i < self->size; i++)
        w[i] += h * a[i];
    if (find_stage(self, from, h / 2, w, last))
        return -1;
    apply(self, rung, PHI_ONE, from->g, whole);
    apply(self, rung, PHI_TWO, last, a);
    for (int i = 0; i < self->size; i++) {
        sum[i] += last[i];
        w[i] = h * (whole[i] + 2 * a[i]);
    }
    if (find_stage(self, from, h, w, last))
        return -1;
    for (int i = 0; i < self->size; i++)
        last[i] -= sum[i];
    return 0;
}

// w after a step of a rung, in which the remainder is phi_2 and `last` of these; phi_1 g is known.
static void find_end(const exponential *self, int rung, const double *first, const double *second,
                     const double *third, double *w)
{
    double *a = self->vector[1], *b = self->vector[2], h = exponential_size(self, rung);
    apply(self, rung, PHI_TWO, second, a);
    apply(self, rung, LAST, third, b);
    for (int i = 0; i < self->size; i++)
        w[i] = h * (first[i] + (a[i] + b[i]));
}

// The slopes in the middle of the step, for what is in no block.
static int find_middle(exponential *self, int rung, const begin *from, const stages *of)
{
    const double *sum = of->sum, *last = of->last;
    double *w = self->vector[0], *second = self->vector[3], *third = self->vector[4];
    for (int i = 0; i < self->size; i++) {
        third[i] = last[i] / 4;
        second[i] = (sum[i] - last[i]) / 2 + third[i];
    }
    find_end(self, rung + 1, of->half, second, third, w);
    return evaluate(self, from, from->h / 2, w, self->y, self->middle);
}

static void keep_course(exponential *self, int rung, const exponential_start *start,
                        const stages *of)
{
    const double *sum = of->sum, *last = of->last;
    exponential_course *course = &self->course;
    self->found = false;
    course->rung = rung;
    for (int i = 0; i < self->settings.n; i++) {
        int at = self->place[i];
        course->y[i] = start->y[i];
        course->y_dot[i] = start->y_dot[i];
        course->drift[i] = start->drift[i];
        course->linear[i] = sum[at] - last[at];
        course->quadratic[i] = 2 * last[at];
    }
}

int exponential_step(exponential *self, int rung, const exponential_start *start,
                     const exponential_end *end)
{
    double *w = self->vector[0], *remainder = self->vector[1], h = exponential_size(self, rung);
    const stages of = {.sum = self->vector[7],
                       .last = self->vector[8],
                       .half = self->vector[5],
                       .whole = self->vector[6]};
    const begin from = {*start, h, self->vector[9]};
    const double *y = start->y, *y_dot = start->y_dot;
    for (int i = 0; i < self->settings.n; i++)
        from.g[self->place[i]] = y_dot[i] - start->drift[i];
    if (find_stages(self, rung, &from, &of) || find_middle(self, rung, &from, &of))
        return -1;
    find_end(self, rung, of.whole, of.sum, of.last, w);
    if (evaluate(self, &from, h, w, end->y, end->y_dot))
        return -1;

    // the slope at the end in place of that of the last stage gives a solution of order 3
    find_remainder(self, &from, w, end->y_dot, remainder);
    for (int i = 0; i < self->settings.n; i++) {
        int at = self->place[i];
        end->error[i] = h / 6 * (of.sum[at] + of.last[at] - remainder[at]);
        if (at >= self->quadratures)
            end->y[i] = y[i] + h / 6 * (y_dot[i] + 4 * self->middle[i] + end->y_dot[i]);
    }
    keep_course(self, rung, start, &of);
    return 0;
}

// ---- between a step's ends

exponential_course *exponential_last(exponential *self)
{
    return &self->course;
}

// The slope less the drift, at x of the step, which is `w` away.
static void slope_within(exponential *self, double x, const double *w, double *g)
{
    const exponential_course *course = &self->course;
    apply_matrix(self, w, g);
    for (int i = 0; i < self->settings.n; i++)
        g[self->place[i]] += course->y_dot[i] - course->drift[i] +
                             x * (course->linear[i] + x * course->quadratic[i]);
}

static int pieces_of(const exponential *self)
{
    return 1 << (self->settings.rungs - 1 - self->course.rung);
}

// w, of slope g, from x of the step on over a piece of it, `s`; the remainder is a polynomial.
static void advance_krylov(exponential *self, double x, double s, const double *g, double *w)
{
    const exponential_course *course = &self->course;
    double *d = self->vector[2], *bend = self->vector[3];
    double *a = self->vector[4], *b = self->vector[5], *c = self->vector[6];
    int rung = self->settings.rungs - 1;
    double size = exponential_size(self, rung);
    for (int i = 0; i < self->settings.n; i++) {
        int k = self->place[i];
        bend[k] = s * s * course->quadratic[i] / 2;
        d[k] = s * (course->linear[i] + 2 * x * course->quadratic[i]) + bend[k];
    }
    apply(self, rung, PHI_ONE, g, a);
    apply(self, rung, PHI_TWO, d, b);
    apply(self, rung, LAST, bend, c);
    for (int i = 0; i < self->size; i++)
        w[i] += size * (a[i] + (b[i] + c[i]));
}

// The whole step in steps of the finest rung: where it goes and its slopes.
static void find_course(exponential *self)
{
    int count = pieces_of(self);
    size_t size = (size_t)self->size * sizeof(double);
    memset(self->way[0], 0, size);
    for (int k = 0; k <= count; k++) {
        double x = (double)k / count;
        slope_within(self, x, self->way[k], self->way_slope[k]);
        if (k == count)
            break;
        memcpy(self->way[k + 1], self->way[k], size);
        advance_krylov(self, x, 1.0 / count, self->way_slope[k], self->way[k + 1]);
    }
    self->found = true;
}

void exponential_forget(exponential *self)
{
    self->found = false;
}

void exponential_between(exponential *self, double since, double *y)
{
    const exponential_course *course = &self->course;
    double finest = exponential_size(self, self->settings.rungs - 1), part = since / finest;
    if (!self->found)
        find_course(self);
    int k = (int)fmax(0, fmin(floor(part), pieces_of(self) - 1));
    const double *w = self->way[k], *next = self->way[k + 1];
    const double *slope = self->way_slope[k], *slope_next = self->way_slope[k + 1];
    double x = part - k, to = x * x * (3 - 2 * x);
    double first = finest * x * (1 - x) * (1 - x), last = finest * x * x * (x - 1);
    for (int i = 0; i < self->settings.n; i++) {
        int at = self->place[i];
        double away = w[at] + to * (next[at] - w[at]) + (first * slope[at] + last * slope_next[at]);
        y[i] = course->y[i] + (since * course->drift[i] + away);
    }
}
