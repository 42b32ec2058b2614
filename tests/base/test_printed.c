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

// Against the ranges of DerivedCoreProperties.txt and PropList.txt (Unicode 15), from their ends.
static void test_characters_that_are_not_seen(void **state)
{
    (void)state;
    static const struct {
        int32_t code;
        bool hidden;
    } at[] = {{0x1f, 1},    {0x20, 0},    {0x7e, 0},    {0x7f, 1},    {0x9f, 1},    {0xa0, 0},
              {0xad, 1},    {0xae, 0},    {0x34f, 1},   {0x61c, 1},   {0x200a, 0},  {0x200b, 1},
              {0x200f, 1},  {0x2010, 0},  {0x2027, 0},  {0x2028, 1},  {0x202e, 1},  {0x202f, 0},
              {0x205f, 0},  {0x2060, 1},  {0x2069, 1},  {0x2070, 0},  {0x3164, 1},  {0xfe0f, 1},
              {0xfeff, 1},  {0xfffb, 1},  {0xfffc, 0},  {0xfffd, 0},  {0xfffe, 1},  {0xffff, 1},
              {0xe0041, 1}, {0xe1000, 0}, {0x1f680, 0}, {0x2fffe, 1}, {0x10ffff, 1}};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++)
        if (printed_is_hidden(at[i].code) != at[i].hidden)
            fail_msg("U+%04X", (unsigned)at[i].code);
    assert_string_equal(VISIBLE("a\xe2\x80\xae|\xe2\x81\xa6|\xf3\xa0\x81\x81|\xef\xbf\xbf"),
                        "a\\xe2\\x80\\xae|\\xe2\\x81\\xa6|\\xf3\\xa0\\x81\\x81|\\xef\\xbf\\xbf");
    size_t length;
    assert_int_equal(printed_code("\xf0\x9f\x9a\x80", &length), 0x1f680);
    assert_int_equal(length, 4);
    assert_int_equal(printed_code("\xe2\x82", &length), -1);
    assert_int_equal(length, 1);
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
        cmocka_unit_test(test_characters_that_are_not_seen),
        cmocka_unit_test(test_what_does_not_fit_is_cut),
        cmocka_unit_test(test_errors_are_visible),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
