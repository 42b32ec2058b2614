#include "foreign/description.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <expat.h>

#include "base/numeric_locale.h"
#include "base/suggestion.h"
#include "base/text_file.h"

enum {
    MOST_VARIABLES = 1000000,
    DEEPEST = 32,
    MOST_TEXT = 1 << 27,
    MOST_DEFINITIONS = 100000,
    MOST_ELEMENTS = 1000000
};

static const char *const type_names[FOREIGN_TYPES] = {
    "Float64", "Float32", "Int8",    "UInt8",       "Int16",  "UInt16", "Int32", "UInt32",
    "Int64",   "UInt64",  "Boolean", "Enumeration", "String", "Binary", "Clock"};
static const char *const causality_names[FOREIGN_CAUSALITIES] = {
    "local", "parameter", "calculatedParameter", "structuralParameter",
    "input", "output",    "independent",         "dependent"};
static const char *const variability_names[FOREIGN_VARIABILITIES] = {"constant", "fixed", "tunable",
                                                                     "discrete", "continuous"};

// A declared type: all that is requested of it is its unit.
typedef struct declared_type {
    char *name, *unit;
} declared_type;

// A dimension of an array, of as many elements as it says or as a structural parameter does.
typedef struct array_dimension {
    size_t variable; // its place as it was read
    bool by_parameter;
    uint32_t number; // elements or value reference
} array_dimension;

typedef struct description_reader {
    const char *name; // of the FMU
    foreign_description *of;
    ld_error *error;
    ld_status status; // other than LD_OK: what follows is left out
    XML_Parser parser;
    int depth;
    bool co_simulation, in_variables, in_types;
    size_t room, type_count;
    declared_type *type;
    size_t dimension_count;
    array_dimension *dimension;
    char *open_type; // name of the SimpleType (FMI 2) that is open
} description_reader;

static void fail(description_reader *self, ld_status status, const char *what, const char *found)
{
    if (self->status)
        return;
    self->status =
        ld_fail(self->error, status, "%.200s: modelDescription.xml:%lu: %s%.200s", self->name,
                (unsigned long)XML_GetCurrentLineNumber(self->parser), what, found);
    XML_StopParser(self->parser, XML_FALSE);
}

static char *copy_text(description_reader *self, const char *text)
{
    char *copy = text ? strdup(text) : NULL;
    if (text && !copy)
        fail(self, LD_ERR_MEMORY, "no memory", "");
    return copy;
}

// Room for one more member behind `count` of them; NULL: there is none.
static void *one_more(description_reader *self, void **list, size_t count, size_t size)
{
    bool full = (count & (count - 1)) == 0; // 0, 1, 2, 4, ...
    void *grown = full ? realloc(*list, (count ? 2 * count : 1) * size) : *list;
    if (!grown) {
        fail(self, LD_ERR_MEMORY, "no memory", "");
        return NULL;
    }
    *list = grown;
    return memset((char *)grown + count * size, 0, size);
}

// ---- attributes

static const char *attribute(const XML_Char **attributes, const char *name)
{
    for (; attributes[0]; attributes += 2)
        if (strcmp(attributes[0], name) == 0)
            return attributes[1];
    return NULL;
}

static bool is_true(const XML_Char **attributes, const char *name)
{
    const char *text = attribute(attributes, name);
    return text && (strcmp(text, "true") == 0 || strcmp(text, "1") == 0);
}

// A number of XML, which knows no locale; false: it is none.
static bool number_of(const char *text, double *value)
{
    char *end;
    locale_t before = numeric_locale_enter();
    *value = strtod(text, &end);
    numeric_locale_leave(before);
    return end != text && !*end;
}

static double number(description_reader *self, const XML_Char **attributes, const char *name,
                     double otherwise)
{
    const char *text = attribute(attributes, name);
    double value = otherwise;
    if (text && !number_of(text, &value))
        fail(self, LD_ERR_INPUT, "found, in place of a number: ", text);
    return value;
}

// The place of an attribute's word in a list of them.
static int word(description_reader *self, const XML_Char **attributes, const char *name,
                const char *const *words, int count, int otherwise)
{
    const char *text = attribute(attributes, name);
    if (!text)
        return otherwise;
    for (int i = 0; i < count; i++)
        if (strcmp(words[i], text) == 0)
            return i;
    fail(self, LD_ERR_INPUT, "unknown word: ", text);
    return otherwise;
}

// ---- elements

