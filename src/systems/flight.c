#include "systems/flight.h"

#include <string.h>

#include "model/salvo.h"

// ---- what is computed once

static bool is_symmetric_mass(const rocket_mass *mass)
{
    const double(*J)[3] = mass->J.a;
    return mass->c.y == 0 && mass->c.z == 0 && J[1][1] == J[2][2] && J[0][1] == 0 && J[0][2] == 0 &&
           J[1][2] == 0;
}

ld_status flight_build(flight_system *self, const ld_model *model, int rocket, ld_error *error)
{
    const ld_rocket *flying = salvo_rocket(model, rocket);
    const ld_motor *thrust = &flying->motor;
    *self = (flight_system){.rocket = flying,
                            .thrust_point = v3_from(thrust->at),
                            .ground = model->environment.ground_height,
                            .has_ground = model->environment.ground == LD_GROUND_PLANE};
    earth_build(&self->earth, model);
    atmosphere_build(&self->atmosphere, &model->environment.atmosphere);
    v3 direction = {1, thrust->misalignment[0], thrust->misalignment[1]};
    self->thrust_direction = v3_scale(1 / v3_norm(direction), direction);
    ld_status status = wind_build(&self->wind, &model->environment.wind, error);
    if (!status)
        status = aerodynamics_build(&self->aerodynamics, &flying->aerodynamics, error);
    if (!status && self->wind.present && self->aerodynamics.present)
        status =
            turbulence_build(&self->turbulence, &model->environment.wind.turbulence, rocket, error);
    self->states = self->turbulence.present ? FLIGHT_STATES : FLIGHT_XI;
    if (!status)
        status = motor_build(&self->motor, flying, error);
    if (status) {
        flight_free(self);
        return status;
    }
    self->c_change = v3_sub(self->motor.empty.c, self->motor.full.c);
    self->J_change = m3_sub(self->motor.empty.J, self->motor.full.J);
    self->symmetric = is_symmetric_mass(&self->motor.full) &&
                      is_symmetric_mass(&self->motor.empty) && direction.y == 0 &&
                      direction.z == 0 && self->thrust_point.y == 0 && self->thrust_point.z == 0 &&
                      self->aerodynamics.axisymmetric;
    return LD_OK;
}

void flight_free(flight_system *self)
{
    wind_free(&self->wind);
    turbulence_free(&self->turbulence);
    aerodynamics_free(&self->aerodynamics);
    motor_free(&self->motor);
}

// Inverse of a symmetric matrix by its adjugate.
LD_INLINE m3 inverse(const m3 *J)
{
    const double(*a)[3] = J->a;
    double c00 = a[1][1] * a[2][2] - a[1][2] * a[1][2], c01 = a[0][2] * a[1][2] - a[0][1] * a[2][2];
    double c02 = a[0][1] * a[1][2] - a[0][2] * a[1][1];
    double s = 1 / (a[0][0] * c00 + a[0][1] * c01 + a[0][2] * c02);
    double d01 = s * c01, d02 = s * c02, d12 = s * (a[0][1] * a[0][2] - a[0][0] * a[1][2]);
    return (m3){{{s * c00, d01, d02},
                 {d01, s * (a[0][0] * a[2][2] - a[0][2] * a[0][2]), d12},
                 {d02, d12, s * (a[0][0] * a[1][1] - a[0][1] * a[0][1])}}};
}

void flight_set_piece(const flight_system *self, flight_phase *phase, int piece)
{
    int corners = (int)self->motor.corner_count;
    phase->piece = piece;
    phase->burning = piece >= 0 && piece + 1 < corners;
    phase->power = piece + 1 < corners;
    motor_mass(&self->motor, piece, piece < 0 ? 0 : self->motor.t[piece], &phase->mass);
    phase->J_inverse = inverse(&phase->mass.J);
    if (!phase->burning)
        return;
    const motor *thrust = &self->motor;
    double length = thrust->t[piece + 1] - thrust->t[piece];
    phase->burn.rate = 1 / motor_total_impulse(thrust);
    phase->burn.t0 = phase->t_ignition + thrust->t[piece];
    phase->burn.thrust = thrust->thrust[piece];
    phase->burn.slope = (thrust->thrust[piece + 1] - thrust->thrust[piece]) / length;
    phase->burn.share = thrust->impulse[piece] * phase->burn.rate;
}

