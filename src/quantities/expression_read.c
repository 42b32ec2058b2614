// A parser by recursive descent, from the weakest operator to the strongest, which writes the
// operations in the order in which they are computed (postfix).
#include "quantities/expression.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "base/suggestion.h"
#include "launchdyn/status.h"

// What units a function takes and gives.
typedef enum unit_rule { UNIT_KEPT, UNIT_HALVED, UNIT_OF_ANGLE, UNIT_TO_ANGLE } unit_rule;

static const struct {
    const char *name;
    operation_kind kind;
    int least, most; // arguments
    unit_rule rule;
} functions[] = {
    {"abs", DO_ABS, 1, 1, UNIT_KEPT},       {"sqrt", DO_SQRT, 1, 1, UNIT_HALVED},
    {"hypot", DO_HYPOT, 2, 8, UNIT_KEPT},   {"min", DO_MIN, 2, 8, UNIT_KEPT},
    {"max", DO_MAX, 2, 8, UNIT_KEPT},       {"sin", DO_SIN, 1, 1, UNIT_OF_ANGLE},
    {"cos", DO_COS, 1, 1, UNIT_OF_ANGLE},   {"tan", DO_TAN, 1, 1, UNIT_OF_ANGLE},
    {"asin", DO_ASIN, 1, 1, UNIT_TO_ANGLE}, {"acos", DO_ACOS, 1, 1, UNIT_TO_ANGLE},
    {"atan", DO_ATAN, 1, 1, UNIT_TO_ANGLE}, {"atan2", DO_ATAN2, 2, 2, UNIT_TO_ANGLE},
};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

// Figures of a course in time.
static const struct {
    const char *name;
    ld_take take;
} figures[] = {{"largest", LD_TAKE_LARGEST}, {"least", LD_TAKE_LEAST}, {"peak", LD_TAKE_PEAK},
               {"mean", LD_TAKE_MEAN},       {"rms", LD_TAKE_RMS},     {"change", LD_TAKE_CHANGE}};
enum { FIGURES = sizeof figures / sizeof *figures };

// ---- reading

typedef struct parser {
    const char *text;
    int at, depth, stack;
    bool inside; // a window
    bool failed;
    const expression_names *names;
    expression_code *code;
    expression_refusal *refusal;
} parser;

// What has been read: where it stands, its unit; `bare_zero`: the number 0, which fits any unit.
typedef struct term {
    int from, to;
    units_dimension unit;
    bool bare_zero;
} term;

static term parse_comparison(parser *p);

static void refuse(parser *p, int at, const char *format, ...) LD_PRINTF(3, 4);
static void refuse(parser *p, int at, const char *format, ...)
{
    va_list arguments;
    if (p->failed)
        return;
    p->failed = true;
    p->refusal->at = at;
    va_start(arguments, format);
    vsnprintf(p->refusal->why, sizeof p->refusal->why, format, arguments);
    va_end(arguments);
}

static void emit(parser *p, operation_kind kind, int operand, double number)
{
    if (p->code->count == EXPRESSION_MOST_OPERATIONS)
        refuse(p, p->at, "the expressions have more than %d operations",
               EXPRESSION_MOST_OPERATIONS);
    if (p->failed)
        return;
    p->code->operation[p->code->count++] = (expression_operation){kind, operand, number};
    bool pushes = kind == DO_NUMBER || kind == DO_OPERAND;
    bool joins =
        (kind >= DO_ADD && kind <= DO_GREATER_EQUAL && kind != DO_POWER) || kind >= DO_ATAN2;
    p->stack += pushes - joins;
    if (p->stack > EXPRESSION_STACK)
        refuse(p, p->at, "the expression is nested too deeply");
}

static void skip_blanks(parser *p)
{
    p->at += (int)strspn(p->text + p->at, " \t\r\n");
}

// Takes a sign or operator if it comes next.
static bool take(parser *p, const char *sign)
{
    skip_blanks(p);
    size_t length = strlen(sign);
    if (p->failed || strncmp(p->text + p->at, sign, length) != 0)
        return false;
    p->at += (int)length;
    return true;
}

