#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "base/numeric_locale.h"
#include "launchdyn/output.h"
#include "launchdyn/version.h"
#include "results/json_text.h"
#include "results/origin.h"
#include "simulation/summary.h"

// A JSON text on its way to a file: indented by two blanks a level, commas as they are needed.
typedef struct json_writer {
    FILE *file;
    int level;
    bool first; // no member of the innermost object or array yet
} json_writer;

static void json_new_line(json_writer *json)
{
    fprintf(json->file, "%s\n%*s", json->first ? "" : ",", 2 * json->level, "");
    json->first = false;
}

// The name of a member; NULL in an array.
static void json_key(json_writer *json, const char *key)
{
    json_new_line(json);
    if (!key)
        return;
    json_write_text(json->file, key);
    fputs(": ", json->file);
}

static void json_open(json_writer *json, const char *key, char bracket)
{
    if (json->level > 0)
        json_key(json, key);
    fputc(bracket, json->file);
    json->level++;
    json->first = true;
}

static void json_close(json_writer *json, char bracket)
{
    json->level--;
    if (!json->first)
        fprintf(json->file, "\n%*s", 2 * json->level, "");
    fputc(bracket, json->file);
    json->first = false;
}

static void json_text(json_writer *json, const char *key, const char *text)
{
    json_key(json, key);
    json_write_text(json->file, text);
}

static void json_number(json_writer *json, const char *key, double value)
{
    json_key(json, key);
    json_write_number(json->file, value);
}

static void json_integer(json_writer *json, const char *key, long long value)
{
    json_key(json, key);
    fprintf(json->file, "%lld", value);
}

// One value an adaptor, by its name.
static void write_adaptors(json_writer *json, const char *key, const ld_model *model,
                           const double *values)
{
    json_open(json, key, '{');
    for (int i = 0; i < model->rocket.adaptor_count; i++)
        json_number(json, model->rocket.adaptor[i].name, values[i]);
    json_close(json, '}');
}

static void write_relative(json_writer *json, const ld_rocket_summary *rocket)
{
    json_open(json, "relative", '{');
    json_number(json, "y", rocket->relative.y);
    json_number(json, "z", rocket->relative.z);
    json_number(json, "psi", rocket->relative.psi);
    json_number(json, "theta", rocket->relative.theta);
    json_number(json, "gamma", rocket->relative.gamma);
    json_number(json, "w_x", rocket->relative.w_x);
    json_number(json, "w_y", rocket->relative.w_y);
    json_number(json, "w_z", rocket->relative.w_z);
    json_close(json, '}');
}

static void write_tip(json_writer *json, const ld_rocket_summary *rocket)
{
    json_open(json, "tip", '{');
    json_number(json, "y", rocket->tip.y);
    json_number(json, "z", rocket->tip.z);
    json_number(json, "pitch", rocket->tip.pitch);
    json_number(json, "yaw", rocket->tip.yaw);
    json_number(json, "vy", rocket->tip.vy);
    json_number(json, "vz", rocket->tip.vz);
    json_number(json, "pitch_rate", rocket->tip.pitch_rate);
    json_number(json, "yaw_rate", rocket->tip.yaw_rate);
    json_close(json, '}');
}

static void write_tip_off(json_writer *json, const ld_tip_off *off)
{
    json_open(json, "tip_off", '{');
    json_number(json, "pitch", off->pitch);
    json_number(json, "yaw", off->yaw);
    json_number(json, "pitch_rate", off->pitch_rate);
    json_number(json, "yaw_rate", off->yaw_rate);
    json_number(json, "pitch_rate_relative", off->pitch_rate_relative);
    json_number(json, "yaw_rate_relative", off->yaw_rate_relative);
    json_number(json, "vy", off->vy);
    json_number(json, "vz", off->vz);
    json_number(json, "vy_relative", off->vy_relative);
    json_number(json, "vz_relative", off->vz_relative);
    json_close(json, '}');
}