// Thrust and mass data while it burns, as motor_thrust and motor_mass have them; of a symmetric
// rocket only the two moments of inertia.
LD_INLINE double burn_at(const flight_system *self, const flight_phase *phase, double t,
                         bool symmetric, rocket_mass *mass)
{
    const rocket_mass *full = &self->motor.full;
    double since = t - phase->burn.t0, thrust = phase->burn.thrust + phase->burn.slope * since;
    double burnt = 0.5 * (phase->burn.thrust + thrust) * since;
    double share = phase->burn.share + phase->burn.rate * burnt;
    mass->m = full->m - share * self->motor.propellant;
    mass->c = v3_axpy(full->c, share, self->c_change);
    mass->c_dot = v3_scale(phase->burn.rate * thrust, self->c_change);
    if (symmetric) {
        mass->J.a[0][0] = full->J.a[0][0] + share * self->J_change.a[0][0];
        mass->J.a[1][1] = full->J.a[1][1] + share * self->J_change.a[1][1];
    } else {
        mass->J = m3_add(full->J, m3_scale(share, self->J_change));
    }
    return thrust;
}

rocket_mass flight_mass(const flight_system *self, const flight_phase *phase, double t)
{
    rocket_mass mass = phase->mass;
    if (phase->burning)
        motor_mass(&self->motor, phase->piece, t - phase->t_ignition, &mass);
    return mass;
}

double flight_thrust(const flight_system *self, const flight_phase *phase, double t)
{
    return motor_thrust(&self->motor, phase->piece, t - phase->t_ignition);
}

// ---- the air

// Velocity of the air against the ground, in C, at the point r of C.
static v3 wind_velocity(const flight_system *self, double t, v3 r, double altitude)
{
    const wind *moving = &self->wind;
    const earth *globe = &self->earth;
    if (globe->flat) {
        v3 v = wind_at(moving, t, moving->geographic ? altitude : r.y - self->ground);
        return moving->geographic ? m3_apply(globe->A_IN, v) : v;
    }
    m3 A_CE = earth_turn(globe, t);
    if (moving->geographic) {
        v3 r_E = m3_apply_transposed(A_CE, r);
        geodetic place = earth_geodetic(globe, r_E);
        v3 v = wind_at(moving, t, altitude);
        return m3_apply(A_CE, m3_apply(earth_local_axes(place.latitude, place.longitude), v));
    }
    return m3_apply(A_CE, m3_apply(globe->A_EI, wind_at(moving, t, altitude - self->ground)));
}

// Height of the point r of C over the ground, as turbulence counts it.
static double height_over_ground(const flight_system *self, v3 r, double altitude)
{
    return (self->earth.flat ? r.y : altitude) - self->ground;
}

// Velocity of the air by turbulence, in C, and its scales at the point r of C.
static v3 turbulence_at(const flight_system *self, double t, v3 r, double altitude,
                        const double xi[2], turbulence_scales *scales)
{
    const earth *globe = &self->earth;
    *scales = turbulence_scales_at(&self->turbulence, height_over_ground(self, r, altitude));
    v3 v = turbulence_velocity(&self->turbulence, scales, xi[0], xi[1]);
    return globe->flat ? v : m3_apply(earth_turn(globe, t), m3_apply(globe->A_EI, v));
}

// The air at a point of C that moves with v: density, speed of sound, velocity through it, in C.
typedef struct flow {
    double altitude;
    air air;
    v3 v;
    double xi_dot[2];
} flow;

LD_INLINE flow flow_at(const flight_system *self, double t, v3 r, v3 v, const double xi[2])
{
    flow out;
    out.altitude = earth_altitude(&self->earth, r);
    out.air = atmosphere_at(&self->atmosphere, out.altitude);
    if (!self->earth.flat)
        v = v3_sub(v, v3_cross(earth_rate(&self->earth), r));
    if (self->wind.present)
        v = v3_sub(v, wind_velocity(self, t, r, out.altitude));
    if (self->turbulence.present) {
        turbulence_scales scales;
        double mean_speed = v3_norm(v);
        v = v3_sub(v, turbulence_at(self, t, r, out.altitude, xi, &scales));
        out.xi_dot[0] = mean_speed / scales.L_u;
        out.xi_dot[1] = mean_speed / scales.L_w;
    }
    out.v = v;
    return out;
}

