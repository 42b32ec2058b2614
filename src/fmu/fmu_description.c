#include "fmu/fmu_description.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/version.h"

enum { BASE_UNITS = 5, MOST_UNITS = 128 };

static const char *const base_unit[BASE_UNITS] = {"kg", "m", "s", "K", "rad"};

// A unit by powers of the base units.
typedef struct derived_unit {
    const char *name;
    int power[BASE_UNITS];
} derived_unit;

static const derived_unit derived_units[] = {
    {"N", {1, 1, -2, 0, 0}},  {"Pa", {1, -1, -2, 0, 0}}, {"J", {1, 2, -2, 0, 0}},
    {"W", {1, 2, -3, 0, 0}},  {"Hz", {0, 0, -1, 0, 0}},  {"kg", {1, 0, 0, 0, 0}},
    {"m", {0, 1, 0, 0, 0}},   {"s", {0, 0, 1, 0, 0}},    {"K", {0, 0, 0, 1, 0}},
    {"rad", {0, 0, 0, 0, 1}}, {"1", {0, 0, 0, 0, 0}},
};

// Adds powers of one factor of a unit, "m2" or "rad"; false: none that whole powers report.
static bool add_factor(const char *text, size_t length, int sign, int power[BASE_UNITS])
{
    size_t letters = 0;
    while (letters < length && isalpha((unsigned char)text[letters]))
        letters++;
    if (letters == 0 && length == 1 && *text == '1')
        return true;
    char *end;
    long times = letters < length ? strtol(text + letters, &end, 10) : 1;
    if (letters < length && end != text + length)
        return false;
    for (size_t i = 0; i < sizeof derived_units / sizeof *derived_units; i++) {
        const derived_unit *unit = &derived_units[i];
        if (strlen(unit->name) != letters || strncmp(unit->name, text, letters) != 0)
            continue;
        for (int k = 0; k < BASE_UNITS; k++)
            power[k] += sign * (int)times * unit->power[k];
        return true;
    }
    return false;
}

// "kg.m2/s", "N.m/rad/s": what stands behind each '/' divides.
static bool powers_of(const char *unit, int power[BASE_UNITS])
{
    int sign = 1;
    memset(power, 0, BASE_UNITS * sizeof *power);
    while (*unit) {
        size_t length = strcspn(unit, "./ ");
        if (!add_factor(unit, length, sign, power))
            return false;
        unit += length;
        sign = *unit == '/' ? -1 : 1;
        unit += *unit != '\0';
    }
    return true;
}

static bool has_unit(const fmu_variable *variable)
{
    return *variable->unit && strcmp(variable->unit, "1") != 0;
}

static void write_unit(FILE *stream, const char *name)
{
    int power[BASE_UNITS];
    fprintf(stream, "    <Unit name=\"%s\">", name);
    if (powers_of(name, power)) {
        fputs("<BaseUnit", stream);
        for (int k = 0; k < BASE_UNITS; k++)
            if (power[k] != 0)
                fprintf(stream, " %s=\"%d\"", base_unit[k], power[k]);
        fputs("/>", stream);
    }
    fputs("</Unit>\n", stream);
}

static void write_units(FILE *stream, const fmu_variables *variables)
{
    const char *known[MOST_UNITS];
    int count = 0;
    fputs("  <UnitDefinitions>\n", stream);
    for (size_t i = 0; i < variables->count; i++) {
        const fmu_variable *v = &variables->item[i];
        bool told = !has_unit(v) || count == MOST_UNITS;
        for (int k = 0; k < count && !told; k++)
            told = strcmp(known[k], v->unit) == 0;
        if (told)
            continue;
        known[count++] = v->unit;
        write_unit(stream, v->unit);
    }
    fputs("  </UnitDefinitions>\n", stream);
}

void fmu_write_text(FILE *stream, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '&':
            fputs("&amp;", stream);
            break;
        case '<':
            fputs("&lt;", stream);
            break;
        case '>':
            fputs("&gt;", stream);
            break;
        case '"':
            fputs("&quot;", stream);
            break;
        default:
            fputc((unsigned char)*text < ' ' ? ' ' : *text, stream);
        }
}

