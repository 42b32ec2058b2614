// Damaged studies: flipped bits and cut ends in study.db, shards and study.pending, and databases
// changed by hand. Each is reported, or changes nothing of what is shown and exported; what is
// intact can be exported, and the rest is run again to the same bits. LD_DAMAGE: how many flips
// and cuts (default 60).
// link: -lsqlite3
#include "support/sealed_study.h"
#include "support/study_run.h"

#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/random.h"
#include "launchdyn/report.h"
#include "studies/store/row_digest.h"

static const char text[] = "include: flight.yaml\n"
                           "run: {flight_tolerance: 1e-4}\n"
                           "scatter:\n"
                           "  samples: 8\n"
                           "  factors:\n"
                           "    rocket.mass_error: {normal: 0.2 kg}\n"
                           "    environment.temperature_offset: {normal: 5 K}\n"
                           "sweep: {rocket.motor.thrust_scale: [1, 1.01]}\n";

// What a folder gives: codes and texts of `show` and of `export`.
typedef struct told {
    ld_status show, export;
    ld_error shown, exported;
    char *page, *table;
} told;

static char *read_file(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    char *bytes = calloc(1, 1 << 20);
    assert_non_null(bytes);
    *size = stream ? fread(bytes, 1, (1 << 20) - 1, stream) : 0;
    if (stream)
        fclose(stream);
    return bytes;
}

