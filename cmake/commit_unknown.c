// Of the library that the tests are linked to: it stays the same from commit to commit.
#include "results/program.h"

const char program_commit[] = "unknown";
