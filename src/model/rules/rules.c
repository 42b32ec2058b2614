// Rules that tie several keys together. Conditions are written so that NaN, and a choice of -1,
// break no rule, but for keys that only other keys make necessary.
#include "model/rules/rules.h"

#include <stdio.h>
#include <strings.h>

#include "model/guide.h"
#include "model/masses.h"
#include "model/model.h"
#include "model/moist_air.h"
#include "model/parts.h"

// A station must lie on the tube.
static void station_rule(const rule_set *rules, const char *path, int index, double at)
{
    double length = rules->model->tubes.length;
    if (at > length)
        report_broken(rules, path, index, "%g m lies beyond the tube's tip at %g m", at, length);
}

// Stations at which loads are asked for, each once.
static void load_rules(const rule_set *rules)
{
    const ld_tubes *tubes = &rules->model->tubes;
    for (int i = 0; i < tubes->station_count; i++) {
        double at = tubes->station[i].at;
        station_rule(rules, "tubes.loads.#.at", i + 1, at);
        if (!isnan(tubes->station[i].outer_fibre[0]) && isnan(tubes->material.youngs_modulus))
            report_broken(rules, "tubes.loads.#.outer_fibre", i + 1,
                          "requires tubes.material.youngs_modulus, for the stress");
        for (int k = 0; k < i; k++)
            if (tubes->station[k].at == at)
                report_broken(rules, "tubes.loads.#.at", i + 1,
                              "%g m is the station of entry %d already", at, k + 1);
    }
}

static void material_rules(const rule_set *rules, const ld_section *section, int index)
{
    const ld_material *material = &rules->model->tubes.material;
    static const char *const given_by[] = {"stiffnesses", "radii", "its area"};
    const char *path = "tubes.material";
    const char *by = given_by[section->form];
    if (isnan(material->youngs_modulus))
        report_broken(rules, path, 0, "youngs_modulus is missing; section %d is given by %s", index,
                      by);
    if (isnan(material->poisson_ratio) && isnan(material->shear_modulus))
        report_broken(rules, path, 0,
                      "poisson_ratio or shear_modulus is missing; section %d is given by %s", index,
                      by);
    if (section->form == LD_SECTION_ANNULUS && isnan(material->density))
        report_broken(rules, path, 0, "density is missing; section %d is given by %s", index, by);
}

static void section_rules(const rule_set *rules)
{
    const ld_tubes *tubes = &rules->model->tubes;
    const ld_material *material = &tubes->material;
    if (!isnan(material->poisson_ratio) && !isnan(material->shear_modulus))
        report_broken(rules, "tubes.material.shear_modulus", 0,
                      "given together with poisson_ratio; give one of them");
    if (tubes->section_count > 0 && tubes->section[0].from > 0)
        report_broken(rules, "tubes.sections.1.from", 0,
                      "the first section must begin at 0 m, not %g m", tubes->section[0].from);
    for (int i = 0; i < tubes->section_count; i++) {
        const ld_section *section = &tubes->section[i];
        if (i > 0 && section->from <= section[-1].from)
            report_broken(rules, "tubes.sections.#.from", i + 1,
                          "%g m does not come after the section before, which begins at %g m",
                          section->from, section[-1].from);
        if (section->from >= tubes->length)
            report_broken(rules, "tubes.sections.#.from", i + 1,
                          "%g m is not before the tube's tip at %g m", section->from,
                          tubes->length);
        if (section->form == LD_SECTION_ANNULUS && section->outer_radius <= section->bore_radius)
            report_broken(rules, "tubes.sections.#.outer_radius", i + 1,
                          "%g m must be greater than the inner radius, %g m", section->outer_radius,
                          section->bore_radius);
    }
    // the material is needed once, so say so once
    for (int i = 0; i < tubes->section_count; i++) {
        ld_section_form form = tubes->section[i].form;
        if (form == LD_SECTION_ANNULUS || form == LD_SECTION_AREA) {
            material_rules(rules, &tubes->section[i], i + 1);
            break;
        }
    }
}

// Values that follow from those given: too large or too small ones must not slip through.
static void derived_rules(const rule_set *rules)
{
    const ld_tubes *tubes = &rules->model->tubes;
    for (int i = 0; i < tubes->section_count; i++) {
        const ld_section *s = &tubes->section[i];
        const double value[] = {s->mass_per_length,     s->axial_stiffness,
                                section_stiffness_y(s), section_stiffness_z(s),
                                s->torsion_stiffness,   s->polar_inertia};
        bool has_wall = s->form != LD_SECTION_ANNULUS || s->outer_radius > s->bore_radius;
        for (int k = 0; k < 6 && has_wall; k++)
            if (value[k] < 1e-100 || value[k] > 1e100) {
                report_broken(rules, "tubes.sections.#", i + 1,
                              "its stiffnesses or masses come out as %g, out of range", value[k]);
                break;
            }
    }
}

// Firing `i` needs a tube, and a rocket in it.
static void firing_rule(const rule_set *rules, int i, int count)
{
    const ld_tubes *tubes = &rules->model->tubes;
    bool order = rules->model->firing_order.present;
    const char *path = order ? "firing.order.#" : "firing.#.tube";
    int tube = rules->model->firing[i].tube;
    if (tube > count)
        report_broken(rules, path, i + 1, "%d; the layout has tubes 1 to %d", tube, count);
    for (int k = 0; k < tubes->empty_count; k++)
        if (tubes->empty[k] == tube) {
            report_broken(rules, path, i + 1, "%d has no rocket: tubes.empty lists it", tube);
            return;
        }
    const ld_firing *firing = rules->model->firing;
    if (i > 0 && firing[i].at <= firing[i - 1].at)
        report_broken(rules, order ? "firing.interval" : "firing.#.at", i + 1,
                      "%g s does not come after the firing before, at %g s", firing[i].at,
                      firing[i - 1].at);
    for (int k = 0; k < i; k++)
        if (firing[k].tube == tube)
            report_broken(rules, path, i + 1, "%d has fired already, as entry %d", tube, k + 1);
}