static void write_file(const char *path, const char *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

static told look(const char *name)
{
    told self = {0};
    size_t length;
    FILE *stream = open_memstream(&self.page, &length);
    ld_study_view few = {.what = "downrange,drift"};
    assert_non_null(stream);
    self.show = ld_study_show(in(name), &few, stream, &self.shown);
    fclose(stream);
    unlink(in("look.csv"));
    self.export = ld_study_export(in(name), in("look.csv"), NULL, &self.exported);
    self.table = read_file(in("look.csv"), &length);
    return self;
}

static void forget(told *self)
{
    free(self->page);
    free(self->table);
}

// Whether each line of a table is one of another, in the same order.
static bool is_part(const char *part, const char *whole)
{
    for (; *part; part += strcspn(part, "\n") + 1) {
        size_t length = strcspn(part, "\n") + 1;
        while (*whole && strncmp(part, whole, length) != 0)
            whole += strcspn(whole, "\n") + 1;
        if (!*whole)
            return false;
    }
    return true;
}

// What damages have come to.
typedef struct tally {
    int told, harmless, silent, wrong, partial;
} tally;

static void count_one(tally *self, const told *found, const told *good)
{
    bool show = found->show == LD_ERR_INPUT && found->shown.text[0];
    bool export = found->export == LD_ERR_INPUT && found->exported.text[0];
    bool same = (show || strcmp(found->page, good->page) == 0) &&
                (export || strcmp(found->table, good->table) == 0);
    self->told += show || export;
    self->harmless += !show && !export && same;
    self->silent += !same;
    self->partial += export && found->table[0];
    self->wrong += export && !is_part(found->table, good->table);
    self->wrong += (found->show && !show) || (found->export && !export);
}

// One bit changed, or the end cut off, in the way that belongs to this number.
static void damage(const char *path, const char *bytes, size_t size, uint64_t number)
{
    char *changed = malloc(size + 1);
    assert_non_null(changed);
    memcpy(changed, bytes, size);
    size_t at = (size_t)(random_uniform(1, 0, number, 0, 0) * (double)size);
    if (number % 10 != 9)
        changed[at] ^= (char)(1 << (int)(random_uniform(2, 0, number, 0, 0) * 8));
    write_file(path, changed, number % 10 != 9 ? size : at);
    free(changed);
}

// How many of all are tried of one kind.
static int damages(double share)
{
    int all = getenv("LD_DAMAGE") ? atoi(getenv("LD_DAMAGE")) : 60;
    return (int)(share * all + 0.5);
}

static void run_command(const char *command)
{
    char line[512];
    snprintf(line, sizeof line, "cd %s && %s", folder, command);
    assert_int_equal(system(line), 0);
}

static void print_tally(const char *of, const tally *self)
{
    printf("    %s: %d told, %d harmless; %d tables of what is intact\n", of, self->told,
           self->harmless, self->partial);
    CHECK_BELOW("accepted silently", self->silent, 0.5);
    CHECK_BELOW("told wrongly, or wrong tables", self->wrong, 0.5);
}

static void test_database(void **state)
{
    (void)state;
    ld_study *study = study_of(text);
    study_run(study, "good", 1);
    ld_study_free(study);
    told good = look("good");
    assert_true(good.show == LD_OK && good.export == LD_OK);
    size_t size;
    char *bytes = read_file(in("good/study.db"), &size);
    tally all = {0};
    run_command("mkdir bad");
    for (int i = 0; i < damages(0.6); i++) {
        damage(in("bad/study.db"), bytes, size, (uint64_t)i);
        told found = look("bad");
        int before = all.silent;
        count_one(&all, &found, &good);
        if (all.silent > before)
            printf("    number %d was not told\n", i);
        forget(&found);
    }
    print_tally("study.db", &all);
    free(bytes);
    forget(&good);
}

// Of what is damaged a run and a merge take nothing that is wrong.
static void test_going_on(void **state)
{
    (void)state;
    ld_study *study = study_of(text);
    told good = look("good");
    size_t size;
    char *bytes = read_file(in("good/study.db"), &size);
    int refused = 0, merged = 0, wrong = 0;
    FILE *stream = fopen("/dev/null", "w");
    assert_non_null(stream);
    for (int i = 0; i < damages(0.1); i++) {
        ld_error error;
        ld_study_counts counts;
        size_t unused;
        run_command("rm -rf on parts && mkdir on parts");
        damage(in("on/study.db"), bytes, size, 1000000 + (uint64_t)i);
        ld_status run = ld_study_run(study, in("on"), NULL, &counts, &error);
        char *table = NULL;
        if (run == LD_OK && ld_study_export(in("on"), in("on.csv"), NULL, &error) == LD_OK) {
            table = read_file(in("on.csv"), &unused);
            wrong += strcmp(table, good.table) != 0;
            free(table);
        } else {
            wrong += run == LD_OK;
            refused++;
        }
        damage(in("parts/shard-1-of-1.db"), bytes, size, 1000000 + (uint64_t)i);
        ld_status merge = ld_study_merge(in("parts"), stream, &error);
        if (access(in("parts/study.db"), F_OK) == 0 &&
            ld_study_run(study, in("parts"), NULL, &counts, &error) == LD_OK) {
            assert_int_equal(ld_study_export(in("parts"), in("on.csv"), NULL, &error), LD_OK);
            table = read_file(in("on.csv"), &unused);
            wrong += strcmp(table, good.table) != 0;
            free(table);
            merged += merge == LD_ERR_INPUT;
        }
    }
    fclose(stream);
    free(bytes);
    printf("    %d studies: %d refused to go on; %d merged though damaged, and made whole\n",
           damages(0.1), refused, merged);
    CHECK_BELOW("other tables at the end", wrong, 0.5);
    assert_true(refused > 0 && merged > 0);
    forget(&good);
    ld_study_free(study);
}

// ---- what a killed study leaves beside its database

// So slow that there are commits in between, and records that wait for theirs.
static void end_soon(void *self, const ld_study_counts *counts)
{
    (void)self;
    usleep(20000);
    if (counts->done == 12)
        raise(SIGKILL);
}

static void leave(const ld_study *study)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        ld_error error;
        ld_study_counts counts;
        ld_study_options options = {.threads = 1, .progress = end_soon};
        ld_study_run(study, in("left"), &options, &counts, &error);
        _exit(0);
    }
    int status;
    waitpid(child, &status, 0);
    assert_true(WIFSIGNALED(status));
}

