// Numbers with units.
#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/fields/field.h"
#include "scenario/scenario_reader.h"

static const char *skip_digits(const char *text, bool *any)
{
    for (; *text >= '0' && *text <= '9'; text++)
        *any = true;
    return text;
}

// Words and notations that strtod would take.
static const char *foreign_notation(const char *text)
{
    text += *text == '+' || *text == '-' || *text == '.';
    if (text[0] == '0' && (text[1] == 'x' || text[1] == 'X'))
        return "a hexadecimal number";
    if (strncasecmp(text, "nan", 3) == 0)
        return "not a number";
    if (strncasecmp(text, "inf", 3) == 0)
        return "not a finite number";
    return NULL;
}

const char *number_parse(const char *text, double *value, const char **reason)
{
    bool digits = false, exponent = false;
    const char *end = skip_digits(text + (*text == '+' || *text == '-'), &digits);
    *reason = foreign_notation(text);
    *value = NAN;
    if (*reason)
        return NULL;
    if (*end == '.')
        end = skip_digits(end + 1, &digits);
    if (!digits)
        return NULL;
    const char *mantissa_end = end;
    if (*end == 'e' || *end == 'E') {
        const char *power = end + 1;
        power = skip_digits(power + (*power == '+' || *power == '-'), &exponent);
        end = exponent ? power : end;
    }
    *value = strtod(text, NULL);
    bool nothing = strcspn(text, "123456789") >= (size_t)(mantissa_end - text);
    if (!isfinite(*value))
        *reason = "the number is too large";
    else if (!nothing && fabs(*value) < DBL_MIN)
        *reason = "the number is too small";
    return *reason ? NULL : end;
}

// What stands in the text of a quantity.
typedef struct quantity {
    int count; // numbers found, of which `most` are kept
    double number[4];
    const char *unit;   // the rest of the text, "" without
    const char *reason; // why the next number is none, or NULL
} quantity;

static quantity split(const char *text, int most)
{
    quantity q = {0};
    for (;;) {
        double value;
        text += strspn(text, " \t\r\n");
        if (q.count > 0 && strncmp(text, "1/", 2) == 0) // the unit 1/m
            break;
        const char *end = number_parse(text, &value, &q.reason);
        if (!end)
            break;
        if (q.count < most)
            q.number[q.count] = value;
        q.count++;
        text = end;
        if (*end && !isspace((unsigned char)*end))
            break;
    }
    q.unit = text;
    return q;
}

// Says what is wrong with the unit.
static void refuse_unit(scenario_reader *reader, const written_value *given, const char *unit,
                        units_result result, const char *unknown)
{
    const field_row *f = given->field;
    text_place place = given->at;
    const char *path = given->path;
    char found[64], quoted[64], expected[256];
    const char *likely = result == UNITS_UNKNOWN ? units_suggestion(unknown) : NULL;
    field_expectation(f, expected, sizeof expected);
    reader_quote(given->text, found);
    if (unit[0] == ',')
        reader_refuse(reader, place, path, "found %s; decimals are written with a point", found);
    else if (!f->unit[0])
        reader_refuse(reader, place, path, "found %s with a unit; expected %s", found, expected);
    else if (result == UNITS_SYNTAX)
        reader_refuse(reader, place, path,
                      "found %s, where %s is not a unit of the form N.m/rad, m2 or kg.m.s-2; "
                      "expected %s",
                      found, reader_quote(unit, quoted), expected);
    else if (likely)
        reader_refuse(reader, place, path, "found %s; unknown unit %s, did you mean \"%s\"?", found,
                      reader_quote(unknown, quoted), likely);
    else if (result == UNITS_UNKNOWN)
        reader_refuse(reader, place, path, "found %s; unknown unit %s, expected %s", found,
                      reader_quote(unknown, quoted), expected);
    else
        reader_refuse(reader, place, path, "found %s, a unit of the wrong dimension; expected %s",
                      found, expected);
}

// Factor of the quantity's unit; NaN after a message.
static double unit_factor(scenario_reader *reader, const written_value *given, const char *rest)
{
    const field_row *f = given->field;
    char unit[64], unknown[32] = "", found[64], expected[256];
    double factor = 1;
    size_t length = strlen(rest);
    while (length > 0 && isspace((unsigned char)rest[length - 1]))
        length--;
    if (length == 0 && f->unit[0]) {
        field_expectation(f, expected, sizeof expected);
        reader_refuse(reader, given->at, given->path, "found %s without a unit; expected %s",
                      reader_quote(given->text, found), expected);
        return NAN;
    }
    if (length == 0)
        return 1;
    snprintf(unit, sizeof unit, "%.*s", length < 63 ? (int)length : 63, rest);
    units_result result =
        length > 60 ? UNITS_SYNTAX : units_factor(unit, f->unit, &factor, unknown);
    if (result == UNITS_OK && (f->unit[0] || strcmp(unit, "%") == 0))
        return factor;
    refuse_unit(reader, given, unit, result, unknown);
    return NAN;
}

bool quantity_read(scenario_reader *reader, const written_value *given, double *values, int count)
{
    char found[64], expected[256];
    text_place place = given->at;
    const char *path = given->path;
    quantity q = split(given->text, count);
    field_row single = *given->field;
    written_value counted = *given;
    single.count = count;
    counted.field = &single;
    reader_quote(given->text, found);
    field_expectation(&single, expected, sizeof expected);
    if (q.reason) {
        reader_refuse(reader, place, path, "found %s, %s; expected %s", found, q.reason, expected);
        return false;
    }
    if (q.count == 0) {
        reader_refuse(reader, place, path, "found %s; expected %s", found, expected);
        return false;
    }
    if (q.count != count) {
        reader_refuse(reader, place, path, "found %s, %d number%s; expected %s", found, q.count,
                      q.count > 1 ? "s" : "", expected);
        return false;
    }
    double factor = unit_factor(reader, &counted, q.unit);
    if (isnan(factor))
        return false;
    for (int i = 0; i < count; i++) {
        values[i] = units_scale(q.number[i], factor);
        bool large = !isfinite(values[i]), small = q.number[i] != 0 && fabs(values[i]) < DBL_MIN;
        const char *size = large   ? ", which is too large in SI units"
                           : small ? ", which is too small in SI units"
                                   : "";
        if (large || small || !field_in_range(single.range, values[i])) {
            reader_refuse(reader, place, path, "found %s%s; expected %s", found, size, expected);
            return false;
        }
    }
    return true;
}

ld_status ld_read_quantity(const char *text, const char *unit, double *value, ld_error *error)
{
    char *end, unknown[32] = "";
    double factor = 1;
    errno = 0;
    double number = strtod(text, &end);
    bool fine = end != text && errno == 0 && isfinite(number);
    end += strspn(end, " ");
    if (fine && *end)
        fine = units_factor(end, unit, &factor, unknown) == UNITS_OK;
    if (fine) {
        *value = units_scale(number, factor);
        return LD_OK;
    }
    const char *likely = *unknown ? units_suggestion(unknown) : NULL;
    return ld_fail(error, LD_ERR_INPUT, "found \"%s\", expected a number%s%s%s%s%s", text,
                   *unit ? " in " : "", unit, likely ? "; did you mean \"" : "",
                   likely ? likely : "", likely ? "\"?" : "");
}
