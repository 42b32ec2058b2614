// What a study's database says once: tables, points, the scenario.
#ifndef LD_STUDIES_STORE_BEGIN_H
#define LD_STUDIES_STORE_BEGIN_H

#include "studies/store/store_database.h"

// Makes the tables, or refuses those of another study.
ld_status store_begin(study_store *self, ld_error *error);

#endif