static void layout_rules(const rule_set *rules)
{
    const ld_tubes *tubes = &rules->model->tubes;
    const ld_layout *layout = &tubes->layout;
    int count = layout->rows * layout->columns;
    if (count > 1 && tubes->section_count > 0 && layout->pitch <= 2 * tubes->section[0].bore_radius)
        report_broken(rules, "tubes.layout.pitch", 0,
                      "%g m: %d tubes with a bore of %g m in diameter would overlap", layout->pitch,
                      count, 2 * tubes->section[0].bore_radius);
    if (count > LD_MAX_TUBES)
        report_broken(rules, "tubes.layout", 0, "%d tubes; at most %d are allowed", count,
                      LD_MAX_TUBES);
    for (int i = 0; i < tubes->empty_count; i++) {
        if (tubes->empty[i] > count)
            report_broken(rules, "tubes.empty.#", i + 1, "%d; the layout has tubes 1 to %d",
                          tubes->empty[i], count);
        for (int k = 0; k < i; k++)
            if (tubes->empty[i] == tubes->empty[k])
                report_broken(rules, "tubes.empty.#", i + 1, "%d is entry %d already",
                              tubes->empty[i], k + 1);
    }
    for (int i = 0; i < rules->model->firing_count; i++)
        firing_rule(rules, i, count);
}

static void modes_rules(const rule_set *rules)
{
    const ld_modes *modes = &rules->model->tubes.modes;
    if (modes->bending > modes->elements)
        report_broken(rules, "tubes.modes.bending", 0, "%d modes need at least %d elements, not %d",
                      modes->bending, modes->bending, modes->elements);
    if (modes->torsion > modes->elements)
        report_broken(rules, "tubes.modes.torsion", 0, "%d modes need at least %d elements, not %d",
                      modes->torsion, modes->torsion, modes->elements);
    if (modes->axial > modes->elements)
        report_broken(rules, "tubes.modes.axial", 0, "%d modes need at least %d elements, not %d",
                      modes->axial, modes->axial, modes->elements);
}

// Stiffness of a support in a direction; of one that it holds rigidly a large one.
static double stiffness_of(const ld_support *support, ld_clamp direction)
{
    if (support_clamps(support, direction))
        return 1e20;
    return support_spring(support, direction);
}

// Whether a beam on these springs is held against translation and tilt in one plane: the 2 x 2
// stiffness [sum k, sum k x; sum k x, sum k x^2 + sum r] must be regular.
static bool plane_held(const ld_tubes *tubes, int along, int about)
{
    double k0 = 0, k1 = 0, k2 = 0, r = 0;
    for (int i = 0; i < tubes->support_count; i++) {
        const ld_support *s = &tubes->support[i];
        double k = stiffness_of(s, (ld_clamp)(LD_CLAMP_X + along));
        k0 += k;
        k1 += k * s->at;
        k2 += k * s->at * s->at;
        r += stiffness_of(s, (ld_clamp)(LD_CLAMP_ROLL + about));
    }
    return !(k0 * (k2 + r) - k1 * k1 <= 1e-12 * k0 * (k2 + r));
}

// A support has springs, or directions that it holds rigidly.
static void clamped_rule(const rule_set *rules, int i)
{
    const ld_support *support = &rules->model->tubes.support[i];
    if (isnan(support->stiffness[0]) && !support->clamped)
        report_broken(rules, "tubes.supports.#.stiffness", i + 1,
                      "missing; expected three numbers and one unit of N/m, >= 0 N/m");
    if (support->clamped && (model_has_vehicle(rules->model) || model_has_multibody(rules->model)))
        report_broken(
            rules, "tubes.supports.#.clamped", i + 1,
            "requires a base whose motion is given; on a vehicle or on bodies use stiff springs");
    if (support->clamped && rules->model->run.formulation == LD_FORMULATION_OVERALL)
        report_broken(rules, "tubes.supports.#.clamped", i + 1,
                      "requires run.formulation: reduced; the overall form has springs only");
    for (int k = 0; k < i && support->clamped; k++)
        if (support[k - i].clamped && support[k - i].at == support->at)
            report_broken(rules, "tubes.supports.#.clamped", i + 1,
                          "support %d is at the station %g m already", k + 1, support->at);
}

// Directions held rigidly must be fewer than what tube and modes can follow.
static void clamps_rules(const rule_set *rules)
{
    static const struct {
        ld_clamp first, second; // value and slope of a line
        int rigid;
        const char *what;
    } line[] = {
        {LD_CLAMP_X, LD_CLAMP_X, 1, "x"},
        {LD_CLAMP_ROLL, LD_CLAMP_ROLL, 1, "roll"},
        {LD_CLAMP_Y, LD_CLAMP_PITCH, 2, "y and pitch"},
        {LD_CLAMP_Z, LD_CLAMP_YAW, 2, "z and yaw"},
    };
    const ld_tubes *tubes = &rules->model->tubes;
    const int modes[] = {tubes->modes.axial, tubes->modes.torsion, tubes->modes.bending,
                         tubes->modes.bending};
    int stations = 0, all = 0;
    for (int i = 0; i < tubes->support_count; i++) {
        stations += tubes->support[i].clamped != 0;
        for (int k = 0; k < LD_CLAMPS; k++)
            all += support_clamps(&tubes->support[i], (ld_clamp)k);
    }
    if (stations > LD_MAX_CLAMPED_STATIONS || all > LD_MAX_CLAMPED)
        report_broken(rules, "tubes.supports", 0,
                      "%d clamped stations hold %d directions; at most %d and %d are allowed",
                      stations, all, LD_MAX_CLAMPED_STATIONS, LD_MAX_CLAMPED);
    for (int l = 0; l < 4; l++) {
        int held = 0;
        for (int i = 0; i < tubes->support_count; i++) {
            held += support_clamps(&tubes->support[i], line[l].first);
            if (line[l].second != line[l].first)
                held += support_clamps(&tubes->support[i], line[l].second);
        }
        if (held > line[l].rigid + modes[l])
            report_broken(
                rules, "tubes.supports", 0,
                "they clamp %d directions of %s, which a tube of %d modes there cannot follow: "
                "at most %d",
                held, line[l].what, modes[l], line[l].rigid + modes[l]);
    }
}

