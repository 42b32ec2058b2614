// Descriptions of FMUs: what is read of them, and what is refused with one sentence.
#include <stdlib.h>

#include "foreign/description.h"
#include "support/check.h"

#define ROOT_2 "<fmiModelDescription fmiVersion='2.0' guid='{8}' modelName='m'>"
#define ROOT_3 "<fmiModelDescription fmiVersion='3.0' instantiationToken='{9}' modelName='m'>"
#define CS "<CoSimulation modelIdentifier='it'/>"
#define END "</fmiModelDescription>"

static foreign_description described(const char *text)
{
    foreign_description of;
    ld_error error;
    if (foreign_describe_text(text, strlen(text), "x.fmu", &of, &error))
        fail_msg("%s", error.text);
    return of;
}

static void variables_of_FMI_2(void **state)
{
    (void)state;
    foreign_description of = described(
        ROOT_2 "<CoSimulation modelIdentifier='it' canGetAndSetFMUstate='true' "
               "canSerializeFMUstate='1' needsExecutionTool='true' fixedInternalStepSize='0.01'/>"
               "<UnitDefinitions><Unit name='deg'><BaseUnit rad='1' factor='0.5'/></Unit>"
               "<Unit name='bare'/></UnitDefinitions><TypeDefinitions>"
               "<SimpleType name='Angle'><Real unit='deg'/></SimpleType></TypeDefinitions>"
               "<ModelVariables><ScalarVariable name='b' valueReference='7' causality='input'>"
               "<Real declaredType='Angle' start='1.5'/></ScalarVariable>"
               "<ScalarVariable name='a' valueReference='4294967295' causality='parameter' "
               "variability='fixed'><Integer start='-3'/></ScalarVariable>"
               "<ScalarVariable name='c' valueReference='0' causality='output'>"
               "<Boolean/></ScalarVariable>"
               "<ScalarVariable name='d' valueReference='1'><Real unit='bare'/></ScalarVariable>"
               "</ModelVariables>" END);
    assert_int_equal(of.version, 2);
    assert_string_equal(of.token, "{8}");
    assert_string_equal(of.identifier, "it");
    assert_true(of.keeps_state && of.saves_state && of.needs_tool && of.step == 0.01);
    assert_int_equal(of.count, 4);
    const foreign_variable *b = foreign_variable_find(&of, "b"),
                           *a = foreign_variable_find(&of, "a");
    assert_true(b->type == FOREIGN_FLOAT64 && b->causality == FOREIGN_INPUT && b->reference == 7);
    assert_true(b->has_start && b->start == 1.5 && b->unit && b->unit->factor == 0.5);
    assert_int_equal(b->unit->power[7], 1);
    assert_true(a->type == FOREIGN_INT32 && a->reference == 4294967295u && a->start == -3);
    assert_true(a->causality == FOREIGN_PARAMETER && a->variability == FOREIGN_FIXED);
    assert_true(foreign_variable_find(&of, "c")->type == FOREIGN_BOOLEAN);
    assert_null(foreign_variable_find(&of, "d")->unit);
    assert_null(foreign_variable_find(&of, "e"));
    foreign_description_free(&of);
}

static void variables_of_FMI_3(void **state)
{
    (void)state;
    foreign_description of = described(
        ROOT_3 "<CoSimulation modelIdentifier='it' canHandleVariableCommunicationStepSize='true' "
               "fixedInternalStepSize='0.01' canGetAndSetFMUState='true'/>"
               "<UnitDefinitions><Unit name='km'><BaseUnit m='1' factor='1e3' offset='2'/></Unit>"
               "</UnitDefinitions><TypeDefinitions><Float64Type name='Way' unit='km'/>"
               "</TypeDefinitions><ModelVariables>"
               "<Float64 name='x' valueReference='1' causality='output' declaredType='Way'>"
               "<Alias name='also x'/></Float64>"
               "<Float32 name='y' valueReference='2' causality='output'><Dimension start='3'/>"
               "</Float32><Int8 name='z' valueReference='3' causality='structuralParameter' "
               "variability='tunable' start='1'/></ModelVariables>" END);
    assert_true(of.version == 3 && of.step == 0 && of.keeps_state && !of.saves_state);
    const foreign_variable *x = foreign_variable_find(&of, "x");
    const foreign_variable *also = foreign_variable_find(&of, "also x");
    assert_true(x->unit && x->unit->factor == 1e3 && x->unit->offset == 2);
    assert_true(also && also->reference == 1 && also->unit == x->unit);
    assert_true(foreign_variable_find(&of, "y")->elements == 3 && x->elements == 0);
    assert_true(foreign_variable_find(&of, "z")->type == FOREIGN_INT8);
    assert_string_equal(foreign_variable_near(&of, "also_x", FOREIGN_OUTPUT), "also x");
    foreign_description_free(&of);
}

