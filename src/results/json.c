#include "results/json.h"

#include "results/json_text.h"

static void json_new_line(json_writer *json)
{
    fprintf(json->file, "%s\n%*s", json->first ? "" : ",", 2 * json->level, "");
    json->first = false;
}

void json_key(json_writer *json, const char *key)
{
    json_new_line(json);
    if (!key)
        return;
    json_write_text(json->file, key);
    fputs(": ", json->file);
}

void json_open(json_writer *json, const char *key, char bracket)
{
    if (json->level > 0)
        json_key(json, key);
    fputc(bracket, json->file);
    json->level++;
    json->first = true;
}

void json_close(json_writer *json, char bracket)
{
    json->level--;
    if (!json->first)
        fprintf(json->file, "\n%*s", 2 * json->level, "");
    fputc(bracket, json->file);
    json->first = false;
}

void json_text(json_writer *json, const char *key, const char *text)
{
    json_key(json, key);
    json_write_text(json->file, text);
}

void json_number(json_writer *json, const char *key, double value)
{
    json_key(json, key);
    json_write_number(json->file, value);
}

void json_truth(json_writer *json, const char *key, bool value)
{
    json_key(json, key);
    fputs(value ? "true" : "false", json->file);
}

void json_integer(json_writer *json, const char *key, long long value)
{
    json_key(json, key);
    fprintf(json->file, "%lld", value);
}
