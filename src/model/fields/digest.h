// A number that distinguishes models.
#ifndef LD_MODEL_DIGEST_H
#define LD_MODEL_DIGEST_H

#include <stddef.h>
#include <stdint.h>

#include "launchdyn/model.h"

// FNV-1a of bytes, continuing from `digest`; the first begins with DIGEST_BEGIN.
#define DIGEST_BEGIN UINT64_C(14695981039346656037)
uint64_t digest_bytes(uint64_t digest, const void *bytes, size_t size);

// Of all that the tables of the language say of a run, whatever file it was read from, and of the
// rockets of a salvo; equal for equal models. Scatter and sweep, which a run does not see, are left
// out.
uint64_t model_digest(const ld_model *model);

#endif
