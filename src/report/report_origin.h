// The block of a report that says where its results come from.
#ifndef LD_REPORT_REPORT_ORIGIN_H
#define LD_REPORT_REPORT_ORIGIN_H

#include <stdio.h>

#include "launchdyn/origin.h"

// Bytes of texts that a report has room for; longer ones are named only.
enum { REPORT_ORIGIN_BYTES = 200000 };

// Writes {"program": [[name, text]], "scenario": text, "files": [[name, text]], "set": [text],
// "point", "sample"}; null in place of a text for which `room` bytes are too few.
void report_write_origin(FILE *json, const ld_origin *origin, size_t room);

#endif
