// Whether two models are the same to the bit.
#ifndef LD_TESTS_SUPPORT_MODEL_COMPARE_H
#define LD_TESTS_SUPPORT_MODEL_COMPARE_H

#include <string.h>

#include "launchdyn/model.h"

static inline bool same_table(const ld_table *a, const ld_table *b)
{
    return a->rows == b->rows && a->columns == b->columns &&
           (a->rows == 0 || memcmp(a->data, b->data, a->rows * a->columns * sizeof(double)) == 0);
}

static inline bool same_model(const ld_model *left, const ld_model *right)
{
    ld_model a, b;
    memcpy(&a, left, sizeof a);
    memcpy(&b, right, sizeof b);
    bool titles = (!a.title && !b.title) || (a.title && b.title && strcmp(a.title, b.title) == 0);
    bool tables = same_table(&a.base.motion, &b.base.motion) &&
                  same_table(&a.tubes.slot.angle, &b.tubes.slot.angle) &&
                  same_table(&a.rocket.motor.thrust, &b.rocket.motor.thrust);
    a.title = b.title = NULL;
    a.base.motion.data = b.base.motion.data = NULL;
    a.tubes.slot.angle.data = b.tubes.slot.angle.data = NULL;
    a.rocket.motor.thrust.data = b.rocket.motor.thrust.data = NULL;
    return titles && tables && memcmp(&a, &b, sizeof a) == 0;
}

#endif
