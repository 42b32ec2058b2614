// Every one-letter change of the keys and words of the scenario language, and what is suggested.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include <unistd.h>

#include "base/text_file.h"
#include "model/fields/field.h"
#include "scenario/scenario.h"
#include "scenario/scenario_reader.h"

enum { LONGEST = 64, BLOCKS = 128, TEXT = 8192 };

// What is done with a typo of a word.
typedef void typo_use(void *self, const char *word, const char *typo);

// Hands every one-letter change of the word to `use`: a letter put in, replaced, taken out,
// exchanged with the next.
static void each_typo(const char *word, typo_use *use, void *self)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789_";
    int n = (int)strlen(word);
    char typo[LONGEST];
    for (int i = 0; i <= n; i++)
        for (const char *c = letters; *c; c++) {
            snprintf(typo, sizeof typo, "%.*s%c%s", i, word, *c, word + i);
            use(self, word, typo);
            if (i == n || *c == word[i])
                continue;
            snprintf(typo, sizeof typo, "%.*s%c%s", i, word, *c, word + i + 1);
            use(self, word, typo);
        }
    for (int i = 0; i < n && n > 1; i++) {
        snprintf(typo, sizeof typo, "%.*s%s", i, word, word + i + 1);
        use(self, word, typo);
        if (i + 1 == n || word[i] == word[i + 1])
            continue;
        snprintf(typo, sizeof typo, "%.*s%c%c%s", i, word, word[i + 1], word[i], word + i + 2);
        use(self, word, typo);
    }
}

// ---- the tables

typedef const char *suggest(const void *among, const char *typo);

typedef struct typo_count {
    suggest *suggest;
    const void *among;
    long right, all, short_right, short_all; // short: of words of at most three letters
} typo_count;

static void count_typo(void *self, const char *word, const char *typo)
{
    typo_count *count = self;
    const char *name = count->suggest(count->among, typo);
    bool brief = strlen(word) <= 3, right = name && strcmp(name, word) == 0;
    count->all++;
    count->right += right;
    count->short_all += brief;
    count->short_right += brief && right;
}

// The key suggested; none where the typo is another key, of which no one can know.
static const char *suggest_key(const void *among, const char *typo)
{
    return field_find(among, typo) ? NULL : scenario_key_meant(among, typo);
}

static const char *suggest_word(const void *among, const char *typo)
{
    return field_word_find(among, typo) ? NULL : field_nearest_word(among, typo);
}

typedef struct table_walk {
    const field_block *seen[BLOCKS];
    int blocks;
    typo_count keys, words;
} table_walk;

static void walk_block(table_walk *walk, const field_block *block)
{
    for (int i = 0; i < walk->blocks; i++)
        if (walk->seen[i] == block)
            return;
    assert_true(walk->blocks < BLOCKS);
    walk->seen[walk->blocks++] = block;
    for (const field_row *f = block->fields; f->name; f++) {
        walk->keys.among = block;
        each_typo(f->name, count_typo, &walk->keys);
        walk->words.among = f->words;
        for (const field_word *w = f->words; w && w->name; w++)
            if (w->name[0])
                each_typo(w->name, count_typo, &walk->words);
        if (f->block)
            walk_block(walk, f->block);
        if (f->alternative)
            walk_block(walk, f->alternative->block);
    }
}

static double share(long part, long all)
{
    return 100 * (double)part / (double)all;
}

static void test_all_typos_of_the_tables(void **state)
{
    (void)state;
    static table_walk walk = {.keys = {.suggest = suggest_key}, .words = {.suggest = suggest_word}};
    walk_block(&walk, &scenario_block);
    walk.keys.among = &scenario_block;
    each_typo("include", count_typo, &walk.keys);
    CHECK_WITHIN("blocks", walk.blocks, 53, 200);
    CHECK_WITHIN("one-letter changes of keys", (double)walk.keys.all, 162000, 500000);
    CHECK_WITHIN("right suggestions in %", share(walk.keys.right, walk.keys.all), 99.8, 100);
    CHECK_WITHIN("those of at most three letters in %",
                 share(walk.keys.short_right, walk.keys.short_all), 96, 100);
    CHECK_WITHIN("one-letter changes of words", (double)walk.words.all, 30000, 200000);
    CHECK_WITHIN("right suggestions in %", share(walk.words.right, walk.words.all), 98.5, 100);
}

// ---- words that mean nothing here

