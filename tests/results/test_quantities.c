// A quantity is written once: each of a summary, given a value of its own, is found under its name
// in summary.json and in the table after a run; docs/quantities.md says what the tables say; the
// report names nothing that is not there.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "base/text_file.h"
#include "flight/flight_history.h"
#include "flight/free_flight.h"
#include "launchdyn/output.h"
#include "quantities/study_results.h"
#include "run/vehicle_run.h"
#include "state/history.h"
#include "state/simulation.h"
#include "support/markdown.h"
#include "support/reference_model.h"
#include "support/scratch.h"

// ---- a value of its own

typedef struct made_run {
    ld_model model;
    ld_summary summary;
    quantity_things things;
} made_run;

static made_run made;

static void put(const quantity_walk *at, double value, void *in_struct)
{
    const quantity_place *place = &at->row->at;
    char *to = (char *)in_struct + place->offset + (size_t)at->item * place->stride;
    if (place->type == QUANTITY_NUMBER)
        memcpy(to, &value, sizeof value);
    else if (place->type == QUANTITY_INT64)
        memcpy(to, &(int64_t){(int64_t)value}, sizeof(int64_t));
    else
        memcpy(to, &(int){(int)value}, sizeof(int));
}

// Number `index` of the table's quantities, from its beginning.
static double value_of(const quantity_table *table, int index)
{
    return (table == &rocket_quantities ? 1001 : table == &run_quantities ? 2001 : 3001) + index;
}

static void fill(const quantity_table *table, void *in_struct)
{
    int index = 0;
    for (quantity_walk at = quantity_first(table, &made.things); at.row; quantity_next(&at))
        put(&at, value_of(table, index++), in_struct);
}

static int set_up(void **state)
{
    reference_vehicle(&made.model, 5);
    static const char *const parachutes[] = {"drogue", "main"};
    made.model.rocket.parachute_count = 2;
    for (int i = 0; i < 2; i++) {
        ld_parachute *one = &made.model.rocket.parachute[i];
        snprintf(one->name, sizeof one->name, "%s", parachutes[i]);
        one->canopy.present = true;
    }
    made.things = quantity_things_of(&made.model);
    made.summary.rocket_count = 1;
    made.summary.rocket[0].flown = made.summary.rocket[0].final.earth = true;
    made.summary.equilibrium.wheel_count = made.model.base.vehicle.wheel_count;
    made.summary.complete = true;
    fill(&rocket_quantities, &made.summary.rocket[0]);
    fill(&run_quantities, &made.summary);
    fill(&cost_quantities, &made.summary);
    return scratch_make(state);
}

static int tear_down(void **state)
{
    reference_model_free(&made.model);
    return scratch_remove(state);
}

// ---- summary.json

// "key.key value" of each number, a line each; of lists the index.
static char *numbers_of(const char *file)
{
    char command[512], *text = calloc(1, 1 << 17);
    snprintf(command, sizeof command,
             "jq -r 'paths(type == \"number\") as $p |"
             " \"=\\($p | map(tostring) | join(\".\")) \\(getpath($p))\"' %s",
             file);
    FILE *list = popen(command, "r");
    assert_non_null(list);
    text[fread(text, 1, (1 << 17) - 1, list)] = 0;
    assert_int_equal(pclose(list), 0);
    return text;
}

// Where the quantity stands there: lists by index, the things of a list by their own.
static void path_of(const quantity_walk *at, int in_list, char *path, size_t size)
{
    char text[QUANTITY_NAME];
    const char *pattern = at->row->json ? at->row->json : at->row->name;
    const char *item = strstr(pattern, "[].%s"), *end = strstr(pattern, "[]");
    if (item) {
        end = strstr(item + 5, "[]");
        snprintf(path, size, "%.*s.%d%.*s", (int)(item - pattern), pattern, at->item,
                 end ? (int)(end - item - 5) : (int)strlen(item + 5), item + 5);
    } else {
        quantity_text(pattern, at->group->each, at->item, at->things, text, sizeof text);
        snprintf(path, size, "%.*s", (int)strcspn(text, "["), text);
    }
    if (end)
        snprintf(path + strlen(path), size - strlen(path), ".%d", in_list);
}

