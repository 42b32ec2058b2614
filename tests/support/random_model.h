// Random models around the reference launcher, with random options, and what every one of them must
// keep: it runs to an end, with finite results or with one clear sentence.
//   LD_RANDOM_MODELS   how many
//   LD_RANDOM_FIRST    number of the first, to repeat one (1)
#ifndef LD_TESTS_SUPPORT_RANDOM_MODEL_H
#define LD_TESTS_SUPPORT_RANDOM_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "launchdyn/model.h"

double between(uint64_t *seed, double low, double high);
bool chance(uint64_t *seed, double probability);
// One of 0 to count - 1.
int choice(uint64_t *seed, int count);

// A factor of 0.3 to 3, on three of four numbers.
void scale(uint64_t *seed, double *value);
void scale_all(uint64_t *seed, int count, double *value);
// One factor for all, so that an inertia stays one that a body can have.
void scale_together(uint64_t *seed, int count, double *value);

// A fixed or prescribed base, tubes, rocket, contact and run settings; free with
// reference_model_free().
void draw_random_model(uint64_t seed, ld_model *model);
// Random bends and a joint to some of them, on what initial shape they have.
void draw_joint(uint64_t seed, ld_model *model);

// Draws and runs models; `otherwise`: how many where LD_RANDOM_MODELS does not say.
void run_random_models(void (*draw_one)(uint64_t seed, ld_model *model), int otherwise);
// One of them, by its number.
void run_random_model_again(void (*draw_one)(uint64_t seed, ld_model *model), int number);

#endif
