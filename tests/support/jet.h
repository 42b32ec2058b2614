// Jets: numbers that carry their derivatives along.
//
// A jet is a function of the generalised coordinates x, known at one state of motion. Along the
// motion x(t) with x_ddot = 0, shifted by e in a second, independent time, it holds
//   v                  value
//   t, e               d/dt, d/de: both are the rate along the motion, until a jet is frozen
//   te                 d2/dt de: the part of the acceleration that is quadratic in the speeds
//   d[k], k < n        partial derivative with respect to coordinate k (n = 0: none, all zero)
// Freezing keeps v and t and drops e, te and d: "at this place, which itself moves on, held fixed
// as a place in the material". What is made of frozen places has the material's velocity in e, its
// time derivative at the moving place in te, and the material's Jacobian in d.
#ifndef LD_TESTS_SUPPORT_JET_H
#define LD_TESTS_SUPPORT_JET_H

#include <math.h>

enum { JET_MAX = 40 };

typedef struct jet {
    double v, t, e, te;
    int n;
    double d[JET_MAX];
} jet;

typedef struct jet3 {
    jet c[3];
} jet3;

typedef struct jet33 {
    jet c[3][3];
} jet33;

#define JET_INLINE static inline __attribute__((unused))

JET_INLINE jet jet_constant(double v)
{
    jet r;
    r.v = v;
    r.t = r.e = r.te = 0;
    r.n = 0;
    return r;
}

// Coordinate `index` of n, with its speed.
JET_INLINE jet jet_coordinate(double v, double speed, int index, int n)
{
    jet r;
    r.v = v;
    r.t = r.e = speed;
    r.te = 0;
    r.n = n;
    for (int k = 0; k < n; k++)
        r.d[k] = 0;
    r.d[index] = 1;
    return r;
}

JET_INLINE jet jet_freeze(jet a)
{
    a.e = a.te = 0;
    a.n = 0;
    return a;
}

JET_INLINE jet jet_scale(double f, jet a)
{
    a.v *= f;
    a.t *= f;
    a.e *= f;
    a.te *= f;
    for (int k = 0; k < a.n; k++)
        a.d[k] *= f;
    return a;
}

// a += f b
JET_INLINE void jet_increase(jet *a, double f, const jet *b)
{
    a->v += f * b->v;
    a->t += f * b->t;
    a->e += f * b->e;
    a->te += f * b->te;
    if (b->n && !a->n) {
        a->n = b->n;
        for (int k = 0; k < b->n; k++)
            a->d[k] = f * b->d[k];
    } else {
        for (int k = 0; k < b->n; k++)
            a->d[k] += f * b->d[k];
    }
}

JET_INLINE jet jet_add(jet a, jet b)
{
    jet_increase(&a, 1, &b);
    return a;
}

JET_INLINE jet jet_sub(jet a, jet b)
{
    jet_increase(&a, -1, &b);
    return a;
}

// r = a b; r is neither of them. (Jets are long: by address, none is copied.)
JET_INLINE void jet_product(jet *r, const jet *a, const jet *b)
{
    r->v = a->v * b->v;
    r->t = a->t * b->v + a->v * b->t;
    r->e = a->e * b->v + a->v * b->e;
    r->te = a->te * b->v + a->t * b->e + a->e * b->t + a->v * b->te;
    if (a->n && b->n) {
        r->n = a->n;
        for (int k = 0; k < r->n; k++)
            r->d[k] = a->d[k] * b->v + a->v * b->d[k];
    } else {
        const jet *full = a->n ? a : b;
        double f = a->n ? b->v : a->v;
        r->n = full->n;
        for (int k = 0; k < r->n; k++)
            r->d[k] = full->d[k] * f;
    }
}

JET_INLINE jet jet_mul(jet a, jet b)
{
    jet r;
    jet_product(&r, &a, &b);
    return r;
}

