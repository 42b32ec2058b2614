// The program that runs an FMU of other people's in a process of its own: does what it is asked for
// (foreign/protocol.h), one request after the other, until it is asked to end or no one is there to
// ask any more. It lies inside programs and library (cmake/host_inside.c).
#define _GNU_SOURCE // POLLRDHUP; NOLINT(bugprone-reserved-identifier)
#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include "fmu/fmi2_interface.h"
#include "fmu/fmi3_interface.h"
#include "foreign/folder.h"
#include "foreign/protocol.h"

#ifdef LD_SANITIZED
// What an FMU does wrong ends this process as it would without sanitizers.
const char *__asan_default_options(void);
const char *__asan_default_options(void)
{
    return "handle_segv=0:handle_abort=0:handle_sigbus=0:handle_sigfpe=0:detect_leaks=0";
}
#endif

// The functions that are called, in either version.
// clang-format off
#define FUNCTIONS_2(X) \
    X(fmi2Instantiate) X(fmi2FreeInstance) X(fmi2SetupExperiment) X(fmi2EnterInitializationMode) \
    X(fmi2ExitInitializationMode) X(fmi2Terminate) X(fmi2GetReal) X(fmi2SetReal) \
    X(fmi2GetInteger) X(fmi2SetInteger) X(fmi2GetBoolean) X(fmi2SetBoolean) X(fmi2SetString) \
    X(fmi2SetRealInputDerivatives) X(fmi2DoStep) \
    X(fmi2GetRealStatus) X(fmi2GetBooleanStatus) X(fmi2GetFMUstate) X(fmi2SetFMUstate) \
    X(fmi2FreeFMUstate) X(fmi2SerializedFMUstateSize) X(fmi2SerializeFMUstate) \
    X(fmi2DeSerializeFMUstate)
#define FUNCTIONS_3(X) \
    X(fmi3InstantiateCoSimulation) X(fmi3FreeInstance) X(fmi3EnterInitializationMode) \
    X(fmi3ExitInitializationMode) X(fmi3Terminate) X(fmi3GetFloat64) X(fmi3SetFloat64) \
    X(fmi3GetFloat32) X(fmi3SetFloat32) X(fmi3GetInt8) X(fmi3SetInt8) X(fmi3GetUInt8) \
    X(fmi3SetUInt8) X(fmi3GetInt16) X(fmi3SetInt16) X(fmi3GetUInt16) X(fmi3SetUInt16) \
    X(fmi3GetInt32) X(fmi3SetInt32) X(fmi3GetUInt32) X(fmi3SetUInt32) X(fmi3GetInt64) \
    X(fmi3SetInt64) X(fmi3GetUInt64) X(fmi3SetUInt64) X(fmi3GetBoolean) X(fmi3SetBoolean) \
    X(fmi3SetString) X(fmi3DoStep) X(fmi3GetFMUState) X(fmi3SetFMUState) X(fmi3FreeFMUState) \
    X(fmi3SerializedFMUStateSize) X(fmi3SerializeFMUState) X(fmi3DeserializeFMUState)
// clang-format on
#define MEMBER(name) __typeof__(&name) name;

static struct {
    foreign_shared *shared;
    pid_t asking;
    int version;
    bool keeps_state;
    void *library, *instance;
    fmi2CallbackFunctions callbacks;
    char folder[FOREIGN_LONGEST_PATH];
    FUNCTIONS_2(MEMBER) FUNCTIONS_3(MEMBER)
} host;