// Damages one file of what was left: what is shown then is reported, or part of the whole; what is
// run on becomes the whole.
static void damage_left(const ld_study *study, const char *file, const told *good, int *wrong)
{
    size_t size;
    char path[160];
    snprintf(path, sizeof path, "%s/%s", in("left"), file);
    char *bytes = read_file(path, &size);
    assert_true(size > 0);
    size = size < 20000 || strstr(file, "wal") ? size : 20000; // the records that there are
    for (int i = 0; i < damages(0.15); i++) {
        ld_error error;
        ld_study_counts counts;
        run_command("rm -rf waiting && cp -r left waiting");
        snprintf(path, sizeof path, "%s/%s", in("waiting"), file);
        damage(path, bytes, size, 2000000 + (uint64_t)i);
        told found = look("waiting");
        *wrong += found.export ? found.export != LD_ERR_INPUT : !is_part(found.table, good->table);
        *wrong += found.show && found.show != LD_ERR_INPUT;
        forget(&found);
        ld_status status = ld_study_run(study, in("waiting"), NULL, &counts, &error);
        found = look("waiting");
        *wrong += status ? status != LD_ERR_INPUT : strcmp(found.table, good->table) != 0;
        forget(&found);
    }
    free(bytes);
}

static void test_left(void **state)
{
    (void)state;
    ld_study *study = study_of(text);
    told good = look("good");
    int wrong = 0;
    leave(study);
    damage_left(study, "study.pending", &good, &wrong);
    damage_left(study, "study.db-wal", &good, &wrong);
    CHECK_BELOW("other tables after damage beside the database", wrong, 0.5);
    forget(&good);
    ld_study_free(study);
}

// ---- changed by hand

static void expect_told(const char *sql, const char *part)
{
    run_command("rm -rf odd && cp -r good odd");
    run_sql(in("odd/study.db"), sql);
    told found = look("odd");
    ld_error error = {0};
    ld_study_counts counts;
    ld_study *study = study_of(text);
    if (found.show != LD_ERR_INPUT || found.export != LD_ERR_INPUT ||
        !strstr(found.shown.text, part) || !strstr(found.exported.text, part))
        fail_msg("%s: %s; %s", sql, found.shown.text, found.exported.text);
    assert_int_equal(ld_study_run(study, in("odd"), NULL, &counts, &error), LD_ERR_INPUT);
    if (!strstr(error.text, part))
        fail_msg("%s: %s", sql, error.text);
    assert_null(strstr(found.page, "nan"));
    forget(&found);
    ld_study_free(study);
}

static void test_odd_contents(void **state)
{
    (void)state;
    static const char kept[] = "changed samples: ",
                      *const changed[] = {
                          "UPDATE study SET value = '1 1 0 0' WHERE name = 'kept'",
                          "DELETE FROM study WHERE name = 'kept'",
                          "UPDATE study SET value = '7' WHERE name = 'samples'",
                          "UPDATE study SET value = 'x' WHERE name = 'strata'",
                          "UPDATE study SET value = 'launchdyn: 1' WHERE name = 'scenario'",
                          "DELETE FROM point WHERE point = 2",
                          "INSERT INTO point VALUES (3, '7')",
                          "DELETE FROM origin WHERE kind = 'file'",
                          "ALTER TABLE rocket ADD more REAL",
                          "ALTER TABLE rocket RENAME COLUMN pitch TO pitsch",
                      };
    for (size_t i = 0; i < sizeof changed / sizeof *changed; i++)
        expect_told(changed[i], "its tables study, point, origin were changed");
    expect_told("UPDATE study SET value = '99' WHERE name = 'format'", "is of format 99, begun by");
    expect_told("DELETE FROM study", "contains no study");
    expect_told("DROP TABLE study", "contains no study");
    expect_told("DROP TABLE rocket", "its tables study, point, origin were changed");
    expect_told("CREATE TABLE more (a)", "its table more does not belong to a study");
    expect_told("DELETE FROM rocket WHERE sample = 7", kept);
    expect_told("DELETE FROM rocket", kept);
    expect_told("DELETE FROM sample WHERE sample = 7", kept);
    expect_told("DELETE FROM sample", kept);
    expect_told("UPDATE sample SET sample = 99 WHERE sample = 7", kept);
    expect_told("UPDATE sample SET status = CAST(status AS BLOB) WHERE sample = 7", kept);
    expect_told("UPDATE sample SET point = 2 WHERE sample = 7", kept);
    expect_told("UPDATE sample SET status = 'launch' WHERE sample = 7", kept);
    expect_told("UPDATE sample SET \"environment.temperature_offset\" = 'warm' WHERE sample = 7",
                kept);
    expect_told("UPDATE rocket SET downrange = NULL WHERE sample = 7", kept);
    expect_told("UPDATE rocket SET downrange = 9e999", kept);
    expect_told("UPDATE rocket SET rocket = 2 WHERE sample = 7", kept);
    expect_told("INSERT INTO rocket (sample, rocket) VALUES (99, 1)", "rockets without a sample");
}

