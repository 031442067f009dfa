/* scene_files.c: see scene_files.h.
 *
 * The files beside the scene are made in a folder of their own, and moved out of it when all are
 * whole, and the scene's text is written too: an import that fails leaves the files of an earlier
 * one as they are, unless one can't be moved. The folder goes away again, but for an import that is
 * killed: it leaves the folder, with what it made so far.
 */
#include "writer/scene_files.h"

#include "base/output_file.h"
#include "base/path.h"
#include "image/image.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* FOLDERNAME, to be freed; NULL: out of memory. */
static char *path_in(const char *folder, const char *name)
{
    size_t size = strlen(folder) + strlen(name) + 1;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s%s", folder, name);
    return path;
}

/* --- files that the scene names
 * ------------------------------------------------------------------- */

/* The path without links, of a file that need not be there; to be freed. NULL: out of memory, or
 * its folder is not there either. */
static char *canonical(const char *path)
{
    char *whole = realpath(path, NULL), *folder = NULL;
    if (whole)
        return whole;
    const char *name = path_name(path);
    char *given = name > path ? strndup(path, (size_t)(name - path)) : strdup("./");
    folder = given ? realpath(given, NULL) : NULL;
    free(given);
    if (folder) {
        size_t size = strlen(folder) + strlen(name) + 2;
        whole = malloc(size);
        if (whole)
            snprintf(whole, size, "%s/%s", folder, name);
    }
    free(folder);
    return whole;
}

static int compare_texts(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* That it is none of `inputs`, which are sorted. */
static ps_result check_target(const char *path, char *const *inputs, size_t count,
                              struct error *error)
{
    char *target = canonical(path);
    bool is_input = target && bsearch(&target, inputs, count, sizeof *inputs, compare_texts);
    free(target);
    if (is_input)
        return error_set(error, PS_ERROR_INVALID,
                         "cannot write '%.1000s': the imported scene reads it; choose another name "
                         "with --output",
                         path);
    return PS_OK;
}

/* The same, and that it can be replaced. */
static ps_result check_side_file(const char *path, char *const *inputs, size_t count,
                                 struct error *error)
{
    struct stat status;
    if (stat(path, &status) == 0 && (!S_ISREG(status.st_mode) || access(path, W_OK) != 0))
        return error_set(error, PS_ERROR_IO,
                         "cannot write '%.1000s': it is no file, or a read-only one", path);
    return check_target(path, inputs, count, error);
}

static ps_result check_targets(const struct written_scene *scene, const char *input,
                               const char *output, const char *folder, struct error *error)
{
    ps_result result = PS_OK;
    size_t count = 0;
    char **inputs = malloc((scene->named_count + 1) * sizeof *inputs);
    if (!inputs)
        return error_memory(error, scene->named_count * sizeof *inputs, "files' names");
    for (size_t i = 0; i <= scene->named_count; i++) {
        inputs[count] = canonical(i > 0 ? scene->named[i - 1] : input);
        count += inputs[count] != NULL;
    }
    qsort(inputs, count, sizeof *inputs, compare_texts);
    for (size_t i = 0; i < scene->file_count && result == PS_OK; i++) {
        char *path = path_in(folder, scene->files[i].name);
        result = path ? check_side_file(path, inputs, count, error)
                      : error_memory(error, strlen(folder), "a path");
        free(path);
    }
    if (result == PS_OK)
        result = check_target(output, inputs, count, error);
    for (size_t i = 0; i < count; i++)
        free(inputs[i]);
    free(inputs);
    return result;
}

/* --- writing
 * -------------------------------------------------------------------------------------- */

/* Leaves the file open, to be committed or discarded; not PS_OK: it is discarded. */
static ps_result start_file(struct output_file *file, const char *path, const void *bytes,
                            size_t size, struct error *error)
{
    ps_result result = output_file_open(file, path, error);
    if (result != PS_OK)
        return result;
    result = output_file_write(file, 0, bytes, size, error);
    if (result != PS_OK)
        output_file_discard(file);
    return result;
}

static ps_result write_side_file(const char *folder, const struct side_file *file,
                                 struct error *error)
{
    struct output_file out;
    char *path = path_in(folder, file->name);
    if (!path)
        return error_memory(error, strlen(file->name), "a path");
    ps_result result = file->picture ? image_write_exr(file->picture, path, IMAGE_ZIP, NULL, error)
                                     : start_file(&out, path, file->bytes, file->size, error);
    if (result == PS_OK && !file->picture)
        result = output_file_commit(&out, error);
    free(path);
    return result;
}

static ps_result move_side_file(const char *from, const char *to, const struct side_file *file,
                                struct error *error)
{
    char *source = path_in(from, file->name), *target = path_in(to, file->name);
    ps_result result = PS_OK;
    if (!source || !target)
        result = error_memory(error, strlen(file->name), "a path");
    else if (rename(source, target) != 0)
        result =
            error_set(error, PS_ERROR_IO, "cannot write '%.1000s': %s", target, strerror(errno));
    free(source);
    free(target);
    return result;
}

static void remove_folder(const struct written_scene *scene, const char *folder)
{
    for (size_t i = 0; i < scene->file_count; i++) {
        char *path = path_in(folder, scene->files[i].name);
        if (path)
            unlink(path); /* where it was not moved */
        free(path);
    }
    rmdir(folder);
}

/* The scene last: what it names is there when it is. `made` is the folder of the side files. */
static ps_result write_through(const struct written_scene *scene, const char *made,
                               const char *output, const char *folder, struct error *error)
{
    struct output_file text;
    ps_result result = PS_OK;
    for (size_t i = 0; i < scene->file_count && result == PS_OK; i++)
        result = write_side_file(made, &scene->files[i], error);
    if (result == PS_OK)
        result = start_file(&text, output, scene->text, scene->length, error);
    if (result != PS_OK)
        return result;
    for (size_t i = 0; i < scene->file_count && result == PS_OK; i++)
        result = move_side_file(made, folder, &scene->files[i], error);
    if (result == PS_OK)
        return output_file_commit(&text, error);
    output_file_discard(&text);
    return result;
}

ps_result scene_files_write(const struct written_scene *scene, const char *input,
                            const char *output, const char *folder, struct error *error)
{
    ps_result result = check_targets(scene, input, output, folder, error);
    if (result != PS_OK || scene->file_count == 0)
        return result == PS_OK ? write_through(scene, "", output, folder, error) : result;
    char *made = path_in(folder, ".psplat-import-XXXXXX/");
    if (!made)
        return error_memory(error, strlen(folder), "a path");
    char *slash = made + strlen(made) - 1;
    *slash = '\0';
    if (!mkdtemp(made)) {
        result = error_set(error, PS_ERROR_IO,
                           "cannot write '%.1000s': cannot create a folder "
                           "beside it: %s",
                           output, strerror(errno));
    } else {
        *slash = '/';
        result = write_through(scene, made, output, folder, error);
        remove_folder(scene, made);
    }
    free(made);
    return result;
}
