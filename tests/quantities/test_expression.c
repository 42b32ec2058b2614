// Expressions: values against the C library's functions, units against a table by hand, what is
// refused and where, limits.
#include "support/check.h"

#include "launchdyn/status.h"
#include "quantities/expression.h"

// ---- names of our own

enum { OPERANDS = 8 };
static const struct {
    const char *name, *unit;
    double value;
} operands[OPERANDS] = {{"a", "m", 3},  {"b.c", "m", -4},   {"v", "m/s", 2.5}, {"turn", "rad", 0.3},
                        {"x", "", 0.7}, {"x-y", "1", 0.25}, {"y", "", 5},      {"q", "kg0.5.m", 1}};
enum { MISSING = 100, WINDOWS = 200 };

static int windows;
static expression_window window[40];
static bool over;

static int find(void *self, bool over_time, const char *name, const char **unit)
{
    (void)self;
    over = over_time;
    for (int i = 0; i < OPERANDS; i++)
        if (strcmp(operands[i].name, name) == 0) {
            *unit = operands[i].unit;
            return i;
        }
    *unit = "m";
    return strcmp(name, "gone") == 0 ? MISSING : -1;
}

static void explain(void *self, bool over_time, const char *name, char why[EXPRESSION_WHY])
{
    (void)self;
    snprintf(why, EXPRESSION_WHY, "no %s %s", over_time ? "column" : "result", name);
}

static bool open_window(void *self, const expression_window *opened, char why[EXPRESSION_WHY])
{
    (void)self;
    bool good = strcmp(opened->from, "never") != 0;
    snprintf(why, EXPRESSION_WHY, "%s", good ? "" : "it never occurs");
    return good;
}

static int close_window(void *self, const expression_window *closed, char why[EXPRESSION_WHY])
{
    (void)self;
    snprintf(why, EXPRESSION_WHY, "%s", windows < 40 ? "" : "too many");
    if (windows == 40)
        return -1;
    window[windows] = *closed;
    return WINDOWS + windows++;
}

static const expression_names names = {find, explain, open_window, close_window, NULL};

static double value_of(const void *self, int number)
{
    (void)self;
    return number < OPERANDS  ? operands[number].value
           : number < WINDOWS ? NAN
                              : 100 + number - WINDOWS;
}

static bool read(const char *text, expression_code *code, expression_part *part,
                 units_dimension *unit, expression_refusal *refusal)
{
    windows = 0;
    code->count = 0;
    return expression_read(text, &names, code, part, unit, refusal);
}

static double evaluated(const char *text, char unit_text[UNITS_TEXT])
{
    static expression_code code;
    expression_part part;
    units_dimension unit;
    expression_refusal refusal;
    if (!read(text, &code, &part, &unit, &refusal))
        fail_msg("%s: %d: %s", text, refusal.at, refusal.why);
    units_write(&unit, unit_text);
    return expression_value(&code, part, value_of, NULL);
}

// ---- values

