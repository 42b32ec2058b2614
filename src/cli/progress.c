#include "cli/progress.h"

#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

static volatile sig_atomic_t stop_signal;

// What a terminal sends comes from there and is not handed on; what another process sends may come
// both ways.
static void ask_to_stop(int number, siginfo_t *about, void *context)
{
    static volatile sig_atomic_t asked; // other than by being handed on
    (void)context;
    bool handed_on = about->si_code == SI_QUEUE && about->si_pid == getppid();
    if (!handed_on && asked == number) {
        signal(number, SIG_DFL);
        raise(number);
    }
    if (!handed_on)
        asked = number;
    stop_signal = number;
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

void progress_start(run_progress *progress, bool quiet)
{
    struct sigaction action = {.sa_sigaction = ask_to_stop, .sa_flags = SA_SIGINFO}, hangup;
    sigaction(SIGHUP, NULL, &hangup);
    if (hangup.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &action, NULL);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    *progress = (run_progress){.shown = !quiet, .terminal = isatty(STDERR_FILENO), .start = now()};
    progress->latest = progress->start;
}

// ---- lines

// Of a line that moves; of lines of their own: no more often than LEAST, then after a tenth of the
// way or after MOST.
static const double MOVES = 0.2, LEAST = 30, MOST = 600; // [s]
static const double STEP = 0.1;

// Whether a line is due; `share`: done of all, NaN: not known.
static bool is_due(run_progress *progress, double share, double time)
{
    double since = time - progress->latest;
    if (!progress->shown || since < (progress->terminal ? MOVES : LEAST))
        return false;
    if (!progress->terminal && since < MOST && !(share - progress->share >= STEP))
        return false;
    progress->latest = time;
    progress->share = share;
    progress->drawn = progress->terminal;
    return true;
}

// A line that is due.
static void print_line(const run_progress *progress, const char *format, ...) LD_PRINTF(2, 3);
static void print_line(const run_progress *progress, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs(progress->terminal ? "\r" : "launchdyn: ", stderr);
    vfprintf(stderr, format, arguments);
    fputs(progress->terminal ? "     " : "\n", stderr);
    fflush(stderr);
    va_end(arguments);
}

// "[######............]  31 %   12.4 %/s   5.6 s left"; without the bar where it does not move.
static void draw(const run_progress *progress, double share)
{
    enum { WIDTH = 40 };
    char bar[WIDTH + 4] = "";
    double rate = share / (progress->latest - progress->start);
    double left = rate > 0 ? (1 - share) / rate : 0;
    for (int i = 0; progress->terminal && i < WIDTH; i++)
        bar[i + 1] = i < share * WIDTH ? '#' : '.';
    if (!progress->terminal) {
        print_line(progress, "%.0f %%, %.3g %%/s, %.0f s left", share * 100, rate * 100, left);
        return;
    }
    bar[0] = '[';
    bar[WIDTH + 1] = ']';
    print_line(progress, "%s %3.0f %% %8.3g %%/s %8.1f s left", bar, share * 100, rate * 100, left);
}

bool progress_share(void *self, double share)
{
    run_progress *progress = self;
    if (progress->shown && is_due(progress, share, now()))
        draw(progress, share);
    return stop_signal == 0;
}

bool progress_resume(void *self)
{
    (void)self;
    return stop_signal == 0;
}

// "1234 of 5000 samples, 3 failed, 83.1 /s, 45 s left", and with a stopping rule "of at most 5000
// samples, next check of the stopping rule at 1450".
void progress_samples(void *self, const ld_study_counts *counts)
{
    run_progress *progress = self;
    double time = now();
    char look[64] = "";
    bool open_end = counts->look > 0 && counts->look < counts->samples;
    int64_t next = open_end ? counts->look : counts->samples;
    if (!is_due(progress, (double)counts->done / (double)counts->samples, time))
        return;
    double rate = (double)counts->now / (time - progress->start);
    if (open_end)
        snprintf(look, sizeof look, ", next check of the stopping rule at %lld",
                 (long long)counts->look);
    print_line(progress, "%lld of %s%lld samples%s, %lld failed, %.3g /s, %.0f s left",
               (long long)counts->done, open_end ? "at most " : "", (long long)counts->samples,
               look, (long long)counts->failed, rate, (double)(next - counts->done) / rate);
}

// "start 2 of 4, 134 launches, 83.1 /s, chi2 12.3".
void progress_launches(void *self, const ld_fit_counts *counts)
{
    run_progress *progress = self;
    double time = now();
    char chi2[48] = "";
    if (!is_due(progress, NAN, time))
        return;
    if (counts->chi2 == counts->chi2)
        snprintf(chi2, sizeof chi2, ", chi2 %.4g", counts->chi2);
    print_line(progress, "%.60s, %lld launches, %.3g /s%s", counts->stage,
               (long long)counts->launches, (double)counts->launches / (time - progress->start),
               chi2);
}

// "5 of 21 launches".
void progress_derivatives(void *self, int launches, int of)
{
    run_progress *progress = self;
    if (is_due(progress, (double)launches / of, now()))
        print_line(progress, "%d of %d launches", launches, of);
}

// "start 1 of 2, 34 candidates, 1360 launches, 83.1 /s, least 0.0123".
void progress_candidates(void *self, const ld_optimise_counts *counts)
{
    run_progress *progress = self;
    double time = now();
    char least[48] = "";
    if (!is_due(progress, NAN, time))
        return;
    if (counts->least == counts->least)
        snprintf(least, sizeof least, ", least %.5g (SI)", counts->least);
    print_line(progress, "%.60s, %d candidates, %lld launches, %.3g /s%s", counts->stage,
               counts->candidates, (long long)counts->launches,
               (double)counts->launches / (time - progress->start), least);
}

void progress_end(run_progress *progress)
{
    if (progress->drawn)
        fprintf(stderr, "\r%79s\r", "");
    progress->drawn = false;
}

int progress_signal(void)
{
    return stop_signal;
}
