/* input_file.c: see input_file.h.
 *
 * In a restricted folder the path is resolved first, and what comes out is opened component by
 * component from the folder down, no step of which follows a link. So a link that is put there
 * between the two leads to an error and not out of the folder.
 */
#include "base/input_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define READ_FLAGS (O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)

/* What follows "FOLDER/" in a resolved path, or NULL where that lies elsewhere. */
static const char *path_below(const char *resolved, const char *folder)
{
    size_t length = strlen(folder);
    if (strcmp(folder, "/") == 0)
        return resolved + 1;
    bool inside = strncmp(resolved, folder, length) == 0 && resolved[length] == '/';
    return inside ? resolved + length + 1 : NULL;
}

/* Opens a path without links, "." and "..", which is changed, below a folder. -1: it can't be. */
static int open_below(const char *folder, char *path)
{
    int at = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    for (char *name = path; at >= 0;) {
        char *slash = strchr(name, '/');
        if (slash)
            *slash = '\0';
        int next = openat(at, name, READ_FLAGS | O_NOFOLLOW | (slash ? O_DIRECTORY : 0));
        close(at);
        at = next;
        if (!slash)
            break;
        name = slash + 1;
    }
    return at;
}

static int open_restricted(const char *path, const char *folder)
{
    char *resolved = realpath(path, NULL);
    const char *below = resolved ? path_below(resolved, folder) : NULL;
    int descriptor = below ? open_below(folder, resolved + (below - resolved)) : -1;
    free(resolved);
    return descriptor;
}

/* Asked after opening, so that nothing can be put in the file's place in between. */
static ps_result inspect(struct input_file *file, struct error *error)
{
    struct stat status;
    if (fstat(file->descriptor, &status) != 0)
        return error_set(error, PS_ERROR_IO, "cannot read: %s", strerror(errno));
    if (!S_ISREG(status.st_mode))
        return error_set(error, PS_ERROR_IO, "it is %s",
                         S_ISDIR(status.st_mode) ? "a directory" : "not a regular file");
    file->size = (uint64_t)status.st_size;
    file->device = (uint64_t)status.st_dev;
    file->serial = (uint64_t)status.st_ino;
    return PS_OK;
}

ps_result input_file_open(const char *path, const char *folder, struct input_file *file,
                          struct error *error)
{
    file->descriptor = folder ? open_restricted(path, folder) : open(path, READ_FLAGS);
    if (file->descriptor < 0 && folder)
        return error_set(
            error, PS_ERROR_INVALID,
            "no readable file of that name lies in %s, to which the scene is restricted", folder);
    if (file->descriptor < 0)
        return error_set(error, PS_ERROR_IO, "cannot open: %s", strerror(errno));
    ps_result result = inspect(file, error);
    if (result != PS_OK)
        close(file->descriptor);
    return result;
}

ps_result input_file_read(const struct input_file *file, void *bytes, size_t *size,
                          struct error *error)
{
    size_t done = 0;
    for (ssize_t count = 1; count != 0 && done<*size; done += count> 0 ? (size_t)count : 0) {
        count = read(file->descriptor, (char *)bytes + done, *size - done);
        if (count < 0 && errno != EINTR)
            return error_set(error, PS_ERROR_IO, "cannot read: %s", strerror(errno));
    }
    *size = done;
    return PS_OK;
}

bool input_file_exists(const char *path, const char *folder)
{
    struct input_file file;
    struct error ignored;
    if (input_file_open(path, folder, &file, &ignored) != PS_OK)
        return false;
    close(file.descriptor);
    return true;
}

bool input_folder_has(const char *folder, const char *path)
{
    if (!folder)
        return true;
    char *resolved = realpath(path, NULL);
    bool has = resolved && (strcmp(resolved, folder) == 0 || path_below(resolved, folder));
    free(resolved);
    return has;
}

char *input_folder_resolve(const char *path, struct error *error)
{
    struct stat status;
    char *resolved = realpath(path, NULL);
    if (resolved && stat(resolved, &status) == 0 && S_ISDIR(status.st_mode))
        return resolved;
    error_set(error, PS_ERROR_IO, "'%s' is not a folder that can be read%s%s", path,
              resolved ? "" : ": ", resolved ? "" : strerror(errno));
    free(resolved);
    return NULL;
}
