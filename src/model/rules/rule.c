#include "model/rules/rule.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void report_broken(const rule_set *rules, const char *path, int index, const char *format, ...)
{
    char full_path[128], text[384];
    const char *place = strchr(path, '#');
    if (place)
        snprintf(full_path, sizeof full_path, "%.*s%d%s", (int)(place - path), path, index,
                 place + 1);
    else
        snprintf(full_path, sizeof full_path, "%s", path);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    rules->report(rules->self, full_path, text);
}

// Principal moments of a rigid body: none may exceed the sum of the two others, which is to say
// that P = tr(J)/2 E - J (the second moments of mass) has no negative eigenvalue.
void inertia_rule(const rule_set *rules, const char *path, const double J[3],
                  const double products[3])
{
    double half = (J[0] + J[1] + J[2]) / 2, slack = 1e-12 * half;
    double p[3] = {half - J[0] + slack, half - J[1] + slack, half - J[2] + slack};
    for (int i = 0; i < 3; i++)
        if (p[i] < 0) {
            report_broken(
                rules, path, 0,
                "the moment about %c, %g kg.m2, exceeds the sum of the two others, which is "
                "impossible",
                "xyz"[i], J[i]);
            return;
        }
    if (!products || (products[0] == 0 && products[1] == 0 && products[2] == 0))
        return;
    // leading minors of P, whose off-diagonal elements are minus the products
    double xy = -products[0], xz = -products[1], yz = -products[2];
    double determinant =
        p[0] * (p[1] * p[2] - yz * yz) - xy * (xy * p[2] - yz * xz) + xz * (xy * yz - p[1] * xz);
    if (p[0] * p[1] < xy * xy || p[0] * p[2] < xz * xz || p[1] * p[2] < yz * yz || determinant < 0)
        report_broken(rules, "rocket.products_of_inertia", 0,
                      "too large for %s = %g %g %g kg.m2; that is impossible", path, J[0], J[1],
                      J[2]);
}

void rising_rule(const rule_set *rules, const char *path, const ld_table *table, const char *unit,
                 bool jumps)
{
    for (size_t i = 1; i < table->rows; i++) {
        double before = table->data[(i - 1) * table->columns], x = table->data[i * table->columns];
        if (x < before || (x == before && !jumps))
            report_broken(rules, path, (int)i + 1,
                          "%g %s does not come after %g %s in the row before", x, unit, before,
                          unit);
        else if (jumps && i > 1 && x == before && x == table->data[(i - 2) * table->columns])
            report_broken(rules, path, (int)i + 1, "%g %s occurs a third time; twice is a jump", x,
                          unit);
    }
}
