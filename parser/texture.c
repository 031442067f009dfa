/* texture.c: see texture.h. */
#include "parser/texture.h"

#include "parser/reference.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What makes two textures the same, or NULL. */
static char *identity(struct reader *reader, const struct texture_keys *keys, const char *path)
{
    size_t size = strlen(path) + 64;
    char *text = arena_allocate(reader->arena, size);
    if (text)
        snprintf(text, size, "%d %d %d %s", (int)keys->wrap, (int)keys->encoding,
                 (int)keys->interpolate, path);
    else
        reader->out_of_memory = true;
    return text;
}

static size_t append(struct reader *reader, const struct texture_keys *keys, char *path)
{
    struct scene_description *description = reader->description;
    struct texture_description *textures =
        reader_extend(reader, description->textures, description->texture_count, 1,
                      sizeof *description->textures);
    if (!textures) {
        free(path);
        return NO_INDEX;
    }
    description->textures = textures;
    textures[description->texture_count] = (struct texture_description){
        .path = path,
        .wrap = keys->wrap,
        .encoding = keys->encoding,
        .nearest = keys->interpolate == 1,
        .origin = reader_origin(reader, keys->file),
    };
    return description->texture_count++;
}

size_t texture_add(struct reader *reader, const struct texture_keys *keys)
{
    size_t index = NO_INDEX;
    char *path = reader_path(reader, keys->file, keys->file->text);
    const char *same = path ? identity(reader, keys, path) : NULL;
    if (same && !reference_get(&reader->textures, same, &index)) {
        index = append(reader, keys, path);
        reference_put(reader, &reader->textures, same, index);
    } else {
        free(path);
    }
    return index;
}
