#include "systems/flight/flight.h"

#include <string.h>

#include "math/functions.h"
#include "model/blocks/drag_devices.h"
#include "model/blocks/flight.h"
#include "model/blocks/motor.h"
#include "model/blocks/rocket.h"
#include "model/parts.h"
#include "model/salvo.h"
#include "systems/flight/line.h"

// ---- what is computed once

static bool is_symmetric_mass(const rocket_mass *mass)
{
    const double(*J)[3] = mass->J.a;
    return mass->c.y == 0 && mass->c.z == 0 && J[1][1] == J[2][2] && J[0][1] == 0 && J[0][2] == 0 &&
           J[1][2] == 0;
}

static bool fills_linearly(const ld_parachute *one)
{
    return !(one->filling_distance > 0) && one->filling_power == 1;
}

// The steps of such a flight are its own.
static bool has_own_filling(const ld_rocket *rocket)
{
    for (int i = 0; i < rocket->parachute_count; i++)
        if (!fills_linearly(&rocket->parachute[i]))
            return true;
    return false;
}

// A canopy leaves the rocket's mass at the point of its lines.
static bool has_canopies_on_axis(const ld_rocket *rocket)
{
    bool on_axis = true;
    for (int i = 0; i < rocket->parachute_count; i++) {
        const ld_canopy *one = &rocket->parachute[i].canopy;
        on_axis &= !one->present || (one->at[1] == 0 && one->at[2] == 0);
    }
    return on_axis;
}

// What goes evenly with the burnt share, from one to the other.
static void set_masses(const rocket_mass *from, const rocket_mass *to, double burnt,
                       flight_numbers *number)
{
    m3 J_change = m3_sub(to->J, from->J);
    number->mass = from->m;
    number->propellant = burnt;
    v3_store(number->c, from->c);
    v3_store(number->c_change, v3_sub(to->c, from->c));
    memcpy(number->J, from->J.a, sizeof number->J);
    memcpy(number->J_change, J_change.a, sizeof number->J_change);
}

// The numbers that no piece of the thrust curve changes.
static flight_numbers numbers_of(const flight_system *self)
{
    const aerodynamics *body = &self->aerodynamics;
    const earth *globe = &self->earth;
    const atmosphere *above = &self->atmosphere;
    bool uniform = above->kind == LD_ATMOSPHERE_UNIFORM;
    double exit_radius = self->rocket->motor.exit_radius;
    flight_numbers number = {
        .exit_square = 0.25 * exit_radius * exit_radius,
        .air = {.density = uniform ? above->density_scale * above->density : 0,
                .speed_of_sound = uniform ? above->speed_of_sound : 1,
                .density_scale = above->density_scale,
                .temperature_offset = above->temperature_offset,
                .drag = body->drag,
                .half_area = body->half_area,
                .diameter = body->diameter,
                .cant = body->cant,
                .crossflow_drag = body->crossflow_drag,
                .crossflow_at = body->crossflow_at,
                .last_mach = body->last_mach},
        .earth = {globe->altitude, globe->gravity, globe->gm, globe->j2, globe->rotation, globe->a,
                  globe->b, globe->e2, self->ground, self->has_ground ? self->ground : -INFINITY},
        .wind = {.scale = self->wind.scale},
    };
    v3_store(number.air.damping, body->damping);
    memcpy(number.air.slope_at, body->surfaces.slope_at, sizeof number.air.slope_at);
    memcpy(number.air.across_at, body->surfaces.across_at, sizeof number.air.across_at);
    memcpy(number.air.across, body->surfaces.across, sizeof number.air.across);
    v3_store(number.wind.steady, self->wind.steady);
    if (self->wind.has_profile) {
        number.wind.first = self->wind.profile.x[0];
        number.wind.last = self->wind.profile.x[self->wind.profile.points - 1];
    }
    memcpy(number.wind.axes, globe->flat ? globe->A_IN.a : globe->A_EI.a, sizeof number.wind.axes);
    v3_store(number.thrust_point, self->thrust_point);
    v3_store(number.thrust_direction, self->thrust_direction);
    set_masses(&self->motor.full, &self->motor.empty, self->motor.propellant, &number);
    return number;
}

ld_status flight_build(flight_system *self, const ld_model *model, int rocket, ld_error *error)
{
    *self = (flight_system){0};
    return flight_renew(self, model, rocket, error);
}

