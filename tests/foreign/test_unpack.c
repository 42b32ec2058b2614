// Archives that are what an FMU is not: each is one sentence, and nothing is left of it.
#include <sys/stat.h>
#include <unistd.h>

#include "foreign/folder.h"
#include "foreign/foreign.h"
#include "foreign/unpack.h"
#include "support/check.h"
#include "support/made_fmu.h"
#include "support/scratch.h"

// The description, and this entry.
static void make_archive(const char *name, unsigned mode)
{
    zipFile zip = zipOpen64(in("made.fmu"), APPEND_STATUS_CREATE);
    pack_entry(zip, "modelDescription.xml", "<a/>", 4, 0);
    pack_entry(zip, name, "text", 4, mode);
    assert_int_equal(zipClose(zip, NULL), ZIP_OK);
}

static const char *unpack(void)
{
    static ld_error error;
    char into[128];
    error = (ld_error){0};
    snprintf(into, sizeof into, "%s", in("into"));
    assert_int_equal(mkdir(into, 0700), 0);
    if (foreign_unpack(in("made.fmu"), into, &error) == LD_OK)
        strcpy(error.text, "");
    foreign_folder_remove(into);
    assert_int_equal(access(into, F_OK), -1);
    return error.text;
}

static void expect(const char *text)
{
    const char *found = unpack();
    if (!strstr(found, text) || (*text != '\0') != (*found != '\0'))
        fail_msg("\"%s\" is not: %s", text, found);
}

static const struct {
    const char *name;
    unsigned mode;
    const char *in;
} entries[] = {
    {"resources/a", 0100644, ""},
    {"resources/deep/er/a", 0, ""},
    {"resources/folder/", 040755, ""},
    {"resources/a..b", 0, ""},
    {"../a", 0, "\"../a\" has a path that leaves the archive"},
    {"resources/../../a", 0, "has a path that leaves the archive"},
    {"resources/..", 0, "has a path that leaves the archive"},
    {"resources/./a", 0, "has a path that leaves the archive"},
    {"resources//a", 0, "has a path that leaves the archive"},
    {"/etc/a", 0, "\"/etc/a\" has an absolute path"},
    {"resources\\a", 0, "has a backslash in its name"},
    {"documentation\\a", 0, "has a backslash in its name"},
    {"resources/\n", 0, "has a control character in its name"},
    {"resources/link", 0120777, "\"resources/link\" is a link"},
    {"sources/link", 0120777, "is a link"},
    {"resources/pipe", 0010644, "is neither a file nor a folder"},
    {"modelDescription.xml", 0, "\"modelDescription.xml\" occurs twice"},
    {"modelDescription.xml/a", 0, ""}, // not looked for
};

static void names_and_kinds(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof entries / sizeof *entries; i++) {
        make_archive(entries[i].name, entries[i].mode);
        expect(entries[i].in);
    }
}

static void long_names(void **state)
{
    (void)state;
    char name[700] = "resources/";
    memset(name + 10, 'a', 600);
    make_archive(name, 0);
    expect("has a name that is too long or has a zero in it");
}

static void a_file_is_no_folder(void **state)
{
    (void)state;
    zipFile zip = zipOpen64(in("made.fmu"), APPEND_STATUS_CREATE);
    pack_entry(zip, "resources/a", "text", 4, 0);
    pack_entry(zip, "resources/a/b", "text", 4, 0);
    assert_int_equal(zipClose(zip, NULL), ZIP_OK);
    expect("\"resources/a/b\" has a path through a file");
}

// Zeros that grow far beyond the archive; more entries than any FMU has.
static void bombs(void **state)
{
    (void)state;
    const size_t size = (size_t)64 << 20;
    char *zeros = calloc(1, size), name[32];
    zipFile zip = zipOpen64(in("made.fmu"), APPEND_STATUS_CREATE);
    pack_entry(zip, "sources/zeros", zeros, size, 0);
    assert_int_equal(zipClose(zip, NULL), ZIP_OK);
    free(zeros);
    expect("grows to more than 200 times its size");
    zip = zipOpen64(in("made.fmu"), APPEND_STATUS_CREATE);
    for (int i = 0; i <= FOREIGN_MOST_ENTRIES; i++) {
        snprintf(name, sizeof name, "sources/%d", i);
        pack_entry(zip, name, "", 0, 0);
    }
    assert_int_equal(zipClose(zip, NULL), ZIP_OK);
    expect("has more than 20000 entries");
}

static void an_encrypted_entry(void **state)
{
    (void)state;
    zip_fileinfo about = {0};
    zipFile zip = zipOpen64(in("made.fmu"), APPEND_STATUS_CREATE);
    assert_int_equal(zipOpenNewFileInZip4_64(zip, "resources/a", &about, NULL, 0, NULL, 0, NULL, 0,
                                             0, 0, -MAX_WBITS, DEF_MEM_LEVEL, Z_DEFAULT_STRATEGY,
                                             NULL, 0, 3 << 8, 1, 0),
                     ZIP_OK);
    assert_int_equal(zipCloseFileInZip(zip), ZIP_OK);
    assert_int_equal(zipClose(zip, NULL), ZIP_OK);
    expect("\"resources/a\" is encrypted");
}