// r += a b
JET_INLINE void jet_accumulate(jet *r, const jet *a, const jet *b)
{
    r->v += a->v * b->v;
    r->t += a->t * b->v + a->v * b->t;
    r->e += a->e * b->v + a->v * b->e;
    r->te += a->te * b->v + a->t * b->e + a->e * b->t + a->v * b->te;
    int n = a->n ? a->n : b->n;
    for (int k = r->n; k < n; k++)
        r->d[k] = 0;
    r->n = n ? n : r->n;
    for (int k = 0; k < a->n; k++)
        r->d[k] += a->d[k] * b->v;
    for (int k = 0; k < b->n; k++)
        r->d[k] += b->d[k] * a->v;
}

// f(a), of f and its first two derivatives at a.v.
JET_INLINE jet jet_apply(jet a, double f, double f1, double f2)
{
    jet r;
    r.v = f;
    r.t = f1 * a.t;
    r.e = f1 * a.e;
    r.te = f1 * a.te + f2 * a.t * a.e;
    r.n = a.n;
    for (int k = 0; k < a.n; k++)
        r.d[k] = f1 * a.d[k];
    return r;
}

JET_INLINE jet jet_sqrt(jet a)
{
    double f = sqrt(a.v);
    return jet_apply(a, f, 0.5 / f, -0.25 / (f * a.v));
}

JET_INLINE jet jet_inverse(jet a)
{
    double f = 1 / a.v;
    return jet_apply(a, f, -f * f, 2 * f * f * f);
}

JET_INLINE jet jet_sin(jet a)
{
    return jet_apply(a, sin(a.v), cos(a.v), -sin(a.v));
}

JET_INLINE jet jet_cos(jet a)
{
    return jet_apply(a, cos(a.v), -sin(a.v), -cos(a.v));
}

JET_INLINE jet3 jet3_constant(const double a[3])
{
    return (jet3){{jet_constant(a[0]), jet_constant(a[1]), jet_constant(a[2])}};
}

JET_INLINE jet3 jet3_freeze(jet3 a)
{
    return (jet3){{jet_freeze(a.c[0]), jet_freeze(a.c[1]), jet_freeze(a.c[2])}};
}

JET_INLINE jet3 jet3_sub(const jet3 *a, const jet3 *b)
{
    jet3 r = *a;
    for (int i = 0; i < 3; i++)
        jet_increase(&r.c[i], -1, &b->c[i]);
    return r;
}

JET_INLINE jet jet3_dot(const jet3 *a, const jet3 *b)
{
    jet r = jet_constant(0);
    for (int i = 0; i < 3; i++)
        jet_accumulate(&r, &a->c[i], &b->c[i]);
    return r;
}

JET_INLINE jet33 jet33_constant(const double A[3][3])
{
    jet33 r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.c[i][j] = jet_constant(A[i][j]);
    return r;
}

JET_INLINE jet3 jet33_column(const jet33 *A, int j)
{
    return (jet3){{A->c[0][j], A->c[1][j], A->c[2][j]}};
}

JET_INLINE jet33 jet33_transpose(const jet33 *A)
{
    jet33 r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.c[i][j] = A->c[j][i];
    return r;
}

// A a
JET_INLINE jet3 jet33_turn(const jet33 *A, const jet3 *a)
{
    jet3 r;
    for (int i = 0; i < 3; i++) {
        r.c[i] = jet_constant(0);
        for (int j = 0; j < 3; j++)
            jet_accumulate(&r.c[i], &A->c[i][j], &a->c[j]);
    }
    return r;
}

// A^T a
JET_INLINE jet3 jet33_turn_back(const jet33 *A, const jet3 *a)
{
    jet3 r;
    for (int i = 0; i < 3; i++) {
        r.c[i] = jet_constant(0);
        for (int j = 0; j < 3; j++)
            jet_accumulate(&r.c[i], &A->c[j][i], &a->c[j]);
    }
    return r;
}

JET_INLINE jet33 jet33_mul(const jet33 *A, const jet33 *B)
{
    jet33 r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            r.c[i][j] = jet_constant(0);
            for (int k = 0; k < 3; k++)
                jet_accumulate(&r.c[i][j], &A->c[i][k], &B->c[k][j]);
        }
    return r;
}

#endif
