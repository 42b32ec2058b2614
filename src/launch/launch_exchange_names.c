// What the states and the events of a launch are called where steps are taken outside.
#include "launch/launch_exchange_names.h"

#include <stdarg.h>
#include <stdio.h>

#include "launch/launch_exchange.h"
#include "launch/launch_run.h"
#include "model/parts.h"

// States that stand together: a name for each ('|' between them) behind the first part of it.
typedef struct named_states {
    int at, count;
    const char *first, *parts; // parts NULL: numbered from 1
    const char *unit, *rate_unit, *description;
} named_states;

static exchange_quantity LD_PRINTF(4, 5)
    quantity_as(const char *unit, const char *rate_unit, const char *description,
                const char *format, ...)
{
    exchange_quantity made = {.unit = unit, .rate_unit = rate_unit, .description = description};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(made.name, sizeof made.name, format, arguments);
    va_end(arguments);
    return made;
}

// Part i of "x|y|z".
static int part_at(const char *parts, int i, const char **part)
{
    int length = 0;
    for (; i > 0 && *parts; parts++)
        i -= *parts == '|';
    while (parts[length] && parts[length] != '|')
        length++;
    *part = parts;
    return length;
}

static exchange_quantity name_state(const named_states *group, int i)
{
    if (!group->parts)
        return quantity_as(group->unit, group->rate_unit, group->description, "%s%d", group->first,
                           i + 1);
    const char *part;
    int length = part_at(group->parts, i, &part);
    return quantity_as(group->unit, group->rate_unit, group->description, "%s%.*s", group->first,
                       length, part);
}

#define WORK_NAME(place, name, is) [place] = {name, is},
#define BASE_NAME(place, name, is) [POWER_COUNT + (place)] = {name, is},
#define MARCHING_NAME(place, name, is)                                                             \
    [(int)POWER_COUNT + (int)VEHICLE_BODY_POWERS + (place)] = {name, is},

#define PART_NAME(place, name, is) [place] = {name, is},
#define ROLLING_NAME(place, name, is) [(int)MECHANISM_POWERS + (place)] = {name, is},

static exchange_quantity name_work(const launcher_system *launcher, int i)
{
    typedef struct named_work {
        const char *name, *is;
    } named_work;
    static const named_work of_bodies[MULTIBODY_POWERS] = {MECHANISM_WORKS(PART_NAME)
                                                               MARCHING_WORKS(ROLLING_NAME)};
    static const named_work work[POWER_COUNT + VEHICLE_POWERS] = {
        LAUNCHING_WORKS(WORK_NAME) OPEN_AIR_WORKS(WORK_NAME) PRESSURE_WORKS(WORK_NAME)
            RECOIL_WORKS(WORK_NAME) LINE_WORKS(WORK_NAME) GUIDE_WIND_WORKS(WORK_NAME)
                GUIDE_JET_WORKS(WORK_NAME) VEHICLE_WORKS(BASE_NAME) MARCHING_WORKS(MARCHING_NAME)
                    JET_WORKS(BASE_NAME)};
    int launching = launcher->launching.work_count;
    int place = i < launching ? i : POWER_COUNT + i - launching;
    if (i >= launching && model_has_multibody(launcher->model))
        return quantity_as("J", "W", of_bodies[i - launching].is, "work.%s",
                           of_bodies[i - launching].name);
    return quantity_as("J", "W", work[place].is, "work.%s", work[place].name);
}

exchange_quantity exchange_base_work(const launcher_system *launcher, int i)
{
    return name_work(launcher, launcher->launching.work_count + i);
}

exchange_quantity exchange_base_state(int i)
{
    return quantity_as("", "", "State of what carries the tube", "base.%d", i + 1);
}

exchange_quantity exchange_wheel(int i)
{
    return quantity_as("", "", "The wheel lands where it rises through zero", "wheel.%d", i + 1);
}

exchange_quantity launch_exchange_state(const ld_run *run, int i)
{
    static const char xyz[] = "x|y|z";
    const launcher_system *launcher = &run->launch.launcher;
    const launching_layout *at = &launcher->launching.layout;
    const base_system *base = &launcher->base;
    const named_states groups[] = {
        {at->r, 3, "tube.position.", xyz, "m", "m/s", "Origin of the tube's frame R, in I"},
        {at->quaternion, 4, "tube.quaternion.", "0|1|2|3", "", "1/s", "R against I, scalar first"},
        {at->v, 3, "tube.velocity.", xyz, "m/s", "m/s2", "Velocity of R's origin, in R"},
        {at->w, 3, "tube.rate.", xyz, "rad/s", "rad/s2", "Angular velocity of R, in R"},
        {at->q, at->nq, "mode.", NULL, "kg0.5.m", "kg0.5.m/s",
         "Modal coordinate (bending y, z, torsion, axial)"},
        {at->q_dot, at->nq, "mode_rate.", NULL, "kg0.5.m/s", "kg0.5.m/s2",
         "Rate of the modal coordinate"},
        {at->x, 3, "rocket.", "s|y|z", "m", "m/s",
         "Rear adaptor of the rocket in the tube: travel, offsets"},
        {at->x + 3, 3, "rocket.", "psi|theta|gamma", "rad", "rad/s",
         "Angles of the rocket in the tube"},
        {at->V, 3, "rocket.velocity.", xyz, "m/s", "m/s2",
         "Velocity of the rocket's rear point, in R"},
        {at->V + 3, 3, "rocket.rate.", xyz, "rad/s", "rad/s2",
         "Angular velocity of the rocket, in R"},
    };
    if (i >= launcher->base_at && base->kind->receive_frame) // those are none
        i += base->state_count;
    if (i >= launcher->work_at)
        return name_work(launcher, i - launcher->work_at);
    for (size_t k = 0; k < sizeof groups / sizeof *groups; k++)
        if (i >= groups[k].at && i < groups[k].at + groups[k].count)
            return name_state(&groups[k], i - groups[k].at);
    return exchange_base_state(i - launcher->base_at);
}

exchange_quantity launch_exchange_indicator(const ld_run *run, int i)
{
    const event *one = &propagator_events(run->propagator)->event[i];
    int surfaces = run->launch.launcher.launching.surfaces.count, index = one->index;
    switch (one->kind) {
    case EVENT_RELEASE:
        return quantity_as("", "", "The lock releases where it falls through zero", "release");
    case EVENT_EXIT:
        return quantity_as("", "", "The adaptor leaves the guide where it falls through zero",
                           "exit.%d", index + 1);
    case EVENT_TOUCH:
        return quantity_as("", "", "The adaptor touches where it rises through zero", "touch.%d",
                           index + 1);
    case EVENT_SURFACE:
        return quantity_as("", "", "The adaptor touches the surface where it rises through zero",
                           "touch.%d.%d", index / surfaces + 1, index % surfaces + 1);
    case EVENT_BASE:
        return exchange_wheel(index);
    case EVENT_BREECH:
        return quantity_as("", "", "The rocket touches the breech where it rises through zero",
                           "breech");
    case EVENT_LINE:
        return quantity_as("", "", "The line becomes taut or breaks where it falls through zero",
                           "line");
    default:
        return quantity_as("", "", "The slide's stop pushes while it is positive", "stop.%d.%d",
                           index / LD_SLIDE_STOPS + 1, index % LD_SLIDE_STOPS + 1);
    }
}
