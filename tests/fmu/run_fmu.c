// usage: run_fmu FOLDER BINARY FMI
// An importer that runs on Windows, too: an unpacked FMU of version FMI (2 or 3) in FOLDER,
// co-simulation by steps of a hundredth of its length to its end. Prints every output as 16
// hexadecimal digits, a line for each instant, and the names and numbers of the last one, arrays by
// their elements: on two machines to be compared as texts (scripts/cross).
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#define OPEN(file) (void *)LoadLibraryA(file)
#define FIND(library, name) (void *)GetProcAddress((HMODULE)library, name)
#define FILE_URI "file:///"
#else
#include <dlfcn.h>
#define OPEN(file) dlopen(file, RTLD_NOW | RTLD_LOCAL)
#define FIND(library, name) dlsym(library, name)
#define FILE_URI "file://"
#endif

#include "fmu/fmi2_interface.h"
#include "fmu/fmi3_interface.h"

enum { MOST = 4000, STEPS = 100, LINE = 1 << 14 };

static void *library, *instance;
static int version, count, numbers; // variables, and of how many numbers they are
static unsigned reference[MOST];
static int length[MOST];
static char name[MOST][160];

#define CALL(name) ((__typeof__(&name))FIND(library, #name))

static void stop(const char *why)
{
    printf("failed: %s\n", why);
    exit(1);
}

static void check(int status, const char *call)
{
    if (status)
        stop(call);
}

static void log_2(void *environment, const char *of, fmi2Status status, const char *category,
                  const char *message, ...)
{
    (void)environment, (void)of, (void)status, (void)category;
    printf("log: %s\n", message);
}

static void log_3(void *environment, fmi3Status status, const char *category, const char *message)
{
    (void)environment, (void)status, (void)category;
    printf("log: %s\n", message);
}

// The attribute of the line; false: it has none.
static int attribute(const char *line, const char *wanted, char *value, size_t size)
{
    char begin[64];
    snprintf(begin, sizeof begin, " %s=\"", wanted);
    const char *at = strstr(line, begin);
    if (!at)
        return 0;
    at += strlen(begin);
    snprintf(value, size, "%.*s", (int)strcspn(at, "\""), at);
    return 1;
}

static void take_line(const char *line, char token[64], double span[2])
{
    char value[32];
    int real = version == 2 ? strstr(line, "<Real") != NULL : strstr(line, "<Float64 ") != NULL;
    attribute(line, version == 2 ? "guid" : "instantiationToken", token, 64);
    if (attribute(line, "startTime", value, sizeof value))
        span[0] = strtod(value, NULL);
    if (attribute(line, "stopTime", value, sizeof value))
        span[1] = strtod(value, NULL);
    if (!real || !strstr(line, " causality=\"output\"") || count == MOST)
        return;
    attribute(line, "valueReference", value, sizeof value);
    attribute(line, "name", name[count], sizeof name[count]);
    reference[count] = (unsigned)strtoul(value, NULL, 10);
    const char *dimension = strstr(line, "<Dimension");
    length[count] =
        dimension && attribute(dimension, "start", value, sizeof value) ? atoi(value) : 1;
    numbers += length[count++];
    if (numbers > MOST)
        stop("too many outputs");
}

static void read_description(const char *folder, char token[64], double span[2])
{
    static char line[LINE];
    char path[512];
    snprintf(path, sizeof path, "%s/modelDescription.xml", folder);
    FILE *file = fopen(path, "rb");
    if (!file)
        stop(path);
    while (fgets(line, sizeof line, file))
        take_line(line, token, span);
    fclose(file);
}

static void begin(const char *folder, const char *token, double start)
{
    static const fmi2CallbackFunctions call = {.logger = log_2};
    char resources[600];
    snprintf(resources, sizeof resources, "%s%s/resources", version == 2 ? FILE_URI : "", folder);
    instance = version == 2
                   ? CALL(fmi2Instantiate)("one", fmi2CoSimulation, token, resources, &call, 0, 0)
                   : CALL(fmi3InstantiateCoSimulation)("one", token, resources, false, false, false,
                                                       false, NULL, 0, NULL, log_3, NULL);
    if (!instance)
        stop("instantiate");
    if (version == 2) {
        check(CALL(fmi2SetupExperiment)(instance, 0, 0, start, 0, 0), "setup");
        check(CALL(fmi2EnterInitializationMode)(instance), "enter initialization");
        check(CALL(fmi2ExitInitializationMode)(instance), "exit initialization");
    } else {
        check(CALL(fmi3EnterInitializationMode)(instance, false, 0, start, false, 0),
              "enter initialization");
        check(CALL(fmi3ExitInitializationMode)(instance), "exit initialization");
    }
}

// Whether the launch goes on.
static int step(double t, double size)
{
    bool event, terminate = false, early;
    double last;
    if (version == 2) {
        int status = CALL(fmi2DoStep)(instance, t, size, 1);
        check(status != fmi2OK && status != fmi2Discard, "step");
        return status == fmi2OK;
    }
    check(CALL(fmi3DoStep)(instance, t, size, true, &event, &terminate, &early, &last), "step");
    return !terminate;
}

static void get(double value[MOST])
{
    check(version == 2 ? (int)CALL(fmi2GetReal)(instance, reference, (size_t)count, value)
                       : (int)CALL(fmi3GetFloat64)(instance, reference, (size_t)count, value,
                                                   (size_t)numbers),
          "get");
}

static void print_bits(const double value[MOST])
{
    for (int i = 0; i < numbers; i++) {
        uint64_t bits;
        memcpy(&bits, &value[i], sizeof bits);
        printf("%s%016" PRIx64, i ? " " : "", bits);
    }
    printf("\n");
}

int main(int arguments, char **argument)
{
    static double value[MOST];
    double span[2] = {0, 0.5};
    char token[64];
    if (arguments != 4)
        stop("usage: run_fmu FOLDER BINARY FMI");
    version = atoi(argument[3]);
    library = OPEN(argument[2]);
    if (!library)
        stop("the binary does not load");
    read_description(argument[1], token, span);
    begin(argument[1], token, span[0]);
    double size = (span[1] - span[0]) / STEPS;
    int going = 1;
    get(value);
    print_bits(value);
    for (int i = 0; i < STEPS && going; i++) {
        going = step(span[0] + i * size, size);
        get(value);
        print_bits(value);
    }
    for (int i = 0, at = 0; i < count; i++)
        for (int k = 0; k < length[i]; k++)
            printf("%s %.6g\n", name[i], value[at++]);
    if (version == 2)
        CALL(fmi2FreeInstance)(instance);
    else
        CALL(fmi3FreeInstance)(instance);
    return 0;
}
