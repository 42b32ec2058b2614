// launchdyn study: many samples of a scattered scenario, kept in a folder; what is in such a
// folder.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/study.h"
#include "launchdyn/origin.h"
#include "launchdyn/scenario.h"

int study_take_notes(const ld_study *study, const study_wishes *wishes)
{
    const ld_model *nominal = ld_study_model(study);
    int axes = ld_scenario_axes(nominal);
    return command_take_notes(ld_model_source(nominal), axes > 0 ? 1 : 0,
                              axes > 0 ? ld_scenario_points(nominal) : 0, wishes->run.strict != 0);
}

static int report_all_failed(const ld_study_counts *counts)
{
    command_complain("all %lld samples failed; launchdyn study show lists why",
                     (long long)counts->done);
    return command_code(LD_ERR_LAUNCH);
}

// What one of several processes says at its end.
static void print_part(const study_wishes *wishes, const ld_study_counts *counts)
{
    char folder[1024];
    ld_visible_text(wishes->run.folder, folder, sizeof folder);
    if (wishes->shards)
        printf(
            "shard %d of %d: %lld samples, %lld failed; when all shards are done: launchdyn study "
            "merge %s\n",
            wishes->shard, wishes->shards, (long long)counts->done, (long long)counts->failed,
            folder);
    if (wishes->join)
        printf("%s: %lld samples, %lld failed; this process ran %lld; launchdyn study show %s\n",
               folder, (long long)counts->done, (long long)counts->failed, (long long)counts->now,
               folder);
}

int study_run_all(const ld_study *study, const study_wishes *wishes, study_runner *run)
{
    run_progress progress;
    ld_study_counts counts;
    ld_error error;
    progress_start(&progress, command_is_quiet());
    ld_study_options options = {.threads = wishes->threads,
                                .shard = wishes->shard,
                                .shards = wishes->shards,
                                .expiry = wishes->expiry,
                                .self = &progress,
                                .progress = progress_samples,
                                .go_on = progress_resume};
    ld_status status = run(study, wishes->run.folder, &options, &counts, &error);
    progress_end(&progress);
    command_step("ran %lld samples into %s", (long long)counts.now, wishes->run.folder);
    if (!status && !command_is_quiet())
        print_part(wishes, &counts);
    if (!status && !command_is_quiet() && counts.look > 0)
        printf("the stopping rule is %s after %lld samples\n", counts.enough ? "met" : "not met",
               (long long)counts.samples);
    if (!status && !command_is_quiet() && !wishes->shards && !wishes->join)
        status = ld_study_show(wishes->run.folder, &wishes->view, stdout, &error);
    if (status)
        return command_fail(status, &error);
    return counts.done > 0 && counts.failed == counts.done ? report_all_failed(&counts) : 0;
}

// One sample of a study, with its whole history, in a folder of its own.
static int run_one(const ld_study *study, const study_wishes *wishes)
{
    ld_sample *sample = NULL;
    ld_error error;
    char folder[4096];
    ld_status status = ld_study_sample(study, wishes->only, &sample, &error);
    if (status)
        return command_fail(status, &error);
    run_wishes run = wishes->run;
    snprintf(folder, sizeof folder, "%s/sample-%d", run.folder ? run.folder : "", wishes->only);
    run.folder = run.folder ? folder : NULL;
    int code = run_model(ld_sample_model(sample), &run);
    ld_sample_free(sample);
    return code;
}

// Runs a study, which is freed.
static int study_do(ld_study *study, study_wishes *wishes)
{
    int code = study_take_notes(study, wishes);
    if (!code && wishes->only != ALL_SAMPLES) {
        code = run_one(study, wishes);
    } else if (!code && wishes->run.folder) {
        code = study_run_all(study, wishes, wishes->join ? ld_study_join : ld_study_run);
    } else if (!code) {
        command_complain("study requires --out DIR, the folder of the study");
        code = EXIT_INPUT;
    }
    ld_study_free(study);
    return code;
}

// The overrides that give the samples the plan for these sensitivities, and after them those given;
// to be freed. NULL: no memory.
static char **with_plan(char **sets, ld_index index)
{
    static char saltelli[] = "scatter.plan=saltelli", morris[] = "scatter.plan=morris",
                one[] = "scatter.replicates=1"; // not those of hypercubes
    size_t count = 0;
    while (sets && sets[count])
        count++;
    char **all = calloc(count + 3, sizeof *all);
    if (!all)
        return NULL;
    const size_t own = index == LD_INDEX_MORRIS ? 1 : 2;
    all[0] = index == LD_INDEX_MORRIS ? morris : saltelli;
    all[1] = one;
    for (size_t i = 0; i <= count; i++)
        all[own + i] = i < count ? sets[i] : NULL;
    return all;
}

