#include "integration/serial_vector.h"

#include <assert.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <stdlib.h>

#include "math/lanes.h"

static double *data(N_Vector v)
{
    return NV_DATA_S(v);
}

#define FOR_EACH(i, v) for (sunindextype i = 0, end_##i = NV_LENGTH_S(v); i < end_##i; i++)

static void vector_linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z)
{
    const double *px = data(x), *py = data(y);
    double *pz = data(z);
    FOR_EACH(i, z)
    pz[i] = a * px[i] + b * py[i];
}

static void vector_const(double c, N_Vector z)
{
    double *pz = data(z);
    FOR_EACH(i, z)
    pz[i] = c;
}

static void vector_prod(N_Vector x, N_Vector y, N_Vector z)
{
    const double *px = data(x), *py = data(y);
    double *pz = data(z);
    FOR_EACH(i, z)
    pz[i] = px[i] * py[i];
}

static void vector_div(N_Vector x, N_Vector y, N_Vector z)
{
    const double *px = data(x), *py = data(y);
    double *pz = data(z);
    FOR_EACH(i, z)
    pz[i] = px[i] / py[i];
}

static void vector_scale(double c, N_Vector x, N_Vector z)
{
    const double *px = data(x);
    double *pz = data(z);
    FOR_EACH(i, z)
    pz[i] = c * px[i];
}

static void vector_abs(N_Vector x, N_Vector z)
{
    const double *px = data(x);
    double *pz = data(z);
    FOR_EACH(i, z)
    pz[i] = fabs(px[i]);
}

static void vector_inv(N_Vector x, N_Vector z)
{
    const double *px = data(x);
    double *pz = data(z);
    FOR_EACH(i, z)
    pz[i] = 1.0 / px[i];
}

static void vector_add_const(N_Vector x, double b, N_Vector z)
{
    const double *px = data(x);
    double *pz = data(z);
    FOR_EACH(i, z)
    pz[i] = px[i] + b;
}

static double vector_min(N_Vector x)
{
    const double *px = data(x);
    double m = px[0];
    FOR_EACH(i, x)
    m = px[i] < m ? px[i] : m;
    return m;
}

static double vector_max_norm(N_Vector x)
{
    const double *px = data(x);
    double m = 0;
    FOR_EACH(i, x)
    m = fabs(px[i]) > m ? fabs(px[i]) : m;
    return m;
}

// The mean is over what steers the step: quadratures have weight 0.
static double vector_wrms_norm(N_Vector x, N_Vector w)
{
    const double *px = data(x), *pw = data(w);
    double sum = 0;
    sunindextype count = 0;
    FOR_EACH(i, x)
    {
        sum += (px[i] * pw[i]) * (px[i] * pw[i]);
        count += pw[i] > 0;
    }
    return sqrt(sum / (double)count);
}

enum { MOST_VECTORS = 16 };

// Four elements wherever they lie.
typedef double four __attribute__((vector_size(32), aligned(8), may_alias));

// pz may be px[0] (the library's contract), so the sum of an element is complete before it is
// stored.
LD_INLINE void combine(const int count, const double *weight, N_Vector *x, size_t n, double *pz)
{
    const double *px[MOST_VECTORS];
    double c[MOST_VECTORS];
    for (int k = 0; k < count; k++) {
        px[k] = data(x[k]);
        c[k] = weight[k];
    }
    size_t i = 0;
    for (; i + 4 <= n; i += 4) {
        four sum = c[0] * *(const four *)(px[0] + i);
        for (int k = 1; k < count; k++)
            sum += c[k] * *(const four *)(px[k] + i);
        *(four *)(pz + i) = sum;
    }
    for (; i < n; i++) {
        double sum = c[0] * px[0][i];
        for (int k = 1; k < count; k++)
            sum += c[k] * px[k][i];
        pz[i] = sum;
    }
}

