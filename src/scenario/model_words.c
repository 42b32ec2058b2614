// A launcher in words: what carries, guides, holds and drives the rocket, a line for each.
#include <assert.h>

#include "base/numeric_locale.h"
#include "base/printed.h"
#include "launchdyn/scenario.h"
#include "launchdyn/status.h"
#include "math/functions.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "model/parts.h"

static const double DEGREE = 3.14159265358979323846 / 180;

// ---- numbers ----

typedef struct number_text {
    char text[48];
} number_text;

// A number with k or M before its unit where that makes it shorter: "15 kN".
static number_text scaled(double value, const char *unit)
{
    number_text made;
    double size = fabs(value);
    int power = size >= 1e6 ? 6 : size >= 1e3 ? 3 : 0;
    const char *prefix = power == 6 ? "M" : power == 3 ? "k" : "";
    snprintf(made.text, sizeof made.text, "%.4g %s%s", value / pow(10, power), prefix, unit);
    return made;
}

static number_text metres(double value)
{
    number_text made;
    snprintf(made.text, sizeof made.text, "%.4g m", value);
    return made;
}

static number_text millimetres(double value)
{
    number_text made;
    snprintf(made.text, sizeof made.text, "%.4g mm", 1e3 * value);
    return made;
}

static number_text degrees(double value)
{
    number_text made;
    snprintf(made.text, sizeof made.text, "%.4g deg", printed_fixed(value / DEGREE, 4));
    return made;
}

#define METRES(value) metres(value).text
#define MILLIMETRES(value) millimetres(value).text
#define DEGREES(value) degrees(value).text
#define PASCALS(value) scaled((value), "Pa").text
#define NEWTONS(value) scaled((value), "N").text
#define STIFFNESS(value) scaled((value), "N.m2").text

// ---- base ----

// The word of the base's kind, without memory, which may be short.
static const char *base_word(const ld_model *model)
{
    char why[LD_ERROR_TEXT];
    field_value kind;
    bool there = field_reach(model, "base.kind", &kind, why, sizeof why);
    assert(there);
    return field_word_of(kind.row->words, (int)model->base.kind)->name;
}

static void describe_base(FILE *stream, const ld_model *model)
{
    static const char *const looks[] = {
        [LD_LOOKS_PLAIN] = "", [LD_LOOKS_SHIP] = ", a ship", [LD_LOOKS_AIRCRAFT] = ", an aircraft"};
    const ld_base *base = &model->base;
    double elevation;
    fprintf(stream, "# base: %s", base_word(model));
    if (model_has_vehicle(model))
        fprintf(stream, " on %d wheels", base->vehicle.wheel_count);
    else
        fputs(looks[base->looks], stream);
    if (!ld_model_number(model, "base.elevation", &elevation, NULL)) {
        fputs("; ", stream);
        if (model_has_multibody(model))
            fprintf(stream, "%s on %s, ", model_guide_word(model), VISIBLE(model->tubes.on));
        else
            fputs("launcher ", stream);
        fprintf(stream, "%s %s", DEGREES(fabs(elevation)), elevation < 0 ? "down" : "up");
        if (base->azimuth != 0)
            fprintf(stream, ", %s to the %s", DEGREES(fabs(base->azimuth)),
                    base->azimuth < 0 ? "right" : "left");
    }
    fputc('\n', stream);
}

// ---- guide ----

static void describe_section(FILE *stream, const ld_section *s, bool bore)
{
    fprintf(stream, "#   from %s:", METRES(s->from));
    if (bore)
        fprintf(stream, " bore radius %s,", MILLIMETRES(s->bore_radius));
    if (s->form == LD_SECTION_ANNULUS)
        fprintf(stream, " wall %s,", MILLIMETRES(s->outer_radius - s->bore_radius));
    if (s->form == LD_SECTION_PLANES)
        fprintf(stream, " EI %s about y, %s about z", STIFFNESS(s->bending_stiffness_y),
                STIFFNESS(s->bending_stiffness_z));
    else if (section_stiffness_y(s) == section_stiffness_z(s))
        fprintf(stream, " EI %s", STIFFNESS(section_stiffness_y(s)));
    else
        fprintf(stream, " EI %s about y, %s about z", STIFFNESS(section_stiffness_y(s)),
                STIFFNESS(section_stiffness_z(s)));
    fprintf(stream, ", GJ %s, %.4g kg/m\n", STIFFNESS(s->torsion_stiffness), s->mass_per_length);
}

