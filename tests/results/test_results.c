// What a run leaves on disk: complete, exact, readable by others, never half-written.
#include "model/model.h"
#include "support/check.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "launchdyn/output.h"
#include "quantities/study_results.h"
#include "results/history.h"
#include "support/comma_locale.h"
#include "support/made_launch.h"

typedef struct place {
    char folder[64];
    ld_model model;
} place;

static int set_up(void **state)
{
    static place here;
    strcpy(here.folder, "/tmp/launchdyn-results-XXXXXX");
    if (!mkdtemp(here.folder))
        return -1;
    made_model(&here.model);
    *state = &here;
    return 0;
}

static int tear_down(void **state)
{
    place *here = *state;
    char command[256];
    snprintf(command, sizeof command, "chmod -R u+w %s; rm -r %s", here->folder, here->folder);
    return system(command);
}

// A path in the folder of the test; four of them live at a time.
static const char *in(const place *here, const char *name)
{
    static char path[4][256];
    static int next;
    char *chosen = path[next++ % 4];
    snprintf(chosen, sizeof *path, "%s/%s", here->folder, name);
    return chosen;
}

static int exists(const char *path)
{
    return access(path, F_OK) == 0;
}

// What a command prints, without the last line break.
static const char *printed_by(const char *format, const char *path)
{
    static char text[1 << 16];
    char command[512];
    snprintf(command, sizeof command, format, path);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    size_t length = fread(text, 1, sizeof text - 1, pipe);
    assert_int_equal(pclose(pipe), 0);
    while (length > 0 && text[length - 1] == '\n')
        length--;
    text[length] = '\0';
    return text;
}

// A model of three parachutes, of which the second does not open in the made launch.
static ld_model with_parachutes = {
    .rocket = {.parachute = {{.name = "pilot"}, {.name = "drogue"}, {.name = "main.lower"}},
               .parachute_count = 3}};

static void write_launch(const place *here, const char *folder, bool csv, size_t rows)
{
    ld_error error = {0};
    ld_output *output = NULL;
    ld_summary summary;
    made_summary(&summary, 1);
    summary.rocket[0].flown = true;
    summary.rocket[0].flight = (ld_flight_summary){.t_apogee = 13.5, .t_impact = 41.5};
    summary.model = &with_parachutes;
    summary.rocket[0].parachute[0].t_open = 15.5;
    summary.rocket[0].parachute[1].t_open = NAN;
    summary.rocket[0].parachute[2].t_open = 30.25;
    if (ld_output_open(in(here, folder), &here->model, csv, &output, &error) ||
        made_run(ld_output_sink(output), rows, &error) ||
        ld_output_finish(output, &summary, &error))
        fail_msg("%s", error.text);
}

// Values that differ, bit for bit, between `read` and the first rows of the made launch.
static size_t differences(const history_data *read)
{
    size_t wrong = 0;
    for (size_t row = 0; row < read->rows; row++) {
        double values[MADE_COLUMNS];
        made_row(row, values);
        for (size_t i = 0; i < read->columns; i++) {
            double value = read->value[i * read->rows + row];
            wrong += isnan(values[i]) ? !isnan(value) : value != values[i];
        }
    }
    return wrong;
}

static void expect_openings(const history_data *rocket)
{
    const history_opening *opening = rocket->opening;
    assert_int_equal(rocket->openings, 2);
    int pilot = opening[1].t == 15.5;
    assert_string_equal(opening[pilot].name, "pilot");
    assert_true(opening[pilot].t == 15.5);
    assert_string_equal(opening[!pilot].name, "main.lower");
    assert_true(opening[!pilot].t == 30.25);
}

static void test_hdf5_holds_every_bit(void **state)
{
    place *here = *state;
    static const size_t lengths[] = {1, 1023, 1024, 1025, 2700};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        write_launch(here, "run", false, lengths[i]);
        history_data read;
        assert_int_equal(history_read(in(here, "run/history.h5"), &read, NULL), LD_OK);
        assert_int_equal(read.rows, lengths[i]);
        assert_int_equal(read.columns, MADE_COLUMNS);
        for (size_t j = 0; j < read.columns; j++)
            assert_string_equal(read.name[j], made_columns()[j].name);
        CHECK_BELOW("values of history.h5 that differ", (double)differences(&read), 0.0);
        assert_string_equal(read.title, here->model.title);
        assert_true(read.t_rear == 0.1604 && read.t_middle == 0.1273 && read.t_front == 0.0952);
        assert_true(read.t_apogee == 13.5 && read.t_impact == 41.5);
        expect_openings(&read.rocket[0]);
        assert_ptr_equal(history_column(&read, "tip.y"), read.value + 33 * read.rows);
        assert_null(history_column(&read, "tip"));
        history_free(&read);
    }
}

