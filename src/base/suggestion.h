// "Did you mean": the nearest of the names offered, by edit distance.
#ifndef LD_BASE_SUGGESTION_H
#define LD_BASE_SUGGESTION_H

typedef struct name_suggestion {
    const char *wanted;
    const char *name; // the best so far, or NULL: none is near enough
    int distance;     // its distance
} name_suggestion;

name_suggestion suggestion_begin(const char *wanted);
void suggestion_offer(name_suggestion *suggestion, const char *name);

#endif