static const char unrelated[] =
    "able about above accept across advice afraid agree airport album almost amount angry "
    "animal answer apple april argue arrive artist asleep autumn avoid bakery banana basket "
    "bath beach beauty bedroom begin bicycle birthday biscuit blanket blood bottle bread "
    "bridge brother bucket butter cabbage camera candle carpet castle chair cheese cherry "
    "child church cinema city clever cloth coffee colour comedy cook country cousin cow cream "
    "culture curtain dance danger daughter december dentist desert dictionary dinner doctor "
    "dog dollar dream dress drink driver duck eagle early egg eleven engine evening example "
    "eye family famous farmer father feather finger flower football forest fork friday friend "
    "fruit garden gate ghost giraffe glass glove goat grandmother grape grass guitar hair "
    "hammer happy hat history holiday honey horse hospital hotel hour house husband ice idea "
    "island jacket january jewel juice jungle key kitchen kite knife lake language laugh leaf "
    "lemon letter library lion lunch magazine market matter meal medicine milk monday money "
    "monkey moon morning mother mountain mouse museum music newspaper night nose number ocean "
    "office onion orange oven owl page paint paper parent party pencil people pepper picture "
    "pig pillow pocket police potato queen question rabbit radio rain restaurant river "
    "roof rope salad sand school";

// Of 200 English words in every block, few are near enough to a key: 10, 0.21 %, before `optimise`,
// whose keys `at_most`, `and` and `over` are a letter from almost, sand and oven.
static void test_unrelated_words(void **state)
{
    (void)state;
    static table_walk walk = {.keys = {.suggest = suggest_key}, .words = {.suggest = suggest_word}};
    walk_block(&walk, &scenario_block);
    char all[sizeof unrelated];
    int words = 0, named = 0, suggested = 0;
    memcpy(all, unrelated, sizeof unrelated);
    for (char *save = NULL, *word = strtok_r(all, " ", &save); word;
         word = strtok_r(NULL, " ", &save)) {
        int blocks = 0;
        for (int i = 0; i < walk.blocks; i++) {
            const char *meant = suggest_key(walk.seen[i], word);
            if (meant)
                printf("    %s -> %s\n", word, meant);
            blocks += meant != NULL;
        }
        words++;
        named += blocks > 0;
        suggested += blocks;
    }
    CHECK_BELOW("unrelated words", words - 200, 0);
    CHECK_WITHIN("of them with a suggestion in some block", named, 0, 14);
    CHECK_WITHIN("suggestions in %, over all words and blocks",
                 share(suggested, (long)words * walk.blocks), 0, 0.25);
}

// ---- the reader

// Texts with one key or word marked by a %s, and what it is. Each is laid over base.yaml.
typedef struct marked_text {
    const char *word, *text;
    bool is_key;
} marked_text;

#define STUDY "include: base.yaml\nscatter:\n  samples: 8\n"
#define FACTOR STUDY "  factors: {rocket.mass: "
#define SEED "include: vehicle.yaml\nscatter:\n  samples: 8\n  factors: {base.road.seed: "
#define GROUP STUDY "  factors: {rocket.mass: {normal: 1 kg}, rocket.center.x: {normal: 1 mm}}\n"
#define PAIR "[rocket.adaptors.rear.clearance, rocket.adaptors.front.clearance]"
#define AIR "include: base.yaml\nenvironment:\n  "

static const marked_text marked[] = {
    {"include", "%s: base.yaml\n", true},
    {"normal", FACTOR "{%s: 1 kg}}\n", true},
    {"uniform", FACTOR "{%s: 59 61 kg}}\n", true},
    {"lognormal", FACTOR "{%s: 1 %}}\n", true},
    {"discrete", FACTOR "{%s: [59 kg, 61 kg]}}\n", true},
    {"within", FACTOR "{normal: 1 kg, %s: 3}}\n", true},
    {"between", FACTOR "{normal: 1 kg, %s: 58 62 kg}}\n", true},
    {"weights", FACTOR "{discrete: [59 kg, 61 kg], %s: [1, 2]}}\n", true},
    {"per", FACTOR "{normal: 1 kg, %s: sample}}\n", true},
    {"sample", FACTOR "{normal: 1 kg, per: %s}}\n", false},
    {"rocket", FACTOR "{normal: 1 kg, per: %s}}\n", false},
    {"each", SEED "{%s: sample}}\n", true},
    {"sample", SEED "{each: %s}}\n", false},
    {"paths", STUDY "  factors: {gap: {%s: " PAIR ", uniform: 0.2 0.4 mm}}\n", true},
    {"factors",
     GROUP "  correlated: [{%s: [rocket.mass, rocket.center.x], matrix: [[1, 0], "
           "[0, 1]]}]\n",
     true},
    {"matrix",
     GROUP "  correlated: [{factors: [rocket.mass, rocket.center.x], %s: [[1, 0], "
           "[0, 1]]}]\n",
     true},
    {"paths", "include: base.yaml\nsweep: {gap: {%s: " PAIR ", values: [0.2 mm]}}\n", true},
    {"values", "include: base.yaml\nsweep: {gap: {paths: " PAIR ", %s: [0.2 mm]}}\n", true},
    {"none", AIR "site: %s\n", false},
    {"none", AIR "ground: %s\n", false},
    {"us1976", AIR "atmosphere: %s\n", false},
    {"wgs84", AIR "earth: %s\n", false},
    {"tip", "include: base.yaml\nrun: {end: %s}\n", false},
    {"landing", "include: base.yaml\nrun: {end: %s}\n", false},
    {"all", "include: vehicle.yaml\nbase: {drive: {wheels: %s}}\n", false},
    {"true", "include: vehicle.yaml\nbase: {road: {class: , flat: %s}}\n", false},
    {"none", "include: base.yaml\nrocket: {lock: %s}\n", false},
    {"rear", "include: base.yaml\nrocket: {adaptors: {%s: {clearance: 1 mm}}}\n", false},
    {"front", "include: base.yaml\nrocket: {adaptors: {%s: {clearance: 1 mm}}}\n", false},
    {"rear-left", "include: vehicle.yaml\nbase: {drive: {wheels: [%s]}}\n", false},
};

