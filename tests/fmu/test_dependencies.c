// Which unknown depends on which known, as an FMU's description says, against what reacts: each
// known is moved on its own at instants of a launch, and everything is asked for again.
// link: -ldl -lsundials_cvode -lsundials_nvecserial
#include "support/fmu_importer.h"

enum { MOST = 1200 };

typedef struct referred {
    uint32_t reference;
    size_t place;
} referred;

// Variables in the order of the description.
typedef struct book {
    const unpacked_fmu *fmu;
    size_t count;
    uint32_t reference[MOST];
    referred by[MOST]; // by value references that rise
    char name[MOST][64], causality[MOST][16];
    bool is_real[MOST];
    bool declared[MOST][MOST], reacts[MOST][MOST]; // [unknown][known]
} book;

static int compare_references(const void *a, const void *b)
{
    const referred *x = a, *y = b;
    return x->reference < y->reference ? -1 : x->reference > y->reference;
}

static size_t place_of(const book *self, uint32_t reference)
{
    referred wanted = {.reference = reference};
    const referred *found =
        bsearch(&wanted, self->by, self->count, sizeof wanted, compare_references);
    assert_non_null(found);
    return found->place;
}

static book *book_read(const unpacked_fmu *fmu)
{
    book *self = calloc(1, sizeof *self);
    assert_non_null(self);
    self->fmu = fmu;
    const char *end = strstr(fmu->description, "</ModelVariables>");
    for (const char *at = strstr(fmu->description, "<ModelVariables>");
         (at = strchr(at + 1, '<')) && at < end;) {
        char reference[16];
        if (at[1] == '/' || strncmp(at, "<Start", 6) == 0)
            continue;
        assert_true(self->count < MOST);
        attribute_after(at, "valueReference", reference, sizeof reference);
        self->reference[self->count] = (uint32_t)atoi(reference);
        self->by[self->count] = (referred){self->reference[self->count], self->count};
        self->is_real[self->count] = strncmp(at, "<Float64", 8) == 0;
        attribute_after(at, "name", self->name[self->count], 64);
        attribute_after(at, "causality", self->causality[self->count++], 16);
    }
    qsort(self->by, self->count, sizeof *self->by, compare_references);
    return self;
}

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

// The lists of these elements; one that is not there is of all knowns.
static void read_lists(book *self, const char *element)
{
    char head[64];
    snprintf(head, sizeof head, "<%s ", element);
    memset(self->declared, 0, sizeof self->declared);
    for (const char *at = self->fmu->description; (at = strstr(at, head)); at++) {
        char reference[16], list[16384];
        attribute_after(at, "valueReference", reference, sizeof reference);
        bool *of = self->declared[place_of(self, (uint32_t)atoi(reference))];
        const char *end = strchr(at, '>'), *listed = strstr(at, " dependencies=\"");
        if (!listed || listed > end) {
            memset(of, true, MOST);
            continue;
        }
        attribute_after(listed, "dependencies", list, sizeof list);
        for (char *word = strtok(list, " "); word; word = strtok(NULL, " "))
            of[place_of(self, (uint32_t)atoi(word))] = true;
    }
}

typedef bool choice(const book *self, size_t i);

static bool is_output(const book *self, size_t i)
{
    return strcmp(self->causality[i], "output") == 0;
}

static bool is_rate(const book *self, size_t i)
{
    return begins(self->name[i], "der(");
}

static bool is_indicator(const book *self, size_t i)
{
    return begins(self->name[i], "indicator.");
}

static bool is_input(const book *self, size_t i)
{
    return strcmp(self->causality[i], "input") == 0 && self->is_real[i];
}

static bool is_asked(const book *self, size_t i)
{
    return is_output(self, i) || is_rate(self, i) || is_indicator(self, i);
}

static size_t choose(const book *self, choice *asked, size_t *place)
{
    size_t count = 0;
    for (size_t i = 0; i < self->count; i++)
        if (asked(self, i))
            place[count++] = i;
    return count;
}

static void get(const book *self, void *instance, double *value)
{
    uint32_t reference[MOST];
    double got[MOST];
    size_t place[MOST], count = choose(self, is_asked, place);
    for (size_t i = 0; i < count; i++)
        reference[i] = self->reference[place[i]];
    assert_int_equal(
        FMU_FUNCTION(self->fmu, fmi3GetFloat64)(instance, reference, count, got, count), fmi3OK);
    for (size_t i = 0; i < count; i++)
        value[place[i]] = got[i];
}

// What is another number than before has reacted to the known.
static void note(book *self, void *instance, const double *before, size_t known)
{
    static double now[MOST];
    get(self, instance, now);
    for (size_t i = 0; i < self->count; i++)
        if (is_asked(self, i))
            self->reacts[i][known] |= memcmp(&now[i], &before[i], sizeof *now) != 0;
}