// Before format 3 units were the attribute "unit".
static void test_earlier_histories_are_read(void **state)
{
    place *here = *state;
    write_launch(here, "run", false, 20);
    hid_t file = H5Fopen(in(here, "run/history.h5"), H5F_ACC_RDWR, H5P_DEFAULT);
    for (size_t i = 0; i < MADE_COLUMNS; i++) {
        char path[128];
        snprintf(path, sizeof path, "/history/%s", made_columns()[i].name);
        assert_true(H5Arename_by_name(file, path, "units", "unit", H5P_DEFAULT) >= 0);
    }
    assert_true(H5Fclose(file) >= 0);
    history_data read;
    assert_int_equal(history_read(in(here, "run/history.h5"), &read, NULL), LD_OK);
    for (size_t i = 0; i < MADE_COLUMNS; i++)
        assert_string_equal(read.unit[i], made_columns()[i].unit);
    CHECK_BELOW("values of an earlier history.h5 that differ", (double)differences(&read), 0.0);
    history_free(&read);
}

// h5dump knows nothing of our reader.
static void test_hdf5_is_read_by_others(void **state)
{
    place *here = *state;
    write_launch(here, "run", false, 3);
    const char *file = in(here, "run/history.h5");
    double values[MADE_COLUMNS];
    char number[32];
    made_row(2, values);
    snprintf(number, sizeof number, " %.17g\n", values[33]);
    assert_non_null(strstr(printed_by("h5dump -m %%.17g -d /history/tip.y %s", file), number));
    assert_non_null(strstr(printed_by("h5dump -a /history/tip.y/units %s", file), "\"m\""));
    const char *description = printed_by("h5dump -a /history/tip.y/long_name %s", file);
    assert_non_null(strstr(description, "H5T_CSET_UTF8"));
    assert_non_null(strstr(description, "\"made up, "));
    assert_non_null(
        strstr(printed_by("h5dump -a /history/t/CLASS %s", file), "\"DIMENSION_SCALE\""));
    assert_non_null(strstr(printed_by("h5dump -a /history/t/NAME %s", file), "\"t\""));
    assert_non_null(
        strstr(printed_by("h5dump -a /history/tip.y/DIMENSION_LIST %s", file), "\"/history/t\""));
    assert_non_null(strstr(printed_by("h5dump -a /complete %s", file), "(0): 1"));
    assert_non_null(strstr(printed_by("h5dump -a /rockets/1/tube %s", file), "(0): 8"));
    assert_non_null(strstr(printed_by("h5dump -a /version %s", file), "\"0."));
}

static void test_same_run_same_bytes(void **state)
{
    place *here = *state;
    write_launch(here, "a", true, 1500);
    write_launch(here, "b", true, 1500);
    printed_by("cd %s && cmp a/history.h5 b/history.h5 && cmp a/history.csv b/history.csv && "
               "cmp a/summary.json b/summary.json",
               here->folder);
}

// A locale with a decimal comma around us must not reach the files.
static void test_decimal_comma_stays_out(void **state)
{
    place *here = *state;
    write_launch(here, "point", true, 20);
    set_comma_locale(here->folder);
    write_launch(here, "comma", true, 20);
    leave_comma_locale();
    // the made columns' descriptions in history.h5 have commas
    printed_by("cd %s && cmp point/history.csv comma/history.csv && "
               "for i in point comma; do grep -v '\"digest\"' $i/summary.json >$i.json; done && "
               "cmp point.json comma.json",
               here->folder);
}

