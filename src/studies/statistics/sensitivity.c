#include "studies/statistics/sensitivity.h"

#include <string.h>

#include "math/curves/distributions.h"
#include "math/functions.h"

// Degree of the polynomials; draws for each degree; blocks of groups for the jackknife.
enum { DEGREE = 6, DRAWS = 20, BLOCKS = 100 };
// A row of the regression: 1, the polynomials, y.
enum { ROW = DEGREE + 2, RESULT = DEGREE + 1 };

// Polynomials that are orthogonal over the values of x, by their recurrence
// p_{k+1} = (z - a_k) p_k - b_k p_{k-1}, z = (x - centre)/scale (Stieltjes).
typedef struct polynomials {
    double centre, scale;
    int degree;
    double a[DEGREE], b[DEGREE], norm[DEGREE + 1]; // root of the mean square
} polynomials;

// Sums of products of rows.
typedef struct moments {
    double of[ROW][ROW];
} moments;

// p_0 ... p_degree at x, not yet over their norms.
static void evaluate(const polynomials *self, double x, double p[DEGREE + 1])
{
    double z = (x - self->centre) / self->scale;
    p[0] = 1;
    for (int k = 0; k < self->degree; k++)
        p[k + 1] = (z - self->a[k]) * p[k] - (k ? self->b[k] * p[k - 1] : 0);
}

// By differences from the first: the mean of equal values is that value.
static double mean_of(const double *value, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += value[i] - value[0];
    return value[0] + sum / (double)count;
}

// Raises the degree as far as the values of x differ.
static polynomials make_polynomials(const double *x, size_t count, int degree)
{
    polynomials self = {.centre = mean_of(x, count), .norm = {1}};
    double n = (double)count, p[DEGREE + 1], squares = 0;
    for (size_t i = 0; i < count; i++)
        squares += (x[i] - self.centre) * (x[i] - self.centre) / n;
    self.scale = squares > 0 ? sqrt(squares) : 1;
    for (int k = 0; k < degree && squares > 0; k++) {
        double first = 0, next = 0;
        for (size_t i = 0; i < count; i++) {
            evaluate(&self, x[i], p);
            first += (x[i] - self.centre) / self.scale * p[k] * p[k] / n;
        }
        self.a[k] = first / (self.norm[k] * self.norm[k]);
        self.b[k] = k ? pow(self.norm[k] / self.norm[k - 1], 2) : 0;
        self.degree = k + 1;
        for (size_t i = 0; i < count; i++) {
            evaluate(&self, x[i], p);
            next += p[k + 1] * p[k + 1] / n;
        }
        self.norm[k + 1] = sqrt(next);
        if (!(self.norm[k + 1] > 1e-6 * self.norm[k])) {
            self.degree = k; // there are but k + 1 different values
            break;
        }
    }
    return self;
}

static void add_moments(moments *sum, const moments *more, double factor)
{
    for (int i = 0; i < ROW; i++)
        for (int j = 0; j < ROW; j++)
            sum->of[i][j] += factor * more->of[i][j];
}

// Cholesky factor L of the upper left part of `a` [n][n], in place; false: not positive definite.
static bool factorise(double a[ROW][ROW], int n)
{
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < j; k++)
            for (int i = j; i < n; i++)
                a[i][j] -= a[i][k] * a[j][k];
        if (!(a[j][j] > 0))
            return false;
        double root = sqrt(a[j][j]);
        for (int i = j; i < n; i++)
            a[i][j] /= root;
    }
    return true;
}

static void solve_lower(double a[ROW][ROW], int n, double *b)
{
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++)
            b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
}

static void solve_upper(double a[ROW][ROW], int n, double *b)
{
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            b[i] -= a[k][i] * b[k];
        b[i] /= a[i][i];
    }
}

typedef struct regression {
    int degree;
    int blocks, without; // block left out, -1: none
    const moments *block, *all;
    double draws;
} regression;