static void read_root(description_reader *self, const char *element, const XML_Char **attributes)
{
    foreign_description *of = self->of;
    const char *version = attribute(attributes, "fmiVersion");
    if (strcmp(element, "fmiModelDescription") != 0 || !version) {
        fail(self, LD_ERR_INPUT, "is not a description of an FMU: its root is ", element);
        return;
    }
    of->version = version[0] == '2' && version[1] == '.'   ? 2
                  : version[0] == '3' && version[1] == '.' ? 3
                                                           : 0;
    if (!of->version) {
        fail(self, LD_ERR_INPUT, "has an FMI version other than 2 and 3: ", version);
        return;
    }
    of->token =
        copy_text(self, attribute(attributes, of->version == 2 ? "guid" : "instantiationToken"));
    of->model = copy_text(self, attribute(attributes, "modelName"));
    if (!self->status && !of->token)
        fail(self, LD_ERR_INPUT, "has no ", of->version == 2 ? "guid" : "instantiationToken");
}

// A file's name without a path: the binary is called so.
static bool is_identifier(const char *text)
{
    for (const char *c = text; *c; c++)
        if (!isalnum((unsigned char)*c) && *c != '_')
            return false;
    return *text && strlen(text) < 200;
}

static void read_co_simulation(description_reader *self, const XML_Char **attributes)
{
    foreign_description *of = self->of;
    const char *identifier = attribute(attributes, "modelIdentifier");
    bool two = of->version == 2;
    self->co_simulation = true;
    if (!identifier || !is_identifier(identifier) || of->identifier) {
        fail(self, LD_ERR_INPUT, "requires one modelIdentifier that is a name in C; found ",
             identifier ? identifier : "none");
        return;
    }
    of->identifier = copy_text(self, identifier);
    of->keeps_state = is_true(attributes, two ? "canGetAndSetFMUstate" : "canGetAndSetFMUState");
    of->saves_state = of->keeps_state &&
                      is_true(attributes, two ? "canSerializeFMUstate" : "canSerializeFMUState");
    of->needs_tool = is_true(attributes, "needsExecutionTool");
    of->takes_rates = two && is_true(attributes, "canInterpolateInputs");
    if (!is_true(attributes, "canHandleVariableCommunicationStepSize"))
        of->step = number(self, attributes, "fixedInternalStepSize", 0);
}

static void read_unit(description_reader *self, const XML_Char **attributes)
{
    foreign_description *of = self->of;
    foreign_unit *unit = of->unit_count < MOST_DEFINITIONS
                             ? one_more(self, (void **)&of->unit, of->unit_count, sizeof *unit)
                             : NULL;
    if (!unit)
        return;
    unit->name = copy_text(self, attribute(attributes, "name"));
    of->unit_count++;
}

static void read_base_unit(description_reader *self, const XML_Char **attributes)
{
    static const char *const base[FOREIGN_BASE_UNITS] = {"kg", "m",   "s",  "A",
                                                         "K",  "mol", "cd", "rad"};
    if (self->of->unit_count == 0)
        return;
    foreign_unit *unit = &self->of->unit[self->of->unit_count - 1];
    unit->described = true;
    for (int i = 0; i < FOREIGN_BASE_UNITS; i++) {
        double power = number(self, attributes, base[i], 0);
        unit->power[i] = power > -100 && power < 100 ? (int)power : 100;
    }
    unit->factor = number(self, attributes, "factor", 1);
    unit->offset = number(self, attributes, "offset", 0);
}

static void read_type(description_reader *self, const char *name, const char *unit)
{
    declared_type *type = name && self->type_count < MOST_DEFINITIONS
                              ? one_more(self, (void **)&self->type, self->type_count, sizeof *type)
                              : NULL;
    if (!type)
        return;
    self->type_count++;
    type->name = copy_text(self, name);
    type->unit = copy_text(self, unit);
}

// A whole number from 0 to UINT32_MAX; false: it is none.
static bool whole_of(const char *text, uint32_t *value)
{
    double number;
    if (!text || !isdigit((unsigned char)*text) || !number_of(text, &number) ||
        !(number <= UINT32_MAX) || number != (uint32_t)number)
        return false;
    *value = (uint32_t)number;
    return true;
}

static foreign_variable *new_variable(description_reader *self, const char *name,
                                      const char *reference)
{
    foreign_description *of = self->of;
    uint32_t number = 0;
    if (!name || !*name)
        fail(self, LD_ERR_INPUT, "has a variable without a name", "");
    else if (!whole_of(reference, &number))
        fail(self, LD_ERR_INPUT, "has no good valueReference of variable ", name);
    else if (of->count == MOST_VARIABLES)
        fail(self, LD_ERR_INPUT, "has too many variables", "");
    foreign_variable *variable =
        self->status ? NULL : one_more(self, (void **)&of->variable, of->count, sizeof *variable);
    if (!variable)
        return NULL;
    of->count++;
    variable->name = copy_text(self, name);
    variable->reference = number;
    return variable;
}

