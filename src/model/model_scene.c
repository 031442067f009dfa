#include "model/model_scene.h"

#include "base/path.h"
#include "model/model.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The absolute path, without symbolic links, of the folder that a file is in; to be freed. NULL, with errno. */
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

/* Of absolute paths of folders: how long the part is that both begin with, at the end of a folder's name. */
static size_t common_length(const char *a, const char *b)
{
    size_t length = 0, i = 0;
    for (; a[i] && a[i] == b[i]; i++)
        if (a[i] == '/')
            length = i;
    if ((!a[i] || a[i] == '/') && (!b[i] || b[i] == '/'))
        length = i;
    return length;
}

/* "../../models/duck.glb" */
static void write_relative(FILE *stream, const char *from, const char *to, const char *name)
{
    size_t common = common_length(from, to);
    for (const char *c = from + common; *c; c++)
        if (*c == '/' && c[1])
            fputs("../", stream);
    for (to += common; *to == '/';)
        to++;
    fprintf(stream, "%s%s%s", to, *to ? "/" : "", name);
}

static char *relative_path(const char *model_path, const char *scene_path)
{
    char *from = folder_of(scene_path), *to = from ? folder_of(model_path) : NULL, *path = NULL;
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

ps_result model_scene_make(const char *model_path, const char *scene_path, const char *folder,
                           char **text, struct error *error)
{
    struct model model;
    ps_result result = model_read(model_path, folder, &model, error);
    if (result != PS_OK)
        return result;
    char *file = scene_path ? relative_path(model_path, scene_path) : strdup(path_name(model_path));
    if (!file)
        return error_set(error, PS_ERROR_IO, "no path leads from %s to %s: %s",
                         scene_path ? scene_path : "", model_path, strerror(errno));
    *text = model_scene_text(&model, file);
    free(file);
    return *text ? PS_OK : error_memory(error, 4096, "the scene of a model");
}
