// The gnuplot script of a page of figures, with its data in it.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "base/printed.h"
#include "figures/labels.h"
#include "figures/plot.h"

// Lengths of the page in pixels of the svg (plot_begin).
enum {
    TITLE = 34,
    NAMES = 24,
    HEADING = 34,
    PANEL = 240,
    LEFT = 75,
    RIGHT = 25,
    TOP = 44,
    TOP_NARROW = 60, // where title and legend have a line each
    BOTTOM = 50,
    TWO_COLUMNS = 640 // width from which two panels stand in a row
};
enum { MOST_CURVES = 64, DASHES = 5, COLOURS = PLOT_RUNS, CURVE_PLACES = 200 };

// One run of the page.
typedef struct plot_source {
    const history_data *history;
    const double *t; // [s] on the run's clock
    double t_ignition;
    plot_marks marks;
} plot_source;

// A curve of a panel, found in the history of a run.
typedef struct found_curve {
    const plot_source *source;
    const double *y;
    const double *x; // NULL: time from ignition
    int run, column; // which run it is of, and which column among those that match
    char label[LD_MAX_NAME + 8];
} found_curve;

// Names beside dots of a panel, and places of its curves, in pixels from the axes' upper left.
typedef struct path_names {
    label_beside label[LABELS_MOST];
    const plot_mark *mark[LABELS_MOST];
    size_t count, others;
    double other[MOST_CURVES * CURVE_PLACES][2];
} path_names;

// A panel in the making: its curves in the units shown, its place and its axes.
typedef struct plot_drawing {
    FILE *script;
    const plot_page *page;
    const plot_figure *figure;
    const plot_panel *panel;
    plot_source *source;            // [runs]
    plot_source *flight[PLOT_RUNS]; // [flights of the run]
    bool headed;                    // the figure's heading is written
    int index;                      // of the panel on the page
    double height;                  // of the page
    double left, top, width;        // of the panel on the page, from above
    double *x, *y;                  // [rows] scaled values of one curve
    char *keep;                     // [rows] points that are drawn
    size_t *stack;                  // [2 rows] of the thinning
    path_names *names;              // of the panel's instants, beside its curves
    int count;                      // curves
    int columns;                    // different columns among them
    found_curve curve[MOST_CURVES];
    double x_range[2], y_range[2];
} plot_drawing;

static const char *const dash[DASHES] = {"solid", "(8,4)", "(2,3)", "(8,3,2,3)", "(14,4)"};

static bool has_several_runs(const plot_drawing *drawing)
{
    return drawing->page->runs > 1;
}

static const plot_style *style_of(const plot_drawing *drawing)
{
    return drawing->page->style;
}

static const char *run_colour(const plot_drawing *drawing, size_t run)
{
    return style_of(drawing)->colour[run];
}

static bool is_narrow(const plot_page *page)
{
    return page->width < TWO_COLUMNS;
}

// Room above a panel's axes.
static double top_room(const plot_drawing *drawing)
{
    return is_narrow(drawing->page) ? TOP_NARROW : TOP;
}

// In a paper the caption says what the page is: no title, a heading only where there are several.
static double title_height(const plot_page *page)
{
    return page->style->caption ? 0 : TITLE;
}

static double heading_height(const plot_page *page)
{
    return page->style->caption && page->figures == 1 ? 0 : HEADING;
}

// ---- words ----

enum { WORDS = 96 };

static bool on_surfaces(const history_data *run)
{
    for (size_t i = 0; i < run->columns; i++)
        if (strncmp(run->name[i], "shoe.", 5) == 0)
            return true;
    return false;
}

// A text of the figures, which speak of a tube and adaptors, as it is for a run: on surfaces of a
// guide and shoes.
static void put_words(const history_data *run, const char *text, char out[WORDS])
{
    static const char *const word[][2] = {
        {"tube", "guide"}, {"Tube", "Guide"}, {"adaptor", "shoe"}, {"Adaptor", "Shoe"}};
    enum { COUNT = sizeof word / sizeof *word };
    size_t used = 0;
    bool other = on_surfaces(run);
    while (*text && used + 8 < WORDS) {
        int k = other ? 0 : COUNT;
        while (k < COUNT && strncmp(text, word[k][0], strlen(word[k][0])) != 0)
            k++;
        if (k < COUNT) {
            used += (size_t)snprintf(out + used, WORDS - used, "%s", word[k][1]);
            text += strlen(word[k][0]);
        } else {
            out[used++] = *text++;
        }
    }
    out[used] = '\0';
}

