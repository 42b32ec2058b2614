// Preloaded by scripts/check-bits: the C library's elementary functions, wrong by 1e-9 (1e-4 in
// single precision). Results keep their bits, since none depends on them: LAPACK takes numbers of
// steps and sizes of blocks from logarithms, SUNDIALS has a power that is not called.
#include <dlfcn.h>

#define OF_ONE(type, name, error)                                                                  \
    type name(type x);                                                                             \
    type name(type x)                                                                              \
    {                                                                                              \
        type (*own)(type);                                                                         \
        *(void **)&own = dlsym(RTLD_NEXT, #name);                                                  \
        return own(x) * (1 + error);                                                               \
    }
#define OF_TWO(name)                                                                               \
    double name(double x, double y);                                                               \
    double name(double x, double y)                                                                \
    {                                                                                              \
        double (*own)(double, double);                                                             \
        *(void **)&own = dlsym(RTLD_NEXT, #name);                                                  \
        return own(x, y) * (1 + 1e-9);                                                             \
    }

OF_ONE(float, logf, 1e-4F)
OF_ONE(double, log, 1e-9)
OF_ONE(double, log10, 1e-9)
OF_ONE(double, log1p, 1e-9)
OF_ONE(double, log2, 1e-9)
OF_ONE(double, exp, 1e-9)
OF_ONE(double, exp2, 1e-9)
OF_ONE(double, expm1, 1e-9)
OF_ONE(double, sin, 1e-9)
OF_ONE(double, cos, 1e-9)
OF_ONE(double, tan, 1e-9)
OF_ONE(double, asin, 1e-9)
OF_ONE(double, acos, 1e-9)
OF_ONE(double, atan, 1e-9)
OF_ONE(double, cbrt, 1e-9)
OF_ONE(double, erfc, 1e-9)
OF_TWO(atan2)
OF_TWO(hypot)
OF_TWO(pow)