static void write_aim(json_writer *json, const ld_aim *aim)
{
    json_open(json, "aim", '{');
    json_number(json, "pitch", aim->pitch);
    json_number(json, "yaw", aim->yaw);
    json_number(json, "pitch_rate", aim->pitch_rate);
    json_number(json, "yaw_rate", aim->yaw_rate);
    json_number(json, "vy", aim->vy);
    json_number(json, "vz", aim->vz);
    json_close(json, '}');
}

// Number by number, as an array.
static void write_vector(json_writer *json, const char *key, const double *values, int count)
{
    json_open(json, key, '[');
    for (int i = 0; i < count; i++)
        json_number(json, NULL, values[i]);
    json_close(json, ']');
}

static void write_flight(json_writer *json, const ld_flight_summary *flight)
{
    json_open(json, "flight", '{');
    json_number(json, "apogee", flight->apogee);
    json_number(json, "downrange", flight->downrange);
    json_number(json, "drift", flight->drift);
    json_number(json, "range", flight->range);
    json_number(json, "t_impact", flight->t_impact);
    json_number(json, "time_of_flight", flight->time_of_flight);
    json_number(json, "impact_speed", flight->impact_speed);
    json_number(json, "impact_angle", flight->impact_angle);
    json_number(json, "max_mach", flight->max_mach);
    json_number(json, "max_angle_of_attack", flight->max_angle_of_attack);
    json_close(json, '}');
}

static void write_final(json_writer *json, const ld_final_state *final)
{
    json_open(json, "final", '{');
    json_number(json, "t", final->t);
    write_vector(json, "position", final->position, 3);
    write_vector(json, "velocity", final->velocity, 3);
    write_vector(json, "quaternion", final->quaternion, 4);
    write_vector(json, "rate", final->rate, 3);
    write_vector(json, "center", final->center, 3);
    write_vector(json, "center_velocity", final->center_velocity, 3);
    if (final->earth) {
        json_number(json, "latitude", final->latitude);
        json_number(json, "longitude", final->longitude);
        json_number(json, "altitude", final->altitude);
        write_vector(json, "velocity_ned", final->velocity_ned, 3);
        json_number(json, "heading", final->heading);
        json_number(json, "pitch", final->pitch);
        json_number(json, "roll", final->roll);
        write_vector(json, "rate_inertial", final->rate_inertial, 3);
    }
    json_close(json, '}');
}

// The state in which the rocket leaves its tube and its flight begins.
static void write_exit(json_writer *json, const ld_rocket_summary *rocket)
{
    json_open(json, "exit", '{');
    write_vector(json, "position", rocket->exit.position, 3);
    write_vector(json, "velocity", rocket->exit.velocity, 3);
    write_vector(json, "quaternion", rocket->exit.quaternion, 4);
    write_vector(json, "rate", rocket->exit.rate, 3);
    json_close(json, '}');
}

// What a rocket does in its tube.
static void write_launch(json_writer *json, const ld_model *model, const ld_rocket_summary *rocket)
{
    json_number(json, "t_release", rocket->t_release);
    json_number(json, "t_front", rocket->t_front);
    json_number(json, "t_middle", rocket->t_middle);
    json_number(json, "t_rear", rocket->t_rear);
    write_adaptors(json, "t_exit", model, rocket->t_exit);
    json_number(json, "muzzle_speed", rocket->muzzle_speed);
    json_number(json, "inertial_speed", rocket->inertial_speed);
    json_number(json, "spin_rate", rocket->spin_rate);
    json_number(json, "pitch", rocket->pitch);
    json_number(json, "yaw", rocket->yaw);
    json_number(json, "pitch_rate", rocket->pitch_rate);
    json_number(json, "yaw_rate", rocket->yaw_rate);
    write_exit(json, rocket);
    write_relative(json, rocket);
    write_tip(json, rocket);
    write_tip_off(json, &rocket->tip_off);
    write_aim(json, &rocket->aim);
    write_adaptors(json, "max_contact_force", model, rocket->max_contact_force);
    json_number(json, "max_slot_force", rocket->max_slot_force);
    json_number(json, "energy_dropped", rocket->energy_dropped);
}

