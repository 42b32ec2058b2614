#include "quantities/expression.h"

#include "math/functions.h"

// Whole powers by multiplication, as one would write them.
static double power_of(double x, double exponent)
{
    double product = x, size = fabs(exponent);
    if (exponent != floor(exponent) || size > UNITS_MOST_POWER || size == 0)
        return pow(x, exponent);
    for (int i = 1; i < (int)size; i++)
        product *= x;
    return exponent < 0 ? 1 / product : product;
}

static double of_one(const expression_operation *operation, double x)
{
    switch (operation->kind) {
    case DO_POWER:
        return isnan(x) ? NAN : power_of(x, operation->number);
    case DO_NEGATE:
        return -x;
    case DO_ABS:
        return fabs(x);
    case DO_SQRT:
        return sqrt(x);
    case DO_SIN:
        return sin(x);
    case DO_COS:
        return cos(x);
    case DO_TAN:
        return sin(x) / cos(x);
    case DO_ASIN:
        return fabs(x) <= 1 ? asin(x) : NAN;
    case DO_ACOS:
        return fabs(x) <= 1 ? acos(x) : NAN;
    default:
        return atan(x);
    }
}

static double of_two(operation_kind kind, double x, double y)
{
    if (isnan(x) || isnan(y)) // missing: not to be lost in a comparison
        return NAN;
    switch (kind) {
    case DO_ADD:
        return x + y;
    case DO_SUBTRACT:
        return x - y;
    case DO_MULTIPLY:
        return x * y;
    case DO_DIVIDE:
        return x / y;
    case DO_LESS:
        return x < y;
    case DO_LESS_EQUAL:
        return x <= y;
    case DO_GREATER:
        return x > y;
    case DO_GREATER_EQUAL:
        return x >= y;
    case DO_ATAN2:
        return atan2(x, y);
    case DO_HYPOT:
        return hypot(x, y);
    case DO_MIN:
        return x < y ? x : y;
    default:
        return x > y ? x : y;
    }
}

// What is too large, or a quotient by zero, is not a value.
static double number_or_none(double x)
{
    return isfinite(x) ? x : NAN;
}

double expression_value(const expression_code *code, expression_part part,
                        double (*operand)(const void *self, int number), const void *self)
{
    double stack[EXPRESSION_STACK + 1] = {0};
    int top = 0; // the number of values on it
    for (int i = part.first; i < part.first + part.count; i++) {
        const expression_operation *now = &code->operation[i];
        operation_kind kind = now->kind;
        if (kind == DO_PASS) {
            i += now->operand;
        } else if (kind == DO_NUMBER || kind == DO_OPERAND) {
            stack[top++] = kind == DO_NUMBER ? now->number : operand(self, now->operand);
        } else if ((kind >= DO_ADD && kind <= DO_GREATER_EQUAL && kind != DO_POWER) ||
                   kind >= DO_ATAN2) {
            top--;
            stack[top - 1] = number_or_none(of_two(kind, stack[top - 1], stack[top]));
        } else {
            stack[top - 1] = number_or_none(of_one(now, stack[top - 1]));
        }
    }
    return stack[0];
}
