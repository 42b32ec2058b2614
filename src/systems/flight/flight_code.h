// The equations of motion of flights side by side, one in each lane (math/real.h): the text of
// flight_default.c, which has one lane, and of flight_avx2.c and flight_avx512.c. Turbulence, gusts
// and the intervals of tables are found lane by lane.
#ifndef LD_SYSTEMS_FLIGHT_CODE_H
#define LD_SYSTEMS_FLIGHT_CODE_H

#include "elements/air/aerodynamics_real.h"
#include "environment/atmosphere_real.h"
#include "environment/earth_real.h"
#include "environment/wind_real.h"
#include "math/real_sine_cosine.h"
#include "math/vectors/real_vec3.h"
#include "model/blocks/rocket.h"
#include "systems/flight/flight.h"

// A number of the flights, and three of them.
#define OF(member) (*REALS(lanes->number, flight_numbers, member))
#define THREE_OF(member) real3_from(REALS(lanes->number, flight_numbers, member))

// What burns, and the mass data; of a symmetric rocket only the two moments of inertia.
typedef struct burning {
    real thrust, mass;
    real flow; // what the burnt share grows with
    real3 c, c_dot;
    real33 J;
} burning;

LD_INLINE burning burning_at(const flight_lanes *lanes, real t, bool symmetric)
{
    burning out;
    real since = t - OF(burn.t0);
    out.thrust = OF(burn.thrust) + OF(burn.slope) * since;
    real burnt = 0.5 * (OF(burn.thrust) + out.thrust) * since;
    out.flow = out.thrust;
    if (lanes->system[0]->motor.at) {
        burnt = since;
        out.flow = real_all(1);
    }
    real share = OF(burn.share) + OF(burn.rate) * burnt;
    real3 change = THREE_OF(c_change);
    out.mass = OF(mass) - share * OF(propellant);
    out.c = real3_axpy(THREE_OF(c), share, change);
    out.c_dot = real3_scale(OF(burn.rate) * out.flow, change);
    const real *J = REALS(lanes->number, flight_numbers, J),
               *J_change = REALS(lanes->number, flight_numbers, J_change);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (!symmetric || (i == j && i < 2))
                out.J.a[i][j] = J[3 * i + j] + share * J_change[3 * i + j];
    return out;
}

// The motor's force, in B, and where it acts; of further ones force and moment about O1.
typedef struct motor_push {
    real3 force, at;
    real_wrench others;
} motor_push;

LD_INLINE void set_lane(real3 *v, int i, v3 now)
{
    (void)i; // where there is but one
    REAL_LANE(v->x, i) = now.x;
    REAL_LANE(v->y, i) = now.y;
    REAL_LANE(v->z, i) = now.z;
}

LD_INLINE motor_push push_of(const flight_lanes *lanes, real t, real thrust)
{
    motor_push out = {.force = real3_scale(thrust, THREE_OF(thrust_direction)),
                      .at = THREE_OF(thrust_point)};
    if (!lanes->system[0]->motor.across)
        return out;
    for (int i = 0; i < LANES; i++) {
        const flight_phase *phase = lanes->phase[i];
        const ld_motor *given = &lanes->system[i]->rocket->motor;
        motor_across across = motor_across_at(&lanes->system[i]->motor, phase->piece,
                                              REAL_LANE(t, i) - phase->t_ignition);
        double y = given->misalignment[0] + across.lean[0],
               z = given->misalignment[1] + across.lean[1];
        double along = (REAL_LANE(thrust, i) - across.others) / sqrt(1 + y * y + z * z);
        REAL_LANE(out.force.x, i) = along;
        REAL_LANE(out.force.y, i) = along * y + across.force[0];
        REAL_LANE(out.force.z, i) = along * z + across.force[1];
        REAL_LANE(out.at.y, i) = given->at[1] + across.shift[0];
        REAL_LANE(out.at.z, i) = given->at[2] + across.shift[1];
        set_lane(&out.others.f, i, across.others_force);
        set_lane(&out.others.m, i, across.others_moment);
    }
    return out;
}

