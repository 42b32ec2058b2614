#include "scenario/clock_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/fields/field.h"
#include "scenario/scenario_reader.h"

static const double LONG_AGO = 1e5, FARTHEST = 1e15; // [s]
static const double MOST = 9e18;                     // that fits into a decimal's whole

enum { DECIMALS = 36 };

// A number >= 0, digit by digit.
typedef struct decimal {
    uint64_t whole;
    char rest[DECIMALS + 1]; // digits behind the point
} decimal;

// Puts a digit of the weight 10^power into the number; false: it has no room for it.
static bool put_digit(decimal *number, int power, char digit)
{
    if (power >= 0) {
        if (number->whole >= (uint64_t)MOST / 10)
            return false;
        number->whole = number->whole * 10 + (uint64_t)(digit - '0');
        return true;
    }
    if (power < -DECIMALS)
        return digit == '0';
    number->rest[-power - 1] = digit;
    return true;
}

// Of a text that begins with a number; false: it is negative or has too many digits.
static bool decimal_of(const char *text, decimal *number)
{
    text += *text == '+';
    size_t length = strspn(text, "0123456789."), point = strcspn(text, ".");
    const char *mark = text + length;
    long exponent = *mark == 'e' || *mark == 'E' ? strtol(mark + 1, NULL, 10) : 0;
    if (length == 0 || labs(exponent) > 400)
        return false;
    memset(number, 0, sizeof *number);
    memset(number->rest, '0', DECIMALS);
    int power = (int)(point < length ? point : length) - 1 + (int)exponent;
    for (size_t i = 0; i < length; i++)
        if (text[i] != '.' && !put_digit(number, power--, text[i]))
            return false;
    for (; power >= 0; power--)
        if (!put_digit(number, power, '0'))
            return false;
    return true;
}

// Its shortest text.
static void decimal_text(const decimal *number, char text[CLOCK_TEXT])
{
    snprintf(text, CLOCK_TEXT, "%llu.%s", (unsigned long long)number->whole, number->rest);
    size_t length = strlen(text);
    while (text[length - 1] == '0')
        text[--length] = '\0';
    if (text[length - 1] == '.')
        text[--length] = '\0';
}

// The whole seconds of a time, where it is of long ago.
static double origin_of(const decimal *number, double per, double time)
{
    if (!(time >= LONG_AGO && time < FARTHEST))
        return 0;
    if (!number)
        return floor(time);
    uint64_t seconds = number->whole / (uint64_t)per;
    return (double)seconds;
}

// The time of the number less the origin.
static double difference_of(decimal number, double per, double factor, double origin)
{
    char text[CLOCK_TEXT];
    number.whole -= (uint64_t)origin * (uint64_t)per;
    decimal_text(&number, text);
    return units_scale(strtod(text, NULL), factor);
}

double clock_read(const char *text, double value, double factor, bool first, double *origin)
{
    decimal number;
    double per = round(1 / factor), time = units_scale(value, factor); // units in a second
    bool exact =
        per >= 1 && per <= 1e12 && units_scale(per, factor) == 1 && decimal_of(text, &number);
    if (first)
        *origin = origin_of(exact ? &number : NULL, per, time);
    if (*origin == 0)
        return time;
    bool fits = exact && *origin * per < MOST && number.whole >= (uint64_t)(*origin * per);
    time = fits ? difference_of(number, per, factor, *origin) : time - *origin;
    // so near the next second that it is rounded to it
    if (first && time >= 1) {
        *origin += time;
        time = 0;
    }
    return time;
}

void clock_print(double time, double origin, char text[CLOCK_TEXT])
{
    decimal number;
    char digits[32];
    field_number_text(time, digits);
    if (origin == 0 || !decimal_of(digits, &number)) {
        field_number_text(time + origin, digits);
        snprintf(text, CLOCK_TEXT, "%s", digits);
        return;
    }
    number.whole += (uint64_t)origin;
    decimal_text(&number, text);
}