// A text while typos of one of its words are read.
typedef struct reading {
    const char *before, *after; // the word
    int length;                 // of what stands before
    bool is_key;
    long seen, every; // typos, of which every so many is read
    long read, right, alone;
} reading;

// Whether the message names the typo and suggests the word.
static bool is_right(const ld_message *m, bool is_key, const char *word, const char *typo)
{
    char likely[160], found[160];
    snprintf(likely, sizeof likely, "did you mean \"%s\"?", word);
    snprintf(found, sizeof found, is_key ? "%s" : "\"%s\"", typo);
    return strstr(m->text, likely) && strcmp(m->file, "typo.yaml") == 0 &&
           strstr(is_key ? m->path : m->text, found);
}

static void read_typo(void *self, const char *word, const char *typo)
{
    reading *r = self;
    char text[TEXT];
    ld_model model;
    ld_messages messages;
    bool right = false;
    if (r->seen++ % r->every)
        return;
    snprintf(text, sizeof text, "%.*s%s%s", r->length, r->before, typo, r->after);
    r->read++;
    if (!scenario_read_text(text, strlen(text), "typo.yaml", "", NULL, 0, &model, &messages))
        model_clear(&model);
    for (size_t i = 0; i < messages.count; i++)
        right = right || is_right(&messages.item[i], r->is_key, word, typo);
    if (!right)
        printf("    %s for %s: %s\n", typo, word, messages.count ? messages.item->text : "taken");
    r->right += right;
    r->alone += right && messages.count == 1;
    ld_messages_free(&messages);
}

static void test_special_words_through_the_reader(void **state)
{
    (void)state;
    reading r = {.every = 17};
    assert_int_equal(chdir(LD_SOURCE_DIR "/tests/faults"), 0);
    for (size_t i = 0; i < sizeof marked / sizeof *marked; i++) {
        const char *mark = strstr(marked[i].text, "%s");
        r.before = marked[i].text;
        r.length = (int)(mark - r.before);
        r.after = mark + 2;
        r.is_key = marked[i].is_key;
        each_typo(marked[i].word, read_typo, &r);
    }
    CHECK_WITHIN("typos of special words read", (double)r.read, 800, 2000);
    CHECK_WITHIN("right suggestions in %", share(r.right, r.read), 99.5, 100);
    CHECK_WITHIN("of them the only message in %", share(r.alone, r.right), 99.5, 100);
}

// Reads typos of every key of a file.
static void read_keys(reading *r, const char *file)
{
    char *text;
    size_t length;
    ld_error error;
    assert_int_equal(text_file_read(file, TEXT / 2, &text, &length, &error), LD_OK);
    for (char *c = text; *c;) {
        size_t letters = strspn(c, "abcdefghijklmnopqrstuvwxyz0123456789_");
        char word[LONGEST];
        r->before = text;
        r->length = (int)(c - text);
        r->after = c + letters;
        snprintf(word, sizeof word, "%.*s", (int)letters, c);
        if (letters > 0 && *r->after == ':')
            each_typo(word, read_typo, r);
        c += letters + (*r->after != '\0');
    }
    free(text);
}

static void test_keys_through_the_reader(void **state)
{
    (void)state;
    reading r = {.every = 97, .is_key = true};
    assert_int_equal(chdir(LD_SOURCE_DIR "/tests/faults"), 0);
    read_keys(&r, "base.yaml");
    read_keys(&r, "vehicle.yaml");
    CHECK_WITHIN("typos of keys read", (double)r.read, 500, 2000);
    CHECK_WITHIN("right suggestions in %", share(r.right, r.read), 99.5, 100);
    CHECK_WITHIN("of them the only message in %", share(r.alone, r.right), 97, 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_typos_of_the_tables),
        cmocka_unit_test(test_unrelated_words),
        cmocka_unit_test(test_special_words_through_the_reader),
        cmocka_unit_test(test_keys_through_the_reader),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
