/// Adaptors and the laws of their contact: the blocks `rocket.adaptors` and `rocket.contact`.
#ifndef LD_MODEL_BLOCKS_CONTACT_H
#define LD_MODEL_BLOCKS_CONTACT_H

#include <stdbool.h>

#include "model/blocks/limits.h"
#include "model/blocks/table.h"

/// What falls off with an adaptor as it leaves the guide; until then a part of the rocket.
typedef struct ld_falling {
    bool present;
    double mass;       ///< [kg]
    double center[2];  ///< [m] y, z of its mass centre in B; x is the adaptor's
    double inertia[3]; ///< [kg m2] about its own mass centre
} ld_falling;

typedef struct ld_adaptor {
    char name[LD_MAX_NAME];
    double at;        ///< [m] l_i, from the rear adaptor
    double clearance; ///< [m] radial; not used by laws that hold on both sides, NaN there if not
                      ///< given. On surfaces: added to their gaps at this shoe, NaN: nothing
    double leaves_at; ///< [m] station of the guide at which its contact ends; NaN: the tip
    ld_falling falls_off;
} ld_adaptor;

/// The contact laws, the first by default: each with its word and its traits. Their forces stand in
/// elements/guide/contact.h; of one that holds on both sides that of an adaptor in
/// elements/guide/adaptor.h (bilateral) and elements/guide/ideal.h.
#define LD_CONTACT_LAWS(LAW)                                                                       \
    LAW(LD_CONTACT_HUNT_CROSSLEY, "hunt-crossley", 0)                                              \
    LAW(LD_CONTACT_LANKARANI_NIKRAVESH, "lankarani-nikravesh", LD_CONTACT_BY_TOUCH)                \
    LAW(LD_CONTACT_KELVIN_VOIGT, "kelvin-voigt", LD_CONTACT_LINEAR)                                \
    LAW(LD_CONTACT_BILATERAL, "bilateral", LD_CONTACT_LINEAR | LD_CONTACT_TWO_SIDED)               \
    LAW(LD_CONTACT_IDEAL, "ideal", LD_CONTACT_TWO_SIDED | LD_CONTACT_HELD)

#define LD_CONTACT_LAW_NAME(name, word, traits) name,
typedef enum ld_contact_law { LD_CONTACT_LAWS(LD_CONTACT_LAW_NAME) } ld_contact_law;

enum {
    LD_CONTACT_LINEAR = 1,    ///< its exponent is 1, it damps by its own coefficient
    LD_CONTACT_TWO_SIDED = 2, ///< holds the adaptor on the axis, without clearance
    LD_CONTACT_BY_TOUCH = 4,  ///< depends on the speed at first touch
    LD_CONTACT_HELD = 8,      ///< holds it there exactly, by constraints: no stiffness
};

/// Whether a law has a trait.
static inline bool contact_has(ld_contact_law law, unsigned trait)
{
#define LD_CONTACT_LAW_TRAITS(name, word, traits) traits,
    static const unsigned of[] = {LD_CONTACT_LAWS(LD_CONTACT_LAW_TRAITS)};
    return of[law] & trait;
}

/// Contact between adaptors and tube: model.md, section 5.
typedef struct ld_contact {
    ld_contact_law law;
    double stiffness;             ///< [N/m] k; NaN if not given (ideal: of the breech alone)
    double exponent;              ///< [-] n
    double reference_penetration; ///< [m] d_0
    double restitution;           ///< [-] e
    double reference_speed;       ///< [m/s] v_0
    double damping;               ///< [N s/m] c, of the laws kelvin-voigt and bilateral
    double friction;              ///< [-] mu
    double friction_speed;        ///< [m/s] v_eps, of tube contact and slot
    ld_table drag;                ///< [m, N] of all adaptors in the guide over the travel from
                                  ///< start_at; no rows: none
    ld_table drag_over_speed;     ///< [m/s, N] added, over the sliding speed; no rows: none
    double drag_scale;            ///< [-] factor on both
} ld_contact;

#endif