static void read_traits(description_reader *self, const XML_Char **attributes,
                        foreign_variable *variable)
{
    variable->causality = (foreign_causality)word(self, attributes, "causality", causality_names,
                                                  FOREIGN_CAUSALITIES, FOREIGN_LOCAL);
    variable->variability =
        (foreign_variability)word(self, attributes, "variability", variability_names,
                                  FOREIGN_VARIABILITIES, FOREIGN_CONTINUOUS);
}

// What an element of the type's name says of a variable.
static void read_kind(description_reader *self, foreign_type type, const XML_Char **attributes,
                      foreign_variable *variable)
{
    const char *start = attribute(attributes, "start");
    variable->type = type;
    variable->declared = copy_text(self, attribute(attributes, "declaredType"));
    variable->unit_name = copy_text(self, attribute(attributes, "unit"));
    if (type == FOREIGN_BOOLEAN && start)
        variable->has_start = true, variable->start = is_true(attributes, "start");
    else if (type <= FOREIGN_ENUMERATION && start)
        variable->has_start = number_of(start, &variable->start);
    if (type == FOREIGN_CLOCK)
        fail(self, LD_ERR_INPUT, "has a clock, which is not supported: ", variable->name);
}

// The types of FMI 2 by the names of FMI 3; -1: it is none.
static int type_of(const char *element, int version)
{
    if (version == 2 && strcmp(element, "Real") == 0)
        return FOREIGN_FLOAT64;
    if (version == 2 && strcmp(element, "Integer") == 0)
        return FOREIGN_INT32;
    for (int i = 0; i < FOREIGN_TYPES; i++)
        if (strcmp(element, type_names[i]) == 0)
            return i;
    return -1;
}

static void read_variable_2(description_reader *self, const char *element,
                            const XML_Char **attributes)
{
    foreign_description *of = self->of;
    int type = type_of(element, 2);
    if (strcmp(element, "ScalarVariable") == 0) {
        foreign_variable *variable = new_variable(self, attribute(attributes, "name"),
                                                  attribute(attributes, "valueReference"));
        if (variable)
            read_traits(self, attributes, variable);
    } else if (type >= 0 && self->depth == 4 && of->count > 0 &&
               !of->variable[of->count - 1].declared && !of->variable[of->count - 1].unit_name) {
        read_kind(self, (foreign_type)type, attributes, &of->variable[of->count - 1]);
    }
}

// One more of the last variable.
static void add_dimension(description_reader *self, bool by_parameter, uint32_t number)
{
    if (self->dimension_count == MOST_DEFINITIONS)
        fail(self, LD_ERR_INPUT, "has too many dimensions", "");
    array_dimension *dimension = self->status ? NULL
                                              : one_more(self, (void **)&self->dimension,
                                                         self->dimension_count, sizeof *dimension);
    if (!dimension)
        return;
    *dimension = (array_dimension){self->of->count - 1, by_parameter, number};
    self->dimension_count++;
    self->of->variable[self->of->count - 1].elements = 1; // until all parameters are there
}

static void read_dimension(description_reader *self, const XML_Char **attributes)
{
    const char *start = attribute(attributes, "start");
    const char *reference = attribute(attributes, "valueReference");
    uint32_t number;
    if (!start == !reference || !whole_of(start ? start : reference, &number))
        fail(self, LD_ERR_INPUT,
             "requires start or valueReference, a whole number, of a dimension of variable ",
             self->of->variable[self->of->count - 1].name);
    else
        add_dimension(self, reference != NULL, number);
}

// Another name of the variable that is open (FMI 3).
static void read_alias(description_reader *self, const XML_Char **attributes)
{
    foreign_description *of = self->of;
    foreign_variable first = of->variable[of->count - 1];
    foreign_variable *alias = new_variable(self, attribute(attributes, "name"), "0");
    if (!alias)
        return;
    first.name = alias->name;
    *alias = first;
    alias->declared = copy_text(self, first.declared);
    alias->unit_name = copy_text(self, first.unit_name);
    for (size_t i = self->dimension_count;
         i > 0 && self->dimension[i - 1].variable == of->count - 2 && !self->status; i--)
        add_dimension(self, self->dimension[i - 1].by_parameter, self->dimension[i - 1].number);
}