// What comes next, for messages: a word, a number or a sign.
static void next_of(const parser *p, char found[40])
{
    const char *next = p->text + p->at;
    size_t length =
        strspn(next, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.");
    size_t shown = length ? length : *next != '\0';
    while (((unsigned char)next[shown] & 0xc0) == 0x80) // the rest of a character
        shown++;
    if (*next)
        snprintf(found, 40, "\"%.*s\"", (int)(shown < 36 ? shown : 36), next);
    else
        snprintf(found, 40, "the end");
}

static void expect(parser *p, const char *sign, const char *expected)
{
    char found[40];
    if (take(p, sign) || p->failed)
        return;
    next_of(p, found);
    refuse(p, p->at, "found %s; expected %s", found, expected);
}

static bool is_word(char c)
{
    return (isalnum((unsigned char)c) && (unsigned char)c < 128) || c == '_' || c == '.';
}

// The length of a name at `text`, with hyphens between its letters if `hyphens`.
static int name_length(const char *text, bool hyphens)
{
    int length = 0;
    while (is_word(text[length]) || (hyphens && length && text[length] == '-' &&
                                     is_word(text[length + 1]) && is_word(text[length - 1])))
        length++;
    return length < LD_MAX_QUANTITY ? length : LD_MAX_QUANTITY - 1;
}

// Whether that word comes next.
static bool next_is(const parser *p, int at, const char *word)
{
    size_t length = strlen(word);
    at += (int)strspn(p->text + at, " \t\r\n");
    return strncmp(p->text + at, word, length) == 0 && !is_word(p->text[at + length]) &&
           p->text[at + length] != '-';
}

static bool take_word(parser *p, const char *word)
{
    if (p->failed || !next_is(p, p->at, word))
        return false;
    skip_blanks(p);
    p->at += (int)strlen(word);
    return true;
}

static void take_instant(parser *p, char name[LD_MAX_QUANTITY])
{
    char found[40];
    skip_blanks(p);
    int length = name_length(p->text + p->at, true);
    next_of(p, found);
    if (length == 0)
        refuse(p, p->at, "found %s; expected an instant such as t_rear", found);
    snprintf(name, LD_MAX_QUANTITY, "%.*s", length, p->text + p->at);
    p->at += length;
}

// ---- units

static bool is_plain(const units_dimension *unit)
{
    static const units_dimension none = {{0}};
    return memcmp(unit, &none, sizeof none) == 0;
}

static const char *said_unit(const units_dimension *unit, char text[UNITS_TEXT])
{
    units_write(unit, text);
    return text[0] ? text : "a number without unit";
}

// What of the text two terms and what lies between them are.
static int span(const term *left, const term *right)
{
    return right->to - left->from;
}

// The unit of both; refused where they differ.
static term alike(parser *p, const term *left, const term *right)
{
    char one[UNITS_TEXT], other[UNITS_TEXT];
    bool same = memcmp(&left->unit, &right->unit, sizeof left->unit) == 0;
    if (!same && !left->bare_zero && !right->bare_zero)
        refuse(p, left->from, "\"%.*s\": found %s and %s; expected one unit", span(left, right),
               p->text + left->from, said_unit(&left->unit, one), said_unit(&right->unit, other));
    return (term){left->from, right->to, left->bare_zero ? right->unit : left->unit,
                  left->bare_zero && right->bare_zero};
}

static void demand_unit(parser *p, const term *of, const char *unit)
{
    units_dimension expected;
    double factor;
    char found[UNITS_TEXT], unknown[32];
    units_read(unit, &factor, &expected, unknown);
    if (memcmp(&of->unit, &expected, sizeof expected) != 0 && !of->bare_zero)
        refuse(p, of->from, "\"%.*s\": found %s; expected %s", of->to - of->from,
               p->text + of->from, said_unit(&of->unit, found),
               *unit ? unit : "a number without unit");
}

static term multiplied(parser *p, const term *left, const term *right, int power)
{
    term result = {.from = left->from, .to = right->to};
    for (int i = 0; i < UNITS_BASES; i++) {
        result.unit.power[i] = left->unit.power[i] + power * right->unit.power[i];
        if (abs(result.unit.power[i]) > UNITS_MOST_POWER)
            refuse(p, left->from, "\"%.*s\": powers of units beyond %d", span(left, right),
                   p->text + left->from, UNITS_MOST_POWER);
    }
    return result;
}

// ---- operands

// The end of a number in plain decimal notation at `text`; NULL: there is none.
static const char *number_end(const char *text)
{
    size_t whole = strspn(text, "0123456789");
    const char *end = text + whole;
    size_t part = *end == '.' ? strspn(end + 1, "0123456789") : 0;
    end += *end == '.' ? 1 + part : 0;
    if (whole + part == 0)
        return NULL;
    if (*end == 'e' || *end == 'E') {
        const char *power = end + 1 + (end[1] == '-' || end[1] == '+');
        size_t digits = strspn(power, "0123456789");
        end = digits ? power + digits : end;
    }
    return end;
}

// The number at the present place, and beyond it; NaN where there is none, or it is too large.
static double take_number(parser *p)
{
    skip_blanks(p);
    const char *text = p->text + p->at, *end = number_end(text);
    if (!end)
        return NAN;
    locale_t before = numeric_locale_enter();
    double value = strtod(text, NULL);
    numeric_locale_leave(before);
    if (!isfinite(value))
        refuse(p, p->at, "the number is too large");
    p->at += (int)(end - text);
    return value;
}

static bool is_keyword(const char *text)
{
    const parser at = {.text = text};
    return next_is(&at, 0, "from") || next_is(&at, 0, "to") || next_is(&at, 0, "at");
}

// The unit after a number, if one stands there: a word without blanks, "mrad/s".
static double take_unit(parser *p, units_dimension *unit)
{
    char text[UNITS_TEXT], unknown[32];
    double factor = 1;
    int blanks = (int)strspn(p->text + p->at, " ");
    const char *word = p->text + p->at + blanks;
    if (!(isalpha((unsigned char)*word) || *word == '%') || is_keyword(word))
        return 1;
    int length = (int)strcspn(word, " \t\r\n(),+<>="), shown = length < UNITS_TEXT ? length : 0;
    snprintf(text, sizeof text, "%.*s", shown, word);
    units_result result = shown ? units_read(text, &factor, unit, unknown) : UNITS_SYNTAX;
    const char *likely =
        result == UNITS_UNKNOWN && !strchr(text, '*') ? units_suggestion(unknown) : NULL;
    if (likely)
        refuse(p, p->at + blanks, "found the unit \"%s\"; did you mean \"%s\"?", unknown, likely);
    else if (result != UNITS_OK)
        refuse(p, p->at + blanks,
               "found \"%.*s\" after a number; expected a unit, such as mrad/s, or an operator "
               "between blanks",
               length < 40 ? length : 40, word);
    p->at += blanks + length;
    return factor;
}

static term parse_number(parser *p)
{
    term result = {.from = p->at};
    double value = take_number(p);
    const char *after = p->text + p->at;
    double factor = take_unit(p, &result.unit);
    result.bare_zero = value == 0 && after == p->text + p->at;
    result.to = p->at;
    emit(p, DO_NUMBER, 0, units_scale(value, factor));
    return result;
}

// Reads the unit of an operand as its table has it.
static void set_unit(parser *p, term *of, const char *unit)
{
    double factor;
    char unknown[32];
    if (units_read(unit, &factor, &of->unit, unknown) != UNITS_OK)
        refuse(p, of->from, "\"%.*s\": its unit %s is not allowed in an expression",
               of->to - of->from, p->text + of->from, unit);
}

// The operations since `begin` are a window's; passed over where its figure is wanted.
static void close_window(parser *p, expression_window *window, int begin, term *result)
{
    char why[EXPRESSION_WHY] = "";
    if (p->failed)
        return;
    window->of = (expression_part){begin + 1, p->code->count - begin - 1};
    p->code->operation[begin].operand = window->of.count;
    p->stack--;
    int figure = p->names->close(p->names->self, window, why);
    if (figure < 0)
        refuse(p, window->at, "%s", why);
    result->to = p->at;
    emit(p, DO_OPERAND, figure, 0);
}

static bool open_window(parser *p, const expression_window *window)
{
    char why[EXPRESSION_WHY] = "";
    if (!p->failed && !p->names->open(p->names->self, window, why))
        refuse(p, window->at, "%s", why);
    emit(p, DO_PASS, 0, 0);
    return !p->failed;
}

// A column at an instant: NAME has been read and "at" follows.
static term parse_value(parser *p, const char *name, int from)
{
    expression_window window = {.take = LD_TAKE_VALUE, .at = from};
    term result = {.from = from, .to = p->at};
    const char *unit = "";
    char why[EXPRESSION_WHY] = "";
    int begin = p->code->count;
    take_word(p, "at");
    take_instant(p, window.from);
    memcpy(window.to, window.from, sizeof window.to);
    if (p->inside)
        refuse(p, from, "\"%.*s\": a value at an instant is not allowed inside a window",
               p->at - from, p->text + from);
    if (!open_window(p, &window))
        return result;
    int column = p->names->find(p->names->self, true, name, &unit);
    if (column < 0) {
        p->names->explain(p->names->self, true, name, why);
        refuse(p, from, "%s", why);
    }
    set_unit(p, &result, unit);
    emit(p, DO_OPERAND, column, 0);
    close_window(p, &window, begin, &result);
    return result;
}

// A result or, in a window, a column. A hyphen belongs to the name where there is such a name.
static term parse_name(parser *p)
{
    char name[LD_MAX_QUANTITY], why[EXPRESSION_WHY] = "";
    const char *unit = "";
    term result = {.from = p->at};
    int number = -1, length = name_length(p->text + p->at, true);
    for (; number < 0; length--) {
        snprintf(name, sizeof name, "%.*s", length, p->text + p->at);
        if (next_is(p, p->at + length, "at")) {
            p->at += length;
            return parse_value(p, name, result.from);
        }
        number = p->names->find(p->names->self, p->inside, name, &unit);
        if (number >= 0)
            break;
        const char *hyphen = strrchr(name, '-');
        if (!hyphen)
            break;
        length = (int)(hyphen - name) + 1;
    }
    p->at += length;
    result.to = p->at;
    if (number < 0) {
        p->names->explain(p->names->self, p->inside, name, why);
        refuse(p, result.from, "%s", why);
    }
    set_unit(p, &result, unit);
    emit(p, DO_OPERAND, number, 0);
    return result;
}

// ---- functions

static void apply_rule(parser *p, unit_rule rule, term *of)
{
    char found[UNITS_TEXT];
    if (rule == UNIT_OF_ANGLE)
        demand_unit(p, of, "rad");
    if (rule == UNIT_OF_ANGLE || rule == UNIT_TO_ANGLE)
        of->unit = (units_dimension){.power[3] = rule == UNIT_TO_ANGLE};
    for (int i = 0; rule == UNIT_HALVED && i < UNITS_BASES; i++) {
        if (of->unit.power[i] % 2)
            refuse(p, of->from, "\"%.*s\": found %s; expected a square, such as m2",
                   of->to - of->from, p->text + of->from, said_unit(&of->unit, found));
        of->unit.power[i] /= 2;
    }
}

// The arguments of function `which`, whose name has been read.
static term parse_function(parser *p, int which, int from)
{
    term result = {.from = p->at};
    int count = 0;
    do {
        term next = parse_comparison(p);
        result = count ? alike(p, &result, &next) : next;
        if (count++ && functions[which].most > 2)
            emit(p, functions[which].kind, 0, 0);
    } while (take(p, ","));
    expect(p, ")", count < functions[which].most ? "\",\" or \")\"" : "\")\"");
    if (count < functions[which].least || count > functions[which].most)
        refuse(p, from, "%s() has %d argument%s; expected %d%s%s", functions[which].name, count,
               count == 1 ? "" : "s", functions[which].least,
               functions[which].most > functions[which].least ? " or more" : "",
               count == 1 && functions[which].least == 2 && functions[which].most > 2 &&
                       functions[which].kind != DO_HYPOT
                   ? functions[which].kind == DO_MAX ? " (over time: largest)"
                                                     : " (over time: least)"
                   : "");
    if (functions[which].rule == UNIT_TO_ANGLE && functions[which].kind != DO_ATAN2)
        demand_unit(p, &result, "");
    apply_rule(p, functions[which].rule, &result);
    if (functions[which].most <= 2)
        emit(p, functions[which].kind, 0, 0);
    return (term){.from = from, .to = p->at, .unit = result.unit};
}

// The place of the word "from" of the window that has just been opened; -1: it has none.
static int find_from(const parser *p)
{
    int depth = 0;
    for (int i = p->at; p->text[i] && depth >= 0; i++) {
        depth += (p->text[i] == '(') - (p->text[i] == ')');
        if (depth == 0 && i > p->at && !is_word(p->text[i - 1]) && next_is(p, i, "from"))
            return i;
    }
    return -1;
}

// largest(EXPRESSION from INSTANT to INSTANT): the instants say whose columns are meant, so they
// are read first.
static term parse_figure(parser *p, int which, int from)
{
    expression_window window = {.take = figures[which].take, .at = from};
    int begin = p->code->count, inner = p->at, ends = find_from(p), after = -1;
    if (p->inside)
        refuse(p, from, "%s() is not allowed inside a window", figures[which].name);
    if (ends >= 0) {
        p->at = ends;
        take_word(p, "from");
        take_instant(p, window.from);
        if (!p->failed && !take_word(p, "to"))
            refuse(p, p->at, "expected \"to\" and an instant after \"from %s\"", window.from);
        take_instant(p, window.to);
        after = p->at;
    }
    term result = {.from = from};
    if (!open_window(p, &window))
        return result;
    p->at = inner;
    p->inside = true;
    result = parse_comparison(p);
    p->inside = false;
    result.from = from;
    skip_blanks(p);
    if (ends >= 0 && !p->failed && next_is(p, p->at, "from"))
        p->at = after;
    expect(p, ")", "\")\", or \"from\" an instant \"to\" another");
    close_window(p, &window, begin, &result);
    return result;
}

static void refuse_function(parser *p, const char *name, int from)
{
    name_suggestion best = suggestion_begin(name);
    for (int i = 0; i < FUNCTIONS; i++)
        suggestion_offer(&best, functions[i].name);
    for (int i = 0; i < FIGURES; i++)
        suggestion_offer(&best, figures[i].name);
    if (best.name)
        refuse(p, from, "found \"%s\", which is not a function; did you mean \"%s\"?", name,
               best.name);
    else
        refuse(p, from,
               "found \"%s\", which is not a function; expected one of abs, sqrt, hypot, min, max, "
               "sin, cos, tan, asin, acos, atan, atan2, or over time largest, least, peak, mean, "
               "rms, change",
               name);
}

static term parse_call(parser *p, int length)
{
    char name[LD_MAX_QUANTITY];
    int from = p->at;
    snprintf(name, sizeof name, "%.*s", length, p->text + p->at);
    p->at += length;
    take(p, "(");
    for (int i = 0; i < FUNCTIONS; i++)
        if (strcmp(functions[i].name, name) == 0)
            return parse_function(p, i, from);
    for (int i = 0; i < FIGURES; i++)
        if (strcmp(figures[i].name, name) == 0)
            return parse_figure(p, i, from);
    refuse_function(p, name, from);
    return (term){.from = from};
}

// ---- operators

static term parse_primary(parser *p)
{
    term result = {.from = p->at};
    char found[40];
    if (p->failed)
        return result;
    const char *next = p->text + p->at;
    int length = name_length(next, false);
    bool letter = isalpha((unsigned char)*next) && length > 0;
    if (number_end(next))
        return parse_number(p);
    if (letter && next[length + (int)strspn(next + length, " ")] == '(')
        return parse_call(p, length);
    if (letter && !is_keyword(next))
        return parse_name(p);
    if (!take(p, "(")) {
        next_of(p, found);
        refuse(p, p->at, "found %s; expected a result, a number, a function or \"(\"", found);
        return result;
    }
    term inner = parse_comparison(p);
    expect(p, ")", "an operator or \")\"");
    inner.from = result.from;
    inner.to = p->at;
    inner.bare_zero = false;
    return inner;
}

// x^2: the exponent is a number; of what has a unit a whole one.
static term parse_power(parser *p)
{
    term of = parse_primary(p);
    if (!take(p, "^"))
        return of;
    skip_blanks(p);
    int at = p->at, sign = take(p, "-") ? -1 : 1;
    double exponent = sign * take_number(p);
    char found[40];
    next_of(p, found);
    if (isnan(exponent))
        refuse(p, at, "found %s; expected a number as exponent", found);
    else if (!is_plain(&of.unit) &&
             (exponent != floor(exponent) || fabs(exponent) > UNITS_MOST_POWER))
        refuse(p, at, "found the exponent %g; of what has a unit, expected -%d to %d, whole",
               exponent, UNITS_MOST_POWER, UNITS_MOST_POWER);
    if (p->failed)
        return of;
    term none = {.from = of.from, .to = p->at};
    term result = multiplied(p, &none, &of, is_plain(&of.unit) ? 1 : (int)exponent);
    result.to = p->at;
    emit(p, DO_POWER, 0, exponent);
    return result;
}

static term parse_signed(parser *p)
{
    skip_blanks(p);
    int from = p->at;
    bool negative = take(p, "-");
    skip_blanks(p);
    term result = parse_power(p);
    result.from = from;
    if (negative)
        emit(p, DO_NEGATE, 0, 0);
    return result;
}

static term parse_product(parser *p)
{
    term left = parse_signed(p);
    for (;;) {
        bool times = take(p, "*");
        if (!times && !take(p, "/"))
            return left;
        term right = parse_signed(p);
        left = multiplied(p, &left, &right, times ? 1 : -1);
        emit(p, times ? DO_MULTIPLY : DO_DIVIDE, 0, 0);
    }
}

static term parse_sum(parser *p)
{
    term left = parse_product(p);
    for (;;) {
        bool plus = take(p, "+");
        if (!plus && !take(p, "-"))
            return left;
        term right = parse_product(p);
        left = alike(p, &left, &right);
        emit(p, plus ? DO_ADD : DO_SUBTRACT, 0, 0);
    }
}

// Also counts how deep it is: each level of parentheses, of a function too, leads here.
static term parse_comparison(parser *p)
{
    static const struct {
        const char *sign;
        operation_kind kind;
    } signs[] = {
        {"<=", DO_LESS_EQUAL}, {">=", DO_GREATER_EQUAL}, {"<", DO_LESS}, {">", DO_GREATER}};
    if (p->depth == EXPRESSION_MOST_DEPTH)
        refuse(p, p->at, "more than %d levels of parentheses", EXPRESSION_MOST_DEPTH);
    if (p->failed)
        return (term){0};
    p->depth++;
    term left = parse_sum(p);
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
        if (!take(p, signs[i].sign))
            continue;
        term right = parse_sum(p);
        alike(p, &left, &right);
        emit(p, signs[i].kind, 0, 0);
        left = (term){.from = left.from, .to = right.to};
        break;
    }
    p->depth--;
    return left;
}

bool expression_read(const char *text, const expression_names *names, expression_code *code,
                     expression_part *part, units_dimension *unit, expression_refusal *refusal)
{
    parser p = {.text = text, .names = names, .code = code, .refusal = refusal};
    char found[40];
    part->first = code->count;
    if (strlen(text) > EXPRESSION_MOST_TEXT) {
        refuse(&p, 0, "the expression has %zu characters; expected at most %d", strlen(text),
               EXPRESSION_MOST_TEXT);
        return false;
    }
    term whole = parse_comparison(&p);
    skip_blanks(&p);
    next_of(&p, found);
    if (text[p.at])
        refuse(&p, p.at, "found %s; expected an operator or the end", found);
    part->count = code->count - part->first;
    *unit = whole.unit;
    return !p.failed;
}
