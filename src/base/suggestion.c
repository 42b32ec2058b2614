#include "base/suggestion.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/status.h"

enum { LONGEST = 40 };

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

// Number of letters to insert, delete, replace or exchange with their neighbour; case costs
// nothing.
static int edit_distance(const char *a, const char *b)
{
    int n = (int)strlen(a), m = (int)strlen(b), cost[LONGEST + 1][LONGEST + 1];
    for (int i = 0; i <= n; i++)
        cost[i][0] = i;
    for (int j = 0; j <= m; j++)
        cost[0][j] = j;
    for (int i = 1; i <= n; i++)
        for (int j = 1; j <= m; j++) {
            int x = tolower((unsigned char)a[i - 1]), y = tolower((unsigned char)b[j - 1]);
            int best = cost[i - 1][j - 1] + (x != y);
            best = smaller(best, smaller(cost[i - 1][j], cost[i][j - 1]) + 1);
            if (i > 1 && j > 1 && x == tolower((unsigned char)b[j - 2]) &&
                y == tolower((unsigned char)a[i - 2]))
                best = smaller(best, cost[i - 2][j - 2] + 1);
            cost[i][j] = best;
        }
    return cost[n][m];
}

// The most edits that leave a name of so many letters recognisable.
static int most_edits(size_t length)
{
    return length < 7 ? 1 : length < 12 ? 2 : 3;
}

// Whether the word may be a slip of the name: something must be left of a short one, and after
// several edits the first letter, which is seldom wrong.
static bool may_mean(const char *wanted, const char *name, size_t longer, int distance)
{
    bool alike = tolower((unsigned char)*wanted) == tolower((unsigned char)*name);
    return distance <= most_edits(longer) && distance < (int)longer && (distance < 2 || alike);
}

// Quantities that had another name in earlier versions; one that ends with a point begins those of
// a group.
static const struct {
    const char *former, *now;
} renamed[] = {{"aim.", "since_ignition."}, {"muzzle_speed", "exit_speed"}};

const char *ld_current_name(const char *former, char *name, size_t size)
{
    for (size_t i = 0; i < sizeof renamed / sizeof *renamed; i++) {
        const char *at = strstr(former, renamed[i].former);
        size_t length = strlen(renamed[i].former);
        bool group = renamed[i].former[length - 1] == '.';
        if (!at || (at > former && at[-1] != '.') || (!group && at[length]))
            continue;
        snprintf(name, size, "%.*s%s%s", (int)(at - former), former, renamed[i].now, at + length);
        return name;
    }
    return NULL;
}

// Whether the name is what the requested one is called now.
static bool is_renamed(const char *wanted, const char *name)
{
    char now[256];
    return ld_current_name(wanted, now, sizeof now) && strcmp(now, name) == 0;
}

name_suggestion suggestion_begin(const char *wanted)
{
    return (name_suggestion){.wanted = wanted};
}

void suggestion_offer(name_suggestion *suggestion, const char *name)
{
    size_t own = strlen(name), given = strlen(suggestion->wanted),
           longer = own > given ? own : given;
    if (is_renamed(suggestion->wanted, name)) {
        suggestion->distance = 0;
        suggestion->name = name;
        return;
    }
    if (longer > LONGEST)
        return;
    int distance = edit_distance(suggestion->wanted, name);
    if (may_mean(suggestion->wanted, name, longer, distance) &&
        (!suggestion->name || distance < suggestion->distance)) {
        suggestion->distance = distance;
        suggestion->name = name;
    }
}

const char *ld_nearest_name(const char *word, const char *const *names, size_t count)
{
    name_suggestion nearest = suggestion_begin(word);
    for (size_t i = 0; i < count; i++)
        suggestion_offer(&nearest, names[i]);
    return nearest.name;
}

const char *ld_suggested_name(const char *text, char *name, size_t size)
{
    static const char question[] = "did you mean \"";
    const char *found = NULL; // the last one: what stands before it may quote anything
    for (const char *at = text; (at = strstr(at, question)); found = at)
        at += sizeof question - 1;
    const char *end = found ? strchr(found, '"') : NULL;
    if (!end)
        return NULL;
    snprintf(name, size, "%.*s", (int)(end - found), found);
    return name;
}