// The tube recoils on slides, or it is held along x: not both.
static void recoil_rules(const rule_set *rules)
{
    const ld_tubes *tubes = &rules->model->tubes;
    int holds = 0;
    for (int i = 0; i < tubes->support_count; i++)
        if (!tubes->support[i].recoil.present &&
            (support_spring(&tubes->support[i], LD_CLAMP_X) > 0 ||
             support_clamps(&tubes->support[i], LD_CLAMP_X)))
            holds = i + 1;
    for (int i = 0; i < tubes->support_count; i++) {
        const ld_support *support = &tubes->support[i];
        if (!support->recoil.present)
            continue;
        if (support_clamps(support, LD_CLAMP_X))
            report_broken(rules, "tubes.supports.#.recoil", i + 1,
                          "this support clamps x, along which the tube would recoil");
        else if (support_spring(support, LD_CLAMP_X) == 0)
            report_broken(rules, "tubes.supports.#.stiffness", i + 1,
                          "0 N/m along x, which the stops of its recoil require");
        if (holds)
            report_broken(
                rules, "tubes.supports.#.recoil", i + 1,
                "support %d holds the tube along x; remove its stiffness there, or give it a "
                "recoil too",
                holds);
    }
}

static void support_rules(const rule_set *rules)
{
    const ld_tubes *tubes = &rules->model->tubes;
    const char *path = "tubes.supports";
    double along = 0, about = 0;
    for (int i = 0; i < tubes->support_count; i++) {
        station_rule(rules, "tubes.supports.#.at", i + 1, tubes->support[i].at);
        along += stiffness_of(&tubes->support[i], LD_CLAMP_X);
        about += stiffness_of(&tubes->support[i], LD_CLAMP_ROLL);
        clamped_rule(rules, i);
    }
    clamps_rules(rules);
    if (rules->model->run.start != LD_START_EQUILIBRIUM)
        return;
    if (along <= 0)
        report_broken(rules, path, 0, "they do not hold the tube along x: no stiffness there");
    if (about <= 0)
        report_broken(rules, path, 0,
                      "they do not hold the tube against roll: no rotational_stiffness about x");
    if (!plane_held(tubes, 1, 2))
        report_broken(rules, path, 0,
                      "they do not hold the tube in the x-y plane: give stiffness along y at two "
                      "stations, or at one with rotational_stiffness about z");
    if (!plane_held(tubes, 2, 1))
        report_broken(rules, path, 0,
                      "they do not hold the tube in the x-z plane: give stiffness along z at two "
                      "stations, or at one with rotational_stiffness about y");
}

static void tail_rules(const rule_set *rules)
{
    const ld_tail *tail = &rules->model->tubes.tail;
    if (tail->mass == 0 && (tail->inertia[0] > 0 || tail->inertia[1] > 0 || tail->inertia[2] > 0))
        report_broken(rules, "tubes.tail.inertia", 0, "given for a tail without mass");
    else
        inertia_rule(rules, "tubes.tail.inertia", tail->inertia, NULL);
}

static void slot_rules(const rule_set *rules)
{
    const ld_slot *slot = &rules->model->tubes.slot;
    if (slot->kind == LD_SLOT_HELIX)
        rising_rule(rules, "tubes.slot.angle.#", &slot->angle, "m", false);
}

static bool masses_fall(const rule_set *rules, const char *path, const ld_table *table)
{
    for (size_t k = 1; k < table->rows; k++) {
        const double *row = &table->data[k * table->columns], *before = row - table->columns;
        if (row[MASSES_MASS] > before[MASSES_MASS]) {
            report_broken(rules, path, (int)k + 1, "%g kg is more than the %g kg of the row before",
                          row[MASSES_MASS], before[MASSES_MASS]);
            return false;
        }
    }
    return true;
}

// A table of masses ends no later than the thrust.
static void end_of_masses_rule(const rule_set *rules, const char *path, const ld_table *table,
                               const ld_table *thrust)
{
    double end = thrust->rows ? thrust->data[(thrust->rows - 1) * thrust->columns] : 0;
    double last = table->data[(table->rows - 1) * table->columns];
    if (last > end)
        report_broken(
            rules, path, 0,
            "ends at %g s, after the thrust, at %g s; give the thrust a last row of 0 N there",
            last, end);
}

// At every row the rocket must be a body, lighter than before or as heavy.
static void table_of_masses_rows(const rule_set *rules, const ld_table *table)
{
    const char *path = "rocket.motor.masses.#";
    const ld_rocket *rocket = &rules->model->rocket;
    if (!masses_fall(rules, path, table))
        return;
    for (size_t k = 0; k < table->rows; k++) {
        char row_path[64];
        snprintf(row_path, sizeof row_path, "rocket.motor.masses.%zu", k + 1);
        ld_mass_data now = masses_at(rocket, k);
        if (now.mass <= 0) {
            report_broken(rules, path, (int)k + 1, "leaves no mass of the rocket");
            return;
        }
        if (now.inertia[0] <= 0 || now.inertia[1] <= 0 || now.inertia[2] <= 0) {
            report_broken(
                rules, path, (int)k + 1,
                "leaves the rocket moments of inertia of %g %g %g kg.m2 about its mass centre",
                now.inertia[0], now.inertia[1], now.inertia[2]);
            return;
        }
        inertia_rule(rules, row_path, now.inertia, rocket->products);
    }
}

