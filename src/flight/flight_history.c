// The history of a free flight: what is found at an instant, and the quantities that stand in it.
#include "flight/flight_history.h"

#include <math.h>

#include "model/blocks/rocket.h"
#include "state/exit_figures.h"
#include "systems/flight/canopy.h"
#include "systems/flight/line.h"

typedef struct flight_instant {
    double t;
    flight_pose pose;
    direction_angles angles;
    earth_motion center;
    double mass, thrust;
    flight_flow flow;
    double acceleration, margin, drag_area;
    v3 w_dot, force;    // against inertial axes, in B; force: specific, at O1
    flight_place place; // on a round or WGS 84 Earth
    double lines_force;
    earth_motion canopy;
    double tension, paid_out; // of the line
    struct {
        double x, y, z;
    } line[LD_LINE_PLACES];
} flight_instant;

#define AT(member) .at = QUANTITY_AT(flight_instant, member)

// clang-format off
static const quantity flight[] = {
    {"t", "s", "time on the run's clock", AT(t)},
    {"rocket.x", "m", "rear adaptor's centre, in I", AT(pose.r_O1.x)},
    {"rocket.y", "m", "rear adaptor's centre, in I", AT(pose.r_O1.y)},
    {"rocket.z", "m", "rear adaptor's centre, in I", AT(pose.r_O1.z)},
    {"rocket.vx", "m/s", "velocity of the rear adaptor against the ground, in I", AT(pose.v_O1.x)},
    {"rocket.vy", "m/s", "velocity of the rear adaptor against the ground, in I", AT(pose.v_O1.y)},
    {"rocket.vz", "m/s", "velocity of the rear adaptor against the ground, in I", AT(pose.v_O1.z)},
    {"rocket.q0", "1", "quaternion of the rocket against I, scalar part first", AT(pose.q_IB.w)},
    {"rocket.q1", "1", "quaternion of the rocket against I, scalar part first", AT(pose.q_IB.x)},
    {"rocket.q2", "1", "quaternion of the rocket against I, scalar part first", AT(pose.q_IB.y)},
    {"rocket.q3", "1", "quaternion of the rocket against I, scalar part first", AT(pose.q_IB.z)},
    {"rocket.wx", "rad/s", "rate of the rocket against inertial axes, in B", AT(pose.w.x)},
    {"rocket.wy", "rad/s", "rate of the rocket against inertial axes, in B", AT(pose.w.y)},
    {"rocket.wz", "rad/s", "rate of the rocket against inertial axes, in B", AT(pose.w.z)},
    {"rocket.wx_dot", "rad/s2", "rate of rocket.wx", AT(w_dot.x)},
    {"rocket.wy_dot", "rad/s2", "rate of rocket.wy", AT(w_dot.y)},
    {"rocket.wz_dot", "rad/s2", "rate of rocket.wz", AT(w_dot.z)},
    {"rocket.fx", "m/s2", "specific force (acceleration less gravity) at the rear adaptor, in B", AT(force.x)},
    {"rocket.fy", "m/s2", "specific force (acceleration less gravity) at the rear adaptor, in B", AT(force.y)},
    {"rocket.fz", "m/s2", "specific force (acceleration less gravity) at the rear adaptor, in B", AT(force.z)},
    {"rocket.pitch", "rad", "pitch of the rocket's axis in I", AT(angles.pitch)},
    {"rocket.yaw", "rad", "yaw of the rocket's axis in I, positive to the left", AT(angles.yaw)},
    {"rocket.pitch_rate", "rad/s", "rate of rocket.pitch", AT(angles.pitch_rate)},
    {"rocket.yaw_rate", "rad/s", "rate of rocket.yaw", AT(angles.yaw_rate)},
    {"rocket.spin", "rad/s", "rate of the rocket against inertial axes about its axis", AT(pose.w.x)},
    {"center.x", "m", "mass centre, in I", AT(center.r.x)},
    {"center.y", "m", "mass centre, in I", AT(center.r.y)},
    {"center.z", "m", "mass centre, in I", AT(center.r.z)},
    {"center.vx", "m/s", "velocity of the mass centre against the ground, in I", AT(center.v.x)},
    {"center.vy", "m/s", "velocity of the mass centre against the ground, in I", AT(center.v.y)},
    {"center.vz", "m/s", "velocity of the mass centre against the ground, in I", AT(center.v.z)},
    {"rocket.mass", "kg", "instantaneous mass", AT(mass)},
    {"thrust", "N", "thrust", AT(thrust)},
    {"altitude", "m", "altitude of the mass centre", AT(flow.altitude)},
    {"density", "kg/m3", "density of the air there", AT(flow.density)},
    {"airspeed", "m/s", "speed of the mass centre through the air", AT(flow.airspeed)},
    {"mach", "1", "Mach number", AT(flow.mach)},
    {"dynamic_pressure", "Pa", "half the density times the square of the airspeed", AT(flow.pressure)},
    {"acceleration", "m/s2", "magnitude of the mass centre's acceleration against inertial axes", AT(acceleration)},
    {"stability_margin", "1", "mass centre ahead of the centre of pressure, in reference diameters", AT(margin)},
    {"angle_of_attack", "rad", "between the rocket's axis and its velocity through the air", AT(flow.angle_of_attack)},
    {"drag_area", "m2", "of the parachute that the rocket hangs below, 0 before", AT(drag_area)},
    {"wind.x", "m/s", "velocity of the air against the ground, in I", AT(flow.wind.x)},
    {"wind.y", "m/s", "velocity of the air against the ground, in I", AT(flow.wind.y)},
    {"wind.z", "m/s", "velocity of the air against the ground, in I", AT(flow.wind.z)},
};
static const quantity on_earth[] = {
    {"latitude", "rad", "geodetic latitude of the mass centre", AT(place.geodetic.latitude)},
    {"longitude", "rad", "longitude of the mass centre", AT(place.geodetic.longitude)},
    {"v_north", "m/s", "velocity of the mass centre against the ground, to the north", AT(place.velocity_ned.x)},
    {"v_east", "m/s", "velocity of the mass centre against the ground, to the east", AT(place.velocity_ned.y)},
    {"v_down", "m/s", "velocity of the mass centre against the ground, down", AT(place.velocity_ned.z)},
    {"heading", "rad", "of the rocket's axis, clockwise from north", AT(place.heading)},
    {"local_pitch", "rad", "of the rocket's axis above the local horizon", AT(place.pitch)},
    {"local_roll", "rad", "of the rocket, Ry(-heading) Rz(pitch) Rx(roll) against north, up, east", AT(place.roll)},
};
static const quantity descent[] = {
    {"canopy.x", "m", "canopy on its lines, in I", AT(canopy.r.x)},
    {"canopy.y", "m", "canopy on its lines, in I", AT(canopy.r.y)},
    {"canopy.z", "m", "canopy on its lines, in I", AT(canopy.r.z)},
    {"canopy.vx", "m/s", "velocity of the canopy against the ground, in I", AT(canopy.v.x)},
    {"canopy.vy", "m/s", "velocity of the canopy against the ground, in I", AT(canopy.v.y)},
    {"canopy.vz", "m/s", "velocity of the canopy against the ground, in I", AT(canopy.v.z)},
    {"canopy.line_force", "N", "force of its lines on the rocket", AT(lines_force)},
};
static const quantity pulled[] = {
    {"line.tension", "N", "pull of the line on the rocket", AT(tension)},
    {"line.paid_out", "m", "unstretched length that has left the container", AT(paid_out)},
};
#define PLACE(member) .at = QUANTITY_OF_EACH(flight_instant, line, member)
static const quantity line_places[] = {
    {"line.%s.x", "m", "line at equal parts of its length, 1 at the container, 12 at the rocket, in I", PLACE(x)},
    {"line.%s.y", "m", "line at equal parts of its length, 1 at the container, 12 at the rocket, in I", PLACE(y)},
    {"line.%s.z", "m", "line at equal parts of its length, 1 at the container, 12 at the rocket, in I", PLACE(z)},
};