flight_flow flight_flow_at(const flight_system *self, double t, const double *state)
{
    v3 r = v3_from(state + FLIGHT_R), v = v3_from(state + FLIGHT_V);
    flow here = flow_at(self, t, r, v, state + FLIGHT_XI);
    v3 axis = m3_column(q_matrix(q_from(state + FLIGHT_Q)), 0);
    double along = v3_dot(axis, here.v), speed = v3_norm(here.v);
    bool has_air = self->atmosphere.kind != LD_ATMOSPHERE_NONE;
    flight_flow out = {.altitude = here.altitude,
                       .density = here.air.density,
                       .airspeed = speed,
                       .mach = has_air ? speed / here.air.speed_of_sound : 0,
                       .angle_of_attack = atan2(v3_norm(v3_cross(axis, here.v)), along)};
    if (self->wind.present) {
        v3 w = wind_velocity(self, t, r, here.altitude);
        turbulence_scales scales;
        if (self->turbulence.present)
            w = v3_add(w, turbulence_at(self, t, r, here.altitude, state + FLIGHT_XI, &scales));
        m3 A_CI = m3_mul(earth_turn(&self->earth, t), self->earth.A_EI);
        out.wind = m3_apply_transposed(A_CI, w);
    }
    return out;
}

static m3 ground_axes(const flight_system *self, double t)
{
    return m3_mul(earth_turn(&self->earth, t), self->earth.A_EI); // A_CI
}

moving_air flight_air_at(const flight_system *self, double t, v3 r, double left)
{
    v3 v = v3_zero(), place = earth_from_ground(&self->earth, t, r, v3_zero()).r;
    double altitude = earth_altitude(&self->earth, place);
    if (self->wind.present)
        v = wind_velocity(self, t, place, altitude);
    if (self->turbulence.present) {
        turbulence_scales scales =
            turbulence_scales_at(&self->turbulence, height_over_ground(self, place, altitude));
        double xi[2] = {-left / scales.L_u, -left / scales.L_w};
        v = v3_add(v, turbulence_at(self, t, place, altitude, xi, &scales));
    }
    air here = atmosphere_at(&self->atmosphere, altitude);
    return (moving_air){m3_apply_transposed(ground_axes(self, t), v), here.density,
                        here.speed_of_sound};
}

// ---- the equations of motion

// Rotation about x by an angle of which cosine and sine are given, and back.
LD_INLINE v3 roll(double c, double s, v3 a)
{
    return v3_make(a.x, c * a.y - s * a.z, s * a.y + c * a.z);
}

