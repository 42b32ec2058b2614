#include "foreign/foreign.h"

#include <elf.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "foreign/folder.h"
#include "foreign/process.h"
#include "foreign/unpack.h"

struct foreign_instance {
    const foreign_package *package;
    foreign_process *process;
};

enum { MOST_STATE = 1 << 28 }; // [byte] of an FMU as bytes

// ---- packages

static ld_status make_folder(foreign_package *self, ld_error *error)
{
    const char *temporary = getenv("TMPDIR");
    char folder[FOREIGN_LONGEST_PATH / 2];
    int length = snprintf(folder, sizeof folder, "%s/launchdyn-fmu-XXXXXX",
                          temporary && temporary[0] == '/' ? temporary : "/tmp");
    if (length >= (int)sizeof folder || !mkdtemp(folder))
        return ld_fail(error, LD_ERR_FILE, "%.300s: cannot make a folder to unpack it: %s",
                       self->path, strerror(errno));
    self->folder = strdup(folder);
    if (!self->folder)
        rmdir(folder);
    return self->folder ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for an FMU");
}

static void library_path(const foreign_package *self, char path[FOREIGN_LONGEST_PATH])
{
    const foreign_description *of = &self->description;
    snprintf(path, FOREIGN_LONGEST_PATH, "%s/binaries/%s/%s.so", self->folder,
             of->version == 2 ? FOREIGN_BINARIES_2 : FOREIGN_BINARIES_3, of->identifier);
}

#if defined(__aarch64__)
enum { THIS_MACHINE = EM_AARCH64 };
#else
enum { THIS_MACHINE = EM_X86_64 };
#endif