static void test_csv_holds_every_bit(void **state)
{
    place *here = *state;
    write_launch(here, "run", true, 1700);
    FILE *file = fopen(in(here, "run/history.csv"), "r");
    assert_non_null(file);
    static char line[1 << 14];
    assert_non_null(fgets(line, sizeof line, file));
    assert_memory_equal(line, "t [s],phase [1],base.x [m],", 27);
    size_t wrong = 0, rows = 0;
    for (; fgets(line, sizeof line, file); rows++) {
        double values[MADE_COLUMNS];
        made_row(rows, values);
        char *cursor = line;
        for (int i = 0; i < MADE_COLUMNS; i++) {
            double value = strtod(cursor, &cursor);
            wrong += isnan(values[i]) ? !isnan(value) : value != values[i];
            wrong += *cursor++ != (i + 1 < MADE_COLUMNS ? ',' : '\n');
        }
    }
    fclose(file);
    CHECK_BELOW("values of history.csv that differ", (double)wrong, 0.0);
    assert_int_equal(rows, 1700);
}

static void test_csv_quotes_names(void **state)
{
    place *here = *state;
    const ld_column columns[] = {{"t", "s", ""}, {"contact.a,\"b\".force", "N", ""}};
    history_csv *csv;
    assert_int_equal(history_csv_create(in(here, "x.csv"), &csv, NULL), LD_OK);
    assert_int_equal(history_csv_begin(csv, columns, 2, NULL), LD_OK);
    assert_int_equal(history_csv_row(csv, (double[]){0.1, -INFINITY}, 2, NULL), LD_OK);
    assert_int_equal(history_csv_close(csv, NULL), LD_OK);
    assert_string_equal(printed_by("cat %s", in(here, "x.csv")),
                        "t [s],\"contact.a,\"\"b\"\".force [N]\"\n0.10000000000000001,-inf");
}

