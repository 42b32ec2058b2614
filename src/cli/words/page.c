#include "cli/words/page.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "launchdyn/version.h"

// What stands for a character in roff; NULL: itself.
static const char *escape_of(char c)
{
    switch (c) {
    case '\\':
        return "\\e";
    case '-':
        return "\\-";
    case '\'':
        return "\\(aq";
    case '~':
        return "\\(ti";
    case '^':
        return "\\(ha";
    default:
        return NULL;
    }
}

// Text on one line, with nothing in it that is a request or an escape.
static void print_roff(const char *text, size_t length)
{
    if (*text == '.')
        fputs("\\&", stdout);
    for (size_t i = 0; i < length && text[i]; i++)
        if (escape_of(text[i]))
            fputs(escape_of(text[i]), stdout);
        else
            putchar(text[i]);
}

// Sentences, a line or more for each, and the end of the line; an empty line parts paragraphs.
static void print_prose(const char *text)
{
    enum { LONG = 60 };
    size_t column = 0;
    for (const char *end; *text; text = end) {
        end = text + strcspn(text, " \n");
        print_roff(text, (size_t)(end - text));
        column += (size_t)(end - text) + 1;
        bool stop = end > text && end[-1] == '.';
        if (strncmp(end, "\n\n", 2) == 0)
            fputs("\n.PP", stdout);
        if (*end)
            putchar(*end == '\n' || stop || column > LONG ? '\n' : ' ');
        if (*end == '\n' || stop || column > LONG)
            column = 0;
        end += strspn(end, " \n");
    }
}

static void print_section(const char *title)
{
    printf(".SH %s\n", title);
}

// A tagged paragraph.
static void print_item(const char *tag, const char *text)
{
    fputs(".TP\n.B ", stdout);
    print_roff(tag, strlen(tag));
    putchar('\n');
    print_prose(text);
    putchar('\n');
}

// What a page is called: "launchdyn-run", or the program whose only command it is.
static const char *page_name(const command *self, char name[HELP_CALL])
{
    snprintf(name, HELP_CALL, self->program ? "%s" : "launchdyn-%s",
             self->program ? self->program : self->name);
    return name;
}

// The day of the sources where a packager reports it, else today.
static void print_title(const char *name)
{
    const char *told = getenv("SOURCE_DATE_EPOCH");
    time_t when = told ? (time_t)strtoll(told, NULL, 10) : time(NULL);
    struct tm day;
    char date[32];
    gmtime_r(&when, &day);
    strftime(date, sizeof date, "%Y-%m-%d", &day);
    fputs(".TH ", stdout);
    for (const char *c = name; *c; c++)
        printf(*c == '-' ? "\\-" : "%c", *c - 'a' + 'A');
    printf(" 1 %s \"launchdyn %s\" \"User Commands\"\n", date, ld_version());
}

static void print_option(const command_option *option)
{
    fputs(".TP\n", stdout);
    if (option->letter)
        printf("\\fB\\-%c\\fR, ", option->letter);
    printf("\\fB\\-\\-");
    print_roff(option->name, strlen(option->name));
    fputs("\\fR", stdout);
    if (option->argument) {
        const bool word = option->kind == OPTION_WORD;
        fputs(option->kind == OPTION_TEXTS ? " \\fI" : word ? "[=\\fI" : "=\\fI", stdout);
        print_roff(option->argument, strlen(option->argument));
        fputs(word ? "\\fR]" : "\\fR", stdout);
    }
    putchar('\n');
    print_prose(option->help);
    puts(option->help[strlen(option->help) - 1] == '.' ? "" : ".");
}

// A line for each form of the words: "FILE | show DIR" are two.
static void print_synopsis(const command *self)
{
    print_section("SYNOPSIS");
    const char *form = self->arguments;
    char call[HELP_CALL];
    help_call(self, call);
    for (bool first = true; *form || first; first = false) {
        const char *next = strstr(form, " | ");
        size_t length = next ? (size_t)(next - form) : strlen(form);
        printf("%s.B ", first ? "" : ".br\n");
        print_roff(call, strlen(call));
        fputs("\n.RI [ OPTION ...]\\&\n", stdout);
        print_roff(form, length);
        fputs("\n", stdout);
        form += next ? length + 3 : length;
    }
}

static void print_page_examples(const command *self)
{
    if (!self->examples)
        return;
    print_section("EXAMPLES");
    for (const char *line = self->examples;; line++) {
        size_t bar = strcspn(line, "|"), end = strcspn(line, "\n");
        fputs(".TP\n.B ", stdout);
        print_roff(line, bar);
        putchar('\n');
        print_roff(line + bar + 1, end - bar - 1);
        fputs(".\n", stdout);
        line += end;
        if (!*line)
            return;
    }
}

static void print_exit_codes(void)
{
    print_section("EXIT STATUS");
    print_item("0", "Success; also of a study with failed samples, which it counts and lists.");
    print_item(
        "1",
        "The launch or a flight could not be computed to its end; the results so far are written.");
    print_item(
        "2",
        "Wrong, missing or damaged input: command line, scenario, tables, folders of results.");
    print_item("3", "The system failed: a file could not be written, or memory, a thread or "
                    "gnuplot was unavailable.");
    print_item("129, 130, 143",
               "Stopped by SIGHUP, SIGINT or SIGTERM; the results so far are written.");
}

// The text that a command prints besides, as it is.
static void print_more(const command *self)
{
    if (!self->more)
        return;
    fputs(".PP\n.nf\n", stdout);
    self->more();
    fputs(".fi\n", stdout);
}

void page_print(const command *self, const command_option *options)
{
    char name[HELP_CALL];
    print_title(page_name(self, name));
    print_section("NAME");
    print_roff(name, strlen(name));
    fputs(" \\- ", stdout);
    print_roff(self->summary, strlen(self->summary));
    putchar('\n');
    print_synopsis(self);
    print_section("DESCRIPTION");
    print_prose(self->about ? self->about : self->summary);
    fputs(self->about ? "\n" : ".\n", stdout);
    print_more(self);
    print_section("OPTIONS");
    for (; options->name; options++)
        print_option(options);
    print_page_examples(self);
    print_exit_codes();
    print_section("SEE ALSO");
    fputs(".BR launchdyn (1)\n", stdout);
}

void page_print_all(const command *commands)
{
    print_title("launchdyn");
    print_section("NAME");
    fputs("launchdyn \\- simulate how a rocket leaves its launcher\n", stdout);
    print_section("SYNOPSIS");
    fputs(".B launchdyn\n.I COMMAND\n.RI [ OPTION ...]\\&\n", stdout);
    print_section("DESCRIPTION");
    fputs(
        "Simulates how a rocket leaves a flexible tube, or a rail,\non a fixed or moving base:\n"
        "tube, supports, rocket, contacts, vehicle and road, then free flight.\n"
        "A scenario is a YAML file;\nresults are HDF5, JSON and CSV files, figures and a report.\n",
        stdout);
    print_section("COMMANDS");
    for (; commands->name; commands++) {
        printf(commands->in_child ? ".TP\n.BR launchdyn\\-%s (1)\n" : ".TP\n.B launchdyn %s\n",
               commands->name);
        print_prose(commands->summary);
        fputs(".\n", stdout);
    }
    print_exit_codes();
    print_section("ENVIRONMENT");
    print_item("LAUNCHDYN_PLAIN",
               "If set, no AVX2 or AVX-512 instructions are used; the results are the same.");
    print_item("TMPDIR", "Folder in which FMUs are unpacked.");
    print_section("SEE ALSO");
    fputs(".BR gnuplot (1)\n", stdout);
}
