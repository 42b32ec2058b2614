// The page that simulates: what its worker calls, from JavaScript. One run at a time; texts and
// columns are those of the last one.
#ifndef LD_PAGE_PAGE_H
#define LD_PAGE_PAGE_H

// What came of the last call, as text.
typedef enum page_text_kind {
    PAGE_MESSAGES, // errors and warnings, as the command prints them
    PAGE_SCENARIO, // the scenario as it was understood, in SI, which can be read again
    PAGE_SUMMARY,  // what summary.json has
    PAGE_DATA,     // what the report's scripts show, JSON
    PAGE_VALUES,   // of the keys that page_values() was asked for, a line each
    PAGE_TEXTS
} page_text_kind;

// Runs a scenario with overrides, "path=value", a line each (changed meanwhile). Files that it
// names are looked for at "/". An ld_status; of LD_ERR_LAUNCH and LD_ERR_NUMERIC there are results
// up to the end of the run.
int page_run(const char *scenario, char *sets);

// Reads a scenario, and values of its keys ("61 kg"; empty: not given, or more than a line) by
// `paths`, a line each.
int page_values(const char *scenario, char *sets, const char *paths);

// Valid until the next call that writes it; "": there is none.
const char *page_text(page_text_kind kind);

// Writes the columns of the launcher (rocket 0) or of a rocket's flight as history.csv and
// flights.csv have them, but for the rocket's number. LD_ERR_INPUT: there are none.
int page_write_csv(int rocket, const char *path);

#endif
