#include <math.h>
#include <stdio.h>

#include "base/printed.h"
#include "optimise/optimise.h"
#include "run/aims.h"
#include "studies/show/show_numbers.h"

enum { NAME = 44, CELL = 28 };

static const char *plural(long long count)
{
    return count == 1 ? "" : "s";
}

static const optimise_candidate *best_of(const ld_optimisation *self)
{
    return &self->candidate[self->best];
}

// ---- numbers

// `width` 0: what ends a line.
static void print_cell(FILE *stream, const ld_optimisation *self, int i, const optimise_pair *of,
                       int width)
{
    ld_estimate found = {NAN, NAN, NAN};
    if (of->number)
        found = optimise_estimate(self, i, of);
    const estimate shown = show_scaled(&found, self->aim[i].shown.factor);
    show_estimate(stream, width, &shown, 0.5 * (shown.high - shown.low));
}

static void print_head(FILE *stream, const char *title, const char *third)
{
    fprintf(stream, "\n%-*s %-*s %-*s %s\n", NAME, title, CELL, "scenario", CELL, "found", third);
}

static void print_line(FILE *stream, const ld_optimisation *self, int i, const char *name,
                       const optimise_pair *of)
{
    show_name(stream, NAME, name, self->aim[i].shown.name);
    const optimise_pair both = of->number && of->from ? *of : (optimise_pair){NULL, NULL, false};
    print_cell(stream, self, i, &(optimise_pair){of->from, NULL, of->others}, CELL);
    print_cell(stream, self, i, &(optimise_pair){of->number, NULL, of->others}, CELL);
    print_cell(stream, self, i, &both, 0);
    fputs("\n", stream);
}

static void print_aim(const ld_optimisation *self, FILE *stream)
{
    char text[256], name[64];
    const optimise_pair searched = {best_of(self)->number, self->candidate[0].number, false};
    const optimise_pair others = {self->others[1], self->others[0], true};
    aim_text(self->aim[0].as, text, sizeof text);
    fprintf(stream, "least %s%s\n", text, optimise_is_noisy(self) ? "; intervals of 95 %" : "");
    print_head(stream, "", "difference");
    if (!optimise_is_noisy(self)) {
        print_line(stream, self, 0, "one launch", &searched);
        return;
    }
    snprintf(name, sizeof name, "%d other samples", self->others_count);
    print_line(stream, self, 0, name, &others);
    snprintf(name, sizeof name, "%d samples of the search", self->samples);
    print_line(stream, self, 0, name, &searched);
}

static void print_keys(const ld_optimisation *self, FILE *stream)
{
    print_head(stream, "key", "bounds");
    for (int i = 0; i < self->keys; i++) {
        const optimise_key *key = &self->key[i];
        char text[3][32], bounds[80];
        show_text(text[0], field_get(self->model, &key->place), 6);
        show_text(text[1], optimise_key_value(key, best_of(self)->x[i]), 6);
        show_text(text[2], key->to, 6);
        snprintf(bounds, sizeof bounds, "%.6g to %s%s", key->from, text[2],
                 key->log ? ", by the logarithm" : "");
        show_name(stream, NAME, key->place.path, key->unit);
        fprintf(stream, " %-*s %-*s %s\n", CELL, text[0], CELL, text[1], bounds);
    }
}

static void print_bound(FILE *stream, const char *word, double limit, const study_unit *shown)
{
    if (!isnan(limit))
        fprintf(stream, " %s %.6g", word, limit * shown->factor);
}

static void print_limits(const ld_optimisation *self, FILE *stream)
{
    bool others = self->others[0] && self->others[1];
    const double *before = others ? self->others[0] : self->candidate[0].number;
    const double *found = others ? self->others[1] : best_of(self)->number;
    if (self->aims == 1)
        return;
    print_head(stream, "subject to", "limit");
    for (int i = 1; i < self->aims; i++) {
        char text[256];
        aim_text(self->aim[i].as, text, sizeof text);
        show_name(stream, NAME, text, self->aim[i].shown.name);
        print_cell(stream, self, i, &(optimise_pair){before, NULL, others}, CELL);
        print_cell(stream, self, i, &(optimise_pair){found, NULL, others}, CELL);
        print_bound(stream, "at least", self->aim[i].as->at_least, &self->aim[i].shown);
        print_bound(stream, "at most", self->aim[i].as->at_most, &self->aim[i].shown);
        fputs("\n", stream);
    }
}

// ---- what was shown, and what was not

