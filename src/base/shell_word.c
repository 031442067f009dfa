#include "base/shell_word.h"

#include <string.h>

void shell_word_print(FILE *stream, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_-+=:,./@%";
    if (word[0] && word[strspn(word, plain)] == '\0') {
        fputs(word, stream);
        return;
    }
    fputc('\'', stream);
    for (; *word; word++)
        if (*word == '\'')
            fputs("'\\''", stream);
        else
            fputc(*word, stream);
    fputc('\'', stream);
}

void shell_word_print_path(FILE *stream, const char *path)
{
    if (path[0] == '-' && path[1])
        fputs("./", stream);
    shell_word_print(stream, path);
}
