// The command launchdyn: a table of commands, and which of them is meant.
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/words/complete.h"
#include "cli/words/page.h"
#include "launchdyn/version.h"

static int command_help(const command *self, int argc, char **argv);
static int command_version(const command *self, int argc, char **argv);

static const command commands[] = {
    {.name = "new",
     .arguments = "",
     .summary = "Write a commented first scenario that is ready to run",
     .about = "The scenario has a rocket in a tube or on a rail, on the ground, a vehicle, a "
              "ship, a trailer on jacks or a swinging link. On a terminal, new asks for what no "
              "option sets. It never overwrites a file.",
     .examples = "launchdyn new --guide rail --base ship --out scenario.yaml|A rail on a ship\n"
                 "launchdyn new|Ask for everything",
     .run = command_new,
     .in_child = true},
    {.name = "run",
     .arguments = "FILE",
     .words = COMMAND_ANY,
     .summary = "Simulate the launch that a scenario file describes",
     .about = "Prints a table of the launch; --out writes the results into a folder. --again "
              "FOLDER repeats the run stored in FOLDER, bit for bit. Ctrl-C stops the run and "
              "keeps the results so far.",
     .examples = "launchdyn run scenario.yaml --out out --report|Run and write a report into out\n"
                 "launchdyn run scenario.yaml --set rocket.mass='61 kg'|With another mass\n"
                 "launchdyn run --again out --out again|Repeat the run stored in out",
     .run = command_run,
     .in_child = true},
    {.name = "live",
     .arguments = "FILE",
     .words = 1,
     .summary = "Serve a page that simulates to a browser of this machine",
     .about = "Prints the address of a page with sliders for the scenario's main numbers, replay "
              "and plots. "
              "launchdyn computes each launch. The address is on this machine alone and "
              "has a random token, without which nothing is answered. Launches open no file "
              "outside the folder of FILE. Ctrl-C ends. libcivetweb is required.",
     .examples = "launchdyn live scenario.yaml|Print an address to open in a browser",
     .run = command_live,
     .in_child = true},
    {.name = "study",
     .arguments = "FILE | show DIR | plot DIR | export DIR | merge DIR",
     .words = COMMAND_ANY,
     .summary = "Run a Monte Carlo study or a sweep, or show its results",
     .about =
         "launchdyn study FILE --out DIR runs the samples that DIR lacks; after an interruption "
         "the same command continues. launchdyn study show DIR prints statistics, also during the "
         "run. launchdyn study plot DIR draws results over swept keys (-o FILE.svg, FILE.pdf or "
         "FILE.png). launchdyn study export DIR writes the results of all rockets (--csv FILE, "
         "--hdf5 "
         "FILE) or, for range safety, the footprints of the landing points (--footprint "
         "FILE.kml).\n\nTo share a study among machines, run it on each with --join and the same "
         "DIR: "
         "processes may come, go or be killed. With --shard I/N, I from 1 to N, each runs a fixed "
         "part, and launchdyn study merge DIR then merges the results.",
     .examples =
         "launchdyn study scenario.yaml --out out -j 4|Run or continue, four samples at a time\n"
         "launchdyn study scenario.yaml --out out --join|Run as one of any number of processes\n"
         "launchdyn study show out --what exit_speed,pitch_rate|Statistics of two "
         "results\n"
         "launchdyn study plot out --over rocket.lock.release_force -o lock.svg|Results over a "
         "swept key, with "
         "intervals\n"
         "launchdyn study scenario.yaml --sensitivity total --out rows|Run rows of launches for "
         "Sobol indices\n"
         "launchdyn study export out --csv all.csv|Results of all rockets as a table",
     .run = command_study,
     .in_child = true},
    {.name = "fit",
     .arguments = "FILE [DATA...]",
     .words = COMMAND_WORDS,
     .summary = "Fit keys of a scenario to measured launches",
     .about = "Finds the values of keys, between bounds, at which the scenario's launch has the "
              "results that were measured: weighted least squares from several starts, with "
              "covariance, 95 % profile-likelihood intervals and the combinations of keys that "
              "the data do not tell. DATA are CSV files with a line a launch and columns by the "
              "names of results, with units; NAME_u is the standard uncertainty of NAME. --log "
              "adds series, "
              "as of launchdyn compare. Ctrl-C "
              "stops; the same command with the same --out continues.",
     .examples =
         "launchdyn fit scenario.yaml launches.csv --over rocket.mass=50..70 -o fit|Fit one "
         "key\n"
         "launchdyn run fit/fitted.yaml|Run the fitted scenario",
     .run = command_fit,
     .in_child = true},
    {.name = "optimise",
     .arguments = "FILE",
     .words = 1,
     .summary = "Find the values of keys at which a disturbance, load or time is least",
     .about = "Searches the keys that the scenario's block optimise names, between their bounds, "
              "for the least mean, deviation, quantile or footprint of its study, under "
              "constraints. All candidates have the same sampled numbers; samples of their own "
              "tell what was gained. Ctrl-C stops; the same command with the same --out "
              "continues.",
     .examples = "launchdyn optimise scenario.yaml -j 4 --out best --plot best.svg|Search, with "
                 "the course as a picture\n"
                 "launchdyn run best/optimised.yaml|Run what was found",
     .run = command_optimise,
     .in_child = true},
    {.name = "check",
     .arguments = "FILE",
     .words = 1,
     .summary = "Check a scenario file and print the model in SI units",
     .about = "Reads the scenario and finds the initial state, as a run does before its first "
              "step. The output is a scenario file again.",
     .examples =
         "launchdyn check scenario.yaml|Print all errors or the model\n"
         "launchdyn check scenario.yaml --json --strict|Print JSON; treat warnings as errors",
     .run = command_check,
     .in_child = true},
    {.name = "modes",
     .arguments = "FILE",
     .words = 1,
     .summary = "List natural frequencies and damping",
     .about = "Lists the modes of tube and tail on their supports with the base fixed, and those "
              "of the whole system about its equilibrium.",
     .run = command_modes,
     .in_child = true},
    {.name = "plot",
     .arguments = "DIR...",
     .words = COMMAND_WORDS,
     .summary = "Draw figures of one run, or of several runs overlaid",
     .examples = "launchdyn plot out --what tip,contact -o figure.svg|Two figures of a run",
     .more = command_plot_figures,
     .run = command_plot,
     .in_child = true},
    {.name = "compare",
     .arguments = "DIR LOG",
     .words = COMMAND_WORDS,
     .summary = "Compare a run with a log of what was measured",
     .about =
         "Simulates the log's sensors in the run stored in DIR and prints simulated less "
         "measured (E), its standard uncertainties and a verdict, after ASME V&V 20. LOG.yaml "
         "beside the log says what its sensors are; without it, columns with names of the run's "
         "are compared.",
     .examples = "launchdyn compare out log.csv --refine --samples 50|With numerical and input "
                 "uncertainties",
     .run = command_compare,
     .in_child = true},
    {.name = "report",
     .arguments = "DIR...",
     .words = COMMAND_WORDS,
     .summary = "Write one HTML file with the results of runs or studies; it works offline",
     .examples = "launchdyn report out|Write out/report.html",
     .run = command_report,
     .in_child = true},
    {.name = "fmu",
     .arguments = "export FILE",
     .words = COMMAND_WORDS,
     .summary = "Write a Functional Mock-up Unit of the launch, for other simulators",
     .examples = "launchdyn fmu export scenario.yaml --out launch.fmu|The whole launch, FMI 3.0",
     .run = command_fmu,
     .in_child = true},
    {.name = "road",
     .arguments = "FILE",
     .words = 1,
     .summary = "Show profile and spectrum of the vehicle's road",
     .run = command_road,
     .in_child = true},
    {.name = "sensitivity",
     .arguments = "FILE KEY[=STEP]...",
     .words = COMMAND_WORDS,
     .summary = "Show how a launch's results change with keys of its scenario",
     .about =
         "Prints derivatives of exit figures, instants and flight by keys: central differences "
         "of launches that take the steps of one, so that they differ as smoothly as the "
         "equations do. A star marks results for which the launch is not smooth. STEP is how "
         "far a key is changed to either side, 1e-4 of its value unless given.",
     .examples = "launchdyn sensitivity scenario.yaml rocket.mass base.elevation|By two keys\n"
                 "launchdyn sensitivity scenario.yaml rocket.mass --what pitch_rate --json|One "
                 "result, as JSON",
     .run = command_sensitivity,
     .in_child = true},
    {.name = "response",
     .arguments = "FILE",
     .words = 1,
     .summary = "Show the linear response to road, base motion, commands and forces",
     .about = "Computes root mean squares, spectra and frequency responses of any column of the "
              "history. The equations are linearised about the equilibrium; no run is needed.",
     .run = command_response,
     .in_child = true},
    {.name = "wind",
     .arguments = "FILE",
     .words = 1,
     .summary = "Show profile, gusts and turbulence of the wind",
     .run = command_wind,
     .in_child = true},
    {.name = "version", .arguments = "", .summary = "Print the version", .run = command_version},
    {.name = "help",
     .arguments = "[COMMAND]",
     .summary = "Print this help, or the help of a command",
     .run = command_help},
    {0},
};