static void test_values(void **state)
{
    (void)state;
    const struct {
        const char *text;
        double value;
        const char *unit;
    } cases[] = {
        {"a", 3, "m"},
        {"a + b.c", -1, "m"},
        {"a-b.c", 7, "m"},
        {"x-y", 0.25, ""},
        {"x - y", 0.7 - 5, ""},
        {"a-1 m - 2 m", 0, "m"},
        {"a - (1 m - 2 m)", 4, "m"},
        {"y / 2 / 5", 0.5, ""},
        {"y / (2 / 5)", 12.5, ""},
        {"2 + 3 * 4", 14, ""},
        {"(2 + 3) * 4", 20, ""},
        {"-2^2", -4, ""},
        {"(-2)^2", 4, ""},
        {"2^-2", 0.25, ""},
        {"y^0.5", 2.23606797749978969641, ""},
        {"y^0", 1, ""},
        {"y^11", 48828125, ""},
        {"1 - -y", 6, ""},
        {"2 * -a", -6, "m"},
        {"a^2", 9, "m2"},
        {"a^-2", 1.0 / 9, "1/m2"},
        {"b.c^3", -64, "m3"},
        {"sqrt(a^2 + b.c^2)", 5, "m"},
        {"hypot(a, b.c)", 5, "m"},
        {"hypot(a, b.c, 12 m)", 13, "m"},
        {"abs(b.c)", 4, "m"},
        {"min(a, b.c, 7 m)", -4, "m"},
        {"max(a, b.c, 0)", 3, "m"},
        {"max(0, b.c)", 0, "m"},
        {"a * v", 7.5, "m2/s"},
        {"a / v", 1.2, "s"},
        {"1 kg * v^2", 6.25, "N.m"},
        {"2 N * v", 5, "W"},
        {"3 N / a^2", 1.0 / 3, "Pa"},
        {"3 N / a / v", 0.4, "kg/m/s"},
        {"turn / 2 s", 0.15, "rad/s"},
        {"90 deg / turn", 5.23598775598298873077, ""},
        {"1 / (1 K * a)", 1.0 / 3, "1/m/K"},
        {"20 mrad/s * 2 s", 0.04, "rad"},
        {"50 % * y", 2.5, ""},
        {"1.5e1 + .5", 15.5, ""},
        {"2e3 mm", 2, "m"},
        {"36 km/h", 10, "m/s"},
        {"sin(turn)", 0.29552020666133957511, ""},
        {"cos(turn)", 0.95533648912560601964, ""},
        {"tan(turn)", 0.30933624960962323303, ""},
        {"asin(x)", 0.77539749661075306374, "rad"},
        {"acos(x)", 0.79539883018414355549, "rad"},
        {"atan(x)", 0.61072596438920861654, "rad"},
        {"atan2(b.c, a)", -0.92729521800161223243, "rad"},
        {"atan2(a, -b.c)", 0.64350110879328438680, "rad"},
        {"a > b.c", 1, ""},
        {"a < b.c", 0, ""},
        {"a <= 3 m", 1, ""},
        {"a >= 3.5 m", 0, ""},
        {"(a > 0) + (b.c > 0)", 1, ""},
        {"v > 0", 1, ""},
        {"a + 1 mm > b.c * 2", 1, ""},
        {" ( a\n+\ta )  ", 6, "m"},
        {"a/2", 1.5, "m"},
        {"largest(a)", 100, "m"},
        {"x + largest(x + y * 2) / mean(y)", 0.7 + 100.0 / 101, ""},
        {"(a at t_rear) - a", 97, "m"},
        {"a at t_rear - a", 97, "m"},
        {"rms(abs(a - 1 m) from t_front to t_exit.rear-one)", 100, "m"},
    };
    double worst = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char unit[UNITS_TEXT];
        double value = evaluated(cases[i].text, unit);
        if (strcmp(unit, cases[i].unit) != 0)
            fail_msg("%s: found the unit \"%s\"", cases[i].text, unit);
        double wrong = fabs(value - cases[i].value) / fmax(1, fabs(cases[i].value));
        if (!(wrong <= 4e-16))
            fail_msg("%s: found %.17g", cases[i].text, value);
        worst = fmax(worst, wrong);
    }
    CHECK_BELOW("expressions against their values", worst, 4e-16);
}

// What is missing, or is not a number, is not made one by any operation.
static void test_missing(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "gone",          "gone + a",         "min(gone, a)",   "max(a, gone)", "gone > a",
        "a <= gone",     "hypot(gone, a)",   "abs(gone)",      "gone^2",       "(gone / 1 m)^0",
        "sqrt(b.c * a)", "asin(y)",          "acos(-y)",       "y / (y - 5)",  "atan2(gone, a)",
        "0 * gone",      "(y / (y - 5))^-1", "10^300 * 10^300"};
    char unit[UNITS_TEXT];
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (!isnan(evaluated(texts[i], unit)))
            fail_msg("%s has a value", texts[i]);
}

