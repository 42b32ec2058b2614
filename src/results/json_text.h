// Text and numbers of JSON.
#ifndef LD_RESULTS_JSON_TEXT_H
#define LD_RESULTS_JSON_TEXT_H

#include <stdio.h>

// A string in quotes; bytes that are not UTF-8 become U+FFFD.
void json_write_text(FILE *file, const char *text);

// 17 digits, null where there is no value; requires the C locale.
void json_write_number(FILE *file, double value);

#endif
