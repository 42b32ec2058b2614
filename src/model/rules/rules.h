// The rules by subject.
#ifndef LD_MODEL_RULES_H
#define LD_MODEL_RULES_H

#include "model/rules/rule.h"

// Rules of what guides the rocket.
void guide_rules(const rule_set *rules);
// Rules of the air on the rocket.
void aerodynamics_rules(const rule_set *rules);
// Rules of a base whose motion is given.
void base_rules(const rule_set *rules);
// Rules of a base of bodies, joints and force elements.
void mechanism_rules(const rule_set *rules);
// Rules of a vehicle and its platforms.
void vehicle_rules(const rule_set *rules);

#endif
