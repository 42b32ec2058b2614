// Rules that tie keys of the vehicle and its platforms together.
#include "model/model.h"
#include "model/parts.h"
#include "model/rules/rules.h"

#include <stdio.h>
#include <string.h>

#define RADIAN (180 / 3.14159265358979323846) // [deg]

// ---- road

static void coherence_rules(const rule_set *rules, const ld_road *road)
{
    bool coherent = road->tracks == LD_TRACKS_COHERENT;
    rising_rule(rules, "base.road.coherence.#", &road->coherence, "1/m", false);
    if (coherent && road->coherence.rows == 0)
        report_broken(rules, "base.road.coherence", 0,
                      "missing; coherent tracks require the table of g over spatial frequency");
    if (road->coherence.rows > 0 && !coherent && (int)road->tracks >= 0)
        report_broken(rules, "base.road.coherence", 0, "requires tracks: coherent");
}

// x of the chassis at the first instant and at the last one that is known of.
static void marching_span(const ld_model *model, double *first, double *last)
{
    double speed = model->base.vehicle.speed, end = 0;
    for (int i = 0; i < model->firing_count; i++)
        end = fmax(end, model->firing[i].at);
    if (model->run.end == LD_END_TIME)
        end += model->run.end_time;
    *first = -speed * model->run.lead_in;
    *last = speed * end;
}

// The table must lie under the wheels for the whole run, as far as that can be known before it.
static void profile_rules(const rule_set *rules, const ld_road *road)
{
    const ld_vehicle *vehicle = &rules->model->base.vehicle;
    const ld_table *profile = &road->profile;
    const char *path = "base.road.table";
    double first, last, behind = INFINITY, ahead = -INFINITY;
    if (profile->rows == 0)
        return;
    rising_rule(rules, "base.road.table.#", profile, "m", false);
    if (profile->rows == 1) {
        report_broken(rules, path, 0, "needs at least two rows");
        return;
    }
    marching_span(rules->model, &first, &last);
    for (int i = 0; i < vehicle->wheel_count; i++) {
        behind = fmin(behind, vehicle->wheel[i].mount[0]);
        ahead = fmax(ahead, vehicle->wheel[i].mount[0]);
    }
    double begin = profile->data[0], end = profile->data[(profile->rows - 1) * profile->columns];
    if (begin > first + behind || end < last + ahead)
        report_broken(rules, path, 0,
                      "does not cover the run: it goes from %g m to %g m, the wheels from %g m "
                      "(speed, lead_in, mounts) to %g m at least",
                      begin, end, first + behind, last + ahead);
}

static void road_rules(const rule_set *rules)
{
    const ld_road *road = &rules->model->base.vehicle.road;
    if (road->form != LD_ROAD_SUM)
        return;
    if (road->iso_class == LD_ROAD_SMOOTH && road->sine_count == 0 && road->bump_count == 0 &&
        road->profile.rows == 0)
        report_broken(rules, "base.road", 0,
                      "it has no height: give class, sines, bumps or table, or flat: true");
    if (road->wavelengths[0] >= road->wavelengths[1])
        report_broken(rules, "base.road.wavelengths", 0,
                      "the shortest, %g m, must be less than the longest, %g m",
                      road->wavelengths[0], road->wavelengths[1]);
    if (road->places[0] >= road->places[1])
        report_broken(
            rules, "base.road.places", 0,
            "the left track, z = %g m, must lie left of the right one, z = %g m (z is positive "
            "to the right)",
            road->places[0], road->places[1]);
    coherence_rules(rules, road);
    profile_rules(rules, road);
}

// ---- wheels

static void wheel_rules(const rule_set *rules)
{
    const ld_vehicle *vehicle = &rules->model->base.vehicle;
    int driven = 0;
    for (int i = 0; i < vehicle->wheel_count; i++) {
        driven += vehicle->wheel[i].driven;
        for (int k = 0; k < i; k++)
            if (vehicle->wheel[i].name[0] &&
                strcmp(vehicle->wheel[i].name, vehicle->wheel[k].name) == 0)
                report_broken(rules, "base.wheels.#.name", i + 1,
                              "\"%s\" is already the name of wheel %d", vehicle->wheel[i].name,
                              k + 1);
    }
    if (vehicle->speed > 0 && driven == 0)
        report_broken(rules, "base.drive.wheels", 0,
                      "no wheel is driven; a speed of %g m/s requires one", vehicle->speed);
}

