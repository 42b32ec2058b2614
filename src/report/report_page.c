// The page of a report: what it shows as JSON, and the page around that.
#include "base/memory_stream.h"
#include "launchdyn/scenario.h"
#include "launchdyn/version.h"
#include "report/report_origin.h"
#include "report/report_parts.h"
#include "results/json_text.h"

#include <stdlib.h>

static void write_rockets(FILE *json, const history_data *history)
{
    for (int i = 0; i < history->rockets; i++) {
        const history_data *rocket = &history->rocket[i];
        const double instant[] = {rocket->t_ignition, rocket->t_release, rocket->t_front,
                                  rocket->t_middle, rocket->t_rear};
        static const char *const name[] = {"ignition", "release", "front", "middle", "rear"};
        fprintf(json, "%s{\"tube\":%d", i ? "," : "", rocket->tube);
        for (int j = 0; j < 5; j++) {
            fprintf(json, ",\"%s\":", name[j]);
            json_write_number(json, instant[j]);
        }
        fputc('}', json);
    }
}

// The launcher's table and those of the flights; a flight alone has one only.
static ld_status write_tables(FILE *json, const report_source *source, const report_detail *detail,
                              ld_error *error)
{
    const history_data *history = &source->history;
    bool launcher = history->columns > 0;
    ld_status status = LD_OK;
    if (launcher)
        status = report_write_table(json, history, 0, detail, error);
    for (size_t i = 0; i < history->flights && !status && !report_is_flight(history); i++) {
        fputs(launcher || i > 0 ? "," : "", json);
        status =
            report_write_table(json, &history->flight[i], history->flight[i].number, detail, error);
    }
    return status;
}

static const char *title_of(const report_source *source)
{
    const char *title = source->history.title;
    return title && *title ? title : "A run of launchdyn";
}

// Warnings on what the folder holds, then those on its scenario, as `check` prints them.
static void write_notes(FILE *json, const report_source *source)
{
    const ld_origin *origin = &source->origin;
    ld_messages of_scenario = {0};
    char text[512];
    int count = source->report->note_count;
    for (int i = 0; i < count; i++) {
        fputs(i ? "," : "", json);
        json_write_text(json, source->report->note[i]);
    }
    if (source->has_origin && origin->source &&
        !ld_scenario_notes(origin->source, origin->point, origin->point, &of_scenario))
        for (size_t i = 0; i < of_scenario.count; i++) {
            const ld_message *note = &of_scenario.item[i];
            snprintf(text, sizeof text, "%s: %s", note->path, note->text);
            fputs(count++ ? "," : "", json);
            json_write_text(json, text);
        }
    ld_messages_free(&of_scenario);
}

ld_status report_write_run(FILE *json, const report_source *source, const report_detail *detail,
                           ld_error *error)
{
    fputs("\"title\":", json);
    json_write_text(json, title_of(source));
    fprintf(json,
            ",\"version\":\"%s\",\"pixels\":%.17g,\"overAll\":%d,\"history\":%d,\"complete\":%d",
            LD_VERSION, detail->whole ? 0 : detail->pixel * 4000, detail->over_all,
            source->has_history, source->history.complete);
    fputs(",\"stopped\":", json);
    json_write_text(json, source->history.stopped ? source->history.stopped : "");
    fputs(",\"notes\":[", json);
    write_notes(json, source);
    fputs("],\"rockets\":[", json);
    write_rockets(json, &source->history);
    fputs("],\"tables\":[", json);
    ld_status status = write_tables(json, source, detail, error);
    fputc(']', json);
    return status;
}

ld_status report_write_data(FILE *json, const report_source *source, const report_detail *detail,
                            ld_error *error)
{
    fputc('{', json);
    ld_status status = report_write_run(json, source, detail, error);
    fputs(",\"geometry\":", json);
    report_write_geometry(json, &source->history);
    fputs(",\"compared\":", json);
    report_write_compared(json, source);
    fputs(",\"figures\":", json);
    plot_write_json(json);
    fputc('}', json);
    return status;
}

// The replay's script, where there is something to replay: as data, which the page's script
// unpacks.
static ld_status write_replay(FILE *page, const report_source *source, ld_error *error)
{
    if (!report_has_replay(&source->history) && !report_is_flight(&source->history))
        return LD_OK;
    fputs("<script type=\"text/plain\" id=\"replay\">", page);
    ld_status status = report_write_bytes(page, replay_script, replay_script_size, error);
    fputs("</script>\n", page);
    return status;
}

ld_status report_write_run_origin(FILE *page, const char *name, const report_source *source,
                                  size_t room, ld_error *error)
{
    char *json = NULL;
    size_t length = 0;
    if (!source->has_origin)
        return LD_OK;
    FILE *stream = memory_stream(&json, &length);
    if (stream)
        report_write_origin(stream, &source->origin, room);
    if (!stream || fclose(stream) != 0)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the report");
    report_write_json(page, name, json, length);
    free(json);
    return LD_OK;
}

ld_status report_write_page(FILE *page, const report_source *source, const char *data,
                            size_t length, ld_error *error)
{
    report_begin_page(page, &run_bundle, title_of(source),
                      "This report draws its plots with JavaScript; summary.json and history.h5 "
                      "have the same numbers.");
    if (source->summary)
        report_write_json(page, "summary", source->summary, source->summary_length);
    report_write_json(page, "data", data, length);
    ld_status status = report_write_run_origin(page, "origin", source, REPORT_ORIGIN_BYTES, error);
    if (!status)
        status = write_replay(page, source, error);
    report_end_page(page, &run_bundle);
    return status;
}
