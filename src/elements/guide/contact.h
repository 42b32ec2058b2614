// Normal force of an adaptor on the tube's wall, and of the rocket on the breech (model.md, section
// 5).
#ifndef LD_ELEMENTS_CONTACT_H
#define LD_ELEMENTS_CONTACT_H

#include <stdbool.h>

#include "math/functions.h"
#include "math/vec3.h"
#include "model/blocks/contact.h"

typedef struct contact_law {
    ld_contact_law kind;
    bool two_sided, by_touch;
    bool held;    // on the axis, exactly: no force of a law but constraints
    double k;     // [N/m]
    double n;     // exponent
    double d0;    // [m] reference penetration
    double chi;   // [s/m] damping per force: 1.5 (1 - e)/v_0 (hunt-crossley)
    double zeta;  // 0.75 (1 - e^2), over the touch speed (lankarani-nikravesh)
    double c;     // [N s/m] (kelvin-voigt, bilateral)
    double mu;    // friction
    double v_eps; // [m/s] of the friction's regularisation
    double v_0;   // [m/s] reference speed
} contact_law;

LD_INLINE contact_law contact_law_of(const ld_contact *model)
{
    double e = model->restitution;
    return (contact_law){.kind = model->law,
                         .two_sided = contact_has(model->law, LD_CONTACT_TWO_SIDED),
                         .by_touch = contact_has(model->law, LD_CONTACT_BY_TOUCH),
                         .held = contact_has(model->law, LD_CONTACT_HELD),
                         .k = model->stiffness,
                         .n = model->exponent,
                         .d0 = model->reference_penetration,
                         .chi = 1.5 * (1 - e) / model->reference_speed,
                         .zeta = 0.75 * (1 - e * e),
                         .c = model->damping,
                         .mu = model->friction,
                         .v_eps = model->friction_speed,
                         .v_0 = model->reference_speed};
}

/// Elastic part k d_0 (p/d_0)^n [N] for p > 0.
LD_INLINE double contact_elastic(const contact_law *law, double p)
{
    if (law->n == 1)
        return law->k * p;
    double ratio = p / law->d0;
    return law->k * law->d0 * (law->n == 1.5 ? ratio * sqrt(ratio) : pow(ratio, law->n));
}

/// Normal force [N] at penetration p > 0 [m] growing at p_dot [m/s]; `touch_speed` is p_dot at
/// first touch (lankarani-nikravesh alone).
LD_INLINE double contact_normal(const contact_law *law, double p, double p_dot, double touch_speed)
{
    switch (law->kind) {
    case LD_CONTACT_KELVIN_VOIGT: // linear
    case LD_CONTACT_BILATERAL:    // at the breech, which holds on one side only
        return fmax(0, law->k * p + law->c * p_dot);
    case LD_CONTACT_LANKARANI_NIKRAVESH:
        return contact_elastic(law, p) * fmax(0, 1 + law->zeta * p_dot / touch_speed);
    default:
        return contact_elastic(law, p) * fmax(0, 1 + law->chi * p_dot);
    }
}

#endif