// jq reads the file and gives back what was put in.
static void test_summary_is_json(void **state)
{
    place *here = *state;
    ld_summary summary;
    ld_error error = {0};
    made_summary(&summary, 0);
    summary.complete = false;
    strcpy(summary.stopped, "the rocket said \"no\"\tand\\or \xff\xc3\xa9\x01");
    summary.note_count = 1;
    strcpy(summary.note[0], "first");
    const char *file = in(here, "summary.json");
    assert_int_equal(ld_summary_write(file, &here->model, &summary, &error), LD_OK);
    static const struct {
        const char *filter, *printed;
    } expected[] = {
        {"keys_unsorted|join(\",\")",
         "format,title,version,program,t_end,complete,stopped,notes,"
         "rockets,equilibrium,energy,modes,statistics,scenario,source,files,digest"},
        {".program|[.version, .commit]|tostring", "[\"0.1.0\",\"unknown\"]"},
        {".program|keys_unsorted|join(\",\")",
         "version,commit,compiler,processor,C library,SUNDIALS,"
         "LAPACK,BLAS,HDF5,SQLite,libyaml,zlib"},
        {".source|tostring", "null"}, // filled by hand
        {".rockets[0]|keys_unsorted|join(\",\")",
         "tube,t_ignition,t_release,t_front,t_middle,t_rear,t_exit,exit_speed,inertial_speed,"
         "spin_rate,since_ignition,tip_off,pitch,yaw,pitch_rate,yaw_rate,exit,relative,tip,"
         "exit_error,max_contact_force,max_slot_force,energy_dropped"},
        {".rockets[0].exit|tostring",
         "{\"position\":[1.5,2.25,-0.5],\"velocity\":[35.5,12.75,0.125],"
         "\"quaternion\":[0.5,-0.5,0.5,0.5],\"rate\":[32,0.25,-0.75]}"},
        {".rockets[0].energy_dropped", "0.0625"},
        {".rockets[0].relative|keys_unsorted|join(\",\")", "y,z,psi,theta,gamma,w_x,w_y,w_z"},
        {".rockets[0].relative|[.y,.z,.psi,.theta,.gamma,.w_x,.w_y,.w_z]|tostring",
         "[0.0001,-0.0002,0.0003,-0.0004,2.5,31.9,0.05,-0.25]"},
        {".rockets[0].tip|keys_unsorted|join(\",\")", "y,z,pitch,yaw,vy,vz,pitch_rate,yaw_rate"},
        {".rockets[0].tip|[.y,.z,.pitch,.yaw,.vy,.vz,.pitch_rate,.yaw_rate]|tostring",
         "[-0.0011,0.0002,-0.0005,0.0001,0.3,-0.02,0.2,0.01]"},
        {".rockets[0].tip_off|tostring",
         "{\"pitch\":-0.007,\"yaw\":0.0002,\"pitch_rate\":-0.26,\"yaw_rate\":0.007,"
         "\"pitch_rate_relative\":-0.3,\"yaw_rate_relative\":0.015,\"vy\":-1.5,\"vz\":5.125,"
         "\"vy_relative\":-0.375,\"vz_relative\":-0.02}"},
        {".rockets[0].since_ignition|tostring",
         "{\"pitch\":-0.0008,\"yaw\":-0.001,\"roll\":2.25,\"pitch_rate\":-0.27,"
         "\"yaw_rate\":0.008,\"roll_rate\":31.5,\"vy\":-1.25,\"vz\":5.25}"},
        {".rockets[0].exit_error|tostring",
         "{\"rates\":2e-05,\"yaw_rate\":0.0012,\"relative\":0.002}"},
        {".rockets[0].max_contact_force|tostring", "{\"rear\":1500,\"middle\":500,\"front\":900}"},
        {".rockets[0]|[.tube,.t_release,.t_front,.t_middle,.t_rear]|tostring",
         "[8,0.0033336,0.0952,null,0.1604]"},
        {".energy.work|keys_unsorted|join(\",\")",
         "thrust,gravity_rocket,contact_normal,contact_friction,slot,slot_friction,lock,"
         "support_damping,modal_damping,base,mass_change"},
        {".energy|[.kinetic,.potential,.elastic,.residual,.residual_relative]|tostring",
         "[43000,300,12,0.00015,3.4e-09]"},
        {".modes|length", "5"},
        {".modes[4]|[.frequency,.damping,.real,.shape]|tostring",
         "[310.125,0.01,-19.5,\"torsion\"]"},
        {".statistics|[.steps,.rhs_evaluations,.cpu_seconds]|tostring", "[1234,9876,0.0105]"},
        {".equilibrium.tip_sag|tostring", "{\"y\":-0.00125,\"z\":0}"},
        {".equilibrium.contact_force.front", "303.5"},
        {".complete", "false"},
        {".notes|tostring", "[\"first\"]"},
        {".stopped", "the rocket said \"no\"\tand\\or \xef\xbf\xbd\xc3\xa9\x01"},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        char command[256];
        snprintf(command, sizeof command, "jq -r '%s' %%s", expected[i].filter);
        const char *printed = printed_by(command, file);
        if (strcmp(expected[i].filter, ".energy|[.kinetic,.potential,.elastic,.residual,"
                                       ".residual_relative]|tostring") == 0)
            assert_memory_equal(printed, "[43000,300,12,0.00015,3.4e-", 27);
        else
            assert_string_equal(printed, expected[i].printed);
    }
}

// What a study keeps of a rocket is what its summary.json says under the same name.
static void test_results_of_a_study_are_those_of_the_summary(void **state)
{
    place *here = *state;
    ld_summary summary;
    ld_error error = {0};
    made_summary(&summary, 1);
    ld_rocket_summary *rocket = &summary.rocket[0];
    rocket->flown = true;
    rocket->flight = (ld_flight_summary){2.5, 900,  1100, 13.5, 8600, -50,   8601, 41.5, 41.375,
                                         210, 0.75, 1.5,  9e4,  3.5,  250.5, 1.25, 0.01};
    const char *file = in(here, "summary.json");
    assert_int_equal(ld_summary_write(file, &here->model, &summary, &error), LD_OK);
    char *text = strdup(printed_by(
        "jq -r '.rockets[0]|del(.final)|.+.flight|.exit|={x:.position[0],y:.position[1],"
        "z:.position[2],vx:.velocity[0],vy:.velocity[1],vz:.velocity[2]}|[paths(numbers) as $p|"
        "\"=\\($p|join(\".\")) \\(getpath($p))\"]|.[]' %s",
        file));
    const quantity_things things = quantity_things_of(&here->model);
    for (quantity_walk r = study_result_first(&things); r.row; study_result_next(&r)) {
        char wanted[QUANTITY_NAME + 2], name[QUANTITY_NAME];
        study_result_name(&r, name);
        snprintf(wanted, sizeof wanted, "=%s ", name);
        const char *found = strstr(text, wanted);
        if (!found || strtod(found + strlen(wanted), NULL) != quantity_value(&r, rocket))
            fail_msg("%s: %.17g in a study, in the summary %.60s", name, quantity_value(&r, rocket),
                     found ? found : "nothing");
    }
    free(text);
}