static void table_of_masses_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    const ld_table *table = &model->rocket.motor.masses, *thrust = &model->rocket.motor.thrust;
    const char *path = "rocket.motor.masses";
    rising_rule(rules, "rocket.motor.masses.#", table, "s", false);
    if (!model->completed.empty_mass || !model->completed.empty_center[0] ||
        !model->completed.empty_inertia[0])
        report_broken(rules, "rocket.empty", 0,
                      "given together with motor.masses, whose last row sets it; give one of them");
    if (!model->completed.propellant)
        report_broken(rules, "rocket.propellant", 0,
                      "given together with motor.masses, which sets it; give one of them");
    end_of_masses_rule(rules, path, table, thrust);
    if (table->data[MASSES_MASS] > model->rocket.full.mass * (1 + 1e-9))
        report_broken(rules, "rocket.motor.masses.1", 0,
                      "%g kg is more than the whole rocket, of %g kg", table->data[MASSES_MASS],
                      model->rocket.full.mass);
    else
        table_of_masses_rows(rules, table);
}

static void mass_rules(const rule_set *rules)
{
    const ld_rocket *rocket = &rules->model->rocket;
    bool by_table = rocket->motor.masses.rows > 0;
    if (rocket->empty.mass > rocket->full.mass && !rocket->motor.absent && !by_table)
        report_broken(rules, "rocket.empty.mass", 0, "%g kg is more than the full mass, %g kg",
                      rocket->empty.mass, rocket->full.mass);
    if (rocket->empty.mass + rocket->mass_error <= 0 && (rocket->empty.mass > 0 || !by_table))
        report_broken(rules, "rocket.mass_error", 0, "%g kg leaves no empty mass of %g kg",
                      rocket->mass_error, rocket->empty.mass);
    if (rocket->propellant >= rocket->full.mass + rocket->mass_error && !by_table)
        report_broken(rules, "rocket.propellant", 0,
                      "%g kg must be less than the full mass with its error, %g kg",
                      rocket->propellant, rocket->full.mass + rocket->mass_error);
    inertia_rule(rules, "rocket.inertia", rocket->full.inertia, rocket->products);
    if (by_table)
        table_of_masses_rules(rules);
    else
        inertia_rule(rules, "rocket.empty.inertia", rocket->empty.inertia, rocket->products);
}

// Enough must be left of the rocket by all that falls off, full and empty.
static void falling_rules(const rule_set *rules, int i)
{
    const ld_rocket *rocket = &rules->model->rocket;
    const ld_mass_data *data[] = {&rocket->full, &rocket->empty};
    const ld_adaptor *adaptor = &rocket->adaptor[i];
    if (!adaptor->falls_off.present)
        return;
    if (rocket->start_at + adaptor->at >= guide_end(&rules->model->tubes, adaptor))
        report_broken(rules, "rocket.adaptors.#.falls_off", i + 1,
                      "the adaptor starts beyond its end, where it would have fallen off");
    for (int k = 0; k < 2; k++)
        for (int axis = 0; axis < 3; axis++) {
            double mass, moment = masses_left(rocket, data[k], axis, &mass);
            if (mass > 0 && moment > 0)
                continue;
            report_broken(rules, "rocket.adaptors.#.falls_off", i + 1,
                          "what falls off leaves the %s rocket %g kg and %g kg m2 about %c",
                          k ? "empty" : "full", mass, moment, 'x' + axis);
            return;
        }
}

// The rocket is out with its rear adaptor, so none leaves after that.
static void leaving_rules(const rule_set *rules, int i)
{
    const ld_model *model = rules->model;
    const ld_tubes *tubes = &model->tubes;
    const ld_rocket *rocket = &model->rocket;
    const ld_adaptor *adaptor = &rocket->adaptor[i];
    double last = guide_end(tubes, &rocket->adaptor[0]);
    if (adaptor->leaves_at > tubes->length)
        report_broken(rules, "rocket.adaptors.#.leaves_at", i + 1,
                      "%g m is beyond the tube's tip at %g m", adaptor->leaves_at, tubes->length);
    else if (i == 0 && adaptor->leaves_at <= rocket->start_at)
        report_broken(rules, "rocket.adaptors.1.leaves_at", 0,
                      "%g m is not beyond the start at %g m", adaptor->leaves_at, rocket->start_at);
    else if (guide_exit_station(tubes, adaptor) > last + GUIDE_TOGETHER)
        report_broken(rules, "rocket.adaptors.#.leaves_at", i + 1,
                      "the rear adaptor, at its end at %g m, would leave before this one; expected "
                      "at most %g m",
                      last, last + adaptor->at);
}

static void adaptor_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    const ld_rocket *rocket = &model->rocket;
    for (int i = 0; i < rocket->adaptor_count; i++) {
        const ld_adaptor *adaptor = &rocket->adaptor[i];
        if (i == 0 && adaptor->at > 0)
            report_broken(rules, "rocket.adaptors.1.at", 0,
                          "%g m; the first adaptor is the rear one, at 0 m", adaptor->at);
        for (int j = 0; j < i; j++)
            if (adaptor->at == rocket->adaptor[j].at)
                report_broken(rules, "rocket.adaptors.#.at", i + 1,
                              "%g m is already the position of adaptor %d", adaptor->at, j + 1);
        for (int j = 0; j < i; j++) {
            // a study's database does not distinguish capital letters from others in a column's
            // name
            const char *other = rocket->adaptor[j].name;
            if (adaptor->name[0] && strcasecmp(adaptor->name, other) == 0)
                report_broken(rules, "rocket.adaptors.#.name", i + 1,
                              "\"%s\" is already the name of adaptor %d", other, j + 1);
        }
    }
    if (rocket->start_at >= model->tubes.length)
        report_broken(rules, "rocket.start_at", 0, "%g m is not before the tube's tip at %g m",
                      rocket->start_at, model->tubes.length);
    for (int i = 0; i < rocket->adaptor_count; i++) {
        leaving_rules(rules, i);
        falling_rules(rules, i);
    }
}

