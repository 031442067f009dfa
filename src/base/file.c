/* file.c: reads in blocks that double, since the size of a pipe cannot be asked for. */
#include "base/file.h"

#include "base/input_file.h"
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

static ps_result fail_size(struct error *error, size_t most)
{
    size_t mebibyte = (size_t)1024 * 1024;
    return error_set(error, PS_ERROR_INVALID, "larger than %zu MiB", most / mebibyte);
}

static ps_result read_stream(FILE *stream, size_t most, struct file_text *text, struct error *error)
{
    size_t capacity = 0;
    ps_result grown = grow(text, &capacity, error); /* of no bytes, there is a text, too */
    if (grown != PS_OK)
        return grown;
    errno = 0;
    while (!feof(stream) && !ferror(stream) && text->length <= most) {
        ps_result result = text->length == capacity ? grow(text, &capacity, error) : PS_OK;
        if (result != PS_OK)
            return result;
        text->length += fread(text->bytes + text->length, 1, capacity - text->length, stream);
    }
    if (ferror(stream))
        return error_set(error, PS_ERROR_IO, "cannot read: %s", strerror(errno));
    return text->length > most ? fail_size(error, most) : PS_OK;
}

ps_result file_read(const char *path, struct file_text *text, struct error *error)
{
    struct stat status;
    bool standard_input = strcmp(path, "-") == 0;
    FILE *stream = standard_input ? stdin : fopen(path, "rb");
    if (!stream)
        return error_set(error, PS_ERROR_IO, "cannot open: %s", strerror(errno));
    if (fstat(fileno(stream), &status) == 0) {
        text->device = (uint64_t)status.st_dev;
        text->serial = (uint64_t)status.st_ino;
    }
    ps_result result = read_stream(stream, FILE_LARGEST, text, error);
    if (!standard_input)
        fclose(stream);
    return result;
}

ps_result file_read_regular(const char *path, const char *folder, size_t most,
                            struct file_text *text, struct error *error)
{
    struct input_file file;
    ps_result result = input_file_open(path, folder, &file, error);
    if (result != PS_OK)
        return result;
    text->device = file.device;
    text->serial = file.serial;
    FILE *stream = fdopen(file.descriptor, "rb");
    if (!stream) {
        close(file.descriptor);
        return error_memory(error, BUFSIZ, "a file");
    }
    result = read_stream(stream, most, text, error);
    fclose(stream);
    return result;
}

void file_release(struct file_text *text)
{
    free(text->bytes);
    *text = (struct file_text){0};
}
