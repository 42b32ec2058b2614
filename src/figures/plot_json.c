// What the figures show as JSON, for the report.
#include "figures/plot.h"
#include "results/json_text.h"

void plot_axis_text(const plot_axis *axis, char *text, size_t size)
{
    const char *name = axis->name, *unit = axis->unit.name;
    snprintf(text, size, "%s%s%s%s%s", name, *name && *unit ? " " : "", *unit ? "[" : "", unit,
             *unit ? "]" : "");
}

static void write_axis(FILE *json, const plot_axis *axis)
{
    char text[64];
    plot_axis_text(axis, text, sizeof text);
    fputs("\"text\":", json);
    json_write_text(json, text);
    fputs(",\"unit\":", json);
    json_write_text(json, axis->unit.name);
    fprintf(json, ",\"factor\":%.17g}", axis->unit.factor);
}

static void write_curves(FILE *json, const plot_panel *panel)
{
    fputs(",\"curves\":[", json);
    for (const plot_curve *curve = panel->curve; curve->column; curve++) {
        fputs(curve == panel->curve ? "[" : ",[", json);
        json_write_text(json, curve->column);
        fputc(',', json);
        json_write_text(json, curve->label);
        fputc(']', json);
    }
    fputc(']', json);
}

static void write_panel(FILE *json, const plot_panel *panel)
{
    fputs("{\"title\":", json);
    json_write_text(json, panel->title);
    fprintf(json, ",\"wide\":%d,\"since\":%d,\"each\":%d,\"y\":{", panel->wide, panel->since,
            panel->each);
    write_axis(json, &panel->y);
    if (panel->x_column) {
        fprintf(json, ",\"x\":{\"column\":\"%s\",", panel->x_column);
        write_axis(json, &panel->x);
    }
    write_curves(json, panel);
    fputc('}', json);
}

static const char *const time[] = {
    [PLOT_LAUNCH] = "launch", [PLOT_VEHICLE] = "vehicle", [PLOT_FLIGHT] = "flight"};

void plot_write_marks(FILE *json, const plot_marks *marks)
{
    fputc('[', json);
    for (size_t i = 0; i < marks->count; i++) {
        const plot_mark *mark = &marks->mark[i];
        fputs(i ? ",{\"name\":" : "{\"name\":", json);
        json_write_text(json, mark->name);
        fprintf(json, ",\"t\":%.17g,\"rank\":%d,\"rocket\":%d,\"figures\":[", mark->t, mark->rank,
                mark->rocket);
        const char *before = "";
        for (int k = PLOT_LAUNCH; k <= PLOT_FLIGHT; k++)
            if (mark->figures >> k & 1) {
                fprintf(json, "%s\"%s\"", before, time[k]);
                before = ",";
            }
        fputs("]}", json);
    }
    fputc(']', json);
}

void plot_write_json(FILE *json)
{
    const plot_figure *figure;
    for (size_t f = 0; (figure = plot_figure_at(f)) != NULL; f++) {
        fprintf(json, "%s\n{\"name\":\"%s\",\"title\":", f ? "," : "[", figure->about.name);
        json_write_text(json, figure->about.description);
        fprintf(json, ",\"time\":\"%s\",\"open\":%d,\"panels\":[", time[figure->time],
                figure->open);
        for (int i = 0; i < PLOT_PANELS && figure->panel[i].title; i++) {
            fputs(i ? "," : "", json);
            write_panel(json, &figure->panel[i]);
        }
        fputs("]}", json);
    }
    fputs("]", json);
}