// ---- variables ----

static const char *causality_of(const fmu_variable *v)
{
    return v->group == FMU_TIME  ? "independent"
           : fmu_is_input(v)     ? "input"
           : fmu_is_parameter(v) ? "parameter"
           : fmu_is_local(v)     ? "local"
                                 : "output";
}

static const char *variability_of(const fmu_variable *v)
{
    return fmu_is_parameter(v)                                ? "fixed"
           : v->group == FMU_IGNITE || v->group == FMU_RESULT ? "discrete"
                                                              : "continuous";
}

size_t fmu_listed_length(const fmu_description *self, size_t place)
{
    return self->arrays ? fmu_array_length(self->variables, place) : 1;
}

void fmu_write_array_name(FILE *stream, const fmu_variable *first)
{
    char name[FMU_ARRAY_NAME];
    fmu_array_name(first, name);
    fmu_write_text(stream, name);
}

// That of all elements, or theirs one by one.
void fmu_write_array_meaning(FILE *stream, const fmu_variable *first, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        if (i > 0 && strcmp(first[i].description, first[i - 1].description) == 0)
            continue;
        fputs(i > 0 ? "; " : "", stream);
        fmu_write_text(stream, first[i].description);
    }
}

// Of an array of that length, 1: of a variable that is none.
static void write_head(FILE *stream, const fmu_variable *v, size_t length)
{
    fprintf(stream, " name=\"");
    if (length > 1)
        fmu_write_array_name(stream, v);
    else
        fmu_write_text(stream, v->name);
    fprintf(stream, "\" valueReference=\"%u\" description=\"",
            length > 1 ? v->array : v->reference);
    fmu_write_array_meaning(stream, v, length);
    fprintf(stream, "\" causality=\"%s\" variability=\"%s\"", causality_of(v), variability_of(v));
}

static void write_start(FILE *stream, const fmu_variable *v, size_t length)
{
    if (fmu_type_of(v) == FMU_BOOLEAN) {
        fprintf(stream, " start=\"%s\"", v->start != 0 ? "true" : "false");
    } else if (!isnan(v->start)) {
        for (size_t i = 0; i < length; i++)
            fprintf(stream, "%s%.17g", i > 0 ? " " : " start=\"", v[i].start);
        fputs("\"", stream);
    }
}

static void write_sizes(FILE *stream, const fmu_variable *v)
{
    if (has_unit(v))
        fprintf(stream, " unit=\"%s\"", v->unit);
    if (v->nominal > 0)
        fprintf(stream, " nominal=\"%.17g\"", v->nominal);
}

// How a variable is named in other places: by its place, from 1, in FMI 2.0, else by its reference.
static size_t number_of(const fmu_description *self, size_t place)
{
    const fmu_variable *v = &self->variables->item[place];
    return self->version == 2                   ? place + 1
           : fmu_listed_length(self, place) > 1 ? v->array
                                                : v->reference;
}

// Of which state it is the rate.
static void write_derivative(FILE *stream, const fmu_description *self, const fmu_variable *v)
{
    if (v->group == FMU_RATE)
        fprintf(stream, " derivative=\"%zu\"",
                number_of(self, fmu_group_begin(self->variables, FMU_STATE) + (size_t)v->index));
}

static void write_variable_2(FILE *stream, const fmu_description *self, size_t place)
{
    static const char *const type[] = {"Real", "Boolean", "Integer"};
    const fmu_variable *v = &self->variables->item[place];
    fputs("    <ScalarVariable", stream);
    write_head(stream, v, 1);
    if (fmu_type_of(v) == FMU_STRING) {
        fputs("><String start=\"", stream);
        fmu_write_text(stream, v->text);
        fputs("\"/>", stream);
    } else {
        fprintf(stream, "><%s", type[fmu_type_of(v)]);
        write_sizes(stream, v);
        write_derivative(stream, self, v);
        write_start(stream, v, 1);
        fputs("/>", stream);
    }
    fputs("</ScalarVariable>\n", stream);
}