static void test_numbers_keep_17_digits(void **state)
{
    place *here = *state;
    ld_summary summary;
    made_summary(&summary, 1);
    summary.rocket[0].exit_speed = 0.1 + 0.2;
    assert_int_equal(ld_summary_write(in(here, "s.json"), &here->model, &summary, NULL), LD_OK);
    printed_by("grep -q 'exit_speed\": 0.30000000000000004,' %s", in(here, "s.json"));
}

static void test_terminal_table(void **state)
{
    place *here = *state;
    ld_summary summary;
    made_summary(&summary, 1);
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    ld_summary_print(&here->model, &summary, stream);
    fclose(stream);
    assert_non_null(strstr(text, "  bending y                 31.25   128.50\n"));
    assert_non_null(strstr(text, "  rear adaptor leaves        160.4000 ms\n"));
    assert_non_null(strstr(text, "  exit speed                  37.7000 m/s\n"));
    static const char *const against_launcher =
        "  since ignition, angles      -0.8000      -1.0000 mrad\n"
        "  since ignition, roll       128.9155 deg\n"
        "  since ignition, rates      -270.000        8.000 ± 0.02 mrad/s\n"
        "  since ignition, vy, vz     -1.25000      5.25000 m/s\n"
        "  tip-off pitch, yaw          -7.0000       0.2000 mrad\n"
        "  tip-off rates              -260.000        7.000 ± 0.02 mrad/s\n"
        "  relative rates             -300.000       15.000 ± 0.02 mrad/s\n"
        "  tip-off vy, vz             -1.50000      5.12500 m/s\n"
        "  relative vy, vz            -0.37500     -0.02000 m/s\n"
        "  ground pitch, yaw          19.79569     -0.00573 deg\n"
        "  ground pitch, yaw rate      254.000       12.000 ± 1.2 mrad/s\n";
    assert_non_null(strstr(text, against_launcher));
    assert_null(strstr(text, "nan"));
    free(text);
}

static void test_table_marks_the_vertical(void **state)
{
    place *here = *state;
    ld_summary summary;
    made_summary(&summary, 1);
    static const struct {
        double pitch; // [deg]
        bool marked;
    } of[] = {{79.99, false}, {80.01, true}, {-80.01, true}, {-79.99, false}, {89.99, true}};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        char *text = NULL;
        size_t length = 0;
        FILE *stream = open_memstream(&text, &length);
        summary.rocket[0].pitch = of[i].pitch * 3.14159265358979323846 / 180;
        ld_summary_print(&here->model, &summary, stream);
        fclose(stream);
        int marks = 0;
        for (const char *at = text; (at = strstr(at, " (near the vertical)\n")); at++)
            marks++;
        assert_int_equal(marks, of[i].marked ? 2 : 0);
        assert_int_equal(strstr(text, "-0.00573 deg (near") != NULL, of[i].marked);
        assert_int_equal(strstr(text, "± 1.2 mrad/s (near") != NULL, of[i].marked);
        free(text);
    }
}

// An earlier run's files, its report too, stand until the next one is complete, then none of them
// is left.
static void test_replaces_an_earlier_run(void **state)
{
    place *here = *state;
    ld_error error = {0};
    ld_output *output;
    write_launch(here, "run", true, 100);
    printed_by("touch %s", in(here, "run/report.html"));
    assert_int_equal(ld_output_open(in(here, "run"), &here->model, false, &output, &error), LD_OK);
    assert_int_equal(made_run(ld_output_sink(output), 2000, &error), LD_OK);
    assert_true(exists(in(here, "run/history.h5.part")));
    ld_output_discard(output);
    assert_string_equal(printed_by("ls %s", in(here, "run")),
                        "history.csv\nhistory.h5\nreport.html\nsummary.json");
    write_launch(here, "run", false, 50);
    assert_string_equal(printed_by("ls %s", in(here, "run")), "history.h5\nsummary.json");
    history_data read;
    assert_int_equal(history_read(in(here, "run/history.h5"), &read, NULL), LD_OK);
    assert_int_equal(read.rows, 50);
    history_free(&read);
}