static void suspension_rules(const rule_set *rules)
{
    const ld_suspension *s = &rules->model->base.vehicle.suspension;
    bool stop = !isnan(s->bump_stop.compression) || !isnan(s->bump_stop.extension);
    if (stop && isnan(s->bump_stop.stiffness))
        report_broken(rules, "base.suspension.bump_stop", 0,
                      "stiffness is missing; a stop requires it, in N/m, > 0 N/m");
    if (!stop && !isnan(s->bump_stop.stiffness))
        report_broken(
            rules, "base.suspension.bump_stop", 0,
            "compression and extension are missing; give the travel of one or both stops");
}

// ---- platforms

static void command_rules(const rule_set *rules, const char *path, const ld_table *command,
                          bool pitch)
{
    char row[96];
    snprintf(row, sizeof row, command->rows > 1 ? "%s.#" : "%s", path);
    rising_rule(rules, row, command, "s", false);
    for (size_t i = 0; i < command->rows && pitch; i++) {
        double angle = command->data[i * command->columns + 1] * RADIAN;
        if (fabs(angle) >= 89)
            report_broken(rules, row, (int)i + 1,
                          "%g deg; a pitch command must lie between -89 and "
                          "89 deg",
                          angle);
    }
}

// What a digital loop alone has.
static void sample_rules(const rule_set *rules, const char *path, const ld_stabiliser *s)
{
    const struct {
        const char *name;
        bool given;
    } option[] = {{"delay", s->delay > 0},
                  {"sensor_noise", s->noise.angle > 0 || s->noise.rate > 0},
                  {"sensor_resolution", s->resolution.angle > 0 || s->resolution.rate > 0}};
    for (int i = 0; i < 3 && s->sample == 0; i++)
        if (option[i].given)
            report_broken(rules, path, 0,
                          "sample is missing; %s requires it, in s, > 0 s and <= 10 s",
                          option[i].name);
    if (s->sample > 0 && s->delay > s->sample)
        report_broken(rules, path, 0, "a delay of %g s is longer than the sample period of %g s",
                      s->delay, s->sample);
}

// Without a lock the hinge needs its stabiliser whole, its gains or a cascade.
static void gain_rules(const rule_set *rules, const char *path, const ld_stabiliser *s)
{
    bool cascade = s->cascade.present;
    const struct {
        const char *name;
        double value;
    } gain[] = {{"kp", cascade ? 0 : s->kp},
                {"kd", cascade ? 0 : s->kd},
                {"torque_limit", s->torque_limit}};
    char missing[64] = "";
    for (int i = 0; i < 3; i++)
        if (isnan(gain[i].value)) {
            strcat(missing, missing[0] ? ", " : "");
            strcat(missing, gain[i].name);
        }
    if (missing[0])
        report_broken(rules, path, 0, "missing: %s; only a hinge with a lock does without",
                      missing);
    if (s->slew > 0 && s->bandwidth == 0)
        report_broken(
            rules, path, 0,
            "bandwidth is missing; a slew limit requires it, in Hz, > 0 Hz and <= 10000 Hz");
    sample_rules(rules, path, s);
}

// A jet is there from the tube's exit on and ends within its table.
static void jet_rules(const rule_set *rules, const char *name, const ld_table *jet)
{
    char row[64], first[64];
    snprintf(row, sizeof row, "%s.#", name);
    snprintf(first, sizeof first, "%s.1", name);
    if (jet->rows == 0)
        return;
    rising_rule(rules, row, jet, "m", false);
    const double *last = &jet->data[(jet->rows - 1) * jet->columns];
    if (jet->data[0] > 0)
        report_broken(rules, first, 0, "the first distance must be 0 m, not %g m", jet->data[0]);
    if (last[1] > 0)
        report_broken(rules, row, (int)jet->rows,
                      "the last force must be 0 N, not %g N: the force ends there", last[1]);
    if (jet->rows == 1)
        report_broken(rules, name, 0, "needs at least two rows");
}

