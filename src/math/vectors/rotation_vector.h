// Rotation vectors: Exp, its logarithm, and the left Jacobian (formulation.md, section 1).
#ifndef LD_MATH_ROTATION_VECTOR_H
#define LD_MATH_ROTATION_VECTOR_H

#include "math/functions.h"
#include "math/vectors/quaternion.h"

// Coefficients of Exp(~th) = E + a ~th + b ~th^2 and Jl(th) = E + b ~th + c ~th^2, with
// a = sin t/t, b = (1 - cos t)/t^2, c = (t - sin t)/t^3, t = |th|, and their derivatives with
// respect to t^2/2 where a derivative along a direction is needed: db = (a - 2 b)/t^2, dc = (b - 3
// c)/t^2.
typedef struct rv_coefficients {
    double a, b, c, db, dc;
} rv_coefficients;

// Sum over k of (-1)^k f_k t2^k, f_0 = 1/first!, f_(k+1) = f_k/((n + 1)(n + 2)): the series of sin
// t/t (first = 1), (1 - cos t)/t^2 (2), (t - sin t)/t^3 (3); with `slope` its derivative with
// respect to t2/2. Twelve terms are exact to rounding up to t2 = 1 (1/26! = 2e-27).
LD_INLINE double rv_series(double t2, int first, int slope)
{
    double factor = 1, sum = 0, power = 1;
    for (int i = 2; i <= first; i++)
        factor /= i;
    for (int k = 0, n = first; k < 12; k++, n += 2) {
        if (!slope) {
            sum += factor * power;
            power *= t2;
        } else if (k > 0) {
            sum += 2 * k * factor * power;
            power *= t2;
        }
        factor /= -(double)((n + 1) * (n + 2));
    }
    return sum;
}

// Small angles by the first terms, up to 1 rad by the whole series, above in closed form (which
// would lose digits below).
LD_INLINE rv_coefficients rv_coefficients_of(double t2)
{
    rv_coefficients k;
    if (t2 < 1e-3) {
        // to t^8: next terms below (1e-3)^5/11! = 3e-23; factors 1/n! as constants, no divisions
        k.a = 1 + t2 * (-1.0 / 6 + t2 * (1.0 / 120 + t2 * (-1.0 / 5040 + t2 * (1.0 / 362880))));
        k.b = 1.0 / 2 +
              t2 * (-1.0 / 24 + t2 * (1.0 / 720 + t2 * (-1.0 / 40320 + t2 * (1.0 / 3628800))));
        k.c = 1.0 / 6 +
              t2 * (-1.0 / 120 + t2 * (1.0 / 5040 + t2 * (-1.0 / 362880 + t2 * (1.0 / 39916800))));
        k.db = -1.0 / 12 + t2 * (4.0 / 720 + t2 * (-6.0 / 40320 + t2 * (8.0 / 3628800)));
        k.dc = -1.0 / 60 + t2 * (4.0 / 5040 + t2 * (-6.0 / 362880 + t2 * (8.0 / 39916800)));
    } else if (t2 < 1) {
        k.a = rv_series(t2, 1, 0);
        k.b = rv_series(t2, 2, 0);
        k.c = rv_series(t2, 3, 0);
        k.db = rv_series(t2, 2, 1);
        k.dc = rv_series(t2, 3, 1);
    } else {
        double t = sqrt(t2), s = sin(t), h = sin(0.5 * t);
        k.a = s / t;
        k.b = 2 * h * h / t2;
        k.c = (t - s) / (t2 * t);
        k.db = (k.a - 2 * k.b) / t2;
        k.dc = (k.b - 3 * k.c) / t2;
    }
    return k;
}

/// Exp(~th): the rotation matrix of the rotation vector th.
LD_INLINE m3 rv_exp(v3 th)
{
    double t2 = v3_norm2(th);
    rv_coefficients k = rv_coefficients_of(t2);
    m3 A = m3_scale(k.b, m3_outer(th, th));
    for (int i = 0; i < 3; i++)
        A.a[i][i] += 1 - k.b * t2;
    return m3_add(A, m3_scale(k.a, m3_skew(th)));
}

/// Jl(th): w = Jl th_dot is the angular velocity of Exp(~th) in the outer frame.
LD_INLINE m3 rv_left_jacobian(v3 th)
{
    double t2 = v3_norm2(th);
    rv_coefficients k = rv_coefficients_of(t2);
    m3 J = m3_scale(k.c, m3_outer(th, th));
    for (int i = 0; i < 3; i++)
        J.a[i][i] += 1 - k.c * t2;
    return m3_add(J, m3_scale(k.b, m3_skew(th)));
}