enum { COMMANDS = sizeof commands / sizeof *commands - 1 };

static const command *find(const char *name)
{
    for (int i = 0; i < COMMANDS; i++)
        if (strcmp(commands[i].name, name) == 0)
            return &commands[i];
    return NULL;
}

static int complain_unknown(const char *name)
{
    const char *names[COMMANDS];
    for (int i = 0; i < COMMANDS; i++)
        names[i] = commands[i].name;
    const char *nearest = ld_nearest_name(name, names, COMMANDS);
    const char *kind = *name == '-' ? "option" : "command";
    if (nearest)
        command_complain("unknown %s %s (did you mean %s?)", kind, name, nearest);
    else
        command_complain("unknown %s %s; see launchdyn help", kind, name);
    return EXIT_INPUT;
}

static void print_commands(FILE *stream)
{
    fputs("launchdyn simulates how a rocket leaves a flexible tube on a fixed or moving base.\n\n"
          "Usage: launchdyn COMMAND [OPTION...] ...\n\n",
          stream);
    enum { NAME = 13, ARGUMENTS = 11 };
    for (int i = 0; i < COMMANDS; i++) {
        const command *c = &commands[i];
        fprintf(stream, "  %-*s%-*s", NAME, c->name, ARGUMENTS, c->arguments);
        if (strlen(c->arguments) >= ARGUMENTS)
            fprintf(stream, "\n%*s", 2 + NAME + ARGUMENTS, "");
        fprintf(stream, "%s\n", c->summary);
    }
    fputs("\n\"launchdyn COMMAND --help\" lists the options of a command.\n", stream);
}

