#include "report/report_html.h"

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <string.h>

#include "base/part_file.h"

// Text between tags.
static void write_text(FILE *page, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '<':
            fputs("&lt;", page);
            break;
        case '>':
            fputs("&gt;", page);
            break;
        case '&':
            fputs("&amp;", page);
            break;
        default:
            fputc(*text, page);
        }
}

void report_begin_page(FILE *page, const report_bundle *bundle, const char *title,
                       const char *without_script)
{
    fputs("<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"",
          page);
    fwrite(bundle->policy, 1, bundle->policy_size, page);
    fputs("\">\n<meta name=\"viewport\" content=\"width=device-width\">\n<title>", page);
    write_text(page, title);
    fputs("</title>\n<style>", page);
    fwrite(bundle->style, 1, bundle->style_size, page);
    fprintf(page, "</style>\n<main id=\"report\"><noscript>%s</noscript></main>\n", without_script);
}

// JSON that no text in it can end: '<' stands in its strings only, and may be escaped there.
void report_write_json(FILE *page, const char *name, const char *json, size_t length)
{
    fprintf(page, "<script type=\"application/json\" id=\"%s\">", name);
    const char *end = json + length;
    while (json < end) {
        const char *tag = memchr(json, '<', (size_t)(end - json));
        size_t plain = (size_t)((tag ? tag : end) - json);
        fwrite(json, 1, plain, page);
        if (tag)
            fputs("\\u003c", page);
        json += plain + (tag != NULL);
    }
    fputs("</script>\n", page);
}

void report_end_page(FILE *page, const report_bundle *bundle)
{
    fputs("<script>", page);
    fwrite(bundle->script, 1, bundle->script_size, page);
    fputs("</script>\n</html>\n", page);
}

static ld_status write_whole(const part_file *part, const char *text, size_t length,
                             ld_error *error)
{
    FILE *stream = fopen(part->path, "wb");
    bool fine = stream && fwrite(text, 1, length, stream) == length;
    int number = errno;
    if (stream && fclose(stream) != 0 && fine) {
        number = errno;
        fine = false;
    }
    return fine ? LD_OK : part_file_failed(part, number, error);
}

ld_status report_write_file(const char *file, const char *text, size_t length, ld_error *error)
{
    part_file part;
    ld_status status = part_file_begin(&part, file, error);
    if (status)
        return status;
    status = write_whole(&part, text, length, error);
    return part_file_end(&part, status, error);
}

void report_folder_name(const char *folder, char *name, size_t size)
{
    size_t end = strlen(folder);
    while (end > 1 && folder[end - 1] == '/')
        end--;
    size_t from = end;
    while (from > 0 && folder[from - 1] != '/')
        from--;
    snprintf(name, size, "%.*s", (int)(end - from), folder + from);
}

void report_take_note(ld_report *report, const char *format, ...)
{
    va_list arguments;
    if (report->note_count == LD_REPORT_NOTES)
        return;
    va_start(arguments, format);
    vsnprintf(report->note[report->note_count++], sizeof *report->note, format, arguments);
    va_end(arguments);
}
