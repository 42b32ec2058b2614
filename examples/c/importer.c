// Imports a launcher on an external base (FMI 3.0) beside a vehicle in another process.
//     importer FOLDER BINARY   the FMU, unpacked; FOLDER/binaries/x86_64-linux/NAME.so
#include <dlfcn.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { FRAME = 13, WRENCH = 6 }; // position, quaternion, velocity, rate; force, moment: in I
static const double step = 1e-4; // [s] between two exchanges

// A platform of 500 kg on a spring that moves up and down. Any program with such a socket will do.
static void vehicle(int other)
{
    const double half = 9.9 * acos(-1) / 180; // the tube points 19.8 degrees up
    double wrench[WRENCH], frame[FRAME] = {[3] = cos(half), [6] = sin(half)}, carried = NAN;
    while (write(other, frame, sizeof frame) == sizeof frame &&
           read(other, wrench, sizeof wrench) == sizeof wrench) {
        carried = isnan(carried) ? -wrench[1] : carried;
        frame[8] += step * ((wrench[1] + carried - 5e5 * frame[1] - 4e3 * frame[8]) / 500);
        frame[1] += step * frame[8];
    }
}

// Value references follow from names (docs/fmi.md): no list of variables has to be read.
static uint32_t reference_of(const char *name)
{
    uint64_t h = UINT64_C(0xcbf29ce484222325);
    for (; *name; name++)
        h = (h ^ (unsigned char)*name) * UINT64_C(0x100000001b3);
    return (uint32_t)(h ^ h >> 32) & 0x7fffffff;
}

#define FUNCTION(result, name, ...)                                                                \
    result (*name)(__VA_ARGS__) = __extension__(result(*)(__VA_ARGS__)) dlsym(binary, "fmi"        \
                                                                                      "3" #name)

int main(int argc, char **argv)
{
    static const char *const names[] = {"input.base.position.x",   "input.base.position.y",
                                        "input.base.position.z",   "input.base.quaternion.0",
                                        "input.base.quaternion.1", "input.base.quaternion.2",
                                        "input.base.quaternion.3", "input.base.velocity.x",
                                        "input.base.velocity.y",   "input.base.velocity.z",
                                        "input.base.rate.x",       "input.base.rate.y",
                                        "input.base.rate.z",       "wrench.force.x",
                                        "wrench.force.y",          "wrench.force.z",
                                        "wrench.moment.x",         "wrench.moment.y",
                                        "wrench.moment.z",         "summary.rocket.1.pitch_rate"};
    enum { NAMES = sizeof names / sizeof *names };
    char path[4096], text[4096] = "", token[64] = "";
    uint32_t reference[NAMES];
    double frame[FRAME], wrench[WRENCH], highest = 0, rate, t = 0;
    bool ended = false, unused;
    int pair[2];

    for (int i = 0; i < NAMES; i++)
        reference[i] = reference_of(names[i]);
    snprintf(path, sizeof path, "%s/modelDescription.xml", argc == 3 ? argv[1] : "");
    FILE *file = fopen(path, "r");
    void *binary = file && fread(text, 1, sizeof text - 1, file) ? dlopen(argv[2], RTLD_NOW) : NULL;
    const char *at = strstr(text, "instantiationToken=");
    if (!binary || !at || sscanf(at, "instantiationToken=\"%63[^\"]", token) != 1 ||
        socketpair(AF_UNIX, SOCK_STREAM, 0, pair))
        return fputs("usage: importer FOLDER BINARY, of an unpacked FMU of FMI 3.0\n", stderr), 2;
    fclose(file);
    pid_t child = fork();
    close(pair[child != 0]);
    if (child == 0)
        return vehicle(pair[1]), 0;

    FUNCTION(void *, InstantiateCoSimulation, const char *, const char *, const char *, bool, bool,
             bool, bool, const uint32_t *, size_t, void *, void *, void *);
    FUNCTION(int, SetFloat64, void *, const uint32_t *, size_t, const double *, size_t);
    FUNCTION(int, GetFloat64, void *, const uint32_t *, size_t, double *, size_t);
    FUNCTION(int, EnterInitializationMode, void *, bool, double, double, bool, double);
    FUNCTION(int, ExitInitializationMode, void *);
    FUNCTION(int, DoStep, void *, double, double, bool, bool *, bool *, bool *, double *);
    snprintf(path, sizeof path, "%s/resources", argv[1]);
    void *launcher = InstantiateCoSimulation("launcher", token, path, false, false, false, false,
                                             NULL, 0, NULL, NULL, NULL);
    bool fine = launcher && read(pair[0], frame, sizeof frame) == sizeof frame &&
                !SetFloat64(launcher, reference, FRAME, frame, FRAME) &&
                !EnterInitializationMode(launcher, false, 0, t, false, 0) &&
                !ExitInitializationMode(launcher);
    while (fine && !ended) { // over one step: the vehicle under the wrench, the launcher on it
        fine = !GetFloat64(launcher, reference + FRAME, WRENCH, wrench, WRENCH) &&
               write(pair[0], wrench, sizeof wrench) == sizeof wrench &&
               read(pair[0], frame, sizeof frame) == sizeof frame &&
               !DoStep(launcher, t, step, true, &unused, &ended, &unused, &t) &&
               (ended || !SetFloat64(launcher, reference, FRAME, frame, FRAME));
        highest = fmax(highest, frame[1]);
    }
    if (!fine || GetFloat64(launcher, reference + FRAME + WRENCH, 1, &rate, 1))
        return fputs("the launcher's FMU has failed\n", stderr), 1;
    printf("the platform rises by %.2f mm, pitch rate %.1f mrad/s\n", 1e3 * highest, 1e3 * rate);
    return 0;
}
