// The reference cases of tests/data/multibody, read into a description.
#ifndef LD_TESTS_SUPPORT_MULTIBODY_CASE_H
#define LD_TESTS_SUPPORT_MULTIBODY_CASE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/mstmm.h"

enum { CASE_BODIES = 128, CASE_VALUES = 256 };

typedef struct multibody_case {
    int count;
    double gravity[3];
    char name[CASE_BODIES][16];
    ld_mstmm_element element[CASE_BODIES];
    double q[CASE_VALUES], u[CASE_VALUES], tau[CASE_VALUES], u_dot[CASE_VALUES];
} multibody_case;

static inline int read_numbers(FILE *file, double *out, int n)
{
    for (int i = 0; i < n; i++)
        if (fscanf(file, "%lf", &out[i]) != 1)
            return 1;
    return 0;
}

static inline int read_body(FILE *file, multibody_case *c)
{
    int i, parent;
    char joint[16];
    if (fscanf(file, "%d parent %d joint %15s axis", &i, &parent, joint) != 3 || i > CASE_BODIES)
        return 1;
    ld_mstmm_element *e = &c->element[i - 1];
    snprintf(c->name[i - 1], sizeof c->name[0], "%d", i);
    e->name = c->name[i - 1];
    e->parent = parent ? c->name[parent - 1] : NULL;
    e->hinge = !strcmp(joint, "free")       ? LD_HINGE_FREE
               : !strcmp(joint, "revolute") ? LD_HINGE_REVOLUTE
                                            : LD_HINGE_PRISMATIC;
    return read_numbers(file, e->axis, 3) || fscanf(file, " pos") || read_numbers(file, e->at, 3) ||
           fscanf(file, " mass") || read_numbers(file, &e->mass, 1) || fscanf(file, " com") ||
           read_numbers(file, e->center, 3) || fscanf(file, " inertia") ||
           read_numbers(file, e->inertia, 6);
}

// Reads tests/data/multibody/<name>.txt; 0 if all is well.
static inline int read_multibody_case(const char *name, multibody_case *c)
{
    char path[512], word[32];
    memset(c, 0, sizeof *c);
    snprintf(path, sizeof path, LD_SOURCE_DIR "/tests/data/multibody/%s.txt", name);
    FILE *file = fopen(path, "r");
    int bad = file == NULL;
    while (!bad && fscanf(file, "%31s", word) == 1) {
        int n = 0;
        double *into = !strcmp(word, "q")     ? c->q
                       : !strcmp(word, "qd")  ? c->u
                       : !strcmp(word, "tau") ? c->tau
                       : !strcmp(word, "qdd") ? c->u_dot
                                              : NULL;
        if (into)
            bad = fscanf(file, "%d", &n) != 1 || n > CASE_VALUES || read_numbers(file, into, n);
        else if (!strcmp(word, "body"))
            bad = read_body(file, c);
        else if (!strcmp(word, "gravity"))
            bad = read_numbers(file, c->gravity, 3);
        else if (!strcmp(word, "bodies"))
            bad = fscanf(file, "%d", &c->count) != 1;
        else if (!strcmp(word, "case"))
            bad = fscanf(file, "%*s");
    }
    if (file)
        fclose(file);
    return bad;
}

#endif