// ---- curves ----

bool plot_column_matches(const char *name, const char *pattern, char *label, size_t size)
{
    const char *star = strchr(pattern, '*');
    if (!star)
        return strcmp(name, pattern) == 0;
    size_t before = (size_t)(star - pattern), after = strlen(star + 1), length = strlen(name);
    if (length <= before + after || strncmp(name, pattern, before) != 0 ||
        strcmp(name + length - after, star + 1) != 0)
        return false;
    snprintf(label, size, "%.*s", (int)(length - before - after), name + before);
    return true;
}

bool plot_figure_shows(const plot_figure *figure, const char *column)
{
    char unused[LD_MAX_NAME + 8];
    for (const plot_panel *panel = figure->panel;
         panel < figure->panel + PLOT_PANELS && panel->title; panel++) {
        if (panel->x_column && strcmp(panel->x_column, column) == 0)
            return true;
        for (const plot_curve *curve = panel->curve; curve->column; curve++)
            if (plot_column_matches(column, curve->column, unused, sizeof unused))
                return true;
    }
    return false;
}

bool plot_figure_has_columns(const plot_figure *figure, const history_data *run)
{
    if (figure->time == PLOT_FLIGHT && run->flights == 0)
        return false;
    if (figure->time == PLOT_FLIGHT)
        run = &run->flight[0];
    char unused[LD_MAX_NAME + 8];
    for (const plot_panel *panel = figure->panel;
         panel < figure->panel + PLOT_PANELS && panel->title; panel++)
        for (const plot_curve *curve = panel->curve; curve->column; curve++)
            for (size_t i = 0; i < run->columns; i++)
                if (plot_column_matches(run->name[i], curve->column, unused, sizeof unused))
                    return true;
    return false;
}

static bool any_finite(const double *values, size_t rows)
{
    for (size_t i = 0; i < rows; i++)
        if (isfinite(values[i]))
            return true;
    return false;
}

// The curves of a history that a column or a pattern names.
static int find_in_source(plot_drawing *drawing, const plot_curve *wanted,
                          const plot_source *source, int run, int column)
{
    const history_data *history = source->history;
    const char *against = drawing->panel->x_column;
    const double *x = against ? history_column(history, against) : NULL;
    if (against && !x)
        return column;
    for (size_t i = 0; i < history->columns && drawing->count < MOST_CURVES; i++) {
        found_curve *curve = &drawing->curve[drawing->count];
        char label[WORDS];
        put_words(history, wanted->label, label);
        snprintf(curve->label, sizeof curve->label, "%.*s", (int)sizeof curve->label - 1, label);
        if (!plot_column_matches(history->name[i], wanted->column, curve->label,
                                 sizeof curve->label))
            continue;
        curve->source = source;
        curve->y = history->value + i * history->rows;
        curve->x = x;
        curve->run = run;
        curve->column = column++;
        drawing->count += any_finite(curve->y, history->rows);
    }
    return column;
}

// The name of a flight in the legend, after that of the curve if it has one.
static void name_flight(const history_data *flight, const char *label, char *name, size_t size)
{
    int length = snprintf(name, size, "%s%srocket %d", label, *label ? ", " : "", flight->number);
    if (flight->tube > 0)
        snprintf(name + length, size - (size_t)length, ", tube %d", flight->tube);
}

// The same of one run: of its launcher, or of each of its flights, which are then named.
static int find_in_run(plot_drawing *drawing, const plot_curve *wanted, int run, int column)
{
    if (drawing->figure->time != PLOT_FLIGHT)
        return find_in_source(drawing, wanted, &drawing->source[run], run, column);
    const history_data *history = drawing->source[run].history;
    for (size_t i = 0; i < history->flights; i++) {
        char name[LD_MAX_NAME];
        if (history->flights > 1)
            name_flight(&history->flight[i], wanted->label, name, sizeof name);
        plot_curve of_flight = {wanted->column, history->flights > 1 ? name : wanted->label};
        column = find_in_source(drawing, &of_flight, &drawing->flight[run][i], run, column);
    }
    return column;
}

static void find_curves(plot_drawing *drawing)
{
    drawing->count = drawing->columns = 0;
    for (const plot_curve *wanted = drawing->panel->curve; wanted->column; wanted++) {
        int first = drawing->columns;
        for (size_t run = 0; run < drawing->page->runs; run++)
            drawing->columns =
                (int)fmax(drawing->columns, find_in_run(drawing, wanted, (int)run, first));
    }
}