/// Derivative of Jl(th) a along d, i.e. d/de [Jl(th + e d) a] at e = 0.
LD_INLINE v3 rv_left_jacobian_derivative(v3 th, v3 d, v3 a)
{
    rv_coefficients k = rv_coefficients_of(v3_norm2(th));
    v3 ta = v3_cross(th, a), da = v3_cross(d, a);
    double td = v3_dot(th, d);
    v3 r = v3_scale(k.b, da);
    r = v3_axpy(r, k.c, v3_add(v3_cross(d, ta), v3_cross(th, da)));
    r = v3_axpy(r, k.db * td, ta);
    return v3_axpy(r, k.dc * td, v3_cross(th, ta));
}

/// Rotation vector of a rotation matrix, |th| <= pi.
LD_INLINE v3 rv_log(m3 A)
{
    quat q = q_from_matrix(A);
    double n = sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
    if (q.w < 0) {
        q = (quat){-q.w, -q.x, -q.y, -q.z};
    }
    double f = n < 1e-8 ? 2.0 / q.w : 2.0 * atan2(n, q.w) / n;
    return v3_make(f * q.x, f * q.y, f * q.z);
}

/// Jl(phi)^-T m, for the spring moment of model.md section 4:
/// Jl^-1 = E - ~phi/2 + e ~phi^2, e = (1 - t sin t/(2 (1 - cos t)))/t^2; ^T changes the sign of
/// ~phi.
LD_INLINE v3 rv_left_jacobian_inverse_transposed(v3 phi, v3 m)
{
    double t2 = v3_norm2(phi), e;
    if (t2 < 1e-3) {
        e = 1.0 / 12 + t2 * (1.0 / 720 + t2 * (1.0 / 30240 + t2 * (1.0 / 1209600)));
    } else if (t2 < 1) {
        // 1 - a/(2 b) = (b - a/2)/b, and (b - a/2)/t2 = sum over k >= 1 of (-1)^(k+1) k
        // t2^(k-1)/(2k + 2)!
        double factor = 1.0 / 6, sum = 0;
        for (int k = 1, n = 4; k < 13; k++, n += 2) {
            sum += k * factor / n;
            factor *= -t2 / ((n) * (n + 1.0));
        }
        e = sum / rv_series(t2, 2, 0);
    } else {
        rv_coefficients k = rv_coefficients_of(t2);
        e = (1 - 0.5 * k.a / k.b) / t2;
    }
    v3 pm = v3_cross(phi, m);
    return v3_axpy(v3_axpy(m, 0.5, pm), e, v3_cross(phi, pm));
}

/// Rotation vector of a quaternion of small or large angle.
LD_INLINE v3 rv_of_quaternion(quat q)
{
    double sign = q.w < 0 ? -1 : 1;
    double n2 = q.x * q.x + q.y * q.y + q.z * q.z;
    double factor;
    if (n2 < 1e-4) { // 2 asin(n)/n; next term below 2e-22
        factor =
            2 * (1 + n2 * (1.0 / 6 + n2 * (3.0 / 40 + n2 * (15.0 / 336 + n2 * (105.0 / 3456)))));
        factor *= sign;
    } else {
        double n = sqrt(n2);
        factor = sign * 2 * atan2(n, fabs(q.w)) / n;
    }
    return v3_make(factor * q.x, factor * q.y, factor * q.z);
}

/// Quaternion of a rotation vector.
LD_INLINE quat rv_quaternion(v3 th)
{
    double h2 = 0.25 * v3_norm2(th), c, s; // s = sin(h)/(2 h)
    if (h2 < 1e-4) {
        c = 1 + h2 * (-1.0 / 2 + h2 * (1.0 / 24 + h2 * (-1.0 / 720 + h2 * (1.0 / 40320))));
        s = 0.5 + h2 * (-1.0 / 12 + h2 * (1.0 / 240 + h2 * (-1.0 / 10080 + h2 * (1.0 / 725760))));
    } else {
        double h = sqrt(h2);
        sincos(h, &s, &c);
        s = 0.5 * s / h;
    }
    return (quat){c, s * th.x, s * th.y, s * th.z};
}

#endif