// Force and moment about the mass centre, in B, of the gas that flows and of the rates of mass,
// centre and inertia (systems/flight/flight.h).
LD_INLINE real_wrench jet_damping(const flight_lanes *lanes, const burning *mass, real3 nozzle,
                                  real3 w)
{
    real gone = OF(burn.rate) * mass->flow, leaving = gone * OF(propellant);
    real3 arm = real3_sub(nozzle, mass->c);
    real3 inside = real3_axpy(real3_scale(mass->mass, mass->c_dot), leaving, arm);
    real3 turned = real3_cross(arm, real3_cross(w, arm));
    real exit = OF(exit_square);
    turned = real3_add(turned, (real3){2.0 * exit * w.x, exit * w.y, exit * w.z});
    const real *J_change = REALS(lanes->number, flight_numbers, J_change);
    real33 J_dot;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            J_dot.a[i][j] = gone * J_change[3 * i + j];
    real3 moment = real3_axpy(real33_apply(&J_dot, w), leaving, turned);
    return (real_wrench){real3_scale(real_all(-2), real3_cross(w, inside)),
                         real3_scale(real_all(-1), moment)};
}

// The air at points of C that move with v, and the velocity through it, in C.
typedef struct flow {
    real altitude;
    real_air air;
    real3 wind; // velocity of the air against the ground, without turbulence
    real3 v;
    real xi_dot[2];
} flow;

// A block of the intervals kept.
#define KEPT(member) ((real *)lanes->tables + offsetof(flight_tables, member) / sizeof(double))

LD_INLINE real3 add_gusts(const flight_lanes *lanes, real t, real3 v)
{
    for (int i = 0; i < LANES; i++) {
        v3 out = {REAL_LANE(v.x, i), REAL_LANE(v.y, i), REAL_LANE(v.z, i)};
        out = wind_add_gusts(&lanes->system[i]->wind, REAL_LANE(t, i), out);
        set_lane(&v, i, out);
    }
    return v;
}

// Velocity of the air against the ground in the wind's axes.
LD_INLINE real3 wind_in_its_axes(const flight_lanes *lanes, real t, real height)
{
    const wind *first = &lanes->system[0]->wind;
    real3 v = THREE_OF(wind.steady);
    if (first->has_profile) {
        real last = OF(wind.last), held = real_select(height < OF(wind.first), OF(wind.first),
                                                      real_select(height > last, last, height));
        real *kept = KEPT(wind);
        unsigned left = curves_left(kept, held);
        for (int i = 0; left; i++, left >>= 1)
            if (left & 1)
                curves_keep(kept, i, &lanes->system[i]->wind.profile, REAL_LANE(held, i),
                            WIND_FUNCTIONS);
        v = wind_by_profile(v, OF(wind.scale), kept, held);
    }
    return first->gust_count > 0 ? add_gusts(lanes, t, v) : v;
}

LD_INLINE real3 turn_wind(const flight_lanes *lanes, real3 v)
{
    real33 A;
    memcpy(&A, REALS(lanes->number, flight_numbers, wind.axes), sizeof A);
    return real33_apply(&A, v);
}

// From axes north, up, east at the points r of C to C; the Earth's turn does not change them.
LD_INLINE real3 turn_from_north(const flight_lanes *lanes, real3 r, real3 v)
{
    const real_ellipsoid round = {OF(earth.a), OF(earth.b), OF(earth.e2)};
    return earth_from_north(&round, r, v);
}