// Where a point is across the guide: "80 mm below and 5 mm right of the line".
static void describe_position(FILE *stream, const double at[2], const char *from)
{
    if (at[0] == 0 && at[1] == 0)
        fprintf(stream, "on");
    if (at[0] != 0)
        fprintf(stream, "%s %s", MILLIMETRES(fabs(at[0])), at[0] < 0 ? "below" : "above");
    if (at[1] != 0)
        fprintf(stream, "%s%s %s of", at[0] != 0 ? " and " : "", MILLIMETRES(fabs(at[1])),
                at[1] < 0 ? "left" : "right");
    fprintf(stream, " the %s", from);
}

static void describe_surfaces(FILE *stream, const ld_guide *guide)
{
    for (int k = 0; k < guide->surface_count; k++) {
        const ld_surface *surface = &guide->surface[k];
        bool flat = surface->shape == LD_SURFACE_FLAT;
        fprintf(stream, "#   surface %s: %s, ", VISIBLE(surface->name), flat ? "flat" : "round");
        describe_position(stream, surface->at, "line");
        fprintf(stream, ", towards %s, gap %s\n", DEGREES(surface->normal),
                MILLIMETRES(surface->gap));
    }
}

static void describe_slide(FILE *stream, const ld_guide *guide)
{
    if (guide->form == LD_GUIDE_T_SLOT) {
        fprintf(stream, "#   T-slot ");
        describe_position(stream, guide->t_slot.at, "line");
        fprintf(stream, ", lips %s apart, gap %s, at the sides %s\n",
                MILLIMETRES(guide->t_slot.lips), MILLIMETRES(guide->t_slot.gap),
                MILLIMETRES(guide->t_slot.side_gap));
    } else if (guide->form == LD_GUIDE_TOWER) {
        fprintf(stream, "#   the first rail at %s, gap %s\n", DEGREES(guide->tower.first),
                MILLIMETRES(guide->tower.gap));
    } else {
        describe_surfaces(stream, guide);
    }
}

static void describe_initial_shape(FILE *stream, const ld_initial_shape *shape)
{
    const ld_table *table = &shape->offsets;
    double most = 0;
    for (size_t i = 0; i < table->rows; i++) {
        const double *row = table->data + i * table->columns;
        most = fmax(most, hypot(shape->scale[0] * row[1], shape->scale[1] * row[2]));
    }
    if (table->rows > 0)
        fprintf(stream, "#   bent by up to %s%s\n", MILLIMETRES(most),
                table->columns > 3 ? ", and twisted" : "");
    if (shape->random.present)
        fprintf(stream, "#   random bends of up to %s\n", MILLIMETRES(shape->random.deviation));
    for (int i = 0; i < shape->joint_count; i++) {
        const ld_rail_joint *joint = &shape->joint[i];
        fprintf(stream, "#   joint at %s: step of %s, kink of %s\n", METRES(joint->at),
                MILLIMETRES(hypot(joint->step[0], joint->step[1])),
                DEGREES(hypot(joint->kink[0], joint->kink[1])));
    }
}

static void describe_guide(FILE *stream, const ld_model *model)
{
    const ld_tubes *tubes = &model->tubes;
    const ld_guide *guide = &tubes->guide;
    bool tower = guide->present && guide->form == LD_GUIDE_TOWER;
    const char *noun = guide->present ? model_guide_word(model) : "bore";
    int count = tubes->layout.rows * tubes->layout.columns;
    if (count > 1)
        fprintf(stream, "# guides: %d %ss", count, noun);
    else
        fprintf(stream, "# guide: a %s", noun);
    if (tower)
        fprintf(stream, " of %d rails", guide->tower.rails);
    fprintf(stream, ", %s%s long", count > 1 ? "each " : "", METRES(tubes->length));
    if (guide->present && (guide->line[0] != 0 || guide->line[1] != 0)) {
        fprintf(stream, ", its line ");
        describe_position(stream, guide->line, "elastic axis");
    }
    fputc('\n', stream);
    if (guide->present)
        describe_slide(stream, guide);
    describe_initial_shape(stream, &tubes->initial_shape);
    for (int i = 0; i < tubes->section_count; i++)
        describe_section(stream, &tubes->section[i], !guide->present);
}

