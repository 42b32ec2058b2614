// Texts that a test writes for a document of docs/.
#ifndef LD_TESTS_SUPPORT_MARKDOWN_H
#define LD_TESTS_SUPPORT_MARKDOWN_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Whether a word would begin a list or a heading at the begin of a line.
static inline bool markdown_begins_block(const char *word)
{
    return strchr("+-*=#", *word) && (word[1] == ' ' || word[1] == '\n');
}

// Characters up to the next blank or end of a line that is not within `code`.
static inline size_t markdown_word(const char *text)
{
    size_t length = 0;
    for (bool code = false; text[length] && text[length] != '\n'; length++) {
        code ^= text[length] == '`';
        if (text[length] == ' ' && !code)
            break;
    }
    return length;
}

// Writes the text in lines of at most 120 characters; items of lists continue under their text.
static inline void markdown_wrap(FILE *stream, const char *text)
{
    size_t column = 0, indent = 0;
    while (*text) {
        size_t word = 1 + markdown_word(text + 1);
        if (*text == '\n') {
            indent = strncmp(text + 1, "- ", 2) == 0 ? 2 : 0;
            column = (size_t)-1;
        } else if (column + word > 120 - 2 && !markdown_begins_block(text + 1)) {
            fprintf(stream, "\n%*s%.*s", (int)indent, "", (int)word - 1, text + 1);
            column = indent + word - 1;
            text += word;
            continue;
        }
        fwrite(text, 1, word, stream);
        column += word;
        text += word;
    }
}

// What is written, so wrapped; to be freed.
static inline char *markdown_wrapped(void (*write)(FILE *stream))
{
    char *text[2];
    size_t length;
    FILE *stream = open_memstream(&text[0], &length);
    write(stream);
    fclose(stream);
    stream = open_memstream(&text[1], &length);
    markdown_wrap(stream, text[0]);
    fclose(stream);
    free(text[0]);
    return text[1];
}

#endif
