#include "report/report_origin.h"

#include <string.h>

#include "model/fields/source.h"
#include "results/json_text.h"

// A text, where there is room for it.
static void write_fitting(FILE *json, const char *text, size_t *room)
{
    size_t length = strlen(text);
    if (length > *room) {
        fputs("null", json);
        return;
    }
    *room -= length;
    json_write_text(json, text);
}

static void write_source(FILE *json, const ld_origin *origin, size_t *room)
{
    const ld_source *source = origin->source;
    fputs(",\"files\":[", json);
    for (size_t i = 0; source && i < source->file_count; i++) {
        fputs(i ? ",\n[" : "[", json);
        json_write_text(json, source->file[i]->name);
        fputc(',', json);
        write_fitting(json, source->file[i]->text, room);
        fputc(']', json);
    }
    fputs("],\"set\":[", json);
    for (size_t i = 0; source && i < source->set_count; i++) {
        fputs(i ? "," : "", json);
        write_fitting(json, source->set[i], room);
    }
    fprintf(json, "],\"point\":%d,\"sample\":%d", origin->point, origin->sample);
}

void report_write_origin(FILE *json, const ld_origin *origin, size_t room)
{
    fputs("{\"program\":[", json);
    for (size_t i = 0; i < origin->fact_count; i++) {
        fputs(i ? ",[" : "[", json);
        json_write_text(json, origin->fact[i].name);
        fputc(',', json);
        json_write_text(json, origin->fact[i].text);
        fputc(']', json);
    }
    fputs("],\"scenario\":", json);
    write_fitting(json, origin->scenario, &room);
    write_source(json, origin, &room);
    fputc('}', json);
}