static void read_variable_3(description_reader *self, const char *element,
                            const XML_Char **attributes)
{
    foreign_description *of = self->of;
    int type = type_of(element, 3);
    if (self->depth == 3 && type >= 0) {
        foreign_variable *variable = new_variable(self, attribute(attributes, "name"),
                                                  attribute(attributes, "valueReference"));
        if (!variable)
            return;
        read_traits(self, attributes, variable);
        read_kind(self, (foreign_type)type, attributes, variable);
    } else if (self->depth == 4 && of->count > 0 && strcmp(element, "Dimension") == 0) {
        read_dimension(self, attributes);
    } else if (self->depth == 4 && of->count > 0 && strcmp(element, "Alias") == 0) {
        read_alias(self, attributes);
    }
}

static void read_element(description_reader *self, const char *element, const XML_Char **attributes)
{
    if (self->depth == 2) {
        self->in_variables = strcmp(element, "ModelVariables") == 0;
        self->in_types = strcmp(element, "TypeDefinitions") == 0;
        if (strcmp(element, "CoSimulation") == 0)
            read_co_simulation(self, attributes);
        return;
    }
    if (self->in_variables && self->of->version == 2)
        read_variable_2(self, element, attributes);
    else if (self->in_variables)
        read_variable_3(self, element, attributes);
    else if (self->in_types && self->of->version == 3)
        read_type(self, attribute(attributes, "name"), attribute(attributes, "unit"));
    else if (self->in_types && strcmp(element, "SimpleType") == 0) {
        free(self->open_type);
        self->open_type = copy_text(self, attribute(attributes, "name"));
    } else if (self->in_types && self->depth == 4)
        read_type(self, self->open_type, attribute(attributes, "unit"));
    else if (strcmp(element, "Unit") == 0)
        read_unit(self, attributes);
    else if (strcmp(element, "BaseUnit") == 0)
        read_base_unit(self, attributes);
}

// ---- expat

static void begin_element(void *user, const XML_Char *element, const XML_Char **attributes)
{
    description_reader *self = user;
    if (self->status)
        return;
    if (++self->depth > DEEPEST)
        fail(self, LD_ERR_INPUT, "is nested too deeply", "");
    else if (self->depth == 1)
        read_root(self, element, attributes);
    else
        read_element(self, element, attributes);
}

static void end_element(void *user, const XML_Char *element)
{
    description_reader *self = user;
    (void)element;
    self->depth--;
}

// No description has one; with it come entities.
static void begin_doctype(void *user, const XML_Char *name, const XML_Char *system,
                          const XML_Char *public, int internal)
{
    (void)system, (void)public, (void)internal;
    fail(user, LD_ERR_INPUT, "has a DOCTYPE, which is not allowed: ", name);
}

// ---- when all has been read

static int by_name(const void *a, const void *b)
{
    return strcmp(((const foreign_variable *)a)->name, ((const foreign_variable *)b)->name);
}

static const foreign_unit *unit_named(const foreign_description *of, const char *name)
{
    for (size_t i = 0; i < of->unit_count && name; i++)
        if (of->unit[i].described && of->unit[i].name && strcmp(of->unit[i].name, name) == 0)
            return &of->unit[i];
    return NULL;
}

static void find_unit(const description_reader *self, foreign_variable *variable)
{
    const char *name = variable->unit_name;
    for (size_t i = 0; i < self->type_count && !name && variable->declared; i++)
        if (self->type[i].name && strcmp(self->type[i].name, variable->declared) == 0)
            name = self->type[i].unit;
    variable->unit = unit_named(self->of, name);
}

// Its elements; 0: there is no such structural parameter, or it is not a number of elements.
static double dimension_size(const foreign_description *of, const array_dimension *dimension)
{
    if (!dimension->by_parameter)
        return dimension->number;
    for (size_t i = 0; i < of->count; i++) {
        const foreign_variable *one = &of->variable[i];
        if (one->reference == dimension->number && one->causality == FOREIGN_STRUCTURAL_PARAMETER)
            return one->type < FOREIGN_BOOLEAN && one->has_start && one->start == floor(one->start)
                       ? one->start
                       : 0;
    }
    return 0;
}

// Arrays are as large as their dimensions' start values say (FMI 3.0.2 section 2.4.7.4).
static void size_arrays(description_reader *self)
{
    foreign_description *of = self->of;
    for (size_t i = 0; i < self->dimension_count && !self->status; i++) {
        foreign_variable *array = &of->variable[self->dimension[i].variable];
        double elements = array->elements * dimension_size(of, &self->dimension[i]);
        if (elements >= 1 && elements <= MOST_ELEMENTS)
            array->elements = (uint32_t)elements;
        else
            fail(self, LD_ERR_INPUT,
                 "has an array of 0 or more than a million elements: ", array->name);
    }
}

