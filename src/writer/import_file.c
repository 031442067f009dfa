/* import_file.c: see import_file.h.
 *
 * The whole scene is read before anything is written: an error leaves no file.
 */
#include "writer/import_file.h"

#include "base/path.h"
#include "parser/yaml/encoding.h"
#include "writer/scene_files.h"
#include <stdlib.h>
#include <string.h>

/* "FOLDER/" of a path, or ""; to be freed. */
static char *folder_of(const char *path)
{
    return strndup(path, (size_t)(path_name(path) - path));
}

static char *resolved(const char *folder)
{
    return realpath(*folder ? folder : ".", NULL);
}

/* How one folder is reached from another, which ends in a slash or is ""; to be freed. NULL: out of
 * memory, or there is no such folder. */
static char *path_between(const char *from, const char *to)
{
    char *a = resolved(from), *b = resolved(to), *path = NULL;
    if (a && b) {
        size_t common = path_common_length(a, b), ups = 0;
        for (const char *c = a + common; *c; c++)
            ups += *c == '/' && c[1];
        const char *rest = b[common] == '/' ? b + common + 1 : b + common;
        size_t size = 3 * ups + strlen(rest) + 2;
        path = calloc(1, size);
        for (size_t i = 0; i < ups && path; i++)
            strcat(path, "../");
        if (path && *rest)
            strcat(strcat(path, rest), "/");
    }
    free(a);
    free(b);
    return path;
}

/* Reads and converts; errors of reading go to `error`. */
static ps_result convert_file(const char *path, import_convert convert, void *user,
                              const struct import_paths *paths, struct written_scene *scene,
                              struct error *error)
{
    struct file_text text = {0};
    ps_result result = file_read(path, &text, error);
    if (result == PS_OK) {
        result = convert(user, path, &text, paths, scene);
    } else {
        struct error reason = *error;
        error_set(error, result, "%s: %.2000s", path, reason.text);
    }
    file_release(&text);
    return result;
}

ps_result import_file(const char *path, const char *output, import_convert convert, void *user,
                      struct error *error)
{
    char *scene_folder = folder_of(path), *output_folder = folder_of(output), *base = NULL,
         *between = NULL;
    struct written_scene scene = {0};
    ps_result result = PS_OK;
    error->text[0] = '\0';
    if (scene_folder && output_folder) {
        base = strdup(output + strlen(output_folder));
        between = path_between(output_folder, scene_folder);
    }
    if (!base || !between) {
        result =
            error_set(error, PS_ERROR_IO, "%s: can't find its folder, or that of %s", output, path);
    } else if (!utf8_is_valid(base, strlen(base)) || !utf8_is_valid(between, strlen(between))) {
        result = error_set(error, PS_ERROR_INVALID,
                           "%s: its name, and the way from it to %s, must be UTF-8", output, path);
    } else {
        base[strlen(base) - strlen(".psd")] = '\0';
        const struct import_paths paths = {base, scene_folder, between};
        result = convert_file(path, convert, user, &paths, &scene, error);
        if (result == PS_OK)
            result = scene_files_write(&scene, path, output, output_folder, error);
    }
    written_scene_release(&scene);
    free(scene_folder);
    free(output_folder);
    free(base);
    free(between);
    return result;
}
