/* format.c: the table of extensions. */
#include "import/format.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

static const struct {
    const char *extension;
    enum mesh_format format;
} table[] = {
    {"obj", FORMAT_OBJ}, {"gltf", FORMAT_GLTF},   {"glb", FORMAT_GLB}, {"ply", FORMAT_PLY},
    {"stl", FORMAT_STL}, {"dae", FORMAT_COLLADA}, {"fbx", FORMAT_FBX}, {"3ds", FORMAT_3DS},
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

ps_result mesh_format_of(const char *path, enum mesh_format *format, struct error *error)
{
    const char *name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < TABLE_LENGTH; i++)
        if (strcasecmp(dot + 1, table[i].extension) == 0) {
            *format = table[i].format;
            return PS_OK;
        }
    char list[256];
    list_extensions(list, sizeof list);
    return error_set(error, PS_ERROR_INVALID,
                     "%s: unknown kind of mesh file; known by their extension are %s", path, list);
}
