// What a study's database says once: tables, points, the scenario.
#ifndef LD_STUDIES_STORE_BEGIN_H
#define LD_STUDIES_STORE_BEGIN_H

#include "studies/store/store_database.h"

// The scenario as text in which nothing is left out but when to stop: the rule, and the number of
// samples where more may be added. To be freed; NULL: no memory.
char *store_identity(const ld_model *model);

// Makes the tables, or refuses those of another study.
ld_status store_begin(study_store *self, ld_error *error);

#endif
