// A history as JSON: the columns that are shown, thinned, as bytes in base64.
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "report/report_parts.h"
#include "results/json_text.h"

// ---- numbers as bytes ----

// Seven bits a byte, the lowest first; the eighth says that more follow.
static void write_count(FILE *bytes, size_t value)
{
    for (; value > 127; value >>= 7)
        fputc((int)((value & 127) | 128), bytes);
    fputc((int)value, bytes);
}

// Bits of a single-precision number, so that larger numbers have larger integers.
static uint32_t order_bits(double value)
{
    float single = isnan(value) ? NAN : (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    return bits >> 31 ? ~bits : bits | 0x80000000;
}

// Second differences of smooth curves are small, whatever their sign.
static uint32_t folded(uint32_t difference)
{
    return difference << 1 ^ (difference >> 31 ? 0xffffffff : 0);
}

// ---- the table ----

// Rows from first to last of one phase of the run: before the ignition, in the tube, after it.
typedef struct segment {
    const char *name;
    size_t first, last;
    bool whole; // all rows are kept
} segment;

typedef struct thinned {
    FILE *json;
    const history_data *history;
    const report_detail *detail;
    const double *t, *phase; // phase may be NULL
    size_t *column;          // [columns] those that are shown
    size_t columns;
    double *span;    // [columns] what they are over all rows
    char *keep;      // [columns][rows] of the segment at hand
    char *any;       // [rows] kept by some column
    uint32_t *value; // [rows] of one column, coded
    FILE *bytes;     // of the segment at hand
} thinned;

bool report_is_flight(const history_data *history)
{
    return history_column(history, "altitude") != NULL;
}

static bool is_shown(const report_detail *detail, const char *name, bool flight)
{
    if (!detail->figures_alone && report_replay_shows(name, flight))
        return true;
    const plot_figure *figure;
    for (size_t f = 0; (figure = plot_figure_at(f)) != NULL; f++)
        if ((figure->time == PLOT_FLIGHT) == flight && plot_figure_shows(figure, name))
            return true;
    return false;
}

static const double *values_of(const thinned *table, size_t column)
{
    return table->history->value + table->column[column] * table->history->rows;
}

// What the rocket does at a row: 0 before ignition, 1 in the tube, 2 after it.
static int phase_at(const thinned *table, size_t row)
{
    double phase = table->phase ? table->phase[row] : 0;
    return phase < 1 ? 0 : phase < 3 ? 1 : 2;
}

static segment segment_from(const thinned *table, size_t first)
{
    static const char *const names[] = {"before", "tube", "after"};
    int phase = phase_at(table, first);
    segment found = {table->phase ? names[phase] : "flight", first, first,
                     table->detail->whole || (phase == 1 && table->detail->whole_tube)};
    while (found.last + 1 < table->history->rows && phase_at(table, found.last + 1) == phase)
        found.last++;
    return found;
}

// The finite values of a column.
typedef struct range {
    double first, low, high;
} range;

static range range_of(const double *values, size_t count)
{
    range found = {NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i])) {
            found.first = isnan(found.first) ? values[i] : found.first;
            found.low = fmin(found.low, values[i]);
            found.high = fmax(found.high, values[i]);
        }
    return found;
}

static double span_of(const double *values, size_t count)
{
    range of = range_of(values, count);
    return of.high > of.low ? of.high - of.low : 1;
}

// Marks the rows from first to last that straight lines between them need to pass all others within
// `bound`: the lines from a kept row that pass all rows so far form a cone; the row before the one
// that lies outside is kept, and the next cone begins there.
static void thin_stretch(const double *t, const double *y, size_t first, size_t last, double bound,
                         char *keep)
{
    double low = -INFINITY, high = INFINITY;
    size_t anchor = first;
    keep[first] = keep[last] = 1;
    for (size_t i = first + 1; i <= last; i++) {
        double dt = t[i] - t[anchor], dy = y[i] - y[anchor];
        if (!(dt > 0 && dy >= low * dt && dy <= high * dt)) {
            anchor = i - 1;
            keep[anchor] = 1;
            dt = t[i] - t[anchor];
            dy = y[i] - y[anchor];
            low = -INFINITY;
            high = INFINITY;
        }
        if (dt > 0) {
            low = fmax(low, (dy - bound) / dt);
            high = fmin(high, (dy + bound) / dt);
        } else {
            keep[i] = 1;
            anchor = i;
        }
    }
}

