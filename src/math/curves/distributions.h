// Distribution functions and their inverses.
#ifndef LD_MATH_DISTRIBUTIONS_H
#define LD_MATH_DISTRIBUTIONS_H

// Standard normal distribution function, accurate in the lower tail.
double normal_cumulative(double z);
// Its inverse for 0 < p < 1 (Wichura, Algorithm AS 241), relative error some 1e-16 in z.
double normal_quantile(double p);

// Regularised incomplete beta function I_x(a, b), by its continued fraction (Lentz); NaN where an
// argument is, or a or b is infinite.
double beta_cumulative(double a, double b, double x);
// Quantile of Student's t with `freedom` > 0 degrees of freedom.
double student_quantile(double p, double freedom);
// P(|T| > |t|) of Student's t.
double student_beyond(double t, double freedom);
// P(X > x) of chi-square with `freedom` > 0 degrees of freedom.
double chi_square_beyond(double x, double freedom);
// P(F > x) of Fisher's F.
double fisher_beyond(double x, double numerator_freedom, double denominator_freedom);
// Binomial distribution function: P(X <= k) of n draws with probability p.
double binomial_cumulative(long k, long n, double p);

#endif