// From and to [s] from ignition: what was asked for, else all of a vehicle's motion, and of a
// launch what comes after ignition.
static bool is_in_range(const plot_drawing *drawing, double t)
{
    const double before = 5e-3;
    double from = drawing->page->from, to = drawing->page->to;
    if (isnan(from))
        from = drawing->figure->time == PLOT_LAUNCH ? -before : -INFINITY;
    return t >= from && !(t > to);
}

// The row at ignition, or the first after it.
static size_t row_of_ignition(const plot_source *source)
{
    size_t row = 0;
    while (row + 1 < source->history->rows && source->t[row] < source->t_ignition)
        row++;
    return row;
}

// x and y of a curve, in the units shown; NaN outside the time that is shown.
static void set_points(plot_drawing *drawing, const found_curve *curve)
{
    const plot_panel *panel = drawing->panel;
    const plot_source *source = curve->source;
    double in_time = drawing->figure->time == PLOT_LAUNCH ? 1e3 : 1;
    double reference =
        panel->since && source->history->rows > 0 ? curve->y[row_of_ignition(source)] : 0;
    for (size_t i = 0; i < source->history->rows; i++) {
        double t = source->t[i] - source->t_ignition;
        drawing->x[i] = curve->x ? curve->x[i] * panel->x.unit.factor : t * in_time;
        drawing->y[i] =
            is_in_range(drawing, t) ? (curve->y[i] - reference) * panel->y.unit.factor : NAN;
    }
}

static bool drawable(const plot_drawing *drawing, size_t i)
{
    return isfinite(drawing->x[i]) && isfinite(drawing->y[i]);
}

static void include(double range[2], double value)
{
    range[0] = fmin(range[0], value);
    range[1] = fmax(range[1], value);
}

// Room around the values; something to draw even where they are all the same.
static void widen(double range[2], double share)
{
    double room = (range[1] - range[0]) * share, largest = fmax(fabs(range[0]), fabs(range[1]));
    if (!(room > largest * 1e-12))
        room = largest > 0 ? largest * 0.1 : 1;
    range[0] -= room;
    range[1] += room;
}

// The ranges of what is drawn; 0 to 1 where that is nothing.
static void set_ranges(plot_drawing *drawing)
{
    double x[2] = {INFINITY, -INFINITY}, y[2] = {INFINITY, -INFINITY};
    for (int i = 0; i < drawing->count; i++) {
        set_points(drawing, &drawing->curve[i]);
        for (size_t row = 0; row < drawing->curve[i].source->history->rows; row++)
            if (drawable(drawing, row)) {
                include(x, drawing->x[row]);
                include(y, drawing->y[row]);
            }
    }
    if (x[0] > x[1]) {
        drawing->count = 0;
        x[0] = y[0] = 0;
        x[1] = y[1] = 1;
    }
    widen(x, drawing->panel->x_column ? 0.05 : 0.01);
    widen(y, 0.06);
    memcpy(drawing->x_range, x, sizeof x);
    memcpy(drawing->y_range, y, sizeof y);
}

void plot_end_data(FILE *script, const char *block, int lines)
{
    fprintf(script, "EOD\nif (|%s| != %d) exit error 'no memory for a curve'\n", block, lines);
}

// Each run of drawable points becomes a line; an empty line of data parts them.
static void write_curve(plot_drawing *drawing, int curve)
{
    size_t rows = drawing->curve[curve].source->history->rows;
    set_points(drawing, &drawing->curve[curve]);
    memset(drawing->keep, 0, rows);
    const plot_line line = {.x = drawing->x,
                            .y = drawing->y,
                            .x_span = drawing->x_range[1] - drawing->x_range[0],
                            .y_span = drawing->y_range[1] - drawing->y_range[0],
                            .keep = drawing->keep,
                            .stack = drawing->stack};
    char block[32];
    int lines = 0;
    snprintf(block, sizeof block, "$p%dc%d", drawing->index, curve);
    fprintf(drawing->script, "%s << EOD\n", block);
    for (size_t first = 0; first < rows; first++) {
        if (!drawable(drawing, first))
            continue;
        size_t last = first;
        while (last + 1 < rows && drawable(drawing, last + 1))
            last++;
        plot_thin(&line, first, last);
        for (size_t i = first; i <= last; i++)
            if (drawing->keep[i]) {
                fprintf(drawing->script, "%.8g %.8g\n", drawing->x[i], drawing->y[i]);
                lines++;
            }
        fputc('\n', drawing->script);
        lines++;
        first = last;
    }
    plot_end_data(drawing->script, block, lines);
}

