// Plausibility of the environment, flights, runs and studies.
#include "math/functions.h"
#include "model/fields/factor.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "model/moist_air.h"
#include "model/parts.h"
#include "model/warnings/estimates.h"
#include "model/warnings/plausible_rule.h"

#define PI 3.14159265358979323846

// ---- environment

static plausible_pair profile_speed(const plausible_entry *at)
{
    const ld_table *profile = &at->model->environment.wind.profile;
    double most = 0;
    for (size_t i = 0; i < profile->rows; i++)
        most = fmax(most, hypot(profile->data[3 * i + 1], profile->data[3 * i + 2]));
    return plausible_alone(most);
}

// Temperature [K] of dry air as dense as that of a row.
static double dry_temperature(const double *row, size_t columns)
{
    return columns == 4 ? virtual_temperature(row[1], row[2], row[3]) : row[2];
}

// Fall of the pressure [Pa] from a row to the next by the weight of the air between them, whose
// temperature is the mean of both.
static double hydrostatic_fall(const double *row, const double *next, size_t columns)
{
    const double g = 9.80665, radius = 6356766, R = 8314.32 / 28.9644; // of us1976
    double T = 0.5 * (dry_temperature(row, columns) + dry_temperature(next, columns));
    double thickness =
        radius * radius * (next[0] - row[0]) / ((radius + row[0]) * (radius + next[0]));
    return -row[1] * expm1(-g * thickness / (R * T));
}

// The row that is farthest from resting on the one before, by more than is measured otherwise.
static plausible_pair air_at_rest(const plausible_entry *at)
{
    const ld_atmosphere *air = &at->model->environment.atmosphere;
    const ld_table *profile = &air->profile;
    plausible_pair worst = plausible_nothing();
    double most = 0.005;
    if (air->kind != LD_ATMOSPHERE_PROFILE)
        return worst;
    for (size_t i = 1; i < profile->rows; i++) {
        const double *row = profile->data + i * profile->columns, *before = row - profile->columns;
        double fall = before[1] - row[1], due = hydrostatic_fall(before, row, profile->columns);
        double off = fabs(fall - due) / before[1];
        if (off <= most)
            continue;
        most = off;
        worst = plausible_compare(fall, due);
        worst.row = (int)i + 1;
    }
    return worst;
}

// Height of a table's last row above the launch site, where it has several; rows count from `zero`.
static plausible_pair top_above_site(const ld_table *table, double zero)
{
    double top = table->rows > 1 ? table->data[(table->rows - 1) * table->columns] : NAN;
    return plausible_alone(top - zero);
}

static plausible_pair top_of_air(const plausible_entry *at)
{
    const ld_environment *environment = &at->model->environment;
    bool given = environment->atmosphere.kind == LD_ATMOSPHERE_PROFILE;
    return given ? top_above_site(&environment->atmosphere.profile, environment->site.altitude)
                 : plausible_nothing();
}

static plausible_pair top_of_wind(const plausible_entry *at)
{
    const ld_environment *environment = &at->model->environment;
    bool geographic = environment->wind.axes == LD_WIND_GEOGRAPHIC;
    return top_above_site(&environment->wind.profile, geographic ? environment->site.altitude : 0);
}

// ---- launch

// Rows of the histories until the last ignition, and of the flights where there are such.
static plausible_pair rows(const plausible_entry *at)
{
    const ld_model *model = at->model;
    const ld_run_settings *run = &model->run;
    double last = model_has_launcher(model) ? model->firing[model->firing_count - 1].at : 0;
    double count = run->lead_in / run->output_step_lead_in;
    count += last / fmin(run->output_step_lead_in, run->output_step_tube);
    if (run->end == LD_END_TIME)
        count += run->end_time / run->output_step_tube;
    return plausible_alone(count);
}

static plausible_pair interval(const plausible_entry *at)
{
    const ld_model *model = at->model;
    const ld_firing *firing = &model->firing[at->i];
    return plausible_compare(at->i > 0 ? firing->at - firing[-1].at : NAN,
                             estimate_time_in_tube(at));
}

// ---- studies

static plausible_pair launches(const plausible_entry *at)
{
    double launches = (double)plan_runs(&at->model->scatter);
    for (int i = 0; i < at->model->sweep_count; i++)
        launches *= at->model->sweep[i].count;
    return plausible_alone(launches);
}