// Adaptors that are held on the axis exactly.
static void held_rules(const rule_set *rules)
{
    const ld_rocket *rocket = &rules->model->rocket;
    if (rocket->adaptor_count > 2)
        report_broken(rules, "rocket.contact.law", 0,
                      "ideal holds at most two adaptors on the axis; this rocket has %d",
                      rocket->adaptor_count);
    if (rocket->contact.friction > 0)
        report_broken(rules, "rocket.contact.friction", 0,
                      "%g; adaptors of the law ideal are held without friction",
                      rocket->contact.friction);
    if (!rocket->lock.present && isnan(rocket->contact.stiffness))
        report_broken(rules, "rocket.contact.stiffness", 0,
                      "missing; without a lock the breech supports the rocket with this stiffness");
}

static void contact_rules(const rule_set *rules)
{
    const ld_contact *contact = &rules->model->rocket.contact;
    rising_rule(rules, "rocket.contact.drag.#", &contact->drag, "m", false);
    rising_rule(rules, "rocket.contact.drag_over_speed.#", &contact->drag_over_speed, "m/s", false);
    if ((int)contact->law < 0)
        return;
    if (contact_has(contact->law, LD_CONTACT_HELD))
        held_rules(rules);
    else if (isnan(contact->stiffness))
        report_broken(rules, "rocket.contact.stiffness", 0,
                      "missing; expected a number with a unit of N/m, > 0 N/m");
    bool linear = contact_has(contact->law, LD_CONTACT_LINEAR);
    if (linear && contact->exponent > 1)
        report_broken(rules, "rocket.contact.exponent", 0,
                      "%g; this law is linear, its exponent is 1", contact->exponent);
    if (!linear && contact->damping > 0)
        report_broken(
            rules, "rocket.contact.damping", 0,
            "requires the law kelvin-voigt or bilateral; this law damps by its restitution");
}

// Of the motor at `path`.
static void thrust_rules(const rule_set *rules, const char *path, const ld_table *thrust)
{
    double impulse = 0, greatest = 0;
    char whole[64], row[64];
    snprintf(whole, sizeof whole, "%s.thrust", path);
    snprintf(row, sizeof row, "%s.thrust.#", path);
    if (thrust->rows == 0)
        return;
    rising_rule(rules, row, thrust, "s", true);
    if (thrust->data[0] > 0)
        report_broken(rules, row, 1, "the first time must be 0 s, not %g s", thrust->data[0]);
    for (size_t i = 1; i < thrust->rows; i++) {
        const double *a = &thrust->data[2 * (i - 1)], *b = &thrust->data[2 * i];
        impulse += (b[0] - a[0]) * (fmax(a[1], 0) + fmax(b[1], 0)) / 2;
        greatest = fmax(greatest, fmax(a[1], b[1]));
    }
    for (size_t i = 0; i < thrust->rows; i++)
        if (thrust->data[2 * i + 1] < -0.1 * greatest) {
            report_broken(
                rules, row, (int)i + 1,
                "%g N; at most a tenth of the greatest thrust may be measured below 0, as 0",
                thrust->data[2 * i + 1]);
            return;
        }
    if (impulse == 0)
        report_broken(rules, whole, 0, "its impulse is 0 N.s");
    if (impulse > 1e100)
        report_broken(rules, whole, 0, "its impulse is %g N.s, out of range", impulse);
}

static void side_noise_rules(const rule_set *rules, const ld_side_noise *noise)
{
    const char *path = "rocket.motor.side_force.fluctuation.spectrum";
    const ld_table *spectrum = &noise->spectrum;
    double power = 0;
    rising_rule(rules, "rocket.motor.side_force.fluctuation.deviation.#", &noise->deviation, "s",
                false);
    if (noise->form != LD_SPECTRUM_TABLE)
        return;
    rising_rule(rules, "rocket.motor.side_force.fluctuation.spectrum.#", spectrum, "Hz", false);
    for (size_t i = 0; i < spectrum->rows; i++)
        power = fmax(power, spectrum->data[2 * i + 1]);
    if (spectrum->rows < 2)
        report_broken(rules, path, 0, "needs at least two rows");
    else if (!(power > 0))
        report_broken(rules, path, 0, "has no power");
}

static void side_force_rules(const rule_set *rules)
{
    const ld_motor *motor = &rules->model->rocket.motor;
    const ld_side_force *side = &motor->side_force;
    rising_rule(rules, "rocket.motor.nozzle.#", &motor->nozzle, "s", false);
    if (!side->present)
        return;
    if (side->force.rows == 0 && !side->noise.present)
        report_broken(rules, "rocket.motor.side_force", 0, "needs force, fluctuation or both");
    rising_rule(rules, "rocket.motor.side_force.force.#", &side->force, "s", false);
    if (side->noise.present)
        side_noise_rules(rules, &side->noise);
}

static void further_masses_rules(const rule_set *rules, const char *motor,
                                 const ld_further_motor *given)
{
    char whole[64], row[64];
    snprintf(whole, sizeof whole, "%s.masses", motor);
    snprintf(row, sizeof row, "%s.masses.#", motor);
    rising_rule(rules, row, &given->masses, "s", false);
    masses_fall(rules, row, &given->masses);
    end_of_masses_rule(rules, whole, &given->masses, &given->thrust);
    if (rules->model->rocket.motor.masses.rows == 0)
        report_broken(rules, whole, 0, "requires rocket.motor.masses");
}

