// A summary.json of any bytes is whole, of an earlier version or damaged, and what it leaves to be
// shown is JSON. The first byte says what follows: '0', the file; '1', its text before its digest,
// which is put to it; '2', changes of a true one under a right digest, a line each: a path of JSON
// and its new value, or none, where it goes; '3', the same without a digest.
#include <inttypes.h>
#include <sqlite3.h>
#include <stdint.h>

#include "fuzz/must_say.h"
#include "fuzz/small_run.h"
#include "report/report.c"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { LINE = 400, MOST_CHANGES = 16 };

static sqlite3 *json;
static char *template; // a JSON object without "digest"

// What a query says of a text and two more, to be freed; NULL where it fails or says nothing.
static char *ask_json(const char *query, const char *text, const char *second, const char *third)
{
    sqlite3_stmt *row = NULL;
    char *answer = NULL;
    must(sqlite3_prepare_v2(json, query, -1, &row, NULL) == SQLITE_OK);
    sqlite3_bind_text(row, 1, text, -1, SQLITE_STATIC);
    sqlite3_bind_text(row, 2, second, -1, SQLITE_STATIC);
    sqlite3_bind_text(row, 3, third, -1, SQLITE_STATIC);
    if (sqlite3_step(row) == SQLITE_ROW && sqlite3_column_type(row, 0) != SQLITE_NULL)
        answer = strdup((const char *)sqlite3_column_text(row, 0));
    sqlite3_finalize(row);
    return answer;
}

static void forget(void)
{
    sqlite3_close(json);
    free(template);
}

// The folder holds a small file, which the summary names, beside it, so that an input is quick.
static void make_once(void)
{
    size_t size;
    char digest[24];
    manifest_file rows;
    ld_error error;
    if (template)
        return;
    must(sqlite3_open(":memory:", &json) == SQLITE_OK);
    write_small_run();
    char *text = (char *)read_in_memory("run/summary.json", &size);
    text[size] = '\0';
    remove(in_memory("run/history.h5"));
    write_in_memory("run/history.csv", "t [s]\n", 6);
    must(manifest_measure(in_memory("run/history.csv"), &rows, &error) == LD_OK);
    snprintf(digest, sizeof digest, "%016" PRIx64, rows.digest);
    template = ask_json("SELECT json_set(json_remove(?1, '$.digest'), '$.files', json_array("
                        "json_object('name', ?2, 'size', 6, 'digest', ?3)))",
                        text, "history.csv", digest);
    must(template != NULL);
    free(text);
    atexit(forget);
}

// ---- changes

static char *change(char *text, char *line)
{
    char *value = strchr(line, ' ');
    if (value)
        *value++ = '\0';
    char *changed = value ? ask_json("SELECT json_set(?1, ?2, json(?3))", text, line, value)
                          : ask_json("SELECT json_remove(?1, ?2)", text, line, NULL);
    if (!changed)
        return text;
    free(text);
    return changed;
}

// The true text, changed, to be freed.
static char *change_all(const uint8_t *data, size_t size)
{
    char line[LINE], *text = strdup(template);
    must(text != NULL);
    for (size_t i = 0, length = 0, lines = 0; i < size && lines < MOST_CHANGES; i++) {
        bool ends = data[i] == '\n' || length == LINE - 1;
        line[length] = ends ? '\0' : (char)data[i];
        length = ends ? 0 : length + 1;
        if (ends)
            text = change(text, line);
        lines += ends;
    }
    return text;
}

static void write_changed(const uint8_t *data, size_t size, bool sealed)
{
    char *text = change_all(data, size);
    size_t length = strlen(text);
    FILE *file = fopen(in_memory("run/summary.json"), "wb");
    must(file != NULL);
    if (sealed && text[length - 1] == '}') { // its last member follows
        text[length - 1] = ',';
        manifest_seal(file, text, length);
    } else {
        fputs(text, file);
    }
    must(fclose(file) == 0);
    free(text);
}

static void write_sealed(const uint8_t *data, size_t size)
{
    FILE *file = fopen(in_memory("run/summary.json"), "wb");
    must(file != NULL);
    manifest_seal(file, (const char *)data, size);
    must(fclose(file) == 0);
}

// ---- reading

// Returns what it is found to be.
static manifest_state judge_folder(const char *folder)
{
    manifest found;
    ld_error error = {0};
    char doubt[256];
    must(manifest_read(folder, &found, &error) == LD_OK);
    must(found.state != MANIFEST_NONE);
    must((found.state == MANIFEST_DAMAGED) == (found.text == NULL));
    must((found.state == MANIFEST_DAMAGED) == (found.problem[0] != '\0'));
    must((found.state == MANIFEST_WHOLE) == (manifest_doubt(&found) == NULL));
    for (int i = 0; i < MANIFEST_FILES; i++)
        must_say(manifest_check(&found, folder, i, &error), &error);
    manifest_free(&found);
    must_say(manifest_check_history(folder, doubt, sizeof doubt, &error), &error);
    return found.state;
}

// What the page is to hold of it is JSON, whatever was read.
static void show(const char *folder)
{
    ld_report report = {0};
    ld_error error = {0};
    report_source *source = calloc(1, sizeof *source);
    must(source != NULL);
    source->report = &report;
    must_say(report_read_folder(source, folder, &error), &error);
    if (source->summary) {
        char *valid = ask_json("SELECT json_valid(?1)", source->summary, NULL, NULL);
        must(valid && valid[0] == '1' && source->summary_length == strlen(source->summary));
        free(valid);
    }
    report_free_source(source);
    free(source);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 1)
        return 0;
    make_once();
    if (data[0] == '0')
        write_in_memory("run/summary.json", data + 1, size - 1);
    else if (data[0] == '1')
        write_sealed(data + 1, size - 1);
    else
        write_changed(data + 1, size - 1, data[0] == '2');
    manifest_state state = judge_folder(in_memory("run"));
    must(data[0] != '3' || state != MANIFEST_WHOLE);
    show(in_memory("run"));
    return 0;
}
