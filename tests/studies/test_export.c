// What is printed and exported of a study, against a database written by hand.
// link: -lsqlite3
#include "support/study_database.h"

#include <stdlib.h>
#include <unistd.h>

#include "launchdyn/study.h"
#include "results/hdf5_support.h"

// Two points of a sweep, three samples at each with two rockets; sample 3 failed, the second
// rocket of sample 6 did not leave.
#define SWEEP                                                                                      \
    STUDY("1")                                                                                     \
    "CREATE TABLE point (point INTEGER PRIMARY KEY, \"base.speed\" TEXT, \"firing.order\" TEXT);"  \
    "INSERT INTO point VALUES (2, '15 km/h', '[1, 2]'), (1, '0 km/h', '[2, \"1\"]');"              \
    "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER, status TEXT, reason TEXT,"    \
    "  \"base.elevation\" REAL);"                                                                  \
    "CREATE TABLE rocket (sample INTEGER, rocket INTEGER, tube INTEGER,"                           \
    "  \"rocket.mass_error\" REAL, t_rear REAL, exit_speed REAL, PRIMARY KEY (sample, rocket))"    \
    "  WITHOUT ROWID;"                                                                             \
    "INSERT INTO sample VALUES (1, 1, 'ok', NULL, 0.5), (2, 2, 'ok', NULL, 0.5),"                  \
    "  (3, 1, 'launch', 'the lock held', 0.25), (4, 2, 'ok', NULL, 0.25),"                         \
    "  (5, 1, 'ok', NULL, 0.1), (6, 2, 'ok', NULL, 0.1);"                                          \
    "INSERT INTO rocket VALUES (1, 1, 2, 0.75, 0.125, 38), (1, 2, 1, -0.5, 0.25, 36),"             \
    "  (2, 1, 1, 0.75, 0.1, 39), (2, 2, 2, -0.5, 0.3, 37), (3, 1, 2, 1, NULL, NULL),"              \
    "  (3, 2, 1, 2, NULL, NULL), (4, 1, 1, 1, 0.2, 37.5), (4, 2, 2, 2, 0.15, 38.5),"               \
    "  (5, 1, 2, 0, 0.1875, 37), (5, 2, 1, 0, 0.1875, 37), (6, 1, 1, 0, 0.2, 37.25),"              \
    "  (6, 2, 2, 0, NULL, NULL);"

static int make_folder(void **state)
{
    if (scratch_make(state))
        return -1;
    write_database("sweep", SWEEP);
    return 0;
}

static char *read_text(const char *path)
{
    char *text = calloc(1, 1 << 16);
    FILE *stream = fopen(path, "r");
    assert_true(text && stream);
    assert_true(fread(text, 1, (1 << 16) - 1, stream) > 0);
    fclose(stream);
    return text;
}

// ---- CSV

static void test_csv(void **state)
{
    (void)state;
    static const char expected[] =
        "sample,rocket,tube,status,point,base.speed,firing.order,base.elevation,"
        "rocket.mass_error,t_rear,exit_speed\n"
        "1,1,2,ok,1,0 km/h,\"[2, \"\"1\"\"]\",0.5,0.75,0.125,38\n"
        "1,2,1,ok,1,0 km/h,\"[2, \"\"1\"\"]\",0.5,-0.5,0.25,36\n"
        "2,1,1,ok,2,15 km/h,\"[1, 2]\",0.5,0.75,0.10000000000000001,39\n"
        "2,2,2,ok,2,15 km/h,\"[1, 2]\",0.5,-0.5,0.29999999999999999,37\n"
        "3,1,2,launch,1,0 km/h,\"[2, \"\"1\"\"]\",0.25,1,,\n"
        "3,2,1,launch,1,0 km/h,\"[2, \"\"1\"\"]\",0.25,2,,\n"
        "4,1,1,ok,2,15 km/h,\"[1, 2]\",0.25,1,0.20000000000000001,37.5\n"
        "4,2,2,ok,2,15 km/h,\"[1, 2]\",0.25,2,0.14999999999999999,38.5\n"
        "5,1,2,ok,1,0 km/h,\"[2, \"\"1\"\"]\",0.10000000000000001,0,0.1875,37\n"
        "5,2,1,ok,1,0 km/h,\"[2, \"\"1\"\"]\",0.10000000000000001,0,0.1875,37\n"
        "6,1,1,ok,2,15 km/h,\"[1, 2]\",0.10000000000000001,0,0.20000000000000001,37.25\n"
        "6,2,2,ok,2,15 km/h,\"[1, 2]\",0.10000000000000001,0,,\n";
    ld_error error;
    assert_int_equal(ld_study_export(in("sweep"), in("a.csv"), NULL, &error), LD_OK);
    char *text = read_text(in("a.csv"));
    assert_string_equal(text, expected);
    free(text);
    assert_int_equal(access(in("a.csv.part"), F_OK), -1);
}