static void further_motor_rules(const rule_set *rules)
{
    const ld_rocket *rocket = &rules->model->rocket;
    const ld_mass_data *empty = &rocket->empty;
    bool losing = false;
    for (int i = 0; i < rocket->further_motor_count; i++) {
        char path[48];
        snprintf(path, sizeof path, "rocket.further_motors.%d", i + 1);
        thrust_rules(rules, path, &rocket->further_motor[i].thrust);
        if (rocket->further_motor[i].masses.rows > 0)
            further_masses_rules(rules, path, &rocket->further_motor[i]);
        losing |= rocket->further_motor[i].masses.rows > 0;
    }
    if (losing && empty->mass <= 0)
        report_broken(rules, "rocket.further_motors", 0,
                      "their masses leave no mass of the rocket");
    else if (losing && !(empty->inertia[0] > 0 && empty->inertia[1] > 0 && empty->inertia[2] > 0))
        report_broken(
            rules, "rocket.further_motors", 0,
            "their masses leave moments of inertia of %g %g %g kg.m2 about the mass centre",
            empty->inertia[0], empty->inertia[1], empty->inertia[2]);
    if (rocket->further_motor_count > 0 && rocket->motor.absent)
        report_broken(rules, "rocket.further_motors", 0, "requires rocket.motor");
    if (rocket->further_motor_count > 0 && rocket->motor.jet_damping == LD_JET_DAMPING_YES)
        report_broken(rules, "rocket.motor.jet_damping", 0, "not with further motors");
}

static void initial_shape_rules(const rule_set *rules)
{
    const ld_tubes *tubes = &rules->model->tubes;
    const ld_initial_shape *shape = &tubes->initial_shape;
    const ld_table *table = &shape->offsets;
    rising_rule(rules, "tubes.initial_shape.offsets.#", table, "m", false);
    for (int i = 0; i < shape->joint_count; i++)
        station_rule(rules, "tubes.initial_shape.joints.#.at", i + 1, shape->joint[i].at);
    if (shape->present && table->rows == 0 && !shape->random.present && shape->joint_count == 0)
        report_broken(rules, "tubes.initial_shape", 0, "needs offsets, random or joints");
    if (table->rows == 0 && (shape->accuracy[0] > 0 || shape->accuracy[1] > 0))
        report_broken(rules, "tubes.initial_shape.accuracy", 0, "needs offsets");
    if (!shape->present || table->rows == 0)
        return;
    double last = table->data[table->columns * (table->rows - 1)];
    if (table->data[0] > 0)
        report_broken(rules, "tubes.initial_shape.offsets.1", 0,
                      "begins at %g m; the rear end is at 0 m", table->data[0]);
    if (last < tubes->length)
        report_broken(rules, "tubes.initial_shape.offsets", 0, "ends at %g m; the tip is at %g m",
                      last, tubes->length);
}

static void wind_drag_rules(const rule_set *rules)
{
    const ld_tubes *tubes = &rules->model->tubes;
    for (int i = 0; i < tubes->wind_drag_count; i++) {
        const ld_wind_drag *given = &tubes->wind_drag[i];
        station_rule(rules, "tubes.wind_drag.#.to", i + 1, given->to);
        if (given->to <= given->from)
            report_broken(rules, "tubes.wind_drag.#.to", i + 1,
                          "%g m does not lie beyond from, %g m", given->to, given->from);
    }
    if (tubes->wind_drag_count > 0 &&
        rules->model->environment.atmosphere.kind == LD_ATMOSPHERE_NONE)
        report_broken(rules, "tubes.wind_drag", 0, "without an atmosphere the guide has no drag");
}

static void over_time_rules(const rule_set *rules)
{
    const ld_table *table = &rules->model->tubes.pressure.over_time;
    rising_rule(rules, "tubes.pressure.over_time.#", table, "s", true);
    if (table->rows > 0 && table->data[0] > 0)
        report_broken(rules, "tubes.pressure.over_time.1", 0,
                      "the first time must be 0 s, not %g s", table->data[0]);
    if (table->rows == 1)
        report_broken(rules, "tubes.pressure.over_time", 0, "needs at least two rows");
}

static void over_travel_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    const ld_table *table = &model->tubes.pressure.over_travel;
    double way = guide_end(&model->tubes, model->rocket.adaptor) - model->rocket.start_at;
    rising_rule(rules, "tubes.pressure.over_travel.#", table, "m", false);
    if (table->rows == 0)
        return;
    double last = table->data[2 * (table->rows - 1)];
    if (table->data[0] > 0)
        report_broken(rules, "tubes.pressure.over_travel.1", 0,
                      "the first travel must be 0 m, not %g m", table->data[0]);
    if (last < way)
        report_broken(rules, "tubes.pressure.over_travel", 0,
                      "ends at %g m; the rocket travels %g m to its exit", last, way);
}

static void pressure_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    const ld_pressure *pressure = &model->tubes.pressure;
    if (model->rocket.motor.absent && !pressure->present)
        report_broken(rules, "rocket.motor", 0, "a launch requires a motor or tubes.pressure");
    if (model->rocket.motor.absent && model_has_jet(model))
        report_broken(rules, "platform.jet", 0, "requires a motor");
    if (model->rocket.motor.absent && model_has_guide_jet(model))
        report_broken(rules,
                      model->tubes.jet_face.present    ? "tubes.jet_face"
                      : model->tubes.deflector.present ? "tubes.deflector"
                                                       : "tubes.jet",
                      0, "requires a motor");
    if (!pressure->present)
        return;
    if (model_has_surfaces(model))
        report_broken(rules, "tubes.pressure", 0,
                      "requires a bore; a guide of surfaces is open behind the rocket");
    if (pressure->form == LD_PRESSURE_OVER_TIME)
        over_time_rules(rules);
    if (pressure->form == LD_PRESSURE_OVER_TRAVEL)
        over_travel_rules(rules);
    double gas = pressure->scale * pressure->pressure;
    if (pressure->form == LD_PRESSURE_OF_GAS && gas <= pressure->ambient)
        report_broken(rules, "tubes.pressure.pressure", 0,
                      "comes to %g Pa, no more than the ambient pressure, %g Pa", gas,
                      pressure->ambient);
}

