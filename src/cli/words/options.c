#include "cli/words/options.h"

#include <assert.h>
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/scenario.h"

// ---- reading

// "unknown option --cvs (did you mean --csv?)"
static ld_status refuse_unknown(const char *word, const command_option *options, ld_error *error)
{
    const char *names[MOST_OPTIONS], *name = word + strspn(word, "-");
    size_t count = 0;
    for (; options[count].name; count++)
        names[count] = options[count].name;
    const char *nearest = ld_nearest_name(name, names, count);
    if (nearest)
        return ld_fail(error, LD_ERR_INPUT, "unknown option %s (did you mean --%s?)", word,
                       nearest);
    return ld_fail(error, LD_ERR_INPUT, "unknown option %s", word);
}

static ld_status take_number(const command_option *option, ld_error *error)
{
    static const char *const units[] = {[OPTION_METRES] = "m",
                                        [OPTION_MILLIMETRES] = "mm",
                                        [OPTION_MILLISECONDS] = "ms",
                                        [OPTION_HERTZ] = "Hz",
                                        [OPTION_NUMBER] = "1"};
    ld_error why;
    if (ld_read_quantity(optarg, units[option->kind], option->value, &why))
        return ld_fail(error, LD_ERR_INPUT, "--%s: %s", option->name, why.text);
    return LD_OK;
}

static bool read_integer(const char *text, int *value)
{
    char *end;
    errno = 0;
    long number = strtol(text, &end, 10);
    *value = (int)number;
    return errno == 0 && end != text && !*end && number >= INT_MIN && number <= INT_MAX;
}

// One more of the texts, which there are not more of than words.
static ld_status add_text(command_line *line, int argc, char ***texts, ld_error *error)
{
    size_t count = 0;
    int list = 0;
    if (!*texts) {
        while (list < MOST_TEXTS && line->texts[list])
            list++;
        assert(list < MOST_TEXTS);
        *texts = line->texts[list] = calloc((size_t)argc, sizeof **texts);
    }
    if (!*texts)
        return ld_fail(error, LD_ERR_MEMORY, "no memory");
    while ((*texts)[count])
        count++;
    (*texts)[count] = optarg;
    return LD_OK;
}

bool option_has_word(const command_option *option, const char *text)
{
    const size_t length = strlen(text);
    for (const char *word = option->argument; word; word = strchr(word, '|')) {
        word += *word == '|';
        if (strcspn(word, "|") == length && strncmp(word, text, length) == 0)
            return true;
    }
    return false;
}

// "--name=word", "--name word", or without the word.
static ld_status take_word(const command_option *option, int argc, char **argv, ld_error *error)
{
    static char none[] = "";
    char **value = option->value;
    if (optarg && !option_has_word(option, optarg))
        return ld_fail(error, LD_ERR_INPUT, "--%s: found %s, expected %s", option->name, optarg,
                       option->argument);
    if (!optarg && optind < argc && option_has_word(option, argv[optind]))
        optarg = argv[optind++];
    *value = optarg ? optarg : none;
    return LD_OK;
}

// Takes what stands after an option.
static ld_status read_value(command_line *line, int argc, char **argv, const command_option *option,
                            ld_error *error)
{
    switch (option->kind) {
    case OPTION_FLAG:
        *(int *)option->value = 1;
        break;
    case OPTION_TEXT:
        *(char **)option->value = optarg;
        break;
    case OPTION_TEXTS:
        return add_text(line, argc, option->value, error);
    case OPTION_INTEGER:
        if (!read_integer(optarg, option->value))
            return ld_fail(error, LD_ERR_INPUT, "--%s: found %s, expected a whole number",
                           option->name, optarg);
        break;
    case OPTION_HELP:
        line->help = true;
        break;
    case OPTION_METRES:
    case OPTION_MILLIMETRES:
    case OPTION_MILLISECONDS:
    case OPTION_HERTZ:
    case OPTION_NUMBER:
        return take_number(option, error);
    case OPTION_WORD:
        return take_word(option, argc, argv, error);
    }
    return LD_OK;
}

enum { LONG = 256 }; // what getopt returns for the first option by its name