// ---- forged, with the digests that belong to it

// What a study's database is made to hold, its digests too; the sentence; whether who only reads it
// takes it.
typedef struct forgery {
    const char *sql, *part;
    bool readable;
} forgery;

static const forgery forgeries[] = {
    {"CREATE TRIGGER steal AFTER INSERT ON sample BEGIN DELETE FROM rocket; END",
     "its trigger steal does not belong to a study", false},
    {"CREATE VIEW more AS SELECT * FROM rocket", "its view more does not belong to a study", false},
    {"ALTER TABLE rocket RENAME TO r; CREATE VIEW rocket AS SELECT * FROM r",
     "does not belong to a study", false},
    {"CREATE INDEX quick ON rocket (pitch)", "its index quick does not belong to a study", false},
    {"CREATE TABLE more (a)", "its table more does not belong to a study", false},
    {"ALTER TABLE rocket ADD more REAL AS (pitch + 1)",
     "its table rocket does not belong to a study", true},
    {"ALTER TABLE study ADD more", "its table study does not belong to a study", true},
};

static void expect_none_taken(const char *name)
{
    sqlite3 *database;
    sqlite3_stmt *row;
    assert_int_equal(sqlite3_open(in(name), &database), SQLITE_OK);
    sqlite3_prepare_v2(database, "SELECT 1 FROM sqlite_master", -1, &row, NULL);
    assert_int_equal(sqlite3_step(row), SQLITE_DONE);
    sqlite3_finalize(row);
    sqlite3_close(database);
}

static void expect_refused(ld_status status, const ld_error *error, const forgery *forged)
{
    if (status != LD_ERR_INPUT || !strstr(error->text, forged->part))
        fail_msg("%s: %d, %s", forged->sql, status, error->text);
}

static void expect_forged(const ld_study *study, const forgery *forged)
{
    ld_error error = {0};
    ld_study_counts counts;
    FILE *stream = fopen("/dev/null", "w");
    assert_non_null(stream);
    run_command("rm -rf odd && cp -r good odd");
    run_sql(in("odd/study.db"), forged->sql);
    seal_study(in("odd/study.db"));
    told found = look("odd");
    if (!forged->readable) {
        expect_refused(found.show, &found.shown, forged);
        expect_refused(found.export, &found.exported, forged);
    }
    forget(&found);
    ld_status status = ld_study_run(study, in("odd"), NULL, &counts, &error);
    expect_refused(status, &error, forged);
    run_command("mv odd/study.db odd/shard-1-of-1.db");
    status = ld_study_merge(in("odd"), stream, &error);
    expect_refused(status, &error, forged);
    fclose(stream);
    expect_none_taken("odd/study.db");
}