static void look_in_json(const quantity_table *table, const char *prefix, const char *text)
{
    int index = 0, in_list = 0;
    const char *before = NULL;
    for (quantity_walk at = quantity_first(table, &made.things); at.row; quantity_next(&at)) {
        char path[2 * QUANTITY_NAME], line[2 * QUANTITY_NAME + 64];
        in_list = before && at.row->json && strcmp(before, at.row->json) == 0 ? in_list + 1 : 0;
        before = at.row->json;
        path_of(&at, in_list, path, sizeof path);
        snprintf(line, sizeof line, "=%s%s %.0f\n", prefix, path, value_of(table, index++));
        if (!strstr(text, line))
            fail_msg("summary.json has no %s", line);
    }
    printf("    %d numbers of summary.json\n", index);
}

static void test_summary_json(void **state)
{
    (void)state;
    ld_error error;
    if (ld_summary_write(in("summary.json"), &made.model, &made.summary, &error))
        fail_msg("%s", error.text);
    char *text = numbers_of(in("summary.json"));
    look_in_json(&rocket_quantities, "rockets.0.", text);
    look_in_json(&run_quantities, "", text);
    look_in_json(&cost_quantities, "", text);
    free(text);
}

// ---- the table after a run

static int look_in_table(const quantity_table *table, const char *text)
{
    const char *number = "";
    int index = 0, lines = 0;
    for (quantity_walk at = quantity_first(table, &made.things); at.row; quantity_next(&at)) {
        const quantity_line *line = &at.row->line;
        double value = value_of(table, index++);
        char label[QUANTITY_TEXT], start[QUANTITY_TEXT + 8];
        if (line->label) {
            quantity_text(line->label, at.group->each, at.item, &made.things, label, sizeof label);
            snprintf(start, sizeof start, "\n  %-22s ", label);
            number = strstr(text, start);
            if (!number)
                fail_msg("the table after a run has no line \"%s\"", label);
            number += strlen(start);
            lines++;
        } else if (!line->beside) {
            continue;
        }
        char *end;
        double shown = strtod(number, &end);
        if (fabs(shown - value * line->factor) > 1e-5 * fabs(shown))
            fail_msg("%s: %.9g in the table, not %.9g", at.row->name, shown, value * line->factor);
        number = end;
    }
    return lines;
}

static void test_table(void **state)
{
    (void)state;
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    ld_summary_print(&made.model, &made.summary, stream);
    fclose(stream);
    int lines = look_in_table(&rocket_quantities, text) + look_in_table(&run_quantities, text);
    printf("    %d lines of the table after a run\n", lines);
    assert_true(lines > 50);
    free(text);
}

// ---- names

// No name stands twice in a table, and each finds its own number.
static void test_names(void **state)
{
    (void)state;
    const quantity_table *tables[] = {&rocket_quantities, &run_quantities, &cost_quantities};
    for (int i = 0; i < 3; i++) {
        void *from = i ? (void *)&made.summary : (void *)&made.summary.rocket[0];
        int index = 0;
        for (quantity_walk at = quantity_first(tables[i], &made.things); at.row;
             quantity_next(&at)) {
            char name[QUANTITY_NAME];
            quantity_text(at.row->name, at.group->each, at.item, &made.things, name, sizeof name);
            quantity_walk found = quantity_find(tables[i], &made.things, name);
            assert_ptr_equal(found.row, at.row);
            assert_ptr_equal(quantity_like(tables[i], name), at.row);
            assert_true(quantity_value(&found, from) == value_of(tables[i], index++));
        }
    }
    assert_null(quantity_find(&run_quantities, &made.things, "energy.work").row);
    assert_null(study_result_like("relative.psi"));
    for (int i = 0; i < STUDY_PAIRS; i++)
        for (int k = 0; k < 2; k++)
            assert_string_equal(study_result_like(study_pairs[i].name[k])->unit,
                                study_pairs[i].unit);
}

