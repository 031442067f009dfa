/* file.c: reads in blocks that double, since the size of a pipe cannot be asked for. */
#include "parser/file.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FIRST_BLOCK ((size_t)64 * 1024)

static ps_result grow(struct file_text *text, size_t *capacity, struct error *error)
{
    size_t wanted = *capacity > 0 ? 2 * *capacity : FIRST_BLOCK;
    char *bytes = realloc(text->bytes, wanted);
    if (!bytes)
        return error_memory(error, wanted, "a scene file");
    text->bytes = bytes;
    *capacity = wanted;
    return PS_OK;
}

static ps_result read_stream(FILE *stream, struct file_text *text, struct error *error)
{
    size_t capacity = 0;
    errno = 0;
    while (!feof(stream) && !ferror(stream) && text->length <= FILE_LARGEST) {
        ps_result result = text->length == capacity ? grow(text, &capacity, error) : PS_OK;
        if (result != PS_OK)
            return result;
        text->length += fread(text->bytes + text->length, 1, capacity - text->length, stream);
    }
    if (ferror(stream))
        return error_set(error, PS_ERROR_IO, "cannot read: %s", strerror(errno));
    if (text->length > FILE_LARGEST)
        return error_set(error, PS_ERROR_INVALID, "larger than %zu MiB",
                         FILE_LARGEST / (1024 * 1024));
    return PS_OK;
}

ps_result file_read(const char *path, struct file_text *text, struct error *error)
{
    bool standard_input = strcmp(path, "-") == 0;
    FILE *stream = standard_input ? stdin : fopen(path, "rb");
    if (!stream)
        return error_set(error, PS_ERROR_IO, "cannot open: %s", strerror(errno));
    ps_result result = read_stream(stream, text, error);
    if (!standard_input)
        fclose(stream);
    return result;
}

void file_release(struct file_text *text)
{
    free(text->bytes);
    *text = (struct file_text){0};
}