// The height that a column takes: in a phase, or in all.
static double height_of(const thinned *table, const segment *part, size_t column)
{
    if (table->detail->over_all)
        return table->span[column];
    return span_of(values_of(table, column) + part->first, part->last - part->first + 1);
}

// By how much a column of a phase may be moved, all in all [its unit].
static double bound_of(const thinned *table, const segment *part, size_t column)
{
    return part->whole ? 0 : table->detail->pixel * height_of(table, part, column);
}

// Marks the rows that one column needs: each stretch with values is thinned on its own, and the
// first row without a value keeps the gap.
static void thin_column(const thinned *table, const segment *part, size_t column, char *keep)
{
    size_t rows = part->last - part->first + 1;
    const double *t = table->t + part->first, *y = values_of(table, column) + part->first;
    double bound = 15.0 / 16 * bound_of(table, part, column); // the rest is for rounding
    memset(keep, part->whole, rows);
    for (size_t first = 0; first < rows && !part->whole; first++) {
        size_t last = first;
        if (!isfinite(y[first])) {
            keep[first] = first == 0 || isfinite(y[first - 1]);
            continue;
        }
        while (last + 1 < rows && isfinite(y[last + 1]))
            last++;
        thin_stretch(t, y, first, last, bound, keep);
        first = last;
    }
}

// Times of the rows that some column needs: steps in whole nanoseconds from the segment's first
// row.
static void write_times(const thinned *table, const segment *part)
{
    long long before = 0;
    for (size_t i = part->first; i <= part->last; i++) {
        if (!table->any[i - part->first])
            continue;
        long long now = llround((table->t[i] - table->t[part->first]) * 1e9);
        write_count(table->bytes, (size_t)(now > before ? now - before : 0));
        before = now > before ? now : before;
    }
}

// Which of those rows a column needs: how many, and where not all the steps from one to the next,
// the first from -1.
static void write_rows(const thinned *table, size_t rows, size_t all, const char *keep)
{
    size_t count = 0, step = 0;
    for (size_t i = 0; i < rows; i++)
        count += keep[i] != 0;
    write_count(table->bytes, count);
    for (size_t i = 0; i < rows && count < all; i++) {
        step += table->any[i] != 0;
        if (!keep[i])
            continue;
        write_count(table->bytes, step);
        step = 0;
    }
}

// What is taken off the values of a column before they become single precision: its first value
// where they are large against their span, else nothing. So they keep their digits in a plot too.
static double offset_of(const double *values, size_t count)
{
    range of = range_of(values, count);
    return of.high - of.low < 0.05 * fmax(fabs(of.low), fabs(of.high)) ? of.first : 0;
}

// The power of two that values are rounded to: by a sixteenth of the bound, at most. Digits that a
// curve does not need are zeros then.
static double step_of(double bound)
{
    return bound > 0 ? ldexp(1, ilogb(bound / 8)) : 0;
}

// The offset, then second differences, first the lowest bytes of all, then the next.
static void write_values(const thinned *table, const segment *part, size_t column)
{
    const char *keep = table->keep + column * table->history->rows;
    const double *y = values_of(table, column) + part->first;
    size_t rows = part->last - part->first + 1, count = 0;
    uint32_t before[2] = {0, 0};
    double offset = offset_of(y, rows), step = step_of(bound_of(table, part, column));
    uint64_t bits;
    memcpy(&bits, &offset, sizeof bits);
    for (int shift = 0; shift < 64; shift += 8)
        fputc((int)(bits >> shift & 255), table->bytes);
    for (size_t i = 0; i < rows; i++) {
        if (!keep[i])
            continue;
        double value = y[i] - offset;
        uint32_t now = order_bits(step > 0 ? step * nearbyint(value / step) : value);
        table->value[count++] = folded(now - 2 * before[0] + before[1]);
        before[1] = before[0];
        before[0] = now;
    }
    for (int shift = 0; shift < 32; shift += 8)
        for (size_t i = 0; i < count; i++)
            fputc((int)(table->value[i] >> shift & 255), table->bytes);
}

