// The command launchdyn: a table of commands, and which of them is meant.
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "launchdyn/version.h"

static int command_help(const command *self, int argc, char **argv);
static int command_version(const command *self, int argc, char **argv);

static const command commands[] = {
    {"run", "FILE", "Simulate the launch that a scenario file describes", NULL, command_run, true},
    {"study", "FILE | show DIR | export DIR | merge DIR",
     "Run the samples of a scattered scenario, or show what a study has found", command_study_help,
     command_study, true},
    {"check", "FILE", "Check a scenario file and print what was understood, in SI", NULL,
     command_check, true},
    {"modes", "FILE", "List natural frequencies and damping", NULL, command_modes, true},
    {"plot", "DIR...", "Draw figures of one run, or of several laid one over the other",
     command_plot_help, command_plot, true},
    {"report", "DIR...",
     "Write one HTML file that shows runs or studies, offline and in any browser", NULL,
     command_report, true},
    {"fmu", "export FILE", "Write a Functional Mock-up Unit of the launch, for other simulators",
     NULL, command_fmu, true},
    {"road", "FILE", "Show profile and spectrum of the road of a vehicle", NULL, command_road,
     true},
    {"response", "FILE",
     "Show what the launcher answers to road, base, commands and forces, linear", NULL,
     command_response, true},
    {"wind", "FILE", "Show profile, gusts and turbulence of the wind", NULL, command_wind, true},
    {"version", "", "Print the version", NULL, command_version, false},
    {"help", "[COMMAND]", "Print this, or the help of a command", NULL, command_help, false},
};

enum { COMMANDS = sizeof commands / sizeof *commands };

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
    enum { NAME = 10, ARGUMENTS = 11 };
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
    return chosen->apart ? command_apart(do_call, &words) : do_call(&words);
}

static bool asks_for_help(const char *word)
{
    return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0;
}

static int command_help(const command *self, int argc, char **argv)
{
    (void)self;
    if (argc < 2 || asks_for_help(argv[1])) {
        print_commands(stdout);
        return 0;
    }
    const command *chosen = find(argv[1]);
    if (!chosen)
        return complain_unknown(argv[1]);
    if (chosen->run == command_help || chosen->run == command_version) {
        print_commands(stdout);
        return 0;
    }
    char option[] = "--help", *help[] = {argv[0], option, NULL};
    return start(chosen, 2, help);
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
    const command *chosen = find(name);
    return chosen ? start(chosen, argc - 1, argv + 1) : complain_unknown(name);
}

int main(int argc, char **argv)
{
    int code = command_begin();
    return code ? code : dispatch(argc, argv);
}