// Who waits for a lock here does so in no time.
int nanosleep(const struct timespec *asked, struct timespec *left)
{
    (void)asked, (void)left;
    return 0;
}

static bool no_locks; // as on a file system without them

int flock(int file, int operation)
{
    errno = ENOSYS;
    return no_locks ? -1 : (int)syscall(SYS_flock, file, operation);
}

static void expect_unfinished(ld_output *output, const char *text)
{
    ld_error error = {.text = ""};
    ld_summary summary;
    made_summary(&summary, 1);
    assert_int_equal(ld_output_finish(output, &summary, &error), LD_ERR_FILE);
    if (!strstr(error.text, text))
        fail_msg("\"%s\" does not say \"%s\"", error.text, text);
}

// A second run keeps away from the first one's files; each of those that are gone at the end is
// missed, and the earlier run's stand.
static void test_two_at_once(void **state)
{
    place *here = *state;
    ld_error error = {0};
    ld_output *output, *second = NULL;
    write_launch(here, "both", true, 100);
    const char *const earlier = "history.csv\nhistory.h5\nsummary.json";
    assert_string_equal(printed_by("ls -A %s", in(here, "both")), earlier);
    assert_int_equal(ld_output_open(in(here, "both"), &here->model, true, &output, &error), LD_OK);
    assert_int_equal(ld_output_open(in(here, "both"), &here->model, true, &second, &error),
                     LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "another launchdyn process uses "));
    assert_null(second);
    assert_int_equal(made_run(ld_output_sink(output), 2000, &error), LD_OK);
    assert_true(exists(in(here, "both/history.h5.part")));
    ld_output_discard(output);
    static const char *const parts[] = {"history.h5.part", "history.csv.part"};
    for (int i = 0; i < 2; i++) {
        char path[64];
        snprintf(path, sizeof path, "both/%s", parts[i]);
        assert_int_equal(ld_output_open(in(here, "both"), &here->model, true, &output, &error),
                         LD_OK);
        assert_int_equal(made_run(ld_output_sink(output), 2000, &error), LD_OK);
        assert_int_equal(unlink(in(here, path)), 0);
        expect_unfinished(output, "another program has removed ");
        assert_string_equal(printed_by("ls -A %s", in(here, "both")), earlier);
    }
    // without locks it is given at the end
    no_locks = true;
    assert_int_equal(ld_output_open(in(here, "both"), &here->model, false, &output, &error), LD_OK);
    assert_int_equal(ld_output_open(in(here, "both"), &here->model, false, &second, &error), LD_OK);
    assert_int_equal(made_run(ld_output_sink(output), 2000, &error), LD_OK);
    no_locks = false;
    expect_unfinished(output, "another program has removed ");
    ld_output_discard(second);
    assert_string_equal(printed_by("ls -A %s", in(here, "both")), earlier);
    write_launch(here, "both", true, 50);
}

// Whoever has to do with a folder that is gone is reported.
static void test_folder_removed(void **state)
{
    place *here = *state;
    ld_error error = {0};
    ld_output *output;
    assert_int_equal(ld_output_open(in(here, "gone"), &here->model, true, &output, &error), LD_OK);
    assert_int_equal(made_run(ld_output_sink(output), 2000, &error), LD_OK);
    printed_by("rm -r %s", in(here, "gone"));
    expect_unfinished(output, "cannot write ");
    assert_false(exists(in(here, "gone")));
}

static void test_discard_leaves_nothing(void **state)
{
    place *here = *state;
    ld_output *output;
    assert_int_equal(ld_output_open(in(here, "a/b/c"), &here->model, true, &output, NULL), LD_OK);
    assert_true(exists(in(here, "a/b/c/history.h5.part")));
    ld_output_discard(output);
    assert_false(exists(in(here, "a")));
    assert_true(exists(here->folder));
    ld_output_discard(NULL);
}

