// A launcher in words: what carries, guides, holds and drives the rocket, a line for each.
#include <locale.h>
#include <math.h>

#include "base/printed.h"
#include "launchdyn/scenario.h"
#include "launchdyn/status.h"
#include "model/model.h"

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
#define NEWTONS(value) scaled((value), "N").text
#define STIFFNESS(value) scaled((value), "N.m2").text

// ---- base ----

static void tell_base(FILE *stream, const ld_base *base)
{
    static const char *const kind[] = {[LD_BASE_FIXED] = "fixed",
                                       [LD_BASE_PRESCRIBED] = "moved as prescribed",
                                       [LD_BASE_VEHICLE] = "a vehicle",
                                       [LD_BASE_EXTERNAL] = "moved from outside"};
    static const char *const looks[] = {
        [LD_LOOKS_PLAIN] = "", [LD_LOOKS_SHIP] = "a ship, ", [LD_LOOKS_AIRCRAFT] = "an aircraft, "};
    bool vehicle = base->kind == LD_BASE_VEHICLE;
    fprintf(stream, "# base: %s%s", vehicle ? "" : looks[base->looks], kind[base->kind]);
    if (vehicle)
        fprintf(stream, " on %d wheels", base->vehicle.wheel_count);
    if (base->kind == LD_BASE_FIXED || base->kind == LD_BASE_PRESCRIBED) {
        fprintf(stream, "; tube %s %s", DEGREES(fabs(base->elevation)),
                base->elevation < 0 ? "down" : "up");
        if (base->azimuth != 0)
            fprintf(stream, ", %s to the %s", DEGREES(fabs(base->azimuth)),
                    base->azimuth < 0 ? "right" : "left");
    }
    fputc('\n', stream);
}

// ---- guide ----

static void tell_section(FILE *stream, const ld_section *s)
{
    fprintf(stream, "#   from %s:", METRES(s->from));
    fprintf(stream, " bore radius %s", MILLIMETRES(s->bore_radius));
    if (s->form == LD_SECTION_ANNULUS)
        fprintf(stream, ", wall %s", MILLIMETRES(s->outer_radius - s->bore_radius));
    fprintf(stream, ", EI %s", STIFFNESS(s->bending_stiffness));
    fprintf(stream, ", GJ %s, %.4g kg/m\n", STIFFNESS(s->torsion_stiffness), s->mass_per_length);
}

static void tell_guide(FILE *stream, const ld_tubes *tubes)
{
    int count = tubes->layout.rows * tubes->layout.columns;
    fprintf(stream, "# guide: ");
    if (count > 1)
        fprintf(stream, "%d tubes, each ", count);
    fprintf(stream, "a bore, %s long\n", METRES(tubes->length));
    for (int i = 0; i < tubes->section_count; i++)
        tell_section(stream, &tubes->section[i]);
}

static void tell_slot(FILE *stream, const ld_slot *slot)
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

static void tell_supports(FILE *stream, const ld_tubes *tubes)
{
    fprintf(stream, "# supports:");
    for (int i = 0; i < tubes->support_count; i++)
        fprintf(stream, "%s springs at %s", i ? "," : "", METRES(tubes->support[i].at));
    fputc('\n', stream);
}

// ---- rocket ----

static void tell_rocket(FILE *stream, const ld_rocket *rocket)
{
    bool gaps = !contact_has(rocket->contact.law, LD_CONTACT_TWO_SIDED);
    fprintf(stream, "# rocket: %.4g kg, from %s, on adaptors", rocket->full.mass,
            METRES(rocket->start_at));
    for (int i = 0; i < rocket->adaptor_count; i++) {
        const ld_adaptor *adaptor = &rocket->adaptor[i];
        fprintf(stream, "%s %s (%s", i ? "," : "", VISIBLE(adaptor->name), METRES(adaptor->at));
        if (gaps)
            fprintf(stream, ", %s%s", i ? "" : "clearance ", MILLIMETRES(adaptor->clearance));
        fputc(')', stream);
    }
    fprintf(stream, gaps ? "\n" : ", held on the axis\n");
}

static void tell_motor(FILE *stream, const ld_motor *motor)
{
    const ld_table *thrust = &motor->thrust;
    double most = 0, end = thrust->rows ? thrust->data[2 * (thrust->rows - 1)] : 0;
    for (size_t i = 0; i < thrust->rows; i++)
        most = fmax(most, thrust->data[2 * i + 1]);
    fprintf(stream, "a motor of at most %s, for %.4g s", NEWTONS(most * motor->thrust_scale),
            end * motor->time_scale);
}

static void tell_drive(FILE *stream, const ld_model *model)
{
    const ld_lock *lock = &model->rocket.lock;
    fprintf(stream, "# drive: ");
    tell_motor(stream, &model->rocket.motor);
    if (lock->present)
        fprintf(stream, "; the lock lets go at %s\n", NEWTONS(lock->release_force));
    else
        fprintf(stream, "; no lock\n");
}

void ld_model_describe(const ld_model *model, FILE *stream)
{
    if (!model_has_launcher(model))
        return;
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0), before = uselocale(plain);
    tell_base(stream, &model->base);
    tell_guide(stream, &model->tubes);
    tell_slot(stream, &model->tubes.slot);
    tell_supports(stream, &model->tubes);
    tell_rocket(stream, &model->rocket);
    tell_drive(stream, model);
    uselocale(before);
    freelocale(plain);
}