static void coupling_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    bool parts = model_has_vehicle(model) || model_has_multibody(model);
    if (model->run.coupling_step > 0 && !parts && (int)model->base.kind >= 0)
        report_broken(rules, "run.coupling", 0,
                      "requires base.kind: vehicle or multibody; other bases have no subsystems to "
                      "couple");
    const ld_mechanism *given = &model->base.mechanism;
    if (model->run.coupling_step > 0 && model_has_multibody(model) &&
        mechanism_body(given, model->tubes.on) >= given->body_count)
        report_broken(rules, "run.coupling", 0,
                      "requires the tubes on a body: the supports on a beam would exchange a frame "
                      "each");
}

// Heights rise, pressures fall, and no row has as much vapour as air.
static void air_profile_rules(const rule_set *rules)
{
    static const char path[] = "environment.atmosphere.profile.#";
    const ld_table *profile = &rules->model->environment.atmosphere.profile;
    rising_rule(rules, path, profile, "m", false);
    for (size_t i = 0; i < profile->rows; i++) {
        const double *row = profile->data + i * profile->columns;
        if (i > 0 && row[1] >= row[1 - (int)profile->columns])
            report_broken(rules, path, (int)i + 1, "%g Pa is not below %g Pa in the row before",
                          row[1], row[1 - (int)profile->columns]);
        if (profile->columns == 4 && vapour_pressure(row[2], row[3]) > 0.5 * row[1])
            report_broken(
                rules, path, (int)i + 1,
                "a humidity of %g at %g K is a vapour pressure of %g Pa, too much for air of "
                "%g Pa",
                row[3], row[2], vapour_pressure(row[2], row[3]), row[1]);
    }
}

static void environment_rules(const rule_set *rules)
{
    const ld_environment *environment = &rules->model->environment;
    const ld_wind *wind = &environment->wind;
    const ld_atmosphere *air = &environment->atmosphere;
    if (air->temperature_offset != 0 && air->kind != LD_ATMOSPHERE_US1976 &&
        air->kind != LD_ATMOSPHERE_PROFILE)
        report_broken(rules, "environment.temperature_offset", 0,
                      "requires the atmosphere us1976 or a profile");
    if (air->kind == LD_ATMOSPHERE_PROFILE)
        air_profile_rules(rules);
    if (!wind->present)
        return;
    rising_rule(rules, "environment.wind.profile.#", &wind->profile, "m", false);
    if (wind->profile.rows > 0 && wind->speed != 0)
        report_broken(rules, "environment.wind.speed", 0,
                      "given together with profile; give one of them");
}

static void brakes_rules(const rule_set *rules)
{
    const ld_air_brakes *brakes = &rules->model->rocket.air_brakes;
    if (!brakes->present)
        return;
    if (rules->model->environment.atmosphere.kind == LD_ATMOSPHERE_NONE)
        report_broken(rules, "rocket.air_brakes", 0, "without an atmosphere they have no drag");
    rising_rule(rules, "rocket.air_brakes.over_time.#", &brakes->over_time, "s", false);
    rising_rule(rules, "rocket.air_brakes.over_height.#", &brakes->over_height, "m", false);
}

// The rocket without the canopy, which is a point of it until it opens.
static void canopy_rules(const rule_set *rules, int i)
{
    const ld_rocket *rocket = &rules->model->rocket;
    const ld_canopy *one = &rocket->parachute[i].canopy;
    double mass = rocket->empty.mass, rest = mass - one->mass, d[3];
    if (one->present != rocket->parachute[0].canopy.present)
        report_broken(rules, "rocket.parachutes.#.canopy", i + 1,
                      "parachute %s has %s; give one to all parachutes of a rocket, or to none",
                      rocket->parachute[0].name, one->present ? "none" : "one");
    if (!one->present)
        return;
    for (int k = 0; k < 3; k++)
        d[k] = one->at[k] - rocket->empty.center[k];
    if (!(rest > 0)) {
        report_broken(rules, "rocket.parachutes.#.canopy.mass", i + 1,
                      "%g kg is not below the rocket's empty mass of %g kg", one->mass, mass);
        return;
    }
    for (int k = 0; k < 3; k++) {
        double y = d[(k + 1) % 3], z = d[(k + 2) % 3];
        double taken = one->mass * mass / rest * (y * y + z * z);
        if (taken >= rocket->empty.inertia[k])
            report_broken(rules, "rocket.parachutes.#.canopy.at", i + 1,
                          "the canopy there has %g kg.m2 about the axis %c through the mass "
                          "centre, the whole rocket %g kg.m2",
                          taken, "xyz"[k], rocket -> empty.inertia[k]);
    }
    if (one->packed_area == 0 && one->ejection[0] == 0 && one->ejection[1] == 0 &&
        one->ejection[2] == 0)
        report_broken(rules, "rocket.parachutes.#.canopy", i + 1,
                      "nothing takes it away from the rocket; give ejection or packed_area");
}

static void filling_rules(const rule_set *rules, int i)
{
    const ld_parachute *one = &rules->model->rocket.parachute[i];
    bool by_way = one->filling_distance > 0;
    if (by_way && one->filling > 0)
        report_broken(rules, "rocket.parachutes.#.filling_distance", i + 1,
                      "is not allowed with filling; give one of them");
    if (one->filling_power != 1 && !by_way && one->filling == 0)
        report_broken(rules, "rocket.parachutes.#.filling_power", i + 1,
                      "requires filling or filling_distance, over which the drag area changes");
}

static void parachute_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    const ld_rocket *rocket = &model->rocket;
    if (rocket->parachute_count > 0 && model->environment.atmosphere.kind == LD_ATMOSPHERE_NONE)
        report_broken(rules, "rocket.parachutes", 0,
                      "without an atmosphere parachutes have no drag");
    for (int i = 0; i < rocket->parachute_count; i++) {
        const ld_parachute *one = &rocket->parachute[i];
        canopy_rules(rules, i);
        filling_rules(rules, i);
        if (one->trigger == LD_TRIGGER_HEIGHT && model->environment.ground == LD_GROUND_NONE)
            report_broken(rules, "rocket.parachutes.#.trigger", i + 1,
                          "without ground there is no height above it");
        for (int j = 0; j < i; j++)
            if (one->name[0] && strcasecmp(one->name, rocket->parachute[j].name) == 0)
                report_broken(rules, "rocket.parachutes.#.name", i + 1,
                              "\"%s\" is already the name of parachute %d", one->name, j + 1);
    }
}