// The estimate of S, NaN where there is none. Of the explained sum of squares is taken away what it
// is expected to be without any influence: the scatter of the coefficients from block to block.
static double adjusted(const regression *self)
{
    moments sum = *self->all, root;
    double beta[ROW] = {0}, expected = 0, blocks = 0;
    int terms = self->degree + 1;
    if (self->without >= 0)
        add_moments(&sum, &self->block[self->without], -1);
    root = sum;
    if (!factorise(root.of, terms))
        return NAN;
    for (int i = 0; i < terms; i++)
        beta[i] = sum.of[i][RESULT];
    solve_lower(root.of, terms, beta);
    double explained = 0, n = sum.of[0][0];
    double total = sum.of[RESULT][RESULT] - sum.of[0][RESULT] * sum.of[0][RESULT] / n;
    for (int i = 1; i < terms; i++)
        explained += beta[i] * beta[i];
    solve_upper(root.of, terms, beta);
    for (int b = 0; b < self->blocks; b++) {
        double score[ROW];
        if (b == self->without)
            continue;
        for (int i = 0; i < terms; i++) {
            score[i] = self->block[b].of[i][RESULT];
            for (int j = 0; j < terms; j++)
                score[i] -= self->block[b].of[i][j] * beta[j];
        }
        solve_lower(root.of, terms, score);
        for (int i = 1; i < terms; i++)
            expected += score[i] * score[i];
        blocks++;
    }
    double draws = self->draws * n / self->all->of[0][0];
    expected *= blocks / (blocks - 1) * (draws - 1) / (draws - terms);
    return (explained - expected) / total;
}

// Pairs of values in the order of their groups.
typedef struct grouped_pairs {
    const double *x, *y;  // [count]
    const int64_t *group; // [count]
    size_t count, groups;
} grouped_pairs;

// Sums the rows of each block; returns how many blocks there are.
static int sum_blocks(const polynomials *p, const grouped_pairs *of, moments block[BLOCKS])
{
    double mean = mean_of(of->y, of->count);
    size_t blocks = of->groups < BLOCKS ? of->groups : BLOCKS;
    memset(block, 0, blocks * sizeof *block);
    for (size_t i = 0, g = 0; i < of->count; i++) {
        double row[ROW] = {0};
        g += i > 0 && of->group[i] != of->group[i - 1];
        evaluate(p, of->x[i], row);
        for (int k = 1; k <= p->degree; k++)
            row[k] /= p->norm[k];
        row[RESULT] = of->y[i] - mean;
        moments *sum = &block[g * blocks / of->groups];
        for (int j = 0; j < ROW; j++)
            for (int k = 0; k < ROW; k++)
                sum->of[j][k] += row[j] * row[k];
    }
    return (int)blocks;
}

static estimate with_interval(regression *self)
{
    estimate result = {adjusted(self), NAN, NAN};
    double n = self->blocks, sum = 0, squares = 0, all = log1p(-result.value);
    for (self->without = 0; self->without < self->blocks; self->without++) {
        double d = log1p(-adjusted(self)) - all;
        sum += d;
        squares += d * d;
    }
    double half = student_quantile(0.975, n - 1) * sqrt((n - 1) / n * (squares - sum * sum / n));
    if (isfinite(half)) {
        result.low = -expm1(all + half);
        result.high = -expm1(all - half);
    }
    return result;
}

static size_t differing(const int64_t *number, size_t count)
{
    size_t result = 0;
    for (size_t i = 0; i < count; i++)
        result += i == 0 || number[i] != number[i - 1];
    return result;
}

estimate sensitivity_of(const double *x, const double *y, const int64_t *sample,
                        const int64_t *group, size_t count, bool per_rocket)
{
    moments block[BLOCKS], all = {0};
    size_t draws = per_rocket ? count : differing(sample, count), groups = differing(group, count);
    int degree = draws / DRAWS < DEGREE ? (int)(draws / DRAWS) : DEGREE;
    if (draws < 5 || groups < 3)
        return (estimate){NAN, NAN, NAN};
    polynomials p = make_polynomials(x, count, degree > 1 ? degree : 1);
    int blocks = sum_blocks(&p, &(grouped_pairs){x, y, group, count, groups}, block);
    for (int b = 0; b < blocks; b++)
        add_moments(&all, &block[b], 1);
    regression all_of_it = {p.degree, blocks, -1, block, &all, (double)draws};
    if (!(all.of[RESULT][RESULT] > 0))
        return (estimate){NAN, NAN, NAN};
    return with_interval(&all_of_it);
}