// Of a window: the figure, its expression, where it begins, its instants.
static void test_windows(void **state)
{
    (void)state;
    static expression_code code;
    expression_part part;
    units_dimension unit;
    expression_refusal refusal;
    assert_true(
        read("y * largest(a + 2 * b.c from t_front to t_rear) / (v at end) / 1 s - change(y)",
             &code, &part, &unit, &refusal));
    assert_int_equal(windows, 3);
    assert_int_equal(window[0].take, LD_TAKE_LARGEST);
    assert_int_equal(window[0].at, 4);
    assert_string_equal(window[0].from, "t_front");
    assert_string_equal(window[0].to, "t_rear");
    assert_int_equal(window[1].take, LD_TAKE_VALUE);
    assert_string_equal(window[1].from, "end");
    assert_int_equal(window[2].take, LD_TAKE_CHANGE);
    assert_string_equal(window[2].from, "");
    CHECK_NEAR("its expression [m]", expression_value(&code, window[0].of, value_of, NULL), -5, 0);
    CHECK_NEAR("the column [m/s]", expression_value(&code, window[1].of, value_of, NULL), 2.5, 0);
    CHECK_NEAR("the whole", expression_value(&code, part, value_of, NULL), 5.0 * 100 / 101 - 102,
               1e-14);
}

// ---- what is refused