static const quantity_group groups[] = {
    {.title = "flight", QUANTITY_ROWS(flight)},
    {.title = "on a round or WGS 84 Earth", .each = EACH_EARTH, QUANTITY_ROWS(on_earth)},
    {.title = "canopy with a mass of its own", .each = EACH_DESCENT, QUANTITY_ROWS(descent)},
    {.title = "line that the rocket pulls", .each = EACH_LINE, QUANTITY_ROWS(pulled)},
    {.title = "places of the line", .each = EACH_LINE_PLACE, QUANTITY_ROWS(line_places)},
};
// clang-format on

_Static_assert((sizeof flight + sizeof on_earth + sizeof descent + sizeof pulled +
                LD_LINE_PLACES * sizeof line_places) /
                       sizeof *flight <=
                   FLIGHT_MAX_COLUMNS,
               "the rows of flights exceed their buffer");

const quantity_table flight_quantities = {groups, sizeof groups / sizeof *groups};

ld_status flight_columns(const flight_system *system, quantity_columns *columns, ld_error *error)
{
    bool pulls = system->rocket && system->rocket->line.present;
    const quantity_things things = {.count = {[EACH_RUN] = 1,
                                              [EACH_EARTH] = !system->earth.flat,
                                              [EACH_DESCENT] = system->canopies,
                                              [EACH_LINE] = pulls,
                                              [EACH_LINE_PLACE] = pulls ? LD_LINE_PLACES : 0}};
    return quantity_columns_make(columns, &(quantity_part){&flight_quantities, 0}, 1, &things,
                                 error);
}

