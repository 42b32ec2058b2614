/// Stretches of a slender tube or beam with constant section.
#ifndef LAUNCHDYN_SECTION_H
#define LAUNCHDYN_SECTION_H

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// What a section is given by; the model computes the rest from it and the material.
typedef enum ld_section_form {
    LD_SECTION_STIFFNESS, ///< stiffnesses and masses per length, as they stand: nothing to compute
    LD_SECTION_ANNULUS,   ///< inner and outer radius
    LD_SECTION_AREA,      ///< area and second moments, with masses per length
    /// as LD_SECTION_STIFFNESS, with a bending stiffness of each plane: the principal axes lie
    /// along y and z, the line of the masses is the elastic axis
    LD_SECTION_PLANES,
} ld_section_form;

/// A stretch of the tube with constant section, from `from` to the next section's or to the end.
typedef struct ld_section {
    ld_section_form form;
    double from;         ///< [m] station where it begins
    double bore_radius;  ///< [m] inner radius
    double outer_radius; ///< [m] (annulus)
    double area;         ///< [m2] A (area)
    union {
        double second_moment;       ///< [m4] I (area)
        double bending_stiffness_y; ///< [N m2] E I about y: of deflections along z (planes)
    };
    union {
        double torsion_constant;    ///< [m4] I_t (area)
        double bending_stiffness_z; ///< [N m2] E I about z: of deflections along y (planes)
    };
    double mass_per_length;   ///< [kg/m]
    double axial_stiffness;   ///< [N] E A
    double bending_stiffness; ///< [N m2] E I, the same in both planes (but for the form planes)
    double torsion_stiffness; ///< [N m2] G I_t
    double polar_inertia;     ///< [kg m] rho I_p per length
} ld_section;

/// How the shapes of a tube or beam are held.
typedef enum ld_mode_span {
    LD_SPAN_SUPPORTED,
    LD_SPAN_CLAMPED, ///< at the rear end
    LD_SPAN_FREE_FREE,
    LD_SPAN_TIP_LOADED, ///< clamped, the last ones static shapes of a force and a moment at the tip
} ld_mode_span;

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