ld_status study_read_planned(const char *file, char **sets, ld_index index, ld_study **study)
{
    char **planned = index ? with_plan(sets, index) : NULL;
    if (index && !planned)
        return LD_ERR_MEMORY;
    ld_status status = command_read_study(file, index ? planned : sets, study);
    free(planned);
    return status;
}

static int study_file(const char *file, study_wishes *wishes)
{
    ld_study *study = NULL;
    ld_status status =
        study_read_planned(file, wishes->run.sets, (ld_index)wishes->view.index, &study);
    return status ? command_code(status) : study_do(study, wishes);
}

// The study that a folder holds, from the texts that it keeps.
static int study_again(const char *folder, study_wishes *wishes)
{
    ld_study *study = NULL;
    ld_origin origin;
    ld_error error;
    ld_status status = ld_study_read_origin(folder, &origin, &error);
    if (status)
        return command_fail(status, &error);
    int code = EXIT_INPUT;
    if (!origin.source) {
        command_complain("%s cannot be repeated: its model was not read from a scenario", folder);
    } else if ((status = command_read_study_source(origin.source, &study)) != LD_OK) {
        code = command_code(status);
    } else {
        command_warn_difference(folder, &origin);
        code = study_do(study, wishes);
    }
    ld_origin_free(&origin);
    return code;
}

static int finish(ld_status status, const ld_error *error, const char *done, const char *folder)
{
    if (!status)
        command_step("%s %s", done, folder);
    return status ? command_fail(status, error) : 0;
}

// What keeps these options from being those of a study to be shown; NULL: nothing.
static const char *wrong_to_show(const study_wishes *wishes)
{
    const ld_study_view *view = &wishes->view;
    const bool rows = view->over || wishes->statistic;
    if (view->measured && (view->sensitivity || view->against || rows))
        return "--measured excludes --sensitivity, --against, --over and --statistic";
    if (view->sensitivity && (view->against || rows))
        return "--sensitivity excludes --against, --over and --statistic";
    if (wishes->map)
        return "--map requires study plot DIR";
    if (wishes->footprint)
        return "--footprint requires study export DIR";
    if (wishes->hdf5 || (wishes->csv && !view->against && !rows))
        return "--csv and --hdf5 require study export DIR, or --csv study show DIR with --over, "
               "--against or --statistic";
    return NULL;
}

static bool is_same(const char *file, const char *other)
{
    return file && other && strcmp(file, other) == 0;
}

static ld_status export_files(const char *folder, const study_wishes *wishes, ld_error *error)
{
    ld_status status = LD_OK;
    if (wishes->csv || wishes->hdf5)
        status = ld_study_export(folder, wishes->csv, wishes->hdf5, error);
    return status || !wishes->footprint
               ? status
               : ld_study_export_footprint(folder, wishes->footprint, error);
}

// The picture in the file that --out names, else in the study's folder.
static int study_plot(const char *folder, const study_wishes *wishes)
{
    const ld_study_view *view = &wishes->view;
    const ld_study_question question = {.what = view->what,
                                        .over = view->over,
                                        .against = view->against,
                                        .statistic = wishes->statistic,
                                        .map = wishes->map,
                                        .sensitivity = view->sensitivity,
                                        .index = view->index};
    char file[4096];
    ld_error error;
    if (view->json || view->measured || wishes->csv) {
        command_complain("study plot takes --what, --over, --and, --against, --statistic, --map, "
                         "--sensitivity and --out");
        return EXIT_INPUT;
    }
    if (view->sensitivity && (view->over || view->against || wishes->statistic || wishes->map)) {
        command_complain("study plot --sensitivity takes --what and --out");
        return EXIT_INPUT;
    }
    snprintf(file, sizeof file, "%s%s", wishes->run.folder ? wishes->run.folder : folder,
             wishes->run.folder ? "" : "/plot.svg");
    ld_status status = ld_study_plot(folder, &question, file, &error);
    if (!status && !wishes->run.folder && !command_is_quiet())
        printf("%s\n", file);
    return finish(status, &error, "drew", file);
}