// Cut off anywhere, or with a byte changed: whole, or one sentence.
static void damage(void **state)
{
    (void)state;
    enum { END_SIZE = 22 }; // of the record that ends it
    size_t size;
    int whole = 0, told = 0;
    make_archive("resources/a", 0100644);
    char *bytes = read_whole(in("made.fmu"), &size);
    for (size_t i = 0; i < 2 * size; i++) {
        size_t at = i % size;
        bytes[at] ^= i < size ? 0 : 0x11;
        FILE *file = fopen(in("made.fmu"), "wb");
        fwrite(bytes, 1, i < size ? at : size, file);
        fclose(file);
        const char *found = unpack();
        bytes[at] ^= i < size ? 0 : 0x11;
        if (*found && !strstr(found, "made.fmu: "))
            fail_msg("byte %zu: %s", at, found);
        *found ? told++ : whole++;
        if (i + END_SIZE < size)
            assert_true(*found);
    }
    free(bytes);
    CHECK_WITHIN("bytes whose change is refused, of all", (told - (double)size) / (double)size, 0.3,
                 1);
}

static void packages_without_what_they_need(void **state)
{
    (void)state;
    foreign_package *package;
    ld_error error;
    assert_int_equal(setenv("TMPDIR", folder, 1), 0);
    zipFile zip = zipOpen64(in("made.fmu"), APPEND_STATUS_CREATE);
    pack_entry(zip, "resources/a", "text", 4, 0);
    assert_int_equal(zipClose(zip, NULL), ZIP_OK);
    assert_int_equal(foreign_open(in("made.fmu"), &package, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "made.fmu: has no modelDescription.xml"));
    char *description = describe_platform(3, "");
    zip = zipOpen64(in("made.fmu"), APPEND_STATUS_CREATE);
    pack_entry(zip, "modelDescription.xml", description, strlen(description), 0);
    pack_entry(zip, "binaries/x86_64-windows/platform.dll", "", 0, 0);
    assert_int_equal(zipClose(zip, NULL), ZIP_OK);
    free(description);
    assert_int_equal(foreign_open(in("made.fmu"), &package, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "made.fmu: has no binary for this machine, "
                                       "binaries/" FOREIGN_BINARIES_3 "/platform.so"));
    assert_null(package);
}

static void a_binary_that_is_none(void **state)
{
    (void)state;
    foreign_package *package;
    foreign_instance *instance;
    ld_error error;
    char *description = describe_platform(2, ""), name[128];
    zipFile zip = zipOpen64(in("made.fmu"), APPEND_STATUS_CREATE);
    pack_entry(zip, "modelDescription.xml", description, strlen(description), 0);
    snprintf(name, sizeof name, "binaries/%s/platform.so", FOREIGN_BINARIES_2);
    pack_entry(zip, name, "text", 4, 0100755);
    assert_int_equal(zipClose(zip, NULL), ZIP_OK);
    free(description);
    assert_int_equal(foreign_open(in("made.fmu"), &package, &error), LD_OK);
    assert_int_equal(foreign_begin(package, 60, &instance, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "made.fmu: its binary cannot be loaded: "));
    foreign_close(package);
}

// A binary of this machine whose header says another one.
static void a_binary_for_another_machine(void **state)
{
    (void)state;
    enum { MACHINE = 18, AARCH64 = 183, X86_64 = 62 };
    foreign_package *package;
    ld_error error;
    size_t size;
    char *description = describe_platform(3, ""), expected[256];
    char *bytes = read_whole(LD_BINARY_DIR "/tests/platform_fmu3.so", &size);
    const bool is_x86 = bytes[MACHINE] == X86_64;
    bytes[MACHINE] = (char)(is_x86 ? AARCH64 : X86_64);
    zipFile zip = zipOpen64(in("made.fmu"), APPEND_STATUS_CREATE);
    pack_entry(zip, "modelDescription.xml", description, strlen(description), 0);
    pack_entry(zip, "binaries/" FOREIGN_BINARIES_3 "/platform.so", bytes, size, 0100755);
    assert_int_equal(zipClose(zip, NULL), ZIP_OK);
    free(description);
    free(bytes);
    assert_int_equal(foreign_open(in("made.fmu"), &package, &error), LD_ERR_INPUT);
    snprintf(expected, sizeof expected,
             "made.fmu: its binary binaries/" FOREIGN_BINARIES_3
             "/platform.so is one for %s; this machine is %s",
             is_x86 ? "AArch64" : "x86-64", is_x86 ? "x86-64" : "AArch64");
    assert_non_null(strstr(error.text, expected));
    assert_null(package);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_and_kinds),
        cmocka_unit_test(long_names),
        cmocka_unit_test(a_file_is_no_folder),
        cmocka_unit_test(bombs),
        cmocka_unit_test(an_encrypted_entry),
        cmocka_unit_test(damage),
        cmocka_unit_test(packages_without_what_they_need),
        cmocka_unit_test(a_binary_that_is_none),
        cmocka_unit_test(a_binary_for_another_machine),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