// FMI 3.0.2 section 2.4.7.4: the parameter may come later; another name is as large.
static void arrays_of_FMI_3(void **state)
{
    (void)state;
    foreign_description of = described(
        ROOT_3 "<CoSimulation modelIdentifier='it'/><ModelVariables>"
               "<Float64 name='A' valueReference='1' causality='output'><Dimension start='4'/>"
               "<Dimension valueReference='7'/><Alias name='also A'/></Float64>"
               "<Float64 name='also 7' valueReference='8' start='9'/>"
               "<UInt64 name='n' valueReference='7' causality='structuralParameter' start='5'/>"
               "<Float64 name='r' valueReference='9'><Dimension start='1'/></Float64>"
               "</ModelVariables>" END);
    assert_int_equal(foreign_variable_find(&of, "A")->elements, 20);
    assert_int_equal(foreign_variable_find(&of, "also A")->elements, 20);
    assert_int_equal(foreign_variable_find(&of, "r")->elements, 1);
    assert_int_equal(foreign_variable_find(&of, "n")->elements, 0);
    foreign_description_free(&of);
}

#define VARIABLES(inner) ROOT_3 CS "<ModelVariables>" inner "</ModelVariables>" END

static const struct {
    const char *text, *in;
} wrong[] = {
    {"", "modelDescription.xml:1: is not valid XML: no element found"},
    {"<a", "modelDescription.xml:1: is not valid XML: "},
    {"<a/>", "is not a description of an FMU: its root is a"},
    {"<fmiModelDescription fmiVersion='1.0'/>", "has an FMI version other than 2 and 3: 1.0"},
    {"<fmiModelDescription fmiVersion='2.0'/>", "has no guid"},
    {"<fmiModelDescription fmiVersion='3.0'/>", "has no instantiationToken"},
    {ROOT_2 "<ModelExchange modelIdentifier='it'/>" END, "x.fmu: is not an FMU for co-simulation"},
    {ROOT_2 "<CoSimulation/>" END, "requires one modelIdentifier that is a name in C; found none"},
    {ROOT_2 "<CoSimulation modelIdentifier='../it'/>" END, "found ../it"},
    {VARIABLES("<Float64 valueReference='1'/>"), "has a variable without a name"},
    {VARIABLES("<Float64 name='a'/>"), "has no good valueReference of variable a"},
    {VARIABLES("<Float64 name='a' valueReference='-1'/>"), "has no good valueReference"},
    {VARIABLES("<Float64 name='a' valueReference='4294967296'/>"), "has no good valueReference"},
    {VARIABLES("<Float64 name='a' valueReference='1' causality='both'/>"), "unknown word: both"},
    {VARIABLES("<Float64 name='a' valueReference='1'/><Int8 name='a' valueReference='2'/>"),
     "has two variables a"},
    {VARIABLES("<Int8 name='a' valueReference='1'><Dimension/></Int8>"),
     "requires start or valueReference, a whole number, of a dimension of variable a"},
    {VARIABLES("<Int8 name='a' valueReference='1'><Dimension start='-1'/></Int8>"),
     "requires start or valueReference, "},
    {VARIABLES(
         "<Int8 name='a' valueReference='1'><Dimension start='1' valueReference='1'/></Int8>"),
     "requires start or valueReference, "},
    {VARIABLES("<Int8 name='a' valueReference='1'><Dimension start='0'/></Int8>"),
     "has an array of 0 or more than a million elements: a"},
    {VARIABLES("<Int8 name='a' valueReference='1'><Dimension start='1001'/><Dimension "
               "start='1000'/></Int8>"),
     "an array of 0 or more than a million elements: a"},
    {VARIABLES(
         "<Int8 name='a' valueReference='1' start='1'><Dimension valueReference='1'/></Int8>"),
     "an array of 0 or more than a million elements: a"},
    {VARIABLES("\n<Clock name='tick' valueReference='1'/>"),
     "x.fmu: modelDescription.xml:2: has a clock, which is not supported: tick"},
    {"<!DOCTYPE f [<!ENTITY a 'b'>]>" ROOT_2 "&a;" END, "has a DOCTYPE"},
};

static void what_is_wrong_is_one_sentence(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        foreign_description of;
        ld_error error = {0};
        assert_int_equal(
            foreign_describe_text(wrong[i].text, strlen(wrong[i].text), "x.fmu", &of, &error),
            LD_ERR_INPUT);
        if (!strstr(error.text, wrong[i].in))
            fail_msg("\"%s\" is not in: %s", wrong[i].in, error.text);
        assert_int_equal(of.count, 0);
    }
}

static void nesting(void **state)
{
    (void)state;
    char text[4096] = ROOT_2;
    foreign_description of;
    ld_error error;
    for (int i = 0; i < 40; i++)
        strcat(text, "<a>");
    assert_int_equal(foreign_describe_text(text, strlen(text), "x.fmu", &of, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "is nested too deeply"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variables_of_FMI_2),
        cmocka_unit_test(variables_of_FMI_3),
        cmocka_unit_test(arrays_of_FMI_3),
        cmocka_unit_test(what_is_wrong_is_one_sentence),
        cmocka_unit_test(nesting),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
