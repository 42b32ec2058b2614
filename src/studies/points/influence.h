// What the factors of a study do to a result, by the plan of its samples: indices of Saltelli's,
// elementary effects of Morris's, of all others the shares of a regression.
#ifndef LD_STUDIES_INFLUENCE_H
#define LD_STUDIES_INFLUENCE_H

#include "launchdyn/study.h"
#include "studies/statistics/indices.h"
#include "studies/store/study_data.h"

typedef enum influence_kind {
    INFLUENCE_SHARES,
    INFLUENCE_INDICES,
    INFLUENCE_EFFECTS,
} influence_kind;

influence_kind influence_kind_of(const study_data *data);

// Refuses sensitivities that the plan of the samples does not give.
// @return LD_OK, LD_ERR_INPUT
ld_status influence_check(const study_data *data, ld_index index, ld_error *error);

// Of one factor; what the kind has not is NaN.
typedef struct influence {
    const study_column *factor;
    variance_indices indices;
    elementary_effects effects;
} influence;

// The number by which factors are ranked: the total index, the first order where that is asked for
// or there is no other, mu*.
double influence_rank(const influence *self, influence_kind kind, ld_index index);

// What is asked.
typedef struct influence_question {
    const study_data *data;
    const study_point *point;
    const study_column *result;
    ld_index index; // by which they are ranked
} influence_question;

// Of all factors on a result, those of the greatest rank first, into a list with room for all; of
// shares without seeds.
// @param values used again from call to call
// @return LD_OK, LD_ERR_FILE, LD_ERR_MEMORY
ld_status influences_of(const influence_question *question, study_values *values, influence *list,
                        int *count, ld_error *error);

// What they say, as a sentence or two; of indices which factors act with others.
enum { INFLUENCE_TEXT = 1024 };
void influence_together(const influence *list, int count, char text[INFLUENCE_TEXT]);
void influence_sentence(const study_column *result, influence_kind kind, const influence *list,
                        int count, char text[INFLUENCE_TEXT]);

#endif
