#include "cli/words/complete.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "launchdyn/output.h"
#include "launchdyn/response.h"
#include "launchdyn/scenario.h"
#include "launchdyn/study_data.h"

enum { MOST_WORDS = 8, LONGEST = 512 };

static struct {
    int count;
    char **word;
    const char *last;              // word[count - 1]
    const char *given[MOST_WORDS]; // words before it that are not options
    int given_count;
    char seen[1 << 16]; // what was offered, a line each
} line;

void complete_begin(int count, char **words)
{
    line.count = count;
    line.word = words;
    line.last = words[count - 1];
    strcpy(line.seen, "\n");
}

// Whether it is the first time.
static bool is_new(const char *word)
{
    char entry[LONGEST + 2];
    snprintf(entry, sizeof entry, "\n%s\n", word);
    if (strstr(line.seen, entry) || strlen(line.seen) + strlen(entry) > sizeof line.seen)
        return false;
    strcat(line.seen, entry + 1);
    return true;
}

void complete_offer(const char *word, const char *about)
{
    if (strncmp(word, line.last, strlen(line.last)) == 0 && is_new(word))
        printf("%s\t%s\n", word, about);
}

// A candidate behind the first `length` characters of the last word.
static void offer_behind(size_t length, const char *word, size_t size, const char *end,
                         const char *about)
{
    char whole[LONGEST];
    snprintf(whole, sizeof whole, "%.*s%.*s%s", (int)length, line.last, (int)size, word, end);
    complete_offer(whole, about);
}

static void offer_files(bool folders)
{
    puts(folders ? ":folders" : ":files");
}

// ---- keys of the scenario

typedef struct key_search {
    size_t from;           // where the path begins in the last word
    const ld_model *model; // that the line names, or NULL
} key_search;

// The names of a list's members, by the path up to it; without a model the first number.
static void offer_members(const key_search *self, size_t to, const char *end)
{
    char path[LONGEST], name[128];
    int number = 1;
    for (bool more = self->model != NULL; more; number += more) {
        snprintf(path, sizeof path, "%.*s%d.name", (int)(to - self->from), line.last + self->from,
                 number);
        more = !ld_model_text(self->model, path, name, sizeof name, NULL);
        if (more)
            offer_behind(to, name, strlen(name), end, "member of the list");
    }
    if (number == 1)
        offer_behind(to, "1", 1, end, "member of the list, by its number");
}

// The words of "one of a, b, c".
static void offer_values(const ld_key *key, size_t to)
{
    static const char begin[] = "one of ";
    if (strncmp(key->expected, begin, strlen(begin)) != 0)
        return;
    for (const char *word = key->expected + strlen(begin); *word;) {
        size_t length = strcspn(word, ", ");
        offer_behind(to, word, length, "", key->description);
        word += length;
        word += strspn(word, ", ");
    }
}

// The next segment of a key's path, where those before are in the last word; N stands for any.
static void take_key(void *data, const ld_key *key)
{
    const key_search *self = data;
    const char *typed = line.last + self->from, *path = key->path;
    for (;;) {
        size_t length = strcspn(typed, ".="), segment = strcspn(path, ".");
        bool any = segment == 1 && *path == 'N', leaf = !path[segment];
        if (typed[length] == '\0') {
            size_t to = (size_t)(typed - line.last);
            if (any)
                offer_members(self, to, leaf ? "=" : ".");
            else
                offer_behind(to, path, segment, leaf ? "=" : ".", leaf ? key->description : "");
            return;
        }
        if (!any && (length != segment || strncmp(typed, path, length) != 0))
            return;
        if (typed[length] == '=' || leaf) {
            if (typed[length] == '=' && leaf)
                offer_values(key, (size_t)(typed + length + 1 - line.last));
            return;
        }
        typed += length + 1;
        path += segment + 1;
    }
}

// The model of the scenario on the line; NULL: there is none, or it is wrong.
static ld_model *read_model(void)
{
    ld_model *model = NULL;
    ld_messages messages = {0};
    const char *file = line.given_count ? line.given[line.given_count - 1] : NULL;
    if (file && ld_scenario_read(file, NULL, 0, &model, &messages))
        ld_messages_free(&messages);
    return model;
}

static void offer_keys(size_t from)
{
    ld_model *model = read_model();
    ld_scenario_keys(take_key, &(key_search){from, model});
    ld_model_free(model);
}

// ---- names of figures and results

static void offer_columns(const ld_column *column, size_t count, size_t from)
{
    for (size_t i = 0; i < count; i++)
        offer_behind(from, column[i].name, strlen(column[i].name), "", column[i].description);
}

// Inputs or columns of a linear response.
static void offer_response(bool inputs, size_t from)
{
    ld_response *response = NULL;
    ld_model *model = read_model();
    const ld_column *column;
    if (model && !ld_response_create(model, NAN, NAN, &response, NULL)) {
        size_t count =
            inputs ? ld_response_inputs(response, &column) : ld_response_columns(response, &column);
        offer_columns(column, count, from);
        ld_response_free(response);
    }
    ld_model_free(model);
}