ld_status flight_renew(flight_system *self, const ld_model *model, int rocket, ld_error *error)
{
    atmosphere kept = self->atmosphere;
    self->atmosphere = (atmosphere){0};
    flight_free(self);
    const ld_rocket *flying = salvo_rocket(model, rocket);
    const ld_motor *thrust = &flying->motor;
    const ld_environment *environment = model_environment(model);
    *self = (flight_system){.rocket = flying,
                            .atmosphere = kept,
                            .thrust_point = v3_from(thrust->at),
                            .jet_damping = thrust->jet_damping == LD_JET_DAMPING_YES,
                            .parachutes = flying->parachute_count > 0,
                            .canopies =
                                flying->parachute_count > 0 && flying->parachute[0].canopy.present,
                            .own_filling = has_own_filling(flying),
                            .ground = environment->ground_height,
                            .has_ground = environment->ground == LD_GROUND_PLANE};
    earth_build(&self->earth, model);
    v3 direction = {1, thrust->misalignment[0], thrust->misalignment[1]};
    self->thrust_direction = v3_scale(1 / v3_norm(direction), direction);
    ld_status status = atmosphere_renew(&self->atmosphere, &environment->atmosphere, error);
    if (!status)
        status = wind_build(&self->wind, &environment->wind, error);
    if (!status)
        status = aerodynamics_build(&self->aerodynamics, &flying->aerodynamics, error);
    self->feels_air = self->aerodynamics.present || self->parachutes ||
                      flying->air_brakes.present || model_has_guide_wind(model);
    if (!status && self->wind.present && self->feels_air)
        status = turbulence_build(&self->turbulence, &environment->wind.turbulence, rocket, error);
    self->states = self->turbulence.present ? FLIGHT_STATES : FLIGHT_XI;
    if (!status)
        status = motor_build(&self->motor, flying, rocket, error);
    if (!status)
        motor_without_falling(&self->motor, flying);
    if (status) {
        flight_free(self);
        return status;
    }
    self->symmetric = is_symmetric_mass(&self->motor.full) &&
                      is_symmetric_mass(&self->motor.empty) && direction.y == 0 &&
                      direction.z == 0 && self->thrust_point.y == 0 && self->thrust_point.z == 0 &&
                      !self->motor.across && self->aerodynamics.axisymmetric &&
                      has_canopies_on_axis(flying);
    self->feels_shear = self->aerodynamics.present &&
                        self->aerodynamics.model == LD_AERODYNAMICS_SURFACES &&
                        self->wind.present && self->wind.has_profile;
    self->number = numbers_of(self);
    return LD_OK;
}

void flight_free(flight_system *self)
{
    atmosphere_free(&self->atmosphere);
    wind_free(&self->wind);
    turbulence_free(&self->turbulence);
    aerodynamics_free(&self->aerodynamics);
    motor_free(&self->motor);
}

// Numbers that a phase has of its own.
static void set_numbers(const flight_system *self, flight_phase *phase)
{
    flight_numbers *number = &phase->number;
    *number = self->number;
    number->parachute.open = phase->hangs;
    number->parachute.t0 = phase->hangs_since;
    number->parachute.area = phase->area;
    number->parachute.slope = phase->slope;
    number->earth.watched = fmax(number->earth.watched, phase->lowest_trigger);
    phase->changes++;
}

// Masses by a table are those of the piece alone.
static void set_piece_of_masses(const motor *thrust, flight_phase *phase)
{
    const rocket_mass *from = &thrust->at[phase->piece < 0 ? 0 : phase->piece];
    const rocket_mass *to = phase->burning ? from + 1 : from;
    set_masses(from, to, from->m - to->m, &phase->number);
    phase->number.burn.share = 0;
}

// Below a canopy nothing burns.
static void set_mass_below(flight_phase *phase)
{
    const rocket_mass *rocket = &phase->canopy.rocket;
    set_masses(rocket, rocket, 0, &phase->number);
    phase->number.burn.thrust = phase->number.burn.slope = 0;
    phase->number.burn.share = phase->number.burn.rate = phase->number.burn.power = 0;
}

