// A JSON text on its way to a file: indented by two blanks a level, commas as they are needed.
#ifndef LD_RESULTS_JSON_H
#define LD_RESULTS_JSON_H

#include <stdbool.h>
#include <stdio.h>

typedef struct json_writer {
    FILE *file;
    int level;
    bool first; // no member of the innermost object or array yet
} json_writer;

// The name of a member, after which its value is due; NULL in an array.
void json_key(json_writer *json, const char *key);

// An object '{' or an array '[', and its end; the outermost has no key.
void json_open(json_writer *json, const char *key, char bracket);
void json_close(json_writer *json, char bracket);

void json_text(json_writer *json, const char *key, const char *text);
void json_number(json_writer *json, const char *key, double value);
void json_truth(json_writer *json, const char *key, bool value);
void json_integer(json_writer *json, const char *key, long long value);

#endif