// Every key that the report's lists begin with, `["key", "label", ...`, is a number of a summary.
static void look_in_script(const char *file)
{
    char *text = NULL, path[256];
    size_t length;
    int keys = 0;
    snprintf(path, sizeof path, LD_SOURCE_DIR "/assets/report/%s", file);
    assert_int_equal(text_file_read(path, 1 << 20, &text, &length, NULL), 0);
    for (char *at = text; (at = strstr(at, "\n  [\"")) != NULL;) {
        char *key = at + 5, *end = strchr(key, '"'), name[160];
        at = end;
        if (end[2] != ' ' || end[3] != '"')
            continue;
        bool several = end[-1] == '*';
        *end = 0;
        const char *const before[] = {"", "equilibrium.", "energy.", "statistics."};
        bool there = false;
        for (int i = 0; i < 4 && !there; i++) {
            snprintf(name, sizeof name, "%s%.*s%s", before[i], (int)(end - key) - several, key,
                     several ? (strcmp(key, "work.*") == 0 ? "thrust" : "rear") : "");
            const char *short_name = strncmp(name, "flight.", 7) == 0 ? name + 7 : name;
            there = quantity_like(&rocket_quantities, short_name) ||
                    quantity_like(&run_quantities, name) || quantity_like(&cost_quantities, name);
        }
        if (!there)
            fail_msg("%s: no quantity is called %s", file, key);
        keys++;
        *end = '"';
    }
    printf("    %d keys in %s\n", keys, file);
    assert_true(keys >= 10);
    free(text);
}

static void test_report(void **state)
{
    (void)state;
    look_in_script("results.js");
    look_in_script("study_results.js");
    look_in_script("summary.js");
}

// ---- docs/quantities.md

static void write_names(FILE *stream, const quantity *row, int count)
{
    for (int i = 0; i < count; i++) {
        const char *mark = strstr(row[i].name, "%s");
        fputs(i ? ", `" : "- `", stream);
        if (mark)
            fprintf(stream, "%.*sNAME%s`", (int)(mark - row[i].name), row[i].name, mark + 2);
        else
            fprintf(stream, "%s`", row[i].name);
    }
}

// Neighbours that are the same but for their names share a line.
static bool are_alike(const quantity *a, const quantity *b)
{
    bool same_json = a->json && b->json ? strcmp(a->json, b->json) == 0 : !a->json && !b->json;
    return same_json && a->unit && b->unit && strcmp(a->unit, b->unit) == 0 &&
           a->studied == b->studied && strcmp(a->description, b->description) == 0;
}

// The description without "adaptor %s: ", which its name says; where it is inside, NAME.
static void write_description(FILE *stream, const char *text)
{
    const char *mark = strstr(text, "%s"), *colon = mark ? strstr(mark, ": ") : NULL;
    if (colon)
        fputs(colon + 2, stream);
    else if (mark)
        fprintf(stream, "%.*sNAME%s", (int)(mark - text), text, mark + 2);
    else
        fputs(text, stream);
}

// " (`path`)", where it is not the name.
static void write_path(FILE *stream, const char *path)
{
    const char *mark = path ? strstr(path, ".%s") : NULL;
    if (mark)
        fprintf(stream, " (`%.*s%s`)", (int)(mark - path), path, mark + 3);
    else if (path)
        fprintf(stream, " (`%s`)", path);
}

static void write_row(FILE *stream, const quantity *row, int count)
{
    write_names(stream, row, count);
    if (!row->unit || (*row->unit && strcmp(row->unit, "1") != 0))
        fprintf(stream, " [%s]", row->unit ? row->unit : "its own");
    fprintf(stream, "%s: ", row->studied ? "\\*" : "");
    write_description(stream, row->description);
    write_path(stream, row->json);
    fputc('\n', stream);
}

// ---- what stands there already

static const quantity *written[1024];
static int written_count;

// What a row's description is referred to: NULL where no row before has it, else the part of that
// row's name before this one's, "energy." or "".
static const char *same_before(const quantity *row)
{
    for (int i = 0; i < written_count; i++) {
        const char *name = written[i]->name;
        bool prefixed = strncmp(name, "energy.", 7) == 0 && strcmp(name + 7, row->name) == 0;
        if (row->unit && written[i]->unit && strcmp(row->unit, written[i]->unit) == 0 &&
            strcmp(row->description, written[i]->description) == 0 &&
            (prefixed || strcmp(name, row->name) == 0))
            return prefixed ? "energy." : "";
    }
    return NULL;
}

// How many rows from the first on have their descriptions above, in rows of names alike.
static int count_repeated(const quantity *row, int count, const char **before)
{
    int repeated = 0;
    *before = same_before(row);
    for (const char *next = *before; next && strcmp(next, *before) == 0;
         next = repeated < count ? same_before(&row[repeated]) : NULL)
        repeated++;
    return repeated;
}

