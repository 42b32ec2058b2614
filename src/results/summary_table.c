#include <math.h>
#include <string.h>

#include "base/printed.h"
#include "launchdyn/output.h"
#include "simulation/summary.h"

static const double degree = 0.017453292519943295; // [rad]

// "  name            value unit", nothing where there is no value.
static void line(FILE *stream, const char *name, double value, int digits, const char *unit)
{
    if (isfinite(value))
        fprintf(stream, "  %-22s %12.*f %s\n", name, digits, printed_fixed(value, digits), unit);
}

static void line_of_two(FILE *stream, const char *name, double first, double second, int digits,
                        const char *unit)
{
    if (isfinite(first) && isfinite(second))
        fprintf(stream, "  %-22s %12.*f %12.*f %s\n", name, digits, printed_fixed(first, digits),
                digits, printed_fixed(second, digits), unit);
}

// Frequencies of one kind of shape a line; the kinds in the order in which they first occur.
static void print_modes(const ld_summary *summary, FILE *stream)
{
    if (summary->mode_count == 0)
        return;
    fputs("\nTube on its supports, natural frequencies [Hz]\n", stream);
    for (int i = 0; i < summary->mode_count; i++) {
        const char *shape = summary->mode[i].shape;
        bool shown = false;
        for (int j = 0; j < i && !shown; j++)
            shown = strcmp(summary->mode[j].shape, shape) == 0;
        if (shown)
            continue;
        fprintf(stream, "  %-22s", shape);
        for (int j = i; j < summary->mode_count; j++)
            if (strcmp(summary->mode[j].shape, shape) == 0)
                fprintf(stream, " %8.2f", summary->mode[j].frequency);
        fputc('\n', stream);
    }
}

static void print_equilibrium(const ld_model *model, const ld_equilibrium_summary *equilibrium,
                              FILE *stream)
{
    fputs("\nEquilibrium at the start\n", stream);
    line(stream, "lock force", equilibrium->lock_force, 2, "N");
    if (equilibrium->breech_force > 0)
        line(stream, "breech force", equilibrium->breech_force, 2, "N");
    line(stream, "slot force", equilibrium->slot_force, 2, "N");
    for (int i = 0; i < model->rocket.adaptor_count; i++) {
        char name[LD_MAX_NAME + 16];
        snprintf(name, sizeof name, "contact %s", model->rocket.adaptor[i].name);
        line(stream, name, equilibrium->contact_force[i], 2, "N");
    }
    line_of_two(stream, "tip sag y, z", equilibrium->tip_sag[0] * 1e3,
                equilibrium->tip_sag[1] * 1e3, 4, "mm");
}

// Rates and angles [mrad/s], [mrad], velocities [m/s].
static void print_against_launcher(const ld_tip_off *off, const ld_aim *aim, FILE *stream)
{
    line_of_two(stream, "tip-off pitch, yaw", off->pitch * 1e3, off->yaw * 1e3, 4, "mrad");
    line_of_two(stream, "tip-off rates", off->pitch_rate * 1e3, off->yaw_rate * 1e3, 3, "mrad/s");
    line_of_two(stream, "relative rates", off->pitch_rate_relative * 1e3,
                off->yaw_rate_relative * 1e3, 3, "mrad/s");
    line_of_two(stream, "tip-off vy, vz", off->vy, off->vz, 5, "m/s");
    line_of_two(stream, "relative vy, vz", off->vy_relative, off->vz_relative, 5, "m/s");
    line_of_two(stream, "aim pitch, yaw", aim->pitch * 1e3, aim->yaw * 1e3, 4, "mrad");
    line_of_two(stream, "aim rates", aim->pitch_rate * 1e3, aim->yaw_rate * 1e3, 3, "mrad/s");
    line_of_two(stream, "aim vy, vz", aim->vy, aim->vz, 5, "m/s");
}