static void describe_slot(FILE *stream, const ld_slot *slot)
{
    if (slot->kind == LD_SLOT_NONE)
        return;
    const double *row = slot->angle.data;
    size_t rows = slot->angle.rows;
    fprintf(stream, "# slot: a helix of %s", DEGREES(row[1]));
    if (rows > 1)
        fprintf(stream, " to %s", DEGREES(row[2 * rows - 1]));
    fprintf(stream, " at the radius %s, friction %.4g\n", MILLIMETRES(slot->radius),
            slot->friction);
}

// A clamp, of which directions unless of all, and springs beside it.
static void describe_clamp(FILE *stream, const ld_support *support)
{
    static const char *const name[LD_CLAMPS] = {"x", "y", "z", "roll", "yaw", "pitch"};
    int held = 0, told = 0, springs = 0;
    for (int i = 0; i < LD_CLAMPS; i++) {
        held += support_clamps(support, (ld_clamp)i);
        springs += support_spring(support, (ld_clamp)i) > 0;
    }
    fprintf(stream, " a clamp");
    for (int i = 0; i < LD_CLAMPS && held < LD_CLAMPS; i++)
        if (support_clamps(support, (ld_clamp)i)) {
            fprintf(stream, "%s %s", told == 0 ? " of" : told + 1 < held ? "," : " and", name[i]);
            told++;
        }
    fputs(springs ? ", with springs," : "", stream);
}

static void describe_supports(FILE *stream, const ld_tubes *tubes)
{
    fprintf(stream, "# supports:");
    for (int i = 0; i < tubes->support_count; i++) {
        const ld_support *support = &tubes->support[i];
        fputs(i ? "," : "", stream);
        if (support->clamped)
            describe_clamp(stream, support);
        else
            fputs(" springs", stream);
        fprintf(stream, " at %s", METRES(support->at));
        if (!support->recoil.present)
            continue;
        fprintf(stream, " with a recoil slide");
        if (!isnan(support->recoil.stroke))
            fprintf(stream, " of %s", MILLIMETRES(support->recoil.stroke));
    }
    fputc('\n', stream);
}

// ---- rocket ----

// What is around an adaptor, or more than the guide's gaps around a shoe.
static void describe_clearance(FILE *stream, const ld_model *model, int i)
{
    double clearance = model->rocket.adaptor[i].clearance;
    if (contact_has(model->rocket.contact.law, LD_CONTACT_TWO_SIDED))
        return;
    if (!model->tubes.guide.present)
        fprintf(stream, ", %s%s", i ? "" : "clearance ", MILLIMETRES(clearance));
    else if (clearance > 0)
        fprintf(stream, ", gaps %s wider", MILLIMETRES(clearance));
}

static void describe_rocket(FILE *stream, const ld_model *model)
{
    const ld_rocket *rocket = &model->rocket;
    fprintf(stream, "# rocket: %.4g kg, from %s, on %s", rocket->full.mass,
            METRES(rocket->start_at), model->tubes.guide.present ? "shoes" : "adaptors");
    for (int i = 0; i < rocket->adaptor_count; i++) {
        const ld_adaptor *adaptor = &rocket->adaptor[i];
        fprintf(stream, "%s %s (%s", i ? "," : "", VISIBLE(adaptor->name), METRES(adaptor->at));
        describe_clearance(stream, model, i);
        if (adaptor->leaves_at > 0)
            fprintf(stream, ", leaves at %s", METRES(adaptor->leaves_at));
        if (adaptor->falls_off.present)
            fprintf(stream, ", falls off: %.4g kg", adaptor->falls_off.mass);
        fputc(')', stream);
    }
    if (contact_has(rocket->contact.law, LD_CONTACT_TWO_SIDED))
        fprintf(stream, contact_has(rocket->contact.law, LD_CONTACT_HELD)
                            ? ", held on the axis"
                            : ", held to the axis by springs");
    fputc('\n', stream);
}

