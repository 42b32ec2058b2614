// A history as JSON: the columns that figures show, thinned, in base64.
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "io/json_text.h"
#include "report/report_parts.h"

// ---- base64 ----

typedef struct base64 {
    FILE *file;
    unsigned char byte[3];
    int count;
} base64;

static void base64_flush(base64 *text)
{
    static const char letter[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *b = text->byte;
    if (text->count == 0)
        return;
    memset(text->byte + text->count, 0, (size_t)(3 - text->count));
    char four[4] = {letter[b[0] >> 2], letter[(b[0] & 3) << 4 | b[1] >> 4],
                    letter[(b[1] & 15) << 2 | b[2] >> 6], letter[b[2] & 63]};
    memset(four + text->count + 1, '=', (size_t)(3 - text->count));
    fwrite(four, 1, 4, text->file);
    text->count = 0;
}

static void base64_byte(base64 *text, unsigned byte)
{
    text->byte[text->count++] = (unsigned char)byte;
    if (text->count == 3)
        base64_flush(text);
}

// The lowest byte first.
static void base64_integer(base64 *text, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        base64_byte(text, value >> 8 * i & 255);
}

static void base64_float(base64 *text, double value)
{
    float single = (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    base64_integer(text, bits, 4);
}

// Seven bits a byte, the lowest first; the eighth says that more follow.
static void base64_count(base64 *text, size_t value)
{
    for (; value > 127; value >>= 7)
        base64_byte(text, (value & 127) | 128);
    base64_byte(text, (unsigned)value);
}

// ---- the table ----

// Rows from first to last of one phase of the run.
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
    char *keep; // [columns][rows] of the segment at hand
    char *any;  // [rows] kept by some column
} thinned;

static bool is_shown(const char *name, bool flight)
{
    char unused[LD_MAX_NAME + 8];
    const plot_figure *figure;
    for (size_t f = 0; (figure = report_figure_at(flight, f)) != NULL; f++)
        for (const plot_panel *panel = figure->panel;
             panel < figure->panel + PLOT_PANELS && panel->title; panel++) {
            if (panel->x_column && strcmp(panel->x_column, name) == 0)
                return true;
            for (const plot_curve *curve = panel->curve; curve->column; curve++)
                if (plot_column_matches(name, curve->column, unused, sizeof unused))
                    return true;
        }
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

static double span_of(const double *values, size_t count)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i])) {
            low = fmin(low, values[i]);
            high = fmax(high, values[i]);
        }
    return high > low ? high - low : 1;
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

// Marks the rows that one column needs: each stretch with values is thinned by itself, and the
// first row without a value keeps the gap.
static void thin(const thinned *table, const segment *part, const double *y, char *keep)
{
    size_t rows = part->last - part->first + 1;
    const double *t = table->t + part->first;
    double bound = table->detail->pixel * span_of(y, rows);
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
    base64 text = {.file = table->json};
    long long before = 0;
    for (size_t i = part->first; i <= part->last; i++) {
        if (!table->any[i - part->first])
            continue;
        long long now = llround((table->t[i] - table->t[part->first]) * 1e9);
        base64_count(&text, (size_t)(now > before ? now - before : 0));
        before = now > before ? now : before;
    }
    base64_flush(&text);
}

// Which of those rows a column needs: the steps from one to the next, the first from -1.
static void write_rows(const thinned *table, size_t rows, const char *keep)
{
    if (memcmp(keep, table->any, rows) == 0) {
        fputs("null", table->json);
        return;
    }
    base64 text = {.file = table->json};
    size_t step = 0;
    fputc('"', table->json);
    for (size_t i = 0; i < rows; i++) {
        step += table->any[i] != 0;
        if (!keep[i])
            continue;
        base64_count(&text, step);
        step = 0;
    }
    base64_flush(&text);
    fputc('"', table->json);
}

static void write_values(const thinned *table, const segment *part, const double *y,
                         const char *keep)
{
    base64 text = {.file = table->json};
    fputc('"', table->json);
    for (size_t i = 0; i <= part->last - part->first; i++)
        if (keep[i])
            base64_float(&text, y[i]);
    base64_flush(&text);
    fputc('"', table->json);
}

static void write_segment(const thinned *table, const segment *part)
{
    size_t rows = part->last - part->first + 1;
    memset(table->any, 0, rows);
    for (size_t c = 0; c < table->columns; c++) {
        char *keep = table->keep + c * table->history->rows;
        thin(table, part, values_of(table, c) + part->first, keep);
        for (size_t i = 0; i < rows; i++)
            table->any[i] |= keep[i];
    }
    fprintf(table->json, "{\"name\":\"%s\",\"of\":%zu,\"from\":%.17g,\"t\":\"", part->name, rows,
            table->t[part->first]);
    write_times(table, part);
    fputs("\",\"rows\":[", table->json);
    for (size_t c = 0; c < table->columns; c++) {
        fputs(c ? "," : "", table->json);
        write_rows(table, rows, table->keep + c * table->history->rows);
    }
    fputs("],\"values\":[", table->json);
    for (size_t c = 0; c < table->columns && ftell(table->json) <= REPORT_BYTES; c++) {
        fputs(c ? "," : "", table->json);
        write_values(table, part, values_of(table, c) + part->first,
                     table->keep + c * table->history->rows);
    }
    fputs("]}", table->json);
}

static void write_table(thinned *table, int rocket)
{
    const history_data *history = table->history;
    bool flight = report_is_flight(history);
    for (size_t i = 0; i < history->columns; i++)
        if (is_shown(history->name[i], flight))
            table->column[table->columns++] = i;
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
    fputs("],\"segments\":[", table->json);
    for (size_t first = 0;
         table->t && first < history->rows && ftell(table->json) <= REPORT_BYTES;) {
        segment part = segment_from(table, first);
        fputs(first ? ",\n" : "\n", table->json);
        write_segment(table, &part);
        first = part.last + 1;
    }
    fputs("]}", table->json);
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
    table.keep = malloc(history->columns * rows + 1);
    table.any = malloc(rows + 1);
    bool fine = table.column && table.keep && table.any;
    if (fine)
        write_table(&table, rocket);
    free(table.column);
    free(table.keep);
    free(table.any);
    return fine ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
}