static plausible_pair samples_of_cube(const plausible_entry *at)
{
    const ld_scatter *scatter = &at->model->scatter;
    return plausible_alone((double)scatter->samples / scatter->replicates);
}

static ld_given given_of(const ld_factor *factor)
{
    return distribution_of(factor->distribution)->given;
}

// A factor beside its nominal value, in the unit of its key; NaN where the key may be negative.
static plausible_pair of_factor(const plausible_entry *at, double value)
{
    char why[384];
    field_place place;
    const ld_factor *factor = &at->model->scatter.factor[at->i];
    if (!field_locate(at->model, factor_path(factor, 0), &place, why, sizeof why))
        return plausible_nothing();
    double nominal = field_get(at->model, &place);
    bool positive = place.row->range.low >= 0 && nominal > 0;
    plausible_pair pair = plausible_compare(value, positive ? nominal : NAN);
    pair.entry = factor->path;
    pair.unit = place.row->unit;
    return pair;
}

static plausible_pair deviation(const plausible_entry *at)
{
    const ld_factor *factor = &at->model->scatter.factor[at->i];
    bool free = given_of(factor) == LD_GIVEN_DEVIATION && isnan(factor->between[0]);
    return of_factor(at, free ? factor->deviation : NAN);
}

static plausible_pair log_deviation(const plausible_entry *at)
{
    const ld_factor *factor = &at->model->scatter.factor[at->i];
    plausible_pair pair =
        plausible_alone(given_of(factor) == LD_GIVEN_RATIO ? factor->deviation : NAN);
    pair.entry = factor->path;
    return pair;
}

static plausible_pair spread(const plausible_entry *at)
{
    const ld_factor *factor = &at->model->scatter.factor[at->i];
    bool about = given_of(factor) == LD_GIVEN_SPAN && isnan(factor->between[0]);
    return of_factor(at, about ? factor->spread : NAN);
}

static plausible_pair middle(const plausible_entry *at)
{
    const ld_factor *factor = &at->model->scatter.factor[at->i];
    bool span = given_of(factor) == LD_GIVEN_SPAN && !isnan(factor->between[0]);
    return of_factor(at, span ? (factor->between[0] + factor->between[1]) / 2 : NAN);
}

#define TIME_IN_TUBE .other = "the shortest time in the tube"
#define NOMINAL .other = "the nominal value"

