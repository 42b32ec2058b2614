// Studies run in the test's folder.
#ifndef LD_TESTS_SUPPORT_STUDY_RUN_H
#define LD_TESTS_SUPPORT_STUDY_RUN_H

#include "launchdyn/study.h"
#include "support/check.h"
#include "support/scratch.h"

// The study of a text, with an override or NULL, beside the examples.
static inline ld_study *study_with(const char *text, const char *set)
{
    ld_study *study;
    ld_messages messages;
    ld_status status = ld_study_read_text(text, strlen(text), "text", LD_SOURCE_DIR "/examples",
                                          &set, set != NULL, &study, &messages);
    if (status)
        ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    return study;
}

static inline ld_study *study_of(const char *text)
{
    return study_with(text, NULL);
}

// Runs what folder `name` does not hold yet.
static inline ld_study_counts study_run(const ld_study *study, const char *name, int threads)
{
    ld_error error = {0};
    ld_study_counts counts;
    ld_study_options options = {.threads = threads};
    ld_status status = ld_study_run(study, in(name), &options, &counts, &error);
    if (status)
        fail_msg("%s", error.text);
    return counts;
}

// The folder's table, to be freed.
static inline char *study_table(const char *name)
{
    ld_error error;
    char csv[160], *text = calloc(1, 1 << 20);
    snprintf(csv, sizeof csv, "%s.csv", in(name));
    assert_int_equal(ld_study_export(in(name), csv, NULL, &error), LD_OK);
    FILE *stream = fopen(csv, "r");
    assert_non_null(stream);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 20) - 1, stream) > 0);
    fclose(stream);
    return text;
}

static inline void expect_same_tables(const char *one, const char *other)
{
    char *a = study_table(one), *b = study_table(other);
    assert_string_equal(a, b);
    free(a);
    free(b);
}

#endif
