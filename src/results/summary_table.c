#include <string.h>

#include "base/printed.h"
#include "launchdyn/output.h"
#include "math/functions.h"
#include "model/parts.h"
#include "quantities/summary.h"
#include "quantities/summary_quantities.h"
#include "run/measure_names.h"

// " ± error" of the values in a line, never less than their last digit; "" where it is not known.
static const char *print_error(const quantity_line *line, const void *from, char text[32])
{
    double error = quantity_number(&line->error, 0, from) * line->factor;
    text[0] = '\0';
    if (isfinite(error))
        snprintf(text, 32, " ± %.2g", fmax(error, pow(10, -line->digits)));
    return text;
}

// The label with `word` in the place of `tube`, where that stands in it.
static void replace(char label[QUANTITY_TEXT], const char *tube, const char *word)
{
    char rest[QUANTITY_TEXT];
    char *at = strstr(label, tube);
    if (!at)
        return;
    snprintf(rest, sizeof rest, "%s", at + strlen(tube));
    snprintf(at, (size_t)(label + QUANTITY_TEXT - at), "%s%s", word, rest);
}

// Labels are those of a tube with adaptors; a guide of surfaces is a rail, or a tower, with shoes.
static void make_label(const quantity_walk *at, char text[QUANTITY_TEXT])
{
    const ld_model *model = at->things->model;
    char label[QUANTITY_TEXT];
    snprintf(label, sizeof label, "%s", at->row->line.label);
    if (model_has_surfaces(model)) {
        replace(label, "tube", model_guide_word(model));
        replace(label, "adaptor", "shoe");
    }
    quantity_text(label, at->group->each, at->item, at->things, text, QUANTITY_TEXT);
}

// "  label           value unit", with two values side by side where the next quantity is said to
// stand there, and a remark; nothing where there is no value.
static void print_line(const quantity_walk *at, const void *from, const char *remark, FILE *stream)
{
    const quantity_line *line = &at->row->line;
    char label[QUANTITY_TEXT], second[32] = "", error[32];
    double value = quantity_value(at, from);
    quantity_walk next = *at;
    quantity_next(&next);
    make_label(at, label);
    if (next.row && next.row->line.beside) {
        double beside = quantity_value(&next, from) * next.row->line.factor;
        snprintf(second, sizeof second, " %12.*f", line->digits,
                 printed_fixed(beside, line->digits));
        value = isfinite(beside) ? value : NAN;
    }
    if (isfinite(value) && !(line->nonzero && value == 0))
        fprintf(stream, "  %-22s %12.*f%s%s %s%s\n", label, line->digits,
                printed_fixed(value * line->factor, line->digits), second,
                print_error(line, from, error), line->unit ? line->unit : quantity_unit(at),
                remark);
}

// The lines of one block.
static void print_block(const quantity_table *table, const quantity_things *things,
                        const void *from, int block, const char *remark, FILE *stream)
{
    for (quantity_walk at = quantity_first(table, things); at.row; quantity_next(&at)) {
        quantity_walk shown = at;
        if (at.group->backwards)
            shown.item = things->count[at.group->each] - 1 - at.item;
        if (at.group->block == block && at.row->line.label)
            print_line(&shown, from, remark, stream);
    }
}

// Frequencies of one kind of shape a line; the kinds in the order in which they first occur.
static void print_modes(const ld_model *model, const ld_summary *summary, FILE *stream)
{
    if (summary->mode_count == 0)
        return;
    fprintf(stream, "\nNatural frequencies of the %s on its supports [Hz]\n",
            model_guide_word(model));
    for (int i = 0; i < summary->mode_count; i++) {
        const char *shape = summary->mode[i].shape;
        bool shown = false;
        for (int j = 0; j < i && !shown; j++)
            shown = strcmp(summary->mode[j].shape, shape) == 0;
        if (shown)
            continue;
        fprintf(stream, "  %-22s", shape);
        for (int j = i; j < summary->mode_count; j++)
            if (strcmp(summary->mode[j].shape, shape) == 0)
                fprintf(stream, " %8.2f", summary->mode[j].frequency);
        fputc('\n', stream);
    }
}

static void print_rocket(const quantity_things *things, const ld_rocket_summary *rocket,
                         FILE *stream)
{
    fprintf(stream, "\nRocket of %s %d, instants from its ignition\n",
            model_guide_word(things->model), rocket->tube);
    for (int block = SHOWN_CHANGE; block <= SHOWN_MEASURES; block++) {
        bool steep = block == SHOWN_GROUND && near_vertical(rocket->pitch);
        print_block(&rocket_quantities, things, rocket, block, steep ? " (near the vertical)" : "",
                    stream);
    }
}

static void print_flight(const quantity_things *things, const ld_rocket_summary *rocket,
                         FILE *stream)
{
    const double *r = rocket->final.center;
    if (!rocket->flown)
        return;
    fputs("\nFlight\n", stream);
    print_block(&rocket_quantities, things, rocket, SHOWN_FLIGHT, "", stream);
    if (!isfinite(rocket->flight.t_impact))
        fprintf(stream, "  %-22s %12.3f %12.3f %12.3f m\n", "mass centre at the end",
                printed_fixed(r[0], 3), printed_fixed(r[1], 3), printed_fixed(r[2], 3));
}

static void print_cost(const ld_summary *summary, bool launch, FILE *stream)
{
    const ld_statistics *statistics = &summary->statistics;
    fputs("\nRun\n", stream);
    if (launch && isfinite(summary->energy.residual))
        fprintf(stream, "  %-22s %12.3e J, %.1e of the largest work\n", "energy residual",
                summary->energy.residual, summary->energy.residual_relative);
    fprintf(stream, "  %-22s %12lld, %lld evaluations\n", "steps", (long long)statistics->steps,
            (long long)statistics->rhs_evaluations);
    fprintf(stream, "  %-22s %12.1f ms, %.1f ms of it set-up\n", "CPU time",
            (statistics->cpu_seconds + statistics->cpu_seconds_setup) * 1e3,
            statistics->cpu_seconds_setup * 1e3);
}

void ld_summary_print(const ld_model *model, const ld_summary *summary, FILE *stream)
{
    const quantity_things things = quantity_things_of(model);
    bool launch = model_has_launcher(model);
    const char *title = model_title(model), *unnamed = launch ? "Launch" : "Flight alone";
    fprintf(stream, "%s\n", title && *title ? VISIBLE(title) : unnamed);
    if (launch) {
        print_modes(model, summary, stream);
        if (isfinite(summary->equilibrium.residual))
            fputs("\nEquilibrium at the start\n", stream);
        print_block(&run_quantities, &things, summary, SHOWN_EQUILIBRIUM, "", stream);
    }
    for (int i = 0; i < summary->rocket_count; i++) {
        if (launch)
            print_rocket(&things, &summary->rocket[i], stream);
        print_flight(&things, &summary->rocket[i], stream);
    }
    print_cost(summary, launch, stream);
    for (int i = 0; i < summary->note_count; i++)
        fprintf(stream, "%snote: %s\n", i ? "" : "\n", VISIBLE(summary->note[i]));
    if (!summary->complete)
        fprintf(stream, "\nStopped at %.7f s: %s\n", summary->t_end, VISIBLE(summary->stopped));
}
