/* gltf_container.c: the JSON of a text or binary file, taken out and put back. */
#include "import/gltf_data.h"

#include <stdlib.h>
#include <string.h>

#define GLB_HEADER 12
#define CHUNK_HEADER 8
#define CHUNK_JSON 0x4e4f534au
#define CHUNK_BINARY 0x004e4942u

/* Where the JSON lies in a .glb file. */
ps_result gltf_find_json(const struct mesh_file *file, struct json_text *text, struct error *error)
{
    if (file->length < GLB_HEADER || memcmp(file->bytes, "glTF", 4) != 0)
        return error_set(error, PS_ERROR_INVALID, "%s: not binary glTF", file->path);
    if (gltf_little_endian(file->bytes + 4, 4) != 2)
        return error_set(error, PS_ERROR_INVALID, "%s: binary glTF of a version other than 2",
                         file->path);
    size_t length = gltf_little_endian(file->bytes + 8, 4);
    if (length > file->length)
        return error_set(error, PS_ERROR_INVALID,
                         "%s: the file is cut short: %zu bytes of %zu are there", file->path,
                         file->length, length);
    if (file->length < GLB_HEADER + CHUNK_HEADER ||
        gltf_little_endian(file->bytes + GLB_HEADER + 4, 4) != CHUNK_JSON)
        return error_set(error, PS_ERROR_INVALID, "%s: binary glTF that does not start with JSON",
                         file->path);
    text->start = file->bytes + GLB_HEADER + CHUNK_HEADER;
    text->length = gltf_little_endian(file->bytes + GLB_HEADER, 4);
    if (text->length > file->length - GLB_HEADER - CHUNK_HEADER)
        return error_set(error, PS_ERROR_INVALID, "%s: the file is cut short", file->path);
    return PS_OK;
}

bool gltf_binary_chunk(const struct gltf *gltf, struct gltf_bytes *bytes)
{
    const struct mesh_file *file = gltf->file;
    struct json_text text = {0};
    struct error ignored;
    if (!gltf->binary || gltf_find_json(file, &text, &ignored) != PS_OK)
        return false;
    size_t at = (size_t)(text.start - file->bytes) + text.length;
    if (file->length - at < CHUNK_HEADER ||
        gltf_little_endian(file->bytes + at + 4, 4) != CHUNK_BINARY)
        return false;
    size_t length = gltf_little_endian(file->bytes + at, 4);
    bytes->bytes = (const unsigned char *)file->bytes + at + CHUNK_HEADER;
    bytes->length = file->length - at - CHUNK_HEADER;
    bytes->length = length < bytes->length ? length : bytes->length;
    return true;
}

static void put_little_endian(char *bytes, size_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (char)(value >> 8 * i & 0xff);
}

/* In the place of the old JSON, with blanks after it; in a file that is made longer where it needs
 * to be. */
static ps_result replace_chunk(struct mesh_file *file, const struct json_text *old,
                               const char *text, size_t length, struct error *error)
{
    const size_t before = GLB_HEADER + CHUNK_HEADER, after = file->length - before - old->length;
    size_t room = old->length > length ? old->length : (length + 3) / 4 * 4;
    if (room > old->length) {
        char *bytes = malloc(before + room + after + 1);
        if (!bytes)
            return error_memory(error, before + room + after, "a mesh file");
        memcpy(bytes, file->bytes, before);
        memcpy(bytes + before + room, file->bytes + before + old->length, after + 1);
        free(file->bytes);
        file->bytes = bytes;
        file->length = before + room + after;
        put_little_endian(bytes + 8, file->length);
        put_little_endian(bytes + GLB_HEADER, room);
    }
    memset(file->bytes + before, ' ', room);
    memcpy(file->bytes + before, text, length);
    return PS_OK;
}

ps_result gltf_rewrite(struct gltf *gltf, const struct json_text *old, struct error *error)
{
    size_t length;
    char *text = json_rewrite(gltf->root, &length);
    if (!text)
        return error_memory(error, old->length, "a mesh file");
    if (!gltf->binary) {
        free(gltf->file->bytes);
        gltf->file->bytes = text;
        gltf->file->length = length;
        return PS_OK;
    }
    ps_result result = replace_chunk(gltf->file, old, text, length, error);
    free(text);
    return result;
}