// Velocity of the air against the ground, without turbulence, at points r of C, in C.
LD_INLINE real3 wind_of_lanes(const flight_lanes *lanes, real t, real3 r, real altitude)
{
    const flight_system *first = lanes->system[0];
    bool flat = first->earth.flat, geographic = first->wind.geographic;
    real height = altitude;
    if (!geographic)
        height = (flat ? r.y : altitude) - OF(earth.ground);
    real3 v = wind_in_its_axes(lanes, t, height);
    if (flat)
        return geographic ? turn_wind(lanes, v) : v;
    if (geographic)
        return turn_from_north(lanes, r, v);
    real s, c;
    real_sine_cosine(OF(earth.rotation) * t, &s, &c);
    v = turn_wind(lanes, v);
    return (real3){c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

// Less the velocity of turbulence, v being that without it.
LD_INLINE void take_turbulence(const flight_lanes *lanes, real t, real3 r, const real xi[2],
                               flow *out)
{
    for (int i = 0; i < LANES; i++) {
        const flight_system *system = lanes->system[i];
        v3 place = {REAL_LANE(r.x, i), REAL_LANE(r.y, i), REAL_LANE(r.z, i)};
        v3 v = {REAL_LANE(out->v.x, i), REAL_LANE(out->v.y, i), REAL_LANE(out->v.z, i)};
        double now = REAL_LANE(t, i), altitude = REAL_LANE(out->altitude, i);
        turbulence_scales scales;
        double mean_speed = v3_norm(v), at[2] = {REAL_LANE(xi[0], i), REAL_LANE(xi[1], i)};
        v = v3_sub(v, flight_turbulence(system, now, place, altitude, at, &scales));
        REAL_LANE(out->xi_dot[0], i) = mean_speed / scales.L_u;
        REAL_LANE(out->xi_dot[1], i) = mean_speed / scales.L_w;
        REAL_LANE(out->v.x, i) = v.x;
        REAL_LANE(out->v.y, i) = v.y;
        REAL_LANE(out->v.z, i) = v.z;
    }
}

// Measured air at the altitude of each lane.
LD_INLINE real_air look_up_air(const flight_lanes *lanes, real altitude)
{
    real *kept = KEPT(air);
    unsigned left = curves_left(kept, altitude);
    for (int i = 0; left; i++, left >>= 1)
        if (left & 1)
            curves_keep(kept, i, &lanes->system[i]->atmosphere.profile, REAL_LANE(altitude, i),
                        ATMOSPHERE_FUNCTIONS);
    return atmosphere_measured(kept, altitude, OF(air.density_scale), OF(air.temperature_offset));
}

LD_INLINE real altitude_of(const flight_lanes *lanes, real3 r)
{
    if (lanes->system[0]->earth.flat)
        return OF(earth.altitude) + r.y;
    const real_ellipsoid round = {OF(earth.a), OF(earth.b), OF(earth.e2)};
    return earth_altitude_above(&round, r);
}

LD_INLINE flow flow_at(const flight_lanes *lanes, real t, real3 r, real3 v, const real xi[2])
{
    const flight_system *first = lanes->system[0];
    flow out = {.altitude = altitude_of(lanes, r), .v = v};
    if (!first->earth.flat)
        out.v =
            real3_sub(v, (real3){-OF(earth.rotation) * r.y, OF(earth.rotation) * r.x, real_all(0)});
    if (first->atmosphere.kind == LD_ATMOSPHERE_US1976) {
        out.air = atmosphere_standard(first->atmosphere.layer, out.altitude, OF(air.density_scale),
                                      OF(air.temperature_offset));
    } else if (first->atmosphere.kind == LD_ATMOSPHERE_PROFILE) {
        out.air = look_up_air(lanes, out.altitude);
    } else {
        out.air = (real_air){OF(air.density), OF(air.speed_of_sound)};
    }
    if (first->wind.present) {
        out.wind = wind_of_lanes(lanes, t, r, out.altitude);
        out.v = real3_sub(out.v, out.wind);
    }
    if (first->turbulence.present)
        take_turbulence(lanes, t, r, xi, &out);
    return out;
}

// The first `functions` coefficients of each lane's table at its Mach number.
LD_INLINE void look_up(const flight_lanes *lanes, real mach, int functions, real *k)
{
    real *kept = KEPT(aerodynamics);
    unsigned left = curves_left(kept, mach);
    for (int i = 0; left; i++, left >>= 1)
        if (left & 1)
            curves_keep(kept, i, &lanes->system[i]->aerodynamics.table, REAL_LANE(mach, i),
                        functions);
    curves_kept_values(kept, mach, functions, k);
}

// Rotation about x by an angle of which cosine and sine are given, and back.
LD_INLINE real3 roll(real c, real s, real3 a)
{
    return (real3){a.x, c * a.y - s * a.z, s * a.y + c * a.z};
}

// The rocket in the flow: from C to N, from N to B, mass centre and rates in B.
typedef struct in_flow {
    const real33 *A;
    real c, s; // cosine and sine of the roll
    real3 center, w;
} in_flow;

// Velocity of the wind at each surface less that at the mass centre r, in B.
LD_INLINE void wind_at_surfaces(const flight_lanes *lanes, real t, real3 r, const flow *here,
                                const in_flow *rocket, real3 *shear)
{
    const flight_system *first = lanes->system[0];
    int slopes = first->aerodynamics.surfaces.slopes,
        count = slopes + first->aerodynamics.surfaces.acrosses;
    const real *slope_at = REALS(lanes->number, flight_numbers, air.slope_at),
               *across_at = REALS(lanes->number, flight_numbers, air.across_at);
    for (int k = 0; k < count; k++) {
        real3 place = {k < slopes ? slope_at[k] : across_at[k - slopes], real_all(0), real_all(0)};
        real3 arm = real3_sub(place, rocket->center);
        real3 at = real3_add(r, real33_apply(rocket->A, roll(rocket->c, rocket->s, arm)));
        real3 more = real3_sub(wind_of_lanes(lanes, t, at, altitude_of(lanes, at)), here->wind);
        shear[k] = roll(rocket->c, -rocket->s, real33_apply_transposed(rocket->A, more));
    }
}

LD_INLINE real_wrench wrench_of_surfaces(const flight_lanes *lanes, real held,
                                         const real_airflow *through, const real3 *shear)
{
    const air_surfaces *first = &lanes->system[0]->aerodynamics.surfaces;
    real k[SURFACES_COLUMNS];
    look_up(lanes, held, SURFACES_FIRST + first->slopes, k);
    const real_surfaces all = {OF(air.half_area),
                               OF(air.diameter),
                               first->slopes,
                               first->acrosses,
                               REALS(lanes->number, flight_numbers, air.slope_at),
                               REALS(lanes->number, flight_numbers, air.across_at),
                               REALS(lanes->number, flight_numbers, air.across)};
    real drag = real_select(OF(burn.power) != 0.0, k[1], k[0]);
    return aerodynamics_of_surfaces(&all, k, drag, through, shear);
}

LD_INLINE real_wrench wrench_of_lanes(const flight_lanes *lanes, real t, real3 r, const flow *here,
                                      const in_flow *rocket)
{
    const flight_system *first = lanes->system[0];
    const real_airflow through = {
        .v = roll(rocket->c, -rocket->s, real33_apply_transposed(rocket->A, here->v)),
        .speed = real3_norm(here->v),
        .w = rocket->w,
        .c = rocket->center,
        .density = here->air.density};
    if (first->aerodynamics.model == LD_AERODYNAMICS_BODY)
        return aerodynamics_of_body(OF(air.drag), THREE_OF(air.damping), &through);
    real mach = through.speed / here->air.speed_of_sound;
    real held = real_select(mach < OF(air.last_mach), mach, OF(air.last_mach));
    if (first->aerodynamics.model == LD_AERODYNAMICS_SURFACES) {
        real3 shear[LD_MAX_AIR_SURFACES + SURFACES_ACROSS];
        if (first->feels_shear)
            wind_at_surfaces(lanes, t, r, here, rocket, shear);
        return wrench_of_surfaces(lanes, held, &through, first->feels_shear ? shear : NULL);
    }
    real coefficient[AERODYNAMICS_COLUMNS];
    look_up(lanes, held, AERODYNAMICS_COLUMNS, coefficient);
    const real_body body = {OF(air.half_area), OF(air.diameter), OF(air.cant),
                            OF(air.crossflow_drag), OF(air.crossflow_at)};
    real drag = real_select(OF(burn.power) != 0.0, coefficient[1], coefficient[0]);
    return aerodynamics_of_coefficients(&body, coefficient, drag, &through);
}

// Force of the air brakes, along the rocket's axis.
LD_INLINE real brakes(const flight_lanes *lanes, real t, real3 r, const real33 *A, const flow *here)
{
    real area;
    for (int i = 0; i < LANES; i++) {
        const flight_system *system = lanes->system[i];
        double height = system->earth.flat ? REAL_LANE(r.y, i) : REAL_LANE(here->altitude, i);
        REAL_LANE(area, i) = flight_brake_area(
            system, REAL_LANE(t, i) - lanes->phase[i]->t_ignition, height - system->ground);
    }
    real along = real33_apply_transposed(A, here->v).x;
    return -0.5 * here->air.density * area * real3_norm(here->v) * along;
}

// Acceleration of a rocket that hangs below a parachute.
LD_INLINE real3 fall_below(const flight_lanes *lanes, real t, const flow *here, real mass,
                           real3 gravity)
{
    real area = OF(parachute.area) + OF(parachute.slope) * (t - OF(parachute.t0));
    real drag = 0.5 * here->air.density * area * real3_norm(here->v) / mass;
    return real3_axpy(gravity, -drag, here->v);
}

// What becomes of the rates where it hangs: those of a point.
LD_INLINE void hang_rates(real_condition hangs, real3 a, const real *y, real *y_dot)
{
    real still[FLIGHT_XI];
    for (int i = 0; i < FLIGHT_XI; i++)
        still[i] = real_all(0);
    real3_store(still + FLIGHT_R, real3_from(y + FLIGHT_V));
    real3_store(still + FLIGHT_V, a);
    for (int i = 0; i < FLIGHT_XI; i++)
        y_dot[i] = real_select(hangs, still[i], y_dot[i]);
}

LD_INLINE void rates(const flight_lanes *lanes, real t, const real *y, real *y_dot, bool symmetric)
{
    const flight_system *first = lanes->system[0];
    real3 r = real3_from(y + FLIGHT_R), v = real3_from(y + FLIGHT_V);
    real3 w_N = real3_from(y + FLIGHT_W);
    const real *q = y + FLIGHT_Q;
    real33 A = real33_of_quaternion(q);
    // roll between N and B; of a symmetric rocket every such pair of axes is as good as B's
    real c = real_all(1), s = real_all(0);
    if (!symmetric)
        real_sine_cosine(y[FLIGHT_ROLL], &s, &c);
    real3 w = roll(c, -s, w_N);
    // mass and thrust
    burning mass = burning_at(lanes, t, symmetric);
    motor_push push = push_of(lanes, t, mass.thrust);
    real3 force = push.force;
    real3 moment = real3_cross(real3_sub(push.at, mass.c), force);
    if (first->motor.across) {
        force = real3_add(force, push.others.f);
        moment = real3_add(moment, real3_sub(push.others.m, real3_cross(mass.c, push.others.f)));
    }
    if (first->jet_damping) {
        real_wrench jet = jet_damping(lanes, &mass, push.at, w);
        force = real3_add(force, jet.f);
        moment = real3_add(moment, jet.m);
    }
    // air
    y_dot[FLIGHT_XI] = y_dot[FLIGHT_XI + 1] = real_all(0);
    flow here;
    if (first->feels_air)
        here = flow_at(lanes, t, r, v, y + FLIGHT_XI);
    if (first->turbulence.present) {
        y_dot[FLIGHT_XI] = here.xi_dot[0];
        y_dot[FLIGHT_XI + 1] = here.xi_dot[1];
    }
    if (first->aerodynamics.present) {
        const in_flow rocket = {&A, c, s, mass.c, w};
        real_wrench wrench = wrench_of_lanes(lanes, t, r, &here, &rocket);
        force = real3_add(force, wrench.f);
        moment = real3_add(moment, wrench.m);
    }
    if (first->rocket->air_brakes.present)
        force.x = force.x + brakes(lanes, t, r, &A, &here);
    // Newton and Euler
    real3 alpha, a = real3_scale(1.0 / mass.mass, force);
    if (symmetric) {
        real Jx = mass.J.a[0][0], Jt = mass.J.a[1][1];
        alpha = (real3){moment.x / Jx, (moment.y - (Jx - Jt) * w.x * w.z) / Jt,
                        (moment.z - (Jt - Jx) * w.x * w.y) / Jt};
    } else {
        real33 J_inverse = real33_symmetric_inverse(&mass.J);
        moment = real3_sub(moment, real3_cross(w, real33_apply(&mass.J, w)));
        alpha = real33_apply(&J_inverse, moment);
    }
    a = real3_add(a, real3_cross(w, mass.c_dot));
    real3 r_dot = real3_add(v, real33_apply(&A, roll(c, s, mass.c_dot)));
    alpha = roll(c, s, alpha);
    real3 gravity = {real_all(0), -OF(earth.gravity), real_all(0)};
    if (!first->earth.flat)
        gravity = earth_gravitation(OF(earth.gm), OF(earth.j2), OF(earth.a), r);
    real3_store(y_dot + FLIGHT_R, r_dot);
    real3_store(y_dot + FLIGHT_V, real3_add(gravity, real33_apply(&A, roll(c, s, a))));
    // q_dot = 1/2 q (0, 0, w_y, w_z)
    y_dot[FLIGHT_Q] = 0.5 * (-q[2] * w_N.y - q[3] * w_N.z);
    y_dot[FLIGHT_Q + 1] = 0.5 * (q[2] * w_N.z - q[3] * w_N.y);
    y_dot[FLIGHT_Q + 2] = 0.5 * (q[0] * w_N.y - q[1] * w_N.z);
    y_dot[FLIGHT_Q + 3] = 0.5 * (q[0] * w_N.z + q[1] * w_N.y);
    y_dot[FLIGHT_ROLL] = w_N.x;
    real3_store(y_dot + FLIGHT_W,
                (real3){alpha.x, alpha.y - w_N.x * w_N.z, alpha.z + w_N.x * w_N.y});
    if (!first->parachutes)
        return;
    real_condition hangs = OF(parachute.open) != 0.0;
    if (real_any(hangs))
        hang_rates(hangs, fall_below(lanes, t, &here, mass.mass, gravity), y, y_dot);
}

LD_INLINE void flight_rates_of(const flight_lanes *lanes, const double *t, const double *y,
                               double *y_dot)
{
    if (lanes->system[0]->symmetric)
        rates(lanes, *(const real *)t, (const real *)y, (real *)y_dot, true);
    else
        rates(lanes, *(const real *)t, (const real *)y, (real *)y_dot, false);
}

// ---- watching

// Square of the velocity against the air, and half its rate, in air that goes with the Earth.
typedef struct pace {
    real square, rate;
} pace;

LD_INLINE pace pace_of(real rotation, const real *y, const real *y_dot)
{
    real3 v = real3_from(y + FLIGHT_V), a = real3_from(y_dot + FLIGHT_V);
    real3 v_rel = {v.x + rotation * y[FLIGHT_R + 1], v.y - rotation * y[FLIGHT_R], v.z};
    real3 a_rel = {a.x + rotation * v.y, a.y - rotation * v.x, a.z};
    return (pace){v_rel.x * v_rel.x + v_rel.y * v_rel.y + v_rel.z * v_rel.z,
                  v_rel.x * a_rel.x + v_rel.y * a_rel.y + v_rel.z * a_rel.z};
}

// Whether a flight is getting faster, in a wind that does not change.
LD_INLINE real_condition speeds_up(real rotation, const real *y, const real *y_dot)
{
    return pace_of(rotation, y, y_dot).rate > 0.0;
}

// Whether the dynamic pressure grows at the beginning of a step and falls at its end, the density
// changing evenly between them, where it may be the greatest so far.
LD_INLINE real_condition pressure_turns(real rotation, const flight_step *step, real before,
                                        real density, real pressure)
{
    real size = 2.0 * (*(const real *)step->t - *(const real *)step->t0), more = density - before;
    pace first = pace_of(rotation, (const real *)step->y0, (const real *)step->y0_dot);
    pace last = pace_of(rotation, (const real *)step->y, (const real *)step->y_dot);
    real_condition grows = size * before * first.rate + more * first.square > 0.0;
    real_condition falls = size * density * last.rate + more * last.square < 0.0;
    return grows & falls & (2.0 * pressure > *REALS(step->extremes, flight_extremes, pressure));
}

// How fast a flight rises; on a round Earth against the sphere, within 0.004 of its speed.
LD_INLINE real rise_of(bool flat, const real *y, const real *y_dot, real *margin)
{
    real3 r = real3_from(y + FLIGHT_R), r_dot = real3_from(y_dot + FLIGHT_R);
    *margin = real_all(0);
    if (flat)
        return r_dot.y;
    *margin = 0.004 * real3_norm(r_dot);
    return (r.x * r_dot.x + r.y * r_dot.y + r.z * r_dot.z) / real3_norm(r);
}

// Whether the highest point may lie in the step, or its end, at the height given, is low enough for
// the ground or a parachute's trigger.
LD_INLINE real_condition turns_or_lands(const flight_lanes *lanes, const flight_step *step,
                                        real altitude)
{
    bool flat = lanes->system[0]->earth.flat;
    const real *y = (const real *)step->y;
    real margin0, margin;
    real rise0 = rise_of(flat, (const real *)step->y0, (const real *)step->y0_dot, &margin0);
    real rise = rise_of(flat, y, (const real *)step->y_dot, &margin);
    real height = altitude - 1e-3;
    if (flat)
        height = y[FLIGHT_R + 1];
    // what rises at both ends passes such a height on its way up
    real_condition rises = (rise0 > margin0) & (rise > margin);
    return ((rise0 > -margin0) & (rise < margin)) |
           ((height <= OF(earth.watched)) & real_not(rises));
}

LD_INLINE unsigned flight_watch_of(const flight_lanes *lanes, const flight_step *step)
{
    const flight_system *first = lanes->system[0];
    const real *y = (const real *)step->y, *q = y + FLIGHT_Q;
    real *most = (real *)step->extremes;
    flow here = flow_at(lanes, *(const real *)step->t, real3_from(y + FLIGHT_R),
                        real3_from(y + FLIGHT_V), y + FLIGHT_XI);
    real speed = real3_norm(here.v), mach = real_all(0);
    if (first->atmosphere.kind != LD_ATMOSPHERE_NONE)
        mach = speed / here.air.speed_of_sound;
    // the Mach number is greatest within the step, or so far at its end
    real rotation = OF(earth.rotation);
    real_condition slows = real_not(speeds_up(rotation, y, (const real *)step->y_dot));
    real_condition within =
        speeds_up(rotation, (const real *)step->y0, (const real *)step->y0_dot) & slows;
    real_condition faster = mach >= *REALS(most, flight_extremes, mach);
    // angle of attack
    real33 A = real33_of_quaternion(q);
    real3 axis = {A.a[0][0], A.a[1][0], A.a[2][0]};
    real along = axis.x * here.v.x + axis.y * here.v.y + axis.z * here.v.z;
    real across = real3_norm(real3_cross(axis, here.v));
    real_condition in_air = here.air.density > 0.0;
    if (first->parachutes)
        in_air &= OF(parachute.open) == 0.0;
    real_condition more = in_air & (speed > 0.0) &
                          (across * *REALS(most, flight_extremes, along) >
                           along * *REALS(most, flight_extremes, across));
    // dynamic pressure, acceleration
    real pressure = 0.5 * here.air.density * speed * speed;
    real_condition denser = pressure > *REALS(most, flight_extremes, pressure);
    real3 a = real3_from((const real *)step->y_dot + FLIGHT_V);
    real square = a.x * a.x + a.y * a.y + a.z * a.z;
    real_condition harder = square > *REALS(most, flight_extremes, acceleration);
    real_condition look = turns_or_lands(lanes, step, here.altitude) | within |
                          pressure_turns(rotation, step, *REALS(most, flight_extremes, density),
                                         here.air.density, pressure);
    if (first->aerodynamics.present)
        look |= (faster & (mach > OF(air.last_mach))) | (in_air & (speed > 10.0) & (along < 0.0));
    real_condition done = *(const real *)step->done > 0.0, keep = done & real_not(look);
#define KEEP(condition, member, value)                                                             \
    *REALS(most, flight_extremes, member) =                                                        \
        real_select(condition, value, *REALS(most, flight_extremes, member))
    KEEP(faster & keep, mach, mach);
    KEEP(more & keep, across, across);
    KEEP(more & keep, along, along);
    KEEP(denser & keep, pressure, pressure);
    KEEP(denser & keep, t_pressure, *(const real *)step->t);
    KEEP(harder & keep, acceleration, square);
    KEEP(harder & keep, t_acceleration, *(const real *)step->t);
    KEEP(keep, density, here.air.density);
#undef KEEP
    return real_lanes(look & done);
}

#endif
