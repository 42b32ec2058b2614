// docs/scenario.md holds the tables of the scenario language as they are.
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "model/field.h"

static const char begin_mark[] = "<!-- keys: begin -->\n", end_mark[] = "<!-- keys: end -->\n";

static char *read_whole(const char *path)
{
    char *text = calloc(1, 1 << 20);
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    assert_non_null(text);
    size_t length = fread(text, 1, (1 << 20) - 1, stream);
    fclose(stream);
    assert_true(length > 0);
    return text;
}

// The part of the document between the marks; a build writes what belongs there beside its tests.
static void test_document_matches_tables(void **state)
{
    (void)state;
    char *tables = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&tables, &length);
    field_write_markdown(stream);
    fclose(stream);
    FILE *record = fopen(LD_BINARY_DIR "/scenario-keys.md", "w");
    assert_non_null(record);
    fputs(tables, record);
    fclose(record);
    char *document = read_whole(LD_SOURCE_DIR "/docs/scenario.md");
    char *begin = strstr(document, begin_mark), *end = strstr(document, end_mark);
    assert_true(begin && end && begin < end);
    begin += strlen(begin_mark);
    *end = '\0';
    if (strcmp(begin, tables) != 0)
        fail_msg("docs/scenario.md differs from the tables; take %s",
                 LD_BINARY_DIR "/scenario-keys.md");
    free(document);
    free(tables);
}

static int check_block(const field_block *block)
{
    int keys = 0;
    for (const field_row *f = block->fields; f->name; f++) {
        assert_non_null(f->doc);
        assert_true(strlen(f->doc) > 0);
        keys += 1 + (f->block ? check_block(f->block) : 0);
    }
    return keys;
}

static void test_every_key_is_documented(void **state)
{
    (void)state;
    CHECK_WITHIN("keys of the language", check_block(&scenario_block), 250, 400);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_key_is_documented),
        cmocka_unit_test(test_document_matches_tables),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
