// launchdyn fit: keys of a scenario fitted to measured launches.
#include "launchdyn/fit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/progress.h"

enum { MOST_KEYS = 32, MOST_LOGS = 16 };

typedef struct fit_wishes {
    char **sets, **over, **priors, **logs, **sensors;
    char *folder, *picture;
    int threads, starts, seed, json, strict;
    const char *const *files;
    size_t file_count, key_count, log_count;
    ld_fit_key key[MOST_KEYS];
} fit_wishes;

// Cuts "KEY=FIRST...SECOND" at the sign between the numbers, in place; false after a message.
static bool cut(const char *option, char *text, const char *sign, char **first, char **second)
{
    char *equals = strchr(text, '='), *between = equals ? strstr(equals + 1, sign) : NULL;
    if (!between) {
        command_complain("--%s: expected KEY=%s, found %s", option,
                         strcmp(sign, "..") == 0 ? "FROM..TO" : "MEAN+-DEVIATION", text);
        return false;
    }
    *equals = *between = '\0';
    *first = equals + 1;
    *second = between + strlen(sign);
    return true;
}

static char *trimmed(char *text)
{
    text += strspn(text, " \t");
    for (size_t length = strlen(text); length > 0 && strchr(" \t", text[length - 1]);)
        text[--length] = '\0';
    return text;
}

static bool read_over(fit_wishes *wishes)
{
    for (size_t i = 0; wishes->over && wishes->over[i]; i++) {
        char *from, *to;
        if (wishes->key_count == MOST_KEYS) {
            command_complain("--over: more than %d keys", MOST_KEYS);
            return false;
        }
        if (!cut("over", wishes->over[i], "..", &from, &to))
            return false;
        wishes->key[wishes->key_count++] = (ld_fit_key){
            .path = trimmed(wishes->over[i]), .from = trimmed(from), .to = trimmed(to)};
    }
    return true;
}

static bool read_prior(fit_wishes *wishes, char *text)
{
    char *mean, *deviation;
    if (!cut("prior", text, "+-", &mean, &deviation))
        return false;
    for (size_t i = 0; i < wishes->key_count; i++) {
        ld_fit_key *key = &wishes->key[i];
        if (strcmp(key->path, trimmed(text)) == 0) {
            key->mean = trimmed(mean);
            key->deviation = trimmed(deviation);
            return true;
        }
    }
    command_complain("--prior: %s is not among the keys of --over", trimmed(text));
    return false;
}

static bool read_keys(fit_wishes *wishes)
{
    bool good = read_over(wishes);
    for (size_t i = 0; good && wishes->priors && wishes->priors[i]; i++)
        good = read_prior(wishes, wishes->priors[i]);
    if (good && wishes->key_count == 0)
        command_complain("fit requires --over KEY=FROM..TO, a key to be fitted with its bounds");
    return good && wishes->key_count > 0;
}

static size_t count_texts(char *const *texts)
{
    size_t count = 0;
    while (texts && texts[count])
        count++;
    return count;
}

// What keeps the numbers from being possible; NULL: nothing.
static const char *wrong_number(const fit_wishes *wishes)
{
    enum { MOST_STARTS = 1000 };
    if (command_wrong_jobs(wishes->threads))
        return command_wrong_jobs(wishes->threads);
    if (wishes->starts < 1 || wishes->starts > MOST_STARTS)
        return "--starts: expected a number from 1 to 1000";
    if (wishes->log_count > MOST_LOGS)
        return "--log: expected at most 16 logs";
    if (count_texts(wishes->sensors) > wishes->log_count)
        return "--sensors: expected a --log for each";
    return NULL;
}

static int run_fit(ld_fit *fit, const fit_wishes *wishes)
{
    run_progress progress;
    ld_error error;
    progress_start(&progress, command_is_quiet());
    const ld_fit_options options = {.folder = wishes->folder,
                                    .threads = wishes->threads,
                                    .starts = wishes->starts,
                                    .seed = wishes->seed,
                                    .self = &progress,
                                    .progress = progress_launches,
                                    .go_on = progress_resume};
    ld_status status = ld_fit_run(fit, &options, &error);
    progress_end(&progress);
    command_step("fitted");
    if (status)
        return command_fail(status, &error);
    if (wishes->json)
        ld_fit_print_json(fit, stdout);
    else
        ld_fit_print(fit, command_text());
    if (wishes->picture) {
        status = ld_fit_draw(fit, wishes->picture, &error);
        command_step("drew %s", wishes->picture);
    }
    return status ? command_fail(status, &error) : 0;
}

