// How pictures look: on a screen, on a dark one, in a paper.
#include <string.h>

#include "figures/plot.h"

// Pixels of 1/96 inch, 300 dots an inch.
static const double millimetre = 96 / 25.4, dots = 300.0 / 96;

// clang-format off
static const plot_style styles[] = {
    {.name = "screen", .paper = "ffffff", .ink = "303030", .soft = "606060", .grid = "e0e0e0",
     .colour = {"0072B2", "D55E00", "009E73", "CC79A7", "E69F00", "56B4E9", "000000", "999999"}},
    {.name = "dark", .paper = "1b2025", .ink = "e6eaee", .soft = "9aa5af", .grid = "343c44",
     .colour = {"56B4E9", "FF8F3C", "2FC79B", "E08FC4", "F0C040", "9AD4F5", "E6EAEE", "A0A0A0"}},
    {.name = "paper", .paper = "ffffff", .ink = "000000", .soft = "404040", .grid = "d8d8d8",
     .colour = {"0072B2", "D55E00", "009E73", "CC79A7", "E69F00", "56B4E9", "000000", "999999"},
     .millimetres = 84, .caption = true, .dashed = true},
};
// clang-format on

enum { STYLES = sizeof styles / sizeof *styles, USUAL_WIDTH = 1000, MOST_DOTS = 32767 };

const plot_style *plot_style_find(const char *name, ld_error *error)
{
    const char *names[STYLES];
    for (int i = 0; i < STYLES; i++) {
        names[i] = styles[i].name;
        if (!name || strcmp(name, styles[i].name) == 0)
            return &styles[i];
    }
    const char *nearest = ld_nearest_name(name, names, STYLES);
    ld_fail(error, LD_ERR_INPUT, "unknown style \"%.40s\"%s%s%s; expected screen, dark or paper",
            name, nearest ? " (did you mean " : "", nearest ? nearest : "", nearest ? "?)" : "");
    return NULL;
}

// Whether lengths are those of paper, not of a screen.
static bool is_measured(const plot_style *style, double width)
{
    return style->millimetres > 0 || width != USUAL_WIDTH;
}

double plot_width(const plot_style *style, double metres)
{
    if (metres > 0)
        return metres * 1e3 * millimetre;
    return style->millimetres > 0 ? style->millimetres * millimetre : USUAL_WIDTH;
}

ld_status plot_fits(plot_format format, const plot_style *style, double width, double height,
                    ld_error *error)
{
    double dots_high = height * (is_measured(style, width) ? dots : 2);
    if (format != PLOT_PNG || dots_high <= MOST_DOTS)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "a .png of these figures would be %.0f dots high, more than %d: name fewer with "
                   "--what, or draw a .pdf or .svg",
                   dots_high, MOST_DOTS);
}

// A font of 12 is 12 points in gnuplot's pdf with a fontscale of 3/4, and a line of 1 half a point.
static void set_terminal(FILE *script, plot_format format, const plot_style *style, double width,
                         double height)
{
    bool measured = is_measured(style, width);
    double inch = measured ? 96 : 72, scale = measured ? dots : 2;
    if (format == PLOT_SVG)
        fprintf(script, "set terminal svg size %.0f,%.0f font 'sans-serif,12' background '#%s'",
                width, height, style->paper);
    else if (format == PLOT_PDF)
        fprintf(
            script,
            "set terminal pdfcairo size %.4fin,%.4fin font 'sans-serif,12' fontscale %g linewidth "
            "%g background '#%s'",
            width / inch, height / inch, 0.75 * 72 / inch, measured ? 1.5 : 1.0, style->paper);
    else
        fprintf(script,
                "set terminal pngcairo size %.0f,%.0f font 'sans-serif,12' fontscale %g linewidth "
                "%g pointscale %g background '#%s'",
                scale * width, scale * height, 0.75 * scale, scale, scale, style->paper);
}

void plot_begin(FILE *script, plot_format format, const plot_style *style, double width,
                double height)
{
    set_terminal(script, format, style, width, height);
    fprintf(script,
            " noenhanced\nset encoding utf8\nset multiplot\n"
            "set key at graph 1, 1.15 right center horizontal Left reverse samplen 2 font ',10' "
            "textcolor rgb '#%s'\n"
            "set grid lc rgb '#%s' lw 0.8\nset border 3 lc rgb '#%s'\n"
            "set tics nomirror font ',10' textcolor rgb '#%s'\nset format '%%g'\n",
            style->ink, style->grid, style->ink, style->ink);
    for (int i = 0; i < PLOT_RUNS; i++)
        fprintf(script, "set style line %d lw 1.5 lc rgb '#%s'\n", i + 1, style->colour[i]);
}