// The largest value of a table's second column.
static double greatest(const ld_table *table)
{
    double most = 0;
    for (size_t i = 0; i < table->rows; i++)
        most = fmax(most, table->data[2 * i + 1]);
    return most;
}

static void describe_motor(FILE *stream, const ld_motor *motor)
{
    const ld_table *thrust = &motor->thrust;
    double end = thrust->rows ? thrust->data[2 * (thrust->rows - 1)] : 0;
    fprintf(stream, "a motor of at most %s, for %.4g s",
            NEWTONS(greatest(thrust) * motor->thrust_scale), end * motor->time_scale);
}

static void describe_pressure(FILE *stream, const ld_pressure *pressure)
{
    switch (pressure->form) {
    case LD_PRESSURE_OVER_TIME:
    case LD_PRESSURE_OVER_TRAVEL:
        fprintf(stream, "a pressure over %s, of at most %s",
                pressure->form == LD_PRESSURE_OVER_TIME ? "time" : "travel",
                PASCALS(pressure->scale * greatest(pressure->form == LD_PRESSURE_OVER_TIME
                                                       ? &pressure->over_time
                                                       : &pressure->over_travel)));
        return;
    case LD_PRESSURE_OF_GAS:
        fprintf(stream, "%.4g l of gas at %s against %s", 1e3 * pressure->volume,
                PASCALS(pressure->pressure), PASCALS(pressure->ambient));
        return;
    }
}

static void describe_drive(FILE *stream, const ld_model *model)
{
    const ld_lock *lock = &model->rocket.lock;
    bool gas = model_has_pressure(model), motor = !model->rocket.motor.absent;
    fprintf(stream, "# drive: ");
    if (gas)
        describe_pressure(stream, &model->tubes.pressure);
    if (motor) {
        fputs(gas ? " and " : "", stream);
        describe_motor(stream, &model->rocket.motor);
        if (model->rocket.further_motor_count > 0)
            fprintf(stream, ", and %d more", model->rocket.further_motor_count);
    }
    if (!gas && !motor)
        fprintf(stream, "none");
    if (lock->present)
        fprintf(stream, "; the lock releases at %s\n", NEWTONS(lock->release_force));
    else
        fprintf(stream, "; no lock\n");
}

// The air that the rocket feels before its release.
static void describe_air(FILE *stream, const ld_model *model)
{
    if (model_has_open_air(model))
        fprintf(stream, "# air: on the whole rocket on its %s, from the start on\n",
                model_guide_word(model));
    else if (model_has_crossflow(model))
        fprintf(stream,
                "# air: on what has come out of the bore, up to %s before the rear adaptor\n",
                METRES(model->rocket.aerodynamics.emerged.nose));
}

static void describe_line(FILE *stream, const ld_model *model)
{
    const ld_line *line = &model->rocket.line;
    if (!line->present)
        return;
    bool carried = line->container_on == LD_LINE_ON_LAUNCHER;
    fprintf(stream, "# line: %s of %.4g g/m, out of a container on the %s", METRES(line->length),
            1e3 * line->mass_per_length, carried ? "launcher" : "ground");
    if (line->slack > 0)
        fprintf(stream, ", %s of it slack", METRES(line->slack));
    if (!isnan(line->breaking_force))
        fprintf(stream, "; it breaks at %s", NEWTONS(line->breaking_force));
    fputc('\n', stream);
    if (carried && !model_base_goes_by_time(model))
        fprintf(stream, "#   after the exit the container goes on with the velocity that it had "
                        "there\n");
}

void ld_model_describe(const ld_model *model, FILE *stream)
{
    if (!model_has_launcher(model))
        return;
    locale_t before = numeric_locale_enter();
    describe_base(stream, model);
    describe_guide(stream, model);
    describe_slot(stream, &model->tubes.slot);
    describe_supports(stream, &model->tubes);
    describe_rocket(stream, model);
    describe_drive(stream, model);
    describe_air(stream, model);
    describe_line(stream, model);
    numeric_locale_leave(before);
}