static void line_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    const ld_line *one = &model->rocket.line;
    if (!one->present)
        return;
    if (model->environment.earth.kind != LD_EARTH_FLAT)
        report_broken(rules, "rocket.line", 0, "requires a flat Earth (environment.earth: flat)");
    if (model_firing_count(model) > 1)
        report_broken(rules, "rocket.line", 0, "requires a single rocket; this scenario fires %d",
                      model_firing_count(model));
    if (one->container_on == LD_LINE_ON_LAUNCHER && !model_has_launcher(model))
        report_broken(rules, "rocket.line.container_on", 0,
                      "a flight alone has no launcher; give `container_on: ground`");
    if (one->slack > 0 && !model_has_launcher(model))
        report_broken(rules, "rocket.line.slack", 0,
                      "a flight alone has no guide in which it would be drawn taut");
    if (one->slack >= one->length)
        report_broken(rules, "rocket.line.slack", 0, "%g m is not less than the line's %g m",
                      one->slack, one->length);
    if (one->breaking_force <= one->tension)
        report_broken(rules, "rocket.line.tension", 0,
                      "%g N is not below the breaking force of %g N", one->tension,
                      one->breaking_force);
    if (one->container_on == LD_LINE_ON_GROUND && model->environment.ground == LD_GROUND_PLANE &&
        one->container[1] < model->environment.ground_height)
        report_broken(rules, "rocket.line.container", 0, "y = %g m lies below the ground at %g m",
                      one->container[1], model->environment.ground_height);
}

static void end_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    if (model->run.end != LD_END_LANDING)
        return;
    if (model->environment.ground == LD_GROUND_NONE)
        report_broken(rules, "run.end", 0, "without ground there is no landing; give a time");
}

static void start_rules(const rule_set *rules)
{
    const ld_flight *flight = &rules->model->flight;
    const ld_earth *earth = &rules->model->environment.earth;
    int velocities =
        !isnan(flight->velocity[0]) + !isnan(flight->speed) + !isnan(flight->velocity_ned[0]);
    const double *q = flight->quaternion;
    if (isnan(flight->position[0]) == !flight->geodetic.present)
        report_broken(rules, "flight", 0, "needs one of position and geodetic");
    if (flight->geodetic.present && earth->kind == LD_EARTH_FLAT)
        report_broken(rules, "flight.geodetic", 0, "requires a round or wgs84 Earth");
    if (velocities != 1)
        report_broken(rules, "flight", 0, "needs one of velocity, speed and velocity_ned");
    if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0)
        report_broken(rules, "flight.quaternion", 0, "its norm is 0");
    if (!isnan(q[0]) && flight->attitude != LD_ATTITUDE_QUATERNION &&
        (flight->yaw != 0 || flight->heading != 0 || flight->pitch != 0 || flight->roll != 0))
        report_broken(rules, "flight.quaternion", 0,
                      "given together with attitude; give one of them");
}

static void launch_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    base_rules(rules);
    vehicle_rules(rules);
    mechanism_rules(rules);
    layout_rules(rules);
    section_rules(rules);
    derived_rules(rules);
    for (int i = 0; i < model->tubes.point_mass_count; i++)
        station_rule(rules, "tubes.point_masses.#.at", i + 1, model->tubes.point_mass[i].at);
    load_rules(rules);
    modes_rules(rules);
    tail_rules(rules);
    support_rules(rules);
    recoil_rules(rules);
    slot_rules(rules);
    initial_shape_rules(rules);
    wind_drag_rules(rules);
    adaptor_rules(rules);
    guide_rules(rules);
    contact_rules(rules);
    pressure_rules(rules);
}

// Plans whose samples come in replicates, of which some have so many points.
static void replicate_rules(const rule_set *rules)
{
    const ld_scatter *scatter = &rules->model->scatter;
    if (!plan_is_replicated(scatter) || scatter->replicates < 1)
        return;
    const int points = scatter->samples / scatter->replicates;
    if (scatter->samples % scatter->replicates != 0)
        report_broken(rules, "scatter.replicates", 0,
                      "%d samples are not a multiple of %d replicates", scatter->samples,
                      scatter->replicates);
    else if (plan_has_points(scatter) && (points & (points - 1)) != 0)
        report_broken(rules, "scatter.samples", 0,
                      "Sobol points require a power of two in each replicate, found %d", points);
    if (scatter->until_count > 0 && scatter->replicates < 2)
        report_broken(rules, "scatter.until", 0,
                      "one %s gives no interval; set replicates, or plan: random",
                      scatter->plan == LD_PLAN_LHS ? "hypercube" : "scrambling");
}

static void scatter_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    const ld_scatter *scatter = &model->scatter;
    if (!scatter->present)
        return;
    replicate_rules(rules);
    if (plan_has_rows(scatter) && scatter->until_count > 0)
        report_broken(rules, "scatter.until", 0,
                      "the plans saltelli and morris run all samples; remove the rule");
    if (plan_has_rows(scatter) && scatter->correlated_count > 0)
        report_broken(rules, "scatter.correlated", 0,
                      "the plans saltelli and morris require independent factors");
}

void model_check_rules(const ld_model *model, rule_report *report, void *self)
{
    const rule_set all = {model, report, self};
    if (model_has_launcher(model))
        launch_rules(&all);
    else
        start_rules(&all);
    mass_rules(&all);
    thrust_rules(&all, "rocket.motor", &model->rocket.motor.thrust);
    side_force_rules(&all);
    further_motor_rules(&all);
    environment_rules(&all);
    aerodynamics_rules(&all);
    brakes_rules(&all);
    parachute_rules(&all);
    line_rules(&all);
    end_rules(&all);
    coupling_rules(&all);
    scatter_rules(&all);
}
