// Rules of a base whose motion is given: table, sea.
#include <math.h>
#include <stdio.h>

#include "model/model.h"
#include "model/rules/rules.h"

static const double PI = 3.14159265358979323846;
#define DEGREES(angle) ((angle) * (180 / PI))

// ---- sea

// Responses at rising headings; several need them all.
static void headings_rule(const rule_set *rules, const ld_sea *sea)
{
    for (int i = 0; i < sea->response_count && sea->response_count > 1; i++) {
        double heading = sea->response[i].heading;
        if (isnan(heading))
            report_broken(rules, "base.sea.responses.#", i + 1,
                          "heading is missing; of several responses each needs its own");
        else if (i > 0 && heading <= sea->response[i - 1].heading)
            report_broken(rules, "base.sea.responses.#.heading", i + 1,
                          "%g deg does not come after %g deg of the response before",
                          DEGREES(heading), DEGREES(sea->response[i - 1].heading));
    }
}

// Without spreading the waves go where there is a response, to a degree; the port side is as the
// starboard one.
static void covered_rule(const rule_set *rules, const ld_sea *sea)
{
    double side = fabs(remainder(sea->heading, 2 * PI)), slack = PI / 180;
    double first = sea->response[0].heading, last = sea->response[sea->response_count - 1].heading;
    if (first > last || !(side < first - slack || side > last + slack))
        return;
    if (first == last)
        report_broken(rules, "base.sea.heading", 0,
                      "%g deg off x, but the response is that to %g deg", DEGREES(side),
                      DEGREES(first));
    else
        report_broken(rules, "base.sea.heading", 0,
                      "%g deg off x, but the responses are those from %g deg to %g deg",
                      DEGREES(side), DEGREES(first), DEGREES(last));
}

static void sea_rules(const rule_set *rules)
{
    const ld_sea *sea = &rules->model->base.sea;
    char path[64];
    if (!sea->present)
        return;
    if (rules->model->gravity == 0)
        report_broken(rules, "base.sea", 0, "without gravity there are no waves");
    for (int i = 0; i < sea->response_count; i++) {
        snprintf(path, sizeof path, "base.sea.responses.%d.table.#", i + 1);
        rising_rule(rules, path, &sea->response[i].table, "rad/s", false);
    }
    if (sea->response_count == 0)
        return;
    headings_rule(rules, sea);
    bool spread = !isnan(sea->spreading);
    if (spread && sea->spectrum == LD_SEA_REGULAR)
        report_broken(rules, "base.sea.spreading", 0, "given for a regular sea, which is one wave");
    else if (spread && sea->response_count == 1)
        report_broken(rules, "base.sea.spreading", 0,
                      "waves of many headings need responses at two headings or more");
    else if (!spread)
        covered_rule(rules, sea);
}

// ---- motion

#define UNTOLD_START "; motion.start says which of its times is 0 of the run's"

// Times rise; rows of eight numbers end with a quaternion.
static void motion_rows_rule(const rule_set *rules, const ld_table *motion)
{
    size_t columns = motion->columns;
    for (size_t i = 0; i < motion->rows; i++) {
        const double *row = motion->data + i * columns;
        if (i > 0 && row[0] <= motion->data[(i - 1) * columns])
            report_broken(rules, "base.motion.table.#", (int)i + 1,
                          "t is not larger than that of the row before");
        if (columns == 8 && !field_is_unit(row + 4))
            report_broken(rules, "base.motion.table.#", (int)i + 1, NO_UNIT_QUATERNION);
    }
}

// The table must hold the motion from the start on to the last ignition, or the end asked for.
static void motion_span_rule(const rule_set *rules)
{
    const ld_model *model = rules->model;
    const ld_table *motion = &model->base.motion;
    if (motion->rows < 2 || model->firing_count < 1)
        return;
    double since = model->base.motion_start - model->base.motion_origin;
    double first = motion->data[0] - since,
           last = motion->data[(motion->rows - 1) * motion->columns] - since;
    double start = fmin(model->firing[0].at, -model->run.lead_in);
    double end = model->firing[model->firing_count - 1].at;
    bool timed = model->run.end == LD_END_TIME;
    if (start < first)
        report_broken(rules, "base.motion.table", 0, "begins at %g s, after the launch, at %g s%s",
                      first, start, model->base.motion_start == 0 ? UNTOLD_START : "");
    if (timed && end + model->run.end_time > last)
        report_broken(rules, "base.motion.table", 0, "ends at %g s, before the run's end, at %g s",
                      last, end + model->run.end_time);
    else if (end >= last)
        report_broken(rules, "base.motion.table", 0,
                      "ends at %g s; it must extend beyond the last ignition, at %g s", last, end);
}

void base_rules(const rule_set *rules)
{
    const ld_base *base = &rules->model->base;
    if (base->kind != LD_BASE_PRESCRIBED)
        return;
    sea_rules(rules);
    motion_rows_rule(rules, &base->motion);
    if (base->motion.rows == 0 && base->motion_start != 0)
        report_broken(rules, "base.motion.start", 0, "requires motion.table, whose clock it uses");
    if (base->motion.rows == 1)
        report_broken(rules, "base.motion.table", 0, "needs at least two rows");
    if (base->motion.rows == 0)
        return;
    if (base->surge.count + base->heave.count + base->sway.count + base->yaw.count +
            base->pitch.count + base->roll.count >
        0)
        report_broken(rules, "base.motion.table", 0, "given together with sines; give one of them");
    if (base->velocity[0] != 0 || base->velocity[1] != 0 || base->velocity[2] != 0)
        report_broken(rules, "base.velocity", 0,
                      "given together with motion.table, which gives the whole motion");
    if (base->sea.present)
        report_broken(rules, "base.sea", 0,
                      "given together with motion.table, which gives the whole motion");
    motion_span_rule(rules);
}
