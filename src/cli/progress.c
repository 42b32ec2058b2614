#include "cli/progress.h"

#include <signal.h>
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
    *progress = (run_progress){.shown = !quiet && isatty(STDERR_FILENO), .start = now()};
    progress->latest = progress->start;
}

// "[######............]  31 %   12.4 %/s   5.6 s left"
static void draw(const run_progress *progress, double share)
{
    enum { WIDTH = 40 };
    char bar[WIDTH + 1] = "";
    for (int i = 0; i < WIDTH; i++)
        bar[i] = i < share * WIDTH ? '#' : '.';
    double rate = share / (progress->latest - progress->start);
    fprintf(stderr, "\r[%s] %3.0f %% %8.3g %%/s %8.1f s left ", bar, share * 100, rate * 100,
            rate > 0 ? (1 - share) / rate : 0);
    fflush(stderr);
}

bool progress_share(void *self, double share)
{
    run_progress *progress = self;
    double time = progress->shown ? now() : 0;
    if (progress->shown && time - progress->latest > 0.2) {
        progress->latest = time;
        progress->drawn = true;
        draw(progress, share);
    }
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
    if (!progress->shown || time - progress->latest < 0.2)
        return;
    progress->latest = time;
    progress->drawn = true;
    double rate = (double)counts->now / (time - progress->start);
    bool open_end = counts->look > 0 && counts->look < counts->samples;
    int64_t next = open_end ? counts->look : counts->samples;
    if (open_end)
        snprintf(look, sizeof look, ", next check of the stopping rule at %lld",
                 (long long)counts->look);
    fprintf(stderr, "\r%lld of %s%lld samples%s, %lld failed, %.3g /s, %.0f s left     ",
            (long long)counts->done, open_end ? "at most " : "", (long long)counts->samples, look,
            (long long)counts->failed, rate, (double)(next - counts->done) / rate);
    fflush(stderr);
}

// "start 2 of 4, 134 launches, 83.1 /s, chi2 12.3".
void progress_launches(void *self, const ld_fit_counts *counts)
{
    run_progress *progress = self;
    double time = now();
    char chi2[48] = "";
    if (!progress->shown || time - progress->latest < 0.2)
        return;
    progress->latest = time;
    progress->drawn = true;
    if (counts->chi2 == counts->chi2)
        snprintf(chi2, sizeof chi2, ", chi2 %.4g", counts->chi2);
    fprintf(stderr, "\r%.60s, %lld launches, %.3g /s%s     ", counts->stage,
            (long long)counts->launches, (double)counts->launches / (time - progress->start), chi2);
    fflush(stderr);
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