static void set_piece(const flight_system *self, flight_phase *phase, int piece)
{
    const motor *thrust = &self->motor;
    int corners = (int)thrust->corner_count;
    double total = motor_total_impulse(thrust);
    phase->piece = piece;
    phase->burning = piece >= 0 && piece + 1 < corners;
    set_numbers(self, phase);
    phase->number.burn.power = piece + 1 < corners;
    phase->number.burn.share = piece >= 0 && total > 0 ? thrust->impulse[piece] / total : 0;
    if (thrust->at)
        set_piece_of_masses(thrust, phase);
    if (!phase->burning)
        return;
    double length = thrust->t[piece + 1] - thrust->t[piece];
    phase->number.burn.rate = 1 / total;
    phase->number.burn.t0 = phase->t_ignition + thrust->t[piece];
    phase->number.burn.thrust = thrust->thrust[piece];
    phase->number.burn.slope = (thrust->thrust[piece + 1] - thrust->thrust[piece]) / length;
    if (thrust->at)
        phase->number.burn.rate = 1 / length;
    else
        phase->number.burn.share = thrust->impulse[piece] * phase->number.burn.rate;
}

void flight_set_piece(const flight_system *self, flight_phase *phase, int piece)
{
    set_piece(self, phase, piece);
    if (phase->canopy.given)
        set_mass_below(phase);
}

// From `area` at t on with the slope given, or as `filling` says.
static void hang(const flight_system *self, flight_phase *phase, double t, double area,
                 double slope)
{
    phase->area = area;
    phase->slope = slope;
    phase->hangs_since = t;
    phase->hangs = !phase->canopy.given;
    flight_set_piece(self, phase, phase->piece);
}

void flight_hang(const flight_system *self, flight_phase *phase, double t, double area)
{
    phase->filling = (flight_filling){0};
    hang(self, phase, t, area, 0);
}

double flight_fill(const flight_system *self, flight_phase *phase, double t, double *state, int i)
{
    const ld_parachute *one = &self->rocket->parachute[i];
    bool by_way = one->filling_distance > 0;
    double length = by_way ? one->filling_distance : one->filling;
    double before = flight_drag_area(phase, t, state), more = one->drag_area - before;
    if (length == 0 || more == 0) {
        flight_hang(self, phase, t, one->drag_area);
        return INFINITY;
    }
    phase->filling = (flight_filling){0};
    if (fills_linearly(one)) {
        hang(self, phase, t, before, more / length);
        return t + length;
    }
    if (by_way)
        state[FLIGHT_WAY] = 0;
    phase->filling = (flight_filling){more, 1 / length, one->filling_power, by_way};
    hang(self, phase, t, before, 0);
    return by_way ? INFINITY : t + length;
}

// The share of the time or the way in which it fills.
static double gone(const flight_phase *phase, double t, const double *state)
{
    return phase->filling.per *
           (phase->filling.by_way ? state[FLIGHT_WAY] : t - phase->hangs_since);
}

double flight_drag_area(const flight_phase *phase, double t, const double *state)
{
    const flight_filling *filling = &phase->filling;
    if (filling->power == 0)
        return phase->area + phase->slope * (t - phase->hangs_since);
    return phase->area + filling->more * pow(gone(phase, t, state), filling->power);
}

double flight_drag_area_rate(const flight_phase *phase, double t, const double *state,
                             double airspeed)
{
    const flight_filling *filling = &phase->filling;
    if (filling->power == 0)
        return phase->slope;
    return filling->more * filling->power * filling->per * (filling->by_way ? airspeed : 1) *
           pow(gone(phase, t, state), filling->power - 1);
}

double flight_filled_by_way(const flight_phase *phase, const double *state)
{
    return phase->filling.by_way ? gone(phase, 0, state) : 0;
}

static const ld_table *brakes_table(const ld_air_brakes *brakes)
{
    return brakes->form == LD_BRAKES_OVER_TIME ? &brakes->over_time : &brakes->over_height;
}

double flight_brake_area(const flight_system *self, double since, double height)
{
    const ld_air_brakes *brakes = &self->rocket->air_brakes;
    const ld_table *table = brakes_table(brakes);
    double at = brakes->form == LD_BRAKES_OVER_TIME ? since : height;
    size_t k = 0;
    while (k < table->rows && table->data[2 * k] <= at)
        k++;
    if (k == 0 || k == table->rows)
        return brakes->scale * table->data[2 * (k ? k - 1 : 0) + 1];
    const double *a = &table->data[2 * (k - 1)], *b = a + 2;
    return brakes->scale * (a[1] + (b[1] - a[1]) * (at - a[0]) / (b[0] - a[0]));
}