// The tables of getopt: words in their order, and no messages of its own.
static void make_tables(const command_option *options, struct option *by_name, char *letters)
{
    int count = 0;
    letters += sprintf(letters, "-:");
    for (; options[count].name; count++) {
        const command_option *o = &options[count];
        assert(count < MOST_OPTIONS);
        int takes = o->kind == OPTION_WORD ? optional_argument
                    : o->argument          ? required_argument
                                           : no_argument;
        by_name[count] = (struct option){o->name, takes, NULL, LONG + count};
        if (o->letter)
            letters += sprintf(letters, o->argument ? "%c:" : "%c", o->letter);
    }
    by_name[count] = (struct option){0};
}

static const command_option *find(const command_option *options, int found)
{
    if (found >= LONG)
        return &options[found - LONG];
    while (options->name && (!options->letter || options->letter != found))
        options++;
    return options->name ? options : NULL;
}

// What is wrong with the word that getopt stopped at.
static ld_status refuse_word(const command_option *options, int found, const char *word,
                             ld_error *error)
{
    const command_option *option = optopt ? find(options, optopt) : NULL;
    if (found == ':')
        return ld_fail(error, LD_ERR_INPUT, "%s: missing argument", word);
    if (option)
        return ld_fail(error, LD_ERR_INPUT, "--%s takes no value", option->name);
    if (optopt)
        return ld_fail(error, LD_ERR_INPUT, "-%c: unknown option", optopt);
    return refuse_unknown(word, options, error);
}

ld_status options_read(command_line *line, int argc, char **argv, const command_option *options,
                       ld_error *error)
{
    struct option by_name[MOST_OPTIONS + 1];
    char letters[2 * MOST_OPTIONS + 3];
    ld_status status = LD_OK;
    int found;
    *line = (command_line){.word = (const char *const *)argv + 1};
    make_tables(options, by_name, letters);
    opterr = 0;
    while (!status && !line->help &&
           (found = getopt_long(argc, argv, letters, by_name, NULL)) != -1)
        if (found == 1) // a word, kept among those that have been read
            argv[++line->count] = optarg;
        else if (found == '?' || found == ':')
            status = refuse_word(options, found, argv[optind - 1], error);
        else
            status = read_value(line, argc, argv, find(options, found), error);
    for (; !status && !line->help && optind < argc; optind++) // after "--"
        argv[++line->count] = argv[optind];
    return status;
}

void options_end(command_line *line)
{
    for (int i = 0; i < MOST_TEXTS; i++) {
        free(line->texts[i]);
        line->texts[i] = NULL;
    }
}

// ---- help

// "  -o, --out=DIR"; returns its length.
static int option_text(const command_option *o, char *text, size_t size)
{
    char letter[4] = "   ";
    if (o->letter)
        snprintf(letter, sizeof letter, "-%c,", o->letter);
    const bool word = o->kind == OPTION_WORD;
    return snprintf(text, size, "  %s --%s%s%s%s", letter, o->name,
                    !o->argument              ? ""
                    : word                    ? "[="
                    : o->kind == OPTION_TEXTS ? " "
                                              : "=",
                    o->argument ? o->argument : "", word ? "]" : "");
}

void print_wrapped(const char *text, int column)
{
    enum { WIDTH = 79 };
    size_t room = (size_t)(WIDTH - column);
    while (strlen(text) > room || strchr(text, '\n')) {
        size_t end = strcspn(text, "\n");
        if (end > room)
            for (end = room - 1; end > 0 && text[end] != ' '; end--)
                ;
        printf("%.*s\n%*s", (int)end, text, text[end + 1] == '\n' ? 0 : column, "");
        text += end + 1;
    }
    puts(text);
}

void options_print(const command_option *options)
{
    enum { BETWEEN = 5 };
    char text[64];
    int column = 0;
    for (const command_option *o = options; o->name; o++) {
        int length = option_text(o, text, sizeof text) + BETWEEN;
        column = length > column ? length : column;
    }
    for (const command_option *o = options; o->name; o++) {
        option_text(o, text, sizeof text);
        printf("%-*s", column, text);
        print_wrapped(o->help, column);
    }
}
