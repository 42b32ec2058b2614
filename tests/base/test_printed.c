// Texts from outside as a terminal may show them.
#include "support/check.h"

#include "base/printed.h"
#include "launchdyn/status.h"

static void test_control_characters_come_out_as_text(void **state)
{
    (void)state;
    assert_string_equal(VISIBLE(""), "");
    assert_string_equal(VISIBLE("a\x1b[31m\r\n\t\x7f"), "a\\x1b[31m\\x0d\\x0a\\x09\\x7f");
    // C1 controls in UTF-8 and as bytes, half a character, an escape in a longer form than need be
    assert_string_equal(VISIBLE("\xc2\x9b|\x9b|\xc3|\xc0\x9b|\xe0\x80\x9b"),
                        "\\xc2\\x9b|\\x9b|\\xc3|\\xc0\\x9b|\\xe0\\x80\\x9b");
    // surrogates and what lies beyond the last character are none
    assert_string_equal(VISIBLE("\xed\xa0\x80 \xf4\x90\x80\x80"),
                        "\\xed\\xa0\\x80 \\xf4\\x90\\x80\\x80");
    const char fine[] = "\xc2\xa0 \xc3\xbc \xce\xbc \xe2\x82\xac \xf0\x9f\x9a\x80 \\x1b";
    assert_string_equal(VISIBLE(fine), fine);
}

static void test_what_does_not_fit_is_cut(void **state)
{
    (void)state;
    char text[8];
    assert_string_equal(ld_visible_text("1234567", text, sizeof text), "1234567");
    assert_string_equal(ld_visible_text("12345678", text, sizeof text), "1234...");
    assert_string_equal(ld_visible_text("123\x1b", text, sizeof text), "123\\x1b");
    assert_string_equal(ld_visible_text("1234\x1b", text, sizeof text), "1234...");
    assert_string_equal(ld_visible_text("12\x1b\x1b", text, sizeof text), "12...");
    assert_string_equal(ld_visible_text("\x1b\x1b", text, sizeof text), "\\x1b...");
    assert_string_equal(ld_visible_text("1234", text, 4), "...");
    assert_string_equal(ld_visible_text("1", text, 1), "");
}

static void test_errors_are_visible(void **state)
{
    (void)state;
    ld_error error;
    ld_fail(&error, LD_ERR_FILE, "cannot read %s",
            "a\x1b"
            "b");
    assert_string_equal(error.text, "cannot read a\\x1b"
                                    "b");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_control_characters_come_out_as_text),
        cmocka_unit_test(test_what_does_not_fit_is_cut),
        cmocka_unit_test(test_errors_are_visible),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