// ---- the panel ----

// Within double quotes, where gnuplot gives these signs a meaning.
static void write_escaped(FILE *script, const char *shown)
{
    for (; *shown; shown++)
        fprintf(script, strchr("'\"`\\@$", *shown) ? "\\%03o" : "%c", (unsigned char)*shown);
}

// In single quotes, where gnuplot expands nothing; a text that has such a quote in double ones,
// for gnuplot 5.4 reads two of them in a row, or one at the beginning, as its end.
void plot_write_quoted(FILE *script, const char *text)
{
    char shown[5];
    bool twice = strchr(text, '\'') != NULL;
    const char *quote = twice ? "\"" : "'";
    fputs(quote, script);
    for (const char *c = text; *c;) {
        // gnuplot escapes < and & in SVG, but leaves ]]>, which XML forbids
        bool ends = *c == '>' && c >= text + 2 && c[-1] == ']' && c[-2] == ']';
        c += printed_character(c, shown);
        const char *written = ends ? "\\x3e" : shown;
        if (twice)
            write_escaped(script, written);
        else
            fputs(written, script);
    }
    fputs(quote, script);
}

// ---- instants ----

// The source whose instants are named: a run's launcher, or its first flight; NULL where it has
// none.
static const plot_source *named_source(const plot_drawing *drawing, size_t run)
{
    if (drawing->figure->time != PLOT_FLIGHT)
        return &drawing->source[run];
    return drawing->source[run].history->flights > 0 ? &drawing->flight[run][0] : NULL;
}

// Whether the figure at hand shows an instant.
static bool marks(const plot_drawing *drawing, const plot_mark *mark)
{
    return (mark->figures >> drawing->figure->time & 1) != 0 && is_in_range(drawing, mark->t);
}

// Place of an instant on the time axis, NaN where it is not on it.
static double place_of(const plot_drawing *drawing, const plot_mark *mark)
{
    double x = mark->t * (drawing->figure->time == PLOT_LAUNCH ? 1e3 : 1);
    bool there = marks(drawing, mark) && x >= drawing->x_range[0] && x <= drawing->x_range[1];
    return there ? x : NAN;
}

// The source whose instants are marked over time: of several flights none, since each has its own.
static const plot_source *marked_source(const plot_drawing *drawing, size_t run)
{
    bool flights = drawing->figure->time == PLOT_FLIGHT;
    return flights && drawing->source[run].history->flights > 1 ? NULL : named_source(drawing, run);
}

// A name above the panel, `left` pixels from its axis, with a line from its foot to its instant.
static void write_name_above(const plot_drawing *drawing, const label_on_line *label,
                             const char *name, double place)
{
    double across = drawing->width - LEFT - RIGHT, up = PANEL - BOTTOM - top_room(drawing);
    double foot = fmin(fmax(label->at, label->left), label->left + label->width);
    fputs("set label ", drawing->script);
    plot_write_quoted(drawing->script, name);
    fprintf(drawing->script, " at graph %.6f, graph %.6f center font ',9' tc rgb '#%s'\n",
            (label->left + label->width / 2) / across, 1 + 11 / up, style_of(drawing)->soft);
    fprintf(drawing->script,
            "set arrow from graph %.6f, graph %.6f to %.8g, graph 1 nohead lw 1 lc rgb '#%s'\n",
            foot / across, 1 + 5 / up, place, style_of(drawing)->soft);
}

// Names above the panel, none through another; those that have no room are left out.
static void write_instant_names(const plot_drawing *drawing, const plot_marks *of)
{
    double across = drawing->width - LEFT - RIGHT;
    double pixels = across / (drawing->x_range[1] - drawing->x_range[0]);
    label_on_line label[PLOT_MARKS];
    const plot_mark *mark[PLOT_MARKS];
    size_t count = 0;
    for (size_t i = 0; i < of->count; i++) {
        double place = place_of(drawing, &of->mark[i]);
        if (isnan(place))
            continue;
        mark[count] = &of->mark[i];
        label[count++] = (label_on_line){.at = (place - drawing->x_range[0]) * pixels,
                                         .width = label_width(of->mark[i].name, 9),
                                         .rank = of->mark[i].rank};
    }
    labels_place_on_line(label, count, -LEFT / 2.0, across + RIGHT - 5, 6);
    for (size_t k = 0; k < count; k++)
        if (isfinite(label[k].left))
            write_name_above(drawing, &label[k], mark[k]->name, place_of(drawing, mark[k]));
}

