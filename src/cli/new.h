// The parts of which launchdyn new makes a scenario (assets/scenario).
#ifndef LD_CLI_NEW_H
#define LD_CLI_NEW_H

typedef struct scenario_part {
    const char *name; // "guide-rail"
    const char *text;
} scenario_part;

// Up to one without a name.
extern const scenario_part scenario_parts[];

#endif
