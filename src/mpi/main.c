// launchdyn-mpi: `launchdyn study FILE --out DIR` on the processes that mpirun starts.
#include <inttypes.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "base/random.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/study.h"
#include "cli/words/page.h"
#include "launchdyn/scenario.h"
#include "launchdyn/version.h"
#include "mpi/hand_out.h"
#include "studies/plan/study.h"

static const command study_command = {
    .name = "study",
    .program = "launchdyn-mpi",
    .arguments = "FILE",
    .words = 1,
    .summary = "Run the samples of a study on all processes that mpirun started",
    .about = "Each sample goes to the next free process; the first process stores the results in "
             "DIR. They equal those of launchdyn study bit for bit, and each of both programs "
             "continues a study of the other.",
    .examples = "mpirun -n 4 launchdyn-mpi study scenario.yaml --out out|Run or continue on four "
                "processes"};

// The lowest number that any process gives.
static int lowest(int number)
{
    int least;
    MPI_Allreduce(&number, &least, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    return least;
}

// Whether all processes give the same.
static bool is_everywhere(uint64_t number)
{
    uint64_t both[2] = {number, ~number}, least[2];
    MPI_Allreduce(both, least, 2, MPI_UINT64_T, MPI_MIN, MPI_COMM_WORLD);
    return least[0] == ~least[1];
}

// What the processes must agree on before they begin.
static uint64_t identity(const ld_study *study)
{
    char *text = NULL;
    size_t length;
    FILE *stream = memory_stream(&text, &length);
    if (!stream)
        return 0;
    ld_model_print(ld_study_model(study), stream);
    fprintf(stream, "%zu %zu %s", sizeof(study_wishes), record_size(&study->shape), LD_VERSION);
    uint64_t hash = fclose(stream) == 0 ? random_stream(text) : 0;
    free(text);
    return hash;
}

// Reads the scenario in every process. What the first one finds wrong it says itself.
static int read_everywhere(const char *file, const study_wishes *wishes, int process,
                           ld_study **study)
{
    int processes;
    MPI_Comm_size(MPI_COMM_WORLD, &processes);
    *study = NULL;
    ld_status status =
        study_read_planned(file, wishes->run.sets, (ld_index)wishes->view.index, study);
    int failed = lowest(status ? process : processes);
    if (failed < processes) {
        if (failed > 0)
            command_complain("process %d cannot read %s as process 0 does", failed, file);
        return status ? command_code(status) : EXIT_INPUT;
    }
    ld_error error;
    status = study_check(*study, &error);
    if (status)
        return command_fail(status, &error);
    if (is_everywhere(identity(*study)))
        return 0;
    command_complain("the processes read different scenarios from %s, or have different versions",
                     file);
    return EXIT_INPUT;
}

static int lead_study(const ld_study *study, const study_wishes *wishes)
{
    return study_run_all(study, wishes, mpi_study_lead);
}

static int follow_study(const ld_study *study)
{
    run_progress progress;
    progress_start(&progress, true);
    mpi_study_follow(study, progress_resume, &progress);
    return 0;
}

static int run_study(const char *file, const study_wishes *wishes, int process)
{
    ld_study *study;
    if (wishes->view.sensitivity && wishes->view.index == LD_INDEX_USUAL) {
        command_complain("--sensitivity requires total, first or morris");
        return EXIT_INPUT;
    }
    if (!wishes->run.folder) {
        command_complain("study requires --out DIR, the folder of the study");
        return EXIT_INPUT;
    }
    int code = read_everywhere(file, wishes, process, &study);
    if (!code)
        code = study_take_notes(study, wishes);
    if (!code)
        code = process == 0 ? lead_study(study, wishes) : follow_study(study);
    ld_study_free(study);
    return code;
}

#define MPI_OPTIONS(wishes, word)                                                                  \
    STUDY_OPTIONS(wishes),                                                                         \
        {"sensitivity",                                                                            \
         '\0',                                                                                     \
         OPTION_WORD,                                                                              \
         word,                                                                                     \
         "Run with the plan for these sensitivities: total and first-order Sobol indices, or "     \
         "Morris's elementary effects",                                                            \
         "total|first|morris"},                                                                    \
        COMMAND_USUAL

// Whether help alone is asked for, which requires no MPI: study --help, --help, or help --man,
// which prints the manual page.
static bool asks_for_help(int argc, char **argv)
{
    const char *first = argc > 1 ? argv[1] : "", *second = argc > 2 ? argv[2] : "";
    const char *word = strcmp(first, "study") == 0 ? second : first;
    return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 || strcmp(word, "help") == 0;
}

static int print_help(int argc, char **argv)
{
    study_wishes wishes = {0};
    char *word = NULL;
    const command_option options[] = {MPI_OPTIONS(&wishes, &word)};
    if (argc > 2 && strcmp(argv[2], "--man") == 0)
        help_choose(page_print);
    help_print(&study_command, options);
    return command_end(0);
}

static int run_command(int argc, char **argv, int process)
{
    study_wishes wishes = {0};
    char *word = NULL;
    const command_option options[] = {MPI_OPTIONS(&wishes, &word)};
    command_line line;
    int code = EXIT_INPUT;
    if (argc < 2 || strcmp(argv[1], "study") != 0) {
        command_complain("launchdyn-mpi has one command: study FILE --out DIR");
        return EXIT_INPUT;
    }
    if (command_line_read(&line, &study_command, argc - 1, argv + 1, options, &code)) {
        wishes.view.sensitivity = word != NULL;
        wishes.view.index = (unsigned char)study_index_of(word);
        code = run_study(line.word[0], &wishes, process);
        options_end(&line);
    }
    return code;
}

// The program's words.
typedef struct program_call {
    int argc;
    char **argv;
} program_call;

static int take_part(void *data)
{
    program_call *call = data;
    int given, process;
    MPI_Init_thread(&call->argc, &call->argv, MPI_THREAD_FUNNELED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &process);
    // one of them talks
    if (process > 0 && (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)))
        MPI_Abort(MPI_COMM_WORLD, EXIT_SYSTEM);
    int code = command_begin();
    if (!code && given >= MPI_THREAD_FUNNELED) {
        code = run_command(call->argc, call->argv, process);
    } else if (!code) {
        command_complain("this MPI library does not support threads");
        code = EXIT_SYSTEM;
    }
    MPI_Finalize();
    return process == 0 ? code : 0;
}

// What mpirun starts waits for the process that takes part: no thread of MPI is there yet.
int main(int argc, char **argv)
{
    if (asks_for_help(argc, argv))
        return print_help(argc, argv);
    return command_in_child(take_part, &(program_call){argc, argv});
}