static const char *machine_name(int machine)
{
    static const struct {
        int machine;
        const char *name;
    } names[] = {{EM_X86_64, "x86-64"},      {EM_AARCH64, "AArch64"}, {EM_386, "x86 of 32 bits"},
                 {EM_ARM, "ARM of 32 bits"}, {EM_RISCV, "RISC-V"},    {EM_PPC64, "PowerPC"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (names[i].machine == machine)
            return names[i].name;
    return "an unknown machine";
}

// Of a binary that is none at all the loader says so; one for another machine it does not find.
static ld_status check_machine(const foreign_package *self, const char *library, ld_error *error)
{
    const size_t at = offsetof(Elf64_Ehdr, e_machine); // which all classes have there
    unsigned char head[sizeof(Elf64_Ehdr)] = {0};
    FILE *file = fopen(library, "rb");
    bool is_elf = file && fread(head, 1, sizeof head, file) == sizeof head &&
                  memcmp(head, ELFMAG, SELFMAG) == 0;
    if (file)
        fclose(file);
    int machine = head[EI_DATA] == ELFDATA2MSB ? 256 * head[at] + head[at + 1]
                                               : head[at] + 256 * head[at + 1];
    if (!is_elf || machine == THIS_MACHINE)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "%.200s: its binary %.200s is one for %s; this machine is %s", self->path,
                   library + strlen(self->folder) + 1, machine_name(machine),
                   machine_name(THIS_MACHINE));
}

static ld_status read_package(foreign_package *self, ld_error *error)
{
    char path[FOREIGN_LONGEST_PATH];
    snprintf(path, sizeof path, "%s/modelDescription.xml", self->folder);
    ld_status status = foreign_unpack(self->path, self->folder, error);
    if (!status && access(path, R_OK))
        status = ld_fail(error, LD_ERR_INPUT, "%.300s: has no modelDescription.xml", self->path);
    if (!status)
        status = foreign_describe(path, self->path, &self->description, error);
    if (status)
        return status;
    library_path(self, path);
    if (access(path, R_OK))
        return ld_fail(error, LD_ERR_INPUT, "%.200s: has no binary for this machine, %.200s",
                       self->path, path + strlen(self->folder) + 1);
    return check_machine(self, path, error);
}

ld_status foreign_open(const char *path, foreign_package **out, ld_error *error)
{
    foreign_package *self = *out = calloc(1, sizeof *self);
    if (self)
        self->path = strdup(path);
    if (!self || !self->path) {
        free(self);
        *out = NULL;
        return ld_fail(error, LD_ERR_MEMORY, "no memory for an FMU");
    }
    ld_status status = make_folder(self, error);
    if (!status)
        status = read_package(self, error);
    if (!status)
        return LD_OK;
    foreign_close(self);
    *out = NULL;
    return status;
}

void foreign_close(foreign_package *self)
{
    if (!self)
        return;
    if (self->folder)
        foreign_folder_remove(self->folder);
    foreign_description_free(&self->description);
    free(self->folder);
    free(self->path);
    free(self);
}

// ---- instances

// Asks for an answer of a known size.
static ld_status ask_process(foreign_instance *self, const foreign_question *question, void *answer,
                             size_t expected, ld_error *error)
{
    foreign_reply reply = {answer, expected, 0};
    ld_status status = foreign_process_ask(self->process, question, &reply, error);
    return status || reply.size == expected
               ? status
               : ld_fail(error, LD_ERR_NUMERIC, "%.300s: the FMU's process gave an invalid answer",
                         self->package->path);
}

static ld_status instantiate(foreign_instance *self, ld_error *error)
{
    const foreign_description *of = &self->package->description;
    foreign_opening *opening = calloc(1, sizeof *opening);
    if (!opening)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for an FMU");
    opening->version = of->version;
    opening->keeps_state = of->keeps_state;
    library_path(self->package, opening->library);
    snprintf(opening->folder, sizeof opening->folder, "%s", self->package->folder);
    // FMI 3: ends with a separator
    snprintf(opening->resources, sizeof opening->resources, "%.4000s/resources%s",
             self->package->folder, of->version == 3 ? "/" : "");
    snprintf(opening->token, sizeof opening->token, "%s", of->token);
    snprintf(opening->identifier, sizeof opening->identifier, "%s", of->identifier);
    const foreign_question question = {FOREIGN_OPEN, NAN, {opening}, {sizeof *opening}};
    ld_status status = ask_process(self, &question, NULL, 0, error);
    free(opening);
    return status;
}

ld_status foreign_begin(const foreign_package *package, double limit, foreign_instance **out,
                        ld_error *error)
{
    foreign_instance *self = *out = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for an FMU");
    self->package = package;
    ld_status status = foreign_process_start(package->path, limit, &self->process, error);
    if (!status)
        status = instantiate(self, error);
    if (!status)
        return LD_OK;
    foreign_end(self);
    *out = NULL;
    return status;
}

void foreign_end(foreign_instance *self)
{
    if (self)
        foreign_process_end(self->process);
    free(self);
}

ld_status foreign_set(foreign_instance *self, double t, const foreign_value *values, size_t count,
                      ld_error *error)
{
    const foreign_question question = {FOREIGN_SET, t, {values}, {count * sizeof *values}};
    return ask_process(self, &question, NULL, 0, error);
}

ld_status foreign_set_text(foreign_instance *self, double t, uint32_t reference, const char *text,
                           ld_error *error)
{
    const foreign_question question = {
        FOREIGN_SET_TEXT, t, {&reference, text}, {sizeof reference, strlen(text) + 1}};
    return ask_process(self, &question, NULL, 0, error);
}

ld_status foreign_get(foreign_instance *self, double t, const foreign_value *values, size_t count,
                      double *numbers, ld_error *error)
{
    const foreign_question question = {FOREIGN_GET, t, {values}, {count * sizeof *values}};
    return ask_process(self, &question, numbers, count * sizeof *numbers, error);
}

ld_status foreign_enter(foreign_instance *self, double t, double start, ld_error *error)
{
    const foreign_question question = {FOREIGN_ENTER, t, {&start}, {sizeof start}};
    return ask_process(self, &question, NULL, 0, error);
}

ld_status foreign_leave(foreign_instance *self, double t, ld_error *error)
{
    return ask_process(self, &(foreign_question){.kind = FOREIGN_LEAVE, .t = t}, NULL, 0, error);
}

// NOLINTNEXTLINE(readability-function-size)
ld_status foreign_step(foreign_instance *self, double t, const foreign_stepping *step,
                       const foreign_value *values, double *numbers, int *pieces, ld_error *error)
{
    foreign_step_answer answer;
    size_t count = step->inputs + step->outputs;
    size_t expected = offsetof(foreign_step_answer, number) + step->outputs * sizeof(double);
    const foreign_question question = {
        FOREIGN_STEP, t, {step, values}, {sizeof *step, count * sizeof *values}};
    ld_status status = ask_process(self, &question, &answer, expected, error);
    if (status)
        return status;
    memcpy(numbers, answer.number, step->outputs * sizeof *numbers);
    *pieces = (int)answer.pieces;
    return LD_OK;
}

// ---- states

// Bytes in words of 8, the last filled up with zeros.
static void archive_bytes(archive *to, unsigned char *bytes, size_t size)
{
    for (size_t at = 0; at < size; at += 8) {
        int64_t word = 0;
        size_t length = size - at < 8 ? size - at : 8;
        memcpy(&word, bytes + at, length);
        archive_int64(to, &word);
        memcpy(bytes + at, &word, length);
    }
}

static ld_status save(foreign_instance *self, double t, archive *to, unsigned char *bytes,
                      ld_error *error)
{
    foreign_reply reply = {bytes, MOST_STATE, 0};
    ld_status status = foreign_process_ask(
        self->process, &(foreign_question){.kind = FOREIGN_SAVE, .t = t}, &reply, error);
    int64_t count = (int64_t)reply.size;
    archive_count(to, &count);
    if (!status)
        archive_bytes(to, bytes, reply.size);
    return status;
}

static ld_status load(foreign_instance *self, double t, archive *from, unsigned char *bytes,
                      ld_error *error)
{
    int64_t count = 0;
    archive_count(from, &count);
    from->failed |= count > MOST_STATE || (size_t)count > from->size;
    if (from->failed)
        return LD_OK;
    archive_bytes(from, bytes, (size_t)count);
    const foreign_question question = {FOREIGN_LOAD, t, {bytes}, {(size_t)count}};
    return ask_process(self, &question, NULL, 0, error);
}

ld_status foreign_archive(foreign_instance *self, double t, archive *bytes, ld_error *error)
{
    if (!self->package->description.saves_state)
        return ld_fail(error, LD_ERR_INPUT,
                       "%.300s: the state cannot be saved: the FMU cannot serialise its own",
                       self->package->path);
    unsigned char *room = malloc(MOST_STATE);
    if (!room)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the FMU's state");
    ld_status status =
        bytes->loading ? load(self, t, bytes, room, error) : save(self, t, bytes, room, error);
    free(room);
    return status;
}