double flight_next_brake_row(const flight_system *self, double since)
{
    const ld_air_brakes *brakes = &self->rocket->air_brakes;
    for (size_t k = 0; brakes->present && k < brakes->over_time.rows; k++)
        if (brakes->over_time.data[2 * k] > since)
            return brakes->over_time.data[2 * k];
    return INFINITY;
}

rocket_mass flight_mass(const flight_system *self, const flight_phase *phase, double t)
{
    rocket_mass mass;
    if (phase->canopy.given)
        return phase->canopy.rocket;
    motor_mass(&self->motor, phase->piece, t - phase->t_ignition, &mass);
    return mass;
}

double flight_stability_margin(const flight_system *self, const flight_phase *phase, double t,
                               double mach)
{
    const aerodynamics *body = &self->aerodynamics;
    return (flight_mass(self, phase, t).c.x - aerodynamics_center(body, mach).at) / body->diameter;
}

double flight_thrust(const flight_system *self, const flight_phase *phase, double t)
{
    if (phase->hangs || phase->canopy.given)
        return 0;
    return motor_thrust(&self->motor, phase->piece, t - phase->t_ignition);
}

// ---- the air

double flight_height_over_ground(const flight_system *self, v3 r, double altitude)
{
    return (self->earth.flat ? r.y : altitude) - self->ground;
}

v3 flight_turbulence(const flight_system *self, double t, v3 r, double altitude, const double xi[2],
                     turbulence_scales *scales)
{
    const earth *globe = &self->earth;
    *scales = turbulence_scales_at(&self->turbulence, flight_height_over_ground(self, r, altitude));
    v3 v = turbulence_velocity(&self->turbulence, scales, xi[0], xi[1]);
    return globe->flat ? v : m3_apply(earth_turn(globe, t), m3_apply(globe->A_EI, v));
}

static m3 ground_axes(const flight_system *self, double t)
{
    return m3_mul(earth_turn(&self->earth, t), self->earth.A_EI); // A_CI
}

// ---- side by side

bool flight_is_like(const flight_system *self, const flight_system *other)
{
    return self->earth.flat == other->earth.flat &&
           self->atmosphere.kind == other->atmosphere.kind &&
           self->wind.present == other->wind.present &&
           self->wind.geographic == other->wind.geographic &&
           self->wind.has_profile == other->wind.has_profile &&
           !self->wind.gust_count == !other->wind.gust_count &&
           self->turbulence.present == other->turbulence.present &&
           self->aerodynamics.present == other->aerodynamics.present &&
           self->parachutes == other->parachutes &&
           self->rocket->air_brakes.present == other->rocket->air_brakes.present &&
           self->aerodynamics.model == other->aerodynamics.model &&
           self->aerodynamics.surfaces.slopes == other->aerodynamics.surfaces.slopes &&
           self->aerodynamics.surfaces.acrosses == other->aerodynamics.surfaces.acrosses &&
           !self->motor.at == !other->motor.at && !self->motor.across == !other->motor.across &&
           self->feels_shear == other->feels_shear && self->jet_damping == other->jet_damping &&
           self->symmetric == other->symmetric;
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

line_bridle flight_point(const flight_system *self, const flight_phase *phase, double t,
                         const double *state, const double *state_dot, v3 r)
{
    rocket_mass mass = flight_mass(self, phase, t);
    v3 w_N = v3_from(state + FLIGHT_W), turning = v3_cross(v3_make(w_N.x, 0, 0), w_N);
    m3 A_CN = q_matrix(q_from(state + FLIGHT_Q));
    v3 arm = m3_apply(m3_mul(A_CN, m3_rotation_x(state[FLIGHT_ROLL])), v3_sub(r, mass.c));
    v3 w = m3_apply(A_CN, w_N);
    v3 alpha = m3_apply(A_CN, v3_sub(v3_from(state_dot + FLIGHT_W), turning));
    v3 spun = v3_cross(w, arm);
    return (line_bridle){
        v3_add(v3_from(state + FLIGHT_R), arm),
        v3_add(v3_from(state + FLIGHT_V), spun),
        v3_add(v3_from(state_dot + FLIGHT_V), v3_add(v3_cross(alpha, arm), v3_cross(w, spun))),
    };
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
    if (phase->burning && !phase->hangs && !phase->canopy.given) {
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
