/* mesh_files.c: reads whole files, from the disk or from a list.
 *
 * Whole, since OBJ and glTF are looked at before assimp gets them, and so that a pipe or a device
 * under the name of a mesh is refused before anything waits for it.
 */
#include "parser/mesh_files.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const struct mesh_memory_file *find_in_memory(const struct mesh_files *files,
                                                     const char *path)
{
    for (size_t i = 0; i < files->memory_count; i++)
        if (strcmp(files->memory[i].path, path) == 0)
            return &files->memory[i];
    return NULL;
}

static ps_result check_size(const char *path, size_t length, struct error *error)
{
    if (length > MESH_FILE_LARGEST)
        return error_set(error, PS_ERROR_INVALID, "%s is larger than 4 GiB", path);
    return PS_OK;
}

static struct mesh_file *create_file(const char *path, size_t length)
{
    struct mesh_file *file = calloc(1, sizeof *file);
    if (!file)
        return NULL;
    file->path = strdup(path);
    file->bytes = malloc(length + 1);
    file->length = length;
    return file;
}

static void destroy_file(struct mesh_file *file)
{
    free(file->path);
    free(file->bytes);
    free(file);
}

static ps_result check_regular(const char *path, size_t *length, struct error *error)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return error_set(error, PS_ERROR_IO, "cannot open %s: %s", path, strerror(errno));
    if (S_ISDIR(status.st_mode))
        return error_set(error, PS_ERROR_IO, "cannot read %s: it is a directory", path);
    if (!S_ISREG(status.st_mode))
        return error_set(error, PS_ERROR_IO, "cannot read %s: it is not a regular file", path);
    *length = (size_t)status.st_size;
    return check_size(path, *length, error);
}

static ps_result fill_from_disk(struct mesh_file *file, struct error *error)
{
    FILE *stream = fopen(file->path, "rb");
    if (!stream)
        return error_set(error, PS_ERROR_IO, "cannot open %s: %s", file->path, strerror(errno));
    errno = 0;
    size_t length = fread(file->bytes, 1, file->length, stream);
    ps_result result = PS_OK;
    if (ferror(stream))
        result = error_set(error, PS_ERROR_IO, "cannot read %s: %s", file->path, strerror(errno));
    fclose(stream);
    file->length = length;
    return result;
}

static ps_result read_new(const struct mesh_files *files, const char *path, struct mesh_file **file,
                          struct error *error)
{
    const struct mesh_memory_file *source = find_in_memory(files, path);
    size_t length = source ? source->length : 0;
    ps_result result = PS_OK;
    if (!files->memory)
        result = check_regular(path, &length, error);
    else if (!source)
        result = error_set(error, PS_ERROR_IO, "cannot open %s: no such file", path);
    if (result != PS_OK)
        return result;
    *file = create_file(path, length);
    if (!*file || !(*file)->path || !(*file)->bytes)
        return error_memory(error, length, "a mesh file");
    if (!source)
        result = fill_from_disk(*file, error);
    else if (length > 0)
        memcpy((*file)->bytes, source->bytes, length);
    (*file)->bytes[(*file)->length] = '\0';
    return result;
}

ps_result mesh_files_read(struct mesh_files *files, const char *path, struct mesh_file **file,
                          struct error *error)
{
    for (*file = files->read; *file; *file = (*file)->next)
        if (strcmp((*file)->path, path) == 0)
            return PS_OK;
    ps_result result = read_new(files, path, file, error);
    if (result == PS_OK) {
        (*file)->next = files->read;
        files->read = *file;
    } else if (*file) {
        destroy_file(*file);
        *file = NULL;
    }
    return result;
}

bool mesh_files_exist(const struct mesh_files *files, const char *path)
{
    struct stat status;
    if (files->memory)
        return find_in_memory(files, path) != NULL;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

void mesh_files_release(struct mesh_files *files)
{
    while (files->read) {
        struct mesh_file *file = files->read;
        files->read = file->next;
        destroy_file(file);
    }
}
