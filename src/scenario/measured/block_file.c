#include "scenario/measured/block_file.h"

#include <stdlib.h>

#include "base/numeric_locale.h"
#include "base/text_file.h"

// The first message as a sentence with its place.
static ld_status fail_by_messages(const scenario_reader *reader, const char *path, ld_error *error)
{
    if (reader->no_memory)
        return ld_fail(error, LD_ERR_MEMORY, "no memory to read %.300s", path);
    if (reader->messages->count == 0)
        return LD_OK;
    const ld_message *first = &reader->messages->item[0];
    return ld_fail(error, LD_ERR_INPUT, "%.200s:%d:%d: %s%s%s", first->file, first->line,
                   first->column, first->path, first->path[0] ? ": " : "", first->text);
}

ld_status block_file_read(const char *path, block_taker *take, void *self, ld_error *error)
{
    char *text;
    size_t length;
    ld_error why;
    ld_messages messages = {0};
    ld_status status = text_file_read(path, READER_MAX_BYTES, &text, &length, &why);
    if (status)
        return ld_fail(error, status, "%.300s %s", path, why.text);
    scenario_reader reader = {.messages = &messages};
    const text_source source = {
        .name = path, .text = text, .length = length, .folder = "", .first_line = 1, .within = ""};
    locale_t before = numeric_locale_enter();
    const tree_node *root = tree_parse(&reader, &source, text, length, 1);
    if (root && root->kind == NODE_MAP)
        take(&reader, root, self);
    else if (root)
        reader_refuse(&reader, root->at, "", "expected a block of keys");
    reader_finish_messages(&reader);
    status = fail_by_messages(&reader, path, error);
    ld_messages_free(&messages);
    pool_free(&reader);
    numeric_locale_leave(before);
    free(text);
    return status;
}