// Whether the first run has a line where that of an instant of another run would stand.
static bool coincides(const plot_drawing *drawing, const plot_marks *first, const plot_mark *mark)
{
    double seen = (drawing->x_range[1] - drawing->x_range[0]) / 300;
    for (size_t i = 0; first && i < first->count; i++)
        if (strcmp(first->mark[i].name, mark->name) == 0)
            return fabs(place_of(drawing, &first->mark[i]) - place_of(drawing, mark)) < seen;
    return false;
}

// A vertical line at each key instant; of several runs in their colours, where they differ.
static void write_instants_in_time(const plot_drawing *drawing)
{
    const plot_source *first = marked_source(drawing, 0);
    if (first)
        write_instant_names(drawing, &first->marks);
    for (size_t run = 0; run < drawing->page->runs; run++) {
        const plot_source *source = marked_source(drawing, run);
        for (size_t i = 0; source && i < source->marks.count; i++) {
            const plot_mark *mark = &source->marks.mark[i];
            double place = place_of(drawing, mark);
            if (isfinite(place) &&
                (run == 0 || !coincides(drawing, first ? &first->marks : NULL, mark)))
                fprintf(drawing->script,
                        "set arrow from %.8g, graph 0 to %.8g, graph 1 nohead lw 1 dt (4,3) lc rgb "
                        "'#%s' back\n",
                        place, place,
                        run == 0 ? style_of(drawing)->soft : run_colour(drawing, run));
        }
    }
}

// The row of a curve that is nearest to a time, of those that are drawn; `rows` if there is none.
static size_t nearest_row(const plot_drawing *drawing, const plot_source *source, double t)
{
    size_t rows = source->history->rows, nearest = rows;
    for (size_t row = 0; row < rows; row++)
        if (drawable(drawing, row) &&
            (nearest == rows || fabs(source->t[row] - t) < fabs(source->t[nearest] - t)))
            nearest = row;
    return nearest;
}

static double pixel(const double range[2], double value, double pixels)
{
    return (value - range[0]) / (range[1] - range[0]) * pixels;
}

// Some hundred places of the curve whose points are set, as it is drawn.
static void add_places(const plot_drawing *drawing, size_t rows, path_names *names)
{
    double across = drawing->width - LEFT - RIGHT, up = PANEL - BOTTOM - top_room(drawing);
    for (int i = 0; i < CURVE_PLACES && rows > 0; i++) {
        size_t row = (rows - 1) * (size_t)i / (CURVE_PLACES - 1);
        if (!drawable(drawing, row))
            continue;
        double *place = names->other[names->others++];
        place[0] = pixel(drawing->x_range, drawing->x[row], across);
        place[1] = up - pixel(drawing->y_range, drawing->y[row], up);
    }
}

// A dot on a curve at each key instant, in the colour of its run; those of the first launcher or
// flight of the only run are to have names.
static void write_dots(plot_drawing *drawing, const found_curve *curve, path_names *names)
{
    const plot_source *source = curve->source;
    double across = drawing->width - LEFT - RIGHT, up = PANEL - BOTTOM - top_room(drawing);
    bool named = !has_several_runs(drawing) && source == named_source(drawing, 0);
    set_points(drawing, curve);
    add_places(drawing, source->history->rows, names);
    for (size_t i = 0; i < source->marks.count; i++) {
        const plot_mark *mark = &source->marks.mark[i];
        if (!marks(drawing, mark))
            continue;
        size_t row = nearest_row(drawing, source, mark->t + source->t_ignition);
        if (row == source->history->rows)
            continue;
        fprintf(drawing->script,
                "set label '' at %.8g, %.8g point pt 7 ps 0.6 lc rgb '#%s' front\n",
                drawing->x[row], drawing->y[row],
                has_several_runs(drawing) ? run_colour(drawing, (size_t)curve->run)
                                          : style_of(drawing)->ink);
        if (!named || mark->rocket > 0 || names->count == LABELS_MOST)
            continue;
        names->mark[names->count] = mark;
        names->label[names->count++] =
            (label_beside){.x = pixel(drawing->x_range, drawing->x[row], across),
                           .y = up - pixel(drawing->y_range, drawing->y[row], up),
                           .width = label_width(mark->name, 9)};
    }
}

// Those of the lowest rank come first; equal ones stay as they were.
static void rank_names(path_names *names)
{
    for (size_t i = 1; i < names->count; i++)
        for (size_t k = i; k > 0 && names->mark[k]->rank < names->mark[k - 1]->rank; k--) {
            label_beside label = names->label[k];
            const plot_mark *mark = names->mark[k];
            names->label[k] = names->label[k - 1];
            names->mark[k] = names->mark[k - 1];
            names->label[k - 1] = label;
            names->mark[k - 1] = mark;
        }
}

