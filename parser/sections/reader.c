/* reader.c: see reader.h. */
#include "parser/sections/reader.h"

#include <stdlib.h>
#include <string.h>

struct origin reader_origin(const struct reader *reader, const struct node *at)
{
    const char *file = at->file ? at->file : reader->file;
    return (struct origin){file, at->mark.line, at->mark.column};
}

void reader_error(const struct reader *reader, const struct node *at, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    reader_error_list(reader, at, format, arguments);
    va_end(arguments);
}

void reader_error_list(const struct reader *reader, const struct node *at, const char *format,
                       va_list arguments)
{
    struct origin origin = reader_origin(reader, at);
    if (at->kind != NODE_BROKEN)
        diagnostics_report_list(reader->sink, SEVERITY_ERROR, &origin, at->mark.width, format,
                                arguments);
}

const char *reader_add_file(struct reader *reader, const char *name)
{
    struct scene_description *description = reader->description;
    char **files =
        realloc(description->files, (description->file_count + 1) * sizeof *description->files);
    if (!files) {
        reader->out_of_memory = true;
        return NULL;
    }
    description->files = files;
    files[description->file_count] = reader_copy(reader, name);
    return files[description->file_count] ? files[description->file_count++] : NULL;
}

void *reader_allocate(struct reader *reader, size_t count, size_t size)
{
    if (count == 0)
        return NULL;
    void *memory = calloc(count, size);
    if (!memory)
        reader->out_of_memory = true;
    return memory;
}

char *reader_path(struct reader *reader, const struct node *node, const char *text)
{
    const char *slash = node->file ? strrchr(node->file, '/') : NULL;
    size_t folder = slash && text[0] != '/' ? (size_t)(slash - node->file) + 1 : 0;
    size_t bytes = strlen(text) + 1;
    char *path = reader_allocate(reader, folder + bytes, 1);
    if (!path)
        return NULL;
    if (folder > 0)
        memcpy(path, node->file, folder);
    memcpy(path + folder, text, bytes);
    return path;
}

char *reader_copy(struct reader *reader, const char *text)
{
    size_t bytes = strlen(text) + 1;
    char *copy = reader_allocate(reader, bytes, 1);
    if (copy)
        memcpy(copy, text, bytes);
    return copy;
}

/* Arrays have room for a power of two. */
static size_t room_for(size_t count)
{
    size_t room = 1;
    while (room < count)
        room *= 2;
    return count ? room : 0;
}

void *reader_extend(struct reader *reader, void *array, size_t count, size_t more, size_t size)
{
    size_t room = room_for(count + more);
    if (!array || room > room_for(count))
        array = realloc(array, (room ? room : 1) * size);
    if (array)
        memset((char *)array + count * size, 0, more * size);
    else
        reader->out_of_memory = true;
    return array;
}
