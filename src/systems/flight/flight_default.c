// One flight.
#define LANES 1
#include "math/functions.h"
#include "math/vectors/mat3.h"
#include "systems/flight/flight_code.h"

void flight_rates(const flight_system *self, flight_phase *phase, double t, const double *state,
                  double *state_dot)
{
    const flight_lanes one = {{self}, {phase}, (const double *)&phase->number};
    flight_rates_of(&one, &t, state, state_dot);
}

unsigned flight_watch(const flight_system *self, const flight_numbers *number,
                      const flight_step *step)
{
    const flight_lanes one = {{self}, {NULL}, (const double *)number};
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

flight_flow flight_flow_at(const flight_system *self, double t, const double *state)
{
    const flight_lanes one = {{self}, {NULL}, (const double *)&self->number};
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
        v3 w = flight_wind(self, t, r, here.altitude);
        turbulence_scales scales;
        if (self->turbulence.present)
            w = v3_add(w, flight_turbulence(self, t, r, here.altitude, state + FLIGHT_XI, &scales));
        m3 A_CI = m3_mul(earth_turn(&self->earth, t), self->earth.A_EI);
        out.wind = m3_apply_transposed(A_CI, w);
    }
    return out;
}