// A command with its words.
typedef struct call {
    const command *chosen;
    int argc;
    char **argv;
} call;

static int do_call(void *data)
{
    const call *self = data;
    return command_end(self->chosen->run(self->chosen, self->argc, self->argv));
}

static int start(const command *chosen, int argc, char **argv)
{
    call words = {chosen, argc, argv};
    return chosen->in_child ? command_in_child(do_call, &words) : do_call(&words);
}

static bool asks_for_help(const char *word)
{
    return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0;
}

// The help of a command in the form that was chosen.
static int help_of(const command *chosen, char *program)
{
    char option[] = "--help", *help[] = {program, option, NULL};
    return start(chosen, 2, help);
}

// help --man [COMMAND]: its page, or that of all.
static int print_page(int argc, char **argv)
{
    const command *chosen = argc > 2 ? find(argv[2]) : NULL;
    if (argc > 2 && !chosen)
        return complain_unknown(argv[2]);
    help_choose(page_print);
    if (chosen && chosen->in_child)
        return help_of(chosen, argv[0]);
    page_print_all(commands);
    return 0;
}

static int command_help(const command *self, int argc, char **argv)
{
    (void)self;
    if (argc > 1 && strcmp(argv[1], "--man") == 0)
        return print_page(argc, argv);
    if (argc < 2 || asks_for_help(argv[1])) {
        print_commands(stdout);
        return 0;
    }
    const command *chosen = find(argv[1]);
    if (!chosen)
        return complain_unknown(argv[1]);
    if (chosen->in_child)
        return help_of(chosen, argv[0]);
    print_commands(stdout);
    return 0;
}

// complete WORD...: what is allowed in place of the last word, for shells.
static int command_complete(int argc, char **argv)
{
    complete_begin(argc - 1, argv + 1);
    if (argc == 2)
        for (const command *c = commands; c->name; c++)
            complete_offer(c->name, c->summary);
    const command *chosen = argc > 2 ? find(argv[1]) : NULL;
    help_choose(complete_print);
    if (chosen && chosen->in_child)
        return help_of(chosen, argv[0]);
    for (const command *c = commands; c->name && chosen && chosen->run == command_help; c++)
        complete_offer(c->name, c->summary);
    return 0;
}

static int command_version(const command *self, int argc, char **argv)
{
    (void)self;
    if (argc > 1 && asks_for_help(argv[1]))
        print_commands(stdout);
    else
        printf("launchdyn %s\n", ld_version());
    return 0;
}

// The command that the first word names; the usual options stand for commands too.
static int dispatch(int argc, char **argv)
{
    if (argc < 2) {
        print_commands(stderr);
        return EXIT_INPUT;
    }
    const char *name = argv[1];
    if (asks_for_help(name))
        name = "help";
    else if (strcmp(name, "--version") == 0)
        name = "version";
    if (strcmp(name, "complete") == 0)
        return command_end(command_complete(argc - 1, argv + 1));
    const command *chosen = find(name);
    return chosen ? start(chosen, argc - 1, argv + 1) : complain_unknown(name);
}

int main(int argc, char **argv)
{
    int code = command_begin();
    return code ? code : dispatch(argc, argv);
}
