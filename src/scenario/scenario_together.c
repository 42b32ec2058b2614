// Several keys under one name, in `scatter.factors` and in `sweep`.
#include <stdio.h>
#include <string.h>

#include "quantities/study_results.h"
#include "scenario/scenario_reader.h"

// Whether the name can stand beside the other columns of a study; NULL: it can.
static const char *wrong_with_name(const char *name)
{
    static const char *const keys[] = {"sample", "point", "status", "reason", "rocket", "tube"};
    size_t length = strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789_-");
    if (length == 0 || name[length] || length >= LD_MAX_NAME || name[0] < 'a')
        return "expected a name that begins with a lower-case letter and has lower-case letters, "
               "digits, - and _ only";
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strcmp(name, keys[i]) == 0)
            return "is the name of a column of every study; choose another name";
    return study_result_like(name) ? "is the name of a result; choose another name" : NULL;
}

const tree_node *together_paths(scenario_reader *reader, const tree_node *block, const char *path)
{
    char below[READER_MAX_PATH];
    const tree_node *list = tree_member(block, "paths");
    const char *wrong = wrong_with_name(block->key);
    snprintf(below, sizeof below, "%s.paths", path);
    if (wrong) {
        reader_refuse(reader, block->key_at, path, "%s", wrong);
        return NULL;
    }
    bool good =
        list && list->kind == NODE_LIST && list->count >= 2 && list->count <= LD_MAX_TOGETHER;
    for (const tree_node *entry = good ? list->first : NULL; entry && good; entry = entry->next)
        good = entry->kind == NODE_SCALAR && !tree_is_empty(entry);
    if (good)
        return list;
    reader_refuse(reader, list ? list->key_at : block->key_at, below,
                  "expected a list of 2 to %d paths", LD_MAX_TOGETHER);
    return NULL;
}