// Descriptions are those of the first logs.
static ld_status add_logs(ld_fit *fit, const fit_wishes *wishes, ld_error *error)
{
    const char *sensors[MOST_LOGS] = {NULL}, *logs[MOST_LOGS] = {NULL};
    for (size_t i = 0; i < wishes->log_count; i++)
        logs[i] = wishes->logs[i];
    for (size_t i = 0; i < count_texts(wishes->sensors); i++)
        sensors[i] = wishes->sensors[i];
    return ld_fit_add_logs(fit, logs, sensors, wishes->log_count, error);
}

static int fit_model(const ld_model *model, void *data)
{
    const fit_wishes *wishes = data;
    ld_fit *fit = NULL;
    ld_error error;
    int code = command_take_notes(ld_model_source(model), 0, 0, wishes->strict != 0);
    if (code)
        return code;
    ld_status status = ld_fit_create(model, wishes->key, wishes->key_count, wishes->files,
                                     wishes->file_count, &fit, &error);
    if (!status && wishes->log_count > 0)
        status = add_logs(fit, wishes, &error);
    code = status ? command_fail(status, &error) : run_fit(fit, wishes);
    ld_fit_free(fit);
    return code;
}

int command_fit(const command *self, int argc, char **argv)
{
    fit_wishes wishes = {.threads = 1, .starts = 4};
    const command_option options[] = {
        {"over", '\0', OPTION_TEXTS, &wishes.over,
         "Fit this key between these bounds (can be repeated)", "KEY=FROM..TO"},
        {"prior", '\0', OPTION_TEXTS, &wishes.priors,
         "What is known of a fitted key beforehand: mean and standard deviation (can be repeated)",
         "KEY=MEAN+-DEV"},
        {"log", '\0', OPTION_TEXTS, &wishes.logs,
         "Fit to the series of this log, too (can be repeated)", "LOG.csv"},
        {"sensors", '\0', OPTION_TEXTS, &wishes.sensors,
         "What that log's sensors are (LOG.yaml beside LOG.csv; can be repeated)", "FILE"},
        COMMAND_SETS(&wishes.sets),
        COMMAND_STRICT(&wishes.strict),
        {"out", 'o', OPTION_TEXT, &wishes.folder,
         "Folder for fit.json, fitted.yaml and the state by which a fit continues", "DIR"},
        COMMAND_JOBS(&wishes.threads, "launches"),
        {"starts", '\0', OPTION_INTEGER, &wishes.starts,
         "Number of starts: the scenario's values, then random ones (4)", "N"},
        {"seed", '\0', OPTION_INTEGER, &wishes.seed, "Seed of the random starts (0)", "N"},
        {"plot", '\0', OPTION_TEXT, &wishes.picture,
         "Draw measured and fitted values and the intervals: FILE.svg, FILE.pdf or FILE.png",
         "FILE"},
        COMMAND_JSON(&wishes.json),
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (!command_line_read(&line, self, argc, argv, options, &code))
        return code;
    wishes.files = line.word + 1;
    wishes.log_count = count_texts(wishes.logs);
    wishes.file_count = line.count > 0 ? line.count - 1 : 0;
    code = EXIT_INPUT;
    if (line.count > 0 && wishes.file_count + wishes.log_count == 0)
        command_complain("fit requires DATA or --log; see launchdyn fit --help");
    else if (line.count < 1)
        command_complain("fit requires %s; see launchdyn fit --help", self->arguments);
    else if (wrong_number(&wishes))
        command_complain("%s", wrong_number(&wishes));
    else if (read_keys(&wishes))
        code = command_on_file(line.word[0], wishes.sets, fit_model, &wishes);
    options_end(&line);
    return code;
}