// Dots on the curves of a panel, with names where these have room.
static void write_instants_on_curves(plot_drawing *drawing)
{
    double across = drawing->width - LEFT - RIGHT, up = PANEL - BOTTOM - top_room(drawing);
    path_names *names = drawing->names;
    names->count = names->others = 0;
    for (int i = 0; i < drawing->count; i++)
        write_dots(drawing, &drawing->curve[i], names);
    rank_names(names);
    labels_place_beside(names->label, names->count, 11,
                        &(label_box){2, across + RIGHT - 3, -14, up},
                        (const double(*)[2])names->other, names->others);
    for (size_t i = 0; i < names->count; i++) {
        const label_box *box = &names->label[i].box;
        if (!names->label[i].placed)
            continue;
        fputs("set label ", drawing->script);
        plot_write_quoted(drawing->script, names->mark[i]->name);
        fprintf(drawing->script, " at graph %.6f, graph %.6f center font ',9' tc rgb '#%s' front\n",
                (box->left + box->right) / 2 / across, 1 - (box->top + box->bottom) / 2 / up,
                style_of(drawing)->soft);
    }
}

// A text at a place of the page, `top` pixels below its upper edge.
static void write_text(const plot_drawing *drawing, const char *text, double left, double top,
                       const char *style)
{
    fputs("set label ", drawing->script);
    plot_write_quoted(drawing->script, text);
    fprintf(drawing->script, " at screen %.6f, screen %.6f tc rgb '#%s' %s\n",
            left / drawing->page->width, 1 - top / drawing->height, style_of(drawing)->ink, style);
}

// The runs' colours and names in rows above the figures; returns the height that they take.
static double place_run_names(const plot_drawing *drawing, const plot_page *page)
{
    const double line = 26, letter = 6.6;
    double left = 16, top = 0;
    for (size_t run = 0; run < page->runs; run++) {
        double width = line + 28 + letter * (double)strlen(page->name[run]);
        if (left > 16 && left + width > page->width) {
            left = 16;
            top += NAMES;
        }
        if (drawing) {
            double middle = 1 - (top + NAMES * 0.6) / drawing->height;
            fprintf(drawing->script,
                    "set arrow from screen %.6f, screen %.6f to screen %.6f, screen %.6f nohead "
                    "lw 2.5 lc rgb '#%s'\n",
                    left / page->width, middle, (left + line) / page->width, middle,
                    run_colour(drawing, run));
            write_text(drawing, page->name[run], left + line + 6, top + NAMES * 0.6,
                       "left font ',12'");
        }
        left += width;
    }
    return top + NAMES + 6;
}

static void write_headings(plot_drawing *drawing)
{
    const plot_page *page = drawing->page;
    if (drawing->index == 0 && has_several_runs(drawing))
        place_run_names(drawing, page);
    else if (drawing->index == 0 && page->run[0].title && title_height(page) > 0)
        write_text(drawing, page->run[0].title, 16, TITLE * 0.55, "left font ',17'");
    if (!drawing->headed && heading_height(page) > 0) {
        double above = 1 - (drawing->top - HEADING) / drawing->height;
        fprintf(drawing->script,
                "set arrow from screen %.6f, screen %.6f to screen %.6f, screen %.6f nohead lw 1 "
                "lc rgb '#%s'\n",
                16 / page->width, above, 1 - 16 / page->width, above, style_of(drawing)->grid);
        char heading[WORDS];
        put_words(&page->run[0], drawing->figure->about.description, heading);
        write_text(drawing, heading, 16, drawing->top - HEADING * 0.35,
                   is_narrow(page) ? "left font ',12'" : "left font ',14'");
    }
    drawing->headed = true;
}

