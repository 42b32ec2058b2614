// One flight.
#define LANES 1
#include <string.h>

#include "math/functions.h"
#include "math/vectors/mat3.h"
#include "model/blocks/rocket.h"
#include "systems/flight/canopy.h"
#include "systems/flight/flight_code.h"
#include "systems/flight/line.h"

static flight_lanes lane_of(const flight_system *self, flight_phase *phase)
{
    return (flight_lanes){
        {self}, {phase}, (const double *)&phase->number, (double *)&phase->tables};
}

// Where nothing is kept.
static flight_lanes lane_without_phase(const flight_system *self, flight_tables *tables)
{
    tables->aerodynamics.from = tables->aerodynamics.to = 0;
    tables->air.from = tables->air.to = 0;
    tables->wind.from = tables->wind.to = 0;
    return (flight_lanes){{self}, {NULL}, (const double *)&self->number, (double *)tables};
}

// A line's force at the bridle, besides what else acts on the rocket.
static void pull(const flight_system *self, const flight_phase *phase, double t,
                 const double *state, double *state_dot)
{
    rocket_mass mass = flight_mass(self, phase, t);
    v3 force = line_force(phase->line, t);
    v3 v_dot = v3_axpy(v3_from(state_dot + FLIGHT_V), 1 / mass.m, force);
    v3_store(state_dot + FLIGHT_V, v_dot);
    if (phase->hangs) // a point
        return;
    m3 A_NB = m3_rotation_x(state[FLIGHT_ROLL]);
    m3 A_CB = m3_mul(q_matrix(q_from(state + FLIGHT_Q)), A_NB);
    v3 arm = v3_sub(v3_from(self->rocket->line.bridle), mass.c);
    v3 moment = v3_cross(arm, m3_apply_transposed(A_CB, force));
    v3 alpha = m3_apply(A_NB, m3_apply(m3_symmetric_inverse(mass.J), moment));
    v3_store(state_dot + FLIGHT_W, v3_add(v3_from(state_dot + FLIGHT_W), alpha));
}

void flight_rates(const flight_system *self, flight_phase *phase, double t, const double *state,
                  double *state_dot)
{
    const flight_lanes one = lane_of(self, phase);
    if (phase->filling.power > 0)
        phase->number.parachute.area = flight_drag_area(phase, t, state);
    flight_rates_of(&one, &t, state, state_dot);
    if (phase->hangs && self->own_filling) {
        memset(state_dot + FLIGHT_CANOPY_S, 0, (FLIGHT_WAY - FLIGHT_CANOPY_S) * sizeof *state_dot);
        state_dot[FLIGHT_WAY] = phase->filling.by_way ? flight_flow_at(self, t, state).airspeed : 0;
    }
    if (phase->line)
        pull(self, phase, t, state, state_dot);
    if (phase->canopy.given)
        canopy_rates(self, phase, t, state, state_dot);
}

unsigned flight_watch(const flight_system *self, flight_phase *phase, const flight_step *step)
{
    const flight_lanes one = lane_of(self, phase);
    return flight_watch_of(&one, step);
}

bool flight_speeds_up(const flight_system *self, const double *state, const double *state_dot)
{
    return speeds_up(self->number.earth.rotation, state, state_dot);
}

bool flight_pressure_turns(const flight_system *self, const flight_step *step,
                           const double density[2], double pressure)
{
    return pressure_turns(self->number.earth.rotation, step, density[0], density[1], pressure);
}

// Without turbulence.
static v3 wind_here(const flight_system *self, double t, v3 r, double altitude)
{
    flight_tables tables;
    const flight_lanes one = lane_without_phase(self, &tables);
    real3 v = wind_of_lanes(&one, t, (real3){r.x, r.y, r.z}, altitude);
    return (v3){v.x, v.y, v.z};
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
        v = wind_here(self, t, place, altitude);
    if (self->turbulence.present) {
        turbulence_scales scales = turbulence_scales_at(
            &self->turbulence, flight_height_over_ground(self, place, altitude));
        double xi[2] = {-left / scales.L_u, -left / scales.L_w};
        v = v3_add(v, flight_turbulence(self, t, place, altitude, xi, &scales));
    }
    air here = atmosphere_at(&self->atmosphere, altitude);
    return (moving_air){m3_apply_transposed(ground_axes(self, t), v), here.density,
                        here.speed_of_sound};
}

moving_air flight_air_about(const flight_system *self, double t, v3 r)
{
    v3 place = earth_from_ground(&self->earth, t, r, v3_zero()).r;
    moving_air here = flight_steady_air_at(self, t, place);
    here.v = m3_apply_transposed(ground_axes(self, t), here.v);
    return here;
}

v3 flight_turbulence_past(const flight_system *self, double t, v3 r)
{
    if (!self->turbulence.present)
        return v3_zero();
    v3 place = earth_from_ground(&self->earth, t, r, v3_zero()).r;
    double altitude = earth_altitude(&self->earth, place);
    double height = flight_height_over_ground(self, place, altitude);
    // before all gusts
    v3 mean = wind_at(&self->wind, -INFINITY, self->wind.geographic ? altitude : height);
    double way = v3_norm(mean) * t;
    turbulence_scales scales = turbulence_scales_at(&self->turbulence, height);
    double xi[2] = {way / scales.L_u, way / scales.L_w};
    v3 v = flight_turbulence(self, t, place, altitude, xi, &scales);
    return m3_apply_transposed(ground_axes(self, t), v);
}

moving_air flight_steady_air_at(const flight_system *self, double t, v3 r)
{
    double altitude = earth_altitude(&self->earth, r);
    air here = atmosphere_at(&self->atmosphere, altitude);
    return (moving_air){self->wind.present ? wind_here(self, t, r, altitude) : v3_zero(),
                        here.density, here.speed_of_sound};
}

flight_flow flight_flow_at(const flight_system *self, double t, const double *state)
{
    flight_tables tables;
    const flight_lanes one = lane_without_phase(self, &tables);
    flow here = flow_at(&one, t, real3_from(state + FLIGHT_R), real3_from(state + FLIGHT_V),
                        state + FLIGHT_XI);
    v3 r = v3_from(state + FLIGHT_R), v = {here.v.x, here.v.y, here.v.z};
    v3 axis = m3_column(q_matrix(q_from(state + FLIGHT_Q)), 0);
    double along = v3_dot(axis, v), across = v3_norm(v3_cross(axis, v)), speed = v3_norm(v);
    bool has_air = self->atmosphere.kind != LD_ATMOSPHERE_NONE;
    flight_flow out = {.altitude = here.altitude,
                       .density = here.air.density,
                       .airspeed = speed,
                       .pressure = 0.5 * here.air.density * speed * speed,
                       .mach = has_air ? speed / here.air.speed_of_sound : 0,
                       .across = across,
                       .along = along,
                       .angle_of_attack = atan2(across, along)};
    if (self->wind.present) {
        v3 w = {here.wind.x, here.wind.y, here.wind.z};
        turbulence_scales scales;
        if (self->turbulence.present)
            w = v3_add(w, flight_turbulence(self, t, r, here.altitude, state + FLIGHT_XI, &scales));
        out.wind = m3_apply_transposed(ground_axes(self, t), w);
    }
    return out;
}