static void test_forged(void **state)
{
    (void)state;
    ld_study *study = study_of(text);
    for (size_t i = 0; i < sizeof forgeries / sizeof *forgeries; i++)
        expect_forged(study, &forgeries[i]);
    ld_study_free(study);
}

// A shard whose columns have changed their names is of another study than the one before it.
static void test_other_columns(void **state)
{
    (void)state;
    static const forgery renamed = {"ALTER TABLE rocket RENAME COLUMN pitch TO \"pitsch\"",
                                    "of different studies: in their table rocket", true},
                         alone = {"", "its tables are not those of this study", true};
    ld_error error = {0};
    ld_study_counts counts;
    ld_study *study = study_of(text);
    FILE *stream = fopen("/dev/null", "w");
    assert_non_null(stream);
    run_command("rm -rf odd && cp -r good odd && cp odd/study.db odd/shard-1-of-2.db");
    run_sql(in("odd/study.db"), renamed.sql);
    seal_study(in("odd/study.db"));
    ld_status status = ld_study_run(study, in("odd"), NULL, &counts, &error);
    expect_refused(status, &error, &alone);
    run_command("mv odd/study.db odd/shard-2-of-2.db");
    status = ld_study_merge(in("odd"), stream, &error);
    expect_refused(status, &error, &renamed);
    fclose(stream);
    ld_study_free(study);
}

// Infinities that a run has found are shown as what they are.
static void test_infinite(void **state)
{
    (void)state;
    run_command("rm -rf odd && cp -r good odd");
    run_sql(in("odd/study.db"), "UPDATE rocket SET downrange = 9e999 WHERE sample < 6;"
                                "UPDATE rocket SET drift = -9e999");
    seal_study(in("odd/study.db"));
    told found = look("odd");
    assert_int_equal(found.show, LD_OK);
    assert_non_null(strstr(found.page, "inf"));
    if (strstr(found.page, "nan"))
        fail_msg("%s", found.page);
    forget(&found);
    // and a report's data has no word that is none of JSON
    static const char *const words[] = {":nan", ":-nan", ",nan", ",-nan", "[nan", "[-nan",
                                        ":inf", ":-inf", ",inf", ",-inf", "[inf", "[-inf"};
    const char *path = in("odd");
    ld_error error;
    size_t size;
    assert_int_equal(ld_report_write_studies(&path, 1, in("odd.html"), NULL, &error), LD_OK);
    char *page = read_file(in("odd.html"), &size);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        assert_null(strstr(page, words[i]));
    assert_non_null(strstr(page, "\"points\":["));
    free(page);
}

// SQLite gives a negative zero back as zero: a sample with one is not damaged.
static void test_both_zeros(void **state)
{
    (void)state;
    assert_true(digest_real(7, -0.0) == digest_real(7, 0.0));
    assert_true(digest_real(7, -1.0) != digest_real(7, 1.0));
}

// What stands in the place of study.db.
static void test_other_files(void **state)
{
    (void)state;
    static const char *const made[] = {
        "mkdir odd/study.db", "ln -s nowhere odd/study.db",           "ln -s study.db odd/study.db",
        "touch odd/study.db", "head -c 5000 /dev/zero >odd/study.db", "echo text >odd/study.db",
    };
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
        char line[128];
        snprintf(line, sizeof line, "rm -rf odd && mkdir odd && %s", made[i]);
        run_command(line);
        told found = look("odd");
        printf("    %s: %s\n", made[i], found.shown.text);
        assert_true(found.show != LD_OK && found.export != LD_OK);
        assert_true(found.shown.text[0] && found.exported.text[0]);
        forget(&found);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_database),    cmocka_unit_test(test_going_on),
        cmocka_unit_test(test_left),        cmocka_unit_test(test_odd_contents),
        cmocka_unit_test(test_forged),      cmocka_unit_test(test_other_columns),
        cmocka_unit_test(test_infinite),    cmocka_unit_test(test_both_zeros),
        cmocka_unit_test(test_other_files),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