LD_INLINE void rates(const flight_system *self, flight_phase *phase, double t, const double *y,
                     double *y_dot, bool symmetric)
{
    v3 r = v3_from(y + FLIGHT_R), v = v3_from(y + FLIGHT_V), w_N = v3_from(y + FLIGHT_W);
    quat q = q_from(y + FLIGHT_Q);
    m3 A = q_matrix(q);
    // roll between N and B; of a symmetric rocket every such pair of axes is as good as B's
    double c = 1, s = 0;
    if (!symmetric) {
        c = cos(y[FLIGHT_ROLL]);
        s = sin(y[FLIGHT_ROLL]);
    }
    v3 w = roll(c, -s, w_N);
    // mass and thrust
    double thrust = 0;
    rocket_mass burning;
    const rocket_mass *mass = &phase->mass;
    if (phase->burning) {
        thrust = burn_at(self, phase, t, symmetric, &burning);
        mass = &burning;
    }
    v3 force = v3_scale(thrust, self->thrust_direction);
    v3 moment = v3_cross(v3_sub(self->thrust_point, mass->c), force);
    // air
    if (self->aerodynamics.present) {
        flow here = flow_at(self, t, r, v, y + FLIGHT_XI);
        if (self->turbulence.present)
            memcpy(y_dot + FLIGHT_XI, here.xi_dot, sizeof here.xi_dot);
        double speed = v3_norm(here.v), mach = speed / here.air.speed_of_sound;
        v3 v_B = roll(c, -s, m3_apply_transposed(A, here.v));
        air_wrench wrench =
            aerodynamics_wrench(&self->aerodynamics, v_B, speed, w, mass->c, here.air.density, mach,
                                phase->power, &phase->interval);
        force = v3_add(force, wrench.f);
        moment = v3_add(moment, wrench.m);
    }
    // Newton and Euler
    v3 alpha, a = v3_scale(1 / mass->m, force);
    if (symmetric) {
        double Jx = mass->J.a[0][0], Jt = mass->J.a[1][1];
        alpha = v3_make(moment.x / Jx, (moment.y - (Jx - Jt) * w.x * w.z) / Jt,
                        (moment.z - (Jt - Jx) * w.x * w.y) / Jt);
    } else {
        m3 J_inverse = phase->burning ? inverse(&mass->J) : phase->J_inverse;
        moment = v3_sub(moment, v3_cross(w, m3_apply(mass->J, w)));
        alpha = m3_apply(J_inverse, moment);
    }
    v3 r_dot = v;
    if (phase->burning) {
        a = v3_add(a, v3_cross(w, mass->c_dot));
        r_dot = v3_add(r_dot, m3_apply(A, roll(c, s, mass->c_dot)));
    }
    alpha = roll(c, s, alpha);
    v3_store(y_dot + FLIGHT_R, r_dot);
    v3_store(y_dot + FLIGHT_V, v3_add(earth_gravity(&self->earth, r), m3_apply(A, roll(c, s, a))));
    quat q_dot = q_rate(q, v3_make(0, w_N.y, w_N.z));
    memcpy(y_dot + FLIGHT_Q, &q_dot, sizeof q_dot);
    y_dot[FLIGHT_ROLL] = w_N.x;
    v3_store(y_dot + FLIGHT_W, v3_make(alpha.x, alpha.y - w_N.x * w_N.z, alpha.z + w_N.x * w_N.y));
}

void flight_rates(const flight_system *self, flight_phase *phase, double t, const double *state,
                  double *state_dot)
{
    if (self->symmetric)
        rates(self, phase, t, state, state_dot, true);
    else
        rates(self, phase, t, state, state_dot, false);
}

// ---- in and out

void flight_enter(const flight_system *self, const flight_phase *phase, double t,
                  const flight_pose *pose, double *state)
{
    rocket_mass mass = flight_mass(self, phase, t);
    m3 A_CB = m3_mul(ground_axes(self, t), q_matrix(pose->q_IB));
    earth_motion O1 = earth_from_ground(&self->earth, t, pose->r_O1, pose->v_O1);
    v3_store(state + FLIGHT_R, v3_add(O1.r, m3_apply(A_CB, mass.c)));
    v3_store(state + FLIGHT_V, v3_add(O1.v, m3_apply(A_CB, v3_cross(pose->w, mass.c))));
    quat q = q_from_matrix(A_CB);
    memcpy(state + FLIGHT_Q, &q, sizeof q);
    state[FLIGHT_ROLL] = 0;
    v3_store(state + FLIGHT_W, pose->w);
    state[FLIGHT_XI] = state[FLIGHT_XI + 1] = 0;
}

void flight_leave(const flight_system *self, const flight_phase *phase, double t,
                  const double *state, flight_pose *pose)
{
    rocket_mass mass = flight_mass(self, phase, t);
    m3 A_CB = m3_mul(q_matrix(q_from(state + FLIGHT_Q)), m3_rotation_x(state[FLIGHT_ROLL]));
    pose->w = m3_apply_transposed(m3_rotation_x(state[FLIGHT_ROLL]), v3_from(state + FLIGHT_W));
    v3 r = v3_sub(v3_from(state + FLIGHT_R), m3_apply(A_CB, mass.c));
    v3 v = v3_sub(v3_from(state + FLIGHT_V), m3_apply(A_CB, v3_cross(pose->w, mass.c)));
    earth_motion O1 = earth_to_ground(&self->earth, t, r, v);
    pose->r_O1 = O1.r;
    pose->v_O1 = O1.v;
    pose->q_IB = q_from_matrix(m3_mul(m3_transpose(ground_axes(self, t)), A_CB));
}

earth_motion flight_center(const flight_system *self, double t, const double *state)
{
    return earth_to_ground(&self->earth, t, v3_from(state + FLIGHT_R), v3_from(state + FLIGHT_V));
}