// Angular acceleration and specific force at O1 = mass centre less c, of whose rate flight.h's
// v = v_O1 + w x c gives a_O1 = v_dot - alpha x c - w x c_dot - w x (w x c). A point below a
// parachute has no axes.
static void find_inertial(const flight_system *system, const flight_phase *phase,
                          const double *state, const double *rates, flight_instant *now)
{
    if (phase->hangs) {
        now->w_dot = now->force = v3_make(NAN, NAN, NAN);
        return;
    }
    m3 A_NB = m3_rotation_x(state[FLIGHT_ROLL]);
    m3 A_CB = m3_mul(q_matrix(q_from(state + FLIGHT_Q)), A_NB);
    v3 w_N = v3_from(state + FLIGHT_W), w = now->pose.w;
    v3 turning = v3_cross(v3_make(w_N.x, 0, 0), w_N);
    now->w_dot = m3_apply_transposed(A_NB, v3_sub(v3_from(rates + FLIGHT_W), turning));
    v3 gravity = earth_gravity(&system->earth, v3_from(state + FLIGHT_R));
    rocket_mass mass = flight_mass(system, phase, now->t);
    v3 arm =
        v3_add(v3_cross(now->w_dot, mass.c), v3_cross(w, v3_add(mass.c_dot, v3_cross(w, mass.c))));
    v3 felt = v3_sub(v3_from(rates + FLIGHT_V), gravity);
    now->force = v3_sub(m3_apply_transposed(A_CB, felt), arm);
}

static void find_line(const flight_system *system, const flight_phase *phase, flight_instant *now)
{
    const flight_line *line = phase->line;
    m3 A_IB = q_matrix(now->pose.q_IB);
    v3 arm = m3_apply(A_IB, v3_from(system->rocket->line.bridle));
    now->tension = v3_norm(line_force(line, now->t));
    now->paid_out = line_paid(line, now->t);
    for (int i = 0; i < LD_LINE_PLACES; i++) {
        double share = (double)i / (LD_LINE_PLACES - 1);
        v3 r = line_place(line, now->t, v3_add(now->pose.r_O1, arm), share);
        now->line[i].x = r.x;
        now->line[i].y = r.y;
        now->line[i].z = r.z;
    }
}

static void find_canopy(const flight_system *system, const flight_phase *phase, const double *state,
                        flight_instant *now)
{
    const v3 unknown = v3_make(NAN, NAN, NAN);
    now->canopy = (earth_motion){unknown, unknown};
    now->lines_force = 0;
    if (!phase->canopy.given)
        return;
    v3 v = v3_add(v3_from(state + FLIGHT_V), v3_from(state + FLIGHT_CANOPY_U));
    now->canopy = earth_to_ground(&system->earth, now->t, canopy_place(state), v);
    now->lines_force = canopy_force(phase, state);
}

void flight_row(const flight_system *system, const quantity_columns *columns,
                const flight_phase *phase, double t, const double *state,
                double row[FLIGHT_MAX_COLUMNS])
{
    flight_instant now = {.t = t};
    flight_leave(system, phase, t, state, &now.pose);
    now.center = flight_center(system, t, state);
    now.flow = flight_flow_at(system, t, state);
    now.mass = flight_mass(system, phase, t).m;
    now.thrust = flight_thrust(system, phase, t);
    now.margin = flight_stability_margin(system, phase, t, now.flow.mach);
    now.drag_area = flight_drag_area(phase, t, state);
    if (phase->hangs) // a point has no axis
        now.flow.angle_of_attack = now.margin = NAN;
    flight_phase rated = *phase;
    double rates[FLIGHT_ALL_STATES];
    flight_rates(system, &rated, t, state, rates);
    now.acceleration = v3_norm(v3_from(rates + FLIGHT_V));
    find_inertial(system, phase, state, rates, &now);
    m3 A_IB = q_matrix(now.pose.q_IB);
    v3 turn = m3_apply_transposed(system->earth.A_EI, earth_rate(&system->earth));
    v3 w = v3_sub(m3_apply(A_IB, now.pose.w), turn), axis = m3_column(A_IB, 0);
    now.angles = direction_angles_of(axis, v3_cross(w, axis));
    if (!system->earth.flat)
        now.place = flight_place_at(system, t, state, A_IB);
    find_canopy(system, phase, state, &now);
    if (phase->line)
        find_line(system, phase, &now);
    quantity_row(columns, &now, row);
}