// Rows from the first on that one line has: those described above, or those that are alike.
static int write_line(FILE *stream, const quantity *row, int count)
{
    const char *before;
    int rows = count_repeated(row, count, &before);
    if (rows > 1 || (rows == 1 && *before)) {
        write_names(stream, row, rows);
        fprintf(stream, *before ? ": as `%s*` above\n" : ": as above\n", before);
        return rows;
    }
    for (rows = 1; rows < count && are_alike(row, &row[rows]); rows++)
        ;
    write_row(stream, row, rows);
    return rows;
}

// Whether all of a group stands above as `energy.NAME`.
static bool is_energy(const quantity_group *group)
{
    const char *before;
    return count_repeated(group->row, group->rows, &before) == group->rows && *before;
}

static void write_group(FILE *stream, const quantity_group *group)
{
    fprintf(stream, "\n**%c%s**\n\n", group->title[0] - 'a' + 'A', group->title + 1);
    for (int k = 0; k < group->rows;)
        k += write_line(stream, &group->row[k], group->rows - k);
    for (int k = 0; k < group->rows; k++)
        written[written_count++] = &group->row[k];
}

// heading NULL: it continues under the one before. Works that stand above have one line together.
static void write_table(FILE *stream, const char *heading, const quantity_table *table)
{
    static bool works;
    if (heading)
        fprintf(stream, "\n## %s\n", heading);
    works &= !heading;
    for (int i = 0; i < table->groups; i++)
        if (!is_energy(&table->group[i]))
            write_group(stream, &table->group[i]);
        else if (!works) {
            fputs("\n**Works since the start**\n\n- `work.NAME`: as `energy.work.NAME` above\n",
                  stream);
            works = true;
        }
}

static void write_document(FILE *stream)
{
    fputs(
        "# Quantities\n\n"
        "Which numbers and columns does a run give? These lists are generated from the program's "
        "tables (`ctest -R results.quantities`). Values are in SI and radians; a unit in brackets "
        "is left out where there is none.\n\n"
        "- Frames ([model.md](model.md)): I inertial, T the undeformed tube on its base "
        "([results.md](results.md#against-the-launcher)), R the floating frame of the tube, S its "
        "section at the rear adaptor, B the rocket.\n"
        "- NAME is an adaptor or shoe, wheel, hinge (`azimuth`, `elevation`), a part of a "
        "multibody "
        "base, parachute, modal coordinate or [measure](scenario.md#measures), or the number of a "
        "station, support, slide or "
        "place of a line.\n"
        "- Instants count from the rocket's ignition unless stated; what did not happen is `null` "
        "or NaN.\n"
        "- In `summary.json` a quantity has its own name, or the path in brackets. Studies keep "
        "those with \\* ([study.md](study.md)).\n",
        stream);
    write_table(stream, "Of a rocket (`rockets` of summary.json)", &rocket_quantities);
    write_table(stream, "Of the run", &run_quantities);
    write_table(stream, "Of its computation", &cost_quantities);
    write_table(stream, "Of a natural mode (`modes` of summary.json)", &mode_quantities);
    write_table(stream, "Columns of a launch", &launch_quantities);
    write_table(stream, NULL, base_vehicle.quantities);
    write_table(stream, NULL, base_fmu.quantities);
    write_table(stream, NULL, base_multibody.quantities);
    write_table(stream, NULL, &balance_quantities);
    write_table(stream, "Columns of a flight", &flight_quantities);
    write_table(stream, "Columns of a vehicle alone", &vehicle_clock_quantities);
    fputs("\nThen chassis, hinges, drive and wheels as of a launch.\n", stream);
    write_table(stream, NULL, &vehicle_balance_quantities);
}

static void test_document(void **state)
{
    (void)state;
    written_count = 0;
    char *text = markdown_wrapped(write_document), *kept = NULL;
    size_t length = strlen(text), kept_length = 0;
    text_file_read(LD_SOURCE_DIR "/docs/quantities.md", 1 << 20, &kept, &kept_length, NULL);
    if (!kept || kept_length != length || memcmp(kept, text, length) != 0) {
        FILE *file = fopen(LD_BINARY_DIR "/quantities.md", "w");
        assert_non_null(file);
        fputs(text, file);
        fclose(file);
        fail_msg("docs/quantities.md is not what the tables say: that is %s",
                 LD_BINARY_DIR "/quantities.md");
    }
    printf("    %zu bytes\n", length);
    free(text);
    free(kept);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_summary_json), cmocka_unit_test(test_table),
        cmocka_unit_test(test_names),        cmocka_unit_test(test_report),
        cmocka_unit_test(test_document),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