static void print_rocket(const ld_model *model, const ld_rocket_summary *rocket, bool first,
                         FILE *stream)
{
    fprintf(stream, "\nRocket of tube %d, instants from its ignition\n", rocket->tube);
    if (!first)
        line(stream, "dropped at tube change", rocket->energy_dropped, 4, "J");
    line(stream, "lock release", rocket->t_release * 1e3, 4, "ms");
    for (int i = model->rocket.adaptor_count - 1; i >= 0; i--) {
        char name[LD_MAX_NAME + 16];
        snprintf(name, sizeof name, "%s adaptor leaves", model->rocket.adaptor[i].name);
        line(stream, name, rocket->t_exit[i] * 1e3, 4, "ms");
    }
    line(stream, "muzzle speed", rocket->muzzle_speed, 4, "m/s");
    line(stream, "inertial speed", rocket->inertial_speed, 4, "m/s");
    line(stream, "spin rate", rocket->spin_rate, 4, "rad/s");
    line_of_two(stream, "pitch, yaw", rocket->pitch / degree, rocket->yaw / degree, 5, "deg");
    line_of_two(stream, "pitch rate, yaw rate", rocket->pitch_rate * 1e3, rocket->yaw_rate * 1e3, 3,
                "mrad/s");
    print_against_launcher(&rocket->tip_off, &rocket->aim, stream);
    line_of_two(stream, "tip y, z", rocket->tip.y * 1e3, rocket->tip.z * 1e3, 4, "mm");
    line_of_two(stream, "tip pitch, yaw rate", rocket->tip.pitch_rate * 1e3,
                rocket->tip.yaw_rate * 1e3, 3, "mrad/s");
    for (int i = 0; i < model->rocket.adaptor_count; i++) {
        char name[LD_MAX_NAME + 16];
        snprintf(name, sizeof name, "largest force, %s", model->rocket.adaptor[i].name);
        line(stream, name, rocket->max_contact_force[i], 1, "N");
    }
    line(stream, "largest slot force", rocket->max_slot_force, 1, "N");
}

static void print_flight(const ld_rocket_summary *rocket, FILE *stream)
{
    const ld_flight_summary *flight = &rocket->flight;
    const double *r = rocket->final.center;
    if (!rocket->flown)
        return;
    fputs("\nFlight\n", stream);
    line(stream, "apogee", flight->apogee, 3, "m");
    line_of_two(stream, "downrange, drift", flight->downrange, flight->drift, 3, "m");
    line(stream, "range", flight->range, 3, "m");
    line(stream, "impact from ignition", flight->t_impact, 4, "s");
    line(stream, "time of flight", flight->time_of_flight, 4, "s");
    line(stream, "impact speed", flight->impact_speed, 3, "m/s");
    line(stream, "impact angle", flight->impact_angle / degree, 3, "deg");
    line(stream, "largest Mach number", flight->max_mach, 4, "");
    line(stream, "largest angle of attack", flight->max_angle_of_attack / degree, 3, "deg");
    if (!isfinite(flight->t_impact))
        fprintf(stream, "  %-22s %12.3f %12.3f %12.3f m\n", "mass centre at the end",
                printed_fixed(r[0], 3), printed_fixed(r[1], 3), printed_fixed(r[2], 3));
}

static void print_cost(const ld_summary *summary, bool launch, FILE *stream)
{
    const ld_statistics *statistics = &summary->statistics;
    fputs("\nRun\n", stream);
    if (launch)
        fprintf(stream, "  %-22s %12.3e J, %.1e of the largest work\n", "energy balance misses",
                summary->energy.residual, summary->energy.residual_relative);
    fprintf(stream, "  %-22s %12lld, %lld evaluations\n", "steps", (long long)statistics->steps,
            (long long)statistics->rhs_evaluations);
    fprintf(stream, "  %-22s %12.1f ms, %.1f ms of it set-up\n", "CPU time",
            (statistics->cpu_seconds + statistics->cpu_seconds_setup) * 1e3,
            statistics->cpu_seconds_setup * 1e3);
}

void ld_summary_print(const ld_model *model, const ld_summary *summary, FILE *stream)
{
    bool launch = model->base.kind != LD_BASE_NONE;
    const char *unnamed = launch ? "Launch" : "Flight alone";
    fprintf(stream, "%s\n", model->title && *model->title ? model->title : unnamed);
    if (launch) {
        print_modes(summary, stream);
        print_equilibrium(model, &summary->equilibrium, stream);
    }
    for (int i = 0; i < summary->rocket_count; i++) {
        if (launch)
            print_rocket(model, &summary->rocket[i], i == 0, stream);
        print_flight(&summary->rocket[i], stream);
    }
    print_cost(summary, launch, stream);
    for (int i = 0; i < summary->note_count; i++)
        fprintf(stream, "%snote: %s\n", i ? "" : "\n", summary->note[i]);
    if (!summary->complete)
        fprintf(stream, "\nStopped at %.7f s: %s\n", summary->t_end, summary->stopped);
}
