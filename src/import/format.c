/* format.c: the table of extensions. */
#include "import/format.h"

#include "base/path.h"
#include "import/import.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

/* `up` is the axis that does by custom, where assimp does not turn it to y itself: prints lie on x
 * and y. */
struct row {
    const char *extension;
    enum mesh_format format;
    int32_t up;
};

static const struct row table[] = {
    {"obj", FORMAT_OBJ, 1}, {"gltf", FORMAT_GLTF, 1}, {"glb", FORMAT_GLB, 1},
    {"ply", FORMAT_PLY, 1}, {"stl", FORMAT_STL, 2},   {"dae", FORMAT_COLLADA, 1},
    {"fbx", FORMAT_FBX, 1}, {"3ds", FORMAT_3DS, 1},
};

#define TABLE_LENGTH (sizeof table / sizeof table[0])

static void list_extensions(char *text, size_t size)
{
    text[0] = '\0';
    for (size_t i = 0; i < TABLE_LENGTH; i++) {
        size_t length = strlen(text);
        snprintf(text + length, size - length, "%s.%s", i > 0 ? ", " : "", table[i].extension);
    }
}

static const struct row *find(const char *path)
{
    const char *dot = strrchr(path_name(path), '.');
    for (size_t i = 0; dot && i < TABLE_LENGTH; i++)
        if (strcasecmp(dot + 1, table[i].extension) == 0)
            return &table[i];
    return NULL;
}

bool mesh_file_is_known(const char *path)
{
    return find(path) != NULL;
}

const char *mesh_file_extension(size_t index)
{
    return index < TABLE_LENGTH ? table[index].extension : NULL;
}

int32_t mesh_file_up(const char *path)
{
    const struct row *row = find(path);
    return row ? row->up : 1;
}

ps_result mesh_format_of(const char *path, enum mesh_format *format, struct error *error)
{
    const struct row *row = find(path);
    if (row) {
        *format = row->format;
        return PS_OK;
    }
    char list[256];
    list_extensions(list, sizeof list);
    return error_set(error, PS_ERROR_INVALID,
                     "%s: unknown kind of mesh file; known by their extension are %s", path, list);
}