// Calls a function of the FMU, whose name is sent first.
#define CALL(name, ...)                                                                            \
    (snprintf(host.shared->function, sizeof host.shared->function, "%s", #name),                   \
     !host.name ? missing(#name) : (int)host.name(__VA_ARGS__))

// The status of a function that the binary lacks: an error in both versions.
static int missing(const char *name)
{
    snprintf(host.shared->said, FOREIGN_LONGEST_SAID, "its binary has no %s", name);
    return fmi2Error;
}

_Static_assert((int)fmi2Error == (int)fmi3Error && (int)fmi2Discard == (int)fmi3Discard &&
                   (int)fmi2Warning == (int)fmi3Warning,
               "both versions count alike");

static foreign_result result_of_status(int status)
{
    return status == fmi2OK || status == fmi2Warning ? FOREIGN_DONE : FOREIGN_REFUSED;
}

// ---- what the FMU says

static void log_2(void *environment, const char *instance, fmi2Status status, const char *category,
                  const char *message, ...)
{
    (void)environment, (void)instance, (void)category;
    va_list arguments;
    va_start(arguments, message);
    if (status != fmi2OK)
        // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): it is begun above
        vsnprintf(host.shared->said, FOREIGN_LONGEST_SAID, message, arguments);
    va_end(arguments);
}

static void log_3(void *environment, fmi3Status status, const char *category, const char *message)
{
    (void)environment, (void)category;
    if (status != fmi3OK)
        snprintf(host.shared->said, FOREIGN_LONGEST_SAID, "%s", message);
}

// ---- begin

static bool load(const foreign_opening *opening)
{
    snprintf(host.shared->function, sizeof host.shared->function, "dlopen");
    host.library = dlopen(opening->library, RTLD_NOW | RTLD_LOCAL);
    if (!host.library) {
        snprintf(host.shared->said, FOREIGN_LONGEST_SAID, "%s", dlerror());
        return false;
    }
#define LOAD(name) host.name = (__extension__(__typeof__(&name)) dlsym(host.library, #name));
    if (opening->version == 2) {
        FUNCTIONS_2(LOAD)
    } else {
        FUNCTIONS_3(LOAD)
    }
    return true;
}

static void *refuse_instance(void)
{
    snprintf(host.shared->said, FOREIGN_LONGEST_SAID, "its binary has no function to instantiate");
    return NULL;
}

static foreign_result open_fmu(const foreign_opening *opening)
{
    char uri[FOREIGN_LONGEST_PATH + 16];
    memcpy(host.folder, opening->folder, sizeof host.folder);
    host.version = opening->version;
    host.keeps_state = opening->keeps_state;
    if (!load(opening))
        return FOREIGN_MISSING;
    host.callbacks = (fmi2CallbackFunctions){log_2, calloc, free, NULL, NULL};
    snprintf(uri, sizeof uri, "file://%s", opening->resources);
    const char *name = "base";
    snprintf(host.shared->function, sizeof host.shared->function, "%s",
             host.version == 2 ? "fmi2Instantiate" : "fmi3InstantiateCoSimulation");
    if (host.version == 2)
        host.instance = host.fmi2Instantiate
                            ? host.fmi2Instantiate(name, fmi2CoSimulation, opening->token, uri,
                                                   &host.callbacks, 0, 0)
                            : refuse_instance();
    else
        host.instance =
            host.fmi3InstantiateCoSimulation
                ? host.fmi3InstantiateCoSimulation(name, opening->token, opening->resources, false,
                                                   false, false, false, NULL, 0, NULL, log_3, NULL)
                : refuse_instance();
    return host.instance ? FOREIGN_DONE : FOREIGN_REFUSED;
}

static foreign_result enter_initialization(double start)
{
    if (host.version == 3)
        return result_of_status(
            CALL(fmi3EnterInitializationMode, host.instance, false, 0, start, false, 0));
    foreign_result result =
        result_of_status(CALL(fmi2SetupExperiment, host.instance, 0, 0, start, 0, 0));
    return result ? result : result_of_status(CALL(fmi2EnterInitializationMode, host.instance));
}

static foreign_result leave_initialization(void)
{
    return result_of_status(host.version == 2 ? CALL(fmi2ExitInitializationMode, host.instance)
                                              : CALL(fmi3ExitInitializationMode, host.instance));
}

// ---- values

static int set_2(const foreign_value *one)
{
    int whole = (int)one->value;
    switch ((foreign_type)one->type) {
    case FOREIGN_FLOAT64:
        return CALL(fmi2SetReal, host.instance, &one->reference, 1, &one->value);
    case FOREIGN_BOOLEAN:
        return CALL(fmi2SetBoolean, host.instance, &one->reference, 1, &whole);
    default:
        return CALL(fmi2SetInteger, host.instance, &one->reference, 1, &whole);
    }
}

static int get_2(const foreign_value *one, double *value)
{
    int whole = 0, status;
    switch ((foreign_type)one->type) {
    case FOREIGN_FLOAT64:
        return CALL(fmi2GetReal, host.instance, &one->reference, 1, value);
    case FOREIGN_BOOLEAN:
        status = CALL(fmi2GetBoolean, host.instance, &one->reference, 1, &whole);
        break;
    default:
        status = CALL(fmi2GetInteger, host.instance, &one->reference, 1, &whole);
    }
    *value = whole;
    return status;
}

// Types of FMI 3 with the C type of their values; an enumeration is an Int64.
#define TYPES_3(X)                                                                                 \
    X(FOREIGN_FLOAT64, double, Float64)                                                            \
    X(FOREIGN_FLOAT32, float, Float32)                                                             \
    X(FOREIGN_INT8, int8_t, Int8)                                                                  \
    X(FOREIGN_UINT8, uint8_t, UInt8)                                                               \
    X(FOREIGN_INT16, int16_t, Int16)                                                               \
    X(FOREIGN_UINT16, uint16_t, UInt16)                                                            \
    X(FOREIGN_INT32, int32_t, Int32)                                                               \
    X(FOREIGN_UINT32, uint32_t, UInt32)                                                            \
    X(FOREIGN_INT64, int64_t, Int64)                                                               \
    X(FOREIGN_UINT64, uint64_t, UInt64)                                                            \
    X(FOREIGN_ENUMERATION, int64_t, Int64)                                                         \
    X(FOREIGN_BOOLEAN, bool, Boolean)

// How many values from this one on are of one variable.
static size_t length_of(const foreign_value *one)
{
    return one->elements ? one->elements : 1;
}

static int set_3(const foreign_value *one)
{
    size_t length = length_of(one);
#define SET(type, ctype, name)                                                                     \
    case type: {                                                                                   \
        ctype value[FOREIGN_MOST_VALUES];                                                          \
        for (size_t i = 0; i < length; i++)                                                        \
            value[i] = (ctype)one[i].value;                                                        \
        return CALL(fmi3Set##name, host.instance, &one->reference, 1, value, length);              \
    }
    switch ((foreign_type)one->type) {
        TYPES_3(SET)
    default:
        return fmi3Error;
    }
}

static int get_3(const foreign_value *one, double *number)
{
    size_t length = length_of(one);
#define GET(type, ctype, name)                                                                     \
    case type: {                                                                                   \
        ctype value[FOREIGN_MOST_VALUES];                                                          \
        memset(value, 0, length * sizeof *value);                                                  \
        int status = CALL(fmi3Get##name, host.instance, &one->reference, 1, value, length);        \
        for (size_t i = 0; i < length; i++)                                                        \
            number[i] = (double)value[i];                                                          \
        return status;                                                                             \
    }
    switch ((foreign_type)one->type) {
        TYPES_3(GET)
    default:
        return fmi3Error;
    }
}

static foreign_result set_values(const foreign_value *value, size_t count)
{
    foreign_result result = FOREIGN_DONE;
    for (size_t i = 0; i < count && !result; i += length_of(&value[i]))
        result = length_of(&value[i]) > count - i
                     ? FOREIGN_BAD
                     : result_of_status(host.version == 2 ? set_2(&value[i]) : set_3(&value[i]));
    return result;
}

static foreign_result get_values(const foreign_value *value, size_t count, double *number)
{
    foreign_result result = FOREIGN_DONE;
    for (size_t i = 0; i < count && !result; i += length_of(&value[i]))
        result = length_of(&value[i]) > count - i
                     ? FOREIGN_BAD
                     : result_of_status(host.version == 2 ? get_2(&value[i], &number[i])
                                                          : get_3(&value[i], &number[i]));
    return result;
}

static foreign_result set_text(uint32_t reference, const char *text)
{
    return result_of_status(host.version == 2
                                ? CALL(fmi2SetString, host.instance, &reference, 1, &text)
                                : CALL(fmi3SetString, host.instance, &reference, 1, &text, 1));
}

// ---- states

static int get_state(void **state)
{
    return host.version == 2 ? CALL(fmi2GetFMUstate, host.instance, state)
                             : CALL(fmi3GetFMUState, host.instance, state);
}

static int set_state(void *state)
{
    return host.version == 2 ? CALL(fmi2SetFMUstate, host.instance, state)
                             : CALL(fmi3SetFMUState, host.instance, state);
}

// Not reported of: what has gone wrong before it is.
static void free_state(void **state)
{
    if (*state && host.version == 2 && host.fmi2FreeFMUstate)
        host.fmi2FreeFMUstate(host.instance, state);
    else if (*state && host.version == 3 && host.fmi3FreeFMUState)
        host.fmi3FreeFMUState(host.instance, state);
}

static int size_of(void *state, size_t *size)
{
    return host.version == 2 ? CALL(fmi2SerializedFMUstateSize, host.instance, state, size)
                             : CALL(fmi3SerializedFMUStateSize, host.instance, state, size);
}

static foreign_result save(char **bytes, size_t *size)
{
    void *state = NULL;
    foreign_result result = result_of_status(get_state(&state));
    if (!result)
        result = result_of_status(size_of(state, size));
    *bytes = result ? NULL : malloc(*size ? *size : 1);
    if (!result)
        result = result_of_status(
            host.version == 2
                ? CALL(fmi2SerializeFMUstate, host.instance, state, *bytes, *size)
                : CALL(fmi3SerializeFMUState, host.instance, state, (uint8_t *)*bytes, *size));
    free_state(&state);
    return result;
}

static foreign_result restore(const char *bytes, size_t size)
{
    void *state = NULL;
    foreign_result result = result_of_status(
        host.version == 2
            ? CALL(fmi2DeSerializeFMUstate, host.instance, bytes, size, &state)
            : CALL(fmi3DeserializeFMUState, host.instance, (const uint8_t *)bytes, size, &state));
    if (!result)
        result = result_of_status(set_state(state));
    free_state(&state);
    return result;
}

// ---- steps

// One step; `reached`: where it stands then. fmi2Discard: not at its end.
static int step_once(double t, double size, double *reached, bool *ends)
{
    const double end = t + size;
    *reached = end;
    *ends = false;
    if (host.version == 3) {
        bool event, early = false;
        double last =
            end; // a unit of fixed steps says where the last of these ended, and continues
        int status = CALL(fmi3DoStep, host.instance, t, size, true, &event, ends, &early, &last);
        if (result_of_status(status) != FOREIGN_DONE || !early || !(last < t + size * (1 - 1e-9)))
            return status;
        *reached = last;
        return fmi3Discard;
    }
    int status = CALL(fmi2DoStep, host.instance, t, size, 1), terminated = 0;
    if (status != fmi2Discard)
        return status;
    *reached = t;
    if (host.fmi2GetRealStatus)
        host.fmi2GetRealStatus(host.instance, fmi2LastSuccessfulTime, reached);
    if (host.fmi2GetBooleanStatus)
        host.fmi2GetBooleanStatus(host.instance, fmi2Terminated, &terminated);
    *ends = terminated != 0;
    return status;
}

// The inputs of a piece that begins at t; with rates they are where these lead from the step's
// start.
static foreign_result set_inputs(const foreign_stepping *to, const foreign_value *input, double t)
{
    static const int first = 1;
    foreign_result result = to->with_rates ? FOREIGN_DONE : set_values(input, to->inputs);
    for (uint32_t i = 0; i < to->inputs && to->with_rates && !result; i++) {
        foreign_value now = input[i];
        now.value += now.rate * (t - to->t);
        result = result_of_status(set_2(&now));
        if (!result)
            result = result_of_status(CALL(fmi2SetRealInputDerivatives, host.instance,
                                           &now.reference, 1, &first, &now.rate));
    }
    return result;
}

// To the step's end in as many pieces as the FMU requires: where it has gone a part of the way,
// onwards from there; where it has not, from the state before by half of it.
static foreign_result step(const foreign_stepping *to, const foreign_value *input, int64_t *pieces)
{
    enum { MOST_PIECES = 1000 };
    const double end = to->t + to->size;
    double t = to->t, size = to->size;
    bool last = true; // the piece leads to the end, whatever t + size is rounded to
    for (*pieces = 1; *pieces <= MOST_PIECES; ++*pieces) {
        void *before = NULL;
        double reached;
        bool ends;
        if (*pieces == 1 || to->with_rates) {
            foreign_result set = set_inputs(to, input, t);
            if (set)
                return set;
        }
        if (host.keeps_state && result_of_status(get_state(&before)))
            return FOREIGN_REFUSED;
        int status = step_once(t, size, &reached, &ends);
        bool stuck = status == fmi2Discard && !(reached > t) && !ends;
        if (stuck && host.keeps_state && result_of_status(set_state(before)))
            status = fmi2Error;
        free_state(&before);
        if (ends)
            return FOREIGN_ENDS;
        if (status != fmi2Discard && result_of_status(status))
            return FOREIGN_REFUSED;
        if (stuck && !host.keeps_state)
            return FOREIGN_NO_STEP;
        if ((last && status != fmi2Discard) || (!stuck && !(reached < end)))
            return FOREIGN_DONE;
        t = stuck ? t : reached;
        size = stuck ? 0.5 * size : end - t;
        last = !stuck;
    }
    return FOREIGN_NO_STEP;
}

// ---- requests

static bool receive(void *bytes, size_t size)
{
    for (size_t at = 0; at < size;) {
        ssize_t got = recv(FOREIGN_SOCKET, (char *)bytes + at, size - at, 0);
        if (got <= 0)
            return false;
        at += (size_t)got;
    }
    return true;
}

static bool send_answer(foreign_result result, const void *bytes, size_t size)
{
    foreign_answer head = {.size = size, .result = result};
    return send(FOREIGN_SOCKET, &head, sizeof head, MSG_NOSIGNAL) == sizeof head &&
           (size == 0 || send(FOREIGN_SOCKET, bytes, size, MSG_NOSIGNAL) == (ssize_t)size);
}

static bool answer_step(const char *body, size_t size)
{
    const foreign_stepping *to = (const void *)body;
    foreign_step_answer out;
    if (size < sizeof *to || to->inputs > FOREIGN_MOST_VALUES ||
        to->outputs > FOREIGN_MOST_VALUES ||
        size != sizeof *to + (to->inputs + to->outputs) * sizeof(foreign_value))
        return send_answer(FOREIGN_BAD, NULL, 0);
    const foreign_value *value = (const void *)(body + sizeof *to);
    foreign_result result = step(to, value, &out.pieces);
    if (!result)
        result = get_values(value + to->inputs, to->outputs, out.number);
    return send_answer(
        result, &out,
        result ? 0 : offsetof(foreign_step_answer, number) + to->outputs * sizeof(double));
}

static bool answer_values(foreign_kind kind, const char *body, size_t size)
{
    double number[FOREIGN_MOST_VALUES];
    size_t count = size / sizeof(foreign_value);
    if (count > FOREIGN_MOST_VALUES)
        return send_answer(FOREIGN_BAD, NULL, 0);
    if (kind == FOREIGN_SET)
        return send_answer(set_values((const void *)body, count), NULL, 0);
    foreign_result result = get_values((const void *)body, count, number);
    return send_answer(result, number, result ? 0 : count * sizeof *number);
}

static bool answer_set_text(const char *body, size_t size)
{
    uint32_t reference;
    if (size <= sizeof reference || body[size - 1])
        return send_answer(FOREIGN_BAD, NULL, 0);
    memcpy(&reference, body, sizeof reference);
    return send_answer(set_text(reference, body + sizeof reference), NULL, 0);
}

static bool answer_save(void)
{
    char *bytes = NULL;
    size_t size = 0;
    foreign_result result = save(&bytes, &size);
    bool sent = send_answer(result, bytes, result ? 0 : size);
    free(bytes);
    return sent;
}

static bool serve_request(foreign_kind kind, const char *body, size_t size)
{
    switch (kind) {
    case FOREIGN_OPEN:
        return send_answer(open_fmu((const void *)body), NULL, 0);
    case FOREIGN_ENTER:
        return send_answer(enter_initialization(*(const double *)(const void *)body), NULL, 0);
    case FOREIGN_SET:
    case FOREIGN_GET:
        return answer_values(kind, body, size);
    case FOREIGN_SET_TEXT:
        return answer_set_text(body, size);
    case FOREIGN_LEAVE:
        return send_answer(leave_initialization(), NULL, 0);
    case FOREIGN_STEP:
        return answer_step(body, size);
    case FOREIGN_SAVE:
        return answer_save();
    case FOREIGN_LOAD:
        return send_answer(restore(body, size), NULL, 0);
    default:
        return send_answer(FOREIGN_BAD, NULL, 0);
    }
}

static void end_fmu(void)
{
    if (!host.instance)
        return;
    if (host.version == 2) {
        CALL(fmi2Terminate, host.instance);
        if (host.fmi2FreeInstance)
            host.fmi2FreeInstance(host.instance);
    } else {
        CALL(fmi3Terminate, host.instance);
        if (host.fmi3FreeInstance)
            host.fmi3FreeInstance(host.instance);
    }
}

// Whatever the FMU is at, this process ends with the one that asks; what that has unpacked goes,
// too. The FMU may have closed the socket: whether the other one is there, the system reports.
static void *watch_parent(void *unused)
{
    enum { OFTEN = 10, SELDOM = 1000 }; // [ms]
    struct pollfd other = {.fd = FOREIGN_SOCKET, .events = POLLRDHUP};
    (void)unused;
    while (getppid() == host.asking) {
        if (poll(&other, 1, host.shared->deaf ? OFTEN : SELDOM) > 0) {
            host.shared->deaf = true;
            other.fd = -1;
        }
    }
    if (*host.folder)
        foreign_folder_remove(host.folder);
    _exit(0);
}

int main(void)
{
    pthread_t watcher;
    foreign_request request;
    host.asking = getppid();
    host.shared =
        mmap(NULL, sizeof *host.shared, PROT_READ | PROT_WRITE, MAP_SHARED, FOREIGN_SHARED, 0);
    if (host.shared == MAP_FAILED || pthread_create(&watcher, NULL, watch_parent, NULL))
        return 1;
    bool fine = true;
    while (fine && (fine = receive(&request, sizeof request)) && request.kind != FOREIGN_END) {
        char *body = malloc(request.size ? request.size : 1);
        fine = body && receive(body, request.size) &&
               serve_request((foreign_kind)request.kind, body, request.size);
        free(body);
    }
    if (fine) {
        end_fmu();
        send_answer(FOREIGN_DONE, NULL, 0);
    }
    for (;;)
        pause(); // the one that asks ends this process, or its end does
}
