#include "model/model_scene.h"

#include "base/path.h"
#include "model/model.h"
#include "parser/yaml/encoding.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The absolute path, without symbolic links, of the folder that a file is in; to be freed. NULL,
 * with errno. */
static char *folder_of(const char *path)
{
    size_t length = (size_t)(path_name(path) - path);
    char *folder = length > 0 ? strndup(path, length) : strdup(".");
    char *resolved = folder ? realpath(folder, NULL) : NULL;
    int reason = errno;
    free(folder);
    errno = reason;
    return resolved;
}

/* "../../models/duck.glb"; of a name that begins as a formula does "./=1.glb". */
static void write_relative(FILE *stream, const char *from, const char *to, const char *name)
{
    size_t common = path_common_length(from, to);
    for (const char *c = from + common; *c; c++)
        if (*c == '/' && c[1])
            fputs("../", stream);
    for (to += common; *to == '/';)
        to++;
    fprintf(stream, "%s%s%s%s", *(*to ? to : name) == '=' ? "./" : "", to, *to ? "/" : "", name);
}

/* From where the scene is, which is beside the model where its path is NULL. */
static char *relative_path(const char *model_path, const char *scene_path)
{
    char *from = scene_path ? folder_of(scene_path) : strdup("");
    char *to = !from ? NULL : scene_path ? folder_of(model_path) : strdup("");
    char *path = NULL;
    size_t length = 0;
    FILE *stream = to ? open_memstream(&path, &length) : NULL;
    if (stream) {
        write_relative(stream, from, to, path_name(model_path));
        if (fclose(stream) != 0) {
            free(path);
            path = NULL;
        }
    }
    free(from);
    free(to);
    return path;
}

static ps_result write_text(const struct model *model, const char *file, char **text,
                            struct error *error)
{
    if (!utf8_is_valid(file, strlen(file)))
        return error_set(error, PS_ERROR_INVALID,
                         "%s: the name is not UTF-8, so no scene can name it", file);
    *text = model_scene_text(model, file);
    return *text ? PS_OK : error_memory(error, 4096, "the scene of a model");
}

ps_result model_scene_make(const struct model_file *model_file, const char *scene_path, char **text,
                           struct mesh_ahead *content, struct error *error)
{
    const char *model_path = model_file->path;
    struct model model;
    ps_result result = model_read(model_file, &model, content, error);
    if (result != PS_OK)
        return result;
    char *file = relative_path(model_path, scene_path);
    result = file ? write_text(&model, file, text, error)
                  : error_set(error, PS_ERROR_IO, "no path leads from %s to %s: %s",
                              scene_path ? scene_path : "", model_path, strerror(errno));
    free(file);
    if (result != PS_OK)
        mesh_ahead_release(content);
    return result;
}