// One instance for each count that a method of six stages has, one for any.
LD_INLINE int combine_counted(int count, const double *c, N_Vector *x, N_Vector z)
{
    size_t n = (size_t)NV_LENGTH_S(z);
    if (count < 1 || count > MOST_VECTORS)
        return -1;
    switch (count) {
#define CASE(k)                                                                                    \
    case k:                                                                                        \
        combine(k, c, x, n, data(z));                                                              \
        break
        CASE(2);
        CASE(3);
        CASE(4);
        CASE(5);
        CASE(6);
        CASE(7);
#undef CASE
    default:
        combine(count, c, x, n, data(z));
    }
    return 0;
}

static int vector_linear_combination(int count, double *c, N_Vector *x, N_Vector z)
{
    return combine_counted(count, c, x, z);
}

// The same code with the processor's wider instructions: the same bits.
LANES_AVX2 static int vector_linear_combination_wide(int count, double *c, N_Vector *x, N_Vector z)
{
    return combine_counted(count, c, x, z);
}

// ---- a set of vectors

enum { MOST_IN_SET = 64, LANE = 8 };

typedef struct member {
    struct _generic_N_Vector vector; // first: the library hands this out
    struct _N_VectorContent_Serial content;
    serial_vectors *set;
    bool taken;
} member;

struct serial_vectors {
    struct _generic_N_Vector_Ops ops;
    member member[MOST_IN_SET];
    double *data;
};

N_Vector serial_vectors_take(serial_vectors *set)
{
    int i = 0;
    while (i < MOST_IN_SET && set->member[i].taken)
        i++;
    assert(i < MOST_IN_SET); // the library takes about thirty
    set->member[i].taken = true;
    vector_const(0, &set->member[i].vector);
    return &set->member[i].vector;
}

static N_Vector vector_clone(N_Vector v)
{
    return serial_vectors_take(((member *)v)->set);
}

static void vector_destroy(N_Vector v)
{
    ((member *)v)->taken = false;
}

static void set_operations(N_Vector_Ops ops)
{
    ops->nvclone = vector_clone;
    ops->nvcloneempty = NULL;
    ops->nvdestroy = vector_destroy;
    ops->nvlinearsum = vector_linear_sum;
    ops->nvconst = vector_const;
    ops->nvprod = vector_prod;
    ops->nvdiv = vector_div;
    ops->nvscale = vector_scale;
    ops->nvabs = vector_abs;
    ops->nvinv = vector_inv;
    ops->nvaddconst = vector_add_const;
    ops->nvmin = vector_min;
    ops->nvmaxnorm = vector_max_norm;
    ops->nvwrmsnorm = vector_wrms_norm;
    ops->nvlinearcombination = vector_linear_combination;
    if (lanes_have_avx2())
        ops->nvlinearcombination = vector_linear_combination_wide;
}

serial_vectors *serial_vectors_new(size_t n, SUNContext context)
{
    size_t row = (n + LANE - 1) / LANE * LANE;
    serial_vectors *set = calloc(1, sizeof *set);
    double *data = calloc(MOST_IN_SET * row, sizeof *data);
    N_Vector pattern = set && data ? N_VNewEmpty_Serial((sunindextype)n, context) : NULL;
    if (!pattern) {
        free(set);
        free(data);
        return NULL;
    }
    set->ops = *pattern->ops;
    set->data = data;
    N_VDestroy(pattern);
    set_operations(&set->ops);
    for (int i = 0; i < MOST_IN_SET; i++) {
        member *self = &set->member[i];
        self->set = set;
        self->content = (struct _N_VectorContent_Serial){
            .length = (sunindextype)n, .own_data = SUNFALSE, .data = data + (size_t)i * row};
        self->vector = (struct _generic_N_Vector){
            .content = &self->content, .ops = &set->ops, .sunctx = context};
    }
    return set;
}

void serial_vectors_free(serial_vectors *set)
{
    if (!set)
        return;
    free(set->data);
    free(set);
}
