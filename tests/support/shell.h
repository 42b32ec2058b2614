// The command as a user meets it, in a folder of its own.
#ifndef LD_TESTS_SUPPORT_SHELL_H
#define LD_TESTS_SUPPORT_SHELL_H

#include "support/check.h"

#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

// What a line of shell gave, in a folder of its own where `launchdyn` is the command just built and
// examples/ the scenarios of the tree.
static struct {
    char folder[64];
    int code;
    char out[1 << 14], err[1 << 14];
} shell;

static int shell_make(void **state)
{
    (void)state;
    char command[512];
    strcpy(shell.folder, "/tmp/launchdyn-command-XXXXXX");
    if (!mkdtemp(shell.folder))
        return -1;
    snprintf(command, sizeof command, "cd %s && ln -s %s/launchdyn . && ln -s %s/examples .",
             shell.folder, LD_BINARY_DIR, LD_SOURCE_DIR);
    return system(command);
}

static int shell_remove(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", shell.folder);
    return system(command);
}

static void read_back(const char *name, char *text, size_t size)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", shell.folder, name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, size - 1, file)] = '\0';
    fclose(file);
}

// Leaves out how far a run of more than 30 s is, as on a busy machine all are.
static void drop_progress(char *text)
{
    char *line = text, *end;
    while ((end = strchr(line, '\n'))) {
        if (strncmp(line, "launchdyn: ", 11) == 0 && strncmp(end - 7, " s left", 7) == 0)
            memmove(line, end + 1, strlen(end + 1) + 1);
        else
            line = end + 1;
    }
}

static int run(const char *line)
{
    char command[1024];
    snprintf(command, sizeof command, "cd %s && PATH=.:$PATH && { %s; } >.out 2>.err </dev/null",
             shell.folder, line);
    int status = system(command);
    shell.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    read_back(".out", shell.out, sizeof shell.out);
    read_back(".err", shell.err, sizeof shell.err);
    drop_progress(shell.err);
    return shell.code;
}

static void expect_in(const char *text, const char *part)
{
    if (!strstr(text, part))
        fail_msg("\"%s\" is not in:\n%s", part, text);
}

// A line that ends with `code`, prints nothing on stdout and this on stderr.
static inline void expect_complaint(const char *line, int code, const char *text)
{
    run(line);
    if (shell.code != code || *shell.out)
        fail_msg("%s: code %d, printed \"%s\" and \"%s\"", line, shell.code, shell.out, shell.err);
    expect_in(shell.err, text);
}

#endif
