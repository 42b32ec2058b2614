// What the command costs from its start to its end: process CPU time and page faults.
// usage: bench_command [COMMAND]      (default: this build's launchdyn)
#include <fcntl.h>
#include <spawn.h>
#include <stdbool.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench_sample.h"
#include "bench_scratch.h"

enum { REPEATS = 40 };

extern char **environ;

static double seconds(struct timeval time)
{
    return (double)time.tv_sec + 1e-6 * (double)time.tv_usec;
}

// Runs it once, of what it prints only errors are seen.
static struct rusage run(char *const *word)
{
    posix_spawn_file_actions_t quiet;
    struct rusage used;
    pid_t child;
    int status;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    bool fine = posix_spawn(&child, word[0], &quiet, NULL, word, environ) == 0 &&
                wait4(child, &status, 0, &used) == child && status == 0;
    posix_spawn_file_actions_destroy(&quiet);
    if (!fine) {
        fprintf(stderr, "%s %s fails\n", word[0], word[1]);
        exit(1);
    }
    return used;
}

static void bench(const char *what, char *const *word)
{
    double cpu[REPEATS], faults[REPEATS];
    for (int i = 0; i < REPEATS; i++) {
        struct rusage used = run(word);
        faults[i] = (double)(used.ru_minflt + used.ru_majflt);
        cpu[i] = seconds(used.ru_utime) + seconds(used.ru_stime);
    }
    print(what, cpu, REPEATS, 1e-3, "ms");
    print("  page faults", faults, REPEATS, 1, "");
}

int main(int argc, char **argv)
{
    char program[] = LD_BINARY_DIR "/launchdyn", scenario[] = LD_SOURCE_DIR "/examples/fixed.yaml";
    char version[] = "--version", check[] = "check", run_it[] = "run", out[] = "--out", folder[32];
    char *command = argc > 1 ? argv[1] : program;
    make_folder(folder);
    bench("launchdyn --version", (char *[]){command, version, NULL});
    bench("launchdyn check examples/fixed.yaml", (char *[]){command, check, scenario, NULL});
    bench("launchdyn run examples/fixed.yaml", (char *[]){command, run_it, scenario, NULL});
    bench("launchdyn run examples/fixed.yaml --out DIR",
          (char *[]){command, run_it, scenario, out, folder, NULL});
    remove_folder(folder);
    return 0;
}