flight_place flight_place_at(const flight_system *self, double t, const double *state, m3 A_IB)
{
    v3 r_E = m3_apply_transposed(earth_turn(&self->earth, t), v3_from(state + FLIGHT_R));
    flight_place place = {.geodetic = earth_geodetic(&self->earth, r_E)};
    // A_NI: I in the axes north, up, east there
    m3 A_EN = earth_local_axes(place.geodetic.latitude, place.geodetic.longitude);
    m3 A_NI = m3_mul(m3_transpose(A_EN), self->earth.A_EI);
    v3 v = m3_apply(A_NI, flight_center(self, t, state).v);
    place.velocity_ned = v3_make(v.x, v.z, -v.y);
    m3 A = m3_mul(A_NI, A_IB);
    place.heading = atan2(A.a[2][0], A.a[0][0]);
    place.pitch = atan2(A.a[1][0], hypot(A.a[0][0], A.a[2][0]));
    place.roll = atan2(-A.a[1][2], A.a[1][1]);
    return place;
}

double flight_height(const flight_system *self, const double *state)
{
    v3 up;
    return earth_height(&self->earth, v3_from(state + FLIGHT_R), &up);
}

double flight_height_rate(const flight_system *self, const flight_phase *phase, double t,
                          const double *state)
{
    v3 up, v = v3_from(state + FLIGHT_V);
    if (phase->burning) {
        v3 c_dot = m3_apply(m3_rotation_x(state[FLIGHT_ROLL]), flight_mass(self, phase, t).c_dot);
        v = v3_add(v, m3_apply(q_matrix(q_from(state + FLIGHT_Q)), c_dot));
    }
    // the Earth's turn moves nothing up or down: v need not be against the ground
    earth_height(&self->earth, v3_from(state + FLIGHT_R), &up);
    return v3_dot(up, v);
}

// Attitude of a flight alone, in I, where the axes north, up, east are those of A_IN.
static m3 start_attitude(const ld_flight *start, m3 A_IN)
{
    if (!isnan(start->quaternion[0]))
        return q_matrix(q_from(start->quaternion));
    m3 tilt = m3_mul(m3_rotation_z(start->pitch), m3_rotation_x(start->roll));
    if (start->attitude == LD_ATTITUDE_HEADING)
        return m3_mul(A_IN, m3_mul(m3_rotation_y(-start->heading), tilt));
    return m3_mul(m3_rotation_y(start->yaw), tilt);
}

void flight_start(const flight_system *self, const flight_phase *phase, const ld_flight *start,
                  double *state)
{
    const earth *globe = &self->earth;
    const geodetic given = {start->geodetic.latitude, start->geodetic.longitude,
                            start->geodetic.altitude};
    // at t = 0 the axes C are those of E; point given, and the axes north, up, east there, in I
    v3 point = v3_from(start->position);
    m3 A_IN = globe->A_IN;
    if (!globe->flat) {
        if (start->geodetic.present)
            point =
                m3_apply_transposed(globe->A_EI, v3_sub(earth_place(globe, given), globe->r_site));
        geodetic place =
            start->geodetic.present
                ? given
                : earth_geodetic(globe, earth_from_ground(globe, 0, point, v3_zero()).r);
        A_IN = m3_mul(m3_transpose(globe->A_EI), earth_local_axes(place.latitude, place.longitude));
    }
    m3 A_IB = start_attitude(start, A_IN);
    v3 velocity = v3_from(start->velocity);
    if (!isnan(start->speed))
        velocity = v3_scale(start->speed, m3_column(A_IB, 0));
    if (!isnan(start->velocity_ned[0]))
        velocity = m3_apply(
            A_IN, v3_make(start->velocity_ned[0], -start->velocity_ned[2], start->velocity_ned[1]));
    m3 A_CB = m3_mul(globe->A_EI, A_IB);
    v3 w = v3_from(start->rate);
    if (start->rate_against == LD_AGAINST_EARTH)
        w = v3_add(w, m3_apply_transposed(A_CB, earth_rate(globe)));
    const flight_pose pose = {point, velocity, q_from_matrix(A_IB), w};
    flight_enter(self, phase, 0, &pose, state);
    if (start->point == LD_POINT_CENTER) {
        earth_motion center = earth_from_ground(globe, 0, point, velocity);
        v3_store(state + FLIGHT_R, center.r);
        v3_store(state + FLIGHT_V, center.v);
    }
}
