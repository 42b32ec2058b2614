// A study's database in which anything was changed is read as far as it goes, or refused with a
// sentence, by all that read it. The first byte says how the rest changes a true one: '0', as SQL;
// '1', as SQL, and the digests are written again; '2', as bytes, each at a place (3 bytes).
#include <stdint.h>

#include <sqlite3.h>

#include "fuzz/must_say.h"
#include "launchdyn/origin.h"
#include "launchdyn/report.h"
#include "studies/store/row_digest.h"
#include "studies/store/store_check.h"
#include "studies/store/study_data.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char scenario[] =
    "launchdyn: 1\ntitle: Small\nbase: {kind: fixed, elevation: 20 deg}\ntubes:\n  length: 1 m\n"
    "  sections: [{from: 0 m, inner_radius: 80 mm, outer_radius: 85 mm}]\n"
    "  material: {youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7850 kg/m3}\n"
    "  supports: [{at: 0.6 m, stiffness: 1e7 1e7 1e7 N/m,\n"
    "              rotational_stiffness: 1e6 1e6 1e6 N.m/rad}]\n"
    "  modes: {bending: 1, torsion: 0}\n  slot: none\nrocket:\n  start_at: 0.4 m\n  mass: 60 kg\n"
    "  center: 0.3 0 0 m\n  inertia: 1 24 24 kg.m2\n"
    "  empty: {mass: 40 kg, center: 0.3 0 0 m, inertia: 1 18 18 kg.m2}\n"
    "  adaptors: [{name: a, at: 0 m, clearance: 1 mm}, {name: b, at: 0.5 m, clearance: 1 mm}]\n"
    "  contact: {stiffness: 5e7 N/m}\n  lock: none\n"
    "  motor: {thrust: [[0 s, 0 N], [1 ms, 80 kN], [1 s, 80 kN], [1.1 s, 0 N]]}\n"
    "scatter:\n  samples: 4\n  factors:\n    rocket.mass_error: {normal: 0.2 kg}\n"
    "    rocket.adaptors.a.clearance: {uniform: 0.2 0.4 mm, per: sample}\n"
    "sweep: {base.elevation: [20 deg, 30 deg]}\nrun: {start: undeformed}\n";

static ld_study *study;
static uint8_t *template;
static size_t template_size;

static void make_once(void)
{
    ld_messages messages;
    ld_study_counts counts;
    ld_error error;
    if (template)
        return;
    ld_status status =
        ld_study_read_text(scenario, sizeof scenario - 1, "small", "", NULL, 0, &study, &messages);
    if (status)
        ld_messages_print(&messages, stderr);
    must(!status);
    must(!ld_study_run(study, in_memory("study"), &(ld_study_options){0}, &counts, &error));
    must(counts.done == 8);
    template = read_in_memory("study/study.db", &template_size);
}

// ---- changes

static int give_up(void *self)
{
    (void)self;
    return 1;
}

static int allow(void *self, int action, const char *a, const char *b, const char *c, const char *d)
{
    (void)self, (void)a, (void)b, (void)c, (void)d;
    return action == SQLITE_ATTACH || action == SQLITE_DETACH || action == SQLITE_PRAGMA
               ? SQLITE_DENY
               : SQLITE_OK;
}

// The digest of a sample and its rockets as they stand there.
static uint32_t digest_in(sqlite3 *database, int64_t number)
{
    static const char *const queries[] = {"SELECT * FROM rocket WHERE sample = ? ORDER BY rocket",
                                          "SELECT * FROM sample WHERE sample = ?"};
    uint32_t digest = 0;
    for (int i = 0; i < 2; i++) {
        sqlite3_stmt *row = NULL;
        sqlite3_prepare_v2(database, queries[i], -1, &row, NULL);
        sqlite3_bind_int64(row, 1, number);
        while (sqlite3_step(row) == SQLITE_ROW) // the last column of a sample is its digest
            digest = digest_columns(digest, row, 0, sqlite3_column_count(row) - i);
        sqlite3_finalize(row);
    }
    return digest;
}

// Writes the digests that belong to what stands there, as far as there is room for them.
static void seal(sqlite3 *database)
{
    study_store store = {.database = database, .lock = -1};
    sqlite3_stmt *number = NULL, *write = NULL;
    sqlite3_prepare_v2(database, "SELECT sample FROM sample", -1, &number, NULL);
    sqlite3_prepare_v2(database, "UPDATE sample SET digest = ? WHERE sample = ?", -1, &write, NULL);
    for (int i = 0; i < 1000 && write && sqlite3_step(number) == SQLITE_ROW; i++) {
        int64_t of = sqlite3_column_int64(number, 0);
        uint32_t digest = digest_in(database, of);
        store_kept_add(&store.kept, of, digest);
        sqlite3_bind_int64(write, 1, (int32_t)digest);
        sqlite3_bind_int64(write, 2, of);
        store_step(write);
    }
    sqlite3_finalize(number);
    sqlite3_finalize(write);
    store_seal(&store, NULL);
}

