// Tables of what an optimisation varies and what it makes least.
#include "model/fields/tables_optimise.h"

#include "model/fields/field_rows.h"

static const field_word take_words[] = {{"mean", LD_AIM_MEAN},
                                        {"deviation", LD_AIM_DEVIATION},
                                        {"greatest", LD_AIM_GREATEST},
                                        {"quantile", LD_AIM_QUANTILE},
                                        {"footprint", LD_AIM_FOOTPRINT},
                                        {"gain_margin", LD_AIM_GAIN_MARGIN},
                                        {"phase_margin", LD_AIM_PHASE_MARGIN},
                                        {NULL, 0}};
#define OF_RESULT                                                                                  \
    (FORM(LD_AIM_MEAN) | FORM(LD_AIM_DEVIATION) | FORM(LD_AIM_GREATEST) | FORM(LD_AIM_QUANTILE))
#define AIM                                                                                        \
    {"take", CHOICE(ld_aim, take, take_words), DEFAULT(LD_AIM_MEAN),                               \
     .doc = "statistic over all rockets of all samples; `greatest`: of each sample's rockets, "    \
            "averaged; `footprint`: area with 95 % of the landings; margins of a loop"},           \
        {"of", QUANTITY(ld_aim, of), .required = true,                                             \
         .forms = OF_RESULT | FORM(LD_AIM_GAIN_MARGIN) | FORM(LD_AIM_PHASE_MARGIN),                \
         .doc = "result ([quantities](quantities.md)); of a margin the hinge or drive"},           \
        {"and", QUANTITY(ld_aim, beside), .initial_doc = "none", .forms = FORM(LD_AIM_DEVIATION),  \
         .doc = "second result: the root of the sum of both variances"},                           \
    {                                                                                              \
        "level", NUMBER(ld_aim, level, ""), INSIDE(0, 1), DEFAULT(0.95),                           \
            .forms = FORM(LD_AIM_QUANTILE), .doc = "of the quantile"                               \
    }
static const field_row least_fields[] = {AIM, {0}};
static const field_block least_block = {.fields = least_fields,
                                        .form = take_words,
                                        .form_offset = offsetof(ld_aim, take),
                                        .form_key = "take"};
static const field_row limit_fields[] = {
    AIM,
    {"at_most", .kind = FIELD_LIMIT, .offset = offsetof(ld_aim, at_most), .initial = NAN,
     .initial_doc = "this or at_least", .doc = "upper limit"},
    {"at_least", .kind = FIELD_LIMIT, .offset = offsetof(ld_aim, at_least), .initial = NAN,
     .initial_doc = "this or at_most", .doc = "lower limit; of a gain margin a factor"},
    {0}};
static const field_block limit_block = {.fields = limit_fields,
                                        .form = take_words,
                                        .form_offset = offsetof(ld_aim, take),
                                        .form_key = "take"};

static const field_word method_words[] = {
    {"cobyla", LD_OPTIMISE_COBYLA}, {"bobyqa", LD_OPTIMISE_BOBYQA}, {"sbplx", LD_OPTIMISE_SBPLX},
    {"slsqp", LD_OPTIMISE_SLSQP},   {"ccsa", LD_OPTIMISE_CCSA},     {"direct", LD_OPTIMISE_DIRECT},
    {"crs", LD_OPTIMISE_CRS},       {"isres", LD_OPTIMISE_ISRES},   {NULL, 0}};
static const field_row optimise_fields[] = {
    {"over", .kind = FIELD_BOUNDS, .offset = offsetof(ld_optimise, key),
     .other = offsetof(ld_optimise, key_count), .count = LD_MAX_BOUNDS, .required = true,
     .doc = "keys with their bounds"},
    {"least", BLOCK(ld_optimise, least, least_block), .required = true,
     .doc = "what is made least: a disturbance, a load, a time, the footprint's area"},
    {"subject_to", LIST(ld_optimise, limit, limit_count, limit_block, 0, LD_MAX_AIMS),
     .silent = true, .initial_doc = "none", .doc = "constraints"},
    {"method", CHOICE(ld_optimise, method, method_words), DEFAULT(LD_OPTIMISE_COBYLA),
     .doc = "method of NLopt ([optimise.md](optimise.md#methods))"},
    {"starts", INTEGER(ld_optimise, starts, 1, 1000), DEFAULT(1),
     .doc = "the scenario's values, then random ones"},
    {"evaluations", INTEGER(ld_optimise, evaluations, 1, 1000000), DEFAULT(200),
     .doc = "most candidates of a start"},
    {"precision", NUMBER(ld_optimise, precision, ""), ABOVE_TO(0, 0.1), DEFAULT(1e-3),
     .doc = "of the keys, of the width of their bounds"},
    {"others", INTEGER(ld_optimise, others, 0, 1000000), DEFAULT(0),
     .doc =
         "samples behind those of the search by which the gain is measured; 0: as many as these"},
    {"seed", INTEGER(ld_optimise, seed, 0, 999999999), DEFAULT(0), .doc = "of the random starts"},
    {0}};
const field_block optimise_block = {.fields = optimise_fields};
