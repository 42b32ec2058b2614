// What the reports share: a page with its style, script and data in one file, written as a whole.
#ifndef LD_REPORT_REPORT_HTML_H
#define LD_REPORT_REPORT_HTML_H

#include <stddef.h>
#include <stdio.h>

#include "launchdyn/report.h"
#include "launchdyn/status.h"

// Data that grow beyond the bytes that a report may have are given up on the way.
enum { REPORT_PATH_SIZE = 4096, REPORT_BYTES = 2000000 };

// What assets/bundle holds for one kind of page, built in.
typedef struct report_bundle {
    const unsigned char *script, *style, *policy;
    size_t script_size, style_size, policy_size;
} report_bundle;

extern const report_bundle run_bundle, runs_bundle, study_bundle;
extern const report_bundle page_bundle; // of the page that simulates, beside the script of a run

// The script of the replay, which the script of a run's report unpacks and starts.
extern const unsigned char replay_script[];
extern const size_t replay_script_size;

// A page from its head to where the data begin; `without_script` is what it says where no script
// may run.
void report_begin_page(FILE *page, const report_bundle *bundle, const char *title,
                       const char *without_script);
// Data that the script finds by their name.
void report_write_json(FILE *page, const char *name, const char *json, size_t length);
void report_end_page(FILE *page, const report_bundle *bundle);

// Writes the text under a temporary name beside the file, which then gets its own.
ld_status report_write_file(const char *file, const char *text, size_t length, ld_error *error);

// The last part of a folder's path.
void report_folder_name(const char *folder, char *name, size_t size);

// Keeps a sentence about what is missing or broken, up to LD_REPORT_NOTES of them.
void report_take_note(ld_report *report, const char *format, ...) LD_PRINTF(2, 3);

#endif
