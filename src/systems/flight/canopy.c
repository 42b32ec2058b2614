// One flight.
#define LANES 1
#include "systems/flight/canopy.h"

#include "math/functions.h"
#include "math/vectors/mat3.h"
#include "model/blocks/drag_devices.h"
#include "model/blocks/rocket.h"
#include "systems/flight/flight_code.h"

// |d|^2 E - d d^T
static m3 about(v3 d)
{
    double square = v3_dot(d, d);
    return m3_sub(m3_diagonal(square, square, square), m3_outer(d, d));
}

static rocket_mass without(const rocket_mass *whole, double mass, v3 at)
{
    v3 d = v3_sub(at, whole->c);
    double rest = whole->m - mass;
    rocket_mass out = {.m = rest, .c = v3_axpy(whole->c, -mass / rest, d)};
    out.J = m3_sub(whole->J, m3_scale(mass * whole->m / rest, about(d)));
    return out;
}

static m3 attitude(const double *state)
{
    return m3_mul(q_matrix(q_from(state + FLIGHT_Q)), m3_rotation_x(state[FLIGHT_ROLL]));
}

// Velocity in B that an impulse at the point `arm` from the mass centre gives that point:
// (E/m - [arm] J^-1 [arm]) times the impulse.
static m3 mobility(const rocket_mass *rocket, v3 arm)
{
    m3 S = m3_skew(arm);
    m3 turned = m3_mul(S, m3_mul(m3_symmetric_inverse(rocket->J), S));
    return m3_sub(m3_scale(1 / rocket->m, m3_identity()), turned);
}

void canopy_open(const flight_system *self, flight_phase *phase, int i, double t, double *state)
{
    const ld_canopy *given = &self->rocket->parachute[i].canopy;
    rocket_mass whole = flight_mass(self, phase, t);
    v3 at = v3_from(given->at);
    rocket_mass rocket = without(&whole, given->mass, at);
    m3 A_CB = attitude(state), A_NB = m3_rotation_x(state[FLIGHT_ROLL]);
    v3 w = m3_apply_transposed(A_NB, v3_from(state + FLIGHT_W));
    v3 moved = v3_sub(rocket.c, whole.c), arm = v3_sub(at, rocket.c);
    // the impulse that drives the two apart with the velocity given
    m3 K = m3_add(mobility(&rocket, arm), m3_scale(1 / given->mass, m3_identity()));
    v3 impulse = m3_apply(m3_symmetric_inverse(K), v3_from(given->ejection));
    v3 v = v3_axpy(v3_cross(w, moved), -1 / rocket.m, impulse);
    v3 turn = m3_apply(m3_symmetric_inverse(rocket.J), v3_cross(arm, impulse));
    v3 u = v3_axpy(v3_cross(w, arm), 1 / given->mass + 1 / rocket.m, impulse);
    v3_store(state + FLIGHT_R, v3_add(v3_from(state + FLIGHT_R), m3_apply(A_CB, moved)));
    v3_store(state + FLIGHT_V, v3_add(v3_from(state + FLIGHT_V), m3_apply(A_CB, v)));
    v3_store(state + FLIGHT_W, m3_apply(A_NB, v3_sub(w, turn)));
    v3_store(state + FLIGHT_CANOPY_S, m3_apply(A_CB, arm));
    v3_store(state + FLIGHT_CANOPY_U, m3_apply(A_CB, u));
    double reduced = given->mass * rocket.m / whole.m;
    phase->canopy = (flight_canopy){
        .given = given,
        .full = self->rocket->parachute[i].drag_area,
        .stiffness = given->line_stiffness / given->line_length,
        .rocket = rocket,
    };
    phase->canopy.damping = 2 * given->damping * sqrt(phase->canopy.stiffness * reduced);
    flight_set_piece(self, phase, (int)self->motor.corner_count - 1); // the motor is out
}

void canopy_switch(flight_phase *phase, bool taut)
{
    phase->canopy.taut = taut;
}

canopy_lines canopy_lines_at(const flight_phase *phase, const double *state)
{
    const flight_canopy *canopy = &phase->canopy;
    v3 arm = v3_sub(v3_from(canopy->given->at), canopy->rocket.c);
    m3 A_CN = q_matrix(q_from(state + FLIGHT_Q));
    v3 p = m3_apply(A_CN, m3_apply(m3_rotation_x(state[FLIGHT_ROLL]), arm));
    v3 w = m3_apply(A_CN, v3_from(state + FLIGHT_W));
    v3 reach = v3_sub(v3_from(state + FLIGHT_CANOPY_S), p);
    double length = v3_norm(reach);
    canopy_lines out = {.p = p, .stretch = length - canopy->given->line_length};
    if (length > 0)
        out.e = v3_scale(1 / length, reach);
    double rate = v3_dot(out.e, v3_sub(v3_from(state + FLIGHT_CANOPY_U), v3_cross(w, p)));
    out.tension = canopy->stiffness * out.stretch + canopy->damping * rate;
    return out;
}