// ---- HDF5

static void read_column(hid_t file, const char *name, hid_t type, void *value)
{
    hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
    assert_true(dataset >= 0);
    assert_true(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    H5Dclose(dataset);
}

static void expect_attribute(hid_t file, const char *object, const char *name, const char *text)
{
    hid_t opened = H5Oopen(file, object, H5P_DEFAULT);
    char *found = hdf5_read_string(opened, name);
    assert_string_equal(found, text);
    free(found);
    H5Oclose(opened);
}

static void test_hdf5(void **state)
{
    (void)state;
    ld_error error;
    int64_t sample[12], tube[12], point[12];
    double speed[12], elevation[12];
    char status[12][16];
    assert_int_equal(ld_study_export(in("sweep"), in("b.csv"), in("b.h5"), &error), LD_OK);
    hid_t file = H5Fopen(in("b.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(file >= 0);
    read_column(file, "rockets/sample", H5T_NATIVE_INT64, sample);
    read_column(file, "rockets/tube", H5T_NATIVE_INT64, tube);
    read_column(file, "rockets/point", H5T_NATIVE_INT64, point);
    read_column(file, "rockets/exit_speed", H5T_NATIVE_DOUBLE, speed);
    read_column(file, "rockets/base.elevation", H5T_NATIVE_DOUBLE, elevation);
    hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, sizeof *status);
    read_column(file, "rockets/status", text, status);
    H5Tclose(text);
    assert_true(sample[5] == 3 && tube[5] == 1 && point[5] == 1 && isnan(speed[5]));
    assert_true(sample[7] == 4 && tube[7] == 2 && point[7] == 2 && speed[7] == 38.5);
    assert_true(elevation[6] == 0.25 && elevation[7] == 0.25 && isnan(speed[11]));
    assert_string_equal(status[5], "launch");
    assert_string_equal(status[6], "ok");
    expect_attribute(file, "rockets/exit_speed", "unit", "m/s");
    expect_attribute(file, ".", "scenario", "include: fixed.yaml");
    char order[2][16];
    text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, sizeof *order);
    H5Tset_cset(text, H5T_CSET_UTF8);
    read_column(file, "points/firing.order", text, order);
    assert_string_equal(order[0], "[2, \"1\"]");
    assert_string_equal(order[1], "[1, 2]");
    H5Tclose(text);
    H5Fclose(file);
    // the CSV beside it is the one alone
    char *alone = read_text(in("a.csv")), *beside = read_text(in("b.csv"));
    assert_string_equal(alone, beside);
    free(alone);
    free(beside);
}

// No text of variable length, on whose damage HDF5 crashes: neither of an attribute nor of a
// dataset.
static herr_t see_attribute(hid_t object, const char *name, const H5A_info_t *info, void *unused)
{
    (void)info, (void)unused;
    hid_t attribute = H5Aopen(object, name, H5P_DEFAULT), type = H5Aget_type(attribute);
    bool variable = H5Tis_variable_str(type) > 0;
    H5Tclose(type);
    H5Aclose(attribute);
    return variable;
}

static herr_t see_object(hid_t file, const char *name, const H5O_info_t *info, void *unused)
{
    hid_t object = H5Oopen(file, name, H5P_DEFAULT);
    bool variable =
        H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, see_attribute, unused) != 0;
    if (info->type == H5O_TYPE_DATASET) {
        hid_t type = H5Dget_type(object);
        variable |= H5Tis_variable_str(type) > 0;
        H5Tclose(type);
    }
    H5Oclose(object);
    return variable;
}

