// ctest: slow
// Every number of summary.json, of the table after a run and of a study's results, by name, against
// the history's columns: a parked vehicle on uneven ground, from its equilibrium to the landing. A
// new number fails the test until what it ought to be is said here (support/column_book.h).
#include <sys/stat.h>

#include "launchdyn/output.h"
#include "math/vectors/mat3.h"
#include "math/vectors/quaternion.h"
#include "model/model.h"
#include "quantities/study_results.h"
#include "results/history.h"
#include "results/manifest.h"
#include "scenario/scenario.h"
#include "support/column_book.h"
#include "support/scratch.h"

static const double degree = 3.14159265358979323846 / 180;

typedef struct finished_run {
    ld_model model;
    ld_summary summary;
    history_data tube; // and the flight in it
    column_book json;  // every number of summary.json by its path
} finished_run;

// ---- the run

static void run_example(finished_run *run)
{
    const char *sets[] = {
        "base.speed=0 km/h",
        "base.road=",
        "base.road.sines=[{amplitude: 3 cm, wavelength: 9 m, phase: 40 deg}]",
        "base.road.bumps=[{at: 1 m, length: 4 m, height: 5 cm, tracks: left}]",
        "platform.azimuth.stabiliser.command=25 deg",
        "rocket.eccentricity=2 -1 mm",
        "tubes.slot.angle=-4 deg", // a slot force below 0
        "environment.earth=wgs84",
        "environment.site={latitude: 40 deg, longitude: 20 deg, azimuth: 70 deg, altitude: 300 m}",
        "environment.ground=200 m",
        "environment.wind={speed: 5 m/s, heading: 100 deg}",
        "run.lead_in=5 ms",
        "run.output_step={lead_in: 1 ms, tube: 0.02 ms, flight: 2 ms}",
        "run.max_step=0.02 ms", // peaks of contacts between steps
        "firing=[{tube: 5, at: 10 ms}]",
    };
    ld_messages messages;
    ld_error error;
    ld_simulation *simulation;
    ld_output *output;
    if (scenario_read(LD_SOURCE_DIR "/examples/reference.yaml", sets, sizeof sets / sizeof *sets,
                      &run->model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    if (ld_simulation_create(&run->model, &simulation, &error) ||
        ld_output_open(in("run"), &run->model, false, &output, &error) ||
        ld_simulation_run(simulation, &(ld_run_options){.sink = ld_output_sink(output)},
                          &run->summary, &error) ||
        ld_output_finish(output, &run->summary, &error) ||
        history_read(in("run/history.h5"), &run->tube, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    assert_int_equal(run->tube.flights, 1);
}

// The numbers of summary.json as a book of one row.
static void read_json(finished_run *run)
{
    static ld_column column[BOOK_COLUMNS];
    static char path[BOOK_COLUMNS][96];
    static double value[BOOK_COLUMNS];
    char command[256];
    column_book *book = &run->json;
    snprintf(command, sizeof command,
             "jq -r 'paths(type == \"number\") as $p |"
             " \"\\($p | map(tostring) | join(\".\")) \\(getpath($p))\"' %s",
             in("run/summary.json"));
    FILE *list = popen(command, "r");
    assert_non_null(list);
    for (size_t i = 0; fscanf(list, "%95s %lf", path[i], &value[i]) == 2; i++) {
        assert_true(i + 1 < BOOK_COLUMNS);
        column[i].name = path[i];
        book->count = i + 1;
    }
    assert_int_equal(pclose(list), 0);
    book->column = column;
    book->row = value;
}

// ---- the columns

static const double *named(const history_data *history, const char *name)
{
    const double *column = history_column(history, name);
    if (!column)
        fail_msg("no column %s", name);
    return column;
}

static double first_of(const history_data *history, const char *name)
{
    return named(history, name)[0];
}

static double last_of(const history_data *history, const char *name)
{
    return named(history, name)[history->rows - 1];
}

static double largest_of(const history_data *history, const char *name)
{
    double largest = 0;
    for (size_t i = 0; i < history->rows; i++)
        largest = fmax(largest, fabs(named(history, name)[i])); // fmax leaves NaN out
    return largest;
}

static v3 triple(const history_data *history, const char *stem, const char *const letters[3],
                 size_t row)
{
    double value[3];
    for (int i = 0; i < 3; i++) {
        char name[96];
        snprintf(name, sizeof name, "%s%s", stem, letters[i]);
        value[i] = named(history, name)[row];
    }
    return v3_from(value);
}

static const char *const xyz[] = {"x", "y", "z"};
static const char *const digits[] = {"0", "1", "2"};

static void expect_triple(column_book *book, const char *stem, v3 a)
{
    double value[3];
    v3_store(value, a);
    expect3(book, stem, digits, value);
}

static m3 pose(const history_data *history, const char *part, size_t row)
{
    static const char *const angles[] = {"yaw", "pitch", "roll"};
    v3 a = triple(history, part, angles, row);
    return m3_mul(m3_rotation_y(a.x), m3_mul(m3_rotation_z(a.y), m3_rotation_x(a.z)));
}

// The last instant at which the column holds a number [s], from ignition.
static double gone(const finished_run *run, const char *name)
{
    size_t i = run->tube.rows;
    while (i > 0 && isnan(named(&run->tube, name)[i - 1]))
        i--;
    return named(&run->tube, "t")[i - 1] - run->model.firing[0].at;
}

static size_t row_at(const history_data *history, double t)
{
    size_t row = 0;
    while (row + 1 < history->rows && named(history, "t")[row] < t)
        row++;
    return row;
}

// The Earth's rotation in the rocket's axes at the flight's row.
static v3 turn_of_earth(const finished_run *run, size_t row)
{
    const double rate = 7.292115e-5;
    const ld_site *site = &run->model.environment.site;
    v3 turn = v3_scale(rate, v3_make(cos(site->latitude) * cos(site->azimuth), sin(site->latitude),
                                     -cos(site->latitude) * sin(site->azimuth)));
    const history_data *flight = run->tube.flight;
    quat q = {named(flight, "rocket.q0")[row], named(flight, "rocket.q1")[row],
              named(flight, "rocket.q2")[row], named(flight, "rocket.q3")[row]};
    return m3_apply_transposed(q_matrix(q), turn);
}

// ---- what is said of a rocket; `at`: the path of its block, with a dot at its end

typedef struct saying {
    const char *name, *column;
} saying;

static void say(column_book *book, const char *at, const saying *says, size_t count,
                const history_data *history)
{
    for (size_t i = 0; i < count; i++) {
        char name[96];
        snprintf(name, sizeof name, "%s%s", at, says[i].name);
        expect(book, name, last_of(history, says[i].column));
    }
}

#define COUNT(list) (sizeof(list) / sizeof *(list))

// Both in summary.json and among the results of a study.
static const saying at_exit[] = {
    {"exit_speed", "rocket.s_dot"},
    {"spin_rate", "rocket.spin"},
    {"pitch", "rocket.pitch"},
    {"yaw", "rocket.yaw"},
    {"pitch_rate", "rocket.pitch_rate"},
    {"yaw_rate", "rocket.yaw_rate"},
    {"tip.y", "tip.y"},
    {"tip.z", "tip.z"},
    {"tip.pitch", "tip.pitch"},
    {"tip.yaw", "tip.yaw"},
    {"tip.vy", "tip.vy"},
    {"tip.vz", "tip.vz"},
    {"tip.pitch_rate", "tip.pitch_rate"},
    {"tip.yaw_rate", "tip.yaw_rate"},
    {"tip_off.pitch", "tip_off.pitch"},
    {"tip_off.yaw", "tip_off.yaw"},
    {"tip_off.pitch_rate", "tip_off.pitch_rate"},
    {"tip_off.yaw_rate", "tip_off.yaw_rate"},
    {"tip_off.pitch_rate_relative", "tip_off.pitch_rate_relative"},
    {"tip_off.yaw_rate_relative", "tip_off.yaw_rate_relative"},
    {"tip_off.vy", "tip_off.vy"},
    {"tip_off.vz", "tip_off.vz"},
    {"tip_off.vy_relative", "tip_off.vy_relative"},
    {"tip_off.vz_relative", "tip_off.vz_relative"},
    {"since_ignition.pitch", "since_ignition.pitch"},
    {"since_ignition.yaw", "since_ignition.yaw"},
    {"since_ignition.roll", "since_ignition.roll"},
    {"since_ignition.pitch_rate", "since_ignition.pitch_rate"},
    {"since_ignition.yaw_rate", "since_ignition.yaw_rate"},
    {"since_ignition.roll_rate", "since_ignition.roll_rate"},
    {"since_ignition.vy", "since_ignition.vy"},
    {"since_ignition.vz", "since_ignition.vz"},
};

static const saying relative[] = {
    {"relative.y", "rocket.y"},         {"relative.z", "rocket.z"},
    {"relative.psi", "rocket.psi"},     {"relative.theta", "rocket.theta"},
    {"relative.gamma", "rocket.gamma"}, {"relative.w_x", "rocket.w_x"},
    {"relative.w_y", "rocket.w_y"},     {"relative.w_z", "rocket.w_z"},
};

static const saying at_landing[] = {
    {"final.t", "t"},
    {"final.position.0", "rocket.x"},
    {"final.position.1", "rocket.y"},
    {"final.position.2", "rocket.z"},
    {"final.velocity.0", "rocket.vx"},
    {"final.velocity.1", "rocket.vy"},
    {"final.velocity.2", "rocket.vz"},
    {"final.quaternion.0", "rocket.q0"},
    {"final.quaternion.1", "rocket.q1"},
    {"final.quaternion.2", "rocket.q2"},
    {"final.quaternion.3", "rocket.q3"},
    {"final.center.0", "center.x"},
    {"final.center.1", "center.y"},
    {"final.center.2", "center.z"},
    {"final.center_velocity.0", "center.vx"},
    {"final.center_velocity.1", "center.vy"},
    {"final.center_velocity.2", "center.vz"},
    {"final.latitude", "latitude"},
    {"final.longitude", "longitude"},
    {"final.altitude", "altitude"},
    {"final.velocity_ned.0", "v_north"},
    {"final.velocity_ned.1", "v_east"},
    {"final.velocity_ned.2", "v_down"},
    {"final.heading", "heading"},
    {"final.pitch", "local_pitch"},
    {"final.roll", "local_roll"},
    {"final.rate_inertial.0", "rocket.wx"},
    {"final.rate_inertial.1", "rocket.wy"},
    {"final.rate_inertial.2", "rocket.wz"},
};

static void expect_at(column_book *book, const char *at, const char *name, double value)
{
    char text[96];
    snprintf(text, sizeof text, "%s%s", at, name);
    expect(book, text, value);
}

// Instants; the lock holds up to the last row of phase 1.
static void say_instants(const finished_run *run, column_book *book, const char *at)
{
    const double *t = named(&run->tube, "t"), *phase = named(&run->tube, "phase");
    double t_ignition = run->model.firing[0].at;
    size_t held = 0;
    for (size_t i = 0; i < run->tube.rows; i++)
        held = phase[i] == 1 ? i : held;
    expect_at(book, at, "t_ignition", t_ignition);
    expect_at(book, at, "t_release", t[held] - t_ignition);
    expect_at(book, at, "t_front", gone(run, "contact.front.y"));
    expect_at(book, at, "t_middle", gone(run, "contact.middle.y"));
    expect_at(book, at, "t_rear", gone(run, "contact.rear.y"));
}

// The flight's numbers; its names begin with `at`.
static void say_flight(const finished_run *run, column_book *book, const char *at)
{
    const history_data *flight = run->tube.flight, *tube = &run->tube;
    size_t last = flight->rows - 1, lit = row_at(tube, run->model.firing[0].at);
    // the rear adaptor at ignition, on a tube that hardly bends
    v3 from = v3_add(triple(tube, "base.", xyz, lit),
                     m3_apply(pose(tube, "base.", lit),
                              v3_make(named(tube, "rocket.s")[lit], named(tube, "rocket.y")[lit],
                                      named(tube, "rocket.z")[lit])));
    v3 hit = triple(flight, "center.", xyz, last), v = triple(flight, "center.v", xyz, last);
    double t = named(flight, "t")[last];
    size_t top = 0, pressed = 0, pushed = 1;
    const double *time = named(flight, "t"), *density = named(flight, "density"),
                 *speed = named(flight, "airspeed"), *height = named(flight, "altitude");
    double q = 0, a = 0;
    for (size_t i = 0; i < flight->rows; i++) {
        top = height[i] > height[top] ? i : top;
        pressed = density[i] * speed[i] * speed[i] > q ? i : pressed;
        q = fmax(q, density[i] * speed[i] * speed[i]);
    }
    // mean from row to row, against the ground
    for (size_t i = 1; i < flight->rows; i++) {
        v3 gained =
            v3_sub(triple(flight, "center.v", xyz, i), triple(flight, "center.v", xyz, i - 1));
        double mean = v3_norm(gained) / (time[i] - time[i - 1]);
        pushed = mean > a ? i : pushed;
        a = fmax(a, mean);
    }
    double t0 = run->model.firing[0].at;
    const ld_rocket *rocket = &run->model.rocket;
    double burnt = (rocket->full.mass - first_of(flight, "rocket.mass")) /
                   (rocket->full.mass - rocket->empty.mass);
    double center =
        rocket->full.center[0] + burnt * (rocket->empty.center[0] - rocket->full.center[0]);
    // the table's centre of pressure below Mach 0.4
    expect_at(book, at, "stability_margin", (center - 0.838) / 0.164);
    expect_at(book, at, "apogee",
              largest_of(flight, "altitude") - run->model.environment.ground_height);
    expect_at(book, at, "apogee_altitude", largest_of(flight, "altitude"));
    expect_at(book, at, "t_apogee", time[top] - t0);
    expect_at(book, at, "max_dynamic_pressure", q / 2);
    expect_at(book, at, "t_max_dynamic_pressure", time[pressed] - t0);
    expect_at(book, at, "max_acceleration", a);
    expect_at(book, at, "t_max_acceleration", time[pushed] - t0);
    expect_at(book, at, "downrange", hit.x - from.x);
    expect_at(book, at, "drift", hit.z - from.z);
    expect_at(book, at, "range", hypot(hit.x - from.x, hit.z - from.z));
    expect_at(book, at, "t_impact", t - run->model.firing[0].at);
    expect_at(book, at, "time_of_flight", t - named(flight, "t")[0]);
    expect_at(book, at, "impact_speed", v3_norm(v));
    expect_at(book, at, "impact_angle", asin(last_of(flight, "v_down") / v3_norm(v)));
    expect_at(book, at, "max_mach", largest_of(flight, "mach"));
    expect_at(book, at, "max_angle_of_attack", largest_of(flight, "angle_of_attack"));
}

// The rocket at its exit by the launcher's columns alone: turned by `gamma` about its own axis,
// which is that of the tip but for psi and theta.
typedef struct exit_state {
    v3 place, rate; // O1 in I; of B against I, in B
    quat q;
} exit_state;

// Roll of the tube's tip in I, nearly that of its floating frame.
static double roll_of(const history_data *tube)
{
    quat q = {last_of(tube, "tube.q0"), last_of(tube, "tube.q1"), last_of(tube, "tube.q2"),
              last_of(tube, "tube.q3")};
    m3 A = q_matrix(q);
    return atan2(-A.a[1][2], A.a[1][1]);
}

static exit_state exit_of(const history_data *tube)
{
    double pitch = last_of(tube, "rocket.pitch"), yaw = last_of(tube, "rocket.yaw");
    double pitch_rate = last_of(tube, "rocket.pitch_rate"),
           yaw_rate = last_of(tube, "rocket.yaw_rate");
    m3 level = m3_mul(m3_rotation_y(yaw), m3_rotation_z(pitch));
    m3 A = m3_mul(level, m3_rotation_x(roll_of(tube) + last_of(tube, "rocket.gamma")));
    m3 tip = m3_mul(
        m3_rotation_y(last_of(tube, "tip.inertial_yaw")),
        m3_mul(m3_rotation_z(last_of(tube, "tip.inertial_pitch")), m3_rotation_x(roll_of(tube))));
    // w = spin d + d x d_dot, d_dot from pitch and yaw
    v3 d = m3_column(level, 0);
    v3 d_dot = v3_add(v3_scale(pitch_rate, m3_column(level, 1)),
                      v3_scale(-yaw_rate * cos(pitch), m3_column(level, 2)));
    v3 w = v3_add(v3_scale(last_of(tube, "rocket.spin"), d), v3_cross(d, d_dot));
    v3 offset = v3_make(0, last_of(tube, "rocket.y"), last_of(tube, "rocket.z"));
    return (exit_state){
        .place = v3_add(triple(tube, "tip.inertial_", xyz, tube->rows - 1), m3_apply(tip, offset)),
        .rate = m3_apply_transposed(A, w),
        .q = q_from_matrix(A),
    };
}

static void say_exit(const finished_run *run, column_book *book)
{
    const char *at = "rockets.0.";
    exit_state found = exit_of(&run->tube);
    expect_triple(book, "rockets.0.exit.position.", found.place);
    expect_triple(book, "rockets.0.exit.velocity.",
                  triple(&run->tube, "rocket.v", xyz, run->tube.rows - 1));
    expect_triple(book, "rockets.0.exit.rate.", found.rate);
    for (int i = 0; i < 4; i++) {
        char name[40];
        snprintf(name, sizeof name, "rockets.0.exit.quaternion.%d", i);
        expect(book, name, (double[]){found.q.w, found.q.x, found.q.y, found.q.z}[i]);
    }
    expect_at(book, at, "inertial_speed",
              v3_norm(triple(&run->tube, "rocket.v", xyz, run->tube.rows - 1)));
}

static const char *const adaptors[] = {"rear", "middle", "front"};

static void say_peaks(const finished_run *run, column_book *book, const char *at)
{
    for (int i = 0; i < 3; i++) {
        char name[64], column[64];
        snprintf(column, sizeof column, "contact.%s.force", adaptors[i]);
        snprintf(name, sizeof name, "max_contact_force.%s", adaptors[i]);
        expect_at(book, at, name, largest_of(&run->tube, column));
    }
    expect_at(book, at, "max_slot_force", largest_of(&run->tube, "slot.force"));
}

// By so short steps the rates are as good as their tolerance, of which three times are reported.
static double say_exit_error(const finished_run *run, column_book *book, const char *at)
{
    double rates =
        hypot(last_of(&run->tube, "tip_off.pitch_rate"), last_of(&run->tube, "tip_off.yaw_rate"));
    double told = 3 * run->model.run.tolerance * rates;
    expect_at(book, at, "exit_error.rates", told);
    expect_at(book, at, "exit_error.relative", told / rates);
    return told;
}

// How a hinge was held from the ignition to the exit, by the rows.
static void say_hinge(const finished_run *run, column_book *book, const char *at, const char *hinge)
{
    const history_data *tube = &run->tube;
    const double *t = named(tube, "t"), ignition = run->model.firing[0].at;
    const char *const what[] = {"error", "torque", "rate"};
    const double *column[3];
    for (int i = 0; i < 3; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s.%s", hinge, what[i]);
        column[i] = named(tube, path);
    }
    double sum[3] = {0}, peak[2] = {0}, before[3] = {0}, since = 0;
    for (size_t i = 0; i < tube->rows; i++) {
        double torque = column[1][i], power = fabs(torque * column[2][i]);
        const double now[] = {column[0][i] * column[0][i], torque * torque, power};
        if (t[i] < ignition)
            continue;
        for (int k = 0; k < 3; k++) {
            sum[k] += 0.5 * (t[i] - ignition - since) * (before[k] + now[k]);
            before[k] = now[k];
        }
        since = t[i] - ignition;
        peak[0] = fmax(peak[0], fabs(torque));
        peak[1] = fmax(peak[1], power);
    }
    const struct {
        const char *name;
        double value;
    } held[] = {{"error_rms", sqrt(sum[0] / since)},
                {"torque_rms", sqrt(sum[1] / since)},
                {"torque_peak", peak[0]},
                {"saturated", 0},
                {"power_mean", sum[2] / since},
                {"power_peak", peak[1]}};
    for (size_t i = 0; i < COUNT(held); i++) {
        char name[64];
        snprintf(name, sizeof name, "%s.%s", hinge, held[i].name);
        expect_at(book, at, name, held[i].value);
    }
}

static void say_rocket(finished_run *run)
{
    const char *at = "rockets.0.";
    column_book *book = &run->json;
    say_instants(run, book, at);
    say(book, at, at_exit, COUNT(at_exit), &run->tube);
    say(book, at, relative, COUNT(relative), &run->tube);
    say(book, at, at_landing, COUNT(at_landing), run->tube.flight);
    say_exit(run, book);
    say_peaks(run, book, at);
    double told = say_exit_error(run, book, at);
    expect_at(book, at, "exit_error.yaw_rate", told / cos(last_of(&run->tube, "rocket.pitch")));
    say_hinge(run, book, at, "azimuth");
    say_hinge(run, book, at, "elevation");
    say_flight(run, book, "rockets.0.flight.");
    size_t last = run->tube.flight->rows - 1;
    expect_triple(
        book, "rockets.0.final.rate.",
        v3_sub(triple(run->tube.flight, "rocket.w", xyz, last), turn_of_earth(run, last)));
    for (int i = 0; i < 3; i++) {
        char name[64], column[64];
        snprintf(column, sizeof column, "contact.%s.y", adaptors[i]);
        snprintf(name, sizeof name, "t_exit.%s", adaptors[i]);
        expect_at(book, at, name, gone(run, column));
    }
    expect_at(book, at, "tube", run->model.firing[0].tube);
    expect_at(book, at, "energy_dropped", 0);
}

// ---- the rest of summary.json

// Of a parked vehicle the first row is the equilibrium.
static void say_equilibrium(finished_run *run)
{
    column_book *book = &run->json;
    const history_data *tube = &run->tube;
    const ld_vehicle *vehicle = &run->model.base.vehicle;
    const saying says[] = {
        {"lock_force", "lock.force"},
        {"breech_force", "breech.force"},
        {"slot_force", "slot.force"},
        {"contact_force.rear", "contact.rear.normal"},
        {"contact_force.middle", "contact.middle.normal"},
        {"contact_force.front", "contact.front.normal"},
        {"tip_sag.y", "tip.y"},
        {"tip_sag.z", "tip.z"},
        {"chassis.y", "chassis.y"},
        {"chassis.pitch", "chassis.pitch"},
        {"chassis.roll", "chassis.roll"},
        {"azimuth.angle", "azimuth.angle"},
        {"azimuth.torque", "azimuth.torque"},
        {"elevation.angle", "elevation.angle"},
        {"elevation.torque", "elevation.torque"},
    };
    for (size_t i = 0; i < COUNT(says); i++)
        expect_at(book, "equilibrium.", says[i].name, first_of(tube, says[i].column));
    expect(book, "equilibrium.residual", 0);
    m3 A = pose(tube, "chassis.", 0);
    for (int i = 0; i < vehicle->wheel_count; i++) {
        char part[80], at[64], stem[96];
        snprintf(part, sizeof part, "wheel.%s.", vehicle->wheel[i].name);
        snprintf(at, sizeof at, "equilibrium.wheels.%d.", i);
        snprintf(stem, sizeof stem, "%ssuspension.", at);
        v3 arm = v3_sub(triple(tube, part, xyz, 0), triple(tube, "chassis.", xyz, 0));
        expect_triple(book, stem,
                      v3_sub(m3_apply_transposed(A, arm), v3_from(vehicle->wheel[i].mount)));
        snprintf(stem, sizeof stem, "%styre_force", part);
        expect_at(book, at, "tyre_force", first_of(tube, stem));
        snprintf(stem, sizeof stem, "%sdeflection", part);
        expect_at(book, at, "tyre_deflection", first_of(tube, stem));
    }
}

static void say_energy(finished_run *run)
{
    column_book *book = &run->json;
    double largest = 0;
    for (size_t i = 0; i < run->tube.columns; i++) {
        const char *name = run->tube.name[i];
        char path[96];
        snprintf(path, sizeof path, "energy.%s", name);
        if (strncmp(name, "work.", 5) == 0) {
            expect(book, path, last_of(&run->tube, name));
            if (strcmp(name, "work.base") != 0)
                largest = fmax(largest, fabs(last_of(&run->tube, name)));
        } else if (strncmp(name, "energy.", 7) == 0) {
            expect(book, name, last_of(&run->tube, name));
        }
    }
    expect(book, "energy.residual_relative", last_of(&run->tube, "energy.residual") / largest);
}

// Counts and times of the machine are but looked up; frequencies are the matter of other tests.
static void say_machine(finished_run *run)
{
    column_book *book = &run->json;
    const ld_statistics *statistics = &run->summary.statistics;
    expect(book, "format", 2);
    int files = 0;
    for (int i = 0; i < MANIFEST_FILES; i++) {
        struct stat about;
        char path[64], name[32];
        snprintf(path, sizeof path, "run/%s", manifest_name[i]);
        snprintf(name, sizeof name, "files.%d.size", files);
        if (stat(in(path), &about) == 0) {
            expect(book, name, (double)about.st_size);
            files++;
        }
    }
    expect(book, "source.point", 0); // of no study
    expect(book, "source.sample", 0);
    expect(book, "t_end", last_of(&run->tube, "t"));
    expect(book, "statistics.steps", (double)statistics->steps);
    expect(book, "statistics.rhs_evaluations", (double)statistics->rhs_evaluations);
    expect(book, "statistics.cpu_seconds", statistics->cpu_seconds);
    expect(book, "statistics.cpu_seconds_setup", statistics->cpu_seconds_setup);
    for (int i = 0; i < run->summary.mode_count; i++) {
        const ld_mode *mode = &run->summary.mode[i];
        char at[32];
        snprintf(at, sizeof at, "modes.%d.", i);
        expect_at(book, at, "frequency", mode->frequency);
        expect_at(book, at, "damping", mode->damping);
        expect_at(book, at, "real", -mode->damping * 360 * degree * mode->frequency);
    }
}

// Largest values lie between the rows, the launch point on a tube that hardly bends.
static const column_bound bounds[] = {
    {"*energy_dropped", 0, true},
    {"energy.work.drive", 0, true},   // parked
    {"*final.altitude", 1e-8, false}, // small beside the radius of the Earth
    {"source.*", 0, true},
    {"equilibrium.residual", 1e-5, true},
    {"equilibrium.breech_force", 0, true}, // the lock holds
    {"equilibrium.contact_force.*", 1e-7, true},
    {"equilibrium.azimuth.torque", 1e-8, false}, // the stabiliser against what it is to hold
    {"equilibrium.*", 1e-9, false},
    {"*exit.position.*", 1e-6, false},
    {"*exit.rate.0", 1e-11, false},
    {"*exit.rate.*", 2e-3, false}, // torsion of the tube from its floating frame to the tip
    {"*exit.quaternion.*", 1e-3, false},
    {"exit.[xyz]", 1e-9, false},
    {"*max_contact_force*", 6e-5, false},
    {"*max_slot_force", 2e-5, false},
    {"*_rms", 1e-3, false},
    {"*saturated", 0, true},
    {"*power_mean", 1e-3, false},
    {"*torque_peak", 1e-4, false},
    {"*power_peak", 1e-3, false},
    {"*apogee", 1e-7, false},
    {"*apogee_altitude", 1e-7, false},
    {"*downrange", 1e-8, false},
    {"*drift", 1e-8, false},
    {"*range", 1e-8, false},
    {"*max_mach", 5e-6, false},
    {"*t_max_*", 5e-4, false},
    {"*max_dynamic_pressure", 1e-5, false},
    {"*max_acceleration", 1e-4, false}, // the Earth turns, the thrust changes within a row

    {"*max_angle_of_attack", 1e-3, false},
    {"energy.residual*", 1e-9, false},
    {"modes.*.real", 1e-12, false},
    {"*", 1e-11, false},
};

static void test_json(void **state)
{
    finished_run *run = *state;
    say_rocket(run);
    say_equilibrium(run);
    say_energy(run);
    say_machine(run);
    check_book(&run->json, bounds, COUNT(bounds));
}

// Pitch and yaw of the flight change by the integrals of their rates, which are against the ground:
// the Earth's own rate would add up to hundredths of a radian.
static void test_rates_of_flight(void **state)
{
    finished_run *run = *state;
    const history_data *flight = run->tube.flight;
    const double *t = named(flight, "t");
    static const char *const angles[] = {"rocket.pitch", "rocket.yaw"};
    for (int k = 0; k < 2; k++) {
        char name[32];
        snprintf(name, sizeof name, "%s_rate", angles[k]);
        const double *rate = named(flight, name);
        double sum = 0;
        for (size_t i = 1; i < flight->rows; i++)
            sum += 0.5 * (rate[i] + rate[i - 1]) * (t[i] - t[i - 1]);
        double change = last_of(flight, angles[k]) - first_of(flight, angles[k]);
        printf("  %s, over %.0f s\n", angles[k], t[flight->rows - 1] - t[0]);
        CHECK_BELOW("change less the integral of the rate [rad]", change - sum, 1e-5);
    }
}

// ---- results of a study

static void test_study_results(void **state)
{
    finished_run *run = *state;
    static ld_column column[BOOK_COLUMNS];
    static char name[BOOK_COLUMNS][QUANTITY_NAME];
    static double value[BOOK_COLUMNS];
    const quantity_things things = quantity_things_of(&run->model);
    column_book *book = calloc(1, sizeof *book);
    book->column = column;
    book->row = value;
    for (quantity_walk r = study_result_first(&things); r.row; study_result_next(&r)) {
        study_result_name(&r, name[book->count]);
        column[book->count] = (ld_column){.name = name[book->count], .unit = r.row->unit};
        value[book->count++] = quantity_value(&r, &run->summary.rocket[0]);
    }
    say_instants(run, book, "");
    say_peaks(run, book, "");
    say_exit_error(run, book, "");
    say_hinge(run, book, "", "azimuth");
    say_hinge(run, book, "", "elevation");
    say(book, "", at_exit, COUNT(at_exit), &run->tube);
    say_flight(run, book, "");
    v3 place = triple(run->tube.flight, "rocket.", xyz, 0);
    v3 velocity = triple(&run->tube, "rocket.v", xyz, run->tube.rows - 1);
    expect3(book, "exit.", xyz, (double[]){place.x, place.y, place.z});
    expect3(book, "exit.v", xyz, (double[]){velocity.x, velocity.y, velocity.z});
    expect(book, "inertial_speed", v3_norm(velocity));
    check_book(book, bounds, COUNT(bounds));
    free(book);
}

// ---- the table after a run

// What the lines hold: numbers of summary.json; NULL: nothing of it.
static const struct {
    const char *label, *path[2];
} lines[] = {
    {"lock force", {"equilibrium.lock_force"}},
    {"slot force", {"equilibrium.slot_force"}},
    {"contact rear", {"equilibrium.contact_force.rear"}},
    {"contact middle", {"equilibrium.contact_force.middle"}},
    {"contact front", {"equilibrium.contact_force.front"}},
    {"tip sag y, z", {"equilibrium.tip_sag.y", "equilibrium.tip_sag.z"}},
    {"lock release", {"rockets.0.t_release"}},
    {"front adaptor leaves", {"rockets.0.t_front"}},
    {"middle adaptor leaves", {"rockets.0.t_middle"}},
    {"rear adaptor leaves", {"rockets.0.t_rear"}},
    {"exit speed", {"rockets.0.exit_speed"}},
    {"inertial speed", {"rockets.0.inertial_speed"}},
    {"spin rate", {"rockets.0.spin_rate"}},
    {"since ignition, angles", {"rockets.0.since_ignition.pitch", "rockets.0.since_ignition.yaw"}},
    {"since ignition, roll", {"rockets.0.since_ignition.roll"}},
    {"since ignition, rates",
     {"rockets.0.since_ignition.pitch_rate", "rockets.0.since_ignition.yaw_rate"}},
    {"since ignition, vy, vz", {"rockets.0.since_ignition.vy", "rockets.0.since_ignition.vz"}},
    {"tip-off pitch, yaw", {"rockets.0.tip_off.pitch", "rockets.0.tip_off.yaw"}},
    {"tip-off rates", {"rockets.0.tip_off.pitch_rate", "rockets.0.tip_off.yaw_rate"}},
    {"relative rates",
     {"rockets.0.tip_off.pitch_rate_relative", "rockets.0.tip_off.yaw_rate_relative"}},
    {"tip-off vy, vz", {"rockets.0.tip_off.vy", "rockets.0.tip_off.vz"}},
    {"relative vy, vz", {"rockets.0.tip_off.vy_relative", "rockets.0.tip_off.vz_relative"}},
    {"ground pitch, yaw", {"rockets.0.pitch", "rockets.0.yaw"}},
    {"ground pitch, yaw rate", {"rockets.0.pitch_rate", "rockets.0.yaw_rate"}},
    {"tip y, z", {"rockets.0.tip.y", "rockets.0.tip.z"}},
    {"tip pitch, yaw rate", {"rockets.0.tip.pitch_rate", "rockets.0.tip.yaw_rate"}},
    {"largest force, rear", {"rockets.0.max_contact_force.rear"}},
    {"largest force, middle", {"rockets.0.max_contact_force.middle"}},
    {"largest force, front", {"rockets.0.max_contact_force.front"}},
    {"largest slot force", {"rockets.0.max_slot_force"}},
    {"azimuth error", {"rockets.0.azimuth.error_rms"}},
    {"azimuth torque", {"rockets.0.azimuth.torque_rms", "rockets.0.azimuth.torque_peak"}},
    {"azimuth power", {"rockets.0.azimuth.power_mean", "rockets.0.azimuth.power_peak"}},
    {"elevation error", {"rockets.0.elevation.error_rms"}},
    {"elevation torque", {"rockets.0.elevation.torque_rms", "rockets.0.elevation.torque_peak"}},
    {"elevation power", {"rockets.0.elevation.power_mean", "rockets.0.elevation.power_peak"}},
    {"stability margin", {"rockets.0.flight.stability_margin"}},
    {"apogee above ground", {"rockets.0.flight.apogee"}},
    {"apogee above sea level", {"rockets.0.flight.apogee_altitude"}},
    {"apogee from ignition", {"rockets.0.flight.t_apogee"}},
    {"downrange, drift", {"rockets.0.flight.downrange", "rockets.0.flight.drift"}},
    {"range", {"rockets.0.flight.range"}},
    {"landing from ignition", {"rockets.0.flight.t_impact"}},
    {"time of flight", {"rockets.0.flight.time_of_flight"}},
    {"landing speed", {"rockets.0.flight.impact_speed"}},
    {"landing angle", {"rockets.0.flight.impact_angle"}},
    {"largest Mach number", {"rockets.0.flight.max_mach"}},
    {"dynamic pressure, peak", {"rockets.0.flight.max_dynamic_pressure"}},
    {"acceleration in flight", {"rockets.0.flight.max_acceleration"}},
    {"largest angle of attack", {"rockets.0.flight.max_angle_of_attack"}},
    {"energy residual", {"energy.residual"}},
    {"steps", {"statistics.steps"}},
    {"CPU time", {NULL}},
};

static double unit_of(const char *text)
{
    static const struct {
        const char *name;
        double factor;
    } units[] = {{"mm", 1e-3}, {"ms", 1e-3},     {"mrad", 1e-3},
                 {"kPa", 1e3}, {"mrad/s", 1e-3}, {"deg", 3.14159265358979323846 / 180}};
    for (size_t i = 0; i < COUNT(units); i++)
        if (strcmp(text, units[i].name) == 0)
            return units[i].factor;
    return 1;
}

// " ± number" at the end of a line of rates: their error, to the two digits that are shown, and
// where that is less to the last digit of the rates.
static const char *check_error(const finished_run *run, const char *text, const char *field,
                               size_t which)
{
    const char *sign = strstr(field, "± "), *path = "rockets.0.exit_error.rates";
    bool rates = strstr(lines[which].label, "rate") && !strstr(lines[which].label, "spin") &&
                 !strstr(lines[which].label, "tip pitch");
    if ((sign != NULL) != rates)
        fail_msg("%s: an error is told of rates at the exit alone", text);
    if (!sign)
        return field;
    if (strcmp(lines[which].path[0], "rockets.0.pitch_rate") == 0)
        path = "rockets.0.exit_error.yaw_rate";
    char *end;
    double told = strtod(sign + strlen("± "), &end), error = column_value(&run->json, path) / 1e-3;
    if (!(fabs(told - fmax(error, 1e-3)) <= 0.051 * told))
        fail_msg("%s: expected an error of %.9g", text, error);
    return end;
}

// A line "  label   number [number] [± error] unit": each number is that of its path, to its last
// digit.
static void check_line(const finished_run *run, const char *text, size_t which)
{
    const char *field = text + 25;
    double number[2], digit[2];
    char *end, unit[16] = "";
    int count = 0;
    while (count < 2 && (number[count] = strtod(field, &end), end > field)) {
        const char *point = memchr(field, '.', (size_t)(end - field));
        digit[count++] = point ? pow(10, -(double)(end - point - 1)) : 1;
        field = end;
    }
    field = check_error(run, text, field, which);
    sscanf(field, " %15[^ ,]", unit);
    for (int k = 0; k < 2 && lines[which].path[k]; k++) {
        double value = column_value(&run->json, lines[which].path[k]) / unit_of(unit);
        if (strchr(text, 'e') && strstr(text, "residual"))
            digit[k] = 1e-3 * fabs(value);
        if (k >= count || !(fabs(number[k] - value) <= 0.51 * digit[k]))
            fail_msg("%s: expected %.9g", text, value);
    }
}

static void test_table(void **state)
{
    finished_run *run = *state;
    char *text = NULL;
    size_t length = 0;
    bool seen[COUNT(lines)] = {false};
    FILE *stream = open_memstream(&text, &length);
    ld_summary_print(&run->model, &run->summary, stream);
    fclose(stream);
    const char *from = strstr(text, "\nEquilibrium");
    assert_non_null(from);
    for (char *line = strtok(text + (from - text), "\n"); line; line = strtok(NULL, "\n")) {
        if (strncmp(line, "  ", 2) != 0)
            continue;
        size_t which = 0, size = 23;
        for (; size > 0 && line[1 + size] == ' '; size--)
            ;
        while (which < COUNT(lines) && (strlen(lines[which].label) != size ||
                                        strncmp(line + 2, lines[which].label, size) != 0))
            which++;
        if (which == COUNT(lines))
            fail_msg("nothing is said of the line \"%s\"", line);
        check_line(run, line, which);
        seen[which] = true;
    }
    for (size_t i = 0; i < COUNT(lines); i++)
        if (!seen[i])
            fail_msg("no line \"%s\"", lines[i].label);
    printf("    %zu lines\n", COUNT(lines));
    free(text);
}

static int make(void **state)
{
    finished_run *run = calloc(1, sizeof *run);
    *state = run;
    if (!run || scratch_make(state))
        return -1;
    *state = run;
    run_example(run);
    read_json(run);
    return 0;
}

static int clear(void **state)
{
    finished_run *run = *state;
    history_free(&run->tube);
    model_clear(&run->model);
    free(run);
    return scratch_remove(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_json),
        cmocka_unit_test(test_rates_of_flight),
        cmocka_unit_test(test_study_results),
        cmocka_unit_test(test_table),
    };
    return cmocka_run_group_tests(tests, make, clear);
}