double canopy_force(const flight_phase *phase, const double *state)
{
    return phase->canopy.taut ? canopy_lines_at(phase, state).tension : 0;
}

void canopy_volume(const flight_phase *phase, double t, const double *state, double airspeed,
                   double *volume, double *rate)
{
    double share = flight_drag_area(phase, t, state) / phase->canopy.full;
    double most = phase->canopy.given->air_volume;
    *volume = most * share * sqrt(share);
    *rate = 1.5 * most * sqrt(share) * flight_drag_area_rate(phase, t, state, airspeed) /
            phase->canopy.full;
}

v3 canopy_place(const double *state)
{
    return v3_add(v3_from(state + FLIGHT_R), v3_from(state + FLIGHT_CANOPY_S));
}

// ---- rates

// Of the air at the canopy.
typedef struct canopy_air {
    v3 force;              // [N] on it
    double mass, airspeed; // [kg] that moves with it, [m/s]
} canopy_air;

static canopy_air air_at_canopy(const flight_lanes *one, double t, const double *state)
{
    const flight_phase *phase = one->phase[0];
    v3 r = canopy_place(state);
    v3 v = v3_add(v3_from(state + FLIGHT_V), v3_from(state + FLIGHT_CANOPY_U));
    flow here = flow_at(one, t, (real3){r.x, r.y, r.z}, (real3){v.x, v.y, v.z}, state + FLIGHT_XI);
    v3 through = {here.v.x, here.v.y, here.v.z};
    double volume, rate, turn = one->system[0]->number.earth.rotation;
    canopy_air out = {.airspeed = v3_norm(through)};
    canopy_volume(phase, t, state, out.airspeed, &volume, &rate);
    out.mass = here.air.density * volume;
    double area = 0.5 * flight_drag_area(phase, t, state) * out.airspeed;
    // the air around carries that in it, which turns with the Earth
    v3 carried = v3_make(-turn * turn * r.x, -turn * turn * r.y, 0);
    out.force = v3_axpy(v3_scale(-here.air.density * (area + rate), through), out.mass, carried);
    return out;
}

// The force of the lines on the rocket.
static v3 pull(const flight_canopy *canopy, const canopy_lines *lines, const double *state,
               double *state_dot)
{
    v3 force = v3_scale(canopy->taut ? lines->tension : 0, lines->e);
    v3 v_dot = v3_axpy(v3_from(state_dot + FLIGHT_V), 1 / canopy->rocket.m, force);
    v3_store(state_dot + FLIGHT_V, v_dot);
    m3 A_NB = m3_rotation_x(state[FLIGHT_ROLL]);
    m3 A_CB = m3_mul(q_matrix(q_from(state + FLIGHT_Q)), A_NB);
    v3 moment = m3_apply_transposed(A_CB, v3_cross(lines->p, force));
    v3 alpha = m3_apply(A_NB, m3_apply(m3_symmetric_inverse(canopy->rocket.J), moment));
    v3_store(state_dot + FLIGHT_W, v3_add(v3_from(state_dot + FLIGHT_W), alpha));
    return force;
}

void canopy_rates(const flight_system *self, flight_phase *phase, double t, const double *state,
                  double *state_dot)
{
    const flight_lanes one = {
        {self}, {phase}, (const double *)&phase->number, (double *)&phase->tables};
    const flight_canopy *canopy = &phase->canopy;
    canopy_lines lines = canopy_lines_at(phase, state);
    v3 force = pull(canopy, &lines, state, state_dot);
    canopy_air around = air_at_canopy(&one, t, state);
    double mass = canopy->given->mass;
    v3 load = v3_sub(around.force, force);
    load = v3_axpy(load, mass, earth_gravity(&self->earth, canopy_place(state)));
    v3_store(state_dot + FLIGHT_CANOPY_S, v3_from(state + FLIGHT_CANOPY_U));
    v3_store(state_dot + FLIGHT_CANOPY_U,
             v3_sub(v3_scale(1 / (mass + around.mass), load), v3_from(state_dot + FLIGHT_V)));
    state_dot[FLIGHT_WAY] = phase->filling.by_way ? around.airspeed : 0;
}