static void test_fixed_texts(void **state)
{
    (void)state;
    ld_error error;
    assert_int_equal(ld_study_export(in("sweep"), NULL, in("fixed.h5"), &error), LD_OK);
    hid_t file = H5Fopen(in("fixed.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_int_equal(H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, see_object, NULL), 0);
    H5Fclose(file);
}

// ---- names of columns that a forged database has

static void test_forged_names(void **state)
{
    (void)state;
    static const char name[] = "x\"\" REAL); DROP TABLE sample; --";
    char forged[sizeof SWEEP + 256], *at, expected[128];
    strcpy(forged, SWEEP);
    assert_non_null(at = strstr(forged, "base.elevation"));
    memmove(at + strlen(name), at + strlen("base.elevation"), strlen(at) - 13);
    memcpy(at, name, strlen(name));
    assert_non_null(at = strstr(forged, "base.speed"));
    memmove(at + strlen(name), at + strlen("base.speed"), strlen(at) - 9);
    memcpy(at, name, strlen(name));
    write_database("forged", forged);
    ld_error error = {.text = ""};
    if (ld_study_export(in("forged"), in("forged.csv"), in("forged.h5"), &error))
        fail_msg("%s", error.text);
    char *text = read_text(in("forged.csv"));
    snprintf(expected, sizeof expected, "sample,rocket,tube,status,point,\"%s\",firing.order,",
             name);
    assert_memory_equal(text, expected, strlen(expected));
    assert_non_null(strstr(text, "\n1,1,2,ok,1,0 km/h,\"[2, \"\"1\"\"]\",0.5,0.75,0.125,38\n"));
    free(text);
    const ld_study_view view = {.sensitivity = true};
    FILE *nowhere = fopen("/dev/null", "w");
    if (ld_study_show(in("forged"), &view, nowhere, &error))
        fail_msg("%s", error.text);
    fclose(nowhere);
}

// ---- what cannot be written

static void expect_failure(const char *csv, const char *hdf5, const char *part)
{
    ld_error error = {0};
    assert_int_equal(ld_study_export(in("sweep"), csv, hdf5, &error), LD_ERR_FILE);
    if (!strstr(error.text, part))
        fail_msg("\"%s\" is not about \"%s\"", error.text, part);
}

static void test_failures(void **state)
{
    (void)state;
    // a full disk
    expect_failure("/dev/full", NULL, "cannot write /dev/full: No space left on device");
    expect_failure(NULL, "/dev/full", "cannot write /dev/full: ");
    // a folder that takes no files
    expect_failure("/proc/a.csv", NULL, "cannot write /proc/a.csv: No such file or directory");
    expect_failure(NULL, "/proc/a.h5", "cannot write /proc/a.h5: No such file or directory");
    // what was there stays where the new one cannot be written
    assert_int_equal(mkdir(in("folder.csv"), 0777), 0);
    expect_failure(in("folder.csv"), NULL, "folder.csv: Is a directory");
    assert_int_not_equal(access(in("folder.csv.part"), F_OK), 0);
    assert_int_equal(rmdir(in("folder.csv")), 0);
}

// ---- show

static char *shown_of(const char *name, const ld_study_view *view)
{
    char *text = NULL;
    size_t length;
    ld_error error;
    FILE *stream = open_memstream(&text, &length);
    assert_non_null(stream);
    assert_int_equal(ld_study_show(in(name), view, stream, &error), LD_OK);
    assert_int_equal(fclose(stream), 0);
    return text;
}

static char *shown(const ld_study_view *view)
{
    return shown_of("sweep", view);
}

static void expect_part(const char *text, const char *part)
{
    if (!strstr(text, part))
        fail_msg("\"%s\" is not in\n%s", part, text);
}

static void test_show(void **state)
{
    (void)state;
    char *text = shown(NULL);
    expect_part(text, "1. base.speed: 0 km/h, firing.order: [2, \"1\"]\n"
                      "3 of 3 samples, 1 failed\n"
                      "  1 failed (launch), the first of them 3: the lock held\n"
                      "4 rockets, 2 independent groups");
    expect_part(text, "\n2. base.speed: 15 km/h, firing.order: [1, 2]\n"
                      "3 of 3 samples, 0 failed\n"
                      "5 rockets, 3 independent groups");
    // means of all rockets: (0.125 + 0.25 + 2 0.1875)/4 and (38 + 36 + 37 + 37)/4
    expect_part(text, "\nt_rear [s]                 0.1875 +- 0 ");
    expect_part(text, "\nexit_speed [m/s]           37 +- 0 ");
    expect_part(text, "\nbase.speed                 0 km/h                 15 km/h");
    for (const char *line = text; *line; line += strcspn(line, "\n") + 1)
        assert_true(strcspn(line, "\n") <= 120);
    assert_null(strstr(text, "t_front"));
    free(text);

    text = shown(&(ld_study_view){.what = "exit_speed,rocket.mass_error"});
    assert_null(strstr(text, "t_rear"));
    expect_part(text, "rocket.mass_error");
    free(text);

    text = shown(&(ld_study_view){.sensitivity = true});
    expect_part(text, "% of the variance that each factor explains alone");
    free(text);

    ld_error error;
    ld_study_view wrong = {.what = "t_rear,exit_sped"};
    assert_int_equal(ld_study_show(in("sweep"), &wrong, stdout, &error), LD_ERR_INPUT);
    assert_string_equal(error.text,
                        "the study has no result \"exit_sped\"; did you mean \"exit_speed\"?");
}

#define TABLES(points)                                                                             \
    STUDY("1")                                                                                     \
    "CREATE TABLE point (point INTEGER PRIMARY KEY, \"rocket.mass\" TEXT);"                        \
    "INSERT INTO point VALUES " points ";"                                                         \
    "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER, status TEXT, reason TEXT);"   \
    "CREATE TABLE rocket (sample INTEGER, rocket INTEGER, tube INTEGER, downrange REAL, yaw REAL," \
    "  PRIMARY KEY (sample, rocket)) WITHOUT ROWID;"

// Where nothing scatters: every value once, no NaN and no negative zero.
static void test_show_without_scatter(void **state)
{
    (void)state;
    write_database("single",
                   TABLES("(1, '60 kg')") "INSERT INTO sample VALUES (1, 1, 'ok', NULL);"
                                          "INSERT INTO rocket VALUES (1, 1, 2, 8641.03125, -0.0);");
    write_database("points",
                   TABLES("(1, '60 kg'), (2, '61 kg')") "INSERT INTO sample VALUES (1, 1, 'ok', "
                                                        "NULL), (2, 2, 'ok', NULL);"
                                                        "INSERT INTO rocket VALUES (1, 1, 2, "
                                                        "8641.5, 0.5), (2, 1, 2, 8565.25, 0.25);");
    char *text = shown_of("single", NULL);
    assert_string_equal(text, "1. rocket.mass: 60 kg\n"
                              "1 of 6 samples, 0 failed\n"
                              "every result has one value\n"
                              "\n"
                              "yaw [deg]                  0\n"
                              "downrange [m]              8641.03\n");
    free(text);
    text = shown_of("points", NULL);
    assert_string_equal(
        text, "1. rocket.mass: 60 kg\n"
              "1 of 3 samples, 0 failed\n"
              "every result has one value\n"
              "\n"
              "2. rocket.mass: 61 kg\n"
              "1 of 3 samples, 0 failed\n"
              "every result has one value\n"
              "\n"
              "All points\n"
              "\n"
              "rocket.mass                60 kg                  61 kg                 \n"
              "yaw [deg]                  28.6479                14.3239               \n"
              "downrange [m]              8641.5                 8565.25               \n");
    free(text);
}

// Eight samples where six were asked for last; a spread of a millimetre over 8641 m, which four
// digits do not show; yaws from -0.0 to 1e-5 around zero.
static void test_show_digits(void **state)
{
    (void)state;
    write_database(
        "close",
        TABLES("(1, '60 kg')") "WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n "
                               "WHERE i < 8) "
                               "INSERT INTO sample SELECT i, 1, 'ok', NULL FROM n;"
                               "INSERT INTO rocket SELECT sample, 1, 1, 8641 + 0.001 * sample, "
                               "CASE sample WHEN 1 THEN -0.0 ELSE 1e-5 END FROM sample;");
    char *text = shown_of("close", NULL);
    expect_part(text, "\n8 samples kept, 6 asked for, 0 failed\n");
    expect_part(text, "\ndownrange [m]              8641.0045 +- 0.002 ");
    expect_part(text, " 8641.001    8641.008\n");
    // the median's interval leaves room for a digit less
    expect_part(text, "\ndownrange [m]              8641.0014                      "
                      "8641.004 [8641.002, 8641.007]  8641.0076\n");
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, " -0 "));
    for (const char *line = text; *line; line += strcspn(line, "\n") + 1)
        assert_true(strcspn(line, "\n") <= 120);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_csv),
        cmocka_unit_test(test_hdf5),
        cmocka_unit_test(test_fixed_texts),
        cmocka_unit_test(test_forged_names),
        cmocka_unit_test(test_failures),
        cmocka_unit_test(test_show),
        cmocka_unit_test(test_show_without_scatter),
        cmocka_unit_test(test_show_digits),
    };
    return cmocka_run_group_tests(tests, make_folder, scratch_remove);
}
