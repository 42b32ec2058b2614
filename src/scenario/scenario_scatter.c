// Scatter: distributions of numbers of the scenario, by their paths.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/fields/factor.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "scenario/scenario_reader.h"

// One factor while it is read.
typedef struct factor_reader {
    scenario_reader *reader;
    const tree_node *map; // its block
    char path[LD_MAX_PATH + 64];
    field_row number; // a number with the key's unit and range
    ld_factor *factor;
} factor_reader;

// What numbers are: their unit and range.
typedef struct number_kind {
    const char *unit;
    field_range range;
} number_kind;

// Keys of a factor: its distribution, and what goes with it.
#define WORD(name, word, given, traits) word,
static const char *const key_names[] = {LD_DISTRIBUTIONS(WORD) "within", "between", "weights",
                                        "per", "paths"};
enum { KEYS = sizeof key_names / sizeof *key_names };

static const field_range any = {-INFINITY, INFINITY, 1, 1}, positive = {0, INFINITY, 1, 1},
                         not_negative = {0, INFINITY, 0, 1};

static const char *path_of(const factor_reader *self, const char *key, char *path, size_t size)
{
    snprintf(path, size, "%s.%s", self->path, key);
    return path;
}

// Reads `count` numbers of the key `node` from `text`.
static bool read_numbers(const factor_reader *self, const tree_node *node, const char *text,
                         number_kind kind, double *values, int count)
{
    char path[256], expected[192];
    field_row row = {.name = node->key,
                     .kind = FIELD_NUMBER,
                     .unit = kind.unit,
                     .range = kind.range,
                     .count = count};
    path_of(self, node->key ? node->key : "discrete", path, sizeof path);
    if (node->kind != NODE_SCALAR || tree_is_empty(node)) {
        field_expectation(&row, expected, sizeof expected);
        reader_refuse(self->reader, node->at, path, "expected %s", expected);
        return false;
    }
    const written_value given = {&row, node->at, path, text};
    return quantity_read(self->reader, &given, values, count);
}

// Two values, the first the smaller.
static bool read_ends(const factor_reader *self, const tree_node *node, field_range range,
                      double ends[2])
{
    char path[256];
    if (!read_numbers(self, node, node->text, (number_kind){self->number.unit, range}, ends, 2))
        return false;
    if (ends[0] < ends[1])
        return true;
    reader_refuse(self->reader, node->at, path_of(self, node->key, path, sizeof path),
                  "the first value must be less than the second");
    return false;
}

static bool read_uniform(const factor_reader *self, const tree_node *node)
{
    ld_factor *factor = self->factor;
    if (node->kind == NODE_SCALAR && strncmp(node->text, "+-", 2) == 0)
        return read_numbers(self, node, node->text + 2, (number_kind){self->number.unit, positive},
                            &factor->spread, 1);
    return read_ends(self, node, self->number.range, factor->between);
}

// A list of values with the key's unit, or of weights.
static bool read_values(const factor_reader *self, const tree_node *list, number_kind kind,
                        double *values, int *count)
{
    char path[256];
    int number = 0;
    path_of(self, list->key, path, sizeof path);
    if (list->kind != NODE_LIST || list->count < 1 || list->count > LD_MAX_CHOICES) {
        reader_refuse(self->reader, list->at, path, "expected a list of 1 to %d values",
                      LD_MAX_CHOICES);
        return false;
    }
    for (const tree_node *entry = list->first; entry; entry = entry->next)
        if (!read_numbers(self, entry, entry->text, kind, &values[number++], 1))
            return false;
    *count = number;
    return true;
}

static bool read_discrete(const factor_reader *self, const tree_node *node, bool whole)
{
    ld_factor *factor = self->factor;
    char path[256];
    const number_kind own = {self->number.unit, self->number.range};
    path_of(self, "discrete", path, sizeof path);
    if (!read_values(self, node, own, factor->value, &factor->value_count))
        return false;
    for (int i = 0; i < factor->value_count; i++) {
        factor->weight[i] = 1;
        if (whole && factor->value[i] != floor(factor->value[i])) {
            reader_refuse(self->reader, node->at, path, "expected whole numbers");
            return false;
        }
    }
    const tree_node *weights = tree_member(self->map, "weights");
    if (!weights)
        return true;
    int count;
    double sum = 0;
    if (!read_values(self, weights, (number_kind){"", not_negative}, factor->weight, &count))
        return false;
    for (int i = 0; i < count; i++)
        sum += factor->weight[i];
    if (count == factor->value_count && sum > 0)
        return true;
    reader_refuse(self->reader, weights->at, path_of(self, "weights", path, sizeof path),
                  "expected %d weights, not all of them 0", factor->value_count);
    return false;
}