static void offer_results(const char *folder, size_t from)
{
    ld_study_data *data = NULL;
    const ld_study_column *column;
    if (ld_study_data_open(folder, &data, NULL))
        return;
    for (int i = 0; (column = ld_study_data_column(data, i)) && !column->factor; i++)
        offer_behind(from, column->name, strlen(column->name), "", column->unit);
    ld_study_data_close(data);
}

// Names for --what and --input, the last of several with commas between.
static void offer_names(const command *self, const command_option *option, size_t from)
{
    const char *comma = strrchr(line.last + from, ',');
    const ld_figure *figure;
    if (comma)
        from = (size_t)(comma + 1 - line.last);
    if (strcmp(self->name, "response") == 0)
        offer_response(strcmp(option->name, "input") == 0, from);
    else if (strcmp(self->name, "study") == 0 && line.given_count == 2)
        offer_results(line.given[1], from);
    for (size_t i = 0; strcmp(self->name, "plot") == 0 && (figure = ld_figure_at(i)); i++)
        offer_behind(from, figure->name, strlen(figure->name), "", figure->description);
    if (strcmp(option->name, "what") == 0)
        offer_behind(from, "all", 3, "", "all of them");
}

// ---- options and words

static const command_option *find_option(const command_option *options, const char *word)
{
    for (; options->name; options++) {
        size_t length = strlen(options->name);
        if (strncmp(word, "--", 2) == 0 && strncmp(word + 2, options->name, length) == 0 &&
            (!word[2 + length] || word[2 + length] == '='))
            return options;
        if (options->letter && word[0] == '-' && word[1] == options->letter && !word[2])
            return options;
    }
    return NULL;
}

// What stands before the last word: words, and the option that waits for its argument, or NULL.
static const command_option *previous_option(const command_option *options)
{
    const command_option *waits = NULL;
    for (int i = 1; i + 1 < line.count; i++) {
        const char *word = line.word[i];
        if (waits && waits->kind == OPTION_WORD && !option_has_word(waits, word))
            waits = NULL;
        const command_option *option = waits ? NULL : find_option(options, word);
        if (!waits && !option && line.given_count < MOST_WORDS)
            line.given[line.given_count++] = word;
        waits = option && option->argument && !strchr(word, '=') ? option : NULL;
    }
    return waits;
}

// What an option takes, behind the first `from` characters of the last word.
static void offer_argument(const command *self, const command_option *option, size_t from)
{
    const char *text = option->argument;
    if (strcmp(text, "PATH=VALUE") == 0)
        offer_keys(from);
    else if (strncmp(text, "NAME", 4) == 0)
        offer_names(self, option, from);
    else if (strcmp(text, "DIR") == 0 || strcmp(text, "FOLDER") == 0)
        offer_files(true);
    else if (strcmp(text, "FILE") == 0)
        offer_files(false);
    for (const char *end = strchr(text, '|'); end; text = end + (*end != '\0')) {
        end = text + strcspn(text, "|");
        offer_behind(from, text, (size_t)(end - text), "", option->help);
        if (!*end)
            return;
    }
}

// A word of the command: of each form of its arguments what stands there, where the words before
// are those of the form.
static void offer_word(const command *self)
{
    for (const char *form = self->arguments; form; form = strstr(form, " | ")) {
        form += *form == ' ' ? 3 : 0;
        const char *part = form;
        int at = 0;
        for (; at < line.given_count && *part; at++) {
            size_t length = strcspn(part, " ");
            bool name = islower((unsigned char)*part);
            if (name &&
                (strlen(line.given[at]) != length || strncmp(part, line.given[at], length) != 0))
                break;
            if (strncmp(part, "DIR...", 6) != 0)
                part += length + (part[length] == ' ');
        }
        if (at < line.given_count || !*part || *part == '|')
            continue;
        if (islower((unsigned char)*part))
            offer_behind(0, part, strcspn(part, " "), "", "");
        else
            offer_files(strncmp(part, "DIR", 3) == 0);
    }
}

void complete_print(const command *self, const command_option *options)
{
    const command_option *option = previous_option(options);
    const char *equals = strchr(line.last, '=');
    size_t from = equals ? (size_t)(equals + 1 - line.last) : 0;
    if (option)
        offer_argument(self, option, 0);
    if (option && option->kind != OPTION_WORD)
        return;
    if (strncmp(line.last, "--", 2) == 0 && equals) {
        option = find_option(options, line.last);
        if (option && option->argument)
            offer_argument(self, option, from);
    } else if (line.last[0] == '-') {
        for (; options->name; options++) {
            char name[64];
            snprintf(name, sizeof name, "--%s", options->name);
            complete_offer(name, options->help);
        }
    } else {
        offer_word(self);
    }
}
