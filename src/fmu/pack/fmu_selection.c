#include "fmu/pack/fmu_selection.h"

#include <stdlib.h>
#include <string.h>

#include "launchdyn/scenario.h"

enum { PATTERN_SIZE = 256 };

// Whether a name follows a pattern, in which '*' stands for any letters.
static bool follows(const char *name, const char *pattern)
{
    for (; *pattern && *pattern != '*'; name++, pattern++)
        if (*name != *pattern)
            return false;
    if (!*pattern)
        return !*name;
    for (; *name; name++)
        if (follows(name, pattern + 1))
            return true;
    return follows(name, pattern + 1);
}

// The next of "NAME,..."; false: there is none.
static bool next_pattern(const char **list, char pattern[PATTERN_SIZE])
{
    *list += strspn(*list, ", ");
    size_t length = strcspn(*list, ", ");
    snprintf(pattern, PATTERN_SIZE, "%.*s", (int)length, *list);
    *list += length;
    return length > 0;
}

static bool is_chosen_parameter(const fmu_variable *v)
{
    return v->group == FMU_NUMBER || v->group == FMU_TEXT;
}

// Parameters are named by the paths of their keys, too.
static bool applies(const char *pattern, const fmu_variable *v)
{
    return follows(v->name, pattern) || (is_chosen_parameter(v) && follows(fmu_key_of(v), pattern));
}

static bool is_listed(const fmu_variable *v, const char *patterns)
{
    char pattern[PATTERN_SIZE];
    while (next_pattern(&patterns, pattern))
        if (applies(pattern, v))
            return true;
    return false;
}

// ---- what is not there ----

typedef bool choice(const fmu_variable *variable);

// The name that a pattern without a star is nearest to; NULL: none.
static const char *nearest(const char *pattern, choice *of, const fmu_variables *list, int count)
{
    size_t names = 0, all = 0;
    for (int k = 0; k < count; k++)
        all += list[k].count;
    const char **name = malloc((1 + all) * sizeof *name), *found = NULL;
    for (int k = 0; k < count && name; k++)
        for (size_t i = 0; i < list[k].count; i++)
            if (of(&list[k].item[i]))
                name[names++] = is_chosen_parameter(&list[k].item[i]) ? fmu_key_of(&list[k].item[i])
                                                                      : list[k].item[i].name;
    if (name && !strchr(pattern, '*'))
        found = ld_nearest_name(pattern, name, names);
    free(name);
    return found;
}

static ld_status check(const char *patterns, choice *of, const fmu_variables *list, int count,
                       ld_error *error)
{
    char pattern[PATTERN_SIZE];
    while (patterns && next_pattern(&patterns, pattern)) {
        bool found = false;
        for (int k = 0; k < count; k++)
            for (size_t i = 0; i < list[k].count && !found; i++)
                found = of(&list[k].item[i]) && applies(pattern, &list[k].item[i]);
        if (found)
            continue;
        const char *meant = nearest(pattern, of, list, count);
        return ld_fail(error, LD_ERR_INPUT, "found no %s \"%s\"%s%s%s",
                       of == fmu_is_output ? "output" : "parameter", pattern,
                       meant ? "; did you mean \"" : "", meant ? meant : "", meant ? "\"?" : "");
    }
    return LD_OK;
}

ld_status fmu_selection_check(const ld_fmu_options *options, const fmu_variables *list, int count,
                              ld_error *error)
{
    ld_status status = check(options->outputs, fmu_is_output, list, count, error);
    return status ? status : check(options->parameters, is_chosen_parameter, list, count, error);
}

// ---- taking out ----

// In FMI 2.0 the independent variable may be left out: one named time stops OpenModelica's import.
static bool stays(const ld_fmu_options *options, const fmu_variables *list, const fmu_variable *v)
{
    if (v->group == FMU_TIME)
        return options->version > 2;
    if (is_chosen_parameter(v))
        return !options->parameters || is_listed(v, options->parameters);
    bool connects = v->group == FMU_PART_OUTPUT && list->runner->input_count > 0;
    return !fmu_is_output(v) || connects || !options->outputs || is_listed(v, options->outputs);
}

void fmu_selection_take(const ld_fmu_options *options, fmu_variables *list)
{
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++) {
        fmu_variable v = list->item[i];
        if (stays(options, list, &v))
            list->item[kept++] = v;
        else
            fmu_variable_free(&v);
    }
    list->count = kept;
    free(list->order);
    free(list->array_order);
    list->order = list->array_order = NULL;
    list->array_count = 0;
}