static bool read_word(const factor_reader *self, const tree_node *node, const char *first,
                      const char *second)
{
    char path[256], expected[64];
    const char *const words[] = {first, second};
    bool scalar = node->kind == NODE_SCALAR && !tree_is_empty(node);
    if (scalar && (strcmp(node->text, first) == 0 || (second && strcmp(node->text, second) == 0)))
        return true;
    path_of(self, node->key, path, sizeof path);
    snprintf(expected, sizeof expected, "%s%s%s", first, second ? " or " : "",
             second ? second : "");
    if (scalar)
        reader_refuse_word(self->reader, node->at, path, node->text,
                           ld_nearest_name(node->text, words, second ? 2 : 1), expected);
    else
        reader_refuse(self->reader, node->at, path, "found a list or a block; expected %s",
                      expected);
    return false;
}

// Reads the numbers of the distribution `node`.
static bool read_distribution(const factor_reader *self, const tree_node *node, bool whole)
{
    const number_kind own = {self->number.unit, positive}, ratio = {"", positive};
    switch (distribution_of(self->factor->distribution)->given) {
    case LD_GIVEN_DEVIATION:
        return read_numbers(self, node, node->text, own, &self->factor->deviation, 1);
    case LD_GIVEN_RATIO:
        return read_numbers(self, node, node->text, ratio, &self->factor->deviation, 1);
    case LD_GIVEN_SPAN:
        return read_uniform(self, node);
    case LD_GIVEN_VALUES:
        return read_discrete(self, node, whole);
    case LD_GIVEN_SAMPLE:
        return read_word(self, node, "sample", NULL);
    }
    return false;
}

// What a normal distribution is kept within.
static bool read_bounds(const factor_reader *self)
{
    const tree_node *within = tree_member(self->map, "within");
    const tree_node *between = tree_member(self->map, "between");
    const number_kind deviations = {"", positive};
    char path[256];
    if (within && between) {
        reader_refuse(self->reader, between->key_at, path_of(self, "between", path, sizeof path),
                      "is not allowed together with within; give one of them");
        return false;
    }
    return (!within ||
            read_numbers(self, within, within->text, deviations, &self->factor->within, 1)) &&
           (!between || read_ends(self, between, any, self->factor->between));
}

static void refuse_without(const factor_reader *self)
{
    char words[128] = "";
    for (int i = 0; i < LD_DISTRIBUTION_COUNT; i++) {
        size_t length = strlen(words);
        const char *before = i == 0 ? "" : i + 1 < LD_DISTRIBUTION_COUNT ? ", " : " or ";
        snprintf(words + length, sizeof words - length, "%s%s", before, key_names[i]);
    }
    reader_refuse(self->reader, self->map->key_at, self->path, "has no distribution; expected %s",
                  words);
}

// The one distribution that the block gives, or NULL after a message.
static const tree_node *find_distribution(factor_reader *self)
{
    const tree_node *found = NULL;
    char path[256];
    for (int i = 0; i < LD_DISTRIBUTION_COUNT; i++) {
        const tree_node *node = tree_member(self->map, key_names[i]);
        if (node && found) {
            reader_refuse(self->reader, node->key_at, path_of(self, node->key, path, sizeof path),
                          "is given together with %s; a factor has one distribution", found->key);
            return NULL;
        }
        if (node) {
            found = node;
            self->factor->distribution = (ld_distribution)i;
        }
    }
    if (!found)
        refuse_without(self);
    return found;
}

// Whether each key of the block goes with its distribution.
static bool keys_go_together(const factor_reader *self)
{
    const distribution_row *row = distribution_of(self->factor->distribution);
    bool good = true;
    for (const tree_node *member = self->map->first; member; member = member->next) {
        char path[256];
        const char *key = member->key, *other = NULL;
        bool bounds = strcmp(key, "within") == 0 || strcmp(key, "between") == 0;
        if (bounds && !(row->traits & LD_BOUNDED))
            other = "normal";
        if (strcmp(key, "weights") == 0 && row->given != LD_GIVEN_VALUES)
            other = "discrete";
        path_of(self, key, path, sizeof path);
        if (other)
            reader_refuse(self->reader, member->key_at, path, "is allowed with %s only", other);
        good = good && !other;
    }
    return good;
}

// Finds what the factor scatters: the key with its path, or those of `paths` under its name; false
// after a message.
static bool find_numbers(factor_reader *self, const ld_model *model, field_place *first)
{
    ld_factor *factor = self->factor;
    const tree_node *node = self->map;
    char why[384], path[256];
    bool several = node->kind == NODE_MAP && tree_member(node, "paths");
    const tree_node *paths = several ? together_paths(self->reader, node, self->path) : NULL;
    if (!several && !field_locate(model, node->key, first, why, sizeof why))
        reader_refuse(self->reader, node->key_at, self->path, "%s", why);
    else if (!several)
        memcpy(factor->path, first->path, sizeof factor->path);
    if (!several || !paths)
        return factor->path[0] != '\0';
    for (const tree_node *entry = paths->first; entry; entry = entry->next) {
        field_place place;
        int count = factor->together.count;
        if (!field_locate(model, entry->text, &place, why, sizeof why)) {
            snprintf(path, sizeof path, "%s.paths.%d", self->path, count + 1);
            reader_refuse(self->reader, entry->at, path, "%s", why);
            return false;
        }
        if (count == 0)
            *first = place;
        memcpy(factor->together.path[count], place.path, sizeof place.path);
        factor->together.count++;
    }
    snprintf(factor->path, sizeof factor->path, "%s", node->key);
    return true;
}