static void move_inputs(book *self, void *instance)
{
    static double before[MOST];
    size_t input[MOST], count = choose(self, is_input, input);
    get(self, instance, before);
    for (size_t k = 0; k < count; k++) {
        double value, moved;
        const uint32_t one = self->reference[input[k]];
        assert_int_equal(FMU_FUNCTION(self->fmu, fmi3GetFloat64)(instance, &one, 1, &value, 1),
                         fmi3OK);
        moved = value + (strstr(self->name[input[k]], "wrench") ? 100 : 1e-6); // no lock releases
        assert_int_equal(FMU_FUNCTION(self->fmu, fmi3SetFloat64)(instance, &one, 1, &moved, 1),
                         fmi3OK);
        note(self, instance, before, input[k]);
        assert_int_equal(FMU_FUNCTION(self->fmu, fmi3SetFloat64)(instance, &one, 1, &value, 1),
                         fmi3OK);
    }
}

// Pairs of these unknowns and knowns: those that react, that are said to, that react unsaid.
typedef struct pairs {
    int all, react, said, unsaid;
} pairs;

static pairs count_pairs(const book *self, choice *unknown, choice *known)
{
    pairs count = {0};
    for (size_t i = 0; i < self->count; i++)
        for (size_t k = 0; k < self->count; k++) {
            if (!unknown(self, i) || !known(self, k))
                continue;
            bool reacts = self->reacts[i][k], said = self->declared[i][k];
            count.all++;
            count.react += reacts;
            count.said += said;
            count.unsaid += reacts && !said;
            if (reacts && !said)
                printf("    unsaid: %s of %s\n", self->name[i], self->name[k]);
        }
    return count;
}

// ---- co-simulation: outputs of inputs

static void *begin_steps(const unpacked_fmu *fmu)
{
    void *instance = FMU_FUNCTION(fmu, fmi3InstantiateCoSimulation)(
        "steps", fmu->token, fmu->resources, false, false, false, false, NULL, 0, NULL,
        importer_log_3, NULL);
    assert_non_null(instance);
    assert_int_equal(
        FMU_FUNCTION(fmu, fmi3EnterInitializationMode)(instance, false, 0, -0.1, false, 0), fmi3OK);
    return instance;
}

// Before the run begins, and at ends of steps, over ignition and release.
static book *watch_inputs(const unpacked_fmu *fmu, pairs *initial)
{
    book *self = book_read(fmu);
    void *instance = begin_steps(fmu);
    read_lists(self, "InitialUnknown");
    move_inputs(self, instance);
    *initial = count_pairs(self, is_output, is_input);
    memset(self->reacts, 0, sizeof self->reacts);
    read_lists(self, "Output");
    assert_int_equal(FMU_FUNCTION(fmu, fmi3ExitInitializationMode)(instance), fmi3OK);
    for (int k = 0; k < 9; k++) {
        bool event, terminate, early;
        double t = -0.1 + 0.02 * k, reached;
        move_inputs(self, instance);
        assert_int_equal(FMU_FUNCTION(fmu, fmi3DoStep)(instance, t, -0.1 + 0.02 * (k + 1) - t, true,
                                                       &event, &terminate, &early, &reached),
                         fmi3OK);
    }
    FMU_FUNCTION(fmu, fmi3FreeInstance)(instance);
    return self;
}

static bool is_wrench(const book *self, size_t i)
{
    return begins(self->name[i], "wrench.");
}

static bool is_result(const book *self, size_t i)
{
    return begins(self->name[i], "summary.");
}

#define MOVING "examples/reference.yaml --set run.lead_in=0.1s"
// whose launcher rests where it is given at its start across the vehicle, so that no direction is
// apart from another
#define AT_REST                                                                                    \
    MOVING " --set 'base.speed=0 km/h' --set 'platform.azimuth.stabiliser.command=20 deg'"

// The two together have no algebraic loop: what the vehicle reports is of its states alone.
static void vehicle_and_launcher_have_no_loop(void **state)
{
    (void)state;
    pairs initial;
    unpacked_fmu fmu = fmu_open(MOVING " --part vehicle", 3);
    book *vehicle = watch_inputs(&fmu, &initial);
    pairs outputs = count_pairs(vehicle, is_output, is_input);
    assert_true(outputs.all > 600);
    CHECK_BELOW("vehicle: outputs said to depend on a wrench", outputs.said, 0);
    CHECK_BELOW("that react to it", outputs.react, 0);
    CHECK_BELOW("said so of the start", initial.said, 0);
    CHECK_BELOW("that react to it there", initial.react, 0);
    free(vehicle);
    fmu_close(&fmu);

    fmu = fmu_open(AT_REST " --part launcher", 3);
    book *launcher = watch_inputs(&fmu, &initial);
    outputs = count_pairs(launcher, is_output, is_input);
    CHECK_BELOW("launcher: outputs that react to a frame unsaid", outputs.unsaid, 0);
    CHECK_BELOW("unsaid of the start", initial.unsaid, 0);
    pairs wrench = count_pairs(launcher, is_wrench, is_input),
          results = count_pairs(launcher, is_result, is_input);
    CHECK_BELOW("wrenches said to depend that do not react", wrench.said - wrench.react, 0);
    CHECK_BELOW("results of the launch said to depend on a frame", results.said, 0);
    free(launcher);
    fmu_close(&fmu);
}