// Runs `work` in a child with the rights of an ordinary user; the child's exit status.
static int in_child(int (*work)(const place *), const place *here)
{
    fflush(stdout);
    pid_t child = fork();
    if (child == 0)
        _exit(work(here));
    int status = 0;
    waitpid(child, &status, 0);
    return status;
}

static int open_in_closed_folder(const place *here)
{
    if (getuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0))
        return 2;
    ld_error error = {0};
    ld_output *output = NULL;
    ld_status status = ld_output_open(in(here, "closed"), &here->model, true, &output, &error);
    printf("    %s\n", error.text);
    fflush(stdout);
    return status != LD_ERR_FILE || !strstr(error.text, "closed/history.lock: Permission denied");
}

static void test_closed_folder_is_one_message(void **state)
{
    place *here = *state;
    mkdir(in(here, "closed"), 0555);
    chmod(here->folder, 0755);
    assert_int_equal(in_child(open_in_closed_folder, here), 0);
    assert_string_equal(printed_by("ls %s", in(here, "closed")), "");
}

static void test_a_file_is_no_folder(void **state)
{
    place *here = *state;
    ld_error error = {0};
    ld_output *output = NULL;
    fclose(fopen(in(here, "file"), "w"));
    assert_int_equal(ld_output_open(in(here, "file"), &here->model, false, &output, &error),
                     LD_ERR_FILE);
    assert_non_null(strstr(error.text, "Not a directory"));
    assert_int_equal(ld_output_open(in(here, "file/x"), &here->model, false, &output, &error),
                     LD_ERR_FILE);
    assert_non_null(strstr(error.text, "Not a directory"));
}

// No file may grow beyond a limit: what a full disk looks like to the writers.
static int fill_the_disk(const place *here, bool csv, rlim_t limit, size_t rows)
{
    signal(SIGXFSZ, SIG_IGN);
    ld_error error = {0};
    ld_output *output = NULL;
    ld_summary summary;
    made_summary(&summary, 1);
    ld_status status = ld_output_open(in(here, "full"), &here->model, csv, &output, &error);
    setrlimit(RLIMIT_FSIZE, &(struct rlimit){limit, limit});
    if (!status)
        status = made_run(ld_output_sink(output), rows, &error);
    if (status)
        ld_output_discard(output);
    else
        status = ld_output_finish(output, &summary, &error);
    if (status != LD_ERR_FILE || !strstr(error.text, "File too large"))
        return 1;
    return exists(in(here, "full")) ? 3 : 0;
}

static int fill_in_a_block(const place *here)
{
    return fill_the_disk(here, false, 1 << 20, 5000);
}

static int fill_at_the_end(const place *here)
{
    return fill_the_disk(here, false, 1 << 18, 1000);
}

static int fill_with_csv(const place *here)
{
    return fill_the_disk(here, true, 3 << 19, 900);
}

static void test_full_disk_is_one_message(void **state)
{
    assert_int_equal(in_child(fill_in_a_block, *state), 0);
    assert_int_equal(in_child(fill_at_the_end, *state), 0);
    assert_int_equal(in_child(fill_with_csv, *state), 0);
}

static int killed_after_3000_rows(const place *here)
{
    ld_output *output;
    if (ld_output_open(in(here, "killed"), &here->model, false, &output, NULL) ||
        made_run(ld_output_sink(output), 3000, NULL))
        return 1;
    return raise(SIGKILL);
}

static void test_a_killed_run_can_be_read(void **state)
{
    place *here = *state;
    int status = in_child(killed_after_3000_rows, here);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    history_data read;
    assert_int_equal(history_read(in(here, "killed/history.h5.part"), &read, NULL), LD_OK);
    CHECK_WITHIN("rows of 3000 there after SIGKILL", (double)read.rows, 3000 - 1023, 3000);
    CHECK_BELOW("values of them that differ", (double)differences(&read), 0.0);
    assert_true(isnan(read.t_rear));
    history_free(&read);
    assert_non_null(
        strstr(printed_by("h5dump -a /complete %s", in(here, "killed/history.h5.part")), "(0): 0"));
}

