// launchdyn new: a scenario to begin with, by options or by questions on a terminal.
#include "cli/new.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"

enum { ANSWER = 1024 };

static const char guides[] = "tube|rail", bases[] = "fixed|vehicle|ship|trailer|suspended";

typedef struct new_wishes {
    char *guide, *base, *out; // NULL: not given
    char answer[3][ANSWER];
} new_wishes;

// Whether `word` is one of "a|b|c"; else complains.
static bool is_one_of(const char *what, const char *word, const char *words)
{
    enum { MOST = 5 };
    char list[64], *rest = NULL;
    const char *names[MOST];
    size_t count = 0;
    snprintf(list, sizeof list, "%s", words);
    for (char *name = strtok_r(list, "|", &rest); name; name = strtok_r(NULL, "|", &rest)) {
        if (strcmp(name, word) == 0)
            return true;
        names[count++] = name;
    }
    const char *nearest = ld_nearest_name(word, names, count);
    command_complain("--%s: expected one of %s, found \"%s\"%s%s%s", what, words, word,
                     nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                     nearest ? "\"?" : "");
    return false;
}

// Asks on the terminal for what was not given; an empty line takes `usual`. NULL where the input
// ends.
static char *ask(char *given, const char *question, const char *usual, char answer[ANSWER])
{
    if (given)
        return given;
    snprintf(answer, ANSWER, "%s", usual);
    if (!isatty(STDIN_FILENO) || command_is_quiet())
        return answer;
    char line[ANSWER] = "";
    fprintf(stderr, "%s [%s] ", question, usual);
    if (!fgets(line, sizeof line, stdin)) {
        fputc('\n', stderr);
        command_complain("the input ended before an answer; no file is written");
        return NULL;
    }
    line[strcspn(line, "\r\n")] = '\0';
    if (*line)
        strcpy(answer, line);
    return answer;
}

static const char *text_of(const char *name, const char *which)
{
    size_t length = strlen(name);
    const scenario_part *part = scenario_parts;
    while (strncmp(part->name, name, length) != 0 || strcmp(part->name + length, which) != 0)
        part++;
    return part->text;
}

static void write_part(FILE *file, const char *name, const char *which)
{
    fputs(text_of(name, which), file);
}

// The guide; on a base of bodies with the name of the one that carries it.
static void write_guide(FILE *file, const char *guide, bool on_body)
{
    const char *text = text_of("guide-", guide), *layout = strstr(text, "  layout:");
    fprintf(file, "%.*s", (int)(layout - text), text);
    if (on_body)
        fputs("  on: cradle                             # the body that carries it\n", file);
    fputs(layout, file);
}

static void write_scenario(FILE *file, const new_wishes *self)
{
    static const char *const places[][2] = {{"fixed", "on the ground"},
                                            {"vehicle", "on a moving vehicle"},
                                            {"ship", "on a ship in a seaway"},
                                            {"trailer", "on a trailer on jacks"},
                                            {"suspended", "on a frame on a swinging link"}};
    const char *place = "";
    bool moves = strcmp(self->base, "vehicle") == 0 || strcmp(self->base, "ship") == 0;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        if (strcmp(places[i][0], self->base) == 0)
            place = places[i][1];
    write_part(file, "head", "");
    fprintf(file, "title: A rocket %s, %s\n",
            strcmp(self->guide, "tube") == 0 ? "in a tube" : "on a rail", place);
    write_part(file, "air", "");
    write_part(file, "base-", self->base);
    write_guide(file, self->guide, !moves && strcmp(self->base, "fixed") != 0);
    write_part(file, "rocket", "");
    write_part(file, "run-", moves ? "moving" : "fixed");
    write_part(file, "study", "");
}

// Writes a file that is not there yet; one that cannot be written whole is removed.
static int write_file(const new_wishes *self)
{
    int number = open(self->out, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (number < 0 && errno == EEXIST) {
        command_complain("%s exists already; choose another name, new never overwrites a file",
                         self->out);
        return EXIT_INPUT;
    }
    FILE *file = number < 0 ? NULL : fdopen(number, "w");
    bool good = file != NULL;
    if (good) {
        write_scenario(file, self);
        good = fflush(file) == 0 && !ferror(file);
        good = fclose(file) == 0 && good;
    }
    if (good)
        return 0;
    command_complain("cannot write %s: %s", self->out, strerror(errno));
    if (number >= 0)
        unlink(self->out);
    return EXIT_SYSTEM;
}

// "launchdyn check FILE" and what else may follow, as a shell takes it.
static void print_next_commands(const char *file)
{
    char visible[ANSWER];
    ld_visible_text(file, visible, sizeof visible);
    printf("Wrote %s. Check it, run it, then open the report in a browser:\n"
           "  launchdyn check %s\n  launchdyn run %s --out out --report\n"
           "  out/report.html\n",
           visible, visible, visible);
}

static int make(new_wishes *self)
{
    bool asks = isatty(STDIN_FILENO) && !(self->guide && self->base);
    self->guide =
        ask(self->guide, "What guides the rocket: tube or rail?", "tube", self->answer[0]);
    if (!self->guide || !is_one_of("guide", self->guide, guides))
        return EXIT_INPUT;
    self->base =
        ask(self->base, "What carries the guide: fixed, vehicle, ship, trailer or suspended?",
            "fixed", self->answer[1]);
    if (!self->base || !is_one_of("base", self->base, bases))
        return EXIT_INPUT;
    if (asks &&
        !(self->out = ask(self->out, "Name of the file?", "scenario.yaml", self->answer[2])))
        return EXIT_INPUT;
    if (!self->out) {
        write_scenario(stdout, self);
        return 0;
    }
    int code = write_file(self);
    if (!code)
        command_step("wrote %s", self->out);
    if (!code && !command_is_quiet())
        print_next_commands(self->out);
    return code;
}

int command_new(const command *self, int argc, char **argv)
{
    static new_wishes wishes;
    const command_option options[] = {
        {"guide", 'g', OPTION_TEXT, &wishes.guide, "What guides the rocket (tube)", guides},
        {"base", 'b', OPTION_TEXT, &wishes.base, "What carries the guide (fixed)", bases},
        {"out", 'o', OPTION_TEXT, &wishes.out,
         "New file (asked for on a terminal; otherwise the scenario is printed)", "FILE"},
        COMMAND_USUAL};
    command_line line;
    int code = 0;
    if (command_line_read(&line, self, argc, argv, options, &code)) {
        code = make(&wishes);
        options_end(&line);
    }
    return code;
}