// ---- model exchange: all of states, time and inputs

static bool is_known(const book *self, size_t i)
{
    return is_input(self, i) || begins(self->name[i], "state.") || i == 0;
}

static void move_all(book *self, importer *by)
{
    static double before[MOST], x[IMPORTER_MOST], nominal[IMPORTER_MOST];
    size_t first = 0;
    while (!begins(self->name[first], "state."))
        first++;
    OK_3(by, fmi3GetNominalsOfContinuousStates, nominal, by->states);
    memcpy(x, by->x, by->states * sizeof *x);
    importer_place(by, by->t, x);
    get(self, by->instance, before);
    for (size_t k = 0; k < by->states; k++) {
        x[k] += 1e-5 * nominal[k];
        importer_place(by, by->t, x);
        note(self, by->instance, before, first + k);
        x[k] = by->x[k];
    }
    importer_place(by, by->t + 1e-7, x);
    note(self, by->instance, before, 0);
    importer_place(by, by->t, x);
    move_inputs(self, by->instance);
}

// `share`: of what is said for a launch so much reacts at least.
static void watch_all(const char *scenario, double start, const double *at, int count, double share)
{
    unpacked_fmu fmu = fmu_open(scenario, 3);
    book *self = book_read(&fmu);
    importer by;
    importer_open(&by, &fmu, 3);
    importer_start(&by, start);
    importer_integrate(&by, 1e-6);
    for (int i = 0; i < count; i++) {
        importer_go(&by, at[i]);
        assert_false(by.ended);
        move_all(self, &by);
    }
    const struct {
        const char *element;
        choice *of;
        double said; // of what is said at least so much reacts
    } lists[] = {{"Output", is_output, 0.1},
                 {"ContinuousStateDerivative", is_rate, 0.2},
                 {"EventIndicator", is_indicator, 0.05}};
    for (int i = 0; i < 3; i++) {
        read_lists(self, lists[i].element);
        pairs found = count_pairs(self, lists[i].of, is_known);
        printf("    %s: %d pairs, %d react, %d are said\n", lists[i].element, found.all,
               found.react, found.said);
        CHECK_BELOW("pairs that react unsaid", found.unsaid, 0);
        CHECK_WITHIN("share that reacts of what is said", found.react / (double)found.said,
                     share * lists[i].said, 1);
        assert_true(found.said < found.all);
    }
    importer_close(&by);
    free(self);
    fmu_close(&fmu);
}

static void rates_and_outputs_of_states(void **state)
{
    (void)state;
    static const double moving[] = {-0.09, 2e-3, 0.03, 0.11}, outside[] = {2e-3, 0.03, 0.11};
    watch_all(MOVING, -0.1, moving, 4, 1);
    assert_int_equal(run("sed -e 's/kind: fixed/kind: external/; /elevation:/d' "
                         "examples/fixed.yaml >external.yaml"),
                     0);
    watch_all("external.yaml", 0, outside, 3, 1);
    watch_all(MOVING " --part vehicle", -0.1, moving, 3, 0.5);
}

// ---- FMI 2

// Its lists are those of FMI 3, counted from 1, but for the time, which FMI 3 has first.
static void both_versions_say_the_same(void **state)
{
    (void)state;
    static const char *const parts[] = {"examples/fixed.yaml", MOVING " --part vehicle",
                                        MOVING " --part launcher"};
    for (int i = 0; i < 3; i++) {
        unpacked_fmu two = fmu_open(parts[i], 2), three = fmu_open(parts[i], 3);
        book *self = book_read(&three);
        read_lists(self, "Output");
        int unequal = 0, unknowns = 0;
        for (const char *at = strstr(two.description, "<Outputs>"),
                        *end = strstr(two.description, "</Outputs>");
             (at = strstr(at + 1, "<Unknown ")) && at < end; unknowns++) {
            char index[16], list[8192];
            bool *said = self->declared[0], one[MOST] = {0};
            attribute_after(at, "index", index, sizeof index);
            attribute_after(at, "dependencies", list, sizeof list);
            said = self->declared[atoi(index)];
            for (char *word = strtok(list, " "); word; word = strtok(NULL, " "))
                one[atoi(word)] = true;
            said[0] = false;
            unequal += memcmp(said, one, sizeof one) != 0;
        }
        assert_true(unknowns > 100);
        CHECK_BELOW("lists that differ between the versions", unequal, 0);
        free(self);
        fmu_close(&two);
        fmu_close(&three);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(vehicle_and_launcher_have_no_loop, shell_make,
                                        shell_remove),
        cmocka_unit_test_setup_teardown(rates_and_outputs_of_states, shell_make, shell_remove),
        cmocka_unit_test_setup_teardown(both_versions_say_the_same, shell_make, shell_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
