// Flights of tests whose scenario is a text.
#ifndef LD_TESTS_SUPPORT_FLIGHT_TEXT_H
#define LD_TESTS_SUPPORT_FLIGHT_TEXT_H

#include <string.h>

#include "model/model.h"
#include "scenario/scenario.h"
#include "support/check.h"
#include "support/recorded_run.h"

// To be cleared.
static inline ld_model read_text(const char *text)
{
    ld_model model;
    ld_messages messages;
    if (scenario_read_text(text, strlen(text), "flight", "", NULL, 0, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    return model;
}

static inline ld_rocket_summary fly_model(const ld_model *model)
{
    return summary_of_run(model).rocket[0];
}

#endif
