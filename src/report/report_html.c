#include "report/report_html.h"

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <string.h>
#include <unistd.h>

#include "base/child.h"
#include "base/text_file.h"

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

ld_status report_write_file(const char *file, const char *text, size_t length, ld_error *error)
{
    char part[REPORT_PATH_SIZE + 8];
    bool replaced = text_file_is_replaced(file);
    snprintf(part, sizeof part, "%s%s", file, replaced ? ".part" : "");
    if (replaced)
        child_writes(part);
    FILE *stream = fopen(part, "wb");
    bool fine = stream && fwrite(text, 1, length, stream) == length;
    int number = errno;
    if (stream && fclose(stream) != 0) {
        number = errno;
        fine = false;
    }
    if (fine && replaced && rename(part, file) != 0) {
        number = errno;
        fine = false;
    }
    if (!fine && stream && replaced)
        unlink(part);
    child_wrote(part);
    if (fine)
        return LD_OK;
    return ld_fail(error, LD_ERR_FILE, "cannot write %.400s: %s", file, strerror(number));
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