// Each distance has its radii from 0 m on and ends at 0 Pa.
static void plume_table_rules(const rule_set *rules, const ld_plume *plume)
{
    const char *row = "rocket.motor.plume.pressure.#", *all = "rocket.motor.plume.pressure";
    const ld_table *table = &plume->pressure;
    for (size_t k = 0; k < table->rows; k++) {
        const double *now = table->data + 3 * k;
        bool first = k == 0 || now[0] != now[-3];
        bool last = k + 1 == table->rows || now[0] != now[3];
        if (k > 0 && now[0] < now[-3])
            report_broken(rules, row, (int)k + 1, "the distance %g m does not come after %g m",
                          now[0], now[-3]);
        else if (first && now[1] != 0)
            report_broken(rules, row, (int)k + 1,
                          "the first radius of a distance must be 0 m, not %g m", now[1]);
        else if (!first && now[1] <= now[-2])
            report_broken(rules, row, (int)k + 1, "the radius %g m does not come after %g m",
                          now[1], now[-2]);
        if (first && last)
            report_broken(rules, row, (int)k + 1, "the distance %g m needs at least two radii",
                          now[0]);
        else if (last && now[2] != 0)
            report_broken(rules, row, (int)k + 1,
                          "the last pressure of a distance must be 0 Pa, not %g Pa: the jet ends "
                          "there",
                          now[2]);
    }
    if (table->rows == 0)
        return;
    if (table->data[0] > 0)
        report_broken(rules, all, 0, "the first distance must be 0 m, not %g m", table->data[0]);
    double end = table->data[3 * (table->rows - 1)];
    if (end < plume->reach)
        report_broken(rules, all, 0, "ends at %g m; it must reach ends_at, %g m", end,
                      plume->reach);
}

static void ring_rules(const rule_set *rules, const char *name, double inner, double outer)
{
    const ld_plume *plume = &rules->model->rocket.motor.plume;
    char path[64];
    snprintf(path, sizeof path, "%s.outer_radius", name);
    if (!plume->present)
        report_broken(rules, name, 0, "requires rocket.motor.plume");
    if (inner >= outer)
        report_broken(rules, path, 0, "must be more than inner_radius, %g m", inner);
    if (plume->present && plume->form == LD_PLUME_ROUND && outer > 8 * plume->radius)
        report_broken(rules, path, 0,
                      "must be at most 8 times rocket.motor.plume.radius, which makes %g m",
                      8 * plume->radius);
}

static void guide_jet_rules(const rule_set *rules)
{
    const ld_tubes *tubes = &rules->model->tubes;
    const ld_rocket *rocket = &rules->model->rocket;
    const ld_plume *plume = &rocket->motor.plume;
    if (tubes->jet_face.present && tubes->jet.rows > 0)
        report_broken(rules, "tubes.jet_face", 0, "not with tubes.jet");
    if (tubes->jet_face.present)
        ring_rules(rules, "tubes.jet_face", tubes->jet_face.inner, tubes->jet_face.outer);
    if (tubes->deflector.present)
        ring_rules(rules, "tubes.deflector", tubes->deflector.inner, tubes->deflector.outer);
    if (tubes->deflector.present && tubes->deflector.at > rocket->start_at)
        report_broken(rules, "tubes.deflector.at", 0,
                      "must be behind the rear adaptor at the start, at most %g m",
                      rocket->start_at);
    if (plume->present && plume->form == LD_PLUME_TABLE)
        plume_table_rules(rules, plume);
}

static void turret_rules(const rule_set *rules, const char *name, const ld_turret *turret,
                         bool pitch)
{
    char path[64];
    snprintf(path, sizeof path, "platform.%s.inertia", name);
    inertia_rule(rules, path, turret->inertia, NULL);
    snprintf(path, sizeof path, "platform.%s.stabiliser.command", name);
    command_rules(rules, path, &turret->stabiliser.command, pitch);
    snprintf(path, sizeof path, "platform.%s.stabiliser", name);
    if (!turret->lock.present)
        gain_rules(rules, path, &turret->stabiliser);
}

void vehicle_rules(const rule_set *rules)
{
    const ld_platform *platform = &rules->model->platform;
    jet_rules(rules, "platform.jet", &platform->jet);
    jet_rules(rules, "tubes.jet", &rules->model->tubes.jet);
    guide_jet_rules(rules);
    bool wheels = model_has_multibody(rules->model) && rules->model->base.vehicle.wheel_count > 0;
    if (!model_has_vehicle(rules->model) && !wheels)
        return;
    road_rules(rules);
    wheel_rules(rules);
    suspension_rules(rules);
    if (wheels)
        return;
    inertia_rule(rules, "platform.chassis.inertia", platform->chassis_inertia, NULL);
    if (platform->has_azimuth)
        turret_rules(rules, "azimuth", &platform->azimuth, false);
    turret_rules(rules, "elevation", &platform->elevation, true);
}
