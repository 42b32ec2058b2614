// An importer of FMUs of our own: unpacks one, reads its description as text, loads its binary.
#ifndef LD_TESTS_SUPPORT_FMU_H
#define LD_TESTS_SUPPORT_FMU_H

#include <dlfcn.h>
#include <sys/stat.h>

#include <minizip/unzip.h>

#include "foreign/unpack.h"
#include "support/shell.h"

enum { FMU_TEXT_SIZE = 4 << 20, FMU_FOLDER_SIZE = 128 };

typedef struct unpacked_fmu {
    char folder[FMU_FOLDER_SIZE], resources[FMU_FOLDER_SIZE + 32], token[64];
    char *description;
    void *binary;
} unpacked_fmu;

static inline void make_folders_of(const char *path)
{
    char folder[512];
    for (const char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
        mkdir(folder, 0700);
    }
}

static inline void unpack_entry(unzFile zip, const char *folder)
{
    char name[256], path[512], bytes[1 << 14];
    unz_file_info info;
    int count;
    assert_int_equal(unzGetCurrentFileInfo(zip, &info, name, sizeof name, NULL, 0, NULL, 0),
                     UNZ_OK);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    make_folders_of(path);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(unzOpenCurrentFile(zip), UNZ_OK);
    while ((count = unzReadCurrentFile(zip, bytes, sizeof bytes)) > 0)
        assert_int_equal(fwrite(bytes, 1, (size_t)count, file), count);
    assert_int_equal(count, 0);
    assert_int_equal(unzCloseCurrentFile(zip), UNZ_OK); // its checksum is right
    fclose(file);
}

// The value of an attribute behind `at`, up to its quotation mark.
static inline void attribute_after(const char *at, const char *name, char *value, size_t size)
{
    char wanted[64];
    snprintf(wanted, sizeof wanted, "%s=\"", name);
    const char *from = strstr(at, wanted);
    assert_non_null(from);
    from += strlen(wanted);
    snprintf(value, size, "%.*s", (int)strcspn(from, "\""), from);
}

// Unpacks an FMU in the shell's folder and loads its binary.
static inline unpacked_fmu fmu_unpack(const char *packed, int version)
{
    unpacked_fmu self = {0};
    static int number;
    char file[512], identifier[128];
    snprintf(self.folder, sizeof self.folder, "%s/unpacked-%d", shell.folder, ++number);
    snprintf(self.resources, sizeof self.resources, "%s/resources", self.folder);
    unzFile zip = unzOpen64(packed);
    assert_non_null(zip);
    for (int next = unzGoToFirstFile(zip); next == UNZ_OK; next = unzGoToNextFile(zip))
        unpack_entry(zip, self.folder);
    unzClose(zip);

    snprintf(file, sizeof file, "%s/modelDescription.xml", self.folder);
    FILE *stream = fopen(file, "rb");
    self.description = calloc(1, FMU_TEXT_SIZE);
    assert_true(stream && self.description);
    assert_true(fread(self.description, 1, FMU_TEXT_SIZE - 1, stream) < FMU_TEXT_SIZE - 1);
    fclose(stream);
    attribute_after(self.description, version == 2 ? "guid" : "instantiationToken", self.token,
                    sizeof self.token);
    attribute_after(self.description, "modelIdentifier", identifier, sizeof identifier);

    snprintf(file, sizeof file, "%s/binaries/%s/%s.so", self.folder,
             version == 2 ? FOREIGN_BINARIES_2 : FOREIGN_BINARIES_3, identifier);
    self.binary = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (!self.binary)
        fail_msg("%s", dlerror());
    return self;
}

// Exports a scenario with the command and opens what came.
static inline unpacked_fmu fmu_open(const char *scenario, int version)
{
    static int number;
    char line[512], file[256];
    number++;
    snprintf(line, sizeof line, "launchdyn fmu export %s --fmi %d --out %d.fmu", scenario, version,
             number);
    assert_int_equal(run(line), 0);
    assert_string_equal(shell.out, "");
    snprintf(file, sizeof file, "%s/%d.fmu", shell.folder, number);
    return fmu_unpack(file, version);
}

static inline void fmu_close(unpacked_fmu *self)
{
    free(self->description);
    dlclose(self->binary);
}

// A function of the binary, as the type of the same function of our declarations.
#define FMU_FUNCTION(fmu, name) (__extension__(__typeof__(&name)) dlsym((fmu)->binary, #name))

// What the value reference of a name is: 64-bit FNV-1a, its halves laid over each other, the lowest
// 31 bits.
static inline unsigned reference_by(const char *name)
{
    uint64_t digest = UINT64_C(0xcbf29ce484222325);
    for (; *name; name++)
        digest = (digest ^ (unsigned char)*name) * UINT64_C(0x100000001b3);
    return (unsigned)((digest >> 32 ^ digest) % (UINT64_C(1) << 31));
}

// The value reference of a variable.
static inline unsigned reference_of(const unpacked_fmu *self, const char *name)
{
    char wanted[256], value[32];
    snprintf(wanted, sizeof wanted, " name=\"%.200s\"", name);
    const char *at = strstr(self->description, wanted);
    if (!at)
        fail_msg("no variable %s", name);
    attribute_after(at, "valueReference", value, sizeof value);
    return (unsigned)atoi(value);
}

#endif