// Marks what each column keeps of a segment and returns how many rows some column keeps.
static size_t thin_all(const thinned *table, const segment *part)
{
    size_t rows = part->last - part->first + 1, kept = 0;
    memset(table->any, 0, rows);
    for (size_t c = 0; c < table->columns; c++) {
        char *keep = table->keep + c * table->history->rows;
        thin_column(table, part, c, keep);
        for (size_t i = 0; i < rows; i++)
            table->any[i] |= keep[i];
    }
    for (size_t i = 0; i < rows; i++)
        kept += table->any[i] != 0;
    return kept;
}

static ld_status write_segment(thinned *table, const segment *part, ld_error *error)
{
    char *bytes = NULL;
    size_t rows = part->last - part->first + 1, kept = thin_all(table, part), length = 0;
    fprintf(table->json, "{\"name\":\"%s\",\"of\":%zu,\"from\":%.17g,\"count\":%zu,\"data\":\"",
            part->name, rows, table->t[part->first], kept);
    table->bytes = memory_stream(&bytes, &length);
    if (!table->bytes)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
    write_times(table, part);
    for (size_t c = 0; c < table->columns; c++) {
        const char *keep = table->keep + c * table->history->rows;
        write_rows(table, rows, kept, keep);
        write_values(table, part, c);
    }
    ld_status status = fclose(table->bytes) == 0
                           ? report_write_bytes(table->json, bytes, length, error)
                           : ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
    free(bytes);
    fputs("\"}", table->json);
    return status;
}

static void write_marks(FILE *json, const history_data *history, bool flight)
{
    plot_marks marks;
    plot_find_marks(history, flight, &marks);
    plot_write_marks(json, &marks);
}

static ld_status write_table(thinned *table, int rocket, ld_error *error)
{
    const history_data *history = table->history;
    bool flight = report_is_flight(history);
    for (size_t i = 0; i < history->columns; i++)
        if (is_shown(table->detail, history->name[i], flight))
            table->column[table->columns++] = i;
    for (size_t c = 0; c < table->columns; c++)
        table->span[c] = span_of(values_of(table, c), history->rows);
    fprintf(table->json, "{\"kind\":\"%s\",\"rocket\":%d,\"columns\":[",
            flight ? "flight" : "launch", rocket);
    for (size_t c = 0; c < table->columns; c++) {
        const char *unit = history->unit[table->column[c]];
        fputs(c ? ",[" : "[", table->json);
        json_write_text(table->json, history->name[table->column[c]]);
        fputc(',', table->json);
        json_write_text(table->json, unit ? unit : "");
        fputc(']', table->json);
    }
    fputs("],\"marks\":", table->json);
    write_marks(table->json, history, flight);
    fputs(",\"segments\":[", table->json);
    ld_status status = LD_OK;
    for (size_t first = 0; table->t && first < history->rows && !status;) {
        segment part = segment_from(table, first);
        fputs(first ? ",\n" : "\n", table->json);
        status = write_segment(table, &part, error);
        first = part.last + 1;
    }
    fputs("]}", table->json);
    return status;
}

ld_status report_write_table(FILE *json, const history_data *history, int rocket,
                             const report_detail *detail, ld_error *error)
{
    size_t rows = history->rows;
    thinned table = {.json = json,
                     .history = history,
                     .detail = detail,
                     .t = history_column(history, "t"),
                     .phase = history_column(history, "phase")};
    table.column = malloc((history->columns + 1) * sizeof *table.column);
    table.span = malloc((history->columns + 1) * sizeof *table.span);
    table.keep = malloc(history->columns * rows + 1);
    table.any = malloc(rows + 1);
    table.value = malloc((rows + 1) * sizeof *table.value);
    bool fine = table.column && table.span && table.keep && table.any && table.value;
    ld_status status = fine ? write_table(&table, rocket, error)
                            : ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
    free(table.column);
    free(table.span);
    free(table.keep);
    free(table.any);
    free(table.value);
    return status;
}