const plausible_rule plausible_of_run[] = {
    {"environment.gravity", .unit = "m/s2", NO_LOW, .high = 30,
     .why = "that of the Earth is 9.8 m/s2"},
    {"environment.site.altitude", .unit = "m", NO_LOW, .high = 86000, .when = "air of a table",
     .why = "us1976 ends there"},
    {"environment.atmosphere.density", .unit = "kg/m3", NO_LOW, .high = 10,
     .why = "that of air on the ground is 1.2 kg/m3"},
    {"environment.atmosphere.speed_of_sound", .unit = "m/s", .low = 100, .high = 2000,
     .why = "that of air on the ground is 340 m/s"},
    {"environment.atmosphere.profile.#", "the fall of the pressure from the row before",
     .unit = "Pa", .other = "the weight of the air between", .low = 0.99, .high = 1.01,
     .find = air_at_rest, .why = "air at rest is carried by the air below"},
    {"environment.atmosphere.profile", "the last row's height above the launch site", .unit = "m",
     .low = 0, NO_HIGH, .find = top_of_air, .why = "the measured air lies below the launch site"},
    {"environment.density_scale", .unit = "", NO_LOW, .high = 3,
     .why = "it is a correction of the atmosphere"},
    {"environment.wind.speed", .unit = "m/s", .low = -100, .high = 100,
     .why = "no such wind blows at every height"},
    {"environment.wind.profile", "the greatest speed", .unit = "m/s", NO_LOW, .high = 150,
     .find = profile_speed, .why = "jet streams have up to 100 m/s"},
    {"environment.wind.profile", "the last row's height above the launch site", .unit = "m",
     .low = 0, NO_HIGH, .find = top_of_wind,
     .why = "above it the wind of that row blows at every height"},
    {"environment.wind.gust.#.speed", .unit = "m/s", .low = -100, .high = 100,
     .why = "gusts of hurricanes have 80 m/s"},
    {"environment.wind.turbulence.wind_at_6m", .unit = "m/s", NO_LOW, .high = 40,
     .why = "severe turbulence is that of 23 m/s"},
    {"flight.speed", .unit = "m/s", .low = -12000, .high = 12000,
     .why = "that exceeds the Earth's escape velocity"},
    {"flight.velocity", "the speed", .unit = "m/s", NO_LOW, .high = 12000, .form = PLAUSIBLE_NORM,
     .why = "that exceeds the Earth's escape velocity"},
    {"flight.rate", "the angular velocity", .unit = "rad/s", NO_LOW, .high = 3000,
     .form = PLAUSIBLE_NORM, .why = "that is more than 28000 rpm"},
    {"flight.geodetic.altitude", .unit = "m", NO_LOW, .high = 86000, .when = "air of a table",
     .why = "us1976 ends there"},
    {"firing.#.at", "the time since the firing before", .unit = "s", TIME_IN_TUBE, .low = 1,
     NO_HIGH, .find = interval, .why = "one rocket leaves before the next one ignites"},
    {"firing.interval", .unit = "s", TIME_IN_TUBE, .low = 1, NO_HIGH,
     .why = "one rocket leaves before the next one ignites"},
    {"run.lead_in", .unit = "s", .other = "the period of the vehicle's heave", .low = 1,
     .high = 1000, .when = "a road that shakes", .of = "base.suspension.stiffness.y",
     .why = "the response to the road builds up over some periods; a thousand add nothing"},
    {"run.tolerance", .unit = "", NO_LOW, .high = 1e-3,
     .why = "results have fewer than three correct digits"},
    {"run.flight_tolerance", .unit = "", NO_LOW, .high = 1e-4,
     .why = "results have fewer than four correct digits"},
    {"run.max_step", .unit = "s", TIME_IN_TUBE, NO_LOW, .high = 0.1,
     .why = "steps miss short contacts"},
    {"run.stuck_time", .unit = "s", TIME_IN_TUBE, .low = 1, NO_HIGH,
     .why = "the run ends before the rocket can leave"},
    {"run.output_step.lead_in", .unit = "s", .other = "run.lead_in", NO_LOW, .high = 1,
     .when = "run.lead_in", .why = "the settling phase has rows at its ends only"},
    {"run.output_step.tube", .unit = "s", TIME_IN_TUBE, NO_LOW, .high = 0.2,
     .why = "the history has few rows with the rocket in the tube"},
    {"run.output_step.flight", .unit = "s", .other = "run.flight_limit", NO_LOW, .high = 0.1,
     .when = "a free flight", .why = "the history has few rows of the flight"},
    {"run.output_step", "the number of rows", .unit = "", NO_LOW, .high = 1e7, .find = rows,
     .why = "histories take about a kilobyte a row"},
    {"run.flight_limit", .unit = "s", .other = "the burn time of the motor", .low = 1, NO_HIGH,
     .when = "a powered flight", .why = "the flight ends while the motor burns"},
    {"scatter.samples", "the number of runs over all points", .unit = "", NO_LOW, .high = 1e7,
     .find = launches, .why = "a million launches take hours"},
    {"scatter.replicates", "the number of samples in a hypercube", .unit = "", .low = 2, NO_HIGH,
     .find = samples_of_cube, .why = "one sample has but one stratum"},
    {"scatter.factors.#", "the deviation", .unit = "", NOMINAL, NO_LOW, .high = 0.5,
     .find = deviation, .why = "many values fall below 0, where none is allowed"},
    {"scatter.factors.#", "the deviation of the logarithm", .unit = "", NO_LOW, .high = 1,
     .find = log_deviation, .why = "values differ by several times"},
    {"scatter.factors.#", "the spread", .unit = "", NOMINAL, NO_LOW, .high = 1, .find = spread,
     .why = "values fall below 0, where none is allowed"},
    {"scatter.factors.#", "the middle of its range", .unit = "", NOMINAL, .low = 0.1, .high = 10,
     .find = middle, .why = "both are usually about equal"},
    {0}};
