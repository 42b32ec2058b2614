// A page of runs, as fine as a file of it may be large.
#include <locale.h>
#include <stdlib.h>

#include "base/memory_stream.h"
#include "base/numeric_locale.h"
#include "report/report_html.h"
#include "report/report_parts.h"

// The page in memory, to be freed.
static ld_status make_page(const report_page *self, const report_detail *detail, char **text,
                           size_t *length, ld_error *error)
{
    char *data = NULL;
    size_t data_length = 0;
    FILE *json = memory_stream(&data, &data_length), *page = memory_stream(text, length);
    ld_status status = json && page ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory");
    if (!status)
        status = self->write_data(json, self->self, detail, error);
    bool wrong = json && fclose(json) != 0;
    if (!status && !wrong)
        status = self->write_page(page, self->self, data, data_length, error);
    wrong |= page && fclose(page) != 0;
    free(data);
    return !status && wrong ? ld_fail(error, LD_ERR_MEMORY, "no memory for the report") : status;
}

// All rows in the tube and else those that a pixel of 4000 needs; a pixel in the tube too; a pixel
// of what curves are in all the run, not in each phase; more pixels.
static void coarsen_detail(report_detail *detail)
{
    if (detail->whole || detail->whole_tube) {
        detail->whole_tube = detail->whole;
        detail->whole = false;
    } else if (!detail->over_all) {
        detail->over_all = true;
    } else {
        detail->pixel *= 2;
    }
}

static ld_status make_page_that_fits(const report_page *self, ld_report *report, char **text,
                                     size_t *length, ld_error *error)
{
    report_detail detail = {.whole = true,
                            .whole_tube = true,
                            .pixel = 1.0 / 4000,
                            .figures_alone = self->figures_alone};
    for (;;) {
        ld_status status = make_page(self, &detail, text, length, error);
        report->pixels = detail.whole ? 0 : detail.pixel * 4000;
        if (status || *length <= REPORT_BYTES)
            return status;
        free(*text);
        *text = NULL;
        if (detail.pixel > 0.1 && self->title > REPORT_BYTES / 10)
            return ld_fail(error, LD_ERR_INPUT,
                           "the title has %zu bytes, too many for a report of %d bytes",
                           self->title, REPORT_BYTES);
        if (detail.pixel > 0.1)
            return ld_fail(error, LD_ERR_INPUT, "the results are too many for a report of %d bytes",
                           REPORT_BYTES);
        coarsen_detail(&detail);
    }
}

ld_status report_write_as_fits(const report_page *page, const char *file, ld_report *report,
                               ld_error *error)
{
    char *text = NULL;
    size_t length = 0;
    locale_t before = numeric_locale_enter();
    ld_status status = make_page_that_fits(page, report, &text, &length, error);
    numeric_locale_leave(before);
    if (!status)
        status = report_write_file(file, text, length, error);
    report->bytes = status ? 0 : length;
    free(text);
    return status;
}