static void write_variable_3(FILE *stream, const fmu_description *self, size_t place)
{
    static const char *const type[] = {"Float64", "Boolean", "Int32", "String"};
    const fmu_variable *v = &self->variables->item[place];
    size_t length = fmu_listed_length(self, place);
    fprintf(stream, "    <%s", type[fmu_type_of(v)]);
    write_head(stream, v, length);
    if (fmu_type_of(v) == FMU_STRING) {
        fputs("><Start value=\"", stream);
        fmu_write_text(stream, v->text);
        fputs("\"/></String>\n", stream);
        return;
    }
    write_sizes(stream, v);
    write_derivative(stream, self, v);
    write_start(stream, v, length);
    if (length > 1)
        fprintf(stream, "><Dimension start=\"%zu\"/></Float64>\n", length);
    else
        fputs("/>\n", stream);
}

// ---- structure ----

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

// What an unknown is calculated from; in co-simulation the states are inside.
typedef struct known {
    bool time, told, states, works, parameters;
} known;

// Rates of places and modes, which are velocities: no force, so no time and no input, is in them.
static bool is_velocity(const fmu_variable *v)
{
    return v->group == FMU_RATE &&
           (begins(v->name, "der(state.tube.position") ||
            begins(v->name, "der(state.tube.quaternion") || begins(v->name, "der(state.mode."));
}

// Works feed nothing but their sums.
static bool sums_works(const fmu_variable *v)
{
    return v->group == FMU_COLUMN &&
           (begins(v->name, "work.") || strcmp(v->name, "energy.residual") == 0);
}

// While time continues; results are reported once, by what has happened. What a vehicle receives
// acts on its rates alone.
static known known_of(const fmu_variables *all, const fmu_variable *v)
{
    if (v->group == FMU_RESULT)
        return (known){0};
    bool forced = !is_velocity(v);
    return (known){.time = all->exchange && forced,
                   .told = (all->runner->follows || v->group == FMU_RATE) && forced,
                   .states = all->exchange,
                   .works = all->exchange && sums_works(v)};
}

static bool is_known(const known *from, const fmu_variable *v)
{
    return v->group == FMU_TIME         ? from->time
           : v->group == FMU_PART_INPUT ? from->told
           : v->group == FMU_STATE ? (begins(v->name, "state.work.") ? from->works : from->states)
                                   : fmu_is_parameter(v) && from->parameters;
}

static void write_dependencies(FILE *stream, const fmu_description *self, const known *from)
{
    const fmu_variables *all = self->variables;
    const char *between = "";
    fputs(" dependencies=\"", stream);
    for (size_t i = 0; i < all->count; i += fmu_listed_length(self, i))
        if (is_known(from, &all->item[i])) {
            fprintf(stream, "%s%zu", between, number_of(self, i));
            between = " ";
        }
    fputs("\"", stream);
}

// An element for each of the variables that are asked for. At the start (`initial`) what has no
// list depends on all parameters and inputs.
static void write_unknowns(FILE *stream, const fmu_description *self, const char *element,
                           bool initial, bool asked(const fmu_variable *))
{
    const fmu_variables *all = self->variables;
    const bool listed = !initial || (all->runner->input_count > 0 && !all->runner->follows);
    if (self->version == 2)
        fprintf(stream, "    <%s>\n", element);
    for (size_t i = 0; i < all->count; i += fmu_listed_length(self, i)) {
        if (!asked(&all->item[i]))
            continue;
        known from = initial ? (known){.parameters = true} : known_of(all, &all->item[i]);
        if (self->version == 2)
            fputs("      <Unknown index", stream);
        else
            fprintf(stream, "    <%s valueReference", element);
        fprintf(stream, "=\"%zu\"", number_of(self, i));
        if (listed)
            write_dependencies(stream, self, &from);
        fputs("/>\n", stream);
    }
    if (self->version == 2)
        fprintf(stream, "    </%s>\n", element);
}

static bool is_rate(const fmu_variable *v)
{
    return v->group == FMU_RATE;
}

static bool is_indicator(const fmu_variable *v)
{
    return v->group == FMU_INDICATOR;
}

