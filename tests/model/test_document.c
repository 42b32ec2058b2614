// docs/scenario.md holds the tables of the scenario language as they are.
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "model/fields/field.h"
#include "model/warnings/plausible.h"
#include "support/markdown.h"

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

// The part of the document between the marks of a name is what is written; a build puts what
// belongs there beside its tests.
static void check_part(const char *name, void (*write)(FILE *stream))
{
    char *tables = markdown_wrapped(write), begin_mark[64], end_mark[64], file[512];
    snprintf(file, sizeof file, "%s/scenario-%s.md", LD_BINARY_DIR, name);
    FILE *record = fopen(file, "w");
    assert_non_null(record);
    fputs(tables, record);
    fclose(record);
    snprintf(begin_mark, sizeof begin_mark, "<!-- %s: begin -->\n", name);
    snprintf(end_mark, sizeof end_mark, "<!-- %s: end -->\n", name);
    char *document = read_whole(LD_SOURCE_DIR "/docs/scenario.md");
    char *begin = strstr(document, begin_mark), *end = strstr(document, end_mark);
    assert_true(begin && end && begin < end);
    begin += strlen(begin_mark);
    *end = '\0';
    if (strcmp(begin, tables) != 0)
        fail_msg("docs/scenario.md differs from the tables; take %s", file);
    free(document);
    free(tables);
}

static void test_document_matches_tables(void **state)
{
    (void)state;
    check_part("keys", field_write_markdown);
}

static void test_document_has_all_notes(void **state)
{
    (void)state;
    check_part("warnings", plausible_write_markdown);
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
    CHECK_WITHIN("keys of the language", check_block(&scenario_block), 500, 900);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_key_is_documented),
        cmocka_unit_test(test_document_matches_tables),
        cmocka_unit_test(test_document_has_all_notes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