static void test_unreadable_histories(void **state)
{
    place *here = *state;
    ld_error error = {0};
    history_data read;
    assert_int_equal(history_read(in(here, "none.h5"), &read, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "none.h5: No such file or directory"));
    FILE *file = fopen(in(here, "text.h5"), "w");
    fputs("no HDF5 at all", file);
    fclose(file);
    assert_int_equal(history_read(in(here, "text.h5"), &read, &error), LD_ERR_INPUT);
    printf("    %s\n", error.text);
}

// The ways in which HDF5 reads from another file.
enum { LINK_OUT, LINK_SOFT, DATA_OUT, DATA_VIRTUAL, WAYS };

// Puts in the place of the column t one of ten numbers that lie in the file `other`.
static void lead_away(const char *path, const char *other, int way)
{
    hsize_t rows = 10;
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), space = H5Screate_simple(1, &rows, NULL);
    hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    assert_true(H5Ldelete(file, "history/t", H5P_DEFAULT) >= 0);
    if (way == LINK_OUT)
        H5Lcreate_external(other, "history/t", file, "history/t", H5P_DEFAULT, H5P_DEFAULT);
    if (way == LINK_SOFT)
        H5Lcreate_soft("/history/tip.y", file, "history/t", H5P_DEFAULT, H5P_DEFAULT);
    if (way == DATA_OUT)
        H5Pset_external(properties, other, 0, H5F_UNLIMITED);
    if (way == DATA_VIRTUAL)
        H5Pset_virtual(properties, space, other, "history/t", space);
    if (way >= DATA_OUT)
        H5Dclose(H5Dcreate2(file, "history/t", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, properties,
                            H5P_DEFAULT));
    assert_true(H5Lexists(file, "history/t", H5P_DEFAULT) > 0);
    H5Pclose(properties);
    H5Sclose(space);
    H5Fclose(file);
}

static void test_histories_that_lead_to_other_files(void **state)
{
    place *here = *state;
    ld_error error = {0};
    history_data read;
    write_launch(here, "other", false, 10);
    for (int way = 0; way < WAYS; way++) {
        write_launch(here, "run", false, 10);
        lead_away(in(here, "run/history.h5"), in(here, "other/history.h5"), way);
        assert_int_equal(history_read(in(here, "run/history.h5"), &read, &error), LD_ERR_INPUT);
        assert_non_null(strstr(error.text, "run/history.h5: it links to other files"));
    }
}

static void test_bad_column_names(void **state)
{
    place *here = *state;
    ld_error error = {0};
    ld_output *output;
    const ld_column slash = {"a/b", "1", ""}, twice[] = {{"a", "1", ""}, {"a", "1", ""}};
    assert_int_equal(ld_output_open(in(here, "x"), &here->model, false, &output, &error), LD_OK);
    const ld_sink *sink = ld_output_sink(output);
    assert_int_equal(sink->begin(sink->self, &slash, 1, &error), LD_ERR_INPUT);
    ld_output_discard(output);
    assert_int_equal(ld_output_open(in(here, "x"), &here->model, false, &output, &error), LD_OK);
    sink = ld_output_sink(output);
    assert_int_equal(sink->begin(sink->self, twice, 2, &error), LD_ERR_FILE);
    ld_output_discard(output);
    assert_false(exists(in(here, "x")));
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_hdf5_holds_every_bit),
        TEST(test_earlier_histories_are_read),
        TEST(test_hdf5_is_read_by_others),
        TEST(test_same_run_same_bytes),
        TEST(test_csv_holds_every_bit),
        TEST(test_decimal_comma_stays_out),
        TEST(test_csv_quotes_names),
        TEST(test_summary_is_json),
        TEST(test_numbers_keep_17_digits),
        TEST(test_terminal_table),
        TEST(test_table_marks_the_vertical),
        TEST(test_replaces_an_earlier_run),
        TEST(test_two_at_once),
        TEST(test_folder_removed),
        TEST(test_discard_leaves_nothing),
        TEST(test_closed_folder_is_one_message),
        TEST(test_a_file_is_no_folder),
        TEST(test_full_disk_is_one_message),
        TEST(test_a_killed_run_can_be_read),
        TEST(test_unreadable_histories),
        TEST(test_bad_column_names),
        TEST(test_results_of_a_study_are_those_of_the_summary),
        TEST(test_histories_that_lead_to_other_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