static void change_by_sql(const uint8_t *data, size_t size, bool sealed)
{
    sqlite3 *database = NULL;
    char *text = malloc(size + 1);
    must(text && sqlite3_open(in_memory("study/study.db"), &database) == SQLITE_OK);
    memcpy(text, data, size);
    text[size] = '\0';
    sqlite3_limit(database, SQLITE_LIMIT_LENGTH, 100000);
    sqlite3_exec(database, "PRAGMA journal_mode = DELETE; PRAGMA synchronous = 0", NULL, NULL,
                 NULL);
    sqlite3_set_authorizer(database, allow, NULL);
    sqlite3_progress_handler(database, 100000, give_up, NULL);
    sqlite3_exec(database, text, NULL, NULL, NULL);
    sqlite3_progress_handler(database, 0, NULL, NULL);
    if (sealed)
        seal(database);
    sqlite3_close(database);
    free(text);
}

static void write_changed(const uint8_t *data, size_t size, uint8_t how)
{
    uint8_t *copy = malloc(template_size);
    must(copy != NULL);
    memcpy(copy, template, template_size);
    for (; how == '2' && size >= 4; data += 4, size -= 4)
        copy[(size_t)(data[0] | data[1] << 8 | data[2] << 16) % template_size] = data[3];
    write_in_memory("study/study.db", copy, template_size);
    free(copy);
    if (how != '2')
        change_by_sql(data, size, how == '1');
}

// ---- reading

static void read_point(const study_data *data, const study_point *point)
{
    study_failure failure[4];
    study_failed failed[4];
    study_values values = {0};
    ld_error error = {0};
    int count;
    must_say(study_data_failures(data, point, failure, 4, &count, &error), &error);
    must(count >= 0 && count <= 4);
    must_say(study_data_failed(data, point, failed, 4, &count, &error), &error);
    must(count >= 0 && count <= 4);
    for (int i = 0; i < data->column_count; i++) {
        const study_column *column = &data->column[i];
        must_say(study_data_read(data, point, &column, 1, &values, &error), &error);
    }
    study_values_free(&values);
}

static void read_data(void)
{
    study_data data;
    ld_error error = {0};
    double half;
    ld_status status = study_data_open(in_memory("study"), &data, &error);
    must_say(status, &error);
    if (status)
        return;
    for (int i = 0; i < data.point_count && i < 8; i++)
        read_point(&data, &data.point[i]);
    for (int i = 0; i < data.column_count && i < 4; i++)
        must_say(study_data_half_width(&data, &data.column[i],
                                       &(ld_until){.statistic = LD_STATISTIC_MEAN}, 0, &half,
                                       &error),
                 &error);
    study_data_close(&data);
}

static bool stop(void *self)
{
    (void)self;
    return false;
}

// Continues with it, and stops before a sample runs.
static void go_on(void)
{
    ld_study_counts counts;
    ld_error error = {0};
    ld_study_options options = {.go_on = stop};
    ld_status status = ld_study_run(study, in_memory("study"), &options, &counts, &error);
    must_say(status, &error);
}

static void show(void)
{
    char *text = NULL;
    size_t length;
    ld_error error = {0};
    ld_origin origin;
    FILE *stream = open_memstream(&text, &length);
    ld_study_view view = {.what = "exit_speed"};
    must_say(ld_study_show(in_memory("study"), &view, stream, &error), &error);
    view.sensitivity = true;
    must_say(ld_study_show(in_memory("study"), &view, stream, &error), &error);
    must_say(ld_study_export(in_memory("study"), in_memory("out.csv"), in_memory("out.h5"), &error),
             &error);
    ld_status status = ld_study_read_origin(in_memory("study"), &origin, &error);
    must_say(status, &error);
    if (status == LD_OK) {
        char differs[256];
        must(!ld_origin_differs(&origin, differs, sizeof differs) || differs[0]);
        ld_origin_free(&origin);
    }
    remove(in_memory("study/shard-1-of-2.db"));
    must(rename(in_memory("study/study.db"), in_memory("study/shard-1-of-2.db")) == 0);
    must_say(ld_study_merge(in_memory("study"), stream, &error), &error);
    remove(in_memory("study/shard-1-of-2.db"));
    fclose(stream);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const beside[] = {"study/study.db", "study/study.db-wal",
                                         "study/study.db-shm", "study/study.db-journal",
                                         "study/study.pending"};
    if (size < 1 || size > 4096)
        return 0;
    make_once();
    for (size_t i = 0; i < sizeof beside / sizeof *beside; i++)
        remove(in_memory(beside[i]));
    write_changed(data + 1, size - 1, data[0]);
    read_data();
    go_on();
    show();
    return 0;
}