static void write_axes(plot_drawing *drawing)
{
    const plot_panel *panel = drawing->panel;
    FILE *script = drawing->script;
    double top = drawing->top + top_room(drawing), bottom = drawing->top + PANEL - BOTTOM;
    char y_text[64], x_text[64] = "time from ignition [s]";
    fprintf(script, "set lmargin at screen %.6f\nset rmargin at screen %.6f\n",
            (drawing->left + LEFT) / drawing->page->width,
            (drawing->left + drawing->width - RIGHT) / drawing->page->width);
    fprintf(script, "set tmargin at screen %.6f\nset bmargin at screen %.6f\n",
            1 - top / drawing->height, 1 - bottom / drawing->height);
    fprintf(script, "set xrange [%.8g:%.8g]\nset yrange [%.8g:%.8g]\n", drawing->x_range[0],
            drawing->x_range[1], drawing->y_range[0], drawing->y_range[1]);
    if (is_narrow(drawing->page))
        fprintf(script, "set key at graph 1, 1.27 samplen 1.5 width %d\n",
                drawing->columns > 2 ? -1 : 0); // three stand in a line
    plot_axis_text(&panel->y, y_text, sizeof y_text);
    if (panel->x_column)
        plot_axis_text(&panel->x, x_text, sizeof x_text);
    else if (drawing->figure->time == PLOT_LAUNCH)
        snprintf(x_text, sizeof x_text, "time from ignition [ms]");
    write_text(drawing, panel->title, drawing->left + LEFT,
               top - (is_narrow(drawing->page) ? 48 : 26), "left font ',11'");
    write_text(drawing, y_text, drawing->left + 18, (top + bottom) / 2,
               "center rotate by 90 font ',10'");
    write_text(drawing, x_text, drawing->left + (LEFT + drawing->width - RIGHT) / 2, bottom + 34,
               "center font ',10'");
}

static void write_title(FILE *script, const char *title)
{
    fputs(*title ? "title " : "notitle", script);
    if (*title)
        plot_write_quoted(script, title);
}

// Of one run, a colour for each column. Of several, a colour for each run, and where there are
// several columns a dash for each, in the legend in grey.
static void write_plot(const plot_drawing *drawing)
{
    FILE *script = drawing->script;
    for (int i = 0; i < drawing->count; i++) {
        const found_curve *curve = &drawing->curve[i];
        int lines = has_several_runs(drawing) ? curve->run : curve->column;
        fprintf(script, "%s $p%dc%d using 1:2 with lines ls %d ", i ? ", \\\n    " : "plot",
                drawing->index, i, lines % COLOURS + 1);
        if (has_several_runs(drawing) || style_of(drawing)->dashed)
            fprintf(script, "dt %s ", dash[curve->column % DASHES]);
        write_title(script, has_several_runs(drawing) ? "" : curve->label);
    }
    int shown = 0;
    for (int i = 0; i < drawing->count && has_several_runs(drawing) && drawing->columns > 1; i++)
        if (drawing->curve[i].column == shown) {
            fprintf(script, ", \\\n     keyentry with lines lw 1.5 lc rgb '#%s' dt %s ",
                    style_of(drawing)->ink, dash[shown++ % DASHES]);
            write_title(script, drawing->curve[i].label);
        }
    if (drawing->count == 0)
        fprintf(
            script,
            "set label 'nothing to show' at graph 0.5, 0.5 center tc rgb '#%s'\nplot NaN notitle",
            style_of(drawing)->ink);
    fputc('\n', script);
}

static void write_panel(plot_drawing *drawing)
{
    find_curves(drawing);
    set_ranges(drawing);
    for (int i = 0; i < drawing->count; i++)
        write_curve(drawing, i);
    fputs("unset label\nunset arrow\n", drawing->script);
    write_headings(drawing);
    write_axes(drawing);
    if (drawing->count > 0 && !drawing->panel->x_column)
        write_instants_in_time(drawing);
    if (drawing->panel->x_column)
        write_instants_on_curves(drawing);
    write_plot(drawing);
    drawing->index++;
}

// ---- the page ----

// The `copy`-th diagram of a panel; of one that is drawn for each text that its '*' stands for,
// that text goes into title and column. False after the last.
static bool panel_copy(const plot_panel *panel, const history_data *history, int copy,
                       plot_panel *made, char text[2][WORDS])
{
    char found[LD_MAX_NAME + 8], title[WORDS];
    *made = *panel;
    put_words(history, panel->title, title);
    if (!panel->each) {
        snprintf(text[0], sizeof *text, "%s", title);
        made->title = text[0];
        return copy == 0;
    }
    for (size_t i = 0; i < history->columns; i++)
        if (plot_column_matches(history->name[i], panel->curve[0].column, found, sizeof found) &&
            copy-- == 0) {
            const char *percent = strstr(title, "%s");
            snprintf(text[0], sizeof *text, "%.*s%s%s", (int)(percent - title), title, found,
                     percent + 2);
            snprintf(text[1], sizeof *text, "%s", history->name[i]);
            made->title = text[0];
            made->curve[0].column = text[1];
            return true;
        }
    return false;
}