static int study_folder(const char *verb, const char *folder, const study_wishes *wishes)
{
    const ld_study_view *view = &wishes->view;
    ld_error error;
    const char *wrong = wrong_to_show(wishes);
    if (wishes->and_over && !wishes->over) {
        command_complain("--and requires --over KEY");
        return EXIT_INPUT;
    }
    if (strcmp(verb, "plot") == 0)
        return study_plot(folder, wishes);
    if (strcmp(verb, "show") == 0 && wrong) {
        command_complain("%s", wrong);
        return EXIT_INPUT;
    }
    if (strcmp(verb, "show") == 0)
        return finish(ld_study_show_statistic(folder, wishes->statistic, view,
                                              view->json ? stdout : command_text(), &error),
                      &error, "read", folder);
    if (strcmp(verb, "merge") == 0)
        return finish(ld_study_merge(folder, command_text(), &error), &error, "merged", folder);
    bool same = is_same(wishes->csv, wishes->hdf5) || is_same(wishes->csv, wishes->footprint);
    if (strcmp(verb, "export") == 0 && (wishes->csv || wishes->hdf5 || wishes->footprint) && !same)
        return finish(export_files(folder, wishes, &error), &error, "exported", folder);
    if (strcmp(verb, "export") == 0)
        command_complain(
            same ? "study export requires different files for --csv, --hdf5 and --footprint"
                 : "study export requires --csv FILE, --hdf5 FILE or --footprint FILE");
    else
        command_complain("study: expected show DIR, plot DIR, export DIR or merge DIR, found %s",
                         verb);
    return EXIT_INPUT;
}

// "3/64"
static bool read_shard(const char *text, study_wishes *wishes)
{
    int length = 0;
    if (sscanf(text, "%d/%d%n", &wishes->shard, &wishes->shards, &length) == 2 && length > 0 &&
        text[length] == '\0' && wishes->shards >= 1 && wishes->shard >= 1 &&
        wishes->shard <= wishes->shards)
        return true;
    command_complain("--shard: expected I/N, from 1/N to N/N, found %s", text);
    return false;
}

// What keeps these options from being those of a study to be run; NULL: nothing.
static const char *wrong_to_run(const char *file, const char *again, const study_wishes *wishes)
{
    enum { MOST_EXPIRY = 86400 };
    if (again && (file || wishes->run.sets))
        return "--again FOLDER repeats the study stored in FOLDER; it excludes other arguments and "
               "--set";
    if (again)
        file = "";
    if (strcmp(file, "show") == 0 || strcmp(file, "plot") == 0 || strcmp(file, "export") == 0 ||
        strcmp(file, "merge") == 0)
        return "study show, study plot, study export and study merge require DIR";
    if (wishes->csv || wishes->hdf5 || wishes->footprint)
        return "--csv, --hdf5 and --footprint require study export DIR";
    const ld_study_view *view = &wishes->view;
    if (view->what || view->json || view->measured || view->against)
        return "--what, --json, --measured and --against require study show DIR";
    if (view->sensitivity && view->index == LD_INDEX_USUAL)
        return "--sensitivity requires total, first or morris, or study show DIR";
    if (view->sensitivity && again)
        return "--sensitivity excludes --again FOLDER, which repeats the plan stored in FOLDER";
    if (view->over || wishes->and_over || wishes->statistic || wishes->map)
        return "--over, --and, --statistic and --map require study show DIR or study plot DIR";
    if (wishes->shards && wishes->only != ALL_SAMPLES)
        return "--only and --shard exclude each other";
    if (wishes->join && (wishes->shards || wishes->only != ALL_SAMPLES))
        return "--join excludes --shard and --only";
    if (wishes->expiry && !wishes->join)
        return "--expiry requires --join";
    if (wishes->join && (wishes->expiry < 0 || wishes->expiry > MOST_EXPIRY))
        return "--expiry: expected a number of seconds from 1 to 86400";
    return command_wrong_jobs(wishes->threads);
}

ld_index study_index_of(const char *word)
{
    static const char *const words[] = {"", "total", "first", "morris"};
    int index = word ? LD_INDEX_MORRIS : LD_INDEX_USUAL;
    while (index > LD_INDEX_USUAL && strcmp(word, words[index]) != 0)
        index--;
    return (ld_index)index;
}

// "KEY,KEY"; NULL: none.
static const char *join_keys(study_wishes *wishes)
{
    if (!wishes->over)
        return NULL;
    snprintf(wishes->keys, sizeof wishes->keys, "%.500s%s%.500s", wishes->over,
             wishes->and_over ? "," : "", wishes->and_over ? wishes->and_over : "");
    return wishes->keys;
}