static void write_rocket(json_writer *json, const ld_model *model, const ld_rocket_summary *rocket)
{
    json_open(json, NULL, '{');
    if (model->base.kind != LD_BASE_NONE)
        json_integer(json, "tube", rocket->tube);
    json_number(json, "t_ignition", rocket->t_ignition);
    if (model->base.kind != LD_BASE_NONE)
        write_launch(json, model, rocket);
    if (rocket->flown) {
        write_flight(json, &rocket->flight);
        write_final(json, &rocket->final);
    }
    json_close(json, '}');
}

static void write_vehicle_at_rest(json_writer *json, const ld_model *model,
                                  const ld_equilibrium_summary *equilibrium)
{
    static const char *const hinges[] = {"azimuth", "elevation"};
    json_open(json, "wheels", '[');
    for (int j = 0; j < equilibrium->wheel_count; j++) {
        json_open(json, NULL, '{');
        json_text(json, "name", model->base.vehicle.wheel[j].name);
        json_number(json, "tyre_force", equilibrium->wheel[j].tyre_force);
        write_vector(json, "suspension", equilibrium->wheel[j].suspension, 3);
        json_number(json, "tyre_deflection", equilibrium->wheel[j].tyre_deflection);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_open(json, "chassis", '{');
    json_number(json, "y", equilibrium->chassis.y);
    json_number(json, "pitch", equilibrium->chassis.pitch);
    json_number(json, "roll", equilibrium->chassis.roll);
    json_close(json, '}');
    for (int i = 0; i < 2; i++) {
        json_open(json, hinges[i], '{');
        json_number(json, "angle", equilibrium->hinge[i].angle);
        json_number(json, "torque", equilibrium->hinge[i].torque);
        json_close(json, '}');
    }
}

static void write_equilibrium(json_writer *json, const ld_model *model,
                              const ld_equilibrium_summary *equilibrium)
{
    json_open(json, "equilibrium", '{');
    json_number(json, "lock_force", equilibrium->lock_force);
    json_number(json, "breech_force", equilibrium->breech_force);
    json_number(json, "slot_force", equilibrium->slot_force);
    write_adaptors(json, "contact_force", model, equilibrium->contact_force);
    json_open(json, "tip_sag", '{');
    json_number(json, "y", equilibrium->tip_sag[0]);
    json_number(json, "z", equilibrium->tip_sag[1]);
    json_close(json, '}');
    json_number(json, "residual", equilibrium->residual);
    if (equilibrium->wheel_count > 0)
        write_vehicle_at_rest(json, model, equilibrium);
    json_close(json, '}');
}

static void write_energy(json_writer *json, const ld_energy *energy, bool vehicle)
{
    json_open(json, "energy", '{');
    json_number(json, "kinetic", energy->kinetic);
    json_number(json, "potential", energy->potential);
    json_number(json, "elastic", energy->elastic);
    json_open(json, "work", '{');
    json_number(json, "thrust", energy->work.thrust);
    json_number(json, "gravity_rocket", energy->work.gravity_rocket);
    json_number(json, "contact_normal", energy->work.contact_normal);
    json_number(json, "contact_friction", energy->work.contact_friction);
    json_number(json, "slot", energy->work.slot);
    json_number(json, "slot_friction", energy->work.slot_friction);
    json_number(json, "lock", energy->work.lock);
    json_number(json, "support_damping", energy->work.support_damping);
    json_number(json, "modal_damping", energy->work.modal_damping);
    json_number(json, "base", energy->work.base);
    json_number(json, "mass_change", energy->work.mass_change);
    if (vehicle) {
        json_number(json, "stabilisers", energy->work.stabilisers);
        json_number(json, "hinge_friction", energy->work.hinge_friction);
        json_number(json, "gravity_platform", energy->work.gravity_platform);
        json_number(json, "gravity_wheels", energy->work.gravity_wheels);
        json_number(json, "suspension_damping", energy->work.suspension_damping);
        json_number(json, "tyre", energy->work.tyre);
        json_number(json, "tyre_side", energy->work.tyre_side);
        json_number(json, "drive", energy->work.drive);
    }
    json_close(json, '}');
    json_number(json, "residual", energy->residual);
    json_number(json, "residual_relative", energy->residual_relative);
    json_close(json, '}');
}

static void write_modes(json_writer *json, const ld_summary *summary)
{
    json_open(json, "modes", '[');
    for (int i = 0; i < summary->mode_count; i++) {
        const ld_mode *mode = &summary->mode[i];
        json_open(json, NULL, '{');
        json_number(json, "frequency", mode->frequency);
        json_number(json, "damping", mode->damping);
        json_number(json, "real", mode->real);
        json_text(json, "shape", mode->shape);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void write_end(json_writer *json, const ld_summary *summary)
{
    json_number(json, "t_end", summary->t_end);
    json_key(json, "complete");
    fputs(summary->complete ? "true" : "false", json->file);
    json_key(json, "stopped");
    if (summary->complete)
        fputs("null", json->file);
    else
        json_write_text(json->file, summary->stopped);
    json_open(json, "notes", '[');
    for (int i = 0; i < summary->note_count; i++)
        json_text(json, NULL, summary->note[i]);
    json_close(json, ']');
}

static void write_statistics(json_writer *json, const ld_statistics *statistics)
{
    json_open(json, "statistics", '{');
    json_integer(json, "steps", statistics->steps);
    json_integer(json, "rhs_evaluations", statistics->rhs_evaluations);
    json_number(json, "cpu_seconds", statistics->cpu_seconds);
    json_number(json, "cpu_seconds_setup", statistics->cpu_seconds_setup);
    json_close(json, '}');
}

// Last of all, and the scenario's texts last of that: a report leaves them out of what it shows.
static void write_texts(json_writer *json, const ld_origin *origin)
{
    json_text(json, "scenario", origin->scenario);
    json_key(json, "source");
    origin_write_source(json->file, origin);
}

static void write_summary(json_writer *json, const ld_model *model, const ld_summary *summary,
                          const ld_origin *origin)
{
    json_open(json, NULL, '{');
    json_text(json, "title", model->title ? model->title : "");
    json_text(json, "version", LD_VERSION);
    json_key(json, "program");
    origin_write_program(json->file, origin);
    write_end(json, summary);
    json_open(json, "rockets", '[');
    for (int i = 0; i < summary->rocket_count; i++)
        write_rocket(json, model, &summary->rocket[i]);
    json_close(json, ']');
    if (model->base.kind != LD_BASE_NONE) {
        write_equilibrium(json, model, &summary->equilibrium);
        write_energy(json, &summary->energy, model->base.kind == LD_BASE_VEHICLE);
        write_modes(json, summary);
    }
    write_statistics(json, &summary->statistics);
    write_texts(json, origin);
    json_close(json, '}');
    fputc('\n', json->file);
}

ld_status ld_summary_write(const char *path, const ld_model *model, const ld_summary *summary,
                           ld_error *error)
{
    json_writer json = {.file = fopen(path, "w")};
    ld_origin origin;
    if (!json.file)
        return ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", path, strerror(errno));
    ld_status status = ld_origin_of(model, &origin, error);
    locale_t before = numeric_locale_enter();
    if (!status)
        write_summary(&json, model, summary, &origin);
    numeric_locale_leave(before);
    ld_origin_free(&origin);
    bool wrong = fflush(json.file) != 0 || ferror(json.file);
    int number = errno;
    wrong |= fclose(json.file) != 0;
    if (!status && !wrong)
        return LD_OK;
    unlink(path);
    return status ? status
                  : ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", path, strerror(number));
}
