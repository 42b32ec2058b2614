// Rules of what guides the rocket: a bore with its clearances, or surfaces with their gaps.
#include <strings.h>

#include "model/model.h"
#include "model/parts.h"
#include "model/rules/rules.h"

static void bore_rules(const rule_set *rules)
{
    const ld_tubes *tubes = &rules->model->tubes;
    const ld_rocket *rocket = &rules->model->rocket;
    double bore = tubes->section_count > 0 ? tubes->section[0].bore_radius : NAN;
    for (int i = 0; i < tubes->section_count; i++)
        if (tubes->section[i].form != LD_SECTION_ANNULUS && isnan(tubes->section[i].bore_radius))
            report_broken(rules, "tubes.sections.#.bore_radius", i + 1,
                          "missing; expected a number with a unit of m, > 0 and <= 10 m");
    if ((int)rocket->contact.law < 0 || contact_has(rocket->contact.law, LD_CONTACT_TWO_SIDED))
        return;
    for (int i = 0; i < rocket->adaptor_count; i++) {
        double clearance = rocket->adaptor[i].clearance;
        if (isnan(clearance))
            report_broken(rules, "rocket.adaptors.#.clearance", i + 1,
                          "missing; expected a number with a unit of m, > 0 m");
        if (clearance == 0)
            report_broken(rules, "rocket.adaptors.#.clearance", i + 1,
                          "must be > 0 m; without clearance use the contact law bilateral");
        if (clearance >= bore)
            report_broken(rules, "rocket.adaptors.#.clearance", i + 1,
                          "%g m must be less than the bore's radius, %g m", clearance, bore);
    }
}

static void surface_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    const ld_guide *guide = &model->tubes.guide;
    for (int k = 0; k < guide->surface_count; k++)
        for (int j = 0; j < k; j++)
            if (guide->surface[k].name[0] &&
                strcasecmp(guide->surface[k].name, guide->surface[j].name) == 0)
                report_broken(rules, "tubes.guide.surfaces.#.name", k + 1,
                              "\"%s\" is already the name of surface %d", guide->surface[j].name,
                              j + 1);
    if (model->tubes.slot.kind == LD_SLOT_HELIX)
        report_broken(rules, "tubes.slot", 0,
                      "requires a bore; with guide.surfaces give `slot: none`");
    if ((int)model->rocket.contact.law >= 0 &&
        contact_has(model->rocket.contact.law, LD_CONTACT_TWO_SIDED))
        report_broken(
            rules, "rocket.contact.law", 0,
            "this law holds adaptors on the axis of a bore; on surfaces use a law of contact");
}

void guide_rules(const rule_set *rules)
{
    const ld_model *model = rules->model;
    if (model_has_surfaces(model))
        surface_rules(rules);
    else
        bore_rules(rules);
    if (model->rocket.lock.holds_roll == LD_HOLD_YES && model->tubes.slot.kind == LD_SLOT_HELIX)
        report_broken(rules, "rocket.lock.holds_roll", 0,
                      "is not allowed with a slot, which holds the roll");
}