static bool is_found_at_start(const fmu_variable *v)
{
    return fmu_is_output(v) || v->group == FMU_STATE || is_rate(v);
}

static void write_structure(FILE *stream, const fmu_description *self)
{
    bool old = self->version == 2;
    fputs("  <ModelStructure>\n", stream);
    write_unknowns(stream, self, old ? "Outputs" : "Output", false, fmu_is_output);
    if (self->variables->exchange)
        write_unknowns(stream, self, old ? "Derivatives" : "ContinuousStateDerivative", false,
                       is_rate);
    write_unknowns(stream, self, old ? "InitialUnknowns" : "InitialUnknown", true,
                   is_found_at_start);
    if (!old)
        write_unknowns(stream, self, "EventIndicator", false, is_indicator);
    fputs("  </ModelStructure>\n", stream);
}

// ---- the whole ----

static void write_root(FILE *stream, const fmu_description *self)
{
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", stream);
    fprintf(stream, "<fmiModelDescription fmiVersion=\"%s\" modelName=\"",
            self->version == 2 ? "2.0" : "3.0");
    fmu_write_text(stream, self->title);
    fprintf(
        stream,
        "\"\n    %s=\"%s\"\n    generationTool=\"launchdyn %s\" variableNamingConvention=\"flat\"",
        self->version == 2 ? "guid" : "instantiationToken", self->token, ld_version());
    if (self->version == 2)
        fprintf(stream, " numberOfEventIndicators=\"%zu\"",
                fmu_group_count(self->variables, FMU_INDICATOR));
    fputs(">\n", stream);
}

static void write_derivatives(FILE *stream, const fmu_description *self)
{
    fputs(self->version == 2 ? "      providesDirectionalDerivative=\"true\"\n"
                             : "      providesDirectionalDerivatives=\"true\" "
                               "providesAdjointDerivatives=\"true\"\n",
          stream);
}

static void write_model_exchange(FILE *stream, const fmu_description *self)
{
    fprintf(stream, "  <ModelExchange modelIdentifier=\"%s\"\n", self->identifier);
    write_derivatives(stream, self);
    fputs(self->version == 2
              ? "      canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\"/>\n"
              : "      canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" "
                "needsCompletedIntegratorStep=\"true\"/>\n",
          stream);
}

static void write_co_simulation(FILE *stream, const fmu_description *self)
{
    fprintf(stream,
            "  <CoSimulation modelIdentifier=\"%s\" "
            "canHandleVariableCommunicationStepSize=\"true\"\n",
            self->identifier);
    if (self->variables->runner->input_count > 0)
        write_derivatives(stream, self);
    fputs(self->version == 2
              ? "      canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\"/>\n"
              : "      canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" "
                "hasEventMode=\"true\"/>\n",
          stream);
}

void fmu_write_experiment(FILE *stream, double start, double stop, double tolerance)
{
    fprintf(stream, " startTime=\"%.17g\"", start);
    if (!isnan(stop))
        fprintf(stream, " stopTime=\"%.12g\"", stop);
    if (!isnan(tolerance))
        fprintf(stream, " tolerance=\"%.17g\"", tolerance);
}

void fmu_description_write(const fmu_description *self, FILE *stream)
{
    write_root(stream, self);
    if (self->variables->exchange)
        write_model_exchange(stream, self);
    write_co_simulation(stream, self);
    write_units(stream, self->variables);
    fputs("  <LogCategories><Category name=\"logStatusError\"/></LogCategories>\n", stream);
    fputs("  <DefaultExperiment", stream);
    fmu_write_experiment(stream, self->start, self->stop, self->tolerance);
    fputs("/>\n", stream);
    fputs("  <ModelVariables>\n", stream);
    for (size_t i = 0; i < self->variables->count; i += fmu_listed_length(self, i))
        (self->version == 2 ? write_variable_2 : write_variable_3)(stream, self, i);
    fputs("  </ModelVariables>\n", stream);
    write_structure(stream, self);
    fputs("</fmiModelDescription>\n", stream);
}