static ld_status complete(description_reader *self)
{
    foreign_description *of = self->of;
    size_arrays(self);
    if (self->status)
        return self->status;
    if (!self->co_simulation)
        return ld_fail(self->error, LD_ERR_INPUT,
                       "%.300s: is not an FMU for co-simulation, which a base requires",
                       self->name);
    if (of->count)
        qsort(of->variable, of->count, sizeof *of->variable, by_name);
    for (size_t i = 1; i < of->count; i++)
        if (by_name(&of->variable[i - 1], &of->variable[i]) == 0)
            return ld_fail(self->error, LD_ERR_INPUT,
                           "%.200s: modelDescription.xml: has two variables %.200s", self->name,
                           of->variable[i].name);
    for (size_t i = 0; i < of->count; i++)
        find_unit(self, &of->variable[i]);
    return LD_OK;
}

static ld_status parse(description_reader *self, const char *text, size_t length)
{
    XML_SetUserData(self->parser, self);
    XML_SetElementHandler(self->parser, begin_element, end_element);
    XML_SetStartDoctypeDeclHandler(self->parser, begin_doctype);
    bool good = XML_Parse(self->parser, text, (int)length, 1) == XML_STATUS_OK;
    if (!good && !self->status)
        fail(self,
             XML_GetErrorCode(self->parser) == XML_ERROR_NO_MEMORY ? LD_ERR_MEMORY : LD_ERR_INPUT,
             "is not valid XML: ", XML_ErrorString(XML_GetErrorCode(self->parser)));
    return self->status ? self->status : complete(self);
}

ld_status foreign_describe_text(const char *text, size_t length, const char *name,
                                foreign_description *out, ld_error *error)
{
    *out = (foreign_description){0};
    description_reader self = {
        .name = name, .of = out, .error = error, .parser = XML_ParserCreate(NULL)};
    ld_status status =
        !self.parser ? ld_fail(error, LD_ERR_MEMORY, "no memory for an FMU")
        : length > MOST_TEXT
            ? ld_fail(error, LD_ERR_INPUT, "%.300s: modelDescription.xml is too long", name)
            : parse(&self, text, length);
    if (self.parser)
        XML_ParserFree(self.parser);
    for (size_t i = 0; i < self.type_count; i++) {
        free(self.type[i].name);
        free(self.type[i].unit);
    }
    free(self.type);
    free(self.dimension);
    free(self.open_type);
    if (status)
        foreign_description_free(out);
    return status;
}

ld_status foreign_describe(const char *path, const char *name, foreign_description *out,
                           ld_error *error)
{
    char *text = NULL;
    size_t length;
    ld_error why;
    *out = (foreign_description){0};
    ld_status status = text_file_read(path, MOST_TEXT, &text, &length, &why);
    if (status)
        return ld_fail(error, status, "%.200s: its modelDescription.xml %.300s", name, why.text);
    status = foreign_describe_text(text, length, name, out, error);
    free(text);
    return status;
}

void foreign_description_free(foreign_description *self)
{
    for (size_t i = 0; i < self->count; i++) {
        free(self->variable[i].name);
        free(self->variable[i].declared);
        free(self->variable[i].unit_name);
    }
    for (size_t i = 0; i < self->unit_count; i++)
        free(self->unit[i].name);
    free(self->variable);
    free(self->unit);
    free(self->token);
    free(self->model);
    free(self->identifier);
    *self = (foreign_description){0};
}

// ---- what is in it

static int is_named(const void *name, const void *variable)
{
    return strcmp(name, ((const foreign_variable *)variable)->name);
}

const foreign_variable *foreign_variable_find(const foreign_description *self, const char *name)
{
    return self->count
               ? bsearch(name, self->variable, self->count, sizeof *self->variable, is_named)
               : NULL;
}

const char *foreign_variable_near(const foreign_description *self, const char *name,
                                  foreign_causality causality)
{
    name_suggestion near = suggestion_begin(name);
    for (size_t i = 0; i < self->count; i++)
        if (self->variable[i].causality == causality)
            suggestion_offer(&near, self->variable[i].name);
    return near.name;
}

const char *foreign_causality_name(foreign_causality causality)
{
    return causality_names[causality];
}

const char *foreign_type_name(foreign_type type)
{
    return type_names[type];
}
