// Rules of the air on the rocket.
#include "model/model.h"
#include "model/parts.h"
#include "model/rules/rules.h"

#include <stdio.h>
#include <strings.h>

// The part of the rocket that has come out of its tube.
static void emerged_rules(const rule_set *rules)
{
    const ld_rocket *rocket = &rules->model->rocket;
    const ld_aerodynamics *air = &rocket->aerodynamics;
    if (!air->present || !air->emerged.present)
        return;
    if (!model_has_launcher(rules->model))
        report_broken(rules, "rocket.aerodynamics.emerged", 0,
                      "requires a launcher; a scenario of flight only has no tube");
    if (model_has_surfaces(rules->model))
        report_broken(rules, "rocket.aerodynamics.emerged", 0,
                      "requires a bore; on a guide of surfaces the air acts on the whole rocket");
    if (air->model == LD_AERODYNAMICS_BODY && isnan(air->emerged.diameter))
        report_broken(rules, "rocket.aerodynamics.emerged.diameter", 0,
                      "missing; a plain body has no reference_diameter in its place");
    for (int i = 0; i < rocket->adaptor_count; i++)
        if (air->emerged.nose < rocket->adaptor[i].at) {
            report_broken(rules, "rocket.aerodynamics.emerged.nose", 0,
                          "%g m lies behind adaptor \"%s\" at %g m", air->emerged.nose,
                          rocket->adaptor[i].name, rocket->adaptor[i].at);
            return;
        }
}

// A table over the Mach number: rising from 0, and no single row where one value is not meant.
static void mach_rule(const rule_set *rules, const char *path, const ld_table *table, bool one_row)
{
    char row[96];
    if (table->rows == 0)
        return;
    snprintf(row, sizeof row, "%s.#", path);
    rising_rule(rules, row, table, "Mach", false);
    snprintf(row, sizeof row, "%s.1", path);
    if (table->data[0] > 0)
        report_broken(rules, row, 0, "the first Mach number must be 0, not %g", table->data[0]);
    if (table->rows == 1 && !one_row)
        report_broken(rules, path, 0, "needs at least two rows");
}

static void surface_rules(const rule_set *rules, const ld_aerodynamics *air)
{
    char path[64];
    mach_rule(rules, "rocket.aerodynamics.axial", &air->axial, true);
    for (int i = 0; i < air->surface_count; i++) {
        const ld_air_surface *surface = &air->surface[i];
        for (int j = 0; j < i; j++)
            if (surface->name[0] && strcasecmp(surface->name, air->surface[j].name) == 0)
                report_broken(rules, "rocket.aerodynamics.surfaces.#.name", i + 1,
                              "\"%s\" is already the name of surface %d", air->surface[j].name,
                              j + 1);
        if (surface->kind != LD_AIR_COEFFICIENTS)
            continue;
        snprintf(path, sizeof path, "rocket.aerodynamics.surfaces.%d.slope", i + 1);
        mach_rule(rules, path, &surface->slope, true);
        snprintf(path, sizeof path, "rocket.aerodynamics.surfaces.%d.roll_forcing", i + 1);
        mach_rule(rules, path, &surface->roll_forcing, true);
        snprintf(path, sizeof path, "rocket.aerodynamics.surfaces.%d.roll_damping", i + 1);
        mach_rule(rules, path, &surface->roll_damping, true);
    }
}

void aerodynamics_rules(const rule_set *rules)
{
    const ld_aerodynamics *air = &rules->model->rocket.aerodynamics;
    emerged_rules(rules);
    if (air->present && air->model == LD_AERODYNAMICS_TABLE)
        mach_rule(rules, "rocket.aerodynamics.table", &air->table, false);
    if (air->present && air->model == LD_AERODYNAMICS_SURFACES)
        surface_rules(rules, air);
}
