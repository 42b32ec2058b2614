// Rules that tie the bodies, joints and force elements of a base of kind multibody together: every
// name stands for something, joints reach the ground, each element has what it needs.
#include <stdio.h>
#include <string.h>

#include "base/suggestion.h"
#include "math/functions.h"
#include "model/model.h"
#include "model/parts.h"
#include "model/rules/rules.h"

static const ld_mechanism *mechanism_of(const rule_set *rules)
{
    return &rules->model->base.mechanism;
}

// ---- names

// " (did you mean \"boom\"?)", or nothing.
typedef struct did_you_mean {
    char text[LD_MAX_NAME + 24];
} did_you_mean;

static did_you_mean suggest_body(const ld_mechanism *given, const char *name)
{
    did_you_mean answer = {""};
    name_suggestion near = suggestion_begin(name);
    suggestion_offer(&near, "ground");
    suggestion_offer(&near, "carrier");
    for (int i = 0; i < given->body_count; i++)
        suggestion_offer(&near, given->body[i].name);
    for (int i = 0; i < given->beam_count; i++)
        suggestion_offer(&near, given->beam[i].name);
    if (near.name)
        snprintf(answer.text, sizeof answer.text, "; did you mean \"%s\"?", near.name);
    return answer;
}

// What is allowed for a body.
enum { ANY_BODY, BODY_ALONE };

// The body of a name; where there is none, says so under path[i].key.
static int body_rule(const rule_set *rules, const char *path, int index, const char *name, int what)
{
    const ld_mechanism *given = mechanism_of(rules);
    int body = mechanism_body(given, name);
    if (body == LD_ON_NOTHING && name[0])
        report_broken(rules, path, index, "no body or beam \"%s\"%s", name,
                      suggest_body(given, name).text);
    else if (body < 0 && body != LD_ON_NOTHING && what == BODY_ALONE)
        report_broken(rules, path, index, "\"%s\" does not move; expected a body or a beam", name);
    return body;
}

// Names of one list differ; `stride` [bytes] from one to the next.
static void names_rule(const rule_set *rules, const char *path, const char *first, size_t stride,
                       int count)
{
    for (int i = 0; i < count; i++)
        for (int k = 0; k < i; k++) {
            const char *name = first + (size_t)i * stride;
            if (name[0] && strcmp(name, first + (size_t)k * stride) == 0)
                report_broken(rules, path, i + 1, "\"%s\" is already the name of number %d", name,
                              k + 1);
        }
}
#define NAMES_RULE(path, list, count) names_rule(rules, path, (list)[0].name, sizeof *(list), count)

static void all_names_rule(const rule_set *rules)
{
    const ld_mechanism *given = mechanism_of(rules);
    NAMES_RULE("base.bodies.#.name", given->body, given->body_count);
    NAMES_RULE("base.beams.#.name", given->beam, given->beam_count);
    NAMES_RULE("base.joints.#.name", given->joint, given->joint_count);
    NAMES_RULE("base.bushings.#.name", given->bushing, given->bushing_count);
    NAMES_RULE("base.struts.#.name", given->strut, given->strut_count);
    NAMES_RULE("base.drives.#.name", given->drive, given->drive_count);
    NAMES_RULE("base.feet.#.name", given->foot, given->foot_count);
    NAMES_RULE("base.loads.#.name", given->load, given->load_count);
    NAMES_RULE("base.drag.#.name", given->drag, given->drag_count);
    for (int i = 0; i < given->beam_count; i++) {
        int body = mechanism_body(given, given->beam[i].name);
        if (body >= 0 && body < given->body_count)
            report_broken(rules, "base.beams.#.name", i + 1, "\"%s\" is already the name of a body",
                          given->beam[i].name);
    }
    for (int i = 0; i < given->body_count; i++)
        if (strcmp(given->body[i].name, "ground") == 0 ||
            strcmp(given->body[i].name, "carrier") == 0)
            report_broken(rules, "base.bodies.#.name", i + 1,
                          "\"%s\" is a reserved name; choose another name", given->body[i].name);
}

// ---- joints

static bool has_one_axis(const ld_joint *joint)
{
    return joint->kind == LD_JOINT_REVOLUTE || joint->kind == LD_JOINT_PRISMATIC;
}

