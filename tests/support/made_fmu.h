// FMUs made by tests: a description as text, a binary that the build made, and both packed.
#ifndef LD_TESTS_SUPPORT_MADE_FMU_H
#define LD_TESTS_SUPPORT_MADE_FMU_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <minizip/zip.h>

#include "foreign/unpack.h"
#include "support/check.h"

// Adds an entry; `mode` is the file's, as Unix has it, 0: none.
static inline void pack_entry(zipFile zip, const char *name, const void *bytes, size_t size,
                              unsigned mode)
{
    zip_fileinfo about = {.external_fa = (uLong)mode << 16};
    // made by Unix, so that the mode counts
    assert_int_equal(zipOpenNewFileInZip4_64(zip, name, &about, NULL, 0, NULL, 0, NULL, Z_DEFLATED,
                                             Z_DEFAULT_COMPRESSION, 0, -MAX_WBITS, DEF_MEM_LEVEL,
                                             Z_DEFAULT_STRATEGY, NULL, 0, 3 << 8, 0, 0),
                     ZIP_OK);
    assert_int_equal(zipWriteInFileInZip(zip, bytes, (unsigned)size), ZIP_OK);
    assert_int_equal(zipCloseFileInZip(zip), ZIP_OK);
}

static inline char *read_whole(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        fail_msg("no %s", path);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *bytes = malloc(*size + 1);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    bytes[*size] = '\0';
    fclose(file);
    return bytes;
}

// Packs a description and a binary, of the identifier's name.
static inline void pack_fmu(const char *path, int version, const char *identifier,
                            const char *description, const char *binary)
{
    char name[256];
    size_t size;
    zipFile zip = zipOpen64(path, APPEND_STATUS_CREATE);
    assert_non_null(zip);
    pack_entry(zip, "modelDescription.xml", description, strlen(description), 0);
    snprintf(name, sizeof name, "binaries/%s/%s.so",
             version == 2 ? FOREIGN_BINARIES_2 : FOREIGN_BINARIES_3, identifier);
    char *bytes = read_whole(binary, &size);
    pack_entry(zip, name, bytes, size, 0100755);
    free(bytes);
    assert_int_equal(zipClose(zip, NULL), ZIP_OK);
}

// ---- the platform of tests/fmu/platform_fmu.c

typedef struct platform_variable {
    const char *name, *unit;
    unsigned reference;
    const char *causality;
    int parts; // 3: .x .y .z, 4: .0 to .3, 1
} platform_variable;

static const platform_variable platform_variables[] = {
    {"input.wrench.force", "N", 0, "input", 3},
    {"input.wrench.moment", "N.m", 3, "input", 3},
    {"base.position", "m", 10, "output", 3},
    {"base.quaternion", NULL, 13, "output", 4},
    {"base.velocity", "m/s", 17, "output", 3},
    {"base.rate", "rad/s", 20, "output", 3},
    {"yaw", "rad", 23, "output", 1},
    {"pitch", "rad", 24, "output", 1},
    {"roll", "rad", 25, "output", 1},
    {"body_rate", "rad/s", 26, "output", 3},
    {"mass", "kg", 30, "parameter", 1},
    {"stiffness", NULL, 31, "parameter", 1},
    {"damping", NULL, 32, "parameter", 1},
    {"inertia", NULL, 33, "parameter", 1},
    {"turning.stiffness", NULL, 34, "parameter", 1},
    {"turning.damping", NULL, 35, "parameter", 1},
    {"gravity", NULL, 36, "parameter", 1},
    {"mishap_at", "s", 41, "parameter", 1},
};

#define PLATFORM_KEEPS_2 "canGetAndSetFMUstate=\"true\""
#define PLATFORM_RAMPED_2 PLATFORM_KEEPS_2 " canInterpolateInputs=\"true\""
#define PLATFORM_SAVES_3 "canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\""

static const char platform_units[] =
    "<UnitDefinitions><Unit name=\"m\"><BaseUnit m=\"1\"/></Unit>"
    "<Unit name=\"m/s\"><BaseUnit m=\"1\" s=\"-1\"/></Unit>"
    "<Unit name=\"rad/s\"><BaseUnit rad=\"1\" s=\"-1\"/></Unit>"
    "<Unit name=\"rad\"><BaseUnit rad=\"1\"/></Unit><Unit name=\"s\"><BaseUnit s=\"1\"/></Unit>"
    "<Unit name=\"kg\"><BaseUnit kg=\"1\"/></Unit>"
    "<Unit name=\"N\"><BaseUnit kg=\"1\" m=\"1\" s=\"-2\"/></Unit>"
    "<Unit name=\"N.m\"><BaseUnit kg=\"1\" m=\"2\" s=\"-2\"/></Unit></UnitDefinitions>";