static void test_refused(void **state)
{
    (void)state;
    const struct {
        const char *text;
        int at;
        const char *why;
    } cases[] = {
        {"a + v", 0, "\"a + v\": found m and m/s; expected one unit"},
        {"2 * (a - v * 2)", 5, "\"a - v * 2\": found m and m/s; expected one unit"},
        {"a + 1", 0, "\"a + 1\": found m and a number without unit; expected one unit"},
        {"a + 0 s", 0, "\"a + 0 s\": found m and s; expected one unit"},
        {"a + turn * a", 0, "\"a + turn * a\": found m and m.rad; expected one unit"},
        {"x > a", 0, "\"x > a\": found a number without unit and m; expected one unit"},
        {"min(a, 1 m, v)", 4, "\"a, 1 m, v\": found m and m/s; expected one unit"},
        {"sin(x)", 4, "\"x\": found a number without unit; expected rad"},
        {"acos(turn)", 5, "\"turn\": found rad; expected a number without unit"},
        {"atan2(a, v)", 6, "\"a, v\": found m and m/s; expected one unit"},
        {"sqrt(a)", 5, "\"a\": found m; expected a square, such as m2"},
        {"a^0.5", 2, "found the exponent 0.5; of what has a unit, expected -9 to 9, whole"},
        {"a^10", 2, "found the exponent 10; of what has a unit, expected -9 to 9, whole"},
        {"a^5 * a^5", 0, "\"a^5 * a^5\": powers of units beyond 9"},
        {"1 km9.m", 2,
         "found \"km9.m\" after a number; expected a unit, such as mrad/s, or an operator between "
         "blanks"},
        {"a^a", 2, "found \"a\"; expected a number as exponent"},
        {"x^2^3", 3, "found \"^\"; expected an operator or the end"},
        {"q", 0, "\"q\": its unit kg0.5.m is not allowed in an expression"},
        {"", 0, "found the end; expected a result, a number, a function or \"(\""},
        {"a +", 3, "found the end; expected a result, a number, a function or \"(\""},
        {"--a", 1, "found \"-\"; expected a result, a number, a function or \"(\""},
        {"a b.c", 2, "found \"b.c\"; expected an operator or the end"},
        {"(a", 2, "found the end; expected an operator or \")\""},
        {"a)", 1, "found \")\"; expected an operator or the end"},
        {"1 < 2 < 3", 6, "found \"<\"; expected an operator or the end"},
        {"lost", 0, "no result lost"},
        {"2 * x-lost", 6, "no result lost"},
        {"mean(lost)", 5, "no column lost"},
        {"lost at t_rear", 0, "no column lost"},
        {"a at never", 0, "it never occurs"},
        {"x + mean(a from never to t_rear)", 4, "it never occurs"},
        {"a at", 4, "found the end; expected an instant such as t_rear"},
        {"mean(a from t_front)", 19, "expected \"to\" and an instant after \"from t_front\""},
        {"mean(a from to t_rear)", 14, "expected \"to\" and an instant after \"from to\""},
        {"mean(a", 6, "found the end; expected \")\", or \"from\" an instant \"to\" another"},
        {"mean(rms(a))", 5, "rms() is not allowed inside a window"},
        {"mean(a at t_rear)", 5,
         "\"a at t_rear\": a value at an instant is not allowed inside a "
         "window"},
        {"max(a)", 0, "max() has 1 argument; expected 2 or more (over time: largest)"},
        {"min(a)", 0, "min() has 1 argument; expected 2 or more (over time: least)"},
        {"hypot(a)", 0, "hypot() has 1 argument; expected 2 or more"},
        {"abs(a, a)", 0, "abs() has 2 arguments; expected 1"},
        {"sqtr(a)", 0, "found \"sqtr\", which is not a function; did you mean \"sqrt\"?"},
        {"larges(a)", 0, "found \"larges\", which is not a function; did you mean \"largest\"?"},
        {"2 mrd", 2, "found the unit \"mrd\"; did you mean \"mrad\"?"},
        {"2 m*a", 2,
         "found \"m*a\" after a number; expected a unit, such as mrad/s, or an "
         "operator between blanks"},
        {"1e999", 0, "the number is too large"},
        {"a $ a", 2, "found \"$\"; expected an operator or the end"},
        {"\xc3\xa4", 0, "found \"\xc3\xa4\"; expected a result, a number, a function or \"(\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static expression_code code;
        expression_part part;
        units_dimension unit;
        expression_refusal refusal = {0};
        if (read(cases[i].text, &code, &part, &unit, &refusal))
            fail_msg("%s is not refused", cases[i].text);
        if (strcmp(refusal.why, cases[i].why) != 0 || refusal.at != cases[i].at)
            fail_msg("%s: %d: %s", cases[i].text, refusal.at, refusal.why);
    }
}

// As long, as deep and as many operations as are allowed, and one more.
static void test_limits(void **state)
{
    (void)state;
    static expression_code code;
    expression_part part;
    units_dimension unit;
    expression_refusal refusal;
    char text[EXPRESSION_MOST_TEXT + 2] = "", found[UNITS_TEXT];
    for (int i = 0; i < EXPRESSION_MOST_DEPTH - 1; i++)
        strcat(text, "(");
    strcat(text, "y");
    for (int i = 0; i < EXPRESSION_MOST_DEPTH - 1; i++)
        strcat(text, ")");
    CHECK_NEAR("deepest", evaluated(text, found), 5, 0);
    memmove(text + 4, text, strlen(text) + 1);
    memcpy(text, "abs(", 4);
    strcat(text, ")");
    assert_false(read(text, &code, &part, &unit, &refusal));
    assert_string_equal(refusal.why, "more than 16 levels of parentheses");
    memset(text, '-', EXPRESSION_MOST_TEXT);
    text[EXPRESSION_MOST_TEXT - 1] = 'y';
    text[EXPRESSION_MOST_TEXT] = '\0';
    assert_false(read(text, &code, &part, &unit, &refusal)); // one sign alone
    for (int i = 0; i < EXPRESSION_MOST_TEXT - 1; i++)
        text[i] = i % 2 ? '+' : 'y';
    text[EXPRESSION_MOST_TEXT - 2] = ' ';
    CHECK_NEAR("longest", evaluated(text, found), 5.0 * (EXPRESSION_MOST_TEXT / 2 - 1) + 5, 0);
    strcat(text, " ");
    assert_false(read(text, &code, &part, &unit, &refusal));
    assert_string_equal(refusal.why, "the expression has 401 characters; expected at most 400");
    code.count = EXPRESSION_MOST_OPERATIONS - 2;
    windows = 0;
    assert_true(expression_read("-y", &names, &code, &part, &unit, &refusal));
    code.count = EXPRESSION_MOST_OPERATIONS - 2;
    assert_false(expression_read("y + 1", &names, &code, &part, &unit, &refusal));
    assert_string_equal(refusal.why, "the expressions have more than 600 operations");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),  cmocka_unit_test(test_missing),
        cmocka_unit_test(test_windows), cmocka_unit_test(test_refused),
        cmocka_unit_test(test_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