static void draw_panel(plot_drawing *drawing, const plot_panel *panel, bool right, double top)
{
    double all = drawing->page->width, half = is_narrow(drawing->page) ? all : all / 2;
    drawing->panel = panel;
    drawing->left = right ? half : 0;
    drawing->width = panel->wide ? all : half;
    drawing->top = top;
    write_panel(drawing);
}

// Places of the panels of a figure from `top` on; returns where the next figure begins. Draws them
// if `drawing` is not NULL.
static double place_panels(const plot_page *page, const plot_figure *figure, double top,
                           plot_drawing *drawing)
{
    const history_data *history = &page->run[0];
    bool right = false;
    plot_panel made;
    char text[2][WORDS];
    top += heading_height(page);
    if (drawing) {
        drawing->figure = figure;
        drawing->headed = false;
    }
    for (int i = 0; i < PLOT_PANELS && figure->panel[i].title; i++)
        for (int copy = 0; panel_copy(&figure->panel[i], history, copy, &made, text); copy++) {
            if (drawing)
                draw_panel(drawing, &made, right, top);
            right = !right && !made.wide && !is_narrow(page);
            if (!right)
                top += PANEL;
        }
    return right ? top + PANEL : top;
}

static double place_figures(const plot_page *page, plot_drawing *drawing)
{
    double top = page->runs > 1 ? place_run_names(NULL, page) : title_height(page);
    for (size_t i = 0; i < page->figures; i++)
        top = place_panels(page, page->figure[i], top, drawing);
    return top;
}

static void set_source(plot_source *source, const history_data *history, bool flight)
{
    source->history = history;
    source->t = history_column(history, "t");
    source->t_ignition = isfinite(history->t_ignition) ? history->t_ignition : 0;
    plot_find_marks(history, flight, &source->marks);
}

// A run and its flights.
static ld_status set_sources(plot_drawing *drawing, size_t run, ld_error *error)
{
    const history_data *history = &drawing->page->run[run];
    set_source(&drawing->source[run], history, false);
    bool has_time = history->columns == 0 || drawing->source[run].t;
    drawing->flight[run] = malloc((history->flights + 1) * sizeof *drawing->flight[run]);
    if (!drawing->flight[run])
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the figures");
    for (size_t i = 0; i < history->flights; i++) {
        set_source(&drawing->flight[run][i], &history->flight[i], true);
        has_time = has_time && drawing->flight[run][i].t;
    }
    return has_time ? LD_OK : ld_fail(error, LD_ERR_INPUT, "the history has no column t");
}

// Rows of the longest history on the page.
static size_t most_rows(const plot_page *page)
{
    size_t rows = 0;
    for (size_t i = 0; i < page->runs; i++) {
        const history_data *run = &page->run[i];
        rows = run->rows > rows ? run->rows : rows;
        for (size_t j = 0; j < run->flights; j++)
            rows = run->flight[j].rows > rows ? run->flight[j].rows : rows;
    }
    return rows;
}

ld_status plot_write_script(FILE *script, const void *what, plot_format format, ld_error *error)
{
    const plot_page *page = what;
    size_t rows = most_rows(page);
    plot_drawing drawing = {
        .script = script,
        .page = page,
        .height = place_figures(page, NULL),
        .x = malloc((rows + 1) * sizeof(double)),
        .y = malloc((rows + 1) * sizeof(double)),
        .keep = malloc(rows + 1),
        .stack = malloc((2 * rows + 8) * sizeof(size_t)),
        .names = malloc(sizeof(path_names)),
        .source = malloc(page->runs * sizeof(plot_source)),
    };
    ld_status status = LD_OK;
    if (!drawing.x || !drawing.y || !drawing.keep || !drawing.stack || !drawing.names ||
        !drawing.source)
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the figures");
    if (!status)
        status = plot_fits(format, page->style, page->width, drawing.height, error);
    for (size_t i = 0; i < page->runs && !status; i++)
        status = set_sources(&drawing, i, error);
    if (!status) {
        locale_t before = numeric_locale_enter();
        plot_begin(script, format, page->style, page->width, drawing.height);
        place_figures(page, &drawing);
        fputs("unset multiplot\nunset output\n", script);
        numeric_locale_leave(before);
    }
    for (size_t i = 0; i < page->runs; i++)
        free(drawing.flight[i]);
    free(drawing.x);
    free(drawing.y);
    free(drawing.keep);
    free(drawing.stack);
    free(drawing.names);
    free(drawing.source);
    return status;
}