static inline void describe_variable(FILE *to, int version, const platform_variable *one, int part)
{
    static const char *const suffix[2][4] = {{".x", ".y", ".z", ""}, {".0", ".1", ".2", ".3"}};
    const char *end = one->parts == 1 ? "" : suffix[one->parts == 4][part];
    const char *variability = strcmp(one->causality, "parameter") == 0 ? "fixed" : "continuous";
    const char *start = strcmp(one->causality, "output") == 0 ? "" : " start=\"0\"";
    fprintf(to, "<%s name=\"%s%s\" valueReference=\"%u\" causality=\"%s\" variability=\"%s\"",
            version == 2 ? "ScalarVariable" : "Float64", one->name, end,
            one->reference + (unsigned)part, one->causality, variability);
    if (version == 2)
        fprintf(to, "><Real");
    if (one->unit)
        fprintf(to, " unit=\"%s\"", one->unit);
    fprintf(to, version == 2 ? "%s/></ScalarVariable>" : "%s/>", start);
}

// The description; `traits`: attributes of its CoSimulation. To be freed.
static inline char *describe_platform(int version, const char *traits)
{
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    assert_non_null(to);
    fprintf(to,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?><fmiModelDescription fmiVersion=\"%s\" "
            "modelName=\"platform\" %s=\"platform\"><CoSimulation modelIdentifier=\"platform\" "
            "canHandleVariableCommunicationStepSize=\"true\" %s/>%s<ModelVariables>",
            version == 2 ? "2.0" : "3.0", version == 2 ? "guid" : "instantiationToken", traits,
            platform_units);
    for (size_t i = 0; i < sizeof platform_variables / sizeof *platform_variables; i++)
        for (int part = 0; part < platform_variables[i].parts; part++)
            describe_variable(to, version, &platform_variables[i], part);
    fprintf(to,
            version == 2
                ? "<ScalarVariable name=\"mishap\" valueReference=\"40\" "
                  "causality=\"parameter\" variability=\"fixed\"><Integer "
                  "start=\"0\"/></ScalarVariable><ScalarVariable name=\"tuning\" "
                  "valueReference=\"60\" causality=\"parameter\" variability=\"fixed\">"
                  "<String start=\"\"/></ScalarVariable>"
                : "<Int32 name=\"mishap\" valueReference=\"40\" causality=\"parameter\" "
                  "variability=\"fixed\" start=\"0\"/><String name=\"tuning\" "
                  "valueReference=\"60\" causality=\"parameter\" variability=\"fixed\"><Start "
                  "value=\"\"/></String><Float64 name=\"springs\" valueReference=\"30\" "
                  "causality=\"parameter\" variability=\"fixed\" start=\"1e3 1e6 2e3\"><Dimension "
                  "valueReference=\"50\"/></Float64><UInt64 name=\"three\" "
                  "valueReference=\"50\" causality=\"structuralParameter\" "
                  "variability=\"fixed\" start=\"3\"/>");
    fprintf(to, "</ModelVariables><ModelStructure/></fmiModelDescription>\n");
    fclose(to);
    return text;
}

static inline void pack_platform(const char *path, int version, const char *description)
{
    char binary[512];
    snprintf(binary, sizeof binary, "%s/tests/platform_fmu%d.so", LD_BINARY_DIR, version);
    pack_fmu(path, version, "platform", description, binary);
}

static inline void make_platform(const char *path, int version, const char *traits)
{
    char *description = describe_platform(version, traits);
    pack_platform(path, version, description);
    free(description);
}

// One that reports its place by other names.
static inline void make_nameless_platform(const char *path)
{
    char *description = describe_platform(2, "");
    for (char *at = description; (at = strstr(at, "base.position"));)
        memcpy(at, "bass", 4);
    pack_platform(path, 2, description);
    free(description);
}

// One that is given its wrench in units of two newtons.
static inline void make_platform_of_two_newtons(const char *path)
{
    static const char powers[] = "kg=\"1\" m=\"1\" s=\"-2\"/>",
                      moment[] = "kg=\"1\" m=\"2\" s=\"-2\"/>";
    char *description = describe_platform(2, PLATFORM_RAMPED_2), *at = description, *whole = NULL;
    size_t size;
    FILE *to = open_memstream(&whole, &size);
    assert_non_null(to);
    for (; *at; at++) {
        if (strncmp(at, powers, strlen(powers)) == 0 || strncmp(at, moment, strlen(moment)) == 0)
            fputs("factor=\"2\" ", to);
        fputc(*at, to);
    }
    fclose(to);
    pack_platform(path, 2, whole);
    free(whole);
    free(description);
}

#endif