int command_study(const command *self, int argc, char **argv)
{
    study_wishes wishes = {.threads = 1, .only = ALL_SAMPLES};
    char *shard = NULL, *what = NULL, *measured = NULL, *against = NULL, *again = NULL,
         *sensitivity = NULL;
    int json = 0;
    const command_option options[] = {
        STUDY_OPTIONS(&wishes),
        {"again", '\0', OPTION_TEXT, &again,
         "Repeat the study stored in FOLDER, bit for bit, in place of FILE", "FOLDER"},
        COMMAND_JOBS(&wishes.threads, "samples"),
        {"only", '\0', OPTION_INTEGER, &wishes.only,
         "Run sample N only, with its history in DIR/sample-N", "N"},
        {"shard", '\0', OPTION_TEXT, &shard, "Run only part I of N of the study; then merge DIR",
         "I/N"},
        {"join", '\0', OPTION_FLAG, &wishes.join,
         "Compute the study together with all processes that run the same command", NULL},
        {"expiry", '\0', OPTION_INTEGER, &wishes.expiry,
         "For --join: time without a sign of life after which others take over the samples of a "
         "process, in seconds (60)",
         "S"},
        {"what", 'w', OPTION_TEXT, &what, "For show, plot: results, or all", "NAME,..."},
        {"sensitivity", '\0', OPTION_WORD, &sensitivity,
         "Run with the plan for these sensitivities: total and first-order Sobol indices, or "
         "Morris's elementary effects; for show, plot: print or draw them, without a word those of "
         "the samples",
         "total|first|morris"},
        {"json", '\0', OPTION_FLAG, &json, "For show: print as JSON, in full precision", NULL},
        {"measured", '\0', OPTION_TEXT, &measured,
         "For show: compare the results with the measured launches in this CSV file", "FILE"},
        {"against", '\0', OPTION_TEXT, &against,
         "For show, plot: differences from this point, given by number or KEY=VALUE,...", "POINT"},
        {"over", '\0', OPTION_TEXT, &wishes.over,
         "For show, plot: a row, or a place on the axis, for each value of this swept key, pooled "
         "over the other keys",
         "KEY"},
        {"and", '\0', OPTION_TEXT, &wishes.and_over,
         "For show, plot: a second swept key, of plot as a family of curves or a map", "KEY"},
        {"statistic", '\0', OPTION_TEXT, &wishes.statistic,
         "For show, plot: mean (default of plot), deviation, quantile:P, share:>LIMIT, "
         "share:<LIMIT or footprint[:SHARE]",
         "NAME"},
        {"map", '\0', OPTION_FLAG, &wishes.map, "For plot: draw two keys as a map", NULL},
        {"csv", '\0', OPTION_TEXT, &wishes.csv,
         "For export: write the table as CSV; for show --over, --against, --statistic: write the "
         "rows",
         "FILE"},
        {"hdf5", '\0', OPTION_TEXT, &wishes.hdf5, "For export: write the table as HDF5", "FILE"},
        {"footprint", '\0', OPTION_TEXT, &wishes.footprint,
         "For export: write the footprints with 95, 99 and 99.9 % of the landing points, for range "
         "safety, as .csv, .kml or .geojson",
         "FILE"},
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, &code)) {
        const char *file = line.count > 0 ? line.word[0] : NULL;
        command_tell_renamed(what);
        wishes.view = (ld_study_view){.what = what,
                                      .sensitivity = sensitivity != NULL,
                                      .index = (unsigned char)study_index_of(sensitivity),
                                      .json = json,
                                      .measured = measured,
                                      .against = against,
                                      .csv = wishes.csv,
                                      .over = join_keys(&wishes)};
        if (shard && !read_shard(shard, &wishes)) {
            code = EXIT_INPUT;
        } else if (line.count == 2 && !again) {
            code = study_folder(file, line.word[1], &wishes);
        } else if (!again && line.count != 1) {
            command_complain("study requires %s; see launchdyn study --help", self->arguments);
            code = EXIT_INPUT;
        } else if (wrong_to_run(file, again, &wishes)) {
            command_complain("%s", wrong_to_run(file, again, &wishes));
            code = EXIT_INPUT;
        } else {
            code = again ? study_again(again, &wishes) : study_file(file, &wishes);
        }
        options_end(&line);
    }
    return code;
}