static double norm(const double x[3])
{
    return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

static void axis_rules(const rule_set *rules, int i)
{
    const ld_joint *joint = &mechanism_of(rules)->joint[i];
    const double *a = joint->axis, *b = joint->axis_2;
    bool has_axis = joint->kind != LD_JOINT_FIXED && joint->kind != LD_JOINT_SPHERICAL &&
                    joint->kind != LD_JOINT_FREE;
    double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
    if (has_axis && !(norm(a) > 0))
        report_broken(rules, "base.joints.#.axis", i + 1, "its length is 0");
    else if (joint->kind == LD_JOINT_UNIVERSAL && !(norm(cross) > 1e-6 * norm(a) * norm(b)))
        report_broken(rules, "base.joints.#.axis_2", i + 1,
                      "is parallel to axis, or its length is 0");
}

// A station of a beam is on it.
static void on_beam_rule(const rule_set *rules, const char *path, int index, int body, double x)
{
    const ld_mechanism *given = mechanism_of(rules);
    int beam = body - given->body_count;
    if (body >= given->body_count && !(x >= 0 && x <= given->beam[beam].length))
        report_broken(rules, path, index,
                      "station %g m is not on the beam \"%s\", which goes from 0 to %g m", x,
                      given->beam[beam].name, given->beam[beam].length);
}

// Which joint carries each body: the first that names it; -1: none.
static void find_carriers(const ld_mechanism *given, int carrier[LD_MAX_BODIES + LD_MAX_BEAMS])
{
    for (int k = 0; k < LD_MAX_BODIES + LD_MAX_BEAMS; k++)
        carrier[k] = -1;
    for (int i = given->joint_count - 1; i >= 0; i--) {
        int body = mechanism_body(given, given->joint[i].body);
        if (body >= 0)
            carrier[body] = i;
    }
}

static void joint_rules(const rule_set *rules, int i, const int *carrier)
{
    const ld_mechanism *given = mechanism_of(rules);
    const ld_joint *joint = &given->joint[i];
    int parent = body_rule(rules, "base.joints.#.parent", i + 1, joint->parent, ANY_BODY);
    int body = body_rule(rules, "base.joints.#.body", i + 1, joint->body, BODY_ALONE);
    bool closes = body >= 0 && carrier[body] != i;
    axis_rules(rules, i);
    on_beam_rule(rules, "base.joints.#.at", i + 1, parent, joint->at[0]);
    if (body >= 0 && body == parent)
        report_broken(rules, "base.joints.#.body", i + 1, "\"%s\" is its own parent", joint->body);
    if (closes && joint->kind == LD_JOINT_FREE)
        report_broken(rules, "base.joints.#.kind", i + 1,
                      "a free joint constrains nothing: joint \"%s\" carries \"%s\" already",
                      given->joint[carrier[body]].name, joint->body);
    if (body >= 0 && !closes && !isnan(joint->body_at[0]))
        report_broken(rules, "base.joints.#.body_at", i + 1,
                      "requires a joint that closes a loop; this one carries \"%s\" at its origin",
                      joint->body);
    if (closes && body >= 0)
        on_beam_rule(rules, "base.joints.#.body_at", i + 1, body,
                     isnan(joint->body_at[0]) ? 0 : joint->body_at[0]);
    if (joint->stops.present && !(joint->stops.low < joint->stops.high) &&
        !isnan(joint->stops.low) && !isnan(joint->stops.high))
        report_broken(rules,
                      joint->kind == LD_JOINT_REVOLUTE ? "base.joints.#.stops"
                                                       : "base.joints.#.slide_stops",
                      i + 1, "`from` must be less than `to`");
    bool held = joint->lock.spring.present || joint->stops.present || joint->friction.coulomb > 0 ||
                joint->friction.viscous > 0;
    if (closes && held)
        report_broken(
            rules, "base.joints.#", i + 1,
            "lock, stops and friction require a joint that carries its body; \"%s\" is carried by "
            "joint \"%s\"",
            joint->body, given->joint[carrier[body]].name);
}

// Every body hangs on a joint, and the joints lead to the ground.
static void tree_rules(const rule_set *rules, const int *carrier)
{
    const ld_mechanism *given = mechanism_of(rules);
    int count = given->body_count + given->beam_count;
    for (int k = 0; k < count; k++) {
        bool beam = k >= given->body_count;
        int number = beam ? k - given->body_count + 1 : k + 1;
        const char *path = beam ? "base.beams.#" : "base.bodies.#";
        const char *name = beam ? given->beam[number - 1].name : given->body[k].name;
        if (carrier[k] < 0) {
            report_broken(
                rules, path, number,
                "no joint carries \"%s\"; a free joint on the ground leaves it to its springs",
                name);
            continue;
        }
        int at = k, steps = 0;
        while (at >= 0 && carrier[at] >= 0 && steps++ <= count)
            at = mechanism_body(given, given->joint[carrier[at]].parent);
        if (steps > count) {
            report_broken(
                rules, path, number,
                "the joints that carry \"%s\" lead back to it; none of them reaches the ground",
                name);
            return;
        }
    }
}

// An end of the tree that nothing accelerates.
static void mass_rules(const rule_set *rules, const int *carrier)
{
    const ld_mechanism *given = mechanism_of(rules);
    for (int k = 0; k < given->body_count; k++) {
        bool end = strcmp(rules->model->tubes.on, given->body[k].name) != 0;
        for (int i = 0; i < given->joint_count; i++) {
            int body = mechanism_body(given, given->joint[i].body);
            end &= !(body >= 0 && carrier[body] == i &&
                     mechanism_body(given, given->joint[i].parent) == k);
        }
        bool fixed = carrier[k] >= 0 && given->joint[carrier[k]].kind == LD_JOINT_FIXED;
        if (end && !fixed && !(given->body[k].mass > 0))
            report_broken(rules, "base.bodies.#.mass", k + 1,
                          "must be > 0 kg: \"%s\" is an end of the tree of bodies",
                          given->body[k].name);
        char path[64];
        snprintf(path, sizeof path, "base.bodies.%d.inertia", k + 1);
        inertia_rule(rules, path, given->body[k].inertia, NULL);
    }
}

static void mesh_rules(const rule_set *rules)
{
    const ld_mechanism *given = mechanism_of(rules);
    size_t count = 0;
    for (int k = 0; k < given->body_count; k++) {
        size_t before = count;
        count += given->body[k].appearance.mesh.rows;
        if (count > LD_MAX_TRIANGLES && before <= LD_MAX_TRIANGLES)
            report_broken(rules, "base.bodies.#.looks.mesh", k + 1,
                          "found %zu triangles in all meshes; expected at most %d",
                          mechanism_triangles(given), LD_MAX_TRIANGLES);
    }
}

// ---- force elements

static void ends_rule(const rule_set *rules, const char *list, int index, const char *from,
                      const char *to)
{
    char path[2][48];
    snprintf(path[0], sizeof path[0], "base.%s.#.from", list);
    snprintf(path[1], sizeof path[1], "base.%s.#.to", list);
    int a = body_rule(rules, path[0], index, from, ANY_BODY);
    int b = body_rule(rules, path[1], index, to, ANY_BODY);
    if (a == b && a != LD_ON_NOTHING)
        report_broken(rules, path[1], index, "\"%s\" is its `from`, too", to);
}

static void element_rules(const rule_set *rules)
{
    const ld_mechanism *given = mechanism_of(rules);
    for (int i = 0; i < given->bushing_count; i++)
        ends_rule(rules, "bushings", i + 1, given->bushing[i].from, given->bushing[i].to);
    for (int i = 0; i < given->strut_count; i++)
        ends_rule(rules, "struts", i + 1, given->strut[i].from, given->strut[i].to);
    for (int i = 0; i < given->foot_count; i++)
        body_rule(rules, "base.feet.#.body", i + 1, given->foot[i].body, BODY_ALONE);
    for (int i = 0; i < given->drag_count; i++)
        body_rule(rules, "base.drag.#.body", i + 1, given->drag[i].body, BODY_ALONE);
    for (int i = 0; i < given->load_count; i++) {
        const ld_point_load *load = &given->load[i];
        char path[64];
        body_rule(rules, "base.loads.#.body", i + 1, load->body, BODY_ALONE);
        snprintf(path, sizeof path, "base.loads.%d.force.#", i + 1);
        rising_rule(rules, path, &load->force, "s", false);
        snprintf(path, sizeof path, "base.loads.%d.moment.#", i + 1);
        rising_rule(rules, path, &load->moment, "s", false);
        if (load->force.rows == 0 && load->moment.rows == 0)
            report_broken(rules, "base.loads.#", i + 1, "neither force nor moment is given");
    }
}

static void drive_rules(const rule_set *rules, const int *carrier)
{
    const ld_mechanism *given = mechanism_of(rules);
    for (int i = 0; i < given->drive_count; i++) {
        const ld_joint_drive *drive = &given->drive[i];
        int joint = mechanism_joint(given, drive->joint);
        if (joint < 0) {
            report_broken(rules, "base.drives.#.joint", i + 1, "no joint \"%s\"", drive->joint);
            continue;
        }
        bool turns = drive->form == LD_DRIVE_ANGLE;
        int body = mechanism_body(given, given->joint[joint].body);
        if (!has_one_axis(&given->joint[joint]) ||
            turns != (given->joint[joint].kind == LD_JOINT_REVOLUTE))
            report_broken(rules, "base.drives.#.joint", i + 1,
                          "\"%s\" is not a %s joint, which a drive of %s requires", drive->joint,
                          turns ? "revolute" : "prismatic", turns ? "an angle" : "a length");
        else if (body >= 0 && carrier[body] != joint)
            report_broken(rules, "base.drives.#.joint", i + 1,
                          "\"%s\" closes a loop; a drive requires a joint that carries its body",
                          drive->joint);
        if (drive->of[0])
            body_rule(rules, "base.drives.#.of", i + 1, drive->of, BODY_ALONE);
        for (int k = 0; k < i; k++)
            if (strcmp(given->drive[k].joint, drive->joint) == 0)
                report_broken(rules, "base.drives.#.joint", i + 1,
                              "drive \"%s\" acts on \"%s\" already", given->drive[k].name,
                              drive->joint);
    }
}

// ---- wheels, tubes

static void wheels_on_rules(const rule_set *rules, const int *carrier)
{
    const ld_mechanism *given = mechanism_of(rules);
    const ld_vehicle *vehicle = &rules->model->base.vehicle;
    if (vehicle->wheel_count == 0) {
        if (given->wheels_on[0])
            report_broken(rules, "base.wheels_on", 0, "requires base.wheels");
        return;
    }
    if (!given->wheels_on[0]) {
        report_broken(rules, "base.wheels_on", 0,
                      "missing; expected the body that the wheels carry");
        return;
    }
    int body = body_rule(rules, "base.wheels_on", 0, given->wheels_on, BODY_ALONE);
    if (body >= given->body_count)
        report_broken(rules, "base.wheels_on", 0, "\"%s\" is a beam; expected a body",
                      given->wheels_on);
    if (!(vehicle->tyre.radius > 0))
        report_broken(rules, "base.tyre", 0, "missing; wheels require it");
    if (!(vehicle->suspension.stiffness[0] > 0))
        report_broken(rules, "base.suspension", 0, "missing; wheels require it");
    if (isnan(vehicle->speed))
        report_broken(rules, "base.speed", 0,
                      "missing; wheels require it, 0 km/h where they are parked");
    bool free = body >= 0 && carrier[body] >= 0 &&
                given->joint[carrier[body]].kind == LD_JOINT_FREE &&
                mechanism_body(given, given->joint[carrier[body]].parent) == LD_ON_GROUND;
    if (body >= 0 && !free)
        report_broken(rules, "base.wheels_on", 0,
                      "\"%s\" must hang on the ground by a free joint: its wheels carry it",
                      given->wheels_on);
}

static void tubes_on_rules(const rule_set *rules)
{
    const ld_mechanism *given = mechanism_of(rules);
    const ld_tubes *tubes = &rules->model->tubes;
    if (!tubes->on[0]) {
        report_broken(rules, "tubes.on", 0,
                      "missing; expected the body or beam that carries the tubes");
        return;
    }
    int body = body_rule(rules, "tubes.on", 0, tubes->on, BODY_ALONE);
    if (body >= given->body_count && tubes->layout.rows * tubes->layout.columns > 1)
        report_broken(rules, "tubes.layout", 0, "a beam carries one tube, not %d",
                      tubes->layout.rows * tubes->layout.columns);
}

void mechanism_rules(const rule_set *rules)
{
    int carrier[LD_MAX_BODIES + LD_MAX_BEAMS];
    if (!model_has_multibody(rules->model)) {
        if (rules->model->tubes.on[0])
            report_broken(rules, "tubes.on", 0, "requires base.kind: multibody");
        return;
    }
    const ld_mechanism *given = mechanism_of(rules);
    find_carriers(given, carrier);
    all_names_rule(rules);
    for (int i = 0; i < given->joint_count; i++)
        joint_rules(rules, i, carrier);
    tree_rules(rules, carrier);
    mass_rules(rules, carrier);
    mesh_rules(rules);
    element_rules(rules);
    drive_rules(rules, carrier);
    wheels_on_rules(rules, carrier);
    tubes_on_rules(rules);
}