static void print_course(const ld_optimisation *self, FILE *stream)
{
    fprintf(stream, "\n%s: %d candidate%s from %d start%s, %lld launch%s\n",
            optimum_method_of(self->as->method)->name, self->candidates, plural(self->candidates),
            self->starts, plural(self->starts), (long long)self->simulated,
            self->simulated == 1 ? "" : "es");
    if (self->failed > 0)
        fprintf(stream, "%d candidate%s without launches count as not allowed; the first: %s\n",
                self->failed, plural(self->failed), self->reason);
}

static void print_gain(const ld_optimisation *self, FILE *stream)
{
    if (best_of(self)->worst > 0) {
        fputs("shown: no candidate meets the constraints; this one breaks the worst least\n",
              stream);
        return;
    }
    if (!optimise_is_noisy(self)) {
        fputs("shown: the launch found is better by the difference\n", stream);
        return;
    }
    if (!self->others[0] || !self->others[1]) {
        fputs("not shown: the gain, as not all other samples can be launched\n", stream);
        return;
    }
    const optimise_pair others = {self->others[1], self->others[0], true};
    ld_estimate gain = optimise_estimate(self, 0, &others);
    if (gain.high < 0)
        fputs("shown: a gain on samples that the search did not use\n", stream);
    else
        fputs("not shown: a gain: on other samples its interval includes none\n", stream);
}

static int starts_at_best(const ld_optimisation *self)
{
    const double share = 0.01;
    int count = 0;
    for (int i = 0; i < self->starts; i++) {
        const optimum_found *end = &self->start[i].best;
        count += end->number >= 0 && !(end->worst > fmax(best_of(self)->worst, 0)) &&
                 end->value - best_of(self)->value <= share * fabs(best_of(self)->value);
    }
    return count;
}

static void print_ends(const ld_optimisation *self, FILE *stream)
{
    int ends[OPTIMUM_NOWHERE + 1] = {0};
    for (int i = 0; i < self->starts; i++)
        ends[self->start[i].end]++;
    if (ends[OPTIMUM_NOISE] > 0)
        fprintf(stream, "%d start%s ended by noise: the last round's gain is within its interval\n",
                ends[OPTIMUM_NOISE], plural(ends[OPTIMUM_NOISE]));
    if (ends[OPTIMUM_EVALUATIONS] > 0)
        fprintf(stream,
                "not shown: convergence of %d start%s, ended after %d candidates (evaluations)\n",
                ends[OPTIMUM_EVALUATIONS], plural(ends[OPTIMUM_EVALUATIONS]),
                self->as->evaluations);
    if (!optimum_method_of(self->as->method)->local)
        fputs("not shown: that nothing is lower: the search covers the bounds by its candidates "
              "alone\n",
              stream);
    else if (self->starts == 1)
        fputs("not shown: that nothing is lower elsewhere: the search is local, from one start\n",
              stream);
    else
        fprintf(stream,
                "%d of %d starts end within 1 %% of the best; not shown: that nothing is lower "
                "elsewhere\n",
                starts_at_best(self), self->starts);
}

static void print_bounds(const ld_optimisation *self, FILE *stream)
{
    for (int i = 0; i < self->keys; i++) {
        double x = best_of(self)->x[i], near = 2 * self->as->precision;
        if (x < near || x > 1 - near)
            fprintf(stream, "%s ends at its %s bound: what is beyond was not searched\n",
                    self->key[i].place.path, x < near ? "lower" : "upper");
    }
}

// Whether a constraint's interval reaches over its limit.
static bool is_unsure(const ld_optimisation *self, int i)
{
    const optimise_aim *aim = &self->aim[i];
    const optimise_pair of = {self->others[1] ? self->others[1] : best_of(self)->number, NULL,
                              self->others[1] != NULL};
    ld_estimate found = optimise_estimate(self, i, &of);
    double low = isnan(found.low) ? found.value : found.low;
    double high = isnan(found.high) ? found.value : found.high;
    return high > aim->as->at_most || low < aim->as->at_least;
}

static void print_unsure(const ld_optimisation *self, FILE *stream)
{
    bool margins = false;
    for (int i = 1; i < self->aims; i++) {
        char text[256];
        aim_text(self->aim[i].as, text, sizeof text);
        margins |= self->aim[i].margin >= 0;
        if (is_unsure(self, i))
            fprintf(stream, "not shown: that the %s keeps its limit\n", text);
    }
    if (margins)
        fputs("margins are those of the linearised equations\n", stream);
}

void ld_optimise_print(const ld_optimisation *self, FILE *stream)
{
    if (!self->done)
        return;
    print_aim(self, stream);
    print_keys(self, stream);
    print_limits(self, stream);
    print_course(self, stream);
    print_gain(self, stream);
    print_ends(self, stream);
    print_bounds(self, stream);
    print_unsure(self, stream);
}