// Whether the value in the scenario of one of the factor's numbers was refused already.
static bool has_refused_numbers(const factor_reader *self)
{
    scenario_reader *reader = self->reader;
    bool refused = false;
    for (int i = 0; i < factor_numbers(self->factor); i++)
        refused |=
            reader_has_refused(reader, reader->messages->count, factor_path(self->factor, i));
    return refused;
}

static void read_factor(scenario_reader *reader, const tree_node *node, const ld_model *model,
                        ld_factor *factor)
{
    factor_reader self = {.reader = reader, .map = node, .factor = factor};
    field_place place;
    char why[384];
    snprintf(self.path, sizeof self.path, "scatter.factors.%.*s", LD_MAX_PATH, node->key);
    memset(factor, 0, sizeof *factor);
    factor->within = factor->between[0] = factor->between[1] = factor->spread = NAN;
    factor->deviation = NAN;
    bool known =
        node->kind != NODE_MAP || reader_check_keys(reader, node, self.path, key_names, KEYS);
    if (!known || !find_numbers(&self, model, &place))
        return;
    if (node->kind != NODE_MAP) {
        reader_refuse(reader, node->at, self.path,
                      "expected a distribution, such as {normal: 1 %s}",
                      place.row->unit && place.row->unit[0] ? place.row->unit : "%");
        return;
    }
    self.number =
        (field_row){.unit = place.row->unit ? place.row->unit : "", .range = place.row->range};
    const tree_node *given = find_distribution(&self), *per = tree_member(node, "per");
    factor->per_rocket = factor_may_be_per_rocket(factor);
    if (!given || !keys_go_together(&self) || !read_distribution(&self, given, place.whole) ||
        !read_bounds(&self) || (per && !read_word(&self, per, "sample", "rocket")))
        return;
    if (per)
        factor->per_rocket = strcmp(per->text, "rocket") == 0;
    if (!has_refused_numbers(&self) && !factor_is_possible(model, factor, why, sizeof why))
        reader_refuse(reader, node->key_at, self.path, "%s", why);
}

// Refuses a number of a factor that is one of those before it.
static void refuse_same(scenario_reader *reader, const tree_node *node, const ld_factor *factor,
                        const char *number)
{
    char path[LD_MAX_PATH + 64];
    snprintf(path, sizeof path, "scatter.factors.%.*s", LD_MAX_PATH, node->key);
    if (factor->together.count)
        reader_refuse(reader, node->key_at, path, "%s is given above already", number);
    else
        reader_refuse(reader, node->key_at, path, "is the same key as %s above", number);
}

// Refuses a number that is scattered twice, by the last factor or by one before it.
static void refuse_double(scenario_reader *reader, const tree_node *node, const ld_scatter *scatter,
                          int last)
{
    const ld_factor *factor = &scatter->factor[last];
    for (int number = 0; factor->path[0] && number < factor_numbers(factor); number++) {
        const char *own = factor_path(factor, number);
        for (int i = 0; i <= last; i++) {
            const ld_factor *other = &scatter->factor[i];
            int end = i < last ? factor_numbers(other) : number;
            for (int k = 0; k < end; k++)
                if (strcmp(factor_path(other, k), own) == 0)
                    refuse_same(reader, node, factor, own);
        }
    }
}

static void fill_factors(scenario_reader *reader, const tree_node *factors, ld_model *model)
{
    ld_scatter *scatter = &model->scatter;
    if (factors->kind != NODE_MAP || factors->count == 0) {
        reader_refuse(reader, factors->key_at, "scatter.factors",
                      "expected paths with their distributions, such as "
                      "rocket.mass: {normal: 0.2 kg}");
        return;
    }
    scatter->factor = calloc((size_t)factors->count, sizeof *scatter->factor);
    if (!scatter->factor) {
        reader->no_memory = true;
        return;
    }
    for (const tree_node *node = factors->first; node; node = node->next) {
        read_factor(reader, node, model, &scatter->factor[scatter->factor_count]);
        refuse_double(reader, node, scatter, scatter->factor_count);
        scatter->factor_count++;
    }
}

void scenario_fill_scatter(scenario_reader *reader, const tree_node *root, ld_model *model)
{
    const tree_node *block = tree_member(root, "scatter");
    if (!block || block->kind != NODE_MAP)
        return;
    const tree_node *factors = tree_member(block, "factors");
    const tree_node *correlated = tree_member(block, "correlated");
    const tree_node *until = tree_member(block, "until");
    if (factors)
        fill_factors(reader, factors, model);
    if (correlated && factors)
        fill_correlated(reader, correlated, model);
    if (until)
        fill_until(reader, until, model);
}
